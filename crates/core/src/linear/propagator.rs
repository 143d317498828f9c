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
    state: V::Columns,
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
        let mut state = V::columns_zeros(n);
        for (j, column) in state.as_mut().iter_mut().enumerate().skip(if slip { 0 } else { 2 }) {
            let mut unit = zeros();
            unit.0.as_mut()[j] = 1.0;
            *column = end_of(unit, still);
        }
        Self {
            state,
            acceleration: [[1.0, 0.0], [0.0, 1.0]].map(|a| end_of(zeros(), [a, [0.0; 2]])),
            friction: [[1.0, 0.0], [0.0, 1.0]].map(|t| match slip {
                true => end_of(zeros(), [[0.0; 2], t]),
                false => zeros().0,
            }),
        }
    }

    /// State at the end of a sample of slip; `acceleration` and `friction` at start and end.
    #[inline(always)]
    #[must_use]
    pub fn slip(&self, x: &State<V>, acceleration: [f64; 2], friction: [f64; 2]) -> State<V> {
        let mut out = x.clone();
        combine(out.0.as_mut(), self.friction.each_ref().map(AsRef::as_ref), friction);
        add(out.0.as_mut(), self.acceleration.each_ref().map(AsRef::as_ref), acceleration);
        self.add_state(&mut out, x, 0);
        out
    }

    /// State at the end of a sample of stick; `acceleration` at start and end.
    #[inline(always)]
    #[must_use]
    pub fn stick(&self, x: &State<V>, acceleration: [f64; 2]) -> State<V> {
        let mut out = x.clone();
        let columns = self.acceleration.each_ref().map(|column| &column.as_ref()[2..]);
        combine(&mut out.0.as_mut()[2..], columns, acceleration);
        self.add_state(&mut out, x, 2);
        out
    }

    /// Adds what the components of `x` from `first` leave behind in themselves, in pairs.
    #[inline(always)]
    fn add_state(&self, out: &mut State<V>, x: &State<V>, first: usize) {
        let (out, x, columns) = (out.0.as_mut(), x.0.as_ref(), self.state.as_ref());
        let mut j = first;
        while j + 1 < x.len() {
            let pair = [&columns[j].as_ref()[first..], &columns[j + 1].as_ref()[first..]];
            add(&mut out[first..], pair, [x[j], x[j + 1]]);
            j += 2;
        }
    }
}

#[inline(always)]
fn combine(out: &mut [f64], [a, b]: [&[f64]; 2], [x, y]: [f64; 2]) {
    for (out, (a, b)) in out.iter_mut().zip(a.iter().zip(b)) {
        *out = a * x + b * y;
    }
}

#[inline(always)]
fn add(out: &mut [f64], [a, b]: [&[f64]; 2], [x, y]: [f64; 2]) {
    for (out, (a, b)) in out.iter_mut().zip(a.iter().zip(b)) {
        *out += a * x + b * y;
    }
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
