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
    let folder = shell::target_folder()?.join("paper");
    // What an earlier run left there is no figure of this one.
    let _ = fs::remove_dir_all(&folder);
    let run = "run --quiet --package slipstick-cli -- paper --out";
    shell::output(shell::cargo(run).arg(&folder))?;
    let book = shell::root().join("book/src");
    let mut files = vec![(folder.join("chapter.md"), book.join("paper.md"))];
    for figure in entries(&folder.join("figures"))? {
        let name = figure.file_name().unwrap_or_default();
        files.push((figure.clone(), book.join("figures").join(name)));
    }
    let mut stale = Vec::new();
    for (made, shown) in &files {
        let bytes = read(made)?;
        if write {
            fs::write(shown, &bytes).map_err(|error| format!("{}: {error}", shown.display()))?;
        } else if read(shown).ok().as_ref() != Some(&bytes) {
            stale.push(shown.display().to_string());
        }
    }
    if stale.is_empty() {
        println!("{} files", files.len());
        Ok(())
    } else {
        Err(format!("paper: differs from what the command writes: {}", stale.join(", ")))
    }
}

fn read(path: &Path) -> Result<Vec<u8>, String> {
    fs::read(path).map_err(|error| format!("{}: {error}", path.display()))
}

fn entries(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let read = fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut paths: Vec<PathBuf> = read.filter_map(Result::ok).map(|entry| entry.path()).collect();
    paths.sort();
    Ok(paths)
}
