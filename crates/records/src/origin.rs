//! Where a motion comes from, as its file says, and what cannot be run together.

use super::Channel;

/// What a file says of the place and the direction of a motion; all empty of a made one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Origin {
    /// Earthquake, where stated.
    pub event: Option<String>,
    /// Station, where stated.
    pub station: Option<String>,
    /// Component, where stated.
    pub component: Option<String>,
    /// Azimuth of the component, clockwise from north in degrees, where stated: a vertical one has none.
    pub azimuth_deg: Option<f64>,
    /// Time of the first sample in ns since the start of 1970, UTC, where it came with one.
    pub start_ns: Option<i64>,
    /// Of a motion in two horizontal directions what the file of the component along y says.
    pub along_y: Option<Box<Self>>,
}

/// Components that files call vertical, in capital letters.
const VERTICAL: [&str; 14] = [
    "UP", "UD", "U-D", "U", "V", "VER", "VRT", "VERT", "VERTICAL", "DWN", "DOWN", "Z", "HNZ", "HLZ",
];

impl Origin {
    /// What a channel says of itself.
    #[must_use]
    pub fn of(channel: &Channel) -> Self {
        Self {
            event: channel.event.clone(),
            station: channel.station.clone(),
            component: channel.component.clone(),
            azimuth_deg: channel.azimuth_deg,
            start_ns: None,
            along_y: None,
        }
    }

    /// The same of a motion with a second horizontal component.
    #[must_use]
    pub fn with_along_y(self, along_y: Self) -> Self {
        Self { along_y: Some(Box::new(along_y)), ..self }
    }

    /// The same of what is left where its first seconds are cut off.
    #[must_use]
    pub fn later_by(mut self, seconds: f64) -> Self {
        self.along_y = self.along_y.map(|along_y| Box::new(along_y.later_by(seconds)));
        let later = |start_ns: i64| start_ns.saturating_add((seconds * 1e9).round() as i64);
        Self { start_ns: self.start_ns.map(later), ..self }
    }

    /// What tells that the motion is a vertical component: the component that its file states, else the
    /// end of the file's name, `RSN68_SFERN_PEL-UP.AT2`.
    #[must_use]
    pub fn vertical(&self, file_name: &str) -> Option<String> {
        if self.azimuth_deg.is_some() {
            return None;
        }
        if let Some(component) = &self.component {
            let first = component.split([' ', ',', '(']).find(|word| !word.is_empty());
            if first.is_some_and(is_vertical) {
                return Some(format!("component {component:?}"));
            }
        }
        let (stem, ending) = file_name.rsplit_once('.').unwrap_or((file_name, ""));
        let ending = ending.trim_end_matches(|c: char| c.is_ascii_digit());
        let last = stem.rsplit(['-', '_', '.', ' ']).next().unwrap_or(stem);
        let of_name = is_vertical(last) || ending.eq_ignore_ascii_case("UD");
        // PEER's names run the station and this together: H-DLTDWN.
        let joined = last.len() > 3 && last.to_ascii_uppercase().ends_with("DWN");
        (of_name || joined).then(|| format!("a name that ends in that, {file_name}"))
    }

    /// What it says, by name: earthquake, station, component and azimuth, those of both components; what it
    /// does not say is left out.
    #[must_use]
    pub fn said(&self) -> Vec<(&'static str, String)> {
        let of_both = |of: fn(&Self) -> Option<String>| match (of(self), &self.along_y) {
            (Some(x), Some(y)) => Some(format!("{x}, {}", of(y).unwrap_or("—".to_owned()))),
            (x, _) => x,
        };
        let all = [
            ("Earthquake", self.event.clone()),
            ("Station", self.station.clone()),
            ("Component", of_both(|on| on.component.clone())),
            ("Azimuth", of_both(|on| on.azimuth_deg.map(|azimuth| format!("{azimuth}°")))),
        ];
        all.into_iter().filter_map(|(name, text)| Some((name, text?))).collect()
    }

    /// Whether two files say that they are of one station in one earthquake.
    #[must_use]
    pub fn is_with(&self, other: &Self) -> bool {
        let same = |a: &Option<String>, b: &Option<String>| match (a, b) {
            (Some(a), Some(b)) => plain(a) == plain(b),
            _ => false,
        };
        same(&self.event, &other.event) && same(&self.station, &other.station)
    }

    /// Why two motions are not the components of one, where their files say so: another earthquake, or
    /// another station.
    #[must_use]
    pub fn apart(&self, other: &Self, file_names: [&str; 2]) -> Option<String> {
        for (what, [a, b]) in [
            ("earthquake", [&self.event, &other.event]),
            ("station", [&self.station, &other.station]),
        ] {
            if let (Some(a), Some(b)) = (a, b)
                && plain(a) != plain(b)
            {
                return Some(format!("of the {what}s {a:?} and {b:?}"));
            }
        }
        // PEER's number of a record, the same of all its components.
        let [a, b] = file_names.map(sequence_number);
        let differ = a.is_some() && b.is_some() && a != b;
        differ.then(|| format!("of the records RSN{} and RSN{}", a.unwrap_or(0), b.unwrap_or(0)))
    }
}

/// Whether a channel is vertical by its component or its own name: `UP`, `UD (gal)`, `U-D`, `acc_z`.
pub(crate) fn is_vertical_channel(channel: &Channel) -> bool {
    let words = |text: &str| text.split([' ', ',', '(', '[', '_', '-']).any(is_vertical);
    let name = crate::bracket(&channel.name).map_or(channel.name.as_str(), |(base, _)| base);
    let of_name = words(name) || is_vertical(name) || name.to_lowercase().contains("vertical");
    channel.azimuth_deg.is_none() && (of_name || channel.component.as_deref().is_some_and(words))
}

fn is_vertical(word: &str) -> bool {
    VERTICAL.iter().any(|name| word.eq_ignore_ascii_case(name))
}

/// Letters and digits alone, small: files of one station differ in blanks and commas.
fn plain(text: &str) -> String {
    text.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

fn sequence_number(file_name: &str) -> Option<u32> {
    let digits = file_name.strip_prefix("RSN")?;
    digits.split(|c: char| !c.is_ascii_digit()).next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stated(component: &str) -> Origin {
        Origin { component: Some(component.to_owned()), ..Origin::default() }
    }

    #[test]
    fn vertical_components_by_header_and_name() {
        for (component, name, vertical) in [
            ("", "RSN68_SFERN_PEL-UP.AT2", true),
            ("", "RSN169_IMPVALL.H_H-DLTDWN.AT2", true),
            ("", "CHICHI_TCU045-V.AT2", true),
            ("", "AOM0011103111446.UD", true),
            ("", "AOM0011103111446.UD2", true),
            ("", "up.txt", true),
            ("UP", "a.AT2", true),
            ("DWN (UNAM STATION 6605)", "a.AT2", true),
            ("", "CHICHI_TCU045-W.AT2", false),
            ("", "RSN169_IMPVALL.H_H-DLT262.AT2", false),
            ("", "pickup.csv", false),
            ("N", "a.AT2", false),
            ("", "a", false),
        ] {
            let component = Some(component).filter(|c| !c.is_empty()).map(str::to_owned);
            let origin = Origin { component, ..Origin::default() };
            assert_eq!(origin.vertical(name).is_some(), vertical, "{origin:?} {name}");
        }
        let known = Origin { azimuth_deg: Some(90.0), ..stated("090") };
        assert_eq!(known.vertical("x-up.AT2"), None);
    }

    #[test]
    fn components_of_a_pair_are_both_said() {
        let pair = Origin { azimuth_deg: Some(0.0), ..stated("000") };
        let pair = pair.with_along_y(Origin { azimuth_deg: Some(90.0), ..stated("090") });
        let expected = [("Component", "000, 090".to_owned()), ("Azimuth", "0°, 90°".to_owned())];
        assert_eq!(pair.said(), expected);
        let half = stated("L").with_along_y(Origin::default());
        assert_eq!(half.said(), [("Component", "L, —".to_owned())]);
    }

    #[test]
    fn components_of_two_earthquakes_are_apart() {
        let of = |event: &str, station: &str| Origin {
            event: Some(event.to_owned()),
            station: Some(station.to_owned()),
            ..Origin::default()
        };
        let names = ["a.AT2", "b.AT2"];
        let kobe = of("KOBE 01/16/95 2046", "SHIN-OSAKA");
        assert_eq!(kobe.apart(&of("Kobe  01/16/95, 2046", "Shin Osaka"), names), None);
        let other = kobe.apart(&of("KOCAELI 08/17/99", "ARCELIK"), names).unwrap();
        assert_eq!(other, "of the earthquakes \"KOBE 01/16/95 2046\" and \"KOCAELI 08/17/99\"");
        let other = kobe.apart(&of("KOBE 01/16/95 2046", "NISHI-AKASHI"), names).unwrap();
        assert!(other.starts_with("of the stations"), "{other}");
        let none = Origin::default();
        let rsn = ["RSN1116_KOBE_SHI000.AT2", "RSN1148_KOCAELI_ARC090.AT2"];
        assert_eq!(none.apart(&none, rsn).unwrap(), "of the records RSN1116 and RSN1148");
        assert_eq!(none.apart(&none, names), None);
    }
}
