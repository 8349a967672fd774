//! The contact of another code from the contact forces of nodes and their motion.

use crate::check::import::imported;
use crate::check::projection::Pair;
use crate::check::surface::Surface;
use nalgebra::Vector3;
use output::layout::CONTACT;
use output::{Cells, FieldSpec, GridSpec, OutputError, StaticField, TransientGrid, Values};
use std::path::{Path, PathBuf};

/// Writes `contact.vtkhdf` record by record. At a node with the unit normal `n` of its own surface, the mean of the normals
/// of the faces around it as they are displaced, and with the area `A`, a force `f` gives the pressure `-f.n/A` and the
/// shear `f/A + p n`. The slip velocity is that relative to the closest-point projection on the other surface, as
/// the check finds it for the pair.
pub struct ContactOfForces {
    path: PathBuf,
    file: TransientGrid,
    surface: Surface,
    /// The nodes of each body over the faces of the other.
    pairs: [Pair; 2],
}

/// Contact forces (N), velocities (m/s) and displacements (m) of all nodes at one time.
#[derive(Clone, Copy, Debug)]
pub struct NodalForces<'a> {
    /// Forces by the other body.
    pub force: &'a [[f64; 3]],
    /// Velocities.
    pub velocity: &'a [[f64; 3]],
    /// Displacements from the points of the surface.
    pub displacement: &'a [[f64; 3]],
}

impl ContactOfForces {
    /// Begins the file, replacing what is there.
    ///
    /// # Errors
    /// A surface without faces, or with nodes that it does not have; a file that cannot be written.
    pub fn create(path: &Path, surface: Surface) -> Result<Self, OutputError> {
        let specs: Vec<FieldSpec> = [
            &CONTACT.pressure,
            &CONTACT.shear,
            &CONTACT.slip_velocity,
            &CONTACT.velocity,
            &CONTACT.displacement,
        ]
        .map(FieldSpec::clone)
        .into();
        let points: Vec<[f64; 3]> = surface.points.iter().map(|&x| x.into()).collect();
        let constant = [StaticField::body(&surface.face_body), StaticField::area(&surface.area)];
        let cells = Cells::Quads(&surface.faces);
        let grid = GridSpec { points: &points, cells, constant: &constant };
        let file = TransientGrid::create(path, &grid, &specs, &imported())?;
        let pairs = [0, 1].map(|body| Pair::over_convex_edges(&surface, body));
        Ok(Self { path: path.into(), file, surface, pairs })
    }

    /// Appends a record; returns how many nodes bear a force but have no projection: they are left out, as open ones.
    ///
    /// # Errors
    /// Values of another number than the nodes; a file that cannot be written.
    pub fn append(&mut self, time: f64, record: &NodalForces) -> Result<usize, OutputError> {
        let Self { path, file, surface, pairs } = self;
        let count = surface.points.len();
        let rows = [record.force, record.velocity, record.displacement].map(<[_]>::len);
        if rows != [count; 3] {
            let problem = format!("forces and motion of {rows:?} nodes, but there are {count}");
            return Err(OutputError::Shape { path: path.clone(), problem });
        }
        let vectors = |rows: &[[f64; 3]]| rows.iter().copied().map(Vector3::from).collect();
        let motion: [Vec<Vector3<f64>>; 2] = [record.displacement, record.velocity].map(vectors);
        let mut pressure = vec![0.0; count];
        let (mut shear, mut slip) = (vec![[0.0; 3]; count], vec![[0.0; 3]; count]);
        let mut lost = 0;
        for body in 0..pairs.len() {
            let bears = |&row: &usize| {
                usize::from(surface.body[row]) == body
                    && record.force[row] != [0.0; 3]
                    && surface.area[row] > 0.0
            };
            let rows: Vec<usize> = (0..count).filter(bears).collect();
            let slips = pairs[body].slip(surface, &motion, &rows);
            for (row, relative) in rows.into_iter().zip(slips) {
                let Some(relative) = relative else {
                    lost += 1;
                    continue;
                };
                // the pair of the other body has the faces of this one
                let normal = pairs[1 - body].normal(surface, &motion[0], row as u32);
                let traction = Vector3::from(record.force[row]) / surface.area[row];
                pressure[row] = -traction.dot(&normal);
                shear[row] = (traction + pressure[row] * *normal).into();
                slip[row] = relative.into();
            }
        }
        file.append(
            time,
            &[
                Values::Scalar(&pressure),
                Values::Vector(&shear),
                Values::Vector(&slip),
                Values::Vector(record.velocity),
                Values::Vector(record.displacement),
            ],
        )?;
        Ok(lost)
    }
}
