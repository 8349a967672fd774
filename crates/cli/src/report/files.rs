//! The files that a command wrote, a line each.

use std::fmt::Write;

use creepage::{Drawn, Reported};
use serde_json::Value;

use super::layout::text as word;

/// The figures of `plot`.
pub fn figures(drawn: &Drawn) -> String {
    let mut page = String::new();
    for figure in &drawn.figures {
        let line = format!("{}  {}", figure.files.join(", "), figure.about);
        let _ = writeln!(page, "{}", line.trim_end());
    }
    page
}

/// The page of `report`.
pub fn report(reported: &Reported) -> String {
    format!("{}\n", reported.page.display())
}

/// The page of `view`.
pub fn page(document: &Value) -> String {
    format!("{}\n", word(document, "/page"))
}

/// The contact history of `import-contact`.
pub fn contact_history(document: &Value) -> String {
    let [nodes, faces, steps] = ["nodes", "faces", "steps"].map(|key| &document[key]);
    format!("{}: {nodes} nodes, {faces} faces, {steps} records\n", word(document, "/file"))
}

/// The case of `import-k`, and what the keyword file lost.
pub fn case(document: &Value) -> String {
    let mut page = String::new();
    for note in document["notes"].as_array().into_iter().flatten().filter_map(Value::as_str) {
        let _ = writeln!(page, "  {note}");
    }
    let [used, ignored] = ["used", "ignored"].map(|fate| &document["cards"][fate]);
    let _ = writeln!(
        page,
        "  cards: {used} used, {ignored} ignored (docs/ls-dyna.md lists which), none refused"
    );
    let (case, elements) = (word(document, "/case"), &document["elements"]);
    page + &format!(
        "{case}: {elements} elements; creepage run {}\n",
        creepage::sweep::plan::quoted(case)
    )
}

/// The keyword file of `export-k`, and what it says in another way than the case.
pub fn deck(document: &Value) -> String {
    let mut page = String::new();
    for note in document["notes"].as_array().into_iter().flatten().filter_map(Value::as_str) {
        let _ = writeln!(page, "  nearly: {note}");
    }
    let [nodes, elements] = ["nodes", "elements"].map(|key| &document[key]);
    let [file, unit] = ["/file", "/unit"].map(|key| word(document, key));
    page + &format!("{file}: {nodes} nodes, {elements} elements, in {unit}\n")
}
