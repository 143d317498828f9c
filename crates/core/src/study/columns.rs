//! The columns of a study's table.

use super::cases::status;
use super::demanded::TRAVEL_USED_UP;
use super::{Row, Study};
use crate::response::{DemandColumn, InDirections, Response, demand_values};
use crate::table::{Cells, Column, Field, Kind, Table};

/// What stands before the names of demands by axis.
const AXES: [&str; 2] = ["x.", "y."];

/// The demands of a structure that exist along an axis.
fn along_an_axis(columns: &[DemandColumn]) -> impl Iterator<Item = DemandColumn> {
    columns.iter().copied().filter(|c| c.demand.in_directions != InDirections::Resultant)
}

impl Study {
    /// The columns of demands, those of [`Study::shape`] first, each after what stands before its name; in two
    /// horizontal directions they are of the resultants, and those along x and then along y follow.
    pub(super) fn demand_columns(&self) -> Vec<(&'static str, DemandColumn)> {
        let all = self.shape.columns();
        let axes = if self.in_plane { &AXES[..] } else { &[] };
        let by_axis = axes.iter().flat_map(|axis| along_an_axis(&all).map(|c| (*axis, c)));
        all.iter().map(|column| ("", *column)).chain(by_axis).collect()
    }

    /// The values of [`Study::demand_columns`]; NaN where one does not exist.
    pub(super) fn demands(&self, response: &Response) -> Vec<f64> {
        if !self.in_plane {
            return demand_values(&response.demands);
        }
        let all = self.shape.columns();
        let nan = |value: Option<f64>| value.unwrap_or(f64::NAN);
        let of_resultant = all.iter().map(|column| match column.demand.in_directions {
            InDirections::Axis => f64::NAN,
            _ => nan(column.value(&response.demands)),
        });
        let axes = response.in_plane.as_ref().map(|plane| plane.axes.each_ref());
        let of_axis = |i: usize| {
            along_an_axis(&all).map(move |c| nan(axes.and_then(|axes| c.value(axes[i]))))
        };
        of_resultant.chain((0..AXES.len()).flat_map(of_axis)).collect()
    }

    /// The columns of the study's table: the run, its motion and the measures of that, the varied
    /// values, the demands, warnings and status.
    #[must_use]
    pub fn fields(&self) -> Vec<Field> {
        let run = Field { kind: Kind::Count, ..Field::number("run", "").required() };
        let mut fields = vec![
            run,
            Field::text("record"),
            Field::text("channel"),
            Field::number("level", self.level_unit()),
            Field::number("scale", "").required(),
        ];
        fields.extend(self.has_clusters().then(|| Field::text("pair")));
        fields.extend(self.measures.iter().map(|m| Field::number(m.column(), m.unit())));
        fields.extend(self.has_bounds().then(|| Field::text("friction")));
        let varied = self.design.vary().iter();
        fields.extend(varied.map(|varied| Field::number(varied.path.clone(), varied.unit)));
        fields.extend(self.demand_columns().iter().map(|(axis, column)| Field {
            kind: column.demand.kind.into(),
            ..Field::number(format!("{axis}{}", column.name()), column.unit())
        }));
        let travels = self.shape.surfaces > 0;
        fields.extend(travels.then(|| Field::number(TRAVEL_USED_UP, "m")));
        fields.extend([Field::text("warnings"), Field::text("status")]);
        fields
    }

    /// Index of the first demand among [`Study::fields`].
    #[must_use]
    pub fn first_demand(&self) -> usize {
        5 + usize::from(self.has_clusters())
            + self.measures.len()
            + usize::from(self.has_bounds())
            + self.design.vary().len()
    }

    /// Index of the column of travels that runs have used up, where the model has surfaces in series.
    #[must_use]
    pub fn travel_used_up(&self) -> Option<usize> {
        (self.shape.surfaces > 0).then(|| self.first_demand() + self.demand_columns().len())
    }

    /// Rows as the cells of [`Study::fields`].
    #[must_use]
    pub fn cells(&self, rows: &[Row]) -> Vec<Cells> {
        let texts = |text: &dyn Fn(&Row) -> String| Cells::Texts(rows.iter().map(text).collect());
        let numbers =
            |number: &dyn Fn(&Row) -> f64| Cells::Numbers(rows.iter().map(number).collect());
        let record = |row: &Row| self.records.get(row.case.record);
        let of = |list: &[f64], i: usize| list.get(i).copied().unwrap_or(f64::NAN);
        let mut cells = vec![
            Cells::Counts(rows.iter().map(|row| Some(row.run as i64)).collect()),
            texts(&|row| record(row).map_or(self.made_motion().to_owned(), |r| r.name.clone())),
            texts(&|row| record(row).map_or_else(String::new, |r| r.channel.clone())),
            numbers(&|row| self.level_of(&row.case)),
            numbers(&|row| row.case.scale),
        ];
        if self.has_clusters() {
            let pair = |row: &Row| self.cluster_name(row.case.record).to_owned();
            cells.push(texts(&pair));
        }
        cells.extend((0..self.measures.len()).map(|i| numbers(&|row| of(&row.measures, i))));
        if self.has_bounds() {
            cells.push(texts(&|row| self.bound(&row.case).name.to_owned()));
        }
        let varied = self.design.vary().len();
        cells.extend((0..varied).map(|i| numbers(&|row| of(&row.values, i))));
        cells.extend(self.demand_columns().iter().enumerate().map(|(i, (_, column))| {
            Cells::of_numbers(column.demand.kind.into(), rows.iter().map(|row| of(&row.demands, i)))
        }));
        if self.shape.surfaces > 0 {
            cells.push(numbers(&|row| row.travel_used_up_m().unwrap_or(f64::NAN)));
        }
        cells.push(texts(&Row::kinds));
        cells.push(texts(&|row| status(row.error.as_ref())));
        cells
    }

    /// Rows as a table.
    #[must_use]
    pub fn table(&self, rows: &[Row]) -> Table {
        let columns = self.fields().into_iter().zip(self.cells(rows));
        let column = |(field, cells): (Field, Cells)| {
            let Field { name, unit, .. } = field;
            Column { name, unit, cells }
        };
        Table { columns: columns.map(column).collect() }
    }
}
