//! Any bytes as a file of the format `itaca`.
#![no_main]

slipstick_fuzz::record_target!(Itaca, "1e-6 m/s2");
