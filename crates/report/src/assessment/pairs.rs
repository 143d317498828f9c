//! Pairs of components and the spectrum that they were brought to.

use slipstick::motion::target::{LEAST_SHARE, Matched};
use slipstick::units::STANDARD_GRAVITY_M_PER_S2;

use super::lines::{FRACTILES, RECORD, line, panel, stacked};
use super::sheet::cell;
use crate::figures::Drawn;
use crate::markup::shortened;
use crate::plot::{Axis, Limit, PlotSeries, Style};

/// The spectra of pairs as they were scaled, beside the target.
pub(crate) fn figure(matched: &Matched) -> Drawn {
    let g = STANDARD_GRAVITY_M_PER_S2;
    let points = |values: &[f64], factor: f64| -> Vec<[f64; 2]> {
        matched.periods_s.iter().zip(values).map(|(t, sa)| [*t, factor * sa / g]).collect()
    };
    let mut series: Vec<PlotSeries> = Vec::new();
    for pair in &matched.pairs_m_per_s2 {
        let label = if series.is_empty() { "pair" } else { "" };
        series.push(line(label, RECORD, points(pair, 1.0)));
    }
    series.push(line("mean of the pairs", FRACTILES[1], points(&matched.mean_m_per_s2, 1.0)));
    series.push(line("target", Style::LIMIT, points(&matched.target_m_per_s2, 1.0)));
    let least = points(&matched.target_m_per_s2, LEAST_SHARE);
    series.push(line("90 % of it", Style { width: 0.6, ..Style::LIMIT }, least));
    let (from, to) = (matched.periods_s[0], matched.periods_s[matched.periods_s.len() - 1]);
    let all = series.iter().flat_map(|s| s.points.iter().map(|p| p[1])).collect::<Vec<_>>();
    let spectra = panel(
        Axis::logarithmic("Period (s)", from, to),
        Axis::from_zero("RotD100 of PSa, 5 % (g)", all),
        220.0,
        series,
    );
    let ratios = matched.mean_m_per_s2.iter().zip(&matched.target_m_per_s2);
    let ratios: Vec<f64> = ratios.map(|(mean, target)| mean / target).collect();
    let points = matched.periods_s.iter().zip(&ratios).map(|(t, ratio)| [*t, *ratio]);
    let mut misfit = panel(
        Axis::logarithmic("Period (s)", from, to),
        Axis::covering("Mean over target", ratios.iter().copied().chain([LEAST_SHARE, 1.0])),
        90.0,
        vec![line("", FRACTILES[1], points.collect())],
    );
    misfit.limits =
        vec![Limit { value: LEAST_SHARE, label: "90 %".to_owned(), style: Style::LIMIT }];
    let caption = format!(
        "Spectra of {} in the maximum direction, each scaled by one factor, from {} s to {} s; below, \
         their mean over the target: least {} at {} s.",
        match matched.factors.len() {
            1 => "one pair".to_owned(),
            pairs => format!("{pairs} pairs"),
        },
        cell(from),
        cell(to),
        cell(matched.least[0]),
        cell(matched.least[1])
    );
    stacked("target", "Pairs and their target spectrum", caption, vec![spectra, misfit])
}

/// Factor and misfit of every pair, by the names of the pairs.
pub(crate) fn table<'a>(
    names: impl Iterator<Item = &'a str>,
    matched: &Matched,
) -> (String, Vec<Vec<String>>) {
    let heads = ["Pair", "Factor", "Misfit σ of ln"].map(str::to_owned).to_vec();
    let row = |((name, factor), misfit): ((&str, &f64), &f64)| {
        vec![shortened(name, 40), cell(*factor), cell(*misfit)]
    };
    let rows = names.zip(&matched.factors).zip(&matched.misfits).map(row);
    (
        "Factors on both components of each pair".to_owned(),
        std::iter::once(heads).chain(rows).collect(),
    )
}

/// How they were brought to it.
pub(crate) fn method(matched: &Matched) -> String {
    format!(
        "Each pair is scaled by one factor, so that the logarithms of its RotD100 spectrum and of the \
         target agree in the mean over the periods; all pairs are then raised by {}, so that their mean \
         is nowhere below 90 % of the target (ASCE/SEI 7-22, 16.2.3.2). The misfit is the standard \
         deviation of ln(RotD100/target).",
        cell(matched.raised)
    )
}
