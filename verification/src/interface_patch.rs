//! The patch test of an interface: uniform pressure across two meshes that do not match.
//!
//! A block with n elements per edge lies on one with m, both pressed together by a uniform pressure;
//! with nu = 0 the exact solution is that pressure everywhere. Contact is exact, in one pass, with the contact
//! constraints of dynamics. A node-to-face constraint distributes a node's force to the corners of one face by its
//! shape functions, unlike a uniform pressure on the faces. It passes where the meshes match; elsewhere its error is
//! shown beside that of mortar constraints, which pass, since their nodal forces and weights are integrals over the
//! faces. The test is static, to avoid the ringing of a dynamic one; statics and dynamics take gaps and weights from
//! the same integrals.
//!
//! The measure is the pressure of the slave nodes, force over nodal area. Where the meshes do not match, the
//! edges of the interface, where faces overlap in part only, are left out. The limit is the pressure error of the node
//! with the least area if that node bears the whole residual of the equilibrium.

use crate::body::{STEEL, contact_material, side_nodes};
use crate::problem::{Cause, Outcome, Size};
use crate::row::Row;
use contact::{ExactSettings, GapFunction, Rows};
use mesh::{Mesh, Padded};
use solid::{Element, Level, Material, Solid, Viscosity};
use statics::{Axis, Contact, Problem, Supports, Tied};

const MATERIAL: Material = Material { poisson: 0.0, ..STEEL };
const EDGE: f64 = 10e-3;
const PRESSURE: f64 = 1e6;
/// Residual over load at which the equilibrium is accepted.
const RESIDUAL: f64 = 1e-10;

pub(crate) fn run(size: Size) -> Outcome {
    run_with(size, |_| {})
}

/// The problem with contact set up on a mesh that was changed by `reshape`, and elements on the unchanged one.
pub(crate) fn run_with(size: Size, reshape: impl Fn(&mut Mesh)) -> Outcome {
    let finest = match size {
        Size::Quick => 1,
        Size::Full => 2,
    };
    let mut rows = Vec::new();
    let source = "uniform pressure";
    for (slaves, masters) in [(6, 6), (6, 5), (9, 5)] {
        let (slaves, masters) = (finest * slaves, finest * masters);
        let meshes = format!("{slaves} on {masters} elements");
        let pressures = |rows| pressures(rows, slaves, masters, &reshape);
        // nodal area over that of an element: a corner, where edges count, has a quarter
        let least = if slaves == masters { 0.25 } else { 1.0 };
        let nodes = (slaves * slaves) as f64 / least;
        let limit =
            (RESIDUAL * nodes, "the residual of the equilibrium, on the node of least area");
        let (spread, mortar) = (pressures(Rows::NodeToFace)?, pressures(Rows::Mortar)?);
        for (i, what) in ["rms", "largest"].into_iter().enumerate() {
            let quantity =
                |by: &str| format!("{meshes}, {by}: pressure over the applied one, less 1, {what}");
            if slaves == masters {
                rows.push(Row::new(quantity("node to face"), [0.0, spread[i]], 1.0, limit, source));
            }
            rows.push(Row::new(
                format!("{}; node to face {:.1e}", quantity("mortar"), spread[i]),
                [0.0, mortar[i]],
                1.0,
                limit,
                source,
            ));
        }
    }
    Ok(rows)
}

/// Departure of the slaves' pressure from the applied one: root mean square and largest.
fn pressures(
    rows: Rows,
    slaves: usize,
    masters: usize,
    reshape: impl Fn(&mut Mesh),
) -> Result<[f64; 2], Cause> {
    let upper = mesh::block([slaves, slaves, 3], [EDGE, EDGE, 0.5 * EDGE]);
    let mut lower = mesh::block([masters, masters, 3], [EDGE, EDGE, 0.5 * EDGE]);
    lower.nodes.iter_mut().for_each(|x| x[2] -= 0.5 * EDGE);
    let mesh = mesh::join(&[upper, lower]);
    let element = Element { hourglass: 0.05 };
    let materials = [MATERIAL; 2];
    let mut solid = Solid::new(&mesh, &materials, element, Viscosity::default(), Level::detect())?;
    let surfaces = [&mesh.bodies[0].surfaces["z-"], &mesh.bodies[1].surfaces["z+"]];
    let mut areas = mesh.clone();
    reshape(&mut areas);
    let mut gaps = GapFunction::new(
        &areas,
        surfaces.map(|s| (s, contact_material(&MATERIAL))),
        &ExactSettings { slave: Some(0), rows, ..ExactSettings::default() },
    )?;
    // pressed by a rigid plate: the solution is uniform as well
    let press = Tied {
        nodes: side_nodes(&mesh, 0, "z+").to_vec(),
        axes: [Axis::Moved(0.0), Axis::Moved(0.0), Axis::Loaded(-PRESSURE * EDGE * EDGE)],
    };
    let supports = Supports {
        held: side_nodes(&mesh, 1, "z-").to_vec(),
        tied: vec![press],
        ..Supports::default()
    };
    let problem = Problem {
        mesh: &mesh,
        supports: &supports,
        spin: None,
        tolerance: RESIDUAL,
        max_iterations: 100,
    };
    let start = vec![Padded::ZERO; mesh.nodes.len()];
    let found =
        statics::solve(&mut solid, Contact::Multipliers(&mut gaps), &problem, &start, |_| true)?;
    let inside = |n: u32| {
        let x = mesh.nodes[n as usize];
        let off = |c: f64| c > 1e-9 && c < EDGE - 1e-9;
        slaves == masters || (off(x[0]) && off(x[1]))
    };
    let errors: Vec<f64> = found
        .pressed
        .iter()
        .filter(|(gap, _)| inside(gap.node))
        .map(|(gap, force)| force / (gap.area * PRESSURE) - 1.0)
        .collect();
    let rms = (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt();
    Ok([rms, errors.iter().map(|e| e.abs()).fold(0.0, f64::max)])
}
