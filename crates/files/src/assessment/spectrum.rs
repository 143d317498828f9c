//! Runs of sliding spectra and frequency response curves.

use slipstick::assessment::fractile::fractiles;
use slipstick::assessment::spectrum::{fixed_base, intervals_above, without_vertical};
use slipstick::input::Parts;
use slipstick::model::Model;
use slipstick::motion::GroundMotion;
use slipstick::solver;
use slipstick_report::assessment::spectrum::Curves;
use slipstick_report::number::compact;

use super::models::{demands, motion_of, roof_acceleration};
use super::suite::{Scaling, Suite};
use super::table::Table;
use super::{AssessmentError, Models, refuse, threads};

/// A spectrum to be run: the last path of the models' grid runs along the axis, those before it make
/// groups of curves.
#[derive(Clone, Copy, Debug)]
pub struct SpectrumRequest<'a> {
    /// The models.
    pub models: &'a Models,
    /// The records.
    pub suite: &'a Suite,
    /// How they are scaled.
    pub scaling: Scaling,
    /// Keys of demands besides those that are always told.
    pub demands: &'a [String],
}

/// What came of it.
#[derive(Clone, Debug)]
pub struct SpectrumRun {
    /// The path along the axis.
    pub over: String,
    /// Its SI unit.
    pub unit: String,
    /// Its values.
    pub values: Vec<f64>,
    /// Names of the groups.
    pub groups: Vec<String>,
    /// Fractiles of each demand.
    pub curves: Vec<Curves>,
    /// Intervals in which the median amplification of each group is above 1.
    pub windows: Vec<Vec<[f64; 2]>>,
    /// The key whose intervals they are.
    pub window_key: String,
    /// Messages of failed runs.
    pub failures: Vec<String>,
    /// Number of runs, those of the fixed-base models apart.
    pub runs: usize,
    /// Fractiles, a row a value and group.
    pub table: Table,
    /// Demands, a row a run.
    pub rows: Table,
}

/// Demands that are always told, besides those of the roof.
const TOLD: [&str; 3] =
    ["peak_sliding_displacement_m", "residual_sliding_displacement_m", "sliding_path_m"];

/// One run: demands, and the peaks of the roof on a fixed base and of the table in m/s².
struct Run {
    demands: Vec<f64>,
    fixed: f64,
    table: f64,
}

/// Runs a spectrum.
///
/// # Errors
/// [`AssessmentError`] for an axis that does not rise, a demand that is none, and scaling without an
/// answer. A run that fails is counted as above all.
pub fn run_spectrum(request: &SpectrumRequest) -> Result<SpectrumRun, AssessmentError> {
    let SpectrumRequest { models, suite, .. } = *request;
    let grid = models.grid();
    let Some((axis, groups_of)) = grid.axes().split_last() else {
        return Err(refuse("--over", "PATH=VALUES", "nothing"));
    };
    if !axis.rises() {
        let found = "values that do not rise";
        return Err(refuse(&format!("--over {}", axis.path), "values that rise", found));
    }
    let roof = models.roof_acceleration();
    let mut keys: Vec<String> = TOLD.iter().map(|key| (*key).to_owned()).collect();
    keys.push(roof.clone());
    keys.extend(request.demands.iter().filter(|key| !TOLD.contains(&key.as_str())).cloned());
    keys.dedup();
    let columns = keys.iter().map(|key| models.column(key)).collect::<Result<Vec<_>, _>>()?;
    let factors = suite.factors(&request.scaling)?;
    let records = suite.records.len();
    let parts = models.all(records)?;
    let runs = run_all(&parts, suite, &factors, models.storeys() > 0);

    let stem = roof
        .trim_end_matches("_peak_acceleration_m_per_s2")
        .trim_end_matches(".peak_acceleration_m_per_s2");
    let ratio_keys = if models.storeys() > 0 {
        vec![format!("{stem}_fixed_base_ratio"), format!("{stem}_amplification")]
    } else {
        vec![format!("{stem}_amplification")]
    };
    let roof_column = models.column(&roof)?;
    let nothing = f64::NAN;
    let value = |run: &Result<Run, String>, key: usize| -> f64 {
        let Ok(run) = run else { return nothing };
        if let Some(&column) = columns.get(key) {
            let value = run.demands[column];
            return if keys[key] == TOLD[1] { value.abs() } else { value };
        }
        let roof = run.demands[roof_column];
        let over =
            if ratio_keys[key - columns.len()].ends_with("ratio") { run.fixed } else { run.table };
        // 0/0: nothing moves, and nothing is amplified.
        if roof == 0.0 && over == 0.0 { 0.0 } else { roof / over }
    };
    let all_keys: Vec<String> = keys.iter().chain(&ratio_keys).cloned().collect();
    let (length, group_count) = (axis.values.len(), grid.len() / axis.values.len());
    let at = |group: usize, i: usize| (group * length + i) * records;
    let curves: Vec<Curves> = all_keys
        .iter()
        .enumerate()
        .map(|(k, key)| {
            let of = |group: usize, i: usize| {
                let from = at(group, i);
                fractiles(
                    &runs[from..from + records].iter().map(|run| value(run, k)).collect::<Vec<_>>(),
                )
            };
            let of_group = |group: usize| (0..length).map(|i| of(group, i)).collect();
            Curves { key: key.clone(), fractiles: (0..group_count).map(of_group).collect() }
        })
        .collect();
    let groups: Vec<String> = (0..group_count)
        .map(|group| {
            let values = grid.values(group * length);
            let name = |(axis, value): (&super::axis::Axis, &f64)| {
                format!("{} {} {}", short(&axis.path), compact(*value), axis.unit)
                    .trim_end()
                    .to_owned()
            };
            groups_of.iter().zip(&values).map(name).collect::<Vec<_>>().join(", ")
        })
        .collect();
    let window = curves.last().map_or(&[][..], |curves| &curves.fractiles[..]);
    let windows = window
        .iter()
        .map(|group| {
            let median: Vec<f64> = group.iter().map(|f| f[1]).collect();
            intervals_above(&axis.values, &median, 1.0)
        })
        .collect();
    let failures = runs
        .iter()
        .enumerate()
        .filter_map(|(i, run)| {
            let message = run.as_ref().err()?;
            Some(format!("{}: {message}", suite.records[i % records].name))
        })
        .collect();

    let mut table = Table::default();
    let coordinates = |table: &mut Table, repeat: usize| {
        for (i, axis) in grid.axes().iter().enumerate() {
            let of = |n: usize| grid.values(n / repeat)[i];
            let cells = (0..grid.len() * repeat).map(of).collect();
            table.numbers(&axis.path, &axis.unit, cells);
        }
    };
    coordinates(&mut table, 1);
    let unit = |key: &str| {
        let columns = models.columns();
        columns.iter().find(|column| column.name == key).map_or("", |column| column.unit)
    };
    for of_key in &curves {
        for (i, share) in ["p16", "p50", "p84"].into_iter().enumerate() {
            let cells = of_key.fractiles.iter().flatten().map(|f| f[i]).collect();
            table.numbers(&format!("{}_{share}", of_key.key), unit(&of_key.key), cells);
        }
    }
    let mut rows = Table::default();
    rows.texts(
        "record",
        (0..runs.len()).map(|i| suite.records[i % records].name.clone()).collect(),
    );
    rows.numbers("scale", "", (0..runs.len()).map(|i| factors[i % records]).collect());
    coordinates(&mut rows, records);
    for (i, column) in models.columns().iter().enumerate() {
        let of = |run: &Result<Run, String>| run.as_ref().map_or(f64::NAN, |run| run.demands[i]);
        rows.numbers(&column.name, column.unit, runs.iter().map(of).collect());
    }
    for (k, key) in ratio_keys.iter().enumerate() {
        rows.numbers(key, "", runs.iter().map(|run| value(run, columns.len() + k)).collect());
    }
    rows.texts(
        "status",
        runs.iter().map(|run| run.as_ref().err().cloned().unwrap_or("ok".to_owned())).collect(),
    );
    Ok(SpectrumRun {
        over: axis.path.clone(),
        unit: axis.unit.clone(),
        values: axis.values.clone(),
        groups,
        window_key: all_keys.last().cloned().unwrap_or_default(),
        curves,
        windows,
        failures,
        runs: runs.len(),
        table,
        rows,
    })
}

/// The last word of a path that says enough in a legend.
fn short(path: &str) -> String {
    path.rsplit('.').next().unwrap_or(path).replace('_', " ")
}

fn run_all(
    parts: &[Result<Parts, String>],
    suite: &Suite,
    factors: &[f64],
    with_fixed_base: bool,
) -> Vec<Result<Run, String>> {
    let records = suite.records.len();
    // One structure on a fixed base serves all designs that share it.
    let mut structures: Vec<Model> = Vec::new();
    let mut of_design: Vec<Option<usize>> = Vec::with_capacity(parts.len());
    const LOOKED_BACK: usize = 256;
    for parts in parts {
        let Some(model) = parts.as_ref().ok().filter(|_| with_fixed_base) else {
            of_design.push(None);
            continue;
        };
        let Ok(held) = fixed_base(&model.model) else {
            of_design.push(None);
            continue;
        };
        let from = structures.len().saturating_sub(LOOKED_BACK);
        let known = structures[from..].iter().position(|other| same_structure(other, &held));
        of_design.push(Some(known.map_or(structures.len(), |i| from + i)));
        if known.is_none() {
            structures.push(held);
        }
    }
    // A made motion may differ from design to design, and with it the table's part of the ratio.
    let shared_motion = !suite.made;
    let held = |structure: &Model, motion: &GroundMotion| -> Result<f64, String> {
        let along = without_vertical(motion).map_err(|error| error.to_string())?;
        let response =
            solver::exact_demands(structure, &along).map_err(|error| error.to_string())?;
        Ok(roof_acceleration(&response.demands))
    };
    let tail_s =
        parts.iter().find_map(|parts| parts.as_ref().ok()).map_or(0.0, |parts| parts.tail_s);
    let fixed: Vec<f64> = if shared_motion {
        threads::map(structures.len() * records, |i| {
            let motion = suite.motion(i % records, factors[i % records], tail_s);
            motion.ok().and_then(|m| held(&structures[i / records], &m).ok()).unwrap_or(f64::NAN)
        })
    } else {
        Vec::new()
    };
    let motions: Vec<Result<GroundMotion, String>> = if shared_motion {
        threads::map(records, |i| suite.motion(i, factors[i], tail_s).map_err(|e| e.to_string()))
    } else {
        Vec::new()
    };
    threads::map(parts.len() * records, |i| {
        let (design, record) = (i / records, i % records);
        let parts = parts[design].as_ref().map_err(Clone::clone)?;
        let own;
        let motion = if shared_motion && parts.tail_s == tail_s {
            motions[record].as_ref().map_err(Clone::clone)?
        } else {
            own = motion_of(suite, record, factors[record], parts)?;
            &own
        };
        let demands = demands(&parts.model, motion)?;
        let fixed = match of_design[design] {
            None => f64::NAN,
            Some(structure) if shared_motion => fixed[structure * records + record],
            Some(structure) => held(&structures[structure], motion)?,
        };
        let table = motion.horizontal_m_per_s2().iter().fold(0.0, |peak: f64, a| peak.max(a.abs()));
        Ok(Run { demands, fixed, table })
    })
}

/// Whether two models on a fixed base answer alike: all but the block and its slider is the same.
fn same_structure(a: &Model, b: &Model) -> bool {
    a.frame() == b.frame()
        && a.gravity_m_per_s2() == b.gravity_m_per_s2()
        && a.slider().tilt_rad == b.slider().tilt_rad
        && a.initial() == b.initial()
}
