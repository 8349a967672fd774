//! Nodes and elements of the zone and its shells.

use super::fan::{HIGH, LOW};
use super::plan::{Bulk, Layer, Patch, S, Y, Z};
use super::row::{Spot, row};
use std::collections::HashMap;

/// Where a node lies, a sum of these.
pub(crate) const TOP: u8 = 1;
pub(crate) const ZONE: u8 = 2;
pub(crate) const BOTTOM: u8 = 4;
pub(crate) const REAR: u8 = 8;
pub(crate) const FRONT: u8 = 16;

/// Places along s are compared in this fraction of an element of the zone, far above round-off.
const STEP: f64 = 1.0 / 1024.0;

/// A node: its coordinates s, y, depth (m), and where it lies.
pub(super) struct Node {
    pub x: [f64; 3],
    pub flags: u8,
}

/// A node by its lines, its level, and a spot along one of the directions.
#[derive(Clone, Copy)]
struct Place {
    lines: [u32; 3],
    direction: usize,
    spot: Spot,
}

/// Nodes and elements in the order in which they are made, each with its place along s in steps.
pub(super) struct Draft<'a> {
    bulk: &'a Bulk,
    /// Place along s, coordinates s, y, depth (m), and where the node lies.
    nodes: Vec<(i64, [f64; 3], u8)>,
    hexes: Vec<(i64, [u32; 8])>,
    known: HashMap<[u32; 4], u32>,
}

impl<'a> Draft<'a> {
    pub fn new(bulk: &'a Bulk) -> Self {
        Self { bulk, nodes: Vec::new(), hexes: Vec::new(), known: HashMap::new() }
    }

    /// Adds the zone: from the rear to the front, downwards, across.
    pub fn zone(&mut self) {
        let [n_s, n_y, n_z] = self.bulk.fans.each_ref().map(|f| f.last());
        let spot = |line| Spot { line, toward: line, shift: 0.0, level: 0, distance: 0.0 };
        // The nodes first: each column then has its own together, in order.
        for i in 0..=n_s {
            for k in 0..=n_z {
                for j in 0..=n_y {
                    self.node(Place { lines: [i, j, k], direction: S, spot: spot(i) });
                }
            }
        }
        for i in 0..n_s {
            for k in 0..n_z {
                let quad = [(i, k + 1), (i + 1, k + 1), (i + 1, k), (i, k)];
                for j in 0..n_y {
                    let corners = [j, j + 1].map(|j| {
                        quad.map(|(i, k)| Place { lines: [i, j, k], direction: S, spot: spot(i) })
                    });
                    self.hex(corners, true);
                }
            }
        }
    }

    /// Adds layer number `index`.
    pub fn layer(&mut self, layer: &Layer, index: usize) {
        for patch in self.bulk.patches(layer.from) {
            let [a, b] = patch.along;
            // The row runs along the direction that merges, and is extruded along the other.
            let [a, b] = if layer.groups(b).is_empty() { [a, b] } else { [b, a] };
            let outermost = if patch.side == LOW { 0 } else { self.bulk.fans[patch.across].last() };
            let quads = row(layer, index, a);
            let positive = is_positive(&patch, a, b);
            for strip in layer.lines[b].windows(2) {
                for quad in &quads {
                    let corners = [strip[0], strip[1]].map(|line| {
                        quad.map(|spot| {
                            let mut lines = [outermost; 3];
                            (lines[a], lines[b]) = (spot.line, line);
                            Place { lines, direction: a, spot }
                        })
                    });
                    self.hex(corners, positive);
                }
            }
        }
    }

    /// Coordinates s, y, depth (m).
    fn position(&self, place: &Place) -> [f64; 3] {
        let Spot { toward, shift, distance, .. } = place.spot;
        let fans = &self.bulk.fans;
        let mut x: [f64; 3] = std::array::from_fn(|a| fans[a].at(place.lines[a], distance));
        if shift > 0.0 {
            let a = place.direction;
            x[a] += shift * (fans[a].at(toward, distance) - x[a]);
        }
        x
    }

    fn steps(&self, s: f64) -> i64 {
        (s / (STEP * self.bulk.size)).round() as i64
    }

    fn node(&mut self, mut place: Place) -> u32 {
        let [s, y, z] = &self.bulk.fans;
        let distance = place.spot.distance;
        let ends = [LOW, HIGH].map(|side| s.is_end(place.lines[S], side, distance));
        if self.bulk.radius.is_some() && ends[LOW] {
            place.lines[S] = s.last();
        }
        let [i, j, k] = place.lines;
        let name = [i, j, k, place.spot.level];
        if let Some(&known) = self.known.get(&name) {
            return known;
        }
        let top = k == 0;
        let flags = [
            (top, TOP),
            (top && place.spot.level == 0 && s.zone.contains(&i) && y.zone.contains(&j), ZONE),
            (z.is_end(k, HIGH, distance), BOTTOM),
            (ends[LOW], REAR),
            (ends[HIGH], FRONT),
        ];
        let flags = flags.iter().filter(|(holds, _)| *holds).map(|(_, flag)| flag).sum();
        let x = self.position(&place);
        let node = self.nodes.len() as u32;
        self.nodes.push((self.steps(x[S]), x, flags));
        self.known.insert(name, node);
        node
    }

    /// Adds the element between two quadrilaterals; with `positive` they follow one another in the sense of the
    /// coordinates s, y, depth.
    fn hex(&mut self, corners: [[Place; 4]; 2], positive: bool) {
        let s = corners.as_flattened().iter().map(|p| self.position(p)[S]).sum::<f64>() / 8.0;
        let [a, b] = corners.map(|quad| quad.map(|place| self.node(place)));
        // Depth counts downwards on the bar, and so makes its coordinates left-handed.
        let forward = positive == self.bulk.radius.is_some();
        let [[a, b, c, d], [e, f, g, h]] = if forward { [a, b] } else { [b, a] };
        self.hexes.push((self.steps(s), [a, b, c, d, e, f, g, h]));
    }

    /// Nodes and elements, sorted along s.
    pub fn sorted(self) -> (Vec<Node>, Vec<[u32; 8]>) {
        let mut order: Vec<u32> = (0..self.nodes.len() as u32).collect();
        order.sort_by_key(|&n| self.nodes[n as usize].0);
        let mut place = vec![0u32; order.len()];
        for (new, &old) in order.iter().enumerate() {
            place[old as usize] = new as u32;
        }
        let nodes = order.iter().map(|&n| {
            let (_, x, flags) = self.nodes[n as usize];
            Node { x, flags }
        });
        let nodes = nodes.collect();
        let mut hexes = self.hexes;
        hexes.sort_by_key(|(s, _)| *s);
        (nodes, hexes.into_iter().map(|(_, h)| h.map(|n| place[n as usize])).collect())
    }
}

/// Whether a row along `a`, whose quadrilaterals run along `a` first and then towards the zone, and the extrusion along
/// `b` make a right-handed system of s, y, depth.
fn is_positive(patch: &Patch, a: usize, b: usize) -> bool {
    // a x (towards the zone) . b = -(a x outwards) . b
    let even = [(S, Y), (Y, Z), (Z, S)].contains(&(a, patch.across));
    debug_assert_eq!(a + b + patch.across, S + Y + Z);
    let outwards = patch.side == HIGH;
    even != outwards
}
