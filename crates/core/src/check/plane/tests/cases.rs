//! The reference cases in two directions, solved through the known events.

use super::drive::{cases, drive, number, numbers, pair, system};
use crate::check::check;
use crate::response::Response;

/// The value of a key of the printed result.
fn value_of(response: &Response, key: &str) -> Option<f64> {
    let plane = response.in_plane.as_deref().unwrap();
    let (d, key) = match key.split_once('.') {
        Some(("x", rest)) => (&plane.axes[0], rest),
        Some(("y", rest)) => (&plane.axes[1], rest),
        _ => (&response.demands, key),
    };
    if let Some(rest) = key.strip_prefix("storeys[") {
        let (i, name) = rest.split_once("].").unwrap();
        let storey = &d.storeys[i.parse::<usize>().unwrap()];
        return Some(match name {
            "peak_acceleration_m_per_s2" => storey.peak_acceleration_m_per_s2,
            "peak_displacement_m" => storey.peak_displacement_m,
            "peak_drift_m" => storey.peak_drift_m,
            _ => panic!("{name}"),
        });
    }
    Some(match key {
        "peak_sliding_displacement_m" => d.peak_sliding_displacement_m,
        "peak_sliding_displacement_time_s" => d.peak_sliding_displacement_time_s,
        "residual_sliding_displacement_m" => d.residual_sliding_displacement_m,
        "peak_sliding_velocity_m_per_s" => d.peak_sliding_velocity_m_per_s,
        "sliding_path_m" => d.sliding_path_m,
        "sliding_time_s" => d.sliding_time_s,
        "slip_count" => d.slip_count as f64,
        "stick_count" => d.stick_count as f64,
        "block.peak_acceleration_m_per_s2" => d.peak_block_acceleration_m_per_s2,
        "peak_friction_force_n" => d.peak_friction_force_n,
        "peak_slider_force_n" => d.peak_slider_force_n,
        "peak_base_shear_n" => d.peak_base_shear_n,
        "least_sliding_speed_m_per_s" => plane.least_sliding_speed_m_per_s?,
        "gap_ratio" => return None,
        _ => panic!("{key}"),
    })
}

/// All states, demands and events of the cases at their tolerances, and a certificate that holds.
#[test]
fn reference_cases_are_the_judges_own() {
    let (mut wrong, mut count) = (Vec::new(), 0);
    for case in cases() {
        let system = system(&case);
        let response = drive(&system);
        let h = response.history.as_ref().unwrap();
        let plane = response.in_plane.as_ref().unwrap();
        let y = plane.history.as_ref().unwrap();
        let id = &system.id;
        let mut worst: f64 = 0.0;
        let mut close = |what: &str, found: f64, expected: f64, tolerance: f64| {
            count += 1;
            let off = (found - expected).abs();
            if tolerance > 0.0 {
                worst = worst.max(off / tolerance);
            }
            if !(off <= tolerance) {
                wrong.push(format!("{id}: {what}: {found:e}, expected {expected:e}: off {off:e}, tolerance {tolerance:e}"));
            }
        };
        for state in case["states"].as_array().unwrap() {
            let k = h.time_s.iter().position(|t| *t == number(&state["t"])).unwrap();
            let (s, w) = (pair(&state["s"]), pair(&state["w"]));
            let (tol_s, tol_w) = (number(&state["tol_s"]), number(&state["tol_w"]));
            close("s_x", h.sliding_displacement_m[k], s[0], tol_s);
            close("s_y", y.sliding_displacement_m[k], s[1], tol_s);
            close("w_x", h.sliding_velocity_m_per_s[k], w[0], tol_w);
            close("w_y", y.sliding_velocity_m_per_s[k], w[1], tol_w);
            let n = h.storeys;
            for i in 0..n {
                let (q, v) = (pair(&state["q"][i]), pair(&state["v"][i]));
                let tol_q = numbers(&state["tol_q"])[i];
                close("q_x", h.storey_displacement_m[k * n + i], q[0], tol_q);
                close("q_y", y.storey_displacement_m[k * n + i], q[1], tol_q);
                close("v_x", h.storey_velocity_m_per_s[k * n + i], v[0], number(&state["tol_v"]));
                close("v_y", y.storey_velocity_m_per_s[k * n + i], v[1], number(&state["tol_v"]));
            }
        }
        for expect in case["expect"].as_array().unwrap() {
            let key = expect["q"].as_str().unwrap();
            let tolerance = number(&expect["tol_abs"]);
            if let Some(found) = value_of(&response, key) {
                close(key, found, number(&expect["value"]), tolerance);
            }
        }
        for (event, own) in case["events"].as_array().unwrap().iter().zip(&plane.events) {
            close(
                "s_y of an event",
                own.sliding_displacement_y_m,
                number(&event["s"][1]),
                number(&event["tol_s"]),
            );
            if event["kind"] == "slip" {
                let u = pair(&event["direction"]);
                for axis in 0..2 {
                    close(
                        "direction",
                        own.direction[axis],
                        u[axis],
                        number(&event["tol_direction"]),
                    );
                }
            }
        }
        close("events", plane.events.len() as f64, number(&case["n_events"]), 0.0);
        let start = std::time::Instant::now();
        let c = check(&system.model, &system.motion, &response);
        let took = start.elapsed();
        println!(
            "{id}: worst {worst:.1e} of its tolerance; equilibrium {:.1e}, friction {:.1e}, energy {:.1e}, demands {:.1e}, {:?}, {took:?}",
            c.equilibrium_residual,
            c.friction_excess,
            c.energy_balance_error,
            c.demands_error,
            c.closest_call
        );
        let figures =
            [c.equilibrium_residual, c.friction_excess, c.energy_balance_error, c.demands_error];
        if !figures.iter().all(|figure| *figure < 1e-11) {
            wrong.push(format!("{id}: {c:?}").chars().take(400).collect());
        }
    }
    println!("{count} figures");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
