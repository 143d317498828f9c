//! The answer in a few lines: how far the block slides, what governs, whether the check holds.

use crate::display::{Quantity, Unit};
use crate::number::{compact, count, printed, typeset};
use crate::report::Report;
use crate::summary::Summary;

/// Gap used, governing run and certificate.
pub fn sentences(report: &Report) -> Vec<String> {
    vec![sliding(report), rest(report), certificate(report.summary)]
}

/// The run with the largest sliding displacement, with its name.
fn governing(summary: &Summary) -> (&'static str, &Summary) {
    governing_by(summary, &|run| run.demands.peak_sliding_displacement_m)
}

/// The run in which a demand is largest in size, with its name.
fn governing_by<'a>(
    summary: &'a Summary,
    demand: &dyn Fn(&Summary) -> f64,
) -> (&'static str, &'a Summary) {
    let size = |run: &Summary| demand(run).abs();
    let mut runs = summary.runs();
    // Of equal ones the nominal run.
    runs.sort_by_key(|run| run.0 != "nominal");
    let mut governing = runs[0];
    for run in &runs[1..] {
        if size(run.1) > size(governing.1) {
            governing = *run;
        }
    }
    governing
}

fn with_unit(unit: Unit, si: f64) -> String {
    format!("{} {}", printed(unit.of(si), 4), unit.symbol)
}

fn sliding(report: &Report) -> String {
    let (name, run) = governing(report.summary);
    let d = &run.demands;
    if d.sliding_path_m == 0.0 {
        return "The block does not slide: friction holds it throughout the motion.".to_owned();
    }
    let peak_m = d.peak_sliding_displacement_m;
    let length = report.display.unit(Quantity::Length, peak_m);
    let block = report.summary.names.block.as_deref().unwrap_or("The block");
    let mut text = format!(
        "{block} slides {} at most, at {} s",
        with_unit(length, peak_m),
        printed(d.peak_sliding_displacement_time_s, 4)
    );
    if let (Some(gap_m), Some(ratio)) = (report.model.slider().gap_m(), d.gap_ratio) {
        let gap = report.display.unit(Quantity::Length, gap_m);
        let gap = format!("{} {}", compact(gap.of(gap_m)), gap.symbol);
        let percent = printed(100.0 * ratio, 3);
        text.push_str(&if ratio > 1.0 {
            format!(": {percent} % of its gap of {gap}. The gap is NOT sufficient")
        } else {
            format!(": {percent} % of its gap of {gap}")
        });
    }
    text.push('.');
    if report.summary.bounds.is_some() {
        let mut friction = of_friction(name).to_owned();
        friction[..1].make_ascii_uppercase();
        text.push_str(&match name {
            "nominal" => format!(" {friction} governs."),
            _ => format!(" {friction} (× {}) governs.", compact(run.friction_factor)),
        });
    }
    text
}

/// The friction of a run, by its name.
fn of_friction(name: &str) -> &'static str {
    match name {
        "lower" => "lower-bound friction",
        "upper" => "upper-bound friction",
        _ => "nominal friction",
    }
}

fn rest(report: &Report) -> String {
    let (_, run) = governing(report.summary);
    let d = &run.demands;
    let with = |name: &str| match report.summary.bounds {
        Some(_) => format!(" ({})", of_friction(name)),
        None => String::new(),
    };
    let length = report.display.unit(Quantity::Length, d.peak_sliding_displacement_m);
    let largest = |of: &dyn Fn(&Summary) -> f64| {
        report.summary.runs().into_iter().map(|(_, run)| of(run)).fold(0.0, f64::max)
    };
    let acceleration = |si: f64| with_unit(report.display.unit(Quantity::Acceleration, si), si);
    let block = largest(&|run| run.demands.peak_block_acceleration_m_per_s2);
    let mut text = format!("Peak acceleration of the block {}", acceleration(block));
    if report.model.points() > 0 {
        let floors = |run: &Summary| {
            let points = run.demands.storeys.iter().chain(&run.demands.points);
            let all = points.map(|s| s.peak_acceleration_m_per_s2);
            all.fold(0.0, f64::max)
        };
        let of = if report.model.structure().is_some() { "points" } else { "floors" };
        text.push_str(&format!(", of the {of} {}", acceleration(largest(&floors))));
    }
    text.push_str(&format!(
        "; peak ground acceleration {}.",
        acceleration(report.summary.record.pga_m_per_s2)
    ));
    if d.sliding_path_m > 0.0 {
        let runs = report.summary.runs();
        let sliding = runs.iter().find(|(_, run)| run.demands.sliding_at_end);
        let left = governing_by(report.summary, &|run| run.demands.residual_sliding_displacement_m);
        text.push_str(&match sliding {
            Some((name, _)) => {
                format!(" The block is still sliding at the end of the analysis{}.", with(name))
            }
            None => format!(
                " It comes to rest at {}{}.",
                with_unit(length, left.1.demands.residual_sliding_displacement_m),
                with(left.0)
            ),
        });
    }
    let stop_force = |run: &Summary| run.demands.stop.map_or(0.0, |stop| stop.peak_force_n);
    let stop_speed =
        |run: &Summary| run.demands.stop.map_or(0.0, |stop| stop.peak_impact_speed_m_per_s);
    let hit = match governing_by(report.summary, &stop_force) {
        (_, run) if stop_force(run) == 0.0 => governing_by(report.summary, &stop_speed),
        hit => hit,
    };
    if let Some(stop) = &hit.1.demands.stop {
        let force = report.display.unit(Quantity::Force, stop.peak_force_n);
        text.push_str(&match stop.contact_count {
            0 if stop.peak_impact_speed_m_per_s > 0.0 => {
                let speed = report.display.unit(Quantity::Velocity, stop.peak_impact_speed_m_per_s);
                format!(
                    " The block strikes the rigid stops at {} or slower{}.",
                    with_unit(speed, stop.peak_impact_speed_m_per_s),
                    with(hit.0)
                )
            }
            0 => " The stops are not reached.".to_owned(),
            n => format!(
                " The stops are reached {} times, with a force of {} at most{}.",
                count(n),
                with_unit(force, stop.peak_force_n),
                with(hit.0)
            ),
        });
    }
    text
}

/// One sentence on the independent check.
pub fn certificate(summary: &Summary) -> String {
    let figures = |run: &Summary| {
        let c = &run.checks;
        let all =
            [c.equilibrium_residual, c.friction_excess, c.energy_balance_error, c.demands_error];
        all.into_iter().fold(0.0, f64::max)
    };
    let largest = summary.runs().into_iter().map(|(_, run)| figures(run)).fold(0.0, f64::max);
    match summary.checks.holds {
        Some(_) if summary.check_failed() => "Certificate: NOT CONFIRMED. An independent check \
             disagrees with this response. Do not use it."
            .to_owned(),
        Some(_) => format!(
            "Certificate: confirmed. An independent check of equilibrium, friction, energy and \
             every peak agrees to {} (limit {}).",
            printed(largest, 2),
            typeset(&crate::number::rounded(summary.checks.bound, 2))
        ),
        None => "Certificate: none. The stepwise method is approximate; its errors are reported, \
                 not judged."
            .to_owned(),
    }
}
