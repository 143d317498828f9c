//! Markdown: lines of 100 characters, tables, lists of claims, numbers as they are printed.

use crate::{Claim, Verdict};

use slipstick_report::number::{self, compact, printed, typeset};
use slipstick_report::plot::Figure;

/// Paragraphs with their lines filled anew, in one text; headings, tables, figures and lists stand as they are.
pub fn refilled(text: &str) -> String {
    let blocks = text.split("\n\n").map(|block| block.trim_matches('\n'));
    let blocks = blocks.filter(|block| !block.is_empty()).map(|block| {
        match block.starts_with(['#', '|', '!']) || block.starts_with("- ") {
            true => block.to_owned(),
            false => filled(block, "", ""),
        }
    });
    blocks.collect::<Vec<_>>().join("\n\n") + "\n"
}

fn filled(text: &str, first: &str, other: &str) -> String {
    let mut lines = String::new();
    let mut line = first.to_owned();
    let mut empty = true;
    for word in text.split([' ', '\n']).filter(|word| !word.is_empty()) {
        if !empty && line.chars().count() + 1 + word.chars().count() > 100 {
            lines.push_str(&line);
            lines.push('\n');
            line = other.to_owned();
            empty = true;
        }
        if !empty {
            line.push(' ');
        }
        line.push_str(word);
        empty = false;
    }
    lines + &line
}

/// Rows of a table.
pub fn rows<const N: usize>(cells: impl IntoIterator<Item = [String; N]>) -> String {
    cells.into_iter().map(|cells| row(&cells)).collect::<Vec<_>>().join("\n")
}

fn row(cells: &[String]) -> String {
    let cells: Vec<String> = cells.iter().map(|cell| cell.replace('|', "\\|")).collect();
    format!("| {} |", cells.join(" | "))
}

/// A table whose first column are words, the others figures.
pub fn table(header: &[String], cells: impl IntoIterator<Item = Vec<String>>) -> String {
    let rule = format!("|---|{}", "--:|".repeat(header.len() - 1));
    let rows = cells.into_iter().map(|cells| row(&cells));
    [row(header), rule].into_iter().chain(rows).collect::<Vec<_>>().join("\n")
}

/// A figure from the folder beside the text.
pub fn image(figure: &Figure) -> String {
    format!("![{}](figures/{}.svg)", figure.title, figure.id)
}

/// Claims as a list, each with its verdict and reason.
pub fn claims<'a>(claims: impl IntoIterator<Item = &'a Claim>) -> String {
    let items = claims.into_iter().map(|claim| {
        let mut text = format!("**{}** — {}", capital(claim.verdict.words()), claim.claim);
        text.push_str(
            &format!(" (section {}).", claim.section).replace("section abstract", "abstract"),
        );
        if claim.paper_value.is_some() {
            text.push_str(&format!(" Paper: {}.", paper_value(claim)));
        }
        if claim.computed_value.is_some() {
            text.push_str(&format!(" Computed: {}.", computed_value(claim)));
        }
        text.push_str(&format!(" {}", typeset_minus(&claim.why)));
        if claim.verdict != Verdict::CannotBeChecked {
            text.push_str(&format!(" *Rule: {}.*", claim.rule));
        }
        filled(&text, "- ", "  ")
    });
    items.collect::<Vec<_>>().join("\n")
}

/// The number that the paper prints, with its unit; nothing where it prints none.
pub fn paper_value(claim: &Claim) -> String {
    with_unit(claim, claim.paper_value.map(|value| typeset(&compact(value))))
}

/// The computed number to four significant digits, with its unit; nothing where there is none.
pub fn computed_value(claim: &Claim) -> String {
    with_unit(claim, claim.computed_value.map(|value| printed(value, 4)))
}

fn with_unit(claim: &Claim, number: Option<String>) -> String {
    number
        .map_or_else(String::new, |number| format!("{number} {}", claim.unit).trim_end().to_owned())
}

/// A test's name as a table has room for: no section, few words.
pub fn short(name: &str) -> String {
    let name = name.trim_start_matches("Section 3, ").trim_start_matches("Section 6, ");
    name.replace(" without a spring", ", free")
        .replace(" on the certified spring without pre-stress", ", certified")
        .replace(" on the certified spring with pre-stress", ", certified pre-stressed")
        .replace(" on the non-certified spring", ", non-certified")
        .replace(" Taft 1952", " Taft")
        .replace(", a ", ", ")
        .replace(" sine", "")
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// True minus signs before digits that follow a space or a bracket; hyphens inside words stay.
fn typeset_minus(text: &str) -> String {
    let letters: Vec<char> = text.chars().collect();
    let minus = |i: usize| {
        let before = i == 0 || matches!(letters[i - 1], ' ' | '(' | 'e');
        let digit = letters.get(i + 1).is_some_and(char::is_ascii_digit);
        let exponent = i > 1 && letters[i - 1] == 'e' && letters[i - 2].is_ascii_digit();
        letters[i] == '-'
            && digit
            && before
            && (letters.get(i.wrapping_sub(1)) != Some(&'e') || exponent)
    };
    (0..letters.len()).map(|i| if minus(i) { '−' } else { letters[i] }).collect()
}

/// Fixed decimals with a true minus sign; what rounds to zero has no sign.
pub fn fixed(value: f64, decimals: usize) -> String {
    if value.is_finite() { typeset(&number::fixed(value, decimals)) } else { "–".to_owned() }
}

/// The same with a plus sign before what is not negative.
pub fn signed(value: f64, decimals: usize) -> String {
    let text = fixed(value, decimals);
    if text.starts_with('−') || !value.is_finite() { text } else { format!("+{text}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn minus_signs() {
        assert_eq!(
            typeset_minus("-1.5 to (-2) mm, one-way 1e-5, F-16"),
            "−1.5 to (−2) mm, one-way 1e−5, F-16"
        );
        assert_eq!(
            (fixed(-0.001, 2), signed(0.5, 1), signed(-0.5, 1)),
            ("0.00".into(), "+0.5".into(), "−0.5".into())
        );
    }

    #[test]
    fn paragraphs_are_filled_and_tables_are_not() {
        let table = format!("| {} |", "word ".repeat(40));
        let text = refilled(&format!("{}\n\n\n\n{table}\n\n", "word\n".repeat(40)));
        let (paragraph, rest) = text.split_once("\n\n").unwrap();
        assert!(paragraph.lines().all(|line| line.chars().count() <= 100));
        assert_eq!((paragraph.lines().count(), rest), (2, &format!("{table}\n")[..]));
    }
}
