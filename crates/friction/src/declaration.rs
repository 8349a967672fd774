//! What a friction law is to those who choose one: its word, its parameters, and how it is made of them.

use crate::{
    Coulomb, Expression, ExpressionError, FrictionLaw, LAWS, LawError, NodeFriction, OwnLaw,
    Parameters,
};
use std::sync::Arc;

/// A number that one law or more take. Its key is the same in a case file and, but for coefficients, in the slider.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Number {
    /// Dotted path of its key in a case file.
    pub path: &'static str,
    /// SI unit; `-` for dimensionless.
    pub unit: &'static str,
    /// Least and largest value.
    pub range: [f64; 2],
    /// What it is, as a sentence with its unit.
    pub sentence: &'static str,
    /// What to do where its value is refused, or is missing.
    pub remedy: &'static str,
}

impl Number {
    /// The section of a case file in which the numbers stand, with its dot.
    const SECTION: &'static str = "friction.";

    /// Its key, without the section.
    pub const fn key(&self) -> &'static str {
        self.path.split_at(Self::SECTION.len()).1
    }

    /// Whether the default law needs it, so that every case gives it whose law can do with it.
    pub const fn is_needed_by_default(&self) -> bool {
        let numbers = LAWS[0].numbers;
        let mut i = 0;
        while i < numbers.len() {
            if same(numbers[i].0.path, self.path) && matches!(numbers[i].1, LeftOut::Refused) {
                return true;
            }
            i += 1;
        }
        false
    }
}

/// What happens where a law's number is left out.
#[derive(Clone, Copy, Debug)]
pub enum LeftOut {
    /// The parameters are refused.
    Refused,
    /// It has this value.
    Default(f64),
    /// It has a value that follows from the other parameters.
    Follows {
        /// The value in words.
        said: &'static str,
        /// The value.
        of: fn(&Parameters) -> f64,
    },
}

/// A friction law, declared in its file as `DECLARATION` and listed in [`LAWS`].
#[derive(Debug)]
pub struct Declaration {
    /// The value of the key `law` that selects it.
    pub word: &'static str,
    /// What it is, as a sentence.
    pub sentence: &'static str,
    /// Its coefficient in its parameters, as a phrase; may be empty.
    pub coefficient: &'static str,
    /// The numbers that it takes.
    pub numbers: &'static [(Number, LeftOut)],
    /// Keys of other parameters that must be given, a part of [`OTHERS`](crate::OTHERS).
    pub needs: &'static [&'static str],
    /// Keys of other parameters that may be given, a part of [`OTHERS`](crate::OTHERS).
    pub takes: &'static [&'static str],
    /// Sets parameters that are not numbers and not given to their defaults; the flag says whether contact is enforced
    /// exactly.
    pub(crate) write_defaults: fn(&mut Parameters, bool),
    /// How the law is made of its parameters.
    pub(crate) make: Make,
}

/// A law without state.
type Steady = Arc<dyn FrictionLaw>;

/// What a law is made of beside its parameters.
pub(crate) struct Beside<'a> {
    /// Reads the text of a formula.
    pub formula: &'a dyn Fn(&str) -> Result<Expression, ExpressionError>,
    /// The user's function.
    pub own: Option<&'a Arc<dyn OwnLaw>>,
}

/// How a law is made of its parameters, those not given with their defaults.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Make {
    /// One coefficient at every slip speed.
    Constant(fn(&Parameters) -> Coulomb),
    /// A law without state, with the slip velocity that the key `mode` says.
    Steady(fn(&Parameters, &Beside) -> Result<Steady, LawError>),
    /// A law of a contact node with its state.
    AtNode(fn(&Parameters, &Beside) -> Box<dyn NodeFriction>),
}

impl Declaration {
    /// The law with a given word.
    pub fn of(word: &str) -> Option<&'static Self> {
        LAWS.into_iter().find(|law| law.word == word)
    }

    /// Whether it has no state, and so is a law of the slider as well.
    pub fn is_steady(&self) -> bool {
        matches!(self.make, Make::Constant(_) | Make::Steady(_))
    }

    /// The keys of the parameters that must be given.
    pub fn needs(&self) -> impl Iterator<Item = &'static str> {
        let needed = self.numbers.iter().filter(|(_, left_out)| left_out.is_refused());
        needed.map(|(number, _)| number.key()).chain(self.needs.iter().copied())
    }

    /// The keys of all its parameters.
    pub fn keys(&self) -> impl Iterator<Item = &'static str> {
        let numbers = self.numbers.iter().map(|(number, _)| number.key());
        numbers.chain(self.needs.iter().copied()).chain(self.takes.iter().copied())
    }

    /// Whether the law has a parameter.
    pub fn has(&self, key: &str) -> bool {
        self.keys().any(|own| own == key)
    }
}

impl LeftOut {
    pub(crate) fn is_refused(&self) -> bool {
        matches!(self, Self::Refused)
    }
}

/// For a law whose parameters are numbers alone, or have no defaults.
pub(crate) const fn no_defaults(_: &mut Parameters, _: bool) {}

/// Every number that some law takes, each once.
pub const NUMBERS: [Number; count()] = {
    let mut all = [LAWS[0].numbers[0].0; count()];
    let (mut found, mut law) = (0, 0);
    while law < LAWS.len() {
        let mut place = 0;
        while place < LAWS[law].numbers.len() {
            if is_first(law, place) {
                all[found] = LAWS[law].numbers[place].0;
                found += 1;
            }
            place += 1;
        }
        law += 1;
    }
    all
};

const fn count() -> usize {
    let (mut found, mut law) = (0, 0);
    while law < LAWS.len() {
        let mut place = 0;
        while place < LAWS[law].numbers.len() {
            found += is_first(law, place) as usize;
            place += 1;
        }
        law += 1;
    }
    found
}

/// Whether no law before has the number.
const fn is_first(law: usize, place: usize) -> bool {
    let mut before = 0;
    while before < law {
        let mut i = 0;
        while i < LAWS[before].numbers.len() {
            if same(LAWS[before].numbers[i].0.path, LAWS[law].numbers[place].0.path) {
                return false;
            }
            i += 1;
        }
        before += 1;
    }
    true
}

const fn same(a: &str, b: &str) -> bool {
    let (a, b) = (a.as_bytes(), b.as_bytes());
    let mut i = 0;
    while i < a.len() && i < b.len() && a[i] == b[i] {
        i += 1;
    }
    i == a.len() && i == b.len()
}

/// Declares the modules of the laws and the list of them.
macro_rules! laws {
    ($($kind:ident: $file:ident;)*) => {
        $(mod $file;)*

        /// The friction laws.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
        #[serde(rename_all = "snake_case")]
        #[allow(missing_docs, reason = "each is declared in its file")]
        pub enum Kind {
            #[default]
            $($kind,)*
        }

        impl Kind {
            /// All laws.
            pub const ALL: [Self; LAWS.len()] = [$(Self::$kind,)*];

            /// The law with a given word.
            pub fn of(word: &str) -> Option<Self> {
                Self::ALL.into_iter().find(|kind| kind.declaration().word == word)
            }

            /// How the law is declared.
            pub const fn declaration(self) -> &'static Declaration {
                LAWS[self as usize]
            }
        }

        /// The friction laws, one per [`Kind`] and in that order; the first is the default.
        pub const LAWS: [&Declaration; [$(stringify!($kind)),*].len()] = [$(&$file::DECLARATION,)*];
    };
}

pub(crate) use laws;
