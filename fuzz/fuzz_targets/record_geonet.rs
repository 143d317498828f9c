//! Any bytes as a file of the format `geonet`.
#![no_main]

use libfuzzer_sys::fuzz_target;
use slipstick::record::{self, Format, Options, Units};

fuzz_target!(|bytes: &[u8]| {
    let format = Some(Format::GeoNet);
    let options = Options { format, units: Units::parse("1e-6 m/s2"), dt_s: Some(0.01) };
    let _ = record::read("fuzz", bytes, &options);
    let _ = record::read("fuzz", bytes, &Options { format, ..Options::default() });
});
