//! The equations of motion in one direction, eqs (9), (10), with all forces and outputs, at some instants of a step.
//!
//! With `a = Ü + g sin θ`, the block's acceleration `B = s̈ + a` and what contents that slide do to their floors,
//! `p = sgn(ṙ) μ_k m N/M`:
//!
//! ```text
//! block     M1 B = T + 1ᵀ(K q + C q̇) + Σ p − (K1 + N/R) s − C1 ṡ − (k s + c ṡ − shift)      in stick B = a
//! floors    M (q̈ + 1 B) = −(K q + C q̇) + p
//! contents  m (r̈ + acceleration of the floor) = −p; where they stick, their mass is the floor's
//! slip      T = N (p₀ − p₁ s − p₂ ṡ), or N p₀ μ(|ṡ|); by pressure of N (N/N₀)^(−m) in place of N
//! stick     T = M1 a − 1ᵀ(K q + C q̇) − Σ p + (K1 + N/R) s + k s − shift                      eqs (8), (14)
//! ```
//!
//! `k`, `c` and the shift are those of an elastic stop that is pressed, `p₁` is of surfaces in series, `N/R` of a pendulum
//! under vertical motion. But for friction by speed all is affine, with numbers that are constant or linear in time.

use super::super::collocation::{Column, add};
use super::super::law::Law;
use super::super::outputs::Outputs;
use super::super::structure::Structure;
use crate::response::Mode;

/// Places in the loads of a step: `a`, `N p₀` in a slip, the shift of the stop, and from there on the pulls of contents
/// over their masses.
pub(super) const TABLE: usize = 0;
pub(super) const FRICTION_LOAD: usize = 1;
pub(super) const SHIFT: usize = 2;
pub(super) const PULLS: usize = 3;

/// What is in force in a step, and the loads that drive it.
#[derive(Clone)]
pub(super) struct Drive<'a> {
    pub(super) modes: &'a [Mode],
    /// Loads at the start and at the end, between which they are linear.
    pub(super) loads: Vec<[f64; 2]>,
    /// Stiffness and damper of an elastic stop that is pressed.
    pub(super) stop: [f64; 2],
    /// `N p₁ + N/R` at the start and at the end.
    pub(super) rise: [f64; 2],
    /// `N p₂` where friction by speed is in a straight piece.
    pub(super) drag: f64,
    /// Whether `T` is `N p₀ μ(|ṡ|)`.
    pub(super) by_speed: bool,
    /// `N`, likewise, and `p₀`.
    pub(super) normal: [f64; 2],
    pub(super) friction: f64,
    /// Least and largest demand over the normal force that friction takes; a rigid stop takes the rest.
    pub(super) taken: [f64; 2],
}

impl Drive<'_> {
    pub(super) fn sticks(&self, interface: usize) -> bool {
        self.modes[interface] == Mode::Stick
    }

    /// A load at parts of the step.
    #[inline(always)]
    fn load<const N: usize>(&self, load: usize, parts: &Column<N>) -> Column<N> {
        linear(self.loads[load], parts)
    }
}

/// What goes linearly from one value to another, at parts of the way.
#[inline(always)]
pub(super) fn linear<const N: usize>([from, to]: [f64; 2], parts: &Column<N>) -> Column<N> {
    parts.map(|part| from + (to - from) * part)
}

/// What acts at some instants.
pub(super) struct LineForces<const N: usize> {
    /// Accelerations of the block, the floors and the contents, with the slope's share.
    pub(super) bodies: Vec<Column<N>>,
    /// `C q̇`.
    pub(super) viscous: Vec<Column<N>>,
    /// `T`; in stick the demand.
    pub(super) friction: Column<N>,
    /// `T` in a slip, but for what follows `s`.
    pub(super) sliding: Column<N>,
    /// `1ᵀ (K q + C q̇)`.
    pub(super) shear: Column<N>,
    /// `N p₁ + N/R`.
    pub(super) rise: Column<N>,
}

impl<const N: usize> LineForces<N> {
    /// Room for a structure.
    pub(super) fn new(structure: &Structure) -> Self {
        Self {
            bodies: vec![[0.0; N]; structure.degrees()],
            viscous: vec![[0.0; N]; structure.masses_kg.len()],
            friction: [0.0; N],
            sliding: [0.0; N],
            shear: [0.0; N],
            rise: [0.0; N],
        }
    }
}

/// Masses, springs, dampers and laws in one direction.
#[derive(Clone, Copy)]
pub(super) struct LineEquations<'a> {
    pub(super) structure: &'a Structure,
    pub(super) law: &'a Law,
    /// `g sin θ`.
    pub(super) slope: f64,
}

impl LineEquations<'_> {
    /// How many loads a step has.
    pub(super) fn loads(&self) -> usize {
        PULLS + self.structure.contents.len()
    }

    /// Mass of the block (0) or of a floor with what sticks to it.
    #[inline(always)]
    pub(super) fn mass(&self, drive: &Drive<'_>, floor: usize) -> f64 {
        let s = self.structure;
        let own = floor.checked_sub(1).map_or(s.block_kg, |floor| s.masses_kg[floor]);
        let stuck = s.contents.iter().enumerate().filter(|(e, _)| drive.sticks(1 + e));
        stuck.filter(|(_, c)| c.floor == floor).fold(own, |sum, (_, c)| sum + c.mass_kg)
    }

    /// `T` in a slip, but for what follows `s`.
    #[inline(always)]
    pub(super) fn sliding(&self, drive: &Drive<'_>, load: f64, w: f64) -> f64 {
        match &self.law.rate {
            Some(rate) if drive.by_speed => load * rate.coefficient(w.abs()),
            _ => load - drive.drag * w,
        }
    }

    /// `T` in a slip at the start (0) or the end (1), of `s` and `ṡ`.
    pub(super) fn stored_sliding(&self, drive: &Drive<'_>, end: usize, [s, w]: [f64; 2]) -> f64 {
        let follows = if self.law.series.is_some() { drive.rise[end] * s } else { 0.0 };
        self.sliding(drive, drive.loads[FRICTION_LOAD][end], w) - follows
    }

    /// What coefficients of friction are multiplied by, at parts of the step.
    #[inline(always)]
    fn pressed<const N: usize>(&self, drive: &Drive<'_>, parts: &Column<N>) -> Column<N> {
        linear(drive.normal, parts).map(|normal| self.law.pressed(normal))
    }

    /// `T` in a slip at some instants, but for what follows `s`.
    #[inline(always)]
    fn sliding_forces<const N: usize>(
        &self,
        drive: &Drive<'_>,
        parts: &Column<N>,
        w: &Column<N>,
    ) -> Column<N> {
        let mut force = match self.law.follows_pressure() {
            true => self.pressed(drive, parts).map(|pressed| drive.friction * pressed),
            false => drive.load(FRICTION_LOAD, parts),
        };
        if drive.by_speed || drive.drag != 0.0 {
            force = core::array::from_fn(|i| self.sliding(drive, force[i], w[i]));
        }
        force
    }

    /// All that acts in states under what drives them.
    #[inline(always)]
    pub(super) fn act<const N: usize>(
        &self,
        drive: &Drive<'_>,
        parts: &Column<N>,
        [x, v]: [&[Column<N>]; 2],
        to: &mut LineForces<N>,
    ) {
        let s = self.structure;
        let n = s.masses_kg.len();
        let (a, shift) = (drive.load(TABLE, parts), drive.load(SHIFT, parts));
        let (rise, sliding) = (linear(drive.rise, parts), self.sliding_forces(drive, parts, &v[0]));
        let shear = s.base_shear(&x[1..=n], &v[1..=n]);
        let LineForces { bodies, viscous, .. } = to;
        viscous.fill([0.0; N]);
        s.add_viscous(&v[1..=n], viscous);
        bodies[1..=n].copy_from_slice(viscous);
        s.add_elastic(&x[1..=n], &mut bodies[1..=n]);
        // What the structure and contents that slide do to the block.
        let mut pushed = shear;
        for (e, contents) in s.contents.iter().enumerate() {
            let pull = drive.load(PULLS + e, parts);
            match contents.floor {
                0 => add(&mut pushed, contents.mass_kg, &pull),
                floor => add(&mut bodies[floor], -contents.mass_kg, &pull),
            }
        }
        for floor in 1..=n {
            let per_kg = 1.0 / self.mass(drive, floor);
            bodies[floor] = bodies[floor].map(|force| -(force * per_kg));
        }
        let (mass, sticks) = (self.mass(drive, 0), drive.sticks(0));
        let in_series = self.law.series.is_some();
        let (per_kg, damper) = (1.0 / mass, s.damper + drive.stop[1]);
        for i in 0..N {
            let spring = (s.spring + drive.stop[0] + rise[i]) * x[0][i];
            let slides = sliding[i] + shift[i] - damper * v[0][i] - spring + pushed[i];
            bodies[0][i] = if sticks { a[i] } else { slides * per_kg };
            let held = mass * a[i] - pushed[i] + spring - shift[i];
            let follows = if in_series { rise[i] * x[0][i] } else { 0.0 };
            to.friction[i] = if sticks { held } else { sliding[i] - follows };
        }
        for (e, contents) in s.contents.iter().enumerate() {
            bodies[1 + n + e] = match drive.sticks(1 + e) {
                true => bodies[contents.floor],
                false => drive.load(PULLS + e, parts).map(|pull| -pull),
            };
        }
        (to.sliding, to.shear, to.rise) = (sliding, shear, rise);
    }

    /// `ẍ` of a degree from the accelerations of all bodies.
    #[inline(always)]
    pub(super) fn rate<const N: usize>(
        &self,
        degree: usize,
        a: &Column<N>,
        bodies: &[Column<N>],
    ) -> Column<N> {
        let n = self.structure.masses_kg.len();
        let under = match degree {
            0 => a,
            k if k <= n => &bodies[0],
            k => &bodies[self.structure.contents[k - 1 - n].floor],
        };
        core::array::from_fn(|i| bodies[degree][i] - under[i])
    }

    /// All outputs from state, accelerations and forces: what cancels in them is nothing. Against a rigid stop friction
    /// takes what it can of the demand, the stop the rest.
    #[inline(always)]
    pub(super) fn outputs<const N: usize>(
        &self,
        outputs: &Outputs,
        (drive, parts): (&Drive<'_>, &Column<N>),
        [x, v]: [&[Column<N>]; 2],
        acting: &LineForces<N>,
        out: &mut [Column<N>],
    ) {
        let (s, bodies) = (self.structure, &acting.bodies);
        let n = s.masses_kg.len();
        let shift = drive.load(SHIFT, parts);
        let (is_rigid, in_series) = (self.law.restitution().is_some(), self.law.series.is_some());
        let (mut stop, mut slider, mut friction) = ([0.0; N], [0.0; N], acting.friction);
        for i in 0..N {
            let restoring = if in_series { 0.0 } else { acting.rise[i] };
            stop[i] = drive.stop[0] * x[0][i] + drive.stop[1] * v[0][i] - shift[i];
            slider[i] =
                friction[i] - (s.spring + restoring) * x[0][i] - s.damper * v[0][i] - stop[i];
        }
        if is_rigid {
            let ([least, most], pressed) = (drive.taken, self.pressed(drive, parts));
            for i in 0..N {
                friction[i] = friction[i].max(least * pressed[i]).min(most * pressed[i]);
                stop[i] += friction[i] - acting.friction[i];
            }
        }
        outputs.each(
            [&v[0], &slider, &friction, &acting.shear, &stop],
            (self.slope, &bodies[0]),
            |point| outputs.point(point, &bodies[0], |j| [x[1 + j], v[1 + j], bodies[1 + j]]),
            |e| [v[1 + n + e], bodies[1 + n + e]],
            |g, value| out[g] = value,
        );
    }
}
