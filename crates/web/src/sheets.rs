//! Analyses over a suite and studies, laid out as the command lays them out.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use slipstick::assessment::models::Models;
use slipstick::assessment::suite::Suite;
use slipstick::error::listed;
use slipstick::input::loaded::{Components, Loaded, Wanted};
use slipstick::input::plan::Plan;
use slipstick::input::unfit::refuse_unfit;
use slipstick::input::{Analysis, MotionSource, Override};
use slipstick::notice::{Notice, NoticeKind};
use slipstick::record::{self, Options};
use slipstick::requests::{Answer, Field, FrontEnd, Kind, On, Request, Results, Runs, Takes};
use slipstick::response::Method;
use slipstick::study::engine::Engine;
use slipstick::study::summary::{Rows, Take};
use slipstick::study::{Case, Certified, Record, Study};
use slipstick::table::Table;
use slipstick_report::DisplayUnits;
use slipstick_report::assessment::answer::Tabled;
use slipstick_report::assessment::{Provenance, Sheet, answer};
use slipstick_report::json::{each, pretty};
use slipstick_report::number::{typeset_cell, typeset_sentence};
use slipstick_report::study::StudyReport;
use slipstick_report::tables::to_csv;
use slipstick_report::{FileNote, InputText, report, view};
use wasm_bindgen::prelude::*;

use crate::answer::warning;
use crate::failure::Failure;
use crate::figures;
use crate::records::Records;
use crate::runs;
use crate::session::{MODEL, UNNAMED, parse};
use crate::whole::files_of_motion;

#[wasm_bindgen]
extern "C" {
    /// Told how many runs are done of how many.
    #[wasm_bindgen(js_namespace = globalThis, js_name = slipstickProgress)]
    fn progress(done: f64, planned: f64);
}

/// A result laid out.
#[wasm_bindgen]
pub struct Page {
    state: String,
    html: String,
    json: String,
    tables: String,
}

#[wasm_bindgen]
impl Page {
    /// What the page shows: `{kind, line, verdict, tables, notes, warnings, figures, method}`, and what makes it
    /// again: `commands`, a line each, and `records`, `{path, text, file}` each, without a text where it is the file.
    #[must_use]
    pub fn state(&self) -> String {
        self.state.clone()
    }

    /// The command's `report.html`.
    #[must_use]
    pub fn html(&self) -> String {
        self.html.clone()
    }

    /// The command's `summary.json`.
    #[must_use]
    pub fn json(&self) -> String {
        self.json.clone()
    }

    /// The command's tables: `[{name, columns: [{name, title, unit: {in_si, symbol}, values}]}]`, in SI.
    #[must_use]
    pub fn tables(&self) -> String {
        self.tables.clone()
    }
}

impl Page {
    fn new(sheet: &Sheet, inputs: &[InputText<'_>], files: &[FileNote<'_>], again: &Again) -> Self {
        let first = sheet.first.as_ref().map(|(name, sentence)| format!("{name}: {sentence}"));
        let state = pretty(&view! {
            kind: sheet.kind,
            line: &sheet.line,
            first,
            verdict: each(&sheet.verdict, |sentence| typeset_sentence(sentence)),
            warnings: each(&sheet.warnings, |notice| warning(None, notice, sheet.display)),
            tables: each(&sheet.tables, |(heading, rows)| {
                let rows = each(rows, |row| each(row, |cell| typeset_cell(cell)));
                view! { heading, rows }
            }),
            notes: each(&sheet.notes, |note| typeset_sentence(note)),
            method: each(&sheet.method, |line| typeset_sentence(line)),
            figures: each(&sheet.figures, figures::alive),
            commands: &again.commands,
            records: each(&again.records, |(path, text, file)| view! { path, text, file }),
        });
        let command_line = again.commands.last().map_or("", String::as_str);
        let provenance = Provenance { command_line, files, inputs };
        Self {
            state,
            html: sheet.to_html(&provenance),
            json: sheet.to_json(),
            tables: again.tables.clone(),
        }
    }
}

/// What makes a result again beside `model.toml`.
struct Again {
    /// The commands, one after the other.
    commands: Vec<String>,
    /// The records: their paths, their texts where those are not the files that were dropped, the files.
    records: Vec<(String, Option<String>, String)>,
    /// The tables of its runs.
    tables: String,
}

/// A record, and what its file does not say; empty where it does.
#[derive(Clone, Copy)]
struct Asks<'a> {
    name: &'a str,
    units: &'a str,
    dt: &'a str,
    channel: &'a str,
}

/// Options of a command: names and values.
struct Settings<'a>(&'a [String]);

impl<'a> Settings<'a> {
    fn pairs(&self) -> impl Iterator<Item = (&'a str, &'a str)> + use<'a> {
        let pairs = self.0.chunks_exact(2).map(|pair| (pair[0].as_str(), pair[1].as_str()));
        pairs.filter(|(_, text)| !text.trim().is_empty())
    }

    /// The records, each with what its file does not say: `NAME`, units, step and channel, by line ends.
    fn records(&self) -> impl Iterator<Item = Asks<'a>> + use<'a> {
        self.pairs().filter(|(name, _)| *name == "records").map(|(_, text)| {
            let mut parts = text.split('\n');
            let mut next = || parts.next().unwrap_or("");
            Asks { name: next(), units: next(), dt: next(), channel: next() }
        })
    }

    /// What is asked of an analysis, of all its fields.
    fn asked(&self, kind: Kind) -> Result<Request, Failure> {
        let field = |name: &str| kind.fields().iter().any(|field| field.name == name);
        let given = self.pairs().filter(|(name, _)| field(name));
        let asked = Request::new(kind, given.map(|(name, text)| (name, text.to_owned())));
        asked.map_err(|error| Failure::choice(&error))
    }

    /// What all records leave unsaid alike, as options of the command; none where they differ: then each file
    /// that leaves something unsaid is taken as columns that say it.
    fn unsaid(&self) -> Option<Vec<(&'static str, &'a str)>> {
        let mut all = self.records().map(|Asks { units, dt, channel, .. }| [units, dt, channel]);
        let first = all.next().unwrap_or_default();
        let options = ["units", "dt", "channel"].into_iter().zip(first);
        all.all(|said| said == first)
            .then(|| options.filter(|(_, text)| !text.is_empty()).collect())
    }

    /// The path of a record beside the command.
    fn path(&self, asks: Asks<'a>) -> String {
        if self.unsaid().is_some() || !asks.leaves_unsaid() {
            return asks.name.to_owned();
        }
        let stem = asks.name.rsplit_once('.').map_or(asks.name, |(stem, _)| stem);
        format!("{stem}.csv")
    }

    /// What was asked, as the command takes it.
    fn commands(&self, what: Kind, display: DisplayUnits) -> Vec<String> {
        let kinds = requests(what);
        let command = |(i, kind): (usize, &Kind)| {
            let name = if *kind == Kind::Suite { Kind::Run } else { *kind }.name();
            let mut words = vec![name.to_owned()];
            if i == 0 {
                words.push(MODEL.to_owned());
                let paths: Vec<String> = self.records().map(|asks| self.path(asks)).collect();
                if !paths.is_empty() {
                    words.extend(core::iter::once("--records".to_owned()).chain(paths));
                }
                for (name, text) in self.unsaid().unwrap_or_default() {
                    words.extend([format!("--{name}"), text.to_owned()]);
                }
            } else {
                words.push(table_of(kinds[i - 1]));
            }
            for (name, text) in self.pairs() {
                let Some(field) = kind.fields().iter().find(|field| field.name == name) else {
                    continue;
                };
                words.push(format!("--{name}"));
                words.extend((field.takes != Takes::Flag).then(|| text.to_owned()));
            }
            let last = i + 1 == kinds.len();
            if display != DisplayUnits::default() {
                words.extend(["--display-units".to_owned(), display.name().to_owned()]);
            }
            words.extend(["--out".to_owned(), if last { "out" } else { name }.to_owned()]);
            report::command_line(words)
        };
        kinds.iter().enumerate().map(command).collect()
    }
}

impl Asks<'_> {
    /// Whether its file does not say all of itself.
    fn leaves_unsaid(&self) -> bool {
        ![self.units, self.dt, self.channel].concat().is_empty()
    }
}

/// The table that a command before another writes, by its path from where both are run.
fn table_of(kind: Kind) -> String {
    format!("{0}/{0}.csv", kind.name())
}

/// The requests that a tab makes, one after the other.
fn requests(what: Kind) -> Vec<Kind> {
    match what {
        // A fragility is fitted to the analysis that it asks for.
        Kind::Fragility => vec![Kind::Ida, Kind::Fragility],
        kind => vec![kind],
    }
}

/// The form of an analysis: what it is, and its fields.
pub fn form(
    what: &str,
    text: &str,
    set: &[Override],
    display: DisplayUnits,
) -> Result<String, Failure> {
    let model = &parse(text, set)?;
    let models = Models::new(MODEL, text, set, &[], false);
    let demands = models.map_err(|error| Failure::assessment(&error, text))?.columns();
    let mut fields: Vec<&Field> = Vec::new();
    let kinds = Kind::of_name(what).map_or_else(Vec::new, requests);
    for field in kinds.into_iter().flat_map(|kind| kind.offered(FrontEnd::Page)) {
        if fields.iter().all(|known| known.name != field.name) {
            fields.push(field);
        }
    }
    let shown = each(fields, |field| {
        let (takes, words): (_, &[&str]) = match field.takes {
            Takes::One => ("one", &[]),
            Takes::Many => ("many", &[]),
            Takes::Flag => ("flag", &[]),
            Takes::Choice(words) => ("choice", words),
        };
        view! {
            name: field.name,
            formerly: field.formerly,
            label: FrontEnd::Page.calls(field.name),
            takes,
            words,
            default: field.default,
            start: field.start(model),
            about: field.about,
        }
    });
    Ok(pretty(&view! {
        about: Kind::of_name(what).map_or("", Kind::about),
        fields: shown,
        demands: runs::demands(&demands, display),
    }))
}

/// Runs something with an engine that tells the page of its progress.
fn followed<T>(work: impl FnOnce(&Engine<'_>) -> T) -> T {
    let (done, planned) = (AtomicU64::new(0), Arc::new(AtomicU64::new(0)));
    let known = planned.clone();
    let follow = move |runs: u64| {
        let all = done.fetch_add(runs, Ordering::Relaxed) + runs;
        // A message costs more than a run.
        if all.is_multiple_of(16) {
            progress(all as f64, known.load(Ordering::Relaxed) as f64);
        }
        ControlFlow::Continue(())
    };
    work(&Engine::planning(&follow, planned))
}

/// What is asked of a model and the records that are chosen.
struct Job<'a> {
    settings: Settings<'a>,
    text: &'a str,
    /// The table of modes that the model names.
    set: Vec<Override>,
    name: String,
    analysis: Analysis,
    suite: Suite,
    taken: Vec<RecordOfSuite>,
}

/// A file of the suite as it was read.
struct RecordOfSuite {
    path: String,
    /// What it was dropped as.
    file: String,
    /// Where that is not the file that was dropped.
    text: Option<String>,
    sha256: String,
    /// What was understood of it.
    description: String,
}

impl RecordOfSuite {
    fn words(&self) -> (String, Option<String>, String) {
        (self.path.clone(), self.text.clone(), self.file.clone())
    }
}

impl<'a> Job<'a> {
    fn new(records: &mut Records, text: &'a str, options: &'a [String]) -> Result<Self, Failure> {
        let (settings, set) = (Settings(options), records.modes(text)?);
        let analysis = parse(text, &set)?;
        if analysis.method != Method::Exact {
            let expected = "the exact method, which is the only one over a suite";
            let error = analysis.error_at("analysis.method", expected, "\"stepwise\"");
            return Err(Failure::input(&error, text));
        }
        let (suite, taken) = suite(records, &settings, &analysis, text)?;
        let name = analysis.name.clone().unwrap_or_else(|| UNNAMED.to_owned());
        Ok(Self { settings, text, set, name, analysis, suite, taken })
    }

    fn on(&self) -> On<'_> {
        On {
            name: &self.name,
            source: MODEL,
            text: self.text,
            set: &self.set,
            analysis: &self.analysis,
            suite: &self.suite,
        }
    }

    /// The answer; of a fragility behind the answer that it is fitted to.
    fn answer(&self, kind: Kind, engine: &Engine<'_>) -> Result<(Option<Answer>, Answer), Failure> {
        let (on, settings) = (self.on(), &self.settings);
        let failed = |error| Failure::assessment(&error, self.text);
        match kind {
            // The incremental dynamic analysis, and the curve that fits it.
            Kind::Fragility => {
                let ida = settings.asked(Kind::Ida)?.run(&on, engine).map_err(failed)?;
                let Results::Ida { limit, run, .. } = &ida.found else { return Ok((None, ida)) };
                let source = "the incremental dynamic analysis";
                let runs = Runs {
                    name: &self.name,
                    source,
                    table: &run.rows,
                    limit: *limit,
                    certified: None,
                };
                let curve = settings.asked(kind)?.fit(&runs, engine).map_err(failed)?;
                Ok((Some(ida), curve))
            }
            Kind::Suite => {
                let answer = settings.asked(kind)?.suite(&[on], None, engine).map_err(failed)?;
                Ok((None, answer))
            }
            kind => Ok((None, settings.asked(kind)?.run(&on, engine).map_err(failed)?)),
        }
    }

    /// The plan of a study of the same.
    fn plan(&self, kind: Kind) -> Result<String, Failure> {
        let names: Vec<&str> = self.settings.records().map(|asks| asks.name).collect();
        // A plan says the same of all its files.
        let all = |of: fn(Asks<'a>) -> &'a str| {
            let mut texts = self.settings.records().map(of).filter(|text| !text.is_empty());
            texts.next().filter(|first| texts.all(|text| text == *first))
        };
        let read =
            [("units", all(|a| a.units)), ("dt", all(|a| a.dt)), ("channel", all(|a| a.channel))];
        let read: Vec<(&str, &str)> =
            read.into_iter().filter_map(|(key, text)| Some((key, text?))).collect();
        let plan = self.settings.asked(kind)?.plan(&self.on(), &names, &read);
        plan.map_err(|error| Failure::assessment(&error, self.text))
    }
}

/// The plan of a study of what is asked.
pub fn plan(
    records: &mut Records,
    what: &str,
    text: &str,
    options: &[String],
) -> Result<String, Failure> {
    let kind = Kind::of_name(what).ok_or_else(|| unknown(what))?;
    let job = Job::new(records, text, options)?;
    // A plan says all its runs beforehand; it must not be another analysis than the one that the page shows.
    let follow = match requests(kind)[0] {
        Kind::Design => Some("the front is run again with the bounds of friction"),
        Kind::Ida if job.settings.pairs().all(|(name, _)| name != "scale-to") => {
            Some("the levels are hunted, record by record")
        }
        _ => None,
    };
    match follow {
        Some(why) => Err(Failure::of(format!(
            "Plan: expected an analysis whose runs are known beforehand, but {why}. Take \
             \"Everything (ZIP)\" beside a result: its command repeats it"
        ))),
        None => job.plan(requests(kind)[0]),
    }
}

fn unknown(what: &str) -> Failure {
    Failure::of(format!("expected an analysis over a suite, found {what:?}"))
}

/// An analysis over a suite.
pub fn assess(
    records: &mut Records,
    what: &str,
    text: &str,
    options: &[String],
    display: DisplayUnits,
) -> Result<Page, Failure> {
    let kind = Kind::of_name(what).ok_or_else(|| unknown(what))?;
    let job = Job::new(records, text, options)?;
    let (of, answer) = followed(|engine| job.answer(kind, engine))?;
    let sheet = answer::sheet(&answer, display);
    // The command fits a fragility to the table that the one before it wrote, and reads nothing else.
    let fitted = of.as_ref().and_then(|of| match &of.found {
        Results::Ida { run, .. } => Some(crate::sha256(to_csv(&run.rows).as_bytes())),
        _ => None,
    });
    let kind_of_runs = answer::kind_of_runs(&answer);
    let tabled: Vec<Tabled> =
        of.into_iter().chain(core::iter::once(answer)).flat_map(answer::tables).collect();
    let own = [InputText { path: MODEL, text }];
    let (model, table) = (crate::sha256(text.as_bytes()), table_of(Kind::Ida));
    let (inputs, files) = match &fitted {
        Some(sha256) => {
            (&[][..], vec![FileNote { path: &table, sha256, description: kind_of_runs }])
        }
        None => {
            let taken = job.taken.iter().map(|taken| FileNote {
                path: &taken.path,
                sha256: &taken.sha256,
                description: &taken.description,
            });
            let model = FileNote { path: MODEL, sha256: &model, description: "model" };
            (&own[..], core::iter::once(model).chain(taken).collect())
        }
    };
    let again = Again {
        commands: job.settings.commands(kind, display),
        records: job.taken.iter().map(RecordOfSuite::words).collect(),
        tables: runs::tables(&tabled, display),
    };
    Ok(Page::new(&sheet, inputs, &files, &again))
}

/// The records that were asked for, else the model's own motion; the files of either.
fn suite(
    records: &mut Records,
    settings: &Settings<'_>,
    analysis: &Analysis,
    text: &str,
) -> Result<(Suite, Vec<RecordOfSuite>), Failure> {
    let (mut read, mut taken) = (Vec::new(), Vec::new());
    let alike = settings.unsaid().is_some();
    for asks in settings.records() {
        let Asks { name, units, dt, channel } = asks;
        let options = crate::records::options(units, dt)?;
        let channel = Some(channel).filter(|channel| !channel.is_empty());
        let path = settings.path(asks);
        let mut loaded = recorded(records, name, &options, (channel, None))?;
        let mut written = None;
        if !alike && asks.leaves_unsaid() {
            let csv = as_columns(records, name, &options, &loaded.channel)?;
            let record = record::read(&path, csv.as_bytes(), &Options::default());
            let record = record.map_err(Failure::of)?;
            let wanted = Wanted { record: &record, channel: None };
            loaded =
                Loaded::recorded(wanted, None).map_err(|e| Failure::of(format!("{path}: {e}")))?;
            written = Some(csv);
        }
        let bytes = written.as_deref().map(str::as_bytes).or_else(|| records.bytes(name));
        let sha256 = bytes.map_or_else(String::new, crate::sha256);
        let description = loaded.description.first().cloned().unwrap_or_default();
        let file = name.to_owned();
        taken.push(RecordOfSuite { path: path.clone(), file, text: written, sha256, description });
        read.push((path, loaded));
    }
    let channel_asked =
        settings.unsaid().is_some_and(|said| said.iter().any(|(name, _)| *name == "channel"));
    let same =
        same_motions(read.iter().map(|(path, loaded)| (path, loaded)), channel_asked, false)?;
    let made = read.is_empty() && !matches!(analysis.motion, Some(MotionSource::Record(_)));
    if read.is_empty() {
        let one = analysis.in_one_direction("a suite of the page has");
        one.map_err(|error| Failure::input(&error, text))?;
        let loaded = records.motion(analysis, text)?;
        let files = files_of_motion(records, analysis).into_iter().zip(&loaded.description);
        taken = files
            .map(|((path, sha256), description)| {
                let (file, description) = (path.clone(), description.clone());
                RecordOfSuite { path, file, text: None, sha256, description }
            })
            .collect();
        read.push((loaded.name(analysis.motion.as_ref()), loaded));
    } else {
        // A record is called by the stem of its file, by its path where stems repeat.
        let stem = |path: &String| {
            let name = path.rsplit('/').next().unwrap_or(path);
            name.rsplit_once('.').map_or(name, |(stem, _)| stem).to_owned()
        };
        let stems: BTreeSet<String> = read.iter().map(|(path, _)| stem(path)).collect();
        if stems.len() == read.len() {
            read.iter_mut().for_each(|(path, _)| *path = stem(path));
        }
    }
    let mut suite = Suite::of(read, made);
    suite
        .notices
        .extend(same.into_iter().map(|message| Notice::new(NoticeKind::SameMotion, message)));
    Ok((suite, taken))
}

/// A sentence for each motion that stands there under two names.
fn same_motions<'a>(
    read: impl Iterator<Item = (&'a String, &'a Loaded)>,
    channel_asked: bool,
    pairs: bool,
) -> Result<Vec<String>, Failure> {
    let read: Vec<(String, &Loaded)> = read.map(|(name, loaded)| (name.clone(), loaded)).collect();
    refuse_unfit(&read, channel_asked, pairs).map_err(Failure::of)
}

/// A channel of a record as columns that say all of themselves.
fn as_columns(
    records: &mut Records,
    name: &str,
    options: &Options,
    channel: &str,
) -> Result<String, Failure> {
    let record = read(records, name, options)?;
    let channel =
        record.channel(channel).ok_or_else(|| Failure::of(format!("{name}: no channel")))?;
    record::write_csv(channel).map_err(Failure::of)
}

/// A record as it is, perhaps with a vertical motion and its factor; what files state themselves needs no
/// option.
fn recorded(
    records: &mut Records,
    name: &str,
    options: &Options,
    (channel, vertical): (Option<&str>, Option<(&str, f64)>),
) -> Result<Loaded, Failure> {
    let up = match vertical {
        Some((name, factor)) => Some((read(records, name, options)?.clone(), factor)),
        None => None,
    };
    let vertical = up.as_ref().map(|(record, factor)| (Wanted { record, channel: None }, *factor));
    let horizontal = Wanted { record: read(records, name, options)?, channel };
    let loaded = Loaded::recorded(Components { horizontal, along_y: None, vertical }, None);
    loaded.map_err(|error| Failure::of(format!("{name}: {error}")))
}

pub(crate) fn read<'a>(
    records: &'a mut Records,
    name: &str,
    options: &Options,
) -> Result<&'a slipstick::record::Record, Failure> {
    let stated = matches!(records.read(name, &Options::default()), Some(Ok(_)));
    let options = if stated { Options::default() } else { options.clone() };
    let missing = || Failure::of(format!("{name}: expected a record, dropped on the page"));
    records.read(name, &options).ok_or_else(missing)?.map_err(Failure::of)
}

/// What errors call the plan's text.
const PLAN: &str = "plan.toml";

/// Numbers of a row before its demands: whether it has an answer, and its kinds of warnings.
const AHEAD: usize = 1 + KINDS_WIDTH;

/// Numbers that hold the kinds of warnings of a row, and how many kinds each holds.
const KINDS_WIDTH: usize = NoticeKind::ALL.len().div_ceil(KINDS_EACH);
const KINDS_EACH: usize = 48;

/// Kinds of warnings as whole numbers, a binary digit a kind: a row of the page is of numbers alone.
fn kinds_to_numbers(kinds: &[NoticeKind]) -> [f64; KINDS_WIDTH] {
    let mut digits = [0_u64; KINDS_WIDTH];
    for kind in kinds {
        if let Some(place) = NoticeKind::ALL.iter().position(|one| one == kind) {
            digits[place / KINDS_EACH] |= 1 << (place % KINDS_EACH);
        }
    }
    digits.map(|digits| digits as f64)
}

/// The names of these kinds, joined by `;`.
fn kinds_of_numbers(numbers: &[f64]) -> String {
    let holds =
        |place: usize| (numbers[place / KINDS_EACH] as u64 >> (place % KINDS_EACH)) & 1 == 1;
    let kinds = NoticeKind::ALL.iter().enumerate().filter(|(place, _)| holds(*place));
    kinds.map(|(_, kind)| kind.name()).collect::<Vec<_>>().join(";")
}

/// A plan with its records, to be run in parts.
pub struct Planned {
    plan: String,
    text: String,
    names: Vec<String>,
    name: String,
    study: Study,
    /// What was noticed of the records together.
    notices: Vec<String>,
    /// Its records, as the command reads them.
    files: Vec<PlanFile>,
    /// The path of its model.
    model: String,
}

/// A record of a plan: its path beside the plan, the file on the page, its hash.
#[derive(Clone)]
struct PlanFile {
    path: String,
    file: String,
    sha256: String,
}

impl Planned {
    /// Finds the plan's records among the files.
    pub fn new(
        records: &mut Records,
        plan: &str,
        text: &str,
        names: &[String],
    ) -> Result<Self, Failure> {
        planned(records, plan, text, names)
    }

    /// Whether it is of these.
    pub fn is_of(&self, plan: &str, text: &str, names: &[String]) -> bool {
        self.plan == plan && self.text == text && self.names == names
    }

    /// Number of its runs, and of the numbers of a row.
    pub fn size(&self) -> [f64; 2] {
        [self.study.runs() as f64, self.width() as f64]
    }

    fn width(&self) -> usize {
        AHEAD + self.study.shape().columns().len()
    }

    /// Some runs, a row each: 1, or 0 where it has no answer, less the travel in m that it has used up, its kinds of
    /// warnings, and its demands.
    pub fn rows(&self, from: u64, to: u64) -> Result<Vec<f64>, Failure> {
        let runs = from..to.min(self.study.runs());
        let rows = self.study.rows(runs, &Engine::unwatched()).map_err(Failure::of)?;
        let mut numbers = Vec::with_capacity(rows.len() * self.width());
        for row in &rows {
            let used_up_m = row.travel_used_up_m().unwrap_or(0.0);
            numbers.push(if row.error.is_none() { 1.0 } else { -used_up_m });
            numbers.extend(kinds_to_numbers(&row.warnings));
            // Those by axis come after them, which no page shows.
            numbers.extend(row.demands.iter().take(self.width() - AHEAD));
        }
        Ok(numbers)
    }

    /// The runs as a table.
    fn table(&self, rows: &[f64]) -> Tabled {
        let rows: Vec<&[f64]> = rows.chunks_exact(self.width()).collect();
        let cases: Vec<Case> = (0..rows.len() as u64).map(|run| self.study.case(run)).collect();
        let record = |case: &Case| match self.study.records().get(case.record) {
            Some(record) => record.name.clone(),
            None => self.study.made_motion().to_owned(),
        };
        let level = |case: &Case| self.study.level(case.level).unwrap_or(f64::NAN);
        let mut table = Table::default();
        table.numbers("run", "", (0..rows.len()).map(|run| run as f64).collect());
        table.texts("record", cases.iter().map(record).collect());
        if self.study.has_bounds() {
            let bound = |case: &Case| self.study.bound(case).name.to_owned();
            table.texts("friction", cases.iter().map(bound).collect());
        }
        table.numbers("level", self.study.level_unit(), cases.iter().map(level).collect());
        for (i, column) in self.study.shape().columns().iter().enumerate() {
            table.numbers(
                &column.name(),
                column.unit(),
                rows.iter().map(|row| row[AHEAD + i]).collect(),
            );
        }
        Tabled { name: "runs", forms: &[], table }
    }

    /// What makes a run by itself: `{record, scale, friction, set: [[path, value]]}`, without a record where the motion is
    /// made.
    pub fn run(&self, run: u64) -> Result<String, Failure> {
        let case = self.study.case(run.min(self.study.runs().saturating_sub(1)));
        let set =
            self.study.overrides(&case).map_err(|error| Failure::input(&error, &self.text))?;
        let file = |path: &String| {
            let known = self.files.iter().find(|file| file.path == *path);
            known.map_or_else(|| path.clone(), |file| file.file.clone())
        };
        Ok(pretty(&view! {
            record: self.study.records().get(case.record).map(|record| file(&record.name)),
            scale: case.scale,
            friction: self.study.bound(&case).name,
            set: each(&set, |text| {
                let (path, value) = text.split_once('=').unwrap_or((text, ""));
                [path, value]
            }),
        }))
    }

    /// What all its rows tell.
    pub fn page(&self, rows: &[f64], display: DisplayUnits) -> Result<Page, Failure> {
        let (expected, found) = (self.study.runs() as usize * self.width(), rows.len());
        if expected != found {
            return Err(Failure::of(format!("expected {expected} numbers of rows, found {found}")));
        }
        let runs = || (0..).zip(rows.chunks_exact(self.width()));
        let solved = |take: Take<'_, bool>| {
            runs().for_each(|(run, row)| take(run, row[0] > 0.0));
            Ok::<(), slipstick::error::Stopped>(())
        };
        let demand = |column: usize, take: Take<'_, f64>| {
            runs().for_each(|(run, row)| take(run, row[AHEAD + column]));
            Ok(())
        };
        let travel_used_up = |take: Take<'_, f64>| {
            let used_up = |of_row: f64| if of_row < 0.0 { -of_row } else { f64::NAN };
            runs().for_each(|(run, row)| take(run, used_up(row[0])));
            Ok(())
        };
        let warnings = |take: &mut dyn FnMut(u64, &str)| {
            runs().for_each(|(run, row)| take(run, &kinds_of_numbers(&row[1..AHEAD])));
            Ok(())
        };
        let passes = Rows {
            solved: &solved,
            demand: &demand,
            travel_used_up: &travel_used_up,
            warnings: &warnings,
        };
        let summary = self.study.summary(&self.name, &passes, &Engine::unwatched());
        let study = StudyReport {
            study: &self.study,
            summary: &summary.map_err(Failure::of)?,
            certified: &Certified::of(self.study.runs()),
            notices: &self.notices,
            display,
        };
        let inputs = [
            InputText { path: PLAN, text: &self.plan },
            InputText { path: &self.model, text: &self.text },
        ];
        let mut words = vec!["study", PLAN, "--report"];
        if display != DisplayUnits::default() {
            words.extend(["--display-units", display.name()]);
        }
        words.extend(["--out", "out"]);
        let commands = vec![report::command_line(words.into_iter().map(str::to_owned))];
        let tables = runs::tables(&[self.table(rows)], display);
        let of = |file: &PlanFile| (file.path.clone(), None, file.file.clone());
        let again = Again { commands, records: self.files.iter().map(of).collect(), tables };
        let [plan, model] = [&self.plan, &self.text].map(|text| crate::sha256(text.as_bytes()));
        let note = |path, sha256, description| FileNote { path, sha256, description };
        let mut files = vec![note(PLAN, &plan[..], "plan"), note(&self.model, &model, "model")];
        files.extend(self.files.iter().map(|file| note(&file.path, &file.sha256, "record")));
        Ok(Page::new(&study.sheet(), &inputs, &files, &again))
    }
}

fn planned(
    records: &mut Records,
    plan_text: &str,
    text: &str,
    names: &[String],
) -> Result<Planned, Failure> {
    let in_plan = |error| Failure::input(&error, plan_text);
    let plan = Plan::parse(PLAN, plan_text).map_err(in_plan)?;
    let set = records.modes(text)?;
    // What is wrong with the model the study says, with the varied values in it.
    let analysis = parse(text, &set).ok();
    let (mut suite, mut notices, mut sources) = (Vec::new(), Vec::new(), Vec::new());
    if let Some(wanted) = &plan.records {
        let named = |key: &str, patterns: &[String]| {
            // In the folder of their pattern, in the order of their paths there.
            let of = |pattern: &String| -> Vec<(String, String)> {
                let folder = folder_of(pattern);
                let path = |name: &String| format!("{folder}{}", last_part(name));
                let all = names.iter().filter(|name| matches(pattern, name));
                let all: BTreeMap<_, _> = all.map(|name| (path(name), name.clone())).collect();
                all.into_iter().collect()
            };
            let found: Vec<Vec<(String, String)>> = patterns.iter().map(of).collect();
            let missing = patterns.iter().zip(&found).filter(|(_, all)| all.is_empty());
            let missing: Vec<String> = missing.map(|(pattern, _)| format!("{pattern:?}")).collect();
            if missing.is_empty() {
                return Ok(found.concat());
            }
            let expected = format!(
                "the plan's records, dropped on the page; {} of {} are missing",
                missing.len(),
                patterns.len()
            );
            let found = format!("no file for {}", listed(missing));
            Err(in_plan(plan.error_at(&format!("records.{key}"), expected, found)))
        };
        let files = named("files", &wanted.files)?;
        let second = named("second", &wanted.second)?;
        let vertical = named("vertical", &wanted.vertical)?;
        let count = (files.len(), "records");
        plan.one_each(("second", "other component"), second.len(), count).map_err(in_plan)?;
        plan.one_each(("vertical", "vertical motion"), vertical.len(), count).map_err(in_plan)?;
        let mut read = Vec::new();
        for (i, first) in files.iter().enumerate() {
            let factor = wanted.vertical_scale.unwrap_or(1.0);
            let up = vertical.get(i).map(|(_, up)| (up.as_str(), factor));
            for (path, name) in core::iter::once(first).chain(second.get(i)) {
                let options = Options { format: None, units: wanted.units, dt_s: wanted.dt_s };
                let channel = wanted.channel.as_deref();
                for (path, file) in
                    core::iter::once((path, name)).chain(vertical.get(i).map(|(p, n)| (p, n)))
                {
                    let sha256 = records.bytes(file).map_or_else(String::new, crate::sha256);
                    sources.push(PlanFile { path: path.clone(), file: file.clone(), sha256 });
                }
                let pair = (!second.is_empty()).then_some(i);
                read.push((path, recorded(records, name, &options, (channel, up))?, pair));
            }
        }
        let of = read.iter().map(|(name, loaded, _)| (*name, loaded));
        notices = same_motions(of, wanted.channel.is_some(), !second.is_empty())?;
        let record =
            |(name, loaded, pair): (&String, _, _)| Record::read(name.clone(), loaded, pair);
        suite = read.into_iter().map(record).collect();
    } else if let Some(analysis) = &analysis
        && let Some(MotionSource::Record(source)) = &analysis.motion
    {
        // The model's own record, scaled as the model says.
        let one = analysis.in_one_direction("a study varies");
        one.map_err(|error| Failure::input(&error, text))?;
        let loaded = records.motion(analysis, text)?;
        suite.push(Record::read(source.path.clone(), loaded, None));
        let of_motion = files_of_motion(records, analysis).into_iter();
        sources.extend(of_motion.map(|(path, sha256)| PlanFile {
            file: path.clone(),
            path,
            sha256,
        }));
    }
    // A study reads one text: that of the model with the modes that it names in it.
    let with_modes = analysis.filter(|_| !set.is_empty()).map(|of| of.to_toml_with_motion());
    let text_of_model = with_modes.as_deref().unwrap_or(text);
    let study = Study::new(&plan, MODEL, text_of_model, suite).map_err(|error| {
        let of_plan = error.place.source_name == PLAN;
        Failure::input(&error, if of_plan { plan_text } else { text_of_model })
    })?;
    const MOST_RUNS: u64 = 1_000_000;
    let runs = study.runs();
    if runs > MOST_RUNS {
        let expected = format!("at most {MOST_RUNS} runs on the page: use slipstick study");
        return Err(in_plan(plan.error_at("sampling.count", expected, runs.to_string())));
    }
    let model = plan.model.replace('\\', "/");
    Ok(Planned {
        plan: plan_text.to_owned(),
        text: text.to_owned(),
        names: names.to_vec(),
        name: plan.name.unwrap_or_else(|| "plan".to_owned()),
        study,
        notices,
        files: sources,
        model,
    })
}

/// The folder of a pattern, with its line; none where it is a pattern itself or leads out of the plan's folder.
fn folder_of(pattern: &str) -> &str {
    let folder = pattern.strip_suffix(last_part(pattern)).unwrap_or("");
    let inside = !folder.starts_with('/') && !folder.contains(['*', '?', '[', '\\', ':']);
    if inside && !folder.split('/').any(|part| part == "..") { folder } else { "" }
}

/// The name of a file without its folders.
fn last_part(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or("")
}

/// Whether a pattern of a plan names a file: `*` stands for any part of its name; folders are not looked
/// at, for files on the page have none.
fn matches(pattern: &str, name: &str) -> bool {
    let last = |path: &str| last_part(path).to_lowercase();
    let (pattern, name) = (last(pattern), last(name));
    let mut parts = pattern.split('*');
    let Some(mut rest) = name.strip_prefix(parts.next().unwrap_or("")) else { return false };
    let parts: Vec<&str> = parts.collect();
    let Some((end, middle)) = parts.split_last() else { return rest.is_empty() };
    for part in middle {
        let Some(at) = rest.find(part) else { return false };
        rest = &rest[at + part.len()..];
    }
    rest.ends_with(end)
}
