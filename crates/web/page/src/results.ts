/** Tables of results beside the pictures. */

import { fill, h } from "./dom";
import type { Answer, Judgement } from "./types";

/** The certificate of a judged answer; that there is none yet, without one. */
export function certificate(into: HTMLElement, judgement: Judgement | undefined): void {
  const say = (kind: string, lead: string, ...more: (Node | string)[]) => {
    into.className = `certificate ${kind}`;
    fill(into, h("strong", {}, lead), ...more);
  };
  if (!judgement) {
    if (into.dataset.state !== "waiting") say("", "Not yet checked", h("span", {}, "It is checked as soon as the values rest."));
    into.dataset.state = "waiting";
    return;
  }
  into.dataset.state = "judged";
  const { holds, bound, figures, closestCall, iterations } = judgement.certificate;
  const list = h("dl", {}, ...figures.flatMap(({ name, value }) => [h("dt", {}, name), h("dd", {}, value)]));
  if (closestCall) list.append(h("dt", {}, `Closest call (${closestCall.kind}, ${closestCall.time_s.toFixed(2)} s)`), h("dd", {}, closestCall.margin));
  if (iterations) list.append(h("dt", {}, "Iterations a step, mean and most"), h("dd", {}, `${iterations.mean}, ${iterations.max}`));
  if (holds === true) say("holds", "Checked: it holds", h("span", {}, `An independent integration agrees within ${bound}.`), list);
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
