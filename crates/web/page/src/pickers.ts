/** Lists with units beside fields of a form, so that nobody has to know how a demand, a measure or a range is written. */

import { h } from "./dom";
import type { Choice, FormField, State } from "./types";

type Entry = HTMLInputElement | HTMLSelectElement | HTMLTextAreaElement;

/** What there is to choose from. */
export interface Known {
  demands: Choice[];
  state: () => State | undefined;
}

const option = (value: string, text: string) => h("option", { value }, text);
export const withUnit = (text: string, symbol: string | undefined) => (symbol ? `${text} (${symbol})` : text);

/** Writes a text into a field as a person would. */
function write(into: Entry, text: string): void {
  into.value = text;
  into.dispatchEvent(new Event("change", { bubbles: true }));
}

/** What stands beside a field; nothing where it needs no help. */
export function picker({ name, label, takes }: FormField, into: Entry, known: Known): HTMLElement | "" {
  if (name === "demand" && takes === "many") return demand(label, into, known.demands);
  if (name === "measure") return measure(label, into);
  if (name === "over" || name === "vary") return range(label, takes === "many", into, known);
  return "";
}

function demand(label: string, into: Entry, demands: Choice[]): HTMLElement {
  const select = h("select", { "aria-label": `${label}: choose` }, option("", "Choose a demand"), ...demands.map(({ name, title, unit }) => option(name, withUnit(title, unit.symbol))));
  select.addEventListener("change", (event) => {
    event.stopPropagation();
    if (select.value !== "") write(into, into.value.trim() ? `${into.value.trim()}\n${select.value}` : select.value);
    select.value = "";
  });
  return h("div", { class: "picker" }, select);
}

function measure(label: string, into: Entry): HTMLElement {
  const select = h("select", { "aria-label": `${label}: choose` }, ...[["PGA", "Peak acceleration (g)"], ["PGV", "Peak velocity (m/s)"], ["Sa", "Spectral acceleration (g)"], ["Sa_avg", "Spectral acceleration, mean over periods (g)"]].map(([value, text]) => option(value!, text!)));
  const [from, to] = ["1 s", "2 s"].map((text) => h("input", { type: "text", value: text, size: 6 }));
  const first = h("label", {}, "Period ", from!);
  const last = h("label", {}, "to ", to!);
  const [, kind = "PGA", one, two] = /^(PGA|PGV|Sa_avg|Sa)(?:\(([^,)]+)(?:,\s*([^)]+))?\))?$/.exec(into.value.trim()) ?? [];
  select.value = kind;
  if (one) from!.value = one;
  if (two) to!.value = two;
  const say = () => {
    first.hidden = !select.value.startsWith("Sa");
    last.hidden = select.value !== "Sa_avg";
  };
  say();
  const change = (event: Event) => {
    event.stopPropagation();
    say();
    write(into, select.value === "Sa" ? `Sa(${from!.value})` : select.value === "Sa_avg" ? `Sa_avg(${from!.value}, ${to!.value})` : select.value);
  };
  for (const entry of [select, from!, to!]) entry.addEventListener("change", change);
  return h("div", { class: "picker" }, select, first, last);
}

function range(label: string, many: boolean, into: Entry, { state }: Known): HTMLElement {
  const inputs = (state()?.inputs ?? []).filter(({ path, value }) => typeof value === "number" && value !== 0 && !/^(motion\.(dt|units)|block\.(width|height)|storey\.\d+\.height|slider\.bounds)/.test(path));
  const own = many ? [] : [option("isolator.period", "Period of the pendulum (s)")];
  const select = h("select", { "aria-label": `${label}: key` }, option("", many ? "Vary a value" : "Another value"), ...own, ...inputs.map(({ path, symbol }) => option(path, withUnit(path, symbol))));
  const [from, to] = ["from", "to"].map((text) => h("input", { type: "text", size: 6, inputmode: "decimal", "aria-label": `${label}: ${text}` }));
  const count = h("input", { type: "text", size: 4, inputmode: "numeric", value: many ? "3" : "40", "aria-label": `${label}: number of values` });
  const unit = h("span", { class: "unit" });
  const more = h("span", { class: "picker", hidden: true }, from!, " to ", to!, unit, " in ", count, h("button", { type: "button", onclick: () => take() }, many ? "Add" : "Take"));
  const chosen = () => inputs.find(({ path }) => path === select.value);
  select.addEventListener("change", (event) => {
    event.stopPropagation();
    more.hidden = select.value === "";
    const input = chosen();
    const now = input && typeof input.value === "number" ? input.value / (input.in_si ?? 1) : undefined;
    unit.textContent = select.value === "isolator.period" ? "s" : (input?.symbol ?? "");
    from!.value = now === undefined ? "1" : String(Number((now * 0.5).toPrecision(2)));
    to!.value = now === undefined ? "5" : String(Number((now * 2).toPrecision(2)));
  });
  for (const entry of [from!, to!, count]) entry.addEventListener("change", (event) => event.stopPropagation());
  const take = () => {
    const text = `${select.value}=${from!.value}..${to!.value}${unit.textContent ? ` ${unit.textContent}` : ""}:${count.value}`;
    write(into, many && into.value.trim() ? `${into.value.trim()}\n${text}` : text);
    select.value = "";
    more.hidden = true;
  };
  return h("div", { class: "picker" }, select, more);
}
