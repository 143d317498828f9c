//! The page that a design office prints: one file, nothing from elsewhere, complete without its script.

pub(crate) mod inputs;
mod results;
mod verdict;

use crate::VERSION;
use crate::assessment::Sheet;
use crate::display::DisplayUnits;
use crate::figures::{self, Drawn};
use crate::laboratory::text::is_number;
use crate::markup::Markup;
use crate::number::{compact, typeset, typeset_cell, typeset_sentence};
use crate::report::Report;
use crate::summary::method_name;
use slipstick::notice::{Notice, Severity};

/// One run laid out.
pub fn sheet(report: &Report) -> Sheet {
    let summary = report.summary;
    let (mut body, mut appendix) = (Markup::new(), Markup::new());
    let all = figures::all(report);
    let (answers, others) = all.split_at(figures::ANSWERS.min(all.len()));
    figure_list(&mut body, answers, 1);
    results::peaks(&mut body, report);
    figure_section(&mut body, "Accelerations, spectra, energy", others, answers.len() + 1);
    results::floor_spectra(&mut body, report);
    results::certificate(&mut body, report);
    inputs::assumptions(&mut body, report);
    inputs::section(&mut appendix, report);
    results::events(&mut appendix, report);
    let (of_runs, warnings): (Vec<_>, Vec<&Notice>) = summary.all_warnings().into_iter().unzip();
    let (method, record) = (method_name(summary.method), report.record);
    Sheet {
        kind: "Sliding response analysis",
        name: summary.model.clone(),
        model_hash: summary.model_hash.clone(),
        line: format!("By the {method} method; ground motion: {record}"),
        verdict: verdict::sentences(report),
        failed: summary.check_failed(),
        warnings: warnings.into_iter().cloned().collect(),
        of_runs,
        display: report.display,
        laid_out: [body, appendix],
        ..Sheet::default()
    }
}

/// What stands around the body of a page.
pub(crate) struct Frame<'a> {
    /// Above the name.
    pub kind: &'static str,
    /// What the page is about.
    pub name: &'a str,
    /// Names and values of the title block.
    pub title: &'a [(&'static str, String)],
    /// Below the name.
    pub line: &'a str,
    /// The command as it was typed.
    pub command_line: &'a str,
    /// All between header and footer.
    pub body: &'a Markup,
}

/// A self-contained page.
pub(crate) fn document(frame: &Frame) -> String {
    let mut out = Markup::new();
    out.raw("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n")
        .raw("<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>")
        .text(frame.name)
        .raw(": ")
        .raw(frame.kind)
        .raw("</title>\n<style>\n")
        .raw(include_str!("html/style.css"));
    page_margins(&mut out, frame);
    out.raw("</style>\n</head>\n<body>\n<header>\n<p>")
        .raw(frame.kind)
        .raw("</p>\n")
        .element("h1", frame.name)
        .raw("\n");
    if !frame.title.is_empty() {
        out.raw("<dl class=\"title\">\n");
        for (name, text) in frame.title {
            out.raw("<div>").element("dt", name).element("dd", text).raw("</div>\n");
        }
        out.raw("</dl>\n");
    }
    out.raw("<p>")
        .text(frame.line)
        .raw("</p>\n</header>\n<main>\n")
        .append(frame.body)
        .raw("</main>\n<footer>\n<p>")
        .text(format!("Slipstick {}: ", VERSION))
        .raw("<code>")
        .text(frame.command_line)
        .raw("</code></p>\n</footer>\n<script>\n")
        .raw(include_str!("html/hover.js"))
        .raw("</script>\n</body>\n</html>\n");
    out.into_string()
}

/// Name above and version, command and page number below, on every printed page.
fn page_margins(out: &mut Markup, frame: &Frame) {
    out.raw("@page { size: A4; margin: 20mm 17mm 20mm 20mm;\n")
        .raw("  font: 7.5pt Helvetica, Arial, \"Liberation Sans\", sans-serif; color: #444;\n")
        .raw("  @top-left { content: ")
        .css_string(frame.name, 90)
        .raw("; }\n  @bottom-left { content: ")
        .css_string(&format!("Slipstick {} · {}", VERSION, frame.command_line), 105)
        .raw("; }\n  @bottom-right { content: counter(page) \" / \" counter(pages); }\n}\n");
}

/// Warnings, each with the run it belongs to, or a line that says there are none; then notes.
pub(crate) fn warning_list(
    out: &mut Markup,
    warnings: &[(Option<&'static str>, &Notice)],
    display: DisplayUnits,
) {
    let (notes, warnings): (Vec<_>, Vec<_>) =
        warnings.iter().copied().partition(|(_, warning)| warning.is_note());
    if warnings.is_empty() {
        out.raw("<p class=\"quiet\">No warnings.</p>\n");
    } else {
        out.raw("<section class=\"warnings\">\n<h2>Warnings</h2>\n");
        told(out, &warnings, display);
        out.raw("</section>\n");
    }
    if !notes.is_empty() {
        out.raw("<section class=\"notes\">\n<h2>Notes</h2>\n");
        told(out, &notes, display);
        out.raw("</section>\n");
    }
}

fn told(out: &mut Markup, warnings: &[(Option<&'static str>, &Notice)], display: DisplayUnits) {
    out.raw("<ul>\n");
    for (run, warning) in warnings {
        let severe = warning.severity() == Severity::Severe;
        let label = if severe { format!("{}: ", warning.label()) } else { String::new() };
        out.raw("<li>").element("strong", label + &warning.kind.words());
        if let Some(name) = run {
            out.text(format!(" ({name} friction)"));
        }
        if let Some(time_s) = warning.time_s {
            out.text(format!(" at {} s", typeset(&compact(time_s))));
        }
        let message = typeset_sentence(&display.sentence(&warning.message));
        out.raw(": ").text(message).raw("</li>\n");
    }
    out.raw("</ul>\n");
}

/// A section of numbered figures; nothing where there are none.
pub(crate) fn figure_section(
    out: &mut Markup,
    heading: &'static str,
    figures: &[Drawn],
    first: usize,
) {
    if figures.is_empty() {
        return;
    }
    out.raw("<section>\n").element("h2", heading).raw("\n");
    figure_list(out, figures, first);
    out.raw("</section>\n");
}

/// Figures with their captions, numbered from `first`; the first of a page is drawn for a phone besides.
pub(crate) fn figure_list(out: &mut Markup, figures: &[Drawn], first: usize) {
    for (i, figure) in figures.iter().enumerate() {
        let both = first + i == 1;
        out.raw("<figure").attribute("id", &figure.id);
        out.raw(if both { " class=\"both\">\n<div class=\"wide\">\n" } else { ">\n<div>\n" })
            .append(figure.svg.markup());
        if both {
            out.raw("</div>\n<div class=\"narrow\">\n")
                .append(figure.figure.to_narrow_svg().markup());
        }
        out.raw("</div>\n<figcaption><strong>")
            .text(format!("Figure {}.", first + i))
            .raw("</strong> ")
            .text(&figure.caption)
            .raw("</figcaption>\n</figure>\n");
    }
}

/// Opens a table with a row of heads; those marked are over numbers.
pub(crate) fn table_head(out: &mut Markup, heads: &[(String, bool)]) {
    out.raw("<table>\n<thead><tr>");
    for (head, number) in heads {
        out.raw(if *number { "<th scope=\"col\" class=\"number\">" } else { "<th scope=\"col\">" })
            .text(head)
            .raw("</th>");
    }
    out.raw("</tr></thead>\n<tbody>\n");
}

/// A table of names and values.
pub(crate) fn name_table(out: &mut Markup, caption: &str, rows: &[(&str, String)]) {
    out.raw("<table>\n").element("caption", caption).raw("\n<tbody>\n");
    for (name, value) in rows {
        out.raw(if name.starts_with(' ') { "<tr class=\"sub\">" } else { "<tr>" })
            .raw("<th scope=\"row\">")
            .text(name.trim_start())
            .raw("</th><td>")
            .text(typeset_sentence(value))
            .raw("</td></tr>\n");
    }
    out.raw("</tbody>\n</table>\n");
}

/// Rows of a table up to which it is not broken over two pages.
const KEPT_ROWS: usize = 24;

/// Characters of a cell from which on a table is one of sentences.
const SENTENCE: usize = 60;

/// A table whose first row are heads and whose first column are names.
pub(crate) fn number_table(out: &mut Markup, rows: &[Vec<String>]) {
    let Some((heads, rows)) = rows.split_first() else { return };
    let wide = heads.len() > 6;
    out.raw(if wide { "<div class=\"small\">\n" } else { "" });
    // A table of few rows stands on one page; one of sentences has its names wide.
    let short = rows.len() <= KEPT_ROWS;
    let sentences = rows.iter().flatten().any(|cell| cell.chars().count() > SENTENCE);
    out.raw(if sentences { "<div class=\"sentences\">\n" } else { "" });
    // A column with words is set as words.
    let numbers: Vec<bool> = (0..heads.len())
        .map(|i| i > 0 && rows.iter().filter_map(|row| row.get(i)).all(|cell| is_number(cell)))
        .collect();
    let heads: Vec<_> = heads.iter().cloned().zip(numbers.iter().copied()).collect();
    if short {
        out.raw("<div class=\"short\">\n");
    }
    table_head(out, &heads);
    for row in rows {
        for (i, cell) in row.iter().enumerate() {
            if i == 0 {
                let sub = cell.starts_with(' ');
                out.raw(if sub { "<tr class=\"sub\">" } else { "<tr>" })
                    .raw("<th scope=\"row\">")
                    .text(cell.trim_start())
                    .raw("</th>");
            } else {
                let governs = cell.strip_suffix('*');
                if !numbers.get(i).is_some_and(|number| *number) {
                    out.raw("<td class=\"words\">").text(typeset_cell(cell)).raw("</td>");
                    continue;
                }
                out.raw(if governs.is_some() {
                    "<td class=\"number governs\">"
                } else {
                    "<td class=\"number\">"
                })
                .text(typeset_cell(governs.unwrap_or(cell)))
                .raw(if governs.is_some() { "*</td>" } else { "</td>" });
            }
        }
        out.raw("</tr>\n");
    }
    out.raw("</tbody>\n</table>\n").raw(if short { "</div>\n" } else { "" });
    out.raw(if sentences { "</div>\n" } else { "" });
    out.raw(if wide { "</div>\n" } else { "" });
}
