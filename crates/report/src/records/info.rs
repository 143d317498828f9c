//! What `slipstick record info` says of every channel.

use serde::Serialize;
use slipstick::error::visible;
use slipstick::motion::intensity::{IntensityMeasures, Measure};
use slipstick::notice::{Notice, NoticeKind};
use slipstick::record::{Channel, Quantity, Record, Sampling};

use crate::display::{DisplayUnits, Quantity as Shown};
use crate::json::{Members, each, pretty};
use crate::laboratory::text::padded;
use crate::number::significant;
use crate::summary::keys::listed;
use crate::view;

/// One channel of one file.
#[derive(Clone, Debug, PartialEq)]
pub struct ChannelInfo {
    /// The file as it was named.
    pub file: String,
    /// Keyword of the format.
    pub format: &'static str,
    /// The format and its variant in words.
    pub layout: String,
    /// What picks the channel.
    pub channel: String,
    /// Component, where stated.
    pub component: Option<String>,
    /// Azimuth clockwise from north in degrees, where stated.
    pub azimuth_deg: Option<f64>,
    /// Units of the file's values.
    pub units: String,
    /// What they measure.
    pub quantity: Quantity,
    /// Number of samples.
    pub npts: usize,
    /// Step in s, `None` where samples are uneven.
    pub dt_s: Option<f64>,
    /// From the first sample to the last, in s.
    pub duration_s: f64,
    /// Corners of the filter that was applied, in Hz, where stated.
    pub high_pass_hz: Option<f64>,
    /// Upper corner.
    pub low_pass_hz: Option<f64>,
    /// Measures of an acceleration, and the velocity it leaves at its end in m/s; `None` for
    /// another quantity, or where it is no motion.
    pub measures: Option<(IntensityMeasures, f64)>,
    /// Earthquake, where stated.
    pub event: Option<String>,
    /// Station, where stated.
    pub station: Option<String>,
    /// What to know of the file and the channel.
    pub warnings: Vec<Notice>,
}

impl ChannelInfo {
    /// What is known of a channel of a file.
    #[must_use]
    pub fn new(file: &str, record: &Record, channel: &Channel) -> Self {
        let (dt_s, duration_s) = match &channel.sampling {
            Sampling::Dt(dt_s) => {
                (Some(*dt_s), channel.values.len().saturating_sub(1) as f64 * dt_s)
            }
            Sampling::Times(times_s) => {
                (None, times_s.last().zip(times_s.first()).map_or(0.0, |(b, a)| b - a))
            }
        };
        let mut warnings: Vec<Notice> =
            record.warnings.iter().chain(&channel.warnings).cloned().collect();
        let measures = match channel.motion() {
            Some(Ok(motion)) => {
                Some((IntensityMeasures::of(&motion), motion.figures().end_velocity_m_per_s))
            }
            Some(Err(error)) => {
                let message = format!("no measures: {error}");
                warnings.push(Notice::new(NoticeKind::NoMeasures, message));
                None
            }
            None => None,
        };
        Self {
            file: file.to_owned(),
            format: record.format.keyword(),
            layout: record.layout.clone(),
            channel: channel.name.clone(),
            component: channel.component.clone(),
            azimuth_deg: channel.azimuth_deg,
            units: channel.units.to_string(),
            quantity: channel.units.quantity(),
            npts: channel.values.len(),
            dt_s,
            duration_s,
            high_pass_hz: channel.filter.high_pass_hz,
            low_pass_hz: channel.filter.low_pass_hz,
            measures,
            event: channel.event.clone(),
            station: channel.station.clone(),
            warnings,
        }
    }

    fn json(&self) -> impl Serialize {
        // The keys stand there for every channel; without an acceleration they are null.
        let columns = self.measures.map_or(IntensityMeasures::default(), |(set, _)| set).columns();
        let value = |si: f64| self.measures.map(|_| si);
        view! {
            file: &self.file,
            format: self.format,
            layout: &self.layout,
            channel: &self.channel,
            component: &self.component,
            azimuth_deg: self.azimuth_deg,
            units: &self.units,
            quantity: self.quantity.name(),
            npts: self.npts,
            dt_s: self.dt_s,
            duration_s: self.duration_s,
            high_pass_hz: self.high_pass_hz,
            low_pass_hz: self.low_pass_hz,
            #[serde(flatten)] measures: Members(each(columns, |(_, name, si)| (name, value(si)))),
            end_velocity_m_per_s: self.measures.map(|(_, end)| end),
            event: &self.event,
            station: &self.station,
            warnings: listed(&self.warnings, false),
            notes: listed(&self.warnings, true),
        }
    }
}

/// One JSON array with an object a channel; numbers in SI.
#[must_use]
pub fn info_json(channels: &[ChannelInfo]) -> String {
    pretty(&each(channels, ChannelInfo::json))
}

/// A table of channels below the name of their file, with what there is to know of them.
#[must_use]
pub fn info_table(channels: &[ChannelInfo], display: DisplayUnits) -> String {
    let mut out = String::new();
    let mut start = 0;
    while start < channels.len() {
        let file = &channels[start].file;
        let count = channels[start..].iter().take_while(|c| c.file == *file).count();
        file_table(&mut out, &channels[start..start + count], display);
        start += count;
        if start < channels.len() {
            out.push('\n');
        }
    }
    out
}

/// Measures of the table, in the order of the set.
const TABLED: [Measure; 6] = [
    Measure::Pga,
    Measure::Pgv,
    Measure::Pgd,
    Measure::Arias,
    Measure::D5To95,
    Measure::MeanPeriod,
];

/// The value of a measure, and its unit.
pub(super) fn shown(measure: &Measure, si: f64, display: DisplayUnits) -> (String, &'static str) {
    let quantity = match measure.unit() {
        "m/s2" => Shown::Acceleration,
        "m/s" => Shown::Velocity,
        "m" => Shown::Length,
        _ => Shown::Time,
    };
    let unit = display.unit(quantity, si.abs());
    (significant(unit.of(si), 4), unit.symbol)
}

/// The channels of one file.
fn file_table(out: &mut String, channels: &[ChannelInfo], display: DisplayUnits) {
    let first = &channels[0];
    out.push_str(&format!("{}  ({})\n", visible(&first.file), visible(&first.layout)));
    let said = [("Event", &first.event), ("Station", &first.station)];
    for (name, value) in said {
        if let Some(value) = value {
            out.push_str(&format!("{name:<9}{}\n", visible(value)));
        }
    }
    let heads = ["Channel", "Units", "Values", "dt", "Duration"].map(str::to_owned);
    let heads = heads.into_iter().chain(TABLED.map(|measure| measure.to_string()));
    let mut rows = vec![heads.collect()];
    for channel in channels {
        let dt = channel.dt_s.map_or("uneven".to_owned(), |dt_s| format!("{dt_s} s"));
        let mut row = vec![
            visible(&channel.channel),
            channel.units.clone(),
            channel.npts.to_string(),
            dt,
            format!("{} s", significant(channel.duration_s, 5)),
        ];
        match &channel.measures {
            Some((set, _)) => {
                let columns = set.columns().into_iter();
                let tabled = columns.filter(|(measure, ..)| TABLED.contains(measure));
                row.extend(tabled.map(|(measure, _, si)| {
                    let (value, unit) = shown(&measure, si, display);
                    format!("{value} {unit}")
                }));
            }
            None => row.push(format!("({})", channel.quantity.name())),
        }
        rows.push(row);
    }
    out.push_str(&padded(&rows, |column| column < 2));
    let mut told: Vec<&Notice> = Vec::new();
    for channel in channels {
        for warning in &channel.warnings {
            // What is said of the file is said once.
            if told.contains(&warning) {
                continue;
            }
            told.push(warning);
            let of = if channels.len() > 1 {
                format!("{}: ", visible(&channel.channel))
            } else {
                String::new()
            };
            out.push_str(&format!(
                "{}  {of}{}: {}\n",
                warning.label(),
                warning.kind,
                visible(&warning.message)
            ));
        }
    }
}
