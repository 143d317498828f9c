/** The animation: table, block and storeys at one instant, drawn from the history. */

import type { Answer, State } from "./types";

export interface Palette {
  [name: string]: string;
}

/** The colours of the style sheet. */
export function palette(element: Element): Palette {
  const style = getComputedStyle(element);
  const names = ["paper", "panel", "line", "ink", "quiet", "accent", "slide", "stick", "table", "block", "roof", "gap", "bound", "sky", "ground", "steel", "steel-soft", "slide-soft", "sunken", "versus"];
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

/** A part of the picture: where it is in it, its name, and what it is. */
export interface Part {
  name: string;
  about: string;
  box: [left: number, top: number, width: number, height: number];
}

/** Height of a storey, and size of the block, where the model gives none. */
const STOREY_M = 3;

/** Room below the table, where the gauge is, and above the roof, in px. */
const BELOW = 66;
const ABOVE = 46;

/** Width of the word friction, with a margin, in px. */
const WORD = 50;

/** Room between a line and a word beside it, in px. */
const BESIDE = 6;

/** Length of the arrow of the largest friction force, in px. */
const ARROW = 46;

/** Largest storey displacement in m, and friction force in N, of an answer. */
interface Largest {
  storey: number;
  friction: number;
}

const largest = new WeakMap<Answer, Largest>();

function largestOf(answer: Answer): Largest {
  const known = largest.get(answer);
  if (known) return known;
  const peak = (values: Float64Array) => {
    let peak = 0;
    for (let i = 0; i < values.length; i++) peak = Math.max(peak, Math.abs(values[i]!));
    return peak;
  };
  const found = { storey: peak(answer.storeyDisplacement), friction: peak(answer.friction) };
  largest.set(answer, found);
  return found;
}

/** Coefficients of static and kinetic friction on the block towards −x and +x; none where a law has no one value. */
function limitsOf({ inputs }: State): { still?: readonly [number, number]; kinetic?: readonly [number, number] } {
  const value = (path: string) => inputs.find((input) => input.path === path)?.value ?? undefined;
  const turn = value("slider.asymmetry") ?? 0;
  // Friction against sliding towards +x pulls towards −x.
  const of = (kind: string): readonly [number, number] | undefined => {
    const both = value(`slider.${kind}_friction`);
    if (both !== undefined) return [both * (1 + turn), both * (1 - turn)];
    const [positive, negative] = [value(`slider.${kind}_friction.positive`), value(`slider.${kind}_friction.negative`)];
    return positive !== undefined && negative !== undefined ? [positive, negative] : undefined;
  };
  return { still: of("static"), kinetic: of("kinetic") };
}

/** A ratio with three digits. */
const shortly = (ratio: number) => String(Number(ratio.toPrecision(3)));

/** Sizes of a building in m: what the model gives, and what it does not. */
function sizes({ structure }: State): { heights: number[]; total: number; width: number; height: number } {
  const storeys = structure.storeyMasses_kg.length;
  const heights = structure.heights_m.length === storeys ? structure.heights_m : Array<number>(storeys).fill(STOREY_M);
  const total = heights.reduce((sum, height) => sum + height, 0);
  const width = structure.width_m ?? (total > 0 ? Math.max(0.5 * total, 1.2 * heights[0]!) : 2);
  return { heights, total, width, height: Math.max(0.1 * total, 0.22 * width) };
}

/** Where things are at one instant, in px. */
interface Frame {
  c: CanvasRenderingContext2D;
  answer: Answer;
  time: number;
  /** px of a metre of the building, and of its displacements. */
  scale: number;
  k: number;
  tableX: number;
  /** Top of the table, and bottom of the block. */
  floorY: number;
  base: number;
}

export class Scene {
  magnified = false;
  private colours: Palette;
  /** Displacements are drawn so many times as large as they are. */
  factor = 1;
  /** What was drawn last, the smallest last. */
  parts: Part[] = [];
  /** What is written over the last picture. */
  said = "";

  constructor(readonly canvas: HTMLCanvasElement) {
    this.colours = palette(canvas);
  }

  restyle(): void {
    this.colours = palette(this.canvas);
  }

  /** Draws an instant; over it, in outline, the building of B. */
  draw(shown: Shown, time: number, pinned: Answer | undefined): void {
    const made = context(this.canvas);
    if (!made) return;
    const [c, width, height] = made;
    const { answer } = shown;
    const { structure, headline, units } = answer.state;
    const colour = this.colours;
    c.clearRect(0, 0, width, height);
    this.parts = [];

    const s = at(answer.time, answer.s, time);
    const knot = knotAt(answer.time, time);
    const mode = answer.mode[knot] ?? 0;
    const ground = at(shown.tableTimes, shown.tableDisplacement, time);
    const { total, width: blockWidth, height: blockHeight } = sizes(answer.state);

    // Scales: the whole motion is in the picture, unless it is many times as wide as the block.
    const floorY = height - BELOW;
    const peak = Math.max(headline.peak_m, pinned?.state.headline.peak_m ?? 0, 1e-6);
    const swing = Math.max(largestOf(answer).storey, pinned ? largestOf(pinned).storey : 0);
    const room = Math.max(peak + swing, Math.min(structure.gap_m ?? 0, 2 * peak)) + shown.tablePeak;
    const above = this.magnified ? ABOVE + 14 : ABOVE;
    const scale = Math.min((floorY - above) / (total + 1.6 * blockHeight), Math.max(0.55 * width, Math.min(0.92 * width, width - 2 * (ARROW + 18))) / (blockWidth + 2.2 * Math.min(room, 2 * blockWidth)));
    const [bw, bh] = [blockWidth * scale, blockHeight * scale];
    const wanted = Math.min((0.16 * width) / (peak * scale), (0.47 * width - bw / 2) / ((peak + swing) * scale));
    this.factor = this.magnified ? Math.max(1, floored(wanted)) : 1;
    const k = scale * this.factor;
    // Magnified, it is seen from the table: the ground passes behind.
    const seen = this.magnified && this.factor > 1;
    const passed = seen ? -ground * scale : ground * k;
    let tableX = width / 2 + (seen ? 0 : passed);
    // The block and the arrow at its edge do not leave the picture: the eye follows.
    const off = tableX + s * k;
    const edge = Math.min(width / 2, bw / 2 + ARROW + 16);
    const follow = Math.max(0, edge - off) + Math.min(0, width - edge - off);
    tableX += follow;
    const blockX = tableX + s * k;

    this.ground(c, width, height, floorY, seen ? passed : follow);
    const pendulum = answer.state.inputs.some(({ path }) => path === "slider.radius");
    const reach = Math.max(bw * 0.75, bw / 2 + Math.max(Math.min(structure.gap_m ?? 0, 2 * peak), peak) * k + 26);
    this.table(c, tableX, reach, floorY, width);
    const base = floorY - (pendulum ? 13 : 0);
    const frame: Frame = { c, answer, time, scale, k, tableX, floorY, base };

    // Where the block has slid so far: its scratch on the table.
    let [low, high] = [0, 0];
    for (let i = 0; i <= knot; i++) {
      const value = answer.s[i]!;
      if (value < low) low = value;
      if (value > high) high = value;
    }
    c.fillStyle = colour.slide!;
    c.globalAlpha = 0.5;
    c.fillRect(tableX + low * k - 1.5, floorY + 2, (high - low) * k + 3, 4);
    c.globalAlpha = 1;
    if ((high - low) * k > 6) this.part("How far it has slid", "The way of the block on the table until now.", tableX + low * k, floorY, (high - low) * k, 8);

    if (pendulum) this.dish(frame, Math.min(reach - 4, bw / 2 + peak * k + 14), blockX, bw);
    this.walls(frame, bw, bh, s, width);
    this.ghost(frame, bw, bh, blockX);
    if (structure.springs && !pendulum) this.spring(c, tableX - reach + 6, blockX - bw / 2, base - bh / 2);
    this.building(frame, bw, bh, blockX, mode);
    if (pinned) this.outline(frame, pinned);

    // Contents.
    for (let i = 0; i < structure.contents; i++) {
      const u = at(answer.time, answer.contents, time, structure.contents, i);
      c.fillStyle = colour.bound!;
      c.fillRect(blockX + u * k - 7 + 22 * i, base - bh - 14, 14, 14);
      this.part("Contents", "What stands on a floor and may slide there.", blockX + u * k - 7 + 22 * i, base - bh - 14, 14, 14);
    }

    this.friction(frame, knot, blockX, bw, bh);
    this.gauge(frame, knot, mode, width, height);
    this.scaleBar(c, width, k, units.length, seen);
    this.words(frame, s, mode);
  }

  private part(name: string, about: string, left: number, top: number, width: number, height: number): void {
    this.parts.push({ name, about, box: [left, top, width, height] });
  }

  /** A word that is read over whatever is behind it. */
  private label(c: CanvasRenderingContext2D, text: string, x: number, y: number, align: CanvasTextAlign, colour = this.colours.quiet!): void {
    c.font = "12px system-ui, sans-serif";
    c.textAlign = align;
    c.textBaseline = "alphabetic";
    c.lineJoin = "round";
    c.lineWidth = 4;
    c.strokeStyle = this.colours.sky!;
    c.strokeText(text, x, y);
    c.fillStyle = colour;
    c.fillText(text, x, y);
  }

  /** The ground, which stands; `shift` is by how much it has passed. */
  private ground(c: CanvasRenderingContext2D, width: number, height: number, floorY: number, shift: number): void {
    const top = floorY + 21;
    c.fillStyle = this.colours.ground!;
    c.fillRect(0, top, width, height - top);
    c.strokeStyle = this.colours.line!;
    c.lineWidth = 1;
    c.beginPath();
    for (let x = -40 + (shift % 13); x < width + 40; x += 13) {
      c.moveTo(x, height);
      c.lineTo(x + 16, top);
    }
    c.stroke();
  }

  private table(c: CanvasRenderingContext2D, x: number, reach: number, floorY: number, width: number): void {
    const colour = this.colours;
    c.fillStyle = colour["steel-soft"]!;
    c.fillRect(x - reach, floorY, 2 * reach, 16);
    c.fillStyle = colour.table!;
    for (const place of [-0.8, -0.4, 0, 0.4, 0.8]) {
      c.beginPath();
      c.arc(x + place * reach, floorY + 18.5, 3, 0, 2 * Math.PI);
      c.fill();
    }
    c.fillStyle = colour.ink!;
    c.font = "11px system-ui, sans-serif";
    c.textAlign = "left";
    c.textBaseline = "alphabetic";
    if (reach > 60) c.fillText("table", Math.max(4, x - reach + 6), floorY + 13);
    this.part("Shaking table", "It moves as the ground does.", Math.max(0, x - reach), floorY, Math.min(width, 2 * reach), 21);
  }

  /** Where the line of the gap or the stop is towards +x (1) or −x (−1); not a number where there is none. */
  private wallAt({ answer, tableX, k }: Frame, bw: number, sign: number): number {
    const { gap_m: gap, stop_m: stops } = answer.state.structure;
    return tableX + sign * (bw / 2 + ((stops ? stops[sign > 0 ? 0 : 1] : gap) ?? Number.NaN) * k);
  }

  /** The dish of a pendulum, deeper than it is, and what glides in it. */
  private dish(frame: Frame, reach: number, blockX: number, bw: number): void {
    const { c, tableX, floorY, base } = frame;
    const rise = 9;
    const wall = this.wallAt(frame, bw, 1);
    c.fillStyle = this.colours.table!;
    c.beginPath();
    c.moveTo(tableX - reach, floorY);
    c.lineTo(tableX - reach, floorY - rise);
    c.quadraticCurveTo(tableX, floorY + rise - 2, tableX + reach, floorY - rise);
    c.lineTo(tableX + reach, floorY);
    c.fill();
    const share = (blockX - tableX) / reach;
    const y = floorY - rise * share * share - 1;
    c.fillStyle = this.colours.steel!;
    c.beginPath();
    c.moveTo(blockX - Math.min(16, 0.3 * bw), base);
    c.lineTo(blockX + Math.min(16, 0.3 * bw), base);
    c.lineTo(blockX + 7, y);
    c.lineTo(blockX - 7, y);
    c.fill();
    if (!(Math.abs(wall - tableX - reach) < 34)) this.label(c, "dish", tableX + reach + 4, floorY - 3, "left");
    this.part("Dish", "The curved surface of the pendulum slider, drawn deeper than it is: the farther the block slides, the harder its weight pushes it back.", tableX - reach, floorY - rise, 2 * reach + 28, rise);
  }

  /** The gap or the stop, on both sides of the block. */
  private walls(frame: Frame, bw: number, bh: number, s: number, width: number): void {
    const { c, answer, floorY } = frame;
    const { structure, units } = answer.state;
    const colour = this.colours;
    const stops = structure.stop_m;
    const gaps = stops ?? (structure.gap_m === null ? [] : [structure.gap_m, structure.gap_m]);
    const top = floorY - Math.max(50, bh * 1.5);
    gaps.forEach((gap, side) => {
      if (gap === null || !Number.isFinite(gap)) return;
      const sign = side === 0 ? 1 : -1;
      const x = this.wallAt(frame, bw, sign);
      if (x < -8 || x > width + 8) return;
      const reached = sign * s >= gap;
      c.strokeStyle = reached ? colour.gap! : colour.quiet!;
      c.lineWidth = stops ? 6 : 2;
      c.setLineDash(stops ? [] : [5, 4]);
      c.beginPath();
      c.moveTo(x + (stops ? sign * 3 : 0), floorY);
      c.lineTo(x + (stops ? sign * 3 : 0), top);
      c.stroke();
      c.setLineDash([]);
      const size = `${Number((gap / units.length.in_si).toPrecision(3))} ${units.length.symbol}`;
      const word = stops ? "stop" : `gap ${size}`;
      const right = x + 64 < width;
      const left = x - 64 > 0;
      if (sign > 0) this.label(c, word, right ? x + 5 : Math.min(width - 4, x), top - 4, right ? "left" : "right", reached ? colour.gap : undefined);
      else if (stops) this.label(c, word, left ? x - 5 : Math.max(4, x), top - 4, left ? "right" : "left", reached ? colour.gap : undefined);
      this.part(stops ? "Stop" : "Gap", stops ? `The wall that the block strikes after ${size}.` : `The room that there is: ${size} to each side. This model has no wall at its end; a block that passes it would strike something.`, x - 9, top - 14, 18, floorY - top + 14);
    });
  }

  /** Where the block stood at first. */
  private ghost({ c, tableX, base }: Frame, bw: number, bh: number, blockX: number): void {
    c.strokeStyle = this.colours.quiet!;
    c.globalAlpha = 0.6;
    c.setLineDash([3, 4]);
    c.lineWidth = 1;
    c.strokeRect(tableX - bw / 2, base - bh, bw, bh);
    c.setLineDash([]);
    c.globalAlpha = 1;
    const away = blockX - tableX;
    if (Math.abs(away) < 3) return;
    const side = away > 0 ? -1 : 1;
    if (Math.abs(away) > 26) this.label(c, "start", tableX + (side * bw) / 2 - side * 2, base - bh - 5, side < 0 ? "left" : "right");
    const edge = side < 0 ? tableX - bw / 2 : tableX + bw / 2 - Math.abs(away);
    this.part("Start", "Where the block stood on the table before it slid.", edge, base - bh, Math.abs(away), bh);
  }

  private building({ c, answer, time, scale, k, base }: Frame, bw: number, bh: number, blockX: number, mode: number): void {
    const { structure } = answer.state;
    const colour = this.colours;
    c.fillStyle = colour.steel!;
    c.fillRect(blockX - bw / 2, base - bh, bw, bh - 3);
    c.fillStyle = mode === 0 ? colour.stick! : colour.slide!;
    c.fillRect(blockX - bw / 2, base - 4, bw, 4);
    if (bh > 22 && bw > 44) {
      c.fillStyle = colour.panel!;
      c.font = "12px system-ui, sans-serif";
      c.textAlign = "center";
      c.fillText("block", blockX, base - bh / 2 + 2);
    }
    this.part("Block", "The rigid base. The line beneath it is blue while it sticks to the table and orange while it slides.", blockX - bw / 2, base - bh, bw, bh);
    const storeys = structure.storeyMasses_kg.length;
    const { heights } = sizes(answer.state);
    let [x, y] = [blockX, base - bh];
    const heaviest = Math.max(1e-9, ...structure.storeyMasses_kg);
    for (let i = 0; i < storeys; i++) {
      const q = at(answer.time, answer.storeyDisplacement, time, storeys, i);
      const top = y - heights[i]! * scale;
      const next = blockX + q * k;
      const slab = Math.max(5, Math.min(0.3 * heights[i]! * scale, 0.55 * bh * Math.sqrt(structure.storeyMasses_kg[i]! / heaviest) + 4));
      c.strokeStyle = colour.steel!;
      c.lineWidth = Math.max(2, Math.min(6, bw * 0.03));
      for (const side of [-0.38, 0.38]) {
        c.beginPath();
        c.moveTo(x + side * bw, y);
        c.bezierCurveTo(x + side * bw, (y + top) / 2, next + side * bw, (y + top) / 2, next + side * bw, top + slab);
        c.stroke();
      }
      const roof = i === storeys - 1;
      c.fillStyle = roof ? colour.roof! : colour.steel!;
      c.fillRect(next - 0.46 * bw, top, 0.92 * bw, slab);
      if (roof) this.label(c, "roof", next + 0.46 * bw + 5, top + slab / 2 + 4, "left", colour.roof);
      this.part(structure.storeyNames[i] ?? "Storey", roof ? "The roof: the highest mass of the building, on columns that bend." : "A mass of the building, on columns that bend.", next - 0.5 * bw, top, bw, y - top);
      [x, y] = [next, top];
    }
  }

  /** The building of B, in outline, on the same table. */
  private outline({ c, scale, k, tableX, base, time }: Frame, pinned: Answer): void {
    const { heights, width, height } = sizes(pinned.state);
    const [bw, bh] = [width * scale, height * scale];
    const blockX = tableX + at(pinned.time, pinned.s, time) * k;
    c.strokeStyle = this.colours.versus!;
    c.lineWidth = 2;
    c.strokeRect(blockX - bw / 2, base - bh, bw, bh);
    this.part("Block of B", "The building of the setting that is kept, at the same time.", blockX - bw / 2, base - bh, bw, bh);
    let [x, y] = [blockX, base - bh];
    heights.forEach((storey, i) => {
      const next = blockX + at(pinned.time, pinned.storeyDisplacement, time, heights.length, i) * k;
      const top = y - storey * scale;
      c.beginPath();
      for (const side of [-0.38, 0.38]) {
        c.moveTo(x + side * bw, y);
        c.bezierCurveTo(x + side * bw, (y + top) / 2, next + side * bw, (y + top) / 2, next + side * bw, top);
      }
      c.moveTo(next - 0.46 * bw, top);
      c.lineTo(next + 0.46 * bw, top);
      c.stroke();
      [x, y] = [next, top];
    });
    this.label(c, "B", x - 0.46 * bw - 5, y + 5, "right", this.colours.versus);
  }

  /** The force of friction on the block, at the edge that it pulls. */
  private friction(frame: Frame, knot: number, blockX: number, bw: number, bh: number): void {
    const { c, answer, base } = frame;
    const most = largestOf(answer).friction;
    const force = -(answer.friction[knot] ?? 0);
    const length = most > 0 ? (ARROW * Math.abs(force)) / most : 0;
    if (length < 3) return;
    const sign = Math.sign(force);
    const [from, y] = [blockX + (sign * bw) / 2 + sign * 4, base - Math.min(9, bh / 2)];
    const to = from + sign * (length + 8);
    c.strokeStyle = c.fillStyle = this.colours.slide!;
    c.lineWidth = 3;
    c.beginPath();
    c.moveTo(from, y);
    c.lineTo(to - sign * 7, y);
    c.stroke();
    c.beginPath();
    c.moveTo(to, y);
    c.lineTo(to - sign * 9, y - 5);
    c.lineTo(to - sign * 9, y + 5);
    c.fill();
    // The word does not lie on the line of a gap, and is whole at the edge of the picture too.
    const wall = this.wallAt(frame, bw, sign);
    const beyond = sign * (wall - from) > -BESIDE && sign * (wall - from) < WORD;
    const word = beyond ? wall + sign * BESIDE : from;
    const room = box(this.canvas)[0] - WORD;
    this.label(c, "friction", sign > 0 ? Math.min(word, room) : Math.max(word, WORD), y - 8, sign > 0 ? "left" : "right", this.colours.slide);
    this.part("Friction", "The force of friction on the block. It holds the block while it sticks, and acts against its motion while it slides. The arrow is longest where the force is largest in this motion.", Math.min(from, to), y - 20, Math.abs(to - from), 26);
  }

  /** The force of friction over the weight, between what static friction can give; where it comes to that, the block slides, and friction falls to its kinetic level. */
  private gauge({ c, answer }: Frame, knot: number, mode: number, width: number, height: number): void {
    const { still, kinetic } = limitsOf(answer.state);
    const weight = answer.state.structure.weight_n;
    if (!still || !(weight > 0)) return;
    const colour = this.colours;
    const plane = answer.sy.length > 0;
    const along = -(answer.friction[knot] ?? 0) / weight;
    const used = plane ? Math.hypot(along, (answer.frictionY[knot] ?? 0) / weight) : along;
    const most = Math.max(...still, ...(kinetic ?? []), Math.abs(used)) * 1.08;
    const half = Math.min(170, 0.36 * width);
    const [middle, y] = [width / 2, height - 12];
    const x = (ratio: number) => middle + (ratio / most) * half;
    c.fillStyle = colour.panel!;
    c.strokeStyle = colour.line!;
    c.lineWidth = 1;
    c.fillRect(middle - half - 6, y - 7, 2 * half + 12, 14);
    c.strokeRect(middle - half - 6, y - 7, 2 * half + 12, 14);
    // From nothing to what is used.
    c.fillStyle = mode === 0 ? colour.stick! : colour.slide!;
    c.fillRect(Math.min(middle, x(used)), y - 4, Math.abs(x(used) - middle), 8);
    const mark = (ratio: number, size: number, stroke: string, lineWidth: number) => {
      c.strokeStyle = stroke;
      c.lineWidth = lineWidth;
      c.beginPath();
      c.moveTo(x(ratio), y - size);
      c.lineTo(x(ratio), y + size);
      c.stroke();
    };
    mark(0, 4, colour.quiet!, 1);
    for (const [ratios, size, stroke, wide] of [[kinetic, 5, colour.slide!, 1.5], [still, 8, colour.ink!, 2.5]] as const) {
      if (!ratios) continue;
      mark(plane ? ratios[0] : -ratios[0], size, stroke, wide);
      mark(ratios[1], size, stroke, wide);
    }
    const level = (word: string, [a, b]: readonly [number, number]) => `${word} ${plane || a === b ? `${plane ? "" : "± "}${shortly(b)}` : `−${shortly(a)}, +${shortly(b)}`}`;
    const words = ["friction over weight", level("static", still), ...(kinetic ? [level("kinetic", kinetic)] : [])];
    this.label(c, words.join(" · "), middle, y - 12, "center");
    this.part("Friction over weight", "The bar is the force of friction on the block, over its weight. The long marks are static friction: up to there the block sticks. Where the bar comes to one, the block slides, and friction has the kinetic level, at the short marks.", middle - half - 6, y - 24, 2 * half + 12, 32);
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
    for (let i = 1; i < turns; i++) c.lineTo(from + lead + (length * i) / turns, y + (i % 2 ? -6 : 6));
    c.lineTo(to - lead, y);
    c.lineTo(to, y);
    c.stroke();
    this.part("Spring", "It pulls the block back to where it stood.", Math.min(from, to), y - 8, Math.abs(to - from), 16);
  }

  /** Whether it sticks or slides, and whether it has come to where it could not go. */
  private words({ c, answer }: Frame, s: number, mode: number): void {
    const { gap_m: gap, stop_m: stops } = answer.state.structure;
    const colour = this.colours;
    const sliding = answer.sy.length > 0 ? "sliding" : mode > 0 ? "sliding →" : "← sliding";
    c.font = "600 13px system-ui, sans-serif";
    c.textAlign = "left";
    c.fillStyle = mode === 0 ? colour.stick! : colour.slide!;
    this.said = mode === 0 ? "stuck" : sliding;
    c.fillText(this.said, 14, 24);
    const stop = stops?.[s > 0 ? 0 : 1];
    const beyond = !stops && gap !== null && Math.abs(s) > gap;
    const atStop = typeof stop === "number" && Math.abs(s) >= stop;
    if (!beyond && !atStop) return;
    const where = beyond ? "beyond its gap: a wall there would stop it" : "at the stop";
    c.fillStyle = colour.gap!;
    c.fillText(where, 14, 42);
    this.said += `, ${where}`;
  }

  private scaleBar(c: CanvasRenderingContext2D, width: number, k: number, unit: { in_si: number; symbol: string }, seen: boolean): void {
    const wanted = (0.13 * width) / k / unit.in_si;
    const size = 10 ** Math.floor(Math.log10(wanted));
    const value = [1, 2, 5, 10].map((n) => n * size).filter((n) => n <= wanted).pop() ?? size;
    const length = value * unit.in_si * k;
    const [right, y] = [width - 16, 16];
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
    c.fillText(seen ? `${text}, displacements × ${this.factor}` : `${text}, true to scale`, right, y + 16);
    if (seen) c.fillText("seen from the table", right, y + 31);
  }
}

/** A factor with one or two digits, not above it. */
function floored(value: number): number {
  if (!(value > 1)) return 1;
  const step = value > 10 ? 10 ** Math.floor(Math.log10(value)) : 0.1;
  return Number((Math.floor(value / step + 1e-9) * step).toPrecision(3));
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

  /** Draws an instant, with the way of B where it has two directions too. */
  draw({ answer }: Shown, time: number, pinned: Answer | undefined): void {
    const made = context(this.canvas);
    if (!made) return;
    const [c, width, height] = made;
    const { structure, headline, units } = answer.state;
    const colour = this.colours;
    c.clearRect(0, 0, width, height);
    const gap = structure.gap_m !== null && structure.gap_m < 3 * headline.peak_m ? structure.gap_m : 0;
    const other = pinned && pinned.sy.length > 0 ? pinned : undefined;
    const reach = 1.12 * Math.max(headline.peak_m, other?.state.headline.peak_m ?? 0, gap, 1e-6);
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
    const way = (to: number, stroke: string, lineWidth: number, of = answer) => {
      c.strokeStyle = stroke;
      c.lineWidth = lineWidth;
      c.beginPath();
      for (let i = 0; i < to; i++) c.lineTo(px(of.s[i]!), py(of.sy[i]!));
      c.stroke();
    };
    way(answer.s.length, colour.line!, 1);
    if (other) {
      way(knotAt(other.time, time) + 1, colour.versus!, 1.2, other);
      c.fillStyle = colour.versus!;
      c.beginPath();
      c.arc(px(at(other.time, other.s, time)), py(at(other.time, other.sy, time)), 4, 0, 2 * Math.PI);
      c.fill();
    }
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

/** The force that the loop shows: with a spring its own too. */
const onSlider = (answer: Answer) => (answer.state.structure.springs ? answer.force : answer.friction);

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

  /** Draws the whole loop, over that of B. */
  show(answer: Answer, pinned: Answer | undefined): void {
    const made = context(this.canvas);
    if (!made) return;
    const [c, width, height] = made;
    const { units } = answer.state;
    const colour = this.colours;
    let [left, right, low, high] = [0, 0, 0, 0];
    const both = pinned ? [pinned, answer] : [answer];
    for (const one of both) {
      const values = onSlider(one);
      for (let i = 0; i < values.length; i++) {
        const [x, y] = [one.s[i]!, values[i]!];
        if (x < left) left = x;
        if (x > right) right = x;
        if (y < low) low = y;
        if (y > high) high = y;
      }
    }
    if (right - left <= 0) [left, right] = [-1e-3, 1e-3];
    if (high - low <= 0) [low, high] = [-1, 1];
    const edge = { left: 56, right: 14, top: 12, bottom: 36 };
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
      // Multiples of the step, not sums of it: what is zero is 0 and no rounding.
      for (let k = Math.ceil(from / unit / step); k * step <= to / unit + 1e-9; k++) list.push(k * step);
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
    for (const one of both) {
      const values = onSlider(one);
      c.strokeStyle = one === answer ? colour.stick! : colour.versus!;
      c.lineWidth = 1;
      c.beginPath();
      for (let i = 0; i < values.length; i++) {
        const [px, py] = [x(one.s[i]!), y(values[i]!)];
        if (i === 0) c.moveTo(px, py);
        else c.lineTo(px, py);
      }
      c.stroke();
    }
  }

  /** Marks one instant. */
  mark(answer: Answer, time: number): void {
    if (!this.map) return;
    const values = onSlider(answer);
    const [x, y] = [this.map.x(at(answer.time, answer.s, time)), this.map.y(at(answer.time, values, time))];
    this.dot.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
  }
}
