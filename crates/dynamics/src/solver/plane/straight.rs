//! An analysis in two horizontal directions: by the solver in one where nothing moves along the other.

use super::summary::{Part, demands};
use super::system::{State, System, along_y, norm};
use super::{Plane, SLIP};
use crate::error::SolveError;
use crate::model::Model;
use crate::motion::GroundMotion;
use crate::numerics::InstructionSet;
use crate::progress::Pulse;
use crate::response::{
    Demands, EventInPlane, History, HistoryAlongY, InPlane, Method, PointFactorsInPlane, Response,
    StoreyDemands,
};
use crate::solver::course::Course;
use crate::solver::ground::{Ground, contact_loss_s};
use crate::solver::slider::SliderState;
use crate::solver::summary;
use crate::solver::walk::Walk;

/// Along which axis all of a motion and of the initial state is, if it is along one. The modes of a structure may
/// move along both axes whatever the table does.
pub(in crate::solver) fn only_axis(model: &Model, motion: &GroundMotion) -> Option<usize> {
    if model.structure().is_some() {
        return None;
    }
    let turned = along_y(model);
    let stands = |model: &Model, table: &[f64]| {
        let initial = model.initial();
        let storeys = [&initial.storey_displacement_m, &initial.storey_velocity_m_per_s];
        initial.sliding_displacement_m == 0.0
            && initial.sliding_velocity_m_per_s == 0.0
            && storeys.into_iter().flatten().flatten().chain(table).all(|x| *x == 0.0)
    };
    let y = motion.horizontal_y_m_per_s2().unwrap_or_default();
    if stands(&turned, y) {
        Some(0)
    } else if stands(model, motion.horizontal_m_per_s2()) {
        Some(1)
    } else {
        None
    }
}

/// Model and motion along one axis as such of one direction.
pub(in crate::solver) fn along(
    model: &Model,
    motion: &GroundMotion,
    axis: usize,
) -> (Model, GroundMotion) {
    if axis == 0 { (model.clone(), motion.along_x()) } else { (along_y(model), motion.along_y()) }
}

/// A response in one direction as one in two.
pub(in crate::solver) fn placed(mut response: Response, axis: usize) -> Response {
    let demands = &mut response.demands;
    let none = Demands {
        storeys: vec![StoreyDemands::default(); demands.storeys.len()],
        ..Demands::default()
    };
    let sign = if demands.max_sliding_displacement_m >= -demands.min_sliding_displacement_m {
        1.0
    } else {
        -1.0
    };
    let [x, y] = if axis == 0 { [sign, 0.0] } else { [0.0, sign] };
    let events = response.events.iter().map(|event| {
        let sign = event.mode.sign();
        let direction = if axis == 0 { [sign, 0.0] } else { [0.0, sign] };
        let sliding_displacement_y_m = if axis == 0 { 0.0 } else { event.sliding_displacement_m };
        EventInPlane { direction, sliding_displacement_y_m }
    });
    let mut in_plane = InPlane {
        axes: [demands.clone(), none],
        peak_sliding_displacement_direction_rad: libm::atan2(y, x),
        least_sliding_speed_m_per_s: None,
        events: events.collect(),
        history: None,
    };
    let mut moved = response.history.as_ref().map(moving_part);
    let mut still = moved.as_ref().map(still_part);
    if axis == 1 {
        in_plane.axes.swap(0, 1);
        demands.overturning_ratio = None;
        (demands.max_sliding_displacement_m, demands.min_sliding_displacement_m) = (0.0, 0.0);
        for event in &mut response.events {
            event.sliding_displacement_m = 0.0;
        }
        core::mem::swap(&mut moved, &mut still);
    }
    if let (Some(history), Some(x), Some(y)) = (&mut response.history, moved, still) {
        put_along_x(history, x);
        in_plane.history = Some(y);
    }
    // In two directions a slip is positive along its own velocity.
    let along_itself = |mode: &mut crate::response::Mode| {
        if mode.sign() != 0.0 {
            *mode = SLIP;
        }
    };
    if axis == 1 {
        response.events.iter_mut().for_each(|event| along_itself(&mut event.mode));
        response.history.iter_mut().flat_map(|h| &mut h.mode).for_each(along_itself);
    }
    Response { in_plane: Some(Box::new(in_plane)), ..response }
}

/// What of a history is along its direction.
fn moving_part(history: &History) -> HistoryAlongY {
    HistoryAlongY {
        table_acceleration_m_per_s2: history.table_acceleration_m_per_s2.clone(),
        sliding_displacement_m: history.sliding_displacement_m.clone(),
        sliding_velocity_m_per_s: history.sliding_velocity_m_per_s.clone(),
        block_acceleration_m_per_s2: history.block_acceleration_m_per_s2.clone(),
        friction_force_n: history.friction_force_n.clone(),
        storey_displacement_m: history.storey_displacement_m.clone(),
        storey_velocity_m_per_s: history.storey_velocity_m_per_s.clone(),
        storey_acceleration_m_per_s2: history.storey_acceleration_m_per_s2.clone(),
        points: None,
    }
}

/// The same of a direction in which nothing moves.
fn still_part(moved: &HistoryAlongY) -> HistoryAlongY {
    let none = |list: &Vec<f64>| vec![0.0; list.len()];
    HistoryAlongY {
        table_acceleration_m_per_s2: none(&moved.table_acceleration_m_per_s2),
        sliding_displacement_m: none(&moved.sliding_displacement_m),
        sliding_velocity_m_per_s: none(&moved.sliding_velocity_m_per_s),
        block_acceleration_m_per_s2: none(&moved.block_acceleration_m_per_s2),
        friction_force_n: none(&moved.friction_force_n),
        storey_displacement_m: none(&moved.storey_displacement_m),
        storey_velocity_m_per_s: none(&moved.storey_velocity_m_per_s),
        storey_acceleration_m_per_s2: none(&moved.storey_acceleration_m_per_s2),
        points: None,
    }
}

fn put_along_x(history: &mut History, x: HistoryAlongY) {
    history.table_acceleration_m_per_s2 = x.table_acceleration_m_per_s2;
    history.sliding_displacement_m = x.sliding_displacement_m;
    history.sliding_velocity_m_per_s = x.sliding_velocity_m_per_s;
    history.block_acceleration_m_per_s2 = x.block_acceleration_m_per_s2;
    history.friction_force_n = x.friction_force_n;
    history.storey_displacement_m = x.storey_displacement_m;
    history.storey_velocity_m_per_s = x.storey_velocity_m_per_s;
    history.storey_acceleration_m_per_s2 = x.storey_acceleration_m_per_s2;
}

/// Solves a model under a motion that is along no axis.
pub(in crate::solver) fn solve(
    (model, system): (&Model, System),
    (ground, table_y): (Ground<'_>, &[f64]),
    instructions: InstructionSet,
    (with_history, pulse): (bool, Pulse<'_>),
) -> Result<Response, SolveError> {
    let state = State::initial(&system, model);
    let law = model.law(false);
    let (s, speed) = (state.s[0], norm(state.w));
    let units = 64 * (1 + system.modes()) as u32;
    let phase = Plane::new((system, state), (ground, table_y), instructions, with_history);
    let course =
        Course::new(SliderState::new(&law, s, speed), [s, speed], (Vec::new(), Vec::new()));
    let mut walk = Walk::new((phase, course), (ground, [0.0, model.normal_n()]), (pulse, units));
    walk.go()?;
    let Walk { phase, course, .. } = walk;
    let contact_loss_s = contact_loss_s(ground.times_s, ground.normal);
    let of = |model: &Model, part: Part| {
        let slides = course.block.mode == SLIP;
        demands(model, &phase, (&course.events, &course.block.sliding, slides), part)
    };
    let [x, y] = phase.peaks.peak_place;
    let mut in_plane = InPlane {
        axes: [of(model, Part::Axis(0)), of(&along_y(model), Part::Axis(1))],
        peak_sliding_displacement_direction_rad: libm::atan2(y, x),
        least_sliding_speed_m_per_s: phase.least.speed,
        events: Vec::new(),
        history: None,
    };
    let demands = of(model, Part::Resultant);
    let history = phase.recorder.map(|recorder| {
        let points = PointFactorsInPlane::of(model);
        in_plane.history = Some(HistoryAlongY { points, ..recorder.along_y });
        recorder.along_x
    });
    in_plane.events = phase.events;
    Ok(Response {
        method: Method::Exact,
        demands,
        warnings: summary::warnings(model, &course.events, &contact_loss_s),
        events: course.events,
        history,
        contact_loss_s,
        iterations: None,
        in_plane: Some(Box::new(in_plane)),
    })
}
