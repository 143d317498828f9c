/** The model's text, with what is wrong in it. */

import { h } from "./dom";

export class Editor {
  readonly element: HTMLDetailsElement;
  private readonly area = h("textarea", { id: "model-text", spellcheck: "false", autocomplete: "off", autocapitalize: "off", wrap: "off", "aria-describedby": "model-fault" });
  private readonly problem = h("p", { id: "model-fault", class: "fault", hidden: true });

  constructor(oninput: (text: string) => void) {
    const label = h("label", { for: this.area.id }, "Model text (TOML)");
    this.element = h("details", { class: "card pad fold editor", open: true }, h("summary", {}, label), this.problem, this.area);
    // A click on the label inside the summary would fold it away.
    label.addEventListener("click", (event) => event.preventDefault());
    this.area.addEventListener("input", () => oninput(this.area.value));
  }

  set text(text: string) {
    if (this.area.value !== text) this.area.value = text;
  }

  right(): void {
    this.problem.hidden = true;
    this.area.removeAttribute("aria-invalid");
  }

  wrong(message: string): void {
    this.area.setAttribute("aria-invalid", "true");
    this.problem.hidden = false;
    this.problem.textContent = message;
  }

  select(start: number, end: number): void {
    this.element.open = true;
    this.area.focus();
    this.area.setSelectionRange(start, end);
  }
}
