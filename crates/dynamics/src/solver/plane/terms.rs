//! Which terms of a series are rounding.

use super::nodes::NODES;
use super::series::{Kind, PlaneSeries};
use super::system::State;
use super::vector::norm;
use crate::linear::polynomial::Polynomial;

/// A term of a series is left out where it is below this part of its scale.
pub(super) const NEGLIGIBLE: f64 = 1e-17;

/// Terms of a series that say how large it is.
const LOW: usize = 6;

/// The least degree of a series: that of a velocity under a force by its values at the nodes, or what says how large it
/// is.
pub(super) fn lowest(kind: Kind) -> usize {
    if kind == Kind::Slip { NODES } else { LOW }
}

/// Largest sizes so far, against which terms are negligible.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Scales {
    pub(super) s: f64,
    pub(super) w: f64,
    pub(super) eta: f64,
    pub(super) rate: f64,
}

impl Scales {
    /// With those of a state.
    pub(super) fn note(&mut self, state: &State) {
        self.s = self.s.max(norm(state.s));
        self.w = self.w.max(norm(state.w));
        self.eta = largest(&state.eta, self.eta);
        self.rate = largest(&state.rate, self.rate);
    }
}

/// Against what the terms of a series are negligible: the largest so far, and its own first terms.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sizes {
    s: f64,
    of_velocity: f64,
    push: f64,
    eta: f64,
    rate: f64,
    is_known: bool,
    /// The last order looked at, and its term.
    last: Option<(usize, f64)>,
}

impl Sizes {
    pub(super) fn of(series: &PlaneSeries, scales: &Scales) -> Self {
        let first = |c: &[Polynomial; 2], scale: f64| {
            (0..LOW).fold(scale, |scale, k| scale.max(c[0][k].abs()).max(c[1][k].abs()))
        };
        let modes = series.modes;
        let of_modes = |list: &[f64], scale: f64| largest(&list[..LOW * modes], scale);
        let is_stuck = series.kind == Kind::Stick;
        let push = |k: usize| series.push_squared(k);
        Self {
            s: first(&series.s, scales.s),
            of_velocity: first(&series.w, scales.w),
            push: if is_stuck { (0..LOW).fold(0.0, |all, k| push(k).max(all)) } else { 1.0 },
            eta: of_modes(&series.eta, scales.eta),
            rate: of_modes(&series.rate, scales.rate),
            is_known: true,
            last: None,
        }
    }

    /// The largest term of an order over its size.
    pub(super) fn term(&self, series: &PlaneSeries, k: usize) -> f64 {
        let over = |term: f64, size: f64| if term == 0.0 { 0.0 } else { term / size };
        let pair = |c: &[Polynomial; 2], size: f64| over(c[0][k].abs().max(c[1][k].abs()), size);
        let of_kind = match series.kind {
            Kind::Stick => over(series.push_squared(k), self.push),
            Kind::Frictionless | Kind::Slip => pair(&series.w, self.of_velocity),
        };
        let at = k * series.modes..(k + 1) * series.modes;
        let of_modes = over(largest(&series.eta[at.clone()], 0.0), self.eta)
            .max(over(largest(&series.rate[at], 0.0), self.rate));
        of_kind.max(pair(&series.s, self.s)).max(of_modes)
    }

    /// Whether an order and the one before it are negligible.
    #[inline(always)]
    pub(super) fn are_negligible(
        &mut self,
        series: &PlaneSeries,
        scales: &Scales,
        k: usize,
    ) -> bool {
        if !self.is_known {
            *self = Self::of(series, scales);
        }
        let before = match self.last {
            Some((order, term)) if order + 1 == k => term,
            _ => self.term(series, k - 1),
        };
        let term = self.term(series, k);
        self.last = Some((k, term));
        term <= NEGLIGIBLE && before <= NEGLIGIBLE
    }
}

/// The largest size in a list, or what is larger.
fn largest(list: &[f64], from: f64) -> f64 {
    list.iter().fold(from, |all, x| if x.abs() > all { x.abs() } else { all })
}
