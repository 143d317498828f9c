//! The own motion from a knot to the next: what is in force, the path, and all that it tells.

use super::super::collocation::{Column, MAX_TURN, POINTS, combined, most};
use super::super::ground::{Load, between};
use super::super::judge::{Directions, Judge, STILL};
use super::super::law::{BOUNDLESS, Push, Sliding, either};
use super::super::near::dip;
use super::super::outputs::{is_below, raise_size};
use super::super::structure::{Phase, Structure, excess, larger};
use super::Line;
use super::equations::{Drive, PULLS, SHIFT, TABLE, linear};
use super::step::{LineStep, LineStretch};
use crate::error::Stopped;
use crate::numerics::instructions::vectorize;
use crate::response::output::{BLOCK, FRICTION, VELOCITY};
use crate::response::{Contact, Mode};
use crate::slider::Direction;

/// What is in force from a knot on.
#[derive(Clone, Copy)]
pub(super) struct IntervalLaw<'m> {
    pub(super) modes: &'m [Mode],
    /// `p₀, p₁`.
    friction: [f64; 2],
    /// What an elastic stop does.
    push: Push,
    /// Least and largest `T/N` at rest, of friction with rigid stops.
    pub(super) hold: [f64; 2],
    /// Between which `T/N` friction takes the demand; a rigid stop takes the rest.
    taken: [f64; 2],
    /// Coefficient of the slider, where it slides, and the sum of those of contents that do.
    slides: [f64; 2],
}

/// A straight piece of friction by speed: `p₀, p₂`, and between which speeds.
pub(super) struct SpeedPiece {
    line: [f64; 2],
    band: [f64; 2],
}

/// What is known of the path from a knot so far.
pub(super) struct LinePath {
    knot: usize,
    step: LineStep,
    fastest: Vec<f64>,
    /// Largest rounding of `N`, and of what the slider's friction follows.
    normal_rounding: f64,
    pressed_rounding: f64,
    /// Interface by interface, the largest speed against the direction claimed, and the force that it says is wrong.
    astray: Vec<[f64; 2]>,
}

impl LinePath {
    /// Room for paths with so many outputs.
    pub(super) fn new(structure: &Structure, outputs: usize) -> Self {
        Self {
            knot: 0,
            step: LineStep::new(structure, outputs),
            fastest: vec![0.0; structure.degrees()],
            normal_rounding: 0.0,
            pressed_rounding: 0.0,
            astray: vec![[0.0; 2]; 1 + structure.contents.len()],
        }
    }
}

impl<'a> Judge<'a, Line<'a>> {
    /// How a slip of surfaces in series goes on from a knot.
    pub(super) fn sliding(&self, k: usize, mode: Mode) -> Option<Sliding> {
        let Mode::Slip(direction) = mode else { return None };
        self.law.series.as_ref()?;
        let mut ways = self.law.slidings(self.h.surface_displacements(k), direction);
        // The force that is stored tells that a surface has left its end.
        let place = if ways.len() > 1 {
            let (loads, found) =
                (self.ground.instant(self.h.time_s[k]), self.h.friction_force_n[k]);
            let suits = |way: &Sliding| {
                let off = |load: &Load| (load.normal * way.force(0.0) + found).abs();
                let least = loads.iter().map(off).fold(f64::INFINITY, f64::min);
                least <= STILL * self.model.weight_n()
            };
            ways.iter().position(suits).unwrap_or(0)
        } else {
            0
        };
        (!ways.is_empty()).then(|| ways.swap_remove(place))
    }

    /// What is in force from a knot on in modes.
    pub(super) fn in_force<'m>(&self, k: usize, modes: &'m [Mode]) -> IntervalLaw<'m> {
        let s = self.h.sliding_displacement_m[k];
        let (mut friction, mut hold) = ([0.0; 2], [0.0; 2]);
        let mut taken = BOUNDLESS;
        let mut slides = [0.0; 2];
        match modes[0] {
            Mode::Stick => {
                let free = self.law.hold(self.h.surface_displacements(k));
                let bears_on_stop = self.law.bears_on_stop(s);
                hold = either(bears_on_stop, BOUNDLESS, free);
                taken = either(bears_on_stop, free, BOUNDLESS);
            }
            Mode::Slip(direction) => {
                friction = match self.sliding(k, modes[0]) {
                    Some(sliding) => sliding.friction(s),
                    None => [self.law.sliding_load(direction), 0.0],
                };
                slides[0] = self.law.most();
            }
        }
        for (mode, contents) in modes[1..].iter().zip(&self.structure().contents) {
            if *mode != Mode::Stick {
                slides[1] += contents.kinetic_friction;
            }
        }
        let push = self.law.push(self.contact(k));
        IntervalLaw { modes, friction, push, hold, taken, slides }
    }

    /// What drives a step under loads.
    pub(super) fn drive<'m>(
        &self,
        in_force: &IntervalLaw<'m>,
        loads: &[Load; 2],
        piece: Option<&SpeedPiece>,
    ) -> Drive<'m> {
        let of = |factor: f64| loads.map(|load| load.normal * factor);
        let [stiffness, damper, shift] = in_force.push.numbers();
        let [p0, p1] = in_force.friction;
        let per_kg = self.structure().total_kg;
        let contents = in_force.modes[1..].iter().zip(&self.structure().contents);
        let pulls = contents.map(|(mode, c)| of(mode.sign() * c.kinetic_friction / per_kg));
        let friction = piece.map_or(p0, |piece| piece.line[0]);
        let slides = loads.map(|load| self.law.pressed(load.normal) * friction);
        let own = [loads.map(|load| load.a), slides, [shift; 2]];
        Drive {
            modes: in_force.modes,
            loads: own.into_iter().chain(pulls).collect(),
            stop: [stiffness, damper],
            rise: of(p1 + self.law.curvature_per_m()),
            drag: piece.map_or(0.0, |piece| loads[0].normal * piece.line[1]),
            by_speed: in_force.modes[0] != Mode::Stick
                && self.law.rate.is_some()
                && piece.is_none(),
            normal: loads.map(|load| load.normal),
            friction,
            taken: in_force.taken,
        }
    }

    /// The straight piece of friction by speed in which the speeds at two knots lie.
    fn piece(&self, in_force: &IntervalLaw<'_>, k: usize) -> Option<SpeedPiece> {
        let (Some(rate), Mode::Slip(direction)) = (&self.law.rate, in_force.modes[0]) else {
            return None;
        };
        let speeds = [k, k + 1].map(|k| self.h.sliding_velocity_m_per_s[k].abs());
        let (band, [mu, slope]) = rate.piece(speeds)?;
        // −σ f (c + m |ṡ|) = −σ f c − f m ṡ.
        let line = [in_force.friction[0] * mu, rate.factor(direction) * slope];
        Some(SpeedPiece { line, band })
    }

    /// Judges the interval from a knot to the next.
    pub(super) fn interval(&mut self, k: usize, path: &mut LinePath) -> Result<(), Stopped> {
        let h = self.h;
        let [from_s, end_s] = [h.time_s[k], h.time_s[k + 1]];
        let in_force = self.in_force(k, h.modes(k));
        let phase = match (in_force.modes[0], self.contact(k)) {
            (Mode::Stick, _) => Phase::Stick,
            (_, Contact::Pressed(_)) => Phase::Pressed,
            _ => Phase::Slip,
        };
        let even = (end_s - from_s - self.axes.even_s).abs() <= 2.0 * self.instant_s;
        let piece =
            if even && !self.ground.has_vertical() { self.piece(&in_force, k) } else { None };
        self.start(path, k, in_force.modes);
        let mut at_s = from_s;
        while at_s < end_s {
            let whole = self.ground.piece(at_s, end_s);
            let length_s = whole.to_s - at_s;
            // A step that is even to within rounding takes as many.
            let turns = self.axes.rates[phase as usize] * length_s / MAX_TURN;
            let steps = libm::ceil(turns * (1.0 - 1e-9)).max(1.0);
            let usual_s = (even && length_s == end_s - from_s).then_some(self.axes.even_s / steps);
            for j in 0..steps as usize {
                let part = |j: usize| between(whole.loads, j as f64 / steps);
                let stretch = LineStretch {
                    from_s: at_s + j as f64 * (length_s / steps),
                    step_s: length_s / steps,
                    loads: [part(j), part(j + 1)],
                };
                let is_first = at_s == from_s && j == 0;
                let is_last = whole.to_s >= end_s && j + 1 == steps as usize;
                self.pulse.tick(32 * self.structure().degrees() as u32)?;
                let acting = (&in_force, piece.as_ref());
                self.go(path, acting, (&stretch, usual_s), [is_first, is_last]);
            }
            at_s = whole.to_s;
        }
        self.ends(path, &in_force);
        Ok(())
    }

    /// Starts a path from what is stored at a knot; what sticks has no velocity.
    fn start(&self, path: &mut LinePath, k: usize, modes: &[Mode]) {
        (path.knot, path.normal_rounding, path.pressed_rounding) = (k, 0.0, 0.0);
        path.fastest.fill(0.0);
        path.astray.fill([0.0; 2]);
        for degree in 0..path.fastest.len() {
            let [x, v] = self.stored(k, degree);
            (path.step.x[degree][POINTS - 1], path.step.v[degree][POINTS - 1]) = (x, v);
        }
        for (i, _) in modes.iter().enumerate().filter(|(_, mode)| **mode == Mode::Stick) {
            path.step.v[self.structure().degree_of(i)][POINTS - 1] = 0.0;
        }
    }

    /// Goes through a step and takes up all that it tells.
    fn go(
        &mut self,
        path: &mut LinePath,
        (in_force, piece): (&IntervalLaw<'_>, Option<&SpeedPiece>),
        (stretch, usual_s): (&LineStretch, Option<f64>),
        [is_first, is_last]: [bool; 2],
    ) {
        let k = path.knot;
        let mut drive = self.drive(in_force, &stretch.loads, piece);
        path.step.go_on();
        self.axes.stepper.step(&drive, (stretch.step_s, usual_s), &mut path.step);
        if piece.is_some_and(|piece| !piece.holds(&path.step.v[0])) {
            drive = self.drive(in_force, &stretch.loads, None);
            self.axes.stepper.step(&drive, (stretch.step_s, None), &mut path.step);
        }
        let rounding = stretch.loads[0].normal_rounding(self.ground.load_rounding());
        path.normal_rounding = path.normal_rounding.max(rounding);
        let least = stretch.loads[0].normal.min(stretch.loads[1].normal);
        let rounding = self.law.pressed_rounding(least, rounding);
        path.pressed_rounding = path.pressed_rounding.max(rounding);
        if is_first {
            if !self.ground.is_at_sample(stretch.from_s) {
                let rounding = self.rounding(0, self.structure().total_kg, &stretch.loads[0]);
                self.unsure_n = larger(self.unsure_n, rounding);
            }
            self.side(path, &drive, (stretch, 0));
        }
        for (fastest, v) in path.fastest.iter_mut().zip(&path.step.v) {
            *fastest = fastest.max(most(v));
        }
        let instructions = self.axes.stepper.instructions;
        vectorize!(instructions, _simd => {
            self.spend(path, &drive, stretch.step_s);
            self.raise(&path.step.outputs);
        });
        if !drive.sticks(0) {
            self.zero_velocity = self.zero_velocity.max(STILL * path.fastest[0]);
        }
        for (i, mode) in in_force.modes.iter().enumerate() {
            match mode {
                Mode::Stick => self.stays(i, (in_force, &drive), stretch, &path.step),
                Mode::Slip(direction) => self.slides(i, *direction, stretch, path),
            }
        }
        if self.contact(k) != Contact::Free && !drive.sticks(0) {
            self.against_stop(k, &path.step);
        }
        if is_last {
            self.side(path, &drive, (stretch, 1));
        }
    }

    /// Compares what is stored at the start (0) or the end (1) of an interval with the loads: the table's acceleration,
    /// forces of sliding, and where more acts on the block, its acceleration.
    fn side(&mut self, path: &LinePath, drive: &Drive<'_>, (stretch, end): (&LineStretch, usize)) {
        let (h, s, k) = (self.h, self.structure(), path.knot + end);
        let load = &stretch.loads[end];
        let state_rounding = self.instant_s * stretch.loads[0].slope.abs();
        let most = self.law.most();
        let f = &mut self.figures;
        let off = (load.table - h.table_acceleration_m_per_s2[k]).abs() - state_rounding;
        f.table[0] = larger(f.table[0], excess(off));
        let force = h.friction_force_n[k];
        if !drive.sticks(0) {
            let state = [h.sliding_displacement_m[k], h.sliding_velocity_m_per_s[k]];
            let own = self.axes.stepper.equations.stored_sliding(drive, end, state);
            let off = (force - own).abs() - most * path.pressed_rounding;
            f.excess = larger(f.excess, excess(off));
        }
        for (e, contents) in s.contents.iter().enumerate().filter(|(e, _)| !drive.sticks(1 + e)) {
            let [.., stored] = h.contents_state(k, e);
            let own = -drive.loads[PULLS + e][end];
            let mu = contents.kinetic_friction * contents.mass_kg / s.total_kg;
            let off = (stored + self.axes.stepper.equations.slope - own).abs();
            let off = contents.mass_kg * off - mu * path.normal_rounding;
            f.force[0] = larger(f.force[0], excess(off));
        }
        if self.law.is_pendulum() || self.law.restitution().is_some() {
            let point = if end == 0 { 0 } else { POINTS - 1 };
            let own = |output: usize| path.step.outputs[output][point];
            let of_block = s.block_kg * (own(BLOCK) - h.block_acceleration_m_per_s2[k]).abs();
            let of_demand = if drive.sticks(0) { (own(FRICTION) - force).abs() } else { 0.0 };
            let rounding = s.total_kg * state_rounding + most * path.pressed_rounding;
            let off = larger(of_block, of_demand) - rounding;
            f.force[0] = larger(f.force[0], excess(off));
            f.force[1] = larger(f.force[1], own(FRICTION));
            f.force[1] = larger(f.force[1], own(self.outputs.of_stop()));
        }
    }

    /// Adds the work and the losses of a step, by Gauss's rule:
    ///
    /// ```text
    /// work      −∫ a Σ m ẋ dt             friction  −∫ (T − (N p₁ + N/R) s) ṡ dt + ∫ Σ p ṙ dt
    /// damping   ∫ C1 ṡ² + q̇ᵀ C q̇ dt, and what the stop takes
    /// ```
    #[inline(always)]
    fn spend(&mut self, path: &LinePath, drive: &Drive<'_>, step_s: f64) {
        let (s, rule) = (self.structure(), self.axes.stepper.rule);
        let LineStep { x, v, acting, .. } = &path.step;
        let (n, a) = (s.masses_kg.len(), linear(drive.loads[TABLE], &rule.points));
        let (mut power, mut sizes) = (combined(v, &s.moved_kg), [0.0; POINTS]);
        let (mut damping, mut friction) = ([0.0; POINTS], [0.0; POINTS]);
        for i in 0..POINTS {
            let w = v[0][i];
            power[i] *= a[i];
            sizes[i] = power[i].abs();
            damping[i] = (s.damper + drive.stop[1]) * w * w;
            friction[i] = (acting.rise[i] * x[0][i] - acting.sliding[i]) * w;
        }
        for (v, force) in v[1..=n].iter().zip(&acting.viscous) {
            (0..POINTS).for_each(|i| damping[i] += v[i] * force[i]);
        }
        for (e, contents) in s.contents.iter().enumerate() {
            let (pull, v) = (linear(drive.loads[PULLS + e], &rule.points), &v[1 + n + e]);
            (0..POINTS).for_each(|i| friction[i] += contents.mass_kg * pull[i] * v[i]);
        }
        let [from, to] = [x[0][0], x[0][POINTS - 1]];
        let shift = drive.loads[SHIFT][0];
        let squares = 0.5 * (to * to - from * from);
        let (k, books) = (path.knot, &mut self.books);
        books.work[k] -= rule.integral(step_s, &power);
        // What the stop's spring takes is exact.
        books.damping[k] +=
            rule.integral(step_s, &damping) + drive.stop[0] * squares - shift * (to - from);
        books.friction[k] += rule.integral(step_s, &friction);
        if let Some(size) = books.size.get_mut(k) {
            // What a spring that follows N gives back is work put in.
            *size += rule.integral(step_s, &sizes) + (-drive.rise[0] * squares).max(0.0);
        }
    }

    /// Raises the peaks by the outputs at the points of a step.
    #[inline(always)]
    fn raise(&mut self, outputs: &[Column<POINTS>]) {
        for (peak, values) in self.axes.attained.iter_mut().zip(outputs) {
            if !is_below(values, *peak) {
                raise_size(self.axes.stepper.rule, peak, values, false);
            }
        }
    }

    /// Judges a step of a stick from what is asked at its points.
    fn stays(
        &mut self,
        i: usize,
        (in_force, drive): (&IntervalLaw<'_>, &Drive<'_>),
        stretch: &LineStretch,
        step: &LineStep,
    ) {
        let rule = self.axes.stepper.rule;
        let (values, mass_kg) = match i.checked_sub(1) {
            None => (&step.acting.friction, self.axes.stepper.equations.mass(drive, 0)),
            Some(e) => (
                &step.acting.bodies[self.structure().degree_of(i)],
                self.structure().contents[e].mass_kg,
            ),
        };
        let rounding = self.rounding(i, mass_kg, &stretch.loads[0]);
        let [from, to] = stretch.loads.map(|load| load.normal);
        let asked = |judge: &Self, value: f64, t: f64| {
            judge.required_friction_in(i, value, in_force.hold, from + (to - from) * t)
        };
        let at_points =
            core::array::from_fn(|point| asked(self, values[point], rule.points[point]));
        self.held(i, (stretch.from_s, stretch.step_s), rounding, &at_points, |judge, t| {
            asked(judge, rule.interpolate(values, t), t)
        });
    }

    /// Judges a step of a slip from the speed, in the direction claimed, at its points.
    fn slides(
        &mut self,
        i: usize,
        direction: Direction,
        stretch: &LineStretch,
        path: &mut LinePath,
    ) {
        let rule = self.axes.stepper.rule;
        let speeds =
            path.step.v[self.structure().degree_of(i)].map(|speed| direction.sign() * speed);
        let per_n = match i.checked_sub(1).map(|e| &self.structure().contents[e]) {
            None => self.law.wrong_way(),
            Some(contents) => {
                let mu = contents.kinetic_friction.max(0.5 * contents.static_friction);
                2.0 * mu * contents.mass_kg / self.structure().total_kg
            }
        };
        let inner = dip(&speeds);
        for (point, speed) in speeds.into_iter().enumerate() {
            let (mut t, mut speed) = (rule.points[point], speed);
            if inner == Some(point) {
                (t, speed) = rule.least(&speeds, point, |_, speed| speed);
            }
            if speed < -self.zero_velocity || speed.is_nan() {
                let force = per_n * between(stretch.loads, t).normal;
                let astray = &mut path.astray[i];
                *astray = [larger(astray[0], speed), larger(astray[1], force)];
            }
            self.dips[i].feed(stretch.from_s + t * stretch.step_s, speed);
        }
    }

    /// Judges an elastic stop that acts or is left at the points of a step.
    fn against_stop(&mut self, k: usize, step: &LineStep) {
        let fastest = most(&step.v[0]);
        for (s, w) in step.x[0].into_iter().zip(step.v[0]) {
            let broken = self.law.contact_excess(self.contact(k), (s, w), self.slack(fastest));
            self.figures.excess = larger(self.figures.excess, broken);
        }
    }

    /// Compares the end of the path with the knot stored there.
    fn ends(&mut self, path: &LinePath, in_force: &IntervalLaw<'_>) {
        let (s, k) = (self.structure(), path.knot);
        let end = |column: &Column<POINTS>| column[POINTS - 1];
        let length_s = self.h.time_s[k + 1] - self.h.time_s[k];
        // What the rounding of N makes of velocities, places and energies.
        let [own, of_contents] = in_force.slides;
        let force = own * path.pressed_rounding + of_contents * path.normal_rounding;
        let state_rounding = self.take_state_rounding(force / s.least_kg(), length_s);
        let moved = |i| {
            let at = s.degree_of(i);
            (end(&path.step.x[at]) - self.stored(k, at)[0]).abs()
        };
        let (moved, speeds): (f64, f64) =
            ((0..in_force.modes.len()).map(moved).sum(), path.fastest.iter().sum());
        if let Some(load_rounding) = self.books.load_rounding.get_mut(k) {
            *load_rounding = force * moved + s.total_kg * speeds * state_rounding[1];
        }
        for (i, fastest) in path.fastest.iter().enumerate() {
            let rates = [k, k + 1].map(|k| self.acceleration(k, i).abs());
            let end = [end(&path.step.x[i]), end(&path.step.v[i])];
            self.arrive((k + 1, i), end, [*fastest, rates[0].max(rates[1])], state_rounding);
        }
        for (i, mode) in in_force.modes.iter().enumerate().filter(|(i, _)| path.astray[*i][0] > 0.0)
        {
            // What the knot's own defect and the rounding of times explain is no sign.
            let at = s.degree_of(i);
            let [_, stored] = self.stored(k + 1, at);
            let defect = (mode.sign() * (stored - end(&path.step.v[at]))).abs();
            let jerked = [k, k + 1].map(|k| self.acceleration(k, at).abs());
            let load_rounding = defect + self.instant_s * jerked[0].max(jerked[1]);
            if path.astray[i][0] > self.zero_velocity + load_rounding {
                self.figures.excess = larger(self.figures.excess, path.astray[i][1]);
            }
        }
    }

    /// Judges surfaces in series from the knot `k` to the next.
    pub(super) fn surfaces(&mut self, k: usize) {
        let h = self.h;
        let [from, to] = [k, k + 1].map(|k| h.surface_displacements(k));
        let Some(sliding) = self.sliding(k, h.modes(k)[0]) else {
            for (own, stored) in from.iter().zip(to) {
                self.figures.displacement[0] = larger(self.figures.displacement[0], own - stored);
            }
            return;
        };
        let moved = h.sliding_displacement_m[k + 1] - h.sliding_displacement_m[k];
        let own = sliding.displacements(from, moved);
        let fastest = self.axes.attained[VELOCITY];
        for (own, stored) in own.iter().zip(to) {
            let off = (own - stored).abs() - self.instant_s * fastest - self.state_rounding[0];
            self.figures.displacement[0] = larger(self.figures.displacement[0], excess(off));
        }
        let normal = self.ground.instant(h.time_s[k + 1])[0].normal;
        let broken = self.law.series_excess(&sliding, &own, moved);
        self.figures.excess = larger(self.figures.excess, excess(normal * broken));
        self.events.slides_on(h, k, sliding.active());
    }
}

impl SpeedPiece {
    /// Whether a motion with these velocities stays in it: between two points a speed passes those at them by less than
    /// a tenth of its range.
    fn holds(&self, w: &Column<POINTS>) -> bool {
        let speeds = w.map(f64::abs);
        let least = speeds.iter().fold(f64::INFINITY, |least, speed| least.min(*speed));
        let largest = most(&speeds);
        let beyond = 0.1 * (largest - least);
        least - beyond >= self.band[0] && largest + beyond <= self.band[1]
    }
}
