//! Python environments of the tasks that need one, and the package in its own.

use crate::shell::{self, Outcome};
use std::env::consts;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Where the package is.
pub const PACKAGE: &str = "crates/python";
/// Where its Python files are.
const SOURCES: &str = "crates/python/python";
/// The page of the book that comes from its docstrings.
const REFERENCE: &str = "book/src/python-reference.md";

/// The environment in which the package is built and tested.
pub struct Package {
    folder: PathBuf,
    python: PathBuf,
}

impl Package {
    /// The environment with all that tests need, without the package.
    ///
    /// # Errors
    /// What this machine lacks.
    pub fn environment() -> Result<Self, String> {
        Self::environment_in("python")
    }

    /// The same in a folder of its own within the target folder.
    ///
    /// # Errors
    /// What this machine lacks.
    pub fn environment_in(folder: &str) -> Result<Self, String> {
        let folder = shell::target_folder()?.join(folder);
        let requirements = format!("{PACKAGE}/tests/requirements.txt");
        let python = environment(&folder.to_string_lossy(), &requirements)?;
        Ok(Self { folder, python })
    }

    /// Python of the environment.
    pub fn python(&self) -> &Path {
        &self.python
    }

    /// Python of the environment with these arguments (words, separated by spaces).
    pub fn command(&self, arguments: &str) -> Command {
        let mut command = shell::command(&self.python);
        command.args(arguments.split_whitespace()).env("VIRTUAL_ENV", &self.folder);
        command
    }

    /// Puts the extension that the tests' own build made beside the Python files and lets the environment find
    /// both: nothing is compiled for it alone.
    pub fn assemble(&self) -> Outcome {
        extension()?;
        findable(&self.python)
    }

    /// Builds the package by maturin with a profile of cargo into the environment.
    pub fn develop(&self, profile: &str) -> Outcome {
        let mut maturin = self.command("-m maturin develop --quiet --profile");
        let manifest = format!("{PACKAGE}/Cargo.toml");
        shell::run(maturin.arg(profile).arg("--manifest-path").arg(manifest))
    }

    /// Builds the wheel with a profile of cargo into a folder, which is made anew.
    pub fn wheel(&self, profile: &str, folder: &Path) -> Result<PathBuf, String> {
        let failed = |error: std::io::Error| format!("{}: {error}", folder.display());
        if folder.exists() {
            std::fs::remove_dir_all(folder).map_err(failed)?;
        }
        let mut maturin = self.command("-m maturin build --quiet --compression-level 9 --profile");
        let manifest = format!("{PACKAGE}/Cargo.toml");
        maturin.args([profile, "--manifest-path", &manifest, "--out"]).arg(folder);
        shell::run(&mut maturin)?;
        let mut files = std::fs::read_dir(folder).map_err(failed)?.filter_map(Result::ok);
        let wheel = files.find(|file| file.path().extension().is_some_and(|e| e == "whl"));
        wheel.map(|file| file.path()).ok_or(format!("{}: no wheel", folder.display()))
    }

    /// Compares the book's reference with the docstrings, or writes it.
    pub fn reference(&self, write: bool) -> Outcome {
        let page = shell::output(self.command("").arg(format!("{PACKAGE}/docs.py")))?;
        let path = shell::root().join(REFERENCE);
        if write {
            return shell::write(&path, &page);
        }
        let current = std::fs::read_to_string(&path).is_ok_and(|text| text == page);
        let stale = || format!("{REFERENCE} is not what the docstrings say: python-docs --write");
        current.then_some(()).ok_or_else(stale)
    }
}

/// `cargo xtask python-docs`: the page of the book from the docstrings of the package.
pub fn docs(options: &[&str]) -> Outcome {
    let write = match options {
        [] => false,
        ["--write"] => true,
        _ => return Err(format!("python-docs: expected --write, found {}", options.join(" "))),
    };
    let package = Package::environment()?;
    package.assemble()?;
    package.reference(write)
}

/// `cargo xtask notebooks`: the notebooks of the examples as they ran, as pages of the book with their figures.
pub fn notebooks() -> Outcome {
    let package = Package::environment()?;
    package.assemble()?;
    shell::run(package.command("").arg(format!("{PACKAGE}/notebooks.py")))
}

/// `cargo xtask python-free-threaded`: builds the package for a free-threaded Python, of which PyO3 serves
/// 3.14 and later, and runs its tests there, without the lock.
pub fn free_threaded() -> Outcome {
    let program = "python3.14t";
    if !shell::answers(program, "-m venv -h") {
        return Err(format!("expected {program} with venv, found none"));
    }
    let folder = shell::target_folder()?.join("python-free-threaded");
    let requirements = format!("{PACKAGE}/tests/requirements-free-threaded.txt");
    let python = environment_by(program, &folder, &requirements)?;
    let package = Package { folder, python };
    package.develop("dev")?;
    const UNLOCKED: &str = "import slipstick, sys; sys.exit(sys._is_gil_enabled())";
    shell::run(package.command("-W error -c").arg(UNLOCKED))?;
    shell::run(&mut shell::cargo("build --quiet --package slipstick-cli"))?;
    let slipstick = shell::target_folder()?.join("debug/slipstick");
    let mut pytest = package.command("-m pytest -q --no-header --tb=short -rs");
    pytest.arg(format!("{PACKAGE}/tests"));
    pytest.env("SLIPSTICK_COMMAND", slipstick).env("SLIPSTICK_ROOT", shell::root());
    shell::run(&mut pytest)
}

/// Builds the extension as the tests' own build does, and copies it to where Python looks for it.
fn extension() -> Outcome {
    shell::run(&mut shell::cargo_for_many_runs("build --workspace --lib --bins --tests --quiet"))?;
    let built = format!("{}_core{}", consts::DLL_PREFIX, consts::DLL_SUFFIX);
    let built = shell::target_folder()?.join("debug").join(built);
    let name = if cfg!(windows) { "_core.pyd" } else { "_core.abi3.so" };
    let placed = shell::root().join(SOURCES).join("slipstick").join(name);
    // What has been loaded is not written over while a process runs with it.
    let _ = std::fs::remove_file(&placed);
    std::fs::copy(&built, &placed)
        .map(|_| ())
        .map_err(|error| format!("{}: {error}", built.display()))
}

/// Lets the Python of an environment find the package where its sources are.
pub fn findable(python: &Path) -> Outcome {
    const FOLDER: &str = "import sysconfig; print(sysconfig.get_path('purelib'))";
    let folder = shell::output(shell::command(python).args(["-c", FOLDER]))?;
    let path = shell::root().join(SOURCES);
    let file = Path::new(folder.trim()).join("slipstick.pth");
    std::fs::write(&file, format!("{}\n", path.display()))
        .map_err(|error| format!("{}: {error}", file.display()))
}

/// A Python that is new enough and can make environments.
fn program() -> Option<&'static str> {
    const PROBE: &str = "import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 11))";
    ["python3", "python"].into_iter().find(|name| {
        let mut probe = shell::command(name);
        probe.args(["-c", PROBE]).stdout(Stdio::null()).stderr(Stdio::null());
        probe.status().is_ok_and(|status| status.success())
    })
}

/// Python of a new environment.
pub fn new_environment(program: &str, folder: &Path) -> Result<PathBuf, String> {
    shell::run(shell::command(program).args(["-m", "venv"]).arg(folder))?;
    Ok(folder.join(PYTHON))
}

/// Where the environment has its Python.
const PYTHON: &str = if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" };

/// Python of an environment with what a list of requirements names in it.
pub fn environment(folder: &str, requirements: &str) -> Result<PathBuf, String> {
    let program = program().ok_or("expected python3 (3.11 or later) with venv, found none");
    environment_by(program?, &shell::root().join(folder), requirements)
}

/// The same by a given Python.
fn environment_by(program: &str, folder: &Path, requirements: &str) -> Result<PathBuf, String> {
    let python = folder.join(PYTHON);
    let wanted = shell::root().join(requirements);
    let installed = folder.join("requirements.txt");
    let read = |path: &Path| std::fs::read_to_string(path).ok();
    if python.exists() && read(&wanted).is_some() && read(&wanted) == read(&installed) {
        return Ok(python);
    }
    new_environment(program, folder)?;
    let mut pip = shell::command(&python);
    pip.args(["-m", "pip", "install", "--quiet", "--requirement"]).arg(&wanted);
    shell::run(&mut pip)?;
    // Kept beside what was installed, so that the next run need not ask pip.
    std::fs::copy(&wanted, &installed)
        .map_err(|error| format!("{}: {error}", installed.display()))?;
    Ok(python)
}
