//! Units at the door: SI inside.

/// Standard gravity in m/s²: what "g" means in a record or a scale, and the default of a model.
pub const STANDARD_GRAVITY_M_PER_S2: f64 = 9.80665;
