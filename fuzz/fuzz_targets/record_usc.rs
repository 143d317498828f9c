//! Any bytes as a USC or Caltech volume.
#![no_main]

slipstick_fuzz::record_target!(Usc, "g");
