//! A profile in a file of its own, and how its points are read into the case.

use mesh::profile::{Profile, ProfileBody, STANDARD_PROFILES, read_profile, smoothed};
use output::files::input;
use std::path::Path;
use toml::Value;

use crate::case::error::CaseError;
use crate::case::layers::Layers;
use crate::case::value::{get, listed};

/// Sections with a profile, whose it is, and the file's usual ending.
const PROFILES: [(&str, ProfileBody, &str); 2] =
    [("disk", ProfileBody::Wheel, ".prw"), ("bar", ProfileBody::Rail, ".prr")];

/// Replaces a path in `disk.profile` and `bar.profile` by the points of that file (m). The path is relative to the case file
/// that holds it; of an option, to the working directory.
///
/// # Errors
/// A file that cannot be read, or is no profile of that body.
pub fn inline(layers: &mut Layers) -> Result<(), CaseError> {
    for (section, body, ending) in PROFILES {
        let key = format!("{section}.profile");
        name_of_number(layers, section);
        let shown = get(&layers.table, &key).and_then(Value::as_str).unwrap_or_default().to_owned();
        let Some(path) = layers.file_at(&key) else { continue };
        if STANDARD_PROFILES.contains(&shown.as_str()) {
            continue;
        }
        let text = input::text(&path, input::PROFILE).map_err(|error| {
            let (_, relative) = layers.places.folder_of(&key);
            let problem = format!("\"{shown}\": {}: {}", path.display(), error.problem());
            let remedy = format!(
                "give the path of a {ending} file or of two columns in mm, {relative}, or one of \"{}\"",
                STANDARD_PROFILES.join("\" and \"")
            );
            layers.error(&key, &problem, &remedy)
        })?;
        let points = read_profile(&text, body).map_err(|error| {
            let problem = format!("\"{shown}\": {}: {error}", path.display());
            layers.error(
                &key,
                &problem,
                "correct the file: two columns y and z in mm, y rising, z down",
            )
        })?;
        if let Some(Value::Table(table)) = layers.table.get_mut(section) {
            table.insert("profile".into(), listed(&points));
        }
    }
    Ok(())
}

/// `--set bar.profile=60E1` without quotes is the number 60e1 of TOML.
fn name_of_number(layers: &mut Layers, section: &str) {
    if let Some(Value::Table(table)) = layers.table.get_mut(section)
        && table.get("profile") == Some(&Value::Float(600.0))
    {
        table.insert("profile".into(), STANDARD_PROFILES[0].into());
    }
}

/// The profile of a file.
///
/// # Errors
/// What is wrong with a file that cannot be read, or is no profile of that body.
pub(crate) fn profile_at(path: &Path, body: ProfileBody) -> Result<Profile, String> {
    let named = |problem: String| format!("{}: {problem}", path.display());
    let text = input::text(path, input::PROFILE).map_err(|error| named(error.problem()))?;
    let points = read_profile(&text, body).map_err(|error| named(error.to_string()))?;
    smoothed(&points).map_err(|error| named(error.to_string()))
}
