//! Floor spectra over a suite.

use super::over_suite::OverSuite;
use super::{ModelHistories, OnRecord};
use crate::assessment::floors::{FloorSpectra, place_name};
use crate::table::Table;

/// What the spectra of two directions are of, as tables name it, in the order of [`FloorSpectra::in_directions`].
pub const DIRECTIONS: [&str; 3] = ["rotd100", "x", "y"];

/// One of the spectra of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FloorSpectrum {
    /// Index of the bound of friction.
    pub bound: usize,
    /// The direction: 0, and where there are two 0 RotD100, 1 along x, 2 along y.
    pub direction: usize,
    /// The place: 0 the table, 1 the block, then the floors from the block up or the points.
    pub place: usize,
}

impl OnRecord {
    /// A spectrum in m/s², one value a period; none of a run without it.
    #[must_use]
    pub fn floor_spectrum(&self, of: FloorSpectrum) -> Option<&[f64]> {
        let spectra = self.runs.get(of.bound)?.as_ref().ok()?.floor_spectra.as_ref()?;
        spectra.in_directions().nth(of.direction)?.places().nth(of.place)
    }
}

impl ModelHistories {
    /// The spectra of one of the runs, whose periods, directions and places are those of all; none where they were not
    /// asked for.
    #[must_use]
    pub fn a_floor_spectrum(&self) -> Option<&FloorSpectra> {
        self.runs().find_map(|run| run.as_ref().ok()?.floor_spectra.as_ref())
    }

    /// A spectrum over the suite in m/s², one value a period; none where a record has none.
    #[must_use]
    pub fn floor_spectrum(&self, of: FloorSpectrum) -> Option<Vec<OverSuite>> {
        let ordinate = |on: &OnRecord, i: usize| {
            let sa = on.floor_spectrum(of).and_then(|sa| sa.get(i));
            sa.copied().unwrap_or(f64::NAN)
        };
        let periods = 0..self.a_floor_spectrum()?.periods_s.len();
        periods.map(|i| self.over_suite(|on| ordinate(on, i))).collect()
    }

    /// All spectra over the suite: bound by bound, place by place from the ground up, direction by direction.
    #[must_use]
    pub fn floor_spectra(&self) -> Vec<(FloorSpectrum, Vec<OverSuite>)> {
        let Some(one) = self.a_floor_spectrum() else { return Vec::new() };
        let (places, directions) = (one.sa.places().count(), one.in_directions().count());
        let bounds = 0..self.bounds.len();
        let of = bounds.flat_map(|bound| {
            let of_place = move |place| {
                (0..directions).map(move |direction| FloorSpectrum { bound, direction, place })
            };
            (0..places).flat_map(of_place)
        });
        of.filter_map(|of| Some((of, self.floor_spectrum(of)?))).collect()
    }

    /// Index of the bound of friction with which a place, in a direction, has the largest ordinate of what governs.
    #[must_use]
    pub fn floor_governs(&self, of: FloorSpectrum) -> Option<usize> {
        let peak = |bound: usize| {
            let over = self.floor_spectrum(FloorSpectrum { bound, ..of })?;
            Some((bound, over.iter().map(|over| self.governing_of(over)).fold(0.0, f64::max)))
        };
        let peaks = (0..self.bounds.len()).filter_map(peak);
        peaks.reduce(|a, b| if b.1 > a.1 { b } else { a }).map(|(bound, _)| bound)
    }
}

/// The spectra of all models over their suites, a row a model, bound, place, direction and period; none where they were
/// not asked for.
pub(super) fn table(models: &[ModelHistories]) -> Option<Table> {
    let mut rows = Vec::new();
    for model in models {
        let periods_s = model.a_floor_spectrum().map_or(&[][..], |one| &one.periods_s);
        for (of, over) in model.floor_spectra() {
            rows.extend(periods_s.iter().zip(over).map(|(t, over)| (model, of, *t, over)));
        }
    }
    let in_plane =
        models.iter().any(|model| model.a_floor_spectrum().is_some_and(|one| one.axes.is_some()));
    let mut table = Table::default();
    table
        .texts("model", rows.iter().map(|(model, ..)| model.name.clone()).collect())
        .texts(
            "friction",
            rows.iter().map(|(m, of, ..)| m.bounds[of.bound].name.to_owned()).collect(),
        )
        .texts("place", rows.iter().map(|(m, of, ..)| place_name(&m.names, of.place)).collect());
    if in_plane {
        let direction = |of: &FloorSpectrum| DIRECTIONS[of.direction].to_owned();
        table.texts("direction", rows.iter().map(|(_, of, ..)| direction(of)).collect());
    }
    table.numbers("period_s", "s", rows.iter().map(|(.., t, _)| *t).collect());
    let all: Vec<OverSuite> = rows.iter().map(|(.., over)| *over).collect();
    OverSuite::add_columns(&all, &mut table, "_m_per_s2", "m/s2");
    (!rows.is_empty()).then_some(table)
}
