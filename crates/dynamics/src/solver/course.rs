//! What the walk shares with what runs ahead of it: modes, the law in force, and what has happened; and
//! what follows a stop or a release of a lone slider beyond doubt.

use super::slider::{SliderState, Start};
use crate::response::{Event, EventKind, Mode};
use crate::slider::{Direction, Hold};

/// Events nearer to an end of a piece, and decisions of a smaller margin, are ambiguous: they are made
/// from the series of the motion.
pub(super) const AMBIGUOUS: f64 = 1e-9;

/// Extremes, path and duration of sliding; `s` is monotone between two events.
#[derive(Clone, Copy)]
pub(super) struct Sliding {
    pub(super) max_m: f64,
    pub(super) min_m: f64,
    pub(super) peak_time_s: f64,
    pub(super) path_m: f64,
    pub(super) time_s: f64,
    /// Least margin of the decisions at stops so far; infinite where there was none.
    pub(super) closest_stop: f64,
    phase_start: [f64; 2],
}

impl Sliding {
    pub(super) fn new(s: f64) -> Self {
        Self {
            max_m: s,
            min_m: s,
            peak_time_s: 0.0,
            path_m: 0.0,
            time_s: 0.0,
            closest_stop: f64::INFINITY,
            phase_start: [0.0, s],
        }
    }

    /// A stop is decided by a margin, if it is one.
    pub(super) fn decide(&mut self, margin: Option<f64>) {
        self.closest_stop = self.closest_stop.min(margin.unwrap_or(f64::INFINITY));
    }

    /// The interface starts to slide, one way or the other.
    pub(super) fn begin(&mut self, time_s: f64, s: f64) {
        self.phase_start = [time_s, s];
    }

    /// It stops, turns round, or the motion ends.
    pub(super) fn end(&mut self, time_s: f64, s: f64) {
        if s.abs() > self.max_m.max(-self.min_m) {
            self.peak_time_s = time_s;
        }
        self.max_m = self.max_m.max(s);
        self.min_m = self.min_m.min(s);
        let [start_s, start_m] = self.phase_start;
        self.path_m += (s - start_m).abs();
        self.time_s += time_s - start_s;
    }
}

/// Two faces that stick or slide: of the slider, or of contents and their floor.
#[derive(Clone, Copy)]
pub(super) struct Interface {
    pub(super) mode: Mode,
    /// Set while a slip has just started.
    pub(super) start: Option<Start>,
    pub(super) sliding: Sliding,
}

impl Interface {
    /// At a displacement and a velocity, before anything has happened.
    fn new(s: f64, w: f64) -> Self {
        let mode = match w {
            w if w > 0.0 => Mode::Slip(Direction::Positive),
            w if w < 0.0 => Mode::Slip(Direction::Negative),
            _ => Mode::Stick,
        };
        Self { mode, start: None, sliding: Sliding::new(s) }
    }
}

/// An interface that slides from rest, and where.
#[derive(Clone, Copy, Debug)]
pub(super) struct Release {
    pub(super) interface: usize,
    pub(super) direction: Direction,
}

/// A rigid stop that has just been struck, and where the block is to it.
#[derive(Clone, Copy)]
pub(super) struct Near {
    pub(super) place: f64,
    pub(super) offset: f64,
}

/// Modes and law, and what the events have left behind.
pub(super) struct WalkState<'a> {
    pub(super) slider: SliderState<'a>,
    /// The slider as an interface.
    pub(super) block: Interface,
    /// Those of contents that slide each by itself, which start from rest.
    pub(super) contents: Vec<Interface>,
    pub(super) near: Option<Near>,
    /// Interfaces that have reached their bounds.
    pub(super) released: Vec<Release>,
    pub(super) events: Vec<Event>,
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

impl<'a> WalkState<'a> {
    /// Before anything has happened, in the lists of another.
    pub(super) fn new(
        slider: SliderState<'a>,
        [s, w]: [f64; 2],
        (mut released, mut events): (Vec<Release>, Vec<Event>),
    ) -> Self {
        released.clear();
        events.clear();
        let (block, contents) = (Interface::new(s, w), Vec::new());
        Self { slider, block, contents, near: None, released, events, events_in_interval: 0 }
    }

    /// The same with so many contents.
    pub(super) fn with_contents(mut self, count: usize) -> Self {
        self.contents.resize(count, Interface::new(0.0, 0.0));
        self
    }

    /// Number of interfaces: the slider, then the contents.
    #[inline(always)]
    pub(super) fn interfaces(&self) -> usize {
        1 + self.contents.len()
    }

    /// An interface.
    #[inline(always)]
    pub(super) fn interface(&self, i: usize) -> &Interface {
        match i {
            0 => &self.block,
            i => &self.contents[i - 1],
        }
    }

    /// The same, to change.
    #[inline(always)]
    pub(super) fn interface_mut(&mut self, i: usize) -> &mut Interface {
        match i {
            0 => &mut self.block,
            i => &mut self.contents[i - 1],
        }
    }

    /// Its mode.
    #[inline(always)]
    pub(super) fn mode(&self, i: usize) -> Mode {
        self.interface(i).mode
    }

    /// Gives all interfaces their modes.
    pub(super) fn set_modes(&mut self, modes: &[Mode]) {
        for (i, mode) in modes.iter().enumerate() {
            self.interface_mut(i).mode = *mode;
        }
    }

    /// The interfaces that stick.
    pub(super) fn stuck(&self) -> impl Iterator<Item = usize> {
        (0..self.interfaces()).filter(|&i| self.mode(i) == Mode::Stick)
    }

    /// What holds the slider at rest; off a stop by less than the rounding of `s` it does not lean on it.
    #[inline(always)]
    pub(super) fn hold(&self, s: f64) -> Hold {
        let hold = self.slider.hold(s);
        match self.near {
            Some(near) if near.offset != 0.0 => hold.off_stops(),
            _ => hold,
        }
    }

    /// Whether a stop of the slider is still to be decided: slip at `ṡ = 0` that has not just started.
    #[inline(always)]
    pub(super) fn is_stopped(&self, w: f64) -> bool {
        self.block.mode != Mode::Stick && self.block.start.is_none() && w == 0.0
    }

    /// The sliding velocity is zero: stick if friction holds the demand, eq. (4), else slip on against it,
    /// eq. (3).
    ///
    /// A block that goes on as before has decided nothing. Nothing happens, and the answer is false, where the
    /// decision is ambiguous, or would have the block go on and that is not wanted.
    pub(super) fn stop(
        &mut self,
        at: &Instant,
        hold: &Hold,
        demand_n: f64,
        may_go_on: bool,
    ) -> bool {
        let margin = hold.margin(demand_n, at.normal_n);
        let way = hold.gives_way(demand_n, at.normal_n);
        let goes_on = way.is_some_and(|direction| self.block.mode == Mode::Slip(direction));
        if (goes_on && !may_go_on) || !margin.is_some_and(|margin| margin > AMBIGUOUS) {
            return false;
        }
        if !goes_on {
            self.block.sliding.decide(margin);
        }
        match way {
            None => {
                self.block.sliding.end(at.time_s, at.place_m);
                self.block.mode = Mode::Stick;
                self.push(at, EventKind::Stick);
            }
            Some(direction) => {
                self.block.start = Some(self.start_beyond(at, demand_n, direction));
                if goes_on {
                    self.slider.law.resume(&mut self.slider.memory, 0.0, direction);
                } else {
                    self.block.sliding.end(at.time_s, at.place_m);
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
        self.block.start = Some(Start { order, acceleration });
        self.begin_slip(at, direction, EventKind::Slip);
    }

    /// In stick a jump has taken the demand beyond its bound.
    pub(super) fn give_way(&mut self, at: &Instant, demand_n: f64, direction: Direction) {
        self.block.start = Some(self.start_beyond(at, demand_n, direction));
        self.begin_slip(at, direction, EventKind::Slip);
    }

    /// How a slip starts under a force beyond what holds: `|s̈| = (|T| − μ_k N) / M1`.
    fn start_beyond(&self, at: &Instant, demand_n: f64, direction: Direction) -> Start {
        let kinetic_n = self.slider.resistance_n(at.place_m, direction, at.normal_n);
        let asked_n = -direction.sign() * demand_n;
        Start { order: 1, acceleration: (asked_n - kinetic_n) / at.mass_kg }
    }

    fn begin_slip(&mut self, at: &Instant, direction: Direction, kind: EventKind) {
        self.block.mode = Mode::Slip(direction);
        self.block.sliding.begin(at.time_s, at.place_m);
        self.push(at, kind);
        if let Some(contact) = self.slider.begin(at.place_m, direction) {
            let kind = self.slider.change_contact(at.time_s, 0.0, contact);
            self.push(at, kind);
        }
    }

    /// Lists an event of the slider.
    pub(super) fn push(&mut self, at: &Instant, kind: EventKind) {
        self.push_of(0, [at.time_s, at.place_m], kind);
    }

    /// Lists an event of an interface at a time and place.
    pub(super) fn push_of(
        &mut self,
        interface: usize,
        [time_s, place_m]: [f64; 2],
        kind: EventKind,
    ) {
        self.events_in_interval += 1;
        let mode = self.mode(interface);
        let event = Event { time_s, kind, mode, sliding_displacement_m: place_m, interface };
        self.events.push(event);
    }
}
