//! What is typed after `slipstick record`.

use clap::{Args, Subcommand};
use std::path::PathBuf;

use slipstick::motion::USUAL_PERIODS;
use slipstick_report::DisplayUnits;

use crate::args::{RecordArgs, unit_systems};

/// Below the help of `slipstick record`.
pub const EXAMPLES: &str = "\
Examples:
  slipstick record info far-field/*.AT2
  slipstick record info records --json
  slipstick record convert RSN15.AT2 taft.csv
  slipstick record spectrum taft.AT2 --damping \"5 %\" --damping \"2 %\" > spectrum.csv
  slipstick record spectrum RSN15_NS.AT2 RSN15_EW.AT2 --rotd > rotd.csv
  slipstick record spectrum out/history.csv --channel storey1_acceleration_m_per_s2 -o floor
  slipstick record process raw.smc --step \"remove linear\" --step \"band-pass 0.1 Hz 25 Hz\" -o ok.csv
  slipstick record plot taft.AT2 -o taft.html

FILE is a file, a folder or a pattern such as \"suite/*.AT2\". A file that cannot be read is
reported and the others go on; then the exit status is 1.";

/// Below the help of `slipstick record process`.
const STEPS: &str = "\
Steps, done in the order in which they are written:
  remove mean | remove linear | remove polynomial 3
  high-pass 0.1 Hz | low-pass 25 Hz | band-pass 0.1 Hz 25 Hz   Butterworth forwards and backwards,
                                         of order 4 unless \"order 2\" follows
  taper 5 %                              half a cosine over 5 % of the duration at each end
  resample 0.005 s                       along the straight lines between samples; no filter
  trim 2 s 30 s                          the part between two times; the clock starts anew
  scale 1.5
  to acceleration | to velocity | to displacement";

/// Commands on records.
#[derive(Debug, Subcommand)]
pub enum RecordCommand {
    /// Say what is understood of records: channels, units, steps, intensity measures, warnings
    Info(InfoArgs),
    /// Write records in another format: CSV, AT2, SMC or Parquet
    Convert(ConvertArgs),
    /// Compute elastic response spectra, or Fourier amplitude spectra
    Spectrum(SpectrumArgs),
    /// Process a record by named steps
    #[command(after_help = STEPS)]
    Process(ProcessArgs),
    /// Draw a record with its integrals, its Arias intensity and its spectra
    Plot(PlotArgs),
}

/// How files are read.
#[derive(Debug, Args)]
pub struct ReadArgs {
    /// Format, where it is not to be recognised from the content
    #[arg(long, value_name = "FORMAT", help_heading = "Ground motion")]
    pub format: Option<String>,
    /// What files do not say
    #[command(flatten)]
    pub record: RecordArgs,
}

/// `slipstick record info`.
#[derive(Debug, Args)]
pub struct InfoArgs {
    /// Files, folders or patterns
    #[arg(value_name = "FILE", required = true)]
    pub files: Vec<String>,
    #[command(flatten)]
    pub read: ReadArgs,
    /// Print a JSON array, one object a channel
    #[arg(long)]
    pub json: bool,
    /// Units of the table; JSON is always SI
    #[arg(long, value_name = "SYSTEM", value_parser = unit_systems(), default_value = "si")]
    pub display_units: DisplayUnits,
}

/// `slipstick record convert`.
#[derive(Debug, Args)]
pub struct ConvertArgs {
    /// File, folder or pattern
    #[arg(value_name = "IN")]
    pub input: String,
    /// File to write, or a folder for several
    #[arg(value_name = "OUT")]
    pub output: PathBuf,
    /// Format to write (csv, at2, smc or parquet), where the name of OUT does not say it
    #[arg(long, value_name = "FORMAT")]
    pub to: Option<String>,
    #[command(flatten)]
    pub read: ReadArgs,
}

/// `slipstick record spectrum`.
#[derive(Debug, Args)]
pub struct SpectrumArgs {
    /// Files, folders or patterns
    #[arg(value_name = "FILE", required = true)]
    pub files: Vec<String>,
    #[command(flatten)]
    pub read: ReadArgs,
    /// A period, such as "1.2 s"; may be repeated
    #[arg(long, value_name = "TIME", conflicts_with_all = ["from", "to", "count"])]
    pub period: Vec<String>,
    /// Shortest of periods that are evenly spaced by their logarithm
    #[arg(long, value_name = "TIME", default_value_t = format!("{} s", USUAL_PERIODS.0))]
    pub from: String,
    /// Longest of them
    #[arg(long, value_name = "TIME", default_value_t = format!("{} s", USUAL_PERIODS.1))]
    pub to: String,
    /// Their number
    #[arg(long, value_name = "N", default_value_t = USUAL_PERIODS.2)]
    pub count: usize,
    /// Damping, such as "5 %" (which is the default) or 0.05; may be repeated
    #[arg(long, value_name = "DAMPING")]
    pub damping: Vec<String>,
    /// RotD50 and RotD100 of two channels at right angles instead
    #[arg(long, conflicts_with = "fourier")]
    pub rotd: bool,
    /// The other channel of a file of several, for --rotd
    #[arg(long, value_name = "NAME", requires_all = ["rotd", "channel"])]
    pub second: Option<String>,
    /// Fourier amplitudes instead
    #[arg(long, conflicts_with_all = ["period", "from", "to", "count", "damping"])]
    pub fourier: bool,
    /// Print JSON instead of CSV
    #[arg(long, conflicts_with = "fourier")]
    pub json: bool,
    /// Folder to write spectrum.csv and figures into, instead of printing
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// `slipstick record process`.
#[derive(Debug, Args)]
pub struct ProcessArgs {
    /// File, folder or pattern
    #[arg(value_name = "FILE")]
    pub input: String,
    #[command(flatten)]
    pub read: ReadArgs,
    /// A step; may be repeated, done in the order in which they are written
    #[arg(long, value_name = "STEP")]
    pub step: Vec<String>,
    /// Sum of channels before the steps: NAME=FACTOR, may be repeated
    #[arg(long, value_name = "NAME=FACTOR", conflicts_with_all = ["channel", "rotate"])]
    pub combine: Vec<String>,
    /// Component at this angle from --channel towards --second, before the steps: "30 deg"
    #[arg(long, value_name = "ANGLE", requires = "second", allow_hyphen_values = true)]
    pub rotate: Option<String>,
    /// Channel at a right angle to --channel, for --rotate
    #[arg(long, value_name = "NAME", requires = "rotate")]
    pub second: Option<String>,
    /// File of that channel, where it is another one
    #[arg(long, value_name = "FILE", requires = "second")]
    pub second_file: Option<PathBuf>,
    /// File to write (.csv, .AT2, .smc, .parquet), or a folder for several; else CSV on standard output
    #[arg(short, long, value_name = "OUT")]
    pub out: Option<PathBuf>,
    /// Format to write (csv, at2, smc or parquet), where the name of OUT does not say it
    #[arg(long, value_name = "FORMAT")]
    pub to: Option<String>,
    /// No list of steps on standard error
    #[arg(short, long)]
    pub quiet: bool,
}

/// `slipstick record plot`.
#[derive(Debug, Args)]
pub struct PlotArgs {
    /// Files, folders or patterns
    #[arg(value_name = "FILE", required = true)]
    pub files: Vec<String>,
    #[command(flatten)]
    pub read: ReadArgs,
    /// File to write: .svg for one channel, .html for any number
    #[arg(short, long, value_name = "OUT")]
    pub out: PathBuf,
    /// Damping of the spectra, such as "5 %" (which is the default); may be repeated
    #[arg(long, value_name = "DAMPING")]
    pub damping: Vec<String>,
    /// Units of the axes
    #[arg(long, value_name = "SYSTEM", value_parser = unit_systems(), default_value = "si")]
    pub display_units: DisplayUnits,
}
