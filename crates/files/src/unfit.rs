//! Records that are not what they would be run as.

use std::path::Path;

use crate::error::FileError;
use crate::load::LoadedMotion;

/// Refuses vertical components where horizontal ones are run, and pairs that are none; gives a sentence
/// for each motion that stands there under two names. The components of pairs stand beside each other.
///
/// A channel that was asked for by name is the one that is wanted, whatever it is.
pub(crate) fn refuse_unfit(
    records: &[(&Path, &LoadedMotion)],
    channel_asked: bool,
    pairs: bool,
) -> Result<Vec<String>, FileError> {
    let unfit = |path: &Path, expected: &str, found: String| {
        Err(FileError::Unfit { path: path.to_owned(), expected: expected.to_owned(), found })
    };
    for (path, loaded) in records.iter().filter(|_| !channel_asked) {
        if let Some(reason) = loaded.origin.vertical(&name(path)) {
            let expected = "a horizontal component (a vertical one is given beside it, as the vertical motion)";
            return unfit(path, expected, format!("a vertical one: {reason}"));
        }
    }
    if pairs {
        for pair in records.chunks_exact(2) {
            let [(first, a), (second, b)] = [pair[0], pair[1]];
            let expected = format!("the other component of {}", first.display());
            if first == second || same(a, b) {
                return unfit(second, &expected, "the same motion".to_owned());
            }
            if let Some(found) = a.origin.apart(&b.origin, [&name(first), &name(second)]) {
                return unfit(second, &expected, format!("components {found}"));
            }
        }
    }
    let mut twice = Vec::new();
    for (i, (path, loaded)) in records.iter().enumerate() {
        let twin = records[..i].iter().find(|(other, known)| other != path && same(known, loaded));
        if let Some((other, _)) = twin {
            let message = format!(
                "{} and {} are the same motion: it counts twice",
                other.display(),
                path.display()
            );
            twice.push(message);
        }
    }
    Ok(twice)
}

fn name(path: &Path) -> String {
    path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}

fn same(a: &LoadedMotion, b: &LoadedMotion) -> bool {
    a.motion.horizontal_m_per_s2() == b.motion.horizontal_m_per_s2()
        && a.motion.times_s() == b.motion.times_s()
}
