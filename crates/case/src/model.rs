//! How the bodies of a case are modelled.

use crate::section::words;

words! {
    /// How the bodies are modelled.
    BodyModel {
        /// A disk and a bar of finite elements.
        #[default]
        FiniteElements = "finite-elements",
        /// Two elastic half-spaces of one material.
        HalfSpace = "half-space",
    }
}

impl BodyModel {
    /// Its word in a case file.
    pub fn word(self) -> &'static str {
        Self::WORDS[self as usize]
    }

    /// The model of that word.
    pub(crate) fn named(word: &str) -> Option<Self> {
        [Self::FiniteElements, Self::HalfSpace].into_iter().find(|model| model.word() == word)
    }

    pub(crate) fn is_default(&self) -> bool {
        *self == Self::default()
    }
}
