//! What went in: model, record, files, command; and what the model leaves out.

use slipstick::model::Model;
use slipstick::response::Method;

use super::{name_table, table_head};
use crate::describe::{model_rows, storey_rows};
use crate::display::Quantity;
use crate::markup::Markup;
use crate::number::{compact, count, printed, significant, typeset};
use crate::report::{FileNote, Provenance, Report};
use crate::table::drifts;

/// Model and record in numbers.
pub fn section(out: &mut Markup, report: &Report) {
    out.raw("<h3>Model and record</h3>\n<div class=\"pair\">\n<div>\n");
    name_table(out, "Model", &model_rows(report.model, report.display));
    out.raw("</div>\n<div>\n");
    name_table(out, "Ground motion", &record_rows(report));
    out.raw("</div>\n</div>\n");
    if let Some((heading, (header, rows))) = storey_rows(report.model, report.display) {
        out.element("h3", heading).raw("\n");
        table_head(out, &header.into_iter().map(|head| (head, true)).collect::<Vec<_>>());
        for row in rows {
            out.raw("<tr>");
            for cell in row {
                out.raw("<td class=\"number\">").text(typeset(&cell)).raw("</td>");
            }
            out.raw("</tr>\n");
        }
        out.raw("</tbody>\n</table>\n");
    }
}

fn record_rows(report: &Report) -> Vec<(&'static str, String)> {
    let (summary, motion) = (report.summary, report.motion);
    let record = &summary.record;
    // The end velocity is read against the peak, so it has the unit of the peak.
    let show_as = |quantity, largest: f64, si: f64| {
        let unit = report.display.unit(quantity, largest);
        format!("{} {}", significant(unit.of(si), 4), unit.symbol)
    };
    let show = |quantity, si: f64| show_as(quantity, si, si);
    // The step of the record: a tail may end between two steps.
    let dt = summary.dt_s.map_or("uneven".to_owned(), |dt_s| format!("{} s", compact(dt_s)));
    let mut rows = vec![("Record", report.record.to_owned())];
    rows.extend(summary.origin.said());
    rows.extend([
        ("Samples", count(motion.len() as u64)),
        ("Time step", dt),
        ("Duration", format!("{} s", compact(motion.duration_s()))),
    ]);
    if summary.duration_s != motion.duration_s() {
        rows.push(("  analysed, with the tail", format!("{} s", compact(summary.duration_s))));
    }
    rows.extend([
        ("Factor on the record", compact(summary.record_factor)),
        ("PGA (as used)", show(Quantity::Acceleration, record.pga_m_per_s2)),
        ("PGV", show(Quantity::Velocity, record.pgv_m_per_s)),
        (
            if drifts(record) { "PGD (the record drifts)" } else { "PGD" },
            show(Quantity::Length, record.pgd_m),
        ),
        (
            "Velocity at the end",
            show_as(Quantity::Velocity, record.pgv_m_per_s, record.end_velocity_m_per_s),
        ),
        (
            "Vertical motion",
            if motion.vertical_m_per_s2().is_some() { "yes" } else { "none" }.to_owned(),
        ),
    ]);
    rows
}

/// Files with their hashes, the command, and texts that people wrote.
pub(crate) fn provenance(out: &mut Markup, provenance: &Provenance) {
    file_table(out, provenance.files);
    out.raw("<h3>Command</h3>\n<p class=\"command\">").text(provenance.command_line).raw("</p>\n");
    for input in provenance.inputs {
        out.raw("<h3 class=\"path\">")
            .text(input.path)
            .raw("</h3>\n<pre>")
            .text(input.text)
            .raw("</pre>\n");
    }
}

fn file_table(out: &mut Markup, files: &[FileNote]) {
    if files.is_empty() {
        return;
    }
    out.raw("<h3>Files read</h3>\n");
    let heads = ["File", "What", "SHA-256"].map(|head| (head.to_owned(), false));
    table_head(out, &heads);
    for file in files {
        out.raw("<tr><td>");
        // A path is broken behind a folder, not within a name.
        for (i, part) in file.path.split_inclusive('/').enumerate() {
            out.raw(if i == 0 { "" } else { "<wbr>" }).text(part);
        }
        out.raw("</td><td>")
            .text(file.description)
            .raw("</td><td class=\"hash\">")
            .text(file.sha256)
            .raw("</td></tr>\n");
    }
    out.raw("</tbody>\n</table>\n");
}

/// What the model takes for granted, with the ratios that say how far it can be trusted.
pub fn assumptions(out: &mut Markup, report: &Report) {
    let model = report.model;
    let runs = report.summary.runs();
    let overturning = runs.iter().filter_map(|(_, run)| run.demands.overturning_ratio);
    let mut list = vec![
        match report.response.in_plane {
            Some(_) => "Motion is along x, along y and vertical; there is no torsion.",
            None => {
                "Motion is in one vertical plane; there is no torsion and no second horizontal \
                 direction."
            }
        }
        .to_owned(),
        "Vertically everything is rigid: the normal force is the total mass times g cos θ plus the \
         vertical acceleration of the table, never below 0, spread evenly over the surface."
            .to_owned(),
        match overturning.reduce(f64::max) {
            Some(ratio) => format!(
                "No rocking and no uplift of an edge. The largest overturning moment is {} of what \
                 the weight resists{}.",
                printed(ratio, 3),
                if ratio > 1.0 { ": an edge would lift, which this analysis does not follow" } else { "" }
            ),
            None => "No rocking and no uplift of an edge; the overturning ratio needs the width of \
                     the block and storey heights, which are not given."
                .to_owned(),
        },
        "Displacements and angles are small: geometry does not change, and the structure is linear \
         (no yielding, no second-order effects)."
            .to_owned(),
        friction(model),
        if model.slider().series().is_some() {
            "Each surface has its own radius and friction; displacements are small beside the radii."
                .to_owned()
        } else {
            "The surface has one constant tilt; the spring is linear and unstressed at s = 0."
                .to_owned()
        },
        "The table acceleration is linear between samples and was not filtered or corrected; \
         accelerations are total (absolute)."
            .to_owned(),
    ];
    if model.slider().gap_m().is_some() && model.stop().is_none() {
        list.push("Nothing is struck: where the gap is exceeded, the block slides on.".to_owned());
    }
    let vertical = report.motion.vertical_m_per_s2().is_some();
    let constant = model.slider().pendulum_radius_m(vertical).is_none();
    if vertical && constant && model.slider_stiffness_n_per_m() > 0.0 {
        list.push(
            "The spring keeps its stiffness under vertical motion; that of a real pendulum slider \
             follows N(t)."
                .to_owned(),
        );
    }
    if report.response.method == Method::Stepwise {
        list.push(
            "The stepwise method finds events only at samples; it is there to reproduce earlier \
             work, not for design."
                .to_owned(),
        );
    }
    out.raw("<section>\n<h2>Assumptions</h2>\n<ul>\n");
    for line in list {
        out.element("li", line).raw("\n");
    }
    out.raw("</ul>\n</section>\n");
}

/// What friction depends on, and what not.
fn friction(model: &Model) -> String {
    let follows = [
        ("velocity", model.slider().rate().is_some()),
        ("pressure", model.slider().pressure().is_some()),
    ];
    let named = |wanted: bool| {
        follows.iter().filter(move |(_, follows)| *follows == wanted).map(|(what, _)| *what)
    };
    let besides: String = named(true).map(|what| format!(", on {what}")).collect();
    let not: String = named(false).map(|what| format!("{what}, ")).collect();
    let law = if besides.is_empty() { "is Coulomb's: it depends" } else { "depends" };
    format!(
        "Friction {law} on whether and which way the block slides{besides}, not on {not}temperature, \
         wear or time at rest."
    )
}
