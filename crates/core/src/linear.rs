//! Propagators and modes.
