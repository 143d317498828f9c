//! What is typed: commands, options and the help that teaches them.

mod assessment;
mod fields;
mod laboratory;
mod structure;

pub use assessment::{AssessArgs, FragilityArgs, SuiteArgs};
pub use fields::Fields;
pub use laboratory::{CompareArgs, IdentifyCommand, ResultArgs, TestArgs};
pub use structure::{
    ModalArgs, StructureCommand, StructureConvertArgs, StructureInfoArgs, StructureTankArgs,
};

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
use slipstick::record::{Quantity, Units};
use slipstick::requests::Kind;
use slipstick::units::{Dimension, Unit, parse_quantity};
use slipstick_files::RecordOptions;
use slipstick_report::DisplayUnits;
use std::path::PathBuf;

use crate::failure::Failure;

const ABOUT: &str = "Exact stick-slip response of structures on sliding bearings";

const EXAMPLES: &str = "\
Start here:
  slipstick init tank                    write tank.toml, an example ready to run
  slipstick run tank.toml --out out      print the result, write out/report.html
  slipstick schema --units               the units that values may have

Exit status: 0 done, 1 a check or comparison failed or a run has no answer, 2 bad input, 130 after
Ctrl-C.";

const RUN_EXAMPLES: &str = "\
Examples:
  slipstick run tank.toml
  slipstick run tank.toml --out out --floor-spectrum
  slipstick run tank.toml --motion taft.txt --units g --dt \"0.01 s\" --scale-to \"0.3 g\"
  slipstick run tank.toml --set slider.kinetic_friction=0.05 --set storey.1.mass=\"90 kg\"
  slipstick run tank.toml --set analysis.tail=\"5 s\" --display-units kN-mm
  slipstick run - --json < tank.toml
  slipstick run tank.toml --records 'suite/*.AT2' --scale-to \"0.4 g\" --floor-spectrum --out out
  slipstick run tank.toml --records 'x/*.AT2' --second 'y/*.AT2' --periods \"0.6 s..3.8 s\" \\
      --code-spectrum \"sds = 1.2 g, sd1 = 0.8 g, tl = 8 s\" --hazard MCE_R --code asce7-22 --out out
  slipstick run flat.toml pendulum.toml --records suite --measure \"Sa(1.2 s)\" --scale-to \"0.5 g\"

Values are numbers with a unit, \"0.3 g\"; slipstick schema --units lists the units. Paths of
keys are joined by dots, storeys counted from 1. The model's record lies relative to the
model file, that of --motion relative to the working folder.

Writes with --out, complete files only, never a part of one:
  summary.json  the object that --json prints
  history.csv   one row per sample: ground, block, friction force, storeys; SI
  events.csv    every slip, stick and reversal
  report.html   one self-contained page, ready to print
Of several records or models runs.csv and governing.csv (with the bounds of friction, their mean
over seven records or more, else the maximum), profiles.csv (demands over the height, of two storeys
and more), floor-spectra.csv with --floor-spectrum, a history a record with --history-of, figures
(SVG), summary.json and report.html.";

const STUDY_EXAMPLES: &str = "\
Examples:
  slipstick study plan.toml --dry-run              count the runs, estimate the time
  slipstick study plan.toml --out out              run them on all processors
  slipstick study plan.toml --out out --resume     continue an interrupted study
  slipstick study plan.toml --out out --report     a page with figures besides
  slipstick study plan.toml --repeat 4711          the command that reproduces one row
  slipstick study plan.toml --out out1 --shard 1/2     on one machine, and on another
  slipstick study plan.toml --out out2 --shard 2/2
  slipstick study merge out1 out2 --out study.parquet  one file of all

Writes into the folder, complete files only, never a part of one:
  parts/          a table in Parquet files, one row per run: record, level, scale, intensity
                  measures, varied values, demands
  summary.csv     each demand at each level: mean, quantiles, maximum with its record and run
  manifest.json   the plan, hashes of all inputs, counts, and the outcome of rows that were run again
  report.html     with --report: one self-contained page, ready to print

slipstick schema --plan prints the JSON schema of a plan.";

const PAPER_EXAMPLES: &str = "\
Examples:
  slipstick paper                        the verdicts, one line per claim
  slipstick paper --out out              the chapter with its figures, and claims.json
  slipstick paper --quick --json         coarser ranges, the same verdicts, as JSON

Takes a minute or two, --quick some seconds. Two runs write the same bytes.

Writes with --out, complete files only, never a part of one:
  chapter.md    the chapter of the manual, with tables
  figures/      its figures (SVG)
  claims.json   the array that --json prints";

/// Everything on the command line.
#[derive(Debug, Parser)]
#[command(name = "slipstick", version, about = ABOUT, after_help = EXAMPLES)]
#[command(
    max_term_width = 100,
    propagate_version = true,
    subcommand_required = true,
    arg_required_else_help = true
)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Compute the response of a model to its ground motion
    #[command(after_help = RUN_EXAMPLES)]
    Run(RunArgs),
    /// Compare a prediction with what was measured on a shaking table
    #[command(after_help = laboratory::COMPARE_EXAMPLES)]
    Compare(CompareArgs),
    /// Compute sliding spectra over a suite of records, or response over excitation frequency
    #[command(after_help = assessment::SPECTRUM_EXAMPLES)]
    Spectrum(AssessArgs<{ Kind::Spectrum as usize }>),
    /// Compute how much each key of a model changes each demand, with its error
    #[command(after_help = assessment::SENSITIVITY_EXAMPLES)]
    Sensitivity(AssessArgs<{ Kind::Sensitivity as usize }>),
    /// Raise the intensity of every record of a suite until a demand reaches its limit
    #[command(after_help = assessment::IDA_EXAMPLES)]
    Ida(AssessArgs<{ Kind::Ida as usize }>),
    /// Fit fragility curves, the probability of exceeding a limit, with confidence intervals
    #[command(after_help = assessment::FRAGILITY_EXAMPLES)]
    Fragility(FragilityArgs),
    /// Find the friction and stiffness that stay within a gap with a given probability
    #[command(after_help = assessment::DESIGN_EXAMPLES)]
    Design(AssessArgs<{ Kind::Design as usize }>),
    /// Inspect, convert, process and plot records
    #[command(subcommand, after_help = crate::record_args::EXAMPLES)]
    Record(crate::record_args::RecordCommand),
    /// Inspect and convert the modes of a structure: tables of ETABS, SAP2000 and OpenSees
    #[command(subcommand, after_help = structure::EXAMPLES)]
    Structure(StructureCommand),
    /// Run many analyses: records, levels and samples of a plan
    #[command(after_help = STUDY_EXAMPLES)]
    Study(StudyArgs),
    /// Identify friction, stiffness and damping from tests
    #[command(after_help = laboratory::IDENTIFY_EXAMPLES)]
    Identify {
        /// The kind of test
        #[command(subcommand)]
        job: IdentifyCommand,
    },
    /// Write an example model, ready to run
    Init(InitArgs),
    /// Reproduce the paper behind the model: every experiment and claim, with a verdict
    #[command(after_help = PAPER_EXAMPLES)]
    Paper(PaperArgs),
    /// Print the JSON schema of the model file, or the table of units
    Schema(SchemaArgs),
    /// Print a completion script for a shell
    Completions {
        /// The shell
        shell: Shell,
    },
    /// Write the manual pages into a folder
    #[command(hide = true)]
    Man {
        /// The folder
        folder: PathBuf,
    },
}

/// `slipstick run`.
#[derive(Debug, Args)]
pub struct RunArgs {
    /// Model file (TOML), or - to read it from standard input; several are set side by side
    #[arg(required = true, value_name = "MODEL")]
    pub models: Vec<PathBuf>,

    /// Record to use instead of the model's [motion]; the format is recognised
    #[arg(long, value_name = "FILE", conflicts_with = "records", help_heading = "Ground motion")]
    pub motion: Option<PathBuf>,
    /// Print the model and its motion as a script for OpenSeesPy instead, with stick as a spring of this
    /// stiffness: "100 kN/mm"; that in which friction builds up over 10 µm if none is given
    #[arg(long, value_name = "STIFFNESS", num_args = 0..=1, require_equals = true, default_missing_value = "",
          conflicts_with_all = ["records", "out", "json"])]
    pub to_opensees: Option<String>,
    /// The records of a suite
    #[command(flatten)]
    pub on: SuiteArgs,
    /// Spectrum that pairs are scaled to: a CSV with the columns period_s and sa_g
    #[arg(long, value_name = "FILE", requires = "second", help_heading = "Ground motion")]
    pub target: Option<PathBuf>,
    /// What is asked of one motion
    #[command(flatten)]
    pub one: Fields<{ Kind::Run as usize }>,
    /// What is asked of a suite
    #[command(flatten)]
    pub suite: Fields<{ Kind::Suite as usize }>,
}

/// The threads that share out runs.
#[derive(Clone, Copy, Debug, Args)]
pub struct Threads {
    /// Number of threads; default: one per processor
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    jobs: Option<u16>,
}

impl Threads {
    /// Their number, where it is given.
    pub fn number(self) -> Option<usize> {
        self.jobs.map(usize::from)
    }
}

/// The value of an option, in SI.
pub fn quantity(option: &str, text: &str, dimension: Dimension) -> Result<f64, Failure> {
    parse_quantity(text, dimension).map_err(|error| Failure::Message(format!("{option}: {error}")))
}

/// What files of records do not say themselves: wherever one is read.
#[derive(Clone, Debug, Args)]
pub struct RecordArgs {
    /// Unit of the values, where a file does not state it: g, gal, m/s2, …; of counts the value of
    /// one: "4.67e-6 m/s2"
    #[arg(long, value_name = "UNIT", help_heading = "Ground motion")]
    pub units: Option<String>,
    /// Time step, where a file does not state it: "0.01 s"
    #[arg(long, value_name = "TIME", help_heading = "Ground motion")]
    pub dt: Option<String>,
    /// Channel, by name or number (from 1)
    #[arg(long, value_name = "NAME", help_heading = "Ground motion")]
    pub channel: Option<String>,
}

impl RecordArgs {
    /// The values of the options, whose unit is one of acceleration where `acceleration` says so.
    pub fn options(&self, acceleration: bool) -> Result<RecordOptions, Failure> {
        let refuse = |option: &str, expected: &str, found: &str| {
            Failure::Message(format!("{option}: expected {expected}, found {found:?}"))
        };
        let units = self.units.as_deref().map(|text| {
            let units = Units::parse(text)
                .filter(|units| !acceleration || units.quantity() == Quantity::Acceleration);
            units.ok_or_else(|| {
                let known: Vec<_> =
                    Dimension::Acceleration.units().iter().map(Unit::name).collect();
                let known = format!("a unit of acceleration ({})", known.join(", "));
                let any =
                    "a unit of acceleration, velocity or displacement, such as g, cm/s2 or m/s";
                refuse("--units", if acceleration { &known } else { any }, text)
            })
        });
        let dt_s = self.dt.as_deref().map(|text| {
            let dt_s = quantity("--dt", text, Dimension::Time)?;
            if dt_s > 0.0 { Ok(dt_s) } else { Err(refuse("--dt", "a time step > 0", text)) }
        });
        Ok(RecordOptions {
            format: None,
            units: units.transpose()?,
            dt_s: dt_s.transpose()?,
            channel: self.channel.clone(),
        })
    }

    /// Refuses them where there is no record that they could speak of.
    pub fn only_with(&self, option: &str, given: bool) -> Result<(), Failure> {
        let said = [("--units", &self.units), ("--dt", &self.dt), ("--channel", &self.channel)];
        match said.iter().find(|(_, value)| value.is_some()) {
            Some((name, _)) if !given => {
                Err(Failure::Message(format!("{name}: expected {option} beside it, found none")))
            }
            _ => Ok(()),
        }
    }
}

/// `slipstick study`.
#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub struct StudyArgs {
    /// Another command instead of running a plan
    #[command(subcommand)]
    pub command: Option<StudyCommand>,
    /// Study plan (TOML)
    #[arg(required = true)]
    pub plan: Option<PathBuf>,
    /// Folder for parts/, summary.csv and manifest.json
    #[arg(short, long, value_name = "DIR", required_unless_present_any = ["dry_run", "repeat"])]
    pub out: Option<PathBuf>,
    /// Continue an interrupted study in this folder
    #[arg(long, conflicts_with = "force")]
    pub resume: bool,
    /// Start over: remove what an earlier study wrote into this folder
    #[arg(long)]
    pub force: bool,
    /// Number of threads
    #[command(flatten)]
    pub threads: Threads,
    /// Run only shard i of n, counted from 1
    #[arg(long, value_name = "i/n")]
    pub shard: Option<String>,
    /// Count the runs and estimate the time without running anything
    #[arg(long)]
    pub dry_run: bool,
    /// Print the command that reproduces a row, by its number in the column run
    #[arg(long, value_name = "RUN", conflicts_with_all = ["out", "dry_run"])]
    pub repeat: Option<u64>,
    /// Write report.html as well: the answer, figures and tables on one page
    #[arg(long, conflicts_with_all = ["dry_run", "repeat"])]
    pub report: bool,
    /// Units of table and page; other files are always SI
    #[arg(long, value_name = "SYSTEM", value_parser = unit_systems(), default_value = "si")]
    pub display_units: DisplayUnits,
    /// Print nothing on standard error but errors
    #[arg(short, long)]
    pub quiet: bool,
}

/// `slipstick study merge`.
#[derive(Debug, Subcommand)]
pub enum StudyCommand {
    /// Join the parts of a study, from one or several folders, in one file
    Merge {
        /// Folders that together hold all parts
        #[arg(required = true, value_name = "DIR")]
        folders: Vec<PathBuf>,
        /// The file to write
        #[arg(short, long, value_name = "FILE.parquet")]
        out: PathBuf,
    },
}

/// `slipstick paper`.
#[derive(Debug, Args)]
pub struct PaperArgs {
    /// Folder for chapter.md, its figures and claims.json
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Print the claims as a JSON array
    #[arg(long)]
    pub json: bool,
    /// Folder of records to add to the table of sliding against friction
    #[arg(long, value_name = "DIR")]
    pub records: Option<PathBuf>,
    /// Scan the ranges more coarsely
    #[arg(long)]
    pub quick: bool,
    /// Number of threads
    #[command(flatten)]
    pub threads: Threads,
    /// No progress on standard error
    #[arg(short, long)]
    pub quiet: bool,
}

/// `slipstick init`.
#[derive(Debug, Args)]
pub struct InitArgs {
    /// Name of the model; the file is NAME.toml
    #[arg(default_value = "model")]
    pub name: String,
    /// The example to write
    #[arg(long, value_enum, default_value = "mock-up")]
    pub example: Example,
    /// Replace a file of that name
    #[arg(long)]
    pub force: bool,
}

/// `slipstick schema`.
#[derive(Debug, Args)]
pub struct SchemaArgs {
    /// Print the units that values may have, instead of the schema
    #[arg(long)]
    pub units: bool,
    /// Print the schema of a study plan, instead of that of a model
    #[arg(long, conflicts_with = "units")]
    pub plan: bool,
    /// Print what may be asked of every analysis, with the defaults
    #[arg(long, conflicts_with_all = ["units", "plan"])]
    pub requests: bool,
}

/// The systems of units for what people read, by their names.
pub fn unit_systems() -> impl TypedValueParser<Value = DisplayUnits> {
    let value = |(name, _, about)| PossibleValue::new(name).help(about);
    let of_name = |name: String| DisplayUnits::of_name(&name).unwrap_or_default();
    PossibleValuesParser::new(DisplayUnits::NAMES.map(value)).map(of_name)
}

/// Example models.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum Example {
    /// A rigid block on a spring
    Block,
    /// A block with one storey
    #[value(name = "mock-up")]
    MockUp,
    /// Five storeys on pendulum sliders
    Frame,
    /// A building between rigid stops, on friction that follows the speed
    Stop,
    /// A tank on double pendulums
    DoublePendulum,
    /// A frame on triple pendulums
    TriplePendulum,
    /// A laboratory with unfastened equipment
    Contents,
    /// A building by its modes
    Structure,
    /// A tank with sloshing liquid
    TankSloshing,
}
