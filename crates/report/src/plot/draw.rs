//! From figures to SVG.

use super::{Axis, Figure, Layout, Limit, NARROW, Panel, PlotSeries, Shape, Style, Tick, thin};
use crate::markup::Markup;
use crate::number::trimmed;
use slipstick::assessment::outline;

const TEXT: f64 = 11.0;
const SMALL: f64 = 10.0;
const LINE: f64 = 15.0;
const TICK: f64 = 4.0;
const INK: &str = "#1a1a1a";
const FRAME: &str = "#7a7a7a";
const GRID: &str = "#d4d4d4";
const SHADE: &str = "#e6e6e6";
const BETWEEN_PANELS: f64 = 10.0;
/// Space right of a frame: half of the last tick label of the x axis.
const RIGHT: f64 = 18.0;

/// A rectangle of the drawing.
#[derive(Clone, Copy)]
struct Frame {
    left: f64,
    top: f64,
    width: f64,
    height: f64,
}

impl Frame {
    fn x(&self, axis: &Axis, value: f64) -> f64 {
        self.left + self.width * axis.fraction(value)
    }

    fn y(&self, axis: &Axis, value: f64) -> f64 {
        self.top + self.height * (1.0 - axis.fraction(value))
    }

    fn bottom(&self) -> f64 {
        self.top + self.height
    }

    fn right(&self) -> f64 {
        self.left + self.width
    }
}

/// The element of a width and its height.
pub fn figure(figure: &Figure, width: f64) -> (Markup, f64) {
    let mut body = Markup::new();
    let height = match figure.layout {
        Layout::Stacked => stacked(&mut body, figure, width),
        Layout::Beside | Layout::Square if width > NARROW => {
            beside(&mut body, figure, width, figure.panels.len())
        }
        Layout::Beside | Layout::Square => beside(&mut body, figure, width, 1),
    };
    let mut svg = Markup::new();
    svg.raw("<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\"")
        .attribute("viewBox", format!("0 0 {width} {}", trimmed(height, 1)))
        .attribute("aria-labelledby", format!("{0}-title {0}-desc", figure.id))
        .attribute("font-family", "Helvetica, Arial, Liberation Sans, sans-serif")
        .attribute("font-size", TEXT)
        .attribute("fill", INK)
        .raw(">\n<title")
        .attribute("id", format!("{}-title", figure.id))
        .raw(">")
        .text(&figure.title)
        .raw("</title>\n<desc")
        .attribute("id", format!("{}-desc", figure.id))
        .raw(">")
        .text(&figure.description)
        .raw("</desc>\n")
        .append(&body)
        .raw("</svg>\n");
    (svg, height)
}

fn stacked(out: &mut Markup, figure: &Figure, whole: f64) -> f64 {
    // One left edge for all panels, so that their times stand below each other.
    let left = figure.panels.iter().map(left_margin).fold(0.0, f64::max);
    let mut top = 0.0;
    for (i, panel) in figure.panels.iter().enumerate() {
        let width = whole - left - RIGHT;
        let frame =
            Frame { left, top: top + header_height(panel, width), width, height: panel.height };
        let lowest = i + 1 == figure.panels.len();
        draw_panel(out, panel, frame, &figure.shaded, lowest);
        top = frame.bottom() + if lowest { 0.0 } else { BETWEEN_PANELS };
    }
    top + x_axis_height()
}

/// Panels in rows of so many, each with an x axis of its own.
fn beside(out: &mut Markup, figure: &Figure, whole: f64, columns: usize) -> f64 {
    let columns = columns.max(1);
    let share = whole / columns as f64;
    let mut bottom: f64 = 0.0;
    for (row, panels) in figure.panels.chunks(columns).enumerate() {
        let top = if row == 0 { 0.0 } else { bottom + x_axis_height() + BETWEEN_PANELS };
        let widths = panels.iter().map(|panel| share - left_margin(panel) - RIGHT);
        let headers = panels.iter().zip(widths.clone());
        let headers = headers.map(|(panel, width)| header_height(panel, width));
        let top = top + headers.fold(0.0, f64::max);
        for (i, (panel, width)) in panels.iter().zip(widths).enumerate() {
            let left = i as f64 * share + left_margin(panel);
            let height = if figure.layout == Layout::Square { width } else { panel.height };
            let frame = Frame { left, top, width, height };
            draw_panel(out, panel, frame, &figure.shaded, true);
            bottom = bottom.max(frame.bottom());
        }
    }
    bottom + x_axis_height()
}

fn x_axis_height() -> f64 {
    TICK + 2.0 * LINE + 4.0
}

fn draw_panel(out: &mut Markup, panel: &Panel, frame: Frame, shaded: &[[f64; 2]], x_labels: bool) {
    let histories = panel.series.iter().any(is_read);
    if histories {
        open_read(out, panel, frame);
    }
    header(out, panel, frame);
    shading(out, &panel.x, frame, shaded);
    grid(out, panel, frame, x_labels);
    let clipped = leaves_frame(panel);
    if clipped {
        // An element of its own shows nothing outside of its place.
        out.raw("<svg");
        let Frame { left, top, width, height } = frame;
        let view = [left, top, width, height].map(|value| trimmed(value, 1)).join(" ");
        place(out, frame).attribute("viewBox", view).raw(">\n");
    }
    for series in &panel.series {
        draw_series(out, panel, series, frame);
    }
    if clipped {
        out.raw("</svg>\n");
    }
    for limit in &panel.limits {
        draw_limit(out, panel, limit, frame);
    }
    if let Some([x, y]) = panel.peak {
        out.raw("<circle r=\"3.2\" fill=\"none\" stroke=\"#a3161c\" stroke-width=\"1.1\"")
            .attribute("cx", trimmed(frame.x(&panel.x, x), 1))
            .attribute("cy", trimmed(frame.y(&panel.y, y), 2))
            .raw("/>\n");
    }
    out.raw("<rect fill=\"none\" stroke-width=\"0.8\"").attribute("stroke", FRAME);
    place(out, frame).raw("/>\n").raw(if histories { "</g>\n" } else { "" });
}

/// Whether the values of a line can be read off under a pointer: it is a function of x.
fn is_read(series: &PlotSeries) -> bool {
    matches!(series.shape, Shape::History | Shape::Area(_))
}

/// Opens the group of a panel whose lines can be read off, with its frame and its axes.
fn open_read(out: &mut Markup, panel: &Panel, frame: Frame) {
    let axis = |axis: &Axis| format!("{} {} {}", axis.min, axis.max, u8::from(axis.logarithmic));
    let Frame { left, top, width, height } = frame;
    let frame = [left, top, width, height].map(|value| trimmed(value, 1)).join(" ");
    out.raw("<g").attribute("data-frame", frame).attribute("data-x", axis(&panel.x));
    out.attribute("data-y", axis(&panel.y)).attribute("data-label", &panel.x.label);
    out.attribute("data-quantity", &panel.y.label).raw(">\n");
}

/// Whether a line goes on above or below the frame.
fn leaves_frame(panel: &Panel) -> bool {
    let beyond = |value: f64| value < panel.y.min || value > panel.y.max;
    panel.series.iter().any(|series| series.points.iter().any(|point| beyond(point[1])))
}

/// Place and size of a rectangle.
fn place(out: &mut Markup, frame: Frame) -> &mut Markup {
    out.attribute("x", trimmed(frame.left, 1))
        .attribute("y", trimmed(frame.top, 1))
        .attribute("width", trimmed(frame.width, 1))
        .attribute("height", trimmed(frame.height, 1))
}

// Text above the frame: the label of the y axis, the legend and the note.

/// An entry of the legend: a sample of a line or an area, or none, and its text.
struct Entry<'a> {
    sample: Option<&'a PlotSeries>,
    text: &'a str,
}

const SAMPLE: f64 = 26.0;
const ENTRY_GAP: f64 = 14.0;

impl Entry<'_> {
    fn width(&self) -> f64 {
        text_width(self.text, SMALL) + if self.sample.is_some() { SAMPLE + 4.0 } else { 0.0 }
    }
}

fn entries(panel: &Panel) -> Vec<Entry<'_>> {
    let in_legend = |series: &&PlotSeries| !series.label.is_empty() && series.shape != Shape::Named;
    let named = panel.series.iter().filter(in_legend);
    let mut entries: Vec<Entry> =
        named.map(|series| Entry { sample: Some(series), text: &series.label }).collect();
    if !panel.note.is_empty() {
        entries.push(Entry { sample: None, text: &panel.note });
    }
    entries
}

/// Entries row by row; the first row is what is left beside the label of the axis.
fn legend_rows<'a>(panel: &'a Panel, width: f64) -> Vec<Vec<Entry<'a>>> {
    let mut rows: Vec<Vec<Entry>> = vec![Vec::new()];
    let mut left = width - text_width(&panel.y.label, TEXT);
    for entry in entries(panel) {
        let needed = entry.width() + ENTRY_GAP;
        if needed > left {
            rows.push(Vec::new());
            left = width;
        }
        left -= needed;
        if let Some(row) = rows.last_mut() {
            row.push(entry);
        }
    }
    rows
}

fn header_height(panel: &Panel, width: f64) -> f64 {
    legend_rows(panel, width).len() as f64 * LINE + 3.0
}

fn header(out: &mut Markup, panel: &Panel, frame: Frame) {
    let rows = legend_rows(panel, frame.width);
    let first = frame.top - 6.0 - (rows.len() - 1) as f64 * LINE;
    label(out, &panel.y.label, frame.left, first, "start", TEXT);
    for (i, row) in rows.iter().enumerate() {
        let y = first + i as f64 * LINE;
        let total: f64 = row.iter().map(|entry| entry.width() + ENTRY_GAP).sum();
        let mut x = frame.right() - total + ENTRY_GAP;
        for entry in row {
            let mut text_x = x;
            if let Some(series) = entry.sample {
                sample(out, series, x, y - 0.35 * SMALL);
                text_x += SAMPLE + 4.0;
            }
            // The note ends at the frame, whatever the true width of its letters.
            if entry.sample.is_none() {
                label(out, entry.text, frame.right(), y, "end", SMALL);
            } else {
                label(out, entry.text, text_x, y, "start", SMALL);
            }
            x += entry.width() + ENTRY_GAP;
        }
    }
}

fn sample(out: &mut Markup, series: &PlotSeries, x: f64, y: f64) {
    if let Shape::Dots(fill) = series.shape {
        dot(out, series.style, fill, [x + 0.5 * SAMPLE, y]);
    } else if let Shape::Area(fill) | Shape::Band(fill) = series.shape {
        out.raw("<rect height=\"9\" stroke-width=\"0.6\"")
            .attribute("stroke", INK)
            .attribute("fill", fill)
            .attribute("x", trimmed(x + 8.0, 1))
            .attribute("y", trimmed(y - 4.5, 1))
            .attribute("width", trimmed(SAMPLE - 8.0, 1))
            .raw("/>");
    } else {
        out.raw("<path");
        stroke(out, series.style);
        out.attribute("d", format!("M{} {}h{SAMPLE}", trimmed(x, 1), trimmed(y, 1))).raw("/>");
    }
}

fn label(out: &mut Markup, text: &str, x: f64, y: f64, anchor: &'static str, size: f64) {
    out.raw("<text").attribute("x", trimmed(x, 1)).attribute("y", trimmed(y, 1));
    if anchor != "start" {
        out.attribute("text-anchor", anchor);
    }
    if size != TEXT {
        out.attribute("font-size", size);
    }
    out.raw(">").text(text).raw("</text>\n");
}

/// A bound on the width of a text; letters of the fonts asked for average half their size.
fn text_width(text: &str, size: f64) -> f64 {
    0.56 * size * text.chars().count() as f64
}

// Ticks, grid and shading.

fn y_ticks(panel: &Panel) -> Vec<Tick> {
    panel.y.ticks(((panel.height / 34.0).round() as usize).max(3))
}

fn left_margin(panel: &Panel) -> f64 {
    let widest = y_ticks(panel)
        .iter()
        .map(|tick| text_width(&tick.label, SMALL))
        .fold(text_width("−0.000", SMALL), f64::max);
    widest + TICK + 6.0
}

fn grid(out: &mut Markup, panel: &Panel, frame: Frame, x_labels: bool) {
    let x_ticks = apart(panel.x.ticks((frame.width / 60.0) as usize), &panel.x, frame);
    let y_ticks = y_ticks(panel);
    let mut lines = String::new();
    for tick in &x_ticks {
        let x = trimmed(frame.x(&panel.x, tick.value), 1);
        lines.push_str(&format!("M{x} {}v{}", trimmed(frame.top, 1), trimmed(frame.height, 1)));
    }
    for tick in &y_ticks {
        let y = trimmed(frame.y(&panel.y, tick.value), 1);
        lines.push_str(&format!("M{} {y}h{}", trimmed(frame.left, 1), trimmed(frame.width, 1)));
    }
    out.raw("<path fill=\"none\" stroke-width=\"0.5\"")
        .attribute("stroke", GRID)
        .attribute("d", lines)
        .raw("/>\n");
    for tick in y_ticks.iter().filter(|tick| !tick.label.is_empty()) {
        let y = frame.y(&panel.y, tick.value) + 0.35 * SMALL;
        label(out, &tick.label, frame.left - TICK, y, "end", SMALL);
    }
    if panel.y.min < 0.0 && panel.y.max > 0.0 {
        let y = trimmed(frame.y(&panel.y, 0.0), 1);
        out.raw("<path fill=\"none\" stroke-width=\"0.7\"")
            .attribute("stroke", FRAME)
            .attribute("d", format!("M{} {y}h{}", trimmed(frame.left, 1), trimmed(frame.width, 1)))
            .raw("/>\n");
    }
    if x_labels {
        let y = frame.bottom() + TICK + SMALL;
        for tick in x_ticks.iter().filter(|tick| !tick.label.is_empty()) {
            label(out, &tick.label, frame.x(&panel.x, tick.value), y, "middle", SMALL);
        }
        let middle = frame.left + 0.5 * frame.width;
        label(out, &panel.x.label, middle, y + LINE + 1.0, "middle", TEXT);
    }
}

/// Ticks of the x axis whose labels leave room for each other: powers of ten stay before others.
fn apart(mut ticks: Vec<Tick>, axis: &Axis, frame: Frame) -> Vec<Tick> {
    let is_decade = |tick: &Tick| {
        let digits = tick.label.trim_matches(['0', '.']);
        axis.logarithmic && digits == "1"
    };
    let reach = |tick: &Tick| {
        let (x, half) = (frame.x(axis, tick.value), 0.5 * text_width(&tick.label, SMALL));
        [x - half, x + half]
    };
    let mut placed: Vec<[f64; 2]> = Vec::new();
    for decades in [true, false] {
        for tick in ticks.iter_mut().filter(|tick| is_decade(tick) == decades) {
            let [left, right] = reach(tick);
            if tick.label.is_empty() {
                continue;
            }
            if placed.iter().any(|other| left < other[1] + 2.0 && other[0] < right + 2.0) {
                tick.label.clear();
            } else {
                placed.push([left, right]);
            }
        }
    }
    ticks
}

/// All intervals as one path; those less than a third of a pixel apart are joined.
fn shading(out: &mut Markup, x: &Axis, frame: Frame, shaded: &[[f64; 2]]) {
    let mut joined: Vec<[f64; 2]> = Vec::new();
    for interval in shaded {
        let [from, to] = interval.map(|value| frame.x(x, value).clamp(frame.left, frame.right()));
        // The shortest slip still shows.
        let to = to.max(from + 0.2);
        match joined.last_mut() {
            Some(last) if from - last[1] < 0.34 => last[1] = last[1].max(to),
            _ => joined.push([from, to]),
        }
    }
    if joined.is_empty() {
        return;
    }
    let mut path = String::new();
    for [from, to] in joined {
        let (x, y) = (trimmed(from, 1), trimmed(frame.top, 1));
        let (w, h) = (trimmed((to - from).max(0.1), 1), trimmed(frame.height, 1));
        path.push_str(&format!("M{x} {y}h{w}v{h}h-{w}z"));
    }
    out.raw("<path").attribute("fill", SHADE).attribute("d", path).raw("/>\n");
}

// Lines.

fn stroke(out: &mut Markup, style: Style) {
    out.attribute("fill", "none")
        .attribute("stroke", style.colour)
        .attribute("stroke-width", style.width)
        .attribute("stroke-linejoin", "round");
    if !style.dashes.is_empty() {
        out.attribute("stroke-dasharray", style.dashes);
    }
}

fn draw_series(out: &mut Markup, panel: &Panel, series: &PlotSeries, frame: Frame) {
    let placed: Vec<[f64; 2]> = series
        .points
        .iter()
        .filter(|point| point.iter().all(|value| value.is_finite()))
        .map(|&[x, y]| [frame.x(&panel.x, x), frame.y(&panel.y, y)])
        .collect();
    if placed.is_empty() {
        return;
    }
    if let Shape::Area(fill) = series.shape {
        let base = trimmed(frame.y(&panel.y, 0.0_f64.max(panel.y.min)), 2);
        let (first, last) = (trimmed(placed[0][0], 1), trimmed(placed[placed.len() - 1][0], 1));
        let top = history_path(&placed);
        out.raw("<path stroke=\"none\"")
            .attribute("fill", fill)
            .attribute("d", format!("{top}L{last} {base}L{first} {base}z"))
            .raw("/>\n");
    }
    let path = match series.shape {
        Shape::History | Shape::Area(_) => history_path(&placed),
        Shape::Curve => curve_path(&placed),
        Shape::Band(fill) => {
            let path = format!("{}z", polygon_path(&placed));
            out.raw("<path stroke=\"none\"")
                .attribute("fill", fill)
                .attribute("d", path)
                .raw("/>\n");
            return;
        }
        Shape::Dots(fill) => {
            for at in placed {
                dot(out, series.style, fill, at);
            }
            return;
        }
        Shape::Named => {
            // As wide as the gaps between letters: a line below does not show in them.
            out.raw("<g paint-order=\"stroke\" stroke=\"#fff\" stroke-width=\"6\" stroke-linejoin=\"round\"")
                .attribute("fill", series.style.colour)
                .raw(">");
            let half = 0.5 * text_width(&series.label, SMALL);
            for [x, y] in placed {
                // Inside the frame, whole.
                let x = x.clamp(frame.left + half + 2.0, frame.right() - half - 2.0);
                let y = (y + 0.35 * SMALL).clamp(frame.top + SMALL, frame.bottom() - 3.0);
                label(out, &series.label, x, y, "middle", SMALL);
            }
            out.raw("</g>\n");
            return;
        }
    };
    out.raw("<path");
    if is_read(series) {
        out.attribute("data-line", &series.label);
    }
    stroke(out, series.style);
    out.attribute("d", path).raw("/>\n");
}

/// A point of a series, as wide as three strokes.
fn dot(out: &mut Markup, style: Style, fill: &'static str, [x, y]: [f64; 2]) {
    out.raw("<circle")
        .attribute("cx", trimmed(x, 1))
        .attribute("cy", trimmed(y, 2))
        .attribute("r", trimmed(0.8 + 1.6 * style.width, 1))
        .attribute("fill", fill)
        .attribute("stroke", style.colour)
        .raw(" stroke-width=\"0.8\"/>\n");
}

fn polygon_path(placed: &[[f64; 2]]) -> String {
    let mut path = String::with_capacity(12 * placed.len());
    for (i, [x, y]) in placed.iter().enumerate() {
        path.push_str(if i == 0 { "M" } else { "L" });
        path.push_str(&format!("{} {}", trimmed(*x, 1), trimmed(*y, 2)));
    }
    path
}

fn history_path(placed: &[[f64; 2]]) -> String {
    let ys: Vec<f64> = placed.iter().map(|point| point[1]).collect();
    let kept = outline::shown(&ys, |i| libm::floor(placed[i][0]) as i64);
    let mut path = String::with_capacity(12 * kept.len());
    for (i, &index) in kept.iter().enumerate() {
        let [x, y] = placed[index];
        path.push_str(match i {
            0 => "M",
            1 => "L",
            _ => " ",
        });
        path.push_str(&trimmed(x, 1));
        path.push(' ');
        path.push_str(&trimmed(y, 2));
    }
    path
}

fn curve_path(placed: &[[f64; 2]]) -> String {
    let mut path = String::new();
    for line in thin::curve(placed) {
        for (i, point) in line.iter().enumerate() {
            path.push_str(match i {
                0 => "M",
                1 => "L",
                _ => " ",
            });
            let [x, y] = point.map(|hundredths| trimmed(hundredths as f64 / 100.0, 2));
            path.push_str(&format!("{x} {y}"));
        }
    }
    path
}

fn draw_limit(out: &mut Markup, panel: &Panel, limit: &Limit, frame: Frame) {
    let y = frame.y(&panel.y, limit.value);
    if !(frame.top..=frame.bottom()).contains(&y) {
        return;
    }
    out.raw("<path");
    stroke(out, limit.style);
    let (x, w) = (trimmed(frame.left, 1), trimmed(frame.width, 1));
    out.attribute("d", format!("M{x} {}h{w}", trimmed(y, 2))).raw("/>\n");
    if limit.label.is_empty() {
        return;
    }
    // Outwards of the line where there is room, else inwards.
    let upper = y < frame.top + 0.5 * frame.height;
    let above = if upper { y - frame.top > LINE } else { frame.bottom() - y <= LINE };
    let baseline = if above { y - 3.5 } else { y + SMALL + 1.0 };
    out.raw("<g paint-order=\"stroke\" stroke=\"#fff\" stroke-width=\"3\">");
    label(out, &limit.label, frame.right() - 4.0, baseline, "end", SMALL);
    out.raw("</g>\n");
}
