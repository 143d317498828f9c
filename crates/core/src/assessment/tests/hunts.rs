//! Crossings of curves, and the search for them.

use crate::assessment::ida::{Curve, Hunt, demand_fractiles, level_fractiles};
use crate::study::Demanded;

fn curve(points: &[(f64, f64)]) -> Curve {
    let mut curve = Curve::default();
    for &(level, demand) in points.iter().rev() {
        curve.insert(level, demand);
    }
    curve
}

#[test]
fn first_crossing_between_points() {
    let rising = curve(&[(0.1, 0.0), (0.2, 1.0), (0.4, 3.0)]);
    let found = rising.first_crossing(2.0);
    assert_eq!((found.reached, found.between, found.returns), (true, [0.2, 0.4], None));
    assert!((found.level - 0.3).abs() < 1e-15);
    // Joined to the origin, where nothing moves.
    let found = rising.first_crossing(1e-9);
    assert!(found.level > 0.1 && found.level < 0.100_001);
    let found = curve(&[(0.5, 4.0)]).first_crossing(1.0);
    assert_eq!((found.level, found.between), (0.125, [0.0, 0.5]));
    // Not reached: known from below.
    let found = rising.first_crossing(5.0);
    assert_eq!((found.level, found.reached, found.between), (0.4, false, [0.4, f64::INFINITY]));
    // Reached exactly is reached.
    assert!(rising.first_crossing(3.0).reached);
}

#[test]
fn resurrection_is_told() {
    let back = curve(&[(0.1, 1.0), (0.2, 3.0), (0.3, 1.5), (0.4, 4.0)]);
    let found = back.first_crossing(2.0);
    assert!((found.level - 0.15).abs() < 1e-15);
    assert_eq!(found.returns, Some(0.3));
}

/// A run that used up its travel crosses every limit up to that travel, at its level. What is not known is no point
/// of the curve, and a curve that ends in such runs is known up to them.
#[test]
fn a_travel_used_up_crosses_and_no_answer_does_not() {
    let mut ended = curve(&[(0.1, 1.0), (0.3, 5.0)]);
    ended.insert(0.2, Demanded::AtLeast(3.0));
    for limit in [1.5, 3.0] {
        let found = ended.first_crossing(limit);
        assert_eq!((found.level, found.between, found.reached), (0.2, [0.1, 0.2], true));
    }
    let found = ended.first_crossing(3.5);
    assert_eq!((found.between, found.reached), ([0.1, 0.3], true));
    assert!((found.level - (0.1 + 0.2 * 2.5 / 4.0)).abs() < 1e-15);
    let unknown = curve(&[(0.1, 1.0), (0.2, f64::NAN), (0.3, 5.0)]);
    assert_eq!(unknown.first_crossing(3.0).level, 0.2);
    let ends = curve(&[(0.1, 1.0), (0.2, f64::NAN)]);
    let found = ends.first_crossing(2.0);
    assert_eq!((found.level, found.reached, found.cut_short), (0.1, false, true));
    assert!(!curve(&[(0.1, f64::NAN)]).first_crossing(2.0).is_known());
    // Left out of the fractiles of levels, and of those of demands.
    assert_eq!(level_fractiles(&[ends, ended], 3.0)[1], 0.2);
    let demands = [Demanded::Value(1.0), Demanded::Unknown, Demanded::AtLeast(2.0)];
    assert_eq!(demand_fractiles(&demands)[1], f64::INFINITY);
    assert_eq!(demand_fractiles(&demands[..2])[1], 1.0);
}

#[test]
fn hunt_finds_the_level_to_its_tolerance() {
    for (start, capacity) in [(0.1, 0.737), (0.1, 0.013), (3.0, 0.02), (0.1, 0.1), (0.01, 9.99)] {
        let hunt = Hunt::new(1.0, start, 10.0).unwrap();
        let mut runs = 0;
        let found = hunt.run(|level| {
            runs += 1;
            (level / capacity) * (level / capacity)
        });
        let crossing = found.first_crossing(1.0);
        assert!(crossing.reached, "{start} {capacity}");
        let [low, high] = crossing.between;
        assert!(low < capacity && capacity <= high, "{capacity} in {low} to {high}");
        assert!(high - low <= 0.01 * high && (crossing.level / capacity - 1.0).abs() < 0.01);
        assert!(runs < 150, "{runs} runs");
        assert!(found.levels.windows(2).all(|pair| pair[0] < pair[1]));
    }
}

/// A bump of the demand, a tenth of the crossing that doubling finds, is found by the fill.
#[test]
fn hunt_finds_the_first_of_several_crossings() {
    let demand = |level: f64| {
        let bump = if (0.30..0.34).contains(&level) { 1.5 } else { 0.0 };
        (level / 2.0_f64).max(bump)
    };
    let hunt = Hunt::new(1.0, 0.05, 20.0).unwrap();
    let crossing = hunt.run(demand).first_crossing(1.0);
    assert!((crossing.between[1] / 0.30 - 1.0).abs() < 0.011, "{crossing:?}");
    assert!(crossing.returns.is_some_and(|level| level > 0.33));
}

#[test]
fn hunt_stops_at_the_top() {
    let hunt = Hunt::new(1.0, 0.1, 3.0).unwrap();
    let found = hunt.run(|level| 0.1 * level);
    let crossing = found.first_crossing(1.0);
    assert_eq!((crossing.level, crossing.reached), (3.0, false));
    // Below the limit everywhere, beyond it from a level on: the crossing is where that starts.
    let found = hunt.run(|level| if level > 0.77 { f64::INFINITY } else { 0.0 });
    let crossing = found.first_crossing(1.0);
    assert!(crossing.reached && (crossing.level / 0.77 - 1.0).abs() < 0.01);
    // Without an answer from a level on: known up to there.
    let found = hunt.run(|level| if level > 0.77 { f64::NAN } else { 0.0 });
    let crossing = found.first_crossing(1.0);
    assert!(crossing.cut_short && (0.7..0.77).contains(&crossing.level), "{crossing:?}");
    for (limit, start, top) in
        [(0.0, 0.1, 1.0), (1.0, -0.1, 1.0), (1.0, 2.0, 1.0), (f64::NAN, 0.1, 1.0)]
    {
        assert!(Hunt::new(limit, start, top).is_err());
    }
    // A demand that always reaches ends too.
    let found = hunt.run(|_| 2.0);
    assert!(found.first_crossing(1.0).reached);
}

#[test]
fn fractiles_of_levels_count_what_is_not_reached() {
    let curves: Vec<Curve> =
        [1.0, 2.0, 4.0].map(|slope| curve(&[(0.5, 0.5 * slope), (1.0, slope)])).to_vec();
    let [low, middle, high] = level_fractiles(&curves, 2.0);
    assert!((low - 0.66).abs() < 1e-12, "{low}");
    assert_eq!((middle, high), (1.0, f64::INFINITY));
}
