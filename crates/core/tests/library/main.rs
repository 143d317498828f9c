//! What the library promises, tried through what it makes public.

mod common;

mod ahead;
mod allocation;
mod bidirectional;
mod cases;
mod check;
mod corners;
mod demands;
mod devices;
mod devices_nasty;
mod devices_random;
mod false_alarms;
mod fine_integration;
mod floors;
mod laboratory;
mod layers;
mod measures;
mod metamorphic;
mod modal;
mod nasty;
mod networks;
mod orders;
mod plane;
mod plane_lines;
mod plane_slope;
mod pressure;
mod properties;
mod records;
mod reference;
mod sample_records;
mod screening;
mod slider;
mod slider_force;
mod structure;
mod structure_in_plane;
