//! A judged response as the page takes it, and the files that are made of it.

use slipstick::assessment::single::{Job, Judged, Outcome};
use slipstick::error::SolveError;
use slipstick::response::{Demands, Response};
use slipstick_report::display::{DisplayUnits, Quantity};
use slipstick_report::json::Json;
use slipstick_report::number::significant;
use slipstick_report::tables::{events_csv, history_csv};
use slipstick_report::{FileNote, InputText, Report, Summary, figures};
use wasm_bindgen::prelude::*;

use crate::answer::{roof, rows, warnings};
use crate::failure::Failure;

/// What the check says, and what stands beside the response.
#[wasm_bindgen]
pub struct Judgement {
    state: String,
    energy: Vec<Vec<f64>>,
    beside: Vec<Vec<f64>>,
}

#[wasm_bindgen]
impl Judgement {
    /// The model's text, the peaks with those of the bounds, the warnings, the certificate, the fixed base, the stepwise
    /// method.
    #[must_use]
    pub fn state(&self) -> String {
        self.state.clone()
    }

    /// Energy at the knots in J: 0 input, 1 kinetic, 2 strain, 3 damping, 4 friction.
    #[must_use]
    pub fn energy(&mut self, number: usize) -> Vec<f64> {
        self.energy.get_mut(number).map(std::mem::take).unwrap_or_default()
    }

    /// Responses beside the nominal one, two lists each, times in s and sliding displacement in m: lower
    /// friction, upper friction, stepwise; empty where there is none.
    #[must_use]
    pub fn beside(&mut self, number: usize) -> Vec<f64> {
        self.beside.get_mut(number).map(std::mem::take).unwrap_or_default()
    }
}

impl Judgement {
    /// Gathers it.
    pub fn new(
        text: &str,
        outcome: &Outcome,
        summary: &Summary,
        fixed: Option<Demands>,
        stepwise: Option<Result<Response, SolveError>>,
        display: DisplayUnits,
    ) -> Self {
        let of = |response: &Response| {
            let history = response.history.as_ref();
            history.map_or_else(Default::default, |history| {
                [history.time_s.clone(), history.sliding_displacement_m.clone()]
            })
        };
        let none = || [Vec::new(), Vec::new()];
        let (lower, upper) = match &outcome.bounds {
            Some([lower, upper]) => (of(&lower.response), of(&upper.response)),
            None => (none(), none()),
        };
        let solved = stepwise.as_ref().and_then(|response| response.as_ref().ok());
        let third = solved.map_or_else(none, of);
        let certificate = &outcome.nominal.certificate;
        let energy = certificate.energy();
        let mut keys = vec![
            ("text", text.into()),
            ("rows", rows(summary, display)),
            ("runs", crate::session::texts(summary.runs().iter().map(|(name, _)| *name))),
            ("warnings", warnings(summary, display)),
            ("certificate", checks(summary, outcome)),
        ];
        if let Some(fixed) = fixed {
            keys.push(("fixedBase", fixed_base(&fixed, &outcome.nominal, display)));
        }
        if let Some(stepwise) = &stepwise {
            keys.push(("stepwise", beside_stepwise(stepwise, &outcome.nominal.response, display)));
        }
        Self {
            state: Json::Object(keys).to_pretty(),
            energy: vec![
                energy.input_j.clone(),
                energy.kinetic_j.clone(),
                energy.strain_j.clone(),
                energy.damping_j.clone(),
                energy.friction_j.clone(),
            ],
            beside: [lower, upper, third].into_iter().flatten().collect(),
        }
    }
}

/// A row of a sweep.
pub fn sweep_row(value: f64, demands: &Demands) -> [f64; 6] {
    let block = demands.peak_block_acceleration_m_per_s2;
    let roof = roof(demands).map_or(block, |roof| roof.peak_acceleration_m_per_s2);
    [
        value,
        demands.peak_sliding_displacement_m,
        demands.residual_sliding_displacement_m,
        block,
        roof,
        demands.peak_base_shear_n,
    ]
}

/// A judged response, from which files are made.
pub struct JudgedRun<'a> {
    /// Model and motion.
    pub job: &'a Job,
    /// What was understood of the records.
    pub words: &'a str,
    /// The responses.
    pub outcome: &'a Outcome,
    /// Their figures.
    pub summary: &'a Summary,
}

impl JudgedRun<'_> {
    /// The file of a name.
    pub fn file(
        &self,
        name: &str,
        text: &str,
        command: &str,
        hashes: &[(String, String)],
        display: DisplayUnits,
    ) -> Result<String, Failure> {
        let nominal = &self.outcome.nominal;
        let written = |bytes: Vec<u8>| String::from_utf8_lossy(&bytes).into_owned();
        let mut bytes = Vec::new();
        match name {
            "summary.json" => return Ok(self.summary.to_json()),
            "history.csv" => {
                history_csv(&nominal.response, &mut bytes).map_err(Failure::of)?;
                return Ok(written(bytes));
            }
            "events.csv" => {
                events_csv(&nominal.response, &mut bytes).map_err(Failure::of)?;
                return Ok(written(bytes));
            }
            _ => {}
        }
        let sha256 = crate::sha256(text.as_bytes());
        let path = crate::session::MODEL;
        let mut files = vec![FileNote { path, sha256: &sha256, description: "model" }];
        // A description for each file of the motion, in their order.
        for ((path, sha256), description) in hashes.iter().zip(&self.job.loaded.description) {
            files.push(FileNote { path, sha256, description });
        }
        let inputs = [InputText { path, text }];
        let bounds = self.outcome.bounds.as_ref();
        let report = Report {
            summary: self.summary,
            model: &self.job.analysis.model,
            motion: &self.job.motion,
            record: self.words,
            response: &nominal.response,
            certificate: &nominal.certificate,
            bounds: bounds.map(|[lower, upper]| [&lower.response, &upper.response]),
            floor_spectra: None,
            inputs: &inputs,
            files: &files,
            command_line: command,
            display,
        };
        match name {
            "report.html" => Ok(report.to_html()),
            "figures" => Ok(drawings(&figures::all(&report)).to_pretty()),
            other => Err(Failure::of(format!("expected a file of a run, found {other:?}"))),
        }
    }
}

/// Figures as `[{id, caption, svg}]`.
pub fn drawings(figures: &[figures::Drawn]) -> Json {
    let one = |figure: &figures::Drawn| {
        Json::Object(vec![
            ("id", figure.id.as_str().into()),
            ("caption", figure.caption.as_str().into()),
            ("svg", figure.svg.as_str().into()),
        ])
    };
    Json::List(figures.iter().map(one).collect())
}

fn checks(summary: &Summary, outcome: &Outcome) -> Json {
    let checks = &summary.checks;
    let figure = |name: &'static str, value: f64| {
        Json::Object(vec![("name", name.into()), ("value", Json::Text(significant(value, 2)))])
    };
    let holds = checks.holds.map(|_| !summary.check_failed());
    let call = checks.closest_call.map_or(Json::Null, |call| {
        Json::Object(vec![
            ("margin", Json::Text(significant(call.margin, 2))),
            ("time_s", call.time_s.into()),
            ("kind", Json::Text(call.decision())),
        ])
    });
    let iterations = outcome.nominal.response.iterations.map_or(Json::Null, |iterations| {
        Json::Object(vec![
            ("mean", Json::Text(significant(iterations.mean, 3))),
            ("max", Json::Count(u64::from(iterations.max))),
        ])
    });
    Json::Object(vec![
        ("holds", holds.map_or(Json::Null, Json::Bool)),
        ("bound", Json::Text(significant(checks.bound, 2))),
        (
            "figures",
            Json::List(vec![
                figure("Equilibrium residual", checks.equilibrium_residual),
                figure("Friction excess", checks.friction_excess),
                figure("Energy balance error", checks.energy_balance_error),
                figure("Demands error", checks.demands_error),
            ]),
        ),
        ("closestCall", call),
        ("iterations", iterations),
    ])
}

/// The structure on a fixed base beside the sliding one.
fn fixed_base(fixed: &Demands, nominal: &Judged, display: DisplayUnits) -> Json {
    let sliding = &nominal.response.demands;
    let row = |label: &'static str, quantity, fixed: f64, sliding: f64| {
        let unit = display.unit(quantity, fixed.max(sliding));
        Json::Object(vec![
            ("label", label.into()),
            ("unit", unit.symbol.into()),
            ("fixed", Json::Text(significant(unit.of(fixed), 4))),
            ("sliding", Json::Text(significant(unit.of(sliding), 4))),
            ("ratio", Json::Text(significant(sliding / fixed, 3))),
        ])
    };
    let roof = |demands: &Demands| demands.storeys.last().copied().unwrap_or_default();
    let drift =
        |demands: &Demands| demands.storeys.iter().fold(0.0, |l: f64, s| l.max(s.peak_drift_m));
    Json::List(vec![
        row(
            "Roof acceleration",
            Quantity::Acceleration,
            roof(fixed).peak_acceleration_m_per_s2,
            roof(sliding).peak_acceleration_m_per_s2,
        ),
        row("Largest drift", Quantity::Length, drift(fixed), drift(sliding)),
        row("Base shear", Quantity::Force, fixed.peak_base_shear_n, sliding.peak_base_shear_n),
    ])
}

/// The stepwise method beside the exact one.
fn beside_stepwise(
    stepwise: &Result<Response, SolveError>,
    exact: &Response,
    display: DisplayUnits,
) -> Json {
    let stepwise = match stepwise {
        Ok(stepwise) => stepwise,
        Err(error) => return Json::Object(vec![("error", Json::Text(error.to_string()))]),
    };
    let row = |label: &'static str, exact: f64, stepwise: f64| {
        let unit = display.unit(Quantity::Length, exact.abs().max(stepwise.abs()));
        Json::Object(vec![
            ("label", label.into()),
            ("unit", unit.symbol.into()),
            ("exact", Json::Text(significant(unit.of(exact), 4))),
            ("stepwise", Json::Text(significant(unit.of(stepwise), 4))),
        ])
    };
    let (a, b) = (&exact.demands, &stepwise.demands);
    let iterations = stepwise.iterations.map_or(Json::Null, |iterations| {
        let words = format!(
            "{} iterations a step, {} at most",
            significant(iterations.mean, 3),
            iterations.max
        );
        Json::Text(words)
    });
    Json::Object(vec![
        (
            "rows",
            Json::List(vec![
                row(
                    "Peak sliding displacement",
                    a.peak_sliding_displacement_m,
                    b.peak_sliding_displacement_m,
                ),
                row(
                    "Residual sliding displacement",
                    a.residual_sliding_displacement_m,
                    b.residual_sliding_displacement_m,
                ),
                row("Sliding path", a.sliding_path_m, b.sliding_path_m),
            ]),
        ),
        ("iterations", iterations),
    ])
}
