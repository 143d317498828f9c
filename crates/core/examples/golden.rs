//! Hashes of the bits of a few analyses, to be compared between machines.
//!
//! Run as it stands it prints one hash an analysis. Built with these in the environment variable
//! `SLIPSTICK_GOLDEN` it compares: it returns 0, or the number of the first analysis (from 1) that
//! differs. So it needs neither files nor output where there are none, as in WebAssembly.

#![allow(clippy::disallowed_macros, reason = "a program may print")]

use slipstick::model::{Block, Damping, Frame, InitialState, Model, Slider};
use slipstick::motion::intensity::{IntensityMeasures, Measure};
use slipstick::motion::processing::Step;
use slipstick::motion::{GroundMotion, logarithmic_periods, spectrum};
use slipstick::response::Response;
use slipstick::slider::Friction;
use slipstick::solver;
use std::process::ExitCode;

fn main() -> ExitCode {
    let Ok(hashes) = hashes() else {
        return ExitCode::from(u8::MAX);
    };
    let Some(golden) = option_env!("SLIPSTICK_GOLDEN") else {
        println!("{}", hashes.join(" "));
        return ExitCode::SUCCESS;
    };
    let mut golden = golden.split(' ');
    let differing = hashes.iter().position(|hash| golden.next() != Some(hash));
    ExitCode::from(differing.map_or(0, |i| i as u8 + 1))
}

/// One 16-digit hash for each analysis.
fn hashes() -> Result<Vec<String>, Box<dyn std::error::Error>> {
    let motions = [sine()?, noise()?];
    let mut hashes = Vec::new();
    for storeys in [0, 1, 5] {
        for stiffness_n_per_m in [0.0, 143e3] {
            let model = model(storeys, stiffness_n_per_m)?;
            for motion in &motions {
                let response = solver::exact(&model, motion)?;
                hashes.push(format!("{:016x}", hash(&response)));
            }
        }
    }
    for motion in &motions {
        hashes.push(format!("{:016x}", of_values(&measures(motion)?)));
    }
    Ok(hashes)
}

/// Every measure of a motion, spectra included.
fn measures(motion: &GroundMotion) -> Result<Vec<f64>, Box<dyn std::error::Error>> {
    let mut values = IntensityMeasures::of(motion).columns().map(|(.., value)| value).to_vec();
    values.push(Measure::parse("FIV3(0.7 s)")?.of(motion));
    let periods_s = logarithmic_periods(0.005, 5.0, 40);
    let (times_s, a) = (motion.times_s(), motion.horizontal_m_per_s2());
    for o in spectrum(times_s, a, &periods_s, &[0.0, 0.05, 0.5])?.ordinates {
        values.extend([o.sd_m, o.sv_m_per_s, o.sa_m_per_s2]);
    }
    let filtered = Step::parse("band-pass 0.1 Hz 25 Hz")?.apply(&motion.series())?;
    values.extend(filtered.values());
    Ok(values)
}

/// FNV-1a over the bits of values.
fn of_values(values: &[f64]) -> u64 {
    let bytes = values.iter().flat_map(|value| value.to_bits().to_le_bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

fn sine() -> Result<GroundMotion, Box<dyn std::error::Error>> {
    let sample = |i: i32| 2.5 * libm::sin(core::f64::consts::TAU * 1.3 * f64::from(i) * 0.005);
    Ok(GroundMotion::evenly_spaced(0.005, (0..2000).map(sample).collect(), None)?)
}

/// Coloured noise from a linear congruential generator, with a vertical component.
fn noise() -> Result<GroundMotion, Box<dyn std::error::Error>> {
    let mut state = 1_u64;
    let mut draw = move || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let mut column = |peak: f64| {
        let mut value = 0.0;
        (0..2000)
            .map(|_| {
                value = 0.9 * value + peak * draw();
                value
            })
            .collect::<Vec<f64>>()
    };
    let (horizontal, vertical) = (column(4.0), column(2.0));
    Ok(GroundMotion::evenly_spaced(0.01, horizontal, Some(vertical))?)
}

fn model(storeys: usize, stiffness_n_per_m: f64) -> Result<Model, Box<dyn std::error::Error>> {
    let frame = Frame {
        masses_kg: vec![60.0; storeys],
        stiffnesses_n_per_m: vec![3e4; storeys],
        damping: Damping::Ratio(0.02),
        heights_m: None,
    };
    Ok(Model::new(
        Block { mass_kg: 325.0, width_m: None, height_m: None },
        Slider {
            tilt_rad: 0.001,
            tilt_y_rad: 0.0,
            ..Slider::sprung(
                Friction::by_direction([0.06, 0.05], [0.045, 0.04])?,
                stiffness_n_per_m,
            )
        },
        frame,
        9.81,
        InitialState::rest(),
    )?)
}

/// FNV-1a over the bits of peaks, events and histories.
fn hash(response: &Response) -> u64 {
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let mut add = |values: &[f64]| {
        for byte in values.iter().flat_map(|value| value.to_bits().to_le_bytes()) {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    };
    let d = &response.demands;
    add(&[
        d.peak_sliding_displacement_m,
        d.peak_sliding_displacement_time_s,
        d.residual_sliding_displacement_m,
        d.sliding_path_m,
        d.peak_sliding_velocity_m_per_s,
        d.sliding_time_s,
        d.peak_block_acceleration_m_per_s2,
        d.peak_base_shear_n,
        d.peak_friction_force_n,
        d.peak_slider_force_n,
    ]);
    for storey in &d.storeys {
        add(&[storey.peak_acceleration_m_per_s2, storey.peak_displacement_m, storey.peak_drift_m]);
    }
    for event in &response.events {
        add(&[event.time_s, event.sliding_displacement_m, event.mode.sign()]);
    }
    if let Some(h) = &response.history {
        add(&h.time_s);
        add(&h.sliding_displacement_m);
        add(&h.sliding_velocity_m_per_s);
        add(&h.block_acceleration_m_per_s2);
        add(&h.friction_force_n);
        add(&h.storey_displacement_m);
        add(&h.storey_velocity_m_per_s);
        add(&h.storey_acceleration_m_per_s2);
    }
    hash
}
