//! Motions made from motions: scaled, with a tail, with a component along y or a vertical one.

use std::sync::Arc;

use super::figures::peak;
use super::{GroundMotion, MAX_SAMPLES};
use crate::error::MotionError;
use crate::numerics::fractile::upper_median;

impl GroundMotion {
    /// This motion with all components times `factor`, which may be negative.
    ///
    /// # Errors
    /// [`MotionError::OutOfRange`] for a factor that is not finite, [`MotionError::NotFinite`] and
    /// [`MotionError::TooLarge`] where a product is.
    pub fn scaled(&self, factor: f64) -> Result<Self, MotionError> {
        if !factor.is_finite() {
            let expected = "a finite factor";
            return Err(MotionError::OutOfRange { quantity: "scale", expected, found: factor });
        }
        let times = |values: &[f64]| values.iter().map(|a| factor * a).collect::<Vec<_>>();
        let horizontal = times(&self.horizontal_m_per_s2);
        let vertical = self.vertical_m_per_s2().map(times);
        super::check_values(horizontal.len(), &horizontal, vertical.as_deref())?;
        let scaled = Self {
            times_s: self.times_s.clone(),
            horizontal_m_per_s2: Arc::new(horizontal),
            horizontal_y_m_per_s2: None,
            vertical_m_per_s2: vertical.map(Arc::new),
            dt_s: self.dt_s,
        };
        scaled.with_y_if(self.horizontal_y_m_per_s2().map(times))
    }

    /// [`GroundMotion::with_y`] where there is such a component.
    fn with_y_if(self, horizontal_y: Option<Vec<f64>>) -> Result<Self, MotionError> {
        match horizontal_y {
            Some(horizontal_y) => self.with_y(horizontal_y),
            None => Ok(self),
        }
    }

    /// The first samples of the motion, two or more of them; `None` for fewer, or more than there are.
    #[must_use]
    pub fn first(&self, samples: usize) -> Option<Self> {
        let cut = |values: &[f64]| values.get(..samples).map(<[f64]>::to_vec);
        let [horizontal_y, vertical] =
            [self.horizontal_y_m_per_s2(), self.vertical_m_per_s2()].map(|v| v.and_then(cut));
        Self::new(cut(&self.times_s)?, cut(&self.horizontal_m_per_s2)?, vertical)
            .and_then(|motion| motion.with_y_if(horizontal_y))
            .ok()
    }

    /// The motion scaled so that its largest horizontal acceleration, of the larger component in two
    /// directions, is `peak_m_per_s2`; the others take the same factor.
    ///
    /// # Errors
    /// [`MotionError::OutOfRange`] unless the peak is finite and > 0, [`MotionError::ZeroPeak`]
    /// for a motion that is zero throughout, and as [`GroundMotion::scaled`].
    pub fn scaled_to_peak(&self, peak_m_per_s2: f64) -> Result<Self, MotionError> {
        self.scaled(self.factor_to_peak(peak_m_per_s2)?)
    }

    /// The factor of [`GroundMotion::scaled_to_peak`].
    ///
    /// # Errors
    /// As there.
    pub fn factor_to_peak(&self, peak_m_per_s2: f64) -> Result<f64, MotionError> {
        if !(peak_m_per_s2.is_finite() && peak_m_per_s2 > 0.0) {
            return Err(MotionError::OutOfRange {
                quantity: "scale_to in m/s²",
                expected: "a finite peak > 0",
                found: peak_m_per_s2,
            });
        }
        let found = [Some(self.horizontal_m_per_s2()), self.horizontal_y_m_per_s2()]
            .map(|component| component.map_or(0.0, peak));
        let found = found[0].max(found[1]);
        if found == 0.0 {
            return Err(MotionError::ZeroPeak);
        }
        Ok(peak_m_per_s2 / found)
    }

    /// `Ü cos φ + Üv sin φ` as a horizontal motion, for a pair whose second component stands as the
    /// vertical one (see [`GroundMotion::with_vertical`]); φ in degrees.
    pub(super) fn in_direction(&self, degrees: f64) -> Result<Self, MotionError> {
        let [cos, sin] = direction(degrees);
        let x = &self.horizontal_m_per_s2;
        let Some(y) = &self.vertical_m_per_s2 else { return Ok(self.clone()) };
        let sum = x.iter().zip(&**y).map(|(x, y)| x * cos + y * sin);
        let horizontal: Vec<f64> = sum.collect();
        super::check_values(horizontal.len(), &horizontal, None)?;
        Ok(Self {
            times_s: self.times_s.clone(),
            horizontal_m_per_s2: Arc::new(horizontal),
            horizontal_y_m_per_s2: None,
            vertical_m_per_s2: None,
            dt_s: self.dt_s,
        })
    }

    /// The motion followed by `tail_s` of rest, so that a history has rows there.
    ///
    /// Where the last sample is not 0 the acceleration jumps to 0 at the end. The tail is sampled
    /// at the motion's own step (the middle one of its intervals where they differ); its last
    /// sample is at the exact end. A tail of 0 s changes nothing.
    ///
    /// # Errors
    /// [`MotionError::OutOfRange`] unless the tail is finite and ≥ 0, [`MotionError::TooLong`] for
    /// more than [`MAX_SAMPLES`] samples, refused before they are allocated.
    pub fn with_tail(&self, tail_s: f64) -> Result<Self, MotionError> {
        if !(tail_s.is_finite() && tail_s >= 0.0) {
            let expected = "a finite duration ≥ 0 s";
            return Err(MotionError::OutOfRange { quantity: "tail", expected, found: tail_s });
        }
        if tail_s == 0.0 {
            return Ok(self.clone());
        }
        let n = self.len();
        let end_s = self.duration_s();
        let dt_s = self.dt_s.unwrap_or_else(|| median_interval(&self.times_s));
        let samples = steps(tail_s, dt_s, n + 1)?;

        let longer = |values: &[f64]| {
            let mut copy = Vec::with_capacity(n + samples + 1);
            copy.extend_from_slice(values);
            copy
        };
        let mut times_s = longer(&self.times_s);
        let mut components = [
            Some(self.horizontal_m_per_s2()),
            self.horizontal_y_m_per_s2(),
            self.vertical_m_per_s2(),
        ]
        .map(|component| component.map(longer));
        let at_rest = components.iter().flatten().all(|component| component[n - 1] == 0.0);
        if !at_rest && times_s[n - 2] == end_s {
            // It ends with a jump, whose right side holds for no time.
            components.iter_mut().flatten().for_each(|component| component[n - 1] = 0.0);
        } else if !at_rest {
            times_s.push(end_s);
        }
        // An even motion stays on the multiples of its step to the last bit.
        let first = if self.dt_s.is_some() { n - 1 } else { 0 };
        let from_s = if self.dt_s.is_some() { 0.0 } else { end_s };
        times_s.extend((1..samples).map(|k| from_s + (first + k) as f64 * dt_s));
        times_s.push(end_s + tail_s);
        components.iter_mut().flatten().for_each(|v| v.resize(times_s.len(), 0.0));
        let [horizontal, horizontal_y, vertical] = components;
        let horizontal = horizontal.unwrap_or_default();
        if self.dt_s.is_none() {
            return Self::new(times_s, horizontal, vertical)?.with_y_if(horizontal_y);
        }
        // Checked already: an even motion that goes on at its step lasts in proportion to its samples.
        let dt_s = super::constant_step(&times_s);
        let horizontal_y_m_per_s2 = horizontal_y.map(Arc::new);
        Ok(Self { horizontal_y_m_per_s2, ..Self::of(times_s, horizontal, vertical, dt_s) })
    }

    /// This motion with `factor` times the horizontal component of `other` as its vertical one
    /// (Üv, positive upwards), and whether the two differ in length.
    ///
    /// Both clocks start at their first sample. The times are the union of both (times closer than
    /// rounding are one), so that both stay linear between them; the shorter is 0 after its end,
    /// by a jump where its last value is not 0.
    ///
    /// # Errors
    /// [`MotionError::OutOfRange`] for a factor that is not finite, [`MotionError::TooLong`] for
    /// more than [`MAX_SAMPLES`] times in the union, and as [`GroundMotion::scaled`].
    pub fn with_vertical(&self, other: &Self, factor: f64) -> Result<(Self, bool), MotionError> {
        let own = Self { vertical_m_per_s2: None, ..self.clone() };
        let Union { times_s, own: [x, y, _], other, lengths_differ } =
            own.union(&other.scaled(factor)?)?;
        let joined = Self::new(times_s, x.unwrap_or_default(), Some(other))?.with_y_if(y)?;
        Ok((joined, lengths_differ))
    }

    /// This motion with the horizontal component of `other` as that along y, and whether the two differ
    /// in length; times as of [`GroundMotion::with_vertical`]. The vertical component stays this motion's own.
    ///
    /// # Errors
    /// As [`GroundMotion::with_vertical`].
    pub fn with_along_y(&self, other: &Self) -> Result<(Self, bool), MotionError> {
        let own = Self { horizontal_y_m_per_s2: None, ..self.clone() };
        let Union { times_s, own: [x, _, vertical], other, lengths_differ } = own.union(other)?;
        Ok((Self::new(times_s, x.unwrap_or_default(), vertical)?.with_y(other)?, lengths_differ))
    }

    /// The motion in two horizontal directions with another factor on y, then turned, x towards y.
    ///
    /// # Errors
    /// [`MotionError::OutOfRange`] for a factor or an angle that is not finite, and as
    /// [`GroundMotion::scaled`].
    pub fn turned(&self, scale_y: f64, angle_rad: f64) -> Result<Self, MotionError> {
        for (quantity, found) in [("scale_y", scale_y), ("rotate in rad", angle_rad)] {
            if !found.is_finite() {
                let expected = "a finite number";
                return Err(MotionError::OutOfRange { quantity, expected, found });
            }
        }
        let Some(y) = self.horizontal_y_m_per_s2() else { return Ok(self.clone()) };
        let [cos, sin] = direction(angle_rad.to_degrees());
        // x cos φ − y sin φ, x sin φ + y cos φ
        let pairs = || self.horizontal_m_per_s2.iter().zip(y.iter().map(|y| scale_y * y));
        let x: Vec<f64> = pairs().map(|(x, y)| x * cos - y * sin).collect();
        let y: Vec<f64> = pairs().map(|(x, y)| x * sin + y * cos).collect();
        super::check_values(x.len(), &x, None)?;
        Self { horizontal_m_per_s2: Arc::new(x), ..self.clone() }.with_y(y)
    }

    /// The components of this motion and the horizontal one of another on the union of their times.
    fn union(&self, other: &Self) -> Result<Union, MotionError> {
        let (own, up) = (&self.times_s, &other.times_s);
        if own.len() + up.len() > MAX_SAMPLES {
            return Err(MotionError::TooLong { found: (own.len() + up.len()) as f64 });
        }
        let slack_s = 8.0 * f64::EPSILON * self.duration_s().max(other.duration_s());
        let lengths_differ = (self.duration_s() - other.duration_s()).abs() > slack_s;
        let components = [
            Some(self.horizontal_m_per_s2()),
            self.horizontal_y_m_per_s2(),
            self.vertical_m_per_s2(),
        ];
        let of_own = |values| Reader::new(own, values, slack_s);
        let mut readers: Vec<Reader> = components.into_iter().flatten().map(of_own).collect();
        readers.push(Reader::new(up, &other.horizontal_m_per_s2, slack_s));
        let capacity = own.len().max(up.len());
        let mut times_s = Vec::with_capacity(capacity);
        let mut values = vec![Vec::with_capacity(capacity); readers.len()];
        let mut limits = vec![[0.0; 2]; readers.len()];
        while let Some(t) =
            earlier(readers[0].next_s(), readers[readers.len() - 1].next_s(), slack_s)
        {
            for (limits, reader) in limits.iter_mut().zip(&mut readers) {
                *limits = reader.limits(t);
            }
            let has_ended = |reader: &Reader| reader.next_s().is_none();
            if !readers.iter().all(has_ended) {
                for (limits, _) in limits.iter_mut().zip(&readers).filter(|(_, r)| has_ended(r)) {
                    limits[1] = 0.0;
                }
            }
            let jumps = limits.iter().any(|[left, right]| left != right);
            for side in 0..1 + usize::from(jumps) {
                times_s.push(t);
                values
                    .iter_mut()
                    .zip(&limits)
                    .for_each(|(values, limits)| values.push(limits[side]));
            }
        }
        let other = values.pop().unwrap_or_default();
        let mut values = values.into_iter();
        let own = components.map(|component| component.and_then(|_| values.next()));
        Ok(Union { times_s, own, other, lengths_differ })
    }
}

/// Components of two motions on the union of their times.
struct Union {
    times_s: Vec<f64>,
    /// Along x, along y and vertical.
    own: [Option<Vec<f64>>; 3],
    other: Vec<f64>,
    lengths_differ: bool,
}

/// Cosine and sine of an angle in degrees, exact at whole quarters.
pub(super) fn direction(degrees: f64) -> [f64; 2] {
    let quarters = degrees / 90.0;
    if quarters == libm::rint(quarters) {
        let [x, y] = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]]
            [(quarters - 4.0 * libm::floor(quarters / 4.0)) as usize % 4];
        return [x, y];
    }
    let phi = degrees.to_radians();
    [libm::cos(phi), libm::sin(phi)]
}

/// How many steps of `dt_s` reach `duration_s`, the last one perhaps shorter; refused where they
/// and the `others` samples are more than a motion may have.
pub(super) fn steps(duration_s: f64, dt_s: f64, others: usize) -> Result<usize, MotionError> {
    let steps = duration_s / dt_s;
    // A last step below a millionth of the others is rounding.
    let whole = if (steps - libm::round(steps)).abs() <= 1e-6 {
        libm::round(steps).max(1.0)
    } else {
        libm::ceil(steps)
    };
    let found = whole + others as f64;
    if !(found <= MAX_SAMPLES as f64) {
        return Err(MotionError::TooLong { found });
    }
    Ok(whole as usize)
}

fn median_interval(times_s: &[f64]) -> f64 {
    let intervals = times_s.windows(2).map(|t| t[1] - t[0]).filter(|&h| h > 0.0);
    upper_median(intervals).unwrap_or(f64::NAN)
}

/// The earlier of two times; where they are one but for rounding, the first.
fn earlier(first_s: Option<f64>, second_s: Option<f64>, slack_s: f64) -> Option<f64> {
    match (first_s, second_s) {
        (Some(a), Some(b)) if (a - b).abs() <= slack_s => Some(a),
        (Some(a), Some(b)) => Some(a.min(b)),
        (a, b) => a.or(b),
    }
}

/// Reads a piecewise-linear function from left to right, limits from both sides.
struct Reader<'a> {
    times_s: &'a [f64],
    values: &'a [f64],
    slack_s: f64,
    next: usize,
}

impl<'a> Reader<'a> {
    fn new(times_s: &'a [f64], values: &'a [f64], slack_s: f64) -> Self {
        Self { times_s, values, slack_s, next: 0 }
    }

    /// The next sample's time.
    fn next_s(&self) -> Option<f64> {
        self.times_s.get(self.next).copied()
    }

    /// Limits from the left and the right at `t`, which may be no later than the next sample; after
    /// the last 0.
    fn limits(&mut self, t: f64) -> [f64; 2] {
        let i = self.next;
        let at = |k: usize| self.times_s.get(k).is_some_and(|s| (s - t).abs() <= self.slack_s);
        if !at(i) {
            let value = match (i, self.next_s()) {
                (0, _) | (_, None) => 0.0,
                (_, Some(after_s)) => {
                    let fraction = (t - self.times_s[i - 1]) / (after_s - self.times_s[i - 1]);
                    self.values[i - 1] + (self.values[i] - self.values[i - 1]) * fraction
                }
            };
            return [value, value];
        }
        let last = (i..).take_while(|&k| at(k)).last().unwrap_or(i);
        self.next = last + 1;
        [self.values[i], self.values[last]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn motion(times_s: &[f64], values: &[f64]) -> GroundMotion {
        GroundMotion::new(times_s.to_vec(), values.to_vec(), None).unwrap()
    }

    #[test]
    fn scaling_multiplies_every_component() {
        let m = motion(&[0.0, 1.0, 2.0], &[0.0, -4.0, 3.0]);
        assert_eq!(m.scaled(-0.5).unwrap().horizontal_m_per_s2(), [0.0, 2.0, -1.5]);
        assert_eq!(m.scaled_to_peak(2.0).unwrap().horizontal_m_per_s2(), [0.0, -2.0, 1.5]);
        assert_eq!(m.scaled(2.0).unwrap().dt_s(), Some(1.0));
    }

    #[test]
    fn scaling_refuses_what_has_no_answer() {
        let zero = motion(&[0.0, 1.0], &[0.0, 0.0]);
        assert_eq!(zero.scaled_to_peak(1.0), Err(MotionError::ZeroPeak));
        let m = motion(&[0.0, 1.0], &[0.0, 1e10]);
        for factor in [f64::NAN, f64::INFINITY] {
            assert!(matches!(m.scaled(factor), Err(MotionError::OutOfRange { .. })));
        }
        assert!(matches!(m.scaled(1e300), Err(MotionError::NotFinite { index: 1, .. })));
        for peak in [0.0, -1.0, f64::NAN] {
            assert!(matches!(m.scaled_to_peak(peak), Err(MotionError::OutOfRange { .. })));
        }
    }

    #[test]
    fn vertical_takes_the_factor_of_the_horizontal() {
        let m = GroundMotion::new(vec![0.0, 1.0], vec![1.0, 2.0], Some(vec![3.0, 0.5])).unwrap();
        assert_eq!(m.scaled_to_peak(4.0).unwrap().vertical_m_per_s2().unwrap(), [6.0, 1.0]);
    }

    #[test]
    fn tail_after_zero_keeps_the_step() {
        let m = GroundMotion::evenly_spaced(0.1, vec![0.0, 1.0, 0.0], None).unwrap();
        let tailed = m.with_tail(0.3).unwrap();
        assert_eq!(tailed.dt_s(), Some(0.1));
        assert_eq!(tailed.len(), 6);
        assert_eq!(tailed.duration_s(), 0.2 + 0.3);
        assert_eq!(tailed.horizontal_m_per_s2(), [0.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(m.with_tail(0.0).unwrap(), m);
    }

    #[test]
    fn tail_after_a_value_jumps() {
        let m = motion(&[0.0, 0.5], &[0.0, 1.0]).with_tail(0.75).unwrap();
        assert_eq!(m.times_s(), [0.0, 0.5, 0.5, 1.0, 1.25]);
        assert_eq!(m.horizontal_m_per_s2(), [0.0, 1.0, 0.0, 0.0, 0.0]);
    }

    #[test]
    fn tail_after_a_jump_at_the_end() {
        let m = motion(&[0.0, 1.0, 1.0], &[2.0, 2.0, 1.0]).with_tail(1.0).unwrap();
        assert_eq!(m.times_s(), [0.0, 1.0, 1.0, 2.0]);
        assert_eq!(m.horizontal_m_per_s2(), [2.0, 2.0, 0.0, 0.0]);
    }

    /// What is known of an even motion is not looked at again: the answer is that of the samples alone.
    #[test]
    fn tail_of_an_even_motion_is_a_motion_of_its_samples() {
        for (end, y) in [(0.0, None), (1.0, None), (0.0, Some(2.0)), (0.0, Some(0.0))] {
            for tail_s in [1e-9, 0.005, 0.01, 0.3, 0.301, 7.0, 5000.0] {
                let x = vec![0.5, 1.0, -1.0, end];
                let m = GroundMotion::evenly_spaced(0.01, x.clone(), Some(x)).unwrap();
                let m = m.with_y_if(y.map(|y| vec![1.0, 0.0, 0.0, y])).unwrap();
                let tailed = m.with_tail(tail_s).unwrap();
                let [x, up] = [Some(tailed.horizontal_m_per_s2()), tailed.vertical_m_per_s2()]
                    .map(Option::unwrap);
                let again =
                    GroundMotion::new(tailed.times_s().to_vec(), x.to_vec(), Some(up.to_vec()));
                let y = tailed.horizontal_y_m_per_s2().map(<[f64]>::to_vec);
                assert_eq!(again.unwrap().with_y_if(y).unwrap(), tailed, "{end} {tail_s}");
            }
        }
    }

    #[test]
    fn tail_of_uneven_samples_uses_their_middle_interval() {
        let m = motion(&[0.0, 0.1, 0.2, 0.200_001], &[0.0; 4]).with_tail(0.25).unwrap();
        assert_eq!(m.len(), 4 + 3);
        assert_eq!(m.duration_s(), 0.200_001 + 0.25);
    }

    #[test]
    fn endless_tails_are_refused_at_once() {
        let m = motion(&[0.0, 0.01], &[0.0, 0.0]);
        assert!(matches!(m.with_tail(1e10), Err(MotionError::TooLong { .. })));
        assert!(matches!(m.with_tail(f64::NAN), Err(MotionError::OutOfRange { .. })));
        assert!(matches!(m.with_tail(-1.0), Err(MotionError::OutOfRange { .. })));
    }

    #[test]
    fn vertical_on_the_same_times() {
        let h = GroundMotion::evenly_spaced(0.1, vec![1.0, 2.0, 3.0], None).unwrap();
        let v = GroundMotion::evenly_spaced(0.1, vec![4.0, 5.0, 6.0], None).unwrap();
        let (both, differ) = h.with_vertical(&v, 2.0).unwrap();
        assert!(!differ);
        assert_eq!(both.times_s(), h.times_s());
        assert_eq!(both.horizontal_m_per_s2(), h.horizontal_m_per_s2());
        assert_eq!(both.vertical_m_per_s2().unwrap(), [8.0, 10.0, 12.0]);
        assert_eq!(both.dt_s(), Some(0.1));
    }

    #[test]
    fn vertical_on_the_union_of_times() {
        let h = motion(&[0.0, 1.0, 2.0], &[0.0, 4.0, 0.0]);
        let v = motion(&[0.0, 0.5, 3.0], &[1.0, 0.0, 5.0]);
        let (both, differ) = h.with_vertical(&v, 1.0).unwrap();
        assert!(differ);
        assert_eq!(both.times_s(), [0.0, 0.5, 1.0, 2.0, 3.0]);
        assert_eq!(both.horizontal_m_per_s2(), [0.0, 2.0, 4.0, 0.0, 0.0]);
        assert_eq!(both.vertical_m_per_s2().unwrap(), [1.0, 0.0, 1.0, 3.0, 5.0]);
    }

    /// The shorter stops at 4, not at 0: it jumps to 0 there, and stays.
    #[test]
    fn shorter_component_jumps_to_zero_at_its_end() {
        let h = motion(&[0.0, 1.0], &[0.0, 4.0]);
        let v = motion(&[0.0, 2.0], &[0.0, 2.0]);
        let (both, _) = h.with_vertical(&v, 1.0).unwrap();
        assert_eq!(both.times_s(), [0.0, 1.0, 1.0, 2.0]);
        assert_eq!(both.horizontal_m_per_s2(), [0.0, 4.0, 0.0, 0.0]);
        assert_eq!(both.vertical_m_per_s2().unwrap(), [0.0, 1.0, 1.0, 2.0]);
        let (both, _) = v.with_vertical(&h, 1.0).unwrap();
        assert_eq!(both.vertical_m_per_s2().unwrap(), [0.0, 4.0, 0.0, 0.0]);
    }

    #[test]
    fn jumps_of_either_component_stay_jumps() {
        let h = motion(&[0.0, 1.0, 1.0, 2.0], &[1.0, 1.0, -1.0, -1.0]);
        let v = motion(&[0.0, 2.0], &[0.0, 2.0]);
        let (both, _) = h.with_vertical(&v, 1.0).unwrap();
        assert_eq!(both.times_s(), [0.0, 1.0, 1.0, 2.0]);
        assert_eq!(both.horizontal_m_per_s2(), [1.0, 1.0, -1.0, -1.0]);
        assert_eq!(both.vertical_m_per_s2().unwrap(), [0.0, 1.0, 1.0, 2.0]);
        let (both, _) = v.with_vertical(&h, 1.0).unwrap();
        assert_eq!(both.vertical_m_per_s2().unwrap(), [1.0, 1.0, -1.0, -1.0]);
    }

    /// What a jump at either end leaves stays, as without a vertical component.
    #[test]
    fn jumps_at_both_ends_stay() {
        let h = motion(&[0.0, 0.0, 1.0, 1.0], &[1.0, 2.0, 2.0, 3.0]);
        let zeros = motion(&[0.0, 1.0], &[0.0, 0.0]);
        let (both, _) = h.with_vertical(&zeros, 1.0).unwrap();
        assert_eq!(both.times_s(), h.times_s());
        assert_eq!(both.horizontal_m_per_s2(), h.horizontal_m_per_s2());
        let (both, _) = zeros.with_vertical(&h, 1.0).unwrap();
        assert_eq!(both.vertical_m_per_s2().unwrap(), h.horizontal_m_per_s2());
    }

    /// Times that differ by rounding alone are one time: no interval of 1e-17 s.
    #[test]
    fn times_that_differ_by_rounding_are_one() {
        let h = GroundMotion::evenly_spaced(0.1, vec![1.0; 50], None).unwrap();
        let shifted: Vec<f64> = h.times_s().iter().map(|t| (t + 0.3) - 0.3).collect();
        let v = GroundMotion::new(shifted, vec![2.0; 50], None).unwrap();
        let (both, differ) = h.with_vertical(&v, 1.0).unwrap();
        assert_eq!((both.len(), differ), (50, false));
    }
}
