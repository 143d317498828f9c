//! Any bytes as a file of the format `geonet`.
#![no_main]

slipstick_fuzz::record_target!(GeoNet, "1e-6 m/s2");
