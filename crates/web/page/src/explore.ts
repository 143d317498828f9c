/** The runs of a result over one another: both axes to choose, values under the pointer, a click that loads a run. */

import { digits, download, fill, h } from "./dom";
import type { RunColumn, RunTable } from "./types";

const NS = "http://www.w3.org/2000/svg";
const [WIDTH, HEIGHT] = [860, 400];
const FRAME = { left: 74, right: 842, top: 14, bottom: 346 };
/** Most runs that are drawn. */
const MOST = 6000;

function s(tag: string, attributes: Record<string, string | number>, ...children: (Node | string)[]): SVGElement {
  const element = document.createElementNS(NS, tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
  element.append(...children);
  return element;
}

/** Round numbers between two values. */
function ticks(low: number, high: number): number[] {
  const raw = (high - low) / 6;
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].find((m) => m * power >= raw)! * power;
  const found = [];
  for (let k = Math.ceil(low / step); k * step <= high + 1e-9 * step; k++) found.push(k * step);
  return found;
}

const isNumeric = ({ values }: RunColumn) => values.some((value) => typeof value === "number");
const number = (column: RunColumn, row: number) => {
  const value = column.values[row];
  return typeof value === "number" ? value / column.unit.in_si : Number.NaN;
};
const named = ({ title, unit }: RunColumn) => `${title}${unit.symbol ? ` (${unit.symbol})` : ""}`;

interface Axis {
  column: RunColumn;
  low: number;
  high: number;
}

export class Explorer {
  readonly element: HTMLElement;
  private table: RunTable;
  private readonly which: HTMLSelectElement;
  private readonly x = h("select", {});
  private readonly y = h("select", {});
  private readonly box = h("div", { class: "explorer-plot" });
  private readonly said = h("output", { class: "readout" });
  private zoom: [number, number, number, number] | undefined;
  private at = -1;
  private svg: SVGElement | undefined;
  private points: [x: number, y: number, row: number][] = [];

  constructor(
    tables: RunTable[],
    private readonly name: string,
    /** What a click does, in a word, and the click. */
    private readonly word: string,
    private readonly take: (table: RunTable, row: number) => void,
    first: [x: RegExp, y: RegExp],
  ) {
    this.table = tables[0]!;
    this.which = h("select", { "aria-label": "Table" }, ...tables.map(({ name }, i) => h("option", { value: i }, name)));
    this.which.addEventListener("change", () => {
      this.table = tables[Number(this.which.value)]!;
      this.choose(first);
    });
    for (const axis of [this.x, this.y]) {
      axis.addEventListener("change", () => {
        this.zoom = undefined;
        this.draw();
      });
    }
    const button = (label: string, act: () => unknown) => h("button", { type: "button", onclick: () => void act() }, label);
    this.element = h(
      "section",
      { class: "explorer", "aria-label": "Runs" },
      h("h3", {}, `Runs: ${word}`),
      h("div", { class: "actions" }, tables.length > 1 && h("label", {}, "Table ", this.which), h("label", {}, "Across ", this.x), h("label", {}, "Up ", this.y)),
      this.box,
      this.said,
      h("div", { class: "actions" }, button("Whole", () => this.whole()), button("CSV", () => this.csv()), button("SVG", () => download(`${this.name}-runs.svg`, this.standing(), "image/svg+xml")), button("PNG", () => this.png())),
    );
    this.choose(first);
  }

  private choose([x, y]: [RegExp, RegExp]): void {
    const columns = this.table.columns.filter(isNumeric);
    const has = (pattern: RegExp) => columns.find((column) => pattern.test(column.name));
    const path = columns.find(({ path }) => path);
    const across = has(x) ?? path ?? has(/^level$/) ?? columns[0];
    const up = has(y) ?? columns.find((column) => column !== across && column.name !== "scale") ?? columns[1] ?? columns[0];
    const options = (chosen: RunColumn | undefined) => columns.map((column) => h("option", { value: column.name, selected: column === chosen }, named(column)));
    fill(this.x, ...options(across));
    fill(this.y, ...options(up));
    this.zoom = undefined;
    this.draw();
  }

  private column(select: HTMLSelectElement): RunColumn {
    return this.table.columns.find(({ name }) => name === select.value)!;
  }

  private whole(): void {
    this.zoom = undefined;
    this.draw();
  }

  /** What the runs of one line share: every text, and the values that are varied and on no axis. */
  private groups(rows: number[]): Map<string, number[]> {
    const [x, y] = [this.x.value, this.y.value];
    const keys = this.table.columns.filter((column) => column.name !== x && column.name !== y && (column.name === "record" || column.name === "friction" || column.path));
    const groups = new Map<string, number[]>();
    for (const row of rows) {
      const key = keys.map(({ values, unit, title }) => {
        const value = values[row];
        return typeof value === "number" ? `${title} ${digits(value / unit.in_si, 3)} ${unit.symbol}`.trim() : String(value);
      }).join(", ");
      groups.set(key, [...(groups.get(key) ?? []), row]);
    }
    return groups;
  }

  private axis(column: RunColumn, range: [number, number] | undefined, rows: number[]): Axis {
    if (range) return { column, low: range[0], high: range[1] };
    let [low, high] = [0, 0];
    for (const row of rows) {
      const value = number(column, row);
      if (value < low) low = value;
      if (value > high) high = value;
    }
    return { column, low: low * 1.04, high: high > low ? high * 1.04 : low + 1 };
  }

  private draw(): void {
    const [cx, cy] = [this.column(this.x), this.column(this.y)];
    const all = cx.values.map((_, row) => row).filter((row) => Number.isFinite(number(cx, row)) && Number.isFinite(number(cy, row)));
    const rows = all.slice(0, MOST);
    const [x, y] = [this.axis(cx, this.zoom && [this.zoom[0], this.zoom[1]], rows), this.axis(cy, this.zoom && [this.zoom[2], this.zoom[3]], rows)];
    const px = (value: number) => FRAME.left + ((value - x.low) / (x.high - x.low)) * (FRAME.right - FRAME.left);
    const py = (value: number) => FRAME.bottom - ((value - y.low) / (y.high - y.low)) * (FRAME.bottom - FRAME.top);
    const inside = ([a, b]: [number, number, number]) => a >= FRAME.left - 1 && a <= FRAME.right + 1 && b >= FRAME.top - 1 && b <= FRAME.bottom + 1;
    const minus = (value: number) => String(Number(value.toPrecision(6))).replace("-", "−");
    const grid = [
      ...ticks(x.low, x.high).flatMap((value) => [s("line", { class: "grid", x1: px(value), x2: px(value), y1: FRAME.top, y2: FRAME.bottom }), s("text", { class: "tick", x: px(value), y: FRAME.bottom + 18, "text-anchor": "middle" }, minus(value))]),
      ...ticks(y.low, y.high).flatMap((value) => [s("line", { class: "grid", x1: FRAME.left, x2: FRAME.right, y1: py(value), y2: py(value) }), s("text", { class: "tick", x: FRAME.left - 7, y: py(value) + 4, "text-anchor": "end" }, minus(value))]),
    ];
    const lines: SVGElement[] = [];
    this.points = [];
    for (const [, of] of this.groups(rows)) {
      // Along what was raised, whichever axis that is on.
      const along = cy.name === "level" ? cy : cx;
      const sorted = [...of].sort((a, b) => number(along, a) - number(along, b));
      const points = sorted.map((row): [number, number, number] => [px(number(cx, row)), py(number(cy, row)), row]);
      if (points.length > 1) lines.push(s("polyline", { class: "run-line", points: points.map(([a, b]) => `${a.toFixed(1)},${b.toFixed(1)}`).join(" ") }));
      this.points.push(...points.filter(inside));
    }
    const dots = this.points.map(([a, b, row]) => s("circle", { class: "run", cx: a.toFixed(1), cy: b.toFixed(1), r: 3.2, "data-row": row }));
    const clip = s("svg", { x: FRAME.left, y: FRAME.top, width: FRAME.right - FRAME.left, height: FRAME.bottom - FRAME.top, viewBox: `${FRAME.left} ${FRAME.top} ${FRAME.right - FRAME.left} ${FRAME.bottom - FRAME.top}` }, ...lines);
    const svg = s(
      "svg",
      { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "application", tabindex: 0, "aria-label": `${named(cy)} over ${named(cx)}; arrow keys go from run to run, Enter takes one: ${this.word}` },
      ...grid,
      s("rect", { class: "frame", x: FRAME.left, y: FRAME.top, width: FRAME.right - FRAME.left, height: FRAME.bottom - FRAME.top }),
      clip,
      ...dots,
      s("text", { class: "axis", x: (FRAME.left + FRAME.right) / 2, y: HEIGHT - 10, "text-anchor": "middle" }, named(cx)),
      s("text", { class: "axis", transform: `translate(16 ${(FRAME.top + FRAME.bottom) / 2}) rotate(-90)`, "text-anchor": "middle" }, named(cy)),
    );
    this.svg = svg;
    this.at = -1;
    this.listen(svg, x, y);
    fill(this.box, svg);
    this.said.textContent = all.length > MOST ? `The first ${MOST} of ${all.length} runs; all are in the CSV.` : "";
  }

  private listen(svg: SVGElement, x: Axis, y: Axis): void {
    const place = (event: PointerEvent): [number, number] => {
      const box = svg.getBoundingClientRect();
      return [((event.clientX - box.left) / box.width) * WIDTH, ((event.clientY - box.top) / box.height) * HEIGHT];
    };
    const back = ([a, b]: [number, number]): [number, number] => [x.low + ((a - FRAME.left) / (FRAME.right - FRAME.left)) * (x.high - x.low), y.low + ((FRAME.bottom - b) / (FRAME.bottom - FRAME.top)) * (y.high - y.low)];
    let from: [number, number] | undefined;
    const frame = s("rect", { class: "zoom", visibility: "hidden" });
    svg.append(frame);
    svg.addEventListener("pointerdown", (event) => {
      from = place(event);
      svg.setPointerCapture(event.pointerId);
    });
    svg.addEventListener("pointermove", (event) => {
      const to = place(event);
      if (from && Math.hypot(to[0] - from[0], to[1] - from[1]) > 8) {
        const [a, b] = [from, to];
        for (const [name, value] of Object.entries({ x: Math.min(a[0], b[0]), y: Math.min(a[1], b[1]), width: Math.abs(a[0] - b[0]), height: Math.abs(a[1] - b[1]), visibility: "visible" })) frame.setAttribute(name, String(value));
      } else this.mark(this.nearest(to));
    });
    svg.addEventListener("pointerup", (event) => {
      const [start, to] = [from, place(event)];
      from = undefined;
      if (start && Math.abs(to[0] - start[0]) > 8 && Math.abs(to[1] - start[1]) > 8) {
        const [[x0, y0], [x1, y1]] = [back(start), back(to)];
        this.zoom = [Math.min(x0, x1), Math.max(x0, x1), Math.min(y0, y1), Math.max(y0, y1)];
        this.draw();
      } else {
        const nearest = this.nearest(to);
        if (nearest >= 0) this.take(this.table, this.points[nearest]![2]);
      }
    });
    svg.addEventListener("dblclick", () => this.whole());
    svg.addEventListener("keydown", (event) => {
      const step = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[event.key];
      if (step !== undefined && this.points.length > 0) {
        event.preventDefault();
        this.mark((this.at + step + this.points.length) % this.points.length);
      }
      if (event.key === "Enter" && this.at >= 0) this.take(this.table, this.points[this.at]![2]);
    });
  }

  private nearest([a, b]: [number, number]): number {
    let [best, found] = [18, -1];
    this.points.forEach(([x, y], i) => {
      const far = Math.hypot(x - a, y - b);
      if (far < best) [best, found] = [far, i];
    });
    return found;
  }

  private mark(at: number): void {
    if (at === this.at) return;
    this.at = at;
    for (const dot of this.svg?.querySelectorAll(".run.here") ?? []) dot.classList.remove("here");
    if (at < 0) {
      this.said.textContent = "";
      return;
    }
    const row = this.points[at]![2];
    this.svg?.querySelector(`[data-row="${row}"]`)?.classList.add("here");
    const shown = this.table.columns.filter(({ name, path }) => name === "record" || name === "friction" || path || name === "level" || name === this.x.value || name === this.y.value);
    this.said.textContent = shown.map((column) => (typeof column.values[row] === "number" ? `${column.title} ${digits(number(column, row))} ${column.unit.symbol}`.trim() : String(column.values[row]))).join(" · ");
  }

  private csv(): void {
    const { columns, name } = this.table;
    const cell = (value: unknown) => (typeof value === "string" && /[",\n]/.test(value) ? `"${value.replaceAll('"', '""')}"` : value === null || value === undefined ? "" : String(value));
    const rows = (columns[0]?.values ?? []).map((_, row) => columns.map(({ values }) => cell(values[row])).join(","));
    download(`${this.name}-${name}.csv`, `${[columns.map(({ name }) => cell(name)).join(","), ...rows].join("\n")}\n`, "text/csv");
  }

  /** The drawing by itself, in its colours as they are. */
  private standing(): string {
    const copy = this.svg!.cloneNode(true) as SVGElement;
    const [was, are] = [[...this.svg!.querySelectorAll("*")], [...copy.querySelectorAll("*")]];
    are.forEach((element, i) => {
      const style = getComputedStyle(was[i]!);
      for (const name of ["fill", "stroke", "stroke-width", "font-family", "font-size"]) element.setAttribute(name, style.getPropertyValue(name));
    });
    copy.setAttribute("xmlns", NS);
    copy.prepend(s("rect", { width: WIDTH, height: HEIGHT, fill: getComputedStyle(this.box).backgroundColor }));
    return new XMLSerializer().serializeToString(copy);
  }

  private async png(): Promise<void> {
    const url = URL.createObjectURL(new Blob([this.standing()], { type: "image/svg+xml" }));
    const image = h("img", { src: url, alt: "", width: WIDTH, height: HEIGHT });
    await image.decode();
    const canvas = h("canvas", { width: 2 * WIDTH, height: 2 * HEIGHT });
    canvas.getContext("2d")!.drawImage(image, 0, 0, canvas.width, canvas.height);
    URL.revokeObjectURL(url);
    canvas.toBlob((blob) => blob && download(`${this.name}-runs.png`, blob, "image/png"));
  }
}
