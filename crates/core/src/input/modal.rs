//! The modes of a structure as the programs write them where it was modelled: tables of ETABS and SAP2000, the
//! report of OpenSees.
//!
//! What is read is written in the form of our own, `modes.csv`, by [`ModalTable::to_csv`]. Signs: a mode may be
//! turned round, `(L, φ) → (−L, −φ)`, but `L_x`, `L_y` and `φ` of one mode only together. Effective masses give
//! `L²` alone, which is enough for the motion of the block along one direction.

use core::fmt::Write as _;

use super::tree::{SourceSpan, Sources};
use crate::error::InputError;
use crate::model::ROUNDED_MASS;

mod cells;
mod csi;
mod matrices;
mod opensees;
mod ours;

pub use matrices::EigenMatrices;
pub use opensees::OPENSEES_TITLE;

/// What files do not say themselves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ModalOptions {
    /// The modal case, where there are several.
    pub case: Option<String>,
    /// The mass in kg that is one in a program without units.
    pub mass_unit_kg: Option<f64>,
    /// Joints whose motion is wanted, and what they are to be called; all of them by their own names where empty.
    pub points: Vec<(String, String)>,
}

/// What a mode takes of the mass in one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Share {
    /// Participation `L = φᵀ M 1` of a shape of unit modal mass, in √kg.
    Participation(f64),
    /// Effective mass `L²` over that of the structure.
    Ratio(f64),
}

/// One mode.
#[derive(Clone, Debug, PartialEq)]
pub struct ModalRow {
    /// Its period in s.
    pub period_s: f64,
    /// Ratio of critical damping, where it is given.
    pub damping_ratio: Option<f64>,
    /// Its share of the mass along x and y.
    pub shares: [Option<Share>; 2],
}

/// The shapes at one point.
#[derive(Clone, Debug, PartialEq)]
pub struct ModalPoint {
    /// Its name.
    pub name: String,
    /// Displacement along x and y, mode by mode, of shapes of unit modal mass, in 1/√kg.
    pub shapes: [Option<Vec<f64>>; 2],
}

/// The modes of a structure, and what was understood of the files.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ModalTable {
    /// The program and its tables.
    pub format: String,
    /// What was read, one line a table: its rows and units.
    pub read: Vec<String>,
    /// Mass of the structure along x and y in kg, where the files say it.
    pub mass_kg: [Option<f64>; 2],
    /// Modes, the longest period first.
    pub modes: Vec<ModalRow>,
    /// Points.
    pub points: Vec<ModalPoint>,
    /// What the reader should know.
    pub notes: Vec<String>,
}

/// Reads the files of one structure, each a name and its text: tables of ETABS or SAP2000, or the report of
/// OpenSees with the eigenvectors; or one `modes.csv`.
///
/// # Errors
/// [`InputError`] at the first fault.
pub fn read_modes(
    files: &[(&str, &str)],
    options: &ModalOptions,
) -> Result<ModalTable, InputError> {
    if let [(name, text)] = files
        && ours::is_ours(text)
    {
        return ours::read(name, text);
    }
    let mut sources = Sources::default();
    let texts: Vec<(usize, &str)> =
        files.iter().map(|(name, text)| (sources.add(name, text), *text)).collect();
    for (source, text) in &texts {
        if let Some([expected, found]) = crate::record::packed(text.as_bytes()) {
            let start = SourceSpan { source: *source, span: 0..0 };
            return Err(sources.error(&start, "", expected, found));
        }
    }
    let mut table = match texts.iter().position(|(_, text)| text.contains(OPENSEES_TITLE)) {
        Some(report) => opensees::read(&sources, &texts, report, options)?,
        None => csi::read(&sources, &texts, options)?,
    };
    table.fit_to_mass();
    Ok(table)
}

impl ModalTable {
    /// Divides what the modes have of the mass by its sum, where that exceeds all of it by more than a model takes,
    /// which is the rounding of printed digits; notes it.
    fn fit_to_mass(&mut self) {
        for (axis, name) in ["x", "y"].into_iter().enumerate() {
            let sum = self.sum(axis, None).filter(|sum| *sum > 1.0 + ROUNDED_MASS);
            let Some(sum) = sum else { continue };
            for mode in &mut self.modes {
                mode.shares[axis] = mode.shares[axis].map(|share| match share {
                    Share::Participation(l) => Share::Participation(l / sum.sqrt()),
                    Share::Ratio(ratio) => Share::Ratio(ratio / sum),
                });
            }
            self.notes.push(format!(
                "the effective masses along {name} sum to {sum:.7} of the mass, by the rounding of their digits: \
                 all are divided by it"
            ));
        }
    }

    /// The effective mass of a mode along x (0) or y (1) in kg, where its share or the mass is known: `mass_kg`
    /// takes the place of what the files say.
    #[must_use]
    pub fn effective_mass_kg(&self, mode: usize, axis: usize, mass_kg: Option<f64>) -> Option<f64> {
        match self.modes[mode].shares[axis]? {
            Share::Participation(l) => Some(l * l),
            Share::Ratio(ratio) => mass_kg.or(self.mass_kg[axis]).map(|mass_kg| ratio * mass_kg),
        }
    }

    /// The same over the mass of the structure.
    #[must_use]
    pub fn ratio(&self, mode: usize, axis: usize, mass_kg: Option<f64>) -> Option<f64> {
        match self.modes[mode].shares[axis]? {
            Share::Participation(l) => {
                mass_kg.or(self.mass_kg[axis]).map(|mass_kg| l * l / mass_kg)
            }
            Share::Ratio(ratio) => Some(ratio),
        }
    }

    /// The sum of effective masses over the mass of the structure.
    #[must_use]
    pub fn sum(&self, axis: usize, mass_kg: Option<f64>) -> Option<f64> {
        (0..self.modes.len()).map(|j| self.ratio(j, axis, mass_kg)).sum()
    }

    /// `modes.csv`, the table that `structure.modes` of a model file names.
    #[must_use]
    pub fn to_csv(&self) -> String {
        let mut columns: Vec<(String, Vec<f64>)> = Vec::new();
        let of = |value: fn(&ModalRow) -> Option<f64>| -> Option<Vec<f64>> {
            self.modes.iter().map(value).collect()
        };
        columns.extend(of(|mode| Some(mode.period_s)).map(|c| ("period_s".to_owned(), c)));
        columns.extend(of(|mode| mode.damping_ratio).map(|c| ("damping_ratio".to_owned(), c)));
        for (axis, suffix) in ["x", "y"].into_iter().enumerate() {
            let share = |wanted: fn(Share) -> Option<f64>| -> Option<Vec<f64>> {
                self.modes.iter().map(|mode| mode.shares[axis].and_then(wanted)).collect()
            };
            let participation = share(|share| match share {
                Share::Participation(l) => Some(l),
                Share::Ratio(_) => None,
            });
            let ratio = share(|share| match share {
                Share::Participation(_) => None,
                Share::Ratio(ratio) => Some(ratio),
            });
            columns.extend(participation.map(|c| (format!("participation_{suffix}"), c)));
            columns.extend(ratio.map(|c| (format!("effective_mass_ratio_{suffix}"), c)));
        }
        for point in &self.points {
            for (shape, suffix) in point.shapes.iter().zip(["x", "y"]) {
                let shape = shape.clone();
                columns.extend(shape.map(|shape| (format!("{}_{suffix}", point.name), shape)));
            }
        }
        let names: Vec<&str> = columns.iter().map(|(name, _)| name.as_str()).collect();
        let mut out = format!("{}\n", names.join(","));
        for j in 0..self.modes.len() {
            let row: Vec<String> = columns.iter().map(|(_, c)| c[j].to_string()).collect();
            let _ = writeln!(out, "{}", row.join(","));
        }
        out
    }
}

/// The name of a point as a column of `modes.csv` has it: in lower case, `_` for what is no letter or digit.
fn column_name(name: &str) -> String {
    let plain = |c: char| if c.is_alphanumeric() { c } else { '_' };
    name.to_lowercase().chars().map(plain).collect()
}

/// What a joint is to be called; `None` where its motion is not wanted.
fn wanted(options: &ModalOptions, names: &[&str]) -> Option<String> {
    if options.points.is_empty() {
        return names.first().map(|name| column_name(name));
    }
    let is_meant = |joint: &str| names.iter().any(|name| name.eq_ignore_ascii_case(joint));
    options.points.iter().find(|(_, joint)| is_meant(joint)).map(|(name, _)| column_name(name))
}

/// Refuses joints that were asked for and are not there.
fn refuse_missing(
    sources: &Sources,
    spot: &SourceSpan,
    options: &ModalOptions,
    points: &[ModalPoint],
) -> Result<(), InputError> {
    let is_there = |name: &str| points.iter().any(|point| point.name == column_name(name));
    match options.points.iter().find(|(name, _)| !is_there(name)) {
        Some((_, joint)) => {
            Err(sources.error(spot, "", format!("rows of the joint {joint:?}"), "none"))
        }
        None => Ok(()),
    }
}

/// A period as a mode has it: finite, > 0, at most that of the mode before.
fn in_order(
    sources: &Sources,
    spot: &SourceSpan,
    period_s: f64,
    before: Option<&ModalRow>,
) -> Result<f64, InputError> {
    let found = || format!("{period_s} s");
    if !(period_s.is_finite() && period_s > 0.0) {
        return Err(sources.error(spot, "", "a finite period > 0", found()));
    }
    match before {
        Some(before) if period_s > before.period_s => {
            let longest_s = before.period_s;
            let expected = format!(
                "a period of at most {longest_s} s, that of the mode before: modes stand in order of \
                 period, the longest first"
            );
            Err(sources.error(spot, "", expected, found()))
        }
        _ => Ok(period_s),
    }
}
