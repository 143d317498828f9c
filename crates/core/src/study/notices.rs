//! What is noticed of a model and the motion under it, before anything is run.

use crate::model::shear_frame_frequencies;
use crate::model::{Damping, Model};
use crate::motion::GroundMotion;
use crate::notice::{Notice, NoticeKind};

/// Nyquist frequencies of the motion in the highest mode of a model that has a rigid link in it.
const RIGID_LINK: f64 = 100.0;

/// Coefficient of friction above which it is said that it is high.
const HIGH_FRICTION: f64 = 0.5;

/// Radius below which it is said that it is small, in m.
const SMALL_RADIUS_M: f64 = 0.05;

/// Damping ratio of the storeys above which it is said that it is high.
const HIGH_DAMPING: f64 = 0.3;

/// Factors on records between which nothing is said of them: FEMA P-1050 and the guidance on ground motions to
/// ASCE/SEI 7.
pub const USUAL_FACTORS: core::ops::RangeInclusive<f64> = 0.25..=4.0;

/// Values that are possible and hardly meant.
pub(crate) fn suspicious(model: &Model) -> Vec<Notice> {
    let coefficient = model.static_friction().into_iter().fold(0.0, f64::max);
    let of_modes = model
        .structure()
        .map(|structure| structure.modes.iter().map(|mode| mode.damping_ratio).fold(0.0, f64::max));
    let ratio = match model.frame().damping {
        _ if of_modes.is_some() => of_modes.unwrap_or(0.0),
        Damping::Ratio(ratio) if model.storeys() > 0 => ratio,
        _ => 0.0,
    };
    let high_friction = (coefficient > HIGH_FRICTION).then(|| {
        let message = format!(
            "the static friction is {coefficient}: above {HIGH_FRICTION} nothing is made to slide; \
             was percent meant?"
        );
        Notice::new(NoticeKind::HighFriction, message)
    });
    let high_damping = (ratio > HIGH_DAMPING).then(|| {
        let message = format!(
            "the storeys' damping ratio is {ratio}: above {HIGH_DAMPING} is no structure's; was \
             percent meant?"
        );
        Notice::new(NoticeKind::HighDamping, message)
    });
    [high_friction, high_damping, small_radius(model), inner_friction(model), missing_mass(model)]
        .into_iter()
        .flatten()
        .collect()
}

/// Part of the mass that modes must have without a warning, and without a word.
const ENOUGH_MODES: f64 = 0.9;
const ALL_MODES: f64 = 1.0 - 1e-6;

/// What the modes of a structure lack of its mass; in two directions along the axis along which they lack more.
fn missing_mass(model: &Model) -> Option<Notice> {
    let structure = model.structure()?;
    let along_x = (structure.missing_mass_kg(), "");
    let in_plane = model.is_in_plane() && !structure.in_plane.is_empty();
    let [_, [_, of_y]] = structure.mass_in_plane_kg();
    let missing_y_kg = (structure.mass_kg - of_y).max(0.0);
    let (missing_kg, axis) = match in_plane {
        true if missing_y_kg > along_x.0 => (missing_y_kg, " along y"),
        true => (along_x.0, " along x"),
        false => along_x,
    };
    let found = 1.0 - missing_kg / structure.mass_kg;
    let kind = match found {
        found if found < ENOUGH_MODES => NoticeKind::MissingModes,
        found if found < ALL_MODES => NoticeKind::MissingMass,
        _ => return None,
    };
    let more = if found < ENOUGH_MODES { "; below 90 % more modes are needed" } else { "" };
    let message = format!(
        "the modes have {:.4} % of the structure's mass{axis}; the rest, {:.4} % or {} kg, moves with the \
         block{more}",
        100.0 * found,
        100.0 - 100.0 * found,
        missing_kg.round()
    );
    Some(Notice::new(kind, message))
}

/// A radius that no slider has.
fn small_radius(model: &Model) -> Option<Notice> {
    let least_m =
        model.slider().radii_m().fold(f64::INFINITY, |least, (_, radius_m)| least.min(radius_m));
    (least_m < SMALL_RADIUS_M).then(|| {
        let message = format!(
            "a radius is {least_m} m: below {SMALL_RADIUS_M} m is no pendulum slider's; were metres meant?"
        );
        Notice::new(NoticeKind::SmallRadius, message)
    })
}

/// A surface of a smaller radius that holds longer than one of a larger: inner surfaces are made to slide
/// first.
fn inner_friction(model: &Model) -> Option<Notice> {
    let surfaces = model.slider().surfaces();
    let curved = || surfaces.iter().filter_map(|on| Some((on.radius_m?, on.friction)));
    let (inner, outer) = curved().find_map(|inner| {
        let outer = curved().find(|outer| inner.0 < outer.0 && inner.1 > outer.1)?;
        Some((inner, outer))
    })?;
    Some(Notice::new(
        NoticeKind::InnerFrictionHigh,
        format!(
            "the surface of radius {} m has the friction {}, that of {} m only {}: inner surfaces are \
             made to slide first; were the surfaces written in another order?",
            inner.0, inner.1, outer.0, outer.1
        ),
    ))
}

/// Frequency of the highest mode, or of the block on its spring, in Hz.
pub(crate) fn highest_hz(model: &Model) -> f64 {
    let frame = model.frame();
    let of_frame = match model.structure() {
        Some(structure) => structure.modes.iter().map(|mode| mode.frequency_rad_per_s).collect(),
        None => shear_frame_frequencies(&frame.masses_kg, &frame.stiffnesses_n_per_m),
    };
    let of_slider = (model.slider_stiffness_n_per_m() / model.total_mass_kg()).sqrt();
    of_frame.into_iter().fold(of_slider, f64::max) / (2.0 * core::f64::consts::PI)
}

/// Longest step of a motion, in s.
pub(crate) fn longest_step_s(motion: &GroundMotion) -> f64 {
    let longest_s = || motion.times_s().windows(2).map(|t| t[1] - t[0]).fold(0.0, f64::max);
    motion.dt_s().unwrap_or_else(longest_s)
}

/// Samples further apart than a tenth of the shortest period say little of the highest mode.
pub(crate) fn coarse_sampling(highest_hz: f64, longest_step_s: f64) -> Option<Notice> {
    let nyquist_hz = 0.5 / longest_step_s;
    let rigid = match highest_hz > RIGID_LINK * nyquist_hz {
        true => "; a storey or spring as stiff as that is a rigid link: leave it out",
        false => "",
    };
    (nyquist_hz < 5.0 * highest_hz).then(|| {
        let message = format!(
            "the Nyquist frequency of the motion, {nyquist_hz:.4} Hz, is below 5 times the highest \
             mode, {highest_hz:.4} Hz: the motion may lack what excites that mode{rigid}"
        );
        Notice::new(NoticeKind::CoarseSampling, message)
    })
}
