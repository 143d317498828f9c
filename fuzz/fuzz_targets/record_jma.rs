//! Any bytes as a file of the format `jma`.
#![no_main]

slipstick_fuzz::record_target!(Jma, "1e-6 m/s2");
