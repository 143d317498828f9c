//! Friction from cyclic tests.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use slipstick::input::Channel;
use slipstick::laboratory::cyclic::{CyclicTest, cyclic as fit_cyclic, estimates, zero_not_stated};
use slipstick::laboratory::measured::{Measured, Series};
use slipstick::units::{Dimension, STANDARD_GRAVITY_M_PER_S2};
use slipstick_files::{expand_all, read_mapping, read_measured, time_left};
use slipstick_report::IdentifyReport;
use slipstick_report::laboratory::cyclic::{
    ASSUMPTION, Test, by_test, facts, figures, json, table,
};

use super::{finish, fitted_model, output, quantity};
use crate::args::{CyclicArgs, Part};
use crate::commands::compare::WentIn;
use crate::commands::run::{ModelFile, command_line, read_model};
use crate::failure::Failure;
use crate::progress::{TRIAL, estimated, watched};

/// Identifies friction, spring and damper from one or several cyclic tests.
pub fn cyclic(args: &CyclicArgs) -> Result<ExitCode, Failure> {
    let model = args.model.as_deref().map(read_model).transpose()?;
    let given = model.as_ref().map(|model| {
        slipstick::input::from_bytes(&model.name, &model.bytes, &[])
            .map_err(|error| Failure::input(error, &model.text()))
    });
    let given = given.transpose()?;
    let mass_kg = args.mass.as_deref().map(|text| quantity("--mass", text, Dimension::Mass));
    let mass_kg = mass_kg.transpose()?;
    let normal_n = match (&args.normal_force, mass_kg, &given) {
        (Some(text), ..) => Some(quantity("--normal-force", text, Dimension::Force)?),
        (None, Some(mass_kg), _) => Some(mass_kg * STANDARD_GRAVITY_M_PER_S2),
        (None, None, Some(given)) => Some(given.model.weight_n()),
        (None, None, None) => None,
    };
    if let Some(normal_n) = normal_n.filter(|n| !(*n > 0.0)) {
        let found = format!("expected a normal force > 0 N, found {normal_n} N");
        return Err(Failure::Message(found));
    }
    let slack_m = args.slack.as_deref().map(|text| quantity("--slack", text, Dimension::Length));
    let slack_m = slack_m.transpose()?;
    let (mapping, mapping_file) = read_mapping(args.mapping.mapping.as_deref(), &args.mapping.map)?;
    let mut files = Vec::new();
    let paths = expand_all(Path::new(""), &args.files)?;
    for path in &paths {
        files.push(watched("reading", args.result.quiet, || read_measured(path, &mapping))?);
    }
    let inputs: Vec<PathBuf> = paths
        .iter()
        .cloned()
        .chain(model.as_ref().map(|model| model.path.clone()))
        .chain(mapping_file.as_ref().map(|file| file.source.path.clone()))
        .collect();
    let folder = output(&args.result, &inputs)?;
    let mut fits = Vec::new();
    for (measured, _) in &files {
        let (displacement, force) = histories(measured)?;
        let test = |samples: usize| CyclicTest {
            times_s: first_of(&displacement.times_s, samples),
            displacement_m: first_of(&displacement.values, samples),
            force_n: first_of(&force.values, samples),
            slack_m,
            spring: !args.without.contains(&Part::Spring),
            damper: !args.without.contains(&Part::Damper),
            // An offset of the displacement is one of the force where a spring is fitted.
            zero_known: force.zero_known
                && (displacement.zero_known || args.without.contains(&Part::Spring)),
        };
        let count = displacement.times_s.len();
        let first = |samples| fit_cyclic(&test(samples)).ok().map(|_| ());
        // Less than half of a test may lack the cycles that a fit needs.
        let estimate = || time_left([count / 2, count], TRIAL, first);
        let fit = || fit_cyclic(&test(usize::MAX));
        let fit = estimated("fitting", args.result.quiet, &estimate, fit);
        let name = &measured.source_name;
        fits.push(fit.map_err(|error| Failure::CannotTell(format!("{name}: {error}")))?);
    }
    let mut tests = Vec::new();
    for ((measured, _), fit) in files.iter().zip(&fits) {
        let (displacement, force) = histories(measured)?;
        tests.push(Test {
            name: &measured.source_name,
            displacement_m: &displacement.values,
            force_n: &force.values,
            fit,
        });
    }
    let all: Vec<_> = fits.iter().collect();
    let largest_n = tests.iter().flat_map(|t| t.force_n).fold(0.0, |m: f64, f| m.max(f.abs()));
    let found = estimates(&all, largest_n, normal_n);
    let mut warnings: Vec<_> = files.iter().flat_map(|(m, _)| m.warnings.clone()).collect();
    warnings.extend(fits.iter().filter_map(|fit| fit.warning()));
    warnings.extend(zero_not_stated(&all));
    let base = model.or_else(|| args.mass.as_deref().map(plain_model));
    let mut more = Vec::new();
    if let Some(base) = base.filter(|_| found.estimates[0].value().is_some()) {
        let (analysis, decided) = fitted_model(&base, &[], &found.estimates)?;
        warnings.extend(decided);
        more.push(("model.toml", analysis.to_toml(None).into_bytes()));
    }
    let sources: Vec<_> = files.iter().map(|(_, source)| source).collect();
    let went_in = WentIn::of_files(None, &sources, mapping_file.as_ref());
    let names: Vec<&str> = files.iter().map(|(m, _)| m.source_name.as_str()).collect();
    let per_hz = found.per_hz.clone();
    let mut tables = vec![("Cycle by cycle".to_owned(), table(&tests, normal_n))];
    if tests.len() > 1 {
        let unit = if normal_n.is_some() { "" } else { " (N)" };
        tables.insert(0, (format!("Test by test{unit}"), by_test(&tests, normal_n)));
    }
    let report = IdentifyReport {
        version: env!("CARGO_PKG_VERSION"),
        job: "cyclic",
        measured: &names.join(", "),
        json: json(&tests, &found),
        estimates: found.estimates.into_iter().chain(per_hz).collect(),
        facts: facts(&tests, normal_n),
        tables,
        assumption: ASSUMPTION.to_owned(),
        figures: figures(&tests, args.result.display_units.into()),
        warnings,
        inputs: &went_in.inputs(),
        files: &went_in.files(),
        command_line: &command_line(),
        display: args.result.display_units.into(),
    };
    finish(&args.result, folder, &report, &more)
}

fn first_of(values: &[f64], count: usize) -> &[f64] {
    values.get(..count).unwrap_or(values)
}

/// Displacement and force of a file.
fn histories(measured: &Measured) -> Result<(&Series, &Series), Failure> {
    let message = |error: slipstick::error::RecordError| Failure::Message(error.to_string());
    let displacement = match measured.get(Channel::SlidingDisplacement) {
        Some(sliding) if measured.get(Channel::Displacement).is_none() => sliding,
        _ => measured.require(Channel::Displacement).map_err(message)?,
    };
    Ok((displacement, measured.require(Channel::Force).map_err(message)?))
}

/// A model of the block alone, whose friction the test replaces.
fn plain_model(mass: &str) -> ModelFile {
    let text = format!(
        "[block]\nmass = \"{}\"\n\n[slider]\nstatic_friction = 1\nkinetic_friction = 1\n",
        mass.trim()
    );
    ModelFile { name: "--mass".to_owned(), path: PathBuf::new(), bytes: text.into_bytes() }
}
