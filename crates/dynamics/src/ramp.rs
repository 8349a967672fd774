//! Prescribed values in time: a smooth rise, and straight lines between points.

/// 3 s^2 - 2 s^3 with s = t/ramp held in [0, 1]; a ramp of zero length is a step.
pub fn smoothstep(t: f64, ramp: f64) -> f64 {
    if t >= ramp {
        return 1.0;
    }
    let s = (t / ramp).max(0.0);
    s * s * (3.0 - 2.0 * s)
}

/// The value at `time` (s) on straight lines between `points` (s, value) of rising times, and that of the last point after
/// it.
pub fn interpolated(points: &[[f64; 2]], time: f64) -> f64 {
    let after = points.partition_point(|[t, _]| *t <= time);
    match (points.get(after.wrapping_sub(1)), points.get(after)) {
        (Some([t0, x0]), Some([t1, x1])) => x0 + (x1 - x0) * ((time - t0) / (t1 - t0)),
        (Some([_, x]), None) | (None, Some([_, x])) => *x,
        (None, None) => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_linear_between_its_points_and_stays_at_the_last_value() {
        let table = [[0.0, 1.0], [2.0, 3.0], [2.5, -1.0]];
        for (t, x) in
            [(0.0, 1.0), (1.0, 2.0), (2.0, 3.0), (2.25, 1.0), (2.5, -1.0), (9.0, -1.0), (-1.0, 1.0)]
        {
            assert_eq!(interpolated(&table, t), x, "{t}");
        }
    }
}
