//! Lines with placeholders `{PATH :FORMAT}`, and how a value is printed.
//!
//! | format | prints |
//! |---|---|
//! | `.3` | three decimals |
//! | `.1e` | one decimal and a power of ten |
//! | `g3` | three significant digits, a power of ten below a thousandth |
//! | `number` | as `creepage verify` does |
//! | `s` | a text as it is |
//! | `pass` | pass or FAIL |
//!
//! `*1e-6` before it is a factor, `+` a sign on every number; null is a dash, a list its values with blanks between.

use serde_json::Value;

/// A text cut at its placeholders: what stands before each, its path and its format; and what follows the last.
type Cut<'a> = (Vec<(&'a str, &'a str, &'a str)>, &'a str);

fn cut(text: &str) -> Result<Cut<'_>, String> {
    let mut found = Vec::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('{') {
        let line = after.lines().next().unwrap_or_default();
        // quantities have colons of their own
        let placeholder = after.split_once('}').and_then(|(inside, after)| {
            let (path, format) = inside.rsplit_once(" :")?;
            Some(((before, path.trim(), format), after))
        });
        let (placeholder, after) =
            placeholder.ok_or_else(|| format!("{{{line} does not begin with {{PATH :FORMAT}}"))?;
        found.push(placeholder);
        rest = after;
    }
    Ok((found, rest))
}

/// The paths of a text's placeholders, in order.
pub fn paths(text: &str) -> Result<Vec<&str>, String> {
    Ok(cut(text)?.0.into_iter().map(|(_, path, _)| path).collect())
}

/// A text with its placeholders replaced by what `value` gives for their paths.
pub fn fill<'a>(
    text: &str,
    value: impl Fn(&str) -> Result<&'a Value, String>,
) -> Result<String, String> {
    let (placeholders, rest) = cut(text)?;
    let mut filled = String::new();
    for (before, path, format) in placeholders {
        let found = value(path)?;
        let printed = print(found, format)
            .ok_or_else(|| format!("{{{path} :{format}}} does not print {found}"))?;
        filled = filled + before + &printed;
    }
    Ok(filled + rest)
}

/// A value as its format says; none where the format is unknown or for other values.
fn print(value: &Value, format: &str) -> Option<String> {
    match value {
        Value::Null => Some("-".into()),
        Value::String(text) => (format == "s").then(|| text.clone()),
        Value::Bool(pass) => (format == "pass").then(|| if *pass { "pass" } else { "FAIL" }.into()),
        Value::Array(values) => {
            let printed: Option<Vec<String>> = values.iter().map(|v| print(v, format)).collect();
            Some(printed?.join(" "))
        }
        Value::Number(number) => {
            let (factor, format) = match format.strip_prefix('*') {
                Some(rest) => rest.split_once(' ')?,
                None => ("1", format),
            };
            let value = factor.parse::<f64>().ok()? * number.as_f64()?;
            let unsigned = format.strip_prefix('+');
            let sign = if unsigned.is_some() && value >= 0.0 { "+" } else { "" };
            Some(format!("{sign}{}", digits(value, unsigned.unwrap_or(format))?))
        }
        Value::Object(_) => None,
    }
}

fn digits(value: f64, format: &str) -> Option<String> {
    // minus nothing is nothing
    let value = if value == 0.0 { 0.0 } else { value };
    if let Some(digits) = format.strip_prefix('g') {
        return significant(value, digits.parse().ok().filter(|&digits| digits > 0)?);
    }
    if format == "number" {
        return Some(match value.abs() {
            0.0 => "0".into(),
            size if (1e-3..1e5).contains(&size) => format!("{value:.6}"),
            _ => format!("{value:.5e}"),
        });
    }
    let decimals = format.strip_prefix('.')?;
    Some(match decimals.strip_suffix('e') {
        Some(decimals) => format!("{value:.*e}", decimals.parse().ok()?),
        None => format!("{value:.*}", decimals.parse().ok()?),
    })
}

fn significant(value: f64, digits: usize) -> Option<String> {
    if value == 0.0 {
        return Some("0".into());
    }
    let scientific = format!("{value:.*e}", digits - 1);
    // the power after rounding: 9.996 has three digits before none behind the point
    let power: i32 = scientific.split_once('e')?.1.parse().ok()?;
    if power < -3 {
        return Some(scientific);
    }
    let decimals = usize::try_from(digits as i32 - 1 - power).unwrap_or(0);
    Some(format!("{value:.decimals$}"))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use serde_json::json;

    use super::*;

    #[test]
    fn values_are_printed_as_their_format_says() {
        for (value, format, wanted) in [
            (json!(0.26054), ".4", "0.2605"),
            (json!(797_211_496.1), "*1e-6 .0", "797"),
            (json!(4.2e-5), ".0e", "4e-5"),
            (json!(0.04), "*100 +.1", "+4.0"),
            (json!(-0.04), "*100 +.1", "-4.0"),
            (json!(0.002_81), "g3", "0.00281"),
            (json!(9.996), "g3", "10.0"),
            (json!(1234.6), "g3", "1235"),
            (json!(2.22e-7), "g3", "2.22e-7"),
            (json!(-0.0), "g3", "0"),
            (json!(0.0), "number", "0"),
            (json!(5169.670043), "number", "5169.670043"),
            (json!(4.961_67e10), "number", "4.96167e10"),
            (json!("settles"), "s", "settles"),
            (json!(false), "pass", "FAIL"),
            (Value::Null, ".2", "-"),
            (json!([-0.0198, 0.0013]), "*100 +.2", "-1.98 +0.13"),
        ] {
            assert_eq!(print(&value, format).as_deref(), Some(wanted), "{value} as {format}");
        }
        for (value, format) in
            [(json!("a"), ".2"), (json!(1.0), "s"), (json!(1.0), "g0"), (json!(1.0), "*x .2")]
        {
            assert_eq!(print(&value, format), None, "{value} as {format}");
        }
    }

    #[test]
    fn a_path_may_hold_colons_and_a_text_several_placeholders() {
        let text = "| {v > quantity=nu = 0: x (m) > error :.1e} | {a > x :.0} |";
        assert_eq!(paths(text).unwrap(), ["v > quantity=nu = 0: x (m) > error", "a > x"]);
        let one = json!(1.25);
        assert_eq!(fill(text, |_| Ok(&one)).unwrap(), "| 1.2e0 | 1 |");
        assert!(paths("{a}").is_err() && paths("{a :.2").is_err());
    }
}
