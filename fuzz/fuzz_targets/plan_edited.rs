//! Plans that are read, with lines taken out, doubled, put elsewhere, and values that take the place of
//! others.
#![no_main]

use slipstick_fuzz::{fuzz_target, plan};

const PLANS: [&str; 4] = [
    include_str!("../../examples/studies/amplification.toml"),
    include_str!("../../examples/studies/far-field.toml"),
    include_str!("../../examples/studies/taft-pair.toml"),
    include_str!("../../examples/studies/usgs-records.toml"),
];

/// What may stand behind an equals sign.
const VALUES: [&str; 28] = [
    "{ values = [0.02, 0.1, 0.3] }",
    "{ uniform = [0.02, 0.10] }",
    "{ uniform = [\"1 m\", \"1e300 m\"] }",
    "{ normal = [0.05, 0.02], truncated = [0.0, 0.1] }",
    "{ lognormal = [\"2 m\", 1e3] }",
    "{ lognormal = [\"2 m\", 0.3] }",
    "{ linspace = [0.01, 0.2, 100000000] }",
    "{ logspace = [1e-300, 1e300, 7] }",
    "{ factor_of = \"slider.kinetic_friction\", values = [1.0, 1.3] }",
    "[[\"slider.kinetic_friction\", \"slider.radius\", 0.999999]]",
    "\"grid\"",
    "\"sobol\"",
    "\"latin-hypercube\"",
    "100000000",
    "18446744073709551615",
    "0",
    "-1",
    "nan",
    "1e308",
    "\"PGA\"",
    "\"Sa_avg(0.5 s, 3 s)\"",
    "\"FIV3(1 s, 1e9, 1e-9)\"",
    "[\"0.1 g\", \"1e12 g\"]",
    "\"RotD100(1.2 s, 2 %)\"",
    "{ sds = \"1 g\", sd1 = \"1e-300 g\", tl = \"1e300 s\" }",
    "[\"0.4 s\", \"4 s\"]",
    "\"upper\"",
    "\"1e12 s\"",
];

fuzz_target!(|bytes: &[u8]| {
    let Some((&first, edits)) = bytes.split_first() else { return };
    let mut lines: Vec<String> =
        PLANS[usize::from(first) % PLANS.len()].lines().map(str::to_owned).collect();
    for edit in edits.chunks_exact(3).take(12) {
        if lines.is_empty() {
            break;
        }
        let [at, with] = [edit[1], edit[2]].map(usize::from);
        let (at, other) = (at % lines.len(), with % lines.len());
        match edit[0] % 5 {
            0 => drop(lines.remove(at)),
            1 => lines.insert(other, lines[at].clone()),
            2 => lines.swap(at, other),
            3 => {
                let key = lines[at].split('=').next().unwrap_or_default().to_owned();
                lines[at] = format!("{key}= {}", VALUES[with % VALUES.len()]);
            }
            _ => {
                let place = lines[at].char_indices().nth(with).map_or(0, |(place, _)| place);
                lines[at].insert(place, char::from(edit[0]));
            }
        }
    }
    plan::check(lines.join("\n").as_bytes());
});
