//! Buffers that one analysis leaves to the next.

use super::Peaks;
use crate::linear::ModalSeries;
use crate::linear::lanes::Eight;
use crate::response::Event;
use crate::solver::course::Release;
use crate::solver::dense::Candidate;

/// Lists that keep their memory.
#[derive(Debug, Default)]
pub(in crate::solver) struct Buffers {
    pub(super) states: [Vec<f64>; 2],
    pub(super) values: Vec<Eight>,
    pub(super) series: ModalSeries,
    pub(super) modes: [Vec<f64>; 3],
    pub(in crate::solver) peaks: Peaks,
    pub(in crate::solver) released: Vec<Release>,
    pub(in crate::solver) events: Vec<Event>,
    pub(super) candidates: Vec<Candidate>,
}

impl Buffers {
    /// A list from a place of this, of so many of a value.
    pub(super) fn list<T: Clone>(place: &mut Vec<T>, count: usize, value: T) -> Vec<T> {
        let mut list = core::mem::take(place);
        list.clear();
        list.resize(count, value);
        list
    }
}
