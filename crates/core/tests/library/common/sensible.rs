//! What an engineer would write: machines, tanks, buildings and mock-ups on sliders under earthquakes,
//! sines, sweeps and pulses, with the devices that such things have, in round numbers.

use std::ops::Range;
use std::sync::OnceLock;

use slipstick::model::{Contents, Damping, Stop, StopKind};
use slipstick::motion::{GroundMotion, Pulse, PulseShape, Sine, Sweep, SweepKind};
use slipstick::slider::{RateCurve, Surface, SurfacesInSeries};

use super::random::Random;
use super::sketch::Sketch;

const G: f64 = 9.80665;
const DT_S: f64 = 0.01;

/// Two recorded accelerograms in g at 0.01 s.
fn records() -> &'static [Vec<f64>; 2] {
    static RECORDS: OnceLock<[Vec<f64>; 2]> = OnceLock::new();
    RECORDS.get_or_init(|| {
        [
            include_str!("../../../../../examples/records/taft-021.txt"),
            include_str!("../../../../../examples/records/el-centro-180.txt"),
        ]
        .map(|text| text.lines().map(|line| line.trim().parse().expect("a number")).collect())
    })
}

/// A number with so many significant digits.
fn round(x: f64, digits: usize) -> f64 {
    format!("{x:.*e}", digits - 1).parse().expect("a number")
}

impl Random {
    /// Between two numbers, evenly or in the logarithm, as one writes it down.
    fn even(&mut self, low: f64, high: f64) -> f64 {
        round(self.between(low, high), 2)
    }

    fn written(&mut self, low: f64, high: f64) -> f64 {
        round(self.logarithmic(low, high), 2)
    }
}

impl Sketch {
    /// A model and a motion of the length of an analysis: seconds.
    pub fn sensible(random: &mut Random) -> Self {
        let mut x = match random.integer(0, 3) {
            0 => machine(random),
            1 => tank(random),
            2 => building(random),
            _ => mock_up(random),
        };
        let motion = motion(random);
        x.times = motion.times_s().to_vec();
        x.horizontal = motion.horizontal_m_per_s2().to_vec();
        x.vertical = motion.vertical_m_per_s2().map(<[f64]>::to_vec);
        x
    }
}

/// The system of a seed: every other one is what an engineer would write, the rest anything with any
/// devices under a few samples.
pub fn system(seed: u64) -> Sketch {
    let random = &mut Random::new(3_000_017 + seed);
    if seed.is_multiple_of(2) {
        return Sketch::sensible(random);
    }
    let mut x = Sketch::shaken(random);
    x.equip(random);
    x
}

/// The system of a seed with contents and a vertical motion that takes most of the weight or more: coefficients from a
/// short list, so that much lets go together, items that weigh nothing, pendulums.
pub fn lifted(seed: u64) -> Sketch {
    let random = &mut Random::new(11_000_027 + seed);
    let mut x = Sketch::shaken(random);
    if random.chance(0.6) {
        for mu in [&mut x.static_friction, &mut x.kinetic_friction].into_iter().flatten() {
            *mu = round(*mu, 2);
        }
    }
    if random.chance(0.3) {
        x.equip(random);
    }
    if random.chance(0.6) {
        x.static_friction = x.kinetic_friction;
    }
    if random.chance(0.5) && x.series.is_none() {
        x.radius_m = Some(random.logarithmic(0.2, 4.0));
    }
    let own = x.kinetic_friction[0];
    for _ in 0..random.integer(1, 3) {
        let kinetic_friction = match random.integer(0, 3) {
            0 => own,
            1 => random.of(&[0.05, 0.1, 0.2]),
            _ => random.written(0.03, 0.4),
        };
        let static_friction = kinetic_friction * random.of(&[1.0, 1.0, 1.0, 1.25]);
        let mass_kg = x.block * random.of(&[1e-14, 0.01, 0.1, 0.3, 1.0]);
        let floor = random.integer(0, x.masses.len() as i64) as usize;
        x.contents.push(Contents { floor, mass_kg, static_friction, kinetic_friction });
    }
    let up = x.gravity * random.of(&[0.3, 0.7, 0.95, 1.2, 2.0]);
    x.lift(random, up);
    x
}

/// The seeds that `SLIPSTICK_SEEDS=0..5000` asks for, else others.
#[allow(
    clippy::disallowed_methods,
    reason = "tests are told which seeds to run by their environment"
)]
pub fn seeds(others: Range<u64>) -> Range<u64> {
    let given = std::env::var("SLIPSTICK_SEEDS").unwrap_or_default();
    let range = given.split_once("..");
    let range = range.and_then(|(from, to)| Some(from.parse().ok()?..to.parse().ok()?));
    range.unwrap_or(others)
}

/// Friction of a sliding material.
fn friction(random: &mut Random, low: f64, high: f64) -> Sketch {
    let kinetic = random.written(low, high);
    let over = random.of(&[1.0, 1.0, 1.1, 1.25, 1.5]);
    Sketch { gravity: G, ..Sketch::block(round(kinetic * over, 3), kinetic) }
}

/// A machine on the floor, perhaps with something on it, a restraint, a wall.
fn machine(random: &mut Random) -> Sketch {
    let mut x = friction(random, 0.05, 0.5);
    x.block = random.written(50.0, 2e4);
    if random.chance(0.3) {
        x.spring = round(x.block * random.logarithmic(1.0, 100.0), 2);
    }
    if random.chance(0.1) {
        x.damper = round(x.block * random.logarithmic(0.1, 2.0), 2);
    }
    if random.chance(0.15) {
        x.tilt = random.of(&[0.001, -0.002, 0.005, 0.01]);
    }
    if random.chance(0.1) {
        // Two materials, or a worn path.
        x.kinetic_friction[1] = round(0.8 * x.kinetic_friction[0], 2);
    }
    if random.chance(0.3) {
        stop(random, &mut x, [0.005, 0.1]);
    }
    if random.chance(0.2) {
        contents(random, &mut x);
    }
    x
}

/// A tank: what moves with its walls, and perhaps what sloshes.
fn tank(random: &mut Random) -> Sketch {
    let mut x = friction(random, 0.02, 0.12);
    x.block = random.written(1e3, 1e6);
    x.masses = vec![round(x.block * random.logarithmic(0.3, 3.0), 2)];
    let rate = std::f64::consts::TAU * random.of(&[0.2, 0.3, 0.5, 2.0, 5.0, 8.0]);
    x.stiffnesses = vec![round(x.masses[0] * rate * rate, 4)];
    x.damping = Damping::Ratio(random.of(&[0.005, 0.01, 0.02, 0.05]));
    x.v = vec![0.0];
    bearing(random, &mut x);
    if random.chance(0.2) {
        stop(random, &mut x, [0.05, 0.4]);
    }
    x
}

/// A building of some storeys, its moat and what stands in it.
fn building(random: &mut Random) -> Sketch {
    let mut x = friction(random, 0.02, 0.12);
    let floor = random.written(2e4, 1e6);
    let n = random.of(&[1, 2, 2, 3, 3, 5]);
    x.block = floor;
    x.masses = vec![floor; n];
    // A uniform shear frame: ω1 = 2 √(k/m) sin(π / (4 n + 2)).
    let period_s = random.even(0.08, 0.16) * n as f64;
    let lowest = 2.0 * libm::sin(std::f64::consts::PI / (4 * n + 2) as f64);
    let rate = std::f64::consts::TAU / (period_s * lowest);
    x.stiffnesses = vec![round(floor * rate * rate, 4); n];
    x.damping = Damping::Ratio(random.of(&[0.0, 0.02, 0.03, 0.05]));
    x.v = vec![0.0; n];
    bearing(random, &mut x);
    if random.chance(0.3) {
        stop(random, &mut x, [0.1, 0.5]);
    }
    if random.chance(0.35) {
        contents(random, &mut x);
    }
    x
}

/// A block on a shaking table, perhaps with an oscillator on it.
fn mock_up(random: &mut Random) -> Sketch {
    let mut x = friction(random, 0.01, 0.05);
    x.block = random.even(100.0, 500.0);
    if random.chance(0.6) {
        x.masses = vec![random.even(20.0, 200.0)];
        let rate = std::f64::consts::TAU * random.even(0.8, 6.0);
        x.stiffnesses = vec![round(x.masses[0] * rate * rate, 4)];
        x.damping = Damping::Ratio(0.01);
        x.v = vec![0.0];
    }
    if random.chance(0.5) {
        x.spring = random.of(&[4e3, 2e4, 1.43e5]);
    }
    if random.chance(0.2) {
        x.s = random.of(&[0.01, -0.02]);
    }
    if random.chance(0.1) {
        x.w = random.of(&[0.1, -0.05]);
    }
    if random.chance(0.2) {
        stop(random, &mut x, [0.025, 0.1]);
    }
    if random.chance(0.25) {
        contents(random, &mut x);
    }
    x
}

/// A pendulum, a spring, friction by speed, a double or triple pendulum.
fn bearing(random: &mut Random, x: &mut Sketch) {
    if random.chance(0.3) {
        let outer = random.of(&[1.0, 1.5, 2.2]);
        let surface = |radius_m: f64, friction: f64, travel_m: f64| Surface {
            radius_m: Some(radius_m),
            friction,
            travel_m: Some(travel_m),
        };
        let mu = x.kinetic_friction[0];
        let surfaces = if random.chance(0.5) {
            let other = random.of(&[1.0, 1.5, 2.0]);
            vec![surface(outer, mu, 0.4), surface(outer, round(mu * other, 2), 0.4)]
        } else {
            let inner = random.of(&[0.2, 0.4]);
            let more = round(mu * random.of(&[1.5, 2.0]), 2);
            vec![
                surface(2.0 * inner, mu, 0.2),
                surface(outer - inner, more, 0.3),
                surface(outer - inner, round(more * random.of(&[1.0, 1.2]), 3), 0.3),
            ]
        };
        let ratio = random.of(&[1.0, 1.0, 1.2]);
        x.series = Some(SurfacesInSeries::new(surfaces, ratio).expect("surfaces"));
        // Nothing else ends its travel.
        x.stop = Some(Stop { gap_m: [Some(0.5); 2], kind: StopKind::Rigid { restitution: 0.3 } });
        return;
    }
    if random.chance(0.7) {
        x.radius_m = Some(random.of(&[0.5, 1.0, 1.5, 2.0, 2.2, 4.0]));
    } else if random.chance(0.7) {
        let rate = std::f64::consts::TAU / random.even(1.5, 4.0);
        x.spring = round(x.total() * rate * rate, 3);
    }
    if random.chance(0.3) {
        let slow = x.kinetic_friction[0];
        let fast = round(slow * random.of(&[0.7, 1.5, 2.0, 2.5]), 2);
        let curve = if random.chance(0.7) {
            RateCurve::Exponential {
                slow,
                fast,
                rate_s_per_m: random.of(&[20.0, 25.0, 50.0, 100.0]),
            }
        } else {
            RateCurve::Pieces {
                speeds_m_per_s: vec![0.0, 0.05, 0.2],
                coefficients: vec![slow, round(0.5 * (slow + fast), 3), fast],
            }
        };
        x.set_curve(curve);
    }
}

fn stop(random: &mut Random, x: &mut Sketch, gaps_m: [f64; 2]) {
    let gap_m = random.written(gaps_m[0], gaps_m[1]);
    let gap_m = random.of(&[[Some(gap_m); 2], [Some(gap_m); 2], [Some(gap_m), None]]);
    let kind = if random.chance(0.4) {
        StopKind::Rigid { restitution: random.of(&[0.0, 0.3, 0.5, 0.7]) }
    } else {
        let rate = random.logarithmic(10.0, 100.0);
        let stiffness_n_per_m = round(x.total() * rate * rate, 2);
        let ratio = random.of(&[0.0, 0.05, 0.2]);
        let damper_n_s_per_m = round(2.0 * ratio * x.block * rate, 2);
        StopKind::Elastic { stiffness_n_per_m, damper_n_s_per_m }
    };
    x.stop = Some(Stop { gap_m, kind });
}

fn contents(random: &mut Random, x: &mut Sketch) {
    for _ in 0..random.of(&[1, 1, 1, 2, 3]) {
        // Perhaps of the material of the slider.
        let own = x.kinetic_friction[0];
        let kinetic_friction = if random.chance(0.2) { own } else { random.written(0.05, 0.6) };
        let over = random.of(&[1.0, 1.1, 1.25]);
        x.contents.push(Contents {
            floor: random.integer(0, x.masses.len() as i64) as usize,
            mass_kg: round(x.block * random.logarithmic(0.01, 0.5), 2),
            static_friction: round(kinetic_friction * over, 3),
            kinetic_friction,
        });
    }
}

/// An earthquake, or what a shaking table is told.
fn motion(random: &mut Random) -> GroundMotion {
    let amplitude_m_per_s2 = if random.chance(0.03) { 0.0 } else { random.even(0.5, 6.0) };
    let duration_s = random.even(2.0, 10.0);
    let ramp_s = random.of(&[0.0, 0.0, 1.0]);
    let decay_s = random.of(&[0.0, 1.0]);
    let made = match random.integer(0, 7) {
        0 => {
            let (frequency_hz, phase_rad) = (random.written(0.3, 6.0), 0.0);
            Sine {
                frequency_hz,
                amplitude_m_per_s2,
                duration_s,
                dt_s: DT_S,
                phase_rad,
                ramp_s,
                decay_s,
            }
            .motion()
        }
        1 => {
            let kind = random.of(&[SweepKind::Linear, SweepKind::Logarithmic]);
            let (from_hz, to_hz) = (random.even(0.3, 1.0), random.even(3.0, 8.0));
            Sweep {
                from_hz,
                to_hz,
                kind,
                amplitude_m_per_s2,
                duration_s,
                dt_s: DT_S,
                ramp_s,
                decay_s,
            }
            .motion()
        }
        2 => {
            let shape =
                random.of(&[PulseShape::HalfSine, PulseShape::Rectangular, PulseShape::Triangular]);
            let duration_s = random.even(0.1, 1.0);
            Pulse {
                shape,
                amplitude_m_per_s2,
                duration_s,
                start_s: random.of(&[0.0, 0.5]),
                dt_s: DT_S,
            }
            .motion()
        }
        _ => return with_tail(random, recorded),
    };
    with_tail(random, |_| made.expect("a motion"))
}

fn with_tail(
    random: &mut Random,
    motion: impl FnOnce(&mut Random) -> GroundMotion,
) -> GroundMotion {
    let motion = motion(random);
    let tail_s = random.of(&[0.0, 2.0, 5.0]);
    motion.with_tail(tail_s).expect("a motion")
}

/// Some seconds of a record at a round peak, perhaps with a vertical component.
fn recorded(random: &mut Random) -> GroundMotion {
    let record = &records()[random.integer(0, 1) as usize];
    let count = random.integer(300, 1200) as usize;
    let mut part = || {
        let from = random.integer(0, 1500) as usize;
        record[from..from + count].to_vec()
    };
    let (horizontal, up) = (part(), part());
    let motion = |a: Vec<f64>| GroundMotion::evenly_spaced(DT_S, a, None).expect("a motion");
    let peak = random.of(&[0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0]) * G;
    let horizontal = motion(horizontal).scaled_to_peak(peak).expect("a motion");
    if random.chance(0.75) {
        return horizontal;
    }
    // Near a fault the vertical one may lift what stands on the ground.
    let part = random.of(&[0.4, 0.67, 0.67, 1.0, 2.0]);
    if random.chance(0.05) {
        // Its file is empty.
        let flat = motion(vec![0.0; count]);
        return horizontal.with_vertical(&flat, 1.0).expect("a motion").0;
    }
    let up = motion(up).scaled_to_peak(part * peak).expect("a motion");
    horizontal.with_vertical(&up, 1.0).expect("a motion").0
}
