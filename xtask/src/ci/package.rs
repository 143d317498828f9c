//! The step of the Python package: put together, tested, its types checked.

use super::{Problem, Tally};
use crate::python::{PACKAGE, Package, findable, new_environment};
use crate::shell::{self, Outcome};
use std::ffi::OsStr;
use std::path::Path;

/// Takes the extension that the tests' build made and runs pytest, the examples of the package's docstrings, the
/// notebooks, mypy and stubtest; compares the book's reference with the docstrings; tries the extension on other
/// Pythons.
pub fn python(tally: &mut Tally) -> Result<(), Problem> {
    let package = Package::environment().map_err(Problem::NotRun)?;
    package.assemble()?;
    pytest(&package, &super::steps::tested("slipstick")?, Some("python"), tally)?;
    let types = Path::new(PACKAGE).join("python/slipstick");
    let config = format!("{PACKAGE}/pyproject.toml");
    let mut mypy = package.command("-m mypy --no-error-summary --config-file");
    shell::run(mypy.arg(&config).arg(types))?;
    shell::run(&mut package.command("-m mypy.stubtest --concise slipstick._core"))?;
    package.reference(false)?;
    on_pythons("extension", tally, &|python| {
        pip_install(python, "numpy".as_ref())?;
        findable(python)
    })
}

/// Runs the package's tests in an environment that has it, with a command beside them; the examples of docstrings
/// too where the folder of sources is the package.
pub fn pytest(
    package: &Package,
    command: &Path,
    docstrings: Option<&str>,
    tally: &mut Tally,
) -> Result<(), Problem> {
    let mut pytest =
        package.command("-m pytest -q --no-header --tb=short --numprocesses auto --dist worksteal");
    pytest.arg(format!("{PACKAGE}/tests"));
    if let Some(folder) = docstrings {
        pytest.arg("--doctest-modules").arg(format!("{PACKAGE}/{folder}"));
    }
    pytest.env("SLIPSTICK_COMMAND", command).env("SLIPSTICK_ROOT", shell::root());
    let ended = pytest.output().map_err(|error| Problem::Failed(format!("pytest: {error}")))?;
    let text = String::from_utf8_lossy(&ended.stdout);
    let counted = counted(&text);
    tally.passed += counted.passed;
    tally.failed += counted.failed;
    tally.skipped += counted.skipped;
    if !ended.status.success() {
        print!("{text}");
        return Err(Problem::Failed(format!("pytest: {}", ended.status)));
    }
    println!("  {}", text.lines().last().unwrap_or_default());
    Ok(())
}

/// Pythons on which the one extension must work, which is built for the oldest.
const PYTHONS: [&str; 3] = ["3.11", "3.12", "3.13"];

/// What is run on each of them, in the root of the workspace.
const FIRST_RUN: &str = "import slipstick as ss; r = ss.run(ss.Model.read('examples/taft.toml')); \
                         assert r.holds and len(r.history['time_s']) == r.summary['samples']";

/// Runs an analysis on every Python that is found, each in an environment that has been given the package.
pub fn on_pythons(
    what: &str,
    tally: &mut Tally,
    give: &dyn Fn(&Path) -> Outcome,
) -> Result<(), Problem> {
    let folder = shell::target_folder()?.join(format!("pythons-{what}"));
    for version in PYTHONS {
        let program = format!("python{version}");
        if !shell::answers(&program, "-c pass") {
            tally.skipped += 1;
            println!("  not run: {what} on Python {version} (not found)");
            continue;
        }
        let python = new_environment(&program, &folder.join(version))?;
        give(&python)?;
        shell::run(shell::command(&python).args(["-c", FIRST_RUN]))?;
        tally.passed += 1;
    }
    Ok(())
}

/// Installs a package, by name or file, for a Python.
pub fn pip_install(python: &Path, package: &OsStr) -> Outcome {
    shell::run(shell::command(python).args(["-m", "pip", "install", "--quiet"]).arg(package))
}

/// What the last line says: `36 passed, 1 skipped in 20.1s`.
pub(super) fn counted(text: &str) -> Tally {
    let last = text.lines().last().unwrap_or_default();
    let words: Vec<&str> = last.split([' ', ',']).filter(|word| !word.is_empty()).collect();
    let count = |what: &str| {
        let at = words.iter().position(|word| *word == what);
        at.and_then(|i| words.get(i.checked_sub(1)?)?.parse().ok()).unwrap_or(0)
    };
    Tally { passed: count("passed"), failed: count("failed"), skipped: count("skipped") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn last_line_is_counted() {
        let tally = counted("....\n36 passed, 1 skipped, 2 warnings in 20.1s\n");
        assert_eq!(tally, Tally { passed: 36, failed: 0, skipped: 1 });
        let tally = counted("=== 2 failed, 3 passed in 1.0s ===");
        assert_eq!(tally, Tally { passed: 3, failed: 2, skipped: 0 });
    }
}
