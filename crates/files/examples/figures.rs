//! Draws the figures of the README and the manual from `examples/taft.toml`.
//!
//! Run from the root of the repository: `cargo xtask figures`.

use std::error::Error;
use std::path::Path;

use slipstick::input;
use slipstick_files::{OpenJob, read_bytes, write_whole};
use slipstick_report::{DisplayUnits, Report, figures};

/// Figures that the README and the manual show.
const SHOWN: [&str; 4] = ["sliding-displacement", "accelerations", "hysteresis", "floor-spectra"];

fn main() -> Result<(), Box<dyn Error>> {
    let path = Path::new("examples/taft.toml");
    let analysis = input::from_bytes(&path.display().to_string(), &read_bytes(path)?, &[])?;
    let open = OpenJob::new(path, analysis, None)?;
    let (outcome, summary) = open.run(true)?;
    let (job, nominal) = (&open.job, &outcome.nominal);
    let report = Report {
        summary: &summary,
        model: &job.analysis.model,
        motion: &job.motion,
        record: "",
        response: &nominal.response,
        certificate: &nominal.certificate,
        bounds: None,
        floor_spectra: summary.floor_spectra.as_ref(),
        inputs: &[],
        files: &[],
        command_line: "",
        display: DisplayUnits::Si,
    };
    for figure in figures::all(&report).into_iter().filter(|f| SHOWN.contains(&f.id.as_str())) {
        let name = format!("book/src/figures/taft-{}.svg", figure.id);
        write_whole(Path::new(&name), figure.svg.as_str().as_bytes())?;
        println!("{name}");
    }
    Ok(())
}
