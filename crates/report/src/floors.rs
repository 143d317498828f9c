//! What figures and tables of floor spectra share.

use slipstick::assessment::floors::{FloorSpectra, TABLED_PERIODS_S, place_name};
use slipstick::input::Names;

use crate::assessment::sheet::{SheetTable, cell};
use crate::display::{DisplayUnits, Quantity, Unit};
use crate::markup::shortened;
use crate::number::compact;

/// What the spectra of [`FloorSpectra::in_directions`] are of; in one direction nothing need be said.
pub(crate) const DIRECTIONS: [&str; 3] = ["RotD100", "along x", "along y"];

/// The largest ordinate; 0 of none.
pub(crate) fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

/// Heads of a table of spectra: the largest ordinate, its period, and the ordinates at round periods.
pub(crate) fn heads() -> impl Iterator<Item = String> {
    let periods = TABLED_PERIODS_S.iter().map(|period_s| format!("{} s", compact(*period_s)));
    ["Largest", "at (s)"].map(str::to_owned).into_iter().chain(periods)
}

/// What stands below [`heads`], of a spectrum in m/s²; what is missing is NaN.
pub(crate) fn ordinates(periods_s: &[f64], sa_m_per_s2: &[f64]) -> Vec<f64> {
    let largest = periods_s.iter().zip(sa_m_per_s2).reduce(|a, b| if b.1 > a.1 { b } else { a });
    let [at_s, largest] = largest.map_or([f64::NAN; 2], |(period_s, sa)| [*period_s, *sa]);
    let ordinate = |period_s: &f64| {
        let place = periods_s.iter().position(|known| known == period_s);
        place.and_then(|place| sa_m_per_s2.get(place)).copied().unwrap_or(f64::NAN)
    };
    [largest, at_s].into_iter().chain(TABLED_PERIODS_S.iter().map(ordinate)).collect()
}

/// The cells of [`ordinates`], of which the second is a period.
pub(crate) fn shown_ordinates(values: &[f64], unit: Unit) -> Vec<String> {
    let shown = |(i, value): (usize, &f64)| cell(if i == 1 { *value } else { unit.of(*value) });
    values.iter().enumerate().map(shown).collect()
}

/// `Floor spectra at 5 % damping, RotD100 (m/s²)`.
pub(crate) fn heading(damping_ratio: f64, unit: &str, direction: &str) -> String {
    format!("Floor spectra at {} % damping{direction} ({unit})", compact(100.0 * damping_ratio))
}

/// The spectra of a run at round periods: a row a place, in two directions RotD100 with x and y below it; none
/// without periods.
pub(crate) fn table(
    spectra: &FloorSpectra,
    names: &Names,
    display: DisplayUnits,
) -> Option<SheetTable> {
    let periods_s = &spectra.periods_s;
    periods_s.first()?;
    let directions: Vec<_> = spectra.in_directions().collect();
    let most = spectra.sa.places().map(largest).fold(0.0, f64::max);
    let unit = display.unit(Quantity::Acceleration, most);
    let first = if directions.len() > 1 { "Place, RotD100" } else { "Place" };
    let mut rows = vec![core::iter::once(first.to_owned()).chain(heads()).collect()];
    for place in 0..spectra.sa.places().count() {
        for (i, direction) in directions.iter().enumerate() {
            let name = match i {
                0 => shortened(&place_name(names, place), 28),
                _ => format!("  {}", DIRECTIONS[i]),
            };
            let sa = direction.places().nth(place).unwrap_or_default();
            let cells = shown_ordinates(&ordinates(periods_s, sa), unit);
            rows.push(core::iter::once(name).chain(cells).collect());
        }
    }
    Some((heading(spectra.damping_ratio, unit.symbol, ""), rows))
}
