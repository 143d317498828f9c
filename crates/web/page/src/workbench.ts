/** The records that all tabs over many runs use: chosen once, each with what is known of it. */

import { digits, fill, h } from "./dom";
import { ModuleError } from "./desk";
import type { Page } from "./tab";
import type { Surveyed } from "./types";

/** What a tab scales records to, as it is written. */
export interface Level {
  measure: string;
  level: string;
}

const G = 9.80665;
/** A level in SI, where it is one value of acceleration or velocity. */
function inSi(text: string): number {
  const [, value, unit = ""] = /^\s*([\d.eE+-]+)\s*(\S*)\s*$/.exec(text) ?? [];
  const factor = { g: G, "m/s2": 1, "m/s": 1, "cm/s": 0.01, "": Number.NaN }[unit];
  return factor === undefined ? Number.NaN : Number(value) * factor;
}

export class Workbench {
  readonly element: HTMLElement;
  private readonly chosen = new Map<string, boolean>();
  private readonly period = h("input", { type: "text", value: "1 s", "aria-label": "Period of the spectral acceleration" });
  private readonly body = h("tbody", { role: "rowgroup" });
  private readonly saHead = h("th", { scope: "col", role: "columnheader", class: "number" }, "Sa");
  private readonly all = h("input", { type: "checkbox", "aria-label": "All records" });
  private readonly known = new Map<string, Surveyed | string>();
  private level: Level = { measure: "PGA", level: "" };
  private working = false;
  private again = false;
  /** Told where the choice has changed. */
  onchoice: () => void = () => {};

  constructor(private readonly page: Page) {
    this.period.addEventListener("change", (event) => {
      event.stopPropagation();
      this.update();
    });
    this.all.addEventListener("change", () => {
      for (const { name } of page.records()) this.chosen.set(name, this.all.checked);
      this.draw();
      this.onchoice();
    });
    // Laid out as a grid it is a table all the same.
    const head = (text: string, number: boolean) => h("th", { scope: "col", role: "columnheader", class: number ? "number" : "" }, text);
    const heads = [head("Record", false), head("Factor", true), head("Notices", true), head("PGA", true), head("PGV", true)];
    this.element = h(
      "fieldset",
      { class: "group workbench" },
      h("legend", {}, "Records"),
      h("p", { class: "drop-hint" }, "Drop any number of records on the page; what is ticked counts on all tabs. ", h("label", {}, "Sa at ", this.period)),
      h(
        "div",
        { class: "table-scroll", tabindex: 0, role: "region", "aria-label": "Records" },
        h("table", { role: "table" }, h("thead", { role: "rowgroup" }, h("tr", { role: "row" }, h("th", { scope: "col", role: "columnheader" }, this.all), ...heads, this.saHead)), this.body),
      ),
    );
  }

  /** Names of the records that count. */
  names(): string[] {
    return this.page.records().map(({ name }) => name).filter((name) => this.chosen.get(name) ?? true);
  }

  /** Names of those that do not. */
  without(): string[] {
    return this.page.records().map(({ name }) => name).filter((name) => this.chosen.get(name) === false);
  }

  leave(names: string[]): void {
    for (const name of names) this.chosen.set(name, false);
    this.draw();
  }

  /** Stands in the open tab, whose level its factors are of. */
  stand(place: HTMLElement, level: Level): void {
    if (this.element.parentElement !== place) place.append(this.element);
    this.level = level;
    this.update();
  }

  private get measure(): string {
    return /^Sa/.test(this.level.measure) ? this.level.measure : `Sa(${this.period.value.trim() || "1 s"})`;
  }

  private key(name: string): string {
    const { units = "", dt = "", channel = "" } = this.page.choice(name);
    return JSON.stringify([name, this.page.identity(name), units, dt, channel, this.measure, this.page.display()]);
  }

  /** Draws what is known, and finds out what is not. */
  update(): void {
    this.draw();
    this.again = true;
    if (!this.working) void this.survey();
  }

  private async survey(): Promise<void> {
    this.working = true;
    while (this.again) {
      this.again = false;
      for (const { name } of this.page.records()) {
        const key = this.key(name);
        if (this.known.has(key)) continue;
        const { units = "", dt = "", channel = "" } = this.page.choice(name);
        try {
          this.known.set(key, await this.page.desk.helper.call("survey", [name, units, dt, channel], this.measure, this.page.display()));
        } catch (error) {
          if (!(error instanceof ModuleError)) break;
          this.known.set(key, error.fault.message);
        }
        this.draw();
        if (this.again) break;
      }
    }
    this.working = false;
  }

  private factor(found: Surveyed): string {
    const wanted = inSi(this.level.level);
    const of = { PGA: found.pga.value, PGV: found.pgv.value }[this.level.measure] ?? found.measure?.value ?? Number.NaN;
    return Number.isFinite(wanted / of) ? digits(wanted / of, 4) : "–";
  }

  private draw(): void {
    this.saHead.textContent = this.measure;
    const records = this.page.records();
    const ticked = this.names().length;
    this.all.checked = ticked === records.length;
    this.all.indeterminate = ticked > 0 && ticked < records.length;
    const shown = ({ value, unit }: { value: number; unit: { in_si: number; symbol: string } }) => `${digits(value / unit.in_si, 3)} ${unit.symbol}`;
    fill(
      this.body,
      ...records.map(({ name, label }) => {
        const box = h("input", { type: "checkbox", checked: this.chosen.get(name) ?? true });
        box.addEventListener("change", () => {
          this.chosen.set(name, box.checked);
          this.onchoice();
        });
        const found = this.known.get(this.key(name));
        const cells = typeof found === "string" || !found ? ["", "", "", ""] : [this.factor(found), shown(found.pga), shown(found.pgv), found.measure ? shown(found.measure) : "–"];
        const told = typeof found === "string" ? [found] : (found?.notices ?? []);
        return h(
          "tr",
          { role: "row" },
          h("td", { role: "cell" }, h("label", { class: "switch" }, box, h("span", { class: "hidden" }, label))),
          h("th", { scope: "row", role: "rowheader" }, label),
          h("td", { role: "cell", class: "number" }, cells[0]!),
          h("td", { role: "cell", class: "told" }, told.length > 0 ? h("details", {}, h("summary", {}, String(told.length)), ...told.map((text) => h("p", {}, text))) : ""),
          ...cells.slice(1).map((text) => h("td", { role: "cell", class: "number" }, text)),
        );
      }),
    );
  }
}
