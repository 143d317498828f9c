//! What is judged in a plane: from knot to knot in order of time.

use super::super::demands::{Comparison, Rounding};
use super::super::energy::EnergyBalance;
use super::super::ground::{Ground, nearest};
use super::super::judge::{Directions, Judge, JudgeInput, Run, Sizes};
use super::super::law::StickDemand;
use super::super::structure::{excess, larger};
use super::super::{ClosestCall, DecisionKind};
use super::frame::{Forces, Loads, Pair, PlaneFrame, State, Under, dot, norm, pair, unit};
use super::peaks::{Acting, Peaks, Tracked};
use super::step::Stepper;
use super::{Lists, lists};
use crate::error::Stopped;
use crate::response::{Contact, HistoryAlongY, InPlane, Mode};
use crate::slider::Direction;

/// A block that slows down to this part of its peak speed in a slip has come to rest if it holds.
pub(super) const REST: f64 = 1e-14;

/// Where a side of a knot lies in its interval.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    Start,
    End,
    /// No interval begins or ends at the knot.
    Alone,
}

/// What an event is in the plane.
pub(super) struct EventDirection {
    /// Direction of the first velocity, as far as it is known; 0 in stick.
    pub(super) direction: Option<Pair>,
    /// What it is not known to, and the force that tells it.
    pub(super) unsure: f64,
    pub(super) force_n: f64,
    /// `s` along y.
    pub(super) y_m: f64,
}

/// Minima of the speed of a slip at which the block would have held, had it come to rest.
#[derive(Default)]
pub(super) struct Minima {
    /// When the speed was last at a turn, and whether the block would hold there.
    pub(super) turn: (f64, bool),
    /// The least of them, and when.
    pub(super) least: Option<(f64, f64)>,
    /// Whether one was rest, by the peak of the speed up to there.
    pub(super) was_at_rest: bool,
}

/// What a judgement in a plane needs besides.
pub(super) struct Plane<'a> {
    pub(super) printed: &'a InPlane,
    pub(super) along_y: &'a HistoryAlongY,
    lists: Lists<'a>,
    pub(super) stepper: Stepper<'a>,
    /// The table along y.
    pub(super) ground_y: Ground<'a>,
    pub(super) peaks: Peaks,
    /// What the events are in the plane, in their order.
    pub(super) event_directions: Vec<EventDirection>,
    /// Minima of the speed of the slip under way.
    pub(super) minima: Minima,
    /// Least local minimum of the sliding speed.
    pub(super) least_speed: Option<f64>,
    /// The least where minima count that rounding may have made.
    pub(super) shallow_speed: f64,
    /// The direction of the one line on which all moves, if it does: friction is along it, and no rounding turns it.
    pub(super) line: Option<Pair>,
    /// Along which axes nothing moves then, not even by rounding.
    pub(super) still: [bool; 2],
    /// Near rest, whether the slip was straight when it came there.
    pub(super) near_rest: Option<bool>,
    /// The last direction of sliding, and the speed that was left where the last interval ended.
    pub(super) heading: Option<Pair>,
    pub(super) arrived: f64,
    /// Where `s` is at the printed time of its peak.
    pub(super) at_peak: Option<Pair>,
}

/// A judgement in a plane.
pub(super) type PlaneJudge<'a> = Judge<'a, Plane<'a>>;

impl<'a> PlaneJudge<'a> {
    /// A judgement of what is printed, and of its part along y.
    pub(super) fn of_plane(
        given: JudgeInput<'a>,
        (printed, along_y, table_y): (&'a InPlane, &'a HistoryAlongY, &'a [f64]),
        frame: &'a PlaneFrame<'a>,
    ) -> Self {
        let end_s = given.history.time_s.last().copied().unwrap_or(0.0);
        let [_, slope_y] = frame.slope;
        let ground_y = Ground::of(given.model, given.motion, (table_y, slope_y), end_s);
        let most_y = ground_y.largest(end_s).1;
        let start = [given.model.initial(), &given.model.along_y().initial];
        let slides = start.iter().any(|initial| initial.sliding_velocity_m_per_s != 0.0);
        let plane = Plane {
            printed,
            along_y,
            lists: lists(given.history, along_y),
            stepper: Stepper::new(frame, given.motion.dt_s(), end_s),
            ground_y,
            peaks: Peaks::new(given.outputs),
            event_directions: Vec::new(),
            minima: Minima::default(),
            least_speed: None,
            shallow_speed: f64::INFINITY,
            line: None,
            still: [false; 2],
            near_rest: None,
            heading: None,
            arrived: 0.0,
            at_peak: None,
        };
        let mut judge = Self::new(given, slides, plane);
        judge.largest.1 = judge.largest.1.max(most_y);
        judge
    }

    pub(super) fn frame(&self) -> &'a PlaneFrame<'a> {
        self.axes.stepper.frame
    }

    pub(super) fn tracked(&self) -> Tracked<'a> {
        let Plane { stepper: Stepper { frame, instructions, .. }, line, .. } = self.axes;
        Tracked { frame, outputs: self.outputs, instructions, line, turns: false }
    }

    /// The mode at a knot.
    pub(super) fn mode(&self, k: usize) -> Mode {
        self.h.modes(k)[0]
    }

    /// The state stored at a knot.
    pub(super) fn state(&self, k: usize) -> State {
        let states = (0..self.frame().degrees()).map(|degree| self.stored(k, degree));
        let (x, v) = states.map(|[x, v]| (x, v)).unzip();
        State { x, v, pressed: self.presses(k) }
    }

    /// Whether the block presses the stop around it from a knot on: on a line, as in one direction, it leans at rest on one
    /// that does not give way.
    pub(super) fn presses(&self, k: usize) -> bool {
        let rests = || {
            self.axes.line.is_some()
                && self.mode(k) == Mode::Stick
                && self.law.bears_on_stop(norm(self.place(k))) != [false; 2]
        };
        matches!(self.contact(k), Contact::Pressed(_)) || rests()
    }

    /// The place and the speed of a block at a stop that does not give way are those of the law: it is within it, and on it
    /// where it bears on it.
    pub(super) fn off_wall(&mut self, k: usize, s: Pair, w: Pair) {
        let Some(ring) = self.frame().wall() else { return };
        let slack_m = self.instant_s * norm(w) + 8.0 * f64::EPSILON * self.figures.displacement[1];
        let off_m = norm(s) - ring.gap_m;
        let off_m = if self.presses(k) { off_m.abs() } else { off_m };
        let f = &mut self.figures;
        f.displacement[0] = larger(f.displacement[0], excess(off_m - slack_m));
    }

    /// By how much the contact at a knot breaks the law of the stop at a place with a velocity.
    pub(super) fn contact_excess(&self, k: usize, s: Pair, w: Pair) -> f64 {
        let Some(stop) = self.frame().stop.filter(|stop| !stop.is_rigid) else { return 0.0 };
        let most_m = self.figures.displacement[1].max(stop.gap_m);
        let slack_m = self.instant_s * norm(w) + 8.0 * f64::EPSILON * most_m;
        let slack = [slack_m, stop.damper * self.velocity_rounding];
        self.law.contact_excess(self.contact(k), along_radius(s, w), slack)
    }

    /// `s` at a knot.
    pub(super) fn place(&self, k: usize) -> Pair {
        [self.h.sliding_displacement_m[k], self.axes.along_y.sliding_displacement_m[k]]
    }

    /// All that the table does at the time of a knot, and how far each is off what is stored there.
    pub(super) fn loads_of(&self, k: usize) -> ([Loads; 4], [f64; 4]) {
        let all = self.instant(self.h.time_s[k]);
        let own = [
            self.h.table_acceleration_m_per_s2[k],
            self.axes.along_y.table_acceleration_m_per_s2[k],
        ];
        let off = all.map(|loads| norm([0, 1].map(|axis| loads[axis].table - own[axis])));
        (all, off)
    }

    /// All that the table does at one instant, from left to right.
    pub(super) fn instant(&self, t: f64) -> [Loads; 4] {
        let [x, y] = [&self.ground, &self.axes.ground_y].map(|ground| ground.instant(t));
        core::array::from_fn(|i| [x[i], y[i]])
    }

    /// What a block at rest is asked for, and the rounding of it. All slips are called positive: `T = −|p| M1`.
    pub(super) fn required_friction(&self, push: Pair, loads: &Loads) -> (StickDemand, f64) {
        let (demand, high) =
            (-self.frame().block_kg * norm(push), self.frame().most_held_n(loads[0].normal));
        (StickDemand { demand, low: -high, high }, self.rounding(loads))
    }

    /// What the rounding of times makes of what a block at rest is asked for, less what holds it.
    pub(super) fn rounding(&self, loads: &Loads) -> f64 {
        let ((instant_s, _), frame) = (self.ground.load_rounding(), self.frame());
        let table = loads.iter().map(|load| load.rounding_of_mass(instant_s, frame.block_kg));
        table.sum::<f64>() + frame.fixed * self.pressed_rounding(&loads[0])
    }

    /// All that acts in a state.
    pub(super) fn acting(&self, state: &State, loads: &Loads) -> Acting<1> {
        let values = state.x.iter().chain(&state.v);
        Acting::new(
            self.frame(),
            values.map(|value| [*value]).collect(),
            Under::new(loads, state.pressed),
        )
    }

    /// The push on the block in a state.
    pub(super) fn push(&self, state: &State, loads: &Loads) -> Pair {
        self.frame().push(state, loads)
    }

    /// Compares what is stored at a knot with the loads on one side of it: the accelerations of the table, the
    /// law of friction, the balance of forces. At the start of a slip from rest friction is against the
    /// push, at its end it has any direction.
    pub(super) fn side(&self, k: usize, loads: &Loads, place: Place) -> Side {
        let (h, y, frame) = (self.h, self.axes.along_y, self.frame());
        let state = self.state(k);
        let Acting { forces, floors, .. } = self.acting(&state, loads);
        let Forces { base, spring, damper, stop, push } = &forces;
        let [base, spring, damper, stop, push] =
            [base, spring, damper, stop, push].map(|of| pair(of, 0));
        let at = |x: &[f64], y: &[f64], i: usize| [x[i], y[i]];
        let own = at(&h.table_acceleration_m_per_s2, &y.table_acceleration_m_per_s2, k);
        let block = at(&h.block_acceleration_m_per_s2, &y.block_acceleration_m_per_s2, k);
        let friction = at(&h.friction_force_n, &y.friction_force_n, k);
        let mut side = Side::default();
        for (load, own) in loads.iter().zip(own) {
            let off = (load.table - own).abs() - self.instant_s * load.slope.abs();
            side.table = larger(side.table, excess(off));
        }
        let normal_n = loads[0].normal_rounding(self.ground.load_rounding());
        let follows_n = frame.curvature_per_m * normal_n * norm([state.x[0], state.x[1]]);
        if self.mode(k) == Mode::Stick {
            side.speed = norm(state.speed());
            let split = [0, 1].map(|i| frame.block_kg * (block[i] - own[i]));
            side.defect = norm(split);
        } else {
            let slid = frame.block_kg * frame.slowing(loads, norm(state.speed()));
            let departs = || frame.body.departure(push, frame.slowing(loads, 0.0));
            let at_rest = (place == Place::Start).then(departs).flatten();
            let off = match unit(state.speed()).or(at_rest) {
                Some(u) => norm([0, 1].map(|i| friction[i] + slid * u[i])),
                None => (norm(friction) - slid).abs(),
            };
            side.excess = excess(off - frame.most * self.pressed_rounding(&loads[0]));
        }
        let pulled = [0, 1].map(|i| block[i] + frame.slope[i]);
        let inertia = frame.inertia(pulled);
        let mut balance =
            [0, 1].map(|i| inertia[i] - base[i] + spring[i] + damper[i] + stop[i] - friction[i]);
        let wall = frame.wall().filter(|_| state.pressed);
        if wall.is_some() && self.mode(k) == Mode::Stick {
            // How a block at rest shares its push between friction and a stop is a convention: the stop does not pull.
            let n = unit([state.x[0], state.x[1]]).unwrap_or_default();
            let taken = (dot(n, stop) - dot(n, balance)).max(0.0) - dot(n, stop);
            balance = [0, 1].map(|i| balance[i] + taken * n[i]);
        }
        side.defect = larger(side.defect, excess(norm(balance) - follows_n));
        for vector in [inertia, base, spring, damper, stop, friction] {
            side.term = larger(side.term, norm(vector));
        }
        let n = h.storeys;
        for (i, (force, mass)) in floors.iter().zip(&frame.masses_kg).enumerate() {
            let lists = [&h.storey_acceleration_m_per_s2, &y.storey_acceleration_m_per_s2];
            let own = match frame.points {
                Some(_) => lists[0][k * n + i],
                None => lists[i % 2][k * n + i / 2],
            };
            let inertia = mass * (own + frame.ridden(i, frame.slope));
            side.defect = larger(side.defect, inertia + force[0]);
            side.term = larger(side.term, inertia);
        }
        side
    }

    /// Takes up what one side of a knot tells.
    pub(super) fn take(&mut self, side: &Side) {
        let f = &mut self.figures;
        f.table[0] = larger(f.table[0], side.table);
        f.excess = larger(f.excess, side.excess);
        f.velocity[0] = larger(f.velocity[0], side.speed);
        f.force[0] = larger(f.force[0], side.defect);
        f.force[1] = larger(f.force[1], side.term);
    }
}

impl Directions for PlaneJudge<'_> {
    fn degrees(&self) -> usize {
        self.frame().degrees()
    }

    fn stored(&self, k: usize, degree: usize) -> [f64; 2] {
        let lists = &self.axes.lists;
        let by_modes = self.frame().points.is_some();
        let list = lists[if by_modes && degree >= 2 { 0 } else { degree % 2 }];
        match degree.checked_sub(2) {
            None => [list[1][k], list[2][k]],
            Some(i) => {
                let storey = if by_modes { i } else { i / 2 };
                [list[5], list[6]].map(|list| list[k * self.h.storeys + storey])
            }
        }
    }

    fn initial(&self, degree: usize) -> [f64; 2] {
        let (model, y) = (self.model, &self.model.along_y().initial);
        match degree.checked_sub(2) {
            None => {
                let initial = if degree == 0 { model.initial() } else { y };
                [initial.sliding_displacement_m, initial.sliding_velocity_m_per_s]
            }
            Some(i) if self.frame().points.is_some() => {
                let velocities = y.storey_velocity_m_per_s.as_ref();
                [self.frame().held_m(i, model), velocities.map_or(0.0, |list| list[i])]
            }
            Some(i) => {
                let turned;
                let own = if i % 2 == 1 {
                    turned = model.turned_to_y();
                    &turned
                } else {
                    model
                };
                [own.initial_storey_displacement_m(), own.initial_storey_velocity_m_per_s()]
                    .map(|list| list[i / 2])
            }
        }
    }

    fn speed_at(&self, k: usize, _: usize) -> f64 {
        norm([0, 1].map(|axis| self.stored(k, axis)[1]))
    }

    fn measure(&mut self) -> Result<bool, Stopped> {
        let lists = self.axes.lists;
        let finite = lists.iter().flatten().copied().flatten().all(|value| value.is_finite());
        let most = |list: &[f64]| list.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let mut sizes = Sizes {
            acceleration: lists.iter().fold(self.largest.1, |a, list| a.max(most(list[3]))),
            frequency: self.frame().frequency,
            ..Sizes::default()
        };
        let (mut kinetic, mut strain) = (Vec::new(), Vec::new());
        for k in 0..self.h.len() {
            let state = self.state(k);
            sizes.displacement_m = sizes.displacement_m.max(most(&state.x));
            sizes.storey_m = sizes.storey_m.max(most(&state.x[2..]));
            sizes.velocity = sizes.velocity.max(most(&state.v));
            sizes.sliding = sizes.sliding.max(norm(state.speed()));
            kinetic.push(self.frame().kinetic_energy(&state.v));
            strain.push(self.frame().strain(&state.x));
            let broken = self.contact_excess(k, self.place(k), state.speed());
            self.figures.excess = larger(self.figures.excess, broken);
            self.off_wall(k, self.place(k), state.speed());
        }
        self.take_sizes(&sizes);
        let varies = self.ground.has_vertical();
        let stop_j = self.law.push(self.contact(0)).strain(norm(self.place(0)));
        self.books = EnergyBalance::new([kinetic, strain], stop_j, [varies, self.law.follows()]);
        Ok(finite)
    }

    fn decide(&mut self, changes: &[usize]) {
        for &k in changes.iter().filter(|&&k| !self.strikes(k)).collect::<Vec<_>>() {
            let (all, off) = self.loads_of(k);
            let state = self.state(k);
            let found = self.weigh((k, 0), nearest(off), 1, |load, _| {
                let push = self.push(&state, &all[load]);
                self.required_friction(push, &all[load])
            });
            self.decided((k, 0), found);
        }
    }

    fn go_through(&mut self, run: Run) -> Result<(), Stopped> {
        (run.from..run.to).try_for_each(|k| self.interval(k))
    }

    /// By the load that suits it best.
    fn isolated_knot(&mut self, k: usize) {
        let all = self.instant(self.h.time_s[k]);
        let sides = all.map(|loads| self.side(k, &loads, Place::Alone));
        let off = |side: &Side| [side.table, side.excess + side.defect];
        let better = |a: usize, b: usize| if off(&sides[b]) < off(&sides[a]) { b } else { a };
        let best = (1..4).fold(0, better);
        self.take(&sides[best]);
        if k == 0 || k + 1 == self.h.len() {
            let state = self.state(k);
            let loads = all[if k == 0 { 1 } else { 2 }];
            let acting = self.acting(&state, &loads);
            let slips = self.mode(k) != Mode::Stick;
            let departs = || {
                let frame = self.frame();
                frame.body.departure(pair(&acting.forces.push, 0), frame.slowing(&loads, 0.0))
            };
            let direction = unit(state.speed()).or_else(departs).filter(|_| slips);
            self.axes.peaks.see(&self.tracked(), &acting, direction);
        }
    }

    fn at_same_time(&mut self, k: usize) -> bool {
        if self.strikes(k) {
            self.impact(k);
            return true;
        }
        for degree in 0..self.frame().degrees() {
            let before = self.stored(k - 1, degree);
            self.compare(k, degree, before, [0.0, self.velocity_rounding]);
        }
        self.turn_between(k - 1);
        false
    }

    fn closest_call_of_slip(&mut self, _: usize, _: Direction) -> Option<ClosestCall> {
        let (minimum, peak) = (self.dips[0].so_far(), self.dips[0].peak());
        self.axes.shallow_speed = self.axes.shallow_speed.min(self.dips[0].shallow());
        if minimum.is_finite() {
            let least = &mut self.axes.least_speed;
            *least = Some(least.map_or(minimum, |least| least.min(minimum)));
        }
        let (least, time_s) = self.axes.minima.least?;
        if self.axes.minima.was_at_rest {
            // It came to rest, was held, and slides on.
            let off = (self.frame().fixed - self.law.kinetic_at(0.0)[0]) * self.largest.0;
            self.figures.excess = larger(self.figures.excess, off);
        }
        Some(ClosestCall { margin: least / peak, time_s, kind: DecisionKind::Slip, interface: 0 })
    }

    fn changed(&mut self, k: usize) {
        self.turn(k);
    }

    fn at_stop(&self, k: usize) -> [f64; 2] {
        let (radius_m, rate) = along_radius(self.place(k), self.state(k).speed());
        [radius_m, rate]
    }

    fn leans(&self, k: usize) -> bool {
        self.presses(k)
    }

    fn touched(&mut self, k: usize) {
        let state = self.state(k);
        let direction = Some(unit(state.speed()).unwrap_or_default());
        let y_m = state.x[1];
        let event = EventDirection { direction, unsure: 0.0, force_n: f64::INFINITY, y_m };
        self.axes.event_directions.push(event);
    }

    fn begins(&mut self, _: usize) {
        let plane = &mut self.axes;
        (plane.minima, plane.near_rest) = (Minima::default(), None);
        (plane.heading, plane.arrived) = (None, 0.0);
    }

    /// The motion is found over the table, whose acceleration a block without friction does not have.
    fn carried_n(&self) -> f64 {
        self.frame().total_kg * (self.largest.1 + norm(self.frame().slope))
    }

    fn compare_demands(&self, c: &mut Comparison, rounding: &Rounding) {
        self.compare_printed(c, rounding);
    }
}

/// `ρ = |s|` and `ρ̇`.
pub(super) fn along_radius(s: Pair, w: Pair) -> (f64, f64) {
    let radius_m = norm(s);
    (radius_m, dot(s, w) / radius_m)
}

/// What one side of a knot tells.
#[derive(Clone, Copy, Default)]
pub(super) struct Side {
    table: f64,
    excess: f64,
    /// Velocity in stick.
    speed: f64,
    defect: f64,
    term: f64,
}
