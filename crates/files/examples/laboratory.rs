//! Makes the tests of `examples/laboratory`: cyclic tests, a shaking-table test and free vibration of
//! a mock-up that exists only here, with noise. What is put in stands below and in the README there.
//!
//! Run from the root of the repository: `cargo run --example laboratory -p slipstick-files`.

use std::error::Error;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::Path;

use slipstick::input;
use slipstick::input::Scale;
use slipstick::motion::GroundMotion;
use slipstick::solver;
use slipstick::study::Random;
use slipstick_files::{RecordRequest, load_record, write_whole};

/// The mock-up as it "is": the block of section 3 of the paper, on a surface that is not quite level.
const TRUTH: &str = r#"
[block]
mass = "124 kg"
[slider]
static_friction  = 0.165
kinetic_friction = 0.153
tilt = "1.5 mrad"
"#;
const MASS_KG: f64 = 124.0;
const STATIC: f64 = 0.165;
const KINETIC: f64 = 0.153;
const GRAVITY: f64 = slipstick::units::STANDARD_GRAVITY_M_PER_S2;

const FOLDER: &str = "examples/laboratory";

fn main() -> Result<(), Box<dyn Error>> {
    for (i, (name, frequency_hz)) in
        [("cyclic-0.1hz.csv", 0.1), ("cyclic-0.25hz.csv", 0.25), ("cyclic-1hz.csv", 1.0)]
            .into_iter()
            .enumerate()
    {
        write(name, &cyclic(frequency_hz, i as u64))?;
    }
    for (i, (name, frequency_hz)) in
        [("bearing-0.005hz.csv", 0.005), ("bearing-0.05hz.csv", 0.05), ("bearing-0.5hz.csv", 0.5)]
            .into_iter()
            .enumerate()
    {
        write(name, &bearing(&Bearing { frequency_hz, seed: 30 + i as u64, ..Bearing::BY_SPEED }))?;
    }
    for (i, load_kn) in [400, 800, 1600].into_iter().enumerate() {
        let normal_n = 1e3 * f64::from(load_kn);
        let bearing_of = Bearing { normal_n, seed: 40 + i as u64, ..Bearing::BY_PRESSURE };
        write(&format!("load-{load_kn:04}kn.csv"), &bearing(&bearing_of))?;
    }
    write("shaking-table.csv", &shaking_table()?)?;
    write("pull-back.csv", &pull_back()?)
}

fn write(name: &str, text: &str) -> Result<(), Box<dyn Error>> {
    write_whole(&Path::new(FOLDER).join(name), text.as_bytes())?;
    println!("{FOLDER}/{name}");
    Ok(())
}

/// An actuator behind a load cell drags the block to and fro, without inertia: it sticks while the
/// force is below static friction, and follows when it slides.
fn cyclic(frequency_hz: f64, seed: u64) -> String {
    const FINE: usize = 10;
    let (amplitude_m, load_train_n_per_m, viscous) = (0.015, 6e4, 1.0);
    let mut random = Random::new(seed);
    let dt_s = 0.001 / frequency_hz;
    let h = dt_s / FINE as f64;
    let weight_n = MASS_KG * GRAVITY;
    let wander = TAU * random.uniform();
    let (mut x, mut sliding) = (0.0, false);
    let mut text = String::from("time (s),displacement (mm),force (N)\n");
    for i in 0..6300 * FINE {
        let t = i as f64 * h;
        let turns = TAU * frequency_hz * t;
        let target = amplitude_m * libm::sin(turns + 0.03 * libm::sin(0.3819 * turns + wander));
        let demand = load_train_n_per_m * (target - x);
        sliding = sliding || demand.abs() > STATIC * weight_n;
        if sliding {
            let friction = (KINETIC * weight_n).copysign(demand);
            let moved = (x + h / viscous * (load_train_n_per_m * target - friction))
                / (1.0 + h / viscous * load_train_n_per_m);
            if (moved - x) * demand > 0.0 { x = moved } else { sliding = false }
        }
        if i % FINE == 0 {
            let force_n = load_train_n_per_m * (target - x) + 0.8 * random.normal();
            let shown_mm = 1e3 * (x + 1e-5 * random.normal());
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{t:.4},{shown_mm:.3},{force_n:.2}");
        }
    }
    text
}

/// A bearing of 0.04 m² in a press that gives way a little before it breaks away, and its test.
struct Bearing {
    normal_n: f64,
    frequency_hz: f64,
    samples_a_cycle: f64,
    samples: usize,
    press_n_per_m: f64,
    /// Static, slow and fast friction at 20 MPa.
    friction: [f64; 3],
    rate_s_per_m: f64,
    /// By which friction falls as the pressure grows.
    exponent: f64,
    seed: u64,
}

impl Bearing {
    /// Under 800 kN, with friction that follows the speed.
    const BY_SPEED: Self = Self {
        normal_n: 8e5,
        frequency_hz: 0.5,
        samples_a_cycle: 1000.0,
        samples: 4400,
        press_n_per_m: 1e8,
        friction: [0.09, 0.04, 0.08],
        rate_s_per_m: 25.0,
        exponent: 0.0,
        seed: 30,
    };

    /// With friction that follows the pressure.
    const BY_PRESSURE: Self = Self {
        frequency_hz: 0.08,
        samples_a_cycle: 625.0,
        samples: 2750,
        press_n_per_m: 2e7,
        friction: [0.1, 0.07, 0.07],
        exponent: 0.2,
        ..Self::BY_SPEED
    };
}

/// A pendulum bearing between ± 80 mm, whose friction differs by 1 % from stroke to stroke.
fn bearing(of: &Bearing) -> String {
    const FINE: usize = 4;
    let (radius_m, amplitude_m) = (2.5, 0.08);
    let Bearing { normal_n, frequency_hz, press_n_per_m, rate_s_per_m, .. } = *of;
    let [limit, slow, fast] = of.friction;
    let pendulum_n_per_m = normal_n / radius_m;
    let by_pressure = libm::pow(normal_n / 8e5, -of.exponent);
    let mut random = Random::new(of.seed);
    let dt_s = 1.0 / of.samples_a_cycle / frequency_hz;
    let h = dt_s / FINE as f64;
    let elastic = (press_n_per_m + pendulum_n_per_m) * h;
    let wander = TAU * random.uniform();
    let (mut x, mut v, mut sliding) = (0.0, 0.0_f64, false);
    let (mut stroke, mut factor) = (-1.0, 1.0);
    let mut text = String::from("time (s),displacement (mm),force (kN)\n");
    for i in 0..of.samples * FINE {
        let t = i as f64 * h;
        let turns = frequency_hz * t;
        let turns = turns + 0.005 * libm::sin(0.3819 * TAU * turns + wander);
        let target = amplitude_m * libm::sin(TAU * turns);
        if libm::floor(2.0 * turns + 0.5) > stroke {
            stroke = libm::floor(2.0 * turns + 0.5);
            factor = normal_n * by_pressure * (1.0 + 0.01 * random.normal());
        }
        let demand = press_n_per_m * (target - x) - pendulum_n_per_m * x;
        sliding |= demand.abs() > limit * factor;
        if sliding {
            // (press + pendulum) h v + N μ(v) = |demand|.
            for _ in 0..8 {
                let fade = (fast - slow) * libm::exp(-rate_s_per_m * v);
                let excess = elastic * v + factor * (fast - fade) - demand.abs();
                v = (v - excess / (elastic + factor * rate_s_per_m * fade)).max(0.0);
            }
            sliding = v > 0.0;
            x += v * h * demand.signum();
        }
        if i % FINE == 0 {
            let force_kn = 1e-3 * press_n_per_m * (target - x) + 0.2 * random.normal();
            let shown_mm = 1e3 * x + 0.02 * random.normal();
            // Writing to a String cannot fail.
            let _ = writeln!(text, "{t:.4},{shown_mm:.2},{force_kn:.2}");
        }
    }
    text
}

/// The Taft record at 0.4 g, as three sensors saw it; that on the block points the other way.
fn shaking_table() -> Result<String, Box<dyn Error>> {
    let request = RecordRequest {
        path: "examples/records/taft-111.txt".into(),
        units: slipstick::record::Units::parse("g"),
        dt_s: Some(0.01),
        scale: Some(Scale::Peak(0.4 * GRAVITY)),
        ..RecordRequest::default()
    };
    let record = load_record(&request)?.loaded.motion;
    let table = record.horizontal_m_per_s2()[..3000].to_vec();
    let motion = GroundMotion::evenly_spaced(0.01, table, None)?;
    let model = input::parse("truth", TRUTH, &[])?.model;
    let history = solver::exact(&model, &motion)?.history.ok_or("no history")?;
    let mut random = Random::new(12);
    let mut text = String::from("t,A0,A1,D1\n");
    for (i, &knot) in history.rows.iter().enumerate() {
        let mut noisy = |value: f64, noise: f64| value + noise * random.normal();
        let table = noisy(history.table_acceleration_m_per_s2[knot], 0.005) / GRAVITY;
        let block = noisy(history.block_acceleration_m_per_s2[knot], 0.03) / GRAVITY;
        let sliding_mm = 1e3 * noisy(history.sliding_displacement_m[knot], 1e-4);
        let _ = writeln!(text, "{:.2},{table:.5},{:.5},{sliding_mm:.3}", 0.01 * i as f64, -block);
    }
    Ok(text)
}

/// A storey of 1.625 Hz and 1 % pulled aside by 8 mm and let go.
fn pull_back() -> Result<String, Box<dyn Error>> {
    let text = r#"
[block]
mass = "325 kg"
[slider]
static_friction = 0.02
kinetic_friction = 0.012
[[storey]]
mass = "45 kg"
frequency = "1.625 Hz"
damping_ratio = 0.01
[initial]
storey_displacement = ["8 mm"]
"#;
    // The block is held for this test: with so much friction it does not move.
    let held = text.replace("0.02\n", "1.0\n").replace("0.012", "1.0");
    let model = input::parse("pull-back", &held, &[])?.model;
    let motion = GroundMotion::evenly_spaced(0.01, vec![0.0; 1201], None)?;
    let history = solver::exact(&model, &motion)?.history.ok_or("no history")?;
    let mut random = Random::new(21);
    let mut text = String::from("time_s,storey1_acceleration_m_per_s2\n");
    for (i, &knot) in history.rows.iter().enumerate() {
        let a = history.storey_accelerations(knot)[0] + 0.02 * random.normal();
        let _ = writeln!(text, "{:.2},{a:.4}", 0.01 * i as f64);
    }
    Ok(text)
}
