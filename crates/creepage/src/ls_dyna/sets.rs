//! Sets, and cards that hold them.

use crate::ls_dyna::cards::Card;
use crate::ls_dyna::deck::{Deck, Target};
use crate::ls_dyna::error::{DeckError, unsupported};
use crate::ls_dyna::fields::{Field, Layout, absent, number, rests, says, whole, zero};

/// The head of a set. Its attributes are factors of friction where it is a side of the contact.
const HEAD: Layout<1> = Layout::new(&[
    number("SID"),
    zero("DA1"),
    zero("DA2"),
    zero("DA3"),
    zero("DA4"),
    says("SOLVER", &["MECH"]),
    rests("ITS", &[1.0]),
    zero("unused"),
]);

const MEMBER: Field = number("a member");
const MEMBERS: Layout<8> = Layout::new(&[MEMBER; 8]);

const SEGMENT: Layout<4> = Layout::new(&[
    number("N1"),
    number("N2"),
    number("N3"),
    number("N4"),
    zero("A1"),
    zero("A2"),
    zero("A3"),
    zero("A4"),
]);

const HELD: Layout<5> = Layout::new(&[
    number("NSID or NID"),
    whole("CID"),
    whole("DOFX"),
    whole("DOFY"),
    whole("DOFZ"),
    absent("DOFRX"),
    absent("DOFRY"),
    absent("DOFRZ"),
]);

const NON_REFLECTING: Layout<1> = Layout::new(&[number("SSID"), zero("AD"), zero("AS")]);

impl Deck {
    /// Takes a set, or a card that holds one; whether it is one.
    pub(super) fn set_card(&mut self, card: &Card) -> Result<bool, DeckError> {
        match card.name.as_str() {
            "SET_NODE" | "SET_NODE_LIST" => {
                let id = self.head(card, "node set")?;
                self.node_sets.insert(id, members(card)?);
            }
            "SET_PART" | "SET_PART_LIST" => {
                let id = self.head(card, "part set")?;
                self.part_sets.insert(id, members(card)?);
            }
            "SET_SEGMENT" => {
                let id = self.head(card, "segment set")?;
                let segments = card.further_lines().map(|line| line.take(&SEGMENT));
                let ids = segments.map(|nodes| Ok(nodes?.map(|id| id as u64)));
                self.segment_sets.insert(id, ids.collect::<Result<_, DeckError>>()?);
            }
            "BOUNDARY_SPC_SET" | "BOUNDARY_SPC_NODE" => self.clamp(card)?,
            "BOUNDARY_NON_REFLECTING" => {
                for line in card.lines() {
                    let [id] = line.take(&NON_REFLECTING)?;
                    self.quiet.push(Target { set: true, id: id as u64, place: line.place() });
                }
            }
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// The number of a set, which must be the first of its kind.
    fn head(&mut self, card: &Card, kind: &'static str) -> Result<u64, DeckError> {
        let line = card.line(0)?;
        let [id] = line.take(&HEAD)?;
        self.first(kind, id as u64, &line.place())?;
        Ok(id as u64)
    }

    fn clamp(&mut self, card: &Card) -> Result<(), DeckError> {
        for line in card.lines() {
            let [id, system, fixed @ ..] = line.take(&HELD)?;
            let set = card.name.ends_with("SET");
            let target = Target { set, id: id as u64, place: line.place() };
            match (system, fixed) {
                (0.0, [0.0, 1.0, 0.0]) => self.sliding.push(target),
                (0.0, [1.0, 1.0, 1.0]) => self.clamped.push(target),
                _ => {
                    let fixed = fixed.map(|held| held as i64);
                    let what = format!("*{} with DOFX, DOFY, DOFZ = {fixed:?}", card.name);
                    let remedy = "clamp the bar in x, y and z, and hold a plane of symmetry in y alone, in the global system";
                    return Err(unsupported(&line.place(), what, remedy));
                }
            }
        }
        Ok(())
    }
}

/// The members of a set of nodes or parts.
fn members(card: &Card) -> Result<Vec<u64>, DeckError> {
    let mut members = Vec::new();
    for line in card.further_lines() {
        let ids = line.take(&MEMBERS)?.map(|id| id as u64);
        members.extend(ids.into_iter().filter(|id| *id > 0));
    }
    Ok(members)
}
