//! The rows of the tables of demands, shared by the plain-text table and the report.

use slipstick::response::{DemandColumn, DemandKind, DemandOf, Demands, InDirections, PrintedRow};

use crate::display::{DisplayUnits, Unit};
use crate::markup::shortened;
use crate::number::significant;
use crate::summary::Summary;

/// One quantity over the runs side by side.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// What it is.
    pub label: String,
    /// Symbol of its unit, empty for ratios.
    pub unit: &'static str,
    /// One value a run, 4 significant digits in plain characters.
    pub values: Vec<String>,
    /// The run whose value is largest in size, where there are several and they differ.
    pub governing: Option<usize>,
}

/// Rows of the demands that are numbers, in the order in which an engineer asks: sliding, block,
/// storeys, forces, ratios.
///
/// The columns are those of [`Summary::runs`].
#[must_use]
pub fn rows(summary: &Summary, display: DisplayUnits) -> Vec<Row> {
    demand_rows(summary, display, |kind| kind == DemandKind::Number)
}

/// Rows of the demands that are counts and flags.
#[must_use]
pub fn count_rows(summary: &Summary) -> Vec<Row> {
    demand_rows(summary, DisplayUnits::Si, |kind| kind != DemandKind::Number)
}

fn demand_rows(
    summary: &Summary,
    display: DisplayUnits,
    wanted: impl Fn(DemandKind) -> bool,
) -> Vec<Row> {
    let demands = &summary.demands;
    let shape = demands.shape();
    let shown = |column: DemandColumn| {
        let printed = column.demand.row?;
        let all = [demands, along_x(summary), along_y(summary)];
        let has_value = all.into_iter().any(|demands| column.value(demands).is_some());
        let has_structure = shape.storeys + shape.points > 0;
        let fits = has_value && (has_structure || !printed.needs_storeys);
        (fits && wanted(column.demand.kind)).then_some((printed, column))
    };
    let mut rows: Vec<(PrintedRow, DemandColumn)> =
        shape.columns().into_iter().filter_map(shown).collect();
    rows.sort_by_key(|row| row.0.place);
    rows.iter()
        .flat_map(|(printed, column)| directions(summary, display, printed, column))
        .collect()
}

/// The row of a demand; in two horizontal directions that of the resultant, and one an axis below it.
fn directions(
    summary: &Summary,
    display: DisplayUnits,
    printed: &PrintedRow,
    column: &DemandColumn,
) -> Vec<Row> {
    let row = |of: fn(&Summary) -> &Demands| row(summary, display, printed, column, of);
    let of_resultant = || row(|run| &run.demands);
    let along = || [("along x", row(along_x)), ("along y", row(along_y))];
    match column.demand.in_directions {
        _ if summary.by_axis.is_none() => vec![of_resultant()],
        InDirections::Resultant => vec![of_resultant()],
        // What is over the weight is told of the resultant.
        InDirections::Both if printed.label.starts_with(' ') => vec![of_resultant()],
        InDirections::Both => {
            let below = along().map(|(axis, row)| Row { label: format!("  {axis}"), ..row });
            [of_resultant()].into_iter().chain(below).collect()
        }
        InDirections::Axis => {
            let named = |(axis, row): (&str, Row)| {
                let label = match row.label.strip_suffix('x') {
                    Some(towards) => format!("{towards}{}", axis.trim_start_matches("along ")),
                    None => format!("{} {axis}", row.label),
                };
                Row { label, ..row }
            };
            along().map(named).into()
        }
    }
}

fn along_x(run: &Summary) -> &Demands {
    run.by_axis.as_ref().map_or(&run.demands, |by_axis| &by_axis.demands[0])
}

fn along_y(run: &Summary) -> &Demands {
    run.by_axis.as_ref().map_or(&run.demands, |by_axis| &by_axis.demands[1])
}

fn row(
    summary: &Summary,
    display: DisplayUnits,
    printed: &PrintedRow,
    column: &DemandColumn,
    of: fn(&Summary) -> &Demands,
) -> Row {
    let of_run = |(_, run): (_, &Summary)| column.value(of(run)).unwrap_or(f64::NAN);
    let values: Vec<f64> = summary.runs().into_iter().map(of_run).collect();
    let largest = values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    let Unit { in_si, symbol } = display.unit(column.dimension().into(), largest);
    let text = |value: &f64| match column.demand.kind {
        DemandKind::Number => significant(value / in_si, 4),
        DemandKind::Count => value.to_string(),
        DemandKind::Flag => if *value != 0.0 { "yes" } else { "no" }.to_owned(),
    };
    let label = match (column.demand.of, column.part) {
        // One force passes through all surfaces, slopes and friction alike.
        _ if column.demand.key == "peak_friction_force_n"
            && !summary.demands.surfaces.is_empty() =>
        {
            "Peak friction and restoring force".to_owned()
        }
        (DemandOf::Run | DemandOf::Stop, _) => match &summary.names.block {
            Some(name) => printed.label.replace("block", &shortened(name, 24)),
            None => printed.label.to_owned(),
        },
        (DemandOf::Storey | DemandOf::Point, point) => {
            format!("{} {}", shortened(&summary.names.point(point), 24), printed.label)
        }
        (DemandOf::Surface, surface) => format!("Surface {surface} {}", printed.label),
        (DemandOf::Contents, contents) => format!("Contents {contents} {}", printed.label),
    };
    Row {
        label,
        unit: symbol,
        values: values.iter().map(text).collect(),
        governing: if printed.governs { governing(&values) } else { None },
    }
}

/// Index of the value largest in size, unless there is one value only or all are the same.
fn governing(values: &[f64]) -> Option<usize> {
    let largest = values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    if values.iter().all(|value| value.abs() == largest) {
        return None;
    }
    values.iter().position(|value| value.abs() == largest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_in_size_governs() {
        assert_eq!(governing(&[1.0, -3.0, 2.0]), Some(1));
        assert_eq!(governing(&[2.0]), None);
        assert_eq!(governing(&[2.0, 2.0, 2.0]), None);
    }
}
