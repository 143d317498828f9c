//! Frames as structures by their modes.

use slipstick::model::{
    AlongY, Block, Damping, InitialState, ModeInPlane, Model, Structure, StructureMode,
    StructurePoint,
};

use super::eigen::modes_of;

/// A structure of such modes; along x alone those that take part there.
pub fn structure_of(
    mass_kg: f64,
    in_plane: Vec<ModeInPlane>,
    points: Vec<StructurePoint>,
) -> Structure {
    let along_x = in_plane.iter().filter(|mode| mode.participation[0] != 0.0);
    let modes = along_x.map(|mode| StructureMode {
        frequency_rad_per_s: mode.frequency_rad_per_s,
        damping_ratio: mode.damping_ratio,
        effective_mass_kg: mode.participation[0] * mode.participation[0],
        points: mode.points.iter().map(|shape| shape[0] * mode.participation[0]).collect(),
    });
    Structure { mass_kg, modes: modes.collect(), in_plane, points }
}

/// The same model with its frame as modes.
pub fn by_modes(model: &Model) -> Model {
    let (frame, y) = (model.frame(), model.along_y());
    let m = &frame.masses_kg;
    let axes = [
        (&frame.stiffnesses_n_per_m, &frame.damping, model.initial().clone()),
        (&y.stiffnesses_n_per_m, &y.damping, y.initial.clone()),
    ];
    let mut all = Vec::new();
    for (axis, (k, damping, initial)) in axes.into_iter().enumerate() {
        for (omega, shape) in modes_of(m, k) {
            let l: f64 = shape.iter().zip(m).map(|(phi, m)| phi * m).sum();
            let damping_ratio = match damping {
                Damping::Ratio(ratio) => *ratio,
                Damping::Dampers(c) => c[0] / (2.0 * m[0] * omega),
            };
            let along = |x: f64| if axis == 0 { [x, 0.0] } else { [0.0, x] };
            let amplitude = |x: &Option<Vec<f64>>| -> f64 {
                let given = x.iter().flatten().zip(&shape).zip(m);
                given.map(|((x, phi), m)| x * phi * m).sum::<f64>() / l.abs()
            };
            let start = [&initial.storey_displacement_m, &initial.storey_velocity_m_per_s];
            let mode = ModeInPlane {
                frequency_rad_per_s: omega,
                damping_ratio,
                participation: along(l),
                points: shape.iter().map(|phi| along(*phi)).collect(),
            };
            all.push((mode, start.map(amplitude)));
        }
    }
    all.sort_by(|a, b| a.0.frequency_rad_per_s.total_cmp(&b.0.frequency_rad_per_s));
    let mut height_m = 0.0;
    let points = (0..m.len()).map(|i| StructurePoint {
        name: format!("floor {}", i + 1),
        height_m: frame.heights_m.as_ref().map(|heights_m| {
            height_m += heights_m[i];
            height_m
        }),
        mass_kg: Some(m[i]),
    });
    let points = points.collect();
    let start = |which: usize| Some(all.iter().map(|(_, start)| start[which]).collect());
    let initial_y = InitialState {
        storey_displacement_m: start(0),
        storey_velocity_m_per_s: start(1),
        ..y.initial.clone()
    };
    let in_plane = all.into_iter().map(|(mode, _)| mode).collect();
    let structure = structure_of(m.iter().sum(), in_plane, points);
    let initial = InitialState {
        storey_displacement_m: None,
        storey_velocity_m_per_s: None,
        ..model.initial().clone()
    };
    with_structure(model, structure, initial, initial_y)
}

pub fn with_structure(
    like: &Model,
    structure: Structure,
    initial: InitialState,
    initial_y: InitialState,
) -> Model {
    let along_y = AlongY {
        stiffnesses_n_per_m: Vec::new(),
        damping: Damping::Ratio(0.0),
        width_m: like.along_y().width_m,
        initial: initial_y,
    };
    let block = Block { mass_kg: like.bare_block_kg(), ..*like.block() };
    Model::with_modes(block, like.slider().clone(), structure, like.gravity_m_per_s2(), initial)
        .and_then(|model| model.with_along_y(along_y))
        .expect("a structure")
}

/// Modes that move along x and y at once: those of the frame at an angle, of which some are cut, so that what moves
/// with the block is not as much along x as along y and joins both.
pub fn cut_and_turned(model: &Model, kept: usize, angle: f64) -> Model {
    let whole = by_modes(model);
    let mut structure = whole.structure().expect("modes").clone();
    structure.in_plane.truncate(kept);
    let turn = turned(angle);
    for mode in &mut structure.in_plane {
        mode.participation = turn(mode.participation);
        mode.points.iter_mut().for_each(|shape| *shape = turn(*shape));
    }
    let structure = structure_of(structure.mass_kg, structure.in_plane, structure.points);
    with_structure(&whole, structure, InitialState::rest(), InitialState::rest())
}

pub fn turned(angle: f64) -> impl Fn([f64; 2]) -> [f64; 2] {
    let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
    move |[x, y]| [cosine * x - sine * y, sine * x + cosine * y]
}
