//! Tampered histories: each must push a figure above 1e-9.

use super::systems::*;
use slipstick::check::{DecisionKind, check};
use slipstick::model::{Block, Contents, Damping, Frame, Model};
use slipstick::motion::GroundMotion;
use slipstick::response::{Demands, EventKind, History, Mode, Response};
use slipstick::slider::{Bearing, Direction, Ends, Friction, RateCurve, RateLaw, SurfacesInSeries};
use slipstick::solver;
use slipstick::study::Verdict;

/// A tampered figure must stand above this.
const SHOWS: f64 = 1e-9;

/// Judges a tampered history and says what went unnoticed.
fn must_show(system: &System, history: &History, what: &str) {
    let c = judge(system, history);
    assert!(worst(&c) > SHOWS, "{}: {what} went unnoticed: {}", system.name, figures(&c));
}

/// What a study says of a row whose check fails names the demand, and the bound that it passes.
#[test]
fn the_message_of_a_failing_row_names_its_demand() {
    let model = Model::builder().block("124 kg").friction(0.2, 0.15).build().expect("a model");
    let motion = GroundMotion::new(vec![0.0, 0.5, 0.5, 1.5], vec![4.0, 4.0, 0.0, 0.0], None);
    let motion = motion.expect("a motion");
    let mut response = solver::exact(&model, &motion).expect("a response");
    let right = Verdict::of(&check(&model, &motion, &response), true);
    assert!(right.holds() && right.defects.is_empty(), "{right:?}");
    response.demands.sliding_path_m *= 1.01;
    let wrong = Verdict::of(&check(&model, &motion, &response), true);
    let what = "demands error of sliding path";
    assert!(!wrong.holds() && wrong.what_failed().starts_with(what), "{wrong:?}");
    assert!(wrong.what_failed().ends_with("above the bound 1.0e-10"), "{wrong:?}");
    assert_eq!(wrong.largest.map(|(name, _)| name).as_deref(), Some(what));
    // What came out differently and holds has no demand.
    let other = Verdict { same: false, ..right };
    assert_eq!(other.what_failed(), "run again alone it came out differently");
}

/// Plain ones, those of long samples, those with devices.
fn all_systems() -> Vec<System> {
    let mut all = systems();
    all.extend(coarse_systems());
    all.extend(device_systems());
    all
}

#[test]
fn moved_events_show() {
    for system in all_systems() {
        let history = history_of(&system);
        for k in changes(&history, |a, b| a != b) {
            for shift_s in [1e-6, -1e-6] {
                let mut moved = history.clone();
                moved.time_s[k] += shift_s;
                moved.time_s[k + 1] += shift_s;
                if moved.time_s.is_sorted() {
                    must_show(&system, &moved, &format!("event at {} s", history.time_s[k]));
                }
            }
        }
    }
}

#[test]
fn changed_friction_shows() {
    for system in systems().into_iter().chain(coarse_systems()) {
        let [fixed, kinetic] = [system.model.static_friction(), system.model.kinetic_friction()];
        let more = |pair: [f64; 2]| pair.map(|mu| mu * (1.0 + 1e-6));
        let less = |pair: [f64; 2]| pair.map(|mu| mu * (1.0 - 1e-6));
        for (fixed, kinetic) in [
            (more(fixed), more(kinetic)),
            (less(fixed), less(kinetic)),
            (more(fixed), kinetic),
            (fixed, less(kinetic)),
        ] {
            let model = system.model.with_friction(coulomb(fixed, kinetic));
            let other = history_of(&System { model, ..system.clone() });
            must_show(&system, &other, "μ changed by 1e-6");
        }
    }
}

/// A law of devices with one number off by 1e-6.
#[test]
fn changed_device_shows() {
    for system in device_systems() {
        let history = history_of(&system);
        let must_show = |model: Model, what: &str| {
            let c = judge(&System { model, ..system.clone() }, &history);
            assert!(worst(&c) > SHOWS, "{}: {what} went unnoticed: {}", system.name, figures(&c));
        };
        let (slider, contents) = (system.model.slider(), system.model.contents());
        let with_contents = |e: usize, change: &dyn Fn(&mut Contents)| {
            let mut contents = contents.to_vec();
            change(&mut contents[e]);
            system.model.clone().with_contents(contents).unwrap()
        };
        for part in [1.0 + 1e-6, 1.0 - 1e-6] {
            must_show(system.model.with_friction_times(part).unwrap(), "friction");
            if let Some(rate) = slider.rate() {
                let curve = match rate.curve().clone() {
                    RateCurve::Exponential { slow, fast, rate_s_per_m } => {
                        RateCurve::Exponential { slow, fast, rate_s_per_m: rate_s_per_m * part }
                    }
                    RateCurve::Pieces { mut speeds_m_per_s, coefficients } => {
                        speeds_m_per_s[1] *= part;
                        RateCurve::Pieces { speeds_m_per_s, coefficients }
                    }
                };
                let factors =
                    [Direction::Positive, Direction::Negative].map(|way| rate.factor(way));
                let rate = RateLaw::new(curve, factors).unwrap();
                let friction = Friction::by_speed(system.model.static_friction(), rate).unwrap();
                must_show(system.model.with_friction(friction), "the rate of friction");
            }
            if let Some(series) = slider.series() {
                for i in 0..series.surfaces().len() {
                    let mut surfaces = series.surfaces().to_vec();
                    surfaces[i].radius_m = surfaces[i].radius_m.map(|radius_m| radius_m * part);
                    let series = SurfacesInSeries::new(surfaces, series.static_ratio()).unwrap();
                    let bearing = Bearing::InSeries(series);
                    let model = with(&system.model, |slider, _| slider.bearing = bearing);
                    must_show(model, "a radius in series");
                }
            }
            for e in 0..contents.len() {
                must_show(with_contents(e, &|c| c.kinetic_friction *= part), "contents");
                must_show(with_contents(e, &|c| c.mass_kg *= part), "the mass of contents");
            }
        }
    }
}

#[test]
fn reversal_left_out_shows() {
    let mut reversals = 0;
    for system in all_systems() {
        let history = history_of(&system);
        for k in changes(&history, |a, b| slips(a) && slips(b) && a != b) {
            // Thrown back by a stop.
            if history.sliding_velocity_m_per_s[k] != 0.0 {
                continue;
            }
            reversals += 1;
            let (mut tampered, claimed) = (history.clone(), slider_mode(&history, k));
            set_slider_mode(&mut tampered, k + 1..end_of_mode(&history, k + 1), claimed);
            must_show(&system, &tampered, "a reversal left out");
        }
    }
    assert!(reversals > 5, "{reversals} reversals are too few");
}

#[test]
fn stop_turned_into_pass_shows() {
    for system in all_systems() {
        let history = history_of(&system);
        for k in changes(&history, |a, b| slips(a) && b == Mode::Stick) {
            let end = end_of_mode(&history, k + 1);
            if history.time_s[end - 1] == history.time_s[k] {
                continue;
            }
            for direction in [Direction::Positive, Direction::Negative] {
                let mut tampered = history.clone();
                set_slider_mode(&mut tampered, k + 1..end, Mode::Slip(direction));
                must_show(&system, &tampered, "a stop turned into a pass");
            }
        }
    }
}

#[test]
fn flipped_friction_shows() {
    for system in all_systems() {
        let history = history_of(&system);
        for k in changes(&history, |a, b| a == Mode::Stick && slips(b)) {
            let mut tampered = history.clone();
            for force in &mut tampered.friction_force_n[k + 1..end_of_mode(&history, k + 1)] {
                *force *= -1.0;
            }
            must_show(&system, &tampered, "friction of the wrong sign");
        }
    }
}

#[test]
fn one_changed_value_shows() {
    for system in all_systems() {
        let history = history_of(&system);
        let columns: [fn(&mut History) -> &mut Vec<f64>; 12] = [
            |h| &mut h.sliding_velocity_m_per_s,
            |h| &mut h.storey_velocity_m_per_s,
            |h| &mut h.contents_velocity_m_per_s,
            |h| &mut h.sliding_displacement_m,
            |h| &mut h.storey_displacement_m,
            |h| &mut h.contents_displacement_m,
            |h| &mut h.surface_displacement_m,
            |h| &mut h.table_acceleration_m_per_s2,
            |h| &mut h.block_acceleration_m_per_s2,
            |h| &mut h.storey_acceleration_m_per_s2,
            |h| &mut h.contents_acceleration_m_per_s2,
            |h| &mut h.friction_force_n,
        ];
        let sliding = peak(&history.sliding_velocity_m_per_s);
        let speed = sliding.max(peak(&history.storey_velocity_m_per_s));
        for (i, column) in columns.into_iter().enumerate() {
            let length = column(&mut history.clone()).len();
            let slider = system.model.slider();
            let is_plain = slider.friction().is_some_and(|friction| friction.rate().is_none())
                && slider.pendulum_radius_m(true).is_none()
                && system.model.contents().is_empty();
            let step = if is_plain { 31 } else { 97 };
            for j in (0..length).step_by(step).chain(length.checked_sub(1)) {
                let mut tampered = history.clone();
                let scale = if i < 3 { speed } else { peak(column(&mut tampered)) };
                column(&mut tampered)[j] += 1e-7 * scale;
                must_show(&system, &tampered, &format!("value {j} of column {i}"));
            }
        }
    }
}

/// A state or a force off by 1e-7 of its peak shows as about that, wherever it stands.
#[test]
fn changed_value_shows_in_proportion() {
    for system in all_systems() {
        let history = history_of(&system);
        let columns: [fn(&mut History) -> &mut Vec<f64>; 3] = [
            |h| &mut h.sliding_velocity_m_per_s,
            |h| &mut h.sliding_displacement_m,
            |h| &mut h.friction_force_n,
        ];
        let sliding = peak(&history.sliding_velocity_m_per_s);
        let speed = sliding.max(peak(&history.storey_velocity_m_per_s));
        let speed = speed.max(peak(&history.contents_velocity_m_per_s));
        let place = peak(&history.sliding_displacement_m);
        let place = place.max(peak(&history.storey_displacement_m));
        let place = place.max(peak(&history.contents_displacement_m));
        let scales = [speed, place, peak(&history.friction_force_n)];
        for (column, scale) in columns.into_iter().zip(scales) {
            for j in (1..history.len()).step_by(53) {
                let mut tampered = history.clone();
                column(&mut tampered)[j] += 1e-7 * scale;
                let c = judge(&system, &tampered);
                // The force of a spring or a stop may be several times the friction's.
                assert!(worst(&c) > 1e-8, "{}: {j} as {}", system.name, figures(&c));
            }
        }
    }
}

/// What was decided closely between the samples of a slip or a stick does not depend on where they lie.
#[test]
fn prop_closest_call_does_not_know_the_samples() {
    for system in all_systems() {
        let fine = |list: &[f64]| -> Vec<f64> {
            let parts = (0..16).map(|i| f64::from(i) / 16.0);
            let between = |pair: &[f64]| {
                let (from, to) = (pair[0], pair[1]);
                parts.clone().map(move |part| from + (to - from) * part).collect::<Vec<f64>>()
            };
            let all = list.windows(2).flat_map(between);
            all.chain(list.last().copied()).collect()
        };
        let motion = &system.motion;
        let [t, a] = [motion.times_s(), motion.horizontal_m_per_s2()].map(fine);
        let motion = GroundMotion::new(t, a, motion.vertical_m_per_s2().map(fine)).unwrap();
        let finer = System { motion, ..system.clone() };
        let [call, same] = [&system, &finer].map(|system| {
            let c = check(&system.model, &system.motion, &response_of(system));
            assert!(c.holds(), "{}: {}", system.name, figures(&c));
            c.closest_call.unwrap()
        });
        assert_eq!(call.kind, same.kind, "{}", system.name);
        // The peak of a velocity is that of knots and nodes; all else is rounding.
        let part = if [DecisionKind::Slip, DecisionKind::Impact].contains(&call.kind) {
            1e-3
        } else {
            1e-9
        };
        let off = (call.margin - same.margin).abs();
        assert!(off < part * call.margin, "{}: {call:?} {same:?}", system.name);
        assert!((call.time_s - same.time_s).abs() < 1e-6, "{}: {call:?} {same:?}", system.name);
    }
}

/// Without a spring the equations do not know where the block stands; its start does.
#[test]
fn other_start_shows() {
    let system = systems().swap_remove(0);
    let mut shifted = history_of(&system);
    let shift_m = 1e-7 * peak(&shifted.sliding_displacement_m);
    shifted.sliding_displacement_m.iter_mut().for_each(|s| *s += shift_m);
    must_show(&system, &shifted, "another start");
}

#[test]
fn damping_left_out_shows() {
    for system in systems() {
        let undamped = with(&system.model, |slider, frame| {
            slider.damper_n_s_per_m = 0.0;
            frame.damping = Damping::Ratio(0.0);
        });
        if undamped == system.model {
            continue;
        }
        let other = history_of(&System { model: undamped, ..system.clone() });
        must_show(&system, &other, "damping left out");
    }
}

/// A demand above its bound only between two samples shows, and one just below it does not.
#[test]
fn excess_between_samples_shows() {
    for system in coarse_systems().into_iter().skip(1) {
        let model = system.model.with_friction(coulomb([1e3; 2], [1e3; 2]));
        let held = System { model, ..system.clone() };
        let history = history_of(&held);
        let call = judge(&held, &history).closest_call.unwrap();
        assert_eq!(call.kind, DecisionKind::Stick);
        let inside = |t: &f64| (t - call.time_s).abs() > 1e-3;
        assert!(held.motion.times_s().iter().all(inside), "between samples");
        for (part, shows) in [(1.0 - 1e-8, true), (1.0 + 1e-8, false)] {
            let mu = 1e3 * (1.0 - call.margin) * part;
            let model = held.model.with_friction(coulomb([mu; 2], [mu; 2]));
            let excess = judge(&System { model, ..held.clone() }, &history).friction_excess;
            let expected = if shows { 1e-8 } else { 0.0 };
            assert!((excess - expected).abs() < 1e-11, "{}: {excess:e}", system.name);
        }
    }
}

/// What cannot be judged is refused, without a panic.
#[test]
fn broken_histories_are_refused() {
    let system = &systems()[2];
    let history = history_of(system);
    let breaks: [fn(&mut History); 8] = [
        |h| *h = History::default(),
        |h| h.mode.truncate(9),
        |h| h.storey_velocity_m_per_s.truncate(9),
        |h| h.storeys = 2,
        |h| h.time_s.swap(3, 4),
        |h| h.time_s[0] = f64::NAN,
        |h| h.sliding_velocity_m_per_s[7] = f64::NAN,
        |h| h.table_acceleration_m_per_s2[7] = f64::NAN,
    ];
    for (i, damage) in breaks.into_iter().enumerate() {
        let mut broken = history.clone();
        damage(&mut broken);
        let c = judge(system, &broken);
        assert!(!holds(&c) && worst(&c) == f64::INFINITY, "{i}: {}", figures(&c));
    }
}

/// The systems with a width, heights and a gap, so that every demand is there.
fn complete_systems() -> Vec<System> {
    let complete = |system: System| {
        let (m, n) = (&system.model, system.model.storeys());
        let block = Block { width_m: Some(0.5), height_m: Some(0.3), ..*m.block() };
        let mut slider = m.slider().clone();
        if let Ends::Open { gap_m } = &mut slider.ends {
            *gap_m = Some(0.1);
        }
        let frame = Frame { heights_m: Some(vec![0.7; n]), ..m.frame().clone() };
        let model = Model::new(block, slider, frame, m.gravity_m_per_s2(), m.initial().clone());
        let model = model.unwrap().with_contents(m.contents().to_vec()).unwrap();
        System { model, ..system }
    };
    all_systems().into_iter().map(complete).collect()
}

/// Judges a response whose demands or events were tampered with.
fn demands_must_show(system: &System, response: &Response, what: &str) {
    let c = check(&system.model, &system.motion, response);
    let (name, error) = (system.name, c.demands_error);
    assert!(error > SHOWS && !c.holds(), "{name}: {what} went unnoticed: {error:e}");
}

#[test]
fn true_demands_pass() {
    for system in complete_systems() {
        let c = check(&system.model, &system.motion, &response_of(&system));
        assert!(c.demands_error < 1e-11, "{}: {}", system.name, figures(&c));
        assert!(c.holds(), "{}: {}", system.name, figures(&c));
    }
}

#[test]
fn every_changed_demand_shows() {
    type Number = fn(&mut Demands) -> &mut f64;
    let numbers: [Number; 16] = [
        |d| &mut d.peak_sliding_displacement_m,
        |d| &mut d.peak_sliding_displacement_time_s,
        |d| &mut d.max_sliding_displacement_m,
        |d| &mut d.min_sliding_displacement_m,
        |d| &mut d.residual_sliding_displacement_m,
        |d| &mut d.sliding_path_m,
        |d| &mut d.peak_sliding_velocity_m_per_s,
        |d| &mut d.sliding_time_s,
        |d| &mut d.peak_block_acceleration_m_per_s2,
        |d| &mut d.peak_base_shear_n,
        |d| &mut d.peak_friction_force_n,
        |d| &mut d.peak_slider_force_n,
        |d| &mut d.base_shear_coefficient,
        |d| &mut d.friction_coefficient_used,
        |d| &mut d.slider_force_coefficient,
        |d| d.closest_stop.as_mut().unwrap(),
    ];
    let ratios: [fn(&mut Demands) -> &mut Option<f64>; 3] =
        [|d| &mut d.gap_ratio, |d| &mut d.overturning_ratio, |d| &mut d.closest_stop];
    let flips: [fn(&mut Demands); 8] = [
        |d| d.sliding_at_end = !d.sliding_at_end,
        |d| d.slip_count += 1,
        |d| d.reversal_count += 1,
        |d| d.stick_count -= 1,
        |d| d.storeys.push(d.storeys.last().copied().unwrap_or_default()),
        |d| d.stop = Some(Default::default()),
        |d| d.peak_slider_force_n = f64::NAN,
        |d| d.sliding_time_s = 0.0,
    ];
    for system in complete_systems() {
        let response = response_of(&system);
        let changed = |change: &dyn Fn(&mut Demands), what: &str| {
            let mut tampered = response.clone();
            change(&mut tampered.demands);
            demands_must_show(&system, &tampered, what);
        };
        for (i, number) in numbers.iter().enumerate() {
            // No storey, no base shear: 0 is what stays 0.
            for part in [1.0 + 1e-7, 1.0 - 1e-7] {
                let value = *number(&mut response.demands.clone());
                if value != 0.0 && value.abs() > 1e-3 * 1e-9 {
                    let scale = if i == 15 { 1.0 } else { value };
                    changed(&|d| *number(d) = value + scale * (part - 1.0), &format!("number {i}"));
                }
            }
        }
        for (i, ratio) in ratios.iter().enumerate() {
            // A stop has its own gap.
            if ratio(&mut response.demands.clone()).is_none() {
                continue;
            }
            changed(&|d| *ratio(d) = None, &format!("ratio {i} left out"));
            changed(&|d| *ratio(d) = ratio(d).map(|r| r + 1e-7), &format!("ratio {i}"));
        }
        for (i, flip) in flips.iter().enumerate() {
            changed(flip, &format!("flip {i}"));
        }
        for i in 0..system.model.storeys() {
            changed(&|d| d.storeys[i].peak_displacement_m *= 1.0 + 1e-7, "a displacement");
            changed(&|d| d.storeys[i].peak_drift_m *= 1.0 - 1e-7, "a drift");
            changed(&|d| d.storeys[i].peak_acceleration_m_per_s2 *= 1.0 + 1e-7, "an acceleration");
            changed(&|d| d.storeys[i].peak_drift_ratio = None, "no drift ratio");
            let faster = |d: &mut Demands| d.storeys[i].peak_drift_velocity_m_per_s *= 1.0 + 1e-7;
            changed(&faster, "a drift velocity");
            let ratio = |d: &mut Demands| d.storeys[i].peak_drift_ratio.as_mut().map(|r| *r *= 1.1);
            changed(&|d| _ = ratio(d), "a drift ratio");
        }
    }
}

#[test]
fn every_changed_event_shows() {
    for system in complete_systems() {
        let response = response_of(&system);
        let changed = |change: &dyn Fn(&mut Response), what: &str| {
            let mut tampered = response.clone();
            change(&mut tampered);
            demands_must_show(&system, &tampered, what);
        };
        let events = response.events.len();
        for i in (0..events).step_by(3) {
            changed(&|r| _ = r.events.remove(i), "an event left out");
            changed(&|r| r.events.insert(i, r.events[i]), "an event twice");
            changed(&|r| r.events[i].time_s += 1e-9, "another time");
            changed(&|r| r.events[i].sliding_displacement_m += 1e-6, "another place");
            let other = |kind| {
                if kind == EventKind::Reversal { EventKind::Slip } else { EventKind::Reversal }
            };
            changed(&|r| r.events[i].kind = other(r.events[i].kind), "another kind");
            let turned = |mode| match mode {
                Mode::Slip(Direction::Positive) => Mode::Slip(Direction::Negative),
                _ => Mode::Slip(Direction::Positive),
            };
            changed(&|r| r.events[i].mode = turned(r.events[i].mode), "another direction");
        }
    }
}
