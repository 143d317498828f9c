//! Any bytes as a CSMIP volume.
#![no_main]

slipstick_fuzz::record_target!(Csmip, "g");
