//! What a slider can be made of, and what of it belongs to the linear system.

// Helpers of tests may panic as tests do.
#![allow(clippy::expect_used)]

use slipstick::model::{Model, ModelBuilder, Slider, Stop};
use slipstick::slider::{Direction, Ends, Friction, RateCurve, RateLaw, Surface, SurfacesInSeries};

fn surfaces() -> SurfacesInSeries {
    let surface =
        |friction, radius_m| Surface { radius_m: Some(radius_m), friction, travel_m: None };
    SurfacesInSeries::new(vec![surface(0.03, 0.5), surface(0.06, 2.0)], 1.5).expect("surfaces")
}

fn by_speed(fixed: f64, fast: f64) -> Friction {
    let curve = RateCurve::Exponential { slow: 0.03, fast, rate_s_per_m: 25.0 };
    let rate = RateLaw::new(curve, [1.0, 0.5]).expect("a rate law");
    Friction::by_speed([fixed; 2], rate).expect("friction")
}

fn on(slider: Slider) -> Model {
    let plain = Model::rigid_block(100.0, Friction::new(0.1, 0.1).expect("friction"));
    let plain = plain.expect("a model");
    let (block, frame, initial) = (*plain.block(), plain.frame().clone(), plain.initial().clone());
    Model::new(block, slider, frame, 10.0, initial).expect("a model")
}

#[test]
fn what_excludes_another_is_refused() {
    let block = || Model::builder().block("1 t");
    let stop = Stop::rigid([Some(0.1); 2], 0.5);
    assert!(block().surfaces(surfaces()).build().is_ok());
    let cases: [(ModelBuilder, &str); 4] = [
        (block().surfaces(surfaces()).spring("1 kN/m"), "spring"),
        (block().surfaces(surfaces()).radius("1 m"), "radius"),
        (block().surfaces(surfaces()).friction(0.1, 0.1), "friction"),
        (block().friction(0.1, 0.1).gap("0.1 m").stop(stop), "slider gap_m"),
    ];
    for (builder, quantity) in cases {
        let error = builder.build().expect_err(quantity).to_string();
        assert!(error.starts_with(quantity), "{error}");
    }
}

#[test]
fn coefficients_are_those_at_rest_and_of_the_first_surface_to_slide() {
    let model = on(Slider::new(by_speed(0.04, 0.06)));
    assert_eq!([model.static_friction(), model.kinetic_friction()], [[0.04; 2], [0.03, 0.015]]);
    let model = on(Slider::in_series(surfaces()));
    assert_eq!([model.static_friction(), model.kinetic_friction()], [[1.5 * 0.03; 2], [0.03; 2]]);
    let twice = model.with_friction_times(2.0).expect("a model");
    assert_eq!(twice.kinetic_friction(), [0.06; 2]);
    // A lower bound of friction may be none.
    let none = model.with_friction_times(0.0).expect("a model");
    assert_eq!(none.kinetic_friction(), [0.0; 2]);
    assert!(model.with_friction_times(-1.0).is_err());
    let kept = model.with_friction(Friction::new(0.2, 0.2).expect("friction"));
    assert_eq!(kept, model);
}

#[test]
fn a_pendulum_is_a_spring_of_its_weight_over_its_radius() {
    let friction = || Friction::new(0.1, 0.1).expect("friction");
    let model = on(Slider::pendulum(friction(), 2.0));
    assert_eq!(model.slider_stiffness_n_per_m(), 100.0 * 10.0 / 2.0);
    // Its spring follows the normal force where that varies, and where friction follows the speed.
    let slider = model.slider();
    assert_eq!([false, true].map(|varying| slider.pendulum_radius_m(varying)), [None, Some(2.0)]);
    let slider = Slider::pendulum(by_speed(0.04, 0.06), 2.0);
    assert_eq!(slider.pendulum_radius_m(false), Some(2.0));
    assert_eq!(on(Slider::in_series(surfaces())).slider_stiffness_n_per_m(), 0.0);
}

#[test]
fn sliders_that_share_a_linear_system() {
    let plain = |mu| Slider::sprung(Friction::new(mu, mu).expect("friction"), 500.0);
    let open = |gap_m| Slider { ends: Ends::Open { gap_m }, ..plain(0.1) };
    let stop = |gap_m| Slider { ends: Stop::elastic([gap_m; 2], 1e4, 0.0).into(), ..plain(0.1) };
    let share = |a: Slider, b: Slider| on(a).has_system_of(&on(b));
    assert!(share(plain(0.1), plain(0.2)));
    assert!(share(open(None), open(Some(0.2))));
    assert!(share(Slider::new(by_speed(0.04, 0.06)), Slider::new(by_speed(0.05, 0.06))));
    assert!(!share(Slider::new(by_speed(0.04, 0.06)), Slider::new(by_speed(0.04, 0.07))));
    assert!(!share(stop(Some(0.1)), stop(Some(0.2))));
    assert!(!share(stop(Some(0.1)), open(None)));
    assert!(!share(plain(0.1), Slider { damper_n_s_per_m: 1.0, ..plain(0.1) }));
    assert!(!share(plain(0.1), Slider::in_series(surfaces())));
}

#[test]
fn friction_that_no_surface_has_is_refused() {
    for (fixed, kinetic) in
        [([0.1, -0.1], [0.1; 2]), ([0.1, 0.05], [0.08; 2]), ([f64::NAN; 2], [0.0; 2])]
    {
        assert!(Friction::by_direction(fixed, kinetic).is_err(), "{fixed:?} {kinetic:?}");
    }
    let rate = by_speed(0.04, 0.06).rate().expect("a rate law").clone();
    let error = Friction::by_speed([0.04, 0.01], rate).unwrap_err().to_string();
    assert!(error.starts_with("kinetic_friction (negative)"), "{error}");
    let scaled = by_speed(0.04, 0.06).scaled(0.5).expect("friction");
    assert_eq!(scaled.kinetic_coefficient(Direction::Negative), 0.5 * 0.5 * 0.03);
    assert!(scaled.scaled(-1.0).is_err());
}
