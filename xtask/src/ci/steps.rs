//! The steps that are one call of cargo or little more.

use super::{Problem, Tally};
use crate::{shell, web};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Every file is formatted.
pub fn formatting(_: &mut Tally) -> Result<(), Problem> {
    ensure_component("rustfmt", "fmt --version")?;
    Ok(shell::run(&mut shell::cargo("fmt --all --check"))?)
}

/// No lint is left, in tests, examples and benches neither.
pub fn lints(_: &mut Tally) -> Result<(), Problem> {
    ensure_component("clippy", "clippy --version")?;
    Ok(shell::run(&mut shell::cargo("clippy --workspace --all-targets -- -D warnings"))?)
}

/// Every public item is documented, and every link in it leads somewhere.
pub fn documentation(_: &mut Tally) -> Result<(), Problem> {
    let mut doc = shell::cargo("doc --workspace --no-deps");
    Ok(shell::run(doc.env("RUSTDOCFLAGS", "-D warnings"))?)
}

/// Every model in `examples/` runs as it stands and gives JSON; of every study there, one part runs.
pub fn examples(tally: &mut Tally) -> Result<(), Problem> {
    examples_by(&tested("slipstick")?, tally)
}

/// The same by a given command.
pub fn examples_by(slipstick: &Path, tally: &mut Tally) -> Result<(), Problem> {
    let (mut plans, mut models) = (Vec::new(), Vec::new());
    for file in toml_files("examples")? {
        match kind(&file) {
            Kind::Plan => plans.push(file),
            Kind::Model => models.push(file),
            Kind::Mapping => {}
        }
    }
    if models.is_empty() {
        return Err(Problem::NotRun("no models in examples/".to_owned()));
    }
    let mut failed = Vec::new();
    for model in &models {
        let mut run = shell::command(slipstick);
        run.arg("run").arg(model).args(["--json", "-q"]);
        let printed = shell::output(&mut run)
            .and_then(|text| serde_json::from_str(&text).map_err(|error| error.to_string()));
        match printed {
            Ok(Value::Object(_)) => tally.passed += 1,
            Ok(_) => failed.push(format!("{model}: expected one JSON object")),
            Err(reason) => failed.push(format!("{model}: {reason}")),
        }
    }
    println!("  {} of {} models ran", models.len() - failed.len(), models.len());
    for plan in &plans {
        study(slipstick, plan, tally, &mut failed)?;
    }
    tally.failed += failed.len() as u64;
    if failed.is_empty() { Ok(()) } else { Err(Problem::Failed(failed.join("; "))) }
}

/// A program that the tests have built, so that nothing is compiled once more.
pub(super) fn tested(program: &str) -> Result<PathBuf, String> {
    shell::run(&mut shell::cargo_for_many_runs("test --workspace --no-run --quiet"))?;
    let file = format!("{program}{}", std::env::consts::EXE_SUFFIX);
    Ok(shell::target_folder()?.join("debug").join(file))
}

/// What a TOML file of the examples is.
enum Kind {
    Model,
    Plan,
    /// Says which column of a measured file is what; the commands that read one are tested.
    Mapping,
}

/// By its keys before its first table: a plan names a model, a mapping the time.
fn kind(file: &str) -> Kind {
    let text = std::fs::read_to_string(shell::root().join(file)).unwrap_or_default();
    let top = text.lines().take_while(|line| !line.starts_with('['));
    let keys: Vec<&str> = top.filter_map(|line| Some(line.split_once('=')?.0.trim())).collect();
    match () {
        () if keys.contains(&"model") => Kind::Plan,
        () if keys.contains(&"time") => Kind::Mapping,
        () => Kind::Model,
    }
}

/// Runs one part of a study, a small one whole; a study whose records are not there is skipped.
fn study(
    slipstick: &Path,
    plan: &str,
    tally: &mut Tally,
    failed: &mut Vec<String>,
) -> Result<(), Problem> {
    let out =
        shell::target_folder()?.join("examples-of-studies").join(plan.replace(['/', '.'], "-"));
    let mut told = String::new();
    // The first sixth of a study of one part is empty.
    for shard in ["1/6", "1/1"] {
        let mut run = shell::command(slipstick);
        run.arg("study").arg(plan).arg("--out").arg(&out).args(["--force", "-q", "--shard", shard]);
        let ended = run.output().map_err(|error| Problem::Failed(format!("{plan}: {error}")))?;
        told = String::from_utf8_lossy(&ended.stderr).into_owned();
        match ended.status.code() {
            Some(0) if out.join("parts/part-00000.parquet").is_file() => {
                tally.passed += 1;
                return Ok(());
            }
            Some(0) => {}
            Some(2) if told.contains(" are missing, found no ") => {
                println!("  {plan}: skipped, its records are not there");
                tally.skipped += 1;
                return Ok(());
            }
            _ => break,
        }
    }
    failed.push(format!("{plan}: {told}"));
    Ok(())
}

/// The commands in README and book print what is shown there.
pub fn console(_: &mut Tally) -> Result<(), Problem> {
    if !shell::answers("sh", "-c true") {
        return Err(Problem::NotRun("found no sh".to_owned()));
    }
    console_by(&tested("slipstick")?)
}

/// The same by a given command, which is called `slipstick`.
pub fn console_by(slipstick: &Path) -> Result<(), Problem> {
    let folder = slipstick.parent().unwrap_or(slipstick);
    let (blocks, differing) = crate::console::pages(folder, false)?;
    println!("  {blocks} blocks of commands, {} pages differ", differing.len());
    if differing.is_empty() { Ok(()) } else { Err(Problem::Failed(differing.join("; "))) }
}

/// All that runs in a browser builds for it.
pub fn wasm_build(_: &mut Tally) -> Result<(), Problem> {
    wasm_built().map(drop)
}

/// Builds all that is built for WebAssembly, once; what the example `golden` gives here, and its module.
pub(super) fn wasm_built() -> Result<(String, PathBuf), Problem> {
    web::add_target().map_err(Problem::NotRun)?;
    let golden = shell::output(&mut shell::command(tested("examples/golden")?))?;
    let module = web::build_for_tests(golden.trim())?;
    Ok((golden.trim().to_owned(), module))
}

/// The example `golden` gives the same bits here and in WebAssembly.
pub fn wasm_golden(_: &mut Tally) -> Result<(), Problem> {
    let host = wasm_host().ok_or_else(|| {
        Problem::NotRun("found neither node nor wasmtime to run WebAssembly".to_owned())
    })?;
    let (golden, module) = wasm_built()?;
    println!("  here:  {golden}");
    let code = shell::output(&mut host(&module))?;
    match code.trim() {
        "0" => Ok(()),
        code => Err(Problem::Failed(format!("analysis {code} differs in bits under wasm"))),
    }
}

/// A program that calls `main` of a WebAssembly module and prints what it returns.
fn wasm_host() -> Option<fn(&PathBuf) -> std::process::Command> {
    const SCRIPT: &str = "WebAssembly.instantiate(require('fs').readFileSync(process.argv[1]))\
        .then(({instance}) => console.log(instance.exports.main(0, 0)))";
    if shell::answers("node", "--version") {
        return Some(|module| {
            let mut node = shell::command("node");
            node.args(["-e", SCRIPT]).arg(module);
            node
        });
    }
    shell::answers("wasmtime", "--version").then_some(|module| {
        let mut wasmtime = shell::command("wasmtime");
        wasmtime.args(["run", "--invoke", "main"]).arg(module).args(["0", "0"]);
        wasmtime
    })
}

/// Adds a component of the toolchain where it is missing.
fn ensure_component(component: &str, probe: &str) -> Result<(), Problem> {
    let cargo = shell::cargo("").get_program().to_string_lossy().into_owned();
    if shell::answers(&cargo, probe) {
        return Ok(());
    }
    shell::run(shell::command("rustup").args(["component", "add", component]))
        .map_err(|reason| Problem::NotRun(format!("{component} is missing; {reason}")))
}

/// The TOML files of a folder and those in it, sorted, as paths from the root of the workspace.
fn toml_files(folder: &str) -> Result<Vec<String>, String> {
    let Ok(entries) = std::fs::read_dir(shell::root().join(folder)) else {
        return Ok(Vec::new());
    };
    let mut files = Vec::new();
    for entry in entries {
        let entry = entry.map_err(|error| format!("{folder}: {error}"))?;
        let path = format!("{folder}/{}", entry.file_name().to_string_lossy());
        if entry.path().is_dir() {
            files.extend(toml_files(&path)?);
        } else if path.ends_with(".toml") {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}
