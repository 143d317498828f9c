//! Runs to draw and to tabulate, as the command makes them.

use slipstick::assessment::floors::{FloorSpectra, PlaceSpectra};
use slipstick::check::{Certificate, check};
use slipstick::model::{Block, Damping, Frame, InitialState, Model, Slider};
use slipstick::motion::{GroundMotion, spectrum};
use slipstick::notice::Notice;
use slipstick::response::Response;
use slipstick::slider::{Ends, Friction};
use slipstick::solver;
use slipstick_report::{DisplayUnits, FileNote, InputText, Report, Summary, SummaryInputs};

/// A run with all that a report needs.
pub struct Case {
    pub model: Model,
    pub motion: GroundMotion,
    pub response: Response,
    pub certificate: Certificate,
    pub summary: Summary,
}

/// 45 kg storeys on a 325 kg block with a spring and a gap of 60 mm.
pub fn frame_model(storeys: usize, friction_factor: f64) -> Model {
    let friction = Friction::new(0.06, 0.04).expect("coefficients of friction");
    let friction = friction.scaled(friction_factor).expect("a factor");
    Model::new(
        Block { mass_kg: 325.0, width_m: Some(0.53), height_m: None },
        Slider { ends: Ends::Open { gap_m: Some(0.06) }, ..Slider::sprung(friction, 8e3) },
        Frame {
            masses_kg: vec![45.0; storeys],
            stiffnesses_n_per_m: vec![20e3; storeys],
            damping: Damping::Ratio(0.02),
            heights_m: Some(vec![0.76; storeys]),
        },
        9.80665,
        InitialState::rest(),
    )
    .expect("a model")
}

/// A record-like motion: a few sines under an envelope, peak about 3 m/s².
pub fn rough_motion(duration_s: f64, dt_s: f64) -> GroundMotion {
    let n = (duration_s / dt_s).round() as usize + 1;
    let wave = |t: f64| (6.1 * t).sin() + 0.7 * (13.7 * t + 1.0).sin() + 0.6 * (31.0 * t).sin();
    let envelope = |t: f64| (t / 4.0).min(1.0) * (-0.08 * (t - 4.0).max(0.0)).exp();
    let values = (0..n).map(|i| i as f64 * dt_s).map(|t| 1.6 * envelope(t) * wave(t));
    GroundMotion::evenly_spaced(dt_s, values.collect(), None).expect("a motion")
}

/// Runs a model on a motion and makes its summary.
pub fn run(name: &str, model: Model, motion: GroundMotion) -> Case {
    run_times(name, model, motion, 1.0)
}

/// The same, saying that the model's friction is the nominal one times a factor.
pub fn run_times(name: &str, model: Model, motion: GroundMotion, factor: f64) -> Case {
    let response = solver::exact(&model, &motion).expect("a response");
    let certificate = check(&model, &motion, &response);
    let summary = summarise(name, &model, &motion, &response, &certificate, factor, &[]);
    Case { model, motion, response, certificate, summary }
}

pub fn summarise(
    name: &str,
    model: &Model,
    motion: &GroundMotion,
    response: &Response,
    certificate: &Certificate,
    friction_factor: f64,
    warnings: &[Notice],
) -> Summary {
    Summary::new(&SummaryInputs {
        name,
        model,
        motion,
        record: motion.figures(),
        response,
        certificate: Some(certificate),
        friction_factor,
        warnings,
    })
}

/// Spectra of table, block and floors of a run.
pub fn floor_spectra(case: &Case) -> FloorSpectra {
    let periods_s: Vec<f64> = (0..120).map(|i| 0.02 * 250f64.powf(f64::from(i) / 119.0)).collect();
    let history = case.response.history.as_ref().expect("a history");
    let of = |acceleration: &[f64]| -> Vec<f64> {
        let spectrum = spectrum(&history.time_s, acceleration, &periods_s, &[0.05]);
        spectrum.expect("a spectrum").ordinates.iter().map(|o| o.sa_m_per_s2).collect()
    };
    let floor = |i| history.storey_acceleration_m_per_s2.iter().skip(i).step_by(history.storeys);
    let sa = PlaceSpectra {
        table_m_per_s2: of(&history.table_acceleration_m_per_s2),
        block_m_per_s2: of(&history.block_acceleration_m_per_s2),
        storeys_m_per_s2: (0..history.storeys)
            .map(|i| of(&floor(i).copied().collect::<Vec<f64>>()))
            .collect(),
    };
    FloorSpectra { damping_ratio: 0.05, periods_s, sa, axes: None }
}

/// The report of a case with everything that is not computed filled in.
pub fn report<'a>(case: &'a Case, summary: &'a Summary) -> Report<'a> {
    Report {
        summary,
        model: &case.model,
        motion: &case.motion,
        record: "PEER AT2, 12001 values, 0.005 s, g",
        response: &case.response,
        certificate: &case.certificate,
        bounds: None,
        floor_spectra: None,
        inputs: &[InputText {
            path: "examples/mockup.toml",
            text: "name = \"Section 6 mock-up\"\n\n[block]\nmass = \"325 kg\"\n",
        }],
        files: &[FileNote {
            path: "examples/records/taft.txt",
            sha256: "9f86d081884c7d659a2feaa0c55ad015a3bf4f1b2b0b822cd15d6c15b0f00a08",
            description: "record",
        }],
        command_line: "slipstick run examples/mockup.toml --floor-spectrum --out out",
        display: DisplayUnits::Si,
    }
}
