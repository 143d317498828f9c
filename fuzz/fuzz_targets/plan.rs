//! Any bytes as a study plan.
#![no_main]

use slipstick_fuzz::{fuzz_target, plan};

fuzz_target!(|bytes: &[u8]| plan::check(bytes));
