//! Why a deck is refused.

use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use miette::Diagnostic;
use output::files::input::InputError;
use thiserror::Error;

/// Why a deck is refused, and where the cause stands.
#[derive(Debug, Error)]
#[error("{}{fault}{}", self.prefix(), self.suffix())]
pub struct DeckError {
    /// File and line; `None` for what the whole deck lacks.
    pub place: Option<DeckLine>,
    /// What is wrong.
    pub fault: Fault,
    /// The other cards that are refused, where that is a card.
    pub others: Vec<DeckError>,
}

/// A line of one of the deck's files.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DeckLine {
    /// The file: the deck, or one that it includes.
    pub file: Arc<Path>,
    /// The line, counted from 1.
    pub line: usize,
}

impl fmt::Display for DeckLine {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}:{}", self.file.display(), self.line)
    }
}

/// What is wrong with a deck.
#[derive(Debug, Error)]
pub enum Fault {
    /// A line does not follow the format.
    #[error("{what}")]
    Syntax {
        /// What was expected, and mostly what was found.
        what: String,
    },
    /// A card, or a value of a field, that is not read.
    #[error("{what} is not read")]
    Unsupported {
        /// What it is.
        what: String,
        /// What to do instead.
        remedy: &'static str,
    },
    /// A field without a place in a case that is neither blank nor at its default.
    #[error("*{what} is not read")]
    Field {
        /// The keyword, the name of the field and what it holds.
        what: String,
        /// What it may hold.
        allowed: String,
    },
    /// A second card where a disk on a bar has one.
    #[error("a second {what} after that of {before} is not read")]
    Second {
        /// What it is.
        what: String,
        /// Where the first one stands.
        before: DeckLine,
        /// What to do instead.
        remedy: &'static str,
    },
    /// A node, set, part or curve that a card names does not exist.
    #[error("{from} names {what}, which does not exist")]
    Unknown {
        /// What names it.
        from: String,
        /// What does not exist.
        what: String,
    },
    /// A number that two nodes have.
    #[error("node {id} is given twice")]
    RepeatedNode {
        /// The number.
        id: u64,
    },
    /// A card that a disk on a bar needs.
    #[error("the deck has no {what}")]
    Lacks {
        /// The card, and mostly what it is needed for.
        what: String,
    },
    /// A field names a parameter that no card `*PARAMETER` gives.
    #[error("the parameter &{name} is not defined")]
    Parameter {
        /// Its name.
        name: String,
    },
    /// A model in another frame than that of a case.
    #[error("the model does not stand in the frame of a case: {what} ({shown})")]
    Axes {
        /// Which axis lies otherwise.
        what: String,
        /// What in the deck shows it.
        shown: String,
    },
    /// Numbers that make no disk on a bar in the units that were given, but do in others.
    #[error("--unit {what}")]
    Unit {
        /// The units that were given, and what in the deck shows that they are not its own.
        what: String,
        /// The units that fit, with what the numbers are in them.
        fitting: String,
    },
    /// The deck or an included file cannot be read.
    #[error(transparent)]
    Input(#[from] InputError),
    /// A file includes itself, maybe by way of others.
    #[error("a file includes itself: {}", chain.join(" includes "))]
    Cycle {
        /// The names of the files, from it back to it.
        chain: Vec<String>,
    },
    /// An included file lies elsewhere.
    #[error("the included file {} lies outside the deck's folder, {}", file.display(), folder.display())]
    Outside {
        /// The file.
        file: PathBuf,
        /// The deck's folder.
        folder: PathBuf,
    },
    /// Files that include others beyond all bounds.
    #[error("the deck includes {what}")]
    Excess {
        /// More than what.
        what: String,
    },
}

const ANEW: &str = "write the file anew with the program that it comes from";

impl Fault {
    /// What to do about it.
    pub fn remedy(&self) -> String {
        match self {
            Self::Unsupported { remedy, .. } | Self::Second { remedy, .. } => (*remedy).into(),
            Self::Field { allowed, .. } => format!("leave the field blank, or give it {allowed}"),
            Self::Input(error) => error.remedy(),
            Self::Syntax { .. } | Self::Unknown { .. } | Self::RepeatedNode { .. } => ANEW.into(),
            Self::Lacks { .. } => {
                "add it; docs/ls-dyna.md lists the cards of a disk on a bar".into()
            }
            Self::Axes { .. } => "turn the whole deck, with its loads and velocities: x is the rolling direction, y lies along the axle, z points up from the bar to the disk".into(),
            Self::Unit { fitting, .. } => format!("give --unit {fitting}"),
            Self::Parameter { name } => {
                format!("define it: *PARAMETER, then the line `R {name}, VALUE`")
            }
            Self::Cycle { .. } => "take the *INCLUDE out that leads back".into(),
            Self::Outside { .. } => {
                "move the file into the deck's folder, or allow it: --include-outside".into()
            }
            Self::Excess { .. } => "put the files together into fewer".into(),
        }
    }

    /// The error of this fault at a place.
    pub(crate) fn at(self, place: &DeckLine) -> DeckError {
        DeckError { place: Some(place.clone()), ..DeckError::of(self) }
    }
}

/// How many further errors are told.
const TOLD: usize = 19;

impl DeckError {
    /// The error of a fault without a place.
    pub(crate) fn of(fault: Fault) -> Self {
        Self { place: None, fault, others: Vec::new() }
    }

    /// The error with those of other cards.
    pub(crate) fn with(self, others: Vec<Self>) -> Self {
        Self { others, ..self }
    }

    /// How many cards are refused, where that is more than one.
    fn suffix(&self) -> String {
        match self.others.len() {
            0 => String::new(),
            more => format!(" (the first of {} cards that are refused)", more + 1),
        }
    }

    fn prefix(&self) -> String {
        self.place.as_ref().map_or(String::new(), |place| format!("{place}: "))
    }
}

impl Diagnostic for DeckError {
    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        Some(Box::new(self.fault.remedy()))
    }

    fn related<'a>(&'a self) -> Option<Box<dyn Iterator<Item = &'a dyn Diagnostic> + 'a>> {
        let others = self.others.iter().take(TOLD).map(|other| other as &dyn Diagnostic);
        (!self.others.is_empty()).then(|| Box::new(others) as Box<_>)
    }
}

pub(crate) fn syntax(at: &DeckLine, what: impl Into<String>) -> DeckError {
    Fault::Syntax { what: what.into() }.at(at)
}

pub(crate) fn unsupported(
    at: &DeckLine,
    what: impl Into<String>,
    remedy: &'static str,
) -> DeckError {
    Fault::Unsupported { what: what.into(), remedy }.at(at)
}

pub(crate) fn second(
    at: &DeckLine,
    what: impl Into<String>,
    before: &DeckLine,
    remedy: &'static str,
) -> DeckError {
    Fault::Second { what: what.into(), before: before.clone(), remedy }.at(at)
}

pub(crate) fn unknown(
    at: &DeckLine,
    from: impl Into<String>,
    what: impl Into<String>,
) -> DeckError {
    Fault::Unknown { from: from.into(), what: what.into() }.at(at)
}

/// The error of a deck that lacks what a disk on a bar needs.
pub(crate) fn lacks(what: &str) -> DeckError {
    DeckError::of(Fault::Lacks { what: what.into() })
}
