//! What the reader of a result or of a record is to know: kinds of notices, how grave each is, and the
//! sentence that says it.

use core::fmt;

/// How much a notice weighs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Severity {
    /// It says how something was read and changes no decision.
    Note,
    /// It is to be looked at before the figures are used.
    Warning,
    /// The figures are void, incomplete or of another quantity until it is cleared up.
    Severe,
}

impl Severity {
    /// Its name in JSON and in Python: `note`, `warning` or `severe`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Note => "note",
            Self::Warning => "warning",
            Self::Severe => "severe",
        }
    }

    /// What stands before a notice in a text: `Note`, `Warning` or `Severe`.
    #[must_use]
    pub const fn label(self) -> &'static str {
        match self {
            Self::Note => "Note",
            Self::Warning => "Warning",
            Self::Severe => "Severe",
        }
    }
}

/// Declares the kinds: what each says, its variant, its stable name, its severity.
macro_rules! kinds {
    ($($(#[doc = $doc:literal])+ $kind:ident $name:literal $severity:ident,)+) => {
        /// Kinds of notices.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum NoticeKind {
            $($(#[doc = $doc])+ $kind,)+
        }

        impl NoticeKind {
            /// All of them.
            pub const ALL: &'static [Self] = &[$(Self::$kind),+];

            /// Its stable name in JSON, tables and texts, such as `gap_exceeded`.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$kind => $name,)+
                }
            }

            /// What it means: one sentence or more.
            #[must_use]
            pub fn meaning(self) -> &'static str {
                match self {
                    $(Self::$kind => concat!($($doc),+).trim(),)+
                }
            }

            /// How much it weighs.
            #[must_use]
            pub const fn severity(self) -> Severity {
                match self {
                    $(Self::$kind => Severity::$severity,)+
                }
            }
        }
    };
}

kinds! {
    // Reading a record or a measured test.
    /// The largest acceleration is none that an earthquake has.
    AbsurdPeak "absurd_peak" Severe,
    /// The motion as it is used has a peak velocity, displacement or acceleration that no earthquake has.
    AbsurdMotion "absurd_motion" Severe,
    /// A channel of the file was left out.
    ChannelSkipped "channel_skipped" Warning,
    /// Values are held at the extremes of the record: the recorder was probably clipped.
    Clipped "clipped" Warning,
    /// The unit of times was taken from their size: a clock that counts since 1970.
    ClockAssumed "clock_assumed" Warning,
    /// Times of blocks run away from equal steps.
    ClockDrift "clock_drift" Warning,
    /// Two files of one test have clocks of their own: one was shifted to where the other shows it.
    ClocksAligned "clocks_aligned" Warning,
    /// A column was left out.
    ColumnSkipped "column_skipped" Note,
    /// Blocks stood twice.
    DuplicateRecords "duplicate_records" Warning,
    /// Rows or traces stand twice.
    DuplicateRows "duplicate_rows" Warning,
    /// The stated duration is not that of the values.
    DurationDiffers "duration_differs" Warning,
    /// The first sample is above 1 % of the peak: the motion starts with a jump.
    FirstSampleNotZero "first_sample_not_zero" Warning,
    /// The first sample is not 0 and up to 1 % of the peak.
    FirstSampleSmall "first_sample_small" Note,
    /// Samples are missing between two times.
    Gap "gap" Warning,
    /// Two statements of the file contradict each other.
    HeaderDiffers "header_differs" Warning,
    /// Horizontal and vertical components differ in length.
    LengthsDiffer "lengths_differ" Warning,
    /// The samples lie further apart than those of any record: times that are no seconds.
    LongStep "long_step" Severe,
    /// The mean was taken off the values.
    MeanRemoved "mean_removed" Note,
    /// The modes of the structure lack some of its mass, which moves with the block.
    MissingMass "missing_mass" Note,
    /// They lack more than a tenth of it.
    MissingModes "missing_modes" Warning,
    /// Values are marked as missing.
    MissingValues "missing_values" Warning,
    /// The channel has no intensity measures.
    NoMeasures "no_measures" Warning,
    /// No value is below 0 and the last is above it: perhaps a spectrum.
    OneSided "one_sided" Severe,
    /// Blocks overlap in time.
    Overlap "overlap" Warning,
    /// The stated peak is not that of the values.
    PeakDiffers "peak_differs" Warning,
    /// The file marks a problem with the record.
    ProblemMarked "problem_marked" Warning,
    /// The stated quantity is not that of the given units.
    QuantityDiffers "quantity_differs" Warning,
    /// The values were read along the lines.
    ReadAlongLines "read_along_lines" Note,
    /// The record has a velocity at its end above 5 % of its peak velocity.
    RecordDrift "record_drift" Warning,
    /// The same file was named more than once.
    RecordNamedTwice "record_named_twice" Warning,
    /// Blocks were put in the order of their times.
    RecordsSorted "records_sorted" Warning,
    /// Two records hold the same motion.
    SameMotion "same_motion" Warning,
    /// A factor that the file states was not applied.
    ScaleUnused "scale_unused" Warning,
    /// The times of the file were replaced by the step that was given.
    TimesReplaced "times_replaced" Warning,
    /// The times are rounded.
    TimesRounded "times_rounded" Warning,
    /// The file ends before what it announces.
    Truncated "truncated" Severe,
    /// A vertical component, by its file, is run as a horizontal one.
    VerticalComponent "vertical_component" Severe,
    /// A column's name states no unit; one was taken that makes its peak that of an earthquake.
    UnitsAssumed "units_assumed" Severe,

    // The model and the motion under it.
    /// The Nyquist frequency of the motion is below five times that of the highest mode.
    CoarseSampling "coarse_sampling" Warning,
    /// The factor on a record lies far from 1.
    FactorFar "factor_far" Warning,
    /// A damping ratio above 0.3: perhaps meant in percent.
    HighDamping "high_damping" Warning,
    /// A coefficient of friction above 0.5: perhaps meant in percent.
    HighFriction "high_friction" Warning,
    /// An inner surface has more friction than an outer one.
    InnerFrictionHigh "inner_friction_high" Warning,
    /// The slope is above the kinetic friction and no spring holds the block.
    SlideNeedNotStop "slide_need_not_stop" Warning,
    /// A radius is smaller than that of pendulum sliders.
    SmallRadius "small_radius" Warning,

    // A response.
    /// The check does not confirm the response.
    CheckFailed "check_failed" Severe,
    /// A decision between sticking and sliding had a margin below 1e-6: a slightly different motion may
    /// tell another story.
    CloseCall "close_call" Warning,
    /// Contact is lost for a time.
    ContactLost "contact_lost" Severe,
    /// The block slides too far for flat geometry.
    FlatGeometry "flat_geometry" Warning,
    /// The block slides past its gap.
    GapExceeded "gap_exceeded" Severe,
    /// Peaks are those between the impacts.
    ImpulsesExcluded "impulses_excluded" Warning,
    /// The block never slides.
    NothingSlides "nothing_slides" Warning,
    /// Friction cannot hold the block at the start.
    SlipsAtStart "slips_at_start" Warning,
    /// The block strikes its stop.
    StopStruck "stop_struck" Warning,
    /// A surface reaches the end of its travel.
    TravelReached "travel_reached" Warning,

    // Many runs, and what is fitted to them.
    /// Rules of a code are used on a target spectrum that may be another's.
    CodeAssumed "code_assumed" Warning,
    /// Property modification factors are milder than those of the code.
    MildFactors "mild_factors" Warning,
    /// The displacement of the equivalent-lateral-force procedure is beyond the travel or the gap.
    LateralBeyondTravel "lateral_beyond_travel" Severe,
    /// A chosen value lies at an end of its range.
    EdgeOfRange "edge_of_range" Warning,
    /// Some draws of a bootstrap have no fit.
    FailedDraws "failed_draws" Warning,
    /// Some runs have no answer.
    FailedRuns "failed_runs" Severe,
    /// There are few records for what is asked of them.
    FewRecords "few_records" Warning,
    /// Some runs of a study are not in its folder.
    Incomplete "incomplete" Severe,
    /// Runs are taken as independent.
    IndependentRuns "independent_runs" Warning,
    /// What is noticed of the inputs of a study.
    Inputs "inputs" Warning,
    /// Some records do not reach the limit.
    LimitNotReached "limit_not_reached" Warning,
    /// No curve could be fitted.
    NoCurve "no_curve" Warning,
    /// No design keeps the gap.
    NoFeasibleDesign "no_feasible_design" Warning,
    /// The chosen design exceeds the gap at a bound of friction.
    NotRobust "not_robust" Warning,
    /// The demand falls below the limit again at a higher level.
    Resurrection "resurrection" Warning,
    /// What runs of a study gave notice of.
    Runs "runs" Warning,

    // Measured tests.
    /// Two clocks differ.
    ClockSuspect "clock_suspect" Warning,
    /// A measured channel does not start at 0.
    DoesNotStartAtZero "does_not_start_at_zero" Warning,
    /// The measured force drifts.
    ForceDrift "force_drift" Warning,
    /// The kinetic friction cannot be determined, the static one can.
    KineticNotTold "kinetic_not_told" Warning,
    /// An estimate is not clear of 0.
    NotClearOfZero "not_clear_of_zero" Warning,
    /// A sensor has an offset.
    SensorOffset "sensor_offset" Warning,
    /// Gain, clock or drift of a sensor is clear of what it is taken for, and was fitted with the rest.
    SensorsDiffer "sensors_differ" Warning,
    /// What a fitted model leaves is no noise: above the stated one, or with a memory that noise does not have.
    ModelMisfit "model_misfit" Severe,
    /// A measured channel has the other sign.
    SignSuspect "sign_suspect" Severe,
    /// The static friction was taken as large as the kinetic one.
    StaticTakenAsKinetic "static_taken_as_kinetic" Warning,
    /// A measured channel has another unit.
    UnitSuspect "unit_suspect" Severe,
    /// The zero of a sensor is not stated.
    ZeroNotStated "zero_not_stated" Warning,
}

impl NoticeKind {
    /// The kind of a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|kind| kind.name() == name)
    }

    /// Its name in words, such as `gap exceeded`.
    #[must_use]
    pub fn words(self) -> String {
        self.name().replace('_', " ")
    }
}

/// Every kind with its severity and what it means, the gravest first, as a table of the book.
#[must_use]
pub fn table() -> String {
    let mut kinds = NoticeKind::ALL.to_vec();
    kinds.sort_by_key(|kind| (core::cmp::Reverse(kind.severity()), kind.name()));
    let mut text = "| notice | severity | what it means |\n|---|---|---|\n".to_owned();
    for kind in kinds {
        let (name, severity, meaning) = (kind.name(), kind.severity().name(), kind.meaning());
        text.push_str(&format!("| `{name}` | {severity} | {meaning} |\n"));
    }
    text
}

impl fmt::Display for NoticeKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// Something that the reader of a result or of a record must know.
#[derive(Clone, Debug, PartialEq)]
pub struct Notice {
    /// What it is about.
    pub kind: NoticeKind,
    /// When, in s, if it has a time.
    pub time_s: Option<f64>,
    /// One sentence.
    pub message: String,
    /// Whether it is severe, however much its kind weighs.
    pub is_severe: bool,
}

impl Notice {
    /// A notice of no one time.
    #[must_use]
    pub fn new(kind: NoticeKind, message: impl Into<String>) -> Self {
        Self { kind, time_s: None, message: message.into(), is_severe: false }
    }

    /// This notice at a time.
    #[must_use]
    pub fn at(self, time_s: f64) -> Self {
        Self { time_s: Some(time_s), ..self }
    }

    /// This notice as a severe one, where that holds.
    #[must_use]
    pub fn severe_where(self, is_severe: bool) -> Self {
        Self { is_severe: self.is_severe || is_severe, ..self }
    }

    /// How much it weighs.
    #[must_use]
    pub const fn severity(&self) -> Severity {
        if self.is_severe { Severity::Severe } else { self.kind.severity() }
    }

    /// Whether it says how something was read and changes no decision.
    #[must_use]
    pub fn is_note(&self) -> bool {
        self.severity() == Severity::Note
    }

    /// What stands before it in a text.
    #[must_use]
    pub const fn label(&self) -> &'static str {
        self.severity().label()
    }

    /// Puts the gravest first; those of one severity keep their order.
    pub fn sort(all: &mut [Self]) {
        all.sort_by_key(|notice| core::cmp::Reverse(notice.severity()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `TimesRounded` is `times_rounded`, and no other is.
    #[test]
    fn names_are_the_variants_in_snake_case() {
        for kind in NoticeKind::ALL {
            let mut snake = String::new();
            for c in format!("{kind:?}").chars() {
                if c.is_uppercase() && !snake.is_empty() {
                    snake.push('_');
                }
                snake.extend(c.to_lowercase());
            }
            assert_eq!(kind.to_string(), snake);
            assert_eq!(NoticeKind::from_name(&snake), Some(*kind));
        }
        assert_eq!(NoticeKind::from_name("first_sample"), None);
    }

    /// `cargo xtask notices --write` writes it.
    #[test]
    fn the_book_has_every_notice() {
        let page = include_str!("../../../book/src/generated/notices.md");
        assert_eq!(page, table());
        for kind in NoticeKind::ALL {
            assert!(page.contains(&format!("| `{}` |", kind.name())), "{kind}");
            assert!(kind.meaning().len() > 10 && !kind.meaning().contains('|'), "{kind}");
        }
    }

    #[test]
    fn notes_change_no_decision() {
        let notes = NoticeKind::ALL.iter().filter(|kind| kind.severity() == Severity::Note);
        let notes: Vec<String> = notes.map(|kind| kind.words()).collect();
        let known = [
            "column skipped",
            "first sample small",
            "mean removed",
            "missing mass",
            "read along lines",
        ];
        assert_eq!(notes, known);
        assert!(Severity::Note < Severity::Warning && Severity::Warning < Severity::Severe);
        let notice = Notice::new(NoticeKind::MeanRemoved, "the mean was removed");
        assert_eq!((notice.label(), notice.at(1.0).time_s), ("Note", Some(1.0)));
        assert_eq!(Notice::new(NoticeKind::Gap, "a gap").label(), "Warning");
        assert_eq!(Notice::new(NoticeKind::GapExceeded, "beyond").label(), "Severe");
    }
}
