//! Options of the analyses over a suite: spectrum, ida, fragility, design.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::{RecordArgs, ResultArgs};

pub const SPECTRUM_EXAMPLES: &str = "\
Examples:
  slipstick spectrum tank.toml --records 'records/*.txt' --units g --dt \"0.01 s\" \\
      --over storey.1.period=0.1..3s:30 --friction 0.02,0.05,0.10 --level \"0.4 g\" --out out
  slipstick spectrum tank.toml --records far-field --over isolator.period=1..5s:40 \\
      --measure \"Sa(1.2 s)\" --level \"0.5 g\"
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
      --levels \"0.1..1.5 g:15\" --measure \"Sa(1.2 s)\" --to \"150 mm\" --out out
  slipstick ida tank.toml --records far-field --hunt --out out
  slipstick ida tank.toml --records far-field --hunt --demand storey1_peak_drift_m --to \"20 mm\"
  slipstick ida tank.toml --records far-field --hunt --vary slider.radius=\"1, 2, 3 m\" --by slider.radius

--vary makes designs: all curves are averaged over them, --by PATH takes them apart. A model with
slider.bounds is run with each of them (--bounds nominal for one).

--hunt searches, for each record, for the level at which the demand first reaches --to (slider.gap
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
  slipstick design tank.toml --records 'records/*.txt' --units g --dt \"0.01 s\" --level \"0.5 g\" \\
      --friction 0.02..0.12:200 --vary slider.radius=1..5m:200 --gap \"200 mm\" --out out
  slipstick design tank.toml --records far-field --measure \"Sa(1.2 s)\" --level \"0.6 g\" \\
      --friction 0.02..0.12:50 --vary slider.radius=\"1, 2, 3, 4 m\" --probability 0.84

Designs of the grid are compared by two figures: the sliding displacement not exceeded in the
stated share of the records, and the floor acceleration not exceeded in half of them (--share).
The design within the gap with the least acceleration is chosen; with slider.bounds in the model, or
--bounds, the front is run again with lower and upper friction.

The exit status is 1 if no design stays within the gap.

Writes with --out: front.csv and front.parquet, runs.parquet (every run of the front), figures
(SVG), summary.json, report.html.";

/// Model and records.
#[derive(Debug, Args)]
pub struct SuiteArgs {
    /// Model file (TOML), or - to read it from standard input
    pub model: PathBuf,
    /// Records: files, folders or patterns such as 'far-field/*.AT2'; may be repeated
    #[arg(long, value_name = "PATTERN", num_args = 1.., help_heading = "Ground motion")]
    pub records: Vec<String>,
    /// Vertical components, as many and in the same order; may be repeated
    #[arg(long, value_name = "PATTERN", num_args = 1.., requires = "records", help_heading = "Ground motion")]
    pub vertical: Vec<String>,
    /// What the files do not state
    #[command(flatten)]
    pub record: RecordArgs,
    /// Set a key of the model by its path, such as slider.gap="150 mm"; may be repeated, the last one counts
    #[arg(long, value_name = "PATH=VALUE")]
    pub set: Vec<String>,
    /// Number of threads; default: one per processor
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub jobs: Option<u16>,
    /// What becomes of the result
    #[command(flatten)]
    pub result: ResultArgs,
}

/// How all records are scaled.
#[derive(Debug, Args)]
pub struct ScaleArgs {
    /// Intensity measure of --level: PGA, PGV, Sa(1.2 s), Sa(1.2 s, 2 %), Sa_avg(0.5 s, 3 s), …
    #[arg(long, value_name = "NAME", default_value = "PGA", help_heading = "Ground motion")]
    pub measure: String,
    /// Scale every record to this value of the measure: "0.4 g"
    #[arg(long, value_name = "LEVEL", help_heading = "Ground motion")]
    pub level: Option<String>,
    /// Scale every record by this factor
    #[arg(long, value_name = "FACTOR", conflicts_with = "level", help_heading = "Ground motion")]
    pub scale: Option<f64>,
}

/// `slipstick spectrum`.
#[derive(Debug, Args)]
pub struct SpectrumArgs {
    /// Model and records
    #[command(flatten)]
    pub suite: SuiteArgs,
    /// Scale
    #[command(flatten)]
    pub scale: ScaleArgs,
    /// Parameter along the axis: storey.1.period=0.1..3s:30, isolator.period=1..5s:40, …
    #[arg(long, value_name = "PATH=VALUES")]
    pub over: String,
    /// Friction of each group of curves: 0.02,0.05,0.10
    #[arg(long, value_name = "VALUES")]
    pub friction: Option<String>,
    /// Another parameter, with one group of curves for each value; may be repeated
    #[arg(long, value_name = "PATH=VALUES")]
    pub vary: Vec<String>,
    /// Further demands, besides displacement, residual, path and roof acceleration; may be repeated
    #[arg(long, value_name = "KEY")]
    pub demand: Vec<String>,
    /// Bounds of friction
    #[command(flatten)]
    pub bounds: BoundsArgs,
}

/// `slipstick ida`.
#[derive(Debug, Args)]
pub struct IdaArgs {
    /// Model and records
    #[command(flatten)]
    pub suite: SuiteArgs,
    /// Intensity measure: PGA, PGV, Sa(1.2 s), Sa(1.2 s, 2 %), Sa_avg(0.5 s, 3 s), …
    #[arg(long, value_name = "NAME", default_value = "PGA")]
    pub measure: String,
    /// Levels for all records: "0.1, 0.2, 0.4 g" or "0.1..1.5 g:15"
    #[arg(long, value_name = "VALUES", required_unless_present = "hunt")]
    pub levels: Option<String>,
    /// Search, record by record, for the level at which the demand first reaches its limit
    #[arg(long, conflicts_with = "levels")]
    pub hunt: bool,
    /// First and highest level of the hunt: "0.05..10 g"; without it, a twentieth and twenty times the
    /// records' median
    #[arg(long, value_name = "FROM..TO", requires = "hunt")]
    pub between: Option<String>,
    /// Key of the demand
    #[arg(long, value_name = "KEY", default_value = "peak_sliding_displacement_m")]
    pub demand: String,
    /// Limit on the demand: "150 mm", or slider.gap for that of the model
    #[arg(long, value_name = "LIMIT")]
    pub to: Option<String>,
    /// Other horizontal components of the suite, as many and in the same order: both components of a pair
    /// take one factor, and certainty is clustered by pair; may be repeated
    #[arg(long, value_name = "PATTERN", num_args = 1.., requires = "records", help_heading = "Ground motion")]
    pub second: Vec<String>,
    /// Parameter to vary, which makes designs: slider.radius="1, 2, 3 m"; may be repeated
    #[arg(long, value_name = "PATH=VALUES")]
    pub vary: Vec<String>,
    /// Run only designs with this value or within this range: slider.radius="1..2 m",
    /// friction=upper; may be repeated
    #[arg(long = "where", value_name = "PATH=VALUE|FROM..TO")]
    pub keep: Vec<String>,
    /// Curves of their own for each value of this path, else averaged over: slider.radius, friction
    #[arg(long, value_name = "PATH")]
    pub by: Option<String>,
    /// Bounds of friction
    #[command(flatten)]
    pub bounds: BoundsArgs,
}

/// Which bounds of friction are run.
#[derive(Clone, Copy, Debug, Args)]
pub struct BoundsArgs {
    /// Which of the model's slider.bounds are run, each with curves of its own
    #[arg(long, value_enum, value_name = "BOUNDS", default_value = "all")]
    pub bounds: BoundsName,
}

/// Bounds of friction by their names.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum BoundsName {
    /// Lower, nominal and upper
    All,
    /// Lower alone
    Lower,
    /// Nominal alone
    Nominal,
    /// Upper alone
    Upper,
}

/// `slipstick fragility`.
#[derive(Debug, Args)]
pub struct FragilityArgs {
    /// Folder that ida, study, spectrum or design wrote, or a table: CSV or Parquet
    pub source: PathBuf,
    /// Key of the demand
    #[arg(long, value_name = "KEY", default_value = "peak_sliding_displacement_m")]
    pub demand: String,
    /// Limit on the demand: "150 mm"; needed unless the source has counts or capacities
    #[arg(long, value_name = "LIMIT")]
    pub limit: Option<String>,
    /// Intensity measure, where it is not that of the levels: PGV, Sa(1.2 s), or a column's name
    #[arg(long, value_name = "NAME")]
    pub measure: Option<String>,
    /// Unit of the intensities, where the table does not state it: g, m/s2, cm/s, …
    #[arg(long, value_name = "UNIT")]
    pub units: Option<String>,
    /// What the curve is fitted to; by the kind of data where not given
    #[arg(long, value_enum, value_name = "DATA")]
    pub fit_to: Option<FitToName>,
    /// Take only rows with this value or within this range: slider.radius="1..2 m", record=taft-111;
    /// may be repeated
    #[arg(long = "where", value_name = "PATH=VALUE|FROM..TO")]
    pub keep: Vec<String>,
    /// One curve for each value of this column: slider.radius
    #[arg(long, value_name = "PATH")]
    pub by: Option<String>,
    /// Bootstrap intervals from this many resamples of the records
    #[arg(long, value_name = "DRAWS", value_parser = clap::value_parser!(u32).range(50..=100_000))]
    pub bootstrap: Option<u32>,
    /// Seed of the bootstrap
    #[arg(long, value_name = "SEED", default_value_t = 1, requires = "bootstrap")]
    pub seed: u64,
    /// Demands below this count as below it only, in a cloud: "1 mm"
    #[arg(long, value_name = "LIMIT")]
    pub floor: Option<String>,
    /// Demands above this count as above it only, in a cloud
    #[arg(long, value_name = "LIMIT")]
    pub cap: Option<String>,
    /// Confidence of intervals and band
    #[arg(long, value_name = "SHARE", default_value_t = 0.9)]
    pub confidence: f64,
    /// What becomes of the result
    #[command(flatten)]
    pub result: ResultArgs,
}

/// `slipstick design`.
#[derive(Debug, Args)]
pub struct DesignArgs {
    /// Model and records
    #[command(flatten)]
    pub suite: SuiteArgs,
    /// Scale
    #[command(flatten)]
    pub scale: ScaleArgs,
    /// Kinetic friction, the model's ratio of static to kinetic kept: 0.02..0.12:200
    #[arg(long, value_name = "VALUES")]
    pub friction: Option<String>,
    /// Parameter to vary: slider.radius=1..5m:200, slider.spring=…; may be repeated
    #[arg(long, value_name = "PATH=VALUES")]
    pub vary: Vec<String>,
    /// Sliding displacement not to be exceeded; by default slider.gap of the model
    #[arg(long, value_name = "LENGTH")]
    pub gap: Option<String>,
    /// Share of the records that must stay within the gap
    #[arg(long, value_name = "SHARE", default_value_t = 0.9)]
    pub probability: f64,
    /// Key of the acceleration to minimise; by default the roof's, or the block's
    #[arg(long, value_name = "KEY")]
    pub demand: Option<String>,
    /// Share of the records that must not exceed that acceleration
    #[arg(long, value_name = "SHARE", default_value_t = 0.5)]
    pub share: f64,
    /// Factors on friction for the robustness check: 0.8,1.3; by default slider.bounds
    #[arg(long, value_name = "LOWER,UPPER")]
    pub bounds: Option<String>,
    /// Sample points of the sensitivity (Sobol' indices); 0 for none
    #[arg(long, value_name = "N", default_value_t = 256)]
    pub sensitivity: u32,
    /// Seed of those points
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    pub seed: u64,
    /// Confidence of intervals
    #[arg(long, value_name = "SHARE", default_value_t = 0.9)]
    pub confidence: f64,
}

/// What a fragility is fitted to.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum FitToName {
    /// Shares of the runs of each level that exceed
    Counts,
    /// The first crossing of each record
    Capacities,
    /// All runs, by regression of ln D on ln IM
    Cloud,
}
