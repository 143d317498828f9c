//! A small plotter: stacked histories on one time axis, or curves side by side, as SVG text.
//!
//! Hand-written rather than a plotting library: the drawn peak must be the tabled peak, lines must
//! differ by dash and width and not only by colour, each figure carries `<title>` and `<desc>`, and
//! the path data is kept short.

mod axis;
mod contour;
mod draw;
mod thin;

pub use axis::{Axis, Tick};
pub use contour::{contour, levels};

use crate::markup::Markup;

/// Width of every figure in its own units; on A4 one of them is about a quarter of a millimetre.
pub const WIDTH: f64 = 680.0;

/// Width of a figure on a phone, in the same units: about one a pixel of its screen.
pub const NARROW: f64 = 360.0;

/// A finished drawing: one `<svg>` element.
#[derive(Clone, Debug, PartialEq)]
pub struct Svg {
    markup: Markup,
    height: f64,
}

impl Svg {
    /// The `<svg>` element as text; also a file of its own.
    #[must_use]
    pub fn as_str(&self) -> &str {
        self.markup.as_str()
    }

    /// The element as a piece of a page.
    #[must_use]
    pub fn markup(&self) -> &Markup {
        &self.markup
    }
}

/// Drawings one below the other, as one file.
#[must_use]
pub fn column(drawings: &[Svg]) -> Svg {
    let heights: Vec<f64> = drawings.iter().map(|svg| svg.height).collect();
    let height = heights.iter().sum();
    let mut out = Markup::new();
    out.raw("<svg xmlns=\"http://www.w3.org/2000/svg\"")
        .attribute("viewBox", format!("0 0 {WIDTH} {}", crate::number::trimmed(height, 1)))
        .raw(">\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n");
    let mut top = 0.0;
    for (svg, height) in drawings.iter().zip(heights) {
        out.raw("<svg")
            .attribute("y", crate::number::trimmed(top, 1))
            .attribute("width", WIDTH)
            .attribute("height", crate::number::trimmed(height, 1))
            .raw(">\n")
            .append(&svg.markup)
            .raw("</svg>\n");
        top += height;
    }
    out.raw("</svg>\n");
    Svg { markup: out, height }
}

/// How a line is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Style {
    /// Colour of the stroke.
    pub colour: &'static str,
    /// Width of the stroke.
    pub width: f64,
    /// Dashes and gaps, empty for a full line.
    pub dashes: &'static str,
}

impl Style {
    /// The main line of a panel.
    pub const MAIN: Self = Self { colour: "#0b3c6f", width: 1.0, dashes: "" };
    /// Another beside it: wide and light, drawn below.
    pub const WIDE: Self = Self { colour: "#a0620e", width: 2.4, dashes: "" };
    /// A third: dashed.
    pub const DASHED: Self = Self { colour: "#1a1a1a", width: 1.0, dashes: "6 3" };
    /// A fourth: dotted.
    pub const DOTTED: Self = Self { colour: "#1a1a1a", width: 1.1, dashes: "1.2 2.4" };
    /// Limits such as the gap.
    pub const LIMIT: Self = Self { colour: "#a3161c", width: 1.0, dashes: "8 3 2 3" };
}

/// What the points of a series are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// A quantity over x, which does not decrease: thinned by minimum and maximum a pixel.
    History,
    /// The same, with the area down to 0 filled in this colour.
    Area(&'static str),
    /// Any curve: strokes that lie on each other are drawn once.
    Curve,
    /// A band: the points go along its lower edge and back along the upper one; filled, no stroke.
    Band(&'static str),
    /// Separate points, filled in this colour (`#fff` for hollow ones).
    Dots(&'static str),
    /// The name of the series at every point, on a white edge, and not in the legend.
    Named,
}

/// A line of a panel.
#[derive(Clone, Debug, PartialEq)]
pub struct PlotSeries {
    /// Its name in the legend; empty for none.
    pub label: String,
    /// How it is drawn.
    pub style: Style,
    /// What it is.
    pub shape: Shape,
    /// Its points in the units of the axes.
    pub points: Vec<[f64; 2]>,
}

/// A level line across a panel.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    /// Where, in the unit of the axis.
    pub value: f64,
    /// What stands on it; empty for nothing.
    pub label: String,
    /// How it is drawn.
    pub style: Style,
}

/// One frame with its axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// The axis along.
    pub x: Axis,
    /// The axis upwards; its label stands above the frame.
    pub y: Axis,
    /// Height of the frame.
    pub height: f64,
    /// What is drawn, the first lowest.
    pub series: Vec<PlotSeries>,
    /// Level lines.
    pub limits: Vec<Limit>,
    /// A point to ring, in the units of the axes: the tabled peak.
    pub peak: Option<[f64; 2]>,
    /// Text at the right above the frame, as `peak 12.3 mm`.
    pub note: String,
}

/// How the panels of a figure stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// One above the other, the lowest with the labels of the shared x axis.
    Stacked,
    /// Side by side, each with its own x axis.
    Beside,
    /// Side by side, each as high as it is wide.
    Square,
}

/// One or more panels.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Identifier in the page: letters, digits and hyphens.
    pub id: String,
    /// One line for those who cannot see it.
    pub title: String,
    /// What it shows, in words.
    pub description: String,
    /// How the panels stand.
    pub layout: Layout,
    /// The panels.
    pub panels: Vec<Panel>,
    /// Intervals of x shaded in every panel, in order: the block slides.
    pub shaded: Vec<[f64; 2]>,
}

impl Figure {
    /// Draws it.
    #[must_use]
    pub fn to_svg(&self) -> Svg {
        self.drawn(WIDTH)
    }

    /// Draws it as narrow as a phone is, panels that stand beside each other below each other; what names it has
    /// identifiers of its own, so that it may stand beside the other.
    #[must_use]
    pub fn to_narrow_svg(&self) -> Svg {
        Self { id: format!("{}-narrow", self.id), ..self.clone() }.drawn(NARROW)
    }

    fn drawn(&self, width: f64) -> Svg {
        let (markup, height) = draw::figure(self, width);
        Svg { markup, height }
    }
}
