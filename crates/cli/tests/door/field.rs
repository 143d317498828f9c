//! Motions as people have them: tables of loggers, spreadsheets and programs, each the same motion, and
//! tables that are none.

use std::fmt::Write as _;
use std::path::Path;

use serde_json::Value;

use super::support::Folder;

const MODEL: &str = "[block]\nmass = \"100 t\"\n[slider]\nstatic_friction = 0.06\n\
                     kinetic_friction = 0.05\nradius = \"2 m\"\n";

/// Samples, 5 ms apart: a sine under half another, 0 at both ends.
const SAMPLES: usize = 1201;

/// Its value in m/s².
fn acceleration(k: usize) -> f64 {
    let t = 0.005 * k as f64;
    let swell = (std::f64::consts::PI * t / 6.0).sin();
    if k + 1 == SAMPLES { 0.0 } else { 3.0 * swell * (7.3 * t).sin() }
}

/// A table of it under a header: what stands before each value, and the value times a factor.
fn table(header: &str, separator: &str, before: impl Fn(usize) -> String, factor: f64) -> String {
    let mut text = format!("{header}\n");
    for k in 0..SAMPLES {
        let value = format!("{:.7}", factor * acceleration(k));
        let value = if separator == ";" { value.replace('.', ",") } else { value };
        writeln!(text, "{}{separator}{value}", before(k)).unwrap();
    }
    text
}

fn seconds(k: usize) -> String {
    format!("{}.{:03}", 5 * k / 1000, 5 * k % 1000)
}

/// A clock that starts at ten in the morning.
fn clock(k: usize) -> String {
    let ms = 5 * k;
    format!("10:{:02}:{:02}.{:03}", ms / 60_000, ms / 1000 % 60, ms % 1000)
}

/// What a run says: the largest sliding displacement in mm and the kinds of notices, the severe ones
/// marked; or the refusal.
fn run(folder: &Folder, record: &Path, options: &[&str]) -> Result<(f64, Vec<String>), String> {
    let record = record.display().to_string();
    let arguments = [&["run", "model.toml", "--motion", &record, "--json"], options].concat();
    let output = folder.output(&arguments);
    if output.status.code() == Some(2) {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned());
    }
    let json: Value = serde_json::from_slice(&output.stdout).unwrap();
    let notices = ["warnings", "notes"].into_iter().flat_map(|list| json[list].as_array().cloned());
    let kinds = notices.flatten().map(|notice| {
        let severe = if notice["severity"] == "severe" { "severe " } else { "" };
        format!("{severe}{}", notice["kind"].as_str().unwrap())
    });
    let mm = 1e3 * json["peak_sliding_displacement_m"].as_f64().unwrap();
    Ok((mm, kinds.collect()))
}

fn of_text(folder: &Folder, text: &str, options: &[&str]) -> Result<(f64, Vec<String>), String> {
    folder.write("motion.txt", text);
    run(folder, Path::new("motion.txt"), options)
}

/// The motion in every clothing comes out the same, to what seven decimals of its values leave.
#[test]
fn tables_of_one_motion() {
    let folder = Folder::with_model("field-same", MODEL);
    let plain = table("time_s,acceleration_m_per_s2", ",", seconds, 1.0);
    let (mm, kinds) = of_text(&folder, &plain, &[]).unwrap();
    assert!(mm > 20.0 && !kinds.iter().any(|kind| kind.starts_with("severe")), "{mm} {kinds:?}");
    let g = 1.0 / 9.80665;
    let count = |k: usize| k.to_string();
    let si: &[&str] = &["--units", "m/s2"];
    let step: &[&str] = &["--dt", "0.005 s"];
    let epoch = |k: usize| format!("17000000{:02}.{:03}", 5 * k / 1000, 5 * k % 1000);
    let milliseconds = |k: usize| (5 * k).to_string();
    let day = |k: usize| format!("2025-11-26 {}", clock(k));
    let both = |k: usize| format!("{k},{}", seconds(k));
    let quoted = |k: usize| format!("\"{}\" {}", k + 1, seconds(k));
    let prose =
        "*******\n*** Site # 1\n  1201 samples\ndt: 0.005 sec\nMag = 6.9\nA\nB\nC\nD\nE\nF\n";
    for (text, options) in [
        (table(",time,acc", ",", both, 1.0), si),
        (table("Unnamed: 0,time,acc", ",", both, 1.0), si),
        (table("#,Time [s],a [m/s²]", ",", both, 1.0), &[]),
        (table("\"time\" \"acc\"", " ", quoted, 1.0), si),
        (table("Sample,Acc (g)", ",", count, g), step),
        (table("n;a [g]", ";", count, g), step),
        (table(",Acc (g)", ",", count, g), step),
        (table("data point,Acc (g)", ",", count, g), step),
        (table("Time,Acc (m/s2)", ",", milliseconds, 1.0), step),
        (table("time_ms,acc m/s^2", ",", milliseconds, 1.0), &[]),
        (table("Zeit [ms];a [m/s²]", ";", milliseconds, 1.0), &[]),
        (table("Zaman (sn),ivme (cm/sn2)", ",", seconds, 100.0), &[]),
        (table("time (s),acc (%g)", ",", seconds, 100.0 * g), &[]),
        (table("timestamp,acc (m/s^2)", ",", epoch, 1.0), &[]),
        (table("timestamp,acc", ",", |k| (1_700_000_000_000 + 5 * k).to_string(), 1.0), si),
        (table("timestamp,acc_m_s2", ",", day, 1.0), &[]),
        (table("timestamp,acc_m_s2", ",", |k| day(k).replace(' ', "T") + "Z", 1.0), &[]),
        (table("timestamp acc_m_s2", " ", day, 1.0), &[]),
        (
            table("t;a (m/s²)", ";", |k| format!("26.11.2025 {}", clock(k)).replace(".", ","), 1.0),
            &[],
        ),
        (table(&format!("{prose}  time(s) acc(cm/s**2)"), " ", seconds, 100.0), &[]),
        (
            table(
                "% -----\n% NPTS, DT: 1201 0.005\n% time(s) NS (cm/s/s)\n % -----",
                " ",
                seconds,
                100.0,
            ),
            &[],
        ),
    ] {
        let header = text.lines().take(3).collect::<Vec<_>>().join(" | ");
        // Dates with commas are none.
        let text = text.replace("26,11,2025", "26.11.2025");
        let (found, kinds) = of_text(&folder, &text, options)
            .unwrap_or_else(|refusal| panic!("{header}: {refusal}"));
        assert!((found - mm).abs() < 1e-4, "{header}: {found} for {mm} mm, {kinds:?}");
        let wrong = |kind: &String| kind.starts_with("severe") || kind == "times_rounded";
        assert!(!kinds.iter().any(wrong), "{header}: {kinds:?}");
    }
}

/// A clock that is not in seconds is refused or doubted before anyone believes the figures.
#[test]
fn clocks_that_are_no_seconds() {
    let folder = Folder::with_model("field-clocks", MODEL);
    for (header, factor, micro) in [("Time,Acc (m/s2)", 5, false), ("t,a (m/s2)", 5000, true)] {
        let text = table(header, ",", |k| (factor * k).to_string(), 1.0);
        match of_text(&folder, &text, &[]) {
            Ok((_, kinds)) => {
                assert!(kinds.contains(&"severe long_step".to_owned()), "{kinds:?}");
                assert!(kinds.contains(&"severe absurd_motion".to_owned()), "{kinds:?}");
            }
            Err(refusal) => assert!(micro && refusal.contains("dt"), "{refusal}"),
        }
        let (_, kinds) = of_text(&folder, &text, &["--dt", "0.005 s"]).unwrap();
        assert!(kinds.contains(&"times_replaced".to_owned()), "{kinds:?}");
    }
    let counted = table("Sample,Acc (g)", ",", |k| k.to_string(), 0.1);
    assert!(of_text(&folder, &counted, &[]).unwrap_err().contains("counts its rows"));
}

/// A spectrum is no motion under any of its names, alone or in a folder, and is what a target is.
#[test]
fn spectra_are_no_motions() {
    let folder = Folder::with_model("field-spectra", MODEL);
    let ordinates = |header: &str, separator: &str| {
        let mut text = format!("{header}\n0{separator}0.35\n");
        for period in [0.05, 0.1, 0.15, 0.2, 0.35, 0.5, 0.8, 1.2, 2.0, 3.0, 4.5] {
            let sa = 0.9 / (0.8 + period * period);
            writeln!(text, "{period}{separator}{sa:.4}").unwrap();
        }
        if separator == ";" { text.replace('.', ",") } else { text }
    };
    for (header, separator) in [
        ("T(s),Sae(g)", ","),
        ("T[s];PSA[g]", ";"),
        ("Periyot (s),Sae (g)", ","),
        ("Period (s)\tSa (g)", "\t"),
        ("T (sn),Sa [g]", ","),
        ("T,PSA(cm/s2)", ","),
        ("T (s),SD (cm)", ","),
        ("Tn;SV [cm/s]", ";"),
        ("Frequency (Hz),PSA (g)", ","),
        ("Time,Spektral ivme (g)", ","),
    ] {
        let refusal = of_text(&folder, &ordinates(header, separator), &[]).unwrap_err();
        assert!(refusal.contains("spectrum"), "{header}: {refusal}");
    }
    let bare = ordinates("", " ");
    let refusal = of_text(&folder, bare.trim_start(), &["--units", "g"]).unwrap_err();
    assert!(refusal.contains("not a spectrum"), "{refusal}");

    let motion = |factor: f64| table("time_s,acceleration_m_per_s2", ",", seconds, factor);
    folder.write("first.csv", motion(1.0));
    folder.write("second.csv", motion(-0.8).replace("0.0000000", "0.0000001"));
    let suite = ["run", "model.toml", "--records", "first.csv", "--second", "second.csv"];
    let range =
        ["--pairs", "separate", "--periods", "0.3 s..3 s", "--target", "target.csv", "--json"];
    let mut answers = Vec::new();
    for (header, separator) in [
        ("T(s),Sae(g)", ","),
        ("Tn [s];PSA [g]", ";"),
        ("Period,sa_g", ","),
        ("T (sn)\tSa{g}", "\t"),
    ] {
        folder.write("target.csv", ordinates(header, separator));
        let answer = folder.stdout(&[&suite[..], &range].concat());
        let answer: Value = serde_json::from_str(&answer).unwrap();
        answers.push(answer["runs"].clone());
    }
    assert!(answers[0] != Value::Null && answers.iter().all(|answer| *answer == answers[0]));
}

/// A target spectrum of which nobody says after which code it is does not silently take the periods and B_M of
/// ASCE/SEI 7: with `--periods` the first is not taken, and of a spectrum of that code nothing is assumed.
#[test]
fn a_code_that_is_assumed_is_said() {
    let folder = Folder::with_model("field-assumed", MODEL);
    let motion = |factor: f64| table("time_s,acceleration_m_per_s2", ",", seconds, factor);
    folder.write("first.csv", motion(1.0));
    folder.write("second.csv", motion(-0.8).replace("0.0000000", "0.0000001"));
    let rows = (1..60).map(|i| {
        let period = 0.1 * f64::from(i);
        format!("{period:.1},{:.4}\n", (0.6 / period).min(1.0))
    });
    folder.write("target.csv", format!("T(s),Sae(g)\n{}", rows.collect::<String>()));
    let suite = ["run", "model.toml", "--records", "first.csv", "--second", "second.csv"];
    let assumed = |options: &[&str]| {
        let answer = folder.stdout(&[&suite[..], options, &["--json"]].concat());
        let answer: Value = serde_json::from_str(&answer).unwrap();
        let warnings = answer["warnings"].as_array().unwrap().clone();
        let of_kind = warnings.iter().filter(|warning| warning["kind"] == "code_assumed");
        of_kind.map(|warning| warning["message"].as_str().unwrap().to_owned()).collect::<Vec<_>>()
    };
    let target = ["--target", "target.csv"].as_slice();
    let [both] = &assumed(target)[..] else { panic!("one notice") };
    for part in ["range of periods, 0.75 to 1.25 T_M", "B_M", "ASCE/SEI 7", "EN 1998"] {
        assert!(both.contains(part), "{part}: {both}");
    }
    let [factor] = &assumed(&[target, &["--periods", "0.3 s..3 s"]].concat())[..] else {
        panic!("one notice")
    };
    assert!(factor.contains("B_M") && !factor.contains("0.75 to 1.25"), "{factor}");
    let code = ["--code-spectrum", "sds = 1 g, sd1 = 0.6 g, tl = 8 s"];
    assert!(assumed(&code).is_empty());
    let text = folder.stdout(&[&suite[..], target].concat());
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("code_assumed: the target spectrum is a table"), "{text}");
}

/// Recorders at the end of their range, with the noise of their amplifiers.
#[test]
fn clipped_records_are_noticed() {
    let folder = Folder::with_model("field-clipped", MODEL);
    let clipped = |low: f64, high: f64, noise: f64| {
        let mut text = "time_s,acceleration_m_per_s2\n".to_owned();
        for k in 0..SAMPLES {
            let value = acceleration(k);
            let held = value.clamp(low, high);
            let ripple = if held == value {
                0.0
            } else {
                noise * (((k * k * 7919) % 1001) as f64 / 500.0 - 1.0)
            };
            writeln!(text, "{},{:.6}", seconds(k), held + ripple).unwrap();
        }
        text
    };
    let said = |text: &str| of_text(&folder, text, &[]).unwrap().1.contains(&"clipped".to_owned());
    for (low, high, noise) in [
        (-2.0, 2.0, 0.0),
        (-2.0, 2.0, 0.002),
        (-9.0, 2.0, 0.005),
        (-1.8, 9.0, 0.01),
        (-2.5, 2.5, 0.001),
    ] {
        assert!(said(&clipped(low, high, noise)), "{low} {high} {noise}");
    }
    assert!(!said(&clipped(-9.0, 9.0, 0.0)));
}

/// The letter of `a_g` stands for the ground: what was taken is said.
#[test]
fn ground_accelerations_of_eurocode_8() {
    let folder = Folder::with_model("field-ground", MODEL);
    for header in ["t,a_g", "t,u_g", "time (s),A_g"] {
        for factor in [1.0, 1.0 / 9.80665] {
            let text = table(header, ",", seconds, factor);
            let (_, kinds) = of_text(&folder, &text, &[]).unwrap();
            assert!(kinds.contains(&"severe units_assumed".to_owned()), "{header}: {kinds:?}");
        }
        let (_, kinds) =
            of_text(&folder, &table(header, ",", seconds, 1.0), &["--units", "m/s2"]).unwrap();
        assert!(!kinds.iter().any(|kind| kind.contains("units")), "{kinds:?}");
    }
    let other = table("t,north_g", ",", seconds, 0.1);
    assert!(!of_text(&folder, &other, &[]).unwrap().1.iter().any(|kind| kind.contains("units")));
}

/// A vertical component that is run alone is told, unless it was asked for by name.
#[test]
fn vertical_components_are_told() {
    let folder = Folder::with_model("field-vertical", MODEL);
    folder.write("quake-UP.csv", table("time_s,acceleration_m_per_s2", ",", seconds, 1.0));
    let told = "severe vertical_component".to_owned();
    let path = Path::new("quake-UP.csv");
    assert!(run(&folder, path, &[]).unwrap().1.contains(&told));
    let asked = ["--channel", "acceleration_m_per_s2"];
    assert!(!run(&folder, path, &asked).unwrap().1.contains(&told));
    let own = format!("{MODEL}[motion]\nrecord = \"quake-UP.csv\"\n");
    folder.write("own.toml", own);
    let json = folder.json(&["own.toml"]);
    assert!(json["warnings"].as_array().unwrap().iter().any(|w| w["kind"] == "vertical_component"));
}

/// A table of thousands of columns is refused before anything is computed of them; messages list twenty.
#[test]
fn wide_tables_are_refused_at_once() {
    let folder = Folder::with_model("field-wide", MODEL);
    let wide = |columns: usize| {
        let names: Vec<String> = (0..columns).map(|c| format!("c{c}_g")).collect();
        let row = |t: f64| format!("{t}{}\n", ",0.1".repeat(columns));
        format!("time_s,{}\n{}{}{}", names.join(","), row(0.0), row(0.01), row(0.02))
    };
    let refusal = of_text(&folder, &wide(20_000), &[]).unwrap_err();
    assert!(refusal.contains("at most 1000 columns"), "{refusal}");
    let refusal = of_text(&folder, &wide(900), &[]).unwrap_err();
    assert!(refusal.contains("(880 more)") && refusal.len() < 2000, "{refusal}");
    let points: Vec<String> = (0..10_000).map(|p| format!("p{p}_x")).collect();
    let modes =
        format!("period_s,participation_x,{}\n1,1{}\n", points.join(","), ",1".repeat(10_000));
    folder.write("modes.csv", modes);
    let model = format!(
        "{MODEL}[structure]\nmass = \"100 t\"\ndamping_ratio = 0.02\nmodes = \"modes.csv\"\n"
    );
    folder.write("model.toml", model);
    let refusal = folder.refused(&["run", "model.toml"]);
    assert!(refusal.contains("at most 200 points"), "{refusal}");
}

/// The files that people sent, where they are at hand, with what each must come to.
#[test]
fn files_from_the_field() {
    let field = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/field");
    let Ok(expected) = std::fs::read_to_string(field.join("expect.json")) else {
        println!("skipped: no {}", field.display());
        return;
    };
    let folder = Folder::with_model("field-files", MODEL);
    let expected: Vec<Value> = serde_json::from_str(&expected).unwrap();
    for case in &expected {
        let file = case["file"].as_str().unwrap();
        let path = field.join(file);
        if case["expect"] == "modes" {
            let name = path.display().to_string();
            folder.stdout(&["structure", "info", &name, "--mass-unit", "t"]);
            continue;
        }
        let options = case["options"].as_array().cloned().unwrap_or_default();
        let options: Vec<&str> = options.iter().filter_map(Value::as_str).collect();
        let found = run(&folder, &path, &options);
        let is_severe = |kind: &String| kind.starts_with("severe");
        let good = match (case["expect"].as_str().unwrap(), &found) {
            ("refused", Err(refusal)) => refusal.contains(case["word"].as_str().unwrap_or("")),
            ("doubted", Err(_)) => true,
            ("doubted", Ok((_, kinds))) => kinds.iter().any(is_severe),
            ("notice", Ok((_, kinds))) => {
                let kind = case["kind"].as_str().unwrap();
                kinds.iter().any(|found| kind == "*" || found.ends_with(kind))
            }
            // Files hold three to seven decimals of one motion.
            ("value", Ok((mm, kinds))) => {
                let without = case["without"].as_str();
                (mm - case["mm"].as_f64().unwrap()).abs() < 1e-3
                    && !kinds.iter().any(|kind| Some(kind.as_str()) == without || is_severe(kind))
            }
            _ => false,
        };
        assert!(good, "{case}: {found:?}");
    }
}
