//! Fourier amplitude spectrum of the horizontal acceleration.
//!
//! The transform is that of the samples, as in every other program:
//! `|A(f)| = Δt |Σ a_k e^(−2πi f kΔt)|` at the frequencies `j/(N Δt)`, where the samples are
//! followed by zeros up to a power of two `N`. The sines and cosines are libm's and the order of the
//! sums is fixed: the same bits on every target.

use core::f64::consts::TAU;

use super::GroundMotion;

/// Most points of a transform.
const MOST: usize = 1 << 26;

/// Points on which an uneven motion is sampled at most: so many, or so many for each of its samples.
const UNEVEN: usize = 1 << 20;
const UNEVEN_A_SAMPLE: usize = 16;

/// Amplitudes at evenly spaced frequencies from 0 to the Nyquist frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct FourierSpectrum {
    /// Step between frequencies in Hz: `1/(N Δt)`.
    pub df_hz: f64,
    /// `|A(f)|` in m/s, from frequency 0.
    pub amplitudes_m_per_s: Vec<f64>,
}

impl FourierSpectrum {
    /// Largest step between frequencies where nothing else is asked for, in Hz.
    pub const USUAL_STEP_HZ: f64 = 0.05;

    /// Frequencies in Hz, one an amplitude.
    pub fn frequencies_hz(&self) -> impl Iterator<Item = f64> + '_ {
        (0..self.amplitudes_m_per_s.len()).map(|j| j as f64 * self.df_hz)
    }

    /// Spectrum of a motion, with frequencies at most `df_hz` apart (in Hz, > 0).
    ///
    /// An evenly spaced motion is taken at its samples. An uneven one is sampled along its straight
    /// lines at the shortest of its intervals, though never closer than 0.001 s, nor at more than a
    /// million points or 16 for each sample.
    #[must_use]
    pub fn of(motion: &GroundMotion, df_hz: f64) -> Self {
        let (dt_s, samples) = match motion.dt_s() {
            Some(dt_s) => (dt_s, motion.horizontal_m_per_s2().to_vec()),
            None => evenly(motion),
        };
        // Rounding may not take it below what is asked for, nor above by a factor of two.
        let least = libm::ceil((1.0 / (df_hz * dt_s)).min(MOST as f64) - 1e-6) as usize;
        let n = samples.len().max(least).next_power_of_two();
        let mut re = samples;
        re.resize(n, 0.0);
        let mut im = vec![0.0; n];
        transform(&mut re, &mut im);
        let amplitude = |j: usize| dt_s * libm::sqrt(re[j] * re[j] + im[j] * im[j]);
        Self {
            df_hz: 1.0 / (n as f64 * dt_s),
            amplitudes_m_per_s: (0..=n / 2).map(amplitude).collect(),
        }
    }
}

/// An uneven motion on an even grid: the mean of both sides at a jump.
fn evenly(motion: &GroundMotion) -> (f64, Vec<f64>) {
    let (times_s, values) = (motion.times_s(), motion.horizontal_m_per_s2());
    let shortest = times_s.windows(2).map(|t| t[1] - t[0]).filter(|&h| h > 0.0);
    let shortest_s = shortest.fold(f64::INFINITY, f64::min);
    let duration_s = motion.duration_s();
    let most = (UNEVEN_A_SAMPLE * motion.len()).clamp(UNEVEN, MOST / 2);
    let dt_s = shortest_s.max(1e-3).max(duration_s / most as f64).min(duration_s);
    let count = libm::floor(duration_s / dt_s) as usize + 1;
    let mut samples = Vec::with_capacity(count);
    let mut next = 0;
    for k in 0..count {
        let t = k as f64 * dt_s;
        while next < times_s.len() && times_s[next] < t {
            next += 1;
        }
        let Some(&after_s) = times_s.get(next) else {
            samples.push(0.0);
            continue;
        };
        samples.push(if after_s == t {
            let right = if times_s.get(next + 1) == Some(&t) { next + 1 } else { next };
            0.5 * (values[next] + values[right])
        } else {
            let (before_s, a) = (times_s[next - 1], values[next - 1]);
            a + (values[next] - a) * ((t - before_s) / (after_s - before_s))
        });
    }
    (dt_s, samples)
}

/// Discrete Fourier transform in place, `Σ x_k e^(−2πi jk/n)`; `n` is a power of two.
///
/// Radix 2, decimation in time; every twiddle factor is computed by itself, so that errors do not
/// grow along a recurrence.
pub(super) fn transform(re: &mut [f64], im: &mut [f64]) {
    let n = re.len();
    debug_assert!(n.is_power_of_two() && im.len() == n);
    let mut j = 0;
    for i in 1..n {
        let mut bit = n >> 1;
        while j & bit != 0 {
            j ^= bit;
            bit >>= 1;
        }
        j |= bit;
        if i < j {
            re.swap(i, j);
            im.swap(i, j);
        }
    }
    let twiddles: Vec<[f64; 2]> = (0..n / 2)
        .map(|k| {
            let angle = -TAU * (k as f64 / n as f64);
            [libm::cos(angle), libm::sin(angle)]
        })
        .collect();
    let mut half = 1;
    while half < n {
        let stride = n / (2 * half);
        for start in (0..n).step_by(2 * half) {
            for k in 0..half {
                let [c, s] = twiddles[k * stride];
                let (p, q) = (start + k, start + k + half);
                let (x, y) = (re[q] * c - im[q] * s, re[q] * s + im[q] * c);
                (re[q], im[q]) = (re[p] - x, im[p] - y);
                (re[p], im[p]) = (re[p] + x, im[p] + y);
            }
        }
        half *= 2;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the sum it stands for.
    #[test]
    fn transform_is_the_sum() {
        for n in [1_usize, 2, 4, 8, 64] {
            let x: Vec<f64> = (0..n).map(|k| libm::sin((k * k) as f64) + 0.3).collect();
            let (mut re, mut im) = (x.clone(), vec![0.0; n]);
            transform(&mut re, &mut im);
            for j in 0..n {
                let angle = |k: usize| -TAU * (j * k) as f64 / n as f64;
                let c: f64 = (0..n).map(|k| x[k] * libm::cos(angle(k))).sum();
                let s: f64 = (0..n).map(|k| x[k] * libm::sin(angle(k))).sum();
                assert!((re[j] - c).abs() < 1e-12 && (im[j] - s).abs() < 1e-12, "{n} {j}");
            }
        }
    }

    /// A whole number of cycles of a sine: amplitude A·duration/2 at its frequency.
    #[test]
    fn sine_stands_at_its_frequency() {
        let a: Vec<f64> = (0..1024).map(|k| 3.0 * libm::sin(TAU * f64::from(k) / 64.0)).collect();
        let motion = GroundMotion::evenly_spaced(0.02, a, None).unwrap();
        let spectrum = FourierSpectrum::of(&motion, 1.0);
        assert_eq!(spectrum.amplitudes_m_per_s.len(), 513);
        assert!((spectrum.df_hz - 1.0 / 20.48).abs() < 1e-15);
        assert!((spectrum.amplitudes_m_per_s[16] - 3.0 * 20.48 / 2.0).abs() < 1e-11);
        assert!(spectrum.amplitudes_m_per_s[17] < 1e-10);
        let f: Vec<f64> = spectrum.frequencies_hz().collect();
        assert!((f[16] - 1.0 / (64.0 * 0.02)).abs() < 1e-15);
        // Zeros make the frequencies as close as asked for.
        assert!(FourierSpectrum::of(&motion, 0.04).df_hz <= 0.04);
    }

    #[test]
    fn uneven_motion_is_sampled_along_its_lines() {
        let motion =
            GroundMotion::new(vec![0.0, 1.0, 1.5, 3.0], vec![0.0, 4.0, 4.0, 1.0], None).unwrap();
        let (dt_s, samples) = evenly(&motion);
        assert_eq!((dt_s, samples), (0.5, vec![0.0, 2.0, 4.0, 4.0, 3.0, 2.0, 1.0]));
    }
}
