//! Exact and stepwise solutions.
