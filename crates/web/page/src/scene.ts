/** The animation: table, block and storeys at one instant, drawn from the history. */

import type { Answer } from "./types";

export interface Palette {
  [name: string]: string;
}

/** The colours of the style sheet. */
export function palette(element: Element): Palette {
  const style = getComputedStyle(element);
  const names = ["paper", "panel", "line", "ink", "quiet", "accent", "slide", "stick", "table", "block", "roof", "gap", "bound", "sky", "ground", "steel", "steel-soft", "slide-soft", "sunken"];
  return Object.fromEntries(names.map((name) => [name, style.getPropertyValue(`--${name}`).trim()]));
}

/** The last knot at or before a time. */
export function knotAt(times: Float64Array, time: number): number {
  let [low, high] = [0, times.length - 1];
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle]! <= time) low = middle;
    else high = middle - 1;
  }
  return low;
}

/** A list at a time, straight between knots. */
export function at(times: Float64Array, values: Float64Array, time: number, width = 1, place = 0): number {
  if (times.length === 0) return 0;
  const knot = knotAt(times, time);
  const next = Math.min(knot + 1, times.length - 1);
  const [a, b] = [values[knot * width + place] ?? 0, values[next * width + place] ?? 0];
  const step = times[next]! - times[knot]!;
  return step > 0 ? a + ((b - a) * Math.min(1, (time - times[knot]!) / step)) : a;
}

/** Sizes of the boxes of canvases: to ask for one at every frame would lay the page out at every frame. */
const boxes = new WeakMap<Element, [number, number]>();
const watcher = new ResizeObserver((entries) => {
  for (const { target } of entries) boxes.set(target, [target.clientWidth, target.clientHeight]);
});

function box(canvas: HTMLCanvasElement): [number, number] {
  const known = boxes.get(canvas);
  if (known) return known;
  watcher.observe(canvas);
  return [canvas.clientWidth, canvas.clientHeight];
}

/** Sets the size of a canvas to that of its box; the context in units of the box. */
export function context(canvas: HTMLCanvasElement): [CanvasRenderingContext2D, number, number] | null {
  const ratio = Math.min(3, globalThis.devicePixelRatio || 1);
  const [width, height] = box(canvas);
  const drawing = canvas.getContext("2d");
  if (!drawing || width === 0 || height === 0) return null;
  const [w, hgt] = [Math.round(width * ratio), Math.round(height * ratio)];
  if (canvas.width !== w || canvas.height !== hgt) {
    canvas.width = w;
    canvas.height = hgt;
  }
  drawing.setTransform(ratio, 0, 0, ratio, 0, 0);
  return [drawing, width, height];
}

export interface Shown {
  answer: Answer;
  tableTimes: Float64Array;
  tableDisplacement: Float64Array;
  tablePeak: number;
}

/** Height of a storey, and size of the block, where the model gives none. */
const STOREY_M = 3;

export class Scene {
  magnified = false;
  private colours: Palette;
  /** Displacements are drawn so many times as large as they are. */
  factor = 1;

  constructor(readonly canvas: HTMLCanvasElement) {
    this.colours = palette(canvas);
  }

  restyle(): void {
    this.colours = palette(this.canvas);
  }

  draw(shown: Shown, time: number): void {
    const made = context(this.canvas);
    if (!made) return;
    const [c, width, height] = made;
    const { answer } = shown;
    const { structure, headline, units } = answer.state;
    const colour = this.colours;
    c.clearRect(0, 0, width, height);

    const storeys = structure.storeyMasses_kg.length;
    const s = at(answer.time, answer.s, time);
    const knot = knotAt(answer.time, time);
    const mode = answer.mode[knot] ?? 0;
    const ground = at(shown.tableTimes, shown.tableDisplacement, time);

    // Sizes in m.
    const heights = structure.heights_m.length === storeys ? structure.heights_m : Array(storeys).fill(STOREY_M);
    const total = heights.reduce((sum: number, hgt: number) => sum + hgt, 0);
    const blockWidth = structure.width_m ?? (total > 0 ? Math.max(0.5 * total, 1.2 * heights[0]!) : 2);
    const blockHeight = Math.max(0.1 * total, 0.22 * blockWidth);
    const tall = total + blockHeight * 1.6;
    const floorY = height - 46;
    const room = Math.max(headline.peak_m, structure.gap_m ?? 0) + shown.tablePeak;
    const scale = Math.min((floorY - 34) / tall, (width * 0.8) / (blockWidth + 2.4 * Math.min(room, blockWidth)));
    const peak = Math.max(headline.peak_m, 1e-6);
    this.factor = this.magnified ? Math.max(1, (0.16 * width) / (peak * scale)) : 1;
    if (this.magnified && this.factor > 10) this.factor = Number(this.factor.toPrecision(1));
    else if (this.magnified) this.factor = Number(this.factor.toPrecision(2));
    const k = scale * this.factor;
    const centre = width / 2;
    const tableX = centre + Math.max(-0.3 * width, Math.min(0.3 * width, ground * k));
    const blockX = tableX + s * k;
    const bw = blockWidth * scale;
    const bh = blockHeight * scale;

    // The ground, which stands.
    c.fillStyle = colour.ground!;
    c.fillRect(0, floorY + 15, width, height - floorY - 15);
    c.strokeStyle = colour.line!;
    c.lineWidth = 1;
    c.beginPath();
    for (let x = -20; x < width + 20; x += 13) {
      c.moveTo(x, height);
      c.lineTo(x + 12, floorY + 15);
    }
    c.stroke();

    // The table.
    const reach = Math.max(bw * 0.75, bw / 2 + Math.max(structure.gap_m ?? 0, peak) * k + 26);
    c.fillStyle = colour["steel-soft"]!;
    c.fillRect(tableX - reach, floorY, 2 * reach, 12);
    c.fillStyle = colour.table!;
    for (const x of [-0.8, -0.4, 0, 0.4, 0.8]) {
      c.beginPath();
      c.arc(tableX + x * reach, floorY + 14, 3, 0, 2 * Math.PI);
      c.fill();
    }
    // Where the block has slid so far: its scratch on the table.
    let [low, high] = [0, 0];
    for (let i = 0; i <= knot; i++) {
      const value = answer.s[i]!;
      if (value < low) low = value;
      if (value > high) high = value;
    }
    c.fillStyle = colour.slide!;
    c.globalAlpha = 0.5;
    c.fillRect(tableX + low * k - 1.5, floorY + 4, (high - low) * k + 3, 4);
    c.globalAlpha = 1;
    c.strokeStyle = colour.ink!;
    c.lineWidth = 1.5;
    c.beginPath();
    c.moveTo(tableX, floorY + 1);
    c.lineTo(tableX, floorY + 11);
    c.stroke();
    c.beginPath();
    c.fillStyle = colour.slide!;
    c.moveTo(blockX, floorY + 1.5);
    c.lineTo(blockX - 5, floorY + 10);
    c.lineTo(blockX + 5, floorY + 10);
    c.fill();

    // The gap, on both sides of the block.
    const stops = structure.stop_m;
    const gaps = stops ?? (structure.gap_m === null ? [] : [structure.gap_m, structure.gap_m]);
    gaps.forEach((gap, side) => {
      if (gap === null || !Number.isFinite(gap)) return;
      const sign = side === 0 ? 1 : -1;
      const x = tableX + sign * (bw / 2 + gap * k);
      const passed = sign * s > gap;
      c.strokeStyle = c.fillStyle = passed ? colour.gap! : colour.quiet!;
      c.lineWidth = stops ? 5 : 2;
      c.setLineDash(stops ? [] : [5, 4]);
      c.beginPath();
      c.moveTo(x + (stops ? sign * 2.5 : 0), floorY);
      c.lineTo(x + (stops ? sign * 2.5 : 0), floorY - Math.max(24, bh * 1.5));
      c.stroke();
      c.setLineDash([]);
    });

    // Where it stood: a ghost.
    c.strokeStyle = colour.quiet!;
    c.globalAlpha = 0.5;
    c.setLineDash([3, 4]);
    c.lineWidth = 1;
    c.strokeRect(tableX - bw / 2, floorY - bh, bw, bh);
    c.setLineDash([]);
    c.globalAlpha = 1;

    // A spring or a dish.
    const pendulum = answer.state.inputs.some(({ path }) => path === "slider.radius");
    if (structure.springs && !pendulum) {
      this.spring(c, tableX - reach + 6, blockX - bw / 2, floorY - bh / 2);
    }

    // Block.
    c.fillStyle = colour.steel!;
    c.fillRect(blockX - bw / 2, floorY - bh, bw, bh - 3);
    c.fillStyle = mode === 0 ? colour.stick! : colour.slide!;
    c.fillRect(blockX - bw / 2, floorY - 4, bw, 4);
    if (pendulum) {
      c.strokeStyle = colour["steel-soft"]!;
      c.lineWidth = 2;
      c.beginPath();
      const depth = Math.min(9, 0.09 * bw);
      c.moveTo(blockX - bw / 2, floorY - bh + 4);
      c.quadraticCurveTo(blockX, floorY - bh + 4 + 2 * depth, blockX + bw / 2, floorY - bh + 4);
      c.stroke();
    }

    // Storeys.
    let [x, y] = [blockX, floorY - bh];
    const heaviest = Math.max(1e-9, ...structure.storeyMasses_kg);
    for (let i = 0; i < storeys; i++) {
      const q = at(answer.time, answer.storeyDisplacement, time, storeys, i);
      const top = y - (heights[i] as number) * scale;
      const next = blockX + q * k;
      const slab = Math.max(5, Math.min(0.3 * (heights[i] as number) * scale, 0.55 * bh * Math.sqrt(structure.storeyMasses_kg[i]! / heaviest) + 4));
      c.strokeStyle = colour.steel!;
      c.lineWidth = Math.max(2, Math.min(6, bw * 0.03));
      for (const side of [-0.38, 0.38]) {
        c.beginPath();
        c.moveTo(x + side * bw, y);
        c.bezierCurveTo(x + side * bw, (y + top) / 2, next + side * bw, (y + top) / 2, next + side * bw, top + slab);
        c.stroke();
      }
      c.fillStyle = i === storeys - 1 ? colour.roof! : colour.steel!;
      c.fillRect(next - 0.46 * bw, top, 0.92 * bw, slab);
      [x, y] = [next, top];
    }

    // Contents.
    for (let i = 0; i < structure.contents; i++) {
      const u = at(answer.time, answer.contents, time, structure.contents, i);
      c.fillStyle = colour.bound!;
      c.fillRect(blockX + u * k - 7 + 22 * i, floorY - bh - 14, 14, 14);
    }

    this.scaleBar(c, width, k, units.length);
    c.font = "600 13px system-ui, sans-serif";
    c.textBaseline = "alphabetic";
    c.fillStyle = mode === 0 ? colour.stick! : colour.slide!;
    c.textAlign = "left";
    const sliding = answer.sy.length > 0 ? "sliding" : mode > 0 ? "sliding →" : "← sliding";
    c.fillText(mode === 0 ? "stuck" : sliding, 14, 24);
  }

  private spring(c: CanvasRenderingContext2D, from: number, to: number, y: number): void {
    c.strokeStyle = this.colours.table!;
    c.lineWidth = 2;
    c.beginPath();
    c.moveTo(from, y + 26);
    c.lineTo(from, y);
    const turns = 9;
    const lead = 6;
    const length = to - from - 2 * lead;
    c.lineTo(from + lead, y);
    for (let i = 1; i < turns; i++) {
      c.lineTo(from + lead + (length * i) / turns, y + (i % 2 ? -6 : 6));
    }
    c.lineTo(to - lead, y);
    c.lineTo(to, y);
    c.stroke();
  }

  private scaleBar(c: CanvasRenderingContext2D, width: number, k: number, unit: { in_si: number; symbol: string }): void {
    const wanted = (0.13 * width) / k / unit.in_si;
    const size = 10 ** Math.floor(Math.log10(wanted));
    const value = [1, 2, 5, 10].map((n) => n * size).filter((n) => n <= wanted).pop() ?? size;
    const length = value * unit.in_si * k;
    const [right, y] = [width - 16, 22];
    c.strokeStyle = c.fillStyle = this.colours.quiet!;
    c.lineWidth = 1.5;
    c.beginPath();
    c.moveTo(right - length, y - 4);
    c.lineTo(right - length, y);
    c.lineTo(right, y);
    c.lineTo(right, y - 4);
    c.stroke();
    c.font = "12px system-ui, sans-serif";
    c.textAlign = "right";
    const text = `${Number(value.toPrecision(3))} ${unit.symbol}`;
    c.fillText(this.factor === 1 ? `${text}, true to scale` : `${text}, displacements × ${this.factor}`, right, y + 17);
  }
}

/** Two directions, from above: the way of the block so far inside its gap, and the force of friction on it. */
export class Plan {
  private colours: Palette;

  constructor(readonly canvas: HTMLCanvasElement) {
    this.colours = palette(canvas);
  }

  restyle(): void {
    this.colours = palette(this.canvas);
  }

  draw({ answer }: Shown, time: number): void {
    const made = context(this.canvas);
    if (!made) return;
    const [c, width, height] = made;
    const { structure, headline, units } = answer.state;
    const colour = this.colours;
    c.clearRect(0, 0, width, height);
    const gap = structure.gap_m !== null && structure.gap_m < 3 * headline.peak_m ? structure.gap_m : 0;
    const reach = 1.12 * Math.max(headline.peak_m, gap, 1e-6);
    const k = Math.min(width - 24, height - 44) / (2 * reach);
    const [x0, y0] = [width / 2, (height - 18) / 2];
    const [px, py] = [(x: number) => x0 + x * k, (y: number) => y0 - y * k];
    c.strokeStyle = colour.line!;
    c.lineWidth = 1;
    c.beginPath();
    c.moveTo(px(-reach), y0);
    c.lineTo(px(reach), y0);
    c.moveTo(x0, py(-reach));
    c.lineTo(x0, py(reach));
    c.stroke();
    if (gap > 0) {
      c.strokeStyle = headline.peak_m > gap ? colour.gap! : colour.quiet!;
      c.setLineDash([5, 4]);
      c.beginPath();
      c.arc(x0, y0, gap * k, 0, 2 * Math.PI);
      c.stroke();
      c.setLineDash([]);
    }
    const knot = knotAt(answer.time, time);
    const way = (to: number, stroke: string, lineWidth: number) => {
      c.strokeStyle = stroke;
      c.lineWidth = lineWidth;
      c.beginPath();
      for (let i = 0; i < to; i++) c.lineTo(px(answer.s[i]!), py(answer.sy[i]!));
      c.stroke();
    };
    way(answer.s.length, colour.line!, 1);
    const [s, sy] = [at(answer.time, answer.s, time), at(answer.time, answer.sy, time)];
    way(knot + 1, colour.stick!, 1.4);
    // Friction on the block, against its motion.
    const [fx, fy] = [-answer.friction[knot]!, -answer.frictionY[knot]!];
    const size = Math.hypot(fx, fy);
    if (size > 0) {
      const [ux, uy] = [(26 * fx) / size, (-26 * fy) / size];
      c.strokeStyle = colour.slide!;
      c.lineWidth = 2;
      c.beginPath();
      c.moveTo(px(s), py(sy));
      c.lineTo(px(s) + ux, py(sy) + uy);
      c.lineTo(px(s) + 0.75 * ux - 0.18 * uy, py(sy) + 0.75 * uy + 0.18 * ux);
      c.moveTo(px(s) + ux, py(sy) + uy);
      c.lineTo(px(s) + 0.75 * ux + 0.18 * uy, py(sy) + 0.75 * uy - 0.18 * ux);
      c.stroke();
    }
    c.fillStyle = (answer.mode[knot] ?? 0) === 0 ? colour.stick! : colour.slide!;
    c.beginPath();
    c.arc(px(s), py(sy), 5, 0, 2 * Math.PI);
    c.fill();
    c.fillStyle = colour.quiet!;
    c.font = "12px system-ui, sans-serif";
    c.textAlign = "left";
    c.fillText("x", px(reach) - 8, y0 - 5);
    c.fillText("y", x0 + 5, py(reach) + 10);
    c.textAlign = "center";
    const resultant = Math.hypot(s, sy) / units.length.in_si;
    const edge = gap > 0 ? `, dashed: gap ${Number((gap / units.length.in_si).toPrecision(3))} ${units.length.symbol}` : "";
    c.fillText(`From above: |s| = ${resultant.toFixed(1)} ${units.length.symbol}${edge}; arrow: friction on the block`, x0, height - 6);
  }
}

/** Force over sliding displacement, and where it is now. */
export class Loop {
  private colours: Palette;
  private map: { x: (v: number) => number; y: (v: number) => number } | undefined;

  constructor(
    readonly canvas: HTMLCanvasElement,
    private readonly dot: HTMLElement,
  ) {
    this.colours = palette(canvas);
  }

  restyle(): void {
    this.colours = palette(this.canvas);
  }

  /** Draws the whole loop. */
  show(answer: Answer): void {
    const made = context(this.canvas);
    if (!made) return;
    const [c, width, height] = made;
    const { units } = answer.state;
    const values = answer.state.structure.springs ? answer.force : answer.friction;
    const colour = this.colours;
    let [left, right, low, high] = [0, 0, 0, 0];
    for (let i = 0; i < values.length; i++) {
      const [x, y] = [answer.s[i]!, values[i]!];
      if (x < left) left = x;
      if (x > right) right = x;
      if (y < low) low = y;
      if (y > high) high = y;
    }
    if (right - left <= 0) [left, right] = [-1e-3, 1e-3];
    if (high - low <= 0) [low, high] = [-1, 1];
    const edge = { left: 50, right: 14, top: 12, bottom: 36 };
    const x = (v: number) => edge.left + ((v - left) / (right - left)) * (width - edge.left - edge.right);
    const y = (v: number) => height - edge.bottom - ((v - low) / (high - low)) * (height - edge.top - edge.bottom);
    this.map = { x, y };
    c.clearRect(0, 0, width, height);
    c.font = "12px system-ui, sans-serif";
    c.fillStyle = colour.quiet!;
    c.strokeStyle = colour.line!;
    c.lineWidth = 1;
    const ticks = (from: number, to: number, unit: number, count: number) => {
      const raw = (to - from) / unit / count;
      const size = 10 ** Math.floor(Math.log10(raw));
      const step = [1, 2, 5, 10].map((n) => n * size).find((n) => n >= raw) ?? size;
      const list: number[] = [];
      for (let v = Math.ceil(from / unit / step) * step; v <= to / unit + 1e-9; v += step) list.push(v);
      return list;
    };
    c.beginPath();
    c.textAlign = "center";
    for (const tick of ticks(left, right, units.length.in_si, 5)) {
      const px = x(tick * units.length.in_si);
      c.moveTo(px, edge.top);
      c.lineTo(px, height - edge.bottom);
      c.fillText(String(Number(tick.toPrecision(4))).replace("-", "−"), px, height - edge.bottom + 14);
    }
    c.textAlign = "right";
    for (const tick of ticks(low, high, units.force.in_si, 5)) {
      const py = y(tick * units.force.in_si);
      c.moveTo(edge.left, py);
      c.lineTo(width - edge.right, py);
      c.fillText(String(Number(tick.toPrecision(4))).replace("-", "−"), edge.left - 5, py + 4);
    }
    c.stroke();
    c.textAlign = "center";
    c.fillText(`Sliding displacement${answer.sy.length > 0 ? " along x" : ""} (${units.length.symbol})`, (edge.left + width - edge.right) / 2, height - 5);
    c.save();
    c.translate(11, (edge.top + height - edge.bottom) / 2);
    c.rotate(-Math.PI / 2);
    c.fillText(`Force on the slider (${units.force.symbol})`, 0, 0);
    c.restore();
    c.strokeStyle = colour.stick!;
    c.lineWidth = 1;
    c.beginPath();
    for (let i = 0; i < values.length; i++) {
      const [px, py] = [x(answer.s[i]!), y(values[i]!)];
      if (i === 0) c.moveTo(px, py);
      else c.lineTo(px, py);
    }
    c.stroke();
  }

  /** Marks one instant. */
  mark(answer: Answer, time: number): void {
    if (!this.map) return;
    const values = answer.state.structure.springs ? answer.force : answer.friction;
    const [x, y] = [this.map.x(at(answer.time, answer.s, time)), this.map.y(at(answer.time, values, time))];
    this.dot.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
  }
}
