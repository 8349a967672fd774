//! Random numbers by which the members of an ensemble differ.

use crate::case::schema::Case;

/// Seed where a case gives none.
const SEED: u64 = 1;

/// What the draws of a case begin with.
pub(crate) fn seed(case: &Case) -> u64 {
    case.preload.seed.unwrap_or(SEED)
}

/// A pseudo-random number in [-1, 1): the output of SplitMix64 (Steele, Lea and Flood 2014) for the state
/// made of `seed` and `place`.
pub(crate) fn draw(seed: u64, place: u64) -> f64 {
    const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;
    let mix = |state: u64| {
        let state = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let state = (state ^ (state >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        state ^ (state >> 31)
    };
    let state =
        mix(seed.wrapping_add(GOLDEN)).wrapping_add(place.wrapping_add(1).wrapping_mul(GOLDEN));
    // the 53 high bits, exact in a double
    2.0 * ((mix(state) >> 11) as f64 / (1_u64 << 53) as f64) - 1.0
}

#[cfg(test)]
mod tests {
    use super::draw;

    #[test]
    fn draws_fill_the_range_evenly_and_seeds_share_none() {
        let of = |seed: u64| (0..10_000).map(move |place| draw(seed, place));
        let mean = of(1).sum::<f64>() / 1e4;
        let square = of(1).map(|r| r * r).sum::<f64>() / 1e4;
        assert!(of(1).all(|r| (-1.0..1.0).contains(&r)));
        // of 10,000 even draws: 0 within 0.0058, 1/3 within 0.003, each one standard deviation
        assert!(mean.abs() < 0.02 && (square - 1.0 / 3.0).abs() < 0.01, "{mean} {square}");
        assert!(of(1).zip(of(2)).all(|(a, b)| a != b));
        let together = of(1).zip(of(2)).map(|(a, b)| a * b).sum::<f64>() / 1e4;
        assert!(together.abs() < 0.02, "{together}");
    }
}
