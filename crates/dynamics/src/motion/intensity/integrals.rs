//! Integrals of the acceleration: Arias intensity and cumulative absolute velocities.

use core::f64::consts::PI;

use crate::motion::GroundMotion;
use crate::units::STANDARD_GRAVITY_M_PER_S2;

/// What a window's peak has to exceed to count in CAVstd, in m/s².
const CAV_STD_THRESHOLD_M_PER_S2: f64 = 0.025 * STANDARD_GRAVITY_M_PER_S2;

/// Length of the windows of CAVstd in s.
const CAV_STD_WINDOW_S: f64 = 1.0;

/// Pieces of the motion that take time: start in s, length in s, acceleration at both ends in m/s².
pub(super) fn pieces(motion: &GroundMotion) -> impl Iterator<Item = (f64, f64, [f64; 2])> {
    let times = motion.times_s().windows(2);
    times
        .zip(motion.horizontal_m_per_s2().windows(2))
        .map(|(t, a)| (t[0], t[1] - t[0], [a[0], a[1]]))
        .filter(|(_, h, _)| *h > 0.0)
}

/// `∫ a² dt` over a straight line.
pub(super) fn energy(h: f64, [a, b]: [f64; 2]) -> f64 {
    h * (a * a + a * b + b * b) / 3.0
}

/// `∫ |a| dt` over a straight line, which may change sign.
fn area(h: f64, [a, b]: [f64; 2]) -> f64 {
    let (p, q) = (a.abs(), b.abs());
    if a * b < 0.0 { 0.5 * h * ((p * p + q * q) / (p + q)) } else { 0.5 * h * (p + q) }
}

/// Arias intensity `π/(2g) ∫ a² dt`, in m/s.
pub(super) fn arias(motion: &GroundMotion) -> f64 {
    let integral: f64 = pieces(motion).map(|(_, h, a)| energy(h, a)).sum();
    PI / (2.0 * STANDARD_GRAVITY_M_PER_S2) * integral
}

/// Cumulative absolute velocity `∫ |a| dt`, in m/s.
pub(super) fn cav(motion: &GroundMotion) -> f64 {
    pieces(motion).map(|(_, h, a)| area(h, a)).sum()
}

/// The part of CAV from windows of 1 s, the first from the start, in which |a| exceeds 0.025 g; the
/// last window may be shorter. In m/s.
pub(super) fn cav_std(motion: &GroundMotion) -> f64 {
    let mut total = 0.0;
    let mut window = Window::default();
    for (start, h, [a, b]) in pieces(motion) {
        let at = |t: f64| a + (b - a) * ((t - start) / h).min(1.0);
        let end = start + h;
        let (mut left, mut a_left) = (start, a);
        // A piece may span many windows: as many as its length has seconds.
        while left < end {
            let edge = (window.index + 1.0) * CAV_STD_WINDOW_S;
            let (right, a_right) = if edge < end { (edge, at(edge)) } else { (end, b) };
            window.add(right - left, [a_left, a_right]);
            if edge <= end {
                total += window.counted();
                window = Window { index: window.index + 1.0, ..Window::default() };
            }
            (left, a_left) = (right, a_right);
        }
    }
    total + window.counted()
}

/// A window of CAVstd as far as it was read.
#[derive(Default)]
struct Window {
    index: f64,
    area: f64,
    peak: f64,
}

impl Window {
    fn add(&mut self, h: f64, ends: [f64; 2]) {
        self.area += area(h, ends);
        self.peak = self.peak.max(ends[0].abs()).max(ends[1].abs());
    }

    fn counted(&self) -> f64 {
        if self.peak > CAV_STD_THRESHOLD_M_PER_S2 { self.area } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn motion(times_s: &[f64], values: &[f64]) -> GroundMotion {
        GroundMotion::new(times_s.to_vec(), values.to_vec(), None).unwrap()
    }

    fn close(found: f64, expected: f64) {
        assert!((found - expected).abs() <= 1e-14 * expected.abs(), "{found} {expected}");
    }

    /// a = 1 − t over 2 s: ∫a² = 2/3, ∫|a| = 1.
    #[test]
    fn sign_change_inside_a_piece() {
        let m = motion(&[0.0, 2.0], &[1.0, -1.0]);
        close(arias(&m), PI / (2.0 * 9.80665) * 2.0 / 3.0);
        close(cav(&m), 1.0);
        // From 3 to −1 over 4 s: ∫|a| = 9/2 + 1/2.
        close(cav(&motion(&[0.0, 4.0], &[3.0, -1.0])), 5.0);
    }

    /// Jumps take no time, and the sampling of a straight line does not matter.
    #[test]
    fn jumps_and_subdivision() {
        close(cav(&motion(&[0.0, 1.0, 1.0, 2.0], &[1.0, 1.0, -1.0, -1.0])), 2.0);
        let fine: Vec<f64> = (0..=70).map(|i| f64::from(i) / 35.0).collect();
        let values: Vec<f64> = fine.iter().map(|t| 1.0 - t).collect();
        let m = motion(&fine, &values);
        assert!((cav(&m) - 1.0).abs() < 1e-14);
        assert!((arias(&m) - PI / (2.0 * 9.80665) * 2.0 / 3.0).abs() < 1e-14);
    }

    /// 1 m/s² in the second of four seconds, which one piece spans as well; 0.2 in the fourth is
    /// below 0.025 g = 0.245, in the fifth, half a second long, 0.3 is above.
    #[test]
    fn windows_of_standardised_cav() {
        let m = motion(
            &[0.0, 1.0, 1.0, 2.0, 2.0, 4.0, 4.0, 4.5],
            &[0.0, 0.0, 1.0, 1.0, 0.2, 0.2, 0.3, 0.3],
        );
        // A limit at a window's edge belongs to the window it comes from.
        close(cav_std(&m), 1.0 + 0.15);
        close(cav(&m), 1.0 + 0.4 + 0.15);
        // A ramp from 0 to 0.5 over 5 s passes 0.245 in its third second.
        let ramp = motion(&[0.0, 5.0], &[0.0, 0.5]);
        close(cav_std(&ramp), 0.5 * 5.0 * 0.5 - 0.5 * 2.0 * 0.2);
        assert_eq!(cav_std(&motion(&[0.0, 3.0], &[0.24, 0.24])), 0.0);
    }
}
