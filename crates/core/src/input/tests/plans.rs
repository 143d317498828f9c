//! Study plans: what they say, and what is wrong with them.

use crate::input::plan::{Distribution, Levels, List, Method, Plan};
use crate::input::{Variation, plan_json_schema};
use crate::motion::intensity::Measure;

const SAMPLING: &str = "[sampling]\nmethod = \"sobol\"\ncount = 100\nseed = 1\n";

fn plan(text: &str) -> Result<Plan, String> {
    Plan::parse("p.toml", text).map_err(|error| error.to_string())
}

/// A plan that varies one path.
fn varying(path: &str, how: &str) -> Result<Plan, String> {
    plan(&format!("model = \"m.toml\"\n[vary]\n\"{path}\" = {how}\n{SAMPLING}"))
}

fn distribution(path: &str, how: &str) -> Distribution {
    varying(path, how).unwrap().vary.remove(0).distribution
}

/// The plan of the manual.
#[test]
fn whole_plan() {
    let text = r#"
name  = "Friction and radius over the far-field suite"
model = "tank.toml"

[records]
files    = ["far-field/*.AT2"]
measure  = "PGA"
levels   = ["0.1 g", "0.2 g", "0.4 g"]

[vary]
"slider.kinetic_friction" = { uniform = [0.02, 0.10] }
"slider.static_friction"  = { factor_of = "slider.kinetic_friction", values = [1.0, 1.3] }
"slider.radius"           = { values = ["1 m", "2 m", "4 m"] }

[sampling]
method = "sobol"
count  = 1000
seed   = 1
correlation = [["slider.kinetic_friction", "slider.radius", 0.3]]
"#;
    let plan = plan(text).unwrap();
    assert_eq!(plan.model, "tank.toml");
    let records = plan.records.unwrap();
    assert_eq!(records.files, ["far-field/*.AT2"]);
    let levels = [0.1, 0.2, 0.4].map(|g| g * 9.80665).to_vec();
    assert_eq!(
        records.levels,
        Levels::Measure {
            measure: crate::motion::intensity::LevelMeasure {
                measure: Measure::Pga,
                rotated: None
            },
            levels
        }
    );
    let paths: Vec<_> = plan.vary.iter().map(|varied| varied.path.as_str()).collect();
    assert_eq!(paths, ["slider.kinetic_friction", "slider.static_friction", "slider.radius"]);
    assert_eq!(plan.vary[1].factor_of.as_deref(), Some("slider.kinetic_friction"));
    assert_eq!((plan.vary[1].unit, plan.vary[2].unit), ("", "m"));
    let sampling = plan.sampling.unwrap();
    assert_eq!((sampling.method, sampling.count, sampling.seed), (Method::Sobol, 1000, Some(1)));
    let lower = sampling.correlation.unwrap();
    assert_eq!(lower[6..9], [0.3, 0.0, (1.0_f64 - 0.3 * 0.3).sqrt()]);
}

#[test]
fn distributions_are_read() {
    let friction = |how| distribution("slider.kinetic_friction", how);
    let list = |list| Distribution::List(list);
    assert_eq!(friction("{ values = [0.1, 0.2] }"), list(List::Values(vec![0.1, 0.2])));
    let even = List::Even { ends: [0.1, 0.2], count: 3 };
    assert_eq!(friction("{ linspace = [0.1, 0.2, 3] }"), list(even.clone()));
    assert_eq!([even.get(0), even.get(1), even.get(2)], [0.1, 0.15, 0.2]);
    let fifth = List::Even { ends: [0.03, 0.07], count: 5 };
    assert_eq!([fifth.get(1), fifth.get(2), fifth.get(3)], [0.04, 0.05, 0.06]);
    // What no short number is stays what it is.
    let third = List::Even { ends: [0.0, 1.0], count: 4 };
    assert_eq!([third.get(1), third.get(2)], [1.0 / 3.0, 2.0 / 3.0]);
    let ratios = List::Ratios { ends: [1.0, 100.0], count: 3 };
    assert_eq!(
        distribution("slider.radius", "{ logspace = [\"1 m\", \"100 m\", 3] }"),
        list(ratios.clone())
    );
    assert!((ratios.get(1) - 10.0).abs() < 1e-14 && ratios.get(2) == 100.0);
    assert_eq!(friction("{ uniform = [0.1, 0.2] }"), Distribution::Uniform([0.1, 0.2]));
    let normal = Distribution::Normal { mean: 0.1, deviation: 0.02, truncated: Some([0.05, 0.15]) };
    assert_eq!(friction("{ normal = [0.1, 0.02], truncated = [0.05, 0.15] }"), normal);
    let lognormal = Distribution::Lognormal { median: 2.0, sigma_ln: 0.3, truncated: None };
    assert_eq!(distribution("slider.radius", "{ lognormal = [\"2 m\", 0.3] }"), lognormal);
}

/// A path is keys joined by dots, quoted or not; a number for both directions has two of its own.
#[test]
fn paths_may_be_written_as_keys() {
    let text = format!(
        "model = \"m.toml\"\n[vary]\nslider.radius = {{ values = [\"1 m\"] }}\n\
         slider.static_friction.positive = {{ values = [0.2] }}\n\
         storey.1.mass = {{ values = [\"1 kg\"] }}\n\
         \"initial.storey_velocity.1\" = {{ values = [\"1 m/s\"] }}\n{SAMPLING}"
    );
    let plan = plan(&text).unwrap();
    let paths: Vec<_> = plan.vary.iter().map(|varied| varied.path.as_str()).collect();
    let expected = [
        "slider.radius",
        "slider.static_friction.positive",
        "storey.1.mass",
        "initial.storey_velocity.1",
    ];
    assert_eq!(paths, expected);
}

#[test]
fn grid_counts_its_lists() {
    let text = "model = \"m.toml\"\n[vary]\n\
                \"slider.radius\" = { values = [\"1 m\", \"2 m\"] }\n\
                \"slider.kinetic_friction\" = { linspace = [0.1, 0.2, 5] }\n\
                [sampling]\nmethod = \"grid\"\n";
    assert_eq!(plan(text).unwrap().samples(), 10);
    assert_eq!(plan("model = \"m.toml\"\n").unwrap().samples(), 1);
}

#[test]
fn errors_say_where_and_what() {
    let long = "{ linspace = [0.1, 0.2, 20000] }";
    let grid = format!(
        "model = \"m.toml\"\n[vary]\n\"slider.static_friction\" = {long}\n\
         \"slider.kinetic_friction\" = {long}\n[sampling]\nmethod = \"grid\"\n"
    );
    let correlated = |pairs: &str| {
        format!(
            "model = \"m.toml\"\n[vary]\nslider.radius = {{ uniform = [\"1 m\", \"2 m\"] }}\n\
             slider.gap = {{ uniform = [\"1 m\", \"2 m\"] }}\n\
             slider.tilt = {{ uniform = [\"0 rad\", \"0.1 rad\"] }}\n{SAMPLING}correlation = {pairs}\n"
        )
    };
    let one = |path: &str, how: &str| {
        format!("model = \"m.toml\"\n[vary]\n\"{path}\" = {how}\n{SAMPLING}")
    };
    let records =
        |keys: &str| format!("model = \"m.toml\"\n[records]\nfiles = \"a.AT2\"\n{keys}\n");
    let cases = [
        (
            "modle = \"m.toml\"\n".to_owned(),
            "p.toml:1:1: modle: expected one of the keys name, model, bounds, records, vary, sampling, found \"modle\"; nearest is \"model\"",
        ),
        (
            "name = \"x\"\n".to_owned(),
            "p.toml:1:1: model: expected text in quotes, such as \"tank.toml\", found nothing",
        ),
        (
            one("slider.radius", "{ valus = [\"1 m\"] }"),
            "p.toml:3:21: vary.slider.radius.valus: expected one of the keys values, linspace, logspace, uniform, normal, lognormal, truncated, factor_of, paired_with, found \"valus\"; nearest is \"values\"",
        ),
        (
            one("slider.radios", "{ values = [\"1 m\"] }"),
            "p.toml:3:1: vary.slider.radios: expected a path of the model, found \"slider.radios\"; nearest is \"slider.radius\"",
        ),
        (
            one("slider", "{ values = [1] }"),
            "p.toml:3:1: vary.slider: expected the path of a number, found \"slider\"",
        ),
        (
            one("analysis.method", "{ values = [1] }"),
            "p.toml:3:1: vary.analysis.method: expected the path of a number, found \"analysis.method\"",
        ),
        (
            one("slider.bounds.lower", "{ values = [1] }"),
            "p.toml:3:1: vary.slider.bounds.lower: expected a path that a study varies: bounds of friction are chosen by bounds = \"all\", or vary the friction, found \"slider.bounds.lower\"",
        ),
        (
            one("slider.radius", "{ values = [\"1 kg\"] }"),
            "p.toml:3:31: vary.slider.radius.values.1: expected a length, such as \"150 mm\", found a mass, \"1 kg\"",
        ),
        (
            one("slider.radius", "{ values = [2] }"),
            "p.toml:3:31: vary.slider.radius.values.1: expected a length with its unit, such as \"150 mm\", found 2",
        ),
        (
            one("slider.radius", "{ values = [] }"),
            "p.toml:3:30: vary.slider.radius.values: expected at least one value, found none",
        ),
        (
            one("slider.radius", "{ uniform = [\"2 m\", \"1 m\"] }"),
            "p.toml:3:31: vary.slider.radius.uniform: expected a first value below the second, found 2 and 1",
        ),
        (
            one("slider.radius", "{ uniform = [\"2 m\"] }"),
            "p.toml:3:31: vary.slider.radius.uniform: expected a list of 2 values, found 1",
        ),
        (
            one("slider.radius", "{ normal = [\"2 m\", \"0 m\"] }"),
            "p.toml:3:38: vary.slider.radius.normal.2: expected a finite length > 0, found \"0 m\"",
        ),
        (
            one("slider.radius", "{ values = [\"2 m\"], truncated = [\"0 m\", \"1 m\"] }"),
            "p.toml:3:51: vary.slider.radius.truncated: expected this key only beside \"normal\" or \"lognormal\", found \"truncated\" beside \"values\"",
        ),
        (
            one("slider.radius", "{ values = [\"2 m\"], uniform = [\"0 m\", \"1 m\"] }"),
            "p.toml:3:39: vary.slider.radius.uniform: expected only one of values, linspace, logspace, uniform, normal, lognormal, found \"uniform\" besides \"values\"",
        ),
        (
            one("slider.radius", "{ linspace = [\"2 m\", \"3 m\", 1.5] }"),
            "p.toml:3:47: vary.slider.radius.linspace.3: expected a whole number from 2 to 100000000, found 1.5",
        ),
        (
            one("slider.radius", "{ factor_of = \"slider.gp\", values = [1] }"),
            "p.toml:3:33: vary.slider.gp: expected a path of the model, found \"slider.gp\"; nearest is \"slider.gap\"",
        ),
        (
            one("slider.radius", "{ factor_of = \"block.mass\", values = [1] }"),
            "p.toml:3:33: vary.slider.radius.factor_of: expected the path of a length, found \"block.mass\"",
        ),
        (
            one("slider.radius", "{ factor_of = \"slider.radius\", values = [1] }"),
            "p.toml:3:33: vary.slider.radius.factor_of: expected a path that does not follow from this one, found \"slider.radius\"",
        ),
        (
            one("slider.radius", "{ values = [\"1 m\"], paired_with = \"slider.gap\" }"),
            "p.toml:3:53: vary.slider.radius.paired_with: expected another path of [vary], found \"slider.gap\"; nearest is \"slider.radius\"",
        ),
        (
            one("slider.radius", "{ values = [\"1 m\"], paired_with = \"slider.radius\" }"),
            "p.toml:3:53: vary.slider.radius.paired_with: expected a path with a list of 1 values of its own, found \"slider.radius\"",
        ),
        (
            "model = \"m.toml\"\n[vary]\nslider.radius = { values = [\"1 m\"] }\n".to_owned(),
            "p.toml:1:1: sampling: expected a table [sampling] beside [vary], found nothing",
        ),
        (
            format!("model = \"m.toml\"\n{SAMPLING}"),
            "p.toml:2:1: sampling: expected a table [vary] beside [sampling], found nothing to sample",
        ),
        (
            one("slider.radius", "{ values = [\"1 m\"] }").replace("seed = 1\n", ""),
            "p.toml:4:1: sampling.seed: expected a whole number, found nothing",
        ),
        (
            one("slider.radius", "{ values = [\"1 m\"] }").replace("count = 100", "count = 0"),
            "p.toml:6:9: sampling.count: expected a whole number from 1 to 100000000, found 0",
        ),
        (
            one("slider.radius", "{ values = [\"1 m\"] }").replace("sobol", "sobal"),
            "p.toml:5:10: sampling.method: expected one of \"sobol\", \"latin-hypercube\", \"grid\", found \"sobal\"; nearest is \"sobol\"",
        ),
        (
            one("slider.radius", "{ values = [\"1 m\"] }").replace("sobol", "grid"),
            "p.toml:6:9: sampling.count: expected no such key with method = \"grid\", which draws nothing, found \"count\"",
        ),
        (
            grid,
            "p.toml:4:29: vary.slider.kinetic_friction: expected a grid of at most 100000000 samples, found more",
        ),
        (
            correlated("[[\"slider.radius\", \"slider.gab\", 0.3]]"),
            "p.toml:10:34: sampling.correlation.1: expected a path of [vary] that is drawn by itself, found \"slider.gab\"; nearest is \"slider.gap\"",
        ),
        (
            correlated("[[\"slider.radius\", \"slider.gap\", 1]]"),
            "p.toml:10:48: sampling.correlation.1: expected a number between -1 and 1, found 1",
        ),
        (
            correlated(
                "[[\"slider.radius\", \"slider.gap\", 0.9], [\"slider.gap\", \"slider.tilt\", 0.9], [\"slider.tilt\", \"slider.radius\", -0.9]]",
            ),
            "p.toml:10:15: sampling.correlation: expected correlations that can hold together (a positive definite matrix), found a matrix that is not positive definite",
        ),
        (
            records("measure = \"Sa(1.2)\"\nlevels = [\"1 g\"]"),
            "p.toml:4:11: records.measure: expected a time with its unit, such as \"0.01 s\", found \"1.2\"",
        ),
        (
            records("measure = \"D5-95\"\nlevels = [\"1 s\"]"),
            "p.toml:4:11: records.measure: expected a measure that grows as the motion does, such as PGA or Sa(1.2 s), found \"D5-95\"",
        ),
        (
            records("measure = \"PGV\"\nlevels = [\"1 g\"]"),
            "p.toml:5:11: records.levels.1: expected a velocity, such as \"0.2 m/s\", found an acceleration, \"1 g\"",
        ),
        (
            records("measure = \"PGV\""),
            "p.toml:2:1: records.levels: expected a list of levels of the measure with their unit, such as [\"0.2 g\"], found nothing",
        ),
        (
            records("levels = [\"1 g\"]"),
            "p.toml:4:1: records.levels: expected this key only beside \"measure\", found \"levels\" alone",
        ),
        (
            records("measure = \"PGA\"\nlevels = [\"1 g\"]\nscale = [1]"),
            "p.toml:6:1: records.scale: expected only one of measure, scale, found \"scale\" besides \"measure\"",
        ),
        (
            records(&format!("[vary]\n\"motion.scale\" = {{ values = [2] }}\n{SAMPLING}")),
            "p.toml:5:18: vary.motion.scale: expected no path of [motion] but rotate beside [records], which replaces it, found \"motion.scale\"",
        ),
    ];
    for (text, expected) in cases {
        assert_eq!(plan(&text).unwrap_err(), expected, "{text}");
    }
}

#[test]
fn variation_is_what_set_does() {
    let model = "[block]\nmass = \"325 kg\"\n[slider]\nspring = \"1 kN/m\"\n\
                 static_friction = 0.2\nkinetic_friction = 0.1\n";
    let text = format!(
        "model = \"m.toml\"\n[vary]\nslider.kinetic_friction = {{ uniform = [0.02, 0.3] }}\n\
         slider.radius = {{ uniform = [\"1 m\", \"2 m\"] }}\n{SAMPLING}"
    );
    let plan = plan(&text).unwrap();
    let variation = Variation::new("m.toml", model, &plan.vary).unwrap();
    let parts = variation.parts(&[0.1, 1.5]).unwrap();
    let analysis = variation.analysis(&[0.1, 1.5]).unwrap();
    assert_eq!(parts.model, analysis.model);
    // The radius has taken the place of the spring.
    assert!((parts.model.slider_stiffness_n_per_m() - 325.0 * 9.80665 / 1.5).abs() < 1e-10);
    let error = variation.parts(&[0.25, 1.5]).unwrap_err().to_string();
    assert!(error.contains("expected at most the static friction 0.2, found 0.25"), "{error}");
    let error = variation.parts(&[0.1, -1.5]).unwrap_err().to_string();
    assert!(error.contains("slider.radius: expected a finite length > 0"), "{error}");
    // A sample that fails leaves nothing behind.
    assert_eq!(variation.parts(&[0.1, 1.5]).unwrap().model, analysis.model);

    let both = format!(
        "model = \"m.toml\"\n[vary]\nslider.spring = {{ values = [\"1 N/m\"] }}\n\
         slider.radius = {{ values = [\"1 m\"] }}\n{SAMPLING}"
    );
    let both = Plan::parse("p.toml", &both).unwrap();
    let error = Variation::new("m.toml", model, &both.vary).unwrap_err().to_string();
    assert!(error.contains("expected no other varied path that takes its place"), "{error}");
}

#[test]
fn schema_of_plans_knows_every_key() {
    let schema = plan_json_schema();
    for key in ["model", "files", "levels", "correlation", "factor_of", "lognormal", "seed"] {
        assert!(schema.contains(&format!("\"{key}\": {{")), "{key}");
    }
}
