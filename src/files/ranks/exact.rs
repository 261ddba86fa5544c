//! Sums of numbers without rounding: the result is the same bits in whatever order, groups or processes the numbers were added.
//! It rounds once, where a sum is read; it sends nothing.
//!
//! A sum is a fixed-point number of [`DIGITS`] digits to the base 2^32, wide enough for every finite `f64`, its digits kept in
//! `i64` so that carries can wait. Source of the idea: Kulisch, Computer Arithmetic and Validity (2008), chapter 8.

/// Digits of a sum: 2^-1074 to 2^1024 take 66 digits of 32 bits, and one more takes what carries add.
const DIGITS: usize = 67;

/// The base of a digit.
const BASE: i64 = 1 << 32;

/// Additions after which carries are done: each adds less than 2^32 to a digit.
const PATIENCE: u32 = 1 << 29;

/// Several sums, added to one by one.
#[derive(Clone, Debug)]
pub struct ExactSums {
    digits: Vec<[i64; DIGITS]>,
    waiting: u32,
    finite: bool,
    point: i64,
}

impl ExactSums {
    /// So many sums, all 0.
    pub fn new(width: usize) -> Self {
        Self { digits: vec![[0; DIGITS]; width], waiting: 0, finite: true, point: 0 }
    }

    /// The same sums, as those of a function at `p`: ranks that add sums of different points notice it.
    pub fn at(mut self, p: &[f64]) -> Self {
        let mix = |hash: u64, x: &f64| (hash ^ x.to_bits()).wrapping_mul(0x0000_0100_0000_01b3);
        // 62 bits, so that its negative is a number too.
        self.point = (p.iter().fold(0xcbf2_9ce4_8422_2325, mix) >> 2) as i64;
        self
    }

    /// Adds `x` to the sum at `i`. A number that is not finite spoils the sums: they have no value then.
    #[inline]
    pub fn add(&mut self, i: usize, x: f64) {
        if x == 0.0 {
            return;
        }
        if !x.is_finite() {
            self.finite = false;
            return;
        }
        let bits = x.to_bits();
        let exponent = ((bits >> 52) & 0x7ff) as usize;
        let fraction = bits & ((1 << 52) - 1);
        // x = mantissa 2^(place - 1074)
        let (mantissa, place) = if exponent == 0 { (fraction, 0) } else { (fraction | 1 << 52, exponent - 1) };
        let shifted = u128::from(mantissa) << (place % 32);
        let sign = if x < 0.0 { -1 } else { 1 };
        for (k, digit) in self.digits[i][place / 32..place / 32 + 3].iter_mut().enumerate() {
            *digit += sign * ((shifted >> (32 * k)) & 0xffff_ffff) as i64;
        }
        self.waiting += 1;
        if self.waiting >= PATIENCE {
            self.carry();
        }
    }

    /// Says that what was to be added has no value.
    pub fn spoil(&mut self) {
        self.finite = false;
    }

    /// Whether everything that was added was finite.
    pub fn is_finite(&self) -> bool {
        self.finite
    }

    /// The point that the sums are of; 0 if none was given.
    pub(super) fn point(&self) -> i64 {
        self.point
    }

    /// Brings every digit into -2^31 .. 2^31, so that small sums have few digits other than 0, negative ones too.
    pub(super) fn carry(&mut self) {
        for digits in &mut self.digits {
            let mut carried = 0;
            for digit in digits {
                *digit += carried;
                carried = (*digit + BASE / 2).div_euclid(BASE);
                *digit -= carried * BASE;
            }
        }
        self.waiting = 0;
    }

    /// For each sum the first digit that is not 0 and the one after the last; `(DIGITS, 0)` for 0.
    pub(super) fn extents(&self) -> Vec<(usize, usize)> {
        let extent = |digits: &[i64; DIGITS]| {
            let first = digits.iter().position(|d| *d != 0).unwrap_or(DIGITS);
            (first, digits.iter().rposition(|d| *d != 0).map_or(0, |last| last + 1))
        };
        self.digits.iter().map(extent).collect()
    }

    /// The digits within given extents, one sum after the other.
    pub(super) fn within(&self, extents: &[(usize, usize)]) -> Vec<i64> {
        let digits = self.digits.iter().zip(extents);
        digits.flat_map(|(digits, (from, to))| digits.get(*from..*to).unwrap_or(&[])).copied().collect()
    }

    /// Sets the digits within given extents, in the order of [`Self::within`].
    pub(super) fn set_within(&mut self, extents: &[(usize, usize)], values: &[i64]) {
        let mut values = values.iter();
        for (digits, (from, to)) in self.digits.iter_mut().zip(extents) {
            for (digit, value) in digits.get_mut(*from..*to).unwrap_or(&mut []).iter_mut().zip(&mut values) {
                *digit = *value;
            }
        }
    }

    /// The sums, each rounded to the nearest `f64`; `None` if something was not finite.
    pub(super) fn values(mut self) -> Option<Vec<f64>> {
        self.carry();
        self.finite.then(|| self.digits.into_iter().map(rounded).collect())
    }
}

/// The nearest `f64` of a number whose digits have been carried.
fn rounded(mut digits: [i64; DIGITS]) -> f64 {
    let Some(last) = digits.iter().rposition(|d| *d != 0) else { return 0.0 };
    let sign = if digits[last] < 0 { -1.0 } else { 1.0 };
    let mut carried = 0;
    for digit in &mut digits {
        let value = if sign < 0.0 { -*digit } else { *digit } + carried;
        carried = value.div_euclid(BASE);
        *digit = value.rem_euclid(BASE);
    }
    let last = digits.iter().rposition(|d| *d != 0).unwrap_or(0);
    let digit = |k: usize| last.checked_sub(k).map_or(0, |at| digits[at] as u128);
    // The first three digits have 65 bits or more; what is below only decides how they are rounded.
    let below = (3..=last).any(|k| digit(k) != 0);
    let top = (digit(0) << 64) | (digit(1) << 32) | digit(2) | u128::from(below);
    let exponent = 32 * (last as i32 - 2) - 1074;
    // In two steps, since the exponent alone may be too small for an f64.
    sign * (top as f64 * power_of_two(exponent / 2)) * power_of_two(exponent - exponent / 2)
}

/// 2^e, for e from -1022 to 1023.
fn power_of_two(e: i32) -> f64 {
    f64::from_bits(((e + 1023) as u64) << 52)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    fn sum(values: &[f64]) -> f64 {
        let mut sums = ExactSums::new(1);
        values.iter().for_each(|x| sums.add(0, *x));
        sums.values().unwrap()[0]
    }

    fn numbers(count: usize) -> Vec<f64> {
        let mut random = ChaCha8Rng::seed_from_u64(3);
        (0..count).map(|_| random.random_range(-1.0..1.0) * 10f64.powi(random.random_range(-30..30))).collect()
    }

    #[test]
    fn a_number_alone_is_its_own_sum() {
        let ends = [f64::MAX, -f64::MAX, f64::MIN_POSITIVE, 5e-324, -5e-324, 0.1, -3.0, 1e300, 4_294_967_296.0];
        for x in numbers(1000).into_iter().chain(ends) {
            assert_eq!(sum(&[x]).to_bits(), x.to_bits(), "{x}");
        }
    }

    #[test]
    fn sums_are_rounded_once() {
        assert_eq!(sum(&[1e16, 1.0, -1e16]), 1.0);
        assert_eq!(sum(&[1e300, 1e-300, -1e300, 1.0, -1.0]), 1e-300);
        assert_eq!(sum(&[f64::MAX, f64::MAX, -f64::MAX]), f64::MAX);
        // Half a unit in the last place is rounded to even, and anything more is rounded up.
        let half = f64::EPSILON / 2.0;
        assert_eq!((sum(&[1.0, half]), sum(&[1.0, half, 1e-300])), (1.0, 1.0 + f64::EPSILON));
        assert_eq!(sum(&[0.1; 10]), 1.0);
    }

    #[test]
    fn order_and_grouping_do_not_change_a_bit() {
        let values = numbers(2000);
        let whole = sum(&values);
        let mut turned = values.clone();
        turned.reverse();
        assert_eq!(sum(&turned).to_bits(), whole.to_bits());
        for parts in [2, 3, 7] {
            let mut total = ExactSums::new(1);
            let mut places = vec![0; DIGITS];
            for part in values.chunks(values.len().div_ceil(parts)) {
                let mut sums = ExactSums::new(1);
                part.iter().for_each(|x| sums.add(0, *x));
                sums.carry();
                for (place, digit) in places.iter_mut().zip(sums.within(&[(0, DIGITS)])) {
                    *place += digit;
                }
            }
            total.set_within(&[(0, DIGITS)], &places);
            assert_eq!(total.values().unwrap()[0].to_bits(), whole.to_bits());
        }
    }

    #[test]
    fn a_sum_takes_few_digits_whatever_its_sign() {
        for x in [1.5, -1.5, 1e-20, -1e20] {
            let mut sums = ExactSums::new(1);
            sums.add(0, x);
            sums.carry();
            let (from, to) = sums.extents()[0];
            assert!(to - from <= 4, "{x}: {from} to {to}");
        }
        assert_eq!(ExactSums::new(1).extents(), [(DIGITS, 0)]);
    }

    #[test]
    fn what_is_not_finite_leaves_no_value() {
        for x in [f64::NAN, f64::INFINITY] {
            let mut sums = ExactSums::new(2);
            sums.add(1, x);
            assert!(!sums.is_finite() && sums.values().is_none());
        }
    }
}
