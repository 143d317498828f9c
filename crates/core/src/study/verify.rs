//! Rows under test: run again alone, from the model's text, with history and certificate.

use super::cases::{Case, MotionOrigin, Noticed, noticed_of};
use super::certified::{Verdict, chosen, same_bits};
use super::engine::Engine;
use super::notices::{highest_hz, longest_step_s, suspicious};
use super::rows::{of_demands, warnings};
use super::{Row, Study};
use crate::check;
use crate::error::{RunError, Stopped};
use crate::input::Analysis;
use crate::motion::GroundMotion;
use crate::solver;

impl Study {
    /// Runs one row of so many again and judges it, the first of each kind of run besides; the first that does not
    /// hold, and what is wrong with it.
    ///
    /// # Errors
    /// [`Stopped`].
    pub fn refuted(
        &self,
        rows: &[Row],
        one_of: usize,
        engine: &Engine<'_>,
    ) -> Result<Option<(u64, String)>, Stopped> {
        let kinds: Vec<_> = rows.iter().map(Row::kind_of_answer).collect();
        let checked = chosen(&kinds, |place| place % one_of.max(1) == 0);
        let verdicts = engine.map(checked.len(), |i| Ok(self.verify(&rows[checked[i]])))?;
        let failed = checked.iter().zip(verdicts).find(|(_, verdict)| !verdict.holds());
        Ok(failed.map(|(&place, verdict)| (rows[place].run, verdict.what_failed())))
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
        let suspicious: Vec<_> =
            suspicious(&analysis.model).into_iter().map(|warning| warning.kind).collect();
        let highest_hz = highest_hz(&analysis.model);
        let noticed = self.noticed(row.case, &suspicious, highest_hz, step_s);
        let same = row.error.is_none()
            && same_bits(&self.demands(&response), &row.demands)
            && warnings([
                noticed,
                of_demands(&response.demands),
                Noticed::kinds(&noticed_of(&analysis.model, &response)),
            ]) == row.warnings;
        Verdict::of(&certificate, same)
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
