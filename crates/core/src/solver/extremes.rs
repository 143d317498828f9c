//! Extremes of the continuous motion, without looking closely at more than a few samples.
//!
//! Each tracked quantity is a linear function of the state, or of its derivative, whose second
//! derivative over a piece of motion is bounded by its dual norm times the energy norm of `ẍ` at
//! the start of the piece. With the error of a chord, its extremes lie within `length²/8` times
//! that bound of the values at the ends. What counts is the peak, the largest size: accelerations
//! are tracked without the slope's pull. Pieces whose bound exceeds the peak attained so far
//! are kept; what is still in question at the end, or when too many have gathered, is looked at
//! by its Taylor polynomial.

use super::excitation::{Excitation, Stretch};
use crate::linear::polynomial::{DEGREE, largest};
use crate::linear::{MAX_RATE_STEP, PerStorey, Series, State, System};
use crate::model::Model;
use crate::response::Mode;

/// Order of the tracked quantities: six of the system, then three groups of one a storey.
pub(super) mod tracked {
    /// `ṡ` in m/s.
    pub(in crate::solver) const VELOCITY: usize = 0;
    /// `u = s̈ + a` less the slope's pull in m/s².
    pub(in crate::solver) const BLOCK: usize = 1;
    /// `T − K1 s − C1 ṡ` in N.
    pub(in crate::solver) const SLIDER: usize = 2;
    /// `T` in N.
    pub(in crate::solver) const FRICTION: usize = 3;
    /// `L·f` in N.
    pub(in crate::solver) const BASE_SHEAR: usize = 4;
    /// Overturning moment about the sliding surface in N m.
    pub(in crate::solver) const OVERTURNING: usize = 5;
    /// Storey displacements, then drifts, then accelerations `−Φ_i f` less the slope's pull.
    pub(in crate::solver) const STOREYS: usize = 6;
}

/// Most pieces in question that are kept before they are looked at.
const ROOM: usize = 48;

/// The values of the tracked quantities, their bounds and what has been attained.
pub(super) struct Extremes<V: PerStorey> {
    /// `Φᵀ z`, the floors' masses times their heights, and half the block's.
    arm: Option<(V, f64)>,
    stick_norm: V::Tracked,
    slip_norm: V::Tracked,
    /// `g sin θ`.
    slope: f64,
    pub(super) peak: V::Tracked,
    pieces: Vec<Piece<V>>,
}

/// A piece of motion that may hold an extreme.
struct Piece<V: PerStorey> {
    stretch: Stretch,
    from_s: f64,
    length_s: f64,
    mode: Mode,
    state: State<V>,
    above: V::Tracked,
}

/// Sizes within which the values at the ends of a piece must lie for it to be dismissed.
pub(super) struct Limits<V: PerStorey> {
    within: V::Tracked,
    slope: f64,
}

impl<V: PerStorey> Limits<V> {
    /// Limits for friction force and acceleration of the block in stick, where the slider takes
    /// the friction force less `spring_n`.
    #[inline(always)]
    pub(super) fn stick(&self, spring_n: f64) -> StickLimits {
        let within = self.within.as_ref();
        let (friction, slider) = (within[tracked::FRICTION], within[tracked::SLIDER]);
        let block = within[tracked::BLOCK];
        StickLimits {
            friction_n: [(spring_n - slider).max(-friction), (spring_n + slider).min(friction)],
            acceleration: [self.slope - block, self.slope + block],
        }
    }

    /// Whether all values keep the limits.
    #[inline(always)]
    pub(super) fn hold(&self, values: &V::Tracked) -> bool {
        self.hold_but::<false>(values)
    }

    /// Whether all values, or all but those of [`StickLimits`], keep the limits.
    #[inline(always)]
    pub(super) fn hold_but<const STICK: bool>(&self, values: &V::Tracked) -> bool {
        let (within, y) = (self.within.as_ref(), values.as_ref());
        // One storey's drift is its displacement, and on the level its acceleration goes with the
        // base shear.
        let one_storey = y.len() == tracked::STOREYS + 3;
        let level = self.slope == 0.0;
        // Left at the first: in one go the compiler would gather into vectors what has just been
        // stored one by one, and wait for the stores.
        for j in 0..y.len() {
            let redundant = (level && j == tracked::BASE_SHEAR) || j == tracked::STOREYS + 1;
            let elsewhere = STICK && (tracked::BLOCK..=tracked::FRICTION).contains(&j);
            if elsewhere || (one_storey && redundant) {
                continue;
            }
            if !(y[j].abs() <= within[j]) {
                return false;
            }
        }
        true
    }
}

/// [`Limits`] of the values that in stick have kinks where the load has.
#[derive(Clone, Copy)]
pub(super) struct StickLimits {
    friction_n: [f64; 2],
    acceleration: [f64; 2],
}

impl StickLimits {
    /// Whether the values at an instant keep the limits.
    #[inline(always)]
    pub(super) fn hold(&self, friction_n: f64, acceleration: f64) -> bool {
        let inside = |x: f64, [below, above]: [f64; 2]| below <= x && x <= above;
        inside(friction_n, self.friction_n) && inside(acceleration, self.acceleration)
    }
}

/// Where a piece of motion lies, for a second look.
pub(super) struct Place<'a, V: PerStorey> {
    pub(super) interval: usize,
    pub(super) from_s: f64,
    pub(super) length_s: f64,
    pub(super) mode: Mode,
    pub(super) state: &'a State<V>,
}

impl<V: PerStorey> Extremes<V> {
    pub(super) fn new(model: &Model, system: &System<V>) -> Self {
        let n = system.storeys();
        let arm = overturning_arm(model, system);
        let mut extremes = Self {
            arm,
            stick_norm: V::tracked(n, 0.0),
            slip_norm: V::tracked(n, 0.0),
            slope: model.slope_m_per_s2(),
            peak: V::tracked(n, 0.0),
            pieces: Vec::new(),
        };
        extremes.set_norms(model, system);
        extremes
    }

    /// Of a system on the level, without an overturning moment, before anything has happened.
    #[cfg(test)]
    pub(super) fn untold(system: &System<V>) -> Self {
        let n = system.storeys();
        Self {
            arm: None,
            stick_norm: V::tracked(n, 0.0),
            slip_norm: V::tracked(n, 0.0),
            slope: 0.0,
            peak: V::tracked(n, 0.0),
            pieces: Vec::new(),
        }
    }

    /// `g sin θ` in m/s².
    pub(super) fn slope(&self) -> f64 {
        self.slope
    }

    /// What `f` of one storey and the block's acceleration add to the overturning moment; zeros
    /// where it is not tracked.
    pub(super) fn one_storey_arm(&self) -> [f64; 2] {
        self.arm
            .as_ref()
            .map_or([0.0; 2], |(arm, half)| [arm.as_ref().first().copied().unwrap_or(0.0), *half])
    }

    /// Whether the overturning moment is tracked.
    pub(super) fn overturns(&self) -> bool {
        self.arm.is_some()
    }

    fn set_norms(&mut self, model: &Model, system: &System<V>) {
        let n = system.storeys();
        let (mass, k1, c1) =
            (system.block_mass_kg, system.stiffness_n_per_m, system.damper_n_s_per_m);
        let l = system.participation.clone();
        let over_mass = |x: &V| {
            let mut x = x.clone();
            x.as_mut().iter_mut().for_each(|x| *x /= mass);
            x
        };
        let (zero, drag) = (V::zeros(n), system.drag(l.as_ref()));
        let shear = system.dual_norm(0.0, 0.0, l.as_ref(), drag.as_ref());
        let block = system.dual_norm(
            -k1 / mass,
            -c1 / mass,
            over_mass(&l).as_ref(),
            over_mass(&drag).as_ref(),
        );
        let moment = self.arm.as_ref().map_or([0.0; 2], |(arm, half)| {
            let of_floors =
                system.dual_norm(0.0, 0.0, arm.as_ref(), system.drag(arm.as_ref()).as_ref());
            [of_floors, of_floors + half * block]
        });
        let (slip, stick) = (self.slip_norm.as_mut(), self.stick_norm.as_mut());
        slip[tracked::VELOCITY] = 1.0 / mass.sqrt();
        slip[tracked::BLOCK] = block;
        slip[tracked::SLIDER] = system.dual_norm(-k1, -c1, zero.as_ref(), zero.as_ref());
        stick[tracked::SLIDER] = shear;
        stick[tracked::FRICTION] = shear;
        stick[tracked::BASE_SHEAR] = shear;
        slip[tracked::BASE_SHEAR] = shear;
        [stick[tracked::OVERTURNING], slip[tracked::OVERTURNING]] = moment;
        let mut flexibility = 0.0;
        for i in 0..n {
            let storey = 1.0 / model.frame().stiffnesses_n_per_m[i];
            flexibility += storey;
            let row = system.floor(i);
            let drag = system.drag(row.as_ref());
            let acceleration = system.dual_norm(0.0, 0.0, row.as_ref(), drag.as_ref());
            for norm in [&mut *slip, &mut *stick] {
                norm[tracked::STOREYS + i] = flexibility.sqrt();
                norm[tracked::STOREYS + n + i] = storey.sqrt();
                norm[tracked::STOREYS + 2 * n + i] = acceleration;
            }
        }
    }

    /// Dual norm of what ends a mode: the demand in stick, the sliding velocity in slip.
    pub(super) fn event_norm(&self, mode: Mode) -> f64 {
        match mode {
            Mode::Stick => self.stick_norm.as_ref()[tracked::FRICTION],
            Mode::Slip(_) => self.slip_norm.as_ref()[tracked::VELOCITY],
        }
    }

    /// Values of the tracked quantities in a state.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)] // the letters of the equations
    pub(super) fn values(
        &self,
        system: &System<V>,
        s: f64,
        w: f64,
        eta: &[f64],
        f: &[f64],
        shear: f64,
        u: f64,
        friction: f64,
    ) -> V::Tracked {
        self.linear(system, s, w, eta, f, shear, [u, self.slope], friction)
    }

    /// The same coefficient by coefficient in a series; the slope counts in the first alone.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)] // the letters of the equations
    fn linear(
        &self,
        system: &System<V>,
        s: f64,
        w: f64,
        eta: &[f64],
        f: &[f64],
        shear: f64,
        [u, slope]: [f64; 2],
        friction: f64,
    ) -> V::Tracked {
        let n = eta.len();
        let mut out = V::tracked(n, 0.0);
        let y = out.as_mut();
        y[tracked::VELOCITY] = w;
        y[tracked::BLOCK] = u - slope;
        y[tracked::SLIDER] = friction - system.stiffness_n_per_m * s - system.damper_n_s_per_m * w;
        y[tracked::FRICTION] = friction;
        y[tracked::BASE_SHEAR] = shear;
        let (q, rest) = y[tracked::STOREYS..].split_at_mut(n);
        let (drift, acceleration) = rest.split_at_mut(n);
        system.floors(eta, q);
        system.floors(f, acceleration);
        let mut below = 0.0;
        for i in 0..n {
            drift[i] = q[i] - below;
            below = q[i];
            acceleration[i] = -acceleration[i] - slope;
        }
        if let Some((arm, half)) = &self.arm {
            let floors = arm.as_ref().iter().zip(f).fold(0.0, |sum, (arm, f)| sum - arm * f);
            y[tracked::OVERTURNING] = floors + half * u;
        }
        out
    }

    /// Limits for the values at both ends of a piece, `reach` being `length²/8` times the norm of
    /// `ẍ`: where they hold, the piece holds no more than has been attained.
    #[inline(always)]
    pub(super) fn limits(&self, reach: f64, mode: Mode) -> Limits<V> {
        let norm = match mode {
            Mode::Stick => &self.stick_norm,
            Mode::Slip(_) => &self.slip_norm,
        };
        let mut limits: Limits<V> = Limits { within: self.peak.clone(), slope: self.slope };
        for (within, norm) in limits.within.as_mut().iter_mut().zip(norm.as_ref()) {
            *within -= reach * norm;
        }
        limits
    }

    /// Takes the values at an instant.
    pub(super) fn attain(&mut self, values: &V::Tracked) {
        for (peak, value) in self.peak.as_mut().iter_mut().zip(values.as_ref()) {
            *peak = if value.abs() > *peak { value.abs() } else { *peak };
        }
    }

    /// Takes the values at both ends of a piece for certain; whether it may hold more, `reach`
    /// being `length²/8` times the norm of `ẍ`.
    #[inline(always)]
    pub(super) fn take(
        &mut self,
        start: &V::Tracked,
        end: &V::Tracked,
        reach: f64,
        mode: Mode,
    ) -> bool {
        let norm = match mode {
            Mode::Stick => &self.stick_norm,
            Mode::Slip(_) => &self.slip_norm,
        };
        let (start, end, norm) = (start.as_ref(), end.as_ref(), norm.as_ref());
        let peak = self.peak.as_mut();
        let mut open = false;
        for j in 0..start.len() {
            let slack = reach * norm[j];
            let attained = larger(start[j].abs(), end[j].abs());
            if attained + slack > peak[j] {
                peak[j] = larger(peak[j], attained);
                open |= bound([start[j], end[j]], slack) > peak[j];
            }
        }
        open
    }

    /// Keeps a piece that may hold more than its ends.
    #[inline(never)]
    pub(super) fn keep(
        &mut self,
        system: &System<V>,
        excitation: &Excitation<'_>,
        start: &V::Tracked,
        end: &V::Tracked,
        reach: f64,
        place: &Place<'_, V>,
    ) {
        let norm = match place.mode {
            Mode::Stick => &self.stick_norm,
            Mode::Slip(_) => &self.slip_norm,
        };
        let mut above = start.clone();
        for (j, norm) in norm.as_ref().iter().enumerate() {
            above.as_mut()[j] = bound([start.as_ref()[j], end.as_ref()[j]], reach * norm);
        }
        if self.pieces.len() == ROOM {
            self.drop_overtaken();
            if self.pieces.len() > ROOM / 2 {
                self.settle(system, excitation);
            }
        }
        self.pieces.push(Piece {
            stretch: excitation.stretch(
                place.interval,
                place.from_s,
                place.from_s + place.length_s,
            ),
            from_s: place.from_s,
            length_s: place.length_s,
            mode: place.mode,
            state: place.state.clone(),
            above,
        });
    }

    fn drop_overtaken(&mut self) {
        let peak = self.peak.as_ref();
        self.pieces.retain(|piece| {
            piece.above.as_ref().iter().zip(peak).any(|(above, peak)| above > peak)
        });
    }

    /// Looks at all pieces still in question.
    pub(super) fn settle(&mut self, system: &System<V>, excitation: &Excitation<'_>) {
        self.drop_overtaken();
        for piece in core::mem::take(&mut self.pieces) {
            self.look_at(system, excitation, &piece);
        }
    }

    fn look_at(&mut self, system: &System<V>, excitation: &Excitation<'_>, piece: &Piece<V>) {
        let in_question = |peak: &V::Tracked, j: usize| piece.above.as_ref()[j] > peak.as_ref()[j];
        let tracked = self.peak.as_ref().len();
        if !(0..tracked).any(|j| in_question(&self.peak, j)) {
            return;
        }
        let (rate, direction) = match piece.mode {
            Mode::Stick => (system.stick_rate_rad_per_s, None),
            Mode::Slip(direction) => (system.slip_rate_rad_per_s, Some(direction)),
        };
        let parts = (rate * piece.length_s / MAX_RATE_STEP).ceil().max(1.0);
        let length_s = piece.length_s / parts;
        let (mut series, mut state) = (Series::zeros(system.storeys()), piece.state.clone());
        for part in 0..parts as usize {
            let from_s = piece.from_s + length_s * part as f64;
            let load = excitation.load(&piece.stretch, from_s, length_s, direction);
            let mut friction = [0.0; DEGREE + 1];
            if direction.is_some() {
                series.slip(system, &state, &load, length_s);
                (friction[0], friction[1]) = (load.friction, load.friction_change);
            } else {
                series.stick(system, &state, &load, length_s);
                friction = series.demand(system, &load);
            }
            let coefficients: [V::Tracked; DEGREE + 1] = core::array::from_fn(|k| {
                let (eta, f) = (series.eta[k].as_ref(), series.f[k].as_ref());
                let shear = system.base_shear_n(f);
                let (s, w) = (series.s[k], series.w[k]);
                let u = match (direction, k) {
                    (Some(_), _) => system.block_acceleration(s, w, shear, friction[k]),
                    (None, 0) => load.acceleration,
                    (None, 1) => load.acceleration_change,
                    (None, _) => 0.0,
                };
                let slope = if k == 0 { self.slope } else { 0.0 };
                self.linear(system, s, w, eta, f, shear, [u, slope], friction[k])
            });
            for j in 0..tracked {
                if in_question(&self.peak, j) {
                    let c = core::array::from_fn(|k| coefficients[k].as_ref()[j]);
                    let peak = &mut self.peak.as_mut()[j];
                    *peak = largest(&c.map(|c| -c), largest(&c, *peak));
                }
            }
            series.state_at(1.0, &mut state);
        }
    }
}

/// Bound on the size of a value over a piece from the values at its ends: with `slack` the error
/// of the chord, an extreme lies inside only where they are less than four times that apart.
#[inline(always)]
fn bound([a, b]: [f64; 2], slack: f64) -> f64 {
    let attained = larger(a.abs(), b.abs());
    let inside = slack - 0.25 * (a - b).abs();
    let bulge = if inside > 0.0 { inside * (inside / slack) } else { 0.0 };
    // A few ulp are no more than the rounding of the ends.
    attained + if bulge > 1e-15 * attained { bulge } else { 0.0 }
}

#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if b > a { b } else { a }
}

/// Moment arms of the floors' and the block's inertia, where width and heights are given.
fn overturning_arm<V: PerStorey>(model: &Model, system: &System<V>) -> Option<(V, f64)> {
    let (block, frame) = (model.block(), model.frame());
    block.width_m?;
    let n = system.storeys();
    let block_height_m = block.height_m.unwrap_or(0.0);
    let heights_m = match &frame.heights_m {
        Some(heights_m) => heights_m.as_slice(),
        None if n == 0 && block.height_m.is_some() => &[],
        None => return None,
    };
    let mut arm = V::zeros(n);
    let mut above_m = block_height_m;
    for (i, height_m) in heights_m.iter().enumerate() {
        above_m += height_m;
        for (j, arm) in arm.as_mut().iter_mut().enumerate() {
            *arm += frame.masses_kg[i] * above_m * system.shapes.as_ref()[i + j * n];
        }
    }
    Some((arm, 0.5 * block_height_m * block.mass_kg))
}
