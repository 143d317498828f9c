//! The sliding speed over a step: its least minimum, and the path.

use super::peaks::bend;
use super::series::{Kind, Series};
use super::system::norm;
use crate::linear::polynomial::{DEGREE, Polynomial, derivative, value};

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

    fn note(&mut self, speed: f64) {
        self.speed = Some(self.speed.map_or(speed, |least| least.min(speed)));
    }

    /// Looks at the speed over `[0, to]`.
    pub(super) fn look(&mut self, speed: &Polynomial, to: f64) {
        if to == 0.0 {
            return;
        }
        let slope = derivative(speed);
        let (mut from, end) = (0.0, value(&slope, to));
        if self.is_falling && slope[0] >= 0.0 {
            self.note(speed[0]);
        }
        let lowest = speed[0].min(value(speed, to)) - bend(speed, to);
        if self.speed.is_none_or(|least| lowest < least) || end < 0.0 && slope[0] >= 0.0 {
            // From one zero of the slope to the next.
            let mut falls = slope[0] < 0.0;
            for _ in 0..DEGREE {
                let Some(x) = next_zero(&slope, from, to, falls) else { break };
                if falls {
                    self.note(value(speed, x));
                }
                (from, falls) = (x, !falls);
            }
        }
        self.is_falling = end < 0.0;
    }
}

/// The next point of `(from, to]` at which a slope changes its sign.
fn next_zero(slope: &Polynomial, from: f64, to: f64, falls: bool) -> Option<f64> {
    let sign = if falls { -1.0 } else { 1.0 };
    let mut low = from;
    // Slopes are smooth over a step: as many parts as a polynomial of its degree has turns.
    let parts = 2 * DEGREE;
    for i in 1..=parts {
        let high = from + (to - from) * (i as f64 / parts as f64);
        if sign * value(slope, high) < 0.0 {
            return Some(bisected(slope, sign, [low, high]));
        }
        low = high;
    }
    None
}

fn bisected(slope: &Polynomial, sign: f64, [mut low, mut high]: [f64; 2]) -> f64 {
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return high;
        }
        if sign * value(slope, middle) < 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
}

/// `∫|w| dt` over the first part of a series.
pub(super) fn path_m(series: &Series, to: f64) -> f64 {
    match series.kind {
        Kind::Stick => 0.0,
        Kind::Slip | Kind::Start => {
            let mut sum = 0.0;
            for k in (0..=DEGREE).rev() {
                sum = sum * to + series.speed[k] / (k + 1) as f64;
            }
            series.unit * to * sum
        }
        // ∫ r² dτ
        Kind::NearRest => gauss(0.0, to, &|x| {
            let r = value(&series.speed, x);
            series.unit * r * r
        }),
        Kind::Frictionless => {
            let speed = |x: f64| series.unit * norm(series.velocity_at(x));
            adaptive(&speed, [0.0, to], gauss(0.0, to, &speed), 40)
        }
    }
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

/// The same, halved where halves tell another story.
fn adaptive(of: &dyn Fn(f64) -> f64, [from, to]: [f64; 2], whole: f64, depth: u32) -> f64 {
    let middle = 0.5 * (from + to);
    let halves = [gauss(from, middle, of), gauss(middle, to, of)];
    let sum = halves[0] + halves[1];
    if depth == 0 || (sum - whole).abs() <= 1e-15 * sum {
        return sum;
    }
    adaptive(of, [from, middle], halves[0], depth - 1)
        + adaptive(of, [middle, to], halves[1], depth - 1)
}
