//! Numbers of the text that need no time history: amplification on a fixed base, masses,
//! frequencies.

use core::f64::consts::{PI, TAU};

use crate::PaperError;
use crate::claims::Finding;
use crate::curves::crossing;
use crate::library::{FIGURE_11_HZ, Library, damping_ratio, storey, with_block_mass};

/// Density of steel in kg/m³.
const STEEL_KG_PER_M3: f64 = 7850.0;

/// Young's modulus of steel in Pa.
const STEEL_PA: f64 = 210e9;

/// Frequency of a mass on a rod of section 6, taken as an ideal cantilever.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cantilever {
    /// Diameter of the rod in m.
    pub diameter_m: f64,
    /// Its free length in m.
    pub length_m: f64,
    /// Mass on it in kg.
    pub mass_kg: f64,
    /// Frequency in Hz.
    pub frequency_hz: f64,
}

/// Peak acceleration of a damped oscillator over that of its base in a steady sine, `r = f/f_n`.
pub(crate) fn amplification(ratio: f64, damping: f64) -> f64 {
    let c = 2.0 * damping * ratio;
    let d = 1.0 - ratio * ratio;
    ((1.0 + c * c) / (d * d + c * c)).sqrt()
}

pub(crate) fn run(
    library: &Library,
    findings: &mut Vec<Finding>,
) -> Result<Vec<Cantilever>, PaperError> {
    let cantilevers = cantilevers();
    findings.extend([figure_10(library)?, figure_11(library)?, digits(library)?]);
    for (id, volume_m3) in [
        ("steel-205", 0.43 * 0.43 * 0.205),
        ("steel-410", 0.43 * 0.43 * 0.410),
        ("steel-325", 0.33 * 0.53 * 0.53),
    ] {
        let solid_kg = volume_m3 * STEEL_KG_PER_M3;
        findings.push(
            Finding::new(id, solid_kg)
                .quoting("density", STEEL_KG_PER_M3)
                .quoting("filled", 100.0 * library.printed(id)? / solid_kg),
        );
    }
    // 45 kg are printed beside 1.625 Hz and 201 kg beside 1.125 and 2.687 Hz: others are free.
    for (id, printed_kg) in [
        ("frequency-1.125", Some(201.0)),
        ("frequency-1.625", Some(45.0)),
        ("frequency-1.75", None),
        ("frequency-2.15", None),
        ("frequency-2.65", Some(201.0)),
    ] {
        findings.push(listed(&cantilevers, id, library.printed(id)?, printed_kg));
    }
    findings.extend(measured_coefficients(library)?);
    Ok(cantilevers)
}

fn figure_10(library: &Library) -> Result<Finding, PaperError> {
    let id = "amplification-4.22";
    let model = &library.experiment("section6-201kg-1_125hz-sine")?.model;
    let (_, frequency_hz) = storey(model);
    let damping = damping_ratio(model);
    let paper = library.printed(id)?;
    let at = |f: f64, fn_hz: f64, xi: f64| amplification(f / fn_hz, xi);
    let excitation =
        crossing([0.9, 1.0], |f| Ok::<_, PaperError>(at(f, frequency_hz, damping) - paper))?;
    let natural =
        crossing([1.125, 1.25], |fn_hz| Ok::<_, PaperError>(at(1.0, fn_hz, damping) - paper))?;
    let ratio = crossing([0.0, 0.2], |xi| Ok::<_, PaperError>(at(1.0, frequency_hz, xi) - paper))?;
    Ok(Finding::new(id, at(1.0, frequency_hz, damping))
        .quoting("table_hz", excitation.unwrap_or(f64::NAN))
        .quoting("storey_hz", natural.unwrap_or(f64::NAN))
        .quoting("damping_percent", 100.0 * ratio.unwrap_or(f64::NAN)))
}

fn figure_11(library: &Library) -> Result<Finding, PaperError> {
    let model = &library.experiment("section6-201kg-2_65hz-sine")?.model;
    let damping = damping_ratio(model);
    let (_, listed_hz) = storey(model);
    let of_storey = |hz: f64| amplification(2.984 / hz, damping);
    Ok(Finding::new("amplification-4.27", of_storey(FIGURE_11_HZ))
        .quoting("listed_hz", listed_hz)
        .quoting("listed", of_storey(listed_hz)))
}

/// 284 kg beside 124 and 248 kg, and what the slip of digits would do to a test on a spring.
fn digits(library: &Library) -> Result<Finding, PaperError> {
    let (id, stated_kg) = ("mass-284", 2.0 * 124.0);
    let paper_kg = library.printed(id)?;
    let mut finding = Finding::new(id, stated_kg).quoting("less", paper_kg - stated_kg);
    for (test, stated, printed) in [
        ("section3-248kg-free-sine", "free_248", "free_284"),
        ("section3-248kg-spring143-sine", "spring_248", "spring_284"),
    ] {
        let test = library.experiment(test)?;
        let heavier = test.with_model(with_block_mass(&test.model, paper_kg)?);
        for (name, test) in [(stated, test), (printed, &heavier)] {
            finding = finding.quoting(name, 1e3 * test.demands()?.peak_sliding_displacement_m);
        }
    }
    Ok(finding)
}

fn cantilevers() -> Vec<Cantilever> {
    let mut all = Vec::new();
    for diameter_m in [0.014, 0.020] {
        for length_m in [0.44, 0.76] {
            for mass_kg in [45.0, 90.0, 201.0] {
                let d2 = diameter_m * diameter_m;
                let inertia_m4 = PI * d2 * d2 / 64.0;
                let stiffness = 3.0 * STEEL_PA * inertia_m4 / (length_m * length_m * length_m);
                let frequency_hz = (stiffness / mass_kg).sqrt() / TAU;
                all.push(Cantilever { diameter_m, length_m, mass_kg, frequency_hz });
            }
        }
    }
    all
}

fn listed(
    cantilevers: &[Cantilever],
    id: &str,
    listed_hz: f64,
    printed_kg: Option<f64>,
) -> Finding {
    let allowed = |c: &&Cantilever| printed_kg.is_none_or(|mass| mass == c.mass_kg);
    let off = |c: &Cantilever| (c.frequency_hz / listed_hz - 1.0).abs();
    let nearest = cantilevers
        .iter()
        .filter(allowed)
        .copied()
        .reduce(|a, b| if off(&b) < off(&a) { b } else { a })
        .unwrap_or(cantilevers[0]);
    let ratio = listed_hz / nearest.frequency_hz;
    Finding::new(id, nearest.frequency_hz)
        .quoting("mass_kg", nearest.mass_kg)
        .quoting("diameter_mm", 1e3 * nearest.diameter_m)
        .quoting("length_m", nearest.length_m)
        .quoting("stiffness", ratio * ratio)
        .quoting("needed_mm", 1e3 * nearest.diameter_m * ratio.sqrt())
        .quoting("needed_m", nearest.length_m / libm::cbrt(ratio * ratio))
        .quoting("needed_kg", nearest.mass_kg / (ratio * ratio))
}

/// What the text says was measured, whose measurements it does not give.
fn measured_coefficients(library: &Library) -> Result<[Finding; 2], PaperError> {
    let light = &library.experiment("section3-124kg-free-sine")?.model;
    let heavy = &library.experiment("section3-248kg-free-sine")?.model;
    let lowered =
        |of: fn(&slipstick::model::Model) -> [f64; 2]| 100.0 * (1.0 - of(heavy)[0] / of(light)[0]);
    let peak_mm = |spring: &str| -> Result<f64, PaperError> {
        let test = library.experiment(&format!("section3-124kg-{spring}-sine"))?;
        Ok(1e3 * test.demands()?.peak_sliding_displacement_m)
    };
    Ok([
        Finding::unchecked("friction-measured")
            .quoting("static", lowered(|model| model.static_friction()))
            .quoting("kinetic", lowered(|model| model.kinetic_friction())),
        Finding::unchecked("spring-measured")
            .quoting("spring_128", peak_mm("spring128")?)
            .quoting("spring_143", peak_mm("spring143")?),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: |H|² = (1 + (2ξr)²)/((1 − r²)² + (2ξr)²).
    #[test]
    fn amplification_is_that_of_a_damped_oscillator() {
        assert!((amplification(1.0 / 1.125, 0.01) - 4.7485).abs() < 5e-5);
        assert!((amplification(2.984 / 2.687, 0.01) - 4.2684).abs() < 5e-5);
        assert_eq!(amplification(0.0, 0.01), 1.0);
    }

    /// 20 mm of steel, 0.76 m long: I = π d⁴/64 = 7.854e-9 m⁴, 3EI/L³ = 11 272 N/m, 2.519 Hz with
    /// 45 kg.
    #[test]
    fn a_cantilever_has_its_stiffness() {
        let rods = cantilevers();
        let rod = rods.iter().find(|c| (c.diameter_m, c.length_m) == (0.020, 0.76)).unwrap();
        assert_eq!(rod.mass_kg, 45.0);
        assert!((rod.frequency_hz - 2.519).abs() < 5e-4, "{}", rod.frequency_hz);
    }
}
