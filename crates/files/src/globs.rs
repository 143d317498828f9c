//! From what a person writes on a command line or in a plan to a sorted list of files.

use std::path::{Component, Path, PathBuf};

use crate::error::FileError;

/// Deepest nesting of folders that `**` or a folder descends.
const DEEPEST: usize = 32;

/// Files that `pattern` means, sorted by their path, each once.
///
/// - A name that exists is that file, whatever characters it has; a folder means the files in it
///   and in folders below, but for hidden ones.
/// - Else `*` stands for any characters of a name, `?` for one, `[abc]`, `[a-z]` and `[!a-z]` for
///   one of a set, `**` for any folders or none. A name that starts with a dot is met only by a
///   pattern that does.
///
/// A relative pattern is looked up from `base`. Both `/` and, where the name has none, `\`
/// separate folders.
///
/// # Errors
/// [`FileError::NoMatch`] where nothing is found, [`FileError::Read`] where a folder cannot be read.
pub fn expand(base: &Path, pattern: &str) -> Result<Vec<PathBuf>, FileError> {
    let whole = crate::read::resolve(base, pattern);
    let no_match = || FileError::NoMatch { pattern: whole.clone() };
    if whole.is_file() {
        return Ok(vec![whole]);
    }
    let mut found = Vec::new();
    if whole.is_dir() {
        entries(&whole)?;
        walk(whole.clone(), &["**".to_owned(), "*".to_owned()], 0, &mut found);
    } else if pattern.contains(['*', '?', '[']) {
        let (start, parts) = split(&whole);
        walk(start, &parts, 0, &mut found);
    }
    found.sort();
    found.dedup();
    if found.is_empty() { Err(no_match()) } else { Ok(found) }
}

/// [`expand`] of each, in the order given, each file once.
///
/// # Errors
/// As [`expand`], the first.
pub fn expand_all<S: AsRef<str>>(base: &Path, patterns: &[S]) -> Result<Vec<PathBuf>, FileError> {
    Ok(expand_once(base, patterns)?.0)
}

/// The same with the files that are named more than once.
///
/// # Errors
/// As [`expand`], the first.
pub(crate) fn expand_once<S: AsRef<str>>(
    base: &Path,
    patterns: &[S],
) -> Result<(Vec<PathBuf>, Vec<PathBuf>), FileError> {
    let (mut files, mut again) = (Vec::new(), Vec::new());
    let mut known = std::collections::HashSet::new();
    for pattern in patterns {
        for file in expand(base, pattern.as_ref())? {
            if known.insert(file.clone()) {
                files.push(file);
            } else if !again.contains(&file) {
                again.push(file);
            }
        }
    }
    Ok((files, again))
}

/// What is said of files that are named more than once; `None` where none is.
pub(crate) fn named_twice(again: &[PathBuf]) -> Option<String> {
    let first = again.first()?;
    let more = match again.len() - 1 {
        0 => String::new(),
        more => format!(" (and {more} more)"),
    };
    Some(format!("{} is named more than once: it is used once{more}", first.display()))
}

/// The folder before the first part that is a pattern, and the parts from there on.
fn split(whole: &Path) -> (PathBuf, Vec<String>) {
    let mut start = PathBuf::new();
    let mut parts = Vec::new();
    for component in whole.components() {
        let text = component.as_os_str().to_string_lossy();
        let is_name = matches!(component, Component::Normal(_));
        if parts.is_empty() && !(is_name && text.contains(['*', '?', '['])) {
            start.push(component);
        } else {
            parts.push(text.into_owned());
        }
    }
    (start, parts)
}

/// Entries of a folder, sorted, and whether each is a folder.
fn entries(folder: &Path) -> Result<Vec<(PathBuf, bool)>, FileError> {
    let here = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let failed = |source| FileError::Read { path: here.to_owned(), source };
    let mut found = Vec::new();
    for entry in std::fs::read_dir(here).map_err(failed)? {
        let path = folder.join(entry.map_err(failed)?.file_name());
        let is_folder = path.is_dir();
        found.push((path, is_folder));
    }
    found.sort();
    Ok(found)
}

/// Files below `folder` whose path fits the parts; folders that cannot be read have none.
fn walk(folder: PathBuf, parts: &[String], depth: usize, found: &mut Vec<PathBuf>) {
    let Some((part, rest)) = parts.split_first() else { return };
    if part == "**" {
        walk(folder.clone(), rest, depth, found);
        // A link to a folder is not followed: it may lead back.
        let below = entries(&folder).unwrap_or_default();
        for (path, is_folder) in below {
            if is_folder && !path.is_symlink() && !is_hidden(&path) && depth < DEEPEST {
                walk(path, parts, depth + 1, found);
            }
        }
        return;
    }
    if !part.contains(['*', '?', '[']) {
        let path = folder.join(part);
        if rest.is_empty() && path.is_file() {
            found.push(path);
        } else if !rest.is_empty() && path.is_dir() {
            walk(path, rest, depth, found);
        }
        return;
    }
    let pattern: Vec<char> = part.chars().collect();
    for (path, is_folder) in entries(&folder).unwrap_or_default() {
        let Some(name) = path.file_name().map(|name| name.to_string_lossy().into_owned()) else {
            continue;
        };
        let hidden = name.starts_with('.') && !part.starts_with('.');
        if hidden || !fits(&pattern, &name.chars().collect::<Vec<_>>()) {
            continue;
        }
        // Pipes and devices are no records: who opens one waits for its other end.
        if rest.is_empty() && path.is_file() {
            found.push(path);
        } else if !rest.is_empty() && is_folder {
            walk(path, rest, depth, found);
        }
    }
}

fn is_hidden(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'))
}

/// Whether a name fits a pattern of `*`, `?` and sets; time is at most the product of both lengths.
fn fits(pattern: &[char], name: &[char]) -> bool {
    let (mut p, mut n) = (0, 0);
    // Where the last star stands, and the first character it has not yet taken.
    let mut star: Option<(usize, usize)> = None;
    while n < name.len() {
        let one = match pattern.get(p) {
            Some('*') => {
                star = Some((p, n));
                p += 1;
                continue;
            }
            Some('?') => Some(p + 1),
            Some('[') => match set(&pattern[p..], name[n]) {
                Some((fits, length)) => fits.then_some(p + length),
                None => (name[n] == '[').then_some(p + 1),
            },
            Some(c) => (*c == name[n]).then_some(p + 1),
            None => None,
        };
        match (one, star) {
            (Some(next), _) => (p, n) = (next, n + 1),
            (None, Some((at, taken))) => {
                star = Some((at, taken + 1));
                (p, n) = (at + 1, taken + 1);
            }
            (None, None) => return false,
        }
    }
    pattern[p..].iter().all(|c| *c == '*')
}

/// Whether a character is in the set at the start of a pattern, and the set's length; `None` where
/// it has no end.
fn set(pattern: &[char], c: char) -> Option<(bool, usize)> {
    let negated = matches!(pattern.get(1), Some('!' | '^'));
    let first = 1 + usize::from(negated);
    // A bracket that stands first is one of the set.
    let end = first + 1 + pattern.get(first + 1..)?.iter().position(|c| *c == ']')?;
    let mut inside = false;
    let mut i = first;
    while i < end {
        if i + 2 < end && pattern[i + 1] == '-' {
            inside |= (pattern[i]..=pattern[i + 2]).contains(&c);
            i += 3;
        } else {
            inside |= pattern[i] == c;
            i += 1;
        }
    }
    Some((inside != negated, end + 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fitting(pattern: &str, name: &str) -> bool {
        fits(&pattern.chars().collect::<Vec<_>>(), &name.chars().collect::<Vec<_>>())
    }

    #[test]
    fn patterns_match_names() {
        for (pattern, name, expected) in [
            ("*.AT2", "RSN15.AT2", true),
            ("*.AT2", "RSN15.AT2.bak", false),
            ("*", "", true),
            ("a*b*c", "aXbYbZc", true),
            ("a*b*c", "aXbYbZ", false),
            ("?at", "cat", true),
            ("?at", "at", false),
            ("[a-c]1", "b1", true),
            ("[!a-c]1", "b1", false),
            ("[]x]", "]", true),
            ("[x", "[x", true),
            ("μ*", "μ_k", true),
            ("********b", "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa", false),
        ] {
            assert_eq!(fitting(pattern, name), expected, "{pattern} {name}");
        }
    }

    #[test]
    fn files_folders_and_globs() {
        let base = std::env::temp_dir().join(format!("slipstick-globs-{}", std::process::id()));
        let names =
            ["b.AT2", "a.AT2", "c.txt", ".hidden.AT2", "x[1].AT2", "in/d.AT2", "in/deep/e.AT2"];
        for name in names {
            let path = base.join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, "").unwrap();
        }
        let found = |pattern: &str| -> Vec<String> {
            let files = expand(&base, pattern).unwrap_or_default();
            let relative = |p: &PathBuf| p.strip_prefix(&base).unwrap().display().to_string();
            files.iter().map(relative).map(|p| p.replace('\\', "/")).collect()
        };
        assert_eq!(found("a.AT2"), ["a.AT2"]);
        assert_eq!(found("*.AT2"), ["a.AT2", "b.AT2", "x[1].AT2"]);
        assert_eq!(
            found("."),
            ["a.AT2", "b.AT2", "c.txt", "in/d.AT2", "in/deep/e.AT2", "x[1].AT2"]
        );
        assert_eq!(found("in"), ["in/d.AT2", "in/deep/e.AT2"]);
        assert_eq!(found("x[1].AT2"), ["x[1].AT2"]);
        assert_eq!(found("[ab].AT2"), ["a.AT2", "b.AT2"]);
        assert_eq!(found("*/d.AT2"), ["in/d.AT2"]);
        assert_eq!(found("in/**/*.AT2"), ["in/d.AT2", "in/deep/e.AT2"]);
        assert_eq!(found("**/e.AT2"), ["in/deep/e.AT2"]);
        assert_eq!(found(".*.AT2"), [".hidden.AT2"]);
        assert_eq!(found("*.SMC"), [""; 0]);
        let error = expand(&base, "*.SMC").unwrap_err().to_string();
        assert!(error.contains("*.SMC: expected a file, a folder or a pattern that meets files"));
        let twice = expand_all(&base, &["b.AT2", "*.AT2"]).unwrap();
        assert_eq!(twice.len(), 3);
        assert!(twice[0].ends_with("b.AT2"));
        std::fs::remove_dir_all(base).unwrap();
    }
}
