/** How the model's own run follows one of its values: slices of it on several workers. */

import uPlot from "uplot";
import { labelOf } from "./controls";
import { ModuleError, Pool } from "./desk";
import { fill, h } from "./dom";
import { type Page, Progress, Result, subject, type Tab, value } from "./tab";
import type { Setting, State } from "./types";

export class SweepTab implements Tab {
  readonly id = "sweep";
  readonly label = "Sweep";
  readonly element: HTMLElement;
  private readonly path = h("select", {});
  private readonly from = h("input", { type: "text", inputmode: "decimal" });
  private readonly to = h("input", { type: "text", inputmode: "decimal" });
  private readonly count = h("input", { type: "text", inputmode: "numeric", value: "200" });
  private readonly progress = new Progress((text) => this.page.progress(this.id, text));
  private readonly go = h("button", { type: "submit", class: "main" }, "Run");
  private readonly charts = h("div", { class: "plots" });
  private readonly result = new Result();
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
    this.element = h("div", { class: "study" }, h("div", { class: "card pad" }, form), this.result.element);
    form.addEventListener("change", () => page.changed());
    this.result.show(undefined, this.charts);
  }

  open(): void {
    const state = this.page.state();
    if (!state) return;
    const numbers = state.inputs.filter((input) => typeof input.value === "number" && input.value !== 0 && !/^(block\.width|block\.height|storey\.\d+\.height|slider\.bounds|analysis|motion\.(dt|units))/.test(input.path));
    const before = this.path.value || "slider.kinetic_friction";
    fill(this.path, ...numbers.map((input) => h("option", { value: input.path, selected: input.path === before }, labelOf(input.path))));
    if (!this.from.value) this.ends();
    this.update();
    if (this.of !== this.key()) void this.run();
  }

  private key(): string {
    return subject(this.page, { display: this.page.display(), ...this.settings() });
  }

  update(): void {
    this.result.check(this.key());
  }

  settings(): Record<string, string> {
    return { path: this.path.value, from: this.from.value, to: this.to.value, count: this.count.value };
  }

  restore({ path, from, to, count }: Record<string, string>): void {
    if (path === undefined) return;
    fill(this.path, h("option", { value: path, selected: true }, path));
    [this.from.value, this.to.value, this.count.value] = [from ?? "", to ?? "", count ?? "200"];
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
      this.result.show(this.of, this.charts);
      this.update();
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
    const one = (heading: string, title: string, unit: string, lines: [string, string, (number | null)[]][]) => {
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
      const card = h("div", { class: "card plot" }, h("header", {}, h("h2", {}, `${heading} over ${labelOf(path).toLowerCase()}`), key), box);
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
            { ...axis, label: `${labelOf(path)}${symbol ? ` (${symbol})` : ""}`, labelSize: 18, size: 30 },
            { ...axis, label: `${title} (${unit})`, labelSize: 18, size: 50 },
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
    one("Sliding displacement", "Sliding", length.symbol, [
      ["peak", colour.stick!, column(1, length.in_si)],
      ["residual, in size", colour.slide!, column(2, length.in_si, true)],
    ]);
    one("Peak accelerations", "Acceleration", acceleration.symbol, [
      ["block", colour.block!, column(3, acceleration.in_si)],
      ...(state.structure.storeyMasses_kg.length > 0 ? [["roof", colour.roof!, column(4, acceleration.in_si)] as [string, string, (number | null)[]]] : []),
    ]);
  }
}
