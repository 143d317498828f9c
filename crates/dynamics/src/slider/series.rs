//! Sliding surfaces in series: double and triple pendulums.
//!
//! Parts between the surfaces have no mass, so one force `F = N φ` passes through all. A surface
//! follows `φ ∈ u/R + μ Sgn(u̇)` with `|u| ≤ d`, and `s = Σ u`. What slides is the surface, or all of
//! those, at which the force needed is least.

use super::Direction;
use super::friction::check_factor;
use super::ranges::{in_range, optional_positive, positive};
use crate::error::ModelError;

/// One of the surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Radius in m; none of a flat one.
    pub radius_m: Option<f64>,
    /// Kinetic coefficient of friction.
    pub friction: f64,
    /// Displacement at which it reaches its end, in m; none where it has no end.
    pub travel_m: Option<f64>,
}

impl Surface {
    /// `1/R`.
    pub(super) fn curvature(&self) -> f64 {
        self.radius_m.map_or(0.0, |radius_m| 1.0 / radius_m)
    }
}

/// Surfaces in series.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfacesInSeries {
    surfaces: Vec<Surface>,
    static_ratio: f64,
}

/// Displacements of the surfaces where a branch began, and which of them slide.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct SeriesState {
    /// `s` at the beginning of the branch.
    pub from_m: f64,
    /// `u` of each surface there.
    pub displacements_m: Vec<f64>,
    /// Which surfaces slide.
    pub active: Vec<bool>,
}

/// Differences of `φ` below this, over the largest, are none: what slides together stays together.
const ALIKE: f64 = 1e-13;

impl SurfacesInSeries {
    /// Surfaces of which the static friction is `static_ratio` times the kinetic one.
    ///
    /// # Errors
    /// [`ModelError`] unless there is one at least, friction, radii and travels are finite and > 0
    /// and the ratio is ≥ 1.
    pub fn new(surfaces: Vec<Surface>, static_ratio: f64) -> Result<Self, ModelError> {
        if surfaces.is_empty() {
            let expected = "one surface at least";
            return Err(ModelError::Missing { quantity: "surface", expected });
        }
        for surface in &surfaces {
            positive("surface friction", surface.friction)?;
            optional_positive("surface radius_m", surface.radius_m)?;
            optional_positive("surface travel_m", surface.travel_m)?;
        }
        let is_within = static_ratio.is_finite() && static_ratio >= 1.0;
        in_range("static_ratio", "a finite number ≥ 1", static_ratio, is_within)?;
        Ok(Self { surfaces, static_ratio })
    }

    /// The surfaces.
    #[must_use]
    pub fn surfaces(&self) -> &[Surface] {
        &self.surfaces
    }

    /// Static over kinetic friction.
    #[must_use]
    pub fn static_ratio(&self) -> f64 {
        self.static_ratio
    }

    /// These surfaces with all coefficients of friction times `factor`.
    ///
    /// # Errors
    /// [`ModelError::OutOfRange`] unless the factor is finite and ≥ 0.
    pub fn scaled(&self, factor: f64) -> Result<Self, ModelError> {
        check_factor(factor)?;
        let scaled = |s: &Surface| Surface { friction: factor * s.friction, ..*s };
        Ok(Self { surfaces: self.surfaces.iter().map(scaled).collect(), ..*self })
    }

    /// Largest `|s|`, where all surfaces have an end.
    #[must_use]
    pub fn travel_m(&self) -> Option<f64> {
        self.surfaces.iter().map(|surface| surface.travel_m).sum()
    }

    /// Least kinetic coefficient: that at which the whole begins to slide.
    #[must_use]
    pub fn least_friction(&self) -> f64 {
        self.surfaces.iter().fold(f64::INFINITY, |least, surface| least.min(surface.friction))
    }

    /// The surfaces after sliding straight from 0 to `s`, at rest.
    pub(super) fn initial(&self, s: f64) -> SeriesState {
        let count = self.surfaces.len();
        let mut state = SeriesState {
            from_m: 0.0,
            displacements_m: vec![0.0; count],
            active: vec![false; count],
        };
        let direction = if s < 0.0 { Direction::Negative } else { Direction::Positive };
        for _ in 0..4 * count {
            if s == state.from_m {
                break;
            }
            self.begin(&mut state, direction);
            let next = self.next_level(&state, direction);
            let ahead = |level: f64| direction.sign() * (s - level) > 0.0;
            match next.filter(|level| ahead(*level)) {
                Some(level) => self.reach(&mut state, level, direction),
                None => {
                    self.settle(&mut state, s);
                    break;
                }
            }
            if !state.active.contains(&true) {
                break;
            }
        }
        state.active.fill(false);
        state
    }

    /// `σ u / R + μ` of a surface: the `σ φ` at which it slides.
    fn threshold(&self, state: &SeriesState, i: usize, direction: Direction) -> f64 {
        let surface = &self.surfaces[i];
        direction.sign() * state.displacements_m[i] * surface.curvature() + surface.friction
    }

    fn at_end(&self, state: &SeriesState, i: usize, direction: Direction) -> bool {
        self.surfaces[i]
            .travel_m
            .is_some_and(|travel_m| direction.sign() * state.displacements_m[i] >= travel_m)
    }

    /// Decides what slides in a direction; whether anything can.
    pub(super) fn begin(&self, state: &mut SeriesState, direction: Direction) -> bool {
        let free = |state: &SeriesState, i: usize| !self.at_end(state, i, direction);
        let thresholds: Vec<f64> =
            (0..self.surfaces.len()).map(|i| self.threshold(state, i, direction)).collect();
        let least = (0..thresholds.len())
            .filter(|&i| free(state, i))
            .map(|i| thresholds[i])
            .fold(f64::INFINITY, f64::min);
        let size = self.surfaces.iter().map(|surface| surface.friction).fold(least.abs(), f64::max);
        for (i, threshold) in thresholds.iter().enumerate() {
            state.active[i] = free(state, i) && *threshold <= least + ALIKE * size;
        }
        least.is_finite()
    }

    /// What each surface takes of a displacement.
    fn shares(&self, state: &SeriesState) -> Vec<f64> {
        let of = |i: usize| if state.active[i] { self.surfaces[i].radius_m } else { Some(0.0) };
        let flat = (0..self.surfaces.len()).filter(|&i| of(i).is_none()).count();
        if flat > 0 {
            return (0..self.surfaces.len())
                .map(|i| if of(i).is_none() { 1.0 / flat as f64 } else { 0.0 })
                .collect();
        }
        let sum: f64 = (0..self.surfaces.len()).filter_map(of).sum();
        (0..self.surfaces.len()).map(|i| of(i).unwrap_or(0.0) / sum).collect()
    }

    /// `φ` at the beginning of the branch and its slope over `s`.
    pub(super) fn force(&self, state: &SeriesState, direction: Direction) -> [f64; 2] {
        let active = || (0..self.surfaces.len()).filter(|&i| state.active[i]);
        let least =
            active().map(|i| self.threshold(state, i, direction)).fold(f64::INFINITY, f64::min);
        let flat = active().any(|i| self.surfaces[i].radius_m.is_none());
        let radii: f64 = active().filter_map(|i| self.surfaces[i].radius_m).sum();
        [direction.sign() * least, if flat { 0.0 } else { 1.0 / radii }]
    }

    /// `s` where another surface joins or one reaches its end.
    pub(super) fn next_level(&self, state: &SeriesState, direction: Direction) -> Option<f64> {
        let shares = self.shares(state);
        let [phi, slope] = self.force(state, direction);
        let held = direction.sign() * phi;
        let of = |i: usize| -> Option<f64> {
            if state.active[i] {
                let left = self.surfaces[i].travel_m? - direction.sign() * state.displacements_m[i];
                return (shares[i] > 0.0).then(|| left / shares[i]);
            }
            if self.at_end(state, i, direction) || slope == 0.0 {
                return None;
            }
            Some((self.threshold(state, i, direction) - held) / slope)
        };
        let ahead = (0..self.surfaces.len()).filter_map(of).reduce(f64::min)?;
        Some(state.from_m + direction.sign() * ahead.max(0.0))
    }

    /// Reaches such a level, and decides what slides from there on.
    pub(super) fn reach(&self, state: &mut SeriesState, level: f64, direction: Direction) {
        self.arrive(state, level, direction);
        self.begin(state, direction);
    }

    /// Makes a level the beginning of a branch; surfaces that have slid to their ends there are at them.
    pub(super) fn arrive(&self, state: &mut SeriesState, level: f64, direction: Direction) {
        self.settle(state, level);
        for (u, surface) in state.displacements_m.iter_mut().zip(&self.surfaces) {
            if let Some(travel_m) = surface.travel_m
                && (direction.sign() * *u - travel_m).abs() <= ALIKE * (travel_m + level.abs())
            {
                *u = direction.sign() * travel_m;
            }
        }
    }

    /// Makes `s` the beginning of a branch; surfaces that have slid in a direction, by less than their
    /// rounding too, are off their ends on the other side.
    pub(super) fn turn(&self, state: &mut SeriesState, s: f64, direction: Direction) {
        self.settle(state, s);
        for (i, surface) in self.surfaces.iter().enumerate() {
            if state.active[i]
                && self.at_end(state, i, direction.opposite())
                && let Some(travel_m) = surface.travel_m
            {
                state.displacements_m[i] = -direction.sign() * travel_m.next_down();
            }
        }
    }

    /// The surfaces at `s` in a branch.
    pub(super) fn displacements(&self, state: &SeriesState, s: f64) -> Vec<f64> {
        let moved = s - state.from_m;
        if moved == 0.0 || !state.active.contains(&true) {
            return state.displacements_m.clone();
        }
        let shares = self.shares(state);
        state.displacements_m.iter().zip(shares).map(|(u, share)| u + share * moved).collect()
    }

    /// Makes `s` the beginning of a branch.
    pub(super) fn settle(&self, state: &mut SeriesState, s: f64) {
        state.displacements_m = self.displacements(state, s);
        state.from_m = s;
    }

    /// The `φ` between which nothing slides.
    pub(super) fn hold(&self, state: &SeriesState) -> [f64; 2] {
        let bound = |direction: Direction| {
            (0..self.surfaces.len())
                .filter(|&i| !self.at_end(state, i, direction))
                .map(|i| {
                    let surface = &self.surfaces[i];
                    direction.sign() * state.displacements_m[i] * surface.curvature()
                        + self.static_ratio * surface.friction
                })
                .fold(f64::INFINITY, f64::min)
        };
        [-bound(Direction::Negative), bound(Direction::Positive)]
    }
}
