//! What figures and tables of floor spectra share.

use slipstick::assessment::floors::{FloorSpectra, PlaceSpectra, TABLED_PERIODS_S};
use slipstick::input::Names;

use crate::assessment::sheet::{Table, cell};
use crate::display::{DisplayUnits, Quantity};
use crate::markup::shortened;
use crate::number::{compact, printed};

/// What the spectra of [`in_directions`] are of; in one direction nothing need be said.
pub(crate) const DIRECTIONS: [&str; 3] = ["RotD100", "along x", "along y"];

/// The spectra of the one direction, or RotD100 and those along x and along y.
pub(crate) fn in_directions(spectra: &FloorSpectra) -> Vec<&PlaceSpectra> {
    core::iter::once(&spectra.sa).chain(spectra.axes.iter().flatten()).collect()
}

/// The largest ordinate; 0 of none.
pub(crate) fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

/// What a place is called: 0 the ground, 1 the block, then the floors or points.
pub(crate) fn place_name(names: &Names, place: usize) -> String {
    match place {
        0 => "Ground".to_owned(),
        1 => names.block().to_owned(),
        point => names.point(point - 1),
    }
}

/// Heads of a table of spectra: the largest ordinate, its period, and the ordinates at round periods.
pub(crate) fn heads() -> impl Iterator<Item = String> {
    let periods = TABLED_PERIODS_S.iter().map(|period_s| format!("{} s", compact(*period_s)));
    ["Largest", "at (s)"].map(str::to_owned).into_iter().chain(periods)
}

/// The cells below [`heads`] of a spectrum in the unit that `shown` gives it; what is missing is a dash.
pub(crate) fn cells(
    periods_s: &[f64],
    sa_m_per_s2: &[f64],
    shown: impl Fn(f64) -> String,
) -> Vec<String> {
    let largest = periods_s.iter().zip(sa_m_per_s2).reduce(|a, b| if b.1 > a.1 { b } else { a });
    let at = largest.map_or("—".to_owned(), |(period_s, _)| cell(*period_s));
    let ordinate = |period_s: &f64| {
        let place = periods_s.iter().position(|known| known == period_s);
        place.and_then(|place| sa_m_per_s2.get(place)).copied().unwrap_or(f64::NAN)
    };
    let largest = shown(largest.map_or(f64::NAN, |(_, sa)| *sa));
    let tabled = TABLED_PERIODS_S.iter().map(|period_s| shown(ordinate(period_s)));
    [largest, at].into_iter().chain(tabled).collect()
}

/// `Floor spectra at 5 % damping (m/s²)`.
pub(crate) fn heading(damping_ratio: f64, unit: &str) -> String {
    format!("Floor spectra at {} % damping ({unit})", printed(100.0 * damping_ratio, 2))
}

/// The spectra of a run at round periods: a row a place, in two directions RotD100 with x and y below it; none
/// without periods.
pub(crate) fn table(spectra: &FloorSpectra, names: &Names, display: DisplayUnits) -> Option<Table> {
    let periods_s = &spectra.periods_s;
    periods_s.first()?;
    let directions = in_directions(spectra);
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
            let cells = cells(periods_s, sa, |sa| cell(unit.of(sa)));
            rows.push(core::iter::once(name).chain(cells).collect());
        }
    }
    Some((heading(spectra.damping_ratio, unit.symbol), rows))
}
