//! Records written as text: CSV, PEER AT2 (VT2, DT2) and SMC.

use core::fmt::Write;

use super::{Channel, Quantity, Sampling};
use slipstick_dynamics::error::RecordWriteError;
use slipstick_dynamics::units::STANDARD_GRAVITY_M_PER_S2;

/// The number that stands for an unknown integer in SMC.
const SMC_INTEGER: i64 = -32768;

/// The number that stands for an unknown real in SMC.
const SMC_REAL: f64 = 1.7e38;

/// CSV of times in s and values in SI, 17 significant digits: reading it gives the same numbers.
///
/// # Errors
/// [`RecordWriteError::Counts`] for a channel that is no motion.
pub fn write_csv(channel: &Channel) -> Result<String, RecordWriteError> {
    let column = match channel.units.quantity() {
        Quantity::Acceleration => "acceleration_m_per_s2",
        Quantity::Velocity => "velocity_m_per_s",
        Quantity::Displacement => "displacement_m",
        Quantity::Counts => return Err(RecordWriteError::Counts),
    };
    let mut text = format!("time_s,{column}\n");
    let time_s = |i: usize| match &channel.sampling {
        Sampling::Dt(dt_s) => i as f64 * dt_s,
        Sampling::Times(times_s) => times_s[i],
    };
    for (i, value) in channel.values.iter().enumerate() {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{:.16e},{value:.16e}", time_s(i));
    }
    Ok(text)
}

/// PEER AT2 in g, VT2 in cm/s or DT2 in cm: five values a line of eight significant digits.
///
/// # Errors
/// [`RecordWriteError`] for a channel that is no motion, or is not evenly sampled.
pub fn write_at2(channel: &Channel) -> Result<String, RecordWriteError> {
    let dt_s = even_step(channel, "AT2")?;
    let (quantity, units, si) = match channel.units.quantity() {
        Quantity::Acceleration => ("ACCELERATION", "G", STANDARD_GRAVITY_M_PER_S2),
        Quantity::Velocity => ("VELOCITY", "CM/S", 0.01),
        Quantity::Displacement => ("DISPLACEMENT", "CM", 0.01),
        Quantity::Counts => return Err(RecordWriteError::Counts),
    };
    // Commas divide event, station and component.
    let label = |text: &Option<String>| one_line(text).replace(',', ";");
    let mut text = format!(
        "PEER FORMAT, WRITTEN BY SLIPSTICK\n{}, {}, {}\n{quantity} TIME SERIES IN UNITS OF \
         {units}\nNPTS= {:6}, DT= {dt_s} SEC",
        one_line(&channel.event),
        label(&channel.station),
        label(&channel.component),
        channel.values.len()
    );
    for (i, value) in channel.values.iter().enumerate() {
        text.push(if i % 5 == 0 { '\n' } else { ' ' });
        text.push_str(&exponential(value / si, 7, 2));
    }
    text.push('\n');
    Ok(text)
}

/// SMC in cm/s², cm/s or cm: eight fields of ten columns a line. A field has as many digits as fit,
/// five at least, with or without an exponent: FORTRAN's E10.4 reads either.
///
/// # Errors
/// [`RecordWriteError`] for a channel that is no motion, is not evenly sampled, or has a value of
/// 10¹⁰ or more.
pub fn write_smc(channel: &Channel) -> Result<String, RecordWriteError> {
    let dt_s = even_step(channel, "SMC")?;
    let kind = match channel.units.quantity() {
        Quantity::Acceleration => "2 CORRECTED ACCELEROGRAM",
        Quantity::Velocity => "3 VELOCITY",
        Quantity::Displacement => "4 DISPLACEMENT",
        Quantity::Counts => return Err(RecordWriteError::Counts),
    };
    let values: Vec<f64> = channel.values.iter().map(|value| value * 100.0).collect();
    let mut text = format!("{kind}\n*\n*\n");
    // Year, day and time are the event's own business: its text stands where the name does.
    let event = one_line(&channel.event);
    let _ = writeln!(text, "{}", if event.is_empty() { "*" } else { &event });
    let station: String = one_line(&channel.station).chars().take(29).collect();
    let component = one_line(&channel.component);
    let _ = writeln!(text, "*\nstation = {station:<29} component= {component}\n*\n*\n*\n*\n*");
    let mut integers = [SMC_INTEGER; 48];
    (integers[15], integers[16]) = (1, values.len() as i64);
    if let Some(azimuth) = channel.azimuth_deg {
        (integers[12], integers[13]) = (90, libm::round(azimuth) as i64);
    }
    for line in integers.chunks(8) {
        line.iter().for_each(|integer| text.push_str(&format!("{integer:10}")));
        text.push('\n');
    }
    let mut reals = [SMC_REAL; 50];
    reals[1] = 1.0 / dt_s;
    let extreme = |better: fn(f64, f64) -> bool| {
        let first = (0, values[0]);
        let all = values.iter().copied().enumerate();
        all.fold(first, |best, next| if better(next.1, best.1) { next } else { best })
    };
    let (at_largest, largest) = extreme(|a, b| a > b);
    let (at_least, least) = extreme(|a, b| a < b);
    (reals[28], reals[29]) = (at_largest as f64 * dt_s, largest);
    (reals[30], reals[31]) = (at_least as f64 * dt_s, least);
    reals[32] = channel.filter.high_pass_hz.unwrap_or(SMC_REAL);
    reals[34] = channel.filter.low_pass_hz.unwrap_or(SMC_REAL);
    for line in reals.chunks(5) {
        line.iter().for_each(|real| text.push_str(&format!("{:>15}", exponential(*real, 7, 2))));
        text.push('\n');
    }
    text.push_str("| written by Slipstick\n");
    for line in values.chunks(8) {
        for value in line {
            let field = smc_field(*value).ok_or(RecordWriteError::TooLarge { value: *value })?;
            text.push_str(&format!("{field:>10}"));
        }
        text.push('\n');
    }
    Ok(text)
}

fn even_step(channel: &Channel, format: &'static str) -> Result<f64, RecordWriteError> {
    match channel.sampling {
        Sampling::Dt(dt_s) => Ok(dt_s),
        Sampling::Times(_) => Err(RecordWriteError::Uneven { format }),
    }
}

/// A label without ends of lines.
fn one_line(text: &Option<String>) -> String {
    text.iter().flat_map(|text| text.split_whitespace()).collect::<Vec<_>>().join(" ")
}

/// A number as FORTRAN's `1PEw.d` prints it: `-1.2345678E-03`, a blank where there is no sign. What
/// needs more digits in its exponent is zero or, where it is large, keeps them.
fn exponential(value: f64, decimals: usize, digits: usize) -> String {
    let text = format!("{value:.decimals$e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if exponent.unsigned_abs() >= 10_u32.pow(digits as u32) && exponent < 0 {
        return exponential(0.0, decimals, digits);
    }
    let sign = if exponent < 0 { '-' } else { '+' };
    let blank = if mantissa.starts_with('-') { "" } else { " " };
    format!("{blank}{mantissa}E{sign}{:0digits$}", exponent.unsigned_abs())
}

/// The ten columns, the first of them a sign or blank, that come closest to a value.
fn smc_field(value: f64) -> Option<String> {
    let exponential = exponential(value, 4, 1);
    let decimals = (0..=7).rev();
    let plain = decimals.map(|decimals| format!("{value: >9.decimals$}"));
    let width = if value < 0.0 { 10 } else { 9 };
    let mut plain = plain.filter(|text| text.len() <= width && text.contains('.'));
    let error =
        |text: &str| text.trim().parse::<f64>().map_or(f64::INFINITY, |v| (v - value).abs());
    let fits = (exponential.len() == 10).then_some(exponential);
    match (plain.next(), fits) {
        (Some(plain), Some(other)) if error(&other) < error(&plain) => Some(other),
        (Some(plain), _) => Some(plain),
        (None, other) => other,
    }
}

#[cfg(test)]
mod tests {
    use super::super::{FilterCorners, Options, Record, Units, read};
    use super::*;
    use proptest::prelude::*;

    fn channel(units: &str, values: Vec<f64>, dt_s: f64) -> Channel {
        Channel {
            name: "N08W".to_owned(),
            event: Some("Made up, 1 January".to_owned()),
            station: Some("Nowhere, hall 2".to_owned()),
            component: Some("N08W".to_owned()),
            azimuth_deg: Some(352.0),
            units: Units::parse(units).unwrap(),
            values,
            sampling: Sampling::Dt(dt_s),
            filter: FilterCorners { high_pass_hz: Some(0.1), low_pass_hz: Some(25.0) },
            warnings: vec![],
        }
    }

    fn back(text: &str) -> Record {
        read("f", text.as_bytes(), &Options::default()).unwrap_or_else(|e| panic!("{e}\n{text}"))
    }

    #[test]
    fn fields_keep_their_width() {
        for (value, field) in [
            (1.5057, " 1.5057000"),
            (-2.2223, "-2.2223000"),
            (0.0, " 0.0000000"),
            (123.456_789_1, " 123.45679"),
            (-12_345.678_91, "-12345.679"),
            (1.234_567e-6, "1.2346E-6"),
            (9.876e9, " 9.8760E+9"),
        ] {
            assert_eq!(smc_field(value).unwrap().trim(), field.trim(), "{value}");
        }
        assert_eq!(smc_field(1e10), None);
        assert_eq!(exponential(-0.001_234_567_84, 7, 2), "-1.2345678E-03");
        assert_eq!(exponential(1.7e38, 7, 2), " 1.7000000E+38");
        assert_eq!(exponential(1e-120, 7, 2), " 0.0000000E+00");
    }

    #[test]
    fn labels_survive() {
        let values = vec![0.0, 1.0, -2.0, 0.5];
        let written = channel("g", values, 0.005);
        for text in [write_at2(&written).unwrap(), write_smc(&written).unwrap()] {
            let record = back(&text);
            let read = &record.channels[0];
            assert_eq!(read.event, written.event, "{text}");
            assert_eq!(read.component, written.component);
            assert_eq!(read.azimuth_deg, written.azimuth_deg);
            assert_eq!(read.sampling, written.sampling);
            assert!(read.warnings.iter().all(|w| super::super::REST_KINDS.contains(&w.kind)));
        }
        let smc = back(&write_smc(&written).unwrap());
        assert_eq!(smc.channels[0].filter, written.filter);
        assert_eq!(smc.channels[0].station, written.station);
        let at2 = back(&write_at2(&written).unwrap());
        assert_eq!(at2.channels[0].station.as_deref(), Some("Nowhere; hall 2"));
    }

    #[test]
    fn what_cannot_be_written() {
        let counts = channel("counts", vec![1.0, 2.0], 0.01);
        assert_eq!(write_csv(&counts), Err(RecordWriteError::Counts));
        let mut uneven = channel("g", vec![1.0, 2.0, 3.0], 0.01);
        uneven.sampling = Sampling::Times(vec![0.0, 1.0, 3.0]);
        assert_eq!(write_at2(&uneven), Err(RecordWriteError::Uneven { format: "AT2" }));
        assert_eq!(
            write_smc(&uneven).unwrap_err().to_string(),
            "SMC has no times: expected even sampling, found uneven (resample it, or write CSV)"
        );
        assert_eq!(back(&write_csv(&uneven).unwrap()).channels[0].sampling, uneven.sampling);
        let large = channel("m/s2", vec![0.0, 1e9], 0.01);
        assert!(matches!(write_smc(&large), Err(RecordWriteError::TooLarge { .. })));
    }

    proptest! {
        #[test]
        fn prop_round_trips(
            values in proptest::collection::vec(-30.0..30.0_f64, 2..60),
            dt in 1_u32..400, kind in 0_usize..3,
        ) {
            let dt_s = f64::from(dt) / 10_000.0;
            let units = ["m/s2", "m/s", "m"][kind];
            let written = channel(units, values.clone(), dt_s);
            let csv = back(&write_csv(&written).unwrap());
            prop_assert_eq!(&csv.channels[0].values, &values);
            prop_assert_eq!(&csv.channels[0].sampling, &written.sampling);
            let at2 = back(&write_at2(&written).unwrap());
            prop_assert_eq!(&at2.channels[0].sampling, &written.sampling);
            for (read, value) in at2.channels[0].values.iter().zip(&values) {
                prop_assert!((read - value).abs() <= 5.1e-8 * value.abs(), "{read} {value}");
            }
            let smc = back(&write_smc(&written).unwrap());
            let Sampling::Dt(step_s) = smc.channels[0].sampling else { panic!("uneven") };
            prop_assert!((step_s - dt_s).abs() <= 1e-7 * dt_s);
            for (read, value) in smc.channels[0].values.iter().zip(&values) {
                // Ten columns: 1e-5 cm/s² below 1000, or five digits.
                let slack = 1e-6_f64.min(5.1e-5 * value.abs()).max(5.1e-6 * value.abs().min(1e-3));
                prop_assert!((read - value).abs() <= slack.max(5.1e-6), "{read} {value}");
            }
        }
    }
}
