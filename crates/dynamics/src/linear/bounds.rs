//! The bounds that the exact method rests on, proved in the book's chapter "Proofs of the bounds": each
//! holds for random systems, and each has a case that reaches it, so that none is larger than it
//! need be.

mod norms;
mod polynomials;
#[allow(dead_code)]
#[path = "../../../core/tests/library/common/random.rs"]
mod random;
mod systems;
mod taylor;
