//! `cargo xtask bench-…`: the same work here and in other programs, timed in one run.

use crate::shell::{self, Outcome};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Makes a Python environment, builds the helper, runs `peers/bench.py` and prints its table.
pub fn bench_peers(options: &[&str]) -> Outcome {
    const OPTIONS: &[&str] = &["--json", "--quick", "--write"];
    if let Some(option) = options.iter().find(|option| !OPTIONS.contains(option)) {
        return Err(format!("bench-peers: expected {}, found {option}", OPTIONS.join(", ")));
    }
    let has = |option| options.contains(&option);
    let python = environment()?;
    let target = shell::target_folder()?;
    let build = "build --release -p slipstick --example peer_bench";
    shell::run(&mut shell::cargo(build))?;
    let folder = target.join("peers");
    let mut bench = shell::command(&python);
    bench.env("PYTHONDONTWRITEBYTECODE", "1").arg("xtask/peers/bench.py");
    bench.arg("--folder").arg(&folder).arg("--helper").arg(helper(&target));
    // A second build with all that this processor can do, in a folder of its own.
    let native = target.join("native");
    let mut build = shell::cargo(build);
    build.env("RUSTFLAGS", "-C target-cpu=native").arg("--target-dir").arg(&native);
    shell::run(&mut build)?;
    bench.arg("--native-helper").arg(helper(&native));
    if has("--quick") {
        bench.arg("--quick");
    }
    // OpenSees prints a banner to standard output; the results are in files.
    shell::run(bench.stdout(Stdio::null()))?;
    let read = |name: &str| {
        let path = folder.join(name);
        std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))
    };
    print!("{}", read(if has("--json") { "peers.json" } else { "peers.md" })?);
    if has("--write") {
        shell::write(&shell::root().join("book/src/generated/peers.md"), &read("peers.md")?)?;
    }
    Ok(())
}

fn helper(target: &Path) -> PathBuf {
    target.join(format!("release/examples/peer_bench{}", std::env::consts::EXE_SUFFIX))
}

/// The far-field study timed, on one thread and two, beside numba and OpenSeesPy; its folder opened
/// by DuckDB.
pub fn bench_study(options: &[&str]) -> Outcome {
    const OPTIONS: &[&str] = &["--quick", "--write"];
    if let Some(option) = options.iter().find(|option| !OPTIONS.contains(option)) {
        return Err(format!("bench-study: expected {}, found {option}", OPTIONS.join(", ")));
    }
    let python = environment()?;
    let target = shell::target_folder()?;
    shell::run(&mut shell::cargo("build --release -p slipstick-cli"))?;
    let folder = target.join("bench-study");
    let slipstick = target.join(format!("release/slipstick{}", std::env::consts::EXE_SUFFIX));
    let mut bench = shell::command(&python);
    bench.env("PYTHONDONTWRITEBYTECODE", "1").arg("xtask/peers/study_bench.py");
    bench.arg("--folder").arg(&folder).arg("--slipstick").arg(slipstick);
    written(bench, options, &folder.join("studies.md"), "studies.md")
}

/// Reading and response spectra timed beside NumPy, ObsPy, eqsig and pyrotd.
pub fn bench_records(options: &[&str]) -> Outcome {
    const OPTIONS: &[&str] = &["--quick", "--write"];
    if let Some(option) = options.iter().find(|option| !OPTIONS.contains(option)) {
        return Err(format!("bench-records: expected {}, found {option}", OPTIONS.join(", ")));
    }
    let python = environment()?;
    let target = shell::target_folder()?;
    shell::run(&mut shell::cargo("build --release -p slipstick --example record_bench"))?;
    let helper =
        target.join(format!("release/examples/record_bench{}", std::env::consts::EXE_SUFFIX));
    let mut bench = shell::command(&python);
    bench.env("PYTHONDONTWRITEBYTECODE", "1").arg("xtask/peers/record_bench.py");
    let folder = target.join("bench-records");
    bench.arg("--folder").arg(&folder).arg("--helper").arg(helper);
    written(bench, options, &folder.join("records.md"), "records.md")
}

/// Runs a bench, prints the page that it wrote and, with `--write`, puts it into the book.
fn written(mut bench: Command, options: &[&str], page: &Path, name: &str) -> Outcome {
    if options.contains(&"--quick") {
        bench.arg("--quick");
    }
    shell::run(bench.stdout(Stdio::null()))?;
    let text =
        std::fs::read_to_string(page).map_err(|error| format!("{}: {error}", page.display()))?;
    print!("{text}");
    if options.contains(&"--write") {
        shell::write(&shell::root().join("book/src/generated").join(name), &text)?;
    }
    Ok(())
}

/// Python of the environment in `.venv` with the programs of `peers/requirements.txt` in it.
fn environment() -> Result<PathBuf, String> {
    let folder = shell::root().join(".venv");
    let python = folder.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    let wanted = shell::root().join("xtask/peers/requirements.txt");
    let installed = folder.join("requirements.txt");
    let read = |path: &Path| std::fs::read_to_string(path).ok();
    if python.exists() && read(&wanted).is_some() && read(&wanted) == read(&installed) {
        return Ok(python);
    }
    let program = ["python3", "python"]
        .into_iter()
        .find(|name| shell::answers(name, "--version"))
        .ok_or("bench-peers: expected python3 (3.11 or later), found none")?;
    shell::run(shell::command(program).args(["-m", "venv"]).arg(&folder))?;
    let mut pip = shell::command(&python);
    pip.args(["-m", "pip", "install", "--quiet", "--requirement"]).arg(&wanted);
    shell::run(&mut pip)?;
    // Kept beside what was installed, so that the next run need not ask pip.
    std::fs::copy(&wanted, &installed)
        .map_err(|error| format!("{}: {error}", installed.display()))?;
    Ok(python)
}
