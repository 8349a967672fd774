//! From a keyword file to a case and its mesh.

use crate::case_file::{self, Settings};
use crate::deck::Deck;
use crate::model::Model;
use crate::units::Units;
use mesh::import::{ImportError, write_abaqus};

/// A keyword file as Creepage takes it.
#[derive(Clone, Debug, PartialEq)]
pub struct Translation {
    /// The case file.
    pub case: String,
    /// The mesh file, an Abaqus input file in metres with the nodes' and elements' own numbers.
    pub mesh: String,
    /// What was passed over or decided, a sentence each.
    pub notes: Vec<String>,
}

/// Translates a keyword file; `title` names it, `mesh_file` is the mesh file's name in the case.
///
/// # Errors
/// What is not read, by its line, and what a disk on a bar lacks.
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
