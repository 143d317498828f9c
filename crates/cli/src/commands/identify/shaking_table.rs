//! Parameters of a model from a shaking-table record.

use std::process::ExitCode;

use slipstick::laboratory::identify::{
    ModelText, ShakingTableRequest, shaking_table as identify_shaking_table,
};
use slipstick_files::read_mapping;

use super::{Inputs, failure, finish, output, read, text};
use crate::args::ShakingTableArgs;
use crate::commands::run::{overrides, read_model};
use crate::failure::Failure;
use crate::progress::counted;

/// Fits chosen keys of a model to measured histories.
pub fn shaking_table(args: &ShakingTableArgs) -> Result<ExitCode, Failure> {
    let model = read_model(&args.model)?;
    let (set, text) = (overrides(&args.set, None)?, text(&model)?);
    let (mapping, mapping_file) = read_mapping(args.mapping.mapping.as_deref(), &args.mapping.map)?;
    let (measured, source) = read(&args.file, &mapping, args.result.quiet)?;
    let inputs =
        Inputs { model: Some(&model), sources: &[&source], mapping: mapping_file.as_ref() };
    let folder = output(&args.result, &inputs.paths())?;
    let fit: Vec<&str> = args.fit.iter().map(String::as_str).collect();
    let using: Vec<&str> = args.using.iter().map(String::as_str).collect();
    let request = ShakingTableRequest {
        model: ModelText { name: &model.name, text: &text, set: &set },
        fit: &fit,
        using: &using,
        seed: args.seed,
    };
    let identified = counted("fitting", args.result.quiet, |engine| {
        identify_shaking_table(&request, &measured, engine)
    });
    let identified = identified.map_err(|error| failure(error, &text))?;
    finish(&args.result, folder, &inputs, core::slice::from_ref(&measured), &identified)
}
