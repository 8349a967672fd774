//! From a keyword file to a case and its mesh.

use crate::ls_dyna::case_file::{self, Settings};
use crate::ls_dyna::deck::{Account, Deck};
use crate::ls_dyna::error::{DeckError, Fault};
use crate::ls_dyna::model::Model;
use crate::ls_dyna::parameters::Parameters;
use crate::ls_dyna::sources::{Source, Sources};
use crate::ls_dyna::units::Units;
use mesh::import::write_abaqus;

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
    /// What became of the cards.
    pub cards: Account,
}

/// Translates a deck in consistent `units`. `mesh_file` is the value of `mesh.file` in the case.
///
/// # Errors
/// A file that cannot be read or must not be included; a card or field that is not supported, with its line; a card
/// that a disk on a bar needs and the deck lacks.
pub fn translate(source: &Source, units: Units, mesh_file: &str) -> Result<Translation, DeckError> {
    let sources = Sources::read(source)?;
    let cards = sources.cards()?;
    let parameters = Parameters::of(&cards)?;
    let cards: Vec<_> = cards.into_iter().map(|card| card.with(&parameters)).collect();
    let deck = Deck::read(&cards)?;
    deck.names(units)?;
    let mut notes = Vec::new();
    if !deck.passed_over.is_empty() {
        let list = deck.passed_over.join(", ");
        notes.push(format!("passed over: {list}; the case has its own method and output"));
    }
    for place in &deck.after_end {
        notes.push(format!("{place}: what follows *END is not read, as in LS-DYNA"));
    }
    let mut model = Model::new(&deck, units)?;
    let shape = model.place(&mut notes);
    let settings = Settings::of(&deck, &model, &shape, units, &mut notes)?;
    let title = source.file.file_name().unwrap_or_default().to_string_lossy();
    let case = case_file::text(&settings, &shape, [&title, mesh_file]);
    Ok(Translation { case, mesh: write_abaqus(&model.foreign), notes, cards: deck.account })
}

impl Deck {
    /// Refuses units other than those that the deck itself names.
    pub(super) fn names(&self, units: Units) -> Result<(), DeckError> {
        let Some((place, [length, mass, time])) = &self.units else { return Ok(()) };
        if units.names() == [*length, *mass, *time] {
            return Ok(());
        }
        let fitting = format!("{length}-{mass}-{time}");
        let given = units.name();
        let what = format!("{given} is not that of the deck: its *CONTROL_UNITS names {fitting}");
        Err(Fault::Unit { what, fitting }.at(place))
    }
}
