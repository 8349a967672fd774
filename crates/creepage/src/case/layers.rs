//! A case file, the files that it extends and the `--set` options, laid over one another.
//!
//! Every key keeps the place where its value was written, so that a message about the merged
//! case can still show the line.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

use output::files::input::{self, Kind};
use output::files::printable;
use serde::Deserialize;
use toml::Spanned;
use toml::de::{DeTable, DeValue, Deserializer};
use toml::{Table, Value};

use crate::case::error::{CaseError, KeyError};
use crate::case::excerpt::Excerpt;
use crate::case::friction_law;
use crate::case::keys;
use friction::Declaration;

/// A chain of `extends` longer than this is taken for a mistake.
const LONGEST_CHAIN: usize = 16;

/// Most characters of a message.
const LONGEST_MESSAGE: usize = 1000;

/// The name of a source that is an option and no file.
const SET: &str = "--set";

/// A text that keys came from: a file, or one `--set` option.
#[derive(Clone, Debug)]
pub struct Source {
    /// Path of the file, or `--set`.
    pub name: String,
    /// What it holds.
    pub text: String,
}

/// Where a key was written.
#[derive(Clone, Debug)]
pub struct Origin {
    /// Index into [`Layers::sources`].
    pub source: usize,
    /// Bytes of the key in the text of its source.
    pub key: Range<usize>,
    /// Bytes of the value there.
    pub value: Range<usize>,
}

/// The merged keys, and where each was written.
#[derive(Clone, Debug, Default)]
pub struct Layers {
    /// The keys, the last layer on top.
    pub table: Table,
    /// Where each key was written, by its dotted path with indices as `[i]`.
    pub origins: BTreeMap<String, Origin>,
    /// The texts: the case file, those that it extends, one after the other, and then the options.
    pub sources: Vec<Source>,
}

impl Layers {
    /// Reads a case file with everything that it extends.
    ///
    /// # Errors
    /// A file that cannot be read, is not well-formed TOML, or extends itself.
    pub fn read(path: &Path) -> Result<Self, CaseError> {
        let mut layers = Self::default();
        layers.add_file(path, &mut Vec::new())?;
        Ok(layers)
    }

    /// Reads a case from a text, with everything that it extends. `path` names it; `extends` is relative to the
    /// folder of `path`.
    ///
    /// # Errors
    /// As those of [`Layers::read`].
    pub fn from_text(text: &str, path: &Path) -> Result<Self, CaseError> {
        let mut layers = Self::default();
        layers.add_text(text.to_owned(), path, &mut vec![path.to_path_buf()])?;
        Ok(layers)
    }

    fn add_file(&mut self, path: &Path, chain: &mut Vec<PathBuf>) -> Result<(), CaseError> {
        let text = read_text(path, input::CASE)?;
        chain.push(path.canonicalize().unwrap_or_else(|_| path.to_path_buf()));
        self.add_text(text, path, chain)
    }

    fn add_text(
        &mut self,
        text: String,
        path: &Path,
        chain: &mut Vec<PathBuf>,
    ) -> Result<(), CaseError> {
        let (mut table, mut origins) = self.parse(path.display().to_string(), text)?;
        let extends = table.remove("extends");
        if let Some(extends) = extends {
            let origin = origins.remove("extends");
            let Some(base) = extends.as_str() else {
                return Err(self.error(
                    origin.as_ref(),
                    "extends",
                    &format!("{extends} must be text in quotes"),
                    "give the path of another case file, relative to this one",
                ));
            };
            let base = path.parent().unwrap_or(Path::new("")).join(base);
            if base.canonicalize().is_ok_and(|base| chain.contains(&base)) {
                return Err(self.error(
                    origin.as_ref(),
                    "extends",
                    &format!("{extends} leads back to a file that extends this one"),
                    "end the chain of `extends` at a file that extends nothing",
                ));
            }
            if chain.len() >= LONGEST_CHAIN {
                return Err(self.error(
                    origin.as_ref(),
                    "extends",
                    &format!("{extends} would be file {} of a chain", chain.len() + 1),
                    &format!("a chain of `extends` may have {LONGEST_CHAIN} files: join some"),
                ));
            }
            self.add_file(&base, chain).map_err(|error| match error {
                CaseError::File { problem, remedy, .. } => self.error(
                    origin.as_ref(),
                    "extends",
                    &format!("{extends}: {}: {problem}", base.display()),
                    &format!("{remedy}; the path is taken relative to this file"),
                ),
                other => other,
            })?;
        }
        self.lay_over(table, origins);
        Ok(())
    }

    /// Lays one `--set KEY=VALUE` over everything before. A value that is no TOML is taken as a word.
    ///
    /// # Errors
    /// A text of another form.
    pub fn add_set(&mut self, set: &str) -> Result<(), CaseError> {
        let name = SET.to_owned();
        let refuse = |problem: &str, layers: &Self| {
            layers.error_in(
                Source { name: SET.into(), text: set.into() },
                0..set.len(),
                "",
                &format!("--set {set}: {problem}"),
                "write --set KEY=VALUE with a dotted key, for example --set mesh.zone.size=2e-3",
            )
        };
        let Some((key, value)) = set.split_once('=') else {
            return Err(refuse("there is no '='", self));
        };
        let (key, value) = (key.trim(), value.trim());
        let plain = |c: char| c.is_ascii_alphanumeric() || "_.-".contains(c);
        if key.is_empty() || !key.chars().all(plain) || key.split('.').any(str::is_empty) {
            return Err(refuse("the part before '=' is not a dotted key", self));
        }
        if key == "extends" {
            return Err(refuse("`extends` belongs in a file", self));
        }
        if value.is_empty() {
            return Err(refuse("there is no value after '='", self));
        }
        let is_value = |value: &str| {
            toml::from_str::<Table>(&format!("x = {value}")).is_ok_and(|table| table.len() == 1)
        };
        let text = if is_value(value) {
            format!("{key} = {value}")
        } else if value.chars().all(|c| plain(c) || "/ %^µ".contains(c)) {
            format!("{key} = \"{value}\"")
        } else {
            return Err(refuse("the part after '=' is neither a TOML value nor a word", self));
        };
        let (table, origins) = self.parse(name, text)?;
        self.lay_over(table, origins);
        Ok(())
    }

    /// The files that were read, and the file that `friction.table` names, if it names one.
    pub fn files(&self) -> Vec<PathBuf> {
        let sources = self.sources.iter().filter(|source| source.name != SET);
        let mut files: Vec<PathBuf> = sources.map(|source| PathBuf::from(&source.name)).collect();
        if let Some(table) = get(&self.table, "friction.table").and_then(Value::as_str) {
            let (folder, _) = self.paths_from(self.origins.get("friction.table"));
            files.push(folder.join(table));
        }
        files
    }

    /// The folder that a path written at `origin` is relative to, and the same in words: that of the case file, or
    /// the working directory for an option.
    pub fn paths_from(&self, origin: Option<&Origin>) -> (&Path, &'static str) {
        match origin.map(|origin| self.sources[origin.source].name.as_str()) {
            Some(file) if file != SET => {
                (Path::new(file).parent().unwrap_or(Path::new("")), "relative to this file")
            }
            _ => (Path::new(""), "relative to the working directory"),
        }
    }

    /// How high the layer lies that was written at `origin`: the file that extends no other lies lowest, and of the
    /// options the last highest.
    pub(crate) fn height(&self, origin: &Origin) -> usize {
        let files = self.sources.iter().filter(|source| source.name != SET).count();
        // a file is read before the one that it extends
        if origin.source < files { files - 1 - origin.source } else { origin.source }
    }

    fn parse(
        &mut self,
        name: String,
        text: String,
    ) -> Result<(Table, BTreeMap<String, Origin>), CaseError> {
        let source = Source { name, text };
        // What is no TOML may be any readable file, also a private one: the message names the place and quotes no line.
        let malformed = |error: toml::de::Error| {
            let span = error.span().unwrap_or(0..0);
            let written = source.text.get(span.clone()).unwrap_or_default();
            let number = written.starts_with(|c: char| c.is_ascii_digit() || "+-".contains(c))
                && toml::from_str::<Table>(&format!("x = \"{written}\"")).is_ok();
            let problem = error.message().trim().replace('\n', "; ");
            let (problem, remedy) =
                if number && (problem.contains("overflow") || problem.contains("integer")) {
                    let problem = format!("the number {written} is too large to be held");
                    (problem, "give a number in the range of its key: see `creepage schema`")
                } else {
                    let column = column(&source.text, span.start);
                    let problem = format!("not well-formed TOML at column {column}: {problem}");
                    (
                        problem,
                        "a case file is TOML: sections [in.brackets], lines `key = value`, text in \
                         quotes",
                    )
                };
            CaseError::Key(Box::new(key_error_at(&source, span, "", &problem, remedy)))
        };
        let parsed = DeTable::parse(&source.text).map_err(&malformed)?;
        let mut origins = BTreeMap::new();
        record(parsed.get_ref(), "", self.sources.len(), &mut origins);
        let table = Table::deserialize(Deserializer::from(parsed)).map_err(&malformed)?;
        self.sources.push(source);
        Ok((table, origins))
    }

    fn lay_over(&mut self, top: Table, origins: BTreeMap<String, Origin>) {
        // A key removes from the layers below those that it replaces or that are not used with it: a file that
        // extends a case with a creepage may set a torque instead. A friction law removes the keys that it does
        // not use.
        for key in keys::KEYS.iter().filter(|key| key.instead_of.is_some()) {
            let replaced = key.instead_of.is_some_and(|other| get(&top, other).is_some());
            let ruled_out = key.only.is_some_and(|(other, words)| {
                let word = get(&top, other).and_then(Value::as_str);
                word.is_some_and(|word| !words.contains(&word))
            });
            if replaced || ruled_out {
                self.drop_key(key.path);
            }
        }
        let law = get(&top, "friction.law").and_then(Value::as_str);
        if let Some(chosen) = law.and_then(Declaration::of) {
            friction::all_parameters()
                .filter(|key| !chosen.has(key))
                .for_each(|key| self.drop_key(&friction_law::path(key)));
        }
        merge(&mut self.table, top, "", &mut self.origins);
        self.origins.extend(origins);
    }

    /// Takes a key out of the layers.
    pub(crate) fn drop_key(&mut self, path: &str) {
        if remove(&mut self.table, path) {
            forget(&mut self.origins, path);
        }
    }

    /// [`Layers::key_error`] as the error of a case.
    pub fn error(
        &self,
        origin: Option<&Origin>,
        key: &str,
        problem: &str,
        remedy: &str,
    ) -> CaseError {
        CaseError::Key(Box::new(self.key_error(origin, key, problem, remedy)))
    }

    /// The error `KEY = PROBLEM` at `origin`, where the value was written; without an origin it names the first
    /// file alone. `remedy` says what to do.
    pub fn key_error(
        &self,
        origin: Option<&Origin>,
        key: &str,
        problem: &str,
        remedy: &str,
    ) -> KeyError {
        let message = format!("{key} = {problem}");
        match origin {
            Some(origin) => {
                let source = self.sources[origin.source].clone();
                key_error_in(source, origin.value.clone(), key, &message, remedy)
            }
            None => self.error_nowhere(key, &message, remedy),
        }
    }

    /// The error `message`, a whole sentence, at the place where the value of `key` was written, if it was.
    pub fn error_at(&self, key: &str, message: &str, remedy: &str) -> KeyError {
        match self.origins.get(key) {
            Some(origin) => {
                let source = self.sources[origin.source].clone();
                key_error_in(source, origin.value.clone(), key, message, remedy)
            }
            None => self.error_nowhere(key, message, remedy),
        }
    }

    /// The error `message` about a key that is written nowhere: a default, or a missing key.
    pub fn error_nowhere(&self, key: &str, message: &str, remedy: &str) -> KeyError {
        // The case file itself is read first, before what it extends.
        let file = self.sources.first().map_or("", |source| source.name.as_str());
        KeyError {
            message: shortened(format!("{file}: {message}")),
            key: key.into(),
            source_code: None,
            span: None,
            label: String::new(),
            help: Some(remedy.into()),
            others: Vec::new(),
        }
    }

    fn error_in(
        &self,
        source: Source,
        span: Range<usize>,
        key: &str,
        message: &str,
        remedy: &str,
    ) -> CaseError {
        CaseError::Key(Box::new(key_error_in(source, span, key, message, remedy)))
    }
}

/// An error at `span` of a source, with the line of the text. For sources that are known to be TOML.
pub fn key_error_in(
    source: Source,
    span: Range<usize>,
    key: &str,
    message: &str,
    remedy: &str,
) -> KeyError {
    let (source_code, at) = Excerpt::of(&source.name, &source.text, span.clone()).unzip();
    KeyError { span: at, source_code, ..key_error_at(&source, span, key, message, remedy) }
}

/// The same without the line, for a source that may be any file that can be read.
pub fn key_error_at(
    source: &Source,
    span: Range<usize>,
    key: &str,
    message: &str,
    remedy: &str,
) -> KeyError {
    let start = span.start.min(source.text.len());
    let line = source.text.as_bytes()[..start].iter().filter(|&&byte| byte == b'\n').count() + 1;
    let message = if source.name == SET {
        if message.starts_with(SET) { message.into() } else { format!("{SET}: {message}") }
    } else {
        format!("{}:{line}: {message}", source.name)
    };
    KeyError {
        message: shortened(message),
        key: key.into(),
        span: None,
        label: "here".into(),
        source_code: None,
        help: Some(remedy.into()),
        others: Vec::new(),
    }
}

/// The column of a byte of a text, in characters, counted from 1.
fn column(text: &str, at: usize) -> usize {
    let before = text.get(..at).unwrap_or(text);
    before.chars().rev().take_while(|&c| c != '\n').count() + 1
}

/// A message with printable characters alone, and no more than [`LONGEST_MESSAGE`] of them.
fn shortened(message: String) -> String {
    let message = printable(&message);
    match message.char_indices().nth(LONGEST_MESSAGE) {
        Some((end, _)) => format!("{}...", &message[..end]),
        None => message,
    }
}

/// Reads a file of a kind as UTF-8.
///
/// # Errors
/// A file that is missing, too large for its kind, or not UTF-8.
pub fn read_text(path: &Path, kind: Kind) -> Result<String, CaseError> {
    input::text(path, kind).map_err(|error| CaseError::File {
        path: path.to_path_buf(),
        problem: error.problem(),
        remedy: error.remedy(),
    })
}

/// Records where every key of a table, at any depth, was written.
fn record(table: &DeTable, prefix: &str, source: usize, origins: &mut BTreeMap<String, Origin>) {
    for (key, value) in table {
        let path = join(prefix, key.get_ref());
        record_value(&path, key.span(), value, source, origins);
    }
}

fn record_value(
    path: &str,
    key: Range<usize>,
    value: &Spanned<DeValue>,
    source: usize,
    origins: &mut BTreeMap<String, Origin>,
) {
    origins.insert(path.to_owned(), Origin { source, key: key.clone(), value: value.span() });
    match value.get_ref() {
        DeValue::Table(table) => record(table, path, source, origins),
        DeValue::Array(array) => {
            for (i, item) in array.iter().enumerate() {
                record_value(&format!("{path}[{i}]"), key.clone(), item, source, origins);
            }
        }
        _ => {}
    }
}

/// Lays `top` over `base`: tables key by key, everything else whole.
fn merge(base: &mut Table, top: Table, prefix: &str, origins: &mut BTreeMap<String, Origin>) {
    for (key, value) in top {
        let path = join(prefix, &key);
        // A key of the table of keys is one value even where it is written as a table.
        let whole = keys::find(&path).is_some();
        match (base.get_mut(&key), value) {
            (Some(Value::Table(below)), Value::Table(above)) if !whole => {
                merge(below, above, &path, origins);
            }
            (_, value) => {
                forget(origins, &path);
                base.insert(key, value);
            }
        }
    }
}

fn forget(origins: &mut BTreeMap<String, Origin>, path: &str) {
    let below = |at: &str| {
        at.strip_prefix(path)
            .is_some_and(|rest| rest.is_empty() || rest.starts_with('.') || rest.starts_with('['))
    };
    // Only what begins with the path is looked at: a file may have very many keys.
    let gone: Vec<String> = origins
        .range(path.to_owned()..)
        .map(|(at, _)| at)
        .take_while(|at| at.starts_with(path))
        .filter(|at| below(at))
        .cloned()
        .collect();
    for at in gone {
        origins.remove(&at);
    }
}

/// `prefix.key`; the key alone where the prefix is empty.
pub fn join(prefix: &str, key: &str) -> String {
    if prefix.is_empty() { key.to_owned() } else { format!("{prefix}.{key}") }
}

/// The value at a dotted path without indices, if there is one.
pub fn get<'a>(table: &'a Table, path: &str) -> Option<&'a Value> {
    let mut segments = path.split('.');
    let mut value = table.get(segments.next()?)?;
    for segment in segments {
        value = value.as_table()?.get(segment)?;
    }
    Some(value)
}

/// Removes the value at a dotted path without indices; whether there was one.
pub(crate) fn remove(table: &mut Table, path: &str) -> bool {
    let mut table = table;
    let mut path = path;
    while let Some((section, rest)) = path.split_once('.') {
        match table.get_mut(section) {
            Some(Value::Table(inner)) => (table, path) = (inner, rest),
            _ => return false,
        }
    }
    table.remove(path).is_some()
}
