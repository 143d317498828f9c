//! Made motions: sines, sweeps and pulses.

use core::f64::consts::{PI, TAU};

use super::GroundMotion;
use super::combine::steps;
use crate::error::MotionError;

/// A harmonic motion, `Ü = A e(t) sin(2π f t + φ)`.
///
/// The envelope `e` rises linearly from 0 to 1 over `ramp_s` and falls back to 0 over the last
/// `decay_s`. Sampled at `k dt` and at the exact end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sine {
    /// `f` in Hz, > 0.
    pub frequency_hz: f64,
    /// `A` in m/s².
    pub amplitude_m_per_s2: f64,
    /// Duration in s, > 0.
    pub duration_s: f64,
    /// Step between samples in s, > 0.
    pub dt_s: f64,
    /// `φ` in rad.
    pub phase_rad: f64,
    /// Rise of the envelope in s, ≥ 0.
    pub ramp_s: f64,
    /// Fall of the envelope in s, ≥ 0; with the rise at most the duration.
    pub decay_s: f64,
}

/// How the frequency of a sweep moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SweepKind {
    /// By the same number of Hz every second.
    Linear,
    /// By the same number of octaves every second.
    Logarithmic,
}

/// A harmonic motion whose frequency moves from one value to another; envelope and samples as for
/// [`Sine`], and phase 0 at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sweep {
    /// Frequency at the start in Hz, > 0.
    pub from_hz: f64,
    /// Frequency at the end in Hz, > 0.
    pub to_hz: f64,
    /// How it moves between.
    pub kind: SweepKind,
    /// Amplitude in m/s².
    pub amplitude_m_per_s2: f64,
    /// Duration in s, > 0.
    pub duration_s: f64,
    /// Step between samples in s, > 0.
    pub dt_s: f64,
    /// Rise of the envelope in s, ≥ 0.
    pub ramp_s: f64,
    /// Fall of the envelope in s, ≥ 0; with the rise at most the duration.
    pub decay_s: f64,
}

/// Form of a pulse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PulseShape {
    /// Half a period of a sine.
    HalfSine,
    /// Constant, with jumps at both ends.
    Rectangular,
    /// Linear to its peak in the middle and back.
    Triangular,
}

/// A single pulse after a rest. Sampled at `k dt`, at its corners and at its exact end, so that
/// rectangle and triangle are exact; the edges of a rectangle are jumps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pulse {
    /// Form.
    pub shape: PulseShape,
    /// Peak in m/s².
    pub amplitude_m_per_s2: f64,
    /// Duration of the pulse itself in s, > 0.
    pub duration_s: f64,
    /// Rest before it in s, ≥ 0.
    pub start_s: f64,
    /// Step between samples in s, > 0.
    pub dt_s: f64,
}

impl Sine {
    /// The samples.
    ///
    /// # Errors
    /// [`MotionError::OutOfRange`], which names the parameter; [`MotionError::TooLong`] before
    /// anything is allocated.
    pub fn motion(&self) -> Result<GroundMotion, MotionError> {
        positive("frequency in Hz", self.frequency_hz)?;
        finite("phase in rad", self.phase_rad)?;
        let envelope = Envelope::new(self.duration_s, self.ramp_s, self.decay_s)?;
        let rate = TAU * self.frequency_hz;
        sampled(self.amplitude_m_per_s2, self.duration_s, self.dt_s, |t| {
            envelope.at(t) * libm::sin(rate * t + self.phase_rad)
        })
    }
}

impl Sweep {
    /// The samples.
    ///
    /// # Errors
    /// As [`Sine::motion`].
    pub fn motion(&self) -> Result<GroundMotion, MotionError> {
        positive("from in Hz", self.from_hz)?;
        positive("to in Hz", self.to_hz)?;
        let envelope = Envelope::new(self.duration_s, self.ramp_s, self.decay_s)?;
        sampled(self.amplitude_m_per_s2, self.duration_s, self.dt_s, |t| {
            envelope.at(t) * libm::sin(TAU * self.cycles(t))
        })
    }

    /// Cycles done at time `t`, ∫f dt.
    fn cycles(&self, t: f64) -> f64 {
        let (f0, f1, d) = (self.from_hz, self.to_hz, self.duration_s);
        let octaves = libm::log(f1 / f0);
        match self.kind {
            SweepKind::Logarithmic if octaves != 0.0 => {
                f0 * d / octaves * libm::expm1(octaves * (t / d))
            }
            _ => t * (f0 + (f1 - f0) * (t / d) / 2.0),
        }
    }
}

impl Pulse {
    /// The samples, from the start of the rest to the end of the pulse.
    ///
    /// # Errors
    /// As [`Sine::motion`].
    pub fn motion(&self) -> Result<GroundMotion, MotionError> {
        finite("amplitude in m/s²", self.amplitude_m_per_s2)?;
        positive("duration in s", self.duration_s)?;
        positive("dt in s", self.dt_s)?;
        not_negative("start in s", self.start_s)?;
        let (start_s, end_s) = (self.start_s, self.start_s + self.duration_s);
        let samples = steps(end_s, self.dt_s, 4)?;
        let middle_s = start_s + self.duration_s / 2.0;
        let corners = match self.shape {
            PulseShape::Triangular => vec![start_s, middle_s],
            _ => vec![start_s],
        };
        let times_s = merged(samples, self.dt_s, &corners, end_s);
        let jumps = self.shape == PulseShape::Rectangular && start_s > 0.0;
        let mut motion_s = Vec::with_capacity(times_s.len() + 1);
        let mut values = Vec::with_capacity(times_s.len() + 1);
        for t in times_s {
            if jumps && t == start_s {
                motion_s.push(t);
                values.push(0.0);
            }
            motion_s.push(t);
            values.push(self.amplitude_m_per_s2 * self.shape_at((t - start_s) / self.duration_s));
        }
        GroundMotion::new(motion_s, values, None)
    }

    /// Form at a fraction of its duration, 1 at its peak, 0 outside.
    fn shape_at(&self, fraction: f64) -> f64 {
        if !(0.0..=1.0).contains(&fraction) {
            return 0.0;
        }
        match self.shape {
            PulseShape::Rectangular => 1.0,
            PulseShape::Triangular => 1.0 - (2.0 * fraction - 1.0).abs(),
            // The sine of π as stored is not quite 0.
            PulseShape::HalfSine if fraction == 1.0 => 0.0,
            PulseShape::HalfSine => libm::sin(PI * fraction),
        }
    }
}

/// Times `k dt`, the corners and the end, in order; a corner stands for a multiple next to it.
fn merged(samples: usize, dt_s: f64, corners: &[f64], end_s: f64) -> Vec<f64> {
    let near = |a: f64, b: f64| (a - b).abs() <= (1e-6 * dt_s).max(4.0 * f64::EPSILON * a);
    let mut times_s: Vec<f64> = (0..samples)
        .map(|k| k as f64 * dt_s)
        .filter(|&t| !near(end_s, t) && !corners.iter().any(|&corner| near(corner, t)))
        .chain(corners.iter().copied())
        .collect();
    if corners.first() != Some(&0.0) && times_s.first() != Some(&0.0) {
        // The first corner is next to 0 and took its place.
        times_s.push(0.0);
    }
    times_s.push(end_s);
    times_s.sort_unstable_by(f64::total_cmp);
    times_s
}

/// Rise and fall of the amplitude.
struct Envelope {
    duration_s: f64,
    ramp_s: f64,
    decay_s: f64,
}

impl Envelope {
    fn new(duration_s: f64, ramp_s: f64, decay_s: f64) -> Result<Self, MotionError> {
        positive("duration in s", duration_s)?;
        not_negative("ramp in s", ramp_s)?;
        not_negative("decay in s", decay_s)?;
        in_range("ramp + decay in s", "at most the duration", ramp_s + decay_s, |sum| {
            sum <= duration_s
        })?;
        Ok(Self { duration_s, ramp_s, decay_s })
    }

    fn at(&self, t: f64) -> f64 {
        let left_s = self.duration_s - t;
        let rise = if t < self.ramp_s { t / self.ramp_s } else { 1.0 };
        let fall = if left_s < self.decay_s { left_s / self.decay_s } else { 1.0 };
        rise * fall
    }
}

/// `amplitude × form(t)` at `k dt` and at the exact end.
fn sampled(
    amplitude_m_per_s2: f64,
    duration_s: f64,
    dt_s: f64,
    form: impl Fn(f64) -> f64,
) -> Result<GroundMotion, MotionError> {
    finite("amplitude in m/s²", amplitude_m_per_s2)?;
    positive("dt in s", dt_s)?;
    let samples = steps(duration_s, dt_s, 1)?;
    let times_s: Vec<f64> =
        (0..samples).map(|k| k as f64 * dt_s).chain(core::iter::once(duration_s)).collect();
    let values = times_s.iter().map(|&t| amplitude_m_per_s2 * form(t)).collect();
    GroundMotion::new(times_s, values, None)
}

fn finite(quantity: &'static str, found: f64) -> Result<(), MotionError> {
    in_range(quantity, "a finite number", found, |_| true)
}

fn positive(quantity: &'static str, found: f64) -> Result<(), MotionError> {
    in_range(quantity, "a finite number > 0", found, |x| x > 0.0)
}

fn not_negative(quantity: &'static str, found: f64) -> Result<(), MotionError> {
    in_range(quantity, "a finite number ≥ 0", found, |x| x >= 0.0)
}

fn in_range(
    quantity: &'static str,
    expected: &'static str,
    found: f64,
    holds: impl Fn(f64) -> bool,
) -> Result<(), MotionError> {
    if found.is_finite() && holds(found) {
        Ok(())
    } else {
        Err(MotionError::OutOfRange { quantity, expected, found })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SINE: Sine = Sine {
        frequency_hz: 1.0,
        amplitude_m_per_s2: 2.0,
        duration_s: 3.0,
        dt_s: 0.25,
        phase_rad: 0.0,
        ramp_s: 0.0,
        decay_s: 0.0,
    };

    fn close(found: &[f64], expected: &[f64]) {
        assert_eq!(found.len(), expected.len());
        for (f, e) in found.iter().zip(expected) {
            assert!((f - e).abs() < 1e-14, "{found:?} {expected:?}");
        }
    }

    #[test]
    fn sine_at_quarter_periods() {
        let m = Sine { duration_s: 1.0, ..SINE }.motion().unwrap();
        assert_eq!(m.dt_s(), Some(0.25));
        close(m.horizontal_m_per_s2(), &[0.0, 2.0, 0.0, -2.0, 0.0]);
        let m = Sine { duration_s: 1.0, phase_rad: PI / 2.0, ..SINE }.motion().unwrap();
        close(m.horizontal_m_per_s2(), &[2.0, 0.0, -2.0, 0.0, 2.0]);
    }

    #[test]
    fn envelope_rises_and_falls_linearly() {
        let m = Sine { ramp_s: 1.0, decay_s: 0.5, ..SINE }.motion().unwrap();
        let expected = [0.0, 0.5, 0.0, -1.5, 0.0, 2.0, 0.0, -2.0, 0.0, 2.0, 0.0, -1.0, 0.0];
        close(m.horizontal_m_per_s2(), &expected);
    }

    #[test]
    fn last_sample_is_at_the_end() {
        let m = Sine { duration_s: 0.6, ..SINE }.motion().unwrap();
        assert_eq!(m.times_s(), [0.0, 0.25, 0.5, 0.6]);
        // 0.3/0.1 is not 3 in binary: no interval of rounding's length.
        let m = Sine { duration_s: 0.3, dt_s: 0.1, ..SINE }.motion().unwrap();
        assert_eq!((m.len(), m.duration_s(), m.dt_s()), (4, 0.3, Some(0.1)));
        let m = Sine { duration_s: 0.1, dt_s: 1.0, ..SINE }.motion().unwrap();
        assert_eq!(m.times_s(), [0.0, 0.1]);
    }

    #[test]
    fn a_million_million_samples_are_refused_at_once() {
        let error = Sine { duration_s: 1e12, dt_s: 1.0, ..SINE }.motion().unwrap_err();
        assert!(matches!(error, MotionError::TooLong { found } if found > 1e12 - 1.0));
        let tiny = Sine { dt_s: 1e-300, ..SINE }.motion();
        assert!(matches!(tiny, Err(MotionError::TooLong { .. })));
        let pulse = Pulse { dt_s: 1e-12, ..PULSE }.motion();
        assert!(matches!(pulse, Err(MotionError::TooLong { .. })));
    }

    #[test]
    fn parameters_out_of_range_are_named() {
        for (sine, quantity) in [
            (Sine { frequency_hz: 0.0, ..SINE }, "frequency in Hz"),
            (Sine { amplitude_m_per_s2: f64::NAN, ..SINE }, "amplitude in m/s²"),
            (Sine { duration_s: -1.0, ..SINE }, "duration in s"),
            (Sine { dt_s: 0.0, ..SINE }, "dt in s"),
            (Sine { ramp_s: -1.0, ..SINE }, "ramp in s"),
            (Sine { ramp_s: 2.0, decay_s: 2.0, ..SINE }, "ramp + decay in s"),
            (Sine { phase_rad: f64::INFINITY, ..SINE }, "phase in rad"),
        ] {
            match sine.motion() {
                Err(MotionError::OutOfRange { quantity: found, .. }) => assert_eq!(found, quantity),
                other => panic!("{quantity}: {other:?}"),
            }
        }
    }

    const SWEEP: Sweep = Sweep {
        from_hz: 1.0,
        to_hz: 3.0,
        kind: SweepKind::Linear,
        amplitude_m_per_s2: 1.0,
        duration_s: 4.0,
        dt_s: 0.5,
        ramp_s: 0.0,
        decay_s: 0.0,
    };

    /// The frequency is the derivative of the cycles: the stated ones at both ends, their mean
    /// (arithmetic or geometric) in the middle.
    #[test]
    fn sweep_frequencies() {
        for (kind, middle) in [(SweepKind::Linear, 2.0), (SweepKind::Logarithmic, 3_f64.sqrt())] {
            let sweep = Sweep { kind, ..SWEEP };
            for (t, f) in [(0.0, 1.0), (2.0, middle), (4.0, 3.0)] {
                let e = 1e-5;
                let found = (sweep.cycles(t + e) - sweep.cycles(t - e)) / (2.0 * e);
                assert!((found - f).abs() < 1e-8, "{kind:?} at {t}: {found} {f}");
            }
        }
        close(&[SWEEP.cycles(4.0)], &[8.0]);
        close(
            &[Sweep { kind: SweepKind::Logarithmic, ..SWEEP }.cycles(4.0)],
            &[8.0 / libm::log(3.0)],
        );
    }

    #[test]
    fn sweep_of_one_frequency_is_a_sine() {
        let sine = Sine { amplitude_m_per_s2: 1.0, ..SINE }.motion().unwrap();
        for kind in [SweepKind::Linear, SweepKind::Logarithmic] {
            let sweep = Sweep { kind, to_hz: 1.0, duration_s: 3.0, dt_s: 0.25, ..SWEEP };
            close(sweep.motion().unwrap().horizontal_m_per_s2(), sine.horizontal_m_per_s2());
        }
    }

    const PULSE: Pulse = Pulse {
        shape: PulseShape::Rectangular,
        amplitude_m_per_s2: 3.0,
        duration_s: 0.5,
        start_s: 0.25,
        dt_s: 0.2,
    };

    #[test]
    fn edges_of_a_rectangle_are_jumps() {
        let m = PULSE.motion().unwrap();
        let times_s = [0.0, 0.2, 0.25, 0.25, 0.4, 0.2 * 3.0, 0.75];
        assert_eq!(m.times_s(), times_s);
        assert_eq!(m.horizontal_m_per_s2(), [0.0, 0.0, 0.0, 3.0, 3.0, 3.0, 3.0]);
        let f = m.figures();
        close(&[f.pgv_m_per_s, f.pgd_m], &[1.5, 0.375]);
        let m = Pulse { start_s: 0.0, ..PULSE }.motion().unwrap();
        assert_eq!(m.times_s(), [0.0, 0.2, 0.4, 0.5]);
        assert_eq!(m.horizontal_m_per_s2(), [3.0; 4]);
    }

    #[test]
    fn triangle_has_its_corners() {
        let m = Pulse { shape: PulseShape::Triangular, ..PULSE }.motion().unwrap();
        assert_eq!(m.times_s(), [0.0, 0.2, 0.25, 0.4, 0.5, 0.2 * 3.0, 0.75]);
        close(&[m.figures().pga_m_per_s2, m.figures().pgv_m_per_s], &[3.0, 0.75]);
        close(&m.horizontal_m_per_s2()[6..], &[0.0]);
    }

    #[test]
    fn half_sine_ends_at_zero() {
        let pulse = Pulse { shape: PulseShape::HalfSine, start_s: 0.5, dt_s: 0.125, ..PULSE };
        let m = pulse.motion().unwrap();
        let h = 3.0 / 2_f64.sqrt();
        close(m.horizontal_m_per_s2(), &[0.0, 0.0, 0.0, 0.0, 0.0, h, 3.0, h, 0.0]);
        assert_eq!(m.horizontal_m_per_s2()[8], 0.0);
        assert_eq!(m.dt_s(), Some(0.125));
    }
}
