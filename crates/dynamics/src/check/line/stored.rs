//! The path of an interval compared with what is stored at its ends.

use fearless_simd::prelude::*;

use super::super::collocation::NODES;
use super::super::lane::{Places, all, both, keep, larger};
use super::group::Group;
use super::knots::{LaneJudge, lists_of};
use super::work::Pass;
use crate::response::output::{BLOCK, FRICTION};

impl LaneJudge<'_> {
    /// Compares the ends of the paths with the knots stored there.
    #[inline(always)]
    pub(super) fn arrive<S: Simd>(
        &self,
        simd: S,
        n: usize,
        group: &Group,
        places: &Places,
        pass: &mut Pass<'_, '_>,
    ) {
        let (h, s) = (self.history, self.structure);
        let (d, e) = (s.degrees(), s.contents.len());
        let (worst, work) = (&mut *pass.worst, &mut *pass.work);
        let instant = all(simd, self.instant_s);
        // What the rounding of N makes of velocities, places and energies.
        let rounding = group.normal_rounding.load(simd);
        let (mut drift, mut drift_m) = (all(simd, 0.0), all(simd, 0.0));
        if self.vertical {
            let length_s = group.length_s.load(simd);
            let force = group.slides.load(simd) * rounding;
            drift = force * all(simd, 1.0 / s.least_kg()) * length_s;
            drift_m = all(simd, 0.5) * length_s * drift;
            let mut speed = all(simd, 0.0);
            let mut moved = all(simd, 0.0);
            for i in 0..d {
                speed += work.fastest[i].load(simd);
            }
            for i in 0..=e {
                let at = s.degree_of(i);
                let ([places_m, _], stride) = lists_of(h, n, at);
                let from = places.read(simd, places_m, 0, stride);
                moved += (work.path[NODES * d + at].load(simd) - from).abs();
            }
            work.spent.blur.store(force * moved + all(simd, s.total_kg) * speed * drift);
        }
        for i in 0..d {
            let (lists, at) = lists_of(h, n, i);
            let rates = both!(|k| self.stored_rate(simd, (n, i), places, k).abs());
            let x = work.path[NODES * d + i].load(simd);
            let v = work.path[(NODES + 1) * d + i].load(simd);
            let fastest = work.fastest[i].load(simd);
            let off = (places.read(simd, lists[0], 1, at) - x).abs() - instant * fastest - drift_m;
            keep(simd, &mut worst.displacement[0], off);
            let rate = larger(rates[0], rates[1]);
            let off = (places.read(simd, lists[1], 1, at) - v).abs() - instant * rate - drift;
            keep(simd, &mut worst.velocity[0], off);
            // Between two knots the motion may be faster and go farther than at any.
            keep(simd, &mut worst.displacement[1], x.abs());
            keep(simd, &mut worst.velocity[1], fastest);
        }
        keep(simd, &mut worst.drift[0], drift_m);
        keep(simd, &mut worst.drift[1], drift);
        let slides = all(simd, 1.0) - group.stuck.load(simd);
        keep(simd, &mut worst.sliding, work.fastest[0].load(simd) * slides);
    }

    /// Compares what is stored at the start (0) or the end (1) of intervals with the loads: the table's
    /// acceleration, forces of sliding, and where more acts on the block, its acceleration.
    #[inline(always)]
    pub(super) fn sides<S: Simd>(
        &self,
        simd: S,
        (group, end): (&Group, usize),
        places: &Places,
        pass: &mut Pass<'_, '_>,
    ) {
        let (h, s) = (self.history, self.structure);
        let d = s.degrees();
        let drift = all(simd, self.instant_s) * group.drift.load(simd).abs();
        let rounding = group.normal_rounding.load(simd);
        let table = places.read(simd, &h.table_acceleration_m_per_s2, end, [1, 0]);
        let off = (group.table[end].load(simd) - table).abs() - drift;
        keep(simd, &mut pass.worst.table, off);
        let force = places.read(simd, &h.friction_force_n, end, [1, 0]);
        let most = all(simd, self.law.most());
        if !group.sticks() {
            let slides = all(simd, 1.0) - group.stuck.load(simd);
            let w = places.read(simd, &h.sliding_velocity_m_per_s, end, [1, 0]);
            let load = pass.work.input[2 * d + 2 + end].load(simd) - group.stop[2].load(simd);
            self.take_speed(simd, group, w, pass.work);
            let mut own = self.sliding_force(simd, group, (w, load), &pass.work.input);
            if self.law.series.is_some() {
                let s_stored = places.read(simd, &h.sliding_displacement_m, end, [1, 0]);
                own -= group.rise[end].load(simd) * s_stored;
            }
            let off = (force - own).abs() - most * rounding;
            keep(simd, &mut pass.worst.excess, off * slides);
        }
        for (e, contents) in s.contents.iter().enumerate() {
            let list = &h.contents_acceleration_m_per_s2;
            let stored =
                places.read(simd, list, end, [s.contents.len(), e]) + all(simd, self.slope);
            let own = -self.pull(simd, &pass.work.input, e, end as f64);
            let mass = all(simd, contents.mass_kg);
            let mu = contents.kinetic_friction * contents.mass_kg / s.total_kg;
            let off = mass * (stored - own).abs() - all(simd, mu) * rounding;
            let moves = all(simd, 1.0) - group.carried[e].stuck.load(simd);
            keep(simd, &mut pass.worst.force[0], off * moves);
        }
        if self.law.is_pendulum() || self.law.restitution().is_some() {
            self.end((group, end), pass.outputs, pass.work);
            let own_force = pass.work.ends[end][FRICTION].load(simd);
            let own_block = pass.work.ends[end][BLOCK].load(simd);
            let block = places.read(simd, &h.block_acceleration_m_per_s2, end, [1, 0]);
            let off = larger(
                (own_force - force).abs() * group.stuck.load(simd),
                all(simd, s.block_kg) * (own_block - block).abs(),
            );
            let rounding = all(simd, s.total_kg) * drift + most * rounding;
            keep(simd, &mut pass.worst.force[0], off - rounding);
            let stop = pass.work.ends[end][pass.outputs.of_stop()].load(simd);
            keep(simd, &mut pass.worst.force[1], larger(own_force.abs(), stop.abs()));
        }
    }
}
