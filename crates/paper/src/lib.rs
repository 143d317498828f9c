//! The paper, reproduced: every experiment and every claim of the source, computed again.
//!
//! [`Library`] holds the mock-ups and records ([`paper_library`] those of the examples),
//! [`reproduce`] runs and judges everything on them, [`chapter`] writes what came of it. What the paper
//! claims stands in `claims.toml`, the chapter's prose in `chapter/paper.md`.
//!
//! **Rules of judgement.** A number agrees where the computed one is within half a unit of the last
//! digit that the paper prints, or within the band that the claim's own `rule` states for a word
//! such as "about". A statement without a number agrees where the figure that `rule` names lies in
//! the band that `rule` names. What rests on data that the paper does not give cannot be checked;
//! `why` then names the datum and the range that was scanned in its place.

use slipstick::error::{InputError, ModelError, MotionError, RecordError, SolveError, Stopped};
use slipstick::study::engine::Engine;

mod carried;
pub mod chapter;
mod claims;
mod curves;
mod experiments;
mod fill;
mod friction;
mod iteration;
mod library;
mod numbers;
mod offset;
mod resonance;
mod sensitivity;
mod steady;
mod storey;
mod suite;
mod window;

pub use carried::paper_library;
pub use experiments::{DrawnTest, TestRun};
pub use friction::{FrictionPair, LighterFriction, Overturning};
pub use iteration::IterationCell;
pub use library::{Experiment, Library, Shake};
pub use numbers::Cantilever;
pub use offset::{OffsetRow, StartPhase, StepDrift};
pub use resonance::FreeSliding;
pub use sensitivity::{Compared, NOISE_M_PER_S2, SensitivityRow};
pub use storey::DisplacementCurve;
pub use suite::{
    SPECTRUM_FRICTIONS, SPECTRUM_MASS_RATIOS, SUITE_PEAK_M_PER_S2, SlidingSpectrum, SuiteRow,
    over_friction,
};
pub use window::{Point, Ratio, SCANNED_HZ, TESTED_HZ, Window};

/// What becomes of a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The computed figure satisfies the claim's rule.
    Agrees,
    /// It does not; `why` says by how much and from what.
    Differs,
    /// A datum is missing; `why` names it and the range scanned.
    CannotBeChecked,
}

impl Verdict {
    /// The verdict in words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Agrees => "agrees",
            Self::Differs => "differs",
            Self::CannotBeChecked => "cannot be checked",
        }
    }
}

/// One claim of the paper and its judgement.
#[derive(Clone, Debug, PartialEq)]
pub struct Claim {
    /// Short stable name.
    pub id: String,
    /// Where the paper says it.
    pub section: String,
    /// What it says, in our words.
    pub claim: String,
    /// The number it prints, in `unit`; `None` where it prints none.
    pub paper_value: Option<f64>,
    /// The number computed, in `unit`.
    pub computed_value: Option<f64>,
    /// Unit of both, empty for a ratio.
    pub unit: String,
    /// When it agrees.
    pub rule: String,
    /// The judgement.
    pub verdict: Verdict,
    /// Why: what was computed; for a difference its size and cause, for what cannot be checked the
    /// missing datum and the range scanned.
    pub why: String,
}

/// How finely the ranges of the paper are scanned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Grid {
    /// As the book shows them.
    Full,
    /// A tenth of the work, with the same verdicts.
    Quick,
}

impl Grid {
    /// One of two settings.
    fn pick<T>(self, full: T, quick: T) -> T {
        match self {
            Self::Full => full,
            Self::Quick => quick,
        }
    }
}

/// Everything computed, claim by claim and table by table.
#[derive(Clone, Debug, PartialEq)]
pub struct Paper {
    /// How finely it was scanned.
    pub grid: Grid,
    /// All claims in the order of the paper's sections.
    pub claims: Vec<Claim>,
    /// Both solvers on every mock-up.
    pub tests: Vec<TestRun>,
    /// The tests of the paper's figures, with histories.
    pub drawn: Vec<DrawnTest>,
    /// Frequencies of a steel rod with each mass.
    pub cantilevers: Vec<Cantilever>,
    /// Storey displacement against amplitude, figures 9d and 10d.
    pub displacements: Vec<DisplacementCurve>,
    /// Storey to table acceleration against amplitude, figures 9 to 11.
    pub free_sliding: Vec<FreeSliding>,
    /// The amplification windows, one a mock-up and amplitude.
    pub windows: Vec<Window>,
    /// Parts of the residual displacement.
    pub offsets: Vec<OffsetRow>,
    /// What the stepwise integration adds to the residual, by step.
    pub step_drifts: Vec<StepDrift>,
    /// Offset against the phase at which a sine starts.
    pub start_phases: Vec<StartPhase>,
    /// Sensitivities of peaks and residuals.
    pub sensitivities: Vec<SensitivityRow>,
    /// Static and kinetic friction, together and apart.
    pub friction_pairs: Vec<FrictionPair>,
    /// Section 6 with friction lowered.
    pub lighter: Vec<LighterFriction>,
    /// Overturning ratios.
    pub overturning: Vec<Overturning>,
    /// The stepwise iteration against `δ` and step.
    pub iterations: Vec<IterationCell>,
    /// Sliding displacement against friction over the records.
    pub suite: Vec<SuiteRow>,
    /// Spectra of sliding structures for El Centro 1940.
    pub spectra: Vec<SlidingSpectrum>,
}

impl Paper {
    /// Number of claims with a verdict.
    #[must_use]
    pub fn count(&self, verdict: Verdict) -> usize {
        self.claims.iter().filter(|claim| claim.verdict == verdict).count()
    }
}

/// Why the paper could not be reproduced: a fault of the library's own texts, or of a solver.
#[derive(Debug, thiserror::Error)]
pub enum PaperError {
    /// A model's text.
    #[error(transparent)]
    Input(#[from] InputError),
    /// A record's text.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// A record that is no motion, or a motion that cannot be made.
    #[error(transparent)]
    Motion(#[from] MotionError),
    /// A varied model.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// An analysis.
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// The callback that followed it stopped it.
    #[error(transparent)]
    Stopped(#[from] Stopped),
    /// A mock-up or record that a claim needs.
    #[error("expected {what} among the mock-ups and records of the paper, found none")]
    Missing {
        /// Its name.
        what: String,
    },
    /// A text of the paper that does not fit what was computed.
    #[error("{place}: expected {expected}, found {found}")]
    Text {
        /// The claim or the file.
        place: String,
        /// What it needs.
        expected: String,
        /// What there is.
        found: String,
    },
}

impl PaperError {
    fn text(place: &str, expected: impl Into<String>, found: impl Into<String>) -> Self {
        Self::Text { place: place.to_owned(), expected: expected.into(), found: found.into() }
    }
}

/// Shares of the work in what takes most of it, of [`WHOLE`]; every other step is one [`STEP`].
pub(crate) const ITERATION: u64 = 230;
pub(crate) const WINDOWS: u64 = 700;
const STEP: u64 = 10;
const WHOLE: u64 = ITERATION + WINDOWS + 8 * STEP;

/// What the piece `i` of `count` adds to a share of the work.
pub(crate) fn piece(share: u64, i: usize, count: usize) -> u64 {
    let upto = |i: usize| share * i as u64 / count.max(1) as u64;
    upto(i + 1) - upto(i)
}

/// Runs everything on the threads of the caller's pool; the engine is told of every thousandth of the
/// work, more or less.
///
/// The same library and grid give the same bits.
///
/// # Errors
/// [`PaperError`] for a library that lacks a mock-up or record, or an exact analysis that fails; a
/// stepwise analysis that fails is a result. [`PaperError::Stopped`] where the engine is stopped.
pub fn reproduce(library: &Library, grid: Grid, engine: &Engine<'_>) -> Result<Paper, PaperError> {
    engine.plan(WHOLE);
    let mut findings = Vec::new();
    let (tests, drawn) = experiments::run(library, &mut findings)?;
    engine.done(STEP)?;
    let cantilevers = numbers::run(library, &mut findings)?;
    engine.done(STEP)?;
    let iterations = iteration::run(library, grid, engine, &mut findings)?;
    let displacements = storey::run(library, grid, &mut findings)?;
    engine.done(STEP)?;
    let free_sliding = resonance::run(library, grid, &mut findings)?;
    engine.done(STEP)?;
    let windows = window::run(library, grid, engine, &mut findings)?;
    let (offsets, step_drifts, start_phases) = offset::run(library, grid, &mut findings)?;
    engine.done(STEP)?;
    let sensitivities = sensitivity::run(library, grid, &mut findings)?;
    engine.done(STEP)?;
    let (friction_pairs, lighter, overturning) = friction::run(library, grid, &mut findings)?;
    engine.done(STEP)?;
    let (suite, spectra) = suite::run(library, grid)?;
    engine.done(STEP)?;
    Ok(Paper {
        grid,
        claims: claims::judge(library.claims(), findings)?,
        tests,
        drawn,
        cantilevers,
        displacements,
        free_sliding,
        windows,
        offsets,
        step_drifts,
        start_phases,
        sensitivities,
        friction_pairs,
        lighter,
        overturning,
        iterations,
        suite,
        spectra,
    })
}
