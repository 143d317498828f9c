//! `slipstick record info`: what is understood of records.

use std::process::ExitCode;

use slipstick_files::{Wanted, channels, open_record};
use slipstick_report::records::{ChannelInfo, info_json, info_table};

use super::{Many, read_options};
use crate::failure::{Failure, print};
use crate::record_args::InfoArgs;

/// Prints a table, or a JSON array with one object a channel.
pub fn info(args: &InfoArgs) -> Result<ExitCode, Failure> {
    let options = read_options(&args.read)?;
    let mut many = Many::find(&args.files)?;
    let mut infos = Vec::new();
    many.each(|path| {
        let record = open_record(path, &options)?;
        let chosen = channels(path, &record, options.channel.as_deref(), Wanted::Any)?;
        let name = path.display().to_string();
        infos.extend(chosen.into_iter().map(|channel| ChannelInfo::new(&name, &record, channel)));
        Ok(())
    })?;
    if args.json {
        print(&info_json(&infos))?;
    } else if !infos.is_empty() {
        print(&info_table(&infos, args.display_units))?;
    }
    Ok(many.status())
}
