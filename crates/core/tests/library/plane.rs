//! Two horizontal directions: what turning, mirroring and exchanging the axes must not change, and how motion
//! along a line agrees with the solver in one direction.

// The numbers of a run are for people who look for them with --nocapture; helpers of tests may panic as
// tests do; a seed from outside to look for more.
#![allow(clippy::disallowed_macros, clippy::disallowed_methods, clippy::expect_used)]

use crate::common::random_in_plane::{Random, Restoring, System, libm_sin};
use slipstick::check::check;
use slipstick::model::{AlongY, Block, InitialState, Model};
use slipstick::motion::GroundMotion;
use slipstick::response::{Demands, EventKind, Response};
use slipstick::slider::{Friction, RateCurve, RateLaw};
use slipstick::solver::{Prepared, PreparedMotion, exact};

/// Every figure of resultants over the peak of its kind.
pub fn differences(a: &Demands, b: &Demands) -> Vec<(&'static str, f64)> {
    let over = |x: f64, y: f64, scale: f64| {
        if x == y { 0.0 } else { (x - y).abs() / scale.abs().max(1e-300) }
    };
    let peak_m = a.peak_sliding_displacement_m;
    let mut all = vec![
        ("peak s", over(peak_m, b.peak_sliding_displacement_m, peak_m)),
        (
            "residual s",
            over(
                a.residual_sliding_displacement_m.abs(),
                b.residual_sliding_displacement_m.abs(),
                peak_m,
            ),
        ),
        ("path", over(a.sliding_path_m, b.sliding_path_m, a.sliding_path_m)),
        ("time", over(a.sliding_time_s, b.sliding_time_s, a.sliding_time_s)),
    ];
    type Named = (&'static str, fn(&Demands) -> f64);
    let relative: [Named; 5] = [
        ("peak w", |d| d.peak_sliding_velocity_m_per_s),
        ("block", |d| d.peak_block_acceleration_m_per_s2),
        ("friction", |d| d.peak_friction_force_n),
        ("slider", |d| d.peak_slider_force_n),
        ("shear", |d| d.peak_base_shear_n),
    ];
    all.extend(relative.map(|(name, of)| (name, over(of(a), of(b), of(a)))));
    for (a, b) in a.storeys.iter().zip(&b.storeys) {
        let [x, y] = [a.peak_displacement_m, b.peak_displacement_m];
        all.push(("q", over(x, y, x)));
        let [x, y] = [a.peak_acceleration_m_per_s2, b.peak_acceleration_m_per_s2];
        all.push(("floor", over(x, y, x)));
        let [x, y] = [a.peak_drift_m, b.peak_drift_m];
        all.push(("drift", over(x, y, x)));
        let [x, y] = [a.peak_drift_velocity_m_per_s, b.peak_drift_velocity_m_per_s];
        all.push(("drift velocity", over(x, y, x)));
    }
    all
}

/// Slips and sticks in their order.
fn kinds(response: &Response) -> Vec<EventKind> {
    let own = response.events.iter().filter(|event| event.kind != EventKind::Reversal);
    own.map(|event| event.kind).collect()
}

/// Whether two responses agree; the worst figure, or what is different.
pub fn agree(a: &Response, b: &Response) -> Result<f64, String> {
    if kinds(a) != kinds(b) {
        return Err(format!("{} and {} events", kinds(a).len(), kinds(b).len()));
    }
    let found = differences(&a.demands, &b.demands);
    let (what, worst) = found.into_iter().fold(("", 0.0), |worst, this| {
        if this.1 > worst.1 || this.1.is_nan() { this } else { worst }
    });
    if worst <= 1e-11 { Ok(worst) } else { Err(format!("{what} {worst:.1e}")) }
}

/// How many systems are tried: `SLIPSTICK_SEEDS=0..10000` takes others.
fn seeds(usual: u64) -> core::ops::Range<u64> {
    let given = std::env::var("SLIPSTICK_SEEDS").unwrap_or_default();
    let parsed = given.split_once("..").and_then(|(a, b)| Some(a.parse().ok()?..b.parse().ok()?));
    parsed.unwrap_or(0..usual)
}

/// Compares each system with what is made of it, for all seeds.
pub fn all_agree(what: &str, equal: bool, of: impl Fn(u64, &System) -> (Response, Response)) {
    let (mut wrong, mut worst, mut count) = (Vec::new(), 0.0_f64, 0);
    for seed in seeds(60) {
        let (a, b) = of(seed, &System::random(seed, equal));
        match agree(&a, &b) {
            Ok(difference) => worst = worst.max(difference),
            Err(difference) => wrong.push(format!("seed {seed}: {difference}")),
        }
        count += 1;
    }
    println!("{what}: {count} systems, worst difference {worst:.1e} of the peak");
    assert!(wrong.is_empty(), "{} of {count}:\n{}", wrong.len(), wrong.join("\n"));
}

pub fn turned(angle: f64) -> impl Fn([f64; 2]) -> [f64; 2] {
    let (sine, cosine) = (libm_sin(angle), libm_sin(angle + core::f64::consts::FRAC_PI_2));
    move |[x, y]| [cosine * x - sine * y, sine * x + cosine * y]
}

#[test]
fn prop_turning_all_vectors_turns_the_response() {
    all_agree("turned", true, |seed, system| {
        let by = turned(0.1 + 0.7 * seed as f64);
        (system.response(), system.changed(by).response())
    });
}

#[test]
fn prop_exchanged_axes_exchange_the_response() {
    all_agree("exchanged", false, |_, system| {
        let mut exchanged = system.changed(|[x, y]| [y, x]);
        exchanged.stiffnesses.reverse();
        exchanged.damping.reverse();
        (system.response(), exchanged.response())
    });
}

#[test]
fn prop_mirrored_axes_mirror_the_response() {
    all_agree("mirrored", false, |seed, system| {
        let signs = [[-1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]][seed as usize % 3];
        (system.response(), system.changed(|[x, y]| [signs[0] * x, signs[1] * y]).response())
    });
}

/// With these samples are uneven: nothing runs ahead over sticks as it does over even ones.
#[test]
fn prop_collinear_samples_change_nothing() {
    all_agree("collinear samples", false, |_, system| {
        (system.response(), system.with_collinear_samples().response())
    });
}

/// Friction does not know the direction: along a line all is as along x, and its figures by axis are parts of it.
#[test]
fn prop_motion_along_a_line_is_motion_in_one_direction() {
    all_agree("along a line", true, |seed, system| {
        let angle = 0.3 + 0.9 * seed as f64;
        let along = system.along_a_line(angle);
        let response = along.response();
        let c = check(&along.model(), &along.motion(), &response);
        assert!(c.holds(), "seed {seed}: {c:?}");
        is_on_a_line(
            seed,
            &response,
            [libm_sin(angle + core::f64::consts::FRAC_PI_2), libm_sin(angle)],
        );
        (system.along_x(), response)
    });
}

/// A record that is both components, turned until one of them is left, leaves rounding of the other.
#[test]
fn prop_rounding_across_a_line_raises_no_alarm() {
    for seed in 0..10 {
        for axis in [0, 1] {
            let line = System::random(seed, true).along_a_line(0.0);
            let mut along = line.changed(|[x, _]| if axis == 0 { [x, 0.0] } else { [0.0, x] });
            let table = along.table[axis].clone();
            let largest = table.iter().fold(0.0_f64, |most, a| most.max(a.abs()));
            for (k, a) in table.iter().enumerate().filter(|(k, a)| k % 3 == 1 && a.abs() < largest)
            {
                along.table[1 - axis][k] = 1e-16 * a;
            }
            let (model, motion) = (along.model(), along.motion());
            let response = exact(&model, &motion).expect("a response");
            let c = check(&model, &motion, &response);
            assert!(c.holds(), "seed {seed} along {axis}: {c:?}");
        }
    }
}

/// What rests is told by the fastest so far: here a slip at 18.5 s passes rest by 1e-15 m/s, and its peak is later.
#[test]
fn a_slip_that_nearly_rests_before_its_peak_raises_no_alarm() {
    let record = include_str!("../../../../examples/records/taft-021.txt");
    let g: Vec<f64> = record.split_whitespace().map(|x| x.parse().expect("a number")).collect();
    let most = g.iter().fold(0.0_f64, |most, a| most.max(a.abs()));
    let x: Vec<f64> = g.iter().map(|a| a * 9.80665 * (1.41125 / most)).collect();
    let cosine = libm_sin(core::f64::consts::PI);
    let turned = |of: &dyn Fn(f64) -> f64| {
        let mut list: Vec<f64> = x.iter().map(|a| of(*a)).collect();
        list.resize(x.len() + 200, 0.0);
        list
    };
    let [x, y] = [turned(&|a| 0.5 * a * cosine - a), turned(&|a| a + 0.5 * a * cosine)];
    let curve =
        RateCurve::Exponential { slow: 0.06606099734, fast: 0.09290273825, rate_s_per_m: 5.0 };
    let law = RateLaw::new(curve, [1.0; 2]).expect("a law");
    let model = Model::builder()
        .block("5.22156 t")
        .friction_by_speed(0.1393534094, law)
        .radius("1.68408 m")
        .tilt("0.0371595 deg")
        .oscillator("1.65408 t", "1.428822493 Hz", 0.02)
        .build()
        .expect("a model");
    let motion = GroundMotion::evenly_spaced(0.01, x, None)
        .and_then(|motion| motion.with_y(y))
        .expect("a motion");
    let response = exact(&model, &motion).expect("a response");
    let c = check(&model, &motion, &response);
    let closest = c.closest_call.as_ref().expect("a decision");
    assert!(c.holds() && closest.margin < 1e-14, "{c:?}");
}

/// Whether the figures by axis are parts of the resultant, and all is said as in two directions.
pub fn is_on_a_line(seed: u64, response: &Response, along: [f64; 2]) {
    let (d, plane) = (&response.demands, response.in_plane.as_deref().expect("two directions"));
    assert_eq!(d.reversal_count, 0, "seed {seed}");
    let by_axis = plane.axes.each_ref().map(|axis| axis.overturning_ratio.unwrap_or(0.0));
    let ratio = d.overturning_ratio.expect("widths and heights");
    assert!((ratio - by_axis[0] - by_axis[1]).abs() <= 1e-15 * ratio, "seed {seed}");
    assert!(d.residual_sliding_displacement_m >= 0.0, "seed {seed}");
    let reverses = response.events.iter().any(|event| event.kind == EventKind::Reversal);
    assert!(!reverses, "seed {seed}");
    for (axis, part) in plane.axes.iter().zip(along) {
        type Named = (&'static str, fn(&Demands) -> f64);
        let figures: [Named; 7] = [
            ("peak s", |d| d.peak_sliding_displacement_m),
            ("residual s", |d| d.residual_sliding_displacement_m.abs()),
            ("peak w", |d| d.peak_sliding_velocity_m_per_s),
            ("block", |d| d.peak_block_acceleration_m_per_s2),
            ("friction", |d| d.peak_friction_force_n),
            ("slider", |d| d.peak_slider_force_n),
            ("shear", |d| d.peak_base_shear_n),
        ];
        for (what, of) in figures {
            let expected = part.abs() * of(d);
            let off = (of(axis) - expected).abs();
            assert!(off <= 1e-12 * of(d), "seed {seed}: {what} {} {expected}", of(axis));
        }
        for (storey, whole) in axis.storeys.iter().zip(&d.storeys) {
            let expected = part.abs() * whole.peak_acceleration_m_per_s2;
            let off = (storey.peak_acceleration_m_per_s2 - expected).abs();
            assert!(off <= 1e-12 * whole.peak_acceleration_m_per_s2, "seed {seed}: a floor");
        }
    }
    let [x, y] = along;
    for event in &plane.events {
        let [a, b] = event.direction;
        assert!((a * y - b * x).abs() <= 1e-15, "seed {seed}: {:?}", event.direction);
    }
}

/// The least speed within slips of a motion along a line is that of one that is off the line by next to nothing, which
/// is solved in two directions.
#[test]
fn prop_least_speed_along_a_line_is_that_beside_it() {
    let mut found = 0;
    for seed in seeds(120) {
        let system = System::random(seed, true).along_a_line(0.0);
        let on_line = system.response();
        let mut beside = system.clone();
        beside.table[1].iter_mut().zip(&system.table[0]).for_each(|(y, x)| *y = 1e-13 * x * x);
        let beside = beside.response();
        let least =
            |r: &Response| r.in_plane.as_ref().expect("a plane").least_sliding_speed_m_per_s;
        let fastest = on_line.demands.peak_sliding_velocity_m_per_s;
        match (least(&on_line), least(&beside)) {
            (Some(a), Some(b)) => {
                assert!((a - b).abs() <= 1e-9 * fastest, "seed {seed}: {a} {b}");
                found += usize::from(a > 0.0);
            }
            (a, b) => assert_eq!(a, b, "seed {seed}"),
        }
    }
    println!("{found} least speeds that are not 0");
    assert!(found > 0);
}

/// Both components of a pair in proportion 3 : 4 have their part of friction and no more.
#[test]
fn friction_of_a_pair_in_proportion_is_its_part() {
    let mut system = System::random(4, true).along_a_line(0.0);
    (system.by_speed, system.vertical) = (None, None);
    system.friction = [0.07, 0.05];
    system.initial = [[0.0; 2]; 2];
    let x = system.table[0].clone();
    system.table = [x.iter().map(|a| 3.0 * a).collect(), x.iter().map(|a| 4.0 * a).collect()];
    let response = system.response();
    assert!(response.demands.slip_count > 0);
    is_on_a_line(4, &response, [0.6, 0.8]);
    let judge = |response: &Response| check(&system.model(), &system.motion(), response);
    assert!(judge(&response).holds(), "{:?}", judge(&response));
    // What friction would have along x if it had turned through that axis.
    let mut turned = response.clone();
    let whole_n = response.demands.peak_friction_force_n;
    turned.in_plane.as_mut().expect("a plane").axes[0].peak_friction_force_n = whole_n;
    assert!(judge(&turned).demands_error > 0.1);
}

/// Without kinetic friction nothing turns a motion to a line, and what passes rest on one is held there as in
/// one direction.
#[test]
fn prop_without_kinetic_friction_a_line_is_one_direction() {
    all_agree("along a line without kinetic friction", true, |seed, system| {
        let system = system.without_kinetic_friction();
        let along = system.along_a_line(0.3 + 0.9 * seed as f64);
        let (model, motion, response) = (along.model(), along.motion(), along.response());
        let certificate = check(&model, &motion, &response);
        assert!(certificate.holds(), "seed {seed}: {:?}", certificate.closest_call);
        (system.along_x(), response)
    });
}

/// Without anything along y the solver in one direction runs: not a bit differs of what means the same.
#[test]
fn nothing_along_y_gives_the_bits_of_one_direction() {
    for seed in 0..20 {
        let mut system = System::random(seed, false).along_a_line(0.0);
        system.table[1].fill(0.0);
        let (plane, straight) = (system.response(), system.along_x());
        let own: Vec<_> =
            straight.events.iter().filter(|e| e.kind != EventKind::Reversal).cloned().collect();
        let c = check(&system.model(), &system.motion(), &plane);
        assert!(c.holds(), "seed {seed}: {c:?}");
        is_on_a_line(seed, &plane, [1.0, 0.0]);
        assert_eq!(differences(&plane.demands, &straight.demands), zeros(&straight.demands));
        let times = |events: &[slipstick::response::Event]| {
            events
                .iter()
                .map(|event| (event.time_s, event.sliding_displacement_m))
                .collect::<Vec<_>>()
        };
        assert_eq!(times(&plane.events), times(&own));
        let x = straight.history.as_ref().expect("a history");
        let h = plane.history.as_ref().expect("a history");
        assert_eq!(h.sliding_displacement_m, x.sliding_displacement_m);
        assert_eq!(h.storey_acceleration_m_per_s2, x.storey_acceleration_m_per_s2);

        let mut turned = system.changed(|[x, y]| [y, x]);
        turned.stiffnesses.reverse();
        turned.damping.reverse();
        let response = turned.response();
        let c = check(&turned.model(), &turned.motion(), &response);
        assert!(c.holds(), "seed {seed} along y: {c:?}");
        is_on_a_line(seed, &response, [0.0, 1.0]);
        assert_eq!(differences(&response.demands, &straight.demands), zeros(&straight.demands));
        let in_plane = response.in_plane.as_deref().expect("two directions");
        let y = in_plane.history.as_ref().expect("a history along y");
        assert_eq!(y.sliding_displacement_m, x.sliding_displacement_m);
        assert_eq!(in_plane.events.len(), own.len());
    }
}

/// Models that share what is linear, and that do not: each has the bits of an analysis of its own, though it comes after
/// another.
#[test]
fn a_prepared_model_gives_way_to_others() {
    let mut differ = 0;
    for seed in 0..8 {
        let mut system = System::random(seed, false);
        let motion = PreparedMotion::new(system.motion());
        let mut prepared = Prepared::new(system.model(), motion.dt_s());
        let first = prepared.demands(&motion).expect("a response").demands;
        for change in 0..3 {
            match change {
                0 => system.friction = system.friction.map(|mu| 0.8 * mu),
                1 => system.stiffnesses[1].iter_mut().for_each(|k| *k *= 1.2),
                _ => system.damping[1] *= 1.1,
            }
            let model = system.model();
            let own = exact(&model, &system.motion()).expect("a response");
            prepared = prepared.with_model(model);
            let shared = prepared.demands(&motion).expect("a response");
            assert_eq!(shared.demands, own.demands, "seed {seed}, change {change}");
            assert_eq!(shared.events, own.events, "seed {seed}, change {change}");
            differ += usize::from(shared.demands != first);
        }
    }
    assert!(differ > 16, "{differ}");
}

/// No difference in any figure.
fn zeros(demands: &Demands) -> Vec<(&'static str, f64)> {
    differences(demands, demands)
}

/// The check, which shares nothing with the solver, comes to the same.
#[test]
fn prop_random_systems_are_certified() {
    let (mut wrong, mut worst, mut count) = (Vec::new(), 0.0_f64, 0);
    for seed in seeds(100) {
        let system = System::random(seed, false);
        let (model, motion) = (system.model(), system.motion());
        let c = check(&model, &motion, &exact(&model, &motion).expect("a response"));
        let figures =
            [c.equilibrium_residual, c.friction_excess, c.energy_balance_error, c.demands_error];
        worst = figures.into_iter().fold(worst, f64::max);
        if !c.holds() {
            wrong.push(format!("seed {seed}: {figures:?}"));
        }
        count += 1;
    }
    println!("certified: {count} systems, worst figure {worst:.1e}");
    assert!(wrong.is_empty(), "{} of {count}:\n{}", wrong.len(), wrong.join("\n"));
}

/// The same where some storeys are a hundred to a thousand times as stiff as their neighbours: what is rounding of the
/// force of a stiff storey on a soft one is far more than that of an acceleration.
#[test]
fn prop_soft_and_stiff_storeys_are_certified() {
    for seed in seeds(40) {
        let mut system = System::random(seed, false);
        if system.floors_kg.len() < 2 {
            continue;
        }
        let mut r = Random::new(1000 + seed);
        let first = usize::from(r.chance(0.5));
        for k in &mut system.stiffnesses {
            for stiff in k.iter_mut().skip(first).step_by(2) {
                *stiff *= [100.0, 300.0, 1000.0][(r.unit() * 3.0) as usize];
            }
        }
        system.dampers = false;
        let (model, motion, response) = (system.model(), system.motion(), system.response());
        let certificate = check(&model, &motion, &response);
        assert!(certificate.holds(), "seed {seed}: {certificate:?}");
    }
}

/// Slips of some 20 µs, at whose stop the rounding of a time is all that is left of the speed.
#[test]
fn a_slip_of_microseconds_has_the_direction_of_its_push() {
    for seed in [1211, 7797] {
        let system = System::random(seed, false);
        let (model, motion, response) = (system.model(), system.motion(), system.response());
        let certificate = check(&model, &motion, &response);
        assert!(certificate.holds(), "seed {seed}: {certificate:?}");
    }
}

/// A release from friction that is no less in a slip begins with no acceleration.
#[test]
fn prop_systems_of_one_coefficient_are_certified() {
    for seed in seeds(60) {
        let system = System::random(seed, false);
        let system = System { friction: [system.friction[0]; 2], by_speed: None, ..system };
        let (model, motion, response) = (system.model(), system.motion(), system.response());
        let certificate = check(&model, &motion, &response);
        assert!(certificate.holds(), "seed {seed}: {certificate:?}");
    }
}

/// A block that is held, h = 0.4 m on 0.5 m by 0.8 m: `r = h a/(g b)` along each axis, and `|r_x| + |r_y|` at its corners, where both
/// are at one instant.
#[test]
fn a_base_is_lifted_at_a_corner_by_both_axes_at_once() {
    let mut system = System::random(1, true);
    (system.floors_kg, system.stiffnesses) = (Vec::new(), [Vec::new(), Vec::new()]);
    (system.friction, system.by_speed, system.vertical) = ([0.9, 0.8], None, None);
    (system.initial, system.slider) = ([[0.0; 2]; 2], Restoring::Flat);
    system.times_s = (0..5).map(f64::from).collect();
    // At 1 s along x alone, at 2 s along both, at 3 s along −y alone.
    system.table = [vec![0.0, 3.0, -2.0, 0.0, 0.0], vec![0.0, 0.0, 1.6, -2.0, 0.0]];
    let model = system.model();
    let block = Block { width_m: Some(0.5), ..*model.block() };
    let along_y = AlongY { width_m: Some(0.8), ..model.along_y() };
    let model = Model::new(
        block,
        model.slider().clone(),
        model.frame().clone(),
        9.80665,
        InitialState::rest(),
    )
    .and_then(|model| model.with_along_y(along_y))
    .expect("a model");
    let response = exact(&model, &system.motion()).expect("a response");
    let c = check(&model, &system.motion(), &response);
    assert!(c.holds(), "{c:?}");
    let of = |x: f64, y: f64| 0.4 / 9.80665 * (x / 0.5 + y / 0.8);
    let plane = response.in_plane.as_deref().expect("two directions");
    let found = [&response.demands, &plane.axes[0], &plane.axes[1]]
        .map(|demands| demands.overturning_ratio.expect("widths and a height"));
    for (found, expected) in found.into_iter().zip([of(3.0, 0.0), of(3.0, 0.0), of(0.0, 2.0)]) {
        assert!((found - expected).abs() <= 1e-15, "{found} {expected}");
    }
    // With more along y at 2 s the corner is what is lifted first.
    system.table[1][2] = 1.9;
    let response = exact(&model, &system.motion()).expect("a response");
    let found = response.demands.overturning_ratio.expect("a ratio");
    assert!((found - of(2.0, 1.9)).abs() <= 1e-15 && of(2.0, 1.9) > of(3.0, 0.0), "{found}");
    let c = check(&model, &system.motion(), &response);
    assert!(c.holds(), "{c:?}");
    let mut tampered = response.clone();
    tampered.demands.overturning_ratio = Some(of(3.0, 0.0));
    assert!(check(&model, &system.motion(), &tampered).demands_error > 1e-3);
}

#[test]
fn what_does_not_move_in_two_directions_is_refused() {
    let system = System::random(1, true);
    let model = system.model();
    let refused = |friction: Friction| {
        let error = exact(&model.with_friction(friction), &system.motion());
        error.expect_err("a refusal").to_string()
    };
    let expected = "two horizontal directions: expected a model without friction by direction";
    let uneven = Friction::by_direction([0.06; 2], [0.05, 0.04]).expect("friction");
    assert_eq!(refused(uneven), expected);
    let speeds_m_per_s = vec![0.0, 0.1];
    let pieces = RateCurve::Pieces { speeds_m_per_s, coefficients: vec![0.05, 0.08] };
    let law = RateLaw::new(pieces, [1.0, 0.9]).expect("a law");
    assert_eq!(refused(Friction::by_speed([0.06; 2], law).expect("friction")), expected);
}
