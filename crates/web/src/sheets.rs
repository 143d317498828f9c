//! Analyses over a suite and studies, laid out as the command lays them out.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use slipstick::assessment::suite::Suite;
use slipstick::input::loaded::{Components, Loaded, Wanted};
use slipstick::input::plan::Plan;
use slipstick::input::{Analysis, MotionSource, Override};
use slipstick::notice::Notice;
use slipstick::record::Options;
use slipstick::requests::{Answer, Door, Field, Kind, On, Request, Results, Runs, Takes};
use slipstick::response::Method;
use slipstick::study::engine::Engine;
use slipstick::study::summary::{Rows, Take};
use slipstick::study::{Record, Study};
use slipstick_report::DisplayUnits;
use slipstick_report::assessment::{Sheet, Went, answer};
use slipstick_report::json::Json;
use slipstick_report::study::StudyReport;
use slipstick_report::{FileNote, InputText};
use wasm_bindgen::prelude::*;

use crate::answer::drawings;
use crate::failure::Failure;
use crate::records::Records;
use crate::session::{MODEL, parse, texts};

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
}

#[wasm_bindgen]
impl Page {
    /// What the page shows: `{kind, line, verdict, tables, notes, warnings, figures, method}`.
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
}

impl Page {
    fn new(sheet: &Sheet, inputs: &[InputText<'_>], files: &[FileNote<'_>], command: &str) -> Self {
        let table = |(heading, rows): &(String, Vec<Vec<String>>)| {
            let rows = rows.iter().map(|row| texts(row.iter().map(String::as_str)));
            Json::Object(vec![
                ("heading", heading.as_str().into()),
                ("rows", Json::List(rows.collect())),
            ])
        };
        let warning = |warning: &Notice| {
            Json::Object(vec![
                ("label", warning.label().into()),
                ("kind", Json::Text(warning.kind.words())),
                ("run", Json::Null),
                ("time_s", warning.time_s.into()),
                ("message", Json::Text(sheet.display.sentence(&warning.message))),
            ])
        };
        let list = |all: &[String]| texts(all.iter().map(String::as_str));
        let first = sheet.first.as_ref().map(|(name, sentence)| format!("{name}: {sentence}"));
        let state = Json::Object(vec![
            ("kind", sheet.kind.into()),
            ("line", sheet.line.as_str().into()),
            ("first", first.map_or(Json::Null, Json::Text)),
            ("verdict", list(&sheet.verdict)),
            ("warnings", Json::List(sheet.warnings.iter().map(warning).collect())),
            ("tables", Json::List(sheet.tables.iter().map(table).collect())),
            ("notes", list(&sheet.notes)),
            ("method", list(&sheet.method)),
            ("figures", drawings(&sheet.figures)),
        ]);
        let went = Went { command_line: command, files, inputs };
        Self { state: state.to_pretty(), html: sheet.to_html(&went), json: sheet.to_json() }
    }
}

/// A record, and what its file does not say; empty where it does.
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

    /// What was asked, as the command takes it.
    fn command(&self, what: &str) -> String {
        let option = |(name, text): (&str, &str)| {
            format!(" --{name} {:?}", text.split('\n').next().unwrap_or(""))
        };
        let what = if what == Kind::Suite.name() { Kind::Run.name() } else { what };
        let options: String = self.pairs().map(option).collect();
        format!("slipstick {what} {MODEL}{options}")
    }
}

/// The requests that a tab makes, one after the other.
fn requests(what: &str) -> Vec<Kind> {
    match Kind::of_name(what) {
        // A fragility is fitted to the analysis that it asks for.
        Some(Kind::Fragility) => vec![Kind::Ida, Kind::Fragility],
        kind => kind.into_iter().collect(),
    }
}

/// The form of an analysis: what it is, and its fields.
pub fn form(what: &str, model: &Analysis) -> Json {
    let mut fields: Vec<&Field> = Vec::new();
    for field in requests(what).into_iter().flat_map(|kind| kind.offered(Door::Page)) {
        if fields.iter().all(|known| known.name != field.name) {
            fields.push(field);
        }
    }
    let shown = |field: &&Field| {
        let (takes, words): (_, &[&str]) = match field.takes {
            Takes::One => ("one", &[]),
            Takes::Many => ("many", &[]),
            Takes::Flag => ("flag", &[]),
            Takes::Choice(words) => ("choice", words),
        };
        Json::Object(vec![
            ("name", field.name.into()),
            ("label", Json::Text(Door::Page.calls(field.name))),
            ("takes", takes.into()),
            ("words", texts(words.iter().copied())),
            ("default", field.default.into()),
            ("start", field.start(model).into()),
            ("about", field.about.into()),
        ])
    };
    Json::Object(vec![
        ("about", Kind::of_name(what).map_or("", Kind::about).into()),
        ("fields", Json::List(fields.iter().map(shown).collect())),
    ])
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
        let suite = suite(records, &settings, &analysis, text)?;
        let name = analysis.name.clone().unwrap_or_else(|| "Model".to_owned());
        Ok(Self { settings, text, set, name, analysis, suite })
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

    fn answer(&self, kind: Kind, engine: &Engine<'_>) -> Result<Answer, Failure> {
        let (on, settings) = (self.on(), &self.settings);
        let failed = |error| Failure::assessment(&error, self.text);
        match kind {
            // The incremental dynamic analysis, and the curve that fits it.
            Kind::Fragility => {
                let ida = settings.asked(Kind::Ida)?.run(&on, engine).map_err(failed)?;
                let Results::Ida { limit, run, .. } = &ida.found else { return Ok(ida) };
                let source = "the incremental dynamic analysis";
                let runs = Runs { name: &self.name, source, table: &run.rows, limit: *limit };
                settings.asked(kind)?.fit(&runs, engine).map_err(failed)
            }
            Kind::Suite => settings.asked(kind)?.suite(&[on], None, engine).map_err(failed),
            kind => settings.asked(kind)?.run(&on, engine).map_err(failed),
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
    let kind = requests(what).into_iter().next().ok_or_else(|| unknown(what))?;
    Job::new(records, text, options)?.plan(kind)
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
    let answer = followed(|engine| job.answer(kind, engine))?;
    let sheet = answer::sheet(&answer, display);
    let inputs = [InputText { path: MODEL, text }];
    let hash =
        |asks: Asks<'_>| Some((asks.name.to_owned(), crate::sha256(records.bytes(asks.name)?)));
    let hashes: Vec<(String, String)> = job.settings.records().filter_map(hash).collect();
    let files: Vec<FileNote> = hashes
        .iter()
        .map(|(path, sha256)| FileNote { path, sha256, description: "record" })
        .collect();
    Ok(Page::new(&sheet, &inputs, &files, &job.settings.command(what)))
}

/// The records that were asked for, else the model's own motion.
fn suite(
    records: &mut Records,
    settings: &Settings<'_>,
    analysis: &Analysis,
    text: &str,
) -> Result<Suite, Failure> {
    let mut read = Vec::new();
    for Asks { name, units, dt, channel } in settings.records() {
        let options = crate::records::options(units, dt)?;
        let channel = Some(channel).filter(|channel| !channel.is_empty());
        let loaded = recorded(records, name, &options, (channel, None))?;
        let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
        let stem = stem.rsplit('/').next().unwrap_or(stem);
        read.push((stem.to_owned(), loaded));
    }
    let made = read.is_empty() && !matches!(analysis.motion, Some(MotionSource::Record(_)));
    if read.is_empty() {
        let one = analysis.in_one_direction("a suite of the page has");
        one.map_err(|error| Failure::input(&error, text))?;
        let loaded = records.motion(analysis, text)?;
        read.push((loaded.description.join("; "), loaded));
    }
    Ok(Suite::of(read, made))
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

fn read<'a>(
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

/// A dropped plan with its records, to be run in parts.
pub struct Planned {
    plan: String,
    text: String,
    names: Vec<String>,
    name: String,
    study: Study,
}

impl Planned {
    /// Finds the plan's records among the files.
    pub fn new(
        records: &mut Records,
        plan: &str,
        text: &str,
        names: &[String],
    ) -> Result<Self, Failure> {
        let (name, study) = planned(records, plan, text, names)?;
        let (plan, text, names) = (plan.to_owned(), text.to_owned(), names.to_vec());
        Ok(Self { plan, text, names, name, study })
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
        1 + self.study.shape().columns().len()
    }

    /// Some runs, a row each: 1, or 0 where it has no answer, and its demands.
    pub fn rows(&self, from: u64, to: u64) -> Result<Vec<f64>, Failure> {
        let runs = from..to.min(self.study.runs());
        let rows = self.study.rows(runs, &Engine::unwatched()).map_err(Failure::of)?;
        let mut numbers = Vec::with_capacity(rows.len() * self.width());
        for row in &rows {
            numbers.push(if row.error.is_none() { 1.0 } else { 0.0 });
            // Those by axis come after them, which no page shows.
            numbers.extend(row.demands.iter().take(self.width() - 1));
        }
        Ok(numbers)
    }

    /// What all its rows tell.
    pub fn page(&self, rows: &[f64], display: DisplayUnits) -> Result<Page, Failure> {
        let (expected, found) = (self.study.runs() as usize * self.width(), rows.len());
        if expected != found {
            return Err(Failure::of(format!("expected {expected} numbers of rows, found {found}")));
        }
        let runs = || (0..).zip(rows.chunks_exact(self.width()));
        let solved = |take: Take<'_, bool>| {
            runs().for_each(|(run, row)| take(run, row[0] != 0.0));
            Ok::<(), slipstick::error::Stopped>(())
        };
        let demand = |column: usize, take: Take<'_, f64>| {
            runs().for_each(|(run, row)| take(run, row[1 + column]));
            Ok(())
        };
        // The page keeps the numbers of rows alone.
        let warnings = |_: &mut dyn FnMut(u64, &str)| Ok(());
        let passes = Rows { solved: &solved, demand: &demand, warnings: &warnings };
        let summary = self.study.summary(&self.name, &passes, &Engine::unwatched());
        let report = StudyReport {
            study: &self.study,
            summary: &summary.map_err(Failure::of)?,
            checked: 0,
            notices: &[],
            display,
        };
        let inputs = [
            InputText { path: PLAN, text: &self.plan },
            InputText { path: MODEL, text: &self.text },
        ];
        Ok(Page::new(&report.sheet(), &inputs, &[], "slipstick study plan.toml"))
    }
}

fn planned(
    records: &mut Records,
    plan_text: &str,
    text: &str,
    names: &[String],
) -> Result<(String, Study), Failure> {
    let in_plan = |error| Failure::input(&error, plan_text);
    let plan = Plan::parse(PLAN, plan_text).map_err(in_plan)?;
    let mut suite = Vec::new();
    if let Some(wanted) = &plan.records {
        let named = |key: &str, patterns: &[String]| {
            let of = |pattern: &String| {
                let mut all: Vec<String> =
                    names.iter().filter(|name| matches(pattern, name)).cloned().collect();
                all.sort();
                all
            };
            let found: Vec<Vec<String>> = patterns.iter().map(of).collect();
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
            let found = format!("no file for {}", missing.join(", "));
            Err(in_plan(plan.error_at(&format!("records.{key}"), expected, found)))
        };
        let files = named("files", &wanted.files)?;
        let second = named("second", &wanted.second)?;
        let vertical = named("vertical", &wanted.vertical)?;
        let count = (files.len(), "records");
        plan.one_each(("second", "other component"), second.len(), count).map_err(in_plan)?;
        plan.one_each(("vertical", "vertical motion"), vertical.len(), count).map_err(in_plan)?;
        for (i, first) in files.iter().enumerate() {
            let up = vertical.get(i).map(|up| (up.as_str(), wanted.vertical_scale.unwrap_or(1.0)));
            for name in core::iter::once(first).chain(second.get(i)) {
                let options = Options { format: None, units: wanted.units, dt_s: wanted.dt_s };
                let channel = wanted.channel.as_deref();
                let loaded = recorded(records, name, &options, (channel, up))?;
                suite.push(Record::read(name.clone(), loaded, (!second.is_empty()).then_some(i)));
            }
        }
    }
    let study = Study::new(&plan, MODEL, text, suite).map_err(|error| {
        let of_plan = error.place.source_name == PLAN;
        Failure::input(&error, if of_plan { plan_text } else { text })
    })?;
    const MOST_RUNS: u64 = 1_000_000;
    let runs = study.runs();
    if runs > MOST_RUNS {
        let expected = format!("at most {MOST_RUNS} runs on the page: use slipstick study");
        return Err(in_plan(plan.error_at("sampling.count", expected, runs.to_string())));
    }
    Ok((plan.name.unwrap_or_else(|| "Study".to_owned()), study))
}

/// Whether a pattern of a plan names a file: `*` stands for any part of its name; folders are not looked
/// at, for files on the page have none.
fn matches(pattern: &str, name: &str) -> bool {
    let last = |path: &str| path.rsplit(['/', '\\']).next().unwrap_or("").to_lowercase();
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
