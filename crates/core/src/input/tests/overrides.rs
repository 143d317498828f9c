//! Keys set from outside the file.

use super::{FULL, SMALLEST, read};
use crate::input::{InputValue, MotionSource, Override, from_values, parse};
use crate::model::Damping;

/// The value in use at a path after keys were set.
fn value(text: &str, set: &[&str], path: &str) -> Option<f64> {
    read(text, set).unwrap().value(path)
}

#[test]
fn values_are_toml_or_else_text() {
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
fn storeys_and_lists_count_from_one() {
    assert_eq!(value(FULL, &["storey.1.mass=90 kg"], "storey.1.mass"), Some(90.0));
    let path = "initial.storey_displacement.1";
    assert_eq!(value(FULL, &["initial.storey_displacement.1=7 mm"], path), Some(0.007));
    assert_eq!(value(FULL, &["initial.storey_displacement=[\"8 mm\"]"], path), Some(0.008));
}

#[test]
fn missing_tables_are_made() {
    let analysis = read(SMALLEST, &["analysis.tail=3 s", "motion.record=taft.txt"]).unwrap();
    assert_eq!(analysis.tail_s, 3.0);
    assert!(matches!(analysis.motion, Some(MotionSource::Record(_))));
}

#[test]
fn setting_a_key_removes_what_excludes_it() {
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
fn setting_one_direction_keeps_the_other() {
    let model = read(FULL, &["slider.static_friction.positive=0.03"]).unwrap().model;
    assert_eq!(model.static_friction(), [0.03, 0.02]);
    assert_eq!(model.kinetic_friction(), [0.012, 0.012]);
}

#[test]
fn numbers_are_set_bit_for_bit() {
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
fn messages_point_into_the_option() {
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
        "--set storey.2.mass=…:1:1: storey.2.mass: expected storey.1, for there is only one, found \"2\""
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

#[test]
fn stops_are_set_by_path() {
    let stop = ["slider.stop.gap=150 mm", "slider.stop.stiffness=40 kN/mm"];
    assert!(
        read(FULL, &stop[..1])
            .unwrap_err()
            .contains("slider.stop: expected one of the keys stiffness")
    );
    let analysis = read(FULL, &stop).unwrap();
    assert_eq!((analysis.model.slider().gap_m(), analysis.value("slider.gap")), (None, None));
    let gap_m = |set: &[&str]| read(FULL, set).unwrap().model.stop().unwrap().gap_m;
    let side = "slider.stop.gap.negative=0.1 m";
    assert_eq!(gap_m(&[stop[0], stop[1], side]), [Some(0.15), Some(0.1)]);
    assert_eq!(gap_m(&[side, stop[1]]), [None, Some(0.1)]);
    let back = read(FULL, &[stop[0], stop[1], "slider.gap=1 m"]).unwrap();
    assert_eq!((back.model.stop(), back.model.slider().gap_m()), (None, Some(1.0)));
    let damped = [stop[0], stop[1], "slider.stop.damper=1 kN s/m", "slider.stop.damping_ratio=0"];
    assert_eq!(read(FULL, &damped).unwrap().value("slider.stop.damper"), None);
    let written = read(FULL, &[stop[1], side]).unwrap().to_toml(None);
    assert!(read(&written, &[]).unwrap().model.stop().is_some(), "{written}");
}

/// Where no option gave a value, its error names the key alone.
#[test]
fn messages_of_values_name_the_key() {
    let message = |set: Override| parse("m.toml", FULL, &[set]).unwrap_err().to_string();
    assert_eq!(
        message(Override::number("slider.gap", -0.1).unwrap()),
        "slider.gap: expected a finite length > 0, found \"-0.1 m\""
    );
    assert_eq!(
        message(Override::number("slider.kinetic_friction", 0.03).unwrap()),
        "slider.kinetic_friction: expected at most the static friction 0.02, found 0.03"
    );
    assert_eq!(
        message(Override::text_value("slider.gap", "150").unwrap()),
        "slider.gap: expected a length with its unit, such as \"150 mm\", found 150"
    );
    assert_eq!(
        Override::number("slider.gpa", 1.0).unwrap_err().to_string(),
        "expected a path of the model, found \"slider.gpa\"; nearest is \"slider.gap\""
    );
}

/// The values of a model file, as numbers in SI or as their texts, make the same model without it.
#[test]
fn models_are_made_of_values() {
    let whole = parse("m.toml", FULL, &[]).unwrap();
    let as_texts: Vec<_> =
        whole.inputs().map(|input| (input.path, InputValue::Text(input.text))).collect();
    let as_numbers: Vec<_> = whole
        .inputs()
        .map(|input| match input.value {
            Some(number) => (input.path, InputValue::Number(number)),
            None => (input.path, InputValue::Text(input.text)),
        })
        .collect();
    for values in [as_texts, as_numbers] {
        let made = from_values(&values).unwrap();
        assert_eq!((&made.model, &made.motion), (&whole.model, &whole.motion));
        assert_eq!((made.tail_s, made.name), (whole.tail_s, whole.name.clone()));
    }
    let refused = |values: &[(&str, InputValue<'_>)]| from_values(values).unwrap_err().to_string();
    let found = refused(&[("storey.2.mass", InputValue::Number(1.0))]);
    assert_eq!(found, "storey.2.mass: expected storey.1, for there is none yet, found \"2\"");
    let both = [
        ("block.mass", InputValue::Number(1.0)),
        ("slider.static_friction", InputValue::Number(0.2)),
        ("slider.kinetic_friction", InputValue::Number(0.1)),
        ("slider.radius", InputValue::Number(2.0)),
        ("slider.spring", InputValue::Text("1 kN/m")),
    ];
    assert_eq!(
        refused(&both),
        "slider.spring: expected only one of spring, radius, period, found \"spring\" besides \"radius\""
    );
    assert_eq!(refused(&both[..1]), "slider: expected a table [slider], found nothing");
}

/// What the file does not have is added key by key; what it has keeps its length.
#[test]
fn the_first_of_a_list_is_added() {
    let text = "[block]\nmass = \"1 t\"\n[slider]\nstatic_friction = 0.1\nkinetic_friction = 0.1\n";
    let with = |set: &[&str]| {
        let set: Vec<Override> = set.iter().map(|one| Override::parse(one).unwrap()).collect();
        parse("m.toml", text, &set)
    };
    let first = ["contents.1.floor=0", "contents.1.mass=200 kg", "contents.1.static_friction=0.3"];
    let refused = with(&first).unwrap_err().to_string();
    assert!(refused.contains("contents.1.kinetic_friction: expected"), "{refused}");
    let one = [&first[..], &["contents.1.kinetic_friction=0.25"]].concat();
    let found = with(&one).unwrap().model;
    assert_eq!(found.contents().len(), 1);
    let second = one.iter().map(|key| key.replace("contents.1", "contents.2"));
    let both: Vec<String> = one.iter().map(|key| (*key).to_owned()).chain(second).collect();
    let both: Vec<&str> = both.iter().map(String::as_str).collect();
    assert_eq!(with(&both).unwrap().model.contents().len(), 2);
    let refused = with(&both[4..]).unwrap_err().to_string();
    assert_eq!(
        refused,
        "contents.2.floor: expected contents.1, for there is none yet, found \"2\""
    );
}

/// Keys and items of lists are taken out; a list grows by one where that is asked for.
#[test]
fn keys_are_taken_out_and_lists_grow() {
    let text = "[block]\nmass = \"1 t\"\n[slider]\nstatic_friction = 0.1\nkinetic_friction = 0.1\n\
                spring = \"9 kN/m\"\ndamping_ratio = 0.1\n[[storey]]\nmass = \"1 t\"\n\
                period = \"1 s\"\ndamping_ratio = 0.02\n";
    let with = |set: &[Override]| parse("m.toml", text, set);
    let removed = |path: &str| with(&[Override::removal(path).unwrap()]);
    assert_eq!(removed("storey.1").unwrap().model.storeys(), 0);
    assert_eq!(removed("storey").unwrap().model.storeys(), 0);
    let bare = [Override::removal("slider.damping_ratio"), Override::removal("slider.spring")];
    let bare = with(&bare.map(Result::unwrap)).unwrap();
    assert_eq!(bare.model.slider_stiffness_n_per_m(), 0.0);
    assert_eq!(
        removed("slider.radius").unwrap_err().to_string(),
        "slider.radius: expected a key that stands in the model, found \"slider.radius\""
    );
    let second = |growing: bool| {
        let one = |path: &str, text: &str| {
            let set = Override::text_value(path, text).unwrap();
            if growing { set.growing() } else { set }
        };
        let keys = [("mass", "1 t"), ("stiffness", "9 kN/mm"), ("damping_ratio", "0.02")];
        let mut set: Vec<Override> =
            keys.map(|(key, text)| one(&format!("storey.2.{key}"), text)).to_vec();
        set.push(one("storey.1.stiffness", "9 kN/mm"));
        with(&set)
    };
    assert_eq!(second(true).unwrap().model.storeys(), 2);
    assert!(second(false).is_err());
    assert_eq!(
        with(&[]).unwrap().canonical(),
        parse("m.toml", &text.replace("\"1 t\"", "\"1000 kg\""), &[]).unwrap().canonical()
    );
}
