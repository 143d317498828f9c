//! `cargo xtask reference`: the reference cases and the published figures as tables of the book, from the tests' own
//! words.

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
    let test = "test --quiet -p slipstick --test library -- --show-output cases:: devices:: bidirectional:: published::";
    let log = shell::output(&mut shell::cargo(test))?;
    let mut all = Vec::new();
    for file in ["cases.json", "devices.json", "bidirectional.json"] {
        let path = shell::root().join("data/reference").join(file);
        let read = std::fs::read_to_string(&path)
            .map_err(|error| error.to_string())
            .and_then(|text| serde_json::from_str::<Value>(&text).map_err(|e| e.to_string()))
            .map_err(|error| format!("{}: {error}", path.display()))?;
        all.extend(read["cases"].as_array().into_iter().flatten().cloned());
    }
    let cases = serde_json::json!({ "cases": all });
    for (page, table) in
        [("verification", table(&cases, &said(&log))?), ("published", published(&log)?)]
    {
        if options.is_empty() {
            print!("{table}");
        } else {
            shell::write(&shell::root().join(format!("book/src/generated/{page}.md")), &table)?;
        }
    }
    Ok(())
}

/// The lines `published CASE | SOURCE | FIGURE | THEIRS | OURS | WHOSE ERROR` of the tests as a table.
fn published(log: &str) -> Result<String, String> {
    let mut rows: Vec<&str> = log.lines().filter_map(|l| l.strip_prefix("published ")).collect();
    if rows.is_empty() {
        return Err("no test has spoken of a published figure".to_owned());
    }
    // Tests end in any order; the rows of one keep theirs.
    rows.sort_by_key(|row| row.split(" | ").next());
    let head = "<!-- Written by `cargo xtask reference --write`. -->\n\n\
                | case | source | figure | published | ours | whose error the difference is |\n\
                |---|---|---|--:|--:|---|\n";
    Ok(rows.iter().fold(head.to_owned(), |table, row| {
        let row = row.replace("|ṡ|", "\\|ṡ\\|");
        format!("{table}| {row} |\n")
    }))
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
    fn published_rows_stand_by_case() {
        let log = "published B | b | second | 1 | 1.00 | none\nother\npublished A | a | N ∫|ṡ| | 2 | 2.00 | none\n\
                   published B | b | third | 3 | 3.00 | none\n";
        let table = published(log).expect("a table");
        let rows: Vec<&str> = table.lines().skip(4).collect();
        let expected = [
            "| A | a | N ∫\\|ṡ\\| | 2 | 2.00 | none |",
            "| B | b | second | 1 | 1.00 | none |",
            "| B | b | third | 3 | 3.00 | none |",
        ];
        assert_eq!(rows, expected);
        assert!(published("nothing").is_err());
    }

    #[test]
    fn a_case_without_a_test_is_an_error() {
        let cases = serde_json::json!({ "cases": [{ "id": "HARM" }] });
        let error = table(&cases, &said("")).expect_err("no row");
        assert_eq!(error, "no test has spoken for case HARM");
    }
}
