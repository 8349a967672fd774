//! Fewer points that draw the same line.

/// Fewer points that draw the same line, `columns` pixels wide: at most four per column.
///
/// `points` (x, y) ascend in x. They are cut in order into at most `columns` parts of equal count; of each part
/// the first, the lowest, the highest and the last point remain. The points must be finite: a gap may be lost,
/// and a NaN that begins a part hides the extremes of the part.
pub fn thin(points: &[[f64; 2]], columns: usize) -> Vec<[f64; 2]> {
    let each = points.len().div_ceil(columns.max(1));
    if each <= 4 {
        return points.to_vec();
    }
    let mut kept = Vec::with_capacity(4 * columns);
    for part in points.chunks(each) {
        let (mut low, mut high) = (0, 0);
        for (i, p) in part.iter().enumerate() {
            if p[1] < part[low][1] {
                low = i;
            }
            if p[1] > part[high][1] {
                high = i;
            }
        }
        let mut chosen = [0, low, high, part.len() - 1];
        chosen.sort_unstable();
        let mut last = None;
        for i in chosen {
            if last != Some(i) {
                kept.push(part[i]);
            }
            last = Some(i);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_ends_and_extremes() {
        let mut points: Vec<[f64; 2]> =
            (0..10_000).map(|i| [f64::from(i), f64::from(i % 7)]).collect();
        points[4321][1] = 99.0;
        points[77][1] = -99.0;
        let few = thin(&points, 100);
        assert!(few.len() <= 400);
        assert!(few.contains(&points[4321]) && few.contains(&points[77]));
        assert_eq!((few.first(), few.last()), (points.first(), points.last()));
        assert!(few.windows(2).all(|w| w[0][0] < w[1][0]));
        assert_eq!(thin(&points[..50], 100), &points[..50]);
    }
}
