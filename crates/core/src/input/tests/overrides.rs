//! Keys set from outside the file.

use super::{FULL, SMALLEST, read};
use crate::input::{MotionSource, Override, parse};
use crate::model::Damping;

/// The value in use at a path after keys were set.
fn value(text: &str, set: &[&str], path: &str) -> Option<f64> {
    read(text, set).unwrap().value(path)
}

#[test]
fn exact_values_are_toml_or_else_text() {
    for set in ["slider.gap=50 mm", "slider.gap=\"50 mm\"", " slider.gap = 50 mm "] {
        assert_eq!(value(FULL, &[set], "slider.gap"), Some(0.05), "{set}");
    }
    assert_eq!(
        value(FULL, &["slider.kinetic_friction=0.01"], "slider.kinetic_friction"),
        Some(0.01)
    );
    assert_eq!(read(FULL, &["name=Tank 7"]).unwrap().name.as_deref(), Some("Tank 7"));
    assert_eq!(value(FULL, &["slider.gap=1 m", "slider.gap=2 m"], "slider.gap"), Some(2.0));
}

#[test]
fn exact_storeys_and_lists_count_from_one() {
    assert_eq!(value(FULL, &["storey.1.mass=90 kg"], "storey.1.mass"), Some(90.0));
    let path = "initial.storey_displacement.1";
    assert_eq!(value(FULL, &["initial.storey_displacement.1=7 mm"], path), Some(0.007));
    assert_eq!(value(FULL, &["initial.storey_displacement=[\"8 mm\"]"], path), Some(0.008));
}

#[test]
fn exact_missing_tables_are_made() {
    let analysis = read(SMALLEST, &["analysis.tail=3 s", "motion.record=taft.txt"]).unwrap();
    assert_eq!(analysis.tail_s, 3.0);
    assert!(matches!(analysis.motion, Some(MotionSource::Record(_))));
}

#[test]
fn exact_setting_a_key_removes_what_excludes_it() {
    let radius = read(FULL, &["slider.radius=2.2 m"]).unwrap();
    assert_eq!(radius.value("slider.spring"), None);
    let damper = read(FULL, &["storey.1.damper=9 N s/m"]).unwrap();
    assert_eq!(damper.model.frame().damping, Damping::Dampers(vec![9.0]));
    let stiff = read(FULL, &["storey.1.stiffness=4.7 kN/m"]).unwrap();
    assert_eq!(stiff.model.frame().stiffnesses_n_per_m, [4700.0]);
    let scale = read(FULL, &["motion.scale=2"]).unwrap();
    assert_eq!(scale.value("motion.scale_to"), None);
    // The keys that belong to the record go with it.
    let set =
        ["motion.sine={frequency=\"1 Hz\",amplitude=\"1 m/s2\",duration=\"1 s\",dt=\"1 ms\"}"];
    assert!(matches!(read(FULL, &set).unwrap().motion, Some(MotionSource::Sine(_))));
    let scaled = ["motion.vertical_scale=2", set[0]];
    assert!(matches!(read(FULL, &scaled).unwrap().motion, Some(MotionSource::Sine(_))));
    let both = [set[0], "motion.record=taft.txt"];
    assert!(matches!(read(FULL, &both).unwrap().motion, Some(MotionSource::Record(_))));
}

/// A coefficient for both directions becomes one for each; asymmetry is another way to say so.
#[test]
fn exact_setting_one_direction_keeps_the_other() {
    let model = read(FULL, &["slider.static_friction.positive=0.03"]).unwrap().model;
    assert_eq!(model.static_friction(), [0.03, 0.02]);
    assert_eq!(model.kinetic_friction(), [0.012, 0.012]);
}

#[test]
fn exact_numbers_are_set_bit_for_bit() {
    for (path, number) in [
        ("slider.kinetic_friction", 0.1 * 0.11),
        ("slider.spring", 1e5 / 3.0),
        ("slider.damping_ratio", 1e-7),
        ("storey.1.mass", 1e16 / 3.0),
        ("motion.scale", -1.0),
        ("initial.storey_velocity.1", 0.1 + 0.2),
    ] {
        let set = Override::number(path, number).unwrap();
        assert_eq!(set.path(), path);
        let analysis = parse("m.toml", FULL, &[set]).unwrap();
        assert_eq!(analysis.value(path), Some(number), "{path}");
    }
}

#[test]
fn exact_messages_point_into_the_option() {
    let refused = |set: &str| read(FULL, &[set]).unwrap_err();
    assert_eq!(
        refused("slider.kinetic_friction=0.03"),
        "--set slider.kinetic_friction=…:1:25: slider.kinetic_friction: expected at most the \
         static friction 0.02, found 0.03"
    );
    assert_eq!(
        refused("slider.gap=150"),
        "--set slider.gap=…:1:12: slider.gap: expected a length with its unit, such as \"150 mm\", \
         found 150"
    );
    assert_eq!(
        refused("slider.gpa=1 m"),
        "--set slider.gpa=…:1:1: expected a path of the model, found \"slider.gpa\"; nearest is \
         \"slider.gap\""
    );
    assert_eq!(
        refused("kinetic_friction=0.01"),
        "--set kinetic_friction=…:1:1: expected a path of the model, found \"kinetic_friction\"; \
         nearest is \"slider.kinetic_friction\""
    );
    assert_eq!(
        refused("storeys.1.mass=1 t"),
        "--set storeys.1.mass=…:1:1: expected a path of the model, found \"storeys.1.mass\"; \
         nearest is \"storey.1.mass\""
    );
    assert_eq!(
        refused("storey.mass=1 t"),
        "--set storey.mass=…:1:1: expected a number from 1 after storey, found \"storey.mass\"; \
         nearest is \"storey.1.mass\""
    );
    assert_eq!(
        refused("storey.2.mass=1 t"),
        "--set storey.2.mass=…:1:1: storey.2.mass: expected a number from 1 to 1, found \"2\""
    );
    assert_eq!(
        refused("slider.gap.x=1 m"),
        "--set slider.gap.x=…:1:1: expected no key inside slider.gap, found \"slider.gap.x\"; \
         nearest is \"slider.gap\""
    );
    assert_eq!(refused("slider.gap"), "--set slider.gap:1:11: expected PATH=VALUE, found no \"=\"");
    assert_eq!(
        refused("motion.sine.frequency=1 Hz"),
        "--set motion.sine.frequency=…:1:1: motion.sine.amplitude: expected an acceleration with \
         its unit, such as \"0.3 g\", found nothing"
    );
}
