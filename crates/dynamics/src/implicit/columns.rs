//! The compliance of the contact surfaces over an implicit step: columns of A^-1, found as contact comes to nodes.
//!
//! A column depends on its node, the step and the undeformed bodies alone, so that it does not matter to the result when it was found.

use super::operator::{ConjugateGradients, Frame, Operator, Vectors};
use crate::nodal_state::NodalState;
use crate::paired;
use crate::system::System;
use contact::{Matrix3, Trace};
use std::collections::HashMap;

/// Part to which the residual of a column falls: contact works with columns that are nearly right, and corrects what they miss.
const TOLERANCE: f64 = 0.03;
const MOST_PRODUCTS: usize = 200;

/// Columns for one time step.
#[derive(Debug, Default)]
pub(crate) struct Columns {
    /// By the node of the trace: the velocities (m/s) of all nodes of its side of the trace under unit forces on it, along x, y and z.
    of: HashMap<u32, Vec<Matrix3>>,
}

impl Columns {
    /// Finds the column of a node of the `trace`, if there is none. Returns how many products it took.
    pub(crate) fn find(
        &mut self,
        node: u32,
        trace: &Trace,
        (operator, gradients): (&mut Operator, &mut ConjugateGradients),
        (system, nodes): (&mut System, &NodalState),
        [r, x]: [&mut Vectors; 2],
        frame: Frame,
    ) -> usize {
        if self.of.contains_key(&node) {
            return 0;
        }
        operator.set(system, nodes, Frame { angle: 0.0, with_hub: false, ..frame });
        let side = trace.side(side_of(trace, node));
        let mut column = vec![[[0.0; 3]; 3]; side.len()];
        let mut products = 0;
        for along in 0..3 {
            *r = Vectors::new(r.nodes.len());
            r.nodes[trace.in_mesh(node) as usize][along] = 1.0;
            // the force on the first of a pair stands for those on both
            paired::follow(&system.paired, &mut r.nodes);
            operator.reduce(system, nodes, &mut r.nodes);
            let work = (&mut *system, nodes);
            products += gradients.solve(operator, work, r, x, (TOLERANCE, MOST_PRODUCTS));
            for (block, &node) in column.iter_mut().zip(side) {
                for (row, v) in block.iter_mut().zip(x.nodes[node as usize].xyz()) {
                    row[along] = v;
                }
            }
        }
        self.of.insert(node, column);
        products
    }

    /// The velocity of `node` under unit forces on `loaded`, of the same side, which has a column; that of the disk turned by `angle` (rad).
    pub(crate) fn block(&self, trace: &Trace, [node, loaded]: [u32; 2], angle: Option<f64>) -> Matrix3 {
        let first = if side_of(trace, loaded) == 0 { 0 } else { trace.side(0).len() };
        let block = self.of.get(&loaded).map_or([[0.0; 3]; 3], |c| c[node as usize - first]);
        match angle {
            None | Some(0.0) => block,
            Some(angle) => turned(block, angle),
        }
    }
}

/// The side of a node of the trace.
pub(crate) fn side_of(trace: &Trace, node: u32) -> usize {
    usize::from(node as usize >= trace.side(0).len())
}

/// `R c R^T` with the turn R about +y.
fn turned(c: Matrix3, angle: f64) -> Matrix3 {
    let (sin, cos) = libm::sincos(angle);
    let r = [[cos, 0.0, sin], [0.0, 1.0, 0.0], [-sin, 0.0, cos]];
    let product = |a: Matrix3, b: Matrix3| {
        a.map(|row| [0, 1, 2].map(|j: usize| (0..3).map(|k| row[k] * b[k][j]).sum::<f64>()))
    };
    let transposed = [0, 1, 2].map(|i: usize| r.map(|row| row[i]));
    product(product(r, c), transposed)
}
