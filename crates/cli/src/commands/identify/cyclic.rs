//! Friction from cyclic tests.

use std::path::Path;
use std::process::ExitCode;

use slipstick::laboratory::identify::{
    CyclicRequest, ModelText, block_text, cyclic as identify_cyclic,
};
use slipstick::laboratory::measured::Measured;
use slipstick::units::Dimension;
use slipstick_files::{SourceFile, expand_all, read_mapping, time_left};

use super::{Inputs, failure, finish, output, read, text};
use crate::args::{CyclicArgs, Part, quantity};
use crate::commands::run::read_model;
use crate::failure::Failure;
use crate::progress::{TRIAL, estimated};

/// Identifies friction, spring and damper from one or several cyclic tests.
pub fn cyclic(args: &CyclicArgs) -> Result<ExitCode, Failure> {
    let given = args.model.as_deref().map(read_model).transpose()?;
    let in_si = |option, text: &Option<String>, dimension| {
        text.as_deref().map(|text| quantity(option, text, dimension)).transpose()
    };
    in_si("--mass", &args.mass, Dimension::Mass)?;
    let normal_force_n = in_si("--normal-force", &args.normal_force, Dimension::Force)?;
    let slack_m = in_si("--slack", &args.slack, Dimension::Length)?;
    let (mapping, mapping_file) = read_mapping(args.mapping.mapping.as_deref(), &args.mapping.map)?;
    let (mut measured, mut sources) = (Vec::new(), Vec::new());
    for path in expand_all(Path::new(""), &args.files)? {
        let (one, source) = read(&path, &mapping, args.result.quiet)?;
        measured.push(one);
        sources.push(source);
    }
    let sources: Vec<&SourceFile> = sources.iter().collect();
    let inputs =
        Inputs { model: given.as_ref(), sources: &sources, mapping: mapping_file.as_ref() };
    let folder = output(&args.result, &inputs.paths())?;
    let given_text = given.as_ref().map(text).transpose()?;
    let base = given.as_ref().map(|model| model.name.as_str()).zip(given_text);
    let base = base.or_else(|| Some(("--mass", block_text(args.mass.as_deref()?))));
    let request = CyclicRequest {
        model: base.as_ref().map(|(name, text)| ModelText { name, text, set: &[] }),
        normal_force_n,
        slack_m,
        spring: !args.without.contains(&Part::Spring),
        damper: !args.without.contains(&Part::Damper),
        law: args.law.into(),
    };
    let samples = measured.iter().map(Measured::samples).max().unwrap_or(0);
    let first = |samples: usize| {
        let first: Vec<Measured> = measured.iter().map(|m| m.first(samples)).collect();
        identify_cyclic(&request, &first).ok().map(|_| ())
    };
    // Less than half of a test may lack the cycles that a fit needs.
    let estimate = || time_left([samples / 2, samples], TRIAL, first);
    let fit = || identify_cyclic(&request, &measured);
    let identified = estimated("fitting", args.result.quiet, &estimate, fit);
    let text = base.as_ref().map_or("", |(_, text)| text);
    let identified = identified.map_err(|error| failure(error, text))?;
    finish(&args.result, folder, &inputs, &measured, &identified)
}
