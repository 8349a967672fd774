//! A number with a unit behind it, as text: `"2 mm"`, `"140 km/h"`, `"50%"`. A case takes plain numbers in SI units, and a
//! refusal says which number such a text is.

use crate::case::key::{OF_A_HUNDRED, OF_SPEED};

/// Longest text that is looked at (bytes).
const LONGEST: usize = 40;

/// Units that people write, the unit of a key, and the size of the first in the second. More are in [`OF_SPEED`] and
/// [`OF_A_HUNDRED`].
const UNITS: &[(&str, &str, f64)] = &[
    ("km", "m", 1e3),
    ("cm", "m", 1e-2),
    ("mm", "m", 1e-3),
    ("um", "m", 1e-6),
    ("µm", "m", 1e-6),
    ("min", "s", 60.0),
    ("ms", "s", 1e-3),
    ("us", "s", 1e-6),
    ("µs", "s", 1e-6),
    ("ns", "s", 1e-9),
    ("cm/s", "m/s", 1e-2),
    ("mm/s", "m/s", 1e-3),
    ("um/s", "m/s", 1e-6),
    ("µm/s", "m/s", 1e-6),
    ("nm/s", "m/s", 1e-9),
    ("kN", "N", 1e3),
    ("MN", "N", 1e6),
    ("Nm", "N m", 1.0),
    ("kNm", "N m", 1e3),
    ("kN m", "N m", 1e3),
    ("kPa", "Pa", 1e3),
    ("MPa", "Pa", 1e6),
    ("GPa", "Pa", 1e9),
    ("N/mm^2", "Pa", 1e6),
    ("g/cm^3", "kg/m^3", 1e3),
    ("t/m^3", "kg/m^3", 1e3),
    ("g", "kg", 1e-3),
    ("t", "kg", 1e3),
    ("s", "min", 1.0 / 60.0),
    ("h", "min", 60.0),
    ("%", "-", 1e-2),
    ("percent", "-", 1e-2),
    ("deg", "rad", std::f64::consts::PI / 180.0),
];

/// What a text is in `unit`, where it is a number with a unit of the same kind; rounded to ten digits, so that 2 mm is
/// 0.002.
pub(crate) fn in_unit(text: &str, unit: &str) -> Option<f64> {
    if text.len() > LONGEST {
        return None;
    }
    let mut splits = (0..=text.len()).rev().filter_map(|end| text.split_at_checked(end));
    let (x, written) =
        splits.find_map(|(x, written)| Some((x.trim().parse::<f64>().ok()?, written.trim())))?;
    let size = if [unit, ""].contains(&written) { 1.0 } else { size_of(written, unit)? };
    Some(x * size).filter(|x| x.is_finite()).map(rounded)
}

/// A number to ten digits.
pub(crate) fn rounded(x: f64) -> f64 {
    format!("{x:.9e}").parse().unwrap_or(x)
}

/// Whether a text is a unit that people write, or one of a key.
pub(crate) fn is_unit(text: &str) -> bool {
    let of_keys = UNITS.iter().map(|(_, of, _)| *of);
    let written = UNITS.iter().map(|(written, ..)| *written);
    let unnamed = OF_SPEED.iter().chain(OF_A_HUNDRED).map(|(written, _)| *written);
    of_keys.chain(written).chain(unnamed).any(|unit| unit == text)
}

/// The size of a unit in another.
pub(crate) fn size_of(written: &str, unit: &str) -> Option<f64> {
    let unnamed = match unit {
        "m/s" => OF_SPEED,
        "-" => OF_A_HUNDRED,
        _ => &[],
    };
    let named =
        UNITS.iter().filter(|(_, of, _)| *of == unit).map(|(other, _, size)| (*other, *size));
    named.chain(unnamed.iter().copied()).find(|(other, _)| *other == written).map(|(_, size)| size)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_with_a_unit_of_the_same_kind_is_the_number_in_the_unit_of_the_key() {
        for (text, unit, wanted) in [
            ("2mm", "m", 0.002),
            ("1e-3 m", "m", 1e-3),
            ("140 km/h", "m/s", 38.88888889),
            ("210 GPa", "Pa", 210e9),
            ("50%", "-", 0.5),
            ("2.4 per mille", "-", 2.4e-3),
            ("-3.5 µm", "m", -3.5e-6),
            ("0.3", "-", 0.3),
        ] {
            assert_eq!(in_unit(text, unit), Some(wanted), "{text}");
        }
    }

    #[test]
    fn other_texts_are_no_quantities() {
        for (text, unit) in [
            ("2 mm", "s"),
            ("mm", "m"),
            ("", "m"),
            ("2 furlongs", "m"),
            ("1e999 mm", "m"),
            ("nan m", "m"),
            ("0.3.1", "-"),
        ] {
            assert_eq!(in_unit(text, unit), None, "{text:?}");
        }
        let long = format!("2{}mm", " ".repeat(LONGEST));
        assert_eq!(in_unit(&long, "m"), None);
    }
}
