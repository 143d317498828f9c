//! Random systems: a model and its ground motion as plain numbers that a test can change.

use slipstick::friction::{Coulomb, Friction};
use slipstick::model::{Block, Damping, Frame, InitialState, Model, Slider};
use slipstick::motion::GroundMotion;

use super::random::Random;

/// Everything a response depends on, SI.
#[derive(Clone, Debug)]
pub struct Sketch {
    pub block: f64,
    pub masses: Vec<f64>,
    pub stiffnesses: Vec<f64>,
    pub damping: Damping,
    pub spring: f64,
    pub damper: f64,
    /// For sliding towards +x and −x.
    pub static_friction: [f64; 2],
    pub kinetic_friction: [f64; 2],
    pub tilt: f64,
    pub gravity: f64,
    /// Whether it has a width and heights, so that the overturning moment is an output.
    pub overturns: bool,
    pub s: f64,
    pub w: f64,
    /// `None`: the model's own default.
    pub q: Option<Vec<f64>>,
    pub v: Vec<f64>,
    pub times: Vec<f64>,
    pub horizontal: Vec<f64>,
    pub vertical: Option<Vec<f64>>,
}

impl Sketch {
    /// A rigid block of 128 kg with the same friction in both directions, at rest under 8 m/s².
    pub fn block(static_friction: f64, kinetic_friction: f64) -> Self {
        Self {
            block: 128.0,
            masses: vec![],
            stiffnesses: vec![],
            damping: Damping::Ratio(0.0),
            spring: 0.0,
            damper: 0.0,
            static_friction: [static_friction; 2],
            kinetic_friction: [kinetic_friction; 2],
            tilt: 0.0,
            gravity: 8.0,
            overturns: false,
            s: 0.0,
            w: 0.0,
            q: None,
            v: vec![],
            times: vec![],
            horizontal: vec![],
            vertical: None,
        }
    }

    /// Anything an engineer might write, with up to three storeys, and no motion.
    pub fn system(random: &mut Random) -> Self {
        let n = [0, 0, 0, 0, 1, 1, 1, 1, 2, 3][random.integer(0, 9) as usize];
        Self::frame(random, n)
    }

    /// The same of so many storeys.
    pub fn frame(random: &mut Random, n: usize) -> Self {
        let kinetic = random.logarithmic(0.01, 0.3);
        let ratio = |r: &mut Random| if r.chance(0.4) { 1.0 } else { r.between(1.0, 1.6) };
        let friction = [kinetic * ratio(random), kinetic];
        let mut x = Self::block(friction[0], friction[1]);
        x.block = random.logarithmic(50.0, 500.0);
        x.gravity = [9.80665, 9.81, 8.0][random.integer(0, 2) as usize];
        if random.chance(0.25) {
            let other = random.between(0.5, 1.5);
            x.kinetic_friction[1] *= other;
            x.static_friction[1] = x.kinetic_friction[1] * ratio(random);
        }
        for _ in 0..n {
            x.masses.push(random.logarithmic(20.0, 500.0));
        }
        for i in 0..n {
            let carried: f64 = x.masses[i..].iter().sum();
            let rate = random.logarithmic(3.0, 30.0);
            x.stiffnesses.push(carried * rate * rate);
        }
        let ratio = if random.chance(0.3) { 0.0 } else { random.between(0.001, 0.1) };
        x.damping = if random.chance(0.5) {
            Damping::Ratio(ratio)
        } else {
            let link = |(k, m): (&f64, &f64)| 2.0 * ratio * (k * m).sqrt();
            Damping::Dampers(x.stiffnesses.iter().zip(&x.masses).map(link).collect())
        };
        if random.chance(0.5) {
            x.set_spring(random.logarithmic(2.0, 20.0));
        }
        if random.chance(0.3) {
            x.damper = x.total() * random.logarithmic(0.05, 5.0);
        }
        if random.chance(0.2) {
            x.tilt = random.between(-0.02, 0.02);
        }
        x.v = vec![0.0; n];
        x
    }

    /// Anything, shaken hard enough to slide: uneven steps, vertical motion, jumps, initial motion.
    pub fn shaken(random: &mut Random) -> Self {
        let mut x = Self::system(random);
        let level = x.level();
        let count = random.integer(4, 10) as usize;
        let (dt, amplitude) = (random.logarithmic(0.01, 0.2), level * random.logarithmic(1.5, 8.0));
        x.shake(random, count, dt, amplitude);
        if random.chance(0.25) {
            x.stretch_times(random);
        }
        if random.chance(0.15) {
            let vertical = x.gravity * random.between(0.0, 0.7);
            x.lift(random, vertical);
        }
        if random.chance(0.15) {
            let to = amplitude * random.between(-1.0, 1.0);
            x.add_jump(random, to);
        }
        if random.chance(0.3) {
            x.disturb(random, 0.05, 0.2);
        }
        x
    }

    /// Mass of block and floors.
    pub fn total(&self) -> f64 {
        self.block + self.masses.iter().sum::<f64>()
    }

    /// A spring with which the whole would swing at a rate in rad/s.
    pub fn set_spring(&mut self, rate: f64) {
        self.spring = self.total() * rate * rate;
    }

    /// Starts it in motion.
    pub fn disturb(&mut self, random: &mut Random, length: f64, velocity: f64) {
        self.s = length * random.between(-1.0, 1.0);
        self.w = velocity * random.between(-1.0, 1.0);
        let mut each = |size: f64| {
            self.masses.iter().map(|_| size * random.between(-1.0, 1.0)).collect::<Vec<_>>()
        };
        self.q = Some(each(0.2 * length));
        self.v = each(0.2 * velocity);
    }

    /// Kinetic friction over mass, the acceleration that matters: at least 0.1 m/s².
    pub fn level(&self) -> f64 {
        (self.gravity * self.static_friction[0].max(self.static_friction[1])).max(0.1)
    }

    /// `count` intervals of `dt` with accelerations up to `amplitude`.
    pub fn shake(&mut self, random: &mut Random, count: usize, dt: f64, amplitude: f64) {
        self.times = (0..=count).map(|i| i as f64 * dt).collect();
        self.horizontal = (0..=count).map(|_| amplitude * random.between(-1.0, 1.0)).collect();
    }

    /// Times that are not evenly spaced.
    pub fn stretch_times(&mut self, random: &mut Random) {
        let steps: Vec<f64> = self.times.windows(2).map(|pair| pair[1] - pair[0]).collect();
        for (i, step) in steps.into_iter().enumerate() {
            self.times[i + 1] = self.times[i] + step * random.between(0.3, 1.7);
        }
    }

    /// A jump at a sample inside the record.
    pub fn add_jump(&mut self, random: &mut Random, to: f64) {
        let i = random.integer(1, self.times.len() as i64 - 2) as usize;
        if self.times[i - 1] == self.times[i] || self.times[i] == self.times[i + 1] {
            return;
        }
        self.times.insert(i, self.times[i]);
        self.horizontal.insert(i + 1, to);
        if let Some(vertical) = &mut self.vertical {
            vertical.insert(i, vertical[i]);
        }
    }

    /// A vertical motion up to `amplitude`.
    pub fn lift(&mut self, random: &mut Random, amplitude: f64) {
        let each = self.times.iter().map(|_| amplitude * random.between(-1.0, 1.0));
        self.vertical = Some(each.collect());
    }

    /// Model and ground motion.
    pub fn build(&self) -> (Model, GroundMotion) {
        let (times, vertical) = (self.times.clone(), self.vertical.clone());
        let motion = GroundMotion::new(times, self.horizontal.clone(), vertical);
        (self.model(), motion.expect("a motion"))
    }

    /// The model alone.
    pub fn model(&self) -> Model {
        let friction = Coulomb::new(self.static_friction, self.kinetic_friction).expect("friction");
        Model::new(
            Block {
                mass_kg: self.block,
                width_m: self.overturns.then_some(1.0),
                height_m: self.overturns.then_some(0.5),
            },
            Slider {
                friction: Friction::Coulomb(friction),
                stiffness_n_per_m: self.spring,
                damper_n_s_per_m: self.damper,
                tilt_rad: self.tilt,
                gap_m: None,
                stop: None,
            },
            Frame {
                masses_kg: self.masses.clone(),
                stiffnesses_n_per_m: self.stiffnesses.clone(),
                damping: self.damping.clone(),
                heights_m: self.overturns.then(|| vec![3.0; self.masses.len()]),
            },
            self.gravity,
            InitialState {
                sliding_displacement_m: self.s,
                sliding_velocity_m_per_s: self.w,
                storey_displacement_m: self.q.clone(),
                storey_velocity_m_per_s: Some(self.v.clone()),
            },
        )
        .expect("a model")
    }

    /// The same with friction larger by a part of it, and with record and start changed by as much
    /// either way: one after the other, lest they make up for each other.
    pub fn perturbed(&self, relative: f64) -> [Self; 2] {
        let mut rougher = self.clone();
        // The same factor for all: static and kinetic friction that are equal stay so.
        for mu in rougher.static_friction.iter_mut().chain(&mut rougher.kinetic_friction) {
            *mu *= 1.0 + relative;
        }
        let mut random = Random::new(1);
        let mut shaken = self.clone();
        let x = &mut shaken;
        let lists = [Some(&mut x.horizontal), x.vertical.as_mut(), x.q.as_mut(), Some(&mut x.v)];
        let all = lists.into_iter().flatten().flatten();
        for value in all.chain([&mut x.s, &mut x.w]) {
            *value *= 1.0 + random.sign() * relative;
        }
        [rougher, shaken]
    }
}
