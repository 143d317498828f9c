//! `cargo xtask findings`: what practice assumes, measured. Each finding is a study by the command itself over
//! recorded pairs, and a table of what came of it.

use crate::shell::{self, Outcome};
use serde_json::Value;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// Kinetic coefficients, static the same, of the designs.
const FRICTIONS: [f64; 3] = [0.03, 0.06, 0.12];

/// Radii of the designs in m.
const RADII_M: [f64; 3] = [1.0, 2.5, 5.0];

/// What stands on the block: nothing, or a storey of three quarters of the mass with this fixed-base period in s.
const STRUCTURES_S: [Option<f64>; 3] = [None, Some(0.5), Some(3.0)];

/// Mass of a design in t.
const MASS_T: f64 = 400.0;

/// The spectrum that pairs are scaled to where a code's procedure is asked.
const SPECTRUM: &str = "sds = 1.2 g, sd1 = 0.8 g, tl = 8 s";

/// Runs the studies and prints the tables; `--write` puts them into the book.
pub fn findings(options: &[&str]) -> Outcome {
    let write = match options {
        [] => false,
        ["--write"] => true,
        _ => {
            let found = options.join(" ");
            return Err(format!("findings: expected --write or nothing, found {found}"));
        }
    };
    let lab = Lab::new()?;
    let mut text = String::new();
    for finding in [hundred_and_thirty, code_displacement, speed, yield_displacement] {
        finding(&lab, &mut text)?;
    }
    match write {
        true => shell::write(&shell::root().join("book/src/generated/findings.md"), &text),
        false => {
            print!("{text}");
            Ok(())
        }
    }
}

/// The command, the records, and where the models of a study are put.
struct Lab {
    slipstick: PathBuf,
    folder: PathBuf,
    far_field: Pairs,
    pulses: Pairs,
}

/// First and second components, in the same order.
type Pairs = [Vec<PathBuf>; 2];

impl Lab {
    fn new() -> Result<Self, String> {
        shell::run(&mut shell::cargo("build --release -p slipstick-cli"))?;
        let target = shell::target_folder()?;
        let program = format!("slipstick{}", std::env::consts::EXE_SUFFIX);
        let beside = shell::root().join("../shared/records");
        let records = std::env::var_os("SLIPSTICK_RECORDS").map_or(beside, PathBuf::from);
        let folder = target.join("findings");
        fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        Ok(Self {
            slipstick: target.join("release").join(program),
            folder,
            far_field: pairs(&records.join("motions/fema_p695_far_field"))?,
            pulses: pairs(&records.join("motions/fema_p695_near_fault_pulse"))?,
        })
    }

    /// Response histories of some models, by their names: what the command's JSON says of them.
    fn run(
        &self,
        models: &[(String, String)],
        pairs: &Pairs,
        more: &[&str],
    ) -> Result<Value, String> {
        let mut command = shell::command(&self.slipstick);
        command.arg("run").args(["--json", "-q", "--units", "g"]).args(more);
        for (name, text) in models {
            let path = self.folder.join(format!("{name}.toml"));
            fs::write(&path, text).map_err(|error| format!("{}: {error}", path.display()))?;
            command.arg(path);
        }
        command.arg("--records").args(&pairs[0]);
        if !pairs[1].is_empty() {
            command.arg("--second").args(&pairs[1]);
        }
        let text = shell::output(&mut command)?;
        serde_json::from_str(&text).map_err(|error| format!("slipstick run: {error}"))
    }
}

/// The horizontal components of a folder, two of a station beside each other in the order of their names.
fn pairs(folder: &Path) -> Result<Pairs, String> {
    let read = fs::read_dir(folder).map_err(|error| {
        format!("findings: expected records in $SLIPSTICK_RECORDS: {}: {error}", folder.display())
    })?;
    let is_vertical = |path: &PathBuf| {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        stem.ends_with("-UP") || stem.ends_with("-V")
    };
    let mut files: Vec<PathBuf> = read.filter_map(Result::ok).map(|entry| entry.path()).collect();
    files.retain(|path| !is_vertical(path));
    files.sort();
    let of = |other: usize| files.iter().skip(other).step_by(2).cloned().collect();
    Ok([of(0), of(1)])
}

/// A design of the studies.
#[derive(Clone, Copy)]
struct Design {
    friction: f64,
    radius_m: f64,
    structure_s: Option<f64>,
}

impl Design {
    /// All of them.
    fn all() -> Vec<Self> {
        let mut all = Vec::new();
        for friction in FRICTIONS {
            for radius_m in RADII_M {
                let of = |structure_s| Self { friction, radius_m, structure_s };
                all.extend(STRUCTURES_S.map(of));
            }
        }
        all
    }

    /// Its model file, with other kinetic friction in place of its own if there is some.
    fn model(&self, kinetic: Option<&str>) -> (String, String) {
        let Self { friction, radius_m, structure_s } = *self;
        let (block_t, storey) = match structure_s {
            None => (MASS_T, String::new()),
            Some(period_s) => (
                0.25 * MASS_T,
                format!(
                    "[[storey]]\nmass = \"{} t\"\nperiod = \"{period_s} s\"\ndamping_ratio = 0.05\n",
                    0.75 * MASS_T
                ),
            ),
        };
        let coefficients = match kinetic {
            None => format!("static_friction = {friction}\nkinetic_friction = {friction}"),
            Some(kinetic) => kinetic.to_owned(),
        };
        let name = format!("mu{friction}-r{radius_m}-t{}", structure_s.unwrap_or(0.0));
        let text = format!(
            "[block]\nmass = \"{block_t} t\"\n[slider]\n{coefficients}\nradius = \"{radius_m} m\"\n{storey}"
        );
        (name, text)
    }
}

/// A column of the runs of some models, which have as many runs each.
fn column(json: &Value, name: &str) -> Result<Vec<f64>, String> {
    let all = json["runs"].as_array().into_iter().flatten();
    let found = all.into_iter().find(|column| column["name"] == name);
    let values = found.and_then(|column| column["values"].as_array());
    let values = values.ok_or_else(|| format!("slipstick run: no column {name}"))?;
    Ok(values.iter().map(|value| value.as_f64().unwrap_or(f64::NAN)).collect())
}

/// Ratios of two columns, run by run.
fn ratios(of: &[f64], to: &[f64]) -> Vec<f64> {
    of.iter().zip(to).map(|(a, b)| a / b).collect()
}

/// A fractile of values, by straight lines between them in order.
fn fractile(values: &[f64], share: f64) -> f64 {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let at = share * last as f64;
    let below = sorted[at as usize];
    below + (at - at.floor()) * (sorted[(at as usize + 1).min(last)] - below)
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Share of values above one, in per cent.
fn share_above(values: &[f64], limit: f64) -> f64 {
    100.0 * values.iter().filter(|value| **value > limit).count() as f64 / values.len() as f64
}

/// Adds a row of a table with ratios: count, fractiles, largest.
fn row(text: &mut String, head: &str, values: &[f64]) {
    let at = |share: f64| fractile(values, share);
    let _ = writeln!(
        text,
        "| {head} | {} | {:.2} | {:.2} | {:.2} | {:.2} | {:.2} | {:.0} % |",
        values.len(),
        at(0.16),
        at(0.5),
        at(0.84),
        at(0.95),
        at(1.0),
        share_above(values, 1.0)
    );
}

/// Adds the head of such a table.
fn head(text: &mut String, first: &str) {
    let _ = writeln!(
        text,
        "| {first} | runs | 16 % | median | 84 % | 95 % | largest | above 1 |\n|---|--:|--:|--:|--:|--:|--:|--:|"
    );
}

/// Both components at once over 100 % of one and 30 % of the other.
fn hundred_and_thirty(lab: &Lab, text: &mut String) -> Outcome {
    let designs = Design::all();
    let models: Vec<(String, String)> = designs.iter().map(|design| design.model(None)).collect();
    text.push_str("## 100 % of one component and 30 % of the other\n\n");
    text.push_str(
        "Peak sliding displacement under both components at once over the longer of the vectors (x, 0.3 y) and (0.3 x, y), where \
         x and y are the peaks under each component alone. Records as they are.\n\n",
    );
    let mut unsafe_by = Vec::new();
    for (name, pairs) in [("far-field pairs", &lab.far_field), ("pulse pairs", &lab.pulses)] {
        let json = lab.run(&models, pairs, &[])?;
        let both = column(&json, "peak_sliding_displacement_m")?;
        let all = ratios(&both, &column(&json, "peak_sliding_displacement_100_30_m")?);
        let runs = pairs[0].len();
        // Where a pair hardly slides nothing is designed for it.
        let slid = both.iter().zip(all).enumerate();
        let slid = slid.filter(|(_, (m, ratio))| **m > 0.005 && ratio.is_finite());
        let slid: Vec<(Design, f64)> =
            slid.map(|(run, (_, ratio))| (designs[run / runs], ratio)).collect();
        let of = |keep: &dyn Fn(&Design) -> bool| -> Vec<f64> {
            let kept = slid.iter().filter(|(design, _)| keep(design));
            kept.map(|(_, ratio)| *ratio).collect()
        };
        let values = of(&|_| true);
        head(text, &format!("design, {runs} {name}"));
        row(text, "all", &values);
        for friction in FRICTIONS {
            row(text, &format!("μ = {friction}"), &of(&|design| design.friction == friction));
        }
        for radius_m in RADII_M {
            row(text, &format!("R = {radius_m} m"), &of(&|design| design.radius_m == radius_m));
        }
        for structure_s in STRUCTURES_S {
            let what = structure_s.map_or("rigid".to_owned(), |s| format!("structure of {s} s"));
            row(text, &what, &of(&|design| design.structure_s == structure_s));
        }
        text.push('\n');
        unsafe_by.push((
            fractile(&values, 0.5),
            fractile(&values, 0.84),
            share_above(&values, 1.0),
        ));
    }
    let [(far, far_84, far_share), (pulse, pulse_84, pulse_share)] = unsafe_by[..] else {
        return Err("findings: expected two suites".to_owned());
    };
    let _ = writeln!(
        text,
        "**For design:** the rule is below both components at once in {far_share:.0} % of far-field and {pulse_share:.0} % of \
         pulse runs; to be safe in 84 % of them multiply its displacement by {far_84:.2} and {pulse_84:.2} (median {far:.2} and \
         {pulse:.2}), or run both components at once.\n\n**Limits:** runs that slide more than 5 mm; isotropic friction, the \
         same in both directions; no vertical component.\n"
    );
    Ok(())
}

/// The displacement of the equivalent lateral force procedure over the mean of response histories.
fn code_displacement(lab: &Lab, text: &mut String) -> Outcome {
    let designs: Vec<Design> =
        Design::all().into_iter().filter(|design| design.structure_s.is_none()).collect();
    let _ = writeln!(
        text,
        "## The code's displacement against the mean of exact runs\n\nASCE/SEI 7-22, 17.5, for a rigid block on a pendulum \
         slider; {} far-field pairs scaled to the spectrum `{SPECTRUM}` from 0.75 to 1.25 T_M.\n\n| μ | R (m) | T_M (s) | β_M \
         (%) | D_M (mm) | mean of runs (mm) | D_M over mean |\n|--:|--:|--:|--:|--:|--:|--:|",
        lab.far_field[0].len()
    );
    let mut all = Vec::new();
    for design in &designs {
        let json =
            lab.run(&[design.model(None)], &lab.far_field, &["--code-spectrum", SPECTRUM])?;
        let of_code = &json["lateral_force"][0];
        let number = |key: &str| of_code[key].as_f64().unwrap_or(f64::NAN);
        let exact_m = mean(&column(&json, "peak_sliding_displacement_m")?);
        let code_m = number("displacement_m");
        all.push(code_m / exact_m);
        let _ = writeln!(
            text,
            "| {} | {} | {:.2} | {:.1} | {:.0} | {:.0} | {:.2} |",
            design.friction,
            design.radius_m,
            number("period_s"),
            100.0 * number("damping_ratio"),
            1e3 * code_m,
            1e3 * exact_m,
            code_m / exact_m
        );
    }
    let below = all.iter().filter(|ratio| **ratio < 1.0).count();
    let _ = writeln!(
        text,
        "\n**For design:** D_M lies between {:.2} and {:.2} of the mean of exact runs, below it in {below} of {} designs; it \
         is a first size, not a bound.\n\n**Limits:** one spectrum, rigid structure, nominal friction, the mean of pairs that are \
         scaled by one factor each.\n",
        fractile(&all, 0.0),
        fractile(&all, 1.0),
        all.len()
    );
    Ok(())
}

/// A constant coefficient over one that follows the speed.
fn speed(lab: &Lab, text: &mut String) -> Outcome {
    const RATES_S_PER_M: [f64; 2] = [20.0, 100.0];
    let designs: Vec<Design> =
        Design::all().into_iter().filter(|design| design.structure_s != Some(3.0)).collect();
    let constant: Vec<(String, String)> = designs.iter().map(|design| design.model(None)).collect();
    let json = lab.run(&constant, &lab.far_field, &["--scale", "1.5"])?;
    let of_constant = [
        column(&json, "peak_sliding_displacement_m")?,
        column(&json, "block.peak_acceleration_m_per_s2")?,
    ];
    let _ = writeln!(
        text,
        "## A constant coefficient against one that follows the speed\n\nA constant coefficient equal to that at high speed \
         over μ = fast − (fast − slow) e^(−α |v|) with slow = fast/2; {} far-field pairs times 1.5, rigid block and structure of \
         0.5 s.\n",
        lab.far_field[0].len()
    );
    head(text, "figure");
    let mut medians = Vec::new();
    for rate in RATES_S_PER_M {
        let models: Vec<(String, String)> = designs
            .iter()
            .map(|design| {
                let (fast, slow) = (design.friction, 0.5 * design.friction);
                design.model(Some(&format!(
                    "static_friction = {slow}\nkinetic_friction = {{ slow = {slow}, fast = {fast}, rate = \"{rate} s/m\" }}"
                )))
            })
            .collect();
        let json = lab.run(&models, &lab.far_field, &["--scale", "1.5"])?;
        let displacements = column(&json, "peak_sliding_displacement_m")?;
        let accelerations = column(&json, "block.peak_acceleration_m_per_s2")?;
        let of_d = ratios(&of_constant[0], &displacements);
        let of_a = ratios(&of_constant[1], &accelerations);
        row(text, &format!("peak sliding displacement, α = {rate} s/m"), &of_d);
        row(text, &format!("peak block acceleration, α = {rate} s/m"), &of_a);
        medians.push((fractile(&of_d, 0.5), fractile(&of_d, 0.16), fractile(&of_a, 0.84)));
    }
    let [(slow, slow_16, slow_a), (fast, fast_16, fast_a)] = medians[..] else {
        return Err("findings: expected two rates".to_owned());
    };
    let _ = writeln!(
        text,
        "\n**For design:** a constant coefficient gives {slow:.2} of the displacement in the median at α = 20 s/m ({slow_16:.2} at \
         the 16 % fractile) and {fast:.2} at 100 s/m ({fast_16:.2}), and overstates the block's acceleration in 84 % of runs by no \
         more than {slow_a:.2} and {fast_a:.2}.\n\n**Limits:** slow friction half of fast; no dependence on pressure or \
         temperature; static friction equal to that at rest.\n"
    );
    Ok(())
}

/// A yield displacement in place of stick, as programs with an elastic branch have it.
fn yield_displacement(lab: &Lab, text: &mut String) -> Outcome {
    const YIELDS_MM: [f64; 4] = [0.25, 1.0, 2.5, 10.0];
    const FRICTION: f64 = 0.06;
    let _ = writeln!(
        text,
        "## A yield displacement in place of stick\n\nA rigid mass on a slider with μ = {FRICTION}, once held by friction and once \
         through a spring of stiffness μ W/D_y to a slider of a thousandth of the mass, as programs without stick model it; {} \
         first components of the far-field pairs, as they are. Ratios are those of the model with the spring over the exact one, \
         differences of the residual are sizes over the exact peak.\n\n| slider | D_y (mm) | peak, 16 % to 84 % | peak, \
         largest | acceleration, median | acceleration, largest | residual, median | residual, largest |\n\
         |---|--:|--:|--:|--:|--:|--:|--:|",
        lab.far_field[0].len()
    );
    let components: Pairs = [lab.far_field[0].clone(), Vec::new()];
    let mut worst: Vec<(f64, f64, f64)> = Vec::new();
    for (slider, restoring) in [("flat", ""), ("R = 2.5 m", "radius = \"2.5 m\"\n")] {
        let coefficients = format!(
            "[slider]\nstatic_friction = {FRICTION}\nkinetic_friction = {FRICTION}\n{restoring}"
        );
        let exact = format!("[block]\nmass = \"{MASS_T} t\"\n{coefficients}");
        let json = lab.run(&[("exact".to_owned(), exact)], &components, &[])?;
        let peaks = column(&json, "peak_sliding_displacement_m")?;
        let accelerations = column(&json, "block.peak_acceleration_m_per_s2")?;
        let residuals = column(&json, "residual_sliding_displacement_m")?;
        for yield_mm in YIELDS_MM {
            let stiffness_kn_per_m = FRICTION * MASS_T * 9.80665 / (1e-3 * yield_mm);
            let model = format!(
                "[block]\nmass = \"{} t\"\n{coefficients}[[storey]]\nmass = \"{MASS_T} t\"\n\
                 stiffness = \"{stiffness_kn_per_m} kN/m\"\ndamping_ratio = 0\n",
                1e-3 * MASS_T
            );
            let json = lab.run(&[("yield".to_owned(), model)], &components, &[])?;
            let of_peak = ratios(&column(&json, "peak_sliding_displacement_m")?, &peaks);
            let found = column(&json, "storey1_peak_acceleration_m_per_s2")?;
            let of_acceleration = ratios(&found, &accelerations);
            let found = column(&json, "residual_sliding_displacement_m")?;
            let differences = found.iter().zip(&residuals).map(|(a, b)| (a - b).abs());
            let of_residual = ratios(&differences.collect::<Vec<f64>>(), &peaks);
            let off = of_peak.iter().fold(1.0_f64, |most, ratio| {
                if (ratio.ln()).abs() > most.ln().abs() { *ratio } else { most }
            });
            let _ = writeln!(
                text,
                "| {slider} | {yield_mm} | {:.2} to {:.2} | {off:.2} | {:.2} | {:.2} | {:.2} | {:.2} |",
                fractile(&of_peak, 0.16),
                fractile(&of_peak, 0.84),
                fractile(&of_acceleration, 0.5),
                fractile(&of_acceleration, 1.0),
                fractile(&of_residual, 0.5),
                fractile(&of_residual, 1.0)
            );
            if yield_mm == 1.0 {
                worst.push((off, fractile(&of_acceleration, 1.0), fractile(&of_residual, 1.0)));
            }
        }
    }
    let [(flat, flat_a, flat_r), (curved, curved_a, curved_r)] = worst[..] else {
        return Err("findings: expected two sliders".to_owned());
    };
    let _ = writeln!(
        text,
        "\n**For design:** with D_y = 1 mm the peak of a run is off by up to a factor of {flat:.2} on a flat slider and {curved:.2} on \
         a pendulum, the residual by up to {flat_r:.2} and {curved_r:.2} of the peak, and the acceleration of the mass is up to \
         {flat_a:.2} and {curved_a:.2} of the exact one: the spring rings where stick is rigid.\n\n**Limits:** no damping in the \
         spring; one direction; a rigid mass; records under which it hardly slides are among \
         them.\n"
    );
    Ok(())
}
