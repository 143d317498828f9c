//! Signs that a measured history is in another unit, of the other sign or on another clock.

use super::Compared;
use crate::input::Channel;
use crate::laboratory::measured::Measured;
use crate::laboratory::metrics::{peak, rms_error};
use crate::notice::{Notice, NoticeKind};
use crate::units::{Dimension, STANDARD_GRAVITY_M_PER_S2};

/// How near a ratio must be to that of two units.
const NEAR: f64 = 0.08;

/// What looks like a wrong unit, sign or clock. Nothing is put right: the mapping has to say it.
///
/// - A unit: peaks of two measured accelerations, or a measured and a predicted history of like
///   shape (correlation above 0.8 in size), in the ratio of two units (9.80665, 1000, 100, 25.4, …)
///   to 8 %.
/// - A sign: a correlation below −0.5, or one that is negative and the larger with the other sign.
/// - A clock: a correlation that a shift raises by 0.05 or more, to above 0.8.
#[must_use]
pub fn suspicions(measured: &Measured, compared: &[Compared]) -> Vec<Notice> {
    let mut warnings = accelerations(measured);
    for Compared { pair, metrics } in compared {
        let name = pair.channel.name();
        let correlation = metrics.correlation.unwrap_or(0.0);
        let opposite: Vec<f64> = pair.measured.iter().map(|m| -m).collect();
        let flipped = rms_error(&opposite, &pair.predicted);
        let wrong_sign =
            correlation < -0.5 || (correlation < -0.2 && flipped < 0.7 * metrics.rms_error);
        if wrong_sign {
            warnings.push(Notice::new(
                NoticeKind::SignSuspect,
                format!(
                    "the measured {name} runs against the prediction (correlation \
                     {correlation:.2}): if its sensor points the other way, say so with \
                     the mapping \"{name}=… * -1\""
                ),
            ));
        }
        let ratio = metrics.peak_ratio.filter(|_| correlation.abs() > 0.8);
        if let Some((words, factor)) =
            ratio.and_then(|ratio| unit_ratio(ratio, pair.channel.dimension()))
        {
            warnings.push(Notice::new(
                NoticeKind::UnitSuspect,
                format!(
                    "the prediction of {name} is {:.3} times the measured one, as {words} would \
                     make it ({factor}): check the unit of {}",
                    ratio.unwrap_or(0.0),
                    pair.origin
                ),
            ));
        }
        let better = metrics.lagged_correlation.unwrap_or(0.0);
        let lag_s = metrics.arrival_lag_s.unwrap_or(0.0);
        if !wrong_sign && better > 0.8 && better > correlation + 0.05 {
            warnings.push(Notice::new(
                NoticeKind::ClockSuspect,
                format!(
                    "the measured {name} comes {lag_s:+.4} s after the prediction (correlation \
                     {correlation:.2}, {better:.2} with that shift): if its clock is wrong, say so \
                     with the mapping \"{name}=… @ {:.4} s\"",
                    -lag_s
                ),
            ));
        }
    }
    warnings
}

/// Measured accelerations whose peaks stand in the ratio of g to m/s².
fn accelerations(measured: &Measured) -> Vec<Notice> {
    let peaks: Vec<(Channel, f64)> = measured
        .series
        .iter()
        .filter(|series| series.channel.dimension() == Dimension::Acceleration)
        .map(|series| (series.channel, peak(&series.values).0))
        .collect();
    let Some((table, at_table)) =
        peaks.iter().find(|(channel, _)| *channel == Channel::TableAcceleration)
    else {
        return vec![];
    };
    let suspect = |(channel, peak): &(Channel, f64)| {
        let ratio = peak / at_table;
        let near = [STANDARD_GRAVITY_M_PER_S2, 1.0 / STANDARD_GRAVITY_M_PER_S2]
            .into_iter()
            .any(|factor| (ratio / factor - 1.0).abs() < NEAR);
        (channel != table && near).then(|| {
            let message = format!(
                "the peak of {} is {ratio:.3} times that of {}: if one of them is in g and the \
                     other in m/s², say so in the mapping",
                channel.name(),
                table.name()
            );
            Notice::new(NoticeKind::UnitSuspect, message)
        })
    };
    peaks.iter().filter_map(suspect).collect()
}

/// The confusion of units that a ratio looks like.
fn unit_ratio(ratio: f64, dimension: Dimension) -> Option<(&'static str, f64)> {
    let known: &[(&str, f64)] = match dimension {
        Dimension::Acceleration => &[
            ("g taken for m/s²", STANDARD_GRAVITY_M_PER_S2),
            ("cm/s² and m/s²", 100.0),
            ("mm/s² and m/s²", 1000.0),
            ("gal and g", 980.665),
        ],
        Dimension::Length => &[
            ("mm and m", 1000.0),
            ("cm and m", 100.0),
            ("mm and cm", 10.0),
            ("in and mm", 25.4),
            ("in and m", 39.37),
        ],
        _ => &[("kN and N", 1000.0), ("kip and N", 4448.22), ("lbf and N", 4.44822)],
    };
    let near = |factor: f64| (ratio / factor - 1.0).abs() < NEAR;
    known.iter().copied().find(|(_, factor)| near(*factor) || near(1.0 / factor))
}
