//! USC and Caltech: volume I (`.m0a`), pairs of time and acceleration in g/10 where film was
//! digitised, unevenly spaced; volume II (`.s0a`), corrected acceleration, velocity and displacement.
//!
//! The first line or the second says `OF UNCORRECTED ACCELEROGRAM DATA OF VOLUME I`; columns 73 and
//! 74 of the lines of text hold their lengths.

use super::component::azimuth;
use super::csmip;
use super::fixed::Cursor;
use super::text::{Line, Text};
use super::volume::{Head, Names, end_of_channel};
use super::{Format, Options, Record, RecordError, quality};
use slipstick_dynamics::notice::{Notice, NoticeKind};

/// Where the text of a line ends and its length stands.
const TEXT_WIDTH: usize = 72;

/// Blocks of a component of volume II.
const VOLUME_TWO: usize = 3;

/// Whether one of the first two lines names the volume.
pub(super) fn recognises(text: &Text) -> bool {
    text.lines().take(2).any(|line| line.find("ACCELEROGRAM DATA OF VOL", 0).is_some())
}

/// Reads the file; its channels are named by their components.
pub(super) fn read(text: &Text, options: &Options) -> Result<Record, RecordError> {
    let mut cursor = Cursor::new(text);
    let mut channels = Vec::new();
    let mut corrected = false;
    let mut warnings = Vec::new();
    loop {
        if let Some(line) = (!channels.is_empty()).then(|| stray(&mut cursor)).flatten() {
            warnings.push(quality::last_line_of_words(line));
            break;
        }
        let Some(head) = Head::read(&mut cursor)? else { break };
        corrected = head.corrected;
        let head = Head { text: head.text.iter().map(cut).collect(), ..head };
        let names = names(&head, channels.len() + 1);
        let mut own = csmip::channel(&mut cursor, &head, &names, options)?;
        end_of_channel(&mut cursor, &mut own, false)?;
        if let (true, 1..VOLUME_TWO, Some(last)) = (corrected, own.len(), own.last_mut()) {
            let message = "the component has no velocity or no displacement, which a volume II has \
                           after its acceleration: the file may be cut";
            last.warnings.push(Notice::new(NoticeKind::Truncated, message));
        }
        channels.append(&mut own);
    }
    if channels.is_empty() {
        return Err(text.error_at_end("a channel", "the end of the file"));
    }
    let layout = if corrected { "USC/Caltech volume II" } else { "USC/Caltech volume I" };
    let layout = layout.to_owned();
    Ok(Record { format: Format::Usc, layout, channels, warnings })
}

/// The number of the last line where it is no head but words, such as what a terminal wrote after the numbers.
fn stray(cursor: &mut Cursor) -> Option<usize> {
    cursor.skip_blank();
    let line = cursor.peek()?;
    let mut rest = cursor.clone();
    rest.next("").ok()?;
    rest.skip_blank();
    let words =
        !line.bytes.iter().any(u8::is_ascii_digit) && line.find("ACCELEROGRAM", 0).is_none();
    (words && rest.peek().is_none()).then_some(line.number)
}

/// A line without the length of its text.
fn cut<'a>(line: &Line<'a>) -> Line<'a> {
    let (text, length) = line.bytes.split_at(line.bytes.len().min(TEXT_WIDTH));
    let is_length = length.trim_ascii().iter().all(u8::is_ascii_digit);
    Line { bytes: if is_length { text } else { line.bytes }, ..*line }
}

fn names(head: &Head, number: usize) -> Names {
    let first = usize::from(head.corrected);
    let component = head.after_key("COMP", b' ');
    Names {
        event: head.phrase(first + 1),
        station: head.phrase(first + 5),
        azimuth_deg: component.as_deref().and_then(azimuth),
        name: component.clone().unwrap_or_else(|| number.to_string()),
        component,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_last_line_of_words_is_no_head() {
        let of = |text: &str| stray(&mut Cursor::new(&Text::new("f", text.as_bytes()).unwrap()));
        assert_eq!(of("\n  VLEE $\n\n"), Some(2));
        for other in ["UNCORRECTED ACCELEROGRAM\n", "VLEE $\nmore\n", "  11.430  -.007\n"] {
            assert_eq!(of(other), None, "{other}");
        }
    }
}
