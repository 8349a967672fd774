//! The plan of the shells: the height of each layer, and the columns that it merges.

use super::fan::{Fan, HIGH, LOW};

/// The three directions: along the rolling direction, across, and down from the surface.
pub(super) const S: usize = 0;
pub(super) const Y: usize = 1;
pub(super) const Z: usize = 2;

/// Height of a layer that merges over the widest of the columns. Below 2.2 the one-point elements of the template have
/// a higher largest frequency than a cube of the column's width.
const HEIGHT: f64 = 2.4;

/// Height of the inner nodes of a template over its bottom: this part of the layer's height, and at most this many
/// widths of the narrowest column. Higher ones would make the corners at the bottom sharp, most of all where a mitre slants
/// them.
const INNER: f64 = 0.45;
const INNER_LIMIT: f64 = 1.15;

/// Largest ratio of the widest to the narrowest column that are merged, and the same where one or two columns would
/// otherwise be left over.
const WIDTH_RATIO: f64 = 1.55;
const LAST_RATIO: f64 = 2.1;

/// Largest slope of a line between columns that are merged. At a slope of 1 the corner `B0` of the template would have
/// an angle of 18 degrees.
const STEEPEST: f64 = 0.3;

/// A merged column is at most this many times as wide as the size wanted at its place, the square root of 2: sizes
/// are rounded to the nearest step of 2:1.
const ROUNDING: f64 = std::f64::consts::SQRT_2;

/// A rest of a stage below this many heights of a layer joins the layer.
const REST: f64 = 0.4;

/// Below this taper, columns across are no longer merged: a layer could not be high enough at the bottom without being
/// far too high at the surface.
const THINNEST: f64 = 0.6;

/// What is to be meshed: a box in the coordinates s (along the rolling direction), y and z (downwards). Of a ring, z
/// is R log(R/r): the map to the ring then keeps angles in its plane.
pub(super) struct Bulk {
    /// The lines of the three directions.
    pub fans: [Fan; 3],
    /// Size of the elements in the zone (m).
    pub size: f64,
    /// Ratio of successive sizes.
    pub growth: f64,
    /// Largest size, by direction (m).
    pub coarsest: [f64; 3],
    /// Radius of the surface of a ring (m), whose two ends are joined.
    pub radius: Option<f64>,
}

/// Columns that are merged: the position of the first among the columns of the layer, their number (four become two,
/// three become one, and so do two at the surface), and the distance of the inner nodes from the zone (m).
#[derive(Clone, Copy)]
pub(super) struct Group {
    pub first: usize,
    pub columns: usize,
    pub inner: f64,
}

impl Group {
    /// Positions of the lines that end in the layer, from the first of the group.
    fn ending(&self) -> &'static [usize] {
        match self.columns {
            4 => &[1, 3],
            3 => &[1, 2],
            _ => &[1],
        }
    }

    /// Number of quadrilaterals of its template.
    fn quads(&self) -> usize {
        if self.columns == 4 { 6 } else { self.columns + 1 }
    }
}

/// A layer of the shells.
pub(super) struct Layer {
    /// Distances from the zone between which it lies (m).
    pub from: f64,
    pub to: f64,
    /// Lines at its upper side, by direction.
    pub lines: [Vec<u32>; 3],
    /// Direction in which it merges, and the columns, ascending.
    merged: (usize, Vec<Group>),
}

impl Layer {
    /// The columns that it merges along `direction`.
    pub fn groups(&self, direction: usize) -> &[Group] {
        if self.merged.0 == direction { &self.merged.1 } else { &[] }
    }

    /// Lines at its lower side.
    fn below(&self) -> [Vec<u32>; 3] {
        let mut lines = self.lines.clone();
        let (direction, groups) = &self.merged;
        for g in groups.iter().rev() {
            g.ending().iter().rev().for_each(|line| {
                lines[*direction].remove(g.first + line);
            });
        }
        lines
    }

    /// Number of quadrilaterals in a row along `direction`.
    fn quads(&self, direction: usize) -> usize {
        let excess: usize = self.groups(direction).iter().map(|g| g.quads() - g.columns).sum();
        self.lines[direction].len() - 1 + excess
    }
}

/// A side of the zone from which shells grow.
#[derive(Clone, Copy)]
pub(super) struct Patch {
    /// The two directions along it.
    pub along: [usize; 2],
    /// The direction across it, and its line.
    pub across: usize,
    pub side: usize,
}

const PATCHES: [Patch; 5] = [
    Patch { along: [S, Y], across: Z, side: HIGH },
    Patch { along: [S, Z], across: Y, side: LOW },
    Patch { along: [S, Z], across: Y, side: HIGH },
    Patch { along: [Y, Z], across: S, side: LOW },
    Patch { along: [Y, Z], across: S, side: HIGH },
];

impl Bulk {
    /// The sides whose shells have not arrived at the end of the body at `distance`.
    pub fn patches(&self, distance: f64) -> impl Iterator<Item = Patch> + '_ {
        PATCHES.into_iter().filter(move |p| distance < self.fans[p.across].sides[p.side].until)
    }

    /// Size wanted at `distance` from the zone (m). A series of sizes with the ratio g gains (g - 1)/g of its length.
    fn wanted(&self, distance: f64) -> f64 {
        self.size + slope(self.growth) * distance
    }

    /// Lengths along s and down shrink with the radius of a ring, by this factor at the bottom of the shell at
    /// `distance`; those across do not.
    fn taper(&self, distance: f64) -> f64 {
        let down = &self.fans[Z];
        self.radius.map_or(1.0, |radius| libm::exp(-down.at(down.last(), distance) / radius))
    }

    /// The layers, from the zone outwards.
    ///
    /// # Errors
    /// An estimate of the number of elements, as soon as it is clear that they exceed `limit`.
    pub fn layers(&self, limit: f64) -> Result<Vec<Layer>, f64> {
        let columns = self.fans.each_ref().map(|f| f.last() as f64);
        let mut count: f64 = columns.iter().product();
        let mut lines = self.fans.each_ref().map(|f| (0..=f.last()).collect::<Vec<u32>>());
        let mut layers = Vec::new();
        let mut stages: Vec<f64> =
            self.fans.iter().flat_map(|f| f.sides.map(|side| side.until)).collect();
        stages.sort_by(f64::total_cmp);
        let mut from = 0.0;
        for end in stages {
            while from < end {
                let layer = self.layer(lines, from, end);
                count += self.count(&layer);
                if count > limit {
                    return Err(count * (end / layer.to).max(1.0));
                }
                lines = layer.below();
                from = layer.to;
                layers.push(layer);
            }
        }
        if count > limit { Err(count) } else { Ok(layers) }
    }

    fn count(&self, layer: &Layer) -> f64 {
        self.patches(layer.from)
            .map(|p| p.along.map(|a| layer.quads(a) as f64).iter().product::<f64>())
            .sum()
    }

    /// The next layer of a stage: it merges in the direction with the narrowest columns that may be merged.
    fn layer(&self, lines: [Vec<u32>; 3], from: f64, end: f64) -> Layer {
        let rest = end - from;
        let used = |direction| self.patches(from).any(|p| p.along.contains(&direction));
        let mut best: Option<(usize, f64)> = None;
        for direction in [S, Y, Z].into_iter().filter(|&d| used(d)) {
            let runs = self.runs(&lines[direction], direction, from, rest);
            let narrowest = runs.iter().fold(f64::INFINITY, |least, run| least.min(run.height));
            // The first direction has the most columns: it goes first where widths are equal.
            if narrowest < best.map_or(f64::INFINITY, |(_, h)| 0.99 * h) {
                best = Some((direction, narrowest));
            }
        }
        let Some((direction, height)) = best else {
            let coarsest = self.coarsest.iter().fold(f64::INFINITY, |a, &b| a.min(b));
            let height = plain(rest, (self.growth * self.wanted(from)).min(coarsest));
            let to = if rest - height <= 1e-9 * rest { end } else { from + height };
            return Layer { from, to, lines, merged: (S, Vec::new()) };
        };
        let to = if rest - height < REST * height { end } else { from + height };
        let runs = self.runs(&lines[direction], direction, from, to - from);
        let mut groups: Vec<Group> = runs.iter().flat_map(|run| run.groups()).collect();
        if direction == Y {
            groups = mirrored(&groups, lines[Y].len() / 2);
        }
        for g in &mut groups {
            let lines = &lines[direction][g.first..=g.first + g.columns];
            let narrowest = lines.windows(2).fold(f64::INFINITY, |least, l| {
                least.min(self.fans[direction].width([l[0], l[1]], from))
            });
            g.inner = to - (INNER * (to - from)).min(INNER_LIMIT * narrowest);
        }
        Layer { from, to, lines, merged: (direction, groups) }
    }

    /// Runs of neighbouring columns that may be merged in a layer of height `most` at `distance`; across, on the side
    /// of positive y.
    fn runs(&self, lines: &[u32], direction: usize, distance: f64, most: f64) -> Vec<Run> {
        let fan = &self.fans[direction];
        let taper = if direction == Y { self.taper(distance) } else { 1.0 };
        let begin = if direction == Y { lines.len() / 2 } else { 0 };
        if taper < THINNEST {
            return Vec::new();
        }
        let mut runs: Vec<Run> = Vec::new();
        for column in begin..lines.len() - 1 {
            let (l, m) = (lines[column], lines[column + 1]);
            let width = fan.width([l, m], distance);
            let height = HEIGHT * width / taper.sqrt();
            let wanted = ROUNDING * self.wanted(distance + height);
            if height > most * (1.0 + 1e-9)
                || 2.0 * width > wanted.min(self.coarsest[direction])
                || fan.slope(l..m, distance) > STEEPEST
            {
                continue;
            }
            let single = Run {
                first: column,
                columns: 1,
                widths: [width; 2],
                height,
                halved: direction != S && column == begin,
            };
            match runs.last_mut() {
                Some(run) if run.is_beside(&single, WIDTH_RATIO) => run.join(&single),
                _ => runs.push(single),
            }
        }
        let mut whole: Vec<Run> = Vec::new();
        for run in runs {
            match whole.last_mut() {
                Some(last)
                    if last.columns.min(run.columns) < 3 && last.is_beside(&run, LAST_RATIO) =>
                {
                    last.join(&run);
                }
                _ => whole.push(run),
            }
        }
        whole.retain(|run| !run.parts().is_empty());
        whole
    }
}

/// Neighbouring columns that may be merged.
struct Run {
    /// Position of the first column, and their number.
    first: usize,
    columns: usize,
    /// The least and the largest width (m).
    widths: [f64; 2],
    /// Least height of the layer (m).
    height: f64,
    /// Whether it begins at y = 0 or at the surface, where half a group of four, two columns, may stand.
    halved: bool,
}

impl Run {
    /// Whether another run follows it, and its columns are not wider or narrower by more than a factor of `ratio`.
    fn is_beside(&self, next: &Run, ratio: f64) -> bool {
        let widest = self.widths[1].max(next.widths[1]);
        let narrowest = self.widths[0].min(next.widths[0]);
        self.first + self.columns == next.first && widest <= ratio * narrowest
    }

    /// Appends a run.
    fn join(&mut self, next: &Run) {
        self.columns += next.columns;
        self.widths = [self.widths[0].min(next.widths[0]), self.widths[1].max(next.widths[1])];
        self.height = self.height.max(next.height);
    }

    /// Numbers of columns of its groups: with half a group at its beginning, if less is then left over, or fewer
    /// groups are threes.
    fn parts(&self) -> Vec<usize> {
        let cost = |parts: &[usize]| {
            let threes = parts.iter().filter(|&&p| p == 3).count();
            (self.columns - parts.iter().sum::<usize>(), threes)
        };
        let beside = parts(self.columns);
        if self.halved && self.columns >= 2 {
            let with = [vec![2], parts(self.columns - 2)].concat();
            if cost(&with) < cost(&beside) {
                return with;
            }
        }
        beside
    }

    fn groups(&self) -> Vec<Group> {
        let mut first = self.first;
        let mut groups = Vec::new();
        for columns in self.parts() {
            groups.push(Group { first, columns, inner: 0.0 });
            first += columns;
        }
        groups
    }
}

/// Numbers of columns of the groups, fours and threes, that make up `columns`, none left over where that is possible:
/// narrow columns left over between wide ones would find no neighbours of similar width further out.
fn parts(columns: usize) -> Vec<usize> {
    let threes = match columns {
        0..3 => return Vec::new(),
        5 => return vec![4],
        _ => [0, 3, 2, 1][columns % 4],
    };
    let mut parts = vec![4; (columns - 3 * threes) / 4];
    parts.resize(parts.len() + threes, 3);
    parts
}

/// Groups beyond the line number `middle` and their mirror images, ascending. Half a group beside the line and its image
/// are one group across it.
fn mirrored(half: &[Group], middle: usize) -> Vec<Group> {
    let (across, beyond) = match half {
        [Group { columns: 2, .. }, beyond @ ..] => {
            (Some(Group { first: middle - 2, columns: 4, inner: 0.0 }), beyond)
        }
        _ => (None, half),
    };
    let images =
        beyond.iter().rev().map(|g| Group { first: 2 * middle - g.first - g.columns, ..*g });
    images.chain(across).chain(beyond.iter().copied()).collect()
}

/// Share of a length that a series of sizes of ratio `growth` gains in size over it.
pub(super) fn slope(growth: f64) -> f64 {
    1.0 - 1.0 / growth
}

/// Height of the next of the plain layers, about `height` each, that fill `rest`.
fn plain(rest: f64, height: f64) -> f64 {
    if rest <= 1.35 * height {
        rest
    } else if rest < 2.0 * height {
        0.5 * rest
    } else {
        height
    }
}
