//! An analysis in two horizontal directions: by the solver in one where all of it is along one line.
//!
//! Friction, springs and dampers of the slider know no direction. So a motion whose components are proportional is one
//! along a line, where the frame is the same along x and y or the line is an axis: it is solved as such, and the answer
//! turned.

use super::speed::Least;
use super::summary::{Part, demands};
use super::system::{State, System, along_y};
use super::vector::{cross, inner, norm};
use super::{Plane, SLIP};
use crate::error::SolveError;
use crate::model::{Model, OscillatorInPlane};
use crate::motion::GroundMotion;
use crate::numerics::InstructionSet;
use crate::progress::Pulse;
use crate::response::{
    Contact, Demands, EventInPlane, EventKind, History, HistoryAlongY, InPlane, Method, Mode,
    PointFactorsInPlane, Response, StoreyDemands,
};
use crate::slider::Ring;
use crate::solver::course::WalkState;
use crate::solver::ground::{Ground, GroundAlongY, Stretch, contact_loss_s};
use crate::solver::slider::SliderState;
use crate::solver::summary;
use crate::solver::walk::Walk;

/// Part of the largest of some vectors by which one may be off the line of all and be on it: rounding.
const OFF: f64 = 8.0 * f64::EPSILON;

/// What is on a line where all is: the table, `s`, `w`, displacements and velocities of storeys, the slope.
const KINDS: usize = 6;

/// The direction of all of a motion and of the initial state, if they have one, and the model along it as one of one
/// direction, if that is what it is.
pub(in crate::solver) fn on_line(
    model: &Model,
    motion: &GroundMotion,
) -> Option<([f64; 2], Model)> {
    let turned = along_y(model);
    let slope = model.slope_in_plane_m_per_s2();
    let of = |axis: usize| -> [Vec<f64>; KINDS] {
        let model = [model, &turned][axis];
        let initial = model.initial();
        let table = match axis {
            0 => motion.horizontal_m_per_s2().to_vec(),
            _ => motion.horizontal_y_m_per_s2().unwrap_or_default().to_vec(),
        };
        let storeys = || match model.structure() {
            Some(_) => [Vec::new(), Vec::new()],
            None => {
                [model.initial_storey_displacement_m(), model.initial_storey_velocity_m_per_s()]
            }
        };
        let [q, v] = storeys();
        let start = [initial.sliding_displacement_m, initial.sliding_velocity_m_per_s];
        let [s, w] = start.map(|value| vec![value]);
        [table, s, w, q, v, vec![slope[axis]]]
    };
    let [x, y] = [of(0), of(1)];
    let is_still = |axis: &[Vec<f64>; KINDS]| axis.iter().flatten().all(|value| *value == 0.0);
    let direction = match [is_still(&x), is_still(&y)] {
        [_, true] => [1.0, 0.0],
        [true, _] => [0.0, 1.0],
        _ => common_direction(&x, &y)?,
    };
    Some((direction, model.turned_to(direction)?))
}

/// The direction of vectors of several kinds, if it is one: each kind is compared with its largest.
fn common_direction(x: &[Vec<f64>; KINDS], y: &[Vec<f64>; KINDS]) -> Option<[f64; 2]> {
    let largest = |i: usize| {
        let vectors = x[i].iter().zip(&y[i]).map(|(x, y)| [*x, *y]);
        vectors.fold([0.0; 2], |most, vector| if norm(vector) > norm(most) { vector } else { most })
    };
    let first = (0..KINDS).map(largest).find(|vector| *vector != [0.0; 2])?;
    let size = norm(first).copysign(if first[0] == 0.0 { first[1] } else { first[0] });
    let along = first.map(|value| value / size);
    let is_on_it = |i: usize| {
        let most = OFF * norm(largest(i));
        x[i].iter().zip(&y[i]).all(|(x, y)| cross(along, [*x, *y]).abs() <= most)
    };
    (0..KINDS).all(is_on_it).then_some(along)
}

/// A response in one direction, with its history.
pub(in crate::solver) struct OnLine<'a> {
    pub(in crate::solver) direction: [f64; 2],
    /// The model in two directions and along the line.
    pub(in crate::solver) model: &'a Model,
    pub(in crate::solver) line: &'a Model,
    /// System and ground in two directions.
    pub(in crate::solver) system: System,
    pub(in crate::solver) ground: Ground<'a>,
    pub(in crate::solver) along_y: GroundAlongY<'a>,
    pub(in crate::solver) instructions: InstructionSet,
}

impl OnLine<'_> {
    /// The response as one in two directions, with its history where that is asked for.
    pub(in crate::solver) fn turned(self, mut response: Response, with_history: bool) -> Response {
        let [x, y] = self.direction;
        let reverses = response.demands.reversal_count > 0;
        response.events.retain(|event| event.kind != EventKind::Reversal);
        let events = response.events.iter().map(|event| EventInPlane {
            direction: [x, y].map(|part| part * event.mode.sign() + 0.0),
            sliding_displacement_y_m: y * event.sliding_displacement_m + 0.0,
        });
        let own = &response.demands;
        // Between two walls a block goes as far both ways.
        let at_peak = response.history.as_ref().and_then(|h| {
            let k = h.time_s.iter().position(|t| *t == own.peak_sliding_displacement_time_s)?;
            Some(h.sliding_displacement_m[k]).filter(|s| *s != 0.0)
        });
        let farthest = own.max_sliding_displacement_m + own.min_sliding_displacement_m;
        let sign = if farthest == 0.0 { at_peak.unwrap_or(1.0) } else { farthest }.signum();
        let mut in_plane = InPlane {
            axes: [0, 1].map(|axis| self.along_axis(own, axis)),
            peak_sliding_displacement_direction_rad: libm::atan2(sign * y, sign * x),
            least_sliding_speed_m_per_s: None,
            events: events.collect(),
            history: None,
        };
        let overturning = in_plane.axes.each_ref().map(|axis| axis.overturning_ratio);
        let mut demands = Demands {
            max_sliding_displacement_m: in_plane.axes[0].max_sliding_displacement_m,
            min_sliding_displacement_m: in_plane.axes[0].min_sliding_displacement_m,
            residual_sliding_displacement_m: own.residual_sliding_displacement_m.abs(),
            reversal_count: 0,
            overturning_ratio: self
                .system
                .per_resisted
                .and_then(|_| overturning.into_iter().try_fold(0.0, |sum, of| Some(sum + of?))),
            ..own.clone()
        };
        for event in &mut response.events {
            event.sliding_displacement_m = x * event.sliding_displacement_m + 0.0;
            event.mode = in_two_directions(event.mode);
        }
        if let Some(history) = response.history.take() {
            if with_history {
                let mut turned = history.clone();
                in_plane.history = Some(self.turn_history(&mut turned));
                response.history = Some(turned);
            }
            if reverses {
                // A block that turns about has passed rest; what its friction was then asked for decided nothing.
                in_plane.least_sliding_speed_m_per_s = Some(0.0);
                demands.closest_stop = self.closest_stop(&history);
            } else {
                in_plane.least_sliding_speed_m_per_s = self.least_speed(&history);
            }
        }
        Response { demands, in_plane: Some(Box::new(in_plane)), ..response }
    }

    /// What the response asks along an axis.
    fn along_axis(&self, d: &Demands, axis: usize) -> Demands {
        let part = self.direction[axis];
        let size = |value: f64| part.abs() * value;
        let signed = |value: f64| part * value + 0.0;
        let ends_m = [d.max_sliding_displacement_m, d.min_sliding_displacement_m].map(signed);
        let width_m = match axis {
            0 => self.model.block().width_m,
            _ => self.model.along_y().width_m,
        };
        let of_line_m = self.line.block().width_m;
        let over = |ratio: f64| Some(size(ratio) * (of_line_m? / width_m?));
        let of_storey = |storey: &StoreyDemands| StoreyDemands {
            peak_acceleration_m_per_s2: size(storey.peak_acceleration_m_per_s2),
            peak_displacement_m: size(storey.peak_displacement_m),
            peak_drift_m: size(storey.peak_drift_m),
            peak_drift_ratio: storey.peak_drift_ratio.map(size),
            peak_drift_velocity_m_per_s: size(storey.peak_drift_velocity_m_per_s),
            peak_shear_n: storey.peak_shear_n.map(size),
        };
        Demands {
            peak_sliding_displacement_m: size(d.peak_sliding_displacement_m),
            max_sliding_displacement_m: ends_m[0].max(ends_m[1]),
            min_sliding_displacement_m: ends_m[0].min(ends_m[1]),
            residual_sliding_displacement_m: signed(d.residual_sliding_displacement_m),
            peak_sliding_velocity_m_per_s: size(d.peak_sliding_velocity_m_per_s),
            peak_block_acceleration_m_per_s2: size(d.peak_block_acceleration_m_per_s2),
            storeys: d.storeys.iter().map(of_storey).collect(),
            points: d.points.iter().map(of_storey).collect(),
            peak_base_shear_n: size(d.peak_base_shear_n),
            peak_friction_force_n: size(d.peak_friction_force_n),
            peak_slider_force_n: size(d.peak_slider_force_n),
            base_shear_coefficient: size(d.base_shear_coefficient),
            friction_coefficient_used: size(d.friction_coefficient_used),
            slider_force_coefficient: size(d.slider_force_coefficient),
            overturning_ratio: d.overturning_ratio.and_then(over),
            ..Demands::default()
        }
    }

    /// What of the storeys of the line at a knot is along x and along y; of a structure by its modes what its oscillators
    /// do, which have directions of their own, in the second list.
    fn storeys(&self, of_line: &[f64]) -> [Vec<f64>; 2] {
        let Some(structure) = self.model.structure() else {
            return self.direction.map(|part| of_line.iter().map(|q| part * q + 0.0).collect());
        };
        let modes = structure.oscillators_in_plane();
        let of_mode = |mode: &OscillatorInPlane| {
            // Modes of one frequency and damping are one along the line.
            let joined = self.line.structure().and_then(|line| {
                line.modes.iter().position(|own| {
                    own.frequency_rad_per_s == mode.frequency_rad_per_s
                        && own.damping_ratio == mode.damping_ratio
                })
            });
            joined.map_or(0.0, |i| inner(mode.direction, self.direction) * of_line[i] + 0.0)
        };
        [Vec::new(), modes.iter().map(of_mode).collect()]
    }

    /// Turns a history to the direction: what is along x, and the oscillators of modes, stay in it, and what is along y
    /// is returned.
    fn turn_history(&self, h: &mut History) -> HistoryAlongY {
        h.mode.iter_mut().for_each(|mode| *mode = in_two_directions(*mode));
        h.contact.iter_mut().for_each(|contact| *contact = in_plane_contact(*contact));
        if self.system.ring.is_some() {
            h.contact.resize(h.time_s.len(), Contact::Free);
        }
        let [x, y] = self.direction;
        let part = |list: &mut Vec<f64>| {
            let along_y = list.iter().map(|value| y * value + 0.0).collect();
            list.iter_mut().for_each(|value| *value = x * *value + 0.0);
            along_y
        };
        let by_modes = self.model.structure().is_some();
        let of_storeys = |list: &mut Vec<f64>, storeys: usize| {
            let knots = list.chunks_exact(storeys.max(1)).map(|knot| self.storeys(knot));
            let (along_x, along_y): (Vec<_>, Vec<_>) = knots.map(|[x, y]| (x, y)).unzip();
            *list = if by_modes { along_y.concat() } else { along_x.concat() };
            if by_modes { Vec::new() } else { along_y.concat() }
        };
        let storeys = h.storeys;
        let turned = HistoryAlongY {
            table_acceleration_m_per_s2: part(&mut h.table_acceleration_m_per_s2),
            sliding_displacement_m: part(&mut h.sliding_displacement_m),
            sliding_velocity_m_per_s: part(&mut h.sliding_velocity_m_per_s),
            block_acceleration_m_per_s2: part(&mut h.block_acceleration_m_per_s2),
            friction_force_n: part(&mut h.friction_force_n),
            storey_displacement_m: of_storeys(&mut h.storey_displacement_m, storeys),
            storey_velocity_m_per_s: of_storeys(&mut h.storey_velocity_m_per_s, storeys),
            storey_acceleration_m_per_s2: of_storeys(&mut h.storey_acceleration_m_per_s2, storeys),
            points: PointFactorsInPlane::of(self.model),
        };
        (h.storeys, h.points) = (self.model.storeys_in_plane(), None);
        turned
    }

    /// The interval in which the motion goes on from a time, and the time in it.
    fn place(&self, interval: &mut usize, time_s: f64) -> f64 {
        let times_s = self.ground.times_s;
        while *interval + 2 < times_s.len() && times_s[*interval + 1] <= time_s {
            *interval += 1;
        }
        time_s - times_s[*interval]
    }

    /// The least margin of the decisions at stops.
    fn closest_stop(&self, h: &History) -> Option<f64> {
        let (mut interval, mut closest) = (0, None);
        // What comes to rest at a rigid stop does so by what it strikes.
        let strikes = |k: usize| {
            h.time_s[k] == h.time_s[k - 1]
                && h.sliding_velocity_m_per_s[k] != h.sliding_velocity_m_per_s[k - 1]
        };
        let stops = (1..h.len())
            .filter(|&k| h.mode[k] == Mode::Stick && h.mode[k - 1] != Mode::Stick && !strikes(k));
        for k in stops {
            let at_s = self.place(&mut interval, h.time_s[k]);
            let normal_n = self.ground.stretch(interval, at_s, at_s).normal_at(at_s);
            let push = (h.friction_force_n[k] / self.system.block_kg).abs();
            let margin = self.system.hold.margin(push, normal_n.max(0.0));
            closest = margin.into_iter().chain(closest).reduce(f64::min);
        }
        closest
    }

    /// The least local minimum of the sliding speed of a motion that does not pass rest: by its series from knot to
    /// knot, where one may be within.
    fn least_speed(self, h: &History) -> Option<f64> {
        let Self { system, ground, .. } = &self;
        let [x, y] = self.direction;
        let state = |k: usize| {
            let of = |list: &[f64]| {
                let [own, across] = self.storeys(&list[k * h.storeys..][..h.storeys]);
                system.amplitudes(&self.model.frame().masses_kg, [&own, &across])
            };
            let (s, w) = (h.sliding_displacement_m[k], h.sliding_velocity_m_per_s[k]);
            State {
                s: [x * s, y * s],
                w: [x * w, y * w],
                eta: of(&h.storey_displacement_m),
                rate: of(&h.storey_velocity_m_per_s),
                contact: in_plane_contact(h.contact.get(k).copied().unwrap_or_default()),
            }
        };
        let gain = |k: usize| {
            h.mode[k].sign() * (h.block_acceleration_m_per_s2[k] - h.table_acceleration_m_per_s2[k])
        };
        let most = |list: &[f64]| list.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let lists = [
            &h.table_acceleration_m_per_s2,
            &h.block_acceleration_m_per_s2,
            &h.storey_acceleration_m_per_s2,
        ];
        let sharpest: f64 = lists.iter().map(|list| most(list)).sum();
        let looks = (0..h.len().saturating_sub(1)).filter(|&k| {
            let length_s = h.time_s[k + 1] - h.time_s[k];
            // How far the acceleration may be off its chord.
            let radians = system.rate_rad_per_s * length_s;
            let hidden = 0.125 * radians * radians * sharpest;
            let may_turn = || gain(k) - hidden < 0.0 && gain(k + 1) + hidden > 0.0;
            length_s > 0.0 && h.mode[k] != Mode::Stick && may_turn()
        });
        let mut interval = 0;
        let parts: Vec<(State, Stretch)> = looks
            .map(|k| {
                let from_s = self.place(&mut interval, h.time_s[k]);
                let to_s = from_s + (h.time_s[k + 1] - h.time_s[k]);
                (state(k), ground.stretch(interval, from_s, to_s))
            })
            .collect();
        let mut least = least_at_knots(h, gain);
        let Some((first, _)) = parts.first() else { return least };
        let first = first.clone();
        let Self { system, ground, along_y, instructions, .. } = self;
        let mut plane = Plane::new((system, first), (ground, along_y), instructions, false);
        for (state, stretch) in parts {
            let Stretch { from_s, to_s, .. } = stretch;
            plane.peak_speed = norm(state.w);
            (plane.state, plane.least) = (state, Least::default());
            let mut at_s = from_s;
            while at_s < to_s {
                let next_s = plane.slide(&stretch, at_s);
                if next_s <= at_s || plane.state.w == [0.0; 2] {
                    break;
                }
                at_s = next_s;
            }
            least = plane.least.speed.into_iter().chain(least).reduce(f64::min);
        }
        least
    }
}

/// The least speed of a jump at which it has fallen and rises, by its slope at a knot.
fn least_at_knots(h: &History, slope: impl Fn(usize) -> f64) -> Option<f64> {
    let turns = (1..h.len()).filter(|&k| {
        let slips = [k - 1, k].iter().all(|&k| h.mode[k] != Mode::Stick);
        let [before, after] = [k - 1, k].map(|k| h.sliding_velocity_m_per_s[k].abs());
        let falls = slope(k - 1) < 0.0 || after < before;
        slips && h.time_s[k - 1] == h.time_s[k] && falls && slope(k) >= 0.0
    });
    turns.map(|k| h.sliding_velocity_m_per_s[k].abs()).reduce(f64::min)
}

/// A slip is positive along its own velocity.
fn in_two_directions(mode: Mode) -> Mode {
    if mode == Mode::Stick { mode } else { SLIP }
}

/// A ring has one side.
fn in_plane_contact(contact: Contact) -> Contact {
    match contact {
        Contact::Free => contact,
        Contact::Pressed(_) => Ring::PRESSED,
        Contact::Separated(_) => Ring::SEPARATED,
    }
}

/// Solves a model under a motion that is along no axis.
pub(in crate::solver) fn solve(
    (model, system): (&Model, System),
    (ground, along_y): (Ground<'_>, GroundAlongY<'_>),
    instructions: InstructionSet,
    (with_history, pulse): (bool, Pulse<'_>),
) -> Result<Response, SolveError> {
    let (state, turned) = (State::initial(&system, model), model.turned_to_y());
    let law = model.law(false);
    let (s, speed) = (state.s[0], norm(state.w));
    let units = 64 * (1 + system.modes()) as u32;
    let contact = state.contact;
    let phase = Plane::new((system, state), (ground, along_y), instructions, with_history);
    let mut course =
        WalkState::new(SliderState::new(&law, s, speed), [s, speed], (Vec::new(), Vec::new()));
    course.slider.memory.contact = contact;
    let mut walk = Walk::new((phase, course), (ground, [0.0, model.normal_n()]), (pulse, units));
    walk.go()?;
    let Walk { phase, course, first_impact_s, .. } = walk;
    let contact_loss_s = contact_loss_s(ground.times_s, ground.normal);
    let of = |model: &Model, part: Part| {
        let slides = course.block.mode == SLIP;
        demands(model, &phase, (&course, slides), part)
    };
    let [x, y] = phase.peaks.peak_place;
    let mut in_plane = InPlane {
        axes: [of(model, Part::Axis(0)), of(&turned, Part::Axis(1))],
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
    let mut warnings = summary::warnings(model, &course.events, &contact_loss_s);
    warnings.extend(first_impact_s.map(summary::impulses_excluded));
    Ok(Response {
        method: Method::Exact,
        demands,
        warnings,
        events: course.events,
        history,
        contact_loss_s,
        iterations: None,
        in_plane: Some(Box::new(in_plane)),
    })
}
