//! Small tasks. Those that need a tool beyond cargo and rustup install it.

use crate::shell::{self, Outcome};
use crate::{console, paper, python};
use std::fs;
use std::path::Path;

/// Keys set from outside a model, one a line: a seed of the fuzz target for them.
const OVERRIDES: &str = "slider.kinetic_friction=0.04\nslider.static_friction.positive = 0.1\n\
    slider.spring=1 MN/m\nstorey.2.mass=\"70 t\"\nframe.period=0.8 s\nmotion.scale_to=0.3 g\n\
    motion.sine.frequency=2 Hz\ninitial.storey_velocity=[\"1 m/s\"]\nanalysis.method=stepwise\n\
    slider.bounds={ lower = 0.9, upper = 1.1 }\n";

/// Licences, advisories, sources and doubles, by `deny.toml`.
pub fn deny() -> Outcome {
    shell::ensure_installed("cargo-deny", "--version", "cargo-deny")?;
    shell::run(&mut shell::cargo("deny --workspace check"))
}

/// The manual, into `book/build`, with its figures.
pub fn book() -> Outcome {
    shell::ensure_installed("mdbook", "--version", "mdbook")?;
    figures()?;
    python::notebooks()?;
    shell::run(shell::command("mdbook").args(["build", "book"]))
}

/// What the chapter on fragilities shows of what its commands draw.
const FRAGILITY: [(&str, &str); 4] = [
    ("out/ida/ida.svg", "fragility-ida.svg"),
    ("out/fragility/fragility.svg", "fragility-curve.svg"),
    ("out/cloud/cloud.svg", "fragility-cloud.svg"),
    ("out/design/front.svg", "fragility-front.svg"),
];

/// The figures of the manual, into `book/src/figures`: from an example, from the commands of the
/// chapter on fragilities, and of the paper. The repository holds only those of the README.
pub fn figures() -> Outcome {
    shell::run(&mut shell::cargo("run --quiet --release -p slipstick-files --example figures"))?;
    let page = Path::new("book/src/tutorial-fragility.md");
    let folder = console::rerun(&console::built()?, page)?.folder;
    for (made, shown) in FRAGILITY {
        paper::copy(&folder.join(made), &shell::root().join("book/src/figures").join(shown))?;
    }
    paper::draw().map(drop)
}

/// The table of what every notice means, from that of the program.
pub fn notices(options: &[&str]) -> Outcome {
    if !matches!(options, [] | ["--write"]) {
        return Err(format!("notices: expected --write or nothing, found {}", options.join(" ")));
    }
    let table = "run --quiet -p slipstick-files --example notices";
    let table = shell::output(&mut shell::cargo(table))?;
    if options.is_empty() {
        print!("{table}");
        return Ok(());
    }
    shell::write(&shell::root().join("book/src/generated/notices.md"), &table)
}

/// The manual pages of the command, into `man` in the target folder.
pub fn man() -> Outcome {
    let folder = shell::target_folder()?.join("man");
    std::fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    shell::run(shell::cargo("run --quiet --package slipstick-cli -- man").arg(&folder))?;
    eprintln!("wrote {}", folder.display());
    Ok(())
}

/// How long one input may take, in s: what is accepted has its results within seconds.
const FUZZ_TIMEOUT_S: u32 = 60;

/// Runs fuzz targets, all or the one named, each for a while, or all of them for some minutes together.
pub fn fuzz(options: &[&str]) -> Outcome {
    let number = |option: &str, text: &str| -> Result<u64, String> {
        text.parse().map_err(|_| format!("fuzz {option}: expected a whole number, found {text}"))
    };
    let (chosen, time) = match options {
        [target, time @ ..] if !target.starts_with("--") => (Some(*target), time),
        time => (None, time),
    };
    let targets = fuzz_targets()?;
    let count = if chosen.is_some() { 1 } else { targets.len() as u64 };
    let seconds = match time {
        [] => 60,
        ["--seconds", seconds] => number("--seconds", seconds)?,
        ["--minutes", minutes] => 60 * number("--minutes", minutes)? / count,
        _ => return Err("fuzz: expected [TARGET] [--seconds N | --minutes N]".to_owned()),
    };
    if let Some(target) = chosen.filter(|target| !targets.iter().any(|t| t == target)) {
        return Err(format!("fuzz: expected one of {}, found {target}", targets.join(", ")));
    }
    shell::ensure_installed("cargo-fuzz", "--version", "cargo-fuzz")?;
    let mut failed = Vec::new();
    for target in targets.iter().filter(|target| chosen.is_none_or(|c| c == *target)) {
        let run = format!(
            "fuzz run {target} -- -max_total_time={seconds} -timeout={FUZZ_TIMEOUT_S} \
             -print_final_stats=1"
        );
        seed(target)?;
        // Sanitizers are still behind a flag of the nightly compiler; this opens it on stable.
        if shell::run(shell::cargo(&run).env("RUSTC_BOOTSTRAP", "1")).is_err() {
            failed.push(target.as_str());
        }
    }
    if failed.is_empty() { Ok(()) } else { Err(format!("fuzz: failed: {}", failed.join(", "))) }
}

/// Puts what is known to be read into the corpus of a target, so that it starts from there.
fn seed(target: &str) -> Outcome {
    let corpus = shell::root().join("fuzz/corpus").join(target);
    let failed = |path: &Path, error| format!("{}: {error}", path.display());
    fs::create_dir_all(&corpus).map_err(|error| failed(&corpus, error))?;
    if target == "overrides" {
        let path = corpus.join("seed");
        return fs::write(&path, OVERRIDES).map_err(|error| failed(&path, error));
    }
    let sources: &[&str] = match target {
        "model" => &["crates/report/models", "examples"],
        "plan" => &["examples/studies"],
        // Edits of plans that are part of the target.
        "plan_edited" => &[],
        _ => &["data/records"],
    };
    for source in sources {
        let folder = shell::root().join(source);
        let entries = fs::read_dir(&folder).map_err(|error| failed(&folder, error))?;
        for path in entries.filter_map(Result::ok).map(|entry| entry.path()) {
            let other = target == "model" && path.extension().is_none_or(|e| e != "toml");
            if let Some(name) = path.file_name().filter(|_| path.is_file() && !other) {
                fs::copy(&path, corpus.join(name)).map_err(|error| failed(&path, error))?;
            }
        }
    }
    Ok(())
}

/// Two hundred made tests for each parameter that `identify` tells.
pub fn coverage() -> Outcome {
    const TESTS: &str = "test -p slipstick --lib -- --ignored --nocapture coverage_";
    shell::run(&mut shell::cargo(TESTS))
}

fn fuzz_targets() -> Result<Vec<String>, String> {
    let list = shell::root().join("fuzz/fuzz_targets");
    let entries = fs::read_dir(&list).map_err(|e| format!("{}: {e}", list.display()))?;
    let mut targets: Vec<String> = entries
        .filter_map(Result::ok)
        .filter_map(|entry| Some(entry.file_name().to_str()?.strip_suffix(".rs")?.to_owned()))
        .collect();
    targets.sort();
    Ok(targets)
}
