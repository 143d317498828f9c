//! Random systems with all devices: stops, friction by speed, surfaces in series, pendulums under
//! vertical motion, contents.

use slipstick::model::{
    Block, Contents, Damping, Frame, InitialState, Model, Slider, Stop, StopKind,
};
use slipstick::motion::GroundMotion;
use slipstick::slider::{Friction, RateCurve, RateLaw, Surface, SurfacesInSeries};

const G: f64 = 9.80665;

/// A small generator: SplitMix64.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }

    fn chance(&mut self, part: f64) -> bool {
        self.next() < part
    }
}

/// A model, its mirror image, and a motion.
pub struct System {
    pub model: Model,
    pub mirrored: Model,
    pub times_s: Vec<f64>,
    pub horizontal: Vec<f64>,
    pub vertical: Option<Vec<f64>>,
}

/// The system of a seed.
pub fn system(seed: u64) -> System {
    let r = &mut Random(seed);
    let n = (r.next() * 3.5) as usize;
    let mass_kg = r.between(200.0, 600.0);
    let frame = Frame {
        masses_kg: (0..n).map(|_| r.between(50.0, 400.0)).collect(),
        stiffnesses_n_per_m: (0..n).map(|_| r.between(1e4, 3e5)).collect(),
        damping: if r.chance(0.5) {
            Damping::Ratio(r.between(0.0, 0.05))
        } else {
            Damping::Dampers((0..n).map(|_| r.between(0.0, 300.0)).collect())
        },
        heights_m: None,
    };
    let fixed = r.between(0.02, 0.12);
    let at_rest = if r.chance(0.3) { fixed } else { fixed * r.between(0.5, 1.0) };
    let in_series = r.chance(0.3);
    let rate = (!in_series && r.chance(0.6)).then(|| {
        let curve = if r.chance(0.5) {
            let fast = r.between(0.02, 0.15);
            let rate_s_per_m = r.between(5.0, 60.0);
            RateCurve::Exponential { slow: at_rest, fast, rate_s_per_m }
        } else {
            let knots = 2 + (r.next() * 3.0) as usize;
            let mut v = 0.0;
            let mut speeds_m_per_s = vec![0.0];
            let mut coefficients = vec![at_rest];
            for _ in 1..knots {
                v += r.between(0.02, 0.2);
                speeds_m_per_s.push(v);
                coefficients.push(r.between(0.02, 0.12));
            }
            RateCurve::Pieces { speeds_m_per_s, coefficients }
        };
        RateLaw::new(curve, [1.0; 2]).expect("a rate law")
    });
    let series = in_series.then(|| {
        let count = 2 + (r.next() * 2.0) as usize;
        let surface = |r: &mut Random| Surface {
            radius_m: (!r.chance(0.1)).then(|| r.between(0.3, 2.5)),
            friction: r.between(0.02, 0.1),
            travel_m: r.chance(0.4).then(|| r.between(0.03, 0.2)),
        };
        let mut surfaces: Vec<Surface> = (0..count).map(|_| surface(r)).collect();
        if r.chance(0.3) {
            surfaces[1] = surfaces[0];
        }
        SurfacesInSeries::new(surfaces, if r.chance(0.5) { 1.0 } else { r.between(1.0, 1.5) })
            .expect("surfaces")
    });
    let vertical = r.chance(0.4);
    let radius_m = (!in_series && r.chance(0.5)).then(|| r.between(0.5, 3.0));
    let contents: Vec<Contents> = (0..(r.next() * 2.2) as usize)
        .map(|_| {
            let static_friction = r.between(0.03, 0.2);
            Contents {
                floor: (r.next() * (n as f64 + 1.0)) as usize,
                mass_kg: r.between(5.0, 150.0),
                static_friction,
                kinetic_friction: static_friction
                    * if r.chance(0.3) { 1.0 } else { r.between(0.5, 1.0) },
            }
        })
        .collect();
    let stop = r.chance(0.5).then(|| {
        let gap = |r: &mut Random| r.chance(0.8).then(|| r.between(0.01, 0.08));
        let gap_m = [Some(r.between(0.01, 0.08)), gap(r)];
        let kind = if r.chance(0.6) {
            StopKind::Rigid { restitution: if r.chance(0.2) { 0.0 } else { r.between(0.1, 0.9) } }
        } else {
            StopKind::Elastic {
                stiffness_n_per_m: r.between(1e4, 2e6),
                damper_n_s_per_m: if r.chance(0.3) { 0.0 } else { r.between(0.0, 3e3) },
            }
        };
        Stop { gap_m, kind }
    });
    let spring =
        if radius_m.is_some() || in_series || r.chance(0.4) { 0.0 } else { r.between(500.0, 2e4) };
    let tilt_rad = if r.chance(0.2) { r.between(-0.01, 0.01) } else { 0.0 };
    let slider = match series {
        Some(series) => Slider::in_series(series),
        None => {
            let friction = match rate {
                Some(rate) => Friction::by_speed([fixed; 2], rate),
                None => Friction::new(fixed, at_rest),
            };
            let friction = friction.expect("friction");
            match radius_m {
                Some(radius_m) => Slider::pendulum(friction, radius_m),
                None => Slider::sprung(friction, spring),
            }
        }
    };
    let damper_n_s_per_m = if r.chance(0.2) { r.between(0.0, 500.0) } else { 0.0 };
    let slider = Slider { damper_n_s_per_m, tilt_rad, ends: stop.into(), ..slider };
    let w = if r.chance(0.2) { r.between(-0.4, 0.4) } else { 0.0 };
    let build = |slider: Slider, w: f64| {
        let initial = InitialState { sliding_velocity_m_per_s: w, ..InitialState::rest() };
        let block = Block { mass_kg, width_m: None, height_m: None };
        Model::new(block, slider, frame.clone(), G, initial)
            .and_then(|model| model.with_contents(contents.clone()))
            .expect("a model")
    };
    let turned = stop.map(|stop| Stop { gap_m: [stop.gap_m[1], stop.gap_m[0]], ..stop });
    let mirror = Slider { tilt_rad: -tilt_rad, ends: turned.into(), ..slider.clone() };
    let (model, mirrored) = (build(slider, w), build(mirror, -w));
    let (f1, f2) = (r.between(0.4, 2.0), r.between(1.0, 5.0));
    let (a1, a2) = (r.between(0.5, 3.0), r.between(0.0, 2.0));
    let up = r.between(0.5, 5.0);
    let wave = |t: f64| a1 * libm::sin(f1 * 6.3 * t) + a2 * libm::sin(f2 * 6.3 * t + 1.0);
    let times_s: Vec<f64> = (0..=150).map(|k| 0.02 * f64::from(k)).collect();
    let horizontal = times_s.iter().map(|t| wave(*t)).collect();
    let vertical = vertical.then(|| times_s.iter().map(|t| up * libm::sin(f2 * 9.1 * t)).collect());
    System { model, mirrored, times_s, horizontal, vertical }
}

/// Its motion, or with the other sign.
pub fn motion(system: &System, sign: f64) -> GroundMotion {
    let a = system.horizontal.iter().map(|a| sign * a).collect();
    GroundMotion::new(system.times_s.clone(), a, system.vertical.clone()).expect("a motion")
}

/// A system of contents and slider in which much coincides: coefficients and masses off a short list,
/// motions of plateaus, zeros and jumps.
pub fn coincident(seed: u64) -> System {
    let r = &mut Random(seed);
    fn pick(r: &mut Random, list: &[f64]) -> f64 {
        list[(r.next() * list.len() as f64) as usize]
    }
    let n = usize::from(r.chance(0.3));
    let frame = Frame {
        masses_kg: vec![50.0; n],
        stiffnesses_n_per_m: vec![2e4; n],
        damping: Damping::Dampers(vec![100.0; n]),
        heights_m: None,
    };
    // Binary fractions: what should be equal is so to the last bit of the reference too.
    let frictions = [0.0625, 0.125, 0.125, 0.1875];
    let coefficients = |r: &mut Random| {
        let kinetic = pick(r, &frictions);
        [kinetic * pick(r, &[1.0, 1.0, 1.25]), kinetic]
    };
    let slider_friction = coefficients(r);
    let contents: Vec<Contents> = (0..1 + (r.next() * 2.5) as usize)
        .map(|_| {
            let floor = if r.chance(0.3) { n } else { 0 };
            let mass_kg = pick(r, &[19.0, 83.0, 101.0, 157.0]);
            let [static_friction, kinetic_friction] =
                if r.chance(0.4) { slider_friction } else { coefficients(r) };
            Contents { floor, mass_kg, static_friction, kinetic_friction }
        })
        .collect();
    // Equal items are one: only the first.
    let mut different: Vec<Contents> = Vec::new();
    for item in contents {
        if !different.iter().any(|c| Contents { mass_kg: item.mass_kg, ..*c } == item) {
            different.push(item);
        }
    }
    let stop = r.chance(0.15).then(|| Stop {
        gap_m: [Some(0.02), Some(0.02)],
        kind: StopKind::Rigid { restitution: pick(r, &[0.0, 0.5]) },
    });
    let [fixed, kinetic] = slider_friction;
    let friction = Friction::new(fixed, kinetic).expect("friction");
    let spring = pick(r, &[0.0, 0.0, 4000.0]);
    let slider = Slider { ends: stop.into(), ..Slider::sprung(friction, spring) };
    let block = Block { mass_kg: 100.0, width_m: None, height_m: None };
    let model = Model::new(block, slider, frame, G, InitialState::rest())
        .and_then(|model| model.with_contents(different))
        .expect("a model");
    let (mut times_s, mut horizontal) = (vec![0.0], vec![0.0]);
    if r.chance(0.5) {
        horizontal[0] = r.between(-5.0, 5.0);
    }
    let mut time_s = 0.0;
    for _ in 0..24 {
        let last = horizontal[horizontal.len() - 1];
        if r.chance(0.2) && time_s > 0.0 {
            times_s.push(time_s);
            horizontal.push(r.between(-5.0, 5.0));
        }
        time_s += 0.0625;
        times_s.push(time_s);
        let kind = r.next();
        horizontal.push(match kind {
            x if x < 0.2 => horizontal[horizontal.len() - 1],
            x if x < 0.35 => 0.0,
            x if x < 0.45 => -last,
            _ => r.between(-5.0, 5.0),
        });
    }
    System { mirrored: model.clone(), model, times_s, horizontal, vertical: None }
}
