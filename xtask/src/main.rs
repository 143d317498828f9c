//! `cargo xtask`: the project's own tasks, on cargo and rustup alone unless a task says otherwise.

mod building;
mod ci;
mod console;
mod dist;
mod findings;
mod paper;
mod peers;
mod python;
mod reference;
mod shell;
mod tools;
mod web;

use std::process::ExitCode;

const HELP: &str = "\
Slipstick's own tasks

Usage: cargo xtask TASK

  ci [WORD...]                   formatting, lints, every test, documentation, wasm, examples,
                                 licences; last line: N passed, N failed, N skipped
                                 (WORD: the steps with one of these words in their names)
  nightly                        the tests that take minutes, coverage of intervals, every fuzz
                                 target for ten minutes (installs cargo-fuzz)
  release-check [WORD...]        page, binary and wheel built as a release has them, and tested
  bench-build [WORD...] [--write]
                                 times a fresh clone: first answer, a change of the solver, tests,
                                 pip install, ci (WORD: those with one of these words in their
                                 names; --write: into book/src/generated/building.md)
  reference [--write]            every reference case: truth, tolerance, error reached
                                 (--write: into book/src/generated/verification.md)
  console [--write]              runs the commands that README and book show and compares what
                                 they print (--write: puts it there)
  paper [--write]                reproduces the paper and compares with the book's chapter
                                 (--write: into book/src/paper.md)
  findings [--write]             what practice assumes, measured on recorded pairs by the command
                                 (--write: into book/src/generated/findings.md; needs its records)
  bench-peers [--json] [--quick] [--write]
                                 times the same analyses here, in a numba loop, SciPy and
                                 OpenSeesPy (needs python3; makes .venv)
                                 (--write: into book/src/generated/peers.md)
  bench-storeys [--json] [--quick] [--write]
                                 times frames of 0 to 20 storeys, their histories and certificates,
                                 beside a numba loop for frames
                                 (--write: into book/src/generated/storeys.md)
  bench-structure [--quick] [--write]
                                 a frame of OpenSees on a sliding slab: its time history beside
                                 the run by its modes, all and fewer (needs python3; makes .venv)
                                 (--write: into book/src/generated/structure.md)
  bench-study [--quick] [--write]
                                 times the far-field study on one thread and two, in a numba loop
                                 and in OpenSeesPy; reads it as readers does (needs its records)
                                 (--write: into book/src/generated/studies.md)
  bench-records [--quick] [--write]
                                 times reading and response spectra beside NumPy, ObsPy, eqsig
                                 and pyrotd (--write: into book/src/generated/records.md)
  bench-python [--quick] [--write]
                                 times the Python package beside the command, its import, its tables
                                 and a cluster of Dask (--write: into book/src/generated/python.md)
  notices [--write]              the table of what every notice means
                                 (--write: into book/src/generated/notices.md)
  python-docs [--write]          compares the book's reference of the Python package with its
                                 docstrings (--write: writes it; needs python3)
  notebooks                      runs the notebooks of the examples and writes them as pages of the
                                 book, with their figures (needs python3)
  python-free-threaded           builds the Python package for a free-threaded Python and runs its
                                 tests there (needs python3.14t)
  readers                        reads the parts of a study in pandas, Polars and DuckDB
                                 (needs python3; makes .venv)
  web [--serve]                  the page, into target/web: a folder for any static host, and
                                 slipstick.html (needs node and npm; --serve: shows it)
  bench-web [--write]            measures the page in Chromium against its bars
                                 (--write: into book/src/generated/web.md)
  fuzz [TARGET] [--seconds N]    all fuzz targets or one, 60 s each (installs cargo-fuzz)
  fuzz --minutes N               all fuzz targets in so many minutes together
  coverage                       how often intervals of identify cover the truth, 200 tests a
                                 parameter, and that silent tests are refused
  deny                           licences, advisories, doubles (installs cargo-deny)
  dist                           the best binary (static where the musl target is installed),
                                 manual pages, completions, checksums: into target/dist
  man                            the manual pages, into the target folder
  book                           the manual with its figures, into book/build (installs mdbook)
  figures                        the figures of the README and the manual, into book/src/figures;
                                 the repository holds those of the README only
  help                           this text
";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let outcome = match words.as_slice() {
        ["ci", words @ ..] => return ci::ci(words),
        ["nightly"] => return ci::nightly(),
        ["release-check", words @ ..] => return ci::release_check(words),
        ["bench-build", options @ ..] => building::bench_build(options),
        ["reference", options @ ..] => reference::reference(options),
        ["console", options @ ..] => console::console(options),
        ["findings", options @ ..] => findings::findings(options),
        ["paper", options @ ..] => paper::paper(options),
        ["bench-peers", options @ ..] => peers::bench_peers(options),
        ["bench-storeys", options @ ..] => peers::bench_storeys(options),
        ["bench-structure", options @ ..] => peers::bench_structure(options),
        ["bench-study", options @ ..] => peers::bench_study(options),
        ["bench-python", options @ ..] => peers::bench_python(options),
        ["notices", options @ ..] => tools::notices(options),
        ["python-docs", options @ ..] => python::docs(options),
        ["notebooks"] => python::notebooks(),
        ["python-free-threaded"] => python::free_threaded(),
        ["readers"] => peers::readers(),
        ["bench-records", options @ ..] => peers::bench_records(options),
        ["web", options @ ..] => web::web(options),
        ["bench-web", options @ ..] => web::bench(options),
        ["fuzz", options @ ..] => tools::fuzz(options),
        ["coverage"] => tools::coverage(),
        ["deny"] => tools::deny(),
        ["dist"] => dist::dist().map(drop),
        ["man"] => tools::man(),
        ["book"] => tools::book(),
        ["figures"] => tools::figures(),
        [] | ["help" | "--help" | "-h"] => {
            print!("{HELP}");
            Ok(())
        }
        _ => Err(format!("unknown task: {}\n\n{HELP}", words.join(" "))),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("xtask: {message}");
            ExitCode::FAILURE
        }
    }
}
