//! Any bytes as a file of the format `nsmn`.
#![no_main]

slipstick_fuzz::record_target!(Nsmn, "1e-6 m/s2");
