//! The step of the Python package: built, tested, its types checked.

use super::{Problem, Tally};
use crate::python::environment;
use crate::shell;
use std::path::Path;

const PACKAGE: &str = "crates/python";

/// Builds the package into an environment of its own and runs pytest, the examples of its docstrings,
/// mypy and stubtest.
pub fn python(tally: &mut Tally) -> Result<(), Problem> {
    let folder = shell::target_folder()?.join("python");
    let requirements = format!("{PACKAGE}/tests/requirements.txt");
    let python = environment(&folder.to_string_lossy(), &requirements).map_err(Problem::NotRun)?;
    let at = |program: &str| {
        let mut command = shell::command(&python);
        command.args(program.split_whitespace()).env("VIRTUAL_ENV", &folder);
        command
    };
    let manifest = format!("{PACKAGE}/Cargo.toml");
    shell::run(at("-m maturin develop --quiet --profile dev --manifest-path").arg(manifest))?;
    let command = super::steps::tested("slipstick")?;
    let mut pytest = at("-m pytest -q --no-header --tb=short --doctest-modules");
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
    shell::run(at("-m mypy --no-error-summary --config-file").arg(&config).arg(types))?;
    Ok(shell::run(&mut at("-m mypy.stubtest --concise slipstick._core"))?)
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
    fn exact_last_line_is_counted() {
        let tally = counted("....\n36 passed, 1 skipped, 2 warnings in 20.1s\n");
        assert_eq!(tally, Tally { passed: 36, failed: 0, skipped: 1 });
        let tally = counted("=== 2 failed, 3 passed in 1.0s ===");
        assert_eq!(tally, Tally { passed: 3, failed: 2, skipped: 0 });
    }
}
