//! Peaks and counts in the words of the result.

use super::Plane;
use super::peaks::Peak;
use super::vector::norm;
use crate::model::Model;
use crate::response::{Demands, EventKind, StopDemands};
use crate::solver::course::WalkState;
use crate::solver::summary::of_peaks;

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
    (course, slides): (&WalkState<'_>, bool),
    part: Part,
) -> Demands {
    let (peaks, s) = (&plane.peaks, plane.state.s);
    let width_m = match part {
        Part::Axis(axis) if plane.system.overturning[axis].is_some() => model.block().width_m,
        _ => None,
    };
    let by_part = of_peaks(model, width_m, |output| part.of(peaks.of(output)));
    match part {
        Part::Axis(axis) => Demands {
            peak_sliding_displacement_m: peaks.largest[axis].max(-peaks.smallest[axis]),
            max_sliding_displacement_m: peaks.largest[axis],
            min_sliding_displacement_m: peaks.smallest[axis],
            residual_sliding_displacement_m: s[axis],
            ..by_part
        },
        Part::Resultant => {
            let (events, sliding) = (&course.events, &course.block.sliding);
            let count = |kind| events.iter().filter(|event| event.kind == kind).count() as u64;
            let peak_force_n = plane.peak_stop_n;
            let impact_count = count(EventKind::Impact);
            let stop = StopDemands { peak_force_n, impact_count, ..course.slider.stopping.demands };
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
                stop: plane.system.ring.map(|_| stop),
                gap_ratio: model.slider().gap_m().map(|gap_m| peak_m / gap_m),
                overturning_ratio: plane.system.per_resisted.map(|_| peaks.overturning_ratio()),
                ..by_part
            }
        }
    }
}
