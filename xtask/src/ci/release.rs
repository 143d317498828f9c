//! What a release hands out: built in its own profiles, and tested as that.

use super::{Problem, Tally, package, page as page_step, steps};
use crate::python::Package;
use crate::shell::Outcome;
use crate::web::Build;
use crate::{dist, shell};
use std::path::Path;

/// The page, used in a browser; it leaves the bundle for notebooks where the wheel takes it from.
pub fn page(tally: &mut Tally) -> Result<(), Problem> {
    page_step::used(Build::Page, &steps::tested("slipstick")?, tally)
}

/// The binary: every model of the examples, and what README and book show.
pub fn binary(tally: &mut Tally) -> Result<(), Problem> {
    let program = dist::dist()?;
    without_symbols(&program)?;
    steps::examples_by(&program, tally)?;
    steps::console_by(&program)
}

/// The wheel: the package's tests with it, a first run on every Python.
pub fn wheel(tally: &mut Tally) -> Result<(), Problem> {
    let package = Package::environment_in("python-release").map_err(Problem::NotRun)?;
    let wheel = package.wheel("wheel", &shell::target_folder()?.join("python-wheel"))?;
    without_symbols(&shell::target_folder()?.join("wheel/lib_core.so"))?;
    let mut install = package.command("-m pip install --quiet --force-reinstall --no-deps");
    shell::run(install.arg(&wheel))?;
    package::pytest(&package, &steps::tested("slipstick")?, None, tally)?;
    package::on_pythons("wheel", tally, &|python| package::pip_install(python, wheel.as_os_str()))
}

/// That a program or library of Linux carries no table of symbols, which nobody needs and everybody fetches.
fn without_symbols(file: &Path) -> Outcome {
    let bytes = std::fs::read(file).map_err(|error| format!("{}: {error}", file.display()))?;
    // Names of sections stand in the file as they are.
    let has_table = bytes.starts_with(b"\x7fELF") && bytes.windows(8).any(|w| w == b".symtab\0");
    if has_table { Err(format!("{}: it has its symbols still", file.display())) } else { Ok(()) }
}
