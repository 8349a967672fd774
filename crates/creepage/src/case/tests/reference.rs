//! The reference cases that the program holds.

use std::path::Path;

use crate::case::reference::REFERENCES;
use crate::case::{Case, CaseFile};

#[test]
fn a_reference_case_is_that_of_its_file_and_names_no_other_file() {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    for reference in REFERENCES.iter().filter(|of| !of.is_sweep()) {
        let held = Case::read(&CaseFile::Reference(reference), &[]).unwrap();
        assert_eq!(held, Case::load(&cases.join(reference.file()), &[]).unwrap());
        assert_eq!(held.inputs(), Vec::<std::path::PathBuf>::new(), "{}", reference.name);
    }
}

#[test]
fn each_reference_case_has_a_title_and_is_found_by_the_last_part_of_its_name() {
    for reference in REFERENCES {
        assert!(!reference.title().is_empty(), "{}", reference.name);
        let stem = reference.name.rsplit('/').next().unwrap();
        assert_eq!(CaseFile::named(Path::new(stem)), CaseFile::Reference(reference));
    }
}

#[test]
fn an_error_in_a_reference_case_names_it_with_its_line() {
    let case = Case::read(&CaseFile::named(Path::new("b-falling")), &[]).unwrap();
    let error = case.error_at("friction.dynamic", "no", "").to_string();
    assert_eq!(error, "zhao-li/b-falling.toml (reference case):16: no");
    let below = case.error_at("load.normal", "no", "").to_string();
    assert!(below.starts_with("zhao-li/a-coulomb.toml (reference case):"), "{below}");
}
