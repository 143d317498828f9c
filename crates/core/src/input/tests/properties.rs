//! Whatever bytes come, the answer is a model or an error.

use proptest::prelude::*;

use super::{FULL, SMALLEST};
use crate::input::{MAX_TEXT_BYTES, Override, from_bytes, parse};

/// Reads and renders whatever comes of it.
fn survives(bytes: &[u8]) {
    if let Err(error) = from_bytes("m.toml", bytes, &[]) {
        let text = error.to_string();
        assert!(error.place.line > 0 && error.place.column > 0 && text.len() < 2000, "{text}");
    }
}

proptest! {
    #[test]
    fn prop_any_bytes(bytes in proptest::collection::vec(any::<u8>(), 0..200)) {
        survives(&bytes);
    }

    #[test]
    fn prop_any_text(text in "\\PC*") {
        survives(text.as_bytes());
    }

    /// A valid model with a part replaced by other bytes.
    #[test]
    fn prop_mutated_model(
        at in 0..FULL.len(),
        length in 0..40_usize,
        bytes in proptest::collection::vec(prop_oneof![any::<u8>(), 32..127_u8], 0..20),
    ) {
        let mut model = FULL.as_bytes().to_vec();
        model.splice(at..(at + length).min(FULL.len()), bytes);
        survives(&model);
    }

    /// A valid model with two of its lines swapped, or one left out.
    #[test]
    fn prop_shuffled_lines(first in 0..40_usize, second in 0..40_usize, drop in any::<bool>()) {
        let mut lines: Vec<&str> = FULL.lines().collect();
        let n = lines.len();
        lines.swap(first % n, second % n);
        if drop {
            lines.remove(first % n);
        }
        survives(lines.join("\n").as_bytes());
    }

    #[test]
    fn prop_any_override(path in "[a-z_.0-9]{0,30}", value in "\\PC{0,20}") {
        if let Ok(set) = Override::parse(&format!("{path}={value}")) {
            let _ = parse("m.toml", FULL, &[set]);
        }
    }

    /// Every path of the model, set to anything.
    #[test]
    fn prop_known_paths(
        path in proptest::sample::select(vec![
            "name", "block", "block.mass", "slider", "slider.static_friction",
            "slider.static_friction.positive", "slider.bounds", "slider.bounds.lower", "storey",
            "storey.1", "storey.1.stiffness", "storey.1.damper", "storey.2.mass", "frame.period",
            "motion", "motion.channel", "motion.units", "motion.pulse.start", "motion.sine",
            "initial.storey_velocity", "initial.storey_velocity.1", "initial.storey_velocity.9",
            "analysis", "analysis.gravity", "slider.asymmetry", "slider.radius",
        ]),
        value in prop_oneof![
            "\\PC{0,12}",
            "-?[0-9]{1,3}(e-?[0-9]{1,3})?( (m|mm|s|kg|N/m|m/s2|g|Hz))?",
            Just("[]".to_owned()), Just("{}".to_owned()), Just("[{}]".to_owned()),
            Just("{positive = 1}".to_owned()), Just("[1, \"2 m\"]".to_owned()),
            Just("nan".to_owned()), Just("true".to_owned()), Just("1979-05-27".to_owned()),
        ],
        more in proptest::sample::select(vec!["slider.radius=2 m", "storey.1.mass=1 kg", "name=x"]),
    ) {
        let set = Override::parse(&format!("{path}={value}")).unwrap();
        let more = Override::parse(more).unwrap();
        for text in [FULL, SMALLEST] {
            for order in [[&set, &more], [&more, &set]] {
                let _ = parse("m.toml", text, &order.map(Clone::clone));
            }
        }
    }
}

/// Nesting as deep as the text is long neither overflows the stack nor takes for ever.
#[test]
fn deep_nesting_is_refused() {
    for unit in ["[", "{a=", "a.", "[a.", "[["] {
        survives(unit.repeat(20_000).as_bytes());
        survives(format!("a = {}", unit.repeat(20_000)).as_bytes());
        let set = format!("slider.gap={}", unit.repeat(20_000));
        let _ = parse("m.toml", FULL, &[Override::parse(&set).unwrap()]);
    }
    survives(format!("{}a = 1", "a.".repeat(20_000)).as_bytes());
    assert!(Override::parse(&format!("{}=1", "a.".repeat(20_000))).is_err());
    assert!(Override::parse(&format!("{}=1", "storey.x.".repeat(20_000))).is_err());
}

/// Lists longer than anyone models are refused at the first item too many, before anything is made of
/// them, and the schema says how long they may be.
#[test]
fn long_lists_are_refused() {
    let contents =
        "[[contents]]\nfloor = 0\nmass = \"1 kg\"\nstatic_friction = 0.2\nkinetic_friction = 0.2\n";
    let surfaces = "[block]\nmass = \"1 t\"\n[slider]\n";
    let surface = "[[slider.surface]]\nfriction = 0.1\n";
    let speeds = |count: usize| {
        let speeds: Vec<String> = (0..count).map(|i| format!("\"{i} m/s\"")).collect();
        let coefficients = vec!["0.1"; count].join(", ");
        let (speeds, kinetic) = (speeds.join(", "), "kinetic_friction.velocity");
        format!(
            "[block]\nmass = \"1 t\"\n[slider]\nstatic_friction = 0.1\n{kinetic} = [{speeds}]\n\
             kinetic_friction.coefficient = [{coefficients}]\n"
        )
    };
    let refused = |text: &str| parse("m.toml", text, &[]).unwrap_err().to_string();
    assert_eq!(
        refused(&format!("{SMALLEST}{}", contents.repeat(51))),
        "m.toml:256:1: contents.51: expected at most 50, found 51"
    );
    assert_eq!(
        refused(&format!("{surfaces}{}", surface.repeat(11))),
        "m.toml:24:1: slider.surface.11: expected at most 10, found 11"
    );
    let long = refused(&speeds(20_000));
    let expected = "slider.kinetic_friction.velocity.101: expected at most 100, found 20000";
    assert!(long.starts_with("m.toml:5:") && long.ends_with(expected), "{long}");
    for text in [
        format!("{SMALLEST}{}", contents.repeat(50)),
        format!("{surfaces}{}", surface.repeat(10)),
        speeds(100),
    ] {
        assert!(parse("m.toml", &text, &[]).is_ok());
    }
    let schema = crate::input::json_schema();
    for most in ["\"maxItems\": 200", "\"maxItems\": 50", "\"maxItems\": 10", "\"maxItems\": 100"] {
        assert!(schema.contains(&format!("{most},")), "{most}");
    }
}

/// Thousands of storeys are refused before any matrix of them is made.
#[test]
fn too_many_storeys_are_refused() {
    let storey = "[[storey]]\nmass = \"1 t\"\nstiffness = \"1 MN/m\"\ndamping_ratio = 0.02\n";
    let text = format!("{SMALLEST}{}", storey.repeat(201));
    assert_eq!(
        parse("m.toml", &text, &[]).unwrap_err().to_string(),
        "m.toml:806:1: storey.201: expected at most 200, found 201"
    );
    let most = format!("{SMALLEST}{}", storey.repeat(200));
    assert_eq!(parse("m.toml", &most, &[]).unwrap().model.storeys(), 200);
}

/// A file that cannot be a model is refused before its text is taken apart.
#[test]
fn texts_too_long_for_a_model_are_refused() {
    let text = "#".repeat(MAX_TEXT_BYTES - SMALLEST.len()) + "\n" + SMALLEST;
    assert_eq!(
        parse("m.toml", &text, &[]).unwrap_err().to_string(),
        "m.toml:1:1: expected a model of at most 1048576 bytes, found 1048577"
    );
    assert!(parse("m.toml", &text[1..], &[]).is_ok());
}
