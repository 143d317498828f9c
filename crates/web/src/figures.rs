//! Drawings as data, for the page to draw them itself: to its width, in its colours, zoomed.

use slipstick_report::figures::Drawn;
use slipstick_report::json::Json;
use slipstick_report::plot::{Axis, Layout, Limit, Panel, Series, Shape, Style};

use crate::session::texts;

/// `{id, caption, title, layout, panels, shaded}`; points as x, y, x, y …, null where a value is none.
pub fn alive(drawn: &Drawn) -> Json {
    let figure = &drawn.figure;
    let layout = match figure.layout {
        Layout::Stacked => "stacked",
        Layout::Beside => "beside",
        Layout::Square => "square",
    };
    Json::Object(vec![
        ("id", figure.id.as_str().into()),
        ("caption", drawn.caption.as_str().into()),
        ("title", figure.title.as_str().into()),
        ("layout", layout.into()),
        ("panels", Json::List(figure.panels.iter().map(panel).collect())),
        ("shaded", Json::List(figure.shaded.iter().map(|ends| numbers(ends)).collect())),
    ])
}

fn panel(panel: &Panel) -> Json {
    Json::Object(vec![
        ("x", axis(&panel.x)),
        ("y", axis(&panel.y)),
        ("height", panel.height.into()),
        ("series", Json::List(panel.series.iter().map(series).collect())),
        ("limits", Json::List(panel.limits.iter().map(limit).collect())),
        ("peak", panel.peak.map_or(Json::Null, |peak| numbers(&peak))),
        ("note", panel.note.as_str().into()),
    ])
}

fn axis(axis: &Axis) -> Json {
    Json::Object(vec![
        ("label", axis.label.as_str().into()),
        ("min", axis.min.into()),
        ("max", axis.max.into()),
        ("log", axis.logarithmic.into()),
        ("names", texts(axis.names.iter().map(String::as_str))),
    ])
}

fn series(series: &Series) -> Json {
    let (shape, fill) = match series.shape {
        Shape::History => ("history", ""),
        Shape::Area(fill) => ("area", fill),
        Shape::Curve => ("curve", ""),
        Shape::Band(fill) => ("band", fill),
        Shape::Dots(fill) => ("dots", fill),
        Shape::Named => ("named", ""),
    };
    let mut keys = vec![("label", Json::from(series.label.as_str()))];
    keys.extend(style(series.style));
    let points: Vec<f64> = series.points.iter().flatten().copied().collect();
    keys.extend([("shape", shape.into()), ("fill", fill.into()), ("points", numbers(&points))]);
    Json::Object(keys)
}

fn limit(limit: &Limit) -> Json {
    let mut keys = vec![("value", Json::from(limit.value)), ("label", limit.label.as_str().into())];
    keys.extend(style(limit.style));
    Json::Object(keys)
}

fn style(style: Style) -> [(&'static str, Json); 3] {
    [
        ("colour", style.colour.into()),
        ("width", style.width.into()),
        ("dashes", style.dashes.into()),
    ]
}

fn numbers(values: &[f64]) -> Json {
    Json::List(values.iter().map(|value| (*value).into()).collect())
}
