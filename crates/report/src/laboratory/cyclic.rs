//! Cyclic tests: loops of force over displacement with the fitted strokes.

use serde::Serialize;
use slipstick::laboratory::cyclic::{
    AtSpeed, CurvePoint, Cycle, CyclicEstimates, CyclicFit, RateFit, means,
};

use super::identify::estimate_json;
use crate::assessment::lines::{BAND, band, dots, laid, line, panel, single};
use crate::display::{DisplayUnits, Quantity};
use crate::figures::Drawn;
use crate::json::each;
use crate::number::significant;
use crate::plot::{Axis, Layout, Limit, Panel, PlotSeries, Style};
use crate::view;

/// One test.
#[derive(Clone, Copy, Debug)]
pub struct Test<'a> {
    /// Its file.
    pub name: &'a str,
    /// Displacement in m.
    pub displacement_m: &'a [f64],
    /// Force in N.
    pub force_n: &'a [f64],
    /// What it says.
    pub fit: &'a CyclicFit,
}

/// What the intervals assume.
#[must_use]
pub fn assumption(by_speed: bool) -> String {
    let speed = if by_speed {
        " Slow and fast friction and the rate are those of the curve μ = fast − (fast − slow) e^(−rate |v|) \
         through all cycles, which count alike; their intervals are profiles of its sum of squares, scaled \
         to the scatter of the cycles. A damper is not fitted beside it."
    } else {
        ""
    };
    format!(
        "Means over cycles with Student's 95 % interval: cycles are taken as independent, nothing is \
         assumed of the noise within one. The static friction of a test whose samples fall on the same \
         part of every cycle is known to half a step of the force before breakaway, which its interval \
         includes.{speed}"
    )
}

/// Other figures of some tests.
#[must_use]
pub fn facts(tests: &[Test], normal_force_n: Option<f64>) -> Vec<(&'static str, String)> {
    let cycles: usize = tests.iter().map(|test| test.fit.cycles.len()).sum();
    let left_out: usize = tests.iter().map(|test| test.fit.strokes_left_out).sum();
    let slack = tests.iter().map(|test| test.fit.slack_m).fold(0.0, f64::max);
    let hz = || tests.iter().flat_map(|test| test.fit.cycles.iter().map(|c| c.frequency_hz));
    let (low, high) = hz().fold((f64::INFINITY, 0.0_f64), |(l, h), f| (l.min(f), h.max(f)));
    vec![
        ("Cycles", format!("{cycles} complete; {left_out} strokes incomplete or short, left out")),
        ("Frequency", format!("{} to {} Hz", significant(low, 3), significant(high, 3))),
        (
            "Travel left out after each reversal",
            format!("{} mm (friction builds up)", significant(1e3 * slack, 3)),
        ),
        (
            "Normal force",
            normal_force_n.map_or("not given: friction is a force".to_owned(), |n| {
                format!("{} N", significant(n, 6))
            }),
        ),
    ]
}

/// A row a test: its estimates, without their intervals.
#[must_use]
pub fn by_test(tests: &[Test], normal_force_n: Option<f64>) -> Vec<Vec<String>> {
    let mut rows = vec![
        ["Test", "f (Hz)", "cycles", "kinetic", "95 % from", "to", "static", "95 % from", "to"]
            .map(str::to_owned)
            .to_vec(),
    ];
    for test in tests {
        let largest_n = test.force_n.iter().fold(0.0, |m: f64, f| m.max(f.abs()));
        let found = means(&[test.fit], largest_n, normal_force_n).estimates;
        let cycles = &test.fit.cycles;
        let hz = cycles.iter().map(|c| c.frequency_hz).sum::<f64>() / cycles.len().max(1) as f64;
        let mut row = vec![test.name.to_owned(), significant(hz, 3), cycles.len().to_string()];
        // Both ways together stand before each way.
        for what in ["slider.kinetic_friction", "slider.static_friction"] {
            let both = found.iter().find(|estimate| estimate.path.starts_with(what));
            row.extend(match both.and_then(|e| e.value().zip(e.interval())) {
                Some((value, [low, high])) => [value, low, high].map(|v| significant(v, 4)),
                None => ["not determined", "", ""].map(str::to_owned),
            });
        }
        rows.push(row);
    }
    rows
}

/// A row a cycle.
#[must_use]
pub fn table(tests: &[Test], normal_force_n: Option<f64>) -> Vec<Vec<String>> {
    let over = normal_force_n.unwrap_or(1.0);
    let unit = if normal_force_n.is_some() { "" } else { " (N)" };
    // Without the zeros of the sensors the two ways cannot be told apart.
    let by_way = tests.iter().all(|test| test.fit.zero_known && test.fit.drift.is_none());
    let ways: &[&str] = if by_way { &[" +x", " −x"] } else { &[""] };
    let mut heads = ["Cycle", "f (Hz)", "stroke (mm)"].map(str::to_owned).to_vec();
    for what in ["kinetic", "static"] {
        heads.extend(ways.iter().map(|way| format!("{what}{way}{unit}")));
    }
    heads.extend(["spring (N/m)", "damper (N s/m)", "rms left (N)"].map(str::to_owned));
    let mut rows = vec![heads];
    for (number, test) in tests.iter().enumerate() {
        for (index, cycle) in test.fit.cycles.iter().enumerate() {
            let label = if tests.len() > 1 {
                format!("{}.{}", number + 1, index + 1)
            } else {
                (index + 1).to_string()
            };
            rows.push(row(label, cycle, over, by_way));
        }
    }
    rows
}

fn row(label: String, cycle: &Cycle, over: f64, by_way: bool) -> Vec<String> {
    let digits = |value: f64| significant(value, 4);
    let maybe = |value: Option<f64>| value.map_or("none".to_owned(), digits);
    let mut row = vec![label, digits(cycle.frequency_hz), digits(1e3 * cycle.stroke_m)];
    for ways in [cycle.kinetic_n.map(Some), cycle.static_n] {
        if by_way {
            row.extend(ways.map(|way| maybe(way.map(|f| f / over))));
        } else {
            let both = ways[0].zip(ways[1]).map(|(a, b)| 0.5 * (a + b) / over);
            row.push(maybe(both));
        }
    }
    row.extend([cycle.spring_n_per_m, cycle.damper_n_s_per_m].map(maybe));
    row.push(significant(cycle.residual_n, 3));
    row
}

/// What only this job has in its JSON object; `slider_keys` are those for the model file.
#[must_use]
pub fn json(
    tests: &[Test],
    found: &CyclicEstimates,
    slider_keys: Option<String>,
) -> impl Serialize {
    let by_speed = |at: &AtSpeed| {
        let [kinetic_positive_n, kinetic_negative_n] = at.kinetic_n;
        view! { speed_m_per_s: at.speed_m_per_s, kinetic_positive_n, kinetic_negative_n }
    };
    let cycle = |cycle: &Cycle| {
        let [from_s, to_s] = cycle.span_s;
        let [kinetic_positive_n, kinetic_negative_n] = cycle.kinetic_n;
        let [static_positive_n, static_negative_n] = cycle.static_n;
        view! {
            from_s,
            to_s,
            frequency_hz: cycle.frequency_hz,
            stroke_m: cycle.stroke_m,
            peak_velocity_m_per_s: cycle.peak_velocity_m_per_s,
            kinetic_positive_n,
            kinetic_negative_n,
            static_positive_n,
            static_negative_n,
            spring_n_per_m: cycle.spring_n_per_m,
            damper_n_s_per_m: cycle.damper_n_s_per_m,
            residual_n: cycle.residual_n,
            by_speed: each(&cycle.by_speed, by_speed),
        }
    };
    let point = |point: &CurvePoint| {
        let [low, high] = point.interval;
        let CurvePoint { speed_m_per_s, friction, .. } = *point;
        view! { speed_m_per_s, kinetic_friction: friction, low, high }
    };
    view! {
        law: tests.first().map(|test| test.fit.law.name()),
        friction_curve: found.rate.as_ref().map(|rate| each(&rate.curve, point)),
        frequency_dependence: found.per_hz.as_ref().map(estimate_json),
        tests: each(tests, |Test { name, fit, .. }| {
            view! {
                file: *name,
                slack_m: fit.slack_m,
                strokes_left_out: fit.strokes_left_out,
                cycles: each(&fit.cycles, cycle),
            }
        }),
        slider_keys,
    }
}

/// Kinetic friction over sliding speed: what every cycle tells, and the fitted curve with its interval.
#[must_use]
pub fn by_speed(
    tests: &[Test],
    rate: &RateFit,
    static_friction: Option<f64>,
    normal_force_n: Option<f64>,
    display: DisplayUnits,
) -> Drawn {
    let over_n = normal_force_n.unwrap_or(1.0);
    let cycles = || tests.iter().flat_map(|test| &test.fit.cycles);
    let measured: Vec<[f64; 2]> = cycles()
        .flat_map(|cycle| &cycle.by_speed)
        .map(|at| [at.speed_m_per_s, 0.5 * (at.kinetic_n[0] + at.kinetic_n[1]) / over_n])
        .collect();
    let largest = measured.iter().fold([0.0; 2], |[v, f]: [f64; 2], m| [v.max(m[0]), f.max(m[1])]);
    let speed = display.unit(Quantity::Velocity, largest[0]);
    let force = display.unit(Quantity::Force, largest[1]);
    let (friction, label) = match normal_force_n {
        Some(_) => (display.unit(Quantity::Ratio, 1.0), "Coefficient of friction".to_owned()),
        None => (force, force.label("Friction")),
    };
    let shown = |[v, f]: [f64; 2]| [speed.of(v), friction.of(f)];
    let curve = &rate.curve;
    let x: Vec<f64> = curve.iter().map(|point| speed.of(point.speed_m_per_s)).collect();
    let [low, high] =
        [0, 1].map(|end| curve.iter().map(|p| friction.of(p.interval[end])).collect::<Vec<f64>>());
    let fitted = curve.iter().map(|point| shown([point.speed_m_per_s, point.friction])).collect();
    let mut series = vec![
        band(&x, &low, &high, "95 % interval of the curve", BAND),
        line("fitted", Style::MAIN, fitted),
        dots(
            "measured, a cycle or a class of its speeds",
            Style { width: 0.4, ..Style::WIDE },
            Style::WIDE.colour,
            measured.iter().copied().map(shown).collect(),
        ),
    ];
    series.retain(|series| !series.points.is_empty());
    let limits: Vec<Limit> = static_friction
        .map(|value| Limit {
            value: friction.of(value),
            label: "static friction".to_owned(),
            style: Style::LIMIT,
        })
        .into_iter()
        .collect();
    let slowest = measured.iter().fold(f64::INFINITY, |least, m| least.min(m[0]));
    let values = series.iter().flat_map(|s| s.points.iter().map(|point| point[1]));
    let values: Vec<f64> = values.chain(limits.iter().map(|limit| limit.value)).collect();
    let [from, to] = [slowest / 1.2, 1.2 * largest[0]].map(|m_per_s| speed.of(m_per_s));
    let along = Axis::logarithmic(speed.label("Sliding speed"), from, to);
    let panel = Panel { limits, ..panel(along, Axis::covering(label, values), 210.0, series) };
    let caption =
        "Kinetic friction over the sliding speed: what every cycle tells (mean of both ways), \
                   and the fitted curve with its 95 % interval."
            .to_owned();
    single("friction-by-speed", "Kinetic friction over sliding speed", caption, panel)
}

/// One figure a test: measured loops with the fitted strokes, and friction by cycle.
#[must_use]
pub fn figures(tests: &[Test], display: DisplayUnits) -> Vec<Drawn> {
    let of = |(i, test): (usize, &Test)| figure(test, &format!("loop-{}", i + 1), display);
    tests.iter().enumerate().map(of).collect()
}

fn figure(test: &Test, id: &str, display: DisplayUnits) -> Drawn {
    let largest = |values: &[f64]| values.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    let x = display.unit(Quantity::Length, largest(test.displacement_m));
    let y = display.unit(Quantity::Force, largest(test.force_n));
    let point = |i: usize, force: f64| [x.of(test.displacement_m[i]), y.of(force)];
    let measured: Vec<[f64; 2]> =
        test.force_n.iter().enumerate().map(|(i, force)| point(i, *force)).collect();
    let mut series = vec![line("measured", Style { width: 1.4, ..Style::WIDE }, measured.clone())];
    let mut stroke: Vec<[f64; 2]> = Vec::new();
    let mut strokes = 0;
    let mut close = |stroke: &mut Vec<[f64; 2]>| {
        if stroke.len() > 1 {
            let label = if strokes == 0 { "fitted while sliding" } else { "" }.to_owned();
            let points = core::mem::take(stroke);
            series.push(line(label, Style::MAIN, points));
            strokes += 1;
        }
        stroke.clear();
    };
    for (i, force) in test.fit.fitted_n.iter().enumerate() {
        if force.is_finite() {
            stroke.push(point(i, *force));
        } else {
            close(&mut stroke);
        }
    }
    close(&mut stroke);
    let loops = panel(
        Axis::covering(x.label("Displacement"), measured.iter().map(|p| p[0])),
        Axis::covering(y.label("Force"), measured.iter().map(|p| p[1])),
        230.0,
        series,
    );
    let by_cycle = |label: &str, style, value: &dyn Fn(&Cycle) -> Option<f64>| {
        line(
            label,
            style,
            test.fit
                .cycles
                .iter()
                .enumerate()
                .filter_map(|(i, cycle)| Some([i as f64 + 1.0, y.of(value(cycle)?)]))
                .collect(),
        )
    };
    let series = vec![
        by_cycle("kinetic +x", Style::MAIN, &|c| Some(c.kinetic_n[0])),
        by_cycle("kinetic −x", Style::DASHED, &|c| Some(c.kinetic_n[1])),
        by_cycle("static +x", Style { dashes: "", ..Style::WIDE }, &|c| c.static_n[0]),
        by_cycle("static −x", Style { dashes: "5 3", ..Style::WIDE }, &|c| c.static_n[1]),
    ];
    let series: Vec<PlotSeries> = series.into_iter().filter(|s| !s.points.is_empty()).collect();
    let values: Vec<f64> = series.iter().flat_map(|s| s.points.iter().map(|p| p[1])).collect();
    let cycles = panel(
        Axis::linear("Cycle", 0.5, test.fit.cycles.len() as f64 + 0.5),
        Axis::from_zero(y.label("Friction"), values),
        230.0,
        series,
    );
    let caption = format!(
        "{}: force over displacement, measured and fitted where the block slides, and friction cycle \
         by cycle.",
        test.name
    );
    laid(
        Layout::Beside,
        (id, &format!("Force over displacement, {}", test.name)),
        caption,
        vec![loops, cycles],
    )
}
