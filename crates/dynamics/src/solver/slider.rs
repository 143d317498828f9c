//! The slider between its events: what is in force, and what follows an event.
//!
//! The [`walk`](super::walk) finds where something happens, and asks here what it does.

use crate::linear::polynomial::{DEGREE, Polynomial, deflated, first_root};
use crate::response::{EventKind, StopDemands, SurfaceDemands};
use crate::slider::{BranchEnd, Contact, Direction, Exit, Hold, Law, Memory};

/// What the block does at the stops.
#[derive(Clone, Copy, Default)]
pub(super) struct Stopping {
    pub(super) demands: StopDemands,
    pressed_since_s: f64,
}

impl Stopping {
    /// Contact changes, which is an event of this kind.
    pub(super) fn change(
        &mut self,
        time_s: f64,
        speed: f64,
        from: Contact,
        to: Contact,
    ) -> EventKind {
        if matches!(from, Contact::Pressed(_)) {
            self.demands.contact_time_s += time_s - self.pressed_since_s;
        }
        if matches!(to, Contact::Pressed(_)) {
            self.pressed_since_s = time_s;
            if from == Contact::Free {
                self.demands.contact_count += 1;
                let peak = self.demands.peak_impact_speed_m_per_s.max(speed);
                self.demands.peak_impact_speed_m_per_s = peak;
            }
        }
        match (from, to) {
            (Contact::Free, Contact::Pressed(_)) => EventKind::Contact,
            (_, Contact::Pressed(_)) => EventKind::Press,
            (_, Contact::Separated(_)) => EventKind::Separation,
            (_, Contact::Free) => EventKind::Leave,
        }
    }
}

/// How a slip starts: `ṡ = 0`, and the leading coefficients of `|ṡ|` that are known to vanish.
#[derive(Clone, Copy)]
pub(super) struct Start {
    /// Number of vanishing coefficients, the constant one included.
    pub(super) order: usize,
    /// `|s̈|` at the start where `order` is 1.
    pub(super) acceleration: f64,
}

/// Peaks of surfaces in series, which move one way between two events.
#[derive(Clone, Default)]
pub(super) struct Surfaces(Vec<SurfaceDemands>);

impl Surfaces {
    /// Notes where they are, and whether at their ends.
    pub(super) fn note(&mut self, law: &Law<'_>, memory: &Memory, s: f64) {
        let count = law.surface_count();
        if count == 0 {
            return;
        }
        self.0.resize(count, SurfaceDemands::default());
        let now = law.surfaces(memory, s);
        let at_ends = law.surfaces_at_ends(&now);
        for ((demands, u), at_end) in self.0.iter_mut().zip(&now).zip(at_ends) {
            demands.peak_displacement_m = demands.peak_displacement_m.max(u.abs());
            demands.residual_displacement_m = *u;
            demands.end_reached |= at_end;
        }
    }

    /// What is left behind.
    pub(super) fn demands(&self) -> Vec<SurfaceDemands> {
        self.0.clone()
    }
}

/// A law with what is in force of it.
pub(super) struct SliderState<'a> {
    pub(super) law: &'a Law<'a>,
    pub(super) memory: Memory,
    /// What has just been reached: an exit that waits for the same starts at its zero.
    pub(super) just: Option<BranchEnd>,
    pub(super) stopping: Stopping,
    pub(super) surfaces: Surfaces,
}

impl<'a> SliderState<'a> {
    /// Before anything has happened.
    pub(super) fn new(law: &'a Law<'a>, s: f64, w: f64) -> Self {
        let mut slider = Self {
            law,
            memory: law.initial(s, w),
            just: None,
            stopping: Stopping::default(),
            surfaces: Surfaces::default(),
        };
        slider.note_surfaces(s);
        slider
    }

    /// What holds it at rest.
    #[inline(always)]
    pub(super) fn hold(&self, s: f64) -> Hold {
        self.law.hold(&self.memory, s)
    }

    /// Comes to rest.
    #[inline(always)]
    pub(super) fn settle(&mut self, s: f64) {
        self.note_surfaces(s);
        self.law.settle(&mut self.memory, s);
    }

    /// The same at the end of a bounce in a direction, however short it was.
    pub(super) fn turn(&mut self, s: f64, direction: Direction) {
        self.note_surfaces(s);
        self.law.turn(&mut self.memory, s, direction);
    }

    /// Begins to slide from rest; the contact with an elastic stop that this makes or ends, which is an
    /// event of its own.
    pub(super) fn begin(&mut self, s: f64, direction: Direction) -> Option<Contact> {
        let contact = self.memory.contact;
        self.law.begin(&mut self.memory, s, direction);
        let begun = core::mem::replace(&mut self.memory.contact, contact);
        (begun != contact).then_some(begun)
    }

    /// Friction with which it would begin to slide, as the size of what resists.
    pub(super) fn resistance_n(&self, s: f64, direction: Direction, normal_n: f64) -> f64 {
        self.law.resistance_n(&self.memory, s, direction, normal_n)
    }

    /// By how much that is below what holds.
    pub(super) fn drop_n(&self, hold: &Hold, s: f64, direction: Direction, normal_n: f64) -> f64 {
        self.law.drop_n(hold, (&self.memory, s), direction, normal_n)
    }

    /// Changes the contact with an elastic stop at a speed.
    pub(super) fn change_contact(&mut self, time_s: f64, speed: f64, to: Contact) -> EventKind {
        let from = core::mem::replace(&mut self.memory.contact, to);
        self.stopping.change(time_s, speed, from, to)
    }

    /// Follows the end of a branch; the kind of event, where it is one that is listed.
    pub(super) fn follow(
        &mut self,
        reached: BranchEnd,
        direction: Direction,
        time_s: f64,
        [s, w]: [f64; 2],
    ) -> Option<EventKind> {
        self.just = Some(reached);
        self.note_surfaces(s);
        let kind = match reached {
            BranchEnd::Contact(to, _) => Some(self.change_contact(time_s, w.abs(), to)),
            BranchEnd::Surface(_) => Some(EventKind::Surface),
            BranchEnd::Wall(..) | BranchEnd::Knot(..) => None,
        };
        self.law.follow(&mut self.memory, reached, direction);
        kind
    }

    /// Notes where surfaces in series are.
    pub(super) fn note_surfaces(&mut self, s: f64) {
        self.surfaces.note(self.law, &self.memory, s);
    }

    /// Whether all its travel is used up.
    pub(super) fn at_end(&self) -> bool {
        self.law.at_end(&self.memory)
    }

    /// The polynomial of an exit, less the zero at which it starts where the same has just been reached.
    pub(super) fn of_exit(&self, exit: &Exit, mut p: Polynomial) -> Polynomial {
        match (exit.reached, self.just) {
            (BranchEnd::Contact(_, None), Some(BranchEnd::Contact(_, None))) => deflated(&p, 1),
            (BranchEnd::Knot(speed, _), Some(BranchEnd::Knot(crossed, _))) if speed == crossed => {
                p[0] = 0.0;
                match p.iter().position(|c| *c != 0.0) {
                    Some(order) => deflated(&p, order),
                    None => p,
                }
            }
            _ => p,
        }
    }
}

/// Part of its terms below which a number is rounding.
pub(super) const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Whether a distance from a bound goes below zero by more than what of it is rounding.
#[inline(always)]
pub(super) fn falls_below(distance: &Polynomial, rounding: f64, to: f64) -> bool {
    let mut raised = *distance;
    raised[0] += rounding;
    first_root(&raised, to).is_some()
}

/// First part of a segment after which a distance from a bound is negative; one that is zero at the
/// start has been found not to go that way.
#[inline(always)]
pub(super) fn first_crossing(distance: &Polynomial, to: f64) -> Option<f64> {
    if distance[0] > 0.0 {
        return first_root(distance, to);
    }
    let order = (1..=DEGREE).find(|&k| distance[k] != 0.0)?;
    first_root(&deflated(distance, order), to)
}

/// Order of the first coefficient that is more than rounding.
pub(super) fn leading(p: &Polynomial, rounding: f64) -> Option<usize> {
    (0..=DEGREE).find(|&k| p[k].abs() > rounding)
}
