//! `slipstick study`: many analyses of one plan.

use std::ops::ControlFlow;
use std::path::Path;
use std::process::ExitCode;
use std::time::Duration;

use slipstick::study::engine::Engine;
use slipstick::study::{Certified, StudySummary};
use slipstick_files::{
    FileError, InputFiles, OpenStudy, OutputFolder, STUDY_REPORT, Shard, StudyError, clear,
    conclude, estimate, has_parts, kept_runs, merge, on_threads, part_rows, quoted, read_bytes,
};
use slipstick_report::number::count;
use slipstick_report::study::{StudyReport, said, table};

use crate::args::{StudyArgs, StudyCommand};
use crate::failure::{Failure, print, say};
use crate::progress::{Steps, counted, on_interrupt, watched};
use crate::results::command_line;

/// How long `--dry-run` runs samples to know how fast they are.
const TRIAL: Duration = Duration::from_secs(1);

/// Runs a plan, or what else is asked of it.
pub fn study(args: &StudyArgs) -> Result<ExitCode, Failure> {
    if let Some(StudyCommand::Merge { folders, out }) = &args.command {
        let merged = merge(folders, out)?;
        say(format_args!("wrote {}: {} rows", out.display(), count(merged.rows)));
        return Ok(ExitCode::SUCCESS);
    }
    let Some(plan) = &args.plan else {
        return Err(Failure::Message("expected a study plan, found none".to_owned()));
    };
    let shard = shard(args)?;
    on_threads(args.threads.number(), || planned(args, plan, shard))
}

/// What is asked of a plan, in the pool of its threads.
fn planned(args: &StudyArgs, plan: &Path, shard: Shard) -> Result<ExitCode, Failure> {
    let study =
        counted("reading records", args.quiet, |engine| OpenStudy::open_followed(plan, engine))?;
    if let Some(run) = args.repeat {
        print(&study.repeat(run)?)?;
        return Ok(ExitCode::SUCCESS);
    }
    if !args.quiet {
        for notice in &study.notices {
            say(format_args!("warning: {notice}"));
        }
    }
    if args.dry_run {
        return dry_run(args, &study, shard);
    }
    let Some(out) = &args.out else {
        return Err(Failure::Message("--out: expected a folder, found none".to_owned()));
    };
    run(args, &study, shard, out)
}

fn shard(args: &StudyArgs) -> Result<Shard, Failure> {
    let Some(text) = &args.shard else { return Ok(Shard::WHOLE) };
    let wrong = || {
        let message =
            format!("--shard: expected i/n with i from 1 to n, such as 3/8, found {text:?}");
        Failure::Message(message)
    };
    let (index, of) = text.split_once('/').ok_or_else(wrong)?;
    let number = |text: &str| text.trim().parse::<u64>().map_err(|_| wrong());
    Shard::new(number(index)?, number(of)?).map_err(|_| wrong())
}

/// Runs what the folder lacks, then tells what the folder holds.
fn run(args: &StudyArgs, study: &OpenStudy, shard: Shard, out: &Path) -> Result<ExitCode, Failure> {
    if args.force {
        clear(out)?;
    } else if !args.resume && has_parts(out)? {
        return Err(Failure::Message(format!(
            "{}: expected an empty folder, found files: go on with --resume, or start anew with \
             --force",
            out.display()
        )));
    }
    let (total, folder) = (study.study.runs(), out.to_owned());
    let again = resumed();
    on_interrupt(move || {
        let done = count(kept_runs(&folder, total));
        let (folder, total) = (folder.display(), count(total));
        format!(
            "interrupted: {done} of {total} runs are done and kept in {folder}; go on with\n  {again}"
        )
    });
    let bar = Steps::new(study.shard_runs(shard), args.quiet);
    let follow = |runs: u64| {
        bar.advance(runs);
        ControlFlow::Continue(())
    };
    let outcome = study.run_shard(shard, out, &Engine::new(&follow));
    bar.finish();
    let outcome = match outcome {
        Ok(outcome) => outcome,
        Err(error @ StudyError::CheckFailed { .. }) => {
            say(format_args!("error: {error}"));
            return Ok(ExitCode::from(1));
        }
        Err(error) => return Err(error.into()),
    };
    for notice in &outcome.notices {
        say(format_args!("warning: {notice}"));
    }
    let summary = counted("summarising", args.quiet, |engine| conclude(study, out, engine))?;
    print(&table(&summary, args.display_units))?;
    for notice in said(&summary).iter().filter(|_| !args.quiet) {
        say(format_args!("{}: {}: {}", notice.severity().name(), notice.kind, notice.message));
    }
    let certified = outcome.checks.certified(outcome.runs);
    if args.report {
        report(args, study, &summary, &certified, out)?;
    }
    if !args.quiet {
        say(format_args!(
            "{} runs, {} failed; run again alone, with the same bits: {certified}",
            count(outcome.runs),
            count(outcome.failures),
        ));
        let page = if args.report { STUDY_REPORT } else { "summary.csv" };
        let (page, table) = (out.join(page), out.join("parts"));
        say(format_args!("wrote {}; the table is {}", page.display(), table.display()));
    }
    // Rows without an answer are no answer to all that was asked.
    Ok(ExitCode::from(u8::from(outcome.failures > 0)))
}

/// Writes the page of a study.
fn report(
    args: &StudyArgs,
    study: &OpenStudy,
    summary: &StudySummary,
    certified: &Certified,
    out: &Path,
) -> Result<(), Failure> {
    let page = StudyReport {
        study: &study.study,
        summary,
        certified,
        notices: &study.notices,
        display: args.display_units,
    };
    let what = |i: usize| ["plan", "model"].get(i).copied().unwrap_or("record");
    let named = study.inputs.iter().enumerate();
    let named = named.map(|(i, (path, sha256))| (path.clone(), sha256.clone(), what(i).to_owned()));
    let model = String::from_utf8_lossy(&read_bytes(&study.model_path)?).into_owned();
    let texts = [study.plan_text.clone(), model].into_iter().zip(&study.inputs);
    let texts = texts.map(|(text, (path, _))| (path.clone(), text)).collect();
    let inputs = InputFiles { files: named.collect(), texts };
    let mut folder = OutputFolder::create(out, &[])?;
    folder.write(STUDY_REPORT, inputs.page(&page.sheet(), &command_line()).as_bytes())?;
    Ok(folder.commit()?)
}

/// The command as it was typed, to go on with it.
fn resumed() -> String {
    let typed = std::env::args_os().skip(1).map(|word| word.to_string_lossy().into_owned());
    let kept = typed.filter(|word| word != "--force" && word != "--resume");
    let words = ["slipstick".to_owned()].into_iter().chain(kept).chain(["--resume".to_owned()]);
    words.map(|word| quoted(&word)).collect::<Vec<_>>().join(" ")
}

/// Counts, and the time that the runs may take.
fn dry_run(args: &StudyArgs, study: &OpenStudy, shard: Shard) -> Result<ExitCode, Failure> {
    let (runs, time) = watched("timing", args.quiet, || estimate(study, shard, TRIAL))?;
    let cases = study.study.cases();
    let total = study.study.runs();
    let mut text = format!(
        "records  {}\nlevels   {}\nsamples  {}\n",
        count(cases.records),
        count(cases.levels),
        count(cases.samples),
    );
    if study.study.has_bounds() {
        let names: Vec<&str> = study.study.bounds().iter().map(|bound| bound.name).collect();
        text.push_str(&format!("friction {}\n", names.join(", ")));
    }
    text.push_str(&format!("runs     {}\n", count(total)));
    if runs != total {
        text.push_str(&format!("of shard {}\n", count(runs)));
    }
    text.push_str(&format!(
        "parts    of {} rows\ntime     about {}\n",
        count(part_rows(total)),
        duration(time)
    ));
    print(&text)?;
    if let Some(out) = &args.out
        && out.exists()
        && !out.is_dir()
    {
        return Err(FileError::NotAFolder { path: out.clone() }.into());
    }
    Ok(ExitCode::SUCCESS)
}

/// A time as a person says it.
fn duration(time: Duration) -> String {
    match time.as_secs_f64() {
        seconds if seconds < 1.0 => "1 s".to_owned(),
        seconds if seconds < 120.0 => format!("{seconds:.0} s"),
        seconds if seconds < 7200.0 => format!("{:.0} min", seconds / 60.0),
        seconds if seconds < 172_800.0 => format!("{:.0} h", seconds / 3600.0),
        seconds => format!("{:.0} days", seconds / 86_400.0),
    }
}
