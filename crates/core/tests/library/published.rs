//! Figures that others have published, repeated: theirs, ours, and whose error a difference is. Every case prints its
//! rows, of which `cargo xtask reference` makes the book's table.

// Every case says what it found: the book's table is made of it. Helpers of tests may panic as tests do.
#![allow(clippy::disallowed_macros, clippy::expect_used)]

use crate::common::cases::{case, cycles};
use core::f64::consts::{FRAC_1_SQRT_2, PI, TAU};
use slipstick::check::check;
use slipstick::input;
use slipstick::model::Model;
use slipstick::motion::GroundMotion;
use slipstick::response::{EventKind, Response};
use slipstick::solver::exact;

/// One figure that a source states.
struct Figure {
    what: &'static str,
    /// As it is printed there; of a formula, its value with six digits.
    published: String,
    ours: f64,
    /// What it is by a closed form, and how near ours must be to that; none where the published figure is all there is.
    truth: Option<(f64, f64)>,
    /// Where ours does not round to the published figure, why.
    because: &'static str,
}

impl Figure {
    /// A figure printed with its digits.
    fn printed(what: &'static str, published: &str, ours: f64) -> Self {
        Self { what, published: published.to_owned(), ours, truth: None, because: "" }
    }

    /// A published formula, and how near ours must be to its value.
    fn formula(what: &'static str, value: f64, ours: f64, within: f64) -> Self {
        Self { truth: Some((value, within)), ..Self::printed(what, &six_digits(value), ours) }
    }

    fn truly(self, value: f64, within: f64) -> Self {
        Self { truth: Some((value, within)), ..self }
    }

    fn because(self, because: &'static str) -> Self {
        Self { because, ..self }
    }

    /// Whether ours rounds to the published figure: within half a unit of its last digit.
    fn rounds(&self) -> bool {
        let value: f64 = self.published.parse().expect("a number");
        let (mantissa, exponent) = self.published.split_once('e').unwrap_or((&self.published, "0"));
        let decimals = mantissa.split_once('.').map_or(0, |(_, digits)| digits.len());
        let exponent: i32 = exponent.parse().expect("an exponent");
        let unit = libm::pow(10.0, f64::from(exponent - decimals as i32));
        (self.ours - value).abs() <= 0.5 * unit * (1.0 + 1e-9)
    }
}

fn six_digits(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let decimals = (5 - libm::log10(value.abs()).floor() as i32).max(0) as usize;
    format!("{value:.decimals$}")
}

/// Prints the rows of a case and fails with every figure that is not what it should be.
fn told(id: &str, source: &str, figures: &[Figure]) {
    let mut wrong = Vec::new();
    for figure in figures {
        let Figure { what, published, ours, truth, because } = figure;
        let rounds = figure.rounds();
        let whose = if rounds { "none" } else { because };
        println!(
            "published {id} | {source} | {what} | {published} | {} | {whose}",
            six_digits(*ours)
        );
        if rounds != because.is_empty() {
            wrong
                .push(format!("{what}: published {published}, ours {ours}, because \"{because}\""));
        }
        if let Some((value, within)) = truth {
            let error = (ours / value - 1.0).abs();
            if error > *within {
                wrong.push(format!("{what}: {ours} for {value}, {error:.1e} off"));
            }
        }
    }
    assert!(wrong.is_empty(), "{id}:\n{}", wrong.join("\n"));
}

fn model(text: &str) -> Model {
    input::parse("published", text, &[]).expect("a model").model
}

/// A certified response.
fn certified(model: &Model, motion: &GroundMotion) -> Response {
    let response = exact(model, motion).expect("a response");
    let certificate = check(model, motion, &response);
    assert!(certificate.holds(), "{certificate:?}");
    response
}

fn at_rest(end_s: f64) -> GroundMotion {
    GroundMotion::new(vec![0.0, end_s], vec![0.0; 2], None).expect("a motion")
}

/// The place where a function changes its sign, which it does once.
fn root(mut between: [f64; 2], of: impl Fn(f64) -> f64) -> f64 {
    let start = of(between[0]);
    for _ in 0..34 {
        let middle = 0.5 * (between[0] + between[1]);
        between[usize::from(start * of(middle) <= 0.0)] = middle;
    }
    0.5 * (between[0] + between[1])
}

/// code_aster, SDND100: 1 kg on a spring of 10 kN/m, μ = 0.1, g = 10 m/s², let go 0.85 mm from rest; the position at
/// the turning points along an axis at 45°.
#[test]
fn sdnd100_friction_oscillator_let_go() {
    let model = model(
        "[analysis]\ngravity = \"10 m/s2\"\n[block]\nmass = \"1 kg\"\n[slider]\nstatic_friction = 0.1\nkinetic_friction = 0.1\n\
         spring = \"10 kN/m\"\n[initial]\nsliding_displacement = \"0.85 mm\"\n",
    );
    let response = certified(&model, &at_rest(0.3));
    let turns = response.events.iter().filter(|e| e.kind != EventKind::Slip);
    let places: Vec<f64> = turns.map(|e| e.sliding_displacement_m * FRAC_1_SQRT_2).collect();
    let [first, second, third, fourth] = places[..] else { panic!("{places:?}") };
    let at = |m: f64| (m * FRAC_1_SQRT_2, 1e-10);
    let figure = |what, published, ours, (value, within)| {
        Figure::printed(what, published, ours).truly(value, within)
    };
    told(
        "SDND100",
        "code_aster, V5.01.100",
        &[
            figure("position after π/ω, m", "-4.596e-4", first, at(-0.65e-3)),
            figure("after 2 π/ω, m", "3.182e-4", second, at(0.45e-3)),
            figure("after 3 π/ω, m", "-1.768e-4", third, at(-0.25e-3)),
            figure("after 4 π/ω, where it stays, m", "3.536e-5", fourth, at(0.05e-3)),
        ],
    );
}

/// code_aster, SDND101: 100 kg on a spring of 10 kN/m against a stop of 1 MN/m on one side, without a gap, at 1 m/s.
#[test]
fn sdnd101_oscillator_against_a_stop() {
    let model = model(
        "[block]\nmass = \"100 kg\"\n[slider]\nstatic_friction = 0.0\nkinetic_friction = 0.0\nspring = \"10 kN/m\"\n\
         [slider.stop]\ngap = { negative = \"0 m\" }\nstiffness = \"1 MN/m\"\n[initial]\nsliding_velocity = \"-1 m/s\"\n",
    );
    let response = certified(&model, &at_rest(0.36 + 0.018));
    let of = |kind| response.events.iter().filter(move |e| e.kind == kind).map(|e| e.time_s);
    let left: Vec<f64> = of(EventKind::Leave).collect();
    let [first_s, second_s] = left[..] else { panic!("{:?}", response.events) };
    let reached_s = of(EventKind::Contact).fold(0.0, f64::max);
    let stop = response.demands.stop.expect("a stop");
    let omega = libm::sqrt(1.01e6 / 100.0);
    let (touching_s, away_s) = (PI / omega, PI / 10.0);
    told(
        "SDND101",
        "code_aster, V5.01.101",
        &[
            Figure::printed("middle of the first contact, s", "0.01563", 0.5 * first_s)
                .truly(0.5 * touching_s, 1e-10),
            Figure::printed("middle of the second, s", "0.361", 0.5 * (reached_s + second_s))
                .truly(1.5 * touching_s + away_s, 1e-10),
            Figure::printed("its duration, s", "0.03126", second_s - reached_s)
                .truly(touching_s, 1e-9),
            Figure::printed("largest force of the stop, N", "9950.0", stop.peak_force_n)
                .truly(1e6 / omega, 1e-10)
                .because("theirs: 9950.37 N by the formula, written with three digits"),
            Figure::printed(
                "speed at the second contact, m/s",
                "1.0",
                stop.peak_impact_speed_m_per_s,
            )
            .truly(1.0, 1e-10),
        ],
    );
}

/// code_aster, SDND104: 1 kg pressed with 10 N, μ = 0.1, on a table that shakes at 1 Hz; the mean power of friction
/// from 4 s to 12 s. Its reference value leaves out the spring that its model has.
#[test]
fn sdnd104_block_on_a_shaking_table() {
    let text = "[analysis]\ngravity = \"10 m/s2\"\n[block]\nmass = \"1 kg\"\n[slider]\nstatic_friction = 0.1\n\
                kinetic_friction = 0.1\n";
    let (free, sprung) = (model(text), model(&format!("{text}spring = \"3e-5 N/m\"\n")));
    let power_w = |model: &Model, amplitude: f64| {
        let path_m = |to: usize| {
            let motion = cycles([amplitude, TAU, 0.0], None, 20_000, 0, to);
            certified(model, &motion).demands.sliding_path_m
        };
        10.0 * 0.1 * 10.0 * (path_m(12) - path_m(4)) / 8.0
    };
    told(
        "SDND104",
        "code_aster, V5.01.104",
        &[
            Figure::printed("N ∫|ṡ| dt over 8 s at 15 m/s², W", "15.2671", power_w(&free, 15.0)),
            Figure::printed(
                "the same on their spring of 3e-5 N/m, W",
                "15.2671",
                power_w(&sprung, 15.0),
            )
            .because("theirs: the value is that without the spring"),
            Figure::printed("at 1.5 m/s², W", "0.409062", power_w(&free, 1.5)),
            Figure::printed("at 1.01 m/s², W", "2.26164e-4", power_w(&free, 1.01)),
            Figure::printed("at 0.99 m/s², W", "0.0", power_w(&free, 0.99)),
        ],
    );
}

/// Den Hartog (1931): steady amplitude of an oscillator with friction and viscous damping that does not stop, over that of
/// the static displacement, at a ratio of frequencies β, a damping ratio ζ and friction over force f.
#[test]
fn den_hartog_amplitude_with_viscous_damping() {
    let by_formula = |[beta, zeta, f]: [f64; 3]| {
        let (root, angle) = (libm::sqrt(1.0 - zeta * zeta), PI / beta);
        let below = libm::cosh(zeta * angle) + libm::cos(root * angle);
        let g = (libm::sinh(zeta * angle) - zeta / root * libm::sin(root * angle)) / below;
        let h = libm::sin(root * angle) / (root * beta * below);
        let (inertia, damping) = (1.0 - beta * beta, 2.0 * zeta * beta);
        let linear = 1.0 / (inertia * inertia + damping * damping);
        libm::sqrt(linear - h * f * h * f) - g * f
    };
    let by_ours = |[beta, zeta, f]: [f64; 3]| {
        // A mass of 1 kg on 1 N/m: ω_n = 1 rad/s.
        let damper = 2.0 * zeta;
        let model = model(&format!(
            "[analysis]\ngravity = \"1 m/s2\"\n[block]\nmass = \"1 kg\"\n[slider]\nstatic_friction = {f}\n\
             kinetic_friction = {f}\nspring = \"1 N/m\"\ndamper = \"{damper} N s/m\"\n",
        ));
        let response = certified(&model, &cycles([1.0, beta, 0.0], None, 4000, 0, 80));
        let mut turns = response.events.iter().filter(|e| e.kind == EventKind::Reversal);
        turns.next_back().expect("a reversal").sliding_displacement_m.abs()
    };
    let figure = |what, case| Figure::formula(what, by_formula(case), by_ours(case), 1e-5);
    told(
        "DEN-HARTOG",
        "Den Hartog (1931)",
        &[
            figure("amplitude at β = 0.8, ζ = 0.05, f = 0.4", [0.8, 0.05, 0.4]),
            figure("amplitude at β = 1.5, ζ = 0.1, f = 0.3", [1.5, 0.1, 0.3]),
        ],
    );
}

/// Newmark (1965): a block of resistance N g under a rectangular pulse A g that leaves the velocity V slides
/// V²/(2 g N) (1 − N/A).
#[test]
fn newmark_rectangular_pulse() {
    let (n, a, g, pulse_s) = (0.1, 0.4, 9.80665, 0.25);
    let model = model(&format!(
        "[block]\nmass = \"1 t\"\n[slider]\nstatic_friction = {n}\nkinetic_friction = {n}\n"
    ));
    let motion =
        GroundMotion::new(vec![0.0, pulse_s, pulse_s, 3.0], vec![a * g, a * g, 0.0, 0.0], None);
    let response = certified(&model, &motion.expect("a motion"));
    let v = a * g * pulse_s;
    let value = v * v / (2.0 * g * n) * (1.0 - n / a);
    let ours = response.demands.peak_sliding_displacement_m;
    told(
        "NEWMARK",
        "Newmark (1965)",
        &[Figure::formula("displacement at A/N = 4, V = 0.98 m/s, m", value, ours, 1e-10)],
    );
}

/// Westermo and Udwadia (1983): under a sine the block never stops below μ g/A = 1/√(1 + π²/4).
#[test]
fn westermo_udwadia_critical_ratio() {
    let stops = |eta: f64| {
        let model = model(&format!(
            "[analysis]\ngravity = \"1 m/s2\"\n[block]\nmass = \"1 kg\"\n[slider]\nstatic_friction = {eta}\n\
             kinetic_friction = {eta}\n"
        ));
        let motion = cycles([1.0, TAU, 0.0], None, 4000, 0, 20);
        let events = exact(&model, &motion).expect("a response").events;
        let late = |e: &slipstick::response::Event| e.kind == EventKind::Stick && e.time_s > 15.0;
        if events.iter().any(late) { 1.0 } else { -1.0 }
    };
    let ours = root([0.5, 0.6], stops);
    let value = 1.0 / libm::sqrt(1.0 + 0.25 * PI * PI);
    told(
        "WESTERMO-UDWADIA",
        "Westermo and Udwadia (1983)",
        &[Figure::formula("least μ g/A at which it stops", value, ours, 1e-5)],
    );
}

/// Abramowitz and Stegun, 20.2.25: characteristic values of Mathieu's equation `y″ + (a − 2 q cos 2τ) y = 0`, on whose
/// sides a pendulum without friction under a vertical sine stays or grows without bound.
#[test]
fn mathieu_characteristic_values() {
    let q = 0.25;
    // One cycle of the vertical motion is τ = π; R = g = 1 with time in units of the pendulum.
    let after_a_cycle = |a: f64, initial: &str| {
        let model = model(&format!(
            "[analysis]\ngravity = \"1 m/s2\"\n[block]\nmass = \"1 kg\"\n[slider]\nstatic_friction = 0.0\n\
             kinetic_friction = 0.0\nradius = \"1 m\"\n[initial]\n{initial}\n"
        ));
        let rate = 2.0 / libm::sqrt(a);
        let still = [0.0, rate, 0.0];
        let vertical = [-2.0 * q / a, rate, PI / 2.0];
        let motion = cycles(still, Some(&vertical), 4000, 0, 1);
        let history = certified(&model, &motion).history.expect("a history");
        let last = history.len() - 1;
        (history.sliding_displacement_m[last], history.sliding_velocity_m_per_s[last])
    };
    let even = |a| after_a_cycle(a, "sliding_displacement = \"1 m\"").1;
    let odd = |a| after_a_cycle(a, "sliding_velocity = \"1 m/s\"").0;
    let q2 = q * q;
    let (q4, q6) = (q2 * q2, q2 * q2 * q2);
    let a2 = 4.0 + 5.0 * q2 / 12.0 - 763.0 * q4 / 13824.0 + 1_002_401.0 * q6 / 79_626_240.0;
    let b2 = 4.0 - q2 / 12.0 + 5.0 * q4 / 13824.0 - 289.0 * q6 / 79_626_240.0;
    told(
        "MATHIEU",
        "Abramowitz and Stegun (1964), 20.2.25",
        &[
            Figure::formula("a₂(0.25): even motion repeats", a2, root([4.01, 4.1], even), 3e-7),
            Figure::formula("b₂(0.25): odd motion repeats", b2, root([3.9, 4.01], odd), 3e-7),
        ],
    );
}

/// Fenz and Constantinou (2008): where the surfaces of a triple pendulum start and where their travel ends, as
/// displacement, and the way back of twice a displacement of the way out (Masing).
#[test]
fn fenz_constantinou_five_regimes() {
    let [l1, l2, l3, l4] = [1.25, 0.18, 0.18, 1.25];
    let (mu1, mu2, mu4, travel) = (0.052, 0.012, 0.14, 0.12);
    let thrown = |speed: f64| {
        let model = model(&format!(
            "[block]\nmass = \"500 t\"\n[slider.triple]\neffective_radius = [\"{l1} m\", \"{l2} m\", \"{l3} m\", \
             \"{l4} m\"]\nfriction = [{mu1}, {mu2}, {mu2}, {mu4}]\n\
             travel = [\"{travel} m\", \"0.05 m\", \"0.05 m\", \"{travel} m\"]\n\
             [initial]\nsliding_velocity = \"{speed} m/s\"\n"
        ));
        let response = certified(&model, &at_rest(1.5));
        let peak_m = response.demands.max_sliding_displacement_m;
        let peak_s = response.demands.peak_sliding_displacement_time_s;
        let surfaces: Vec<_> =
            response.events.iter().filter(|e| e.kind == EventKind::Surface).collect();
        let part = |back: bool| -> Vec<f64> {
            let of = surfaces.iter().filter(|e| (e.time_s > peak_s) == back);
            of.map(|e| e.sliding_displacement_m).collect()
        };
        (peak_m, part(false), part(true))
    };
    let first = (mu1 - mu2) * (l2 + l3);
    let second = first + (mu4 - mu1) * (l1 + l3);
    let end1 = mu1 + travel / l1;
    let third = second + (end1 - mu4) * (l1 + l4);
    let fourth = third + (mu4 + travel / l4 - end1) * (l2 + l4);
    let (peak_m, out, _) = thrown(0.94);
    assert!(peak_m > fourth, "{peak_m} m");
    let [ours1, ours2, ours3, ours4] = out[..] else { panic!("{out:?}") };
    // In the third regime, where no travel is used up, what is unloaded is twice what was loaded.
    let (peak_m, _, back) = thrown(0.52);
    assert!(peak_m > second && peak_m < third, "{peak_m} m");
    let [back1, ..] = back[..] else { panic!("{back:?}") };
    let figure = |what, value, ours| Figure::formula(what, value, ours, 1e-9);
    told(
        "FENZ-CONSTANTINOU",
        "Fenz and Constantinou (2008)",
        &[
            figure("u*: surface 1 starts, m", first, ours1),
            figure("u**: surface 4 starts, m", second, ours2),
            figure("u_dr1: surface 1 at its end, m", third, ours3),
            figure("u_dr4: surface 4 at its end, m", fourth, ours4),
            figure("way back until surface 1 starts, 2 u*, m", 2.0 * first, peak_m - back1),
        ],
    );
}

/// The paper: largest acceleration of the oscillator on a block that does not slide, over that of the table, ξ = 1 %.
#[test]
fn paper_amplifications_at_a_fixed_base() {
    let amplification = |frequency_hz: f64, own_hz: f64| {
        let model = model(&format!(
            "[block]\nmass = \"325 kg\"\n[slider]\nstatic_friction = 9.0\nkinetic_friction = 9.0\n\
             [[storey]]\nmass = \"201 kg\"\nfrequency = \"{own_hz} Hz\"\ndamping_ratio = 0.01\n"
        ));
        let motion = cycles([1.0, TAU * frequency_hz, 0.0], None, 1000, 0, 250);
        let history = exact(&model, &motion).expect("a response").history.expect("a history");
        let late = (0..history.len()).filter(|k| history.time_s[*k] > 245.0 / frequency_hz);
        late.map(|k| history.storey_accelerations(k)[0].abs()).fold(0.0, f64::max)
    };
    let of = |id: &str| case(id).list("expect")[0]["value"].as_f64().expect("a number");
    told(
        "PAPER",
        "the paper",
        &[
            Figure::printed("at 1 Hz of 1.125 Hz", "4.22", amplification(1.0, 1.125))
                .truly(of("SDOF-SS-1-1.125"), 1e-4)
                .because("theirs: 4.75 by the formula for that damping ratio"),
            Figure::printed("at 2.984 Hz of 2.687 Hz", "4.27", amplification(2.984, 2.687))
                .truly(of("SDOF-SS-2.984-2.687"), 1e-4),
        ],
    );
}
