//! `cargo xtask console`: the commands that the README and the book show, run again.
//!
//! A block of code whose first line begins with `$ ` is a command (which goes on after a `\`) and what
//! it prints, several of them one after another. The commands of a page run in one folder with the
//! repository's `examples` in it. A line `…` stands for any lines. `<!-- run: COMMAND -->` runs a
//! command that the page does not show.

use crate::shell::{self, Outcome};
use std::path::{Path, PathBuf};

const MARK: &str = "…";

/// Compares the outputs with those printed now, or writes them.
pub fn console(options: &[&str]) -> Outcome {
    let write = match options {
        [] => false,
        ["--write"] => true,
        _ => return Err(format!("console: expected --write, found {}", options.join(" "))),
    };
    let folder = built()?;
    let (blocks, differing) = pages(&folder, write)?;
    match differing.as_slice() {
        _ if write => println!("wrote {} of {blocks} outputs", differing.len()),
        [] => println!("{blocks} outputs are what the commands print"),
        _ => return Err(differing.join("\n")),
    }
    Ok(())
}

/// Builds the command; the folder that it is in.
pub fn built() -> Result<PathBuf, String> {
    shell::run(&mut shell::cargo("build --release -p slipstick-cli"))?;
    Ok(shell::target_folder()?.join("release"))
}

/// Runs the commands of every page with the programs in a folder. The number of blocks, and what
/// differs.
pub fn pages(programs: &Path, write: bool) -> Result<(usize, Vec<String>), String> {
    let root = shell::root();
    let mut pages = vec![PathBuf::from("README.md")];
    let entries = std::fs::read_dir(root.join("book/src")).map_err(|error| error.to_string())?;
    let names = entries.filter_map(|entry| Some(entry.ok()?.file_name()));
    pages.extend(names.map(|name| Path::new("book/src").join(name)));
    pages.retain(|page| page.extension().is_some_and(|extension| extension == "md"));
    pages.sort();
    let (mut blocks, mut differing) = (0, Vec::new());
    for page in pages {
        let path = root.join(&page);
        let Rerun { text, fresh, blocks: count, .. } = rerun(programs, &page)?;
        blocks += count;
        if fresh == text {
            continue;
        }
        let mut lines = text.lines().zip(fresh.lines()).enumerate();
        let at = lines.find(|(_, (old, new))| old != new);
        let (line, (old, new)) = at.map_or((0, ("", "")), |(line, both)| (line + 1, both));
        differing.push(format!("{}:{line}: shows {old:?}, prints {new:?}", page.display()));
        if write {
            shell::write(&path, &fresh)?;
        }
    }
    Ok((blocks, differing))
}

/// A page whose commands have run once more.
pub struct Rerun {
    text: String,
    fresh: String,
    blocks: usize,
    /// Where they ran, and left what they write.
    pub folder: PathBuf,
}

/// Runs the commands of a page, named by its path in the repository.
pub fn rerun(programs: &Path, page: &Path) -> Result<Rerun, String> {
    let path = shell::root().join(page);
    let text =
        std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", page.display()))?;
    let folder = shell::target_folder()?.join("console").join(page.with_extension(""));
    let mut terminal = Terminal { folder: folder.clone(), programs, started: false };
    let (fresh, blocks) = page_again(&text, |command| terminal.run(command))?;
    Ok(Rerun { text, fresh, blocks, folder })
}

/// A folder in which commands run one after another.
struct Terminal<'a> {
    folder: PathBuf,
    programs: &'a Path,
    started: bool,
}

impl Terminal<'_> {
    /// What a command prints, errors included.
    fn run(&mut self, command: &str) -> Result<String, String> {
        let failed = |error: std::io::Error| format!("{}: {error}", self.folder.display());
        if !self.started {
            if self.folder.exists() {
                std::fs::remove_dir_all(&self.folder).map_err(failed)?;
            }
            std::fs::create_dir_all(&self.folder).map_err(failed)?;
            copy(&shell::root().join("examples"), &self.folder.join("examples")).map_err(failed)?;
            self.started = true;
        }
        let mut paths = vec![self.programs.to_path_buf()];
        paths.extend(std::env::split_paths(&std::env::var_os("PATH").unwrap_or_default()));
        let path = std::env::join_paths(paths).map_err(|error| error.to_string())?;
        let mut sh = shell::command("sh");
        sh.arg("-c").arg(format!("{{ {command}\n}} 2>&1")).env("PATH", path);
        let output = sh.current_dir(&self.folder).output().map_err(failed)?;
        Ok(String::from_utf8_lossy(&output.stdout).into_owned())
    }
}

fn copy(from: &Path, to: &Path) -> std::io::Result<()> {
    std::fs::create_dir_all(to)?;
    for entry in std::fs::read_dir(from)? {
        let entry = entry?;
        let target = to.join(entry.file_name());
        if entry.file_type()?.is_dir() {
            copy(&entry.path(), &target)?;
        } else {
            std::fs::copy(entry.path(), target)?;
        }
    }
    Ok(())
}

/// A page with the output of each of its commands as `run` gives it, and how many blocks it has.
fn page_again(
    text: &str,
    mut run: impl FnMut(&str) -> Result<String, String>,
) -> Result<(String, usize), String> {
    let (mut page, mut blocks) = (String::new(), 0);
    let mut lines = text.lines().peekable();
    let mut in_code = false;
    while let Some(line) = lines.next() {
        page.push_str(line);
        page.push('\n');
        if let Some(rest) = line.strip_prefix("<!-- run: ") {
            run(rest.trim_end_matches("-->").trim())?;
        }
        if !line.starts_with("```") {
            continue;
        }
        in_code = !in_code;
        let is_command = |line: &&str| line.starts_with("$ ");
        if !(in_code && lines.peek().is_some_and(is_command)) {
            continue;
        }
        blocks += 1;
        while let Some(first) = lines.next_if(is_command) {
            let mut command = vec![first];
            while command.last().is_some_and(|line| line.ends_with('\\')) {
                command.extend(lines.next());
            }
            let shown: Vec<&str> = std::iter::from_fn(|| {
                lines.next_if(|line| !line.starts_with("$ ") && !line.starts_with("```"))
            })
            .collect();
            let output = run(&command.join("\n")[2..])?;
            let printed: Vec<&str> = output.lines().map(str::trim_end).collect();
            for line in command.into_iter().chain(abridged(&printed, &shown)) {
                page.push_str(line);
                page.push('\n');
            }
        }
    }
    Ok((page, blocks))
}

/// The lines that a page shows of an output: as many as it did before and after its mark.
fn abridged<'a>(printed: &[&'a str], shown: &[&'a str]) -> Vec<&'a str> {
    let Some(mark) = shown.iter().position(|line| line.trim() == MARK) else {
        return printed.to_vec();
    };
    let head = mark.min(printed.len());
    let tail = (shown.len() - mark - 1).min(printed.len() - head);
    [&printed[..head], &[shown[mark]], &printed[printed.len() - tail..]].concat()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outputs_are_replaced() {
        let page = "a\n<!-- run: hidden -->\n```text\n$ one \\\n  two\nold\n$ three\n1\n…\n4\n```\n\
                    ```toml\nx = 1\n```\n";
        let mut commands = Vec::new();
        let (fresh, blocks) = page_again(page, |command| {
            commands.push(command.to_owned());
            Ok(if command == "three" { "1\n2\n3\n5\n" } else { "new\n" }.to_owned())
        })
        .unwrap();
        assert_eq!(commands, ["hidden", "one \\\n  two", "three"]);
        assert_eq!(fresh, page.replace("old", "new").replace("\n4\n", "\n5\n"));
        assert_eq!(blocks, 1);
    }
}
