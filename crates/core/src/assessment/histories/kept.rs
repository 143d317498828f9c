//! Runs of a suite in two directions as text, by which a suite that was interrupted goes on.

use super::RunFigures;
use super::alone::Alone;
use crate::assessment::outline::SlidingOutline;
use crate::notice::Notice;
use crate::response::{Demands, StopDemands, StoreyDemands};
use crate::study::kept::{bits, kind_of, of_bits};

/// Between the parts of a line, between the notices of a list, and between what a notice has.
const PARTS: char = '\u{1e}';
const NOTICES: char = '\u{1d}';
const FIELDS: char = '\u{1f}';

/// Before what is there; what is not is empty.
const THERE: char = '+';

/// A run as a line; none of one that is not kept: with floor spectra, surfaces in series or contents, or with a text that
/// would not stand in a line.
pub(super) fn line(run: &RunFigures) -> Option<String> {
    let RunFigures { demands, axes, defect, largest, alone, floor_spectra, sliding, noticed } = run;
    if floor_spectra.is_some() {
        return None;
    }
    let text = |text: &str| (!text.contains(char::is_control)).then(|| text.to_owned());
    let optional =
        |part: Option<String>| part.map_or(String::new(), |part| format!("{THERE}{part}"));
    let of_axis = |axis: usize| match axes {
        Some(axes) => Some(optional(Some(bits(&numbers(&axes[axis])?)))),
        None => Some(String::new()),
    };
    let outline = sliding.as_ref();
    let notice = |Notice { kind, time_s, message, is_severe }: &Notice| {
        let time_s = optional(time_s.map(|time_s| bits(&[time_s])));
        let severe = if *is_severe { "!" } else { "" };
        let fields = [kind.name().to_owned(), time_s, severe.to_owned(), text(message)?];
        Some(fields.join(&FIELDS.to_string()))
    };
    let notices = |all: &Vec<Notice>| {
        let each = all.iter().map(notice).collect::<Option<Vec<String>>>()?;
        Some(each.join(&NOTICES.to_string()))
    };
    let (name, value) = match largest {
        Some((name, value)) => (optional(Some(text(name)?)), bits(&[*value])),
        None => (String::new(), String::new()),
    };
    let parts = [
        bits(&numbers(demands)?),
        of_axis(0)?,
        of_axis(1)?,
        match defect {
            Some(defect) => optional(Some(text(defect)?)),
            None => String::new(),
        },
        name,
        value,
        optional(alone.map(|alone| bits(&alone.axes_m))),
        optional(outline.map(|outline| bits(&outline.time_s))),
        optional(outline.map(|outline| bits(&outline.sliding_displacement_m))),
        notices(&noticed[0])?,
        notices(&noticed[1])?,
        notices(&noticed[2])?,
    ];
    Some(parts.join(&PARTS.to_string()))
}

/// What such a line says; none of any other text.
pub(super) fn read(line: &str) -> Option<RunFigures> {
    let parts: Vec<&str> = line.split(PARTS).collect();
    let [demands, x, y, defect, name, value, alone, times, sliding, noticed @ ..] = &parts[..]
    else {
        return None;
    };
    let [of_job, of_response, met] = noticed else { return None };
    let there = |part: &&str| part.strip_prefix(THERE).map(str::to_owned);
    let one = |text: &str| <[f64; 1]>::try_from(of_bits(text)?).ok().map(|[x]| x);
    let both = |[a, b]: [&&str; 2]| Some([there(a)?, there(b)?]);
    let axes = match both([x, y]) {
        Some([x, y]) => Some(Box::new([read_demands(of_bits(&x)?)?, read_demands(of_bits(&y)?)?])),
        None => None,
    };
    let largest = match there(name) {
        Some(name) => Some((name, one(value)?)),
        None => None,
    };
    let alone = match there(alone) {
        Some(alone) => Some(Alone { axes_m: <[f64; 2]>::try_from(of_bits(&alone)?).ok()? }),
        None => None,
    };
    let sliding = match both([times, sliding]) {
        // Lines of an earlier version have whole histories.
        Some([times, sliding]) => {
            Some(SlidingOutline::through(&of_bits(&times)?, &of_bits(&sliding)?))
        }
        None => None,
    };
    let notice = |text: &str| {
        let fields: Vec<&str> = text.split(FIELDS).collect();
        let [kind, time_s, severe, message] = fields[..] else { return None };
        let time_s = match time_s.strip_prefix(THERE) {
            Some(time_s) => Some(one(time_s)?),
            None => None,
        };
        let (message, is_severe) = (message.to_owned(), severe == "!");
        Some(Notice { kind: kind_of(kind)?, time_s, message, is_severe })
    };
    let notices =
        |text: &&str| text.split_terminator(NOTICES).map(notice).collect::<Option<Vec<_>>>();
    Some(RunFigures {
        demands: read_demands(of_bits(demands)?)?,
        axes,
        defect: there(defect),
        largest,
        alone,
        floor_spectra: None,
        sliding,
        noticed: [notices(of_job)?, notices(of_response)?, notices(met)?],
    })
}

/// Numbers on their way into a line, or out of one.
enum Pass {
    Out(Vec<f64>),
    In(std::vec::IntoIter<f64>),
}

impl Pass {
    fn number(&mut self, number: &mut f64) -> Option<()> {
        match self {
            Self::Out(all) => all.push(*number),
            Self::In(rest) => *number = rest.next()?,
        }
        Some(())
    }

    fn flag(&mut self, is: &mut bool) -> Option<()> {
        let mut number = f64::from(u8::from(*is));
        self.number(&mut number)?;
        *is = number == 1.0;
        Some(())
    }

    fn count(&mut self, count: &mut u64) -> Option<()> {
        let mut number = *count as f64;
        self.number(&mut number)?;
        *count = number as u64;
        Some(())
    }

    /// Whether there is a number, and it.
    fn optional(&mut self, value: &mut Option<f64>) -> Option<()> {
        let (mut is, mut number) = (value.is_some(), value.unwrap_or(0.0));
        self.flag(&mut is)?;
        self.number(&mut number)?;
        *value = is.then_some(number);
        Some(())
    }

    fn storeys(&mut self, list: &mut Vec<StoreyDemands>) -> Option<()> {
        let mut count = list.len() as u64;
        self.count(&mut count)?;
        for i in 0..count as usize {
            if i == list.len() {
                list.push(StoreyDemands::default());
            }
            let StoreyDemands {
                peak_acceleration_m_per_s2,
                peak_displacement_m,
                peak_drift_m,
                peak_drift_ratio,
                peak_drift_velocity_m_per_s,
                peak_shear_n,
            } = &mut list[i];
            self.number(peak_acceleration_m_per_s2)?;
            self.number(peak_displacement_m)?;
            self.number(peak_drift_m)?;
            self.number(peak_drift_velocity_m_per_s)?;
            self.optional(peak_drift_ratio)?;
            self.optional(peak_shear_n)?;
        }
        Some(())
    }

    /// All numbers of demands, in one order; none of a model with surfaces in series or contents.
    fn demands(&mut self, demands: &mut Demands) -> Option<()> {
        let Demands {
            peak_sliding_displacement_m,
            peak_sliding_displacement_time_s,
            max_sliding_displacement_m,
            min_sliding_displacement_m,
            residual_sliding_displacement_m,
            sliding_at_end,
            sliding_path_m,
            peak_sliding_velocity_m_per_s,
            sliding_time_s,
            slip_count,
            reversal_count,
            stick_count,
            peak_block_acceleration_m_per_s2,
            storeys,
            points,
            peak_base_shear_n,
            peak_friction_force_n,
            peak_slider_force_n,
            base_shear_coefficient,
            friction_coefficient_used,
            slider_force_coefficient,
            closest_stop,
            gap_ratio,
            overturning_ratio,
            stop,
            surfaces,
            contents,
        } = demands;
        if !(surfaces.is_empty() && contents.is_empty()) {
            return None;
        }
        self.number(peak_sliding_displacement_m)?;
        self.number(peak_sliding_displacement_time_s)?;
        self.number(max_sliding_displacement_m)?;
        self.number(min_sliding_displacement_m)?;
        self.number(residual_sliding_displacement_m)?;
        self.flag(sliding_at_end)?;
        self.number(sliding_path_m)?;
        self.number(peak_sliding_velocity_m_per_s)?;
        self.number(sliding_time_s)?;
        self.count(slip_count)?;
        self.count(reversal_count)?;
        self.count(stick_count)?;
        self.number(peak_block_acceleration_m_per_s2)?;
        self.number(peak_base_shear_n)?;
        self.number(peak_friction_force_n)?;
        self.number(peak_slider_force_n)?;
        self.number(base_shear_coefficient)?;
        self.number(friction_coefficient_used)?;
        self.number(slider_force_coefficient)?;
        self.optional(closest_stop)?;
        self.optional(gap_ratio)?;
        self.optional(overturning_ratio)?;
        let mut has_stop = stop.is_some();
        self.flag(&mut has_stop)?;
        let mut of_stop = stop.unwrap_or_default();
        let StopDemands {
            contact_count,
            impact_count,
            peak_force_n,
            peak_impact_speed_m_per_s,
            contact_time_s,
        } = &mut of_stop;
        self.count(contact_count)?;
        self.count(impact_count)?;
        self.number(peak_force_n)?;
        self.number(peak_impact_speed_m_per_s)?;
        self.number(contact_time_s)?;
        *stop = has_stop.then_some(of_stop);
        self.storeys(storeys)?;
        self.storeys(points)
    }
}

/// All numbers of demands; none of a model with surfaces in series or contents.
fn numbers(demands: &Demands) -> Option<Vec<f64>> {
    let mut pass = Pass::Out(Vec::new());
    pass.demands(&mut demands.clone())?;
    match pass {
        Pass::Out(all) => Some(all),
        Pass::In(_) => None,
    }
}

/// The demands of such numbers.
fn read_demands(all: Vec<f64>) -> Option<Demands> {
    let (mut pass, mut demands) = (Pass::In(all.into_iter()), Demands::default());
    pass.demands(&mut demands)?;
    match pass {
        Pass::In(mut rest) => rest.next().is_none().then_some(demands),
        Pass::Out(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::notice::NoticeKind;

    #[test]
    fn a_run_that_is_kept_is_the_same() {
        let storey = StoreyDemands {
            peak_acceleration_m_per_s2: 1.5,
            peak_drift_ratio: Some(0.1 + 0.2),
            ..StoreyDemands::default()
        };
        let demands = Demands {
            peak_sliding_displacement_m: 0.3,
            sliding_at_end: true,
            stick_count: 7,
            storeys: vec![storey, StoreyDemands { peak_shear_n: Some(-0.0), ..storey }],
            stop: Some(StopDemands { contact_count: 3, ..StopDemands::default() }),
            gap_ratio: Some(1e-310),
            ..Demands::default()
        };
        let notice =
            Notice::new(NoticeKind::GapExceeded, "a \"gap\" of 1 µm; + 2 and = 3").at(1.25);
        let mut run = RunFigures {
            axes: Some(Box::new([demands.clone(), Demands::default()])),
            demands,
            defect: None,
            largest: Some(("friction excess".to_owned(), 3e-12)),
            alone: Some(Alone { axes_m: [0.1, 0.2] }),
            floor_spectra: None,
            sliding: Some(SlidingOutline::through(&[0.0, 0.01], &[0.0, -0.0])),
            noticed: [vec![notice.clone()], Vec::new(), vec![notice]],
        };
        let line = line(&run).unwrap();
        assert!(!line.contains(['\n', '\t']), "{line}");
        let again = read(&line).unwrap();
        assert_eq!((again.demands, again.axes), (run.demands.clone(), run.axes.clone()));
        assert_eq!((again.defect, again.largest), (run.defect.clone(), run.largest.clone()));
        assert_eq!((again.alone, again.sliding), (run.alone, run.sliding.clone()));
        assert_eq!(again.noticed, run.noticed);
        let of_no_kind = line.replacen("gap", "unheard of", 1);
        for wrong in ["", "{}", &of_no_kind, &line.replacen("0000 ", "", 1)] {
            assert!(read(wrong).is_none(), "{wrong}");
        }
        run.noticed[1].push(Notice::new(NoticeKind::GapExceeded, "two\nlines"));
        assert!(super::line(&run).is_none());
        run.noticed[1].clear();
        run.floor_spectra = Some(super::super::FloorSpectra::default());
        assert!(super::line(&run).is_none());
    }
}
