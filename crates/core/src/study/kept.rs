//! Answers of runs that are kept while an analysis goes on: one that was interrupted goes on with them.
//!
//! Runs in two directions take milliseconds, and an analysis of some ten thousand of them takes a minute. An answer is
//! kept under the hash of all that it follows from, so that it serves any analysis that makes the same run.

use core::fmt::Write as _;

use super::cases::Noticed;
use super::records::Record;
use crate::hash::{sha256_hex, sha256_of_motion};
use crate::input::Parts;
use crate::model::Model;
use crate::notice::NoticeKind;

/// Where answers are kept, as lines of text by their keys.
pub trait KeptRuns: Sync {
    /// What was kept under a key.
    fn find(&self, key: &str) -> Option<String>;

    /// Keeps a line without an end under a key.
    fn keep(&self, key: &str, line: &str);
}

/// What analyses keep of a response, as numbers.
pub(crate) trait InNumbers: Sized {
    /// The numbers; `None` of what is not kept.
    fn numbers(&self) -> Option<Vec<f64>>;

    /// What such numbers say.
    fn of(numbers: Vec<f64>) -> Option<Self>;
}

impl InNumbers for Vec<f64> {
    fn numbers(&self) -> Option<Vec<f64>> {
        Some(self.clone())
    }

    fn of(numbers: Vec<f64>) -> Option<Self> {
        Some(numbers)
    }
}

impl InNumbers for f64 {
    fn numbers(&self) -> Option<Vec<f64>> {
        Some(vec![*self])
    }

    fn of(numbers: Vec<f64>) -> Option<Self> {
        <[f64; 1]>::try_from(numbers).ok().map(|[number]| number)
    }
}

/// The key of a run: the hash of model and tail, of the record and of the factor on it.
pub(crate) fn key(of_design: &str, of_record: &str, scale: f64) -> String {
    sha256_hex(format!("{of_design} {of_record} {:016x}", scale.to_bits()).as_bytes())
}

/// The hash of a design.
pub(crate) fn hash_of_design(parts: &Parts) -> String {
    hash_of_model(&parts.model, parts.tail_s)
}

/// The hash of a model and of the free vibration after its motions, in s.
pub(crate) fn hash_of_model(model: &Model, tail_s: f64) -> String {
    sha256_hex(format!("{} {model:?} {tail_s:?}", env!("CARGO_PKG_VERSION")).as_bytes())
}

/// The hash of a record's motion, which is run in two directions; `None` of others.
pub(crate) fn hash_of_record(record: &Record) -> Option<String> {
    record.motion.horizontal_y_m_per_s2()?;
    Some(sha256_of_motion(&record.motion))
}

/// An answer and what was noticed of it as a line: kinds of notices, `!` before the severe ones, then the bits of
/// the numbers.
pub(crate) fn line<R: InNumbers>(answer: &R, noticed: &[Noticed]) -> Option<String> {
    let numbers = answer.numbers()?;
    let mut line = String::with_capacity(16 + 17 * numbers.len());
    for Noticed { kind, is_severe } in noticed {
        let _ = write!(line, "{}{},", if *is_severe { "!" } else { "" }, kind.name());
    }
    line.push(' ');
    line.push_str(&bits(&numbers));
    Some(line)
}

/// The bits of numbers.
pub(crate) fn bits(numbers: &[f64]) -> String {
    let words: Vec<String> = numbers.iter().map(|x| format!("{:016x}", x.to_bits())).collect();
    words.join(" ")
}

/// The numbers of such bits; `None` of any other text.
pub(crate) fn of_bits(text: &str) -> Option<Vec<f64>> {
    let whole = |word: &str| (word.len() == 16).then(|| u64::from_str_radix(word, 16).ok());
    let bits = text.split_terminator(' ').map(|word| whole(word).flatten());
    bits.map(|bits| bits.map(f64::from_bits)).collect()
}

/// The kind of a notice by its name.
pub(crate) fn kind_of(name: &str) -> Option<NoticeKind> {
    NoticeKind::ALL.iter().copied().find(|kind| kind.name() == name)
}

/// What such a line says; `None` of any other text.
pub(crate) fn read<R: InNumbers>(line: &str) -> Option<(R, Vec<Noticed>)> {
    let (kinds, numbers) = line.split_once(' ')?;
    let noticed = kinds.split_terminator(',').map(|word| {
        let (is_severe, name) = match word.strip_prefix('!') {
            Some(name) => (true, name),
            None => (false, word),
        };
        Some(Noticed { kind: kind_of(name)?, is_severe })
    });
    Some((R::of(of_bits(numbers)?)?, noticed.collect::<Option<Vec<Noticed>>>()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_gives_back_what_was_kept() {
        let answer = vec![0.1 + 0.2, f64::NAN, -0.0, 1e-310];
        let noticed = [
            Noticed { kind: NoticeKind::FlatGeometry, is_severe: true },
            Noticed { kind: NoticeKind::GapExceeded, is_severe: false },
        ];
        for noticed in [&noticed[..], &[]] {
            let line = line(&answer, noticed).expect("a line");
            let (found, of_found): (Vec<f64>, _) = read(&line).expect("an answer");
            let bits = |list: &[f64]| list.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
            assert_eq!((bits(&found), &of_found[..]), (bits(&answer), noticed));
            // Another number of numbers is another answer.
            assert!(read::<f64>(&line).is_none());
        }
        for wrong in ["", "gap_exceeded,", "no_such_kind, 3ff0000000000000", " 3ff000000000000x"] {
            assert!(read::<f64>(wrong).is_none(), "{wrong:?}");
        }
    }
}
