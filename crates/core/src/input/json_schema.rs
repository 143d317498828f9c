//! The description of the keys as a JSON Schema, for editors.

use super::json::Json;
use super::keys::MODEL;
use super::plan_keys::{DISTRIBUTION, PLAN};
use super::schema::{Exclusive, Key, Kind, Range, Section, Special};
use crate::units::Dimension;

/// The JSON Schema (draft 2020-12) of a model file, as text.
#[must_use]
pub fn json_schema() -> String {
    document("Slipstick model", &MODEL)
}

/// The JSON Schema (draft 2020-12) of a study plan, as text.
#[must_use]
pub fn plan_json_schema() -> String {
    document("Slipstick study plan", &PLAN)
}

fn document(title: &str, root: &'static Section) -> String {
    let Json::Object(keys) = section(root) else { return String::new() };
    let mut entries = vec![
        ("$schema", Json::text("https://json-schema.org/draft/2020-12/schema")),
        ("title", Json::text(title)),
    ];
    entries.extend(keys);
    Json::Object(entries).pretty()
}

fn section(section: &'static Section) -> Json {
    let of_keys = section.keys.iter().map(|k| (k.name, key(k))).collect();
    let mut entries = vec![
        ("type", Json::text("object")),
        ("properties", Json::Object(of_keys)),
        ("additionalProperties", Json::False),
    ];
    let required: Vec<_> = section.keys.iter().filter(|k| k.required).map(|k| k.name).collect();
    if !required.is_empty() {
        entries.push(("required", Json::texts(required)));
    }
    let beside: Vec<_> = section
        .keys
        .iter()
        .filter_map(|k| k.beside.map(|other| (k.name, Json::texts([other]))))
        .collect();
    if !beside.is_empty() {
        entries.push(("dependentRequired", Json::Object(beside)));
    }
    let choices: Vec<_> = section.choices.iter().flat_map(exclusive).collect();
    if !choices.is_empty() {
        entries.push(("allOf", Json::List(choices)));
    }
    Json::Object(entries)
}

/// One of the keys exactly, or none of the pairs.
fn exclusive(choice: &Exclusive) -> Vec<Json> {
    if choice.required {
        let each = choice.names.iter().map(|name| Json::Object(given(name))).collect();
        return vec![Json::Object(vec![("oneOf", Json::List(each))])];
    }
    let mut pairs = Vec::new();
    for (index, first) in choice.names.iter().enumerate() {
        for second in choice.names.iter().skip(index + 1) {
            let both = [first, second].map(|name| Json::Object(given(name)));
            let both = Json::Object(vec![("allOf", Json::List(both.into()))]);
            pairs.push(Json::Object(vec![("not", both)]));
        }
    }
    pairs
}

/// That a key is given; `key.*`: that it is given as a table.
fn given(name: &'static str) -> Vec<(&'static str, Json)> {
    let plain = name.trim_end_matches(".*");
    let mut entries = vec![("required", Json::texts([plain]))];
    if plain != name {
        let table = Json::Object(vec![("type", Json::text("object"))]);
        entries.push(("properties", Json::Object(vec![(plain, table)])));
    }
    entries
}

fn key(key: &Key) -> Json {
    let mut entries = vec![("description", Json::text(key.doc))];
    match &key.kind {
        Kind::Text(example) => {
            entries.extend([("type", Json::text("string")), ("minLength", Json::Number(1.0))]);
            entries.push(("examples", Json::texts([*example])));
        }
        Kind::Word(words) => entries.push(("enum", Json::texts(words.iter().copied()))),
        Kind::UnitOf(dimension) => {
            entries.push(("type", Json::text("string")));
            // Perhaps after the value of one count.
            let pattern = format!(r"^([0-9.eE+-]+\s+)?{}$", unit_pattern(*dimension));
            entries.push(("pattern", Json::text(pattern)));
        }
        Kind::NameOrIndex => {
            let index = vec![("type", Json::text("integer")), ("minimum", Json::Number(1.0))];
            entries.push(("anyOf", Json::List(vec![a("string"), Json::Object(index)])));
        }
        Kind::Number(range) => {
            let either = vec![Json::Object(number(*range)), percent()];
            entries.push(("anyOf", Json::List(either)));
        }
        Kind::NumberOr(range, both) => {
            let either = vec![Json::Object(number(*range)), percent(), section(both)];
            entries.push(("anyOf", Json::List(either)));
        }
        Kind::Quantity(dimension, _) => entries.extend(quantity(*dimension)),
        Kind::QuantityOr(dimension, _, sides) => {
            let mut sides = section(sides);
            if let Json::Object(entries) = &mut sides {
                entries.push(("minProperties", Json::Number(1.0)));
            }
            let either = vec![Json::Object(quantity(*dimension)), sides];
            entries.push(("anyOf", Json::List(either)));
        }
        Kind::QuantityOrRatio(dimension, range) => {
            let either = vec![Json::Object(quantity(*dimension)), Json::Object(number(*range))];
            entries.push(("anyOf", Json::List(either)));
        }
        Kind::Quantities(dimension, _, most) => {
            entries.push(("type", Json::text("array")));
            entries.push(("maxItems", Json::Number(*most as f64)));
            entries.push(("items", Json::Object(quantity(*dimension))));
        }
        Kind::Vector(dimension, _) => entries.push(vector(*dimension)),
        Kind::Vectors(dimension, _, most) => {
            entries.push(("type", Json::text("array")));
            entries.push(("maxItems", Json::Number(*most as f64)));
            entries.push(("items", Json::Object(vec![vector(*dimension)])));
        }
        Kind::Section(inner) => {
            if let Json::Object(inner) = section(inner) {
                entries.extend(inner);
            }
        }
        Kind::Sections(inner, most) => {
            entries.push(("type", Json::text("array")));
            entries.push(("maxItems", Json::Number(*most as f64)));
            entries.push(("items", section(inner)));
        }
        Kind::Texts(example) => {
            let list = vec![("type", Json::text("array")), ("items", a("string"))];
            entries.push(("anyOf", Json::List(vec![a("string"), Json::Object(list)])));
            entries.push(("examples", Json::texts([*example])));
        }
        Kind::Numbers(range, most) => {
            entries.push(("type", Json::text("array")));
            entries.push(("maxItems", Json::Number(*most as f64)));
            entries.push(("items", Json::Object(number(*range))));
        }
        Kind::Whole(least, most) => {
            entries.push(("type", Json::text("integer")));
            entries.push(("minimum", Json::Number(*least as f64)));
            entries.push(("maximum", Json::Number(*most as f64)));
        }
        Kind::Special(special) => entries.extend(self::special(*special)),
    }
    Json::Object(entries)
}

fn special(special: Special) -> Vec<(&'static str, Json)> {
    let list = |items| vec![("type", Json::text("array")), ("items", items)];
    let number_or_text = || Json::Object(vec![("type", Json::texts(["number", "string"]))]);
    match special {
        Special::Vary => {
            vec![("type", Json::text("object")), ("additionalProperties", section(&DISTRIBUTION))]
        }
        Special::Levels => list(a("string")),
        Special::Correlation => list(Json::Object(vec![
            ("type", Json::text("array")),
            ("prefixItems", Json::List(vec![a("string"), a("string"), a("number")])),
            ("minItems", Json::Number(3.0)),
            ("maxItems", Json::Number(3.0)),
        ])),
        Special::Values(0) => {
            let mut entries = list(number_or_text());
            entries.push(("minItems", Json::Number(1.0)));
            entries
        }
        Special::Values(count) => {
            let mut entries = list(number_or_text());
            entries.push(("minItems", Json::Number(count as f64)));
            entries.push(("maxItems", Json::Number(count as f64)));
            entries
        }
    }
}

fn a(kind: &str) -> Json {
    Json::Object(vec![("type", Json::text(kind))])
}

fn number(range: Range) -> Vec<(&'static str, Json)> {
    let mut entries = vec![("type", Json::text("number"))];
    match range {
        Range::Any | Range::Tilt => {}
        Range::Positive => entries.push(("exclusiveMinimum", Json::Number(0.0))),
        Range::NotNegative => entries.push(("minimum", Json::Number(0.0))),
        Range::Fraction => {
            entries.push(("exclusiveMinimum", Json::Number(-1.0)));
            entries.push(("exclusiveMaximum", Json::Number(1.0)));
        }
    }
    entries
}

/// A number as text.
const NUMBER: &str = r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?";

/// A ratio in percent.
fn percent() -> Json {
    let pattern = format!(r"^\s*{NUMBER}\s*%\s*$");
    Json::Object(vec![
        ("type", Json::text("string")),
        ("pattern", Json::Text(pattern)),
        ("examples", Json::texts(["6 %"])),
    ])
}

fn quantity(dimension: Dimension) -> Vec<(&'static str, Json)> {
    let pattern = format!(r"^\s*{NUMBER}\s*{}\s*$", unit_pattern(dimension));
    vec![
        ("type", Json::text("string")),
        ("pattern", Json::Text(pattern)),
        ("examples", Json::texts([dimension.example()])),
    ]
}

/// A quantity, or two of it.
fn vector(dimension: Dimension) -> (&'static str, Json) {
    let pair = vec![
        ("type", Json::text("array")),
        ("minItems", Json::Number(2.0)),
        ("maxItems", Json::Number(2.0)),
        ("items", Json::Object(quantity(dimension))),
    ];
    ("anyOf", Json::List(vec![Json::Object(quantity(dimension)), Json::Object(pair)]))
}

/// The dimension's units, in every way in which the reader takes them.
fn unit_pattern(dimension: Dimension) -> String {
    let names: Vec<_> = dimension
        .units()
        .iter()
        .map(|unit| unit.name().replace('2', r"(\^?2|²)").replace(' ', r"[\s·*]+"))
        .collect();
    format!("({})", names.join("|"))
}
