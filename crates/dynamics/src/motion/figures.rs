//! Peaks of acceleration, velocity and displacement of a piecewise-linear acceleration.

use super::GroundMotion;
use crate::linear::polynomial::{self, largest};

/// What an engineer looks at first: peaks of the motion, and the velocity left at its end.
///
/// Velocity and displacement are the exact integrals of the piecewise-linear acceleration from
/// rest, and their peaks those of the continuous motion, between samples included.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Figures {
    /// Largest |Ü| in m/s² (PGA).
    pub pga_m_per_s2: f64,
    /// Largest |U̇| in m/s (PGV).
    pub pgv_m_per_s: f64,
    /// Largest |U| in m (PGD).
    pub pgd_m: f64,
    /// U̇ at the last sample in m/s, signed (a norm in two directions): not 0 where the record drifts.
    pub end_velocity_m_per_s: f64,
}

impl GroundMotion {
    /// Figures of the horizontal acceleration; in two directions of the resultant, the norm at each
    /// instant.
    #[must_use]
    pub fn figures(&self) -> Figures {
        match self.horizontal_y_m_per_s2() {
            None => Figures::of(&self.times_s, &self.horizontal_m_per_s2),
            Some(y) => Figures::of_resultant(&self.times_s, [&self.horizontal_m_per_s2, y]),
        }
    }

    /// Figures along x and along y of a motion in two horizontal directions.
    #[must_use]
    pub fn figures_by_axis(&self) -> Option<[Figures; 2]> {
        let y = self.horizontal_y_m_per_s2()?;
        Some([&self.horizontal_m_per_s2, y].map(|a| Figures::of(&self.times_s, a)))
    }
}

impl Figures {
    /// Figures of an acceleration in m/s² that is linear between times in s which do not decrease.
    fn of(times_s: &[f64], acceleration_m_per_s2: &[f64]) -> Self {
        let mut figures = Self { pga_m_per_s2: peak(acceleration_m_per_s2), ..Self::default() };
        let (mut v0, mut u0) = (0.0, 0.0);
        for (t, a) in times_s.windows(2).zip(acceleration_m_per_s2.windows(2)) {
            let piece = Piece { u0, v0, a0: a[0], a1: a[1], h: t[1] - t[0] };
            if let Some(t) = piece.zero_of_acceleration() {
                figures.pgv_m_per_s = figures.pgv_m_per_s.max(piece.velocity(t).abs());
            }
            for t in piece.zeros_of_velocity().into_iter().flatten() {
                figures.pgd_m = figures.pgd_m.max(piece.displacement(t).abs());
            }
            (v0, u0) = (piece.velocity(piece.h), piece.displacement(piece.h));
            figures.pgv_m_per_s = figures.pgv_m_per_s.max(v0.abs());
            figures.pgd_m = figures.pgd_m.max(u0.abs());
        }
        figures.end_velocity_m_per_s = v0;
        figures
    }
}

impl Figures {
    /// Figures of the norm of two components; between samples its square is a polynomial of the time.
    fn of_resultant(times_s: &[f64], components: [&[f64]; 2]) -> Self {
        let (mut velocity, mut displacement) = ([0.0; 2], [0.0; 2]);
        let (mut largest_v2, mut largest_u2) = (0.0, 0.0);
        for (k, t) in times_s.windows(2).enumerate() {
            let h = t[1] - t[0];
            let (mut v2, mut u2) = (polynomial::ZERO, polynomial::ZERO);
            for (axis, a) in components.iter().enumerate() {
                let (a0, a1) = (a[k], a[k + 1]);
                let (u0, v0) = (displacement[axis], velocity[axis]);
                add_square(&mut v2, &[v0, a0 * h, 0.5 * (a1 - a0) * h]);
                add_square(&mut u2, &[u0, v0 * h, 0.5 * a0 * h * h, (a1 - a0) * h * h / 6.0]);
                let piece = Piece { u0, v0, a0, a1, h };
                (velocity[axis], displacement[axis]) = (piece.velocity(h), piece.displacement(h));
            }
            (largest_v2, largest_u2) =
                (largest(&v2, 1.0, largest_v2), largest(&u2, 1.0, largest_u2));
        }
        let [x, y] = components;
        let pga = x.iter().zip(y).map(|(x, y)| libm::hypot(*x, *y)).fold(0.0, f64::max);
        Self {
            pga_m_per_s2: pga,
            pgv_m_per_s: largest_v2.sqrt(),
            pgd_m: largest_u2.sqrt(),
            end_velocity_m_per_s: libm::hypot(velocity[0], velocity[1]),
        }
    }
}

/// Adds the square of a short polynomial to another.
fn add_square(sum: &mut polynomial::Polynomial, c: &[f64]) {
    for (i, a) in c.iter().enumerate() {
        for (j, b) in c.iter().enumerate() {
            sum[i + j] += a * b;
        }
    }
}

/// Largest absolute value.
pub(super) fn peak(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |peak, value| value.abs().max(peak))
}

/// One interval of length `h` over which the acceleration runs from `a0` to `a1`.
pub(super) struct Piece {
    pub u0: f64,
    pub v0: f64,
    pub a0: f64,
    pub a1: f64,
    pub h: f64,
}

impl Piece {
    /// `v = v0 + a0 t + (a1 − a0) t²/2h`, written with the acceleration at `t/2`.
    fn velocity(&self, t: f64) -> f64 {
        if self.h == 0.0 {
            return self.v0;
        }
        self.v0 + t * (self.a0 + (self.a1 - self.a0) * (t / self.h) / 2.0)
    }

    /// `u = u0 + v0 t + a0 t²/2 + (a1 − a0) t³/6h`.
    fn displacement(&self, t: f64) -> f64 {
        if self.h == 0.0 {
            return self.u0;
        }
        let mean = self.a0 / 2.0 + (self.a1 - self.a0) * (t / self.h) / 6.0;
        self.u0 + t * (self.v0 + t * mean)
    }

    /// Where the acceleration changes its sign inside.
    fn zero_of_acceleration(&self) -> Option<f64> {
        let (a0, a1) = (self.a0, self.a1);
        let crosses = (a0 < 0.0 && a1 > 0.0) || (a0 > 0.0 && a1 < 0.0);
        (crosses && self.h > 0.0).then(|| self.h * (a0 / (a0 - a1)))
    }

    /// Where the velocity is zero inside: at most twice, as it is quadratic.
    fn zeros_of_velocity(&self) -> [Option<f64>; 2] {
        // q t² + a0 t + v0 = 0, solved in the form that does not cancel.
        let (a0, v0) = (self.a0, self.v0);
        let q = (self.a1 - a0) / (2.0 * self.h);
        let discriminant = a0 * a0 - 4.0 * q * v0;
        if discriminant.is_nan() || discriminant < 0.0 {
            return [None, None];
        }
        let s = -0.5 * (a0 + libm::copysign(libm::sqrt(discriminant), a0));
        [s / q, v0 / s].map(|t| (t > 0.0 && t < self.h).then_some(t))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn motion(times_s: &[f64], values: &[f64]) -> GroundMotion {
        GroundMotion::new(times_s.to_vec(), values.to_vec(), None).unwrap()
    }

    fn close(found: f64, expected: f64) {
        assert!((found - expected).abs() <= 1e-14 * expected.abs().max(1.0), "{found} {expected}");
    }

    /// a from 1 to −1 over 2 s: v = t − t²/2 peaks at 1/2 between the samples and ends at 0;
    /// u = t²/2 − t³/6 ends at 2/3.
    #[test]
    fn peak_velocity_between_samples() {
        let f = motion(&[0.0, 2.0], &[1.0, -1.0]).figures();
        close(f.pga_m_per_s2, 1.0);
        close(f.pgv_m_per_s, 0.5);
        close(f.end_velocity_m_per_s, 0.0);
        close(f.pgd_m, 2.0 / 3.0);
    }

    /// a from 1 to −2 over 3 s: v = t − t²/2 is zero at t = 2, where u = t²/2 − t³/6 peaks at 2/3;
    /// at the end v = −3/2, u = 0.
    #[test]
    fn peak_displacement_between_samples() {
        let f = motion(&[0.0, 3.0], &[1.0, -2.0]).figures();
        close(f.pgv_m_per_s, 1.5);
        close(f.end_velocity_m_per_s, -1.5);
        close(f.pgd_m, 2.0 / 3.0);
    }

    /// Jumps: +1 for 1 s, then −1 for 1 s: v peaks at 1, u ends at 1.
    #[test]
    fn jumps_take_no_time() {
        let f = motion(&[0.0, 1.0, 1.0, 2.0], &[1.0, 1.0, -1.0, -1.0]).figures();
        close(f.pgv_m_per_s, 1.0);
        close(f.end_velocity_m_per_s, 0.0);
        close(f.pgd_m, 1.0);
    }

    /// A constant acceleration has no zero of velocity inside: the quadratic degenerates.
    #[test]
    fn constant_and_zero_acceleration() {
        let f = motion(&[0.0, 2.0], &[3.0, 3.0]).figures();
        close(f.pgv_m_per_s, 6.0);
        close(f.pgd_m, 6.0);
        assert_eq!(motion(&[0.0, 2.0], &[0.0, 0.0]).figures(), Figures::default());
    }
}
