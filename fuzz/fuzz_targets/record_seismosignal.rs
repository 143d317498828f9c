//! Any bytes as text of SeismoSignal.
#![no_main]

slipstick_fuzz::record_target!(SeismoSignal, "g");
