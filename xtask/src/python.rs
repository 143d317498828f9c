//! Python environments of the tasks that need one.

use crate::shell;
use std::path::{Path, PathBuf};
use std::process::Stdio;

/// A Python that is new enough and can make environments.
fn program() -> Option<&'static str> {
    const PROBE: &str = "import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 11))";
    ["python3", "python"].into_iter().find(|name| {
        let mut probe = shell::command(name);
        probe.args(["-c", PROBE]).stdout(Stdio::null()).stderr(Stdio::null());
        probe.status().is_ok_and(|status| status.success())
    })
}

/// Python of an environment with what a list of requirements names in it.
pub fn environment(folder: &str, requirements: &str) -> Result<PathBuf, String> {
    let folder = shell::root().join(folder);
    let python = folder.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    let wanted = shell::root().join(requirements);
    let installed = folder.join("requirements.txt");
    let read = |path: &Path| std::fs::read_to_string(path).ok();
    if python.exists() && read(&wanted).is_some() && read(&wanted) == read(&installed) {
        return Ok(python);
    }
    let program = program().ok_or("expected python3 (3.11 or later) with venv, found none")?;
    shell::run(shell::command(program).args(["-m", "venv"]).arg(&folder))?;
    let mut pip = shell::command(&python);
    pip.args(["-m", "pip", "install", "--quiet", "--requirement"]).arg(&wanted);
    shell::run(&mut pip)?;
    // Kept beside what was installed, so that the next run need not ask pip.
    std::fs::copy(&wanted, &installed)
        .map_err(|error| format!("{}: {error}", installed.display()))?;
    Ok(python)
}
