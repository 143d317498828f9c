//! `cargo xtask reference`: the reference cases as a table of the book, from the tests' own words.

use crate::shell::{self, Outcome};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// What the test of one case said.
#[derive(Debug, PartialEq, Eq)]
struct Said<'a> {
    /// Name of the test: its prefix is the source of truth.
    test: &'a str,
    /// Number of figures compared.
    figures: &'a str,
    /// Largest error over its tolerance.
    worst: &'a str,
    /// That tolerance, SI.
    tolerance: &'a str,
    /// The figure that is so.
    what: &'a str,
}

/// Runs the tests of all cases of `data/reference/` and tabulates the errors reached.
pub fn reference(options: &[&str]) -> Outcome {
    if !matches!(options, [] | ["--write"]) {
        return Err(format!("reference: expected --write or nothing, found {}", options.join(" ")));
    }
    let test = "test --quiet -p slipstick --test library -- --show-output cases:: devices:: bidirectional::";
    let log = shell::output(&mut shell::cargo(test))?;
    let mut all = Vec::new();
    for file in ["cases.json", "devices.json", "bidirectional.json"] {
        let path = shell::root().join("data/reference").join(file);
        let read = std::fs::read_to_string(&path)
            .map_err(|error| error.to_string())
            .and_then(|text| serde_json::from_str::<Value>(&text).map_err(|e| e.to_string()))
            .map_err(|error| format!("{}: {error}", path.display()))?;
        let cases = read["cases"].as_array().into_iter().flatten();
        // Of two directions those of friction by speed are not solved.
        all.extend(cases.filter(|case| case["step"] != 2).cloned());
    }
    let cases = serde_json::json!({ "cases": all });
    let table = table(&cases, &said(&log))?;
    if options.is_empty() {
        print!("{table}");
        return Ok(());
    }
    shell::write(&shell::root().join("book/src/generated/verification.md"), &table)
}

/// By case: `case ID: N figures, worst R of its tolerance T (WHAT)` in the output of a test.
fn said(log: &str) -> BTreeMap<&str, Said<'_>> {
    let mut test = "";
    let mut said = BTreeMap::new();
    for line in log.lines() {
        if let Some(name) = line.strip_prefix("---- ").and_then(|l| l.strip_suffix(" stdout ----"))
        {
            test = name.rsplit("::").next().unwrap_or(name);
        }
        let parts = line.strip_prefix("case ").and_then(|line| {
            let (id, rest) = line.split_once(": ")?;
            let (figures, rest) = rest.split_once(" figures, worst ")?;
            let (worst, rest) = rest.split_once(" of its tolerance ")?;
            let (tolerance, what) = rest.strip_suffix(')')?.split_once(" (")?;
            Some((id, Said { test, figures, worst, tolerance, what }))
        });
        said.extend(parts);
    }
    said
}

fn table(cases: &Value, said: &BTreeMap<&str, Said<'_>>) -> Result<String, String> {
    let mut table = String::from(
        "<!-- Written by `cargo xtask reference --write`. -->\n\n\
         | case | what it is | truth | figures | largest error / tolerance | that tolerance, SI | figure |\n\
         |---|---|---|--:|--:|--:|---|\n",
    );
    let cases = cases["cases"].as_array().ok_or("cases.json: expected a list of cases")?;
    for case in cases {
        let word = |key: &str| case[key].as_str().unwrap_or_default().replace('|', "\\|");
        let id = word("id");
        let Said { test, figures, worst, tolerance, what } =
            said.get(id.as_str()).ok_or_else(|| format!("no test has spoken for case {id}"))?;
        let digits = if id.starts_with("BIDI") { "34-digit solution" } else { "50-digit solution" };
        let truth = if test.starts_with("closed_form_") { "closed form" } else { digits };
        let title = word("title");
        let what = what.replace('|', "\\|");
        writeln!(
            table,
            "| {id} | {title} | {truth} | {figures} | {worst} | {tolerance} | {what} |"
        )
        .map_err(|error| error.to_string())?;
    }
    Ok(table)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_of_a_test_becomes_a_row() {
        let log = "running 1 test\n---- cases::closed_form_harm stdout ----\n\
                   case HARM: 7 figures, worst 1.2e-3 of its tolerance 4.9e-11 (peak |z|)\n";
        let cases = serde_json::json!({ "cases": [{ "id": "HARM", "title": "a=A sin" }] });
        let table = table(&cases, &said(log)).expect("a table");
        let row = "| HARM | a=A sin | closed form | 7 | 1.2e-3 | 4.9e-11 | peak \\|z\\| |";
        assert_eq!(table.lines().last(), Some(row));
    }

    #[test]
    fn a_case_without_a_test_is_an_error() {
        let cases = serde_json::json!({ "cases": [{ "id": "HARM" }] });
        let error = table(&cases, &said("")).expect_err("no row");
        assert_eq!(error, "no test has spoken for case HARM");
    }
}
