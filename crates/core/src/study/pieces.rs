//! How long runs take, roughly, and so how many of them make a piece of work for one thread.
//!
//! A piece prepares its models anew, and when all others have ended the last one is waited for: pieces are as short as
//! preparing allows. The figures decide who does what, never what comes of it.

use crate::model::Model;
use crate::motion::GroundMotion;

/// Work that is worth handing to a thread, in ns.
const WORTH_NS: f64 = 3e6;

/// Work of a piece over that of preparing its model.
const OVER_PREPARING: f64 = 4.0;

/// Runs of one design that make a piece, of those on motions with so many samples.
pub(crate) fn runs_in_piece(model: &Model, motion: &GroundMotion) -> usize {
    let parts = model.points() as f64;
    // Measured: one direction 15 ns a sample and 12 more a storey, two directions 50 times as much.
    let (sample_ns, preparing_ns) = match motion.horizontal_y_m_per_s2() {
        None => (15.0 + 12.0 * parts, 0.0),
        Some(_) => (700.0 + 60.0 * parts, 6e4 * (1.0 + parts) * (1.0 + parts)),
    };
    let piece_ns = WORTH_NS.max(OVER_PREPARING * preparing_ns);
    (piece_ns / (sample_ns * motion.len() as f64)).max(1.0) as usize
}
