//! The font of all figures.

use base64::Engine;
use plotters::style::{FontStyle, register_font};
use std::sync::OnceLock;

/// Name of the font in figures.
pub(crate) const NAME: &str = "DejaVu Sans";

/// DejaVu Sans with the characters that figures use; its licence is beside it.
pub(crate) static BYTES: &[u8] = include_bytes!("../../font/DejaVuSans-subset.ttf");

/// Makes the font known to the drawing library; false if that failed.
pub(crate) fn register() -> bool {
    static DONE: OnceLock<bool> = OnceLock::new();
    *DONE.get_or_init(|| register_font(NAME, FontStyle::Normal, BYTES).is_ok())
}

/// A style sheet that carries the font inside an SVG file.
pub(crate) fn style_sheet() -> String {
    let data = base64::engine::general_purpose::STANDARD.encode(BYTES);
    format!(
        "<style>@font-face{{font-family:\"{NAME}\";src:url(data:font/ttf;base64,{data})}}\
         {CRISP}</style>\n"
    )
}

/// The CSS rule by which neighbouring cells meet without a seam.
pub(crate) const CRISP: &str = "rect{shape-rendering:crispEdges}";

/// The CSS rules of the figures without a `<style>` tag: their font and how cells meet. A page that holds
/// figures of [`Figure::svg_element`](crate::chart::Figure::svg_element) needs them once.
pub fn font_face() -> String {
    style_sheet().replacen("<style>", "", 1).replacen("</style>", "", 1)
}
