//! Varied paths and their values: numbers, or lists as people write them, `0.1..3 s:30`.

use super::{AssessmentError, ChoiceError, refuse};
use crate::error::InputError;
use crate::input::plan::{Distribution, Plan, Varied};
use crate::motion::intensity::Measure;

/// One varied path and the values that it takes.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The path.
    pub path: String,
    /// The SI unit; empty where it has none.
    pub unit: String,
    /// The values, in SI, in the order given.
    pub values: Vec<f64>,
}

/// Varied paths: every combination of their values, the last fastest.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Grid {
    axes: Vec<Axis>,
    varied: Vec<Varied>,
}

/// Values of one path at most; a grid is refused by its runs.
const MOST_VALUES: u64 = 1_000_000;

impl Grid {
    /// Reads pairs `(what errors call it, PATH=VALUES)`.
    ///
    /// Values are a list `1 m, 2 m` (or `1, 2 m`: the last unit is that of all) or a range
    /// `0.1..3 s:30` of so many values at equal distances, `:30 log` at equal ratios.
    ///
    /// # Errors
    /// [`AssessmentError::Choice`] which names what is wrong.
    pub fn parse(options: &[(&str, String)]) -> Result<Self, AssessmentError> {
        let mut text = String::from("model = \"model\"\n[vary]\n");
        for (option, given) in options {
            let Some((path, values)) = given.split_once('=') else {
                return Err(refuse(option, "PATH=VALUES", format!("{given:?}")));
            };
            text.push_str(&format!("{} = {}\n", quoted(path.trim()), table(option, values)?));
        }
        text.push_str("[sampling]\nmethod = \"grid\"\n");
        if options.is_empty() {
            return Ok(Self::default());
        }
        let plan = Plan::parse("options", &text).map_err(|error| of_plan(options, error))?;
        let axes = plan.vary.iter().map(axis).collect();
        Ok(Self { axes, varied: plan.vary })
    }

    /// The varied paths with their values.
    #[must_use]
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// The paths as a model takes them.
    #[must_use]
    pub fn varied(&self) -> &[Varied] {
        &self.varied
    }

    /// Gives an axis another name.
    pub(super) fn rename(&mut self, axis: usize, name: &str) {
        name.clone_into(&mut self.axes[axis].path);
    }

    /// Number of combinations.
    #[must_use]
    pub fn len(&self) -> usize {
        self.axes.iter().fold(1_usize, |n, axis| n.saturating_mul(axis.values.len()))
    }

    /// Never: without paths there is one combination.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        false
    }

    /// Indices of the values of a combination.
    #[must_use]
    pub fn indices(&self, number: usize) -> Vec<usize> {
        let mut rest = number;
        let mut indices: Vec<usize> = Vec::with_capacity(self.axes.len());
        for axis in self.axes.iter().rev() {
            indices.push(rest % axis.values.len());
            rest /= axis.values.len();
        }
        indices.reverse();
        indices
    }

    /// A combination in words, to stand after a name: `, slider.radius = 2 m`.
    #[must_use]
    pub fn label(&self, number: usize) -> String {
        let values = self.axes.iter().zip(self.values(number));
        let one = |(axis, value): (&Axis, f64)| {
            format!(", {} = {value} {}", axis.path, axis.unit).trim_end().to_owned()
        };
        values.map(one).collect()
    }

    /// The values of a combination, in SI.
    #[must_use]
    pub fn values(&self, number: usize) -> Vec<f64> {
        let indices = self.indices(number);
        self.axes.iter().zip(indices).map(|(axis, i)| axis.values[i]).collect()
    }
}

/// Levels of a measure as people write them, in SI; `what` is what errors call them.
///
/// # Errors
/// [`AssessmentError::Choice`] which names what is wrong.
pub fn levels(what: &str, text: &str, measure: &Measure) -> Result<Vec<f64>, AssessmentError> {
    let unscalable = || {
        let expected = "a measure that grows as the motion does, such as PGA or Sa(1.2 s)";
        refuse("measure", expected, measure.to_string())
    };
    if !measure.scales() {
        return Err(unscalable());
    }
    // A path of the model that takes what the measure takes.
    let like = match measure.unit() {
        "m/s2" => "motion.sine.amplitude",
        "m/s" => "initial.sliding_velocity",
        "m" => "block.width",
        _ => return Err(unscalable()),
    };
    let grid = Grid::parse(&[(what, format!("{like}={text}"))]).map_err(|error| match error {
        AssessmentError::Choice(error) => {
            AssessmentError::Choice(ChoiceError { what: what.to_owned(), ..error })
        }
        other => other,
    })?;
    let values = grid.axes()[0].values.clone();
    match values.iter().find(|value| !(**value > 0.0)) {
        Some(value) => Err(refuse(what, "levels > 0", value.to_string())),
        None => Ok(values),
    }
}

fn axis(varied: &Varied) -> Axis {
    let values = match &varied.distribution {
        Distribution::List(list) => (0..list.len()).map(|i| list.get(i)).collect(),
        // Nothing else is written by `table`.
        _ => Vec::new(),
    };
    Axis { path: varied.path.clone(), unit: varied.unit.to_owned(), values }
}

/// Values as a plan writes them.
fn table(option: &str, text: &str) -> Result<String, AssessmentError> {
    let expected = "a list \"1, 2 m\" or a range \"FROM..TO UNIT:COUNT\", perhaps with \" log\"";
    let wrong = || refuse(option, expected, format!("{:?}", text.trim()));
    let Some((from, rest)) = text.split_once("..") else {
        let items: Vec<&str> = text.split(',').map(str::trim).collect();
        if items.iter().any(|item| item.is_empty()) {
            return Err(wrong());
        }
        let unit = items.last().map_or("", |last| unit_of(last));
        let written: Vec<String> = items.iter().map(|item| value(item, unit)).collect();
        return Ok(format!("{{ values = [{}] }}", written.join(", ")));
    };
    let (to, count) = rest.split_once(':').ok_or_else(wrong)?;
    let (count, kind) = match count.trim().strip_suffix("log") {
        Some(count) => (count.trim(), "logspace"),
        None => (count.trim(), "linspace"),
    };
    let number = count.parse::<u64>().ok().filter(|n| (2..=MOST_VALUES).contains(n));
    let number = number.ok_or_else(|| {
        refuse(option, format!("a number of values from 2 to {MOST_VALUES}"), format!("{count:?}"))
    })?;
    let unit = unit_of(to.trim());
    let (from, to) = (value(from.trim(), unit), value(to.trim(), unit));
    Ok(format!("{{ {kind} = [{from}, {to}, {number}] }}"))
}

/// What follows the number in `3 s`.
fn unit_of(text: &str) -> &str {
    let end = text
        .char_indices()
        .find(|(i, c)| c.is_alphabetic() && !is_exponent(text, *i))
        .map_or(text.len(), |(i, _)| i);
    &text[end..]
}

/// Whether the letter at `i` is the e of `1e-3`.
fn is_exponent(text: &str, i: usize) -> bool {
    let after = text[i..].strip_prefix(['e', 'E']).unwrap_or("");
    let digits = after.strip_prefix(['+', '-']).unwrap_or(after);
    i > 0 && digits.starts_with(|c: char| c.is_ascii_digit())
}

/// A value as TOML: a bare number where there is no unit, else text.
fn value(text: &str, unit: &str) -> String {
    if unit.is_empty() && text.parse::<f64>().is_ok_and(f64::is_finite) {
        // `.5` and `5.` are numbers here and not in TOML.
        return format!("{:?}", text.parse::<f64>().unwrap_or(0.0));
    }
    let own = unit_of(text);
    if own.is_empty() && !unit.is_empty() {
        quoted(&format!("{text} {unit}"))
    } else {
        quoted(text)
    }
}

/// A text as a TOML string.
fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for character in text.chars() {
        match character {
            '"' | '\\' => out.extend(['\\', character]),
            c if c.is_control() => out.push_str(&format!("\\u{:04X}", c as u32)),
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

/// The error of a plan as that of the option it came from: options stand one a line from the third.
fn of_plan(options: &[(&str, String)], error: InputError) -> AssessmentError {
    let at = error.place.line.saturating_sub(3);
    let option = options.get(at).map_or("vary", |(option, _)| option);
    let path = error.path.strip_prefix("vary.").unwrap_or("");
    let what = if path.is_empty() { option.to_owned() } else { format!("{option} {path}") };
    AssessmentError::Choice(ChoiceError {
        what,
        expected: error.expected,
        found: error.found,
        nearest: error.nearest,
    })
}

impl Axis {
    /// Whether the values rise.
    #[must_use]
    pub fn rises(&self) -> bool {
        self.values.windows(2).all(|pair| pair[0] < pair[1])
    }

    /// Smallest and largest value.
    #[must_use]
    pub fn ends(&self) -> [f64; 2] {
        self.values
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], v| [l.min(*v), h.max(*v)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(options: &[&str]) -> Result<Grid, String> {
        let options: Vec<_> = options.iter().map(|o| ("vary", (*o).to_owned())).collect();
        Grid::parse(&options).map_err(|error| error.to_string())
    }

    #[test]
    fn lists_and_ranges() {
        let found = grid(&[
            "slider.kinetic_friction=0.02,.05",
            "slider.radius = 1..3m:5",
            "storey.1.period=100 ms, 0.2s",
            "slider.spring=1,2 kN/m",
        ])
        .unwrap();
        let values: Vec<_> = found.axes().iter().map(|axis| axis.values.clone()).collect();
        assert_eq!(values[0], [0.02, 0.05]);
        assert_eq!(values[1], [1.0, 1.5, 2.0, 2.5, 3.0]);
        assert_eq!(values[2], [0.1, 0.2]);
        assert_eq!(values[3], [1e3, 2e3]);
        assert_eq!(found.axes()[1].unit, "m");
        assert_eq!((found.len(), found.values(0)[3], found.values(1)[3]), (40, 1e3, 2e3));
        assert_eq!(found.values(39), [0.05, 3.0, 0.2, 2e3]);
        let ratios = grid(&["storey.1.period=0.1 s..10s:3 log"]).unwrap();
        let middle = ratios.axes()[0].values[1];
        assert!((middle - 1.0).abs() < 1e-14, "{middle}");
        assert_eq!(grid(&["slider.spring=1e3..2e3 N/m:2"]).unwrap().axes()[0].values, [1e3, 2e3]);
    }

    #[test]
    fn what_is_wrong_is_said_of_the_option() {
        for (option, expected) in [
            (
                "slider.radios=1 m",
                "vary slider.radios: expected a path of the model, found \"slider.radios\"; nearest \
                 is \"slider.radius\"",
            ),
            ("slider.radius", "vary: expected PATH=VALUES, found \"slider.radius\""),
            (
                "slider.radius=1..2 m",
                "vary: expected a list \"1, 2 m\" or a range \"FROM..TO UNIT:COUNT\", perhaps with \
                 \" log\", found \"1..2 m\"",
            ),
            (
                "slider.radius=1..2 m:1",
                "vary: expected a number of values from 2 to 1000000, found \"1\"",
            ),
        ] {
            assert_eq!(grid(&[option]).unwrap_err(), expected);
        }
        let error = grid(&["slider.radius=1,2"]).unwrap_err();
        assert!(error.starts_with("vary slider.radius") && error.contains("a length"), "{error}");
        let error = grid(&["slider.radius=1 s"]).unwrap_err();
        assert!(error.contains("found a time"), "{error}");
        assert!(grid(&["slider.radius=1 m\"]}, x={values=[\"1 m"]).is_err());
        let error = grid(&["slider.radius=1 m", "slider.radius=2 m"]).unwrap_err();
        assert!(error.contains("slider.radius"), "{error}");
    }
}
