//! Warnings from all sources in one list, the gravest first.

use slipstick::check::Certificate;
use slipstick::notice::{Notice, NoticeKind};
use slipstick::response::{Method, Response, flat_geometry};

use super::SummaryInputs;
use crate::number::{compact, rounded, significant};

/// Below this margin a slightly different record would tell another story.
const CLOSE_CALL_MARGIN: f64 = 1e-6;

/// Those that follow from the figures, then the solver's, then those given; each once, notes last.
pub fn assemble(inputs: &SummaryInputs) -> Vec<Notice> {
    let derived = [
        inputs.certificate.and_then(|certificate| check_failed(inputs.response, certificate)),
        gap_exceeded(inputs),
        inputs.certificate.and_then(|certificate| close_call(inputs.response, certificate)),
        nothing_slides(inputs.response),
        flat_geometry(inputs.model, &inputs.response.demands),
    ];
    let mut all: Vec<Notice> = derived.into_iter().flatten().collect();
    for warning in inputs.response.warnings.iter().chain(inputs.warnings) {
        // What the solver says of a kind that is derived here would only say it twice.
        let told = all.iter().any(|seen| {
            seen.kind == warning.kind
                && (matches!(
                    seen.kind,
                    NoticeKind::CheckFailed | NoticeKind::GapExceeded | NoticeKind::CloseCall
                ) || seen == warning)
        });
        if !told {
            all.push(warning.clone());
        }
    }
    Notice::sort(&mut all);
    all
}

/// A motion under which the slider might as well be fixed.
fn nothing_slides(response: &Response) -> Option<Notice> {
    let demands = &response.demands;
    (demands.slip_count == 0 && demands.sliding_path_m == 0.0).then(|| {
        let message = format!(
            "the block never slides under this motion: the friction force reaches {} of the weight",
            significant(demands.friction_coefficient_used, 3)
        );
        Notice::new(NoticeKind::NothingSlides, message)
    })
}

fn check_failed(response: &Response, certificate: &Certificate) -> Option<Notice> {
    if response.method != Method::Exact || certificate.holds() {
        return None;
    }
    let named = |(name, figure): (String, f64)| format!("{name} {}", significant(figure, 2));
    let failed: Vec<String> = certificate.defects().into_iter().map(named).collect();
    Some(Notice::new(
        NoticeKind::CheckFailed,
        format!(
            "the independent check does not confirm this response: {} above the bound {}",
            failed.join(", "),
            rounded(certificate.bound, 2)
        ),
    ))
}

/// Exceeding the gap, at the first instant known to be beyond it.
fn gap_exceeded(inputs: &SummaryInputs) -> Option<Notice> {
    let gap_m = inputs.model.slider().gap_m()?;
    let demands = &inputs.response.demands;
    let peak_m = demands.peak_sliding_displacement_m;
    if peak_m.is_nan() || peak_m <= gap_m {
        return None;
    }
    let knot_s = inputs.response.history.as_ref().and_then(|history| {
        let along_y = inputs.response.in_plane.as_ref().and_then(|plane| plane.history.as_ref());
        let beyond = (0..history.len()).position(|knot| {
            let y = along_y.map_or(0.0, |y| y.sliding_displacement_m[knot]);
            history.sliding_displacement_m[knot].hypot(y) > gap_m
        })?;
        Some(history.time_s[beyond])
    });
    let in_plane = inputs.response.in_plane.as_ref();
    let event_s = inputs.response.events.iter().enumerate().find_map(|(i, event)| {
        let y = in_plane.map_or(0.0, |plane| plane.events[i].sliding_displacement_y_m);
        (event.sliding_displacement_m.hypot(y) > gap_m).then_some(event.time_s)
    });
    let time_s = [knot_s, event_s]
        .into_iter()
        .flatten()
        .fold(demands.peak_sliding_displacement_time_s, f64::min);
    let message = format!(
        "the block slides past its gap of {} mm: peak {} mm, {} of the gap; what it strikes \
         there is not modelled",
        compact(1e3 * gap_m),
        significant(1e3 * peak_m, 4),
        significant(peak_m / gap_m, 4),
    );
    Some(Notice::new(NoticeKind::GapExceeded, message).at(time_s))
}

fn close_call(response: &Response, certificate: &Certificate) -> Option<Notice> {
    let call = certificate.closest_call.filter(|_| response.method == Method::Exact)?;
    (call.margin < CLOSE_CALL_MARGIN).then(|| {
        Notice::new(
            NoticeKind::CloseCall,
            format!(
                "a decision between sticking and sliding ({}) had a margin of only {}: a slightly \
             different record would tell another story",
                call.decision(),
                significant(call.margin, 2)
            ),
        )
        .at(call.time_s)
    })
}
