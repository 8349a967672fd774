//! From a keyword file to a case and its mesh.

use crate::case_file::{self, Settings};
use crate::deck::Deck;
use crate::model::Model;
use crate::units::Units;
use mesh::import::{ImportError, write_abaqus};

/// A keyword file as a case and a mesh file of Creepage.
#[derive(Clone, Debug, PartialEq)]
pub struct Translation {
    /// Text of the case file, in SI units.
    pub case: String,
    /// Text of the mesh file: an Abaqus input file in metres, with the numbers that nodes and elements have in the
    /// keyword file.
    pub mesh: String,
    /// Cards that were ignored, and choices that were made, one sentence each.
    pub notes: Vec<String>,
}

/// Translates a keyword file in consistent `units`. `title` is its name for the case's `title`; `mesh_file` is the
/// value of `mesh.file` in the case.
///
/// # Errors
/// A card or field that is not supported, with its line; a card that a disk on a bar needs and the file lacks.
pub fn translate(
    bytes: &[u8],
    units: Units,
    title: &str,
    mesh_file: &str,
) -> Result<Translation, ImportError> {
    let deck = Deck::read(bytes)?;
    let mut notes = deck.notes.clone();
    let mut model = Model::new(&deck, units)?;
    let shape = model.place(&mut notes);
    let settings = Settings::of(&deck, &model, &shape, units, &mut notes)?;
    let case = case_file::text(&settings, &shape, [title, mesh_file]);
    Ok(Translation { case, mesh: write_abaqus(&model.foreign), notes })
}
