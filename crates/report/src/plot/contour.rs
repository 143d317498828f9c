//! Level lines of values on a grid, by marching squares.

/// Lines along which a function, bilinear between the values at the nodes of a grid, takes a level.
///
/// `values` are those at `(x[i], y[j])`, at `i * y.len() + j`; cells with a value that is not finite
/// are left out. Lines end at the edge of the grid or close.
#[must_use]
pub fn contour(x: &[f64], y: &[f64], values: &[f64], level: f64) -> Vec<Vec<[f64; 2]>> {
    let at = |i: usize, j: usize| values.get(i * y.len() + j).copied().unwrap_or(f64::NAN) - level;
    let mut pieces: Vec<[[f64; 2]; 2]> = Vec::new();
    for i in 0..x.len().saturating_sub(1) {
        for j in 0..y.len().saturating_sub(1) {
            // Corners in turn around the cell.
            let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
            let v = corners.map(|(i, j)| at(i, j));
            if v.iter().any(|v| !v.is_finite()) {
                continue;
            }
            let crossing = |k: usize| -> Option<[f64; 2]> {
                let (from, to) = (v[k], v[(k + 1) % 4]);
                if (from > 0.0) == (to > 0.0) {
                    return None;
                }
                let part = from / (from - to);
                let [a, b] = [corners[k], corners[(k + 1) % 4]].map(|(i, j)| [x[i], y[j]]);
                Some([a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])])
            };
            let found: Vec<[f64; 2]> = (0..4).filter_map(crossing).collect();
            match found[..] {
                [a, b] => pieces.push([a, b]),
                [a, b, c, d] => {
                    // A saddle: its middle says which corners hang together.
                    let middle = 0.25 * v.iter().sum::<f64>();
                    let first = (middle > 0.0) == (v[0] > 0.0);
                    pieces.extend(if first { [[a, b], [c, d]] } else { [[d, a], [b, c]] });
                }
                _ => {}
            }
        }
    }
    joined(pieces)
}

/// Pieces with a common end as lines.
fn joined(mut pieces: Vec<[[f64; 2]; 2]>) -> Vec<Vec<[f64; 2]>> {
    let mut lines = Vec::new();
    while let Some([a, b]) = pieces.pop() {
        let mut line = std::collections::VecDeque::from([a, b]);
        // A node is shared by neighbouring cells to the last bit.
        let mut grow = |end: [f64; 2]| {
            let at = pieces.iter().position(|piece| piece.contains(&end))?;
            let [a, b] = pieces.swap_remove(at);
            Some(if a == end { b } else { a })
        };
        while let Some(next) = grow(line[line.len() - 1]) {
            line.push_back(next);
        }
        while let Some(next) = grow(line[0]) {
            line.push_front(next);
        }
        lines.push(line.into());
    }
    lines
}

/// About `count` round levels strictly between two values.
#[must_use]
pub fn levels(low: f64, high: f64, count: usize) -> Vec<f64> {
    let span = high - low;
    if !(span > 0.0 && span.is_finite()) {
        return Vec::new();
    }
    let raw = span / (count + 1) as f64;
    let tens = libm::pow(10.0, libm::floor(libm::log10(raw)));
    let step = [1.0, 2.0, 2.5, 5.0, 10.0].map(|k| k * tens).into_iter().find(|step| *step >= raw);
    let step = step.unwrap_or(10.0 * tens);
    let first = libm::floor(low / step) as i64 + 1;
    (first..first + 2 * count as i64 + 2)
        .map(|k| k as f64 * step)
        .take_while(|v| *v < high)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a plane the lines are straight, and each runs from edge to edge.
    #[test]
    fn lines_of_a_plane() {
        let x: Vec<f64> = (0..7).map(f64::from).collect();
        let y: Vec<f64> = (0..5).map(|j| 0.5 * f64::from(j)).collect();
        let values: Vec<f64> =
            x.iter().flat_map(|x| y.iter().map(move |y| 2.0 * x + 3.0 * y)).collect();
        let lines = contour(&x, &y, &values, 5.3);
        assert_eq!(lines.len(), 1);
        for [x, y] in &lines[0] {
            assert!((2.0 * x + 3.0 * y - 5.3).abs() < 1e-12);
        }
        let on_edge = |p: &[f64; 2]| [0.0, 6.0].contains(&p[0]) || [0.0, 2.0].contains(&p[1]);
        assert!(on_edge(&lines[0][0]) && on_edge(lines[0].last().unwrap()));
    }

    /// Around a hill a line closes; where values are missing there is none.
    #[test]
    fn lines_around_a_hill_close() {
        let x: Vec<f64> = (0..21).map(|i| f64::from(i) - 10.0).collect();
        let hill = |x: &f64, y: &f64| 100.0 - x * x - y * y;
        let values: Vec<f64> = x.iter().flat_map(|a| x.iter().map(move |b| hill(a, b))).collect();
        let lines = contour(&x, &x, &values, 61.5);
        assert_eq!(lines.len(), 1);
        assert_eq!(lines[0].first(), lines[0].last());
        let radius = lines[0].iter().map(|p| libm::hypot(p[0], p[1]));
        assert!(radius.into_iter().all(|r| (r - libm::sqrt(38.5)).abs() < 0.05));
        assert!(contour(&x, &x, &vec![f64::NAN; 441], 0.0).is_empty());
    }

    #[test]
    fn levels_are_round() {
        assert_eq!(levels(0.0, 10.0, 4), [2.0, 4.0, 6.0, 8.0]);
        assert_eq!(levels(113.0, 208.0, 6), [120.0, 140.0, 160.0, 180.0, 200.0]);
        assert!(levels(1.0, 1.0, 6).is_empty());
    }
}
