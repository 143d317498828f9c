//! Floor response spectra.

use super::{Drawn, shown_note, shown_storeys};
use crate::assessment::lines::{over_x, panel, single};
use crate::display::Quantity;
use crate::markup::shortened;
use crate::number::printed;
use crate::plot::{Axis, PlotSeries, Style};
use slipstick::assessment::single::FloorSpectra;

use crate::report::Report;

/// Spectra of table, block and floors over a logarithmic period; none without two periods.
pub fn floors(report: &Report, spectra: &FloorSpectra) -> Option<Drawn> {
    let periods = &spectra.periods_s;
    let (&first, &last) = (periods.first()?, periods.last()?);
    if first >= last {
        return None;
    }
    let peaks: Vec<f64> = spectra.storeys_m_per_s2.iter().map(|values| largest(values)).collect();
    let all = peaks.iter().copied().chain([largest(&spectra.block_m_per_s2)]).fold(0.0, f64::max);
    let unit = report.display.unit(Quantity::Acceleration, all);
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
    let storeys = shown.iter().zip(storey_styles).map(|(&i, style)| {
        line(names.point(i + 1).to_lowercase(), style, &spectra.storeys_m_per_s2[i])
    });
    let mut series: Vec<PlotSeries> = storeys.collect();
    if !spectra.table_m_per_s2.is_empty() {
        series.push(line("ground".to_owned(), Style::DOTTED, &spectra.table_m_per_s2));
    }
    let block = Style { width: 1.3, ..Style::MAIN };
    series.push(line(names.block().to_lowercase(), block, &spectra.block_m_per_s2));
    let values: Vec<f64> = series.iter().flat_map(|s| s.points.iter().map(|p| p[1])).collect();
    let panel = panel(
        Axis::logarithmic("Period (s)", first, last),
        Axis::from_zero(unit.label("Spectral acceleration"), values),
        230.0,
        series,
    );
    let place = if names.points.is_empty() { "floor" } else { "point of the structure" };
    let caption = format!(
        "Floor response spectra: largest total acceleration of a light oscillator with {} % damping \
         fixed to the block or a {place}, over its period. For equipment, read its own period.{}",
        printed(100.0 * spectra.damping_ratio, 2),
        shown_note(&shown, peaks.len(), names)
    );
    Some(single("floor-spectra", "Floor response spectra", caption, panel))
}

fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}
