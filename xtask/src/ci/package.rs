//! The step of the Python package: built, tested, its types checked.

use super::{Problem, Tally};
use crate::python::{PACKAGE, Package, new_environment};
use crate::shell;
use std::path::Path;

/// Builds the package into an environment of its own and runs pytest, the examples of its docstrings, the
/// notebooks, mypy and stubtest; compares the book's reference with the docstrings; tries the wheel on other
/// Pythons.
pub fn python(tally: &mut Tally) -> Result<(), Problem> {
    let package = Package::environment().map_err(Problem::NotRun)?;
    package.build("dev")?;
    let command = super::steps::tested("slipstick")?;
    let mut pytest = package.command("-m pytest -q --no-header --tb=short --doctest-modules");
    pytest.args([format!("{PACKAGE}/tests"), format!("{PACKAGE}/python")]);
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
    let types = Path::new(PACKAGE).join("python/slipstick");
    let config = format!("{PACKAGE}/pyproject.toml");
    let mut mypy = package.command("-m mypy --no-error-summary --config-file");
    shell::run(mypy.arg(&config).arg(types))?;
    shell::run(&mut package.command("-m mypy.stubtest --concise slipstick._core"))?;
    package.reference(false)?;
    wheels(&package, tally)
}

/// Pythons on which the one wheel must work, which is built for the oldest.
const PYTHONS: [&str; 3] = ["3.11", "3.12", "3.13"];

/// What is run on each of them, in the root of the workspace.
const FIRST_RUN: &str = "import slipstick as ss; r = ss.run(ss.Model.read('examples/taft.toml')); \
                         assert r.holds and len(r.history['time_s']) == r.summary['samples']";

/// Installs the wheel on every Python that is found and runs an analysis there.
fn wheels(package: &Package, tally: &mut Tally) -> Result<(), Problem> {
    let folder = shell::target_folder()?.join("python-wheel");
    let wheel = package.wheel("dev", &folder)?;
    for version in PYTHONS {
        let program = format!("python{version}");
        if !shell::answers(&program, "-c pass") {
            tally.skipped += 1;
            println!("  not run: wheel on Python {version} (not found)");
            continue;
        }
        let python = new_environment(&program, &folder.join(version))?;
        shell::run(shell::command(&python).args(["-m", "pip", "install", "--quiet"]).arg(&wheel))?;
        shell::run(shell::command(&python).args(["-c", FIRST_RUN]))?;
        tally.passed += 1;
    }
    Ok(())
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
