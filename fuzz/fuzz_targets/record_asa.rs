//! Any bytes as a file of the format `asa`.
#![no_main]

slipstick_fuzz::record_target!(Asa, "1e-6 m/s2");
