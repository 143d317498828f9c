//! Choice of a design over a suite of records: a gap kept with a stated probability, and the least
//! floor acceleration.
//!
//! Every design is judged by two figures over the suite, both counted
//! ([`fractile::held_by`](super::fractile::held_by)): the sliding displacement that a share
//! `probability` of the records does not exceed, and the floor acceleration that a share
//! `acceleration_share` of them does not. A design is *feasible* where the first is within the gap.
//! The *front* is the feasible designs that no other feasible design beats: none is at least as good in
//! both figures and better in one.
//!
//! The search looks at every design of its grid and leaves out only runs that cannot change the front.
//! With some records run, the others' demands taken as 0 give lower bounds of both figures; a design
//! is dropped when its bound of displacement is beyond the gap, or when a design of the front is
//! better than both bounds. So the front equals that of the full grid, run for run.

use super::fractile::{held_by, needed, sorted};
use super::proportion::Proportion;
use crate::error::FitError;

/// What is asked of a design.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// Sliding displacement that must be kept, in m, > 0.
    pub gap_m: f64,
    /// Share of the records in which it must be, in (0, 1].
    pub probability: f64,
    /// Share of the records that must not exceed the floor acceleration to be made least, in (0, 1]:
    /// 0.5 for the median.
    pub acceleration_share: f64,
}

/// Peak demands of one run, SI; not finite where it failed, which counts as beyond everything.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Demand {
    /// Peak sliding displacement in m.
    pub displacement_m: f64,
    /// Peak floor acceleration in m/s².
    pub acceleration_m_per_s2: f64,
}

/// A design over the whole suite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figures {
    /// Peak sliding displacement that the asked share of the records does not exceed, in m.
    pub displacement_m: f64,
    /// Peak floor acceleration that the asked share of the records does not exceed, in m/s².
    pub acceleration_m_per_s2: f64,
    /// Records in which the gap is kept.
    pub within: Proportion,
}

/// A design of the front.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Number of the design.
    pub design: usize,
    /// Its figures.
    pub figures: Figures,
}

/// What a search found.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// The front, by rising displacement; the last has the least acceleration.
    pub front: Vec<Point>,
    /// Runs made, of designs × records.
    pub runs: u64,
    /// Designs dropped because they pass the gap too often.
    pub beyond_gap: usize,
    /// Where no design is feasible, the one with the least displacement of all.
    pub nearest: Option<Point>,
}

impl Found {
    /// The feasible design with the least acceleration, and of those the least displacement.
    #[must_use]
    pub fn chosen(&self) -> Option<Point> {
        self.front.last().copied()
    }
}

impl Target {
    /// Checks every number.
    ///
    /// # Errors
    /// [`FitError::OutOfRange`].
    pub fn check(&self) -> Result<(), FitError> {
        if !(self.gap_m.is_finite() && self.gap_m > 0.0) {
            let expected = "a finite gap > 0";
            return Err(FitError::OutOfRange { quantity: "gap", expected, found: self.gap_m });
        }
        for (quantity, found) in
            [("probability", self.probability), ("acceleration share", self.acceleration_share)]
        {
            if !(found > 0.0 && found <= 1.0) {
                let expected = "a share above 0, at most 1";
                return Err(FitError::OutOfRange { quantity, expected, found });
            }
        }
        Ok(())
    }

    /// The figures of a design from its demands, one a record.
    ///
    /// # Errors
    /// [`FitError`] for no demands.
    pub fn figures(&self, demands: &[Demand]) -> Result<Figures, FitError> {
        let [displacement_m, acceleration_m_per_s2] = self.bounds(demands, 0);
        let within = demands.iter().filter(|d| d.displacement_m <= self.gap_m).count();
        let within = Proportion::new(within as u64, demands.len() as u64)?;
        Ok(Figures { displacement_m, acceleration_m_per_s2, within })
    }

    /// Lower bounds of both figures with `missing` records not yet run, their demands taken as 0.
    fn bounds(&self, demands: &[Demand], missing: usize) -> [f64; 2] {
        let of = |pick: fn(&Demand) -> f64, share: f64| {
            let none = std::iter::repeat_n(0.0, missing);
            let values: Vec<f64> = demands.iter().map(pick).chain(none).collect();
            held_by(&sorted(&values), share)
        };
        [
            of(|d| d.displacement_m, self.probability),
            of(|d| d.acceleration_m_per_s2, self.acceleration_share),
        ]
    }
}

/// Designs judged together: the front found so far bounds the next batch.
const BATCH: usize = 256;
/// Parts in which a batch's records are run.
const PARTS: usize = 6;

/// Searches `designs × records` runs for the front.
///
/// `run` gives the demands of pairs (design, record), in their order; it may run them in any order and
/// in parallel. The result depends on nothing else: batches are fixed.
///
/// # Errors
/// [`FitError`] for a target out of range, no designs or no records; and those of `run`.
pub fn search<E: From<FitError>>(
    target: &Target,
    designs: usize,
    records: usize,
    mut run: impl FnMut(&[(usize, usize)]) -> Result<Vec<Demand>, E>,
) -> Result<Found, E> {
    target.check()?;
    for (what, found) in [("designs", designs), ("records", records)] {
        if found == 0 {
            return Err(FitError::TooFew { what, expected: 1, found }.into());
        }
    }
    let mut found = Found { front: Vec::new(), runs: 0, beyond_gap: 0, nearest: None };
    // What a design must keep to be of interest: the gap, or while none keeps that, the least so far.
    let mut kept_m = f64::INFINITY;
    let part = records.div_ceil(PARTS);
    for batch in spread(designs).chunks(BATCH) {
        let mut active: Vec<(usize, Vec<Demand>)> =
            batch.iter().map(|&design| (design, Vec::with_capacity(records))).collect();
        for first in (0..records).step_by(part) {
            let last = (first + part).min(records);
            let pairs: Vec<(usize, usize)> = active
                .iter()
                .flat_map(|(design, _)| (first..last).map(|record| (*design, record)))
                .collect();
            found.runs += pairs.len() as u64;
            let demands = run(&pairs)?;
            for ((_, known), new) in active.iter_mut().zip(demands.chunks(last - first)) {
                known.extend_from_slice(new);
            }
            let missing = records - last;
            active.retain(|(_, known)| {
                let bounds = target.bounds(known, missing);
                if missing > 0 && bounds[0] > kept_m {
                    found.beyond_gap += 1;
                    return false;
                }
                missing == 0 || !found.front.iter().any(|point| beats(point, bounds))
            });
        }
        for (design, demands) in active {
            let point = Point { design, figures: target.figures(&demands)? };
            if point.figures.displacement_m <= target.gap_m {
                insert(&mut found.front, point);
            } else {
                found.beyond_gap += 1;
                let least = |nearest: &Point| {
                    let (new, old) = (point.figures.displacement_m, nearest.figures.displacement_m);
                    new < old || (new == old && point.design < nearest.design)
                };
                if found.nearest.as_ref().is_none_or(least) {
                    found.nearest = Some(point);
                }
            }
            kept_m = kept_m.min(point.figures.displacement_m).max(target.gap_m);
        }
    }
    // Equal figures stand together, the first design first; the last has the least acceleration.
    found.front.sort_by(|a, b| {
        let (of_a, of_b) = (&a.figures, &b.figures);
        of_a.displacement_m
            .total_cmp(&of_b.displacement_m)
            .then(of_b.acceleration_m_per_s2.total_cmp(&of_a.acceleration_m_per_s2))
            .then(b.design.cmp(&a.design))
    });
    if !found.front.is_empty() {
        found.nearest = None;
    }
    Ok(found)
}

/// How many of `records` must keep the gap.
#[must_use]
pub fn records_needed(target: &Target, records: usize) -> usize {
    needed(target.probability, records)
}

/// Whether a point is at least as good in both figures and better in one.
fn beats(point: &Point, [displacement, acceleration]: [f64; 2]) -> bool {
    let Figures { displacement_m: d, acceleration_m_per_s2: a, .. } = point.figures;
    d <= displacement && a <= acceleration && (d < displacement || a < acceleration)
}

fn insert(front: &mut Vec<Point>, point: Point) {
    let figures = [point.figures.displacement_m, point.figures.acceleration_m_per_s2];
    if front.iter().any(|other| beats(other, figures)) {
        return;
    }
    front.retain(|other| {
        let of_other = [other.figures.displacement_m, other.figures.acceleration_m_per_s2];
        !beats(&point, of_other)
    });
    front.push(point);
}

/// All numbers below `n`, every start of the list spread over the whole: steps of the golden ratio.
fn spread(n: usize) -> Vec<usize> {
    let rough = libm::round(n as f64 * 0.618_033_988_749_894_9) as usize;
    let step = (rough.max(1)..=n.max(1)).find(|step| gcd(*step, n) == 1).unwrap_or(1);
    (0..n)
        .scan(0, |at, _| {
            let now = *at;
            *at = (*at + step) % n.max(1);
            Some(now)
        })
        .collect()
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}
