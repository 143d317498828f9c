//! Runs and records as tables that the page shows and takes runs from.

use slipstick::input::loaded::{Loaded, Wanted};
use slipstick::motion::intensity::LevelMeasure;
use slipstick::record::Options;
use slipstick::requests::measured;
use slipstick::response::DemandColumn;
use slipstick::table::{Cells, Column};
use slipstick::units::Dimension;
use slipstick_report::DisplayUnits;
use slipstick_report::assessment::answer::Tabled;
use slipstick_report::assessment::key::{of_measure, quantity, title};
use slipstick_report::display::{Quantity, Unit};
use slipstick_report::json::{Serialize, cell_values, each, pretty};
use slipstick_report::number::typeset_sentence;
use slipstick_report::view;

use crate::answer::shown_unit;
use crate::failure::Failure;
use crate::records::Records;

/// Tables as `[{name, columns: [{name, title, unit: {in_si, symbol}, si, path, values}]}]`, values in SI,
/// whose unit is `si`; `path` where it is one of the model.
pub fn tables(tabled: &[Tabled], display: DisplayUnits) -> String {
    pretty(&each(tabled, |Tabled { name, table, .. }| {
        view! { name, columns: each(&table.columns, |column| self::column(column, display)) }
    }))
}

fn column(Column { name, unit, cells }: &Column, display: DisplayUnits) -> impl Serialize {
    let largest = match cells {
        Cells::Numbers(numbers) => {
            numbers.iter().filter(|v| v.is_finite()).fold(0.0_f64, |l, v| l.max(v.abs()))
        }
        _ => 0.0,
    };
    let shown = if name == "level" || name == "capacity" {
        of_measure(unit, display, largest)
    } else {
        unit_of(name, unit, display, largest)
    };
    // A path is called as the model calls it; demands by axis have points in their names too.
    let by_axis = name.starts_with("x.") || name.starts_with("y.");
    let path = name.contains('.') && !by_axis && measured(name).0.is_none();
    let title = if path { name.clone() } else { title(name) };
    view! {
        name,
        title,
        unit: shown_unit(shown),
        si: unit,
        path,
        values: cell_values(cells),
    }
}

fn unit_of(name: &str, si: &str, display: DisplayUnits, largest: f64) -> Unit {
    if DemandColumn::of_name(name).is_some() {
        return display.unit(quantity(name), largest);
    }
    let of =
        Dimension::ALL.into_iter().find(|dimension| !si.is_empty() && dimension.si_unit() == si);
    match Quantity::from(of) {
        Quantity::Ratio => Unit { in_si: 1.0, symbol: of.map_or("", Dimension::si_unit) },
        quantity => display.unit(quantity, largest),
    }
}

/// Demands of a model to choose from: `[{name, title, unit}]`.
pub fn demands(columns: &[DemandColumn], display: DisplayUnits) -> impl Serialize {
    each(columns, |column| {
        let name = column.name();
        let unit = shown_unit(unit_of(&name, column.unit(), display, 0.1));
        view! { name, title: column.title(), unit }
    })
}

/// What is known of one record: `{pga, pgv, measure, notices}`, each figure with its unit, the measure where
/// one is asked for.
pub fn surveyed(
    records: &mut Records,
    name: &str,
    options: &Options,
    channel: Option<&str>,
    measure: &str,
    display: DisplayUnits,
) -> Result<String, Failure> {
    let record = crate::sheets::read(records, name, options)?;
    let loaded = Loaded::recorded(Wanted { record, channel }, None);
    let loaded = loaded.map_err(|error| Failure::of(format!("{name}: {error}")))?;
    let figures = loaded.figures;
    let figure = |value: f64, unit: Unit| view! { value, unit: shown_unit(unit) };
    let measured = match measure.trim() {
        "" => None,
        text => {
            let measure =
                LevelMeasure::parse(text).map_err(|error| Failure::of(error.to_string()))?;
            let value = measure.of(&loaded.motion, None).map_err(Failure::of)?;
            Some(figure(value, of_measure(measure.unit(), display, value)))
        }
    };
    let [pga, pgv] = [figures.pga_m_per_s2, figures.pgv_m_per_s];
    Ok(pretty(&view! {
        pga: figure(pga, of_measure("m/s2", display, pga)),
        pgv: figure(pgv, display.unit(Quantity::Velocity, pgv)),
        measure: measured,
        duration_s: loaded.motion.duration_s(),
        notices: each(&loaded.warnings, |notice| {
            format!("{}: {}", notice.label(), typeset_sentence(&display.sentence(&notice.message)))
        }),
    }))
}
