//! Numbers and rows for people.

use std::fmt::Write;

/// Shown where there is no number.
const NONE: &str = "-";

/// A number with `significant` digits: plain where that is readable, with an exponent elsewhere.
pub fn digits(x: Option<f64>, significant: i32) -> String {
    let Some(x) = x.filter(|x| x.is_finite()) else {
        return NONE.into();
    };
    let size = x.abs();
    if size == 0.0 {
        "0".into()
    } else if (1e-3..1e7).contains(&size) {
        let decimals = (significant - 1 - libm::log10(size).floor() as i32).clamp(0, 9) as usize;
        if decimals == 0 { count(Some(x)) } else { format!("{x:.decimals$}") }
    } else {
        format!("{x:.*e}", (significant - 1).clamp(0, 9) as usize)
    }
}

/// A whole number with its thousands set apart.
pub fn count(x: Option<f64>) -> String {
    let Some(x) = x.filter(|x| x.is_finite()) else {
        return NONE.into();
    };
    let plain = format!("{:.0}", x.abs());
    let mut text = String::new();
    for (i, digit) in plain.chars().enumerate() {
        if i > 0 && (plain.len() - i) % 3 == 0 {
            text.push(' ');
        }
        text.push(digit);
    }
    if x < 0.0 && plain != "0" { format!("-{text}") } else { text }
}

/// Seconds as a person would say them.
pub fn duration(seconds: Option<f64>) -> String {
    let Some(s) = seconds.filter(|s| s.is_finite()) else {
        return NONE.into();
    };
    match s {
        s if s < 120.0 => format!("{} s", digits(Some(s), 3)),
        s if s < 7200.0 => format!("{:.0} min", s / 60.0),
        s if s < 172_800.0 => format!("{:.1} hours", s / 3600.0),
        s => format!("{:.1} days", s / 86400.0),
    }
}

/// Seconds as an estimate gives them, which another day may miss by a third: to one digit, or half of one.
pub fn about(seconds: Option<f64>) -> String {
    let Some(s) = seconds.filter(|s| s.is_finite()) else {
        return NONE.into();
    };
    let units = [(86400.0, "days"), (3600.0, "hours"), (60.0, "min"), (1.0, "s")];
    // the largest of which there are at least two
    let (unit, name) = units.into_iter().find(|(unit, _)| s >= 1.9 * unit).unwrap_or((1.0, "s"));
    let size = s / unit;
    let step = libm::pow(10.0, libm::log10(size).floor()) / if size < 10.0 { 1.0 } else { 2.0 };
    match (size / step).round() * step {
        _ if size < 0.5 => "less than 1 s".into(),
        rounded => format!("{} {name}", count(Some(rounded.max(1.0)))),
    }
}

/// Appends a heading, set off by an empty line.
pub fn heading(out: &mut String, title: &str) {
    let _ = writeln!(out, "\n{title}");
}

/// Appends a row: a label, a number, its unit, and a remark where there is one.
pub fn row(out: &mut String, label: &str, number: &str, unit: &str, remark: &str) {
    let line = format!("  {label:<24}{number:>12} {unit:<6} {remark}");
    let _ = writeln!(out, "{}", line.trim_end());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_estimate_has_the_digits_that_it_is_worth() {
        let said = |s| about(Some(s));
        assert_eq!([3.84, 6.1, 13.4, 74.0].map(said), ["4 s", "6 s", "15 s", "75 s"]);
        assert_eq!([0.2, 0.7, 119.0, 700.0].map(said), ["less than 1 s", "1 s", "2 min", "10 min"]);
        assert_eq!(
            [5e3, 9.9e3, 1.4e5, 3e6].map(said),
            ["85 min", "3 hours", "40 hours", "35 days"]
        );
        assert_eq!(about(None), "-");
    }

    #[test]
    fn digits_are_significant_and_never_nan() {
        let shown = |x| digits(Some(x), 4);
        assert_eq!(shown(1234.5678), "1 235");
        assert_eq!(shown(-0.012_345_6), "-0.01235");
        assert_eq!(shown(1.0), "1.000");
        assert_eq!(shown(3.3e-5), "3.300e-5");
        assert_eq!(shown(341_392.12), "341 392");
        assert_eq!(shown(0.0), "0");
        assert_eq!((shown(f64::NAN), digits(None, 4)), ("-".into(), "-".into()));
    }

    #[test]
    fn durations_are_told_in_the_unit_that_fits() {
        assert_eq!(duration(Some(6.3295)), "6.33 s");
        assert_eq!(duration(Some(600.0)), "10 min");
        assert_eq!(duration(Some(36_000.0)), "10.0 hours");
        assert_eq!(duration(Some(1e6)), "11.6 days");
    }
}
