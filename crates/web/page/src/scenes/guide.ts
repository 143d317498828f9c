/** A guided scene on the page: its card, its answer, its place in other pages. */

import { type Desk, Ended, Helper, ModuleError } from "../desk";
import { fill, h } from "../dom";
import type { Display, Setting, State } from "../types";
import { type Guide, SCENES } from "./list";

/** What a scene needs of the page. */
export interface Place {
  desk: Desk;
  display: () => Display;
  /** Opens a whole model, and keeps another as B, or none. */
  open: (text: string, pinned: string | undefined) => void;
  set: (settings: Setting[]) => void;
  /** What is to be dragged in a scene, beside its words; nothing where none is open. Its picture begins. */
  begin: (path: string | undefined) => HTMLElement;
  /** Another scene is open, or none. */
  changed: () => void;
  copy: (text: string, said: string) => void;
}

/** The address of the page without what is set on it. */
const here = () => location.href.replace(/#.*$/, "");

export const linkOf = (id: string) => `${here()}#scene.${id}`;

/** What another page takes up to show a scene. */
export function embedOf({ id, title }: Guide): string {
  return `<iframe src="${linkOf(id)}" title="Slipstick: ${title}" width="100%" height="720" style="border: 1px solid #ccc" loading="lazy"></iframe>\n<p><a href="${linkOf(id)}">${title}</a>, in Slipstick</p>\n`;
}

export class Guides {
  readonly element = h("section", { class: "card pad guide", "aria-label": "Guided scene", hidden: true });
  private guide: Guide | undefined;
  private work: Helper | undefined;
  /** The figures of the answer, for the tests. */
  found: Record<string, State> | undefined;

  constructor(private readonly place: Place) {}

  /** The scene that is open, for the address. */
  get id(): string | undefined {
    return this.guide?.id;
  }

  /** Buttons that open them. */
  buttons(): HTMLElement[] {
    return SCENES.map((guide, i) => h("button", { type: "button", onclick: () => this.open(guide.id) }, `${i + 1}. ${guide.title}`));
  }

  /** Opens one with its model; whether there is one of that name. */
  open(id: string): boolean {
    const guide = SCENES.find((guide) => guide.id === id);
    if (!guide) return false;
    this.place.open(guide.model, guide.pinned);
    this.show(id);
    this.place.changed();
    return true;
  }

  /** Shows the card of one, whatever the model is now; none of an unknown name. */
  show(id: string | undefined): void {
    const guide = SCENES.find((guide) => guide.id === id);
    if (guide === this.guide) return;
    this.work?.end();
    this.guide = guide;
    this.found = undefined;
    this.element.hidden = !guide;
    const control = this.place.begin(guide?.path);
    if (guide) this.draw(guide, control);
  }

  private draw(guide: Guide, control: HTMLElement): void {
    const { place } = this;
    const number = SCENES.indexOf(guide);
    const [before, next] = [SCENES[number - 1], SCENES[number + 1]];
    const button = (label: string, act: () => void, main = false) => h("button", { type: "button", onclick: act, class: main ? "main" : "" }, label);
    const answer = h("div", { class: "answer", role: "status" });
    const reveal = button("Show the answer", () => void this.answer(guide, answer, reveal), true);
    const code = h("textarea", { readonly: true, rows: 4, "aria-label": "Code to embed the scene", spellcheck: "false" });
    code.value = embedOf(guide);
    fill(
      this.element,
      h("p", { class: "count" }, `Scene ${number + 1} of ${SCENES.length}, about a minute`),
      h("h2", {}, guide.title),
      h("p", { class: "lead" }, guide.question),
      h("dl", {}, h("dt", {}, "Drag"), h("dd", {}, guide.drag, control, h("span", { class: "actions" }, ...guide.steps.map(({ label, set }) => button(label, () => place.set(set))))), h("dt", {}, "See"), h("dd", {}, guide.see)),
      answer,
      h("div", { class: "actions" }, reveal, before && button("Previous scene", () => this.open(before.id)), next && button("Next scene", () => this.open(next.id)), button("Close", () => this.close())),
      h("details", { class: "fold" }, h("summary", {}, "Embed this scene"), code, h("div", { class: "actions" }, button("Copy the code", () => place.copy(code.value, "The code is in the clipboard.")), button("Copy the link", () => place.copy(linkOf(guide.id), "The link is in the clipboard.")))),
    );
  }

  private close(): void {
    this.show(undefined);
    this.place.changed();
  }

  /** Computes what the answer speaks of, in a worker of its own, and says it. */
  private async answer(guide: Guide, into: HTMLElement, reveal: HTMLButtonElement): Promise<void> {
    reveal.disabled = true;
    const { desk, display } = this.place;
    const helper = new Helper(desk.engine, desk.records);
    this.work = helper;
    const runs = Object.entries(guide.runs);
    const found: Record<string, State> = {};
    try {
      for (const [i, [name, { text = guide.model, set = [] }]] of runs.entries()) {
        fill(into, h("p", {}, `Computing ${i + 1} of ${runs.length} analyses.`));
        found[name] = (await helper.call("analyse", { number: i + 1, text, set, display: display(), stepwise: false })).state;
      }
      if (this.guide !== guide) return;
      this.found = found;
      fill(into, h("h3", {}, "Answer"), ...guide.answer(found).map((words) => h("p", {}, words)), h("p", { class: "drop-hint" }, `The figures of this answer were computed here, just now, by ${runs.length} analyses.`));
      reveal.hidden = true;
    } catch (error) {
      if (error instanceof Ended) return;
      fill(into, h("p", { class: "fault" }, error instanceof ModuleError ? error.fault.message : String(error)));
      reveal.disabled = false;
    } finally {
      helper.end();
    }
  }
}
