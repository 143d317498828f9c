//! `slipstick structure`: the modes of a structure, as other programs write them.

use std::path::Path;
use std::process::ExitCode;

use slipstick::input::{MAX_TEXT_BYTES, ModalOptions, ModalTable, from_bytes, read_modes};
use slipstick::units::Dimension;
use slipstick_files::{modes_beside, read_at_most, refuse_inputs, write_whole};
use slipstick_report::number::rounded;
use slipstick_report::structure::ModalInfo;

use super::record::damping_ratio;
use super::tank;
use crate::args::{ModalArgs, StructureCommand, StructureConvertArgs, StructureInfoArgs, quantity};
use crate::failure::{Failure, print, say};

/// The largest table: ten thousand joints in a hundred modes.
const MAX_TABLE_BYTES: u64 = 1 << 27;

/// Runs one of the commands.
pub fn structure(command: &StructureCommand) -> Result<ExitCode, Failure> {
    match command {
        StructureCommand::Info(args) => info(args),
        StructureCommand::Convert(args) => convert(args),
        StructureCommand::Tank(args) => tank::tank(args),
    }
}

/// What files of one structure say, and the mass from the option.
struct Read {
    table: ModalTable,
    mass_kg: Option<f64>,
}

fn read(args: &ModalArgs) -> Result<Read, Failure> {
    let refuse = |option: &str, expected: &str, found: &str| {
        Failure::Message(format!("{option}: expected {expected}, found {found:?}"))
    };
    let mass = |option: &str, text: &str| {
        let kg = quantity(option, text, Dimension::Mass)?;
        if kg > 0.0 { Ok(kg) } else { Err(refuse(option, "a mass > 0", text)) }
    };
    let mass_kg = args.mass.as_deref().map(|text| mass("--mass", text)).transpose()?;
    let unit = |text: &str| {
        let is_bare = Dimension::Mass.units().iter().any(|unit| unit.name() == text.trim());
        mass("--mass-unit", &if is_bare { format!("1 {text}") } else { text.to_owned() })
    };
    let mass_unit_kg = args.mass_unit.as_deref().map(unit).transpose()?;
    let point = |text: &String| match text.split_once('=') {
        Some((name, joint)) if !name.trim().is_empty() && !joint.trim().is_empty() => {
            Ok((name.trim().to_owned(), joint.trim().to_owned()))
        }
        _ => Err(refuse("--point", "a name and a joint, such as Roof=103", text)),
    };
    let points = args.point.iter().map(point).collect::<Result<_, _>>()?;
    let options = ModalOptions { case: args.case.clone(), mass_unit_kg, points };
    if let [model] = &args.files[..]
        && model.extension().is_some_and(|e| e.eq_ignore_ascii_case("toml"))
    {
        return Ok(Read { table: of_model(model)?, mass_kg });
    }
    let mut texts = Vec::new();
    for path in &args.files {
        let bytes = read_at_most(path, MAX_TABLE_BYTES)?;
        texts.push((path.display().to_string(), String::from_utf8_lossy(&bytes).into_owned()));
    }
    let files: Vec<(&str, &str)> =
        texts.iter().map(|(n, text)| (n.as_str(), text.as_str())).collect();
    let table = read_modes(&files, &options).map_err(|error| {
        let of = texts.iter().find(|(name, _)| *name == error.place.source_name);
        let text = of.map_or("", |(_, text)| text);
        Failure::input(error, text)
    })?;
    Ok(Read { table, mass_kg })
}

/// The structure of a model file.
fn of_model(path: &Path) -> Result<ModalTable, Failure> {
    let bytes = read_at_most(path, MAX_TEXT_BYTES as u64)?;
    let name = path.display().to_string();
    let text = String::from_utf8_lossy(&bytes);
    let failed = |error| Failure::input(error, &text);
    let modes = modes_beside(path, &name, &bytes).map_err(failed)?;
    let set: Vec<_> = modes.into_iter().collect();
    let analysis = from_bytes(&name, &bytes, &set).map_err(failed)?;
    analysis.model.structure().map(ModalTable::of).ok_or_else(|| {
        failed(analysis.error_at("structure", "a table [structure] with the modes", "none"))
    })
}

/// Prints the table or JSON, and draws the shapes.
fn info(args: &StructureInfoArgs) -> Result<ExitCode, Failure> {
    let Read { table, mass_kg } = read(&args.read)?;
    let names: Vec<String> =
        args.read.files.iter().map(|path| path.display().to_string()).collect();
    let info = ModalInfo { files: &names.join(", "), table: &table, mass_kg };
    if let Some(path) = &args.svg {
        refuse_inputs(path, &args.read.files)?;
        let Some(svg) = info.figure() else {
            let expected = "points with shapes to draw";
            return Err(Failure::Message(format!("--svg: expected {expected}, found none")));
        };
        write_whole(path, svg.as_str().as_bytes())?;
        say(format_args!("wrote {}", path.display()));
    }
    print(&if args.json { info.json() } else { info.text(args.display_units) })?;
    Ok(ExitCode::SUCCESS)
}

/// Writes `modes.csv`, and says what a model needs besides.
fn convert(args: &StructureConvertArgs) -> Result<ExitCode, Failure> {
    let Read { mut table, mass_kg } = read(&args.read)?;
    if let Some(text) = &args.damping {
        let ratio = damping_ratio(text)?;
        table.modes.iter_mut().for_each(|mode| mode.damping_ratio = Some(ratio));
    }
    for note in &table.notes {
        say(format_args!("note: {note}"));
    }
    let csv = table.to_csv();
    let Some(path) = &args.out else {
        print(&csv)?;
        return Ok(ExitCode::SUCCESS);
    };
    refuse_inputs(path, &args.read.files)?;
    write_whole(path, csv.as_bytes())?;
    let largest_kg = table.mass_kg.into_iter().flatten().reduce(f64::max);
    let mass =
        mass_kg.or(largest_kg).map_or("…".to_owned(), |kg| format!("{} t", rounded(kg / 1e3, 8)));
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    say(format_args!(
        "wrote {}; in a model beside it: [structure] with mass = {mass:?}, modes = {name:?}",
        path.display()
    ));
    Ok(ExitCode::SUCCESS)
}
