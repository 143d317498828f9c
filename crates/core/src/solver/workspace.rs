//! Room that one analysis leaves to the next.

use super::dense::Candidate;
use super::peaks::Peaks;
use crate::linear::Series;
use crate::linear::lanes::Eight;
use crate::response::Event;

/// Room for analyses, one after another, of any models: with it a run of friction without memory
/// allocates nothing but its answer.
#[derive(Debug, Default)]
pub struct Workspace {
    /// `a` at the samples, where the slope adds to it.
    pub(super) acceleration: Vec<f64>,
    /// `N` at the samples, where it varies.
    pub(super) normal_n: Vec<f64>,
    pub(super) states: [Vec<f64>; 2],
    pub(super) values: Vec<Eight>,
    pub(super) series: Series,
    pub(super) modes: [Vec<f64>; 3],
    pub(super) peaks: Peaks,
    pub(super) events: Vec<Event>,
    pub(super) candidates: Vec<Candidate>,
}

impl Workspace {
    /// A list from a place of this, of so many of a value.
    pub(super) fn list<T: Clone>(place: &mut Vec<T>, count: usize, value: T) -> Vec<T> {
        let mut list = core::mem::take(place);
        list.clear();
        list.resize(count, value);
        list
    }
}
