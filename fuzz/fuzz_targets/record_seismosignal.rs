//! Any bytes as text of SeismoSignal.
#![no_main]

use libfuzzer_sys::fuzz_target;
use slipstick::record::{self, Format, Options, Units};

fuzz_target!(|bytes: &[u8]| {
    let format = Some(Format::SeismoSignal);
    let options = Options { format, units: Units::parse("g"), dt_s: Some(0.01) };
    let _ = record::read("fuzz", bytes, &options);
    let _ = record::read("fuzz", bytes, &Options { format, ..Options::default() });
});
