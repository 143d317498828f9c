//! The figures of a report, each a drawing with a caption that says what to see.

mod devices;
mod energy;
mod force;
mod histories;
mod plane;
mod spectra;
mod trace;

pub use force::friction_bounds;
pub(crate) use histories::marked;
pub(crate) use trace::Trace;

use slipstick::input::Names;
use slipstick::response::{History, Mode};

use crate::display::Unit;
use crate::legend::TIME;
use crate::plot::{Axis, Figure, Svg};
use crate::report::Report;

/// A figure ready for the page.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawn {
    /// Identifier in the page and stem for a file: `sliding-displacement`.
    pub id: String,
    /// What to see in it, plain text.
    pub caption: String,
    /// The drawing.
    pub svg: Svg,
    /// What it is of, for those who draw it themselves.
    pub figure: Figure,
}

impl Drawn {
    /// Draws a figure and puts its caption beside it.
    #[must_use]
    pub fn new(figure: Figure, caption: String) -> Self {
        Self { id: figure.id.clone(), caption, svg: figure.to_svg(), figure }
    }
}

/// How many figures, from the first, stand before the table of peaks.
pub(crate) const ANSWERS: usize = 2;

/// All figures that the report has data for, in order; none over time without a history.
#[must_use]
pub fn all(report: &Report) -> Vec<Drawn> {
    let history = report.response.history.as_ref().filter(|history| history.len() > 1);
    let Some(history) = history else { return Vec::new() };
    let scene = Scene::new(report, history);
    let along_y = report.response.in_plane.as_ref().and_then(|plane| plane.history.as_ref());
    let floor_spectra = report.floor_spectra.and_then(|spectra| spectra::floors(report, spectra));
    if let Some(along_y) = along_y {
        let mut figures = plane::all(&scene, along_y);
        figures.extend(floor_spectra.into_iter().chain(energy::by_kind(&scene)));
        return figures;
    }
    [
        Some(histories::sliding_displacement(&scene)),
        Some(force::loops(&scene)),
        Some(histories::accelerations(&scene)),
        histories::drifts(&scene),
        devices::surfaces(&scene),
        devices::contents(&scene),
        devices::friction_by_speed(&scene),
        floor_spectra,
        force::demand(&scene),
        energy::by_kind(&scene),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// What all figures over time share.
struct Scene<'a> {
    report: &'a Report<'a>,
    history: &'a History,
    sliding: Vec<[f64; 2]>,
}

impl<'a> Scene<'a> {
    fn new(report: &'a Report<'a>, history: &'a History) -> Self {
        Self { report, history, sliding: sliding_intervals(history) }
    }

    fn time_axis(&self) -> Axis {
        let end_s = self.history.time_s.last().copied().unwrap_or(0.0);
        Axis::linear(TIME.alone(Unit::SECOND), 0.0, end_s)
    }

    /// Points over time: one value a knot, in a unit.
    fn over_time(&self, unit: Unit, value: impl Fn(usize) -> f64) -> Vec<[f64; 2]> {
        let times = self.history.time_s.iter().enumerate();
        times.map(|(knot, &time_s)| [time_s, unit.of(value(knot))]).collect()
    }
}

/// Intervals in which the block slides, those that touch joined.
fn sliding_intervals(history: &History) -> Vec<[f64; 2]> {
    let mut intervals: Vec<[f64; 2]> = Vec::new();
    let sliders = history.mode.iter().step_by(history.interfaces);
    for (times, mode) in history.time_s.windows(2).zip(sliders) {
        let [from, to] = [times[0], times[1]];
        if *mode == Mode::Stick || to <= from {
            continue;
        }
        match intervals.last_mut() {
            Some(last) if last[1] == from => last[1] = to,
            _ => intervals.push([from, to]),
        }
    }
    intervals
}

/// Storeys worth a panel, as indices: all of three, else the lowest, the one with the largest
/// value and the roof.
pub(crate) fn shown_storeys(values: &[f64]) -> Vec<usize> {
    let n = values.len();
    if n <= 3 {
        return (0..n).collect();
    }
    let mut largest = 0;
    for (i, value) in values.iter().enumerate() {
        if *value > values[largest] {
            largest = i;
        }
    }
    let middle = if largest == 0 || largest == n - 1 { n / 2 } else { largest };
    vec![0, middle, n - 1]
}

/// What the figure of drifts is called.
fn drifts_title(names: &Names) -> &'static str {
    if names.points.is_empty() { "Storey drifts over time" } else { "Drifts of points over time" }
}

/// ` Storeys 1, 4 and 8 of 8 are drawn.`, points by their names, or nothing where all are.
pub(crate) fn shown_note(shown: &[usize], n: usize, names: &Names) -> String {
    match shown {
        [a, b, c] if n > 3 && !names.points.is_empty() => {
            let [a, b, c] = [a, b, c].map(|i| names.point(i + 1));
            format!(" {a}, {b} and {c} of {n} points are drawn.")
        }
        [a, b, c] if n > 3 => {
            format!(" Storeys {}, {} and {} of {n} are drawn.", a + 1, b + 1, c + 1)
        }
        _ => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use slipstick::slider::Direction;

    use super::*;

    #[test]
    fn sliding_intervals_join_over_reversals() {
        let slip = Mode::Slip(Direction::Positive);
        let back = Mode::Slip(Direction::Negative);
        let history = History {
            time_s: vec![0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0],
            mode: vec![Mode::Stick, Mode::Stick, slip, slip, back, back, Mode::Stick, Mode::Stick],
            ..History::default()
        };
        assert_eq!(sliding_intervals(&history), [[1.0, 3.0]]);
    }

    #[test]
    fn storeys_shown() {
        assert_eq!(shown_storeys(&[]), Vec::<usize>::new());
        assert_eq!(shown_storeys(&[1.0, 2.0, 3.0]), [0, 1, 2]);
        assert_eq!(shown_storeys(&[1.0, 5.0, 2.0, 3.0, 4.0]), [0, 1, 4]);
        assert_eq!(shown_storeys(&[1.0, 2.0, 3.0, 4.0, 5.0]), [0, 2, 4]);
    }
}
