//! One module a command.

pub mod assess;
pub mod compare;
pub mod histories;
pub mod identify;
pub mod init;
pub mod paper;
pub mod record;
pub mod run;
pub mod structure;
pub mod study;
mod tank;
pub mod text;
