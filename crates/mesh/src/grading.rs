//! Graded divisions of a line.

use crate::error::{MAX_ELEMENTS, graded, positive, within};
use crate::{Allowed, MeshError, Parameter};
use std::ops::Range;

/// A gap next to the zone that is shorter than this many elements joins the zone.
pub(crate) const LEAST_GAP: f64 = 0.75;

/// Smallest ratio of successive sizes that is accepted so that the sizes fit a length exactly.
const LEAST_RATIO: f64 = 0.88;

/// A line divided into cells, uniform in one stretch and graded away from it.
#[derive(Clone, Debug)]
pub(crate) struct Axis {
    /// End points of the cells, ascending (m).
    pub points: Vec<f64>,
    /// The cells of the uniform stretch.
    pub fine: Range<usize>,
}

impl Axis {
    /// Divides `span` with cells of about `size` over `fine`, growing by about `growth` outside,
    /// up to `coarsest`.
    ///
    /// The sizes are adjusted so that they fit exactly. Outside the stretch, the ratio becomes slightly smaller
    /// than `growth`. Within it, the size changes only where the stretch reaches an end of the span and is no
    /// whole number of cells long; a gap of less than [`LEAST_GAP`] elements at an end joins the stretch.
    pub fn new(span: [f64; 2], fine: [f64; 2], size: f64, growth: f64, coarsest: f64) -> Self {
        let [from, to] = joined(span, fine, size);
        let n = cells(to - from, size);
        let rear = outward(size, growth, coarsest, from - span[0]);
        let front = outward(size, growth, coarsest, span[1] - to);
        let mut points = Vec::with_capacity(rear.len() + n + 1 + front.len());
        points.extend(rear.iter().rev().map(|d| from - d));
        let first = points.len();
        points.extend(divided([from, to], n));
        points.extend(front.iter().map(|d| to + d));
        let last = points.len() - 1;
        points[0] = span[0];
        points[last] = span[1];
        Self { points, fine: first..first + n }
    }

    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.points.len() - 1
    }

    /// Estimate of the number of cells that [`new`](Self::new) would make for a line of length `span` with a uniform
    /// stretch of length `fine` (m).
    pub fn estimate(span: f64, fine: f64, size: f64, growth: f64, coarsest: f64) -> f64 {
        let gap = (span - fine).max(0.0);
        let graded = 2.0 * libm::log(coarsest / size) / libm::log(growth);
        fine / size + (gap / coarsest + graded).min(gap / size)
    }
}

/// Divides a line into cells. Returns the coordinates of their ends (m, ascending), those of `span` included.
///
/// Cells are about `size` (m) long over the stretch `fine`, and grow outside it by about the factor `growth` from
/// cell to cell, up to `coarsest` (m). Sizes are adjusted so that they fit exactly. `span` and `fine` are
/// coordinates of ends (m).
///
/// # Errors
/// [`MeshError::OutOfRange`] for sizes that are not positive, a growth outside (1, 3], a `coarsest` below `size`,
/// or a stretch that does not lie in the span; [`MeshError::TooManyElements`] for too many cells.
pub fn graded_line(
    span: [f64; 2],
    fine: [f64; 2],
    size: f64,
    growth: f64,
    coarsest: f64,
) -> Result<Vec<f64>, MeshError> {
    positive(Parameter::ZoneSize, size)?;
    positive(Parameter::Line, span[1] - span[0])?;
    positive(Parameter::ZoneLength, fine[1] - fine[0])?;
    let inside = fine[0] >= span[0] && fine[1] <= span[1];
    let allowed = Allowed::Between(span[0], span[1], "for the zone to lie on the line");
    within(inside, Parameter::ZoneStart, fine[0], allowed)?;
    graded(size, growth, coarsest)?;
    let estimate = Axis::estimate(span[1] - span[0], fine[1] - fine[0], size, growth, coarsest);
    if estimate > MAX_ELEMENTS {
        return Err(MeshError::TooManyElements { body: "line", size, estimate });
    }
    Ok(Axis::new(span, fine, size, growth, coarsest).points)
}

/// `length` rounded up to a multiple of `size`; an excess of round-off is not rounded up.
pub(crate) fn whole(length: f64, size: f64) -> f64 {
    (length / size - 1e-9).ceil().max(1.0) * size
}

/// The ends of the uniform stretch `fine` of `span` (m): a gap of less than [`LEAST_GAP`] elements joins it.
pub(crate) fn joined(span: [f64; 2], fine: [f64; 2], size: f64) -> [f64; 2] {
    let from = if fine[0] - span[0] < LEAST_GAP * size { span[0] } else { fine[0] };
    let to = if span[1] - fine[1] < LEAST_GAP * size { span[1] } else { fine[1] };
    [from, to]
}

/// Ends of `n` equal cells. The weighted form makes those of a symmetric stretch symmetric to the last bit.
pub(crate) fn divided([from, to]: [f64; 2], n: usize) -> Vec<f64> {
    (0..=n).map(|i| (from * (n - i) as f64 + to * i as f64) / n as f64).collect()
}

/// Number of cells of about `size` in `length`, at least one.
pub(crate) fn cells(length: f64, size: f64) -> usize {
    (length / size).round().max(1.0) as usize
}

/// Ends of the cells that fill `length`, as distances from its start: the first is about `growth`
/// times `previous`, each next one about `growth` times the one before, none above `coarsest`.
pub(crate) fn outward(previous: f64, growth: f64, coarsest: f64, length: f64) -> Vec<f64> {
    if length <= 0.0 {
        return Vec::new();
    }
    let cap = coarsest.max(previous);
    let (mut n, mut sum, mut size) = (0, 0.0, previous);
    while sum < length * (1.0 - 1e-12) {
        size = (size * growth).min(cap);
        sum += size;
        n += 1;
    }
    let mut ratio = fitting_ratio(previous, cap, n, length);
    // One cell fewer and slightly larger is better than cells below the zone's own size.
    if ratio < LEAST_RATIO && n > 1 && cap * (n - 1) as f64 >= length {
        n -= 1;
        ratio = fitting_ratio(previous, cap, n, length);
    }
    let mut ends = Vec::with_capacity(n);
    let (mut sum, mut size) = (0.0, previous);
    for _ in 0..n {
        size = (size * ratio).min(cap);
        sum += size;
        ends.push(sum);
    }
    let scale = length / sum;
    ends.iter_mut().for_each(|e| *e *= scale);
    ends
}

/// Ratio of successive sizes with which `n` cells fill `length`, by bisection.
fn fitting_ratio(previous: f64, cap: f64, n: usize, length: f64) -> f64 {
    let (mut low, mut high) = (0.0, cap.max(length) / previous + 1.0);
    while high - low > 1e-15 * high {
        let ratio = 0.5 * (low + high);
        if ratio <= low || ratio >= high {
            break;
        }
        let (mut sum, mut size) = (0.0, previous);
        for _ in 0..n {
            size = (size * ratio).min(cap);
            sum += size;
        }
        if sum < length {
            low = ratio;
        } else {
            high = ratio;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sizes(ends: &[f64]) -> Vec<f64> {
        let mut last = 0.0;
        ends.iter().map(|&e| e - std::mem::replace(&mut last, e)).collect()
    }

    #[test]
    fn sizes_fill_the_length_and_grow_by_no_more_than_asked() {
        for growth in [1.05, 1.2, 1.35, 1.6] {
            for i in 1..400 {
                let length = 0.75 + 0.1 * i as f64;
                let ends = outward(1.0, growth, 8.0, length);
                assert!((ends[ends.len() - 1] - length).abs() < 1e-12);
                let mut last = 1.0;
                for size in sizes(&ends) {
                    // Short gaps hold one or two cells that may miss the ratio a little.
                    let ratio = size / last;
                    let free = if ends.len() <= 2 { 0.75..1.7 } else { 0.88 - 1e-9..growth + 0.13 };
                    assert!(free.contains(&ratio), "{growth} {length} {:?}", sizes(&ends));
                    assert!(size < 8.0 + 1e-9);
                    last = size;
                }
            }
        }
    }

    #[test]
    fn a_zone_that_all_but_fills_the_span_takes_all_of_it() {
        let axis = Axis::new([0.0, 10.0], [0.4, 9.3], 1.0, 1.3, 3.0);
        assert_eq!(axis.fine, 0..10);
        assert_eq!(axis.points.len(), 11);
        assert_eq!((axis.points[0], axis.points[10]), (0.0, 10.0));
    }

    #[test]
    fn symmetric_spans_have_symmetric_points() {
        let axis = Axis::new([-0.03, 0.03], [-0.0105, 0.0105], 1e-3, 1.35, 0.05);
        let n = axis.points.len();
        for i in 0..n {
            assert_eq!(axis.points[i], -axis.points[n - 1 - i]);
        }
        assert_eq!(axis.fine.len(), 21);
    }

    #[test]
    fn lengths_are_rounded_up_to_whole_cells_but_not_for_round_off() {
        assert_eq!(cells(whole(0.08, 1e-3), 1e-3), 80);
        assert_eq!(cells(whole(0.3, 0.1), 0.1), 3);
        assert_eq!(cells(whole(0.31, 0.1), 0.1), 4);
    }
}
