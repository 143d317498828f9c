//! The verification cases in two horizontal directions as models and motions.

use serde_json::Value;
use slipstick::model::{AlongY, Block, Damping, Frame, InitialState, Model, Slider};
use slipstick::motion::GroundMotion;
use slipstick::slider::{Ends, Friction, RateCurve, RateLaw};

pub fn cases() -> Vec<Value> {
    let text = include_str!("../../../../../data/reference/bidirectional.json");
    let file: Value = serde_json::from_str(text).expect("JSON");
    file["cases"].as_array().expect("cases").clone()
}

pub fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("expected a number, found {value}"))
}

pub fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(number).collect()
}

pub fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

pub fn model(case: &Value) -> Model {
    let p = &case["params"];
    let fixed = number(&p["mu_s"]);
    let friction = match &p["mu_exp"] {
        Value::Null => Friction::new(fixed, number(&p["mu_d"])),
        by_speed => {
            let [slow, fast, rate_s_per_m] =
                ["slow", "fast", "rate"].map(|key| number(&by_speed[key]));
            RateLaw::new(RateCurve::Exponential { slow, fast, rate_s_per_m }, [1.0; 2])
                .and_then(|law| Friction::by_speed([fixed; 2], law))
        }
    }
    .expect("friction");
    let slider = match p["R"].as_f64() {
        Some(radius_m) => Slider::pendulum(friction, radius_m),
        None => Slider::sprung(friction, number(&p["K1"])),
    };
    let initial = &case["initial"];
    let along = |axis: usize| {
        let floors = |of: &str| list(&initial[of]).iter().map(|q| number(&q[axis])).collect();
        InitialState {
            sliding_displacement_m: number(&initial["s"][axis]),
            sliding_velocity_m_per_s: number(&initial["w"][axis]),
            storey_displacement_m: Some(floors("q")),
            storey_velocity_m_per_s: Some(floors("v")),
        }
    };
    let gap_m = p.get("gap").map(number);
    Model::new(
        Block { mass_kg: number(&p["M1"]), width_m: None, height_m: None },
        Slider { damper_n_s_per_m: number(&p["C1"]), ends: Ends::Open { gap_m }, ..slider },
        Frame {
            masses_kg: numbers(&p["m"]),
            stiffnesses_n_per_m: numbers(&p["kx"]),
            damping: Damping::Ratio(number(&p["xi"])),
            heights_m: None,
        },
        number(&p["g"]),
        along(0),
    )
    .and_then(|model| {
        model.with_along_y(AlongY {
            stiffnesses_n_per_m: numbers(&p["ky"]),
            damping: Damping::Ratio(number(&p["xiy"])),
            width_m: None,
            initial: along(1),
        })
    })
    .expect("a model")
}

/// The motion of a case up to its end, with the times of its states as collinear samples.
pub fn motion(case: &Value) -> GroundMotion {
    let input = &case["input"];
    let end_s = number(&case["t_end"]);
    let mut t = numbers(&input["t"]);
    let mut lists: Vec<Vec<f64>> = ["ax", "ay", "av"]
        .iter()
        .filter_map(|key| input[*key].as_array())
        .map(|list| list.iter().map(number).collect())
        .collect();
    let states = list(&case["states"]).iter().map(|state| number(&state["t"]));
    for time_s in states.chain([end_s]) {
        if !t.contains(&time_s) {
            let i = t.iter().position(|x| *x > time_s).expect("a time inside the record");
            let x = (time_s - t[i - 1]) / (t[i] - t[i - 1]);
            t.insert(i, time_s);
            for values in &mut lists {
                let between = values[i - 1] + (values[i] - values[i - 1]) * x;
                values.insert(i, between);
            }
        }
    }
    let count = t.iter().rposition(|t| *t <= end_s).expect("a sample") + 1;
    t.truncate(count);
    lists.iter_mut().for_each(|values| values.truncate(count));
    let mut lists = lists.into_iter();
    let (x, y, vertical) = (lists.next().expect("x"), lists.next().expect("y"), lists.next());
    GroundMotion::new(t, x, vertical).and_then(|motion| motion.with_y(y)).expect("a motion")
}

/// Both components of Taft at 0.01 s, scaled to a peak of the larger in g, up to a sample.
pub fn taft(peak_g: f64, samples: usize) -> GroundMotion {
    let component = |text: &str| {
        let value = |line: &str| 9.80665 * line.trim().parse::<f64>().expect("a number");
        let values = text.lines().map(value).collect();
        GroundMotion::evenly_spaced(0.01, values, None).expect("a component")
    };
    let [x, y] = [
        include_str!("../../../../../examples/records/taft-021.txt"),
        include_str!("../../../../../examples/records/taft-111.txt"),
    ]
    .map(component);
    let (pair, _) = x.with_along_y(&y).expect("a pair");
    let pair = pair.scaled_to_peak(9.80665 * peak_g).expect("a pair");
    let part = |list: &[f64]| list[..samples].to_vec();
    GroundMotion::evenly_spaced(0.01, part(pair.horizontal_m_per_s2()), None)
        .and_then(|x| x.with_y(part(pair.horizontal_y_m_per_s2().expect("y"))))
        .expect("a pair")
}
