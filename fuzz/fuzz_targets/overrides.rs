//! Any lines as keys set in a model that is sound: `PATH=VALUE`.
#![no_main]

use libfuzzer_sys::fuzz_target;
use slipstick::input::{self, Override};

const MODEL: &str = include_str!("../../crates/report/models/frame.toml");

fuzz_target!(|text: &str| {
    let overrides: Vec<Override> = text.lines().filter_map(|l| Override::parse(l).ok()).collect();
    if let Err(error) = input::parse("frame.toml", MODEL, &overrides) {
        assert!(error.place.line > 0 && error.place.column > 0, "{error}");
    }
});
