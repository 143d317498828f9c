//! Histories whose drawn peak is the tabled peak.

/// Points over time, with the place of the largest in size.
pub struct Trace {
    /// Time in s and value.
    pub points: Vec<[f64; 2]>,
    /// The point largest in size.
    pub peak: Option<[f64; 2]>,
}

impl Trace {
    /// Adds the extremes of the continuous motion, which lie between knots: `[lowest, highest]`.
    ///
    /// An extreme beyond those of the points is put beside the outermost point, where the parabola
    /// through it and its neighbours turns; others change nothing.
    pub fn new(mut points: Vec<[f64; 2]>, extremes: [f64; 2]) -> Self {
        let [lowest, highest] = extremes;
        lift(&mut points, highest, 1.0);
        lift(&mut points, lowest, -1.0);
        Self::of(points)
    }

    /// The same for a peak given as an absolute value: it goes where the points are largest.
    pub fn with_peak(mut points: Vec<[f64; 2]>, peak: f64) -> Self {
        let outermost = outermost(&points, f64::abs);
        let sign = outermost.map_or(1.0, |index| if points[index][1] < 0.0 { -1.0 } else { 1.0 });
        lift(&mut points, sign * peak, sign);
        Self::of(points)
    }

    /// The points as they are.
    pub fn of(points: Vec<[f64; 2]>) -> Self {
        let peak = outermost(&points, f64::abs).map(|index| points[index]);
        Self { points, peak }
    }

    /// All values, for the range of an axis.
    pub fn values(&self) -> impl Iterator<Item = f64> {
        self.points.iter().map(|point| point[1])
    }
}

fn lift(points: &mut Vec<[f64; 2]>, extreme: f64, sign: f64) {
    let Some(top) = outermost(points, |value| sign * value) else { return };
    let [time_s, value] = points[top];
    if !(extreme.is_finite() && sign * extreme > sign * value) {
        return;
    }
    let vertex_s = vertex(points, top).unwrap_or(time_s);
    let place = if vertex_s < time_s { top } else { top + 1 };
    points.insert(place, [vertex_s, extreme]);
}

/// Index of the first point with the largest measure.
fn outermost(points: &[[f64; 2]], measure: impl Fn(f64) -> f64) -> Option<usize> {
    let mut best: Option<usize> = None;
    for (i, point) in points.iter().enumerate() {
        let larger = |b: usize| measure(point[1]) > measure(points[b][1]);
        if point[1].is_finite() && best.is_none_or(larger) {
            best = Some(i);
        }
    }
    best
}

/// Where the parabola through a point and its two neighbours turns, if that is between them.
fn vertex(points: &[[f64; 2]], middle: usize) -> Option<f64> {
    let [ta, a] = *points.get(middle.checked_sub(1)?)?;
    let [tb, b] = points[middle];
    let [tc, c] = *points.get(middle + 1)?;
    let (left, right) = ((b - a) / (tb - ta), (c - b) / (tc - tb));
    let curvature = (right - left) / (tc - ta);
    let vertex_s = 0.5 * (ta + tb) - 0.5 * left / curvature;
    (vertex_s > ta && vertex_s < tc).then_some(vertex_s)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_peak_between_knots_is_put_where_the_parabola_turns() {
        // 4 − (t − 1.25)², sampled at 0, 1, 2.
        let points = [0.0, 1.0, 2.0].map(|t: f64| [t, 4.0 - (t - 1.25) * (t - 1.25)]).to_vec();
        let trace = Trace::with_peak(points, 4.0);
        assert_eq!(trace.points[2], [1.25, 4.0]);
        assert_eq!(trace.peak, Some([1.25, 4.0]));
    }

    #[test]
    fn signs_and_edges() {
        let down = Trace::with_peak(vec![[0.0, 1.0], [1.0, -2.0]], 2.5);
        assert_eq!(down.peak, Some([1.0, -2.5]));
        let known = Trace::with_peak(vec![[0.0, 1.0], [1.0, -2.0]], 2.0);
        assert_eq!(known.points.len(), 2);
        let both = Trace::new(vec![[0.0, 0.0], [1.0, 1.0], [2.0, -1.0], [3.0, 0.0]], [-1.1, 1.2]);
        assert_eq!(both.points.len(), 6);
        assert!(Trace::with_peak(Vec::new(), 1.0).peak.is_none());
        assert_eq!(Trace::with_peak(vec![[0.0, 1.0]], f64::NAN).points.len(), 1);
    }
}
