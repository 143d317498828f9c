//! Options of the analyses over a suite: spectrum, ida, fragility, design.

use std::path::PathBuf;

use clap::Args;
use slipstick::requests::Kind;

use super::{Fields, RecordArgs, ResultArgs, Threads};
use crate::failure::Failure;

pub const SENSITIVITY_EXAMPLES: &str = "\
Examples:
  slipstick sensitivity tank.toml --vary slider.kinetic_friction,slider.radius --out out
  slipstick sensitivity tank.toml --records 'records/*.txt' --units g --dt \"0.01 s\" \\
      --vary slider.radius,storey.1.period --demand peak_sliding_displacement_m

Derivatives are differences of exact runs, each with its error; a step within which the order or
number of events changes is marked. Without --records the model's own motion is used. Of 20 keys
that is at most 45 runs on a record.

Writes with --out: sensitivity.csv and sensitivity.parquet (one row a record, key and demand),
summary.json, the tornado figures as SVG, report.html.";

pub const SPECTRUM_EXAMPLES: &str = "\
Examples:
  slipstick spectrum tank.toml --records 'records/*.txt' --units g --dt \"0.01 s\" \\
      --over storey.1.period=0.1..3s:30 --friction 0.02,0.05,0.10 --scale-to \"0.4 g\" --out out
  slipstick spectrum tank.toml --records far-field --over isolator.period=1..5s:40 \\
      --measure \"Sa(1.2 s)\" --scale-to \"0.5 g\"
  slipstick spectrum shaken.toml --over motion.sine.frequency=0.5..5Hz:100 --friction 0.02,0.05

Values are a list, \"1, 2 m\", or a range FROM..TO with a count, \"0.1..3s:30\", \"0.1..3s:30
log\" at equal ratios. isolator.period is 2 pi sqrt(R/g) and sets slider.radius. --friction
sets the kinetic coefficient and keeps the model's ratio of static to kinetic. Without
--records the model's own motion is used; over motion.sine.frequency that gives response
curves and the window of frequencies in which the structure amplifies.

Writes with --out: spectrum.csv and spectrum.parquet (16, 50, 84 % fractiles), runs.parquet
(every run), a figure per demand (SVG), summary.json, report.html.";

pub const IDA_EXAMPLES: &str = "\
Examples:
  slipstick ida tank.toml --records 'records/*.txt' --units g --dt \"0.01 s\" \\
      --scale-to \"0.1..1.5 g:15\" --measure \"Sa(1.2 s)\" --limit \"150 mm\" --out out
  slipstick ida tank.toml --records far-field --out out
  slipstick ida tank.toml --records far-field --demand storey1_peak_drift_m --limit \"20 mm\"
  slipstick ida tank.toml --records far-field --vary slider.radius=\"1, 2, 3 m\" --by slider.radius

--vary makes designs: all curves are averaged over them, --by PATH takes them apart. A model with
slider.bounds is run with each of them (--bounds nominal for one).

Without --scale-to it searches, for each record, for the level at which the demand first reaches --limit (slider.gap
of the model where that is not given), to 1 %. Demands are keys of summary.json, those of
storeys as storey1_peak_acceleration_m_per_s2.

Writes with --out: ida.csv and ida.parquet (every run), capacities.csv (with a limit),
ida.svg, summary.json, report.html. slipstick fragility reads ida.csv and capacities.csv.";

pub const FRAGILITY_EXAMPLES: &str = "\
Examples:
  slipstick fragility out/ida.csv --demand peak_sliding_displacement_m --limit \"150 mm\" --out fragility
  slipstick fragility study-folder --demand peak_sliding_displacement_m --limit \"150 mm\"
  slipstick fragility study-folder --measure PGV --fit-to cloud --floor \"1 mm\" --limit \"150 mm\"
  slipstick fragility stripes.csv --measure PGA

SOURCE is ida.csv or capacities.csv of slipstick ida, the folder of a study (or a Parquet
file), or counts of your own: a CSV with the columns level (SI), runs, exceeded. --measure
names the column of intensities where it is not that of the levels: PGV, Sa(1.2 s), or the
name itself.

Writes with --out: fragility.csv and fragility.parquet (curve and band), fragility.svg,
summary.json, report.html.";

pub const DESIGN_EXAMPLES: &str = "\
Examples:
  slipstick design tank.toml --records 'records/*.txt' --units g --dt \"0.01 s\" --scale-to \"0.5 g\" \\
      --friction 0.02..0.12:200 --vary slider.radius=1..5m:200 --gap \"200 mm\" --out out
  slipstick design tank.toml --records far-field --measure \"Sa(1.2 s)\" --scale-to \"0.6 g\" \\
      --friction 0.02..0.12:50 --vary slider.radius=\"1, 2, 3, 4 m\" --probability 0.84

Designs of the grid are compared by two figures: the sliding displacement not exceeded in the
stated share of the records, and the floor acceleration not exceeded in half of them (--share).
The design within the gap with the least acceleration is chosen; with slider.bounds in the model, or
--friction-factors, the front is run again with lower and upper friction.

The exit status is 1 if no design stays within the gap.

Writes with --out: front.csv and front.parquet, runs.parquet (every run of the front), figures
(SVG), summary.json, report.html.";

/// Records of a suite, and what is set in the models that it is run on.
#[derive(Clone, Debug, Args)]
pub struct SuiteArgs {
    /// A suite of records: files, folders or patterns such as 'far-field/*.AT2'; may be repeated
    #[arg(long, value_name = "PATTERN", num_args = 1.., help_heading = "Ground motion")]
    pub records: Vec<String>,
    /// Vertical components, as many and in the same order; may be repeated
    #[arg(long, value_name = "PATTERN", num_args = 1.., help_heading = "Ground motion")]
    pub vertical: Vec<String>,
    /// Other horizontal components, as many and in the same order: both components of a pair take one factor
    /// and act at once (--pairs separate: each by itself); may be repeated
    #[arg(long, value_name = "PATTERN", num_args = 1.., help_heading = "Ground motion")]
    pub second: Vec<String>,
    /// What the files do not state
    #[command(flatten)]
    pub record: RecordArgs,
    /// Set a key of the model by its path, such as slider.gap="150 mm"; may be repeated, the last one counts
    #[arg(long, value_name = "PATH=VALUE")]
    pub set: Vec<String>,
    /// Number of threads
    #[command(flatten)]
    pub threads: Threads,
    /// What becomes of the result
    #[command(flatten)]
    pub result: ResultArgs,
}

impl SuiteArgs {
    /// Refuses other components, and what files do not say, where there is no suite that they could be of.
    pub fn only_with_records(&self) -> Result<(), Failure> {
        if !self.records.is_empty() {
            return Ok(());
        }
        let others = [("--second", &self.second), ("--vertical", &self.vertical)];
        if let Some((option, _)) = others.iter().find(|(_, given)| !given.is_empty()) {
            let mend = "a suite beside it, --records <PATTERN>, whose other components these are";
            return Err(Failure::Message(format!("{option}: expected {mend}")));
        }
        Ok(())
    }
}

/// `slipstick spectrum`, `ida`, `design`.
#[derive(Debug, Args)]
pub struct AssessArgs<const KIND: usize> {
    /// Model file (TOML), or - to read it from standard input
    pub model: PathBuf,
    /// The records
    #[command(flatten)]
    pub suite: SuiteArgs,
    /// What is asked
    #[command(flatten)]
    pub fields: Fields<KIND>,
}

/// `slipstick fragility`.
#[derive(Debug, Args)]
pub struct FragilityArgs {
    /// Folder that ida, study, spectrum or design wrote, or a table: CSV or Parquet
    pub source: PathBuf,
    /// What is asked
    #[command(flatten)]
    pub fields: Fields<{ Kind::Fragility as usize }>,
    /// Number of threads
    #[command(flatten)]
    pub threads: Threads,
    /// What becomes of the result
    #[command(flatten)]
    pub result: ResultArgs,
}
