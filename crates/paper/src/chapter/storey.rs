//! Numbers of the text, storey displacement, and no amplification.

use crate::Paper;

use super::doc::{Doc, fixed};
use super::graphs;

pub fn write(doc: &mut Doc, paper: &Paper) {
    doc.heading(2, "Numbers of the text");
    doc.claims(paper.claims_of(&[
        "amplification-",
        "mass-",
        "steel-",
        "friction-measured",
        "spring-measured",
    ]));
    doc.paragraph(
        "The rods of section 6 as ideal steel cantilevers, in Hz; the paper lists 1.125, 1.625, \
         1.75, 2.15 and 2.65 Hz without saying which mass stood on which rod.",
    );
    let rods: Vec<(f64, f64)> =
        paper.cantilevers.iter().map(|c| (c.diameter_m, c.length_m)).collect();
    let mut distinct = rods.clone();
    distinct.dedup();
    let rows = distinct.iter().map(|&(diameter_m, length_m)| {
        let of_rod = paper
            .cantilevers
            .iter()
            .filter(|c| (c.diameter_m, c.length_m) == (diameter_m, length_m));
        let name = format!("{} mm, {} m", fixed(1e3 * diameter_m, 0), fixed(length_m, 2));
        std::iter::once(name).chain(of_rod.map(|c| fixed(c.frequency_hz, 3))).collect()
    });
    doc.table(&["rod", "45 kg", "90 kg", "201 kg"], 1, rows.collect());
    doc.claims(paper.claims_of(&["frequency-"]));

    doc.heading(2, "How far the storey moves");
    doc.paragraph(
        "Figures 9d and 10d are quoted with 6.5 mm and 11 mm, without the table that gave them. The \
         peaks of 20 s from rest were computed over all amplitudes that section 6 names. They \
         belong to the start; once sliding repeats, friction alone drives the storey and the \
         table's size hardly matters.",
    );
    doc.figure(
        &graphs::displacements(&paper.displacements),
        "Peak storey displacement in 20 s from rest; red: the printed value. A sine that starts at \
         its peak starts with a jump.",
    );
    doc.claims(paper.claims_of(&["storey-"]));

    doc.heading(2, "No amplification near resonance");
    doc.paragraph(
        "The three tests run near the storey's resonance. A fixed block would amplify; a block that \
         slides freely passes on little more than its friction.",
    );
    doc.figure(
        &graphs::free_sliding(&paper.free_sliding),
        "Peak accelerations over that of the table (red: one) in 20 s from rest.",
    );
    doc.claims(
        paper
            .claims_of(&["fig9-", "fig10-", "fig11-"])
            .filter(|claim| !claim.id.ends_with("-histories")),
    );
}
