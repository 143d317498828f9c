//! The report of `modalProperties -file` of OpenSees, and eigenvectors as a table `mode,node,ux,uy`.
//!
//! The report has participation factors `Γ = φᵀ M 1/φᵀ M φ` and participation masses `L²`, so that
//!
//! ```text
//! L = √(L²) sgn Γ        √(φᵀ M φ) = √(L²)/|Γ|        shape of unit modal mass = φ/√(φᵀ M φ)
//! ```
//!
//! OpenSees has no units; shapes over unit modal mass need that of mass alone. z is upwards, in two dimensions y.

use std::collections::BTreeMap;

use super::super::tree::{SourceSpan, Sources};
use super::cells::{Exported, tables};
use super::{
    ModalOptions, ModalPoint, ModalRow, ModalTable, Share, in_order, refuse_missing, wanted,
};
use crate::error::{InputError, cut};

/// How the report begins.
pub const OPENSEES_TITLE: &str = "MODAL ANALYSIS REPORT";

/// A number of the report and where it stands.
struct Number {
    value: f64,
    spot: SourceSpan,
}

/// A section: its title and rows of numbers.
struct Section<'a> {
    title: &'a str,
    spot: SourceSpan,
    rows: Vec<Vec<Number>>,
}

/// What is common to the modes: their number of directions and `√(φᵀ M φ)` of each.
struct Normalisation {
    axes: usize,
    root_mass: Vec<f64>,
    /// Square root of the unit of mass, in √kg.
    root_unit: f64,
}

pub(super) fn read(
    sources: &Sources,
    texts: &[(usize, &str)],
    report: usize,
    options: &ModalOptions,
) -> Result<ModalTable, InputError> {
    let (source, text) = texts[report];
    let Some(unit_kg) = options.mass_unit_kg else {
        let expected = "the unit of mass of the model, since OpenSees has none: add --mass-unit, such as kg or t";
        return Err(sources.error(&SourceSpan { source, span: 0..0 }, "", expected, "none"));
    };
    let (mut out, normalisation) = modes(sources, source, text, unit_kg)?;
    for (i, (source, text)) in texts.iter().enumerate() {
        if i == report {
            continue;
        }
        for table in tables(sources, *source, text)? {
            eigenvectors(sources, &table, options, &normalisation, &mut out)?;
        }
    }
    Ok(out)
}

/// The modes of the report.
fn modes(
    sources: &Sources,
    source: usize,
    text: &str,
    unit_kg: f64,
) -> Result<(ModalTable, Normalisation), InputError> {
    let sections = sections(sources, source, text)?;
    let section = |title: &str, columns: usize| -> Result<&Section<'_>, InputError> {
        let found = sections.iter().find(|section| section.title.eq_ignore_ascii_case(title));
        let end = SourceSpan { source, span: text.len()..text.len() };
        let section = found
            .ok_or_else(|| sources.error(&end, "", format!("the section {title:?}"), "none"))?;
        for row in &section.rows {
            if row.len() < columns {
                let spot = row.first().map_or(&section.spot, |number| &number.spot);
                return Err(sources.error(
                    spot,
                    "",
                    format!("{columns} numbers"),
                    row.len().to_string(),
                ));
            }
        }
        Ok(section)
    };
    let first =
        |section: &Section<'_>, column: usize| section.rows.first().map(|row| row[column].value);
    let dimensions = first(section("DOMAIN SIZE", 1)?, 0);
    let axes = if matches!(dimensions, Some(1.0 | 2.0)) { 1 } else { 2 };
    let eigen = section("EIGENVALUE ANALYSIS", 5)?;
    let mass = section("TOTAL FREE MASS OF THE STRUCTURE", axes)?;
    let factors = section("MODAL PARTICIPATION FACTORS", 1 + axes)?;
    let masses = section("MODAL PARTICIPATION MASSES", 1 + axes)?;
    for other in [factors, masses] {
        if other.rows.len() != eigen.rows.len() {
            let expected = format!("{} modes, as the eigenvalue analysis has", eigen.rows.len());
            return Err(sources.error(&other.spot, "", expected, other.rows.len().to_string()));
        }
    }
    let mut out = ModalTable {
        format: "report of modalProperties of OpenSees".to_owned(),
        ..Default::default()
    };
    let mut root_mass = Vec::new();
    for ((row, factors), masses) in eigen.rows.iter().zip(&factors.rows).zip(&masses.rows) {
        let period_s = in_order(sources, &row[4].spot, row[4].value, out.modes.last())?;
        let mut shares = [None; 2];
        for axis in 0..axes {
            let mass = &masses[1 + axis];
            if mass.value < 0.0 {
                return Err(sources.error(&mass.spot, "", "a mass ≥ 0", mass.value.to_string()));
            }
            let l = (mass.value * unit_kg).sqrt().copysign(factors[1 + axis].value);
            shares[axis] = Some(Share::Participation(l));
        }
        root_mass.push(modal_mass_root(factors, masses));
        out.modes.push(ModalRow { period_s, damping_ratio: None, shares });
    }
    if out.modes.is_empty() {
        return Err(sources.error(&eigen.spot, "", "a row for each mode", "none"));
    }
    for axis in 0..axes {
        out.mass_kg[axis] = first(mass, axis).map(|mass| mass * unit_kg).filter(|mass| *mass > 0.0);
        let sum_kg: f64 =
            (0..out.modes.len()).filter_map(|j| out.effective_mass_kg(j, axis, None)).sum();
        // Six digits are printed.
        if out.mass_kg[axis].is_some_and(|mass_kg| sum_kg > mass_kg * (1.0 + 1e-5)) {
            let expected = "participation masses that sum to at most the total free mass";
            return Err(sources.error(&masses.spot, "", expected, format!("{sum_kg} kg")));
        }
    }
    out.read
        .push(format!("modal report: {} modes; one unit of mass is {unit_kg} kg", out.modes.len()));
    let normalisation = Normalisation { axes, root_mass, root_unit: unit_kg.sqrt() };
    Ok((out, normalisation))
}

/// `√(φᵀ M φ) = √(L²)/|Γ|`, from the direction of the largest mass; 1 of a mode that takes part in none.
fn modal_mass_root(factors: &[Number], masses: &[Number]) -> f64 {
    let pairs = factors.iter().zip(masses).skip(1);
    let root =
        |(factor, mass): (&Number, &Number)| (mass.value, mass.value.sqrt() / factor.value.abs());
    let largest = pairs.map(root).filter(|(_, root)| root.is_finite() && *root > 0.0);
    largest.max_by(|a, b| a.0.total_cmp(&b.0)).map_or(1.0, |(_, root)| root)
}

/// Sections `* 2. EIGENVALUE ANALYSIS:` with the numbers of their lines; `#` begins a comment.
fn sections<'a>(
    sources: &Sources,
    source: usize,
    text: &'a str,
) -> Result<Vec<Section<'a>>, InputError> {
    let mut all: Vec<Section<'a>> = Vec::new();
    let mut at = 0;
    for whole in text.split_inclusive('\n') {
        let from = at;
        at += whole.len();
        let line = whole.trim_end();
        if let Some(title) = line.strip_prefix('*') {
            let title = title.split_once(". ").map_or(title, |(_, title)| title);
            let title = title.trim().trim_end_matches(':');
            let spot = SourceSpan { source, span: from..from + line.len() };
            all.push(Section { title, spot, rows: Vec::new() });
            continue;
        }
        let Some(section) = all.last_mut().filter(|_| !line.trim_start().starts_with('#')) else {
            continue;
        };
        let mut row = Vec::new();
        for word in line.split_whitespace() {
            let start = from + (word.as_ptr() as usize - whole.as_ptr() as usize);
            let spot = SourceSpan { source, span: start..start + word.len() };
            match word.parse::<f64>().ok().filter(|value| value.is_finite()) {
                Some(value) => row.push(Number { value, spot }),
                None => {
                    let found = format!("{:?}", cut(word));
                    return Err(sources.error(&spot, "", "a finite number", found));
                }
            }
        }
        if !row.is_empty() {
            section.rows.push(row);
        }
    }
    Ok(all)
}

/// The shapes at a node so far.
struct AtNode {
    name: String,
    spot: SourceSpan,
    shape: Vec<[Option<f64>; 2]>,
}

/// Shapes at nodes: a row for each node and mode.
fn eigenvectors(
    sources: &Sources,
    table: &Exported<'_>,
    options: &ModalOptions,
    normalisation: &Normalisation,
    out: &mut ModalTable,
) -> Result<(), InputError> {
    let Normalisation { axes, root_mass, root_unit } = normalisation;
    let modes = root_mass.len();
    let number = table.required(sources, &["mode"], "mode, node, ux, uy")?;
    let node = table.required(sources, &["node"], "node")?;
    let mut columns = vec![table.required(sources, &["ux"], "ux")?];
    if *axes == 2 {
        columns.push(table.required(sources, &["uy"], "uy")?);
    }
    let mut found: Vec<AtNode> = Vec::new();
    let mut places: BTreeMap<String, usize> = BTreeMap::new();
    for row in &table.rows {
        let Some(name) = wanted(options, &[row[node].text]) else { continue };
        let mode = table.mode(sources, &row[number])?;
        let place = *places.entry(name.clone()).or_insert(found.len());
        if place == found.len() {
            found.push(AtNode {
                name,
                spot: row[node].spot.clone(),
                shape: vec![[None; 2]; modes],
            });
        }
        let Some(shape) = found[place].shape.get_mut(mode - 1).filter(|shape| shape[0].is_none())
        else {
            let expected = format!("each of {modes} modes once at this node");
            return Err(sources.error(&row[number].spot, "", expected, format!("mode {mode}")));
        };
        for (value, column) in shape.iter_mut().zip(&columns) {
            let phi = table.number(sources, &row[*column])?;
            *value = Some(phi / (root_mass[mode - 1] * root_unit));
        }
    }
    for AtNode { name, spot, shape } in found {
        let along =
            |axis: usize| shape.iter().map(|shape| shape[axis]).collect::<Option<Vec<f64>>>();
        let Some(x) = along(0) else {
            let given = shape.iter().filter(|shape| shape[0].is_some()).count();
            let expected = format!("{modes} modes at this node, as the report has");
            return Err(sources.error(&spot, "", expected, given.to_string()));
        };
        out.points.push(ModalPoint { name, shapes: [Some(x), along(1)] });
    }
    out.read.push(format!("eigenvectors: {} rows", table.rows.len()));
    refuse_missing(sources, &table.spot, options, &out.points)
}
