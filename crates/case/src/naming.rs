//! Texts that name keys, checked while they compile.

/// A text whose keys and sections the table of keys has, with the values of its braces.
#[macro_export]
macro_rules! remedy {
    ($text:literal) => {{
        const { assert!($crate::keys::names_only_keys($text), "it names a key that there is not") };
        format!($text)
    }};
}

/// The path of a key that the table of keys has.
#[macro_export]
macro_rules! key {
    ($path:literal) => {
        const {
            assert!($crate::keys::names_only_keys($path), "there is no such key");
            $path
        }
    };
}
