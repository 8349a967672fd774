//! The compliance of the contact surfaces over an implicit step: columns of A^-1, found as contact comes to nodes.
//!
//! A column depends on its node, the step and the undeformed bodies alone, so that it does not matter to the result when it was found. Along
//! a surface whose nodes lie in rows at one pitch, a column is that of another node of its row, moved along ([`Rows`]).

use super::operator::{Frame, Operator, StepMatrix, Vectors};
use crate::nodal_state::NodalState;
use crate::paired;
use crate::system::System;
use contact::Trace;
use mesh::Padded;
use mesh::geometry::rotation_about_y;
use nalgebra::{Matrix3, Vector3};
use solid::linear::{ConjugateGradients, Vector};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Part to which the residual of a column falls: contact works with columns that are nearly right, and corrects what they miss.
const TOLERANCE: f64 = 0.03;
const MOST_PRODUCTS: usize = 200;

/// Columns for one time step.
#[derive(Debug, Default)]
pub(crate) struct Columns {
    /// By the node of the trace: the velocities (m/s) of all nodes of its side of the trace under unit forces on it, along x, y and z.
    of: HashMap<u32, Vec<Matrix3<f64>>>,
    /// The nodes whose products are counted. A run that is resumed finds their columns again, which is no part of what it takes.
    pub(crate) counted: BTreeSet<u32>,
}

/// The nodes of the trace in rows along the surface: of the lower body along x, of a body on a hub around its axle.
#[derive(Debug)]
pub(crate) struct Rows {
    /// Of each node: its row, its place in it.
    of: Vec<[u32; 2]>,
    /// Of each node: how far along it is (m, or rad about the axle, positive about +y).
    along: Vec<f64>,
    /// The nodes of each row, ascending along it.
    rows: Vec<Vec<u32>>,
}

/// Coordinates that differ by less than this part of the extent of a surface across its rows are those of one row.
const SAME: f64 = 1e-6;
/// Part of the distance to the neighbour by which two nodes may differ in their place along two rows of equal pitch.
const ALIKE: f64 = 0.02;

impl Rows {
    /// Of the `trace` of a mesh with reference positions `reference` (m); with the centre of the hub that side 0 turns about, if there is one (m).
    pub(crate) fn new(trace: &Trace, reference: &[Padded], centre: Option<Vector3<f64>>) -> Self {
        let positions = trace.gather(reference);
        let around = |node: usize| centre.filter(|_| node < trace.side(0).len());
        // along the row, and what all of a row have alike
        let place = |node: usize, x: &Padded| match around(node) {
            Some(c) => {
                let [ahead, down] = [x[0] - c[0], x[2] - c[2]];
                (libm::atan2(-ahead, -down), [x[1], libm::hypot(ahead, down)])
            }
            None => (x[0], [x[1], x[2]]),
        };
        let size = positions.iter().flat_map(|x| x.xyz()).fold(0.0, |m: f64, c| m.max(c.abs()));
        let key = |c: f64| (c / (SAME * size)).round() as i64;
        let mut found: BTreeMap<(usize, [i64; 2]), Vec<u32>> = BTreeMap::new();
        let mut along = vec![0.0; positions.len()];
        for (node, x) in positions.iter().enumerate() {
            let (s, across) = place(node, x);
            along[node] = s;
            let row = (side_of(trace, node as u32), across.map(key));
            found.entry(row).or_default().push(node as u32);
        }
        let mut of = vec![[0; 2]; positions.len()];
        let mut rows: Vec<Vec<u32>> = found.into_values().collect();
        for (r, row) in rows.iter_mut().enumerate() {
            row.sort_by(|&a, &b| along[a as usize].total_cmp(&along[b as usize]));
            for (place, &node) in row.iter().enumerate() {
                of[node as usize] = [r as u32, place as u32];
            }
        }
        Self { of, along, rows }
    }

    /// The node in the middle of the row of a node.
    fn middle(&self, node: u32) -> u32 {
        let row = &self.rows[self.of[node as usize][0] as usize];
        row[row.len() / 2]
    }

    /// The node that is to `middle`, of the row of `loaded`, what `node` is to `loaded`, if there is one at the same distance along.
    fn moved(&self, node: u32, loaded: u32, middle: u32) -> Option<u32> {
        let place = |n: u32| self.of[n as usize].map(i64::from);
        let [row, at] = place(node);
        let row = &self.rows[row as usize];
        let to = usize::try_from(at + place(middle)[1] - place(loaded)[1]).ok()?;
        let found = *row.get(to)?;
        let along = |n: u32| self.along[n as usize];
        let next = row.get(to + 1).or_else(|| row.get(to.checked_sub(1)?))?;
        let missed = (along(found) - along(middle)) - (along(node) - along(loaded));
        let pitch = (along(*next) - along(found)).abs();
        (missed.abs() < ALIKE * pitch).then_some(found)
    }

    /// The node whose column serves for `loaded`: the middle of its row, where that can be moved to all of `borne` of its side, or itself.
    pub(crate) fn source(&self, trace: &Trace, loaded: u32, borne: &[u32]) -> u32 {
        let middle = self.middle(loaded);
        let side = side_of(trace, loaded);
        let mut others = borne.iter().filter(|&&node| side_of(trace, node) == side);
        let alike = others.all(|&node| self.moved(node, loaded, middle).is_some());
        if alike { middle } else { loaded }
    }
}

impl Columns {
    /// Finds the column of a node of the `trace`, if there is none. Returns how many products it took, unless they were counted before.
    pub(crate) fn find(
        &mut self,
        node: u32,
        trace: &Trace,
        (operator, gradients): (&mut Operator, &mut ConjugateGradients<Vectors>),
        (system, nodes): (&mut System, &NodalState),
        [r, x]: [&mut Vectors; 2],
        frame: Frame,
    ) -> usize {
        if self.of.contains_key(&node) {
            return 0;
        }
        operator.set(system, nodes, Frame { angle: 0.0, with_hub: false, ..frame });
        let side = trace.side(side_of(trace, node));
        let mut column = vec![Matrix3::zeros(); side.len()];
        let mut products = 0;
        for along in 0..3 {
            r.set_zero();
            // a force on a node that moves as one with others stands for those on all of them
            for node in paired::group(&system.paired, trace.in_mesh(node)) {
                r.nodes[node as usize][along] = 1.0;
            }
            operator.reduce(system, nodes, &mut r.nodes);
            let mut matrix = StepMatrix { operator, system, nodes };
            products += gradients.solve(&mut matrix, r, x, TOLERANCE, MOST_PRODUCTS).1;
            for (block, &node) in column.iter_mut().zip(side) {
                block.set_column(along, &x.nodes[node as usize].vector());
            }
        }
        self.of.insert(node, column);
        if self.counted.insert(node) { products } else { 0 }
    }

    /// The velocity of `node` under unit forces on `loaded`, of the same side, by the column of `source`; that of the upper body
    /// turned by `angle` (rad).
    pub(crate) fn block(
        &self,
        trace: &Trace,
        rows: &Rows,
        [node, loaded, source]: [u32; 3],
        angle: Option<f64>,
    ) -> Matrix3<f64> {
        let first = if side_of(trace, loaded) == 0 { 0 } else { trace.side(0).len() };
        let at = rows.moved(node, loaded, source).unwrap_or(node);
        let block = self.of.get(&source).map_or(Matrix3::zeros(), |c| c[at as usize - first]);
        let beside = rows.along[loaded as usize] - rows.along[source as usize];
        match angle {
            Some(angle) if angle + beside != 0.0 => {
                let r = rotation_about_y(angle + beside);
                r * block * r.transpose()
            }
            _ => block,
        }
    }
}

/// The side of a node of the trace.
pub(crate) fn side_of(trace: &Trace, node: u32) -> usize {
    usize::from(node as usize >= trace.side(0).len())
}
