//! Times analyses for `cargo xtask bench-peers`, which talks to it line by line.
//!
//! `load FILE` reads a case: little-endian doubles block mass, floor mass (0 without a floor),
//! slider spring, storey spring, storey damper, static and kinetic friction, gravity, dt, then the
//! acceleration of the table at 0, dt, 2 dt, …, all SI. `time WHAT COUNT` prints the nanoseconds of
//! so many analyses, set-up of the system included; WHAT is `demands`, `history`, `checked`
//! (history and certificate) or `setup` (two samples of a table at rest); or of its parts: `tables`
//! prepares the model, `prepared` solves with model and motion prepared. `history FILE` writes the
//! sliding displacement at the samples and prints its peak and the number of events.

#![allow(
    clippy::disallowed_macros,
    clippy::disallowed_methods,
    clippy::disallowed_types,
    reason = "a program may print, read the clock and open files"
)]

use slipstick::check::check;
use slipstick::model::{Block, Damping, Frame, InitialState, Model, Slider};
use slipstick::motion::GroundMotion;
use slipstick::slider::Friction;
use slipstick::solver::{self, Prepared, PreparedMotion, Workspace};
use std::error::Error;
use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let mut case = None;
    for line in std::io::stdin().lines() {
        let line = line?;
        let words: Vec<&str> = line.split_whitespace().collect();
        match (words.as_slice(), &case) {
            (["load", file], _) => {
                case = Some(load(&std::fs::read(file)?)?);
                println!("loaded");
            }
            (["time", what, count], Some(case)) => {
                println!("{}", time(case, what, count.parse()?)?)
            }
            (["history", file], Some(case)) => println!("{}", history(case, file)?),
            _ => return Err(format!("expected load, time or history, found {line:?}").into()),
        }
    }
    Ok(())
}

struct Case {
    block: Block,
    slider: Slider,
    frame: Frame,
    gravity_m_per_s2: f64,
    motion: GroundMotion,
    still: GroundMotion,
}

impl Case {
    fn model(&self) -> Result<Model, Box<dyn Error>> {
        let (slider, frame) = (self.slider.clone(), self.frame.clone());
        Ok(Model::new(self.block, slider, frame, self.gravity_m_per_s2, InitialState::rest())?)
    }
}

fn load(bytes: &[u8]) -> Result<Case, Box<dyn Error>> {
    let (words, _) = bytes.as_chunks::<8>();
    let numbers: Vec<f64> = words.iter().map(|word| f64::from_le_bytes(*word)).collect();
    let [
        mass_kg,
        floor_kg,
        spring,
        storey_spring,
        storey_damper,
        mu_s,
        mu_k,
        gravity,
        dt_s,
        ground @ ..,
    ] = numbers.as_slice()
    else {
        return Err("expected nine numbers and a ground motion".into());
    };
    let frame = if *floor_kg == 0.0 {
        Frame::none()
    } else {
        Frame {
            masses_kg: vec![*floor_kg],
            stiffnesses_n_per_m: vec![*storey_spring],
            damping: Damping::Dampers(vec![*storey_damper]),
            heights_m: None,
        }
    };
    Ok(Case {
        block: Block { mass_kg: *mass_kg, width_m: None, height_m: None },
        slider: Slider::sprung(Friction::new(*mu_s, *mu_k)?, *spring),
        frame,
        gravity_m_per_s2: *gravity,
        motion: GroundMotion::evenly_spaced(*dt_s, ground.to_vec(), None)?,
        still: GroundMotion::evenly_spaced(*dt_s, vec![0.0; 2], None)?,
    })
}

fn time(case: &Case, what: &str, count: usize) -> Result<String, Box<dyn Error>> {
    let mut nanoseconds = Vec::with_capacity(count);
    let motion = PreparedMotion::new(case.motion.clone());
    let model = Arc::new(case.model()?);
    let (prepared, mut workspace) =
        (Prepared::new(model.clone(), motion.dt_s()), Workspace::default());
    for _ in 0..count {
        let clock = Instant::now();
        match what {
            "setup" => {
                black_box(solver::exact_demands(&case.model()?, &case.still)?);
            }
            "tables" => {
                black_box(Prepared::new(black_box(&model).clone(), motion.dt_s()));
            }
            "demands" => {
                black_box(solver::exact_demands(&case.model()?, &case.motion)?);
            }
            "prepared" => {
                black_box(prepared.demands_in(&mut workspace, &motion)?);
            }
            "history" => {
                black_box(solver::exact(&case.model()?, &case.motion)?);
            }
            "checked" => {
                let model = case.model()?;
                let response = solver::exact(&model, &case.motion)?;
                black_box(check(&model, &case.motion, &response));
            }
            _ => {
                return Err(format!(
                    "expected demands, prepared, tables, history, checked or setup, found {what}"
                )
                .into());
            }
        }
        nanoseconds.push(clock.elapsed().as_nanos().to_string());
    }
    Ok(nanoseconds.join(" "))
}

fn history(case: &Case, file: &str) -> Result<String, Box<dyn Error>> {
    let response = solver::exact(&case.model()?, &case.motion)?;
    let history = response.history.as_ref().ok_or("expected a history")?;
    let bytes: Vec<u8> = history
        .rows
        .iter()
        .flat_map(|&row| history.sliding_displacement_m[row].to_le_bytes())
        .collect();
    std::fs::write(file, bytes)?;
    let peak_m = response.demands.peak_sliding_displacement_m;
    Ok(format!("{peak_m:e} {}", response.events.len()))
}
