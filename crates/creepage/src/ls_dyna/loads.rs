//! What presses and turns the hub: forces in z, and a torque about the axle.

use std::collections::BTreeSet;

use mesh::import::Foreign;

use crate::ls_dyna::cards::six;
use crate::ls_dyna::deck::{Deck, Load, Loaded};
use crate::ls_dyna::error::{DeckError, lacks, second, unknown, unsupported};
use crate::ls_dyna::model::Model;
use crate::ls_dyna::units::Units;

impl Load {
    /// Whether it acts on the rigid hub: on its part, or on the node by which it is loaded.
    fn on_hub(&self, deck: &Deck) -> bool {
        match &self.on {
            Loaded::Rigid(_) => true,
            Loaded::Nodes(target) => !target.set && deck.axle == Some(target.id),
        }
    }
}

/// Refuses loads of other parts than the hub, and along or about other axes than a case has.
///
/// # Errors
/// Such a load, with its line.
pub(crate) fn kinds(deck: &Deck) -> Result<(), DeckError> {
    for load in &deck.loads {
        if let Loaded::Rigid(part) = load.on {
            deck.of_the_hub(&load.card, part, &load.place)?;
        }
        if !(load.dof == 3 || load.dof == 6 && load.on_hub(deck)) {
            let what = format!("*{} with DOF = {}", load.card, load.dof);
            let remedy = "load the hub in z, which points up (DOF = 3), and turn it about y, the axle (DOF = 6), at its PNODE";
            return Err(unsupported(&load.place, what, remedy));
        }
    }
    Ok(())
}

/// The torque about the axle, if there is one.
///
/// # Errors
/// A second one.
pub(crate) fn torque(deck: &Deck) -> Result<Option<&Load>, DeckError> {
    let mut torques = deck.loads.iter().filter(|load| load.dof == 6);
    let (first, another) = (torques.next(), torques.next());
    if let (Some(first), Some(another)) = (first, another) {
        let remedy = "put both into one curve: a case has one torque";
        return Err(second(&another.place, "torque", &first.place, remedy));
    }
    Ok(first)
}

/// The force that presses the disk down (N): the sum over the loaded nodes and that on the hub, by the values of their
/// curves at the end; loads that reach it while the disk rolls go into `notes`.
///
/// # Errors
/// A load that does not press down, falls again, or changes up to the end; nodes that are not the hub's.
pub(crate) fn normal(
    deck: &Deck,
    model: &Model,
    units: Units,
    notes: &mut Vec<String>,
) -> Result<f64, DeckError> {
    let Foreign { nodes, sets, .. } = &model.foreign;
    let hub: BTreeSet<u64> = sets["hub"].nodes.iter().map(|n| nodes.ids[*n as usize]).collect();
    let mut sum = 0.0;
    for load in deck.loads.iter().filter(|load| load.dof == 3) {
        let nodes = match &load.on {
            _ if load.on_hub(deck) => 1,
            Loaded::Rigid(_) => 1,
            Loaded::Nodes(target) => {
                let unknown = |what: String| unknown(&load.place, "the load", what);
                let nodes = match deck.node_sets.get(&target.id) {
                    _ if !target.set => vec![target.id],
                    Some(set) => set.clone(),
                    None => return Err(unknown(format!("node set {}", target.id))),
                };
                if let Some(id) = nodes.iter().find(|id| !hub.contains(id)) {
                    return Err(unknown(format!("node {id} of the hub")));
                }
                nodes.len()
            }
        };
        let course = deck.course(load.curve, &load.place)?;
        let goes_on = course.goes_on || course.changes >= deck.rolls()?;
        if goes_on || !course.ramps_from(0.0) {
            let (curve, last) = (load.curve, six(course.last));
            let what = if goes_on {
                format!(
                    "a load that still changes at ENDTIM, where its curve {curve} is at {last},"
                )
            } else {
                format!(
                    "a load that falls again, as its curve {curve} does before it is at {last},"
                )
            };
            let remedy =
                "let it rise before the disk rolls, or as it begins, and stay: a case has one load";
            return Err(unsupported(&load.place, what, remedy));
        }
        if course.changes > 0.0 && !course.is_constant() {
            notes.push(format!(
                "the load of curve {} rises for {:.3e} s while the disk rolls: the case begins with the whole load",
                load.curve,
                course.changes * units.time()
            ));
        }
        sum += load.factor * course.last * nodes as f64;
    }
    if sum >= 0.0 {
        return Err(lacks("*LOAD_NODE_SET or *LOAD_RIGID_BODY that presses the disk down, in -z"));
    }
    Ok(-model.alike() * sum * units.force())
}
