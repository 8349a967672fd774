//! The records that are drawn: positions, deformations and values at all nodes.

use super::SceneError;
use super::quantity::{Drawable, Quantity};
use super::rigid::Rigid;
use crate::check::PostError;
use crate::check::frames;
use nalgebra::Vector3;
use output::layout::{BODIES, CONSTANT, CONTACT, HALF, attribute};
use output::{FieldSpec, GridFile, as_long_as_written, as_written, read_summary};
use solid::invariants::von_mises;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Label of the disk.
pub(super) const DISK: u8 = 0;

/// The mesh and the file of its records.
pub(crate) struct Source {
    pub(super) path: PathBuf,
    file: GridFile,
    pub(crate) times: Vec<f64>,
    /// Reference coordinates (m).
    pub(super) points: Vec<Vector3<f64>>,
    /// Corners of all cells, one cell after the other.
    pub(crate) corners: Vec<u32>,
    /// Corners of each cell: 8 of the bodies, 4 of the surfaces.
    pub(super) per_cell: usize,
    /// Body of each cell.
    pub(crate) bodies: Vec<u8>,
    /// Nodes of the disk, and the lowest and highest z of them before they moved (m).
    disk: Vec<usize>,
    pub(super) heights: [f64; 2],
    /// Whether the part y >= 0 alone is modelled.
    pub(crate) half: bool,
}

/// One record.
#[derive(Clone, Debug, Default)]
pub(crate) struct Record {
    /// Where the nodes are (m).
    pub(crate) placed: Vec<Vector3<f64>>,
    /// What of their displacement is no rigid motion of their body (m).
    pub(super) deformation: Vec<Vector3<f64>>,
    /// The quantities by their names, each in the unit of its label.
    pub(super) values: BTreeMap<&'static str, Vec<f64>>,
    /// Shear traction (Pa); of surfaces alone.
    pub(super) shear: Option<Vec<Vector3<f64>>>,
    /// Below the axis of the disk, as deep as the disk reaches.
    pub(crate) lowest: Vector3<f64>,
}

impl Record {
    /// Where the nodes are with their deformation `times` as large.
    pub(super) fn magnified(&self, times: f64) -> Vec<Vector3<f64>> {
        let pairs = self.placed.iter().zip(&self.deformation);
        pairs.map(|(p, d)| p + (times - 1.0) * d).collect()
    }
}

impl Source {
    /// Opens the records of a run, after a check of the file's checksum where the run has ended.
    pub(crate) fn open(folder: &Path, what: Drawable) -> Result<Self, SceneError> {
        let path = folder.join(what.file());
        if !path.is_file() {
            return Err(SceneError::NoFile { folder: folder.into(), what });
        }
        if let Some(summary) = read_summary(folder)? {
            let this = |name: &str| name == what.file();
            if as_long_as_written(folder, &summary, this)? {
                as_written(folder, &summary, this)?;
            }
        }
        let file = frames::open(&path)?;
        let times = file.times()?;
        if times.is_empty() {
            return Err(SceneError::NoRecord(path));
        }
        let per_cell = if what == Drawable::Bodies { 8 } else { 4 };
        let half = file.provenance(attribute::SYMMETRY).is_ok_and(|text| text == HALF)
            && what == Drawable::Bodies;
        let mut source = Self {
            points: file.points()?.into_iter().map(Vector3::from).collect(),
            corners: file.connectivity()?,
            bodies: vec![DISK; file.cells()],
            disk: Vec::new(),
            heights: [0.0; 2],
            path,
            file,
            times,
            per_cell,
            half,
        };
        source.check()?;
        if source.has(&CONSTANT.body) {
            let labels = source.file.read(&CONSTANT.body.name, true, 0)?;
            source.bodies = labels.into_iter().map(|label| label as u8).collect();
        }
        source.disk = source.nodes_of(DISK);
        source.heights = ends(source.disk.iter().map(|&node| source.points[node][2]));
        Ok(source)
    }

    /// Refuses a mesh that does not fit together.
    fn check(&self) -> Result<(), SceneError> {
        let lacks = |what: &str| {
            Err(PostError::Lacks { path: self.path.clone(), what: what.into() }.into())
        };
        if self.file.cells().checked_mul(self.per_cell) != Some(self.corners.len()) {
            return lacks(&format!("its cells do not have {} corners each", self.per_cell));
        }
        if self.corners.iter().any(|&node| node as usize >= self.points.len()) {
            return lacks("a cell names a node that the file does not hold");
        }
        let finite = self.points.iter().flatten().chain(&self.times).all(|x| x.is_finite());
        if finite { Ok(()) } else { lacks("a coordinate or a time is not a number") }
    }

    pub(crate) fn has(&self, field: &FieldSpec) -> bool {
        let same = |f: &output::FieldInfo| {
            f.name == field.name && f.on_cells == field.on_cells && f.components == field.components
        };
        self.file.fields().iter().any(same)
    }

    /// Whether the run wrote what `quantity` is made of.
    pub(super) fn shows(&self, quantity: Quantity) -> bool {
        let of_tensor = quantity == Quantity::VonMises && self.has(&BODIES.stress);
        of_tensor || quantity.dataset().is_none_or(|field| self.has(field))
    }

    /// Nodes of a body, sorted.
    fn nodes_of(&self, wanted: u8) -> Vec<usize> {
        let cells = self.corners.chunks_exact(self.per_cell).zip(&self.bodies);
        let mine = cells.filter(|(_, body)| **body == wanted).flat_map(|(cell, _)| cell);
        let mut nodes: Vec<usize> = mine.map(|&node| node as usize).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    /// The outer faces of the cells that `keep` takes, outward.
    pub(super) fn outside(&self, keep: impl Fn(usize) -> bool) -> Vec<[u32; 4]> {
        let faces = mesh::outer_faces(self.corners.as_chunks().0, keep);
        faces.into_iter().map(|(_, face)| face).collect()
    }

    /// Centre of each cell before it moved.
    pub(super) fn centre(&self, cell: usize) -> Vector3<f64> {
        let corners = &self.corners[cell * self.per_cell..][..self.per_cell];
        corners.iter().map(|&node| 1.0 / corners.len() as f64 * self.points[node as usize]).sum()
    }

    /// The record `index` with these quantities at its nodes.
    pub(crate) fn record(
        &self,
        index: usize,
        quantities: &[Quantity],
    ) -> Result<Record, SceneError> {
        let displacement = if self.per_cell == 4 && !self.has(&CONTACT.displacement) {
            // contact histories of other codes need not have it
            vec![Vector3::zeros(); self.points.len()]
        } else {
            self.vectors(&BODIES.displacement, index)?
        };
        let placed: Vec<Vector3<f64>> =
            self.points.iter().zip(&displacement).map(|(p, u)| p + u).collect();
        let deformation = if self.has(&BODIES.deformation) {
            self.vectors(&BODIES.deformation, index)?
        } else {
            self.less_rigid(displacement, &placed)
        };
        let lowest = self.lowest(&placed, &deformation);
        let mut record = Record { placed, deformation, lowest, ..Record::default() };
        for &quantity in quantities {
            let mut values = self.values(index, quantity, &record)?;
            let size = quantity.label().1;
            values.iter_mut().for_each(|value| *value /= size);
            record.values.insert(quantity.name(), values);
        }
        if quantities.contains(&Quantity::Shear) {
            record.shear = Some(self.vectors(&CONTACT.shear, index)?);
        }
        Ok(record)
    }

    /// The place below the axis of the disk, which moves without jumps from node to node.
    fn lowest(&self, placed: &[Vector3<f64>], deformation: &[Vector3<f64>]) -> Vector3<f64> {
        let of_disk = |node: &usize| placed[*node] - deformation[*node];
        let before: Vec<Vector3<f64>> = self.disk.iter().map(|&node| self.points[node]).collect();
        let after: Vec<Vector3<f64>> = self.disk.iter().map(of_disk).collect();
        let [low, high] = self.heights;
        let axis = 0.5 * (low + high) * Vector3::z();
        let moved = Rigid::fit(&before, &after).map_or(axis, |rigid| rigid.of(axis));
        let [bottom, _] = ends(self.disk.iter().map(|&node| placed[node][2]));
        Vector3::new(moved.x, 0.0, bottom)
    }

    /// The displacements, those of the disk's nodes without its rigid motion; the bar has none, as in the field
    /// `deformation`.
    fn less_rigid(
        &self,
        mut displacement: Vec<Vector3<f64>>,
        placed: &[Vector3<f64>],
    ) -> Vec<Vector3<f64>> {
        let of_disk = |all: &[Vector3<f64>]| self.disk.iter().map(|&n| all[n]).collect::<Vec<_>>();
        if let Some(rigid) = Rigid::fit(&of_disk(&self.points), &of_disk(placed)) {
            for &node in &self.disk {
                displacement[node] = placed[node] - rigid.of(self.points[node]);
            }
        }
        displacement
    }

    /// The quantity at every node (SI).
    fn values(
        &self,
        index: usize,
        quantity: Quantity,
        record: &Record,
    ) -> Result<Vec<f64>, SceneError> {
        let sizes = |vectors: Vec<Vector3<f64>>| vectors.iter().map(|v| v.norm()).collect();
        match (quantity, quantity.dataset()) {
            (Quantity::VonMises, Some(field)) if self.has(field) => {
                Ok(self.to_nodes(&self.numbers(field, index)?))
            }
            (Quantity::VonMises, _) => {
                let stress = self.stress(index)?;
                Ok(self.to_nodes(&stress.iter().map(von_mises).collect::<Vec<_>>()))
            }
            (Quantity::Pressure, Some(field)) => self.numbers(field, index),
            (Quantity::SlipVelocity, Some(field)) => {
                let mut values: Vec<f64> = sizes(self.vectors(field, index)?);
                // surfaces that do not touch move past one another, and that is no slip
                let pressure = self.numbers(&CONTACT.pressure, index)?;
                let pairs = values.iter_mut().zip(pressure);
                pairs.filter(|(_, pressure)| *pressure <= 0.0).for_each(|(value, _)| *value = 0.0);
                Ok(values)
            }
            (_, Some(field)) => Ok(sizes(self.vectors(field, index)?)),
            (_, None) => Ok(sizes(record.deformation.clone())),
        }
    }

    /// The stress of every element, xx yy zz xy yz xz (Pa).
    pub(crate) fn stress(&self, index: usize) -> Result<Vec<[f64; 6]>, SceneError> {
        Ok(self.numbers(&BODIES.stress, index)?.as_chunks().0.to_vec())
    }

    /// The mean at each node of the cells around it.
    fn to_nodes(&self, of_cells: &[f64]) -> Vec<f64> {
        let mut sums = vec![(0.0, 0u32); self.points.len()];
        for (cell, value) in self.corners.chunks_exact(self.per_cell).zip(of_cells) {
            for &node in cell {
                let (sum, count) = &mut sums[node as usize];
                *sum += value;
                *count += 1;
            }
        }
        sums.into_iter().map(|(sum, count)| sum / f64::from(count.max(1))).collect()
    }

    fn vectors(&self, field: &FieldSpec, index: usize) -> Result<Vec<Vector3<f64>>, SceneError> {
        Ok(frames::vectors(&self.numbers(field, index)?))
    }

    /// A field of a record, as many numbers as it must have, all finite.
    fn numbers(&self, field: &FieldSpec, index: usize) -> Result<Vec<f64>, SceneError> {
        if !self.has(field) {
            let what = format!("it holds no field {}", field.name);
            return Err(PostError::Lacks { path: self.path.clone(), what }.into());
        }
        let values = self.file.read(&field.name, field.on_cells, index)?;
        let rows = if field.on_cells { self.file.cells() } else { self.points.len() };
        if values.len() != field.components * rows {
            return Err(PostError::Damaged { path: self.path.clone() }.into());
        }
        match values.iter().position(|value| !value.is_finite()) {
            None => Ok(values),
            Some(at) => {
                let (time, row) = (self.times[index], at / field.components);
                let what = format!(
                    "{} is not a number at {} {row} at t = {time:e} s; the run went wrong before",
                    field.name,
                    if field.on_cells { "element" } else { "node" },
                );
                Err(PostError::Lacks { path: self.path.clone(), what }.into())
            }
        }
    }
}

/// The lowest and highest of numbers.
pub(crate) fn ends(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn magnified_bodies_keep_their_place_and_only_their_deformation_grows() {
        let record = Record {
            placed: vec![Vector3::new(1.0, 2.0, 3.0), Vector3::new(4.0, 5.0, 6.0)],
            deformation: vec![Vector3::zeros(), 1e-3 * Vector3::z()],
            ..Record::default()
        };
        assert_eq!(record.magnified(100.0)[0], Vector3::new(1.0, 2.0, 3.0));
        assert!((record.magnified(100.0)[1][2] - 6.099).abs() < 1e-12);
        assert_eq!(record.magnified(1.0), record.placed);
    }
}
