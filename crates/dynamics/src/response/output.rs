//! The outputs: every number of the motion of which the analysis reports a peak.
//!
//! Solver and check each say in one place what an output is; here stand only their names and their order in lists.

/// Places of the outputs that every model has.
pub(crate) const VELOCITY: usize = 0;
pub(crate) const BLOCK: usize = 1;
pub(crate) const SLIDER: usize = 2;
pub(crate) const FRICTION: usize = 3;
pub(crate) const BASE_SHEAR: usize = 4;
pub(crate) const OVERTURNING: usize = 5;
/// How many these are.
pub(crate) const OF_BLOCK: usize = 6;

/// An output; points are floors, or those of a structure by its modes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Output {
    /// `ṡ` in m/s.
    Velocity,
    /// Total acceleration of the block less the slope's pull, in m/s².
    Block,
    /// All that passes from the table to the block, in N.
    SliderForce,
    /// `T` in N.
    FrictionForce,
    /// Base shear of the structure in N.
    BaseShear,
    /// Overturning moment about the sliding surface in N m.
    Overturning,
    /// Displacement of a point over the block in m.
    Displacement(usize),
    /// Total acceleration of a point less the slope's pull, in m/s².
    Acceleration(usize),
    /// Displacement of a point over the one before it in m; of the first that over the block.
    Drift(usize),
    /// Velocity of a point over the one before it in m/s; of the first that over the block.
    DriftVelocity(usize),
    /// Shear between a point and the one before it in N; of the first the base shear.
    StoreyShear(usize),
    /// Sliding velocity of contents in m/s.
    ContentsVelocity(usize),
    /// Total acceleration of contents less the slope's pull, in m/s².
    ContentsAcceleration(usize),
}

impl Output {
    /// Its place in the list of all outputs of a model with so many points.
    #[inline(always)]
    pub(crate) const fn place(self, points: usize) -> usize {
        let of_contents = Self::count(points, 0);
        match self {
            Self::Velocity => VELOCITY,
            Self::Block => BLOCK,
            Self::SliderForce => SLIDER,
            Self::FrictionForce => FRICTION,
            Self::BaseShear => BASE_SHEAR,
            Self::Overturning => OVERTURNING,
            Self::Displacement(i) => OF_BLOCK + i,
            Self::Acceleration(i) => OF_BLOCK + points + i,
            // The drift of the first point is its displacement.
            Self::Drift(0) => OF_BLOCK,
            Self::Drift(i) => OF_BLOCK + 2 * points + i - 1,
            Self::DriftVelocity(i) => OF_BLOCK + 2 * points + points.saturating_sub(1) + i,
            Self::StoreyShear(0) => BASE_SHEAR,
            Self::StoreyShear(i) => OF_BLOCK + 3 * points + points.saturating_sub(1) + i - 1,
            Self::ContentsVelocity(e) => of_contents + 2 * e,
            Self::ContentsAcceleration(e) => of_contents + 2 * e + 1,
        }
    }

    /// How many a model has with so many points and contents.
    #[inline(always)]
    pub(crate) const fn count(points: usize, contents: usize) -> usize {
        OF_BLOCK + 3 * points + 2 * points.saturating_sub(1) + 2 * contents
    }

    /// All of them in the order of their places.
    pub(crate) fn all(points: usize, contents: usize) -> impl Iterator<Item = Self> {
        let of_block = [
            Self::Velocity,
            Self::Block,
            Self::SliderForce,
            Self::FrictionForce,
            Self::BaseShear,
            Self::Overturning,
        ];
        let of_contents = |e| [Self::ContentsVelocity(e), Self::ContentsAcceleration(e)];
        of_block
            .into_iter()
            .chain((0..points).map(Self::Displacement))
            .chain((0..points).map(Self::Acceleration))
            .chain((1..points).map(Self::Drift))
            .chain((0..points).map(Self::DriftVelocity))
            .chain((1..points).map(Self::StoreyShear))
            .chain((0..contents).flat_map(of_contents))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outputs_stand_in_the_order_of_their_places() {
        for (points, contents) in [(0, 0), (1, 0), (1, 2), (5, 0), (5, 3)] {
            let places: Vec<usize> =
                Output::all(points, contents).map(|output| output.place(points)).collect();
            let count = Output::count(points, contents);
            assert_eq!(places, (0..count).collect::<Vec<usize>>());
        }
        assert_eq!(Output::Drift(0).place(3), Output::Displacement(0).place(3));
        assert_eq!(Output::StoreyShear(0).place(3), Output::BaseShear.place(3));
    }
}
