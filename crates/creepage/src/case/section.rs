//! One declaration per key of the case file.
//!
//! A line of a [`section!`] gives a key's meaning, type, default and row of the table of keys; serde, the
//! JSON Schema and the checks take all that they know of the key from there.

use crate::case::key::Key;

/// A section of a case file, and the rows of its keys.
pub(crate) trait Section {
    /// The rows of the keys of the section `path`, and of the sections in it.
    fn keys(path: &str) -> Vec<Key>;
}

/// A list of sections.
impl<S: Section> Section for Vec<S> {
    fn keys(path: &str) -> Vec<Key> {
        S::keys(&format!("{path}[]"))
    }
}

/// Whether a value is that of a key that is left out, which a resolved case then leaves out as well.
pub(crate) fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// Declares a section as a struct, of which each line is a field, `name: type = default => row;`. The default may be
/// left out where it is the type's own; a field without a row is a section itself.
///
/// `optional` sections may be left out of a case as a whole; in `required` ones a key without a default must be
/// given, and a default is an attribute of serde.
macro_rules! section {
    ($(#[$meta:meta])* optional $name:ident {
        $($(#[$of:meta])* $field:ident: $type:ty $(= $default:expr)? $(=> $row:expr)?;)*
    }) => {
        section! {
            $(#[$meta])*
            #[serde(default)]
            required $name { $($(#[$of])* $field: $type $(=> $row)?;)* }
        }

        impl Default for $name {
            fn default() -> Self {
                Self { $($field: section!(@default $($default)?)),* }
            }
        }
    };
    ($(#[$meta:meta])* required $name:ident {
        $($(#[$of:meta])* $field:ident: $type:ty $(=> $row:expr)?;)*
    }) => {
        #[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
        #[serde(deny_unknown_fields)]
        $(#[$meta])*
        pub struct $name { $($(#[$of])* pub $field: $type),* }

        impl crate::case::section::Section for $name {
            fn keys(path: &str) -> Vec<crate::case::key::Key> {
                let at = |name: &str| crate::case::value::join(path, name);
                [$(section!(@rows at(stringify!($field)), $type $(, $row)?)),*].concat()
            }
        }
    };
    (@default) => { Default::default() };
    (@default $default:expr) => { $default };
    (@rows $path:expr, $type:ty) => { <$type as crate::case::section::Section>::keys(&$path) };
    (@rows $path:expr, $type:ty, $row:expr) => { vec![$row.at($path)] };
}

/// Declares the words that a key may be as an enum, each word with its variant; one is the default.
macro_rules! words {
    ($(#[$meta:meta])* $name:ident { $($(#[$of:meta])* $variant:ident = $word:literal,)+ }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        #[derive(serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
        pub enum $name { $($(#[$of])* #[serde(rename = $word)] $variant,)+ }

        impl $name {
            pub(crate) const WORDS: &'static [&'static str] = &[$($word),+];

            /// Its word in a case file.
            pub fn word(self) -> &'static str {
                Self::WORDS[self as usize]
            }
        }
    };
}

pub(crate) use {section, words};
