//! What the columns of a measured file are: a small text of quantities and columns.
//!
//! ```text
//! time                 = "t [ms]"                # or a time step, "0.005 s"
//! table_acceleration   = "A0 [g]"
//! block_acceleration   = "A1 [g] * -1"           # the sensor points the other way
//! sliding_displacement = "X1 - U [mm]"           # difference of two columns
//! storey1_acceleration = "'roof acc' [g] @ 12 ms"  # its clock is 12 ms slow
//! displacement         = "LVDT [mm] - 12.3 mm"   # the sensor shows 12.3 mm at rest
//! zero                 = "first 2 s"             # all sensors are at rest there; or "as measured"
//! ```

use super::tree::{self, SourceSpan, Sources, Value};
use crate::error::{InputError, cut, similar};
use crate::units::{self, Dimension, Unit};

/// A measured quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// Time.
    Time,
    /// Acceleration of the table, `Ü`.
    TableAcceleration,
    /// Total acceleration of the block.
    BlockAcceleration,
    /// Block minus table, `s`.
    SlidingDisplacement,
    /// Rate of the sliding displacement, `ṡ`.
    SlidingVelocity,
    /// Force of the table on the block by friction, `T`.
    FrictionForce,
    /// Displacement imposed in a cyclic test, or any displacement in free vibration.
    Displacement,
    /// Force that a cyclic test needs, positive along the displacement.
    Force,
    /// Any acceleration in free vibration.
    Acceleration,
    /// Displacement of a storey (from 1) relative to the block.
    StoreyDisplacement(usize),
    /// Velocity of a storey (from 1) relative to the block.
    StoreyVelocity(usize),
    /// Total acceleration of a storey (from 1).
    StoreyAcceleration(usize),
}

const PLAIN: [Channel; 9] = [
    Channel::Time,
    Channel::TableAcceleration,
    Channel::BlockAcceleration,
    Channel::SlidingDisplacement,
    Channel::SlidingVelocity,
    Channel::FrictionForce,
    Channel::Displacement,
    Channel::Force,
    Channel::Acceleration,
];

impl Channel {
    /// The channel of a name such as `block_acceleration` or `storey2_displacement`.
    #[must_use]
    pub fn parse(name: &str) -> Option<Self> {
        if let Some(channel) = PLAIN.into_iter().find(|channel| channel.name() == name) {
            return Some(channel);
        }
        let (number, what) = name.strip_prefix("storey")?.split_once('_')?;
        let storey: usize = number.parse().ok()?;
        if !(1..=super::MAX_STOREYS).contains(&storey) || number.starts_with('0') {
            return None;
        }
        match what {
            "displacement" => Some(Self::StoreyDisplacement(storey)),
            "velocity" => Some(Self::StoreyVelocity(storey)),
            "acceleration" => Some(Self::StoreyAcceleration(storey)),
            _ => None,
        }
    }

    /// Its name, which is that of the column of `history.csv` without the unit.
    #[must_use]
    pub fn name(self) -> String {
        match self {
            Self::Time => "time".to_owned(),
            Self::TableAcceleration => "table_acceleration".to_owned(),
            Self::BlockAcceleration => "block_acceleration".to_owned(),
            Self::SlidingDisplacement => "sliding_displacement".to_owned(),
            Self::SlidingVelocity => "sliding_velocity".to_owned(),
            Self::FrictionForce => "friction_force".to_owned(),
            Self::Displacement => "displacement".to_owned(),
            Self::Force => "force".to_owned(),
            Self::Acceleration => "acceleration".to_owned(),
            Self::StoreyDisplacement(storey) => format!("storey{storey}_displacement"),
            Self::StoreyVelocity(storey) => format!("storey{storey}_velocity"),
            Self::StoreyAcceleration(storey) => format!("storey{storey}_acceleration"),
        }
    }

    /// What it measures.
    #[must_use]
    pub fn dimension(self) -> Dimension {
        match self {
            Self::Time => Dimension::Time,
            Self::TableAcceleration
            | Self::BlockAcceleration
            | Self::Acceleration
            | Self::StoreyAcceleration(_) => Dimension::Acceleration,
            Self::SlidingDisplacement | Self::Displacement | Self::StoreyDisplacement(_) => {
                Dimension::Length
            }
            Self::SlidingVelocity | Self::StoreyVelocity(_) => Dimension::Velocity,
            Self::FrictionForce | Self::Force => Dimension::Force,
        }
    }

    /// The storey, from 1, of a quantity of a storey.
    #[must_use]
    pub fn storey(self) -> Option<usize> {
        match self {
            Self::StoreyDisplacement(i) | Self::StoreyVelocity(i) | Self::StoreyAcceleration(i) => {
                Some(i)
            }
            _ => None,
        }
    }
}

/// A column as a mapping names it.
#[derive(Clone, Debug, PartialEq)]
pub struct ColumnRef {
    /// Its name, or its number from 1 after a `#`.
    pub name: String,
    spot: SourceSpan,
}

/// Where a quantity comes from: `A [− B]` in a unit, times a factor, its clock shifted.
#[derive(Clone, Debug, PartialEq)]
pub struct MappedColumn {
    /// The quantity.
    pub channel: Channel,
    /// The column.
    pub column: ColumnRef,
    /// The column to be subtracted.
    pub minus: Option<ColumnRef>,
    /// What the sensor shows at zero, in SI: subtracted before the factor. `None`: not known.
    pub zero: Option<f64>,
    /// The unit of both; `None`: as the header says.
    pub unit: Option<&'static Unit>,
    /// Factor, −1 for a sensor that points the other way.
    pub factor: f64,
    /// What is added to the times of this quantity, in s.
    pub offset_s: f64,
    spot: SourceSpan,
}

/// What is known of the zero of sensors that no entry states.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Zero {
    /// Nothing: a sensor may be off by any constant.
    #[default]
    Unknown,
    /// They are right as measured.
    AsMeasured,
    /// All is at rest in the first so many seconds, whose mean is the zero.
    First(f64),
}

/// What the columns of a measured file are, where their names do not say it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mapping {
    /// One entry a quantity.
    pub columns: Vec<MappedColumn>,
    /// The time step in s, of a file without a column of times.
    pub dt_s: Option<f64>,
    /// The zero of the sensors.
    pub zero: Zero,
    zero_spot: Option<SourceSpan>,
    sources: Sources,
}

impl Mapping {
    /// The same with the entries alone that are wanted.
    #[must_use]
    pub fn of_columns(&self, is_wanted: impl Fn(&MappedColumn) -> bool) -> Self {
        let mut chosen = self.clone();
        chosen.columns.retain(is_wanted);
        chosen
    }

    /// Reads a mapping file (`None` for none) and options of the form `QUANTITY=COLUMN…`, which
    /// replace what the file says of the same quantity.
    ///
    /// # Errors
    /// [`InputError`] at the fault: no TOML, an unknown quantity, no column, a wrong unit, a factor
    /// that is no finite number other than 0.
    pub fn parse(file: Option<(&str, &str)>, options: &[String]) -> Result<Self, InputError> {
        let mut mapping = Self::default();
        if let Some((name, text)) = file {
            let source = mapping.sources.add(name, text);
            for entry in tree::parse_document(&mapping.sources, source)?.0 {
                let Value::Text(value) = &entry.node.value else {
                    let expected = "text in quotes, such as \"A1 [g] * -1\"";
                    let found = entry.node.found();
                    return Err(mapping.sources.error(
                        &entry.node.spot,
                        &entry.name,
                        expected,
                        found,
                    ));
                };
                // The text starts after its quotation mark.
                let mut at = entry.node.spot.clone();
                at.span.start += 1;
                mapping.add(&entry.name, &entry.key, value, &at)?;
            }
        }
        for option in options {
            let source = mapping.sources.add(&format!("mapping {}", cut(option)), option);
            let Some((name, value)) = option.split_once('=') else {
                let spot = SourceSpan { source, span: option.len()..option.len() };
                return Err(mapping.sources.error(&spot, "", "QUANTITY=COLUMN", "no \"=\""));
            };
            let key = SourceSpan { source, span: 0..name.len() };
            let blanks = value.len() - value.trim_start().len();
            let at = SourceSpan { source, span: name.len() + 1 + blanks..option.len() };
            mapping.add(name.trim(), &key, value.trim(), &at)?;
        }
        Ok(mapping)
    }

    fn add(
        &mut self,
        name: &str,
        key: &SourceSpan,
        value: &str,
        at: &SourceSpan,
    ) -> Result<(), InputError> {
        if name == "zero" {
            self.zero = parse_zero(value).ok_or_else(|| {
                let expected = "\"first 2 s\", in which all is at rest, or \"as measured\"";
                self.sources.error(at, name, expected, format!("\"{}\"", cut(value)))
            })?;
            self.zero_spot = Some(at.clone());
            return Ok(());
        }
        let Some(channel) = Channel::parse(name) else {
            let storeys = [
                Channel::StoreyDisplacement(1),
                Channel::StoreyVelocity(1),
                Channel::StoreyAcceleration(1),
            ];
            let names: Vec<_> = PLAIN.into_iter().chain(storeys).map(Channel::name).collect();
            let expected = format!("one of the quantities {}, …", names.join(", "));
            let found = format!("\"{}\"", cut(name));
            let nearest = similar(name, names.iter().map(String::as_str));
            return Err(InputError {
                nearest,
                ..self.sources.error(key, &cut(name), expected, found)
            });
        };
        if channel == Channel::Time
            && let Ok(dt_s) = units::parse_quantity(value, Dimension::Time)
        {
            if !(dt_s > 0.0) {
                let found = format!("\"{}\"", cut(value));
                return Err(self.sources.error(at, name, "a time step > 0 s", found));
            }
            self.columns.retain(|entry| entry.channel != channel);
            self.dt_s = Some(dt_s);
            return Ok(());
        }
        let entry = self.entry(channel, value, at)?;
        if channel == Channel::Time {
            self.dt_s = None;
        }
        self.columns.retain(|entry| entry.channel != channel);
        self.columns.push(entry);
        Ok(())
    }

    /// Reads `COLUMN [- COLUMN] [[UNIT]] [- ZERO] [* FACTOR] [@ SHIFT]`; the zero may also stand before
    /// the unit.
    fn entry(
        &self,
        channel: Channel,
        text: &str,
        at: &SourceSpan,
    ) -> Result<MappedColumn, InputError> {
        let path = channel.name();
        let spot = |from: usize, to: usize| SourceSpan {
            source: at.source,
            span: at.span.start + from..at.span.start + to,
        };
        let fault = |from: usize, to: usize, expected: &str| {
            let word = text.get(from..to).unwrap_or("").trim();
            let found =
                if word.is_empty() { "nothing".to_owned() } else { format!("\"{}\"", cut(word)) };
            self.sources.error(&spot(from, to), &path, expected, found)
        };
        let mut rest = Rest { text, at: 0 };
        let column = |rest: &mut Rest| -> Result<ColumnRef, InputError> {
            let (name, from, to) = rest.column();
            if name.is_empty() {
                return Err(fault(from, to, "the name of a column, or # and its number"));
            }
            Ok(ColumnRef { name, spot: spot(from, to) })
        };
        let first = column(&mut rest)?;
        let (mut minus, mut zero) = (None, None);
        // What follows a minus is a quantity where it reads as one, else a column.
        let subtracted = |rest: &mut Rest, zero: &mut Option<f64>| -> Result<_, InputError> {
            let next = column(rest)?;
            match units::parse_quantity(&next.name.replace('−', "-"), channel.dimension()) {
                Ok(value) if zero.is_none() => {
                    *zero = Some(value);
                    Ok(None)
                }
                _ => Ok(Some(next)),
            }
        };
        if rest.take('-') {
            minus = subtracted(&mut rest, &mut zero)?;
            if minus.is_some() && rest.take('-') {
                let (from, to) = (rest.at, text.len());
                if subtracted(&mut rest, &mut zero)?.is_some() {
                    return Err(fault(from, to, "a zero such as 12.3 mm after the second column"));
                }
            }
        }
        let mut unit = None;
        if rest.take('[') {
            let (from, to) = rest.until(&[']']);
            let name = text.get(from..to).unwrap_or("");
            if !rest.take(']') {
                return Err(fault(from, to, "a unit and a closing bracket"));
            }
            unit = Some(units::parse_unit(name, channel.dimension()).map_err(|error| {
                let place = self.sources.error(&spot(from, to), &path, error.expected, error.found);
                InputError { nearest: error.nearest, ..place }
            })?);
        }
        if unit.is_some() && zero.is_none() && rest.take('-') {
            let (from, to) = (rest.at, text.len());
            if subtracted(&mut rest, &mut zero)?.is_some() {
                let expected = format!("a zero such as {}", channel.dimension().example());
                return Err(fault(from, to, &expected));
            }
        }
        let mut factor = 1.0;
        if rest.take('*') {
            let (from, to) = rest.until(&['@', '[']);
            let number = text.get(from..to).unwrap_or("").trim().replace('−', "-").parse::<f64>();
            factor = number
                .ok()
                .filter(|factor| factor.is_finite() && *factor != 0.0)
                .ok_or_else(|| fault(from, to, "a factor that is not 0, such as -1"))?;
        }
        let mut offset_s = 0.0;
        if rest.take('@') {
            let (from, to) = (rest.at, text.len());
            rest.at = to;
            let written = text.get(from..to).unwrap_or("").trim();
            offset_s = units::parse_quantity(written, Dimension::Time).map_err(|error| {
                let place = self.sources.error(&spot(from, to), &path, error.expected, error.found);
                InputError { nearest: error.nearest, ..place }
            })?;
        }
        rest.blanks();
        if rest.at < text.len() {
            let expected = "COLUMN [- COLUMN] [UNIT] - ZERO * FACTOR @ SHIFT, each part after the first \
                            optional; names with blanks, dashes or brackets in single quotes";
            return Err(fault(rest.at, text.len(), expected));
        }
        Ok(MappedColumn {
            channel,
            column: first,
            minus,
            zero,
            unit,
            factor,
            offset_s,
            spot: spot(0, text.len()),
        })
    }

    /// The entry of a quantity.
    #[must_use]
    pub fn get(&self, channel: Channel) -> Option<&MappedColumn> {
        self.columns.iter().find(|entry| entry.channel == channel)
    }

    /// The error at a column's name.
    #[must_use]
    pub fn error_at_column(
        &self,
        entry: &MappedColumn,
        column: &ColumnRef,
        expected: String,
        nearest: Option<String>,
    ) -> InputError {
        let found = format!("\"{}\"", cut(&column.name));
        let error = self.sources.error(&column.spot, &entry.channel.name(), expected, found);
        InputError { nearest, ..error }
    }

    /// The error at the zero of all sensors.
    #[must_use]
    pub fn error_at_zero(&self, expected: &str, found: String) -> InputError {
        let spot = self.zero_spot.clone().unwrap_or(SourceSpan { source: 0, span: 0..0 });
        self.sources.error(&spot, "zero", expected, found)
    }

    /// The error at an entry as a whole.
    #[must_use]
    pub fn error_at(&self, entry: &MappedColumn, expected: String, found: String) -> InputError {
        self.sources.error(&entry.spot, &entry.channel.name(), expected, found)
    }
}

/// Reads `first 2 s` or `as measured`.
fn parse_zero(text: &str) -> Option<Zero> {
    if text.trim() == "as measured" {
        return Some(Zero::AsMeasured);
    }
    let span = text.trim().strip_prefix("first ")?;
    let span_s = units::parse_quantity(span, Dimension::Time).ok()?;
    (span_s > 0.0).then_some(Zero::First(span_s))
}

/// What is left of a text.
struct Rest<'a> {
    text: &'a str,
    at: usize,
}

impl Rest<'_> {
    fn left(&self) -> &str {
        self.text.get(self.at..).unwrap_or("")
    }

    fn blanks(&mut self) {
        self.at += self.left().len() - self.left().trim_start().len();
    }

    /// Takes a mark, after blanks.
    fn take(&mut self, mark: char) -> bool {
        self.blanks();
        let found = self.left().starts_with(mark);
        if found {
            self.at += mark.len_utf8();
        }
        found
    }

    /// Bytes up to one of some marks.
    fn until(&mut self, marks: &[char]) -> (usize, usize) {
        let from = self.at;
        self.at += self.left().find(marks).unwrap_or(self.left().len());
        (from, self.at)
    }

    /// A column's name, in single quotes or up to ` - `, `[`, `*` or `@`, and where it stands.
    fn column(&mut self) -> (String, usize, usize) {
        self.blanks();
        let from = self.at;
        if let Some(quoted) = self.left().strip_prefix('\'') {
            let length = quoted.find('\'').unwrap_or(quoted.len());
            let name = quoted.get(..length).unwrap_or("").to_owned();
            self.at = (from + length + 2).min(self.text.len());
            return (name, from, self.at);
        }
        let left = self.left();
        let marks = [left.find('['), left.find('*'), left.find('@'), left.find(" - ")];
        let length = marks.into_iter().flatten().min().unwrap_or(left.len());
        let name = left.get(..length).unwrap_or("").trim().to_owned();
        self.at += length;
        let to = from + name.len();
        (name, from, to)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn option(text: &str) -> Result<Mapping, String> {
        Mapping::parse(None, &[text.to_owned()]).map_err(|error| error.to_string())
    }

    #[test]
    fn every_part_is_read() {
        let mapping =
            option("sliding_displacement = X1 - 'table disp' [mm] * -1 @ -12 ms").unwrap();
        let entry = &mapping.columns[0];
        assert_eq!(entry.channel, Channel::SlidingDisplacement);
        assert_eq!(entry.column.name, "X1");
        assert_eq!(entry.minus.as_ref().unwrap().name, "table disp");
        assert_eq!(entry.unit.unwrap().name(), "mm");
        assert_eq!((entry.factor, entry.offset_s), (-1.0, -0.012));
        let plain = option("block_acceleration=acc block").unwrap();
        assert_eq!(plain.columns[0].column.name, "acc block");
        assert_eq!((plain.columns[0].unit, plain.columns[0].factor), (None, 1.0));
        assert_eq!(option("time=0.005 s").unwrap().dt_s, Some(0.005));
        for text in ["LVDT - 12.3 mm [mm]", "LVDT [mm] - 12.3 mm", "LVDT - U - 12.3 mm [mm] * -1"] {
            let entry = option(&format!("sliding_displacement={text}")).unwrap().columns.remove(0);
            assert_eq!((entry.column.name.as_str(), entry.zero), ("LVDT", Some(0.0123)), "{text}");
            assert_eq!(entry.minus.is_some(), text.contains('U'), "{text}");
        }
        assert_eq!(option("force=F [N] - -3 N").unwrap().columns[0].zero, Some(-3.0));
        assert_eq!(option("zero=first 2 s").unwrap().zero, Zero::First(2.0));
        assert_eq!(option("zero=as measured").unwrap().zero, Zero::AsMeasured);
        assert!(option("zero=first 2").unwrap_err().contains("zero: expected \"first 2 s\""));
        assert!(option("force=F [N] - 3 mm").unwrap_err().contains("expected a zero such as"));
        assert_eq!(option("storey12_acceleration=#4 [g]").unwrap().columns[0].column.name, "#4");
    }

    #[test]
    fn options_replace_the_file() {
        let file = "time = \"t [ms]\"\nforce = \"F [kN]\"\n";
        let mapping =
            Mapping::parse(Some(("m.toml", file)), &["force=G [N]".into(), "time=2 ms".into()])
                .unwrap();
        assert_eq!(mapping.get(Channel::Force).unwrap().column.name, "G");
        assert_eq!((mapping.dt_s, mapping.columns.len()), (Some(0.002), 1));
    }

    #[test]
    fn faults_say_where_and_what_is_near() {
        let file =
            |text: &str| Mapping::parse(Some(("m.toml", text)), &[]).unwrap_err().to_string();
        let message = file("block_acceleraton = \"A\"\n");
        assert!(message.starts_with("m.toml:1:1: block_acceleraton: expected one of the"));
        assert!(message.ends_with("nearest is \"block_acceleration\""), "{message}");
        assert_eq!(
            file("\nforce = \"F [mm]\"\n"),
            "m.toml:2:13: force: expected a force, such as \"12 kN\", found a length, \"mm\""
        );
        assert_eq!(
            file("force = 3\n"),
            "m.toml:1:9: force: expected text in quotes, such as \"A1 [g] * -1\", found 3"
        );
        assert_eq!(
            option("force=F * x").unwrap_err(),
            "mapping force=F * x:1:10: force: expected a factor that is not 0, such as -1, found \
             \"x\""
        );
        assert!(option("force=").unwrap_err().contains("expected the name of a column"));
        assert!(option("force").unwrap_err().contains("expected QUANTITY=COLUMN, found no \"=\""));
        assert!(option("force=F [N").unwrap_err().contains("a unit and a closing bracket"));
        assert!(option("force=F [N] twice").unwrap_err().contains("each part after the first"));
        for text in ["force='", "force=[", "force=€ - € [N] * 1 @", "=", "storey0_velocity=a"] {
            assert!(option(text).is_err(), "{text}");
        }
    }
}
