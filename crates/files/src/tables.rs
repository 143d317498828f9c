//! `history.csv` and `events.csv`.

use std::io::{self, Write};

use slipstick::response::{Event, EventKind, History};

/// Writes the history: a header, then a row a sample with 17 significant digits, ended by LF.
///
/// Columns: time, table acceleration, sliding displacement (block minus table) and velocity, total
/// acceleration of the block, friction force of the table on the block; for each storey its
/// displacement and velocity relative to the block and its total acceleration. Units are in the
/// names.
///
/// # Errors
/// Those of the writer.
pub fn history_csv(history: &History, to: &mut impl Write) -> io::Result<()> {
    let mut header = "time_s,table_acceleration_m_per_s2,sliding_displacement_m,\
                      sliding_velocity_m_per_s,block_acceleration_m_per_s2,friction_force_n"
        .to_owned();
    for storey in 1..=history.storeys {
        for column in ["displacement_m", "velocity_m_per_s", "acceleration_m_per_s2"] {
            header.push_str(&format!(",storey{storey}_{column}"));
        }
    }
    writeln!(to, "{header}")?;
    for &knot in &history.rows {
        write!(to, "{:.16e}", history.time_s[knot])?;
        let columns = [
            &history.table_acceleration_m_per_s2,
            &history.sliding_displacement_m,
            &history.sliding_velocity_m_per_s,
            &history.block_acceleration_m_per_s2,
            &history.friction_force_n,
        ];
        for column in columns {
            write!(to, ",{:.16e}", column[knot])?;
        }
        let displacements = history.storey_displacements(knot);
        let velocities = history.storey_velocities(knot);
        let accelerations = history.storey_accelerations(knot);
        for ((q, v), a) in displacements.iter().zip(velocities).zip(accelerations) {
            write!(to, ",{q:.16e},{v:.16e},{a:.16e}")?;
        }
        writeln!(to)?;
    }
    Ok(())
}

/// Writes the events: `direction` is that of the sliding after it, 1 towards +x, −1 towards −x, 0
/// stuck.
///
/// # Errors
/// Those of the writer.
pub fn events_csv(events: &[Event], to: &mut impl Write) -> io::Result<()> {
    writeln!(to, "time_s,kind,direction,sliding_displacement_m")?;
    for event in events {
        let kind = match event.kind {
            EventKind::Slip => "slip",
            EventKind::Stick => "stick",
            EventKind::Reversal => "reversal",
        };
        let (time_s, direction) = (event.time_s, event.mode.sign());
        writeln!(to, "{time_s:.16e},{kind},{direction},{:.16e}", event.sliding_displacement_m)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use slipstick::friction::Direction;
    use slipstick::response::Mode;

    #[test]
    fn exact_history_has_its_rows_and_columns() {
        let history = History {
            storeys: 1,
            time_s: vec![0.0, 0.05, 0.1],
            mode: vec![Mode::Stick; 3],
            table_acceleration_m_per_s2: vec![1.0, 2.0, 3.0],
            sliding_displacement_m: vec![0.0, 0.0, -0.001],
            sliding_velocity_m_per_s: vec![0.0; 3],
            block_acceleration_m_per_s2: vec![1.0, 2.0, 1.0 / 3.0],
            friction_force_n: vec![10.0, 20.0, 30.0],
            storey_displacement_m: vec![0.1, 0.2, 0.3],
            storey_velocity_m_per_s: vec![1.0, 2.0, 3.0],
            storey_acceleration_m_per_s2: vec![4.0, 5.0, 6.0],
            rows: vec![0, 2],
        };
        let mut text = Vec::new();
        history_csv(&history, &mut text).unwrap();
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
    fn exact_events_have_direction_and_kind() {
        let event = |kind, mode| Event { time_s: 0.5, kind, mode, sliding_displacement_m: 0.25 };
        let events = [
            event(EventKind::Slip, Mode::Slip(Direction::Negative)),
            event(EventKind::Reversal, Mode::Slip(Direction::Positive)),
            event(EventKind::Stick, Mode::Stick),
        ];
        let mut text = Vec::new();
        events_csv(&events, &mut text).unwrap();
        assert_eq!(
            String::from_utf8(text).unwrap(),
            "time_s,kind,direction,sliding_displacement_m\n\
             5.0000000000000000e-1,slip,-1,2.5000000000000000e-1\n\
             5.0000000000000000e-1,reversal,1,2.5000000000000000e-1\n\
             5.0000000000000000e-1,stick,0,2.5000000000000000e-1\n"
        );
    }
}
