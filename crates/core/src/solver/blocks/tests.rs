//! The bounds of the book's chapter "Proofs", (h) to (j): that they hold, and that they are near.

use super::lanes::{BLOCK, Four};
use super::plant::Plant;
use super::tables::{Phase, Tables};
use crate::linear::polynomial::value;
use crate::linear::{Load, Series, State, StoreyDamping, System};
use crate::solver::extremes::Extremes;

type One = System<[f64; 1]>;

/// Uniform in [−1, 1).
struct Random(u64);

impl Random {
    fn signed(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

fn system(random: &mut Random) -> (One, f64) {
    let mut positive = |least: f64, most: f64| least + (most - least) * random.signed().abs();
    let (block, mass) = (positive(50.0, 400.0), positive(20.0, 400.0));
    let rate = positive(4.0, 30.0);
    let spring = if positive(0.0, 1.0) > 0.5 { block * positive(1.0, 100.0) } else { 0.0 };
    let damper = if positive(0.0, 1.0) > 0.7 { block * positive(0.1, 3.0) } else { 0.0 };
    let ratio = StoreyDamping::Ratio(positive(0.0, 0.1));
    let system = One::new(block, spring, damper, &[mass], &[mass * rate * rate], ratio);
    let dt_s = positive(0.02, 0.29) / system.slip_rate_rad_per_s;
    (system, dt_s)
}

fn tables(system: &One, dt_s: f64) -> std::sync::Arc<Tables> {
    Tables::new(system, &Extremes::untold(system), dt_s).expect("tables")
}

fn gates(phase: &Phase, x: [f64; 4], input: f64) -> [f64; 4] {
    let g = &phase.gates;
    core::array::from_fn(|j| {
        let sum: f64 = (0..4).map(|i| g.columns[i].0[j] * x[i]).sum();
        sum + g.of_input.0[j] * input
    })
}

fn slack(phase: &Phase, [norm, size, rate, force]: [f64; 4]) -> [f64; 4] {
    let b = &phase.gates.bend;
    let of = |c: &Four, j: usize| c.0[j];
    core::array::from_fn(|j| {
        (of(&b.of_norm, j) * norm + of(&b.of_acceleration, j) * size)
            + (of(&b.of_rate, j) * rate + of(&b.of_force, j) * force.abs())
    })
}

/// Over a block of sliding the gates stay within their slack of the chord between its ends, and in
/// stick over a sample; kinks of the acceleration at every sample.
#[test]
fn prop_gates_stay_within_reach_of_their_chords() {
    let mut nearest = 0.0_f64;
    for seed in 0..400 {
        let mut random = Random(seed);
        let (system, dt_s) = system(&mut random);
        let tables = tables(&system, dt_s);
        for slip in [false, true] {
            let phase = if slip { &tables.slip } else { &tables.stick };
            let mut x: [f64; 4] = core::array::from_fn(|_| random.signed());
            // Now and then no more than the load, which then does all of the bending.
            let small = if seed % 3 == 0 { 0.0 } else { 1.0 };
            x = x.map(|x| small * x);
            if !slip {
                x[1] = 0.0;
            }
            let a: [f64; BLOCK + 1] = core::array::from_fn(|_| 10.0 * random.signed());
            let force = if slip { system.block_mass_kg * random.signed() } else { 0.0 };
            let size = a.iter().fold(0.0_f64, |m, a| m.max(a.abs()));
            let rate = a.windows(2).fold(0.0_f64, |m, a| m.max((a[1] - a[0]).abs())) / dt_s;
            let plant = &tables.plant;
            let norm = if slip { plant.norm(&x) } else { plant.norm_of_structure(&x) };
            let samples = if slip { BLOCK } else { 1 };
            let slack = slack(phase, [norm, size, rate, force]);
            let mut state = State::<[f64; 1]>(x);
            let mut series = Series::zeros(1);
            let input = |a: f64| if slip { force } else { a };
            let mut values = vec![gates(phase, x, input(a[0]))];
            for k in 0..samples {
                let load = Load {
                    acceleration: a[k],
                    acceleration_change: a[k + 1] - a[k],
                    friction: force,
                    friction_change: 0.0,
                };
                if slip {
                    series.slip(&system, &state, &load, dt_s);
                } else {
                    series.stick(&system, &state, &load, dt_s);
                }
                for part in 1..=10 {
                    let t = f64::from(part) / 10.0;
                    let at = [
                        value(&series.s, t),
                        value(&series.w, t),
                        value(&core::array::from_fn(|k| series.eta[k][0]), t),
                        value(&core::array::from_fn(|k| series.eta_dot[k][0]), t),
                    ];
                    values.push(gates(phase, at, input(a[k] + (a[k + 1] - a[k]) * t)));
                    if part == 10 {
                        state.0 = at;
                    }
                }
            }
            let last = values.len() - 1;
            for j in 0..4 {
                let size = values.iter().fold(0.0_f64, |m, v| m.max(v[j].abs()));
                for (i, v) in values.iter().enumerate() {
                    let part = i as f64 / last as f64;
                    let chord = values[0][j] + (values[last][j] - values[0][j]) * part;
                    let departs = (v[j] - chord).abs();
                    assert!(
                        departs <= slack[j] + 1e-13 * size,
                        "seed {seed}, slip {slip}, gate {j}: {departs:e} of {:e}",
                        slack[j]
                    );
                    if slack[j] > 1e-9 * size {
                        nearest = nearest.max(departs / slack[j]);
                    }
                }
            }
        }
    }
    // Somewhere the bound is used up to a good part, or it would bound something else.
    assert!(nearest > 0.6, "at most {nearest} of the bound was used");
}

/// (h) The energy norm grows by at most √M_tot |a| + |T|/√M1 a second, and from rest by just that.
#[test]
fn exact_growth_of_the_norm_is_reached_from_rest() {
    let mut random = Random(7);
    for _ in 0..50 {
        let (system, _) = system(&mut random);
        let plant: Plant = tables(&system, 1e-3 / system.slip_rate_rad_per_s).plant;
        let t = 1e-7;
        for (a, force) in [(1.0, 0.0), (0.0, 1.0)] {
            let load = Load {
                acceleration: a,
                acceleration_change: 0.0,
                friction: force,
                friction_change: 0.0,
            };
            let mut series = Series::zeros(1);
            series.slip(&system, &State([0.0; 4]), &load, t);
            let mut state = State([0.0; 4]);
            series.state_at(1.0, &mut state);
            let bound = t * (plant.root_mass * a + plant.per_root_block * force);
            let reached = plant.norm(&state.0) / bound;
            assert!((reached - 1.0).abs() < 1e-5, "{reached}");
        }
    }
}

/// The end of a block, of each of its samples and of a stretch of quiet stick are those of one
/// sample after the other.
#[test]
fn exact_formulas_of_many_samples_are_those_of_one_repeated() {
    for seed in 0..50 {
        let mut random = Random(seed);
        let (system, dt_s) = system(&mut random);
        let tables = tables(&system, dt_s);
        for slip in [false, true] {
            let phase = if slip { &tables.slip } else { &tables.stick };
            let x: [f64; 4] =
                core::array::from_fn(|i| if i == 1 && !slip { 0.0 } else { random.signed() });
            let a: Vec<f64> = (0..40).map(|_| random.signed()).collect();
            let force = if slip { system.block_mass_kg * random.signed() } else { 0.0 };
            let one = |x: [f64; 4], a: &[f64]| end(phase, 1, x, a, force);
            let mut y = x;
            for k in 1..=BLOCK {
                y = one(y, &a[k - 1..]);
                let z = end(phase, k, x, &a, force);
                for i in 0..4 {
                    assert!((y[i] - z[i]).abs() < 1e-13, "seed {seed}: {y:?} {z:?}");
                    if i < 3 {
                        let row = &phase.rows[i];
                        let taps: f64 = (0..BLOCK).map(|m| row.tap[m].0[k - 1] * a[m + 1]).sum();
                        let state: f64 = (0..4).map(|j| row.state[j].0[k - 1] * x[j]).sum();
                        let sum =
                            state + taps + row.first.0[k - 1] * a[0] + row.force.0[k - 1] * force;
                        let plant = &tables.plant;
                        let [value, size] = if i == 0 && !slip {
                            let inertia = plant.block_mass_kg * a[k];
                            let shear = plant.participation * plant.restoring(&z);
                            [inertia - shear, inertia.abs() + shear.abs()]
                        } else {
                            [z[i], 1.0]
                        };
                        assert!((sum - value).abs() < 1e-13 * size.max(1.0), "row {i} at {k}");
                    }
                }
            }
            if !slip {
                let mut y = x;
                for k in 0..super::tables::QUIET {
                    y = one(y, &a[k..]);
                }
                let q = &tables.quiet;
                for i in 0..4 {
                    let state: f64 = (0..4).map(|j| q.power[j].0[i] * x[j]).sum();
                    let taps: f64 =
                        (1..=q.tap.len()).map(|m| q.tap[q.tap.len() - m].0[i] * a[m]).sum();
                    assert!((state + taps + q.first.0[i] * a[0] - y[i]).abs() < 1e-13);
                }
            }
        }
    }
}

fn end(phase: &Phase, k: usize, x: [f64; 4], a: &[f64], force: f64) -> [f64; 4] {
    core::array::from_fn(|i| {
        let state: f64 = (0..4).map(|j| phase.power[k][j].0[i] * x[j]).sum();
        let taps: f64 = (1..=k).map(|m| phase.tap[BLOCK + k - m].0[i] * a[m]).sum();
        state + taps + phase.first[k].0[i] * a[0] + phase.force[k].0[i] * force
    })
}
