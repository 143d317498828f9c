//! What a release hands out: built in its own profiles, and tested as that.

use super::{Problem, Tally, package, page as page_step, steps};
use crate::python::Package;
use crate::web::Build;
use crate::{dist, shell};

/// The page, used in a browser; it leaves the bundle for notebooks where the wheel takes it from.
pub fn page(tally: &mut Tally) -> Result<(), Problem> {
    page_step::used(Build::Page, &steps::tested("slipstick")?, tally)
}

/// The binary: every model of the examples, and what README and book show.
pub fn binary(tally: &mut Tally) -> Result<(), Problem> {
    let program = dist::dist()?;
    steps::examples_by(&program, tally)?;
    steps::console_by(&program)
}

/// The wheel: the package's tests with it, a first run on every Python.
pub fn wheel(tally: &mut Tally) -> Result<(), Problem> {
    let package = Package::environment_in("python-release").map_err(Problem::NotRun)?;
    let wheel = package.wheel("wheel", &shell::target_folder()?.join("python-wheel"))?;
    let mut install = package.command("-m pip install --quiet --force-reinstall --no-deps");
    shell::run(install.arg(&wheel))?;
    package::pytest(&package, &steps::tested("slipstick")?, None, tally)?;
    package::on_pythons("wheel", tally, &|python| package::pip_install(python, wheel.as_os_str()))
}
