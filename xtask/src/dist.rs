//! What is handed out: the command built as well as it can be, with its pages and checksums.

use crate::shell::{self, Outcome};
use sha2::{Digest, Sha256};
use std::env::consts;
use std::fs;
use std::path::{Path, PathBuf};

/// Shells with completions.
const SHELLS: [&str; 5] = ["bash", "zsh", "fish", "elvish", "powershell"];

/// The binary of the profile `dist`, static where the musl target is installed, its manual pages and
/// completions, and `SHA256SUMS`: into `dist` in the target folder; where the binary lies there.
pub fn dist() -> Result<PathBuf, String> {
    let target = shell::target_folder()?;
    let mut build = shell::cargo("build --profile dist -p slipstick-cli");
    let built = match musl()? {
        Some(triple) => {
            build.args(["--target", &triple]);
            target.join(triple).join("dist")
        }
        None => {
            eprintln!("the binary needs the C library of this system: no musl target is installed");
            target.join("dist")
        }
    };
    shell::run(&mut build)?;
    let name = format!("slipstick{}", consts::EXE_SUFFIX);
    let folder = target.join("dist").join(format!("slipstick-{}", env!("CARGO_PKG_VERSION")));
    // What an earlier version left there belongs to that version.
    let _ = fs::remove_dir_all(&folder);
    for inside in ["", "man", "completions"] {
        let path = folder.join(inside);
        fs::create_dir_all(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    }
    let program = folder.join(&name);
    let (from, to) = (built.join(&name), &program);
    fs::copy(&from, to).map_err(|error| format!("{}: {error}", from.display()))?;
    shell::run(shell::command(&program).arg("man").arg(folder.join("man")))?;
    for shell_name in SHELLS {
        let text = shell::output(shell::command(&program).args(["completions", shell_name]))?;
        shell::write(&folder.join("completions").join(format!("slipstick.{shell_name}")), &text)?;
    }
    for licence in ["LICENSE-MIT", "LICENSE-APACHE"] {
        let from = shell::root().join(licence);
        fs::copy(&from, folder.join(licence))
            .map_err(|error| format!("{}: {error}", from.display()))?;
    }
    shell::write(&folder.join("SHA256SUMS"), &checksums(&folder)?)?;
    Ok(program)
}

/// The musl target of this processor, where it is installed.
fn musl() -> Result<Option<String>, String> {
    if consts::OS != "linux" {
        return Ok(None);
    }
    let triple = format!("{}-unknown-linux-musl", consts::ARCH);
    let mut rustc = shell::command("rustc");
    rustc.args(["--print", "target-libdir", "--target", &triple]);
    let libraries = shell::output(&mut rustc)?;
    Ok(Path::new(libraries.trim()).is_dir().then_some(triple))
}

/// Lines as `sha256sum` writes and checks them, by name.
fn checksums(folder: &Path) -> Result<String, String> {
    let mut files = Vec::new();
    list(folder, &mut files)?;
    files.sort();
    let mut lines = String::new();
    for path in files {
        let bytes = fs::read(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        let hash: String = Sha256::digest(&bytes).iter().map(|b| format!("{b:02x}")).collect();
        let inside = path.strip_prefix(folder).unwrap_or(&path);
        let parts: Vec<_> = inside.iter().map(|part| part.to_string_lossy()).collect();
        lines.push_str(&format!("{hash}  {}\n", parts.join("/")));
    }
    Ok(lines)
}

fn list(folder: &Path, files: &mut Vec<std::path::PathBuf>) -> Outcome {
    let failed = |error| format!("{}: {error}", folder.display());
    for entry in fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if path.is_dir() {
            list(&path, files)?;
        } else {
            files.push(path);
        }
    }
    Ok(())
}
