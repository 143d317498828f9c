//! A run in workspace that another has left allocates its answer and nothing else.

// Helpers of tests may panic as tests do.
#![allow(clippy::unwrap_used)]

use allocation_counter::measure;
use slipstick::model::{Block, Damping, Frame, InitialState, Model, Slider};
use slipstick::motion::GroundMotion;
use slipstick::slider::Friction;
use slipstick::solver::{Prepared, PreparedMotion, Workspace};

fn model(storeys: usize, tilt_rad: f64) -> Model {
    let friction = Friction::new(0.06, 0.05).unwrap();
    let frame = Frame {
        masses_kg: vec![1000.0; storeys],
        stiffnesses_n_per_m: vec![4e5; storeys],
        damping: Damping::Ratio(0.03),
        heights_m: None,
    };
    let block = Block { mass_kg: 1000.0, width_m: None, height_m: None };
    let slider = Slider { tilt_rad, ..Slider::sprung(friction, 2e4) };
    Model::new(block, slider, frame, 9.81, InitialState::rest()).unwrap()
}

#[test]
fn a_run_allocates_its_answer_alone() {
    let shake = |i: usize| 2.0 * libm::sin(0.07 * i as f64) * libm::sin(0.003 * i as f64);
    let values: Vec<f64> = (0..3000).map(shake).collect();
    let upwards: Vec<f64> = values.iter().rev().map(|a| 0.5 * a).collect();
    let motions = [None, Some(upwards)].map(|vertical| {
        PreparedMotion::new(GroundMotion::evenly_spaced(0.01, values.clone(), vertical).unwrap())
    });
    for motion in &motions {
        for (storeys, tilt_rad) in [(0, 0.0), (1, 0.0), (1, 0.01), (2, 0.0), (5, 0.01)] {
            let prepared = Prepared::new(model(storeys, tilt_rad), motion.dt_s());
            let mut workspace = Workspace::default();
            let first = prepared.demands_in(&mut workspace, motion).unwrap();
            let mut again = None;
            let made =
                measure(|| again = Some(prepared.demands_in(&mut workspace, motion).unwrap()));
            assert_eq!(again.as_ref(), Some(&first));
            assert!(first.events.len() > 20, "{} events", first.events.len());
            // The list of events, and that of the storeys' demands.
            let lists = 1 + u64::from(storeys > 0);
            assert_eq!(made.count_total, lists, "{storeys} storeys, tilt {tilt_rad}: {made:?}");
        }
    }
}
