//! Floor response spectra: those of table, block and floors, or of the points of a structure by its modes.

use std::borrow::Cow;

use crate::error::{MotionError, Stopped};
use crate::input::Names;
use crate::motion::intensity::SaInPlane;
use crate::motion::{GroundMotion, spectrum};
use crate::progress::GoOn;
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
        go_on: GoOn<'_>,
    ) -> Result<Option<Self>, Stopped> {
        let Some(x) = &response.history else { return Ok(None) };
        let plane = response.in_plane.as_ref();
        let y = plane.and_then(|plane| plane.history.as_ref());
        let at_knots = |along_x: &dyn Fn(usize) -> f64| (0..x.len()).map(along_x).collect();
        let times_s = &x.time_s[..];
        let table = Shaken {
            times_s: motion.times_s(),
            x: motion.horizontal_m_per_s2().into(),
            y: motion.horizontal_y_m_per_s2().filter(|_| y.is_some()).map(Cow::from),
        };
        let block = Shaken {
            times_s,
            x: (&x.block_acceleration_m_per_s2[..]).into(),
            y: y.map(|y| (&y.block_acceleration_m_per_s2[..]).into()),
        };
        let point = |i: usize| match y {
            None => Shaken { times_s, x: at_knots(&|knot| x.point_acceleration(knot, i)), y: None },
            Some(y) => Shaken {
                times_s,
                x: at_knots(&|knot| y.point_acceleration(x, knot, i)[0]),
                y: Some(at_knots(&|knot| y.point_acceleration(x, knot, i)[1])),
            },
        };
        let points = y.map_or_else(|| x.point_count(), |y| y.point_count(x));
        let periods_s = periods();
        let of = |shaken: &Shaken<'_>| shaken.sa(&periods_s, go_on);
        let storeys: Result<Vec<_>, Stopped> = (0..points).map(|i| of(&point(i))).collect();
        let (table, block, storeys) = (of(&table)?, of(&block)?, storeys?);
        let places = |of: fn(&SaInPlane) -> &Vec<f64>| PlaceSpectra {
            table_m_per_s2: of(&table).clone(),
            block_m_per_s2: of(&block).clone(),
            storeys_m_per_s2: storeys.iter().map(|storey| of(storey).clone()).collect(),
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

/// Accelerations of a place in m/s² at its times in s: along x, and along y where there are two directions.
struct Shaken<'a> {
    times_s: &'a [f64],
    x: Cow<'a, [f64]>,
    y: Option<Cow<'a, [f64]>>,
}

impl Shaken<'_> {
    /// Its spectra, in one direction along x alone; empty where it is too short for one.
    fn sa(&self, periods_s: &[f64], go_on: GoOn<'_>) -> Result<SaInPlane, Stopped> {
        let together = if self.times_s.len() < LONG_HISTORY { periods_s.len() } else { 1 };
        let mut all = SaInPlane::default();
        for periods_s in periods_s.chunks(together) {
            if go_on().is_break() {
                return Err(Stopped);
            }
            let Ok(some) = self.sa_at(periods_s) else { return Ok(SaInPlane::default()) };
            all.x_m_per_s2.extend(some.x_m_per_s2);
            all.y_m_per_s2.extend(some.y_m_per_s2);
            all.rotd100_m_per_s2.extend(some.rotd100_m_per_s2);
        }
        Ok(all)
    }

    fn sa_at(&self, periods_s: &[f64]) -> Result<SaInPlane, MotionError> {
        if let Some(y) = &self.y {
            return SaInPlane::of(self.times_s, [&self.x, y], periods_s, DAMPING_RATIO);
        }
        let spectrum = spectrum(self.times_s, &self.x, periods_s, &[DAMPING_RATIO])?;
        let along_x = spectrum.ordinates.iter().map(|ordinates| ordinates.sa_m_per_s2);
        Ok(SaInPlane { x_m_per_s2: along_x.collect(), ..SaInPlane::default() })
    }
}
