/** Histories: uPlot with sliding shaded, zoom and cursor shared, the present instant marked. */

import uPlot from "uplot";
import { digits, fill, h } from "./dom";
import { at, knotAt, type Palette } from "./scene";
import type { Beside, Unit } from "./types";

export interface Line {
  label: string;
  colour: string;
  values: Float64Array;
  width?: number;
  dash?: boolean;
}

/** A line on times of its own, drawn behind the others. */
export interface Overlay extends Beside {
  label: string;
  colour: string;
  dash?: boolean;
  width?: number;
}

export interface Content {
  time: Float64Array;
  lines: Line[];
  overlays?: Overlay[];
  /** Values that are not to be passed. */
  limits?: number[];
  /** What the values are, for the axis. */
  title: string;
  unit: Unit;
}

/** What the charts of a page share. */
export class Clock {
  readonly charts: Chart[] = [];
  /** Intervals in which the block slides, in s. */
  sliding: [number, number][] = [];
  zoomed: [number, number] | null = null;
  onpoint: (time: number) => void = () => {};
  onzoom: (zoomed: boolean) => void = () => {};

  zoom(range: [number, number] | null): void {
    this.zoomed = range;
    for (const chart of this.charts) chart.zoom(range);
    this.onzoom(range !== null);
  }

  now(time: number): void {
    for (const chart of this.charts) chart.now(time);
  }
}

/** Intervals of sliding from the modes at knots, those that touch joined. */
export function intervals(time: Float64Array, mode: Int8Array): [number, number][] {
  const found: [number, number][] = [];
  for (let i = 0; i + 1 < time.length; i++) {
    const [from, to] = [time[i]!, time[i + 1]!];
    if (mode[i] === 0 || to <= from) continue;
    const last = found[found.length - 1];
    if (last && last[1] === from) last[1] = to;
    else found.push([from, to]);
  }
  return found;
}

/** How long the values rest before a chart that is not on the screen is drawn, in ms. */
const LATE_MS = 250;

let sync: uPlot.SyncPubSub | undefined;

export class Chart {
  readonly element = h("div", { class: "card plot" });
  private readonly box = h("div", { class: "chart" });
  private readonly marker = h("div", { class: "now" });
  private readonly key = h("ul", { class: "key" });
  private readonly readout = h("div", { class: "readout" });
  private plot: uPlot | undefined;
  private content: Content | undefined;
  private shape = "";
  private named = "";
  private time = 0;
  /** Whether it is on the screen, or nearly; what it is to show once it is. */
  private seen = true;
  private late: Content | undefined;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(
    private readonly clock: Clock,
    head: (string | Node)[],
    private colours: Palette,
    private readonly height: number,
  ) {
    clock.charts.push(this);
    this.element.append(h("header", {}, ...head, this.key), this.box, this.readout);
    new ResizeObserver(() => this.resize()).observe(this.box);
    const look = ([entry]: IntersectionObserverEntry[]) => {
      this.seen = entry?.isIntersecting ?? true;
      if (this.seen && this.late) this.draw(this.late);
    };
    new IntersectionObserver(look, { rootMargin: "200px" }).observe(this.element);
  }

  restyle(colours: Palette): void {
    this.colours = colours;
    this.shape = "";
    if (this.content) this.show(this.content);
  }

  show(content: Content): void {
    this.content = content;
    this.name(content);
    clearTimeout(this.timer);
    if (this.seen || !this.plot) {
      this.draw(content);
      return;
    }
    // What nobody sees is drawn when somebody does, or when the values rest.
    this.late = content;
    this.timer = setTimeout(() => this.draw(content), LATE_MS);
  }

  private draw(content: Content): void {
    this.late = undefined;
    const { unit } = content;
    const scaled = (values: Float64Array) => {
      if (unit.in_si === 1) return values;
      const out = new Float64Array(values.length);
      for (let i = 0; i < values.length; i++) out[i] = values[i]! / unit.in_si;
      return out;
    };
    const data = [content.time, ...content.lines.map((line) => scaled(line.values))] as unknown as uPlot.AlignedData;
    const shape = JSON.stringify([content.lines.map((l) => [l.label, l.colour, l.width, l.dash]), content.title, unit.symbol]);
    if (shape !== this.shape || !this.plot) {
      this.shape = shape;
      this.make(data);
    } else {
      this.plot.setData(data, false);
      this.plot.setScale("x", this.range());
    }
  }

  /** Names its lines. */
  private name(content: Content): void {
    const keys = [...content.lines, ...(content.overlays ?? [])];
    const named = JSON.stringify(keys.map(({ label, colour, dash }) => [label, colour, dash]));
    if (named === this.named) return;
    this.named = named;
    fill(
      this.key,
      ...keys.map((line) => {
        const item = h("li", { class: line.dash ? "dash" : "" }, line.label);
        item.style.setProperty("--swatch", line.colour);
        return item;
      }),
      h("li", { class: "band" }, "sliding"),
    );
  }

  zoom(range: [number, number] | null): void {
    if (!this.plot || !this.content) return;
    this.plot.setScale("x", range ? { min: range[0], max: range[1] } : this.range());
    this.now(this.time);
  }

  now(time: number): void {
    this.time = time;
    const plot = this.plot;
    if (!plot) return;
    const x = plot.valToPos(time, "x");
    const width = plot.bbox.width / (globalThis.devicePixelRatio || 1);
    this.marker.hidden = !(x >= 0 && x <= width);
    this.marker.style.transform = `translateX(${x}px)`;
  }

  private range(): { min: number; max: number } {
    const zoomed = this.clock.zoomed;
    if (zoomed) return { min: zoomed[0], max: zoomed[1] };
    const times = this.content!.time;
    return { min: times[0] ?? 0, max: times[times.length - 1] ?? 1 };
  }

  /** The values at a time, in words. */
  tell(time: number): void {
    const content = this.content;
    if (!content || content.time.length === 0) return;
    const told = (label: string, value: number) => `${label} ${digits(value / content.unit.in_si, 3)}`;
    const knot = knotAt(content.time, time);
    const beside = (content.overlays ?? []).filter(({ time }) => time.length > 0);
    const values = [...content.lines.map(({ label, values }) => told(label, values[knot]!)), ...beside.map((overlay) => told(overlay.label, at(overlay.time, overlay.s, time)))];
    this.readout.textContent = `${time.toFixed(2)} s: ${values.join(" · ")} ${content.unit.symbol}`;
  }

  private resize(): void {
    const width = this.box.clientWidth;
    if (this.plot && width > 0 && Math.abs(width - this.plot.width) > 1) {
      this.plot.setSize({ width, height: this.height });
      this.now(this.time);
    }
  }

  private make(data: uPlot.AlignedData): void {
    this.plot?.destroy();
    const { lines, title, unit } = this.content!;
    const colour = this.colours;
    const axis = {
      stroke: colour.quiet!,
      grid: { stroke: colour.line!, width: 1 },
      ticks: { stroke: colour.line!, width: 1, size: 4 },
      font: "12px system-ui, sans-serif",
      labelFont: "12px system-ui, sans-serif",
    };
    // Sums of steps are told without their rounding errors.
    const minus = (_: uPlot, splits: number[]) => splits.map((v) => (Math.abs(v) < 1e-6 * Math.abs(splits[1]! - splits[0]!) ? "0" : String(Number(v.toPrecision(8))).replace("-", "−")));
    this.plot = new uPlot(
      {
        width: Math.max(200, this.box.clientWidth),
        height: this.height,
        padding: [8, 12, 0, 0],
        legend: { show: false },
        cursor: { sync: { key: "slipstick", setSeries: false }, y: false, points: { show: false }, drag: { x: true, y: false, dist: 6, setScale: false } },
        scales: { x: { time: false }, y: { range: (_, low, high) => this.bounds(low, high) } },
        axes: [
          { ...axis, size: 26, label: "Time (s)", labelSize: 18, labelGap: -2, values: minus },
          { ...axis, size: 50, label: `${title} (${unit.symbol})`, labelSize: 18, labelGap: 0, values: minus },
        ],
        series: [
          {},
          ...lines.map((line) => ({
            label: line.label,
            stroke: line.colour,
            width: line.width ?? 1.4,
            dash: line.dash ? [6, 4] : undefined,
            points: { show: false },
          })),
        ],
        hooks: {
          drawClear: [(plot) => this.behind(plot)],
          draw: [(plot) => this.limits(plot)],
          setSelect: [
            (plot) => {
              const { left, width } = plot.select;
              if (width < 4) return;
              this.clock.zoom([plot.posToVal(left, "x"), plot.posToVal(left + width, "x")]);
              plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
            },
          ],
          setCursor: [
            (plot) => {
              if (plot.cursor.event && plot.cursor.left !== undefined && plot.cursor.left >= 0) {
                this.clock.onpoint(plot.posToVal(plot.cursor.left, "x"));
              }
            },
          ],
        },
      },
      data,
      this.box,
    );
    sync ??= uPlot.sync("slipstick");
    this.plot.over.append(this.marker);
    // Two clicks show all; a drag shows a part.
    this.plot.over.addEventListener("dblclick", () => this.clock.zoom(null));
    this.plot.setScale("x", this.range());
    this.now(this.time);
  }

  /** The range of values, with what is drawn behind. */
  private bounds(low: number | null, high: number | null): [number, number] {
    let [min, max] = [low ?? 0, high ?? 0];
    const unit = this.content!.unit.in_si;
    for (const overlay of this.content!.overlays ?? []) {
      for (const value of overlay.s) {
        if (value / unit < min) min = value / unit;
        if (value / unit > max) max = value / unit;
      }
    }
    const room = Math.max(max - min, 1e-9) * 0.06;
    return [min - room, max + room];
  }

  /** Shades sliding, and draws what stands beside. */
  private behind(plot: uPlot): void {
    const c = plot.ctx;
    const { left, top, width, height } = plot.bbox;
    const { min = 0, max = 1 } = plot.scales.x!;
    c.save();
    c.beginPath();
    c.rect(left, top, width, height);
    c.clip();
    c.fillStyle = this.colours["slide-soft"]!;
    for (const [from, to] of this.clock.sliding) {
      if (to < min! || from > max!) continue;
      const a = plot.valToPos(from, "x", true);
      c.fillRect(a, top, Math.max(0.7, plot.valToPos(to, "x", true) - a), height);
    }
    const unit = this.content!.unit.in_si;
    for (const overlay of this.content!.overlays ?? []) {
      c.strokeStyle = overlay.colour;
      c.lineWidth = (overlay.width ?? 1.1) * (globalThis.devicePixelRatio || 1);
      c.setLineDash(overlay.dash ? [7, 5] : []);
      c.beginPath();
      let [column, low, high, last] = [NaN, 0, 0, 0];
      for (let i = 0; i < overlay.time.length; i++) {
        const time = overlay.time[i]!;
        if (time < min! || time > max!) continue;
        const x = Math.round(plot.valToPos(time, "x", true));
        const y = plot.valToPos(overlay.s[i]! / unit, "y", true);
        if (x === column) {
          [low, high, last] = [Math.min(low, y), Math.max(high, y), y];
          continue;
        }
        if (Number.isNaN(column)) c.moveTo(x, y);
        else {
          c.lineTo(column, low);
          c.lineTo(column, high);
          c.lineTo(column, last);
          c.lineTo(x, y);
        }
        [column, low, high, last] = [x, y, y, y];
      }
      c.stroke();
      c.setLineDash([]);
    }
    c.restore();
  }

  private limits(plot: uPlot): void {
    const c = plot.ctx;
    const { left, top, width, height } = plot.bbox;
    c.save();
    c.beginPath();
    c.rect(left, top, width, height);
    c.clip();
    c.strokeStyle = this.colours.gap!;
    c.lineWidth = 1.2;
    c.setLineDash([8, 5]);
    for (const limit of this.content!.limits ?? []) {
      const y = plot.valToPos(limit / this.content!.unit.in_si, "y", true);
      c.beginPath();
      c.moveTo(left, y);
      c.lineTo(left + width, y);
      c.stroke();
    }
    c.restore();
  }
}
