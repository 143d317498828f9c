//! A result laid out: tables, figures, notes.

use std::fmt::Display;

use slipstick::assessment::FailedRun;
use slipstick::assessment::suite::Recorded;
use slipstick::notice::{Notice, NoticeKind};
use slipstick::study::{Certified, travel_used_up};
use slipstick::units::STANDARD_GRAVITY_M_PER_S2;

use crate::VERSION;
use crate::display::DisplayUnits;
use crate::figures::Drawn;
use crate::html::{Frame, document, figure_list, inputs, name_table, number_table, warning_list};
use crate::json::{joined, pretty};
use crate::laboratory::text::{aligned, field, wrapped};
use crate::markup::Markup;
use crate::markup::shortened;
use crate::number::typeset_sentence;
use crate::report::{FileNote, Provenance};
use crate::summary::keys::{certified_keys, listed, suite};
use crate::view;

/// A heading and a table: the first row are heads, the first column names.
pub type SheetTable = (String, Vec<Vec<String>>);

/// A result as people and programs read it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sheet {
    /// What it is, above the name: `Incremental dynamic analysis`.
    pub kind: &'static str,
    /// Name of the model, or of what was measured.
    pub name: String,
    /// What stands before the name in a text; `Model` where it is empty.
    pub named: &'static str,
    /// Hash of the model, where it is of one.
    pub model_hash: Option<String>,
    /// The records that it is of.
    pub suite: Vec<Recorded>,
    /// What stands before all else, where a reader must know it first: a name and a sentence.
    pub first: Option<(&'static str, String)>,
    /// What is said of it by the rules of others, a name and a sentence each.
    pub verdicts: Vec<(&'static str, String)>,
    /// What was done, in a line.
    pub line: String,
    /// The answer in sentences, the shortest first: what the page begins with.
    pub verdict: Vec<String>,
    /// Units of the quantities in warnings.
    pub display: DisplayUnits,
    /// All that a reader must know.
    pub warnings: Vec<Notice>,
    /// The run that each of the first warnings is of, where there are several of one record.
    pub of_runs: Vec<Option<&'static str>>,
    /// Whether the answer must not be used.
    pub failed: bool,
    /// Tables that stand before the figures, where some do.
    pub first_tables: Vec<SheetTable>,
    /// The tables, the one that answers first.
    pub tables: Vec<SheetTable>,
    /// A heading and lines in small print that the page alone shows, at its end.
    pub formulas: Option<(String, Vec<String>)>,
    /// Names and values that the page alone shows, at its end; without heads.
    pub appendix: Vec<SheetTable>,
    /// Keys of a model, with what stands over them.
    pub keys: Option<(&'static str, String)>,
    /// Sentences below the tables.
    pub notes: Vec<String>,
    /// Drawings.
    pub figures: Vec<Drawn>,
    /// How it was found and what that leaves out, a sentence or two each.
    pub method: Vec<String>,
    /// What is not modelled, a sentence or two each.
    pub not_modelled: Vec<String>,
    /// What the title block has besides version and hashes: `project`, `author`, `date`.
    pub title: Vec<(&'static str, String)>,
    /// Sections that the page has besides, and what stands first in its appendix.
    pub(crate) laid_out: [Markup; 2],
    /// How many of its runs were certified; none where that is not known.
    pub certified: Option<Certified>,
    /// Whether every run has an answer whose certificate holds, and what was looked for is found.
    pub complete: bool,
    /// The object whose members `--json` prints between the version and the warnings.
    pub json: String,
}

impl Sheet {
    /// The same with what came of certifying some of its runs: what the check does not confirm is said first, and
    /// with it the answer is not complete.
    #[must_use]
    pub fn certified(mut self, certified: Option<Certified>) -> Self {
        let refusal = certified.as_ref().and_then(Certified::refusal);
        let is_said = self.warnings.iter().any(|known| known.kind == NoticeKind::CheckFailed);
        if let Some(notice) = certified.as_ref().and_then(Certified::notice).filter(|_| !is_said) {
            self.warnings.insert(0, notice);
        }
        if let Some(refusal) = refusal {
            (self.failed, self.complete) = (true, false);
            if !is_said {
                self.verdict.insert(0, format!("{refusal}."));
            }
        }
        self.certified = certified;
        self
    }

    /// The result as plain text for a terminal.
    #[must_use]
    pub fn to_text(&self) -> String {
        let mut text = String::new();
        for (name, sentence) in self.first.iter().chain(&self.verdicts) {
            text.push_str(&field(name, sentence));
        }
        let hash = self.model_hash.iter().map(|hash| format!("  (model {hash})"));
        let named = if self.named.is_empty() { "Model" } else { self.named };
        text.push_str(&field(named, &format!("{}{}", self.name, hash.collect::<String>())));
        text.push_str(&field("Analysis", &format!("{}. {}", self.kind, self.line)));
        if let Some(certified) = &self.certified {
            text.push_str(&field("Checked", &format!("{certified}.")));
        }
        for (heading, rows) in self.first_tables.iter().chain(&self.tables) {
            text.push_str(&format!("\n{heading}\n"));
            text.push_str(&aligned(&wrapped(rows)));
        }
        if let Some((heading, keys)) = &self.keys {
            text.push_str(&format!("\n{heading}\n{keys}"));
        }
        if !self.notes.is_empty() {
            text.push('\n');
        }
        for note in &self.notes {
            text.push_str(&field("", note));
        }
        for warning in &self.warnings {
            text.push('\n');
            text.push_str(&field(
                warning.label(),
                &format!("{}: {}", warning.kind, self.display.sentence(&warning.message)),
            ));
        }
        text
    }

    /// The object that `--json` prints, indented.
    #[must_use]
    pub fn to_json(&self) -> String {
        let hash = self.model_hash.as_ref().map(|model_hash| view! { model_hash });
        let certified = self.certified.as_ref().map(certified_keys);
        let suite = (!self.suite.is_empty()).then(|| suite(&self.suite));
        let head = view! { slipstick: VERSION, #[serde(flatten)] hash };
        let tail = view! {
            #[serde(flatten)] certified: certified.map(|certified| view! { certified }),
            #[serde(flatten)] suite: suite.map(|suite| view! { suite }),
            warnings: listed(&self.warnings, false),
            notes: listed(&self.warnings, true),
        };
        joined(&[&pretty(&head), &self.json, &pretty(&tail)])
    }

    /// What was noticed of each record, where several kinds or records would hide it above.
    fn noticed(&self, out: &mut Markup) {
        if self.suite.iter().all(|on| on.notices.is_empty()) {
            return;
        }
        // One line a kind, with all records that gave it.
        let mut kinds: Vec<(&Notice, Vec<&str>)> = Vec::new();
        for on in &self.suite {
            for notice in &on.notices {
                match kinds.iter_mut().find(|(known, _)| known.kind == notice.kind) {
                    Some((_, names)) if names.last() == Some(&&on.name[..]) => {}
                    Some((_, names)) => names.push(&on.name),
                    None => kinds.push((notice, vec![&on.name])),
                }
            }
        }
        kinds.sort_by_key(|(notice, _)| core::cmp::Reverse(notice.severity()));
        out.raw("<h3>What was noticed of the records</h3>\n<ul>\n");
        for (notice, names) in kinds {
            let label = notice.severity().name();
            out.raw("<li>").element("strong", notice.kind.words()).text(format!(
                " ({label}): {}. The first: {}",
                names.join(", "),
                typeset_sentence(&self.display.sentence(&notice.message))
            ));
            out.raw("</li>\n");
        }
        out.raw("</ul>\n");
    }

    /// Project, author and date as they are given, then what made the page: names and values; nothing where none is given.
    fn title_block(&self, provenance: &Provenance) -> Vec<(&'static str, String)> {
        if self.title.is_empty() {
            return Vec::new();
        }
        let named = |(name, text): &(&'static str, String)| {
            let name = match *name {
                "project" => "Project",
                "author" => "Author",
                "date" => "Date",
                other => other,
            };
            (name, text.clone())
        };
        let version = ("Program", format!("Slipstick {VERSION}"));
        let model = self.model_hash.iter().map(|hash| ("Hash of the model", hash.clone()));
        let file = |file: &FileNote<'_>| {
            let hash: String = file.sha256.chars().take(16).collect();
            ("SHA-256 of its file", format!("{} {hash}…", file.path))
        };
        let models = provenance.files.iter().filter(|file| file.description == "model").map(file);
        self.title.iter().map(named).chain([version]).chain(model).chain(models).collect()
    }

    /// The first figure and table, which answer, and the rest, which supports them.
    fn answers(&self, out: &mut Markup) {
        let Self { figures, first_tables, tables, notes, keys, .. } = self;
        if figures.is_empty() && tables.is_empty() && notes.is_empty() && keys.is_none() {
            return;
        }
        let (figure, figures) = figures.split_at(figures.len().min(1));
        let (table, tables) = tables.split_at(tables.len().min(1));
        out.raw("<section>\n");
        table_list(out, first_tables);
        figure_list(out, figure, 1);
        table_list(out, table);
        for note in notes {
            out.element("p", typeset_sentence(note)).raw("\n");
        }
        if let Some((heading, keys)) = keys {
            out.element("h3", heading).raw("\n").element("pre", keys).raw("\n");
        }
        figure_list(out, figures, 2);
        table_list(out, tables);
        out.raw("</section>\n");
    }

    /// One self-contained HTML page that prints on A4.
    #[must_use]
    pub fn to_html(&self, provenance: &Provenance) -> String {
        let mut body = Markup::new();
        // What others require stands before what was found.
        let first = self.verdicts.iter().chain(&self.first);
        let first = first.map(|(name, sentence)| format!("{name}: {sentence}"));
        let failed = if self.failed { " failed" } else { "" };
        body.raw("<section class=\"verdict").raw(failed).raw("\">\n");
        for (i, sentence) in self.verdict.iter().cloned().chain(first).enumerate() {
            body.raw(if i == 0 { "<p class=\"lead\">" } else { "<p>" })
                .text(typeset_sentence(&sentence))
                .raw("</p>\n");
        }
        body.raw("</section>\n");
        let of_runs = self.of_runs.iter().copied().chain(core::iter::repeat(None));
        let warnings: Vec<_> = of_runs.zip(&self.warnings).collect();
        warning_list(&mut body, &warnings, self.display);
        self.answers(&mut body);
        let closing = self.closing(provenance);
        let short = closing.as_str().len() <= SHORT_CLOSING;
        body.raw(if short { "<div class=\"closing\">\n" } else { "" })
            .append(&closing)
            .raw(if short { "</div>\n" } else { "" });
        let hash = self.model_hash.iter().map(|hash| format!(", model {hash}"));
        document(&Frame {
            kind: self.kind,
            name: &self.name,
            title: &self.title_block(provenance),
            line: &format!("Slipstick {VERSION}{}. {}", hash.collect::<String>(), self.line),
            command_line: provenance.command_line,
            body: &body,
        })
    }

    /// What follows the answers: how they were found, what is not modelled, and the appendix.
    fn closing(&self, provenance: &Provenance) -> Markup {
        let mut body = Markup::new();
        let certified =
            self.certified.iter().map(|certified| format!("Certificates: {certified}."));
        let method: Vec<String> = certified.chain(self.method.iter().cloned()).collect();
        if !method.is_empty() {
            body.raw("<section>\n<h2>Method and limits</h2>\n<ul>\n");
            for line in &method {
                body.element("li", typeset_sentence(line)).raw("\n");
            }
            body.raw("</ul>\n</section>\n");
        }
        if !self.not_modelled.is_empty() {
            body.raw("<section>\n<h2>What is not modelled</h2>\n<ul>\n");
            for line in &self.not_modelled {
                body.element("li", line).raw("\n");
            }
            body.raw("</ul>\n</section>\n");
        }
        let [sections, appendix] = &self.laid_out;
        body.append(sections);
        body.raw("<section class=\"appendix\">\n<h2>Appendix</h2>\n").append(appendix);
        for (heading, rows) in &self.appendix {
            let pairs = rows.iter().filter_map(|row| match row.as_slice() {
                [name, value] => Some((name.as_str(), value.clone())),
                _ => None,
            });
            name_table(&mut body, heading, &pairs.collect::<Vec<_>>());
        }
        if let Some((heading, lines)) = &self.formulas {
            body.element("h3", heading).raw("\n<ul class=\"formulas\">\n");
            lines.iter().for_each(|line| {
                body.element("li", line).raw("\n");
            });
            body.raw("</ul>\n");
        }
        self.noticed(&mut body);
        inputs::provenance(&mut body, provenance);
        body.raw("</section>\n");
        body
    }
}

/// Records: what their files say of them, factors where each has one, and peaks; nothing without records.
pub(crate) fn record_table(records: &[Recorded]) -> Option<Vec<Vec<String>>> {
    let known = ["Earthquake", "Station", "Component", "Azimuth"].into_iter();
    let said: Vec<_> = records.iter().map(|on| on.origin.said()).collect();
    let known = known.filter(|name| said.iter().flatten().any(|(other, _)| other == name));
    let known: Vec<&str> = known.collect();
    let factors = records.iter().any(|on| on.factor.is_some());
    let in_plane = records.iter().any(|on| on.origin.along_y.is_some());
    let peak = match (factors, in_plane) {
        (true, false) => "PGA (g)",
        (true, true) => "PGA, resultant (g)",
        (false, false) => "PGA as recorded (g)",
        (false, true) => "PGA as recorded, resultant (g)",
    };
    let heads = core::iter::once("Record").chain(known.iter().copied());
    let heads = heads.chain(factors.then_some("Factor")).chain([peak]);
    let row = |(on, said): (&Recorded, &Vec<(&str, String)>)| -> Vec<String> {
        let of = |name: &&str| said.iter().find(|(other, _)| other == name);
        let origin = known
            .iter()
            .map(|name| of(name).map_or("—".to_owned(), |(_, text)| shortened(text, 28)));
        let factor = factors.then(|| cell(on.factor.unwrap_or(f64::NAN)));
        let pga = cell(on.pga_m_per_s2 / STANDARD_GRAVITY_M_PER_S2);
        core::iter::once(on.name.clone()).chain(origin).chain(factor).chain([pga]).collect()
    };
    let heads = heads.map(str::to_owned).collect();
    let rows = records.iter().zip(&said).map(row);
    (!records.is_empty()).then(|| core::iter::once(heads).chain(rows).collect())
}

fn table_list(out: &mut Markup, tables: &[SheetTable]) {
    // Narrow tables after each other stand beside each other in print.
    for run in tables.chunk_by(|a, b| is_narrow(&a.1) && is_narrow(&b.1)) {
        let beside = run.len() > 1;
        out.raw(if beside { "<div class=\"tables\">\n" } else { "" });
        for (heading, rows) in run {
            out.raw(if beside { "<div>\n" } else { "" });
            out.element("h3", heading).raw("\n");
            number_table(out, rows);
            out.raw(if beside { "</div>\n" } else { "" });
        }
        out.raw(if beside { "</div>\n" } else { "" });
    }
}

/// Whether a table is of few columns of numbers under short names, and of rows that one column of a page holds.
fn is_narrow(rows: &[Vec<String>]) -> bool {
    let short = |row: &Vec<String>| {
        let width = |(i, cell): (usize, &String)| {
            cell.chars().count() <= if i == 0 { MOST_NAME } else { MOST_NUMBER }
        };
        row.len() <= 5 && row.iter().enumerate().all(width)
    };
    rows.len() <= MOST_ROWS && rows.iter().all(short)
}

/// Bytes of what follows the answers up to which it stands on one page, so that none has the command alone.
const SHORT_CLOSING: usize = 5000;

/// Rows that one column of a printed page holds, with room to spare.
const MOST_ROWS: usize = 60;

/// Characters of names and of numbers in tables that stand beside each other.
const MOST_NAME: usize = 40;
const MOST_NUMBER: usize = 12;

/// A number of a table: four digits, or a dash where there is none.
pub(crate) fn cell(value: f64) -> String {
    if value.is_finite() { crate::number::significant(value, 4) } else { "—".to_owned() }
}

/// Runs without an answer, of so many, as one warning.
pub(super) fn failed(runs: &[FailedRun], of: u64, count_as: &str) -> Option<Notice> {
    let first = runs.first()?;
    let message =
        format!("{} of {of} runs have no answer and {count_as}; the first: {first}", runs.len());
    Some(Notice::new(NoticeKind::FailedRuns, message))
}

/// What runs without an answer count as where demands are counted or put in order.
pub(super) fn counted_as(runs: &[FailedRun]) -> String {
    let beyond = travel_used_up(runs);
    match (beyond, runs.len() - beyond) {
        (0, _) => "are left out".to_owned(),
        (_, 0) => "used up their travel: their sliding displacement exceeds every limit up to it, all else of them is \
                   left out"
            .to_owned(),
        (_, left) => format!(
            "are left out ({left}) or used up their travel ({beyond}: their sliding displacement exceeds every limit \
             up to it)"
        ),
    }
}

/// A heading for a list of warnings from the messages of runs: each message once, with its count.
pub(super) fn counted(kind: NoticeKind, messages: &[impl Display]) -> Option<Notice> {
    let first = messages.first()?;
    let more = match messages.len() - 1 {
        0 => String::new(),
        more => format!(" (and {more} more)"),
    };
    Some(Notice::new(kind, format!("{first}{more}")))
}
