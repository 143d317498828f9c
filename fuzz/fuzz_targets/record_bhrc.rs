//! Any bytes as a BHRC volume.
#![no_main]

slipstick_fuzz::record_target!(Bhrc, "g");
