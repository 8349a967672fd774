//! Sets as meshio writes them to VTU: all sets of cells, or of points, as one array of their numbers, whose name
//! joins theirs.
//!
//! Source: meshio 5.3, `Mesh.cell_sets_to_data`, `Mesh.point_sets_to_data` and its writer of VTU. The value of a member
//! is the number of its set, counted from 0; -1 is for members of none.

/// What joins names: the first character that none of them holds.
const JOINTS: [char; 5] = ['-', '_', '#', '+', '/'];

/// What stands in place of a space.
const SPACES: [char; 6] = ['_', '-', '+', 'X', '/', '#'];

/// Longest name that is taken apart.
const LONGEST: usize = 1000;

/// The names of the sets of an array over points or over cells that is called `joined` and has these values, if it holds
/// sets in this way.
pub(super) fn names(joined: &str, values: &[i64], over_points: bool) -> Option<Vec<String>> {
    let count = usize::try_from(values.iter().max()?.checked_add(1)?).ok()?;
    if count == 0 || joined.len() > LONGEST || values.iter().any(|&value| value < -1) {
        return None;
    }
    let repeated = if over_points { around(joined, count) } else { None };
    repeated.or_else(|| once(joined, count))
}

/// The names that are joined to one.
fn once(joined: &str, count: usize) -> Option<Vec<String>> {
    let parts = |joint: &char| joined.split(*joint).map(str::to_owned).collect::<Vec<_>>();
    JOINTS.iter().map(parts).find(|names| sound(names, count))
}

/// The names of sets of points: meshio puts all names, joined to one, between each name and the next.
fn around(joined: &str, count: usize) -> Option<Vec<String>> {
    let gaps = count - 1;
    let names = joined.len().checked_sub(gaps.checked_mul(gaps)?)? / count;
    let length = names + gaps;
    let split = |first: usize| -> Option<Vec<String>> {
        let middle = joined.get(first..first + length)?;
        if !alike(middle.get(..first)?, &joined[..first]) {
            return None;
        }
        let names: Vec<String> = joined.split(middle).map(str::to_owned).collect();
        let whole = |joint: &char| alike(middle, &names.join(&joint.to_string()));
        (sound(&names, count) && JOINTS.iter().any(whole)).then_some(names)
    };
    (1..joined.len()).find_map(split)
}

fn sound(names: &[String], count: usize) -> bool {
    names.len() == count && names.iter().all(|name| !name.is_empty())
}

/// Whether a text is a name, maybe with something in place of its spaces.
fn alike(text: &str, name: &str) -> bool {
    let same = |(a, b): (char, char)| a == b || b == ' ' && SPACES.contains(&a);
    text.len() == name.len() && text.chars().zip(name.chars()).all(same)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joined_names_come_apart_into_as_many_as_the_values_number() {
        for (joined, over_points, last, expected) in [
            ("disk-bar", false, 1, &["disk", "bar"][..]),
            ("left-rail-head_tread", false, 1, &["left-rail-head", "tread"]),
            ("aa-bb", false, 1, &["aa", "bb"]),
            ("hub", true, 0, &["hub"]),
            ("hub-clamp", true, 1, &["hub", "clamp"]),
            ("hubhub-clampclamp", true, 1, &["hub", "clamp"]),
            ("aa-b-cba-b-cc", true, 2, &["a", "b", "c"]),
            ("rail toprail_top-hubhub", true, 1, &["rail top", "hub"]),
        ] {
            let found = names(joined, &[-1, last, 0], over_points).unwrap_or_default();
            assert_eq!(found, expected, "{joined}");
        }
    }

    #[test]
    fn numbers_that_are_none_of_joined_sets_give_no_names() {
        for (joined, values) in [
            ("MaterialIds", &[0, 1, 2][..]),
            ("a-b", &[-2, 1]),
            ("a-b", &[2, -1]),
            ("a-", &[0, 1]),
            ("a-b", &[-1]),
            ("a-b", &[]),
            ("a", &[i64::MAX]),
            ("a", &[1_000_000]),
        ] {
            assert_eq!(names(joined, values, true), None, "{joined} {values:?}");
        }
        assert_eq!(names(&"a".repeat(100_000), &[0, 1], true), None);
    }
}
