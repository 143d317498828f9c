//! Values back to text.

use super::reader::{Given, Leaf, Values};

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

/// The text of some values, a table a section; see [`super::Analysis::to_toml`].
pub(super) fn toml(values: &Values, motion: Motion<'_>) -> String {
    let mut text = String::new();
    let mut section = String::new();
    let mut list: Option<(String, Vec<String>)> = None;
    let drop_motion = match motion {
        Motion::AsWritten => false,
        Motion::Made => values.has("motion.record"),
        Motion::Record(_) => true,
    };
    let replaced = |leaf: &&Leaf| !(drop_motion && leaf.path.starts_with("motion."));
    for leaf in values.leaves.iter().filter(replaced) {
        let (head, key) = split(&leaf.path);
        // An item of a list of numbers ends in its number.
        let item = key.rsplit_once('.').filter(|(_, n)| n.bytes().all(|b| b.is_ascii_digit()));
        let name = item.map_or(key.as_str(), |(name, _)| name);
        if let Some((open, items)) = list.take_if(|(open, _)| *open != format!("{head}.{name}")) {
            push_list(&mut text, &open, &items);
        }
        if head != section {
            text.push_str(&header(&head, text.is_empty()));
            section = head.clone();
        }
        if item.is_some() {
            let open = list.get_or_insert_with(|| (format!("{head}.{name}"), Vec::new()));
            open.1.push(value(leaf));
        } else {
            text.push_str(&format!("{key} = {}\n", value(leaf)));
        }
    }
    if let Some((open, items)) = list {
        push_list(&mut text, &open, &items);
    }
    if let Motion::Record(record) = motion {
        text.push_str(&format!("\n[motion]\nrecord = {}\n", quoted(record)));
    }
    text
}

fn push_list(text: &mut String, path: &str, items: &[String]) {
    let key = path.rsplit('.').next().unwrap_or(path);
    text.push_str(&format!("{key} = [{}]\n", items.join(", ")));
}

/// The section (`block`, `storey.2`) and the key inside it.
fn split(path: &str) -> (String, String) {
    let mut parts = path.split('.');
    let first = parts.next().unwrap_or("");
    let rest: Vec<&str> = parts.collect();
    match rest.as_slice() {
        [] => (String::new(), first.to_owned()),
        [number, rest @ ..] if first == "storey" => (format!("storey.{number}"), rest.join(".")),
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
        Given::Number(_) if leaf.unit.is_empty() => leaf.written.clone(),
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
    fn exact_written_text_reads_back_the_same() {
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
