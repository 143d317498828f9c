//! Results in, text out: the JSON summary, the plain-text table, SVG figures and the HTML report.
//!
//! Nothing here opens a file, reads a clock or prints. The same inputs give the same text, byte for
//! byte, on every machine. Whatever a user typed (names, paths, model text) is escaped on its way
//! into HTML and SVG by the types in [`markup`]: only text of this crate can be markup.
//!
//! ```text
//! Model, GroundMotion, Response, Certificate ──> Summary ──> to_json()
//!                                                   │──────> table::table(…)
//!                                                   └─ Report ──> Report::to_html(), figures::all(…)
//! ```

pub mod describe;
pub mod display;
pub mod figures;
pub mod html;
pub mod json;
pub mod markup;
pub mod number;
pub mod peaks;
pub mod plot;
pub mod report;
pub mod summary;
pub mod table;

pub use display::DisplayUnits;
pub use report::{FileNote, FloorSpectra, InputText, Report};
pub use summary::{RecordFigures, Summary, SummaryInputs};
