//! Every kind of fault, where it is and in which words.

use super::{FULL, SMALLEST, read, with};
use crate::error::MotionError;
use crate::input::MotionSource;

fn refused(text: &str) -> String {
    read(text, &[]).unwrap_err()
}

/// The full example with one piece of text replaced.
fn changed(from: &str, to: &str) -> String {
    assert!(FULL.contains(from), "{from}");
    refused(&FULL.replacen(from, to, 1))
}

/// The smallest model with `to` in place of `from`.
fn small(from: &str, to: &str) -> String {
    assert!(SMALLEST.contains(from), "{from}");
    refused(&SMALLEST.replacen(from, to, 1))
}

#[test]
fn unknown_keys_at_any_depth() {
    assert_eq!(
        changed("spring = ", "sprng = "),
        "m.toml:10:1: slider.sprng: expected one of the keys static_friction, kinetic_friction, \
         pressure, static_ratio, surface, triple, spring, radius, period, damper, damping_ratio, tilt, tilt_y, asymmetry, gap, stop, bounds, found \"sprng\"; \
         nearest is \"spring\""
    );
    assert_eq!(
        changed("lower = ", "lowre = "),
        "m.toml:15:12: slider.bounds.lowre: expected one of the keys lower, upper, found \"lowre\"; \
         nearest is \"lower\""
    );
    assert_eq!(
        changed("[analysis]", "[analyses]"),
        "m.toml:38:2: analyses: expected one of the keys name, block, slider, storey, contents, structure, frame, \
         motion, initial, analysis, found \"analyses\"; nearest is \"analysis\""
    );
    assert_eq!(
        changed("height = ", "hieght = "),
        "m.toml:21:1: storey.1.hieght: expected one of the keys mass, weight, name, frequency, \
         period, stiffness, damping_ratio, damper, frequency_y, period_y, stiffness_y, damping_ratio_y, damper_y, height, found \"hieght\"; nearest is \"height\""
    );
    // A key of another section: its whole path.
    assert!(changed("width = ", "gravity = ").ends_with("; nearest is \"analysis.gravity\""));
    assert!(
        with("[slider.static_friction]\n").unwrap_err().starts_with("m.toml:6:9: expected each")
    );
    let direction = small("0.02\n", "{ positive = 0.02, negativ = 0.02 }\n");
    assert_eq!(
        direction,
        "m.toml:4:38: slider.static_friction.negativ: expected one of the keys positive, negative, \
         found \"negativ\"; nearest is \"negative\""
    );
    let sine = "[motion]\nsine = { frequency = \"1 Hz\", amplitud = \"1 g\" }\n";
    assert!(with(sine).unwrap_err().starts_with("m.toml:7:30: motion.sine.amplitud: "));
}

#[test]
fn missing_keys_at_their_table() {
    assert_eq!(refused(""), "m.toml:1:1: block: expected a table [block], found nothing");
    assert_eq!(
        small("mass = \"325 kg\"\n", ""),
        "m.toml:1:1: block: expected one of the keys mass, weight, found none"
    );
    assert_eq!(
        small("kinetic_friction = 0.012\n", ""),
        "m.toml:3:1: slider.kinetic_friction: expected a finite number ≥ 0 or a table of positive \
         and negative, found nothing"
    );
    assert_eq!(
        changed("bounds = { lower = 0.8, ", "bounds = { "),
        "m.toml:15:10: slider.bounds.lower: expected a finite number ≥ 0, found nothing"
    );
    assert_eq!(
        changed("frequency = \"1.625 Hz\"", ""),
        "m.toml:17:1: storey.1: expected one of the keys frequency, period, stiffness, found none"
    );
    assert_eq!(
        changed("damping_ratio = 0.01", ""),
        "m.toml:17:1: storey.1: expected one of the keys damping_ratio, damper, found none"
    );
    assert_eq!(
        with("[motion]\n").unwrap_err(),
        "m.toml:6:1: motion: expected one of the keys record, sine, sweep, pulse, found none"
    );
    assert_eq!(
        with("[motion.pulse]\nshape = \"half-sine\"\n").unwrap_err(),
        "m.toml:6:1: motion.pulse.amplitude: expected an acceleration with its unit, such as \
         \"0.3 g\", found nothing"
    );
}

#[test]
fn excluding_keys() {
    for (from, to, message) in [
        (
            "damper = \"0 N s/m\"",
            "radius = \"2 m\"",
            "m.toml:11:1: slider.radius: expected only one of spring, radius, period, found \"radius\" \
             besides \"spring\"",
        ),
        (
            "tilt   = \"1 mrad\"",
            "damping_ratio = 0.1",
            "m.toml:12:1: slider.damping_ratio: expected only one of damper, damping_ratio, found \
             \"damping_ratio\" besides \"damper\"",
        ),
        (
            "static_friction  = 0.020",
            "static_friction = { positive = 0.02, negative = 0.02 }",
            "m.toml:13:1: slider.asymmetry: expected only one of asymmetry, static_friction, found \
             \"asymmetry\" besides \"static_friction\"",
        ),
        (
            "height = \"0.76 m\"",
            "period = \"1 s\"",
            "m.toml:21:1: storey.1.period: expected only one of frequency, period, stiffness, found \
             \"period\" besides \"frequency\"",
        ),
        (
            "height = \"0.76 m\"",
            "damper = \"1 N s/m\"",
            "m.toml:21:1: storey.1.damper: expected only one of damping_ratio, damper, found \
             \"damper\" besides \"damping_ratio\"",
        ),
        (
            "vertical = \"records/taft-up.txt\"",
            "scale = 2.0",
            "m.toml:30:1: motion.scale: expected only one of scale, scale_to, found \"scale\" \
             besides \"scale_to\"",
        ),
        (
            "vertical = \"records/taft-up.txt\"",
            "sine = {}",
            "m.toml:30:1: motion.sine: expected only one of record, sine, sweep, pulse, found \
             \"sine\" besides \"record\"",
        ),
    ] {
        assert_eq!(changed(from, to), message);
    }
    let sine = "[motion]\nscale = 2.0\nsine = { frequency = \"1 Hz\", amplitude = \"1 g\", \
                duration = \"1 s\", dt = \"1 ms\" }\n";
    assert_eq!(
        with(sine).unwrap_err(),
        "m.toml:7:1: motion.scale: expected this key only beside \"record\", found \"scale\" beside \
         \"sine\""
    );
    assert_eq!(
        with("[motion]\nrecord = \"a.csv\"\nvertical_scale = 2\n").unwrap_err(),
        "m.toml:8:1: motion.vertical_scale: expected this key only beside \"vertical\", found \
         \"vertical_scale\" alone"
    );
}

#[test]
fn wrong_types() {
    for (from, to, message) in [
        (
            "\"325 kg\"",
            "325",
            "m.toml:4:9: block.mass: expected a mass with its unit, such as \"325 kg\", found 325",
        ),
        (
            "\"325 kg\"",
            "true",
            "m.toml:4:9: block.mass: expected a mass with its unit, such as \"325 kg\", found true",
        ),
        (
            "0.012",
            "\"0.012\"",
            "m.toml:9:20: slider.kinetic_friction: expected a finite number ≥ 0 or a table of \
             positive, negative, slow, fast, rate, velocity, coefficient, found \"0.012\"",
        ),
        (
            "{ lower = 0.8, upper = 1.3 }",
            "[0.8, 1.3]",
            "m.toml:15:10: slider.bounds: expected a table of keys, found a list",
        ),
        (
            "[\"5 mm\"]",
            "\"5 mm\"",
            "m.toml:35:24: initial.storey_displacement: expected a list with a length for each \
             storey, such as [\"150 mm\"], found \"5 mm\"",
        ),
        (
            "[\"5 mm\"]",
            "[5]",
            "m.toml:35:25: initial.storey_displacement.1: expected a length with its unit, such as \
             \"150 mm\", found 5",
        ),
        (
            "[[storey]]",
            "[storey]",
            "m.toml:17:1: storey: expected [[storey]] in two brackets, one for each, found [storey]",
        ),
        (
            "name = \"Section 6 mock-up\"",
            "name = 6",
            "m.toml:1:8: name: expected text in quotes, such as \"Tank on sliders\", found 6",
        ),
        (
            "\"exact\"",
            "\"exct\"",
            "m.toml:39:11: analysis.method: expected one of \"exact\", \"stepwise\", found \"exct\"; \
             nearest is \"exact\"",
        ),
        (
            "record   = \"records/taft.txt\"",
            "record = \"\"",
            "m.toml:26:10: motion.record: expected text in quotes, such as \"records/taft.txt\", \
             found \"\"",
        ),
        (
            "units    = \"g\"",
            "channel = 0",
            "m.toml:27:11: motion.channel: expected a name in quotes or a number from 1, found 0",
        ),
        (
            "units    = \"g\"",
            "units = 1979-05-27",
            "m.toml:27:9: motion.units: expected a unit of acceleration (m/s2, mm/s2, cm/s2, gal, \
             g, in/s2, ft/s2), found the date 1979-05-27",
        ),
    ] {
        assert_eq!(changed(from, to), message);
    }
}

#[test]
fn wrong_units_and_ranges() {
    for (from, to, message) in [
        (
            "\"143 kN/m\"",
            "\"143 kN/mmm\"",
            "m.toml:10:10: slider.spring: expected a unit of stiffness (N/m, N/mm, kN/m, kN/mm, \
             MN/m, lbf/in, kip/in, kip/ft), found \"kN/mmm\"; nearest is \"kN/mm\"",
        ),
        (
            "\"45 kg\"",
            "\"45 g\"",
            "m.toml:18:8: storey.1.mass: expected a mass, such as \"325 kg\", found an \
             acceleration, \"45 g\"",
        ),
        (
            "\"45 kg\"",
            "\"-45 kg\"",
            "m.toml:18:8: storey.1.mass: expected a finite mass > 0, found \"-45 kg\"",
        ),
        (
            "0.020",
            "nan",
            "m.toml:8:20: slider.static_friction: expected a finite number ≥ 0, found nan",
        ),
        (
            "0.020",
            "1e999",
            "m.toml:8:20: slider.static_friction: expected a finite number ≥ 0, found 1e999",
        ),
        (
            "asymmetry = 0.0",
            "asymmetry = -1",
            "m.toml:13:13: slider.asymmetry: expected a number between -1 and 1, found -1",
        ),
        (
            "\"1 mrad\"",
            "\"90 deg\"",
            "m.toml:12:10: slider.tilt: expected an angle between -90 deg and 90 deg, found \
             \"90 deg\"",
        ),
        (
            "\"10 mm\"",
            "\"NaN mm\"",
            "m.toml:33:24: initial.sliding_displacement: expected a length with its unit, such as \
             \"150 mm\", found \"NaN mm\"",
        ),
        (
            "\"9.81 m/s2\"",
            "\"0 g\"",
            "m.toml:40:11: analysis.gravity: expected a finite acceleration > 0, found \"0 g\"",
        ),
        (
            "dt       = \"0.01 s\"",
            "dt = 0.01",
            "m.toml:28:6: motion.dt: expected a time with its unit, such as \"0.01 s\", found 0.01",
        ),
    ] {
        assert_eq!(changed(from, to), message);
    }
}

#[test]
fn rules_between_keys() {
    assert_eq!(
        changed("0.012", "0.021"),
        "m.toml:9:20: slider.kinetic_friction: expected at most the static friction 0.02, found \
         0.021"
    );
    let tables = small("0.012\n", "{ positive = 0.02, negative = 0.03 }\n");
    assert_eq!(
        tables,
        "m.toml:5:50: slider.kinetic_friction.negative: expected at most the static friction 0.02, \
         found 0.03"
    );
    assert_eq!(
        changed("upper = 1.3", "upper = 0.5"),
        "m.toml:15:33: slider.bounds.upper: expected at least the lower bound 0.8, found 0.5"
    );
    assert_eq!(
        with("damping_ratio = 0.1\n").unwrap_err(),
        "m.toml:6:17: slider.damping_ratio: expected a spring, radius or period > 0 of which to take the \
         critical damping, found none"
    );
    assert_eq!(
        changed("[\"5 mm\"]", "[\"5 mm\", \"6 mm\"]"),
        "m.toml:35:24: initial.storey_displacement: expected one value a storey, 1 in all, found 2"
    );
    assert_eq!(
        with("radius = \"1e-20 m\"\n[analysis]\ngravity = \"1e20 m/s2\"\n").unwrap_err(),
        "m.toml:6:10: slider.radius: expected a value whose stiffness M_tot g cos θ / R is at most \
         1e30 in SI, found \"1e-20 m\""
    );
    assert_eq!(
        changed("\"1.625 Hz\"", "\"1e-200 Hz\""),
        "m.toml:19:13: storey.1.frequency: expected a frequency from 1e-30 to 1e30 in SI, found \
         \"1e-200 Hz\""
    );
    assert_eq!(
        with("[frame]\nperiod = \"1 s\"\n").unwrap_err(),
        "m.toml:7:10: frame.period: expected storeys whose stiffnesses it scales, found no storey"
    );
}

/// The error for two storeys; `first` and `second` are what each has besides its mass.
fn two_storeys(first: &str, second: &str, more: &str) -> String {
    with(&format!(
        "[[storey]]\nmass = \"2 t\"\n{first}\n[[storey]]\nmass = \"1 t\"\n{second}\n{more}\n"
    ))
    .unwrap_err()
}

#[test]
fn mixtures_of_storeys() {
    let k = "stiffness = \"1 kN/m\"; damping_ratio = 0.02".replace("; ", "\n");
    assert_eq!(
        two_storeys(&k, "frequency = \"1 Hz\"\ndamping_ratio = 0.02", ""),
        "m.toml:12:13: storey.2.frequency: expected a stiffness: a frequency belongs to a structure \
         of one storey, found \"1 Hz\""
    );
    assert_eq!(
        two_storeys(&k, "stiffness = \"1 kN/m\"\ndamping_ratio = 0.03", ""),
        "m.toml:13:17: storey.2.damping_ratio: expected 0.02, the ratio of storey 1: it belongs to \
         every mode, found 0.03"
    );
    assert_eq!(
        two_storeys(&k, "stiffness = \"1 kN/m\"\ndamper = \"1 N s/m\"", ""),
        "m.toml:13:10: storey.2.damper: expected a damping_ratio, as for storey 1, found \"1 N s/m\""
    );
    assert_eq!(
        two_storeys(&k, "stiffness = 1\ndamping_ratio = 0.02", ""),
        "m.toml:12:13: storey.2.stiffness: expected a stiffness with its unit, such as \
         \"143 kN/m\", found 1"
    );
    assert_eq!(
        two_storeys(&k, "stiffness = 1\ndamping_ratio = 0.02", "[frame]\nperiod = \"1 s\""),
        "m.toml:12:13: storey.2.stiffness: expected ratios for all storeys or stiffnesses for all, \
         found 1"
    );
    let tall = format!("{k}\nheight = \"3 m\"");
    assert_eq!(
        two_storeys(&k, &tall, ""),
        "m.toml:6:1: storey.1.height: expected a height, as for storey 2, or none at all, found \
         nothing"
    );
    assert_eq!(
        changed("[motion] ", "[frame]\nperiod = \"0.8 s\"\n[motion] "),
        "m.toml:19:13: storey.1.frequency: expected a stiffness, which frame.period scales, found \
         \"1.625 Hz\""
    );
}

#[test]
fn faults_of_the_toml() {
    for (text, message) in [
        (
            "[block]\nmass = 325 kg\n",
            "m.toml:2:8: expected a number, or text in double quotes, found \"325 kg\"",
        ),
        ("[block]\nmass\n", "m.toml:2:5: expected `=`, found key with no value"),
        ("[block\n", "m.toml:1:7: expected `]`, found unclosed table"),
        ("a = 1\na = 2\n", "m.toml:2:1: expected each key and table once, found \"a\""),
        ("[block]\n[block]\n", "m.toml:2:2: expected each key and table once, found \"block\""),
        ("a = [1,", "m.toml:1:8: expected `]`, found unclosed array"),
        ("a =", "m.toml:1:4: expected a number, or text in double quotes, found nothing"),
        (
            "é = 1",
            "m.toml:1:1: expected letters, numbers, `-`, `_`, found invalid unquoted key: \"é\"",
        ),
        ("\0\0", "m.toml:1:3: expected `=`, found key with no value"),
    ] {
        let found = refused(text);
        assert_eq!(found, message);
    }
}

#[test]
fn found_text_is_cut_and_escaped() {
    let long = small("325 kg", &"k".repeat(100));
    assert!(long.ends_with(&format!("found \"{}…\"", "k".repeat(40))), "{long}");
    let control = small("325 kg", "3\\u001b[31m kg");
    assert!(control.ends_with("found \"3\\u{1b}[31m kg\""), "{control}");
}

/// A motion whose parts are each in range, refused by its maker.
fn unmade(keys: &str) -> String {
    let analysis = with(&format!("[motion.sine]\nfrequency = \"1 Hz\"\n{keys}")).unwrap();
    let Ok(MotionSource::Sine(sine)) = analysis.required_motion() else { panic!("no sine") };
    analysis.motion_error(&sine.motion().unwrap_err()).to_string()
}

#[test]
fn motions_that_cannot_be_made() {
    assert_eq!(
        unmade("amplitude = \"1 g\"\nduration = \"1e6 s\"\ndt = \"1e-6 s\"\n"),
        "m.toml:10:6: motion.sine.dt: expected at most 100 000 000 samples, found 1.0e12"
    );
    assert_eq!(
        unmade("amplitude = \"1 g\"\nduration = \"5 s\"\ndt = \"10 ms\"\nramp = \"6 s\"\n",),
        "m.toml:11:8: motion.sine.ramp: expected ramp + decay in s at most the duration, found 6"
    );
    let record = with("[motion]\nrecord = \"zero.csv\"\nscale_to = \"0.3 g\"\n").unwrap();
    assert_eq!(
        record.motion_error(&MotionError::ZeroPeak).to_string(),
        "m.toml:8:12: motion.scale_to: expected a record that is not zero throughout, found a peak \
         of 0 m/s²"
    );
    let short = MotionError::TooShort { found: 1 };
    assert_eq!(
        record.motion_error(&short).to_string(),
        "m.toml:7:10: motion.record: expected a ground motion, found expected at least two samples \
         with one value each, found 1"
    );
}

/// Squares and products of numbers stay finite: those of a size that nothing has are refused.
#[test]
fn numbers_are_of_some_size() {
    let sizes = "expected a mass from 1e-30 to 1e30 in SI, found";
    assert!(small("325 kg", "1e150 kg").ends_with(&format!("{sizes} \"1e150 kg\"")));
    assert!(small("325 kg", "1e-99 t").ends_with(&format!("{sizes} \"1e-99 t\"")));
}

#[test]
fn stops_that_cannot_be() {
    let stop = |text: &str| with(&format!("[slider.stop]\n{text}")).unwrap_err();
    let gap = "gap = \"0.1 m\"\n";
    let stiff = "stiffness = \"1 MN/m\"\n";
    assert_eq!(
        with("gap = \"0.1 m\"\nstop = { gap = \"0.1 m\", stiffness = \"1 MN/m\" }\n").unwrap_err(),
        "m.toml:7:1: slider.stop: expected only one of gap, stop, found \"stop\" besides \"gap\""
    );
    assert_eq!(
        stop(gap),
        "m.toml:6:1: slider.stop: expected one of the keys stiffness, restitution, found none"
    );
    assert_eq!(
        stop(stiff),
        "m.toml:6:1: slider.stop.gap: expected a length with its unit, such as \"150 mm\" or a table \
         of positive and negative, of which one may be missing, found nothing"
    );
    assert_eq!(
        stop(&format!("{gap}{stiff}restitution = 0.5\n")),
        "m.toml:9:1: slider.stop.restitution: expected only one of stiffness, restitution, found \
         \"restitution\" besides \"stiffness\""
    );
    assert_eq!(
        stop(&format!("{gap}{stiff}damper = \"1 kN s/m\"\ndamping_ratio = 0.1\n")),
        "m.toml:10:1: slider.stop.damping_ratio: expected only one of damper, damping_ratio, found \
         \"damping_ratio\" besides \"damper\""
    );
    assert_eq!(
        stop(&format!("gap = {{}}\n{stiff}")),
        "m.toml:7:7: slider.stop.gap: expected one of the keys positive, negative or both, found an \
         empty table"
    );
    assert_eq!(
        stop(&format!("gap = {{ postive = \"1 m\" }}\n{stiff}")),
        "m.toml:7:9: slider.stop.gap.postive: expected one of the keys positive, negative, found \
         \"postive\"; nearest is \"positive\""
    );
    assert_eq!(
        stop(&format!("gap = 0.1\n{stiff}")),
        "m.toml:7:7: slider.stop.gap: expected a length with its unit, such as \"150 mm\" or a table \
         of positive and negative, of which one may be missing, found 0.1"
    );
    assert_eq!(
        stop(&format!("gap = \"-1 mm\"\n{stiff}")),
        "m.toml:7:7: slider.stop.gap: expected a finite length ≥ 0, found \"-1 mm\""
    );
    assert_eq!(
        stop(&format!("{gap}stiffness = \"0 N/m\"\n")),
        "m.toml:8:13: slider.stop.stiffness: expected a finite stiffness > 0, found \"0 N/m\""
    );
    assert_eq!(
        stop(&format!("{gap}{stiff}damper = \"-1 N s/m\"\n")),
        "m.toml:9:10: slider.stop.damper: expected a finite damper constant ≥ 0, found \"-1 N s/m\""
    );
    assert_eq!(
        stop(&format!("{gap}stiffness = \"1e20 N/m\"\ndamping_ratio = 1e20\n")),
        "m.toml:9:17: slider.stop.damping_ratio: expected a value whose damper 2 ξ √(k M1) is at \
         most 1e30 in SI, found 1e20"
    );
}

/// Friction by speed, surfaces, contents and rigid stops: one clear error each.
#[test]
fn devices_that_cannot_be() {
    let model = |slider: &str| {
        let head = "[block]\nmass = \"325 kg\"\n[slider]\n";
        refused(&format!("{head}{slider}\n"))
    };
    let rate =
        |law: &str| model(&format!("static_friction = 0.05\nkinetic_friction = {{ {law} }}"));
    let plain = "static_friction = 0.05\nkinetic_friction = 0.04\n";
    let path = "slider.kinetic_friction";
    for (found, wanted) in [
        (
            rate("slow = 0.06, fast = 0.08, rate = \"25 s/m\""),
            format!("m.toml:5:29: {path}.slow: expected at most the static friction 0.05, found 0.06"),
        ),
        (
            rate("velocity = [\"0 m/s\", \"1 m/s\"], coefficient = [0.06, 0.02]"),
            format!(
                "m.toml:5:68: {path}.coefficient.1: expected at most the static friction 0.05, found \
                 0.06"
            ),
        ),
        (
            rate("velocity = [\"0.1 m/s\"], coefficient = [0.05]"),
            format!("m.toml:5:34: {path}.velocity.1: expected velocities from 0 on, found \"0.1 m/s\""),
        ),
        (
            rate("velocity = [\"0 m/s\", \"0 m/s\"], coefficient = [0.05, 0.02]"),
            format!("m.toml:5:43: {path}.velocity.2: expected velocities that increase, found \"0 m/s\""),
        ),
        (
            rate("velocity = [\"0 m/s\"], coefficient = [0.05, 0.02]"),
            format!(
                "m.toml:5:58: {path}.coefficient: expected one coefficient a velocity, 1 in all, \
                 found 2"
            ),
        ),
        (
            rate("slow = 0.04, fast = 0.08, rate = \"-25 s/m\""),
            format!("m.toml:5:55: {path}.rate: expected a finite rate by speed ≥ 0, found \"-25 s/m\""),
        ),
        (
            rate("slow = 0.04, fast = 0.08"),
            format!(
                "m.toml:5:20: {path}.rate: expected a rate by speed with its unit, such as \"25 s/m\", \
                 found nothing"
            ),
        ),
        (
            rate("fast = 0.08, rate = \"25 s/m\""),
            format!(
                "m.toml:5:20: {path}: expected one of the keys positive, slow, velocity, found none"
            ),
        ),
        (
            rate("positive = 0.04, slow = 0.04"),
            format!(
                "m.toml:5:39: {path}.slow: expected only one of positive, slow, velocity, found \
                 \"slow\" besides \"positive\""
            ),
        ),
        (
            model(&format!(
                "{plain}pressure = {{ at_rest = \"2 MPa\", reference = \"2 MPa\", exponent = 1 }}"
            )),
            "m.toml:6:65: slider.pressure.exponent: expected a number from 0 to below 1, found 1"
                .into(),
        ),
        (
            model(&format!(
                "{plain}pressure = {{ at_rest = \"2 MPa\", reference = \"2 kN\", exponent = 0.2 }}"
            )),
            "m.toml:6:45: slider.pressure.reference: expected a pressure, such as \"20 MPa\", found \
             a force, \"2 kN\""
                .into(),
        ),
        (
            model(&format!("{plain}stop = {{ gap = \"0.1 m\", restitution = 1.5 }}")),
            "m.toml:6:39: slider.stop.restitution: expected a number from 0 to 1, found 1.5".into(),
        ),
        (
            model(&format!("{plain}stop = {{ gap = \"0.1 m\", restitution = 0.5, damper = \"1 N s/m\" }}")),
            "m.toml:6:44: slider.stop.damper: expected this key only beside \"stiffness\", found \
             \"damper\" beside \"restitution\""
                .into(),
        ),
        (
            model(&format!(
                "{plain}stop = {{ gap = \"0.1 m\", restitution = 0.5 }}\n[initial]\n\
                 sliding_displacement = \"0.2 m\""
            )),
            "m.toml:8:24: initial.sliding_displacement: expected a place between the rigid stops, \
             found 0.2"
                .into(),
        ),
        (
            model("[[slider.surface]]\nradius = \"1 m\""),
            "m.toml:4:1: slider.surface.1.friction: expected a finite number > 0, found nothing".into(),
        ),
        (
            model("[[slider.surface]]\nfriction = { slow = 0.04, fast = 0.08, rate = \"25 s/m\" }"),
            "m.toml:5:12: slider.surface.1.friction: expected a number > 0: friction by direction or \
             speed on surfaces in series is a differential-algebraic system, which is not solved, \
             found a table"
                .into(),
        ),
        (
            model("static_friction = 0.05\n[[slider.surface]]\nfriction = 0.04"),
            "m.toml:5:10: slider.surface: expected only one of surface, triple, static_friction, found \
             \"surface\" besides \"static_friction\""
                .into(),
        ),
        (
            model("static_ratio = 0.9\n[[slider.surface]]\nfriction = 0.04"),
            "m.toml:4:16: slider.static_ratio: expected a number of at least 1, found 0.9".into(),
        ),
        (
            model(
                "[[slider.surface]]\nfriction = 0.04\ntravel = \"0.1 m\"\n[initial]\n\
                 sliding_displacement = \"0.2 m\"",
            ),
            "m.toml:8:24: initial.sliding_displacement: expected less than the travel of all \
             surfaces, found 0.2"
                .into(),
        ),
        (
            model(
                "[slider.triple]\neffective_radius = [\"1 m\", \"1 m\", \"1 m\"]\n\
                 friction = [0.1, 0.02, 0.02, 0.1]\ntravel = [\"1 m\", \"1 m\", \"1 m\", \"1 m\"]",
            ),
            "m.toml:5:20: slider.triple.effective_radius: expected four values, one a surface from \
             the bottom up, found 3"
                .into(),
        ),
        (
            model(&format!(
                "{plain}[[contents]]\nfloor = 1\nmass = \"1 t\"\nstatic_friction = 0.2\n\
                 kinetic_friction = 0.1"
            )),
            "m.toml:7:9: contents.1.floor: expected 0, the block: there are no storeys, found 1".into(),
        ),
        (
            model(&format!(
                "{plain}[[contents]]\nfloor = 0\nmass = \"1 t\"\nstatic_friction = 0.2\n\
                 kinetic_friction = 0.3"
            )),
            "m.toml:10:20: contents.1.kinetic_friction: expected at most the static friction 0.2, \
             found 0.3"
                .into(),
        ),
    ] {
        assert_eq!(found, wanted);
    }
}
