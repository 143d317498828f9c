//! The records that a model is run on, and how they are scaled.

use std::collections::BTreeSet;

use super::grid::levels;
use super::{AssessmentError, refuse};
use crate::error::{MotionError, RunError, Stopped};
use crate::hash::motion_hash;
use crate::input::Bound;
use crate::input::loaded::Loaded;
use crate::motion::GroundMotion;
use crate::motion::intensity::{LevelMeasure, Measure};
use crate::motion::target::{Matched, TargetSpectrum};
use crate::notice::Notice;
use crate::record::Origin;
use crate::study::cases::{InWords, MotionOrigin, Runs};
use crate::study::engine::Engine;
use crate::study::{Record, records};
use crate::table::{Column, Table};

/// A factor on records in words, to stand after them.
#[must_use]
pub fn times(factor: f64) -> String {
    if factor == 1.0 { " as recorded".to_owned() } else { format!(" × {factor}") }
}

/// What a measure over all directions and a target spectrum ask for.
const PAIRS: &str = "the other components of all records beside it, `second`";

/// How records are scaled, vertical components with them; the two components of a pair take one factor.
#[derive(Clone, Debug, PartialEq)]
pub enum Scaling {
    /// By a factor, 1 as recorded.
    Factor(f64),
    /// So that a measure takes a value, in its SI unit; that of a component is of a pair the geometric mean.
    Level(LevelMeasure, f64),
    /// Pairs brought to a spectrum between two periods in s.
    Target(TargetSpectrum, [f64; 2]),
}

impl Scaling {
    /// The same to an intensity of so many times that; pairs over the same range of periods.
    #[must_use]
    pub fn times(&self, factor: f64) -> Self {
        match self {
            Self::Factor(own) => Self::Factor(factor * own),
            Self::Level(measure, level) => Self::Level(*measure, factor * level),
            Self::Target(spectrum, range_s) => Self::Target(scaled(spectrum, factor), *range_s),
        }
    }

    /// That to one level of a measure as people write it; `what` is what errors call the level.
    ///
    /// # Errors
    /// [`AssessmentError::Choice`] for text that is not one level of the measure.
    pub fn to_level(
        what: &str,
        measure: LevelMeasure,
        text: &str,
    ) -> Result<Self, AssessmentError> {
        match levels(what, text, &measure.measure)?[..] {
            [value] => Ok(Self::Level(measure, value)),
            _ => Err(refuse(what, "one level", format!("{text:?}"))),
        }
    }
}

/// A spectrum with ordinates so many times as large.
fn scaled(spectrum: &TargetSpectrum, factor: f64) -> TargetSpectrum {
    match spectrum {
        TargetSpectrum::Points { periods_s, sa_m_per_s2 } => TargetSpectrum::Points {
            periods_s: periods_s.clone(),
            sa_m_per_s2: sa_m_per_s2.iter().map(|sa| factor * sa).collect(),
        },
        TargetSpectrum::Code { sds_m_per_s2, sd1_m_per_s2, tl_s } => TargetSpectrum::Code {
            sds_m_per_s2: factor * sds_m_per_s2,
            sd1_m_per_s2: factor * sd1_m_per_s2,
            tl_s: *tl_s,
        },
    }
}

/// The factor on each record, and how pairs were brought to a spectrum.
#[derive(Clone, Debug, PartialEq)]
pub struct Scaled {
    /// A factor a record.
    pub factors: Vec<f64>,
    /// Of a target spectrum.
    pub matched: Option<Matched>,
}

/// What an answer is of: a record, without its samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Recorded {
    /// Its name in tables.
    pub name: String,
    /// What its file says of where it was recorded.
    pub origin: Origin,
    /// Short hash of its samples as recorded; none where an answer does not have them.
    pub motion_hash: Option<String>,
    /// Factor on it; none where that differs from run to run.
    pub factor: Option<f64>,
    /// Its peak acceleration under that factor, else as recorded, in m/s².
    pub pga_m_per_s2: f64,
    /// What was noticed of it.
    pub notices: Vec<Notice>,
}

/// The records that a model is run on.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Suite {
    /// The records in their order.
    pub records: Vec<Record>,
    /// Whether the motion is made by the model rather than recorded: then it is the one record.
    pub made: bool,
    /// What was noticed of the records together.
    pub notices: Vec<Notice>,
}

/// Notices of many, which are `called` so, such as records: each kind once with the one that gave it first and the
/// number of the others that give it.
pub fn condensed<'a>(
    called: &str,
    of: impl IntoIterator<Item = (&'a str, &'a [Notice])>,
) -> Vec<Notice> {
    let mut noticed: Vec<(Notice, Vec<&str>)> = Vec::new();
    for (name, notices) in of {
        for notice in notices {
            match noticed.iter_mut().find(|(seen, _)| seen.kind == notice.kind) {
                Some((seen, names)) => {
                    *seen = seen.clone().severe_where(notice.is_severe);
                    if !names.contains(&name) {
                        names.push(name);
                    }
                }
                None => {
                    let message = format!("{name}: {}", notice.message);
                    noticed.push((Notice { message, time_s: None, ..notice.clone() }, vec![name]));
                }
            }
        }
    }
    let told = |(notice, names): (Notice, Vec<&str>)| match names.len() - 1 {
        0 => notice,
        more => {
            let message = format!("{} (and {more} of the other {called})", notice.message);
            Notice { message, ..notice }
        }
    };
    noticed.into_iter().map(told).collect()
}

/// Gives different motions of the same name their numbers among those: `a (1)`, `a (2)`. One that is there twice, as in
/// two pairs, is one.
fn number_alike(records: &mut [Record]) {
    let mut taken: BTreeSet<String> = records.iter().map(|record| record.name.clone()).collect();
    let names: Vec<String> = taken.iter().cloned().collect();
    for name in names {
        let mut places: Vec<Vec<usize>> = Vec::new();
        for (i, record) in records.iter().enumerate().filter(|(_, record)| record.name == name) {
            match places.iter_mut().find(|same| records[same[0]].motion == record.motion) {
                Some(same) => same.push(i),
                None => places.push(vec![i]),
            }
        }
        if places.len() < 2 {
            continue;
        }
        let mut number = 0;
        for same in places {
            number += 1;
            while !taken.insert(format!("{name} ({number})")) {
                number += 1;
            }
            same.iter().for_each(|i| records[*i].name = format!("{name} ({number})"));
        }
    }
}

impl Suite {
    /// Records that were read, by their names, each alone. Those that share a name, as motions of one description
    /// do, are told apart by their numbers.
    #[must_use]
    pub fn of(read: impl IntoIterator<Item = (String, Loaded)>, made: bool) -> Self {
        let record = |(name, loaded): (String, Loaded)| Record::read(name, loaded, None);
        let mut records: Vec<Record> = read.into_iter().map(record).collect();
        number_alike(&mut records);
        Self { records, made, notices: Vec::new() }
    }

    /// Takes records that stand beside each other as the two components of pairs.
    pub fn pair_up(&mut self) {
        for (i, record) in self.records.iter_mut().enumerate() {
            record.pair = Some(i / 2);
        }
    }

    /// Whether there are pairs among the records, each component by itself.
    #[must_use]
    pub fn has_pairs(&self) -> bool {
        records::has_pairs(&self.records)
    }

    /// Whether records move the table in two horizontal directions.
    #[must_use]
    pub fn in_plane(&self) -> bool {
        records::in_plane(&self.records)
    }

    /// The same with each pair as one motion in two horizontal directions, its first component along x, its
    /// second along y, with the vertical component of the first.
    ///
    /// # Errors
    /// [`MotionError`] where the union of their times has too many samples.
    pub fn together(&self) -> Result<Self, MotionError> {
        let records = records::together(&self.records, |x, y| format!("{x} + {y}"))?;
        Ok(Self { records, made: self.made, notices: self.notices.clone() })
    }

    /// The same with each motion in two horizontal directions as the pair of its components.
    #[must_use]
    pub fn apart(&self) -> Self {
        Self { records: records::apart(&self.records), ..self.clone() }
    }

    /// What was noticed of the records, each kind once.
    #[must_use]
    pub fn noticed(&self) -> Vec<Notice> {
        let of_each = self.records.iter().map(|record| (&record.name[..], &record.notices[..]));
        condensed("records", of_each).into_iter().chain(self.notices.iter().cloned()).collect()
    }

    /// What an answer over the suite is of.
    #[must_use]
    pub fn recorded(&self) -> Vec<Recorded> {
        let of = |record: &Record| Recorded {
            name: record.name.clone(),
            origin: record.origin.clone(),
            motion_hash: Some(motion_hash(&record.motion)),
            factor: None,
            pga_m_per_s2: record.motion.figures().pga_m_per_s2,
            notices: record.notices.clone(),
        };
        self.records.iter().map(of).collect()
    }

    /// The measure of each record as recorded, in SI; that of a pair is one of both components.
    ///
    /// # Errors
    /// [`AssessmentError::Choice`] for a measure that does not grow as the motion does, a measure of pairs
    /// where there are none, and for a record or pair of which it is 0; stopped.
    pub fn measure(
        &self,
        measure: &LevelMeasure,
        engine: &Engine<'_>,
    ) -> Result<Vec<f64>, AssessmentError> {
        let values = self.measure_of_groups(measure, engine)?;
        Ok(self.on_each_record(&values))
    }

    /// The measure of each record alone, or pair.
    fn measure_of_groups(
        &self,
        measure: &LevelMeasure,
        engine: &Engine<'_>,
    ) -> Result<Vec<f64>, AssessmentError> {
        if !measure.scales() {
            let expected = "a measure that grows as the motion does, such as PGA or Sa(1.2 s)";
            return Err(refuse("measure", expected, measure.to_string()));
        }
        if measure.rotated.is_some() && !self.is_of_pairs() {
            return Err(refuse("measure", PAIRS, measure.to_string()));
        }
        let groups = self.scaled_together();
        let values = engine.map(groups.len(), |i| Ok(records::measured(groups[i], measure)))?;
        let values: Result<Vec<f64>, String> = values.into_iter().collect();
        values.map_err(|found| {
            let expected = format!("records that can be scaled to {measure}");
            refuse("measure", expected, found)
        })
    }

    /// Values of records alone and pairs, those of pairs on both components.
    fn on_each_record(&self, of_groups: &[f64]) -> Vec<f64> {
        let groups = self.scaled_together().into_iter().zip(of_groups);
        groups.flat_map(|(group, value)| vec![*value; group.len()]).collect()
    }

    /// Whether every record has both horizontal components.
    fn is_of_pairs(&self) -> bool {
        let in_plane = |record: &Record| record.motion.horizontal_y_m_per_s2().is_some();
        self.scaled_together().iter().all(|group| group.len() == 2 || in_plane(&group[0]))
    }

    /// The column `pair` with the name of each row's cluster; none where every record is alone.
    pub(super) fn pair_column(&self, of_rows: impl Iterator<Item = usize>) -> Option<Column> {
        let alone = self.clusters().iter().enumerate().all(|(i, first)| i == *first);
        let names = of_rows.map(|first| self.records[first].name.clone());
        (!alone).then(|| Column::texts("pair", names.collect()))
    }

    /// Names of the pairs, those of their first components, or of the motions that they were joined to.
    #[must_use]
    pub fn names_of_pairs(&self) -> Vec<String> {
        self.scaled_together().iter().map(|group| group[0].name.clone()).collect()
    }

    /// Records that are scaled by one factor: a pair, or a record alone.
    fn scaled_together(&self) -> Vec<&[Record]> {
        records::groups(&self.records)
    }

    /// The factor on each record, the same on both components of a pair.
    ///
    /// # Errors
    /// [`AssessmentError::Choice`] for a measure of pairs or a target spectrum where there are none, for a
    /// record or pair of which the measure is 0, and for periods beyond the spectrum; stopped.
    pub fn scaled(
        &self,
        scaling: &Scaling,
        engine: &Engine<'_>,
    ) -> Result<Scaled, AssessmentError> {
        let groups = self.scaled_together();
        let mut matched = None;
        let of_groups: Vec<f64> = match scaling {
            Scaling::Factor(factor) => vec![*factor; groups.len()],
            Scaling::Level(measure, level) => {
                let values = self.measure_of_groups(measure, engine)?;
                values.iter().map(|value| level / value).collect()
            }
            Scaling::Target(target, range_s) => {
                if !self.is_of_pairs() {
                    return Err(refuse("target", PAIRS, "records alone"));
                }
                let found = records::matched(&groups, target, *range_s, (engine, false))?;
                let found = found.map_err(|error| {
                    let expected = "pairs that can be brought to the spectrum over these periods";
                    refuse("periods", expected, error.to_string())
                })?;
                let factors = found.factors.clone();
                matched = Some(found);
                factors
            }
        };
        let factors = self.on_each_record(&of_groups);
        Ok(Scaled { factors, matched })
    }

    /// For each record the first one that shares its earthquake and station: the components of a pair, or
    /// records whose files say so. Their demands are not independent.
    #[must_use]
    pub fn clusters(&self) -> Vec<usize> {
        records::clusters(&self.records)
    }

    /// The name of a record's pair, that of its first component; empty where it is in none.
    #[must_use]
    pub fn pair_name(&self, record: usize) -> &str {
        records::pair_name(&self.records, &self.records[record])
    }

    /// Columns that say of what intensity each record is as it is run: `measure`, `measure_unit` and
    /// `level`, the peak acceleration where records are scaled by a factor; none for a made motion.
    pub(super) fn intensities(
        &self,
        scaling: &Scaling,
        factors: &[f64],
        of_runs: &[usize],
        engine: &Engine<'_>,
    ) -> Result<Table, AssessmentError> {
        let mut table = Table::default();
        if self.made {
            return Ok(table);
        }
        let (measure, levels) = match scaling {
            Scaling::Level(measure, level) => (*measure, vec![*level; self.records.len()]),
            Scaling::Factor(_) | Scaling::Target(..) => {
                let pga = LevelMeasure { measure: Measure::Pga, rotated: None };
                let of = |i: usize| Ok(pga.of(&self.records[i].motion, None).unwrap_or(f64::NAN));
                let values = engine.map(self.records.len(), of)?;
                let levels = values.iter().zip(factors).map(|(value, factor)| value * factor.abs());
                (pga, levels.collect())
            }
        };
        table
            .texts("measure", vec![measure.to_string(); of_runs.len()])
            .texts("measure_unit", vec![measure.unit().to_owned(); of_runs.len()])
            .numbers("level", measure.unit(), of_runs.iter().map(|&i| levels[i]).collect());
        Ok(table)
    }

    /// Runs on the records, most of them times these factors and with this tail; no factors where each run has
    /// its own.
    pub(super) fn runs<'a>(
        &'a self,
        factors: &[f64],
        tail_s: f64,
        engine: &'a Engine<'a>,
    ) -> Result<Runs<'a>, Stopped> {
        let records = if self.made { &[][..] } else { &self.records[..] };
        let motions: Vec<(usize, f64)> = factors.iter().copied().enumerate().collect();
        Runs::new(records, (&motions, tail_s), &|_, _, _| (), engine)
    }

    /// What messages call the runs of designs with bounds of friction, none where there is one.
    pub(super) fn in_words<'a>(
        &'a self,
        bounds: &'a [Bound],
        design: &'a dyn Fn(usize) -> String,
    ) -> InWords<'a> {
        InWords { records: &self.records, bounds, design }
    }

    /// A record times a factor, with a tail of free vibration.
    ///
    /// # Errors
    /// [`RunError`] for a factor or tail that cannot be.
    pub fn motion(&self, record: usize, scale: f64, tail_s: f64) -> Result<GroundMotion, RunError> {
        let origin = MotionOrigin { record, scale, source: None, turned_rad: None, tail_s };
        Ok(origin.finished(origin.bare(&self.records)?)?)
    }
}
