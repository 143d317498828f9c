//! What came out: peaks, events, certificate.

use slipstick::response::Event;

use super::{number_table, table_head};
use crate::describe::{event_bearing, event_direction};
use crate::display::{Quantity, Unit};
use crate::floors;
use crate::markup::Markup;
use crate::number::{
    compact, count, decimals, printed, rounded, significant, typeset, typeset_sentence,
};
use crate::peaks;
use crate::report::Report;
use crate::summary::{Summary, exceeds};

/// Most rows of the table of events; of more, the first and the last are shown.
pub const EVENT_ROWS: usize = 60;
const LAST_EVENTS: usize = 20;

/// The peaks: the governing value first, then the runs side by side.
pub fn peaks(out: &mut Markup, report: &Report) {
    let summary = report.summary;
    let runs = summary.runs();
    out.raw("<section class=\"peaks\">\n<h2>Peaks</h2>\n");
    let mut heads = vec![("Quantity".to_owned(), false), ("Unit".to_owned(), false)];
    if runs.len() > 1 {
        heads.push(("Governing".to_owned(), true));
        heads.push(("from".to_owned(), false));
        heads.extend(
            runs.iter()
                .map(|(name, run)| (format!("{name} (× {})", compact(run.friction_factor)), true)),
        );
    } else {
        heads.push(("Value".to_owned(), true));
    }
    table_head(out, &heads);
    for row in peaks::rows(summary, report.display) {
        out.raw(if row.label.starts_with(' ') { "<tr class=\"sub\">" } else { "<tr>" })
            .raw("<th scope=\"row\">")
            .text(row.label.trim_start())
            .raw("</th><td>")
            .text(row.unit)
            .raw("</td>");
        if runs.len() > 1 {
            let governing = row.governing.map_or(("", ""), |i| (row.values[i].as_str(), runs[i].0));
            out.raw("<td class=\"number\"><strong>")
                .text(typeset(governing.0))
                .raw("</strong></td><td>")
                .text(governing.1)
                .raw("</td>");
        }
        for (i, value) in row.values.iter().enumerate() {
            let governs = row.governing == Some(i);
            out.raw(if governs {
                "<td class=\"number governs\">"
            } else {
                "<td class=\"number\">"
            })
            .text(typeset(value))
            .raw("</td>");
        }
        out.raw("</tr>\n");
    }
    out.raw("</tbody>\n</table>\n<p class=\"note\">Peaks are absolute values of the continuous motion over the ")
        .raw("whole run, both sides of jumps included; accelerations are total. The residual ")
        .raw("sliding displacement is that of the last instant.</p>\n</section>\n");
}

/// The floor spectra at round periods, where they were asked for.
pub fn floor_spectra(out: &mut Markup, report: &Report) {
    let names = &report.summary.names;
    let table =
        report.floor_spectra.and_then(|spectra| floors::table(spectra, names, report.display));
    let Some((heading, rows)) = table else { return };
    out.raw("<section class=\"keep\">\n").element("h3", heading).raw("\n");
    number_table(out, &rows);
    out.raw("</section>\n");
}

/// Counts, and the events themselves as far as they fit.
pub fn events(out: &mut Markup, report: &Report) {
    let (summary, events) = (report.summary, &report.response.events);
    out.raw("<h3>Events</h3>\n");
    for (name, run) in summary.runs() {
        let prefix =
            if summary.bounds.is_some() { format!("{name} friction: ") } else { String::new() };
        out.element("p", prefix + &event_line(run)).raw("\n");
    }
    for [from, to] in &summary.contact_loss_s {
        let times = [from, to].map(|time_s| compact(*time_s));
        out.element("p", format!("Contact lost from {} s to {} s.", times[0], times[1]));
    }
    if !events.is_empty() {
        let peak_m = summary.demands.peak_sliding_displacement_m;
        let unit = report.display.unit(Quantity::Length, peak_m);
        // As many decimals in every row as the peak needs for five digits.
        let places = decimals(unit.of(peak_m), 5);
        if summary.bounds.is_some() {
            out.raw("<p>The events with nominal friction:</p>\n");
        }
        let hidden = events.len().saturating_sub(EVENT_ROWS);
        if hidden > 0 {
            let first = EVENT_ROWS - LAST_EVENTS;
            out.element(
                "p",
                format!(
                    "The first {first} and the last {LAST_EVENTS} of {} events; {} more stand in \
                     events.csv.",
                    count(events.len() as u64),
                    count(hidden as u64)
                ),
            );
        }
        out.raw("\n<div class=\"events\">\n");
        table_head(
            out,
            &[
                ("Time (s)".to_owned(), true),
                ("Event".to_owned(), false),
                ("then".to_owned(), false),
                (unit.label(if report.response.in_plane.is_some() { "|s|" } else { "s" }), true),
            ],
        );
        let first = if hidden > 0 { EVENT_ROWS - LAST_EVENTS } else { events.len() };
        let way = |i: usize, event: &Event| match &report.response.in_plane {
            None => event_direction(event).to_owned(),
            Some(plane) => event_bearing(plane.events[i].direction),
        };
        let row = |out: &mut Markup, i: usize, event: &Event| {
            event_row(out, event, &way(i, event), size(report, i, event), (unit, places));
        };
        for (i, event) in events[..first].iter().enumerate() {
            row(out, i, event);
        }
        if hidden > 0 {
            out.raw("<tr><td class=\"number\">…</td><td colspan=\"3\">")
                .text(format!("{} more in events.csv", count(hidden as u64)))
                .raw("</td></tr>\n");
            for (i, event) in events.iter().enumerate().skip(events.len() - LAST_EVENTS) {
                row(out, i, event);
            }
        }
        out.raw("</tbody>\n</table>\n</div>\n");
    }
}

fn event_line(run: &Summary) -> String {
    let d = &run.demands;
    format!(
        "{} slips (stick to slip), {} direct reversals, {} sticks; sliding for {} s of {} s{}.",
        count(d.slip_count),
        count(d.reversal_count),
        count(d.stick_count),
        printed(d.sliding_time_s, 4),
        printed(run.duration_s, 4),
        if d.sliding_at_end { ", and still sliding at the end" } else { "" }
    )
}

/// Sliding displacement at an event; in two horizontal directions its size.
fn size(report: &Report, i: usize, event: &Event) -> f64 {
    let s = event.sliding_displacement_m;
    let plane = report.response.in_plane.as_ref();
    plane.map_or(s, |plane| libm::hypot(s, plane.events[i].sliding_displacement_y_m))
}

fn event_row(out: &mut Markup, event: &Event, way: &str, s: f64, (unit, places): (Unit, usize)) {
    out.raw("<tr><td class=\"number\">")
        .text(format!("{:.6}", event.time_s))
        .raw("</td><td>")
        .raw(event.kind.name())
        .raw("</td><td>")
        .text(typeset_sentence(way))
        .raw("</td><td class=\"number\">")
        .text(typeset(&format!("{:.places$}", unit.of(s) + 0.0)))
        .raw("</td></tr>\n");
}

/// The independent check, with what each figure means.
pub fn certificate(out: &mut Markup, report: &Report) {
    let summary = report.summary;
    let checks = &summary.checks;
    out.raw("<section class=\"keep\">\n<h2>Certificate</h2>\n<p>A check that shares no code with ")
        .raw("the solver integrates the equations of motion anew between the stored states and ")
        .raw("judges them by the law of friction and the balance of energy. ")
        .text(match checks.holds {
            Some(_) if summary.check_failed() => {
                "NOT CONFIRMED: a figure is beyond its bound. Do not use this response."
            }
            Some(_) => "All figures are within their bound: the response is confirmed.",
            None => "The stepwise method is approximate: its figures are reported, not judged.",
        })
        .raw("</p>\n");
    let runs = summary.runs();
    let mut heads = vec![("Figure".to_owned(), false)];
    heads.extend(runs.iter().map(|(name, _)| ((*name).to_owned(), true)));
    heads.push(("Bound".to_owned(), true));
    heads.push(("What it means".to_owned(), false));
    table_head(out, &heads);
    type Pick = fn(&Summary) -> f64;
    let figures: [(&str, Pick, &str); 4] = [
        (
            "Equilibrium residual",
            |run| run.checks.equilibrium_residual,
            "Largest disagreement of displacements, velocities and accelerations with the \
             equations of motion, relative to their largest value.",
        ),
        (
            "Friction excess",
            |run| run.checks.friction_excess,
            "Largest breach of the law of friction, relative to the largest force that friction \
             can hold.",
        ),
        (
            "Energy balance error",
            |run| run.checks.energy_balance_error,
            "Largest difference between the energy put in and the energy accounted for, relative \
             to all energy moved.",
        ),
        (
            "Demands error",
            |run| run.checks.demands_error,
            "Largest difference of a peak, path, time or residual above from the one computed \
             anew, relative to its peak; 1 where a count or the time of an event differs.",
        ),
    ];
    for (name, pick, meaning) in figures {
        out.raw("<tr><th scope=\"row\">").text(name).raw("</th>");
        for (_, run) in &runs {
            let over = run.checks.holds.is_some() && exceeds(pick(run), run.checks.bound);
            out.raw(if over { "<td class=\"number governs\">" } else { "<td class=\"number\">" })
                .text(typeset(&significant(pick(run), 2)))
                .raw("</td>");
        }
        let bound = if checks.holds.is_some() {
            typeset(&rounded(checks.bound, 2))
        } else {
            "none".to_owned()
        };
        out.raw("<td class=\"number\">")
            .text(bound)
            .raw("</td><td>")
            .text(meaning)
            .raw("</td></tr>\n");
    }
    out.raw("</tbody>\n</table>\n");
    match &checks.closest_call {
        Some(call) => out.element(
            "p",
            format!(
                "Closest call: at {} s a decision ({}) would have gone the other way had the \
                 forces or velocities been different by {} of their bound or peak. Below 10⁻⁶ a \
                 slightly different record would tell another story.",
                typeset(&compact(call.time_s)),
                call.decision(),
                printed(call.margin, 2)
            ),
        ),
        None => out.raw(
            "<p>Closest call: none; nothing had to be decided, or the method does not \
                         report it.</p>",
        ),
    };
    if let Some(iterations) = summary.iterations {
        out.element(
            "p",
            format!(
                "Iterations a step: {} in the mean, {} at most.",
                printed(iterations.mean, 3),
                iterations.max
            ),
        );
    }
    out.raw("\n</section>\n");
}
