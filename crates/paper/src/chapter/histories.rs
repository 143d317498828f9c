//! The paper's figures 3–6 and 9–12, drawn anew: table, block and storey, both solvers.

use super::graphs::{self, panel};
use crate::DrawnTest;
use slipstick::response::{History, Response};

use slipstick_report::plot::{Axis, Figure, Layout, Panel, PlotSeries, Shape, Style};

/// The table: grey and thin, below the others.
const TABLE: Style = Style { colour: "#9a9a9a", width: 1.0, dashes: "" };
/// The exact response.
const EXACT: Style = Style { colour: "#0b3c6f", width: 1.6, dashes: "" };
/// The stepwise response, on top.
const STEPWISE: Style = Style { colour: "#d8641c", width: 1.1, dashes: "4 3" };

/// The identifier of a figure and its file.
fn id(figure: u32) -> &'static str {
    match figure {
        3 => "paper-figure-3",
        4 => "paper-figure-4",
        5 => "paper-figure-5",
        6 => "paper-figure-6",
        9 => "paper-figure-9",
        10 => "paper-figure-10",
        11 => "paper-figure-11",
        _ => "paper-figure-12",
    }
}

/// One figure in the layout of the paper: (a) table and block acceleration, (b) sliding
/// displacement; with a storey (b) its acceleration, (c) sliding, (d) its displacement.
pub fn drawn(test: &DrawnTest) -> Figure {
    let storey = test.exact.demands.storeys.len() == 1;
    let mut panels =
        vec![accelerations(test, "(a) Acceleration of table and block (m/s²)", |h, i| {
            h.block_acceleration_m_per_s2[i]
        })];
    if storey {
        panels.push(accelerations(test, "(b) Acceleration of table and storey (m/s²)", |h, i| {
            h.storey_acceleration_m_per_s2[i]
        }));
    }
    let letter = if storey { "(c)" } else { "(b)" };
    panels.push(displacement(
        test,
        &format!("{letter} Sliding displacement U − X1 (mm)"),
        |h, i| -1e3 * h.sliding_displacement_m[i],
    ));
    if storey {
        panels.push(displacement(
            test,
            "(d) Displacement of the storey on the block (mm)",
            |h, i| 1e3 * h.storey_displacement_m[i],
        ));
    }
    let (name, number) = (&test.name, test.figure);
    graphs::figure(
        id(number),
        Layout::Stacked,
        format!("Figure {number} of the paper: {name}"),
        format!("{name}, exact and stepwise, in the layout of the paper's figure {number}."),
        panels,
    )
}

fn points(
    test: &DrawnTest,
    history: &History,
    value: impl Fn(&History, usize) -> f64,
) -> Vec<[f64; 2]> {
    let [from_s, to_s] = test.window_s;
    let inside = |i: &usize| (from_s..=to_s).contains(&history.time_s[*i]);
    (0..history.len()).filter(inside).map(|i| [history.time_s[i], value(history, i)]).collect()
}

/// Exact and, where there is one, stepwise.
fn responses(test: &DrawnTest, value: impl Fn(&History, usize) -> f64 + Copy) -> Vec<PlotSeries> {
    let line = |response: &Response, label: &str, style: Style| {
        let history = response.history.as_ref()?;
        let points = points(test, history, value);
        Some(PlotSeries { label: label.to_owned(), style, shape: Shape::History, points })
    };
    let stepwise = test.stepwise.as_ref().and_then(|r| line(r, "stepwise", STEPWISE));
    line(&test.exact, "exact", EXACT).into_iter().chain(stepwise).collect()
}

fn accelerations(
    test: &DrawnTest,
    label: &str,
    value: impl Fn(&History, usize) -> f64 + Copy,
) -> Panel {
    let mut series = Vec::new();
    if let Some(history) = &test.exact.history {
        let points = points(test, history, |h, i| h.table_acceleration_m_per_s2[i]);
        let label = "table".to_owned();
        series.push(PlotSeries { label, style: TABLE, shape: Shape::History, points });
    }
    series.extend(responses(test, value));
    over_time(test, label, series, Axis::symmetric)
}

fn displacement(
    test: &DrawnTest,
    label: &str,
    value: impl Fn(&History, usize) -> f64 + Copy,
) -> Panel {
    over_time(test, label, responses(test, value), Axis::covering)
}

fn over_time(
    test: &DrawnTest,
    label: &str,
    series: Vec<PlotSeries>,
    axis: fn(String, Vec<f64>) -> Axis,
) -> Panel {
    let values = graphs::values(&series).chain([0.0]).collect();
    let [from_s, to_s] = test.window_s;
    let y = axis(label.to_owned(), values);
    panel(Axis::linear("Time (s)", from_s, to_s), y, 110.0, series, Vec::new())
}
