/** A drawing that is alive: values under the pointer, zoom, and out as CSV, SVG and PNG. */

import { valueAt } from "./axes";
import { digits, download, fill, h, picture } from "./dom";
import { across, inside, paint, type Placed, points, s, up, type Zoom } from "./paint";
import type { AxisData, FigureData, SeriesData } from "./types";

/** A point of a series. */
export interface Hit {
  panel: number;
  series: number;
  point: number;
}

export interface Options {
  /** Whether it stands on a dark ground. */
  dark: () => boolean;
  /** Told where it is clicked: at a value of the x axis, on a point where there is one near. */
  pick?: (x: number, hit: Hit | undefined) => void;
  /** What a click does, in words, for those who do not see. */
  word?: string;
  /** What is said of a point, in place of its coordinates. */
  tell?: (hit: Hit) => string;
  /** Its CSV, in place of the points of its series. */
  csv?: () => string;
}

/** How near a point is one that is pointed at, in px. */
const NEAR = 16;
/** Most lines whose values are told at once. */
const MOST_TOLD = 8;
/** The width of what leaves the page, and the widest that it is shown. */
const [PRINTED, WIDEST] = [860, 1200];

/** A drawing with its caption and what it can do. */
export class FigureView {
  readonly element: HTMLElement;
  private readonly box = h("div", { class: "figure-plot" });
  private readonly said = h("output", { class: "readout" });
  private readonly out: HTMLElement;
  private placed: Placed[] = [];
  private zoom: Zoom;
  private width = 0;
  private was: boolean | undefined;
  private readonly cursor = s("path", { class: "cursor", fill: "none", "stroke-width": 1, "pointer-events": "none" });
  private readonly ring = s("circle", { class: "here", r: 5.5, fill: "none", "stroke-width": 2, visibility: "hidden", "pointer-events": "none" });
  private readonly part = s("rect", { class: "zoom", visibility: "hidden", "pointer-events": "none" });
  /** The points that can be gone to by keyboard, and which of them it is at. */
  private stops: Hit[] = [];
  private at = -1;
  /** Where the points of a series stand, known once they are asked for. */
  private readonly known = new Map<SeriesData, ReturnType<typeof points>>();

  constructor(
    private figure: FigureData,
    private readonly options: Options,
    ...caption: (string | Node)[]
  ) {
    const button = (label: string, act: () => unknown) => h("button", { type: "button", onclick: () => void act() }, label);
    const whole = button("Whole", () => this.whole());
    this.out = h("span", { class: "figure-out" }, whole, button("CSV", () => download(`${this.figure.id}.csv`, this.csv(), "text/csv")), button("SVG", () => download(`${this.figure.id}.svg`, this.standing(), "image/svg+xml")), button("PNG", () => picture(this.standing(), `${this.figure.id}.png`)));
    this.element = h("figure", { class: "figure" }, this.box, h("figcaption", {}, ...caption, " ", this.out), this.said);
    new ResizeObserver(() => {
      const width = Math.min(WIDEST, Math.floor(this.box.clientWidth));
      if (width > 0 && width !== this.width) this.draw();
    }).observe(this.box);
  }

  /** Shows another figure. */
  show(figure: FigureData): void {
    this.figure = figure;
    this.zoom = undefined;
    this.draw();
  }

  /** Draws it again where the ground has changed. */
  restyle(): void {
    if (this.was !== this.options.dark()) this.draw();
  }

  whole(): void {
    this.zoom = undefined;
    this.draw();
  }

  private draw(): void {
    const width = Math.min(WIDEST, Math.floor(this.box.clientWidth));
    if (width <= 0) return;
    this.width = width;
    this.was = this.options.dark();
    const { svg, placed } = paint(this.figure, width, this.was, this.zoom);
    this.placed = placed;
    this.known.clear();
    const { title } = this.figure;
    const pick = this.options.word ? `, Enter takes one: ${this.options.word}` : "";
    for (const [name, value] of Object.entries({ role: "application", tabindex: "0", "aria-label": `${title}; arrow keys go from point to point${pick}` })) svg.setAttribute(name, value);
    svg.append(this.cursor, this.ring, this.part);
    this.still();
    this.stops = this.goTo();
    this.listen(svg);
    fill(this.box, svg);
  }

  private points(at: Placed, series: SeriesData): ReturnType<typeof points> {
    const found = this.known.get(series) ?? points(at, series);
    this.known.set(series, found);
    return found;
  }

  /** Points in the order of their places: those that are dots, else those of the first named line. */
  private goTo(): Hit[] {
    const of = (shape: (series: SeriesData, panel: number) => boolean) =>
      this.placed.flatMap((at, panel) =>
        at.panel.series.flatMap((series, i) =>
          shape(series, panel)
            ? this.points(at, series).flatMap((point, k) => (point && inside(at, point) ? [{ panel, series: i, point: k, x: point[0], y: point[1] }] : []))
            : [],
        ).sort((a, b) => a.x - b.x || b.y - a.y),
      );
    const dots = of(({ shape }) => shape === "dots");
    if (dots.length > 0) return dots;
    return of((series, panel) => series === this.told(panel)[0]);
  }

  /** Lines whose values are told, where there are not too many: those with a name, else all. */
  private told(panel: number): SeriesData[] {
    const lines = this.placed[panel]!.panel.series.filter((series) => series.shape !== "band" && series.shape !== "dots" && series.shape !== "named" && rises(series));
    const named = lines.filter(({ label }) => label !== "");
    return named.length > 0 ? named.slice(0, MOST_TOLD) : lines.length <= MOST_TOLD ? lines : [];
  }

  private still(): void {
    this.at = -1;
    this.cursor.setAttribute("d", "");
    this.ring.setAttribute("visibility", "hidden");
    this.part.setAttribute("visibility", "hidden");
    this.said.textContent = "";
  }

  /** The point nearest to a place of a panel. */
  private nearest(panel: number, [a, b]: [number, number]): Hit | undefined {
    const at = this.placed[panel]!;
    let [best, found]: [number, Hit | undefined] = [NEAR, undefined];
    at.panel.series.forEach((series, i) => {
      if (series.shape === "band" || series.shape === "named") return;
      // A dot is meant before a line that it stands on.
      const further = series.shape === "dots" ? 0 : 4;
      this.points(at, series).forEach((point, k) => {
        const far = point && inside(at, point) ? Math.hypot(point[0] - a, point[1] - b) + further : Infinity;
        if (far < best) [best, found] = [far, { panel, series: i, point: k }];
      });
    });
    return found;
  }

  /** Says what is at a place, or at a point. */
  private point(panel: number, place: [number, number], hit: Hit | undefined): void {
    const at = this.placed[panel]!;
    const { frame } = at;
    const [x, y] = hit ? this.values(hit) : [valueAt(at.x, (place[0] - frame.left) / frame.width), Number.NaN];
    const along = hit ? across(at, x) : place[0];
    const bar = at.panel.series.find((series) => series.shape === "band" && around(at, series, place));
    this.cursor.setAttribute("d", `M${along.toFixed(1)} ${frame.top}v${frame.height}`);
    if (hit) for (const [name, value] of Object.entries({ cx: along, cy: up(at, y), visibility: "visible" })) this.ring.setAttribute(name, String(value));
    else this.ring.setAttribute("visibility", "hidden");
    const series = hit && at.panel.series[hit.series];
    const lines = this.told(panel).filter((line) => line !== series);
    const values = lines.flatMap((line) => {
      const value = between(line, x);
      return value === undefined ? [] : [`${line.label || at.panel.y.label}: ${digits(value, 4)}`];
    });
    const own = hit && series ? [`${series.label || named(at.y)}: ${at.y.names[Math.round(y) - 1] ?? digits(y, 4)}`] : [];
    const barred = bar && at.y.names.length > 0 ? [`${at.y.names[Math.round(valueAt(at.y, 1 - (place[1] - frame.top) / frame.height)) - 1] ?? ""}: ${digits(furthest(bar), 4)}`] : [];
    const text = barred.length > 0 ? barred : [`${named(at.x)}: ${at.x.names[Math.round(x) - 1] ?? digits(x, 4)}`, ...own, ...values];
    this.said.textContent = (hit && this.options.tell?.(hit)) || (text.length > 1 || barred.length > 0 ? text.join(" · ") : `${text[0]} · ${named(at.y)}: ${digits(valueAt(at.y, 1 - (place[1] - frame.top) / frame.height), 4)}`);
  }

  private values({ panel, series, point }: Hit): [number, number] {
    const { points } = this.placed[panel]!.panel.series[series]!;
    return [points[2 * point]!, points[2 * point + 1]!];
  }

  private listen(svg: SVGElement): void {
    const place = (event: PointerEvent | MouseEvent): [number, number] => {
      const box = svg.getBoundingClientRect();
      return [((event.clientX - box.left) / box.width) * this.width, ((event.clientY - box.top) / box.height) * Number(svg.getAttribute("height"))];
    };
    const panelOf = (point: [number, number]) => this.placed.findIndex((at) => inside(at, point));
    let from: { panel: number; place: [number, number] } | undefined;
    svg.addEventListener("pointerdown", (event) => {
      const at = place(event);
      const panel = panelOf(at);
      if (panel < 0 || event.button !== 0) return;
      from = { panel, place: at };
      svg.setPointerCapture(event.pointerId);
    });
    svg.addEventListener("pointermove", (event) => {
      const to = place(event);
      if (from && Math.hypot(to[0] - from.place[0], to[1] - from.place[1]) > 8) {
        const { left, top, width, height } = this.marked(from.panel, from.place, to);
        for (const [name, value] of Object.entries({ x: left, y: top, width, height, visibility: "visible" })) this.part.setAttribute(name, String(value));
        return;
      }
      const panel = panelOf(to);
      if (panel < 0) this.still();
      else this.point(panel, to, this.nearest(panel, to));
    });
    svg.addEventListener("pointerup", (event) => {
      const [start, to] = [from, place(event)];
      from = undefined;
      if (!start) return;
      const { left, top, width, height } = this.marked(start.panel, start.place, to);
      const at = this.placed[start.panel]!;
      if (width > 8) {
        const x = (value: number) => valueAt(at.x, (value - at.frame.left) / at.frame.width);
        const y = (value: number) => valueAt(at.y, 1 - (value - at.frame.top) / at.frame.height);
        const tall = height < at.frame.height - 1;
        this.zoom = { x: [x(left), x(left + width)], ...(tall ? { y: [start.panel, y(top + height), y(top)] as [number, number, number] } : this.zoom?.y ? { y: this.zoom.y } : {}) };
        this.draw();
      } else {
        this.part.setAttribute("visibility", "hidden");
        this.options.pick?.(valueAt(at.x, (to[0] - at.frame.left) / at.frame.width), this.nearest(start.panel, to));
      }
    });
    svg.addEventListener("pointercancel", () => {
      from = undefined;
      this.still();
    });
    svg.addEventListener("pointerleave", () => {
      if (!from) this.still();
    });
    svg.addEventListener("dblclick", () => this.whole());
    svg.addEventListener("keydown", (event) => {
      const step = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[event.key];
      if (step !== undefined && this.stops.length > 0) {
        event.preventDefault();
        const next = this.at < 0 && step < 0 ? this.stops.length - 1 : (this.at + step + this.stops.length) % this.stops.length;
        const hit = this.stops[next]!;
        const [x, y] = this.values(hit);
        const at = this.placed[hit.panel]!;
        this.point(hit.panel, [across(at, x), up(at, y)], hit);
        this.at = next;
      }
      const hit = this.stops[this.at];
      if (event.key === "Enter" && hit) this.options.pick?.(this.values(hit)[0], hit);
      if (event.key === "Escape" && this.zoom) this.whole();
    });
  }

  /** What a drag marks: a part of the x axis, of both where it goes up and down too. */
  private marked(panel: number, [a, b]: [number, number], [c, d]: [number, number]): { left: number; top: number; width: number; height: number } {
    const { frame, y } = this.placed[panel]!;
    const clamp = (value: number, low: number, length: number) => Math.min(Math.max(value, low), low + length);
    const [left, right] = [Math.min(a, c), Math.max(a, c)].map((value) => clamp(value, frame.left, frame.width)) as [number, number];
    if (Math.abs(d - b) <= 24 || y.names.length > 0) return { left, top: frame.top, width: right - left, height: frame.height };
    const [top, bottom] = [Math.min(b, d), Math.max(b, d)].map((value) => clamp(value, frame.top, frame.height)) as [number, number];
    return { left, top, width: right - left, height: bottom - top };
  }

  private csv(): string {
    if (this.options.csv) return this.options.csv();
    const cell = (text: string | number) => (/[",\n]/.test(String(text)) ? `"${String(text).replaceAll('"', '""')}"` : String(text));
    const rows = this.figure.panels.flatMap(({ x, y, series }, panel) =>
      series.flatMap(({ label, points }) => {
        const at: string[] = [];
        for (let i = 0; i + 1 < points.length; i += 2) at.push([panel + 1, x.label, y.label, label, points[i] ?? "", points[i + 1] ?? ""].map(cell).join(","));
        return at;
      }),
    );
    return `${["panel,x_axis,y_axis,series,x,y", ...rows].join("\n")}\n`;
  }

  /** The drawing by itself, in the colours of print, zoomed as it is. */
  private standing(): string {
    const { svg } = paint(this.figure, PRINTED, false, this.zoom);
    svg.prepend(s("title", {}, this.figure.title), s("rect", { width: "100%", height: "100%", fill: "#ffffff" }));
    return new XMLSerializer().serializeToString(svg);
  }
}

const named = ({ label }: AxisData) => label || "y";

/** Whether a line is a function of x. */
function rises({ points }: SeriesData): boolean {
  for (let i = 2; i < points.length; i += 2) if (points[i]! < points[i - 2]!) return false;
  return points.length > 2;
}

/** The value of a line that is a function of x, straight between its points. */
function between({ points }: SeriesData, x: number): number | undefined {
  for (let i = 2; i + 1 < points.length; i += 2) {
    const [x0, y0, x1, y1] = [points[i - 2]!, points[i - 1]!, points[i]!, points[i + 1]!];
    if (x0 <= x && x <= x1) {
      const value = x1 > x0 ? y0 + ((y1 - y0) * (x - x0)) / (x1 - x0) : y1;
      return Number.isFinite(value) ? value : undefined;
    }
  }
  return undefined;
}

/** Whether a place is in the box around a bar. */
function around(at: Placed, series: SeriesData, [a, b]: [number, number]): boolean {
  const known = points(at, series).filter((point) => point !== undefined);
  const [xs, ys] = [known.map(([x]) => x), known.map(([, y]) => y)];
  return known.length === 4 && a >= Math.min(...xs) - 2 && a <= Math.max(...xs) + 2 && b >= Math.min(...ys) && b <= Math.max(...ys);
}

/** The x of a bar that is furthest from its foot. */
function furthest({ points }: SeriesData): number {
  let found = 0;
  for (let i = 0; i < points.length; i += 2) if (Math.abs(points[i]!) > Math.abs(found)) found = points[i]!;
  return found;
}
