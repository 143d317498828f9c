//! What stands in the places of the chapter's placeholders, figures and lists of claims apart.

use crate::fill::{self, Values};
use crate::library::storey_peak;
use crate::suite::SUITE_PEAK_M_PER_S2;
use crate::{Grid, NOISE_M_PER_S2, OffsetRow, Paper, Ratio, SCANNED_HZ, SuiteRow, TESTED_HZ};
use crate::{Verdict, Window};
use slipstick::response::Demands;
use slipstick::units::STANDARD_GRAVITY_M_PER_S2;

use super::graphs;
use super::markdown::{computed_value, fixed, image, paper_value, rows, short, signed, table};
use slipstick_report::number::{compact, printed, rounded, typeset};
use slipstick_report::plot::Figure;

pub fn values(paper: &Paper, histories: &[Figure], windows: &[(&Window, Figure)]) -> Values {
    let quick = (paper.grid == Grid::Quick).then(Vec::new);
    let worst = paper.tests.iter().map(|t| t.certificate).fold(0.0, f64::max);
    let [table, held]: [[Ratio; 2]; 2] = [
        [|p| p.rest_over_table, |p| p.steady_over_table],
        [|p| p.rest_over_fixed, |p| p.steady_over_fixed],
    ];
    let mut all = fill::values([
        ("quick", Vec::from_iter(quick).into()),
        ("verdicts", verdicts(paper).into()),
        ("differing", differing(paper).into()),
        ("models", paper.tests.len().into()),
        ("certified", paper.tests.iter().filter(|t| t.certified).count().into()),
        ("certificate", printed(worst, 2).into()),
        ("tests", tests(paper).into()),
        ("failing", failing(paper).into()),
        ("drawn", drawn(paper, histories).into()),
        ("rods", rods(paper).into()),
        ("over-table-stretches", stretches(paper, table).into()),
        ("over-table-peaks", peaks(paper, table).into()),
        ("over-fixed-stretches", stretches(paper, held).into()),
        ("over-fixed-peaks", peaks(paper, held).into()),
        ("below", below(paper).into()),
        ("windows", drawn_windows(windows).into()),
        ("ramps", ramps(paper).into()),
        ("tilts", tilts(paper).into()),
        ("asymmetries", asymmetries(paper).into()),
        ("tilt_mrad", fixed(1e3 * 0.01 / STANDARD_GRAVITY_M_PER_S2, 2).into()),
        ("disturbances", disturbances(paper).into()),
        ("steps", steps(paper).into()),
        ("noise", NOISE_M_PER_S2.into()),
        ("sensitivities", sensitivities(paper).into()),
        ("frictions", frictions(paper).into()),
        ("lowered", lowered(paper).into()),
        ("overturning", overturning(paper).into()),
        ("iterations", iterations(paper).into()),
        ("peak_g", compact(SUITE_PEAK_M_PER_S2 / STANDARD_GRAVITY_M_PER_S2).into()),
        ("suite-peak", suite(paper, |row| 1e3 * row.peak_m).into()),
        ("suite-residual", suite(paper, |row| 1e3 * row.residual_m).into()),
        ("spectra", spectra(paper).into()),
    ]);
    all.extend(settling(paper));
    all
}

/// First cells, and more behind them.
fn cells(first: impl Into<Vec<String>>, more: impl IntoIterator<Item = String>) -> Vec<String> {
    let mut cells = first.into();
    cells.extend(more);
    cells
}

fn verdicts(paper: &Paper) -> String {
    let first = |section: &str| section.split(',').next().unwrap_or_default().to_owned();
    let mut sections: Vec<String> = paper.claims.iter().map(|c| first(&c.section)).collect();
    sections.dedup();
    let all = [Verdict::Agrees, Verdict::Differs, Verdict::CannotBeChecked];
    let here = sections.into_iter().map(|section| {
        let claims = || paper.claims.iter().filter(|c| first(&c.section) == section);
        let [a, d, u] = all.map(|v| claims().filter(|c| c.verdict == v).count().to_string());
        [section.clone(), a, d, u]
    });
    let [a, d, u] = all.map(|verdict| format!("**{}**", paper.count(verdict)));
    rows(here.chain([["**all**".to_owned(), a, d, u]]))
}

fn differing(paper: &Paper) -> String {
    let differing = paper.claims.iter().filter(|claim| claim.verdict == Verdict::Differs);
    rows(differing.map(|claim| {
        [claim.section.clone(), claim.claim.clone(), paper_value(claim), computed_value(claim)]
    }))
}

fn tests(paper: &Paper) -> String {
    rows(paper.tests.iter().map(|test| {
        let exact = &test.exact;
        let other = test.stepwise.as_ref().ok().map(|(demands, _)| demands);
        let pair = |of: &dyn Fn(&Demands) -> f64, decimals: usize| {
            let base = of(exact);
            let added = other.map_or("–".to_owned(), |d| signed(of(d) - base, decimals));
            format!("{} {added}", fixed(base, decimals))
        };
        let storey = exact.storeys.first().map_or_else(String::new, |_| pair(&storey_peak, 3));
        let iterations = match &test.stepwise {
            Ok((_, iterations)) => format!("{}, {}", fixed(iterations.mean, 2), iterations.max),
            Err(_) => "fails".to_owned(),
        };
        [
            short(&test.name),
            compact((test.pga_m_per_s2 * 1e3).round() / 1e3),
            pair(&|d| d.peak_block_acceleration_m_per_s2, 3),
            storey,
            pair(&|d| 1e3 * d.peak_sliding_displacement_m, 2),
            pair(&|d| 1e3 * d.residual_sliding_displacement_m, 2),
            iterations,
        ]
    }))
}

/// Tests on which the stepwise program fails.
fn failing(paper: &Paper) -> Vec<Values> {
    let failing = paper.tests.iter().filter_map(|test| Some((test, test.stepwise.as_ref().err()?)));
    let named = failing.map(|(test, reason)| {
        fill::values([("name", test.name[..].into()), ("reason", reason[..].into())])
    });
    named.collect()
}

fn drawn(paper: &Paper, histories: &[Figure]) -> Vec<Values> {
    let each = paper.drawn.iter().zip(histories).map(|(test, figure)| {
        let residual = |d: &Demands| signed(-1e3 * d.residual_sliding_displacement_m, 2);
        let stepwise = test.stepwise.as_ref().map(|r| format!("{} mm", residual(&r.demands)));
        let table = test.exact.history.as_ref().map_or(0.0, |history| {
            history.table_acceleration_m_per_s2.iter().fold(0.0, |peak: f64, a| peak.max(a.abs()))
        });
        fill::values([
            ("drawing", image(figure).into()),
            ("figure", f64::from(test.figure).into()),
            ("name", test.name[..].into()),
            ("table", fixed(table, 2).into()),
            ("exact", residual(&test.exact.demands).into()),
            ("stepwise", stepwise.unwrap_or("fails".to_owned()).into()),
        ])
    });
    each.collect()
}

/// A row a rod, a column a mass.
fn rods(paper: &Paper) -> String {
    rows(paper.cantilevers.chunks(3).map(|of_rod| {
        let rod = of_rod[0];
        let [a, b, c] = [0, 1, 2].map(|i| fixed(of_rod[i].frequency_hz, 3));
        [format!("{} mm, {} m", fixed(1e3 * rod.diameter_m, 0), fixed(rod.length_m, 2)), a, b, c]
    }))
}

/// How many of the motions became steady.
fn settling(paper: &Paper) -> Values {
    let motions: usize = paper.windows.iter().map(|w| w.points.len()).sum();
    let unsettled: Vec<(f64, f64)> = paper
        .windows
        .iter()
        .flat_map(|w| w.unsettled().map(|p| (w.amplitude_m_per_s2, p.frequency_hz)))
        .collect();
    let subharmonic: usize = paper.windows.iter().map(Window::subharmonic).sum();
    let drifting = paper.windows.iter().flat_map(|w| &w.points);
    let drifting = drifting.filter(|p| p.period.is_some() && p.drift_m.abs() > 1e-9).count();
    let ends = |of: fn(&(f64, f64)) -> f64| {
        let [low, high] = crate::curves::range(unsettled.iter().map(of));
        let round3 = |value: f64| compact((value * 1e3).round() / 1e3);
        format!("{} to {}", round3(low), round3(high)).into()
    };
    let ends = (!unsettled.is_empty())
        .then(|| fill::values([("tables", ends(|u| u.0)), ("frequencies", ends(|u| u.1))]));
    fill::values([
        ("motions", motions.into()),
        ("settled", (motions - unsettled.len() - subharmonic).into()),
        ("subharmonic", subharmonic.into()),
        ("unsettled", unsettled.len().into()),
        ("drifting", drifting.into()),
        ("ends", Vec::from_iter(ends).into()),
    ])
}

fn drawn_windows(windows: &[(&Window, Figure)]) -> Vec<Values> {
    let drawn = windows.iter().map(|(window, figure)| {
        fill::values([
            ("drawing", image(figure).into()),
            ("kg", compact(window.mass_kg).into()),
            ("hz", frequency(window.frequency_hz).into()),
        ])
    });
    drawn.collect()
}

fn frequency(hz: f64) -> String {
    compact((hz * 1e6).round() / 1e6)
}

/// The oscillator and the table.
fn name(window: &Window) -> [String; 2] {
    let (kg, hz) = (compact(window.mass_kg), frequency(window.frequency_hz));
    [format!("{kg} kg, {hz} Hz"), compact(window.amplitude_m_per_s2)]
}

/// Where a ratio exceeds one; many stretches by their number and ends.
fn above(window: &Window, ratio: Ratio, band_hz: [f64; 2]) -> String {
    let stretches = window.above_one(ratio, band_hz);
    match (stretches.first(), stretches.last()) {
        (Some(first), Some(last)) if stretches.len() > 2 => {
            let (from, to) = (fixed(first[0], 2), fixed(last[1], 2));
            format!("{} stretches, {from} to {to}", stretches.len())
        }
        _ => window.above_one_text(ratio, band_hz),
    }
}

/// Where ratios exceed one, as tested and as scanned, from rest and steady.
fn stretches(paper: &Paper, [rest, steady]: [Ratio; 2]) -> String {
    let columns = [TESTED_HZ, SCANNED_HZ].map(|hz| [(hz, "rest", rest), (hz, "steady", steady)]);
    let columns = columns.concat();
    let heads = columns
        .iter()
        .map(|([from, to], what, _)| format!("{}–{} Hz, {what}", compact(*from), compact(*to)));
    let header = cells(["oscillator".to_owned(), "table, m/s²".to_owned()], heads);
    table(
        &header,
        paper.windows.iter().map(|window| {
            let stretches = columns.iter().map(|(hz, _, ratio)| above(window, *ratio, *hz));
            cells(name(window), stretches)
        }),
    )
}

/// The largest ratios about the storey's own resonance, and where.
fn peaks(paper: &Paper, pair: [Ratio; 2]) -> String {
    rows(paper.windows.iter().map(|window| {
        let [rest, steady] = pair.map(|ratio| {
            let [hz, value] = window.peak(ratio, window.near_hz());
            let over = |frequency_hz: f64| fixed(hz / frequency_hz, 3);
            [fixed(value, 2), over(window.frequency_hz), over(window.free_free_hz)]
        });
        let ([name, table], [a, b, c], [d, e, f]) = (name(window), rest, steady);
        [name, table, a, b, c, d, e, f]
    }))
}

fn below(paper: &Paper) -> String {
    rows(paper.windows.iter().map(|window| {
        let [hz, value] = window.peak(|p| p.steady_over_fixed, window.below_hz());
        let [name, table] = name(window);
        [name, table, fixed(value, 2), fixed(hz, 3), fixed(window.free_free_hz / hz, 2)]
    }))
}

fn ramps(paper: &Paper) -> String {
    rows(
        paper
            .start_phases
            .iter()
            .filter(|p| p.phase_deg == 0.0)
            .map(|p| [compact(p.ramp_cycles), fixed(p.midline_mm, 2), fixed(p.half_range_mm, 2)]),
    )
}

/// The levels of a column of the offsets, as heads.
fn levels(paper: &Paper, of: fn(&OffsetRow) -> &[[f64; 2]], head: &str) -> Vec<String> {
    let first = paper.offsets.first().map_or(&[][..], of);
    first.iter().map(|[level, _]| head.replace('#', &compact(*level))).collect()
}

fn tilts(paper: &Paper) -> String {
    let mut header = cells(
        ["test", "peak", "level"].map(str::to_owned),
        levels(paper, |row| &row.tilt, "# mrad"),
    );
    header.push("a cycle".to_owned());
    table(
        &header,
        paper.offsets.iter().map(|row| {
            let first = [short(&row.name), fixed(row.peak_mm, 2), fixed(row.residual_mm, 2)];
            let growth = row.growth_mm_per_cycle.map_or("–".to_owned(), |mm| signed(mm, 3));
            cells(first, row.tilt.iter().map(|[_, mm]| signed(*mm, 2)).chain([growth]))
        }),
    )
}

fn asymmetries(paper: &Paper) -> String {
    let header = cells(["test".to_owned()], levels(paper, |row| &row.asymmetry, "# %"));
    table(
        &header,
        paper.offsets.iter().map(|row| {
            cells([short(&row.name)], row.asymmetry.iter().map(|[_, mm]| signed(*mm, 2)))
        }),
    )
}

fn disturbances(paper: &Paper) -> String {
    let errors = levels(paper, |row| &row.baseline, "error #");
    let noise = levels(paper, |row| &row.noise, "noise #");
    let header = cells(["test".to_owned()], noise.into_iter().chain(errors));
    table(
        &header,
        paper.offsets.iter().map(|row| {
            let noise = row.noise.iter().map(|[_, mm]| fixed(*mm, 2));
            let errors = row.baseline.iter().map(|[_, mm]| signed(*mm, 2));
            cells([short(&row.name)], noise.chain(errors))
        }),
    )
}

fn steps(paper: &Paper) -> String {
    let steps = paper.step_drifts.first().map_or(&[][..], |drift| &drift.steps);
    let steps = steps.iter().map(|(dt_s, ..)| format!("{} ms", compact(1e3 * dt_s)));
    let header = cells(["test", "peak"].map(str::to_owned), steps);
    table(
        &header,
        paper.step_drifts.iter().map(|drift| {
            let steps = drift.steps.iter().map(|(_, exact, stepwise)| {
                stepwise.map_or("fails".to_owned(), |stepwise| signed(stepwise - exact, 3))
            });
            cells([short(&drift.name), fixed(drift.peak_mm, 2)], steps)
        }),
    )
}

fn sensitivities(paper: &Paper) -> String {
    let mut all = Vec::new();
    for row in &paper.sensitivities {
        let has_storey = row.base[1] != 0.0;
        let storey = |text: String| if has_storey { text } else { String::new() };
        let [block, of_storey, peak, residual] = row.base;
        all.push([
            short(&row.name),
            String::new(),
            fixed(block, 3),
            storey(fixed(of_storey, 3)),
            fixed(peak, 2),
            fixed(residual, 2),
        ]);
        for (label, change) in ["friction", "tilt", "asymmetry", "noise"].iter().zip(&row.changes) {
            let text = |value: f64| match *label {
                "noise" => fixed(value, 2),
                _ => signed(value, 2),
            };
            all.push([
                String::new(),
                (*label).to_owned(),
                format!("{} %", text(change[0])),
                storey(format!("{} %", text(change[1]))),
                text(change[2]),
                text(change[3]),
            ]);
        }
    }
    rows(all)
}

fn frictions(paper: &Paper) -> String {
    rows(paper.friction_pairs.iter().flat_map(|pair| {
        let [mu_s, mu_k] = pair.measured.map(compact);
        let labels = [format!("{mu_k} both"), format!("{mu_s}, {mu_k}"), format!("{mu_s} both")];
        labels.into_iter().enumerate().map(|(i, label)| {
            let name = if i == 0 { short(&pair.name) } else { String::new() };
            let [block, storey, peak, residual] = pair.figures[i];
            let [slips, reversals, sticks] = pair.counts[i];
            let storey = if storey == 0.0 { String::new() } else { fixed(storey, 3) };
            let counts = format!("{slips}, {reversals}, {sticks}");
            [name, label, fixed(block, 3), storey, fixed(peak, 2), fixed(residual, 2), counts]
        })
    }))
}

fn lowered(paper: &Paper) -> String {
    rows(paper.lighter.iter().map(|l| {
        let [mu_s, mu_k] = l.factors.map(|factor| rounded(factor, 3));
        let [acceleration, displacement, sliding] = l.changes_percent.map(|c| signed(c, 2));
        let (name, residual) = (short(&l.name), signed(l.residual_mm, 2));
        [name, format!("{mu_s}, {mu_k}"), acceleration, displacement, sliding, residual]
    }))
}

fn overturning(paper: &Paper) -> String {
    let levels = paper.overturning.first().map_or(&[][..], |first| &first.ratios);
    let mut header = cells(["test".to_owned()], levels.iter().map(|[level, _]| compact(*level)));
    header.push("lifts at".to_owned());
    table(
        &header,
        paper.overturning.iter().map(|o| {
            let lifts = o.lifts_at_m_per_s2.map_or("never".to_owned(), |level| fixed(level, 2));
            cells(
                [short(&o.name)],
                o.ratios.iter().map(|[_, ratio]| fixed(*ratio, 3)).chain([lifts]),
            )
        }),
    )
}

fn iterations(paper: &Paper) -> String {
    rows(paper.iterations.iter().map(|cell| {
        [
            compact(1e3 * cell.dt_s),
            typeset(&format!("{:.0e}", cell.tolerance_m_per_s2)).replace("1\u{202f}×\u{202f}", ""),
            fixed(cell.mean, 2),
            cell.max.to_string(),
            format!("{} of {}", cell.failures, cell.runs),
            format!("{}, {}", fixed(cell.held_mean, 2), cell.held_max),
            cell.held_failures.to_string(),
        ]
    }))
}

/// A row a record, a column a friction; mean and standard deviation below.
fn suite(paper: &Paper, value: fn(&SuiteRow) -> f64) -> String {
    let rows = graphs::by_record(paper);
    let frictions = rows.first().map_or(&[][..], |first| first).iter();
    let header = cells(["record".to_owned()], frictions.map(|row| compact(row.friction_over_pga)));
    let records: Vec<Vec<f64>> = rows.iter().map(|rows| rows.iter().map(value).collect()).collect();
    let count = records.len() as f64;
    let mean = |i: usize| records.iter().map(|record| record[i]).sum::<f64>() / count;
    let deviation = |i: usize| {
        let squares = records.iter().map(|record| (record[i] - mean(i)) * (record[i] - mean(i)));
        (squares.sum::<f64>() / (count - 1.0)).sqrt()
    };
    let named = rows.iter().map(|rows| graphs::stem(&rows[0].record).to_owned());
    let row = |label: String, of: &dyn Fn(usize) -> f64| {
        cells([label], (0..header.len() - 1).map(|i| fixed(of(i), 2)))
    };
    let of_records = named.zip(&records).map(|(name, record)| row(name, &|i| record[i]));
    let below =
        [row("**mean**".to_owned(), &mean), row("**standard deviation**".to_owned(), &deviation)];
    table(&header, of_records.chain(below))
}

fn spectra(paper: &Paper) -> String {
    rows(paper.spectra.iter().map(|spectrum| {
        let highest = spectrum.points.iter().map(|p| p[1]).fold(0.0, f64::max);
        let sliding = spectrum.points.iter().map(|p| 1e3 * p[2]).fold(0.0, f64::max);
        let [friction, sliding] = match spectrum.friction.is_finite() {
            true => [fixed(spectrum.friction, 2), fixed(sliding, 1)],
            false => ["fixed", "–"].map(str::to_owned),
        };
        [compact(spectrum.mass_ratio), friction, fixed(highest, 3), sliding]
    }))
}
