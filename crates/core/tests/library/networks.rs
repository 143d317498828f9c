//! Files of networks, SAC and MiniSEED: real ones, compared with the table that came with them, which
//! are not part of the repository (see `records.rs`); and the small ones of `data/records`.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::{Path, PathBuf};

use slipstick::record::{self, Channel, Options, Record, Units};

mod changed;
mod made;
mod real;

const G: f64 = 9.80665;
const NOTHING: Options = Options { format: None, units: None, dt_s: None };

/// The folder, or `None` and a line that says so.
#[allow(clippy::disallowed_macros, reason = "tests say what they skip on their own output")]
fn folder(test: &str) -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/records");
    let folder = std::env::var_os("SLIPSTICK_RECORDS").map_or(beside, PathBuf::from);
    if folder.join("index.csv").is_file() {
        return Some(folder.join("formats"));
    }
    println!("skipped: {test}");
    None
}

fn bytes(folder: &Path, file: &str) -> Vec<u8> {
    fs::read(folder.join(file)).unwrap()
}

fn read(folder: &Path, file: &str, options: &Options) -> Record {
    record::read(file, &bytes(folder, file), options).unwrap_or_else(|error| panic!("{error}"))
}

fn given(units: &str) -> Options {
    Options { units: Units::parse(units), ..NOTHING }
}

/// Largest size of a channel's values in its units.
fn peak(channel: &Channel) -> f64 {
    channel.values.iter().fold(0.0_f64, |peak, v| peak.max(v.abs())) / channel.units.si()
}

fn kinds(channel: &Channel) -> Vec<&str> {
    channel.warnings.iter().map(|w| w.kind.name()).collect()
}

/// File, channel, units, step, count, PGA in g and peak in the file's units: rows of the index.
type Row = (&'static str, &'static str, &'static str, f64, usize, f64, f64);

#[rustfmt::skip]
const ROWS: [Row; 27] = [
    ("knet_kiknet/CHB0021412312349.EW", "E-W", "cm/s²", 0.01, 6800, 0.006_981_75, 6.846_76),
    ("knet_kiknet/CHB0021412312349.NS", "N-S", "cm/s²", 0.01, 6800, 0.003_944_42, 3.868_16),
    ("knet_kiknet/CHB0021412312349.UD", "U-D", "cm/s²", 0.01, 6800, 0.008_014_2, 7.859_24),
    ("knet_kiknet/NGNH311106302345.EW1", "EW1", "cm/s²", 0.01, 12_000, 0.000_195_642, 0.191_86),
    ("knet_kiknet/NGNH311106302345.EW2", "EW2", "cm/s²", 0.01, 12_000, 0.000_722_106, 0.708_144),
    ("knet_kiknet/test.knet", "E-W", "cm/s²", 0.01, 5900, 0.004_469_7, 4.383_28),
    ("esm_dyna/HL.DLFA..HNE.D.20190728.160908.C.ACC.ASC", "HNE", "cm/s²", 0.005, 13_876, 0.000_232_468, 0.227_973),
    ("esm_dyna/HL.DLFA..HNN.D.20190728.160908.C.ACC.ASC", "HNN", "cm/s²", 0.005, 13_876, 0.000_193_921, 0.190_172),
    ("esm_dyna/HL.DLFA..HNZ.D.20190728.160908.C.ACC.ASC", "HNZ", "cm/s²", 0.005, 13_876, 0.000_212_924, 0.208_807),
    ("afad/20101114230825_3104_ap_RawAcc_E.asc", "HNE", "cm/s²", 0.01, 5600, 0.001_664_15, 1.631_97),
    ("afad/20230206011732_0131_ap_Acc_E.asc", "HNE", "cm/s²", 0.01, 12_500, 0.166_899, 163.672),
    ("afad/20230206011732_0131_ap_Acc_N.asc", "HNN", "cm/s²", 0.01, 12_500, 0.147_525, 144.673),
    ("afad/20230206011732_0131_ap_Acc_U.asc", "HNZ", "cm/s²", 0.01, 12_500, 0.048_501, 47.5632),
    ("afad_old_nsmn/20170720223109_0921.txt", "N-S", "cm/s²", 0.01, 28_683, 0.013_460_6, 13.2003),
    ("afad_old_nsmn/20170720223109_0921.txt", "E-W", "cm/s²", 0.01, 28_683, 0.012_403_7, 12.1638),
    ("afad_old_nsmn/20170720223109_0921.txt", "U-D", "cm/s²", 0.01, 28_683, 0.010_034_6, 9.840_57),
    ("itaca_sisma_acc/16840_H1.cor.acc", "NS", "m/s²", 0.005, 12_400, 0.001_021_96, 0.010_022),
    ("geonet/20180212_211557_WPWS_20.V2A", "S16W", "mm/s²", 0.02, 5800, 0.004_242_02, 41.6),
    ("geonet/20180212_211557_WPWS_20.V2A", "S74E", "mm/s²", 0.02, 5800, 0.019_782_5, 194.0),
    ("geonet/20180212_211557_WPWS_20.V2A", "Up", "mm/s²", 0.02, 5800, 0.002_783_83, 27.3),
    ("unam_asa2/CUP50401.012", "V", "cm/s²", 0.004, 17_500, 0.000_479_267, 0.47),
    ("unam_asa2/CUP50401.012", "N90E", "cm/s²", 0.004, 17_500, 0.001_212_44, 1.189),
    ("unam_asa2/CUP50401.012", "N00E", "cm/s²", 0.004, 17_500, 0.001_239_97, 1.216),
    ("csmnc_china/ua0004.dat", "EW", "cm/s²", 0.005, 8800, 0.003_326_78, 3.262_46),
    ("cwa_taiwan/2-ECU.dat", "U", "cm/s²", 0.02, 6000, 0.001_219_58, 1.196),
    ("cwa_taiwan/2-ECU.dat", "N", "cm/s²", 0.02, 6000, 0.002_988_79, 2.931),
    ("cwa_taiwan/2-ECU.dat", "E", "cm/s²", 0.02, 6000, 0.002_866_42, 2.811),
];

fn samples() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/records")
}
