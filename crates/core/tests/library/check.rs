//! The check passes true histories, from closed forms and from the solver, and notices every kind
//! of tampering.

#![allow(clippy::unwrap_used, reason = "a test that cannot be set up has failed")]

mod plane;
mod systems;
mod tampered;
mod tampered_in_plane;
mod true_histories;
