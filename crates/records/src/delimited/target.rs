//! A spectrum as offices have it: a table of periods and spectral accelerations.

use super::header::{Header, Name, Unit};
use super::table::TextTable;
use crate::text::Text;
use slipstick_dynamics::error::RecordError;
use slipstick_dynamics::motion::Quantity;
use slipstick_dynamics::motion::target::TargetSpectrum;

/// Reads the periods, `T`, `Tn` or `Period`, in s where no unit says otherwise, and the accelerations,
/// `Sa`, `Sae` or `PSA`, whose unit must stand with the name, in any brackets.
pub(crate) fn read(text: &Text) -> Result<TargetSpectrum, RecordError> {
    let header = Header::of(text)?;
    let table = TextTable::read(text, &header)?;
    let names = header.names(text, &table)?.unwrap_or_default();
    let found = || match names.is_empty() {
        true => "no names of columns".to_owned(),
        false => format!("the columns {}", header.names_line()),
    };
    let periods = "a column of periods, T, Tn or Period";
    let columns = |is: &dyn Fn(&Name) -> bool| -> Vec<usize> {
        (0..names.len()).filter(|column| is(&names[*column])).collect()
    };
    let is_period = |name: &Name| {
        let is_seconds = matches!(name.unit, None | Some(Unit::Time(_)));
        name.may_be_period() && is_seconds
    };
    let &[period] = &columns(&is_period)[..] else {
        return Err(header.error(text, periods, &found()));
    };
    let is_acceleration = |name: &Name| match name.unit {
        Some(Unit::Motion(units)) => {
            name.is_spectral_acceleration() && units.quantity() == Quantity::Acceleration
        }
        _ => false,
    };
    let all = columns(&is_acceleration);
    let plain = || all.iter().copied().find(|c| names[*c].base().eq_ignore_ascii_case("sa"));
    let one = if let &[one] = &all[..] { Some(one) } else { plain() };
    let Some(ordinate) = one else {
        let expected = "one column of spectral acceleration with its unit, such as sa_g, Sae (g) or \
                        PSA [m/s2]";
        return Err(header.error(text, expected, &found()));
    };
    let second = match names[period].unit {
        Some(Unit::Time(second)) => second,
        _ => 1.0,
    };
    let unit = match names[ordinate].unit {
        Some(Unit::Motion(units)) => units.si(),
        _ => 1.0,
    };
    table.require(text, period)?;
    table.require(text, ordinate)?;
    let periods_s = table.column(period).map(|t| t * second).collect();
    let sa_m_per_s2 = table.column(ordinate).map(|sa| sa * unit).collect();
    TargetSpectrum::points(periods_s, sa_m_per_s2).map_err(|error| {
        let expected = "periods that rise and accelerations above 0";
        table.error_found(text, expected, &error.to_string())
    })
}
