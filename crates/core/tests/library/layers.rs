//! The order of the modules: each uses only those to its left, so that what is simple never depends
//! on what is not, and what judges never on what it judges.

// Helpers of tests may panic as tests do.
#![allow(clippy::expect_used)]

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// The modules of each crate from left to right; that a crate uses no other to its right is what cargo holds.
const ORDERS: [(&str, &[&str]); 2] = [
    (
        "dynamics",
        &[
            "error", "progress", "notice", "units", "table", "numerics", "linear", "motion",
            "slider", "model", "response", "check", "solver",
        ],
    ),
    ("core", &["hash", "input", "study", "laboratory", "assessment", "requests"]),
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

/// The folder of sources of a crate.
fn folder_of(of_crate: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(of_crate).join("src")
}

/// Adds what is wrong with the modules of a crate; the number of uses between them.
fn uses_against(of_crate: &str, order: &[&str], wrong: &mut Vec<String>) -> usize {
    let root = folder_of(of_crate);
    let mut files = Vec::new();
    sources(&root, &mut files);
    let place = |name: &str| order.iter().position(|m| *m == name);
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
    uses
}

#[test]
fn every_module_uses_only_those_to_its_left() {
    let mut wrong = Vec::new();
    let uses = ORDERS.map(|(of_crate, order)| uses_against(of_crate, order, &mut wrong));
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(
        uses.iter().all(|uses| *uses > 10),
        "{uses:?} uses found: the sources are read wrongly"
    );
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

/// What names laws: where they are, the judge that has its own, and what builds them.
const NAMES_LAWS: [&str; 5] = ["slider", "check", "model", "input", "laboratory"];

#[test]
fn what_is_computed_knows_no_law() {
    let all = ["dynamics", "core"].map(Sources::read);
    let mut wrong = Vec::new();
    let others = all
        .iter()
        .flat_map(|sources| &sources.0)
        .filter(|(path, _)| !NAMES_LAWS.contains(&path[0].as_str()));
    for (path, code) in others.clone() {
        // A text may begin with such a word.
        let is_word =
            |i: usize| !code[..i].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == '"');
        for law in LAWS {
            let named = code
                .match_indices(law)
                .any(|(i, _)| is_word(i) && (law.ends_with(')') || word(&code[i..]) == law));
            if named {
                wrong.push(format!("{path:?}: {law}"));
            }
        }
    }
    assert!(others.count() > 60 && wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Modules inside which no circle of arrows may pass through more than two of their parts.
const WITHOUT_CIRCLES: [&str; 4] = ["check", "linear", "slider", "solver"];

/// The sources of a crate: each module by its path, with its code but for tests.
struct Sources(BTreeMap<Vec<String>, String>);

impl Sources {
    /// Of the folder of sources of a crate beside this one.
    fn read(of_crate: &str) -> Self {
        let root = folder_of(of_crate);
        let mut files = Vec::new();
        sources(&root, &mut files);
        let module = |file: &PathBuf| {
            let inside = file.strip_prefix(&root).expect("a path below the root");
            let parts = inside.with_extension("");
            let parts: Vec<String> =
                parts.iter().map(|p| p.to_string_lossy().into_owned()).collect();
            let text = std::fs::read_to_string(file).expect("a source");
            let own = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
            (!parts.iter().any(|part| part == "tests" || part == "lib")).then(|| (parts, code(own)))
        };
        Self(files.iter().filter_map(module).collect())
    }

    fn is_module(&self, path: &[String]) -> bool {
        self.0.contains_key(path)
    }

    /// The module whose item a path names, seen from a module; what that only passes on is the item of the
    /// module that has it. None for what is not of this crate.
    fn home(&self, from: &[String], path: &[String]) -> Option<Vec<String>> {
        let mut at = from.to_vec();
        let mut rest = path;
        match path.first()?.as_str() {
            "crate" => (at, rest) = (Vec::new(), &path[1..]),
            "self" | "super" => {
                while let Some(first) = rest.first().filter(|p| *p == "self" || *p == "super") {
                    if first == "super" {
                        at.pop()?;
                    }
                    rest = &rest[1..];
                }
            }
            first => {
                let inside: Vec<String> = at.iter().cloned().chain([first.to_owned()]).collect();
                self.is_module(&inside).then_some(())?;
            }
        }
        while let Some((first, further)) = rest.split_first() {
            let inside: Vec<String> = at.iter().cloned().chain([first.clone()]).collect();
            if !self.is_module(&inside) {
                let passed = self.0.get(&at).and_then(|code| {
                    let mut passed = code.match_indices("pub").filter_map(|(i, _)| {
                        let rest = code[i + 3..].trim_start();
                        let rest = match rest.strip_prefix('(') {
                            Some(rest) => rest.split_once(')')?.1.trim_start(),
                            None => rest,
                        };
                        let tree = rest.strip_prefix("use ")?.split(';').next()?;
                        paths(tree).into_iter().find(|path| path.last() == Some(first))
                    });
                    passed.next()
                });
                return match passed {
                    Some(passed) => self.home(&at, &passed),
                    None => Some(at),
                };
            }
            (at, rest) = (inside, further);
        }
        Some(at)
    }

    /// Which parts of a module name which others.
    fn arrows(&self, module: &[String]) -> BTreeMap<String, BTreeSet<String>> {
        let part = |path: &[String]| {
            path.starts_with(module).then(|| path.get(module.len()).cloned()).flatten()
        };
        let mut arrows: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        for (path, code) in &self.0 {
            let Some(own) = part(path) else { continue };
            let homes = paths(code).into_iter().filter_map(|named| self.home(path, &named));
            let others = homes.filter_map(|home| part(&home)).filter(|other| *other != own);
            arrows.entry(own.clone()).or_default().extend(others);
        }
        arrows
    }
}

/// Paths of two names at least in a code, those in braces one by one.
fn paths(code: &str) -> Vec<Vec<String>> {
    let mut found = Vec::new();
    let mut open: Vec<Vec<String>> = Vec::new();
    let mut rest = code;
    while let Some(first) = rest.chars().next() {
        if !(first.is_alphabetic() || first == '_') {
            match first {
                '{' => open.push(Vec::new()),
                '}' => drop(open.pop()),
                _ => {}
            }
            rest = &rest[first.len_utf8()..];
            continue;
        }
        let mut path = open.last().cloned().unwrap_or_default();
        let is_listed = !path.is_empty();
        loop {
            let name = word(rest);
            path.push(name.to_owned());
            rest = &rest[name.len()..];
            let Some(further) = rest.strip_prefix("::") else { break };
            if let Some(list) = further.strip_prefix('{') {
                open.push(core::mem::take(&mut path));
                rest = list;
                break;
            }
            rest = further;
            if !rest.starts_with(|c: char| c.is_alphabetic() || c == '_') {
                break;
            }
        }
        if is_listed && path.last().is_some_and(|name| name == "self") {
            path.pop();
        }
        if path.len() > 1 {
            found.push(path);
        }
    }
    found
}

/// Names to which a name leads.
fn reached<'a>(arrows: &'a BTreeMap<String, BTreeSet<String>>, from: &'a str) -> BTreeSet<&'a str> {
    let mut all = BTreeSet::new();
    let mut next = vec![from];
    while let Some(name) = next.pop() {
        let further = arrows.get(name).into_iter().flatten().map(String::as_str);
        next.extend(further.filter(|name| all.insert(*name)));
    }
    all
}

/// Sets of more than two names each of which leads to all others.
fn circles(arrows: &BTreeMap<String, BTreeSet<String>>) -> BTreeSet<BTreeSet<&str>> {
    let reach: BTreeMap<&str, BTreeSet<&str>> =
        arrows.keys().map(|name| (name.as_str(), reached(arrows, name))).collect();
    let circle = |name: &str| -> BTreeSet<&str> {
        let both = |other: &&&str| reach.get(**other).is_some_and(|back| back.contains(name));
        reach[name].iter().filter(both).copied().collect()
    };
    arrows.keys().map(|name| circle(name)).filter(|circle| circle.len() > 2).collect()
}

/// Siblings may use each other in one direction, two of them in both; a module and what is inside it make one
/// thing.
#[test]
fn inside_a_module_no_circle_passes_through_more_than_two() {
    let [dynamics, cli] = ["dynamics", "cli"].map(Sources::read);
    let mut wrong = Vec::new();
    let mut drawn = 0;
    let mut draw = |sources: &Sources, module: &[String]| {
        let arrows = sources.arrows(module);
        drawn += arrows.values().map(BTreeSet::len).sum::<usize>();
        wrong.extend(circles(&arrows).iter().map(|circle| format!("{module:?}: {circle:?}")));
    };
    let of_dynamics = dynamics.0.keys().filter(|path| WITHOUT_CIRCLES.contains(&path[0].as_str()));
    of_dynamics.for_each(|module| draw(&dynamics, module));
    draw(&cli, &[]);
    cli.0.keys().for_each(|module| draw(&cli, module));
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(drawn > 60, "only {drawn} arrows found: the sources are read wrongly");
}

#[test]
fn circles_are_found() {
    let of = |pairs: &[(&str, &str)]| {
        let mut arrows: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
        for (from, to) in pairs {
            arrows.entry((*from).to_owned()).or_default().insert((*to).to_owned());
            arrows.entry((*to).to_owned()).or_default();
        }
        circles(&arrows).len()
    };
    assert_eq!(of(&[("a", "b"), ("b", "a"), ("b", "c")]), 0);
    assert_eq!(of(&[("a", "b"), ("b", "c"), ("c", "a"), ("c", "d")]), 1);
    let named = paths("use super::{a::{self, B}, c::D}; fn f() { e::g::<H>(x) }");
    assert_eq!(
        named.iter().map(|path| path.join("::")).collect::<Vec<_>>(),
        ["super::a", "super::a::B", "super::c::D", "e::g"]
    );
}

#[test]
fn every_module_of_a_crate_has_a_place() {
    for (of_crate, order) in ORDERS {
        let text = std::fs::read_to_string(folder_of(of_crate).join("lib.rs")).expect("a source");
        let declared = text.lines().filter_map(|line| {
            let line = line.trim();
            line.strip_prefix("pub ").unwrap_or(line).strip_prefix("mod ").map(word)
        });
        let unplaced: Vec<&str> = declared.filter(|m| !order.contains(m)).collect();
        assert!(unplaced.is_empty(), "{of_crate}: modules without a place: {unplaced:?}");
    }
}

#[test]
fn uses_are_found_in_every_form() {
    let text = "use crate::model::Model; // crate::input\nuse crate::{linear::x, units};\n\
                let y = super::super::solver::exact; super::local::z();";
    let names: Vec<String> = used(&code(text), 2).into_iter().collect();
    assert_eq!(names, ["linear", "model", "solver", "units"]);
}
