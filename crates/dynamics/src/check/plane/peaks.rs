//! The outputs of a motion in a plane, and the largest sizes that they and their parts attain.
//!
//! In a step whose last Legendre coefficients are rounding all outputs are polynomials as good as the motion.

use super::super::collocation::{POINTS, Rule};
use super::super::outputs::{Outputs, raise, raise_size};
use super::super::structure::larger;
use super::body::PointOfModes;
use super::frame::{Forces, Loads, Pair, PlaneFrame, cross, dot, norm, table, times, unit};
use super::step::{State, Step};
use crate::response::output::{BLOCK, FRICTION, OVERTURNING, Output, SLIDER};
use std::borrow::Cow;

/// The outputs that the direction of friction decides.
const BY_DIRECTION: [usize; 4] = [BLOCK, SLIDER, FRICTION, OVERTURNING];
/// Sides of the axes on which the largest `s` is looked for: +x, −x, +y, −y.
const SIDES: [Pair; 4] = [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]];

/// Sizes of a vector and of its parts along x and y.
fn sizes(vector: Pair) -> [f64; 3] {
    [norm(vector), vector[0].abs(), vector[1].abs()]
}

/// What moves and acts at an instant.
pub(super) struct Acting<'a> {
    pub(super) x: &'a [f64],
    pub(super) v: &'a [f64],
    pub(super) loads: Loads,
    pub(super) forces: Forces,
    pub(super) floors: Cow<'a, [f64]>,
}

impl<'a> Acting<'a> {
    pub(super) fn new(frame: &PlaneFrame<'_>, state: &'a State, loads: &Loads) -> Self {
        let mut floors = vec![0.0; frame.masses_kg.len()];
        let forces = frame.forces(&state.x, &state.v, loads, &mut floors);
        Self { x: &state.x, v: &state.v, loads: *loads, forces, floors: Cow::Owned(floors) }
    }

    /// `w`.
    fn speed(&self) -> Pair {
        [self.v[0], self.v[1]]
    }

    /// `ẇ + a`, `T` and `T − K1 s − N s/R − C1 w`, with the direction of a slip.
    fn on_block(&self, frame: &PlaneFrame<'_>, direction: Option<Pair>) -> [Pair; 3] {
        let (a, Forces { push, spring, damper, .. }) = (table(&self.loads), self.forces);
        let (block, friction) = match direction {
            None => (a, times(push, -frame.block_kg)),
            Some(u) => {
                let slowed = times(u, frame.slowing(&self.loads, norm(self.speed())));
                let moved = frame.body.moved([push[0] - slowed[0], push[1] - slowed[1]]);
                let block = match frame.body.is_one() {
                    true => [0, 1].map(|i| push[i] + a[i] - slowed[i]),
                    false => [moved[0] + a[0], moved[1] + a[1]],
                };
                (block, times(slowed, -frame.block_kg))
            }
        };
        [block, [0, 1].map(|i| friction[i] - spring[i] - damper[i]), friction]
    }
}

/// Vectors of all outputs, in their order, then `s`.
pub(super) struct Tracked<'a> {
    pub(super) frame: &'a PlaneFrame<'a>,
    pub(super) outputs: &'a Outputs,
    /// The direction of the one line on which all moves, if it does.
    pub(super) line: Option<Pair>,
}

impl Tracked<'_> {
    fn len(&self) -> usize {
        self.outputs.len() + 1
    }

    /// In a slip in a direction, or in stick.
    fn vectors(&self, acting: &Acting<'_>, direction: Option<Pair>, out: &mut Vec<Pair>) {
        let (frame, Acting { x, v, .. }) = (self.frame, acting);
        out.clear();
        out.resize(self.len(), [0.0; 2]);
        // On a line friction is along it, whatever rounding makes of a velocity near rest.
        let on_line = |u: Pair| self.line.map_or(u, |line| times(line, dot(u, line).signum()));
        let [block, slider, friction] = acting.on_block(frame, direction.map(on_line));
        let of_part = |j: usize| -acting.floors[j] / frame.masses_kg[j];
        let by_modes = frame.points.as_ref().map(|points| {
            let of = |point: &PointOfModes| {
                [point.vector(|j| x[2 + j], [0.0; 2]), point.vector(of_part, block)]
            };
            points.iter().map(of).collect::<Vec<[Pair; 2]>>()
        });
        for axis in 0..2 {
            self.outputs.each(
                [v[axis], slider[axis], friction[axis], acting.forces.base[axis], 0.0],
                (0.0, block[axis]),
                |i| match &by_modes {
                    Some(points) => points[i].map(|vector| vector[axis]),
                    None => [x[2 + 2 * i + axis], of_part(2 * i + axis)],
                },
                |_| [0.0; 2],
                |g, value| out[g][axis] = value,
            );
        }
        out[self.outputs.len()] = [x[0], x[1]];
    }

    /// Vectors at a point of a step.
    fn at_point(&self, step: &Step, point: usize, out: &mut Vec<Pair>) {
        let acting = step.acting(point);
        let heading = || step.heading(self.frame, point, acting.forces.push);
        self.vectors(&acting, step.slips.then(heading), out);
    }
}

/// Largest sizes so far.
pub(super) struct Peaks {
    /// Of the vectors, along x, along y.
    pub(super) largest: [Vec<f64>; 3],
    /// The same where what is decided by rounding counts too.
    pub(super) possible: [Vec<f64>; 3],
    /// Largest `s` towards the four sides.
    pub(super) sides_m: [f64; 4],
    /// Room for vectors at the points of a step.
    at: [Vec<Pair>; POINTS],
}

impl Peaks {
    pub(super) fn new(tracked: &Tracked<'_>) -> Self {
        let zeros = || core::array::from_fn(|_| vec![0.0; tracked.len()]);
        let at = core::array::from_fn(|_| Vec::new());
        Self { largest: zeros(), possible: zeros(), sides_m: [f64::NEG_INFINITY; 4], at }
    }

    /// Raises the peaks by what is seen at an instant, in a slip in a direction or in stick.
    pub(super) fn see(
        &mut self,
        tracked: &Tracked<'_>,
        acting: &Acting<'_>,
        direction: Option<Pair>,
    ) {
        let mut vectors = Vec::new();
        tracked.vectors(acting, direction, &mut vectors);
        for (g, vector) in vectors.iter().enumerate() {
            for (view, size) in sizes(*vector).into_iter().enumerate() {
                let peak = &mut self.largest[view][g];
                *peak = larger(*peak, size);
            }
        }
        let s = [acting.x[0], acting.x[1]];
        for (most, side) in self.sides_m.iter_mut().zip(SIDES) {
            *most = most.max(dot(s, side));
        }
    }

    /// Raises the peaks by what friction does in all directions between two, by the shorter arc; `all`
    /// directions where there is none.
    pub(super) fn turn(
        &mut self,
        tracked: &Tracked<'_>,
        acting: &Acting<'_>,
        arc: Option<[Pair; 2]>,
        certain: bool,
    ) {
        if !tracked.frame.body.is_one() {
            self.turn_of_body(tracked, acting, arc, certain);
            return;
        }
        let (a, Forces { push, spring, damper, .. }) = (table(&acting.loads), acting.forces);
        let block = unit([-(push[0] + a[0]), -(push[1] + a[1])]);
        let slider = unit([0, 1].map(|i| spring[i] + damper[i]));
        let inside = |u: &Pair| {
            arc.is_none_or(|[from, to]| {
                let turn = cross(from, to);
                turn != 0.0
                    && cross(from, *u) * turn >= 0.0
                    && cross(*u, to) * turn >= 0.0
                    && dot(*u, [from[0] + to[0], from[1] + to[1]]) > 0.0
            })
        };
        let turns = SIDES.into_iter().chain(block).chain(slider).filter(inside);
        let mut vectors = Vec::new();
        let to = if certain { &mut self.largest } else { &mut self.possible };
        for u in turns.chain(arc.into_iter().flatten()) {
            tracked.vectors(acting, Some(u), &mut vectors);
            for g in BY_DIRECTION {
                for (view, size) in sizes(vectors[g]).into_iter().enumerate() {
                    to[view][g] = larger(to[view][g], size);
                }
            }
        }
    }

    /// The same where the acceleration of the block is not along friction: by looking along the arc, and closer where
    /// an output is largest.
    fn turn_of_body(
        &mut self,
        tracked: &Tracked<'_>,
        acting: &Acting<'_>,
        arc: Option<[Pair; 2]>,
        certain: bool,
    ) {
        const LOOKS: usize = 48;
        let full = 2.0 * core::f64::consts::PI;
        let (first, turn) = arc.map_or((0.0, full), |[from, to]| {
            (libm::atan2(from[1], from[0]), libm::atan2(cross(from, to), dot(from, to)))
        });
        let at = |part: f64, out: &mut Vec<Pair>| {
            let angle = first + part * turn;
            tracked.vectors(acting, Some([libm::cos(angle), libm::sin(angle)]), out);
        };
        let mut all = vec![Vec::new(); LOOKS + 1];
        for (i, vectors) in all.iter_mut().enumerate() {
            at(i as f64 / LOOKS as f64, vectors);
        }
        let n = tracked.outputs.points();
        let to = if certain { &mut self.largest } else { &mut self.possible };
        let mut vectors = Vec::new();
        for g in BY_DIRECTION.into_iter().chain((0..n).map(|i| Output::Acceleration(i).place(n))) {
            for view in 0..3 {
                let size = |i: usize| sizes(all[i][g])[view];
                let best =
                    (1..=LOOKS).fold(0, |best, i| if size(i) > size(best) { i } else { best });
                let mut most = size(best);
                let [mut low, mut high] = [best.saturating_sub(1), (best + 1).min(LOOKS)]
                    .map(|i| i as f64 / LOOKS as f64);
                for _ in 0..40 {
                    let [a, b] = [0.4, 0.6].map(|part| low + (high - low) * part);
                    let [of_a, of_b] = [a, b].map(|part| {
                        at(part, &mut vectors);
                        sizes(vectors[g])[view]
                    });
                    most = most.max(of_a).max(of_b);
                    if of_a > of_b { high = b } else { low = a }
                }
                to[view][g] = larger(to[view][g], most);
            }
        }
    }

    /// Raises the peaks by a step; `false` where some may rise by more than the step tells: it is too coarse.
    pub(super) fn follow(
        &mut self,
        rule: &Rule,
        tracked: &Tracked<'_>,
        step: &Step,
        coarse: bool,
    ) -> bool {
        let mut at = core::mem::take(&mut self.at);
        for (point, vectors) in at.iter_mut().enumerate() {
            tracked.at_point(step, point, vectors);
        }
        let tells = self.raise(rule, tracked, &at, coarse);
        self.at = at;
        tells
    }

    /// Whether what [`raise`] and [`raise_size`] take for possible between values at the points is below the peaks,
    /// whichever these values are.
    fn is_below(&self, g: usize, at: &[Vec<Pair>; POINTS]) -> bool {
        let (mut square, mut most, mut sum) = (0.0_f64, [0.0_f64; 2], 0.0);
        for vectors in at {
            let [x, y] = vectors[g];
            square = square.max(x * x + y * y);
            most = [most[0].max(x.abs()), most[1].max(y.abs())];
            sum += x + y;
        }
        let [whole, along @ ..] = &self.largest;
        let is_axis_below = |axis: usize| 1.2 * most[axis] <= along[axis][g];
        !f64::is_nan(sum)
            && 1.21 * square <= whole[g] * whole[g]
            && is_axis_below(0)
            && is_axis_below(1)
    }

    /// The same by the vectors at the points.
    fn raise(
        &mut self,
        rule: &Rule,
        tracked: &Tracked<'_>,
        at: &[Vec<Pair>; POINTS],
        coarse: bool,
    ) -> bool {
        for g in 0..tracked.len() {
            let is_place = g + 1 == tracked.len();
            if !is_place && self.is_below(g, at) {
                continue;
            }
            let parts: [[f64; POINTS]; 2] =
                [0, 1].map(|axis| core::array::from_fn(|i| at[i][g][axis]));
            let part = |axis: usize, t: f64| rule.interpolate(&parts[axis], t);
            let norms: [f64; POINTS] = core::array::from_fn(|i| norm(at[i][g]));
            let [whole, along_x, along_y] = &mut self.largest;
            let tells =
                raise(rule, &mut whole[g], &norms, coarse, |t| norm([part(0, t), part(1, t)]))
                    && raise_size(rule, &mut along_x[g], &parts[0], coarse)
                    && raise_size(rule, &mut along_y[g], &parts[1], coarse);
            if !tells {
                return false;
            }
            if is_place {
                for (i, most) in self.sides_m.iter_mut().enumerate() {
                    let (axis, sign) = (i / 2, SIDES[i][i / 2]);
                    let values = parts[axis].map(|s| sign * s);
                    raise(rule, most, &values, false, |t| sign * part(axis, t));
                }
            }
        }
        true
    }
}
