//! Any bytes as a file of the format `miniseed`.
#![no_main]

slipstick_fuzz::record_target!(MiniSeed, "1e-6 m/s2");
