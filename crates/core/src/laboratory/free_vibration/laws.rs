//! Viscous damping, dry friction, or both: which of them a record needs.

use core::f64::consts::TAU;

use super::decay::{Decay, Motion};
use super::{Ends, FRICTION, intervals, oscillation};
use crate::laboratory::estimate::{Estimate, correlation_length};
use crate::laboratory::fit::{Minimum, Problem, refine};

/// What stops a vibration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Damping {
    /// Viscous damping.
    Viscous,
    /// Dry friction.
    Friction,
    /// Both.
    Both,
    /// Viscous damping and dry friction, each alone, fit alike.
    Undecided,
}

impl Damping {
    /// Its name in JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Viscous => "viscous",
            Self::Friction => "friction",
            Self::Both => "both",
            Self::Undecided => "undecided",
        }
    }
}

/// The laws that are fitted.
const LAWS: [Damping; 3] = [Damping::Viscous, Damping::Friction, Damping::Both];
/// Difference of the criterion below which two laws fit alike: odds of 20 to 1.
const CLEAR: f64 = 6.0;
/// Parameters of a vibration: frequency in Hz, displacement and velocity at the start over their amplitudes,
/// damping ratio, friction over that which stops the amplitude at once.
const PARAMETERS: usize = 5;
const DAMPING: usize = 3;
const FRICTION_AT: usize = 4;

/// A fit by viscous damping alone, and its bounds of frequency and damping ratio.
pub(super) struct Viscous {
    pub frequency_hz: f64,
    pub damping_ratio: f64,
    pub bounds: Vec<[f64; 2]>,
}

/// Fits of the laws to a record.
pub(super) struct Laws<'a> {
    /// From the first sample, in s.
    times_s: Vec<f64>,
    values: &'a [f64],
    motion: Motion,
    scale: f64,
    /// Amplitude of the displacement at the start, and its angular frequency in rad/s.
    amplitude: f64,
    omega: f64,
    bounds: Vec<[f64; 2]>,
    minima: [Minimum; 3],
}

/// What the criterion chose.
pub(super) struct Chosen {
    pub damping: Damping,
    pub evidence: [f64; 3],
    pub frequency: (f64, Ends),
    pub damping_ratio: Estimate,
    pub friction: Estimate,
    pub fitted: Vec<f64>,
    pub explained: f64,
    pub correlation_length: f64,
}

/// The parameters that a law has.
fn of_law(damping: Damping) -> &'static [usize] {
    match damping {
        Damping::Viscous => &[0, 1, 2, DAMPING],
        Damping::Friction => &[0, 1, 2, FRICTION_AT],
        Damping::Both | Damping::Undecided => &[0, 1, 2, DAMPING, FRICTION_AT],
    }
}

impl<'a> Laws<'a> {
    /// Fits all of them, from the fit by viscous damping; `None` where none fits.
    pub(super) fn new(
        times_s: &[f64],
        values: &'a [f64],
        motion: Motion,
        scale: f64,
        viscous: &Viscous,
    ) -> Option<Self> {
        let Viscous { frequency_hz, damping_ratio: xi, bounds } = viscous;
        let (linear, _) = oscillation(times_s, values, *frequency_hz, *xi)?;
        let [a, b] = [linear[0], linear[1]];
        let omega = TAU * frequency_hz;
        // Displacement and velocity over ω at the start.
        let [x, v] = match motion {
            Motion::Displacement => [a, b - xi * a],
            Motion::Velocity => [-b / omega, a / omega],
            Motion::Acceleration => [-a / (omega * omega), -b / (omega * omega)],
        };
        let amplitude = libm::hypot(x, v);
        if !(amplitude > 0.0 && amplitude.is_finite()) {
            return None;
        }
        let wide = [-3.0, 3.0];
        let mut this = Self {
            times_s: times_s.iter().map(|t| t - times_s[0]).collect(),
            values,
            motion,
            scale,
            amplitude,
            omega,
            bounds: vec![bounds[0], wide, wide, bounds[1], [0.0, 0.6]],
            minima: core::array::from_fn(|_| Minimum {
                unit: Vec::new(),
                sse: f64::INFINITY,
                count: 0,
            }),
        };
        // Friction that takes as much of the amplitude in the record as damping does.
        let duration_s = this.times_s.last()?;
        let lost = 1.0 - libm::exp(-xi * omega * duration_s);
        let alike = core::f64::consts::FRAC_PI_2 * lost / (omega * duration_s);
        let [x, v] = [x / amplitude, v / amplitude];
        for (index, law) in LAWS.into_iter().enumerate() {
            let parts: &[f64] = match law {
                Damping::Viscous => &[0.0],
                Damping::Friction => &[0.7, 1.0, 1.5, 2.5],
                _ => &[0.1, 0.4, 0.7, 1.0],
            };
            for part in parts {
                let damping = if law == Damping::Friction { 0.0 } else { xi * (1.0 - 0.8 * part) };
                let start = [*frequency_hz, x, v, damping, part * alike];
                let Some(found) = this.refined(law, &start) else { continue };
                if found.sse < this.minima[index].sse {
                    this.minima[index] = found;
                }
            }
        }
        // What one law finds is open to both.
        for one in [0, 1] {
            let start = this.parameters(LAWS[one], &this.minima[one])?;
            if let Some(found) = this.refined(Damping::Both, &start)
                && found.sse < this.minima[2].sse
            {
                this.minima[2] = found;
            }
        }
        this.minima.iter().all(|minimum| minimum.sse.is_finite()).then_some(this)
    }

    fn bounds_of(&self, law: Damping) -> Vec<[f64; 2]> {
        of_law(law).iter().map(|k| self.bounds[*k]).collect()
    }

    /// All parameters of a fit.
    fn parameters(&self, law: Damping, minimum: &Minimum) -> Option<[f64; PARAMETERS]> {
        let mut all = [0.0; PARAMETERS];
        for ((index, [low, high]), unit) in
            of_law(law).iter().zip(self.bounds_of(law)).zip(&minimum.unit)
        {
            all[*index] = low + unit * (high - low);
        }
        (minimum.unit.len() == of_law(law).len()).then_some(all)
    }

    fn decay(&self, [frequency_hz, x, v, damping_ratio, friction]: [f64; PARAMETERS]) -> Decay {
        Decay {
            omega: TAU * frequency_hz,
            damping_ratio,
            friction: friction * self.amplitude * self.omega * self.omega,
            x: x * self.amplitude,
            v: v * self.amplitude * self.omega,
        }
    }

    /// Values less those of a vibration, less their mean, over the scale.
    fn left(&self, all: [f64; PARAMETERS]) -> Vec<f64> {
        let mut left: Vec<f64> = self
            .decay(all)
            .values(&self.times_s, self.motion)
            .iter()
            .zip(self.values)
            .map(|(fitted, value)| value - fitted)
            .collect();
        let mean = left.iter().sum::<f64>() / left.len() as f64;
        left.iter_mut().for_each(|r| *r = (*r - mean) / self.scale);
        left
    }

    /// Calls back with the problem of a law.
    fn with_problem<T>(&self, law: Damping, then: impl FnOnce(&Problem) -> T) -> T {
        let residuals = |p: &[f64]| {
            let mut all = [0.0; PARAMETERS];
            for (index, value) in of_law(law).iter().zip(p) {
                all[*index] = *value;
            }
            Some(self.left(all))
        };
        then(&Problem { bounds: self.bounds_of(law), residuals: &residuals })
    }

    fn refined(&self, law: Damping, start: &[f64; PARAMETERS]) -> Option<Minimum> {
        let start: Vec<f64> = of_law(law).iter().map(|k| start[*k]).collect();
        self.with_problem(law, |problem| refine(problem, &problem.unit(&start)))
    }

    /// Schwarz's criterion of the laws, less the least.
    fn evidence(&self) -> [f64; 3] {
        let n = self.values.len() as f64;
        let length = self
            .parameters(Damping::Both, &self.minima[2])
            .map_or(1.0, |all| correlation_length(&self.left(all)));
        let independent = (n / length).max(2.0);
        // Without noise every law but the true one is infinitely worse: rounding is the noise.
        let criterion = |index: usize| {
            let variance = (self.minima[index].sse / n).max(1e-20);
            let unknowns = of_law(LAWS[index]).len() as f64 + 2.0;
            independent * libm::log(variance) + unknowns * libm::log(independent)
        };
        let all = [0, 1, 2].map(criterion);
        let least = all.iter().copied().fold(f64::INFINITY, f64::min);
        all.map(|value| value - least)
    }

    /// The law that the criterion chooses; `total` is the sum of squares of the scaled values about their mean.
    pub(super) fn choose(&self, total: f64) -> Chosen {
        let evidence = self.evidence();
        let [viscous, friction, both] = evidence;
        let law = match both {
            0.0 => Damping::Both,
            _ if viscous <= friction => Damping::Viscous,
            _ => Damping::Friction,
        };
        // Where hardly anything is lost, that is said of the damping ratio.
        let fits_alike = both > 0.0 && (viscous - friction).abs() < CLEAR && self.loses();
        let damping = if fits_alike { Damping::Undecided } else { law };
        let index = LAWS.into_iter().position(|one| one == law).unwrap_or(2);
        let (minimum, ends, length) = self.with_problem(law, |problem| {
            intervals(problem, self.minima[index].clone(), &[0, 3], 1)
        });
        let all = self.parameters(law, &minimum).unwrap_or_default();
        let unit_of_friction = self.amplitude * self.omega * self.omega;
        let path = ["storey.1.damping_ratio", FRICTION];
        let (damping_ratio, friction) = match damping {
            Damping::Undecided => {
                let why = "viscous damping and dry friction, each alone, fit alike: a longer record, or one with \
                           less noise, tells which";
                (Estimate::refused(path[0], "", why), Estimate::refused(path[1], "m/s²", why))
            }
            Damping::Viscous => {
                let most = self.most_beside(FRICTION_AT).map(|most| most * unit_of_friction);
                let most =
                    most.map_or(String::new(), |most| format!(": it is at most {most:.2e} m/s²"));
                let why =
                    format!("viscous damping alone explains the record, no friction shows{most}");
                // Its own interval is that of the fit by viscous damping.
                (Estimate::refused(path[0], "", ""), Estimate::refused(path[1], "m/s²", why))
            }
            Damping::Friction => {
                let most = self.most_beside(DAMPING);
                let most =
                    most.map_or(String::new(), |most| format!("; a ratio is at most {most:.2e}"));
                let why = format!(
                    "the envelope falls along a straight line, as dry (Coulomb) friction makes it, and not along \
                     an exponential, as viscous damping would{most}"
                );
                let told =
                    Self::told(path[1], "m/s²", all[FRICTION_AT], &ends[1], unit_of_friction);
                (Estimate::refused(path[0], "", why), told)
            }
            Damping::Both => {
                let (_, of_friction, _) = self.with_problem(law, |problem| {
                    intervals(problem, self.minima[index].clone(), &[4], 1)
                });
                (
                    Self::told(path[0], "", all[DAMPING], &ends[1], 1.0),
                    Self::told(
                        path[1],
                        "m/s²",
                        all[FRICTION_AT],
                        &of_friction[0],
                        unit_of_friction,
                    ),
                )
            }
        };
        let left = self.left(all);
        let mean = left.iter().zip(self.values).map(|(r, v)| v - r * self.scale);
        Chosen {
            damping,
            evidence,
            frequency: (all[0], ends[0]),
            damping_ratio,
            friction,
            fitted: mean.collect(),
            explained: 1.0 - minimum.sse / total,
            correlation_length: length,
        }
    }

    /// Whether the vibration loses a tenth of its amplitude or more.
    fn loses(&self) -> bool {
        let viscous = self.parameters(Damping::Viscous, &self.minima[0]).unwrap_or_default();
        let duration_s = self.times_s.last().copied().unwrap_or(0.0);
        viscous[DAMPING] * TAU * viscous[0] * duration_s > 0.1
    }

    /// The upper end of a parameter where both laws are fitted.
    fn most_beside(&self, parameter: usize) -> Option<f64> {
        let at = of_law(Damping::Both).iter().position(|index| *index == parameter)?;
        let (_, ends, _) = self.with_problem(Damping::Both, |problem| {
            intervals(problem, self.minima[2].clone(), &[at], 1)
        });
        ends[0].map(|(ends, _)| ends[1])
    }

    fn told(path: &str, unit: &'static str, value: f64, ends: &Ends, factor: f64) -> Estimate {
        match ends {
            Some((ends, [false, false])) => {
                Estimate::determined(path, unit, factor * value, ends.map(|end| factor * end))
            }
            Some((ends, [true, false])) => {
                let most = factor * ends[1];
                let why = format!("it cannot be distinguished from zero: it is at most {most:.2e}");
                Estimate::refused(path, unit, why)
            }
            _ => {
                Estimate::refused(path, unit, "values up to the largest that was tried fit as well")
            }
        }
    }
}
