/** The runs of a result over one another: both axes to choose, values under the pointer, a click that loads a run. */

import { labelOf } from "./controls";
import { digits, fill, h } from "./dom";
import { FigureView, type Hit } from "./figure";
import type { AxisData, FigureData, RunColumn, RunTable, SeriesData } from "./types";

/** Most runs that are drawn. */
const MOST = 6000;

const isNumeric = ({ values }: RunColumn) => values.some((value) => typeof value === "number");
const number = (column: RunColumn, row: number) => {
  const value = column.values[row];
  return typeof value === "number" ? value / column.unit.in_si : Number.NaN;
};
const named = ({ title, unit }: RunColumn) => `${title}${unit.symbol ? ` (${unit.symbol})` : ""}`;

/** From 0 to the ends of some values. */
function axis(column: RunColumn, rows: number[]): AxisData {
  let [low, high] = [0, 0];
  for (const row of rows) {
    const value = number(column, row);
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return { label: named(column), min: low * 1.04, max: high > low ? high * 1.04 : low + 1, log: false, names: [] };
}

export class Explorer {
  readonly element: HTMLElement;
  private table: RunTable;
  private readonly which: HTMLSelectElement;
  private readonly x = h("select", {});
  private readonly y = h("select", {});
  private readonly note = h("p", { class: "drop-hint" });
  private readonly view: FigureView;
  /** The rows of the points that are drawn. */
  private rows: number[] = [];

  constructor(
    runs: RunTable[],
    private readonly name: string,
    dark: () => boolean,
    /** What a click does, in words, and the click. */
    word: string,
    take: (table: RunTable, row: number) => void,
    first: [x: RegExp, y: RegExp],
  ) {
    // Values of the model are called as their fields are.
    const tables = runs.map((table) => ({ ...table, columns: table.columns.map((column) => (column.path ? { ...column, title: labelOf(column.name) } : column)) }));
    this.table = tables[0]!;
    this.which = h("select", { "aria-label": "Table" }, ...tables.map(({ name }, i) => h("option", { value: i }, name)));
    this.which.addEventListener("change", () => {
      this.table = tables[Number(this.which.value)]!;
      this.choose(first);
      this.view.show(this.figure());
    });
    for (const axis of [this.x, this.y]) axis.addEventListener("change", () => this.view.show(this.figure()));
    this.choose(first);
    const pick = (_: number, hit: Hit | undefined) => {
      const row = hit && this.rows[hit.point];
      if (row !== undefined) take(this.table, row);
    };
    this.view = new FigureView(this.figure(), { dark, pick, word, tell: ({ point }) => this.tell(this.rows[point] ?? 0), csv: () => this.csv() });
    this.element = h(
      "section",
      { class: "explorer", "aria-label": "Runs" },
      h("h3", {}, `Runs: ${word}`),
      h("div", { class: "actions" }, tables.length > 1 && h("label", {}, "Table ", this.which), h("label", {}, "Across ", this.x), h("label", {}, "Up ", this.y)),
      this.note,
      this.view.element,
    );
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
  }

  private column(select: HTMLSelectElement): RunColumn {
    return this.table.columns.find(({ name }) => name === select.value)!;
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

  private figure(): FigureData {
    const [cx, cy] = [this.column(this.x), this.column(this.y)];
    const all = cx.values.map((_, row) => row).filter((row) => Number.isFinite(number(cx, row)) && Number.isFinite(number(cy, row)));
    this.rows = all.slice(0, MOST);
    this.note.textContent = all.length > MOST ? `The first ${MOST} of ${all.length} runs; all are in the CSV.` : "";
    this.note.hidden = all.length <= MOST;
    const points = (rows: number[]) => rows.flatMap((row) => [number(cx, row), number(cy, row)]);
    // Along what was raised, whichever axis that is on.
    const along = cy.name === "level" ? cy : cx;
    const lines = [...this.groups(this.rows).values()].filter(({ length }) => length > 1);
    const line = (of: number[]): SeriesData => ({ label: "", colour: "#7f9fba", width: 1, dashes: "", shape: "curve", fill: "", points: points([...of].sort((a, b) => number(along, a) - number(along, b))) });
    const dots: SeriesData = { label: "", colour: "#1f5f8b", width: 1.5, dashes: "", shape: "dots", fill: "#1f5f8b", points: points(this.rows) };
    const panel = { x: axis(cx, this.rows), y: axis(cy, this.rows), height: 330, series: [...lines.map(line), dots], limits: [], peak: null, note: "" };
    return { id: `${this.name}-${this.table.name}`, title: `${named(cy)} over ${named(cx)}`, layout: "stacked", panels: [panel], shaded: [] };
  }

  private tell(row: number): string {
    const shown = this.table.columns.filter(({ name, path }) => name === "record" || name === "friction" || path || name === "level" || name === this.x.value || name === this.y.value);
    return shown.map((column) => (typeof column.values[row] === "number" ? `${column.title} ${digits(number(column, row))} ${column.unit.symbol}`.trim() : String(column.values[row]))).join(" · ");
  }

  private csv(): string {
    const { columns } = this.table;
    const cell = (value: unknown) => (typeof value === "string" && /[",\n]/.test(value) ? `"${value.replaceAll('"', '""')}"` : value === null || value === undefined ? "" : String(value));
    const rows = (columns[0]?.values ?? []).map((_, row) => columns.map(({ values }) => cell(values[row])).join(","));
    return `${[columns.map(({ name }) => cell(name)).join(","), ...rows].join("\n")}\n`;
  }

  /** Told where the ground may have changed. */
  restyle(): void {
    this.view.restyle();
  }
}
