//! Any bytes as an SMC file.
#![no_main]

slipstick_fuzz::record_target!(Smc, "g");
