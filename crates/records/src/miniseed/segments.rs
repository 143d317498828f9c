//! Records of a file put together: those of one stream that follow one another are a segment.

use super::DataRecord;
use super::decode::samples;
use crate::bytes::Bytes;
use slipstick_dynamics::error::RecordError;
use slipstick_dynamics::notice::{Notice, NoticeKind};
use slipstick_dynamics::numerics::sort;

/// What a record's time may be off by its rounding, in s.
const CLOCK_S: f64 = 1e-9;

/// Samples at equal steps without a gap.
#[derive(Debug)]
pub(super) struct Segment {
    /// Network, station, location, channel.
    pub id: String,
    /// The same, with its number among the segments of the stream where there are more than one.
    pub name: String,
    /// Offset of its first record.
    pub offset: usize,
    /// Step in s.
    pub dt_s: f64,
    /// Samples as the file has them.
    pub values: Vec<f64>,
    /// What to know about it.
    pub warnings: Vec<Notice>,
}

/// A record with its samples.
struct Block {
    record: DataRecord,
    dt_s: f64,
    values: Vec<f64>,
}

impl Block {
    /// Time of the sample after its last, in ns since 1970.
    fn end_ns(&self) -> i64 {
        let length_ns = libm::round(self.values.len() as f64 * self.dt_s * 1e9);
        // A length past the range of times, which no record has, is cut to it.
        self.record.start_ns.saturating_add(length_ns as i64)
    }
}

/// Records by stream, streams in the order of the file.
#[derive(Default)]
pub(super) struct Streams {
    streams: Vec<(String, Vec<Block>)>,
    skipped: Vec<(String, &'static str)>,
}

impl Streams {
    /// Takes a record; one without samples at equal steps or in a coding that is not read is noted.
    ///
    /// # Errors
    /// Where its samples cannot be read.
    pub fn add(&mut self, bytes: &Bytes, record: DataRecord) -> Result<(), RecordError> {
        if record.count == 0 {
            return Ok(());
        }
        let Some(dt_s) = record.dt_s.filter(|_| record.encoding.is_read()) else {
            let skipped = (record.id, record.encoding.name());
            if !self.skipped.contains(&skipped) {
                self.skipped.push(skipped);
            }
            return Ok(());
        };
        let values = samples(bytes, &record)?;
        let at = self.streams.iter().position(|(id, _)| *id == record.id);
        let at = at.unwrap_or_else(|| {
            self.streams.push((record.id.clone(), vec![]));
            self.streams.len() - 1
        });
        self.streams[at].1.push(Block { record, dt_s, values });
        Ok(())
    }

    /// The segments, and a warning for each stream that was left out.
    pub fn finish(self) -> (Vec<Segment>, Vec<Notice>) {
        let mut segments = Vec::new();
        let skip = |what: &str, id: &str| {
            Notice::new(NoticeKind::ChannelSkipped, format!("{what} in {id}, left out"))
        };
        let mut skipped: Vec<_> = self.skipped.iter().map(|(id, what)| skip(what, id)).collect();
        for (id, blocks) in self.streams {
            for segment in joined(&id, blocks) {
                if segment.values.len() >= 2 {
                    segments.push(segment);
                } else {
                    skipped.push(skip("one sample only", &segment.name));
                }
            }
        }
        (segments, skipped)
    }
}

/// The segments of one stream.
fn joined(id: &str, mut blocks: Vec<Block>) -> Vec<Segment> {
    let sorted = blocks.is_sorted_by_key(|block| block.record.start_ns);
    sort(&mut blocks, |a, b| a.record.start_ns.cmp(&b.record.start_ns));
    let all = blocks.len();
    blocks.dedup_by(|later, kept| {
        let same_time = later.record.start_ns == kept.record.start_ns && later.dt_s == kept.dt_s;
        same_time && later.values == kept.values
    });
    let repeated = all - blocks.len();

    let mut segments: Vec<Segment> = Vec::new();
    let mut end_ns = 0;
    let mut drift = Drift::default();
    for block in blocks {
        let late_s = block.record.start_ns.saturating_sub(end_ns) as f64 / 1e9;
        let follows = segments.last().is_some_and(|segment| segment.dt_s == block.dt_s)
            && late_s.abs() <= 0.5 * block.dt_s + CLOCK_S;
        end_ns = block.end_ns();
        if !follows {
            if let Some(segment) = segments.last_mut() {
                drift.end(segment);
                segment.warnings.push(interruption(segment.values.len(), late_s, segment.dt_s));
            }
            drift = Drift { start_ns: block.record.start_ns, late_s: 0.0 };
            segments.push(Segment {
                id: id.to_owned(),
                name: id.to_owned(),
                offset: block.record.offset,
                dt_s: block.dt_s,
                values: vec![],
                warnings: vec![],
            });
        }
        if let Some(segment) = segments.last_mut() {
            drift.look(&block, segment.values.len());
            segment.values.extend_from_slice(&block.values);
            if block.record.clipped
                && segment.warnings.iter().all(|w| w.kind != NoticeKind::Clipped)
            {
                let at = block.record.offset;
                segment.warnings.push(Notice::new(
                    NoticeKind::Clipped,
                    format!("the record at byte {at} is marked as saturated or clipped"),
                ));
            }
        }
    }
    if let Some(segment) = segments.last_mut() {
        drift.end(segment);
    }
    finish(&mut segments, sorted, repeated);
    segments
}

/// Names and warnings of all segments of a stream.
fn finish(segments: &mut [Segment], sorted: bool, repeated: usize) {
    let count = segments.len();
    for (i, segment) in segments.iter_mut().enumerate() {
        let mut warn = |kind, message| segment.warnings.push(Notice::new(kind, message));
        if count > 1 {
            warn(NoticeKind::Gap, format!("segment {} of {count}: gaps are not bridged", i + 1));
            segment.name = format!("{} {}", segment.id, i + 1);
        }
        let mut warn = |kind, message| segment.warnings.push(Notice::new(kind, message));
        if !sorted {
            warn(
                NoticeKind::RecordsSorted,
                "the records were put in the order of their times".to_owned(),
            );
        }
        if repeated > 0 {
            let message = format!("{repeated} records that stand twice were taken once");
            warn(NoticeKind::DuplicateRecords, message);
        }
    }
}

/// What comes between a segment and the next.
fn interruption(count: usize, late_s: f64, dt_s: f64) -> Notice {
    if late_s.abs() <= 0.5 * dt_s + CLOCK_S {
        let message = format!("after its {count} samples the step changes");
        return Notice::new(NoticeKind::Gap, message);
    }
    let (kind, what) = if late_s > 0.0 {
        (NoticeKind::Gap, "a gap of")
    } else {
        (NoticeKind::Overlap, "an overlap of")
    };
    let message = format!("after its {count} samples {what} {:.6} s", late_s.abs());
    Notice::new(kind, message)
}

/// How far the times of records run away from equal steps within a segment.
#[derive(Default)]
struct Drift {
    start_ns: i64,
    late_s: f64,
}

impl Drift {
    fn look(&mut self, block: &Block, before: usize) {
        let passed_s = (block.record.start_ns - self.start_ns) as f64 / 1e9;
        let late_s = passed_s - before as f64 * block.dt_s;
        if late_s.abs() > self.late_s.abs() {
            self.late_s = late_s;
        }
    }

    fn end(&self, segment: &mut Segment) {
        if self.late_s.abs() > 0.5 * segment.dt_s {
            let message = format!(
                "the records' times run up to {:.6} s away from steps of {} s, which were taken",
                self.late_s, segment.dt_s
            );
            segment.warnings.push(Notice::new(NoticeKind::ClockDrift, message));
        }
    }
}
