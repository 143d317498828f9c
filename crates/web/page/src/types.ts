/** What the module returns, and what workers and page say to each other. */

export type Display = "si" | "si-g" | "kN-mm" | "us";

export interface Unit {
  in_si: number;
  symbol: string;
}

/** A value of the model in use. */
export interface InputValue {
  path: string;
  text: string;
  value?: number | null;
  in_si?: number;
  symbol?: string;
  shown?: string;
}

export interface Row {
  label: string;
  unit: string;
  values: string[];
  governing: number | null;
}

export interface Warning {
  label: string;
  kind: string;
  run: string | null;
  time_s: number | null;
  message: string;
}

export interface State {
  name: string;
  line: string;
  inputs: InputValue[];
  motion: {
    kind: string;
    words: string;
    pga_m_per_s2: number;
    duration_s: number;
    dt_s: number | null;
  };
  structure: {
    blockMass_kg: number;
    storeyMasses_kg: number[];
    heights_m: number[];
    width_m: number | null;
    gap_m: number | null;
    stop_m: (number | null)[] | null;
    radius_m: number | null;
    springs: boolean;
    weight_n: number;
    tilt_rad: number;
    contents: number;
    storeyNames: string[];
    blockName: string;
  };
  rows: Row[];
  runs: string[];
  warnings: Warning[];
  units: Record<"length" | "velocity" | "acceleration" | "force" | "energy", Unit>;
  headline: {
    peak_m: number;
    peakTime_s: number;
    residual_m: number;
    block_m_per_s2: number;
    roof_m_per_s2: number | null;
    gapRatio: number | null;
    slips: number;
    baseShear: number;
  };
  method: string;
}

/** A response that is not judged yet; SI. */
export interface Answer {
  state: State;
  time: Float64Array;
  table: Float64Array;
  s: Float64Array;
  velocity: Float64Array;
  block: Float64Array;
  friction: Float64Array;
  force: Float64Array;
  storeyDisplacement: Float64Array;
  storeyAcceleration: Float64Array;
  contents: Float64Array;
  /** Along y; empty in one direction. */
  sy: Float64Array;
  frictionY: Float64Array;
  mode: Int8Array;
  eventTimes: Float64Array;
  eventKinds: Uint8Array;
  ground: number;
  /** Only where the table moves otherwise than in the last answer. */
  tableTimes?: Float64Array;
  tableDisplacement?: Float64Array;
}

export interface Beside {
  time: Float64Array;
  s: Float64Array;
}

export interface Judgement {
  rows: Row[];
  runs: string[];
  warnings: Warning[];
  certificate: {
    holds: boolean | null;
    bound: string;
    figures: { name: string; value: string }[];
    closestCall: { margin: string; time_s: number; kind: string } | null;
    iterations: { mean: string; max: number } | null;
  };
  fixedBase?: { label: string; unit: string; fixed: string; sliding: string; ratio: string }[];
  stepwise?: {
    error?: string;
    rows?: { label: string; unit: string; exact: string; stepwise: string }[];
    iterations?: string | null;
  };
  energy: Float64Array[];
  lower?: Beside;
  upper?: Beside;
  steps?: Beside;
}

export interface Drawing {
  id: string;
  caption: string;
  svg: string;
}

export interface Sheet {
  kind: string;
  line: string;
  first: string | null;
  verdict: string[];
  warnings: Warning[];
  tables: { heading: string; rows: string[][] }[];
  notes: string[];
  method: string[];
  figures: (FigureData & { caption: string })[];
  /** What makes it again beside the model: lines of commands, and the records; with a text where that is not the file itself. */
  commands: string[];
  records: { path: string; text: string | null; file: string }[];
  /** The command's tables of its runs. */
  runs: RunTable[];
  html: string;
  json: string;
}

/** One direction of a drawing: from `min` to `max`, or names at 1, 2, 3 …. */
export interface AxisData {
  label: string;
  min: number;
  max: number;
  log: boolean;
  names: string[];
}

/** A line, a band or points of a drawing; `points` are x, y, x, y …, a value that is none null. */
export interface SeriesData {
  label: string;
  colour: string;
  width: number;
  dashes: string;
  shape: "history" | "area" | "curve" | "band" | "dots" | "named";
  fill: string;
  points: (number | null)[];
}

export interface PanelData {
  x: AxisData;
  y: AxisData;
  height: number;
  series: SeriesData[];
  limits: { value: number; label: string; colour: string; width: number; dashes: string }[];
  peak: [number, number] | null;
  note: string;
  /** Values of x that are marked. */
  marks?: number[];
}

/** A drawing as the report lays it out, in the colours of print. */
export interface FigureData {
  id: string;
  title: string;
  layout: "stacked" | "beside" | "square";
  panels: PanelData[];
  shaded: [number, number][];
}

/** A column of a table of runs; values in SI, whose unit is `si`. */
export interface RunColumn {
  name: string;
  title: string;
  unit: Unit;
  si: string;
  /** Whether it is a path of the model. */
  path: boolean;
  values: (number | string | boolean | null)[];
}

export interface RunTable {
  name: string;
  columns: RunColumn[];
}

/** What makes a run by itself: its record by name, none where the motion is made; the factor on it; which bound of friction; keys of the model. */
export interface Run {
  record: string | null;
  scale: number;
  friction: string;
  set: Setting[];
}

/** A demand to choose. */
export interface Choice {
  name: string;
  title: string;
  unit: Unit;
}

interface Figure {
  value: number;
  unit: Unit;
}

/** What is known of a record. */
export interface Surveyed {
  pga: Figure;
  pgv: Figure;
  measure: Figure | null;
  duration_s: number;
  notices: string[];
}

/** A field of a form. */
export interface FormField {
  name: string;
  /** What it was called in the addresses of earlier versions; empty where it has always had its name. */
  formerly: string;
  label: string;
  takes: "one" | "many" | "choice" | "flag";
  words: string[];
  default: string;
  /** What stands there at first. */
  start: string;
  about: string;
}

/** What is in a dropped record. */
export interface Inspected {
  layout: string;
  /** It needs no more to be a motion. */
  plain: boolean;
  /** That motion is vertical. */
  upright: boolean;
  channels: {
    name: string;
    quantity: string;
    usable: boolean;
    counts: boolean;
    vertical: boolean;
    values: number;
    dt_s: number | null;
    words: string;
  }[];
}

/** An error with its place in a text. */
export interface Fault {
  message: string;
  source?: string;
  start?: number;
  end?: number;
  /** The module is gone; its worker has to be replaced. */
  fatal?: boolean;
  /** The path of a file that the model names and that is not here. */
  missing?: string;
}

export type Setting = [path: string, value: string];

/** A model as it is wanted: its text and the keys set on it since, how it is shown, and whether the stepwise method stands beside it. Each change is another, under the next number. */
export interface Revision {
  number: number;
  text: string;
  set: Setting[];
  display: Display;
  stepwise: boolean;
}

export interface Calls {
  add: (name: string, bytes: Uint8Array) => void;
  remove: (name: string) => void;
  hash: (bytes: Uint8Array) => string;
  inspect: (name: string, units: string, dt: string) => Inspected;
  /** With a time in ms the answer is judged where no newer one is asked for in it. */
  analyse: (of: Revision, restMs?: number) => Answer;
  judge: (of: Revision) => Judgement;
  /** Its text with the keys set. */
  text: (of: Revision) => string;
  /** Judges it once what is asked before is done; what is found comes as what is judged at rest. */
  check: (of: Revision) => void;
  /** Files of the names, all made of one judged answer, and its model's text. */
  files: (of: Revision, names: string[], command: string) => { text: string; files: string[] };
  sweep: (text: string, over: string, from: number, to: number) => Float64Array;
  plan: (what: string, text: string, options: Setting[]) => string;
  form: (what: string, text: string, display: Display) => { about: string; fields: FormField[]; demands: Choice[] };
  survey: (asked: string[], measure: string, display: Display) => Surveyed;
  studyRun: (plan: string, text: string, names: string[], run: number) => Run;
  assess: (what: string, text: string, options: Setting[], display: Display) => Sheet;
  /** Number of runs, and of the numbers of a row. */
  studySize: (plan: string, text: string, names: string[]) => [number, number];
  studyRows: (plan: string, text: string, names: string[], from: number, to: number) => Float64Array;
  study: (plan: string, text: string, names: string[], rows: Float64Array, display: Display) => Sheet;
  histories: (count: number) => number;
  wait: (ms: number) => void;
  trap: () => void;
}

export type Op = keyof Calls;

export interface Request {
  id: number;
  op: Op;
  args: unknown[];
}

export type Reply =
  | { id: number; result: unknown }
  | { id: number; fault: Fault }
  | { progress: [done: number, planned: number] }
  | { judging: number; text: string }
  | { judged: number; judgement: Judgement }
  | { judged: number; fault: Fault }
  | { ready: string };
