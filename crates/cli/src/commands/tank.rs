//! A tank with sloshing liquid as a model file, from its radius and the depth of its liquid.

use std::process::ExitCode;

use slipstick::model::LiquidTank;
use slipstick::units::Dimension;
use slipstick_files::write_whole;
use slipstick_report::number::{compact, significant};

use crate::args::{StructureTankArgs, quantity};
use crate::failure::{Failure, print, say};

const MODEL: &str = include_str!("../../models/tank-sloshing.toml");

const POUND_KG: f64 = 0.453_592_37;
const FOOT_M: f64 = 0.3048;

/// Mass of slab and wall over that of the liquid, and how much wider the slab is than the liquid: assumed.
const BLOCK_OF_LIQUID: f64 = 0.16;
const WIDER_M: f64 = 1.0;

/// `slipstick structure tank`.
pub fn tank(args: &StructureTankArgs) -> Result<ExitCode, Failure> {
    let radius_m = quantity("--radius", &args.radius, Dimension::Length)?;
    let depth_m = quantity("--height", &args.height, Dimension::Length)?;
    let tank = LiquidTank::new(radius_m, depth_m, args.specific_gravity)
        .map_err(|error| Failure::Message(error.to_string()))?;
    let text = model(&tank);
    let Some(path) = &args.out else {
        print(&text)?;
        return Ok(ExitCode::SUCCESS);
    };
    write_whole(path, text.as_bytes())?;
    let path = path.display();
    say(format_args!("wrote {path}; next: slipstick run {path} --out out"));
    Ok(ExitCode::SUCCESS)
}

/// The model file of the example: a tank of 20 m, 8 m deep.
pub fn example() -> Result<String, Failure> {
    let tank = LiquidTank::new(10.0, 8.0, 1.0);
    tank.map(|tank| model(&tank)).map_err(|error| Failure::Message(error.to_string()))
}

/// The model file of a tank, with how its numbers come about.
fn model(tank: &LiquidTank) -> String {
    let mass = |kg: f64| format!("{} t", significant(kg / 1e3, 6));
    let both =
        |text: String, us: f64, unit: &str| format!("{text:<10} ({} {unit})", significant(us, 4));
    let masses = |kg: f64| both(mass(kg), kg / POUND_KG, "lb");
    let length = |m: f64| format!("{} m", significant(m, 4));
    let lengths = |m: f64| both(length(m), m / FOOT_M, "ft");
    let ratio = |kg: f64| significant(kg / tank.mass_kg, 6);
    let shape = |kg: f64| format!("{:.6e}", 1.0 / kg.sqrt());
    let what = format!(
        "Diameter D = {}, depth H = {}, liquid of {} kg/m³ (specific gravity {})",
        lengths(2.0 * tank.radius_m),
        lengths(tank.depth_m),
        compact(1000.0 * tank.specific_gravity),
        compact(tank.specific_gravity)
    );
    let block_kg = BLOCK_OF_LIQUID * tank.mass_kg;
    let put = [
        ("{what}", what.replace("  (", " (")),
        ("{mass}", masses(tank.mass_kg)),
        ("{impulsive_ratio}", ratio(tank.impulsive_mass_kg)),
        ("{convective_ratio}", ratio(tank.convective_mass_kg)),
        ("{impulsive_height}", lengths(tank.impulsive_height_m)),
        ("{convective_height}", lengths(tank.convective_height_m)),
        ("{convective_period}", format!("{} s", significant(tank.convective_period_s, 5))),
        ("{block_mass}", format!("{} t", significant(block_kg / 1e3, 3))),
        ("{block_width}", length(2.0 * tank.radius_m + WIDER_M)),
        ("{liquid}", mass(tank.mass_kg)),
        ("{impulsive_height_m}", length(tank.impulsive_height_m)),
        ("{convective_height_m}", length(tank.convective_height_m)),
        ("{impulsive_mass}", mass(tank.impulsive_mass_kg)),
        ("{convective_mass}", mass(tank.convective_mass_kg)),
        ("{impulsive_shape}", shape(tank.impulsive_mass_kg)),
        ("{convective_shape}", shape(tank.convective_mass_kg)),
    ];
    put.iter().fold(MODEL.to_owned(), |text, (name, value)| text.replace(name, value))
}
