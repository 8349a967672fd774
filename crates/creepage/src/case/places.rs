//! Where the keys of a case were written, and errors that show the line.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

use output::files::printable;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::case::error::{Excerpt, KeyError};
use crate::case::file::CaseFile;
use crate::case::value::join;

/// Most characters of a message.
const LONGEST_MESSAGE: usize = 1000;

/// A text that keys came from.
#[derive(Clone, Debug)]
pub struct Source {
    /// The file; none for a `--set` option.
    pub file: Option<CaseFile>,
    /// What it holds.
    pub text: String,
}

impl Source {
    /// The text of a file.
    pub fn file(file: CaseFile, text: String) -> Self {
        Self { file: Some(file), text }
    }

    /// The text of an option.
    pub fn option(text: String) -> Self {
        Self { file: None, text }
    }

    fn name(&self) -> String {
        self.file.as_ref().map_or("--set".into(), CaseFile::to_string)
    }

    /// The error `message` about `key` at `span`, with the line of the text. For texts that are known to be TOML.
    pub fn error(&self, span: Range<usize>, key: &str, message: &str, remedy: &str) -> KeyError {
        let (source_code, at) = Excerpt::of(&self.name(), &self.text, span.clone()).unzip();
        KeyError { span: at, source_code, ..self.unquoted_error(span, key, message, remedy) }
    }

    /// The same without the line, for a text that may be that of any file that can be read.
    pub fn unquoted_error(
        &self,
        span: Range<usize>,
        key: &str,
        message: &str,
        remedy: &str,
    ) -> KeyError {
        let before = &self.text.as_bytes()[..span.start.min(self.text.len())];
        let line = before.iter().filter(|&&byte| byte == b'\n').count() + 1;
        let message = match self.file {
            Some(_) => format!("{}:{line}: {message}", self.name()),
            None if message.starts_with("--set") => message.into(),
            None => format!("--set: {message}"),
        };
        KeyError { label: "here".into(), ..placeless(message, key, remedy) }
    }
}

/// Where a key was written.
#[derive(Clone, Debug)]
pub struct Origin {
    /// Index into [`Places::sources`].
    pub source: usize,
    /// Bytes of the key in the text of its source.
    pub key: Range<usize>,
    /// Bytes of the value there.
    pub value: Range<usize>,
}

/// Where each key was written, by its dotted path with indices as `[i]`.
pub type Origins = BTreeMap<String, Origin>;

/// Where the keys of a case were written.
#[derive(Clone, Debug, Default)]
pub struct Places {
    /// Where each key was written.
    pub origins: Origins,
    /// The texts: the case file, those that it extends, one after the other, and then the options.
    pub sources: Vec<Source>,
}

impl Places {
    /// The text in which something was written.
    pub fn source(&self, origin: &Origin) -> &Source {
        &self.sources[origin.source]
    }

    /// The files on the disk that were read.
    pub fn files(&self) -> impl Iterator<Item = &PathBuf> {
        self.sources.iter().filter_map(|source| source.file.as_ref()?.on_disk())
    }

    /// The folder that the path in the value of `key` is relative to, and the same in words: that of the case file, or
    /// the working directory for an option.
    pub fn folder_of(&self, key: &str) -> (&Path, &'static str) {
        let file = self.origins.get(key).and_then(|at| self.source(at).file.as_ref());
        match file.and_then(CaseFile::on_disk) {
            Some(file) => (file.parent().unwrap_or(Path::new("")), "relative to this file"),
            None => (Path::new(""), "relative to the working directory"),
        }
    }

    /// How high the layer lies that gives `key`, if one does: the file that extends no other lies lowest, and of the
    /// options the last highest.
    pub(crate) fn height(&self, key: &str) -> Option<usize> {
        let files = self.sources.iter().filter(|source| source.file.is_some()).count();
        let source = self.origins.get(key)?.source;
        // a file is read before the one that it extends
        Some(if source < files { files - 1 - source } else { source })
    }

    /// The error `message`, a whole sentence, at the place where the value of `key` was written, if it was.
    pub fn error(&self, key: &str, message: &str, remedy: &str) -> KeyError {
        match self.origins.get(key) {
            Some(at) => self.source(at).error(at.value.clone(), key, message, remedy),
            None => self.error_nowhere(key, message, remedy),
        }
    }

    /// The error `message` about `key` at the place where the name of the key or section `named` was written, if it was.
    pub fn error_at_name(&self, named: &str, key: &str, message: &str, remedy: &str) -> KeyError {
        match self.origins.get(named) {
            Some(at) => self.source(at).error(at.key.clone(), key, message, remedy),
            None => self.error_nowhere(key, message, remedy),
        }
    }

    /// The error `message` about a key that is written nowhere: a default, or a missing key.
    pub fn error_nowhere(&self, key: &str, message: &str, remedy: &str) -> KeyError {
        // The case file itself is read first, before what it extends.
        let file = self.sources.first().map_or(String::new(), Source::name);
        placeless(format!("{file}: {message}"), key, remedy)
    }

    /// Forgets where a key and what is below it were written.
    pub(crate) fn forget(&mut self, path: &str) {
        let below = |at: &str| {
            let rest = at.strip_prefix(path);
            rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
        };
        // Only what begins with the path is looked at: a file may have very many keys.
        let begun = self.origins.range(path.to_owned()..).map(|(at, _)| at);
        let begun = begun.take_while(|at| at.starts_with(path));
        let gone: Vec<String> = begun.filter(|at| below(at)).cloned().collect();
        for at in gone {
            self.origins.remove(&at);
        }
    }
}

/// Where every key of a table, at any depth, was written in a source.
pub(crate) fn origins_of(table: &DeTable, source: usize) -> Origins {
    let mut origins = Origins::new();
    record_table(table, "", source, &mut origins);
    origins
}

fn record_table(table: &DeTable, prefix: &str, source: usize, origins: &mut Origins) {
    for (key, value) in table {
        record(&join(prefix, key.get_ref()), key.span(), value, source, origins);
    }
}

fn record(
    path: &str,
    key: Range<usize>,
    value: &Spanned<DeValue>,
    source: usize,
    origins: &mut Origins,
) {
    origins.insert(path.to_owned(), Origin { source, key: key.clone(), value: value.span() });
    match value.get_ref() {
        DeValue::Table(table) => record_table(table, path, source, origins),
        DeValue::Array(array) => {
            for (i, item) in array.iter().enumerate() {
                record(&format!("{path}[{i}]"), key.clone(), item, source, origins);
            }
        }
        _ => {}
    }
}

/// An error without a place, its message with printable characters alone, and no more than [`LONGEST_MESSAGE`] of them.
fn placeless(message: String, key: &str, remedy: &str) -> KeyError {
    let message = printable(&message);
    let message = match message.char_indices().nth(LONGEST_MESSAGE) {
        Some((end, _)) => format!("{}...", &message[..end]),
        None => message,
    };
    KeyError {
        message,
        key: key.into(),
        source_code: None,
        span: None,
        label: String::new(),
        help: Some(remedy.into()),
        others: Vec::new(),
    }
}
