//! The page that a design office prints: one file, no scripts, nothing from elsewhere.

mod inputs;
mod results;

use crate::figures;
use crate::markup::Markup;
use crate::number::{compact, typeset};
use crate::report::Report;
use crate::summary::method_name;

/// The whole page.
pub fn page(report: &Report) -> String {
    let summary = report.summary;
    let mut out = Markup::new();
    out.raw("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n")
        .raw("<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>")
        .text(&summary.model)
        .raw(": sliding response</title>\n<style>\n")
        .raw(include_str!("style.css"));
    page_margins(&mut out, report);
    out.raw("</style>\n</head>\n<body>\n<header>\n<p>Sliding response analysis</p>\n")
        .element("h1", &summary.model)
        .raw("\n<p>")
        .text(format!(
            "Slipstick {}, {} method. {}",
            summary.slipstick,
            method_name(summary.method),
            report.record
        ))
        .raw("</p>\n</header>\n<main>\n");
    warnings(&mut out, report);
    inputs::section(&mut out, report);
    results::peaks(&mut out, report);
    results::events(&mut out, report);
    results::certificate(&mut out, report);
    inputs::assumptions(&mut out, report);
    figure_section(&mut out, report);
    out.raw("</main>\n<footer>\n<p>")
        .text(format!("Slipstick {}: ", summary.slipstick))
        .raw("<code>")
        .text(report.command_line)
        .raw("</code></p>\n</footer>\n</body>\n</html>\n");
    out.into_string()
}

/// Name above and version, command and page number below, on every printed page.
fn page_margins(out: &mut Markup, report: &Report) {
    out.raw("@page { size: A4; margin: 20mm 17mm 20mm 20mm;\n")
        .raw("  font: 7.5pt Helvetica, Arial, \"Liberation Sans\", sans-serif; color: #444;\n")
        .raw("  @top-left { content: ")
        .css_string(&report.summary.model, 90)
        .raw("; }\n  @bottom-left { content: ")
        .css_string(
            &format!("Slipstick {} · {}", report.summary.slipstick, report.command_line),
            105,
        )
        .raw("; }\n  @bottom-right { content: counter(page) \" / \" counter(pages); }\n}\n");
}

fn warnings(out: &mut Markup, report: &Report) {
    let warnings = report.summary.all_warnings();
    if warnings.is_empty() {
        out.raw("<p class=\"quiet\">No warnings.</p>\n");
        return;
    }
    out.raw("<section class=\"warnings\">\n<h2>Warnings</h2>\n<ul>\n");
    for (run, warning) in warnings {
        out.raw("<li>").element("strong", warning.kind.replace('_', " "));
        if let Some(name) = run {
            out.text(format!(" ({name} friction)"));
        }
        if let Some(time_s) = warning.time_s {
            out.text(format!(" at {} s", typeset(&compact(time_s))));
        }
        out.raw(": ").text(&warning.message).raw("</li>\n");
    }
    out.raw("</ul>\n</section>\n");
}

fn figure_section(out: &mut Markup, report: &Report) {
    let figures = figures::all(report);
    out.raw("<section class=\"figures\">\n<h2>Figures</h2>\n");
    if figures.is_empty() {
        out.raw("<p>No history was kept, so there is nothing to draw.</p>\n");
    }
    for (i, figure) in figures.iter().enumerate() {
        out.raw("<figure").attribute("id", figure.id).raw(">\n").append(figure.svg.markup());
        out.raw("<figcaption><strong>")
            .text(format!("Figure {}.", i + 1))
            .raw("</strong> ")
            .text(&figure.caption)
            .raw("</figcaption>\n</figure>\n");
    }
    out.raw("</section>\n");
}

/// Opens a table with a row of heads; those marked are over numbers.
fn table_head(out: &mut Markup, heads: &[(String, bool)]) {
    out.raw("<table>\n<thead><tr>");
    for (head, number) in heads {
        out.raw(if *number { "<th scope=\"col\" class=\"number\">" } else { "<th scope=\"col\">" })
            .text(head)
            .raw("</th>");
    }
    out.raw("</tr></thead>\n<tbody>\n");
}

/// A table of names and values.
fn name_table(out: &mut Markup, caption: &str, rows: &[(&str, String)]) {
    out.raw("<table>\n").element("caption", caption).raw("\n<tbody>\n");
    for (name, value) in rows {
        out.raw(if name.starts_with(' ') { "<tr class=\"sub\">" } else { "<tr>" })
            .raw("<th scope=\"row\">")
            .text(name.trim_start())
            .raw("</th><td>")
            .text(value.replace('-', "−"))
            .raw("</td></tr>\n");
    }
    out.raw("</tbody>\n</table>\n");
}
