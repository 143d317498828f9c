//! The three jobs of identification from measured files to estimates and, where a model is given, that
//! model with what was told.

use super::compare::table_csv;
use super::cyclic::{
    self, BearingLoads, CurvePoint, Cycle, CycleColumn, CyclicError, CyclicEstimates, CyclicFit,
    CyclicTest, KineticLaw, PressurePoint, estimates, estimates_at_loads, zero_not_stated,
};
use super::estimate::Estimate;
use super::fitted::{self, PressureKeys};
use super::free_vibration::{FreeVibration, Motion, free_vibration as fit_free_vibration};
use super::measured::{Measured, MeasuredSeries};
use super::shaking_table::{
    Builder, Instruments, Parameter, TableError, TableFit, TableTest, shaking_table as fit_table,
};
use crate::error::{ChoiceError, InputError, RecordError, listed, similar};
use crate::input::{self, Analysis, Channel, Override};
use crate::notice::Notice;
use crate::study::engine::Engine;
use crate::table::Table;
use crate::units::Dimension;

/// The text of a model and the keys that are set from outside.
#[derive(Clone, Copy, Debug)]
pub struct ModelText<'a> {
    /// What messages call it.
    pub name: &'a str,
    /// All its keys, as TOML.
    pub text: &'a str,
    /// Keys set from outside.
    pub set: &'a [Override],
}

impl ModelText<'_> {
    fn analysis(&self) -> Result<Analysis, InputError> {
        let analysis = input::parse(self.name, self.text, self.set)?;
        analysis.along_x_alone()?;
        Ok(analysis)
    }

    /// The model with what was told and more keys, and what had to be decided for it.
    fn fitted(
        &self,
        estimates: &[Estimate],
        more: Vec<Override>,
    ) -> Result<(Analysis, Vec<Notice>), InputError> {
        let (told, warnings) = fitted::overrides(estimates);
        let set: Vec<Override> = self.set.iter().cloned().chain(told).chain(more).collect();
        Ok((input::parse(self.name, self.text, &set)?, warnings))
    }
}

/// The text of a model of a block alone, whose friction a test replaces; the mass as it was written.
#[must_use]
pub fn block_text(mass: &str) -> String {
    let mass = mass.trim();
    format!("[block]\nmass = \"{mass}\"\n\n[slider]\nstatic_friction = 1\nkinetic_friction = 1\n")
}

/// What was identified.
#[derive(Clone, Debug)]
pub struct Identified {
    /// One estimate a parameter.
    pub estimates: Vec<Estimate>,
    /// The given model with what was told.
    pub model: Option<Analysis>,
    /// What a reader must know.
    pub warnings: Vec<Notice>,
    /// What only one of the jobs has.
    pub found: Fitted,
}

impl Identified {
    /// The fitted model and what it needs beside it, by the names of their files.
    #[must_use]
    pub fn files(&self) -> Vec<(&'static str, String)> {
        let table = match &self.found {
            Fitted::ShakingTable { fit, .. } => Some(table_csv(&fit.comparison.motion)),
            _ => None,
        };
        let record = table.as_ref().map(|_| TABLE_FILE);
        let model = self.model.as_ref().map(|model| ("model.toml", model.to_toml(record)));
        model.into_iter().chain(table.map(|text| (TABLE_FILE, text))).collect()
    }
}

impl Identified {
    /// The estimates, one row a parameter; of cyclic tests also one row a cycle, and where friction follows
    /// the speed one row a cycle and class of speeds and the fitted curve, where it follows the pressure one row a
    /// cycle and that curve; of a shaking-table record also the agreement with the best values.
    #[must_use]
    pub fn tables(&self, measured: &[Measured]) -> Vec<(&'static str, Table)> {
        let all = &self.estimates;
        let numbers = |of: &dyn Fn(&Estimate) -> Option<f64>| {
            all.iter().map(|estimate| of(estimate).unwrap_or(f64::NAN)).collect::<Vec<f64>>()
        };
        let mut estimates = Table::default();
        estimates
            .texts("parameter", all.iter().map(|e| e.path.clone()).collect())
            .texts("unit", all.iter().map(|e| e.unit.to_owned()).collect())
            .numbers("value", "", numbers(&Estimate::value))
            .numbers("low", "", numbers(&|e| e.interval().map(|[low, _]| low)))
            .numbers("high", "", numbers(&|e| e.interval().map(|[_, high]| high)))
            .texts("cannot_tell", all.iter().map(|e| e.why().unwrap_or("").to_owned()).collect());
        let more = match &self.found {
            Fitted::Cyclic { fits, .. } => Some(("cycles", cycles(fits, measured))),
            Fitted::FreeVibration { .. } => None,
            Fitted::ShakingTable { fit, .. } => Some(("agreement", fit.comparison.table())),
        };
        core::iter::once(("estimates", estimates))
            .chain(more)
            .chain(self.by_speed(measured))
            .chain(self.by_pressure(measured))
            .collect()
    }

    /// The table `[slider]` of a model with what cyclic tests told; `None` for the other jobs, and where
    /// friction is not told as a coefficient.
    #[must_use]
    pub fn slider_keys(&self) -> Option<String> {
        let Fitted::Cyclic { together, at_rest_pa, .. } = &self.found else { return None };
        let law = together.pressure.as_ref();
        let law = law.and_then(|law| PressureKeys::new(law, *at_rest_pa).ok().flatten());
        fitted::slider_keys(&self.estimates, law.as_ref())
    }

    /// Friction by pressure, measured and fitted, where it was taken to follow the pressure.
    fn by_pressure(&self, measured: &[Measured]) -> Vec<(&'static str, Table)> {
        let Fitted::Cyclic { fits, together, .. } = &self.found else { return Vec::new() };
        let Some(law) = &together.pressure else { return Vec::new() };
        if law.curve.is_empty() {
            return Vec::new();
        }
        let tests = measured.iter().zip(fits);
        let cycles = tests.flat_map(|(measured, fit)| {
            (1..=fit.cycles.len()).map(|number| (measured.source_name.clone(), number as f64))
        });
        let (names, numbers): (Vec<String>, Vec<f64>) = cycles.unzip();
        let of = |points: &[PressurePoint], figure: fn(&PressurePoint) -> f64| {
            points.iter().map(figure).collect::<Vec<f64>>()
        };
        let (mut points, mut curve) = (Table::default(), Table::default());
        points
            .texts("test", names)
            .numbers("cycle", "", numbers)
            .numbers("pressure_pa", "Pa", of(&law.cycles, |point| point.pressure_pa))
            .numbers("kinetic_friction", "", of(&law.cycles, |point| point.friction));
        curve
            .numbers("pressure_pa", "Pa", of(&law.curve, |point| point.pressure_pa))
            .numbers("kinetic_friction", "", of(&law.curve, |point| point.friction))
            .numbers("low", "", of(&law.curve, |point| point.interval[0]))
            .numbers("high", "", of(&law.curve, |point| point.interval[1]));
        vec![("friction_by_pressure", points), ("pressure_curve", curve)]
    }

    /// Friction by speed, measured and fitted, where it was taken to follow the speed.
    fn by_speed(&self, measured: &[Measured]) -> Vec<(&'static str, Table)> {
        let Fitted::Cyclic { fits, together, .. } = &self.found else { return Vec::new() };
        let Some(rate) = &together.rate else { return Vec::new() };
        let all = || {
            measured.iter().zip(fits).flat_map(|(measured, fit)| {
                let cycles = fit.cycles.iter().enumerate();
                cycles.flat_map(move |(i, cycle)| {
                    cycle.by_speed.iter().map(move |at| (measured, i as f64 + 1.0, at))
                })
            })
        };
        let mut points = Table::default();
        points
            .texts("test", all().map(|(measured, ..)| measured.source_name.clone()).collect())
            .numbers("cycle", "", all().map(|(_, cycle, _)| cycle).collect())
            .numbers("speed_m_per_s", "m/s", all().map(|(.., at)| at.speed_m_per_s).collect())
            .numbers("kinetic_positive_n", "N", all().map(|(.., at)| at.kinetic_n[0]).collect())
            .numbers("kinetic_negative_n", "N", all().map(|(.., at)| at.kinetic_n[1]).collect());
        let of = |figure: fn(&CurvePoint) -> f64| rate.curve.iter().map(figure).collect();
        let unit = rate.estimates[0].unit;
        let mut curve = Table::default();
        curve
            .numbers("speed_m_per_s", "m/s", of(|point| point.speed_m_per_s))
            .numbers("kinetic_friction", unit, of(|point| point.friction))
            .numbers("low", unit, of(|point| point.interval[0]))
            .numbers("high", unit, of(|point| point.interval[1]));
        vec![("friction_by_speed", points), ("friction_curve", curve)]
    }

    /// What was fitted, with the fit: displacement and force of every cyclic test, by the name of its file;
    /// the free vibration; measured and predicted values of a shaking-table record, by quantity. A
    /// sample that was left out has no fitted value.
    #[must_use]
    pub fn curves(&self, measured: &[Measured]) -> Vec<(String, Table)> {
        match &self.found {
            Fitted::Cyclic { fits, .. } => {
                let tests = measured.iter().zip(fits).filter_map(|(measured, fit)| {
                    let [displacement, force] = cyclic_histories(measured).ok()?;
                    let mut table = Table::default();
                    table
                        .numbers("time_s", "s", displacement.times_s.clone())
                        .numbers("displacement_m", "m", displacement.values.clone())
                        .numbers("force_n", "N", force.values.clone())
                        .numbers("fitted_n", "N", fit.fitted_n.clone());
                    Some((measured.source_name.clone(), table))
                });
                tests.collect()
            }
            Fitted::FreeVibration { channel, times_s, values, fit } => {
                let unit = channel.dimension().si_unit();
                let mut fitted_values = fit.fitted.clone();
                fitted_values.resize(times_s.len(), f64::NAN);
                let mut table = Table::default();
                table
                    .numbers("time_s", "s", times_s.clone())
                    .numbers("measured", unit, values.clone())
                    .numbers("fitted", unit, fitted_values);
                vec![(channel.name(), table)]
            }
            Fitted::ShakingTable { fit, .. } => fit.comparison.curves(),
        }
    }
}

/// One row a cycle.
fn cycles(fits: &[CyclicFit], measured: &[Measured]) -> Table {
    let tests = measured.iter().zip(fits);
    let names = tests.flat_map(|(m, fit)| fit.cycles.iter().map(|_| m.source_name.clone()));
    let mut table = Table::default();
    table.texts("test", names.collect());
    for CycleColumn { key, unit, value, .. } in &Cycle::COLUMNS {
        let cycles = fits.iter().flat_map(|fit| &fit.cycles);
        table.numbers(key, unit, cycles.map(|c| value(c).unwrap_or(f64::NAN)).collect());
    }
    table
}

/// The file of a measured table acceleration.
const TABLE_FILE: &str = "table.csv";

/// What only one of the jobs has.
#[derive(Clone, Debug)]
pub enum Fitted {
    /// Cyclic tests.
    Cyclic {
        /// What each test says, in the order of the files.
        fits: Vec<CyclicFit>,
        /// What they say together.
        together: Box<CyclicEstimates>,
        /// The force that presses the block on its surface in each test, in N, where it is known.
        normal_forces_n: Option<Vec<f64>>,
        /// The pressure under the weight of the model in Pa, where a model and the area of the bearing are known.
        at_rest_pa: Option<f64>,
    },
    /// Free vibration.
    FreeVibration {
        /// The quantity that was fitted.
        channel: Channel,
        /// The times that were fitted, in s.
        times_s: Vec<f64>,
        /// Its values there, in SI.
        values: Vec<f64>,
        /// The fit.
        fit: Box<FreeVibration>,
    },
    /// A shaking-table record.
    ShakingTable {
        /// The fit.
        fit: Box<TableFit>,
        /// What was fitted.
        parameters: Vec<Parameter>,
        /// Seed of the global start.
        seed: u64,
    },
}

/// Why nothing was identified.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum IdentifyError {
    /// The model.
    #[error(transparent)]
    Input(#[from] InputError),
    /// A file lacks a quantity.
    #[error(transparent)]
    Measured(#[from] RecordError),
    /// Something chosen that cannot be.
    #[error(transparent)]
    Choice(#[from] ChoiceError),
    /// A cyclic test that says nothing.
    #[error("{source_name}: {error}")]
    Cyclic {
        /// The file.
        source_name: String,
        /// Why.
        error: CyclicError,
    },
    /// A shaking-table record that says nothing.
    #[error(transparent)]
    Table(#[from] TableError),
}

/// What is asked of cyclic tests.
#[derive(Clone, Copy, Debug)]
pub struct CyclicRequest<'a> {
    /// A model that takes the friction found.
    pub model: Option<ModelText<'a>>,
    /// The force that presses the block on its surface, in N: one, or one for each test; the weight of the model if there
    /// is none.
    pub normal_forces_n: &'a [f64],
    /// Area of the bearing in m², where friction is to follow the pressure.
    pub area_m2: Option<f64>,
    /// As in [`BearingLoads`].
    pub reference_pa: Option<f64>,
    /// As in [`CyclicTest`].
    pub slack_m: Option<f64>,
    /// As in [`CyclicTest`].
    pub spring: bool,
    /// As in [`CyclicTest`].
    pub damper: bool,
    /// As in [`CyclicTest`].
    pub law: KineticLaw,
}

/// Displacement and force of a cyclic test.
///
/// # Errors
/// [`RecordError`] where the file lacks either.
pub fn cyclic_histories(measured: &Measured) -> Result<[&MeasuredSeries; 2], RecordError> {
    let displacement = match measured.get(Channel::SlidingDisplacement) {
        Some(sliding) if measured.get(Channel::Displacement).is_none() => sliding,
        _ => measured.require(Channel::Displacement)?,
    };
    Ok([displacement, measured.require(Channel::Force)?])
}

/// What cannot be in a field of a request.
fn refused(what: &str, expected: impl Into<String>, found: impl Into<String>) -> ChoiceError {
    let (what, expected, found) = (what.to_owned(), expected.into(), found.into());
    ChoiceError { what, expected, found, nearest: None }
}

/// The normal force of each test, where it is known.
fn normal_forces(
    given_n: &[f64],
    weight_n: Option<f64>,
    tests: usize,
) -> Result<Option<Vec<f64>>, ChoiceError> {
    if let Some(found) = given_n.iter().chain(&weight_n).find(|n| !(**n > 0.0)) {
        return Err(refused("normal-force", "more than 0 N", format!("{found} N")));
    }
    match given_n {
        [] => Ok(weight_n.map(|weight_n| vec![weight_n; tests])),
        [one] => Ok(Some(vec![*one; tests])),
        each if each.len() == tests => Ok(Some(each.to_vec())),
        each => {
            let expected = match tests {
                1 => "one force for the one test".to_owned(),
                _ => format!("one force, or one for each of {tests} tests, in their order"),
            };
            Err(refused("normal-force", expected, format!("{} forces", each.len())))
        }
    }
}

/// What presses the bearing in each test, where friction is to follow the pressure.
fn bearing_loads<'a>(
    request: &CyclicRequest<'_>,
    normal_forces_n: Option<&'a [f64]>,
) -> Result<Option<BearingLoads<'a>>, ChoiceError> {
    let CyclicRequest { area_m2, reference_pa, .. } = *request;
    let Some(area_m2) = area_m2 else {
        let differ = normal_forces_n.is_some_and(|all| all.windows(2).any(|two| two[0] != two[1]));
        let expected = "the area of the bearing, such as \"0.04 m2\", beside";
        return match reference_pa {
            _ if differ => {
                Err(refused("area", format!("{expected} normal forces that differ"), "none"))
            }
            Some(_) => Err(refused("area", format!("{expected} a `reference-pressure`"), "none")),
            None => Ok(None),
        };
    };
    for (what, found) in [("area", Some(area_m2)), ("reference-pressure", reference_pa)] {
        if let Some(found) = found.filter(|value| !(*value > 0.0)) {
            return Err(refused(what, "more than 0", format!("{found}")));
        }
    }
    let beside = "a `normal-force`, a `mass` or a model beside the area of the bearing";
    let normal_n = normal_forces_n.ok_or_else(|| refused("area", beside, "none"))?;
    Ok(Some(BearingLoads { normal_n, area_m2, reference_pa }))
}

/// What was noticed of each test; of several files each warning names its own.
fn cyclic_warnings(measured: &[Measured], fits: &[CyclicFit]) -> Vec<Notice> {
    let of_file = |measured: &Measured, warning: Notice| match fits.len() {
        1 => warning,
        _ => {
            Notice { message: format!("{}: {}", measured.source_name, warning.message), ..warning }
        }
    };
    let read = measured.iter().flat_map(|m| m.warnings.iter().cloned().map(move |w| (m, w)));
    let doubt = |m: &Measured, fit| m.zero_as_measured.then(|| cyclic::zero_doubted(fit)).flatten();
    let fitted = measured
        .iter()
        .zip(fits)
        .flat_map(|(m, fit)| fit.warnings().into_iter().chain(doubt(m, fit)).map(move |w| (m, w)));
    read.chain(fitted).map(|(m, w)| of_file(m, w)).collect()
}

/// Identifies friction, spring and damper from one or several cyclic tests.
///
/// # Errors
/// [`IdentifyError`] for a model that cannot be, normal forces that are not positive or not as many as tests, or differ
/// without an area, a file without displacement and force, a test in which nothing slides or with too few cycles.
pub fn cyclic(
    request: &CyclicRequest<'_>,
    measured: &[Measured],
) -> Result<Identified, IdentifyError> {
    let given = request.model.map(|model| model.analysis()).transpose()?;
    let weight_n = given.as_ref().map(|given| given.model.weight_n());
    let normal_forces_n = normal_forces(request.normal_forces_n, weight_n, measured.len())?;
    let loads = bearing_loads(request, normal_forces_n.as_deref())?;
    let histories: Result<Vec<_>, _> = measured.iter().map(cyclic_histories).collect();
    let histories = histories?;
    let mut fits = Vec::with_capacity(measured.len());
    for (measured, [displacement, force]) in measured.iter().zip(&histories) {
        let test = CyclicTest {
            times_s: &displacement.times_s,
            displacement_m: &displacement.values,
            force_n: &force.values,
            slack_m: request.slack_m,
            spring: request.spring,
            // A lag between two clocks looks like one.
            damper: request.damper && !measured.is_of_two_clocks,
            law: request.law,
            // An offset of the displacement is one of the force where a spring is fitted.
            zero_known: force.zero_known && (displacement.zero_known || !request.spring),
        };
        let of_file =
            |error| IdentifyError::Cyclic { source_name: measured.source_name.clone(), error };
        fits.push(cyclic::cyclic(&test).map_err(of_file)?);
    }
    let all: Vec<&CyclicFit> = fits.iter().collect();
    let largest = |[_, force]: &[&MeasuredSeries; 2]| {
        force.values.iter().fold(0.0, |m: f64, f| m.max(f.abs()))
    };
    let largest_n: Vec<f64> = histories.iter().map(largest).collect();
    let together = match &loads {
        Some(loads) => estimates_at_loads(&all, &largest_n, loads),
        None => {
            let largest_n = largest_n.iter().copied().fold(0.0, f64::max);
            let normal_force_n = normal_forces_n.as_ref().and_then(|all| all.first().copied());
            estimates(&all, largest_n, normal_force_n)
        }
    };
    let stated = given.as_ref().and_then(|given| given.model.slider().pressure());
    let at_rest_pa = loads.and_then(|loads| {
        let of_weight = weight_n.map(|weight_n| weight_n / loads.area_m2);
        stated.map(|law| law.at_rest_pa()).or(of_weight)
    });
    let mut warnings = cyclic_warnings(measured, &fits);
    warnings.extend(zero_not_stated(&all));
    let kinetic = match &together.rate {
        Some(rate) => rate.estimates.iter().all(|estimate| estimate.value().is_some()),
        None => together.estimates.first().is_some_and(|estimate| estimate.value().is_some()),
    };
    let mut model = None;
    let law = together.pressure.as_ref().map(|law| PressureKeys::new(law, at_rest_pa)).transpose();
    let law = law.map(Option::flatten).unwrap_or_else(|notice| {
        warnings.push(notice);
        None
    });
    if let Some(text) = request.model.filter(|_| kinetic) {
        let more = match &law {
            Some(law) => law.overrides()?,
            // What was fitted holds at any pressure.
            None if stated.is_some() && loads.is_some() => {
                vec![Override::removal("slider.pressure")?]
            }
            None => Vec::new(),
        };
        let (analysis, decided) = text.fitted(&together.estimates, more)?;
        warnings.extend(decided);
        model = Some(analysis);
    }
    let estimates = together.estimates.iter().chain(&together.per_hz).cloned().collect();
    let found = Fitted::Cyclic { fits, together: Box::new(together), normal_forces_n, at_rest_pa };
    Ok(Identified { estimates, model, warnings, found })
}

/// What is asked of a record of free vibration.
#[derive(Clone, Copy, Debug)]
pub struct FreeVibrationRequest<'a> {
    /// A model that takes frequency and damping ratio.
    pub model: Option<ModelText<'a>>,
    /// The quantity to fit; the only one of the file if `None`.
    pub channel: Option<&'a str>,
    /// First and last time to fit, in s.
    pub span_s: [f64; 2],
}

/// Identifies frequency and damping ratio of a storey.
///
/// # Errors
/// [`IdentifyError`] for a model that cannot be, and where the quantity is not there or must be chosen.
pub fn free_vibration(
    request: &FreeVibrationRequest<'_>,
    measured: &Measured,
) -> Result<Identified, IdentifyError> {
    let series = chosen(measured, request.channel)?;
    let [from_s, to_s] = request.span_s;
    let inside = |t: &f64| (from_s..=to_s).contains(t);
    let (times_s, values): (Vec<f64>, Vec<f64>) = series
        .times_s
        .iter()
        .zip(&series.values)
        .filter(|(t, _)| inside(t))
        .map(|(t, v)| (*t, *v))
        .unzip();
    let motion = match series.channel.dimension() {
        Dimension::Acceleration => Motion::Acceleration,
        Dimension::Velocity => Motion::Velocity,
        _ => Motion::Displacement,
    };
    let fit = fit_free_vibration(&times_s, &values, motion);
    // Friction is of no storey: it is told where it shows, beside what a model takes.
    let of_model = vec![fit.frequency.clone(), fit.damping_ratio.clone()];
    let mut estimates = of_model.clone();
    estimates.extend(fit.friction.value().map(|_| fit.friction.clone()));
    let mut warnings = measured.warnings.clone();
    let mut model = None;
    if let Some(text) = request.model.filter(|_| fit.frequency.value().is_some()) {
        let (analysis, decided) = text.fitted(&of_model, Vec::new())?;
        warnings.extend(decided);
        model = Some(analysis);
    }
    let found =
        Fitted::FreeVibration { channel: series.channel, times_s, values, fit: Box::new(fit) };
    Ok(Identified { estimates, model, warnings, found })
}

/// The quantity asked for, else the only one.
fn chosen<'a>(
    measured: &'a Measured,
    name: Option<&str>,
) -> Result<&'a MeasuredSeries, ChoiceError> {
    let fault = |found: &str| {
        let names: Vec<String> = measured.series.iter().map(|s| s.channel.name()).collect();
        let expected = match names.as_slice() {
            [] => format!(
                "a quantity in {}, such as the mapping \"storey1_acceleration = COLUMN [g]\"",
                measured.source_name
            ),
            _ => format!(
                "one of the quantities {} of {}",
                listed(names.iter().cloned()),
                measured.source_name
            ),
        };
        let nearest = similar(found, names.iter().map(String::as_str));
        let (what, found) = ("channel".to_owned(), found.to_owned());
        ChoiceError { what, expected, found, nearest }
    };
    match (name, measured.series.as_slice()) {
        (Some(name), _) => {
            let channel = Channel::parse(name).and_then(|channel| measured.get(channel));
            channel.ok_or_else(|| fault(name))
        }
        (None, [only]) => Ok(only),
        (None, _) => Err(fault("none")),
    }
}

/// What is asked of a shaking-table record.
#[derive(Clone, Copy, Debug)]
pub struct ShakingTableRequest<'a> {
    /// The model.
    pub model: ModelText<'a>,
    /// Its keys to fit, each perhaps with its range: `slider.spring=100 kN/m..200 kN/m`.
    pub fit: &'a [&'a str],
    /// Names of the quantities to fit; all that the model has if empty.
    pub using: &'a [&'a str],
    /// What is known of the transducers, as [`Instruments::parse`] reads it.
    pub instruments: &'a [&'a str],
    /// Seed of the random starts.
    pub seed: u64,
}

/// Identifies keys of a model; the engine is told of every run of it.
///
/// # Errors
/// [`IdentifyError`] for a model, a key or a quantity that cannot be, and as [`fit_table`].
pub fn shaking_table(
    request: &ShakingTableRequest<'_>,
    measured: &Measured,
    engine: &Engine<'_>,
) -> Result<Identified, IdentifyError> {
    let text = request.model;
    let analysis = text.analysis()?;
    let parameters = request.fit.iter().map(|one| Parameter::parse(one, &analysis, request.fit));
    let parameters: Vec<Parameter> = parameters.collect::<Result<_, _>>()?;
    let builder = Builder::new(text.name, text.text, text.set, &parameters);
    let build = |values: &[f64]| builder.model(values);
    let using: Result<Vec<Channel>, ChoiceError> = request.using.iter().map(used).collect();
    let instruments = Instruments::parse(request.instruments)?;
    let test = TableTest {
        measured,
        parameters: &parameters,
        build: &build,
        start: parameters.iter().map(|p| analysis.value(&p.path)).collect(),
        using: Some(using?).filter(|using| !using.is_empty()),
        instruments: &instruments,
        seed: request.seed,
    };
    let fit = fit_table(&test, engine)?;
    let (model, decided) = text.fitted(&fit.estimates, Vec::new())?;
    let mut warnings = fit.comparison.warnings.clone();
    warnings.extend(fit.warnings.iter().cloned());
    warnings.extend(decided);
    let estimates = fit.estimates.clone();
    let found = Fitted::ShakingTable { fit: Box::new(fit), parameters, seed: request.seed };
    Ok(Identified { estimates, model: Some(model), warnings, found })
}

/// A quantity by its name.
fn used(name: &&str) -> Result<Channel, ChoiceError> {
    Channel::parse(name).ok_or_else(|| ChoiceError {
        what: "using".to_owned(),
        expected: "a quantity such as sliding_displacement or block_acceleration".to_owned(),
        found: format!("{name:?}"),
        nearest: None,
    })
}
