//! Records that are not what they would be run as.

use super::loaded::Loaded;
use crate::notice::{Notice, NoticeKind};
use crate::record::Origin;

/// A record that is not what it is to be run as.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{name}: expected {expected}, found {found}")]
pub struct Unfit {
    /// Its place among the records.
    pub place: usize,
    /// Its name.
    pub name: String,
    /// What was expected.
    pub expected: String,
    /// What was found.
    pub found: String,
}

/// What is said of a motion that is run alone along a surface and is a vertical component by its file.
#[must_use]
pub fn vertical_alone(path: &str, origin: &Origin) -> Option<Notice> {
    let reason = origin.vertical(file_name(path))?;
    let message =
        format!("{path} is a vertical component ({reason}) and is run as a horizontal one");
    Some(Notice::new(NoticeKind::VerticalComponent, message))
}

/// Refuses vertical components where horizontal ones are run, and pairs that are none; gives a sentence
/// for each motion that stands there under several names. The components of pairs stand beside each other.
///
/// A channel that was asked for by name is the one that is wanted, whatever it is.
///
/// # Errors
/// [`Unfit`], which names the record.
pub fn refuse_unfit(
    records: &[(String, &Loaded)],
    channel_asked: bool,
    pairs: bool,
) -> Result<Vec<String>, Unfit> {
    let unfit = |place: usize, expected: &str, found: String| {
        let name = records[place].0.clone();
        Err(Unfit { place, name, expected: expected.to_owned(), found })
    };
    for (place, (name, loaded)) in records.iter().enumerate().filter(|_| !channel_asked) {
        if let Some(reason) = loaded.origin.vertical(file_name(name)) {
            let expected = "a horizontal component (a vertical one is given beside it, as the vertical motion)";
            return unfit(place, expected, format!("a vertical one: {reason}"));
        }
    }
    if pairs {
        for (pair, components) in records.chunks_exact(2).enumerate() {
            let [(first, a), (second, b)] = components else { continue };
            let (place, expected) = (2 * pair + 1, format!("the other component of {first}"));
            if first == second || same(a, b) {
                return unfit(place, &expected, "the same motion".to_owned());
            }
            if let Some(found) = a.origin.apart(&b.origin, [file_name(first), file_name(second)]) {
                return unfit(place, &expected, format!("components {found}"));
            }
        }
    }
    let mut motions: Vec<(&Loaded, Vec<&str>)> = Vec::new();
    for (name, loaded) in records {
        match motions.iter_mut().find(|(known, _)| same(known, loaded)) {
            Some((_, names)) if names.contains(&&name[..]) => {}
            Some((_, names)) => names.push(name),
            None => motions.push((loaded, vec![name])),
        }
    }
    Ok(motions.iter().filter_map(|(_, names)| counted_again(names)).collect())
}

/// That a motion stands there under several names; nothing of one name.
fn counted_again(names: &[&str]) -> Option<String> {
    let (last, first) = names.split_last()?;
    let times = match first.len() {
        0 => return None,
        1 => "twice".to_owned(),
        others => format!("{} times", others + 1),
    };
    let (first, last) = match first.len() {
        ..=NAMED => (first.join(", "), (*last).to_owned()),
        others => (first[..NAMED].join(", "), format!("{} others", others + 1 - NAMED)),
    };
    Some(format!("{first} and {last} are the same motion: it counts {times}"))
}

/// So many names of one motion are told; of more the others are counted.
const NAMED: usize = 4;

fn file_name(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or(path)
}

fn same(a: &Loaded, b: &Loaded) -> bool {
    a.motion.horizontal_m_per_s2() == b.motion.horizontal_m_per_s2()
        && a.motion.horizontal_y_m_per_s2() == b.motion.horizontal_y_m_per_s2()
        && a.motion.times_s() == b.motion.times_s()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::GroundMotion;

    /// Pairs with one component in common are two motions.
    #[test]
    fn motions_are_the_same_along_both_axes() {
        let pair = |y: f64| {
            let motion = GroundMotion::evenly_spaced(0.1, vec![0.0, 1.0, 0.0], None).unwrap();
            Loaded::made(motion.with_y(vec![0.0, y, 0.0]).unwrap(), String::new())
        };
        let (a, b, c) = (pair(1.0), pair(2.0), pair(1.0));
        let named = [("a".to_owned(), &a), ("b".to_owned(), &b), ("c".to_owned(), &c)];
        let same = refuse_unfit(&named, true, false).unwrap();
        assert_eq!(same, ["a and c are the same motion: it counts twice"]);
    }

    /// A motion under many names is told in one sentence, which counts those beyond the first four.
    #[test]
    fn one_motion_is_one_sentence() {
        let names = ["a", "b", "c", "d", "e", "f"];
        for (count, said) in [
            (1, None),
            (2, Some("a and b are the same motion: it counts twice")),
            (4, Some("a, b, c and d are the same motion: it counts 4 times")),
            (5, Some("a, b, c, d and e are the same motion: it counts 5 times")),
            (6, Some("a, b, c, d and 2 others are the same motion: it counts 6 times")),
        ] {
            assert_eq!(counted_again(&names[..count]).as_deref(), said);
        }
    }
}
