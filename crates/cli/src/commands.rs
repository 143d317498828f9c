//! One module a command.

mod assessment;
pub mod compare;
pub mod design;
pub mod fragility;
pub mod histories;
pub mod ida;
pub mod identify;
pub mod init;
pub mod paper;
pub mod record;
pub mod run;
pub mod spectrum;
pub mod study;
pub mod text;
