//! (a) the chord and (e) extremes.

use super::random::Random;
use super::systems::streams;
use crate::linear::polynomial::{
    DEGREE, Polynomial, ZERO, curvature_bound, first_root, largest, value,
};

fn polynomial(random: &mut Random) -> Polynomial {
    let mut size = 1.0;
    let mut c = ZERO;
    for c in &mut c[..=DEGREE] {
        // As a Taylor series of rate times length about 1 would have them.
        size *= random.between(0.2, 0.9);
        *c = size * random.between(-1.0, 1.0);
    }
    c
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
        let mut parabola = ZERO;
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
        let mut c = ZERO;
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
        let root = first_root(&c, 1.0).expect("a dip below zero");
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
        let found = largest(&c, 1.0, f64::NEG_INFINITY);
        let between = 0.125 * curvature_bound(&c) / f64::from(POINTS * POINTS);
        assert!(seen - 1e-15 <= found && found <= seen + between, "{found} where {seen} was seen");
        assert_eq!(largest(&c, 1.0, found + 1e-3), found + 1e-3);
    }
}
