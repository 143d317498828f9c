//! A motion in two horizontal directions: the same figures, from the equations of a plane.
//!
//! Only friction joins x and y: `T = −μ_k(|w|) N w/|w|` in a slip, `|T| ≤ μ_s N` in a stick. From every knot the
//! equations are solved to the next in physical time, whatever variable the solver has used: what is linear by maps,
//! the slider's force by collocation.

mod body;
mod decisions;
mod demands;
mod frame;
mod interval;
mod judge;
mod maps;
mod peaks;
mod step;

use super::ground::Ground;
use super::judge::JudgeInput;
use super::law::Law;
use super::outputs::Outputs;
use super::{Certificate, MAX_RADIANS, unjudged, well_formed};
use crate::error::Stopped;
use crate::model::{Model, Stop};
use crate::motion::GroundMotion;
use crate::progress::{Cancel, Pulse};
use crate::response::{History, HistoryAlongY, Response};
use crate::slider::{Direction, RateLaw};
use frame::{Pair, PlaneFrame, cross, norm, unit};
use judge::PlaneJudge;

/// [`super::check_while`] of a motion that has a component along y.
pub(super) fn check(
    model: &Model,
    (motion, table_y): (&GroundMotion, &[f64]),
    response: &Response,
    go_on: Cancel<'_>,
) -> Result<Certificate, Stopped> {
    let unjudged = || Ok(unjudged(1e-10));
    let (Some(h), Some(plane)) = (response.history.as_ref(), response.in_plane.as_deref()) else {
        return unjudged();
    };
    let Some(along_y) = plane.history.as_ref().filter(|y| is_beside(model, y, h)) else {
        return unjudged();
    };
    if !(is_within(model) && well_formed(model, model.storeys_in_plane(), motion, h)) {
        return unjudged();
    }
    let vertical = motion.vertical_m_per_s2().is_some();
    let end_s = h.time_s.last().copied().unwrap_or(0.0);
    let law = Law::new(model, vertical);
    let normal = Ground::new(model, motion, end_s).largest(end_s).0;
    let frame = PlaneFrame::new(model, vertical, &law, normal);
    let radians = frame.rates[1] * end_s;
    if radians > MAX_RADIANS {
        return unjudged();
    }
    let bound = (100.0 * f64::EPSILON * radians).max(1e-10);
    let widths = [model.block().width_m, model.along_y().width_m];
    let outputs = Outputs::with_moment(model, widths.iter().any(Option::is_some));
    let (law, outputs, pulse) = (&law, &outputs, Pulse::new(go_on));
    let given = JudgeInput { model, motion, response, history: h, law, outputs, pulse };
    let mut judge = PlaneJudge::of_plane(given, (plane, along_y, table_y), &frame);
    if let Some((line, still)) = line_of(model, (motion.horizontal_m_per_s2(), table_y)) {
        (judge.axes.line, judge.axes.still) = (Some(line), still);
    }
    judge.run(bound)?.map_or_else(unjudged, Ok)
}

/// Whether the slider is the same in all directions and nothing else slides or stops.
fn is_within(model: &Model) -> bool {
    let slider = model.slider();
    let same = |pair: [f64; 2]| pair[0] == pair[1];
    same(model.static_friction())
        && same(model.kinetic_friction())
        && slider.rate().is_none_or(fades_alike)
        && slider.series().is_none()
        && model.stop().is_none_or(is_ring)
        && model.contents().is_empty()
}

/// Whether a stop is the same all around.
fn is_ring(stop: &Stop) -> bool {
    let [one, other] = stop.gap_m;
    one == other && one.is_some_and(|gap_m| gap_m > 0.0)
}

/// The direction of the line through rest that all of a motion and of the start is on, where a model with this frame
/// stays on it, and along which axes nothing is, not even rounding.
fn line_of(model: &Model, table: (&[f64], &[f64])) -> Option<(Pair, [bool; 2])> {
    let (x, y) = (model.initial(), model.along_y());
    let (frame, [q, v]) = (
        model.frame(),
        [model.initial_storey_displacement_m(), model.initial_storey_velocity_m_per_s()],
    );
    let along_y = model.turned_to_y();
    let (own_q, own_v) = match model.structure() {
        Some(_) => (Vec::new(), Vec::new()),
        None => {
            (along_y.initial_storey_displacement_m(), along_y.initial_storey_velocity_m_per_s())
        }
    };
    let initial = [x, &y.initial]
        .map(|initial| [[initial.sliding_displacement_m], [initial.sliding_velocity_m_per_s]]);
    let slope = model.slope_in_plane_m_per_s2().map(|pull| [pull]);
    let kinds: [(&[f64], &[f64]); 6] = [
        table,
        (&initial[0][0], &initial[1][0]),
        (&initial[0][1], &initial[1][1]),
        (&q, &own_q),
        (&v, &own_v),
        (&slope[0], &slope[1]),
    ];
    let mut line: Option<Pair> = None;
    for (x, y) in kinds {
        let pairs = || x.iter().zip(y).map(|(x, y)| [*x, *y]);
        let most = pairs().fold([0.0; 2], |most, v| if norm(v) > norm(most) { v } else { most });
        let Some(along) = line.or(unit(most)) else { continue };
        line = Some(along);
        if pairs().any(|v| cross(along, v).abs() > 4.0 * f64::EPSILON * norm(most)) {
            return None;
        }
    }
    let line = line.unwrap_or([1.0, 0.0]);
    let is_axis = line.contains(&0.0);
    let is_alike = model.storeys() == 0
        || (frame.stiffnesses_n_per_m == y.stiffnesses_n_per_m && frame.damping == y.damping);
    let is_zero = |axis: &[f64]| axis.iter().all(|value| *value == 0.0);
    let still = [kinds.iter().all(|(x, _)| is_zero(x)), kinds.iter().all(|(_, y)| is_zero(y))];
    (model.structure().is_none() && (is_axis || is_alike)).then_some((line, still))
}

/// Whether friction by speed is the same both ways.
fn fades_alike(rate: &RateLaw) -> bool {
    let [factor, other] = Direction::BOTH.map(|way| rate.factor(way));
    factor == other
}

/// What is stored along x and along y: at every knot the table's acceleration, `s`, `ṡ`, the block's acceleration
/// and `T`, and of every storey `q`, `q̇` and its acceleration.
type Lists<'a> = [[&'a [f64]; 8]; 2];

fn lists<'a>(h: &'a History, y: &'a HistoryAlongY) -> Lists<'a> {
    [
        [
            &h.table_acceleration_m_per_s2,
            &h.sliding_displacement_m,
            &h.sliding_velocity_m_per_s,
            &h.block_acceleration_m_per_s2,
            &h.friction_force_n,
            &h.storey_displacement_m,
            &h.storey_velocity_m_per_s,
            &h.storey_acceleration_m_per_s2,
        ],
        [
            &y.table_acceleration_m_per_s2,
            &y.sliding_displacement_m,
            &y.sliding_velocity_m_per_s,
            &y.block_acceleration_m_per_s2,
            &y.friction_force_n,
            &y.storey_displacement_m,
            &y.storey_velocity_m_per_s,
            &y.storey_acceleration_m_per_s2,
        ],
    ]
}

/// Whether the part along y has the knots of a history; the oscillators of a structure by its modes are all in the
/// other part.
fn is_beside(model: &Model, y: &HistoryAlongY, h: &History) -> bool {
    let [along_x, along_y] = lists(h, y);
    let by_modes = model.structure().is_some();
    let wanted = |i: usize| if by_modes && i >= 5 { 0 } else { along_x[i].len() };
    along_y.iter().enumerate().all(|(i, list)| list.len() == wanted(i))
}
