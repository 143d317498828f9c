/** Sliders and fields of the model's values, each with its unit. */

import { digits, fill, h } from "./dom";
import type { InputValue, Setting, State } from "./types";

interface Spec {
  label: string;
  /** Ends of the slider in SI. */
  min: number;
  max: number;
  log?: boolean;
}

/** Words and ranges of the keys that have a slider; `#` stands for a number. */
const SPECS: Record<string, Spec> = {
  "slider.static_friction": { label: "Static friction", min: 0, max: 0.3 },
  "slider.kinetic_friction": { label: "Kinetic friction", min: 0, max: 0.3 },
  "slider.kinetic_friction.slow": { label: "Kinetic friction at rest", min: 0, max: 0.3 },
  "slider.kinetic_friction.fast": { label: "Kinetic friction, fast", min: 0, max: 0.3 },
  "slider.static_friction.positive": { label: "Static friction, +x", min: 0, max: 0.3 },
  "slider.static_friction.negative": { label: "Static friction, −x", min: 0, max: 0.3 },
  "slider.kinetic_friction.positive": { label: "Kinetic friction, +x", min: 0, max: 0.3 },
  "slider.kinetic_friction.negative": { label: "Kinetic friction, −x", min: 0, max: 0.3 },
  "slider.radius": { label: "Radius of the pendulum", min: 0.2, max: 10, log: true },
  "slider.period": { label: "Sliding period", min: 0.5, max: 8 },
  "slider.spring": { label: "Spring", min: 100, max: 1e8, log: true },
  "slider.damping_ratio": { label: "Damping of the slider", min: 0, max: 0.5 },
  "slider.tilt": { label: "Tilt", min: -0.05, max: 0.05 },
  "slider.asymmetry": { label: "Asymmetry", min: -0.5, max: 0.5 },
  "slider.gap": { label: "Gap", min: 0.01, max: 1, log: true },
  "slider.stop.gap": { label: "Gap to the stop", min: 0.01, max: 1, log: true },
  "slider.stop.stiffness": { label: "Stiffness of the stop", min: 0, max: 0, log: true },
  "slider.stop.restitution": { label: "Restitution of the stop", min: 0, max: 1 },
  "slider.bounds.lower": { label: "Lower bound ×", min: 0.3, max: 1 },
  "slider.bounds.upper": { label: "Upper bound ×", min: 1, max: 3 },
  "block.mass": { label: "Mass of the block", min: 0, max: 0, log: true },
  "block.weight": { label: "Weight of the block", min: 0, max: 0, log: true },
  "storey.#.mass": { label: "Mass", min: 0, max: 0, log: true },
  "storey.#.weight": { label: "Weight", min: 0, max: 0, log: true },
  "storey.#.frequency": { label: "Frequency on a fixed base", min: 0.2, max: 20, log: true },
  "storey.#.period": { label: "Period on a fixed base", min: 0.05, max: 5, log: true },
  "storey.#.stiffness": { label: "Stiffness", min: 0, max: 0, log: true },
  "storey.#.damping_ratio": { label: "Damping ratio", min: 0, max: 0.2 },
  "frame.period": { label: "First period on a fixed base", min: 0.05, max: 5, log: true },
  "motion.scale": { label: "Scale of the record", min: 0.1, max: 5, log: true },
  "motion.scale_to": { label: "Peak acceleration of the table", min: 0.1, max: 15 },
  "motion.vertical_scale": { label: "Factor on the vertical motion", min: 0, max: 2 },
  "motion.scale_y": { label: "Further factor on y", min: 0.1, max: 5, log: true },
  "motion.rotate": { label: "Turn of the pair, x towards y", min: -Math.PI, max: Math.PI },
  "motion.sine.frequency": { label: "Frequency", min: 0.1, max: 20, log: true },
  "motion.sine.amplitude": { label: "Amplitude", min: 0.1, max: 15 },
  "motion.sweep.from": { label: "From", min: 0.1, max: 20, log: true },
  "motion.sweep.to": { label: "To", min: 0.1, max: 20, log: true },
  "motion.sweep.amplitude": { label: "Amplitude", min: 0.1, max: 15 },
  "motion.pulse.amplitude": { label: "Amplitude", min: 0.1, max: 15 },
  "motion.pulse.duration": { label: "Duration of the pulse", min: 0.05, max: 5, log: true },
  "isolator.period": { label: "Period of the isolators", min: 0.5, max: 8 },
  "analysis.tail": { label: "Free vibration after it", min: 0, max: 30 },
};

const GROUPS: [prefix: string, label: string][] = [
  ["slider", "Slider"],
  ["block", "Block"],
  ["storey", "Structure"],
  ["frame", "Structure"],
  ["motion", "Ground motion"],
  ["analysis", "Ground motion"],
];

const pattern = (path: string) => path.replace(/\.\d+(?=\.|$)/g, ".#");
/** The words of a value of the model. */
export function labelOf(path: string): string {
  const storey = /^storey\.(\d+)/.exec(path)?.[1];
  const label = SPECS[pattern(path)]?.label ?? path;
  return storey === undefined ? label : `Storey ${storey}, ${label.toLowerCase()}`;
}

const round = (value: number, count = 3) => Number(value.toPrecision(count));

/** One value: its field, its unit, its slider. */
class Control {
  readonly element: HTMLElement;
  private readonly range: HTMLInputElement;
  private readonly field: HTMLInputElement;
  private readonly unit: HTMLElement;
  private readonly problem = h("p", { class: "fault", hidden: true });
  private ends: [number, number] = [0, 1];
  /** Something is typed that is not taken in yet. */
  private typed = false;
  input: InputValue;

  constructor(
    input: InputValue,
    private readonly spec: Spec,
    label: string,
    private readonly onset: (path: string, value: string) => void,
    /** A movement begins or ends. */
    onrest: () => void,
  ) {
    this.input = input;
    const id = `value-${input.path.replace(/\W/g, "-")}-${++made}`;
    this.field = h("input", { type: "text", id, inputmode: "decimal", autocomplete: "off", spellcheck: "false" });
    this.unit = h("span", { class: "unit" });
    this.range = h("input", { type: "range", min: 0, max: 1000, step: 1, "aria-label": label });
    this.element = h("div", { class: "control" }, h("label", { for: id }, label), this.field, this.unit, this.range, this.problem);
    this.problem.id = `${id}-fault`;
    this.field.addEventListener("input", () => (this.typed = true));
    this.field.addEventListener("blur", () => {
      if (this.typed) this.field.value = this.input.shown ?? "";
      this.typed = false;
    });
    for (const kind of ["pointerdown", "pointerup", "keydown"]) this.range.addEventListener(kind, onrest);
    this.range.addEventListener("input", () => {
      const value = this.valueAt(Number(this.range.value) / 1000);
      this.paint();
      this.field.value = digits(value / (this.input.in_si ?? 1), 3).replace("−", "-");
      this.onset(this.input.path, this.written(value));
    });
    this.range.addEventListener("change", onrest);
    this.field.addEventListener("change", () => {
      this.typed = false;
      const text = this.field.value.trim().replace("−", "-").replace(/^(\d+),(\d+)$/, "$1.$2");
      const symbol = this.input.symbol ?? "";
      const bare = /^[-+]?[\d.]+(e[-+]?\d+)?$/i.test(text);
      this.onset(this.input.path, bare && symbol ? `${text} ${symbol}` : text);
      onrest();
    });
    this.update(input);
  }

  private written(si: number): string {
    const shown = String(round(si / (this.input.in_si ?? 1)));
    return this.input.symbol ? `${shown} ${this.input.symbol}` : shown;
  }

  private valueAt(share: number): number {
    const [min, max] = this.ends;
    const value = this.spec.log ? min * (max / min) ** share : min + (max - min) * share;
    return this.spec.log ? value : Math.round(value / ((max - min) / 1000)) * ((max - min) / 1000);
  }

  private shareOf(value: number): number {
    const [min, max] = this.ends;
    return this.spec.log ? Math.log(Math.max(value, min) / min) / Math.log(max / min) : (value - min) / (max - min);
  }

  private paint(): void {
    this.range.style.setProperty("--at", `${Number(this.range.value) / 10}%`);
  }

  get dragging(): boolean {
    return this.range.matches(":active");
  }

  update(input: InputValue): void {
    this.input = input;
    this.right();
    const value = input.value ?? 0;
    let { min, max } = this.spec;
    if (max === 0) {
      // A decade to each side of where it stood.
      if (this.ends[0] === 0 || value < this.ends[0] || value > this.ends[1]) {
        this.ends = [value / 10, value * 10];
      }
    } else {
      if (value > max) max = value * 1.5;
      if (value < min) min = this.spec.log ? value / 2 : value * 1.5;
      this.ends = [min, max];
    }
    this.unit.textContent = input.symbol ?? "";
    this.unit.title = `written as ${input.text}`;
    if (!this.typed) this.field.value = input.shown ?? "";
    if (!this.dragging) {
      this.range.value = String(Math.round(1000 * this.shareOf(value)));
      this.range.setAttribute("aria-valuetext", `${input.shown} ${input.symbol ?? ""}`.trim());
      this.paint();
    }
  }

  /** What is typed and not taken in yet is given up. */
  release(): void {
    this.typed = false;
  }

  private right(): void {
    if (this.problem.hidden) return;
    this.field.removeAttribute("aria-invalid");
    this.field.removeAttribute("aria-describedby");
    this.field.title = "";
    this.problem.hidden = true;
  }

  /** Marks what was written and cannot be, and says why beneath it. */
  refuse(written: string, message: string): void {
    this.field.value = written;
    this.field.setAttribute("aria-invalid", "true");
    this.field.setAttribute("aria-describedby", this.problem.id);
    this.field.title = message;
    this.problem.hidden = false;
    this.problem.textContent = message;
  }
}

let made = 0;

const RESTORING: [key: string, label: string, first: (state: State) => string][] = [
  ["none", "None", () => ""],
  ["radius", "Pendulum", () => "2 m"],
  ["period", "Spring by period", () => "3 s"],
  ["spring", "Spring by stiffness", (state) => `${round((state.structure.weight_n / 2))} N/m`],
];

/** All controls of a model. */
export class Controls {
  readonly element = h("div", {});
  private controls = new Map<string, Control>();
  private shape = "";
  /** Where the other coefficient stood before a movement took it along, and whether that has moved it. */
  private along: { path: string; value: number; moved: boolean } | undefined;
  private select: HTMLSelectElement | undefined;
  /** A value that has a control in another place too. */
  readonly second = h("div", { class: "second" });
  private secondPath: string | undefined;
  private secondControl: Control | undefined;
  /** It is brought into view until a person moves on the page. */
  private brings = false;

  constructor(
    private readonly onset: (settings: Setting[]) => void,
    /** What is put at the head of the ground motion's group. */
    private readonly motion: HTMLElement,
  ) {
    for (const kind of ["pointerdown", "wheel", "keydown", "touchmove"]) addEventListener(kind, () => (this.brings = false), { passive: true });
  }

  update(state: State): void {
    const wanted = state.inputs.filter((input) => input.value !== undefined && input.value !== null && SPECS[pattern(input.path)]);
    const restoring = this.restoring(state);
    const shape = `${wanted.map((input) => `${input.path} ${input.symbol}`).join()}|${restoring}|${state.structure.storeyNames.join()}`;
    if (shape !== this.shape) {
      this.shape = shape;
      this.build(state, wanted);
    }
    for (const input of wanted) this.controls.get(input.path)?.update(input);
    // A choice that could not be leaves the select as it was.
    if (this.select) this.select.value = restoring;
    this.updateSecond(wanted);
  }

  /** Gives a value a control in another place too; none without a path. */
  twice(path: string | undefined, state: State | undefined): void {
    this.secondPath = path;
    this.brings = path !== undefined;
    this.secondControl = undefined;
    this.second.replaceChildren();
    if (state) this.updateSecond(state.inputs);
  }

  /** Brings it into view where a person has not moved since; in another page's frame that page would be scrolled. */
  bring(): void {
    if (this.brings && window.self === window.top) requestAnimationFrame(() => this.second.scrollIntoView({ block: "nearest" }));
  }

  private updateSecond(inputs: InputValue[]): void {
    const input = inputs.find(({ path }) => path === this.secondPath);
    const known = this.secondControl;
    if (!input || typeof input.value !== "number") {
      this.second.replaceChildren();
      this.secondControl = undefined;
    } else if (known) known.update(input);
    else {
      this.secondControl = new Control(input, SPECS[pattern(input.path)]!, labelOf(input.path), (path, value) => this.set(path, value), () => (this.along = undefined));
      this.second.replaceChildren(this.secondControl.element);
      this.bring();
    }
  }

  /** Another model is opened: what is typed and not taken in yet is given up. */
  release(): void {
    this.along = undefined;
    for (const control of this.controls.values()) control.release();
    this.secondControl?.release();
  }

  /** Marks values that were set and cannot be. */
  refuse(settings: Setting[], message: string): void {
    for (const [path, value] of settings) {
      this.controls.get(path)?.refuse(value, message);
      if (path === this.secondPath) this.secondControl?.refuse(value, message);
    }
  }

  private restoring(state: State): string {
    const has = (key: string) => state.inputs.find((input) => input.path === `slider.${key}`);
    if (has("surface.1.friction") || has("triple.friction.1")) return "";
    const key = ["radius", "period", "spring"].find(has);
    return key === undefined || (key === "spring" && has("spring")?.value === 0) ? "none" : key;
  }

  private build(state: State, wanted: InputValue[]): void {
    // A value that a person is about to change keeps its place.
    const groups = new Map<string, HTMLElement[]>();
    const into = (label: string, element: HTMLElement) => groups.set(label, [...(groups.get(label) ?? []), element]);
    const old = this.controls;
    this.controls = new Map();
    const storeys = state.structure.storeyNames.length;
    for (const input of wanted) {
      const spec = SPECS[pattern(input.path)]!;
      const group = GROUPS.find(([prefix]) => input.path.startsWith(prefix))?.[1];
      if (!group || (input.path === "slider.spring" && input.value === 0)) continue;
      const storey = /^storey\.(\d+)/.exec(input.path)?.[1];
      const label = storey && storeys > 1 ? `${state.structure.storeyNames[Number(storey) - 1]}: ${spec.label.toLowerCase()}` : storey && spec.label === "Mass" ? "Mass of the storey" : spec.label;
      const kept = old.get(input.path);
      const control = kept ?? new Control(input, spec, label, (path, value) => this.set(path, value), () => (this.along = undefined));
      this.controls.set(input.path, control);
      into(group, control.element);
    }
    const restoring = this.restoring(state);
    this.select = undefined;
    if (restoring) {
      const select = h("select", { id: `restoring-${++made}` }, ...RESTORING.map(([key, label]) => h("option", { value: key, selected: key === restoring }, label)));
      select.addEventListener("change", () => {
        const chosen = RESTORING.find(([key]) => key === select.value)!;
        const setting: Setting = select.value === "none" ? ["slider.spring", "0 N/m"] : [`slider.${chosen[0]}`, chosen[2](state)];
        this.onset([setting]);
      });
      this.select = select;
      const place = h("div", { class: "choice" }, h("label", { for: select.id }, "Restoring force"), select);
      const slider = groups.get("Slider") ?? [];
      groups.set("Slider", [...slider.slice(0, 2), place, ...slider.slice(2)]);
    }
    groups.set("Ground motion", [this.motion, ...(groups.get("Ground motion") ?? [])]);
    const order = ["Slider", "Ground motion", "Structure", "Block"];
    fill(
      this.element,
      ...order.filter((label) => groups.has(label)).map((label) => {
        const all = groups.get(label)!;
        const many = label === "Structure" && all.length > 6;
        return h("fieldset", { class: "group" }, h("legend", {}, label), ...(many ? [h("details", { class: "fold" }, h("summary", {}, `${all.length} values`), ...all)] : all));
      }),
    );
  }

  /** Kinetic friction is at most the static one: the one that is moved takes the other along, and back. */
  private set(path: string, value: string): void {
    const settings: Setting[] = [[path, value]];
    const number = Number(value);
    const other = path === "slider.kinetic_friction" ? "slider.static_friction" : path === "slider.static_friction" ? "slider.kinetic_friction" : undefined;
    const beside = other && this.controls.get(other)?.input.value;
    if (other && typeof beside === "number" && Number.isFinite(number)) {
      if (this.along?.path !== other) this.along = { path: other, value: beside, moved: false };
      const { along } = this;
      const wanted = path === "slider.kinetic_friction" ? Math.max(number, along.value) : Math.min(number, along.value);
      // Once moved it is said with every step: what the last answer says may be older than what was set since.
      along.moved ||= wanted !== along.value;
      if (along.moved) settings.unshift([other, wanted === number ? value : String(wanted)]);
    }
    this.onset(settings);
  }
}
