//! Tampered histories and demands in two directions: each must push a figure above 1e-9.

use crate::common::in_plane::{cases, model, motion};
use slipstick::check::{Certificate, check};
use slipstick::model::{AlongY, Damping, Model, Slider};
use slipstick::motion::GroundMotion;
use slipstick::response::{Demands, History, HistoryAlongY, InPlane, Mode, Response};
use slipstick::slider::{Direction, Friction, RateCurve, RateLaw};
use slipstick::solver::exact;

/// A tampered figure must stand above this.
const SHOWS: f64 = 1e-9;

#[derive(Clone)]
struct System {
    id: String,
    model: Model,
    motion: GroundMotion,
}

fn judge(system: &System, response: &Response) -> Certificate {
    check(&system.model, &system.motion, response)
}

/// The worst of the figures that judge the history.
fn worst(c: &Certificate) -> f64 {
    c.equilibrium_residual.max(c.friction_excess).max(c.energy_balance_error)
}

fn must_show(system: &System, response: &Response, what: &str) {
    let found = worst(&judge(system, response));
    assert!(found > SHOWS, "{}: {what} went unnoticed: {found:e}", system.id);
}

fn must_show_in_demands(system: &System, response: &Response, what: &str) {
    let found = judge(system, response).demands_error;
    assert!(found > SHOWS, "{}: {what} went unnoticed: {found:e}", system.id);
}

/// Systems with their true responses: rigid, with a vertical motion, one and two storeys, friction by speed.
fn systems() -> Vec<(System, Response)> {
    let some =
        ["BIDI-SINES-EQUAL", "BIDI-VERTICAL-0", "BIDI-XY-1", "BIDI-UNEVEN-2", "BIDI-EXP-TAFT-1"];
    let cases = cases();
    let chosen = cases.iter().filter(|case| some.iter().any(|id| case["id"] == *id));
    chosen
        .map(|case| {
            let id = case["id"].as_str().unwrap().to_owned();
            let system = System { id, model: model(case), motion: motion(case) };
            let response = exact(&system.model, &system.motion).unwrap();
            (system, response)
        })
        .collect()
}

fn along_y(response: &mut Response) -> &mut HistoryAlongY {
    plane(response).history.as_mut().unwrap()
}

fn plane(response: &mut Response) -> &mut InPlane {
    response.in_plane.as_mut().unwrap()
}

/// Knots just before a change of mode.
fn changes(h: &History, pick: impl Fn(Mode, Mode) -> bool) -> Vec<usize> {
    (0..h.len() - 1)
        .filter(|&k| h.mode[k] != h.mode[k + 1] && pick(h.mode[k], h.mode[k + 1]))
        .collect()
}

/// The first knot from one on at which the mode is another.
fn end_of_mode(h: &History, from: usize) -> usize {
    (from..h.len()).find(|&k| h.mode[k] != h.mode[from]).unwrap_or(h.len())
}

/// Changes values of every column, `apart` from each other, the first and the last among them.
fn changed_values_show(apart: usize) {
    type Column = fn(&mut Response) -> &mut Vec<f64>;
    fn along_x(response: &mut Response) -> &mut History {
        response.history.as_mut().unwrap()
    }
    let columns: [Column; 16] = [
        |r| &mut along_x(r).sliding_velocity_m_per_s,
        |r| &mut along_y(r).sliding_velocity_m_per_s,
        |r| &mut along_x(r).storey_velocity_m_per_s,
        |r| &mut along_y(r).storey_velocity_m_per_s,
        |r| &mut along_x(r).sliding_displacement_m,
        |r| &mut along_y(r).sliding_displacement_m,
        |r| &mut along_x(r).storey_displacement_m,
        |r| &mut along_y(r).storey_displacement_m,
        |r| &mut along_x(r).table_acceleration_m_per_s2,
        |r| &mut along_y(r).table_acceleration_m_per_s2,
        |r| &mut along_x(r).block_acceleration_m_per_s2,
        |r| &mut along_y(r).block_acceleration_m_per_s2,
        |r| &mut along_x(r).storey_acceleration_m_per_s2,
        |r| &mut along_y(r).storey_acceleration_m_per_s2,
        |r| &mut along_x(r).friction_force_n,
        |r| &mut along_y(r).friction_force_n,
    ];
    let peak = |list: &[f64]| list.iter().fold(0.0, |peak: f64, x| peak.max(x.abs()));
    for (system, mut response) in systems() {
        for (i, column) in columns.into_iter().enumerate() {
            let scale = peak(column(&mut response));
            let count = column(&mut response).len();
            for j in (0..count).step_by(apart).chain(count.checked_sub(1)) {
                let kept = column(&mut response)[j];
                column(&mut response)[j] += 1e-7 * scale;
                must_show(&system, &response, &format!("value {j} of column {i}"));
                column(&mut response)[j] = kept;
            }
        }
    }
}

/// Few values of every column of every system; an odd number apart, so that storeys alternate.
#[test]
fn one_changed_value_shows_along_either_axis() {
    changed_values_show(11 * 37);
}

#[test]
#[ignore = "minutes: cargo xtask nightly"]
fn one_changed_value_of_many_shows_along_either_axis() {
    changed_values_show(37);
}

#[test]
fn moved_events_show() {
    for (system, response) in systems() {
        for k in changes(response.history.as_ref().unwrap(), |_, _| true) {
            for shift_s in [1e-6, -1e-6] {
                let mut moved = response.clone();
                let times_s = &mut moved.history.as_mut().unwrap().time_s;
                times_s[k] += shift_s;
                times_s[k + 1] += shift_s;
                if times_s.is_sorted() {
                    let at_s = times_s[k];
                    must_show(&system, &moved, &format!("event at {at_s} s, moved by {shift_s} s"));
                }
            }
        }
    }
}

#[test]
fn stick_left_out_shows() {
    for (system, response) in systems() {
        let history = response.history.as_ref().unwrap();
        for k in changes(history, |_, after| after == Mode::Stick) {
            let end = end_of_mode(history, k + 1);
            let mut tampered = response.clone();
            tampered.history.as_mut().unwrap().mode[k + 1..end]
                .fill(Mode::Slip(Direction::Positive));
            must_show(&system, &tampered, "a stick left out");
        }
    }
}

#[test]
fn release_astray_shows() {
    let (sin, cos) = (1e-6, 1.0);
    for (system, response) in systems() {
        let history = response.history.as_ref().unwrap();
        for k in changes(history, |before, _| before == Mode::Stick) {
            // Friction at release, and with it the block.
            let mut tampered = response.clone();
            let mass_kg = system.model.block().mass_kg;
            let h = tampered.history.as_mut().unwrap();
            let x_n = h.friction_force_n[k + 1];
            let y = tampered.in_plane.as_mut().unwrap().history.as_mut().unwrap();
            let y_n = y.friction_force_n[k + 1];
            let [to_x, to_y] = [cos * x_n - sin * y_n, sin * x_n + cos * y_n];
            h.friction_force_n[k + 1] = to_x;
            h.block_acceleration_m_per_s2[k + 1] += (to_x - x_n) / mass_kg;
            y.friction_force_n[k + 1] = to_y;
            y.block_acceleration_m_per_s2[k + 1] += (to_y - y_n) / mass_kg;
            must_show(&system, &tampered, "friction astray at a release");
        }
        for (i, event) in plane(&mut response.clone()).events.iter().enumerate() {
            let mut tampered = response.clone();
            let [x, y] = event.direction;
            plane(&mut tampered).events[i].direction = [cos * x - sin * y, sin * x + cos * y];
            if event.direction != [0.0; 2] {
                must_show_in_demands(&system, &tampered, "the direction of a release");
            }
            plane(&mut tampered).events[i] = *event;
            plane(&mut tampered).events[i].sliding_displacement_y_m += 1e-6;
            must_show_in_demands(&system, &tampered, "the place of an event");
        }
    }
}

/// The friction of a model with factors on the static and on the kinetic one.
fn friction(model: &Model, of_fixed: f64, of_kinetic: f64) -> Friction {
    let fixed = of_fixed * model.static_friction()[0];
    match model.slider().rate() {
        Some(law) => Friction::by_speed([fixed; 2], law.scaled(of_kinetic)),
        None => Friction::new(fixed, of_kinetic * model.kinetic_friction()[0]),
    }
    .unwrap()
}

/// Friction by speed with another value at high speed, and with another rate.
fn faded(model: &Model, part: f64) -> Vec<Friction> {
    let Some(law) = model.slider().rate() else { return Vec::new() };
    let RateCurve::Exponential { slow, fast, rate_s_per_m } = *law.curve() else {
        return Vec::new();
    };
    let curves = [[fast * part, rate_s_per_m], [fast, rate_s_per_m * part]];
    let of = |[fast, rate_s_per_m]: [f64; 2]| {
        let law = RateLaw::new(RateCurve::Exponential { slow, fast, rate_s_per_m }, [1.0; 2]);
        law.and_then(|law| Friction::by_speed(model.static_friction(), law)).unwrap()
    };
    curves.map(of).to_vec()
}

#[test]
fn changed_model_shows() {
    for (system, response) in systems() {
        let must_show = |model: Model, what: &str| {
            let other = System { model, ..system.clone() };
            must_show(&other, &response, what);
        };
        let [fixed, kinetic] =
            [system.model.static_friction()[0], system.model.kinetic_friction()[0]];
        let all_slides = !response.history.as_ref().unwrap().mode.contains(&Mode::Stick);
        for part in [1.0 + 1e-6, 1.0 - 1e-6] {
            let equal = fixed == kinetic;
            let parts = [
                Some([part, part]),
                (!equal && !all_slides).then_some([part, 1.0]),
                (!equal).then_some([1.0, part]),
            ];
            for [of_fixed, of_kinetic] in parts.into_iter().flatten() {
                let friction = friction(&system.model, of_fixed, of_kinetic);
                must_show(system.model.with_friction(friction), "μ changed by 1e-6");
            }
            for friction in faded(&system.model, part) {
                must_show(system.model.with_friction(friction), "what the speed does to μ");
            }
            let with = |slider: Slider, along_y: AlongY| {
                let m = &system.model;
                let g = m.gravity_m_per_s2();
                Model::new(*m.block(), slider, m.frame().clone(), g, m.initial().clone())
                    .and_then(|model| model.with_along_y(along_y))
                    .unwrap()
            };
            let (slider, mut along_y) = (system.model.slider().clone(), system.model.along_y());
            let damper = Slider { damper_n_s_per_m: 0.1 * part, ..slider.clone() };
            must_show(with(damper, along_y.clone()), "a damper");
            if let Some(radius_m) = slider.radius_m() {
                let other = Slider::pendulum(friction(&system.model, 1.0, 1.0), radius_m * part);
                must_show(with(other, along_y.clone()), "a radius");
            }
            if let Some(k) = along_y.stiffnesses_n_per_m.first_mut() {
                *k *= part;
                must_show(with(slider.clone(), along_y.clone()), "a stiffness along y");
                let mut along_y = system.model.along_y();
                if let Damping::Ratio(ratio) = &mut along_y.damping {
                    *ratio *= 1.0 + 1e3 * (part - 1.0);
                }
                must_show(with(slider.clone(), along_y), "damping along y");
            }
        }
    }
}

/// Changes demands up and down; those that are looked at are chosen by the numbers of system, demand, view and sign.
fn changed_demands_show(looked_at: fn(usize, usize, usize, usize) -> bool) {
    type Number = fn(&mut Demands) -> Option<&mut f64>;
    let numbers: [Number; 21] = [
        |d| Some(&mut d.peak_sliding_displacement_m),
        |d| Some(&mut d.max_sliding_displacement_m),
        |d| Some(&mut d.min_sliding_displacement_m),
        |d| Some(&mut d.residual_sliding_displacement_m),
        |d| Some(&mut d.peak_sliding_velocity_m_per_s),
        |d| Some(&mut d.peak_block_acceleration_m_per_s2),
        |d| Some(&mut d.peak_base_shear_n),
        |d| Some(&mut d.peak_friction_force_n),
        |d| Some(&mut d.peak_slider_force_n),
        |d| Some(&mut d.base_shear_coefficient),
        |d| Some(&mut d.friction_coefficient_used),
        |d| Some(&mut d.slider_force_coefficient),
        |d| Some(&mut d.storeys.last_mut()?.peak_acceleration_m_per_s2),
        |d| Some(&mut d.storeys.last_mut()?.peak_displacement_m),
        |d| Some(&mut d.storeys.last_mut()?.peak_drift_m),
        |d| Some(&mut d.storeys.last_mut()?.peak_drift_velocity_m_per_s),
        |d| d.gap_ratio.as_mut(),
        |d| d.closest_stop.as_mut(),
        |d| Some(&mut d.peak_sliding_displacement_time_s),
        |d| Some(&mut d.sliding_path_m),
        |d| Some(&mut d.sliding_time_s),
    ];
    for (s, (system, response)) in systems().into_iter().enumerate() {
        assert!(judge(&system, &response).holds());
        for (i, number) in numbers.into_iter().enumerate() {
            for view in 0..3 {
                for (sign, part) in [1.0 + 1e-6, 1.0 - 1e-6].into_iter().enumerate() {
                    if !looked_at(s, i, view, sign) {
                        continue;
                    }
                    let mut tampered = response.clone();
                    let demands = match view {
                        0 => &mut tampered.demands,
                        axis => &mut plane(&mut tampered).axes[axis - 1],
                    };
                    let Some(value) = number(demands).filter(|value| **value != 0.0) else {
                        continue;
                    };
                    // Where |s| is flat its time is known to the root of rounding.
                    let part = if i == 17 { 1.0 + 1e2 * (part - 1.0) } else { part };
                    *value *= part;
                    must_show_in_demands(&system, &tampered, &format!("demand {i} of {view}"));
                }
            }
        }
        let counts: [fn(&mut Demands) -> &mut u64; 3] =
            [|d| &mut d.slip_count, |d| &mut d.stick_count, |d| &mut d.reversal_count];
        for count in counts {
            let mut tampered = response.clone();
            *count(&mut tampered.demands) += 1;
            must_show_in_demands(&system, &tampered, "a count");
        }
        let mut tampered = response.clone();
        plane(&mut tampered).peak_sliding_displacement_direction_rad += 1e-7;
        must_show_in_demands(&system, &tampered, "the direction of the peak");
        let mut tampered = response.clone();
        if let Some(least) = &mut plane(&mut tampered).least_sliding_speed_m_per_s {
            *least += 1e-7;
            must_show_in_demands(&system, &tampered, "the least speed");
        }
        let mut tampered = response.clone();
        if tampered.events.pop().is_some() {
            must_show_in_demands(&system, &tampered, "an event left out");
        }
    }
}

/// Every demand of every system in one view and with one sign, the next ones in the next system.
#[test]
fn changed_demand_shows() {
    changed_demands_show(|s, i, view, sign| view == (s + i) % 3 && sign == (s + i) % 2);
}

#[test]
#[ignore = "minutes: cargo xtask nightly"]
fn changed_demand_shows_in_every_view() {
    changed_demands_show(|_, _, _, _| true);
}

/// What is not finite or not there is not judged.
#[test]
fn broken_histories_get_infinite_figures() {
    for (system, response) in systems().into_iter().take(1) {
        let broken: [fn(&mut Response); 4] = [
            |r| along_y(r).sliding_velocity_m_per_s[3] = f64::NAN,
            |r| along_y(r).sliding_velocity_m_per_s.truncate(2),
            |r| plane(r).history = None,
            |r| r.in_plane = None,
        ];
        for change in broken {
            let mut tampered = response.clone();
            change(&mut tampered);
            let c = judge(&system, &tampered);
            assert!(worst(&c) == f64::INFINITY && !c.holds());
        }
    }
}
