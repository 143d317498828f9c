//! Every demand of an analysis, once: its key, unit, words, place in tables, and how it is got.
//!
//! From this list come the keys of the summary, the columns of tables, the printed rows, the titles
//! of figures and the keys that options take. A new demand is a field of [`Demands`] and an entry
//! here.

use super::{ContentsDemands, Demands, StopDemands};
use crate::table::Kind;
use crate::units::Dimension::{self, Acceleration, Force, Length, Time, Velocity};

/// What a demand's values are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DemandKind {
    /// A number; none where it does not exist.
    Number,
    /// A whole number.
    Count,
    /// Yes or no.
    Flag,
}

impl From<DemandKind> for Kind {
    fn from(kind: DemandKind) -> Self {
        match kind {
            DemandKind::Number => Self::Number,
            DemandKind::Count => Self::Count,
            DemandKind::Flag => Self::Flag,
        }
    }
}

/// What has a demand: the analysis once, or each of its parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DemandOf {
    /// Every analysis.
    Run,
    /// Each storey.
    Storey,
    /// Each point of a structure by its modes.
    Point,
    /// The stop, where the model has one.
    Stop,
    /// Each surface in series.
    Surface,
    /// Each contents of a floor.
    Contents,
}

impl DemandOf {
    /// What stands before the number of a part in names; none of what an analysis has once.
    #[must_use]
    pub fn part(self) -> Option<&'static str> {
        match self {
            Self::Run | Self::Stop => None,
            Self::Storey => Some("storey"),
            Self::Point => Some("point"),
            Self::Surface => Some("surface"),
            Self::Contents => Some("contents"),
        }
    }

    /// The key of the summary's list of such parts.
    #[must_use]
    pub fn list(self) -> Option<&'static str> {
        match self {
            Self::Run | Self::Stop => None,
            Self::Storey => Some("storeys"),
            Self::Point => Some("points"),
            Self::Surface => Some("surfaces"),
            Self::Contents => Some("contents"),
        }
    }
}

/// How the table of one analysis shows a demand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PrintedRow {
    /// Rows stand in the order of their places; those of one storey after the other have the same.
    pub place: u8,
    /// What stands before the value; of a storey, after its number.
    pub label: &'static str,
    /// Whether the largest of several runs governs.
    pub governs: bool,
    /// Whether it means nothing without storeys.
    pub needs_storeys: bool,
}

/// Of what a demand is where the table moves in two horizontal directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InDirections {
    /// Of the resultant and by axis.
    Both,
    /// Of the resultant, or of neither axis, alone.
    Resultant,
    /// By axis alone.
    Axis,
}

/// A demand.
#[derive(Debug)]
pub struct Demand {
    /// Its key in the summary; of a storey, inside the storey's object. `block.x` is the key `x` in
    /// the object `block`.
    pub key: &'static str,
    /// Its name in words, without the unit.
    pub words: &'static str,
    /// What it measures; `None` for ratios, counts and flags.
    pub dimension: Option<Dimension>,
    /// What its values are.
    pub kind: DemandKind,
    /// What has it.
    pub of: DemandOf,
    /// Its row in the table of one analysis, if it has one.
    pub row: Option<PrintedRow>,
    /// Its place in the table of a study, from 1; 0 where it is not in it.
    pub study_place: u8,
    /// Whether it is a key of the summary; what is not stands there in another form.
    pub in_summary: bool,
    /// Of what it is in two horizontal directions.
    pub in_directions: InDirections,
    /// Its value, of the storey with that index from 0; `None` where it does not exist.
    value: fn(&Demands, usize) -> Option<f64>,
}

impl Demand {
    const fn new(
        key: &'static str,
        words: &'static str,
        kind: DemandKind,
        dimension: Option<Dimension>,
        value: fn(&Demands, usize) -> Option<f64>,
    ) -> Self {
        Self {
            key,
            words,
            dimension,
            kind,
            of: DemandOf::Run,
            row: None,
            study_place: 0,
            in_summary: true,
            in_directions: InDirections::Both,
            value,
        }
    }

    const fn number(
        key: &'static str,
        words: &'static str,
        dimension: Dimension,
        value: fn(&Demands, usize) -> Option<f64>,
    ) -> Self {
        Self::new(key, words, DemandKind::Number, Some(dimension), value)
    }

    const fn ratio(
        key: &'static str,
        words: &'static str,
        value: fn(&Demands, usize) -> Option<f64>,
    ) -> Self {
        Self::new(key, words, DemandKind::Number, None, value)
    }

    const fn count(
        key: &'static str,
        words: &'static str,
        value: fn(&Demands, usize) -> Option<f64>,
    ) -> Self {
        Self::new(key, words, DemandKind::Count, None, value)
    }

    /// Of the stop, which in two directions is one all around.
    const fn of_stop(self) -> Self {
        Self { of: DemandOf::Stop, in_directions: InDirections::Resultant, ..self }
    }

    const fn of_storey(self) -> Self {
        Self { of: DemandOf::Storey, ..self }
    }

    const fn of_point(self) -> Self {
        Self { of: DemandOf::Point, ..self }
    }

    const fn of_surface(self) -> Self {
        Self { of: DemandOf::Surface, ..self }
    }

    const fn of_contents(self) -> Self {
        Self { of: DemandOf::Contents, ..self }
    }

    /// A row of which the largest value governs.
    const fn row(self, place: u8, label: &'static str) -> Self {
        let row = PrintedRow { place, label, governs: true, needs_storeys: false };
        Self { row: Some(row), ..self }
    }

    /// A row that governs nothing.
    const fn note(self, place: u8, label: &'static str) -> Self {
        let row = PrintedRow { place, label, governs: false, needs_storeys: false };
        Self { row: Some(row), ..self }
    }

    const fn row_with_storeys(self, place: u8, label: &'static str) -> Self {
        let row = PrintedRow { place, label, governs: true, needs_storeys: true };
        Self { row: Some(row), ..self }
    }

    const fn in_study(self, study_place: u8) -> Self {
        Self { study_place, ..self }
    }

    const fn of_resultant(self) -> Self {
        Self { in_directions: InDirections::Resultant, ..self }
    }

    const fn by_axis(self) -> Self {
        Self { in_directions: InDirections::Axis, ..self }
    }

    const fn not_in_summary(self) -> Self {
        Self { in_summary: false, ..self }
    }

    /// The SI unit of its values; empty where they have none.
    #[must_use]
    pub fn unit(&self) -> &'static str {
        self.dimension.map_or("", Dimension::si_unit)
    }
}

/// Place of the rows of all storeys.
const STOREYS: u8 = 20;

/// Places of the rows of all surfaces in series and of all contents.
const SURFACES: u8 = 44;
const CONTENTS: u8 = 45;

/// The demands in the order of the summary and of tables.
pub static DEMANDS: [Demand; 51] = [
    Demand::number("peak_sliding_displacement_m", "peak sliding displacement", Length, |d, _| {
        Some(d.peak_sliding_displacement_m)
    })
    .row(1, "Peak sliding displacement")
    .in_study(1),
    Demand::number(
        "peak_sliding_displacement_time_s",
        "peak sliding displacement time",
        Time,
        |d, _| Some(d.peak_sliding_displacement_time_s),
    )
    .note(2, "  at time")
    .of_resultant(),
    Demand::number("max_sliding_displacement_m", "max sliding displacement", Length, |d, _| {
        Some(d.max_sliding_displacement_m)
    })
    .note(4, "Largest towards +x")
    .by_axis(),
    Demand::number("min_sliding_displacement_m", "min sliding displacement", Length, |d, _| {
        Some(d.min_sliding_displacement_m)
    })
    .note(5, "Largest towards −x")
    .by_axis(),
    Demand::number(
        "residual_sliding_displacement_m",
        "residual sliding displacement",
        Length,
        |d, _| Some(d.residual_sliding_displacement_m),
    )
    .row(3, "Residual sliding displacement")
    .in_study(2),
    Demand::new("sliding_at_end", "sliding at end", DemandKind::Flag, None, |d, _| {
        Some(f64::from(u8::from(d.sliding_at_end)))
    })
    .note(53, "Sliding at the end")
    .of_resultant(),
    Demand::number("sliding_path_m", "sliding path", Length, |d, _| Some(d.sliding_path_m))
        .row(6, "Sliding path")
        .of_resultant(),
    Demand::number("peak_sliding_velocity_m_per_s", "peak sliding velocity", Velocity, |d, _| {
        Some(d.peak_sliding_velocity_m_per_s)
    })
    .row(7, "Peak sliding velocity")
    .in_study(4),
    Demand::number("sliding_time_s", "sliding time", Time, |d, _| Some(d.sliding_time_s))
        .note(8, "Time spent sliding")
        .of_resultant(),
    Demand::count("slip_count", "slip count", |d, _| Some(d.slip_count as f64))
        .note(50, "Slips (stick to slip)")
        .of_resultant(),
    Demand::count("reversal_count", "reversal count", |d, _| Some(d.reversal_count as f64))
        .note(51, "Reversals without a stick")
        .of_resultant(),
    Demand::count("stick_count", "stick count", |d, _| Some(d.stick_count as f64))
        .note(52, "Sticks (slip to stick)")
        .of_resultant(),
    Demand::number(
        "block.peak_acceleration_m_per_s2",
        "block peak acceleration",
        Acceleration,
        |d, _| Some(d.peak_block_acceleration_m_per_s2),
    )
    .row(9, "Peak block acceleration")
    .in_study(5),
    Demand::number("peak_acceleration_m_per_s2", "peak acceleration", Acceleration, |d, i| {
        d.storeys.get(i).map(|storey| storey.peak_acceleration_m_per_s2)
    })
    .of_storey()
    .row(STOREYS, "peak acceleration")
    .in_study(6),
    Demand::number("peak_displacement_m", "peak displacement", Length, |d, i| {
        d.storeys.get(i).map(|storey| storey.peak_displacement_m)
    })
    .of_storey()
    .row(STOREYS, "peak displacement"),
    Demand::number("peak_drift_m", "peak drift", Length, |d, i| {
        d.storeys.get(i).map(|storey| storey.peak_drift_m)
    })
    .of_storey()
    .row(STOREYS, "peak drift")
    .in_study(7),
    Demand::ratio("peak_drift_ratio", "peak drift ratio", |d, i| {
        d.storeys.get(i).and_then(|storey| storey.peak_drift_ratio)
    })
    .of_storey()
    .row(STOREYS, "peak drift ratio"),
    Demand::number("peak_drift_velocity_m_per_s", "peak drift velocity", Velocity, |d, i| {
        d.storeys.get(i).map(|storey| storey.peak_drift_velocity_m_per_s)
    })
    .of_storey()
    .row(STOREYS, "peak drift velocity"),
    Demand::number("peak_shear_n", "peak shear", Force, |d, i| {
        d.storeys.get(i).and_then(|storey| storey.peak_shear_n)
    })
    .of_storey(),
    Demand::number("peak_acceleration_m_per_s2", "peak acceleration", Acceleration, |d, i| {
        d.points.get(i).map(|point| point.peak_acceleration_m_per_s2)
    })
    .of_point()
    .row(STOREYS, "peak acceleration")
    .in_study(6),
    Demand::number("peak_displacement_m", "peak displacement", Length, |d, i| {
        d.points.get(i).map(|point| point.peak_displacement_m)
    })
    .of_point()
    .row(STOREYS, "peak displacement"),
    Demand::number("peak_drift_m", "peak drift", Length, |d, i| {
        d.points.get(i).map(|point| point.peak_drift_m)
    })
    .of_point()
    .row(STOREYS, "peak drift")
    .in_study(7),
    Demand::ratio("peak_drift_ratio", "peak drift ratio", |d, i| {
        d.points.get(i).and_then(|point| point.peak_drift_ratio)
    })
    .of_point()
    .row(STOREYS, "peak drift ratio"),
    Demand::number("peak_drift_velocity_m_per_s", "peak drift velocity", Velocity, |d, i| {
        d.points.get(i).map(|point| point.peak_drift_velocity_m_per_s)
    })
    .of_point()
    .row(STOREYS, "peak drift velocity"),
    Demand::number("peak_shear_n", "peak shear", Force, |d, i| {
        d.points.get(i).and_then(|point| point.peak_shear_n)
    })
    .of_point(),
    Demand::number("peak_base_shear_n", "peak base shear", Force, |d, _| Some(d.peak_base_shear_n))
        .row_with_storeys(30, "Peak base shear"),
    Demand::number("peak_friction_force_n", "peak friction force", Force, |d, _| {
        Some(d.peak_friction_force_n)
    })
    .row(32, "Peak friction force"),
    Demand::number("peak_slider_force_n", "peak slider force", Force, |d, _| {
        Some(d.peak_slider_force_n)
    })
    .row(34, "Peak slider force"),
    Demand::ratio("base_shear_coefficient", "base shear coefficient", |d, _| {
        Some(d.base_shear_coefficient)
    })
    .row_with_storeys(31, "  over the weight")
    .in_study(8),
    Demand::ratio("friction_coefficient_used", "friction coefficient used", |d, _| {
        Some(d.friction_coefficient_used)
    })
    .row(33, "  over the weight"),
    Demand::ratio("slider_force_coefficient", "slider force coefficient", |d, _| {
        Some(d.slider_force_coefficient)
    })
    .row(35, "  over the weight"),
    Demand::ratio("gap_ratio", "gap ratio", |d, _| d.gap_ratio)
        .row(36, "Peak sliding over gap")
        .in_study(3)
        .of_resultant(),
    Demand::ratio("overturning_ratio", "overturning ratio", |d, _| d.overturning_ratio)
        .row(43, "Overturning ratio"),
    Demand::ratio("closest_stop", "closest stop", |d, _| d.closest_stop)
        .not_in_summary()
        .of_resultant(),
    Demand::count("stop.contact_count", "stop contact count", |d, _| {
        of_stop(d, |stop| stop.contact_count as f64)
    })
    .of_stop()
    .note(54, "Contacts with the stop"),
    Demand::count("stop.impact_count", "stop impact count", |d, _| {
        of_stop(d, |stop| stop.impact_count as f64)
    })
    .of_stop()
    .note(55, "Impacts on the stop"),
    Demand::number("stop.peak_force_n", "stop peak force", Force, |d, _| {
        of_stop(d, |stop| stop.peak_force_n)
    })
    .of_stop()
    .row(40, "Peak force of the stop"),
    Demand::number("stop.peak_impact_speed_m_per_s", "stop peak impact speed", Velocity, |d, _| {
        of_stop(d, |stop| stop.peak_impact_speed_m_per_s)
    })
    .of_stop()
    .note(41, "  fastest contact"),
    Demand::number("stop.contact_time_s", "stop contact time", Time, |d, _| {
        of_stop(d, |stop| stop.contact_time_s)
    })
    .of_stop()
    .note(42, "  time in contact"),
    Demand::number("peak_displacement_m", "peak displacement", Length, |d, i| {
        d.surfaces.get(i).map(|surface| surface.peak_displacement_m)
    })
    .of_surface()
    .row(SURFACES, "peak displacement"),
    Demand::number("residual_displacement_m", "residual displacement", Length, |d, i| {
        d.surfaces.get(i).map(|surface| surface.residual_displacement_m)
    })
    .of_surface()
    .row(SURFACES, "residual displacement"),
    Demand::new("end_reached", "end reached", DemandKind::Flag, None, |d, i| {
        d.surfaces.get(i).map(|surface| f64::from(u8::from(surface.end_reached)))
    })
    .of_surface()
    .note(SURFACES, "end of travel reached"),
    Demand::number("peak_sliding_displacement_m", "peak sliding displacement", Length, |d, i| {
        of_contents(d, i, |contents| contents.peak_sliding_displacement_m)
    })
    .of_contents()
    .row(CONTENTS, "peak sliding displacement"),
    Demand::number(
        "residual_sliding_displacement_m",
        "residual sliding displacement",
        Length,
        |d, i| of_contents(d, i, |contents| contents.residual_sliding_displacement_m),
    )
    .of_contents()
    .row(CONTENTS, "residual sliding displacement"),
    Demand::number("sliding_path_m", "sliding path", Length, |d, i| {
        of_contents(d, i, |contents| contents.sliding_path_m)
    })
    .of_contents()
    .row(CONTENTS, "sliding path"),
    Demand::number("sliding_time_s", "sliding time", Time, |d, i| {
        of_contents(d, i, |contents| contents.sliding_time_s)
    })
    .of_contents()
    .note(CONTENTS, "time spent sliding"),
    Demand::number("peak_sliding_velocity_m_per_s", "peak sliding velocity", Velocity, |d, i| {
        of_contents(d, i, |contents| contents.peak_sliding_velocity_m_per_s)
    })
    .of_contents()
    .row(CONTENTS, "peak sliding velocity"),
    Demand::number("peak_acceleration_m_per_s2", "peak acceleration", Acceleration, |d, i| {
        of_contents(d, i, |contents| contents.peak_acceleration_m_per_s2)
    })
    .of_contents()
    .row(CONTENTS, "peak acceleration"),
    Demand::count("slip_count", "slip count", |d, i| {
        of_contents(d, i, |contents| contents.slip_count as f64)
    })
    .of_contents(),
    Demand::count("reversal_count", "reversal count", |d, i| {
        of_contents(d, i, |contents| contents.reversal_count as f64)
    })
    .of_contents(),
    Demand::count("stick_count", "stick count", |d, i| {
        of_contents(d, i, |contents| contents.stick_count as f64)
    })
    .of_contents(),
];

fn of_contents(demands: &Demands, i: usize, pick: fn(&ContentsDemands) -> f64) -> Option<f64> {
    demands.contents.get(i).map(pick)
}

fn of_stop(demands: &Demands, pick: fn(&StopDemands) -> f64) -> Option<f64> {
    demands.stop.as_ref().map(pick)
}

/// What a structure has that demands are asked of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DemandShape {
    /// Number of storeys.
    pub storeys: usize,
    /// Number of points of a structure by its modes, 0 of a frame.
    pub points: usize,
    /// Whether there is a stop that acts.
    pub stop: bool,
    /// Number of surfaces in series, 0 where there is one surface only.
    pub surfaces: usize,
    /// Number of contents of floors.
    pub contents: usize,
}

/// A demand of a structure: of the whole, or of one of its parts.
#[derive(Clone, Copy, Debug)]
pub struct DemandColumn {
    /// The demand.
    pub demand: &'static Demand,
    /// The number of the storey, surface or contents, from 1; 0 where it is of none.
    pub part: usize,
}

impl DemandShape {
    /// All demands of such a structure, in the order of tables: those of storeys storey by storey.
    #[must_use]
    pub fn columns(self) -> Vec<DemandColumn> {
        let mut columns = Vec::with_capacity(DEMANDS.len() + 4 * self.storeys);
        self.each(|column| columns.push(column));
        columns
    }

    /// How many parts of a kind there are.
    fn count(self, of: DemandOf) -> usize {
        match of {
            DemandOf::Run => 1,
            DemandOf::Stop => usize::from(self.stop),
            DemandOf::Storey => self.storeys,
            DemandOf::Point => self.points,
            DemandOf::Surface => self.surfaces,
            DemandOf::Contents => self.contents,
        }
    }

    fn each(self, mut take: impl FnMut(DemandColumn)) {
        let mut done = None;
        for demand in &DEMANDS {
            if demand.of.part().is_none() {
                if self.count(demand.of) > 0 {
                    take(DemandColumn { demand, part: 0 });
                }
            } else if done != Some(demand.of) {
                done = Some(demand.of);
                for part in 1..=self.count(demand.of) {
                    let own = DEMANDS.iter().filter(|other| other.of == demand.of);
                    own.for_each(|demand| take(DemandColumn { demand, part }));
                }
            }
        }
    }

    /// The demand with the name that tables give it, and its place in [`DemandShape::columns`].
    #[must_use]
    pub fn find(self, name: &str) -> Option<(usize, DemandColumn)> {
        self.columns().into_iter().enumerate().find(|(_, column)| column.name() == name)
    }

    /// The demand that people look at first: the total acceleration of the roof, or of the block.
    #[must_use]
    pub fn roof_acceleration(self) -> DemandColumn {
        let (of, part, key) = match (self.storeys, self.points) {
            (0, 0) => (DemandOf::Run, 0, "block.peak_acceleration_m_per_s2"),
            (0, points) => (DemandOf::Point, points, "peak_acceleration_m_per_s2"),
            (storeys, _) => (DemandOf::Storey, storeys, "peak_acceleration_m_per_s2"),
        };
        let found = DEMANDS.iter().position(|demand| demand.of == of && demand.key == key);
        DemandColumn { demand: &DEMANDS[found.unwrap_or(0)], part }
    }
}

impl PartialEq for DemandColumn {
    fn eq(&self, other: &Self) -> bool {
        core::ptr::eq(self.demand, other.demand) && self.part == other.part
    }
}

impl DemandColumn {
    /// The demand of any structure with this name in tables: `slip_count`, `storey12_peak_drift_m`.
    #[must_use]
    pub fn of_name(name: &str) -> Option<Self> {
        let of_part = [DemandOf::Storey, DemandOf::Point, DemandOf::Surface, DemandOf::Contents];
        let parted = of_part.into_iter().find_map(|of| {
            let (number, key) = name.strip_prefix(of.part()?)?.split_once('_')?;
            Some((Some(of), number.parse().ok().filter(|part| *part > 0)?, key))
        });
        let (of, part, key) = parted.unwrap_or((None, 0, name));
        let fits = |demand: &&Demand| match of {
            Some(of) => demand.of == of,
            None => demand.of.part().is_none(),
        };
        let demand = DEMANDS.iter().filter(fits).find(|demand| demand.key == key)?;
        Some(Self { demand, part })
    }

    /// Its name in tables: the key; what the summary has under `storeys[i].` is `storey1_…`.
    #[must_use]
    pub fn name(&self) -> String {
        match self.demand.of.part() {
            None => self.demand.key.to_owned(),
            Some(of) => format!("{of}{}_{}", self.part, self.demand.key),
        }
    }

    /// What a sentence calls it: `storey 2 peak drift`.
    #[must_use]
    pub fn words(&self) -> String {
        match self.demand.of.part() {
            None => self.demand.words.to_owned(),
            Some(of) => format!("{of} {} {}", self.part, self.demand.words),
        }
    }

    /// Its title: `Storey 2 peak drift`.
    #[must_use]
    pub fn title(&self) -> String {
        let words = self.words();
        let mut letters = words.chars();
        letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
    }

    /// What it measures; `None` for ratios, counts and flags.
    #[must_use]
    pub fn dimension(&self) -> Option<Dimension> {
        self.demand.dimension
    }

    /// The SI unit of its values; empty where they have none.
    #[must_use]
    pub fn unit(&self) -> &'static str {
        self.demand.unit()
    }

    /// Its value; `None` where it does not exist. A count is that number, a flag 0 or 1.
    #[must_use]
    pub fn value(&self, demands: &Demands) -> Option<f64> {
        (self.demand.value)(demands, self.part.wrapping_sub(1))
    }
}

/// The values of [`DemandShape::columns`] of the structure that these are the demands of; NaN where
/// one does not exist.
#[must_use]
pub fn demand_values(demands: &Demands) -> Vec<f64> {
    let mut values = Vec::with_capacity(DEMANDS.len() + 4 * demands.storeys.len());
    let mut push = |value: Option<f64>| values.push(value.unwrap_or(f64::NAN));
    demands.shape().each(|column| push(column.value(demands)));
    values
}

impl Demands {
    /// What the structure has that these are the demands of.
    #[must_use]
    pub fn shape(&self) -> DemandShape {
        DemandShape {
            storeys: self.storeys.len(),
            points: self.points.len(),
            stop: self.stop.is_some(),
            surfaces: self.surfaces.len(),
            contents: self.contents.len(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::response::StoreyDemands;

    #[test]
    fn columns_and_values_stand_in_the_same_order() {
        let storey = |peak_drift_m| StoreyDemands { peak_drift_m, ..Default::default() };
        let demands = Demands {
            peak_sliding_displacement_m: 1.0,
            slip_count: 2,
            sliding_at_end: true,
            storeys: vec![storey(3.0), storey(4.0)],
            overturning_ratio: Some(5.0),
            stop: Some(StopDemands { contact_count: 6, contact_time_s: 7.0, ..Default::default() }),
            ..Default::default()
        };
        let shape = DemandShape { storeys: 2, stop: true, ..DemandShape::default() };
        let (columns, values) = (shape.columns(), demand_values(&demands));
        assert_eq!(columns.len(), values.len());
        let of = |name: &str| values[shape.find(name).unwrap().0];
        assert_eq!(of("peak_sliding_displacement_m"), 1.0);
        assert_eq!(of("slip_count"), 2.0);
        assert_eq!(of("sliding_at_end"), 1.0);
        assert_eq!([of("storey1_peak_drift_m"), of("storey2_peak_drift_m")], [3.0, 4.0]);
        assert_eq!(of("overturning_ratio"), 5.0);
        assert_eq!([of("stop.contact_count"), of("stop.contact_time_s")], [6.0, 7.0]);
        assert!(of("gap_ratio").is_nan() && of("storey1_peak_drift_ratio").is_nan());
    }

    /// No name twice, every name found again, and names end in the unit of their demand.
    #[test]
    fn names_are_found_again() {
        let columns =
            DemandShape { storeys: 12, points: 3, stop: true, surfaces: 3, contents: 2 }.columns();
        for (i, column) in columns.iter().enumerate() {
            let name = column.name();
            assert_eq!(DemandColumn::of_name(&name), Some(*column), "{name}");
            assert!(columns[..i].iter().all(|other| other.name() != name), "{name}");
            let unit = column.unit().replace('/', "_per_").to_lowercase();
            assert!(unit.is_empty() || name.ends_with(&format!("_{unit}")), "{name}: {unit}");
        }
        for wrong in ["storey0_peak_drift_m", "storey_peak_drift_m", "peak_drift_m", "x", ""] {
            assert_eq!(DemandColumn::of_name(wrong), None, "{wrong}");
        }
        let title = |name: &str| DemandColumn::of_name(name).unwrap().title();
        assert_eq!(title("peak_sliding_displacement_m"), "Peak sliding displacement");
        assert_eq!(title("storey2_peak_acceleration_m_per_s2"), "Storey 2 peak acceleration");
        assert_eq!(title("block.peak_acceleration_m_per_s2"), "Block peak acceleration");
    }
}
