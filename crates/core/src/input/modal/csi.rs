//! Tables of ETABS and SAP2000, exported as CSV: one text may hold several, each below a line `TABLE: …`.
//!
//! Participating mass ratios give `L²/M`. Shapes and signs come from the joint displacements of the modal case `φ`
//! with the participation factors `f = φᵀ M 1` and modal masses `φᵀ M φ`, which are in the units of the export:
//!
//! ```text
//! L = f/√(φᵀ M φ)        shape of unit modal mass = φ/√(φᵀ M φ)        M = Σ L²/Σ ratio
//! ```

use std::collections::BTreeMap;

use super::super::tree::{SourceSpan, Sources};
use super::cells::{Cell, Exported, tables};
use super::{
    ModalOptions, ModalPoint, ModalRow, ModalTable, Share, in_order, refuse_missing, wanted,
};
use crate::error::{InputError, cut};
use crate::units::{Dimension, parse_quantity};

const AXES: [&str; 2] = ["x", "y"];

/// Part of the last digit that a rounded number may be off.
const HALF: f64 = 0.5;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Periods,
    Ratios,
    Factors,
    Displacements,
}

impl Kind {
    const ALL: [Self; 4] = [Self::Periods, Self::Ratios, Self::Factors, Self::Displacements];

    fn title(self) -> &'static str {
        match self {
            Self::Periods => "Modal Periods And Frequencies",
            Self::Ratios => "Modal Participating Mass Ratios",
            Self::Factors => "Modal Participation Factors",
            Self::Displacements => "Joint Displacements",
        }
    }

    /// By its title, else by its columns.
    fn of(table: &Exported<'_>) -> Option<Self> {
        if let Some(title) = table.title {
            return Self::ALL.into_iter().find(|kind| title.eq_ignore_ascii_case(kind.title()));
        }
        let has = |name: &str| table.find(&[name]).is_some();
        match () {
            () if has("period") && has("sumux") => Some(Self::Ratios),
            () if has("period") && has("modalmass") => Some(Self::Factors),
            () if has("period") && has("frequency") => Some(Self::Periods),
            () if has("ux") && has("uy") || has("u1") && has("u2") => Some(Self::Displacements),
            () => None,
        }
    }
}

/// The tables of some texts by their kinds.
struct ModalTables<'a> {
    tables: Vec<(Kind, Exported<'a>)>,
    others: Vec<String>,
}

impl<'a> ModalTables<'a> {
    fn read(sources: &Sources, texts: &[(usize, &'a str)]) -> Result<Self, InputError> {
        let mut found = Self { tables: Vec::new(), others: Vec::new() };
        for (source, text) in texts {
            for table in tables(sources, *source, text)? {
                match Kind::of(&table) {
                    Some(kind) if found.get(kind).is_some() => {
                        let expected = format!("the table {:?} once", kind.title());
                        return Err(sources.error(&table.spot, "", expected, "a second"));
                    }
                    Some(kind) => found.tables.push((kind, table)),
                    None => {
                        let title = table.title.map_or("a table without a title".to_owned(), cut);
                        found.others.push(title);
                    }
                }
            }
        }
        Ok(found)
    }

    fn get(&self, kind: Kind) -> Option<&Exported<'a>> {
        self.tables.iter().find(|(own, _)| *own == kind).map(|(_, table)| table)
    }
}

/// Rows of one modal case in the order of modes, and where the number of the mode stands.
fn rows_of<'t, 'a>(
    sources: &Sources,
    table: &'t Exported<'a>,
    options: &ModalOptions,
) -> Result<Vec<&'t Vec<Cell<'a>>>, InputError> {
    let case = table.find(&["case", "outputcase", "loadcase"]);
    let number = table.required(sources, &["mode", "stepnum", "stepnumber"], "Mode or StepNum")?;
    let mut rows: Vec<&Vec<Cell<'_>>> = Vec::new();
    for row in &table.rows {
        if let (Some(case), Some(wanted)) = (case, &options.case)
            && !row[case].text.eq_ignore_ascii_case(wanted)
        {
            continue;
        }
        if let (Some(case), Some(first)) = (case, rows.first())
            && row[case].text != first[case].text
        {
            let [one, other] = [first[case].text, row[case].text].map(cut);
            let expected = format!("one modal case, {one:?} or {other:?}: add --case");
            return Err(sources.error(&row[case].spot, "", expected, format!("{other:?}")));
        }
        let mode = table.mode(sources, &row[number])?;
        if mode != rows.len() + 1 {
            let expected = format!("mode {}: modes stand in their order", rows.len() + 1);
            return Err(sources.error(&row[number].spot, "", expected, format!("mode {mode}")));
        }
        rows.push(row);
    }
    if rows.is_empty() {
        let expected = match &options.case {
            Some(case) => format!("rows of the case {case:?}"),
            None => "a row for each mode".to_owned(),
        };
        return Err(sources.error(&table.spot, "", expected, "none"));
    }
    Ok(rows)
}

/// What one of a unit is in SI, from the units of force, length and time it is made of: `sec`, `kN-m-s2`.
fn unit_si(
    sources: &Sources,
    table: &Exported<'_>,
    column: usize,
    example: &str,
) -> Result<f64, InputError> {
    let column = &table.columns[column];
    if column.unit.is_empty() {
        let expected =
            format!("a unit of {:?} in the line below the names, such as {example}", column.name);
        return Err(sources.error(&column.spot, "", expected, "none"));
    }
    let one = |word: &str| -> Option<f64> {
        let word = word.replace('²', "2").to_lowercase();
        let (name, dimension) = match word.as_str() {
            "s2" | "sec2" => return Some(1.0),
            "sec" | "s" => ("s", Dimension::Time),
            "kgf" => return Some(crate::units::STANDARD_GRAVITY_M_PER_S2),
            "tonf" => return Some(1e3 * crate::units::STANDARD_GRAVITY_M_PER_S2),
            "n" => ("N", Dimension::Force),
            "kn" => ("kN", Dimension::Force),
            "mn" => return Some(1e6),
            "lb" | "lbf" => ("lbf", Dimension::Force),
            "kip" | "kips" => ("kip", Dimension::Force),
            length => (length, Dimension::Length),
        };
        parse_quantity(&format!("1 {name}"), dimension).ok()
    };
    let parts: Option<Vec<f64>> = column.unit.split('-').map(one).collect();
    // As many parts as the example has: kN-s2, kN-m-s2.
    match parts.filter(|parts| parts.len() == example.split('-').count()) {
        Some(parts) => Ok(parts.iter().product()),
        None => {
            let expected = format!("a unit of {:?}, such as {example}", column.name);
            Err(sources.error(&column.spot, "", expected, format!("{:?}", cut(column.unit))))
        }
    }
}

pub(super) fn read(
    sources: &Sources,
    texts: &[(usize, &str)],
    options: &ModalOptions,
) -> Result<ModalTable, InputError> {
    let found = ModalTables::read(sources, texts)?;
    let start = SourceSpan { source: texts.first().map_or(0, |(source, _)| *source), span: 0..0 };
    let base = found.get(Kind::Ratios).or(found.get(Kind::Factors));
    let Some(base) = base else {
        let expected = "the table \"Modal Participating Mass Ratios\" or \"Modal Participation Factors\" of ETABS or \
                        SAP2000, the report of modalProperties of OpenSees, or a modes.csv";
        return Err(sources.error(&start, "", expected, "none"));
    };
    let mut out =
        ModalTable { format: "tables of ETABS or SAP2000".to_owned(), ..Default::default() };
    let rows = rows_of(sources, base, options)?;
    let period = base.required(sources, &["period"], "Period")?;
    let unit_s = unit_si(sources, base, period, "sec")?;
    for row in &rows {
        let period_s = base.number(sources, &row[period])? * unit_s;
        let period_s = in_order(sources, &row[period].spot, period_s, out.modes.last())?;
        out.modes.push(ModalRow { period_s, damping_ratio: None, shares: [None; 2] });
    }
    if let Some(table) = found.get(Kind::Periods) {
        compare_periods(sources, table, &out, options)?;
    }
    let ratios = match found.get(Kind::Ratios) {
        Some(table) => ratios(sources, table, &rows, found.get(Kind::Factors).is_some(), &mut out)?,
        None => [0.0; 2],
    };
    if let Some(table) = found.get(Kind::Factors) {
        let root_mass = factors(sources, table, options, ratios, &mut out)?;
        if let Some(table) = found.get(Kind::Displacements) {
            shapes(sources, table, options, &root_mass, &mut out)?;
        }
    } else if let Some(table) = found.get(Kind::Displacements) {
        let expected = "beside it the table \"Modal Participation Factors\", which gives modal masses and signs";
        return Err(sources.error(&table.spot, "", expected, "none"));
    } else {
        say_of_signs(&mut out);
    }
    for (kind, table) in &found.tables {
        let mut units: Vec<&str> = Vec::new();
        for unit in table.columns.iter().map(|column| column.unit) {
            if !(unit.is_empty() || units.contains(&unit) || ["Text", "Unitless"].contains(&unit)) {
                units.push(unit);
            }
        }
        let units = if units.is_empty() { "no units".to_owned() } else { units.join(", ") };
        out.read.push(format!("{}: {} rows; {units}", kind.title(), table.rows.len()));
    }
    out.notes.extend(found.others.iter().map(|title| format!("{title}: not used")));
    Ok(out)
}

/// A second table of periods says the same.
fn compare_periods(
    sources: &Sources,
    table: &Exported<'_>,
    out: &ModalTable,
    options: &ModalOptions,
) -> Result<(), InputError> {
    let period = table.required(sources, &["period"], "Period")?;
    let unit_s = unit_si(sources, table, period, "sec")?;
    let rows = rows_of(sources, table, options)?;
    if rows.len() != out.modes.len() {
        let expected = format!("{} modes, as the other table has", out.modes.len());
        return Err(sources.error(&table.spot, "", expected, rows.len().to_string()));
    }
    for (row, mode) in rows.iter().zip(&out.modes) {
        let cell = &row[period];
        let period_s = table.number(sources, cell)? * unit_s;
        // Each is rounded to the digits that its table prints.
        if (period_s - mode.period_s).abs() > 2.0 * HALF * last_digit(cell.text) * unit_s {
            let expected = format!("the period of the other table, {} s", mode.period_s);
            return Err(sources.error(&cell.spot, "", expected, format!("{period_s} s")));
        }
    }
    Ok(())
}

/// What the last digit of a number as it is written is worth: 0.001 of `0.125`.
fn last_digit(text: &str) -> f64 {
    let (digits, exponent) = match text.split_once(['e', 'E']) {
        Some((digits, exponent)) => (digits, exponent.parse::<i32>().unwrap_or(0)),
        None => (text, 0),
    };
    let decimals = digits.split_once(['.', ',']).map_or(0, |(_, decimals)| decimals.len());
    libm::pow(10.0, f64::from(exponent) - decimals as f64)
}

/// Ratios of effective mass; their sums.
fn ratios(
    sources: &Sources,
    table: &Exported<'_>,
    rows: &[&Vec<Cell<'_>>],
    has_factors: bool,
    out: &mut ModalTable,
) -> Result<[f64; 2], InputError> {
    let mut sums = [0.0; 2];
    for (axis, name) in ["ux", "uy"].into_iter().enumerate() {
        let Some(column) = table.find(&[name]) else {
            continue;
        };
        let (mut sum, mut rounding) = (0.0, 0.0);
        for (row, mode) in rows.iter().zip(&mut out.modes) {
            let cell = &row[column];
            let ratio = table.number(sources, cell)?;
            if !(0.0..=1.0).contains(&ratio) {
                let expected = "a ratio of effective mass from 0 to 1";
                return Err(sources.error(
                    &cell.spot,
                    "",
                    expected,
                    format!("{:?}", cut(cell.text)),
                ));
            }
            sum += ratio;
            rounding += HALF * last_digit(cell.text);
            if sum > 1.0 + rounding {
                let expected =
                    format!("ratios of effective mass along {} that sum to at most 1", AXES[axis]);
                return Err(sources.error(
                    &cell.spot,
                    "",
                    expected,
                    format!("{sum} with this mode"),
                ));
            }
            mode.shares[axis] = Some(Share::Ratio(ratio));
        }
        if sum > 1.0 && !has_factors {
            for mode in &mut out.modes {
                if let Some(Share::Ratio(ratio)) = &mut mode.shares[axis] {
                    *ratio /= sum;
                }
            }
            out.notes.push(format!(
                "ratios along {} sum to {sum:.6} by their rounding and are divided by that",
                AXES[axis]
            ));
        }
        sums[axis] = sum.min(1.0);
    }
    if table.find(&["ux", "uy"]).is_none() {
        table.required(sources, &["ux"], "UX or UY")?;
    }
    Ok(sums)
}

/// Participations, and `√(φᵀ M φ)` of each mode in √kg m.
fn factors(
    sources: &Sources,
    table: &Exported<'_>,
    options: &ModalOptions,
    ratios: [f64; 2],
    out: &mut ModalTable,
) -> Result<Vec<f64>, InputError> {
    let rows = rows_of(sources, table, options)?;
    if rows.len() != out.modes.len() {
        let expected = format!("{} modes, as the other table has", out.modes.len());
        return Err(sources.error(&table.spot, "", expected, rows.len().to_string()));
    }
    let column = table.required(sources, &["modalmass"], "ModalMass")?;
    let unit_kg_m2 = unit_si(sources, table, column, "kN-m-s2")?;
    let mut root_mass = Vec::with_capacity(rows.len());
    for row in &rows {
        let cell = &row[column];
        let mass_kg_m2 = table.number(sources, cell)? * unit_kg_m2;
        if mass_kg_m2 <= 0.0 {
            return Err(sources.error(
                &cell.spot,
                "",
                "a modal mass > 0",
                format!("{:?}", cut(cell.text)),
            ));
        }
        root_mass.push(mass_kg_m2.sqrt());
    }
    for (axis, name) in ["ux", "uy"].into_iter().enumerate() {
        let Some(column) = table.find(&[name]) else { continue };
        let unit_kg_m = unit_si(sources, table, column, "kN-s2")?;
        let mut sum_kg = 0.0;
        for ((row, mode), root) in rows.iter().zip(&mut out.modes).zip(&root_mass) {
            let l = table.number(sources, &row[column])? * unit_kg_m / root;
            sum_kg += l * l;
            mode.shares[axis] = Some(Share::Participation(l));
        }
        out.mass_kg[axis] = (ratios[axis] > 0.0).then(|| sum_kg / ratios[axis]);
    }
    Ok(root_mass)
}

/// Shapes at the joints, of unit modal mass.
fn shapes(
    sources: &Sources,
    table: &Exported<'_>,
    options: &ModalOptions,
    root_mass: &[f64],
    out: &mut ModalTable,
) -> Result<(), InputError> {
    let joint =
        table.required(sources, &["uniquename", "joint", "label"], "Joint or Unique Name")?;
    let number = table.required(sources, &["stepnum", "stepnumber", "mode"], "StepNum")?;
    let kind = table.find(&["steptype"]);
    let (story, label) = (table.find(&["story"]), table.find(&["label"]));
    let mut axes = Vec::new();
    for (axis, names) in [["ux", "u1"], ["uy", "u2"]].into_iter().enumerate() {
        let column =
            table.required(sources, &names, if axis == 0 { "Ux or U1" } else { "Uy or U2" })?;
        axes.push((column, unit_si(sources, table, column, "m")?));
    }
    let modes = root_mass.len();
    let mut found: Vec<(String, SourceSpan, [Vec<f64>; 2])> = Vec::new();
    let mut places: BTreeMap<String, usize> = BTreeMap::new();
    for row in &table.rows {
        // Static cases have no modes.
        if kind.is_some_and(|kind| !row[kind].text.eq_ignore_ascii_case("mode")) {
            continue;
        }
        let at_story = story.zip(label).map(|(s, l)| format!("{} {}", row[s].text, row[l].text));
        let names: Vec<&str> = [row[joint].text].into_iter().chain(at_story.as_deref()).collect();
        let Some(name) = wanted(options, &names) else { continue };
        let place = *places.entry(name.clone()).or_insert(found.len());
        if place == found.len() {
            found.push((name, row[joint].spot.clone(), [Vec::new(), Vec::new()]));
        }
        let mode = table.mode(sources, &row[number])?;
        let shapes = &mut found[place].2;
        if mode != shapes[0].len() + 1 || mode > modes {
            let expected = match shapes[0].len() {
                so_far if so_far < modes => format!("mode {} of this joint", so_far + 1),
                _ => format!("{modes} modes, as the other tables have"),
            };
            return Err(sources.error(&row[number].spot, "", expected, format!("mode {mode}")));
        }
        for (shape, (column, unit_m)) in shapes.iter_mut().zip(&axes) {
            shape.push(table.number(sources, &row[*column])? * unit_m / root_mass[mode - 1]);
        }
    }
    for (name, spot, [x, y]) in found {
        if x.len() != modes {
            let expected = format!("{modes} modes at this joint, as the other tables have");
            return Err(sources.error(&spot, "", expected, x.len().to_string()));
        }
        out.points.push(ModalPoint { name, shapes: [Some(x), Some(y)] });
    }
    refuse_missing(sources, &table.spot, options, &out.points)
}

/// Ratios along x and y of one mode do not say whether it moves along both or against.
fn say_of_signs(out: &mut ModalTable) {
    const SMALL: f64 = 1e-3;
    let is_coupled = |mode: &ModalRow| {
        mode.shares.iter().all(|share| matches!(share, Some(Share::Ratio(ratio)) if *ratio > SMALL))
    };
    let coupled: Vec<String> = (1..)
        .zip(&out.modes)
        .filter(|(_, mode)| is_coupled(mode))
        .map(|(number, _)| number.to_string())
        .collect();
    if !coupled.is_empty() {
        out.notes.push(format!(
            "ratios say no signs: for the motion in two directions it matters whether L_x and L_y of one mode have the \
             same (modes {}), which the table \"Modal Participation Factors\" tells",
            coupled.join(", ")
        ));
    }
}
