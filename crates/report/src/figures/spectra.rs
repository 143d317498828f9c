//! Floor response spectra.

use super::{Drawn, shown_note, shown_storeys};
use crate::assessment::lines::{over_x, panel, stacked};
use crate::display::{Quantity, Unit};
use crate::floors::{DIRECTIONS, largest};
use crate::legend::{self, BLOCK, GROUND, PERIOD, SPECTRAL_ACCELERATION};
use crate::markup::shortened;
use crate::number::compact;
use crate::plot::{Axis, Panel, PlotSeries, Style};
use slipstick::assessment::floors::{FloorSpectra, PlaceSpectra};

use crate::report::Report;

/// Spectra of table, block and floors over a logarithmic period, in two horizontal directions RotD100, x and y one
/// below the other; none without two periods.
pub fn floors(report: &Report, spectra: &FloorSpectra) -> Option<Drawn> {
    let periods = &spectra.periods_s;
    let (&first, &last) = (periods.first()?, periods.last()?);
    if first >= last {
        return None;
    }
    let storeys = &spectra.sa.storeys_m_per_s2;
    let peaks: Vec<f64> = storeys.iter().map(|values| largest(values)).collect();
    let all = peaks.iter().copied().chain([largest(&spectra.sa.block_m_per_s2)]);
    let unit = report.display.unit(Quantity::Acceleration, all.fold(0.0, f64::max));
    let shown = shown_storeys(&peaks);
    let storey_styles = [
        Style { width: 1.8, ..Style::DASHED },
        Style::WIDE,
        Style { colour: "#1a1a1a", ..Style::LIMIT },
    ];
    let names = &report.summary.names;
    let line = |label: String, style: Style, values: &[f64]| {
        over_x(
            shortened(&label, 24),
            style,
            periods.iter().zip(values).map(|(&t, &a)| [t, unit.of(a)]).collect(),
        )
    };
    let series = |sa: &PlaceSpectra| {
        let storeys = shown
            .iter()
            .zip(storey_styles)
            .map(|(&i, style)| line(legend::point(names, i + 1), style, &sa.storeys_m_per_s2[i]));
        let mut series: Vec<PlotSeries> = storeys.collect();
        if !sa.table_m_per_s2.is_empty() {
            series.push(line(GROUND.label.into(), GROUND.style, &sa.table_m_per_s2));
        }
        series.push(line(legend::block(names), BLOCK.style, &sa.block_m_per_s2));
        series
    };
    let drawn: Vec<Vec<PlotSeries>> = spectra.in_directions().map(series).collect();
    let points = drawn.iter().flatten().flat_map(|series| &series.points);
    let values: Vec<f64> = points.map(|point| point[1]).collect();
    let y = Axis::from_zero(SPECTRAL_ACCELERATION.alone(unit), values);
    let in_plane = spectra.axes.is_some();
    let panels =
        drawn.into_iter().zip(DIRECTIONS).enumerate().map(|(i, (mut series, direction))| {
            if i > 0 {
                series.iter_mut().for_each(|series| series.label.clear());
            }
            let label =
                if in_plane { format!("{}, {direction}", y.label) } else { y.label.clone() };
            let y = Axis { label, ..y.clone() };
            let height = if in_plane { 150.0 } else { 230.0 };
            panel(Axis::logarithmic(PERIOD.alone(Unit::SECOND), first, last), y, height, series)
        });
    let panels: Vec<Panel> = panels.collect();
    let place = if names.points.is_empty() { "floor" } else { "point of the structure" };
    let directions =
        if in_plane { " RotD100 is the largest over all horizontal directions." } else { "" };
    let caption = format!(
        "Floor response spectra: largest total acceleration of a light oscillator with {} % damping \
         fixed to the block or a {place}, over its period. For equipment, read its own period.{directions}{}",
        compact(100.0 * spectra.damping_ratio),
        shown_note(&shown, peaks.len(), names)
    );
    Some(stacked("floor-spectra", "Floor response spectra", caption, panels))
}
