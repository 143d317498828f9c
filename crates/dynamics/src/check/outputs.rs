//! The tracked outputs, and the largest sizes that they attain.

use super::collocation::{Column, POINTS, Rule, add};
use crate::model::{Contents, Model};
use crate::response::output::{BASE_SHEAR, BLOCK, FRICTION, OVERTURNING, Output, SLIDER, VELOCITY};

/// `m z` of the block (to its centre), of the floors and of contents.
struct Arm {
    block: f64,
    floors: Vec<f64>,
    contents: Vec<f64>,
}

/// Masses of the points in kg, and floors and masses of contents.
struct Masses {
    points_kg: Vec<f64>,
    contents_kg: Vec<(usize, f64)>,
}

/// The tracked outputs: linear functions of state, accelerations and forces.
pub(super) struct Outputs {
    /// `None`: no moment is asked for.
    arm: Option<Arm>,
    /// Number of points: floors, or those of a structure by its modes.
    points: usize,
    /// Of those, point by point: what the oscillators add, and what of the motion is the block's.
    of_modes: Option<Vec<(Vec<f64>, f64)>>,
    contents: usize,
    /// For the shears of storeys, where all points have a mass.
    masses: Option<Masses>,
}

impl Outputs {
    pub(super) fn new(model: &Model) -> Self {
        Self::with_moment(model, model.block().width_m.is_some())
    }

    /// With the moment if it is asked for and heights are given.
    pub(super) fn with_moment(model: &Model, asked: bool) -> Self {
        let (points, contents) = (model.points(), model.contents().len());
        let arm = if asked { arm(model) } else { None };
        let of_modes = model.structure().map(|structure| {
            let of = |i: usize| structure.modes.iter().map(move |mode| mode.points[i]);
            (0..points).map(|i| (of(i).collect(), 1.0 - of(i).sum::<f64>())).collect()
        });
        let of_contents = || model.contents().iter().map(|c| (c.floor, c.mass_kg)).collect();
        let masses = model.point_masses_kg().filter(|_| points > 1);
        let masses = masses.map(|points_kg| Masses { points_kg, contents_kg: of_contents() });
        Self { arm, points, of_modes, contents, masses }
    }

    /// How many there are, with the force of a stop, which stands last.
    pub(super) fn len(&self) -> usize {
        self.of_stop() + 1
    }

    /// Place of the force of a stop.
    pub(super) fn of_stop(&self) -> usize {
        Output::count(self.points, self.contents)
    }

    /// Place of an output.
    #[inline(always)]
    pub(super) fn place(&self, output: Output) -> usize {
        output.place(self.points)
    }

    /// Number of points.
    pub(super) fn points(&self) -> usize {
        self.points
    }

    /// Hands on all outputs in their order, at some instants. Those of the block are its velocity, the forces of slider
    /// and friction, the base shear and the force on a stop; then come total accelerations, all with the slope's
    /// share: of the block, of points beside their displacements and velocities, of contents beside their velocities.
    #[inline(always)]
    pub(super) fn each<const N: usize>(
        &self,
        [w, slider, friction, base, stop]: [&Column<N>; 5],
        (slope, block): (f64, &Column<N>),
        point: impl Fn(usize) -> [Column<N>; 3],
        carried: impl Fn(usize) -> [Column<N>; 2],
        mut out: impl FnMut(usize, Column<N>),
    ) {
        let less_slope = |total: &Column<N>| total.map(|total| total - slope);
        out(VELOCITY, *w);
        out(BLOCK, less_slope(block));
        out(SLIDER, *slider);
        out(FRICTION, *friction);
        out(BASE_SHEAR, *base);
        out(self.of_stop(), *stop);
        // The moment about the sliding surface.
        let mut moment = self.arm.as_ref().map(|arm| (arm, block.map(|block| block * arm.block)));
        let mut below = None;
        for i in 0..self.points {
            let [q, v, total] = point(i);
            let mut drift = [q, v];
            out(self.place(Output::Displacement(i)), q);
            if let Some(below) = &below {
                drift.iter_mut().zip(below).for_each(|(drift, below)| add(drift, -1.0, below));
                out(self.place(Output::Drift(i)), drift[0]);
            }
            out(self.place(Output::DriftVelocity(i)), drift[1]);
            out(self.place(Output::Acceleration(i)), less_slope(&total));
            below = Some([q, v]);
            if let Some((arm, sum)) = &mut moment {
                add(sum, arm.floors[i], &total);
            }
        }
        for e in 0..self.contents {
            let [velocity, total] = carried(e);
            out(self.place(Output::ContentsVelocity(e)), velocity);
            out(self.place(Output::ContentsAcceleration(e)), less_slope(&total));
            if let Some((arm, sum)) = &mut moment {
                add(sum, arm.contents[e], &total);
            }
        }
        if let Some((_, sum)) = moment {
            out(OVERTURNING, sum);
        }
        // From the top down: a storey moves all above it.
        if let Some(Masses { points_kg, contents_kg }) = &self.masses {
            let mut sum = [0.0; N];
            for i in (1..self.points).rev() {
                let [_, _, total] = point(i);
                add(&mut sum, -points_kg[i], &total);
                for (e, (floor, kg)) in contents_kg.iter().enumerate() {
                    if *floor == i + 1 {
                        let [_, total] = carried(e);
                        add(&mut sum, -kg, &total);
                    }
                }
                out(self.place(Output::StoreyShear(i)), sum);
            }
        }
    }

    /// Displacement, velocity and total acceleration of a point, from those of floors or oscillators: `Σ φ η`, `Σ φ η̇`
    /// and `Σ φ η̈ + u`.
    #[inline(always)]
    pub(super) fn point<const N: usize>(
        &self,
        i: usize,
        block: &Column<N>,
        of: impl Fn(usize) -> [Column<N>; 3],
    ) -> [Column<N>; 3] {
        let Some(of_modes) = &self.of_modes else { return of(i) };
        let (factors, with_block) = &of_modes[i];
        let mut sums = [[0.0; N], [0.0; N], block.map(|block| block * with_block)];
        for (j, factor) in factors.iter().enumerate() {
            sums.iter_mut().zip(of(j)).for_each(|(sum, own)| add(sum, *factor, &own));
        }
        sums
    }

    /// Height of what a moment is asked of, in m; 0 without one.
    pub(super) fn height_m(&self, model: &Model) -> f64 {
        let block_m = model.block().height_m.unwrap_or(0.0);
        let points = model.lever_arms();
        let highest = points.iter().flatten().fold(block_m, |most, [_, above_m]| above_m.max(most));
        if self.arm.is_some() { highest } else { 0.0 }
    }

    /// Whether a moment is asked for.
    pub(super) fn has_moment(&self) -> bool {
        self.arm.is_some()
    }
}

/// The arms, where heights are given.
fn arm(model: &Model) -> Option<Arm> {
    let points = model.lever_arms()?;
    let block_m = model.block().height_m.unwrap_or(0.0);
    let height_m = |floor: usize| floor.checked_sub(1).map_or(block_m, |floor| points[floor][1]);
    let contents = model.contents().iter();
    Some(Arm {
        block: 0.5 * block_m * model.bare_block_kg(),
        floors: points.iter().map(|[mass_kg, above_m]| mass_kg * above_m).collect(),
        contents: contents.map(|c: &Contents| c.mass_kg * height_m(c.floor)).collect(),
    })
}

/// Raises a peak to the largest value in a step, known at its points; `false` where a coarse step may raise
/// it.
pub(super) fn raise(
    rule: &Rule,
    peak: &mut f64,
    values: &[f64; POINTS],
    coarse: bool,
    of: impl Fn(f64) -> f64,
) -> bool {
    let best = (1..POINTS).fold(0, |best, i| if values[i] > values[best] { i } else { best });
    if values.iter().any(|value| value.is_nan()) {
        *peak = f64::INFINITY;
        return true;
    }
    let least = values.iter().fold(values[best], |least, value| value.min(least));
    // Between two points the polynomial rises above both by less than a tenth of its range.
    let may_reach = values[best] + 0.1 * (values[best] - least);
    if may_reach <= *peak + 1e-12 * peak.abs() {
        *peak = peak.max(values[best]);
        return true;
    }
    if coarse {
        return false;
    }
    let (_, lowest) = rule.least_of((best, -values[best]), |t| -of(t));
    *peak = peak.max(values[best]).max(-lowest);
    true
}

/// Whether a polynomial through values at the points stays below a peak, whichever these values are: between two points
/// it rises above both by less than a tenth of its range.
#[inline(always)]
pub(super) fn is_below(values: &[f64; POINTS], peak: f64) -> bool {
    values.iter().fold(true, |below, value| below & (1.2 * value.abs() <= peak))
}

/// Raises a peak to the largest size of a polynomial through the values at the points of a step, likewise.
#[inline]
pub(super) fn raise_size(
    rule: &Rule,
    peak: &mut f64,
    values: &[f64; POINTS],
    coarse: bool,
) -> bool {
    let is_larger = |i: usize, best: usize| values[i].abs() > values[best].abs();
    let best = (1..POINTS).fold(0, |best, i| if is_larger(i, best) { i } else { best });
    let sign = values[best].signum();
    let of = |t: f64| sign * rule.interpolate(values, t);
    raise(rule, peak, &values.map(|value| sign * value), coarse, of)
}
