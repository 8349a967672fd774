//! Rows of quadrilaterals in the plane of one direction and the distance from the zone.
//!
//! The template that makes two columns of four, the zone above:
//!
//! ```text
//!   T0 ---- T1 ---- T2 ---- T3 ---- T4
//!   |        |       |       |       |
//!   |       I1 ---- I2 ---- I3       |
//!   |     /          |          \    |
//!   |  /             |             \ |
//!   B0 ------------- B1 ------------ B2
//! ```
//!
//! and the one that makes one of three:
//!
//! ```text
//!   T0 ---- T1 ---- T2 ---- T3
//!   |        |       |       |
//!   |       I1 ---- I2       |
//!   |     /            \     |
//!   |  /                  \  |
//!   B0 -------------------- B1
//! ```
//!
//! At the surface the right half of the first, from `T2 I2 B1` on, stands alone.
//!
//! Their left and right sides are single edges. Templates and plain quadrilaterals can therefore stand side by side in
//! one row, and a row may coarsen at any columns.

use super::plan::Layer;

/// Shift of `I1` and `I3` towards `I2`, over the width of a column between them. With it and a height of 2.2 widths
/// no corner of equal columns is sharper than a scaled Jacobian of 0.7.
const SHIFT: f64 = 0.1;

/// A corner of a quadrilateral of a row.
#[derive(Clone, Copy)]
pub(super) struct Spot {
    /// Line on which it lies, and the line towards which it is shifted.
    pub line: u32,
    pub toward: u32,
    /// Shift over the distance of the two lines.
    pub shift: f64,
    /// Twice the number of the layer above, one more inside the layer.
    pub level: u32,
    /// Distance from the zone (m).
    pub distance: f64,
}

impl Spot {
    fn on(line: u32, level: u32, distance: f64) -> Self {
        Self { line, toward: line, shift: 0.0, level, distance }
    }
}

/// The quadrilaterals of layer number `index` along `direction`: outer edge first, then inner edge.
pub(super) fn row(layer: &Layer, index: usize, direction: usize) -> Vec<[Spot; 4]> {
    let lines = &layer.lines[direction];
    let level = 2 * index as u32;
    let mut groups = layer.groups(direction).iter().peekable();
    let mut quads = Vec::with_capacity(lines.len() + 2 * groups.len());
    let mut column = 0;
    while column + 1 < lines.len() {
        let group = groups.next_if(|g| g.first == column);
        let columns = group.map_or(1, |g| g.columns);
        let within = group.map_or(layer.to, |g| g.inner);
        let lines = &lines[column..=column + columns];
        column += columns;
        let t = |i: usize| Spot::on(lines[i], level, layer.from);
        let b = |i: usize| Spot::on(lines[i], level + 2, layer.to);
        let inner = |i: usize| Spot::on(lines[i], level + 1, within);
        let shifted = |i: usize, j: usize| Spot { toward: lines[j], shift: SHIFT, ..inner(i) };
        match columns {
            4 => {
                let [i1, i2, i3] = [shifted(1, 2), inner(2), shifted(3, 2)];
                quads.extend([
                    [b(0), i1, t(1), t(0)],
                    [i1, i2, t(2), t(1)],
                    [b(0), b(2), i2, i1],
                    [b(2), b(4), i3, i2],
                    [i2, i3, t(3), t(2)],
                    [i3, b(4), t(4), t(3)],
                ]);
            }
            3 => {
                let [i1, i2] = [shifted(1, 2), shifted(2, 1)];
                quads.extend([
                    [b(0), i1, t(1), t(0)],
                    [i1, i2, t(2), t(1)],
                    [b(0), b(3), i2, i1],
                    [i2, b(3), t(3), t(2)],
                ]);
            }
            2 => {
                let [i0, i1] = [inner(0), shifted(1, 0)];
                quads.extend([[i0, i1, t(1), t(0)], [b(0), b(2), i1, i0], [i1, b(2), t(2), t(1)]]);
            }
            _ => quads.push([b(0), b(1), t(1), t(0)]),
        }
    }
    quads
}
