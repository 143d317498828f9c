//! The outputs of a motion in a plane, and the largest sizes that they and their parts attain.
//!
//! In a step whose last Legendre coefficients are rounding all outputs are polynomials as good as the motion.

use super::super::collocation::{Column, POINTS, Rule};
use super::super::outputs::{Outputs, is_below, raise, raise_size};
use super::super::structure::larger;
use super::body::PointOfModes;
use super::frame::{Forces, Pair, PlaneFrame, Under, cross, dot, norm, pair, times, unit};
use super::step::Step;
use crate::numerics::InstructionSet;
use crate::numerics::instructions::vectorize;
use crate::response::output::{BLOCK, FRICTION, OVERTURNING, Output, SLIDER};

/// The outputs that the direction of friction decides.
const BY_DIRECTION: [usize; 4] = [BLOCK, SLIDER, FRICTION, OVERTURNING];
/// Sides of the axes on which the largest `s` is looked for: +x, −x, +y, −y.
const SIDES: [Pair; 4] = [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]];

/// Sizes of a vector and of its parts along x and y.
fn sizes(vector: Pair) -> [f64; 3] {
    [norm(vector), vector[0].abs(), vector[1].abs()]
}

/// What moves and acts at some instants.
pub(super) struct Acting<const N: usize> {
    /// `x` and `v` one after the other.
    states: Vec<Column<N>>,
    pub(super) under: Under<N>,
    pub(super) forces: Forces<N>,
    /// `K q + C q̇`.
    pub(super) floors: Vec<Column<N>>,
}

impl<const N: usize> Acting<N> {
    #[inline(always)]
    pub(super) fn new(frame: &PlaneFrame<'_>, states: Vec<Column<N>>, under: Under<N>) -> Self {
        let mut floors = vec![[0.0; N]; frame.masses_kg.len()];
        let (x, v) = states.split_at(states.len() / 2);
        let forces = frame.forces([x, v], &under, &mut floors);
        Self { states, under, forces, floors }
    }

    pub(super) fn x(&self) -> &[Column<N>] {
        &self.states[..self.states.len() / 2]
    }

    pub(super) fn v(&self) -> &[Column<N>] {
        &self.states[self.states.len() / 2..]
    }

    /// `ẇ + a`, `T` and `T − K1 s − N s/R − C1 w`, with the directions of a slip.
    #[inline(always)]
    fn on_block(
        &self,
        frame: &PlaneFrame<'_>,
        along: Option<&[Column<N>; 2]>,
    ) -> [[Column<N>; 2]; 3] {
        let (a, push) = (&self.under.a, &self.forces.push);
        let Some(along) = along else {
            let friction = push.map(|push| push.map(|p| -frame.block_kg * p));
            return [*a, self.on_slider(&friction), friction];
        };
        let w = self.v();
        let (mut block, mut friction) = ([[0.0; N]; 2], [[0.0; N]; 2]);
        for i in 0..N {
            let speed = norm([w[0][i], w[1][i]]);
            let [f, _] = frame.slowing_and_slope(self.under.normal[i], speed);
            let slowed = times(pair(along, i), f);
            let [p, a] = [push, a].map(|columns| pair(columns, i));
            let whole = match frame.body.is_one() {
                true => [0, 1].map(|k| p[k] + a[k] - slowed[k]),
                false => {
                    let moved = frame.body.moved([p[0] - slowed[0], p[1] - slowed[1]]);
                    [moved[0] + a[0], moved[1] + a[1]]
                }
            };
            for axis in 0..2 {
                block[axis][i] = whole[axis];
                friction[axis][i] = -frame.block_kg * slowed[axis];
            }
        }
        [block, self.on_slider(&friction), friction]
    }

    #[inline(always)]
    fn on_slider(&self, friction: &[Column<N>; 2]) -> [Column<N>; 2] {
        let Forces { spring, damper, stop, .. } = &self.forces;
        [0, 1].map(|axis| {
            core::array::from_fn(|i| {
                friction[axis][i] - spring[axis][i] - damper[axis][i] - stop[axis][i]
            })
        })
    }
}

/// Vectors of all outputs, in their order, then `s`.
pub(super) struct Tracked<'a> {
    pub(super) frame: &'a PlaneFrame<'a>,
    pub(super) outputs: &'a Outputs,
    pub(super) instructions: InstructionSet,
    /// The direction of the one line on which all moves, if it does.
    pub(super) line: Option<Pair>,
    /// Whether rounding tells the direction of friction: what it decides is not looked for.
    pub(super) turns: bool,
}

impl Tracked<'_> {
    fn len(&self) -> usize {
        self.outputs.len() + 1
    }

    /// The outputs that the direction of friction decides: those of points too where it does not push along itself.
    fn by_direction(&self) -> impl Iterator<Item = usize> + use<> {
        let n = self.outputs.points();
        let points = if self.frame.body.is_one() { 0 } else { n };
        BY_DIRECTION.into_iter().chain((0..points).map(move |i| Output::Acceleration(i).place(n)))
    }

    /// On one line, as in one direction, friction takes what it can of the push of a block at rest against a stop that does
    /// not give way; else the stop takes what pushes towards it.
    #[inline(always)]
    fn share<const N: usize>(
        &self,
        (friction, stop): (&mut [Column<N>; 2], &mut [Column<N>; 2]),
        (acting, i): (&Acting<N>, usize),
    ) {
        let Some(line) = self.line.filter(|_| self.frame.wall().is_some()) else {
            return;
        };
        let taken_n = dot(pair(stop, i), line);
        let most_n = self.frame.most_held_n(acting.under.normal[i]);
        for axis in 0..2 {
            let own = line[axis] * taken_n.clamp(-most_n, most_n);
            friction[axis][i] -= own;
            stop[axis][i] -= own;
        }
    }

    /// In a slip in directions, or in stick.
    #[inline(always)]
    fn vectors<const N: usize>(
        &self,
        acting: &Acting<N>,
        directions: Option<[Column<N>; 2]>,
        out: &mut Vec<[Column<N>; 2]>,
    ) {
        let (frame, x, v) = (self.frame, acting.x(), acting.v());
        out.clear();
        out.resize(self.len(), [[0.0; N]; 2]);
        // On a line friction is along it, whatever rounding makes of a velocity near rest.
        let directions = directions.map(|mut along| {
            for (i, line) in self.line.iter().flat_map(|line| (0..N).map(move |i| (i, line))) {
                let own = times(*line, dot(pair(&along, i), *line).signum());
                (0..2).for_each(|axis| along[axis][i] = own[axis]);
            }
            along
        });
        let rests = directions.is_none();
        let [block, slider, mut friction] = acting.on_block(frame, directions.as_ref());
        let mut stop = acting.forces.stop;
        for i in (0..N).filter(|_| rests && acting.under.pressed) {
            self.share((&mut friction, &mut stop), (acting, i));
        }
        let of_part = |part: usize, i: usize| -acting.floors[part][i] / frame.masses_kg[part];
        // Displacement, velocity and acceleration of a point, along x and along y.
        let of_modes = |point: &PointOfModes| {
            let mut of = [[[0.0; N]; 3]; 2];
            for i in 0..N {
                let q = point.vector(|j| x[2 + j][i], [0.0; 2]);
                let rate = point.vector(|j| v[2 + j][i], [0.0; 2]);
                let total = point.vector(|j| of_part(j, i), pair(&block, i));
                for (axis, of) in of.iter_mut().enumerate() {
                    (of[0][i], of[1][i], of[2][i]) = (q[axis], rate[axis], total[axis]);
                }
            }
            of
        };
        let by_modes: Option<Vec<_>> =
            frame.points.as_ref().map(|points| points.iter().map(of_modes).collect());
        for axis in 0..2 {
            self.outputs.each(
                {
                    let forces = &acting.forces;
                    [&v[axis], &slider[axis], &friction[axis], &forces.base[axis], &stop[axis]]
                },
                (frame.slope[axis], &block[axis]),
                |point| match &by_modes {
                    Some(points) => points[point][axis],
                    None => {
                        let part = 2 * point + axis;
                        let total = core::array::from_fn(|i| of_part(part, i));
                        [x[2 + part], v[2 + part], total]
                    }
                },
                |_| [[0.0; N]; 2],
                |g, value| out[g][axis] = value,
            );
        }
        out[self.outputs.len()] = [x[0], x[1]];
    }
}

/// Largest sizes so far.
pub(super) struct Peaks {
    /// Of the vectors, along x, along y.
    pub(super) largest: [Vec<f64>; 3],
    /// Largest sizes where what is decided by rounding counts too.
    pub(super) possible: [Vec<f64>; 3],
    /// Largest `s` towards the four sides.
    pub(super) sides_m: [f64; 4],
    /// Largest `|r_x| + |r_y|` of the overturning ratios, and what it may be where rounding decides.
    pub(super) corner: [f64; 2],
    /// Room for vectors at the points of a step.
    at: Vec<[Column<POINTS>; 2]>,
}

impl Peaks {
    pub(super) fn new(outputs: &Outputs) -> Self {
        let zeros = || core::array::from_fn(|_| vec![0.0; outputs.len() + 1]);
        let (sides_m, at) = ([f64::NEG_INFINITY; 4], Vec::new());
        Self { largest: zeros(), possible: zeros(), sides_m, corner: [0.0; 2], at }
    }

    /// Raises the peaks by what is seen at an instant, in a slip in a direction or in stick.
    pub(super) fn see(
        &mut self,
        tracked: &Tracked<'_>,
        acting: &Acting<1>,
        direction: Option<Pair>,
    ) {
        let mut vectors = Vec::new();
        tracked.vectors(acting, direction.map(|u| u.map(|u| [u])), &mut vectors);
        for (g, vector) in vectors.iter().enumerate() {
            for (view, size) in sizes(pair(vector, 0)).into_iter().enumerate() {
                let peak = &mut self.largest[view][g];
                *peak = larger(*peak, size);
            }
        }
        self.see_corner(tracked, pair(&vectors[OVERTURNING], 0), true);
        let s = [0, 1].map(|axis| acting.x()[axis][0]);
        for (most, side) in self.sides_m.iter_mut().zip(SIDES) {
            *most = most.max(dot(s, side));
        }
    }

    /// Raises the overturning ratio of both axes together by moments.
    fn see_corner(&mut self, tracked: &Tracked<'_>, [x, y]: Pair, certain: bool) {
        if let Some(per) = tracked.frame.per_resisted {
            let sum = (per[0] * x).abs() + (per[1] * y).abs();
            let most = &mut self.corner[usize::from(!certain)];
            *most = larger(*most, sum);
        }
    }

    /// Raises the peaks by what friction does in all directions between two, by the shorter arc; `all`
    /// directions where there is none.
    pub(super) fn turn(
        &mut self,
        tracked: &Tracked<'_>,
        acting: &Acting<1>,
        arc: Option<[Pair; 2]>,
        certain: bool,
    ) {
        if !tracked.frame.body.is_one() {
            self.turn_of_body(tracked, acting, arc, certain);
            return;
        }
        let Forces { push, spring, damper, stop, .. } = &acting.forces;
        let [push, spring, damper, stop, a] =
            [push, spring, damper, stop, &acting.under.a].map(|columns| pair(columns, 0));
        let slope = tracked.frame.slope;
        let block = unit([0, 1].map(|i| slope[i] - (push[i] + a[i])));
        let slider = unit([0, 1].map(|i| spring[i] + damper[i] + stop[i]));
        let inside = |u: &Pair| {
            arc.is_none_or(|[from, to]| {
                let turn = cross(from, to);
                turn != 0.0
                    && cross(from, *u) * turn >= 0.0
                    && cross(*u, to) * turn >= 0.0
                    && dot(*u, [from[0] + to[0], from[1] + to[1]]) > 0.0
            })
        };
        // Of r_x ± r_y, in which the block's acceleration is by its own height.
        let diagonal = tracked.frame.per_resisted.and_then(unit);
        let diagonals = diagonal.map(|[x, y]| [[x, y], [-x, -y], [x, -y], [-x, y]]);
        let turns = SIDES.into_iter().chain(block).chain(slider);
        let turns = turns.chain(diagonals.into_iter().flatten()).filter(inside);
        let mut vectors = Vec::new();
        for u in turns.chain(arc.into_iter().flatten()) {
            tracked.vectors(acting, Some(u.map(|u| [u])), &mut vectors);
            self.see_corner(tracked, pair(&vectors[OVERTURNING], 0), certain);
            let to = if certain { &mut self.largest } else { &mut self.possible };
            for g in tracked.by_direction() {
                for (view, size) in sizes(pair(&vectors[g], 0)).into_iter().enumerate() {
                    to[view][g] = larger(to[view][g], size);
                }
            }
        }
    }

    /// Raises the peaks of an arc where the acceleration of the block is not along friction: by looking along it, and
    /// closer where an output is largest.
    fn turn_of_body(
        &mut self,
        tracked: &Tracked<'_>,
        acting: &Acting<1>,
        arc: Option<[Pair; 2]>,
        certain: bool,
    ) {
        const LOOKS: usize = 48;
        let full = 2.0 * core::f64::consts::PI;
        let (first, turn) = arc.map_or((0.0, full), |[from, to]| {
            (libm::atan2(from[1], from[0]), libm::atan2(cross(from, to), dot(from, to)))
        });
        let at = |part: f64, out: &mut Vec<[Column<1>; 2]>| {
            let angle = first + part * turn;
            tracked.vectors(acting, Some([[libm::cos(angle)], [libm::sin(angle)]]), out);
        };
        let mut all = vec![Vec::new(); LOOKS + 1];
        for (i, vectors) in all.iter_mut().enumerate() {
            at(i as f64 / LOOKS as f64, vectors);
        }
        let mut vectors = Vec::new();
        if let Some(per) = tracked.frame.per_resisted {
            let sum = |moments: Pair| (per[0] * moments[0]).abs() + (per[1] * moments[1]).abs();
            let own = |i: usize| sum(pair(&all[i][OVERTURNING], 0));
            let most = largest_along(own, LOOKS, |part| {
                at(part, &mut vectors);
                sum(pair(&vectors[OVERTURNING], 0))
            });
            let to = &mut self.corner[usize::from(!certain)];
            *to = larger(*to, most);
        }
        let to = if certain { &mut self.largest } else { &mut self.possible };
        for g in tracked.by_direction() {
            for view in 0..3 {
                let size = |i: usize| sizes(pair(&all[i][g], 0))[view];
                let most = largest_along(size, LOOKS, |part| {
                    at(part, &mut vectors);
                    sizes(pair(&vectors[g], 0))[view]
                });
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
        vectorize!(tracked.instructions, _simd => self.follow_here(rule, tracked, step, coarse))
    }

    #[inline(always)]
    fn follow_here(
        &mut self,
        rule: &Rule,
        tracked: &Tracked<'_>,
        step: &Step,
        coarse: bool,
    ) -> bool {
        let mut at = core::mem::take(&mut self.at);
        tracked.vectors(&step.acting, step.slips.then_some(step.headings), &mut at);
        let tells = self.raise(rule, tracked, &at, coarse);
        self.at = at;
        tells
    }

    /// Whether what [`raise`] and [`raise_size`] take for possible between values at the points is below the peaks,
    /// whichever these values are.
    #[inline(always)]
    fn is_below(&self, g: usize, vector: &[Column<POINTS>; 2]) -> bool {
        let (mut square, mut most, mut sum) = (0.0_f64, [0.0_f64; 2], 0.0);
        for i in 0..POINTS {
            let [x, y] = pair(vector, i);
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

    /// Raises the peaks by the vectors at the points of a step.
    #[inline(always)]
    fn raise(
        &mut self,
        rule: &Rule,
        tracked: &Tracked<'_>,
        at: &[[Column<POINTS>; 2]],
        coarse: bool,
    ) -> bool {
        if let Some(per) = tracked.frame.per_resisted.filter(|_| !tracked.turns) {
            let moments = &at[OVERTURNING];
            for sign in [1.0, -1.0] {
                let sum: Column<POINTS> = core::array::from_fn(|i| {
                    per[0] * moments[0][i] + sign * (per[1] * moments[1][i])
                });
                if !is_below(&sum, self.corner[0])
                    && !raise_size(rule, &mut self.corner[0], &sum, coarse)
                {
                    return false;
                }
            }
        }
        let left: Vec<_> = tracked.by_direction().filter(|_| tracked.turns).collect();
        for (g, parts) in at.iter().enumerate() {
            let is_place = g + 1 == tracked.len();
            if !is_place && (left.contains(&g) || self.is_below(g, parts)) {
                continue;
            }
            let part = |axis: usize, t: f64| rule.interpolate(&parts[axis], t);
            let norms: [f64; POINTS] = core::array::from_fn(|i| norm(pair(parts, i)));
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

/// The largest value of a function of a part, known at so many parts and sought closer about the largest of them.
fn largest_along(
    known: impl Fn(usize) -> f64,
    count: usize,
    mut of: impl FnMut(f64) -> f64,
) -> f64 {
    let best = (1..=count).fold(0, |best, i| if known(i) > known(best) { i } else { best });
    let mut most = known(best);
    let [mut low, mut high] =
        [best.saturating_sub(1), (best + 1).min(count)].map(|i| i as f64 / count as f64);
    for _ in 0..40 {
        let [a, b] = [0.4, 0.6].map(|part| low + (high - low) * part);
        let [of_a, of_b] = [of(a), of(b)];
        most = most.max(of_a).max(of_b);
        if of_a > of_b { high = b } else { low = a }
    }
    most
}
