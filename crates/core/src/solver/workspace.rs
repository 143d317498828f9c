//! Room that one analysis leaves to the next.

use super::course::Release;
use super::dense::Candidate;
use super::modal::Peaks;
use super::prepared::Prepared;
use crate::linear::Series;
use crate::linear::lanes::Eight;
use crate::model::Model;
use crate::response::Event;

/// Room for analyses, one after another, of any models: with it a run of friction without memory
/// allocates nothing but its answer. It remembers the tables that were made last.
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
    pub(super) released: Vec<Release>,
    pub(super) events: Vec<Event>,
    pub(super) candidates: Vec<Candidate>,
    last: Option<Prepared>,
}

impl Workspace {
    /// Prepares a model for motions of one step in s, or of none: with the tables that were made last in
    /// this room where they serve.
    pub fn prepare(&mut self, model: &Model, dt_s: Option<f64>) -> Prepared {
        let prepared = match self.last.take().filter(|last| last.dt_s() == dt_s) {
            Some(last) => last.with_model(model.clone()),
            None => Prepared::new(model.clone(), dt_s),
        };
        self.last = Some(prepared.clone());
        prepared
    }

    /// A list from a place of this, of so many of a value.
    pub(super) fn list<T: Clone>(place: &mut Vec<T>, count: usize, value: T) -> Vec<T> {
        let mut list = core::mem::take(place);
        list.clear();
        list.resize(count, value);
        list
    }
}
