/** Lines above the page: what is wrong, what takes long, what was done. */

import { fill, h } from "./dom";

export class Notices {
  /** What is wrong with what was asked for. */
  readonly fault = h("div", { class: "note-bar", role: "alert", hidden: true });
  /** What takes long, and what was done. */
  readonly work = h("div", { class: "note-bar busy", role: "status", hidden: true });
  /** For those who do not see the page. */
  readonly live = h("p", { class: "hidden", role: "status", "aria-live": "polite" });

  private kept = false;

  say(text: string): void {
    this.live.textContent = text;
  }

  /** A line that goes away. */
  tell(text: string): void {
    this.work.hidden = false;
    fill(this.work, h("p", {}, h("code", {}, text)));
    setTimeout(() => (this.work.hidden = true), 4000);
  }

  /** The worker has been silent for long, or speaks again; `replace` gives it up for another. */
  busy(busy: boolean, replace: () => void): void {
    this.work.hidden = !busy;
    if (!busy) return;
    const act = () => {
      replace();
      this.work.hidden = true;
      this.say("Another worker has started; what was shown stays.");
    };
    fill(this.work, h("p", {}, "The analysis has been at work for more than two seconds. What is shown is the last answer."), h("button", { type: "button", onclick: act }, "Start another"));
  }

  /** A message that stays until a person has read it. */
  keep(message: string): void {
    this.wrong(message, undefined);
    this.kept = true;
    this.fault.append(h("button", { type: "button", onclick: () => this.read() }, "Close"));
  }

  private read(): void {
    this.kept = false;
    this.right();
  }

  /** One message; where it has a place in the model's text, `show` goes there. */
  wrong(message: string, show: (() => void) | undefined): void {
    this.kept = false;
    this.fault.hidden = false;
    fill(this.fault, h("p", {}, message), h("span", { class: "drop-hint" }, "The last good state stays."), show && h("button", { type: "button", onclick: show }, "Show the place"));
  }

  /** What is needed before there is an answer, and what gives it. */
  needs(message: string, give: HTMLElement): void {
    this.kept = false;
    this.fault.hidden = false;
    fill(this.fault, h("p", {}, message), give);
  }

  right(): void {
    if (!this.kept) this.fault.hidden = true;
  }
}
