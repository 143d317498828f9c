//! Options of `slipstick compare` and `slipstick identify`.

use super::{MethodName, UnitSystem};
use clap::{Args, Subcommand, ValueEnum};
use slipstick::laboratory::cyclic::KineticLaw;
use std::path::PathBuf;

pub(super) const COMPARE_EXAMPLES: &str = "\
Examples:
  slipstick compare test12.csv mock-up.toml --out out
  slipstick compare test12.csv mock-up.toml --mapping sensors.toml
  slipstick compare test12.csv mock-up.toml --map \"block_acceleration = A1 [g] * -1\" \\
      --map \"sliding_displacement = X1 - U [mm]\" --map \"time = 0.005 s\"
  slipstick compare test12.csv mock-up.toml --within peak_ratio.sliding_displacement=0.9..1.1

The prediction is driven by the measured table acceleration; the model's [motion] is
ignored. Columns that are named as in history.csv, perhaps in another unit
(block_acceleration_g), need no mapping. Others are named by QUANTITY = COLUMN [- COLUMN]
[UNIT] * FACTOR @ SHIFT, as an option or in a mapping file (TOML, QUANTITY = \"COLUMN …\");
all parts but the first column are optional, and #3 is the third column. Quantities: time,
table_acceleration, block_acceleration, sliding_displacement, sliding_velocity,
friction_force, storey1_displacement, storey1_velocity, storey1_acceleration, …

Figures for --within: peak_ratio, residual_error, rms_error, normalised_rms_error,
correlation, russell_magnitude, russell_phase, russell_comprehensive, anderson_whole_band,
arrival_lag;
SI, either end may be left out. A bound that is missed makes the exit status 1.";
pub(super) const IDENTIFY_EXAMPLES: &str = "\
Examples:
  slipstick identify cyclic cyclic-*.csv --mass \"124 kg\" --out friction
  slipstick identify cyclic bearing-*.csv --normal-force \"800 kN\" --law slow-fast-rate
  slipstick identify free-vibration pull-back.csv --channel storey1_acceleration --from \"2 s\"
  slipstick identify shaking-table test12.csv mock-up.toml \\
      --fit slider.static_friction,slider.kinetic_friction,slider.tilt --out fitted

Every value comes with its 95 % confidence interval; a parameter that the data do not determine
is reported as such, with the reason, and the exit status is 1. Columns are named as for slipstick compare;
a cyclic test has the quantities displacement and force. With --out: identified.json,
figures (SVG), report.html and, where a model is known, model.toml, which run and compare read.";
/// The columns of a measured file.
#[derive(Debug, Args)]
pub struct MappingArgs {
    /// Mapping file (TOML): which column holds which quantity
    #[arg(long, value_name = "FILE", help_heading = "Measured file")]
    pub mapping: Option<PathBuf>,
    /// Column of a quantity: "block_acceleration = A1 [g] * -1"; may be repeated
    #[arg(long, value_name = "QUANTITY=COLUMN", help_heading = "Measured file")]
    pub map: Vec<String>,
}

/// What becomes of a result.
#[derive(Clone, Debug, Args)]
pub struct ResultArgs {
    /// Print the result as one JSON object
    #[arg(long, help_heading = "Output")]
    pub json: bool,
    /// Folder to write the results into
    #[arg(short, long, value_name = "DIR", help_heading = "Output")]
    pub out: Option<PathBuf>,
    /// Units of the table and the report; files and JSON are always SI
    #[arg(long, value_name = "SYSTEM", value_enum, default_value = "si", help_heading = "Output")]
    pub display_units: UnitSystem,
    /// Print nothing on standard error but errors
    #[arg(short, long, help_heading = "Output")]
    pub quiet: bool,
}

/// `slipstick compare`.
#[derive(Debug, Args)]
pub struct CompareArgs {
    /// Measured histories: text in columns with a header, or Parquet
    pub measured: PathBuf,
    /// Model file (TOML), or - to read it from standard input
    pub model: PathBuf,
    /// The columns
    #[command(flatten)]
    pub mapping: MappingArgs,
    /// Method: exact, or stepwise as in the program of the paper
    #[arg(long, value_enum)]
    pub method: Option<MethodName>,
    /// Set a key of the model by its path, such as slider.tilt="1 mrad"; may be repeated, the last one counts
    #[arg(long, value_name = "PATH=VALUE")]
    pub set: Vec<String>,
    /// A bound to keep: "peak_ratio.sliding_displacement=0.9..1.1"; may be repeated
    #[arg(long, value_name = "METRIC.QUANTITY=LEAST..MOST", allow_hyphen_values = true)]
    pub within: Vec<String>,
    /// The result
    #[command(flatten)]
    pub result: ResultArgs,
}

/// The jobs of `slipstick identify`.
#[derive(Debug, Subcommand)]
pub enum IdentifyCommand {
    /// Friction, spring and viscous part from cyclic tests: displacement and force
    Cyclic(CyclicArgs),
    /// Frequency and damping ratio of a storey from free vibration
    FreeVibration(FreeVibrationArgs),
    /// Any keys of a model from a shaking-table record
    ShakingTable(ShakingTableArgs),
}

/// `slipstick identify cyclic`.
#[derive(Debug, Args)]
pub struct CyclicArgs {
    /// Cyclic tests with the quantities displacement and force: files, folders or patterns; several
    /// frequencies are compared, and a file may hold several
    #[arg(required = true)]
    pub files: Vec<String>,
    /// Mass of the block: friction becomes a coefficient, and with --out a model is written
    #[arg(long, value_name = "MASS")]
    pub mass: Option<String>,
    /// Force that presses the block on its surface, where it is not the weight of that mass
    #[arg(long, value_name = "FORCE")]
    pub normal_force: Option<String>,
    /// Model that takes the friction found; its weight is the normal force
    #[arg(long, value_name = "FILE", conflicts_with = "mass")]
    pub model: Option<PathBuf>,
    /// How kinetic friction follows the sliding speed: not at all, or by slow and fast coefficients and the
    /// rate between them, which takes tests at several speeds and leaves out the damper
    #[arg(long, value_enum, default_value = "coulomb")]
    pub law: LawName,
    /// Do not fit these beside friction: spring, damper
    #[arg(long, value_name = "PART", value_enum, value_delimiter = ',')]
    pub without: Vec<Part>,
    /// Travel after each reversal to leave out (backlash); found from the force if not given
    #[arg(long, value_name = "LENGTH")]
    pub slack: Option<String>,
    /// The columns
    #[command(flatten)]
    pub mapping: MappingArgs,
    /// The result
    #[command(flatten)]
    pub result: ResultArgs,
}

/// How kinetic friction follows the sliding speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LawName {
    /// One coefficient at all speeds
    Coulomb,
    /// fast - (fast - slow) e^(-rate |v|)
    SlowFastRate,
}

impl From<LawName> for KineticLaw {
    fn from(name: LawName) -> Self {
        match name {
            LawName::Coulomb => Self::Coulomb,
            LawName::SlowFastRate => Self::SlowFastRate,
        }
    }
}

/// What a cyclic test need not have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Part {
    /// A force along the displacement
    Spring,
    /// A force along the velocity
    Damper,
}

/// `slipstick identify free-vibration`.
#[derive(Debug, Args)]
pub struct FreeVibrationArgs {
    /// Measured history of free vibration
    pub file: PathBuf,
    /// Quantity to fit, where the file has several: storey1_acceleration, displacement, …
    #[arg(long, value_name = "QUANTITY")]
    pub channel: Option<String>,
    /// Time at which free vibration starts: "12 s"
    #[arg(long, value_name = "TIME")]
    pub from: Option<String>,
    /// Time at which it ends
    #[arg(long, value_name = "TIME")]
    pub to: Option<String>,
    /// Model that takes the frequency and damping ratio found
    #[arg(long, value_name = "FILE")]
    pub model: Option<PathBuf>,
    /// The columns
    #[command(flatten)]
    pub mapping: MappingArgs,
    /// The result
    #[command(flatten)]
    pub result: ResultArgs,
}

/// `slipstick identify shaking-table`.
#[derive(Debug, Args)]
pub struct ShakingTableArgs {
    /// Measured histories, the table acceleration among them
    pub file: PathBuf,
    /// Model file (TOML), or - to read it from standard input
    pub model: PathBuf,
    /// Keys to fit, each perhaps with its range: "slider.spring=100 kN/m..200 kN/m"
    #[arg(long, value_name = "PATH[=LEAST..MOST]", value_delimiter = ',', required = true)]
    pub fit: Vec<String>,
    /// Measured quantities to fit; all if not given
    #[arg(long, value_name = "QUANTITY", value_delimiter = ',')]
    pub using: Vec<String>,
    /// Set a key of the model by its path; may be repeated, the last one counts
    #[arg(long, value_name = "PATH=VALUE")]
    pub set: Vec<String>,
    /// Seed of the random starts
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    pub seed: u64,
    /// The columns
    #[command(flatten)]
    pub mapping: MappingArgs,
    /// The result
    #[command(flatten)]
    pub result: ResultArgs,
}
