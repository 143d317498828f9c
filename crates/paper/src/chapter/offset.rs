//! The offset, and why accelerations agree and displacements do not.

use crate::{NOISE_M_PER_S2, OffsetRow, Paper};
use slipstick::units::STANDARD_GRAVITY_M_PER_S2;

use super::doc::{Doc, fixed, short, signed};
use super::graphs;
use slipstick_report::number::compact;

pub fn write(doc: &mut Doc, paper: &Paper) {
    doc.heading(2, "Where an offset comes from");
    doc.paragraph(
        "Without a spring the paper's measured and predicted sliding displacements end apart, and \
         it could only guess why: a surface off the level, friction that differs by direction, its \
         own integration. Each can be computed, and the start of the table besides. The tests are \
         those of the figures; the springs were also run under the table motion of the free block, \
         so that only the spring differs.",
    );
    doc.heading(3, "The start");
    doc.paragraph(
        "A level table with equal friction both ways leaves an offset when its sine starts: the \
         first slip is not half a cycle like the others, and what it leaves stays. The phase of the \
         start decides it, and a slow start removes it.",
    );
    doc.figure(
        &graphs::start_phase(&paper.start_phases),
        "Block of 124 kg without a spring, 1.5 Hz, 3 m/s²: mid-line of the 15th cycle.",
    );
    let ramps =
        paper.start_phases.iter().filter(|p| p.phase_deg == 0.0).map(|p| {
            vec![compact(p.ramp_cycles), fixed(p.midline_mm, 2), fixed(p.half_range_mm, 2)]
        });
    doc.table(&["cycles of rise", "mid-line, mm", "half peak-to-peak, mm"], 0, ramps.collect());
    doc.claims(paper.claims_of(&["fig5-no-offset"]));
    doc.heading(3, "Tilt and asymmetry");
    doc.paragraph(
        "What a tilt (uphill towards +x) and friction larger towards +x than towards −x add to the \
         residual sliding displacement, in mm, and the growth in a cycle under 1 mrad late in the \
         motion. Without a spring both grow with every cycle for as long as the table moves: the \
         mark of a tolerance is a drift, not a step.",
    );
    tolerances(doc, paper);
    doc.claims(paper.claims_of(&["offset-tolerances", "offset-spring", "offset-reproduced"]));
    doc.heading(3, "Noise and baseline of the table record");
    doc.paragraph(&format!(
        "The paper fed its program with the measured table acceleration. White noise on that record \
         (standard deviation in m/s², root mean square change of the residual in mm) and a constant \
         error of it (change in mm). A constant error is a tilt: 0.01 m/s² is one of {} mrad.",
        fixed(1e3 * 0.01 / STANDARD_GRAVITY_M_PER_S2, 2)
    ));
    disturbances(doc, paper);
    doc.heading(3, "The stepwise integration");
    doc.paragraph(
        "Stepwise less exact residual on the same samples, in mm, by step: what the integration \
         alone adds. The method notices a stop or a release at the next sample, and the error of \
         one run depends on where between two samples its events happen to lie, so that it does not \
         fall evenly with the step.",
    );
    steps(doc, paper);
    doc.claims(paper.claims_of(&["offset-integration"]));
    doc.heading(2, "Why accelerations agree and displacements do not");
    sensitivities(doc, paper);
    doc.claims(paper.claims_of(&["accelerations-agree", "preliminary-design"]));
}

fn tolerances(doc: &mut Doc, paper: &Paper) {
    let levels = |of: fn(&OffsetRow) -> &Vec<[f64; 2]>, unit: &str| -> Vec<String> {
        let first = paper.offsets.first().map_or(&[][..], |row| of(row).as_slice());
        first.iter().map(|[level, _]| format!("{} {unit}", compact(*level))).collect()
    };
    let tilts = levels(|row| &row.tilt, "mrad");
    let mut header = vec!["test", "peak", "level"];
    header.extend(tilts.iter().map(String::as_str));
    header.push("a cycle");
    let rows = paper.offsets.iter().map(|row| {
        let mut cells = vec![short(&row.name), fixed(row.peak_mm, 2), fixed(row.residual_mm, 2)];
        cells.extend(row.tilt.iter().map(|[_, mm]| signed(*mm, 2)));
        cells.push(row.growth_mm_per_cycle.map_or("–".to_owned(), |mm| signed(mm, 3)));
        cells
    });
    doc.table(&header, 1, rows.collect());
    let asymmetries = levels(|row| &row.asymmetry, "%");
    let mut header = vec!["test"];
    header.extend(asymmetries.iter().map(String::as_str));
    let rows = paper.offsets.iter().map(|row| {
        let mut cells = vec![short(&row.name)];
        cells.extend(row.asymmetry.iter().map(|[_, mm]| signed(*mm, 2)));
        cells
    });
    doc.table(&header, 1, rows.collect());
}

fn disturbances(doc: &mut Doc, paper: &Paper) {
    let rows = paper.offsets.iter().map(|row| {
        let mut cells = vec![short(&row.name)];
        cells.extend(row.noise.iter().map(|[_, mm]| fixed(*mm, 2)));
        cells.extend(row.baseline.iter().map(|[_, mm]| signed(*mm, 2)));
        cells
    });
    let mut header = vec!["test".to_owned()];
    if let Some(row) = paper.offsets.first() {
        header.extend(row.noise.iter().map(|[level, _]| format!("noise {}", compact(*level))));
        header.extend(row.baseline.iter().map(|[level, _]| format!("error {}", compact(*level))));
    }
    let header: Vec<&str> = header.iter().map(String::as_str).collect();
    doc.table(&header, 1, rows.collect());
}

fn steps(doc: &mut Doc, paper: &Paper) {
    let rows = paper.step_drifts.iter().map(|drift| {
        let mut cells = vec![short(&drift.name), fixed(drift.peak_mm, 2)];
        cells.extend(drift.steps.iter().map(|(_, exact, stepwise)| {
            stepwise.map_or("fails".to_owned(), |stepwise| signed(stepwise - exact, 3))
        }));
        cells
    });
    let mut header = vec!["test".to_owned(), "peak".to_owned()];
    if let Some(drift) = paper.step_drifts.first() {
        header.extend(drift.steps.iter().map(|(dt_s, ..)| format!("{} ms", compact(1e3 * dt_s))));
    }
    let header: Vec<&str> = header.iter().map(String::as_str).collect();
    doc.table(&header, 1, rows.collect());
}

fn sensitivities(doc: &mut Doc, paper: &Paper) {
    doc.paragraph(&format!(
        "What small unknowns change: both coefficients of friction 1 % higher, a tilt of 1 mrad, 1 % \
         asymmetry, white noise of {NOISE_M_PER_S2} m/s² on the table record (root mean square of \
         the changes). Under each test's own figures, peak accelerations in m/s² and sliding \
         displacements in mm, stand the changes of the accelerations in % of each, of the \
         displacements in mm.",
    ));
    let labels = ["friction", "tilt", "asymmetry", "noise"];
    let mut rows = Vec::new();
    for row in &paper.sensitivities {
        let has_storey = row.base[1] != 0.0;
        let storey = |text: String| if has_storey { text } else { String::new() };
        let [block, of_storey, peak, residual] = row.base;
        rows.push(vec![
            short(&row.name),
            String::new(),
            fixed(block, 3),
            storey(fixed(of_storey, 3)),
            fixed(peak, 2),
            fixed(residual, 2),
        ]);
        for (i, (label, change)) in labels.iter().zip(&row.changes).enumerate() {
            let text = |value: f64| if i == 3 { fixed(value, 2) } else { signed(value, 2) };
            rows.push(vec![
                String::new(),
                (*label).to_owned(),
                format!("{} %", text(change[0])),
                storey(format!("{} %", text(change[1]))),
                text(change[2]),
                text(change[3]),
            ]);
        }
    }
    doc.table(&["test", "", "block", "storey", "peak sliding", "residual"], 2, rows);
}
