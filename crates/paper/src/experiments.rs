//! Both solvers on every mock-up, and the tests of the paper's figures.

use crate::PaperError;
use crate::claims::Finding;
use crate::curves::range;
use crate::library::{Experiment, Library, Shake, storey_peak};
use slipstick::check::check;
use slipstick::motion::Sine;
use slipstick::response::{Demands, EventKind, Iterations, Response};
use slipstick::solver;
use slipstick::units::STANDARD_GRAVITY_M_PER_S2;

/// One experiment by both solvers.
#[derive(Clone, Debug, PartialEq)]
pub struct TestRun {
    /// Name of the experiment.
    pub id: String,
    /// What its model file calls it.
    pub name: String,
    /// Peak of the table acceleration in m/s².
    pub pga_m_per_s2: f64,
    /// Step of the motion in s.
    pub dt_s: f64,
    /// Peaks and counts of the exact response.
    pub exact: Demands,
    /// Largest of the four figures of the exact response's certificate.
    pub certificate: f64,
    /// Whether the certificate holds.
    pub certified: bool,
    /// Peaks, counts and iterations of the stepwise response, or why there is none.
    pub stepwise: Result<(Demands, Iterations), String>,
}

/// A test drawn in the layout of one of the paper's figures.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawnTest {
    /// Number of the figure.
    pub figure: u32,
    /// What is drawn.
    pub name: String,
    /// The part of the history that is drawn, in s.
    pub window_s: [f64; 2],
    /// Exact response.
    pub exact: Response,
    /// Stepwise response, where its iteration converged.
    pub stepwise: Option<Response>,
}

pub(crate) fn run(
    library: &Library,
    findings: &mut Vec<Finding>,
) -> Result<(Vec<TestRun>, Vec<DrawnTest>), PaperError> {
    let mut tests = Vec::new();
    for experiment in library.experiments() {
        tests.push(test(experiment)?);
    }
    let mut drawn = Vec::new();
    for (figure, id, seconds) in [
        (3, "section3-124kg-spring143-sine", [0.0, 4.0]),
        (4, "section3-124kg-spring143-taft", [0.0, 30.0]),
        (5, "section3-124kg-free-sine", [0.0, 11.0]),
        (6, "section3-124kg-free-taft", [0.0, 30.0]),
        (9, "section6-45kg-1_625hz-sine", [0.0, 15.0]),
        (10, "section6-201kg-1_125hz-sine", [0.0, 15.0]),
        (11, "section6-201kg-2_65hz-sine", [0.0, 8.0]),
        (12, "section6-201kg-1_125hz-taft", [0.0, 30.0]),
    ] {
        let experiment = library.drawn(id)?;
        let motion = experiment.motion()?;
        drawn.push(DrawnTest {
            figure,
            name: experiment.name.clone(),
            window_s: seconds,
            exact: solver::exact(&experiment.model, &motion)?,
            stepwise: solver::stepwise(&experiment.model, &motion).ok(),
        });
    }
    findings.push(release(library)?);
    histories(library, findings)?;
    Ok((tests, drawn))
}

fn test(experiment: &Experiment) -> Result<TestRun, PaperError> {
    let motion = experiment.motion()?;
    let response = solver::exact(&experiment.model, &motion)?;
    let certificate = check(&experiment.model, &motion, &response);
    let figures = [
        certificate.equilibrium_residual,
        certificate.friction_excess,
        certificate.energy_balance_error,
        certificate.demands_error,
    ];
    let dt_s = match &experiment.shake {
        Shake::Sine(sine) => Some(sine.dt_s),
        Shake::Record(motion) => motion.dt_s(),
    };
    let stepwise = solver::stepwise(&experiment.model, &motion).map_err(|error| error.to_string());
    Ok(TestRun {
        id: experiment.id.clone(),
        name: experiment.name.clone(),
        pga_m_per_s2: motion.figures().pga_m_per_s2,
        dt_s: dt_s.unwrap_or(f64::NAN),
        exact: response.demands,
        certificate: figures.into_iter().fold(0.0, f64::max),
        certified: certificate.holds(),
        stepwise: stepwise.and_then(|response| {
            let iterations = response.iterations.ok_or("no iterations were counted")?;
            Ok((response.demands, iterations))
        }),
    })
}

/// Amplitudes of the table in m/s² over which a figure without a stated one is scanned: section 6
/// names 0.1 to 5.
const SCANNED: [f64; 7] = [0.5, 1.0, 2.0, 3.0, 4.0, 4.5, 5.0];

/// Peaks in g over which a record without a stated size is scanned.
const SCANNED_G: [f64; 5] = [0.1, 0.2, 0.3, 0.4, 0.5];

/// The histories of the figures, whose tests are not stated in full: ranges of peak block and storey
/// acceleration in m/s², peak and residual sliding displacement in mm.
fn histories(library: &Library, findings: &mut Vec<Finding>) -> Result<(), PaperError> {
    let tests: [(&str, &str, &[&str]); 8] = [
        ("fig3", "section3", &["spring128-sine", "spring143-sine"]),
        ("fig4", "section3", &["spring143-taft"]),
        ("fig5", "section3", &["free-sine"]),
        ("fig6", "section3", &["free-taft"]),
        ("fig9-histories", "section6", &["45kg-1_625hz-sine"]),
        ("fig10-histories", "section6", &["201kg-1_125hz-sine"]),
        ("fig11-histories", "section6", &["201kg-2_65hz-sine"]),
        ("fig12", "section6", &["taft"]),
    ];
    for (figure, section, ends) in tests {
        let of_figure = |test: &&Experiment| {
            test.id.starts_with(section) && ends.iter().any(|end| test.id.ends_with(end))
        };
        let all = scanned(library.experiments().iter().filter(of_figure))?;
        let of = |value: &dyn Fn(&Demands) -> f64| range(all.iter().map(value));
        let storey = of(&storey_peak);
        let mut finding = Finding::unchecked(figure)
            .quoting("block", of(&|d| d.peak_block_acceleration_m_per_s2))
            .quoting("sliding", of(&|d| 1e3 * d.peak_sliding_displacement_m))
            .quoting("residual", of(&|d| 1e3 * d.residual_sliding_displacement_m));
        if storey[1] > 0.0 {
            finding = finding.quoting("storey", storey);
        }
        findings.push(finding);
    }
    Ok(())
}

/// Each test over the sizes of its table.
fn scanned<'a>(tests: impl Iterator<Item = &'a Experiment>) -> Result<Vec<Demands>, PaperError> {
    let mut all = Vec::new();
    for test in tests {
        let shakes: Vec<Shake> = match &test.shake {
            Shake::Sine(sine) => {
                let of = |amplitude_m_per_s2| Shake::Sine(Sine { amplitude_m_per_s2, ..*sine });
                SCANNED.map(of).to_vec()
            }
            Shake::Record(record) => {
                let peaks = SCANNED_G.map(|peak_g| peak_g * STANDARD_GRAVITY_M_PER_S2);
                let of = |peak| record.scaled_to_peak(peak).map(Shake::Record);
                peaks.into_iter().map(of).collect::<Result<_, _>>()?
            }
        };
        for shake in shakes {
            all.push(Experiment { shake, ..test.clone() }.demands()?);
        }
    }
    Ok(all)
}

/// Eq. (1): at which table acceleration a block at rest starts to slide.
fn release(library: &Library) -> Result<Finding, PaperError> {
    let experiment = library.experiment("section3-124kg-free-sine")?;
    let response = solver::exact(&experiment.model, &experiment.motion()?)?;
    let first = response.events.iter().find(|event| event.kind == EventKind::Slip);
    let found = first.zip(response.history.as_ref()).and_then(|(event, history)| {
        let knot = history.time_s.iter().position(|t| *t == event.time_s)?;
        history.table_acceleration_m_per_s2.get(knot).copied()
    });
    Ok(Finding::new("eq1", found.map_or(f64::NAN, f64::abs))
        .quoting("gravity", experiment.model.gravity_m_per_s2()))
}
