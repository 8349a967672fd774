//! The rule for names: those of cases and of sweeps become folders.

/// Most bytes of a name.
const LONGEST: usize = 100;

/// What a name may be, for messages.
pub const REMEDY: &str = "use letters, digits, '-', '_', '+' and '.'";

/// Whether a character may stand in a name.
pub fn may_hold(c: char) -> bool {
    c.is_alphanumeric() || "-_. +".contains(c)
}

/// Why a name cannot be that of a folder inside another one, if it cannot.
pub fn refused(name: &str) -> Option<String> {
    let fine = !name.trim_matches(['.', ' ']).is_empty()
        && name.len() <= LONGEST
        && name.chars().all(may_hold);
    (!fine).then(|| format!("name = {name:?} cannot name a folder"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_stays_in_its_folder() {
        for fine in ["kt", "kt 2.5e+3", "b-falling", ".hidden", "Öl"] {
            assert_eq!(refused(fine), None, "{fine}");
        }
        for bad in ["", ".", "..", ". .", "../up", "a/b", "a\\b", "a\nb", "a\0", &"a".repeat(101)] {
            assert!(refused(bad).is_some(), "{bad:?}");
        }
    }
}
