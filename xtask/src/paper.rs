//! `cargo xtask paper`: the chapter "The paper, reproduced" and its figures, by the command itself.

use crate::shell::{self, Outcome};
use std::fs;
use std::path::{Path, PathBuf};

/// Reproduces the paper; `--write` puts the chapter into the book, without it the book's is
/// compared.
pub fn paper(options: &[&str]) -> Outcome {
    let write = match options {
        [] => false,
        ["--write"] => true,
        _ => {
            return Err(format!("paper: expected --write or nothing, found {}", options.join(" ")));
        }
    };
    let made = draw()?.join("chapter.md");
    let shown = shell::root().join("book/src/paper.md");
    let chapter = read(&made)?;
    if write {
        return fs::write(&shown, &chapter).map_err(|error| failed(&shown, &error));
    }
    if read(&shown)? == chapter {
        Ok(())
    } else {
        Err(format!("paper: {} differs from what the command writes", shown.display()))
    }
}

/// Reproduces the paper and puts its figures into the book; the folder with all that was written.
pub fn draw() -> Result<PathBuf, String> {
    let folder = shell::target_folder()?.join("paper");
    // What an earlier run left there is no figure of this one.
    let _ = fs::remove_dir_all(&folder);
    let run = "run --quiet --release --package slipstick-cli -- paper --out";
    shell::output(shell::cargo(run).arg(&folder))?;
    for figure in entries(&folder.join("figures"))? {
        let name = figure.file_name().unwrap_or_default();
        copy(&figure, &shell::root().join("book/src/figures").join(name))?;
    }
    Ok(folder)
}

/// Copies a file.
pub fn copy(from: &Path, to: &Path) -> Outcome {
    fs::copy(from, to).map(|_| ()).map_err(|error| failed(from, &error))
}

fn failed(path: &Path, error: &std::io::Error) -> String {
    format!("{}: {error}", path.display())
}

fn read(path: &Path) -> Result<Vec<u8>, String> {
    fs::read(path).map_err(|error| failed(path, &error))
}

fn entries(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let read = fs::read_dir(folder).map_err(|error| failed(folder, &error))?;
    let mut paths: Vec<PathBuf> = read.filter_map(Result::ok).map(|entry| entry.path()).collect();
    paths.sort();
    Ok(paths)
}
