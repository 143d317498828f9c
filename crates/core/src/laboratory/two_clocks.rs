//! Displacement and force of a cyclic test in two files, each with a clock of its own.
//!
//! Friction turns round with the displacement, so that the force shows when its clock says what the other one says: at the
//! shift at which the loop is thinnest, what friction and spring leave of the force being least. It is sought within a
//! quarter of a cycle of what the mapping says. A lag of the force looks like a damper, `K x(t − l) ≈ K x − K l ẋ`: of
//! such a test none can be determined.

use super::compare::linear;
use super::cyclic::{CyclicTest, KineticLaw, cyclic};
use super::identify::cyclic_histories;
use super::measured::{Measured, MeasuredError, MeasuredSeries};
use crate::input::Mapping;
use crate::notice::{Notice, NoticeKind};
use crate::record;

/// Shifts to either side that are looked at, over a quarter of a cycle.
const SHIFTS: i32 = 24;
/// Steps of the search between two shifts, by the golden section.
const HALVINGS: usize = 24;

/// Reads two files as one test; the mapping is of both.
///
/// # Errors
/// [`MeasuredError`] as [`Measured::read`], where the two lack displacement or force, and where they overlap by too little.
pub fn read_two(
    [first, second]: [(&str, &[u8]); 2],
    mapping: &Mapping,
) -> Result<Measured, MeasuredError> {
    let [a, b] = [first, second].map(|(name, bytes)| record::columns(name, bytes));
    let (a, b) = (a?, b?);
    // What neither has is an error of the first.
    let of_second = mapping.of_columns(|entry| Measured::has(&b, mapping, entry));
    let of_first = mapping.of_columns(|entry| {
        Measured::has(&a, mapping, entry) || !Measured::has(&b, mapping, entry)
    });
    let all = Measured::of_columns(a, &of_first)?.beside(Measured::of_columns(b, &of_second)?);
    let [displacement, force] = cyclic_histories(&all)?;
    if displacement.times_s == force.times_s {
        return Ok(all);
    }
    let Some(aligned) = Aligned::new(displacement, force) else { return Ok(all) };
    let (displacement, force) = (displacement.clone(), force.clone());
    Ok(aligned.of(all, displacement, force))
}

/// Two histories at the times of the first, the second shifted.
struct Aligned {
    times_s: Vec<f64>,
    displacement: Vec<f64>,
    force: Vec<f64>,
    shift_s: f64,
}

impl Aligned {
    /// `None` where the two do not overlap by three cycles.
    fn new(displacement: &MeasuredSeries, force: &MeasuredSeries) -> Option<Self> {
        let frequency_hz = {
            let flat = vec![0.0; displacement.values.len()];
            let test = test(&displacement.times_s, &displacement.values, &flat);
            cyclic(&test).ok()?.cycles.first()?.frequency_hz
        };
        let most_s = 0.25 / frequency_hz;
        let [start_s, end_s] = [*force.times_s.first()?, *force.times_s.last()?];
        let inside = |t: &f64| (start_s + most_s..=end_s - most_s).contains(t);
        let rows: Vec<usize> =
            (0..displacement.times_s.len()).filter(|i| inside(&displacement.times_s[*i])).collect();
        let times_s: Vec<f64> = rows.iter().map(|i| displacement.times_s[*i]).collect();
        let values: Vec<f64> = rows.iter().map(|i| displacement.values[*i]).collect();
        let forces = |shift_s: f64| -> Vec<f64> {
            times_s.iter().map(|t| linear(&force.times_s, &force.values, t + shift_s)).collect()
        };
        let left = |shift_s: f64| {
            let forces = forces(shift_s);
            let fit = cyclic(&test(&times_s, &values, &forces));
            fit.map_or(f64::INFINITY, |fit| fit.cycles.iter().map(|c| c.residual_n).sum::<f64>())
        };
        let step_s = most_s / f64::from(SHIFTS);
        let all = (-SHIFTS..=SHIFTS).map(|k| f64::from(k) * step_s);
        let scored = all.map(|shift_s| (left(shift_s), shift_s));
        let (_, middle_s) =
            scored.min_by(|a, b| a.0.total_cmp(&b.0)).filter(|best| best.0.is_finite())?;
        let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
        let (mut low, mut high) = (middle_s - step_s, middle_s + step_s);
        for _ in 0..HALVINGS {
            let width = golden * (high - low);
            if left(high - width) < left(low + width) {
                high = low + width
            } else {
                low = high - width
            }
        }
        let shift_s = 0.5 * (low + high);
        Some(Self { displacement: values, force: forces(shift_s), times_s, shift_s })
    }

    /// The test with both histories in place of those of the files.
    fn of(
        self,
        mut all: Measured,
        displacement: MeasuredSeries,
        force: MeasuredSeries,
    ) -> Measured {
        let Self { times_s, displacement: x, force: f, shift_s } = self;
        let message = format!(
            "displacement and force have clocks of their own: that of the force was taken as {:.2} ms {}, where the loop \
             is thinnest, and the force was interpolated at the times of the displacement; a damper cannot be told from such \
             a lag",
            1e3 * shift_s.abs(),
            if shift_s > 0.0 { "late" } else { "early" }
        );
        all.warnings.push(Notice::new(NoticeKind::ClocksAligned, message));
        let origin = format!("{}, {:+.3e} s", force.origin, -shift_s);
        all.series = vec![
            MeasuredSeries { times_s: times_s.clone(), values: x, ..displacement },
            MeasuredSeries { times_s, values: f, origin, ..force },
        ];
        all.is_of_two_clocks = true;
        all
    }
}

fn test<'a>(times_s: &'a [f64], displacement_m: &'a [f64], force_n: &'a [f64]) -> CyclicTest<'a> {
    CyclicTest {
        times_s,
        displacement_m,
        force_n,
        slack_m: None,
        spring: true,
        damper: false,
        law: KineticLaw::Coulomb,
        zero_known: false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::Channel;
    use crate::laboratory::cyclic::estimates;
    use crate::numerics::random::Random;

    /// Displacement at 500 Hz and force at 800 Hz, the clock of the force 37 ms late.
    #[test]
    fn a_force_whose_clock_is_late_is_brought_back() {
        let mut random = Random::new(3);
        let (omega, late_s) = (core::f64::consts::TAU * 0.5, 0.037);
        let x = |t: f64| 0.02 * libm::sin(omega * t);
        let v = |t: f64| 0.02 * omega * libm::cos(omega * t);
        let mut displacement = "time_s,x (mm)\n".to_owned();
        for i in 0..9000 {
            let t = f64::from(i) / 500.0;
            displacement.push_str(&format!("{t:.4},{:e}\n", 1e3 * (x(t) + 1e-6 * random.normal())));
        }
        let mut force = "time_s,F (kN)\n".to_owned();
        for i in 0..14400 {
            let t = f64::from(i) / 800.0;
            let friction = 180.0 * v(t - late_s).signum();
            let newton = friction + 4000.0 * x(t - late_s) + 0.5 * random.normal();
            force.push_str(&format!("{t:.5},{:e}\n", 1e-3 * newton));
        }
        let options = ["displacement=x (mm)", "force=F (kN)"].map(str::to_owned);
        let mapping = Mapping::parse(None, &options).unwrap();
        let files = [("x.csv", displacement.as_bytes()), ("f.csv", force.as_bytes())];
        let measured = read_two(files, &mapping).unwrap();
        assert!(measured.is_of_two_clocks);
        let notice =
            measured.warnings.iter().find(|w| w.kind == NoticeKind::ClocksAligned).unwrap();
        assert!(notice.message.contains("37.") || notice.message.contains("36.9"), "{notice:?}");
        assert!(!notice.message.contains(['\\', '\n']), "{notice:?}");
        let [x, f] = cyclic_histories(&measured).unwrap();
        let fit = cyclic(&test(&x.times_s, &x.values, &f.values)).unwrap();
        let found = estimates(&[&fit], 300.0, None);
        for (estimate, truth) in
            [(&found.estimates[0], 180.0), (found.estimates.last().unwrap(), 4000.0)]
        {
            assert!((estimate.value().unwrap() / truth - 1.0).abs() < 2e-3, "{estimate:?}");
        }
        // A column that neither has is an error.
        let options = ["displacement=x (mm)", "force=G [kN]"].map(str::to_owned);
        let mapping = Mapping::parse(None, &options).unwrap();
        assert!(read_two(files, &mapping).unwrap_err().to_string().contains("\"G\""));
        assert_eq!(measured.series[1].channel, Channel::Force);
    }
}
