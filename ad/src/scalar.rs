//! The `Scalar` trait: the operations of a number that physics is written against once.
//! It is not a numeric tower: it has only the operations that ship dynamics use.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

/// A number that physics can be written against: `f64`, a dual number, SIMD lanes, or duals over SIMD lanes.
///
/// Branches on values are written with [`Scalar::select`], so that one text of the physics runs on a single value and on
/// lanes that take different branches. Both arms are evaluated: neither may panic, and an arm that is not taken must still
/// have a finite value (guard a denominator before the division, not after it).
pub trait Scalar:
    Copy
    + Debug
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + Add<<Self as Scalar>::Coefficient, Output = Self>
    + Sub<<Self as Scalar>::Coefficient, Output = Self>
    + Mul<<Self as Scalar>::Coefficient, Output = Self>
    + Div<<Self as Scalar>::Coefficient, Output = Self>
{
    /// The number that coefficients of a law are given in: the same number, or a plainer one where derivatives are taken
    /// along directions in which coefficients are constant. A law is written as `p[0] * v * v` whichever it is.
    type Coefficient: Scalar<Coefficient = Self::Coefficient>
        + Add<Self, Output = Self>
        + Sub<Self, Output = Self>
        + Mul<Self, Output = Self>;

    /// The outcome of a comparison: `bool`, or one flag a lane.
    type Mask: Copy;

    /// The constant `x` in every lane, with zero derivatives.
    fn from_f64(x: f64) -> Self;
    /// A coefficient as a number, with zero derivatives where coefficients carry none.
    fn lift(coefficient: Self::Coefficient) -> Self;
    /// The real part (of the first lane). For messages and decisions outside the dynamics only.
    fn value(self) -> f64;
    /// True when the real part is finite in every lane.
    fn is_finite(self) -> bool;
    /// Where `self < other`, by real part.
    fn less(self, other: Self) -> Self::Mask;
    /// `a` where the mask is true, `b` elsewhere; derivatives are taken with the value.
    fn select(mask: Self::Mask, a: Self, b: Self) -> Self;
    /// Square root. The argument must be positive where a derivative is wanted.
    fn sqrt(self) -> Self;
    /// Natural exponential.
    fn exp(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// Sine and cosine of an angle in radians.
    fn sin_cos(self) -> (Self, Self);
    /// Hyperbolic tangent.
    fn tanh(self) -> Self;
    /// Four-quadrant arc tangent of `self / x`, in [-pi, pi] (-pi only for `self = -0.0`).
    ///
    /// At the origin, where the angle is not defined, the value and the derivatives are zero, whatever the signs of the
    /// zeros. The derivatives are also zero where `self^2 + x^2` underflows, that is within 1e-154 of the origin.
    fn atan2(self, x: Self) -> Self;

    /// The constant 0.
    #[inline(always)]
    fn zero() -> Self {
        Self::from_f64(0.0)
    }
    /// The constant 1.
    #[inline(always)]
    fn one() -> Self {
        Self::from_f64(1.0)
    }
    /// Sine of an angle in radians.
    #[inline(always)]
    fn sin(self) -> Self {
        self.sin_cos().0
    }
    /// Cosine of an angle in radians.
    #[inline(always)]
    fn cos(self) -> Self {
        self.sin_cos().1
    }
    /// `self * factor + summand`, in one rounding where the machine can and in two elsewhere.
    #[inline(always)]
    fn mul_add(self, factor: Self, summand: Self) -> Self {
        self * factor + summand
    }
    /// `self^2`.
    #[inline(always)]
    fn squared(self) -> Self {
        self * self
    }
    /// Absolute value; the derivative at 0 is that of the right-hand branch.
    #[inline(always)]
    fn abs(self) -> Self {
        Self::select(self.less(Self::zero()), -self, self)
    }
    /// The larger of two.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::select(self.less(other), other, self)
    }
    /// The smaller of two.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::select(other.less(self), other, self)
    }
    /// The integer nearest to the real part, the lower one of two equally near, with zero derivatives.
    ///
    /// The default reads [`Scalar::value`]; a type with lanes must override it.
    #[inline(always)]
    fn nearest(self) -> Self {
        let even = self.value().round_ties_even();
        Self::from_f64(if even - self.value() == 0.5 { even - 1.0 } else { even })
    }
    /// `self` limited to `[lo, hi]`; the derivative vanishes outside.
    #[inline(always)]
    fn clamp(self, lo: f64, hi: f64) -> Self {
        self.max(Self::from_f64(lo)).min(Self::from_f64(hi))
    }
}

impl Scalar for f64 {
    type Coefficient = Self;
    type Mask = bool;

    #[inline]
    fn lift(coefficient: Self) -> Self {
        coefficient
    }

    #[inline]
    fn from_f64(x: f64) -> Self {
        x
    }
    #[inline]
    fn value(self) -> f64 {
        self
    }
    #[inline]
    fn is_finite(self) -> bool {
        f64::is_finite(self)
    }
    #[inline]
    fn less(self, other: Self) -> bool {
        self < other
    }
    #[inline]
    fn select(mask: bool, a: Self, b: Self) -> Self {
        if mask { a } else { b }
    }
    #[inline]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline]
    fn exp(self) -> Self {
        f64::exp(self)
    }
    #[inline]
    fn ln(self) -> Self {
        f64::ln(self)
    }
    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        f64::sin_cos(self)
    }
    #[inline]
    fn tanh(self) -> Self {
        f64::tanh(self)
    }
    #[inline]
    fn atan2(self, x: Self) -> Self {
        if self == 0.0 && x == 0.0 { 0.0 } else { f64::atan2(self, x) }
    }
}
