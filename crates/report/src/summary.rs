//! One analysis in figures: what `--json` prints, the table shows and the report begins with.

pub(crate) mod keys;
mod warnings;

use slipstick::assessment::floors::FloorSpectra;
use slipstick::assessment::single::{Job, Judged, Outcome, Solved};
use slipstick::check::{Certificate, ClosestCall};
use slipstick::hash::motion_hash;
use slipstick::input::Names;
use slipstick::model::Model;
use slipstick::motion::{Figures, GroundMotion};
use slipstick::notice::Notice;
use slipstick::record::Origin;
use slipstick::response::{Demands, Iterations, Method, Response};

/// What a [`Summary`] is made from.
#[derive(Clone, Copy, Debug)]
pub struct SummaryInputs<'a> {
    /// Name of the model, else the stem of its file.
    pub name: &'a str,
    /// The model that ran.
    pub model: &'a Model,
    /// The motion that it ran on.
    pub motion: &'a GroundMotion,
    /// Figures of that motion without its tail, in which a drift would go on.
    pub record: Figures,
    /// The answer.
    pub response: &'a Response,
    /// Its certificate; `None` while it is not checked.
    pub certificate: Option<&'a Certificate>,
    /// Factor on both coefficients of friction: 1 but for lower- and upper-bound runs.
    pub friction_factor: f64,
    /// What reading the model and the record gave notice of.
    pub warnings: &'a [Notice],
}

/// Figures that certify a response, without the energy histories.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checks {
    /// Largest defect of the equations of motion.
    pub equilibrium_residual: f64,
    /// Largest excess over the friction law.
    pub friction_excess: f64,
    /// Largest imbalance of energy.
    pub energy_balance_error: f64,
    /// Largest difference of a demand from the one recomputed.
    pub demands_error: f64,
    /// The nearest decision; `None` where nothing was decided, and of the stepwise method.
    pub closest_call: Option<ClosestCall>,
    /// What the first four must stay below.
    pub bound: f64,
    /// Whether they do; `None` of the stepwise method, which is reported, never judged, and of a
    /// response that is not checked.
    pub holds: Option<bool>,
}

impl Checks {
    /// Of a response that is not checked: no figure is a number.
    pub const NONE: Self = Self {
        equilibrium_residual: f64::NAN,
        friction_excess: f64::NAN,
        energy_balance_error: f64::NAN,
        demands_error: f64::NAN,
        closest_call: None,
        bound: f64::NAN,
        holds: None,
    };
}

/// Summaries of the runs with lower- and upper-bound friction.
#[derive(Clone, Debug, PartialEq)]
pub struct Bounds {
    /// With the lower coefficients.
    pub lower: Summary,
    /// With the upper ones.
    pub upper: Summary,
}

/// What a summary has besides where the table moves in two horizontal directions.
#[derive(Clone, Debug, PartialEq)]
pub struct ByAxis {
    /// Demands along x and along y.
    pub demands: [Demands; 2],
    /// Figures of the motion along x and along y.
    pub record: [Figures; 2],
    /// Direction of the sliding displacement at its peak, from x towards y, in rad.
    pub peak_sliding_displacement_direction_rad: f64,
    /// Least local minimum of the sliding speed within slips, in m/s.
    pub least_sliding_speed_m_per_s: Option<f64>,
}

/// One analysis in figures.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// Version of Slipstick.
    pub slipstick: &'static str,
    /// Name of the model, else the stem of its file.
    pub model: String,
    /// Hash of the model, where it was read from a text or from values.
    pub model_hash: Option<String>,
    /// Hash of the motion under its factor, without a tail.
    pub motion_hash: Option<String>,
    /// How it was computed.
    pub method: Method,
    /// Rows of the history.
    pub samples: usize,
    /// Constant step of the motion in s, `None` where it is uneven.
    pub dt_s: Option<f64>,
    /// Time of the last instant, tail included, in s.
    pub duration_s: f64,
    /// Factor on both coefficients of friction.
    pub friction_factor: f64,
    /// Figures of the motion.
    pub record: Figures,
    /// What its file says of where it was recorded.
    pub origin: Origin,
    /// Factor on the record.
    pub record_factor: f64,
    /// Peaks, residuals and counts; of the resultant in two horizontal directions.
    pub demands: Demands,
    /// By axis, where there are two horizontal directions.
    pub by_axis: Option<Box<ByAxis>>,
    /// Intervals in which contact was lost, in s.
    pub contact_loss_s: Vec<[f64; 2]>,
    /// Iterations, of the stepwise method only.
    pub iterations: Option<Iterations>,
    /// The certificate's figures.
    pub checks: Checks,
    /// All that a reader must know, the gravest first.
    pub warnings: Vec<Notice>,
    /// The runs with lower- and upper-bound friction, where they were asked for.
    pub bounds: Option<Box<Bounds>>,
    /// Response spectra of table, block and floors, where they were asked for.
    pub floor_spectra: Option<FloorSpectra>,
    /// What the parts of the model are called.
    pub names: Names,
}

impl Summary {
    /// Gathers the figures and the warnings: those given, the solver's, and those that follow from
    /// the figures (`check_failed`, `gap_exceeded`, `close_call`), one a kind and time.
    #[must_use]
    pub fn new(inputs: &SummaryInputs) -> Self {
        let SummaryInputs { name, motion, record, response, certificate, .. } = *inputs;
        let exact = response.method == Method::Exact;
        let history = response.history.as_ref().filter(|history| !history.is_empty());
        Self {
            slipstick: env!("CARGO_PKG_VERSION"),
            model: name.to_owned(),
            model_hash: None,
            motion_hash: None,
            method: response.method,
            samples: history.map_or(motion.len(), |history| history.rows.len()),
            dt_s: motion.dt_s(),
            duration_s: history
                .and_then(|history| history.time_s.last().copied())
                .unwrap_or_else(|| motion.duration_s()),
            friction_factor: inputs.friction_factor,
            record,
            origin: Origin::default(),
            record_factor: 1.0,
            demands: response.demands.clone(),
            by_axis: by_axis(response, motion),
            contact_loss_s: response.contact_loss_s.clone(),
            iterations: response.iterations,
            checks: certificate.map_or(Checks::NONE, |certificate| Checks {
                equilibrium_residual: certificate.equilibrium_residual,
                friction_excess: certificate.friction_excess,
                energy_balance_error: certificate.energy_balance_error,
                demands_error: certificate.demands_error,
                closest_call: certificate.closest_call.filter(|_| exact),
                bound: certificate.bound,
                holds: exact.then(|| certificate.holds()),
            }),
            warnings: warnings::assemble(inputs),
            bounds: None,
            floor_spectra: None,
            names: Names::default(),
        }
    }

    /// The figures of a response to a job, which is not judged without a certificate.
    #[must_use]
    pub fn of_response(
        name: &str,
        job: &Job,
        (model, friction_factor): (&Model, f64),
        response: &Response,
        certificate: Option<&Certificate>,
    ) -> Self {
        let Job { analysis, loaded, motion, warnings } = job;
        let record = loaded.figures;
        let summary = Self::new(&SummaryInputs {
            name,
            model,
            motion,
            record,
            response,
            certificate,
            friction_factor,
            warnings,
        });
        Self {
            model_hash: Some(analysis.hash()),
            motion_hash: Some(motion_hash(&loaded.motion)),
            // The step is that of the record: a tail may start with a jump or end between two steps.
            dt_s: loaded.motion.dt_s(),
            origin: loaded.origin.clone(),
            record_factor: loaded.factor,
            names: analysis.names.clone(),
            ..summary
        }
    }

    /// The figures of all that came of a job.
    #[must_use]
    pub fn of(name: &str, job: &Job, outcome: &Outcome) -> Self {
        let one = |judged: &Judged| {
            let Judged { friction_factor, model, response, certificate } = judged;
            let of = (model, *friction_factor);
            Self::of_response(name, job, of, response, Some(certificate))
        };
        let summary = one(&outcome.nominal);
        let summary = match &outcome.bounds {
            Some([lower, upper]) => summary.with_bounds(one(lower), one(upper)),
            None => summary,
        };
        Self { floor_spectra: outcome.floor_spectra.clone(), ..summary }
    }

    /// All that a reader must know of a response to a motion with its tail, which is not judged; `warnings` are
    /// those of model and motion.
    #[must_use]
    pub fn noticed(solved: &Solved, motion: &GroundMotion, warnings: &[Notice]) -> Vec<Notice> {
        let Solved { friction_factor, model, response } = solved;
        warnings::assemble(&SummaryInputs {
            name: "",
            model,
            motion,
            record: Figures::default(),
            response,
            certificate: None,
            friction_factor: *friction_factor,
            warnings,
        })
    }

    /// The figures of responses to a job that are not judged: nominal, and perhaps lower and upper.
    ///
    /// `None` without a response.
    #[must_use]
    pub fn of_solved(name: &str, job: &Job, solved: &[Solved]) -> Option<Self> {
        let one = |Solved { friction_factor, model, response }: &Solved| {
            Self::of_response(name, job, (model, *friction_factor), response, None)
        };
        let summary = one(solved.first()?);
        Some(match solved {
            [_, lower, upper] => summary.with_bounds(one(lower), one(upper)),
            _ => summary,
        })
    }

    /// The same with the runs with lower- and upper-bound friction beside it.
    #[must_use]
    pub fn with_bounds(mut self, lower: Self, upper: Self) -> Self {
        self.bounds = Some(Box::new(Bounds { lower, upper }));
        self
    }

    /// Whether an exact run, or one of its bounds, fails its check; a stepwise run never does.
    #[must_use]
    pub fn check_failed(&self) -> bool {
        self.runs().iter().any(|(_, run)| run.checks.holds == Some(false))
    }

    /// All runs with their names, side by side: `nominal`, or `lower`, `nominal`, `upper`.
    #[must_use]
    pub fn runs(&self) -> Vec<(&'static str, &Self)> {
        match &self.bounds {
            None => vec![("nominal", self)],
            Some(bounds) => {
                vec![("lower", &bounds.lower), ("nominal", self), ("upper", &bounds.upper)]
            }
        }
    }

    /// The warnings of all runs, the gravest first; of one weight those of the nominal run, with `None`, before those
    /// of the bounds that it does not share, with the name of the run.
    #[must_use]
    pub fn all_warnings(&self) -> Vec<(Option<&'static str>, &Notice)> {
        let mut all: Vec<_> = self.warnings.iter().map(|warning| (None, warning)).collect();
        for (name, run) in self.runs().into_iter().filter(|(name, _)| *name != "nominal") {
            let own = run.warnings.iter().filter(|warning| !self.warnings.contains(warning));
            all.extend(own.map(|warning| (Some(name), warning)));
        }
        all.sort_by_key(|(_, warning)| core::cmp::Reverse(warning.severity()));
        all
    }

    /// The `--json` object as text: two spaces of indentation, keys always in the same order,
    /// numbers in shortest round-trip digits, finite or `null`.
    #[must_use]
    pub fn to_json(&self) -> String {
        crate::json::pretty(self)
    }
}

fn by_axis(response: &Response, motion: &GroundMotion) -> Option<Box<ByAxis>> {
    let plane = response.in_plane.as_ref()?;
    Some(Box::new(ByAxis {
        demands: plane.axes.clone(),
        record: motion.figures_by_axis()?,
        peak_sliding_displacement_direction_rad: plane.peak_sliding_displacement_direction_rad,
        least_sliding_speed_m_per_s: plane.least_sliding_speed_m_per_s,
    }))
}

/// Whether a figure is above its bound; NaN is.
pub(crate) fn exceeds(figure: f64, bound: f64) -> bool {
    figure.is_nan() || figure > bound
}

/// The name that files and tables give a method.
#[must_use]
pub fn method_name(method: Method) -> &'static str {
    method.name()
}
