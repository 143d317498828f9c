//! The page: safe, self-contained, small, in the order in which a design office reads.

use crate::support::{floor_spectra, frame_model, report, rough_motion, run, run_times};
use slipstick::response::{Event, EventKind, Mode};
use slipstick_report::{FileNote, InputText};

/// Opening and closing tags in order, without their attributes; void ones left out.
fn assert_balanced(html: &str) {
    // Within the script `<` compares.
    let (page, rest) = html.split_once("<script>").expect("a script");
    let (_, end) = rest.split_once("</script>").expect("its end");
    let html = &(page.to_owned() + end);
    let mut open = Vec::new();
    for piece in html.split('<').skip(1) {
        let tag = piece.split('>').next().expect("a tag");
        let name = tag.split([' ', '\n', '/']).next().unwrap_or("");
        if tag.starts_with('!') || matches!(name, "meta" | "br" | "wbr") || tag.ends_with('/') {
            continue;
        }
        match tag.strip_prefix('/') {
            Some(closed) => assert_eq!(open.pop(), Some(closed.to_owned()), "at {piece}"),
            None => open.push(name.to_owned()),
        }
    }
    assert!(open.is_empty(), "left open: {open:?}");
}

#[test]
fn what_users_type_is_never_markup() {
    let bad = "<script>alert(1)</script>\"'><img src=x onerror=y> </style> @import \\2f & \u{202e}";
    let mut case = run(bad, frame_model(1, 1.0), rough_motion(5.0, 0.02));
    case.response.warnings.clear();
    let mut summary = case.summary.clone();
    summary.warnings[0].message = bad.to_owned();
    let mut report = report(&case, &summary);
    report.record = bad;
    report.command_line = bad;
    report.inputs = &[InputText { path: BAD, text: BAD }];
    report.files = &[FileNote { path: BAD, sha256: BAD, description: BAD }];
    let html = report.to_html();
    assert_eq!(html.matches("<script").count(), 1, "a script got in");
    assert!(!html.contains("<img"), "an element got in");
    assert_eq!(html.matches("</style>").count(), 1, "the style sheet was closed early");
    let from = html.find("<style>").expect("a style sheet");
    let style = &html[from..html.find("</style>").expect("its end")];
    assert!(!style.contains("@import"), "a rule got into the style sheet");
    assert!(html.contains("&lt;script&gt;alert(1)&lt;/script&gt;&quot;&#39;&gt;"));
    assert_balanced(&html);
}

/// Numbers have a minus sign, names of records keep their hyphens.
#[test]
fn names_stay_as_they_are_where_numbers_are_set_as_in_print() {
    let case = run("mock-up", frame_model(2, 1.0), rough_motion(10.0, 0.01));
    let mut summary = case.summary.clone();
    summary.record.end_velocity_m_per_s = -0.0125;
    let mut report = report(&case, &summary);
    report.record = "taft-021 (text with one column)";
    let html = report.to_html();
    assert!(html.contains("<td>taft-021 (text with one column)</td>"));
    assert!(html.contains("<td>−0.01250 m/s</td>"));
    assert!(html.contains("<h3>Storeys, from the roof down</h3>"));
}

const BAD: &str = "<script>\"</pre>";

#[test]
fn the_page_needs_nothing_else() {
    let case = run("mock-up", frame_model(2, 1.0), rough_motion(10.0, 0.01));
    let html = report(&case, &case.summary).to_html();
    let without_namespace = html.replace("http://www.w3.org/2000/svg", "");
    // The page's own script loads nothing, and nothing waits for it.
    let script = &html[html.find("<script>").unwrap()..html.find("</script>").unwrap()];
    assert!(!["fetch", "import", "eval", "innerHTML"].iter().any(|word| script.contains(word)));
    assert!(!html.contains(" onload") && !html.contains(" onclick"));
    for outside in ["http:", "https:", "<script ", "<link", " src=", "url(", "@import", "file:"] {
        assert!(!without_namespace.contains(outside), "{outside}");
    }
    assert!(html.starts_with("<!DOCTYPE html>"));
    assert!(html.contains("<meta charset=\"utf-8\">") && html.contains("size: A4"));
    assert!(html.is_ascii() || !html.contains('\u{fffd}'));
    assert_balanced(&html);
    assert_eq!(html, report(&case, &case.summary).to_html(), "not the same text twice");
}

#[test]
fn answers_come_first_and_inputs_last() {
    let nominal = run("mock-up", frame_model(1, 1.0), rough_motion(10.0, 0.01));
    let bound = |f| run_times("mock-up", frame_model(1, f), rough_motion(10.0, 0.01), f);
    let (lower, upper) = (bound(0.8), bound(1.3));
    let summary = nominal.summary.clone().with_bounds(lower.summary, upper.summary);
    let mut report = report(&nominal, &summary);
    report.bounds = Some([&lower.response, &upper.response]);
    let html = report.to_html();
    let mut from = 0;
    for heading in [
        "The block slides",
        "% of its gap of 60 mm",
        "friction (× ",
        "governs.",
        "Certificate: confirmed.",
        "<h2>Warnings",
        "gap exceeded",
        "id=\"sliding-displacement\"",
        "lower friction",
        "id=\"hysteresis\"",
        "<h2>Peaks",
        "Governing",
        "lower (× 0.8)",
        "<h2>Accelerations, spectra, energy",
        "id=\"accelerations\"",
        "id=\"energy\"",
        "<h2>Certificate",
        "<h2>Assumptions",
        "<h2>Appendix",
        "Model and record",
        "<h3>Events",
        "9f86d081884c7d659a2feaa0c55ad015",
        "slipstick run examples/mockup.toml",
        "[block]",
    ] {
        let at = html[from..].find(heading);
        from += at.unwrap_or_else(|| panic!("{heading} is missing or out of order"));
    }
    assert!(html.contains("number governs"));
    assert_eq!(html.matches("<h2>").count(), html[..from].matches("<h2>").count());
}

/// The words of the verdict agree with the figures of the run that governs.
#[test]
fn the_verdict_names_gap_time_and_governing_friction() {
    let nominal = run("mock-up", frame_model(1, 1.0), rough_motion(10.0, 0.01));
    let bound = |f| run_times("mock-up", frame_model(1, f), rough_motion(10.0, 0.01), f).summary;
    let summary = nominal.summary.clone().with_bounds(bound(0.8), bound(1.3));
    let slides = |s: &slipstick_report::Summary| s.demands.peak_sliding_displacement_m;
    let runs = summary.runs();
    let (name, governing) =
        runs.iter().copied().max_by(|a, b| slides(a.1).total_cmp(&slides(b.1))).expect("runs");
    let html = report(&nominal, &summary).to_html();
    let d = &governing.demands;
    let peak = slipstick_report::number::printed(1e3 * d.peak_sliding_displacement_m, 4);
    assert!(html.contains(&format!("The block slides {peak} mm at most, at ")), "{peak}");
    let said = match name {
        "nominal" => "Nominal friction governs.",
        "lower" => "Lower-bound friction (× 0.8) governs.",
        _ => "Upper-bound friction (× 1.3) governs.",
    };
    assert!(html.contains(said), "{said}");
    assert!(html.contains("The gap is NOT sufficient"));
    let still = run("m", frame_model(0, 50.0), rough_motion(5.0, 0.01));
    assert!(report(&still, &still.summary).to_html().contains("The block does not slide"));
}

#[test]
fn many_events_are_cut_and_counted() {
    let mut case = run("mock-up", frame_model(0, 1.0), rough_motion(5.0, 0.01));
    case.response.events = (0..1234)
        .map(|i| Event {
            time_s: f64::from(i),
            kind: EventKind::Stick,
            mode: Mode::Stick,
            sliding_displacement_m: 0.0,
            interface: 0,
        })
        .collect();
    let html = report(&case, &case.summary).to_html();
    assert_eq!(html.matches("<td>stick</td>").count(), 60);
    assert!(html.contains("1174 more stand in events.csv"));
    assert!(html.contains(">39.000000<") && !html.contains(">40.000000<"));
    assert!(html.contains(">1233.000000<") && html.contains(">1214.000000<"));
}

#[test]
fn the_largest_page_stays_below_two_megabytes() {
    let nominal = run("tower", frame_model(20, 1.0), rough_motion(60.0, 0.005));
    let again = || nominal.summary.clone();
    let summary = again().with_bounds(again(), again());
    let spectra = floor_spectra(&nominal);
    let mut report = report(&nominal, &summary);
    report.bounds = Some([&nominal.response, &nominal.response]);
    report.floor_spectra = Some(&spectra);
    let bytes = report.to_html().len();
    assert!(bytes < 2_000_000, "{bytes} bytes");
}

#[test]
fn a_failed_check_is_said_loudly() {
    let mut case = run("mock-up", frame_model(1, 1.0), rough_motion(5.0, 0.01));
    case.certificate.friction_excess = 1e-6;
    let (model, motion) = (&case.model, &case.motion);
    let summary =
        crate::support::summarise("m", model, motion, &case.response, &case.certificate, 1.0, &[]);
    let html = report(&case, &summary).to_html();
    assert!(html.contains("NOT CONFIRMED"));
    assert!(html.contains("check failed"));
    // A bound that fails spoils the whole, even beside a nominal run that holds.
    let spoiled = case.summary.clone().with_bounds(summary, case.summary.clone());
    assert!(report(&case, &spoiled).to_html().contains("NOT CONFIRMED"));
}

/// Colours of drawings, as the sources of the report write them.
fn colours(folder: &std::path::Path, found: &mut Vec<String>) {
    for entry in std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry"))
    {
        let path = entry.path();
        if path.is_dir() {
            colours(&path, found);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            let text = std::fs::read_to_string(&path).expect("a source");
            let quoted = text
                .split('"')
                .filter(|word| word.starts_with('#'))
                .map(|word| word.trim_end_matches('\\'));
            let colour = |word: &&str| {
                matches!(word.len(), 4 | 7) && word[1..].chars().all(|c| c.is_ascii_hexdigit())
            };
            found.extend(quoted.filter(colour).map(str::to_owned));
        }
    }
}

/// Where the reader's system is dark the page and every colour of its drawings are; paper stays light.
#[test]
fn every_colour_of_a_drawing_has_one_for_the_dark() {
    let mut found = Vec::new();
    colours(&std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), &mut found);
    found.sort();
    found.dedup();
    // The ground of a file of drawings, which no page has.
    found.retain(|colour| colour != "#ffffff");
    assert!(found.len() > 15, "{found:?}");
    let case = run("mock-up", frame_model(1, 1.0), rough_motion(5.0, 0.02));
    let html = report(&case, &case.summary).to_html();
    let (_, dark) =
        html.split_once("@media screen and (prefers-color-scheme: dark)").expect("rules");
    for colour in found {
        for of in ["fill", "stroke"] {
            assert!(dark.contains(&format!("svg [{of}=\"{colour}\"]")), "{of} {colour}");
        }
    }
}

/// The first figure is there a second time, as narrow as a phone, under identifiers of its own.
#[test]
fn the_first_figure_is_drawn_for_a_phone_besides() {
    let case = run("mock-up", frame_model(1, 1.0), rough_motion(5.0, 0.02));
    let html = report(&case, &case.summary).to_html();
    assert_eq!(html.matches("viewBox=\"0 0 360 ").count(), 1);
    assert_eq!(html.matches("<div class=\"narrow\">").count(), 1);
    let ids: Vec<&str> =
        html.split(" id=\"").skip(1).filter_map(|part| part.split('"').next()).collect();
    for (i, id) in ids.iter().enumerate() {
        assert!(!ids[..i].contains(id), "{id} twice");
    }
    assert!(ids.contains(&"sliding-displacement-narrow-title"), "{ids:?}");
}

/// A path is broken behind folders alone; what ends a short report stands together.
#[test]
fn cells_of_paths_break_behind_folders() {
    let case = run("mock-up", frame_model(1, 1.0), rough_motion(5.0, 0.02));
    let mut report = report(&case, &case.summary);
    report.files = &[FileNote { path: "far-field/a_b.AT2", sha256: "00", description: "PEER AT2" }];
    let html = report.to_html();
    assert!(html.contains("<td>far-field/<wbr>a_b.AT2</td>"), "no break");
}
