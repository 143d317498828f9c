//! From the path of a record to a motion that can be analysed.

use std::ops::Deref;
use std::path::{Path, PathBuf};

use slipstick::hash::sha256_hex;
use slipstick::input::loaded::{Component, Components, LoadError, Loaded, Wanted};
use slipstick::input::{PairOf, Scale};
use slipstick::record::{Format, Options, Record, Units};

use crate::error::FileError;
use crate::read::read_bytes;
use crate::records::understood;

/// A record to be opened, and what it may not say itself.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RecordRequest {
    /// The file, resolved against the model's folder.
    pub path: PathBuf,
    /// Its format, where that is not to be recognised.
    pub format: Option<Format>,
    /// Units, where the file does not state them.
    pub units: Option<Units>,
    /// Time step in s, where the file does not state it.
    pub dt_s: Option<f64>,
    /// Name or number (from 1) of the channel; not needed where one is acceleration.
    pub channel: Option<String>,
    /// Scale; as it stands where `None`.
    pub scale: Option<Scale>,
    /// The file with the component along y.
    pub along_y: Option<AlongYRequest>,
    /// The file with the vertical component.
    pub vertical: Option<VerticalRequest>,
}

/// A record whose horizontal component acts along y.
#[derive(Clone, Debug, PartialEq)]
pub struct AlongYRequest {
    /// The file.
    pub path: PathBuf,
    /// Units, where the file does not state them.
    pub units: Option<Units>,
    /// Time step in s, where the file does not state it.
    pub dt_s: Option<f64>,
    /// Name or number (from 1) of its channel.
    pub channel: Option<String>,
    /// How the two make a pair.
    pub pair: PairOf,
}

/// A record whose horizontal component acts vertically; format, units and time step as beside it.
#[derive(Clone, Debug, PartialEq)]
pub struct VerticalRequest {
    /// The file.
    pub path: PathBuf,
    /// Name or number (from 1) of its channel.
    pub channel: Option<String>,
    /// Factor besides that of the horizontal component.
    pub factor: f64,
}

/// A file that was read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SourceFile {
    /// Its path.
    pub path: PathBuf,
    /// SHA-256 of its bytes, in hexadecimal digits.
    pub sha256: String,
}

/// A motion ready for analysis, and the files that it came from.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadedMotion {
    /// The motion, and what is to be said of it.
    pub loaded: Loaded,
    /// Files read; none for a made motion.
    pub sources: Vec<SourceFile>,
}

impl Deref for LoadedMotion {
    type Target = Loaded;

    fn deref(&self) -> &Loaded {
        &self.loaded
    }
}

/// Opens a record, adds its other components and scales it.
///
/// # Errors
/// [`FileError`] where a file cannot be read or understood, where the channel is not one that can
/// be told, and where scaling has no answer.
pub fn load_record(request: &RecordRequest) -> Result<LoadedMotion, FileError> {
    let mut sources = Vec::new();
    let path = &request.path;
    let options = Options { format: request.format, units: request.units, dt_s: request.dt_s };
    let record = open(path, &options, &mut sources)?;
    let second = request.along_y.as_ref().map(|y| {
        let options = Options { format: request.format, units: y.units, dt_s: y.dt_s };
        Ok::<_, FileError>((open(&y.path, &options, &mut sources)?, y))
    });
    let second = second.transpose()?;
    let up = request.vertical.as_ref();
    let up = up.map(|up| Ok::<_, FileError>((open(&up.path, &options, &mut sources)?, up)));
    let up = up.transpose()?;
    let components = Components {
        horizontal: Wanted { record: &record, channel: request.channel.as_deref() },
        along_y: second
            .as_ref()
            .map(|(record, y)| (Wanted { record, channel: y.channel.as_deref() }, y.pair)),
        vertical: up
            .as_ref()
            .map(|(record, up)| (Wanted { record, channel: up.channel.as_deref() }, up.factor)),
    };
    let of = |component: Component| {
        let other = match component {
            Component::X => None,
            Component::Y => request.along_y.as_ref().map(|y| &y.path),
            Component::Vertical => request.vertical.as_ref().map(|up| &up.path),
        };
        other.unwrap_or(path).clone()
    };
    let loaded = Loaded::recorded(components, request.scale);
    let loaded = loaded.map_err(|error| match error {
        LoadError::Channel { expected, key, channels, component } => {
            let key = key.filter(|_| component != Component::Y);
            let option = key.map_or_else(String::new, |key| format!(" (or --{key})"));
            FileError::Channel {
                path: of(component),
                expected: format!("{expected}{option}"),
                channels,
            }
        }
        LoadError::Motion { error, component } => {
            FileError::Motion { path: of(component), source: error }
        }
    })?;
    Ok(LoadedMotion { loaded, sources })
}

fn open(
    path: &Path,
    options: &Options,
    sources: &mut Vec<SourceFile>,
) -> Result<Record, FileError> {
    let bytes = read_bytes(path)?;
    sources.push(SourceFile { path: path.to_owned(), sha256: sha256_hex(&bytes) });
    understood(path, &bytes, options)
}

#[cfg(test)]
mod tests {
    use super::*;
    use slipstick::record::{self, Sampling};

    fn write(name: &str, text: &str) -> PathBuf {
        let folder = std::env::temp_dir().join(format!("slipstick-load-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let path = folder.join(name);
        std::fs::write(&path, text).unwrap();
        path
    }

    fn g(path: PathBuf) -> RecordRequest {
        RecordRequest { path, units: Units::parse("g"), dt_s: Some(0.05), ..Default::default() }
    }

    fn kinds(loaded: &LoadedMotion) -> Vec<&str> {
        loaded.warnings.iter().map(|w| w.kind.name()).collect()
    }

    #[test]
    fn record_with_scale_and_warnings() {
        let path = write("one.txt", "0.1\n-0.4\n0.1\n");
        let loaded = load_record(&g(path.clone())).unwrap();
        assert_eq!(loaded.description, ["text with one column, 3 values, 0.05 s, g"]);
        assert_eq!(kinds(&loaded), ["first_sample_not_zero", "record_drift"]);
        let sha256 = sha256_hex(b"0.1\n-0.4\n0.1\n");
        assert_eq!(loaded.sources, [SourceFile { path: path.clone(), sha256 }]);
        let scaled = RecordRequest { scale: Some(Scale::Peak(2.0)), ..g(path.clone()) };
        assert!((load_record(&scaled).unwrap().figures.pga_m_per_s2 - 2.0).abs() < 1e-15);
        let scaled = RecordRequest { scale: Some(Scale::Factor(-2.0)), ..g(path) };
        let peak = load_record(&scaled).unwrap().motion.horizontal_m_per_s2()[1];
        assert!((peak - 0.8 * 9.80665).abs() < 1e-14);
    }

    #[test]
    fn vertical_component_takes_both_factors() {
        let path = write("along.txt", "0\n1\n-1\n0\n");
        let up = write("up.txt", "0\n1\n0\n");
        let vertical = VerticalRequest { path: up, channel: None, factor: 3.0 };
        let request =
            RecordRequest { scale: Some(Scale::Factor(2.0)), vertical: Some(vertical), ..g(path) };
        let loaded = load_record(&request).unwrap();
        let up = loaded.motion.vertical_m_per_s2().unwrap();
        assert!((up[1] - 6.0 * 9.80665).abs() < 1e-13 && up[3] == 0.0);
        assert_eq!(kinds(&loaded), ["lengths_differ"]);
        assert_eq!((loaded.description.len(), loaded.sources.len()), (2, 2));
    }

    #[test]
    fn columns_of_the_manual_need_no_key() {
        let text = "time_s,acceleration_m_per_s2,vertical_acceleration_m_per_s2\n0,0,0\n1,2,3\n";
        let path = write("columns.csv", text);
        let loaded = load_record(&RecordRequest { path, ..Default::default() }).unwrap();
        assert_eq!(loaded.motion.horizontal_m_per_s2(), [0.0, 2.0]);
        assert_eq!(loaded.motion.vertical_m_per_s2().unwrap(), [0.0, 3.0]);
    }

    #[test]
    fn channel_must_be_told() {
        let path = write("two.csv", "time_s,north_g,east_g,d_mm\n0,0,1,9\n1,2,3,9\n");
        let request = |channel: Option<&str>| RecordRequest {
            path: path.clone(),
            channel: channel.map(str::to_owned),
            ..Default::default()
        };
        let error = load_record(&request(None)).unwrap_err().to_string();
        let end = "expected one channel of acceleration: add channel = \"north_g\" to [motion] (or \
                   --channel) (channels: 1 \"north_g\" (acceleration), 2 \"east_g\" \
                   (acceleration))";
        assert_eq!(error, format!("{}: {end}", path.display()));
        for name in ["east_g", "EAST_G", "2"] {
            let loaded = load_record(&request(Some(name))).unwrap();
            assert_eq!(loaded.motion.horizontal_m_per_s2()[0], 9.80665, "{name}");
        }
        assert!(load_record(&request(Some("up"))).is_err());
        let error = load_record(&request(Some("d_mm"))).unwrap_err().to_string();
        assert!(error.contains("an acceleration channel \"d_mm\""), "{error}");
    }

    #[test]
    fn zero_record_cannot_be_scaled_to_a_peak() {
        let path = write("zero.txt", "0\n0\n0\n");
        let request = RecordRequest { scale: Some(Scale::Peak(1.0)), ..g(path.clone()) };
        let error = load_record(&request).unwrap_err().to_string();
        let end = "scale_to: expected a motion that is not zero throughout, its peak is 0 m/s²";
        assert_eq!(error, format!("{}: {end}", path.display()));
    }

    #[test]
    fn errors_of_the_reader_pass_through() {
        let path = write("bad.txt", "0\nx\n0\n");
        let error = load_record(&g(path.clone())).unwrap_err().to_string();
        let end = "2:1: expected a finite number, found \"x\"";
        assert_eq!(error, format!("{}:{end}", path.display()));
    }

    #[test]
    fn sampling_of_a_record_is_kept() {
        let path = write("times.txt", "0 0\n1 1\n1 0\n3 0\n");
        let record = record::read(
            "t",
            &read_bytes(&path).unwrap(),
            &Options { units: Units::parse("m/s2"), ..Default::default() },
        );
        let sampling = record.unwrap().channels[0].sampling.clone();
        assert_eq!(sampling, Sampling::Times(vec![0.0, 1.0, 1.0, 3.0]));
        let units = Units::parse("m/s2");
        let request = RecordRequest { path, units, ..Default::default() };
        assert_eq!(load_record(&request).unwrap().motion.times_s(), [0.0, 1.0, 1.0, 3.0]);
    }
}
