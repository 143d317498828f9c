//! A motion along one of the axes: judged as one in one direction.

use super::super::structure::larger;
use super::super::{Certificate, check_while};
use super::frame::Pair;
use super::lists;
use crate::error::Stopped;
use crate::model::{InitialState, Model};
use crate::motion::GroundMotion;
use crate::progress::GoOn;
use crate::response::{
    Demands, EventKind, History, HistoryAlongY, InPlane, Mode, Response, StoreyDemands,
};
use crate::slider::Direction;

/// Along which axis all of a motion and of the initial state is, if it is along one.
pub(super) fn only_axis(model: &Model, motion: &GroundMotion) -> Option<usize> {
    // Modes may move along both axes whatever the table does.
    if model.structure().is_some() {
        return None;
    }
    let stands = |initial: &InitialState, table: &[f64]| {
        let storeys = [&initial.storey_displacement_m, &initial.storey_velocity_m_per_s];
        let block = [initial.sliding_displacement_m, initial.sliding_velocity_m_per_s];
        let storeys = storeys.into_iter().flatten().flatten();
        storeys.chain(table).chain(&block).all(|value| *value == 0.0)
    };
    let along_y = motion.horizontal_y_m_per_s2().unwrap_or_default();
    match [
        stands(&model.along_y().initial, along_y),
        stands(model.initial(), motion.horizontal_m_per_s2()),
    ] {
        [true, _] => Some(0),
        [_, true] => Some(1),
        _ => None,
    }
}

/// [`super::check`] of a motion along an axis: by the judge of one direction, and by what does not move.
pub(super) fn check(
    model: &Model,
    motion: &GroundMotion,
    (response, plane, h, y): (&Response, &InPlane, &History, &HistoryAlongY),
    axis: usize,
    go_on: GoOn<'_>,
) -> Result<Certificate, Stopped> {
    let history = if axis == 0 { h.clone() } else { along_y(response, plane, h, y) };
    let lists = lists(h, y);
    let mut own = Response { history: Some(history.clone()), in_plane: None, ..response.clone() };
    let (model, motion) = if axis == 0 {
        (model.clone(), motion.along_x())
    } else {
        own.demands = plane.axes[1].clone();
        for (event, in_plane) in own.events.iter_mut().zip(&plane.events) {
            event.sliding_displacement_m = in_plane.sliding_displacement_y_m;
            event.mode = signed(event.mode, in_plane.direction[1]);
        }
        (model.turned_to_y(), motion.along_y())
    };
    let mut certificate = check_while(&model, &motion, &own, go_on)?;
    // What stands still is 0.
    for (still, moves) in lists[1 - axis].into_iter().zip(lists[axis]) {
        let most = |list: &[f64]| list.iter().fold(0.0, |most, value| larger(most, *value));
        let off = most(still);
        if off > 0.0 {
            let figure = &mut certificate.equilibrium_residual;
            *figure = larger(*figure, off / most(moves));
        }
    }
    if !is_placed(&own, response, plane, &history, axis) {
        certificate.demands_error = larger(certificate.demands_error, 1.0);
    }
    Ok(certificate)
}

/// Whether the results of the one direction stand at the root and at its axis, and nothing at the other.
fn is_placed(
    own: &Response,
    response: &Response,
    plane: &InPlane,
    h: &History,
    axis: usize,
) -> bool {
    let none = Demands {
        storeys: vec![StoreyDemands::default(); own.demands.storeys.len()],
        ..Demands::default()
    };
    let mut root = own.demands.clone();
    if axis == 1 {
        root.overturning_ratio = None;
        (root.max_sliding_displacement_m, root.min_sliding_displacement_m) = (0.0, 0.0);
    }
    let along = |sign: f64| -> Pair { if axis == 0 { [sign, 0.0] } else { [0.0, sign] } };
    let events = own.events.iter().zip(&plane.events).all(|(event, placed)| {
        let y_m = if axis == 0 { 0.0 } else { event.sliding_displacement_m };
        placed.direction == along(event.mode.sign()) && placed.sliding_displacement_y_m == y_m
    });
    let at_s = own.demands.peak_sliding_displacement_time_s;
    let peak_m = own.demands.peak_sliding_displacement_m;
    let knots = h.time_s.iter().zip(&h.sliding_displacement_m);
    let at_peak = knots.filter(|(t, _)| **t == at_s).map(|(_, s)| *s);
    let toward = |s: f64| {
        let [x, y] = along(s.signum());
        libm::atan2(y, x) == plane.peak_sliding_displacement_direction_rad
    };
    root == response.demands
        && plane.axes[axis] == own.demands
        && plane.axes[1 - axis] == none
        && plane.least_sliding_speed_m_per_s.is_none()
        && plane.events.len() == own.events.len()
        && events
        && (peak_m == 0.0 || at_peak.into_iter().any(toward))
}

/// The mode of a slip in a direction along its axis.
fn signed(mode: Mode, sign: f64) -> Mode {
    match mode {
        Mode::Stick => Mode::Stick,
        Mode::Slip(_) if sign < 0.0 => Mode::Slip(Direction::Negative),
        Mode::Slip(_) => Mode::Slip(Direction::Positive),
    }
}

/// The history along y as that of one direction: slips have the signs that the events give them.
fn along_y(response: &Response, plane: &InPlane, h: &History, y: &HistoryAlongY) -> History {
    let mut events = response.events.iter().zip(&plane.events).peekable();
    let mut sign = y.sliding_velocity_m_per_s[0];
    let mut mode = Vec::with_capacity(h.len());
    for k in 0..h.len() {
        let before = k.checked_sub(1).map(|last| h.mode[last]);
        let changes = before.is_none_or(|before| before != h.mode[k]);
        let abreast = k > 0 && h.time_s[k - 1] == h.time_s[k];
        let next = events.next_if(|(event, _)| {
            let turns = abreast && event.kind == EventKind::Reversal;
            event.time_s == h.time_s[k] && (changes || turns)
        });
        if let Some((_, placed)) = next {
            sign = placed.direction[1];
        }
        mode.push(signed(h.mode[k], sign));
    }
    History {
        mode,
        table_acceleration_m_per_s2: y.table_acceleration_m_per_s2.clone(),
        sliding_displacement_m: y.sliding_displacement_m.clone(),
        sliding_velocity_m_per_s: y.sliding_velocity_m_per_s.clone(),
        block_acceleration_m_per_s2: y.block_acceleration_m_per_s2.clone(),
        friction_force_n: y.friction_force_n.clone(),
        storey_displacement_m: y.storey_displacement_m.clone(),
        storey_velocity_m_per_s: y.storey_velocity_m_per_s.clone(),
        storey_acceleration_m_per_s2: y.storey_acceleration_m_per_s2.clone(),
        ..h.clone()
    }
}
