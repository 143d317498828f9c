//! Options of `slipstick compare` and `slipstick identify`.

use super::{Fields, Threads, unit_systems};
use clap::{Args, Subcommand};
use slipstick::requests::Kind;
use slipstick_report::DisplayUnits;
use std::path::PathBuf;

pub(super) const COMPARE_EXAMPLES: &str = "\
Examples:
  slipstick compare test12.csv mock-up.toml --out out
  slipstick compare test12.csv mock-up.toml --mapping sensors.toml
  slipstick compare test12.csv mock-up.toml --mapping \"block_acceleration = A1 [g] * -1\" \\
      --mapping \"sliding_displacement = X1 - U [mm]\" --mapping \"time = 0.005 s\"
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
  slipstick identify cyclic load-1.csv load-2.csv --normal-force \"400 kN,1600 kN\" --area \"0.04 m2\"
  slipstick identify free-vibration pull-back.csv --channel storey1_acceleration --start \"2 s\"
  slipstick identify shaking-table test12.csv mock-up.toml \\
      --fit slider.static_friction,slider.kinetic_friction,slider.tilt --out fitted

Every value comes with its 95 % confidence interval; a parameter that the data do not determine
is reported as such, with the reason, and the exit status is 1. Columns are named as for slipstick compare;
a cyclic test has the quantities displacement and force. With --out: identified.json,
figures (SVG), report.html and, where a model is known, model.toml, which run and compare read.";

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
    #[arg(long, value_name = "SYSTEM", value_parser = unit_systems(), default_value = "si", help_heading = "Output")]
    pub display_units: DisplayUnits,
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
    /// What is asked
    #[command(flatten)]
    pub fields: Fields<{ Kind::Compare as usize }>,
    /// Set a key of the model by its path, such as slider.tilt="1 mrad"; may be repeated, the last one counts
    #[arg(long, value_name = "PATH=VALUE")]
    pub set: Vec<String>,
    /// The result
    #[command(flatten)]
    pub result: ResultArgs,
}

/// The jobs of `slipstick identify`.
#[derive(Debug, Subcommand)]
pub enum IdentifyCommand {
    /// Friction, spring and viscous part from cyclic tests: displacement and force
    Cyclic(TestArgs<{ Kind::Cyclic as usize }>),
    /// Frequency and damping ratio of a storey from free vibration
    FreeVibration(TestArgs<{ Kind::FreeVibration as usize }>),
    /// Any keys of a model from a shaking-table record
    ShakingTable(ShakingTableArgs),
}

/// `slipstick identify cyclic`, `free-vibration`.
#[derive(Debug, Args)]
pub struct TestArgs<const KIND: usize> {
    /// Measured file; of cyclic tests several, folders or patterns, each of one frequency or more
    #[arg(required = true)]
    pub files: Vec<String>,
    /// Model that takes what is found; its weight is the normal force of a cyclic test
    #[arg(long, value_name = "FILE")]
    pub model: Option<PathBuf>,
    /// What is asked
    #[command(flatten)]
    pub fields: Fields<KIND>,
    /// The result
    #[command(flatten)]
    pub result: ResultArgs,
}

/// `slipstick identify shaking-table`.
#[derive(Debug, Args)]
pub struct ShakingTableArgs {
    /// Measured histories, the table acceleration among them
    pub file: String,
    /// Model file (TOML), or - to read it from standard input
    pub model: PathBuf,
    /// What is asked
    #[command(flatten)]
    pub fields: Fields<{ Kind::ShakingTable as usize }>,
    /// Set a key of the model by its path; may be repeated, the last one counts
    #[arg(long, value_name = "PATH=VALUE")]
    pub set: Vec<String>,
    /// Number of threads
    #[command(flatten)]
    pub threads: Threads,
    /// The result
    #[command(flatten)]
    pub result: ResultArgs,
}
