//! Any bytes as a file of the format `knet`.
#![no_main]

slipstick_fuzz::record_target!(Knet, "1e-6 m/s2");
