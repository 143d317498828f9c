//! The sliding speed over a step: its least minimum, and the path.

use super::nodes::{AtNodes, NODES, nodes};
use super::peaks::bend;
use super::series::{Kind, PlaneSeries};
use super::vector::{inner, norm};
use crate::linear::polynomial::{DEGREE, ZERO, derivative, value};

/// Last Legendre coefficients of a speed over its mean with which Gauss' rule is exact.
const SMOOTH: f64 = 1e-8;

/// Part of a velocity and its rate of change by which these are across each other but for rounding.
const ACROSS: f64 = 64.0 * f64::EPSILON;

/// The least local minimum of `|w|` within a slip.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Least {
    pub(super) speed: Option<f64>,
    is_falling: bool,
}

impl Least {
    /// A slip begins or ends.
    pub(super) fn interrupt(&mut self) {
        self.is_falling = false;
    }

    /// The speed jumps.
    pub(super) fn drop_to(&mut self, before: f64, after: f64) {
        self.is_falling |= after < before;
    }

    fn note(&mut self, speed: f64) {
        self.speed = Some(self.speed.map_or(speed, |least| least.min(speed)));
    }

    /// Looks at the speed over the first part of a series.
    pub(super) fn look(&mut self, series: &PlaneSeries, (to, speeds): (f64, &AtNodes)) {
        match series.kind {
            Kind::Stick => self.interrupt(),
            _ if stays(series, to) => {}
            Kind::Frictionless => {
                let speed = |x: f64| norm(series.velocity_at(x));
                self.look_at(slope_of(series), speed, (lowest(series, to), to));
            }
            Kind::Slip => self.look_at_nodes(series, (to, speeds)),
        }
    }

    /// Looks at the speed of a slip, which falls and rises between its nodes as the speeds there tell.
    fn look_at_nodes(&mut self, series: &PlaneSeries, (to, speeds): (f64, &AtNodes)) {
        if to == 0.0 {
            return;
        }
        let slope = slope_of(series);
        let of = |x: f64| norm(series.velocity_at(x));
        self.look_at_ends(&slope, of, to);
        let at = |i: usize| match i {
            0 => 0.0,
            i if i > NODES => to,
            i => nodes().at[i - 1],
        };
        let last = NODES + 1;
        let mut all = [of(0.0); NODES + 2];
        all[1..last].copy_from_slice(speeds);
        all[last] = of(to);
        for i in 0..=last {
            let is_below = |j: usize| all[i] < all[j] || (all[i] == all[j] && j > i);
            let is_least = (i == 0 || is_below(i - 1)) && (i == last || is_below(i + 1));
            let sides = [at(i.saturating_sub(1)), at((i + 1).min(last))];
            if is_least && slope(sides[0]) < 0.0 && slope(sides[1]) >= 0.0 {
                self.note(of(bisected(&slope, -1.0, sides)));
            }
        }
    }

    /// Whether the speed that fell before rises at the start, and whether it falls at the end.
    fn look_at_ends(&mut self, slope: impl Fn(f64) -> f64, of: impl Fn(f64) -> f64, to: f64) {
        let [start, end] = [0.0, to].map(&slope);
        if self.is_falling && start >= 0.0 {
            self.note(of(0.0));
        }
        self.is_falling = end < 0.0;
    }

    /// Looks at a speed over `[0, to]` by a function that has the sign of its slope, and its lower bound. A speed that
    /// stays turns where it leaves.
    fn look_at(
        &mut self,
        slope: impl Fn(f64) -> f64,
        of: impl Fn(f64) -> f64,
        (lowest, to): (f64, f64),
    ) {
        if to == 0.0 {
            return;
        }
        self.look_at_ends(&slope, &of, to);
        if self.speed.is_none_or(|least| lowest < least) {
            for (x, is_least) in turns(slope, to) {
                // At the end it is a minimum if the slip goes on.
                if is_least && x < to {
                    self.note(of(x));
                } else if is_least {
                    self.is_falling = true;
                }
            }
        }
    }
}

/// `w·ẇ`. The series of `|w|²` would not do: beside a large `|w|` its rounding hides how small the least is.
pub(super) fn slope_of(series: &PlaneSeries) -> impl Fn(f64) -> f64 {
    let change = series.w.each_ref().map(derivative);
    move |x| inner(series.velocity_at(x), change.each_ref().map(|c| value(c, x)))
}

/// Whether the speed is the same all over the first part of a series: beside a force across the velocity its slope is rounding.
fn stays(series: &PlaneSeries, to: f64) -> bool {
    let change = series.w.each_ref().map(derivative);
    if change == [ZERO; 2] {
        return true;
    }
    let is_rounding = |x: f64| {
        let (w, change) = (series.velocity_at(x), change.each_ref().map(|c| value(c, x)));
        inner(w, change).abs() <= ACROSS * norm(w) * norm(change)
    };
    series.stopped != [ZERO; 2] && [0.0, 0.25, 0.5, 0.75, 1.0].iter().all(|x| is_rounding(x * to))
}

/// Points of `(0, to]` at which a slope changes its sign, and whether it is to +.
pub(super) fn turns(slope: impl Fn(f64) -> f64, to: f64) -> impl Iterator<Item = (f64, bool)> {
    let (mut from, mut falls) = (0.0, slope(0.0) < 0.0);
    let next = move || {
        let turn = (next_zero(&slope, from, to, falls)?, falls);
        (from, falls) = (turn.0, !falls);
        Some(turn)
    };
    core::iter::from_fn(next).take(DEGREE)
}

/// The next point of `(from, to]` at which a slope changes its sign.
fn next_zero(slope: &impl Fn(f64) -> f64, from: f64, to: f64, falls: bool) -> Option<f64> {
    let sign = if falls { -1.0 } else { 1.0 };
    let mut low = from;
    // Slopes are smooth over a step: as many parts as a polynomial of its degree has turns. From rest a speed may
    // turn at once.
    let parts = 2 * DEGREE;
    let from_rest = if from == 0.0 && slope(0.0) == 0.0 { 32 } else { 0 };
    let first = (1..=from_rest).rev().map(|i| libm::ldexp(1.0, -i));
    for i in first.chain((1..=parts).map(|i| i as f64)) {
        let high = from + (to - from) * (i / parts as f64);
        if sign * slope(high) < 0.0 {
            return Some(bisected(slope, sign, [low, high]));
        }
        low = high;
    }
    None
}

fn bisected(slope: &impl Fn(f64) -> f64, sign: f64, [mut low, mut high]: [f64; 2]) -> f64 {
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return high;
        }
        if sign * slope(middle) < 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
}

/// A bound on the least speed over the first part of a series: that of its chord, less how far it departs from it.
fn lowest(series: &PlaneSeries, to: f64) -> f64 {
    let [from, end] = [0.0, to].map(|x| series.velocity_at(x));
    let chord = [end[0] - from[0], end[1] - from[1]];
    let square = inner(chord, chord);
    let nearest = if square > 0.0 { (-inner(from, chord) / square).clamp(0.0, 1.0) } else { 0.0 };
    let least = norm([0, 1].map(|k| from[k] + nearest * chord[k]));
    least - norm(series.w.each_ref().map(|w| bend(w, to)))
}

/// `∫|w| dt` over the first part of a series; of a slip by the speeds at its nodes.
pub(super) fn path_m(series: &PlaneSeries, (to, speeds): (f64, &AtNodes)) -> f64 {
    if series.kind == Kind::Stick {
        return 0.0;
    }
    if series.kind == Kind::Slip {
        let coefficients = nodes().coefficients(speeds);
        let mean = coefficients[0];
        let tail = coefficients[NODES - 2].abs().max(coefficients[NODES - 1].abs());
        if tail <= SMOOTH * mean {
            return series.unit * mean;
        }
    }
    let speed = |x: f64| series.unit * norm(series.velocity_at(x));
    integral_of_length(&speed, slope_of(series), to)
}

/// `∫|w|` over `[0, to]`, from one turn of `|w|` to the next: where it passes 0 it has a bend.
fn integral_of_length(of: &dyn Fn(f64) -> f64, slope: impl Fn(f64) -> f64, to: f64) -> f64 {
    let tolerance = 4e-15 * gauss(0.0, to, of);
    let (mut sum, mut from) = (0.0, 0.0);
    for (end, _) in turns(slope, to).chain([(to, true)]) {
        sum += adaptive(of, [from, end], gauss(from, end, of), tolerance);
        from = end;
    }
    sum
}

/// Nodes and weights of the Gauss–Legendre rule of 12 points on [−1, 1], one side of it.
const GAUSS: [[f64; 2]; 6] = [
    [0.125_233_408_511_468_9, 0.249_147_045_813_402_8],
    [0.367_831_498_998_180_2, 0.233_492_536_538_354_8],
    [0.587_317_954_286_617_4, 0.203_167_426_723_065_9],
    [0.769_902_674_194_304_7, 0.160_078_328_543_346_23],
    [0.904_117_256_370_474_9, 0.106_939_325_995_318_4],
    [0.981_560_634_246_719_3, 0.047_175_336_386_511_83],
];

fn gauss(from: f64, to: f64, of: &dyn Fn(f64) -> f64) -> f64 {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let sum: f64 =
        GAUSS.iter().map(|[x, w]| w * (of(middle - half * x) + of(middle + half * x))).sum();
    half * sum
}

/// An integral over a part, in halves where they add up to something else.
fn adaptive(of: &dyn Fn(f64) -> f64, [from, to]: [f64; 2], whole: f64, tolerance: f64) -> f64 {
    let middle = 0.5 * (from + to);
    let halves = [gauss(from, middle, of), gauss(middle, to, of)];
    let sum = halves[0] + halves[1];
    // A part whose middle is one of its ends has no halves.
    if middle <= from || middle >= to || (sum - whole).abs() <= tolerance {
        return sum;
    }
    adaptive(of, [from, middle], halves[0], tolerance)
        + adaptive(of, [middle, to], halves[1], tolerance)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::polynomial::Polynomial;

    /// A polynomial by its lowest coefficients.
    fn polynomial(of: &[f64]) -> Polynomial {
        let mut c = ZERO;
        c[..of.len()].copy_from_slice(of);
        c
    }

    /// A speed that falls, rises, falls deeper and rises within one step.
    #[test]
    fn all_minima_of_a_step_are_looked_at() {
        // c' = (x − 0.2)(x − 0.5)(x − 0.8) − 0.003
        let slope = polynomial(&[-0.083, 0.66, -1.5, 1.0]);
        let speed = polynomial(&[0.1, -0.083, 0.33, -0.5, 0.25]);
        let mut least = Least::default();
        least.look_at(|x| value(&slope, x), |x| value(&speed, x), (0.0, 1.0));
        let by_samples =
            (0..=100_000).map(|k| value(&speed, k as f64 * 1e-5)).fold(f64::INFINITY, f64::min);
        let found = least.speed.expect("a minimum");
        assert!((found - by_samples).abs() <= 1e-10, "{found} {by_samples}");
    }

    /// A speed that falls and then stays has no minimum until it rises.
    #[test]
    fn a_speed_that_stays_is_no_minimum_until_it_rises() {
        let mut least = Least::default();
        let mut look = |slope: &[f64], speed: f64| {
            least.look_at(|x| value(&polynomial(slope), x), |_| speed, (0.0, 1.0));
            least.speed
        };
        assert_eq!(look(&[-1.0], 2.0), None);
        assert_eq!(look(&[1.0], 1.0), Some(1.0));
    }

    /// `∫|x − c|`, and that of a length which comes to 1e-9 of zero, wherever that is.
    #[test]
    fn the_path_through_rest_is_found() {
        for (least, c) in [(0.0, 0.3), (1e-9, 0.3), (0.0, 1e-5), (1e-9, 1.0 - 1e-6)] {
            let of = |x: f64| norm([0.6 * (x - c) + 0.8 * least, 0.8 * (x - c) - 0.6 * least]);
            let found = integral_of_length(&of, |x| 2.0 * (x - c), 1.0);
            let expected = 0.5 * (c * c + (1.0 - c) * (1.0 - c));
            assert!((found - expected).abs() <= 1e-15, "{least} {c}: {found}");
        }
    }
}
