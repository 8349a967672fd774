//! A case file, the files that it extends and the `--set` options, laid over one another.
//!
//! Every key keeps the [place](crate::case::places) where its value was written, so that a message about the merged
//! case can still show the line.

use std::path::{Path, PathBuf};

use friction::Declaration;
use serde::Deserialize;
use toml::de::{DeTable, Deserializer};
use toml::{Table, Value};

use crate::case::error::{CaseError, KeyError};
use crate::case::file::CaseFile;
use crate::case::keys::{self, KEYS};
use crate::case::places::{Origin, Origins, Places, Source, origins_of};
use crate::case::value::{get, join, remove};
use crate::case::{friction_law, irregularity};

/// A chain of `extends` longer than this is taken for a mistake.
const LONGEST_CHAIN: usize = 16;

/// The merged keys, and where each was written.
#[derive(Clone, Debug, Default)]
pub struct Layers {
    /// The keys, the last layer on top.
    pub table: Table,
    /// Where each was written.
    pub places: Places,
}

impl Layers {
    /// Reads a case file with everything that it extends.
    ///
    /// # Errors
    /// A file that cannot be read, is not well-formed TOML, or extends itself.
    pub fn read(file: &CaseFile) -> Result<Self, CaseError> {
        Self::of_chain(file.clone(), file.first_text()?, file.canonical())
    }

    /// Reads a case from a text, with everything that it extends. `path` names it; `extends` is relative to the
    /// folder of `path`.
    ///
    /// # Errors
    /// As those of [`Layers::read`].
    pub fn from_text(text: &str, path: &Path) -> Result<Self, CaseError> {
        let named = CaseFile::Disk(path.to_path_buf());
        Self::of_chain(named.clone(), text.to_owned(), named)
    }

    /// The layers of a text and of all files that it extends; `first` is its place in the chain.
    fn of_chain(file: CaseFile, text: String, first: CaseFile) -> Result<Self, CaseError> {
        let mut layers = Self::default();
        let (mut chain, mut written) = (vec![first], Vec::new());
        let mut next = Some((file, text));
        while let Some((file, text)) = next {
            let (mut table, mut origins) = layers.parse(Source::file(file.clone(), text))?;
            let extends = table.remove("extends").zip(origins.remove("extends"));
            written.push((table, origins));
            next = match extends {
                Some((base, origin)) => Some(layers.base(&file, &base, &origin, &mut chain)?),
                None => None,
            };
        }
        for (table, origins) in written.into_iter().rev() {
            layers.lay_over(table, origins);
        }
        Ok(layers)
    }

    /// The file that the value `extends` of `file` names, and its text.
    fn base(
        &self,
        file: &CaseFile,
        extends: &Value,
        origin: &Origin,
        chain: &mut Vec<CaseFile>,
    ) -> Result<(CaseFile, String), CaseError> {
        let refused = |problem: &str, remedy: &str| {
            let message = format!("extends = {problem}");
            let source = self.places.source(origin);
            CaseError::from(source.error(origin.value.clone(), "extends", &message, remedy))
        };
        let Some(base) = extends.as_str() else {
            return Err(refused(
                &format!("{extends} must be text in quotes"),
                "give the path of another case file, relative to this one",
            ));
        };
        let base = file.beside(base);
        if chain.contains(&base.canonical()) {
            return Err(refused(
                &format!("{extends} leads back to a file that extends this one"),
                "end the chain of `extends` at a file that extends nothing",
            ));
        }
        if chain.len() >= LONGEST_CHAIN {
            return Err(refused(
                &format!("{extends} would be file {} of a chain", chain.len() + 1),
                &format!("a chain of `extends` may have {LONGEST_CHAIN} files: join some"),
            ));
        }
        let text = base.text().map_err(|error| {
            refused(
                &format!("{extends}: {base}: {}", error.problem()),
                &format!("{}; the path is taken relative to this file", error.remedy()),
            )
        })?;
        chain.push(base.canonical());
        Ok((base, text))
    }

    /// Lays one `--set KEY=VALUE` over everything before. A value that is no TOML is taken as a word.
    ///
    /// # Errors
    /// A text of another form.
    pub fn add_set(&mut self, set: &str) -> Result<(), CaseError> {
        let text = line_of(set).map_err(|problem| {
            Source::option(set.into()).error(
                0..set.len(),
                "",
                &format!("--set {set}: {problem}"),
                "write --set KEY=VALUE with a dotted key, for example --set mesh.zone.size=2e-3",
            )
        })?;
        let (table, origins) = self.parse(Source::option(text))?;
        self.lay_over(table, origins);
        Ok(())
    }

    /// The files that were read, and those that `friction.table`, `bar.surface` and `disk.out_of_round` name.
    pub fn files(&self) -> Vec<PathBuf> {
        let mut files: Vec<PathBuf> = self.places.files().cloned().collect();
        files.extend(self.file_at("friction.table"));
        files.extend(irregularity::file_keys().filter_map(|key| self.file_at(&key)));
        files
    }

    /// The file whose path is the value of a key, if it has one.
    pub fn file_at(&self, key: &str) -> Option<PathBuf> {
        let path = get(&self.table, key)?.as_str()?;
        Some(self.places.folder_of(key).0.join(path))
    }

    /// The error `KEY = PROBLEM` at the place where the value was written. `remedy` says what to do.
    pub fn error(&self, key: &str, problem: &str, remedy: &str) -> KeyError {
        self.places.error(key, &format!("{key} = {problem}"), remedy)
    }

    fn parse(&mut self, source: Source) -> Result<(Table, Origins), CaseError> {
        let malformed = |error| malformed(&source, &error);
        let parsed = DeTable::parse(&source.text).map_err(malformed)?;
        let origins = origins_of(parsed.get_ref(), self.places.sources.len());
        let table = Table::deserialize(Deserializer::from(parsed)).map_err(malformed)?;
        self.places.sources.push(source);
        Ok((table, origins))
    }

    fn lay_over(&mut self, top: Table, origins: Origins) {
        // A key removes from the layers below those that it replaces or that are not used with it: a file that
        // extends a case with a creepage may set a torque instead. A friction law removes the keys that it does
        // not use.
        for key in KEYS.iter().filter(|key| key.instead_of.is_some()) {
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
        merge(&mut self.table, top, "", &mut self.places);
        self.places.origins.extend(origins);
    }

    /// Takes a key out of the layers.
    pub(crate) fn drop_key(&mut self, path: &str) {
        if remove(&mut self.table, path) {
            self.places.forget(path);
        }
    }
}

/// The line of TOML that a `--set` option stands for.
fn line_of(set: &str) -> Result<String, &'static str> {
    let (key, value) = set.split_once('=').ok_or("there is no '='")?;
    let (key, value) = (key.trim(), value.trim());
    let plain = |c: char| c.is_ascii_alphanumeric() || "_.-".contains(c);
    if key.is_empty() || !key.chars().all(plain) || key.split('.').any(str::is_empty) {
        return Err("the part before '=' is not a dotted key");
    }
    if key == "extends" {
        return Err("`extends` belongs in a file");
    }
    if value.is_empty() {
        return Err("there is no value after '='");
    }
    let is_value =
        toml::from_str::<Table>(&format!("x = {value}")).is_ok_and(|table| table.len() == 1);
    if is_value {
        Ok(format!("{key} = {value}"))
    } else if value.chars().all(|c| plain(c) || "/ %^µ".contains(c)) {
        Ok(format!("{key} = \"{value}\""))
    } else {
        Err("the part after '=' is neither a TOML value nor a word")
    }
}

/// Why a text is no TOML. It may be that of any readable file, also a private one: the message names the place and quotes
/// no line.
fn malformed(source: &Source, error: &toml::de::Error) -> KeyError {
    let span = error.span().unwrap_or(0..0);
    let written = source.text.get(span.clone()).unwrap_or_default();
    let number = written.starts_with(|c: char| c.is_ascii_digit() || "+-".contains(c))
        && toml::from_str::<Table>(&format!("x = \"{written}\"")).is_ok();
    let problem = error.message().trim().replace('\n', "; ");
    if number && (problem.contains("overflow") || problem.contains("integer")) {
        let problem = format!("the number {written} is too large to be held");
        let remedy = "give a number in the range of its key: see `creepage schema`";
        return source.unquoted_error(span, "", &problem, remedy);
    }
    let before = source.text.get(..span.start).unwrap_or(&source.text);
    let column = before.chars().rev().take_while(|&c| c != '\n').count() + 1;
    let problem = format!("not well-formed TOML at column {column}: {problem}");
    let remedy = "a case file is TOML: sections [in.brackets], lines `key = value`, text in quotes";
    source.unquoted_error(span, "", &problem, remedy)
}

/// Lays `top` over `base`: tables key by key, everything else whole.
fn merge(base: &mut Table, top: Table, prefix: &str, places: &mut Places) {
    for (key, value) in top {
        let path = join(prefix, &key);
        // A key of the table of keys is one value even where it is written as a table.
        let whole = keys::find(&path).is_some();
        match (base.get_mut(&key), value) {
            (Some(Value::Table(below)), Value::Table(above)) if !whole => {
                merge(below, above, &path, places);
            }
            (_, value) => {
                places.forget(&path);
                base.insert(key, value);
            }
        }
    }
}
