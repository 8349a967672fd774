//! The files that a command wrote, a line each.

use std::fmt::Write;

use creepage::check::Imported;
use creepage::ls_dyna::Account;
use creepage::{
    CasesFound, Drawn, ExportedK, ImportedContact, ImportedInp, ImportedK, Reported, Viewed,
};

/// The reference cases of `cases`, or the files of their copies.
pub fn cases(CasesFound { cases, files }: &CasesFound) -> String {
    if !files.is_empty() {
        return files.join("\n") + "\n";
    }
    let width = cases.iter().map(|case| case.name.len()).max().unwrap_or(0);
    let mut page = String::new();
    for command in ["run", "sweep"] {
        let _ = writeln!(page, "creepage {command} NAME");
        for case in cases.iter().filter(|case| case.command == command) {
            let _ = writeln!(page, "  {:<width$}  {}", case.name, case.title);
        }
    }
    page
}

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
pub fn view(viewed: &Viewed) -> String {
    format!("{}\n", viewed.page.display())
}

/// The contact history of `import-contact`.
pub fn contact_history(ImportedContact { file, size }: &ImportedContact) -> String {
    let Imported { nodes, faces, steps, .. } = size;
    format!("{}: {nodes} nodes, {faces} faces, {steps} records\n", file.display())
}

/// The case of `import-k`, and what the keyword file lost.
pub fn case(ImportedK { case, elements, notes, cards, .. }: &ImportedK) -> String {
    let mut page = String::new();
    for note in notes {
        let _ = writeln!(page, "  {note}");
    }
    let Account { used, ignored, .. } = cards;
    let _ = writeln!(
        page,
        "  cards: {used} used, {ignored} ignored (docs/ls-dyna.md lists which), none refused"
    );
    let case = case.display().to_string();
    let quoted = creepage::sweep::plan::quoted(&case);
    page + &format!("{case}: {elements} elements; creepage run {quoted}\n")
}

/// The case files of `import-inp`.
pub fn inp_cases(ImportedInp { cases }: &ImportedInp) -> String {
    cases.iter().map(|case| format!("{case}\n")).collect()
}

/// The keyword file of `export-k`, and what it says in another way than the case.
pub fn deck(ExportedK { file, unit, nodes, elements, notes, .. }: &ExportedK) -> String {
    let mut page = String::new();
    for note in notes {
        let _ = writeln!(page, "  nearly: {note}");
    }
    page + &format!("{}: {nodes} nodes, {elements} elements, in {unit}\n", file.display())
}
