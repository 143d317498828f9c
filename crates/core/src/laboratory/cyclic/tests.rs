use core::f64::consts::TAU;

use super::*;
use crate::numerics::random::Random;

/// A cyclic test: an actuator of finite stiffness drags the block against friction, spring and
/// damper, without inertia. It sticks while the force of the actuator is below static friction.
pub struct SyntheticTest {
    pub times_s: Vec<f64>,
    pub displacement_m: Vec<f64>,
    pub force_n: Vec<f64>,
}

pub const STATIC_N: [f64; 2] = [205.0, 195.0];
pub const KINETIC_N: [f64; 2] = [186.0, 174.0];
pub const SPRING: f64 = 4000.0;
pub const DAMPER: f64 = 30.0;

pub fn made(frequency_hz: f64, cycles: f64, noise: [f64; 2], seed: u64) -> SyntheticTest {
    made_by(frequency_hz, cycles, noise, seed, false)
}

/// Friction of a block that does not care which way it slides.
const EVEN_N: [f64; 2] = [200.0, 180.0];

/// The same, or with a machine so steady that samples fall on the same part of every cycle, and friction
/// alike both ways: then both share one error, the worst case for their mean.
fn made_by(
    frequency_hz: f64,
    cycles: f64,
    noise: [f64; 2],
    seed: u64,
    locked: bool,
) -> SyntheticTest {
    let (amplitude_m, actuator) = (0.02, 2e5);
    let mut random = Random::new(seed);
    let free = if locked { 0.0 } else { 0.01 * random.uniform() };
    let dt_s = 0.0005 / frequency_hz * (1.0 + free);
    let n = (cycles / frequency_hz / dt_s) as usize;
    const FINE: usize = 12;
    let [static_n, kinetic_n] =
        if locked { EVEN_N.map(|force_n| [force_n; 2]) } else { [STATIC_N, KINETIC_N] };
    // No machine keeps its frequency so well that every breakaway falls on the same part of a step.
    let wander = TAU * random.uniform();
    let late = if locked { random.uniform() } else { 0.0 };
    let (mut x, mut sliding) = (0.0_f64, false);
    let mut out = SyntheticTest { times_s: vec![], displacement_m: vec![], force_n: vec![] };
    for i in 0..n * FINE {
        let t = i as f64 * dt_s / FINE as f64;
        let turns = TAU * frequency_hz * (t + late * dt_s);
        let wanders = if locked { 0.0 } else { 0.03 * libm::sin(0.3819 * turns + wander) };
        let target = amplitude_m * libm::sin(turns + wanders);
        let h = dt_s / FINE as f64;
        let force = actuator * (target - x);
        let demand = force - SPRING * x;
        let side = usize::from(demand < 0.0);
        if !sliding && demand.abs() > static_n[side] {
            sliding = true;
        }
        if sliding {
            // Without inertia: a(target − x) = f sgn + K x + C v, over an implicit step.
            let next = |f: f64| {
                (x + h / DAMPER * (actuator * target - f))
                    / (1.0 + h / DAMPER * (actuator + SPRING))
            };
            let moved = next(if demand > 0.0 { kinetic_n[0] } else { -kinetic_n[1] });
            if (moved - x) * demand > 0.0 { x = moved } else { sliding = false }
        }
        if i % FINE == 0 {
            out.times_s.push(t);
            out.displacement_m.push(x + noise[0] * random.normal());
            out.force_n.push(actuator * (target - x) + noise[1] * random.normal());
        }
    }
    out
}

fn test(made: &SyntheticTest) -> CyclicTest<'_> {
    CyclicTest {
        times_s: &made.times_s,
        displacement_m: &made.displacement_m,
        force_n: &made.force_n,
        slack_m: None,
        spring: true,
        damper: true,
        law: KineticLaw::Coulomb,
        zero_known: true,
    }
}

fn truth(path: &str, normal_n: f64) -> f64 {
    let mean = |f: [f64; 2]| 0.5 * (f[0] + f[1]);
    match path {
        "slider.kinetic_friction" => mean(KINETIC_N) / normal_n,
        "slider.kinetic_friction.positive" => KINETIC_N[0] / normal_n,
        "slider.kinetic_friction.negative" => KINETIC_N[1] / normal_n,
        "slider.static_friction" => mean(STATIC_N) / normal_n,
        "slider.static_friction.positive" => STATIC_N[0] / normal_n,
        "slider.static_friction.negative" => STATIC_N[1] / normal_n,
        "slider.spring" => SPRING,
        "slider.damper" => DAMPER,
        other => panic!("{other}"),
    }
}

#[test]
fn without_noise() {
    let made = made(0.5, 6.4, [0.0; 2], 1);
    let fit = cyclic(&test(&made)).unwrap();
    assert!(fit.cycles.len() >= 5, "{fit:?}");
    let found = estimates(&[&fit], 300.0, Some(1216.0));
    for estimate in &found.estimates {
        let truth = truth(&estimate.path, 1216.0);
        let value = estimate.value().unwrap_or_else(|| panic!("{estimate:?}"));
        // The generator's own step and the slope over a twentieth of a stroke leave this much.
        let slack = if estimate.path.ends_with("damper") { 0.05 } else { 0.006 };
        assert!((value / truth - 1.0).abs() < slack, "{} {value} {truth}", estimate.path);
    }
    assert_eq!(found.per_hz, None);
    assert!((fit.cycles[0].frequency_hz - 0.5).abs() < 0.01);
}

/// How many of some tests have intervals that cover the truth, by parameter.
fn covered(seeds: u64) -> std::collections::BTreeMap<String, u64> {
    let mut covered = std::collections::BTreeMap::new();
    for seed in 0..seeds {
        let made = made(0.5, 9.3, [1e-5, 1.5], seed);
        let fit = cyclic(&test(&made)).unwrap();
        for estimate in estimates(&[&fit], 300.0, Some(1216.0)).estimates {
            let truth = truth(&estimate.path, 1216.0);
            let inside = estimate.interval().is_some_and(|[l, h]| l <= truth && truth <= h);
            *covered.entry(estimate.path).or_insert(0) += u64::from(inside);
        }
    }
    covered
}

#[test]
fn prop_intervals_cover() {
    // At 95 % fewer than 19 of 24 have a chance of 1e-3.
    for (path, count) in covered(24) {
        assert!(count >= 19, "{path}: {count} of 24");
    }
}

#[test]
#[ignore = "200 tests: cargo xtask coverage"]
fn coverage_cyclic() {
    let counts = covered(200);
    let counts: Vec<(&str, u64)> = counts.iter().map(|(path, n)| (path.as_str(), *n)).collect();
    let refused = (0..200).filter(|seed| silent_is_refused(*seed)).count() as u64;
    crate::laboratory::hold_to_coverage(&counts, refused);
}

/// Counts of intervals that cover the truth, and of tests whose drift was seen, over tests with a force
/// cell that is off by 25 N and drifts by 6 N.
fn covered_under_drift(seeds: u64) -> (std::collections::BTreeMap<String, u64>, u64) {
    let (mut covered, mut seen) = (std::collections::BTreeMap::new(), 0);
    for seed in 0..seeds {
        let mut made = made(0.5, 9.3, [1e-5, 1.5], seed);
        let last_s = made.times_s[made.times_s.len() - 1];
        for (force_n, t) in made.force_n.iter_mut().zip(&made.times_s) {
            *force_n += 25.0 + 6.0 * t / last_s;
        }
        let fit = cyclic(&CyclicTest { zero_known: false, ..test(&made) }).unwrap();
        let rate = 6.0 / last_s;
        let drift = fit.drift.filter(|drift| (drift.n_per_s / rate - 1.0).abs() < 0.5);
        // What it makes is said of the whole test, not of its middle.
        assert!(
            drift.is_none_or(|drift| (drift.over_test_n - drift.n_per_s * last_s).abs() < 1e-9)
        );
        seen += u64::from(drift.is_some() && !fit.warnings().is_empty());
        for estimate in estimates(&[&fit], 300.0, Some(1216.0)).estimates {
            let truth = truth(&estimate.path, 1216.0);
            let inside = estimate.interval().is_some_and(|[l, h]| l <= truth && truth <= h);
            *covered.entry(estimate.path).or_insert(0) += u64::from(inside);
        }
    }
    (covered, seen)
}

/// The same of the static friction where the samples fall on the same part of every cycle.
fn covered_where_locked(seeds: u64) -> std::collections::BTreeMap<String, u64> {
    let mut covered = std::collections::BTreeMap::new();
    for seed in 0..seeds {
        let made = made_by(0.5, 9.3, [1e-6, 0.1], seed, true);
        let fit = cyclic(&test(&made)).unwrap();
        assert!(fit.runs[0].shared[0] > 0.9);
        for estimate in estimates(&[&fit], 300.0, Some(1216.0)).estimates {
            if !estimate.path.contains("static") {
                continue;
            }
            let truth = EVEN_N[0] / 1216.0;
            let inside = estimate.interval().is_some_and(|[l, h]| l <= truth && truth <= h);
            *covered.entry(estimate.path).or_insert(0) += u64::from(inside);
        }
    }
    covered
}

#[test]
fn prop_a_drifting_force_cell_is_seen_and_intervals_cover() {
    let (counts, seen) = covered_under_drift(24);
    assert_eq!(seen, 24);
    assert!(counts.values().all(|count| *count >= 19), "{counts:?}");
    // A cell that holds its zero does not drift.
    let still = (0..24).filter(|seed| {
        let made = made(0.5, 9.3, [1e-5, 1.5], *seed);
        cyclic(&test(&made)).unwrap().drift.is_some()
    });
    assert_eq!(still.count(), 0);
}

/// Friction that scatters from cycle to cycle has a slope too: with four cycles, which leave two degrees of
/// freedom, four standard errors were passed by 6 % of sound tests.
#[test]
fn prop_a_sound_test_seldom_drifts_however_few_its_cycles() {
    let few = made(0.5, 5.3, [1e-5, 1.5], 1);
    let fit = cyclic(&test(&few)).unwrap();
    assert_eq!((fit.cycles.len(), fit.drift), (4, None));
    let ten = cyclic(&test(&made(0.5, 11.3, [1e-5, 1.5], 1))).unwrap().cycles;
    assert_eq!(ten.len(), 10);
    let mut random = Random::new(1);
    for count in 4..=10 {
        let mut cycles = ten[..count].to_vec();
        let alarms = (0..2000).filter(|_| {
            for cycle in &mut cycles {
                cycle.kinetic_n = KINETIC_N.map(|f| f * (1.0 + 0.02 * random.normal()));
            }
            drift(&cycles, 20.0).is_some()
        });
        // 20 of 2000 at 1 %; more than 34 have a chance of 1e-3.
        let alarms = alarms.count();
        assert!(alarms <= 34, "{alarms} of 2000 with {count} cycles");
    }
    // A cell that drifts by 6 N within four cycles is seen.
    let mut drifting = few;
    let last_s = drifting.times_s[drifting.times_s.len() - 1];
    for (force_n, t) in drifting.force_n.iter_mut().zip(&drifting.times_s) {
        *force_n += 6.0 * t / last_s;
    }
    let rate = cyclic(&test(&drifting)).unwrap().drift.unwrap().n_per_s;
    assert!((rate * last_s / 6.0 - 1.0).abs() < 0.2, "{rate}");
}

#[test]
fn prop_intervals_of_a_locked_test_cover() {
    for (path, count) in covered_where_locked(24) {
        assert!(count >= 19, "{path}: {count} of 24");
    }
}

#[test]
#[ignore = "200 tests: cargo xtask coverage"]
fn coverage_cyclic_drift() {
    let (counts, seen) = covered_under_drift(200);
    let counts: Vec<(&str, u64)> = counts.iter().map(|(path, n)| (path.as_str(), *n)).collect();
    crate::laboratory::hold_to_coverage(&counts, seen);
}

#[test]
#[ignore = "200 tests: cargo xtask coverage"]
fn coverage_cyclic_locked() {
    let counts = covered_where_locked(200);
    let counts: Vec<(&str, u64)> = counts.iter().map(|(path, n)| (path.as_str(), *n)).collect();
    crate::laboratory::hold_to_coverage(&counts, 200);
}

/// Without the zeros of the sensors an offset would be friction that differs by direction.
#[test]
fn friction_by_direction_needs_the_zero() {
    let mut made = made(0.5, 9.3, [1e-5, 1.5], 1);
    let of = |made: &SyntheticTest, zero_known: bool| {
        let fit = cyclic(&CyclicTest { zero_known, ..test(made) }).unwrap();
        estimates(&[&fit], 300.0, None).estimates
    };
    let known = of(&made, true);
    assert!((known[1].value().unwrap() - KINETIC_N[0]).abs() < 2.0);
    made.force_n.iter_mut().for_each(|force_n| *force_n += 40.0);
    let off = of(&made, false);
    let [a, b] = [known[0].value().unwrap(), off[0].value().unwrap()];
    assert!((a - b).abs() < 1e-9, "{a} {b}");
    let paths: Vec<&str> = off.iter().map(|estimate| estimate.path.as_str()).collect();
    let force = |what: &str| format!("slider.{what}_friction_force");
    let expected = [&force("kinetic"), &force("static"), "slider.spring", "slider.damper"];
    assert_eq!(paths, expected);
    let fit = cyclic(&CyclicTest { zero_known: false, ..test(&made) }).unwrap();
    assert_eq!(zero_not_stated(&[&fit]).unwrap().kind, NoticeKind::ZeroNotStated);
    // A drift is told from neither.
    let last_s = made.times_s[made.times_s.len() - 1];
    made.force_n.iter_mut().zip(&made.times_s).for_each(|(f, t)| *f += 8.0 * t / last_s);
    for i in [1, 2, 4, 5] {
        let drifting = of(&made, true);
        assert!(drifting[i].why().unwrap().contains("drifts"), "{:?}", drifting[i]);
    }
}

/// Whether a block that is stuck, and a spring without friction, are refused.
fn silent_is_refused(seed: u64) -> bool {
    let mut random = Random::new(seed);
    // Stuck: the force swings, the block does not move.
    let times_s: Vec<f64> = (0..2000).map(|i| 0.01 * f64::from(i)).collect();
    let force_n: Vec<f64> =
        times_s.iter().map(|t| 100.0 * libm::sin(3.0 * t) + random.normal()).collect();
    let displacement_m: Vec<f64> = times_s.iter().map(|_| 1e-5 * random.normal()).collect();
    let stuck =
        SyntheticTest { times_s: times_s.clone(), displacement_m, force_n: force_n.clone() };
    let stuck = matches!(cyclic(&test(&stuck)), Err(CyclicError::NoSliding { .. }));
    // A spring alone: the loop has no width.
    let displacement_m =
        times_s.iter().map(|t| 0.025 * libm::sin(3.0 * t) + 1e-5 * random.normal()).collect();
    let spring = SyntheticTest { times_s, displacement_m, force_n };
    let fit = cyclic(&test(&spring)).unwrap();
    let found = estimates(&[&fit], 100.0, None).estimates;
    let stiff = found[6].value().unwrap();
    stuck && found[..6].iter().all(|e| e.why().is_some()) && (stiff / 4000.0 - 1.0).abs() < 0.01
}

#[test]
fn what_cannot_be_told_is_refused() {
    for seed in 0..24 {
        assert!(silent_is_refused(seed), "{seed}");
    }
    let short = made(0.5, 2.5, [0.0; 2], 1);
    assert!(matches!(cyclic(&test(&short)), Err(CyclicError::TooFewCycles { .. })));
}

/// Sampled so coarsely that the force rises by as much a step as it falls at breakaway.
#[test]
fn a_breakaway_between_coarse_samples_is_refused() {
    let mut coarse = made(0.5, 6.4, [0.0, 0.5], 1);
    for list in [&mut coarse.times_s, &mut coarse.displacement_m, &mut coarse.force_n] {
        *list = list.iter().copied().step_by(6).collect();
    }
    let fit = cyclic(&test(&coarse)).unwrap();
    let found = estimates(&[&fit], 300.0, Some(1216.0)).estimates;
    assert!((found[0].value().unwrap() / (180.0 / 1216.0) - 1.0).abs() < 0.01);
    assert!(found[3].why().unwrap().contains("breakaway"), "{:?}", found[3]);
}

#[test]
fn frequency_dependence_over_several_tests() {
    let slow = made(0.2, 6.4, [1e-5, 0.5], 1);
    let fast = made(1.0, 6.4, [1e-5, 0.5], 2);
    let fits = [cyclic(&test(&slow)).unwrap(), cyclic(&test(&fast)).unwrap()];
    let found = estimates(&[&fits[0], &fits[1]], 300.0, None).per_hz.unwrap();
    let [low, high] = found.interval().unwrap();
    // Nothing in the made tests depends on frequency: 1 N/Hz is half a percent.
    assert!(low > -2.0 && high < 2.0, "{low} {high}");
}

/// A test drawn at random: samples of 100 to 2000 Hz, a rig from soft to stiff, static friction 2 to 40 % above the
/// kinetic one, counts of a card.
struct Drawn {
    sampled_hz: f64,
    static_n: f64,
    kinetic_n: f64,
    rig_n_per_m: f64,
    noise_n: f64,
    count_n: f64,
}

impl Drawn {
    fn of(seed: u64) -> Self {
        let mut random = Random::new(seed ^ 0x5eed);
        let mut between = |low: f64, high: f64| low * libm::pow(high / low, random.uniform());
        let kinetic_n = 180.0;
        Self {
            sampled_hz: between(100.0, 2000.0),
            static_n: kinetic_n * (1.0 + between(0.02, 0.4)),
            kinetic_n,
            rig_n_per_m: between(2e4, 2e6),
            noise_n: between(0.2, 2.0),
            count_n: between(0.05, 0.5),
        }
    }

    /// The test, the block without inertia dragged by the rig, with steps far below those of the samples.
    fn made(&self, seed: u64) -> SyntheticTest {
        let (amplitude_m, frequency_hz) = (0.02, 0.5);
        let mut random = Random::new(seed);
        let dt_s = 1.0 / self.sampled_hz;
        let n = (9.3 / frequency_hz / dt_s) as usize;
        let fine = (1000.0 * dt_s / 0.02).ceil().max(12.0) as usize;
        let wander = TAU * random.uniform();
        let (mut x, mut sliding) = (0.0_f64, false);
        let mut out = SyntheticTest { times_s: vec![], displacement_m: vec![], force_n: vec![] };
        for i in 0..n * fine {
            let t = i as f64 * dt_s / fine as f64;
            let turns = TAU * frequency_hz * t;
            let target = amplitude_m * libm::sin(turns + 0.03 * libm::sin(0.3819 * turns + wander));
            let h = dt_s / fine as f64;
            let demand = self.rig_n_per_m * (target - x) - SPRING * x;
            sliding |= demand.abs() > self.static_n;
            if sliding {
                let f = self.kinetic_n.copysign(demand);
                let moved = (x + h / DAMPER * (self.rig_n_per_m * target - f))
                    / (1.0 + h / DAMPER * (self.rig_n_per_m + SPRING));
                if (moved - x) * demand > 0.0 { x = moved } else { sliding = false }
            }
            if i % fine == 0 {
                let force_n = self.rig_n_per_m * (target - x) + self.noise_n * random.normal();
                out.times_s.push(t);
                out.displacement_m.push(x + 1e-5 * random.normal());
                out.force_n.push(self.count_n * (force_n / self.count_n).round());
            }
        }
        out
    }
}

/// How many of some drawn tests have intervals that cover the truth, or say that the parameter is not determined.
fn held_by_drawn(seeds: u64) -> std::collections::BTreeMap<String, u64> {
    let mut held = std::collections::BTreeMap::new();
    for seed in 0..seeds {
        let drawn = Drawn::of(seed);
        let made = drawn.made(seed);
        let fit = cyclic(&test(&made)).unwrap();
        for estimate in estimates(&[&fit], 300.0, None).estimates {
            let truth = match estimate.path.as_str() {
                path if path.contains("kinetic") => drawn.kinetic_n,
                path if path.contains("static") => drawn.static_n,
                "slider.spring" => SPRING,
                _ => DAMPER,
            };
            let covers = |[low, high]: [f64; 2]| low <= truth && truth <= high;
            let holds = estimate.interval().is_none_or(covers);
            *held.entry(estimate.path).or_insert(0) += u64::from(holds);
        }
    }
    held
}

/// With samples far apart, a stiff rig, or a drop that is hardly there, static friction came out a tenth off or more;
/// behind a soft rig kinetic friction was low and the damper three times too large.
#[test]
fn prop_intervals_hold_however_a_test_is_sampled() {
    // At 95 % fewer than 25 of 32 have a chance of 1e-4.
    let held = held_by_drawn(32);
    assert!(held.values().all(|count| *count >= 26), "{held:?}");
}

#[test]
#[ignore = "200 tests: cargo xtask coverage"]
fn coverage_cyclic_drawn() {
    let held = held_by_drawn(200);
    assert!(held.values().all(|count| *count >= 181), "{held:?}");
}
