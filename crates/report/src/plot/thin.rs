//! Fewer points, the same picture: loops by drawing each stroke once.

use std::collections::HashSet;

/// Strokes of a curve that may run back over itself, in hundredths of a pixel.
///
/// Points are moved to a grid of a quarter of a pixel, except those at the extremes, which stay
/// where they are; points between two that lie on the same upright or level line are left out; a
/// stroke already drawn is not drawn again. So the number of strokes is bounded by the picture, not
/// by the length of the history.
pub fn curve(points: &[[f64; 2]]) -> Vec<Vec<[i64; 2]>> {
    let extremes = extreme_indices(points);
    let mut strokes = Strokes::default();
    let mut previous: Option<[i64; 2]> = None;
    // The end of a straight run that may still grow.
    let mut pending: Option<[i64; 2]> = None;
    for (i, point) in points.iter().enumerate() {
        let grid = if extremes.contains(&i) { 100.0 } else { 4.0 };
        let here = point.map(|p| (libm::round(p * grid) * (100.0 / grid)) as i64);
        let Some(from) = previous else {
            previous = Some(here);
            continue;
        };
        match pending {
            None if here == from => {}
            None => pending = Some(here),
            Some(to) if here == to => {}
            Some(to) if continues(from, to, here) => pending = Some(here),
            Some(to) => {
                strokes.add(from, to);
                previous = Some(to);
                pending = Some(here);
            }
        }
    }
    match (previous, pending) {
        (Some(from), Some(to)) => strokes.add(from, to),
        // A curve that never moves is still a point.
        (Some(from), None) => strokes.add(from, from),
        _ => {}
    }
    strokes.lines
}

/// Whether `c` goes on from `a → b` along the same upright or level line.
fn continues(a: [i64; 2], b: [i64; 2], c: [i64; 2]) -> bool {
    let along = |i: usize, j: usize| {
        a[i] == b[i] && b[i] == c[i] && (b[j] - a[j]).signum() == (c[j] - b[j]).signum()
    };
    along(0, 1) || along(1, 0)
}

fn extreme_indices(points: &[[f64; 2]]) -> Vec<usize> {
    (0..2)
        .flat_map(|axis| {
            let index = |better: fn(f64, f64) -> bool| {
                let mut best = 0;
                for (i, point) in points.iter().enumerate() {
                    if better(point[axis], points[best][axis]) {
                        best = i;
                    }
                }
                best
            };
            [index(|a, b| a < b), index(|a, b| a > b)]
        })
        .collect()
}

#[derive(Default)]
struct Strokes {
    lines: Vec<Vec<[i64; 2]>>,
    drawn: HashSet<([i64; 2], [i64; 2])>,
}

impl Strokes {
    fn add(&mut self, from: [i64; 2], to: [i64; 2]) {
        let key = if from <= to { (from, to) } else { (to, from) };
        if !self.drawn.insert(key) {
            return;
        }
        match self.lines.last_mut() {
            Some(line) if line.last() == Some(&from) => line.push(to),
            _ => self.lines.push(vec![from, to]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_loop_run_ten_times_is_drawn_once() {
        let square = [[0.0, 0.0], [10.0, 0.0], [10.0, 5.0], [10.0, 10.0], [0.0, 10.0]];
        let once: Vec<[f64; 2]> = square.into_iter().chain([[0.0, 0.0]]).collect();
        let many: Vec<[f64; 2]> = once.iter().cycle().take(60).copied().collect();
        assert_eq!(curve(&once), vec![vec![[0, 0], [1000, 0], [1000, 1000], [0, 1000], [0, 0]]]);
        assert_eq!(curve(&many), curve(&once));
    }

    #[test]
    fn extremes_of_a_curve_stay_off_the_grid() {
        let points = [[0.0, 0.0], [1.13, 0.4], [0.6, 7.77], [0.0, -1.01]];
        let drawn: Vec<[i64; 2]> = curve(&points).concat();
        assert!(drawn.iter().any(|p| p[0] == 113));
        assert!(drawn.iter().any(|p| p[1] == 777));
        assert!(drawn.iter().any(|p| p[1] == -101));
    }
}
