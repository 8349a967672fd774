//! What `creepage sweep`, `plot` and `report` put beside the files of a run, and `--force` removes with it.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use serde_json::Value;

/// Folder of the figures.
const FIGURES: &str = "figures";

/// The figures of a run, each as SVG and PNG.
pub const FIGURE_NAMES: [&str; 8] = [
    "figure-1-velocities",
    "figure-2-stick-slip",
    "figure-3-tractions",
    "figure-4-bound",
    "figure-7-law",
    "space-time",
    "histories",
    "spectrum",
];

/// Tells by the beginning of a file whether this program wrote it.
type Ours = fn(&[u8]) -> bool;

/// Bytes of a file that are looked at; a check is far shorter.
const BEGINNING: u64 = 1 << 20;

/// Every file that may be there.
fn files() -> Vec<(PathBuf, Ours)> {
    let mut files: Vec<(PathBuf, Ours)> = vec![
        ("check.json".into(), is_check),
        ("check.json.partial".into(), |_| true),
        ("report.html".into(), is_page),
    ];
    for name in FIGURE_NAMES {
        let place = |extension| Path::new(FIGURES).join(format!("{name}.{extension}"));
        files.push((place("svg"), is_svg));
        files.push((place("png"), |bytes| bytes.starts_with(b"\x89PNG\r\n")));
    }
    files
}

fn has(bytes: &[u8], words: &str) -> bool {
    bytes.windows(words.len()).any(|part| part == words.as_bytes())
}

fn is_check(bytes: &[u8]) -> bool {
    let found = serde_json::from_slice::<Value>(bytes);
    found.is_ok_and(|check| check["metrics"].is_object() && !check["limits_for"].is_null())
}

fn is_page(bytes: &[u8]) -> bool {
    let bytes = &bytes[..bytes.len().min(1024)];
    bytes.starts_with(b"<!DOCTYPE html>") && has(bytes, "<link rel=\"icon\" href=\"data:,\">")
}

fn is_svg(bytes: &[u8]) -> bool {
    let bytes = &bytes[..bytes.len().min(1024)];
    bytes.starts_with(b"<svg") && has(bytes, "@font-face")
}

/// Removes these files from `folder`, and the folder of figures if nothing is left in it. What does not look
/// like the program's own work stays.
pub(crate) fn remove(folder: &Path) -> io::Result<()> {
    for (name, is_ours) in files() {
        let path = folder.join(name);
        let mut bytes = Vec::new();
        match File::open(&path) {
            Ok(file) => file.take(BEGINNING).read_to_end(&mut bytes)?,
            Err(_) => continue,
        };
        if is_ours(&bytes) {
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
            ("figures/own.png", "\u{89}PNG"),
        ];
        for (name, text) in foreign {
            fs::write(at(name), text).unwrap();
        }
        let png = at("figures/space-time.png");
        fs::write(&png, b"\x89PNG\r\n\x1a\n").unwrap();
        remove(folder.path()).unwrap();
        assert!(!png.exists());
        for (name, text) in foreign {
            assert_eq!(fs::read_to_string(at(name)).unwrap(), text, "{name}");
        }
    }
}
