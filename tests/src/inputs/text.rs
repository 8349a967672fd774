//! Inputs that are text.

use std::cell::RefCell;
use std::fs;
use std::hint::black_box;
use std::path::{Path, PathBuf};

use creepage::case::Case;
use creepage::sweep::Sweep;
use friction::{Domain, Expression, FrictionLaw, NodeConditions};
use tempfile::TempDir;

/// A case file, from its text to the resolved case and to the file that a run writes of it.
pub fn case(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let path = Path::new("nowhere/case.toml");
    match Case::from_text(text, path, &[]) {
        Ok(case) => {
            black_box((case.hash(), case.warnings()));
            let again = Case::from_text(&case.to_toml(), path, &[]);
            assert!(again.is_ok_and(|again| again == case), "a resolved case reads back as itself");
        }
        Err(error) => told(&error),
    }
    // the same text as an option
    black_box(Case::from_text(SMALL, path, &[text.to_owned()]).is_ok());
}

/// A sweep file over a small base case, up to the cases of its runs.
pub fn sweep(data: &[u8]) {
    in_a_folder(|folder| {
        let path = folder.join("sweep.toml");
        write(&folder.join("base.toml"), SMALL.as_bytes());
        write(&path, data);
        match Sweep::load(&path) {
            // many runs take long, and are the same again
            Ok(sweep) if sweep.axes.iter().map(|axis| axis.values.len()).product::<usize>() < 9 => {
                match sweep.points() {
                    Ok(points) => drop(black_box(sweep.hash(&points))),
                    Err(error) => told(&error),
                }
            }
            Ok(_) => {}
            Err(error) => told(&error),
        }
    });
}

/// A formula of friction, with the place of a node and without it, at many slip speeds.
pub fn formula(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else { return };
    let domain = Domain { pressure: 2e9, duration: 1e-3, along: [-0.03, 0.05] };
    for law in [Expression::new(text), Expression::over(text, &domain)] {
        match law {
            Ok(law) => {
                for i in -40..40 {
                    let s = 10f64.powi(i);
                    let at = NodeConditions { position: [s, -s, 0.0], time: s, pressure: 1e9 * s };
                    for mu in [law.mu(s), law.mu_at(s, &at)] {
                        assert!(mu.is_nan() || (mu >= 0.0 && mu.is_finite()), "mu = {mu}");
                    }
                    black_box(law.slope_at(s, &at));
                }
            }
            Err(error) => drop(black_box(error.to_string())),
        }
    }
}

/// A friction table in a file that a case names.
pub fn table(data: &[u8]) {
    in_a_folder(|folder| {
        write(&folder.join("table.csv"), data);
        let text = format!("{SMALL}\nlaw = \"table\"\ntable = \"table.csv\"\n");
        let text = text.replace("static = 0.5\n", "");
        match Case::from_text(&text, &folder.join("case.toml"), &[]) {
            Ok(case) => drop(black_box(case.to_toml())),
            Err(error) => told(&error),
        }
    });
}

/// A case of four lines.
const SMALL: &str = "[load]\nnormal = 100e3\n[drive]\nspeed = 38.89\ncreepage = 2.4e-3\n\
                     [friction]\nstatic = 0.5\n";

/// The message for people, with its excerpt of the text.
pub(crate) fn told(error: &dyn miette::Diagnostic) {
    let mut text = String::new();
    let _ = miette::GraphicalReportHandler::new_themed(miette::GraphicalTheme::unicode_nocolor())
        .render_report(&mut text, error);
    black_box(text);
}

pub(crate) fn write(path: &Path, data: &[u8]) {
    // without room on the disk there is nothing to be found out
    let _ = fs::write(path, data);
}

/// A folder of this thread that lives as long as it.
pub(crate) fn in_a_folder(read: impl FnOnce(&Path)) {
    thread_local!(static FOLDER: RefCell<Option<TempDir>> = const { RefCell::new(None) });
    let path = FOLDER.with(|folder| -> Option<PathBuf> {
        let mut folder = folder.borrow_mut();
        if folder.is_none() {
            *folder = tempfile::tempdir().ok();
        }
        folder.as_ref().map(|folder| folder.path().to_path_buf())
    });
    if let Some(path) = path {
        read(&path);
    }
}

/// The three tables of `import-contact` with a zero byte between, up to the contact history made of them.
pub fn import(data: &[u8]) {
    in_a_folder(|folder| {
        let mut tables = data.splitn(3, |&byte| byte == 0);
        let paths = ["nodes.csv", "faces.csv", "values.csv"].map(|name| folder.join(name));
        for path in &paths {
            write(path, tables.next().unwrap_or_default());
        }
        let [nodes, faces, values] = paths;
        let out = folder.join("imported.vtkhdf");
        let options = creepage::ImportContactOptions { nodes, faces, values, out };
        match creepage::check::import_contact(&options) {
            Ok(_) => {
                let made = output::GridFile::open(&options.out);
                assert!(made.is_ok(), "what was made can be read");
            }
            Err(error) => drop(black_box(error.to_string())),
        }
    });
}
