//! Any bytes as a study plan.
#![no_main]

use libfuzzer_sys::fuzz_target;

#[path = "../shared/plan.rs"]
mod plan;

fuzz_target!(|bytes: &[u8]| plan::check(bytes));
