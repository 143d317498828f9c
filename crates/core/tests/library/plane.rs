//! Two horizontal directions: what turning, mirroring and exchanging the axes must not change, and how motion
//! along a line agrees with the solver in one direction.

// The numbers of a run are for people who look for them with --nocapture; helpers of tests may panic as
// tests do; a seed from outside to look for more.
#![allow(clippy::disallowed_macros, clippy::disallowed_methods, clippy::expect_used)]

use slipstick::check::check;
use slipstick::model::{AlongY, Block, Damping, Frame, InitialState, Model, Slider};
use slipstick::motion::GroundMotion;
use slipstick::response::{Demands, EventKind, Response};
use slipstick::slider::{Friction, RateCurve, RateLaw};
use slipstick::solver::exact;

/// Numbers of a seed.
struct Random(u64);

impl Random {
    fn new(seed: u64) -> Self {
        let mut random = Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ 0xD1B5_4A32_D192_ED03);
        (0..8).for_each(|_| _ = random.unit());
        random
    }

    /// In [0, 1).
    fn unit(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    fn chance(&mut self, part: f64) -> bool {
        self.unit() < part
    }
}

/// A system in numbers that can be turned: all vectors as x and y.
#[derive(Clone)]
struct System {
    mass_kg: f64,
    floors_kg: Vec<f64>,
    stiffnesses: [Vec<f64>; 2],
    damping: [f64; 2],
    /// Whether damping is by dampers, which do not part into modes.
    dampers: bool,
    friction: [f64; 2],
    /// `μ_fast` and `α` in s/m, of friction by speed.
    by_speed: Option<[f64; 2]>,
    slider: Restoring,
    damper: f64,
    initial: [[f64; 2]; 2],
    times_s: Vec<f64>,
    table: [Vec<f64>; 2],
    vertical: Option<Vec<f64>>,
}

#[derive(Clone, Copy)]
enum Restoring {
    Flat,
    Spring(f64),
    Pendulum(f64),
}

impl System {
    /// One of many; with equal frames along both axes, if that is wanted.
    fn random(seed: u64, equal: bool) -> Self {
        let mut r = Random::new(seed);
        let storeys = (r.unit() * 4.0) as usize;
        let floors_kg: Vec<f64> = (0..storeys).map(|_| r.between(200.0, 900.0)).collect();
        let stiff =
            |r: &mut Random| floors_kg.iter().map(|m| m * r.between(80.0, 2500.0)).collect();
        let (x, y): (Vec<f64>, Vec<f64>) = (stiff(&mut r), stiff(&mut r));
        let damping = [r.between(0.0, 0.08), r.between(0.0, 0.08)];
        let kinetic = r.between(0.01, 0.12);
        let fixed = if r.chance(0.4) { kinetic } else { kinetic * r.between(1.0, 1.8) };
        let mass_kg = r.between(100.0, 1500.0);
        let slider = match (r.unit() * 3.0) as u32 {
            0 => Restoring::Flat,
            1 => Restoring::Spring(mass_kg * r.between(1.0, 60.0)),
            _ => Restoring::Pendulum(r.between(0.5, 4.0)),
        };
        let damper = if r.chance(0.3) { mass_kg * r.between(0.0, 2.0) } else { 0.0 };
        let moves = r.chance(0.3);
        let mut start =
            |size: f64| [0; 2].map(|_| if moves { r.between(-size, size) } else { 0.0 });
        let initial = [start(0.05), start(0.4)];
        let dt_s = [0.005, 0.01, 0.02][(r.unit() * 3.0) as usize];
        let samples = 250;
        let mut times_s: Vec<f64> = (0..samples).map(|k| k as f64 * dt_s).collect();
        let mut wave = |size: f64| {
            let terms: Vec<[f64; 3]> = (0..4)
                .map(|_| [size * r.unit(), r.between(2.0, 40.0), r.between(0.0, 6.3)])
                .collect();
            let noise = 0.1 * size;
            let of = |r: &mut Random, t: f64| {
                let sines = terms.iter().map(|[a, w, p]| a * libm_sin(w * t + p));
                sines.sum::<f64>() + noise * r.between(-1.0, 1.0)
            };
            times_s.iter().map(|t| of(&mut r, *t)).collect::<Vec<f64>>()
        };
        let size = 9.81 * kinetic * 2.5;
        let mut table = [wave(size), wave(size)];
        let vertical = wave(4.0);
        let vertical = r.chance(0.3).then_some(vertical);
        if vertical.is_none() && r.chance(0.3) {
            // A jump.
            let at = 100;
            times_s[at] = times_s[at - 1];
        }
        if r.chance(0.2) {
            // Quiet for a while.
            table.iter_mut().for_each(|a| a[60..90].fill(0.0));
        }
        let y = if equal { x.clone() } else { y };
        let damping = if equal { [damping[0]; 2] } else { damping };
        let dampers = r.chance(0.3);
        let friction = [fixed, kinetic];
        let by_speed = [kinetic * r.between(0.4, 2.5), r.between(2.0, 80.0)];
        let by_speed = r.chance(0.4).then_some(by_speed);
        let slips_freely = by_speed.is_none() && r.chance(0.1);
        let friction = match slips_freely {
            true => [if r.chance(0.5) { fixed } else { 0.0 }, 0.0],
            false => friction,
        };
        Self {
            mass_kg,
            floors_kg,
            stiffnesses: [x, y],
            damping,
            dampers,
            friction,
            by_speed,
            slider,
            damper,
            initial,
            times_s,
            table,
            vertical,
        }
    }

    /// The same moving along a line at an angle as x alone does.
    fn along_a_line(&self, angle: f64) -> Self {
        let (sine, cosine) = (libm_sin(angle), libm_sin(angle + core::f64::consts::FRAC_PI_2));
        let on = |x: f64| [cosine * x, sine * x];
        let x = &self.table[0];
        Self {
            initial: self.initial.map(|[x, _]| on(x)),
            table: [0, 1].map(|axis| x.iter().map(|x| on(*x)[axis]).collect()),
            ..self.clone()
        }
    }

    /// The same without kinetic friction, from rest.
    fn without_kinetic_friction(&self) -> Self {
        Self {
            friction: [self.friction[0], 0.0],
            by_speed: None,
            initial: [[0.0; 2]; 2],
            ..self.clone()
        }
    }

    /// The same with all vectors changed.
    fn changed(&self, of: impl Fn([f64; 2]) -> [f64; 2]) -> Self {
        let [x, y] = &self.table;
        let (x, y) = x.iter().zip(y).map(|(x, y)| of([*x, *y])).map(|[x, y]| (x, y)).unzip();
        Self { initial: self.initial.map(&of), table: [x, y], ..self.clone() }
    }

    /// The same with two more samples between each two, on the lines between them.
    fn with_collinear_samples(&self) -> Self {
        let fill = |list: &[f64]| {
            let mut all = vec![list[0]];
            for (k, pair) in list.windows(2).enumerate() {
                if self.times_s[k + 1] > self.times_s[k] {
                    all.push(pair[0] + (pair[1] - pair[0]) * 0.25);
                    all.push(pair[0] + (pair[1] - pair[0]) * 0.625);
                }
                all.push(pair[1]);
            }
            all
        };
        Self {
            times_s: fill(&self.times_s),
            table: [fill(&self.table[0]), fill(&self.table[1])],
            vertical: self.vertical.as_deref().map(fill),
            ..self.clone()
        }
    }

    fn model(&self) -> Model {
        let [fixed, kinetic] = self.friction;
        let friction = match self.by_speed {
            None => Friction::new(fixed, kinetic),
            Some([fast, rate_s_per_m]) => {
                let curve = RateCurve::Exponential { slow: kinetic, fast, rate_s_per_m };
                RateLaw::new(curve, [1.0; 2]).and_then(|law| Friction::by_speed([fixed; 2], law))
            }
        }
        .expect("friction");
        let slider = match self.slider {
            Restoring::Flat => Slider::new(friction),
            Restoring::Spring(stiffness) => Slider::sprung(friction, stiffness),
            Restoring::Pendulum(radius_m) => Slider::pendulum(friction, radius_m),
        };
        let damping = |axis: usize| match self.dampers {
            true => {
                let k = self.stiffnesses[axis].iter().enumerate();
                let uneven = |(i, k): (usize, &f64)| k * self.damping[axis] * 0.05 * (1 + i) as f64;
                Damping::Dampers(k.map(uneven).collect())
            }
            false => Damping::Ratio(self.damping[axis]),
        };
        let initial = |axis: usize| InitialState {
            sliding_displacement_m: self.initial[0][axis],
            sliding_velocity_m_per_s: self.initial[1][axis],
            ..InitialState::rest()
        };
        let frame = Frame {
            masses_kg: self.floors_kg.clone(),
            stiffnesses_n_per_m: self.stiffnesses[0].clone(),
            damping: damping(0),
            heights_m: Some(vec![1.1; self.floors_kg.len()]),
        };
        let along_y = AlongY {
            stiffnesses_n_per_m: self.stiffnesses[1].clone(),
            damping: damping(1),
            width_m: Some(0.6),
            initial: initial(1),
        };
        let block = Block { mass_kg: self.mass_kg, width_m: Some(0.6), height_m: Some(0.4) };
        let slider = Slider { damper_n_s_per_m: self.damper, ..slider };
        Model::new(block, slider, frame, 9.80665, initial(0))
            .and_then(|model| model.with_along_y(along_y))
            .expect("a model")
    }

    fn motion(&self) -> GroundMotion {
        let [x, y] = self.table.clone();
        GroundMotion::new(self.times_s.clone(), x, self.vertical.clone())
            .and_then(|motion| motion.with_y(y))
            .expect("a motion")
    }

    fn response(&self) -> Response {
        exact(&self.model(), &self.motion()).expect("a response")
    }

    /// That of x alone, by the solver in one direction.
    fn along_x(&self) -> Response {
        let motion =
            GroundMotion::new(self.times_s.clone(), self.table[0].clone(), self.vertical.clone());
        exact(&self.along_a_line(0.0).model(), &motion.expect("a motion")).expect("a response")
    }
}

/// A sine to within rounding, for made motions.
fn libm_sin(x: f64) -> f64 {
    #[allow(clippy::disallowed_methods)]
    x.sin()
}

/// Every figure of resultants over the peak of its kind.
fn differences(a: &Demands, b: &Demands) -> Vec<(&'static str, f64)> {
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
    }
    all
}

/// Slips and sticks in their order.
fn kinds(response: &Response) -> Vec<EventKind> {
    let own = response.events.iter().filter(|event| event.kind != EventKind::Reversal);
    own.map(|event| event.kind).collect()
}

/// Whether two responses agree; the worst figure, or what is different.
fn agree(a: &Response, b: &Response) -> Result<f64, String> {
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
fn all_agree(what: &str, equal: bool, of: impl Fn(u64, &System) -> (Response, Response)) {
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

fn turned(angle: f64) -> impl Fn([f64; 2]) -> [f64; 2] {
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

#[test]
fn prop_collinear_samples_change_nothing() {
    all_agree("collinear samples", false, |_, system| {
        (system.response(), system.with_collinear_samples().response())
    });
}

/// Friction does not know the direction: along a line all is as along x.
#[test]
fn prop_motion_along_a_line_is_motion_in_one_direction() {
    all_agree("along a line", true, |seed, system| {
        (system.along_x(), system.along_a_line(0.3 + 0.9 * seed as f64).response())
    });
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

/// Without anything along y the solver in one direction runs: not a bit differs.
#[test]
fn nothing_along_y_gives_the_bits_of_one_direction() {
    for seed in 0..20 {
        let mut system = System::random(seed, false).along_a_line(0.0);
        system.table[1].fill(0.0);
        let (plane, straight) = (system.response(), system.along_x());
        let in_plane = plane.in_plane.as_deref().expect("two directions");
        assert_eq!(plane.demands, straight.demands);
        assert_eq!(in_plane.axes[0], straight.demands);
        assert_eq!(in_plane.axes[1].peak_sliding_displacement_m, 0.0);
        assert_eq!((&plane.events, &plane.history), (&straight.events, &straight.history));

        let mut turned = system.changed(|[x, y]| [y, x]);
        turned.stiffnesses.reverse();
        turned.damping.reverse();
        let turned = turned.response();
        let in_plane = turned.in_plane.as_deref().expect("two directions");
        assert_eq!(in_plane.axes[1], straight.demands);
        let y = in_plane.history.as_ref().expect("a history along y");
        let x = straight.history.as_ref().expect("a history");
        assert_eq!(y.sliding_displacement_m, x.sliding_displacement_m);
        assert_eq!(in_plane.events.len(), straight.events.len());
    }
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

#[test]
fn what_does_not_move_in_two_directions_is_refused() {
    let system = System::random(1, true);
    let model = system.model();
    let slider = Slider { tilt_rad: 0.01, ..model.slider().clone() };
    let tilted =
        Model::new(*model.block(), slider, model.frame().clone(), 9.8, InitialState::rest());
    let error = exact(&tilted.expect("a model"), &system.motion()).expect_err("a tilt");
    assert_eq!(error.to_string(), "two horizontal directions: expected a model without tilt");

    let speeds_m_per_s = vec![0.0, 0.1];
    let pieces = RateCurve::Pieces { speeds_m_per_s, coefficients: vec![0.05, 0.08] };
    let law = RateLaw::new(pieces, [1.0; 2]).expect("a law");
    let friction = Friction::by_speed([0.06; 2], law).expect("friction");
    let error = exact(&model.with_friction(friction), &system.motion()).expect_err("pieces");
    assert_eq!(
        error.to_string(),
        "two horizontal directions: expected a model without friction by straight lines of the speed"
    );
}
