//! Durations: between shares of the Arias intensity, and above a threshold.

use super::integrals::{energy, pieces};
use crate::motion::GroundMotion;

/// Time between two shares of `∫ a² dt`, in s; 0 for a motion that is zero.
///
/// The integral is a cubic inside each piece, which is inverted exactly.
pub(super) fn significant(motion: &GroundMotion, from: f64, to: f64) -> f64 {
    let total: f64 = pieces(motion).map(|(_, h, a)| energy(h, a)).sum();
    if total == 0.0 {
        return 0.0;
    }
    let time_of = |share: f64| {
        let wanted = share * total;
        let mut sum = 0.0;
        for (start, h, ends) in pieces(motion) {
            let next = sum + energy(h, ends);
            if next >= wanted {
                return start + h * fraction(h, ends, wanted - sum);
            }
            sum = next;
        }
        motion.duration_s()
    };
    time_of(to) - time_of(from)
}

/// The part `x` of a piece over which `∫ a² dt` reaches `wanted`.
///
/// `h (a² x + a d x² + d² x³/3)` with `d = b − a` does not decrease: Newton's method, which
/// bisection keeps in its bracket.
fn fraction(h: f64, [a, b]: [f64; 2], wanted: f64) -> f64 {
    let d = b - a;
    let (mut low, mut high) = (0.0, 1.0);
    let mut x = 0.5;
    for _ in 0..100 {
        let value = h * x * (a * a + x * (a * d + x * (d * d / 3.0))) - wanted;
        if value < 0.0 {
            low = x;
        } else {
            high = x;
        }
        let at = a + d * x;
        let next = x - value / (h * at * at);
        let next = if next > low && next < high { next } else { 0.5 * (low + high) };
        if (next - x).abs() <= f64::EPSILON {
            return next;
        }
        x = next;
    }
    x
}

/// Times above a threshold.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Above {
    /// From the first to the last time, in s.
    pub bracketed_s: f64,
    /// Their sum, in s.
    pub uniform_s: f64,
}

/// Times during which |a| is above `threshold`, with crossings inside pieces.
///
/// A value that is above at one side of a jump only, for no time, is not above.
pub(super) fn above(motion: &GroundMotion, threshold: f64) -> Above {
    let mut span: Option<[f64; 2]> = None;
    let mut uniform_s = 0.0;
    let mut add = |from: f64, to: f64| {
        uniform_s += to - from;
        let first = span.map_or(from, |[first, _]| first);
        span = Some([first, to]);
    };
    for (start, h, [a, b]) in pieces(motion) {
        if a.abs() <= threshold && b.abs() <= threshold {
            continue;
        }
        // Where the line passes a level; outside (0, 1) where it does not.
        let at = |level: f64| start + h * ((level - a) / (b - a));
        let mut side = |a: f64, b: f64, level: f64| match (a > threshold, b > threshold) {
            (true, true) => add(start, start + h),
            (true, false) => add(start, at(level)),
            (false, true) => add(at(level), start + h),
            (false, false) => {}
        };
        if a > b {
            side(a, b, threshold);
            side(-a, -b, -threshold);
        } else {
            side(-a, -b, -threshold);
            side(a, b, threshold);
        }
    }
    Above { bracketed_s: span.map_or(0.0, |[first, last]| last - first), uniform_s }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn motion(times_s: &[f64], values: &[f64]) -> GroundMotion {
        GroundMotion::new(times_s.to_vec(), values.to_vec(), None).unwrap()
    }

    fn close(found: f64, expected: f64) {
        assert!((found - expected).abs() <= 2e-15 * expected.abs().max(1.0), "{found} {expected}");
    }

    /// a = t over [0, 1]: ∫a² = t³/3, so the share p is reached at p^(1/3).
    #[test]
    fn significant_duration_of_a_ramp() {
        let m = motion(&[0.0, 1.0], &[0.0, 1.0]);
        close(significant(&m, 0.05, 0.95), libm::cbrt(0.95) - libm::cbrt(0.05));
        close(significant(&m, 0.05, 0.75), libm::cbrt(0.75) - libm::cbrt(0.05));
        // Falling, it is the mirror image in time.
        let m = motion(&[0.0, 1.0], &[-1.0, 0.0]);
        close(significant(&m, 0.05, 0.95), libm::cbrt(0.95) - libm::cbrt(0.05));
    }

    /// Through zero: a = 1 − t over [0, 2] has ∫a² = (1 − (1 − t)³)/3.
    #[test]
    fn significant_duration_through_zero() {
        let m = motion(&[0.0, 2.0], &[1.0, -1.0]);
        close(significant(&m, 0.05, 0.95), 2.0 * libm::cbrt(0.9));
    }

    #[test]
    fn significant_duration_of_constant_and_zero() {
        close(significant(&motion(&[0.0, 4.0], &[2.0, 2.0]), 0.05, 0.95), 3.6);
        assert_eq!(significant(&motion(&[0.0, 4.0], &[0.0, 0.0]), 0.05, 0.95), 0.0);
    }

    /// From 2 to −3 over 5 s, above 1 in the first and the last two seconds.
    #[test]
    fn crossings_of_a_threshold() {
        let m = motion(&[0.0, 1.0, 6.0, 6.0, 8.0], &[0.0, 2.0, -3.0, 0.0, 0.0]);
        let found = above(&m, 1.0);
        close(found.bracketed_s, 5.5);
        close(found.uniform_s, 0.5 + 1.0 + 2.0);
        assert_eq!(above(&m, 3.0), Above::default());
        let found = above(&m, 0.0);
        close(found.bracketed_s, 6.0);
        close(found.uniform_s, 6.0);
    }

    #[test]
    fn one_sided_limit_of_a_jump_takes_no_time() {
        let m = motion(&[0.0, 1.0, 1.0, 2.0], &[0.0, 0.0, 5.0, 5.0]);
        close(above(&m, 1.0).bracketed_s, 1.0);
        close(above(&m, 1.0).uniform_s, 1.0);
    }
}
