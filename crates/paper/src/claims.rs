//! The claims: their fixed facts, `claims.toml`, and the judgement of what was computed.

use std::collections::BTreeMap;

use toml::de::{DeTable, DeValue};

use crate::fill::{Value, Values, fill};
use crate::{Claim, PaperError, Verdict};

/// What the paper claims and when it agrees; the keys of the file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Facts {
    pub id: String,
    pub paper: Option<f64>,
    pub within: Option<f64>,
    section: String,
    claim: String,
    unit: String,
    band: [f64; 2],
    rule: String,
    why: String,
    differs: String,
}

/// What was computed for a claim.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Finding {
    id: String,
    /// `None` where a datum is missing.
    value: Option<f64>,
    within: Option<f64>,
    quoted: Values,
}

impl Finding {
    pub fn new(id: impl Into<String>, value: f64) -> Self {
        Self { value: Some(value), ..Self::unchecked(id) }
    }

    /// For a claim that rests on what the paper does not give.
    pub fn unchecked(id: impl Into<String>) -> Self {
        Self { id: id.into(), value: None, within: None, quoted: Vec::new() }
    }

    /// How near to the paper's number the value must be, where no file can say it.
    pub fn within(self, tolerance: f64) -> Self {
        Self { within: Some(tolerance), ..self }
    }

    /// What the claim's texts quote by a name.
    pub fn quoting(mut self, name: &str, value: impl Into<Value>) -> Self {
        self.quoted.push((name.to_owned(), value.into()));
        self
    }
}

/// The facts of all claims.
pub(crate) fn facts() -> Result<Vec<Facts>, PaperError> {
    read(include_str!("claims.toml"))
}

fn read(text: &str) -> Result<Vec<Facts>, PaperError> {
    let table = DeTable::parse(text)
        .map_err(|error| PaperError::text("claims.toml", "TOML", error.to_string()))?;
    let mut all = Vec::new();
    expand(table.into_inner(), &BTreeMap::new(), &mut all)?;
    Ok(all)
}

/// A table is a claim, or has a list of tables that share its other keys.
fn expand(
    table: DeTable<'_>,
    shared: &BTreeMap<String, String>,
    all: &mut Vec<Facts>,
) -> Result<(), PaperError> {
    let mut keys = shared.clone();
    let mut members = None;
    for (key, value) in table {
        let value = match value.into_inner() {
            DeValue::String(text) => text.split_whitespace().collect::<Vec<_>>().join(" "),
            DeValue::Float(number) => number.to_string(),
            DeValue::Integer(number) => number.to_string(),
            DeValue::Array(list) => {
                members = Some(list);
                continue;
            }
            _ => return Err(PaperError::text(key.get_ref(), "a text or a number", "neither")),
        };
        keys.insert(key.into_inner().into_owned(), value);
    }
    let Some(members) = members else {
        all.push(Facts::of(keys)?);
        return Ok(());
    };
    for member in members {
        match member.into_inner() {
            DeValue::Table(member) => expand(member, &keys, all)?,
            _ => return Err(PaperError::text("claims.toml", "a list of tables", "another")),
        }
    }
    Ok(())
}

impl Facts {
    fn of(mut keys: BTreeMap<String, String>) -> Result<Self, PaperError> {
        let mut take = |key: &str| keys.remove(key).unwrap_or_default();
        let (id, section, paper, unit) = (take("id"), take("section"), take("paper"), take("unit"));
        let (within, least, most) = (take("within"), take("least"), take("most"));
        let mut texts = ["claim", "rule", "why", "differs"].map(take);
        for (word, value) in keys {
            let placeholder = format!("{{{word}}}");
            if !texts.iter().any(|text| text.contains(&placeholder)) {
                return Err(PaperError::text(&id, format!("a place for {placeholder}"), "none"));
            }
            texts = texts.map(|text| text.replace(&placeholder, &value));
        }
        let [claim, mut rule, why, differs] = texts;
        if rule.is_empty() && !within.is_empty() {
            rule = format!("within {within} {unit} of the printed number").replace("  ", " ");
        }
        for (key, text) in [("id", &id), ("section", &section), ("claim", &claim), ("why", &why)] {
            if text.is_empty() {
                return Err(PaperError::text(&id, key, "none"));
            }
        }
        let number = |key: &str, text: &str| match text {
            "" => Ok(None),
            text => text.parse().map(Some).map_err(|_| PaperError::text(&id, key, text)),
        };
        let [least, most] = [number("least", &least)?, number("most", &most)?];
        let band = [least.unwrap_or(f64::NEG_INFINITY), most.unwrap_or(f64::INFINITY)];
        let (paper, within) = (number("paper", &paper)?, number("within", &within)?);
        Ok(Self { id, paper, within, section, claim, unit, band, rule, why, differs })
    }

    fn holds(&self, value: f64, within: Option<f64>) -> bool {
        // Half a unit itself still rounds to the printed digits, one way or the other.
        let near = |within: f64| {
            self.paper.is_some_and(|paper| (value - paper).abs() <= within * (1.0 + 1e-9))
        };
        let [least, most] = self.band;
        (least..=most).contains(&value) && within.or(self.within).is_none_or(near)
    }

    fn judged(&self, finding: Finding) -> Result<Claim, PaperError> {
        let Finding { value, within, mut quoted, .. } = finding;
        if value.is_some() == self.rule.is_empty() {
            return Err(PaperError::text(
                &self.id,
                "a value and a rule, or neither",
                "one of them",
            ));
        }
        let verdict = match value {
            None => Verdict::CannotBeChecked,
            Some(value) if self.holds(value, within) => Verdict::Agrees,
            Some(_) => Verdict::Differs,
        };
        let (before, after) = self.why.split_once("{differs}").unwrap_or((&self.why, ""));
        let texts = [&self.claim, &self.rule, before, &self.differs, after].join("\n");
        let [least, most] = self.band;
        for (name, number) in [
            ("value", value),
            ("paper", self.paper),
            ("difference", value.zip(self.paper).map(|(value, paper)| value - paper)),
            ("beyond", value.map(|value| value - value.max(least).min(most))),
        ] {
            if let (true, Some(number)) = (texts.contains(&format!("{{{name}")), number) {
                quoted.push((name.to_owned(), number.into()));
            }
        }
        let filled = fill(&self.id, &texts, &quoted)?;
        let parts: Vec<&str> = filled.split('\n').collect();
        let [claim, rule, before, differs, after] = parts[..] else {
            return Err(PaperError::text(&self.id, "texts of one line", "several"));
        };
        let differs = if verdict == Verdict::Differs { differs } else { "" };
        Ok(Claim {
            id: self.id.clone(),
            section: self.section.clone(),
            claim: claim.to_owned(),
            paper_value: self.paper,
            computed_value: value,
            unit: self.unit.clone(),
            rule: if value.is_some() { rule } else { "none: a datum is missing" }.to_owned(),
            verdict,
            why: [before, differs, after].concat(),
        })
    }
}

/// All claims in the order of the paper's sections; of a claim in several the first counts.
///
/// # Errors
/// [`PaperError::Text`] for facts without a finding and a finding without facts.
pub(crate) fn judge(facts: &[Facts], mut findings: Vec<Finding>) -> Result<Vec<Claim>, PaperError> {
    let mut claims = Vec::new();
    for facts in facts {
        let found = findings.iter().position(|finding| finding.id == facts.id);
        let found =
            found.ok_or_else(|| PaperError::text(&facts.id, "what was computed", "none"))?;
        claims.push(facts.judged(findings.remove(found))?);
    }
    if let Some(finding) = findings.first() {
        return Err(PaperError::text(&finding.id, "its facts in claims.toml", "none"));
    }
    claims.sort_by_cached_key(|claim| {
        let section = claim.section.split(',').next().unwrap_or_default();
        section.split('.').filter_map(|number| number.parse().ok()).collect::<Vec<u32>>()
    });
    Ok(claims)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TWO: &str = "
        [[claim]]
        section = '3.1'
        claim = 'The {part} moves {paper} mm'
        why = '{value:.1} mm{differs}.'
        differs = ', {difference:+.1} mm off'
        unit = 'mm'
        within = 0.5
        each = [
            { id = 'block', paper = 2, part = 'block' },
            { id = 'storey', paper = 3, part = 'storey', section = '3' },
        ]";

    fn judged(findings: Vec<Finding>) -> Result<Vec<Claim>, String> {
        read(TWO).and_then(|facts| judge(&facts, findings)).map_err(|error| error.to_string())
    }

    #[test]
    fn a_claim_is_judged_by_its_facts() {
        let findings = vec![Finding::new("block", 2.4), Finding::new("storey", 3.6)];
        let claims = judged(findings).unwrap();
        let [storey, block] = &claims[..] else { panic!("{claims:?}") };
        assert_eq!((&block.claim[..], &block.why[..]), ("The block moves 2 mm", "2.4 mm."));
        assert_eq!(block.rule, "within 0.5 mm of the printed number");
        assert_eq!((block.verdict, storey.verdict), (Verdict::Agrees, Verdict::Differs));
        assert_eq!(storey.why, "3.6 mm, +0.6 mm off.");
    }

    #[test]
    fn facts_and_findings_need_each_other() {
        let [block, storey] = ["block", "storey"].map(|id| Finding::new(id, 2.0));
        for (findings, expected) in [
            (vec![block.clone()], "storey: expected what was computed, found none"),
            (
                vec![block.clone(), storey.clone(), Finding::new("roof", 1.0)],
                "roof: expected its facts in claims.toml, found none",
            ),
            (
                vec![block.clone(), storey.clone().quoting("mean", 1.0)],
                "storey: expected a place for {mean}, found none",
            ),
            (
                vec![block, Finding::unchecked("storey")],
                "storey: expected a value and a rule, or neither, found one of them",
            ),
        ] {
            assert_eq!(judged(findings).unwrap_err(), expected);
        }
    }

    #[test]
    fn a_key_that_no_text_names_is_an_error() {
        let error = read(&TWO.replace("part = 'block'", "prat = 'block'")).unwrap_err();
        assert_eq!(error.to_string(), "block: expected a place for {prat}, found none");
    }

    #[test]
    fn every_rule_can_fail() {
        for facts in facts().unwrap() {
            let by_code = facts.id == "fig5-no-offset";
            let bounded = facts.within.is_some() || facts.band.iter().any(|end| end.is_finite());
            assert_eq!(bounded, !facts.rule.is_empty() && !by_code, "{}", facts.id);
        }
    }
}
