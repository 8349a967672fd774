//! Sums that do not depend on the order of their addends.
//!
//! Every finite f64 is an integer multiple of 2^-1074. [`ExactSum`] holds the sum of such multiples as one
//! long integer, to which addends are added without rounding (Neal 2015, "Fast exact summation using small
//! and large superaccumulators", arXiv:1505.05571); only [`ExactSum::value`] rounds. The parts of a sum may
//! therefore arrive in any order, from any number of threads or processes: the bits are the same.
//!
//! ```
//! use exact_sum::ExactSum;
//!
//! let forward: ExactSum = [1e16, 1.0, -1e16].into_iter().collect();
//! let backward: ExactSum = [-1e16, 1.0, 1e16].into_iter().collect();
//! assert_eq!(forward.value(), 1.0);
//! assert_eq!(forward.value().to_bits(), backward.value().to_bits());
//! ```

#![cfg_attr(not(test), deny(clippy::unwrap_used))]

/// Bits of a digit.
const BITS: u32 = 32;

/// Number of digits: the largest f64 reaches into the 66th, the rest is for carries.
const DIGITS: usize = 68;

/// Numbers that [`ExactSum::words`] gives: the digits, and whether positive and negative infinities are in the sum.
pub const WORDS: usize = DIGITS + 2;

/// Addends between two carries: each changes a digit by less than 2^53, so that an i64 holds so many.
const ADDENDS: u32 = 1 << 9;

/// The unit of the lowest digit is 2 to this power.
const LEAST: i32 = -1074;

/// The bits of one digit.
const MASK: i64 = (1 << BITS) - 1;

/// The exact sum of f64 numbers. It allocates nothing.
///
/// Addends that are infinite or NaN give what IEEE 754 arithmetic gives: an infinity, or NaN.
#[derive(Clone, Copy, Debug)]
pub struct ExactSum {
    /// The sum is that of `digits[i] 2^(32 i - 1074)`.
    digits: [i64; DIGITS],
    /// The lowest and the highest digit that may differ from zero.
    used: [usize; 2],
    /// Addends that the digits can still take before they must be carried.
    addends_left: u32,
    /// Sum of the addends that are not finite; zero if there are none.
    special: f64,
}

impl ExactSum {
    /// The sum of nothing.
    pub const ZERO: Self =
        Self { digits: [0; DIGITS], used: [DIGITS - 1, 0], addends_left: ADDENDS, special: 0.0 };

    /// Adds one number.
    #[inline]
    pub fn add(&mut self, x: f64) {
        let bits = x.to_bits();
        let (exponent, fraction) = ((bits >> 52) & 0x7ff, bits & ((1 << 52) - 1));
        if exponent == 0x7ff {
            self.special += x;
            return;
        }
        if bits << 1 == 0 {
            return;
        }
        if self.addends_left == 0 {
            self.carry();
        }
        self.addends_left -= 1;
        let normal = u64::from(exponent > 0);
        let mantissa = fraction | normal << 52;
        let shift = exponent - normal;
        let (digit, within) = ((shift >> 5) as usize, shift & 31);
        let low = ((mantissa << within) & MASK as u64) as i64;
        let high = (mantissa >> (u64::from(BITS) - within)) as i64;
        let sign = 1 - 2 * (bits >> 63) as i64;
        self.digits[digit] += sign * low;
        self.digits[digit + 1] += sign * high;
        self.used = [self.used[0].min(digit), self.used[1].max(digit + 1)];
    }

    /// Adds another sum, exactly.
    pub fn merge(&mut self, mut other: Self) {
        self.carry();
        other.carry();
        for (digit, by) in self.digits.iter_mut().zip(other.digits) {
            *digit += by;
        }
        self.used = [self.used[0].min(other.used[0]), self.used[1].max(other.used[1])];
        self.addends_left -= 1;
        self.special += other.special;
    }

    /// The sum rounded to the nearest f64, ties to even. An empty sum and one that cancels are +0; one beyond
    /// the largest f64 is infinite.
    pub fn value(&self) -> f64 {
        if self.special != 0.0 {
            // the payload of a NaN may depend on the order
            return if self.special.is_nan() { f64::NAN } else { self.special };
        }
        let mut sum = *self;
        sum.carry();
        let negative = sum.digits[sum.used[1]] < 0;
        if negative {
            sum.digits.iter_mut().for_each(|d| *d = -*d);
            sum.carry();
        }
        let [lowest, highest] = sum.used;
        let Some(top) = (lowest..=highest).rev().find(|&i| sum.digits[i] != 0) else { return 0.0 };
        // Three digits hold at least 65 bits; what lies below matters to the rounding only by not being
        // zero, which the lowest bit says.
        let from = top.saturating_sub(2);
        let leading = sum.digits[from..=top].iter().rev();
        let leading = leading.fold(0u128, |all, &d| all << BITS | d as u128);
        let below = u128::from((lowest..from).any(|i| sum.digits[i] != 0));
        let magnitude =
            scaled((leading << 1 | below) as f64, BITS as i32 * from as i32 + LEAST - 1);
        if negative { -magnitude } else { magnitude }
    }

    /// The sum as whole numbers, which can be added up, word by word, with those of up to 2^30 other sums:
    /// [`of_words`](Self::of_words) makes the sum of all of them.
    pub fn words(&self) -> [i64; WORDS] {
        let mut sum = *self;
        sum.carry();
        let mut words = [0; WORDS];
        words[..DIGITS].copy_from_slice(&sum.digits);
        // NaN is the sum of both infinities
        words[DIGITS] = i64::from(sum.special > 0.0 || sum.special.is_nan());
        words[DIGITS + 1] = i64::from(sum.special < 0.0 || sum.special.is_nan());
        words
    }

    /// The sum that these words are of.
    pub fn of_words(words: &[i64; WORDS]) -> Self {
        let mut sum = Self { used: [0, DIGITS - 1], addends_left: 0, ..Self::ZERO };
        sum.digits.copy_from_slice(&words[..DIGITS]);
        if words[DIGITS] > 0 {
            sum.special += f64::INFINITY;
        }
        if words[DIGITS + 1] > 0 {
            sum.special += f64::NEG_INFINITY;
        }
        sum
    }

    /// Brings every digit into 0..2^32, except the highest in use, which carries the sign.
    fn carry(&mut self) {
        self.addends_left = ADDENDS;
        let [lowest, highest] = self.used;
        let mut carried = 0;
        for i in lowest..=highest.min(DIGITS - 2) {
            let all = self.digits[i] + carried;
            carried = all >> BITS;
            self.digits[i] = all & MASK;
        }
        if lowest <= highest {
            let next = (highest + 1).min(DIGITS - 1);
            self.digits[next] += carried;
            self.used[1] = next;
        }
    }
}

/// `x 2^e`, rounded once: `x` is at least 1, or the result is exact.
fn scaled(x: f64, e: i32) -> f64 {
    let power = |e: i32| f64::from_bits(((1023 + e) as u64) << 52);
    let first = e.clamp(-1000, 1000);
    x * power(first) * power(e - first)
}

impl Default for ExactSum {
    fn default() -> Self {
        Self::ZERO
    }
}

impl Extend<f64> for ExactSum {
    fn extend<I: IntoIterator<Item = f64>>(&mut self, addends: I) {
        addends.into_iter().for_each(|x| self.add(x));
    }
}

impl FromIterator<f64> for ExactSum {
    fn from_iter<I: IntoIterator<Item = f64>>(addends: I) -> Self {
        let mut sum = Self::ZERO;
        sum.extend(addends);
        sum
    }
}

/// The sum of `addends` as [`ExactSum::value`] rounds it; their order does not matter.
pub fn sum(addends: impl IntoIterator<Item = f64>) -> f64 {
    addends.into_iter().collect::<ExactSum>().value()
}

#[cfg(test)]
mod tests {
    use super::{ExactSum, scaled};
    use proptest::prelude::*;

    fn sum(addends: &[f64]) -> f64 {
        super::sum(addends.iter().copied())
    }

    /// Numbers k 2^e, whose sum an i128 holds exactly.
    fn whole() -> impl Strategy<Value = Vec<i64>> {
        prop::collection::vec(-(1i64 << 53)..(1 << 53), 0..2000)
    }

    proptest! {
        #[test]
        fn a_sum_of_whole_numbers_is_the_nearest_f64_of_the_exact_sum(
            numbers in whole(), exponent in -1000i32..900,
        ) {
            let exact: i128 = numbers.iter().map(|&k| i128::from(k)).sum();
            let unit = power_of_two(exponent);
            let addends: Vec<f64> = numbers.iter().map(|&k| k as f64 * unit).collect();
            prop_assert_eq!(sum(&addends), exact as f64 * unit);
        }

        #[test]
        fn a_sum_has_the_same_bits_in_any_order_and_over_any_parts(
            mut addends in prop::collection::vec(any::<f64>().prop_filter("finite", |x| x.is_finite()), 0..300),
            cut in 0usize..300, seed in any::<u64>(),
        ) {
            let expected = sum(&addends).to_bits();
            let n = addends.len().max(1) as u64;
            for i in 0..addends.len() {
                let j = (seed.wrapping_mul(i as u64 + 1) >> 7) % n;
                addends.swap(i, j as usize);
            }
            prop_assert_eq!(sum(&addends).to_bits(), expected);
            let (a, b) = addends.split_at(cut.min(addends.len()));
            let mut parts: ExactSum = b.iter().copied().collect();
            parts.merge(a.iter().copied().collect());
            prop_assert_eq!(parts.value().to_bits(), expected);
        }

        #[test]
        fn words_of_parts_add_up_to_the_sum_of_all(
            addends in prop::collection::vec(any::<f64>(), 0..300), cut in 0usize..300,
        ) {
            let (a, b) = addends.split_at(cut.min(addends.len()));
            let of = |part: &[f64]| part.iter().copied().collect::<ExactSum>().words();
            let (mut words, others) = (of(a), of(b));
            words.iter_mut().zip(others).for_each(|(word, other)| *word += other);
            let (together, expected) = (ExactSum::of_words(&words).value(), sum(&addends));
            prop_assert!(together.to_bits() == expected.to_bits() || together.is_nan() && expected.is_nan());
        }
    }

    fn power_of_two(e: i32) -> f64 {
        scaled(1.0, e)
    }

    #[test]
    fn what_cancels_leaves_what_is_small() {
        assert_eq!(sum(&[1e300, 1e-300, -1e300]), 1e-300);
        assert_eq!(sum(&[f64::MAX, f64::MAX, -f64::MAX, -f64::MAX, 5e-324]), 5e-324);
        assert_eq!(sum(&[]), 0.0);
        assert_eq!(sum(&[0.1; 10]), 1.0);
    }

    #[test]
    fn ties_are_rounded_to_even_and_what_lies_far_below_breaks_them() {
        let half = f64::EPSILON / 2.0;
        assert_eq!(sum(&[1.0, half]), 1.0);
        assert_eq!(sum(&[1.0, half, 1e-300]), 1.0 + f64::EPSILON);
        assert_eq!(sum(&[-1.0, -half, -1e-300]), -1.0 - f64::EPSILON);
        assert_eq!(sum(&[1.0, half, -1e-300]), 1.0);
    }

    #[test]
    fn what_is_not_finite_stays_so_and_too_large_a_sum_is_infinite() {
        assert!(sum(&[1.0, f64::NAN]).is_nan());
        assert_eq!(sum(&[f64::INFINITY, 1.0]), f64::INFINITY);
        assert!(sum(&[f64::INFINITY, f64::NEG_INFINITY]).is_nan());
        assert_eq!(sum(&[f64::MAX, f64::MAX]), f64::INFINITY);
    }
}
