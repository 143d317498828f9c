//! What is in force in an interval.

use super::super::ground::Load;
use super::super::judge::{Judge, STILL};
use super::super::law::{BOUNDLESS, Sliding, either};
use super::super::structure::{Phase, larger};
use super::Line;
use super::group::{Course, Feed, Key};
use crate::response::{Contact, Mode};

impl<'a> Judge<'a, Line<'a>> {
    /// How a slip of surfaces in series goes on from a knot.
    pub(super) fn sliding(&self, k: usize, mode: Mode) -> Option<Sliding> {
        let Mode::Slip(direction) = mode else { return None };
        self.law.series.as_ref()?;
        let mut ways = self.law.slidings(self.h.surface_displacements(k), direction);
        // The force that is stored tells that a surface has left its end.
        let place = if ways.len() > 1 {
            let (loads, found) =
                (self.ground.instant(self.h.time_s[k]), self.h.friction_force_n[k]);
            let suits = |way: &Sliding| {
                let off = |load: &Load| (load.normal * way.force(0.0) + found).abs();
                let least = loads.iter().map(off).fold(f64::INFINITY, f64::min);
                least <= STILL * self.model.weight_n()
            };
            ways.iter().position(suits).unwrap_or(0)
        } else {
            0
        };
        (!ways.is_empty()).then(|| ways.swap_remove(place))
    }

    /// What is in force from a knot on in modes.
    pub(super) fn course<'m>(&self, k: usize, modes: &'m [Mode], feed: Feed) -> Course<'m> {
        let s = self.h.sliding_displacement_m[k];
        let (mut friction, mut hold) = ([0.0; 2], [0.0; 2]);
        let mut taken = BOUNDLESS;
        let mut slides = 0.0;
        match modes[0] {
            Mode::Stick => {
                let free = self.law.hold(self.h.surface_displacements(k));
                let leans = self.law.leans(s);
                hold = either(leans, BOUNDLESS, free);
                taken = either(leans, free, BOUNDLESS);
            }
            Mode::Slip(direction) => {
                friction = match self.sliding(k, modes[0]) {
                    Some(sliding) => sliding.friction(s),
                    None => [self.law.sliding_load(direction), 0.0],
                };
                slides += self.law.most();
            }
        }
        for (mode, contents) in modes[1..].iter().zip(&self.axes.structure.contents) {
            if *mode != Mode::Stick {
                slides += contents.kinetic_friction;
            }
        }
        let push = self.law.push(self.contact(k));
        Course { knot: k, modes, friction, piece: None, push, hold, taken, slides, feed }
    }

    /// The interval from a knot to the next.
    pub(super) fn interval(&mut self, k: usize) -> Course<'a> {
        let h = self.h;
        let modes = h.modes(k);
        let phase = match (modes[0], self.contact(k)) {
            (Mode::Stick, _) => Phase::Stick,
            (_, Contact::Pressed(_)) => Phase::Pressed,
            _ => Phase::Slip,
        };
        let times_s = [h.time_s[k], h.time_s[k + 1]];
        let feed = Feed::new(&mut self.ground, times_s, self.axes.rates[phase as usize]);
        if !self.ground.is_at_sample(times_s[0]) {
            let rounding = self.rounding(0, self.axes.structure.total_kg, &feed.loads()[0]);
            self.unsure_n = larger(self.unsure_n, rounding);
        }
        self.course(k, modes, feed)
    }

    /// The course of a slip whose speeds at two knots lie in one straight piece of friction by speed, by that.
    pub(super) fn in_piece<'m>(&self, course: &Course<'m>, k: usize) -> Option<Course<'m>> {
        let (Some(rate), Mode::Slip(direction)) = (&self.law.rate, course.modes[0]) else {
            return None;
        };
        let speeds = [k, k + 1].map(|k| self.h.sliding_velocity_m_per_s[k].abs());
        let (band, [mu, slope]) = rate.piece(speeds)?;
        let [p, _] = course.friction;
        // −σ f (c + m |ṡ|) = −σ f c − f m ṡ.
        let piece = Some((rate.factor(direction) * slope, band));
        Some(Course { friction: [p * mu, 0.0], piece, ..*course })
    }

    /// The key of an interval whose path is a linear map of its inputs.
    pub(super) fn key(&self, course: &Course<'_>) -> Option<Key> {
        let slips = course.modes[0] != Mode::Stick;
        if !course.feed.is_single()
            || course.modes.len() > 64
            || slips && self.law.rate.is_some() && course.piece.is_none()
        {
            return None;
        }
        let per_n = course.friction[1] + self.law.curvature_per_m();
        let [from, to] = course.feed.loads().map(|load| load.normal * per_n);
        let [stiffness, damper, _] = course.push.numbers();
        let stuck = course.modes.iter().enumerate().filter(|(_, mode)| **mode == Mode::Stick);
        let stuck = stuck.fold(0, |bits, (i, _)| bits | 1 << i);
        let slope = course.piece.map_or(0.0, |(slope, _)| slope);
        let [drag, last] = course.feed.loads().map(|load| load.normal * slope);
        let key = Key { stuck, push: [stiffness, damper], rise: from, drag };
        (from == to && drag == last).then_some(key)
    }
}
