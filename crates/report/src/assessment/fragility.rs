//! Fragility curves with their certainty.

mod family;
mod figures;

use serde::Serialize;
use slipstick::assessment::censored::Known;
use slipstick::assessment::fragility::{
    Certainty, CloudPoint, Stripe, test_counts, test_normality,
};
use slipstick::assessment::observed::{Data, FragilityRun};
use slipstick::notice::NoticeKind;
use slipstick::table::Table;

use super::key::{of_measure, quantity, title};
use super::sheet::{Sheet, cell};
use crate::display::{DisplayUnits, Unit};
use crate::json::{each, pretty};
use crate::number::compact;
use crate::view;

pub use family::FragilityFamily;

/// What a fragility is told from.
#[derive(Clone, Debug)]
pub struct FragilityReport<'a> {
    /// Where the data came from, as a person calls it.
    pub name: &'a str,
    /// Key of the demand.
    pub demand: &'a str,
    /// The limit on it, SI; `None` where the data are counts or capacities of a limit unknown.
    pub limit: Option<f64>,
    /// The data and the fit.
    pub run: &'a FragilityRun,
    /// Confidence of intervals and band, such as 0.9.
    pub confidence: f64,
    /// Units to show results in.
    pub display: DisplayUnits,
}

/// Shares whose intensities are tabled.
const SHARES: [f64; 5] = [0.05, 0.16, 0.5, 0.84, 0.95];
const POINTS: usize = 161;

impl FragilityReport<'_> {
    fn levels(&self) -> Vec<f64> {
        match &self.run.data {
            Data::Stripes(stripes) => stripes.iter().map(|stripe| stripe.level).collect(),
            Data::Capacities(capacities) => capacities.iter().map(|c| c.level).collect(),
            Data::Cloud(points) => points.iter().map(|point| point.level).collect(),
        }
    }

    fn unit(&self) -> Unit {
        of_measure(
            &self.run.measure_unit,
            self.display,
            self.levels().into_iter().fold(0.0, f64::max),
        )
    }

    fn demand_unit(&self) -> Unit {
        self.display.unit(quantity(self.demand), self.limit.unwrap_or(0.0))
    }

    /// `Peak sliding displacement > 150 mm`, or that the limit is not known.
    fn exceedance(&self) -> String {
        let unit = self.demand_unit();
        match self.limit {
            Some(limit) => {
                format!("{} > {} {}", title(self.demand), compact(unit.of(limit)), unit.symbol)
                    .trim_end()
                    .to_owned()
            }
            None => "exceedance of the limit that was counted".to_owned(),
        }
    }

    /// Intensities from 0 to where the curve ends, with probability and band: the tabled curve.
    #[must_use]
    pub fn curve(&self) -> Vec<[f64; 4]> {
        let curve = self.run.fragility.curve();
        let data = self.levels().into_iter().fold(0.0, f64::max);
        // Past the data the curve is drawn to 99 %, but no further than half as far again.
        let last = curve.intensity(0.99).clamp(data, 1.5 * data);
        let of = |i: usize| {
            let x = last * i as f64 / (POINTS - 1) as f64;
            if i == 0 {
                return [0.0; 4];
            }
            let [low, high] = self.run.fragility.band(x, self.confidence);
            [x, curve.probability(x), low, high]
        };
        (0..POINTS).map(of).collect()
    }

    /// The curve as a table.
    #[must_use]
    pub fn table(&self) -> Table {
        let mut table = Table::default();
        add_curve(&mut table, &self.run.measure_unit, &self.curve());
        table
    }

    /// The result laid out.
    #[must_use]
    pub fn sheet(&self) -> Sheet {
        let (unit, edp) = (self.unit(), self.demand_unit());
        let from = match &self.run.data {
            Data::Stripes(stripes) => {
                let runs: u64 = stripes.iter().map(|stripe| stripe.runs).sum();
                format!("{} stripes, {runs} runs", stripes.len())
            }
            Data::Capacities(capacities) => {
                let reached = capacities.iter().filter(|c| c.reached).count();
                format!("{} capacities, {reached} reached", capacities.len())
            }
            Data::Cloud(points) => format!("a cloud of {} runs", points.len()),
        };
        let mut figures = vec![self.figure(unit)];
        if let Data::Cloud(points) = &self.run.data {
            figures.push(self.cloud_figure(points, unit, edp));
        }
        Sheet {
            kind: "Fragility",
            name: self.name.to_owned(),
            first: Some(("Fitted", self.fitted())),
            line: format!("{} over {}, from {from}", self.exceedance(), &self.run.measure),
            display: self.display,
            verdict: vec![self.verdict(unit)],
            warnings: self.run.warnings.clone(),
            tables: self.tables(unit),
            notes: vec![self.goodness().1],
            figures,
            method: self.method(),
            complete: self.complete(),
            json: pretty(&self.json()),
            ..Sheet::default()
        }
    }

    /// Whether every run has a demand.
    fn complete(&self) -> bool {
        !self.run.warnings.iter().any(|warning| warning.kind == NoticeKind::FailedRuns)
    }

    /// Median with its interval, and dispersion.
    fn verdict(&self, unit: Unit) -> String {
        let curve = self.run.fragility.curve();
        let interval = match self.run.fragility.median_interval(self.confidence) {
            [Some(low), Some(high)] => format!(
                " ({} % interval {} to {} {})",
                compact(100.0 * self.confidence),
                cell(unit.of(low)),
                cell(unit.of(high)),
                unit.symbol
            ),
            _ => String::new(),
        };
        format!(
            "Median {} θ = {} {}{interval}, dispersion β = {}.",
            self.run.measure,
            cell(unit.of(curve.median)),
            unit.symbol,
            cell(curve.dispersion)
        )
    }

    /// What was fitted and why, and over what it averages.
    fn fitted(&self) -> String {
        let what = match &self.run.data {
            Data::Stripes(_) => "counts of exceedances at each level",
            Data::Capacities(_) => "capacities, the first crossing of each record",
            Data::Cloud(_) => "all runs by regression (cloud)",
        };
        let averaged = if self.run.averaged.designs > 1 {
            format!("; {}", self.run.averaged)
        } else {
            String::new()
        };
        format!("to {what}: {}{averaged}", self.run.why)
    }

    /// Of what the standard errors and intervals are.
    fn certainty(&self) -> String {
        let by = self.run.clustered_by;
        match self.run.fragility.certainty() {
            Certainty::Independent => {
                "Intervals of θ and β are by profile likelihood; the band is pointwise, Φ(η ± z se(η)) of \
                 the linear predictor, with the observed information. The data are taken as independent \
                 of each other."
                    .to_owned()
            }
            Certainty::Clustered { records } => format!(
                "Runs of one {by} are not independent: standard errors are clustered by {by} (the \
                 sandwich of the scores of {records} {by}s), intervals are θ exp(± t se(ln θ)) and \
                 β exp(± t se(β)/β) with Student's t on {} degrees of freedom, and so is the band.",
                records - 1
            ),
            Certainty::Bootstrap { records, curves, .. } => format!(
                "Standard errors, intervals and band are those of {} curves, each fitted to {records} \
                 {by}s drawn with replacement (bootstrap).",
                curves.len()
            ),
        }
    }

    fn tables(&self, unit: Unit) -> Vec<(String, Vec<Vec<String>>)> {
        let curve = self.run.fragility.curve();
        let [of_median, of_dispersion] = self.run.fragility.standard_errors();
        let percent = compact(100.0 * self.confidence);
        let heads = ["", "Estimate", "Standard error", &format!("{percent} % from"), "to"];
        let end = |end: Option<f64>, unit: Option<Unit>| {
            end.map_or("open".to_owned(), |v| cell(unit.map_or(v, |unit| unit.of(v))))
        };
        let [low, high] = self.run.fragility.median_interval(self.confidence);
        let median = vec![
            unit.label("Median θ"),
            cell(unit.of(curve.median)),
            format!("{} (of ln θ)", cell(of_median)),
            end(low, Some(unit)),
            end(high, Some(unit)),
        ];
        let [low, high] = self.run.fragility.dispersion_interval(self.confidence);
        let dispersion = vec![
            "Dispersion β".to_owned(),
            cell(curve.dispersion),
            cell(of_dispersion),
            end(low, None),
            end(high, None),
        ];
        let mut tables = vec![(
            "Lognormal fragility".to_owned(),
            vec![heads.map(str::to_owned).to_vec(), median, dispersion],
        )];
        let heads = vec!["Probability of exceedance".to_owned(), unit.label(&self.run.measure)];
        let row =
            |p: f64| vec![format!("{} %", compact(100.0 * p)), cell(unit.of(curve.intensity(p)))];
        tables.push((
            "Intensity by probability".to_owned(),
            std::iter::once(heads).chain(SHARES.map(row)).collect(),
        ));
        if let Data::Stripes(stripes) = &self.run.data {
            let heads =
                [&unit.label(&self.run.measure), "Runs", "Exceed", "Share", "Fitted", "from", "to"];
            let row = |stripe: &Stripe| {
                let [low, high] = self.run.fragility.band(stripe.level, self.confidence);
                vec![
                    cell(unit.of(stripe.level)),
                    stripe.runs.to_string(),
                    stripe.exceeded.to_string(),
                    share(stripe.exceeded as f64 / stripe.runs as f64),
                    share(curve.probability(stripe.level)),
                    share(low),
                    share(high),
                ]
            };
            let heads = heads.map(|head| head.to_string()).to_vec();
            let rows = std::iter::once(heads).chain(stripes.iter().map(row)).collect();
            tables.push(("Stripes".to_owned(), rows));
        }
        if let Data::Cloud(points) = &self.run.data {
            let fit = self.run.fragility.fit();
            let count =
                |known: Known| points.iter().filter(|p| p.known == known).count().to_string();
            let rows = [
                ("", "Value".to_owned()),
                ("a (ln D = a + b ln IM, SI)", cell(fit.intercept())),
                ("b", cell(fit.slope())),
                ("σ of ln D", cell(fit.sigma())),
                ("Demands known", count(Known::Exactly)),
                ("  below the floor", count(Known::AtMost)),
                ("  above the cap", count(Known::AtLeast)),
            ];
            let rows = rows.map(|(name, value)| vec![name.to_owned(), value]).to_vec();
            tables.push(("Cloud regression".to_owned(), rows));
        }
        tables
    }

    /// Goodness of fit, where it is tested, and that in words.
    fn goodness(&self) -> (Option<GoodnessOfFit>, String) {
        let normality = |values: &[f64], of: &str| {
            let Some(test) = test_normality(values) else {
                let untested = "Goodness of fit is not tested: it needs eight values or more, none \
                                of them censored.";
                return (None, untested.to_owned());
            };
            let note = format!(
                "Goodness of fit: Anderson and Darling's A² of {of} is {}, p = {}; largest \
                 difference from the fitted distribution {}. {}",
                cell(test.anderson_darling),
                cell(test.p_value),
                cell(test.largest_difference),
                verdict(test.p_value)
            );
            let found = GoodnessOfFit {
                test: "anderson_darling",
                statistic: test.anderson_darling,
                p_value: Some(test.p_value),
                largest_difference: Some(test.largest_difference),
                ..GoodnessOfFit::default()
            };
            (Some(found), note)
        };
        match &self.run.data {
            Data::Stripes(stripes) => {
                let test = test_counts(&self.run.fragility.curve(), stripes);
                let p = test.p_value.map_or("no degrees of freedom".to_owned(), |p| {
                    format!("p = {} on {} degrees of freedom", cell(p), test.degrees)
                });
                let rough = if test.least_expected < 1.0 {
                    " Some expected counts are below 1, so p is rough."
                } else {
                    ""
                };
                let verdict = test.p_value.map_or("", verdict);
                let note = format!(
                    "Goodness of fit: deviance {}, {p}; Pearson's χ² {}. {verdict}{rough}",
                    cell(test.deviance),
                    cell(test.pearson)
                );
                let found = GoodnessOfFit {
                    test: "deviance",
                    statistic: test.deviance,
                    pearson: Some(test.pearson),
                    degrees_of_freedom: Some(test.degrees),
                    p_value: test.p_value,
                    ..GoodnessOfFit::default()
                };
                (Some(found), note.trim_end().to_owned())
            }
            Data::Capacities(capacities) => {
                let all = capacities.iter().all(|capacity| capacity.reached);
                let logs: Vec<f64> = capacities.iter().map(|c| libm::log(c.level)).collect();
                normality(if all { &logs } else { &[] }, "the logarithms of the capacities")
            }
            Data::Cloud(points) => {
                let fit = self.run.fragility.fit();
                let all = points.iter().all(|point| point.known == Known::Exactly);
                let residual = |p: &CloudPoint| {
                    libm::log(p.demand) - fit.intercept() - fit.slope() * libm::log(p.level)
                };
                let residuals: Vec<f64> = points.iter().map(residual).collect();
                normality(if all { &residuals } else { &[] }, "the residuals of ln D")
            }
        }
    }

    fn method(&self) -> Vec<String> {
        let mut method = vec![format!(
            "P(exceedance | x) = Φ(ln(x/θ)/β), by maximum likelihood. {} All count the scatter \
                 between the runs given, not what the suite, the model or the measure leave out.",
            self.certainty()
        )];
        method.push(
            match &self.run.data {
                Data::Stripes(_) => {
                    "Counts: k of n runs at a level exceed (Baker 2015). The test of fit takes runs as \
                     independent."
                }
                Data::Capacities(_) => {
                    "Capacities: a record that does not reach the limit at its highest level counts as a \
                     capacity above it (right-censored)."
                }
                Data::Cloud(_) => {
                    "Cloud: ln D is linear in ln IM with constant, normal scatter; demands below the floor \
                     and above the cap count as such (Tobin's likelihood). σ is that of maximum \
                     likelihood, with n."
                }
            }
            .to_owned(),
        );
        method
    }

    fn json(&self) -> impl Serialize {
        let FragilityRun { data, why, averaged, measure, measure_unit, fragility, .. } = self.run;
        let curve = fragility.curve();
        let [se_ln_median, se_dispersion] = fragility.standard_errors();
        let (mut stripes, mut capacities, mut cloud) = (None, None, None);
        let method = match data {
            Data::Stripes(all) => {
                let all =
                    each(all, |s| view! { level: s.level, runs: s.runs, exceeded: s.exceeded });
                stripes = Some(view! { stripes: all });
                "stripes"
            }
            Data::Capacities(all) => {
                let all = each(all, |c| view! { level: c.level, reached: c.reached });
                capacities = Some(view! { capacities: all });
                "capacities"
            }
            Data::Cloud(points) => {
                let fit = fragility.fit();
                let count = |known: Known| points.iter().filter(|p| p.known == known).count();
                let found = view! {
                    intercept: fit.intercept(),
                    slope: fit.slope(),
                    sigma: fit.sigma(),
                    known: count(Known::Exactly),
                    below_floor: count(Known::AtMost),
                    above_cap: count(Known::AtLeast),
                };
                cloud = Some(view! { cloud: found });
                "cloud"
            }
        };
        let (certainty, records) = match fragility.certainty() {
            Certainty::Independent => ("independent", None),
            Certainty::Clustered { records } => ("clustered", Some(*records)),
            Certainty::Bootstrap { records, .. } => ("bootstrap", Some(*records)),
        };
        view! {
            name: self.name,
            method,
            why,
            designs: averaged.designs,
            averaged_over: &averaged.paths,
            measure,
            measure_unit,
            demand: self.demand,
            limit: self.limit,
            median: curve.median,
            dispersion: curve.dispersion,
            se_ln_median,
            se_dispersion,
            certainty,
            clustered_by: records.map(|_| self.run.clustered_by),
            records,
            confidence: self.confidence,
            median_interval: fragility.median_interval(self.confidence),
            dispersion_interval: fragility.dispersion_interval(self.confidence),
            log_likelihood: fragility.fit().log_likelihood(),
            goodness_of_fit: self.goodness().0,
            #[serde(flatten)] stripes,
            #[serde(flatten)] capacities,
            #[serde(flatten)] cloud,
            curve: self.curve(),
        }
    }
}

/// The columns of a curve over intensities in a unit.
fn add_curve(table: &mut Table, unit: &str, rows: &[[f64; 4]]) {
    let column = |i: usize| rows.iter().map(|row| row[i]).collect::<Vec<f64>>();
    table.numbers("level", unit, column(0));
    for (i, name) in ["probability", "band_low", "band_high"].into_iter().enumerate() {
        table.numbers(name, "", column(i + 1));
    }
}

/// A test of the fitted distribution; which figures it has depends on the test.
#[derive(Default, Serialize)]
struct GoodnessOfFit {
    test: &'static str,
    statistic: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pearson: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    degrees_of_freedom: Option<usize>,
    p_value: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    largest_difference: Option<f64>,
}

fn verdict(p: f64) -> &'static str {
    if p < 0.05 {
        "A lognormal curve is rejected at the 5 % level."
    } else {
        "A lognormal curve is not rejected at the 5 % level."
    }
}

/// A probability as a table shows it: what no data can tell from 0 is not spelt out.
fn share(value: f64) -> String {
    if value > 0.0 && value < 1e-6 { "< 1e-6".to_owned() } else { cell(value) }
}
