//! `slipstick record plot`: a record as a figure or a page.

use std::process::ExitCode;

use slipstick::error::listed;
use slipstick::motion::{logarithmic_periods, spectrum};
use slipstick_files::{FileError, Wanted, channels, open_record, refuse_inputs, write_whole};
use slipstick_report::DisplayUnits;
use slipstick_report::plot;
use slipstick_report::records::{ChannelInfo, figures, page};

use super::{Many, damping_ratios, read_options};
use crate::failure::{Failure, say};
use crate::record_args::PlotArgs;

/// Periods of the spectra.
const FROM_S: f64 = 0.02;
const TO_S: f64 = 10.0;
const COUNT: usize = 240;

/// Draws every acceleration channel asked for.
pub fn plot(args: &PlotArgs) -> Result<ExitCode, Failure> {
    let options = read_options(&args.read)?;
    let display: DisplayUnits = args.display_units;
    let damping = damping_ratios(&args.damping)?;
    let extension = args.out.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    let as_page = match extension.as_deref() {
        Some("svg") => false,
        Some("html" | "htm") => true,
        _ => {
            let out = args.out.display();
            return Err(Failure::Message(format!(
                "{out}: expected a name that ends in .svg or .html"
            )));
        }
    };
    let mut many = Many::find(&args.files)?;
    refuse_inputs(&args.out, &many.files)?;
    let periods_s = logarithmic_periods(FROM_S, TO_S, COUNT);
    let mut drawn = Vec::new();
    many.each(|path| {
        let record = open_record(path, &options)?;
        for channel in channels(path, &record, options.channel.as_deref(), Wanted::Acceleration)? {
            let at = |source| FileError::Motion { path: path.to_owned(), source };
            let Some(motion) = channel.motion() else { continue };
            let motion = motion.map_err(at)?;
            let (times_s, a) = (motion.times_s(), motion.horizontal_m_per_s2());
            let spectrum = spectrum(times_s, a, &periods_s, &damping).map_err(at)?;
            let info = ChannelInfo::new(&path.display().to_string(), &record, channel);
            drawn.push((info, figures(&motion, &spectrum, display)));
        }
        Ok(())
    })?;
    if drawn.is_empty() {
        return Ok(many.status());
    }
    let text = if as_page {
        page(&drawn, display, &crate::results::command_line())
    } else if let [(_, figures)] = &drawn[..] {
        let svgs: Vec<_> = figures.iter().map(|figure| figure.svg.clone()).collect();
        plot::column(&svgs).as_str().to_owned()
    } else {
        let names = drawn.iter().map(|(info, _)| format!("{:?}", info.channel));
        return Err(Failure::Message(format!(
            "{}: expected one channel for one figure: add --channel, or name a page that ends in \
             .html (channels: {})",
            args.out.display(),
            listed(names)
        )));
    };
    write_whole(&args.out, text.as_bytes())?;
    say(format_args!("wrote {}", args.out.display()));
    Ok(many.status())
}
