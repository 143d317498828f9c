//! Example models, ready to run, and the model of a tank with sloshing liquid.

use slipstick::model::LiquidTank;

use crate::number::{compact, significant};

/// Every example by its name.
const EXAMPLES: [(&str, &str); 9] = [
    ("block", include_str!("../models/block.toml")),
    ("mock-up", include_str!("../models/mock-up.toml")),
    ("frame", include_str!("../models/frame.toml")),
    ("stop", include_str!("../models/stop.toml")),
    ("double-pendulum", include_str!("../models/double-pendulum.toml")),
    ("triple-pendulum", include_str!("../models/triple-pendulum.toml")),
    ("contents", include_str!("../models/contents.toml")),
    ("structure", include_str!("../models/structure.toml")),
    (TANK, MODEL),
];

const TANK: &str = "tank-sloshing";
const MODEL: &str = include_str!("../models/tank-sloshing.toml");

const POUND_KG: f64 = 0.453_592_37;
const FOOT_M: f64 = 0.3048;

/// Mass of slab and wall over that of the liquid, and how much wider the slab is than the liquid: assumed.
const BLOCK_OF_LIQUID: f64 = 0.16;
const WIDER_M: f64 = 1.0;

/// Names of the examples.
pub fn names() -> impl Iterator<Item = &'static str> {
    EXAMPLES.iter().map(|(name, _)| *name)
}

/// The model file of an example; that of the tank is 20 m wide, its liquid 8 m deep. `None` for another name.
///
/// ```
/// use slipstick_report::examples;
/// for name in examples::names() {
///     let text = examples::text(name).unwrap();
///     slipstick::input::parse(name, &text, &[]).unwrap();
/// }
/// ```
#[must_use]
pub fn text(name: &str) -> Option<String> {
    let (name, text) = EXAMPLES.iter().find(|(known, _)| *known == name)?;
    if *name != TANK {
        return Some((*text).to_owned());
    }
    LiquidTank::new(10.0, 8.0, 1.0).ok().map(|tank| of_tank(&tank))
}

/// The model file of a tank, with how its numbers come about.
#[must_use]
pub fn of_tank(tank: &LiquidTank) -> String {
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
        ("{wall_impulsive_height}", length(tank.wall_impulsive_height_m)),
        ("{wall_convective_height}", length(tank.wall_convective_height_m)),
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
