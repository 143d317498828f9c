//! What the events of a lone slider change: the one place that decides what follows a stop or a release.

use super::run::Sliding;
use super::slider::{SliderState, Start};
use crate::response::{Event, EventKind, Mode};
use crate::slider::{Direction, Hold};

/// Mode and law of a lone slider, and what its events have left behind.
pub(super) struct Course<'a> {
    pub(super) slider: SliderState<'a>,
    pub(super) mode: Mode,
    /// Set while a slip has just started.
    pub(super) start: Option<Start>,
    pub(super) events: Vec<Event>,
    pub(super) sliding: Sliding,
    pub(super) events_in_interval: u32,
}

/// When, where and under what an event happens.
#[derive(Clone, Copy)]
pub(super) struct Instant {
    pub(super) time_s: f64,
    /// `s`.
    pub(super) place_m: f64,
    /// `N`.
    pub(super) normal_n: f64,
    /// `M1`.
    pub(super) mass_kg: f64,
}

impl<'a> Course<'a> {
    /// Before anything has happened, in a list that is empty.
    pub(super) fn new(slider: SliderState<'a>, [s, w]: [f64; 2], events: Vec<Event>) -> Self {
        let mode = match w {
            w if w > 0.0 => Mode::Slip(Direction::Positive),
            w if w < 0.0 => Mode::Slip(Direction::Negative),
            _ => Mode::Stick,
        };
        let (start, sliding) = (None, Sliding::new(s));
        Self { slider, mode, start, events, sliding, events_in_interval: 0 }
    }

    /// Whether a stop is still to be decided: slip at `ṡ = 0` that has not just started.
    #[inline(always)]
    pub(super) fn is_stopped(&self, w: f64) -> bool {
        self.mode != Mode::Stick && self.start.is_none() && w == 0.0
    }

    /// The sliding velocity is zero: stick if friction holds the demand, eq. (4), else slip on against it,
    /// eq. (3).
    ///
    /// A block that goes on as before has decided nothing. Nothing happens, and the answer is false, where a
    /// margin is asked for and the demand is nearer to a bound, or would have the block go on.
    pub(super) fn stop(
        &mut self,
        at: &Instant,
        hold: &Hold,
        demand_n: f64,
        least_margin: Option<f64>,
    ) -> bool {
        let margin = hold.margin(demand_n, at.normal_n);
        let way = hold.gives_way(demand_n, at.normal_n);
        let goes_on = way.is_some_and(|direction| self.mode == Mode::Slip(direction));
        if least_margin.is_some_and(|least| goes_on || !margin.is_some_and(|m| m > least)) {
            return false;
        }
        if !goes_on {
            self.sliding.decide(margin);
        }
        match way {
            None => {
                self.sliding.end(at.time_s, at.place_m);
                self.mode = Mode::Stick;
                self.push(at, EventKind::Stick);
            }
            Some(direction) => {
                self.start = Some(self.start_beyond(at, demand_n, direction));
                if goes_on {
                    self.slider.law.resume(&mut self.slider.memory, 0.0, direction);
                } else {
                    self.sliding.end(at.time_s, at.place_m);
                    self.begin_slip(at, direction, EventKind::Reversal);
                }
            }
        }
        true
    }

    /// In stick the demand has reached its bound, and leaves it by a derivative of this order:
    /// `|s̈| = (μ_s − μ_k) N / M1`.
    pub(super) fn release(
        &mut self,
        at: &Instant,
        hold: &Hold,
        direction: Direction,
        order: usize,
    ) {
        let drop_n = self.slider.drop_n(hold, at.place_m, direction, at.normal_n);
        let acceleration = drop_n / at.mass_kg;
        let order = if acceleration > 0.0 { 1 } else { order + 1 };
        self.start = Some(Start { order, acceleration });
        self.begin_slip(at, direction, EventKind::Slip);
    }

    /// In stick a jump has taken the demand beyond its bound.
    pub(super) fn give_way(&mut self, at: &Instant, demand_n: f64, direction: Direction) {
        self.start = Some(self.start_beyond(at, demand_n, direction));
        self.begin_slip(at, direction, EventKind::Slip);
    }

    /// How a slip starts under a force beyond what holds: `|s̈| = (|T| − μ_k N) / M1`.
    fn start_beyond(&self, at: &Instant, demand_n: f64, direction: Direction) -> Start {
        let kinetic_n = self.slider.resistance_n(at.place_m, direction, at.normal_n);
        let asked_n = -direction.sign() * demand_n;
        Start { order: 1, acceleration: (asked_n - kinetic_n) / at.mass_kg }
    }

    fn begin_slip(&mut self, at: &Instant, direction: Direction, kind: EventKind) {
        self.mode = Mode::Slip(direction);
        self.sliding.begin(at.time_s, at.place_m);
        self.push(at, kind);
        if let Some(contact) = self.slider.begin(at.place_m, direction) {
            let kind = self.slider.change_contact(at.time_s, 0.0, contact);
            self.push(at, kind);
        }
    }

    /// Lists an event.
    pub(super) fn push(&mut self, at: &Instant, kind: EventKind) {
        self.events_in_interval += 1;
        let Instant { time_s, place_m: sliding_displacement_m, .. } = *at;
        let event = Event { time_s, kind, mode: self.mode, sliding_displacement_m, interface: 0 };
        self.events.push(event);
    }
}
