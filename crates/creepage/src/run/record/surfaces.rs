//! Both contact surfaces as a run records them, and the file that holds them.

use super::basis::RecordBasis;
use super::images::Images;
use crate::case::schema::{Case, Rows};
use crate::run::error::RunError;
use crate::scenario::{BAR, DISK};
use contact::NodalContact;
use nalgebra::Vector3;
use output::layout::{BODY_NAMES, CONTACT, MORTAR, NODE_TO_FACE, Pairing, attribute, file};
use output::{Cells, GridSpec, StaticField, TransientGrid};

/// Both contact surfaces, disk and bar.
pub(crate) struct Surfaces<'a> {
    /// Contact at the nodes of each side, which the recorder fills before it writes a record.
    pub(crate) tables: [NodalContact; 2],
    /// Undeformed positions of those nodes (m).
    pub(crate) points: [Vec<Vector3<f64>>; 2],
    /// Faces, their nodes as rows of the tables.
    pub(crate) faces: &'a [Vec<[u32; 4]>; 2],
    /// The side at whose nodes conditions are enforced; none where both sides share the pressure.
    pub(crate) enforced_on: Option<usize>,
    /// Whether y >= 0 alone is modelled.
    pub(crate) half: bool,
}

impl Surfaces<'_> {
    /// Which velocities belong to a record: conditions that are enforced hold with the slip velocity of the step that
    /// leaves x^n.
    pub(super) fn pairing(&self) -> Pairing {
        self.enforced_on.map_or(Pairing::Before, |_| Pairing::After)
    }

    /// Begins `contact.vtkhdf`, or goes on with it.
    pub(super) fn create(
        &self,
        case: &Case,
        images: &Images,
        basis: &RecordBasis,
    ) -> Result<TransientGrid, RunError> {
        let Self { tables, points, faces, enforced_on, .. } = self;
        let mut provenance = basis.provenance.clone();
        if let Some(side) = *enforced_on {
            let rows = match case.contact.rows.unwrap_or_default() {
                Rows::NodeToFace => NODE_TO_FACE,
                Rows::Mortar => MORTAR,
            };
            let texts = [
                (attribute::SLIP_PAIRING, self.pairing().name()),
                (attribute::ENFORCED_ON, BODY_NAMES[side]),
                (attribute::CONTACT_ROWS, rows),
            ];
            provenance.attributes.extend(texts.map(|(name, text)| (name.into(), text.into())));
        }
        let offset = images.counts()[DISK] as u32;
        let faces = [DISK, BAR].map(|side| images.faces(side, &faces[side]));
        let bar = faces[BAR].iter().map(|face| face.map(|node| node + offset));
        let quads: Vec<_> = faces[DISK].iter().copied().chain(bar).collect();
        let area = images.areas([&tables[DISK].area, &tables[BAR].area]);
        let body = labels(&[faces[DISK].len(), faces[BAR].len()]);
        let grid = GridSpec {
            points: &images.vectors([&points[DISK], &points[BAR]]),
            cells: Cells::Quads(&quads),
            constant: &[StaticField::body(&body), StaticField::area(&area)],
        };
        let fields = CONTACT.of_run(self.pairing());
        basis.grid(file::CONTACT, &grid, &fields, &provenance, |results| &results.contact)
    }
}

/// 0 for the first `counts[0]` entries, 1 for the next, and so on.
pub(super) fn labels(counts: &[usize]) -> Vec<u8> {
    counts.iter().enumerate().flat_map(|(k, &n)| std::iter::repeat_n(k as u8, n)).collect()
}
