//! One model with many values: what a study sets anew for every sample.

use std::sync::Arc;

use super::build::{self, Parts};
use super::keys::MODEL;
use super::plan::Varied;
use super::reader::Values;
use super::schema::Range;
use super::{Analysis, FrictionBounds, MAX_TEXT_BYTES, Names, Override, parse, tree};
use crate::error::InputError;
use crate::response::DemandShape;

/// A model text in which numbers at some paths take the place of what stands there.
///
/// A sample is checked as `--set` checks it, and gives the same bits; only the text is read once.
#[derive(Clone, Debug)]
pub struct Variation {
    name: Arc<str>,
    text: Arc<str>,
    /// Keys set once, before those of a sample.
    set: Arc<[Override]>,
    paths: Arc<[Path]>,
    /// The text with every path set, to numbers that do not matter.
    values: Values,
}

#[derive(Clone, Debug)]
struct Path {
    path: String,
    unit: &'static str,
    range: Range,
    /// Whether it is of the records, and no key of the text.
    of_records: bool,
}

impl Variation {
    /// Reads a model text whose numbers at the paths of `vary` will be set.
    ///
    /// `name` is what errors call the text.
    ///
    /// # Errors
    /// [`InputError`] for a text that is no model, whatever stands at those paths; for paths that
    /// the model lacks (a storey too many), and for two paths of which one removes the other.
    pub fn new(name: &str, text: &str, vary: &[Varied]) -> Result<Self, InputError> {
        Self::with(name, text, &[], vary)
    }

    /// As [`Variation::new`], with keys of the text set first.
    ///
    /// # Errors
    /// As [`Variation::new`], and for keys that cannot be set.
    pub fn with(
        name: &str,
        text: &str,
        set: &[Override],
        vary: &[Varied],
    ) -> Result<Self, InputError> {
        let mut sources = tree::Sources::default();
        let file = sources.add(name, text);
        if text.len() > MAX_TEXT_BYTES {
            // The reader's own message.
            parse(name, text, &[])?;
        }
        let mut root = tree::parse_document(&sources, file)?;
        let paths: Vec<Path> = vary
            .iter()
            .map(|varied| Path {
                path: varied.path.clone(),
                unit: varied.unit,
                range: varied.range,
                of_records: varied.of_records,
            })
            .collect();
        for set in set {
            set.apply(&mut sources, &mut root)?;
        }
        for path in paths.iter().filter(|path| !path.of_records) {
            // One half lies within every range.
            path.set(0.5)?.replace(&mut sources, &mut root)?;
        }
        let values = Values::read(sources, &root, &MODEL)?;
        let (name, text) = (name.into(), text.into());
        let this = Self { name, text, set: set.into(), paths: paths.into(), values };
        for path in this.paths.iter() {
            if !path.of_records && this.values.number(&path.path).is_none() {
                let expected = "no other varied path that takes its place";
                let found = format!("\"{}\" removed by another", path.path);
                return Err(this.values.error(&path.path, expected, found));
            }
        }
        Ok(this)
    }

    /// The same for motions from outside the text in two horizontal directions.
    #[must_use]
    pub fn in_plane(mut self) -> Self {
        self.values.in_plane = true;
        self
    }

    /// Refuses a model that speaks of two horizontal directions where motions are in one.
    ///
    /// # Errors
    /// [`InputError`] at the key that speaks of the second.
    pub fn along_x_alone(&self) -> Result<(), InputError> {
        super::along_x_alone(&self.values)
    }

    /// The model with the numbers of a sample, in the order of the paths, in SI.
    ///
    /// # Errors
    /// [`InputError`], the one that `slipstick run` gives for the same values.
    pub fn parts(&self, numbers: &[f64]) -> Result<Parts, InputError> {
        // What was read is shared by all samples; only their numbers are their own.
        let mut values = self.values.clone();
        let mut in_range = true;
        for (path, &number) in self.paths.iter().zip(numbers) {
            in_range &= path.range.contains(number)
                && (path.of_records || values.set_number(&path.path, number));
        }
        if in_range && let Ok(parts) = build::parts(&values) {
            return Ok(parts);
        }
        // The long way, for its message.
        let Analysis { model, motion, tail_s, .. } = self.analysis(numbers)?;
        Ok(Parts { model, motion, tail_s })
    }

    /// The analysis of a sample, read from the text as `slipstick run` reads it.
    ///
    /// # Errors
    /// [`InputError`] where the model objects to the numbers.
    pub fn analysis(&self, numbers: &[f64]) -> Result<Analysis, InputError> {
        let own = self.paths.iter().zip(self.overrides(numbers)?);
        let own = own.filter(|(path, _)| !path.of_records).map(|(_, set)| set);
        let all = self.set.iter().cloned().chain(own);
        let mut values = super::values(&self.name, &self.text, &all.collect::<Vec<_>>())?;
        // Before it is read as a model: keys along y are refused where nothing moves along y.
        values.in_plane = self.values.in_plane;
        build::analysis(values)
    }

    /// The numbers of a sample as `--set` takes them.
    ///
    /// # Errors
    /// None: the paths are known.
    pub fn overrides(&self, numbers: &[f64]) -> Result<Vec<Override>, InputError> {
        self.paths.iter().zip(numbers).map(|(path, number)| path.set(*number)).collect()
    }

    /// The number at a path that is not varied, as the model's text has it.
    #[must_use]
    pub fn number(&self, path: &str) -> Option<f64> {
        self.values.number(path)
    }

    /// The error for a value that only its user can judge, at that value.
    pub fn error_at(
        &self,
        path: &str,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> InputError {
        self.values.error(path, expected, found)
    }

    /// Whether the model has a value at a path, or a table.
    #[must_use]
    pub fn has(&self, path: &str) -> bool {
        self.values.has(path)
    }

    /// What the model has that demands are asked of.
    #[must_use]
    pub fn shape(&self) -> DemandShape {
        DemandShape {
            storeys: self.values.count("storey"),
            points: self.values.count("structure.point"),
            stop: self.has("slider.stop"),
            surfaces: if self.has("slider.triple") {
                3
            } else {
                self.values.count("slider.surface")
            },
            contents: self.values.count("contents"),
        }
    }

    /// What the model calls its block, its storeys and its points.
    #[must_use]
    pub fn names(&self) -> Names {
        build::names(&self.values)
    }

    /// The bounds of friction, where the model gives them.
    ///
    /// # Errors
    /// [`InputError`] for bounds that do not rise.
    pub fn friction_bounds(&self) -> Result<Option<FrictionBounds>, InputError> {
        build::friction_bounds(&self.values)
    }

    /// The text at a path.
    #[must_use]
    pub fn text(&self, path: &str) -> Option<&str> {
        self.values.text(path)
    }
}

impl Path {
    fn set(&self, number: f64) -> Result<Override, InputError> {
        if self.unit.is_empty() {
            // A ratio where a quantity could stand as well: as it is written.
            return Override::text_value(&self.path, &format!("{number:?}"));
        }
        Override::number(&self.path, number)
    }
}
