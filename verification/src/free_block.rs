//! A free block of fully integrated elements beside five other codes.
//!
//! n^3 hexahedra of 1 mm, all faces free, row-sum mass, start velocity v_z = -z/L, 20 steps of 0.1 us;
//! u_z of the corner (L, L, L). Akantu, Kratos, MFEM, SciPy and fenris agree on every digit. The block
//! starts without displacement, hence without force: a start velocity at t = -dt/2, 0 or dt/2 is the
//! same in central difference, u^1 = dt v^0.
//!
//! The density is 7800 kg/m^3, as in the references: with it all of them are met in every
//! digit, with 7850 kg/m^3 none (n = 4: -1.073219e-6 m).

use crate::body::at_rest;
use crate::problem::{Outcome, Size};
use crate::row::Row;
use dynamics::{Setup, Simulation};
use mesh::Padded;
use nalgebra::Vector3;
use solid::{Level, Material, Solid, SolidError, Viscosity, Volumetric};

const STEEL: Material = Material { young: 210e9, poisson: 0.3, density: 7800.0 };

/// Start velocity over that of the references, which are of small strain with 1 m/s at the top. At this velocity finite
/// strain equals small strain to a part in 1e9.
const SCALE: f64 = 1e-6;

const REFERENCES: [(usize, f64); 4] =
    [(4, -1.074103e-6), (10, -8.809777e-7), (20, -1.418167e-6), (40, -1.709083e-6)];

pub(crate) fn run(size: Size) -> Outcome {
    run_with(size, |_| {})
}

/// The problem with the masses of the nodes (kg) changed by `reweigh`.
pub(crate) fn run_with(size: Size, reweigh: impl Fn(&mut [f64])) -> Outcome {
    let blocks = match size {
        Size::Quick => &REFERENCES[..3],
        Size::Full => &REFERENCES,
    };
    let mut rows = Vec::new();
    for &(n, reference) in blocks {
        // half a unit of the seventh digit
        let digit = 0.5e-6 * libm::pow(10f64, libm::log10(reference.abs()).floor());
        let limit = (digit / reference.abs(), "half of the last printed digit");
        let quantity = format!("u_z of the corner, n = {n} (m)");
        let source = "Akantu, Kratos, MFEM, SciPy and fenris";
        rows.push(Row::new(quantity, [reference, corner(n, &reweigh)?], reference, limit, source));
    }
    Ok(rows)
}

fn corner(n: usize, reweigh: impl Fn(&mut [f64])) -> Result<f64, SolidError> {
    let size = n as f64 * 1e-3;
    let mesh = mesh::block([n; 3], [size; 3]);
    let solid =
        Solid::new(&mesh, &[STEEL], Volumetric::Full, Viscosity::default(), Level::detect())?;
    let dt = 1e-7;
    let start = |x: &Vector3<f64>| Padded::new([0.0, 0.0, -SCALE * x[2] / size]);
    let mut setup = Setup {
        velocity: mesh.nodes.iter().map(start).collect(),
        dt,
        dt_limit: dt,
        ..at_rest(&mesh, STEEL, 1.0, None)?
    };
    setup.system.solid = solid;
    reweigh(&mut setup.system.mass);
    let mut simulation = Simulation::new(setup);
    for _ in 0..20 {
        simulation.step(false);
    }
    Ok(simulation.displacement().last().map_or(f64::NAN, |u| u.0[2]) / SCALE)
}
