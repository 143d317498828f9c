//! Identified parameters: what the three jobs have in common.

use slipstick::laboratory::estimate::{Estimate, Outcome};
use slipstick::laboratory::identify::{Found, Identified, cyclic_histories};
use slipstick::laboratory::measured::Measured;
use slipstick::notice::Notice;

use super::compare::number_table;
use super::text::{aligned, field};
use super::{cyclic, free_vibration, shaking_table};
use crate::VERSION;
use crate::display::{DisplayUnits, Quantity};
use crate::figures::Drawn;
use crate::html::{self, Frame, inputs, name_table, warning_list};
use crate::json::Json;
use crate::markup::Markup;
use crate::number::{fixed, significant};
use crate::report::{FileNote, InputText};
use crate::summary::keys::listed;

/// What stands over the keys of a model.
const FOR_MODEL: &str = "For the model file";

/// What was identified, and from what.
#[derive(Clone, Debug)]
pub struct IdentifyReport<'a> {
    /// The job: `cyclic`, `free-vibration` or `shaking-table`.
    pub job: &'static str,
    /// The measured files.
    pub measured: String,
    /// The estimates.
    pub estimates: Vec<Estimate>,
    /// Other figures, by name.
    pub facts: Vec<(&'static str, String)>,
    /// Tables with their captions; the first row holds the heads.
    pub tables: Vec<(String, Vec<Vec<String>>)>,
    /// The table `[slider]` of a model with what was told; only of cyclic tests.
    pub slider_keys: Option<String>,
    /// What the intervals assume.
    pub assumption: String,
    /// Keys of the JSON object that only this job has.
    pub json: Vec<(&'static str, Json)>,
    /// The figures of the page.
    pub figures: Vec<Drawn>,
    /// What was noticed.
    pub warnings: Vec<Notice>,
    /// Texts that people wrote: model and mapping.
    pub inputs: &'a [InputText<'a>],
    /// Files read, with their hashes.
    pub files: &'a [FileNote<'a>],
    /// The command as it was typed.
    pub command_line: &'a str,
    /// Units to show results in.
    pub display: DisplayUnits,
}

/// A value and its unit as a person reads them: `[value, low, high]` and the unit.
fn shown(display: DisplayUnits, unit: &'static str, values: [f64; 3]) -> ([String; 3], String) {
    let largest = values.into_iter().fold(0.0, |m: f64, v| m.max(v.abs()));
    let quantity = match unit {
        "N/m" => Some(Quantity::Stiffness),
        "N s/m" => Some(Quantity::Damping),
        "N" => Some(Quantity::Force),
        "m" => Some(Quantity::Length),
        "kg" => Some(Quantity::Mass),
        _ => None,
    };
    let (factor, symbol) = match (quantity, unit) {
        (Some(quantity), _) => {
            let unit = display.unit(quantity, largest);
            (unit.in_si, unit.symbol)
        }
        (None, "rad") => (1e-3, "mrad"),
        (None, unit) => (1.0, unit),
    };
    // The interval says how many digits mean something: two of its own.
    let width = (values[2] - values[1]).abs() / factor;
    let digits = |value: f64| {
        let value = value / factor;
        if !(width > 0.0 && width.is_finite()) {
            return significant(value, 4);
        }
        let decimals = (1.0 - libm::floor(libm::log10(width))).max(0.0) as usize;
        if decimals <= 9 && value.abs() < 1e6 {
            fixed(value, decimals)
        } else {
            significant(value, 4)
        }
    };
    (values.map(digits), symbol.to_owned())
}

impl IdentifyReport<'_> {
    /// Of what was identified from measured files; what went in is left to the caller.
    #[must_use]
    pub fn of(measured: &[Measured], identified: &Identified, display: DisplayUnits) -> Self {
        let names: Vec<&str> = measured.iter().map(|m| m.source_name.as_str()).collect();
        let report = Self {
            job: "",
            measured: names.join(", "),
            estimates: identified.estimates.clone(),
            facts: Vec::new(),
            tables: Vec::new(),
            slider_keys: identified.slider_keys(),
            assumption: String::new(),
            json: Vec::new(),
            figures: Vec::new(),
            warnings: identified.warnings.clone(),
            inputs: &[],
            files: &[],
            command_line: "",
            display,
        };
        match &identified.found {
            Found::Cyclic { fits, together, normal_force_n } => {
                let tests = measured.iter().zip(fits).filter_map(|(measured, fit)| {
                    let [displacement, force] = cyclic_histories(measured).ok()?;
                    let (displacement_m, force_n) = (&displacement.values, &force.values);
                    let name = measured.source_name.as_str();
                    Some(cyclic::Test { name, displacement_m, force_n, fit })
                });
                let tests: Vec<cyclic::Test<'_>> = tests.collect();
                let normal_n = *normal_force_n;
                let mut tables =
                    vec![("Cycle by cycle".to_owned(), cyclic::table(&tests, normal_n))];
                let friction = together.rate.as_ref().map(|rate| {
                    let limit = identified.estimates.iter().find(|e| e.path.contains("static"));
                    cyclic::by_speed(
                        &tests,
                        rate,
                        limit.and_then(Estimate::value),
                        normal_n,
                        display,
                    )
                });
                let mut json = cyclic::json(&tests, together);
                let keys = report.slider_keys.as_deref();
                json.push(("slider_keys", keys.map_or(Json::Null, Json::from)));
                if tests.len() > 1 {
                    let unit = if normal_n.is_some() { "" } else { " (N)" };
                    let rows = cyclic::by_test(&tests, normal_n);
                    tables.insert(0, (format!("Test by test{unit}"), rows));
                }
                Self {
                    job: "cyclic",
                    json,
                    facts: cyclic::facts(&tests, normal_n),
                    tables,
                    assumption: cyclic::assumption(together.rate.is_some()),
                    figures: friction.into_iter().chain(cyclic::figures(&tests, display)).collect(),
                    ..report
                }
            }
            Found::FreeVibration { channel, times_s, values, fit } => {
                let span_s = [times_s.first(), times_s.last()].map(|t| t.copied().unwrap_or(0.0));
                Self {
                    job: "free-vibration",
                    facts: free_vibration::facts(*channel, span_s, fit),
                    assumption: free_vibration::ASSUMPTION.to_owned(),
                    json: free_vibration::json(*channel, span_s, fit),
                    figures: free_vibration::figures(*channel, times_s, values, fit, display),
                    ..report
                }
            }
            Found::ShakingTable { fit, parameters, seed } => {
                let (rows, figures) = shaking_table::agreement(fit, &report.measured, display);
                Self {
                    job: "shaking-table",
                    facts: shaking_table::facts(fit, display),
                    tables: vec![("Agreement with the best values".to_owned(), rows)],
                    assumption: shaking_table::assumption(fit),
                    json: shaking_table::json(fit, parameters, *seed),
                    figures,
                    ..report
                }
            }
        }
    }

    /// Whether the data tell every parameter.
    #[must_use]
    pub fn all_told(&self) -> bool {
        self.estimates.iter().all(|estimate| estimate.value().is_some())
    }

    /// Parameter, value, interval, unit; the first row holds the heads.
    fn rows(&self) -> Vec<Vec<String>> {
        let heads = ["Parameter", "Value", "95 % from", "to", "Unit"].map(str::to_owned);
        let told = self.estimates.iter().filter_map(|estimate| match estimate.outcome {
            Outcome::Told { value, low, high } => {
                let ([value, low, high], unit) =
                    shown(self.display, estimate.unit, [value, low, high]);
                Some(vec![estimate.path.clone(), value, low, high, unit])
            }
            Outcome::CannotTell { .. } => None,
        });
        core::iter::once(heads.to_vec()).chain(told).collect()
    }

    /// One sentence a parameter that the data do not tell.
    #[must_use]
    pub fn refusals(&self) -> Vec<String> {
        let refusal = |estimate: &Estimate| Some(format!("{}: {}", estimate.path, estimate.why()?));
        self.estimates.iter().filter_map(refusal).collect()
    }

    /// What the data determine, with its intervals, and what they do not: what the page begins with.
    #[must_use]
    pub fn verdict(&self) -> Vec<String> {
        const NAMED: usize = 4;
        let told: Vec<String> = self
            .estimates
            .iter()
            .filter_map(|estimate| {
                let (value, [low, high]) = (estimate.value()?, estimate.interval()?);
                let ([value, low, high], unit) =
                    shown(self.display, estimate.unit, [value, low, high]);
                let unit = if unit.is_empty() { unit } else { format!(" {unit}") };
                Some(format!("{} = {value}{unit} (95 %: {low} to {high})", estimate.path))
            })
            .collect();
        let all = self.estimates.len();
        let parameters = if all == 1 { "parameter" } else { "parameters" };
        let more = match told.len().saturating_sub(NAMED) {
            0 => String::new(),
            more => format!(" and {more} more"),
        };
        let named = format!("{}{more}", told[..told.len().min(NAMED)].join(", "));
        let first = match told.len() {
            0 => return vec![format!("The data do not determine any of {all} {parameters}.")],
            count if count == all => format!("Determined: {named}."),
            count => format!("{count} of {all} {parameters} determined: {named}."),
        };
        let missing = self.estimates.iter().filter(|estimate| estimate.value().is_none());
        let missing: Vec<&str> = missing.map(|estimate| estimate.path.as_str()).collect();
        let second = format!("Not determined by the data: {}.", missing.join(", "));
        std::iter::once(first).chain((!missing.is_empty()).then_some(second)).collect()
    }

    /// The table that a person reads.
    #[must_use]
    pub fn table(&self) -> String {
        let mut text = format!("identify {}  (slipstick {})\n", self.job, VERSION);
        text.push_str(&field("Measured", &self.measured));
        for (name, fact) in &self.facts {
            text.push_str(&field("", &format!("{name}: {fact}")));
        }
        let rows = self.rows();
        if rows.len() > 1 {
            text.push('\n');
            text.push_str(&aligned(&rows));
        }
        let refusals = self.refusals();
        if !refusals.is_empty() {
            text.push_str("\nNot determined by the data:\n");
            for refusal in refusals {
                text.push_str(&field("", &refusal));
            }
        }
        for (caption, rows) in &self.tables {
            text.push_str(&format!("\n{caption}\n{}", aligned(rows)));
        }
        if let Some(keys) = &self.slider_keys {
            text.push_str(&format!("\n{FOR_MODEL}\n{keys}"));
        }
        text.push('\n');
        text.push_str(&field("Interval", &self.assumption));
        for warning in &self.warnings {
            text.push_str(&field(
                warning.label(),
                &format!("{}: {}", warning.kind, self.display.sentence(&warning.message)),
            ));
        }
        text
    }

    /// The object that `--json` prints.
    #[must_use]
    pub fn to_json(&self) -> String {
        let mut keys: Vec<(&'static str, Json)> = vec![
            ("slipstick", VERSION.into()),
            ("job", self.job.into()),
            ("measured", self.measured.as_str().into()),
            ("confidence", 0.95.into()),
            ("estimates", Json::List(self.estimates.iter().map(estimate_json).collect())),
        ];
        keys.extend(self.json.iter().cloned());
        keys.push(("warnings", listed(&self.warnings, false)));
        keys.push(("notes", listed(&self.warnings, true)));
        Json::Object(keys).to_pretty()
    }

    /// One self-contained page.
    #[must_use]
    pub fn to_html(&self) -> String {
        let mut body = Markup::new();
        body.raw("<section class=\"verdict\">\n");
        for (i, sentence) in self.verdict().iter().enumerate() {
            body.raw(if i == 0 { "<p class=\"lead\">" } else { "<p>" })
                .text(sentence.replace('-', "−"))
                .raw("</p>\n");
        }
        body.raw("</section>\n");
        let warnings: Vec<_> = self.warnings.iter().map(|warning| (None, warning)).collect();
        warning_list(&mut body, &warnings, self.display);
        body.raw("<section>\n<h2>Parameters</h2>\n");
        number_table(&mut body, &self.rows());
        let refusals = self.refusals();
        if !refusals.is_empty() {
            body.raw("<h3>Not determined by the data</h3>\n<ul>\n");
            for refusal in refusals {
                body.element("li", refusal).raw("\n");
            }
            body.raw("</ul>\n");
        }
        body.raw("<p>").text(&self.assumption).raw("</p>\n");
        if let Some(keys) = &self.slider_keys {
            body.element("h3", FOR_MODEL).raw("\n");
            body.element("pre", keys).raw("\n");
        }
        body.raw("</section>\n");
        html::figure_section(&mut body, "Figures", &self.figures, 1);
        body.raw("<section>\n<h2>Details</h2>\n");
        let facts: Vec<(&str, String)> =
            self.facts.iter().map(|(name, fact)| (*name, fact.clone())).collect();
        name_table(&mut body, "Record and fit", &facts);
        for (caption, rows) in &self.tables {
            body.element("h3", caption).raw("\n");
            number_table(&mut body, rows);
        }
        body.raw("</section>\n");
        html::appendix(&mut body);
        inputs::provenance(&mut body, self.files, self.command_line, self.inputs);
        body.raw("</section>\n");
        html::document(&Frame {
            kind: "Parameters from a test",
            title_end: ": identified parameters",
            name: &self.measured,
            line: &format!("Slipstick {}, identify {}.", VERSION, self.job),
            command_line: self.command_line,
            body: &body,
        })
    }
}

/// An estimate as an object; numbers are null where the data do not tell it.
pub(super) fn estimate_json(estimate: &Estimate) -> Json {
    let interval = estimate.interval();
    Json::Object(vec![
        ("parameter", estimate.path.as_str().into()),
        ("unit", estimate.unit.into()),
        ("value", estimate.value().into()),
        ("low", interval.map(|[low, _]| low).into()),
        ("high", interval.map(|[_, high]| high).into()),
        ("cannot_tell", estimate.why().map_or(Json::Null, Json::from)),
    ])
}
