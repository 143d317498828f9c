//! A tank with sloshing liquid as a model file, from its radius and the depth of its liquid.

use std::process::ExitCode;

use slipstick::model::LiquidTank;
use slipstick::units::Dimension;
use slipstick_files::write_whole;
use slipstick_report::examples::of_tank;

use crate::args::{StructureTankArgs, quantity};
use crate::failure::{Failure, print, say};

/// `slipstick structure tank`.
pub fn tank(args: &StructureTankArgs) -> Result<ExitCode, Failure> {
    let radius_m = quantity("--radius", &args.radius, Dimension::Length)?;
    let depth_m = quantity("--height", &args.height, Dimension::Length)?;
    let tank = LiquidTank::new(radius_m, depth_m, args.specific_gravity)
        .map_err(|error| Failure::Message(error.to_string()))?;
    let text = of_tank(&tank);
    let Some(path) = &args.out else {
        print(&text)?;
        return Ok(ExitCode::SUCCESS);
    };
    write_whole(path, text.as_bytes())?;
    let path = path.display();
    say(format_args!("wrote {path}; next: slipstick run {path} --out out"));
    Ok(ExitCode::SUCCESS)
}
