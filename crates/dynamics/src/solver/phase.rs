//! What the walk asks of the motion between two events.

use super::course::WalkState;
use super::ground::Stretch;
use super::walk::Walk;
use crate::error::SolveError;
use crate::linear::lanes::least;
use crate::linear::polynomial::Polynomial;
use crate::response::Mode;
use crate::slider::Hold;

/// A segment of a stretch: one series long at most.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Segment {
    pub(super) from_s: f64,
    pub(super) to_s: f64,
    /// Length of its series in s.
    pub(super) unit_s: f64,
    /// Its length over that.
    pub(super) part: f64,
}

impl Segment {
    /// Its first part.
    #[inline(always)]
    pub(super) fn up_to(self, part: f64) -> Self {
        Self { to_s: least(self.from_s + part * self.unit_s, self.to_s), part, ..self }
    }
}

/// How far running ahead has come: so long after a sample, from where the walk goes on.
#[derive(Clone, Copy)]
pub(super) struct Advance {
    pub(super) sample: usize,
    pub(super) at_s: f64,
}

/// The motion between two events: the state of structure, slider and contents, its series, and what is kept
/// of it. Interfaces are numbered, the slider first, then the contents.
pub(super) trait Phase<'a> {
    // ---- steps ----------------------------------------------------------------------------------

    /// Goes on from the first of two samples towards the second, as far as nothing is in doubt.
    ///
    /// # Errors
    /// Where the analysis is stopped.
    fn run_ahead(walk: &mut Walk<'a, Self>, samples: [usize; 2]) -> Result<Advance, SolveError>
    where
        Self: Sized;

    /// Settles what may still hold a peak.
    fn settle(walk: &mut Walk<'a, Self>)
    where
        Self: Sized;

    // ---- state ----------------------------------------------------------------------------------

    /// Modes or law have changed.
    fn update_branch(&mut self, course: &WalkState<'a>);

    /// Displacement and velocity of an interface, in two horizontal directions those along x.
    fn position_and_velocity(&self, interface: usize) -> [f64; 2];

    // ---- what is kept ---------------------------------------------------------------------------

    /// Whether a history is wanted.
    fn records(&self) -> bool;

    /// Records the present state as a knot at a sample, perhaps as a row of the history.
    fn record_sample(&mut self, course: &WalkState<'a>, sample: usize, row: bool);

    /// The same between samples, at a time with the acceleration of the table there.
    fn record_between(
        &mut self,
        course: &WalkState<'a>,
        knot: [f64; 2],
        at: (&Stretch, f64),
        row: bool,
    );
}

/// Which series of the motion by powers of the time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Of {
    /// That which was expanded last.
    Motion,
    /// Of the last instant looked at: accelerations and forces.
    Instant,
}

/// A phase in one direction, in which an interface slides one way or the other: its series in the modes of a
/// [`WalkState`].
///
/// What an interface is *asked* for is the force of the slider in N, of contents their acceleration in
/// m/s², with the *normal* force in the same unit.
pub(super) trait LinePhase<'a>: Phase<'a> + 'a {
    // ---- state ----------------------------------------------------------------------------------

    /// Gives the slider or contents a displacement and a velocity that an event fixes.
    fn set_position_and_velocity(&mut self, interface: usize, place: [f64; 2]);

    /// Adds to the block's velocity over the ground what is taken from that of all else over the block:
    /// an impact, which what does not touch the stop does not feel.
    fn apply_impulse(&mut self, change: f64);

    /// All that moves.
    fn state(&self) -> Vec<f64>;

    /// Goes back to it.
    fn set_state(&mut self, state: &[f64]);

    /// The force that keeps the block stuck under an acceleration and a normal force, eqs (8), (14), by what
    /// holds it.
    fn required_friction_n(&mut self, hold: &Hold, loads: [f64; 2]) -> f64;

    /// Mass of the block with what is stuck to it, in kg.
    fn block_kg(&self) -> f64;

    // ---- series ---------------------------------------------------------------------------------

    /// Expands the motion from a time of a stretch over as much of it as one series takes.
    fn expand(&mut self, course: &WalkState<'a>, stretch: &Stretch, from_s: f64) -> Segment;

    /// Finds accelerations and forces of an instant.
    fn look_at_instant(&mut self, course: &WalkState<'a>, stretch: &Stretch, at_s: f64);

    /// What of the motion a series is of, as far as it is exact.
    fn segment(&self, of: Of) -> Segment;

    /// The length that a series took last, in s.
    fn unit_s(&self) -> f64;

    /// The length to begin with.
    fn set_unit_s(&mut self, unit_s: f64);

    /// Sliding displacement by what was expanded last, where the slider slides and its branch can end elsewhere than at
    /// a stop.
    fn displacement(&self) -> &Polynomial;

    /// Velocity of an interface that slides, by what was expanded last.
    fn velocity(&self, interface: usize) -> &Polynomial;

    /// Acceleration of an interface over what it slides on.
    fn acceleration(&self, of: Of, interface: usize) -> Polynomial;

    /// What an interface that sticks is asked for.
    fn required_friction(&self, of: Of, interface: usize) -> &Polynomial;

    /// What presses on it, at the start, and by how much that changes over the unit.
    fn normal(&self, of: Of, interface: usize) -> [f64; 2];

    /// What holds it.
    fn hold(&self, course: &WalkState<'a>, interface: usize) -> Hold;

    /// What is rounding of the acceleration of an interface over what it slides on, in m/s²: of its terms
    /// now, or of the largest so far.
    fn rounding_m_per_s2(&self, course: &WalkState<'a>, of: Of, interface: usize) -> f64;

    /// Where the slider rests against a rigid stop, or between two: how much of its push towards each friction cannot
    /// take, positive where that stop takes some; and the sign of that push.
    fn beyond_friction(&self, course: &WalkState<'a>) -> Vec<(f64, Polynomial)> {
        let mut hold = self.hold(course, 0);
        if course.block.mode != Mode::Stick {
            hold = hold.off_stops();
        }
        hold.beyond_friction(self.required_friction(Of::Motion, 0), self.normal(Of::Motion, 0))
            .collect()
    }

    /// Largest velocity of an interface so far.
    fn peak_velocity(&self, interface: usize) -> f64;

    /// Moves to a part of what was expanded last.
    fn move_to(&mut self, part: f64);

    /// Looks for peaks in the part of the series just gone through.
    fn look(&mut self, course: &mut WalkState<'a>, stretch: &Stretch, segment: &Segment);
}

/// The length over which a series is expanded, and the part of it that the series serves, at most 1.
///
/// `expand` expands over a length and returns the part over which that is exact, perhaps above 1; `last_s`
/// is the length that the last series would have served.
#[inline(always)]
pub(super) fn fitting(
    last_s: &mut f64,
    first_s: f64,
    left_s: f64,
    mut expand: impl FnMut(f64) -> f64,
) -> [f64; 2] {
    let mut unit_s = if last_s.is_finite() { *last_s } else { first_s };
    loop {
        // A hair beyond is the rounding of the times.
        if unit_s * (1.0 + 1e-9) >= left_s {
            unit_s = left_s;
        }
        let part = expand(unit_s);
        let longer_s = unit_s * part;
        *last_s = if unit_s == left_s { longer_s.max(*last_s) } else { longer_s };
        if !last_s.is_finite() {
            *last_s = unit_s;
        }
        if part >= 0.25 {
            return [unit_s, part.min(1.0)];
        }
        unit_s *= part.max(1e-3);
    }
}
