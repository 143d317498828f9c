//! The bounds that the exact method rests on, proved in the book's chapter "Theory": each holds for
//! random systems, and each has a case that reaches it, so that none is larger than it need be.

// Helpers of tests may panic as tests do.
#![allow(clippy::expect_used)]

#[allow(dead_code)]
#[path = "common/random.rs"]
mod random;

use random::Random;
use slipstick::linear::polynomial::{
    DEGREE, Polynomial, curvature_bound, first_root, largest, value,
};
use slipstick::linear::{Load, MAX_RATE_STEP, Series, State, StoreyDamping};

type System = slipstick::linear::System<Vec<f64>>;

/// Random systems a test looks at.
const SYSTEMS: u64 = 300;

/// A system and what it was made from.
struct Made {
    system: System,
    masses_kg: Vec<f64>,
    stiffnesses_n_per_m: Vec<f64>,
    damped: bool,
}

/// None, one or three storeys; with and without spring, damper, dampers or ratio.
fn system(random: &mut Random, damped: bool) -> Made {
    let n = [0, 1, 3][random.integer(0, 2) as usize];
    let mut list =
        |low, high| -> Vec<f64> { (0..n).map(|_| random.logarithmic(low, high)).collect() };
    let (masses_kg, stiffnesses_n_per_m) = (list(10.0, 1e3), list(1e2, 1e6));
    let dampers = list(1.0, 1e3);
    let block_kg = random.logarithmic(10.0, 1e3);
    let spring = if random.chance(0.7) { random.logarithmic(1e2, 1e6) } else { 0.0 };
    let damper = if damped && random.chance(0.7) { random.logarithmic(1.0, 1e3) } else { 0.0 };
    let damping = match (damped, random.chance(0.5)) {
        (false, _) => StoreyDamping::Ratio(0.0),
        (true, true) => StoreyDamping::Ratio(random.between(0.0, 0.2)),
        (true, false) => StoreyDamping::Dampers(&dampers),
    };
    let system = System::new(block_kg, spring, damper, &masses_kg, &stiffnesses_n_per_m, damping);
    Made { system, masses_kg, stiffnesses_n_per_m, damped }
}

/// Seeds, each with its stream, and whether the system is damped.
fn streams() -> impl Iterator<Item = (Random, bool)> {
    (0..SYSTEMS).map(|seed| (Random::new(seed), seed % 3 != 0))
}

/// Displacements about 10 mm, velocities about 100 mm/s, in the coordinates of the system.
fn state(random: &mut Random, made: &Made, slip: bool) -> State<Vec<f64>> {
    let n = made.masses_kg.len();
    let mut draw = |size: f64| size * random.between(-1.0, 1.0);
    let q: Vec<f64> = (0..n).map(|_| draw(0.01)).collect();
    let v: Vec<f64> = (0..n).map(|_| draw(0.1)).collect();
    let mut x = vec![draw(0.01), if slip { draw(0.1) } else { 0.0 }];
    x.extend(made.system.coordinates(&made.masses_kg, &q));
    x.extend(made.system.coordinates(&made.masses_kg, &v));
    State(x)
}

/// Loads and their rates: acceleration in m/s², friction force in N.
#[derive(Clone, Copy)]
struct Rates {
    acceleration: [f64; 2],
    friction: [f64; 2],
}

impl Rates {
    const NONE: Self = Self { acceleration: [0.0; 2], friction: [0.0; 2] };

    fn random(random: &mut Random) -> Self {
        let mut draw = |size: f64| size * random.between(-1.0, 1.0);
        Self { acceleration: [draw(3.0), draw(100.0)], friction: [draw(100.0), draw(1e3)] }
    }

    fn load(&self, from_s: f64, length_s: f64) -> Load {
        let at = |[value, rate]: [f64; 2]| (value + rate * from_s, rate * length_s);
        let ((acceleration, acceleration_change), (friction, friction_change)) =
            (at(self.acceleration), at(self.friction));
        Load { acceleration, acceleration_change, friction, friction_change }
    }
}

fn series(
    system: &System,
    slip: bool,
    state: &State<Vec<f64>>,
    load: &Load,
    length_s: f64,
) -> Series<Vec<f64>> {
    let mut series = Series::zeros(system.storeys());
    if slip {
        series.slip(system, state, load, length_s);
    } else {
        series.stick(system, state, load, length_s);
    }
    series
}

/// A coefficient of a series as a state.
fn coefficient(series: &Series<Vec<f64>>, k: usize) -> State<Vec<f64>> {
    let mut x = vec![series.s[k], series.w[k]];
    x.extend_from_slice(&series.eta[k]);
    x.extend_from_slice(&series.eta_dot[k]);
    State(x)
}

fn norm(system: &System, x: &State<Vec<f64>>) -> f64 {
    system.energy_norm(x.s(), x.w(), x.eta(), x.eta_dot())
}

/// Norm of `ẍ` in a state under loads.
fn bend(system: &System, slip: bool, state: &State<Vec<f64>>, rates: &Rates, at_s: f64) -> f64 {
    // Over one second the second coefficient is half the second derivative.
    2.0 * norm(system, &coefficient(&series(system, slip, state, &rates.load(at_s, 1.0), 1.0), 2))
}

/// `ẋ` of the unloaded system: the row of equations that the rates bound.
fn derivative(system: &System, slip: bool, x: &State<Vec<f64>>) -> State<Vec<f64>> {
    coefficient(&series(system, slip, x, &Rates::NONE.load(0.0, 1.0), 1.0), 1)
}

fn rate(system: &System, slip: bool) -> f64 {
    if slip { system.slip_rate_rad_per_s } else { system.stick_rate_rad_per_s }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn assert_near(found: f64, expected: f64, tolerance: f64, what: &str) {
    let error = (found - expected).abs() / expected.abs().max(f64::MIN_POSITIVE);
    assert!(error <= tolerance, "{what}: found {found:e}, expected {expected:e}, off by {error:e}");
}

fn polynomial(random: &mut Random) -> Polynomial {
    let mut size = 1.0;
    std::array::from_fn(|_| {
        // As a Taylor series of rate times length about 1 would have them.
        size *= random.between(0.2, 0.9);
        size * random.between(-1.0, 1.0)
    })
}

/// (a) A function departs from its chord by at most D w²/8; a parabola does, at the middle.
#[test]
fn prop_chord_bound_holds_and_a_parabola_reaches_it() {
    for (mut random, _) in streams() {
        let c = polynomial(&mut random);
        let a = random.unit();
        let b = a + (1.0 - a) * random.unit();
        let [ga, gb] = [a, b].map(|x| value(&c, x));
        let bound = 0.125 * curvature_bound(&c) * (b - a) * (b - a);
        for i in 0..=50 {
            let part = f64::from(i) / 50.0;
            let chord = ga + (gb - ga) * part;
            let departs = (value(&c, a + (b - a) * part) - chord).abs();
            assert!(departs <= bound + 1e-15, "{departs:e} from the chord, {bound:e} allowed");
        }
        let mut parabola = [0.0; DEGREE + 1];
        (parabola[0], parabola[1], parabola[2]) = (c[0], c[1], c[2]);
        let [ga, gb] = [a, b].map(|x| value(&parabola, x));
        let departs = (value(&parabola, 0.5 * (a + b)) - 0.5 * (ga + gb)).abs();
        let bound = 0.125 * curvature_bound(&parabola) * (b - a) * (b - a);
        assert!((departs - bound).abs() < 2e-15, "{departs:e} of {bound:e}");
    }
}

/// (a) A dip of 1e-12 below zero anywhere in [0, 1] is found, and before it.
#[test]
fn prop_no_dip_is_missed() {
    for (mut random, _) in streams() {
        // Not negative: a square of a polynomial of degree five times the distance from a point,
        // squared, so that it touches zero there.
        let at = random.between(0.05, 0.95);
        let factor: Vec<f64> = (0..6).map(|_| random.between(-0.5, 0.5)).collect();
        let mut c = [0.0; DEGREE + 1];
        for (i, f) in factor.iter().enumerate() {
            for (j, g) in factor.iter().enumerate() {
                let square = [at * at, -2.0 * at, 1.0];
                for (k, s) in square.iter().enumerate() {
                    c[i + j + k] += f * g * s;
                }
            }
        }
        let depth = 1e-12;
        c[0] -= depth;
        let root = first_root(&c).expect("a dip below zero");
        assert!(root < at + 1e-12, "found at {root}, the dip is before {at}");
        assert!(value(&c, root).abs() < 0.1 * depth, "{:e} at {root}", value(&c, root));
        for i in 0..1000 {
            let x = f64::from(i) / 1000.0 * (root - 1e-9);
            assert!(x < 0.0 || value(&c, x) > -0.1 * depth, "{:e} before it", value(&c, x));
        }
    }
}

/// (e) The largest value is attained, and nothing is above it.
#[test]
fn prop_largest_value_is_the_largest() {
    const POINTS: u32 = 1000;
    for (mut random, _) in streams() {
        let c = polynomial(&mut random);
        let seen = (0..=POINTS)
            .map(|i| value(&c, f64::from(i) / f64::from(POINTS)))
            .fold(f64::NEG_INFINITY, f64::max);
        let found = largest(&c, f64::NEG_INFINITY);
        let between = 0.125 * curvature_bound(&c) / f64::from(POINTS * POINTS);
        assert!(seen - 1e-15 <= found && found <= seen + between, "{found} where {seen} was seen");
        assert_eq!(largest(&c, found + 1e-3), found + 1e-3);
    }
}

/// (b) Under loads that are linear in time the norm of `ẍ` does not grow, and without dampers it
/// stays; past a zero of the sliding velocity too, the friction force going on as it was.
#[test]
fn prop_norm_of_the_second_derivative_does_not_grow() {
    let mut passed_zero = 0;
    for (mut random, damped) in streams() {
        let made = system(&mut random, damped);
        let system = &made.system;
        for slip in [false, true] {
            let rates = Rates::random(&mut random);
            let mut x = state(&mut random, &made, slip);
            let start_w = x.w();
            let first = bend(system, slip, &x, &rates, 0.0);
            let length_s = MAX_RATE_STEP / rate(system, slip).max(1.0);
            let (mut last, mut turned) = (first, false);
            for piece in 0..40 {
                let at_s = f64::from(piece) * length_s;
                let run = series(system, slip, &x, &rates.load(at_s, length_s), length_s);
                run.state_at(1.0, &mut x);
                turned |= x.w() * start_w < 0.0;
                let now = bend(system, slip, &x, &rates, at_s + length_s);
                // The rounding of a state, seen through two derivatives.
                let rate = rate(system, slip);
                let rounding = 1e-13 * (first + rate * rate * norm(system, &x));
                assert!(now <= last + rounding, "grew from {last:e} to {now:e}");
                if !made.damped {
                    assert!((now - first).abs() <= 40.0 * rounding, "{first:e} became {now:e}");
                }
                last = now;
            }
            passed_zero += u32::from(slip && turned);
        }
    }
    assert!(
        passed_zero > SYSTEMS as u32 / 10,
        "the velocity changed sign only {passed_zero} times"
    );
}

/// (c) A kink of the loads adds at most √M_tot |Δȧ| + |ΔṪ|/√M1 to that norm; from rest just that.
#[test]
fn prop_kink_adds_at_most_its_bound_and_from_rest_the_whole() {
    for (mut random, damped) in streams() {
        let made = system(&mut random, damped);
        let system = &made.system;
        let floors_kg: f64 = made.masses_kg.iter().sum();
        let root_total = (system.block_mass_kg + floors_kg).sqrt();
        let of_acceleration = |kink: f64| root_total * kink.abs();
        let of_friction = |kink: f64| kink.abs() / system.block_mass_kg.sqrt();
        let (before, kink) = (Rates::random(&mut random), Rates::random(&mut random));
        let mut after = before;
        after.acceleration[1] += kink.acceleration[1];
        after.friction[1] += kink.friction[1];
        for slip in [false, true] {
            let x = state(&mut random, &made, slip);
            let [from, to] = [before, after].map(|r| bend(system, slip, &x, &r, 0.0));
            let friction = if slip { of_friction(kink.friction[1]) } else { 0.0 };
            let allowed = from + of_acceleration(kink.acceleration[1]) + friction;
            assert!(to <= allowed * (1.0 + 1e-12), "{from:e} to {to:e}, {allowed:e} allowed");
        }
        let rest = State(vec![0.0; 2 * made.masses_kg.len() + 2]);
        let jerk = kink.acceleration[1];
        let only_jerk = Rates { acceleration: [0.0, jerk], ..Rates::NONE };
        let reached = bend(system, true, &rest, &only_jerk, 0.0);
        assert_near(reached, of_acceleration(jerk), 1e-13, "acceleration in slip");
        let reached = bend(system, false, &rest, &only_jerk, 0.0);
        assert!((reached - floors_kg.sqrt() * jerk.abs()).abs() <= 1e-12 * jerk.abs() * root_total);
        let only_force = Rates { friction: [0.0, kink.friction[1]], ..Rates::NONE };
        let reached = bend(system, true, &rest, &only_force, 0.0);
        assert_near(reached, of_friction(kink.friction[1]), 1e-12, "friction");
    }
}

/// A row `s · s + w · ṡ + yᵀ Ω η + e · η̇` of what is linear in the state.
struct Row {
    s: f64,
    w: f64,
    y: Vec<f64>,
    e: Vec<f64>,
}

impl Row {
    fn dual_norm(&self, system: &System) -> f64 {
        system.dual_norm(self.s, self.w, &self.y, &self.e)
    }

    fn of(&self, system: &System, x: &State<Vec<f64>>) -> f64 {
        let elastic = system.restoring(x.eta(), &vec![0.0; x.eta().len()]);
        self.s * x.s() + self.w * x.w() + dot(&self.y, &elastic) + dot(&self.e, x.eta_dot())
    }

    /// The state in which Cauchy and Schwarz hold with equality.
    fn largest(&self, system: &System) -> State<Vec<f64>> {
        let l = &system.participation;
        let s = if self.s == 0.0 { 0.0 } else { self.s / system.stiffness_n_per_m };
        let w = (self.w - dot(&self.e, l)) / system.block_mass_kg;
        let mut x = vec![s, w];
        x.extend_from_slice(&self.y);
        x.extend(self.e.iter().zip(l).map(|(e, l)| e - l * w));
        State(x)
    }
}

/// (d) No state of norm 1 gives more than the dual norm, and one gives just that: of the sliding
/// velocity, the demand, the block's and the floors' accelerations, and any other row.
#[test]
fn prop_dual_norms_hold_and_are_reached() {
    for (mut random, damped) in streams() {
        let made = system(&mut random, damped);
        let system = &made.system;
        let n = made.masses_kg.len();
        let l = system.participation.clone();
        let over_mass =
            |x: &[f64]| -> Vec<f64> { x.iter().map(|x| x / system.block_mass_kg).collect() };
        let (none, drag) = (vec![0.0; n], system.drag(&l));
        let mut rows = vec![
            Row { s: 0.0, w: 1.0, y: none.clone(), e: none.clone() },
            Row { s: 0.0, w: 0.0, y: l.clone(), e: drag.clone() },
            Row {
                s: -system.stiffness_n_per_m / system.block_mass_kg,
                w: -system.damper_n_s_per_m / system.block_mass_kg,
                y: over_mass(&l),
                e: over_mass(&drag),
            },
        ];
        for floor in system.shapes.chunks_exact(n.max(1)) {
            rows.push(Row { s: 0.0, w: 0.0, y: floor.to_vec(), e: system.drag(floor) });
        }
        let mut any = || -> Vec<f64> { (0..n).map(|_| random.between(-1.0, 1.0)).collect() };
        rows.push(Row { s: 0.0, w: 0.5, y: any(), e: any() });
        assert_near(
            rows[0].dual_norm(system),
            1.0 / system.block_mass_kg.sqrt(),
            1e-15,
            "velocity",
        );
        for row in &rows {
            let dual = row.dual_norm(system);
            if dual == 0.0 {
                continue; // no storeys, no base shear
            }
            for _ in 0..20 {
                let x = state(&mut random, &made, true);
                let (found, allowed) = (row.of(system, &x).abs(), dual * norm(system, &x));
                assert!(found <= allowed * (1.0 + 1e-12), "{found:e}, {allowed:e} allowed");
            }
            let best = row.largest(system);
            assert_near(norm(system, &best), dual, 1e-12, "norm of the largest state");
            assert_near(row.of(system, &best), dual * dual, 1e-12, "its value");
        }
    }
}

/// (d) Drift of a storey: 1/√k; displacement of a floor: the root of the flexibility below it.
#[test]
fn exact_dual_norms_of_drift_and_displacement_are_reached() {
    for (mut random, damped) in streams() {
        let made = system(&mut random, damped);
        let (k, n) = (&made.stiffnesses_n_per_m, made.masses_kg.len());
        let size = |q: &[f64]| {
            let x = made.system.coordinates(&made.masses_kg, q);
            made.system.energy_norm(0.0, 0.0, &x, &vec![0.0; n])
        };
        for i in 0..n {
            // One storey drifts by 1 m, and all above it move along.
            let drifting: Vec<f64> = (0..n).map(|j| f64::from(u8::from(j >= i))).collect();
            assert_near(size(&drifting), k[i].sqrt(), 1e-11, "drift");
            // A force of 1 N pushes the floor i.
            let below = |j: usize| k[..=j.min(i)].iter().map(|k| 1.0 / k).sum::<f64>();
            let pushed: Vec<f64> = (0..n).map(below).collect();
            assert_near(size(&pushed), below(i).sqrt(), 1e-11, "displacement");
        }
    }
}

/// (a) to (d) together: over a whole sample the demand and the sliding velocity stay as near to
/// their chords as the short way through the samples takes them to be.
#[test]
fn prop_samples_stay_within_reach_of_their_chords() {
    let mut nearest: f64 = 0.0;
    for (mut random, damped) in streams() {
        let made = system(&mut random, damped);
        let system = &made.system;
        let n = made.masses_kg.len();
        let demand_norm =
            system.dual_norm(0.0, 0.0, &system.participation, &system.drag(&system.participation));
        let velocity_norm = system.dual_norm(0.0, 1.0, &vec![0.0; n], &vec![0.0; n]);
        for slip in [false, true] {
            let length_s = MAX_RATE_STEP / rate(system, slip).max(1.0);
            let (x, rates) = (state(&mut random, &made, slip), Rates::random(&mut random));
            let load = rates.load(0.0, length_s);
            let run = series(system, slip, &x, &load, length_s);
            let demand = run.demand(system, &load);
            let (c, dual) = if slip { (run.w, velocity_norm) } else { (demand, demand_norm) };
            let reach = 0.125 * length_s * length_s * dual * bend(system, slip, &x, &rates, 0.0);
            let size = c.iter().fold(0.0_f64, |size, c| size.max(c.abs()));
            for i in 0..=20 {
                let part = f64::from(i) / 20.0;
                let chord = c[0] + (value(&c, 1.0) - c[0]) * part;
                let departs = (value(&c, part) - chord).abs();
                assert!(departs <= reach + 4e-15 * size, "{departs:e} of {reach:e}");
                if reach > 1e-9 * size {
                    nearest = nearest.max(departs / reach);
                }
            }
        }
    }
    // Somewhere the bound is nearly used up, or it would bound something else.
    assert!(nearest > 0.9, "at most {nearest} of the bound was used");
}

/// (g) `‖A x‖ ≤ rate · ‖x‖` in stick and slip.
#[test]
fn prop_rates_bound_the_system() {
    for (mut random, damped) in streams() {
        let made = system(&mut random, damped);
        let system = &made.system;
        for slip in [false, true] {
            for _ in 0..20 {
                let mut x = state(&mut random, &made, slip);
                if !slip {
                    x.0[0] = 0.0; // the block's spring does not move in stick
                }
                let (rate, size) = (rate(system, slip), norm(system, &x));
                let found = norm(system, &derivative(system, slip, &x));
                assert!(found <= rate * size * (1.0 + 1e-12), "{found:e}, rate {rate:e}");
            }
        }
    }
}

/// (g) One storey without damping, and a rigid block on a spring, turn at just their rate.
#[test]
fn exact_rates_are_reached() {
    let none = StoreyDamping::Ratio(0.0);
    let storey = System::new(325.0, 0.0, 0.0, &[201.0], &[36_700.0], none);
    let stretched = State(vec![0.0, 0.0, 1.0, 0.0]);
    for slip in [false, true] {
        let found = norm(&storey, &derivative(&storey, slip, &stretched));
        assert_near(found, rate(&storey, slip) * norm(&storey, &stretched), 1e-15, "storey");
    }
    let omega = (36_700.0_f64 / 201.0).sqrt();
    assert_near(storey.stick_rate_rad_per_s, omega, 1e-15, "fixed base");
    let free = omega * (1.0_f64 + 201.0 / 325.0).sqrt();
    assert_near(storey.slip_rate_rad_per_s, free, 1e-15, "free in slip");
    let block = System::new(124.0, 143e3, 0.0, &[], &[], none);
    let stretched = State(vec![0.01, 0.0]);
    let found = norm(&block, &derivative(&block, true, &stretched));
    assert_near(found, block.slip_rate_rad_per_s * norm(&block, &stretched), 1e-15, "block");
    assert_near(
        block.slip_rate_rad_per_s,
        (143e3_f64 / 124.0).sqrt(),
        1e-15,
        "block on its spring",
    );
}

/// 0.3^13 / 13!.
fn first_term_left_out() -> f64 {
    (1..=DEGREE + 1).map(|k| MAX_RATE_STEP / k as f64).product()
}

/// (f) The first term that a series leaves out, which doubles cannot show in a sum: from the last
/// one kept, by the equations. Under loads it is measured by `ẍ`.
#[test]
fn prop_truncation_is_below_rounding() {
    let bound = first_term_left_out();
    assert!(bound < 3e-17);
    for (mut random, damped) in streams() {
        let made = system(&mut random, damped);
        let system = &made.system;
        for slip in [false, true] {
            let rate = rate(system, slip);
            if rate == 0.0 {
                continue; // a rigid block without a spring moves by a polynomial of degree 3
            }
            let length_s = MAX_RATE_STEP / rate;
            let (x, rates) = (state(&mut random, &made, slip), Rates::random(&mut random));
            let run = series(system, slip, &x, &rates.load(0.0, length_s), length_s);
            let mut last = coefficient(&run, DEGREE);
            if !slip {
                last.0[0] = 0.0;
            }
            let next = norm(system, &derivative(system, slip, &last)) * length_s / 13.0;
            let scale = bend(system, slip, &x, &rates, 0.0) / (rate * rate);
            assert!(next <= bound * scale * (1.0 + 1e-9), "{next:e} of {:e}", bound * scale);
        }
    }
}

/// (f) One storey without damping leaves out just that much.
#[test]
fn exact_truncation_is_reached() {
    let system = System::new(325.0, 0.0, 0.0, &[201.0], &[36_700.0], StoreyDamping::Ratio(0.0));
    let length_s = MAX_RATE_STEP / system.stick_rate_rad_per_s;
    let x = State(vec![0.0, 0.0, 0.3, -2.0]);
    let run = series(&system, false, &x, &Rates::NONE.load(0.0, length_s), length_s);
    let last = coefficient(&run, DEGREE);
    let next = norm(&system, &derivative(&system, false, &last)) * length_s / 13.0;
    assert_near(next, first_term_left_out() * norm(&system, &x), 1e-13, "term left out");
}

/// (f) One series and two over half the length agree to rounding.
#[test]
fn prop_one_series_and_two_halves_agree() {
    for (mut random, damped) in streams() {
        let made = system(&mut random, damped);
        let system = &made.system;
        for slip in [false, true] {
            let length_s = MAX_RATE_STEP / rate(system, slip).max(1.0);
            let (x, rates) = (state(&mut random, &made, slip), Rates::random(&mut random));
            let (mut whole, mut halves) = (x.clone(), x.clone());
            let run = series(system, slip, &x, &rates.load(0.0, length_s), length_s);
            run.state_at(1.0, &mut whole);
            for half in [0.0, 0.5] {
                let (at_s, half_s) = (half * length_s, 0.5 * length_s);
                let run = series(system, slip, &halves, &rates.load(at_s, half_s), half_s);
                run.state_at(1.0, &mut halves);
            }
            let apart: Vec<f64> = whole.0.iter().zip(&halves.0).map(|(a, b)| a - b).collect();
            let (apart, size) = (norm(system, &State(apart)), norm(system, &whole));
            let start = norm(system, &x);
            // Sums of some ten terms, each rounded.
            assert!(apart <= 4e-15 * size.max(start), "{apart:e} of {size:e}");
        }
    }
}
