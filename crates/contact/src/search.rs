//! Which nodes are near the other surface: a bounding-volume search over the zone in reach,
//! repeated only when motion could have made its answer incomplete.
//!
//! # Why nothing is missed
//! Let `m` be the margin and `D` the distance of a slave node from a face. A search lists all
//! nodes with `D < m` for some face, and every listed node finds its face by walking over the
//! surface. It also gives each node a clearance `c >= m`: a lower bound on the distance of its
//! faces from the other surface, as far as such distances are not below `m` (those points are
//! listed). A point that is not listed has `D >= m`, `D >= c` of the node and `D >= c` of the face's
//! corners. So it cannot close while every node has moved by less than half its clearance, in any
//! frame common to both bodies (the frame moves with the mean of the listed nodes): the two motions
//! together stay below `max(c_node, c_face) <= D`. The largest used part of the allowance is
//! measured every few steps, together with how far nodes went since the last measurement: the next
//! comes before twice that motion per step could use up the rest, and after [`LONGEST_INTERVAL`]
//! steps at the latest, since motion that has just turned round starts from nothing. The search is
//! repeated once [`DUE`] of the allowance is used: what is left covers the acceleration within an
//! interval (with 1 mm faces and 0.2 us steps, 10^7 m/s^2).
//!
//! The boxes of faces reach half a face size into the body, so that nodes that have penetrated at
//! the first call are found too. Pairs that are closed stay listed until they open.

use crate::face::Positions;
use crate::surface::{ContactSurface, NONE};
use mesh::BoxTree;
use nalgebra::Vector3;
use serde::{Deserialize, Serialize};

/// Margin in terms of the smallest face: small, for few open points; large enough that a rolling
/// disk is searched every few hundred steps.
const MARGIN: f64 = 0.1;
/// Distances are resolved up to this many margins.
const RESOLVED: f64 = 4.0;
/// Depth of a face's box into its body in terms of the face's size.
const DEPTH: f64 = 0.5;
/// Steps between two looks at the motion, at most.
const LONGEST_INTERVAL: u32 = 8;
/// Part of the allowance at which the search is repeated.
const DUE: f64 = 0.7;

/// A box of a face, `[low, high]`.
pub(crate) type Span = [Vector3<f64>; 2];

const NOTHING: Span = {
    let far = f64::INFINITY;
    [Vector3::new(far, far, far), Vector3::new(-far, -far, -far)]
};

/// A slave node that the search lists because it is near the other surface.
pub(crate) trait Listed: Copy {
    /// An open node whose projection is to be sought from `face`.
    fn near(slave: u32, face: u32) -> Self;
    /// The node, in its surface.
    fn slave(&self) -> u32;
    /// Closed nodes stay listed.
    fn is_closed(&self) -> bool;
}

/// When to search again.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Search {
    #[serde(skip)]
    pub margin: f64,
    /// Positions of the surface nodes at the last search.
    pub at: [Vec<Vector3<f64>>; 2],
    /// One over the square of the motion allowed to each surface node (1/m^2).
    pub allowance: [Vec<f64>; 2],
    /// Motion of the surface nodes since the last search, at the last look (m).
    pub moved: [Vec<Vector3<f64>>; 2],
    pub steps_to_check: u32,
    pub steps_since_check: u32,
    /// Nearest master face of each node in the search under way.
    #[serde(skip)]
    nearest: [Vec<(f64, u32)>; 2],
    #[serde(skip)]
    spans: [Vec<Span>; 2],
}

impl Search {
    pub fn new(sides: &[ContactSurface; 2]) -> Self {
        let smallest =
            sides.iter().flat_map(|s| &s.faces).map(|f| f.size).fold(f64::INFINITY, f64::min);
        let margin = MARGIN * smallest;
        Self {
            margin,
            at: [const { Vec::new() }; 2],
            allowance: [const { Vec::new() }; 2],
            moved: [const { Vec::new() }; 2],
            steps_to_check: 0,
            steps_since_check: 0,
            nearest: [const { Vec::new() }; 2],
            spans: [const { Vec::new() }; 2],
        }
    }

    /// Searches at the next call, whatever moved.
    pub fn forget(&mut self) {
        self.at = [const { Vec::new() }; 2];
        self.allowance = [const { Vec::new() }; 2];
        self.moved = [const { Vec::new() }; 2];
    }

    /// Looks at the motion at the next call, however small it was so far.
    pub fn expect_jump(&mut self) {
        self.steps_to_check = 0;
    }

    /// Whether the lists could be incomplete before the next check.
    pub fn is_due(
        &mut self,
        sides: &[ContactSurface; 2],
        positions: &Positions<'_>,
        points: &[Vec<impl Listed>; 2],
    ) -> bool {
        if self.at[0].is_empty() {
            return true;
        }
        self.steps_since_check += 1;
        if self.steps_since_check < self.steps_to_check {
            return false;
        }
        let frame = self.mean_motion(sides, positions, points);
        let (mut used, mut went) = (0.0_f64, 0.0_f64);
        for side in 0..2 {
            for (i, node) in sides[side].nodes().enumerate() {
                let moved = positions.at(node) - self.at[side][i] - frame;
                let last = moved - self.moved[side][i];
                self.moved[side][i] = moved;
                let allowance = self.allowance[side][i];
                used = used.max(moved.norm_squared() * allowance);
                went = went.max(last.norm_squared() * allowance);
            }
        }
        let used = used.sqrt();
        let per_step = went.sqrt() / f64::from(self.steps_since_check);
        let steps = 0.5 * (1.0 - used) / per_step;
        // A saturating cast: 0/0 and infinity give the longest interval.
        self.steps_to_check = (steps.min(f64::from(LONGEST_INTERVAL))) as u32;
        self.steps_since_check = 0;
        used >= DUE || self.steps_to_check == 0
    }

    fn mean_motion(
        &self,
        sides: &[ContactSurface; 2],
        positions: &Positions<'_>,
        points: &[Vec<impl Listed>; 2],
    ) -> Vector3<f64> {
        let mut sum = Vector3::zeros();
        let mut count = 0.0;
        for side in 0..2 {
            for point in &points[side] {
                let i = point.slave() as usize;
                sum += positions.at(sides[side].node(point.slave())) - self.at[side][i];
                count += 1.0;
            }
        }
        if count > 0.0 { sum * (1.0 / count) } else { sum }
    }

    /// Lists the nodes within the margin of the other surface as points, ascending; closed points
    /// of the old lists are kept as they are.
    pub fn refresh(
        &mut self,
        sides: &[ContactSurface; 2],
        positions: &Positions<'_>,
        points: &mut [Vec<impl Listed>; 2],
    ) {
        let far = RESOLVED * self.margin;
        for side in 0..2 {
            let surface = &sides[side];
            self.at[side].clear();
            self.at[side].extend(surface.nodes().map(|n| positions.at(n)));
            self.moved[side].clear();
            self.moved[side].resize(surface.len(), Vector3::zeros());
            self.spans[side].clear();
            self.spans[side]
                .extend((0..surface.faces.len()).map(|f| span(surface, f, &self.at[side])));
            self.nearest[side].clear();
            self.nearest[side].resize(surface.len(), (f64::INFINITY, NONE));
        }
        let whole = [0, 1].map(|side| hull(self.spans[side].iter()));
        let mut clearance = [0, 1].map(|side: usize| {
            let spans = &self.spans[side];
            spans.iter().map(|s| distance(s, &whole[1 - side]).max(far)).collect::<Vec<f64>>()
        });
        let reach = self.reach(&whole, far);
        let tree = BoxTree::new(reach[1].iter().map(|&g| self.spans[1][g as usize]));
        let mut near = Vec::new();
        for &f in &reach[0] {
            tree.near(self.spans[0][f as usize], far, &mut near);
            for g in near.iter().map(|&g| reach[1][g as usize]) {
                let d = distance(&self.spans[0][f as usize], &self.spans[1][g as usize]);
                for (side, face) in [(0, f), (1, g)] {
                    let c = &mut clearance[side][face as usize];
                    *c = c.min(d.max(self.margin));
                }
                if d < self.margin {
                    self.list(sides, f, g);
                }
            }
        }
        for side in 0..2 {
            let allowance = &mut self.allowance[side];
            allowance.clear();
            allowance.resize(sides[side].len(), 0.0);
            for (face, c) in sides[side].faces.iter().zip(&clearance[side]) {
                for node in face.local {
                    let a = &mut allowance[node as usize];
                    *a = a.max(4.0 / (c * c));
                }
            }
            points[side] = merged(&points[side], &self.nearest[side]);
        }
        self.steps_since_check = 0;
        self.steps_to_check = 1;
    }

    /// The faces of each side whose boxes come near the other side: what lies outside of the
    /// common part of the hulls is dropped, twice.
    fn reach(&self, whole: &[Span; 2], far: f64) -> [Vec<u32>; 2] {
        let mut reach =
            [0, 1].map(|side: usize| (0..self.spans[side].len() as u32).collect::<Vec<u32>>());
        let mut hulls = *whole;
        for _ in 0..2 {
            for side in 0..2 {
                let other = hulls[1 - side];
                reach[side].retain(|&f| distance(&self.spans[side][f as usize], &other) < far);
            }
            hulls = [0, 1].map(|side: usize| {
                hull(reach[side].iter().map(|&f| &self.spans[side][f as usize]))
            });
        }
        reach
    }

    /// Notes that faces `f` of side 0 and `g` of side 1 are near one another.
    fn list(&mut self, sides: &[ContactSurface; 2], f: u32, g: u32) {
        for (slave, own, master, face) in [(0, f, 1, g), (1, g, 0, f)] {
            let corners = sides[master].faces[face as usize].local;
            let sum: Vector3<f64> = corners.iter().map(|&c| self.at[master][c as usize]).sum();
            let centre = 0.25 * sum;
            for node in sides[slave].faces[own as usize].local {
                let d = (self.at[slave][node as usize] - centre).norm_squared();
                let best = &mut self.nearest[slave][node as usize];
                if d < best.0 || (d == best.0 && face < best.1) {
                    *best = (d, face);
                }
            }
        }
    }
}

/// The old closed points and the newly listed ones, ascending by slave.
fn merged<P: Listed>(old: &[P], nearest: &[(f64, u32)]) -> Vec<P> {
    let mut closed = old.iter().filter(|p| p.is_closed()).peekable();
    let mut result = Vec::with_capacity(old.len() + old.len() / 2 + 64);
    for (slave, &(_, face)) in nearest.iter().enumerate() {
        match closed.next_if(|p| p.slave() as usize == slave) {
            Some(point) => result.push(*point),
            None if face != NONE => result.push(P::near(slave as u32, face)),
            None => {}
        }
    }
    result
}

/// Box of a face and of what lies behind it; nowhere if a coordinate is not finite.
fn span(surface: &ContactSurface, face: usize, at: &[Vector3<f64>]) -> Span {
    let face = &surface.faces[face];
    let x = face.local.map(|n| at[n as usize]);
    let outward = (x[2] - x[0]).cross(&(x[3] - x[1]));
    let inward = outward * (-DEPTH * face.size / outward.norm().max(f64::MIN_POSITIVE));
    let mut span = NOTHING;
    for point in x.into_iter().flat_map(|corner| [corner, corner + inward]) {
        if !point.iter().all(|c| c.is_finite()) {
            return NOTHING;
        }
        span = common_hull(&span, &[point; 2]);
    }
    span
}

fn hull<'a>(spans: impl Iterator<Item = &'a Span>) -> Span {
    spans.fold(NOTHING, |all, span| common_hull(&all, span))
}

fn common_hull(a: &Span, b: &Span) -> Span {
    [a[0].inf(&b[0]), a[1].sup(&b[1])]
}

/// Distance of two boxes; infinite from [`NOTHING`].
fn distance(a: &Span, b: &Span) -> f64 {
    (a[0] - b[1]).sup(&(b[0] - a[1])).sup(&Vector3::zeros()).norm()
}

/// Calls `visit` for all faces `f` of side 0 and `g` of side 1 whose boxes in the configuration
/// `positions` lie within `sizes` face sizes of one another.
pub(crate) fn neighbours(
    sides: &[ContactSurface; 2],
    positions: &Positions<'_>,
    sizes: f64,
    mut visit: impl FnMut(usize, usize),
) {
    let spans = [0, 1].map(|side: usize| {
        let at: Vec<Vector3<f64>> = sides[side].nodes().map(|n| positions.at(n)).collect();
        (0..sides[side].faces.len()).map(|f| span(&sides[side], f, &at)).collect::<Vec<Span>>()
    });
    let tree = BoxTree::new(spans[1].iter().copied());
    let mut near = Vec::new();
    for (f, &span) in spans[0].iter().enumerate() {
        tree.near(span, sizes * sides[0].faces[f].size, &mut near);
        near.iter().for_each(|&g| visit(f, g as usize));
    }
}
