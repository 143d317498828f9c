//! Any bytes as a file of the format `sac`.
#![no_main]

slipstick_fuzz::record_target!(Sac, "1e-6 m/s2");
