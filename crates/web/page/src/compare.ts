/** Pin and compare: one setting kept as B, beside what is set now. */

import { labelOf } from "./controls";
import { type Desk, Ended, Helper, ModuleError } from "./desk";
import { fill, h } from "./dom";
import { filesOf } from "./tab";
import type { Answer, Display, Judgement, State } from "./types";

/** What comparing needs of the page. */
export interface Compared {
  desk: Desk;
  /** The model's text as it is set now. */
  text: () => string;
  /** Of what is set now, judged. */
  state: () => State | undefined;
  display: () => Display;
  /** Takes a whole text. */
  setText: (text: string) => void;
  /** B is another one, or none. */
  changed: () => void;
  say: (text: string) => void;
}

/** The setting that is kept, computed and judged. */
export interface Pinned {
  answer: Answer;
  judgement: Judgement;
}

/** Most differences that are told one by one. */
const MOST_TOLD = 3;

/** In what two models differ, in words: first as it is now, then as it is in B. */
export function differences(now: State, pinned: State): string[] {
  const of = (state: State) => new Map(state.inputs.map((input) => [input.path, input]));
  const [a, b] = [of(now), of(pinned)];
  const words = (state: typeof a, path: string) => {
    const input = state.get(path);
    return input ? (input.shown ? `${input.shown} ${input.symbol ?? ""}`.trim() : input.text) : "none";
  };
  return [...new Set([...a.keys(), ...b.keys()])]
    .filter((path) => path !== "name" && words(a, path) !== words(b, path))
    .map((path) => `${labelOf(path)}: ${words(a, path)}, in B ${words(b, path)}`);
}

export class Compare {
  readonly element = h("div", { class: "compare", role: "group", "aria-label": "Comparison" });
  /** B, where there is one and it has an answer. */
  pinned: Pinned | undefined;
  private text: string | undefined;
  private wrong = "";
  /** Of what B was asked for last. */
  private of: string | undefined;
  private asked = 0;
  private shown = "";

  constructor(private readonly page: Compared) {
    this.draw();
  }

  /** The text of B, for the address. */
  get kept(): string | undefined {
    return this.text;
  }

  /** Keeps a text as B; none without one. */
  keep(text: string | undefined): void {
    if (text === this.text) return;
    this.text = text;
    this.of = undefined;
    void this.update();
  }

  /** Computes B again where its units or the records are others now. */
  async update(): Promise<void> {
    const { page, text } = this;
    const of = text === undefined ? "" : JSON.stringify([text, filesOf(page.desk), page.display()]);
    if (of === this.of) {
      this.draw();
      return;
    }
    this.of = of;
    const asked = ++this.asked;
    this.wrong = "";
    if (text === undefined) this.done(asked, undefined);
    else {
      // A worker of its own: the page's keeps what it judges.
      const helper = new Helper(page.desk.engine, page.desk.records);
      try {
        const revision = { number: asked, text, set: [], display: page.display(), stepwise: false };
        const answer = await helper.call("analyse", revision);
        const judgement = await helper.call("judge", revision);
        this.done(asked, { answer, judgement });
      } catch (error) {
        if (error instanceof Ended || asked !== this.asked) return;
        this.wrong = error instanceof ModuleError ? error.fault.message : String(error);
        this.done(asked, undefined);
      } finally {
        helper.end();
      }
    }
  }

  private done(asked: number, pinned: Pinned | undefined): void {
    if (asked !== this.asked) return;
    this.pinned = pinned;
    this.draw();
    this.page.changed();
  }

  private pin(): void {
    if (!this.page.state()) return;
    this.keep(this.page.text());
    this.page.say("This setting is kept as B. Change a value and compare.");
  }

  private swap(): void {
    const [now, kept] = [this.page.text(), this.text];
    if (kept === undefined) return;
    this.keep(now);
    this.page.setText(kept);
  }

  /** Draws the line above the picture; anew only where it says something else. */
  draw(): void {
    const { pinned, text, wrong } = this;
    const now = this.page.state();
    const told = pinned && now ? differences(now, pinned.answer.state) : [];
    const shown = JSON.stringify([text === undefined, wrong, pinned?.answer.state.name, pinned?.judgement.certificate.holds, told]);
    if (shown === this.shown) return;
    this.shown = shown;
    const button = (label: string, act: () => void) => h("button", { type: "button", onclick: act }, label);
    if (text === undefined) {
      fill(this.element, button("Pin as B", () => this.pin()), h("span", { class: "drop-hint" }, "Keeps this setting in the pictures, to compare with what you set next."));
      return;
    }
    const more = told.length > MOST_TOLD ? ` and ${told.length - MOST_TOLD} more` : "";
    const failed = pinned?.judgement.certificate.holds === false;
    fill(
      this.element,
      h("p", {}, h("strong", { class: "is-b" }, "B"), " ", pinned ? (told.length > 0 ? `${told.slice(0, MOST_TOLD).join("; ")}${more}.` : "the same setting as now: change a value.") : wrong ? "" : "is being computed.", failed ? " The check of B FAILED: do not use it." : ""),
      wrong && h("p", { class: "fault", role: "alert" }, `B has no answer: ${wrong}`),
      h("span", { class: "actions" }, button("Pin anew", () => this.pin()), button("Swap with B", () => this.swap()), button("Remove B", () => this.keep(undefined))),
    );
  }
}
