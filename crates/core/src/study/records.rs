//! Recorded motions, alone or the two horizontal components of a pair beside each other: how pairs are found,
//! joined, measured and brought to a spectrum.

use super::engine::Engine;
use crate::error::{MotionError, Stopped};
use crate::input::loaded::Loaded;
use crate::motion::GroundMotion;
use crate::motion::intensity::LevelMeasure;
use crate::motion::target::{Matched, TargetSpectrum, matching_periods, maximum_direction_of_pair};
use crate::notice::{Notice, NoticeKind};
use crate::record::Origin;

/// A recorded motion of a study or a suite.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// What rows and tables call it.
    pub name: String,
    /// The channel that was used.
    pub channel: String,
    /// The motion as it was recorded, unscaled, with its vertical component.
    pub motion: GroundMotion,
    /// Number of the pair of horizontal components that it is one of; the two stand beside each other.
    pub pair: Option<usize>,
    /// What its file says of where it was recorded.
    pub origin: Origin,
    /// What reading it gave notice of.
    pub notices: Vec<Notice>,
}

impl Record {
    /// A motion of which nothing else is known.
    #[must_use]
    pub fn new(name: impl Into<String>, motion: GroundMotion) -> Self {
        let (name, channel, origin) = (name.into(), String::new(), Origin::default());
        Self { name, channel, motion, pair: None, origin, notices: Vec::new() }
    }

    /// A motion that was read, alone or as a component of a pair.
    #[must_use]
    pub fn read(name: String, loaded: Loaded, pair: Option<usize>) -> Self {
        let Loaded { motion, channel, origin, warnings: notices, .. } = loaded;
        Self { name, channel, motion, pair, origin, notices }
    }
}

/// Records that take one factor: a pair, or a record alone.
pub(crate) fn groups(records: &[Record]) -> Vec<&[Record]> {
    records.chunk_by(|a, b| a.pair.is_some() && a.pair == b.pair).collect()
}

/// Whether there are pairs, each component by itself.
pub(crate) fn has_pairs(records: &[Record]) -> bool {
    records.iter().any(|record| record.pair.is_some())
}

/// Whether a record moves the table in two horizontal directions.
pub(crate) fn in_plane(records: &[Record]) -> bool {
    records.iter().any(|record| record.motion.horizontal_y_m_per_s2().is_some())
}

/// For each record the first one that shares its earthquake and station: the components of a pair, or records whose
/// files say so. Their demands are not independent.
pub(crate) fn clusters(records: &[Record]) -> Vec<usize> {
    let together = |a: &Record, b: &Record| match (a.pair, b.pair) {
        (Some(a), Some(b)) => a == b,
        _ => a.origin.is_with(&b.origin),
    };
    let first = |i: usize| (0..i).find(|&j| together(&records[j], &records[i])).unwrap_or(i);
    (0..records.len()).map(first).collect()
}

/// The name of a record's pair, that of its first component; empty where it is in none.
pub(crate) fn pair_name<'r>(records: &'r [Record], record: &Record) -> &'r str {
    let first = records.iter().find(|first| record.pair.is_some() && first.pair == record.pair);
    first.map_or("", |first| &first.name)
}

/// Each pair as one motion in two horizontal directions under a name made of both, its first component along x,
/// its second along y, with the vertical component of the first.
///
/// # Errors
/// [`MotionError`] where the union of their times has too many samples.
pub(crate) fn together(
    records: &[Record],
    name: impl Fn(&str, &str) -> String,
) -> Result<Vec<Record>, MotionError> {
    let join = |group: &[Record]| match group {
        [x, y] => {
            let (motion, lengths_differ) = x.motion.with_along_y(&y.motion)?;
            let mut notices = x.notices.clone();
            notices.extend(y.notices.iter().filter(|n| !x.notices.contains(n)).cloned());
            notices.extend(lengths_differ.then(|| {
                let message = "the components along x and along y differ in length: the shorter is zero \
                               after its end";
                Notice::new(NoticeKind::LengthsDiffer, message.to_owned())
            }));
            let origin = x.origin.clone().with_along_y(y.origin.clone());
            let (name, channel) = (name(&x.name, &y.name), x.channel.clone());
            Ok(Record { name, channel, motion, pair: None, origin, notices })
        }
        _ => Ok(group[0].clone()),
    };
    groups(records).into_iter().map(join).collect()
}

/// Each motion in two horizontal directions as the pair of its components, called by their axes, both with the
/// vertical component.
pub(crate) fn apart(records: &[Record]) -> Vec<Record> {
    let split = |(number, record): (usize, &Record)| {
        let Record { name, motion, origin, .. } = record;
        if motion.horizontal_y_m_per_s2().is_none() {
            return vec![record.clone()];
        }
        let along_y = origin.along_y.as_deref().cloned().unwrap_or_default();
        let along_x = Origin { along_y: None, ..origin.clone() };
        let of = |(axis, motion, origin)| {
            let (name, pair) = (format!("{name} {axis}"), Some(number));
            Record { name, motion, origin, pair, ..record.clone() }
        };
        [("x", motion.along_x(), along_x), ("y", motion.along_y(), along_y)].map(of).into()
    };
    records.iter().enumerate().flat_map(split).collect()
}

/// The measure of a record alone, or of a pair; else what was found instead of records that can be scaled to it.
pub(crate) fn measured(group: &[Record], measure: &LevelMeasure) -> Result<f64, String> {
    let [first, rest @ ..] = group else { return Err("no record".to_owned()) };
    let other = rest.first().map(|other| &other.motion);
    let value = measure.of(&first.motion, other).unwrap_or(f64::NAN);
    if value.is_finite() && value > 0.0 {
        return Ok(value);
    }
    Err(format!("{measure} = {value} of {}", first.name))
}

/// Pairs brought to a spectrum between two periods in s; of each the engine is told, where it counts them.
pub(crate) fn matched(
    groups: &[&[Record]],
    target: &TargetSpectrum,
    range_s: [f64; 2],
    (engine, counted): (&Engine<'_>, bool),
) -> Result<Result<Matched, MotionError>, Stopped> {
    let periods_s = matching_periods(range_s);
    let spectrum = |i: usize| {
        let other = groups[i].get(1).map(|other| &other.motion);
        maximum_direction_of_pair(&groups[i][0].motion, other, &periods_s)
    };
    let spectra = match counted {
        true => engine.runs(groups.len(), spectrum)?,
        false => engine.map(groups.len(), |i| Ok(spectrum(i)))?,
    };
    let spectra: Result<Vec<Vec<f64>>, MotionError> = spectra.into_iter().collect();
    Ok(spectra.and_then(|spectra| Matched::new(target, periods_s, &spectra)))
}
