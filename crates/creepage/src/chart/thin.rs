//! Fewer points that draw the same line.

/// Fewer points that draw the same line, `columns` pixels wide: at most five per column.
///
/// `points` (x, y) ascend in x. They are cut in order into at most `columns` parts of equal count; of each part
/// the first, the lowest, the highest and the last point remain, and the first gap (a y that is not a number).
pub fn thin(points: &[[f64; 2]], columns: usize) -> Vec<[f64; 2]> {
    let each = points.len().div_ceil(columns.max(1));
    if each <= 4 {
        return points.to_vec();
    }
    let mut kept = Vec::with_capacity(4 * columns);
    for part in points.chunks(each) {
        let (mut low, mut high, mut gap) = (None, None, None);
        for (i, [_, y]) in part.iter().enumerate() {
            if y.is_nan() {
                gap = gap.or(Some(i));
                continue;
            }
            if low.is_none_or(|low: usize| *y < part[low][1]) {
                low = Some(i);
            }
            if high.is_none_or(|high: usize| *y > part[high][1]) {
                high = Some(i);
            }
        }
        let extremes = [low, high, gap].map(|i| i.unwrap_or(0));
        let mut chosen = [0, extremes[0], extremes[1], extremes[2], part.len() - 1];
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
    fn a_gap_hides_no_extreme_and_remains() {
        let mut points: Vec<[f64; 2]> = (0..1000).map(|i| [f64::from(i), 0.0]).collect();
        (points[100][1], points[101][1], points[105][1]) = (f64::NAN, 7.0, f64::NAN);
        // the gap begins a part, and its extreme follows
        let few = thin(&points, 10);
        assert!(few.contains(&[101.0, 7.0]));
        assert!(few.iter().any(|point| point[1].is_nan()));
        assert!(few.len() < 50);
    }

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
