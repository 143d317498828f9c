//! Answers to requests, laid out, and their tables.

use slipstick::assessment::histories::{ChosenHistory, Histories};
use slipstick::notice::Notice;
use slipstick::requests::{Answer, Curves, Results};
use slipstick::response::Response;
use slipstick::table::{Column, Table};

use super::design::DesignReport;
use super::fragility::{FragilityFamily, FragilityReport};
use super::histories::HistoriesReport;
use super::ida::IdaFamily;
use super::sensitivity::SensitivityReport;
use super::sheet::Sheet;
use super::spectrum::SpectrumReport;
use crate::display::DisplayUnits;

/// A table of an answer.
#[derive(Clone, Debug)]
pub struct Tabled {
    /// Its name.
    pub name: &'static str,
    /// The endings of the files that hold it.
    pub forms: &'static [&'static str],
    /// Its columns.
    pub table: Table,
}

/// An answer laid out.
#[must_use]
pub fn sheet(answer: &Answer, display: DisplayUnits) -> Sheet {
    let Answer { name, model_hash, records, scaled, warnings, title, found } = answer;
    let names: Vec<String> = records.iter().map(|record| record.name.clone()).collect();
    let sheet = match found {
        Results::Suite { histories, hazard, factors, plan, judgements, others } => {
            let (hazard, factors, plan) = (hazard.as_deref(), *factors, *plan);
            let mut sheet = HistoriesReport {
                histories,
                scaled,
                hazard,
                factors,
                plan,
                judgements,
                others,
                is_further: false,
                display,
            }
            .sheet();
            // What was noticed of the request; of its records the histories know more.
            let told =
                |notice: &&Notice| !sheet.warnings.iter().any(|known| known.kind == notice.kind);
            let more: Vec<Notice> = warnings.iter().filter(told).cloned().collect();
            sheet.warnings.extend(more);
            sheet
        }
        Results::Spectrum(run) => {
            let records = &names;
            SpectrumReport { name, records, scaled, run, warnings, display }.sheet()
        }
        Results::Sensitivity(run) => {
            SensitivityReport { name, scaled, run, warnings, display }.sheet()
        }
        Results::Ida { measure, demand, limit, fixed_levels, run } => IdaFamily {
            name,
            measure,
            demand,
            limit: *limit,
            fixed_levels: *fixed_levels,
            run,
            warnings,
            display,
        }
        .sheet(),
        Results::Design { target, acceleration, bounds, confidence, run } => DesignReport {
            name,
            records: records.len(),
            scaled,
            target: *target,
            run,
            acceleration,
            bounds: *bounds,
            confidence: *confidence,
            warnings,
            display,
        }
        .sheet(),
        Results::Fragility { demand, limit, confidence, curves, .. } => {
            let mut sheet = match fragility(name, demand, *limit, *confidence, curves, display) {
                Fragility::One(report) => report.sheet(),
                Fragility::By(family) => family.sheet(),
            };
            sheet.warnings.extend(warnings.iter().cloned());
            sheet
        }
    };
    // A suite's own records have the factors of its runs.
    let suite = if sheet.suite.is_empty() { records.clone() } else { sheet.suite };
    let (model_hash, title) = (model_hash.clone(), title.clone());
    let sheet = Sheet { model_hash, suite, title, ..sheet };
    let mut sheet = sheet.certified(found.certified());
    Notice::sort(&mut sheet.warnings);
    sheet
}

/// What the table of runs is that a fragility was fitted to, as the list of files read gives it.
#[must_use]
pub fn kind_of_runs(answer: &Answer) -> &'static str {
    match &answer.found {
        Results::Fragility { curves: Curves::One(run), .. } => run.kind.name(),
        _ => "runs",
    }
}

/// The histories that a suite was asked for, each by the name of its file: record, model and bound where there are
/// several.
#[must_use]
pub fn histories(answer: &mut Answer) -> Vec<(String, Response)> {
    let Results::Suite { histories, .. } = &mut answer.found else { return Vec::new() };
    let chosen = core::mem::take(&mut histories.chosen);
    let models = &histories.models;
    let mut named: Vec<(String, Response)> = Vec::new();
    for ChosenHistory { model, record, bound, response } in chosen {
        let of = &models[model];
        let mut name = of.records[record].record.clone();
        if models.len() > 1 {
            name = format!("{name}-{}", of.name);
        }
        if of.bounds.len() > 1 {
            name = format!("{name}-{}", of.bounds[bound].name);
        }
        let plain = |c: char| if c.is_alphanumeric() || "-_.+".contains(c) { c } else { '_' };
        let name: String = name.chars().map(plain).collect();
        let is_taken = |name: &str| named.iter().any(|(known, _)| known == name);
        let first = format!("history-{name}.csv");
        let numbered = (2..).map(|i| format!("history-{name}-{i}.csv"));
        let mut free = core::iter::once(first).chain(numbered).filter(|name| !is_taken(name));
        let name = free.next().unwrap_or_default();
        named.push((name, response));
    }
    named
}

/// The tables of an answer, its own first.
#[must_use]
pub fn tables(answer: Answer) -> Vec<Tabled> {
    const BOTH: &[&str] = &["csv", "parquet"];
    let tabled = |name, forms, table| Tabled { name, forms, table };
    match answer.found {
        Results::Suite { histories, hazard, others, .. } => {
            let others = others.into_iter().map(|at| (at.name, at.histories));
            let first = (hazard.unwrap_or_default(), histories);
            let all: Vec<(String, Histories)> = core::iter::once(first).chain(others).collect();
            let of = |name, forms, table: fn(&Histories) -> Option<&Table>| {
                let tables = all.iter().filter_map(|(hazard, of)| Some((&hazard[..], table(of)?)));
                at_each(tables.collect()).map(|table| tabled(name, forms, table))
            };
            let tables = [
                of("runs", &BOTH[..1], |of| Some(&of.runs)),
                of("governing", &BOTH[..1], |of| Some(&of.governing)),
                of("profiles", &BOTH[..1], |of| of.profiles.as_ref()),
                of("floor-spectra", BOTH, |of| of.floor_spectra.as_ref()),
            ];
            tables.into_iter().flatten().collect()
        }
        Results::Spectrum(run) => {
            vec![tabled("spectrum", BOTH, run.table), tabled("runs", &BOTH[1..], run.rows)]
        }
        Results::Sensitivity(run) => vec![tabled("sensitivity", BOTH, run.table)],
        Results::Ida { run, .. } => {
            let capacities = run.capacities.map(|table| tabled("capacities", &BOTH[..1], table));
            core::iter::once(tabled("ida", BOTH, run.rows)).chain(capacities).collect()
        }
        Results::Design { run, .. } => {
            vec![tabled("front", BOTH, run.front), tabled("runs", &BOTH[1..], run.runs)]
        }
        Results::Fragility { demand, limit, confidence, curves, .. } => {
            let display = DisplayUnits::Si;
            let of = fragility(&answer.name, &demand, limit, confidence, &curves, display);
            let table = match of {
                Fragility::One(report) => report.table(),
                Fragility::By(family) => family.table(),
            };
            vec![tabled("fragility", BOTH, table)]
        }
    }
}

/// Tables of the same columns under each other, of several intensities each row with the name of its own; none of none.
fn at_each(tables: Vec<(&str, &Table)>) -> Option<Table> {
    let several = tables.len() > 1;
    let mut all: Option<Table> = None;
    for (hazard, table) in tables {
        let mut table = table.clone();
        if several {
            let names = vec![hazard.to_owned(); table.rows()];
            table.columns.insert(0, Column::texts("hazard", names));
        }
        match &mut all {
            None => all = Some(table),
            Some(all) => {
                for (column, more) in all.columns.iter_mut().zip(table.columns) {
                    // Of the same models on the same records all columns are of the same kinds.
                    let _ = column.cells.append(more.cells);
                }
            }
        }
    }
    all
}

/// What a fragility is told from.
enum Fragility<'a> {
    One(FragilityReport<'a>),
    By(FragilityFamily<'a>),
}

/// The report of a fragility.
fn fragility<'a>(
    name: &'a str,
    demand: &'a str,
    limit: Option<f64>,
    confidence: f64,
    curves: &'a Curves,
    display: DisplayUnits,
) -> Fragility<'a> {
    match curves {
        Curves::One(run) => {
            Fragility::One(FragilityReport { name, demand, limit, run, confidence, display })
        }
        Curves::By { path: by, unit: by_unit, groups } => Fragility::By(FragilityFamily {
            name,
            by,
            by_unit,
            groups,
            demand,
            limit,
            confidence,
            display,
        }),
    }
}
