//! Systems, and their true histories driven through by the judge's own steps.

use std::path::Path;

use serde_json::Value;

use super::super::super::collocation::{POINTS, Rule};
use super::super::super::judge::Directions;
use super::super::super::outputs::{BASE_SHEAR, BLOCK, FRICTION, SLIDER, STOREYS, VELOCITY};
use super::super::decisions::Turn;
use super::super::frame::{Loads, Pair, dot, norm, times, unit};
use super::super::step::{State, Stepper, Stretch, time_to_rest};
use super::super::*;
use crate::model::{AlongY, Block, Damping, Frame, InitialState, Model, Slider};
use crate::response::{
    Demands, Event, EventInPlane, EventKind, InPlane, Method, Mode, StoreyDemands,
};
use crate::slider::Friction;

/// The reference cases.
pub(super) fn cases() -> Vec<Value> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let path = root.join("../../data/reference/bidirectional.json");
    let text = std::fs::read_to_string(path).expect("the reference cases");
    let file: Value = serde_json::from_str(&text).expect("JSON");
    file["cases"].as_array().expect("cases").clone()
}

pub(super) fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("expected a number, found {value}"))
}

pub(super) fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().map_or_else(Vec::new, |list| list.iter().map(number).collect())
}

pub(super) fn pair(value: &Value) -> Pair {
    [number(&value[0]), number(&value[1])]
}

#[derive(Clone)]
pub(super) struct System {
    pub(super) id: String,
    pub(super) model: Model,
    pub(super) motion: GroundMotion,
    /// Times of the events, kinds in turn.
    pub(super) events_s: Vec<f64>,
    pub(super) starts_sliding: bool,
    pub(super) states_s: Vec<f64>,
    /// Time of the largest sliding displacement, where it is told.
    pub(super) peak_s: Option<f64>,
}

pub(super) fn system(case: &Value) -> System {
    let p = |name: &str| case["params"].get(name).and_then(Value::as_f64);
    let fixed = p("mu_s").unwrap();
    let friction = match &case["params"]["mu_exp"] {
        Value::Null => Friction::new(fixed, p("mu_d").unwrap()),
        by_speed => {
            let [slow, fast, rate_s_per_m] =
                ["slow", "fast", "rate"].map(|name| number(&by_speed[name]));
            RateLaw::new(RateCurve::Exponential { slow, fast, rate_s_per_m }, [1.0; 2])
                .and_then(|law| Friction::by_speed([fixed; 2], law))
        }
    };
    let friction = friction.unwrap();
    let mut slider = match p("R") {
        Some(radius_m) => Slider::pendulum(friction, radius_m),
        None => Slider::sprung(friction, p("K1").unwrap()),
    };
    slider.damper_n_s_per_m = p("C1").unwrap();
    let masses_kg = numbers(&case["params"]["m"]);
    let frame = Frame {
        masses_kg,
        stiffnesses_n_per_m: numbers(&case["params"]["kx"]),
        damping: Damping::Ratio(p("xi").unwrap()),
        heights_m: None,
    };
    let initial = |axis: usize| {
        let of = |name: &str| {
            let list = case["initial"][name].as_array().expect("a list");
            list.iter().map(|pair| number(&pair[axis])).collect()
        };
        InitialState {
            sliding_displacement_m: number(&case["initial"]["s"][axis]),
            sliding_velocity_m_per_s: number(&case["initial"]["w"][axis]),
            storey_displacement_m: Some(of("q")),
            storey_velocity_m_per_s: Some(of("v")),
        }
    };
    let block = Block { mass_kg: p("M1").unwrap(), width_m: None, height_m: None };
    let along_y = AlongY {
        stiffnesses_n_per_m: numbers(&case["params"]["ky"]),
        damping: Damping::Ratio(p("xiy").unwrap()),
        width_m: None,
        initial: initial(1),
    };
    let model = Model::new(block, slider, frame, p("g").unwrap(), initial(0));
    let model = model.and_then(|model| model.with_along_y(along_y)).expect("a model");
    let end_s = number(&case["t_end"]);
    let mut t = numbers(&case["input"]["t"]);
    let lists = ["ax", "ay", "av"].map(|name| numbers(&case["input"][name]));
    let count = t.partition_point(|t| *t < end_s);
    let cut = |list: &Vec<f64>| {
        let part = (end_s - t[count - 1]) / (t[count] - t[count - 1]);
        let mut short = list[..count].to_vec();
        short.push(list[count - 1] + part * (list[count] - list[count - 1]));
        short
    };
    let [ax, ay] = [cut(&lists[0]), cut(&lists[1])];
    let av = (!lists[2].is_empty()).then(|| cut(&lists[2]));
    t.truncate(count);
    t.push(end_s);
    let motion =
        GroundMotion::new(t, ax, av).and_then(|motion| motion.with_y(ay)).expect("a motion");
    System {
        id: case["id"].as_str().unwrap().to_owned(),
        model,
        motion,
        events_s: numbers(&case["event_times"]),
        starts_sliding: case["initial_mode"] == "slip" && case["event_times"][0] != 0.0,
        peak_s: case["expect"]
            .as_array()
            .unwrap()
            .iter()
            .find(|expect| expect["q"] == "peak_sliding_displacement_time_s")
            .map(|expect| number(&expect["value"])),
        states_s: case["states"].as_array().unwrap().iter().map(|s| number(&s["t"])).collect(),
    }
}

/// Drives through a system.
struct Driver<'a> {
    stepper: Stepper<'a>,
    grounds: [Ground<'a>; 2],
    h: History,
    y: HistoryAlongY,
    /// The last direction of sliding.
    heading: Option<Pair>,
}

impl Driver<'_> {
    fn knot(&mut self, t: f64, state: &State, loads: &Loads, mode: Mode) {
        let frame = self.stepper.frame;
        let mut floors = vec![0.0; frame.masses_kg.len()];
        let forces = frame.forces(&state.x, &state.v, loads, &mut floors);
        let a = [loads[0].a, loads[1].a];
        let (friction, block) = if mode == Mode::Stick {
            (times(forces.push, -frame.block_kg), a)
        } else {
            let from_rest = unit(forces.push).filter(|_| self.heading.is_none());
            let u = unit(state.speed()).or(from_rest).or(self.heading).unwrap_or([0.0; 2]);
            let f = frame.slowing(loads, norm(state.speed()));
            let block = [0, 1].map(|i| forces.push[i] + a[i] - f * u[i]);
            (times(u, -frame.block_kg * f), block)
        };
        let (h, y) = (&mut self.h, &mut self.y);
        h.time_s.push(t);
        h.mode.push(mode);
        let sides = [
            (&mut h.table_acceleration_m_per_s2, &mut y.table_acceleration_m_per_s2, a),
            (
                &mut h.sliding_displacement_m,
                &mut y.sliding_displacement_m,
                [state.x[0], state.x[1]],
            ),
            (&mut h.sliding_velocity_m_per_s, &mut y.sliding_velocity_m_per_s, state.speed()),
            (&mut h.block_acceleration_m_per_s2, &mut y.block_acceleration_m_per_s2, block),
            (&mut h.friction_force_n, &mut y.friction_force_n, friction),
        ];
        for (x, y, value) in sides {
            x.push(value[0]);
            y.push(value[1]);
        }
        for i in 0..floors.len() / 2 {
            let at = |list: &[f64]| [list[2 * i], list[2 * i + 1]];
            let own = [0, 1].map(|k| -floors[2 * i + k] / frame.masses_kg[2 * i + k]);
            let sides = [
                (&mut h.storey_displacement_m, &mut y.storey_displacement_m, at(&state.x[2..])),
                (&mut h.storey_velocity_m_per_s, &mut y.storey_velocity_m_per_s, at(&state.v[2..])),
                (&mut h.storey_acceleration_m_per_s2, &mut y.storey_acceleration_m_per_s2, own),
            ];
            for (x, y, value) in sides {
                x.push(value[0]);
                y.push(value[1]);
            }
        }
    }

    /// Goes through a stretch; `stops` where it ends at rest.
    fn go(&mut self, state: &mut State, stretch: &Stretch, slips: bool, stops: bool) {
        let frame = self.stepper.frame;
        let longest_s = 0.25 / frame.rates[usize::from(slips)].max(1e-3);
        let mut t = 0.0;
        let mut floors = vec![0.0; frame.masses_kg.len()];
        while t < stretch.step_s {
            let left_s = stretch.step_s - t;
            let mut step_s = left_s.min(longest_s);
            if slips {
                let loads = stretch.at(t);
                let push = frame.forces(&state.x, &state.v, &loads, &mut floors).push;
                let (r, p) = (norm(state.speed()), norm(push));
                let f = frame.slowing(&loads, r);
                self.heading = unit(state.speed());
                if r > 0.0 && (dot(push, state.speed()) < 0.0 || p < f) {
                    step_s = step_s.min(0.25 * r / (f + p));
                    let rest_s = time_to_rest(state.speed(), push, f);
                    if stops
                        && (rest_s.is_some_and(|rest_s| r * rest_s < 1e-18)
                            || left_s < 1e-14
                            || r < 1e-14)
                    {
                        state.lose_speed(frame);
                        let part = stretch.part(t, left_s);
                        let step = self.stepper.solve(state, part, false).unwrap();
                        step.at_point(POINTS - 1, state);
                        return;
                    }
                    if !stops && t + step_s == t {
                        state.lose_speed(frame);
                        continue;
                    }
                }
            }
            loop {
                let step = self.stepper.solve(state, stretch.part(t, step_s), slips);
                let fine = step.filter(|step| step.tail <= 1e-5 && step.defect() <= 1e-17);
                if let Some(step) = fine {
                    step.at_point(POINTS - 1, state);
                    break;
                }
                step_s *= 0.5;
                assert!(step_s > 1e-30, "no step at {} s", stretch.from_s + t);
            }
            t = if step_s >= left_s { stretch.step_s } else { t + step_s };
        }
        if stops {
            assert!(
                norm(state.speed()) < 1e-12,
                "{} at {}",
                norm(state.speed()),
                stretch.from_s + t
            );
            state.lose_speed(frame);
        }
    }
}

/// What all of a judge's parts are borrowed from.
pub(super) struct Parts {
    law: Law,
    outputs: Outputs,
}

impl Parts {
    pub(super) fn frame(&self, system: &System) -> PlaneFrame<'_> {
        let vertical = system.motion.vertical_m_per_s2().is_some();
        let end_s = system.motion.duration_s();
        let normal = Ground::new(&system.model, &system.motion, end_s).largest(end_s).0;
        PlaneFrame::new(&system.model, vertical, &self.law, normal)
    }
}

pub(super) fn parts(system: &System) -> Parts {
    let vertical = system.motion.vertical_m_per_s2().is_some();
    let law = Law::new(&system.model, vertical);
    Parts { law, outputs: Outputs::with_moment(&system.model, false) }
}

/// The true history of a system, by its known events.
pub(super) fn drive(system: &System) -> Response {
    let parts = parts(system);
    let frame = parts.frame(system);
    let (model, motion) = (&system.model, &system.motion);
    let end_s = motion.duration_s();
    let table_y = motion.horizontal_y_m_per_s2().unwrap();
    let grounds =
        [motion.horizontal_m_per_s2(), table_y].map(|list| Ground::of(model, motion, list, end_s));
    let h = History { storeys: model.storeys(), ..History::default() };
    let stepper = Stepper { frame: &frame, rule: Rule::get() };
    let mut driver = Driver { stepper, grounds, h, y: HistoryAlongY::default(), heading: None };
    let mut times_s = motion.times_s().to_vec();
    times_s.extend(&system.events_s);
    times_s.extend(&system.states_s);
    times_s.retain(|t| *t <= end_s);
    times_s.sort_by(f64::total_cmp);
    times_s.dedup();
    let slip = Mode::Slip(Direction::Positive);
    let mut mode = if system.starts_sliding { slip } else { Mode::Stick };
    let along_y = model.along_y().initial;
    let start = [model.initial(), &along_y];
    let both = |of: &dyn Fn(&InitialState) -> Vec<f64>| {
        let [x, y] = start.map(of);
        x.into_iter().zip(y).flat_map(|(x, y)| [x, y]).collect::<Vec<f64>>()
    };
    let mut state = State {
        x: both(&|s| {
            [vec![s.sliding_displacement_m], s.storey_displacement_m.clone().unwrap()].concat()
        }),
        v: both(&|s| {
            [vec![s.sliding_velocity_m_per_s], s.storey_velocity_m_per_s.clone().unwrap()].concat()
        }),
    };
    let mut last: Option<(Loads, Mode)> = None;
    for pair in times_s.windows(2) {
        let (from_s, to_s) = (pair[0], pair[1]);
        let is_event = |t: f64| system.events_s.contains(&t);
        if is_event(from_s) {
            mode = if mode == Mode::Stick { slip } else { Mode::Stick };
        }
        let mut at_s = from_s;
        while at_s < to_s {
            let pieces = [0, 1].map(|axis| driver.grounds[axis].piece(at_s, to_s));
            let end_s = pieces[0].to_s.min(pieces[1].to_s);
            let loads = [0, 1].map(|end| [0, 1].map(|axis| pieces[axis].loads[end]));
            let same = |(before, was): &(Loads, Mode)| {
                *was == mode && [0, 1].iter().all(|&i| before[i].a == loads[0][i].a)
            };
            if !last.as_ref().is_some_and(same) {
                driver.heading = None;
                driver.knot(at_s, &state, &loads[0], mode);
            }
            let stretch = Stretch { from_s: at_s, step_s: end_s - at_s, loads };
            let stops = mode != Mode::Stick && end_s == to_s && is_event(to_s);
            driver.go(&mut state, &stretch, mode != Mode::Stick, stops);
            driver.knot(end_s, &state, &loads[1], mode);
            last = Some((loads[1], mode));
            at_s = end_s;
        }
    }
    let plane = InPlane { history: Some(driver.y), ..InPlane::default() };
    let response = Response {
        method: Method::Exact,
        demands: Demands::default(),
        events: Vec::new(),
        history: Some(driver.h),
        contact_loss_s: Vec::new(),
        iterations: None,
        warnings: Vec::new(),
        in_plane: Some(Box::new(plane)),
    };
    printed(system, response)
}

/// Judges a history without its demands.
pub(super) fn with_judge<T>(
    system: &System,
    response: &Response,
    tell: impl FnOnce(&PlaneJudge<'_>) -> T,
) -> T {
    let parts = parts(system);
    let frame = parts.frame(system);
    let printed = response.in_plane.as_deref().unwrap();
    let given = Given {
        model: &system.model,
        motion: &system.motion,
        response,
        history: response.history.as_ref().unwrap(),
        law: &parts.law,
        outputs: &parts.outputs,
        pulse: Pulse::new(crate::progress::UNWATCHED),
    };
    let table_y = system.motion.horizontal_y_m_per_s2().unwrap();
    let along_y = printed.history.as_ref().unwrap();
    let mut judge = PlaneJudge::of_plane(given, (printed, along_y, table_y), &frame);
    assert!(judge.measure().unwrap());
    judge.go_on().unwrap();
    tell(&judge)
}

/// A response with the demands that its history has.
fn printed(system: &System, response: Response) -> Response {
    let (mut demands, mut plane) = with_judge(system, &response, |judge| {
        let of = |view: usize| {
            let peak = &judge.axes.peaks.largest[view];
            let (model, n) = (&system.model, system.model.storeys());
            let storey = |i: usize| StoreyDemands {
                peak_acceleration_m_per_s2: peak[STOREYS + 2 * n + i],
                peak_displacement_m: peak[STOREYS + i],
                peak_drift_m: peak[STOREYS + n + i],
                peak_drift_ratio: None,
            };
            let weight_n = model.weight_n();
            Demands {
                peak_sliding_displacement_m: peak[judge.outputs.len()],
                peak_sliding_velocity_m_per_s: peak[VELOCITY],
                peak_block_acceleration_m_per_s2: peak[BLOCK],
                storeys: (0..n).map(storey).collect(),
                peak_base_shear_n: peak[BASE_SHEAR],
                peak_friction_force_n: peak[FRICTION],
                peak_slider_force_n: peak[SLIDER],
                base_shear_coefficient: peak[BASE_SHEAR] / weight_n,
                friction_coefficient_used: peak[FRICTION] / weight_n,
                slider_force_coefficient: peak[SLIDER] / weight_n,
                ..Demands::default()
            }
        };
        let [mut root, mut x, mut y] = [of(0), of(1), of(2)];
        let last = judge.place(judge.h.len() - 1);
        let [most_x, least_x, most_y, least_y] = judge.axes.peaks.sides_m;
        x.max_sliding_displacement_m = most_x;
        x.min_sliding_displacement_m = -least_x;
        y.max_sliding_displacement_m = most_y;
        y.min_sliding_displacement_m = -least_y;
        x.residual_sliding_displacement_m = last[0];
        y.residual_sliding_displacement_m = last[1];
        root.max_sliding_displacement_m = most_x;
        root.min_sliding_displacement_m = -least_x;
        root.residual_sliding_displacement_m = norm(last);
        root.sliding_at_end = judge.mode(judge.h.len() - 1) != Mode::Stick;
        root.sliding_path_m = judge.totals.interfaces[0].path_m;
        root.sliding_time_s = judge.totals.interfaces[0].sliding_s;
        root.closest_stop = judge.totals.closest_stop();
        let gap_m = system.model.slider().gap_m();
        root.gap_ratio = gap_m.map(|gap_m| root.peak_sliding_displacement_m / gap_m);
        let count = |kind| judge.events.list.iter().filter(|e| e.event.kind == kind).count() as u64;
        root.slip_count = count(EventKind::Slip);
        root.stick_count = count(EventKind::Stick);
        let event = |turn: &Turn| EventInPlane {
            direction: turn.direction.unwrap_or([f64::NAN; 2]),
            sliding_displacement_y_m: turn.y_m,
        };
        let plane = InPlane {
            axes: [x, y],
            peak_sliding_displacement_direction_rad: 0.0,
            least_sliding_speed_m_per_s: judge.axes.least_speed,
            events: judge.axes.turns.iter().map(event).collect(),
            history: None,
        };
        (root, plane)
    });
    let events: Vec<Event> =
        with_judge(system, &response, |judge| judge.events.list.iter().map(|e| e.event).collect());
    let mut asked = response.clone();
    let mut at = |at_s: f64| {
        asked.demands.peak_sliding_displacement_time_s = at_s;
        with_judge(system, &asked, |judge| judge.axes.at_peak.unwrap_or([0.0; 2]))
    };
    let at_s = system.peak_s.unwrap_or_else(|| {
        let times_s = &response.history.as_ref().unwrap().time_s;
        let all: Vec<f64> = times_s.iter().map(|t| norm(at(*t))).collect();
        let best = (1..all.len()).fold(0, |best, k| if all[k] > all[best] { k } else { best });
        let [mut low, mut high] = [times_s[best - 1], times_s[best + 1]];
        for _ in 0..50 {
            let [a, b] = [0.4, 0.6].map(|part| low + (high - low) * part);
            if norm(at(a)) > norm(at(b)) { high = b } else { low = a }
        }
        0.5 * (low + high)
    });
    let s = at(at_s);
    demands.peak_sliding_displacement_time_s = at_s;
    plane.peak_sliding_displacement_direction_rad = libm::atan2(s[1], s[0]);
    let history = response.in_plane.and_then(|plane| plane.history);
    let plane = InPlane { history, ..plane };
    Response { demands, events, in_plane: Some(Box::new(plane)), ..response }
}
