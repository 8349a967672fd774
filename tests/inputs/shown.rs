//! What is shown when the HDF5 library panics over a damaged file. In a process of its own, since it
//! replaces the hook of panics.
#![allow(clippy::unwrap_used)]

use std::fs;
use std::panic::{catch_unwind, set_hook};
use std::sync::atomic::{AtomicUsize, Ordering};

static SHOWN: AtomicUsize = AtomicUsize::new(0);

#[test]
fn a_panic_of_the_hdf5_library_is_not_shown_but_any_other_is() {
    set_hook(Box::new(|_| {
        SHOWN.fetch_add(1, Ordering::Relaxed);
    }));
    // A damaged index of chunks: the library takes a byte of an empty bitmap.
    let found = concat!(env!("CARGO_MANIFEST_DIR"), "/../fuzz/found/grid/crash-f67a3db5");
    runs::inputs::read("grid", &fs::read(found).unwrap());
    assert_eq!(SHOWN.load(Ordering::Relaxed), 0);
    assert!(catch_unwind(|| panic!("of this program")).is_err());
    assert_eq!(SHOWN.load(Ordering::Relaxed), 1);
}
