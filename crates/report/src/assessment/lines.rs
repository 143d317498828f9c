//! Lines that all figures of many runs share.

use slipstick::assessment::SHARES;

use crate::figures::Drawn;
use crate::plot::{Axis, Figure, Layout, Panel, PlotSeries, Shape, Style};

/// Styles of groups: they differ by dash and width, not only by colour.
pub const GROUPS: [Style; 6] = [
    Style { colour: "#0b3c6f", width: 1.6, dashes: "" },
    Style { colour: "#b3541e", width: 1.6, dashes: "7 3" },
    Style { colour: "#1a1a1a", width: 1.5, dashes: "1.4 2.6" },
    Style { colour: "#3f7d4e", width: 2.6, dashes: "" },
    Style { colour: "#6a4c93", width: 1.6, dashes: "10 3 2 3" },
    Style { colour: "#6b6b6b", width: 2.6, dashes: "4 3" },
];

/// The style of a group by its place: after the first six their colours with the dashes and width of others, so that no
/// two of 36 are drawn alike.
pub fn group_style(place: usize) -> Style {
    let count = GROUPS.len();
    let Style { width, dashes, .. } = GROUPS[(place + place / count) % count];
    Style { width, dashes, ..GROUPS[place % count] }
}

/// A single record of a suite.
pub const RECORD: Style = Style { colour: "#767676", width: 0.5, dashes: "" };

/// The fill between two fractiles.
pub const BAND: &str = "#dde5ee";

/// Styles of the fractiles of 16, 50 and 84 %.
pub const FRACTILES: [Style; 3] = [
    Style { colour: "#1a1a1a", width: 1.3, dashes: "2 2.5" },
    Style { colour: "#0b3c6f", width: 2.0, dashes: "" },
    Style { colour: "#b3541e", width: 1.4, dashes: "7 3" },
];

/// `16 %`, `median`, `84 %`.
pub fn share_names() -> [String; 3] {
    SHARES.map(
        |share| if share == 0.5 { "median".to_owned() } else { format!("{} %", 100.0 * share) },
    )
}

pub fn line(label: impl Into<String>, style: Style, points: Vec<[f64; 2]>) -> PlotSeries {
    PlotSeries { label: label.into(), style, shape: Shape::Curve, points }
}

/// A quantity over x, which does not decrease.
pub fn over_x(label: impl Into<String>, style: Style, points: Vec<[f64; 2]>) -> PlotSeries {
    PlotSeries { label: label.into(), style, shape: Shape::History, points }
}

/// Separate points, filled in a colour.
pub fn dots(
    label: impl Into<String>,
    style: Style,
    fill: &'static str,
    points: Vec<[f64; 2]>,
) -> PlotSeries {
    PlotSeries { label: label.into(), style, shape: Shape::Dots(fill), points }
}

/// Points along lower and back along upper values, where both are finite.
pub fn band(
    x: &[f64],
    low: &[f64],
    high: &[f64],
    label: impl Into<String>,
    fill: &'static str,
) -> PlotSeries {
    let both = |i: &usize| low[*i].is_finite() && high[*i].is_finite();
    let kept: Vec<usize> = (0..x.len()).filter(both).collect();
    let lower = kept.iter().map(|&i| [x[i], low[i]]);
    let upper = kept.iter().rev().map(|&i| [x[i], high[i]]);
    let points = lower.chain(upper).collect();
    PlotSeries { label: label.into(), style: Style::MAIN, shape: Shape::Band(fill), points }
}

/// A curve cut off where x or y passes the end of its axis, at the axis itself; what is not finite
/// ends it.
pub fn clipped(points: &[[f64; 2]], [x_end, y_end]: [f64; 2]) -> Vec<[f64; 2]> {
    let mut kept: Vec<[f64; 2]> = Vec::new();
    for &[x, y] in points {
        if !(x.is_finite() && y.is_finite()) {
            break;
        }
        if x <= x_end && y <= y_end {
            kept.push([x, y]);
            continue;
        }
        if let Some(&[x0, y0]) = kept.last() {
            let part = ((x_end - x0) / (x - x0)).min(if y > y0 {
                (y_end - y0) / (y - y0)
            } else {
                f64::INFINITY
            });
            let part = if x > x0 { part } else { (y_end - y0) / (y - y0) };
            if part.is_finite() {
                kept.push([x0 + part * (x - x0), y0 + part * (y - y0)]);
            }
        }
        break;
    }
    kept
}

/// A figure of one panel.
pub fn single(id: &str, title: &str, caption: String, panel: Panel) -> Drawn {
    stacked(id, title, caption, vec![panel])
}

/// A figure of panels one above the other.
pub fn stacked(id: &str, title: &str, caption: String, panels: Vec<Panel>) -> Drawn {
    laid(Layout::Stacked, (id, title), caption, panels)
}

/// A figure of panels laid out in another way: its identifier and title, its caption.
pub fn laid(
    layout: Layout,
    (id, title): (&str, &str),
    caption: String,
    panels: Vec<Panel>,
) -> Drawn {
    let (title, description, shaded) = (title.to_owned(), caption.clone(), Vec::new());
    let figure = Figure { id: id.to_owned(), title, description, layout, panels, shaded };
    Drawn::new(figure, caption)
}

/// A panel without limits or notes.
pub fn panel(x: Axis, y: Axis, height: f64, series: Vec<PlotSeries>) -> Panel {
    Panel { x, y, height, series, limits: Vec::new(), peak: None, note: String::new() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_of_36_groups_are_drawn_alike() {
        let styles: Vec<Style> = (0..36).map(group_style).collect();
        assert_eq!(styles[..6], GROUPS);
        for (i, style) in styles.iter().enumerate() {
            assert!(!styles[..i].contains(style), "{i}");
        }
    }
}
