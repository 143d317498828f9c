//! Components as files name them, and the azimuths of those that state one.

/// Azimuth of the positive direction in degrees clockwise from north of a component that is a
/// number of degrees (`360`, `90 DEG`), a bearing (`N08W`, `S69E`) or a point of the compass.
///
/// `None` for vertical components, for axes whose sense is not stated (`NS`, `H1`), and for
/// bearings that do not exist.
pub(super) fn azimuth(component: &str) -> Option<f64> {
    let upper = component.trim().to_ascii_uppercase();
    let name = upper.strip_suffix("DEG").unwrap_or(&upper).trim();
    match name {
        "N" | "NORTH" => return Some(0.0),
        "E" | "EAST" => return Some(90.0),
        "S" | "SOUTH" => return Some(180.0),
        "W" | "WEST" => return Some(270.0),
        _ => {}
    }
    let degrees = |digits: &str, largest: f64| {
        let plain = !digits.is_empty() && digits.bytes().all(|b| b.is_ascii_digit() || b == b'.');
        let value = digits.parse::<f64>().ok().filter(|_| plain)?;
        (0.0..=largest).contains(&value).then_some(value)
    };
    if let Some(value) = degrees(name, 360.0) {
        return Some(value);
    }
    let from_south = match name.bytes().next()? {
        b'N' => false,
        b'S' => true,
        _ => return None,
    };
    let to_west = match name.bytes().last()? {
        b'E' => false,
        b'W' => true,
        _ => return None,
    };
    let angle = degrees(name.get(1..name.len() - 1)?.trim(), 90.0)?;
    let azimuth = match (from_south, to_west) {
        (false, false) => angle,
        (false, true) => 360.0 - angle,
        (true, false) => 180.0 - angle,
        (true, true) => 180.0 + angle,
    };
    Some(if azimuth == 360.0 { 0.0 } else { azimuth })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn azimuths_are_read() {
        for (name, degrees) in [
            ("360", Some(360.0)),
            ("067", Some(67.0)),
            (" 90 DEG", Some(90.0)),
            ("340 deg", Some(340.0)),
            ("N08W", Some(352.0)),
            ("S69E", Some(111.0)),
            ("S16W", Some(196.0)),
            ("N00E", Some(0.0)),
            ("N90E", Some(90.0)),
            ("east", Some(90.0)),
            ("NS", None),
            ("N-S", None),
            ("EW", None),
            ("N91E", None),
            ("361", None),
            ("UP", None),
            ("V", None),
            ("H1", None),
            ("", None),
            ("é", None),
            ("Né", None),
        ] {
            assert_eq!(azimuth(name), degrees, "{name}");
        }
    }
}
