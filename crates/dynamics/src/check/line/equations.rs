//! The equations of motion in lanes, with all forces and outputs of an instant. Between two knots all laws but
//! friction by speed are affine with numbers of the lane:
//!
//! ```text
//! T = N (p₀ − p₁ s − p₂ ṡ)                             in a slip, or N p₀ μ(|ṡ|) with friction by speed
//! F = T − (K1 + N/R) s − C1 ṡ − (k s + c ṡ − shift)     with the spring of a pendulum and an elastic stop
//! ```
//!
//! and contents add their mass to a floor that they stick to, or pull at it with `μ m N/M`.

use fearless_simd::f64x8;
use fearless_simd::prelude::*;

use super::super::collocation::NODES;
use super::super::lane::{Eight, all, both, inlined, larger, smaller};
use super::super::outputs::Outputs;
use super::super::structure::StoreyDamping;
use super::group::Group;
use super::knots::LaneJudge;
use super::work::Work;
use crate::numerics::instructions::vectorize;
use crate::response::output::FRICTION;

/// Loads and springs at a part of a step.
#[derive(Clone, Copy)]
pub(super) struct Now<S: Simd> {
    pub(super) a: f64x8<S>,
    /// `N p₀ + shift` in slip, `shift` in stick.
    pub(super) load: f64x8<S>,
    pub(super) rise: f64x8<S>,
    pub(super) part: f64,
}

impl LaneJudge<'_> {
    /// Loads at a part of a step.
    #[inline(always)]
    pub(super) fn at<S: Simd>(&self, simd: S, group: &Group, input: &[Eight], part: f64) -> Now<S> {
        let d = self.structure.degrees();
        let linear = inlined!(|from: &Eight, to: &Eight| {
            let from = from.load(simd);
            from + (to.load(simd) - from) * all(simd, part)
        });
        Now {
            a: linear(&input[2 * d], &input[2 * d + 1]),
            load: linear(&input[2 * d + 2], &input[2 * d + 3]),
            rise: if self.law.follows() {
                linear(&group.rise[0], &group.rise[1])
            } else {
                all(simd, 0.0)
            },
            part,
        }
    }

    /// `μ m N/M` of contents that slide, over their mass, at a part of a step.
    #[inline(always)]
    pub(super) fn pull<S: Simd>(&self, simd: S, input: &[Eight], e: usize, part: f64) -> f64x8<S> {
        let at = 2 * self.structure.degrees() + 4 + 2 * e;
        let from = input[at].load(simd);
        from + (input[at + 1].load(simd) - from) * all(simd, part)
    }

    /// The shear of the lowest storey and the pull of contents that slide on the block.
    #[inline(always)]
    pub(super) fn on_block<S: Simd>(
        &self,
        simd: S,
        now: Now<S>,
        (x, v): (impl Fn(usize) -> f64x8<S> + Copy, impl Fn(usize) -> f64x8<S> + Copy),
        input: &[Eight],
    ) -> [f64x8<S>; 2] {
        let shear =
            self.base_force(simd, inlined!(|j: usize| x(1 + j)), inlined!(|j: usize| v(1 + j)));
        let mut pull = all(simd, 0.0);
        let contents = self.structure.contents.iter().enumerate();
        for (e, contents) in contents.filter(|(_, contents)| contents.floor == 0) {
            pull += all(simd, contents.mass_kg) * self.pull(simd, input, e, now.part);
        }
        [shear, pull]
    }

    /// Accelerations of all bodies in a state: eqs (9), (10). Returns the shear of the lowest storey and
    /// the pull of contents that slide on the block.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)] // an instant
    pub(super) fn accelerate<S: Simd>(
        &self,
        simd: S,
        n: usize,
        group: &Group,
        now: Now<S>,
        (x, v): (impl Fn(usize) -> f64x8<S> + Copy, impl Fn(usize) -> f64x8<S> + Copy),
        input: &[Eight],
        bodies: &mut [Eight],
    ) -> [f64x8<S>; 2] {
        let s = self.structure;
        let [shear, pull] = self.on_block(simd, now, (x, v), input);
        let shift = group.stop[2].load(simd);
        let force = match &self.law.rate {
            Some(_) => self.sliding_force(simd, group, (v(0), now.load - shift), input) + shift,
            None => now.load,
        };
        let spring = all(simd, s.spring) + group.stop[0].load(simd) + now.rise;
        let damper = all(simd, s.damper) + group.stop[1].load(simd);
        let slider = force - damper * v(0) - spring * x(0);
        let sliding = (slider + shear + pull) * group.inverse[0].load(simd);
        let stuck = group.stuck.load(simd).simd_gt(all(simd, 0.0));
        let block = stuck.select(now.a, sliding);
        bodies[0].store(block);
        for k in 0..n {
            // Oscillators of modes stand each on the block, floors on the one below.
            let (lowest, highest) = (k == 0 || s.on_block, k + 1 == n || s.on_block);
            let below = if lowest { all(simd, 0.0) } else { x(k) };
            let mut force = all(simd, s.stiffnesses[k]) * (x(k + 1) - below);
            if !highest {
                let above = x(k + 2) - x(k + 1);
                force -= all(simd, s.stiffnesses[k + 1]) * above;
            }
            match &s.damping {
                StoreyDamping::Chain(c) => {
                    let below = if lowest { all(simd, 0.0) } else { v(k) };
                    force += all(simd, c[k]) * (v(k + 1) - below);
                    if !highest {
                        let above = v(k + 2) - v(k + 1);
                        force -= all(simd, c[k + 1]) * above;
                    }
                }
                StoreyDamping::Full(c) => {
                    for j in 0..n {
                        force += all(simd, c[k * n + j]) * v(1 + j);
                    }
                }
            }
            for (e, contents) in s.contents.iter().enumerate().filter(|(_, c)| c.floor == k + 1) {
                force -= all(simd, contents.mass_kg) * self.pull(simd, input, e, now.part);
            }
            bodies[1 + k].store(-(force * group.inverse[1 + k].load(simd)));
        }
        for (e, contents) in s.contents.iter().enumerate() {
            let under = bodies[contents.floor].load(simd);
            let stuck = group.carried[e].stuck.load(simd).simd_gt(all(simd, 0.0));
            let slides = -self.pull(simd, input, e, now.part);
            bodies[1 + n + e].store(stuck.select(under, slides));
        }
        [shear, pull]
    }

    /// `ẍ` of a degree from the accelerations of all bodies.
    #[inline(always)]
    pub(super) fn rate<S: Simd>(
        &self,
        simd: S,
        (n, k): (usize, usize),
        a: f64x8<S>,
        bodies: &[Eight],
    ) -> f64x8<S> {
        let own = bodies[k].load(simd);
        if k == 0 {
            own - a
        } else if k <= n {
            own - bodies[0].load(simd)
        } else {
            own - bodies[self.structure.contents[k - 1 - n].floor].load(simd)
        }
    }

    /// `T` in a slip at a velocity, of a load of sliding: with friction by speed `μ(|ṡ|)` times it, within a
    /// straight piece less what rises with the velocity.
    #[inline(always)]
    pub(super) fn sliding_force<S: Simd>(
        &self,
        simd: S,
        group: &Group,
        (w, load): (f64x8<S>, f64x8<S>),
        input: &[Eight],
    ) -> f64x8<S> {
        match &self.law.rate {
            None => load,
            Some(_) if group.affine => load - group.drag.load(simd) * w,
            Some(rate) => {
                let near = [input[input.len() - 2].load(simd), input[input.len() - 1].load(simd)];
                load * rate.coefficients(simd, w.abs(), near)
            }
        }
    }

    /// `T`, in stick the demand: eqs (8), (14).
    #[inline(always)]
    #[allow(clippy::too_many_arguments)] // an instant
    pub(super) fn friction<S: Simd>(
        &self,
        simd: S,
        group: &Group,
        now: Now<S>,
        (s, w): (f64x8<S>, f64x8<S>),
        [shear, pull]: [f64x8<S>; 2],
        input: &[Eight],
    ) -> f64x8<S> {
        let structure = self.structure;
        let shift = group.stop[2].load(simd);
        let spring = all(simd, structure.spring) + group.stop[0].load(simd) + now.rise;
        let held = group.mass[0].load(simd) * now.a - shear - pull + spring * s - shift;
        let slid = self.sliding_force(simd, group, (w, now.load - shift), input);
        let slid = if self.law.series.is_some() { slid - now.rise * s } else { slid };
        group.stuck.load(simd).simd_gt(all(simd, 0.0)).select(held, slid)
    }

    /// Accelerations and `T` at the start (0) or the end (1) of a step.
    #[inline(always)]
    pub(super) fn ask<S: Simd>(
        &self,
        simd: S,
        n: usize,
        group: &Group,
        end: usize,
        work: &mut Work,
    ) {
        let d = self.structure.degrees();
        let Work { input, path, bodies, ends, .. } = work;
        let now = self.at(simd, group, input, end as f64);
        let x = inlined!(|k: usize| state_of(input, path, end, k, d).load(simd));
        let v = inlined!(|k: usize| state_of(input, path, end, d + k, d).load(simd));
        let forces = if self.structure.contents.is_empty() {
            self.on_block(simd, now, (x, v), input)
        } else {
            self.accelerate(simd, n, group, now, (x, v), input, bodies)
        };
        let force = self.friction(simd, group, now, (x(0), v(0)), forces, input);
        ends[end][FRICTION].store(force);
    }

    /// The outputs at the start (0) or the end (1) of a step, from the equations.
    pub(super) fn end(&self, (group, end): (&Group, usize), outputs: &Outputs, work: &mut Work) {
        vectorize!(self.instructions, simd => self.end_of(simd, (group, end), outputs, work));
    }

    #[inline(always)]
    fn end_of<S: Simd>(
        &self,
        simd: S,
        (group, end): (&Group, usize),
        outputs: &Outputs,
        work: &mut Work,
    ) {
        let (d, n) = (self.structure.degrees(), self.structure.masses_kg.len());
        let Work { input, path, bodies, ends, .. } = work;
        let now = self.at(simd, group, input, end as f64);
        let x = inlined!(|k: usize| state_of(input, path, end, k, d).load(simd));
        let v = inlined!(|k: usize| state_of(input, path, end, d + k, d).load(simd));
        self.outputs(
            simd,
            n,
            (group, outputs, now),
            (x, v),
            input,
            bodies,
            inlined!(|g: usize, value: f64x8<S>| ends[end][g].store(value)),
        );
    }

    /// Hands on the outputs of a state under loads, its rates from the equations: what cancels in them is
    /// nothing. Against a rigid stop friction takes what it can of the demand, the stop the rest.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)] // an instant
    pub(super) fn outputs<S: Simd>(
        &self,
        simd: S,
        n: usize,
        (group, outputs, now): (&Group, &Outputs, Now<S>),
        (x, v): (impl Fn(usize) -> f64x8<S> + Copy, impl Fn(usize) -> f64x8<S> + Copy),
        input: &[Eight],
        bodies: &mut [Eight],
        out: impl FnMut(usize, f64x8<S>),
    ) {
        let structure = self.structure;
        let forces = self.accelerate(simd, n, group, now, (x, v), input, bodies);
        let asked = self.friction(simd, group, now, (x(0), v(0)), forces, input);
        let body = inlined!(|k: usize| bodies[k].load(simd));
        let [stiffness, damper] = both!(|i| group.stop[i].load(simd));
        let shift = group.stop[2].load(simd);
        let mut stop = stiffness * x(0) + damper * v(0) - shift;
        let restoring = if self.law.series.is_some() { all(simd, 0.0) } else { now.rise };
        let spring = (all(simd, structure.spring) + restoring) * x(0);
        let slider = asked - (spring + all(simd, structure.damper) * v(0)) - stop;
        let mut friction = asked;
        if self.law.restitution().is_some() {
            let [low, high] = both!(|i| {
                let [from, to] = both!(|end| group.normal[end].load(simd));
                group.taken[i].load(simd) * (from + (to - from) * all(simd, now.part))
            });
            friction = smaller(larger(asked, low), high);
            stop += friction - asked;
        }
        outputs.each(
            [v(0), slider, friction, forces[0], stop],
            (self.slope, body(0)),
            inlined!(|i: usize| {
                let (x, a) = (inlined!(|j: usize| x(1 + j)), inlined!(|j: usize| body(1 + j)));
                outputs.point(i, body(0), x, a)
            }),
            inlined!(|e: usize| [v(1 + n + e), body(1 + n + e)]),
            out,
        );
    }
}

/// An entry of the state at the start of a path (0) or at its end (1).
#[inline(always)]
pub(super) fn state_of(
    input: &[Eight],
    path: &[Eight],
    end: usize,
    entry: usize,
    degrees: usize,
) -> Eight {
    if end == 0 { input[entry] } else { path[NODES * degrees + entry] }
}
