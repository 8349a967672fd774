//! The files that `creepage sweep`, `plot`, `render` and `report` write beside those of a run; `--force` removes them with it.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use output::files::input;
use output::files::made::{PAGE, PDF, PNG, SVG, wrote};
use output::layout::file;
use serde::Deserialize;
use serde::de::IgnoredAny;
use std::collections::BTreeMap;

/// Folder of the figures.
const FIGURES: &str = "figures";

/// The figures of a run, each as SVG, PDF or PNG.
pub const FIGURE_NAMES: [&str; 11] = [
    "figure-1-velocities",
    "figure-2-stick-slip",
    "figure-3-tractions",
    "figure-4-bound",
    "figure-7-law",
    "space-time",
    "contact-maps",
    "stress-section",
    "stress-depth",
    "histories",
    "spectrum",
];

/// Whether a file is this program's work.
type Ours = fn(&Path) -> bool;

/// Every file that may be there.
fn files() -> Vec<(PathBuf, Ours)> {
    let mut files: Vec<(PathBuf, Ours)> = vec![
        ("check.json".into(), is_check),
        ("check.json.partial".into(), |_| true),
        (file::REFERENCE.into(), is_reference),
        ("report.html".into(), |path| wrote(path, &PAGE).unwrap_or(false)),
        ("render.png".into(), |path| wrote(path, &PNG).unwrap_or(false)),
        ("render-contact.png".into(), |path| wrote(path, &PNG).unwrap_or(false)),
    ];
    for name in FIGURE_NAMES {
        let place = |extension| Path::new(FIGURES).join(format!("{name}.{extension}"));
        files.push((place("svg"), |path| wrote(path, &SVG).unwrap_or(false)));
        files.push((place("pdf"), |path| wrote(path, &PDF).unwrap_or(false)));
        files.push((place("png"), |path| wrote(path, &PNG).unwrap_or(false)));
    }
    files
}

/// What tells the results of a check from other files.
#[derive(Deserialize)]
struct Check {
    #[serde(rename = "metrics")]
    _metrics: BTreeMap<String, IgnoredAny>,
    #[serde(rename = "limits_for")]
    _limits_for: String,
}

fn is_check(path: &Path) -> bool {
    let bytes = input::bytes(path, input::DOCUMENT).unwrap_or_default();
    serde_json::from_slice::<Check>(&bytes).is_ok()
}

/// What tells a reference from other files.
#[derive(Deserialize)]
struct Reference {
    #[serde(rename = "of")]
    _of: BTreeMap<String, IgnoredAny>,
    #[serde(rename = "centreline")]
    _centreline: IgnoredAny,
}

fn is_reference(path: &Path) -> bool {
    let bytes = input::bytes(path, input::DOCUMENT).unwrap_or_default();
    serde_json::from_slice::<Reference>(&bytes).is_ok()
}

/// Removes these files from `folder`, and the folder of figures if nothing is left in it. What does not look
/// like the program's own work stays.
pub(crate) fn remove(folder: &Path) -> io::Result<()> {
    for (name, is_ours) in files() {
        let path = folder.join(name);
        if path.is_file() && is_ours(&path) {
            fs::remove_file(&path)?;
        }
    }
    // fails where there is none, or something in it
    let _ = fs::remove_dir(folder.join(FIGURES));
    Ok(())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    #[test]
    fn what_the_program_wrote_goes_and_what_others_wrote_under_its_names_stays() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at(FIGURES)).unwrap();
        let foreign = [
            ("check.json", "{\"notes\": 1}"),
            ("report.html", "<!DOCTYPE html><title>mine</title>"),
            ("figures/histories.svg", "<svg><!-- drawn by hand --></svg>"),
            ("render.png", "a photograph"),
            ("figures/own.png", "\u{89}PNG"),
        ];
        for (name, text) in foreign {
            fs::write(at(name), text).unwrap();
        }
        let png = at("figures/space-time.png");
        let chunk = [b"\x89PNG\r\n\x1a\n", output::files::made::PNG_MARK].concat();
        fs::write(&png, chunk).unwrap();
        remove(folder.path()).unwrap();
        assert!(!png.exists());
        for (name, text) in foreign {
            assert_eq!(fs::read_to_string(at(name)).unwrap(), text, "{name}");
        }
    }
}
