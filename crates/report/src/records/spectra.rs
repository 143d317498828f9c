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

/// Name of a column and the ordinate in it.
type Column = (&'static str, fn(&Ordinates) -> f64);

const COLUMNS: [Column; 5] = [
    ("sd_m", |o| o.sd_m),
    ("sv_m_per_s", |o| o.sv_m_per_s),
    ("psv_m_per_s", |o| o.psv_m_per_s),
    ("psa_m_per_s2", |o| o.psa_m_per_s2),
    ("sa_m_per_s2", |o| o.sa_m_per_s2),
];

/// CSV: file, channel, damping ratio, period and ordinates, one row a period.
#[must_use]
pub fn spectra_csv(spectra: &[ChannelSpectrum]) -> String {
    let names = COLUMNS.map(|(name, _)| name);
    let mut rows =
        vec![["file", "channel", "damping_ratio", "period_s"].map(str::to_owned).to_vec()];
    rows[0].extend(names.map(str::to_owned));
    for one in spectra {
        for (index, damping) in one.spectrum.damping_ratios.iter().enumerate() {
            let ordinates = one.spectrum.of_damping(index);
            for (period, ordinates) in one.spectrum.periods_s.iter().zip(ordinates) {
                let of = [one.file.clone(), one.channel.clone()].into_iter();
                let at = [damping, period].map(|value| format!("{value:?}"));
                let values = COLUMNS.map(|(_, value)| format!("{:.16e}", value(ordinates)));
                rows.push(of.chain(at).chain(values).collect());
            }
        }
    }
    text(&rows)
}

/// One JSON array with an object a channel: its periods, and the ordinates of each damping ratio.
#[must_use]
pub fn spectra_json(spectra: &[ChannelSpectrum]) -> String {
    pretty(&each(spectra, |ChannelSpectrum { file, channel, spectrum }| {
        view! {
            file,
            channel,
            periods_s: &spectrum.periods_s,
            spectra: each(spectrum.damping_ratios.iter().enumerate(), |(index, damping_ratio)| {
                let ordinates = spectrum.of_damping(index);
                let columns = each(COLUMNS, |(name, value)| (name, each(ordinates, value)));
                view! { damping_ratio, #[serde(flatten)] columns: Members(columns) }
            }),
        }
    }))
}

/// Damping ratio, period and ordinates as columns, one row a period.
#[must_use]
pub fn spectrum_table(spectrum: &Spectrum) -> Table {
    let n = spectrum.periods_s.len();
    let damping = spectrum.damping_ratios.iter().flat_map(|ratio| core::iter::repeat_n(*ratio, n));
    let periods = spectrum.damping_ratios.iter().flat_map(|_| spectrum.periods_s.iter().copied());
    let mut table = Table::default();
    table.numbers("damping_ratio", "", damping.collect()).numbers(
        "period_s",
        "s",
        periods.collect(),
    );
    let units = ["m", "m/s", "m/s", "m/s2", "m/s2"];
    for ((name, value), unit) in COLUMNS.into_iter().zip(units) {
        table.numbers(name, unit, spectrum.ordinates.iter().map(value).collect());
    }
    table
}

/// Frequency and amplitude as columns, one row a frequency.
#[must_use]
pub fn fourier_table(spectrum: &FourierSpectrum) -> Table {
    let mut table = Table::default();
    table.numbers("frequency_hz", "Hz", spectrum.frequencies_hz().collect()).numbers(
        "fourier_amplitude_m_per_s",
        "m/s",
        spectrum.amplitudes_m_per_s.clone(),
    );
    table
}

/// CSV: file, channel, frequency and amplitude, one row a frequency.
#[must_use]
pub fn fourier_csv(spectra: &[ChannelFourier]) -> String {
    let header = ["file", "channel", "frequency_hz", "fourier_amplitude_m_per_s"];
    let mut rows = vec![header.map(str::to_owned).to_vec()];
    for one in spectra {
        for (f, amplitude) in one.spectrum.frequencies_hz().zip(&one.spectrum.amplitudes_m_per_s) {
            let of = [one.file.clone(), one.channel.clone()];
            rows.push([of, [format!("{f:?}"), format!("{amplitude:.16e}")]].concat());
        }
    }
    text(&rows)
}

/// Rows of one length as CSV.
fn text(rows: &[Vec<String>]) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        // Into a vector of bytes it cannot fail.
        let _ = writer.write_record(row.iter().map(|cell| to_cell(cell).into_owned()));
    }
    String::from_utf8(writer.into_inner().unwrap_or_default()).unwrap_or_default()
}
