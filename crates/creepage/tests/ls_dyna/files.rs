//! Decks of several files: what is included, and what is refused, by file and line.

use std::fs;
use std::path::Path;

use creepage::ls_dyna::{DeckError, Fault, Source, Translation, Units, translate};
use tempfile::TempDir;

/// A folder `decks` with these files, beside which others may lie.
fn files(named: &[(&str, &str)]) -> TempDir {
    let place = tempfile::tempdir().unwrap();
    for (name, text) in named {
        let path = place.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    place
}

fn read(place: &TempDir, include_outside: bool) -> Result<Translation, DeckError> {
    let file = place.path().join("decks/main.k");
    let source = Source { file: &file, include_outside };
    translate(&source, Units::parse("mm-ton-s").unwrap(), "mesh.inp")
}

/// The file and line of an error.
fn place_of(error: &DeckError) -> (String, usize) {
    let place = error.place.as_ref().unwrap();
    (place.file.file_name().unwrap().to_string_lossy().into_owned(), place.line)
}

/// The deck of the tests in two files: its nodes and what follows them in `name`.
fn split(name: &str) -> [String; 2] {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/parts.k");
    let text = fs::read_to_string(path).unwrap();
    let (head, nodes) = text.split_once("*NODE\n").unwrap();
    [format!("{head}*INCLUDE\n{name}\n*END\n"), format!("*NODE\n{nodes}")]
}

#[test]
fn a_deck_split_into_files_is_the_same_model() {
    let [main, nodes] = split("more/nodes.k");
    let place = files(&[("decks/main.k", &main), ("decks/more/nodes.k", &nodes)]);
    let together = main.replace("*INCLUDE\nmore/nodes.k\n*END\n", &nodes);
    let alone = files(&[("decks/main.k", &together)]);
    let [split, alone] = [read(&place, false).unwrap(), read(&alone, false).unwrap()];
    assert_eq!((split.case, split.mesh, split.notes), (alone.case, alone.mesh, alone.notes));
    // the card that includes
    assert_eq!(split.cards.used, alone.cards.used + 1);
}

#[test]
fn a_backslash_between_folders_leads_to_the_same_file() {
    let [main, nodes] = split("more\\nodes.k");
    let place = files(&[("decks/main.k", &main), ("decks/more/nodes.k", &nodes)]);
    assert!(read(&place, false).is_ok());
    let [main, _] = split("..\\nodes.k");
    let place = files(&[("decks/main.k", &main), ("nodes.k", &nodes)]);
    assert!(matches!(read(&place, false).unwrap_err().fault, Fault::Outside { .. }));
}

#[test]
fn a_file_that_includes_itself_is_refused_by_the_line_that_leads_back() {
    for (main, other, at, chain) in [
        ("*KEYWORD\n*INCLUDE\nmain.k\n", "", ("main.k", 3), "main.k includes main.k"),
        (
            "*KEYWORD\n*INCLUDE\nb.k\n",
            "$ back\n*INCLUDE\n$ name\n./main.k\n",
            ("b.k", 4),
            "main.k includes b.k includes main.k",
        ),
    ] {
        let place = files(&[("decks/main.k", main), ("decks/b.k", other)]);
        let error = read(&place, true).unwrap_err();
        assert!(matches!(error.fault, Fault::Cycle { .. }), "{error}");
        assert_eq!(place_of(&error), (at.0.to_owned(), at.1));
        assert!(error.to_string().ends_with(chain), "{error}");
    }
}

#[test]
fn files_outside_the_decks_folder_are_included_only_where_that_is_asked_for() {
    let [main, nodes] = split("../elsewhere/nodes.k");
    let place = files(&[("decks/main.k", &main), ("elsewhere/nodes.k", &nodes)]);
    let error = read(&place, false).unwrap_err();
    assert!(matches!(error.fault, Fault::Outside { .. }), "{error}");
    assert!(error.fault.remedy().contains("--include-outside"), "{}", error.fault.remedy());
    let line = 1 + main.lines().position(|line| line == "../elsewhere/nodes.k").unwrap();
    assert_eq!(place_of(&error), ("main.k".to_owned(), line));
    assert!(read(&place, true).is_ok());
}

#[test]
#[cfg(unix)]
fn a_link_does_not_lead_outside_the_decks_folder() {
    let [main, nodes] = split("nodes.k");
    let place = files(&[("decks/main.k", &main), ("elsewhere/nodes.k", &nodes)]);
    let link = place.path().join("decks/nodes.k");
    std::os::unix::fs::symlink(place.path().join("elsewhere/nodes.k"), link).unwrap();
    assert!(matches!(read(&place, false).unwrap_err().fault, Fault::Outside { .. }));
}

#[test]
fn an_included_file_that_is_not_there_is_refused_by_the_line_that_names_it() {
    let [main, _] = split("none.k");
    let error = read(&files(&[("decks/main.k", &main)]), false).unwrap_err();
    assert!(error.to_string().contains("none.k: there is no such file"), "{error}");
    let line = 1 + main.lines().position(|line| line == "none.k").unwrap();
    assert_eq!(place_of(&error), ("main.k".to_owned(), line));
}

#[test]
fn files_that_include_each_other_twice_and_twice_again_end_with_an_error() {
    let mut named = vec![("decks/main.k".to_owned(), "*INCLUDE\nf1.k\nf1.k\n".to_owned())];
    for i in 1..40 {
        let next = i + 1;
        let text = format!("*INCLUDE\nf{next}.k\nf{next}.k\n");
        named.push((format!("decks/f{i}.k"), text));
    }
    named.push(("decks/f40.k".to_owned(), "*TITLE\nend\n".to_owned()));
    let named: Vec<_> = named.iter().map(|(name, text)| (&name[..], &text[..])).collect();
    let error = read(&files(&named), false).unwrap_err();
    assert!(matches!(error.fault, Fault::Excess { .. }), "{error}");
}

#[test]
fn an_unknown_parameter_is_refused_by_its_line_in_the_included_file() {
    let [main, nodes] = split("nodes.k");
    let main = main.replacen("*TITLE", "*PARAMETER\nR  span, 3.0\n*TITLE", 1);
    let mut lines: Vec<&str> = nodes.lines().collect();
    // NODE, the names of its fields, the first node
    lines[2] = "1,0.0,&Width,50.0";
    let place = files(&[("decks/main.k", &main), ("decks/nodes.k", &lines.join("\n"))]);
    let error = read(&place, false).unwrap_err();
    assert!(matches!(&error.fault, Fault::Parameter { name } if name == "Width"), "{error}");
    assert_eq!(place_of(&error), ("nodes.k".to_owned(), 3));
    assert!(error.fault.remedy().contains("R Width, VALUE"), "{}", error.fault.remedy());
}

#[test]
fn a_parameter_is_a_number_that_is_given_once() {
    let [main, nodes] = split("nodes.k");
    let with = |card: &str| {
        let main = main.replacen("*TITLE", &format!("{card}\n*TITLE"), 1);
        let place = files(&[("decks/main.k", &main), ("decks/nodes.k", &nodes)]);
        read(&place, false).map(|_| ()).map_err(|error| error.to_string())
    };
    assert_eq!(with("*PARAMETER\nR  span, 3.0, I n, 4\nRhalf     &span"), Ok(()));
    for (card, words) in [
        ("*PARAMETER\nRspan,3.0\nRSPAN,4.0", "a second parameter `span`"),
        ("*PARAMETER\nCname,wheel", "whose type is neither R nor I"),
        ("*PARAMETER\nRspan", "needs a name and a value"),
        ("*PARAMETER\nRspan,wide", "`wide`"),
        ("*PARAMETER\nRspan,&span", "&span is not defined"),
        ("*PARAMETER_EXPRESSION\nRspan,2*3", "*PARAMETER_EXPRESSION is not read"),
    ] {
        let error = with(card).unwrap_err();
        assert!(error.contains(words), "{card}: {error}");
    }
}
