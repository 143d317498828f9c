//! The events that the knots tell.

use crate::response::{Contact, Event, EventKind, History, Mode};

/// Impacts slower than this are neither listed nor counted, in m/s.
pub(super) const SLOWEST_IMPACT_M_PER_S: f64 = 1e-3;

/// An event, with the sliding speed before it.
pub(super) struct JudgedEvent {
    pub(super) event: Event,
    pub(super) speed: f64,
}

/// All so far.
#[derive(Default)]
pub(super) struct Events {
    pub(super) list: Vec<JudgedEvent>,
    /// The last turn of the slider since its last impact.
    turn: Option<usize>,
    /// Largest speed of an impact.
    pub(super) impacts: f64,
    /// Surfaces that slid in the last interval, while the slider slides on.
    active: Option<Vec<bool>>,
}

/// What a change of contact is called.
fn contact_event(before: Contact, after: Contact) -> Option<EventKind> {
    match (before, after) {
        (Contact::Free, Contact::Pressed(_) | Contact::Separated(_)) => Some(EventKind::Contact),
        (Contact::Pressed(_), Contact::Separated(_)) => Some(EventKind::Separation),
        (Contact::Separated(_), Contact::Pressed(_)) => Some(EventKind::Press),
        (Contact::Pressed(_) | Contact::Separated(_), Contact::Free) => Some(EventKind::Leave),
        _ => None,
    }
}

impl Events {
    fn push(&mut self, h: &History, k: usize, interface: usize, kind: EventKind, speed: f64) {
        let place = match interface {
            0 => h.sliding_displacement_m[k],
            _ => h.contents_state(k, interface - 1)[0],
        };
        if interface == 0 {
            self.turn = (kind == EventKind::Reversal).then_some(self.list.len());
        }
        let mode = h.modes(k)[interface];
        let event =
            Event { time_s: h.time_s[k], kind, mode, sliding_displacement_m: place, interface };
        self.list.push(JudgedEvent { event, speed });
    }

    /// The first knot, with the modes and the contact before it, and the speed into a stop; whether the contact changes.
    pub(super) fn begin(
        &mut self,
        h: &History,
        before: &[Mode],
        (contact, speed): (Contact, f64),
    ) -> bool {
        for i in 0..before.len() {
            if before[i] == Mode::Stick && h.modes(0)[i] != Mode::Stick {
                self.push(h, 0, i, EventKind::Slip, 0.0);
            }
        }
        self.touch(h, 0, contact, speed)
    }

    /// Contact with the stop at a knot, after another, at a speed; whether it changes.
    fn touch(&mut self, h: &History, k: usize, before: Contact, speed: f64) -> bool {
        let kind = h.contact.get(k).and_then(|after| contact_event(before, *after));
        if let Some(kind) = kind {
            self.push(h, k, 0, kind, speed);
        }
        kind.is_some()
    }

    /// Passes to the knot `k`, at which the block has perhaps struck a rigid stop at a speed, and goes into a stop at a speed;
    /// whether contact changes.
    pub(super) fn pass(
        &mut self,
        h: &History,
        k: usize,
        struck: Option<f64>,
        speed_into: f64,
    ) -> bool {
        let (before, after) = (h.modes(k - 1), h.modes(k));
        if let Some(speed) = struck {
            self.impacts = self.impacts.max(speed);
            if let Some(turn) = self.turn.take()
                && speed < SLOWEST_IMPACT_M_PER_S
            {
                self.list.remove(turn);
            }
            self.active = None;
            let bears = matches!(h.contact.get(k), Some(Contact::Pressed(_)));
            if after[0] == Mode::Stick {
                self.push(h, k, 0, EventKind::Rest, speed);
            } else if speed >= SLOWEST_IMPACT_M_PER_S && !bears {
                self.push(h, k, 0, EventKind::Impact, speed);
            }
            self.turn = None;
        }
        for i in usize::from(struck.is_some())..after.len() {
            let kind = match (before[i], after[i]) {
                (Mode::Stick, Mode::Slip(_)) => EventKind::Slip,
                (Mode::Slip(_), Mode::Stick) => EventKind::Stick,
                (a, b) if a != b => EventKind::Reversal,
                _ => continue,
            };
            if i == 0 {
                self.active = None;
            }
            self.push(h, k, i, kind, 0.0);
        }
        let before = h.contact.get(k - 1);
        before.is_some_and(|before| self.touch(h, k, *before, speed_into))
    }

    /// The slider slides from the knot `k` on these surfaces.
    pub(super) fn slides_on(&mut self, h: &History, k: usize, active: Vec<bool>) {
        if self.active.as_ref().is_some_and(|before| *before != active) {
            self.push(h, k, 0, EventKind::Surface, 0.0);
        }
        self.active = Some(active);
    }
}
