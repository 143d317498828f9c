/** The guided scenes: a question, what to drag, what to see, and an answer whose figures are computed where it is read. */

import rigidSine from "../../../../../examples/paper/section3-124kg-free-sine.toml";
import rigidTaft from "../../../../../examples/paper/section3-124kg-free-taft.toml";
import oscillator from "../../../../../examples/paper/section6-45kg-1_625hz-sine.toml";
import oscillatorTaft from "../../../../../examples/paper/section6-45kg-1_625hz-taft.toml";
import taftTwo from "../../../../../examples/taft-two-directions.toml";
import taft from "../../../../../examples/taft.toml";
import { digits } from "../dom";
import type { Setting, State } from "../types";

/** What the answer speaks of: an analysis of the scene's model, or of another text, with keys set. */
export interface Run {
  text?: string;
  set?: Setting[];
}

/** A button that does what is to be dragged. */
export interface Step {
  label: string;
  set: Setting[];
}

export interface Guide {
  /** Its name in an address. */
  id: string;
  title: string;
  question: string;
  /** The model's text. */
  model: string;
  /** The text that is kept as B. */
  pinned?: string;
  drag: string;
  /** The value that is dragged, by its path. */
  path: string;
  steps: Step[];
  see: string;
  runs: Record<string, Run>;
  /** Paragraphs of the runs' figures. */
  answer: (of: Record<string, State>) => string[];
}

/** An example under another name, with parts of its text replaced; each must be there once. */
function edited(text: string, name: string, ...changes: [from: string | RegExp, to: string][]): string {
  let made = text.replace(/^#.*\n/gm, "").replace(/^name = .*$/m, `name = ${JSON.stringify(name)}`).replaceAll("../records/", "records/");
  for (const [from, to] of changes) made = made.replace(from, to);
  return made;
}

const length = ({ units }: State, value_m: number) => `${digits(Math.abs(value_m) / units.length.in_si, 3)} ${units.length.symbol}`;
const acceleration = ({ units }: State, value: number) => `${digits(value / units.acceleration.in_si, 3)} ${units.acceleration.symbol}`;
const peak = (state: State) => length(state, state.headline.peak_m);
const residual = (state: State) => length(state, state.headline.residual_m);
const roof = (state: State) => acceleration(state, state.headline.roof_m_per_s2 ?? 0);
const block = (state: State) => acceleration(state, state.headline.block_m_per_s2);
const input = (state: State, path: string) => state.inputs.find((input) => input.path === path)?.value ?? Number.NaN;
const ratio = (a: number, b: number) => digits(a / b, 2);
const times = (count: number) => (count === 1 ? "once" : `${count} times`);

const friction = (static_: string, kinetic: string): Setting[] => [["slider.static_friction", static_], ["slider.kinetic_friction", kinetic]];

const STICK = edited(rigidSine, "Why it sticks: 124 kg block, a 1.5 Hz sine", ['amplitude = "3 m/s2"', 'amplitude = "1.4 m/s2"']);
const STATIC = edited(rigidSine, "Static above kinetic: 124 kg block, a 1.5 Hz sine", ['amplitude = "3 m/s2"', 'amplitude = "1.6 m/s2"']);
const RESIDUAL = edited(oscillatorTaft, "Residual and radius: 45 kg on the block of 325 kg, Taft 1952", ["kinetic_friction = 0.012", 'kinetic_friction = 0.012\nradius = "10 m"']);
const RESONANCE = edited(oscillator, "Resonance: 45 kg at 1.625 Hz on the block of 325 kg");
const STOP = edited(taft, "The stop: one storey on sliders, Taft 1952", [/^gap .*\n/m, ""], [/^bounds.*\n/m, '\n[slider.stop]\ngap = "40 mm"\nstiffness = "10 kN/mm"\n']);
const BOUNDS = edited(taft, "Lower against upper bound: one storey on sliders, Taft 1952");
const VERTICAL = edited(rigidTaft, "Vertical motion: 124 kg block, Taft 1952", [/^(scale_to .*)$/m, '$1\nvertical = "records/taft-021.txt"\nvertical_scale = 0']);
const TWO = edited(taftTwo, "Two directions: pendulum sliders, Taft 1952", [/^scale_to.*$/m, "scale = 2.8"]);
const ONE = TWO.replace(/^record_y.*\n/m, "").replace(/^period_y.*\n/m, "").replace(/^rotate.*\n/m, "");

/** Frequencies of the table that the answer on resonance looks through, in Hz. */
const FREQUENCIES = Array.from({ length: 49 }, (_, i) => Number((1 + 0.05 * i).toFixed(2)));
const TURNS = Array.from({ length: 12 }, (_, i) => 15 * i);

export const SCENES: Guide[] = [
  {
    id: "sticking",
    title: "Why it sticks",
    question: "The table shakes, and the block rides along without sliding. How hard must it be shaken before it slides?",
    model: STICK,
    drag: "Amplitude, slowly, from 1.4 to 1.8 m/s².",
    path: "motion.sine.amplitude",
    steps: [{ label: "1.6 m/s²", set: [["motion.sine.amplitude", "1.6 m/s2"]] }, { label: "1.7 m/s²", set: [["motion.sine.amplitude", "1.7 m/s2"]] }],
    see: "The arrow of friction grows with the table's acceleration until friction has no more to give. Then the line under the block turns orange.",
    runs: {
      below: { set: [["motion.sine.amplitude", "1.6 m/s2"]] },
      above: { set: [["motion.sine.amplitude", "1.7 m/s2"]] },
      heavy: { set: [["motion.sine.amplitude", "1.7 m/s2"], ["block.mass", "248 kg"]] },
    },
    answer: ({ below, above, heavy }) => [
      `To take the block along, friction must give its mass times the table's acceleration. It has at most the static friction times the weight, so the block slides once the table passes ${digits(input(below!, "slider.static_friction"), 3)} × 9.81 m/s² = ${digits(9.81 * input(below!, "slider.static_friction"), 3)} m/s².`,
      `At 1.6 m/s² it slides ${times(below!.headline.slips)}; at 1.7 m/s² ${times(above!.headline.slips)}, by up to ${peak(above!)}. Mass does not matter: twice as heavy, it slides ${peak(heavy!)}.`,
    ],
  },
  {
    id: "static-kinetic",
    title: "Static above kinetic",
    question: "On the paper's block, static friction is only 8 % above kinetic friction. Does so little matter?",
    model: STATIC,
    pinned: edited(STATIC, "Equal coefficients", ["static_friction  = 0.165", "static_friction  = 0.153"]),
    drag: "Static friction, down to the kinetic friction of 0.153. B, in outline, has them equal already.",
    path: "slider.static_friction",
    steps: [{ label: "0.153", set: [["slider.static_friction", "0.153"]] }, { label: "0.165", set: [["slider.static_friction", "0.165"]] }],
    see: "Between the two lies the acceleration of this table. With the higher static friction the block never lets go; with equal coefficients it slides in every half cycle.",
    runs: { higher: {}, equal: { set: [["slider.static_friction", "0.153"]] }, strong: { set: [["motion.sine.amplitude", "3 m/s2"]] }, strongEqual: { set: [["motion.sine.amplitude", "3 m/s2"], ["slider.static_friction", "0.153"]] } },
    answer: ({ higher, equal, strong, strongEqual }) => [
      `Near the threshold it decides everything: with 0.165 the block slides ${times(higher!.headline.slips)}, with 0.153 ${times(equal!.headline.slips)}, by up to ${peak(equal!)}.`,
      `Well above it, little: at 3 m/s² the block slides ${peak(strong!)} with the higher static friction and ${peak(strongEqual!)} with equal coefficients, for while it slides only the kinetic one acts.`,
    ],
  },
  {
    id: "residual",
    title: "Residual and radius",
    question: "After the earthquake the block does not stand where it stood. What brings it back?",
    model: RESIDUAL,
    drag: "Radius of the pendulum, from 10 m down to 0.5 m.",
    path: "slider.radius",
    steps: [{ label: "2 m", set: [["slider.radius", "2 m"]] }, { label: "0.5 m", set: [["slider.radius", "0.5 m"]] }, { label: "Flat, no restoring force", set: [["slider.spring", "0 N/m"]] }],
    see: "Residual, in the headline, and the end of the curve of sliding displacement.",
    runs: { flat: { set: [["slider.spring", "0 N/m"]] }, ten: { set: [["slider.radius", "10 m"]] }, two: { set: [["slider.radius", "2 m"]] }, half: { set: [["slider.radius", "0.5 m"]] } },
    answer: ({ flat, ten, two, half }) => [
      `A curved dish pushes the block back by its weight times its displacement over the radius. On a flat surface ${residual(flat!)} remain of a peak of ${peak(flat!)}; with a radius of 10 m ${residual(ten!)}, of 2 m ${residual(two!)}, of 0.5 m ${residual(half!)}.`,
      `It need not come back all the way: friction holds the block wherever the push is less than it, within static friction × radius, ${digits(1000 * input(two!, "slider.static_friction") * 2, 3)} mm with 2 m. The paper found on its table that what was predicted and what was measured came much closer together once a spring linked block and table.`,
    ],
  },
  {
    id: "resonance",
    title: "Resonance and the amplification window",
    question: "Sliding protects the mass on top from resonance. Always?",
    model: RESONANCE,
    drag: "Frequency of the table, from 1 to 2.5 Hz, through that of the oscillator.",
    path: "motion.sine.frequency",
    steps: [{ label: "1.625 Hz", set: [["motion.sine.frequency", "1.625 Hz"]] }, { label: "1.75 Hz", set: [["motion.sine.frequency", "1.75 Hz"]] }, { label: "2.5 Hz", set: [["motion.sine.frequency", "2.5 Hz"]] }],
    see: "Roof acceleration, against the 1 m/s² of the table, and the table of a fixed base beside the pictures.",
    runs: Object.fromEntries(FREQUENCIES.map((f) => [`${f}`, { set: [["motion.sine.frequency", `${f} Hz`]] }])),
    answer: (of) => {
      const all = FREQUENCIES.map((f) => [f, of[f]!.headline.roof_m_per_s2 ?? 0, of[f]!] as const);
      const above = all.filter(([, roof]) => roof > 1).map(([f]) => f);
      const [at, most, state] = all.reduce((a, b) => (b[1] > a[1] ? b : a));
      const [m1, m2] = [input(state, "block.mass"), input(state, "storey.1.mass")];
      return [
        `Nearly always. Of ${all.length} frequencies from 1 to 3.4 Hz the mass feels more than the table's 1 m/s² only from ${above[0]} to ${above.at(-1)} Hz: the paper's narrow window of amplification.`,
        `Its peak, ${acceleration(state, most)} at ${at} Hz, lies slightly above the 1.625 Hz of the oscillator on a fixed base: on a block that slides freely it swings against the block, at 1.625 Hz × √(1 + ${m2}/${m1}) = ${digits(1.625 * Math.sqrt(1 + m2 / m1), 4)} Hz.`,
      ];
    },
  },
  {
    id: "stop",
    title: "The stop",
    question: "A wall ends the travel of the sliders. What does the building feel of it?",
    model: STOP,
    drag: "Gap to the stop, from 40 to 80 mm.",
    path: "slider.stop.gap",
    steps: [{ label: "20 mm", set: [["slider.stop.gap", "20 mm"]] }, { label: "40 mm", set: [["slider.stop.gap", "40 mm"]] }, { label: "80 mm", set: [["slider.stop.gap", "80 mm"]] }],
    see: "The block is stopped at the wall, and its acceleration jumps.",
    runs: { narrow: { set: [["slider.stop.gap", "20 mm"]] }, middle: { set: [["slider.stop.gap", "40 mm"]] }, wide: { set: [["slider.stop.gap", "80 mm"]] } },
    answer: ({ narrow, middle, wide }) => [
      `With 80 mm it never strikes: it slides ${peak(wide!)}, and the roof feels ${roof(wide!)}, the block ${block(wide!)}.`,
      `With 40 mm the wall keeps it to ${peak(middle!)}, and the block feels ${block(middle!)}; with 20 mm it is ${peak(narrow!)} and ${block(narrow!)}. The wall saves room and gives shocks; the roof feels ${roof(middle!)} and ${roof(narrow!)}.`,
    ],
  },
  {
    id: "bounds",
    title: "Lower against upper bound",
    question: "Friction is known only within bounds, here × 0.8 and × 1.3. Which of them is the worse?",
    model: BOUNDS,
    pinned: edited(BOUNDS, "Upper bound of friction", ["static_friction  = 0.060", "static_friction  = 0.078"], ["kinetic_friction = 0.050", "kinetic_friction = 0.065"], [/^bounds.*\n/m, ""]),
    drag: "Kinetic friction, from 0.05 to 0.04, its lower bound. B has the upper bound.",
    path: "slider.kinetic_friction",
    steps: [{ label: "Lower bound", set: friction("0.048", "0.04") }, { label: "Nominal", set: friction("0.06", "0.05") }, { label: "Upper bound", set: friction("0.078", "0.065") }],
    see: "Peak sliding grows as friction falls; the acceleration of the block does not.",
    runs: { lower: { set: friction("0.048", "0.04") }, nominal: {}, upper: { set: friction("0.078", "0.065") } },
    answer: ({ lower, nominal, upper }) => [
      `Neither: each governs something else. The lower bound asks for the gap: it slides ${peak(lower!)}, where the upper bound slides ${peak(upper!)} and the nominal friction ${peak(nominal!)}.`,
      `The upper bound asks for the building: its base shear is ${digits(upper!.headline.baseShear, 3)} of the weight, against ${digits(lower!.headline.baseShear, 3)} with the lower and ${digits(nominal!.headline.baseShear, 3)} with the nominal friction. So both are run.`,
    ],
  },
  {
    id: "vertical",
    title: "Vertical motion",
    question: "The ground moves up and down too. Does the block slide farther for it?",
    model: VERTICAL,
    drag: "Factor on the vertical motion, from 0 to 2.",
    path: "motion.vertical_scale",
    steps: [{ label: "0", set: [["motion.vertical_scale", "0"]] }, { label: "1", set: [["motion.vertical_scale", "1"]] }, { label: "2", set: [["motion.vertical_scale", "2"]] }],
    see: "Force on the slider, as the third picture and in the loop: its limits are no longer straight lines, for they go with the weight on the slider.",
    runs: { none: { set: [["motion.vertical_scale", "0"]] }, one: { set: [["motion.vertical_scale", "1"]] }, two: { set: [["motion.vertical_scale", "2"]] } },
    answer: ({ none, one, two }) => [
      `Friction is in proportion to what presses the block down, and that is its weight times 1 + the vertical acceleration over g. Sometimes it is held harder, sometimes less: it slides ${peak(none!)} without vertical motion, ${peak(one!)} with it, ${peak(two!)} with twice as much, so ${ratio(one!.headline.peak_m, none!.headline.peak_m)} and ${ratio(two!.headline.peak_m, none!.headline.peak_m)} times as far.`,
      "The page carries no vertical record: the other horizontal component of Taft stands in for one here. Drop the vertical record of an event and name it in the model's text as vertical.",
    ],
  },
  {
    id: "two-directions",
    title: "Two directions",
    question: "The ground moves in both horizontal directions. Is it enough to look at each by itself?",
    model: TWO,
    drag: "Turn of the pair, from 0 to 90 degrees.",
    path: "motion.rotate",
    steps: [{ label: "0°", set: [["motion.rotate", "0 deg"]] }, { label: "45°", set: [["motion.rotate", "45 deg"]] }, { label: "90°", set: [["motion.rotate", "90 deg"]] }],
    see: "The way of the block from above: friction acts against its way, so that sliding along y takes from what holds it along x.",
    runs: { alone: { text: ONE }, ...Object.fromEntries(TURNS.map((turn) => [`${turn}`, { set: [["motion.rotate", `${turn} deg`]] as Setting[] }])) },
    answer: (of) => {
      const { alone } = of;
      const all = TURNS.map((turn) => [turn, of[turn]!] as const);
      const most = all.reduce((a, b) => (b[1].headline.peak_m > a[1].headline.peak_m ? b : a));
      const least = all.reduce((a, b) => (b[1].headline.peak_m < a[1].headline.peak_m ? b : a));
      return [
        `No. Under the first component alone the block slides ${peak(alone!)}; under both ${peak(of[0]!)}, ${ratio(of[0]!.headline.peak_m, alone!.headline.peak_m)} times as far: there is but one friction force for both directions.`,
        `How the building stands to the record matters too: over the ${all.length} turns looked at, the peak is from ${peak(least[1])} (${least[0]}°) to ${peak(most[1])} (${most[0]}°).`,
      ];
    },
  },
];
