//! The solution at the end of a whole sample as a matrix.

use super::series::{Load, MAX_RATE_STEP, Series, State};
use super::system::{PerStorey, System};

/// State at the end of a sample from that at its start and the loads at both ends.
///
/// Stored column by column, each a state: what one unit of each component of the state leaves
/// behind, then one unit of the acceleration at start and end and of the friction force at start
/// and end. In stick the block's own components do not change and friction has no effect.
#[derive(Clone, Debug)]
pub struct Propagator<V: PerStorey> {
    state: Vec<V::Flat>,
    acceleration: [V::Flat; 2],
    friction: [V::Flat; 2],
}

impl<V: PerStorey> Propagator<V> {
    /// Propagator of slip or stick over `length_s`: the Taylor series of every unit input.
    #[must_use]
    pub fn new(system: &System<V>, slip: bool, length_s: f64) -> Self {
        let n = system.storeys();
        let mut series = Series::zeros(n);
        let mut end_of = |state, ends| end(system, slip, length_s, state, ends, &mut series);
        let zeros = || State::<V>::zeros(n);
        let still = [[0.0; 2]; 2];
        Self {
            state: (0..2 * n + 2)
                .map(|j| {
                    let mut unit = zeros();
                    unit.0.as_mut()[j] = 1.0;
                    end_of(unit, still)
                })
                .collect(),
            acceleration: [[1.0, 0.0], [0.0, 1.0]].map(|a| end_of(zeros(), [a, [0.0; 2]])),
            friction: [[1.0, 0.0], [0.0, 1.0]].map(|t| end_of(zeros(), [[0.0; 2], t])),
        }
    }

    /// State at the end of a sample of slip; `acceleration` and `friction` at start and end.
    #[inline(always)]
    #[must_use]
    pub fn slip(&self, x: &State<V>, acceleration: [f64; 2], friction: [f64; 2]) -> State<V> {
        let mut out = x.clone();
        let dimension = out.0.as_ref().len();
        let (x, columns) = (x.0.as_ref(), &self.state[..dimension]);
        let [a, b] = self.acceleration.each_ref().map(|column| &column.as_ref()[..dimension]);
        let [c, d] = self.friction.each_ref().map(|column| &column.as_ref()[..dimension]);
        for (i, out) in out.0.as_mut().iter_mut().enumerate() {
            let load = (a[i] * acceleration[0] + b[i] * acceleration[1])
                + (c[i] * friction[0] + d[i] * friction[1]);
            *out = load + combination(columns, x, i, 0);
        }
        out
    }

    /// State at the end of a sample of stick; `acceleration` at start and end.
    #[inline(always)]
    #[must_use]
    pub fn stick(&self, x: &State<V>, acceleration: [f64; 2]) -> State<V> {
        let mut out = x.clone();
        let dimension = out.0.as_ref().len();
        let (x, columns) = (x.0.as_ref(), &self.state[..dimension]);
        let [a, b] = self.acceleration.each_ref().map(|column| &column.as_ref()[..dimension]);
        for (i, out) in out.0.as_mut().iter_mut().enumerate().skip(2) {
            let load = a[i] * acceleration[0] + b[i] * acceleration[1];
            *out = load + combination(columns, x, i, 2);
        }
        out
    }
}

/// Row `i` of the columns from `first` on times `x`, in pairs.
#[inline(always)]
fn combination<F: AsRef<[f64]>>(columns: &[F], x: &[f64], i: usize, first: usize) -> f64 {
    let mut sum = 0.0;
    let mut j = first;
    while j + 1 < x.len() {
        sum += columns[j].as_ref()[i] * x[j] + columns[j + 1].as_ref()[i] * x[j + 1];
        j += 2;
    }
    sum
}

/// State at the end of a sample, by as many series as its length needs.
fn end<V: PerStorey>(
    system: &System<V>,
    slip: bool,
    length_s: f64,
    mut state: State<V>,
    [acceleration, friction]: [[f64; 2]; 2],
    series: &mut Series<V>,
) -> V::Flat {
    let rate = if slip { system.slip_rate_rad_per_s } else { system.stick_rate_rad_per_s };
    let pieces = (rate * length_s / MAX_RATE_STEP).ceil().max(1.0);
    let length_s = length_s / pieces;
    for piece in 0..pieces as usize {
        let at = |[from, to]: [f64; 2]| {
            let change = (to - from) / pieces;
            (from + change * piece as f64, change)
        };
        let ((acceleration, acceleration_change), (friction, friction_change)) =
            (at(acceleration), at(friction));
        let load = Load { acceleration, acceleration_change, friction, friction_change };
        if slip {
            series.slip(system, &state, &load, length_s);
        } else {
            series.stick(system, &state, &load, length_s);
        }
        series.state_at(1.0, &mut state);
    }
    state.0
}
