//! The order of the modules: each uses only those to its left, so that what is simple never depends
//! on what is not, and what judges never on what it judges.

// Helpers of tests may panic as tests do.
#![allow(clippy::expect_used)]

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// From left to right.
const ORDER: [&str; 20] = [
    "error",
    "hash",
    "progress",
    "notice",
    "units",
    "table",
    "numerics",
    "linear",
    "motion",
    "record",
    "slider",
    "model",
    "response",
    "check",
    "solver",
    "input",
    "study",
    "laboratory",
    "assessment",
    "requests",
];

/// Uses that the order would allow and the design does not: the judge shares no matrices with the
/// judged.
const FORBIDDEN: [(&str, &str); 1] = [("check", "linear")];

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder of sources") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
}

/// The text without comments, which may name anything.
fn code(text: &str) -> String {
    let line = |line: &str| {
        let end = line.find("//").unwrap_or(line.len());
        line[..end].to_owned()
    };
    text.lines().map(line).collect::<Vec<_>>().join("\n")
}

fn word(text: &str) -> &str {
    let end = text.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(text.len());
    &text[..end]
}

/// Top-level names in a list in braces that starts at `text`.
fn listed(text: &str) -> Vec<&str> {
    let mut depth = 0;
    let mut names = Vec::new();
    let mut expected = true;
    for (i, c) in text.char_indices() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 1 => expected = true,
            c if expected && depth == 1 && !c.is_whitespace() => {
                names.push(word(&text[i..]));
                expected = false;
            }
            _ => {}
        }
        if depth == 0 {
            break;
        }
    }
    names
}

/// Modules that a source names from the root of the crate, by `crate::` or enough `super::`.
fn used(code: &str, depth: usize) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    let root = "super::".repeat(depth);
    for start in ["crate::", root.as_str()] {
        for (i, _) in code.match_indices(start) {
            let rest = &code[i + start.len()..];
            let found = if rest.starts_with('{') { listed(rest) } else { vec![word(rest)] };
            names.extend(found.into_iter().map(str::to_owned));
        }
    }
    names
}

#[test]
fn every_module_uses_only_those_to_its_left() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    sources(&root, &mut files);
    let place = |name: &str| ORDER.iter().position(|m| *m == name);
    let mut wrong = Vec::new();
    let mut uses = 0;
    for file in &files {
        let inside = file.strip_prefix(&root).expect("a path below the root");
        let parts: Vec<String> =
            inside.with_extension("").iter().map(|p| p.to_string_lossy().into_owned()).collect();
        if parts == ["lib"] {
            continue;
        }
        let module = parts[0].as_str();
        let depth = parts.iter().filter(|p| *p != "mod").count();
        let Some(own) = place(module) else {
            wrong.push(format!("{}: {module} has no place in the order", inside.display()));
            continue;
        };
        let text = std::fs::read_to_string(file).expect("a source");
        for name in used(&code(&text), depth) {
            let Some(other) = place(&name) else { continue };
            uses += usize::from(other != own);
            let forbidden = FORBIDDEN.contains(&(module, name.as_str()));
            if other > own || forbidden {
                wrong.push(format!("{}: {module} may not use {name}", inside.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(uses > 20, "only {uses} uses between modules found: the sources are read wrongly");
}

/// What the kinds of sliders are called, and how one is told from another.
const LAWS: [&str; 12] = [
    "Bearing",
    "Restoring",
    "Ends",
    "StopKind",
    "Friction",
    "RateLaw",
    "RateCurve",
    "friction()",
    "rate()",
    "slider().series()",
    "radius_m()",
    "stop()",
];

#[test]
fn the_solver_knows_no_law() {
    let mut files = Vec::new();
    sources(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src/solver"), &mut files);
    let mut wrong = Vec::new();
    for file in &files {
        let text = std::fs::read_to_string(file).expect("a source");
        // Tests may build a model.
        let solver = code(text.split("#[cfg(test)]").next().unwrap_or_default());
        let is_word = |i: usize| !solver[..i].ends_with(|c: char| c.is_alphanumeric() || c == '_');
        for law in LAWS {
            let named = solver
                .match_indices(law)
                .any(|(i, _)| is_word(i) && (law.ends_with(')') || word(&solver[i..]) == law));
            if named {
                wrong.push(format!("{}: {law}", file.display()));
            }
        }
    }
    assert!(files.len() > 30 && wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_module_of_the_crate_has_a_place() {
    let text = include_str!("../src/lib.rs");
    let declared = text.lines().filter_map(|line| {
        let line = line.trim();
        line.strip_prefix("pub ").unwrap_or(line).strip_prefix("mod ").map(word)
    });
    let unplaced: Vec<&str> = declared.filter(|m| !ORDER.contains(m)).collect();
    assert!(unplaced.is_empty(), "modules without a place in the order: {unplaced:?}");
}

#[test]
fn uses_are_found_in_every_form() {
    let text = "use crate::model::Model; // crate::input\nuse crate::{linear::x, units};\n\
                let y = super::super::solver::exact; super::local::z();";
    let names: Vec<String> = used(&code(text), 2).into_iter().collect();
    assert_eq!(names, ["linear", "model", "solver", "units"]);
}
