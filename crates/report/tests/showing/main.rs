//! Results shown: the JSON summary, the table, the figures and the page.

#![allow(clippy::expect_used, reason = "a test that cannot set itself up must fail")]

mod figures;
mod page;
mod reviewer;
mod sensitivity;
mod suite;
mod summary;
mod support;
mod table;
