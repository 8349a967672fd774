//! The state in which the guards stopped a run, for a look at the place.

use crate::run_error::RunError;
use dynamics::{Diagnosis, Simulation};
use mesh::Padded;
use output::{Cells, FieldSpec, GridSpec, Provenance, StaticField, TransientGrid, Values};
use std::path::Path;

/// The file, in the run's folder.
pub(crate) const POSTMORTEM: &str = "postmortem.vtkhdf";

/// An element folded to less than this at a corner is suspect.
const FOLDED: f64 = 0.2;

/// Writes both bodies as they are, with the state of every element and what is suspect.
///
/// Displacements may be no numbers: viewers then leave those points out.
pub(crate) fn write(
    folder: &Path,
    simulation: &mut Simulation,
    diagnosis: &Diagnosis,
    provenance: &Provenance,
) -> Result<(), RunError> {
    let force = simulation.elastic_force();
    let solid = simulation.solid();
    let vectors = |field: &[Padded]| field.iter().map(|v| v.xyz()).collect::<Vec<_>>();
    let points = vectors(solid.reference());
    let hexes: Vec<_> = (0..solid.elements()).map(|e| solid.nodes_of(e)).collect();
    let body: Vec<u8> = (0..solid.elements()).map(|e| solid.body_of(e) as u8).collect();
    let states = solid.element_states(simulation.displacement());
    let column = |of: fn(&solid::ElementState) -> f64| states.iter().map(of).collect::<Vec<_>>();
    let place = &diagnosis.place;
    let at_node = |e: usize| hexes[e].contains(&(place.node as u32));
    let suspect: Vec<u8> = states
        .iter()
        .enumerate()
        .map(|(e, state)| match state.corner_ratio {
            _ if e == place.element => 2,
            ratio if ratio.is_nan() || ratio < FOLDED || at_node(e) => 1,
            _ => 0,
        })
        .collect();
    let mut suspect_node = vec![0_u8; points.len()];
    suspect_node[place.node] = 2;

    let at = FieldSpec::at_points;
    let suspicious = "0 no, 1 suspect, 2 named in the diagnosis";
    let fields = [
        at("displacement", "m", 3, "displacement from the undeformed state"),
        at("velocity", "m/s", 3, "velocity over the last step"),
        at("force", "N", 3, "force of the elements on the node, without viscous parts"),
        at("suspect", "1", 1, suspicious).integer(),
        at("volume_ratio", "1", 1, "volume over that of the undeformed element").on_cells(),
        at("corner_ratio", "1", 1, "smallest det F at a corner, negative where inside out")
            .on_cells(),
        at("strain_energy", "J", 1, "strain energy of the element").on_cells(),
        at("hourglass_energy", "J", 1, "hourglass energy of the element").on_cells(),
        at("suspect", "1", 1, suspicious).integer().on_cells(),
    ];
    let grid = GridSpec {
        points: &points,
        cells: Cells::Hexahedra(&hexes),
        constant: &[StaticField {
            spec: at("body", "1", 1, "0 disk, 1 bar").integer().on_cells(),
            values: Values::Integer(&body),
        }],
    };
    let mut provenance = provenance.clone();
    provenance.attributes.push(("diagnosis".into(), diagnosis.to_string()));
    let mut file = TransientGrid::create(folder.join(POSTMORTEM), &grid, &fields, &provenance)?;
    Ok(file.append(
        simulation.time(),
        &[
            Values::Vector(&vectors(simulation.displacement())),
            Values::Vector(&vectors(simulation.velocity())),
            Values::Vector(&vectors(&force)),
            Values::Integer(&suspect_node),
            Values::Scalar(&column(|s| s.volume_ratio)),
            Values::Scalar(&column(|s| s.corner_ratio)),
            Values::Scalar(&column(|s| s.strain_energy)),
            Values::Scalar(&column(|s| s.hourglass_energy)),
            Values::Integer(&suspect),
        ],
    )?)
}
