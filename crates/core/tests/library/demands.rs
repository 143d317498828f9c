//! Demands of random systems as they were stored: a change of the solver that means to leave answers as
//! they are leaves these.
//!
//! A line of `data/reference/demands.txt` is a system: its class and number, a tolerance over the largest
//! demand of the same unit, and the demands in the order of `demand_values`. The independent references
//! of the other tests say that they are right; what is stored here is held closer, and to what was.

#![allow(clippy::expect_used)]

use std::fmt::Write;
use std::path::PathBuf;

use crate::common::nasty::CLASSES;
use crate::common::random::Random;
use crate::common::random_devices::{System, coincident, motion, system};
use crate::common::sketch::Sketch;
use slipstick::model::Model;
use slipstick::motion::GroundMotion;
use slipstick::response::{Demands, demand_values};
use slipstick::solver::exact;

const STORED: &str = include_str!("../../../../data/reference/demands.txt");

/// Systems stored of each class of traps, and of each kind with devices.
const OF_CLASS: u64 = 12;
const OF_DEVICES: u64 = 60;

/// Rounding of a rearranged sum, over the largest demand of the same unit.
const ROUNDING: f64 = 1e-11;
/// Relative change of friction and motion by which the tolerance of a system is found, how much more of
/// the input a rearrangement may look like, and what of the tolerance is too much to be stored.
const PERTURBATION: f64 = 1e-13;
const SAFETY: f64 = 10.0;
const TOO_MUCH: f64 = 1e-7;

fn of_system(system: &System) -> (Model, GroundMotion) {
    (system.model.clone(), motion(system, 1.0))
}

/// All systems, by names that are their classes and numbers.
fn systems() -> Vec<(String, Model, GroundMotion)> {
    let mut all = Vec::new();
    let mut add = |class: &str, number: u64, (model, motion): (Model, GroundMotion)| {
        all.push((format!("{class} {number}"), model, motion));
    };
    for (class, draw) in CLASSES {
        for number in 0..OF_CLASS {
            add(class, number, draw(&mut Random::new(number)).build());
        }
    }
    for number in 0..OF_DEVICES {
        let random = &mut Random::new(number);
        let mut equipped = Sketch::shaken(random);
        equipped.equip(random);
        add("equipped", number, equipped.build());
        add("devices", number, of_system(&system(number)));
        add("coincident", number, of_system(&coincident(number)));
    }
    all
}

/// The demands with the largest of the same unit, for each.
fn sized(demands: &Demands) -> Vec<[f64; 2]> {
    let (columns, values) = (demands.shape().columns(), demand_values(demands));
    let largest = |unit: &str| {
        let of_unit = columns.iter().zip(&values).filter(|(column, _)| column.unit() == unit);
        of_unit.map(|(_, value)| value.abs()).fold(0.0, f64::max)
    };
    columns.iter().zip(&values).map(|(column, value)| [*value, largest(column.unit())]).collect()
}

/// Largest difference over its size; infinite where one exists and the other does not.
fn difference(stored: &[f64], found: &[[f64; 2]]) -> f64 {
    if stored.len() != found.len() {
        return f64::INFINITY;
    }
    let each = stored.iter().zip(found).map(|(stored, [found, size])| {
        if stored == found || (stored.is_nan() && found.is_nan()) {
            0.0
        } else if stored.is_nan() || found.is_nan() {
            f64::INFINITY
        } else {
            (stored - found).abs() / size
        }
    });
    each.fold(0.0, f64::max)
}

#[test]
fn demands_are_those_stored() {
    let mut lines = STORED.lines().filter(|line| !line.starts_with('#')).peekable();
    let (mut failures, mut compared) = (Vec::new(), 0);
    for (name, model, motion) in systems() {
        let Some(line) = lines.next_if(|line| line.split(':').next() == Some(&name)) else {
            continue;
        };
        let numbers = line[name.len() + 1..].split_whitespace();
        let numbers: Vec<f64> = numbers.map(|word| word.parse().expect("a number")).collect();
        compared += 1;
        match exact(&model, &motion) {
            Ok(response) => {
                let off = difference(&numbers[1..], &sized(&response.demands));
                if !(off <= numbers[0]) {
                    failures
                        .push(format!("{name}: off by {off:.1e}, tolerance {:.1e}", numbers[0]));
                }
            }
            Err(error) => failures.push(format!("{name}: {error}")),
        }
    }
    assert_eq!(lines.next(), None, "a line of no system");
    assert!(compared > 250, "only {compared} lines");
    assert!(failures.is_empty(), "{} differ:\n{}", failures.len(), failures.join("\n"));
}

/// Those of a system whose friction and motion are larger by a part of them, where they exist.
fn changed(model: &Model, motion: &GroundMotion, part: f64) -> Option<Vec<f64>> {
    let larger = |list: &[f64]| list.iter().map(|a| a * (1.0 + part)).collect::<Vec<_>>();
    let motion = GroundMotion::new(
        motion.times_s().to_vec(),
        larger(motion.horizontal_m_per_s2()),
        motion.vertical_m_per_s2().map(larger),
    );
    let model = model.with_friction_times(1.0 - part).ok()?;
    Some(demand_values(&exact(&model, &motion.ok()?).ok()?.demands))
}

#[test]
#[ignore = "writes: cargo test -p slipstick --test library demands:: -- --ignored"]
fn write_the_demands() {
    let mut text = String::from(
        "# Demands of random systems, written by cargo test -p slipstick --test library demands:: -- --ignored\n",
    );
    for (name, model, motion) in systems() {
        let Ok(response) = exact(&model, &motion) else { continue };
        let found = sized(&response.demands);
        let moved = [PERTURBATION, -PERTURBATION].map(|part| {
            changed(&model, &motion, part).map_or(f64::INFINITY, |moved| difference(&moved, &found))
        });
        let tolerance = (SAFETY * moved[0].max(moved[1])).max(ROUNDING);
        if tolerance > TOO_MUCH {
            continue;
        }
        write!(text, "{name}: {tolerance:.0e}").expect("text");
        for [value, _] in found {
            write!(text, " {value:e}").expect("text");
        }
        text.push('\n');
    }
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../data/reference/demands.txt");
    std::fs::write(path, text).expect("written");
}
