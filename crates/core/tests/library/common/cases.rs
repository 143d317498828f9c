//! The verification cases of `data/reference/cases.json` as models and ground motions.

use serde_json::Value;
use slipstick::model::{Block, Damping, Frame, InitialState, Model, Slider};
use slipstick::motion::GroundMotion;
use slipstick::slider::Friction;

/// One case.
pub struct Case {
    pub id: String,
    json: Value,
}

/// A sum of sines on an interval.
struct Harmonic {
    from_s: f64,
    to_s: f64,
    horizontal: Vec<[f64; 3]>,
    vertical: Vec<[f64; 3]>,
}

/// All cases in the order of the file.
pub fn all() -> Vec<Case> {
    let text = include_str!("../../../../../data/reference/cases.json");
    let file: Value = serde_json::from_str(text).expect("cases.json is JSON");
    let cases = file["cases"].as_array().expect("a list of cases");
    let case = |json: &Value| Case { id: text_of(&json["id"]), json: json.clone() };
    cases.iter().map(case).collect()
}

/// The case with an id.
pub fn case(id: &str) -> Case {
    all().into_iter().find(|c| c.id == id).unwrap_or_else(|| panic!("no case {id}"))
}

/// A text.
pub fn text_of(value: &Value) -> String {
    value.as_str().expect("a text").to_owned()
}

/// A number.
pub fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("expected a number, found {value}"))
}

/// A list of numbers, or a single one.
pub fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().map_or_else(|| vec![number(value)], |list| list.iter().map(number).collect())
}

impl Case {
    /// A field of the case.
    pub fn field(&self, name: &str) -> &Value {
        &self.json[name]
    }

    /// A list of the case, empty where it has none.
    pub fn list(&self, name: &str) -> &[Value] {
        self.json[name].as_array().map_or(&[], Vec::as_slice)
    }

    /// A parameter, or what stands for it where it is not given.
    pub fn parameter(&self, name: &str, otherwise: f64) -> f64 {
        self.json["params"].get(name).map_or(otherwise, number)
    }

    /// Whether the case is a time history with events and states.
    pub fn is_history(&self) -> bool {
        text_of(self.field("kind")).starts_with("time-history")
    }

    /// Amplitude in m/s², rate in rad/s and phase of the first sine of the input.
    pub fn sine(&self) -> [f64; 3] {
        term(&self.json["input"]["pieces"][0]["terms"][0])
    }

    /// Whether the input is made of sines.
    pub fn is_harmonic(&self) -> bool {
        self.json["input"]["type"] == "harmonic"
    }

    /// The model; times its frictions `factor`.
    pub fn model(&self) -> Model {
        let p = |name: &str| self.parameter(name, 0.0);
        let both = |name: &str| {
            [("pos"), ("neg")].map(|side| self.parameter(&format!("{name}_{side}"), p(name)))
        };
        let friction = Friction::by_direction(both("mu_s"), both("mu_d")).expect("friction");
        let initial = &self.json["initial"];
        let start = |name: &str| initial.get(name).map_or(0.0, number);
        let (masses, stiffnesses, damping) = if let Some(m) = self.json["params"].get("m") {
            let k = numbers(&self.json["params"]["k"]);
            (numbers(m), k, Damping::Ratio(p("xi")))
        } else if p("M2") > 0.0 {
            (vec![p("M2")], vec![p("K2")], Damping::Dampers(vec![p("C2")]))
        } else {
            (vec![], vec![], Damping::Dampers(vec![]))
        };
        let n = masses.len();
        let storeys = |name: &str| {
            let given = initial.get(name).map_or_else(|| vec![0.0; n], numbers);
            if n == 0 { vec![] } else { given }
        };
        let q = if initial.get("q").is_some() { "q" } else { "y" };
        Model::new(
            Block { mass_kg: p("M1"), width_m: None, height_m: None },
            Slider {
                damper_n_s_per_m: p("C1"),
                tilt_rad: p("tilt"),
                ..Slider::sprung(friction, p("K1"))
            },
            Frame { masses_kg: masses, stiffnesses_n_per_m: stiffnesses, damping, heights_m: None },
            self.parameter("g", 9.81),
            InitialState {
                sliding_displacement_m: start("z"),
                sliding_velocity_m_per_s: start("w"),
                storey_displacement_m: Some(storeys(q)),
                storey_velocity_m_per_s: Some(storeys("v")),
            },
        )
        .expect("a model")
    }

    /// The ground motion; sines sampled `per_cycle` times a cycle, with the times of the states
    /// added as collinear samples where `with_states`.
    pub fn motion(&self, per_cycle: usize, with_states: bool) -> GroundMotion {
        if self.is_harmonic() {
            return sampled(&self.harmonics(), per_cycle);
        }
        let input = &self.json["input"];
        let (mut t, mut a) = (numbers(&input["t"]), numbers(&input["a"]));
        let mut vertical = input.get("av").map(numbers);
        let states = self.list("states").iter().map(|s| number(&s["t"]));
        for time_s in states.filter(|_| with_states) {
            if !t.contains(&time_s) {
                let i = t.iter().position(|x| *x > time_s).expect("a time inside the record");
                let x = (time_s - t[i - 1]) / (t[i] - t[i - 1]);
                t.insert(i, time_s);
                for list in [Some(&mut a), vertical.as_mut()].into_iter().flatten() {
                    list.insert(i, list[i - 1] + (list[i] - list[i - 1]) * x);
                }
            }
        }
        GroundMotion::new(t, a, vertical).expect("a motion")
    }

    /// The first sine of the input for whole cycles `from` to `to`, its vertical beside it.
    pub fn cycles(&self, per_cycle: usize, from: usize, to: usize) -> GroundMotion {
        let piece = &self.harmonics()[0];
        cycles(piece.horizontal[0], piece.vertical.first(), per_cycle, from, to)
    }

    fn harmonics(&self) -> Vec<Harmonic> {
        let terms = |list: &Value| {
            list.as_array().map_or_else(Vec::new, |l| l.iter().map(term).collect::<Vec<_>>())
        };
        let piece = |p: &Value| Harmonic {
            from_s: number(&p["t0"]),
            to_s: number(&p["t1"]),
            horizontal: terms(&p["terms"]),
            vertical: terms(&p["av_terms"]),
        };
        let pieces = self.json["input"]["pieces"].as_array().expect("pieces");
        pieces.iter().map(piece).collect()
    }
}

/// Amplitude, rate and phase of a term.
fn term(value: &Value) -> [f64; 3] {
    ["A", "omega", "phi"].map(|name| number(&value[name]))
}

fn sum(terms: &[[f64; 3]], time_s: f64) -> f64 {
    terms.iter().map(|[a, omega, phi]| a * libm::sin(omega * time_s + phi)).sum()
}

/// Whole cycles of `A sin(ωt + φ)`, counted from t = 0, on a clock that starts at the first.
pub fn cycles(
    horizontal: [f64; 3],
    vertical: Option<&[f64; 3]>,
    per_cycle: usize,
    from: usize,
    to: usize,
) -> GroundMotion {
    let dt_s = std::f64::consts::TAU / horizontal[1] / per_cycle as f64;
    let samples = from * per_cycle..=to * per_cycle;
    let values =
        |term: [f64; 3]| samples.clone().map(|k| sum(&[term], k as f64 * dt_s)).collect::<Vec<_>>();
    GroundMotion::evenly_spaced(dt_s, values(horizontal), vertical.map(|v| values(*v)))
        .expect("a motion")
}

/// Sines sampled at multiples of the step and at the exact end of each piece; free of terms: zero.
fn sampled(pieces: &[Harmonic], per_cycle: usize) -> GroundMotion {
    let (mut t, mut a, mut vertical) = (vec![], vec![], vec![]);
    for piece in pieces {
        let mut push = |time_s: f64| {
            t.push(time_s);
            a.push(sum(&piece.horizontal, time_s));
            vertical.push(sum(&piece.vertical, time_s));
        };
        push(piece.from_s);
        if let Some([_, omega, _]) = piece.horizontal.first() {
            let dt_s = std::f64::consts::TAU / omega / per_cycle as f64;
            let count = ((piece.to_s - piece.from_s) / dt_s).round() as usize;
            let inside = (1..count.max(1)).map(|k| piece.from_s + k as f64 * dt_s);
            inside.filter(|x| *x < piece.to_s - 1e-9 * dt_s).for_each(&mut push);
        }
        push(piece.to_s);
    }
    let still = vertical.iter().all(|x| *x == 0.0);
    GroundMotion::new(t, a, (!still).then_some(vertical)).expect("a motion")
}
