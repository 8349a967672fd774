//! The lines that divide the zone along one direction, and how they fan out beyond it.

use super::plan::slope;
use std::ops::Range;

/// Number of columns over which a side fans out at least: fewer would become wide too soon.
const LEAST_SPREAD: usize = 4;

/// Gaps below this part of the length of the body are round-off.
const ROUND_OFF: f64 = 1e-12;

/// Two sides of a direction: the low one and the high one.
pub(super) const LOW: usize = 0;
pub(super) const HIGH: usize = 1;

/// One side of the zone.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side {
    /// Distance from the zone to the end of the body (m).
    pub gap: f64,
    /// Distance from the zone, as the shells count it, where they reach the end of the body (m).
    pub until: f64,
}

impl Side {
    /// How far the shell at `distance` reaches beyond the zone (m).
    fn reach(&self, distance: f64) -> f64 {
        if distance < self.until { self.gap * (distance / self.until) } else { self.gap }
    }

    /// Rate at which the reach grows with the distance.
    fn rate(&self, distance: f64) -> f64 {
        if distance < self.until { self.gap / self.until } else { 0.0 }
    }
}

/// The lines of one direction. Those near a side with shells move outwards with the shells: the outermost by their
/// whole reach, each further one by an equal fraction less, and from the `spread`-th one on not at all. The columns
/// between them thus widen evenly, and those of the middle run straight.
#[derive(Clone, Debug)]
pub(super) struct Fan {
    /// Coordinates in the zone (m), ascending.
    pub lines: Vec<f64>,
    /// Coordinates of the ends of the body (m).
    pub ends: [f64; 2],
    /// The low and the high side.
    pub sides: [Side; 2],
    /// Lines of the zone itself.
    pub zone: Range<u32>,
    /// Number of columns over which each side fans out.
    spread: f64,
}

/// Sizes of the columns about the zone.
#[derive(Clone, Copy)]
pub(super) struct Sizes {
    /// Size in the zone (m), ratio of successive sizes, and the largest size (m).
    pub fine: f64,
    pub growth: f64,
    pub coarsest: f64,
}

impl Fan {
    /// The lines of a zone in a body between `ends`. Columns of growing size are added to a zone that has too few to fan
    /// out.
    pub fn new(lines: Vec<f64>, ends: [f64; 2], sizes: Sizes) -> Self {
        let (lines, zone) = extended(lines, ends, sizes);
        let last = lines.len() - 1;
        let gap = gaps(&lines, ends);
        let both = gap[LOW] > 0.0 && gap[HIGH] > 0.0;
        let most = if both { (last / 2).max(1) } else { last };
        let spread = (1.0 / slope(sizes.growth)).round().max(LEAST_SPREAD as f64).min(most as f64);
        Self { lines, ends, sides: gap.map(|gap| Side { gap, until: gap }), zone, spread }
    }

    /// Index of the last line.
    pub fn last(&self) -> u32 {
        (self.lines.len() - 1) as u32
    }

    /// Share of the reach of one side by which a line moves.
    fn share(&self, line: u32, side: usize) -> f64 {
        let steps = if side == LOW { line } else { self.last() - line };
        (1.0 - f64::from(steps) / self.spread).max(0.0)
    }

    /// Coordinate of a line in the shell at `distance` (m).
    pub fn at(&self, line: u32, distance: f64) -> f64 {
        if self.is_end(line, LOW, distance) {
            return self.ends[LOW];
        }
        if self.is_end(line, HIGH, distance) {
            return self.ends[HIGH];
        }
        let [back, forth] =
            [LOW, HIGH].map(|s| self.share(line, s) * self.sides[s].reach(distance));
        self.lines[line as usize] - back + forth
    }

    /// Width of the column between two lines in the shell at `distance` (m).
    pub fn width(&self, [from, to]: [u32; 2], distance: f64) -> f64 {
        self.at(to, distance) - self.at(from, distance)
    }

    /// Whether the outermost line of a side has arrived at the end of the body.
    pub fn is_end(&self, line: u32, side: usize, distance: f64) -> bool {
        let outermost = if side == LOW { 0 } else { self.last() };
        line == outermost && distance >= self.sides[side].until
    }

    /// The steepest slope of some lines against the direction in which the shells follow one another.
    pub fn slope(&self, lines: Range<u32>, distance: f64) -> f64 {
        let back = self.share(lines.start, LOW) * self.sides[LOW].rate(distance);
        let forth = self.share(lines.end, HIGH) * self.sides[HIGH].rate(distance);
        back.max(forth)
    }
}

/// Distances from the outermost lines to the ends of the body (m): nought, not round-off, where a line lies at the end.
fn gaps(lines: &[f64], ends: [f64; 2]) -> [f64; 2] {
    let least = ROUND_OFF * (ends[HIGH] - ends[LOW]);
    [lines[0] - ends[LOW], ends[HIGH] - lines[lines.len() - 1]]
        .map(|gap| if gap < least { 0.0 } else { gap })
}

/// The lines of the zone, with columns added at all sides that do not lie at the end of the body, until there are enough
/// or no room is left for one more; and the range of those of the zone.
fn extended(mut lines: Vec<f64>, ends: [f64; 2], sizes: Sizes) -> (Vec<f64>, Range<u32>) {
    let open: Vec<usize> =
        [LOW, HIGH].into_iter().filter(|&side| gaps(&lines, ends)[side] > 0.0).collect();
    let of_zone = lines.len() as u32;
    let (mut before, mut width) = (0, sizes.fine);
    while lines.len() - 1 < LEAST_SPREAD * open.len() {
        width = (width * sizes.growth).min(sizes.coarsest).max(sizes.fine);
        let gaps = gaps(&lines, ends);
        if open.iter().any(|&side| gaps[side] < width + sizes.fine) {
            break;
        }
        if open.contains(&LOW) {
            lines.insert(0, lines[0] - width);
            before += 1;
        }
        if open.contains(&HIGH) {
            lines.push(lines[lines.len() - 1] + width);
        }
    }
    (lines, before..before + of_zone)
}
