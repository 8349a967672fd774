//! The two streams of the terminal.
//!
//! Messages on standard error are a convenience: where nobody can read them any more, the work goes on. Standard output
//! is what was asked for: what it cannot take is an error, which the program tells at its end.

use std::io::{self, ErrorKind, Write};
use std::sync::OnceLock;

/// Standard error, which drops what it cannot take: a reader that is gone, a full disk below a log.
pub struct Messages;

impl Write for Messages {
    fn write(&mut self, text: &[u8]) -> io::Result<usize> {
        let _ = io::stderr().write_all(text);
        Ok(text.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        let _ = io::stderr().flush();
        Ok(())
    }
}

/// Writes a line on standard error.
pub fn message(line: &str) {
    // `Messages` never fails
    let _ = writeln!(Messages, "{line}");
}

/// The first failure of standard output. A command that has much to print goes on, so that its exit code and its files
/// are those of its work.
static FAILURE: OnceLock<io::Error> = OnceLock::new();

/// Writes on standard output.
pub fn print(text: &[u8]) {
    let mut out = io::stdout().lock();
    note(out.write_all(text).and_then(|()| out.flush()));
}

/// Keeps the first failure of standard output. A reader that closed the pipe wants no more, which is none.
pub fn note(written: io::Result<()>) {
    if let Err(error) = written
        && error.kind() != ErrorKind::BrokenPipe
    {
        FAILURE.get_or_init(|| error);
    }
}

/// Why standard output did not take all that was printed, where it did not.
pub fn failure() -> Option<&'static io::Error> {
    FAILURE.get()
}
