//! Results in, text out: the JSON summary, the plain-text table, SVG figures and the HTML report.
//!
//! Nothing here opens a file, reads a clock or prints. The same inputs give the same text, byte for
//! byte, on every machine. Whatever a user typed (names, paths, model text) is escaped on its way
//! into HTML and SVG by the types in [`markup`]: only text of this crate can be markup.
//!
//! ```
//! use slipstick::slider::Friction;
//! use slipstick::{check::check, model::Model, motion::GroundMotion, solver};
//! use slipstick_report::{DisplayUnits, Summary, SummaryInputs, table::table};
//!
//! let friction = Friction::new(0.3, 0.2)?;
//! let model = Model::rigid_block(124.0, friction)?;
//! let motion = GroundMotion::evenly_spaced(0.5, vec![0.0, 4.0, -4.0, 0.0, 0.0], None)?;
//! let response = solver::exact(&model, &motion)?;
//! let certificate = check(&model, &motion, &response);
//! let summary = Summary::new(&SummaryInputs {
//!     name: "Block",
//!     model: &model,
//!     motion: &motion,
//!     record: motion.figures(),
//!     response: &response,
//!     certificate: Some(&certificate),
//!     friction_factor: 1.0,
//!     warnings: &[],
//! });
//! let text = table(&summary, &model, "5 values, 0.5 s, m/s²", DisplayUnits::Si);
//! assert!(text.contains("Peak block acceleration"));
//! assert!(summary.to_json().contains("\"peak_sliding_displacement_m\": "));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! ```text
//! Model, GroundMotion, Response, Certificate ──> Summary ──> to_json()
//!                                                   │──────> table::table(…)
//!                                                   └─ Report ──> Report::to_html(), figures::all(…)
//! ```

// For `view!`, whose derived code has one path in every crate.
extern crate self as slipstick_report;

pub mod assessment;
pub mod describe;
pub mod display;
pub mod examples;
pub mod figures;
pub(crate) mod floors;
pub mod html;
pub mod json;
pub mod laboratory;
pub mod legend;
pub mod markup;
pub mod number;
pub mod opensees;
pub mod peaks;
pub mod plot;
pub mod records;
pub mod report;
pub mod structure;
pub mod study;
pub mod summary;
pub mod table;
pub mod tables;

/// Version of this program, as every answer states it.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

pub use display::DisplayUnits;
pub use laboratory::CompareReport;
pub use report::{FileNote, InputText, Report};
pub use summary::{Summary, SummaryInputs};
