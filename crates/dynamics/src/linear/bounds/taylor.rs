//! (f) truncation and (g) the rates.

use super::systems::{
    Rates, State, System, assert_near, bend, coefficient, derivative, norm, rate, series, state,
    streams, system,
};
use crate::linear::polynomial::{DEGREE, value};
use crate::linear::{IntervalTables, MAX_RATE_STEP, StoreyDamping, orders};
use crate::numerics::InstructionSet;
use crate::numerics::instructions::vectorize;

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
fn rates_are_reached() {
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
    let stretched = State(vec![0.01, 0.0, 0.0, 0.0]);
    let found = norm(&block, &derivative(&block, true, &stretched));
    assert_near(found, block.slip_rate_rad_per_s * norm(&block, &stretched), 1e-15, "block");
    assert_near(
        block.slip_rate_rad_per_s,
        (143e3_f64 / 124.0).sqrt(),
        1e-15,
        "block on its spring",
    );
}

/// 1.4^21 / 21!.
fn first_term_left_out() -> f64 {
    (1..=DEGREE + 1).map(|k| MAX_RATE_STEP / k as f64).product()
}

/// (f) Fewer orders, where the rate is low, leave out no more than 0.8^17 / 17!.
#[test]
fn prop_fewer_orders_leave_out_no_more() {
    for i in 1..=1400 {
        let rate_step = 0.001 * f64::from(i);
        let kept = orders(rate_step);
        let next: f64 = (1..=kept + 1).map(|k| rate_step / k as f64).product();
        assert!(kept.is_multiple_of(4) && next < 6.4e-17, "{kept} orders leave out {next:e}");
    }
    assert_eq!([0.05, 0.8, 1.4].map(orders), [12, 16, 20]);
}

/// (f) A part of an interval by the map to the nearest sixteenth and a short series is what the whole
/// series says, and so is the polynomial of one number.
#[test]
fn prop_parts_of_an_interval_agree_with_the_whole_series() {
    for (mut random, damped) in streams() {
        let made = system(&mut random, damped);
        let system = &made.system;
        for slip in [false, true] {
            let length_s = MAX_RATE_STEP / rate(system, slip).max(1.0);
            let mut x = state(&mut random, &made, slip);
            let load = Rates::random(&mut random).load(0.0, length_s);
            let whole = series(system, slip, &x, &load, length_s);
            let components = x.0.len();
            let draw = |_| random.between(-1.0, 1.0);
            let mut row: Vec<f64> = (0..components).map(draw).collect();
            row.resize(components.next_multiple_of(4), 0.0);
            if !slip {
                row[0] = 0.0;
            }
            let start = [&x.0[..], &[0.0; 4][..row.len() - components]].concat();
            let mut out = row.clone();
            let mut scratch = crate::linear::ModalSeries::new(system, DEGREE);
            let (of_a, of_force) = (random.unit(), if slip { random.unit() } else { 0.0 });
            let of_row = whole.row(&row[..components]);
            for _ in 0..10 {
                let part = random.unit();
                let (mut number, mut size) = (0.0, 0.0);
                vectorize!(InstructionSet::best(), simd => {
                    let of = (row.as_slice(), of_a, of_force);
                    let solution = IntervalTables::new(simd, system, slip, (length_s, DEGREE), of);
                    let from = (start.as_slice(), &load);
                    let c = solution.number(simd, system, from, &mut scratch);
                    solution.state_at(simd, system, from, part, &mut scratch, &mut out);
                    size += c.iter().map(|c| c.abs()).sum::<f64>();
                    number += value(&c, part);
                });
                let direct = of_a * (load.acceleration + part * load.acceleration_change)
                    + of_force * (load.force + part * load.force_change);
                let expected = value(&of_row, part) + direct;
                size += of_row.iter().map(|c| c.abs()).sum::<f64>();
                assert!((number - expected).abs() <= 1e-14 * size, "{number:e}, {expected:e}");
                whole.state_at(part, &mut x);
                let (found, of) = (State(out[..components].to_vec()), norm(system, &x));
                let largest = of.max(norm(system, &State(start[..components].to_vec())));
                let error = State(found.0.iter().zip(&x.0).map(|(a, b)| a - b).collect());
                assert!(norm(system, &error) <= 1e-14 * largest, "{:e}", norm(system, &error));
                assert!((found.s() - x.s()).abs() <= 1e-14 * (1.0 + x.s().abs()));
            }
        }
    }
}

/// (f) The first term that a series leaves out, which doubles cannot show in a sum: from the last
/// one kept, by the equations. Under loads it is measured by `ẍ`.
#[test]
fn prop_truncation_is_below_rounding() {
    let bound = first_term_left_out();
    assert!(bound < 2.3e-17);
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
            let next =
                norm(system, &derivative(system, slip, &last)) * length_s / (DEGREE + 1) as f64;
            let scale = bend(system, slip, &x, &rates, 0.0) / (rate * rate);
            assert!(next <= bound * scale * (1.0 + 1e-9), "{next:e} of {:e}", bound * scale);
        }
    }
}

/// (f) One storey without damping leaves out just that much.
#[test]
fn truncation_is_reached() {
    let system = System::new(325.0, 0.0, 0.0, &[201.0], &[36_700.0], StoreyDamping::Ratio(0.0));
    let length_s = MAX_RATE_STEP / system.stick_rate_rad_per_s;
    let x = State(vec![0.0, 0.0, 0.3, -2.0]);
    let run = series(&system, false, &x, &Rates::NONE.load(0.0, length_s), length_s);
    let last = coefficient(&run, DEGREE);
    let next = norm(&system, &derivative(&system, false, &last)) * length_s / (DEGREE + 1) as f64;
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
