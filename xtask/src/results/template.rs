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

/// A value to be printed.
#[derive(Clone, Debug, PartialEq)]
pub struct Placeholder {
    pub path: String,
    format: Format,
    /// Its place in the text, braces included.
    begin: usize,
    end: usize,
}

#[derive(Clone, Debug, PartialEq)]
struct Format {
    factor: f64,
    sign: bool,
    kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Fixed(usize),
    Scientific(usize),
    Significant(usize),
    Number,
    Text,
    Pass,
}

/// The placeholders of a text, in order.
pub fn placeholders(text: &str) -> Result<Vec<Placeholder>, String> {
    let mut found = Vec::new();
    let mut from = 0;
    while let Some(open) = text[from..].find('{') {
        let begin = from + open;
        let length = text[begin..].find('}').ok_or_else(|| {
            format!("a brace is not closed: {}", text[begin..].lines().next().unwrap_or_default())
        })?;
        let end = begin + length + 1;
        let inside = &text[begin + 1..end - 1];
        // quantities have colons of their own
        let (path, format) = inside
            .rsplit_once(" :")
            .ok_or_else(|| format!("{{{inside}}} is not {{PATH :FORMAT}}"))?;
        let format = read_format(format).ok_or_else(|| {
            format!(
                "{{{inside}}}: a format is .N, .Ne, gN, number, s or pass, perhaps after *FACTOR"
            )
        })?;
        found.push(Placeholder { path: path.trim().to_owned(), format, begin, end });
        from = end;
    }
    Ok(found)
}

fn read_format(text: &str) -> Option<Format> {
    let (factor, rest) = match text.strip_prefix('*') {
        Some(rest) => {
            let (factor, rest) = rest.split_once(' ')?;
            (factor.parse().ok()?, rest)
        }
        None => (1.0, text),
    };
    let (sign, kind) = rest.strip_prefix('+').map_or((false, rest), |kind| (true, kind));
    let kind = match kind {
        "number" => Kind::Number,
        "s" => Kind::Text,
        "pass" => Kind::Pass,
        _ => match (kind.strip_prefix('.'), kind.strip_prefix('g')) {
            (Some(digits), _) => match digits.strip_suffix('e') {
                Some(digits) => Kind::Scientific(digits.parse().ok()?),
                None => Kind::Fixed(digits.parse().ok()?),
            },
            (_, Some(digits)) => Kind::Significant(digits.parse().ok().filter(|&n| n > 0)?),
            _ => return None,
        },
    };
    Some(Format { factor, sign, kind })
}

/// A text with its placeholders replaced by what `value` gives for their paths.
pub fn fill(
    text: &str,
    placeholders: &[Placeholder],
    value: impl Fn(&str) -> Result<Value, String>,
) -> Result<String, String> {
    let mut filled = String::new();
    let mut from = 0;
    for placeholder in placeholders {
        filled.push_str(&text[from..placeholder.begin]);
        let found = value(&placeholder.path)?;
        let printed = print(&found, &placeholder.format)
            .ok_or_else(|| format!("{{{}}} cannot be printed so: {found}", placeholder.path))?;
        filled.push_str(&printed);
        from = placeholder.end;
    }
    filled.push_str(&text[from..]);
    Ok(filled)
}

fn print(value: &Value, format: &Format) -> Option<String> {
    match (value, format.kind) {
        (Value::Null, _) => Some("-".into()),
        (Value::String(text), Kind::Text) => Some(text.clone()),
        (Value::Bool(pass), Kind::Pass) => Some(if *pass { "pass" } else { "FAIL" }.into()),
        (Value::Array(values), _) => {
            let printed: Option<Vec<String>> =
                values.iter().map(|value| print(value, format)).collect();
            Some(printed?.join(" "))
        }
        (Value::Number(number), _) => {
            let value = format.factor * number.as_f64()?;
            let sign = if format.sign && value >= 0.0 { "+" } else { "" };
            Some(format!("{sign}{}", digits(value, format.kind)?))
        }
        _ => None,
    }
}

fn digits(value: f64, kind: Kind) -> Option<String> {
    // minus nothing is nothing
    let value = if value == 0.0 { 0.0 } else { value };
    Some(match kind {
        Kind::Fixed(decimals) => format!("{value:.decimals$}"),
        Kind::Scientific(decimals) => format!("{value:.decimals$e}"),
        Kind::Significant(digits) => significant(value, digits),
        Kind::Number if value == 0.0 => "0".into(),
        Kind::Number if (1e-3..1e5).contains(&value.abs()) => format!("{value:.6}"),
        Kind::Number => format!("{value:.5e}"),
        Kind::Text | Kind::Pass => return None,
    })
}

fn significant(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".into();
    }
    let scientific = format!("{value:.*e}", digits - 1);
    // the power after rounding: 9.996 has three digits before none behind the point
    let power = scientific.split_once('e').and_then(|(_, power)| power.parse::<i32>().ok());
    let power = power.unwrap_or_default();
    if power < -3 {
        return scientific;
    }
    let decimals = usize::try_from(digits as i32 - 1 - power).unwrap_or(0);
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use serde_json::json;

    use super::*;

    fn printed(value: Value, format: &str) -> String {
        let text = format!("{{a :{format}}}");
        fill(&text, &placeholders(&text).unwrap(), |_| Ok(value.clone())).unwrap()
    }

    #[test]
    fn values_are_printed_as_their_format_says() {
        for (value, format, wanted) in [
            (json!(0.26054), ".4", "0.2605"),
            (json!(797_211_496.1), "*1e-6 .0", "797"),
            (json!(4.2e-5), ".0e", "4e-5"),
            (json!(0.04), "*100 +.1", "+4.0"),
            (json!(-0.04), "*100 +.1", "-4.0"),
            (json!(0.002_81), "g3", "0.00281"),
            (json!(87.96), "g3", "88.0"),
            (json!(9.996), "g3", "10.0"),
            (json!(1234.6), "g3", "1235"),
            (json!(2.22e-7), "g3", "2.22e-7"),
            (json!(-0.0), "g3", "0"),
            (json!(0.0), "number", "0"),
            (json!(5169.670043), "number", "5169.670043"),
            (json!(4.961_67e10), "number", "4.96167e10"),
            (json!("settles"), "s", "settles"),
            (json!(true), "pass", "pass"),
            (json!(false), "pass", "FAIL"),
            (Value::Null, ".2", "-"),
            (json!([-0.0198, 0.0013]), "*100 +.2", "-1.98 +0.13"),
            (json!([]), ".2", ""),
        ] {
            assert_eq!(printed(value.clone(), format), wanted, "{value} as {format}");
        }
    }

    #[test]
    fn a_path_may_hold_colons_and_a_text_several_placeholders() {
        let text = "| {v > quantity=nu = 0: x (m) > error :.1e} | {a > x :.0} |";
        let found = placeholders(text).unwrap();
        let paths: Vec<_> = found.iter().map(|placeholder| placeholder.path.as_str()).collect();
        assert_eq!(paths, ["v > quantity=nu = 0: x (m) > error", "a > x"]);
        let one = json!(1.25);
        assert_eq!(fill(text, &found, |_| Ok(one.clone())).unwrap(), "| 1.2e0 | 1 |");
    }

    #[test]
    fn a_placeholder_that_cannot_be_read_is_refused() {
        for text in ["{a}", "{a :}", "{a :.x}", "{a :g0}", "{a :*x .2}", "{a :.2"] {
            assert!(placeholders(text).is_err(), "{text}");
        }
    }

    #[test]
    fn a_text_is_not_printed_as_a_number_nor_a_number_as_a_text() {
        for (value, format) in [(json!("a"), ".2"), (json!(1.0), "s"), (json!(["a"]), ".2")] {
            let text = format!("{{a :{format}}}");
            let error =
                fill(&text, &placeholders(&text).unwrap(), |_| Ok(value.clone())).unwrap_err();
            assert!(error.contains("cannot be printed so"), "{error}");
        }
    }
}
