/** Drawings of the report, painted to a width and in the colours of the page: data in, SVG out. */

import { fraction, type Tick, ticks } from "./axes";
import type { AxisData, FigureData, PanelData, SeriesData } from "./types";

const NS = "http://www.w3.org/2000/svg";
const FONT = "Helvetica, Arial, 'Liberation Sans', sans-serif";
const [TEXT, SMALL, LINE] = [12, 11, 16];
const [INK, FRAME, GRID, SHADE, RING, MARK] = ["#1a1a1a", "#7a7a7a", "#d4d4d4", "#e6e6e6", "#a3161c", "#b4480a"];

export interface Rect {
  left: number;
  top: number;
  width: number;
  height: number;
}

/** A panel where it was painted. */
export interface Placed {
  panel: PanelData;
  frame: Rect;
  /** The axes as they were shown, a part of their own where it is zoomed. */
  x: AxisData;
  y: AxisData;
}

/** What a panel is zoomed to; nothing where it shows all. */
export type Zoom = { x: [number, number]; y?: [panel: number, low: number, high: number] } | undefined;

/** An element of SVG. */
export function s(tag: string, attributes: Record<string, string | number>, ...children: (Node | string)[]): SVGElement {
  const element = document.createElementNS(NS, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
  element.append(...children);
  return element;
}

/** A colour of print as it stands on a dark ground: light for dark, of the same hue. */
function darkened(colour: string): string {
  const hex = /^#([0-9a-f]{6}|[0-9a-f]{3})$/i.exec(colour)?.[1];
  if (!hex) return colour;
  const wide = hex.length === 3 ? [...hex].map((c) => c + c).join("") : hex;
  const [r, g, b] = [0, 2, 4].map((i) => parseInt(wide.slice(i, i + 2), 16) / 255) as [number, number, number];
  const [high, low] = [Math.max(r, g, b), Math.min(r, g, b)];
  const light = (high + low) / 2;
  const turned = 0.115 + 0.785 * (1 - light);
  if (high === low) return grey(turned);
  const strong = (high - low) / (1 - Math.abs(2 * light - 1));
  const hue = high === r ? ((g - b) / (high - low) + 6) % 6 : high === g ? (b - r) / (high - low) + 2 : (r - g) / (high - low) + 4;
  return `hsl(${Math.round(60 * hue)} ${Math.round(100 * Math.min(strong, 0.75))}% ${Math.round(100 * turned)}%)`;
}

const grey = (light: number) => `#${Math.round(255 * light).toString(16).padStart(2, "0").repeat(3)}`;

/** What turns colours of print into those of a theme. */
export const theme = (dark: boolean) => (dark ? darkened : (colour: string) => colour);

let measuring: CanvasRenderingContext2D | null | undefined;
function widthOf(text: string, size: number): number {
  measuring ??= document.createElement("canvas").getContext("2d");
  if (!measuring) return 0.56 * size * text.length;
  measuring.font = `${size}px ${FONT}`;
  return measuring.measureText(text).width;
}

/** A text cut to a width. */
function cut(text: string, size: number, room: number): string {
  if (widthOf(text, size) <= room) return text;
  let end = text.length;
  while (end > 1 && widthOf(`${text.slice(0, end)}…`, size) > room) end--;
  return `${text.slice(0, end)}…`;
}

/** A text in lines of a width, at its spaces. */
function lines(text: string, size: number, room: number): string[] {
  const found: string[] = [];
  for (const word of text.split(" ")) {
    const last = found[found.length - 1];
    const longer = last === undefined ? word : `${last} ${word}`;
    if (last !== undefined && widthOf(longer, size) <= room) found[found.length - 1] = longer;
    else found.push(word);
  }
  return found.map((line) => cut(line, size, room));
}

/** A drawing as wide as asked for, and where its panels stand. */
export function paint(figure: FigureData, width: number, dark: boolean, zoom?: Zoom): { svg: SVGElement; placed: Placed[]; height: number } {
  const colour = theme(dark);
  const shown = figure.panels.map((panel, i) => {
    const x = zoom ? { ...panel.x, min: zoom.x[0], max: zoom.x[1] } : panel.x;
    const y = zoom?.y?.[0] === i ? { ...panel.y, min: zoom.y[1], max: zoom.y[2] } : panel.y;
    return { panel, x, y, yTicks: ticks(y, Math.max(3, Math.round(panel.height / 34))) };
  });
  const named = Math.max(60, 0.42 * width);
  const margin = (yTicks: Tick[]) => 10 + Math.min(named, Math.max(...yTicks.map(({ text }) => widthOf(text, SMALL)), 26));
  const stacked = figure.layout === "stacked" || width < 560;
  const share = stacked ? width : width / Math.max(1, shown.length);
  const left = stacked ? Math.max(...shown.map(({ yTicks }) => margin(yTicks))) : 0;
  const parts: Node[] = [];
  const placed: Placed[] = [];
  const common = figure.layout === "stacked";
  let top = 0;
  const heads = shown.map(({ panel, yTicks }) => new Head(panel, share - (stacked ? left : margin(yTicks)) - RIGHT));
  const highest = Math.max(...heads.map(({ height }) => height));
  shown.forEach(({ panel, x, y, yTicks }, i) => {
    const own = stacked ? left : margin(yTicks);
    const frameWidth = share - own - RIGHT;
    const head = heads[i]!;
    const frame: Rect = { left: (stacked ? 0 : i * share) + own, top: (stacked ? top + head.height : highest), width: frameWidth, height: figure.layout === "square" ? frameWidth : panel.height };
    const lowest = !common || i + 1 === shown.length;
    const below = lowest ? lines(x.label, TEXT, frameWidth) : [];
    parts.push(...head.paint(frame, colour), ...paintPanel({ panel, frame, x, y }, yTicks, common ? figure.shaded : [], lowest, below, colour));
    placed.push({ panel, frame, x, y });
    const bottom = frame.top + frame.height + (lowest ? 2 + LINE * (1 + below.length) + 4 : 10);
    top = stacked ? bottom : Math.max(top, bottom);
  });
  const height = Math.ceil(top);
  const svg = s("svg", { xmlns: NS, viewBox: `0 0 ${width} ${height}`, width, height, "font-family": FONT, "font-size": TEXT, fill: colour(INK) }, ...parts);
  return { svg, placed, height };
}

/** Space right of a frame: half of the last tick label of the x axis. */
const RIGHT = 18;

/** What stands above a frame: the label of the y axis, the legend, the note. */
class Head {
  readonly height: number;
  private readonly label: string[];
  private readonly rows: { series: SeriesData | undefined; text: string; width: number }[][] = [];

  constructor(panel: PanelData, width: number) {
    this.label = panel.y.label ? lines(panel.y.label, TEXT, width) : [];
    const entries = panel.series
      .filter(({ label, shape }) => label !== "" && shape !== "named")
      .map((series) => ({ series, text: cut(series.label, SMALL, width - 30), width: 30 + 14 + Math.min(width - 30, widthOf(series.label, SMALL)) }));
    const all = panel.note ? [...entries, { series: undefined, text: cut(panel.note, SMALL, width), width: 14 + widthOf(panel.note, SMALL) }] : entries;
    let room = this.label.length === 1 ? width - widthOf(this.label[0]!, TEXT) : this.label.length === 0 ? width : 0;
    this.rows = [[]];
    for (const entry of all) {
      if (entry.width > room) {
        this.rows.push([]);
        room = width;
      }
      room -= entry.width;
      this.rows[this.rows.length - 1]!.push(entry);
    }
    this.height = LINE * (Math.max(this.label.length, 1) + this.rows.length - 1) + 3;
  }

  paint(frame: Rect, colour: (name: string) => string): Node[] {
    const right = frame.left + frame.width;
    const first = frame.top - this.height + 3 + TEXT - 2;
    const found: Node[] = this.label.map((text, i) => s("text", { class: "axis", x: frame.left, y: first + LINE * i }, text));
    const start = first + LINE * (Math.max(this.label.length, 1) - 1);
    this.rows.forEach((row, i) => {
      const y = start + LINE * i;
      let x = right + 14 - row.reduce((sum, { width }) => sum + width, 0);
      for (const { series, text, width } of row) {
        if (!series) found.push(s("text", { x: right, y, "text-anchor": "end", "font-size": SMALL }, text));
        else found.push(...sample(series, x, y - 4, colour), s("text", { x: x + 30, y, "font-size": SMALL }, text));
        x += width;
      }
    });
    return found;
  }
}

function stroke({ colour, width, dashes }: { colour: string; width: number; dashes: string }, to: (name: string) => string): Record<string, string | number> {
  return { fill: "none", stroke: to(colour), "stroke-width": width, "stroke-linejoin": "round", ...(dashes ? { "stroke-dasharray": dashes } : {}) };
}

function sample(series: SeriesData, x: number, y: number, colour: (name: string) => string): Node[] {
  if (series.shape === "dots") return [dot(series, [x + 13, y], colour)];
  if (series.shape === "area" || series.shape === "band") return [s("rect", { x: x + 8, y: y - 4.5, width: 18, height: 9, fill: colour(series.fill), stroke: colour(INK), "stroke-width": 0.6 })];
  return [s("path", { ...stroke(series, colour), d: `M${x} ${y}h26` })];
}

const dot = (series: SeriesData, [x, y]: [number, number], colour: (name: string) => string) =>
  s("circle", { cx: x.toFixed(1), cy: y.toFixed(2), r: (0.8 + 1.6 * series.width).toFixed(1), fill: series.fill === "none" ? "none" : colour(series.fill), stroke: colour(series.colour), "stroke-width": 0.8 });

/** Where a value stands in a frame. */
export const across = ({ frame, x }: Placed, value: number): number => frame.left + frame.width * fraction(x, value);
export const up = ({ frame, y }: Placed, value: number): number => frame.top + frame.height * (1 - fraction(y, value));

function paintPanel(at: Placed, yTicks: Tick[], shaded: [number, number][], labels: boolean, below: string[], colour: (name: string) => string): Node[] {
  const { panel, frame, x, y } = at;
  const bottom = frame.top + frame.height;
  const found: Node[] = [];
  // About every 60 px, and no label on another.
  const widest = Math.max(...ticks(x, 6).map(({ text }) => widthOf(text, SMALL)), 20);
  const xTicks = ticks(x, Math.max(2, Math.floor(frame.width / Math.max(60, widest + 16))));
  const line = (d: string, width: number, name: string, dashes = "") => s("path", { d, ...stroke({ colour: name, width, dashes }, colour) });
  const clip = s("svg", { x: frame.left, y: frame.top, width: frame.width, height: frame.height, viewBox: `${frame.left} ${frame.top} ${frame.width} ${frame.height}` });
  const shade = shaded.map(([from, to]) => [across(at, from), across(at, to)]).filter(([from, to]) => to! >= frame.left && from! <= frame.left + frame.width);
  if (shade.length > 0) clip.append(s("path", { fill: colour(SHADE), d: shade.map(([from, to]) => `M${from!.toFixed(1)} ${frame.top}h${Math.max(0.2, to! - from!).toFixed(1)}v${frame.height}H${from!.toFixed(1)}z`).join("") }));
  const grid = [...xTicks.map(({ value }) => `M${across(at, value).toFixed(1)} ${frame.top}v${frame.height}`), ...yTicks.map(({ value }) => `M${frame.left} ${up(at, value).toFixed(1)}h${frame.width}`)].join("");
  found.push(line(grid, 0.5, GRID), clip);
  for (const { value, text } of yTicks) {
    if (text) found.push(s("text", { class: "tick", x: frame.left - 5, y: up(at, value) + 4, "text-anchor": "end", "font-size": SMALL }, cut(text, SMALL, frame.left - 8)));
  }
  if (!y.log && y.min < 0 && y.max > 0 && y.names.length === 0) found.push(line(`M${frame.left} ${up(at, 0).toFixed(1)}h${frame.width}`, 0.7, FRAME));
  if (labels) {
    let end = -Infinity;
    for (const { value, text } of xTicks) {
      const half = widthOf(text, SMALL) / 2;
      const middle = across(at, value);
      if (!text || middle - half < end) continue;
      end = middle + half + 4;
      found.push(s("text", { class: "tick", x: middle.toFixed(1), y: bottom + LINE, "text-anchor": "middle", "font-size": SMALL }, text));
    }
    below.forEach((text, i) => found.push(s("text", { class: "axis", x: frame.left + frame.width / 2, y: bottom + LINE * (2 + i) + 1, "text-anchor": "middle" }, text)));
  }
  // A point on the edge is whole.
  const over: Node[] = [];
  for (const series of panel.series) {
    const drawn = paintSeries(at, series, colour);
    if (series.shape === "dots") over.push(...drawn);
    else clip.append(...drawn);
  }
  for (const limit of panel.limits) found.push(...paintLimit(at, limit, colour));
  for (const mark of panel.marks ?? []) clip.append(line(`M${across(at, mark).toFixed(1)} ${frame.top}v${frame.height}`, 2, MARK, "6 4"));
  if (panel.peak) clip.append(s("circle", { cx: across(at, panel.peak[0]), cy: up(at, panel.peak[1]), r: 3.2, fill: "none", stroke: colour(RING), "stroke-width": 1.1 }));
  found.push(s("rect", { x: frame.left, y: frame.top, width: frame.width, height: frame.height, fill: "none", stroke: colour(FRAME), "stroke-width": 0.8 }), ...over);
  return found;
}

/** Whether a place is in a frame, or on its edge. */
export const inside = ({ frame }: Placed, [x, y]: [number, number]): boolean => x >= frame.left - 1 && x <= frame.left + frame.width + 1 && y >= frame.top - 1 && y <= frame.top + frame.height + 1;

/** The points of a series in the drawing; a value that is none breaks a line. */
export function points(at: Placed, { points }: SeriesData): ([number, number] | undefined)[] {
  const found: ([number, number] | undefined)[] = [];
  for (let i = 0; i + 1 < points.length; i += 2) {
    const [x, y] = [points[i], points[i + 1]];
    found.push(typeof x === "number" && typeof y === "number" && Number.isFinite(x) && Number.isFinite(y) ? [across(at, x), up(at, y)] : undefined);
  }
  return found;
}

/** A path along points; of many that share a column of the screen the first, the extremes and the last. */
function path(placed: ([number, number] | undefined)[]): string {
  const kept: ([number, number] | undefined)[] = [];
  const thin = placed.length > 2000;
  for (let i = 0; i < placed.length; ) {
    const point = placed[i];
    let end = i + 1;
    if (point && thin) while (end < placed.length && placed[end] && Math.floor(placed[end]![0] * 2) === Math.floor(point[0] * 2)) end++;
    if (end - i <= 4) kept.push(...placed.slice(i, end));
    else {
      let [low, high] = [i, i];
      for (let k = i; k < end; k++) {
        if (placed[k]![1] < placed[low]![1]) low = k;
        if (placed[k]![1] > placed[high]![1]) high = k;
      }
      kept.push(...[...new Set([i, low, high, end - 1])].sort((a, b) => a - b).map((k) => placed[k]));
    }
    i = end;
  }
  let from = true;
  return kept
    .map((point) => {
      if (!point) {
        from = true;
        return "";
      }
      const text = `${from ? "M" : "L"}${point[0].toFixed(1)} ${point[1].toFixed(2)}`;
      from = false;
      return text;
    })
    .join("");
}

function paintSeries(at: Placed, series: SeriesData, colour: (name: string) => string): Node[] {
  const placed = points(at, series);
  const known = placed.filter((point) => point !== undefined);
  if (known.length === 0) return [];
  const { frame, y } = at;
  switch (series.shape) {
    case "band":
      return [s("path", { fill: colour(series.fill), d: `${path(known)}z` })];
    case "dots":
      return placed.flatMap((point, i) => {
        if (!point || !inside(at, point)) return [];
        const drawn = dot(series, point, colour);
        drawn.setAttribute("data-point", String(i));
        return [drawn];
      });
    case "named":
      return known.map(([a, b]) => {
        const half = widthOf(series.label, SMALL) / 2;
        const x = Math.min(Math.max(a, frame.left + half + 2), frame.left + frame.width - half - 2);
        const middle = Math.min(Math.max(b + 4, frame.top + SMALL), frame.top + frame.height - 3);
        return s("text", { x, y: middle, "text-anchor": "middle", "font-size": SMALL, "paint-order": "stroke", stroke: colour("#ffffff"), "stroke-width": 6, "stroke-linejoin": "round" }, series.label);
      });
    default: {
      const along = path(placed);
      const drawn = s("path", { ...stroke(series, colour), d: along });
      if (series.shape !== "area") return [drawn];
      const base = Math.min(frame.top + frame.height, up(at, Math.max(0, y.min)));
      return [s("path", { fill: colour(series.fill), d: `${path(known)}L${known[known.length - 1]![0].toFixed(1)} ${base}L${known[0]![0].toFixed(1)} ${base}z` }), drawn];
    }
  }
}

function paintLimit(at: Placed, limit: PanelData["limits"][number], colour: (name: string) => string): Node[] {
  const { frame } = at;
  const y = up(at, limit.value);
  if (!(y >= frame.top && y <= frame.top + frame.height)) return [];
  const drawn = s("path", { ...stroke(limit, colour), d: `M${frame.left} ${y.toFixed(2)}h${frame.width}` });
  if (!limit.label) return [drawn];
  const upper = y < frame.top + frame.height / 2;
  const above = upper ? y - frame.top > LINE : frame.top + frame.height - y <= LINE;
  const text = s("text", { x: frame.left + frame.width - 4, y: above ? y - 3.5 : y + SMALL + 1, "text-anchor": "end", "font-size": SMALL, "paint-order": "stroke", stroke: colour("#ffffff"), "stroke-width": 3 }, cut(limit.label, SMALL, frame.width - 8));
  return [drawn, text];
}
