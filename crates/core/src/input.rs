//! Model text to checked values.
//!
//! A model file is TOML; every dimensional value is a number with its unit. [`parse`] checks
//! everything and repairs nothing: an [`InputError`] names the file, line, column and key, what was
//! expected and what was found. [`json_schema`] and [`Override`] speak of the same keys by the same
//! paths, because all three read one description.

use crate::error::{ChoiceError, InputError, MotionError, Place};
use crate::hash::{SHORT, sha256_hex};
use crate::model::Model;
use crate::response::{DemandColumn, DemandOf, Method};

mod build;
mod edit;
mod frame;
mod json;
mod json_schema;
mod keys;
pub(crate) mod kind;
pub mod loaded;
mod mapping;
mod modal;
mod modes;
mod motion;
mod overrides;
mod paths;
pub mod plan;
mod plan_keys;
mod reader;
mod schema;
mod structure;
#[cfg(test)]
mod tests;
mod tree;
pub mod unfit;
mod variation;
mod write;

pub use build::Parts;
pub use edit::with_keys;
pub use json_schema::{json_schema, plan_json_schema};
pub use keys::MAX_STOREYS;
pub use mapping::{Channel, ColumnRef, MappedColumn, Mapping, Zero};
pub use modal::{
    EigenMatrices, ModalOptions, ModalPoint, ModalRow, ModalTable, OPENSEES_TITLE, Share,
    read_modes,
};
pub use motion::{MotionSource, PairOf, RecordAlongY, RecordSource, Scale, stem};
pub use overrides::{InputValue, Override, dimension_of, unit_of_bare};
pub use plan_keys::MAX_RUNS;
pub use variation::Variation;

/// The longest text that can be a model, in bytes: a storey takes a hundred.
pub const MAX_TEXT_BYTES: usize = 1 << 20;

/// All that a model file says.
#[derive(Clone, Debug, PartialEq)]
pub struct Analysis {
    /// The model's name, where it has one.
    pub name: Option<String>,
    /// What its parts are called.
    pub names: Names,
    /// The checked model.
    pub model: Model,
    /// Factors on both coefficients of friction for which it is run besides.
    pub friction_bounds: Option<FrictionBounds>,
    /// How the table moves; `None` where the file does not say.
    pub motion: Option<MotionSource>,
    /// How the response is computed.
    pub method: Method,
    /// Free vibration after the motion ends, in s.
    pub tail_s: f64,
    values: reader::Values,
}

/// Names of the parts of a model, where they have one.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Names {
    /// Of the block, such as `Base mat`.
    pub block: Option<String>,
    /// Of the storeys from the block up, such as `Roof`.
    pub storeys: Vec<Option<String>>,
    /// Of the points of a structure by its modes.
    pub points: Vec<String>,
}

impl Names {
    /// What the block is called; `Block` without a name.
    #[must_use]
    pub fn block(&self) -> &str {
        self.block.as_deref().unwrap_or("Block")
    }

    /// What a storey (from 1) is called; `Storey 2` without a name.
    #[must_use]
    pub fn storey(&self, storey: usize) -> String {
        let name = self.storeys.get(storey.wrapping_sub(1)).and_then(Option::as_ref);
        name.cloned().unwrap_or_else(|| format!("Storey {storey}"))
    }
}

impl Names {
    /// What a point (from 1) is called: the storey, or the point of a structure by its modes.
    #[must_use]
    pub fn point(&self, point: usize) -> String {
        self.points.get(point.wrapping_sub(1)).cloned().unwrap_or_else(|| self.storey(point))
    }

    /// A demand in words, with the name of what it is of: `Roof peak acceleration`.
    #[must_use]
    pub fn title(&self, column: &DemandColumn) -> String {
        let title = column.title();
        match (column.demand.of, title.strip_prefix("Block")) {
            (DemandOf::Storey | DemandOf::Point, _) => {
                format!("{} {}", self.point(column.part), column.demand.words)
            }
            (_, Some(rest)) => format!("{}{rest}", self.block()),
            _ => title,
        }
    }
}

/// Factors on both coefficients of friction, `0 ≤ lower ≤ upper`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrictionBounds {
    /// Factor of the lower bound.
    pub lower: f64,
    /// Factor of the upper bound.
    pub upper: f64,
}

impl FrictionBounds {
    /// Lower, nominal and upper friction.
    #[must_use]
    pub fn all(&self) -> [Bound; 3] {
        let bound = |name, friction_factor| Bound { name, friction_factor };
        [bound("lower", self.lower), Bound::NOMINAL, bound("upper", self.upper)]
    }

    /// The bounds of a model to run: those of a name, all of them without one; none for a model that
    /// gives no bounds and is run as it stands.
    ///
    /// # Errors
    /// [`ChoiceError`] for a bound of a model that gives none.
    pub fn chosen(given: Option<Self>, name: Option<&str>) -> Result<Vec<Bound>, ChoiceError> {
        match (given, name) {
            (Some(given), name) => {
                let all = given.all().into_iter();
                Ok(all.filter(|bound| name.is_none_or(|name| name == bound.name)).collect())
            }
            (None, None | Some("nominal")) => Ok(Vec::new()),
            (None, Some(name)) => Err(ChoiceError {
                what: "bounds".to_owned(),
                expected: "slider.bounds in the model".to_owned(),
                found: format!("{name:?}"),
                nearest: None,
            }),
        }
    }
}

/// A bound of friction: its name, lower, nominal or upper, and the factor on both coefficients.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bound {
    /// Its name.
    pub name: &'static str,
    /// The factor.
    pub friction_factor: f64,
}

impl Bound {
    /// The friction of the model as it stands.
    pub const NOMINAL: Self = Self { name: "nominal", friction_factor: 1.0 };

    /// The model with this friction.
    #[must_use]
    pub fn of(&self, model: &Model) -> Model {
        model.with_friction_times(self.friction_factor).unwrap_or_else(|_| model.clone())
    }
}

/// A value in use, as it was written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Input<'a> {
    /// The key's path, storeys counted from 1.
    pub path: &'a str,
    /// The text of the value, with its unit.
    pub text: &'a str,
    /// Its number, in SI where it has a unit; `None` for text.
    pub value: Option<f64>,
    /// The SI unit of `value` (Hz for frequencies); empty where it has none.
    pub unit: &'static str,
}

/// Reads a model file's text, with keys set from outside the file, in their order.
///
/// `source_name` is what errors call the text. A byte order mark and CRLF are read.
///
/// # Errors
/// [`InputError`] for the first fault found.
///
/// # Examples
/// ```
/// use slipstick::input::{Override, parse};
///
/// let text = "[block]\nmass = \"325 kg\"\n[slider]\nstatic_friction = 0.02\nkinetic_friction = 0.012\n";
/// let set = [Override::parse("slider.spring=143 kN/m")?];
/// let analysis = parse("mock-up.toml", text, &set)?;
/// assert_eq!(analysis.model.slider_stiffness_n_per_m(), 143e3);
///
/// let error = parse("mock-up.toml", &text.replace("kg", "mm"), &[]).unwrap_err();
/// assert_eq!(
///     error.to_string(),
///     "mock-up.toml:2:8: block.mass: expected a mass, such as \"325 kg\", found a length, \"325 mm\""
/// );
/// # Ok::<(), slipstick::error::InputError>(())
/// ```
pub fn parse(
    source_name: &str,
    text: &str,
    overrides: &[Override],
) -> Result<Analysis, InputError> {
    build::analysis(values(source_name, text, overrides)?)
}

/// The values of a model's text.
fn values(
    source_name: &str,
    text: &str,
    overrides: &[Override],
) -> Result<reader::Values, InputError> {
    let mut sources = tree::Sources::default();
    let file = sources.add(source_name, text);
    if text.len() > MAX_TEXT_BYTES {
        let start = tree::SourceSpan { source: file, span: 0..0 };
        let expected = format!("a model of at most {MAX_TEXT_BYTES} bytes");
        return Err(sources.error(&start, "", expected, text.len().to_string()));
    }
    let mut root = tree::parse_document(&sources, file)?;
    for set in overrides {
        set.apply(&mut sources, &mut root)?;
    }
    reader::Values::read(sources, &root, &keys::MODEL)
}

/// A model from the values of its keys, without a text: paths are keys joined by dots, storeys counted
/// from 1 and given in their order.
///
/// # Errors
/// [`InputError`] for the first fault found, as [`parse`]; it names the key, not a place.
///
/// # Examples
/// ```
/// use slipstick::input::{InputValue::{Number, Text}, from_values};
///
/// let analysis = from_values(&[
///     ("block.mass", Number(325.0)),
///     ("slider.static_friction", Number(0.02)),
///     ("slider.kinetic_friction", Number(0.012)),
///     ("slider.radius", Text("2.2 m")),
///     ("storey.1.mass", Text("45 kg")),
///     ("storey.1.period", Number(0.6)),
///     ("storey.1.damping_ratio", Number(0.01)),
/// ])?;
/// assert_eq!((analysis.model.block().mass_kg, analysis.model.storeys()), (325.0, 1));
///
/// let error = from_values(&[("block.mass", Number(-1.0))]).unwrap_err();
/// assert_eq!(
///     error.to_string(),
///     "block.mass: expected a finite mass > 0, found \"-1.0 kg\""
/// );
/// # Ok::<(), slipstick::error::InputError>(())
/// ```
pub fn from_values(values: &[(&str, InputValue<'_>)]) -> Result<Analysis, InputError> {
    let mut sources = tree::Sources::default();
    // Where something is missing there is no place.
    sources.add("", "");
    let mut root = tree::TomlTable(Vec::new());
    for &(path, value) in values {
        let set = match value {
            InputValue::Number(number) => Override::number(path, number)?,
            InputValue::Text(text) => Override::text_value(path, text)?,
        };
        set.add(&mut sources, &mut root)?;
    }
    build::analysis(reader::Values::read(sources, &root, &keys::MODEL)?)
}

/// The table of modes that a model file names, as what [`parse`] puts in its place: `read` gives the text of a
/// file by its path, which is relative to the model file, with what errors call it.
///
/// # Errors
/// [`InputError`] at the path, for what `read` says of a file that it cannot read. What is wrong with the model
/// itself [`parse`] tells.
pub fn modes_beside<E: core::fmt::Display>(
    source_name: &str,
    text: &str,
    read: impl FnOnce(&str) -> Result<(String, String), E>,
) -> Result<Option<Override>, InputError> {
    let mut sources = tree::Sources::default();
    let file = sources.add(source_name, text);
    let Ok(root) = tree::parse_document(&sources, file) else { return Ok(None) };
    let structure = root.get("structure").map(|entry| &entry.node.value);
    let Some(tree::Value::Table(structure)) = structure else { return Ok(None) };
    let Some(node) = structure.get("modes").map(|entry| &entry.node) else { return Ok(None) };
    let tree::Value::Text(path) = &node.value else { return Ok(None) };
    match read(path) {
        Ok((name, table)) => Ok(Some(Override::modes(&name, &table))),
        Err(error) => {
            let expected = "a table of modes that can be read";
            Err(sources.error(&node.spot, "structure.modes", expected, error.to_string()))
        }
    }
}

/// As [`parse`], for the bytes of a file.
///
/// # Errors
/// As [`parse`], and for bytes that are not UTF-8.
pub fn from_bytes(
    source_name: &str,
    bytes: &[u8],
    overrides: &[Override],
) -> Result<Analysis, InputError> {
    parse(source_name, utf8(source_name, bytes)?, overrides)
}

/// Refuses values that speak of two horizontal directions under a motion in one.
fn along_x_alone(values: &reader::Values) -> Result<(), InputError> {
    match build::key_of_y(values, values.count("storey")) {
        Some(path) if !motion::in_plane(values) => Err(motion::only_in_plane(values, &path)),
        _ => Ok(()),
    }
}

/// The bytes of a file as text.
fn utf8<'a>(source_name: &str, bytes: &'a [u8]) -> Result<&'a str, InputError> {
    let error = match std::str::from_utf8(bytes) {
        Ok(text) => return Ok(text),
        Err(error) => error,
    };
    let at = error.valid_up_to();
    let before = bytes.get(..at).and_then(|valid| std::str::from_utf8(valid).ok()).unwrap_or("");
    let (line, column) = tree::line_and_column(before, at);
    let found = bytes.get(at).map_or("nothing".to_owned(), |byte| format!("the byte 0x{byte:02x}"));
    let span = at..(at + 1).min(bytes.len());
    Err(InputError {
        place: Box::new(Place { source_name: source_name.to_owned(), line, column, span }),
        path: String::new(),
        expected: "text in UTF-8".to_owned(),
        found,
        nearest: None,
    })
}

impl Analysis {
    /// Every value in use as it was written, in the order of the manual; defaults are not among them.
    pub fn inputs(&self) -> impl Iterator<Item = Input<'_>> {
        self.values.leaves.iter().map(|leaf| Input {
            path: &leaf.path,
            text: &leaf.written,
            value: self.values.number(&leaf.path),
            unit: leaf.unit,
        })
    }

    /// Paths of the numbers that say how the thing is built that moves, each by itself, but for those that are 0.
    #[must_use]
    pub fn built(&self) -> Vec<&str> {
        // The ratios of many storeys are one value.
        let shared = |path: &str| self.model.storeys() > 1 && path.contains(".damping_ratio");
        let of = |input: &Input<'_>| {
            input.value.is_some_and(|value| value != 0.0)
                && keys::MODEL.along(input.path).all(|key| key.built)
                && !(input.path.starts_with("storey.") && shared(input.path))
        };
        self.inputs().filter(of).map(|input| input.path).collect()
    }

    /// The model file's text anew, without comments, in the order of the manual. The motion is that
    /// of a record in a file beside it where `record` names one; else a made motion stays and a
    /// record, whose path is relative to the original file, is left out.
    ///
    /// Reads back as an equal analysis (but for the motion).
    #[must_use]
    pub fn to_toml(&self, record: Option<&str>) -> String {
        write::toml(&self.values, record.map_or(write::Motion::Made, write::Motion::Record))
    }

    /// The same with the motion as it was written, the path of a record included. Reads back as an equal
    /// analysis.
    #[must_use]
    pub fn to_toml_with_motion(&self) -> String {
        write::toml(&self.values, write::Motion::AsWritten)
    }

    /// A short hash of the model in use, keys set from outside the file in it, comments, layout and the record
    /// not: the first 12 hexadecimal digits of the SHA-256 of [`Analysis::to_toml`].
    #[must_use]
    pub fn hash(&self) -> String {
        let mut hash = sha256_hex(self.to_toml(None).as_bytes());
        hash.truncate(SHORT);
        hash
    }

    /// The number written at a path, in SI where it has a unit; `None` where none is written.
    #[must_use]
    pub fn value(&self, path: &str) -> Option<f64> {
        self.values.number(path)
    }

    /// What the values in use are, however they were written: two analyses with the same say the same.
    /// Paths of records stand as written.
    #[must_use]
    pub fn canonical(&self) -> String {
        // Fifteen digits: 0.3 m is 300 mm.
        let said = |input: Input<'_>| match input.value {
            Some(value) => format!("{} = {:.14e}\n", input.path, value + 0.0),
            None => format!("{} = {}\n", input.path, input.text),
        };
        self.inputs().map(said).collect()
    }

    /// The error for a value that only its user can judge (a file that is not there, a ramp longer
    /// than the motion), at that value; where it is not written, at the table that lacks it.
    pub fn error_at(
        &self,
        path: &str,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> InputError {
        self.values.error(path, expected, found)
    }

    /// The error for a motion that cannot be made or scaled, at the key that caused it.
    pub fn motion_error(&self, error: &MotionError) -> InputError {
        motion::error(&self.values, self.motion.as_ref(), error)
    }

    /// Refuses a motion in two horizontal directions where one is asked for.
    ///
    /// # Errors
    /// [`InputError`] at the key that gives the motion along y.
    pub fn in_one_direction(&self, what: &str) -> Result<(), InputError> {
        match self.motion.as_ref().and_then(MotionSource::key_of_y) {
            Some(key) => {
                let expected = format!("a motion in one direction, which {what}");
                Err(self.error_at(key, expected, "one in two"))
            }
            None => Ok(()),
        }
    }

    /// The same model for motions from outside its text that move the table in two horizontal directions.
    ///
    /// # Errors
    /// [`InputError`] at a key of what is not solved in two directions.
    pub fn in_plane(&self) -> Result<Self, InputError> {
        let mut values = self.values.clone();
        values.in_plane = true;
        build::analysis(values)
    }

    /// Refuses a model that speaks of two horizontal directions under a motion in one.
    ///
    /// # Errors
    /// [`InputError`] at the key that speaks of the second.
    pub fn along_x_alone(&self) -> Result<(), InputError> {
        along_x_alone(&self.values)
    }

    /// How the table moves.
    ///
    /// # Errors
    /// [`InputError`] where neither the file nor the caller says it.
    pub fn required_motion(&self) -> Result<&MotionSource, InputError> {
        self.motion.as_ref().ok_or_else(|| {
            let expected = "a table [motion] with one of the keys record, sine, sweep, pulse (or a \
                            record beside the model: --motion FILE, --records PATTERN)";
            self.error_at("motion", expected, "nothing")
        })
    }
}
