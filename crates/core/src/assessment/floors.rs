//! Floor response spectra: those of table, block and floors, or of the points of a structure by its modes.

use crate::error::{MotionError, Stopped};
use crate::input::Names;
use crate::motion::intensity::SaInPlane;
use crate::motion::{GroundMotion, spectrum};
use crate::progress::Cancel;
use crate::response::Response;

/// Damping ratio of the oscillators.
const DAMPING_RATIO: f64 = 0.05;

/// First and last period in s, and how many there are at equal ratios, both among them.
const PERIODS: (f64, f64, u32) = (0.02, 4.0, 120);

/// Periods in s that tables show; all floor spectra have them.
pub const TABLED_PERIODS_S: [f64; 6] = [0.05, 0.1, 0.2, 0.5, 1.0, 2.0];

/// Knots of a history from which on spectra are computed one period at a time, to be stopped.
const LONG_HISTORY: usize = 100_000;

/// Absolute-acceleration response spectra of table, block and floors.
///
/// The acceleration of a floor is that of the knots of the history, both sides of jumps among them, linear between
/// them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FloorSpectra {
    /// Damping ratio ξ of the oscillators, such as 0.05.
    pub damping_ratio: f64,
    /// Periods in s, increasing, > 0.
    pub periods_s: Vec<f64>,
    /// The spectra; where the table moves in two horizontal directions RotD100, the largest over all directions.
    pub sa: PlaceSpectra,
    /// Along x and along y, where the table moves in two horizontal directions.
    pub axes: Option<[PlaceSpectra; 2]>,
}

/// Spectral accelerations of the places where equipment stands, one a period, in m/s².
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlaceSpectra {
    /// Of the table; may be empty.
    pub table_m_per_s2: Vec<f64>,
    /// Of the block.
    pub block_m_per_s2: Vec<f64>,
    /// Of each floor from the block up, or each point of a structure by its modes.
    pub storeys_m_per_s2: Vec<Vec<f64>>,
}

impl FloorSpectra {
    /// Those of a response to a motion, of which the table's spectrum is; none without a history.
    ///
    /// # Errors
    /// [`Stopped`] where `go_on` says no, which is asked for every place, and of a long history for every period.
    pub fn of(
        motion: &GroundMotion,
        response: &Response,
        go_on: Cancel<'_>,
    ) -> Result<Option<Self>, Stopped> {
        let Some(x) = &response.history else { return Ok(None) };
        let plane = response.in_plane.as_ref();
        let y = plane.and_then(|plane| plane.history.as_ref());
        let own = |list: &[f64]| vec![list.to_vec()];
        let table = Shaken {
            times_s: motion.times_s(),
            x: own(motion.horizontal_m_per_s2()),
            y: motion.horizontal_y_m_per_s2().filter(|_| y.is_some()).map(own),
        };
        let points = y.map_or_else(|| x.point_count(), |y| y.point_count(x));
        let mut above = Shaken {
            times_s: &x.time_s,
            x: own(&x.block_acceleration_m_per_s2),
            y: y.map(|y| own(&y.block_acceleration_m_per_s2)),
        };
        let at_knots = |of: &dyn Fn(usize) -> f64| (0..x.len()).map(of).collect::<Vec<f64>>();
        for i in 0..points {
            match (y, &mut above.y) {
                (Some(y), Some(along_y)) => {
                    above.x.push(at_knots(&|knot| y.point_acceleration(x, knot, i)[0]));
                    along_y.push(at_knots(&|knot| y.point_acceleration(x, knot, i)[1]));
                }
                _ => above.x.push(at_knots(&|knot| x.point_acceleration(knot, i))),
            }
        }
        let periods_s = periods();
        let table = table.sa(&periods_s, go_on)?;
        let above = above.sa(&periods_s, go_on)?;
        let places = |of: fn(&SaInPlane) -> &Vec<f64>| PlaceSpectra {
            table_m_per_s2: of(&table[0]).clone(),
            block_m_per_s2: of(&above[0]).clone(),
            storeys_m_per_s2: above[1..].iter().map(|storey| of(storey).clone()).collect(),
        };
        let axes = y.map(|_| [places(|sa| &sa.x_m_per_s2), places(|sa| &sa.y_m_per_s2)]);
        let sa = match y {
            None => places(|sa| &sa.x_m_per_s2),
            Some(_) => places(|sa| &sa.rotd100_m_per_s2),
        };
        Ok(Some(Self { damping_ratio: DAMPING_RATIO, sa, axes, periods_s }))
    }
}

impl FloorSpectra {
    /// The spectra of the one direction; of two RotD100, then those along x and along y.
    pub fn in_directions(&self) -> impl Iterator<Item = &PlaceSpectra> {
        core::iter::once(&self.sa).chain(self.axes.iter().flatten())
    }
}

impl PlaceSpectra {
    /// The spectra from the ground up: table, block, floors.
    pub fn places(&self) -> impl Iterator<Item = &[f64]> {
        let storeys = self.storeys_m_per_s2.iter().map(|sa| &sa[..]);
        [&self.table_m_per_s2[..], &self.block_m_per_s2].into_iter().chain(storeys)
    }
}

/// What a place is called, counted as in [`PlaceSpectra::places`]: the ground, the block, a floor or a point.
#[must_use]
pub fn place_name(names: &Names, place: usize) -> String {
    match place {
        0 => "Ground".to_owned(),
        1 => names.block().to_owned(),
        point => names.point(point - 1),
    }
}

/// All periods in s, those of tables among them.
fn periods() -> Vec<f64> {
    let (from_s, to_s, count) = PERIODS;
    let last = f64::from(count - 1);
    let ratio = to_s / from_s;
    let even = (0..count).map(|i| from_s * libm::pow(ratio, f64::from(i) / last));
    let mut periods_s: Vec<f64> = even.chain(TABLED_PERIODS_S).collect();
    periods_s.sort_by(f64::total_cmp);
    periods_s
}

/// Accelerations of places in m/s² at the same times in s: of each along x, and along y where there are two
/// directions.
struct Shaken<'a> {
    times_s: &'a [f64],
    x: Vec<Vec<f64>>,
    y: Option<Vec<Vec<f64>>>,
}

impl Shaken<'_> {
    /// The spectra of each place, in one direction along x alone; empty where the history is too short for one.
    fn sa(&self, periods_s: &[f64], go_on: Cancel<'_>) -> Result<Vec<SaInPlane>, Stopped> {
        let mut all = vec![SaInPlane::default(); self.x.len()];
        let samples = self.times_s.len() * self.y.as_ref().map_or(1, Vec::len);
        let together = if samples < LONG_HISTORY { periods_s.len() } else { 1 };
        for periods_s in periods_s.chunks(together) {
            let found = match &self.y {
                Some(y) => {
                    let motions = self.x.iter().zip(y).map(|(x, y)| [&x[..], y]);
                    let motions: Vec<[&[f64]; 2]> = motions.collect();
                    asked(go_on)?;
                    SaInPlane::of_each(self.times_s, &motions, periods_s, DAMPING_RATIO)
                }
                None => {
                    let along = |x: &Vec<f64>| -> Result<_, Stopped> {
                        asked(go_on)?;
                        Ok(self.along_x(x, periods_s))
                    };
                    let along: Vec<_> = self.x.iter().map(along).collect::<Result<_, Stopped>>()?;
                    along.into_iter().collect()
                }
            };
            let Ok(found) = found else { return Ok(vec![SaInPlane::default(); self.x.len()]) };
            for (all, found) in all.iter_mut().zip(found) {
                all.x_m_per_s2.extend(found.x_m_per_s2);
                all.y_m_per_s2.extend(found.y_m_per_s2);
                all.rotd100_m_per_s2.extend(found.rotd100_m_per_s2);
            }
        }
        Ok(all)
    }

    fn along_x(&self, x: &[f64], periods_s: &[f64]) -> Result<SaInPlane, MotionError> {
        let spectrum = spectrum(self.times_s, x, periods_s, &[DAMPING_RATIO])?;
        let along_x = spectrum.ordinates.iter().map(|ordinates| ordinates.sa_m_per_s2);
        Ok(SaInPlane { x_m_per_s2: along_x.collect(), ..SaInPlane::default() })
    }
}

/// Asks whether to go on.
fn asked(go_on: Cancel<'_>) -> Result<(), Stopped> {
    if go_on().is_break() { Err(Stopped) } else { Ok(()) }
}
