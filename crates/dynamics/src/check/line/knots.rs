//! The knots by themselves: the balance of forces, eqs (9), (10), with what is stored there, energies, outputs.

use super::super::judge::{Judge, Sizes};
use super::super::structure::larger;
use super::Line;
use crate::error::Stopped;
use crate::response::output::{BLOCK, VELOCITY};
use crate::response::{History, Mode};

/// Displacements and velocities of a degree, and its place in what is stored at a knot.
pub(super) fn lists_of(h: &History, degree: usize) -> ([&[f64]; 2], [usize; 2]) {
    match degree {
        0 => ([&h.sliding_displacement_m, &h.sliding_velocity_m_per_s], [1, 0]),
        i if i <= h.storeys => {
            ([&h.storey_displacement_m, &h.storey_velocity_m_per_s], [h.storeys, i - 1])
        }
        i => {
            let lists = [&h.contents_displacement_m[..], &h.contents_velocity_m_per_s];
            (lists, [h.contents(), i - 1 - h.storeys])
        }
    }
}

/// Largest sizes at the knots.
struct KnotSizes {
    x: Vec<f64>,
    v: Vec<f64>,
    table: f64,
}

/// What is looked at again at every knot.
struct Room {
    elastic: Vec<[f64; 1]>,
    viscous: Vec<[f64; 1]>,
}

impl<'a> Judge<'a, Line<'a>> {
    /// Acceleration of the block (0) or of a floor stored at a knot.
    fn floor_acceleration(&self, k: usize, floor: usize) -> f64 {
        match floor.checked_sub(1) {
            None => self.h.block_acceleration_m_per_s2[k],
            Some(floor) => self.h.storey_acceleration_m_per_s2[k * self.h.storeys + floor],
        }
    }

    /// `ẍ` of a degree from the accelerations stored at a knot.
    pub(super) fn acceleration(&self, k: usize, degree: usize) -> f64 {
        let n = self.h.storeys;
        match degree {
            0 => self.floor_acceleration(k, 0) - self.h.table_acceleration_m_per_s2[k],
            i if i <= n => self.floor_acceleration(k, i) - self.floor_acceleration(k, 0),
            i => {
                let [.., own] = self.h.contents_state(k, i - 1 - n);
                own - self.floor_acceleration(k, self.structure().contents[i - 1 - n].floor)
            }
        }
    }

    /// Force of the block on an elastic stop at a knot.
    fn stop_force(&self, k: usize) -> f64 {
        let (s, w) = (self.h.sliding_displacement_m[k], self.h.sliding_velocity_m_per_s[k]);
        self.law.push(self.contact(k)).force(s, w)
    }

    /// Whether more than friction, spring and an elastic stop acts on the block at a knot: the spring of a pendulum, or
    /// a rigid stop. Sliding, the block has left the stop or not yet struck it.
    fn is_held(&self, k: usize) -> bool {
        let bears_on_stop =
            || self.law.bears_on_stop(self.h.sliding_displacement_m[k]) != [false; 2];
        self.law.is_pendulum()
            || (self.law.restitution().is_some()
                && self.h.modes(k)[0] == Mode::Stick
                && bears_on_stop())
    }

    /// Looks at every knot; kinetic and strain energy. `None` where something stored is not finite.
    pub(super) fn look_at_knots(&mut self) -> Result<Option<[Vec<f64>; 2]>, Stopped> {
        let (d, n) = (self.structure().degrees(), self.h.storeys);
        let mut sizes = KnotSizes { x: vec![0.0; d], v: vec![0.0; d], table: 0.0 };
        let mut room = Room { elastic: vec![[0.0]; n], viscous: vec![[0.0]; n] };
        let mut energies = [Vec::new(), Vec::new()];
        let mut finite = true;
        for k in 0..self.h.len() {
            self.pulse.tick(2 * d as u32)?;
            finite &= self.take_knot_sizes(k, &mut sizes);
            let at_knot = self.balance(k, &mut room);
            energies.iter_mut().zip(at_knot).for_each(|(list, energy)| list.push(energy));
        }
        if !(finite && self.h.surface_displacement_m.iter().all(|u| u.is_finite())) {
            return Ok(None);
        }
        let most = |list: &[f64]| list.iter().fold(0.0, |most: f64, x| most.max(*x));
        let (storey, place) = (most(&sizes.x[1..=n]), most(&sizes.x[1 + n..]).max(sizes.x[0]));
        let attained = &self.axes.attained;
        let (sliding, block) = (attained[VELOCITY], attained[BLOCK]);
        self.take_sizes(&Sizes {
            displacement_m: storey.max(place),
            storey_m: storey,
            velocity: sliding.max(most(&sizes.v[1..])),
            sliding,
            acceleration: block.max(sizes.table),
            frequency: self.structure().frame_frequency(),
        });
        Ok(Some(energies))
    }

    /// Takes the sizes of what is stored at a knot; whether all of it is finite.
    fn take_knot_sizes(&self, k: usize, sizes: &mut KnotSizes) -> bool {
        let h = self.h;
        let table = h.table_acceleration_m_per_s2[k];
        sizes.table = sizes.table.max(table.abs());
        let mut sum = table + h.friction_force_n[k];
        for degree in 0..sizes.x.len() {
            let (lists, [stride, i]) = lists_of(h, degree);
            let [x, v] = lists.map(|list| list[k * stride + i]);
            sizes.x[degree] = sizes.x[degree].max(x.abs());
            sizes.v[degree] = sizes.v[degree].max(v.abs());
            sum += x + v + self.acceleration(k, degree);
        }
        sum.is_finite()
    }

    /// Judges the balance of the forces at a knot and raises the peaks by its outputs; its kinetic and strain energy.
    fn balance(&mut self, k: usize, room: &mut Room) -> [f64; 2] {
        let (h, s, slope) = (self.h, self.structure(), self.axes.stepper.equations.slope);
        let n = h.storeys;
        let of = |list: &'a [f64]| list[k * n..(k + 1) * n].as_chunks::<1>().0;
        let (q, v) = (of(&h.storey_displacement_m), of(&h.storey_velocity_m_per_s));
        let (place, w) = (h.sliding_displacement_m[k], h.sliding_velocity_m_per_s[k]);
        let (table, friction) = (h.table_acceleration_m_per_s2[k], h.friction_force_n[k]);
        let block = h.block_acceleration_m_per_s2[k];
        let (held, stop) = (self.is_held(k), self.stop_force(k));
        let Room { elastic, viscous } = room;
        elastic.fill([0.0]);
        viscous.fill([0.0]);
        let mut term = s.add_elastic(q, elastic).max(s.add_viscous(v, viscous));
        let (spring, damper) = (s.spring * place, s.damper * w);
        let inertia = s.block_kg * (block + slope);
        let mut balance = inertia + damper + spring + stop - friction;
        let mut kinetic = s.block_kg * w * w;
        let mut defect = 0.0;
        let f = &mut self.figures;
        // Contents pull at their floors with their inertia, whether they slide or not.
        for (e, contents) in s.contents.iter().enumerate() {
            let [_, p, a] = h.contents_state(k, e);
            let inertia = contents.mass_kg * (a + slope);
            balance += inertia;
            term = term.max(inertia.abs());
            let (mut speed, mut under) = (w + p, block);
            if let Some(i) = contents.floor.checked_sub(1) {
                viscous[i][0] += inertia;
                speed += v[i][0];
                under = h.storey_acceleration_m_per_s2[k * n + i];
            }
            kinetic += contents.mass_kg * speed * speed;
            if h.modes(k)[1 + e] == Mode::Stick {
                defect = larger(defect, contents.mass_kg * (a - under));
                f.velocity[0] = larger(f.velocity[0], p);
            }
        }
        for (i, mass) in s.masses_kg.iter().enumerate() {
            let inertia = mass * (h.storey_acceleration_m_per_s2[k * n + i] + slope);
            balance += inertia;
            defect = larger(defect, inertia + viscous[i][0] + elastic[i][0]);
            term = term.max(inertia.abs());
            let speed = w + v[i][0];
            kinetic += mass * speed * speed;
        }
        for single in [spring, damper, inertia, friction, stop] {
            term = term.max(single.abs());
        }
        if !held {
            defect = larger(defect, balance);
        }
        if h.modes(k)[0] == Mode::Stick {
            defect = larger(defect, s.block_kg * (block - table));
            f.velocity[0] = larger(f.velocity[0], w);
        }
        f.force = [larger(f.force[0], defect), larger(f.force[1], term)];
        // At the start and at the end both sides of a jump last; what the motion passes in no time is no peak.
        let t = &h.time_s;
        let passes = k > 0 && k + 1 < t.len() && t[k + 1] == t[k] && t[k - 1] == t[k];
        if !passes {
            // Where more acts on the block the slider's force is not known from what is stored.
            let slider = if held { 0.0 } else { friction - (spring + damper) - stop };
            let [shear] = s.base_shear(q, v);
            let total = |j: usize| [h.storey_acceleration_m_per_s2[k * n + j] + slope];
            let floor = |j: usize| [q[j], v[j], total(j)];
            let (attained, block) = (&mut self.axes.attained, [block + slope]);
            self.outputs.each(
                [&[w], &[slider], &[friction], &[shear], &[stop]],
                (slope, &block),
                |i| self.outputs.point(i, &block, floor),
                |e| {
                    let [_, velocity, acceleration] = h.contents_state(k, e);
                    [[velocity], [acceleration + slope]]
                },
                |g, [value]| attained[g] = larger(attained[g], value),
            );
        }
        [0.5 * kinetic, 0.5 * (spring * place + s.elastic_form(q))]
    }
}
