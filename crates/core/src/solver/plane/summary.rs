//! Peaks and counts in the words of the result.

use super::Plane;
use super::peaks::{Output, Peak};
use super::system::norm;
use crate::model::Model;
use crate::response::{Demands, Event, EventKind, StoreyDemands};
use crate::solver::course::Sliding;

/// What a peak is of: the resultant, or an axis.
#[derive(Clone, Copy)]
pub(super) enum Part {
    Resultant,
    Axis(usize),
}

impl Part {
    fn of(self, peak: Peak) -> f64 {
        match self {
            Self::Resultant => peak.norm,
            Self::Axis(axis) => peak.axes[axis],
        }
    }
}

/// What the response asks of the structure, as resultants or along an axis, whose width is that of the model.
pub(super) fn demands(
    model: &Model,
    plane: &Plane<'_>,
    (events, sliding, slides): (&[Event], &Sliding, bool),
    part: Part,
) -> Demands {
    let (n, weight_n, peaks) = (model.points(), model.weight_n(), &plane.peaks);
    let peak = |output: Output| part.of(peaks.of(output));
    let storeys = (0..n).map(|i| {
        let displacement = peak(Output::Displacement(i));
        let drift = if i == 0 { displacement } else { peak(Output::Drift(i)) };
        StoreyDemands {
            peak_acceleration_m_per_s2: peak(Output::Acceleration(i)),
            peak_displacement_m: displacement,
            peak_drift_m: drift,
            peak_drift_ratio: model.rise_m(i).map(|rise_m| drift / rise_m),
        }
    });
    let (storeys, points) = match model.structure() {
        Some(_) => (Vec::new(), storeys.collect()),
        None => (storeys.collect(), Vec::new()),
    };
    let [shear_n, friction_n, slider_n] =
        [Output::Shear, Output::FrictionForce, Output::SliderForce].map(peak);
    let s = plane.state.s;
    let by_part = Demands {
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
        ..Demands::default()
    };
    match part {
        Part::Axis(axis) => Demands {
            peak_sliding_displacement_m: peaks.largest[axis].max(-peaks.smallest[axis]),
            max_sliding_displacement_m: peaks.largest[axis],
            min_sliding_displacement_m: peaks.smallest[axis],
            residual_sliding_displacement_m: s[axis],
            overturning_ratio: model
                .block()
                .width_m
                .filter(|_| plane.system.overturning[axis].is_some())
                .map(|width_m| peak(Output::Moment) / (0.5 * width_m * weight_n)),
            ..by_part
        },
        Part::Resultant => {
            let count = |kind| events.iter().filter(|event| event.kind == kind).count() as u64;
            let peak_m = peaks.sliding.norm;
            Demands {
                peak_sliding_displacement_m: peak_m,
                peak_sliding_displacement_time_s: peaks.peak_time_s,
                max_sliding_displacement_m: peaks.largest[0],
                min_sliding_displacement_m: peaks.smallest[0],
                residual_sliding_displacement_m: norm(s),
                sliding_at_end: slides,
                sliding_path_m: plane.path_m,
                sliding_time_s: sliding.time_s,
                slip_count: count(EventKind::Slip),
                stick_count: count(EventKind::Stick),
                closest_stop: Some(sliding.closest_stop).filter(|margin| margin.is_finite()),
                gap_ratio: model.slider().gap_m().map(|gap_m| peak_m / gap_m),
                ..by_part
            }
        }
    }
}
