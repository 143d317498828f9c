//! Compares the solver with the plain reference, wherever the answer is well determined.

use slipstick::response::{Event, EventKind, Response};

use super::plain::{Reference, reference};
use super::sketch::Sketch;

/// Largest difference, over the peak of each quantity.
pub const TOLERANCE: f64 = 1e-9;
/// Sticks and slips shorter than this part of the duration are none.
const SLACK: f64 = 1e-7;
/// Relative change of the input that must move a well-conditioned result by less.
const PERTURBATION: f64 = 1e-12;

/// What became of a comparison.
pub enum Verdict {
    /// Everything within the tolerance; the largest difference of states and peaks.
    Agrees(f64),
    /// A change of the input by 1e-12 moves figures by more than the tolerance; events agree, unless
    /// it moves these too.
    IllConditioned,
    /// What differs.
    Differs(String),
}

/// A named number and the size it is measured by.
type Figure = (String, f64, f64);

/// States at samples and peaks, each with its peak.
fn figures(r: &Reference) -> Vec<Figure> {
    let p = &r.peaks;
    let mut list: Vec<Figure> = Vec::new();
    let mut put = |name: &str, value: f64, size: f64| list.push((name.to_owned(), value, size));
    for x in &r.samples {
        put("s", x.s, p.s);
        put("ds/dt", x.w, p.w);
        for i in 0..x.q.len() {
            put("q", x.q[i], p.q[i]);
            put("dq/dt", x.v[i], p.v[i]);
        }
    }
    put("peak s", p.s, p.s);
    put("peak ds/dt", p.w, p.w);
    put("peak block acceleration", p.block, p.block);
    put("peak friction", p.friction, p.friction);
    put("peak slider force", p.slider, p.slider);
    put("peak base shear", p.shear, p.shear);
    for i in 0..p.q.len() {
        put("peak q", p.q[i], p.q[i]);
        put("peak drift", p.drift[i], p.drift[i]);
        put("peak floor acceleration", p.floors[i], p.floors[i]);
    }
    put("path", r.path, r.path);
    // Where the velocity touches zero and static and kinetic friction are equal, rounding decides
    // whether a stick as long as the root of it is told.
    let end_s = r.samples[r.samples.len() - 1].time_s;
    put("sliding time", r.sliding_time_s, SLACK / TOLERANCE * end_s);
    list
}

/// The same numbers of a response.
fn values(response: &Response) -> Vec<f64> {
    let d = &response.demands;
    let h = response.history.as_ref().expect("a history");
    let mut list = Vec::new();
    for &row in &h.rows {
        list.push(h.sliding_displacement_m[row]);
        list.push(h.sliding_velocity_m_per_s[row]);
        for i in 0..h.storeys {
            list.push(h.storey_displacements(row)[i]);
            list.push(h.storey_velocities(row)[i]);
        }
    }
    list.push(d.peak_sliding_displacement_m);
    list.push(d.peak_sliding_velocity_m_per_s);
    list.push(d.peak_block_acceleration_m_per_s2);
    list.push(d.peak_friction_force_n);
    list.push(d.peak_slider_force_n);
    list.push(d.peak_base_shear_n);
    for storey in &d.storeys {
        list.push(storey.peak_displacement_m);
        list.push(storey.peak_drift_m);
        list.push(storey.peak_acceleration_m_per_s2);
    }
    list.push(d.sliding_path_m);
    list.push(d.sliding_time_s);
    list
}

/// An event in the words in which two lists can be compared.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Plain {
    time_s: f64,
    kind: EventKind,
    sign: f64,
}

/// Events without sticks and slips of no length, whose presence is a matter of the last digit.
fn told(events: impl Iterator<Item = Plain>, slack_s: f64, sign: f64) -> Vec<Plain> {
    let mut list: Vec<Plain> = Vec::new();
    for event in events {
        match list.last().copied() {
            Some(last) if event.time_s - last.time_s <= slack_s => {
                // Two changes at once are one, or none, from the mode before the first.
                list.pop();
                let before = list.last().map_or(sign, |e| e.sign);
                if event.sign != before {
                    let kind = match (before == 0.0, event.sign == 0.0) {
                        (true, _) => EventKind::Slip,
                        (_, true) => EventKind::Stick,
                        _ => EventKind::Reversal,
                    };
                    list.push(Plain { time_s: last.time_s, kind, ..event });
                }
            }
            _ => list.push(event),
        }
    }
    list
}

fn of_reference(r: &Reference, slack_s: f64) -> Vec<Plain> {
    let event =
        |e: &super::plain::Event| Plain { time_s: e.time_s, kind: e.kind, sign: e.mode.sign() };
    told(r.events.iter().map(event), slack_s, r.samples[0].mode.sign())
}

fn of_response(events: &[Event], slack_s: f64, initial_sign: f64) -> Vec<Plain> {
    let event = |e: &Event| Plain { time_s: e.time_s, kind: e.kind, sign: e.mode.sign() };
    told(events.iter().map(event), slack_s, initial_sign)
}

fn same_story(a: &[Plain], b: &[Plain]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(x, y)| x.kind == y.kind && x.sign == y.sign)
}

/// Whether two references tell the same within the tolerance.
fn close(a: &[Figure], b: &[Figure]) -> bool {
    let near = |(x, y): (&Figure, &Figure)| (x.1 - y.1).abs() <= TOLERANCE * x.2;
    a.iter().zip(b).all(near)
}

/// Compares a response of a system with the reference's.
pub fn compare(sketch: &Sketch, expected: &Reference, response: &Response) -> Verdict {
    let end_s = sketch.times[sketch.times.len() - 1];
    let slack_s = SLACK * end_s;
    let wanted = figures(expected);
    let story = of_reference(expected, slack_s);
    let (mut figures_hold, mut story_holds) = (true, true);
    let mut times_hold = vec![true; story.len()];
    for changed in sketch.perturbed(PERTURBATION) {
        let (model, motion) = changed.build();
        let moved = reference(&model, &motion);
        figures_hold &= close(&wanted, &figures(&moved));
        let other = of_reference(&moved, slack_s);
        story_holds &= same_story(&story, &other);
        for (holds, (a, b)) in times_hold.iter_mut().zip(story.iter().zip(&other)) {
            *holds &= (a.time_s - b.time_s).abs() <= TOLERANCE * end_s;
        }
    }
    if story_holds {
        let told = of_response(&response.events, slack_s, expected.samples[0].mode.sign());
        if !same_story(&story, &told) {
            return Verdict::Differs(format!("events: expected {story:?}, found {told:?}"));
        }
        let timed = times_hold.iter().zip(story.iter().zip(&told));
        for (_, (a, b)) in timed.filter(|(holds, _)| **holds) {
            if (a.time_s - b.time_s).abs() > 2.0 * TOLERANCE * end_s {
                return Verdict::Differs(format!("event: expected {a:?}, found {b:?}"));
            }
        }
    }
    if !figures_hold {
        return Verdict::IllConditioned;
    }
    let mut worst = 0.0_f64;
    let found = values(response);
    assert_eq!(found.len(), wanted.len(), "rows and samples differ: {sketch:?}");
    for ((name, value, size), found) in wanted.iter().zip(&found) {
        let error = (found - value).abs();
        // NaN must fail; what is zero throughout must be so to rounding of the other quantities.
        let floor = 1e-13 * end_s * end_s * sketch.level();
        if !(error <= TOLERANCE * size || error <= floor * TOLERANCE) {
            return Verdict::Differs(format!(
                "{name}: expected {value:e}, found {found:e}, off by {:.1e} of its peak",
                error / size
            ));
        }
        if *size > 0.0 && name != "sliding time" {
            worst = worst.max(error / size);
        }
    }
    Verdict::Agrees(worst)
}
