//! Sliding displacement over records, and spectra.

use crate::{Paper, SUITE_PEAK_M_PER_S2, SuiteRow};
use slipstick::units::STANDARD_GRAVITY_M_PER_S2;

use super::doc::{Doc, fixed};
use super::graphs;
use slipstick_report::number::compact;

pub fn write(doc: &mut Doc, paper: &Paper) {
    doc.heading(2, "Sliding displacement against friction");
    let peak_g = compact(SUITE_PEAK_M_PER_S2 / STANDARD_GRAVITY_M_PER_S2);
    doc.paragraph(&format!(
        "Choi and Tung asked, over many records, how far a block slides as its friction grows. Here are \
         the records that ship with the examples, and those of `--records` where that was given, \
         scaled to a peak of {peak_g} g; a rigid block without a spring, one coefficient for stick and \
         slip. The columns are friction over the peak in g.",
    ));
    doc.paragraph("Peak sliding displacement, mm:");
    table(doc, paper, |row| 1e3 * row.peak_m);
    doc.paragraph("Residual sliding displacement, mm:");
    table(doc, paper, |row| 1e3 * row.residual_m);
    doc.figure(
        &graphs::suite(paper),
        &format!("Peak sliding displacement of a rigid block at {peak_g} g."),
    );
    doc.paragraph(
        "The records are trimmed at both ends and drift (see `examples/records/README.md`), which \
         moves the residuals at the smallest frictions.",
    );

    doc.heading(2, "Spectra of sliding structures");
    doc.paragraph(
        "Mostaghel and Tanbakuchi drew spectra of a one-storey structure on a sliding block under El \
         Centro 1940. The same form: fixed-base period along, 5 % damping, four coefficients of \
         friction and three shares of the storey in the whole mass; those values are ours, as the \
         paper does not quote theirs. As recorded, 180° component.",
    );
    doc.figure(
        &graphs::spectra(paper, false),
        "Peak total acceleration of the storey over the peak of the table.",
    );
    doc.figure(&graphs::spectra(paper, true), "Peak sliding displacement of the block.");
    let rows = paper.spectra.iter().map(|spectrum| {
        let highest = spectrum.points.iter().map(|p| p[1]).fold(0.0, f64::max);
        let sliding = spectrum.points.iter().map(|p| 1e3 * p[2]).fold(0.0, f64::max);
        let friction = if spectrum.friction.is_finite() {
            fixed(spectrum.friction, 2)
        } else {
            "fixed".to_owned()
        };
        let sliding =
            if spectrum.friction.is_finite() { fixed(sliding, 1) } else { "–".to_owned() };
        vec![compact(spectrum.mass_ratio), friction, fixed(highest, 3), sliding]
    });
    doc.table(
        &["M2/(M1 + M2)", "friction", "largest acceleration over PGA", "largest sliding, mm"],
        0,
        rows.collect(),
    );
}

/// A row a record, a column a friction; mean and standard deviation below.
fn table(doc: &mut Doc, paper: &Paper, value: fn(&SuiteRow) -> f64) {
    let names = graphs::records(paper);
    let of = |name: &str| -> Vec<&SuiteRow> {
        paper.suite.iter().filter(|row| row.record == name).collect()
    };
    let mut rows: Vec<Vec<String>> = Vec::new();
    let mut columns: Vec<Vec<f64>> = Vec::new();
    for name in &names {
        let mut cells = vec![graphs::stem(name).to_owned()];
        for (i, row) in of(name).into_iter().enumerate() {
            if columns.len() <= i {
                columns.push(Vec::new());
            }
            columns[i].push(value(row));
            cells.push(fixed(value(row), 2));
        }
        rows.push(cells);
    }
    let mean = |column: &Vec<f64>| column.iter().sum::<f64>() / column.len() as f64;
    let deviation = |column: &Vec<f64>| {
        let squares = column.iter().map(|v| (v - mean(column)) * (v - mean(column)));
        (squares.sum::<f64>() / (column.len() as f64 - 1.0)).sqrt()
    };
    for (label, figure) in
        [("mean", &mean as &dyn Fn(&Vec<f64>) -> f64), ("standard deviation", &deviation)]
    {
        let cells = columns.iter().map(|column| fixed(figure(column), 2));
        rows.push(std::iter::once(format!("**{label}**")).chain(cells).collect());
    }
    let first = names.first().copied().unwrap_or_default();
    let mut header = vec!["record".to_owned()];
    header.extend(of(first).iter().map(|row| compact(row.friction_over_pga)));
    let header: Vec<&str> = header.iter().map(String::as_str).collect();
    doc.table(&header, 1, rows);
}
