//! The keys of the `--json` object, which are a promise to other programs.

use slipstick::motion::Figures;
use slipstick::response::{StoreyDemands, Warning};

use super::{Checks, Summary, method_name};
use crate::json::Json;
use crate::report::FloorSpectra;

/// The object; `iterations`, `floor_spectrum` and `bounds` only where there are any.
pub fn object(summary: &Summary) -> Json {
    let d = &summary.demands;
    let mut keys = vec![
        ("slipstick", summary.slipstick.into()),
        ("model", summary.model.as_str().into()),
        ("method", method_name(summary.method).into()),
        ("samples", (summary.samples as u64).into()),
        ("dt_s", summary.dt_s.into()),
        ("duration_s", summary.duration_s.into()),
        ("friction_factor", summary.friction_factor.into()),
        ("record", record(&summary.record)),
        ("peak_sliding_displacement_m", d.peak_sliding_displacement_m.into()),
        ("peak_sliding_displacement_time_s", d.peak_sliding_displacement_time_s.into()),
        ("max_sliding_displacement_m", d.max_sliding_displacement_m.into()),
        ("min_sliding_displacement_m", d.min_sliding_displacement_m.into()),
        ("residual_sliding_displacement_m", d.residual_sliding_displacement_m.into()),
        ("sliding_at_end", d.sliding_at_end.into()),
        ("sliding_path_m", d.sliding_path_m.into()),
        ("peak_sliding_velocity_m_per_s", d.peak_sliding_velocity_m_per_s.into()),
        ("sliding_time_s", d.sliding_time_s.into()),
        ("slip_count", d.slip_count.into()),
        ("reversal_count", d.reversal_count.into()),
        ("stick_count", d.stick_count.into()),
        (
            "block",
            Json::Object(vec![(
                "peak_acceleration_m_per_s2",
                d.peak_block_acceleration_m_per_s2.into(),
            )]),
        ),
        ("storeys", Json::List(d.storeys.iter().map(storey).collect())),
        ("peak_base_shear_n", d.peak_base_shear_n.into()),
        ("peak_friction_force_n", d.peak_friction_force_n.into()),
        ("peak_slider_force_n", d.peak_slider_force_n.into()),
        ("base_shear_coefficient", d.base_shear_coefficient.into()),
        ("friction_coefficient_used", d.friction_coefficient_used.into()),
        ("slider_force_coefficient", d.slider_force_coefficient.into()),
        ("gap_ratio", d.gap_ratio.into()),
        ("overturning_ratio", d.overturning_ratio.into()),
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
        ("warnings", Json::List(summary.warnings.iter().map(warning).collect())),
        ("checks", checks(&summary.checks)),
    ];
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

fn record(figures: &Figures) -> Json {
    Json::Object(vec![
        ("pga_m_per_s2", figures.pga_m_per_s2.into()),
        ("pgv_m_per_s", figures.pgv_m_per_s.into()),
        ("pgd_m", figures.pgd_m.into()),
        ("end_velocity_m_per_s", figures.end_velocity_m_per_s.into()),
    ])
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

fn storey(demands: &StoreyDemands) -> Json {
    Json::Object(vec![
        ("peak_acceleration_m_per_s2", demands.peak_acceleration_m_per_s2.into()),
        ("peak_displacement_m", demands.peak_displacement_m.into()),
        ("peak_drift_m", demands.peak_drift_m.into()),
        ("peak_drift_ratio", demands.peak_drift_ratio.into()),
    ])
}

fn warning(warning: &Warning) -> Json {
    Json::Object(vec![
        ("kind", warning.kind.into()),
        ("time_s", warning.time_s.into()),
        ("message", warning.message.as_str().into()),
    ])
}

fn checks(checks: &Checks) -> Json {
    let closest = checks.closest_call.map_or(Json::Null, |call| {
        Json::Object(vec![
            ("margin", call.margin.into()),
            ("time_s", call.time_s.into()),
            ("kind", call.kind.into()),
        ])
    });
    Json::Object(vec![
        ("equilibrium_residual", checks.equilibrium_residual.into()),
        ("friction_excess", checks.friction_excess.into()),
        ("energy_balance_error", checks.energy_balance_error.into()),
        ("closest_call", closest),
        ("bound", checks.bound.into()),
        ("holds", checks.holds.map_or(Json::Null, Json::Bool)),
    ])
}
