//! `slipstick paper`: the paper, reproduced.

use std::path::Path;
use std::process::ExitCode;

use slipstick::motion::GroundMotion;
use slipstick::study::engine::Engine;
use slipstick_files::{FileError, OutputFolder, folder_records, on_threads};
use slipstick_paper::chapter::{Chapter, chapter, claims_json, listing};
use slipstick_paper::{Grid, PaperError, paper_library, reproduce};

use crate::args::PaperArgs;
use crate::failure::{Failure, print, say};
use crate::progress::counted;

/// Reproduces the paper, prints its verdicts and writes its chapter.
pub fn paper(args: &PaperArgs) -> Result<ExitCode, Failure> {
    let folders = args.out.as_deref().map(folders).transpose()?;
    let grid = if args.quick { Grid::Quick } else { Grid::Full };
    let failed = |error: PaperError| Failure::Message(error.to_string());
    let mut library = paper_library().map_err(failed)?;
    if let Some(folder) = &args.records {
        library = library.with_records(records(folder, args.quiet)?);
    }
    let work = |engine: &Engine<'_>| {
        on_threads(args.threads.number(), || reproduce(&library, grid, engine))
    };
    let result = counted("computing", args.quiet, work).map_err(failed)?;
    if let Some([out, figures]) = folders {
        let chapter = chapter(&result).map_err(failed)?;
        write(&chapter, &claims_json(&result), out, figures)?;
    }
    if args.json {
        print(&claims_json(&result))?;
    } else {
        print(&listing(&result))?;
    }
    if let (Some(out), false) = (&args.out, args.quiet) {
        say(format_args!("wrote {}", out.join("chapter.md").display()));
    }
    Ok(ExitCode::SUCCESS)
}

/// The records of a folder; how many files are none is said, and why the first is not.
fn records(folder: &Path, quiet: bool) -> Result<Vec<(String, GroundMotion)>, Failure> {
    let found = folder_records(folder)?;
    if found.records.is_empty() {
        let folder = folder.display();
        return Err(Failure::Message(format!(
            "{folder}: expected records, found none that can be read"
        )));
    }
    if let (Some(first), false) = (found.skipped.first(), quiet) {
        let (read, skipped) = (found.records.len(), found.skipped.len());
        say(format_args!(
            "warning: {read} records read, {skipped} files skipped; the first: {first}"
        ));
    }
    Ok(found.records)
}

/// The output folder and the one for figures in it, found to be writable before the work.
fn folders(out: &Path) -> Result<[OutputFolder; 2], FileError> {
    Ok([OutputFolder::create(out, &[])?, OutputFolder::create(&out.join("figures"), &[])?])
}

fn write(
    chapter: &Chapter,
    claims: &str,
    mut out: OutputFolder,
    mut figures: OutputFolder,
) -> Result<(), FileError> {
    out.write("chapter.md", chapter.markdown.as_bytes())?;
    out.write("claims.json", claims.as_bytes())?;
    for (name, svg) in &chapter.figures {
        figures.write(name, svg.as_str().as_bytes())?;
    }
    figures.commit()?;
    out.commit()
}
