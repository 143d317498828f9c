//! What a code requires of the runs: its values, forces over the height, and one row a requirement.

use serde::Serialize;
use slipstick::assessment::code::{CodeUnit, FoundValue, JudgedRule, Judgement, LevelForces, Side};

use super::HistoriesReport;
use crate::assessment::sheet::{SheetTable, cell};
use crate::display::{DisplayUnits, Quantity};
use crate::json::each;
use crate::markup::shortened;
use crate::number::compact;
use crate::view;

/// Names of directions.
pub(super) const DIRECTIONS: [&str; 2] = ["x", "y"];

/// A value with its unit, as people read it.
fn shown(value: f64, unit: CodeUnit, display: DisplayUnits) -> String {
    match unit {
        CodeUnit::Percent => format!("{} %", cell(100.0 * value)),
        CodeUnit::Number if value == value.trunc() && value.abs() < 1e6 => compact(value),
        CodeUnit::Number => cell(value),
        CodeUnit::Of(dimension) => {
            let unit = display.unit(Quantity::from(Some(dimension)), value);
            format!("{} {}", cell(unit.of(value)), unit.symbol)
        }
    }
}

/// `lower friction, x`, or nothing.
fn side(Side { bound, direction }: Side) -> String {
    let bound = bound.map(|bound| format!("{bound} friction"));
    let both: Vec<String> = bound.into_iter().chain(direction.map(str::to_owned)).collect();
    both.join(", ")
}

/// A clause as words: one that is a number behind a sign for it.
fn place(clause: &str) -> String {
    match clause.starts_with(|c: char| c.is_ascii_digit()) {
        true => format!("§\u{a0}{clause}"),
        false => clause.to_owned(),
    }
}

/// A requirement's row.
fn row(rule: &JudgedRule, display: DisplayUnits) -> Vec<String> {
    let none = || "—".to_owned();
    let mut row = vec![rule.requirement.clone(), place(&rule.clause)];
    row.extend(match &rule.found {
        Err(why) => [none(), none(), none(), format!("not judged: {why}")],
        Ok(compared) => {
            let verdict = match (compared.ok, &rule.condition) {
                (true, _) => "yes",
                (false, None) => "NO",
                (false, Some(_)) => "no: not permitted",
            };
            let side = side(compared.side);
            let side = if side.is_empty() { side } else { format!(" ({side})") };
            [
                shown(compared.demand, rule.unit, display),
                shown(compared.capacity, rule.unit, display),
                format!("{:.3}", compared.ratio),
                format!("{verdict}{side}"),
            ]
        }
    });
    row
}

/// The columns of a list over bounds and directions: their heads, and for each direction whether it has a table or a
/// row of its own.
fn value_rows(of: &Judgement, value: &FoundValue, display: DisplayUnits) -> Vec<Vec<String>> {
    let at = |bound: usize, direction: usize| &value.found[bound * of.directions + direction];
    let bounds = 0..of.bounds.len();
    let differs = of.directions > 1
        && bounds.clone().any(|bound| at(bound, 0).as_ref().ok() != at(bound, 1).as_ref().ok());
    let directions = if differs { 0..of.directions } else { 0..1 };
    let row = |direction: usize| {
        let name = match differs {
            true => format!("{}, {}", value.words, DIRECTIONS[direction]),
            false => value.words.clone(),
        };
        let cells = bounds.clone().map(|bound| match at(bound, direction) {
            Ok(found) => shown(*found, value.unit, display),
            Err(_) => "—".to_owned(),
        });
        [name, place(&value.clause)].into_iter().chain(cells).collect()
    };
    directions.map(row).collect()
}

/// The tables of forces over the height, one a direction where they differ, the roof first.
fn force_tables(of: &Judgement, forces: &LevelForces, display: DisplayUnits) -> Vec<SheetTable> {
    let at = |bound: usize, direction: usize| &forces.found[bound * of.directions + direction];
    let bounds = 0..of.bounds.len();
    let differs = of.directions > 1 && bounds.clone().any(|bound| at(bound, 0) != at(bound, 1));
    let all = forces.found.iter().flatten().flatten();
    let unit = display.unit(Quantity::Force, all.fold(0.0, |most: f64, n| most.max(n.abs())));
    let weight = |n: f64| display.unit(Quantity::Force, n);
    let length = display.unit(Quantity::Length, 10.0);
    let table = |direction: usize| -> Option<SheetTable> {
        let found: Option<Vec<&Vec<f64>>> =
            bounds.clone().map(|bound| at(bound, direction).as_ref().ok()).collect();
        let found = found?;
        let heads = ["Level".to_owned(), "Weight".to_owned(), length.label("Height")];
        let heads = heads.into_iter().chain(of.bounds.iter().map(|bound| (*bound).to_owned()));
        let row = |level: usize| {
            let above = level.checked_sub(1).map(|above| forces.weights_and_heights[above]);
            let weight = above.map_or("—".to_owned(), |[n, _]| {
                format!("{} {}", cell(weight(n).of(n)), weight(n).symbol)
            });
            let height = above.map_or(0.0, |[_, height_m]| length.of(height_m));
            let first = [shortened(&forces.levels[level], 28), weight, compact(height)];
            let cells = found.iter().map(|of_bound| cell(unit.of(of_bound[level])));
            first.into_iter().chain(cells).collect::<Vec<_>>()
        };
        let rows = (0..forces.levels.len()).rev().map(row);
        let along = match differs {
            true => format!(" along {}", DIRECTIONS[direction]),
            false => String::new(),
        };
        let heading = unit.label(&format!("{}{along}, {}", forces.words, forces.clause));
        Some((heading, core::iter::once(heads.collect()).chain(rows).collect()))
    };
    let directions = if differs { 0..of.directions } else { 0..1 };
    directions.filter_map(table).collect()
}

/// A judgement as JSON, of a model.
pub(super) fn json<'a>(model: &'a str, of: &'a Judgement) -> impl Serialize + use<'a> {
    let case = |i: usize| (of.bounds[i / of.directions], DIRECTIONS[i % of.directions]);
    view! {
        model,
        code: &of.title[..],
        edition: &of.edition[..],
        note: &of.note[..],
        verdict: slipstick::assessment::code::verdict(of),
        values: each(&of.values, |value| view! {
            name: &value.name[..],
            words: &value.words[..],
            clause: &value.clause[..],
            unit: value.unit.si_unit(),
            formula: &value.formula[..],
            found: each(value.found.iter().enumerate(), |(i, found)| view! {
                friction: case(i).0,
                direction: case(i).1,
                value: found.as_ref().ok().copied(),
                missing: found.as_ref().err(),
            }),
        }),
        forces: each(&of.forces, |forces| view! {
            words: &forces.words[..],
            clause: &forces.clause[..],
            levels: &forces.levels,
            weights_n: each(&forces.weights_and_heights, |[weight_n, _]| *weight_n),
            heights_m: each(&forces.weights_and_heights, |[_, height_m]| *height_m),
            found: each(forces.found.iter().enumerate(), |(i, found)| view! {
                friction: case(i).0,
                direction: case(i).1,
                forces_n: found.as_ref().ok(),
                missing: found.as_ref().err(),
            }),
        }),
        requirements: each(&of.rules, |rule| {
            let found = rule.found.as_ref().ok();
            view! {
                requirement: &rule.requirement[..],
                clause: &rule.clause[..],
                condition_of: rule.condition.as_deref(),
                formal: rule.formal,
                unit: rule.unit.si_unit(),
                demand_formula: rule.formulas.as_ref().map(|[demand, _]| &demand[..]),
                capacity_formula: rule.formulas.as_ref().map(|[_, capacity]| &capacity[..]),
                demand: found.map(|found| found.demand),
                capacity: found.map(|found| found.capacity),
                ratio: found.map(|found| found.ratio),
                ok: found.map(|found| found.ok),
                friction: found.and_then(|found| found.side.bound),
                direction: found.and_then(|found| found.side.direction),
                not_judged: rule.found.as_ref().err(),
            }
        }),
    }
}

impl HistoriesReport<'_> {
    /// Models with what a code makes of them.
    fn judged(&self) -> impl Iterator<Item = (&str, &Judgement)> {
        let models = self.histories.models.iter().map(|model| &model.name[..]);
        models.zip(self.judgements)
    }

    /// A heading with the name of the model where there are several.
    fn heading(&self, words: String, model: &str) -> String {
        if self.histories.models.len() == 1 { words } else { format!("{words}, {model}") }
    }

    /// Whether the requirements of a code hold, and which governs, a sentence a model.
    pub(super) fn verdicts(&self) -> Vec<(&'static str, String)> {
        let of = |(model, of): (&str, &Judgement)| {
            let verdict = slipstick::assessment::code::verdict(of);
            let of_model = match self.histories.models.len() {
                1 => String::new(),
                _ => format!("{model}: "),
            };
            let at = self.hazard.map_or(String::new(), |hazard| format!("{hazard}: "));
            ("Code", format!("{at}{of_model}{verdict}"))
        };
        self.judged().map(of).collect()
    }

    /// One row a requirement, then the values of the code.
    pub(super) fn judged_tables(&self) -> Vec<SheetTable> {
        let heads = ["Requirement", "Clause", "Demand", "Capacity", "Ratio", "OK"];
        let heads = heads.map(str::to_owned).to_vec();
        let of = |(model, of): (&str, &Judgement)| {
            // At a further intensity a code without a requirement of its own adds nothing.
            if of.rules.is_empty() {
                return Vec::new();
            }
            let rows = of.rules.iter().map(|rule| row(rule, self.display));
            let rows = core::iter::once(heads.clone()).chain(rows).collect();
            let words = format!("Requirements of {}{}", of.title, self.at());
            let mut tables = vec![(self.heading(words, model), rows)];
            let of_bounds = match of.bounds.as_slice() {
                [_] => vec!["Value".to_owned()],
                several => several.iter().map(|bound| (*bound).to_owned()).collect(),
            };
            let mut rows = vec![vec!["Quantity".to_owned(), "Clause".to_owned()]];
            rows[0].extend(of_bounds);
            rows.extend(of.values.iter().flat_map(|value| value_rows(of, value, self.display)));
            let words = format!("Values of {}{}", of.title, self.at());
            tables.push((self.heading(words, model), rows));
            for forces in of.forces.iter().filter(|_| !self.is_further) {
                let all = force_tables(of, forces, self.display);
                tables.extend(
                    all.into_iter().map(|(words, rows)| (self.heading(words, model), rows)),
                );
            }
            tables
        };
        self.judged().flat_map(of).collect()
    }

    /// How each row was computed, for the end of the page.
    pub(super) fn formulas(&self) -> Option<(String, Vec<String>)> {
        let of = self.judgements.first()?;
        let values = of.values.iter().map(|value| {
            format!("{} = {}: {}, {}", value.name, value.formula, value.words, place(&value.clause))
        });
        let forces = of.forces.iter().map(|forces| {
            let [base, level] = &forces.formulas;
            let clause = place(&forces.clause);
            format!("{}, {clause}: at the base level {base}; above it {level}", forces.words)
        });
        let rules = of.rules.iter().filter_map(|rule| {
            let [demand, capacity] = rule.formulas.as_ref()?;
            let clause = place(&rule.clause);
            Some(format!("{demand} ≤ {capacity}: {}, {clause}", rule.requirement))
        });
        let heading = format!("What was computed for {}", of.edition);
        Some((heading, values.chain(forces).chain(rules).collect()))
    }

    /// What a reader must know of how the rules were written down.
    pub(super) fn of_codes(&self) -> Option<String> {
        let of = self.judgements.first()?;
        Some(format!("Rules of {}. {}", of.edition, of.note))
    }

    /// The factor by which the displacement of the runs is raised for torsion, of a model by its place: that of the
    /// code, else that of the plan, where there is one of both.
    pub(super) fn torsion(&self, model: usize) -> Option<f64> {
        let of = self.judgements.get(model);
        let of_code = of.and_then(|of| of.values.iter().find(|value| value.name == "torsion"));
        let of_code = of_code.and_then(|value| value.found.first()?.as_ref().ok().copied());
        of_code.or_else(|| self.plan.map(|plan| plan.total_over_displacement()))
    }
}
