//! What a response lies beyond.

use super::Demands;
use crate::model::Model;
use crate::notice::{Notice, NoticeKind};

/// Displacement over radius beyond which flat geometry is said to be one.
const FLAT: f64 = 0.2;

/// Warning for a pendulum, or a surface of several, that slides beyond 0.2 of its radius: the force `N s/R`
/// of flat geometry is that of the dish, `N s/√(R² − s²)`, times `√(1 − (s/R)²)`. It is severe beyond the dish, from
/// `s = R` on.
#[must_use]
pub fn flat_geometry(model: &Model, demands: &Demands) -> Option<Notice> {
    let of = |(surface, radius_m): (Option<usize>, f64)| match surface {
        None => Some(("the block".to_owned(), demands.peak_sliding_displacement_m / radius_m)),
        Some(i) => {
            let on = demands.surfaces.get(i)?;
            Some((format!("surface {}", i + 1), on.peak_displacement_m / radius_m))
        }
    };
    let all = model.slider().radii_m().filter_map(of);
    let (what, ratio) = all.reduce(|a, b| if b.1 > a.1 { b } else { a })?;
    if !(ratio > FLAT) {
        return None;
    }
    let short = if ratio < 1.0 {
        let percent = 100.0 * (1.0 - (1.0 - ratio * ratio).sqrt());
        format!("here its restoring force is {percent:.0} % below that of the dish")
    } else {
        "a dish of that radius does not reach so far".to_owned()
    };
    let message = format!(
        "{what} slides {ratio:.2} of its radius: beyond {FLAT} flat geometry is in error; {short}"
    );
    Some(Notice::new(NoticeKind::FlatGeometry, message).severe_where(ratio >= 1.0))
}

/// What the slider comes to the end of, which a table of sliding displacements does not tell: its gap, its
/// stop, the travel of a surface.
#[must_use]
pub fn struck(model: &Model, demands: &Demands) -> Vec<Notice> {
    let mut found = Vec::new();
    let mut say = |kind, message| found.push(Notice::new(kind, message));
    if let Some(ratio) = demands.gap_ratio.filter(|ratio| *ratio > 1.0) {
        say(
            NoticeKind::GapExceeded,
            format!(
                "the block slides past its gap: {ratio:.2} of it; what it strikes there is not modelled"
            ),
        );
    }
    if let Some(stop) = demands.stop.filter(|stop| stop.contact_count + stop.impact_count > 0) {
        let speed = stop.peak_impact_speed_m_per_s;
        let times = match stop.contact_count.max(stop.impact_count) {
            1 => "once".to_owned(),
            2 => "twice".to_owned(),
            n => format!("{n} times"),
        };
        let force = match stop.peak_force_n {
            0.0 => String::new(),
            force_n => format!(", with {:.3} of the weight", force_n / model.weight_n()),
        };
        say(
            NoticeKind::StopStruck,
            format!("the block strikes its stop {times}, at up to {speed:.3} m/s{force}"),
        );
    }
    let ended = demands.surfaces.iter().enumerate().filter(|(_, surface)| surface.end_reached);
    let ended: Vec<String> = ended.map(|(i, _)| (i + 1).to_string()).collect();
    let message = match ended.as_slice() {
        [] => None,
        [one] => Some(format!("surface {one} reaches the end of its travel")),
        [first @ .., last] => {
            let first = first.join(", ");
            Some(format!("surfaces {first} and {last} reach the end of their travel"))
        }
    };
    found.extend(message.map(|message| Notice::new(NoticeKind::TravelReached, message)));
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::notice::Severity;
    use crate::response::SurfaceDemands;
    use crate::slider::{Surface, SurfacesInSeries};

    fn slid(peak_m: f64) -> Demands {
        Demands { peak_sliding_displacement_m: peak_m, ..Demands::default() }
    }

    /// √(1 − 0.6²) = 0.8.
    #[test]
    fn flat_geometry_is_short_of_the_dish() {
        let block = || Model::builder().block("1 t").friction(0.06, 0.05);
        let pendulum = block().radius("2 m").build().unwrap();
        assert_eq!(flat_geometry(&pendulum, &slid(0.4)), None);
        let found = flat_geometry(&pendulum, &slid(1.2)).unwrap();
        assert_eq!((found.kind, found.severity()), (NoticeKind::FlatGeometry, Severity::Warning));
        assert_eq!(
            found.message,
            "the block slides 0.60 of its radius: beyond 0.2 flat geometry is in error; here its restoring \
             force is 20 % below that of the dish"
        );
        let beyond = flat_geometry(&pendulum, &slid(2.0)).unwrap();
        assert_eq!((beyond.severity(), beyond.label()), (Severity::Severe, "Severe"));
        assert!(
            beyond.message.ends_with("a dish of that radius does not reach so far"),
            "{}",
            beyond.message
        );
        let spring = block().spring("2 kN/m").build().unwrap();
        assert_eq!(flat_geometry(&spring, &slid(5.0)), None);
    }

    #[test]
    fn flat_geometry_of_surfaces_is_that_of_each() {
        let surface =
            |friction, radius_m| Surface { friction, radius_m: Some(radius_m), travel_m: None };
        let series =
            SurfacesInSeries::new(vec![surface(0.03, 0.5), surface(0.06, 2.0)], 1.0).unwrap();
        let two = Model::builder().block("1 t").surfaces(series).build().unwrap();
        let surface =
            |peak_displacement_m| SurfaceDemands { peak_displacement_m, ..Default::default() };
        let demands = Demands { surfaces: vec![surface(0.15), surface(0.1)], ..slid(0.25) };
        let found = flat_geometry(&two, &demands).unwrap();
        assert!(
            found.message.starts_with("surface 1 slides 0.30 of its radius"),
            "{}",
            found.message
        );
    }
}
