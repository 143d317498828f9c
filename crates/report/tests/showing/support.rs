//! Runs to draw and to tabulate, with a certificate made up beside them: what is tested here is the
//! showing of results, not the results.

use slipstick::check::{Certificate, ClosestCall, EnergyHistory};
use slipstick::friction::{Coulomb, Friction};
use slipstick::model::{Block, Damping, Frame, InitialState, Model, Slider};
use slipstick::motion::GroundMotion;
use slipstick::response::{History, Response, Warning};
use slipstick::solver;
use slipstick_report::{
    DisplayUnits, FileNote, FloorSpectra, InputText, RecordFigures, Report, Summary, SummaryInputs,
};

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
    let coulomb = Coulomb::new([0.06; 2], [0.04; 2]).expect("coefficients of friction");
    Model::new(
        Block { mass_kg: 325.0, width_m: Some(0.53), height_m: None },
        Slider {
            friction: Friction::Coulomb(coulomb).scaled(friction_factor).expect("a factor"),
            stiffness_n_per_m: 8e3,
            damper_n_s_per_m: 0.0,
            tilt_rad: 0.0,
            gap_m: Some(0.06),
        },
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
    let history = response.history.as_ref().expect("a history");
    let certificate = Certificate {
        equilibrium_residual: 3.1e-14,
        friction_excess: 0.0,
        energy_balance_error: 1.7e-13,
        closest_call: Some(ClosestCall { margin: 2.3e-3, time_s: 12.345, kind: "stop" }),
        bound: 1e-10,
        energy: energy(&model, history),
    };
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
    warnings: &[Warning],
) -> Summary {
    let pga = motion.horizontal_m_per_s2().iter().fold(0.0, |m: f64, a| m.max(a.abs()));
    let record = RecordFigures {
        pga_m_per_s2: pga,
        pgv_m_per_s: 0.31,
        pgd_m: 0.084,
        end_velocity_m_per_s: -0.002,
    };
    Summary::new(&SummaryInputs {
        name,
        model,
        motion,
        record,
        response,
        certificate,
        friction_factor,
        warnings,
    })
}

/// Energies at the knots, those spent by the trapezoidal rule; the input is their sum.
fn energy(model: &Model, history: &History) -> EnergyHistory {
    let (m, k) = (&model.frame().masses_kg, &model.frame().stiffnesses_n_per_m);
    let mut energy = EnergyHistory::default();
    let mut spent = 0.0;
    for knot in 0..history.len() {
        let (s, w) = (history.sliding_displacement_m[knot], history.sliding_velocity_m_per_s[knot]);
        let (q, v) = (history.storey_displacements(knot), history.storey_velocities(knot));
        let mut kinetic = 0.5 * model.block().mass_kg * w * w;
        let mut strain = 0.5 * model.slider().stiffness_n_per_m * s * s;
        for i in 0..m.len() {
            let below = if i == 0 { 0.0 } else { q[i - 1] };
            kinetic += 0.5 * m[i] * (w + v[i]).powi(2);
            strain += 0.5 * k[i] * (q[i] - below).powi(2);
        }
        if knot > 0 {
            let h = history.time_s[knot] - history.time_s[knot - 1];
            let power = |i: usize| {
                (history.friction_force_n[i] * history.sliding_velocity_m_per_s[i]).abs()
            };
            spent += 0.5 * h * (power(knot - 1) + power(knot));
        }
        energy.kinetic_j.push(kinetic);
        energy.strain_j.push(strain);
        energy.damping_j.push(0.1 * spent);
        energy.friction_j.push(spent);
        energy.input_j.push(kinetic + strain + 1.1 * spent);
    }
    energy
}

/// Some smooth spectra.
pub fn floor_spectra(storeys: usize) -> FloorSpectra {
    let periods_s: Vec<f64> = (0..120).map(|i| 0.02 * 250f64.powf(f64::from(i) / 119.0)).collect();
    let spectrum = |peak_s: f64, zero: f64| -> Vec<f64> {
        let bell = |t: f64| 1.0 + 3.0 * (-2.0 * (t / peak_s).ln().powi(2)).exp();
        periods_s.iter().map(|&t| zero * bell(t) * (0.3 / t).min(1.0)).collect()
    };
    FloorSpectra {
        damping_ratio: 0.05,
        table_m_per_s2: spectrum(0.4, 3.0),
        block_m_per_s2: spectrum(0.1, 1.0),
        storeys_m_per_s2: (0..storeys)
            .map(|i| spectrum(0.2 + 0.05 * i as f64, 1.0 + i as f64))
            .collect(),
        periods_s,
    }
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
