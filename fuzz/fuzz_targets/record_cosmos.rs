//! Any bytes as a COSMOS file.
#![no_main]

slipstick_fuzz::record_target!(Cosmos, "g");
