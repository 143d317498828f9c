//! What is in force between ground and block on a branch of a law, and where the branch ends.

use super::rate::Coefficient;
use super::{Contact, Direction, Pressing};
use crate::linear::polynomial::Polynomial;

/// A stiffness and a damper between ground and block.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Restraint {
    /// `k` in N/m.
    pub(crate) stiffness_n_per_m: f64,
    /// `c` in N s/m.
    pub(crate) damper_n_s_per_m: f64,
}

/// The force on the ground while the block slides:
/// `F = force + k s + c ṡ + N (of_normal + of_normal_s s) + σ μ(|ṡ|) N`, or by what friction follows in place of the last
/// `N`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SlipForce {
    /// `k` and `c`.
    pub(crate) restraint: Restraint,
    /// Whether a stop is pressed.
    pub(crate) is_pressed: bool,
    /// Constant part in N.
    pub(crate) force_n: f64,
    /// Constant part over the normal force.
    pub(crate) of_normal: f64,
    /// Stiffness over the normal force in 1/m.
    pub(crate) of_normal_s: f64,
    /// Whether these two count as friction: of surfaces in series, whose springs memory mixes with it.
    pub(crate) is_friction: bool,
    /// `σ`.
    pub(crate) sign: f64,
    /// `μ`.
    pub(crate) coefficient: Coefficient,
    /// The normal force that friction follows in place of `N`.
    pub(crate) pressing: Pressing,
}

/// What a branch adds to the linear system, by which its tables are found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Restraints {
    /// `k` and `c` of all.
    pub(crate) all: Restraint,
    /// What of them counts as friction.
    pub(crate) of_friction: Restraint,
    /// Whether a stop is pressed.
    pub(crate) is_pressed: bool,
}

/// The force of a branch under a constant normal force, affine but perhaps for what fades:
/// `F = force + k s + c ṡ + coefficient N − fading`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Affine {
    /// `k` and `c`.
    pub(crate) restraints: Restraints,
    /// Constant part in N.
    pub(crate) force_n: f64,
    /// Constant part over the normal force, which is friction.
    pub(crate) coefficient: f64,
    /// What exponential friction lacks of that at high speed.
    pub(crate) fading: Option<Fading>,
}

/// A force that fades with the speed: `force e^(−rate σ ṡ)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Fading {
    /// At rest in N, positive towards +x.
    pub(crate) force_n: f64,
    /// Rate in s/m, with the sign `σ` of the velocity.
    pub(crate) rate_s_per_m: f64,
}

impl Fading {
    /// The force at a velocity, in N.
    #[inline(always)]
    pub(crate) fn at(&self, w: f64) -> f64 {
        self.force_n * libm::exp(-self.rate_s_per_m * w)
    }
}

/// The end of a branch other than `ṡ = 0`: where `of_s s + of_w ṡ + constant`, positive within the
/// branch, reaches zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Exit {
    /// Factor of `s`.
    pub(crate) of_s: f64,
    /// Factor of `ṡ`; 0 where the exit is a level of `s`, which is monotone while the block slides.
    pub(crate) of_w: f64,
    /// Constant part.
    pub(crate) constant: f64,
    /// What is reached there.
    pub(crate) reached: BranchEnd,
}

/// Most exits of a branch.
pub(crate) const EXITS: usize = 4;

/// What is reached where a branch ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum BranchEnd {
    /// The elastic stop changes its contact; at this `s`, where that is a level.
    Contact(Contact, Option<f64>),
    /// A rigid stop on a side, at this `s`.
    Wall(Direction, f64),
    /// Another surface joins or one leaves, at this `s`.
    Surface(f64),
    /// A knot of the rate law, this speed, and the piece beyond.
    Knot(f64, usize),
}

/// The forces of a law that has but two branches, towards +x and −x, in N.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TwoBranches {
    /// `−μ_s⁺ N` and `μ_s⁻ N`.
    pub(crate) bounds_n: [f64; 2],
    /// `−μ_k⁺ N` and `μ_k⁻ N`.
    pub(crate) kinetic_n: [f64; 2],
}

impl BranchEnd {
    /// `s` and `ṡ` where it is reached in a direction, of which one is known, from both as computed.
    #[inline(always)]
    pub(crate) fn place(&self, direction: Direction, [s, w]: [f64; 2]) -> [f64; 2] {
        match *self {
            Self::Contact(_, level_m) => [level_m.unwrap_or(s), w],
            Self::Wall(_, level_m) | Self::Surface(level_m) => [level_m, w],
            Self::Knot(speed, _) => [s, direction.sign() * speed],
        }
    }
}

impl Exit {
    /// Its value in a state; the branch lasts while it is positive.
    #[inline(always)]
    pub(crate) fn value(&self, s: f64, w: f64) -> f64 {
        (self.of_s * s + self.of_w * w) + self.constant
    }
}

impl SlipForce {
    /// Coefficient of an order of `N (of_normal + of_normal_s s)`, from those of `s` up to it and both of `N`.
    #[inline(always)]
    pub(crate) fn of_normal_of_order(&self, k: usize, [n0, n1]: [f64; 2], s: &Polynomial) -> f64 {
        let [p0, p1] = [self.of_normal, self.of_normal_s];
        let first = if k == 0 { 1.0 } else { 0.0 };
        let second = if k == 1 { p0 } else { 0.0 };
        n0 * (p0 * first + p1 * s[k]) + if k > 0 { n1 * (second + p1 * s[k - 1]) } else { 0.0 }
    }

    /// The force under a constant normal force, as tables take it.
    #[inline(always)]
    pub(crate) fn affine(&self, normal_n: f64) -> Affine {
        let (at_rest, slope_s_per_m, fading) = match self.coefficient {
            Coefficient::Linear { at_rest, slope_s_per_m } => (at_rest, slope_s_per_m, None),
            Coefficient::Exponential { fast, drop, rate_s_per_m } => {
                let force_n = self.sign * drop * normal_n;
                let rate_s_per_m = self.sign * rate_s_per_m;
                (fast, 0.0, Some(Fading { force_n, rate_s_per_m }))
            }
        };
        let (mut all, mut of_friction) = (self.restraint, Restraint::default());
        let mut coefficient = self.sign * at_rest;
        if self.is_friction {
            coefficient = self.of_normal;
            of_friction.stiffness_n_per_m = self.of_normal_s * normal_n;
            all.stiffness_n_per_m += of_friction.stiffness_n_per_m;
        } else {
            all.stiffness_n_per_m += self.of_normal_s * normal_n;
        }
        if slope_s_per_m != 0.0 {
            of_friction.damper_n_s_per_m = slope_s_per_m * normal_n;
            all.damper_n_s_per_m += of_friction.damper_n_s_per_m;
        }
        let restraints = Restraints { all, of_friction, is_pressed: self.is_pressed };
        Affine { restraints, force_n: self.force_n, coefficient, fading }
    }
}
