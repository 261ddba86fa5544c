//! `Lanes`: four `f64` side by side in SIMD registers, so that one pass of the physics serves four trajectories.
//! It is not a vector type: there is no dot product or norm here, and the lanes never mix.

use crate::Scalar;
use std::ops::{Add, AddAssign, Div, DivAssign, Mul, MulAssign, Neg, Sub, SubAssign};
use wide::f64x4;

/// Four independent `f64` computed together.
///
/// `+ - * / sqrt`, comparisons and `select` give in each lane the same bits as `f64`. The transcendental functions are
/// polynomials evaluated across the lanes and agree with the standard library to a few units in the last place
/// (`tests/lanes.rs` states the bounds), so a simulation over lanes equals its `f64` counterpart to rounding, not bit for bit.
/// No lane ever depends on the value of another lane.
///
/// ```
/// use trimtab_ad::{Lanes, Scalar};
///
/// let speeds = Lanes::from_fn(|lane| 0.5 * lane as f64);
/// let drag = speeds * speeds.abs() * 12.0;
/// assert_eq!(drag.lane(2), 12.0 * 1.0 * 1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lanes(f64x4);

/// One flag a lane: the outcome of [`Scalar::less`] on [`Lanes`].
#[derive(Clone, Copy, Debug)]
pub struct LaneMask(f64x4);

impl Lanes {
    /// How many lanes there are.
    pub const LANES: usize = 4;

    /// The value `f(lane)` in each lane, called in the order of the lanes.
    #[inline]
    pub fn from_fn(f: impl FnMut(usize) -> f64) -> Self {
        Self(f64x4::from(std::array::from_fn::<f64, { Self::LANES }, _>(f)))
    }
    /// The value in one lane. Panics, as a slice does, when `lane` is not below [`Lanes::LANES`].
    #[inline]
    pub fn lane(self, lane: usize) -> f64 {
        self.to_array()[lane]
    }
    /// All lanes, in order.
    #[inline]
    pub fn to_array(self) -> [f64; Self::LANES] {
        self.0.to_array()
    }
    /// The sum over the lanes in their order, so that a total does not depend on the machine's registers.
    #[inline]
    pub fn sum(self) -> f64 {
        self.to_array().iter().sum()
    }
}

impl LaneMask {
    /// The flag of one lane. Panics, as a slice does, when `lane` is not below [`Lanes::LANES`].
    #[inline]
    pub fn lane(self, lane: usize) -> bool {
        self.0.to_array()[lane].to_bits() != 0
    }
}

/// Lanes with lanes, and lanes with one number for all of them.
macro_rules! operator {
    ($Op:ident, $op:ident, $symbol:tt) => {
        impl $Op for Lanes {
            type Output = Self;
            #[inline(always)]
            fn $op(self, other: Self) -> Self {
                Self(self.0 $symbol other.0)
            }
        }
        impl $Op<f64> for Lanes {
            type Output = Self;
            #[inline(always)]
            fn $op(self, x: f64) -> Self {
                Self(self.0 $symbol f64x4::splat(x))
            }
        }
    };
}
operator!(Add, add, +);
operator!(Sub, sub, -);
operator!(Mul, mul, *);
operator!(Div, div, /);

/// Operators in place.
macro_rules! assign_operator {
    ($Op:ident, $op:ident, $symbol:tt) => {
        impl $Op for Lanes {
            #[inline(always)]
            fn $op(&mut self, other: Self) {
                *self = *self $symbol other;
            }
        }
    };
}
assign_operator!(AddAssign, add_assign, +);
assign_operator!(SubAssign, sub_assign, -);
assign_operator!(MulAssign, mul_assign, *);
assign_operator!(DivAssign, div_assign, /);

impl Neg for Lanes {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Scalar for Lanes {
    type Coefficient = Self;
    type Mask = LaneMask;

    #[inline(always)]
    fn lift(coefficient: Self) -> Self {
        coefficient
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, summand: Self) -> Self {
        Self(self.0.mul_add(factor.0, summand.0))
    }

    #[inline(always)]
    fn from_f64(x: f64) -> Self {
        Self(f64x4::splat(x))
    }
    #[inline(always)]
    fn value(self) -> f64 {
        self.lane(0)
    }
    #[inline(always)]
    fn is_finite(self) -> bool {
        self.0.is_finite().all()
    }
    #[inline(always)]
    fn less(self, other: Self) -> LaneMask {
        LaneMask(self.0.simd_lt(other.0))
    }
    #[inline(always)]
    fn select(mask: LaneMask, a: Self, b: Self) -> Self {
        Self(mask.0.select(a.0, b.0))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }
    #[inline]
    fn exp(self) -> Self {
        Self(self.0.exp())
    }
    #[inline]
    fn ln(self) -> Self {
        Self(self.0.ln())
    }
    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        let (s, c) = self.0.sin_cos();
        (Self(s), Self(c))
    }
    #[inline]
    fn tanh(self) -> Self {
        // wide's own tanh takes x for tanh(x) below 5e-8, which is 7 ulps off at the upper end; this form needs no case.
        let t = (self.0.abs() * f64x4::splat(-2.0)).exp_m1();
        Self((-t / (t + f64x4::splat(2.0))).copysign(self.0))
    }
    #[inline]
    fn atan2(self, x: Self) -> Self {
        let origin = self.0.simd_eq(f64x4::ZERO) & x.0.simd_eq(f64x4::ZERO);
        Self(origin.select(f64x4::ZERO, self.0.atan2(x.0)))
    }
    #[inline]
    fn nearest(self) -> Self {
        let even = self.0.round_ties_even();
        Self((even - self.0).simd_eq(f64x4::HALF).select(even - f64x4::ONE, even))
    }
}
