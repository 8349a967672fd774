//! Whether slip and the elements below the contact show a mode of the mesh, over the evaluation window.

use crate::case::schema::{Case, ContactLayers};
use crate::run::error::RunError;
use crate::scenario::{BAR, DISK, Model};
use contact::NodalContact;
use contact::mesh_mode::{HOURGLASS_LIMIT, LEAST_SLIP, MESH_MODE_LIMIT, MeshMode, warning};
use contact::patch::IN_CONTACT;
use mesh::Padded;
use output::summary;
use serde::{Deserialize, Serialize};
use solid::Solid;

/// Samples of the energies of the elements below the contact over the evaluation window. They are few, since each
/// is a pass over the elements outside the vector kernels.
const SAMPLES: f64 = 20.0;

/// Sums over the evaluation window.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct MeshModeSums {
    pub(crate) slip: MeshMode,
    /// Hourglass and strain energy of the elements below the contact (J), summed over the samples.
    pub(crate) energy: [f64; 2],
}

impl MeshModeSums {
    /// Part of the slip that alternates; none where hardly anything slips.
    fn alternating(&self, case: &Case) -> Option<f64> {
        self.slip.share(LEAST_SLIP * case.drive.speed.abs())
    }

    /// Hourglass over strain energy of the elements below the contact.
    fn hourglass(&self) -> Option<f64> {
        let [hourglass, strain] = self.energy;
        (strain > 0.0).then(|| hourglass / strain)
    }

    /// Warnings about them, one sentence each.
    pub(crate) fn warnings(&self, case: &Case) -> Vec<String> {
        let one_point = case.element.contact_layers == ContactLayers::OnePoint;
        let slip = self.alternating(case).and_then(|share| warning(share, one_point));
        let slip = slip.map(|text| match one_point {
            true => format!("{text}: use element.contact_layers = \"full\""),
            false => text.to_owned(),
        });
        let energy = self.hourglass().filter(|part| *part > HOURGLASS_LIMIT).map(|part| {
            format!(
                "the hourglass energy of the elements below the contact is {:.0} % of their strain energy: they \
                 deform by modes of the mesh; use element.contact_layers = \"full\"",
                100.0 * part
            )
        });
        slip.into_iter().chain(energy).collect()
    }

    /// What they show.
    pub(crate) fn result(&self, case: &Case) -> summary::MeshMode {
        summary::MeshMode {
            alternating_slip: self.alternating(case),
            alternating_slip_limit: MESH_MODE_LIMIT,
            hourglass_energy_in_layers: self.hourglass(),
            hourglass_energy_limit: HOURGLASS_LIMIT,
            warnings: self.warnings(case),
        }
    }
}

/// The faces and elements whose slip and energies are watched.
pub(crate) struct WatchedFaces {
    /// Sides at whose nodes slip is judged: those where the conditions are enforced.
    sides: Vec<usize>,
    /// Faces of the zones of both sides, their nodes as rows of that side's table.
    faces: [Vec<[u32; 4]>; 2],
    /// Elements of the layers below the zones.
    layers: Vec<u32>,
    /// Least pressure of a node in contact (Pa).
    pressure: f64,
    /// Start of the window (s), and time between two samples of energy (s).
    from: f64,
    interval: f64,
}

impl WatchedFaces {
    pub(crate) fn new(
        case: &Case,
        model: &Model,
        tables: &[NodalContact; 2],
        enforced_on: Option<usize>,
        hertz_pressure: f64,
    ) -> Result<Self, RunError> {
        let mut faces = [Vec::new(), Vec::new()];
        for side in [DISK, BAR] {
            for face in &model.zones[side] {
                let mut quad = [0; 4];
                for (corner, node) in quad.iter_mut().zip(face.nodes) {
                    let row = tables[side].nodes.binary_search(&node);
                    *corner = row.map_err(|_| RunError::NoContact)? as u32;
                }
                faces[side].push(quad);
            }
        }
        let layers = case.contact_layers() as usize;
        let below = |side: usize| {
            mesh::layers_below(&model.mesh, &model.mesh.bodies[side], &model.zones[side], layers)
        };
        let [from, to] = case.evaluation_window();
        Ok(Self {
            sides: enforced_on.map_or(vec![DISK, BAR], |side| vec![side]),
            layers: [below(DISK), below(BAR)].concat(),
            faces,
            pressure: IN_CONTACT * hertz_pressure,
            from,
            interval: (to - from) / SAMPLES,
        })
    }

    /// Faces of the zones of both sides, their nodes as rows of that side's table.
    pub(crate) fn faces(&self) -> &[Vec<[u32; 4]>; 2] {
        &self.faces
    }

    /// Adds the slip at a time within the window.
    pub(crate) fn slip(&self, tables: &[NodalContact; 2], sums: &mut MeshModeSums) {
        for &side in &self.sides {
            let table = &tables[side];
            let in_contact = |row: usize| table.pressure[row] > self.pressure;
            sums.slip.add(1.0, &self.faces[side], &table.slip_velocity, in_contact);
        }
    }

    /// Whether a sample of energy is due between `time - dt` and `time` (s), not before the window.
    pub(crate) fn samples(&self, [time, dt]: [f64; 2]) -> bool {
        let sample = |time: f64| ((time - self.from) / self.interval).floor();
        time >= self.from && sample(time) != sample(time - dt)
    }

    /// Adds the energies of the elements if a sample is due between `at[0] - at[1]` and `at[0]` (s), within the window.
    pub(crate) fn energy(
        &self,
        at: [f64; 2],
        solid: &Solid,
        displacement: &[Padded],
        sums: &mut MeshModeSums,
    ) {
        if !self.samples(at) {
            return;
        }
        for &element in &self.layers {
            let state = solid.element_state(displacement, element as usize);
            sums.energy[0] += state.hourglass_energy;
            sums.energy[1] += state.strain_energy;
        }
    }
}
