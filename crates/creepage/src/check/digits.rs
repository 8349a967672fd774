//! Numbers as text for people.

/// `value` to `significant` digits, in scientific notation below 1e-3 and from 1e6 on.
pub(crate) fn digits(value: f64, significant: i32) -> String {
    let size = value.abs();
    let text = if size == 0.0 {
        "0".into()
    } else if (1e-3..1e6).contains(&size) {
        let decimals = (significant - 1 - libm::log10(size).floor() as i32).max(0) as usize;
        format!("{value:.decimals$}")
    } else {
        format!("{value:.*e}", (significant - 1).max(0) as usize)
    };
    text.replace('-', "\u{2212}")
}

/// `value` with as many significant digits as it has, at least three.
pub fn all_digits(value: f64) -> String {
    let texts = (3..10).map(|significant| digits(value, significant));
    let mut whole = texts.filter(|text| text.parse() == Ok(value));
    whole.next().unwrap_or_else(|| value.to_string())
}

#[cfg(test)]
mod tests {
    use super::{all_digits, digits};

    #[test]
    fn a_limit_keeps_the_digit_that_tells_it_from_one() {
        assert_eq!([0.8, 1.25, 0.999, 1.001].map(all_digits), ["0.800", "1.25", "0.999", "1.001"]);
    }

    #[test]
    fn numbers_stay_short() {
        assert_eq!(digits(-0.012_345, 3), "\u{2212}0.0123");
        assert_eq!(digits(1.5e-9, 2), "1.5e\u{2212}9");
        assert_eq!(digits(0.0, 3), "0");
    }
}
