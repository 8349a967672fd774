//! The state in which the guards stopped a run, for a look at the place.

use crate::run::error::RunError;
use crate::run::record::moved;
use dynamics::{Diagnosis, Simulation};
use mesh::Padded;
use output::layout::{POSTMORTEM, PostmortemFields, attribute, file};
use output::{Cells, FieldSpec, GridSpec, Provenance, StaticField, TransientGrid, Values};
use std::path::Path;

/// An element whose volume ratio at a corner is less than this is suspect.
const FOLDED: f64 = 0.2;

/// Writes both bodies as they are, with the state of every element and what is suspect: 2 where the guard stopped the
/// run, 1 for other elements that are folded or hold that node.
///
/// Displacements may be NaN: viewers then leave those points out.
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

    let grid = GridSpec {
        points: &points,
        cells: Cells::Hexahedra(&hexes),
        constant: &[StaticField::body(&body)],
    };
    let mut provenance = provenance.clone();
    provenance.attributes.push((attribute::DIAGNOSIS.into(), diagnosis.to_string()));
    let fields = POSTMORTEM.each().map(FieldSpec::clone);
    let path = folder.join(file::POSTMORTEM);
    let mut grid = TransientGrid::create(path, &grid, &fields, &provenance)?;
    let places = simulation.displacement().iter().map(|u| moved(*u, simulation.travel()).into());
    let displacement: Vec<_> = places.collect();
    let values = PostmortemFields {
        displacement: Values::Vector(&displacement),
        velocity: Values::Vector(&vectors(simulation.velocity())),
        force: Values::Vector(&vectors(&force)),
        suspect_node: Values::Integer(&suspect_node),
        volume_ratio: Values::Scalar(&column(|s| s.volume_ratio)),
        corner_ratio: Values::Scalar(&column(|s| s.corner_ratio)),
        strain_energy: Values::Scalar(&column(|s| s.strain_energy)),
        hourglass_energy: Values::Scalar(&column(|s| s.hourglass_energy)),
        suspect_element: Values::Integer(&suspect),
    };
    Ok(grid.append(simulation.time(), &values.each().map(|values| *values))?)
}
