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

#[cfg(test)]
mod tests {
    use super::digits;

    #[test]
    fn numbers_stay_short() {
        assert_eq!(digits(-0.012_345, 3), "\u{2212}0.0123");
        assert_eq!(digits(1.5e-9, 2), "1.5e\u{2212}9");
        assert_eq!(digits(0.0, 3), "0");
    }
}
