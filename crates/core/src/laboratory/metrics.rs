//! How far a predicted history is from a measured one: figures of two series on the same times.
//!
//! `m` is measured, `p` predicted; sums run over all samples, which are taken as equally heavy.
//! Russell's errors: D. M. Russell, "Error measures for comparing transient data: Part I",
//! 68th Shock and Vibration Symposium, 1997.

/// Russell's errors of magnitude and phase, both 0 for equal histories.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Russell {
    /// `M = sgn(e) log₁₀(1 + |e|)`, `e = (Σp² − Σm²) / √(Σm² Σp²)`; > 0 where the prediction is
    /// the larger.
    pub magnitude: f64,
    /// `P = acos(Σmp / √(Σm² Σp²)) / π`, between 0 and 1.
    pub phase: f64,
    /// `C = √(π/4 (M² + P²))`; up to 0.15 is called excellent, up to 0.28 acceptable.
    pub comprehensive: f64,
}

/// Largest absolute value and its index; 0 of nothing.
#[must_use]
pub fn peak(values: &[f64]) -> (f64, usize) {
    let mut best = (0.0, 0);
    for (index, value) in values.iter().enumerate() {
        if value.abs() > best.0 {
            best = (value.abs(), index);
        }
    }
    best
}

/// Root of the mean square.
#[must_use]
pub fn rms(values: &[f64]) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    // Scaled, so that squares neither overflow nor vanish.
    let (largest, _) = peak(values);
    if largest == 0.0 {
        return 0.0;
    }
    let sum: f64 = values.iter().map(|v| (v / largest) * (v / largest)).sum();
    largest * (sum / values.len() as f64).sqrt()
}

/// Root of the mean square of `p − m`.
#[must_use]
pub fn rms_error(measured: &[f64], predicted: &[f64]) -> f64 {
    let errors: Vec<f64> = predicted.iter().zip(measured).map(|(p, m)| p - m).collect();
    rms(&errors)
}

/// Pearson's coefficient of correlation; `None` where one of them is constant.
#[must_use]
pub fn correlation(measured: &[f64], predicted: &[f64]) -> Option<f64> {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (m0, p0) = (mean(measured), mean(predicted));
    let (mut mm, mut pp, mut mp) = (0.0, 0.0, 0.0);
    for (m, p) in measured.iter().zip(predicted) {
        mm += (m - m0) * (m - m0);
        pp += (p - p0) * (p - p0);
        mp += (m - m0) * (p - p0);
    }
    let product = (mm * pp).sqrt();
    (product > 0.0 && product.is_finite()).then(|| mp / product)
}

/// Russell's errors; `None` where one of the histories is zero throughout.
#[must_use]
pub fn russell(measured: &[f64], predicted: &[f64]) -> Option<Russell> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let (mm, pp, mp) =
        (dot(measured, measured), dot(predicted, predicted), dot(measured, predicted));
    let product = (mm * pp).sqrt();
    if !(product > 0.0 && product.is_finite()) {
        return None;
    }
    let e = (pp - mm) / product;
    let size = libm::log10(1.0 + e.abs());
    let magnitude = if e < 0.0 { -size } else { size };
    let phase = libm::acos((mp / product).clamp(-1.0, 1.0)) / core::f64::consts::PI;
    let comprehensive =
        (0.25 * core::f64::consts::PI * (magnitude * magnitude + phase * phase)).sqrt();
    Some(Russell { magnitude, phase, comprehensive })
}

/// How much later the measured history comes than the predicted one, in samples, to a part of one:
/// where their normalised cross-correlation is largest, within ± `most` samples; with the
/// correlation there and that without a shift.
///
/// Between samples the largest value is that of the parabola through three. `None` where one of
/// the histories is zero throughout or shorter than three samples.
#[must_use]
pub fn lag(measured: &[f64], predicted: &[f64], most: usize) -> Option<Lag> {
    let n = measured.len().min(predicted.len());
    if n < 3 {
        return None;
    }
    let (em, ep) = (running_energy(&measured[..n]), running_energy(&predicted[..n]));
    if !(em[n] > 0.0 && ep[n] > 0.0 && em[n].is_finite() && ep[n].is_finite()) {
        return None;
    }
    // Each shift by the energies of what overlaps, so that the ends do not pull towards no shift.
    let at = |shift: isize| -> f64 {
        let first = shift.max(0) as usize;
        let last = (n as isize + shift.min(0)) as usize;
        let moved = |i: usize| (i as isize - shift) as usize;
        let sum: f64 = (first..last).map(|i| measured[i] * predicted[moved(i)]).sum();
        let norm = ((em[last] - em[first]) * (ep[moved(last)] - ep[moved(first)])).sqrt();
        if norm > 0.0 { sum / norm } else { 0.0 }
    };
    let most = most.min(n - 2) as isize;
    let values: Vec<f64> = (-most..=most).map(at).collect();
    let mut best = most as usize;
    for (index, value) in values.iter().enumerate() {
        // The smaller shift where two are equal.
        let nearer = index.abs_diff(most as usize) < best.abs_diff(most as usize);
        if *value > values[best] || (*value == values[best] && nearer) {
            best = index;
        }
    }
    let mut samples = best as f64 - most as f64;
    let mut largest = values[best];
    if best > 0 && best + 1 < values.len() {
        let (a, b, c) = (values[best - 1], values[best], values[best + 1]);
        let bend = a - 2.0 * b + c;
        if bend < 0.0 {
            let part = 0.5 * (a - c) / bend;
            samples += part;
            largest = b - 0.25 * (a - c) * part;
        }
    }
    Some(Lag { samples, correlation: largest, unshifted: values[most as usize] })
}

/// Sums of squares of the first values, from none to all.
fn running_energy(values: &[f64]) -> Vec<f64> {
    let mut sum = 0.0;
    let sums = values.iter().map(|v| {
        sum += v * v;
        sum
    });
    core::iter::once(0.0).chain(sums.collect::<Vec<f64>>()).collect()
}

/// See [`lag`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lag {
    /// By how many samples the measured history comes later.
    pub samples: f64,
    /// The normalised cross-correlation at that shift.
    pub correlation: f64,
    /// The same without a shift.
    pub unshifted: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::{PI, TAU};

    fn sine(n: usize, cycles: f64, phase: f64) -> Vec<f64> {
        (0..n).map(|i| libm::sin(TAU * cycles * i as f64 / n as f64 + phase)).collect()
    }

    /// Whole cycles: Σ sin² = n/2, Σ sin sin(+φ) = n/2 cos φ.
    #[test]
    fn sines_of_other_size_and_phase() {
        let m = sine(1000, 5.0, 0.0);
        let p: Vec<f64> = sine(1000, 5.0, 0.3).iter().map(|v| 2.0 * v).collect();
        let r = russell(&m, &p).unwrap();
        // e = (4 − 1) / 2.
        assert!((r.magnitude - libm::log10(2.5)).abs() < 1e-12);
        assert!((r.phase - 0.3 / PI).abs() < 1e-12);
        let c = (PI / 4.0 * (r.magnitude * r.magnitude + r.phase * r.phase)).sqrt();
        assert!((r.comprehensive - c).abs() < 1e-15);
        assert!((correlation(&m, &p).unwrap() - libm::cos(0.3)).abs() < 1e-12);
        assert!((rms(&m) - 0.5_f64.sqrt()).abs() < 1e-12);
        // |2 e^{iφ} − 1|² = 5 − 4 cos φ.
        let expected = (0.5 * (5.0 - 4.0 * libm::cos(0.3))).sqrt();
        assert!((rms_error(&m, &p) - expected).abs() < 1e-12);
        assert!((russell(&p, &m).unwrap().magnitude + r.magnitude).abs() < 1e-12);
    }

    #[test]
    fn equal_and_opposite_histories() {
        let m = [1.0, -2.0, 3.0];
        let same = russell(&m, &m).unwrap();
        assert_eq!((same.magnitude, same.phase, same.comprehensive), (0.0, 0.0, 0.0));
        let p = m.map(|v| -v);
        assert!((russell(&m, &p).unwrap().phase - 1.0).abs() < 1e-15);
        assert!((correlation(&m, &p).unwrap() + 1.0).abs() < 1e-15);
        assert_eq!(peak(&p), (3.0, 2));
        assert!(russell(&m, &[0.0; 3]).is_none() && correlation(&m, &[1.0; 3]).is_none());
    }

    #[test]
    fn lag_of_a_shifted_pulse() {
        let pulse = |at: f64| -> Vec<f64> {
            (0..200)
                .map(|i| libm::exp(-((i as f64 - at) / 6.0) * ((i as f64 - at) / 6.0)))
                .collect()
        };
        let found = lag(&pulse(107.0), &pulse(100.0), 50).unwrap();
        assert!((found.samples - 7.0).abs() < 1e-9 && (found.correlation - 1.0).abs() < 1e-9);
        let part = lag(&pulse(96.4), &pulse(100.0), 50).unwrap();
        // The parabola through samples of a Gaussian of that width is off by 1e-3 at most.
        assert!((part.samples + 3.6).abs() < 2e-3, "{}", part.samples);
        assert_eq!(lag(&pulse(100.0), &[0.0; 200], 5), None);
        // Beyond the bound the nearest allowed shift is found, at the edge.
        assert_eq!(lag(&pulse(130.0), &pulse(100.0), 5).unwrap().samples, 5.0);
    }
}
