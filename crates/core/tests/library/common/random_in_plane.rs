//! Random systems in two horizontal directions, in numbers that can be turned.

use slipstick::model::{AlongY, Block, Damping, Frame, InitialState, Model, Slider};
use slipstick::motion::GroundMotion;
use slipstick::response::Response;
use slipstick::slider::{Friction, RateCurve, RateLaw, Stop};
use slipstick::solver::exact;

use super::by_modes::{by_modes, cut_and_turned};

/// Numbers of a seed.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        let mut random = Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ 0xD1B5_4A32_D192_ED03);
        (0..8).for_each(|_| _ = random.unit());
        random
    }

    /// In [0, 1).
    pub fn unit(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    pub fn chance(&mut self, part: f64) -> bool {
        self.unit() < part
    }
}

/// A system in numbers that can be turned: all vectors as x and y.
#[derive(Clone)]
pub struct System {
    pub mass_kg: f64,
    pub floors_kg: Vec<f64>,
    pub stiffnesses: [Vec<f64>; 2],
    pub damping: [f64; 2],
    /// Whether damping is by dampers, which do not part into modes.
    pub dampers: bool,
    pub friction: [f64; 2],
    /// `μ_fast` and `α` in s/m, of friction by speed.
    pub by_speed: Option<[f64; 2]>,
    /// Corners of friction by straight lines of the speed after that at rest: speeds in m/s and `μ` there.
    pub corners: Vec<[f64; 2]>,
    pub slider: Restoring,
    pub damper: f64,
    pub initial: [[f64; 2]; 2],
    pub times_s: Vec<f64>,
    pub table: [Vec<f64>; 2],
    pub vertical: Option<Vec<f64>>,
    /// `sin θ` of the tilt along x and y.
    pub slope: [f64; 2],
    /// Gap, stiffness and damper of a stop around the block.
    pub ring: Option<Stop>,
}

#[derive(Clone, Copy)]
pub enum Restoring {
    Flat,
    Spring(f64),
    Pendulum(f64),
}

impl System {
    /// One of many; with equal frames along both axes, if that is wanted.
    pub fn random(seed: u64, equal: bool) -> Self {
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
            corners: Vec::new(),
            slider,
            damper,
            initial,
            times_s,
            table,
            vertical,
            slope: [0.0; 2],
            ring: None,
        }
    }

    /// The same with a ring within what it would slide, and a start within it.
    pub fn with_ring(&self, seed: u64) -> Self {
        let mut r = Random::new(9_000_011 + seed);
        let free_m = self.response().demands.peak_sliding_displacement_m;
        let [x, y] = self.initial[0];
        let gap_m = (free_m * r.between(0.2, 0.95)).max(1.01 * libm::hypot(x, y)).max(1e-4);
        let total_kg = self.mass_kg + self.floors_kg.iter().sum::<f64>();
        let rate = [5.0, 30.0, 150.0][(r.unit() * 3.0) as usize] * r.between(0.5, 2.0);
        let ratio = if r.chance(0.3) { 0.0 } else { r.between(0.0, 0.6) };
        let ring =
            Stop::elastic([Some(gap_m); 2], total_kg * rate * rate, 2.0 * ratio * total_kg * rate);
        Self { ring: Some(ring), ..self.clone() }
    }

    /// The same with one that does not give way.
    pub fn with_wall(&self, seed: u64) -> Self {
        let mut r = Random::new(5_000_011 + seed);
        let ringed = self.with_ring(seed);
        // Without any loss a block may hop along it more often than can be followed.
        let restitution = if r.chance(0.25) { 0.0 } else { r.between(0.05, 0.95) };
        let ring = ringed.ring.map(|ring| Stop::rigid(ring.gap_m, restitution));
        Self { ring, ..ringed }
    }

    /// The same with friction by straight lines of the speed.
    pub fn with_lines(&self, seed: u64) -> Self {
        let mut r = Random::new(3_000_017 + seed);
        let [fixed, kinetic] = self.friction;
        let kinetic = if kinetic > 0.0 { kinetic } else { 0.03 };
        let (mut speed, mut corners) = (0.0, Vec::new());
        for _ in 0..1 + (r.unit() * 4.0) as usize {
            speed += [1e-3, 0.02, 0.1, 0.4][(r.unit() * 4.0) as usize] * r.between(0.3, 1.0);
            corners.push([speed, kinetic * r.between(0.3, 2.5)]);
        }
        Self { friction: [fixed.max(kinetic), kinetic], by_speed: None, corners, ..self.clone() }
    }

    /// The same on a surface with a tilt.
    pub fn on_a_slope(&self, seed: u64) -> Self {
        let mut r = Random::new(5_000_011 + seed);
        let most = 1.3 * self.friction[0];
        Self { slope: [0; 2].map(|_| r.between(-most, most)), ..self.clone() }
    }

    /// The same moving along a line at an angle as x alone does.
    pub fn along_a_line(&self, angle: f64) -> Self {
        let (sine, cosine) = (libm_sin(angle), libm_sin(angle + core::f64::consts::FRAC_PI_2));
        let on = |x: f64| [cosine * x, sine * x];
        let x = &self.table[0];
        Self {
            slope: on(self.slope[0]),
            initial: self.initial.map(|[x, _]| on(x)),
            table: [0, 1].map(|axis| x.iter().map(|x| on(*x)[axis]).collect()),
            ..self.clone()
        }
    }

    /// The same without kinetic friction, from rest.
    pub fn without_kinetic_friction(&self) -> Self {
        Self {
            friction: [self.friction[0], 0.0],
            by_speed: None,
            corners: Vec::new(),
            initial: [[0.0; 2]; 2],
            ..self.clone()
        }
    }

    /// The same with all vectors changed.
    pub fn changed(&self, of: impl Fn([f64; 2]) -> [f64; 2]) -> Self {
        let [x, y] = &self.table;
        let (x, y) = x.iter().zip(y).map(|(x, y)| of([*x, *y])).map(|[x, y]| (x, y)).unzip();
        let (initial, slope) = (self.initial.map(&of), of(self.slope));
        Self { initial, slope, table: [x, y], ..self.clone() }
    }

    /// The same with two more samples between each two, on the lines between them.
    pub fn with_collinear_samples(&self) -> Self {
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

    pub fn model(&self) -> Model {
        let [fixed, kinetic] = self.friction;
        let curve = match self.by_speed {
            Some([fast, rate_s_per_m]) => {
                Some(RateCurve::Exponential { slow: kinetic, fast, rate_s_per_m })
            }
            None if self.corners.is_empty() => None,
            None => {
                let all = || [[0.0, kinetic]].into_iter().chain(self.corners.iter().copied());
                let speeds_m_per_s = all().map(|[speed, _]| speed).collect();
                let coefficients = all().map(|[_, mu]| mu).collect();
                Some(RateCurve::Pieces { speeds_m_per_s, coefficients })
            }
        };
        let friction = match curve {
            None => Friction::new(fixed, kinetic),
            Some(curve) => {
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
        let [tilt_rad, tilt_y_rad] = self.slope.map(libm::asin);
        let ends = self.ring.map_or(slider.ends, Stop::into);
        let damper_n_s_per_m = self.damper;
        let slider = Slider { damper_n_s_per_m, tilt_rad, tilt_y_rad, ends, ..slider };
        Model::new(block, slider, frame, 9.80665, initial(0))
            .and_then(|model| model.with_along_y(along_y))
            .expect("a model")
    }

    pub fn motion(&self) -> GroundMotion {
        let [x, y] = self.table.clone();
        GroundMotion::new(self.times_s.clone(), x, self.vertical.clone())
            .and_then(|motion| motion.with_y(y))
            .expect("a motion")
    }

    pub fn response(&self) -> Response {
        exact(&self.model(), &self.motion()).expect("a response")
    }

    /// That of x alone, by the solver in one direction.
    pub fn along_x(&self) -> Response {
        let motion =
            GroundMotion::new(self.times_s.clone(), self.table[0].clone(), self.vertical.clone());
        exact(&self.along_a_line(0.0).model(), &motion.expect("a motion")).expect("a response")
    }
}

/// A sine to within rounding, for made motions.
pub fn libm_sin(x: f64) -> f64 {
    #[allow(clippy::disallowed_methods)]
    x.sin()
}

/// A system of a seed, a tenth with storeys a hundred times as stiff as those beside them, and a tenth with storeys that
/// ring up to 30 radians from a sample to the next; and the numbers that follow.
pub fn with_stiff_storeys(seed: u64) -> (System, Random) {
    let mut system = System::random(seed, seed.is_multiple_of(7));
    let mut r = Random::new(7_000_003 + seed);
    if r.chance(0.1) {
        let first = usize::from(r.chance(0.5));
        for k in &mut system.stiffnesses {
            k.iter_mut().skip(first).step_by(2).for_each(|stiff| *stiff *= 100.0);
        }
    }
    let mut other = Random::new(11_000_027 + seed);
    if other.chance(0.1) {
        let step_s = system.times_s[1] - system.times_s[0];
        let of =
            |k: &Vec<f64>| k.iter().zip(&system.floors_kg).map(|(k, m)| k / m).fold(0.0, f64::max);
        // No frame rings faster than twice the fastest of its storeys by itself, or hardly.
        let fastest = 2.0 * system.stiffnesses.iter().map(of).fold(0.0, f64::max).sqrt();
        let wanted = other.between(3.0, 30.0) / step_s;
        if fastest > 0.0 && wanted > fastest {
            let factor = (wanted / fastest) * (wanted / fastest);
            system.stiffnesses.iter_mut().flatten().for_each(|stiff| *stiff *= factor);
        }
    }
    (system, r)
}

/// A model and a motion of a seed in two directions: every other one a structure by its modes, of which some are cut in
/// half of them, so that what moves with the block joins x and y.
pub fn in_plane(seed: u64) -> (Model, GroundMotion) {
    let (mut system, mut r) = with_stiff_storeys(seed);
    let is_by_modes = seed.is_multiple_of(2) && !system.floors_kg.is_empty();
    // Ratios of critical damping are what modes have.
    system.dampers &= !is_by_modes;
    let motion = system.motion();
    if !is_by_modes {
        return (system.model(), motion);
    }
    if r.chance(0.5) {
        return (by_modes(&system.model()), motion);
    }
    let modes = 2 * system.floors_kg.len();
    let kept = 1 + (r.unit() * modes as f64) as usize;
    let angle = if r.chance(0.2) { 0.0 } else { r.between(0.0, 3.1) };
    (cut_and_turned(&system.model(), kept, angle), motion)
}
