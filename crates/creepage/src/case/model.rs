//! How the bodies of a case are modelled.

use crate::case::words::words;

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
    /// The model of that word.
    pub(crate) fn named(word: &str) -> Option<Self> {
        [Self::FiniteElements, Self::HalfSpace].into_iter().find(|model| model.word() == word)
    }

    pub(crate) fn is_default(&self) -> bool {
        *self == Self::default()
    }
}

/// Keys that a layer below that of `model` gives and that have no meaning for it. They are no part of what a case says:
/// all of them are equal.
#[derive(Clone, Debug, Default)]
pub struct LeftOut(pub Vec<&'static str>);

impl PartialEq for LeftOut {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl LeftOut {
    /// The warning about them.
    pub(crate) fn warning(&self, model: BodyModel) -> Option<String> {
        let keys = self.0.join(", ");
        let model = model.word();
        (!self.0.is_empty())
            .then(|| format!("without meaning for model = \"{model}\" and left out: {keys}"))
    }
}
