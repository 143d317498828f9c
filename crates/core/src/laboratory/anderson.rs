//! Anderson's scores of one acceleration history, over the whole band.
//!
//! J. G. Anderson, "Quantitative measure of the goodness-of-fit of synthetic seismograms", 13th
//! World Conference on Earthquake Engineering, 2004, paper 243. Ten scores from 0 to 10; below 4
//! is a poor fit, 4 to 6 fair, 6 to 8 good, above 8 excellent. The original repeats them in
//! ten bands of frequency and takes the mean over those, which is his goodness of fit; here they are
//! those of the whole band of the record, and are called so.
//!
//! For two positive numbers `S(a, b) = 10 exp(−((a − b)/min(a, b))²)`, and 10 where both are 0.

use core::f64::consts::TAU;

use super::metrics::peak;
use crate::motion;
use crate::numerics::sort;

/// The scores, each from 0 to 10, in the order of the original.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anderson {
    /// C1 Arias duration, `10 (1 − max|F_m − F_p|)`, `F(t) = ∫₀ᵗ a² / ∫ a²`.
    pub arias_duration: f64,
    /// C2 energy duration: the same with velocity.
    pub energy_duration: f64,
    /// C3 Arias intensity, `S` of `∫ a²`.
    pub arias_intensity: f64,
    /// C4 energy integral, `S` of `∫ v²`.
    pub energy_integral: f64,
    /// C5 `S` of the peak acceleration.
    pub peak_acceleration: f64,
    /// C6 `S` of the peak velocity.
    pub peak_velocity: f64,
    /// C7 `S` of the peak displacement.
    pub peak_displacement: f64,
    /// C8 mean of `S` of the 5 % response spectra of total acceleration.
    pub response_spectrum: f64,
    /// C9 mean of `S` of the Fourier amplitudes.
    pub fourier_spectrum: f64,
    /// C10 `10 max(0, ∫ a_m a_p / √(∫ a_m² ∫ a_p²))`.
    pub cross_correlation: f64,
}

impl Anderson {
    /// The scores with their names.
    #[must_use]
    pub fn scores(&self) -> [(&'static str, f64); 10] {
        [
            ("arias_duration", self.arias_duration),
            ("energy_duration", self.energy_duration),
            ("arias_intensity", self.arias_intensity),
            ("energy_integral", self.energy_integral),
            ("peak_acceleration", self.peak_acceleration),
            ("peak_velocity", self.peak_velocity),
            ("peak_displacement", self.peak_displacement),
            ("response_spectrum", self.response_spectrum),
            ("fourier_spectrum", self.fourier_spectrum),
            ("cross_correlation", self.cross_correlation),
        ]
    }

    /// Their mean.
    #[must_use]
    pub fn mean(&self) -> f64 {
        self.scores().iter().map(|(_, score)| score).sum::<f64>() / 10.0
    }
}

impl Anderson {
    /// The mean with its word; and the lowest score where that deserves another, which a mean of ten hides.
    ///
    /// The score of a peak falls slowly: one that is 22 % low has 9.2. So no mean is called excellent where
    /// the peak, predicted over measured, is off by more than a tenth, none good beyond a fifth.
    #[must_use]
    pub fn words(&self, peak_ratio: Option<f64>) -> String {
        let mean = self.mean();
        let off = peak_ratio.map_or(0.0, |ratio| ratio - 1.0);
        let most = match off.abs() {
            off if off > 0.2 => 5.9,
            off if off > 0.1 => 7.9,
            _ => 10.0,
        };
        if most < mean && word(most) != word(mean) {
            let way = if off < 0.0 { "low" } else { "high" };
            return format!(
                "{mean:.1}, but {}: the peak is {:.0} % {way}",
                word(most),
                100.0 * off.abs()
            );
        }
        let mut scores = self.scores();
        sort(&mut scores, |a, b| a.1.total_cmp(&b.1));
        let (name, lowest) = scores[0];
        if word(lowest) == word(mean) {
            return format!("{mean:.1} {}", word(mean));
        }
        format!("{mean:.1}, {} {lowest:.1} {}", in_words(name), word(lowest))
    }
}

/// What a score is called in texts: `Arias duration` of `arias_duration`.
#[must_use]
pub fn in_words(name: &str) -> String {
    // Those that are called after a person begin with a capital letter.
    name.replace('_', " ").replace("arias", "Arias").replace("fourier", "Fourier")
}

/// The word for a score.
#[must_use]
pub fn word(score: f64) -> &'static str {
    match score {
        s if s < 4.0 => "poor",
        s if s < 6.0 => "fair",
        s if s < 8.0 => "good",
        _ => "excellent",
    }
}

/// `S(a, b)` of two numbers that are not negative.
#[must_use]
pub fn score(a: f64, b: f64) -> f64 {
    let least = a.min(b);
    if a == b {
        return 10.0;
    }
    if !(least > 0.0) {
        return 0.0;
    }
    let ratio = (a - b) / least;
    10.0 * libm::exp(-ratio * ratio)
}

/// Number of periods and of frequencies at which spectra are compared.
const ORDINATES: usize = 40;

/// Scores of two accelerations in m/s² at the same times, which increase.
///
/// Velocity and displacement are trapezoidal integrals; the straight line that fits the velocity
/// best is taken off before it is integrated again, alike in both, so that an offset of a sensor
/// does not become a displacement. Spectra are compared at 40 periods from 4 steps (0.05 s at
/// least) to a fifth of the duration (10 s at most), and at the frequencies of those periods.
/// `None` for fewer than 16 samples, or where a history is zero throughout.
#[must_use]
pub fn anderson(times_s: &[f64], measured: &[f64], predicted: &[f64]) -> Option<Anderson> {
    let n = times_s.len();
    if n < 16 || measured.len() != n || predicted.len() != n {
        return None;
    }
    let duration_s = times_s[n - 1] - times_s[0];
    let [m, p] = [measured, predicted].map(|a| Integrals::of(times_s, a));
    let (im, ip) = (total(&m.arias), total(&p.arias));
    let (em, ep) = (total(&m.energy), total(&p.energy));
    if !(im > 0.0 && ip > 0.0 && em > 0.0 && ep > 0.0) {
        return None;
    }
    let product: Vec<f64> = measured.iter().zip(predicted).map(|(a, b)| a * b).collect();
    let cross = total(&integral(times_s, &product)) / (im * ip).sqrt();
    let periods_s = periods(duration_s, duration_s / (n - 1) as f64);
    let mut responses = [Vec::new(), Vec::new()];
    for (values, to) in [measured, predicted].iter().zip(&mut responses) {
        let spectrum = motion::spectrum(times_s, values, &periods_s, &[0.05]).ok()?;
        *to = spectrum.of_damping(0).iter().map(|ordinates| ordinates.sa_m_per_s2).collect();
    }
    let mean_score = |a: &[f64], b: &[f64]| {
        a.iter().zip(b).map(|(a, b)| score(*a, *b)).sum::<f64>() / a.len().max(1) as f64
    };
    let fourier = |values: &[f64]| -> Vec<f64> {
        periods_s.iter().map(|period_s| amplitude(times_s, values, TAU / period_s)).collect()
    };
    Some(Anderson {
        arias_duration: 10.0 * (1.0 - widest(&m.arias, &p.arias)),
        energy_duration: 10.0 * (1.0 - widest(&m.energy, &p.energy)),
        arias_intensity: score(im, ip),
        energy_integral: score(em, ep),
        peak_acceleration: score(peak(measured).0, peak(predicted).0),
        peak_velocity: score(peak(&m.velocity).0, peak(&p.velocity).0),
        peak_displacement: score(peak(&m.displacement).0, peak(&p.displacement).0),
        response_spectrum: mean_score(&responses[0], &responses[1]),
        fourier_spectrum: mean_score(&fourier(measured), &fourier(predicted)),
        cross_correlation: 10.0 * cross.max(0.0),
    })
}

/// What is integrated from an acceleration.
struct Integrals {
    velocity: Vec<f64>,
    displacement: Vec<f64>,
    arias: Vec<f64>,
    energy: Vec<f64>,
}

impl Integrals {
    fn of(times_s: &[f64], acceleration: &[f64]) -> Self {
        let squares = |values: &[f64]| values.iter().map(|v| v * v).collect::<Vec<f64>>();
        let velocity = without_line(times_s, &integral(times_s, acceleration));
        let displacement = integral(times_s, &velocity);
        Self {
            arias: integral(times_s, &squares(acceleration)),
            energy: integral(times_s, &squares(&velocity)),
            velocity,
            displacement,
        }
    }
}

/// Running integral by the trapezium rule, from 0.
fn integral(times_s: &[f64], values: &[f64]) -> Vec<f64> {
    let mut sum = 0.0;
    let mut sums = vec![0.0];
    for (t, v) in times_s.windows(2).zip(values.windows(2)) {
        sum += 0.5 * (t[1] - t[0]) * (v[0] + v[1]);
        sums.push(sum);
    }
    sums
}

fn total(running: &[f64]) -> f64 {
    running.last().copied().unwrap_or(0.0)
}

/// Values less the straight line of least squares.
fn without_line(times_s: &[f64], values: &[f64]) -> Vec<f64> {
    let n = values.len() as f64;
    let (t0, v0) = (times_s.iter().sum::<f64>() / n, values.iter().sum::<f64>() / n);
    let (mut tt, mut tv) = (0.0, 0.0);
    for (t, v) in times_s.iter().zip(values) {
        tt += (t - t0) * (t - t0);
        tv += (t - t0) * (v - v0);
    }
    let slope = if tt > 0.0 { tv / tt } else { 0.0 };
    times_s.iter().zip(values).map(|(t, v)| v - v0 - slope * (t - t0)).collect()
}

/// Largest difference of two running integrals, each over its own total.
fn widest(a: &[f64], b: &[f64]) -> f64 {
    let (ta, tb) = (total(a), total(b));
    a.iter().zip(b).fold(0.0, |widest: f64, (a, b)| widest.max((a / ta - b / tb).abs()))
}

/// Periods in equal ratios.
fn periods(duration_s: f64, dt_s: f64) -> Vec<f64> {
    let shortest_s = (4.0 * dt_s).max(0.05);
    let longest_s = (0.2 * duration_s).min(10.0).max(1.01 * shortest_s);
    let step = libm::log(longest_s / shortest_s) / (ORDINATES - 1) as f64;
    (0..ORDINATES).map(|i| shortest_s * libm::exp(step * i as f64)).collect()
}

/// `|∫ a e^{−iωt} dt|` by the trapezium rule.
fn amplitude(times_s: &[f64], values: &[f64], omega: f64) -> f64 {
    let (mut re, mut im) = (0.0, 0.0);
    let n = times_s.len();
    for i in 0..n {
        let before_s = times_s[i] - times_s[i.saturating_sub(1)];
        let after_s = times_s[(i + 1).min(n - 1)] - times_s[i];
        let weight = 0.5 * (before_s + after_s) * values[i];
        let (sin, cos) = libm::sincos(omega * (times_s[i] - times_s[0]));
        re += weight * cos;
        im -= weight * sin;
    }
    (re * re + im * im).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(factor: f64, shift_s: f64) -> (Vec<f64>, Vec<f64>) {
        let times_s: Vec<f64> = (0..2001).map(|i| 0.01 * f64::from(i)).collect();
        let value = |t: f64| {
            let t = t - shift_s;
            factor * libm::exp(-0.1 * (t - 6.0) * (t - 6.0)) * libm::sin(TAU * 1.5 * t)
        };
        let values = times_s.iter().map(|t| value(*t)).collect();
        (times_s, values)
    }

    #[test]
    fn equal_histories_score_ten() {
        let (times_s, a) = wave(1.0, 0.0);
        let scores = anderson(&times_s, &a, &a).unwrap();
        for (name, score) in scores.scores() {
            assert!((score - 10.0).abs() < 1e-9, "{name} {score}");
        }
        assert!((scores.mean() - 10.0).abs() < 1e-9);
    }

    /// Twice the history: amplitudes score 10/e, their squares 10/e⁹, shapes 10.
    #[test]
    fn doubled_history() {
        let ((times_s, a), (_, b)) = (wave(1.0, 0.0), wave(2.0, 0.0));
        let s = anderson(&times_s, &a, &b).unwrap();
        let (e1, e9) = (10.0 * libm::exp(-1.0), 10.0 * libm::exp(-9.0));
        for found in [s.peak_acceleration, s.peak_velocity, s.peak_displacement] {
            assert!((found - e1).abs() < 1e-9, "{found}");
        }
        assert!((s.response_spectrum - e1).abs() < 1e-9 && (s.fourier_spectrum - e1).abs() < 1e-6);
        assert!((s.arias_intensity - e9).abs() < 1e-9 && (s.energy_integral - e9).abs() < 1e-9);
        assert!((s.arias_duration - 10.0).abs() < 1e-9 && (s.energy_duration - 10.0).abs() < 1e-9);
        assert!((s.cross_correlation - 10.0).abs() < 1e-9);
    }

    #[test]
    fn words_and_edges() {
        assert_eq!([3.9, 4.0, 6.0, 8.0].map(word), ["poor", "fair", "good", "excellent"]);
        let all = |cross_correlation| Anderson {
            arias_duration: 9.5,
            energy_duration: 9.5,
            arias_intensity: 9.5,
            energy_integral: 9.5,
            peak_acceleration: 9.5,
            peak_velocity: 9.5,
            peak_displacement: 9.5,
            response_spectrum: 9.5,
            fourier_spectrum: 9.5,
            cross_correlation,
        };
        assert_eq!(in_words("arias_intensity"), "Arias intensity");
        assert_eq!(in_words("cross_correlation"), "cross correlation");
        assert_eq!(all(9.5).words(Some(0.93)), "9.5 excellent");
        assert_eq!(all(6.7).words(None), "9.2, cross correlation 6.7 good");
        assert_eq!(all(9.5).words(Some(0.78)), "9.5, but fair: the peak is 22 % low");
        assert_eq!(all(9.5).words(Some(1.15)), "9.5, but good: the peak is 15 % high");
        assert_eq!((score(0.0, 0.0), score(0.0, 1.0), score(2.0, 2.0)), (10.0, 0.0, 10.0));
        let (times_s, a) = wave(1.0, 0.0);
        assert!(anderson(&times_s, &a, &vec![0.0; a.len()]).is_none());
        assert!(anderson(&times_s[..10], &a[..10], &a[..10]).is_none());
        let (_, late) = wave(1.0, 1.0 / 3.0);
        let shifted = anderson(&times_s, &a, &late).unwrap();
        assert_eq!(shifted.cross_correlation, 0.0, "half a period late");
    }
}
