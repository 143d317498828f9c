//! Models that are read, and the numbers that come of them.

use core::f64::consts::{PI, TAU};

use super::{FULL, SMALLEST, read, with};
use crate::input::{
    FrictionBounds, MotionSource, RecordSource, Scale, from_bytes, json_schema, parse,
};
use crate::model::shear_frame_frequencies;
use crate::model::{
    Block, Contents, Damping, Frame, InitialState, Model, ModelBuilder, Stop, StopKind,
};
use crate::motion::{Pulse, PulseShape, Sine, Sweep, SweepKind};
use crate::record::Units;
use crate::response::Method;
use crate::slider::{RateCurve, RateLaw, Surface, SurfacesInSeries};
use crate::units::Dimension;

#[test]
fn friction_by_pressure_is_that_under_the_weight() {
    let text = "[block]\nmass = \"31 t\"\n[slider]\nstatic_friction = 0.1\nkinetic_friction = 0.05\n\
                pressure = { at_rest = \"45 MPa\", reference = \"20 N/mm2\", exponent = 0.2 }\n";
    let model = read(text, &[]).unwrap().model;
    let factor = libm::pow(45.0 / 20.0, -0.2);
    let law = model.slider().pressure().unwrap();
    assert_eq!([law.at_rest_pa(), law.reference_pa(), law.exponent()], [45e6, 20e6, 0.2]);
    for (found, of_reference) in [(model.static_friction(), 0.1), (model.kinetic_friction(), 0.05)]
    {
        let off = found.map(|mu| (mu / (factor * of_reference) - 1.0).abs());
        assert!(off.iter().all(|off| *off < 1e-15), "{found:?}");
    }
}

#[test]
fn full_example() {
    let analysis = read(FULL, &[]).unwrap();
    assert_eq!(analysis.name.as_deref(), Some("Section 6 mock-up"));
    let model = &analysis.model;
    let block = Block { mass_kg: 325.0, width_m: Some(0.53), height_m: None };
    assert_eq!(model.block(), &block);
    assert_eq!(model.static_friction(), [0.020; 2]);
    assert_eq!(model.kinetic_friction(), [0.012; 2]);
    let slider = model.slider();
    assert_eq!(model.slider_stiffness_n_per_m(), 143e3);
    assert_eq!(slider.damper_n_s_per_m, 0.0);
    assert_eq!(slider.tilt_rad, 0.001);
    assert_eq!(slider.gap_m(), Some(0.15));
    let omega = TAU * 1.625;
    let frame = Frame {
        masses_kg: vec![45.0],
        stiffnesses_n_per_m: vec![45.0 * omega * omega],
        damping: Damping::Ratio(0.01),
        heights_m: Some(vec![0.76]),
    };
    assert_eq!(model.frame(), &frame);
    assert_eq!(model.gravity_m_per_s2(), 9.81);
    let initial = InitialState {
        sliding_displacement_m: 0.01,
        sliding_velocity_m_per_s: 0.0,
        storey_displacement_m: Some(vec![0.005]),
        storey_velocity_m_per_s: Some(vec![0.0]),
    };
    assert_eq!(model.initial(), &initial);
    assert_eq!(analysis.friction_bounds, Some(FrictionBounds { lower: 0.8, upper: 1.3 }));
    let record = RecordSource {
        path: "records/taft.txt".to_owned(),
        units: Units::parse("g"),
        dt_s: Some(0.01),
        channel: None,
        scale: Scale::Peak(0.3 * 9.80665),
        vertical: Some("records/taft-up.txt".to_owned()),
        vertical_scale: None,
        along_y: None,
    };
    assert_eq!(analysis.required_motion(), Ok(&MotionSource::Record(record)));
    assert_eq!(analysis.method, Method::Exact);
    assert_eq!(analysis.tail_s, 5.0);
}

/// `M = W/g` with the model's own g; `K1 = M_tot (2π/T)²`; a kip is 4448.2216152605 N.
#[test]
fn weights_and_periods_stand_for_masses_and_springs() {
    let text = "[block]\nweight = \"1200 kip\"\nname = \"Base mat\"\n[slider]\n\
                static_friction = 0.06\nkinetic_friction = 0.05\nperiod = \"3 s\"\n\
                [[storey]]\nweight = \"981 kN\"\nname = \"Roof\"\nperiod = \"0.5 s\"\n\
                damping_ratio = 0.02\n[analysis]\ngravity = \"9.81 m/s2\"\n";
    let analysis = parse("m.toml", text, &[]).unwrap();
    let block_kg = 1200.0 * 4_448.221_615_260_5 / 9.81;
    let model = &analysis.model;
    assert!((model.block().mass_kg / block_kg - 1.0).abs() < 1e-15);
    assert!((model.frame().masses_kg[0] / 100e3 - 1.0).abs() < 1e-15);
    let spring = (block_kg + 100e3) * (TAU / 3.0) * (TAU / 3.0);
    assert!((model.slider_stiffness_n_per_m() / spring - 1.0).abs() < 1e-14);
    assert_eq!(analysis.names.block(), "Base mat");
    assert_eq!([analysis.names.storey(1), analysis.names.storey(2)], ["Roof", "Storey 2"]);
    assert_eq!(read(FULL, &[]).unwrap().names.block(), "Block");
    // Setting one of two excluding keys removes the other.
    let set = [crate::input::Override::of_option("--set", "block.mass=1 t").unwrap()];
    assert_eq!(parse("m.toml", text, &set).unwrap().model.block().mass_kg, 1000.0);
}

#[test]
fn inputs_are_given_as_written() {
    let analysis = read(FULL, &["slider.gap=0.2 m"]).unwrap();
    let inputs: Vec<_> = analysis.inputs().map(|i| (i.path, i.text, i.value, i.unit)).collect();
    for input in [
        ("name", "Section 6 mock-up", None, ""),
        ("block.mass", "325 kg", Some(325.0), "kg"),
        ("slider.static_friction", "0.020", Some(0.02), ""),
        ("slider.spring", "143 kN/m", Some(143e3), "N/m"),
        ("slider.gap", "0.2 m", Some(0.2), "m"),
        ("slider.bounds.upper", "1.3", Some(1.3), ""),
        ("storey.1.frequency", "1.625 Hz", Some(1.625), "Hz"),
        ("motion.scale_to", "0.3 g", Some(0.3 * 9.80665), "m/s2"),
        ("initial.storey_displacement.1", "5 mm", Some(0.005), "m"),
    ] {
        assert!(inputs.contains(&input), "{input:?} in {inputs:#?}");
    }
    assert_eq!(analysis.value("slider.tilt"), Some(0.001));
    assert_eq!(analysis.value("slider.radius"), None);
}

#[test]
fn what_is_not_given_has_its_default() {
    let analysis = read(SMALLEST, &[]).unwrap();
    assert_eq!(analysis.name, None);
    assert_eq!(analysis.model.storeys(), 0);
    assert_eq!(analysis.model.slider_stiffness_n_per_m(), 0.0);
    assert_eq!(analysis.model.gravity_m_per_s2(), 9.80665);
    assert_eq!(analysis.model.initial(), &InitialState::rest());
    assert_eq!(analysis.friction_bounds, None);
    assert_eq!(analysis.method, Method::Exact);
    assert_eq!(analysis.tail_s, 0.0);
    assert_eq!(
        analysis.required_motion().unwrap_err().to_string(),
        "m.toml:1:1: motion: expected a table [motion] with one of the keys record, sine, sweep, \
         pulse (or a record beside the model: --motion FILE, --records PATTERN), found nothing"
    );
}

#[test]
fn each_initial_key_replaces_its_own_default() {
    let initial = with("[initial]\nsliding_velocity = \"-20 cm/s\"\n").unwrap();
    assert_eq!(
        initial.model.initial(),
        &InitialState { sliding_velocity_m_per_s: -0.2, ..InitialState::rest() }
    );
}

/// K1 = M_tot g cos θ / R and C1 = 2 ξ √(K1 M_tot), with the storeys' masses and the model's gravity.
#[test]
fn pendulum_radius_and_damping_ratio() {
    let text = SMALLEST.replace("[slider]", "[slider]\nradius = \"2 m\"\ndamping_ratio = 0.05");
    let more = "[[storey]]\nmass = \"75 kg\"\nperiod = \"0.5 s\"\ndamper = \"9 N s/m\"\n\
                [analysis]\ngravity = \"10 m/s2\"\n";
    let model = read(&(text + more), &[]).unwrap().model;
    assert_eq!(model.slider_stiffness_n_per_m(), 400.0 * 10.0 / 2.0);
    assert_eq!(model.slider().damper_n_s_per_m, 0.1 * (2000.0_f64 * 400.0).sqrt());
    let omega = TAU / 0.5;
    assert_eq!(model.frame().stiffnesses_n_per_m, [75.0 * omega * omega]);
    assert_eq!(model.frame().damping, Damping::Dampers(vec![9.0]));
}

/// N/R, with the N that a tilted block presses on the surface.
#[test]
fn tilted_pendulum_has_the_spring_of_its_normal_force() {
    let text = SMALLEST.replace("[slider]", "[slider]\nradius = \"2 m\"\ntilt = \"60 mrad\"");
    let model = read(&text, &[]).unwrap().model;
    assert_eq!(model.slider_stiffness_n_per_m(), model.normal_n() / 2.0);
}

#[test]
fn friction_by_direction() {
    let tables = "[block]\nmass = \"1 t\"\n[slider]\n\
                  static_friction = { positive = 0.03, negative = 0.02 }\n\
                  [slider.kinetic_friction]\npositive = 0.01\nnegative = 0.02\n";
    let model = read(tables, &[]).unwrap().model;
    assert_eq!(model.static_friction(), [0.03, 0.02]);
    assert_eq!(model.kinetic_friction(), [0.01, 0.02]);

    let model = read(&format!("{SMALLEST}asymmetry = -0.25\n"), &[]).unwrap().model;
    assert_eq!(model.static_friction(), [0.02 * 0.75, 0.02 * 1.25]);
    assert_eq!(model.kinetic_friction(), [0.012 * 0.75, 0.012 * 1.25]);
}

const THREE_STOREYS: &str = "\
[[storey]]
mass = \"2 t\"
stiffness = \"3 MN/m\"
damping_ratio = 0.02
[[storey]]
mass = \"2 t\"
stiffness = \"2 MN/m\"
damping_ratio = 0.02
[[storey]]
mass = \"1 t\"
stiffness = \"1 MN/m\"
damping_ratio = 0.02
";

/// The classic frame with k = 3, 2, 1 and m = 2, 2, 1: Stodola's ω₁² is a root of
/// 4λ³ − 20λ² + 25λ − 6 = 0 in units of k/m (determinant expanded by hand); scaling to a period
/// must give that period whatever the unit of the ratios.
#[test]
fn frame_period_scales_stiffnesses() {
    let free = with(THREE_STOREYS).unwrap().model;
    assert_eq!(free.frame().stiffnesses_n_per_m, [3e6, 2e6, 1e6]);
    assert_eq!(free.frame().damping, Damping::Ratio(0.02));

    let scaled = with(&format!("{THREE_STOREYS}[frame]\nperiod = \"0.8 s\"\n")).unwrap().model;
    let frame = scaled.frame();
    let first = shear_frame_frequencies(&frame.masses_kg, &frame.stiffnesses_n_per_m)[0];
    assert!((first * 0.8 / TAU - 1.0).abs() < 1e-14, "{first}");
    let ratio = frame.stiffnesses_n_per_m[0] / frame.stiffnesses_n_per_m[2];
    assert!((ratio - 3.0).abs() < 1e-15);
    // λ = ω² m/k with m = 1 t and k = 1 MN/m scaled alike.
    let lambda = first * first * 1000.0 / frame.stiffnesses_n_per_m[2];
    let determinant = ((-4.0 * lambda + 20.0) * lambda - 25.0) * lambda + 6.0;
    assert!(determinant.abs() < 1e-12, "{lambda} {determinant}");

    let ratios = THREE_STOREYS.replace("\"3 MN/m\"", "3").replace("\"2 MN/m\"", "2.0");
    let ratios = ratios.replace("\"1 MN/m\"", "1");
    let by_ratio = with(&format!("{ratios}[frame]\nperiod = \"0.8 s\"\n")).unwrap().model;
    for (a, b) in by_ratio.frame().stiffnesses_n_per_m.iter().zip(&frame.stiffnesses_n_per_m) {
        assert!((a / b - 1.0).abs() < 1e-14);
    }
}

#[test]
fn made_motions() {
    let sine = "[motion]\nsine = { frequency = \"2 Hz\", amplitude = \"0.2 g\", duration = \"5 s\", \
                dt = \"5 ms\", phase = \"90 deg\", decay = \"1 s\" }\n";
    let expected = Sine {
        frequency_hz: 2.0,
        amplitude_m_per_s2: 0.2 * 9.80665,
        duration_s: 5.0,
        dt_s: 0.005,
        phase_rad: 90.0 * (PI / 180.0),
        ramp_s: 0.0,
        decay_s: 1.0,
    };
    assert_eq!(with(sine).unwrap().motion, Some(MotionSource::Sine(expected)));

    let sweep = "[motion.sweep]\nfrom = \"0.5 Hz\"\nto = \"10 Hz\"\nkind = \"logarithmic\"\n\
                 amplitude = \"1 m/s²\"\nduration = \"1 min\"\ndt = \"0.01 s\"\nramp = \"2 s\"\n";
    let expected = Sweep {
        from_hz: 0.5,
        to_hz: 10.0,
        kind: SweepKind::Logarithmic,
        amplitude_m_per_s2: 1.0,
        duration_s: 60.0,
        dt_s: 0.01,
        ramp_s: 2.0,
        decay_s: 0.0,
    };
    assert_eq!(with(sweep).unwrap().motion, Some(MotionSource::Sweep(expected)));

    let pulse = "[motion.pulse]\nshape = \"triangular\"\namplitude = \"-3 m/s2\"\n\
                 duration = \"0.4 s\"\nstart = \"1 s\"\ndt = \"10 ms\"\n";
    let expected = Pulse {
        shape: PulseShape::Triangular,
        amplitude_m_per_s2: -3.0,
        duration_s: 0.4,
        start_s: 1.0,
        dt_s: 0.01,
    };
    assert_eq!(with(pulse).unwrap().motion, Some(MotionSource::Pulse(expected)));
}

#[test]
fn record_keys() {
    let source = |more: &str| match with(&format!("[motion]\nrecord = \"a.csv\"\n{more}")) {
        Ok(analysis) => match analysis.motion {
            Some(MotionSource::Record(record)) => record,
            other => panic!("{other:?}"),
        },
        Err(error) => panic!("{error}"),
    };
    assert_eq!(source("").scale, Scale::Factor(1.0));
    assert_eq!(source("scale = -1.5").scale, Scale::Factor(-1.5));
    assert_eq!(source("channel = 2").channel.as_deref(), Some("2"));
    assert_eq!(source("channel = \"NS\"").channel.as_deref(), Some("NS"));
    assert_eq!(source("units = \"cm/s^2\"").units, Units::parse("cm/s2"));
    // The readers of records know every unit that a model may name.
    for unit in Dimension::Acceleration.units() {
        let units = source(&format!("units = \"{}\"", unit.name())).units.unwrap();
        assert!((units.si() / unit.to_si(1.0) - 1.0).abs() < 1e-15, "{unit:?}");
    }
    let up = source("vertical = \"up.csv\"\nvertical_scale = 0.5");
    assert_eq!((up.vertical.as_deref(), up.vertical_scale), (Some("up.csv"), Some(0.5)));
}

#[test]
fn byte_order_mark_and_crlf_change_nothing() {
    let crlf = format!("\u{feff}{}", FULL.replace('\n', "\r\n"));
    let (plain, windows) = (read(FULL, &[]).unwrap(), read(&crlf, &[]).unwrap());
    assert_eq!(plain.model, windows.model);
    assert_eq!(plain.motion, windows.motion);
    let broken = "\u{feff}blok = 1\r\n";
    let error = from_bytes("m.toml", broken.as_bytes(), &[]).unwrap_err();
    assert_eq!((error.place.line, error.place.column), (1, 1));
    assert_eq!(&broken[error.place.span], "blok");
}

#[test]
fn bytes_that_are_not_utf8_are_refused() {
    let mut bytes = SMALLEST.replace("325", "3é5").into_bytes();
    let after = bytes.iter().position(|b| *b == 0xc3).unwrap() + 2;
    bytes[after] = 0xff;
    assert_eq!(
        from_bytes("m.toml", &bytes, &[]).unwrap_err().to_string(),
        "m.toml:2:11: expected text in UTF-8, found the byte 0xff"
    );
    assert!(from_bytes("m.toml", SMALLEST.as_bytes(), &[]).is_ok());
}

#[test]
fn values_can_be_refused_by_their_user() {
    let analysis = parse("m.toml", FULL, &[]).unwrap();
    let error = analysis.error_at("motion.record", "a file that exists", "none");
    assert_eq!(
        error.to_string(),
        "m.toml:26:12: motion.record: expected a file that exists, found none"
    );
    let error = analysis.error_at("motion.channel", "a channel", "nothing");
    assert_eq!((error.place.line, error.place.column), (25, 1));
}

/// The schema is JSON, and has a description for every key at every depth.
#[test]
fn json_schema_is_json_and_describes_every_key() {
    fn count(node: &serde_json::Value) -> usize {
        let own = node.get("properties").and_then(|p| p.as_object()).map_or(0, |properties| {
            let described = properties.values().filter(|key| key.get("description").is_some());
            described.map(|key| 1 + count(key)).sum()
        });
        let inside = ["items", "anyOf"].iter().filter_map(|name| node.get(name));
        own + inside
            .map(|inner| match inner {
                serde_json::Value::Array(list) => list.iter().map(count).sum(),
                other => count(other),
            })
            .sum::<usize>()
    }
    let schema: serde_json::Value = serde_json::from_str(&json_schema()).unwrap();
    let keys = |section: &'static crate::input::schema::Section| {
        fn all(section: &'static crate::input::schema::Section) -> usize {
            section.keys.iter().map(|key| 1 + key.kind.section().map_or(0, all)).sum()
        }
        all(section)
    };
    assert_eq!(count(&schema), keys(&crate::input::keys::MODEL));
    let either = &schema["properties"]["block"]["allOf"][0]["oneOf"];
    assert_eq!(either[0]["required"][0], "mass");
    let pattern = schema["properties"]["analysis"]["properties"]["gravity"]["pattern"].as_str();
    assert!(pattern.unwrap().contains(r"m/s(\^?2|²)"), "{pattern:?}");
}

#[test]
fn stops_by_side_with_damper_or_ratio() {
    let stop =
        |text: &str| with(&format!("[slider.stop]\n{text}")).map(|a| *a.model.stop().unwrap());
    let elastic = |c| StopKind::Elastic { stiffness_n_per_m: 4e7, damper_n_s_per_m: c };
    assert_eq!(
        stop("gap = \"150 mm\"\nstiffness = \"40 kN/mm\"\n"),
        Ok(Stop { gap_m: [Some(0.15); 2], kind: elastic(0.0) })
    );
    assert_eq!(
        stop("gap = { negative = \"0.1 m\" }\nstiffness = \"40 kN/mm\"\ndamper = \"3 kN s/m\"\n"),
        Ok(Stop { gap_m: [None, Some(0.1)], kind: elastic(3e3) })
    );
    // C = 2 ξ √(k M1) with the block's own mass.
    assert_eq!(
        stop(
            "gap = { positive = \"0.1 m\", negative = \"0.2 m\" }\nstiffness = \"40 kN/mm\"\n\
              damping_ratio = 0.05\n"
        ),
        Ok(Stop { gap_m: [Some(0.1), Some(0.2)], kind: elastic(0.1 * (4e7_f64 * 325.0).sqrt()) })
    );
    assert_eq!(with("").unwrap().model.stop(), None);
}

/// The builder has the words of the file and makes the same bits of them.
#[test]
fn builder_makes_the_model_of_the_file() {
    let file = |slider: &str, rest: &str| {
        let text = format!("[block]\nmass = \"31 t\"\n[slider]\n{slider}\n{rest}");
        read(&text, &[]).unwrap().model
    };
    let built = |builder: ModelBuilder| builder.block("31 t").build().unwrap();
    let model = || Model::builder().friction(0.06, 0.05);
    let friction = "static_friction = 0.06\nkinetic_friction = 0.05";

    let storeys = "[[storey]]\nmass = \"60 t\"\nstiffness = \"9 kN/mm\"\ndamper = \"2 kN s/m\"\n\
                   height = \"3 m\"\n[[storey]]\nmass = \"47 t\"\nstiffness = \"7 kN/mm\"\n\
                   damper = \"1 kN s/m\"\nheight = \"10 ft\"\n[analysis]\ngravity = \"9.81 m/s2\"";
    let pendulum = "radius = \"2.2 m\"\ndamper = \"3 kN s/m\"\ntilt = \"2 mrad\"\ngap = \"150 mm\"";
    let builder = model().radius("2.2 m").damper("3 kN s/m").tilt("2 mrad").gap("150 mm");
    let builder = builder.storey("60 t", "9 kN/mm").storey("47 t", "7 kN/mm");
    let builder = builder.dampers(&["2 kN s/m", "1 kN s/m"]).heights(&["3 m", "10 ft"]);
    let builder = builder.gravity("9.81 m/s2");
    assert_eq!(built(builder), file(&format!("{friction}\n{pendulum}"), storeys));

    let oscillator = "[[storey]]\nmass = \"45 t\"\nfrequency = \"1.625 Hz\"\ndamping_ratio = 0.01\n\
                      [[contents]]\nfloor = 1\nmass = \"2 t\"\nstatic_friction = 0.4\n\
                      kinetic_friction = 0.3";
    let contents = Contents { floor: 1, mass_kg: 2e3, static_friction: 0.4, kinetic_friction: 0.3 };
    let stop = Stop { gap_m: [Some(0.1); 2], kind: StopKind::Rigid { restitution: 0.5 } };
    let builder = model().radius("1 m").spring("2 MN/m").oscillator("45 t", "1.625 Hz", 0.01);
    let slider = "spring = \"2 MN/m\"\nstop = { gap = \"100 mm\", restitution = 0.5 }";
    assert_eq!(
        built(builder.contents(contents).stop(stop)),
        file(&format!("{friction}\n{slider}"), oscillator),
    );

    let law =
        "static_friction = 0.1\nkinetic_friction = { slow = 0.05, fast = 0.1, rate = \"25 s/m\" }";
    let curve = RateCurve::Exponential { slow: 0.05, fast: 0.1, rate_s_per_m: 25.0 };
    let by_speed = RateLaw::new(curve, [1.0; 2]).unwrap();
    assert_eq!(built(Model::builder().friction_by_speed(0.1, by_speed)), file(law, ""));

    let surface =
        |friction, radius_m| Surface { radius_m: Some(radius_m), friction, travel_m: None };
    let series = SurfacesInSeries::new(vec![surface(0.05, 2.0), surface(0.1, 3.0)], 1.0).unwrap();
    let surfaces = "[[slider.surface]]\nradius = \"2 m\"\nfriction = 0.05\n\
                    [[slider.surface]]\nradius = \"3 m\"\nfriction = 0.1";
    assert_eq!(built(Model::builder().surfaces(series)), file("", surfaces));
}

#[test]
fn builder_says_what_is_wrong_or_missing() {
    let whole = || Model::builder().block("31 t").friction(0.06, 0.05);
    for (builder, message) in [
        (
            Model::builder().friction(0.06, 0.05),
            "block mass: expected a mass with its unit, found none",
        ),
        (
            Model::builder().block("31 t"),
            "friction: expected two coefficients or surfaces, found none",
        ),
        (
            whole().storey("9 t", "1 MN/m"),
            "storey damping: expected a ratio or dampers, found none",
        ),
        (
            whole().friction(0.05, 0.06),
            "kinetic_friction (positive): expected at most the static friction of the same \
             direction, found 0.06",
        ),
        (
            whole().gap("15 cn").radius("2 s"),
            "gap: expected a unit of length (m, mm, cm, in, ft), found \"cn\"; nearest is \"cm\"",
        ),
        (whole().radius("0 m"), "slider radius_m: expected a finite number > 0, found 0"),
    ] {
        assert_eq!(builder.build().unwrap_err().to_string(), message);
    }
}
