//! Response spectra and Fourier spectra of channels as tables for other programs.

use slipstick::motion::{FourierSpectrum, Ordinates, Spectrum};
use slipstick::table::{Table, to_cell};

use crate::json::{Members, each, pretty};
use crate::view;

/// The response spectrum of one channel.
#[derive(Clone, Debug, PartialEq)]
pub struct ChannelSpectrum {
    /// The file as it was named.
    pub file: String,
    /// What picks the channel.
    pub channel: String,
    /// Its ordinates.
    pub spectrum: Spectrum,
}

/// The Fourier amplitude spectrum of one channel.
#[derive(Clone, Debug, PartialEq)]
pub struct ChannelFourier {
    /// The file as it was named.
    pub file: String,
    /// What picks the channel.
    pub channel: String,
    /// Its amplitudes.
    pub spectrum: FourierSpectrum,
}

/// A column: its name, its unit, its value in a row.
type Column<R> = (&'static str, &'static str, fn(&R) -> f64);

/// Damping ratio, period in s and the ordinates there.
type AtPeriod = (f64, f64, Ordinates);

const SPECTRUM: [Column<AtPeriod>; 7] = [
    ("damping_ratio", "", |row| row.0),
    ("period_s", "s", |row| row.1),
    ("sd_m", "m", |row| row.2.sd_m),
    ("sv_m_per_s", "m/s", |row| row.2.sv_m_per_s),
    ("psv_m_per_s", "m/s", |row| row.2.psv_m_per_s),
    ("psa_m_per_s2", "m/s2", |row| row.2.psa_m_per_s2),
    ("sa_m_per_s2", "m/s2", |row| row.2.sa_m_per_s2),
];

/// Of rows of a frequency in Hz and the amplitude there in m/s.
const FOURIER: [Column<(f64, f64)>; 2] =
    [("frequency_hz", "Hz", |row| row.0), ("fourier_amplitude_m_per_s", "m/s", |row| row.1)];

fn at_periods(spectrum: &Spectrum) -> Vec<AtPeriod> {
    let of_damping = |ratio: &f64| each(&spectrum.periods_s, |period_s| (*ratio, *period_s));
    let rows = spectrum.damping_ratios.iter().flat_map(of_damping).zip(&spectrum.ordinates);
    each(rows, |((damping_ratio, period_s), ordinates)| (damping_ratio, period_s, *ordinates))
}

fn at_frequencies(spectrum: &FourierSpectrum) -> Vec<(f64, f64)> {
    spectrum.frequencies_hz().zip(spectrum.amplitudes_m_per_s.iter().copied()).collect()
}

/// CSV: file, channel, damping ratio, period and ordinates, one row a period.
#[must_use]
pub fn spectra_csv(spectra: &[ChannelSpectrum]) -> String {
    csv(&SPECTRUM, 2, each(spectra, |of| ([&of.file, &of.channel], at_periods(&of.spectrum))))
}

/// One JSON array with an object a channel: its periods, and the ordinates of each damping ratio.
#[must_use]
pub fn spectra_json(spectra: &[ChannelSpectrum]) -> String {
    pretty(&each(spectra, |ChannelSpectrum { file, channel, spectrum }| {
        let (periods_s, rows) = (&spectrum.periods_s, at_periods(spectrum));
        view! {
            file,
            channel,
            periods_s,
            spectra: each(rows.chunks(periods_s.len().max(1)), |rows| {
                let columns = each(&SPECTRUM[2..], |(name, _, value)| (*name, each(rows, value)));
                view! { damping_ratio: rows[0].0, #[serde(flatten)] columns: Members(columns) }
            }),
        }
    }))
}

/// Damping ratio, period and ordinates as columns, one row a period.
#[must_use]
pub fn spectrum_table(spectrum: &Spectrum) -> Table {
    table(&SPECTRUM, &at_periods(spectrum))
}

/// Frequency and amplitude as columns, one row a frequency.
#[must_use]
pub fn fourier_table(spectrum: &FourierSpectrum) -> Table {
    table(&FOURIER, &at_frequencies(spectrum))
}

/// CSV: file, channel, frequency and amplitude, one row a frequency.
#[must_use]
pub fn fourier_csv(spectra: &[ChannelFourier]) -> String {
    csv(&FOURIER, 1, each(spectra, |of| ([&of.file, &of.channel], at_frequencies(&of.spectrum))))
}

fn table<R>(columns: &[Column<R>], rows: &[R]) -> Table {
    let mut table = Table::default();
    for (name, unit, value) in columns {
        table.numbers(name, unit, each(rows, value));
    }
    table
}

/// Rows of channels, each channel by its file and its name. The first columns, the `coordinates`, have their
/// shortest digits, the others 17.
fn csv<R>(
    columns: &[Column<R>],
    coordinates: usize,
    channels: Vec<([&String; 2], Vec<R>)>,
) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    // Into a vector of bytes it cannot fail.
    let names = columns.iter().map(|(name, ..)| *name);
    let _ = writer.write_record(["file", "channel"].into_iter().chain(names));
    for (of, row) in channels.iter().flat_map(|(of, rows)| rows.iter().map(move |row| (of, row))) {
        let number = |(i, (_, _, value)): (usize, &Column<R>)| match i < coordinates {
            true => format!("{:?}", value(row)),
            false => format!("{:.16e}", value(row)),
        };
        let of = of.iter().map(|name| to_cell(name).into_owned());
        let _ = writer.write_record(of.chain(columns.iter().enumerate().map(number)));
    }
    String::from_utf8(writer.into_inner().unwrap_or_default()).unwrap_or_default()
}
