use proptest::prelude::*;

use super::*;

fn message(text: &str, dimension: Dimension) -> String {
    parse_quantity(text, dimension).unwrap_err().to_string()
}

/// The units' definitions: SI prefixes, the international pound, foot and inch, standard gravity.
#[test]
fn definitions_of_units() {
    use Dimension::*;
    for (text, dimension, si) in [
        ("325 kg", Mass, 325.0),
        ("2.5 t", Mass, 2500.0),
        ("1 lb", Mass, 0.45359237),
        ("1 lbf", Force, 4.4482216152605),
        ("1 kip", Force, 4448.2216152605),
        ("1.5 MN", Force, 1.5e6),
        ("5 mm", Length, 0.005),
        ("0.3mm", Length, 0.0003),
        ("0.53 m", Length, 0.53),
        ("1 in", Length, 0.0254),
        ("1 ft", Length, 0.3048),
        ("10 ms", Time, 0.01),
        ("2 min", Time, 120.0),
        ("1.625 Hz", Frequency, 1.625),
        ("6.283185307179586 rad/s", Frequency, 1.0),
        ("1 mrad", Angle, 0.001),
        ("180 deg", Angle, std::f64::consts::PI),
        ("30 cm/s", Velocity, 0.3),
        ("0.3 g", Acceleration, 0.3 * 9.80665),
        ("1g", Acceleration, 9.80665),
        ("9.81 m/s2", Acceleration, 9.81),
        ("9.81 m/s^2", Acceleration, 9.81),
        ("9.81 m/s²", Acceleration, 9.81),
        ("981 gal", Acceleration, 9.81),
        ("981 cm/s²", Acceleration, 9.81),
        ("143 kN/m", Stiffness, 143e3),
        ("0.143 kN/mm", Stiffness, 143e3),
        ("143 N/mm", Stiffness, 143e3),
        ("1 kip/in", Stiffness, 4448.2216152605 / 0.0254),
        ("250 N s/m", Damper, 250.0),
        ("2 kN·s/m", Damper, 2000.0),
        ("2 kN*s/m", Damper, 2000.0),
        ("2kN  s/m", Damper, 2000.0),
        ("-1e-3 m", Length, -0.001),
        ("+.5e1 m", Length, 5.0),
        ("5. m", Length, 5.0),
    ] {
        assert_eq!(parse_quantity(text, dimension), Ok(si), "{text}");
    }
}

#[test]
fn no_unit_name_stands_twice_and_grams_do_not_exist() {
    let names: Vec<_> = all().map(|(_, unit)| unit.name()).collect();
    let distinct: std::collections::BTreeSet<_> = names.iter().collect();
    assert_eq!(names.len(), distinct.len());
    assert_eq!(
        message("5 g", Dimension::Mass),
        "expected a mass, such as \"325 kg\", found an acceleration, \"5 g\""
    );
}

#[test]
fn messages_say_what_to_write() {
    let length = Dimension::Length;
    let with_unit = "expected a length with its unit, such as \"150 mm\", found";
    for text in ["150", "", "mm", "1_000 m", "−5 m", "--5 m", "NaN m", "inf m", "5 5 m"] {
        assert_eq!(message(text, length), format!("{with_unit} \"{text}\""));
    }
    let comma = "expected a decimal point, \"1.5 m\", found \"1,5 m\"";
    assert_eq!(message("1,5 m", length), comma);
    assert_eq!(
        message("5 mmm", length),
        "expected a unit of length (m, mm, cm, in, ft), found \"mmm\"; nearest is \"mm\""
    );
    assert_eq!(
        message("5 bananas", length),
        "expected a unit of length (m, mm, cm, in, ft), found \"bananas\""
    );
    assert_eq!(
        message("5 kg", length),
        "expected a length, such as \"150 mm\", found a mass, \"5 kg\""
    );
    assert_eq!(message("1e999 m", length), "expected a length that is finite, found \"1e999 m\"");
    assert_eq!(
        message("1e308 kN", Dimension::Force),
        "expected a force that is finite, found \"1e308 kN\""
    );
    assert_eq!(
        parse_unit("cms2", Dimension::Acceleration).unwrap_err().to_string(),
        "expected a unit of acceleration (m/s2, mm/s2, cm/s2, gal, g, in/s2, ft/s2), found \"cms2\"; \
         nearest is \"cm/s2\""
    );
    assert_eq!(parse_unit("cm/s²", Dimension::Acceleration).map(Unit::name), Ok("cm/s2"));
}

#[test]
fn table_prints_every_unit() {
    let table = table();
    for (dimension, unit) in all() {
        let line = table.lines().find(|line| line.starts_with(dimension.name())).unwrap();
        assert!(line.contains(unit.name()), "{line}");
    }
    assert!(table.lines().all(|line| line.chars().count() <= 110), "{table}");
}

#[test]
fn every_example_is_a_quantity_of_its_dimension() {
    for dimension in Dimension::ALL {
        assert!(parse_quantity(dimension.example(), dimension).is_ok(), "{dimension:?}");
        assert_eq!(dimension.units()[0].to_si(0.1), 0.1, "the first unit of {dimension:?} is SI");
    }
}

proptest! {
    #[test]
    fn prop_any_text_is_read_or_refused(text in "\\PC*") {
        for dimension in Dimension::ALL {
            let _ = parse_quantity(&text, dimension);
        }
    }

    /// The SI unit keeps the bits of the number.
    #[test]
    fn prop_si_units_keep_the_bits(value in proptest::num::f64::NORMAL) {
        for dimension in Dimension::ALL {
            let text = format!("{value:?} {}", dimension.si_unit());
            prop_assert_eq!(parse_quantity(&text, dimension), Ok(value));
        }
    }

    /// Decimal fractions are rounded once: dividing by 1000 is moving the point.
    #[test]
    fn prop_millimetres_move_the_point(digits in 0_u64..1_000_000_000_000) {
        let moved: f64 = format!("{digits}e-3").parse().unwrap();
        prop_assert_eq!(parse_quantity(&format!("{digits} mm"), Dimension::Length), Ok(moved));
    }
}
