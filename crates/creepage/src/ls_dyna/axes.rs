//! Whether a model stands in the frame of a case: x the rolling direction, y along the axle, z up.

use std::collections::BTreeSet;

use mesh::geometry::hull;
use nalgebra::Vector3;

use crate::ls_dyna::deck::Deck;
use crate::ls_dyna::error::{DeckError, Fault};

const NAMES: [&str; 3] = ["x", "y", "z"];

/// Refuses a model whose disk does not lie above the bar in z, or whose axle does not lie along y. `points` are those
/// of the mesh, `nodes` those of disk and bar.
///
/// # Errors
/// Another frame, with what in the deck shows it.
pub(crate) fn check_frame(
    deck: &Deck,
    points: &[Vector3<f64>],
    nodes: &[BTreeSet<u32>; 2],
) -> Result<(), DeckError> {
    let [disk, bar] = nodes.each_ref().map(|body| hull(body.iter().map(|n| &points[*n as usize])));
    let size = |a: usize| disk[1][a] - disk[0][a];
    // how far the bodies are apart along an axis; below 0 how far they overlap
    let apart = |a: usize| (disk[0][a] - bar[1][a]).max(bar[0][a] - disk[1][a]);
    let beyond = |a: usize| disk[0][a] + disk[1][a] > bar[0][a] + bar[1][a];
    // bodies in contact meet along one axis and overlap along the others
    let vertical =
        (0..3).find(|a| apart(*a) > -MEETING * size(*a)).filter(|_| apart(2) < -OVERLAP * size(2));
    let what = match vertical {
        Some(axis) => format!("its vertical axis is {}", NAMES[axis]),
        None if !beyond(2) && apart(2) > -MEETING * size(2) => "its vertical axis is -z".into(),
        None if is_round(size(1), size(2)) && !is_round(size(0), size(2)) => {
            "its axle lies along x".into()
        }
        None => return Ok(()),
    };
    let mut shown = Vec::new();
    let axis = vertical.unwrap_or(2);
    let sign = if beyond(axis) { "+" } else { "-" };
    shown.push(format!("the disk lies in {sign}{} of the bar", NAMES[axis]));
    if vertical.is_none() {
        shown.push(format!("the disk is {:.4e} by {:.4e} by {:.4e} m", size(0), size(1), size(2)));
    }
    let acts = deck.loads.iter().find(|load| matches!(load.dof, 1..=3));
    if let Some(load) = acts {
        shown.push(format!("*{} acts along {}", load.card, NAMES[load.dof as usize - 1]));
    }
    if let Some(turn) = deck.initial.as_ref().and_then(|initial| initial.turn.as_ref()) {
        let [nx, ny, nz] = turn.axis;
        shown.push(format!("the disk turns about the axis ({nx}, {ny}, {nz})"));
    }
    Err(DeckError::of(Fault::Axes { what, shown: shown.join(", ") }))
}

/// Bodies that meet along an axis overlap by less than this share of the disk's size.
const MEETING: f64 = 0.05;
/// Bodies that overlap by more than this share are side by side along another axis.
const OVERLAP: f64 = 0.4;

/// Whether two sizes are those of a circle.
fn is_round(a: f64, b: f64) -> bool {
    (a - b).abs() < 0.01 * b
}
