/** Spectrum, IDA, fragility and so on: an analysis over a suite, by the fields of its request. */

import { Ended, Helper, ModuleError } from "./desk";
import { download, fill, h } from "./dom";
import { type Page, Progress, Result, sheetElement, subject, type Tab } from "./tab";
import type { FormField, Setting, Sheet } from "./types";

/** What is typed or chosen in the form for a field. */
type Entry = HTMLInputElement | HTMLSelectElement | HTMLTextAreaElement;

function entry({ name, takes, words, default: usual, start }: FormField): Entry {
  const typed = { name, autocomplete: "off", spellcheck: "false" };
  switch (takes) {
    case "choice":
      return h("select", { name }, ...(usual ? [] : [h("option", { value: "" }, "as it comes")]), ...words.map((word) => h("option", { value: word, selected: word === start }, word)));
    case "flag":
      return h("input", { type: "checkbox", name, value: "true" });
    case "many": {
      const lines = h("textarea", { ...typed, rows: 1 });
      lines.value = start;
      return lines;
    }
    default:
      return h("input", { ...typed, type: "text", value: start });
  }
}

/** What stands in an entry, as text. */
function valueOf(input: Entry): string {
  return input instanceof HTMLInputElement && input.type === "checkbox" ? (input.checked ? input.value : "") : input.value;
}

function setValue(input: Entry, text: string): void {
  if (input instanceof HTMLInputElement && input.type === "checkbox") input.checked = text !== "";
  else input.value = text;
}

/** An analysis over a suite, by the fields of its request. */
export class SuiteTab implements Tab {
  readonly element: HTMLElement;
  private fields: [FormField, Entry][] = [];
  private readonly asked = h("div", {}, h("p", { class: "drop-hint" }, "Loading"));
  private readonly suite = h("ul", { class: "records" });
  private readonly progress = new Progress();
  private readonly result = new Result();
  private wanted: Record<string, string> = {};
  private readonly go = h("button", { type: "submit", class: "main", disabled: true }, "Run");
  private readonly chosen = new Map<string, boolean>();
  private helper: Helper | undefined;
  private opened = false;

  constructor(
    private readonly page: Page,
    readonly id: string,
    readonly label: string,
  ) {
    const form = h(
      "form",
      {},
      this.asked,
      h("fieldset", { class: "group" }, h("legend", {}, "Records"), this.suite),
      h("div", { class: "actions" }, this.go, h("button", { type: "button", onclick: () => void this.exportPlan() }, "Plan (TOML)")),
      this.progress.element,
    );
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      void this.run();
    });
    form.addEventListener("change", () => this.changed());
    this.progress.stop.addEventListener("click", () => this.helper?.end());
    this.element = h("div", { class: "study" }, h("div", { class: "card pad" }, form), this.result.element);
    this.result.show(undefined, h("p", { class: "card empty" }, "Press Run: the records are analysed in a worker of their own, and the page stays free."));
  }

  /** Makes the form; what need not be said stands folded below. */
  private async build(): Promise<void> {
    const { about, fields } = await this.page.desk.helper.call("form", this.id, this.page.text());
    this.fields = fields.map((field) => [field, entry(field)]);
    const label = ([field, input]: [FormField, Entry]) => h("label", { class: "field" }, h("span", {}, field.label), input, h("small", { class: "drop-hint" }, field.about));
    const [first, more] = [this.fields.filter(([field]) => field.start), this.fields.filter(([field]) => !field.start)];
    fill(this.asked, h("p", { class: "drop-hint" }, about), ...first.map(label), more.length > 0 ? h("details", { class: "fold" }, h("summary", {}, "More"), ...more.map(label)) : "");
    this.go.disabled = false;
    this.restore(this.wanted);
    this.update();
  }

  private get subject(): string {
    return subject(this.page, this.options());
  }

  private changed(): void {
    this.update();
    this.page.changed();
  }

  update(): void {
    this.result.check(this.subject);
  }

  settings(): Record<string, string> {
    const left = this.page.records().filter(({ name }) => this.chosen.get(name) === false).map(({ name }) => name);
    const fields = this.fields.flatMap(([{ name, start }, input]) => (valueOf(input) === start ? [] : [[name, valueOf(input)]]));
    return { ...Object.fromEntries(fields), ...(left.length > 0 ? { "without records": left.join("\n") } : {}) };
  }

  restore(settings: Record<string, string>): void {
    this.wanted = settings;
    for (const name of settings["without records"]?.split("\n") ?? []) this.chosen.set(name, false);
    for (const [{ name, start }, input] of this.fields) setValue(input, settings[name] ?? start);
  }

  /** What is said for a field, a line each where it may be repeated. */
  private said([{ takes }, input]: [FormField, Entry]): string[] {
    if (input instanceof HTMLInputElement && input.type === "checkbox") return input.checked ? [input.value] : [];
    const text = input.value.trim();
    return takes === "many" ? text.split("\n").map((line) => line.trim()).filter(Boolean) : [text].filter(Boolean);
  }

  /** What is asked, and of which records; what stands there of itself is not said. */
  private options(): Setting[] {
    const asked = this.fields.flatMap((field) => this.said(field).filter((text) => text !== field[0].default).map((text): Setting => [field[0].name, text]));
    const records = this.records().map((name): Setting => {
      const { units = "", dt = "", channel = "" } = this.page.choice(name);
      return ["records", [name, units, dt, channel].join("\n")];
    });
    return [...asked, ...records];
  }

  private records(): string[] {
    return this.page.records().map((record) => record.name).filter((name) => this.chosen.get(name) ?? true);
  }

  open(): void {
    const state = this.page.state();
    if (!state) return;
    if (!this.opened) {
      this.opened = true;
      void this.build();
    }
    this.update();
    fill(
      this.suite,
      ...this.page.records().map(({ name, label }) => {
        const box = h("input", { type: "checkbox", checked: this.chosen.get(name) ?? true });
        box.addEventListener("change", () => this.chosen.set(name, box.checked));
        return h("li", {}, h("label", { class: "switch" }, box, label));
      }),
    );
  }

  private async run(): Promise<void> {
    const state = this.page.state();
    if (!state || this.helper) return;
    const helper = new Helper(this.page.desk.engine, this.page.desk.records);
    this.helper = helper;
    helper.onprogress = (done, planned) => this.progress.show(done, planned);
    this.progress.begin();
    this.go.disabled = true;
    const of = this.subject;
    try {
      const sheet = await helper.call("assess", this.id, this.page.text(), this.options(), this.page.display());
      this.show(of, sheet);
      this.page.say(`${this.label} is done. ${sheet.verdict[0] ?? sheet.line}`);
    } catch (error) {
      if (error instanceof Ended) this.page.say(`${this.label} was cancelled.`);
      else if (error instanceof ModuleError) this.refuse(error);
    } finally {
      helper.end();
      this.helper = undefined;
      this.progress.end();
      this.go.disabled = false;
    }
  }

  private show(of: string, sheet: Sheet): void {
    this.result.show(
      of,
      sheetElement(sheet),
      h(
        "div",
        { class: "actions" },
        h("button", { type: "button", onclick: () => download(`${this.id}-report.html`, sheet.html, "text/html") }, "report.html"),
        h("button", { type: "button", onclick: () => download(`${this.id}-summary.json`, sheet.json, "application/json") }, "summary.json"),
      ),
    );
    this.update();
  }

  private async exportPlan(): Promise<void> {
    try {
      const plan = await this.page.desk.helper.call("plan", this.id, this.page.text(), this.options());
      download("plan.toml", plan, "application/toml");
    } catch (error) {
      if (error instanceof ModuleError) this.refuse(error);
    }
  }

  private refuse({ fault }: ModuleError): void {
    this.result.show(undefined, h("p", { class: "card pad fault", role: "alert" }, fault.message));
  }
}
