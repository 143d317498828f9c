/** The three pictures over time: sliding displacement, accelerations, and one to choose. */

import { fill, h } from "./dom";
import { Chart, type Clock, intervals, type Line, type Overlay } from "./plots";
import type { Palette } from "./scene";
import type { Answer, Beside, Judgement } from "./types";

const CHOICES: [string, string][] = [
  ["energy", "Energy"],
  ["storeys", "Storey displacements"],
  ["force", "Force on the slider"],
  ["velocity", "Sliding velocity"],
];

/** One storey of a history of all storeys, knot after knot. */
function storey(values: Float64Array, place: number, count: number): Float64Array {
  const out = new Float64Array(count ? values.length / count : 0);
  for (let i = 0; i < out.length; i++) out[i] = values[i * count + place]!;
  return out;
}

const storeysOf = (answer: Answer | undefined) => answer?.state.structure.storeyMasses_kg.length ?? 0;

/** The sliding displacement; of two directions, its size. */
const resultant = ({ s, sy }: Answer) => (sy.length > 0 ? s.map((x, i) => Math.hypot(x, sy[i]!)) : s);

export class Histories {
  readonly element: HTMLElement;
  private readonly sliding: Chart;
  private readonly acceleration: Chart;
  private readonly third: Chart;
  private readonly choice = h("select", { "aria-label": "What the third picture shows" });
  private answer: Answer | undefined;
  private judgement: Judgement | undefined;
  private pinned: Answer | undefined;
  private energyShown = false;

  constructor(
    private readonly clock: Clock,
    private colours: Palette,
  ) {
    fill(this.choice, ...CHOICES.map(([value, label]) => h("option", { value }, label)));
    this.choice.addEventListener("change", () => this.drawThird());
    const make = (head: Node, height: number) => new Chart(clock, [head], colours, height);
    this.sliding = make(h("h2", {}, "Sliding displacement"), 220);
    this.acceleration = make(h("h2", {}, "Accelerations"), 220);
    this.third = make(this.choice, 200);
    this.element = h("section", { class: "plots", "aria-label": "Histories" }, this.sliding.element, this.acceleration.element, this.third.element);
  }

  restyle(colours: Palette): void {
    this.colours = colours;
    for (const chart of this.clock.charts) chart.restyle(colours);
  }

  /** Draws an answer, with what is known of it by now, and B where one is kept. */
  show(answer: Answer, judgement: Judgement | undefined, pinned: Answer | undefined): void {
    this.answer = answer;
    this.judgement = judgement;
    this.pinned = pinned;
    this.clock.sliding = intervals(answer.time, answer.mode);
    this.drawSliding();
    this.drawAccelerations();
    this.drawThird();
  }

  /** Adds what the check says. */
  judged(judgement: Judgement): void {
    this.judgement = judgement;
    this.drawSliding();
    if (this.choice.value === "energy") this.drawThird();
  }

  /** A history of B, as it stands behind the others. */
  private ofPinned(of: string, values: (pinned: Answer) => Float64Array): Overlay[] {
    const { pinned, colours } = this;
    return pinned ? [{ label: `B ${of}`.trim(), colour: colours.versus!, time: pinned.time, s: values(pinned), width: 1.6 }] : [];
  }

  private drawSliding(): void {
    const { answer, colours, judgement } = this;
    if (!answer) return;
    const gap = answer.state.structure.gap_m;
    const peak = answer.state.headline.peak_m;
    const near = gap !== null && gap < 2.5 * peak ? [gap, -gap] : [];
    const of = (label: string, colour: string, beside: Beside | undefined, dash = false) => (beside ? [{ ...beside, label, colour, dash }] : []);
    const one = [{ label: judgement?.lower ? "nominal friction" : "now", colour: colours.stick!, values: answer.s, width: 1.7 }];
    const two = [
      { label: "along x", colour: colours.stick!, values: answer.s, width: 1.2 },
      { label: "along y", colour: colours.bound!, values: answer.sy, width: 1.2 },
      { label: "resultant", colour: colours.ink!, values: resultant(answer), width: 1.7 },
    ];
    this.sliding.show({
      time: answer.time,
      lines: answer.sy.length > 0 ? two : one,
      overlays: [
        // Those of the bounds are along x alone.
        ...(answer.sy.length > 0 ? [] : of("lower friction", colours.bound!, judgement?.lower)),
        ...(answer.sy.length > 0 ? [] : of("upper friction", colours.table!, judgement?.upper)),
        ...of("stepwise", colours.gap!, judgement?.steps, true),
        ...this.ofPinned(this.pinned?.sy.length ? "resultant" : "", resultant),
      ],
      limits: near,
      title: "Sliding",
      unit: answer.state.units.length,
    });
  }

  private drawAccelerations(): void {
    const { answer, colours } = this;
    if (!answer) return;
    const storeys = answer.state.structure.storeyMasses_kg.length;
    const lines: Line[] = [
      { label: "table", colour: colours.table!, values: answer.table, width: 1 },
      { label: "block", colour: colours.block!, values: answer.block, width: 1 },
    ];
    if (storeys > 0) {
      const roof = storey(answer.storeyAcceleration, storeys - 1, storeys);
      lines.push({ label: "roof", colour: colours.roof!, values: roof, width: 1 });
    }
    this.acceleration.show({
      time: answer.time,
      lines,
      overlays: this.ofPinned(storeysOf(this.pinned) > 0 ? "roof" : "block", (pinned) => (storeysOf(pinned) > 0 ? storey(pinned.storeyAcceleration, storeysOf(pinned) - 1, storeysOf(pinned)) : pinned.block)),
      title: "Acceleration",
      unit: answer.state.units.acceleration,
    });
  }

  private drawThird(): void {
    const { answer, colours } = this;
    if (!answer) return;
    const { units, structure } = answer.state;
    const show = (title: string, lines: Line[], overlays: Overlay[], unit = units.length) => this.third.show({ time: answer.time, lines, overlays, title, unit });
    const storeys = structure.storeyMasses_kg.length;
    switch (this.choice.value) {
      case "energy":
        this.drawEnergy(answer);
        return;
      case "storeys": {
        const shown = storeys > 3 ? [0, Math.floor(storeys / 2), storeys - 1] : [...Array(storeys).keys()];
        const colour = [colours.stick!, colours.bound!, colours.roof!];
        const lines = shown.map((place, i) => ({ label: structure.storeyNames[place] ?? "", colour: colour[shown.length === 1 ? 2 : i]!, values: storey(answer.storeyDisplacement, place, storeys) }));
        const none = [{ label: "no storeys", colour: colours.quiet!, values: new Float64Array(answer.time.length) }];
        const count = storeysOf(this.pinned);
        show("Displacement", lines.length ? lines : none, count > 0 ? this.ofPinned("roof", (pinned) => storey(pinned.storeyDisplacement, count - 1, count)) : []);
        break;
      }
      case "force":
        show(
          "Force",
          [
            { label: "all of the slider", colour: colours.stick!, values: answer.force },
            { label: "friction alone", colour: colours.slide!, values: answer.friction, width: 1 },
          ],
          this.ofPinned("all of the slider", (pinned) => pinned.force),
          units.force,
        );
        break;
      default:
        show("Velocity", [{ label: "now", colour: colours.stick!, values: answer.velocity }], this.ofPinned("", (pinned) => pinned.velocity), units.velocity);
    }
    this.energyShown = false;
  }

  /** Energies come with the check; until then those of the answer before it stay. */
  private drawEnergy(answer: Answer): void {
    const { colours, judgement } = this;
    const colour = [colours.quiet!, colours.stick!, colours.roof!, colours.bound!, colours.slide!];
    const names = ["input", "kinetic", "strain", "damping", "friction"];
    const none = new Float64Array(answer.time.length).fill(Number.NaN);
    const known = (values: Float64Array | undefined) => (values?.length === answer.time.length ? values : none);
    const lines = names.map((label, i) => ({ label, colour: colour[i]!, values: known(judgement?.energy[i]), width: 1.4 }));
    if (judgement || !this.energyShown) this.third.show({ time: answer.time, lines, title: "Energy", unit: answer.state.units.energy });
    this.energyShown = true;
  }
}
