//! Any bytes as a file of the format `csmnc`.
#![no_main]

slipstick_fuzz::record_target!(Csmnc, "1e-6 m/s2");
