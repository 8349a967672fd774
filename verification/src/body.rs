//! Shared by the dynamic problems: materials, elastic bodies set up for central difference, and sums
//! over nodes.

use contact::BodyMaterial;
use dynamics::{Fixed, Setup, System};
use mesh::{Mesh, Padded};
use solid::{Element, Elements, Level, Material, Solid, SolidError, Viscosity};

/// The steel of the ladder.
pub(crate) const STEEL: Material = Material { young: 210e9, poisson: 0.3, density: 7850.0 };

/// A material with the shear modulus of [`STEEL`] and Poisson's ratio zero: pressure then causes no lateral strain,
/// which would push free sides apart.
pub(crate) const SHEARED: Material =
    Material { young: STEEL.young / (1.0 + STEEL.poisson), poisson: 0.0, density: STEEL.density };

/// The elements of most problems.
pub(crate) const ONE_POINT: Element = Element { hourglass: 0.05 };

/// Lanczos steps for the largest frequency, and the safety factor on it, as in rolling runs.
const LANCZOS: usize = 40;
const MARGIN: f64 = 1.01;

/// Free bodies of one material at rest, with a time step of `factor` times the stability limit.
///
/// `contact` bounds the contact stiffness on each node (N/m), if there will be contact: with
/// K_c <= diag(bound), omega^2 <= omega_el^2 + max(bound/m).
pub(crate) fn at_rest(
    mesh: &Mesh,
    material: Material,
    factor: f64,
    contact: Option<&contact::PenaltyContact>,
) -> Result<Setup, SolidError> {
    at_rest_with(mesh, material, ONE_POINT, factor, contact)
}

/// [`at_rest`] with other elements than [`ONE_POINT`].
pub(crate) fn at_rest_with<'a>(
    mesh: &Mesh,
    material: Material,
    elements: impl Into<Elements<'a>>,
    factor: f64,
    contact: Option<&contact::PenaltyContact>,
) -> Result<Setup, SolidError> {
    let materials = vec![material; mesh.bodies.len()];
    let mut solid = Solid::new(mesh, &materials, elements, Viscosity::default(), Level::detect())?;
    let mass = solid::lumped_mass(mesh, &vec![material.density; materials.len()]);
    let inverse: Vec<f64> = mass.iter().map(|m| 1.0 / m).collect();
    let elastic = MARGIN
        * solid::largest_frequency(&inverse, |x, y| solid.add_stiffness_product(x, y), LANCZOS);
    let mut bound = vec![0.0; mass.len()];
    if let Some(contact) = contact {
        contact.nodal_stiffness_bound(&mut bound);
    }
    let springs = bound.iter().zip(&inverse).map(|(k, w)| k * w).fold(0.0, f64::max);
    let omega_max = (elastic * elastic + springs).sqrt();
    let n = mass.len();
    Ok(Setup {
        system: System::free(solid, mass),
        displacement: vec![Padded::ZERO; n],
        velocity: vec![Padded::ZERO; n],
        dt: factor * 2.0 / omega_max,
        dt_limit: 2.0 / omega_max,
    })
}

/// Supports that keep the nodes of a side of a block from moving along `axis`.
pub(crate) fn rollers(mesh: &Mesh, side: &str, axis: usize) -> Vec<Fixed> {
    let axes = [0, 1, 2].map(|i| i == axis);
    side_nodes(mesh, 0, side).iter().map(|&node| Fixed { node, axes }).collect()
}

/// Nodes on a side of a block.
pub(crate) fn side_nodes<'a>(mesh: &'a Mesh, body: usize, side: &str) -> &'a [u32] {
    mesh.bodies[body].node_sets.get(side).map_or(&[], |nodes| nodes)
}

/// The properties of a material that contact uses.
pub(crate) fn contact_material(material: &Material) -> BodyMaterial {
    BodyMaterial { bulk_modulus: material.bulk(), density: material.density }
}

/// Momentum of the nodes (kg m/s).
pub(crate) fn momentum(
    mass: &[f64],
    velocity: &[Padded],
    nodes: impl Iterator<Item = usize>,
) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for n in nodes {
        for i in 0..3 {
            sum[i] += mass[n] * velocity[n].0[i];
        }
    }
    sum
}
