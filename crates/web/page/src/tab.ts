/** What the tabs over many runs have in common: what they need of the page, progress, a sheet of results. */

import type { Desk } from "./desk";
import { fill, h } from "./dom";
import { FigureView } from "./figure";
import type { RecordChoice } from "./motion";
import { warningList } from "./results";
import type { Display, Fault, InputValue, Run, Setting, Sheet, State } from "./types";

/** What the tabs need of the page. */
export interface Page {
  desk: Desk;
  state: () => State | undefined;
  display: () => Display;
  /** Whether it stands on a dark ground. */
  dark: () => boolean;
  /** Names of all records, with their words. */
  records: () => { name: string; label: string }[];
  /** What a record's file does not say. */
  choice: (name: string) => RecordChoice;
  /** The model's text. */
  text: () => string;
  set: (settings: Setting[]) => void;
  /** Shows a run by itself; its record by the name on the page. */
  load: (run: Run) => void;
  /** A number that is another for other bytes of a record. */
  identity: (name: string) => number;
  /** Says on the bar how far a tab is; nothing where it is at rest. */
  progress: (tab: string, text: string) => void;
  /** A setting of a tab changed. */
  changed: () => void;
  say: (text: string) => void;
  fault: (fault: Fault) => void;
}

export interface Tab {
  readonly id: string;
  readonly label: string;
  readonly element: HTMLElement;
  open(): void;
  /** Told where model or records may have changed. */
  update?(): void;
  /** Told where the ground has become dark or light. */
  restyle?(): void;
  /** What is set on it, for the address. */
  settings?(): Record<string, string>;
  restore?(settings: Record<string, string>): void;
}

const identities = new WeakMap<Uint8Array, number>();
let known = 0;

/** A number that is another for other bytes. */
export function identity(bytes: Uint8Array): number {
  const number = identities.get(bytes) ?? ++known;
  identities.set(bytes, number);
  return number;
}

/** The files of the page, as they are told apart. */
export const filesOf = ({ records }: Desk) => [...records].map(([name, bytes]) => [name, identity(bytes)]);

/** What a result is of, as text: the model with the keys set on it, the bytes of the records, what was asked. */
export function subject({ desk }: Pick<Page, "desk">, asked: unknown): string {
  return JSON.stringify([desk.wanted.text, desk.wanted.set, filesOf(desk), asked]);
}

/** A result, greyed where it is no longer of what stands on the page. */
export class Result {
  private readonly note = h("p", { class: "out-of-date", role: "status", hidden: true }, "Out of date: the model, a record or a setting has changed since. Run it again.");
  private readonly place = h("div", {});
  readonly element = h("div", { class: "result" }, this.note, this.place);
  private of: string | undefined;

  /** Shows something; `of` where it is a result. */
  show(of: string | undefined, ...children: Node[]): void {
    this.of = of;
    fill(this.place, ...children);
    this.check(of ?? "");
  }

  /** Compares what it is of with what stands on the page. */
  check(now: string): void {
    const stale = this.of !== undefined && this.of !== now;
    this.note.hidden = !stale;
    this.place.classList.toggle("stale", stale);
  }
}

/** Progress with a button that ends the work. */
export class Progress {
  private readonly bar = h("progress", { max: 1, value: 0, "aria-label": "Progress" });
  private readonly words = h("span", { role: "status" });
  readonly stop = h("button", { type: "button" }, "Cancel");
  readonly element = h("div", { class: "progress", hidden: true }, this.bar, h("div", { class: "actions" }, this.words, this.stop));
  private started = 0;

  /** `told` is told how far it is; nothing at its end. */
  constructor(private readonly told: (text: string) => void) {}

  begin(): void {
    this.told("…");
    this.started = performance.now();
    this.element.hidden = false;
    this.bar.removeAttribute("value");
    this.words.textContent = "Loading";
  }

  show(done: number, of: number): void {
    if (of > 0) {
      this.bar.value = Math.min(1, done / of);
      this.told(`${Math.floor((100 * Math.min(done, of)) / of)} %`);
    }
    const left = ((performance.now() - this.started) / Math.max(1, done)) * Math.max(0, of - done);
    this.words.textContent = of > 0 ? `${done} of ${of} runs, ${(left / 1000).toFixed(0)} s left` : `${done} runs`;
  }

  end(): void {
    this.told("");
    this.element.hidden = true;
  }
}

/** A result laid out, its figures alive. */
export function sheetElement(sheet: Sheet, dark: () => boolean): { element: HTMLElement; views: FigureView[] } {
  const views: FigureView[] = [];
  const table = ({ heading, rows }: Sheet["tables"][number]) => {
    const [head = [], ...body] = rows;
    const cell = (text: string, i: number) => h("td", { class: i > 0 ? "number" : "" }, text.replace(/^-(?=\d)/, "−"));
    return [
      h("h3", {}, heading),
      h(
        "div",
        { class: "table-scroll", tabindex: 0, role: "region", "aria-label": heading },
        h(
          "table",
          {},
          h("thead", {}, h("tr", {}, ...head.map((text, i) => h("th", { scope: "col", class: i > 0 ? "number" : "" }, text)))),
          h("tbody", {}, ...body.map((row) => h("tr", {}, ...row.map((text, i) => (i === 0 ? h("th", { scope: "row", class: text.startsWith("  ") ? "sub" : "" }, text.trim()) : cell(text, i)))))),
        ),
      ),
    ];
  };
  const figure = (drawn: Sheet["figures"][number]) => {
    const view = new FigureView(drawn, { dark }, h("span", {}, drawn.caption));
    views.push(view);
    return view.element;
  };
  const [first, ...others] = sheet.figures;
  const element = h(
    "article",
    { class: "card pad sheet" },
    h("h2", {}, `${sheet.kind}. ${sheet.line}`),
    ...sheet.verdict.map((sentence, i) => h("p", { class: i === 0 ? "lead" : "" }, sentence)),
    sheet.first ? h("p", {}, sheet.first) : "",
    ...warningList(sheet.warnings),
    first ? figure(first) : "",
    ...sheet.tables.slice(0, 1).flatMap(table),
    ...sheet.notes.map((note) => h("p", {}, note)),
    ...others.map(figure),
    ...sheet.tables.slice(1).flatMap(table),
    h("h3", {}, "Method and limits"),
    ...sheet.method.map((line) => h("p", {}, line)),
  );
  return { element, views };
}

/** The value at a path of the model. */
export const value = (state: State, path: string): InputValue | undefined => state.inputs.find((input) => input.path === path);
