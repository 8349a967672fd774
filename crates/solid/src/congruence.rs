//! Elements of one shape: congruent but for a translation and a turn about y, as generated bars and disks
//! have them by the thousand. Their reference gradients are computed once and shared.
//!
//! An element's shape is what its modes (module `kernel`) are in a frame turned about y such that its xi
//! direction, the sum of the corners with the signs of xi, has no z component. Material and element are
//! isotropic, so forces found in that frame and turned back are the element's. Elements count as
//! congruent where all modes agree to [`SAME`] of the element's size, the round-off of
//! coordinates: what is shared is exact, not an approximation.

use crate::blocks::BATCH;
use mesh::Mesh;
use std::collections::HashMap;

/// Largest difference of two modes of congruent elements over the largest mode.
const SAME: f64 = 2e-12;

/// Modes are sorted into cells of this part of the largest one before they are compared.
const CELL: f64 = 1e-9;

/// The turn of an element that counts as none: its sine.
const STRAIGHT: f64 = 1e-14;

/// Elements of a batch lie no farther from its first one than this many of their edges: what a thread
/// works on lies together.
const REACH: f64 = 32.0;

/// An element whose xi direction points along y by all but this part has no frame of its own.
const ALONG_Y: f64 = 1e-3;

/// Sums of corner coordinates with the signs of xi, eta, zeta, then eta zeta, zeta xi, xi eta,
/// xi eta zeta (m).
type Modes = [[f64; 3]; 7];

/// Reference gradients of a shape, in the notation and scaling of module `kernel`.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Shape {
    /// b_k/W
    pub(crate) b_per_w: [[f64; 3]; 3],
    /// c_a/W
    pub(crate) c_per_w: [[f64; 3]; 3],
    /// G_a
    pub(crate) g: [[f64; 3]; 4],
    /// W = 64 V
    pub(crate) w: f64,
    /// 512 B_iI B_iI
    pub(crate) squares: f64,
    /// squares/W
    pub(crate) squares_per_w: f64,
}

impl Shape {
    /// Of no element, to count with.
    pub(crate) const UNIT: Self = Self {
        b_per_w: [[1.0; 3]; 3],
        c_per_w: [[1.0; 3]; 3],
        g: [[1.0; 3]; 4],
        w: 1.0,
        squares: 1.0,
        squares_per_w: 1.0,
    };
}

/// Cosine and sine of the turn of the elements of a batch, lane by lane.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(crate) struct Turn {
    pub(crate) cos: [f64; BATCH],
    pub(crate) sin: [f64; BATCH],
}

/// A batch of elements of one shape.
#[derive(Clone, Debug)]
pub(crate) struct Alike {
    /// The elements, ascending.
    pub(crate) elements: [u32; BATCH],
    /// Index of the shape.
    pub(crate) shape: u32,
    /// None where no element is turned.
    pub(crate) turn: Option<Turn>,
}

/// Finds batches of elements of one shape among `list` (ascending); what is left over stays in `list`.
/// Batches are ordered by their first element; new shapes are added to `shapes`.
pub(crate) fn batches(mesh: &Mesh, list: &mut Vec<u32>, shapes: &mut Vec<Shape>) -> Vec<Alike> {
    let mut found: Vec<(Modes, Vec<Member>)> = Vec::new();
    let mut cells: HashMap<[i64; 21], usize> = HashMap::new();
    for &element in list.iter() {
        let (modes, cos, sin) = straightened(&modes(mesh, element));
        let member = Member { element, cos, sin };
        let size = largest(&modes);
        let cell: Vec<i64> =
            modes.as_flattened().iter().map(|m| (m / (CELL * size)).round() as i64).collect();
        let Ok(cell) = <[i64; 21]>::try_from(cell) else { continue };
        let next = found.len();
        let class = *cells.entry(cell).or_insert(next);
        if class == next {
            found.push((modes, vec![member]));
        } else if same(&found[class].0, &modes, size) {
            found[class].1.push(member);
        }
    }
    let mut alike = Vec::new();
    for (modes, members) in &found {
        // a linear mode is four edges
        let reach = REACH * 0.25 * largest(modes);
        let far = |a: &Member, b: &Member| {
            let [a, b] = [a, b].map(|m| mesh.nodes[mesh.hexes[m.element as usize][0] as usize]);
            (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>() > reach * reach
        };
        let index = shapes.len() as u32;
        let mut left = &members[..];
        while left.len() >= BATCH {
            if let Some(near) = left[1..BATCH].iter().position(|m| far(&left[0], m)) {
                left = &left[near + 1..];
                continue;
            }
            let (batch, rest) = left.split_at(BATCH);
            alike.push(together(batch, index));
            left = rest;
        }
        if alike.last().is_some_and(|batch| batch.shape == index) {
            shapes.push(shape(modes));
        }
    }
    alike.sort_by_key(|batch| batch.elements[0]);
    let mut taken: Vec<u32> = alike.iter().flat_map(|batch| batch.elements).collect();
    taken.sort_unstable();
    list.retain(|element| taken.binary_search(element).is_err());
    alike
}

fn together(members: &[Member], shape: u32) -> Alike {
    let lane = |of: fn(&Member) -> f64| {
        let mut lanes = [0.0; BATCH];
        lanes.iter_mut().zip(members).for_each(|(lane, member)| *lane = of(member));
        lanes
    };
    let turn = Turn { cos: lane(|m| m.cos), sin: lane(|m| m.sin) };
    let turned = members.iter().any(|m| m.sin.abs() > STRAIGHT || m.cos < 0.0);
    let mut elements = [0; BATCH];
    elements.iter_mut().zip(members).for_each(|(e, member)| *e = member.element);
    Alike { elements, shape, turn: turned.then_some(turn) }
}

#[derive(Clone, Copy, Debug)]
struct Member {
    element: u32,
    cos: f64,
    sin: f64,
}

fn modes(mesh: &Mesh, element: u32) -> Modes {
    const SIGNS: [[f64; 3]; 8] = [
        [-1.0, -1.0, -1.0],
        [1.0, -1.0, -1.0],
        [1.0, 1.0, -1.0],
        [-1.0, 1.0, -1.0],
        [-1.0, -1.0, 1.0],
        [1.0, -1.0, 1.0],
        [1.0, 1.0, 1.0],
        [-1.0, 1.0, 1.0],
    ];
    let hex = mesh.hexes[element as usize];
    let origin = mesh.nodes[hex[0] as usize];
    let mut modes = [[0.0; 3]; 7];
    for (&node, [xi, eta, zeta]) in hex.iter().zip(SIGNS) {
        let signs = [xi, eta, zeta, eta * zeta, zeta * xi, xi * eta, xi * eta * zeta];
        for (mode, sign) in modes.iter_mut().zip(signs) {
            for i in 0..3 {
                mode[i] += sign * (mesh.nodes[node as usize][i] - origin[i]);
            }
        }
    }
    modes
}

/// The modes in the element's frame, with the cosine and sine of its turn.
fn straightened(modes: &Modes) -> (Modes, f64, f64) {
    let [x, y, z] = modes[0];
    let length = x.hypot(z);
    let (cos, sin) = if length > ALONG_Y * y.abs() { (x / length, z / length) } else { (1.0, 0.0) };
    (modes.map(|[x, y, z]| [cos * x + sin * z, y, cos * z - sin * x]), cos, sin)
}

fn largest(modes: &Modes) -> f64 {
    modes.as_flattened().iter().fold(0.0, |largest: f64, m| largest.max(m.abs()))
}

fn same(a: &Modes, b: &Modes, size: f64) -> bool {
    a.as_flattened().iter().zip(b.as_flattened()).all(|(a, b)| (a - b).abs() <= SAME * size)
}

/// The gradients of `kernel::mean_gradient` for one shape.
fn shape(modes: &Modes) -> Shape {
    use crate::geometry::{cross, dot};
    let [a1, a2, a3, g1, g2, g3, g4] = *modes;
    let (a, g) = ([a1, a2, a3], [g1, g2, g3]);
    let sum = |x: [f64; 3], y: [f64; 3], third: f64| [0, 1, 2].map(|i| x[i] + third * y[i]);
    let mut b = [[0.0; 3]; 3];
    let mut c = b;
    for m in 0..3 {
        let (n, o) = ((m + 1) % 3, (m + 2) % 3);
        b[m] = sum(cross(a[n], a[o]), cross(g[o], g[n]), 1.0 / 3.0);
        c[m] = sum(cross(a[o], g[n]), cross(g[o], a[n]), 1.0).map(|x| x / 3.0);
    }
    let w = dot(a[0], b[0]) + dot(g[0], c[0]);
    let squares = b.iter().chain(&c).map(|v| dot(*v, *v)).sum::<f64>();
    Shape {
        b_per_w: b.map(|v| v.map(|x| x / w)),
        c_per_w: c.map(|v| v.map(|x| x / w)),
        g: [g1, g2, g3, g4],
        w,
        squares,
        squares_per_w: squares / w,
    }
}
