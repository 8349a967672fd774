//! Tables in the documents stand between `<!-- results: NAME -->` and `<!-- end of results -->`, each on a
//! line of its own.

use crate::markdown::parse;

const BEGIN: &str = "<!-- results:";
const CLOSE: &str = "-->";
const END: &str = "<!-- end of results -->";

/// A pair of markers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Marked {
    pub name: String,
    /// Line of the first marker, from 1.
    pub begin: usize,
    /// Line of the second.
    pub end: usize,
}

/// The pairs of markers of a document, in order; a fault has its line.
pub fn find(text: &str) -> Result<Vec<Marked>, (usize, String)> {
    let mut found = Vec::new();
    let mut open: Option<(String, usize)> = None;
    // a marker in a block of code is an example
    for (line, prose) in parse(text).prose {
        let prose = prose.trim();
        if let Some(rest) = prose.strip_prefix(BEGIN) {
            let name = rest.strip_suffix(CLOSE).map(str::trim).unwrap_or_default();
            if name.is_empty() {
                return Err((line, format!("a marker is `{BEGIN} NAME {CLOSE}`")));
            }
            if let Some((before, _)) = open.replace((name.to_owned(), line)) {
                return Err((line, format!("the table `{before}` has no `{END}`")));
            }
        } else if prose == END {
            let Some((name, begin)) = open.take() else {
                return Err((line, format!("`{END}` without `{BEGIN} NAME {CLOSE}`")));
            };
            found.push(Marked { name, begin, end: line });
        }
    }
    match open {
        Some((name, line)) => Err((line, format!("the table `{name}` has no `{END}`"))),
        None => Ok(found),
    }
}

/// What stands between two markers.
pub fn between<'a>(text: &'a str, marked: &Marked) -> Vec<&'a str> {
    text.lines().skip(marked.begin).take(marked.end - marked.begin - 1).collect()
}

/// The document with other lines between two markers.
pub fn replace(text: &str, marked: &Marked, content: &str) -> String {
    let lines: Vec<&str> = text.lines().collect();
    let kept = [&lines[..marked.begin], &lines[marked.end - 1..]];
    let [before, after] = kept.map(|lines| lines.iter().map(|line| format!("{line}\n")).collect());
    let (before, after): (String, String) = (before, after);
    before + content + &after
}

/// The first line between two markers that is not that of `content`, with what stands there and what should.
pub fn first_difference(text: &str, marked: &Marked, content: &str) -> Option<(usize, String)> {
    let stands = between(text, marked);
    let should: Vec<&str> = content.lines().collect();
    let at = (0..stands.len().max(should.len())).find(|&i| stands.get(i) != should.get(i))?;
    let say = |line: Option<&&str>| line.map_or("nothing".to_owned(), |line| format!("`{line}`"));
    let problem =
        format!("{} stands where the results give {}", say(stands.get(at)), say(should.get(at)));
    Some((marked.begin + 1 + at, problem))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    const TEXT: &str = "# A\n<!-- results: a -->\n| 1 |\n| 2 |\n<!-- end of results -->\n\n```text\n\
                        <!-- results: example -->\n```\n<!-- results: b -->\n<!-- end of results -->\nend\n";

    #[test]
    fn markers_are_found_in_pairs_and_not_in_code() {
        let found = find(TEXT).unwrap();
        let wanted = [("a", 2, 5), ("b", 10, 11)];
        assert_eq!(found.len(), wanted.len());
        for (marked, (name, begin, end)) in found.iter().zip(wanted) {
            assert_eq!(*marked, Marked { name: name.into(), begin, end });
        }
    }

    #[test]
    fn a_marker_without_its_fellow_is_told_with_its_line() {
        for (text, line, problem) in [
            ("<!-- results: a -->\n", 1, "`a` has no"),
            ("\n<!-- end of results -->\n", 2, "without"),
            ("<!-- results: a -->\n<!-- results: b -->\n", 2, "`a` has no"),
            ("<!-- results: -->\n", 1, "NAME"),
        ] {
            let (found, said) = find(text).unwrap_err();
            assert!(found == line && said.contains(problem), "{text}: {found}: {said}");
        }
    }

    #[test]
    fn what_stands_between_is_replaced_and_nothing_else() {
        let first = &find(TEXT).unwrap()[0];
        let replaced = replace(TEXT, first, "| 3 |\n");
        assert_eq!(replaced, TEXT.replace("| 1 |\n| 2 |\n", "| 3 |\n"));
        let second = &find(&replaced).unwrap()[1];
        assert!(replace(&replaced, second, "x\n").contains("b -->\nx\n<!-- end"));
    }

    #[test]
    fn a_changed_digit_is_told_with_its_line() {
        let first = &find(TEXT).unwrap()[0];
        assert_eq!(first_difference(TEXT, first, "| 1 |\n| 2 |\n"), None);
        let (line, problem) = first_difference(TEXT, first, "| 1 |\n| 7 |\n").unwrap();
        assert_eq!((line, &*problem), (4, "`| 2 |` stands where the results give `| 7 |`"));
        let (line, problem) = first_difference(TEXT, first, "| 1 |\n").unwrap();
        assert_eq!((line, &*problem), (4, "`| 2 |` stands where the results give nothing"));
    }
}
