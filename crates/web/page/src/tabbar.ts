/** The tabs and their panels, by pointer and by keyboard. */

import { h } from "./dom";
import type { Tab } from "./tab";

export class TabBar {
  readonly element = h("div", { class: "tabs", role: "tablist", "aria-label": "Analyses" });
  /** The one that is open. */
  tab = "motion";
  private readonly buttons = new Map<string, HTMLElement>();

  constructor(
    private readonly tabs: Tab[],
    panels: HTMLElement,
    /** Told where a person opens one. */
    private readonly onopen: (id: string) => void,
  ) {
    for (const tab of tabs) {
      tab.element.id = `panel-${tab.id}`;
      tab.element.setAttribute("role", "tabpanel");
      tab.element.setAttribute("aria-labelledby", `tab-${tab.id}`);
      const button = h("button", { type: "button", role: "tab", id: `tab-${tab.id}`, "aria-controls": tab.element.id }, tab.label);
      button.addEventListener("click", () => onopen(tab.id));
      this.buttons.set(tab.id, button);
      this.element.append(button);
      panels.append(tab.element);
    }
    this.element.addEventListener("keydown", (event) => {
      const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
      if (step === undefined) return;
      const at = tabs.findIndex((tab) => tab.id === this.tab);
      const next = tabs[(at + step + tabs.length) % tabs.length]!;
      this.onopen(next.id);
      this.buttons.get(next.id)!.focus();
      event.preventDefault();
    });
  }

  /** The one that is open. */
  get open(): Tab {
    return this.tabs.find((tab) => tab.id === this.tab) ?? this.tabs[0]!;
  }

  /** Says beside a tab's name how far it is; nothing where it is at rest. */
  progress(id: string, text: string): void {
    const button = this.buttons.get(id);
    if (!button) return;
    const said = button.querySelector(".running");
    if (text === "") said?.remove();
    else if (said) said.textContent = text;
    else button.append(h("span", { class: "running" }, text));
  }

  /** Tells all that model or records may have changed. */
  update(): void {
    for (const tab of this.tabs) tab.update?.();
  }

  /** Tells all that the ground has become dark or light. */
  restyle(): void {
    for (const tab of this.tabs) tab.restyle?.();
  }

  /** Opens one; the first where there is none of that name. */
  select(id: string): void {
    this.tab = this.buttons.has(id) ? id : this.tabs[0]!.id;
    for (const tab of this.tabs) {
      const on = tab.id === this.tab;
      tab.element.hidden = !on;
      const button = this.buttons.get(tab.id)!;
      button.setAttribute("aria-selected", String(on));
      button.tabIndex = on ? 0 : -1;
      // On a narrow screen the bar scrolls.
      const { offsetLeft: left, offsetWidth: width } = button;
      const { scrollLeft, clientWidth } = this.element;
      if (on && (left < scrollLeft || left + width > scrollLeft + clientWidth)) this.element.scrollLeft = left - (clientWidth - width) / 2;
      if (on) tab.open();
    }
  }
}
