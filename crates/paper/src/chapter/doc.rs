//! Markdown, piece by piece.

use crate::{Claim, Verdict};

use slipstick_report::number::{compact, printed, typeset};
use slipstick_report::plot::{Figure, Svg};

/// A growing chapter and its figures.
#[derive(Default)]
pub struct Doc {
    text: String,
    figures: Vec<(String, Svg)>,
}

impl Doc {
    /// The text and the figures with their file names.
    pub fn finish(self) -> (String, Vec<(String, Svg)>) {
        (self.text, self.figures)
    }

    /// A heading of level 1, 2, …
    pub fn heading(&mut self, level: usize, text: &str) {
        self.text.push_str(&format!("{} {text}\n\n", "#".repeat(level)));
    }

    /// A paragraph, its lines filled to 100 characters.
    pub fn paragraph(&mut self, text: &str) {
        self.filled(text, "", "");
        self.text.push('\n');
    }

    fn filled(&mut self, text: &str, first: &str, other: &str) {
        let mut line = first.to_owned();
        let mut empty = true;
        for word in text.split(' ').filter(|word| !word.is_empty()) {
            if !empty && line.chars().count() + 1 + word.chars().count() > 100 {
                self.text.push_str(&line);
                self.text.push('\n');
                line = other.to_owned();
                empty = true;
            }
            if !empty {
                line.push(' ');
            }
            line.push_str(word);
            empty = false;
        }
        self.text.push_str(&line);
        self.text.push('\n');
    }

    /// A table; the first `left` columns are words, the others figures.
    pub fn table(&mut self, header: &[&str], left: usize, rows: Vec<Vec<String>>) {
        let row = |cells: Vec<String>| {
            let cells: Vec<String> = cells.iter().map(|cell| cell.replace('|', "\\|")).collect();
            format!("| {} |\n", cells.join(" | "))
        };
        self.text.push_str(&row(header.iter().map(|cell| (*cell).to_owned()).collect()));
        let rule = |i: usize| if i < left { "---" } else { "--:" };
        let rules: Vec<&str> = (0..header.len()).map(rule).collect();
        self.text.push_str(&format!("|{}|\n", rules.join("|")));
        for cells in rows {
            self.text.push_str(&row(cells));
        }
        self.text.push('\n');
    }

    /// A figure with its caption.
    pub fn figure(&mut self, figure: &Figure, caption: &str) {
        let name = format!("{}.svg", figure.id);
        self.text.push_str(&format!("![{}](figures/{name})\n\n", figure.title));
        self.filled(&format!("*{caption}*"), "", "");
        self.text.push('\n');
        self.figures.push((name, figure.to_svg()));
    }

    /// Claims as a list, each with its verdict and reason.
    pub fn claims<'a>(&mut self, claims: impl Iterator<Item = &'a Claim>) {
        for claim in claims {
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
            self.filled(&text, "- ", "  ");
        }
        self.text.push('\n');
    }
}

/// The number that the paper prints, with its unit; nothing where it prints none.
pub fn paper_value(claim: &Claim) -> String {
    let text = |value: f64| typeset(&compact(value));
    claim.paper_value.map_or_else(String::new, |v| format!("{}{}", text(v), unit_after(claim)))
}

/// The computed number to four significant digits, with its unit; nothing where there is none.
pub fn computed_value(claim: &Claim) -> String {
    claim
        .computed_value
        .map_or_else(String::new, |v| format!("{}{}", printed(v, 4), unit_after(claim)))
}

fn unit_after(claim: &Claim) -> String {
    if claim.unit.is_empty() { String::new() } else { format!(" {}", claim.unit) }
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
    if !value.is_finite() {
        return "–".to_owned();
    }
    let text = format!("{value:.decimals$}");
    let zero = text.trim_start_matches('-').chars().all(|c| matches!(c, '0' | '.'));
    typeset(if zero { text.trim_start_matches('-') } else { &text })
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
    fn lines_are_filled() {
        let mut doc = Doc::default();
        doc.paragraph(&"word ".repeat(40));
        assert!(doc.finish().0.lines().all(|line| line.chars().count() <= 100));
    }
}
