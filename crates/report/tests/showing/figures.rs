//! The drawings: the drawn peak is the tabled peak, labels stay inside, nothing grows without bound.

use crate::support::{Case, floor_spectra, frame_model, report, rough_motion, run};
use slipstick::assessment::floors::FloorSpectra;
use slipstick::assessment::outline::{COLUMNS, SlidingOutline};
use slipstick::model::{InitialState, Model, Slider, Stop};
use slipstick::motion::GroundMotion;
use slipstick_report::DisplayUnits;
use slipstick_report::figures::{self, Drawn};
use slipstick_report::plot::{
    Axis, Figure, Layout, NARROW, Panel, PlotSeries, Shape, Style, WIDTH,
};

/// One text element: place, size, anchor, content.
struct Text {
    x: f64,
    y: f64,
    size: f64,
    anchor: String,
    content: String,
}

fn attribute(tag: &str, name: &str) -> Option<String> {
    let start = tag.find(&format!(" {name}=\""))? + name.len() + 3;
    Some(tag[start..start + tag[start..].find('"')?].to_owned())
}

fn number(tag: &str, name: &str) -> Option<f64> {
    attribute(tag, name)?.parse().ok()
}

fn texts(svg: &str) -> Vec<Text> {
    svg.split("<text")
        .skip(1)
        .map(|piece| {
            let (tag, rest) = piece.split_once('>').expect("a tag");
            Text {
                x: number(tag, "x").expect("x"),
                y: number(tag, "y").expect("y"),
                size: number(tag, "font-size").unwrap_or(11.0),
                anchor: attribute(tag, "text-anchor").unwrap_or("start".into()),
                content: rest.split('<').next().expect("a text").to_owned(),
            }
        })
        .collect()
}

/// The paths drawn with a full line in the colour of main lines, as points.
fn main_lines(svg: &str) -> Vec<Vec<[f64; 2]>> {
    svg.split("<path")
        .filter(|tag| tag.contains("stroke=\"#0b3c6f\""))
        .filter_map(|tag| attribute(tag, "d"))
        // Samples in legends are drawn by a relative command.
        .filter(|path| !path.contains('h'))
        .map(|path| points(&path))
        .collect()
}

fn points(path: &str) -> Vec<[f64; 2]> {
    let numbers: Vec<f64> = path
        .split([' ', 'M', 'L'])
        .filter(|text| !text.is_empty())
        .map(|text| text.parse().expect("a coordinate"))
        .collect();
    numbers.chunks(2).map(|pair| [pair[0], pair[1]]).collect()
}

/// Value of a height in a panel, read off its ticks as a person would with a ruler.
///
/// `panel` counts frames from the top; its ticks are the texts that end at the frame's left.
fn read_off(svg: &str, panel: usize, y: f64) -> f64 {
    let frames: Vec<[f64; 3]> = svg
        .split("<rect fill=\"none\"")
        .skip(1)
        .map(|tag| ["x", "y", "height"].map(|name| number(tag, name).expect(name)))
        .collect();
    let [left, top, height] = frames[panel];
    let ticks: Vec<[f64; 2]> = texts(svg)
        .into_iter()
        .filter(|text| text.anchor == "end" && (text.x - (left - 4.0)).abs() < 0.11)
        .map(|text| (text.y - 3.5, text.content))
        .filter(|(tick_y, _)| (top - 0.1..=top + height + 0.1).contains(tick_y))
        .map(|(tick_y, content)| [tick_y, content.replace('−', "-").parse().expect("a number")])
        .collect();
    let (a, b) = (ticks[0], ticks[ticks.len() - 1]);
    a[1] + (b[1] - a[1]) * (y - a[0]) / (b[0] - a[0])
}

/// The value farthest from 0 that the only main line of a panel reaches.
fn drawn_peak(svg: &str, panel: usize) -> f64 {
    let line = &main_lines(svg)[panel];
    let values = line.iter().map(|point| read_off(svg, panel, point[1]));
    values.fold(0.0, |peak: f64, value| peak.max(value.abs()))
}

fn figure<'a>(all: &'a [Drawn], id: &str) -> &'a str {
    all.iter().find(|drawn| drawn.id == id).unwrap_or_else(|| panic!("no {id}")).svg.as_str()
}

fn assert_close(drawn: f64, tabled: f64) {
    // Ticks are placed to 0.1 of at least 78 units, over which the range is a bit over twice the
    // peak: what is read off is good to 0.5 %.
    assert!((drawn - tabled).abs() < 5e-3 * tabled, "drawn {drawn}, tabled {tabled}");
}

/// A coarse record: peaks between samples stand out from the samples.
fn coarse() -> Case {
    run("coarse", frame_model(2, 1.0), rough_motion(12.0, 0.05))
}

#[test]
fn drawn_peaks_are_the_tabled_peaks() {
    for case in [coarse(), run("fine", frame_model(2, 1.0), rough_motion(60.0, 0.005))] {
        let all = figures::all(&report(&case, &case.summary));
        let d = &case.summary.demands;
        assert_close(
            drawn_peak(figure(&all, "sliding-displacement"), 0),
            1e3 * d.peak_sliding_displacement_m,
        );
        let svg = figure(&all, "accelerations");
        assert_close(drawn_peak(svg, 0), case.summary.record.pga_m_per_s2);
        assert_close(drawn_peak(svg, 1), d.peak_block_acceleration_m_per_s2);
        let svg_drift = figure(&all, "drifts");
        for (i, storey) in d.storeys.iter().enumerate() {
            assert_close(drawn_peak(svg, 2 + i), storey.peak_acceleration_m_per_s2);
            assert_close(drawn_peak(svg_drift, i), 1e3 * storey.peak_drift_m);
        }
    }
}

/// Without the peaks of the continuous motion the coarse record would be drawn too low.
#[test]
fn a_peak_between_samples_is_drawn() {
    let mut case = coarse();
    case.summary.demands.storeys[0].peak_drift_m *= 1.2;
    let all = figures::all(&report(&case, &case.summary));
    assert_close(
        drawn_peak(figure(&all, "drifts"), 0),
        1e3 * case.summary.demands.storeys[0].peak_drift_m,
    );
}

#[test]
fn prop_labels_stay_inside_and_every_drawing_is_named() {
    for display in [DisplayUnits::Si, DisplayUnits::KnMm, DisplayUnits::Us] {
        for storeys in [0, 1, 5] {
            let case = run("m", frame_model(storeys, 1.0), rough_motion(12.0, 0.02));
            let spectra = floor_spectra(&case);
            let mut report = report(&case, &case.summary);
            report.floor_spectra = Some(&spectra);
            report.display = display;
            let all = figures::all(&report);
            assert_eq!(all.len(), if storeys == 0 { 6 } else { 7 });
            for drawn in &all {
                assert_sound(drawn);
            }
        }
    }
}

/// Both drawings of a figure, that of a page and that of a phone.
fn assert_sound(drawn: &Drawn) {
    assert!(!drawn.caption.is_empty());
    assert_sound_svg(&drawn.id, drawn.svg.as_str(), WIDTH);
    assert_sound_svg(&drawn.id, drawn.figure.to_narrow_svg().as_str(), NARROW);
}

fn assert_sound_svg(id: &str, svg: &str, width: f64) {
    for needed in ["<title", "<desc", "role=\"img\"", "aria-labelledby"] {
        assert!(svg.contains(needed), "{}: {needed}", id);
    }
    for wrong in ["NaN", "inf", "url(", "href", "<script", "<style"] {
        assert!(!svg.contains(wrong), "{}: {wrong}", id);
    }
    let view = attribute(svg, "viewBox").expect("a view box");
    let height: f64 = view.rsplit(' ').next().and_then(|text| text.parse().ok()).expect("height");
    assert!(view.starts_with(&format!("0 0 {width} ")), "{id}: {view}");
    assert_apart(id, svg);
    for text in texts(svg) {
        // Letters of Helvetica are half their size wide, digits 0.56.
        let wide = 0.56 * text.size * text.content.chars().count() as f64;
        let left = match text.anchor.as_str() {
            "start" => text.x,
            "middle" => text.x - 0.5 * wide,
            _ => text.x - wide,
        };
        assert!(left >= -0.5 && left + wide <= width + 1.0, "{}: {:?} is cut", id, text.content);
        assert!(text.y - 0.75 * text.size >= -0.5 && text.y + 3.0 <= height, "{}", text.content);
    }
}

/// No two labels below a frame lie on each other.
fn assert_apart(id: &str, svg: &str) {
    let below: Vec<Text> = texts(svg).into_iter().filter(|text| text.anchor == "middle").collect();
    for (i, one) in below.iter().enumerate() {
        for other in below[..i].iter().filter(|other| (other.y - one.y).abs() < 1.0) {
            let half = |text: &Text| 0.28 * text.size * text.content.chars().count() as f64;
            let apart = (one.x - other.x).abs();
            assert!(
                apart >= half(one) + half(other),
                "{id}: {:?} on {:?}",
                one.content,
                other.content
            );
        }
    }
}

/// Of a logarithmic axis too long for all its labels the powers of ten stay.
#[test]
fn labels_of_a_logarithmic_axis_leave_room() {
    let line = |x: f64| [x, x];
    let series = PlotSeries {
        label: String::new(),
        style: Style::MAIN,
        shape: Shape::Curve,
        points: (0..40).map(|i| line(0.002 * 1.3_f64.powi(i))).collect(),
    };
    let panel = Panel {
        x: Axis::logarithmic("Period (s)", 0.002, 60.0),
        y: Axis::linear("Sa (g)", 0.0, 60.0),
        height: 100.0,
        series: vec![series],
        limits: Vec::new(),
        peak: None,
        note: String::new(),
    };
    let figure = Figure {
        id: "log".to_owned(),
        title: "Periods".to_owned(),
        description: "Periods".to_owned(),
        layout: Layout::Square,
        panels: vec![panel.clone(), panel],
        shaded: Vec::new(),
    };
    let drawn = Drawn::new(figure, "Periods.".to_owned());
    assert_sound(&drawn);
    for svg in [drawn.svg, drawn.figure.to_narrow_svg()] {
        for decade in ["0.01", "0.1", "1", "10"] {
            let labels = texts(svg.as_str());
            let found = labels.iter().filter(|t| t.anchor == "middle" && t.content == decade);
            assert_eq!(found.count(), 2, "{decade}");
        }
    }
    // On a phone the panels stand below each other.
    let frames = drawn.figure.to_narrow_svg();
    assert!(frames.as_str().matches("<rect fill=\"none\"").count() == 2);
}

#[test]
fn units_stand_on_both_axes() {
    let case = run("m", frame_model(1, 1.0), rough_motion(12.0, 0.02));
    let mut report = report(&case, &case.summary);
    report.display = DisplayUnits::Us;
    let all = figures::all(&report);
    for (id, labels) in [
        ("sliding-displacement", ["Sliding displacement s (in)", "Time (s)"]),
        ("accelerations", ["Storey 1 acceleration (g)", "Time (s)"]),
        ("hysteresis", ["Slider force (kip)", "Sliding displacement s (in)"]),
        ("hysteresis", ["Friction force alone (kip)", "Sliding displacement s (in)"]),
        ("demand", ["Friction force T (kip)", "Time (s)"]),
        ("energy", ["Energy (kip in)", "Time (s)"]),
    ] {
        for label in labels {
            let svg = figure(&all, id);
            assert!(texts(svg).iter().any(|text| text.content == label), "{id}: {label}");
        }
    }
}

/// A data sheet draws force rising with displacement: the slope of the loop is that of the spring.
#[test]
fn the_hysteresis_loop_rises() {
    let case = run("m", frame_model(2, 1.0), rough_motion(12.0, 0.02));
    let all = figures::all(&report(&case, &case.summary));
    let svg = figure(&all, "hysteresis");
    let d = &case.summary.demands;
    let unit = if d.peak_slider_force_n >= 1e3 { 1e3 } else { 1.0 };
    assert_close(drawn_peak(svg, 0), d.peak_slider_force_n / unit);
    let line = &main_lines(svg)[0];
    // In the drawing y falls as the force rises.
    let mean = |i: usize| line.iter().map(|p| p[i]).sum::<f64>() / line.len() as f64;
    let (x, y) = (mean(0), mean(1));
    let along: f64 = line.iter().map(|p| (p[0] - x) * (y - p[1])).sum();
    assert!(along > 0.0, "falls: {along}");
}

#[test]
fn a_drawing_does_not_grow_with_the_record() {
    let svgs = |dt_s: f64| {
        let case = run("m", frame_model(1, 1.0), rough_motion(30.0, dt_s));
        figures::all(&report(&case, &case.summary))
    };
    for (short, long) in svgs(0.02).iter().zip(&svgs(0.002)) {
        let (few, many) = (short.svg.as_str().len(), long.svg.as_str().len());
        assert!(many < 3 * few + 20_000, "{}: {few} bytes grew to {many}", short.id);
    }
}

/// Of an outline the same is drawn as of the whole history: what a column of pixels of one reaches, the other reaches
/// there or a column beside.
#[test]
fn an_outline_is_drawn_as_the_history_that_it_is_of() {
    assert!(COLUMNS as f64 >= WIDTH);
    let motion = rough_motion(60.0, 0.005);
    let case = run("m", frame_model(1, 1.0), motion);
    let history = case.response.history.as_ref().expect("a history");
    let (times_s, sliding_m) = (&history.time_s, &history.sliding_displacement_m);
    let outline = SlidingOutline::of(&case.response).expect("an outline");
    let whole: Vec<[f64; 2]> = times_s.iter().zip(sliding_m).map(|(t, s)| [*t, *s]).collect();
    assert!(4 * outline.time_s.len() < whole.len());
    let drawn = |points: Vec<[f64; 2]>, width: f64| {
        let most = points.iter().fold(0.0, |most: f64, point| most.max(point[1].abs()));
        let line =
            PlotSeries { label: String::new(), style: Style::MAIN, shape: Shape::History, points };
        let panel = Panel {
            x: Axis::linear("Time (s)", 0.0, times_s[times_s.len() - 1]),
            y: Axis::symmetric("s (m)", [most]),
            height: 150.0,
            series: vec![line],
            limits: Vec::new(),
            peak: None,
            note: String::new(),
        };
        let figure = Figure {
            id: "one".into(),
            title: String::new(),
            description: String::new(),
            layout: Layout::Stacked,
            panels: vec![panel],
            shaded: Vec::new(),
        };
        let svg = if width == WIDTH { figure.to_svg() } else { figure.to_narrow_svg() };
        let mut columns = vec![[f64::INFINITY, f64::NEG_INFINITY]; width as usize];
        for [x, y] in main_lines(svg.as_str()).remove(0) {
            let [low, high] = &mut columns[x as usize];
            (*low, *high) = (low.min(y), high.max(y));
        }
        columns
    };
    for width in [WIDTH, NARROW] {
        let of_whole = drawn(whole.clone(), width);
        let of_outline = drawn(outline.points().collect(), width);
        let reaches = |one: &[[f64; 2]], other: &[[f64; 2]]| {
            one.iter().enumerate().filter(|(_, [low, _])| low.is_finite()).all(
                |(i, [low, high])| {
                    let near = &other[i.saturating_sub(1)..(i + 2).min(other.len())];
                    near.iter().any(|beside| beside[0] <= *low)
                        && near.iter().any(|beside| beside[1] >= *high)
                },
            )
        };
        assert!(reaches(&of_whole, &of_outline), "{width}");
        assert!(reaches(&of_outline, &of_whole), "{width}");
        let peak = |columns: &[[f64; 2]]| {
            let first = [f64::INFINITY, f64::NEG_INFINITY];
            columns.iter().fold(first, |all, of| [all[0].min(of[0]), all[1].max(of[1])])
        };
        assert_eq!(peak(&of_whole), peak(&of_outline));
    }
}

#[test]
fn still_ground_and_empty_histories_are_drawn_without_fault() {
    let still = GroundMotion::evenly_spaced(0.01, vec![0.0; 20], None).expect("a motion");
    let mut case = run("still", frame_model(1, 1.0), still);
    for drawn in figures::all(&report(&case, &case.summary)) {
        assert_sound(&drawn);
    }
    case.response.history = None;
    assert!(figures::all(&report(&case, &case.summary)).is_empty());
    let empty = FloorSpectra::default();
    let mut report = report(&case, &case.summary);
    report.floor_spectra = Some(&empty);
    assert!(figures::all(&report).is_empty());
}

#[test]
fn bounds_of_friction_follow_the_vertical_motion() {
    let level = rough_motion(12.0, 0.02);
    let up = level.times_s().iter().map(|t| 3.0 * (9.0 * t).sin()).collect();
    let horizontal = level.horizontal_m_per_s2().to_vec();
    let motion = GroundMotion::new(level.times_s().to_vec(), horizontal, Some(up)).expect("ok");
    let case = run("vertical", frame_model(1, 1.0), motion);
    let all = figures::all(&report(&case, &case.summary));
    let drawn = all.iter().find(|drawn| drawn.id == "demand").expect("demand");
    assert!(drawn.caption.contains("follow the normal force"));
    assert_sound(drawn);
    let dashed = drawn.svg.as_str().split("<path").filter(|tag| tag.contains("\"6 3\""));
    assert!(dashed.filter(|tag| tag.len() > 1000).count() == 2, "two wavy bounds");
}

#[test]
fn the_loop_is_red_only_where_a_stop_is_pressed() {
    let elastic = |gap_m| Stop::elastic([Some(gap_m); 2], 2e5, 0.0);
    let rigid = Stop::rigid([Some(0.005); 2], 0.4);
    for (stop, is_red) in [(elastic(0.005), true), (elastic(10.0), false), (rigid, false)] {
        let plain = frame_model(0, 1.0);
        let slider = Slider { ends: stop.into(), ..plain.slider().clone() };
        let model = Model::new(
            *plain.block(),
            slider,
            plain.frame().clone(),
            9.80665,
            InitialState::rest(),
        );
        let case = run("stop", model.expect("a model"), rough_motion(8.0, 0.01));
        let summary = case.summary.clone();
        let all = figures::all(&report(&case, &summary));
        let drawn = all.iter().find(|drawn| drawn.id == "hysteresis").expect("a loop");
        assert_eq!(drawn.caption.contains("Red:"), is_red, "{stop:?}");
        assert_eq!(drawn.svg.as_str().contains("against the stop"), is_red, "{stop:?}");
    }
}

#[test]
fn a_stiff_stop_does_not_flatten_the_loop() {
    for (stiffness_n_per_m, leaves) in [(2e8, true), (2e4, false)] {
        let plain = frame_model(0, 1.0);
        let stop = Stop::elastic([Some(0.005); 2], stiffness_n_per_m, 0.0);
        let slider = Slider { ends: stop.into(), ..plain.slider().clone() };
        let (block, frame) = (*plain.block(), plain.frame().clone());
        let model = Model::new(block, slider, frame, 9.80665, InitialState::rest());
        let case = run("stop", model.expect("a model"), rough_motion(8.0, 0.01));
        let summary = case.summary.clone();
        let all = figures::all(&report(&case, &summary));
        let drawn = all.iter().find(|drawn| drawn.id == "hysteresis").expect("a loop");
        let svg = drawn.svg.as_str();
        assert_sound(drawn);
        assert_eq!(drawn.caption.contains("it leaves the frame"), leaves);
        assert_eq!(svg.matches("<svg").count(), if leaves { 2 } else { 1 }, "{svg}");
        assert_eq!(svg.contains(">stop "), leaves, "{svg}");
    }
}
