//! The one line of a text that a message shows.

use miette::{MietteError, MietteSpanContents, SourceCode, SourceSpan, SpanContents};
use output::files::Line;

/// A line of a file: a message has no more of it to show.
#[derive(Clone, Debug)]
pub struct Excerpt {
    name: String,
    line: Line,
}

impl Excerpt {
    /// The line of `text` in which `span` (bytes of `text`) begins, and the part of that line to point at (bytes
    /// of the line); none where the line is too long to be shown. `name` is that of the text.
    pub fn of(name: &str, text: &str, span: std::ops::Range<usize>) -> Option<(Self, SourceSpan)> {
        let line = output::files::line_of(text, span)?;
        let at = SourceSpan::new(line.span.start.into(), line.span.len());
        Some((Self { name: output::files::printable(name), line }, at))
    }
}

impl SourceCode for Excerpt {
    /// The line whole, whatever is asked for.
    fn read_span<'a>(
        &'a self,
        _: &SourceSpan,
        _: usize,
        _: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let text = self.line.text.as_bytes();
        let whole = SourceSpan::new(0.into(), text.len());
        let (name, line) = (self.name.clone(), self.line.number - 1);
        let column = self.line.text[..self.line.span.start].chars().count();
        Ok(Box::new(MietteSpanContents::new_named(name, text, whole, line, column, 1)))
    }
}
