//! How deep the elements of an XML text are nested.
//!
//! `roxmltree` parses recursively and without a limit: a text of thousands of nested elements would overflow
//! the stack and abort the process.

/// Deepest nesting that is read. A VTU file has six levels: file, grid, piece, section, array, and information
/// about an array.
pub(super) const DEEPEST: usize = 32;

/// The line, counted from 1, of the first element at a depth of more than [`DEEPEST`]. `None` also for a text that
/// is not well-formed: the parser stops at the mistake.
pub(super) fn too_deep(text: &str) -> Option<usize> {
    let mut depth = 0_usize;
    let mut at = 0;
    while let Some(found) = text[at..].find('<') {
        let start = at + found;
        let tag = &text[start..];
        at = start
            + if tag.starts_with("<!--") {
                behind(tag, "-->")?
            } else if tag.starts_with("<![CDATA[") {
                behind(tag, "]]>")?
            } else if tag.starts_with("<?") {
                behind(tag, "?>")?
            } else {
                let length = behind_tag(tag)?;
                if tag.starts_with("</") {
                    depth = depth.saturating_sub(1);
                } else if !tag.starts_with("<!") && !tag[..length].ends_with("/>") {
                    depth += 1;
                }
                length
            };
        if depth > DEEPEST {
            return Some(text[..start].matches('\n').count() + 1);
        }
    }
    None
}

/// Number of bytes up to and including `mark`.
fn behind(text: &str, mark: &str) -> Option<usize> {
    text.find(mark).map(|at| at + mark.len())
}

/// Length of a tag (bytes); a `>` within the quotes of an attribute does not end it.
fn behind_tag(tag: &str) -> Option<usize> {
    let mut quote = None;
    for (at, byte) in tag.bytes().enumerate() {
        match (quote, byte) {
            (None, b'>') => return Some(at + 1),
            (None, b'"' | b'\'') => quote = Some(byte),
            (Some(open), byte) if open == byte => quote = None,
            _ => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depth_is_that_of_open_elements_and_nothing_else_counts() {
        let nested = |n: usize| format!("{}{}", "<a>".repeat(n), "</a>".repeat(n));
        assert_eq!(too_deep(&nested(DEEPEST)), None);
        assert_eq!(too_deep(&format!("<?xml?>\n{}", nested(DEEPEST + 1))), Some(2));
        for flat in [
            "<a/>".repeat(100),
            "<a x='>' y=\"/>\"></a>".repeat(100),
            format!("<!--{}-->", "<a>".repeat(100)),
            format!("<![CDATA[{}]]>", "<a>".repeat(100)),
            "<?a <b> ?>".repeat(100),
        ] {
            assert_eq!(too_deep(&flat), None, "{flat}");
        }
        let quoted = "<a x='/>'>".repeat(DEEPEST + 1);
        assert_eq!(too_deep(&quoted), Some(1), "a slash in quotes closes no element");
    }
}
