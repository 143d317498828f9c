//! RENADIC, University of Chile: volume I with pairs of time and acceleration in s and g/10, three
//! channels, each ended by `/&`.

use super::csmip;
use super::fixed::Cursor;
use super::text::Text;
use super::volume::{Head, end_of_channel};
use super::{Format, Options, Record, RecordError};

/// Whether the text of a volume I names the network.
pub(super) fn recognises(text: &Text) -> bool {
    let mut lines = text.lines().take(13);
    csmip::recognises(text) && lines.any(|line| line.find("RENADIC", 0).is_some())
}

/// Reads the file; channels are named by their components.
pub(super) fn read(text: &Text, options: &Options) -> Result<Record, RecordError> {
    let mut cursor = Cursor::new(text);
    let mut channels = Vec::new();
    while let Some(head) = Head::read(&mut cursor)? {
        let names = csmip::names(&head, channels.len() + 1);
        let mut own = csmip::channel(&mut cursor, &head, &names, options)?;
        end_of_channel(&mut cursor, &mut own, true)?;
        channels.append(&mut own);
    }
    if channels.is_empty() {
        return Err(text.error_at_end("a channel", "the end of the file"));
    }
    let layout = "RENADIC V1".to_owned();
    Ok(Record { format: Format::Renadic, layout, channels, warnings: vec![] })
}
