//! The laboratory: measured histories, how well a prediction meets them, and what they say of a
//! model.
//!
//! Everything here works on slices in SI and on bytes that the caller has read.

pub mod anderson;
pub mod compare;
pub mod cyclic;
pub mod estimate;
pub mod fit;
pub mod fitted;
pub mod free_vibration;
pub mod identify;
pub mod measured;
pub mod metrics;
pub mod shaking_table;
pub mod two_clocks;

/// Prints how many of 200 intervals cover the truth and how many of 200 silent records are refused,
/// and holds both to their bars.
#[cfg(test)]
#[allow(clippy::disallowed_macros, reason = "what was counted is the result")]
fn hold_to_coverage(covered: &[(&str, u64)], refused: u64) {
    for (name, count) in covered {
        println!("coverage {name}: {count} of 200");
    }
    println!("refused: {refused} of 200");
    let outside = covered.iter().find(|(_, count)| !(181..=198).contains(count));
    assert_eq!((outside, refused), (None, 200));
}
