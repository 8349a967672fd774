//! One declaration per key of the case file.
//!
//! A line of a [`section!`] gives the key's meaning, type, default and row of the table of keys; serde, the
//! JSON Schema and the checks take all that they know of the key from there.

/// Declares a section: the struct that serde reads, its defaults, and `KEYS`, the rows of its keys below each
/// of the paths.
///
/// A line is `name: type = default => row;`. The default may be left out where it is the type's own, the row
/// where the field is a section itself. `optional` sections may be left out of a case as a whole; in
/// `required` ones a key without a default must be given, and a default is an attribute of serde.
macro_rules! section {
    (@line $head:tt [$($field:tt)*] [$($row:tt)*] [$($default:tt)*]
        $(#[$meta:meta])* $name:ident: Option<$type:ty> $(=> $key:expr)?; $($rest:tt)*) => {
        section!(@line $head
            [$($field)* $(#[$meta])* #[serde(skip_serializing_if = "Option::is_none")]
                pub $name: Option<$type>,]
            [$($row)* $({ $name $key })?] [$($default)* $name: None,] $($rest)*);
    };
    (@line $head:tt [$($field:tt)*] [$($row:tt)*] [$($default:tt)*]
        $(#[$meta:meta])* $name:ident: $type:ty $(= $value:expr)? $(=> $key:expr)?; $($rest:tt)*) => {
        section!(@line $head [$($field)* $(#[$meta])* pub $name: $type,]
            [$($row)* $({ $name $key })?]
            [$($default)* $name: section!(@or_default $($value)?),] $($rest)*);
    };
    (@line [optional $name:ident [$($path:literal),+] $(#[$meta:meta])*]
        [$($field:tt)*] $rows:tt [$($default:tt)*]) => {
        #[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
        #[serde(deny_unknown_fields, default)]
        $(#[$meta])*
        pub struct $name { $($field)* }

        impl Default for $name {
            fn default() -> Self {
                Self { $($default)* }
            }
        }

        section!(@rows $name [$($path),+] $rows);
    };
    (@line [required $name:ident [$($path:literal),+] $(#[$meta:meta])*]
        [$($field:tt)*] $rows:tt $default:tt) => {
        #[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
        #[serde(deny_unknown_fields)]
        $(#[$meta])*
        pub struct $name { $($field)* }

        section!(@rows $name [$($path),+] $rows);
    };
    (@or_default) => { Default::default() };
    (@or_default $value:expr) => { $value };
    (@rows $name:ident [$($path:literal),+] $rows:tt) => {
        impl $name {
            pub(crate) const KEYS: &'static [&'static [crate::case::key::Key]] =
                &[$(section!(@below $path $rows)),+];
        }
    };
    (@below $path:literal [$({ $name:ident $key:expr })*]) => {
        &[$(crate::case::key::Key { path: concat!($path, stringify!($name)), ..$key }),*]
    };
    ($(#[$meta:meta])* $kind:ident $name:ident $paths:tt { $($line:tt)* }) => {
        section!(@line [$kind $name $paths $(#[$meta])*] [] [] [] $($line)*);
    };
}

/// Declares the rows of keys whose struct another crate declares.
macro_rules! rows {
    ($(#[$meta:meta])* $($path:literal => $key:expr;)*) => {
        $(#[$meta])*
        pub(crate) const KEYS: &[Key] = &[$(Key { path: $path, ..$key }),*];
    };
}

pub(crate) use {rows, section};
