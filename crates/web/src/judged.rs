//! A judged response as the page takes it, and the files that are made of it.

use slipstick::assessment::single::{Job, Judged, Outcome};
use slipstick::error::SolveError;
use slipstick::response::{Demands, Response};
use slipstick_report::display::{DisplayUnits, Quantity};
use slipstick_report::json::{Serialize, each, pretty};
use slipstick_report::number::{printed, rounded, significant, typeset};
use slipstick_report::tables::{events_csv, history_csv};
use slipstick_report::{FileNote, InputText, Report, Summary, figures, view};
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
    /// The peaks with those of the bounds, the warnings, the certificate, the fixed base, the stepwise method.
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
        let nominal = &outcome.nominal;
        let fixed = fixed.as_ref().map(|fixed| fixed_base(fixed, nominal, display));
        let stepwise = stepwise.map(|found| beside_stepwise(found, &nominal.response, display));
        let state = view! {
            rows: rows(summary, display),
            runs: each(summary.runs(), |(name, _)| name),
            warnings: warnings(summary, display),
            certificate: checks(summary, outcome),
            #[serde(flatten)] fixed: fixed.map(|fixed| view! { fixedBase: fixed }),
            #[serde(flatten)] stepwise: stepwise.map(|stepwise| view! { stepwise }),
        };
        Self {
            state: pretty(&state),
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
            "figures" => Ok(drawings(&figures::all(&report))),
            other => Err(Failure::of(format!("expected a file of a run, found {other:?}"))),
        }
    }
}

/// Figures as `[{id, caption, svg}]`.
fn drawings(figures: &[figures::Drawn]) -> String {
    pretty(&each(figures, |figure| {
        view! { id: &figure.id, caption: &figure.caption, svg: figure.svg.as_str() }
    }))
}

fn checks(summary: &Summary, outcome: &Outcome) -> impl Serialize {
    let checks = &summary.checks;
    let figures = [
        ("Equilibrium residual", checks.equilibrium_residual),
        ("Friction excess", checks.friction_excess),
        ("Energy balance error", checks.energy_balance_error),
        ("Demands error", checks.demands_error),
    ];
    view! {
        holds: checks.holds.map(|_| !summary.check_failed()),
        bound: typeset(&rounded(checks.bound, 2)),
        figures: each(figures, |(name, value)| view! { name, value: printed(value, 2) }),
        closestCall: checks.closest_call.map(|call| {
            view! {
                margin: printed(call.margin, 2),
                time_s: call.time_s,
                kind: call.decision(),
            }
        }),
        iterations: outcome.nominal.response.iterations.map(|iterations| {
            view! { mean: significant(iterations.mean, 3), max: iterations.max }
        }),
    }
}

/// The structure on a fixed base beside the sliding one.
fn fixed_base(fixed: &Demands, nominal: &Judged, display: DisplayUnits) -> impl Serialize {
    let sliding = &nominal.response.demands;
    let row = |label: &'static str, quantity, of: &dyn Fn(&Demands) -> f64| {
        let (fixed, sliding) = (of(fixed), of(sliding));
        let unit = display.unit(quantity, fixed.max(sliding));
        view! {
            label,
            unit: unit.symbol,
            fixed: significant(unit.of(fixed), 4),
            sliding: significant(unit.of(sliding), 4),
            ratio: significant(sliding / fixed, 3),
        }
    };
    let roof = |demands: &Demands| {
        demands.storeys.last().copied().unwrap_or_default().peak_acceleration_m_per_s2
    };
    let drift =
        |demands: &Demands| demands.storeys.iter().fold(0.0, |l: f64, s| l.max(s.peak_drift_m));
    [
        row("Roof acceleration", Quantity::Acceleration, &roof),
        row("Largest drift", Quantity::Length, &drift),
        row("Base shear", Quantity::Force, &|demands| demands.peak_base_shear_n),
    ]
}

/// The stepwise method beside the exact one.
fn beside_stepwise(
    stepwise: Result<Response, SolveError>,
    exact: &Response,
    display: DisplayUnits,
) -> impl Serialize {
    let (stepwise, error) = match stepwise {
        Ok(stepwise) => (Some(stepwise), None),
        Err(error) => (None, Some(view! { error: error.to_string() })),
    };
    let found = stepwise.map(|stepwise| {
        let row = |label: &'static str, of: &dyn Fn(&Demands) -> f64| {
            let (exact, stepwise) = (of(&exact.demands), of(&stepwise.demands));
            let unit = display.unit(Quantity::Length, exact.abs().max(stepwise.abs()));
            view! {
                label,
                unit: unit.symbol,
                exact: significant(unit.of(exact), 4),
                stepwise: significant(unit.of(stepwise), 4),
            }
        };
        view! {
            rows: [
                row("Peak sliding displacement", &|d| d.peak_sliding_displacement_m),
                row("Residual sliding displacement", &|d| d.residual_sliding_displacement_m),
                row("Sliding path", &|d| d.sliding_path_m),
            ],
            iterations: stepwise.iterations.map(|iterations| {
                let mean = significant(iterations.mean, 3);
                format!("{mean} iterations a step, {} at most", iterations.max)
            }),
        }
    });
    view! { #[serde(flatten)] error, #[serde(flatten)] found }
}
