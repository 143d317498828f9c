//! The keys of the `--json` object, which are a promise to other programs.

use slipstick::assessment::single::FloorSpectra;
use slipstick::assessment::suite::Recorded;
use slipstick::motion::Figures;
use slipstick::notice::Notice;
use slipstick::response::{
    DEMANDS, Demand, DemandColumn, DemandKind, DemandOf, Demands, InDirections,
};

use slipstick::input::Names;
use slipstick::record::Origin;
use slipstick::study::{Certified, Worst};

use super::{Checks, Summary, method_name};
use crate::json::Json;

/// The object; `x`, `y`, `stop`, `surfaces`, `contents`, `iterations`, `floor_spectrum` and `bounds` only where there are any.
pub fn object(summary: &Summary) -> Json {
    let mut keys = vec![
        ("slipstick", summary.slipstick.into()),
        ("model", summary.model.as_str().into()),
        ("model_hash", summary.model_hash.as_deref().map_or(Json::Null, Json::from)),
        ("method", method_name(summary.method).into()),
        ("samples", (summary.samples as u64).into()),
        ("dt_s", summary.dt_s.into()),
        ("duration_s", summary.duration_s.into()),
        ("friction_factor", summary.friction_factor.into()),
        ("record", record(summary)),
    ];
    let by_axis = summary.by_axis.as_ref();
    let absent = by_axis.map(|_| InDirections::Axis);
    keys.extend(demands(&summary.demands, &summary.names, |demand| {
        Some(demand.in_directions) != absent
    }));
    if let Some(by_axis) = by_axis {
        let direction = by_axis.peak_sliding_displacement_direction_rad;
        keys.push(("peak_sliding_displacement_direction_rad", direction.into()));
        keys.push(("least_sliding_speed_m_per_s", by_axis.least_sliding_speed_m_per_s.into()));
        for (i, axis) in ["x", "y"].into_iter().enumerate() {
            let figures = figure_keys(&by_axis.record[i]).into();
            let mut object = vec![("record", Json::Object(figures))];
            object.extend(axis_demands(&by_axis.demands[i], &summary.names));
            keys.push((axis, Json::Object(object)));
        }
    }
    keys.extend([
        (
            "contact_loss_s",
            Json::List(
                summary
                    .contact_loss_s
                    .iter()
                    .map(|&[from, to]| Json::List(vec![from.into(), to.into()]))
                    .collect(),
            ),
        ),
        ("warnings", listed(&summary.warnings, false)),
        ("notes", listed(&summary.warnings, true)),
        ("checks", checks(&summary.checks)),
    ]);
    if let Some(iterations) = summary.iterations {
        let max = u64::from(iterations.max);
        keys.push((
            "iterations",
            Json::Object(vec![("mean", iterations.mean.into()), ("max", max.into())]),
        ));
    }
    if let Some(spectra) = &summary.floor_spectra {
        keys.push(("floor_spectrum", floor_spectrum(spectra)));
    }
    if let Some(bounds) = &summary.bounds {
        keys.push((
            "bounds",
            Json::Object(vec![("lower", object(&bounds.lower)), ("upper", object(&bounds.upper))]),
        ));
    }
    Json::Object(keys)
}

fn record(summary: &Summary) -> Json {
    let Summary { record: figures, origin, record_factor, .. } = summary;
    let mut keys = origin_keys(origin);
    keys.push(("factor", (*record_factor).into()));
    keys.extend(figure_keys(figures));
    Json::Object(keys)
}

fn figure_keys(figures: &Figures) -> [(&'static str, Json); 4] {
    [
        ("pga_m_per_s2", figures.pga_m_per_s2.into()),
        ("pgv_m_per_s", figures.pgv_m_per_s.into()),
        ("pgd_m", figures.pgd_m.into()),
        ("end_velocity_m_per_s", figures.end_velocity_m_per_s.into()),
    ]
}

/// What a file says of where it was recorded.
fn origin_keys(origin: &Origin) -> Vec<(&'static str, Json)> {
    let text = |text: &Option<String>| text.as_deref().map_or(Json::Null, Json::from);
    let mut keys = vec![
        ("event", text(&origin.event)),
        ("station", text(&origin.station)),
        ("component", text(&origin.component)),
        ("azimuth_deg", origin.azimuth_deg.into()),
    ];
    if let Some(y) = &origin.along_y {
        keys.push(("component_y", text(&y.component)));
        keys.push(("azimuth_y_deg", y.azimuth_deg.into()));
    }
    keys
}

/// How many runs of an answer were certified, and which of them was the worst.
pub(crate) fn certified_keys(certified: &Certified) -> Json {
    let refused = certified.unconfirmed.iter().map(|refused| {
        Json::Object(vec![
            ("run", refused.run.as_str().into()),
            ("what", refused.what.as_str().into()),
        ])
    });
    Json::Object(vec![
        ("runs", certified.runs.into()),
        ("certified", certified.certified.into()),
        ("worst", certified.worst.as_ref().map_or(Json::Null, worst_keys)),
        ("unconfirmed", Json::List(refused.collect())),
    ])
}

/// The worst of certified runs: what it is called, the figure or demand, and its size.
#[must_use]
pub fn worst_keys(worst: &Worst) -> Json {
    Json::Object(vec![
        ("run", worst.run.as_str().into()),
        ("what", worst.what.as_str().into()),
        ("error", worst.error.into()),
    ])
}

/// The records that an answer is of, each with what its file says and what reading it gave notice of.
pub(crate) fn suite(records: &[Recorded]) -> Json {
    let one = |on: &Recorded| {
        let mut keys = vec![("record", on.name.as_str().into())];
        keys.extend(origin_keys(&on.origin));
        keys.extend([
            ("scale", on.factor.into()),
            ("pga_m_per_s2", on.pga_m_per_s2.into()),
            ("notices", Json::List(on.notices.iter().map(warning).collect())),
        ]);
        Json::Object(keys)
    };
    Json::List(records.iter().map(one).collect())
}

fn floor_spectrum(spectra: &FloorSpectra) -> Json {
    let list = |values: &[f64]| Json::List(values.iter().map(|&value| value.into()).collect());
    Json::Object(vec![
        ("damping_ratio", spectra.damping_ratio.into()),
        ("period_s", list(&spectra.periods_s)),
        ("table_acceleration_m_per_s2", list(&spectra.table_m_per_s2)),
        ("block_acceleration_m_per_s2", list(&spectra.block_m_per_s2)),
        (
            "storeys_acceleration_m_per_s2",
            Json::List(spectra.storeys_m_per_s2.iter().map(|floor| list(floor)).collect()),
        ),
    ])
}

/// Those of an axis, without what is of neither.
fn axis_demands(demands: &Demands, names: &Names) -> Vec<(&'static str, Json)> {
    let all = self::demands(demands, names, |_| true);
    let of_resultant = |key: &str| {
        let of = |demand: &&Demand| demand.key == key && demand.of == DemandOf::Run;
        let demand = DEMANDS.iter().find(of);
        demand.is_some_and(|demand| demand.in_directions == InDirections::Resultant)
    };
    all.into_iter().filter(|(key, _)| !of_resultant(key)).collect()
}

/// The demands in the order of the registry; `block.x` is `x` in the object `block`. Block and storeys
/// have their names, where the model gives them; what has no value here is null.
fn demands(
    demands: &Demands,
    names: &Names,
    has_value: impl Fn(&Demand) -> bool,
) -> Vec<(&'static str, Json)> {
    let name = |name: &Option<String>| name.as_ref().map(|name| ("name", name.as_str().into()));
    let json = |column: DemandColumn| {
        let value = column.value(demands).filter(|_| has_value(column.demand));
        json(column.demand.kind, value)
    };
    let of_part = |of: DemandOf, part: usize| {
        let own = DEMANDS.iter().filter(|demand| demand.of == of);
        let own = own.map(|demand| (demand.key, json(DemandColumn { demand, part })));
        let storey = names.storeys.get(part - 1).filter(|_| of == DemandOf::Storey);
        let point = names.points.get(part - 1).filter(|_| of == DemandOf::Point);
        let named = storey.and_then(name).or(point.map(|point| ("name", point.as_str().into())));
        Json::Object(named.into_iter().chain(own).collect())
    };
    let mut keys: Vec<(&'static str, Json)> = Vec::new();
    for demand in DEMANDS.iter().filter(|demand| demand.in_summary) {
        if let Some(list) = demand.of.list() {
            let count = match demand.of {
                DemandOf::Surface => demands.surfaces.len(),
                DemandOf::Contents => demands.contents.len(),
                DemandOf::Point => demands.points.len(),
                _ => demands.storeys.len(),
            };
            // Only storeys are listed where there are none.
            let wanted = count > 0 || demand.of == DemandOf::Storey;
            if wanted && !keys.iter().any(|(key, _)| *key == list) {
                let parts = (1..=count).map(|part| of_part(demand.of, part));
                keys.push((list, Json::List(parts.collect())));
            }
            continue;
        }
        if demand.of == DemandOf::Stop && demands.stop.is_none() {
            continue;
        }
        let value = json(DemandColumn { demand, part: 0 });
        match (demand.key.split_once('.'), keys.last_mut()) {
            (None, _) => keys.push((demand.key, value)),
            (Some((group, key)), Some((last, Json::Object(members)))) if *last == group => {
                members.push((key, value));
            }
            (Some((group, key)), _) => {
                let named = if group == "block" { name(&names.block) } else { None };
                keys.push((group, Json::Object(named.into_iter().chain([(key, value)]).collect())));
            }
        }
    }
    keys
}

fn json(kind: DemandKind, value: Option<f64>) -> Json {
    match (kind, value) {
        (DemandKind::Count, Some(value)) => Json::Count(value as u64),
        (DemandKind::Flag, Some(value)) => Json::Bool(value != 0.0),
        (_, value) => value.into(),
    }
}

/// The warnings among some, or the notes.
pub(crate) fn listed(all: &[Notice], notes: bool) -> Json {
    Json::List(all.iter().filter(|warning| warning.is_note() == notes).map(warning).collect())
}

fn warning(warning: &Notice) -> Json {
    Json::Object(vec![
        ("kind", warning.kind.name().into()),
        ("severity", warning.severity().name().into()),
        ("time_s", warning.time_s.into()),
        ("message", warning.message.as_str().into()),
    ])
}

fn checks(checks: &Checks) -> Json {
    let closest = checks.closest_call.map_or(Json::Null, |call| {
        Json::Object(vec![
            ("margin", call.margin.into()),
            ("time_s", call.time_s.into()),
            ("kind", call.kind.name().into()),
            ("interface", Json::Text(call.interface_name())),
        ])
    });
    Json::Object(vec![
        ("equilibrium_residual", checks.equilibrium_residual.into()),
        ("friction_excess", checks.friction_excess.into()),
        ("energy_balance_error", checks.energy_balance_error.into()),
        ("demands_error", checks.demands_error.into()),
        ("closest_call", closest),
        ("bound", checks.bound.into()),
        ("holds", checks.holds.map_or(Json::Null, Json::Bool)),
    ])
}
