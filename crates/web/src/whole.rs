//! What a session does beyond one analysis: the check, files, runs over many models and records.

use slipstick::assessment::spectrum::{fixed_base, without_vertical};
use slipstick::assessment::sweep::Sweep;
use slipstick::input::{self, Analysis, MotionSource};
use slipstick::requests::{Kind, Request};
use slipstick::solver;
use slipstick_report::Summary;
use wasm_bindgen::prelude::*;

use crate::failure::Failure;
use crate::judged::{self, Judgement};
use crate::records::Records;
use crate::runs;
use crate::session::{MODEL, Session, display_units, parse};
use crate::sheets::{self, Page, Planned};

/// What stays between two calls.
#[derive(Default)]
pub(crate) struct More {
    sweep: Option<(String, Sweep)>,
    study: Option<Planned>,
}

#[wasm_bindgen]
impl Session {
    /// What is in a record, as JSON; `units` and `dt` say what the file does not, or are empty.
    ///
    /// # Errors
    /// With line and column where the bytes are no record.
    pub fn inspect(&mut self, name: &str, units: &str, dt: &str) -> Result<String, JsValue> {
        Ok(self.records.inspect(name, units, dt)?)
    }

    /// The model's text of the last answer with the keys set, comments kept.
    ///
    /// # Errors
    /// Where nothing was analysed.
    pub fn text(&self) -> Result<String, JsValue> {
        let last = self.last.as_ref().ok_or_else(|| Failure::of("nothing was analysed"))?;
        let text = input::with_keys(MODEL, &last.text, &last.set);
        Ok(text.map_err(|error| Failure::input(&error, &last.text))?)
    }

    /// Judges the last answer, with lower- and upper-bound friction, the same structure on a fixed base and, where
    /// asked for, the paper's stepwise method.
    ///
    /// # Errors
    /// Where nothing was analysed, or a bound cannot be solved.
    pub fn judge(&mut self, stepwise: bool) -> Result<Judgement, JsValue> {
        let last = self.last.as_mut().ok_or_else(|| Failure::of("nothing was analysed"))?;
        let outcome = last.job.run_on(last.response.clone(), false).map_err(Failure::of)?;
        let summary = Summary::of(&last.name, &last.job, &outcome);
        let model = &last.job.analysis.model;
        let fixed = (model.storeys() > 0).then(|| {
            let model = fixed_base(model).ok()?;
            let motion = without_vertical(&last.job.motion).ok()?;
            solver::exact_demands(&model, &motion).ok().map(|response| response.demands)
        });
        let stepwise = stepwise.then(|| solver::stepwise(model, &last.job.motion));
        let judgement = Judgement::new(&outcome, &summary, fixed.flatten(), stepwise, last.display);
        last.judged = Some((outcome, summary));
        Ok(judgement)
    }

    /// A file made of the last judged answer: `summary.json`, `history.csv`, `events.csv`,
    /// `report.html`, or `figures` as JSON `[{id, caption, svg}]`.
    ///
    /// # Errors
    /// Where nothing was judged, or no such file is written.
    pub fn file(&mut self, name: &str, text: &str, command: &str) -> Result<String, JsValue> {
        let nothing = || Failure::of("nothing was checked yet");
        let last = self.last.as_mut().ok_or_else(nothing)?;
        let (outcome, summary) = last.judged.as_ref().ok_or_else(nothing)?;
        let hashes = files_of_motion(&self.records, &last.job.analysis);
        let made = judged::JudgedRun { job: &last.job, words: &last.words, outcome, summary };
        Ok(made.file(name, text, command, &hashes, last.display)?)
    }

    /// Demands of the models of a range of values on the model's own motion: for each value it, the peak
    /// and the residual sliding displacement, the peak acceleration of block and roof, the peak base
    /// shear; NaN where a run has no answer.
    ///
    /// # Errors
    /// With the place in the text; for values that make no model.
    pub fn sweep(
        &mut self,
        text: &str,
        over: &str,
        from: usize,
        to: usize,
    ) -> Result<Vec<f64>, JsValue> {
        let key = format!("{over}\n{text}");
        if self.more.sweep.as_ref().is_none_or(|(of, _)| *of != key) {
            let set = self.records.modes(text)?;
            let analysis = parse(text, &set)?;
            let one = analysis.in_one_direction("a sweep follows");
            one.map_err(|error| Failure::input(&error, text))?;
            self.load(&analysis, text)?;
            let Some(ground) = &self.ground else { return Err(Failure::of("no motion").into()) };
            let motion = ground.with_tail.motion().clone();
            let asked = Request::new(Kind::Sweep, [("over", over.to_owned())]);
            let asked = asked.map_err(|error| Failure::choice(&error))?;
            let sweep = asked.sweep(MODEL, text, &set, motion);
            self.more.sweep =
                Some((key, sweep.map_err(|error| Failure::assessment(&error, text))?));
        }
        let Some((_, sweep)) = &mut self.more.sweep else { return Ok(Vec::new()) };
        let values: Vec<f64> = match sweep.models().grid().axes() {
            [axis] => axis.values.clone(),
            _ => Vec::new(),
        };
        let demands = sweep.demands(from..to);
        let row = |(value, demands): (&f64, &Result<_, _>)| match demands {
            Ok(demands) => judged::sweep_row(*value, demands),
            Err(_) => [*value, f64::NAN, f64::NAN, f64::NAN, f64::NAN, f64::NAN],
        };
        Ok(values.iter().skip(from).zip(&demands).flat_map(row).collect())
    }

    /// An analysis over a suite: `suite`, `spectrum`, `ida`, `fragility` or `design`. The options are fields
    /// of its request, as `[name, value, …]`; `records` names a record and may be repeated.
    ///
    /// # Errors
    /// One message, with the place in the model's text where it has one.
    pub fn assess(
        &mut self,
        what: &str,
        text: &str,
        options: Vec<String>,
        display: &str,
    ) -> Result<Page, JsValue> {
        Ok(sheets::assess(&mut self.records, what, text, &options, display_units(display))?)
    }

    /// The form of an analysis of a model: `{about, fields: [{name, label, takes, words, default, start, about}],
    /// demands: [{name, title, unit}]}`.
    ///
    /// # Errors
    /// With the place in the text where the model cannot be understood.
    pub fn form(&self, what: &str, text: &str, display: &str) -> Result<String, JsValue> {
        Ok(sheets::form(what, text, &self.records.modes(text)?, display_units(display))?)
    }

    /// What is known of a record: `{pga, pgv, measure, duration_s, notices}`, the first three with their units;
    /// `asked` is its
    /// name and what the file does not say, units, step and channel, or empty texts, as is a `measure` that is not asked for.
    ///
    /// # Errors
    /// One message where the record cannot be read, or the measure is none.
    pub fn survey(
        &mut self,
        asked: Vec<String>,
        measure: &str,
        display: &str,
    ) -> Result<String, JsValue> {
        let said = |i: usize| asked.get(i).map_or("", String::as_str);
        let options = crate::records::options(said(1), said(2))?;
        let channel = Some(said(3)).filter(|channel| !channel.is_empty());
        let display = display_units(display);
        Ok(runs::surveyed(&mut self.records, said(0), &options, channel, measure, display)?)
    }

    /// The plan of a study of what is asked, as [`Session::assess`] takes it.
    ///
    /// # Errors
    /// As [`Session::assess`].
    pub fn plan(
        &mut self,
        what: &str,
        text: &str,
        options: Vec<String>,
    ) -> Result<String, JsValue> {
        Ok(sheets::plan(&mut self.records, what, text, &options)?)
    }

    /// Prepares a study: a plan, the model that it names, and the records that its patterns match among
    /// the files. Returns the number of its runs, and of the numbers of a row.
    ///
    /// # Errors
    /// One message, with the place in plan or model where it has one.
    #[wasm_bindgen(js_name = studySize)]
    pub fn study_size(
        &mut self,
        plan: &str,
        text: &str,
        names: Vec<String>,
    ) -> Result<Vec<f64>, JsValue> {
        Ok(self.planned(plan, text, &names)?.size().to_vec())
    }

    /// Some runs of a study, a row each: 1, or 0 where it has no answer, its kinds of warnings in two numbers, and its
    /// demands in SI.
    ///
    /// # Errors
    /// As [`Session::study_size`].
    #[wasm_bindgen(js_name = studyRows)]
    pub fn study_rows(
        &mut self,
        plan: &str,
        text: &str,
        names: Vec<String>,
        from: u32,
        to: u32,
    ) -> Result<Vec<f64>, JsValue> {
        Ok(self.planned(plan, text, &names)?.rows(u64::from(from), u64::from(to))?)
    }

    /// What makes a run of a study by itself: `{record, scale, friction, set: [[path, value]]}`.
    ///
    /// # Errors
    /// As [`Session::study_size`].
    #[wasm_bindgen(js_name = studyRun)]
    pub fn study_run(
        &mut self,
        plan: &str,
        text: &str,
        names: Vec<String>,
        run: u32,
    ) -> Result<String, JsValue> {
        Ok(self.planned(plan, text, &names)?.run(u64::from(run))?)
    }

    /// What all rows of a study tell, in their order.
    ///
    /// # Errors
    /// As [`Session::study_size`]; where rows are missing.
    pub fn study(
        &mut self,
        plan: &str,
        text: &str,
        names: Vec<String>,
        rows: &[f64],
        display: &str,
    ) -> Result<Page, JsValue> {
        Ok(self.planned(plan, text, &names)?.page(rows, display_units(display))?)
    }
}

impl Session {
    fn planned(&mut self, plan: &str, text: &str, names: &[String]) -> Result<&Planned, Failure> {
        let known = self.more.study.take().filter(|study| study.is_of(plan, text, names));
        let study = match known {
            Some(study) => study,
            None => Planned::new(&mut self.records, plan, text, names)?,
        };
        Ok(self.more.study.insert(study))
    }
}

/// The files of a model's motion, in the order of its components, with their hashes.
pub(crate) fn files_of_motion(records: &Records, analysis: &Analysis) -> Vec<(String, String)> {
    let Some(MotionSource::Record(record)) = &analysis.motion else { return Vec::new() };
    let second = record.along_y.as_ref().map(|y| &y.path);
    let all = [Some(&record.path), second, record.vertical.as_ref()];
    let hash = |path: &String| Some((path.clone(), crate::sha256(records.bytes(path)?)));
    all.into_iter().flatten().filter_map(hash).collect()
}
