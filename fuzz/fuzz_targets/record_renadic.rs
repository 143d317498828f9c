//! Any bytes as a RENADIC volume.
#![no_main]

slipstick_fuzz::record_target!(Renadic, "g");
