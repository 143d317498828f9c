//! Rows under test: run again alone, from the model's text, with history and certificate.

use super::cases::{Case, MotionOrigin, Noticed, noticed_of};
use super::engine::Engine;
use super::notices::{highest_hz, longest_step_s, suspicious};
use super::rows::{of_demands, warnings};
use super::{Row, Study};
use crate::check::{self, Certificate};
use crate::error::{RunError, Stopped};
use crate::input::Analysis;
use crate::motion::GroundMotion;
use crate::solver;

/// What became of running a row again.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Verdict {
    /// Whether every number of the row came out the same, to the last bit; of a failed run, the same
    /// error.
    pub same: bool,
    /// Whether the certificate holds; of a failed run, which has none, whether it failed again.
    pub holds: bool,
    /// The certificate's largest defect of the equations of motion.
    pub equilibrium_residual: f64,
    /// Its largest excess over the friction law.
    pub friction_excess: f64,
    /// Its largest imbalance of energy.
    pub energy_balance_error: f64,
    /// Its largest difference of a demand from the one recomputed.
    pub demands_error: f64,
}

impl Verdict {
    /// Whether nothing is wrong with the row.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.same && self.holds
    }
}

impl Study {
    /// Runs one row of so many again and judges it, the first at least; the first that does not hold.
    ///
    /// # Errors
    /// [`Stopped`].
    pub fn refuted(
        &self,
        rows: &[Row],
        one_of: usize,
        engine: &Engine<'_>,
    ) -> Result<Option<u64>, Stopped> {
        let checked: Vec<&Row> = rows.iter().step_by(one_of.max(1)).collect();
        let verdicts = engine.map(checked.len(), |i| Ok(self.verify(checked[i]).holds()))?;
        let failed = checked.iter().zip(verdicts).find(|(_, holds)| !holds);
        Ok(failed.map(|(row, _)| row.run))
    }

    /// Runs a row again as `slipstick run` would, and judges the response.
    #[must_use]
    pub fn verify(&self, row: &Row) -> Verdict {
        let (analysis, motion, step_s) = match self.alone(row) {
            Ok(alone) => alone,
            Err(error) => return failed_again(row, &error),
        };
        let response = match solver::exact(&analysis.model, &motion) {
            Ok(response) => response,
            Err(error) => return failed_again(row, &error.into()),
        };
        let certificate = check::check(&analysis.model, &motion, &response);
        let bits = |values: &[f64]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
        let suspicious: Vec<_> =
            suspicious(&analysis.model).into_iter().map(|warning| warning.kind).collect();
        let highest_hz = highest_hz(&analysis.model);
        let noticed = self.noticed(row.case, &suspicious, highest_hz, step_s);
        let same = row.error.is_none()
            && bits(&self.demands(&response)) == bits(&row.demands)
            && warnings([
                noticed,
                of_demands(&response.demands),
                Noticed::kinds(&noticed_of(&analysis.model, &response)),
            ]) == row.warnings;
        let holds = certificate.holds();
        let Certificate {
            equilibrium_residual,
            friction_excess,
            energy_balance_error,
            demands_error,
            ..
        } = certificate;
        Verdict {
            same,
            holds,
            equilibrium_residual,
            friction_excess,
            energy_balance_error,
            demands_error,
        }
    }

    /// The analysis and the motion of a row, made from the text and the record, and the longest step of the
    /// motion without its tail.
    fn alone(&self, row: &Row) -> Result<(Analysis, GroundMotion, f64), RunError> {
        let case = self.case(row.run);
        let Case { record, design, scale, .. } = case;
        let values = self.design.values(design as u64);
        let mut analysis = self.variation.analysis(&values)?;
        analysis.model = self.bound(&case).of(&analysis.model);
        let (turned_rad, tail_s) = (self.turned_rad(&values), analysis.tail_s);
        let source = analysis.motion.as_ref();
        let origin = MotionOrigin { record, scale, source, turned_rad, tail_s };
        let bare = origin.bare(&self.records)?;
        let step_s = longest_step_s(&bare);
        let motion = origin.finished(bare)?;
        Ok((analysis, motion, step_s))
    }
}

fn failed_again(row: &Row, error: &RunError) -> Verdict {
    let same = row.error.as_ref() == Some(error);
    Verdict { same, holds: same, ..Verdict::default() }
}
