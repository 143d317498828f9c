//! What is looked for in every channel, whatever its format: a start that is not at rest, drift,
//! clipped peaks, gaps and repeated rows.

use slipstick_dynamics::notice::{Notice, NoticeKind};
use slipstick_dynamics::numerics::fractile::upper_median;
use slipstick_dynamics::units::STANDARD_GRAVITY_M_PER_S2;

use super::{Channel, Quantity, Sampling, Units};

/// Values at a peak that follow one another unchanged: fewer happen by rounding.
const CLIPPED_RUN: usize = 4;

/// The warnings of [`rest`] and of [`beyond_earthquakes`]: what is said of a motion as it is used,
/// scaled or processed, rather than of the file.
pub const REST_KINDS: [NoticeKind; 4] = [
    NoticeKind::FirstSampleNotZero,
    NoticeKind::FirstSampleSmall,
    NoticeKind::RecordDrift,
    NoticeKind::AbsurdMotion,
];

/// Longest usual step of a record, in s: that of the coarsest recorders is 0.02 s.
const LONGEST_STEP_S: f64 = 0.1;

/// Peak velocity in m/s and displacement in m that no earthquake has; the largest that were recorded are
/// some 5 m/s and 10 m.
const LARGEST_VELOCITY_M_PER_S: f64 = 10.0;
const LARGEST_DISPLACEMENT_M: f64 = 100.0;

/// Fewest values of which it means something that none is below 0.
const LEAST_ONE_SIDED: usize = 10;

/// Shares of the range within which a plateau lies, and how much steeper than a rounded top the values
/// run into it: of a parabola that is 1 to 2 whatever the share.
const PLATEAU_SHARES: [f64; 3] = [0.001, 0.003, 0.01];
const PLATEAU_EDGE: f64 = 4.0;

/// Share of the peak up to which a first sample is worth a note only.
const SMALL_FIRST_SAMPLE: f64 = 0.01;

/// Peaks that no earthquake has, in m/s²: the units are not those of the values. The largest that were
/// recorded are about 4 g, the smallest that are kept some ten-thousandths of it.
const ABSURD_PEAKS_M_PER_S2: [f64; 2] =
    [5e-5 * STANDARD_GRAVITY_M_PER_S2, 5.0 * STANDARD_GRAVITY_M_PER_S2];

/// Warnings about a motion that does not begin or end at rest: a first acceleration other than 0, which
/// up to 1 % of the peak is a note, and a velocity at the end beyond 5 % of the peak velocity.
#[must_use]
pub fn rest(
    first_m_per_s2: f64,
    pga_m_per_s2: f64,
    end_velocity_m_per_s: f64,
    pgv_m_per_s: f64,
) -> Vec<Notice> {
    let mut warnings = Vec::new();
    let [not_zero, small, drift, _] = REST_KINDS;
    if first_m_per_s2 != 0.0 {
        let is_small = first_m_per_s2.abs() <= SMALL_FIRST_SAMPLE * pga_m_per_s2;
        let message = format!(
            "the first sample is {} m/s², not 0: taken as a jump at the start of \
             the motion",
            figures(first_m_per_s2)
        );
        warnings.push(Notice::new(if is_small { small } else { not_zero }, message));
    }
    if end_velocity_m_per_s.abs() > 0.05 * pgv_m_per_s {
        let percent = 100.0 * end_velocity_m_per_s.abs() / pgv_m_per_s;
        let message = format!(
            "the record drifts: its velocity at the end is {} m/s, \
             {percent:.0} % of its peak; nothing was corrected",
            figures(end_velocity_m_per_s)
        );
        warnings.push(Notice::new(drift, message));
    }
    warnings
}

/// A notice of a motion whose peaks no earthquake has: its clock or its factor is wrong.
#[must_use]
pub fn beyond_earthquakes(pga_m_per_s2: f64, pgv_m_per_s: f64, pgd_m: f64) -> Option<Notice> {
    let [_, largest_pga] = ABSURD_PEAKS_M_PER_S2;
    let peaks = [
        ("acceleration", pga_m_per_s2 / STANDARD_GRAVITY_M_PER_S2, "g", pga_m_per_s2 > largest_pga),
        ("velocity", pgv_m_per_s, "m/s", pgv_m_per_s > LARGEST_VELOCITY_M_PER_S),
        ("displacement", pgd_m, "m", pgd_m > LARGEST_DISPLACEMENT_M),
    ];
    let beyond = peaks.iter().filter(|(.., is_beyond)| *is_beyond);
    let beyond: Vec<String> = beyond
        .map(|(of, peak, unit, _)| format!("a peak {of} of {} {unit}", figures(*peak)))
        .collect();
    (!beyond.is_empty()).then(|| {
        let message = format!(
            "the motion has {}, as no earthquake has: check the time step, the units and the factor",
            beyond.join(" and ")
        );
        Notice::new(NoticeKind::AbsurdMotion, message)
    })
}

/// A step at which no record is sampled.
fn long_step(sampling: &Sampling) -> Option<Notice> {
    let usual_s = match sampling {
        Sampling::Dt(dt_s) => *dt_s,
        Sampling::Times(times_s) => {
            let steps = times_s.windows(2).map(|t| t[1] - t[0]);
            upper_median(steps.filter(|step| *step > 0.0))?
        }
    };
    // Rounding of the times may make 0.1 s a little more.
    (usual_s > (1.0 + 1e-9) * LONGEST_STEP_S).then(|| {
        let message = format!(
            "the samples lie {} s apart, which no record does: if the times are milliseconds or \
             numbers of samples, give the time step as dt",
            round(usual_s)
        );
        Notice::new(NoticeKind::LongStep, message)
    })
}

/// Values of which none is below 0 and the last is above it, as ordinates of a spectrum are.
fn one_sided(values: &[f64]) -> Option<Notice> {
    let ends_above = values.last().is_some_and(|last| *last > 0.0);
    let none_below = || values.iter().all(|value| *value >= 0.0);
    (values.len() >= LEAST_ONE_SIDED && ends_above && none_below()).then(|| {
        let message = "no value is below 0 and the last is above it: a spectrum, or another quantity, \
                       is no ground motion";
        Notice::new(NoticeKind::OneSided, message)
    })
}

/// A peak that the values can only have in another unit.
fn absurd(pga_m_per_s2: f64, units: &Units) -> Option<Notice> {
    let [least, largest] = ABSURD_PEAKS_M_PER_S2;
    let is_absurd = pga_m_per_s2 > largest || (pga_m_per_s2 > 0.0 && pga_m_per_s2 < least);
    is_absurd.then(|| {
        let in_g = match units.to_string().as_str() {
            "g" => String::new(),
            _ => format!(", {:.3e} g", pga_m_per_s2 / STANDARD_GRAVITY_M_PER_S2),
        };
        let peak = pga_m_per_s2 / units.si();
        let message =
            format!("the largest acceleration is {} {units}{in_g}: check the units", figures(peak));
        Notice::new(NoticeKind::AbsurdPeak, message)
    })
}

/// Four decimals, or by a power of ten where the number is small.
fn figures(x: f64) -> String {
    if x.abs() < 1e-3 { format!("{x:.2e}") } else { format!("{x:.4}") }
}

/// Adds to a channel the warnings that its values and times call for.
pub(super) fn inspect(channel: &mut Channel) {
    let warnings = judged(&channel.values, &channel.sampling, &channel.units);
    channel.warnings.extend(warnings);
}

/// What values in SI at their times call for, read in these units.
pub fn judged(values: &[f64], sampling: &Sampling, units: &Units) -> Vec<Notice> {
    let mut warnings = Vec::new();
    if units.quantity() == Quantity::Acceleration
        && let Some(&first) = values.first()
    {
        let Integrals { end_velocity, velocity, displacement } = Integrals::of(values, sampling);
        let pga = values.iter().fold(0.0_f64, |pga, a| pga.max(a.abs()));
        warnings.extend(rest(first, pga, end_velocity, velocity));
        warnings.extend(absurd(pga, units));
        // The peak acceleration was said in the units of the file.
        warnings.extend(beyond_earthquakes(0.0, velocity, displacement));
        warnings.extend(one_sided(values));
    }
    warnings.extend(long_step(sampling));
    warnings.extend(clipped(values, units.si()));
    if let Sampling::Times(times_s) = sampling {
        warnings.extend(gap(times_s));
        warnings.extend(repeated(times_s, values));
    }
    warnings
}

/// Of a last line that is words and none of the numbers.
pub(super) fn last_line_of_words(line: usize) -> Notice {
    let message = format!("the last line, {line}, is words and no numbers: skipped");
    Notice::new(NoticeKind::ColumnSkipped, message)
}

/// A warning where the largest value of a channel is not the peak that its file states: `stated` in
/// `unit`, written with a last digit of `ulp`, on a line of that number. Half a percent and three
/// units in the last digit are allowed, because programs that wrote both rounded in between.
pub(super) fn peak_differs(
    channel: &Channel,
    stated: f64,
    ulp: f64,
    unit: Units,
    line: usize,
) -> Option<Notice> {
    let peak = channel.values.iter().fold(0.0_f64, |peak, value| peak.max(value.abs()));
    let peak = peak / unit.si();
    let differs = (peak - stated.abs()).abs() > 3.0 * ulp + 0.005 * stated.abs();
    differs.then(|| {
        Notice::new(
            NoticeKind::PeakDiffers,
            format!("line {line} states a peak of {stated} {unit}, the values have {peak:.6}"),
        )
    })
}

/// Integrals of an acceleration from rest: the trapezium rule, which is exact at the samples of straight
/// lines for the velocity, and the displacement of straight lines.
struct Integrals {
    /// Velocity at the end, in m/s.
    end_velocity: f64,
    /// Its largest size at a sample, in m/s.
    velocity: f64,
    /// The largest displacement at a sample, in m.
    displacement: f64,
}

impl Integrals {
    fn of(values: &[f64], sampling: &Sampling) -> Self {
        let (mut v, mut u) = (0.0_f64, 0.0_f64);
        let mut all = Self { end_velocity: 0.0, velocity: 0.0, displacement: 0.0 };
        let mut pass = |dt_s: f64, a: &[f64]| {
            u += dt_s * (v + dt_s * (2.0 * a[0] + a[1]) / 6.0);
            v += dt_s * 0.5 * (a[0] + a[1]);
            all.velocity = all.velocity.max(v.abs());
            all.displacement = all.displacement.max(u.abs());
        };
        let pairs = values.windows(2);
        match sampling {
            Sampling::Dt(dt_s) => pairs.for_each(|a| pass(*dt_s, a)),
            Sampling::Times(times_s) => {
                times_s.windows(2).zip(pairs).for_each(|(t, a)| pass(t[1] - t[0], a));
            }
        }
        Self { end_velocity: v, ..all }
    }
}

/// Values held at an extreme.
#[derive(Default)]
struct Plateaus {
    count: usize,
    /// Values in them.
    held: usize,
}

impl Plateaus {
    /// Those of [`CLIPPED_RUN`] values or more that are the extreme itself.
    fn exact(values: &[f64], extreme: f64) -> Self {
        let runs = values.chunk_by(|a, b| (*a == extreme) == (*b == extreme));
        let runs = runs.filter(|run| run[0] == extreme && run.len() >= CLIPPED_RUN);
        runs.fold(Self::default(), |all, run| Self {
            count: all.count + 1,
            held: all.held + run.len(),
        })
    }

    /// Those that lie within a band at the extreme and are run into and left far more steeply than a
    /// rounded top of their width and height would be: `4 h/n` a sample for a parabola.
    fn within(values: &[f64], extreme: f64, band: f64) -> Self {
        let inside = |value: f64| (value - extreme).abs() <= band;
        let (mut all, mut start) = (Self::default(), 0);
        for run in values.chunk_by(|a, b| inside(*a) == inside(*b)) {
            let (before, after) = (&values[..start], &values[start + run.len()..]);
            start += run.len();
            if !inside(run[0]) || run.len() < CLIPPED_RUN {
                continue;
            }
            let (&[.., b1, b0], &[a0, a1, ..]) = (before, after) else { continue };
            let edge = PLATEAU_EDGE * 4.0 * band / run.len() as f64;
            if (b0 - b1).abs() > edge && (a1 - a0).abs() > edge {
                all.count += 1;
                all.held += run.len();
            }
        }
        all
    }
}

/// A recorder at the end of its range holds its largest value, to within what its amplifier makes of it.
/// Two plateaus at the extremes, far above the resolution, are taken for that; a made-up rectangle or one
/// flat top is not.
fn clipped(values: &[f64], si: f64) -> Option<Notice> {
    let largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let range = largest - least;
    // Levels between the extremes: few in a made-up motion or a quiet one.
    let steps = values.windows(2).map(|v| (v[1] - v[0]).abs()).filter(|step| *step > 0.0);
    if !(steps.fold(f64::INFINITY, f64::min) < 0.01 * range) {
        return None;
    }
    let notice = |held: usize, count: usize, how: &str, extreme: f64| {
        let message = format!(
            "{held} values are {how} {} times the unit of the file, in {count} plateaus: the recorder \
             was probably clipped there",
            extreme / si
        );
        Notice::new(NoticeKind::Clipped, message)
    };
    for extreme in [largest, least].into_iter().filter(|extreme| *extreme != 0.0) {
        let Plateaus { count, held } = Plateaus::exact(values, extreme);
        if count >= 2 {
            return Some(notice(held, count, "exactly", extreme));
        }
    }
    PLATEAU_SHARES.into_iter().find_map(|share| {
        let of = |extreme: f64| Plateaus::within(values, extreme, share * range);
        let [high, low] = [of(largest), of(least)];
        let (count, held) = (high.count + low.count, high.held + low.held);
        let extreme = if high.count >= low.count { largest } else { least };
        let how = format!("within {} % of the range of", 100.0 * share);
        (count >= 2 && extreme != 0.0).then(|| notice(held, count, &how, extreme))
    })
}

/// One step far longer than the others, which are alike.
fn gap(times_s: &[f64]) -> Option<Notice> {
    let steps = || times_s.windows(2).map(|t| t[1] - t[0]);
    let usual = upper_median(steps())?;
    let long = |step: &f64| *step > 1.5 * usual;
    let alike = steps().filter(|step| (step - usual).abs() <= 0.2 * usual).count();
    let gaps = steps().filter(long).count();
    // Digitised film has steps of all lengths: no gaps there.
    let (at, step) = steps().enumerate().find(|(_, step)| long(step))?;
    let count = times_s.len() - 1;
    (usual > 0.0 && alike + gaps >= count && gaps * 10 <= count).then(|| {
        let message = format!(
            "{gaps} gap(s) in the times, the first after {} s: a step of {} s where {} s is usual; \
             the motion is taken as linear across it",
            round(times_s[at]),
            round(step),
            round(usual)
        );
        Notice::new(NoticeKind::Gap, message)
    })
}

/// A time in s without the noise of a subtraction.
fn round(t: f64) -> f64 {
    libm::round(t * 1e9) / 1e9
}

/// Rows that stand twice, time and value alike.
fn repeated(times_s: &[f64], values: &[f64]) -> Option<Notice> {
    let pairs = || times_s.windows(2).zip(values.windows(2));
    let same = |(t, a): &(&[f64], &[f64])| t[0] == t[1] && a[0] == a[1];
    let count = pairs().filter(same).count();
    let (t, _) = pairs().find(same)?;
    let message = format!("{count} row(s) repeat the row before, the first at {} s", t[1]);
    Some(Notice::new(NoticeKind::DuplicateRows, message))
}

#[cfg(test)]
mod tests {
    use super::super::FilterCorners;
    use super::*;

    fn kinds(values: &[f64], sampling: Sampling) -> Vec<&'static str> {
        let mut channel = Channel {
            name: "1".to_owned(),
            event: None,
            station: None,
            component: None,
            azimuth_deg: None,
            units: Units::parse("m/s2").unwrap(),
            values: values.to_vec(),
            sampling,
            filter: FilterCorners::default(),
            warnings: vec![],
        };
        inspect(&mut channel);
        channel.warnings.iter().map(|w| w.kind.name()).collect()
    }

    #[test]
    fn what_does_not_start_or_end_at_rest_is_noticed() {
        assert!(kinds(&[0.0, 1.0, -1.0, 0.0], Sampling::Dt(0.1)).is_empty());
        assert_eq!(kinds(&[1.0, -1.0], Sampling::Dt(0.1)), ["first_sample_not_zero"]);
        assert_eq!(kinds(&[0.0, 1.0, 0.0], Sampling::Dt(0.1)), ["record_drift"]);
        assert_eq!(kinds(&[0.01, 1.0, -1.0], Sampling::Dt(0.1))[0], "first_sample_small");
        assert_eq!(kinds(&[0.0101, 1.0, -1.0], Sampling::Dt(0.1))[0], "first_sample_not_zero");
        let messages =
            rest(0.5, 2.0, -0.02, 0.1).into_iter().map(|w| w.message).collect::<Vec<_>>();
        assert!(messages[0].starts_with("the first sample is 0.5000 m/s²"), "{messages:?}");
        assert!(messages[1].contains("-0.0200 m/s, 20 % of its peak"), "{messages:?}");
    }

    /// 100 g and a millionth of g are other units.
    #[test]
    fn absurd_peaks() {
        let of = |peak: f64| kinds(&[0.0, peak, -peak, 0.0], Sampling::Dt(0.1));
        assert_eq!(of(981.0), ["absurd_peak", "absurd_motion"]);
        assert_eq!(of(1e-5), ["absurd_peak"]);
        assert!(of(40.0).is_empty() && of(2e-3).is_empty() && of(0.0).is_empty());
    }

    #[test]
    fn clipped_peaks() {
        let clip = |limit: f64| -> Vec<f64> {
            let value = |k: i32| 2.0 * libm::sin(f64::from(k) * 0.1);
            (0..200).map(|k| value(k).clamp(-limit, limit)).collect()
        };
        assert!(kinds(&clip(1.9), Sampling::Dt(0.1)).contains(&"clipped"));
        assert!(!kinds(&clip(2.1), Sampling::Dt(0.1)).contains(&"clipped"));
        // Noise of a ten-thousandth on the plateaus, on both sides or on one.
        let noisy = |least: f64| -> Vec<f64> {
            let noise = |k: usize| 2e-4 * libm::sin(7.0 * (k * k) as f64);
            let top = |(k, v): (usize, f64)| if v.abs() == 1.9 { v + noise(k) } else { v };
            let one_side = |v: f64| v.max(least);
            clip(1.9).into_iter().map(one_side).enumerate().map(top).collect()
        };
        assert!(kinds(&noisy(-1.9), Sampling::Dt(0.1)).contains(&"clipped"));
        assert!(kinds(&noisy(-1.0), Sampling::Dt(0.1)).contains(&"clipped"));
        // The tops of a sine that is sampled finely are round.
        let fine: Vec<f64> = (0..20_000).map(|k| libm::sin(f64::from(k) * 0.003)).collect();
        assert!(!kinds(&fine, Sampling::Dt(0.001)).contains(&"clipped"));
        // Rectangles are meant.
        let rectangles = [0.0, 2.0, 2.0, 2.0, 2.0, 0.0, 2.0, 2.0, 2.0, 2.0, 0.0, 0.0];
        assert!(!kinds(&rectangles, Sampling::Dt(0.1)).contains(&"clipped"));
    }

    /// Milliseconds taken as seconds, and the ordinates of a spectrum.
    #[test]
    fn no_motion_of_the_ground() {
        let sine = |dt_s: f64| {
            let values: Vec<f64> = (0..100).map(|k| libm::sin(f64::from(k) * 0.1)).collect();
            kinds(&values, Sampling::Dt(dt_s))
        };
        assert!(!sine(0.1).contains(&"long_step") && !sine(0.1).contains(&"absurd_motion"));
        assert!(sine(5.0).contains(&"long_step") && sine(5.0).contains(&"absurd_motion"));
        let uneven: Vec<f64> = (0..100).map(|k| f64::from(k) * 5.0 + f64::from(k % 2)).collect();
        assert!(kinds(&[0.0; 100], Sampling::Times(uneven)).contains(&"long_step"));
        let ordinates: Vec<f64> = (1..30).map(|k| 1.0 / f64::from(k)).collect();
        assert!(kinds(&ordinates, Sampling::Dt(0.1)).contains(&"one_sided"));
        let pulse: Vec<f64> = (0..30).map(|k| f64::from(k.min(29 - k))).collect();
        assert!(!kinds(&pulse, Sampling::Dt(0.1)).contains(&"one_sided"));
    }

    #[test]
    fn gaps_and_repeated_rows() {
        let mut times_s: Vec<f64> = (0..50).map(|k| f64::from(k) * 0.01).collect();
        let values = vec![0.0; 50];
        times_s[30..].iter_mut().for_each(|t| *t += 0.07);
        assert_eq!(kinds(&values, Sampling::Times(times_s.clone())), ["gap"]);
        times_s[10] = times_s[9];
        let found = kinds(&values, Sampling::Times(times_s));
        assert!(found.contains(&"duplicate_rows"), "{found:?}");
        // A film digitised where it bends.
        let times_s: Vec<f64> = (0..50).map(|k| f64::from(k * k) * 0.001).collect();
        assert!(kinds(&values, Sampling::Times(times_s)).is_empty());
    }
}
