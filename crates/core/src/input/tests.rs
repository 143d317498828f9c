//! What the reader takes, what it refuses and in which words.

mod errors;
mod in_plane;
mod overrides;
mod plans;
mod properties;
mod valid;

use super::{Analysis, Override, parse};

/// A model with nothing optional in it.
const SMALLEST: &str = "\
[block]
mass = \"325 kg\"
[slider]
static_friction = 0.02
kinetic_friction = 0.012
";

/// The smallest model and more text after it.
fn with(more: &str) -> Result<Analysis, String> {
    read(&format!("{SMALLEST}{more}"), &[])
}

/// Reads a model named `m.toml`, with keys set from outside.
fn read(text: &str, set: &[&str]) -> Result<Analysis, String> {
    let set: Result<Vec<_>, _> =
        set.iter().map(|text| Override::of_option("--set", text)).collect();
    let set = set.map_err(|error| error.to_string())?;
    parse("m.toml", text, &set).map_err(|error| error.to_string())
}

/// The example of the manual, every section of it.
const FULL: &str = r#"name = "Section 6 mock-up"

[block]
mass  = "325 kg"
width = "0.53 m"               # optional, with storey heights: the ratio of overturning is reported

[slider]
static_friction  = 0.020       # or { positive = 0.021, negative = 0.019 }
kinetic_friction = 0.012
spring = "143 kN/m"            # optional; or radius = "2.2 m"
damper = "0 N s/m"             # optional; or damping_ratio: C1 = 2 ξ √(K1 M_tot)
tilt   = "1 mrad"              # optional
asymmetry = 0.0                # optional
gap    = "150 mm"              # optional: gap_ratio is reported, passing it is a warning with the time
bounds = { lower = 0.8, upper = 1.3 }   # optional: run also with both coefficients times these

[[storey]]                     # none, one or many, from the block up
mass = "45 kg"
frequency = "1.625 Hz"         # one storey: its fixed-base frequency; or period; or stiffness = "4.7 kN/m"
damping_ratio = 0.01           # or damper = "9 N s/m"
height = "0.76 m"              # optional: drift ratio, overturning

# [frame] period = "0.8 s"     # many storeys: stiffnesses are relative, scaled to this first fixed-base period

[motion]                       # one of record, sine, sweep, pulse
record   = "records/taft.txt"  # relative to this file; units, dt, channel beside it where the file does not state them
units    = "g"
dt       = "0.01 s"
scale_to = "0.3 g"             # peak; or scale = 1.5 (may be negative)
vertical = "records/taft-up.txt"        # takes the factor of the horizontal; vertical_scale = 1

[initial]                      # optional; each key replaces its own default of §2
sliding_displacement = "10 mm"
sliding_velocity     = "0 m/s"
storey_displacement  = ["5 mm"]         # relative to the block, one a storey
storey_velocity      = ["0 m/s"]

[analysis]                     # optional throughout
method  = "exact"              # or "stepwise"
gravity = "9.81 m/s2"
tail    = "5 s"                # free vibration after the motion ends; default none
"#;
