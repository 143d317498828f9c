//! `modes.csv` and the structure of a model, as modes to be shown beside those of other programs.

use core::f64::consts::TAU;

use super::super::{Override, parse};
use super::{ModalPoint, ModalRow, ModalTable, Share};
use crate::error::InputError;
use crate::model::Structure;

/// A mass in kg that bounds no sum of effective masses, where `modes.csv` is read without its model.
const ANY_MASS_KG: f64 = 1e15;

/// The first line that is no comment, in lower case.
fn header(text: &str) -> String {
    let is_comment = |line: &str| line.trim().is_empty() || line.trim_start().starts_with('#');
    text.lines().find(|line| !is_comment(line)).unwrap_or("").to_lowercase()
}

/// Whether a text is a `modes.csv`: its header names periods or frequencies.
pub(super) fn is_ours(text: &str) -> bool {
    let header = header(text);
    header.contains("period_s") || header.contains("frequency_hz")
}

/// Reads `modes.csv` as the model reads it that names it.
pub(super) fn read(name: &str, text: &str) -> Result<ModalTable, InputError> {
    let header = header(text);
    let has_damping = header.contains("damping_ratio");
    let damping = if has_damping { "" } else { "damping_ratio = 0\n" };
    let model = format!(
        "[block]\nmass = \"1 kg\"\n[slider]\nstatic_friction = 0\nkinetic_friction = 0\n\
         [structure]\nmass = \"{ANY_MASS_KG} kg\"\n{damping}modes = \"modes.csv\"\n"
    );
    let analysis = parse("modes.csv", &model, &[Override::modes(name, text)])?;
    let mut out = analysis.model.structure().map(ModalTable::of).unwrap_or_default();
    out.format = "modes.csv".to_owned();
    out.mass_kg = [None; 2];
    for mode in &mut out.modes {
        mode.damping_ratio = mode.damping_ratio.filter(|_| has_damping);
        if let Some(Share::Participation(l)) = mode.shares[0]
            && header.contains("effective_mass_ratio")
        {
            mode.shares[0] = Some(Share::Ratio(l * l / ANY_MASS_KG));
        }
    }
    if header.contains("effective_mass") && !out.points.is_empty() {
        out.notes.push(
            "shapes are shown as those of unit modal mass; what they are normalised to is said in the model"
                .to_owned(),
        );
    }
    let is_along_y = |name: &str| name.trim_matches(['"', ' ']).ends_with("_y");
    if out.modes.iter().all(|mode| mode.shares[1].is_none())
        && header.split([',', ';', '\t']).any(is_along_y)
    {
        out.notes.push("columns that end in _y are not used".to_owned());
    }
    Ok(out)
}

impl ModalTable {
    /// The structure of a model, each mode turned so that `L > 0`.
    #[must_use]
    pub fn of(structure: &Structure) -> Self {
        let modes = &structure.modes;
        let row = |mode: &crate::model::StructureMode| ModalRow {
            period_s: TAU / mode.frequency_rad_per_s,
            damping_ratio: Some(mode.damping_ratio),
            shares: [Some(Share::Participation(mode.effective_mass_kg.sqrt())), None],
        };
        // φ = (φ L)/L
        let shape = |i: usize| {
            let shape = modes.iter().map(|mode| mode.points[i] / mode.effective_mass_kg.sqrt());
            [Some(shape.collect()), None]
        };
        let points = structure.points.iter().enumerate();
        Self {
            format: "model".to_owned(),
            read: Vec::new(),
            mass_kg: [Some(structure.mass_kg), None],
            modes: modes.iter().map(row).collect(),
            points: points
                .map(|(i, point)| ModalPoint { name: point.name.clone(), shapes: shape(i) })
                .collect(),
            notes: Vec::new(),
        }
    }
}
