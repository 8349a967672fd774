//! Panics of the HDF5 library, as errors.
//!
//! The library checks most of what it reads, but not everything in a damaged index of chunks, and then panics.
//! The parameters of the index are not accessible, so that they cannot be checked before. Such a file is
//! refused like any other damaged one.

use rust_hdf5::Hdf5Error;
use std::any::Any;
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::Once;

thread_local! {
    /// Whether this thread is within [`catch_panic`].
    static WITHIN: Cell<bool> = const { Cell::new(false) };
}

/// What `call` returns; its panic, of which nothing is printed, becomes an error. `call` must only call the
/// library.
///
/// The first call replaces the panic hook of the process by one that prints nothing within this function.
///
/// Asserted to be safe on unwinding: what the library shares between calls are cells, which unwinding
/// releases, and caches behind locks, which it no longer uses once they are poisoned.
pub(crate) fn catch_panic<T>(call: impl FnOnce() -> Result<T, Hdf5Error>) -> Result<T, Hdf5Error> {
    static HOOK: Once = Once::new();
    HOOK.call_once(|| {
        let before = take_hook();
        set_hook(Box::new(move |panic| {
            if !WITHIN.get() {
                before(panic);
            }
        }));
    });
    WITHIN.set(true);
    let result = catch_unwind(AssertUnwindSafe(call));
    WITHIN.set(false);
    result.unwrap_or_else(|panic| {
        let reason = text(panic.as_ref());
        Err(Hdf5Error::InvalidState(format!("damaged: the HDF5 library broke off ({reason})")))
    })
}

fn text(panic: &(dyn Any + Send)) -> &str {
    let text = panic.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("without a reason")
}

#[cfg(test)]
mod tests {
    use super::catch_panic;

    #[test]
    fn a_panic_becomes_an_error_with_its_text() {
        let bitmap: Vec<u8> = Vec::new();
        let error = catch_panic(|| Ok(bitmap[std::hint::black_box(0)])).map_err(|e| e.to_string());
        assert!(error.is_err_and(|text| text.contains("the len is 0 but the index is 0")));
        let error = catch_panic::<()>(|| panic!("page {}", 7)).map_err(|e| e.to_string());
        assert!(error.is_err_and(|text| text.contains("broke off (page 7)")));
        assert_eq!(catch_panic(|| Ok(3)).ok(), Some(3));
    }
}
