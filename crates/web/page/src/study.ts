/** A dropped plan with its records: slices of it on several workers. */

import { ModuleError, Pool } from "./desk";
import { download, h } from "./dom";
import { Explorer } from "./explore";
import { handStudy, type Planned, rowsOf } from "./planned";
import { type Page, Progress, Result, sheetElement, subject, type Tab } from "./tab";

export class StudyTab implements Tab {
  readonly id = "study";
  readonly label = "Study";
  readonly element: HTMLElement;
  private readonly text = h("textarea", { "aria-label": "Plan", spellcheck: "false", rows: 22 });
  private readonly progress = new Progress((text) => this.page.progress(this.id, text));
  private readonly result = new Result();
  private readonly go = h("button", { type: "button", class: "main" }, "Run");
  private readonly pool: Pool;
  private running = false;
  private views: { restyle(): void }[] = [];

  constructor(private readonly page: Page) {
    this.pool = new Pool(page.desk.engine, page.desk.records);
    this.go.addEventListener("click", () => void this.run());
    this.progress.stop.addEventListener("click", () => this.pool.stop());
    this.text.value = '# Drop a plan of slipstick study here, and its records on the page.\nname  = "Friction over three records"\nmodel = "model.toml"\n\n[records]\nfiles   = ["*.txt"]\nunits   = "g"\ndt      = "0.01 s"\nmeasure = "PGA"\nlevels  = ["0.2 g", "0.4 g"]\n\n[vary]\n"slider.kinetic_friction" = { uniform = [0.03, 0.10] }\n"slider.static_friction"  = { factor_of = "slider.kinetic_friction", values = [1.2] }\n\n[sampling]\nmethod = "sobol"\ncount  = 64\nseed   = 1\n';
    this.element = h(
      "div",
      { class: "study" },
      h("div", { class: "card pad editor" }, h("h2", {}, "Plan"), this.text, h("div", { class: "actions" }, this.go, h("button", { type: "button", onclick: () => download("plan.toml", this.text.value, "application/toml") }, "Plan (TOML)")), this.progress.element),
      this.result.element,
    );
    this.text.addEventListener("change", () => {
      this.update();
      page.changed();
    });
    this.result.show(undefined, h("p", { class: "card empty" }, "A study runs the model of this page, whatever its plan calls it, on the records on this page that its plan names, else on the model's own motion."));
  }

  load(text: string): void {
    this.text.value = text;
  }

  open(): void {
    this.update();
  }

  private get subject(): string {
    return subject(this.page, this.text.value);
  }

  update(): void {
    this.result.check(this.subject);
  }

  restyle(): void {
    for (const view of this.views) view.restyle();
  }

  settings(): Record<string, string> {
    return { plan: this.text.value };
  }

  restore({ plan }: Record<string, string>): void {
    if (plan !== undefined) this.load(plan);
  }

  async run(): Promise<void> {
    if (this.running) return;
    this.running = true;
    this.progress.begin();
    this.go.disabled = true;
    this.text.removeAttribute("aria-invalid");
    try {
      // Of what is wanted, with what was set on it in its text.
      await this.page.desk.rested();
      const asked = this.subject;
      const names = this.page.records().map((record) => record.name);
      // As they are now.
      const files = new Map(this.page.desk.records);
      const of: Planned = [this.text.value, this.page.text(), names];
      const sheet = await this.pool.call("study", ...of, await rowsOf(this.pool, of, (done, count) => this.progress.show(done, count)), this.page.display());
      const runs = new Explorer(sheet.runs, this.id, this.page.dark, "a click shows the run by itself", (_, row) => void this.take(of, row), [/^level$/, /^peak_sliding_displacement_m$/]);
      const { element, views } = sheetElement(sheet, this.page.dark);
      this.views = [...views, runs];
      this.result.show(asked, element, h("div", { class: "card pad" }, runs.element), h("div", { class: "actions" }, h("button", { type: "button", onclick: () => handStudy("study.zip", of, sheet, files) }, "Everything (ZIP)"), h("button", { type: "button", onclick: () => download("study-report.html", sheet.html, "text/html") }, "report.html")));
      this.update();
      this.page.say(`The study is done. ${sheet.verdict[0] ?? sheet.line}`);
    } catch (error) {
      if (error instanceof ModuleError) {
        const { message, source, start, end } = error.fault;
        this.result.show(undefined, h("p", { class: "card pad fault", role: "alert" }, message));
        if (source === "plan.toml" && start !== undefined) {
          this.text.setAttribute("aria-invalid", "true");
          this.text.setSelectionRange(start, end ?? start);
        }
      } else this.page.say("The study was cancelled.");
    } finally {
      this.pool.stop();
      this.running = false;
      this.progress.end();
      this.go.disabled = false;
    }
  }

  private async take(of: Planned, run: number): Promise<void> {
    try {
      this.page.load(await this.page.desk.helper.call("studyRun", ...of, run));
    } catch (error) {
      if (error instanceof ModuleError) this.page.fault(error.fault);
    }
  }
}
