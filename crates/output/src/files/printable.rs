//! What a message quotes of a file: at most one line, and no control sequence of a terminal.

use std::ops::Range;

/// Longest line that is quoted, in characters after escaping.
const LONGEST_LINE: usize = 300;

/// `text` with control characters, line ends and invisible characters (such as marks of writing direction)
/// escaped as in Rust; quotes and backslashes stay.
pub fn printable(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '"' | '\'' | '\\' => shown.push(c),
            c => shown.extend(c.escape_debug()),
        }
    }
    shown
}

/// A line of a text as a message quotes it, with a part of it to be pointed at.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Line {
    /// Its number, counted from 1.
    pub number: usize,
    /// The line as [`printable`] escapes it, with four spaces for each tab.
    pub text: String,
    /// The part to point at (byte range in `text`).
    pub span: Range<usize>,
}

/// The line of `text` in which the byte range `span` begins, pointing at the part of the span in that line. A
/// span beyond the end or within a character is moved to the character before. `None` if the line is longer
/// than 300 characters as quoted.
pub fn line_of(text: &str, span: Range<usize>) -> Option<Line> {
    let boundary = |at: usize| (0..=at).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0);
    let start = boundary(span.start.min(text.len()));
    let begin = text[..start].rfind('\n').map_or(0, |at| at + 1);
    let end = text[start..].find('\n').map_or(text.len(), |at| start + at);
    let end = if text[start..end].ends_with('\r') { end - 1 } else { end };
    let stop = boundary(span.end.clamp(start, end));
    let [before, marked, after] = [begin..start, start..stop.max(start), stop.max(start)..end]
        .map(|part| printable(&text[part].replace('\t', "    ")));
    let span = before.len()..before.len() + marked.len();
    let line = before + &marked + &after;
    let number = text[..begin].matches('\n').count() + 1;
    (line.chars().count() <= LONGEST_LINE).then_some(Line { number, text: line, span })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_that_a_terminal_obeys_is_left() {
        let text = "a\x1b[31m\"b\"\n\x07\u{9b}\u{202e}\\é";
        let shown = printable(text);
        assert_eq!(shown, "a\\u{1b}[31m\"b\"\\n\\u{7}\\u{9b}\\u{202e}\\é");
        assert!(!shown.chars().any(char::is_control));
    }

    #[test]
    fn one_line_is_shown_with_its_number_and_the_place_in_it() {
        let text = "one = 1\r\nt\two = \x1b2\r\nthree = 3\r\n";
        let at = text.find("\x1b2").unwrap();
        let line = line_of(text, at..text.len()).unwrap();
        assert_eq!((line.number, line.text.as_str()), (2, "t    wo = \\u{1b}2"));
        assert_eq!(&line.text[line.span], "\\u{1b}2");
        // the end of a text, an end within a character, a span behind the end
        for span in [0..0, 7..7, text.len()..text.len(), 500..600] {
            assert!(!line_of(text, span).unwrap().text.contains(char::is_control));
        }
        assert_eq!(line_of("é = 1", 1..1).unwrap().span, 0..0);
        assert_eq!(line_of(&"a".repeat(301), 0..1), None);
    }
}
