//! Any bytes as a PEER file.
#![no_main]

slipstick_fuzz::record_target!(Peer, "g");
