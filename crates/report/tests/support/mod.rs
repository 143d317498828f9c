//! Responses for looking at: a plain explicit integrator, good to a per cent or so, that stores
//! knots as the solver does. What is tested here is the drawing, not the answer.

use slipstick::check::{Certificate, ClosestCall, EnergyHistory};
use slipstick::friction::{Coulomb, Direction, Friction};
use slipstick::model::{Block, Damping, Frame, InitialState, Model, Slider};
use slipstick::motion::GroundMotion;
use slipstick::response::{
    Demands, Event, EventKind, History, Method, Mode, Response, StoreyDemands,
};
use slipstick_report::{RecordFigures, Summary, SummaryInputs};

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
    let friction =
        Friction::Coulomb(Coulomb::new([0.06; 2], [0.04; 2]).expect("coefficients of friction"))
            .scaled(friction_factor)
            .expect("a factor");
    Model::new(
        Block { mass_kg: 325.0, width_m: Some(0.53), height_m: None },
        Slider {
            friction,
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
    let values = (0..n).map(|i| {
        let t = i as f64 * dt_s;
        let envelope = (t / 4.0).min(1.0) * (-0.08 * (t - 4.0).max(0.0)).exp();
        let wave = (6.1 * t).sin() + 0.7 * (13.7 * t + 1.0).sin() + 0.6 * (31.0 * t + 2.0).sin();
        1.6 * envelope * wave
    });
    GroundMotion::evenly_spaced(dt_s, values.collect(), None).expect("a motion")
}

/// Runs a model on a motion and makes its summary.
pub fn run(name: &str, model: Model, motion: GroundMotion, friction_factor: f64) -> Case {
    let (history, events, energy) = integrate(&model, &motion);
    let demands = demands(&model, &history, &events);
    let response = Response {
        method: Method::Exact,
        demands,
        events,
        history: Some(history),
        contact_loss_s: Vec::new(),
        iterations: None,
        warnings: Vec::new(),
    };
    let certificate = Certificate {
        equilibrium_residual: 3.1e-14,
        friction_excess: 0.0,
        energy_balance_error: 1.7e-13,
        closest_call: Some(ClosestCall { margin: 2.3e-3, time_s: 12.345, kind: "stop" }),
        bound: 1e-10,
        energy,
    };
    let summary = summary(name, &model, &motion, &response, &certificate, friction_factor);
    Case { model, motion, response, certificate, summary }
}

pub fn summary(
    name: &str,
    model: &Model,
    motion: &GroundMotion,
    response: &Response,
    certificate: &Certificate,
    friction_factor: f64,
) -> Summary {
    let pga = peak(motion.horizontal_m_per_s2().iter().copied());
    Summary::new(&SummaryInputs {
        name,
        model,
        motion,
        record: RecordFigures {
            pga_m_per_s2: pga,
            pgv_m_per_s: 0.31,
            pgd_m: 0.084,
            end_velocity_m_per_s: -0.002,
        },
        response,
        certificate,
        friction_factor,
        warnings: &[],
    })
}

fn peak(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |largest: f64, value| largest.max(value.abs()))
}

struct State {
    s: f64,
    w: f64,
    q: Vec<f64>,
    v: Vec<f64>,
    mode: Mode,
}

struct Forces {
    friction: f64,
    block: f64,
    floors: Vec<f64>,
}

/// Dampers of 2 % by stiffness stand in for the modal ones.
const BETA: f64 = 2e-3;

/// Force that each storey pulls the floor above with, then that of the slider's spring.
fn storey_forces(model: &Model, state: &State) -> Vec<f64> {
    let k = &model.frame().stiffnesses_n_per_m;
    (0..k.len())
        .map(|i| {
            let (below, below_v) =
                if i == 0 { (0.0, 0.0) } else { (state.q[i - 1], state.v[i - 1]) };
            k[i] * (state.q[i] - below) + BETA * k[i] * (state.v[i] - below_v)
        })
        .collect()
}

fn forces(model: &Model, state: &State, table: f64) -> Forces {
    let m = &model.frame().masses_kg;
    let shear = storey_forces(model, state);
    let floors: Vec<f64> = (0..m.len())
        .map(|i| (shear.get(i + 1).copied().unwrap_or(0.0) - shear[i]) / m[i])
        .collect();
    let m1 = model.block().mass_kg;
    let base = shear.first().copied().unwrap_or(0.0);
    let spring = model.slider().stiffness_n_per_m * state.s;
    let (friction, block) = match state.mode {
        Mode::Stick => (m1 * table + spring - base, table),
        Mode::Slip(direction) => {
            let mu = model.slider().friction.kinetic_coefficient(direction);
            let friction = -direction.sign() * mu * model.weight_n();
            (friction, (friction - spring + base) / m1)
        }
    };
    Forces { friction, block, floors }
}

fn integrate(model: &Model, motion: &GroundMotion) -> (History, Vec<Event>, EnergyHistory) {
    const STEPS: usize = 20;
    let n = model.storeys();
    let dt_s = motion.dt_s().expect("an even motion");
    let a = motion.horizontal_m_per_s2();
    let mut state = State { s: 0.0, w: 0.0, q: vec![0.0; n], v: vec![0.0; n], mode: Mode::Stick };
    let mut history = History { storeys: n, ..History::default() };
    let mut events = Vec::new();
    let mut energy = EnergyHistory::default();
    let (mut damping, mut friction_loss) = (0.0, 0.0);
    let h = dt_s / STEPS as f64;
    for i in 0..a.len() {
        let t = i as f64 * dt_s;
        history.rows.push(history.len());
        store(model, &mut history, &mut energy, &state, t, a[i], damping, friction_loss);
        if i + 1 == a.len() {
            break;
        }
        for step in 0..STEPS {
            let part = step as f64 / STEPS as f64;
            let (now, table) = (t + part * dt_s, a[i] + part * (a[i + 1] - a[i]));
            let f = forces(model, &state, table);
            let before = state.mode;
            let old_w = state.w;
            state.w += if before == Mode::Stick { 0.0 } else { h * (f.block - table) };
            let demand =
                forces(model, &State { mode: Mode::Stick, ..copy(&state) }, table).friction;
            let bound = model.static_friction()[0] * model.weight_n();
            match before {
                Mode::Stick if demand.abs() > bound => {
                    state.mode = Mode::Slip(if demand > 0.0 {
                        Direction::Negative
                    } else {
                        Direction::Positive
                    });
                }
                Mode::Slip(_) if state.w * old_w < 0.0 => {
                    state.mode = if demand.abs() <= bound {
                        state.w = 0.0;
                        Mode::Stick
                    } else if demand > 0.0 {
                        Mode::Slip(Direction::Negative)
                    } else {
                        Mode::Slip(Direction::Positive)
                    };
                }
                _ => {}
            }
            if state.mode != before {
                let after = state.mode;
                state.mode = before;
                store(model, &mut history, &mut energy, &state, now, table, damping, friction_loss);
                state.mode = after;
                store(model, &mut history, &mut energy, &state, now, table, damping, friction_loss);
                events.push(Event {
                    time_s: now,
                    kind: match (before, after) {
                        (Mode::Stick, _) => EventKind::Slip,
                        (_, Mode::Stick) => EventKind::Stick,
                        _ => EventKind::Reversal,
                    },
                    mode: after,
                    sliding_displacement_m: state.s,
                });
            }
            let f = forces(model, &state, table);
            state.s += h * state.w;
            friction_loss +=
                h * (f.friction * state.w).abs() * f64::from(state.mode != Mode::Stick);
            for j in 0..n {
                let below = if j == 0 { 0.0 } else { state.v[j - 1] };
                let rate = state.v[j] - below;
                damping += h * BETA * model.frame().stiffnesses_n_per_m[j] * rate * rate;
            }
            for j in 0..n {
                state.v[j] += h * (f.floors[j] - f.block);
                state.q[j] += h * state.v[j];
            }
        }
    }
    (history, events, energy)
}

fn copy(state: &State) -> State {
    State { s: state.s, w: state.w, q: state.q.clone(), v: state.v.clone(), mode: state.mode }
}

#[allow(clippy::too_many_arguments)]
fn store(
    model: &Model,
    history: &mut History,
    energy: &mut EnergyHistory,
    state: &State,
    time_s: f64,
    table: f64,
    damping: f64,
    friction_loss: f64,
) {
    let f = forces(model, state, table);
    history.time_s.push(time_s);
    history.mode.push(state.mode);
    history.table_acceleration_m_per_s2.push(table);
    history.sliding_displacement_m.push(state.s);
    history.sliding_velocity_m_per_s.push(state.w);
    history.block_acceleration_m_per_s2.push(f.block);
    history.friction_force_n.push(f.friction);
    history.storey_displacement_m.extend(&state.q);
    history.storey_velocity_m_per_s.extend(&state.v);
    history.storey_acceleration_m_per_s2.extend(&f.floors);
    let (m, k) = (&model.frame().masses_kg, &model.frame().stiffnesses_n_per_m);
    let mut kinetic = 0.5 * model.block().mass_kg * state.w * state.w;
    let mut strain = 0.5 * model.slider().stiffness_n_per_m * state.s * state.s;
    for j in 0..m.len() {
        kinetic += 0.5 * m[j] * (state.w + state.v[j]).powi(2);
        let below = if j == 0 { 0.0 } else { state.q[j - 1] };
        strain += 0.5 * k[j] * (state.q[j] - below).powi(2);
    }
    energy.kinetic_j.push(kinetic);
    energy.strain_j.push(strain);
    energy.damping_j.push(damping);
    energy.friction_j.push(friction_loss);
    energy.input_j.push(kinetic + strain + damping + friction_loss);
}

fn demands(model: &Model, history: &History, events: &[Event]) -> Demands {
    let s = &history.sliding_displacement_m;
    let count = |kind| events.iter().filter(|event| event.kind == kind).count() as u64;
    let peak_s = peak(s.iter().copied());
    let at = s.iter().position(|value| value.abs() == peak_s).unwrap_or(0);
    let sliding: f64 = history
        .time_s
        .windows(2)
        .zip(&history.mode)
        .filter(|(_, mode)| **mode != Mode::Stick)
        .map(|(t, _)| t[1] - t[0])
        .sum();
    let knots = 0..history.len();
    let storeys = (0..history.storeys)
        .map(|i| {
            let drift = peak(knots.clone().map(|knot| {
                let q = history.storey_displacements(knot);
                if i == 0 { q[0] } else { q[i] - q[i - 1] }
            }));
            StoreyDemands {
                // Between knots the motion goes a little higher.
                peak_acceleration_m_per_s2: 1.001
                    * peak(knots.clone().map(|knot| history.storey_accelerations(knot)[i])),
                peak_displacement_m: peak(
                    knots.clone().map(|knot| history.storey_displacements(knot)[i]),
                ),
                peak_drift_m: 1.002 * drift,
                peak_drift_ratio: model.frame().heights_m.as_ref().map(|h| 1.002 * drift / h[i]),
            }
        })
        .collect();
    let slider_force = peak(
        history
            .friction_force_n
            .iter()
            .zip(s)
            .map(|(t, s)| t - model.slider().stiffness_n_per_m * s),
    );
    let friction = peak(history.friction_force_n.iter().copied());
    Demands {
        peak_sliding_displacement_m: peak_s,
        peak_sliding_displacement_time_s: history.time_s[at],
        max_sliding_displacement_m: s.iter().copied().fold(0.0, f64::max),
        min_sliding_displacement_m: s.iter().copied().fold(0.0, f64::min),
        residual_sliding_displacement_m: s[s.len() - 1],
        sliding_at_end: history.mode[s.len() - 1] != Mode::Stick,
        sliding_path_m: s.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum(),
        peak_sliding_velocity_m_per_s: peak(history.sliding_velocity_m_per_s.iter().copied()),
        sliding_time_s: sliding,
        slip_count: count(EventKind::Slip),
        reversal_count: count(EventKind::Reversal),
        stick_count: count(EventKind::Stick),
        peak_block_acceleration_m_per_s2: 1.0005
            * peak(history.block_acceleration_m_per_s2.iter().copied()),
        storeys,
        peak_base_shear_n: 512.0,
        peak_friction_force_n: friction,
        peak_slider_force_n: slider_force,
        base_shear_coefficient: 512.0 / model.weight_n(),
        friction_coefficient_used: friction / model.weight_n(),
        slider_force_coefficient: slider_force / model.weight_n(),
        gap_ratio: model.slider().gap_m.map(|gap| peak_s / gap),
        overturning_ratio: model.block().width_m.map(|_| 0.41),
    }
}
