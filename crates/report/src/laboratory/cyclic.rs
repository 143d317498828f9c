//! Cyclic tests: loops of force over displacement with the fitted strokes.

use serde::Serialize;
use slipstick::laboratory::cyclic::{
    AtSpeed, CurvePoint, Cycle, CycleCell, CycleColumn, CyclicEstimates, CyclicFit, PressureFit,
    PressurePoint, RateFit, means,
};

use super::identify::estimate_json;
use crate::assessment::lines::{BAND, band, dots, laid, line, panel, single};
use crate::display::{DisplayUnits, Quantity};
use crate::figures::Drawn;
use crate::json::{Members, each};
use crate::legend::{DISPLACEMENT, FORCE, MEASURED};
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
    /// Force that presses the block on its surface in N, where it is known.
    pub normal_n: Option<f64>,
}

/// What the intervals assume.
#[must_use]
pub fn assumption(found: &CyclicEstimates) -> String {
    let speed = if found.rate.is_some() {
        " Slow and fast friction and the rate are those of the curve μ = fast − (fast − slow) e^(−rate |v|) \
         through all cycles, which count alike; their intervals are profiles of its sum of squares, scaled \
         to the scatter of the cycles. A damper is not fitted beside it."
    } else {
        ""
    };
    let pressure = if found.pressure.as_ref().is_some_and(|law| law.exponent.value().is_some()) {
        " The exponent of the pressure is that of μ(p) = μ (p/reference)^(−exponent) through all cycles, fitted \
         together with the kinetic friction; coefficients are those at the reference pressure, and their intervals \
         include that of the exponent."
    } else {
        ""
    };
    format!(
        "Means over cycles with Student's 95 % interval: cycles are taken as independent, nothing is \
         assumed of the noise within one. The static friction of a test whose samples fall on the same \
         part of every cycle is known to half a step of the force before breakaway, which its interval \
         includes.{speed}{pressure}"
    )
}

/// Other figures of some tests; with the pressure under the weight of the model, where it is known.
#[must_use]
pub fn facts(
    tests: &[Test],
    found: &CyclicEstimates,
    at_rest_pa: Option<f64>,
) -> Vec<(&'static str, String)> {
    let cycles: usize = tests.iter().map(|test| test.fit.cycles.len()).sum();
    let left_out: usize = tests.iter().map(|test| test.fit.strokes_left_out).sum();
    let slack = tests.iter().map(|test| test.fit.slack_m).fold(0.0, f64::max);
    let hz = || tests.iter().flat_map(|test| test.fit.cycles.iter().map(|c| c.frequency_hz));
    let (low, high) = hz().fold((f64::INFINITY, 0.0_f64), |(l, h), f| (l.min(f), h.max(f)));
    let forces_n = || tests.iter().filter_map(|test| test.normal_n);
    let (least, largest) =
        forces_n().fold((f64::INFINITY, 0.0_f64), |(l, h), n| (l.min(n), h.max(n)));
    let normal_force = match forces_n().next() {
        None => "not given: friction is a force".to_owned(),
        Some(_) if least == largest => format!("{} N", significant(largest, 6)),
        Some(_) => {
            let [least, largest] = [least, largest].map(|n| significant(1e-3 * n, 4));
            format!("{least} to {largest} kN")
        }
    };
    let mut facts = vec![
        ("Cycles", format!("{cycles} complete; {left_out} strokes incomplete or short, left out")),
        ("Frequency", format!("{} to {} Hz", significant(low, 3), significant(high, 3))),
        (
            "Travel left out after each reversal",
            format!("{} mm (friction builds up)", significant(1e3 * slack, 3)),
        ),
        ("Normal force", normal_force),
    ];
    let megapascals = |pa: f64| format!("{} MPa", significant(1e-6 * pa, 4));
    if let Some(law) = &found.pressure {
        facts.push(("Pressure of the coefficients", megapascals(law.reference_pa)));
        let tested = law.pressures_pa.iter();
        let [low, high] = tested.fold([f64::INFINITY, 0.0], |[l, h], pa| [pa.min(l), pa.max(h)]);
        facts.extend(at_rest_pa.map(|pa| {
            let outside = if (low..=high).contains(&pa) { "" } else { ", outside of those tested" };
            ("Pressure under the weight of the model", format!("{}{outside}", megapascals(pa)))
        }));
    }
    facts
}

/// A row a test: its estimates; with its normal force and pressure where friction was taken to follow it.
#[must_use]
pub fn by_test(tests: &[Test], pressure: Option<&PressureFit>) -> Vec<Vec<String>> {
    let loads: &[&str] = if pressure.is_some() { &["N (kN)", "p (MPa)"] } else { &[] };
    let friction = ["kinetic", "95 % from", "to", "static", "95 % from", "to"];
    let heads = [&["Test", "f (Hz)", "cycles"], loads, &friction[..]].concat();
    let mut rows = vec![heads.into_iter().map(str::to_owned).collect::<Vec<String>>()];
    for (i, test) in tests.iter().enumerate() {
        let largest_n = test.force_n.iter().fold(0.0, |m: f64, f| m.max(f.abs()));
        let found = means(&[test.fit], largest_n, test.normal_n).estimates;
        let cycles = &test.fit.cycles;
        let hz = cycles.iter().map(|c| c.frequency_hz).sum::<f64>() / cycles.len().max(1) as f64;
        let mut row = vec![test.name.to_owned(), significant(hz, 3), cycles.len().to_string()];
        if let Some(pa) = pressure.and_then(|law| law.pressures_pa.get(i)) {
            let load = [1e-3 * test.normal_n.unwrap_or(f64::NAN), 1e-6 * pa];
            row.extend(load.map(|value| significant(value, 4)));
        }
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

/// A row a cycle; friction over the normal force of its test.
#[must_use]
pub fn table(tests: &[Test]) -> Vec<Vec<String>> {
    let unit = if tests.iter().all(|test| test.normal_n.is_some()) { "" } else { " (N)" };
    // Without the zeros of the sensors the two ways cannot be told apart.
    let by_way = tests.iter().all(|test| test.fit.zero_known && test.fit.drift.is_none());
    let head = |column: &CycleColumn| match column.shown {
        CycleCell::None => None,
        CycleCell::Number { head, .. } => Some(head.to_owned()),
        CycleCell::Friction { head, is_positive: true } if by_way => {
            Some(format!("{head} +x{unit}"))
        }
        CycleCell::Friction { head, is_positive: false } if by_way => {
            Some(format!("{head} −x{unit}"))
        }
        CycleCell::Friction { head, is_positive } => is_positive.then(|| format!("{head}{unit}")),
    };
    let heads = core::iter::once("Cycle".to_owned());
    let mut rows = vec![heads.chain(Cycle::COLUMNS.iter().filter_map(head)).collect::<Vec<_>>()];
    for (number, test) in tests.iter().enumerate() {
        for (index, cycle) in test.fit.cycles.iter().enumerate() {
            let label = if tests.len() > 1 {
                format!("{}.{}", number + 1, index + 1)
            } else {
                (index + 1).to_string()
            };
            let over = test.normal_n.unwrap_or(1.0);
            rows.push(core::iter::once(label).chain(cells(cycle, over, by_way)).collect());
        }
    }
    rows
}

/// The cells of a cycle, its friction over a normal force.
fn cells(cycle: &Cycle, over: f64, by_way: bool) -> Vec<String> {
    let shown = |value: Option<f64>, digits: usize| {
        value.map_or("none".to_owned(), |value| significant(value, digits))
    };
    let cell = move |(i, column): (usize, &CycleColumn)| {
        let value = (column.value)(cycle);
        match column.shown {
            CycleCell::None => None,
            CycleCell::Number { factor, digits, .. } => {
                Some(shown(value.map(|value| factor * value), digits))
            }
            CycleCell::Friction { .. } if by_way => Some(shown(value.map(|f| f / over), 4)),
            CycleCell::Friction { is_positive: false, .. } => None,
            CycleCell::Friction { .. } => {
                let other = Cycle::COLUMNS.get(i + 1).and_then(|other| (other.value)(cycle));
                Some(shown(value.zip(other).map(|(a, b)| 0.5 * (a + b) / over), 4))
            }
        }
    };
    Cycle::COLUMNS.iter().enumerate().filter_map(cell).collect()
}

/// What only this job has in its JSON object; `slider_keys` are those for the model file.
#[must_use]
pub fn json(
    tests: &[Test],
    found: &CyclicEstimates,
    at_rest_pa: Option<f64>,
    slider_keys: Option<String>,
) -> impl Serialize {
    let at_pressure = |point: &PressurePoint| {
        let ([low, high], PressurePoint { pressure_pa, friction, .. }) = (point.interval, *point);
        view! { pressure_pa, kinetic_friction: friction, low, high }
    };
    let pressure = found.pressure.as_ref().map(|law| {
        let loads = tests.iter().zip(&law.pressures_pa);
        let pressure = view! {
            reference_pa: law.reference_pa,
            at_rest_pa,
            tests: each(loads, |(Test { name, normal_n, .. }, pressure_pa)| {
                view! { file: *name, normal_force_n: *normal_n, pressure_pa: *pressure_pa }
            }),
            curve: each(&law.curve, at_pressure),
        };
        view! { pressure }
    });
    let by_speed = |at: &AtSpeed| {
        let [kinetic_positive_n, kinetic_negative_n] = at.kinetic_n;
        view! { speed_m_per_s: at.speed_m_per_s, kinetic_positive_n, kinetic_negative_n }
    };
    let cycle = |cycle: &Cycle| {
        let figure = |column: &CycleColumn| (column.key, (column.value)(cycle));
        view! {
            #[serde(flatten)] figures: Members(each(&Cycle::COLUMNS, figure)),
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
        #[serde(flatten)] pressure,
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

/// Kinetic friction over sliding speed: what every cycle tells, at the reference pressure where there is one, and the
/// fitted curve with its interval.
#[must_use]
pub fn by_speed(
    tests: &[Test],
    rate: &RateFit,
    pressure: Option<&PressureFit>,
    static_friction: Option<f64>,
    display: DisplayUnits,
) -> Drawn {
    let is_coefficient = tests.iter().all(|test| test.normal_n.is_some());
    let over_n = |(i, test): (usize, &Test)| {
        test.normal_n.unwrap_or(1.0) * pressure.map_or(1.0, |law| law.factor(i))
    };
    let of_test = tests.iter().enumerate().flat_map(|(i, test)| {
        let over_n = over_n((i, test));
        let all = test.fit.cycles.iter().flat_map(|cycle| &cycle.by_speed);
        all.map(move |at| [at.speed_m_per_s, 0.5 * (at.kinetic_n[0] + at.kinetic_n[1]) / over_n])
    });
    let measured: Vec<[f64; 2]> = of_test.collect();
    let largest = measured.iter().fold([0.0; 2], |[v, f]: [f64; 2], m| [v.max(m[0]), f.max(m[1])]);
    let speed = display.unit(Quantity::Velocity, largest[0]);
    let force = display.unit(Quantity::Force, largest[1]);
    let (friction, label) = if is_coefficient {
        (display.unit(Quantity::Ratio, 1.0), "Coefficient of friction".to_owned())
    } else {
        (force, force.label("Friction"))
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

/// Kinetic friction over pressure: what every cycle tells, and the fitted law with its interval; none where the exponent
/// was not determined.
#[must_use]
pub fn by_pressure(law: &PressureFit, over_reference: bool) -> Option<Drawn> {
    let (first, last) = (law.curve.first()?, law.curve.last()?);
    let shown = |point: &PressurePoint| [1e-6 * point.pressure_pa, point.friction];
    let x: Vec<f64> = law.curve.iter().map(|point| 1e-6 * point.pressure_pa).collect();
    let [low, high] =
        [0, 1].map(|end| law.curve.iter().map(|p| p.interval[end]).collect::<Vec<f64>>());
    let series = vec![
        band(&x, &low, &high, "95 % interval of the curve", BAND),
        line("fitted", Style::MAIN, law.curve.iter().map(shown).collect()),
        dots(
            "measured, a cycle",
            Style { width: 0.4, ..Style::WIDE },
            Style::WIDE.colour,
            law.cycles.iter().map(shown).collect(),
        ),
    ];
    let values = series.iter().flat_map(|s| s.points.iter().map(|point| point[1]));
    let values: Vec<f64> = values.collect();
    let [from, to] = [first.pressure_pa / 1.2, 1.2 * last.pressure_pa].map(|pa| 1e-6 * pa);
    let label = match over_reference {
        true => "Friction over that at the reference",
        false => "Coefficient of friction",
    };
    let along = Axis::logarithmic("Pressure (MPa)".to_owned(), from, to);
    let panel = panel(along, Axis::covering(label.to_owned(), values), 210.0, series);
    let caption = format!(
        "Kinetic friction over the pressure: what every cycle tells (mean of both ways), and the fitted law with its \
         95 % interval. Coefficients are those at {} MPa.",
        significant(1e-6 * law.reference_pa, 4)
    );
    Some(single("friction-by-pressure", "Kinetic friction over pressure", caption, panel))
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
    let mut series =
        vec![line(MEASURED.label, Style { width: 1.4, ..MEASURED.style }, measured.clone())];
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
        Axis::covering(DISPLACEMENT.alone(x), measured.iter().map(|p| p[0])),
        Axis::covering(FORCE.alone(y), measured.iter().map(|p| p[1])),
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
