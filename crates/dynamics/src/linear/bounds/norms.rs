//! (b) the norm of the second derivative, (c) kinks, (d) dual norms, (k) amplitudes of the modes and
//! (l) their chords.

use super::systems::{
    Rates, SYSTEMS, State, System, assert_near, bend, dot, norm, rate, restoring, row, series,
    state, streams, system,
};
use crate::linear::MAX_RATE_STEP;
use crate::linear::polynomial::value;
use crate::numerics::InstructionSet;
use crate::numerics::instructions::vectorize;

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
        let rest = State(vec![0.0; 2 * system.modes() + 2]);
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
        system.dual_norm(true, &row(system, [self.s, self.w], &self.y, &self.e))
    }

    fn of(&self, system: &System, x: &State) -> f64 {
        let elastic = restoring(system, x.eta(), &vec![0.0; x.eta().len()]);
        self.s * x.s() + self.w * x.w() + dot(&self.y, &elastic) + dot(&self.e, x.eta_dot())
    }

    /// The state in which Cauchy and Schwarz hold with equality.
    fn largest(&self, system: &System) -> State {
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
        let n = system.modes();
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
        for i in 0..system.storeys {
            let floor = system.floor(i).to_vec();
            rows.push(Row { s: 0.0, w: 0.0, e: system.drag(&floor), y: floor });
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
fn dual_norms_of_drift_and_displacement_are_reached() {
    for (mut random, damped) in streams() {
        let made = system(&mut random, damped);
        let (k, n) = (&made.stiffnesses_n_per_m, made.masses_kg.len());
        let size = |q: &[f64]| {
            let x = made.system.coordinates(&made.masses_kg, q);
            {
                let mut state = vec![0.0; 2];
                state.extend_from_slice(&x);
                state.resize(2 + 2 * x.len(), 0.0);
                made.system.energy_norm(&state)
            }
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
        let none = vec![0.0; system.modes()];
        let l = &system.participation;
        let shear = row(system, [0.0; 2], l, &system.drag(l));
        let demand_norm = system.dual_norm(true, &shear);
        let velocity_norm = system.dual_norm(true, &row(system, [0.0, 1.0], &none, &none));
        for slip in [false, true] {
            let length_s = MAX_RATE_STEP / rate(system, slip).max(1.0);
            let (x, rates) = (state(&mut random, &made, slip), Rates::random(&mut random));
            let load = rates.load(0.0, length_s);
            let run = series(system, slip, &x, &load, length_s);
            let mut demand = run.row(&shear).map(|c| -c);
            demand[0] +=
                system.block_mass_kg * load.acceleration + system.stiffness_n_per_m * x.s();
            demand[1] += system.block_mass_kg * load.acceleration_change;
            let (c, dual) = if slip { (run.w(), velocity_norm) } else { (demand, demand_norm) };
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

/// (a) to (d) together over several samples in a row: the sliding velocity has a continuous
/// derivative, so one chord serves them all, with the kinks between them added to the norm of `ẍ`.
#[test]
fn prop_several_samples_stay_within_reach_of_one_chord() {
    const SAMPLES: usize = 4;
    let mut nearest: f64 = 0.0;
    for (mut random, damped) in streams() {
        let made = system(&mut random, damped);
        let system = &made.system;
        let mut x = state(&mut random, &made, true);
        let root_total = (system.block_mass_kg + made.masses_kg.iter().sum::<f64>()).sqrt();
        // Soft enough for the bound to be near: kinks and loads do most of the bending.
        let length_s = 0.1 * MAX_RATE_STEP / rate(system, true).max(1.0);
        let mut rates = Rates::random(&mut random);
        rates.friction[1] = 0.0;
        let mut norm_of_bend = bend(system, true, &x, &rates, 0.0);
        let (mut points, mut last_jerk) = (vec![(0.0, x.w())], rates.acceleration[1]);
        for sample in 0..SAMPLES {
            norm_of_bend += root_total * (rates.acceleration[1] - last_jerk).abs();
            last_jerk = rates.acceleration[1];
            let run = series(system, true, &x, &rates.load(0.0, length_s), length_s);
            for i in 1..=10 {
                let part = f64::from(i) / 10.0;
                points.push((sample as f64 + part, value(&run.w(), part)));
            }
            run.state_at(1.0, &mut x);
            let [a, jerk] = rates.acceleration;
            rates.acceleration = [a + jerk * length_s, 100.0 * random.between(-1.0, 1.0)];
        }
        let whole_s = SAMPLES as f64 * length_s;
        let reach = 0.125 * whole_s * whole_s * norm_of_bend / system.block_mass_kg.sqrt();
        let (from, to) = (points[0].1, points[points.len() - 1].1);
        let size = points.iter().fold(0.0_f64, |size, p| size.max(p.1.abs()));
        for (at, w) in points {
            let departs = (w - (from + (to - from) * at / SAMPLES as f64)).abs();
            assert!(departs <= reach + 4e-15 * size, "{departs:e} of {reach:e}");
            if reach > 1e-9 * size {
                nearest = nearest.max(departs / reach);
            }
        }
    }
    assert!(nearest > 0.5, "at most {nearest} of the bound was used");
}

fn amplitudes(system: &System, x: &State, out: &mut [f64]) {
    vectorize!(InstructionSet::best(), simd => system.amplitudes(simd, &x.0, out));
}

/// (k) In stick the amplitudes grow by what the acceleration adds, bound every row, and bound it no
/// less closely than the energy norm.
#[test]
fn prop_amplitudes_of_modes_bound_every_row() {
    for (mut random, damped) in streams() {
        let made = system(&mut random, damped);
        let system = &made.system;
        let count = system.amplitude_count();
        let of_impulse = system.amplitudes_of_impulse();
        let mut x = state(&mut random, &made, false);
        let mut most = vec![0.0; count];
        amplitudes(system, &x, &mut most);
        let mut c = vec![0.0; x.0.len()];
        c[2..].fill_with(|| random.between(-1.0, 1.0));
        let of_c = system.dual_amplitudes(&c);
        let by_norm = system.dual_norm(false, &c) * norm(system, &x);
        assert!(dot(&of_c, &most[..count]) <= by_norm * (1.0 + 1e-14));
        let rates = Rates::random(&mut random);
        let length_s = MAX_RATE_STEP / rate(system, false).max(1.0);
        for piece in 0..40 {
            let load = rates.load(f64::from(piece) * length_s, length_s);
            let end = load.acceleration + load.acceleration_change;
            let impulse = length_s * load.acceleration.abs().max(end.abs());
            series(system, false, &x, &load, length_s).state_at(1.0, &mut x);
            for (most, of_impulse) in most.iter_mut().zip(&of_impulse) {
                *most += of_impulse * impulse;
            }
            let mut now = vec![0.0; count];
            amplitudes(system, &x, &mut now);
            for (now, most) in now[..count].iter().zip(&most) {
                assert!(*now <= most * (1.0 + 1e-13), "{now:e} above {most:e}");
            }
            let bound = dot(&of_c, &most[..count]);
            let value = dot(&c, &x.0);
            assert!(value.abs() <= bound * (1.0 + 1e-13), "{value:e} above {bound:e}");
        }
    }
}

/// Departures of the modes from chords of several lengths.
fn departures<const N: usize>(
    system: &System,
    x: &State,
    load: [f64; 2],
    kinks_and_impulse: [f64; 2],
    lengths_s: [f64; N],
) -> [Vec<f64>; N] {
    let count = system.padded_modes();
    let mut all = vec![0.0; N * count];
    let reaches = lengths_s.map(|length_s| 0.125 * length_s * length_s);
    vectorize!(InstructionSet::best(), simd => {
        system.departures(simd, &x.0, load, kinks_and_impulse, reaches, &mut all);
    });
    core::array::from_fn(|i| all[i * count..][..system.modes()].to_vec())
}

/// (l) In stick each mode departs from a chord over several samples by its bound at most, and so does
/// every row.
#[test]
fn prop_modes_stay_within_reach_of_their_chords() {
    const SAMPLES: usize = 4;
    let (mut looked_at, mut nearest) = (0, 0.0_f64);
    for (mut random, damped) in streams() {
        let made = system(&mut random, damped);
        let system = &made.system;
        if !system.has_modes(false) {
            continue;
        }
        looked_at += 1;
        let start = state(&mut random, &made, false);
        let mut c = vec![0.0; start.0.len()];
        c[2..].fill_with(|| random.between(-1.0, 1.0));
        let of_c = system.dual_amplitudes(&c);
        // From chords much shorter than a period to some that are longer.
        let length_s = random.logarithmic(0.01, 1.0) * MAX_RATE_STEP / rate(system, false);
        let mut rates = Rates::random(&mut random);
        let first = rates.acceleration;
        let (mut x, mut last_jerk) = (start.clone(), first[1]);
        let (mut kinks, mut largest) = (0.0, first[0].abs());
        let mut points = vec![(0.0, dot(&c, &x.0))];
        for sample in 0..SAMPLES {
            kinks += (rates.acceleration[1] - last_jerk).abs();
            last_jerk = rates.acceleration[1];
            let run = series(system, false, &x, &rates.load(0.0, length_s), length_s);
            for i in 1..=10 {
                let part = f64::from(i) / 10.0;
                points.push((sample as f64 + part, value(&run.row(&c), part)));
            }
            run.state_at(1.0, &mut x);
            let a = rates.acceleration[0] + last_jerk * length_s;
            largest = largest.max(a.abs());
            rates.acceleration = [a, 100.0 * random.between(-1.0, 1.0)];
        }
        let whole_s = SAMPLES as f64 * length_s;
        let loads = [kinks, largest * whole_s];
        let [of_modes] = departures(system, &start, first, loads, [whole_s]);
        let reach = dot(&of_c, &of_modes);
        let (from, to) = (points[0].1, points[points.len() - 1].1);
        let size = points.iter().fold(0.0_f64, |size, p| size.max(p.1.abs()));
        for (at, y) in points {
            let departs = (y - (from + (to - from) * at / SAMPLES as f64)).abs();
            assert!(departs <= reach + 1e-13 * size, "{departs:e} of {reach:e}");
            if reach > 1e-9 * size {
                nearest = nearest.max(departs / reach);
            }
        }
    }
    assert!(looked_at > SYSTEMS / 10, "only {looked_at} systems had modes");
    assert!(nearest > 0.5, "at most {nearest} of the bound was used");
}

/// (l) A mode that swings freely reaches the bound of its acceleration over a short chord, and that of its
/// amplitude over a period.
#[test]
fn departures_of_a_free_mode_are_reached() {
    for (mut random, _) in streams() {
        let made = system(&mut random, false);
        let system = &made.system;
        if !system.has_modes(false) {
            continue;
        }
        for j in 0..system.modes() {
            let omega = system.omega2[j].sqrt();
            let mut x = State(vec![0.0; 2 + 2 * system.modes()]);
            x.0[2 + j] = random.between(0.1, 1.0);
            let amplitude = omega * x.0[2 + j];
            let period_s = 2.0 * core::f64::consts::PI / omega;
            let lengths_s = [1e-3 * period_s, period_s];
            let [short, long] = departures(system, &x, [0.0; 2], [0.0; 2], lengths_s);
            // From one extreme to the next, and about one extreme: A − A cos(ω H/2).
            assert_near(2.0 * amplitude, long[j], 1e-14, "a period");
            let quarter = libm::sin(0.25 * omega * lengths_s[0]);
            assert_near(2.0 * amplitude * quarter * quarter, short[j], 1e-6, "a short chord");
            for (i, departure) in short.iter().chain(&long).enumerate() {
                assert!(i % system.modes() == j || *departure == 0.0);
            }
        }
    }
}
