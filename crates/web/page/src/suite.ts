/** Spectrum, IDA, fragility and so on: an analysis over a suite, by the fields of its request. */

import { Ended, Helper, ModuleError } from "./desk";
import { download, fill, h } from "./dom";
import { hand } from "./exports";
import { type Page, Progress, Result, sheetElement, subject, type Tab, value } from "./tab";
import { picker, withUnit } from "./pickers";
import { Explorer } from "./explore";
import type { Workbench } from "./workbench";
import type { Choice, FormField, RunTable, Setting, Sheet, State } from "./types";

/** What is typed or chosen in the form for a field. */
type Entry = HTMLInputElement | HTMLSelectElement | HTMLTextAreaElement;

/** Whether a field is one demand, which is chosen by its name. */
const isDemand = ({ name, takes }: FormField) => name === "demand" && takes === "one";

function entry(field: FormField, demands: Choice[]): Entry {
  const { name, takes, words, default: usual, start } = field;
  const typed = { name, autocomplete: "off", spellcheck: "false" };
  if (isDemand(field)) {
    const select = h("select", { name }, ...demands.map((of) => h("option", { value: of.name }, withUnit(of.title, of.unit.symbol))));
    setValue(select, start);
    return select;
  }
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
  // What an address says and the list lacks stands in it too: what it is of may come, or is refused by its name.
  else if (input instanceof HTMLSelectElement && ![...input.options].some((option) => option.value === text)) input.append(h("option", { value: text, selected: true }, text));
  else input.value = text;
}

/** An analysis over a suite, by the fields of its request. */
export class SuiteTab implements Tab {
  readonly element: HTMLElement;
  private fields: [FormField, Entry][] = [];
  private readonly asked = h("div", {}, h("p", { class: "drop-hint" }, "Loading"));
  private readonly suite = h("div", {});
  private readonly progress = new Progress((text) => this.page.progress(this.id, text));
  private readonly result = new Result();
  private views: { restyle(): void }[] = [];
  private wanted: Record<string, string> = {};
  private readonly go = h("button", { type: "submit", class: "main", disabled: true }, "Run");
  private helper: Helper | undefined;
  /** Model and units that the form is of. */
  private formOf: string | undefined;
  /** What the form says, which is often the same for another model. */
  private made = "";
  /** The field whose value cannot be, and what says so. */
  private wrong: [Entry, HTMLElement] | undefined;

  constructor(
    private readonly page: Page,
    readonly id: string,
    readonly label: string,
    private readonly bench: Workbench,
  ) {
    const form = h(
      "form",
      {},
      this.asked,
      this.suite,
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

  /** Makes the form of the model, which stays where it is of another; what need not be said stands folded below. */
  private async build(): Promise<void> {
    const [text, display] = [this.page.text(), this.page.display()];
    const of = this.asksFor;
    this.formOf = of;
    let form;
    try {
      form = await this.page.desk.helper.call("form", this.id, text, display);
    } catch {
      // It is asked for again where the tab is opened again.
      if (this.formOf === of) this.formOf = undefined;
      return;
    }
    const made = JSON.stringify(form);
    if (this.formOf !== of || this.made === made) return;
    this.made = made;
    this.wanted = this.settings();
    const { about, fields, demands } = form;
    this.right();
    this.fields = fields.map((field) => [field, entry(field, demands)]);
    const label = ([field, input]: [FormField, Entry]) => h("div", {}, h("label", { class: "field" }, h("span", {}, field.label), input, isDemand(field) ? "" : h("small", { class: "drop-hint" }, field.about)), picker(field, input, { demands, state: this.page.state }));
    const [first, more] = [this.fields.filter(([field]) => field.start), this.fields.filter(([field]) => !field.start)];
    fill(this.asked, h("p", { class: "drop-hint" }, about), ...first.map(label), more.length > 0 ? h("details", { class: "fold" }, h("summary", {}, "More"), ...more.map(label)) : "");
    this.go.disabled = false;
    this.restore(this.wanted);
    this.update();
    if (!this.element.hidden) this.stand();
  }

  /** What the form is asked for of. */
  private get asksFor(): string {
    return JSON.stringify([this.page.text(), this.page.display()]);
  }

  private get subject(): string {
    return subject(this.page, this.options());
  }

  private changed(): void {
    this.update();
    this.stand();
    this.page.changed();
  }

  update(): void {
    this.result.check(this.subject);
  }

  restyle(): void {
    for (const view of this.views) view.restyle();
  }

  settings(): Record<string, string> {
    // What an address says stands until there is a form.
    if (this.fields.length === 0) return this.wanted;
    const left = this.bench.without();
    const fields = this.fields.flatMap(([{ name, start }, input]) => (valueOf(input) === start ? [] : [[name, valueOf(input)]]));
    return { ...Object.fromEntries(fields), ...(left.length > 0 ? { "without records": left.join("\n") } : {}) };
  }

  restore(settings: Record<string, string>): void {
    this.wanted = settings;
    const left = settings["without records"]?.split("\n") ?? [];
    if (left.length > 0) this.bench.leave(left);
    for (const [{ name, formerly, start }, input] of this.fields) setValue(input, settings[name] ?? settings[formerly] ?? start);
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
    return this.bench.names();
  }

  open(): void {
    const state = this.page.state();
    if (!state) return;
    // What there is to choose from is of the model, in the units of the page.
    if (this.formOf !== this.asksFor) void this.build();
    this.update();
    this.stand();
  }

  /** The records stand here, with factors to what is asked here. */
  private stand(): void {
    const of = (name: string) => this.fields.find(([field]) => field.name === name)?.[1];
    const said = (name: string) => of(name)?.value ?? "";
    this.bench.stand(this.suite, { measure: said("measure") || "PGA", level: said("scale-to") });
  }

  private async run(): Promise<void> {
    if (this.helper) return;
    const helper = new Helper(this.page.desk.engine, this.page.desk.records);
    this.helper = helper;
    this.right();
    helper.onprogress = (done, planned) => this.progress.show(done, planned);
    this.progress.begin();
    this.go.disabled = true;
    try {
      // Of what is wanted, with what was set on it in its text.
      await this.page.desk.rested();
      const [state, of, text] = [this.page.state(), this.subject, this.page.text()];
      if (!state) return;
      const sheet = await helper.call("assess", this.id, text, this.options(), this.page.display());
      this.show(of, text, state, sheet);
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

  private show(of: string, text: string, state: State, sheet: Sheet): void {
    // As they were when it was run.
    const { records } = this.page.desk;
    const files = sheet.records.map(({ path, text }) => [path, text ?? records.get(path) ?? records.get(path.replace(/^.*[/\\]/, "")) ?? ""]);
    const { element, views } = sheetElement(sheet, this.page.dark);
    const explorer = this.explorer(state, sheet);
    this.views = explorer ? [...views, explorer] : views;
    this.result.show(
      of,
      element,
      ...(explorer ? [h("div", { class: "card pad" }, explorer.element)] : []),
      h(
        "div",
        { class: "actions" },
        h("button", { type: "button", onclick: () => hand(`${this.id}.zip`, sheet.commands, ["model.toml", text], records, Object.fromEntries(files), { "summary.json": sheet.json, "report.html": sheet.html }) }, "Everything (ZIP)"),
        h("button", { type: "button", onclick: () => download(`${this.id}-report.html`, sheet.html, "text/html") }, "report.html"),
        h("button", { type: "button", onclick: () => download(`${this.id}-summary.json`, sheet.json, "application/json") }, "summary.json"),
      ),
    );
    this.update();
  }

  /** The runs, each of which can be shown by itself; of a design its keys are taken over. */
  private explorer(state: State, sheet: Sheet): Explorer | undefined {
    // Derivatives are no runs.
    if (this.id === "sensitivity") return undefined;
    const enough = sheet.runs.filter(({ columns }) => columns.filter(({ values }) => values.some((value) => typeof value === "number")).length > 1);
    const tables = this.id === "spectrum" ? [...enough].reverse() : enough;
    if (tables.length === 0) return undefined;
    const demand = this.options().find(([name]) => name === "demand")?.[1] ?? "peak_sliding_displacement_m";
    const axes: Record<string, [RegExp, RegExp]> = { ida: [new RegExp(`^${demand}$`), /^level$/], fragility: [new RegExp(`^${demand}$`), /^level$/], design: [/displacement_m$/, /acceleration_m_per_s2$/], suite: [/^peak_sliding_displacement_m/, /^(storey\d+_|block\.)peak_acceleration/] };
    const coupled = this.options().some(([name]) => name === "friction");
    const take = (table: RunTable, row: number) => this.take(state, coupled, sheet, table, row);
    const word = this.id === "design" ? "a click uses this design" : "a click shows the run by itself";
    return new Explorer(tables, this.id, this.page.dark, word, take, axes[this.id] ?? [/^(?!)/, /^peak_sliding_displacement_m/]);
  }

  private take(state: State, coupled: boolean, sheet: Sheet, { columns }: RunTable, row: number): void {
    const cell = (name: string) => columns.find((column) => column.name === name)?.values[row];
    const name = cell("record");
    const stem = (path: string) => path.replace(/^.*\//, "").replace(/\.[^.]*$/, "");
    const file = sheet.records.find(({ path }) => path === name || stem(path) === name)?.file;
    const known = this.page.records().find((record) => record.name === file);
    const set = columns.flatMap(({ name, si, path, values }): Setting[] => {
      const number = values[row];
      if (!path || typeof number !== "number") return [];
      if (name === "isolator.period") {
        const rate = number / (2 * Math.PI);
        return [["slider.radius", `${(value(state, "analysis.gravity")?.value ?? 9.80665) * rate * rate} m`]];
      }
      const own: Setting = [name, si ? `${number} ${si}` : String(number)];
      const [kinetic, still] = ["slider.kinetic_friction", "slider.static_friction"].map((path) => value(state, path)?.value);
      return coupled && name === "slider.kinetic_friction" && kinetic && still ? [["slider.static_friction", String(number * (still / kinetic))], own] : [own];
    });
    const scale = cell("scale");
    this.page.load({ record: known ? known.name : null, scale: typeof scale === "number" ? scale : 1, friction: String(cell("friction") ?? "nominal"), set });
  }

  private async exportPlan(): Promise<void> {
    try {
      const plan = await this.page.desk.helper.call("plan", this.id, this.page.text(), this.options());
      download("plan.toml", plan, "application/toml");
    } catch (error) {
      if (error instanceof ModuleError) this.page.fault(error.fault);
    }
  }

  /** Says what is wrong, at the field that it is of where the message begins with its label. */
  private refuse({ fault }: ModuleError): void {
    const said = h("p", { class: "fault", role: "alert" }, fault.message);
    const of = this.fields.find(([{ label }]) => fault.message.startsWith(`${label}: `))?.[1];
    if (!of) {
      said.classList.add("card", "pad");
      this.result.show(undefined, said);
      return;
    }
    of.setAttribute("aria-invalid", "true");
    of.closest("details")?.setAttribute("open", "");
    this.wrong = [of, said];
    of.closest(".field")?.after(said);
    said.scrollIntoView({ block: "nearest" });
  }

  private right(): void {
    if (!this.wrong) return;
    const [of, said] = this.wrong;
    of.removeAttribute("aria-invalid");
    said.remove();
    this.wrong = undefined;
  }
}
