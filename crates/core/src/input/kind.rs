//! What a model is one of: its structure and its devices.

use crate::model::{Model, StopKind};

/// What stands on the slider.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum StructureKind {
    #[default]
    Rigid,
    OneStorey,
    Storeys,
    Modes,
}

/// Models of one kind are solved in the same way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct ModelKind {
    pub(crate) structure: StructureKind,
    /// Contents, surfaces in series, friction by speed, tilt.
    has: [bool; 4],
    /// Whether its stop is rigid, where it has one.
    rigid_stop: Option<bool>,
}

impl ModelKind {
    /// That of a model.
    pub(crate) fn of(model: &Model) -> Self {
        let slider = model.slider();
        Self {
            structure: match (model.structure().is_some(), model.storeys()) {
                (true, _) => StructureKind::Modes,
                (false, 0) => StructureKind::Rigid,
                (false, 1) => StructureKind::OneStorey,
                _ => StructureKind::Storeys,
            },
            has: [
                !model.contents().is_empty(),
                slider.series().is_some(),
                slider.rate().is_some(),
                slider.tilt_rad != 0.0 || slider.tilt_y_rad != 0.0,
            ],
            rigid_stop: model.stop().map(|stop| matches!(stop.kind, StopKind::Rigid { .. })),
        }
    }
}
