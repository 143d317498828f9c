//! Any bytes as delimited text.
#![no_main]

slipstick_fuzz::record_target!(Delimited, "g");
