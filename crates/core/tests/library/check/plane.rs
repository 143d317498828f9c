//! Two horizontal directions: what the solver says of real pairs is certified, along an axis too.

use std::path::{Path, PathBuf};

use slipstick::check::check;
use slipstick::model::{AlongY, Block, Damping, Frame, InitialState, Model, Slider};
use slipstick::motion::GroundMotion;
use slipstick::record::{self, Options};
use slipstick::response::Response;
use slipstick::slider::Friction;
use slipstick::solver::exact;
use slipstick::units::STANDARD_GRAVITY_M_PER_S2 as G;

use super::systems::{figures, shaking};

/// A block on a pendulum under storeys that are stiffer along y.
fn model(storeys: usize) -> Model {
    let friction = Friction::new(0.07, 0.06).unwrap();
    let stiffnesses: Vec<f64> = [3e5, 2.4e5, 1.8e5][..storeys].to_vec();
    let frame = Frame {
        masses_kg: vec![300.0; storeys],
        stiffnesses_n_per_m: stiffnesses.clone(),
        damping: Damping::Ratio(0.02),
        heights_m: Some(vec![3.0; storeys]),
    };
    let block = Block { mass_kg: 1000.0, width_m: None, height_m: None };
    let along_y = AlongY {
        stiffnesses_n_per_m: stiffnesses.iter().map(|k| 1.3 * k).collect(),
        damping: Damping::Ratio(0.03),
        width_m: None,
        initial: InitialState::rest(),
    };
    Model::new(block, Slider::pendulum(friction, 2.2), frame, G, InitialState::rest())
        .and_then(|model| model.with_along_y(along_y))
        .unwrap()
}

fn certified(what: &str, model: &Model, motion: &GroundMotion) -> Response {
    let response = exact(model, motion).unwrap();
    let c = check(model, motion, &response);
    assert!(c.holds(), "{what}: {}", figures(&c));
    response
}

/// The files of the far-field suite, two and two of one station.
#[allow(clippy::disallowed_macros, reason = "tests say what they skip on their own output")]
fn far_field(test: &str) -> Vec<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/records");
    let folder = std::env::var_os("SLIPSTICK_RECORDS").map_or(beside, PathBuf::from);
    let Ok(files) = std::fs::read_dir(folder.join("motions/fema_p695_far_field")) else {
        println!("skipped: {test}");
        return Vec::new();
    };
    let mut files: Vec<PathBuf> = files.map(|file| file.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|e| e.eq_ignore_ascii_case("at2")));
    files.sort();
    files
}

fn component(file: &Path) -> GroundMotion {
    let bytes = std::fs::read(file).unwrap();
    let name = file.file_name().unwrap().to_string_lossy();
    record::read(&name, &bytes, &Options::default()).unwrap().channels[0].motion().unwrap().unwrap()
}

/// Storeys of the structures under far-field pairs.
const STOREYS: [usize; 3] = [0, 1, 3];

/// Certifies every pair under the structures that are chosen by its number.
fn far_field_pairs(test: &str, structures: impl Fn(usize) -> Vec<usize>) {
    let files = far_field(test);
    for (i, pair) in files.chunks_exact(2).enumerate() {
        let [x, y] = [0, 1].map(|axis| component(&pair[axis]));
        let mut along_y = y.horizontal_m_per_s2().to_vec();
        along_y.resize(x.len(), 0.0);
        let motion = x.with_y(along_y).unwrap();
        for storeys in structures(i) {
            let what = format!("{}, {storeys} storeys", pair[0].display());
            certified(&what, &model(storeys), &motion);
        }
    }
}

/// Each pair under one structure, each structure under every third pair.
#[test]
fn far_field_pairs_are_certified() {
    far_field_pairs("far_field_pairs_are_certified", |i| vec![STOREYS[i % STOREYS.len()]]);
}

#[test]
#[ignore = "minutes: cargo xtask nightly"]
fn far_field_pairs_are_certified_under_every_structure() {
    let test = "far_field_pairs_are_certified_under_every_structure";
    far_field_pairs(test, |_| STOREYS.to_vec());
}

/// A motion along one axis is certified as one in one direction, and what stands still is looked at too.
#[test]
fn motion_along_an_axis_is_certified() {
    let shaking = shaking(3.0, Some(2.0));
    let none = vec![0.0; shaking.len()];
    let [times_s, moves] = [shaking.times_s(), shaking.horizontal_m_per_s2()].map(<[f64]>::to_vec);
    let up = shaking.vertical_m_per_s2().map(<[f64]>::to_vec);
    for storeys in [0, 2] {
        for axis in 0..2 {
            let [x, y] = if axis == 0 { [&moves, &none] } else { [&none, &moves] };
            let motion = GroundMotion::new(times_s.clone(), x.clone(), up.clone());
            let motion = motion.and_then(|motion| motion.with_y(y.clone())).unwrap();
            let model = model(storeys);
            let response = certified(&format!("along axis {axis}"), &model, &motion);
            let mut moved = response.clone();
            let still = if axis == 0 {
                let plane = moved.in_plane.as_mut().unwrap();
                &mut plane.history.as_mut().unwrap().sliding_displacement_m
            } else {
                &mut moved.history.as_mut().unwrap().sliding_displacement_m
            };
            still[77] = 1e-9;
            assert!(check(&model, &motion, &moved).equilibrium_residual > 1e-9);
            let mut wrong = response;
            wrong.in_plane.as_mut().unwrap().axes[1 - axis].peak_friction_force_n = 1e-9;
            assert!(check(&model, &motion, &wrong).demands_error > 1e-9);
        }
    }
}
