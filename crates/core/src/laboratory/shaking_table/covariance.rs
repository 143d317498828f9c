//! The covariance of what was fitted: parameters of the model and what the transducers do.

use super::instruments::Instrument;
use super::{Data, Fitted, Sight};
use crate::laboratory::fit::Problem;
use crate::numerics::algebra::inverse;
use crate::numerics::distribution::student_quantile;

/// Covariances of a fit, by derivatives at the best values.
#[derive(Clone, Debug, PartialEq)]
pub struct Covariance {
    /// What was fitted: parameters of the model, then of transducers.
    pub names: Vec<String>,
    /// How many of them are parameters of the model.
    pub parameters: usize,
    /// The covariances, row by row, in the products of the SI units.
    pub rows: Vec<Vec<f64>>,
    /// Student's quantile of 95 %.
    quantile: f64,
}

impl Covariance {
    /// Of the best values: `σ² L (Jᵀ J)⁻¹` with the derivatives `J` of all residuals over half of each
    /// interval, and the correlation length `L`.
    pub(super) fn new(
        paths: &[&str],
        found: &Fitted,
        problem: &Problem,
        data: &Data,
        scales: &[f64],
    ) -> Option<Self> {
        let values = problem.parameters(&found.minimum.unit);
        let sights = |values: &[f64]| data.sights(&(data.build)(values)?, data.motion);
        let best = sights(&values)?;
        let fitted = data.remainders(&best, None, scales)?;
        let predicted = |sights: &[Sight]| -> Vec<f64> {
            let of = |(index, sight): (usize, &Sight)| {
                let b = fitted[index].found;
                let at = |i: usize| {
                    let x = Instrument::regressors(&sight.seen, i);
                    b.iter().zip(x).map(|(b, x)| b * x).sum::<f64>() / scales[index]
                };
                (0..sight.measured.len()).map(at).collect::<Vec<f64>>()
            };
            sights.iter().enumerate().flat_map(of).collect()
        };
        let mut columns = found.derivatives(problem, |values| Some(predicted(&sights(values)?)))?;
        let mut names: Vec<String> = paths.iter().map(|path| (*path).to_owned()).collect();
        let parameters = names.len();
        let mut priors = vec![0.0; parameters];
        let total: usize = best.iter().map(|sight| sight.measured.len()).sum();
        let mut from = 0;
        for (index, sight) in best.iter().enumerate() {
            let series = &data.measured.series[index];
            let nominal = data.instruments[index].nominal(0.0);
            let whats = ["gain", "lag", "zero", "drift"];
            for (k, [_, deviation]) in nominal.into_iter().enumerate().filter(|(_, n)| n[1] > 0.0) {
                let mut column = vec![0.0; total];
                for i in 0..sight.measured.len() {
                    column[from + i] = Instrument::regressors(&sight.seen, i)[k] / scales[index];
                }
                columns.push(column);
                priors.push(data.weight.get() / (deviation * deviation));
                names.push(format!("{}.{}", series.channel.name(), whats[k]));
            }
            from += sight.measured.len();
        }
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let normal: Vec<Vec<f64>> = (0..columns.len())
            .map(|i| {
                let entry =
                    |j: usize| dot(&columns[i], &columns[j]) + if i == j { priors[i] } else { 0.0 };
                (0..columns.len()).map(entry).collect()
            })
            .collect();
        let scale: Vec<f64> = (0..columns.len()).map(|i| normal[i][i].sqrt()).collect();
        if scale.iter().any(|s| !(*s > 0.0)) {
            return None;
        }
        let scaled = |(i, row): (usize, &Vec<f64>)| {
            row.iter().zip(&scale).map(|(v, s)| v / (s * scale[i])).collect::<Vec<f64>>()
        };
        let inverted = inverse(&normal.iter().enumerate().map(scaled).collect())?;
        let variance = found.variance * found.length;
        let row = |(i, row): (usize, &Vec<f64>)| {
            row.iter().zip(&scale).map(|(v, s)| variance * v / (s * scale[i])).collect()
        };
        let rows: Vec<Vec<f64>> = inverted.iter().enumerate().map(row).collect();
        let is_sound = rows.iter().enumerate().all(|(i, row)| row[i] > 0.0);
        let freedom = (total as f64 - names.len() as f64).max(1.0);
        let quantile = student_quantile(0.95, freedom);
        is_sound.then_some(Self { names, parameters, rows, quantile })
    }

    /// The correlation of two of them.
    #[must_use]
    pub fn correlation(&self, i: usize, j: usize) -> f64 {
        self.rows[i][j] / (self.rows[i][i] * self.rows[j][j]).sqrt()
    }

    /// Half the 95 % interval of one of them.
    #[must_use]
    pub fn half_width(&self, name: &str) -> Option<f64> {
        let index = self.names.iter().position(|known| known == name)?;
        Some(self.quantile * self.rows[index][index].sqrt())
    }
}
