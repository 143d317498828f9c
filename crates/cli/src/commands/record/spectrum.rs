//! `slipstick record spectrum`: elastic response spectra and Fourier amplitudes.

use std::path::Path;
use std::process::ExitCode;

use slipstick::motion::intensity::rotated_spectra;
use slipstick::motion::{FourierSpectrum, GroundMotion, Spectrum, spectrum as elastic};
use slipstick::units::Dimension;
use slipstick_files::{FileError, FileNames, OutputFolder, Wanted, channels, open_record};
use slipstick_report::DisplayUnits;
use slipstick_report::plot;
use slipstick_report::records::{
    ChannelFourier, ChannelSpectrum, fourier_csv, spectra_csv, spectra_json, spectrum_figures,
};

use super::{Many, damping_ratios, read_options, refuse};
use crate::args::quantity;
use crate::failure::{Failure, print, say};
use crate::record_args::SpectrumArgs;

/// Most periods of one spectrum.
const MOST_PERIODS: usize = 100_000;

/// A file, its channel and the motion of that.
type ChannelMotion = (String, String, GroundMotion);

/// Prints spectra of every acceleration channel, or writes them with a figure each.
pub fn spectrum(args: &SpectrumArgs) -> Result<ExitCode, Failure> {
    let options = read_options(&args.read)?;
    let (periods_s, damping) = (periods(args)?, damping_ratios(&args.damping)?);
    let mut many = Many::find(&args.files)?;
    let mut folder =
        args.out.as_deref().map(|out| OutputFolder::create(out, &many.files)).transpose()?;
    let mut names = FileNames::default();
    let (mut spectra, mut fourier) = (Vec::new(), Vec::new());
    let mut pair: Vec<ChannelMotion> = Vec::new();
    many.each(|path| {
        let record = open_record(path, &options)?;
        let mut chosen = channels(path, &record, options.channel.as_deref(), Wanted::Acceleration)?;
        if let Some(second) = &args.second {
            chosen.extend(channels(path, &record, Some(second), Wanted::Acceleration)?);
        }
        for channel in &chosen {
            let at = |source| FileError::Motion { path: path.to_owned(), source };
            let Some(motion) = channel.motion() else { continue };
            let motion = motion.map_err(at)?;
            let (file, name) = (path.display().to_string(), channel.name.clone());
            if args.rotd {
                pair.push((file, name, motion));
                continue;
            }
            if args.fourier {
                let spectrum = FourierSpectrum::of(&motion, FourierSpectrum::USUAL_STEP_HZ);
                fourier.push(ChannelFourier { file, channel: name, spectrum });
                continue;
            }
            let (times_s, a) = (motion.times_s(), motion.horizontal_m_per_s2());
            let spectrum = elastic(times_s, a, &periods_s, &damping).map_err(at)?;
            if let Some(folder) = &mut folder {
                let named = (chosen.len() > 1).then_some(channel.name.as_str());
                let figure = names.name(Path::new(path), named, "svg");
                draw(folder, &figure.to_string_lossy(), &spectrum)?;
            }
            spectra.push(ChannelSpectrum { file, channel: name, spectrum });
        }
        Ok(())
    })?;
    if args.rotd {
        spectra = rotated(&pair, &periods_s, &damping)?;
        if let Some(folder) = &mut folder {
            for one in &spectra {
                draw(folder, &format!("{}.svg", one.channel), &one.spectrum)?;
            }
        }
    }
    let csv = if args.fourier { fourier_csv(&fourier) } else { spectra_csv(&spectra) };
    match folder {
        Some(mut folder) => {
            folder.write("spectrum.csv", csv.as_bytes())?;
            if args.json {
                folder.write("spectrum.json", spectra_json(&spectra).as_bytes())?;
            }
            let shown = folder.path("spectrum.csv");
            folder.commit()?;
            say(format_args!("wrote {}", shown.display()));
        }
        None if args.json => print(&spectra_json(&spectra))?,
        None => print(&csv)?,
    }
    Ok(many.status())
}

/// RotD50 and RotD100 of the two channels that were named.
fn rotated(
    pair: &[ChannelMotion],
    periods_s: &[f64],
    damping: &[f64],
) -> Result<Vec<ChannelSpectrum>, Failure> {
    let [(first, name, x), (second, other, y)] = pair else {
        let expected = "expected two channels of acceleration at right angles (two files, or \
                        --channel and --second)";
        return Err(refuse("--rotd", &format!("{expected}, found {}", pair.len())));
    };
    let both = rotated_spectra(x, y, periods_s, damping)
        .map_err(|source| FileError::Motion { path: first.into(), source })?;
    let file = match first == second {
        true => format!("{first} ({name}, {other})"),
        false => format!("{first}, {second}"),
    };
    let named = ["RotD50", "RotD100"].into_iter().zip(both);
    let one = |(name, spectrum): (&str, Spectrum)| ChannelSpectrum {
        file: file.clone(),
        channel: name.to_owned(),
        spectrum,
    };
    Ok(named.map(one).collect())
}

/// Writes the figure of a spectrum, if there is something to draw.
fn draw(folder: &mut OutputFolder, name: &str, spectrum: &Spectrum) -> Result<(), Failure> {
    let drawn: Vec<_> =
        spectrum_figures(spectrum, DisplayUnits::Si).into_iter().map(|d| d.svg).collect();
    if !drawn.is_empty() {
        folder.write(name, plot::column(&drawn).as_str().as_bytes())?;
    }
    Ok(())
}

/// The periods asked for, in s.
fn periods(args: &SpectrumArgs) -> Result<Vec<f64>, Failure> {
    if !args.period.is_empty() {
        let period = |text: &String| {
            let period_s = quantity("--period", text, Dimension::Time)?;
            let expected = || refuse("--period", &format!("expected a period ≥ 0, found {text:?}"));
            if period_s >= 0.0 { Ok(period_s) } else { Err(expected()) }
        };
        return args.period.iter().map(period).collect();
    }
    let from_s = quantity("--from", &args.from, Dimension::Time)?;
    let to_s = quantity("--to", &args.to, Dimension::Time)?;
    if !(0.0 < from_s && from_s < to_s) {
        return Err(refuse("--from", "expected two periods > 0, the shorter in --from"));
    }
    if !(2..=MOST_PERIODS).contains(&args.count) {
        return Err(refuse("--count", &format!("expected 2 to {MOST_PERIODS} periods")));
    }
    Ok(slipstick::motion::logarithmic_periods(from_s, to_s, args.count))
}
