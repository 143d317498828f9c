//! `cargo xtask bench-…`: the same work here and in other programs, timed in one run.

use crate::python::{Package, environment};
use crate::shell::{self, Outcome};
use std::path::{Path, PathBuf};
use std::process::Stdio;

/// Analyses in numba, SciPy and OpenSeesPy, by `peers/bench.py`.
pub fn bench_peers(options: &[&str]) -> Outcome {
    let bench = Bench::new("peers", options, &["--json", "--quick", "--write"])?;
    let build = "build --release -p slipstick --example peer_bench";
    shell::run(&mut shell::cargo(build))?;
    shell::run(&mut shell::cargo("build --release -p slipstick-files --example device_bench"))?;
    // A second build with all that this processor can do, in a folder of its own.
    let native = bench.target.join("native");
    let mut again = shell::cargo(build);
    again.env("RUSTFLAGS", "-C target-cpu=native").arg("--target-dir").arg(&native);
    shell::run(&mut again)?;
    let [helper, native] =
        [&bench.target, &native].map(|t| built(t, "release", "examples/peer_bench"));
    let devices = built(&bench.target, "release", "examples/device_bench");
    let programs =
        [("--helper", helper), ("--native-helper", native), ("--device-helper", devices)];
    bench.run("bench.py", &programs)
}

/// The far-field study timed, on one thread and two, beside numba and OpenSeesPy; its parts read by
/// pandas, Polars and DuckDB.
pub fn bench_study(options: &[&str]) -> Outcome {
    let bench = Bench::new("studies", options, &["--quick", "--write"])?;
    shell::run(&mut shell::cargo("build --release -p slipstick-cli"))?;
    let slipstick = built(&bench.target, "release", "slipstick");
    bench.run("study_bench.py", &[("--slipstick", slipstick)])
}

/// The parts of a study of the examples read as one table by pandas, Polars and DuckDB.
pub fn readers() -> Outcome {
    let python = environment(".venv", "xtask/peers/requirements.txt")?;
    shell::run(&mut shell::cargo("build -p slipstick-cli"))?;
    let target = shell::target_folder()?;
    let mut check = shell::command(&python);
    check.env("PYTHONDONTWRITEBYTECODE", "1").arg("xtask/peers/readers.py");
    check.arg("--slipstick").arg(built(&target, "debug", "slipstick"));
    check.arg("--folder").arg(target.join("readers"));
    shell::run(&mut check)
}

/// Frames of 0 to 20 storeys timed beside a numba loop.
pub fn bench_storeys(options: &[&str]) -> Outcome {
    let bench = Bench::new("storeys", options, &["--json", "--quick", "--write"])?;
    shell::run(&mut shell::cargo("build --release -p slipstick --example storeys_bench"))?;
    let helper = built(&bench.target, "release", "examples/storeys_bench");
    bench.run("storeys_bench.py", &[("--helper", helper)])
}

/// A frame of OpenSees on a sliding slab in two directions: its time history beside the run by its modes.
pub fn bench_structure(options: &[&str]) -> Outcome {
    let bench = Bench::new("structure", options, &["--quick", "--write"])?;
    shell::run(&mut shell::cargo("build --release -p slipstick-cli"))?;
    let slipstick = built(&bench.target, "release", "slipstick");
    bench.run("structure.py", &[("--slipstick", slipstick)])
}

/// Reading and response spectra timed beside NumPy, ObsPy, eqsig and pyrotd.
pub fn bench_records(options: &[&str]) -> Outcome {
    let bench = Bench::new("records", options, &["--quick", "--write"])?;
    shell::run(&mut shell::cargo("build --release -p slipstick --example record_bench"))?;
    let helper = built(&bench.target, "release", "examples/record_bench");
    bench.run("record_bench.py", &[("--helper", helper)])
}

/// The Python package timed beside the command and the Rust call.
pub fn bench_python(options: &[&str]) -> Outcome {
    let bench = Bench::new("python", options, &["--json", "--quick", "--write"])?;
    let package = Package::environment()?;
    package.develop("wheel")?;
    let wheel = package.wheel("wheel", &bench.target.join("bench-python-wheel"))?;
    shell::run(&mut shell::cargo("build --release -p slipstick-cli"))?;
    shell::run(&mut shell::cargo("build --release -p slipstick-files --example run_bench"))?;
    let helper = built(&bench.target, "release", "examples/run_bench");
    let slipstick = built(&bench.target, "release", "slipstick");
    let bench = Bench { python: package.python().to_owned(), ..bench };
    let examples = shell::root().join("examples");
    let programs = [
        ("--helper", helper),
        ("--slipstick", slipstick),
        ("--examples", examples),
        ("--wheel", wheel),
    ];
    bench.run("python_bench.py", &programs)
}

/// A program in a target folder.
fn built(target: &Path, profile: &str, program: &str) -> PathBuf {
    target.join(profile).join(format!("{program}{}", std::env::consts::EXE_SUFFIX))
}

/// A bench whose page in the book has its name.
struct Bench<'a> {
    name: &'a str,
    options: &'a [&'a str],
    python: PathBuf,
    target: PathBuf,
}

impl<'a> Bench<'a> {
    /// Refuses unknown options and makes the Python environment.
    fn new(name: &'a str, options: &'a [&'a str], known: &[&str]) -> Result<Self, String> {
        if let Some(option) = options.iter().find(|option| !known.contains(option)) {
            return Err(format!("bench-{name}: expected {}, found {option}", known.join(", ")));
        }
        Ok(Self {
            name,
            options,
            python: environment(".venv", "xtask/peers/requirements.txt")?,
            target: shell::target_folder()?,
        })
    }

    /// Runs a script, which leaves NAME.md and NAME.json in its folder; prints one of them and, with
    /// `--write`, puts the page into the book.
    fn run(&self, script: &str, programs: &[(&str, PathBuf)]) -> Outcome {
        let has = |option| self.options.contains(&option);
        let folder = self.target.join(format!("bench-{}", self.name));
        let mut python = shell::command(&self.python);
        python.env("PYTHONDONTWRITEBYTECODE", "1").arg(format!("xtask/peers/{script}"));
        python.arg("--folder").arg(&folder);
        for (option, program) in programs {
            python.arg(option).arg(program);
        }
        if has("--quick") {
            python.arg("--quick");
        }
        // OpenSees prints a banner to standard output; the results are in files.
        shell::run(python.stdout(Stdio::null()))?;
        let page = format!("{}.md", self.name);
        let read = |name: &str| {
            let path = folder.join(name);
            std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))
        };
        let shown = if has("--json") { format!("{}.json", self.name) } else { page.clone() };
        print!("{}", read(&shown)?);
        if has("--write") {
            shell::write(&shell::root().join("book/src/generated").join(&page), &read(&page)?)?;
        }
        Ok(())
    }
}
