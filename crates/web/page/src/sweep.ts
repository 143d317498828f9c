/** How the model's own run follows one of its values: slices of it on several workers. */

import { labelOf } from "./controls";
import { ModuleError, Pool } from "./desk";
import { fill, h } from "./dom";
import { FigureView } from "./figure";
import { handStudy, type Planned, rowsOf } from "./planned";
import { type Page, Progress, Result, subject, type Tab, value } from "./tab";
import type { AxisData, FigureData, SeriesData, Setting, State, Unit } from "./types";

type Style = Pick<SeriesData, "colour" | "width" | "dashes">;
const FIRST: Style = { colour: "#0b3c6f", width: 1.7, dashes: "" };
const SECOND: Style = { colour: "#b3541e", width: 1.7, dashes: "7 3" };

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
  private views: FigureView[] = [];
  private readonly result = new Result();
  private pool: Pool;
  private running = false;
  private of = "";

  constructor(private readonly page: Page) {
    this.pool = new Pool(page.desk.engine, page.desk.records);
    const form = h(
      "form",
      {},
      h("p", { class: "drop-hint" }, "How peaks follow one value of the model, all else as it stands; where that is kinetic friction, static friction keeps its ratio to it. Click in a picture to take the value over."),
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

  restyle(): void {
    for (const view of this.views) view.restyle();
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
    if (this.running) return;
    this.running = true;
    // Of what is wanted, with what was set on it in its text.
    await this.page.desk.rested().finally(() => (this.running = false));
    const state = this.page.state();
    const input = this.input();
    if (!state || !input) return;
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
      this.charts.append(h("div", { class: "actions" }, h("button", { type: "button", onclick: () => void this.everything(text, over) }, "Everything (ZIP)")));
      this.page.say(`The sweep of ${labelOf(input.path)} is done: ${count} runs.`);
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
    const { length, acceleration } = state.units;
    const title = `${labelOf(path)}${symbol ? ` (${symbol})` : ""}`;
    const places = Array.from({ length: count }, (_, i) => rows[6 * i]! / inSi);
    const x: AxisData = { label: title, min: Math.min(...places), max: Math.max(...places), log: false, names: [] };
    const one = (id: string, heading: string, unit: Unit, lines: [label: string, column: number, style: Style][]) => {
      const series = lines.map(([label, column, style]): SeriesData => {
        const points = places.flatMap((place, i) => [place, Math.abs(rows[6 * i + column]!) / unit.in_si]);
        return { label, ...style, shape: "history", fill: "", points };
      });
      const high = Math.max(...series.flatMap(({ points }) => points.filter((_, i) => i % 2 === 1).map((value) => (Number.isFinite(value) ? value! : 0))));
      const y: AxisData = { label: `${heading} (${unit.symbol})`, min: 0, max: high > 0 ? high * 1.06 : 1, log: false, names: [] };
      const over = `${heading} over ${labelOf(path).toLowerCase()}`;
      const figure: FigureData = { id, title: over, layout: "stacked", panels: [{ x, y, height: 230, series, limits: [], peak: null, note: "", marks: [now / inSi] }], shaded: [] };
      const view = new FigureView(figure, { dark: this.page.dark, pick: (value) => this.take(value, state, symbol, inSi, now, path), word: "a click takes the value over" }, h("span", {}, over));
      this.views.push(view);
      this.charts.append(h("div", { class: "card plot" }, view.element));
    };
    this.charts.replaceChildren();
    this.views = [];
    const storeys = state.structure.storeyMasses_kg.length > 0;
    one("sweep-displacement", "Sliding displacement", length, [["peak", 1, FIRST], ["residual, in size", 2, SECOND]]);
    one("sweep-acceleration", "Peak accelerations", acceleration, [["block", 3, FIRST], ...(storeys ? [["roof", 4, SECOND] as [string, number, Style]] : [])]);
  }

  /** The sweep as the command runs it: a study of the model's own motion. */
  private async everything(text: string, over: string): Promise<void> {
    // As they are now.
    const files = new Map(this.page.desk.records);
    const pool = new Pool(this.page.desk.engine, files);
    try {
      const of: Planned = [await pool.call("plan", "sweep", text, [["over", over]]), text, []];
      const rows = await rowsOf(pool, of, () => {});
      handStudy("sweep.zip", of, await pool.call("study", ...of, rows, this.page.display()), files);
    } catch (error) {
      if (error instanceof ModuleError) this.page.fault(error.fault);
    } finally {
      pool.stop();
    }
  }

  /** Takes a value of the axis over into the model. */
  private take(place: number, state: State, symbol: string, inSi: number, now: number, path: string): void {
    const taken = Number(place.toPrecision(3));
    const settings: Setting[] = [[path, symbol ? `${taken} ${symbol}` : String(taken)]];
    if (path === "slider.kinetic_friction") {
      const ratio = (value(state, "slider.static_friction")?.value ?? now) / now;
      settings.unshift(["slider.static_friction", String(Number((taken * inSi * ratio).toPrecision(6)))]);
    }
    this.of = "";
    this.page.set(settings);
  }
}
