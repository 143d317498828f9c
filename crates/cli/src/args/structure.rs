//! What is typed after `slipstick structure`.

use clap::{Args, Subcommand};
use std::path::PathBuf;

use slipstick_report::DisplayUnits;

use super::unit_systems;

/// Below the help of `slipstick structure`.
pub const EXAMPLES: &str = "\
Examples:
  slipstick structure info building.csv --mass \"1200 t\" --svg modes.svg
  slipstick structure info periods.csv ratios.csv factors.csv displacements.csv --json
  slipstick structure convert building.csv --point Roof=103 --damping \"3 %\" -o modes.csv
  slipstick structure convert modal.txt eigenvectors.csv --mass-unit t -o modes.csv
  slipstick structure info model.toml
  slipstick structure tank --radius \"10 m\" --height \"8 m\" -o tank.toml
  slipstick structure tank --radius \"30 ft\" --height \"24 ft\" --specific-gravity 0.85 -o oil.toml

FILES are those of one structure: tables of ETABS or SAP2000 as CSV, in one file or several (\"Modal
Participating Mass Ratios\"; for signs and shapes \"Modal Participation Factors\" and \"Joint
Displacements\"); the report of modalProperties of OpenSees, with a table mode,node,ux,uy for shapes;
a modes.csv; or a model with [structure].";

/// Commands on structures.
#[derive(Debug, Subcommand)]
pub enum StructureCommand {
    /// Say what is understood of the modes of a structure: masses, what is missing, points, shapes
    Info(StructureInfoArgs),
    /// Write modes.csv, the table of modes that a model names
    Convert(StructureConvertArgs),
    /// Write the model of a circular tank with sloshing liquid, by Housner's two masses
    Tank(StructureTankArgs),
}

/// How files are read.
#[derive(Debug, Args)]
pub struct ModalArgs {
    /// Files of one structure
    #[arg(value_name = "FILE", required = true)]
    pub files: Vec<PathBuf>,
    /// Mass of the structure, where the files do not say it: "1200 t"
    #[arg(long, value_name = "MASS")]
    pub mass: Option<String>,
    /// The modal case, where there are several
    #[arg(long, value_name = "NAME")]
    pub case: Option<String>,
    /// What one unit of mass is in a program without units, OpenSees: t, kg or "175.127 t"
    #[arg(long, value_name = "UNIT")]
    pub mass_unit: Option<String>,
    /// A joint whose motion is wanted, by its name or number or by story and label, and what to call it; may be
    /// repeated; default: all joints of the table
    #[arg(long, value_name = "NAME=JOINT")]
    pub point: Vec<String>,
}

/// `slipstick structure info`.
#[derive(Debug, Args)]
pub struct StructureInfoArgs {
    #[command(flatten)]
    pub read: ModalArgs,
    /// Print a JSON object
    #[arg(long)]
    pub json: bool,
    /// Draw the shapes of the first modes at the points
    #[arg(long, value_name = "FILE.svg")]
    pub svg: Option<PathBuf>,
    /// Units of the table; JSON is always SI
    #[arg(long, value_name = "SYSTEM", value_parser = unit_systems(), default_value = "si")]
    pub display_units: DisplayUnits,
}

/// `slipstick structure convert`.
#[derive(Debug, Args)]
pub struct StructureConvertArgs {
    #[command(flatten)]
    pub read: ModalArgs,
    /// Ratio of critical damping of all modes, such as "3 %" or 0.03; without it structure.damping_ratio of the
    /// model says it
    #[arg(long, value_name = "DAMPING")]
    pub damping: Option<String>,
    /// File to write; else standard output
    #[arg(short, long, value_name = "FILE.csv")]
    pub out: Option<PathBuf>,
}

/// `slipstick structure tank`.
#[derive(Debug, Args)]
pub struct StructureTankArgs {
    /// Radius of the tank, inside: "10 m", "33 ft"
    #[arg(long, value_name = "LENGTH")]
    pub radius: String,
    /// Height of the liquid
    #[arg(long, value_name = "LENGTH")]
    pub height: String,
    /// Density of the liquid over that of water, 1000 kg/m³
    #[arg(long, value_name = "NUMBER", default_value_t = 1.0)]
    pub specific_gravity: f64,
    /// Model file to write; else standard output
    #[arg(short, long, value_name = "FILE.toml")]
    pub out: Option<PathBuf>,
}
