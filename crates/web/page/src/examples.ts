/** What the page carries with it: models and public-domain records of the repository's `examples/`. */

import elCentroModel from "../../../../examples/el-centro.toml";
import frame from "../../../../examples/frame-pendulum.toml";
import taftTwo from "../../../../examples/taft-two-directions.toml";
import taft from "../../../../examples/taft.toml";
import elCentro from "../../../../examples/records/el-centro-180.txt";
import taft021 from "../../../../examples/records/taft-021.txt";
import taft111 from "../../../../examples/records/taft-111.txt";

export interface Carried {
  name: string;
  label: string;
  units: string;
  dt: string;
  text: string;
}

export const RECORDS: Carried[] = [
  { name: "records/taft-111.txt", label: "Taft 1952, 111°", units: "g", dt: "0.01 s", text: taft111 },
  { name: "records/taft-021.txt", label: "Taft 1952, 021°", units: "g", dt: "0.01 s", text: taft021 },
  { name: "records/el-centro-180.txt", label: "El Centro 1940, 180°", units: "g", dt: "0.01 s", text: elCentro },
];

const RIGID = `# A rigid block on a shaking table under a sine.
name = "Rigid block, sine"

[block]
mass = "124 kg"

[slider]
static_friction  = 0.10
kinetic_friction = 0.08

[motion]
sine = { frequency = "1 Hz", amplitude = "2 m/s2", duration = "10 s", dt = "0.005 s", ramp = "2 s" }

[analysis]
tail = "2 s"
`;

export const MODELS: { label: string; text: string }[] = [
  { label: "One storey, Taft 1952", text: taft },
  { label: "Pendulum, Taft, two components", text: taftTwo },
  { label: "El Centro 1940", text: elCentroModel },
  { label: "Frame on pendulum sliders", text: frame },
  { label: "Rigid block, sine", text: RIGID },
];

export const START = taft;
