//! Tables as CSV; `history.csv` and `events.csv`.

use std::io::{self, Write};

use slipstick::response::{EventInPlane, Response};
use slipstick::table::{Cells, Column, Table, to_cell};

/// The table as CSV: a header, then rows ended by LF; numbers in the shortest digits that read back as
/// the same, `inf` for +∞.
#[must_use]
pub fn to_csv(table: &Table) -> String {
    let mut rows = csv::Writer::from_writer(Vec::new());
    // Rows of one length into a vector of bytes cannot fail.
    let _ =
        rows.write_record(table.columns.iter().map(|column| to_cell(&column.name).into_owned()));
    for row in 0..table.rows() {
        let cell = |column: &Column| match &column.cells {
            Cells::Texts(cells) => to_cell(&cells[row]).into_owned(),
            Cells::Numbers(cells) if cells[row].is_nan() => String::new(),
            // Adding 0 takes the sign off a zero.
            Cells::Numbers(cells) => format!("{:?}", cells[row] + 0.0),
            Cells::Counts(cells) => cells[row].map_or_else(String::new, |n| n.to_string()),
            Cells::Flags(cells) => cells[row].map_or_else(String::new, |f| f.to_string()),
        };
        let _ = rows.write_record(table.columns.iter().map(cell));
    }
    let bytes = rows.into_inner().unwrap_or_default();
    String::from_utf8(bytes).unwrap_or_default()
}

/// Writes the history: a header, then a row a sample with 17 significant digits, ended by LF.
///
/// The columns are those of [`Response::columns`].
///
/// # Errors
/// Those of the writer.
pub fn history_csv(response: &Response, to: &mut impl Write) -> io::Result<()> {
    let mut rows = csv::Writer::from_writer(to);
    let samples = response.history.as_ref().map_or(&[][..], |history| &history.rows);
    let columns = response.columns(samples);
    rows.write_record(columns.iter().map(|(name, _)| name)).map_err(of_file)?;
    for row in 0..samples.len() {
        let cells = columns.iter().map(|(_, values)| digits(values[row]));
        rows.write_record(cells).map_err(of_file)?;
    }
    rows.flush()
}

/// The error of the file itself, whose kind the messages know.
fn of_file(error: csv::Error) -> io::Error {
    match error.into_kind() {
        csv::ErrorKind::Io(error) => error,
        other => io::Error::other(format!("{other:?}")),
    }
}

/// 17 significant digits.
fn digits(value: f64) -> String {
    format!("{value:.16e}")
}

/// Writes the events: `direction` is that of the sliding after it, 1 towards +x, −1 towards −x, 0
/// stuck; `interface` is where it happened. In two horizontal directions the direction is a unit vector and
/// stands with the displacement along x and along y.
///
/// # Errors
/// Those of the writer.
pub fn events_csv(response: &Response, to: &mut impl Write) -> io::Result<()> {
    let mut rows = csv::Writer::from_writer(to);
    let in_plane = response.in_plane.as_ref();
    let header = ["time_s", "kind", "direction", "sliding_displacement_m", "interface"];
    let header: Vec<&str> = match in_plane {
        None => header.to_vec(),
        Some(_) => [
            &header[..3],
            &["direction_y"],
            &header[3..4],
            &["sliding_displacement_y_m"],
            &header[4..],
        ]
        .concat(),
    };
    rows.write_record(header).map_err(of_file)?;
    for (i, event) in response.events.iter().enumerate() {
        let mut row = vec![digits(event.time_s), event.kind.name().to_owned()];
        match in_plane.and_then(|plane| plane.events.get(i)) {
            None => {
                row.extend([event.mode.sign().to_string(), digits(event.sliding_displacement_m)])
            }
            Some(EventInPlane { direction: [x, y], sliding_displacement_y_m }) => row.extend(
                [*x, *y, event.sliding_displacement_m, *sliding_displacement_y_m].map(digits),
            ),
        }
        row.push(event.interface_name());
        rows.write_record(row).map_err(of_file)?;
    }
    rows.flush()
}

#[cfg(test)]
mod tests {
    use super::*;
    use slipstick::response::{Event, EventKind, History, Method, Mode};
    use slipstick::slider::Direction;

    fn response(events: Vec<Event>, history: Option<History>) -> Response {
        Response {
            method: Method::Exact,
            demands: Default::default(),
            events,
            history,
            contact_loss_s: Vec::new(),
            iterations: None,
            warnings: Vec::new(),
            in_plane: None,
        }
    }

    #[test]
    fn history_has_its_rows_and_columns() {
        let history = History {
            storeys: 1,
            interfaces: 1,
            time_s: vec![0.0, 0.05, 0.1],
            mode: vec![Mode::Stick; 3],
            contact: Vec::new(),
            table_acceleration_m_per_s2: vec![1.0, 2.0, 3.0],
            sliding_displacement_m: vec![0.0, 0.0, -0.001],
            sliding_velocity_m_per_s: vec![0.0; 3],
            block_acceleration_m_per_s2: vec![1.0, 2.0, 1.0 / 3.0],
            friction_force_n: vec![10.0, 20.0, 30.0],
            storey_displacement_m: vec![0.1, 0.2, 0.3],
            storey_velocity_m_per_s: vec![1.0, 2.0, 3.0],
            storey_acceleration_m_per_s2: vec![4.0, 5.0, 6.0],
            rows: vec![0, 2],
            ..History::default()
        };
        let mut text = Vec::new();
        history_csv(&response(Vec::new(), Some(history)), &mut text).unwrap();
        let text = String::from_utf8(text).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 3);
        assert_eq!(
            lines[0],
            "time_s,table_acceleration_m_per_s2,sliding_displacement_m,sliding_velocity_m_per_s,\
             block_acceleration_m_per_s2,friction_force_n,storey1_displacement_m,\
             storey1_velocity_m_per_s,storey1_acceleration_m_per_s2"
        );
        let cells: Vec<f64> = lines[2].split(',').map(|cell| cell.parse().unwrap()).collect();
        assert_eq!(cells, [0.1, 3.0, -0.001, 0.0, 1.0 / 3.0, 30.0, 0.3, 3.0, 6.0]);
        assert!(lines[2].contains(",3.3333333333333331e-1,"), "{}", lines[2]);
        assert!(text.ends_with('\n') && !text.contains('\r'));
    }

    #[test]
    fn events_have_direction_and_kind() {
        let event = |kind, mode| Event {
            time_s: 0.5,
            kind,
            mode,
            sliding_displacement_m: 0.25,
            interface: 0,
        };
        let events = [
            event(EventKind::Slip, Mode::Slip(Direction::Negative)),
            event(EventKind::Contact, Mode::Slip(Direction::Negative)),
            event(EventKind::Reversal, Mode::Slip(Direction::Positive)),
            event(EventKind::Separation, Mode::Slip(Direction::Positive)),
            event(EventKind::Press, Mode::Slip(Direction::Positive)),
            event(EventKind::Leave, Mode::Slip(Direction::Positive)),
            event(EventKind::Stick, Mode::Stick),
        ];
        let mut text = Vec::new();
        events_csv(&response(events.to_vec(), None), &mut text).unwrap();
        assert_eq!(
            String::from_utf8(text).unwrap(),
            "time_s,kind,direction,sliding_displacement_m,interface\n\
             5.0000000000000000e-1,slip,-1,2.5000000000000000e-1,slider\n\
             5.0000000000000000e-1,contact,-1,2.5000000000000000e-1,slider\n\
             5.0000000000000000e-1,reversal,1,2.5000000000000000e-1,slider\n\
             5.0000000000000000e-1,separation,1,2.5000000000000000e-1,slider\n\
             5.0000000000000000e-1,press,1,2.5000000000000000e-1,slider\n\
             5.0000000000000000e-1,leave,1,2.5000000000000000e-1,slider\n\
             5.0000000000000000e-1,stick,0,2.5000000000000000e-1,slider\n"
        );
    }
}
