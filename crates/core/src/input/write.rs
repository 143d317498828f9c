//! Values back to text.

use super::overrides::kind_of;
use super::reader::{Leaf, LeafValue, Values};
use super::schema::Kind;

/// What becomes of the motion in a text.
#[derive(Clone, Copy)]
pub(super) enum Motion<'a> {
    /// All of it stays.
    AsWritten,
    /// A made one stays, a record is left out.
    Made,
    /// The record of a file.
    Record(&'a str),
}

/// A list within a section: its key, and its items by their numbers.
struct List {
    key: String,
    items: Vec<(String, Item, Vec<String>)>,
}

/// What an item of a list is.
#[derive(Clone, Copy)]
enum Item {
    Value,
    Pair,
    Table,
}

impl List {
    fn line(&self) -> String {
        let item = |(_, item, entries): &(String, Item, Vec<String>)| match item {
            Item::Value => entries.join(", "),
            Item::Pair => format!("[{}]", entries.join(", ")),
            Item::Table => format!("{{ {} }}", entries.join(", ")),
        };
        let items: Vec<String> = self.items.iter().map(item).collect();
        format!("{} = [{}]\n", self.key, items.join(", "))
    }
}

/// The last entry as that of a list in a table of a list: the first number opens it, others join it.
fn join_list(entries: &mut Vec<String>, name: &str, place: &str, value: &str) {
    entries.pop();
    match entries.last_mut().filter(|_| place != "1") {
        Some(list) => {
            list.pop();
            list.push_str(&format!(", {value}]"));
        }
        None => entries.push(format!("{name} = [{value}]")),
    }
}

/// The text of some values, a table a section; see [`super::Analysis::to_toml`].
pub(super) fn toml(values: &Values, motion: Motion<'_>) -> String {
    let mut text = String::new();
    let mut section = String::new();
    let mut open: Option<List> = None;
    let drop_motion = match motion {
        Motion::AsWritten => false,
        Motion::Made => values.has("motion.record"),
        Motion::Record(_) => true,
    };
    let replaced = |leaf: &&Leaf| !(drop_motion && leaf.path.starts_with("motion."));
    for leaf in values.leaves.iter().filter(replaced) {
        let (head, key) = split(&leaf.path);
        let item = item_of(&key);
        let goes_on = |list: &List| head == section && item.is_some_and(|(k, ..)| k == list.key);
        if let Some(list) = open.take_if(|list| !goes_on(list)) {
            text.push_str(&list.line());
        }
        if head != section {
            text.push_str(&header(&head, text.is_empty()));
            section = head;
        }
        let Some((name, number, inner)) = item else {
            text.push_str(&format!("{key} = {}\n", value(leaf)));
            continue;
        };
        let list = open.get_or_insert_with(|| List { key: name.to_owned(), items: Vec::new() });
        let (item, entry) = match inner {
            "" => (Item::Value, value(leaf)),
            inner if inner.parse::<usize>().is_ok() => (Item::Pair, value(leaf)),
            inner => (Item::Table, format!("{inner} = {}", value(leaf))),
        };
        match list.items.last_mut() {
            Some((last, _, entries)) if last == number => entries.push(entry),
            _ => list.items.push((number.to_owned(), item, vec![entry])),
        }
        if let (Some((name, place)), Some((_, _, entries))) =
            (inner.split_once('.'), list.items.last_mut())
        {
            join_list(entries, name, place, &value(leaf));
        }
    }
    if let Some(list) = open {
        text.push_str(&list.line());
    }
    if let Motion::Record(record) = motion {
        text.push_str(&format!("\n[motion]\nrecord = {}\n", quoted(record)));
    }
    text
}

/// The list, the number of its item and the key inside that, if any: of `surface.2.friction`.
fn item_of(key: &str) -> Option<(&str, &str, &str)> {
    let mut from = 0;
    for part in key.split('.') {
        let end = from + part.len();
        if from > 0 && part.bytes().all(|byte| byte.is_ascii_digit()) {
            let inner = key.get(end..)?.trim_start_matches('.');
            return Some((key.get(..from - 1)?, part, inner));
        }
        from = end + 1;
    }
    None
}

/// The section (`block`, `storey.2`) and the key inside it.
fn split(path: &str) -> (String, String) {
    let mut parts = path.split('.');
    let first = parts.next().unwrap_or("");
    let rest: Vec<&str> = parts.collect();
    let listed = matches!(kind_of(first), Some(Kind::Sections(..)));
    match rest.as_slice() {
        [] => (String::new(), first.to_owned()),
        [number, rest @ ..] if listed => (format!("{first}.{number}"), rest.join(".")),
        rest => (first.to_owned(), rest.join(".")),
    }
}

fn header(section: &str, at_start: bool) -> String {
    let gap = if at_start { "" } else { "\n" };
    match section.split_once('.') {
        _ if section.is_empty() => String::new(),
        Some((name, _)) => format!("{gap}[[{name}]]\n"),
        None => format!("{gap}[{section}]\n"),
    }
}

fn value(leaf: &Leaf) -> String {
    match leaf.given {
        // What is written in percent is a text.
        LeafValue::Number(_) if leaf.unit.is_empty() && !leaf.written.trim_end().ends_with('%') => {
            leaf.written.clone()
        }
        _ => quoted(&leaf.written),
    }
}

pub(super) fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for character in text.chars() {
        match character {
            '"' | '\\' => quoted.extend(['\\', character]),
            c if c.is_control() => quoted.push_str(&format!("\\u{:04x}", u32::from(c))),
            c => quoted.push(c),
        }
    }
    quoted.push('"');
    quoted
}

#[cfg(test)]
mod tests {
    use crate::input::{Override, parse};

    #[test]
    fn lists_of_sections_read_back_the_same() {
        let rest = "[block]\nmass = \"325 kg\"\n[motion]\nsine = { frequency = \"1 Hz\", \
            amplitude = \"1 m/s2\", duration = \"2 s\", dt = \"0.01 s\" }\n";
        let contents = "[slider]\nstatic_friction = 0.06\nkinetic_friction = 0.05\n\
            [[contents]]\nfloor = 0\nmass = \"10 kg\"\nstatic_friction = 0.3\n\
            kinetic_friction = 0.25\n\
            [[contents]]\nfloor = 0\nmass = \"20 kg\"\nstatic_friction = 0.2\n\
            kinetic_friction = 0.15\n";
        let surfaces = "[slider]\ngap = \"0.3 m\"\n\
            [[slider.surface]]\nradius = \"2 m\"\nfriction = 0.05\ntravel = \"0.1 m\"\n\
            [[slider.surface]]\nradius = \"3 m\"\nfriction = 0.1\n";
        let triple = "[slider.triple]\neffective_radius = [\"2 m\", \"0.3 m\", \"0.3 m\", \
            \"2 m\"]\nfriction = [0.05, 0.02, 0.02, 0.1]\n\
            travel = [\"0.4 m\", \"0.04 m\", \"0.04 m\", \"0.4 m\"]\n";
        for sections in [contents, surfaces, triple] {
            let first = parse("a.toml", &format!("{rest}{sections}"), &[]).unwrap();
            let written = first.to_toml_with_motion();
            let second = parse("b.toml", &written, &[]).unwrap();
            assert_eq!(first.model, second.model, "{written}");
        }
    }

    #[test]
    fn ratios_in_percent_read_back_the_same() {
        let text = "[block]\nmass = \"1 t\"\n[slider]\nstatic_friction = \"6 %\"\n\
            kinetic_friction = { positive = \"5%\", negative = \"4 % \" }\n\
            [[storey]]\nmass = \"1 t\"\nfrequency = \"2 Hz\"\ndamping_ratio = \"2 %\"\n";
        let first = parse("a.toml", text, &[]).unwrap();
        let written = first.to_toml_with_motion();
        let second = parse("b.toml", &written, &[]).unwrap_or_else(|e| panic!("{e}: {written}"));
        assert_eq!(first.model, second.model, "{written}");
    }

    #[test]
    fn written_text_reads_back_the_same() {
        let text = r#"
name = "A \"tank\" on sliders"
[block]
mass = "325 kg"
[slider]
static_friction = { positive = 0.021, negative = 0.019 }
kinetic_friction = 0.012
spring = "143 kN/m"
bounds = { lower = 0.8, upper = 1.3 }
[[storey]]
mass = "45 kg"
stiffness = 2
damping_ratio = 0.01
[[storey]]
mass = "40 kg"
stiffness = 1
damping_ratio = 0.01
[frame]
period = "0.8 s"
[motion]
sine = { frequency = "1 Hz", amplitude = "1 m/s2", duration = "2 s", dt = "0.01 s" }
[initial]
sliding_displacement = "10 mm"
storey_displacement = ["5 mm", "7 mm"]
[analysis]
method = "exact"
"#;
        let set = [Override::number("slider.kinetic_friction.positive", 0.0125).unwrap()];
        let first = parse("a.toml", text, &set).unwrap();
        let written = first.to_toml(None);
        let second = parse("b.toml", &written, &[]).unwrap();
        assert_eq!(first.model, second.model, "{written}");
        assert_eq!(first.motion, second.motion);
        assert_eq!((first.name, first.method), (second.name, second.method));
        assert_eq!(first.friction_bounds, second.friction_bounds);
        let moved = parse("a.toml", text, &[]).unwrap().to_toml(Some("table.csv"));
        assert!(moved.ends_with("[motion]\nrecord = \"table.csv\"\n") && !moved.contains("sine"));
        assert!(parse("c.toml", &moved, &[]).is_ok());
    }
}
