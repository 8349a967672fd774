//! Slip that alternates from node to node: a mode of the mesh, or slip that the mesh does not resolve.
//!
//! On a face with the slip velocities `s_1` to `s_4` around it, `(s_1 - s_2 + s_3 - s_4)/4` is the
//! amplitude of the hourglass mode of its nodes (Flanagan and Belytschko 1981). Its root mean square over the
//! faces in contact, over that of the slip of their nodes, is 0 for slip that varies smoothly (it falls with
//! the square of the element's size), 1 for slip that only alternates, and 1/2 where the slip of each node
//! knows nothing of its neighbours'. Along a line such slip looks like any other: no spectrum tells it apart.

use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Part of the slip beyond which it alternates: half of that of nodes that know nothing of each other.
pub const MESH_MODE_LIMIT: f64 = 0.25;
/// Part of the strain energy of the elements under the contact that their hourglass energy may be, as
/// handbooks of explicit codes have it for any part of a model.
pub const HOURGLASS_LIMIT: f64 = 0.1;
/// Slip below this part of the rolling speed is no slip, in root mean square: its shape says nothing.
pub const LEAST_SLIP: f64 = 1e-5;

/// Squares of slip over faces in contact, summed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MeshMode {
    /// Of the part that alternates around a face (m^2/s^2).
    pub alternating: f64,
    /// Of all slip, per face the mean over its nodes (m^2/s^2).
    pub all: f64,
    /// Faces, each with its weight.
    pub faces: f64,
}

impl MeshMode {
    /// Adds, with `weight`, those of `faces` (indices into `slip`, m/s) all nodes of which are in contact.
    pub fn add(
        &mut self,
        weight: f64,
        faces: &[[u32; 4]],
        slip: &[impl Copy + Into<Vector3<f64>>],
        in_contact: impl Fn(usize) -> bool,
    ) {
        for face in faces.iter().map(|face| face.map(|node| node as usize)) {
            if !face.iter().all(|&node| in_contact(node)) {
                continue;
            }
            let [a, b, c, d] = face.map(|node| slip[node].into());
            for i in 0..3 {
                let mode = 0.25 * (a[i] - b[i] + c[i] - d[i]);
                self.alternating += weight * mode * mode;
                let squares = a[i] * a[i] + b[i] * b[i] + c[i] * c[i] + d[i] * d[i];
                self.all += weight * 0.25 * squares;
            }
            self.faces += weight;
        }
    }

    /// Root mean square of the alternating part over that of all slip; none where the latter is below
    /// `least` (m/s).
    pub fn share(&self, least: f64) -> Option<f64> {
        let slips = self.faces > 0.0 && (self.all / self.faces).sqrt() > least;
        slips.then(|| (self.alternating / self.all).sqrt())
    }
}

/// What is to be said of slip of which `share` alternates, with elements of one point under the contact or
/// with fully integrated ones; nothing of slip that the mesh resolves.
pub fn warning(share: f64, one_point: bool) -> Option<&'static str> {
    (share > MESH_MODE_LIMIT).then_some(if one_point {
        "slip alternates from node to node: a mode of the mesh, not friction; fully integrated elements below \
         the contact do not have it"
    } else {
        "slip alternates from node to node and the elements have no such mode: this mesh does not resolve it \
         (refine it; where friction falls with slip velocity and has no memory, no mesh does)"
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Faces of a grid of n by n nodes, and slip of its nodes.
    fn grid(n: u32, slip: impl Fn(u32, u32) -> [f64; 3]) -> (Vec<[u32; 4]>, Vec<[f64; 3]>) {
        let node = |i: u32, j: u32| j * n + i;
        let faces = (0..n - 1)
            .flat_map(|j| (0..n - 1).map(move |i| (i, j)))
            .map(|(i, j)| [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)])
            .collect();
        let slip = (0..n * n).map(|k| slip(k % n, k / n)).collect();
        (faces, slip)
    }

    fn share(n: u32, slip: impl Fn(u32, u32) -> [f64; 3]) -> Option<f64> {
        let (faces, slip) = grid(n, slip);
        let mut mode = MeshMode::default();
        mode.add(1.0, &faces, &slip, |_| true);
        mode.share(1e-9)
    }

    #[test]
    fn slip_that_only_alternates_is_a_mode_of_the_mesh_altogether() {
        let sign = |i: u32, j: u32| if (i + j).is_multiple_of(2) { 1.0 } else { -1.0 };
        assert_eq!(share(8, |i, j| [0.3 * sign(i, j), -0.1 * sign(i, j), 0.0]), Some(1.0));
    }

    #[test]
    fn slip_that_varies_linearly_or_along_one_direction_alone_has_no_such_part() {
        let linear = share(8, |i, j| [f64::from(i) + 2.0 * f64::from(j), 1.0, 0.0]);
        assert!(linear.is_some_and(|share| share < 1e-15), "{linear:?}");
        let one_way = share(8, |i, _| [if i % 2 == 0 { 1.0 } else { -1.0 }, 0.0, 0.0]);
        assert_eq!(one_way, Some(0.0));
    }

    #[test]
    fn of_smooth_slip_it_falls_with_the_square_of_the_mesh_size() {
        let of = |n: u32| {
            let at = |i: u32| 3.0 * f64::from(i) / f64::from(n - 1);
            share(n, |i, j| [libm::sin(at(i)) * libm::cos(at(j)), 0.0, 0.0]).unwrap()
        };
        let order = libm::log2(of(21) / of(41));
        assert!((order - 2.0).abs() < 0.1, "{order}");
    }

    #[test]
    fn half_of_it_alternates_where_nodes_know_nothing_of_each_other() {
        // the finish of SplitMix64 (Steele, Lea and Flood 2014)
        let noise = |i: u32, j: u32| {
            let k = u64::from(j * 1000 + i + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
            let k = (k ^ (k >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            let k = (k ^ (k >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((k ^ (k >> 31)) >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        let found = share(200, |i, j| [noise(i, j), noise(j + 500, i), 0.0]).unwrap();
        assert!((found - 0.5).abs() < 0.01, "{found}");
    }

    #[test]
    fn faces_that_are_not_wholly_in_contact_and_slip_that_is_none_say_nothing() {
        let (faces, slip) = grid(3, |i, _| [f64::from(i) * 1e-7, 0.0, 0.0]);
        let mut mode = MeshMode::default();
        mode.add(1.0, &faces, &slip, |node| node != 4);
        assert_eq!(mode.faces, 0.0);
        mode.add(1.0, &faces, &slip, |_| true);
        assert_eq!((mode.faces, mode.share(1e-3)), (4.0, None));
    }
}
