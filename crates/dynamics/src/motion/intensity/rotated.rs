//! Measures of a pair of horizontal components over all directions: RotD50 and RotD100.

use core::f64::consts::TAU;

use super::Measure;
use crate::error::MotionError;
use crate::motion::combine::direction;
use crate::motion::oscillator::{Interval, Overshoot, Peaks, State, Step, Steps};
use crate::motion::spectrum::check;
use crate::motion::{GroundMotion, Ordinates, Spectrum, spectrum};
use crate::numerics::fractile::median;

/// Number of directions, a degree apart.
const DIRECTIONS: u8 = 180;

/// A measure of the component at every whole degree from 0 to 179 between two components.
///
/// D. M. Boore, "Orientation-independent, nongeometric-mean measures of seismic intensity from two
/// horizontal components of motion", Bulletin of the Seismological Society of America 100 (2010)
/// 1830–1835.
#[derive(Clone, Debug, PartialEq)]
pub struct RotD {
    /// The measure in SI at 0°, the first component, 1°, … 179°; 90° is the second component.
    pub values: Vec<f64>,
}

impl RotD {
    /// The measure of `x cos φ + y sin φ` at every degree.
    ///
    /// Times of both are united; the shorter is zero after its end.
    ///
    /// # Errors
    /// [`MotionError`] where the union has too many samples.
    pub fn of(measure: &Measure, x: &GroundMotion, y: &GroundMotion) -> Result<Self, MotionError> {
        Ok(Self { values: in_all_directions(x, y, |motion| Ok(measure.of(motion)))? })
    }

    /// RotD50: the median over the directions, the mean of the two middle values.
    #[must_use]
    pub fn median(&self) -> f64 {
        median(&self.values)
    }

    /// RotD100: the largest over the directions.
    #[must_use]
    pub fn largest(&self) -> f64 {
        largest(&self.values)
    }

    /// RotD00: the smallest over the directions.
    #[must_use]
    pub fn smallest(&self) -> f64 {
        self.values.iter().copied().fold(f64::INFINITY, f64::min)
    }
}

/// Response spectra of a pair over all directions: RotD50 and RotD100 of every ordinate.
///
/// As [`RotD::of`] and [`spectrum`]; each ordinate has its own direction.
///
/// # Errors
/// As those two.
pub fn rotated_spectra(
    x: &GroundMotion,
    y: &GroundMotion,
    periods_s: &[f64],
    damping_ratios: &[f64],
) -> Result<[Spectrum; 2], MotionError> {
    let all: Vec<Spectrum> = in_all_directions(x, y, |motion| {
        spectrum(motion.times_s(), motion.horizontal_m_per_s2(), periods_s, damping_ratios)
    })?;
    let over_directions = |fold: fn(&[f64]) -> f64| Spectrum {
        periods_s: periods_s.to_vec(),
        damping_ratios: damping_ratios.to_vec(),
        ordinates: (0..periods_s.len() * damping_ratios.len())
            .map(|i| {
                let of = |value: fn(&Ordinates) -> f64| {
                    fold(&all.iter().map(|one| value(&one.ordinates[i])).collect::<Vec<f64>>())
                };
                Ordinates {
                    sd_m: of(|o| o.sd_m),
                    sv_m_per_s: of(|o| o.sv_m_per_s),
                    psv_m_per_s: of(|o| o.psv_m_per_s),
                    psa_m_per_s2: of(|o| o.psa_m_per_s2),
                    sa_m_per_s2: of(|o| o.sa_m_per_s2),
                }
            })
            .collect(),
    };
    Ok([over_directions(median), over_directions(largest)])
}

/// What becomes of `x cos φ + y sin φ` at every whole degree from 0 to 179.
fn in_all_directions<T>(
    x: &GroundMotion,
    y: &GroundMotion,
    of: impl Fn(&GroundMotion) -> Result<T, MotionError>,
) -> Result<Vec<T>, MotionError> {
    let (pair, _) = x.with_vertical(y, 1.0)?;
    (0..DIRECTIONS).map(|degrees| of(&pair.in_direction(f64::from(degrees))?)).collect()
}

/// Spectral accelerations of a motion with two horizontal components, one a period, in m/s².
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SaInPlane {
    /// Sa of the first component.
    pub x_m_per_s2: Vec<f64>,
    /// Sa of the second component.
    pub y_m_per_s2: Vec<f64>,
    /// RotD100 of Sa: the largest over the directions of [`RotD`].
    pub rotd100_m_per_s2: Vec<f64>,
}

/// Two components of an acceleration in m/s².
pub type Components<'a> = [&'a [f64]; 2];

impl SaInPlane {
    /// Spectral accelerations of motions at the same times, of each its two components, linear between the times; a
    /// repeated time is a jump.
    ///
    /// They are those of [`spectrum`] and [`rotated_spectra`] but for rounding. As RotD100 alone is asked for, a motion
    /// is followed once for all directions: a direction is looked at where it may exceed what all others have attained.
    ///
    /// # Errors
    /// As [`spectrum`].
    ///
    /// # Examples
    /// ```
    /// use slipstick_dynamics::motion::intensity::SaInPlane;
    ///
    /// // Both components are one motion along 45°.
    /// let (times_s, along) = (vec![0.0, 0.1, 0.2, 0.3], vec![0.0, 2.0, -1.0, 0.0]);
    /// let sa = &SaInPlane::of_each(&times_s, &[[&along, &along]], &[0.2], 0.05)?[0];
    /// assert_eq!(sa.x_m_per_s2, sa.y_m_per_s2);
    /// let ratio = sa.rotd100_m_per_s2[0] / sa.x_m_per_s2[0];
    /// assert!((ratio - 2.0_f64.sqrt()).abs() < 1e-12);
    /// # Ok::<(), slipstick_dynamics::error::MotionError>(())
    /// ```
    pub fn of_each(
        times_s: &[f64],
        motions: &[Components<'_>],
        periods_s: &[f64],
        damping_ratio: f64,
    ) -> Result<Vec<Self>, MotionError> {
        for component in motions.iter().flatten() {
            check(times_s, component, periods_s, &[damping_ratio])?;
        }
        let directions: Vec<[f64; 2]> =
            (0..DIRECTIONS).map(|degrees| direction(f64::from(degrees))).collect();
        let mut all = vec![Self::default(); motions.len()];
        for period_s in periods_s {
            let omega = TAU / period_s;
            let found = match omega.is_finite() {
                true => {
                    let oscillator = VectorOscillator { omega, xi: damping_ratio };
                    oscillator.largest(times_s, motions, &directions)
                }
                false => motions.iter().map(|motion| largest_of(motion, &directions)).collect(),
            };
            for (sa, found) in all.iter_mut().zip(found) {
                let [x, y, rotd100] = found;
                sa.x_m_per_s2.push(x);
                sa.y_m_per_s2.push(y);
                sa.rotd100_m_per_s2.push(rotd100.max(x).max(y));
            }
        }
        Ok(all)
    }
}

/// Largest acceleration along x, along y and over the directions.
fn largest_of([x, y]: &Components<'_>, directions: &[[f64; 2]]) -> [f64; 3] {
    let along = |[cos, sin]: &[f64; 2]| {
        let both = x.iter().zip(*y);
        both.map(|(x, y)| (x * cos + y * sin).abs()).fold(0.0, f64::max)
    };
    [along(&X), along(&Y), directions.iter().map(along).fold(0.0, f64::max)]
}

const X: [f64; 2] = [1.0, 0.0];
const Y: [f64; 2] = [0.0, 1.0];

/// Longest phase of the parts that an interval is cut into: what a peak inside may exceed the ends by is then small, so
/// that few parts are looked at in all directions.
const PART: f64 = 0.4;

/// Parts of an interval beyond which it is not cut, but looked at as it is.
const MOST_PARTS: f64 = 64.0;

/// An oscillator under both components: ω in rad/s and its damping ratio.
struct VectorOscillator {
    omega: f64,
    xi: f64,
}

impl VectorOscillator {
    /// Largest total accelerations in m/s² under each motion: along x, along y and over the directions.
    ///
    /// In every direction both ends of an interval and its forcing are at most the norms of the vectors, so that
    /// where these do not pass the bound of [`Overshoot`], no direction does.
    fn largest(
        &self,
        times_s: &[f64],
        motions: &[Components<'_>],
        directions: &[[f64; 2]],
    ) -> Vec<[f64; 3]> {
        let Self { omega, xi } = *self;
        let stiffness = omega * omega;
        let mut steps = Steps::new(xi);
        let mut walks = vec![VectorWalk::default(); motions.len()];
        for (k, t) in times_s.windows(2).enumerate() {
            let theta = omega * (t[1] - t[0]);
            if theta == 0.0 {
                continue;
            }
            let parts = libm::ceil(theta / PART);
            let parts = if parts > MOST_PARTS { 1.0 } else { parts };
            let part = theta / parts;
            let (step, overshoot) = (steps.of(part), Overshoot::new(part, xi));
            for (walk, motion) in walks.iter_mut().zip(motions) {
                let alpha = motion.map(|a| [a[k] / stiffness, a[k + 1] / stiffness]);
                // The total acceleration is forced by α + 2ξσ.
                let shift = norm(alpha.map(|[from, to]| 2.0 * xi * (to - from) / theta));
                let ends = [0, 1].map(|end| norm(alpha.map(|alpha| alpha[end])));
                let forcing = ends[0].max(ends[1]) + shift;
                for i in 0..parts as u32 {
                    let at = |i: u32| {
                        let share = f64::from(i) / parts;
                        alpha.map(|[from, to]| from + (to - from) * share)
                    };
                    let alpha = [at(i), at(i + 1)];
                    let (start, end) = (walk.state, walk.state.after(&step, alpha, xi));
                    let interval =
                        VectorInterval { xi, theta: part, start, end, alpha, forcing, overshoot };
                    walk.raise(&interval, directions);
                    walk.state = end;
                }
            }
        }
        walks.iter().map(|walk| walk.most.map(|most| stiffness * most)).collect()
    }
}

/// An oscillator on its way along a motion: where it is, and the largest total accelerations so far over ω², along x,
/// along y and over the directions.
#[derive(Clone, Copy, Default)]
struct VectorWalk {
    state: VectorState,
    most: [f64; 3],
}

impl VectorWalk {
    /// With the peaks of an interval.
    fn raise(&mut self, interval: &VectorInterval, directions: &[[f64; 2]]) {
        let VectorInterval { start, end, .. } = interval;
        let sizes = [0, 1].map(|c| start.total[c].abs().max(end.total[c].abs()));
        let sizes = [sizes[0], sizes[1], start.size.max(end.size)];
        let along: [&[[f64; 2]]; 3] = [&[X], &[Y], directions];
        for (most, (size, directions)) in self.most.iter_mut().zip(sizes.into_iter().zip(along)) {
            if size > interval.overshoot.limit(*most, interval.forcing) {
                *most = interval.largest(directions, *most);
            }
        }
    }
}

/// States of an oscillator under both components, as [`State`], its total acceleration over ω² and the norm of that.
#[derive(Clone, Copy, Default)]
struct VectorState {
    u: [f64; 2],
    w: [f64; 2],
    total: [f64; 2],
    size: f64,
}

impl VectorState {
    fn after(&self, step: &Step, [alpha0, alpha1]: [[f64; 2]; 2], xi: f64) -> Self {
        let of = |c: usize| step.apply(State { u: self.u[c], w: self.w[c] }, alpha0[c], alpha1[c]);
        let [x, y] = [of(0), of(1)];
        let total = [x, y].map(|state| state.u + 2.0 * xi * state.w);
        Self { u: [x.u, y.u], w: [x.w, y.w], total, size: norm(total) }
    }
}

/// One interval of both components, seen by one oscillator; the fields are those of [`Interval`].
struct VectorInterval {
    xi: f64,
    theta: f64,
    start: VectorState,
    end: VectorState,
    /// At its start and at its end.
    alpha: [[f64; 2]; 2],
    /// Bound on what forces the total acceleration, over the directions.
    forcing: f64,
    overshoot: Overshoot,
}

impl VectorInterval {
    /// The largest total acceleration over some directions and the interval, at least `most`.
    fn largest(&self, directions: &[[f64; 2]], most: f64) -> f64 {
        let Self { xi, theta, overshoot, .. } = *self;
        // What is infinite is not looked for.
        let (u, w) = (f64::INFINITY, f64::INFINITY);
        let mut peaks = Peaks { u, w, total: most };
        for [cos, sin] in directions {
            let along = |[x, y]: [f64; 2]| x * cos + y * sin;
            let [start, end] =
                [&self.start, &self.end].map(|at| State { u: along(at.u), w: along(at.w) });
            let sizes = [&start, &end].map(|at| (at.u + 2.0 * xi * at.w).abs());
            if sizes[0].max(sizes[1]) <= overshoot.limit(peaks.total, self.forcing) {
                continue;
            }
            peaks.raise(end, xi);
            let [alpha0, alpha1] = self.alpha.map(along);
            Interval { xi, theta, start, end, alpha0, alpha1 }.raise(overshoot, &mut peaks);
        }
        peaks.total
    }
}

fn norm([x, y]: [f64; 2]) -> f64 {
    (x * x + y * y).sqrt()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A motion along one line: |cos φ| of it in every direction.
    #[test]
    fn rotated_single_component() {
        let x = GroundMotion::evenly_spaced(0.5, vec![0.0, 3.0, -1.0, 0.0], None).unwrap();
        let y = GroundMotion::evenly_spaced(0.5, vec![0.0; 4], None).unwrap();
        let rotated = RotD::of(&Measure::Pga, &x, &y).unwrap();
        assert_eq!(rotated.largest(), 3.0);
        assert!(rotated.smallest().abs() < 1e-15);
        // Middle values: |cos| at 45° and 135° are equal.
        assert!((rotated.median() - 3.0 * core::f64::consts::FRAC_1_SQRT_2).abs() < 1e-14);
        assert!((rotated.values[60] - 1.5).abs() < 1e-14);
    }

    /// A motion that turns has the same peak in every direction, but for its sampling.
    #[test]
    fn rotated_circle() {
        let angle = |k: u32| f64::from(k) * core::f64::consts::TAU / 3600.0;
        let x: Vec<f64> = (0..=7200).map(|k| libm::cos(angle(k))).collect();
        let y: Vec<f64> = (0..=7200).map(|k| libm::sin(angle(k))).collect();
        let x = GroundMotion::evenly_spaced(0.01, x, None).unwrap();
        let y = GroundMotion::evenly_spaced(0.01, y, None).unwrap();
        let rotated = RotD::of(&Measure::Pga, &x, &y).unwrap();
        assert!((rotated.largest() - 1.0).abs() < 1e-12);
        assert!((rotated.median() - 1.0).abs() < 1e-12);
    }

    /// Followed once for all directions, a motion has the RotD100 of its 180 spectra: at even and uneven times, jumps,
    /// gaps of many periods, and periods far shorter and longer than a sample.
    #[test]
    fn sa_in_plane_is_that_of_rotated_spectra() {
        let mut seed = 5_u64;
        let mut random = || {
            seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        let periods_s = [0.0, 0.01, 0.03, 0.1, 0.3, 4.0];
        for case in 0..8 {
            let mut times_s = vec![0.0];
            for k in 1..40 {
                let gap = match (case, k % 9) {
                    (0, _) => 0.02,
                    (1.., 4) => 0.0,
                    (4.., 7) => 1.5,
                    _ => 0.02 * (1.1 + random()),
                };
                times_s.push(times_s[k - 1] + gap);
            }
            let component = |random: &mut dyn FnMut() -> f64| -> Vec<f64> {
                times_s.iter().map(|_| 3.0 * random()).collect()
            };
            let (x, y) = (component(&mut random), component(&mut random));
            let xi = [0.0, 0.02, 0.05, 0.4][case % 4];
            let found =
                SaInPlane::of_each(&times_s, &[[&y, &x], [&x, &y]], &periods_s, xi).unwrap();
            let found = &found[1];
            let motion = |a: &[f64]| GroundMotion::new(times_s.clone(), a.to_vec(), None).unwrap();
            let [_, largest] =
                rotated_spectra(&motion(&x), &motion(&y), &periods_s, &[xi]).unwrap();
            for (i, period_s) in periods_s.iter().enumerate() {
                let (found, expected) =
                    (found.rotd100_m_per_s2[i], largest.ordinates[i].sa_m_per_s2);
                assert!(
                    (found / expected - 1.0).abs() < 1e-11,
                    "{case} {period_s} {found} {expected}"
                );
            }
            for (component, found) in [(&x, &found.x_m_per_s2), (&y, &found.y_m_per_s2)] {
                let along = spectrum(&times_s, component, &periods_s, &[xi]).unwrap();
                for (found, expected) in found.iter().zip(&along.ordinates) {
                    assert!((found / expected.sa_m_per_s2 - 1.0).abs() < 1e-11, "{case}");
                }
            }
        }
    }

    #[test]
    fn rotated_spectra_are_those_of_every_ordinate() {
        let wave = |k: f64, phase: f64| libm::sin(0.3 * k + phase) * libm::exp(-0.02 * k);
        let of = |phase: f64| {
            let a = (0..100).map(|k| wave(f64::from(k), phase)).collect();
            GroundMotion::evenly_spaced(0.02, a, None).unwrap()
        };
        let (x, y) = (of(0.0), of(1.3));
        let [median, largest] = rotated_spectra(&x, &y, &[0.0, 0.3, 1.0], &[0.05]).unwrap();
        assert_eq!(median.periods_s, [0.0, 0.3, 1.0]);
        let rotated = RotD::of(&Measure::Pga, &x, &y).unwrap();
        assert_eq!(median.ordinates[0].psa_m_per_s2, rotated.median());
        assert_eq!(largest.ordinates[0].psa_m_per_s2, rotated.largest());
        for (i, name) in [(1, "PSa(0.3 s)"), (2, "PSa(1 s)")] {
            let rotated = RotD::of(&Measure::parse(name).unwrap(), &x, &y).unwrap();
            let close = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-12;
            assert!(close(median.ordinates[i].psa_m_per_s2, rotated.median()), "{name}");
            assert!(close(largest.ordinates[i].psa_m_per_s2, rotated.largest()), "{name}");
        }
    }
}
