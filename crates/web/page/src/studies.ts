/** The tabs over many runs: sweep, spectrum, IDA, fragility, design, study. */

import uPlot from "uplot";
import { type Desk, Ended, Helper, ModuleError, Pool } from "./desk";
import { download, drawing, fill, h } from "./dom";
import type { RecordChoice } from "./motion";
import { warningList } from "./results";
import type { Palette } from "./scene";
import type { Display, Fault, Setting, Sheet, State } from "./types";

/** What the tabs need of the page. */
export interface Page {
  desk: Desk;
  state: () => State | undefined;
  display: () => Display;
  colours: () => Palette;
  /** Names of all records, with their words. */
  records: () => { name: string; label: string }[];
  /** What a record's file does not say. */
  choice: (name: string) => RecordChoice;
  /** The model's text. */
  text: () => string;
  set: (settings: Setting[]) => void;
  say: (text: string) => void;
  fault: (fault: Fault) => void;
}

interface Field {
  name: string;
  label: string;
  value: (state: State) => string;
  hint?: string;
}

export interface Tab {
  readonly id: string;
  readonly label: string;
  readonly element: HTMLElement;
  open(): void;
}

/** Progress with a button that ends the work. */
class Progress {
  private readonly bar = h("progress", { max: 1, value: 0, "aria-label": "Progress" });
  private readonly words = h("span", { role: "status" });
  readonly stop = h("button", { type: "button" }, "Cancel");
  readonly element = h("div", { class: "progress", hidden: true }, this.bar, h("div", { class: "actions" }, this.words, this.stop));
  private started = 0;

  begin(): void {
    this.started = performance.now();
    this.element.hidden = false;
    this.bar.removeAttribute("value");
    this.words.textContent = "Starting";
  }

  show(done: number, of: number): void {
    if (of > 0) this.bar.value = Math.min(1, done / of);
    const left = ((performance.now() - this.started) / Math.max(1, done)) * Math.max(0, of - done);
    this.words.textContent = of > 0 ? `${done} of ${of} runs, ${(left / 1000).toFixed(0)} s left` : `${done} runs`;
  }

  end(): void {
    this.element.hidden = true;
  }
}

export function sheetElement(sheet: Sheet): HTMLElement {
  const table = ({ heading, rows }: Sheet["tables"][number]) => {
    const [head = [], ...body] = rows;
    const cell = (text: string, i: number) => h("td", { class: i > 0 ? "number" : "" }, text);
    return [
      h("h3", {}, heading),
      h(
        "div",
        { class: "table-scroll", tabindex: 0, role: "region", "aria-label": heading },
        h(
          "table",
          {},
          h("thead", {}, h("tr", {}, ...head.map((text, i) => h("th", { scope: "col", class: i > 0 ? "number" : "" }, text)))),
          h("tbody", {}, ...body.map((row) => h("tr", {}, ...row.map((text, i) => (i === 0 ? h("th", { scope: "row" }, text) : cell(text, i)))))),
        ),
      ),
    ];
  };
  const figure = (drawn: Sheet["figures"][number]) =>
    h(
      "figure",
      {},
      drawing(drawn.svg, drawn.caption),
      h("figcaption", {}, drawn.caption, " ", h("button", { type: "button", onclick: () => download(`${drawn.id}.svg`, drawn.svg, "image/svg+xml") }, "SVG")),
    );
  const [first, ...others] = sheet.figures;
  return h(
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
}

const value = (state: State, path: string) => state.inputs.find((input) => input.path === path);
const friction = (state: State) => value(state, "slider.kinetic_friction")?.value ?? 0.05;
const span = (state: State) => `${Number((friction(state) * 0.4).toPrecision(2))}..${Number((friction(state) * 2).toPrecision(2))}`;

/** An analysis over a suite, by the options of its command. */
class SuiteTab implements Tab {
  readonly element: HTMLElement;
  private readonly fields = new Map<string, HTMLInputElement>();
  private readonly suite = h("ul", { class: "records" });
  private readonly progress = new Progress();
  private readonly result = h("div", {});
  private readonly go = h("button", { type: "submit", class: "main" }, "Run");
  private readonly chosen = new Map<string, boolean>();
  private helper: Helper | undefined;
  private opened = false;

  constructor(
    private readonly page: Page,
    readonly id: string,
    readonly label: string,
    about: string,
    private readonly wanted: Field[],
    private readonly plan: ((tab: SuiteTab, state: State) => string) | null = null,
  ) {
    const form = h("form", {}, h("p", { class: "drop-hint" }, about));
    for (const field of wanted) {
      const input = h("input", { type: "text", name: field.name, autocomplete: "off", spellcheck: "false" });
      this.fields.set(field.name, input);
      form.append(h("label", { class: "field" }, h("span", {}, field.label), input, field.hint ? h("small", { class: "drop-hint" }, field.hint) : ""));
    }
    form.append(
      h("fieldset", { class: "group" }, h("legend", {}, "Records"), this.suite),
      h("div", { class: "actions" }, this.go, this.plan ? h("button", { type: "button", onclick: () => this.exportPlan() }, "Plan (TOML)") : ""),
      this.progress.element,
    );
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      void this.run();
    });
    this.progress.stop.addEventListener("click", () => this.helper?.end());
    this.element = h("div", { class: "study" }, h("div", { class: "card pad" }, form), this.result);
    fill(this.result, h("p", { class: "card empty" }, "Press Run: the records are analysed in a worker of their own, and the page stays free."));
  }

  option(name: string): string {
    return this.fields.get(name)?.value.trim() ?? "";
  }

  records(): string[] {
    return this.page.records().map((record) => record.name).filter((name) => this.chosen.get(name) ?? true);
  }

  open(): void {
    const state = this.page.state();
    if (!state) return;
    if (!this.opened) {
      this.opened = true;
      for (const field of this.wanted) this.fields.get(field.name)!.value = field.value(state);
    }
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
    const options: Setting[] = [
      ...this.wanted.map((field): Setting => [field.name, this.option(field.name)]),
      ...this.records().map((name): Setting => {
        const { units = "", dt = "", channel = "" } = this.page.choice(name);
        return ["records", [name, units, dt, channel].join("\n")];
      }),
    ];
    try {
      const sheet = await helper.call("assess", this.id, this.page.text(), options, this.page.display());
      this.show(sheet);
      this.page.say(`${this.label} is done. ${sheet.verdict[0] ?? sheet.line}`);
    } catch (error) {
      if (error instanceof Ended) this.page.say(`${this.label} was cancelled.`);
      else if (error instanceof ModuleError) {
        fill(this.result, h("p", { class: "card pad fault", role: "alert" }, error.fault.message));
      }
    } finally {
      helper.end();
      this.helper = undefined;
      this.progress.end();
      this.go.disabled = false;
    }
  }

  private show(sheet: Sheet): void {
    fill(
      this.result,
      sheetElement(sheet),
      h(
        "div",
        { class: "actions" },
        h("button", { type: "button", onclick: () => download(`${this.id}-report.html`, sheet.html, "text/html") }, "report.html"),
        h("button", { type: "button", onclick: () => download(`${this.id}-summary.json`, sheet.json, "application/json") }, "summary.json"),
      ),
    );
  }

  private exportPlan(): void {
    const state = this.page.state();
    if (state && this.plan) download("plan.toml", this.plan(this, state), "application/toml");
  }
}

/** A plan for `slipstick study` of what a tab varies. */
function planOf(tab: SuiteTab, state: State): string {
  const files = tab.records().map((name) => JSON.stringify(name)).join(", ");
  const lines = [`name = ${JSON.stringify(state.name)}`, 'model = "model.toml"', "", "[records]", `files = [${files}]`, 'units = "g"', 'dt = "0.01 s"'];
  const list = (text: string): string | null => {
    const range = /^\s*([\d.eE+-]+)\s*\.\.\s*([\d.eE+-]+)\s*([^:]*?)\s*:\s*(\d+)\s*(log)?\s*$/.exec(text);
    if (range) {
      const [, from, to, unit, count, log] = range;
      const end = (number: string) => (unit ? JSON.stringify(`${number} ${unit}`) : number);
      return `${log ? "logspace" : "linspace"} = [${end(from!)}, ${end(to!)}, ${count}]`;
    }
    const parts = text.split(",").map((part) => part.trim()).filter(Boolean);
    const unit = /[^\d.eE+\s-].*$/.exec(parts.at(-1) ?? "")?.[0] ?? "";
    return parts.length > 0 ? `values = [${parts.map((part) => (unit ? JSON.stringify(/[^\d.eE+\s-]/.test(part) ? part : `${part} ${unit}`) : part)).join(", ")}]` : null;
  };
  const [measure, levels, level] = [tab.option("measure"), tab.option("levels"), tab.option("level")];
  if (measure && level) lines.push(`measure = ${JSON.stringify(measure)}`, `levels = [${JSON.stringify(level)}]`);
  else if (measure && levels) {
    const range = /^\s*([\d.]+)\s*\.\.\s*([\d.]+)\s*([^:]*?)\s*:\s*(\d+)\s*$/.exec(levels);
    const count = Number(range?.[4] ?? 0);
    const values = range
      ? Array.from({ length: count }, (_, i) => `${Number((Number(range[1]) + ((Number(range[2]) - Number(range[1])) * i) / Math.max(1, count - 1)).toPrecision(6))} ${range[3]}`)
      : levels.split(",").map((part) => part.trim());
    lines.push(`measure = ${JSON.stringify(measure)}`, `levels = [${values.map((text) => JSON.stringify(text.trim())).join(", ")}]`);
  } else lines.push("scale = [1.0]");
  const varied: string[] = [];
  const frictionText = tab.option("friction");
  const ratio = (value(state, "slider.static_friction")?.value ?? 1) / friction(state);
  if (frictionText) {
    varied.push(`"slider.kinetic_friction" = { ${list(frictionText)} }`);
    varied.push(`"slider.static_friction" = { factor_of = "slider.kinetic_friction", values = [${Number(ratio.toPrecision(12))}] }`);
  }
  for (const text of [tab.option("vary"), tab.option("over")]) {
    const [path, values] = [text.slice(0, text.indexOf("=")).trim(), text.slice(text.indexOf("=") + 1)];
    if (text.includes("=") && path !== "isolator.period") varied.push(`${JSON.stringify(path)} = { ${list(values)} }`);
  }
  if (varied.length > 0) lines.push("", "[vary]", ...varied, "", "[sampling]", 'method = "grid"');
  return `${lines.join("\n")}\n`;
}

/** How the model's own run follows one of its values: slices of it on several workers. */
class SweepTab implements Tab {
  readonly id = "sweep";
  readonly label = "Sweep";
  readonly element: HTMLElement;
  private readonly path = h("select", {});
  private readonly from = h("input", { type: "text", inputmode: "decimal" });
  private readonly to = h("input", { type: "text", inputmode: "decimal" });
  private readonly count = h("input", { type: "text", inputmode: "numeric", value: "200" });
  private readonly progress = new Progress();
  private readonly go = h("button", { type: "submit", class: "main" }, "Run");
  private readonly charts = h("div", { class: "plots" });
  private pool: Pool;
  private running = false;
  private of = "";

  constructor(private readonly page: Page) {
    this.pool = new Pool(page.desk.engine, page.desk.records);
    const form = h(
      "form",
      {},
      h("p", { class: "drop-hint" }, "How peaks follow one value of the model, all else as it stands. Click in a picture to take the value over."),
      h("label", { class: "field" }, h("span", {}, "Value"), this.path),
      h("label", { class: "field" }, h("span", {}, "From"), this.from),
      h("label", { class: "field" }, h("span", {}, "To"), this.to),
      h("label", { class: "field" }, h("span", {}, "Number of runs"), this.count),
      h("div", { class: "actions" }, this.go),
      this.progress.element,
    );
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      void this.run();
    });
    this.path.addEventListener("change", () => {
      this.ends();
      void this.run();
    });
    this.progress.stop.addEventListener("click", () => this.pool.stop());
    this.element = h("div", { class: "study" }, h("div", { class: "card pad" }, form), this.charts);
  }

  open(): void {
    const state = this.page.state();
    if (!state) return;
    const numbers = state.inputs.filter((input) => typeof input.value === "number" && input.value !== 0 && !/^(block\.width|block\.height|storey\.\d+\.height|slider\.bounds|analysis|motion\.(dt|units))/.test(input.path));
    const before = this.path.value || "slider.kinetic_friction";
    fill(this.path, ...numbers.map((input) => h("option", { value: input.path, selected: input.path === before }, input.path)));
    if (!this.from.value) this.ends();
    if (this.of !== this.key()) void this.run();
  }

  private key(): string {
    return `${this.page.text()}|${this.page.display()}|${this.path.value}|${this.from.value}|${this.to.value}|${this.count.value}`;
  }

  private input() {
    return this.page.state()?.inputs.find((input) => input.path === this.path.value);
  }

  private ends(): void {
    const input = this.input();
    if (!input || typeof input.value !== "number") return;
    const shown = input.value / (input.in_si ?? 1);
    const write = (number: number) => `${Number(number.toPrecision(2))}${input.symbol ? ` ${input.symbol}` : ""}`;
    this.from.value = write(shown * 0.25);
    this.to.value = write(shown * 2.5);
  }

  async run(): Promise<void> {
    const state = this.page.state();
    const input = this.input();
    if (!state || !input || this.running) return;
    const count = Number(this.count.value);
    if (!(Number.isInteger(count) && count >= 2 && count <= 100_000)) {
      fill(this.charts, h("p", { class: "card pad fault", role: "alert" }, `Number of runs: expected 2 to 100000, found "${this.count.value}"`));
      return;
    }
    this.of = this.key();
    const text = this.page.text();
    const unit = /[^\d.eE+\s−-].*$/.exec(this.to.value)?.[0] ?? "";
    const bare = (text: string) => text.replace("−", "-").replace(unit, "").trim();
    const over = `${input.path}=${bare(this.from.value)}..${bare(this.to.value)} ${unit}:${count}`;
    this.running = true;
    this.go.disabled = true;
    this.progress.begin();
    const rows = new Float64Array(6 * count).fill(Number.NaN);
    let done = 0;
    try {
      await this.pool.slices(count, 25, async (helper, from, to) => {
        const slice = await helper.call("sweep", text, over, from, to);
        rows.set(slice, 6 * from);
        done += to - from;
        this.progress.show(done, count);
      });
      this.show(rows, state, input.symbol ?? "", input.in_si ?? 1, input.value ?? 0, input.path);
      this.page.say(`The sweep of ${input.path} is done: ${count} runs.`);
    } catch (error) {
      this.pool.stop();
      this.of = "";
      if (error instanceof ModuleError) fill(this.charts, h("p", { class: "card pad fault", role: "alert" }, error.fault.message));
      else this.page.say("The sweep was cancelled.");
    } finally {
      this.running = false;
      this.go.disabled = false;
      this.progress.end();
    }
  }

  private show(rows: Float64Array, state: State, symbol: string, inSi: number, now: number, path: string): void {
    const count = rows.length / 6;
    const column = (k: number, unit: number, absolute = false) =>
      Array.from({ length: count }, (_, i) => {
        const v = rows[6 * i + k]! / unit;
        return Number.isFinite(v) ? (absolute ? Math.abs(v) : v) : null;
      });
    const x = column(0, inSi) as number[];
    const { length, acceleration } = state.units;
    const colour = this.page.colours();
    const one = (title: string, unit: string, lines: [string, string, (number | null)[]][]) => {
      const box = h("div", { class: "chart" });
      const key = h(
        "ul",
        { class: "key" },
        ...lines.map(([label, stroke]) => {
          const item = h("li", {}, label);
          item.style.setProperty("--swatch", stroke);
          return item;
        }),
      );
      const card = h("div", { class: "card plot" }, h("header", {}, h("h2", {}, title), key), box);
      this.charts.append(card);
      const axis = { stroke: colour.quiet!, grid: { stroke: colour.line!, width: 1 }, ticks: { stroke: colour.line!, width: 1, size: 4 }, font: "12px system-ui, sans-serif", labelFont: "12px system-ui, sans-serif" };
      const plot = new uPlot(
        {
          width: Math.max(260, box.clientWidth),
          height: 240,
          padding: [10, 14, 0, 0],
          legend: { show: false },
          cursor: { sync: { key: "sweep" }, y: false, drag: { x: false, y: false } },
          scales: { x: { time: false }, y: { range: (_, low, high) => [Math.min(0, low ?? 0), (high ?? 1) * 1.06] } },
          axes: [
            { ...axis, label: `${path}${symbol ? ` (${symbol})` : ""}`, labelSize: 18, size: 30 },
            { ...axis, label: unit, labelSize: 16, size: 58 },
          ],
          series: [{}, ...lines.map(([label, stroke]) => ({ label, stroke, width: 1.7, pxAlign: 0, points: { show: false } }))],
          hooks: {
            draw: [
              (plot) => {
                const at = plot.valToPos(now / inSi, "x", true);
                const c = plot.ctx;
                c.save();
                c.strokeStyle = colour.slide!;
                c.lineWidth = 2;
                c.setLineDash([6, 4]);
                c.beginPath();
                c.moveTo(at, plot.bbox.top);
                c.lineTo(at, plot.bbox.top + plot.bbox.height);
                c.stroke();
                c.restore();
              },
            ],
          },
        },
        [x, ...lines.map(([, , values]) => values)] as uPlot.AlignedData,
        box,
      );
      plot.over.addEventListener("click", () => {
        const left = plot.cursor.left ?? -1;
        if (left < 0) return;
        const taken = Number(plot.posToVal(left, "x").toPrecision(3));
        const settings: Setting[] = [[path, symbol ? `${taken} ${symbol}` : String(taken)]];
        if (path === "slider.kinetic_friction") {
          const ratio = (value(state, "slider.static_friction")?.value ?? now) / now;
          settings.unshift(["slider.static_friction", String(Number((taken * ratio).toPrecision(6)))]);
        }
        this.of = "";
        this.page.set(settings);
      });
      new ResizeObserver(() => {
        const width = box.clientWidth;
        if (width > 0 && Math.abs(width - plot.width) > 1) plot.setSize({ width, height: 240 });
      }).observe(box);
    };
    this.charts.replaceChildren();
    one(`Sliding displacement over ${path}`, length.symbol, [
      ["peak", colour.stick!, column(1, length.in_si)],
      ["residual, in size", colour.slide!, column(2, length.in_si, true)],
    ]);
    one(`Peak accelerations over ${path}`, acceleration.symbol, [
      ["block", colour.block!, column(3, acceleration.in_si)],
      ...(state.structure.storeyMasses_kg.length > 0 ? [["roof", colour.roof!, column(4, acceleration.in_si)] as [string, string, (number | null)[]]] : []),
    ]);
  }
}

/** A dropped plan with its records. */
export class StudyTab implements Tab {
  readonly id = "study";
  readonly label = "Study";
  readonly element: HTMLElement;
  private readonly text = h("textarea", { "aria-label": "Plan", spellcheck: "false" });
  private readonly progress = new Progress();
  private readonly result = h("div", {});
  private readonly go = h("button", { type: "button", class: "main" }, "Run");
  private readonly pool: Pool;
  private running = false;

  constructor(private readonly page: Page) {
    this.pool = new Pool(page.desk.engine, page.desk.records);
    this.go.addEventListener("click", () => void this.run());
    this.progress.stop.addEventListener("click", () => this.pool.stop());
    this.text.value = '# Drop a plan of slipstick study here, and its records on the page.\nname  = "Friction over three records"\nmodel = "model.toml"\n\n[records]\nfiles   = ["*.txt"]\nunits   = "g"\ndt      = "0.01 s"\nmeasure = "PGA"\nlevels  = ["0.2 g", "0.4 g"]\n\n[vary]\n"slider.kinetic_friction" = { uniform = [0.03, 0.10] }\n"slider.static_friction"  = { factor_of = "slider.kinetic_friction", values = [1.2] }\n\n[sampling]\nmethod = "sobol"\ncount  = 64\nseed   = 1\n';
    this.element = h(
      "div",
      { class: "study" },
      h("div", { class: "card pad editor" }, h("h2", {}, "Plan"), this.text, h("div", { class: "actions" }, this.go, h("button", { type: "button", onclick: () => download("plan.toml", this.text.value, "application/toml") }, "Plan (TOML)")), this.progress.element),
      this.result,
    );
    fill(this.result, h("p", { class: "card empty" }, "A study runs the model of this page, whatever its plan calls it, on the records on this page."));
  }

  load(text: string): void {
    this.text.value = text;
  }

  open(): void {}

  async run(): Promise<void> {
    const state = this.page.state();
    if (!state || this.running) return;
    this.running = true;
    this.progress.begin();
    this.go.disabled = true;
    this.text.removeAttribute("aria-invalid");
    try {
      const names = this.page.records().map((record) => record.name);
      const of: [string, string, string[]] = [this.text.value, this.page.text(), names];
      const sheet = await this.pool.call("study", ...of, await this.rows(...of), this.page.display());
      fill(this.result, sheetElement(sheet), h("div", { class: "actions" }, h("button", { type: "button", onclick: () => download("study-report.html", sheet.html, "text/html") }, "report.html")));
      this.page.say(`The study is done. ${sheet.verdict[0] ?? sheet.line}`);
    } catch (error) {
      if (error instanceof ModuleError) {
        const { message, source, start, end } = error.fault;
        fill(this.result, h("p", { class: "card pad fault", role: "alert" }, message));
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

  /** All rows of a study, in slices on several workers. */
  private async rows(...of: [plan: string, text: string, names: string[]]): Promise<Float64Array> {
    const [count, width] = await this.pool.call("studySize", ...of);
    const rows = new Float64Array(count * width);
    const size = Math.max(1, Math.min(250, Math.ceil(count / (8 * this.pool.size))));
    let done = 0;
    await this.pool.slices(count, size, async (helper, from, to) => {
      rows.set(await helper.call("studyRows", ...of, from, to), from * width);
      done += to - from;
      this.progress.show(done, count);
    });
    return rows;
  }
}

/** All tabs over many runs, in their order. */
export function tabs(page: Page): { all: Tab[]; study: StudyTab } {
  const measure: Field = { name: "measure", label: "Intensity measure", value: () => "PGA", hint: "PGA, PGV, Sa(1.2 s), Sa_avg(0.5 s, 3 s), …" };
  const gap = (state: State) => value(state, "slider.gap")?.text ?? "150 mm";
  const bounds: Field = { name: "bounds", label: "Bounds of friction", value: () => "nominal", hint: "nominal, lower, upper or all" };
  const study = new StudyTab(page);
  const all: Tab[] = [
    new SweepTab(page),
    new SuiteTab(page, "spectrum", "Spectrum", "Fractiles of the demands over a parameter, as slipstick spectrum draws them.", [
      { name: "over", label: "Parameter along the axis", value: () => "isolator.period=1..5 s:30" },
      { name: "friction", label: "Kinetic friction of each group", value: (state) => [0.6, 1, 1.6].map((f) => Number((f * friction(state)).toPrecision(2))).join(", ") },
      measure,
      { name: "level", label: "Records scaled to", value: () => "0.4 g" },
      bounds,
    ], planOf),
    new SuiteTab(page, "ida", "IDA", "Incremental dynamic analysis: demands over intensity, record by record.", [
      measure,
      { name: "levels", label: "Levels", value: () => "0.05..1.2 g:24" },
      { name: "demand", label: "Demand", value: () => "peak_sliding_displacement_m" },
      { name: "to", label: "Limit on the demand", value: gap },
      bounds,
    ], planOf),
    new SuiteTab(page, "fragility", "Fragility", "The probability of passing a limit, fitted to an incremental dynamic analysis over friction.", [
      measure,
      { name: "levels", label: "Levels", value: () => "0.05..1.2 g:24" },
      { name: "friction", label: "Kinetic friction, a design each", value: (state) => `${span(state)}:9` },
      { name: "demand", label: "Demand", value: () => "peak_sliding_displacement_m" },
      { name: "to", label: "Limit on the demand", value: gap },
      bounds,
    ], planOf),
    new SuiteTab(page, "design", "Design", "Friction and radius for a gap: the least floor acceleration that stays within it.", [
      { name: "friction", label: "Kinetic friction", value: (state) => `${span(state)}:20` },
      { name: "vary", label: "Parameter to vary", value: () => "slider.radius=1..5 m:12" },
      measure,
      { name: "level", label: "Records scaled to", value: () => "0.4 g" },
      { name: "gap", label: "Gap", value: gap },
      { name: "probability", label: "Share of the records within it", value: () => "0.9" },
    ], planOf),
    study,
  ];
  return { all, study };
}
