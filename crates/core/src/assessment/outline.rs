//! What a figure shows of a line over time: a few points of each column of its pixels.

use crate::response::Response;

/// Columns into which an outline divides a history; no figure has more pixels along its time axis.
pub const COLUMNS: usize = 700;

/// Indices of the points of a line over time to draw: in each column the first, the lowest, the highest and the
/// last, in order of time. The extremes of the whole are always among them.
///
/// `column` gives the column of a point; columns do not decrease.
pub fn shown(y: &[f64], column: impl Fn(usize) -> i64) -> Vec<usize> {
    let mut kept = Vec::new();
    let mut start = 0;
    while start < y.len() {
        let here = column(start);
        let (mut low, mut high, mut end) = (start, start, start);
        while end + 1 < y.len() && column(end + 1) == here {
            end += 1;
            if y[end] < y[low] {
                low = end;
            }
            if y[end] > y[high] {
                high = end;
            }
        }
        let mut few = [start, low, high, end];
        few.sort_unstable();
        for index in few {
            if kept.last() != Some(&index) {
                kept.push(index);
            }
        }
        start = end + 1;
    }
    kept
}

/// The sliding displacement over time in the points that a figure shows of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SlidingOutline {
    /// Times in s, the first and the last of the history among them.
    pub time_s: Vec<f64>,
    /// Sliding displacements in m at these times; their sizes where the block slides in two directions.
    pub sliding_displacement_m: Vec<f64>,
}

impl SlidingOutline {
    /// That of a response; `None` where it has no history.
    #[must_use]
    pub fn of(response: &Response) -> Option<Self> {
        let history = response.history.as_ref()?;
        let x = &history.sliding_displacement_m;
        let along_y = response.in_plane.as_ref().and_then(|plane| plane.history.as_ref());
        Some(match along_y {
            None => Self::through(&history.time_s, x),
            Some(y) => {
                let both = x.iter().zip(&y.sliding_displacement_m);
                let sizes: Vec<f64> = both.map(|(x, y)| (x * x + y * y).sqrt()).collect();
                Self::through(&history.time_s, &sizes)
            }
        })
    }

    /// That of displacements in m at times in s, which do not decrease. Of an outline it is that outline.
    #[must_use]
    pub fn through(time_s: &[f64], sliding_displacement_m: &[f64]) -> Self {
        let count = time_s.len().min(sliding_displacement_m.len());
        let (time_s, sliding_m) = (&time_s[..count], &sliding_displacement_m[..count]);
        let start_s = time_s.first().copied().unwrap_or_default();
        let duration_s = time_s.last().map_or(0.0, |end_s| end_s - start_s);
        // Of an instant alone 0 / 0 is in column 0.
        let column = |i: usize| (COLUMNS as f64 * ((time_s[i] - start_s) / duration_s)) as i64;
        let shown = shown(sliding_m, column);
        Self {
            time_s: shown.iter().map(|&i| time_s[i]).collect(),
            sliding_displacement_m: shown.iter().map(|&i| sliding_m[i]).collect(),
        }
    }

    /// Times in s and displacements in m, point by point.
    pub fn points(&self) -> impl Iterator<Item = [f64; 2]> {
        self.time_s.iter().zip(&self.sliding_displacement_m).map(|(t, s)| [*t, *s])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_each_column_the_first_lowest_highest_and_last_are_shown() {
        let y = [0.0, 5.0, -3.0, 1.0, 2.0, 2.0];
        let kept = shown(&y, |i| if i < 4 { 0 } else { 1 });
        assert_eq!(kept, [0, 1, 2, 3, 4, 5]);
        let long: Vec<f64> = (0..100_000).map(|i| f64::from(i % 977)).collect();
        let kept = shown(&long, |i| i as i64 / 1000);
        assert!(kept.len() <= 400);
        assert!(kept.iter().any(|&i| long[i] == 976.0));
        assert!(shown(&[], |_| 0).is_empty());
    }

    /// A history of any length takes at most four points a column, and no column loses its extremes: the slowest wave
    /// here has hundreds of samples in a column, the fastest has several waves in one.
    #[test]
    fn an_outline_is_small_and_holds_every_extreme_of_a_column() {
        for (count, rate) in [(90_000_u32, 0.5), (90_000, 40.0), (4_000, 3.0), (500, 2.0)] {
            let time_s: Vec<f64> =
                (0..count).map(|k| 60.0 * f64::from(k) / f64::from(count)).collect();
            let wave = |t: &f64| libm::sin(rate * t) * libm::exp(-0.05 * t);
            let sliding_m: Vec<f64> = time_s.iter().map(wave).collect();
            let outline = SlidingOutline::through(&time_s, &sliding_m);
            assert!(outline.time_s.len() <= 4 * (COLUMNS + 1), "{}", outline.time_s.len());
            assert_eq!(outline.time_s.len(), outline.sliding_displacement_m.len());
            assert_eq!(
                [outline.time_s.first(), outline.time_s.last()],
                [time_s.first(), time_s.last()]
            );

            let extremes = |points: &mut dyn Iterator<Item = [f64; 2]>| {
                let mut of = vec![[f64::INFINITY, f64::NEG_INFINITY]; COLUMNS + 1];
                for [t, s] in points {
                    let column =
                        &mut of[(COLUMNS as f64 * (t / time_s[time_s.len() - 1])) as usize];
                    *column = [column[0].min(s), column[1].max(s)];
                }
                of
            };
            let mut whole = time_s.iter().zip(&sliding_m).map(|(t, s)| [*t, *s]);
            assert_eq!(extremes(&mut outline.points()), extremes(&mut whole));
            let again = SlidingOutline::through(&outline.time_s, &outline.sliding_displacement_m);
            assert_eq!(again, outline);
        }
        assert_eq!(
            SlidingOutline::through(&[0.0], &[0.1]).points().collect::<Vec<_>>(),
            [[0.0, 0.1]]
        );
        assert_eq!(SlidingOutline::through(&[], &[]), SlidingOutline::default());
    }
}
