//! What a worker keeps between two calls: the files, the motion, what the solver has prepared.

use std::sync::Arc;

use slipstick::assessment::single::Job;
#[cfg(feature = "whole")]
use slipstick::assessment::single::Outcome;
use slipstick::input::loaded::Loaded;
use slipstick::input::{self, Analysis, MotionSource, Override};
use slipstick::motion::Quantity;
use slipstick::motion::processing::{Step, process};
use slipstick::response::Method;
#[cfg(feature = "whole")]
use slipstick::response::Response;
use slipstick::solver::{self, Prepared, PreparedMotion};
use slipstick_report::{DisplayUnits, Summary};
use wasm_bindgen::prelude::*;

use crate::answer::Answer;
use crate::failure::Failure;
use crate::records::Records;

/// What errors call the model's text.
pub(crate) const MODEL: &str = "model.toml";

/// What a model without a name is called: the stem of its file, as by the command.
pub(crate) const UNNAMED: &str = "model";

/// Most samples whose history the page can hold and draw.
const MOST_SAMPLES: usize = 1_000_000;

/// A ground motion ready to be used again.
pub(crate) struct Ground {
    source: Option<MotionSource>,
    tail_s: f64,
    loaded: Arc<Loaded>,
    pub with_tail: PreparedMotion,
    number: u32,
}

/// The last answer, which is judged and written when the page asks.
#[cfg(feature = "whole")]
pub(crate) struct Last {
    pub job: Job,
    pub name: String,
    pub words: String,
    /// The model's text, and the keys set in it.
    pub text: String,
    pub set: Vec<Override>,
    pub response: Response,
    pub judged: Option<(Outcome, Summary)>,
    pub display: DisplayUnits,
}

/// The state of a worker.
#[wasm_bindgen]
#[derive(Default)]
pub struct Session {
    pub(crate) records: Records,
    pub(crate) ground: Option<Ground>,
    prepared: Option<Prepared>,
    grounds: u32,
    #[cfg(feature = "whole")]
    pub(crate) last: Option<Last>,
    /// What the whole module keeps besides.
    #[cfg(feature = "whole")]
    pub(crate) more: crate::whole::More,
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
        #[cfg(feature = "whole")]
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
        let name = job.analysis.name.clone().unwrap_or_else(|| UNNAMED.to_owned());
        let words = loaded.words(&loaded.name(job.analysis.motion.as_ref()));
        let summary = Summary::of_response(&name, &job, (model, 1.0), &response, None);
        let answer = Answer::new(&job, &words, &response, &summary, display, ground.number);
        #[cfg(feature = "whole")]
        {
            // Without keys set the text is as written, its table of modes beside it.
            let set = if as_written { Vec::new() } else { set };
            let (text, judged) = (text.to_owned(), None);
            self.last = Some(Last { job, name, words, text, set, response, judged, display });
        }
        Ok(answer)
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
}

impl Session {
    /// Drops what was made of records.
    fn forget(&mut self) {
        self.ground = None;
        #[cfg(feature = "whole")]
        {
            self.more = crate::whole::More::default();
        }
    }

    pub(crate) fn load(&mut self, analysis: &Analysis, text: &str) -> Result<(), Failure> {
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

#[cfg(feature = "whole")]
pub(crate) fn parse(text: &str, set: &[Override]) -> Result<Analysis, Failure> {
    input::parse(MODEL, text, set).map_err(|error| Failure::input(&error, text))
}

pub(crate) fn display_units(name: &str) -> DisplayUnits {
    DisplayUnits::of_name(name).unwrap_or_default()
}
