//! The scene of a run as an element of a page, with what draws it: nothing is loaded from elsewhere.

use super::escape;
use crate::scene::{Scene, SceneError};
use std::fmt::Write;
use std::path::Path;

const STYLE: &str = include_str!("scene/scene.css");
const THREE: &str = include_str!("scene/three.iife.min.js");
const OURS: [&str; 3] = [
    include_str!("scene/parts.js"),
    include_str!("scene/controls.js"),
    include_str!("scene/scene.js"),
];

/// The scene of the run in `folder` with its still picture, its style and its scripts.
///
/// # Errors
/// A scene that cannot be read.
pub(super) fn element(folder: &Path) -> Result<String, SceneError> {
    let scene = Scene::read(folder)?;
    let still = scene.still.svg_element()?.replacen("<svg", "<svg class=\"still\"", 1);
    let mut out = format!(
        "<style>{STYLE}</style>\n<figure class=\"scene\" aria-label=\"Both bodies in three dimensions\">{still}\n\
         <script type=\"application/json\" class=\"scene-data\">{}</script></figure>\n<script>{THREE}</script>\n",
        scene.script()
    );
    for script in OURS {
        let _ = writeln!(out, "<script>\n{script}</script>");
    }
    Ok(out)
}

/// The scene of the run in `folder`; why there is none where it cannot be drawn, and nothing where the run has no records
/// of its bodies.
pub(super) fn section(folder: &Path) -> String {
    match element(folder) {
        Ok(element) => element,
        Err(SceneError::NoFile { .. } | SceneError::NoRecord(_)) => String::new(),
        Err(error) => {
            format!("<p class=\"note\">No picture: {}.</p>\n", escape(&error.to_string()))
        }
    }
}
