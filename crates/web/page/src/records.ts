/** The records on the page, and by what the table moves. */

import type { Desk } from "./desk";
import { fill, h } from "./dom";
import { MODELS, RECORDS } from "./examples";
import { lastPart } from "./intake";
import { onMade, onRecord, type RecordChoice, renamed } from "./motion";
import type { State } from "./types";

/** What the records need of the page. */
export interface Holder {
  desk: Desk;
  state: () => State | undefined;
  text: () => string;
  setText: (text: string) => void;
}

export class Records {
  /** Those of the person's own, with what was said of them. */
  readonly own = new Map<string, { sha256: string; choice: RecordChoice }>();
  readonly list = h("ul", { class: "records" });
  /** The choice of the motion, and the words of the record. */
  readonly motion: HTMLElement;
  private readonly select = h("select", { id: "motion-source" });
  private readonly words = h("p", { class: "drop-hint" });
  private choices = "";

  constructor(private readonly page: Holder) {
    this.motion = h("div", {}, h("div", { class: "choice" }, h("label", { for: "motion-source" }, "Table moves by"), this.select), this.words);
    this.select.addEventListener("change", () => this.choose(this.select.value));
    for (const record of RECORDS) page.desk.records.set(record.name, new TextEncoder().encode(record.text));
  }

  /** A record of the person's own that nothing has to be said of. */
  add(name: string, bytes: Uint8Array): void {
    this.page.desk.records.set(name, bytes);
    this.own.set(name, { sha256: "", choice: { name } });
  }

  all(): { name: string; label: string }[] {
    const own = [...this.own.keys()].map((name) => ({ name, label: name }));
    return [...RECORDS.map(({ name, label }) => ({ name, label })), ...own];
  }

  /** What a record's file does not say. */
  choice(name: string): RecordChoice {
    return RECORDS.find((record) => record.name === name) ?? this.own.get(name)?.choice ?? { name };
  }

  /** Paths of all components of the motion, as a model names them. */
  private paths(state: State): string[] {
    return state.inputs.filter(({ path }) => /^motion\.(record|record_y|vertical)$/.test(path)).map(({ text }) => text);
  }

  /** What the table moves by: the names of the records, and words where the motion is made. */
  moved(state: State): string {
    const labels = this.paths(state).map((path) => this.all().find(({ name }) => name === path)?.label ?? lastPart(path));
    return labels.length > 0 ? labels.join(" and ") : state.motion.words;
  }

  /** Those files that the motion of a model is of, by their paths in it. */
  bytes(state: State, files: Map<string, Uint8Array>): [path: string, bytes: Uint8Array][] {
    return this.paths(state).flatMap((path): [string, Uint8Array][] => {
      const bytes = files.get(path) ?? files.get(lastPart(path));
      return bytes ? [[path, bytes]] : [];
    });
  }

  /** Those of the person's own that a model needs, and B where there is one, as the address names them. */
  needed(state: State, pinned: State | undefined): { name: string; sha256: string }[] {
    const used = [...this.paths(state), ...(pinned ? this.paths(pinned) : [])];
    return [...this.own].filter(([name]) => used.some((path) => path === name || lastPart(path) === name)).map(([name, { sha256 }]) => ({ name, sha256 }));
  }

  show(): void {
    const remove = (name: string) => {
      this.own.delete(name);
      this.page.desk.drop(name);
      this.page.desk.changed();
      this.show();
    };
    fill(
      this.list,
      ...RECORDS.map(({ label }) => h("li", {}, `${label} (U.S. Geological Survey)`)),
      ...[...this.own.keys()].map((name) => h("li", {}, name, h("button", { type: "button", "aria-label": `Remove ${name}`, onclick: () => remove(name) }, "×"))),
    );
    this.update();
  }

  /** Takes over what the model says. */
  update(): void {
    const state = this.page.state();
    this.words.textContent = state?.motion.words ?? "";
    const record = this.used();
    const known = this.all().find(({ name }) => name === record || name.endsWith(`/${record}`));
    const now = record === undefined ? (state?.motion.kind ?? "") : `record:${known?.name ?? record}`;
    const options = [
      ...this.all().map(({ name, label }) => [`record:${name}`, label]),
      ["sine", "A sine"],
      ["sweep", "A sine sweep"],
      ["pulse", "A pulse"],
    ];
    if (now && !options.some(([value]) => value === now)) options.unshift([now, record ?? now]);
    const choices = JSON.stringify([options, now]);
    if (choices === this.choices) {
      // A choice that could not be leaves the select as it was.
      this.select.value = now;
      return;
    }
    this.choices = choices;
    fill(this.select, ...options.map(([value, label]) => h("option", { value, selected: value === now }, label!)));
  }

  private used(): string | undefined {
    return this.page.state()?.inputs.find((input) => input.path === "motion.record")?.text;
  }

  private choose(value: string): void {
    if (!value.startsWith("record:")) this.move(onMade(this.page.text(), value), this.select.selectedOptions[0]?.textContent ?? value);
    else this.take(this.choice(value.slice(7)));
  }

  /** Moves the table by a record, as it was recorded. */
  take({ name, units, dt, channel }: RecordChoice): void {
    const label = this.all().find((record) => record.name === name)?.label ?? name;
    this.move(onRecord(this.page.text(), { name, units, dt, channel }), label);
  }

  private move(text: string, motion: string): void {
    this.page.setText(renamed(text, MODELS.map((model) => model.text), motion));
  }
}
