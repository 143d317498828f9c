//! The plain reference with devices: stops, friction by speed, pendulums under vertical motion,
//! surfaces in series, contents of the floors.
//!
//! As [`plain`](super::plain): physical coordinates, double-double numbers, Taylor series of degree 22
//! of the whole nonlinear motion over steps so short that their remainder is below 1e-26, events
//! isolated by the signs of Bernstein coefficients. With `α` the true accelerations plus `g sin θ`, `b`
//! that of the table and `ν = N / M_tot`:
//!
//! ```text
//! m_i α_i = −f_i + Σ σ_e μ_e m_e ν        M1 α_0 = G + Σ f_i + Σ σ_e μ_e m_e ν        s̈ = α_0 − b
//! −G = K1 s + C1 ṡ + stop + N s/R + σ μ(|ṡ|) N,    or N φ of the surfaces in place of the last two
//! contents   sliding α_e = −σ_e μ_e ν,    stuck α_e = α_i, joined to m_i
//! ```

use slipstick::model::{Model, StopKind};
use slipstick::motion::GroundMotion;
use slipstick::response::EventKind;
use slipstick::slider::{Direction, RateCurve};

use super::bernstein::{DEGREE, Poly, first_root, largest, leading, rounded, value};
use super::dd::{Dd, ONE, ZERO};
use super::system::{Load, System};

/// Part of its terms below which a number is rounding.
const NOISE: f64 = 1e-26;
/// The same of places, which are not sums of forces: last bounces at a rigid stop are 1e-26 high.
const PLACE_NOISE: f64 = 1e-30;
/// Rate of the fastest motion times the step: 0.6^23 / 23! is 3e-28.
const RATE_TIMES_STEP: f64 = 0.6;
/// What the last two terms of a nonlinear series may be, over its largest.
const LAST_TERMS: f64 = 1e-28;
/// Part of themselves by which forces of surfaces that slide together differ.
const ALIKE: f64 = 1e-20;
/// Impacts slower than this are not listed.
const LISTED_IMPACT_M_PER_S: f64 = 1e-3;
/// How long a jump takes.
const JUMP_S: f64 = 1e-20;
/// Bounces that end within this time are over.
const LAST_BOUNCES_S: f64 = 1e-13;

/// What happened, to which interface: 0 the slider, then the contents.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    pub time_s: f64,
    pub interface: usize,
    pub kind: EventKind,
    /// Sign of the velocity after it.
    pub sign: i32,
}

/// States at a sample: `s, ṡ`, then `q`, `q̇`, then displacements and velocities of the contents, then the
/// displacements of the surfaces.
#[derive(Clone, Debug)]
pub struct Sample {
    pub time_s: f64,
    pub values: Vec<f64>,
}

/// Largest absolute values of the continuous motion.
#[derive(Clone, Debug, Default)]
pub struct Peaks {
    pub s: f64,
    pub w: f64,
    pub block: f64,
    pub friction: f64,
    pub slider: f64,
    pub shear: f64,
    pub stop: f64,
    pub q: Vec<f64>,
    pub v: Vec<f64>,
    pub drift: Vec<f64>,
    pub floors: Vec<f64>,
    /// Of each of the contents: displacement and velocity over the floor, acceleration.
    pub contents: Vec<[f64; 3]>,
    pub surfaces: Vec<f64>,
}

/// A response.
#[derive(Clone, Debug, Default)]
pub struct Reference {
    pub events: Vec<Event>,
    pub samples: Vec<Sample>,
    pub peaks: Peaks,
    /// Of each interface.
    pub path: Vec<f64>,
    pub sliding_time_s: Vec<f64>,
    pub contact_time_s: f64,
    pub impact_speed: f64,
    /// When no surface could slide on, which ends the response.
    pub end_of_travel_s: Option<f64>,
}

impl Reference {
    /// Number of events of the slider of a kind.
    pub fn count(&self, kind: EventKind) -> usize {
        self.events.iter().filter(|e| e.interface == 0 && e.kind == kind).count()
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Contact {
    Free,
    Pressed(i32),
    Separated(i32),
}

/// One surface of a series.
struct Surface {
    radius: Option<Dd>,
    curvature: Dd,
    friction: Dd,
    travel: Option<Dd>,
}

/// Kinetic friction, for each direction where it is one surface.
enum Friction {
    Constant([Dd; 2]),
    /// Speeds and coefficients at the knots, and factors by direction.
    Pieces(Vec<Dd>, Vec<Dd>, [Dd; 2]),
    /// Slow, fast, rate, and factors by direction.
    Exponential([Dd; 3], [Dd; 2]),
    /// Surfaces in series and their static over kinetic friction.
    Series(Vec<Surface>, Dd),
}

#[derive(Clone, Copy)]
enum Stop {
    None,
    Elastic { k: Dd, c: Dd },
    Rigid { e: Dd },
}

struct Contents {
    floor: usize,
    mass: Dd,
    fixed: Dd,
    kinetic: Dd,
}

/// The model.
struct Body {
    frame: System,
    total: Dd,
    spring: Dd,
    damper: Dd,
    /// `1/R` of a pendulum that follows `N`.
    curvature: Dd,
    fixed: [Dd; 2],
    friction: Friction,
    stop: Stop,
    /// Places of the stops towards +x and −x.
    places: [Option<Dd>; 2],
    contents: Vec<Contents>,
    /// Bound on the rate of the fastest motion without and with a pressed stop.
    rates: [f64; 2],
}

#[derive(Clone)]
struct State {
    s: Dd,
    w: Dd,
    q: Vec<Dd>,
    v: Vec<Dd>,
    /// Displacements and velocities of contents over their floors.
    r: Vec<Dd>,
    z: Vec<Dd>,
    /// Displacements of the surfaces, and which slide.
    u: Vec<Dd>,
    active: Vec<bool>,
    /// Signs of the velocities of the interfaces, 0 in stick.
    modes: Vec<i32>,
    contact: Contact,
    piece: usize,
}

/// Taylor coefficients over a step, in the unit of the step.
struct Series {
    s: Poly<Dd>,
    w: Poly<Dd>,
    q: Vec<Poly<Dd>>,
    v: Vec<Poly<Dd>>,
    r: Vec<Poly<Dd>>,
    z: Vec<Poly<Dd>>,
    /// `α_0`, `α_i` and `α_e`.
    block: Poly<Dd>,
    floors: Vec<Poly<Dd>>,
    carried: Vec<Poly<Dd>>,
    /// `e^(−rate |ṡ|)`.
    fading: Poly<Dd>,
    /// `G`, and `T`: what of it is friction (and the whole of surfaces).
    ground: Poly<Dd>,
    friction: Poly<Dd>,
    stop: Poly<Dd>,
    shear: Poly<Dd>,
}

impl Series {
    /// Makes `[0, to]` the unit interval.
    fn cut(&mut self, to: Dd) {
        let Self { s, w, q, v, r, z, block, floors, carried, .. } = self;
        let Self { fading, ground, friction, stop, shear, .. } = self;
        let single = [s, w, block, fading, ground, friction, stop, shear];
        let lists = [q, v, r, z, floors, carried];
        for p in lists.into_iter().flatten().chain(single) {
            let mut power = ONE;
            for c in p {
                *c = *c * power;
                power = power * to;
            }
        }
    }
}

/// What ends a step early.
#[derive(Clone, Copy, Debug)]
enum Hit {
    /// An interface has no velocity.
    Still(usize),
    /// A stuck one reaches its bound, at which it slides with this sign.
    Bound(usize, i32),
    /// Friction alone reaches what it can take of a push against a stop.
    Lean,
    Contact(Contact),
    Impact,
    /// A knot of the rate law: the piece beyond it and the speed.
    Knot(usize, Dd),
    /// Surfaces join or come to their end.
    Level(Dd),
}

/// Index of a direction.
fn side(sign: i32) -> usize {
    usize::from(sign < 0)
}

/// Largest coefficient.
fn size(p: &Poly<Dd>) -> f64 {
    p.iter().fold(0.0, |m: f64, c| m.max(c.value().abs()))
}

fn signed(p: &Poly<Dd>, sign: i32) -> Poly<Dd> {
    if sign < 0 { p.map(|c| -c) } else { *p }
}

/// `e^x` by `(Σ (x/1024)^k / k!)^1024`.
fn exp(x: Dd) -> Dd {
    let y = x * (1.0 / 1024.0);
    let mut sum = ONE;
    for k in (1..=24).rev() {
        sum = ONE + sum * y / Dd::from(f64::from(k));
    }
    for _ in 0..10 {
        sum = sum * sum;
    }
    sum
}

fn smaller(a: Dd, b: Dd) -> Dd {
    if b < a { b } else { a }
}

impl Body {
    fn new(model: &Model, motion: &GroundMotion) -> Self {
        let frame = System::new(model);
        let both = |f: &dyn Fn(Direction) -> f64| {
            [Direction::Positive, Direction::Negative].map(|d| Dd::from(f(d)))
        };
        let friction = match (model.slider().series(), model.slider().rate()) {
            (Some(series), _) => {
                let surface = |surface: &slipstick::slider::Surface| Surface {
                    radius: surface.radius_m.map(Dd::from),
                    curvature: surface.radius_m.map_or(ZERO, |radius_m| ONE / Dd::from(radius_m)),
                    friction: Dd::from(surface.friction),
                    travel: surface.travel_m.map(Dd::from),
                };
                let surfaces = series.surfaces().iter().map(surface).collect();
                Friction::Series(surfaces, Dd::from(series.static_ratio()))
            }
            (None, Some(rate)) => {
                let factors = both(&|d| rate.factor(d));
                match rate.curve() {
                    RateCurve::Pieces { speeds_m_per_s, coefficients } => Friction::Pieces(
                        speeds_m_per_s.iter().copied().map(Dd::from).collect(),
                        coefficients.iter().copied().map(Dd::from).collect(),
                        factors,
                    ),
                    RateCurve::Exponential { slow, fast, rate_s_per_m } => {
                        Friction::Exponential([*slow, *fast, *rate_s_per_m].map(Dd::from), factors)
                    }
                }
            }
            (None, None) => Friction::Constant(frame.kinetic_friction),
        };
        let (mut stop, mut places) = (Stop::None, [None; 2]);
        if let Some(given) = model.stop() {
            places = [given.gap_m[0].map(Dd::from), given.gap_m[1].map(|gap_m| Dd::from(-gap_m))];
            stop = match given.kind {
                StopKind::Elastic { stiffness_n_per_m, damper_n_s_per_m } => {
                    Stop::Elastic { k: Dd::from(stiffness_n_per_m), c: Dd::from(damper_n_s_per_m) }
                }
                StopKind::Rigid { restitution } => Stop::Rigid { e: Dd::from(restitution) },
            };
        }
        let varying = motion.vertical_m_per_s2().is_some();
        let radius_m = model.slider().pendulum_radius_m(varying);
        let contents: Vec<Contents> = model
            .contents()
            .iter()
            .map(|contents| Contents {
                floor: contents.floor,
                mass: Dd::from(contents.mass_kg),
                fixed: Dd::from(contents.static_friction),
                kinetic: Dd::from(contents.kinetic_friction),
            })
            .collect();
        let mut body = Self {
            total: contents.iter().fold(frame.total_kg, |sum, c| sum + c.mass),
            spring: if radius_m.is_some() { ZERO } else { frame.spring },
            damper: frame.damper,
            curvature: radius_m.map_or(ZERO, |radius_m| ONE / Dd::from(radius_m)),
            fixed: frame.static_friction,
            friction,
            stop,
            places,
            contents,
            rates: [0.0; 2],
            frame,
        };
        let up = motion.vertical_m_per_s2().unwrap_or_default();
        let normal = up.iter().fold(0.0, |m: f64, a| m.max(*a)) + body.frame.normal_gravity.value();
        body.rates = [false, true].map(|pressed| body.fastest(normal, pressed));
        body
    }

    /// `√‖K‖ + ‖C‖` with the largest row sums of the matrices over the masses.
    fn fastest(&self, normal: f64, pressed: bool) -> f64 {
        let weight = self.total.value() * normal;
        let mut k = self.spring.value() + self.curvature.value() * weight;
        let mut c = self.damper.value();
        match &self.friction {
            Friction::Constant(_) => {}
            Friction::Pieces(speeds, values, _) => {
                let slope =
                    |i: usize| ((values[i + 1] - values[i]) / (speeds[i + 1] - speeds[i])).abs();
                c += (0..speeds.len() - 1).map(|i| slope(i).value()).fold(0.0, f64::max) * weight;
            }
            Friction::Exponential([slow, fast, rate], _) => {
                c += ((*fast - *slow).abs() * *rate).value() * weight;
            }
            Friction::Series(surfaces, _) => {
                k += surfaces.iter().map(|x| x.curvature.value()).fold(0.0, f64::max) * weight;
            }
        }
        if let (Stop::Elastic { k: stop_k, c: stop_c }, true) = (self.stop, pressed) {
            k += stop_k.value();
            c += stop_c.value();
        }
        let norm = |matrix: &[Vec<Dd>], link: f64| {
            let row = |r: &Vec<Dd>| r.iter().fold(0.0, |sum, x| sum + x.abs().value());
            let column = |j: usize| matrix.iter().fold(ZERO, |sum, r| sum + r[j]).abs().value();
            let all: f64 = (0..self.frame.n).map(column).sum();
            let block = (link + all) / self.frame.block_kg.value();
            let rows = matrix.iter().zip(&self.frame.masses).map(|(r, m)| row(r) / m.value());
            block + rows.fold(0.0, f64::max)
        };
        norm(&self.frame.stiffness, k).sqrt() + norm(&self.frame.damping, c)
    }

    /// `σ φ` at which surface `i` slides in a direction; none at its end.
    fn threshold(&self, x: &State, i: usize, sign: i32) -> Option<Dd> {
        let Friction::Series(surfaces, _) = &self.friction else { return None };
        let along = x.u[i] * f64::from(sign);
        let free = surfaces[i].travel.is_none_or(|travel| along < travel);
        free.then(|| along * surfaces[i].curvature + surfaces[i].friction)
    }

    /// Least of these, and its slope over `s`.
    fn resistance(&self, x: &State, sign: i32) -> Option<(Dd, Dd)> {
        let Friction::Series(surfaces, _) = &self.friction else { return None };
        let active = || (0..surfaces.len()).filter(|&i| x.active[i]);
        let least = active().filter_map(|i| self.threshold(x, i, sign)).reduce(smaller)?;
        let radii = active().try_fold(ZERO, |sum, i| Some(sum + surfaces[i].radius?));
        Some((least, radii.map_or(ZERO, |radii| ONE / radii)))
    }

    /// What each surface takes of a displacement; flat ones take all.
    fn shares(&self, x: &State) -> Vec<Dd> {
        let Friction::Series(surfaces, _) = &self.friction else { return Vec::new() };
        let flat =
            surfaces.iter().zip(&x.active).filter(|(s, a)| **a && s.radius.is_none()).count();
        let radii = surfaces.iter().zip(&x.active).filter(|(_, a)| **a);
        let sum = radii.filter_map(|(s, _)| s.radius).fold(ZERO, |sum, r| sum + r);
        let share = |(s, a): (&Surface, &bool)| match (a, s.radius) {
            (false, _) => ZERO,
            (true, None) => ONE / Dd::from(flat as f64),
            (true, Some(_)) if flat > 0 => ZERO,
            (true, Some(radius)) => radius / sum,
        };
        surfaces.iter().zip(&x.active).map(share).collect()
    }

    /// Which surfaces slide in a direction.
    fn activate(&self, x: &mut State, sign: i32) {
        let count = x.u.len();
        let all: Vec<Option<Dd>> = (0..count).map(|i| self.threshold(x, i, sign)).collect();
        let Some(least) = all.iter().flatten().copied().reduce(smaller) else {
            x.active.fill(false);
            return;
        };
        for (active, threshold) in x.active.iter_mut().zip(&all) {
            *active = threshold.is_some_and(|t| (t - least).value() <= ALIKE);
        }
    }

    /// `s` where another surface joins or one comes to its end.
    fn next_level(&self, x: &State, sign: i32) -> Option<Dd> {
        let Friction::Series(surfaces, _) = &self.friction else { return None };
        let (held, slope) = self.resistance(x, sign)?;
        let shares = self.shares(x);
        let ahead = |i: usize| {
            if x.active[i] {
                let left = surfaces[i].travel? - x.u[i] * f64::from(sign);
                return (shares[i].sign() > 0).then(|| left / shares[i]);
            }
            let more = self.threshold(x, i, sign)? - held;
            (slope.sign() > 0).then(|| more / slope)
        };
        let least = (0..surfaces.len()).filter_map(ahead).reduce(smaller)?;
        Some(x.s + least * f64::from(sign))
    }

    /// The piece of the rate law at a speed.
    fn piece_of(&self, speed: Dd) -> usize {
        let Friction::Pieces(speeds, ..) = &self.friction else { return 0 };
        speeds.iter().filter(|knot| **knot <= speed).count().max(1) - 1
    }

    /// The line `at_rest + slope v` of a piece.
    fn line(&self, piece: usize) -> [Dd; 2] {
        let Friction::Pieces(speeds, values, _) = &self.friction else { return [ZERO; 2] };
        if piece + 1 == speeds.len() {
            return [values[piece], ZERO];
        }
        let slope = (values[piece + 1] - values[piece]) / (speeds[piece + 1] - speeds[piece]);
        [values[piece] - slope * speeds[piece], slope]
    }

    /// What holds the slider: `−T / N` at the bounds towards −x and +x; none where nothing gives way.
    fn holds(&self, x: &State) -> [Option<Dd>; 2] {
        let mut holds = match &self.friction {
            Friction::Series(surfaces, ratio) => {
                let bound = |sign: i32| {
                    let of = |i: usize| {
                        self.threshold(x, i, sign)?;
                        let along = x.u[i] * f64::from(sign);
                        Some(along * surfaces[i].curvature + *ratio * surfaces[i].friction)
                    };
                    let least = (0..surfaces.len()).filter_map(of).reduce(smaller);
                    least.map(|least| least * f64::from(sign))
                };
                [bound(-1), bound(1)]
            }
            _ => [Some(-self.fixed[1]), Some(self.fixed[0])],
        };
        if matches!(self.stop, Stop::Rigid { .. }) {
            for sign in [1, -1] {
                if self.places[side(sign)] == Some(x.s) {
                    holds[1 - side(sign)] = None;
                }
            }
        }
        holds
    }

    fn series(&self, x: &State, load: Load, h: Dd) -> Series {
        let (n, count) = (self.frame.n, self.contents.len());
        let zero = [ZERO; DEGREE + 1];
        let mut p = Series {
            s: zero,
            w: zero,
            q: vec![zero; n],
            v: vec![zero; n],
            r: vec![zero; count],
            z: vec![zero; count],
            block: zero,
            floors: vec![zero; n],
            carried: vec![zero; count],
            fading: zero,
            ground: zero,
            friction: zero,
            stop: zero,
            shear: zero,
        };
        (p.s[0], p.w[0]) = (x.s, x.w);
        for i in 0..n {
            (p.q[i][0], p.v[i][0]) = (x.q[i], x.v[i]);
        }
        for e in 0..count {
            (p.r[e][0], p.z[e][0]) = (x.r[e], x.z[e]);
        }
        let sign = x.modes[0];
        let way = f64::from(sign);
        let mut masses = vec![self.frame.block_kg];
        masses.extend(&self.frame.masses);
        for (e, contents) in self.contents.iter().enumerate() {
            if x.modes[1 + e] == 0 {
                masses[contents.floor] += contents.mass;
            }
        }
        let inverses: Vec<Dd> = masses.iter().map(|m| ONE / *m).collect();
        let resistance = if sign == 0 { None } else { self.resistance(x, sign) };
        let line = self.line(x.piece);
        let places = self.places;
        let mut coefficient = zero;
        let mut reaction = vec![ZERO; n + 1];
        for k in 0..=DEGREE {
            let input = |pair: [Dd; 2]| if k < 2 { pair[k] } else { ZERO };
            let start = |c: Dd| if k == 0 { c } else { ZERO };
            let by_normal = |c: &Poly<Dd>| {
                let last = if k > 0 { load.normal[1] * c[k - 1] } else { ZERO };
                self.total * (load.normal[0] * c[k] + last)
            };
            reaction.fill(ZERO);
            for (e, contents) in self.contents.iter().enumerate() {
                let friction = contents.kinetic * input(load.normal) * f64::from(x.modes[1 + e]);
                if x.modes[1 + e] != 0 {
                    p.carried[e][k] = -friction;
                    reaction[contents.floor] += friction * contents.mass;
                }
            }
            let mut shear = ZERO;
            for i in 0..n {
                let mut force = ZERO;
                for j in 0..n {
                    force += self.frame.stiffness[i][j] * p.q[j][k];
                    force += self.frame.damping[i][j] * p.v[j][k];
                }
                p.floors[i][k] = (reaction[i + 1] - force) * inverses[i + 1];
                shear += force;
            }
            p.shear[k] = shear;
            if let (Stop::Elastic { k: stiffness, c: damper }, Contact::Pressed(at)) =
                (self.stop, x.contact)
            {
                let place = start(places[side(at)].unwrap_or(ZERO));
                p.stop[k] = stiffness * (p.s[k] - place) + damper * p.w[k];
            }
            let pendulum = by_normal(&p.s) * self.curvature;
            let springs = self.spring * p.s[k] + self.damper * p.w[k] + p.stop[k] + pendulum;
            if sign == 0 {
                p.block[k] = input(load.b);
                p.ground[k] = masses[0] * p.block[k] - shear - reaction[0];
                p.friction[k] = p.ground[k] + springs;
            } else {
                match &self.friction {
                    Friction::Constant(kinetic) => {
                        coefficient[k] = start(kinetic[side(sign)] * way)
                    }
                    Friction::Pieces(_, _, factors) => {
                        let at = start(line[0]) + line[1] * p.w[k] * way;
                        coefficient[k] = at * factors[side(sign)] * way;
                    }
                    Friction::Exponential([slow, fast, rate], factors) => {
                        p.fading[k] = if k == 0 {
                            exp(-(*rate * p.w[0] * way))
                        } else {
                            let mut sum = ZERO;
                            for j in 0..k {
                                sum += p.w[j + 1] * ((j + 1) as f64) * p.fading[k - 1 - j];
                            }
                            -(*rate * sum * way) / Dd::from(k as f64)
                        };
                        let at = start(*fast) - (*fast - *slow) * p.fading[k];
                        coefficient[k] = at * factors[side(sign)] * way;
                    }
                    Friction::Series(..) => {
                        let (least, slope) = resistance.unwrap_or((ZERO, ZERO));
                        coefficient[k] = start(least * way - slope * x.s) + slope * p.s[k];
                    }
                }
                p.friction[k] = -by_normal(&coefficient);
                p.ground[k] = p.friction[k] - springs;
                p.block[k] = (p.ground[k] + shear + reaction[0]) * inverses[0];
            }
            let floor = |p: &Series, floor: usize| match floor {
                0 => p.block[k],
                floor => p.floors[floor - 1][k],
            };
            for (e, contents) in self.contents.iter().enumerate() {
                if x.modes[1 + e] == 0 {
                    p.carried[e][k] = floor(&p, contents.floor);
                }
            }
            if k == DEGREE {
                break;
            }
            let step = h / Dd::from((k + 1) as f64);
            if sign != 0 {
                p.s[k + 1] = p.w[k] * step;
                p.w[k + 1] = (p.block[k] - input(load.b)) * step;
            }
            for i in 0..n {
                p.q[i][k + 1] = p.v[i][k] * step;
                p.v[i][k + 1] = (p.floors[i][k] - p.block[k]) * step;
            }
            for (e, contents) in self.contents.iter().enumerate() {
                if x.modes[1 + e] != 0 {
                    p.r[e][k + 1] = p.z[e][k] * step;
                    p.z[e][k + 1] = (p.carried[e][k] - floor(&p, contents.floor)) * step;
                }
            }
        }
        p
    }
}

/// The response of a model to a ground motion; none where contact with the ground is lost.
pub fn reference(model: &Model, motion: &GroundMotion) -> Option<Reference> {
    let body = Body::new(model, motion);
    let dd = |values: Vec<f64>| values.into_iter().map(Dd::from).collect::<Vec<_>>();
    let initial = model.initial();
    let (n, count) = (body.frame.n, body.contents.len());
    let surfaces = match &body.friction {
        Friction::Series(surfaces, _) => surfaces.len(),
        _ => 0,
    };
    let mut x = State {
        s: Dd::from(initial.sliding_displacement_m),
        w: Dd::from(initial.sliding_velocity_m_per_s),
        q: dd(model.initial_storey_displacement_m()),
        v: dd(model.initial_storey_velocity_m_per_s()),
        r: vec![ZERO; count],
        z: vec![ZERO; count],
        u: vec![ZERO; surfaces],
        active: vec![false; surfaces],
        modes: vec![0; 1 + count],
        contact: Contact::Free,
        piece: 0,
    };
    assert!(x.s == ZERO, "the reference with devices starts where springs are unstressed");
    x.modes[0] = x.w.sign();
    if x.w != ZERO {
        x.piece = body.piece_of(x.w.abs());
        let sign = x.w.sign();
        body.activate(&mut x, sign);
    }
    let mut out = Reference {
        path: vec![0.0; 1 + count],
        sliding_time_s: vec![0.0; 1 + count],
        ..Reference::default()
    };
    for list in [&mut out.peaks.q, &mut out.peaks.v, &mut out.peaks.drift, &mut out.peaks.floors] {
        list.resize(n, 0.0);
    }
    out.peaks.contents.resize(count, [0.0; 3]);
    out.peaks.surfaces.resize(surfaces, 0.0);
    let mut run = Run {
        still: vec![false; 1 + count],
        reached: Vec::new(),
        jumps: false,
        forces: 0.0,
        turn: None,
        body,
        x,
        out,
    };
    let times = motion.times_s();
    let slope = run.body.frame.slope;
    let at_sample = |i: usize| {
        let vertical = motion.vertical_m_per_s2().map_or(0.0, |v| v[i]);
        let normal = Dd::from(vertical) + run.body.frame.normal_gravity;
        [Dd::from(motion.horizontal_m_per_s2()[i]) + slope, normal]
    };
    let samples: Vec<[Dd; 2]> = (0..times.len()).map(at_sample).collect();
    if samples.iter().any(|[_, normal]| normal.sign() <= 0) {
        return None;
    }
    run.sample(times[0]);
    run.walk_jump(Dd::from(times[0]), [slope, run.body.frame.normal_gravity], samples[0]);
    for i in 1..times.len() {
        let [t0, t1] = [i - 1, i].map(|j| Dd::from(times[j]));
        if t0 == t1 {
            run.walk_jump(t0, samples[i - 1], samples[i]);
            run.sample(times[i]);
            continue;
        }
        run.cross(t0, t1 - t0, Load::between(samples[i - 1], samples[i]));
        if run.out.end_of_travel_s.is_some() {
            break;
        }
        run.sample(times[i]);
    }
    Some(run.out)
}

struct Run {
    body: Body,
    x: State,
    /// Interfaces that slid and have come to have no velocity.
    still: Vec<bool>,
    /// Stuck ones that have reached their bounds, and the signs with which they slide there.
    reached: Vec<(usize, i32)>,
    /// Whether a jump is walked.
    jumps: bool,
    /// Largest force so far.
    forces: f64,
    /// The slider's last event, if it is a reversal since the last impact.
    turn: Option<usize>,
    out: Reference,
}

impl Run {
    /// A jump: a ramp so short that nothing moves, and 100 000 times as long after it, in which what
    /// was only let go meanwhile stops again. What slides then has reached its bound.
    fn walk_jump(&mut self, time: Dd, from: [Dd; 2], to: [Dd; 2]) {
        let (x, still, out) = (self.x.clone(), self.still.clone(), self.out.clone());
        self.jumps = true;
        self.cross(time, Dd::from(JUMP_S), Load::between(from, to));
        self.cross(time, Dd::from(1e5 * JUMP_S), Load::between(to, to));
        self.jumps = false;
        let after = std::mem::replace(&mut self.x, x);
        let slides = |&i: &usize| {
            (self.x.modes[i] == 0 || still[i]) && after.modes[i] != 0 && !self.still[i]
        };
        self.reached = (0..still.len()).filter(slides).map(|i| (i, after.modes[i])).collect();
        (self.still, self.out) = (still, out);
    }

    /// Goes through the interval between two samples.
    fn cross(&mut self, start: Dd, length: Dd, load: Load) {
        let mut at = ZERO;
        let mut stalls = 0;
        while at < ONE && self.out.end_of_travel_s.is_none() {
            let rate = self.body.rates[usize::from(matches!(self.x.contact, Contact::Pressed(_)))];
            let most = Dd::from(RATE_TIMES_STEP / (rate * length.value()).max(1e-9));
            let left = ONE - at;
            let part = smaller(left, most);
            let whole = part == left;
            let part_of = |pair: [Dd; 2]| [pair[0] + pair[1] * at, pair[1] * part];
            let here = Load { b: part_of(load.b), normal: part_of(load.normal) };
            let time_s = (start + length * at).value();
            let to = self.step(here, length * part, time_s);
            let next = if to == ONE && whole { ONE } else { at + part * to };
            stalls = if (next - at).value() > 1e-25 { 0 } else { stalls + 1 };
            assert!(stalls < 40, "the reference makes no progress at {time_s} s");
            at = next;
        }
    }

    /// Goes on to the next event, at most over `h` seconds; the part of these that it took.
    fn step(&mut self, load: Load, h: Dd, time_s: f64) -> Dd {
        let decides = self.x.modes.contains(&0) || self.still.contains(&true);
        let mut series =
            if decides { self.decide(load, h, time_s) } else { self.body.series(&self.x, load, h) };
        if self.x.modes[0] != 0 && !self.x.u.is_empty() && !self.x.active.contains(&true) {
            self.out.end_of_travel_s = Some(time_s);
            return ONE;
        }
        let mut to = ONE;
        let (mut load, mut h) = (load, h);
        if let Some(part) = serves(&series) {
            to = part;
            series.cut(part);
            h = h * part;
            load = load_up_to(load, part);
        }
        let mut first: Option<(Dd, Vec<Hit>)> = None;
        for (p, noise, hit) in self.hits(&series, load, h) {
            let Some(root) = first_root(&p, noise) else { continue };
            match &mut first {
                Some((at, _)) if (root - *at).value() > 1e-24 => {}
                Some((at, hits)) if (*at - root).value() <= 1e-24 => hits.push(hit),
                _ => first = Some((root, vec![hit])),
            }
        }
        let (root, hits) = first.unwrap_or((ONE, Vec::new()));
        if !hits.is_empty() {
            series.cut(root);
            h = h * root;
            load = load_up_to(load, root);
            to = to * root;
        }
        let noises = self.velocity_noises(&series, load, h);
        self.record(&series, h, load);
        let at = |p: &Poly<Dd>| value(p, ONE);
        let moved = at(&series.s) - self.x.s;
        let shares = self.body.shares(&self.x);
        for (u, share) in self.x.u.iter_mut().zip(shares) {
            *u += share * moved;
        }
        (self.x.s, self.x.w) = (at(&series.s), at(&series.w));
        for (to, from) in [
            (&mut self.x.q, &series.q),
            (&mut self.x.v, &series.v),
            (&mut self.x.r, &series.r),
            (&mut self.x.z, &series.z),
        ] {
            *to = from.iter().map(at).collect();
        }
        for i in 0..self.x.modes.len() {
            let v = self.velocity(i);
            if self.x.modes[i] != 0 && v.value().abs() <= noises[i] {
                self.stop_at(i);
            }
        }
        for hit in hits {
            self.apply(hit, load_after(load), time_s + h.value());
        }
        for (peak, u) in self.out.peaks.surfaces.iter_mut().zip(&self.x.u) {
            *peak = peak.max(u.value().abs());
        }
        to
    }

    fn velocity(&self, interface: usize) -> Dd {
        if interface == 0 { self.x.w } else { self.x.z[interface - 1] }
    }

    fn stop_at(&mut self, interface: usize) {
        self.still[interface] = true;
        if interface == 0 {
            self.x.w = ZERO;
        } else {
            self.x.z[interface - 1] = ZERO;
        }
    }

    /// What of the velocities is rounding.
    fn velocity_noises(&self, p: &Series, load: Load, h: Dd) -> Vec<f64> {
        let b = load.b[0].value().abs();
        let forces = size(&p.ground) + size(&p.shear) + size(&p.friction) + size(&p.stop);
        let gain = h.value() * (forces.max(self.forces) / self.body.frame.block_kg.value() + b);
        // Within a jump velocities are as small as it is short.
        let largest = |peak: f64| if self.jumps { 0.0 } else { peak };
        let mut list = vec![NOISE * size(&p.w).max(largest(self.out.peaks.w)).max(gain)];
        for (e, contents) in self.body.contents.iter().enumerate() {
            let floor = match contents.floor {
                0 => size(&p.block),
                floor => size(&p.floors[floor - 1]),
            };
            let gain = gain.max(h.value() * floor);
            let peak = largest(self.out.peaks.contents[e][1]);
            list.push(NOISE * size(&p.z[e]).max(peak).max(gain));
        }
        list
    }

    /// What is left of the bounds of a stuck interface against sliding towards −x and +x, and the
    /// noise of it; none where it cannot.
    fn bounds(&self, p: &Series, load: Load, interface: usize) -> [Option<(Poly<Dd>, f64)>; 2] {
        if interface > 0 {
            let contents = &self.body.contents[interface - 1];
            let demand = p.carried[interface - 1];
            return [1, -1].map(|push| {
                let mut left = signed(&demand, -push);
                left[0] += contents.fixed * load.normal[0];
                left[1] += contents.fixed * load.normal[1];
                let structure = size(&p.shear) / self.body.frame.block_kg.value();
                let terms =
                    size(&demand) + structure + contents.fixed.value() * load.normal[0].value();
                Some((left, NOISE * terms))
            });
        }
        let holds = self.body.holds(&self.x);
        let springs = size(&p.stop) + (self.body.spring * p.s[0]).value().abs();
        let b = (self.body.frame.block_kg * load.b[0]).value().abs();
        let terms = size(&p.friction) + size(&p.shear) + springs + b;
        // −T lies between the two holds.
        [-1, 1].map(|sign| {
            let bound = holds[usize::from(sign > 0)]? * self.body.total * f64::from(sign);
            let mut left = signed(&p.friction, sign);
            left[0] += bound * load.normal[0];
            left[1] += bound * load.normal[1];
            Some((left, NOISE * (terms + (bound * load.normal[0]).value().abs())))
        })
    }

    /// At rest at a rigid stop: on which side, what the stop takes of a push, negative where friction
    /// takes all of it, and the noise of that.
    fn leaning(&self, p: &Series, load: Load) -> Option<(i32, Poly<Dd>, f64)> {
        let rigid = matches!(self.body.stop, Stop::Rigid { .. }) && self.x.modes[0] == 0;
        let at = [1, -1].into_iter().find(|&at| self.body.places[side(at)] == Some(self.x.s));
        let at = at.filter(|_| rigid)?;
        let off = State { s: self.x.s + ONE, ..self.x.clone() };
        let hold = self.body.holds(&off)[usize::from(at > 0)]? * self.body.total * f64::from(at);
        let mut push = signed(&p.friction, -at);
        push[0] = push[0] - hold * load.normal[0];
        push[1] = push[1] - hold * load.normal[1];
        let terms = size(&p.friction) + size(&p.shear) + (hold * load.normal[0]).value().abs();
        Some((at, push, NOISE * terms))
    }

    /// All that may end the step.
    fn hits(&self, p: &Series, load: Load, h: Dd) -> Vec<(Poly<Dd>, f64, Hit)> {
        let mut list = Vec::new();
        let x = &self.x;
        let noises = self.velocity_noises(p, load, h);
        for i in 0..x.modes.len() {
            if x.modes[i] != 0 {
                let velocity = if i == 0 { &p.w } else { &p.z[i - 1] };
                list.push((signed(velocity, x.modes[i]), noises[i], Hit::Still(i)));
            } else {
                for (sign, bound) in [-1, 1].into_iter().zip(self.bounds(p, load, i)) {
                    if let Some((left, noise)) = bound {
                        list.push((left, noise, Hit::Bound(i, sign)));
                    }
                }
            }
        }
        if let Some((_, push, noise)) = self.leaning(p, load) {
            list.push((push, noise, Hit::Lean));
        }
        let sign = x.modes[0];
        if sign == 0 {
            return list;
        }
        let away = |place: Dd, sign: i32| {
            let mut distance = signed(&p.s, sign);
            distance[0] = distance[0] - place * f64::from(sign);
            (distance, PLACE_NOISE * (size(&p.s) + place.value().abs()))
        };
        match self.body.stop {
            Stop::None => {}
            Stop::Rigid { .. } => {
                if let Some(place) = self.body.places[side(sign)] {
                    let (distance, noise) = away(place, -sign);
                    list.push((distance, noise, Hit::Impact));
                }
            }
            Stop::Elastic { k, c } => {
                let at = match x.contact {
                    Contact::Free => sign,
                    Contact::Pressed(at) | Contact::Separated(at) => at,
                };
                if let Some(place) = self.body.places[side(at)] {
                    let (depth, noise) = away(place, at);
                    let force = std::array::from_fn(|i| k * depth[i] + c * p.w[i] * f64::from(at));
                    let force_noise = k.value() * noise + c.value() * noises[0];
                    match x.contact {
                        Contact::Free => {
                            let to = Contact::Pressed(at);
                            list.push((signed(&depth, -1), noise, Hit::Contact(to)));
                        }
                        Contact::Pressed(_) if sign == at => {}
                        Contact::Pressed(_) if c == ZERO => {
                            list.push((depth, noise, Hit::Contact(Contact::Free)));
                        }
                        Contact::Pressed(_) => {
                            let to = Contact::Separated(at);
                            list.push((force, force_noise, Hit::Contact(to)));
                        }
                        Contact::Separated(_) => {
                            list.push((depth, noise, Hit::Contact(Contact::Free)));
                            let to = Contact::Pressed(at);
                            list.push((signed(&force, -1), force_noise, Hit::Contact(to)));
                        }
                    }
                }
            }
        }
        if let Friction::Pieces(speeds, ..) = &self.body.friction {
            let beyond = |knot: Dd, way: i32| {
                let mut left = signed(&p.w, -sign * way);
                left[0] += knot * f64::from(way);
                left
            };
            let noise = |knot: Dd| NOISE * (size(&p.w) + knot.value());
            if let Some(&knot) = speeds.get(x.piece + 1) {
                list.push((beyond(knot, 1), noise(knot), Hit::Knot(x.piece + 1, knot)));
            }
            if x.piece > 0 {
                let knot = speeds[x.piece];
                list.push((beyond(knot, -1), noise(knot), Hit::Knot(x.piece - 1, knot)));
            }
        }
        // At a rigid stop the impact decides what slides on.
        let at_stop = |level: &Dd| {
            let rigid = matches!(self.body.stop, Stop::Rigid { .. });
            let near = |place: Dd| (place - *level).value().abs() <= ALIKE;
            rigid && self.body.places[side(sign)].is_some_and(near)
        };
        if let Some(level) = self.body.next_level(x, sign).filter(|level| !at_stop(level)) {
            let (distance, noise) = away(level, -sign);
            list.push((distance, noise, Hit::Level(level)));
        }
        list
    }

    fn apply(&mut self, hit: Hit, load: Load, time_s: f64) {
        let sign = self.x.modes[0];
        match hit {
            Hit::Still(interface) => self.stop_at(interface),
            Hit::Bound(interface, sign) => self.reached.push((interface, sign)),
            Hit::Lean => {}
            Hit::Contact(to) => {
                let from = std::mem::replace(&mut self.x.contact, to);
                let kind = match (from, to) {
                    (Contact::Free, _) => EventKind::Contact,
                    (_, Contact::Pressed(_)) => EventKind::Press,
                    (_, Contact::Separated(_)) => EventKind::Separation,
                    (_, Contact::Free) => EventKind::Leave,
                };
                let place = match (from, to) {
                    (Contact::Free, Contact::Pressed(at)) => self.body.places[side(at)],
                    (Contact::Pressed(at) | Contact::Separated(at), Contact::Free) => {
                        self.body.places[side(at)]
                    }
                    _ => None,
                };
                self.x.s = place.unwrap_or(self.x.s);
                if kind == EventKind::Contact {
                    let speed = self.x.w.value().abs();
                    self.out.impact_speed = self.out.impact_speed.max(speed);
                }
                self.tell(time_s, 0, kind);
            }
            Hit::Impact => self.strike(load, time_s),
            Hit::Knot(piece, speed) => {
                self.x.piece = piece;
                self.x.w = speed * f64::from(sign);
            }
            Hit::Level(level) => {
                self.x.s = level;
                if let Friction::Series(surfaces, _) = &self.body.friction {
                    for (u, surface) in self.x.u.iter_mut().zip(surfaces) {
                        if let Some(travel) = surface.travel
                            && (*u * f64::from(sign) - travel).value().abs() <= ALIKE
                        {
                            *u = travel * f64::from(sign);
                        }
                    }
                }
                self.body.activate(&mut self.x, sign);
                self.tell(time_s, 0, EventKind::Surface);
            }
        }
    }

    /// `ṡ⁺ = −e ṡ⁻`; what does not touch the stop keeps its absolute velocity.
    fn strike(&mut self, load: Load, time_s: f64) {
        let Stop::Rigid { e } = self.body.stop else { return };
        let sign = self.x.modes[0];
        self.x.s = self.body.places[side(sign)].unwrap_or(self.x.s);
        let before = self.x.w;
        let speed = before.value().abs();
        let fast = speed >= LISTED_IMPACT_M_PER_S;
        // A bounce that is not listed has no turn either.
        let turn = self.turn.take();
        if let (false, Some(turn)) = (fast, turn) {
            self.out.events.remove(turn);
        }
        self.out.impact_speed = self.out.impact_speed.max(speed);
        let after = -(e * before);
        self.jump(before - after, time_s);
        self.x.w = after;
        if after == ZERO {
            self.rest(time_s);
            return;
        }
        self.x.modes[0] = -sign;
        self.still[0] = false;
        self.x.piece = self.body.piece_of(after.abs());
        self.body.activate(&mut self.x, -sign);
        if fast {
            self.tell(time_s, 0, EventKind::Impact);
        }
        if self.bounces_end(load, sign, e) {
            self.jump(after, time_s);
            self.x.w = ZERO;
            self.rest(time_s);
        }
    }

    /// Floors and what stands on the block gain a velocity relative to the block.
    fn jump(&mut self, change: Dd, time_s: f64) {
        for v in &mut self.x.v {
            *v += change;
        }
        for e in 0..self.x.z.len() {
            if self.body.contents[e].floor != 0 {
                continue;
            }
            self.x.z[e] += change;
            let (was, now) = (self.x.modes[1 + e], self.x.z[e].sign());
            if now == 0 || now == was {
                continue;
            }
            self.x.modes[1 + e] = now;
            self.still[1 + e] = false;
            let kind = if was == 0 { EventKind::Slip } else { EventKind::Reversal };
            self.tell(time_s, 1 + e, kind);
        }
    }

    fn rest(&mut self, time_s: f64) {
        self.x.modes[0] = 0;
        self.still[0] = false;
        self.tell(time_s, 0, EventKind::Rest);
    }

    /// Whether the block cannot stay off the stop, and infinitely many bounces take no time:
    /// `T∞ = (ẇ⁺/Q)(1 + √(Q/P))/(1 − e√(P/Q))`.
    fn bounces_end(&self, load: Load, sign: i32, e: Dd) -> bool {
        let speed = self.x.w.value().abs();
        let at_rest = |mode: i32| {
            let mut x = self.x.clone();
            x.w = ZERO;
            x.piece = 0;
            x.modes[0] = mode;
            if mode != 0 {
                self.body.activate(&mut x, mode);
            }
            self.body.series(&x, load, ONE)
        };
        let push = |mode: i32| at_rest(mode).w[1].value() * f64::from(sign);
        let (p, q) = (push(sign), push(-sign));
        if !(p > 0.0 && q > 0.0) {
            return false;
        }
        let r = e.value() * (p / q).sqrt();
        if r >= 1.0 || speed / q * (1.0 + (q / p).sqrt()) / (1.0 - r) > LAST_BOUNCES_S {
            return false;
        }
        let off = State { s: self.x.s + Dd::from(1.0), ..self.x.clone() };
        let Some(hold) = self.body.holds(&off)[usize::from(sign > 0)] else { return true };
        let demand = -at_rest(0).friction[0] * f64::from(sign);
        (demand - hold * self.body.total * load.normal[0] * f64::from(sign)).sign() > 0
    }

    /// Decides which interfaces without velocity stick, and which way the others slide: of all
    /// combinations the one that is possible in which most stick, the slider first. What has reached its
    /// bound slides, if that is possible.
    fn decide(&mut self, load: Load, h: Dd, time_s: f64) -> Series {
        let before = self.x.modes.clone();
        let reached = std::mem::take(&mut self.reached);
        let count = before.len();
        let free: Vec<usize> = (0..count).filter(|&i| before[i] == 0 || self.still[i]).collect();
        let slid = before[0] != 0 && self.still[0];
        for &i in &free {
            self.x.modes[i] = 0;
            self.still[i] = false;
        }
        let held = self.x.clone();
        let series = self.body.series(&held, load, h);
        let is_due = !reached.is_empty() || held.modes != before;
        if !is_due && free.iter().all(|&i| self.exceeded(&series, load, i).is_none()) {
            return series;
        }
        let chosen = self.most_sticking(&held, &free, &reached, (load, h));
        let chosen = chosen.or_else(|| self.most_sticking(&held, &free, &[], (load, h)));
        self.x = chosen.unwrap_or_else(|| {
            panic!("nothing is possible at {time_s} s: {before:?} {free:?} {reached:?}")
        });
        if self.x.modes[0] == 0 && slid && matches!(self.body.stop, Stop::Rigid { .. }) {
            // Within the rounding of s off the stop the block is at it.
            for place in self.body.places.into_iter().flatten() {
                if (self.x.s - place).value().abs() <= 8.0 * f64::EPSILON * place.value().abs() {
                    self.x.s = place;
                }
            }
        }
        self.tell_changes(&before, time_s);
        self.body.series(&self.x, load, h)
    }

    fn tell_changes(&mut self, before: &[i32], time_s: f64) {
        for i in 0..before.len() {
            let kind = match (before[i], self.x.modes[i]) {
                (a, b) if a == b => continue,
                (0, _) => EventKind::Slip,
                (_, 0) => EventKind::Stick,
                _ => EventKind::Reversal,
            };
            self.tell(time_s, i, kind);
        }
    }

    /// The state with `free` interfaces decided, where some have `reached` their bounds.
    fn most_sticking(
        &mut self,
        held: &State,
        free: &[usize],
        reached: &[(usize, i32)],
        (load, h): (Load, Dd),
    ) -> Option<State> {
        let mut best: Option<(usize, State)> = None;
        for number in 0..3_usize.pow(free.len() as u32) {
            self.x = held.clone();
            let mut digits = number;
            for &i in free {
                self.x.modes[i] = [0, -1, 1][digits % 3];
                digits /= 3;
            }
            if reached.iter().any(|&(i, sign)| self.x.modes[i] != sign) {
                continue;
            }
            self.set_out();
            let sticking = self.x.modes.iter().filter(|mode| **mode == 0).count();
            // The slider sticks first: it is the fastest digit.
            let larger = best.as_ref().is_none_or(|(most, state)| {
                (sticking, self.x.modes[0] == 0) > (*most, state.modes[0] == 0)
            });
            if larger && self.is_possible(free, reached, (load, h)) {
                best = Some((sticking, self.x.clone()));
            }
        }
        best.map(|(_, state)| state)
    }

    /// What slides where the slider starts from rest.
    fn set_out(&mut self) {
        let sign = self.x.modes[0];
        if sign != 0 && self.x.w == ZERO {
            self.x.piece = 0;
            self.body.activate(&mut self.x, sign);
        }
    }

    /// Whether each `free` interface that sticks is within its bound, and each that slides moves off and
    /// could not be held.
    fn is_possible(
        &mut self,
        free: &[usize],
        reached: &[(usize, i32)],
        (load, h): (Load, Dd),
    ) -> bool {
        let series = self.body.series(&self.x, load, h);
        let noises = self.velocity_noises(&series, load, h);
        free.iter().all(|&i| {
            let mode = self.x.modes[i];
            if mode == 0 {
                return self.exceeded(&series, load, i).is_none();
            }
            let velocity = if i == 0 { &series.w } else { &series.z[i - 1] };
            if leading(velocity, noises[i]).is_none_or(|(_, sign)| sign != mode) {
                return false;
            }
            if reached.contains(&(i, mode)) {
                return true;
            }
            let mut held = self.x.clone();
            held.modes[i] = 0;
            self.exceeded(&self.body.series(&held, load, h), load, i) == Some(mode)
        })
    }

    /// The sign with which a stuck interface would slide, where it is beyond its bound.
    fn exceeded(&self, series: &Series, load: Load, interface: usize) -> Option<i32> {
        let bounds = self.bounds(series, load, interface);
        [-1, 1].into_iter().zip(bounds).find_map(|(sign, bound)| {
            let (left, noise) = bound?;
            leading(&left, noise).is_some_and(|(_, sign)| sign < 0).then_some(sign)
        })
    }

    fn tell(&mut self, time_s: f64, interface: usize, kind: EventKind) {
        if interface == 0 {
            self.turn = (kind == EventKind::Reversal).then_some(self.out.events.len());
        }
        let sign = self.x.modes[interface];
        self.out.events.push(Event { time_s, interface, kind, sign });
    }

    /// Peaks, paths and times over a step of `h` seconds.
    fn record(&mut self, p: &Series, h: Dd, load: Load) {
        let leaning = self.leaning(p, load);
        let (body, peaks) = (&self.body, &mut self.out.peaks);
        let slope = body.frame.slope;
        let grow = |peak: &mut f64, p: Poly<f64>| *peak = largest(&p, *peak);
        let less = |p: &Poly<Dd>| {
            let mut p = *p;
            p[0] = p[0] - slope;
            rounded(&p)
        };
        grow(&mut peaks.s, rounded(&p.s));
        grow(&mut peaks.w, rounded(&p.w));
        grow(&mut peaks.block, less(&p.block));
        grow(&mut peaks.slider, rounded(&p.ground));
        grow(&mut peaks.shear, rounded(&p.shear));
        let mut friction = p.friction;
        // At rest at a rigid stop friction takes what it can, the stop the remainder.
        if let Some((at, push, _)) = leaning
            && value(&push, ONE.half()).sign() > 0
        {
            grow(&mut peaks.stop, rounded(&push));
            for (friction, push) in friction.iter_mut().zip(&push) {
                *friction += *push * f64::from(at);
            }
        }
        grow(&mut peaks.friction, rounded(&friction));
        grow(&mut peaks.stop, rounded(&p.stop));
        self.forces = self.forces.max(size(&p.ground));
        for i in 0..body.frame.n {
            let below = |k: usize| if i == 0 { ZERO } else { p.q[i - 1][k] };
            grow(&mut peaks.q[i], rounded(&p.q[i]));
            grow(&mut peaks.v[i], rounded(&p.v[i]));
            grow(&mut peaks.drift[i], std::array::from_fn(|k| (p.q[i][k] - below(k)).value()));
            grow(&mut peaks.floors[i], less(&p.floors[i]));
        }
        for (e, [r, z, a]) in peaks.contents.iter_mut().enumerate() {
            grow(r, rounded(&p.r[e]));
            grow(z, rounded(&p.z[e]));
            grow(a, less(&p.carried[e]));
        }
        let h = h.value();
        if leaning.is_some() || matches!(self.x.contact, Contact::Pressed(_)) {
            self.out.contact_time_s += h;
        }
        for i in 0..self.x.modes.len() {
            if self.x.modes[i] != 0 {
                let place = if i == 0 { &p.s } else { &p.r[i - 1] };
                self.out.path[i] += (value(place, ONE) - place[0]).value().abs();
                self.out.sliding_time_s[i] += h;
            }
        }
    }

    fn sample(&mut self, time_s: f64) {
        let x = &self.x;
        let lists = [&x.q, &x.v, &x.r, &x.z, &x.u];
        let all = [&x.s, &x.w].into_iter().chain(lists.into_iter().flatten());
        let values = all.map(|x| x.value()).collect();
        self.out.samples.push(Sample { time_s, values });
    }
}

/// The part of a step over which a series with friction that fades is exact, where that is not all.
fn serves(p: &Series) -> Option<Dd> {
    if p.fading[0] == ZERO {
        return None;
    }
    let mut part = 1.0_f64;
    for list in [&p.fading, &p.w, &p.s] {
        let largest = size(list);
        for k in [DEGREE - 1, DEGREE] {
            let last = list[k].value().abs();
            if last > LAST_TERMS * largest {
                part = part.min(libm::pow(LAST_TERMS * largest / last, 1.0 / k as f64));
            }
        }
    }
    (part < 1.0).then(|| Dd::from(part))
}

/// The load over the first part of a step.
fn load_up_to(load: Load, part: Dd) -> Load {
    let cut = |pair: [Dd; 2]| [pair[0], pair[1] * part];
    Load { b: cut(load.b), normal: cut(load.normal) }
}

/// The load at the end of a step, as that of a step of no length.
fn load_after(load: Load) -> Load {
    let end = |pair: [Dd; 2]| [pair[0] + pair[1], ZERO];
    Load { b: end(load.b), normal: end(load.normal) }
}
