//! Paths of keys, and the key that was probably meant.

use super::schema::{self, Section};
use super::tree::{Entry, TomlTable, Value};
use crate::error::edit_distance;

/// The entry of a name in a group of excluding keys: `key.*` is that key given as a table.
pub(super) fn matching<'a>(table: &'a TomlTable, name: &str) -> Option<&'a Entry> {
    match name.strip_suffix(".*") {
        None => table.get(name),
        Some(name) => table.get(name).filter(|entry| matches!(entry.node.value, Value::Table(_))),
    }
}

/// A path one key deeper.
pub(super) fn join(path: &str, key: &str) -> String {
    if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") }
}

/// The key that was probably meant.
pub(super) enum NearestKey {
    /// A key of the same section.
    Here(&'static str),
    /// The path of a key of the same name elsewhere in the text.
    Elsewhere(String),
}

/// A similar key of the section, else the same name elsewhere in the text, else whichever key of
/// the section is nearest. `root` describes the whole text.
pub(super) fn nearest_key(
    name: &str,
    section: &'static Section,
    root: &'static Section,
) -> Option<NearestKey> {
    let names = section.keys.iter().map(|key| key.name);
    let here = names.min_by_key(|known| edit_distance(name, known))?;
    if 2 * edit_distance(name, here) > here.len().max(2) {
        // `friction` means `static_friction` beside it rather than a key of that name elsewhere.
        let ends = |known: &str| known.strip_suffix(name).is_some_and(|start| start.ends_with('_'));
        if let Some(here) = section.keys.iter().map(|key| key.name).find(|known| ends(known)) {
            return Some(NearestKey::Here(here));
        }
        if let Some(path) = path_of(name, "", root) {
            return Some(NearestKey::Elsewhere(path));
        }
    }
    Some(NearestKey::Here(here))
}

/// Keys of a section that a name is the end of, where it is of several: `friction` is static or kinetic.
pub(super) fn several(name: &str, section: &'static Section) -> Option<String> {
    let ends = |known: &&str| known.strip_suffix(name).is_some_and(|start| start.ends_with('_'));
    let all: Vec<&str> = section.keys.iter().map(|key| key.name).filter(ends).collect();
    (all.len() > 1).then(|| all.join(" or "))
}

fn path_of(name: &str, path: &str, section: &'static Section) -> Option<String> {
    section.keys.iter().find_map(|key| {
        let path = join(path, key.name);
        if key.name == name {
            return Some(path);
        }
        let path = if matches!(key.kind, schema::Kind::Sections(..)) { path + ".1" } else { path };
        key.kind.section().and_then(|section| path_of(name, &path, section))
    })
}
