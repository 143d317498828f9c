//! The curve with its band, and the cloud behind it.

use slipstick::assessment::censored::Known;
use slipstick::assessment::fragility::{Capacity, CloudPoint};

use super::{Data, FragilityReport};
use crate::assessment::key::title;
use crate::assessment::lines::{BAND, band, dots, line, panel, single};
use crate::display::Unit;
use crate::figures::Drawn;
use crate::legend::{self, FITTED, LIMIT, PROBABILITY};
use crate::number::compact;
use crate::plot::{Axis, Style};

impl FragilityReport<'_> {
    pub(super) fn figure(&self, unit: Unit) -> Drawn {
        let curve = self.curve();
        let column = |i: usize| -> Vec<f64> { curve.iter().map(|row| row[i]).collect() };
        let x: Vec<f64> = column(0).into_iter().map(|v| unit.of(v)).collect();
        let percent = compact(100.0 * self.confidence);
        let points = x.iter().zip(column(1)).map(|(&x, p)| [x, p]).collect();
        let mut series = vec![
            band(&x, &column(2), &column(3), legend::band(self.confidence), BAND),
            line(FITTED.label, FITTED.style, points),
        ];
        let hollow = |label: &str, points: Vec<[f64; 2]>| {
            dots(label, Style { colour: "#a3161c", width: 1.2, dashes: "" }, "#fff", points)
        };
        let what = match &self.run.data {
            Data::Stripes(stripes) => {
                let point = |s: &slipstick::assessment::fragility::Stripe| {
                    [unit.of(s.level), s.exceeded as f64 / s.runs as f64]
                };
                series.push(hollow("observed share", stripes.iter().map(point).collect()));
                "points: share of the runs of each level that exceed the limit"
            }
            Data::Capacities(capacities) => {
                series.push(hollow("records", empirical(capacities, unit)));
                "points: the records' capacities, at their rank among all records"
            }
            Data::Cloud(_) => "from the cloud of the next figure",
        };
        let theta = unit.of(self.run.fragility.curve().median);
        let mark = vec![[0.0, 0.5], [theta, 0.5], [theta, 0.0]];
        let label = format!("θ = {} {}", crate::assessment::sheet::cell(theta), unit.symbol);
        series.push(line(label.trim_end(), Style::LIMIT, clip_at(&mark, &x)));
        let last = x.last().copied().unwrap_or(1.0);
        let axes = [
            Axis::linear(unit.label(&self.run.measure), 0.0, last),
            Axis::linear(PROBABILITY.alone(Unit::NONE), 0.0, 1.0),
        ];
        let [x_axis, y_axis] = axes;
        let caption = format!(
            "Probability of exceedance ({}), with its pointwise {percent} % band; {what}.",
            self.exceedance()
        );
        single("fragility", "Fragility curve", caption, panel(x_axis, y_axis, 260.0, series))
    }

    pub(super) fn cloud_figure(&self, points: &[CloudPoint], unit: Unit, edp: Unit) -> Drawn {
        let runs = |known: Known, label: &str, fill: &'static str| {
            dots(
                label,
                Style { colour: "#1a1a1a", width: 0.8, dashes: "" },
                fill,
                points
                    .iter()
                    .filter(|point| point.known == known)
                    .map(|point| [unit.of(point.level), edp.of(point.demand)])
                    .collect(),
            )
        };
        let mut series = vec![runs(Known::Exactly, "run", "#1a1a1a")];
        for (known, label) in
            [(Known::AtMost, "below the floor"), (Known::AtLeast, "above the cap")]
        {
            let part = runs(known, label, "#fff");
            if !part.points.is_empty() {
                series.push(part);
            }
        }
        let range = |values: Vec<f64>| {
            values
                .into_iter()
                .fold((f64::INFINITY, 0.0), |(l, h): (f64, f64), v| (l.min(v), h.max(v)))
        };
        let (first, last) = range(points.iter().map(|p| unit.of(p.level)).collect());
        let (low, high) = range(points.iter().map(|p| edp.of(p.demand)).collect());
        let limit = edp.of(self.limit.unwrap_or(f64::NAN));
        let (low, high) = (low.min(limit) / 1.2, high.max(limit) * 1.2);
        let fit = self.run.fragility.fit();
        let at = |x: f64, by: f64| {
            let ln_d = fit.intercept() + fit.slope() * libm::log(x * unit.in_si) + by * fit.sigma();
            edp.of(libm::exp(ln_d))
        };
        for (by, label, style) in [
            (0.0, "a + b ln IM", Style { width: 1.8, ..Style::MAIN }),
            (-1.0, "± σ", Style::DASHED),
            (1.0, "", Style::DASHED),
        ] {
            let points: Vec<[f64; 2]> = (0..=100)
                .map(|i| first * libm::pow(last / first, f64::from(i) / 100.0))
                .map(|x| [x, at(x, by)])
                .filter(|[_, y]| (low..=high).contains(y))
                .collect();
            series.push(line(label, style, points));
        }
        series.push(line(LIMIT.label, LIMIT.style, vec![[first, limit], [last, limit]]));
        let axes = [
            Axis::logarithmic(unit.label(&self.run.measure), first / 1.05, last * 1.05),
            Axis::logarithmic(edp.label(&title(self.demand)), low, high),
        ];
        let [x, y] = axes;
        let caption = format!(
            "{} of every run over {}, with the regression ln D = a + b ln IM and one standard \
             deviation to either side.",
            title(self.demand),
            &self.run.measure
        );
        single("cloud", "Cloud", caption, panel(x, y, 260.0, series))
    }
}

/// The mark of θ, as far as the axis goes.
fn clip_at(mark: &[[f64; 2]], x: &[f64]) -> Vec<[f64; 2]> {
    let last = x.last().copied().unwrap_or(1.0);
    if mark.iter().all(|point| point[0] <= last) { mark.to_vec() } else { Vec::new() }
}

/// Reached capacities at their rank over all records: `(i − 1/2)/n`, those not reached above all
/// that are lower.
fn empirical(capacities: &[Capacity], unit: Unit) -> Vec<[f64; 2]> {
    let mut sorted: Vec<Capacity> = capacities.to_vec();
    sorted.sort_by(|a, b| a.level.total_cmp(&b.level).then(b.reached.cmp(&a.reached)));
    // The product-limit estimate of Kaplan and Meier, half a step back.
    let (mut survival, n) = (1.0, sorted.len());
    let mut points = Vec::new();
    for (i, capacity) in sorted.iter().enumerate() {
        let at_risk = (n - i) as f64;
        if capacity.reached {
            let after = survival * (1.0 - 1.0 / at_risk);
            points.push([unit.of(capacity.level), 1.0 - 0.5 * (survival + after)]);
            survival = after;
        }
    }
    points
}
