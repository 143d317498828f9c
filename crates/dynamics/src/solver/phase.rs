//! What the walk asks of the motion between two events.

use super::course::Course;
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
pub(super) struct Reached {
    pub(super) sample: usize,
    pub(super) at_s: f64,
}

/// The motion between two events: the state of structure, slider and contents, its series, and what is kept
/// of it. Interfaces are numbered, the slider first, then the contents.
pub(super) trait Phase<'a>: Sized {
    // ---- steps ----------------------------------------------------------------------------------

    /// [`Walk::step`] by the vector instructions of this.
    fn step(walk: &mut Walk<'a, Self>, sample: usize, from_s: f64) -> Result<(), SolveError>;

    /// Goes on from the first of two samples towards the second, as far as nothing is in doubt.
    ///
    /// # Errors
    /// Where the analysis is stopped.
    fn run_ahead(walk: &mut Walk<'a, Self>, samples: [usize; 2]) -> Result<Reached, SolveError>;

    /// One segment, up to its end or the first event in it; the time reached.
    ///
    /// # Errors
    /// Where what is reached has no continuation.
    fn segment(walk: &mut Walk<'a, Self>, stretch: &Stretch, at_s: f64) -> Result<f64, SolveError>;

    /// Whether something waits to be decided.
    fn is_due(walk: &Walk<'a, Self>) -> bool;

    /// Decides all that is due at an instant; whether something was.
    fn decide(walk: &mut Walk<'a, Self>, stretch: &Stretch, at_s: f64, at_sample: bool) -> bool;

    /// Goes through a jump at a sample between two pairs of acceleration and normal force: what it releases
    /// has reached its bound. Displacements and velocities are what they were.
    ///
    /// # Errors
    /// Where the events in it do not end.
    fn walk_jump(
        walk: &mut Walk<'a, Self>,
        sample: usize,
        from: [f64; 2],
        to: [f64; 2],
    ) -> Result<(), SolveError>;

    /// Looks at the outputs under loads that stand.
    fn look_beside_jump(walk: &mut Walk<'a, Self>, stretch: &Stretch);

    /// What holds from the start.
    fn begin(walk: &mut Walk<'a, Self>);

    /// Ends at a time what lasts, and settles what may still hold a peak.
    fn end(walk: &mut Walk<'a, Self>, end_s: f64);

    // ---- state ----------------------------------------------------------------------------------

    /// Modes or law have changed.
    fn enter(&mut self, course: &Course<'a>);

    /// Displacement and velocity of an interface, in two horizontal directions those along x.
    fn place(&self, interface: usize) -> [f64; 2];

    // ---- what is kept ---------------------------------------------------------------------------

    /// Whether a history is wanted.
    fn records(&self) -> bool;

    /// Records the present state as a knot at a sample, perhaps as a row of the history.
    fn record_sample(&mut self, course: &Course<'a>, sample: usize, row: bool);

    /// The same between samples, at a time with the acceleration of the table there.
    fn record_between(
        &mut self,
        course: &Course<'a>,
        knot: [f64; 2],
        at: (&Stretch, f64),
        row: bool,
    );
}

/// A phase in one direction, in which an interface slides one way or the other: its series in the modes of a
/// [`Course`].
///
/// What an interface is *asked* for is the force of the slider in N, of contents their acceleration in
/// m/s², with the *normal* force in the same unit.
pub(super) trait Straight<'a>: Phase<'a> {
    /// The motion from an instant on by powers of the time.
    type Expansion;
    /// What moves.
    type State: Clone;

    // ---- state ----------------------------------------------------------------------------------

    /// Gives the slider or contents a displacement and a velocity that an event fixes.
    fn put(&mut self, interface: usize, place: [f64; 2]);

    /// Adds to the block's velocity over the ground what is taken from that of all else over the block:
    /// an impact, which what does not touch the stop does not feel.
    fn strike(&mut self, change: f64);

    /// All that moves.
    fn state(&self) -> Self::State;

    /// Goes back to it.
    fn set_state(&mut self, state: &Self::State);

    /// The force that keeps the block stuck under an acceleration and a normal force, eqs (8), (14), by what
    /// holds it.
    fn demand_n(&mut self, hold: &Hold, loads: [f64; 2]) -> f64;

    /// Mass of the block with what is stuck to it, in kg.
    fn block_kg(&self) -> f64;

    // ---- series ---------------------------------------------------------------------------------

    /// Expands the motion from a time of a stretch over as much of it as one series takes.
    fn expand(&mut self, course: &Course<'a>, stretch: &Stretch, from_s: f64) -> Segment;

    /// Finds accelerations and forces of an instant.
    fn look_at_instant(&mut self, course: &Course<'a>, stretch: &Stretch, at_s: f64);

    /// What was expanded last.
    fn series(&self) -> &Self::Expansion;

    /// The last instant looked at.
    fn instant(&self) -> &Self::Expansion;

    /// What of the motion a series is of, as far as it is exact.
    fn segment(&self, series: &Self::Expansion) -> Segment;

    /// The length that a series took last, in s.
    fn unit_s(&self) -> f64;

    /// The length to begin with.
    fn set_unit_s(&mut self, unit_s: f64);

    /// Sliding displacement, where the slider slides and its branch can end elsewhere than at a stop.
    fn displacement<'e>(&self, series: &'e Self::Expansion) -> &'e Polynomial;

    /// Velocity of an interface that slides.
    fn velocity<'e>(&self, series: &'e Self::Expansion, interface: usize) -> &'e Polynomial;

    /// Acceleration of an interface over what it slides on.
    fn acceleration(&self, series: &Self::Expansion, interface: usize) -> Polynomial;

    /// What an interface that sticks is asked for.
    fn asked<'e>(&self, series: &'e Self::Expansion, interface: usize) -> &'e Polynomial;

    /// What presses on it, at the start, and by how much that changes over the unit.
    fn normal(&self, series: &Self::Expansion, interface: usize) -> [f64; 2];

    /// What holds it.
    fn hold(&self, course: &Course<'a>, interface: usize) -> Hold;

    /// What is rounding of the acceleration of an interface over what it slides on, in m/s²: of its terms
    /// now, or of the largest so far.
    fn rounding_m_per_s2(
        &self,
        course: &Course<'a>,
        series: &Self::Expansion,
        interface: usize,
    ) -> f64;

    /// Where the slider rests against a rigid stop, or between two: how much of its push towards each friction cannot
    /// take, positive where that stop takes some; and the sign of that push.
    fn beyond_friction(&self, course: &Course<'a>) -> impl Iterator<Item = (f64, Polynomial)> {
        let (series, mut hold) = (self.series(), self.hold(course, 0));
        if course.block.mode != Mode::Stick {
            hold = hold.off_stops();
        }
        hold.beyond_friction(self.asked(series, 0), self.normal(series, 0))
    }

    /// Largest velocity of an interface so far.
    fn peak_velocity(&self, interface: usize) -> f64;

    /// Moves to a part of what was expanded last.
    fn move_to(&mut self, part: f64);

    /// Looks for peaks in the part of the series just gone through.
    fn look(&mut self, course: &mut Course<'a>, stretch: &Stretch, segment: &Segment);
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
