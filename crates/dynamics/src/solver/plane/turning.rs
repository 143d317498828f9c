//! The motion near rest of a block with a mass in each direction: by powers of `τ`, `dt = |w| dτ`, with `w = r u`.
//!
//! ```text
//! q = C (p − f u)    r' = r (u·q)    u' = q − u (u·q)    t' = r    s' = r² u    η' = r η̇    η̇' = −r (g + Lᵀ b)
//! ```
//!
//! Nothing is singular at `w = 0`, which is `τ → ∞`. The root of `w`, by which one mass goes farther in a step, is of
//! no use here: `C w` is no product with it.

use super::series::{Kind, Series, product};
use super::system::{Loads, State, System};
use super::terms::Scales;
use super::vector::norm;
use crate::linear::polynomial::{DEGREE, ZERO};

impl Series {
    /// Expands by powers of `τ`.
    pub(super) fn expand_turning(
        &mut self,
        system: &System,
        state: &State,
        (loads, unit): (Loads, f64),
        scales: &Scales,
        sums: &mut [f64],
    ) {
        self.begin(Kind::Turning, state, loads, unit);
        let speed = norm(state.w);
        self.speed[0] = speed;
        for axis in 0..2 {
            self.direction[axis][0] = state.w[axis] / speed;
        }
        let (mut rate, mut growth, mut block) = ([ZERO; 2], ZERO, [ZERO; 2]);
        for k in 0..=DEGREE {
            let per = unit / (k + 1) as f64;
            self.restore(system, k);
            for axis in 0..2 {
                self.w[axis][k] = product(&self.speed, &self.direction[axis], k);
            }
            self.find_slowing(system, k);
            let time = self.time[k];
            for axis in 0..2 {
                self.pull[axis][k] = self.pull_of(system, axis, k);
                self.friction[axis][k] = self.slowed(system, &self.direction[axis], k);
            }
            let force = [0, 1].map(|axis| self.pull[axis][k] - self.friction[axis][k]);
            let moved = system.moved(force);
            for axis in 0..2 {
                let [table, slope] = loads.table[axis];
                block[axis][k] = moved[axis];
                rate[axis][k] = moved[axis] - (slope * time + if k == 0 { table } else { 0.0 });
            }
            if k == DEGREE {
                break;
            }
            let [x, y] = &self.direction;
            growth[k] = product(x, &rate[0], k) + product(y, &rate[1], k);
            let turned = [x, y].map(|u| product(u, &growth, k));
            for axis in 0..2 {
                self.direction[axis][k + 1] = per * (rate[axis][k] - turned[axis]);
                self.s[axis][k + 1] = per * product(&self.speed, &self.w[axis], k);
            }
            self.speed[k + 1] = per * product(&self.speed, &growth, k);
            self.time[k + 1] = per * self.speed[k];
            let carried = block.each_ref().map(|block| product(&self.speed, block, k));
            self.integrate_modes(system, k, (per, carried), sums);
        }
        self.degree = DEGREE;
        self.part = self.fitting_part(scales).min(1.0);
    }
}
