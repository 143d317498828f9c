//! Which runs of many are certified, and what came of it.
//!
//! A certificate costs several runs, so of many runs only some have one: one of every thousand, the first of each
//! kind, and all where they are few. A kind is a structure and its devices under motions in the same directions:
//! what is solved in another way. A run that the check does not confirm is no answer, and every analysis says how
//! many of its runs were certified, and which of them was the worst.

use core::fmt;

use super::records::Record;
use crate::check::Certificate;
use crate::input::Parts;
use crate::input::kind::ModelKind;
use crate::motion::GroundMotion;
use crate::notice::{Notice, NoticeKind};
use crate::numerics::random::{GOLDEN, mix};

/// One of so many runs is drawn.
const EVERY: u64 = 1000;

/// So few runs are all certified.
const FEW: usize = 8;

/// What a run is one of: the model, and the directions of its motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RunKind {
    model: ModelKind,
    /// Whether the table moves along y too, and vertically.
    moves: [bool; 2],
}

impl RunKind {
    /// That of a model on a record, or on the motion that it makes where there is none.
    pub(crate) fn of(parts: &Parts, record: Option<&Record>) -> Self {
        let moves = match (record, &parts.motion) {
            (Some(record), _) => of_motion(&record.motion),
            (None, Some(source)) => [source.key_of_y().is_some(), false],
            (None, None) => [false; 2],
        };
        Self { model: ModelKind::of(&parts.model), moves }
    }
}

fn of_motion(motion: &GroundMotion) -> [bool; 2] {
    [motion.horizontal_y_m_per_s2().is_some(), motion.vertical_m_per_s2().is_some()]
}

/// Whether a run is drawn of so many: one of every thousand, wherever it stands among them, and at least one.
pub(super) fn is_drawn(run: u64, runs: u64) -> bool {
    let first = run - run % EVERY;
    let length = EVERY.min(runs.saturating_sub(first)).max(1);
    run == first + mix(mix(first.wrapping_add(GOLDEN))) % length
}

/// The places of the runs that are certified: those that are drawn, the first of each kind, and all where they are
/// few. A run without an answer has no kind.
pub(super) fn chosen(kinds: &[Option<RunKind>], is_drawn: impl Fn(usize) -> bool) -> Vec<usize> {
    let mut seen: Vec<RunKind> = Vec::new();
    let mut is_chosen = |(place, kind): &(usize, &Option<RunKind>)| {
        let is_first = kind.filter(|kind| !seen.contains(kind)).map(|kind| seen.push(kind));
        is_first.is_some() || is_drawn(*place) || (kinds.len() <= FEW && kind.is_some())
    };
    kinds.iter().enumerate().filter(|of| is_chosen(of)).map(|(place, _)| place).collect()
}

/// What became of running a run again.
#[derive(Clone, Debug, Default, PartialEq)]
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
    /// The largest of these by its name, that of demands with the demand; none without a certificate.
    pub largest: Option<(String, f64)>,
    /// What the certificate does not confirm, in words; empty where it holds.
    pub defects: String,
}

impl Verdict {
    /// That of a certificate.
    #[must_use]
    pub fn of(certificate: &Certificate, same: bool) -> Self {
        let named = |(name, figure): (String, f64)| format!("{name} {figure:.1e}");
        let defects: Vec<String> = certificate.defects().into_iter().map(named).collect();
        let defects = match &defects[..] {
            [] => String::new(),
            all => format!("{} above the bound {:.1e}", all.join(", "), certificate.bound),
        };
        Self {
            same,
            holds: certificate.holds(),
            equilibrium_residual: certificate.equilibrium_residual,
            friction_excess: certificate.friction_excess,
            energy_balance_error: certificate.energy_balance_error,
            demands_error: certificate.demands_error,
            largest: Some(certificate.largest()),
            defects,
        }
    }

    /// Whether nothing is wrong with the row.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.same && self.holds
    }

    /// What is wrong with it: that it came out differently, or the figures that do not hold, with the demand.
    #[must_use]
    pub fn what_failed(&self) -> String {
        match self.holds || self.defects.is_empty() {
            true => "run again alone it came out differently".to_owned(),
            false => self.defects.clone(),
        }
    }
}

/// The figure of a certificate that came closest to its bound, of all certified runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Worst {
    /// What the run is called.
    pub run: String,
    /// The figure, or the demand.
    pub what: String,
    /// Its size.
    pub error: f64,
}

/// A run that the check does not confirm.
#[derive(Clone, Debug, PartialEq)]
pub struct Unconfirmed {
    /// What the run is called.
    pub run: String,
    /// What is not confirmed, with the demand where it is one.
    pub what: String,
}

/// How many runs of an answer were certified.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Certified {
    /// All of them.
    pub runs: u64,
    /// Those that were made again, alone and with their histories, and judged.
    pub certified: u64,
    /// The worst of those.
    pub worst: Option<Worst>,
    /// Those that the check does not confirm.
    pub unconfirmed: Vec<Unconfirmed>,
}

impl Certified {
    /// None yet, of so many.
    #[must_use]
    pub fn of(runs: u64) -> Self {
        Self { runs, ..Self::default() }
    }

    /// With one more certified run, by its name.
    pub fn add(&mut self, run: &str, verdict: &Verdict) {
        let defect = (!verdict.holds()).then(|| verdict.what_failed());
        self.add_judged(run, verdict.largest.clone(), defect);
    }

    /// The same by the largest figure of its certificate, where that is known, and what it does not confirm.
    pub(crate) fn add_judged(
        &mut self,
        run: &str,
        largest: Option<(String, f64)>,
        defect: Option<String>,
    ) {
        let run = || run.to_owned();
        self.join(Self {
            runs: 0,
            certified: 1,
            worst: largest.map(|(what, error)| Worst { run: run(), what, error }),
            unconfirmed: defect.map(|what| Unconfirmed { run: run(), what }).into_iter().collect(),
        });
    }

    /// With those of other runs.
    pub fn join(&mut self, other: Self) {
        self.runs += other.runs;
        self.certified += other.certified;
        self.worst = worse(self.worst.take(), other.worst);
        self.unconfirmed.extend(other.unconfirmed);
    }

    /// That the check does not confirm runs: how many, the first of them, and the demand.
    #[must_use]
    pub fn refusal(&self) -> Option<String> {
        let Unconfirmed { run, what } = self.unconfirmed.first()?;
        Some(format!(
            "CHECK FAILED for {} of {} certified runs, the first {run}: {what}",
            self.unconfirmed.len(),
            self.certified
        ))
    }

    /// The same as a notice of an answer that leaves them out.
    #[must_use]
    pub fn notice(&self) -> Option<Notice> {
        let message =
            format!("{}; they are left out, and so is what they would count", self.refusal()?);
        Some(Notice::new(NoticeKind::CheckFailed, message))
    }
}

/// The worse of two, the first where they are equal.
#[must_use]
pub fn worse(one: Option<Worst>, other: Option<Worst>) -> Option<Worst> {
    match (one, other) {
        (Some(one), Some(other)) => {
            let is_worse = other.error > one.error || other.error.is_nan() && !one.error.is_nan();
            Some(if is_worse { other } else { one })
        }
        (one, other) => one.or(other),
    }
}

impl fmt::Display for Certified {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { runs, certified, worst, .. } = self;
        write!(f, "{certified} of {runs} runs certified")?;
        match worst {
            None => Ok(()),
            Some(Worst { run, what, error }) if *error == 0.0 => {
                write!(f, "; worst: {run} ({what}, 0)")
            }
            Some(Worst { run, what, error }) => write!(f, "; worst: {run} ({what}, {error:.0e})"),
        }
    }
}

/// Whether numbers are the same to the last bit.
pub(crate) fn same_bits(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.to_bits() == b.to_bits())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::kind::StructureKind;
    use crate::notice::Severity;

    fn kind(structure: StructureKind) -> Option<RunKind> {
        let mut kind = RunKind::default();
        kind.model.structure = structure;
        Some(kind)
    }

    /// The first of each kind with an answer is certified beside those that are drawn.
    #[test]
    fn the_first_of_each_kind_is_certified() {
        let mut kinds = vec![kind(StructureKind::Rigid); 40];
        kinds[0] = None;
        kinds[7] = kind(StructureKind::Modes);
        kinds[9] = Some(RunKind { moves: [true, false], ..RunKind::default() });
        kinds[12] = kind(StructureKind::Modes);
        assert_eq!(chosen(&kinds, |place| place == 30), [1, 7, 9, 30]);
        // Few are all certified, but for those without an answer.
        assert_eq!(chosen(&kinds[..4], |_| false), [1, 2, 3]);
        assert_eq!(chosen(&[], |_| false), [0; 0]);
    }

    /// The worst is named whatever the order, and what is no number is worst of all.
    #[test]
    fn the_worst_is_named() {
        let verdict = |error: f64| Verdict {
            same: true,
            holds: error < 1e-10,
            largest: Some(("demands error of sliding path".to_owned(), error)),
            defects: format!("demands error of sliding path {error:.1e} above the bound 1.0e-10"),
            ..Verdict::default()
        };
        let mut certified = Certified::of(2640);
        for (run, error) in [("run 3", 1e-14), ("run 17", 2e-13), ("run 20", 0.0)] {
            certified.add(run, &Verdict { defects: String::new(), ..verdict(error) });
        }
        let said = "3 of 2640 runs certified; worst: run 17 (demands error of sliding path, 2e-13)";
        assert_eq!(certified.to_string(), said);
        assert_eq!(certified.notice(), None);
        certified.add("run 21", &verdict(f64::NAN));
        certified.add("run 22", &verdict(0.5));
        assert_eq!(certified.worst.as_ref().map(|worst| &worst.run[..]), Some("run 21"));
        let notice = certified.notice().expect("a notice");
        let kind = (notice.kind, notice.severity());
        assert_eq!(kind, (NoticeKind::CheckFailed, Severity::Severe), "{notice:?}");
        let said = "CHECK FAILED for 2 of 5 certified runs, the first run 21: demands error of sliding path";
        assert!(notice.message.starts_with(said), "{notice:?}");
    }
}
