//! The contact of other codes, from Python arrays of the forces and the motion of its nodes.

use creepage::check::{ContactOfForces, NO_BODY, NodalForces, Surface};
use numpy::{PyReadonlyArray1, PyReadonlyArray2};
use output::OutputError;
use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;
use std::path::PathBuf;

fn failed(error: OutputError) -> PyErr {
    PyOSError::new_err(error.to_string())
}

/// Vectors, one after the other.
type Vectors<'py> = PyReadonlyArray1<'py, f64>;

/// Writes `contact.vtkhdf`, one record after the other.
#[pyclass]
pub struct ContactWriter(ContactOfForces);

#[pymethods]
impl ContactWriter {
    /// A file of the nodes at `points` (m) with `areas` (m2), and of `faces` with their `body` (0 disk, 1 bar).
    #[new]
    fn create(
        path: PathBuf,
        points: PyReadonlyArray2<'_, f64>,
        areas: PyReadonlyArray1<'_, f64>,
        faces: Vec<[u32; 4]>,
        bodies: Vec<u8>,
    ) -> PyResult<Self> {
        let points: Vec<_> =
            points.as_slice()?.as_chunks::<3>().0.iter().map(|x| (*x).into()).collect();
        let mut body = vec![NO_BODY; points.len()];
        for (face, &label) in faces.iter().zip(&bodies) {
            for &n in face {
                body.get_mut(n as usize).into_iter().for_each(|of| *of = label);
            }
        }
        let area = areas.as_slice()?.to_vec();
        let surface = Surface { points, faces, face_body: bodies, body, area };
        Ok(Self(ContactOfForces::create(&path, surface).map_err(failed)?))
    }

    /// Appends a record: the time (s), and of each node the force (N), the velocity (m/s) and the displacement (m), flat.
    /// Returns how many nodes with a force have no projection and were left out.
    fn append(
        &mut self,
        py: Python<'_>,
        time: f64,
        force: Vectors<'_>,
        velocity: Vectors<'_>,
        displacement: Vectors<'_>,
    ) -> PyResult<usize> {
        let record = NodalForces {
            force: force.as_slice()?.as_chunks().0,
            velocity: velocity.as_slice()?.as_chunks().0,
            displacement: displacement.as_slice()?.as_chunks().0,
        };
        py.detach(|| self.0.append(time, &record)).map_err(failed)
    }
}
