//! Random systems: a model and its ground motion as plain numbers that a test can change.

use slipstick::model::{
    Block, Contents, Damping, Frame, InitialState, Model, Slider, Stop, StopKind,
};
use slipstick::motion::GroundMotion;
use slipstick::slider::{Direction, Friction, RateCurve, RateLaw, Surface, SurfacesInSeries};

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
    pub stop: Option<Stop>,
    /// Kinetic friction by speed, which at rest is the kinetic friction above.
    pub rate: Option<RateLaw>,
    /// Of a pendulum, in the place of the spring.
    pub radius_m: Option<f64>,
    /// In the place of friction and spring.
    pub series: Option<SurfacesInSeries>,
    pub contents: Vec<Contents>,
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
            stop: None,
            rate: None,
            radius_m: None,
            series: None,
            contents: vec![],
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

    /// Devices of every kind, about as often as not: stops, friction by speed, surfaces in series or a
    /// pendulum, contents.
    pub fn equip(&mut self, random: &mut Random) {
        match random.integer(0, 4) {
            0 => self.set_pieces(random),
            1 => self.set_exponential(random),
            2 => self.set_surfaces(random),
            _ => {}
        }
        if self.series.is_none() && random.chance(0.4) {
            self.radius_m = Some(random.logarithmic(0.3, 4.0));
        }
        if random.chance(0.4) {
            let gap = |r: &mut Random, s: f64| s.abs() + r.logarithmic(0.002, 0.1);
            let both = [(); 2].map(|()| Some(gap(random, self.s)));
            let gap_m = if random.chance(0.8) { both } else { [both[0], None] };
            let kind = if random.chance(0.5) {
                let restitution = if random.chance(0.2) { 0.0 } else { random.between(0.1, 0.9) };
                StopKind::Rigid { restitution }
            } else {
                let rate = random.logarithmic(10.0, 100.0);
                let ratio = if random.chance(0.3) { 0.0 } else { random.between(0.01, 0.5) };
                StopKind::Elastic {
                    stiffness_n_per_m: self.block * rate * rate,
                    damper_n_s_per_m: 2.0 * ratio * self.block * rate,
                }
            };
            self.stop = Some(Stop { gap_m, kind });
        }
        for _ in 0..[0, 0, 0, 1, 1, 2, 3][random.integer(0, 6) as usize] {
            let kinetic_friction = random.logarithmic(0.02, 0.4);
            let over = if random.chance(0.4) { 1.0 } else { random.between(1.0, 1.5) };
            self.contents.push(Contents {
                floor: random.integer(0, self.masses.len() as i64) as usize,
                mass_kg: self.block * random.logarithmic(0.02, 1.0),
                static_friction: kinetic_friction * over,
                kinetic_friction,
            });
        }
    }

    /// Kinetic friction by speed, which at rest is the kinetic friction of each direction.
    pub fn set_curve(&mut self, curve: RateCurve) {
        let factors = self.kinetic_friction.map(|mu| mu / self.kinetic_friction[0]);
        self.set_rate(RateLaw::new(curve, factors).expect("a rate law"));
    }

    /// Makes the coefficients at rest those of the law, to the last bit; those that were equal stay so.
    fn set_rate(&mut self, rate: RateLaw) {
        for (i, direction) in [Direction::Positive, Direction::Negative].into_iter().enumerate() {
            let at_rest = rate.at(0.0, direction);
            let alike = self.static_friction[i] == self.kinetic_friction[i];
            self.static_friction[i] =
                if alike { at_rest } else { self.static_friction[i].max(at_rest) };
            self.kinetic_friction[i] = at_rest;
        }
        self.rate = Some(rate);
    }

    fn set_pieces(&mut self, random: &mut Random) {
        let (mut speeds_m_per_s, mut coefficients) = (vec![0.0], vec![self.kinetic_friction[0]]);
        for i in 0..random.integer(1, 3) as usize {
            speeds_m_per_s.push(speeds_m_per_s[i] + random.logarithmic(0.02, 0.3));
            coefficients.push(coefficients[0] * random.between(0.5, 2.0));
        }
        self.set_curve(RateCurve::Pieces { speeds_m_per_s, coefficients });
    }

    fn set_exponential(&mut self, random: &mut Random) {
        let slow = self.kinetic_friction[0];
        let fast = slow * random.between(0.6, 2.5);
        let rate_s_per_m = random.logarithmic(5.0, 100.0);
        self.set_curve(RateCurve::Exponential { slow, fast, rate_s_per_m });
    }

    fn set_surfaces(&mut self, random: &mut Random) {
        let mut surface = || Surface {
            radius_m: (!random.chance(0.1)).then(|| random.logarithmic(0.3, 3.0)),
            friction: random.logarithmic(0.01, 0.2),
            travel_m: random.chance(0.4).then(|| self.s.abs() + random.logarithmic(0.05, 0.5)),
        };
        let mut surfaces = vec![surface(), surface(), surface()];
        surfaces.truncate(random.integer(1, 3) as usize);
        if surfaces.len() > 1 && random.chance(0.3) {
            surfaces[1] = surfaces[0];
        }
        let static_ratio = if random.chance(0.4) { 1.0 } else { random.between(1.0, 1.5) };
        self.series = Some(SurfacesInSeries::new(surfaces, static_ratio).expect("surfaces"));
        self.spring = 0.0;
    }

    /// Mass of block, floors and contents.
    pub fn total(&self) -> f64 {
        self.block
            + self.masses.iter().sum::<f64>()
            + self.contents.iter().map(|contents| contents.mass_kg).sum::<f64>()
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

    /// The slider.
    fn slider(&self) -> Slider {
        let fixed = self.static_friction;
        let friction = match &self.rate {
            Some(rate) => Friction::by_speed(fixed, rate.clone()),
            None => Friction::by_direction(fixed, self.kinetic_friction),
        };
        let friction = friction.expect("friction");
        let slider = match (&self.series, self.radius_m) {
            (Some(series), _) => Slider::in_series(series.clone()),
            (None, Some(radius_m)) => Slider::pendulum(friction, radius_m),
            (None, None) => Slider::sprung(friction, self.spring),
        };
        let (damper_n_s_per_m, tilt_rad) = (self.damper, self.tilt);
        Slider { damper_n_s_per_m, tilt_rad, ends: self.stop.into(), ..slider }
    }

    /// The model alone.
    pub fn model(&self) -> Model {
        Model::new(
            Block {
                mass_kg: self.block,
                width_m: self.overturns.then_some(1.0),
                height_m: self.overturns.then_some(0.5),
            },
            self.slider(),
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
        .and_then(|model| model.with_contents(self.contents.clone()))
        .expect("a model")
    }

    /// The same in units of other size: every number times the powers of the three factors that its
    /// dimension has.
    pub fn in_units(&self, mass: f64, length: f64, time: f64) -> Self {
        let acceleration = length / (time * time);
        let mut twin = self.times_factors(mass, length, time);
        twin.gravity *= acceleration;
        twin.vertical.iter_mut().flatten().for_each(|a| *a *= acceleration);
        twin.radius_m.iter_mut().for_each(|radius_m| *radius_m *= length);
        if let Some(series) = &self.series {
            twin.series = Some(of_surfaces(series, |surface| Surface {
                radius_m: surface.radius_m.map(|radius_m| radius_m * length),
                friction: surface.friction,
                travel_m: surface.travel_m.map(|travel_m| travel_m * length),
            }));
        }
        twin
    }

    /// Motion, start, friction, gaps and speeds times a factor, while the weight stays: the same story,
    /// so much larger, on a level surface.
    pub fn louder(&self, factor: f64) -> Self {
        let mut twin = self.times_factors(1.0, factor, 1.0);
        let coefficients = twin.static_friction.iter_mut().chain(&mut twin.kinetic_friction);
        coefficients.for_each(|mu| *mu *= factor);
        if let Some(rate) = &mut twin.rate {
            *rate = rate.scaled(factor);
        }
        for contents in &mut twin.contents {
            contents.static_friction *= factor;
            contents.kinetic_friction *= factor;
        }
        if let Some(series) = &self.series {
            twin.series = Some(of_surfaces(series, |surface| Surface {
                radius_m: surface.radius_m,
                friction: surface.friction * factor,
                travel_m: surface.travel_m.map(|travel_m| travel_m * factor),
            }));
        }
        twin
    }

    /// The same with all but gravity, vertical motion, radii and surfaces times the powers of the
    /// three factors that their dimensions have.
    fn times_factors(&self, mass: f64, length: f64, time: f64) -> Self {
        let velocity = length / time;
        let acceleration = velocity / time;
        let (stiffness, damper) = (mass / (time * time), mass / time);
        let each = |list: &[f64], factor: f64| list.iter().map(|x| x * factor).collect::<Vec<_>>();
        let rate = |rate: &RateLaw| {
            let curve = match rate.curve() {
                RateCurve::Pieces { speeds_m_per_s, coefficients } => RateCurve::Pieces {
                    speeds_m_per_s: each(speeds_m_per_s, velocity),
                    coefficients: coefficients.clone(),
                },
                RateCurve::Exponential { slow, fast, rate_s_per_m } => RateCurve::Exponential {
                    slow: *slow,
                    fast: *fast,
                    rate_s_per_m: rate_s_per_m / velocity,
                },
            };
            RateLaw::new(curve, factors(rate)).expect("a rate law")
        };
        let stop = |stop: Stop| Stop {
            gap_m: stop.gap_m.map(|gap_m| gap_m.map(|gap_m| gap_m * length)),
            kind: match stop.kind {
                StopKind::Elastic { stiffness_n_per_m, damper_n_s_per_m } => StopKind::Elastic {
                    stiffness_n_per_m: stiffness_n_per_m * stiffness,
                    damper_n_s_per_m: damper_n_s_per_m * damper,
                },
                rigid @ StopKind::Rigid { .. } => rigid,
            },
        };
        let contents = |x: &Contents| Contents { mass_kg: x.mass_kg * mass, ..*x };
        Self {
            block: self.block * mass,
            masses: each(&self.masses, mass),
            stiffnesses: each(&self.stiffnesses, stiffness),
            damping: match &self.damping {
                Damping::Ratio(ratio) => Damping::Ratio(*ratio),
                Damping::Dampers(c) => Damping::Dampers(each(c, damper)),
            },
            spring: self.spring * stiffness,
            damper: self.damper * damper,
            stop: self.stop.map(stop),
            rate: self.rate.as_ref().map(rate),
            contents: self.contents.iter().map(contents).collect(),
            s: self.s * length,
            w: self.w * velocity,
            q: self.q.as_ref().map(|q| each(q, length)),
            v: each(&self.v, velocity),
            times: each(&self.times, time),
            horizontal: each(&self.horizontal, acceleration),
            ..self.clone()
        }
    }

    /// The same seen from the other side.
    pub fn mirrored(&self) -> Self {
        let negated = |list: &[f64]| list.iter().map(|x| -x).collect::<Vec<_>>();
        let [positive, negative] = [self.static_friction, self.kinetic_friction]
            .map(|[positive, negative]| [negative, positive]);
        let mut twin = Self {
            static_friction: positive,
            kinetic_friction: negative,
            tilt: -self.tilt,
            s: -self.s,
            w: -self.w,
            q: self.q.as_deref().map(negated),
            v: negated(&self.v),
            horizontal: negated(&self.horizontal),
            ..self.clone()
        };
        twin.stop.iter_mut().for_each(|stop| stop.gap_m.reverse());
        if let Some(rate) = &self.rate {
            let [positive, negative] = factors(rate);
            let turned = RateLaw::new(rate.curve().clone(), [negative, positive]);
            twin.rate = Some(turned.expect("a rate law"));
        }
        twin
    }

    /// The same with friction larger by a part of it, and with record and start changed by as much
    /// either way: one after the other, lest they make up for each other.
    pub fn perturbed(&self, relative: f64) -> [Self; 2] {
        let mut rougher = self.clone();
        // The same factor for all: static and kinetic friction that are equal stay so.
        for mu in rougher.static_friction.iter_mut().chain(&mut rougher.kinetic_friction) {
            *mu *= 1.0 + relative;
        }
        if let Some(rate) = &self.rate {
            rougher.set_rate(rate.scaled(1.0 + relative));
        }
        if let Some(series) = &mut rougher.series {
            *series = series.scaled(1.0 + relative).expect("surfaces");
        }
        for contents in &mut rougher.contents {
            contents.static_friction *= 1.0 + relative;
            contents.kinetic_friction *= 1.0 + relative;
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

/// Factors of a rate law for sliding towards +x and −x.
fn factors(rate: &RateLaw) -> [f64; 2] {
    [Direction::Positive, Direction::Negative].map(|direction| rate.factor(direction))
}

/// Surfaces made of others one by one.
fn of_surfaces(
    series: &SurfacesInSeries,
    change: impl Fn(&Surface) -> Surface,
) -> SurfacesInSeries {
    let surfaces = series.surfaces().iter().map(change).collect();
    SurfacesInSeries::new(surfaces, series.static_ratio()).expect("surfaces")
}
