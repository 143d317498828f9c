//! The work space of intervals that are judged eight at a time.

use super::super::collocation::{MOST_TERMS, NODES};
use super::super::energy::Books;
use super::super::ground::Ground;
use super::super::lane::{Eight, LANES};
use super::super::outputs::Outputs;
use super::knots::{LaneJudge, Worst};
use super::watch::{Extremes, Watch};
use crate::progress::Pulse;

/// What is told of the energies of an interval.
#[derive(Clone, Copy, Default)]
pub(super) struct Spent {
    pub(super) work: Eight,
    pub(super) size: Eight,
    pub(super) damping: Eight,
    pub(super) friction: Eight,
    /// What the rounding of `N` makes of them.
    pub(super) blur: Eight,
}

impl Spent {
    /// Enters it for the intervals from these knots on.
    pub(super) fn enter(&self, knots: &[usize; LANES], books: &mut Books) {
        let lists = [
            (&mut books.work, &self.work),
            (&mut books.size, &self.size),
            (&mut books.damping, &self.damping),
            (&mut books.friction, &self.friction),
            (&mut books.blur, &self.blur),
        ];
        let (first, last) = (knots[0], knots[LANES - 1]);
        let contiguous = knots.windows(2).all(|pair| pair[1] == pair[0] + 1);
        for (list, values) in lists.into_iter().filter(|(list, _)| !list.is_empty()) {
            if contiguous {
                list[first..=last].copy_from_slice(&values.0);
                continue;
            }
            for (knot, value) in knots.iter().zip(&values.0) {
                list[*knot] = *value;
            }
        }
    }
}

/// Inputs and paths of a group under judgement.
pub(super) struct Work {
    pub(super) input: Vec<Eight>,
    /// The inputs that are not 0, and a state at a node.
    pub(super) active: Vec<Eight>,
    /// Of an even interval: Legendre's terms, then the velocities at its end.
    pub(super) sums: Vec<Eight>,
    pub(super) state: Vec<(Eight, Eight)>,
    /// Accelerations of the block, the floors and the contents, with the slope's share.
    pub(super) bodies: Vec<Eight>,
    /// `v` at the nodes, `x` and `v` at the end, what is asked of each interface at the nodes.
    pub(super) path: Vec<Eight>,
    /// `x` at the nodes, and `ẍ` where the equations were solved.
    pub(super) trace: Vec<Eight>,
    pub(super) fastest: Vec<Eight>,
    /// Outputs at the nodes, and at the ends of a step within an interval.
    pub(super) values: Vec<Eight>,
    pub(super) ends: [Vec<Eight>; 2],
    pub(super) seen: Vec<Extremes>,
    pub(super) spent: Spent,
    pub(super) watch: Vec<Watch<Eight>>,
}

impl Work {
    pub(super) fn new(bench: &LaneJudge<'_>, outputs: usize) -> Self {
        let zeros = |count: usize| vec![Eight::ZERO; count];
        let (d, e) = (bench.structure.degrees(), bench.structure.contents.len());
        Self {
            input: zeros(bench.inputs() + 2),
            active: zeros(bench.inputs()),
            sums: zeros((MOST_TERMS + 1) * d),
            state: vec![(Eight::ZERO, Eight::ZERO); d],
            bodies: zeros(d),
            path: zeros((NODES + 2) * d + NODES * (1 + e)),
            trace: zeros(2 * NODES * d),
            fastest: zeros(d),
            values: zeros(NODES * outputs),
            ends: [zeros(outputs), zeros(outputs)],
            seen: vec![Extremes::default(); 1 + e],
            spent: Spent::default(),
            watch: vec![Watch::default(); 1 + e],
        }
    }

    /// Starts where the last step has ended.
    pub(super) fn go_on(&mut self, degrees: usize) {
        self.input[..2 * degrees]
            .copy_from_slice(&self.path[NODES * degrees..(NODES + 2) * degrees]);
    }
}

/// What a pass through groups reads and changes besides them.
pub(super) struct Pass<'p, 'g> {
    pub(super) ground: &'p mut Ground<'g>,
    pub(super) outputs: &'p Outputs,
    pub(super) attained: &'p mut [f64],
    pub(super) books: &'p mut Books,
    pub(super) work: &'p mut Work,
    pub(super) worst: &'p mut Worst,
    pub(super) pulse: &'p mut Pulse<'g>,
}
