//! Sliding displacement over records, and spectra.

use slipstick::laboratory::paper::{Paper, SuiteRow};

use super::doc::{Doc, fixed};
use super::graphs;
use crate::number::compact;

pub fn write(doc: &mut Doc, paper: &Paper) {
    doc.heading(2, "Sliding displacement against friction");
    doc.paragraph(
        "Choi and Tung asked, over many records, how far a block slides as its friction grows. Here \
         are the records that ship with the examples, scaled to a peak of 0.3 g; a rigid block \
         without a spring, one coefficient for stick and slip. Peak and residual sliding \
         displacement in mm.",
    );
    let mut names: Vec<&str> = Vec::new();
    for row in &paper.suite {
        if !names.contains(&row.record.as_str()) {
            names.push(&row.record);
        }
    }
    let first: Vec<&SuiteRow> =
        paper.suite.iter().filter(|row| Some(&row.record.as_str()) == names.first()).collect();
    let rows = first.iter().map(|row| {
        let mut cells = vec![compact(row.friction_over_pga), fixed(row.friction, 3)];
        let mut sum = 0.0;
        for name in &names {
            let same =
                |r: &&SuiteRow| r.record == *name && r.friction_over_pga == row.friction_over_pga;
            if let Some(found) = paper.suite.iter().find(same) {
                sum += found.peak_m;
                cells.push(format!(
                    "{}, {}",
                    fixed(1e3 * found.peak_m, 2),
                    fixed(1e3 * found.residual_m, 2)
                ));
            }
        }
        cells.push(fixed(1e3 * sum / names.len() as f64, 2));
        cells
    });
    let mut header = vec!["μ over PGA in g".to_owned(), "μ".to_owned()];
    header.extend(names.iter().map(|name| name.trim_end_matches(".txt").to_owned()));
    header.push("mean peak".to_owned());
    let header: Vec<&str> = header.iter().map(String::as_str).collect();
    doc.table(&header, 0, rows.collect());
    doc.figure(&graphs::suite(paper), "Peak sliding displacement of a rigid block at 0.3 g.");
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
