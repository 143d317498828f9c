//! Any bytes as a record whose format is to be recognised.
#![no_main]

use libfuzzer_sys::fuzz_target;
use slipstick::record::{self, Options, Units};

fuzz_target!(|bytes: &[u8]| {
    let _ = record::read("fuzz", bytes, &Options::default());
    let options = Options { units: Units::parse("g"), dt_s: Some(0.01), ..Options::default() };
    if let Ok(record) = record::read("fuzz", bytes, &options) {
        for channel in &record.channels {
            // A frame of 64 bytes codes 105 differences at most.
            assert!(channel.values.len() >= 2 && channel.values.len() <= 2 * bytes.len());
            if let Some(Ok(motion)) = channel.motion() {
                let _ = motion.figures();
            }
        }
    }
});
