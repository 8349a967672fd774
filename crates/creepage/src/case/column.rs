//! The units that the headings of a table's columns name.

use crate::case::quantity::{is_unit, size_of};

/// What one of the unit that a heading names is in `unit`; 1 where it names none.
///
/// A unit stands in brackets at the end (`slip (mm/s)`), or is the last word or the end of a name (`slip mm/s`, `slip_mm_s`).
///
/// # Errors
/// What stands in brackets, or a unit of another kind, that is none of `unit`.
pub(crate) fn unit_size(heading: &str, unit: &str) -> Result<f64, String> {
    let size = |written: &str| {
        let is_none = written.is_empty() || written == unit || (unit == "-" && written == "1");
        if is_none { Some(1.0) } else { size_of(written, unit) }
    };
    if let Some((name, written)) = in_brackets(heading) {
        let written = plain(written);
        // mu(s) is a function, mu (s) a coefficient in seconds
        let function = unit == "-" && name.ends_with(char::is_alphanumeric);
        return match size(&written) {
            Some(size) => Ok(size),
            None if function && !is_unit(&written) => Ok(1.0),
            None if function && written.chars().all(char::is_alphabetic) => Ok(1.0),
            None => Err(written),
        };
    }
    let heading = plain(heading);
    let word = heading.rsplit([' ', '_']).next().unwrap_or_default();
    let parts: Vec<&str> = heading.rsplitn(3, '_').collect();
    let ratio = match parts[..] {
        [below, above, _] => format!("{above}/{below}"),
        _ => String::new(),
    };
    let ends = [ratio.as_str(), word].into_iter().filter(|end| end.len() < heading.len());
    // a single letter is a symbol, such as s of the slip velocity, and min a minimum
    let named = ends.filter(|end| *end == "%" || (end.chars().count() > 1 && *end != "min"));
    match named.into_iter().find(|end| is_unit(end)) {
        Some(end) => size(end).ok_or_else(|| end.to_owned()),
        None => Ok(1.0),
    }
}

/// What stands before and in the brackets with which a heading ends.
fn in_brackets(heading: &str) -> Option<(&str, &str)> {
    let brackets = [('(', ')'), ('[', ']')];
    let (open, close) = brackets.into_iter().find(|(_, close)| heading.ends_with(*close))?;
    let (name, rest) = heading.rsplit_once(open)?;
    Some((name, rest.trim_end_matches(close).trim()))
}

/// A text with units as the table of units writes them.
fn plain(text: &str) -> String {
    text.replace('\u{3bc}', "\u{b5}").replace(" per ", "/").replace("_per_", "/").trim().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_heading_names_its_unit_in_brackets_or_as_its_last_word() {
        for (heading, unit, wanted) in [
            ("slip (m/s)", "m/s", 1.0),
            ("slip (mm/s)", "m/s", 1e-3),
            ("slip [\u{3bc}m/s]", "m/s", 1e-6),
            ("slip velocity in km/h", "m/s", 1.0 / 3.6),
            ("slip_mm_s", "m/s", 1e-3),
            ("slip_mm_per_s", "m/s", 1e-3),
            ("slip mm per s", "m/s", 1e-3),
            ("s", "m/s", 1.0),
            ("slip velocity", "m/s", 1.0),
            ("slip_min", "m/s", 1.0),
            ("mu (-)", "-", 1.0),
            ("mu (%)", "-", 1e-2),
            ("friction %", "-", 1e-2),
            ("mu_percent", "-", 1e-2),
            ("mu(s)", "-", 1.0),
            ("mu(|s|)", "-", 1.0),
        ] {
            assert_eq!(unit_size(heading, unit), Ok(wanted), "{heading}");
        }
    }

    #[test]
    fn a_unit_of_another_kind_or_unknown_is_told_by_its_name() {
        for (heading, unit, told) in [
            ("slip (mm)", "m/s", "mm"),
            ("slip mm", "m/s", "mm"),
            ("slip (furlong/day)", "m/s", "furlong/day"),
            ("slip (%)", "m/s", "%"),
            ("shear (MPa)", "-", "MPa"),
            ("mu (s)", "-", "s"),
            ("slip(mm/s)", "-", "mm/s"),
            ("slip velocity m/s", "-", "m/s"),
        ] {
            assert_eq!(unit_size(heading, unit), Err(told.to_owned()), "{heading}");
        }
    }
}
