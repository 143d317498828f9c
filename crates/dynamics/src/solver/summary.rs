//! Peaks and counts in the words of the result, and what the reader must be told.

use super::course::Sliding;
use crate::model::Model;
use crate::notice::{Notice, NoticeKind};
use crate::response::output::Output;
use crate::response::{Demands, Event, EventKind, StopDemands, StoreyDemands, SurfaceDemands};
use crate::slider::Direction;

/// What an analysis leaves behind besides its peaks.
pub(super) struct Outcome {
    pub(super) events: Vec<Event>,
    pub(super) overturns: bool,
    pub(super) sliding: Sliding,
    pub(super) stop: Option<StopDemands>,
    pub(super) surfaces: Vec<SurfaceDemands>,
    pub(super) residual_m: f64,
    pub(super) sliding_at_end: bool,
    pub(super) first_impact_s: Option<f64>,
}

/// What the peaks of outputs say, `width_m` where the overturning moment is one; the rest is left out.
pub(super) fn of_peaks(
    model: &Model,
    width_m: Option<f64>,
    peak: impl Fn(Output) -> f64,
) -> Demands {
    let (weight_n, has_masses) = (model.weight_n(), model.has_point_masses());
    let of_point = |i: usize| {
        let peak_drift_m = peak(Output::Drift(i));
        StoreyDemands {
            peak_acceleration_m_per_s2: peak(Output::Acceleration(i)),
            peak_displacement_m: peak(Output::Displacement(i)),
            peak_drift_m,
            peak_drift_ratio: model.rise_m(i).map(|rise_m| peak_drift_m / rise_m),
            peak_drift_velocity_m_per_s: peak(Output::DriftVelocity(i)),
            peak_shear_n: has_masses.then(|| peak(Output::StoreyShear(i))),
        }
    };
    let points = (0..model.points()).map(of_point).collect();
    let (storeys, points) = match model.structure() {
        Some(_) => (Vec::new(), points),
        None => (points, Vec::new()),
    };
    // Modes along y alone are no storeys along x.
    let is_rigid = model.storeys().max(model.storeys_in_plane()) == 0;
    let shear_n = if is_rigid { 0.0 } else { peak(Output::BaseShear) };
    let [friction_n, slider_n] = [Output::FrictionForce, Output::SliderForce].map(&peak);
    Demands {
        storeys,
        points,
        peak_sliding_velocity_m_per_s: peak(Output::Velocity),
        peak_block_acceleration_m_per_s2: peak(Output::Block),
        peak_base_shear_n: shear_n,
        peak_friction_force_n: friction_n,
        peak_slider_force_n: slider_n,
        base_shear_coefficient: shear_n / weight_n,
        friction_coefficient_used: friction_n / weight_n,
        slider_force_coefficient: slider_n / weight_n,
        overturning_ratio: width_m
            .map(|width_m| peak(Output::Overturning) / (0.5 * width_m * weight_n)),
        ..Demands::default()
    }
}

/// What the response asks of the structure.
pub(super) fn demands(model: &Model, outcome: &Outcome, peak: impl Fn(Output) -> f64) -> Demands {
    let [mut slip_count, mut reversal_count, mut stick_count] = [0; 3];
    for event in outcome.events.iter().filter(|e| e.interface == 0) {
        slip_count += u64::from(event.kind == EventKind::Slip);
        reversal_count += u64::from(event.kind == EventKind::Reversal);
        stick_count += u64::from(event.kind == EventKind::Stick);
    }
    let sliding = &outcome.sliding;
    let peak_sliding_displacement_m = sliding.max_m.max(-sliding.min_m);
    Demands {
        peak_sliding_displacement_m,
        peak_sliding_displacement_time_s: sliding.peak_time_s,
        max_sliding_displacement_m: sliding.max_m,
        min_sliding_displacement_m: sliding.min_m,
        residual_sliding_displacement_m: outcome.residual_m,
        sliding_at_end: outcome.sliding_at_end,
        sliding_path_m: sliding.path_m,
        sliding_time_s: sliding.time_s,
        slip_count,
        reversal_count,
        stick_count,
        closest_stop: Some(sliding.closest_stop).filter(|margin| margin.is_finite()),
        gap_ratio: model.slider().gap_m().map(|gap_m| peak_sliding_displacement_m / gap_m),
        stop: outcome.stop,
        surfaces: outcome.surfaces.clone(),
        ..of_peaks(model, model.block().width_m.filter(|_| outcome.overturns), peak)
    }
}

/// That impulses are in no peak.
pub(super) fn impulses_excluded(time_s: f64) -> Notice {
    Notice::new(
        NoticeKind::ImpulsesExcluded,
        "the block strikes a rigid stop: peak accelerations and forces are those of the motion between impacts, \
         without the impulses",
    )
    .at(time_s)
}

/// What follows from model and events alone.
pub(super) fn warnings(
    model: &Model,
    events: &[Event],
    contact_loss_s: &[[f64; 2]],
) -> Vec<Notice> {
    let mut warnings = Vec::new();
    let first = events.iter().find(|e| e.interface == 0);
    if let Some(start) = first.filter(|e| e.time_s == 0.0 && e.kind == EventKind::Slip) {
        warnings.push(
            Notice::new(
                NoticeKind::SlipsAtStart,
                "friction cannot hold the block at t = 0: it slips at once",
            )
            .at(start.time_s),
        );
    }
    let tilt_rad = model.slider().tilt_rad;
    let downhill = if tilt_rad > 0.0 { Direction::Negative } else { Direction::Positive };
    let kinetic = downhill.of(model.kinetic_friction());
    let steepness = model.slider().steepness();
    if steepness > kinetic && model.slider_stiffness_n_per_m() == 0.0 {
        warnings.push(Notice::new(
            NoticeKind::SlideNeedNotStop,
            format!(
                "the slope {steepness:.4} is above the kinetic friction {kinetic} downhill and no \
                 spring holds the block: a slide need not stop",
            ),
        ));
    }
    if let (Some([from_s, _]), Some([_, to_s])) = (contact_loss_s.first(), contact_loss_s.last()) {
        let message = format!(
            "contact is lost {} times between {from_s:.4} s and {to_s:.4} s: friction is zero \
             there, and what the model says of that time is void",
            contact_loss_s.len()
        );
        warnings.push(Notice::new(NoticeKind::ContactLost, message).at(*from_s));
    }
    warnings
}
