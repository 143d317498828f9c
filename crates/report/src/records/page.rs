//! A record on a page to read and print.

use super::ChannelInfo;
use super::info::shown;
use crate::VERSION;
use crate::display::DisplayUnits;
use crate::figures::Drawn;
use crate::html::{Frame, document, warning_list};
use crate::markup::Markup;
use crate::number::typeset;

/// One self-contained page: what the channel is, its measures, its figures.
#[must_use]
pub fn page(
    channels: &[(ChannelInfo, Vec<Drawn>)],
    display: DisplayUnits,
    command: &str,
) -> String {
    let first = channels.first().map_or("", |(info, _)| info.file.as_str());
    let one_file = channels.iter().all(|(info, _)| info.file == first);
    let mut body = Markup::new();
    for (info, figures) in channels {
        channel(&mut body, info, figures, one_file, display);
    }
    document(&Frame {
        kind: "Ground motion",
        name: if one_file { first } else { "Ground motions" },
        title: &[],
        line: &format!("Slipstick {VERSION}"),
        command_line: command,
        body: &body,
    })
}

fn channel(
    out: &mut Markup,
    info: &ChannelInfo,
    figures: &[Drawn],
    one_file: bool,
    display: DisplayUnits,
) {
    let channel = format!("Channel {}", info.channel);
    let head = if one_file { channel } else { format!("{}: {channel}", info.file) };
    out.raw("<section class=\"figures\">\n").element("h2", head);
    let dt = info.dt_s.map_or("uneven samples".to_owned(), |dt_s| format!("{dt_s} s"));
    out.raw("\n<p>").text(format!("{}, {} values, {dt}, {}.", info.layout, info.npts, info.units));
    for (name, value) in
        [("Event", &info.event), ("Station", &info.station), ("Component", &info.component)]
    {
        if let Some(value) = value {
            out.text(format!(" {name}: {value}."));
        }
    }
    out.raw("</p>\n");
    let notices: Vec<_> = info.warnings.iter().map(|notice| (None, notice)).collect();
    warning_list(out, &notices, display);
    if let Some((set, _)) = &info.measures {
        out.raw("<table>\n<tbody>\n");
        let columns = set.columns();
        for pair in columns.chunks(2) {
            out.raw("<tr>");
            for (measure, _, si) in pair {
                let (value, unit) = shown(measure, *si, display);
                out.raw("<th scope=\"row\">")
                    .text(measure)
                    .raw("</th><td class=\"number\">")
                    .text(format!("{} {unit}", typeset(&value)))
                    .raw("</td>");
            }
            out.raw("</tr>\n");
        }
        out.raw("</tbody>\n</table>\n");
    }
    for figure in figures {
        out.raw("<figure>\n<div>\n").append(figure.svg.markup()).raw("</div>\n<figcaption>");
        out.text(&figure.caption).raw("</figcaption>\n</figure>\n");
    }
    out.raw("</section>\n");
}
