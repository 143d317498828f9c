//! What a reviewer asks of the report of a suite, found as a person finds it: by headings, row labels and labels of figures.

use slipstick::assessment::suite::Suite;
use slipstick::input;
use slipstick::input::loaded::Loaded;
use slipstick::motion::GroundMotion;
use slipstick::requests::{Kind, On, Request};
use slipstick::study::engine::Engine;
use slipstick_report::DisplayUnits;
use slipstick_report::assessment::{Provenance, Sheet, answer};
use slipstick_report::report::FileNote;

const HOSPITAL: &str = include_str!("../../../../examples/hospital.toml");

/// Eleven pairs of our own making.
fn pairs() -> Suite {
    let wave = |i: u32| {
        let at = |k: u32| {
            let t = 0.02 * f64::from(k);
            let rate = 2.0 + 0.2 * f64::from(i);
            let shake = 2.0 * libm::sin(rate * t) + libm::sin(4.1 * rate * t + f64::from(i));
            shake * libm::exp(-0.1 * t) * (1.0 - libm::exp(-2.0 * t))
        };
        GroundMotion::evenly_spaced(0.02, (0..500).map(at).collect(), None).expect("a motion")
    };
    let named = |i: u32| (format!("STATION_{i}"), Loaded::made(wave(i), format!("STATION_{i}")));
    let mut suite = Suite::of((0..22).map(named), false);
    suite.pair_up();
    suite
}

fn sheet() -> Sheet {
    let analysis = input::parse("hospital.toml", HOSPITAL, &[]).expect("a model");
    let suite = pairs();
    let given = [
        ("code", "asce7-22"),
        ("code-spectrum", "sds = 1 g, sd1 = 0.6 g, tl = 8 s"),
        ("property-factors", "test = 0.9..1.2, specification = 0.85..1.15"),
        ("eccentricity", "e = 1.8 m, y = 12 m, b = 24 m, d = 36 m"),
        ("code-values", "R = 4, I_e = 1.5, S_1 = 0.7"),
        ("hazard", "MCE_R"),
        ("hazard", "DE=0.6667"),
        ("project", "General <Hospital>"),
        ("author", "A. Engineer"),
        ("date", "14 March"),
    ];
    let given = given.map(|(name, text)| (name, text.to_owned()));
    let asked = Request::new(Kind::Suite, given).expect("a request");
    let on = On {
        name: "Hospital",
        source: "hospital.toml",
        text: HOSPITAL,
        set: &[],
        analysis: &analysis,
        suite: &suite,
    };
    let found = asked.suite(&[on], None, &Engine::unwatched()).expect("an answer");
    answer::sheet(&found, DisplayUnits::Si)
}

/// The text between tags, entities as what they stand for.
fn plain(html: &str) -> String {
    let mut text = String::new();
    let mut inside = false;
    for c in html.chars() {
        match c {
            '<' => inside = true,
            '>' => inside = false,
            c if !inside => text.push(c),
            _ => {}
        }
    }
    let text = text.replace("&lt;", "<").replace("&gt;", ">").replace("&#39;", "'");
    text.replace("&quot;", "\"").replace("&amp;", "&").trim().to_owned()
}

/// What stands between each opening and closing of an element.
fn elements<'a>(html: &'a str, tag: &str) -> Vec<&'a str> {
    let (open, close) = (format!("<{tag}"), format!("</{tag}>"));
    let parts = html.split(&open[..]).skip(1).filter_map(|part| {
        let starts = part.starts_with(['>', ' ']);
        let body = part.split_once('>')?.1;
        starts.then(|| body.split(&close[..]).next().unwrap_or(""))
    });
    parts.collect()
}

/// A page as a person reads it.
struct Page {
    html: String,
}

impl Page {
    /// The rows of the first table below a heading that starts so: cells as they are read.
    fn table(&self, heading: &str) -> Vec<Vec<String>> {
        let at = ["<h2>", "<h3>"].into_iter().find_map(|tag| {
            let headings = self.html.match_indices(tag);
            headings.map(|(at, _)| at).find(|at| {
                let text = self.html[*at + 4..].split("</h").next().unwrap_or("");
                plain(text).starts_with(heading)
            })
        });
        let below = &self.html[at.unwrap_or_else(|| panic!("no heading {heading:?}"))..];
        let table = below.split("</table>").next().unwrap_or("");
        let cells = |row: &str| -> Vec<String> {
            let row = row.replace("<th", "<td").replace("</th>", "</td>");
            elements(&row, "td").into_iter().map(plain).collect()
        };
        elements(table, "tr").into_iter().map(cells).collect()
    }

    /// The row of such a table whose first cell starts so.
    fn row(&self, heading: &str, label: &str) -> Vec<String> {
        let table = self.table(heading);
        let found =
            table.iter().find(|row| row.first().is_some_and(|cell| cell.starts_with(label)));
        found.unwrap_or_else(|| panic!("no row {label:?} below {heading:?}: {table:?}")).clone()
    }

    /// The list below a heading.
    fn list(&self, heading: &str) -> Vec<String> {
        let below = self.html.split(&format!(">{heading}</h")[..]).nth(1).expect(heading);
        let list = below.split("</ul>").next().unwrap_or("");
        elements(list, "li").into_iter().map(plain).collect()
    }

    /// The drawing of a figure, as text, with its caption.
    fn figure(&self, id: &str) -> String {
        let below = self.html.split(&format!("<figure id=\"{id}\">")[..]).nth(1).expect(id);
        below.split("</figure>").next().unwrap_or("").to_owned()
    }
}

/// Twelve points of a reviewer, and that every figure names its bounds of friction.
#[test]
fn a_reviewer_finds_what_is_asked_for() {
    let sheet = sheet();
    let files =
        [FileNote { path: "hospital.toml", sha256: "0123456789abcdef01", description: "model" }];
    let provenance = Provenance { command_line: "slipstick run", files: &files, inputs: &[] };
    let page = Page { html: sheet.to_html(&provenance) };

    // 1. The title block.
    let title = page.html.split("<dl class=\"title\">").nth(1).expect("a title block");
    let title = title.split("</dl>").next().expect("its end");
    let entries: Vec<(String, String)> = elements(title, "dt")
        .into_iter()
        .map(plain)
        .zip(elements(title, "dd").into_iter().map(plain))
        .collect();
    let of = |name: &str| &entries.iter().find(|(known, _)| known == name).expect(name).1;
    assert_eq!((&of("Project")[..], &of("Author")[..]), ("General <Hospital>", "A. Engineer"));
    assert_eq!(of("Date"), "14 March");
    assert!(of("Program").starts_with("Slipstick ") && of("Hash of the model").len() >= 8);
    assert_eq!(of("SHA-256 of its file"), "hospital.toml 0123456789abcdef…");

    // 2. The verdict in one line, with the row that governs.
    let lead =
        plain(elements(&page.html, "p class=\"lead\"").first().copied().unwrap_or_else(|| {
            page.html
                .split("<p class=\"lead\">")
                .nth(1)
                .expect("a lead")
                .split("</p>")
                .next()
                .expect("its end")
        }));
    assert!(lead.starts_with("Code: MCE_R: ASCE/SEI 7-22:"), "{lead}");
    assert!(
        lead.contains("Governing, demand over capacity") && lead.contains("friction"),
        "{lead}"
    );

    // 3. A row for each requirement: demand, capacity, ratio, or why it is not judged.
    let rules = page.table("Requirements of ASCE/SEI 7-22 at MCE_R");
    assert_eq!(rules[0], ["Requirement", "Clause", "Demand", "Capacity", "Ratio", "OK"]);
    for row in &rules[1..] {
        let judged = row[4].parse::<f64>().is_ok() && !row[2].is_empty() && !row[3].is_empty();
        assert!(row.len() == 6 && !row[1].is_empty(), "{row:?}");
        assert!(judged != row[5].starts_with("not judged: "), "{row:?}");
    }
    let wind =
        page.row("Requirements of ASCE/SEI 7-22 at MCE_R", "V_s at least the factored design wind");
    assert!(wind[5].starts_with("not judged: V_wind is not given"), "{wind:?}");

    // 4. Two intensities side by side.
    let each = page.table("Mean at each intensity");
    assert_eq!(each[0], ["", "MCE_R", "DE"]);
    let peaks = page.row("Mean at each intensity", "Peak sliding displacement");
    assert!(
        peaks[1..].iter().all(|cell| cell.ends_with("friction)") || cell.ends_with(')')),
        "{peaks:?}"
    );
    page.row("Demand and capacity at DE", "Gap, demand with torsion × ");
    assert!(page.html.contains("Code: DE: ASCE/SEI 7-22: no requirement of its own."));

    // 5. Torsion is applied to the displacement of the runs, before it is compared with the gap.
    let gap = page.row("Demand and capacity", "Gap, demand with torsion × ");
    let runs = page.row("Equivalent lateral force", "with torsion × ");
    assert!(runs[1..].contains(&gap[1]), "{gap:?} {runs:?}");
    let headline = page.html.split("Governs: ").nth(1).expect("a headline");
    let headline = plain(headline.split("</p>").next().expect("its end"));
    assert!(
        headline.contains(&format!("{} mm", gap[1])) && headline.contains(&gap[4]),
        "{headline}"
    );
    let of_code = page.row("Values of ASCE/SEI 7-22", "Displacement of the runs times");
    assert!(of_code.iter().any(|cell| *cell == format!("{} mm", gap[1])), "{of_code:?} {gap:?}");

    // 6. What is not modelled.
    let missing = page.list("What is not modelled");
    for what in ["Torsion", "uplift", "Single isolators", "Yielding", "Wind"] {
        assert!(missing.iter().any(|line| line.contains(what)), "{what}: {missing:?}");
    }

    // 7. V_b and the base shear, each over a weight by its name, and 8. overturning with its axial range; in two directions.
    let forces = page.table("Forces at the base");
    let labels: Vec<&str> = forces.iter().map(|row| &row[0][..]).collect();
    for axis in ["x", "y"] {
        for label in [
            format!("Force of the isolators V_b, {axis} (MN)"),
            format!("Shear of the structure above the block, {axis} (MN)"),
            format!("Overturning moment over W width/2, {axis}"),
        ] {
            assert!(labels.contains(&&label[..]), "{label}: {labels:?}");
        }
    }
    for (label, count) in [
        ("over the whole weight W = 34.81 MN", 4),
        ("over the weight above the block W_s = 25.99 MN", 2),
        ("axial range of isolators in rows at both edges, over the mean", 2),
        ("axial range of isolators spread evenly, over the mean", 2),
    ] {
        assert_eq!(labels.iter().filter(|known| **known == label).count(), count, "{labels:?}");
    }

    // 9. All storeys by name, over the height.
    for demand in ["Peak acceleration", "Peak displacement", "Peak drift ratio"] {
        let table = page.table(&format!("{demand} over the height"));
        let levels: Vec<&str> = table[1..].iter().map(|row| &row[0][..]).collect();
        assert_eq!(levels[..4], ["Roof", "Third", "Second", "First"], "{demand}");
    }
    let profiles = page.figure("profiles");
    assert!(profiles.contains("Third") && profiles.contains("Roof"));

    // 10. |s| on an axis that starts at 0.
    let drawn = sheet.figures.iter().find(|figure| figure.id == "histories").expect("histories");
    assert_eq!(drawn.figure.panels[0].y.min, 0.0);
    assert!(page.figure("histories").contains("|s|"));

    // 11. Every figure says of which bound its lines are; that of the target spectrum has none.
    for figure in sheet.figures.iter().filter(|figure| figure.id != "target") {
        let text = page.figure(&figure.id);
        assert!(text.contains("friction"), "{}", figure.id);
    }
    for bound in ["lower friction", "nominal friction", "upper friction"] {
        for id in ["shares", "profiles"] {
            assert!(page.figure(id).contains(bound), "{id}: {bound}");
        }
    }

    // 12. Notices of a kind are one line.
    let noticed = page.list("What was noticed of the records");
    let coarse: Vec<&String> =
        noticed.iter().filter(|line| line.starts_with("coarse sampling")).collect();
    assert_eq!(coarse.len(), 1, "{noticed:?}");
    assert!(coarse[0].contains("STATION_0") && coarse[0].contains("STATION_20"), "{coarse:?}");
}

/// Print: heads of tables on every page, headings with what they head, short tables whole, words whole.
#[test]
fn the_page_prints_without_orphans() {
    let html = sheet().to_html(&Provenance { command_line: "", files: &[], inputs: &[] });
    let style = html.split("<style>").nth(1).and_then(|rest| rest.split("</style>").next());
    let style = style.expect("a style");
    let print = style.split("@media print").nth(1).expect("rules of print");
    for rule in [
        "thead { display: table-header-group; }",
        "h2, h3, caption { break-after: avoid; }",
        ".short",
        "break-inside: avoid;",
    ] {
        assert!(print.contains(rule), "{rule}");
    }
    assert!(style.contains("tbody th, td, th { overflow-wrap: break-word; }"));
    // Every table but lists of names has its heads in a head.
    for table in elements(&html, "table") {
        assert!(table.contains("<thead>") || table.contains("<caption>"), "{}", plain(table));
    }
}
