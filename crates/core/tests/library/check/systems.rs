//! Systems, and what is done with their histories.

use slipstick::check::{Certificate, check};
use slipstick::model::{Block, Contents, Damping, Frame, InitialState, Model, Slider, Stop};
use slipstick::motion::GroundMotion;
use slipstick::response::{Demands, History, Method, Mode, Response};
use slipstick::slider::{Friction, RateCurve, RateLaw, Surface, SurfacesInSeries};
use slipstick::solver;
use slipstick::units::STANDARD_GRAVITY_M_PER_S2 as G;

pub fn coulomb(fixed: [f64; 2], kinetic: [f64; 2]) -> Friction {
    Friction::by_direction(fixed, kinetic).unwrap()
}

pub fn block(mass_kg: f64) -> Block {
    Block { mass_kg, width_m: None, height_m: None }
}

pub fn slider(friction: Friction) -> Slider {
    Slider::new(friction)
}

pub fn frame(masses_kg: &[f64], stiffnesses_n_per_m: &[f64], damping: Damping) -> Frame {
    Frame {
        masses_kg: masses_kg.to_vec(),
        stiffnesses_n_per_m: stiffnesses_n_per_m.to_vec(),
        damping,
        heights_m: None,
    }
}

/// The same model with another slider or frame.
pub fn with(model: &Model, change: impl FnOnce(&mut Slider, &mut Frame)) -> Model {
    let (mut slider, mut frame) = (model.slider().clone(), model.frame().clone());
    change(&mut slider, &mut frame);
    let g = model.gravity_m_per_s2();
    let with = Model::new(*model.block(), slider, frame, g, model.initial().clone());
    with.and_then(|with| with.with_contents(model.contents().to_vec())).unwrap()
}

/// A shaking that wanders between several frequencies, with or without a vertical companion.
pub fn shaking(peak: f64, vertical: Option<f64>) -> GroundMotion {
    let wave = |t: f64, shift: f64| {
        let sum = libm::sin(6.3 * t + shift) + 0.7 * libm::sin(17.1 * t + 2.0 * shift)
            - 0.4 * libm::sin(41.0 * t);
        0.5 * sum * (t / 2.0).min(1.0) * (4.0 - 0.5 * t).min(1.0)
    };
    let dt_s = 0.01;
    let values = |peak: f64, shift: f64| -> Vec<f64> {
        (0..=800).map(|i| peak * wave(f64::from(i) * dt_s, shift)).collect()
    };
    let up = vertical.map(|peak| values(peak, 1.0));
    GroundMotion::evenly_spaced(dt_s, values(peak, 0.0), up).unwrap()
}

#[derive(Clone)]
pub struct System {
    pub name: &'static str,
    pub model: Model,
    pub motion: GroundMotion,
}

/// Rigid, one and three storeys; springs, dampers, tilt, vertical motion, unequal friction.
pub fn systems() -> Vec<System> {
    let model = |block_kg, slider: Slider, frame| {
        Model::new(block(block_kg), slider, frame, G, InitialState::rest()).unwrap()
    };
    let k1 = 45.0 * (2.0 * core::f64::consts::PI * 1.625) * (2.0 * core::f64::consts::PI * 1.625);
    vec![
        System {
            name: "rigid",
            model: model(124.0, slider(coulomb([0.1; 2], [0.08; 2])), Frame::none()),
            motion: shaking(3.0, None),
        },
        System {
            name: "rigid on spring and damper",
            model: model(
                248.0,
                Slider {
                    damper_n_s_per_m: 400.0,
                    ..Slider::sprung(coulomb([0.158; 2], [0.136; 2]), 143e3)
                },
                Frame::none(),
            ),
            motion: shaking(4.0, None),
        },
        System {
            name: "mock-up",
            model: model(
                325.0,
                slider(coulomb([0.02; 2], [0.012; 2])),
                frame(&[45.0], &[k1], Damping::Ratio(0.01)),
            ),
            motion: shaking(1.0, None),
        },
        System {
            name: "mock-up, tilted, vertical, unequal friction",
            model: model(
                325.0,
                Slider {
                    tilt_rad: 0.004,
                    ..Slider::sprung(coulomb([0.05, 0.06], [0.05, 0.03]), 8e3)
                },
                frame(&[90.0], &[1.09e4], Damping::Dampers(vec![30.0])),
            ),
            motion: shaking(2.0, Some(3.0)),
        },
        System {
            name: "contact lost now and then",
            model: model(
                325.0,
                slider(coulomb([0.3; 2], [0.25; 2])),
                frame(&[90.0], &[1.09e4], Damping::Ratio(0.03)),
            ),
            motion: shaking(4.0, Some(14.0)),
        },
        System {
            name: "three storeys",
            model: model(
                800.0,
                Slider::sprung(coulomb([0.06; 2], [0.05; 2]), 2e4),
                frame(&[500.0, 400.0, 300.0], &[6e5, 5e5, 3e5], Damping::Ratio(0.02)),
            ),
            motion: shaking(2.5, None),
        },
    ]
}

pub fn response_of(system: &System) -> Response {
    solver::exact(&system.model, &system.motion).unwrap()
}

pub fn history_of(system: &System) -> History {
    response_of(system).history.unwrap()
}

/// Judges a history; of a response that is all of it but the demands.
pub fn judge(system: &System, history: &History) -> Certificate {
    let response = Response {
        method: Method::Exact,
        demands: Demands::default(),
        events: Vec::new(),
        history: Some(history.clone()),
        contact_loss_s: Vec::new(),
        iterations: None,
        warnings: Vec::new(),
        in_plane: None,
    };
    check(&system.model, &system.motion, &response)
}

/// Whether the figures of a history are within the bound.
pub fn holds(c: &Certificate) -> bool {
    worst(c) <= c.bound
}

/// The worst of the figures that judge the history.
pub fn worst(c: &Certificate) -> f64 {
    c.equilibrium_residual.max(c.friction_excess).max(c.energy_balance_error)
}

/// Indices of the knots just before a change of the slider from one kind of mode to another.
pub fn changes(h: &History, pick: impl Fn(Mode, Mode) -> bool) -> Vec<usize> {
    let after = |k: &usize| {
        h.time_s[*k] == h.time_s[k + 1] && pick(slider_mode(h, *k), slider_mode(h, k + 1))
    };
    (0..h.len() - 1).filter(after).collect()
}

/// The slider's mode at a knot.
pub fn slider_mode(h: &History, knot: usize) -> Mode {
    h.modes(knot)[0]
}

/// The first knot from one on at which the slider has another mode than there, or their number.
pub fn end_of_mode(h: &History, from: usize) -> usize {
    let mode = slider_mode(h, from);
    (from..h.len()).find(|&k| slider_mode(h, k) != mode).unwrap_or(h.len())
}

/// Gives the slider one mode at some knots.
pub fn set_slider_mode(h: &mut History, knots: core::ops::Range<usize>, mode: Mode) {
    for k in knots {
        h.mode[k * h.interfaces] = mode;
    }
}

pub fn slips(mode: Mode) -> bool {
    mode != Mode::Stick
}

/// Largest |value|.
pub fn peak(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |p, v| v.abs().max(p))
}

/// One storey on a slider with each device, and with some together.
pub fn device_systems() -> Vec<System> {
    let coarse = |motion: &GroundMotion| {
        let every = |list: &[f64]| list.iter().step_by(2).take(250).copied().collect::<Vec<f64>>();
        let vertical = motion.vertical_m_per_s2().map(every);
        GroundMotion::evenly_spaced(0.02, every(motion.horizontal_m_per_s2()), vertical).unwrap()
    };
    let level = coarse(&shaking(3.0, None));
    let up = coarse(&shaking(3.0, Some(4.0)));
    let exponential = RateCurve::Exponential { slow: 0.03, fast: 0.06, rate_s_per_m: 25.0 };
    let pieces = RateCurve::Pieces {
        speeds_m_per_s: vec![0.0, 0.05, 0.2],
        coefficients: vec![0.03, 0.05, 0.06],
    };
    let pendulum = |friction| Slider::pendulum(friction, 2.0);
    let by_speed = |curve: &RateCurve, factors| {
        let rate = RateLaw::new(curve.clone(), factors).unwrap();
        pendulum(Friction::by_speed([0.035; 2], rate).unwrap())
    };
    let plain = || pendulum(coulomb([0.06; 2], [0.05; 2]));
    let surface = |radius_m: f64, friction: f64, travel_m: f64| Surface {
        radius_m: Some(radius_m),
        friction,
        travel_m: Some(travel_m),
    };
    let surfaces = vec![surface(1.0, 0.03, 0.012), surface(2.0, 0.05, 0.3)];
    let in_series = Slider::in_series(SurfacesInSeries::new(surfaces, 1.1).unwrap());
    let contents = |floor, mass_kg, static_friction, kinetic_friction| Contents {
        floor,
        mass_kg,
        static_friction,
        kinetic_friction,
    };
    let contents = vec![contents(0, 30.0, 0.05, 0.04), contents(1, 20.0, 0.12, 0.1)];
    let gap_m = [Some(0.006), Some(0.008)];
    let rigid = Some(Stop::rigid(gap_m, 0.4));
    let elastic = Some(Stop::elastic(gap_m, 1e5, 900.0));
    let none = Vec::new;
    let all = [
        ("exponential", by_speed(&exponential, [1.0; 2]), none(), None, &level),
        ("pieces", by_speed(&pieces, [1.0, 0.9]), none(), None, &level),
        ("surfaces", in_series.clone(), none(), None, &level),
        ("contents", plain(), contents.clone(), None, &level),
        ("elastic stop", plain(), none(), elastic, &level),
        ("rigid stop", plain(), none(), rigid, &level),
        ("pendulum under vertical motion", plain(), none(), None, &up),
        (
            "pieces, contents, rigid stop",
            by_speed(&pieces, [1.0; 2]),
            contents.clone(),
            rigid,
            &level,
        ),
        ("surfaces, contents, elastic stop, vertical motion", in_series, contents, elastic, &up),
    ];
    let build = |(name, slider, contents, stop, motion): (
        &'static str,
        Slider,
        Vec<Contents>,
        Option<Stop>,
        &GroundMotion,
    )| {
        let slider = Slider { ends: stop.into(), ..slider };
        let frame = frame(&[201.0], &[3.6e4], Damping::Ratio(0.01));
        let model = Model::new(block(325.0), slider, frame, G, InitialState::rest());
        let model = model.and_then(|model| model.with_contents(contents)).unwrap();
        System { name, model, motion: motion.clone() }
    };
    all.into_iter().map(build).collect()
}

/// Two systems in which one sample holds many radians of the structure, or many events.
pub fn coarse_systems() -> Vec<System> {
    let model = |block_kg, fixed, kinetic, frame| {
        let slider = slider(coulomb([fixed; 2], [kinetic; 2]));
        Model::new(block(block_kg), slider, frame, G, InitialState::rest()).unwrap()
    };
    let zigzag = [0.0, 1.1, -0.9, 0.2, 1.6, -2.2, 0.7, -0.3, 0.0].map(|a| 0.5 * a).to_vec();
    vec![
        System {
            name: "60 Hz without damping, sampled at 2 Hz",
            model: model(325.0, 0.05, 0.04, frame(&[45.0], &[6.4e6], Damping::Ratio(0.0))),
            motion: GroundMotion::evenly_spaced(0.5, zigzag.clone(), None).unwrap(),
        },
        System {
            name: "light block under a heavy oscillator",
            model: model(0.5, 0.05, 0.04, frame(&[200.0], &[7.9e3], Damping::Ratio(0.02))),
            motion: GroundMotion::evenly_spaced(0.5, zigzag, None).unwrap(),
        },
    ]
}

pub fn figures(c: &Certificate) -> String {
    let [r, f, e] = [c.equilibrium_residual, c.friction_excess, c.energy_balance_error];
    let (d, of, call) = (c.demands_error, &c.demand_in_error, &c.closest_call);
    format!("equilibrium {r:e}, friction {f:e}, energy {e:e}, demands {d:e} of {of:?}, {call:?}")
}

/// Appends a knot: `[s, ṡ, block acceleration]`, friction force, storeys' `q`, `q̇`, accelerations.
pub fn knot(
    h: &mut History,
    time_s: f64,
    mode: Mode,
    table: f64,
    [s, v, block]: [f64; 3],
    force: f64,
    [q, rates, storeys]: [&[f64]; 3],
) {
    h.storeys = q.len();
    h.time_s.push(time_s);
    h.mode.push(mode);
    h.table_acceleration_m_per_s2.push(table);
    h.sliding_displacement_m.push(s);
    h.sliding_velocity_m_per_s.push(v);
    h.block_acceleration_m_per_s2.push(block);
    h.friction_force_n.push(force);
    h.storey_displacement_m.extend(q);
    h.storey_velocity_m_per_s.extend(rates);
    h.storey_acceleration_m_per_s2.extend(storeys);
}
