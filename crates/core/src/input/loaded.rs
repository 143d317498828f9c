//! From records that were read to the motion that is analysed: the choice of channel, the vertical
//! component, the scale, and what is to be said of all that.

use super::unfit::vertical_alone;
use super::{MotionSource, PairOf, Scale};
use crate::error::{MotionError, listed};
use crate::motion::processing::{Step, process_motion};
use crate::motion::{Figures, GroundMotion};
use crate::notice::{Notice, NoticeKind};
use crate::record::{self, Channel, FilterCorners, Origin, Quantity, Record, Sampling, Units};

/// The column that becomes the vertical component of its neighbour without being asked for.
const VERTICAL_COLUMN: &str = "vertical_acceleration_m_per_s2";

/// A record, and which of its channels is wanted.
#[derive(Clone, Copy, Debug)]
pub struct Wanted<'a> {
    /// The record.
    pub record: &'a Record,
    /// Name or number (from 1) of the channel; not needed where one is acceleration.
    pub channel: Option<&'a str>,
}

/// Records of the components of one motion.
#[derive(Clone, Copy, Debug)]
pub struct Components<'a> {
    /// Along the surface, along x in two directions.
    pub horizontal: Wanted<'a>,
    /// Along y, and how the two make a pair.
    pub along_y: Option<(Wanted<'a>, PairOf)>,
    /// Normal to the surface, and its factor besides that of all.
    pub vertical: Option<(Wanted<'a>, f64)>,
}

impl<'a> From<Wanted<'a>> for Components<'a> {
    fn from(horizontal: Wanted<'a>) -> Self {
        Self { horizontal, along_y: None, vertical: None }
    }
}

/// A component of a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Component {
    /// Horizontal, along x in two directions.
    X,
    /// Horizontal, along y.
    Y,
    /// Vertical.
    Vertical,
}

impl Component {
    /// The key of a model's motion that names its file.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            Self::X => "record",
            Self::Y => "record_y",
            Self::Vertical => "vertical",
        }
    }
}

/// A motion ready for analysis, and what is to be said of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The motion, scaled, with its vertical component.
    pub motion: GroundMotion,
    /// Name of the horizontal channel; empty for a made motion.
    pub channel: String,
    /// What its file says of where it was recorded.
    pub origin: Origin,
    /// Factor on the values of the file; 1 of a made motion.
    pub factor: f64,
    /// What was understood, one line a record: `PEER AT2, 2800 values, 0.005 s, g`.
    pub description: Vec<String>,
    /// Figures of the horizontal component as analysed.
    pub figures: Figures,
    /// What the reader should know.
    pub warnings: Vec<Notice>,
}

/// Why records make no motion.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LoadError {
    /// Several channels, or none of the name that was asked for.
    #[error("expected {expected} (channels: {channels})")]
    Channel {
        /// What was expected.
        expected: String,
        /// The key of the model that tells which, where one would help.
        key: Option<&'static str>,
        /// The channels there are.
        channels: String,
        /// Of which component.
        component: Component,
    },
    /// Samples that are no ground motion, or that cannot be scaled.
    #[error("{error}")]
    Motion {
        /// Why.
        error: MotionError,
        /// Of which component.
        component: Component,
    },
}

impl Loaded {
    /// A made motion, which comes from no record.
    #[must_use]
    pub fn made(motion: GroundMotion, description: String) -> Self {
        let figures = motion.figures();
        let description = vec![description];
        let (channel, origin) = (String::new(), Origin::default());
        Self { motion, channel, origin, factor: 1.0, description, figures, warnings: vec![] }
    }

    /// A motion of arrays in these units, judged as a record of a file is.
    #[must_use]
    pub fn of_arrays(motion: GroundMotion, units: &Units, description: String) -> Self {
        let uneven = || Sampling::Times(motion.times_s().to_vec());
        let sampling = motion.dt_s().map_or_else(uneven, Sampling::Dt);
        let components = [
            Some(motion.horizontal_m_per_s2()),
            motion.horizontal_y_m_per_s2(),
            motion.vertical_m_per_s2(),
        ];
        let judged = |values| record::judged(values, &sampling, units);
        let warnings = components.into_iter().flatten().flat_map(judged).collect();
        let made = Self::made(motion.clone(), description);
        Self { warnings, ..made }.with(motion, 1.0)
    }

    /// What it is called where a name is needed: a record as its source, whatever is made by what it is.
    #[must_use]
    pub fn name(&self, source: Option<&MotionSource>) -> String {
        match source {
            Some(MotionSource::Record(record)) => record.name(),
            _ => self.description.join("; "),
        }
    }

    /// A name of it, with what was understood of its files as a note.
    #[must_use]
    pub fn words(&self, name: &str) -> String {
        let understood = self.description.join("; ");
        if name == understood { understood } else { format!("{name} ({understood})") }
    }

    /// The same times a factor; what its reader said stands, how it starts and ends is said anew.
    ///
    /// # Errors
    /// [`MotionError`] as [`GroundMotion::scaled`].
    pub fn scaled(&self, factor: f64) -> Result<Self, MotionError> {
        Ok(self.with(self.motion.scaled(factor)?, factor))
    }

    /// The same with another factor on y, then turned, x towards y.
    ///
    /// # Errors
    /// [`MotionError`] as [`GroundMotion::turned`].
    pub fn turned(&self, scale_y: f64, angle_rad: f64) -> Result<Self, MotionError> {
        Ok(self.with(self.motion.turned(scale_y, angle_rad)?, 1.0))
    }

    /// The same after steps of processing, on all components; `None` where they end in another quantity.
    ///
    /// # Errors
    /// As [`process_motion`].
    pub fn processed(&self, steps: &[Step]) -> Result<Option<Self>, (usize, MotionError)> {
        let Some(motion) = process_motion(&self.motion, steps)? else { return Ok(None) };
        let said = steps.iter().map(Step::to_string);
        let description = self.description.iter().cloned().chain(said).collect();
        let cut_s = |step: &Step| if let Step::Trim { from_s, .. } = step { *from_s } else { 0.0 };
        let origin = self.origin.clone().later_by(steps.iter().map(cut_s).sum());
        Ok(Some(Self { description, origin, ..self.with(motion, 1.0) }))
    }

    /// With a notice of each file along the surface that is a vertical component; a channel that was asked
    /// for by name is the one that is wanted. Each file stands with the channel that was asked for.
    #[must_use]
    pub fn with_vertical_told(
        mut self,
        x: (&str, Option<&str>),
        along_y: Option<(&str, Option<&str>)>,
    ) -> Self {
        let none = Origin::default();
        let of_y = self.origin.along_y.as_deref().unwrap_or(&none);
        let files = [Some((x, &self.origin)), along_y.map(|y| (y, of_y))];
        let told = |((path, channel), origin): ((&str, Option<&str>), &Origin)| {
            if channel.is_some() { None } else { vertical_alone(path, origin) }
        };
        let told: Vec<Notice> = files.into_iter().flatten().filter_map(told).collect();
        self.warnings.extend(told);
        self
    }

    /// One of its components, with the label of its place.
    #[must_use]
    pub fn component(&self, component: Component) -> Option<Self> {
        let motion = match component {
            Component::X => Some(self.motion.along_x()),
            Component::Y => self.motion.horizontal_y_m_per_s2().map(|_| self.motion.along_y()),
            Component::Vertical => self.motion.upwards(),
        };
        let motion = motion?.horizontal_alone();
        let origin = match component {
            Component::X => self.origin.clone(),
            _ => Origin { component: None, azimuth_deg: None, ..self.origin.clone() },
        };
        Some(Self { origin, ..self.with(motion, 1.0) })
    }

    /// Its component along x as a channel of a record, in SI.
    #[must_use]
    pub fn as_channel(&self) -> Channel {
        let Origin { event, station, component, azimuth_deg, .. } = self.origin.clone();
        let uneven = || Sampling::Times(self.motion.times_s().to_vec());
        Channel {
            name: self.channel.clone(),
            event,
            station,
            component,
            azimuth_deg,
            units: Units::m_per_s2(),
            values: self.motion.horizontal_m_per_s2().to_vec(),
            sampling: self.motion.dt_s().map_or_else(uneven, Sampling::Dt),
            filter: FilterCorners::default(),
            warnings: self.warnings.clone(),
        }
    }

    /// What it is with another motion made of its own, and a factor on that.
    fn with(&self, motion: GroundMotion, factor: f64) -> Self {
        let figures = motion.figures();
        let said = self.warnings.iter().filter(|w| !record::REST_KINDS.contains(&w.kind));
        let warnings = said.cloned().chain(of_motion(&motion, &figures, &[])).collect();
        Self { motion, factor: self.factor * factor, figures, warnings, ..self.clone() }
    }

    /// Records as one motion, scaled as one: the factor, or the peak of the larger horizontal component,
    /// is of all; then the pair has its own factor and is turned.
    ///
    /// # Errors
    /// [`LoadError`] where the channel is not one that can be told, and where scaling has no answer.
    pub fn recorded<'a>(
        components: impl Into<Components<'a>>,
        scale: Option<Scale>,
    ) -> Result<Self, LoadError> {
        let Components { horizontal, along_y, vertical } = components.into();
        let of = |component| move |error| LoadError::Motion { error, component };
        let (record, channel) = (horizontal.record, choose(horizontal, Component::X)?);
        let mut description = vec![record.describe(channel)];
        let mut warnings = of_reader(record, channel);
        let mut motion = motion(channel).map_err(of(Component::X))?;
        let mut differ = Vec::new();
        let mut origin = Origin::of(channel);
        if let Some((second, _)) = along_y {
            let channel = choose(second, Component::Y)?;
            origin = origin.with_along_y(Origin::of(channel));
            description.push(format!("along y: {}", second.record.describe(channel)));
            warnings.extend(of_reader(second.record, channel));
            let second = self::motion(channel).map_err(of(Component::Y))?;
            let lengths_differ;
            (motion, lengths_differ) = motion.with_along_y(&second).map_err(of(Component::Y))?;
            differ.extend(lengths_differ.then_some("the components along x and along y"));
        }
        if let Some((up, factor)) = vertical {
            let channel = choose(up, Component::Vertical)?;
            description.push(format!("vertical: {}", up.record.describe(channel)));
            warnings.extend(of_reader(up.record, channel));
            let up = self::motion(channel).map_err(of(Component::Vertical))?;
            let lengths_differ;
            (motion, lengths_differ) =
                motion.with_vertical(&up, factor).map_err(of(Component::Vertical))?;
            differ
                .extend(lengths_differ.then_some("the vertical component and the horizontal one"));
        } else if let Some(up) = record.channels.iter().find(|c| c.name == VERTICAL_COLUMN)
            && up.name != channel.name
        {
            let up = self::motion(up).map_err(of(Component::X))?;
            (motion, _) = motion.with_vertical(&up, 1.0).map_err(of(Component::X))?;
            description.push(format!("vertical: column {VERTICAL_COLUMN}"));
        }
        let factor = match scale {
            None => Ok(1.0),
            Some(Scale::Factor(factor)) => Ok(factor),
            Some(Scale::Peak(peak)) => motion.factor_to_peak(peak),
        };
        let factor = factor.map_err(of(Component::X))?;
        let scaled = if scale.is_some() { motion.scaled(factor) } else { Ok(motion) };
        let turned = match along_y {
            None => scaled,
            Some((_, pair)) => scaled.and_then(|m| m.turned(pair.scale_y, pair.rotate_rad)),
        };
        let motion = turned.map_err(of(Component::X))?;
        let figures = motion.figures();
        warnings.extend(of_motion(&motion, &figures, &differ));
        let channel = channel.name.clone();
        Ok(Self { motion, channel, origin, factor, description, figures, warnings })
    }
}

/// The channel asked for, else the only one that is acceleration along the surface.
fn choose(wanted: Wanted<'_>, component: Component) -> Result<&Channel, LoadError> {
    let record = wanted.record;
    let is_acceleration = |c: &&Channel| c.units.quantity() == Quantity::Acceleration;
    let error = |expected: String, key| {
        let describe = |(i, c): (usize, &Channel)| {
            format!("{} {:?} ({})", i + 1, c.name, c.units.quantity().name())
        };
        let all = || record.channels.iter().enumerate();
        // Those that may be chosen, where there are any.
        let fitting: Vec<_> = all().filter(|(_, c)| is_acceleration(c)).collect();
        let shown = if fitting.is_empty() { all().collect() } else { fitting };
        let channels = listed(shown.into_iter().map(describe));
        LoadError::Channel { expected, key, channels, component }
    };
    if let Some(name) = wanted.channel {
        let channel = record.channel(name).filter(is_acceleration);
        return channel.ok_or_else(|| error(format!("an acceleration channel {name:?}"), None));
    }
    let mut candidates = record.channels.iter().filter(is_acceleration);
    let mut along = candidates.clone().filter(|c| c.name != VERTICAL_COLUMN);
    match (along.next(), along.next(), candidates.next()) {
        (Some(channel), None, _) | (None, _, Some(channel)) => Ok(channel),
        (None, ..) if record.channels.iter().any(|c| c.units.quantity() == Quantity::Counts) => {
            let expected = "the value of one count: add units = \"4.67e-6 m/s2\" to [motion]";
            Err(error(expected.to_owned(), Some("units")))
        }
        (None, ..) => Err(error("a channel of acceleration".to_owned(), None)),
        (Some(first), Some(_), _) => {
            let wanted = component == Component::Vertical;
            let of_kind = |c: &&Channel| c.is_vertical() == wanted;
            let mut all = record.channels.iter().filter(is_acceleration);
            let name = &all.find(of_kind).unwrap_or(first).name;
            let key = if component == Component::Y { "channel_y" } else { "channel" };
            let expected = format!("one channel of acceleration: add {key} = {name:?} to [motion]");
            Err(error(expected, Some(key)))
        }
    }
}

/// The motion of a channel of acceleration.
fn motion(channel: &Channel) -> Result<GroundMotion, MotionError> {
    channel.motion().unwrap_or(Err(MotionError::Counts))
}

/// What the reader says; how the motion starts and ends is said of it as it is used.
fn of_reader(file: &Record, channel: &Channel) -> Vec<Notice> {
    let all = file.warnings.iter().chain(&channel.warnings);
    let of_file = all.filter(|w| !record::REST_KINDS.contains(&w.kind));
    of_file.cloned().collect()
}

/// What an engineer asks first of a record: does it start from rest, and does it drift.
fn of_motion(motion: &GroundMotion, figures: &Figures, differ: &[&str]) -> Vec<Notice> {
    let mut warnings = Vec::new();
    let by_axis = motion.figures_by_axis();
    let axes = match (&by_axis, motion.horizontal_y_m_per_s2()) {
        (Some([x, y]), Some(second)) => {
            vec![(x, motion.horizontal_m_per_s2(), "along x: "), (y, second, "along y: ")]
        }
        _ => vec![(figures, motion.horizontal_m_per_s2(), "")],
    };
    for (figures, samples, axis) in axes {
        let Figures { pga_m_per_s2, pgv_m_per_s, pgd_m, end_velocity_m_per_s } = *figures;
        let beyond = record::beyond_earthquakes(pga_m_per_s2, pgv_m_per_s, pgd_m);
        let beyond = beyond.map(|w| Notice { message: format!("{axis}{}", w.message), ..w });
        warnings.extend(beyond);
        for w in record::rest(samples[0], pga_m_per_s2, end_velocity_m_per_s, pgv_m_per_s) {
            let at_start = w.kind != NoticeKind::RecordDrift;
            let time_s = Some(if at_start { 0.0 } else { motion.duration_s() });
            warnings.push(Notice { time_s, message: format!("{axis}{}", w.message), ..w });
        }
    }
    warnings.extend(differ.iter().map(|components| {
        let message = format!("{components} differ in length: the shorter is zero after its end");
        Notice::new(NoticeKind::LengthsDiffer, message)
    }));
    warnings
}
