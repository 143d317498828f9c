//! Numbers of the text that need no time history: amplification on a fixed base, masses,
//! frequencies.

use core::f64::consts::{PI, TAU};

use crate::curves::crossing;
use crate::experiments::FIGURE_11_HZ;
use crate::library::{Library, damping_ratio, storey, with_block_mass};
use crate::{Claim, PaperError, Verdict};

/// Density of steel in kg/m³.
const STEEL_KG_PER_M3: f64 = 7850.0;

/// Young's modulus of steel in Pa.
const STEEL_PA: f64 = 210e9;

/// The frequencies in Hz that section 6 lists.
const LISTED_HZ: [f64; 5] = [1.125, 1.625, 1.75, 2.15, 2.65];

/// Most by which a cantilever may miss a listed frequency, as a ratio: clamping and the free
/// length of the rod are not known better.
const CANTILEVER_BAND: f64 = 0.10;

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

pub(crate) fn run(library: &Library) -> Result<(Vec<Cantilever>, Vec<Claim>), PaperError> {
    let cantilevers = cantilevers();
    let mut claims = vec![figure_10(library)?, figure_11(library)?, digits(library)?];
    for (id, claim, section, size, paper_kg) in [
        ("steel-205", "The 430 × 430 × 205 mm block is of steel and has 124 kg", "3", 0.205, 124.0),
        ("steel-410", "The 430 × 430 × 410 mm block is of steel and has 248 kg", "3", 0.410, 248.0),
    ] {
        claims.push(solid((id, section, claim), 0.43 * 0.43 * size, paper_kg));
    }
    let id = ("steel-325", "6", "The 330 × 530 × 530 mm block is of steel and has 325 kg");
    claims.push(solid(id, 0.33 * 0.53 * 0.53, 325.0));
    claims.extend(LISTED_HZ.map(|listed_hz| listed(&cantilevers, listed_hz)));
    claims.extend(measured_coefficients(library)?);
    Ok((cantilevers, claims))
}

fn figure_10(library: &Library) -> Result<Claim, PaperError> {
    let model = &library.experiment("section6-201kg-1_125hz-sine")?.model;
    let (_, frequency_hz) = storey(model);
    let damping = damping_ratio(model);
    let at = |f: f64, fn_hz: f64, xi: f64| amplification(f / fn_hz, xi);
    let paper = 4.22;
    let excitation =
        crossing([0.9, 1.0], |f| Ok::<_, PaperError>(at(f, frequency_hz, damping) - paper))?;
    let natural =
        crossing([1.125, 1.25], |fn_hz| Ok::<_, PaperError>(at(1.0, fn_hz, damping) - paper))?;
    let ratio = crossing([0.0, 0.2], |xi| Ok::<_, PaperError>(at(1.0, frequency_hz, xi) - paper))?;
    Ok(Claim::printed(
        (
            "amplification-4.22",
            "7.1",
            "On a fixed base the storey of 1.125 Hz would amplify a 1.0 Hz sine 4.22 times at 1 % \
             damping (figure 10)",
        ),
        [paper, 0.005],
        (at(1.0, frequency_hz, damping), ""),
        |verdict, difference| match verdict {
            Verdict::Agrees => "The closed form for a steady sine.".to_owned(),
            _ => format!(
                "The stated numbers give {difference:.3} more by the closed form for a steady \
                 sine. The printed value follows from one of them alone changed: a table \
                 frequency of {:.4} Hz, which prints as 1.0; a storey of {:.4} Hz, which does not \
                 print as 1.125; or {:.1} % damping, which is not of the order of 1 %. So the \
                 table most likely ran at {:.3} Hz.",
                excitation.unwrap_or(f64::NAN),
                natural.unwrap_or(f64::NAN),
                100.0 * ratio.unwrap_or(f64::NAN),
                excitation.unwrap_or(f64::NAN),
            ),
        },
    ))
}

fn figure_11(library: &Library) -> Result<Claim, PaperError> {
    let model = &library.experiment("section6-201kg-2_65hz-sine")?.model;
    let damping = damping_ratio(model);
    let (_, nominal_hz) = storey(model);
    let excitation_hz = 2.984;
    let nominal = amplification(excitation_hz / nominal_hz, damping);
    Ok(Claim::printed(
        (
            "amplification-4.27",
            "7.1",
            "On a fixed base the storey of 2.687 Hz would amplify a 2.984 Hz sine 4.27 times at \
             1 % damping (figure 11)",
        ),
        [4.27, 0.005],
        (amplification(excitation_hz / FIGURE_11_HZ, damping), ""),
        |_, difference| {
            format!(
                "The closed form for a steady sine is {difference:.4} off the printed value. With \
                 the {nominal_hz:.2} Hz that section 6 lists for the same mock-up it is \
                 {nominal:.3}."
            )
        },
    ))
}

/// 284 kg beside 124 and 248 kg, and what the slip of digits would do to a test on a spring.
fn digits(library: &Library) -> Result<Claim, PaperError> {
    let free = library.experiment("section3-248kg-free-sine")?;
    let sprung = library.experiment("section3-248kg-spring143-sine")?;
    let mut shown = Vec::new();
    for experiment in [free, sprung] {
        let heavier = experiment.with_model(with_block_mass(&experiment.model, 284.0)?);
        let [a, b] = [experiment.demands()?, heavier.demands()?];
        shown.push([a, b].map(|d| 1e3 * d.peak_sliding_displacement_m));
    }
    Ok(Claim::printed(
        ("mass-284", "3", "Friction of the heavier block was measured on 284 kg"),
        [284.0, 0.5],
        (2.0 * 124.0, "kg"),
        |_, difference| {
            format!(
                "{:.0} kg less: the section's own list has 124 and 248 kg, and twice the height is \
                 twice 124 kg; two digits changed places. Without a spring no motion depends on it \
                 ({:.1} and {:.1} mm peak sliding under the 1.5 Hz sine); on the 143 kN/m spring \
                 under the 3.5 Hz sine 248 kg slides {:.1} mm and 284 kg {:.1} mm.",
                difference.abs(),
                shown[0][0],
                shown[0][1],
                shown[1][0],
                shown[1][1],
            )
        },
    ))
}

fn solid(id: (&str, &'static str, &str), volume_m3: f64, paper_kg: f64) -> Claim {
    let solid_kg = volume_m3 * STEEL_KG_PER_M3;
    Claim::printed(id, [paper_kg, 0.5], (solid_kg, "kg"), |_, difference| {
        format!(
            "Solid steel of {STEEL_KG_PER_M3:.0} kg/m³ has {difference:.0} kg more. The stated mass \
             fills {:.0} % of the stated size, so the block is hollow or not all of steel; every \
             analysis here takes the stated mass.",
            100.0 * paper_kg / solid_kg
        )
    })
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

fn listed(cantilevers: &[Cantilever], listed_hz: f64) -> Claim {
    // 45 kg are printed beside 1.625 Hz and 201 kg beside 1.125 and 2.687 Hz: others are free.
    let printed_kg = match listed_hz {
        1.625 => Some(45.0),
        1.125 | 2.65 => Some(201.0),
        _ => None,
    };
    let allowed = |c: &&Cantilever| printed_kg.is_none_or(|mass| mass == c.mass_kg);
    let off = |c: &Cantilever| (c.frequency_hz / listed_hz - 1.0).abs();
    let nearest = cantilevers
        .iter()
        .filter(allowed)
        .copied()
        .reduce(|a, b| if off(&b) < off(&a) { b } else { a })
        .unwrap_or(cantilevers[0]);
    let mass = match printed_kg {
        Some(mass) => format!("with the {mass:.0} kg printed beside it"),
        None => "with one of the three masses".to_owned(),
    };
    let claim = format!("The rods of section 6 give a storey of {listed_hz} Hz {mass}");
    let band = [listed_hz * (1.0 - CANTILEVER_BAND), listed_hz * (1.0 + CANTILEVER_BAND)];
    Claim::banded(
        (&format!("frequency-{listed_hz}"), "6", &claim),
        Some(listed_hz),
        (nearest.frequency_hz, "Hz"),
        (band, "the nearest ideal steel cantilever (E = 210 GPa) within 10 %"),
        |verdict| {
            let shape = format!(
                "Nearest is {:.0} kg on the rod of {:.0} mm and {:.2} m",
                nearest.mass_kg,
                1e3 * nearest.diameter_m,
                nearest.length_m
            );
            let difference = nearest.frequency_hz - listed_hz;
            match verdict {
                Verdict::Agrees => format!("{shape}, {difference:+.3} Hz off."),
                _ => {
                    let ratio = listed_hz / nearest.frequency_hz;
                    format!(
                        "{shape}, {difference:+.3} Hz off; it would need {:.2} times that \
                         stiffness, a rod of {:.1} mm or {:.2} m, or a mass of {:.0} kg.",
                        ratio * ratio,
                        1e3 * nearest.diameter_m * ratio.sqrt(),
                        nearest.length_m / libm::cbrt(ratio * ratio),
                        nearest.mass_kg / (ratio * ratio),
                    )
                }
            }
        },
    )
}

/// What the text says was measured, whose measurements it does not give.
fn measured_coefficients(library: &Library) -> Result<Vec<Claim>, PaperError> {
    let light = &library.experiment("section3-124kg-free-sine")?.model;
    let heavy = &library.experiment("section3-248kg-free-sine")?.model;
    let lowered =
        |of: fn(&slipstick::model::Model) -> [f64; 2]| 100.0 * (1.0 - of(heavy)[0] / of(light)[0]);
    let statics = lowered(|model| model.static_friction());
    let kinetics = lowered(|model| model.kinetic_friction());
    let mut peaks = Vec::new();
    for id in ["section3-124kg-spring128-sine", "section3-124kg-spring143-sine"] {
        peaks.push(1e3 * library.experiment(id)?.demands()?.peak_sliding_displacement_m);
    }
    Ok(vec![
        Claim::unchecked(
            (
                "friction-measured",
                "3",
                "Friction, measured in ten cyclic tests from 0.1 to 1.0 Hz, does not depend on \
                 frequency",
            ),
            format!(
                "The force and displacement histories of the tests are not given, nor their \
                 scatter. What is given contradicts one constant of the material: doubling the \
                 mass lowers the static coefficient by {statics:.1} % and the kinetic one by \
                 {kinetics:.1} %. Coefficients 4 to 11 % lower are scanned for section 6."
            ),
        ),
        Claim::unchecked(
            (
                "spring-measured",
                "3",
                "The springs have 128.6, 143.0 and 19.4 kN/m, measured in cyclic tests",
            ),
            format!(
                "The histories are not given, and section 3.2.1 does not say which certified \
                 spring it used. At 3 m/s² and 3.5 Hz the 124 kg block slides {:.2} mm on 128.6 \
                 kN/m and {:.2} mm on 143.0 kN/m.",
                peaks[0], peaks[1]
            ),
        ),
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
