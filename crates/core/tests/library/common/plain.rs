//! The plain reference: slow, short, and independent of the solver.
//!
//! Physical coordinates, double-double numbers, Taylor series of degree 22 over steps so short that
//! their remainder is below 1e-26; events isolated by the signs of Bernstein coefficients; peaks by
//! bisection with Bernstein bounds. At 32 digits the reference needs no tolerance of its own: what
//! is below 1e-26 of its terms is zero, and a difference of doubles never is.

use slipstick::model::Model;
use slipstick::motion::GroundMotion;
use slipstick::response::{EventKind, Mode};
use slipstick::slider::Direction;

use super::bernstein::{DEGREE, Poly, first_root, largest, leading, rounded, value};
use super::dd::{Dd, ONE, ZERO};
use super::system::{Load, Series, State, System};

/// Part of its terms below which a number is rounding.
const NOISE: f64 = 1e-26;
/// Rate of the fastest motion times the step: 0.6^23 / 23! is 3e-28.
const RATE_TIMES_STEP: f64 = 0.6;

/// What the reference says about a sample; accelerations and mode are limits from the left.
#[derive(Clone, Debug)]
pub struct Sample {
    pub time_s: f64,
    pub mode: Mode,
    pub s: f64,
    pub w: f64,
    pub q: Vec<f64>,
    pub v: Vec<f64>,
    pub block: f64,
    pub floors: Vec<f64>,
}

/// An event, and how clear the decision was.
#[derive(Clone, Copy, Debug)]
pub struct Event {
    pub time_s: f64,
    pub kind: EventKind,
    pub mode: Mode,
    pub s: f64,
    /// At a stop (1 − |demand|/bound), positive if the block sticks; 0 at other events.
    pub margin: f64,
    /// At a stop: depth of the parabola through zero that the sliding velocity would follow if it
    /// went on, over the largest sliding velocity of the slip; a grazing stop has almost none.
    pub dip: f64,
}

/// A local minimum of the sliding speed inside a slip.
#[derive(Clone, Copy, Debug)]
pub struct Dip {
    pub time_s: f64,
    /// Over the largest speed of the slip so far.
    pub depth: f64,
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
    pub q: Vec<f64>,
    pub v: Vec<f64>,
    pub drift: Vec<f64>,
    pub floors: Vec<f64>,
}

/// A response.
#[derive(Clone, Debug, Default)]
pub struct Reference {
    pub events: Vec<Event>,
    pub dips: Vec<Dip>,
    pub samples: Vec<Sample>,
    pub peaks: Peaks,
    pub path: f64,
    pub sliding_time_s: f64,
    pub contact_loss_s: Vec<[f64; 2]>,
}

impl Reference {
    /// The mode after what happens at t = 0.
    pub fn initial_mode(&self) -> Mode {
        let at_once = self.events.iter().take_while(|e| e.time_s == 0.0);
        at_once.last().map_or(self.samples[0].mode, |e| e.mode)
    }
}

/// A stretch over which the table's accelerations are linear and contact holds or not.
struct Piece {
    start: Dd,
    length: Dd,
    load: Load,
    contact: bool,
}

/// The response of a model to a ground motion.
pub fn reference(model: &Model, motion: &GroundMotion) -> Reference {
    let system = System::new(model);
    let dd = |values: Vec<f64>| values.into_iter().map(Dd::from).collect::<Vec<_>>();
    let initial = model.initial();
    let state = State {
        s: Dd::from(initial.sliding_displacement_m),
        w: Dd::from(initial.sliding_velocity_m_per_s),
        q: dd(model.initial_storey_displacement_m()),
        v: dd(model.initial_storey_velocity_m_per_s()),
    };
    let n = system.n;
    let mut run = Run {
        sign: state.w.sign(),
        fresh: false,
        slip: Slip::default(),
        system,
        state,
        out: Reference::default(),
    };
    for list in [
        &mut run.out.peaks.q,
        &mut run.out.peaks.v,
        &mut run.out.peaks.drift,
        &mut run.out.peaks.floors,
    ] {
        list.resize(n, 0.0);
    }
    let times = motion.times_s();
    run.sample(times[0], None);
    for i in 1..times.len() {
        let mut last = None;
        for piece in pieces(&run.system, motion, i) {
            last = Some(run.cross(&piece));
        }
        run.sample(times[i], last.as_ref());
    }
    run.out
}

/// The interval before sample `i`, cut where contact is lost or made; nothing for a jump.
fn pieces(system: &System, motion: &GroundMotion, i: usize) -> Vec<Piece> {
    let [t0, t1] = [i - 1, i].map(|j| Dd::from(motion.times_s()[j]));
    if t0 == t1 {
        return Vec::new();
    }
    let b = [i - 1, i].map(|j| Dd::from(motion.horizontal_m_per_s2()[j]) + system.slope);
    let normal = [i - 1, i].map(|j| {
        let vertical = motion.vertical_m_per_s2().map_or(0.0, |v| v[j]);
        Dd::from(vertical) + system.normal_gravity
    });
    let crosses = normal[0].sign() * normal[1].sign() < 0;
    let mut cuts = vec![ZERO, ONE];
    if crosses {
        cuts.insert(1, normal[0] / (normal[0] - normal[1]));
    }
    let whole = t1 - t0;
    let at = |pair: [Dd; 2], x: Dd| pair[0] + (pair[1] - pair[0]) * x;
    cuts.windows(2)
        .map(|cut| {
            let (from, to) = (cut[0], cut[1]);
            let part = |pair: [Dd; 2]| [at(pair, from), (pair[1] - pair[0]) * (to - from)];
            let contact = at(normal, (from + to).half()).sign() > 0;
            let normal = if contact { part(normal) } else { [ZERO; 2] };
            Piece {
                start: t0 + whole * from,
                length: whole * (to - from),
                load: Load { b: part(b), normal },
                contact,
            }
        })
        .collect()
}

/// What is known of the slip under way.
#[derive(Default)]
struct Slip {
    peak: f64,
    /// Sign of sgn(ṡ) s̈ at the end of the last step.
    trend: i32,
}

struct Run {
    system: System,
    state: State,
    /// Sign of the sliding velocity; 0 in stick.
    sign: i32,
    /// The slip starts here: ṡ = 0 has been decided.
    fresh: bool,
    slip: Slip,
    out: Reference,
}

/// Largest coefficient.
fn size(p: &Poly<Dd>) -> f64 {
    p.iter().fold(0.0, |m: f64, c| m.max(c.value().abs()))
}

fn mode(sign: i32) -> Mode {
    match sign {
        0 => Mode::Stick,
        1 => Mode::Slip(Direction::Positive),
        _ => Mode::Slip(Direction::Negative),
    }
}

impl Run {
    /// Goes through a piece; returns the series of its last step and the point of it reached.
    fn cross(&mut self, piece: &Piece) -> Series {
        if !piece.contact {
            let [from, to] = [piece.start, piece.start + piece.length].map(Dd::value);
            match self.out.contact_loss_s.last_mut() {
                Some(last) if last[1] == from => last[1] = to,
                _ => self.out.contact_loss_s.push([from, to]),
            }
        }
        let length = piece.length.value();
        let count = (self.system.rate * length / RATE_TIMES_STEP).ceil().max(1.0) as u64;
        let mut x = ZERO;
        let mut stalls = 0;
        let mut last = None;
        for j in 1..=count {
            let end = if j == count { ONE } else { Dd::from(j as f64) / Dd::from(count as f64) };
            while x < end {
                let (next, series) = self.step(piece, x, end);
                stalls = if (next - x).value() > 1e-25 { 0 } else { stalls + 1 };
                assert!(
                    stalls < 20,
                    "the reference makes no progress at {:?}",
                    piece.start + piece.length * x
                );
                x = next;
                last = Some(series);
            }
        }
        last.expect("a piece has a length")
    }

    /// Goes from `x` (in lengths of the piece) to the next event, at most to `end`.
    fn step(&mut self, piece: &Piece, x: Dd, end: Dd) -> (Dd, Series) {
        let part = end - x;
        let h = piece.length * part;
        let part_of = |pair: [Dd; 2]| [pair[0] + pair[1] * x, pair[1] * part];
        let load = Load { b: part_of(piece.load.b), normal: part_of(piece.load.normal) };
        let time_s = (piece.start + piece.length * x).value();
        if self.sign == 0 || (self.state.w == ZERO && !self.fresh) {
            self.decide(load, h, time_s);
        }
        self.fresh = false;
        let mut series = self.system.series(&self.state, load, h, self.sign);
        let noise = self.velocity_noise(&series, load, h);
        let root = if self.sign == 0 {
            let bounds = self.bounds(&series, load);
            let roots = bounds.iter().filter_map(|(bound, noise)| first_root(bound, *noise));
            roots.reduce(|a, b| if a < b { a } else { b })
        } else {
            first_root(&series.w, noise)
        };
        if let Some(to) = root {
            series.cut(to);
        }
        self.record(&series, h * root.unwrap_or(ONE), time_s);
        let at = |p: &Poly<Dd>| value(p, ONE);
        self.state = State {
            s: at(&series.s),
            w: at(&series.w),
            q: series.q.iter().map(at).collect(),
            v: series.v.iter().map(at).collect(),
        };
        let touches = self.state.w.value().abs() <= noise;
        if self.sign != 0 && (root.is_some() || touches) {
            self.state.w = ZERO;
        }
        (root.map_or(end, |to| x + part * to), series)
    }

    /// The forces that may cancel, at the start of a step.
    fn terms(&self, series: &Series) -> f64 {
        let link = self.system.spring * series.s[0];
        size(&series.friction) + size(&series.shear) + link.value().abs()
    }

    fn velocity_noise(&self, series: &Series, load: Load, h: Dd) -> f64 {
        let forces = self.terms(series) / self.system.block_kg.value();
        let gain = h.value() * (forces + load.b[0].value().abs());
        NOISE * size(&series.w).max(self.out.peaks.w).max(gain)
    }

    /// What is left of the bound for pushes towards −x and +x in stick, and the noise of it.
    fn bounds(&self, stick: &Series, load: Load) -> [(Poly<Dd>, f64); 2] {
        let terms = self.terms(stick) + (self.system.block_kg * load.b[0]).value().abs();
        [(1, -1.0), (0, 1.0)].map(|(direction, push)| {
            let factor = self.system.static_friction[direction] * self.system.total_kg;
            let mut left = stick.friction.map(|t| t * push);
            left[0] += factor * load.normal[0];
            left[1] += factor * load.normal[1];
            (left, NOISE * (terms + (factor * load.normal[0]).value().abs()))
        })
    }

    /// At ṡ = 0: sticks where the demand is within its bound, else slips against the demand.
    fn decide(&mut self, load: Load, h: Dd, time_s: f64) {
        let before = self.sign;
        let stick = self.system.series(&self.state, load, h, 0);
        let bounds = self.bounds(&stick, load);
        let exceeded = |i: usize| {
            let (bound, noise): &(Poly<Dd>, f64) = &bounds[i];
            leading(bound, *noise).is_some_and(|(_, sign)| sign < 0)
        };
        self.sign = if exceeded(0) { -1 } else { i32::from(exceeded(1)) };
        if self.sign != 0 {
            self.fresh = true;
        }
        if self.sign == before {
            return;
        }
        let kind = match (before, self.sign) {
            (0, _) => EventKind::Slip,
            (_, 0) => EventKind::Stick,
            _ => EventKind::Reversal,
        };
        let (mut margin, mut dip) = (0.0, 0.0);
        if before != 0 {
            let demand = stick.friction[0].value();
            let held = if demand > 0.0 { &bounds[0].0 } else { &bounds[1].0 };
            let bound = held[0].value() + demand.abs();
            margin = if bound > 0.0 { held[0].value() / bound } else { 0.0 };
            let slip = self.system.series(&self.state, load, h, before);
            let (rate, bend) = (slip.w[1].value(), slip.w[2].value());
            dip = rate * rate / (4.0 * bend.abs().max(1e-300)) / self.slip.peak.max(1e-300);
        }
        self.slip = Slip::default();
        let s = self.state.s.value();
        self.out.events.push(Event { time_s, kind, mode: mode(self.sign), s, margin, dip });
    }

    /// Peaks, path, sliding time and dips over a step of `h` seconds.
    fn record(&mut self, x: &Series, h: Dd, time_s: f64) {
        let system = &self.system;
        let peaks = &mut self.out.peaks;
        let slope = system.slope.value();
        let grow = |peak: &mut f64, p: Poly<f64>| *peak = largest(&p, *peak);
        let w = rounded(&x.w);
        grow(&mut peaks.s, rounded(&x.s));
        grow(&mut peaks.w, w);
        let mut block = rounded(&x.block);
        block[0] = (x.block[0] - system.slope).value();
        grow(&mut peaks.block, block);
        grow(&mut peaks.friction, rounded(&x.friction));
        let link = |k: usize| x.friction[k] - system.spring * x.s[k] - system.damper * x.w[k];
        grow(&mut peaks.slider, std::array::from_fn(|k| link(k).value()));
        grow(&mut peaks.shear, rounded(&x.shear));
        for i in 0..system.n {
            let below = |k: usize| if i == 0 { ZERO } else { x.q[i - 1][k] };
            grow(&mut peaks.q[i], rounded(&x.q[i]));
            grow(&mut peaks.v[i], rounded(&x.v[i]));
            grow(&mut peaks.drift[i], std::array::from_fn(|k| (x.q[i][k] - below(k)).value()));
            let mut floor = rounded(&x.floors[i]);
            floor[0] -= slope;
            grow(&mut peaks.floors[i], floor);
        }
        if self.sign == 0 {
            return;
        }
        self.out.path += (value(&x.s, ONE) - x.s[0]).value().abs();
        self.out.sliding_time_s += h.value();
        self.slip.peak = largest(&w, self.slip.peak);
        self.find_dip(x, h.value(), time_s);
    }

    /// Local minima of the speed: where sgn(ṡ) s̈ turns from − to +.
    fn find_dip(&mut self, x: &Series, h: f64, time_s: f64) {
        let mut rate = [ZERO; DEGREE + 1];
        for k in 1..=DEGREE {
            rate[k - 1] = x.w[k] * (k as f64 * f64::from(self.sign));
        }
        let noise = NOISE * size(&rate);
        let start = leading(&rate, noise).map_or(0, |(_, sign)| sign);
        if self.slip.trend < 0 && start > 0 {
            let depth = x.w[0].value().abs() / self.slip.peak;
            self.out.dips.push(Dip { time_s, depth });
        }
        if start < 0
            && let Some(root) = first_root(&rate, noise)
        {
            let depth = value(&x.w, root).value().abs() / self.slip.peak;
            self.out.dips.push(Dip { time_s: time_s + root.value() * h, depth });
        }
        self.slip.trend = value(&rate, ONE).sign();
    }

    /// Stores the state at a sample, with the limits from the left of the last series' end.
    fn sample(&mut self, time_s: f64, left: Option<&Series>) {
        let end = |p: &Poly<Dd>| (value(p, ONE) - self.system.slope).value();
        let round = |list: &[Dd]| list.iter().map(|x| x.value()).collect::<Vec<_>>();
        let previous = self.out.samples.last();
        let sample = Sample {
            time_s,
            mode: mode(self.sign),
            s: self.state.s.value(),
            w: self.state.w.value(),
            q: round(&self.state.q),
            v: round(&self.state.v),
            block: left.map_or(previous.map_or(0.0, |p| p.block), |x| end(&x.block)),
            floors: left.map_or_else(
                || previous.map_or(vec![0.0; self.system.n], |p| p.floors.clone()),
                |x| x.floors.iter().map(end).collect(),
            ),
        };
        self.out.samples.push(sample);
    }
}
