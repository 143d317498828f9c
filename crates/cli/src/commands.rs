//! One module a command.

pub mod init;
pub mod record;
pub mod run;
pub mod text;
