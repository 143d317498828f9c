//! The slider: the one force between ground and block.
//!
//! A [`Slider`] is one surface with its [`Friction`] and what draws the block back, or surfaces in
//! series ([`SurfacesInSeries`]); beside them a damper, and at the ends of the travel nothing or a
//! [`Stop`]. It cannot hold what no slider has. Its law (`law`) says what is in force, where that ends,
//! what holds at rest and what follows; nothing else knows one kind of slider from another.

mod branch;
mod friction;
mod hold;
mod isotropic;
mod law;
mod pressure;
pub(crate) mod ranges;
mod rate;
mod ring;
mod series;
mod stop;

pub(crate) use branch::{Affine, BranchEnd, EXITS, Exit, Fading, TwoBranches};
pub(crate) use branch::{Restraint, Restraints, SlipForce};
pub use friction::Friction;
pub(crate) use hold::{Disc, Hold};
pub(crate) use isotropic::IsotropicFriction;
pub(crate) use law::{Law, Memory};
pub(crate) use pressure::Pressing;
pub use pressure::PressureLaw;
pub(crate) use rate::Coefficient;
pub use rate::{RateCurve, RateLaw};
pub(crate) use ring::Ring;
pub use series::{Surface, SurfacesInSeries};
pub use stop::{Contact, Stop, StopKind};

use self::ranges::{in_range, not_negative, optional_positive, positive};
use crate::error::ModelError;

/// Direction of sliding along x.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Towards +x: the sliding velocity is positive.
    Positive,
    /// Towards −x.
    Negative,
}

impl Direction {
    /// Towards +x, then towards −x: the order of pairs of numbers by direction.
    pub const BOTH: [Self; 2] = [Self::Positive, Self::Negative];

    /// +1 or −1.
    #[must_use]
    pub fn sign(self) -> f64 {
        match self {
            Self::Positive => 1.0,
            Self::Negative => -1.0,
        }
    }

    /// The other one.
    #[must_use]
    pub fn opposite(self) -> Self {
        match self {
            Self::Positive => Self::Negative,
            Self::Negative => Self::Positive,
        }
    }

    /// That of a pair by direction which belongs to this one.
    #[inline(always)]
    #[must_use]
    pub fn of<T>(self, [positive, negative]: [T; 2]) -> T {
        match self {
            Self::Positive => positive,
            Self::Negative => negative,
        }
    }
}

/// The bearing between table and block.
///
/// # Examples
/// ```
/// use slipstick_dynamics::slider::{Friction, Slider, Stop};
///
/// let friction = Friction::new(0.06, 0.05)?;
/// let stop = Stop::rigid([Some(0.15); 2], 0.5);
/// let slider = Slider { ends: stop.into(), ..Slider::pendulum(friction, 2.0) };
/// assert_eq!(slider.stiffness_n_per_m(4000.0), 2000.0);
/// # Ok::<(), slipstick_dynamics::error::ModelError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Slider {
    /// What the block slides on.
    pub bearing: Bearing,
    /// Damper `C1` between table and block in N s/m, 0 without one.
    pub damper_n_s_per_m: f64,
    /// Tilt of the surface in rad, positive uphill towards +x: the angle that its x axis makes with the horizontal.
    pub tilt_rad: f64,
    /// Angle of the y axis of the surface with the horizontal, uphill towards +y.
    pub tilt_y_rad: f64,
    /// What is at the ends of its travel.
    pub ends: Ends,
}

/// What the block slides on.
#[derive(Clone, Debug, PartialEq)]
pub enum Bearing {
    /// One surface.
    Surface {
        /// Its friction.
        friction: Friction,
        /// What draws the block back to `s = 0`.
        restoring: Restoring,
    },
    /// Surfaces in series, with friction and radii of their own.
    InSeries(SurfacesInSeries),
}

impl Bearing {
    #[inline(always)]
    fn friction(&self) -> Option<&Friction> {
        match self {
            Self::Surface { friction, .. } => Some(friction),
            Self::InSeries(_) => None,
        }
    }

    #[inline(always)]
    fn rate(&self) -> Option<&RateLaw> {
        self.friction().and_then(Friction::rate)
    }

    #[inline(always)]
    fn series(&self) -> Option<&SurfacesInSeries> {
        match self {
            Self::Surface { .. } => None,
            Self::InSeries(series) => Some(series),
        }
    }

    fn surfaces(&self) -> &[Surface] {
        self.series().map_or(&[], SurfacesInSeries::surfaces)
    }
}

/// What draws a block on one surface back to `s = 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Restoring {
    /// Nothing.
    None,
    /// A spring between table and block.
    Spring {
        /// `K1` in N/m.
        stiffness_n_per_m: f64,
    },
    /// A pendulum: its spring follows the normal force, `N(t)/R`.
    Pendulum {
        /// `R` in m.
        radius_m: f64,
    },
}

/// What is at the ends of the slider's travel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ends {
    /// Nothing is struck.
    Open {
        /// Sliding displacement that the detailing allows, in m; reported only.
        gap_m: Option<f64>,
    },
    /// What the block strikes.
    Stop(Stop),
}

impl From<Stop> for Ends {
    fn from(stop: Stop) -> Self {
        Self::Stop(stop)
    }
}

impl From<Option<Stop>> for Ends {
    fn from(stop: Option<Stop>) -> Self {
        stop.map_or(Self::Open { gap_m: None }, Self::Stop)
    }
}

impl Slider {
    fn on(bearing: Bearing) -> Self {
        let ends = Ends::Open { gap_m: None };
        Self { bearing, damper_n_s_per_m: 0.0, tilt_rad: 0.0, tilt_y_rad: 0.0, ends }
    }

    /// Friction alone on a level surface: no spring, damper, gap or stop.
    #[must_use]
    pub fn new(friction: Friction) -> Self {
        Self::on(Bearing::Surface { friction, restoring: Restoring::None })
    }

    /// A slider on one flat surface, restrained by a spring of this stiffness.
    #[must_use]
    pub fn sprung(friction: Friction, stiffness_n_per_m: f64) -> Self {
        let restoring = Restoring::Spring { stiffness_n_per_m };
        Self::on(Bearing::Surface { friction, restoring })
    }

    /// A pendulum of this radius.
    #[must_use]
    pub fn pendulum(friction: Friction, radius_m: f64) -> Self {
        Self::on(Bearing::Surface { friction, restoring: Restoring::Pendulum { radius_m } })
    }

    /// Surfaces in series.
    #[must_use]
    pub fn in_series(series: SurfacesInSeries) -> Self {
        Self::on(Bearing::InSeries(series))
    }

    /// Refuses what no slider has, on one from which the block starts at `start_m`.
    pub(crate) fn check(&self, start_m: f64) -> Result<(), ModelError> {
        match &self.bearing {
            Bearing::Surface { restoring, .. } => match *restoring {
                Restoring::None => {}
                Restoring::Spring { stiffness_n_per_m } => {
                    not_negative("slider stiffness_n_per_m", stiffness_n_per_m)?;
                }
                Restoring::Pendulum { radius_m } => positive("slider radius_m", radius_m)?,
            },
            Bearing::InSeries(series) => in_range(
                "initial sliding_displacement_m",
                "less than the travel of all surfaces",
                start_m,
                series.travel_m().is_none_or(|travel_m| start_m.abs() < travel_m),
            )?,
        }
        not_negative("slider damper_n_s_per_m", self.damper_n_s_per_m)?;
        match &self.ends {
            Ends::Open { gap_m } => optional_positive("slider gap_m", *gap_m)?,
            Ends::Stop(stop) => stop.check()?,
        }
        for (quantity, tilt_rad) in
            [("slider tilt_rad", self.tilt_rad), ("slider tilt_y_rad", self.tilt_y_rad)]
        {
            let is_within = tilt_rad.abs() < core::f64::consts::FRAC_PI_2;
            in_range(quantity, "a tilt between −π/2 and π/2", tilt_rad, is_within)?;
        }
        let (expected, cosine) = ("tilts of a surface that is not upright", self.slope_cosine());
        in_range("slider tilt_y_rad", expected, self.tilt_y_rad, cosine > 0.0)
    }

    /// `sin θ` along x and along y: what of gravity pulls towards −x and −y in the surface.
    #[must_use]
    pub fn slope_sines(&self) -> [f64; 2] {
        [self.tilt_rad, self.tilt_y_rad].map(libm::sin)
    }

    /// The cosine of the angle between the surface's normal and the vertical: `√(1 − sin²θ_x − sin²θ_y)`, as both axes
    /// lie in the surface and are at right angles to one another.
    #[must_use]
    pub fn slope_cosine(&self) -> f64 {
        match (self.tilt_rad, self.tilt_y_rad) {
            (tilt_rad, 0.0) | (0.0, tilt_rad) => libm::cos(tilt_rad),
            _ => {
                let [x, y] = self.slope_sines();
                (1.0 - x * x - y * y).max(0.0).sqrt()
            }
        }
    }

    /// How steep the surface is: the tangent of the angle between its normal and the vertical.
    #[must_use]
    pub fn steepness(&self) -> f64 {
        match (self.tilt_rad, self.tilt_y_rad) {
            (tilt_rad, 0.0) | (0.0, tilt_rad) => libm::tan(tilt_rad).abs(),
            _ => {
                let [x, y] = self.slope_sines();
                libm::hypot(x, y) / self.slope_cosine()
            }
        }
    }

    /// This slider turned so that what is along a direction, given by its cosine and sine, is along x: of a surface
    /// that rises along it alone.
    pub(crate) fn turned_to(&self, [x, y]: [f64; 2]) -> Self {
        let tilt_rad = match [x, y] {
            [1.0, 0.0] => self.tilt_rad,
            [0.0, 1.0] => self.tilt_y_rad,
            _ => {
                let [of_x, of_y] = self.slope_sines();
                libm::asin((x * of_x + y * of_y).clamp(-1.0, 1.0))
            }
        };
        Self { tilt_rad, tilt_y_rad: 0.0, ..self.clone() }
    }

    /// The friction of one surface.
    #[must_use]
    pub fn friction(&self) -> Option<&Friction> {
        self.bearing.friction()
    }

    /// The law of kinetic friction that follows the speed, where it does.
    #[must_use]
    pub fn rate(&self) -> Option<&RateLaw> {
        self.bearing.rate()
    }

    /// How friction follows the pressure, where it does.
    #[must_use]
    pub fn pressure(&self) -> Option<&PressureLaw> {
        self.bearing.friction().and_then(Friction::pressure)
    }

    /// The surfaces in series, where there are such.
    #[must_use]
    pub fn series(&self) -> Option<&SurfacesInSeries> {
        self.bearing.series()
    }

    /// The surfaces in series, in their order; none where there is one surface.
    #[must_use]
    pub fn surfaces(&self) -> &[Surface] {
        self.bearing.surfaces()
    }

    /// Radii in m: of a pendulum on one surface, and by their places of surfaces in series that have one.
    pub fn radii_m(&self) -> impl Iterator<Item = (Option<usize>, f64)> + '_ {
        let of = |(i, surface): (usize, &Surface)| Some((Some(i), surface.radius_m?));
        let whole = self.radius_m().map(|radius_m| (None, radius_m));
        self.surfaces().iter().enumerate().filter_map(of).chain(whole)
    }

    /// The slider pushed slowly, as surfaces in series: of one surface the mean coefficient over both directions
    /// and the weight over its stiffness as radius. None where friction follows the speed.
    pub fn slow_surfaces(&self, normal_n: f64, weight_n: f64) -> Option<Vec<Surface>> {
        match &self.bearing {
            Bearing::InSeries(series) => Some(series.surfaces().to_vec()),
            Bearing::Surface { friction, .. } => friction.rate().is_none().then(|| {
                let [positive, negative] = self.coefficients()[1];
                let stiffness_n_per_m = self.stiffness_n_per_m(normal_n);
                let is_sprung = stiffness_n_per_m > 0.0;
                vec![Surface {
                    radius_m: is_sprung.then(|| weight_n / stiffness_n_per_m),
                    friction: 0.5 * (positive + negative),
                    travel_m: None,
                }]
            }),
        }
    }

    /// One surface without ends that does what these do when all slide: of surfaces in series with radii a pendulum of the
    /// sum of these, `φ = (s + Σ μ R)/Σ R` over the normal force; with a flat one friction alone, of the least of those.
    /// None where friction is not the same in all directions.
    #[must_use]
    pub fn as_one_surface(&self) -> Option<Self> {
        let ends = Ends::Open { gap_m: None };
        let Some(series) = self.series() else {
            let one = Self { ends, ..self.clone() };
            return one.isotropic(1.0).is_ok().then_some(one);
        };
        let surfaces = series.surfaces();
        let flat = surfaces.iter().filter(|surface| surface.radius_m.is_none());
        let flat = flat.map(|surface| surface.friction).reduce(f64::min);
        let sum = |of: fn(&Surface) -> f64| surfaces.iter().map(of).sum::<f64>();
        let radius_m = sum(|surface| surface.radius_m.unwrap_or(0.0));
        let weighted = sum(|surface| surface.radius_m.unwrap_or(0.0) * surface.friction);
        let mu = flat.unwrap_or(weighted / radius_m);
        let friction = Friction::new(series.static_ratio() * mu, mu).ok()?;
        let one = match flat {
            Some(_) => Self::new(friction),
            None => Self::pendulum(friction, radius_m),
        };
        let Self { damper_n_s_per_m, tilt_rad, tilt_y_rad, .. } = *self;
        Some(Self { damper_n_s_per_m, tilt_rad, tilt_y_rad, ends, ..one })
    }

    /// The least displacement in m beyond which the isolators cannot or are not meant to go, and what is there: the
    /// end of their travel, a stop, or the gap that the detailing allows.
    #[must_use]
    pub fn reach_m(&self) -> Option<(&'static str, f64)> {
        let travel = self.series().and_then(SurfacesInSeries::travel_m);
        let [positive, negative] = self.stop_m();
        let stop = positive.into_iter().chain(negative).reduce(f64::min);
        let all = [("travel", travel), ("gap to the stop", stop), ("gap", self.gap_m())];
        let given = all.into_iter().filter_map(|(what, reach_m)| Some((what, reach_m?)));
        given.reduce(|a, b| if b.1 < a.1 { b } else { a })
    }

    /// A slider held by one coefficient of friction, on a spring with the stiffness that this one has under a normal
    /// force, without a gap.
    ///
    /// # Errors
    /// As [`Friction::new`].
    pub fn held(&self, coefficient: f64, normal_n: f64) -> Result<Self, ModelError> {
        let friction = Friction::new(coefficient, coefficient)?;
        let ends = self.stop().copied().into();
        let Self { damper_n_s_per_m, tilt_rad, tilt_y_rad, .. } = *self;
        let sprung = Self::sprung(friction, self.stiffness_n_per_m(normal_n));
        Ok(Self { damper_n_s_per_m, tilt_rad, tilt_y_rad, ends, ..sprung })
    }

    /// Static and kinetic coefficients towards +x and −x: of friction by the speed that at rest, of
    /// surfaces in series those of the first to slide.
    pub(crate) fn coefficients(&self) -> [[f64; 2]; 2] {
        match &self.bearing {
            Bearing::Surface { friction, .. } => [
                Direction::BOTH.map(|direction| friction.static_coefficient(direction)),
                Direction::BOTH.map(|direction| friction.kinetic_coefficient(direction)),
            ],
            Bearing::InSeries(series) => {
                let least = series.least_friction();
                [[series.static_ratio() * least; 2], [least; 2]]
            }
        }
    }

    /// Radius of a pendulum on one surface, in m.
    #[must_use]
    pub fn radius_m(&self) -> Option<f64> {
        match self.bearing {
            Bearing::Surface { restoring: Restoring::Pendulum { radius_m }, .. } => Some(radius_m),
            _ => None,
        }
    }

    /// Radius of a pendulum whose spring follows the normal force: under one that varies, and where
    /// friction follows the speed.
    #[must_use]
    pub fn pendulum_radius_m(&self, varying: bool) -> Option<f64> {
        self.radius_m().filter(|_| varying || self.rate().is_some())
    }

    /// Exponent by which friction falls with a pressure that varies: under a normal force that does, where it is not 0.
    #[must_use]
    pub fn pressure_exponent(&self, varying: bool) -> Option<f64> {
        self.pressure().map(PressureLaw::exponent).filter(|exponent| varying && *exponent > 0.0)
    }

    /// Stiffness in N/m of its spring, of a pendulum under a normal force; 0 without either.
    #[must_use]
    pub fn stiffness_n_per_m(&self, normal_n: f64) -> f64 {
        match self.bearing {
            Bearing::Surface { restoring: Restoring::Spring { stiffness_n_per_m }, .. } => {
                stiffness_n_per_m
            }
            Bearing::Surface { restoring: Restoring::Pendulum { radius_m }, .. } => {
                normal_n / radius_m
            }
            _ => 0.0,
        }
    }

    /// Sliding displacement that the detailing allows, in m, where it is given and nothing is struck.
    #[must_use]
    pub fn gap_m(&self) -> Option<f64> {
        match self.ends {
            Ends::Open { gap_m } => gap_m,
            Ends::Stop(_) => None,
        }
    }

    /// The stop at the ends of its travel.
    #[must_use]
    pub fn stop(&self) -> Option<&Stop> {
        match &self.ends {
            Ends::Open { .. } => None,
            Ends::Stop(stop) => Some(stop),
        }
    }

    /// Distances from `s = 0` to it towards +x and −x in m.
    #[must_use]
    pub fn stop_m(&self) -> [Option<f64>; 2] {
        self.stop().map_or([None; 2], |stop| stop.gap_m)
    }

    /// Force of an elastic stop on the block in a contact, as a size in N.
    #[must_use]
    pub fn stop_force_n(&self, contact: Contact, s: f64, w: f64) -> f64 {
        self.law(0.0, true).stop_force_n(contact, s, w)
    }

    /// This slider with other friction on its one surface; surfaces in series keep theirs.
    #[must_use]
    pub fn with_friction(mut self, other: Friction) -> Self {
        if let Bearing::Surface { friction, .. } = &mut self.bearing {
            *friction = other;
        }
        self
    }

    /// This slider with all coefficients of friction times `factor`.
    ///
    /// # Errors
    /// As [`Friction::scaled`].
    pub(crate) fn with_friction_times(&self, factor: f64) -> Result<Self, ModelError> {
        let mut slider = self.clone();
        match &mut slider.bearing {
            Bearing::Surface { friction, .. } => *friction = friction.scaled(factor)?,
            Bearing::InSeries(series) => *series = series.scaled(factor)?,
        }
        Ok(slider)
    }

    /// Whether another has the same linear system: whether the two differ in constant coefficients of
    /// friction, static ones and a reported gap alone.
    pub(crate) fn has_system_of(&self, other: &Self) -> bool {
        let alike = match (&self.bearing, &other.bearing) {
            (
                Bearing::Surface { friction, restoring },
                Bearing::Surface { friction: of_other, restoring: restoring_of_other },
            ) => restoring == restoring_of_other && friction.rate() == of_other.rate(),
            (own, of_other) => own == of_other,
        };
        alike
            && self.damper_n_s_per_m == other.damper_n_s_per_m
            && self.tilt_rad == other.tilt_rad
            && self.tilt_y_rad == other.tilt_y_rad
            && self.stop() == other.stop()
    }
}
