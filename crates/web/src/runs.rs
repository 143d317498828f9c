//! Runs and records as tables that the page shows and takes runs from.

use slipstick::input::loaded::{Loaded, Wanted};
use slipstick::motion::intensity::LevelMeasure;
use slipstick::notice::Notice;
use slipstick::record::Options;
use slipstick::requests::measured;
use slipstick::response::DemandColumn;
use slipstick::table::{Cells, Column};
use slipstick::units::Dimension;
use slipstick_report::DisplayUnits;
use slipstick_report::assessment::answer::Tabled;
use slipstick_report::assessment::key::{of_measure, quantity, title};
use slipstick_report::display::{Quantity, Unit};
use slipstick_report::json::Json;

use crate::failure::Failure;
use crate::records::Records;
use crate::session::texts;

/// Tables as `[{name, columns: [{name, title, unit: {in_si, symbol}, si, path, values}]}]`, values in SI,
/// whose unit is `si`; `path` where it is one of the model.
pub fn tables(tabled: &[Tabled], display: DisplayUnits) -> Json {
    let one = |Tabled { name, table, .. }: &Tabled| {
        let columns = table.columns.iter().map(|column| self::column(column, display));
        Json::Object(vec![("name", (*name).into()), ("columns", Json::List(columns.collect()))])
    };
    Json::List(tabled.iter().map(one).collect())
}

fn column(Column { name, unit, cells }: &Column, display: DisplayUnits) -> Json {
    let count = |cell: &Option<i64>| cell.map_or(Json::Null, |value| (value as f64).into());
    let flag = |cell: &Option<bool>| cell.map_or(Json::Null, Json::Bool);
    let values = match cells {
        Cells::Numbers(numbers) => Json::List(numbers.iter().map(|v| (*v).into()).collect()),
        Cells::Counts(counts) => Json::List(counts.iter().map(count).collect()),
        Cells::Flags(flags) => Json::List(flags.iter().map(flag).collect()),
        Cells::Texts(all) => texts(all.iter().map(String::as_str)),
    };
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
    Json::Object(vec![
        ("name", name.as_str().into()),
        ("title", Json::Text(title)),
        ("unit", self::unit(shown)),
        ("si", unit.as_str().into()),
        ("path", path.into()),
        ("values", values),
    ])
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

fn unit(unit: Unit) -> Json {
    Json::Object(vec![("in_si", unit.in_si.into()), ("symbol", unit.symbol.into())])
}

/// Demands of a model to choose from: `[{name, title, unit}]`.
pub fn demands(columns: &[DemandColumn], display: DisplayUnits) -> Json {
    let one = |column: &DemandColumn| {
        let (name, si) = (column.name(), column.unit());
        Json::Object(vec![
            ("name", Json::Text(name.clone())),
            ("title", Json::Text(column.title())),
            ("unit", self::unit(unit_of(&name, si, display, 0.1))),
        ])
    };
    Json::List(columns.iter().map(one).collect())
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
) -> Result<Json, Failure> {
    let record = crate::sheets::read(records, name, options)?;
    let loaded = Loaded::recorded(Wanted { record, channel }, None);
    let loaded = loaded.map_err(|error| Failure::of(format!("{name}: {error}")))?;
    let figures = loaded.figures;
    let figure = |value: f64, unit: Unit| {
        Json::Object(vec![("value", value.into()), ("unit", self::unit(unit))])
    };
    let measured = match measure.trim() {
        "" => Json::Null,
        text => {
            let measure =
                LevelMeasure::parse(text).map_err(|error| Failure::of(error.to_string()))?;
            let value = measure.of(&loaded.motion, None).map_err(Failure::of)?;
            figure(value, of_measure(measure.unit(), display, value))
        }
    };
    let notice = |notice: &Notice| {
        Json::Text(format!("{}: {}", notice.label(), display.sentence(&notice.message)))
    };
    Ok(Json::Object(vec![
        ("pga", figure(figures.pga_m_per_s2, of_measure("m/s2", display, figures.pga_m_per_s2))),
        ("pgv", figure(figures.pgv_m_per_s, display.unit(Quantity::Velocity, figures.pgv_m_per_s))),
        ("measure", measured),
        ("duration_s", loaded.motion.duration_s().into()),
        ("notices", Json::List(loaded.warnings.iter().map(notice).collect())),
    ]))
}
