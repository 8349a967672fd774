//! The plane mesh of a ring, coarsened towards its inside without hanging nodes.
//!
//! Columns of the fine zone taper towards the hub, where they would limit the time step. In a
//! *transition* the three columns between `T0` and `T3` of the row above continue as one, `B0 B1`:
//!
//! ```text
//!   T0 ---- T1 ---- T2 ---- T3
//!   |        |       |       |      quads (counter-clockwise)
//!   |       I1 ---- I2       |        B0 B1 I2 I1
//!   |     /            \     |        I1 I2 T2 T1
//!   |  /                  \  |        B0 I1 T1 T0
//!   B0 -------------------- B1        B1 T3 T2 I2
//! ```
//!
//! Its left and right sides are single edges. Transitions and plain quads can therefore stand side by side
//! in one row, and each row may coarsen at any column.

/// A row coarsens three columns where its height is at least this many times their largest width.
const HEIGHT_TO_WIDTH: f64 = 2.4;

/// Largest ratio of the widest to the narrowest of three columns that become one.
const WIDTH_RATIO: f64 = 3.0;

/// Largest angle of a column made by coarsening (rad): 24 columns around the hub or more.
const WIDEST_COLUMN: f64 = 0.2619;

/// Height of `I1` and `I2` over the mean width of the three columns, and at most over the row's
/// height; their inward shift over the width of the middle column. Chosen so that with equal
/// columns and a row of 2.6 to 3.5 widths no quad is thinner than 0.8 widths, and that the largest
/// frequency of the one-point element stays below that of a cube of one width.
const INNER_HEIGHT: f64 = 1.25;
const INNER_HEIGHT_LIMIT: f64 = 0.5;
const INNER_SHIFT: f64 = 0.06;

/// A plane quadrilateral mesh of a ring, sorted by angle, then by radius.
pub(crate) struct Ring {
    /// Angle (rad) and radius (m) of each node.
    pub nodes: Vec<[f64; 2]>,
    /// Corners of each quad, counter-clockwise in the plane of (angle, radius); the third and
    /// fourth lie outside.
    pub quads: Vec<[u32; 4]>,
    /// Nodes on the outer circle, by column.
    pub outer: Vec<u32>,
    /// Nodes on the inner circle, by column.
    pub inner: Vec<u32>,
    /// The quad at each column of the outer circle.
    pub rim: Vec<u32>,
}

impl Ring {
    /// Meshes the ring with columns that begin at `angles` (ascending within one turn) and rows
    /// that end at `radii` (descending, the outer one first); the first `regular` rows are not
    /// coarsened.
    ///
    /// # Errors
    /// An estimate of the number of quads, as soon as it is clear that they exceed `limit`.
    pub fn new(angles: &[f64], radii: &[f64], regular: usize, limit: f64) -> Result<Self, f64> {
        let n = angles.len();
        let mut draft = Draft { angles, nodes: Vec::new(), quads: Vec::new() };
        let mut columns: Vec<usize> = (0..n).collect();
        let outer = draft.circle(&columns, radii[0]);
        let mut above = outer.clone();
        for (row, r) in radii.windows(2).enumerate() {
            let merged = if row < regular { vec![] } else { draft.transitions(&columns, r) };
            let (below_columns, below) = draft.row(&columns, &above, &merged, r);
            columns = below_columns;
            above = below;
            if draft.quads.len() as f64 > limit {
                return Err(draft.quads.len() as f64 / (row + 1) as f64 * (radii.len() - 1) as f64);
            }
        }
        Ok(draft.sorted(outer, above))
    }
}

/// Nodes and quads in the order in which they are made, each with a number by which it is sorted around the ring:
/// a node's column, and the sum of a quad's two columns.
struct Draft<'a> {
    angles: &'a [f64],
    nodes: Vec<(usize, [f64; 2])>,
    quads: Vec<(usize, [u32; 4])>,
}

impl Draft<'_> {
    /// Angle at which column `c` begins; `angles.len()` is the first column, a turn later.
    fn angle(&self, c: usize) -> f64 {
        match self.angles.get(c) {
            Some(&angle) => angle,
            None => self.angles[0] + std::f64::consts::TAU,
        }
    }

    fn node(&mut self, column: usize, angle: f64, radius: f64) -> u32 {
        self.nodes.push((column, [angle, radius]));
        (self.nodes.len() - 1) as u32
    }

    fn circle(&mut self, columns: &[usize], radius: f64) -> Vec<u32> {
        columns.iter().map(|&c| self.node(c, self.angles[c], radius)).collect()
    }

    /// Positions in `columns` of the first of each three that this row merges, ascending.
    ///
    /// The narrowest triples are merged first: narrow columns left over between wide ones would find no
    /// neighbours of similar width further in. Equal triples go in order.
    fn transitions(&self, columns: &[usize], r: &[f64]) -> Vec<usize> {
        let height = r[0] - r[1];
        let widths: Vec<f64> = (0..columns.len())
            .map(|i| {
                let end = columns.get(i + 1).copied().unwrap_or(self.angles.len());
                self.angle(end) - self.angle(columns[i])
            })
            .collect();
        let mut candidates: Vec<(u64, usize)> = Vec::new();
        for (i, w) in widths.windows(3).enumerate() {
            let widest = w[0].max(w[1]).max(w[2]);
            let narrowest = w[0].min(w[1]).min(w[2]);
            let angle = w[0] + w[1] + w[2];
            if angle <= WIDEST_COLUMN
                && widest <= WIDTH_RATIO * narrowest
                && height >= HEIGHT_TO_WIDTH * widest * r[0]
            {
                // Rounded far above round-off, so that equal columns compare equal.
                candidates.push(((angle / WIDEST_COLUMN * 1e9).round() as u64, i));
            }
        }
        candidates.sort_unstable();
        let mut taken = vec![false; columns.len()];
        let mut triples = Vec::new();
        for (_, i) in candidates {
            if !taken[i..i + 3].contains(&true) {
                taken[i..i + 3].fill(true);
                triples.push(i);
            }
        }
        triples.sort_unstable();
        triples
    }

    /// Adds the quads between the circles `r[0]` (nodes `above`) and `r[1]`; returns the columns
    /// and nodes of the latter.
    fn row(
        &mut self,
        columns: &[usize],
        above: &[u32],
        triples: &[usize],
        r: &[f64],
    ) -> (Vec<usize>, Vec<u32>) {
        let n = columns.len();
        let mut starts = Vec::with_capacity(n - 2 * triples.len());
        let (mut i, mut next) = (0, triples.iter().peekable());
        while i < n {
            starts.push(i);
            i += if next.next_if_eq(&&i).is_some() { 3 } else { 1 };
        }
        let kept: Vec<usize> = starts.iter().map(|&i| columns[i]).collect();
        let below = self.circle(&kept, r[1]);
        let column = |i: usize| columns.get(i).copied().unwrap_or(self.angles.len());
        let ends: Vec<usize> = (0..=n).map(column).collect();
        for (b, &i) in starts.iter().enumerate() {
            let end = starts.get(b + 1).copied().unwrap_or(n);
            let bottom = [below[b], below[(b + 1) % below.len()]];
            if end == i + 1 {
                let quad = [bottom[0], bottom[1], above[end % n], above[i]];
                self.quads.push((ends[i] + ends[end], quad));
            } else {
                let top = [above[i], above[i + 1], above[i + 2], above[end % n]];
                self.transition([ends[i], ends[i + 1], ends[i + 2], ends[end]], top, bottom, r);
            }
        }
        (kept, below)
    }

    fn transition(&mut self, c: [usize; 4], t: [u32; 4], b: [u32; 2], r: &[f64]) {
        let a = c.map(|c| self.angle(c));
        let width = (a[3] - a[0]) / 3.0 * 0.5 * (r[0] + r[1]);
        let height = r[0] - r[1];
        let radius = r[1] + (INNER_HEIGHT * width).min(INNER_HEIGHT_LIMIT * height);
        let shift = INNER_SHIFT * (a[2] - a[1]);
        let i1 = self.node(c[1], a[1] + shift, radius);
        let i2 = self.node(c[2], a[2] - shift, radius);
        self.quads.push((c[0] + c[3], [b[0], b[1], i2, i1]));
        self.quads.push((c[1] + c[2], [i1, i2, t[2], t[1]]));
        self.quads.push((c[0] + c[1], [b[0], i1, t[1], t[0]]));
        // Begins with I2, so that the third and fourth corners are the outer ones here too.
        self.quads.push((c[2] + c[3], [i2, b[1], t[3], t[2]]));
    }

    /// Sorts nodes and quads by their place around the ring, then outwards.
    fn sorted(self, outer: Vec<u32>, inner: Vec<u32>) -> Ring {
        let radius = |q: &[u32; 4]| q.iter().map(|&n| self.nodes[n as usize].1[1]).sum::<f64>();
        let mut order: Vec<u32> = (0..self.nodes.len() as u32).collect();
        order.sort_by(|&a, &b| {
            let (a, b) = (&self.nodes[a as usize], &self.nodes[b as usize]);
            a.0.cmp(&b.0).then(a.1[1].total_cmp(&b.1[1]))
        });
        let mut place = vec![0u32; order.len()];
        for (new, &old) in order.iter().enumerate() {
            place[old as usize] = new as u32;
        }
        let nodes = order.iter().map(|&n| self.nodes[n as usize].1).collect();

        let mut quads: Vec<(usize, f64, [u32; 4])> =
            self.quads.iter().map(|(c, q)| (*c, radius(q), q.map(|n| place[n as usize]))).collect();
        quads.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let quads: Vec<[u32; 4]> = quads.into_iter().map(|(_, _, q)| q).collect();

        let moved = |nodes: Vec<u32>| -> Vec<u32> {
            nodes.into_iter().map(|n| place[n as usize]).collect()
        };
        let (outer, inner) = (moved(outer), moved(inner));
        let mut column = vec![u32::MAX; order.len()];
        for (c, &n) in outer.iter().enumerate() {
            column[n as usize] = c as u32;
        }
        let mut rim = vec![0; outer.len()];
        for (quad, corners) in quads.iter().enumerate() {
            let c = column[corners[3] as usize];
            if c != u32::MAX && column[corners[2] as usize] != u32::MAX {
                rim[c as usize] = quad as u32;
            }
        }
        Ring { nodes, quads, outer, inner, rim }
    }
}
