//! One module a command.

pub mod init;
pub mod paper;
pub mod run;
pub mod study;
pub mod text;
