//! Slip from rest.

use super::mass::{Mass, times};
use super::series::{Along, Series, convolved};
use super::system::System;
use super::vector::{cross, inner, norm};
use crate::linear::polynomial::{DEGREE, Polynomial};

impl Series {
    /// `u` of a slip from rest, with `e₁ = p_0/|p_0|`, `u = c e₁ + s e₂`, `w = r u`:
    ///
    /// ```text
    /// across   (k+1) (r s)_{k+1} = p₂_k − (f s)_k      s_k is on both sides: its factor is f + (k+1) r_1
    /// along    c² + s² = 1,  r = w·u
    /// ```
    ///
    /// It is convergent for `|p| > f`, where `r_1 = |p| − f`. For `|p| = f`, `r_1 = 0`, the direction is slaved
    /// to that of `p`, and the series asymptotic.
    pub(super) fn find_start(&mut self, system: &System, along: &mut Along, k: usize) {
        let h = self.unit;
        let push = [0, 1].map(|axis| self.pull[axis][k] - self.table(axis, k));
        if k == 0 {
            self.find_slowing(system, 0);
            let (size, f) = (norm(push), self.slowing[0]);
            let e = if size > 0.0 { push.map(|p| p / size) } else { [1.0, 0.0] };
            along.axes = [e, [-e[1], e[0]]];
            (along.cosine[0], self.speed[1]) = (1.0, h * beyond(size, f));
        } else {
            for (w, e) in along.w.iter_mut().zip(along.axes) {
                w[k] = inner([self.w[0][k], self.w[1][k]], e);
            }
            let (c, s) = (&along.cosine, &along.sine);
            // r_k = Σ_{0<j≤k} (w₁_j c_{k−j} + w₂_j s_{k−j})
            let [w1, w2] = &along.w;
            if k > 1 {
                self.speed[k] = convolved(&w1[1..=k], &c[..k]) + convolved(&w2[1..=k], &s[..k]);
            }
            self.find_slowing(system, k);
            let (r, f) = (&self.speed, &self.slowing);
            let turns = (k + 1) as f64 / h;
            let known = if k > 1 { convolved(&r[2..=k], &s[1..k]) } else { 0.0 };
            let across = inner(push, along.axes[1]) - convolved(&f[1..=k], &s[..k]) - turns * known;
            let factor = f[0] + turns * r[1];
            let s_k = if across == 0.0 { 0.0 } else { across / factor };
            let within = |p: &Polynomial| if k > 1 { convolved(&p[1..k], &p[1..k]) } else { 0.0 };
            let c_k = -0.5 * (within(c) + within(s));
            (along.sine[k], along.cosine[k]) = (s_k, c_k);
        }
        let [e1, e2] = along.axes;
        for axis in 0..2 {
            self.direction[axis][k] = along.cosine[k] * e1[axis] + along.sine[k] * e2[axis];
        }
    }
}

impl Series {
    /// The same of a block with a mass in each direction, `e₁ = u_0`: coefficient `k` of
    ///
    /// ```text
    /// Ĉ (r u)' + f u = p
    /// ```
    ///
    /// tells `s_k` and `r_{k+1}`, whose factors `(f + (k+1) r_1 Ĉ) e₂` and `(k+1) Ĉ e₁` are never along one line.
    pub(super) fn find_start_of(
        &mut self,
        system: &System,
        mass: &Mass,
        along: &mut Along,
        k: usize,
    ) {
        let h = self.unit;
        let push = self.push(system, k);
        self.find_slowing(system, k);
        let f = &self.slowing;
        if k == 0 {
            let size = norm(push);
            let (e, rate) = match beyond(size, f[0]) {
                _ if size == 0.0 => ([1.0, 0.0], 0.0),
                0.0 => (push.map(|p| p / size), 0.0),
                _ => mass.departure(push, f[0]),
            };
            along.axes = [e, [-e[1], e[0]]];
            (along.cosine[0], self.speed[1]) = (1.0, h * rate);
        } else {
            let (c, s) = (&along.cosine, &along.sine);
            let within = |p: &Polynomial| if k > 1 { convolved(&p[1..k], &p[1..k]) } else { 0.0 };
            let c_k = -0.5 * (within(c) + within(s));
            let (r, turns) = (&self.speed, (k + 1) as f64 / h);
            // What is known of r u and f u, along e₁ and e₂.
            let known = |list: &Polynomial| {
                let of_f = convolved(&f[1..=k], &list[..k]);
                let of_r = if k > 1 { convolved(&r[2..=k], &list[1..k]) } else { 0.0 };
                [of_f, turns * of_r]
            };
            let ([f1, r1], [f2, r2]) = (known(c), known(s));
            let [e1, e2] = along.axes;
            let of_r = [r1 + turns * r[1] * c_k, r2];
            let of_f = [f1 + f[0] * c_k, f2];
            let placed = |x: [f64; 2]| [0, 1].map(|axis| x[0] * e1[axis] + x[1] * e2[axis]);
            let (moved, taken) = (times(&mass.relative, placed(of_r)), placed(of_f));
            let rest = [0, 1].map(|axis| push[axis] - moved[axis] - taken[axis]);
            let [g1, g2] = [e1, e2].map(|e| times(&mass.relative, e));
            let of_sine = [0, 1].map(|axis| f[0] * e2[axis] + turns * r[1] * g2[axis]);
            let of_speed = g1.map(|x| turns * x);
            let per = 1.0 / cross(of_speed, of_sine);
            (along.cosine[k], along.sine[k]) = (c_k, cross(of_speed, rest) * per);
            if k < DEGREE {
                self.speed[k + 1] = cross(rest, of_sine) * per;
            }
        }
        let [e1, e2] = along.axes;
        for axis in 0..2 {
            self.direction[axis][k] = along.cosine[k] * e1[axis] + along.sine[k] * e2[axis];
        }
    }
}

/// `|p| − f`, nothing where that is rounding.
fn beyond(push: f64, friction: f64) -> f64 {
    let excess = push - friction;
    if excess > 1e-13 * friction { excess } else { 0.0 }
}
