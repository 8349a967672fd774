//! Texts that name keys, checked at compile time.

/// `format!` of a text in which every key and section is in the table of keys; another one does not compile.
#[macro_export]
macro_rules! remedy {
    ($text:literal) => {{
        const {
            assert!(
                $crate::case::keys::names_only_keys($text),
                "it names a key that does not exist"
            )
        };
        format!($text)
    }};
}

/// The path of a key in the table of keys; another one does not compile.
#[macro_export]
macro_rules! key {
    ($path:literal) => {
        const {
            assert!($crate::case::keys::names_only_keys($path), "there is no such key");
            $path
        }
    };
}
