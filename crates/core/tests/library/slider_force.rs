//! The force of the whole slider at the knots of a history.

// Helpers of tests may panic as tests do.
#![allow(clippy::expect_used)]

use slipstick::input;
use slipstick::solver;

fn history_and_peak(text: &str) -> (slipstick::model::Model, slipstick::response::Response) {
    let analysis = input::parse("m", text, &[]).expect("a model");
    let values = (0..400).map(|i| 4.0 * libm::sin(0.03 * f64::from(i))).collect();
    let motion =
        slipstick::motion::GroundMotion::evenly_spaced(0.01, values, None).expect("a motion");
    let response = solver::exact(&analysis.model, &motion).expect("a response");
    (analysis.model, response)
}

const SLIDER: &str = "[block]\nmass = \"2 t\"\n[slider]\nstatic_friction = 0.06\n\
    kinetic_friction = 0.05\nspring = \"40 kN/m\"\ndamper = \"3 kN s/m\"\n";

/// Its own parts: friction, `K₁ s` and `C₁ ṡ`.
#[test]
fn slider_force_is_the_sum_of_its_parts() {
    let text =
        format!("{SLIDER}[[storey]]\nmass = \"1 t\"\nperiod = \"0.4 s\"\ndamping_ratio = 0.02\n");
    let (model, response) = history_and_peak(&text);
    let history = response.history.expect("a history");
    for knot in 0..history.len() {
        let force_n = history.slider_force_n(&model, knot);
        let parts = 40e3 * history.sliding_displacement_m[knot]
            + 3e3 * history.sliding_velocity_m_per_s[knot]
            - history.friction_force_n[knot];
        assert!((force_n - parts).abs() < 1e-9 * response.demands.peak_slider_force_n);
    }
}

/// What stands on the block pulls at its slider too: the peak that the run reports is reached.
#[test]
fn slider_force_counts_contents() {
    let contents =
        "[[contents]]\nfloor = 0\nmass = \"1 t\"\nstatic_friction = 0.3\nkinetic_friction = 0.2\n";
    let (model, response) = history_and_peak(&format!("{SLIDER}{contents}"));
    let history = response.history.expect("a history");
    let force_n = (0..history.len()).map(|knot| history.slider_force_n(&model, knot));
    let peak_n = force_n.fold(0.0, |m: f64, f| m.max(f.abs()));
    let told_n = response.demands.peak_slider_force_n;
    assert!(peak_n <= told_n * (1.0 + 1e-12) && peak_n > 0.999 * told_n, "{peak_n} {told_n}");
}
