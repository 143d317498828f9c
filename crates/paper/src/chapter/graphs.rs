//! Curves over amplitude, frequency, phase, friction and period.

use crate::{
    DisplacementCurve, FreeSliding, Paper, Ratio, SCANNED_HZ, StartPhase, SuiteRow, Window,
};

use slipstick_report::number::compact;
use slipstick_report::plot::{Axis, Figure, Layout, Limit, Panel, PlotSeries, Shape, Style};

/// Lines that differ by colour, width and dashes.
const LINES: [Style; 5] = [
    Style { colour: "#0b3c6f", width: 1.5, dashes: "" },
    Style { colour: "#d8641c", width: 1.5, dashes: "6 2" },
    Style { colour: "#2f7d4f", width: 1.5, dashes: "2 2" },
    Style { colour: "#7a3b8f", width: 1.5, dashes: "8 2 2 2" },
    Style { colour: "#8c8c8c", width: 1.2, dashes: "" },
];

fn line(label: &str, number: usize, points: Vec<[f64; 2]>) -> PlotSeries {
    let style = LINES[number % LINES.len()];
    PlotSeries { label: label.to_owned(), style, shape: Shape::History, points }
}

fn limit(value: f64) -> Limit {
    Limit { value, label: String::new(), style: Style::LIMIT }
}

pub fn values(series: &[PlotSeries]) -> impl Iterator<Item = f64> {
    series.iter().flat_map(|s| s.points.iter().map(|p| p[1]))
}

pub fn panel(x: Axis, y: Axis, height: f64, series: Vec<PlotSeries>, limits: Vec<Limit>) -> Panel {
    Panel { x, y, height, series, limits, peak: None, note: String::new() }
}

pub fn figure(
    id: &'static str,
    layout: Layout,
    title: impl Into<String>,
    description: impl Into<String>,
    panels: impl IntoIterator<Item = Panel>,
) -> Figure {
    let (title, description) = (title.into(), description.into());
    let panels = panels.into_iter().collect();
    Figure { id: id.to_owned(), title, description, layout, panels, shaded: Vec::new() }
}

/// Storey displacement against amplitude, figures 9d and 10d.
fn displacements(curves: &[DisplacementCurve]) -> Figure {
    let panels = curves.iter().map(|curve| {
        let series = vec![
            line("from 0", 0, curve.points.clone()),
            line("from peak", 1, curve.from_peak.clone()),
        ];
        let y = Axis::from_zero(
            format!("Figure {}d (mm)", curve.figure),
            values(&series).chain([curve.paper_mm]).collect::<Vec<_>>(),
        );
        let x = Axis::logarithmic("Amplitude of the table (m/s²)", 0.1, 5.0);
        panel(x, y, 170.0, series, vec![limit(curve.paper_mm)])
    });
    figure(
        "paper-storey-displacement",
        Layout::Beside,
        "Peak storey displacement against the amplitude of the table",
        "Peaks of 20 s from rest for a sine that starts at phase 0 and for one that \
         starts at its peak, beside the printed value.",
        panels,
    )
}

/// Accelerations over that of the table, figures 9 to 11.
fn free_sliding(tests: &[FreeSliding]) -> Figure {
    let panels = tests.iter().map(|test| {
        let series =
            vec![line("block", 0, test.block.clone()), line("storey", 1, test.storey.clone())];
        let y =
            Axis::from_zero(format!("Figure {}", test.figure), values(&series).collect::<Vec<_>>());
        let x = Axis::logarithmic("Table (m/s²)", 0.1, 5.0);
        panel(x, y, 150.0, series, vec![limit(1.0)])
    });
    figure(
        "paper-no-amplification",
        Layout::Beside,
        "Peak acceleration over that of the table against its amplitude",
        "Block and storey in 20 s from rest, for the mock-ups of figures 9, 10 and 11.",
        panels,
    )
}

/// Amplitudes drawn for a window, in m/s².
const DRAWN: [f64; 3] = [0.1, 1.0, 5.0];

/// Identifiers of the windows, one a mock-up in their order.
const WINDOWS: [&str; 5] =
    ["paper-window-1", "paper-window-2", "paper-window-3", "paper-window-4", "paper-window-5"];

/// The windows of each mock-up, with the first of them.
pub fn windows(paper: &Paper) -> Vec<(&Window, Figure)> {
    let mock_ups = paper.windows.chunk_by(|a, b| a.id == b.id).zip(WINDOWS);
    mock_ups.map(|(of_mock_up, id)| (&of_mock_up[0], window(id, of_mock_up))).collect()
}

/// The figures that stand alone.
pub fn single(paper: &Paper) -> [Figure; 6] {
    [
        displacements(&paper.displacements),
        free_sliding(&paper.free_sliding),
        start_phase(&paper.start_phases),
        suite(paper),
        spectra(paper, false),
        spectra(paper, true),
    ]
}

/// The four ratios of one mock-up over frequency.
fn window(id: &'static str, of_mock_up: &[Window]) -> Figure {
    let first = &of_mock_up[0];
    let ratios: [(&str, Ratio); 4] = [
        ("Storey over table, 20 s from rest", |p| p.rest_over_table),
        ("Storey over table, steady", |p| p.steady_over_table),
        ("Sliding over fixed block, 20 s from rest", |p| p.rest_over_fixed),
        ("Sliding over fixed block, steady", |p| p.steady_over_fixed),
    ];
    let panels = ratios.into_iter().enumerate().map(|(row, (label, ratio))| {
        let mut series: Vec<PlotSeries> = DRAWN
            .iter()
            .enumerate()
            .filter_map(|(i, amplitude)| {
                let window = of_mock_up.iter().find(|w| w.amplitude_m_per_s2 == *amplitude)?;
                let curve = window.curve(ratio, SCANNED_HZ);
                let label =
                    if row == 0 { format!("{} m/s²", compact(*amplitude)) } else { String::new() };
                Some(line(&label, i, curve))
            })
            .collect();
        let largest = values(&series).fold(1.0, f64::max);
        let least = values(&series).filter(|v| *v > 0.0).fold(1.0, f64::min);
        let (low, high) = (least / 1.2, 1.3 * largest);
        for (name, frequency_hz) in [("f2", first.frequency_hz), ("f_ff", first.free_free_hz)] {
            let style = if name == "f2" { Style::DOTTED } else { Style::DASHED };
            let label = if row == 0 { name.to_owned() } else { String::new() };
            let points = vec![[frequency_hz, low], [frequency_hz, high]];
            series.push(PlotSeries { label, style, shape: Shape::Curve, points });
        }
        let [from_hz, to_hz] = SCANNED_HZ;
        let x = Axis::logarithmic("Frequency of the table (Hz)", from_hz, to_hz);
        panel(x, Axis::logarithmic(label, low, high), 112.0, series, vec![limit(1.0)])
    });
    figure(
        id,
        Layout::Stacked,
        format!(
            "Amplification against frequency, {} kg at {} Hz",
            compact(first.mass_kg),
            compact((first.frequency_hz * 1e4).round() / 1e4)
        ),
        "Peak storey acceleration over that of the table and over that of the same \
         storey on a fixed block, from rest and steady, for three amplitudes.",
        panels,
    )
}

/// Mid-line against the phase at which the sine starts.
fn start_phase(phases: &[StartPhase]) -> Figure {
    let points: Vec<[f64; 2]> = phases
        .iter()
        .filter(|p| p.ramp_cycles == 0.0)
        .map(|p| [p.phase_deg, p.midline_mm])
        .collect();
    let series = vec![line("", 0, points)];
    let y = Axis::covering(
        "Mid-line of the last cycle (mm)",
        values(&series).chain([0.0]).collect::<Vec<_>>(),
    );
    let x = Axis::linear("Phase at which the sine starts (degrees)", 0.0, 180.0);
    figure(
        "paper-start-phase",
        Layout::Stacked,
        "Offset against the phase at which the table starts",
        "Mid-line of the sliding displacement in the 15th cycle of 1.5 Hz, 3 m/s², on a \
         level table with equal friction both ways.",
        [panel(x, y, 130.0, series, Vec::new())],
    )
}

/// Rows of the suite, record by record.
pub fn by_record(paper: &Paper) -> Vec<&[SuiteRow]> {
    paper.suite.chunk_by(|a, b| a.record == b.record).collect()
}

/// A record's name without the ending of its file.
pub fn stem(name: &str) -> &str {
    name.rsplit_once('.').map_or(name, |(stem, _)| stem)
}

/// Peak sliding displacement against friction, one line a record; of many records grey lines and
/// their mean.
fn suite(paper: &Paper) -> Figure {
    let records = by_record(paper);
    let many = records.len() > LINES.len();
    let points = |rows: &[SuiteRow]| -> Vec<[f64; 2]> {
        rows.iter().map(|r| [r.friction_over_pga, 1e3 * r.peak_m]).collect()
    };
    let each = records.iter().enumerate();
    let mut series: Vec<PlotSeries> = each
        .map(|(i, rows)| match many {
            true => line("", LINES.len() - 1, points(rows)),
            false => line(stem(&rows[0].record), i, points(rows)),
        })
        .collect();
    if many {
        let count = records.len() as f64;
        let mut mean = points(records[0]);
        for point in &mut mean {
            let same = paper.suite.iter().filter(|row| row.friction_over_pga == point[0]);
            point[1] = same.map(|row| 1e3 * row.peak_m).sum::<f64>() / count;
        }
        series.push(line("mean", 0, mean));
    }
    let [low, high] = [0.1, 1.5 * values(&series).fold(1.0, f64::max)];
    let y = Axis::logarithmic("Peak sliding displacement (mm)", low, high);
    let x = Axis::linear("Friction over PGA in g", 0.0, 1.0);
    figure(
        "paper-suite",
        Layout::Stacked,
        "Peak sliding displacement against friction",
        "Rigid block without a spring, records scaled to one peak.",
        [panel(x, y, 190.0, series, Vec::new())],
    )
}

/// Spectra of sliding structures, of accelerations or of sliding, a panel a mass ratio.
fn spectra(paper: &Paper, sliding: bool) -> Figure {
    let mut ratios: Vec<f64> = paper.spectra.iter().map(|s| s.mass_ratio).collect();
    ratios.dedup();
    let shown = |friction: f64| !(sliding && friction.is_infinite());
    let value = |p: &[f64; 3]| if sliding { 1e3 * p[2] } else { p[1] };
    let all = paper.spectra.iter().filter(|s| shown(s.friction));
    let highest = all.flat_map(|s| s.points.iter().map(value)).fold(0.0, f64::max);
    let panels = ratios.iter().enumerate().map(|(i, ratio)| {
        let of_ratio = paper.spectra.iter().filter(|s| s.mass_ratio == *ratio && shown(s.friction));
        let series = of_ratio
            .enumerate()
            .map(|(n, s)| {
                let label = match (i, s.friction.is_infinite()) {
                    (0, true) => "fixed".to_owned(),
                    (0, false) => format!("μ {:.2}", s.friction),
                    _ => String::new(),
                };
                let points = s.points.iter().map(|p| [p[0], value(p)]).collect();
                line(&label, n, points)
            })
            .collect();
        let quantity = if sliding { "Peak sliding (mm)" } else { "Acceleration over PGA" };
        let label = format!("{quantity}, M2/(M1 + M2) = {}", compact(*ratio));
        let x = Axis::logarithmic("Fixed-base period (s)", 0.05, 4.0);
        panel(x, Axis::from_zero(label, [highest]), 120.0, series, Vec::new())
    });
    let (id, what) = if sliding {
        ("paper-spectrum-sliding", "Peak sliding displacement")
    } else {
        ("paper-spectrum-acceleration", "Peak storey acceleration")
    };
    figure(
        id,
        Layout::Stacked,
        format!("{what} of sliding structures, El Centro 1940"),
        format!("{what} against fixed-base period, 5 % damping, four frictions."),
        panels,
    )
}
