//! The shape of arrows.

/// Length of the head (points), at most a share of the arrow, and half its width over its length.
const HEAD: f64 = 5.0;
const SHARE: f64 = 0.45;
const SPREAD: f64 = 0.5;

/// The lines of an arrow from `tail` to `tip`: its shaft, and its head as one path; all in pixels, of which a point
/// has `unit`. None where it has no length.
pub(crate) fn pieces(tail: [f64; 2], tip: [f64; 2], unit: f64) -> Vec<Vec<(i32, i32)>> {
    let along = [tip[0] - tail[0], tip[1] - tail[1]];
    let length = libm::hypot(along[0], along[1]);
    if length.is_nan() || length < 1e-9 {
        return Vec::new();
    }
    let head = (HEAD * unit).min(SHARE * length) / length;
    let side = |sign: f64| {
        let across = [-along[1], along[0]].map(|a| sign * SPREAD * head * a);
        [0, 1].map(|i| tip[i] - head * along[i] + across[i])
    };
    let pixel = |[x, y]: [f64; 2]| (x.round() as i32, y.round() as i32);
    [vec![tail, tip], vec![side(1.0), tip, side(-1.0)]]
        .map(|piece| piece.into_iter().map(pixel).collect())
        .into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_head_is_at_the_tip_and_behind_it_on_both_sides() {
        let pieces = pieces([0.0, 0.0], [0.0, 40.0], 2.0);
        assert_eq!(pieces[0], [(0, 0), (0, 40)]);
        assert_eq!(pieces[1], [(-5, 30), (0, 40), (5, 30)]);
        assert!(super::pieces([1.0, 1.0], [1.0, 1.0], 1.0).is_empty());
        assert!(super::pieces([1.0, 1.0], [f64::NAN, 1.0], 1.0).is_empty());
    }
}
