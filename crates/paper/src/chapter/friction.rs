//! Static against kinetic friction, friction and mass, overturning.

use crate::Paper;

use super::doc::{Doc, fixed, short, signed};
use slipstick_report::number::{compact, rounded};

pub fn write(doc: &mut Doc, paper: &Paper) {
    doc.heading(2, "Static and kinetic friction");
    doc.paragraph(
        "The paper's novelty is to tell the two apart. Each test with both at the measured kinetic \
         coefficient, as measured, and both at the static one; counts are slips, reversals and \
         sticks. Where the table is strong the block hardly sticks and only the kinetic coefficient \
         counts; the static one decides when and whether a slip starts.",
    );
    let rows = paper.friction_pairs.iter().flat_map(|pair| {
        let [mu_s, mu_k] = pair.measured;
        let labels = [
            format!("{} both", compact(mu_k)),
            format!("{}, {}", compact(mu_s), compact(mu_k)),
            format!("{} both", compact(mu_s)),
        ];
        labels.into_iter().enumerate().map(|(i, label)| {
            let name = if i == 0 { short(&pair.name) } else { String::new() };
            let [block, storey, peak, residual] = pair.figures[i];
            let [slips, reversals, sticks] = pair.counts[i];
            let storey = if storey == 0.0 { String::new() } else { fixed(storey, 3) };
            vec![
                name,
                label,
                fixed(block, 3),
                storey,
                fixed(peak, 2),
                fixed(residual, 2),
                format!("{slips}, {reversals}, {sticks}"),
            ]
        })
    });
    doc.table(
        &[
            "test",
            "friction",
            "block, m/s²",
            "storey, m/s²",
            "peak sliding, mm",
            "residual, mm",
            "counts",
        ],
        2,
        rows.collect(),
    );
    doc.claims(paper.claims_of(&["static-kinetic"]));

    doc.heading(2, "Friction that falls with mass");
    doc.paragraph(
        "In section 3 twice the mass lowers both coefficients (see `friction-measured`). The tests of \
         section 6 use coefficients measured without the oscillator's mass; here they are \
         run again with both lowered so. Changes of peak storey acceleration, storey displacement \
         and sliding displacement in %, of the residual in mm.",
    );
    let rows = paper.lighter.iter().map(|l| {
        let [acceleration, displacement, sliding] = l.changes_percent;
        vec![
            short(&l.name),
            format!("{}, {}", rounded(l.factors[0], 3), rounded(l.factors[1], 3)),
            signed(acceleration, 2),
            signed(displacement, 2),
            signed(sliding, 2),
            signed(l.residual_mm, 2),
        ]
    });
    doc.table(
        &[
            "test",
            "factors on μ_s, μ_k",
            "storey acceleration, %",
            "storey displacement, %",
            "peak sliding, %",
            "residual, mm",
        ],
        2,
        rows.collect(),
    );
    doc.claims(paper.claims_of(&["friction-other-mass"]));

    doc.heading(2, "No rocking");
    doc.paragraph(
        "The model slides and does not rock. The overturning moment about the sliding surface over \
         weight times half the width tells where that assumption ends: at 1 the mock-up begins to \
         lift. By peak acceleration of the table in m/s²; the last column is where the ratio first \
         reaches 1, by straight lines between the columns. Springs act at the sliding surface.",
    );
    let rows = paper.overturning.iter().map(|o| {
        let mut cells = vec![short(&o.name)];
        cells.extend(o.ratios.iter().map(|[_, ratio]| fixed(*ratio, 3)));
        cells.push(o.lifts_at_m_per_s2.map_or("never".to_owned(), |level| fixed(level, 2)));
        cells
    });
    let mut header = vec!["test".to_owned()];
    if let Some(first) = paper.overturning.first() {
        header.extend(first.ratios.iter().map(|[level, _]| compact(*level)));
    }
    header.push("lifts at".to_owned());
    let header: Vec<&str> = header.iter().map(String::as_str).collect();
    doc.table(&header, 1, rows.collect());
    doc.claims(paper.claims_of(&["no-rocking"]));
}
