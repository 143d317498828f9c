//! One module a command.

pub mod compare;
pub mod identify;
pub mod init;
pub mod paper;
pub mod run;
pub mod text;
