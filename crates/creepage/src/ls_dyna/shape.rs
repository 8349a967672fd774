//! The shapes of the bodies of a keyword file, measured on the mesh, and their place in Creepage's frame.

use crate::ls_dyna::model::Model;
use std::collections::BTreeSet;

/// Bodies that are nearer to their places than this (m) stay: a file prints no more digits.
const IN_PLACE: f64 = 1e-9;

/// Shapes that the case gives, measured on the mesh (m).
pub(crate) struct Shape {
    /// Where the axle was in the deck (x, z).
    pub(crate) axle: [f64; 2],
    pub(crate) radius: f64,
    pub(crate) hub_radius: f64,
    pub(crate) disk_width: f64,
    pub(crate) disk_crown: Option<f64>,
    pub(crate) length: f64,
    pub(crate) bar_width: f64,
    pub(crate) height: f64,
    pub(crate) bar_crown: Option<f64>,
    pub(crate) start: f64,
    pub(crate) zone: Zone,
}

/// The fine part of the bar's top.
pub(crate) struct Zone {
    pub(crate) size: f64,
    pub(crate) start: f64,
    pub(crate) length: f64,
    pub(crate) width: f64,
}

impl Model {
    /// Moves the bodies into Creepage's frame: the disk's axis at x = 0, the bar's apex at
    /// z = 0 and the disk on it, both centred on y = 0. Returns their shapes; `notes` says what was moved.
    pub(crate) fn place(&mut self, notes: &mut Vec<String>) -> Shape {
        let top = self.extent(&mut self.faces("top").iter().flatten().copied());
        let bodies = [0, 1].map(|b| self.extent(&mut self.nodes[b].iter().copied()));
        let middle = |[low, high]: [f64; 2]| 0.5 * (low + high);
        let across = middle(bodies[0][1]);
        let ([axis, height], radius) = self.running_circle(across);
        let lowest = height - radius;
        let drop = lowest - top[2][1];
        let needed = |by: f64| if by.abs() < IN_PLACE { 0.0 } else { by };
        let moves = [[-axis, -across, -lowest], [-axis, -middle(bodies[1][1]), -top[2][1]]];
        let moves = moves.map(|by| by.map(needed));
        for (body, by) in moves.iter().enumerate() {
            for &n in &self.nodes[body] {
                let point = &mut self.foreign.points[n as usize];
                (0..3).for_each(|a| point[a] += by[a]);
            }
        }
        if drop.abs() > 1e-9 {
            notes.push(format!("the disk is moved by {:.3e} m in z, to touch the bar", -drop));
        }
        if axis.abs() > 1e-9 {
            notes.push(format!(
                "both bodies are moved by {:.6} m in x: rolling starts at x = 0",
                -axis
            ));
        }
        let [disk, bar] = [0, 1].map(|b| self.extent(&mut self.nodes[b].iter().copied()));
        let span = |[low, high]: [f64; 2]| high - low;
        let points = &self.foreign.points;
        let from_axis = |n: u32| {
            let p = points[n as usize];
            libm::hypot(p[0], p[2] - radius)
        };
        let hub = self.foreign.sets["hub"].nodes.iter().map(|&n| from_axis(n));
        let rim: Vec<[f64; 2]> = self
            .faces("tread")
            .iter()
            .flatten()
            .map(|&n| [points[n as usize][1], radius - from_axis(n)])
            .collect();
        let head: Vec<[f64; 2]> = self
            .faces("top")
            .iter()
            .flatten()
            .map(|&n| [points[n as usize][1], -points[n as usize][2]])
            .collect();
        Shape {
            axle: [axis, height],
            radius,
            hub_radius: hub.fold(0.0, f64::max),
            disk_width: span(disk[1]),
            disk_crown: crown(&rim),
            length: span(bar[0]),
            bar_width: span(bar[1]),
            height: -bar[2][0],
            bar_crown: crown(&head),
            start: bar[0][0],
            zone: self.zone(bar[0], span(bar[1]).min(span(disk[1]))),
        }
    }

    /// Centre (x, z) and radius of the circle through the tread's nodes nearest to y = `across`.
    ///
    /// Source: Kåsa (1976), "A circle fitting procedure and its error analysis": the linear least
    /// squares of x^2 + z^2 = 2 a x + 2 b z + c.
    fn running_circle(&self, across: f64) -> ([f64; 2], f64) {
        let nodes: BTreeSet<u32> = self.faces("tread").iter().flatten().copied().collect();
        let at = |n: u32| self.foreign.points[n as usize];
        let off = |n: u32| (at(n)[1] - across).abs();
        let least = nodes.iter().map(|&n| off(n)).fold(f64::INFINITY, f64::min);
        let ring: Vec<[f64; 2]> = nodes
            .iter()
            .filter(|n| off(**n) <= least + 1e-6)
            .map(|&n| [at(n)[0], at(n)[2]])
            .collect();
        let count = ring.len() as f64;
        let mean = [0, 1].map(|i| ring.iter().map(|p| p[i]).sum::<f64>() / count);
        let (mut xx, mut xz, mut zz, mut xr, mut zr, mut rr) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
        for p in &ring {
            let (x, z) = (p[0] - mean[0], p[1] - mean[1]);
            let r = x * x + z * z;
            (xx, xz, zz) = (xx + x * x, xz + x * z, zz + z * z);
            (xr, zr, rr) = (xr + x * r, zr + z * r, rr + r);
        }
        let twice = 2.0 * (xx * zz - xz * xz);
        let (a, b) = ((xr * zz - zr * xz) / twice, (zr * xx - xr * xz) / twice);
        ([mean[0] + a, mean[1] + b], (rr / count + a * a + b * b).sqrt())
    }

    /// The fine zone: the part of the bar's top whose faces are about as large as the one nearest to the first
    /// contact, between x = `ends[0]` and `ends[1]` (m) and no wider than `width` (m).
    fn zone(&self, ends: [f64; 2], width: f64) -> Zone {
        let points = &self.foreign.points;
        let faces: Vec<([f64; 2], f64)> = self
            .faces("top")
            .iter()
            .map(|face| {
                let corners = face.map(|n| points[n as usize]);
                let at = |a: usize| 0.25 * corners.iter().map(|p| p[a]).sum::<f64>();
                let area: f64 = mesh::quad_corner_areas(&corners).iter().sum();
                ([at(0), at(1)], area.sqrt())
            })
            .collect();
        let distance = |f: &&([f64; 2], f64)| libm::hypot(f.0[0], f.0[1]);
        let nearest = faces.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let size = nearest.map_or(1e-3, |f| f.1);
        let (mut x, mut y) = ([0.0f64; 2], 0.0f64);
        for (at, edge) in &faces {
            if (0.7..1.3).contains(&(edge / size)) {
                x = [x[0].min(at[0] - 0.5 * size), x[1].max(at[0] + 0.5 * size)];
                y = y.max(at[1].abs() + 0.5 * size);
            }
        }
        let x = [x[0].max(ends[0]), x[1].min(ends[1])];
        Zone { size, start: x[0], length: x[1] - x[0], width: width.min(2.0 * y) }
    }
}

/// Radius of the crown (m) from points (y, depth below the apex) of the running surface: that of the circle through
/// the apex and the outermost points. None for a flat surface.
fn crown(profile: &[[f64; 2]]) -> Option<f64> {
    let widest = profile.iter().map(|p| p[0].abs()).fold(0.0, f64::max);
    let rim: Vec<_> = profile.iter().filter(|p| p[0].abs() > 0.999 * widest).collect();
    let sag = rim.iter().map(|p| p[1]).sum::<f64>() / rim.len().max(1) as f64;
    (sag > 1e-5 * widest).then(|| (widest * widest + sag * sag) / (2.0 * sag))
}
