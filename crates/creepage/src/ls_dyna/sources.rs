//! The files of a deck: that which is named, and those that it includes.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use output::files::input::{self, KEYWORDS};

use crate::ls_dyna::cards::{Card, Format, cards};
use crate::ls_dyna::error::{DeckError, DeckLine, Fault, syntax};

/// A deck on disk.
#[derive(Clone, Copy, Debug)]
pub struct Source<'a> {
    /// The file that the deck begins with.
    pub file: &'a Path,
    /// Whether files outside its folder may be included.
    pub include_outside: bool,
}

/// How deep files may include others.
const DEEPEST: usize = 100;
/// How many included files a deck may have; one that is included twice counts twice.
const MOST: usize = 10_000;

/// The contents of a deck's files; the first is that which the deck begins with.
pub(super) struct Sources(Vec<File>);

struct File {
    path: Arc<Path>,
    bytes: Vec<u8>,
    /// The files that its cards `*INCLUDE` name, in their order.
    included: Vec<usize>,
}

impl Sources {
    /// Reads a deck's files.
    ///
    /// # Errors
    /// A file that cannot be read, includes itself, or lies outside where that is not allowed.
    pub(super) fn read(source: &Source) -> Result<Self, DeckError> {
        let mut reading =
            Reading { source, files: Vec::new(), known: HashMap::new(), chain: Vec::new() };
        reading.file(source.file, None)?;
        Ok(Self(reading.files))
    }

    /// All cards, those of an included file where it is included.
    pub(super) fn cards(&self) -> Result<Vec<Card<'_>>, DeckError> {
        let mut flat = Flat { sources: self, cards: Vec::new(), files: 0, bytes: 0 };
        flat.file(0, Format::Standard)?;
        Ok(flat.cards)
    }
}

/// The files while they are read.
struct Reading<'a> {
    source: &'a Source<'a>,
    files: Vec<File>,
    /// Files by their place on the disk.
    known: HashMap<PathBuf, usize>,
    /// The files that include the present one, from the first.
    chain: Vec<PathBuf>,
}

impl Reading<'_> {
    /// Reads a file, which a line of the deck names, and those that it includes; returns its index.
    fn file(&mut self, path: &Path, named: Option<&DeckLine>) -> Result<usize, DeckError> {
        let fail = |fault| DeckError { place: named.cloned(), ..DeckError::of(fault) };
        let known = path.canonicalize().ok().and_then(|real| self.known.get(&real).copied());
        if let Some(known) = known {
            return Ok(known);
        }
        let bytes = input::bytes(path, KEYWORDS).map_err(|error| fail(error.into()))?;
        let real = canonical(path).map_err(fail)?;
        let index = self.files.len();
        self.known.insert(real.clone(), index);
        self.files.push(File { path: path.into(), bytes, included: Vec::new() });
        self.chain.push(real);
        self.files[index].included = self.includes(index)?;
        self.chain.pop();
        Ok(index)
    }

    /// Reads the files that a file includes.
    fn includes(&mut self, index: usize) -> Result<Vec<usize>, DeckError> {
        let path = self.files[index].path.clone();
        let named = {
            // formats do not matter for names
            let cards = cards(&self.files[index].bytes, &path, Format::Standard)?;
            let includes = cards.iter().filter(|card| card.name == "INCLUDE");
            includes.map(names).collect::<Result<Vec<_>, _>>()?.concat()
        };
        if named.len() > MOST {
            return Err(too_much());
        }
        let mut included = Vec::new();
        for (name, place) in named {
            let file = self.find(&name, &path);
            self.allowed(&file).map_err(|fault| fault.at(&place))?;
            included.push(self.file(&file, Some(&place))?);
        }
        Ok(included)
    }

    /// The file of that name: seen from the deck's folder, as LS-DYNA does, or else from that of the file that
    /// includes it.
    fn find(&self, name: &str, from: &Path) -> PathBuf {
        let beside = |file: &Path, name: &str| file.parent().unwrap_or(Path::new("")).join(name);
        // decks of Windows have backslashes between folders
        let portable = name.replace('\\', "/");
        let places =
            [name, &portable].map(|name| [self.source.file, from].map(|f| beside(f, name)));
        let found = places.as_flattened().iter().find(|file| file.exists());
        found.unwrap_or(&places[0][1]).clone()
    }

    /// Refuses a file that leads back to itself or lies outside.
    fn allowed(&self, file: &Path) -> Result<(), Fault> {
        // what is wrong with a file that is not there is said where it is read
        let Ok(real) = file.canonicalize() else { return Ok(()) };
        let parent = self.source.file.parent().filter(|folder| *folder != Path::new(""));
        let folder = canonical(parent.unwrap_or(Path::new(".")))?;
        if !self.source.include_outside && !real.starts_with(&folder) {
            return Err(Fault::Outside { file: file.into(), folder });
        }
        if let Some(first) = self.chain.iter().position(|above| *above == real) {
            let name = |path: &PathBuf| {
                path.file_name().unwrap_or_default().to_string_lossy().into_owned()
            };
            let chain = self.chain[first..].iter().chain([&real]).map(name).collect();
            return Err(Fault::Cycle { chain });
        }
        if self.chain.len() >= DEEPEST {
            return Err(Fault::Excess { what: format!("files more than {DEEPEST} deep") });
        }
        Ok(())
    }
}

fn too_much() -> DeckError {
    let what = format!("more than {MOST} files or 4 GiB");
    DeckError::of(Fault::Excess { what })
}

fn canonical(path: &Path) -> Result<PathBuf, Fault> {
    path.canonicalize().map_err(|cause| {
        let fault = input::Fault::Unreadable(cause);
        Fault::Input(input::InputError { path: path.into(), kind: KEYWORDS, fault })
    })
}

/// The names of files of a card `*INCLUDE`, one a line; a line that ends with ` +` goes on with the next.
fn names(card: &Card) -> Result<Vec<(String, DeckLine)>, DeckError> {
    let mut names = Vec::new();
    let mut begun = String::new();
    for line in card.lines() {
        let text = line.text.trim();
        if let Some(part) = text.strip_suffix(" +") {
            begun.push_str(part.trim_end());
            continue;
        }
        names.push((begun.clone() + text, line.place()));
        begun.clear();
    }
    if names.is_empty() || !begun.is_empty() {
        return Err(syntax(&card.place, "*INCLUDE needs the name of a file"));
    }
    Ok(names)
}

/// The cards while files are put in where they are included.
struct Flat<'a> {
    sources: &'a Sources,
    cards: Vec<Card<'a>>,
    /// How many files, and how many bytes, were put in.
    files: usize,
    bytes: u64,
}

impl Flat<'_> {
    fn file(&mut self, index: usize, format: Format) -> Result<(), DeckError> {
        let file = &self.sources.0[index];
        (self.files, self.bytes) = (self.files + 1, self.bytes + file.bytes.len() as u64);
        if self.files > MOST || self.bytes > KEYWORDS.most {
            return Err(too_much());
        }
        let mut included = file.included.iter();
        for card in cards(&file.bytes, &file.path, format)? {
            if card.name != "INCLUDE" {
                self.cards.push(card.without_headings());
                continue;
            }
            let (count, format) = (names(&card)?.len(), card.format);
            self.cards.push(card);
            for &next in included.by_ref().take(count) {
                // *INCLUDE + says that the file is in the long format
                self.file(next, format)?;
            }
        }
        Ok(())
    }
}
