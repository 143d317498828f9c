//! Derivatives laid out: percentages where they say something.

use slipstick::assessment::suite::Suite;
use slipstick::input;
use slipstick::input::loaded::Loaded;
use slipstick::motion::GroundMotion;
use slipstick::requests::{Kind, On, Request, Results};
use slipstick::study::engine::Engine;
use slipstick_report::DisplayUnits;
use slipstick_report::assessment::{Sheet, answer};

/// The answer to a sensitivity of a block on a pendulum under a fading wave, and its residual over its peak.
fn sheet(radius: &str) -> (Sheet, f64) {
    let text = format!(
        "[block]\nmass = \"10 t\"\n[slider]\nstatic_friction = 0.05\nkinetic_friction = 0.05\n{radius}"
    );
    let wave = |k: u32| {
        let t = 0.02 * f64::from(k);
        3.0 * libm::sin(4.0 * t) * libm::sin(9.0 * t) * libm::exp(-0.3 * t)
    };
    let motion = GroundMotion::evenly_spaced(0.02, (0..400).map(wave).collect(), None);
    let loaded = Loaded::made(motion.expect("a motion"), "wave".to_owned());
    let suite = Suite::of([("wave".to_owned(), loaded)], false);
    let analysis = input::parse("m.toml", &text, &[]).expect("a model");
    let (name, source, text, set) = ("m", "m.toml", &text[..], &[][..]);
    let on = On { name, source, text, set, analysis: &analysis, suite: &suite };
    let asked = Request::new(Kind::Sensitivity, []).expect("a request");
    let found = asked.run(&on, &Engine::unwatched()).expect("an answer");
    let Results::Sensitivity(run) = &found.found else { panic!("derivatives") };
    let value = |name: &str| {
        let place = run.demands.iter().position(|demand| demand.name() == name);
        let of = run.derivatives.iter().find(|d| Some(d.demand) == place).expect("a derivative");
        of.value.abs()
    };
    let ratio = value("residual_sliding_displacement_m") / value("peak_sliding_displacement_m");
    (answer::sheet(&found, DisplayUnits::Si), ratio)
}

/// The column of percentages of a demand.
fn percentages(sheet: &Sheet, demand: &str) -> Vec<String> {
    let table = sheet.tables.iter().find(|(heading, _)| heading == demand).expect(demand);
    let place = table.1[0].iter().position(|head| head == "% for 1 %").expect("a column");
    table.1[1..].iter().map(|row| row[place].clone()).collect()
}

/// A residual that is next to nothing beside the peak has no percentage, and a note says so; one that is not has.
#[test]
fn a_residual_near_zero_has_no_percentage() {
    let note = "No percentage is given of residuals below 5 % of the peak sliding displacement.";
    for (radius, tiny) in [("radius = \"0.3 m\"\n", true), ("", false)] {
        let (sheet, ratio) = sheet(radius);
        assert_eq!(ratio < 0.05, tiny, "{ratio}");
        let residual = percentages(&sheet, "Residual sliding displacement");
        assert_eq!(residual.iter().all(|cell| cell == "—"), tiny, "{ratio}: {residual:?}");
        let peak = percentages(&sheet, "Peak sliding displacement");
        assert!(peak.iter().all(|cell| cell != "—"), "{peak:?}");
        assert_eq!(sheet.notes.iter().any(|said| said == note), tiny, "{:?}", sheet.notes);
    }
}
