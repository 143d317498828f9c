/** Tables of results beside the pictures. */

import { digits, fill, h } from "./dom";
import type { Answered } from "./desk";
import type { Answer, Judgement, State, Warning } from "./types";

/** What the figures of the check say. */
const MEANINGS: Record<string, string> = {
  "Equilibrium residual": "Largest difference from an integration by another method, as a share of the peak",
  "Friction excess": "Largest excess of the force on the slider over what friction can give, as a share of it",
  "Energy balance error": "What went in and is found nowhere, as a share of the energy",
  "Demands error": "Largest difference of a printed figure from the same figure computed anew, as a share of it",
};

/** A figure that is read first: its value in SI, and how it is written. */
interface Figure {
  label: string;
  value: number;
  text: string;
  unit: string;
  over?: boolean;
  /** It has either sign. */
  signed?: boolean;
}

/** Share of the peak below which a residual is that of rounding. */
const ROUNDING = 1e-9;

function figures({ headline, units, structure }: State): Figure[] {
  const length = (label: string, value: number): Figure => ({ label, value, text: digits(value / units.length.in_si), unit: units.length.symbol });
  const acceleration = (label: string, value: number): Figure => ({ label, value, text: digits(value / units.acceleration.in_si), unit: units.acceleration.symbol });
  const { gapRatio, roof_m_per_s2: roof, baseShear, slips } = headline;
  const gap = structure.gap_m !== null && gapRatio !== null;
  return [
    length("Peak sliding", headline.peak_m),
    // What is left of a return to where it stood is rounding.
    { ...length("Residual", Math.abs(headline.residual_m) < ROUNDING * headline.peak_m ? 0 : headline.residual_m), signed: true },
    gap ? { label: "Gap used", value: gapRatio, text: digits(100 * gapRatio, 3), unit: "%", over: gapRatio > 1 } : { label: "Times it slides", value: slips, text: String(slips), unit: "" },
    roof === null ? acceleration("Block accel\u00aderation", headline.block_m_per_s2) : acceleration("Roof accel\u00aderation", roof),
    ...(roof === null ? [] : [{ label: "Base shear / weight", value: baseShear, text: digits(baseShear, 3), unit: "" }]),
  ];
}

/** What B has instead, and by how much the present value differs from it; no share of what lies about zero. */
function versus(now: Figure, pinned: Figure | undefined): string {
  if (!pinned) return "";
  const share = Math.round(100 * (now.value / pinned.value - 1));
  const more = pinned.signed || pinned.value === 0 || !Number.isFinite(share) ? "" : share === 0 ? ", as now" : `, now ${share > 0 ? "+" : "−"}${Math.abs(share)} %`;
  return `B ${pinned.text}${pinned.unit && ` ${pinned.unit}`}${more}`;
}

/** The figures that are read first, beside those of B where one is kept. */
export function headline(into: HTMLElement, state: State, pinned?: State): void {
  const beside = pinned ? figures(pinned) : [];
  const all = figures(state).map((figure) => ({ ...figure, other: versus(figure, beside.find((one) => one.label === figure.label)) }));
  // Elements stay while a value moves: a layout less in every picture.
  const shape = JSON.stringify(all.map(({ label, unit, over, other }) => [label, unit, over, other !== ""]));
  if (into.dataset.shape !== shape) {
    into.dataset.shape = shape;
    fill(into, ...all.map(({ label, unit, over, other }) => h("div", { class: over ? "over" : "" }, h("dt", {}, label), h("dd", {}, h("span", {}), unit && h("small", {}, unit)), other && h("dd", { class: "versus" }))));
  }
  const write = (element: Element | null | undefined, text: string) => {
    if (element && element.textContent !== text) element.textContent = text;
  };
  all.forEach(({ text, other }, i) => {
    write(into.children[i]?.querySelector("dd span"), text);
    write(into.children[i]?.querySelector(".versus"), other);
  });
}

/** What forbids to take the figures as they stand, beside them. */
export function severe(into: HTMLElement, warnings: Warning[]): void {
  const said = warnings.filter(({ label }) => label === "Severe");
  const words = JSON.stringify(said);
  if (words === into.dataset.said) return;
  into.dataset.said = words;
  into.hidden = said.length === 0;
  fill(into, ...warningList(said));
}

export function warningList(warnings: Warning[]): HTMLElement[] {
  return warnings.map((warning) =>
    h(
      "p",
      { class: warning.label === "Note" ? "warning note" : "warning" },
      h("strong", {}, `${warning.label}: ${warning.kind}`),
      warning.run ? ` (${warning.run} friction)` : "",
      warning.time_s !== null ? ` at ${warning.time_s.toFixed(2)} s` : "",
      `: ${warning.message}`,
    ),
  );
}

/** The table of peaks and the warnings; made anew only where their shape changes. */
export class Peaks {
  readonly table = h("div", { class: "table-scroll", tabindex: 0, role: "region", "aria-label": "Peaks" });
  readonly warnings = h("div", {});
  private shape = "";
  private cells: HTMLElement[][] = [];
  private warned = "";

  show({ rows, runs, warnings }: Pick<State, "rows" | "runs" | "warnings">): void {
    const shape = JSON.stringify([runs, rows.map(({ label, unit }) => [label, unit])]);
    if (shape !== this.shape) {
      this.shape = shape;
      this.cells = rows.map((row) => row.values.map(() => h("td", { class: "number" })));
      const head = runs.length > 1 ? [h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "Friction"), ...runs.map((run) => h("th", { scope: "col", class: "number" }, run))))] : [];
      const body = rows.map((row, i) => h("tr", {}, h("th", { scope: "row" }, row.label, row.unit && h("small", {}, ` ${row.unit}`)), ...this.cells[i]!));
      fill(this.table, h("table", {}, ...head, h("tbody", {}, ...body)));
    }
    rows.forEach((row, i) =>
      row.values.forEach((value, run) => {
        const cell = this.cells[i]![run]!;
        const text = value.replace("-", "−");
        if (cell.textContent !== text) cell.textContent = text;
        cell.classList.toggle("governs", row.governing === run);
      }),
    );
    this.warn(warnings);
  }

  private warn(warnings: Warning[]): void {
    const warned = JSON.stringify(warnings);
    if (warned === this.warned) return;
    this.warned = warned;
    fill(this.warnings, ...warningList(warnings));
  }
}

/** What a person hears once the page rests. */
export function sentence({ headline, units }: State, holds: boolean | null | undefined): string {
  const length = (value: number) => `${digits(value / units.length.in_si)} ${units.length.symbol}`;
  const checked = holds === true ? "Computed right." : holds === false ? "The check failed." : "Not judged.";
  return `Peak sliding displacement ${length(headline.peak_m)}, residual ${length(headline.residual_m)}. ${checked}`;
}

/** What is said of a picture while the page loads: that there is none, that it is of the build, that it is not checked. */
const LOADING = {
  nothing: "The solver is on its way.",
  built: "This picture was computed when the page was built. It is computed here as soon as the solver has come, and what you change is answered then.",
  answer: "Not yet checked: the check, and the analyses over many runs, are on their way.",
};

/** That a part of the page is on its way. */
export function loading(into: HTMLElement, shown: keyof typeof LOADING): void {
  if (into.dataset.state === shown) return;
  into.dataset.state = shown;
  into.classList.remove("holds", "fails");
  fill(into, h("strong", {}, "Loading"), h("span", {}, LOADING[shown]));
}

/** The certificate of an answer; that there is none yet, or none at all, where `check` checks it. `last`: what is wanted now has no answer, and it is of the one before. */
export function certificate(into: HTMLElement, { judgement, unchecked }: Answered, last: boolean, check: () => void): void {
  const say = (kind: string, lead: string, ...more: (Node | string)[]) => {
    for (const one of ["holds", "fails"]) into.classList.toggle(one, one === kind);
    fill(into, h("strong", {}, lead), ...more);
  };
  if (!judgement && unchecked === undefined) {
    if (into.dataset.state !== "waiting") say("", "Not yet checked", h("span", {}, "It is checked as soon as the values rest."));
    into.dataset.state = "waiting";
    return;
  }
  into.dataset.state = "judged";
  if (last) {
    say("", "Of the last good state", h("span", {}, "What stands in the model now cannot be analysed."));
    return;
  }
  if (!judgement) {
    say("", "Not checked", h("span", {}, `${unchecked}.`.replace(/^./, (first) => first.toUpperCase())), h("span", { class: "actions" }, h("button", { type: "button", onclick: check }, "Check it")));
    return;
  }
  const { holds, bound, figures, closestCall, iterations } = judgement.certificate;
  const list = h("dl", {}, ...figures.flatMap(({ name, value }) => [h("dt", { title: MEANINGS[name] ?? "" }, name), h("dd", {}, value)]));
  if (closestCall) {
    const of = h("dt", { title: "How far the least certain of all decisions, to slide or to stick, was from falling the other way, as a share" }, `Margin of the least certain step (${closestCall.kind}, ${closestCall.time_s.toFixed(2)} s)`);
    list.append(of, h("dd", {}, closestCall.margin));
  }
  if (iterations) list.append(h("dt", {}, "Iterations a step, mean and most"), h("dd", {}, `${iterations.mean}, ${iterations.max}`));
  if (holds === true) say("holds", "Computed right", h("span", {}, `An independent integration of this model agrees within ${bound}.`), list);
  else if (holds === false) say("fails", "The check FAILED: do not use this response", h("span", {}, `Not every figure is within ${bound}.`), list);
  else say("", "Stepwise: reported, not judged", h("span", {}, "The paper's method has an error of its own."), list);
}

/** The same structure on a fixed base, and the stepwise method where it was asked for. */
export function beside(into: HTMLElement, judgement: Judgement): void {
  const { fixedBase, stepwise } = judgement;
  const table = (caption: string, heads: string[], rows: string[][]) =>
    h(
      "table",
      {},
      h("caption", { class: "hidden" }, caption),
      h("thead", {}, h("tr", {}, ...heads.map((text, i) => h("th", { scope: "col", class: i > 0 ? "number" : "" }, text)))),
      h("tbody", {}, ...rows.map((row) => h("tr", {}, ...row.map((text, i) => (i === 0 ? h("th", { scope: "row" }, text) : h("td", { class: "number" }, text.replace("-", "−"))))))),
    );
  fill(
    into,
    stepwise?.error ? h("p", { class: "fault" }, stepwise.error) : "",
    stepwise?.rows ? table("Stepwise beside exact", ["Displacements", "exact", "stepwise", ""], stepwise.rows.map((row) => [row.label, row.exact, row.stepwise, row.unit])) : "",
    stepwise?.iterations ? h("p", { class: "drop-hint" }, stepwise.iterations) : "",
    fixedBase ? table("On a fixed base", ["Structure", "fixed", "sliding", "", "ratio"], fixedBase.map((row) => [row.label, row.fixed, row.sliding, row.unit, row.ratio])) : h("p", { class: "drop-hint" }, "A block without storeys has no fixed base to compare with."),
  );
}

/** The events, each with a button that goes to it. */
export function events(into: HTMLElement, answer: Answer, seek: (time: number) => void): void {
  const { eventTimes, eventKinds } = answer;
  const names = ["slip", "stick", "reversal", "contact", "separation", "press", "leave", "impact", "rest", "surface"];
  const most = 400;
  const rows = [...eventTimes.subarray(0, most)].map((time, i) => {
    const go = h("button", { type: "button" }, `${time.toFixed(4)} s`);
    go.addEventListener("click", () => {
      seek(time);
    });
    return h("tr", {}, h("td", {}, go), h("td", {}, names[eventKinds[i]!] ?? ""));
  });
  fill(
    into,
    h("table", {}, h("thead", {}, h("tr", {}, h("th", { scope: "col" }, "Time"), h("th", { scope: "col" }, "Event"))), h("tbody", {}, ...rows)),
    eventTimes.length > most ? h("p", { class: "drop-hint" }, `The first ${most} of ${eventTimes.length}; the others are in events.csv.`) : "",
  );
}
