//! What a worker keeps between two calls: the files, the motion, what the solver has prepared.

use std::sync::Arc;

use slipstick::assessment::single::{Job, Outcome};
use slipstick::assessment::spectrum::{fixed_base, without_vertical};
use slipstick::assessment::sweep::Sweep;
use slipstick::input::loaded::Loaded;
use slipstick::input::{self, Analysis, MotionSource, Override};
use slipstick::motion::Quantity;
use slipstick::motion::processing::{Step, process};
use slipstick::requests::{Kind, Request};
use slipstick::response::{Method, Response};
use slipstick::solver::{self, Prepared, PreparedMotion};
use slipstick_report::json::Json;
use slipstick_report::{DisplayUnits, Summary};
use wasm_bindgen::prelude::*;

use crate::answer::{self, Answer, Judgement};
use crate::failure::Failure;
use crate::records::Records;
use crate::sheets::{self, Page, Planned};

/// What errors call the model's text.
pub(crate) const MODEL: &str = "model.toml";

/// Most samples whose history the page can hold and draw.
const MOST_SAMPLES: usize = 1_000_000;

/// A ground motion ready to be used again.
struct Ground {
    source: Option<MotionSource>,
    tail_s: f64,
    loaded: Arc<Loaded>,
    with_tail: PreparedMotion,
    number: u32,
}

/// The last answer, which is judged and written when the page asks.
struct Last {
    job: Job,
    name: String,
    words: String,
    /// The model's text, and the keys set in it.
    text: String,
    set: Vec<Override>,
    response: Response,
    judged: Option<(Outcome, Summary)>,
    display: DisplayUnits,
}

/// The state of a worker.
#[wasm_bindgen]
#[derive(Default)]
pub struct Session {
    records: Records,
    ground: Option<Ground>,
    prepared: Option<Prepared>,
    last: Option<Last>,
    sweep: Option<(String, Sweep)>,
    study: Option<Planned>,
    grounds: u32,
}

#[wasm_bindgen]
impl Session {
    /// A session without files.
    #[wasm_bindgen(constructor)]
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Keeps the bytes of a record under its name.
    #[wasm_bindgen(js_name = addRecord)]
    pub fn add_record(&mut self, name: &str, bytes: Vec<u8>) {
        self.records.add(name, bytes);
        self.forget();
    }

    /// Forgets a record.
    #[wasm_bindgen(js_name = removeRecord)]
    pub fn remove_record(&mut self, name: &str) {
        self.records.remove(name);
        self.forget();
    }

    /// What is in a record, as JSON; `units` and `dt` say what the file does not, or are empty.
    ///
    /// # Errors
    /// With line and column where the bytes are no record.
    pub fn inspect(&mut self, name: &str, units: &str, dt: &str) -> Result<String, JsValue> {
        Ok(self.records.inspect(name, units, dt)?.to_pretty())
    }

    /// Analyses a model with keys set, `[path, value, …]`, without judging the response.
    ///
    /// # Errors
    /// With the place in the text where the model cannot be understood, with time and cause where it
    /// cannot be solved.
    pub fn analyse(
        &mut self,
        text: &str,
        set: Vec<String>,
        display: &str,
    ) -> Result<Answer, JsValue> {
        let (mut set, modes) = (overrides(&set)?, self.records.modes(text)?);
        let as_written = set.is_empty();
        set.extend(modes);
        let analysis =
            input::parse(MODEL, text, &set).map_err(|error| Failure::input(&error, text))?;
        let display = display_units(display);
        self.load(&analysis, text)?;
        let Some(ground) = &self.ground else { return Err(Failure::of("no motion").into()) };
        let loaded = &ground.loaded;
        let job = Job::new(analysis, Loaded::clone(loaded))
            .map_err(|error| Failure::input(&error, text))?;
        let model = &job.analysis.model;
        let response = match job.analysis.method {
            Method::Exact => {
                let prepared = match self.prepared.take() {
                    Some(prepared) => prepared.with_model(model.clone()),
                    None => Prepared::new(model.clone(), ground.with_tail.dt_s()),
                };
                let response = prepared.response(&ground.with_tail);
                self.prepared = Some(prepared);
                response
            }
            Method::Stepwise => solver::stepwise(model, &job.motion),
        };
        let response = response.map_err(Failure::of)?;
        let name = job.analysis.name.clone().unwrap_or_else(|| "Model".to_owned());
        let words = loaded.description.join("; ");
        let summary = Summary::of_response(&name, &job, (model, 1.0), &response, None);
        let answer = Answer::new(&job, &words, &response, &summary, display, ground.number);
        // Without keys set the text is as written, its table of modes beside it.
        let set = if as_written { Vec::new() } else { set };
        let (text, judged) = (text.to_owned(), None);
        self.last = Some(Last { job, name, words, text, set, response, judged, display });
        Ok(answer)
    }

    /// Judges the last answer and says its model's text with the keys set, comments kept; with lower- and upper-bound friction, the same structure on a fixed base
    /// and, where asked for, the paper's stepwise method.
    ///
    /// # Errors
    /// Where nothing was analysed, or a bound cannot be solved.
    pub fn judge(&mut self, stepwise: bool) -> Result<Judgement, JsValue> {
        let last = self.last.as_mut().ok_or_else(|| Failure::of("nothing was analysed"))?;
        let outcome = last.job.run_on(last.response.clone(), false).map_err(Failure::of)?;
        let summary = Summary::of(&last.name, &last.job, &outcome);
        let text = input::with_keys(MODEL, &last.text, &last.set)
            .map_err(|error| Failure::input(&error, &last.text))?;
        let model = &last.job.analysis.model;
        let fixed = (model.storeys() > 0).then(|| {
            let model = fixed_base(model).ok()?;
            let motion = without_vertical(&last.job.motion).ok()?;
            solver::exact_demands(&model, &motion).ok().map(|response| response.demands)
        });
        let stepwise = stepwise.then(|| solver::stepwise(model, &last.job.motion));
        let judgement =
            Judgement::new(&text, &outcome, &summary, fixed.flatten(), stepwise, last.display);
        last.judged = Some((outcome, summary));
        Ok(judgement)
    }

    /// Times at which the table's displacement is known, in s.
    #[wasm_bindgen(js_name = tableTimes)]
    #[must_use]
    pub fn table_times(&self) -> Vec<f64> {
        self.ground.as_ref().map_or_else(Vec::new, |ground| ground.loaded.motion.times_s().to_vec())
    }

    /// Displacement of the table in m at these times, without the drift of its record, to be looked at.
    #[wasm_bindgen(js_name = tableDisplacement)]
    #[must_use]
    pub fn table_displacement(&self) -> Vec<f64> {
        const STEPS: [Step; 4] = [
            Step::To { quantity: Quantity::Velocity },
            Step::RemovePolynomial { degree: 2 },
            Step::To { quantity: Quantity::Displacement },
            Step::RemovePolynomial { degree: 2 },
        ];
        let Some(ground) = &self.ground else { return Vec::new() };
        let moved = process(&ground.loaded.motion.series(), &STEPS);
        moved.map_or_else(|_| Vec::new(), |series| series.values().to_vec())
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
        let paths = last.job.analysis.motion.as_ref();
        let hash = |path: &String| {
            let bytes = self.records.bytes(path)?;
            Some((path.clone(), crate::sha256(bytes)))
        };
        let hashes = match paths {
            Some(MotionSource::Record(record)) => {
                let second = record.along_y.as_ref().map(|y| &y.path);
                let all = [Some(&record.path), second, record.vertical.as_ref()];
                all.into_iter().flatten().filter_map(hash).collect()
            }
            _ => Vec::new(),
        };
        let made = answer::Made { job: &last.job, words: &last.words, outcome, summary };
        Ok(made.file(name, text, command, &hashes, last.display)?)
    }

    /// Solves the last model so many times with its history, to be timed.
    ///
    /// # Errors
    /// Where nothing was analysed, or it cannot be solved.
    pub fn histories(&self, count: u32) -> Result<(), JsValue> {
        let (Some(prepared), Some(ground)) = (&self.prepared, &self.ground) else {
            return Err(Failure::of("nothing was analysed").into());
        };
        for _ in 0..count {
            let response = prepared.response(&ground.with_tail).map_err(Failure::of)?;
            std::hint::black_box(response);
        }
        Ok(())
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
        if self.sweep.as_ref().is_none_or(|(of, _)| *of != key) {
            let analysis = parse(text, &[])?;
            let one = analysis.in_one_direction("a sweep follows");
            one.map_err(|error| Failure::input(&error, text))?;
            self.load(&analysis, text)?;
            let Some(ground) = &self.ground else { return Err(Failure::of("no motion").into()) };
            let motion = ground.with_tail.motion().clone();
            let asked = Request::new(Kind::Sweep, [("over", over.to_owned())]);
            let asked = asked.map_err(|error| Failure::choice(&error))?;
            let sweep = asked.sweep(MODEL, text, motion);
            self.sweep = Some((key, sweep.map_err(|error| Failure::assessment(&error, text))?));
        }
        let Some((_, sweep)) = &mut self.sweep else { return Ok(Vec::new()) };
        let values: Vec<f64> = match sweep.models().grid().axes() {
            [axis] => axis.values.clone(),
            _ => Vec::new(),
        };
        let demands = sweep.demands(from..to);
        let row = |(value, demands): (&f64, &Result<_, _>)| match demands {
            Ok(demands) => answer::sweep_row(*value, demands),
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

    /// The form of an analysis of a model: `{about, fields: [{name, label, takes, words, default, start, about}]}`.
    ///
    /// # Errors
    /// With the place in the text where the model cannot be understood.
    pub fn form(&self, what: &str, text: &str) -> Result<String, JsValue> {
        Ok(sheets::form(what, &parse(text, &self.records.modes(text)?)?).to_pretty())
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

    /// Some runs of a study, a row each: 1, or 0 where it has no answer, and its demands in SI.
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

    fn planned(&mut self, plan: &str, text: &str, names: &[String]) -> Result<&Planned, Failure> {
        let known = self.study.take().filter(|study| study.is_of(plan, text, names));
        let study = match known {
            Some(study) => study,
            None => Planned::new(&mut self.records, plan, text, names)?,
        };
        Ok(self.study.insert(study))
    }

    /// Drops what was made of records.
    fn forget(&mut self) {
        (self.ground, self.sweep, self.study) = (None, None, None);
    }

    fn load(&mut self, analysis: &Analysis, text: &str) -> Result<(), Failure> {
        let known = self.ground.as_ref().is_some_and(|ground| {
            ground.source == analysis.motion && ground.tail_s == analysis.tail_s
        });
        if known {
            return Ok(());
        }
        let loaded = self.records.motion(analysis, text)?;
        let samples = loaded.motion.len();
        if samples > MOST_SAMPLES {
            let expected = format!("at most {MOST_SAMPLES} samples on the page");
            let error = analysis.error_at("motion", expected, samples.to_string());
            return Err(Failure::input(&error, text));
        }
        let with_tail = match analysis.tail_s {
            0.0 => loaded.motion.clone(),
            tail_s => {
                let tailed = loaded.motion.with_tail(tail_s);
                tailed.map_err(|e| Failure::input(&analysis.motion_error(&e), text))?
            }
        };
        self.grounds += 1;
        self.ground = Some(Ground {
            source: analysis.motion.clone(),
            tail_s: analysis.tail_s,
            loaded: Arc::new(loaded),
            with_tail: PreparedMotion::new(Arc::new(with_tail)),
            number: self.grounds,
        });
        Ok(())
    }
}

/// Keys and their values, `[path, value, …]`.
fn overrides(set: &[String]) -> Result<Vec<Override>, Failure> {
    let set = set.chunks_exact(2).map(|pair| Override::text_value(&pair[0], &pair[1]));
    set.collect::<Result<_, _>>().map_err(|error| Failure::input(&error, ""))
}

pub(crate) fn parse(text: &str, set: &[Override]) -> Result<Analysis, Failure> {
    input::parse(MODEL, text, set).map_err(|error| Failure::input(&error, text))
}

fn display_units(name: &str) -> DisplayUnits {
    DisplayUnits::of_name(name).unwrap_or_default()
}

/// A list of texts.
pub(crate) fn texts<'a>(texts: impl Iterator<Item = &'a str>) -> Json {
    Json::List(texts.map(Json::from).collect())
}
