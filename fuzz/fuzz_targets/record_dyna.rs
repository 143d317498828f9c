//! Any bytes as a file of the format `dyna`.
#![no_main]

slipstick_fuzz::record_target!(Dyna, "1e-6 m/s2");
