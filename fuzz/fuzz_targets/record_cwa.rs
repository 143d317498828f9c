//! Any bytes as a file of the format `cwa`.
#![no_main]

slipstick_fuzz::record_target!(Cwa, "1e-6 m/s2");
