//! The step of the page: put together, its types checked, used in a browser.

use super::{Problem, Tally, package, steps};
use crate::web::Build;
use crate::{shell, web};
use std::path::Path;

/// Puts the page together from the modules whose bits were compared and uses it in Chromium as a person would.
pub fn page(tally: &mut Tally) -> Result<(), Problem> {
    used(Build::Tested, &steps::tested("slipstick")?, tally)
}

/// Builds the page and uses it in Chromium, with a command beside it.
pub fn used(how: Build, command: &Path, tally: &mut Tally) -> Result<(), Problem> {
    if let Some(missing) = web::missing() {
        return Err(Problem::NotRun(missing));
    }
    let chromium = web::chromium().map_err(Problem::NotRun)?;
    if how == Build::Tested {
        steps::wasm_built()?;
    }
    let folder = web::build(how)?;
    let page = shell::root().join(web::PAGE);
    let types = page.join("node_modules/typescript/bin/tsc");
    shell::run(shell::command("node").arg(types).arg("--project").arg(&page))?;
    let mut tests = shell::command("node");
    tests.arg(page.join("tests/page.mjs")).arg(&folder);
    tests.env("SLIPSTICK_CHROMIUM", chromium).env("SLIPSTICK_COMMAND", command);
    let ended = tests.output().map_err(|error| Problem::Failed(format!("node: {error}")))?;
    let text = String::from_utf8_lossy(&ended.stdout);
    let counted = package::counted(&text);
    tally.passed += counted.passed;
    tally.failed += counted.failed;
    tally.skipped += counted.skipped;
    if !ended.status.success() {
        print!("{text}{}", String::from_utf8_lossy(&ended.stderr));
        return Err(Problem::Failed(format!("the page: {}", ended.status)));
    }
    println!("  {}", text.lines().last().unwrap_or_default());
    Ok(())
}
