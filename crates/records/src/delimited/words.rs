//! Words that people write over the columns of records and of spectra.

use super::header::Name;

/// Names of a column of times in which no unit stands.
const TIMES: [&str; 19] = [
    "t",
    "time",
    "times",
    "zeit",
    "zaman",
    "temps",
    "tempo",
    "tiempo",
    "timestamp",
    "datetime",
    "datetimeutc",
    "elapsed",
    "elapsedtime",
    "relativetime",
    "timeutc",
    "epoch",
    "unixtime",
    "epochtime",
    "clock",
];

/// Names of a column that numbers the rows.
const INDICES: [&str; 27] = [
    "",
    "n",
    "i",
    "j",
    "k",
    "no",
    "nr",
    "num",
    "number",
    "id",
    "idx",
    "index",
    "sample",
    "samples",
    "samplenumber",
    "sampleno",
    "sampleindex",
    "point",
    "points",
    "row",
    "rows",
    "step",
    "count",
    "unnamed",
    "sıra",
    "sira",
    "sirano",
];

/// Names of spectral ordinates, figures at their end cut.
const ORDINATES: [&str; 24] = [
    "sa",
    "sae",
    "sar",
    "saed",
    "sat",
    "saet",
    "saavg",
    "psa",
    "psah",
    "spa",
    "se",
    "set",
    "sd",
    "sde",
    "sdt",
    "sv",
    "sve",
    "psv",
    "psd",
    "rotd",
    "gmrotd",
    "gmroti",
    "sageomean",
    "sarotd",
];

/// What the names of spectral ordinates have in them.
const ORDINATE_PARTS: [&str; 7] =
    ["spectral", "spektral", "spectrum", "spektrum", "espectral", "spettrale", "pseudo"];

/// Those that are accelerations; of others a target has no use.
const VELOCITIES_AND_DISPLACEMENTS: [&str; 9] =
    ["sd", "sde", "sdt", "sv", "sve", "psv", "psd", "velocity", "displacement"];

/// Names of a column of periods that are never times.
const PERIODS: [&str; 5] = ["period", "periyot", "periode", "tn", "période"];

/// Names of a column of frequencies.
const FREQUENCIES: [&str; 4] = ["freq", "frek", "frec", "frequenz"];

/// Letters and digits of a name without its unit, in lower case.
fn key(name: &Name) -> String {
    name.base().chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}

impl Name {
    /// Whether the column holds times: by its unit, or by a word for it.
    pub fn is_time(&self) -> bool {
        self.has_time_unit() || TIMES.contains(&key(self).as_str())
    }

    /// Whether it is a name for numbers of rows.
    pub fn is_index(&self) -> bool {
        let key = key(self);
        INDICES.contains(&key.trim_end_matches(|c: char| c.is_ascii_digit()))
    }

    /// Whether it is the name of spectral ordinates.
    pub fn is_ordinate(&self) -> bool {
        let key = key(self);
        ORDINATES.contains(&key.trim_end_matches(|c: char| c.is_ascii_digit()))
            || ORDINATE_PARTS.iter().any(|part| key.contains(part))
    }

    /// Whether it is the name of spectral accelerations.
    pub fn is_spectral_acceleration(&self) -> bool {
        let key = key(self);
        let other = |word: &&str| key == *word || (word.len() > 3 && key.contains(*word));
        self.is_ordinate() && !VELOCITIES_AND_DISPLACEMENTS.iter().any(other)
    }

    /// Whether it is a name for periods that times do not have.
    pub fn is_period(&self) -> bool {
        let key = key(self);
        PERIODS.iter().any(|word| key == *word || (word.len() > 2 && key.contains(word)))
    }

    /// Whether it may be a name for periods: one of theirs, or the letter that times have too.
    pub fn may_be_period(&self) -> bool {
        self.is_period() || key(self) == "t"
    }

    /// Whether it is a name for frequencies.
    pub fn is_frequency(&self) -> bool {
        let key = key(self);
        FREQUENCIES.iter().any(|word| key.starts_with(word))
    }
}
