//! Opens models and records and writes results, whole or not at all.
