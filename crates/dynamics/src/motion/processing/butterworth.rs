//! Butterworth filters without phase shift: second-order sections, forwards and backwards.
//!
//! The digital filter comes from the analogue one by the bilinear transform with its corners
//! prewarped, so that they are where they are asked for; run twice, its gain there is 1/2
//! (−6 dB). As SciPy's `sosfiltfilt` does, the samples are extended at both ends by turning them
//! about the end points, `2 x₀ − x_k`, over three times the number of the filter's coefficients,
//! and each pass starts in the steady state of its first value.

use core::f64::consts::PI;

use crate::error::MotionError;
use crate::motion::Series;

/// What a filter lets through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Band {
    /// Frequencies above a corner.
    High {
        /// The corner in Hz.
        corner_hz: f64,
    },
    /// Frequencies below a corner.
    Low {
        /// The corner in Hz.
        corner_hz: f64,
    },
    /// Frequencies between two corners.
    Pass {
        /// The lower corner in Hz.
        from_hz: f64,
        /// The upper corner in Hz.
        to_hz: f64,
    },
}

/// The series behind the filter.
pub(super) fn filter(series: &Series, band: Band, order: usize) -> Result<Series, MotionError> {
    let Some(dt_s) = series.dt_s() else {
        return Err(MotionError::Uneven { step: "a filter" });
    };
    if !(1..=10).contains(&order) {
        let expected = "an order from 1 to 10";
        let found = order as f64;
        return Err(MotionError::OutOfRange { quantity: "order of the filter", expected, found });
    }
    let corners = match band {
        Band::High { corner_hz } | Band::Low { corner_hz } => [corner_hz, corner_hz],
        Band::Pass { from_hz, to_hz } => [from_hz, to_hz],
    };
    for found in corners {
        if !(found > 0.0 && found < 0.5 / dt_s) {
            let expected =
                "a frequency above 0 and below the Nyquist frequency, half the sampling rate";
            return Err(MotionError::OutOfRange { quantity: "corner in Hz", expected, found });
        }
    }
    if matches!(band, Band::Pass { .. }) && !(corners[0] < corners[1]) {
        let expected = "two corners, the lower first";
        let found = corners[1];
        return Err(MotionError::OutOfRange { quantity: "corners in Hz", expected, found });
    }
    let sections = sections(band, order, dt_s);
    let single = sections.iter().filter(|s| s.b[2] == 0.0 && s.a[1] == 0.0).count();
    let padding = 3 * (2 * sections.len() + 1 - single);
    let values = series.values();
    if values.len() <= padding {
        return Err(MotionError::OutOfRange {
            quantity: "samples to be filtered",
            expected: "more samples than three times the filter's coefficients",
            found: values.len() as f64,
        });
    }
    let mut extended = extended(values, padding);
    for _ in 0..2 {
        run(&sections, &mut extended);
        extended.reverse();
    }
    series.with_values(extended[padding..padding + values.len()].to_vec())
}

/// `2 x₀ − x_k` before, the values, `2 x_n − x_(n−k)` after.
fn extended(x: &[f64], padding: usize) -> Vec<f64> {
    let n = x.len();
    let before = (1..=padding).rev().map(|k| 2.0 * x[0] - x[k]);
    let after = (1..=padding).map(|k| 2.0 * x[n - 1] - x[n - 1 - k]);
    before.chain(x.iter().copied()).chain(after).collect()
}

/// All sections over the values, from the steady state of the first.
fn run(sections: &[Section], values: &mut [f64]) {
    let mut steady = values[0];
    for section in sections {
        let Section { b, a, gain_at_0 } = *section;
        let mut z1 = steady * (b[2] - a[1] * gain_at_0);
        let mut z0 = steady * (b[1] - a[0] * gain_at_0) + z1;
        for value in values.iter_mut() {
            let x = *value;
            let y = b[0] * x + z0;
            z0 = b[1] * x - a[0] * y + z1;
            z1 = b[2] * x - a[1] * y;
            *value = y;
        }
        steady *= gain_at_0;
    }
}

/// `(b₀ + b₁/z + b₂/z²)/(1 + a₀/z + a₁/z²)`.
#[derive(Clone, Copy, Debug)]
struct Section {
    b: [f64; 3],
    a: [f64; 2],
    gain_at_0: f64,
}

/// A complex number, as far as it is needed.
#[derive(Clone, Copy, Debug)]
struct Complex {
    re: f64,
    im: f64,
}

impl Complex {
    fn times(self, other: Self) -> Self {
        Self {
            re: self.re * other.re - self.im * other.im,
            im: self.re * other.im + self.im * other.re,
        }
    }

    fn square_modulus(self) -> f64 {
        self.re * self.re + self.im * self.im
    }

    /// `(1 + s)/(1 − s)`: the bilinear transform.
    fn bilinear(self) -> Self {
        let denominator = Self { re: 1.0 - self.re, im: self.im };
        let product = Self { re: 1.0 + self.re, im: self.im }.times(denominator);
        let modulus = denominator.square_modulus();
        Self { re: product.re / modulus, im: product.im / modulus }
    }

    /// The root with a real part ≥ 0.
    fn square_root(self) -> Self {
        let modulus = libm::sqrt(self.square_modulus());
        let re = libm::sqrt(0.5 * (modulus + self.re.abs()));
        if re == 0.0 {
            return Self { re: 0.0, im: 0.0 };
        }
        let im = 0.5 * self.im.abs() / re;
        if self.re >= 0.0 {
            Self { re, im: libm::copysign(im, self.im) }
        } else {
            Self { re: im, im: libm::copysign(re, self.im) }
        }
    }
}

/// Sections of the filter; frequencies in units in which the bilinear transform is
/// `s = (z − 1)/(z + 1)`.
fn sections(band: Band, order: usize, dt_s: f64) -> Vec<Section> {
    let warped = |hz: f64| libm::tan(PI * (hz * dt_s));
    // Poles of the low-pass filter with its corner at 1, one of each conjugate pair.
    let poles = (0..order.div_ceil(2)).map(|k| {
        let angle = PI * (2 * k + 1) as f64 / (2 * order) as f64;
        let real = 2 * k + 1 == order;
        let pole = Complex { re: -libm::sin(angle), im: libm::cos(angle) };
        (if real { Complex { re: -1.0, im: 0.0 } } else { pole }, real)
    });
    let times = |pole: Complex, factor: f64| Complex { re: factor * pole.re, im: factor * pole.im };
    match band {
        Band::Low { corner_hz } => {
            let w = warped(corner_hz);
            poles.map(|(pole, real)| Section::low_pass(times(pole, w), real)).collect()
        }
        // s → ω/s; the poles lie on the unit circle, where 1/p is the conjugate of p.
        Band::High { corner_hz } => {
            let w = warped(corner_hz);
            poles.map(|(pole, real)| Section::high_pass(times(pole, w), real)).collect()
        }
        // s → (s² + ω₀²)/(b s): the roots of s² − b p s + ω₀² = 0.
        Band::Pass { from_hz, to_hz } => {
            let (from, to) = (warped(from_hz), warped(to_hz));
            let (width, square) = (to - from, from * to);
            let mut all = Vec::with_capacity(order);
            for (pole, real) in poles {
                let half = times(pole, 0.5 * width);
                let half_square = half.times(half);
                let root = Complex { re: half_square.re - square, ..half_square }.square_root();
                let plus = Complex { re: half.re + root.re, im: half.im + root.im };
                let minus = Complex { re: half.re - root.re, im: half.im - root.im };
                if real {
                    all.push(Section::band_pass(plus, minus, width));
                } else {
                    let conjugate = |s: Complex| Complex { im: -s.im, ..s };
                    all.push(Section::band_pass(plus, conjugate(plus), width));
                    all.push(Section::band_pass(minus, conjugate(minus), width));
                }
            }
            all
        }
    }
}

impl Section {
    /// `1/(1 − s/p)(1 − s/p*)`, or `1/(1 − s/p)` for a real pole.
    fn low_pass(pole: Complex, real: bool) -> Self {
        let z = pole.bilinear();
        if real {
            let gain = -pole.re / (1.0 - pole.re);
            return Self { b: [gain, gain, 0.0], a: [-z.re, 0.0], gain_at_0: 1.0 };
        }
        let gain = pole.square_modulus() / Complex { re: 1.0 - pole.re, ..pole }.square_modulus();
        Self { b: [gain, 2.0 * gain, gain], a: Self::pair(z), gain_at_0: 1.0 }
    }

    fn high_pass(pole: Complex, real: bool) -> Self {
        let z = pole.bilinear();
        if real {
            let gain = 1.0 / (1.0 - pole.re);
            return Self { b: [gain, -gain, 0.0], a: [-z.re, 0.0], gain_at_0: 0.0 };
        }
        let gain = 1.0 / Complex { re: 1.0 - pole.re, ..pole }.square_modulus();
        Self { b: [gain, -2.0 * gain, gain], a: Self::pair(z), gain_at_0: 0.0 }
    }

    /// `b s/((s − p)(s − q))` with `p`, `q` conjugate or both real.
    fn band_pass(p: Complex, q: Complex, width: f64) -> Self {
        let one_less = |s: Complex| Complex { re: 1.0 - s.re, im: -s.im };
        let gain = width / one_less(p).times(one_less(q)).re;
        let (p, q) = (p.bilinear(), q.bilinear());
        let a = [-(p.re + q.re), p.times(q).re];
        Self { b: [gain, 0.0, -gain], a, gain_at_0: 0.0 }
    }

    fn pair(z: Complex) -> [f64; 2] {
        [-2.0 * z.re, z.square_modulus()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::Quantity;

    /// Gain of one pass at a frequency, straight from the sections.
    fn gain(sections: &[Section], hz: f64, dt_s: f64) -> f64 {
        let angle = -2.0 * PI * hz * dt_s;
        let z1 = Complex { re: libm::cos(angle), im: libm::sin(angle) };
        let z2 = z1.times(z1);
        let modulus = |c: [f64; 3]| {
            Complex { re: c[0] + c[1] * z1.re + c[2] * z2.re, im: c[1] * z1.im + c[2] * z2.im }
                .square_modulus()
        };
        let square: f64 =
            sections.iter().map(|s| modulus(s.b) / modulus([1.0, s.a[0], s.a[1]])).product();
        square.sqrt()
    }

    /// The Butterworth gain 1/√(1 + (Ω/Ω_c)^2n), Ω = tan(π f Δt): at corners 1/√2.
    #[test]
    fn gain_is_butterworths() {
        let dt_s = 0.01;
        let warped = |hz: f64| libm::tan(PI * hz * dt_s);
        for order in 1..=10 {
            for hz in [0.02, 0.3, 1.0, 5.0, 12.0, 40.0] {
                let power = |ratio: f64| libm::pow(ratio, 2.0 * order as f64);
                let low = sections(Band::Low { corner_hz: 5.0 }, order, dt_s);
                let expected = 1.0 / (1.0 + power(warped(hz) / warped(5.0))).sqrt();
                assert!((gain(&low, hz, dt_s) / expected - 1.0).abs() < 1e-9, "{order} {hz}");
                let high = sections(Band::High { corner_hz: 1.0 }, order, dt_s);
                let expected = 1.0 / (1.0 + power(warped(1.0) / warped(hz))).sqrt();
                assert!((gain(&high, hz, dt_s) / expected - 1.0).abs() < 1e-6, "{order} {hz}");
                let (from, to) = (warped(0.3), warped(12.0));
                let band = sections(Band::Pass { from_hz: 0.3, to_hz: 12.0 }, order, dt_s);
                assert_eq!(band.len(), order);
                let w = warped(hz);
                let ratio = (w * w - from * to) / ((to - from) * w);
                let expected = 1.0 / (1.0 + power(ratio)).sqrt();
                assert!((gain(&band, hz, dt_s) / expected - 1.0).abs() < 1e-6, "{order} {hz}");
            }
        }
    }

    /// A constant passes a low-pass filter untouched and no other, from the first sample on.
    #[test]
    fn a_constant_passes_low_and_is_stopped_high() {
        let s = Series::evenly_spaced(0.01, vec![3.0; 200], Quantity::Acceleration).unwrap();
        for order in [1, 2, 3, 4, 7] {
            let largest = |band, shift: f64| {
                let out = filter(&s, band, order).unwrap();
                out.values().iter().fold(0.0_f64, |m, v| m.max((v - shift).abs()))
            };
            assert!(largest(Band::Low { corner_hz: 5.0 }, 3.0) < 1e-11);
            assert!(largest(Band::High { corner_hz: 5.0 }, 0.0) < 1e-12);
            assert!(largest(Band::Pass { from_hz: 1.0, to_hz: 5.0 }, 0.0) < 1e-12);
        }
    }

    #[test]
    fn what_cannot_be_filtered() {
        let band = Band::Low { corner_hz: 5.0 };
        let short = Series::evenly_spaced(0.01, vec![1.0; 15], Quantity::Acceleration).unwrap();
        assert!(filter(&short, band, 4).is_err());
        assert!(filter(&short, band, 1).is_ok() && filter(&short, band, 2).is_ok());
        let uneven =
            Series::new(vec![0.0, 1.0, 3.0], vec![0.0; 3], Quantity::Acceleration).unwrap();
        assert_eq!(filter(&uneven, band, 1), Err(MotionError::Uneven { step: "a filter" }));
        let long = Series::evenly_spaced(0.01, vec![1.0; 100], Quantity::Acceleration).unwrap();
        for corner_hz in [0.0, -1.0, 50.0, 60.0, f64::NAN] {
            assert!(filter(&long, Band::Low { corner_hz }, 4).is_err(), "{corner_hz}");
        }
        assert!(filter(&long, Band::Pass { from_hz: 5.0, to_hz: 5.0 }, 4).is_err());
        assert!(filter(&long, band, 0).is_err() && filter(&long, band, 11).is_err());
    }
}
