//! Drawings as data, for the page to draw them itself: to its width, in its colours, zoomed.

use slipstick_report::figures::Drawn;
use slipstick_report::json::{Serialize, each};
use slipstick_report::plot::{Axis, Layout, Limit, Panel, PlotSeries, Shape, Style};
use slipstick_report::view;

/// `{id, caption, title, layout, panels, shaded}`; points as x, y, x, y …, null where a value is none.
pub fn alive(drawn: &Drawn) -> impl Serialize {
    let figure = &drawn.figure;
    let layout = match figure.layout {
        Layout::Stacked => "stacked",
        Layout::Beside => "beside",
        Layout::Square => "square",
    };
    view! {
        id: &figure.id,
        caption: &drawn.caption,
        title: &figure.title,
        layout,
        panels: each(&figure.panels, panel),
        shaded: &figure.shaded,
    }
}

fn panel(panel: &Panel) -> impl Serialize {
    view! {
        x: axis(&panel.x),
        y: axis(&panel.y),
        height: panel.height,
        series: each(&panel.series, series),
        limits: each(&panel.limits, limit),
        peak: panel.peak,
        note: &panel.note,
    }
}

fn axis(axis: &Axis) -> impl Serialize {
    view! {
        label: &axis.label,
        min: axis.min,
        max: axis.max,
        log: axis.logarithmic,
        names: &axis.names,
    }
}

fn series(series: &PlotSeries) -> impl Serialize {
    let (shape, fill) = match series.shape {
        Shape::History => ("history", ""),
        Shape::Area(fill) => ("area", fill),
        Shape::Curve => ("curve", ""),
        Shape::Band(fill) => ("band", fill),
        Shape::Dots(fill) => ("dots", fill),
        Shape::Named => ("named", ""),
    };
    view! {
        label: &series.label,
        #[serde(flatten)] style: style(series.style),
        shape,
        fill,
        points: series.points.as_flattened(),
    }
}

fn limit(limit: &Limit) -> impl Serialize {
    view! {
        value: limit.value,
        label: &limit.label,
        #[serde(flatten)] style: style(limit.style),
    }
}

fn style(style: Style) -> impl Serialize {
    view! { colour: style.colour, width: style.width, dashes: style.dashes }
}
