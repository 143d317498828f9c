//! Orders of convergence: of the stepwise method, and of sampling a sine by straight lines.

// Helpers of tests may panic as tests do.
#![allow(clippy::expect_used)]

use crate::common::cases::{case, cycles};
use crate::common::compare::{by_reference, of_response};
use crate::common::random::Random;
use crate::common::sketch::Sketch;
use crate::common::values::values;
use slipstick::model::{Model, Slider, Stop};
use slipstick::motion::GroundMotion;
use slipstick::slider::{Direction, Friction, RateCurve, RateLaw};
use slipstick::solver::{exact, stepwise};

/// The same straight lines with every interval divided into `parts`.
fn subdivided(motion: &GroundMotion, parts: usize) -> GroundMotion {
    let (t, a) = (motion.times_s(), motion.horizontal_m_per_s2());
    let dt_s = t[1] / parts as f64;
    let count = (t.len() - 1) * parts;
    let value = |k: usize| {
        let (i, x) = (k / parts, (k % parts) as f64 / parts as f64);
        if x == 0.0 { a[i] } else { a[i] + (a[i + 1] - a[i]) * x }
    };
    let up = motion.vertical_m_per_s2().map(|up| {
        let at = |k: usize| {
            let (i, x) = (k / parts, (k % parts) as f64 / parts as f64);
            if x == 0.0 { up[i] } else { up[i] + (up[i + 1] - up[i]) * x }
        };
        (0..=count).map(at).collect()
    });
    GroundMotion::evenly_spaced(dt_s, (0..=count).map(value).collect(), up).expect("a motion")
}

/// A block with one storey under straight lines 0.16 s long, sliding or held.
fn mock_up(random: &mut Random, slides: bool) -> Sketch {
    let friction = if slides { random.between(0.05, 0.1) } else { 1e3 };
    let mut x = Sketch::block(friction * 1.2, friction);
    x.masses = vec![random.between(20.0, 100.0)];
    let rate = random.between(4.0, 10.0);
    x.stiffnesses = vec![x.masses[0] * rate * rate];
    x.v = vec![0.0];
    x.shake(random, 12, 0.16, 4.0);
    // No jump at t = 0: the program starts from the first sample at rest.
    x.horizontal[0] = 0.0;
    x
}

/// Root mean squares over many systems of the error of the stepwise method at the last sample over
/// the peak, with every straight line in so many parts: of the sliding displacement, or of the
/// storey's where nothing slides.
fn stepwise_errors(parts: &[usize], slides: bool) -> Vec<f64> {
    errors_of(parts, slides, |index| mock_up(&mut Random::new(index), slides).build())
}

fn errors_of(
    parts: &[usize],
    slides: bool,
    system: impl Fn(u64) -> (Model, GroundMotion),
) -> Vec<f64> {
    let (last, peak) = if slides { ("final_z", "peak_abs_z") } else { ("final_y", "peak_abs_y") };
    let mut sums = vec![0.0; parts.len()];
    let mut systems = 0;
    for index in 0..80 {
        let (model, motion) = system(index);
        let wanted = of_response(&model, &exact(&model, &motion).expect("a response")).numbers;
        // The iteration of the method need not settle where stick and slip take turns in it.
        let error = |&parts: &usize| {
            let found = stepwise(&model, &subdivided(&motion, parts)).ok()?;
            let found = of_response(&model, &found).numbers;
            Some((found[last] - wanted[last]) / wanted[peak])
        };
        let Some(errors) = parts.iter().map(error).collect::<Option<Vec<f64>>>() else { continue };
        sums.iter_mut().zip(errors).for_each(|(sum, error)| *sum += error * error);
        systems += 1;
    }
    assert!(systems >= 40, "only {systems} systems where the iteration settles");
    sums.into_iter().map(|sum| (sum / f64::from(systems)).sqrt()).collect()
}

/// Mean order over halvings of the step.
fn order(errors: &[f64]) -> f64 {
    let first_to_last = errors[0] / errors[errors.len() - 1];
    libm::log2(first_to_last) / (errors.len() - 1) as f64
}

/// The trapezoidal rule: half the step, a quarter of the error.
#[test]
fn order_stepwise_without_events_is_two() {
    let errors = stepwise_errors(&[16, 32, 64, 128], false);
    let order = order(&errors);
    assert!((order - 2.0).abs() < 0.1, "order {order:.2} from {errors:?}");
}

/// Stops and releases are noticed at the next sample: the error of a single run jumps about, that
/// of many falls with the step.
#[test]
fn order_stepwise_with_events_is_one() {
    let errors = stepwise_errors(&[8, 16, 32, 64, 128, 256], true);
    let order = order(&errors);
    assert!((order - 1.0).abs() < 0.2, "order {order:.2} from {errors:?}");
}

/// Friction by the speed, an elastic stop, and a pendulum under vertical motion are taken as forces at
/// samples.
#[test]
fn order_stepwise_with_devices_is_one() {
    let pieces = RateCurve::Pieces {
        speeds_m_per_s: vec![0.0, 0.05, 0.2],
        coefficients: vec![0.04, 0.06, 0.08],
    };
    let exponential = RateCurve::Exponential { slow: 0.04, fast: 0.09, rate_s_per_m: 20.0 };
    let by_speed = |slider: Slider, curve: &RateCurve| {
        let fixed = slider.friction().expect("friction").clone();
        let fixed = Direction::BOTH.map(|direction| fixed.static_coefficient(direction));
        let rate = RateLaw::new(curve.clone(), [1.0; 2]).expect("a rate law");
        slider.with_friction(Friction::by_speed(fixed, rate).expect("friction"))
    };
    let stop = Stop::elastic([Some(0.01); 2], 2e4, 100.0);
    let changes: [(&str, &dyn Fn(Slider) -> Slider); 4] = [
        ("friction in pieces", &|slider| by_speed(slider, &pieces)),
        ("exponential friction", &|slider| by_speed(slider, &exponential)),
        ("a pendulum", &|slider| {
            let friction = slider.friction().expect("friction").clone();
            Slider { bearing: Slider::pendulum(friction, 1.5).bearing, ..slider }
        }),
        ("an elastic stop", &|slider| Slider { ends: stop.into(), ..slider }),
    ];
    for (what, change) in changes {
        let parts = [16, 32, 64, 128, 256];
        let errors = errors_of(&parts, true, |index| {
            let random = &mut Random::new(index);
            let mut x = mock_up(random, true);
            if what == "a pendulum" {
                x.lift(random, 4.0);
                x.set_spring((x.gravity / 1.5).sqrt());
            }
            let (model, motion) = x.build();
            let slider = change(model.slider().clone());
            let (block, frame) = (*model.block(), model.frame().clone());
            let model = Model::new(block, slider, frame, x.gravity, model.initial().clone())
                .expect("a model");
            (model, motion)
        });
        let order = order(&errors);
        assert!((order - 1.0).abs() < 0.3, "{what}: order {order:.2} from {errors:?}");
    }
}

fn assert_order_two(what: &str, errors: &[f64]) {
    for pair in errors.windows(2) {
        let order = libm::log2(pair[0] / pair[1]);
        assert!((order - 2.0).abs() < 0.15, "{what}: order {order:.2} from {errors:?}");
    }
}

/// Limit cycles and drift of sines sampled 100, 200, … times a cycle.
#[test]
fn order_of_sampling_limit_cycles_is_two() {
    let solve = |model: &Model, motion: &GroundMotion| {
        of_response(model, &exact(model, motion).expect("a response"))
    };
    for (id, name) in [
        ("HARM-ETA-0.6", "half_pp_z"),
        ("HARM-ETA-0.8", "half_pp_z"),
        ("HARM-MUSD-0.6-0.4", "half_pp_z"),
        ("HARM-START-0.3-45", "offset"),
        ("HARM-START-0.7-90", "max_abs_z"),
        ("DENHARTOG-FORCED-1.5-0.3", "half_pp_z"),
        ("TILT-DRIFT-2", "drift_per_cycle"),
        ("TILT-DRIFT-5", "drift_per_cycle"),
        ("VERT-DRIFT-1", "drift_per_cycle"),
    ] {
        let case = case(id);
        let expected = case.list("expect").iter().find(|e| e["q"] == name).expect("a value");
        let wanted = expected["value"].as_f64().expect("a number");
        let errors =
            [200, 400, 800].map(|per_cycle| (values(&case, solve, per_cycle)[name] - wanted).abs());
        assert_order_two(&format!("{id} {name}"), &errors);
    }
}

/// The steady state of an oscillator on a held block.
#[test]
fn order_of_sampling_a_held_oscillator_is_two() {
    let mut x = Sketch::block(1e3, 1e3);
    x.masses = vec![50.0];
    x.stiffnesses = vec![50.0 * 36.0];
    x.v = vec![0.0];
    x.times = vec![0.0, 1.0];
    x.horizontal = vec![0.0, 0.0];
    let (model, _) = x.build();
    // From rest under sin 5t: q = (sin 5t − 5/6 sin 6t) / (25 − 36).
    let end_s = 4.0 * std::f64::consts::TAU / 5.0;
    let wanted = -(5.0 / 6.0) * libm::sin(6.0 * end_s) / (25.0 - 36.0);
    let errors = [50, 100, 200, 400].map(|per_cycle| {
        let motion = cycles([1.0, 5.0, 0.0], None, per_cycle, 0, 4);
        let response = exact(&model, &motion).expect("a response");
        (of_response(&model, &response).numbers["final_y"] - wanted).abs()
    });
    assert_order_two("held oscillator", &errors);
}

/// The reference of these tests stands on its own: it shows the same order.
#[test]
fn order_of_sampling_is_two_by_the_reference_too() {
    let case = case("HARM-START-0.7-90");
    let wanted = case.list("expect")[0]["value"].as_f64().expect("a number");
    let name = case.list("expect")[0]["q"].as_str().expect("a name").to_owned();
    let errors = [100, 200, 400].map(|n| (values(&case, by_reference, n)[&name] - wanted).abs());
    assert_order_two("reference", &errors);
}
