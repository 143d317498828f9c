//! The steady state under a sine: the motion that repeats with the table's period.

use crate::PaperError;
use crate::library::{storey_peak, with_initial};
use slipstick::model::{InitialState, Model};
use slipstick::motion::{GroundMotion, Sine};
use slipstick::response::{Demands, Mode};
use slipstick::solver;

/// Samples in a period of the table.
pub(crate) const SAMPLES: usize = 100;

/// How nearly a period must repeat the one before, over the largest values in it.
const REPEATS: f64 = 1e-9;

/// Periods from rest before an extrapolation is tried.
const LEAD: usize = 24;

/// Most periods before a motion counts as one that does not settle.
const LONGEST: usize = 1200;

/// The longest sub-harmonic looked for, in periods of the table.
const SUBHARMONIC: usize = 6;

/// State at the start of a period: `[ṡ, q, q̇]` of a mock-up with one storey.
type State = [f64; 3];

/// How a motion ends up.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Steady {
    /// Periods of the table after which it repeats; `None` where it has not settled.
    pub period: Option<usize>,
    /// Peaks over one repetition (over the last period where it has not settled).
    pub demands: Vec<Demands>,
    /// Sliding displacement gained a repetition, in m.
    pub drift_m: f64,
}

impl Steady {
    /// Peak storey acceleration in m/s².
    pub fn peak_m_per_s2(&self) -> f64 {
        self.demands.iter().map(storey_peak).fold(0.0, f64::max)
    }
}

/// One period from a state.
struct Period {
    end: State,
    demands: Demands,
    scale: State,
}

fn period(model: &Model, table: &GroundMotion, start: &State) -> Result<Period, PaperError> {
    let initial = InitialState {
        sliding_displacement_m: 0.0,
        sliding_velocity_m_per_s: start[0],
        storey_displacement_m: Some(vec![start[1]]),
        storey_velocity_m_per_s: Some(vec![start[2]]),
    };
    let response = solver::exact(&with_initial(model, initial)?, table)?;
    let history = response.history.unwrap_or_default();
    let last = history.len().saturating_sub(1);
    let w = match history.mode.last() {
        Some(Mode::Slip(_)) => history.sliding_velocity_m_per_s[last],
        _ => 0.0,
    };
    let end = [w, history.storey_displacements(last)[0], history.storey_velocities(last)[0]];
    let largest = |values: &[f64]| values.iter().fold(1e-12, |m: f64, v| m.max(v.abs()));
    let scale = [
        largest(&history.sliding_velocity_m_per_s),
        largest(&history.storey_displacement_m),
        largest(&history.storey_velocity_m_per_s),
    ];
    Ok(Period { end, demands: response.demands, scale })
}

/// The steady state of a mock-up with one storey and no spring, reached from rest.
///
/// Periods follow each other from rest; every few of them the limit of the sequence is extrapolated
/// (reduced rank, exact for a linear map), and only a state that the motion itself repeats to 1e-9
/// is taken. The spring's absence makes the sliding displacement itself of no account.
pub(crate) fn steady(model: &Model, sine: &Sine) -> Result<Steady, PaperError> {
    let period_s = 1.0 / sine.frequency_hz;
    let table = Sine {
        duration_s: period_s,
        dt_s: period_s / SAMPLES as f64,
        ramp_s: 0.0,
        decay_s: 0.0,
        ..*sine
    }
    .motion()?;
    // Start states, end states and peaks of the periods since the last extrapolation.
    let mut states: Vec<State> = vec![[0.0; 3]];
    let mut demands: Vec<Demands> = Vec::new();
    let mut since = 0;
    for made in 1..=LONGEST {
        let start = states[states.len() - 1];
        let next = period(model, &table, &start)?;
        demands.push(next.demands);
        states.push(next.end);
        since += 1;
        let repeats = |n: usize| {
            let ago = states[states.len() - 1 - n];
            (0..3).all(|i| (next.end[i] - ago[i]).abs() <= REPEATS * next.scale[i])
        };
        let found = (1..=SUBHARMONIC).filter(|n| *n <= since).find(|&n| repeats(n));
        if let Some(n) = found {
            let demands = demands.split_off(demands.len() - n);
            let drift_m = demands.iter().map(|d| d.residual_sliding_displacement_m).sum();
            return Ok(Steady { period: Some(n), demands, drift_m });
        }
        let due = (LEAD..LONGEST / 2).contains(&made) && since >= 8 && made % 8 == 0;
        if due
            && approaching(&states, &next.scale)
            && let Some(limit) = extrapolated(&states[states.len() - 5..])
        {
            states = vec![limit];
            since = 0;
        }
    }
    let last = demands.split_off(demands.len() - SUBHARMONIC);
    let drift_m = last.iter().map(|d| d.residual_sliding_displacement_m).sum();
    Ok(Steady { period: None, demands: last, drift_m })
}

/// Whether the last step of the sequence is shorter than the one six periods before: only then is
/// the limit one that the motion itself goes to, and not an orbit that it leaves.
fn approaching(states: &[State], scale: &State) -> bool {
    let step = |end: usize| {
        let differ = |i: usize| (states[end][i] - states[end - 1][i]).abs() / scale[i];
        (0..3).map(differ).fold(0.0, f64::max)
    };
    let last = states.len() - 1;
    step(last) < step(last - 6)
}

/// The limit of five states of an affine map by reduced rank extrapolation: weights γ with sum 1
/// for which Σ γ_i (x_{i+1} − x_i) = 0, and Σ γ_i x_i. `None` where they are not determined.
fn extrapolated(states: &[State]) -> Option<State> {
    let stuck = states.iter().all(|x| x[0] == 0.0);
    // Rows: the components that move, then the sum; one weight more than components.
    let rows: &[usize] = if stuck { &[1, 2] } else { &[0, 1, 2] };
    let n = rows.len() + 1;
    let first = states.len() - 1 - n;
    let mut matrix = [[0.0; 5]; 4];
    for (r, &component) in rows.iter().enumerate() {
        let step = |i: usize| states[first + i + 1][component] - states[first + i][component];
        let size = (0..n).map(|i| step(i).abs()).fold(0.0, f64::max);
        if size == 0.0 {
            return None;
        }
        for i in 0..n {
            matrix[r][i] = step(i) / size;
        }
    }
    for i in 0..n {
        matrix[n - 1][i] = 1.0;
    }
    matrix[n - 1][4] = 1.0;
    let weights = solved(&mut matrix, n)?;
    let mut limit = [0.0; 3];
    for i in 0..n {
        for component in 0..3 {
            limit[component] += weights[i] * states[first + i][component];
        }
    }
    limit.iter().all(|x| x.is_finite()).then_some(limit)
}

/// Solution of the first `n` equations by elimination with row pivots; right sides in column 4.
fn solved(matrix: &mut [[f64; 5]; 4], n: usize) -> Option<[f64; 4]> {
    for column in 0..n {
        let pivot = (column..n)
            .reduce(|a, b| if matrix[b][column].abs() > matrix[a][column].abs() { b } else { a })?;
        matrix.swap(column, pivot);
        if matrix[column][column].abs() < 1e-12 {
            return None;
        }
        for row in column + 1..n {
            let factor = matrix[row][column] / matrix[column][column];
            for k in (column..n).chain([4]) {
                matrix[row][k] -= factor * matrix[column][k];
            }
        }
    }
    let mut solution = [0.0; 4];
    for row in (0..n).rev() {
        let known: f64 = (row + 1..n).map(|k| matrix[row][k] * solution[k]).sum();
        solution[row] = (matrix[row][4] - known) / matrix[row][row];
    }
    Some(solution)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x → A x + b with eigenvalues 0.9, −0.8, 0.5 has the limit (I − A)⁻¹ b = (10, 1, 2).
    #[test]
    fn limit_of_an_affine_map() {
        let mut states = vec![[0.0; 3]];
        for _ in 0..4 {
            let [x, y, z] = states[states.len() - 1];
            states.push([0.9 * x + 0.3 * y + 0.7, -0.8 * y + 0.4 * z + 1.0, 0.5 * z + 1.0]);
        }
        let [x, y, z] = extrapolated(&states).unwrap();
        assert!((z - 2.0).abs() < 1e-9 && (y - 1.0).abs() < 1e-9 && (x - 10.0).abs() < 1e-7);
    }
}
