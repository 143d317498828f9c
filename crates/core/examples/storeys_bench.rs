//! Times analyses of frames for `cargo xtask bench-storeys`: Taft at 0.3 g under 0 to 20 storeys.
//!
//! Prints a line a system, fields by tabs: name, number of storeys, samples, events, peak sliding
//! displacement in m, then nanoseconds a run of the demands alone, of the history and of the history
//! with its certificate, each the least of several runs of a prepared model, and of the preparation.
//! With `pairs` and a folder of records it prints, for 0, 1 and 3 storeys under each pair of components of
//! an earthquake there (files beside each other by name): number of storeys, name of the first file, samples,
//! events, peak sliding displacement in m, nanoseconds of the demands in two directions, and of the demands
//! along x alone. With a system's name, `demands`, `history`, `certificate` or `set-up`, and a count it runs that so
//! many times, for a profiler.

#![allow(
    clippy::disallowed_macros,
    clippy::disallowed_methods,
    reason = "a program may print, read files and the clock"
)]

use slipstick::check::check;
use slipstick::error::SolveError;
use slipstick::model::{Block, Contents, Damping, Frame, InitialState, Model, Slider, Stop};
use slipstick::motion::GroundMotion;
use slipstick::record::{self, Options, Units};
use slipstick::slider::{Friction, RateCurve, RateLaw, Surface, SurfacesInSeries};
use slipstick::solver::{Prepared, PreparedMotion, Workspace};
use slipstick::units::STANDARD_GRAVITY_M_PER_S2;
use std::error::Error;
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Mass of the block and of each floor.
const MASS_KG: f64 = 1000.0;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let profiled = match arguments.as_slice() {
        [] => None,
        [pairs, folder] if pairs == "pairs" => return of_pairs(Path::new(folder)),
        [name, what, count] => Some((name.as_str(), what.as_str(), count.parse::<u32>()?)),
        _ => {
            return Err(
                "expected no argument, pairs and a folder, or a name, what to run and a count"
                    .into(),
            );
        }
    };
    let [level, vertical] = taft()?;
    let [level, vertical] = [level, vertical].map(PreparedMotion::new);
    let mut systems = vec![
        ("n = 0", model(0, 0.5, [0.06, 0.05])?, &level),
        ("n = 1, T = 0.5 s", model(1, 0.5, [0.06, 0.05])?, &level),
        ("n = 1, T = 0.5 s, low friction", model(1, 0.5, [0.03, 0.02])?, &level),
        ("n = 1, T = 0.1 s", model(1, 0.1, [0.06, 0.05])?, &level),
        ("n = 1, vertical motion", model(1, 0.5, [0.06, 0.05])?, &vertical),
    ];
    for (name, model) in with_devices()? {
        systems.push((name, model, &level));
    }
    for (name, n) in [("n = 2", 2), ("n = 5", 5), ("n = 10", 10), ("n = 20", 20)] {
        systems.push((name, model(n, 0.1 * n as f64, [0.06, 0.05])?, &level));
    }
    for (name, model, motion) in systems {
        if profiled.is_some_and(|(wanted, ..)| wanted != name) {
            continue;
        }
        let prepared = Prepared::new(model.clone(), motion.dt_s());
        match profiled {
            None => measure(name, &model, &prepared, motion)?,
            Some((_, "set-up", count)) => {
                for _ in 0..count {
                    black_box(Prepared::new(model.clone(), motion.dt_s()));
                }
            }
            Some((_, "history", count)) => {
                for _ in 0..count {
                    black_box(prepared.response(motion)?);
                }
            }
            Some((_, "certificate", count)) => {
                for _ in 0..count {
                    let response = prepared.response(motion)?;
                    black_box(check(prepared.model(), motion.motion(), &response));
                }
            }
            Some((.., count)) => {
                let mut workspace = Workspace::default();
                for _ in 0..count {
                    black_box(prepared.demands_in(&mut workspace, motion)?);
                }
            }
        }
    }
    Ok(())
}

fn measure(
    name: &str,
    model: &Model,
    prepared: &Prepared,
    motion: &PreparedMotion,
) -> Result<(), Box<dyn Error>> {
    let response = prepared.demands(motion)?;
    let samples = motion.motion().len();
    let mut workspace = Workspace::default();
    let demands = least(|| {
        prepared.demands_in(&mut workspace, motion).map(|response| drop(black_box(response)))
    })?;
    let history = least(|| prepared.response(motion).map(|response| drop(black_box(response))))?;
    let checked = least(|| {
        let response = prepared.response(motion)?;
        black_box(check(prepared.model(), motion.motion(), &response));
        Ok(())
    })?;
    let set_up = least(|| {
        drop(black_box(Prepared::new(model.clone(), motion.dt_s())));
        Ok(())
    })?;
    let [demands, history, checked, set_up] =
        [demands, history, checked, set_up].map(|time| time.as_nanos());
    let (storeys, events) = (prepared.model().storeys(), response.events.len());
    let peak_m = response.demands.peak_sliding_displacement_m;
    println!(
        "{name}\t{storeys}\t{samples}\t{events}\t{peak_m:e}\t{demands}\t{history}\t{checked}\t{set_up}"
    );
    Ok(())
}

/// The least time of a run, of as many as 0.3 s hold.
fn least(mut run: impl FnMut() -> Result<(), SolveError>) -> Result<Duration, SolveError> {
    let clock = Instant::now();
    let mut least = Duration::MAX;
    while clock.elapsed() < Duration::from_millis(300) {
        let start = Instant::now();
        run()?;
        least = least.min(start.elapsed());
    }
    Ok(least)
}

/// Pairs of a folder, on a pendulum of 2.2 m with friction 0.06.
fn of_pairs(folder: &Path) -> Result<(), Box<dyn Error>> {
    let entries: Result<Vec<_>, _> = std::fs::read_dir(folder)?.collect();
    let mut files: Vec<PathBuf> = entries?.iter().map(std::fs::DirEntry::path).collect();
    files.sort();
    for n in [0, 1, 3] {
        let model = model_on(2.2, (n, 0.5), [0.06; 2])?;
        for pair in files.chunks_exact(2) {
            let along_x = motion(&pair[0])?;
            let (both, _) = along_x.with_along_y(&motion(&pair[1])?)?;
            let mut workspace = Workspace::default();
            let [along_x, both] = [along_x, both].map(PreparedMotion::new);
            let mut time = |motion: &PreparedMotion| -> Result<Duration, SolveError> {
                let prepared = Prepared::new(model.clone(), motion.dt_s());
                least(|| {
                    prepared.demands_in(&mut workspace, motion).map(|one| drop(black_box(one)))
                })
            };
            let times = [time(&both)?, time(&along_x)?].map(|time| time.as_nanos());
            let response = Prepared::new(model.clone(), both.dt_s()).demands(&both)?;
            let name = pair[0].file_stem().unwrap_or_default().to_string_lossy();
            let (samples, events) = (both.motion().len(), response.events.len());
            let peak_m = response.demands.peak_sliding_displacement_m;
            println!("{n}\t{name}\t{samples}\t{events}\t{peak_m:e}\t{}\t{}", times[0], times[1]);
        }
    }
    Ok(())
}

/// The motion of a file of one component.
fn motion(file: &Path) -> Result<GroundMotion, Box<dyn Error>> {
    let name = file.display().to_string();
    // Those that are a table state no units; they are in g.
    let is_table = file.extension().is_some_and(|extension| extension == "txt");
    let units = Units::parse("g").filter(|_| is_table);
    let record =
        record::read(&name, &std::fs::read(file)?, &Options { units, ..Options::default() })?;
    let channel = record.channels.first().ok_or("expected a channel")?;
    Ok(channel.motion().ok_or("expected an acceleration")??)
}

/// The Taft record at 0.3 g, without and with two thirds of it upwards, reversed in time.
fn taft() -> Result<[GroundMotion; 2], Box<dyn Error>> {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/records/taft-111.txt");
    let text = std::fs::read_to_string(file)?;
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    let values: Vec<f64> = lines.filter_map(|line| line.trim().parse().ok()).collect();
    let peak = values.iter().fold(0.0_f64, |peak, a| peak.max(a.abs()));
    let factor = 0.3 * STANDARD_GRAVITY_M_PER_S2 / peak;
    let scaled: Vec<f64> = values.iter().map(|a| factor * a).collect();
    let upwards = scaled.iter().rev().map(|a| a * 2.0 / 3.0).collect();
    Ok([
        GroundMotion::evenly_spaced(0.01, scaled.clone(), None)?,
        GroundMotion::evenly_spaced(0.01, scaled, Some(upwards))?,
    ])
}

/// One storey with devices, each beside the same friction without.
fn with_devices() -> Result<Vec<(&'static str, Model)>, Box<dyn Error>> {
    let plain = || model(1, 0.5, [0.06, 0.05]);
    let pieces = RateCurve::Pieces {
        speeds_m_per_s: vec![0.0, 0.02, 0.1, 0.3],
        coefficients: vec![0.03, 0.04, 0.05, 0.055],
    };
    let exponential = RateCurve::Exponential { slow: 0.03, fast: 0.055, rate_s_per_m: 30.0 };
    let surface = |radius_m, friction, travel_m| Surface {
        radius_m: Some(radius_m),
        friction,
        travel_m: Some(travel_m),
    };
    let double =
        SurfacesInSeries::new(vec![surface(0.4, 0.03, 0.05), surface(1.6, 0.055, 0.6)], 1.1)?;
    let with = |change: &dyn Fn(Slider) -> Slider| -> Result<Model, Box<dyn Error>> {
        let plain = plain()?;
        let (block, frame) = (*plain.block(), plain.frame().clone());
        let slider = change(plain.slider().clone());
        Ok(Model::new(block, slider, frame, STANDARD_GRAVITY_M_PER_S2, InitialState::rest())?)
    };
    let rigid = |gap_m| {
        let stop = Stop::rigid([Some(gap_m); 2], 0.5);
        with(&|slider| Slider { ends: stop.into(), ..slider })
    };
    let contents = |static_friction, kinetic_friction| -> Result<Model, Box<dyn Error>> {
        let contents = Contents { floor: 1, mass_kg: 50.0, static_friction, kinetic_friction };
        Ok(plain()?.with_contents(vec![contents])?)
    };
    let by_speed = |curve| -> Result<Model, Box<dyn Error>> {
        let rate = RateLaw::new(curve, [1.0; 2])?;
        Ok(plain()?.with_friction(Friction::by_speed([0.06; 2], rate)?))
    };
    Ok(vec![
        ("n = 1, friction in pieces", by_speed(pieces)?),
        ("n = 1, exponential friction", by_speed(exponential)?),
        ("n = 1, double pendulum", with(&|_| Slider::in_series(double.clone()))?),
        ("n = 1, rigid stop not reached", rigid(1.0)?),
        ("n = 1, rigid stop struck", rigid(0.03)?),
        ("n = 1, contents", contents(0.4, 0.3)?),
        ("n = 1, contents that slide", contents(0.1, 0.08)?),
    ])
}

/// A shear frame of equal floors and storeys with a first period, on a pendulum slider of 2 m.
fn model(n: usize, period_s: f64, friction: [f64; 2]) -> Result<Model, Box<dyn Error>> {
    model_on(2.0, (n, period_s), friction)
}

/// The same on a pendulum of a radius.
fn model_on(
    radius_m: f64,
    (n, period_s): (usize, f64),
    [mu_s, mu_k]: [f64; 2],
) -> Result<Model, Box<dyn Error>> {
    let total_kg = MASS_KG * (n + 1) as f64;
    let spring = total_kg * STANDARD_GRAVITY_M_PER_S2 / radius_m;
    let slider = Slider::sprung(Friction::new(mu_s, mu_k)?, spring);
    let frame = if n == 0 {
        Frame::none()
    } else {
        // First frequency of a uniform shear frame: 2 √(k/m) sin(π / (4n + 2)).
        let half = libm::sin(core::f64::consts::PI / (4 * n + 2) as f64);
        let rate = core::f64::consts::PI / (period_s * half);
        Frame {
            masses_kg: vec![MASS_KG; n],
            stiffnesses_n_per_m: vec![MASS_KG * rate * rate; n],
            damping: Damping::Ratio(0.05),
            heights_m: None,
        }
    };
    let block = Block { mass_kg: MASS_KG, width_m: None, height_m: None };
    Ok(Model::new(block, slider, frame, STANDARD_GRAVITY_M_PER_S2, InitialState::rest())?)
}
