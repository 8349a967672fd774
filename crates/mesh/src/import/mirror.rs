//! The whole mesh of which a file holds the half y >= 0.

use super::foreign::{Foreign, Labels};
use nalgebra::Vector3;
use std::collections::BTreeSet;

impl Foreign {
    /// Adds the mirror image in y = 0 of nodes, elements and sets, in the unit of the file. Nodes nearer to the plane
    /// than `near` are put on it, and are their own images.
    ///
    /// Returns the image of each of the nodes that there were.
    pub fn mirror(&mut self, near: f64) -> Vec<u32> {
        let nodes = self.points.len();
        let mut image: Vec<u32> = (0..nodes as u32).collect();
        let mut copied = Vec::new();
        for n in 0..nodes {
            let point = self.points[n];
            if point.y.abs() < near {
                self.points[n].y = 0.0;
                continue;
            }
            image[n] = self.points.len() as u32;
            self.points.push(Vector3::new(point.x, -point.y, point.z));
            copied.push(n);
        }
        self.nodes.repeat(copied.into_iter());
        let of = |n: u32| image[n as usize];
        let elements = self.hexes.len();
        for e in 0..elements {
            // the other way round, so that it is not inverted
            let [a, b, c, d, e, f, g, h] = self.hexes[e].map(of);
            self.hexes.push([d, c, b, a, h, g, f, e]);
        }
        self.elements.repeat(0..elements);
        for set in self.sets.values_mut() {
            let there: BTreeSet<u32> = set.nodes.iter().copied().collect();
            set.nodes.extend(there.iter().map(|n| of(*n)).filter(|n| !there.contains(n)));
            set.faces
                .extend(set.faces.clone().into_iter().map(|[a, b, c, d]| [d, c, b, a].map(of)));
            set.hexes.extend(set.hexes.clone().into_iter().map(|e| e + elements as u32));
        }
        image
    }
}

impl Labels {
    /// Appends entries for copies of others, which have their lines and numbers above all.
    fn repeat(&mut self, copied: impl Iterator<Item = usize>) {
        let Some(last) = self.ids.iter().copied().max() else { return };
        for (k, index) in (1..).zip(copied) {
            self.ids.push(last.saturating_add(k));
            self.lines.extend(self.lines.get(index).copied());
        }
    }
}
