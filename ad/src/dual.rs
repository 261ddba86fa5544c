//! Forward-mode dual numbers with `N` partial derivatives over any [`Scalar`]: `f64`, SIMD lanes, or duals again.
//! It is not a tape: nothing is recorded and there is no reverse pass.

use crate::Scalar;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

/// `re + sum_j eps[j] e_j` with `e_i e_j = 0`: a value and its `N` first derivatives.
///
/// The value is computed by the same operations as without derivatives and has the same bits. `Dual<Dual<f64, N>, M>` has
/// second derivatives in `eps[i].eps[j]`; `Dual<Lanes, N>` differentiates eight evaluations at once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<T, const N: usize> {
    /// The value.
    pub re: T,
    /// The partial derivatives.
    pub eps: [T; N],
}

impl<T: Scalar, const N: usize> Dual<T, N> {
    /// A constant: zero derivatives.
    #[inline]
    pub fn constant(re: T) -> Self {
        Self { re, eps: [T::zero(); N] }
    }
    /// The `j`-th independent variable: derivative 1 in place `j`.
    #[inline]
    pub fn variable(re: T, j: usize) -> Self {
        let mut x = Self::constant(re);
        x.eps[j] = T::one();
        x
    }
    /// `f(x)` from the value `f` and the derivative `df` at the real part.
    #[inline]
    fn chain(self, f: T, df: T) -> Self {
        Self { re: f, eps: self.eps.map(|e| e * df) }
    }
}

impl<T: Scalar, const N: usize> Add for Dual<T, N> {
    type Output = Self;
    #[inline]
    fn add(mut self, o: Self) -> Self {
        self += o;
        self
    }
}
impl<T: Scalar, const N: usize> Sub for Dual<T, N> {
    type Output = Self;
    #[inline]
    fn sub(mut self, o: Self) -> Self {
        self -= o;
        self
    }
}
impl<T: Scalar, const N: usize> Mul for Dual<T, N> {
    type Output = Self;
    #[inline]
    fn mul(self, o: Self) -> Self {
        let mut eps = self.eps;
        for j in 0..N {
            eps[j] = self.eps[j] * o.re + o.eps[j] * self.re;
        }
        Self { re: self.re * o.re, eps }
    }
}
impl<T: Scalar, const N: usize> Div for Dual<T, N> {
    type Output = Self;
    #[inline]
    fn div(self, o: Self) -> Self {
        // A division of its own, not `self.re * inv`: the value then has the same bits as without derivatives.
        let re = self.re / o.re;
        let inv = T::one() / o.re;
        let mut eps = self.eps;
        for j in 0..N {
            eps[j] = (self.eps[j] - o.eps[j] * re) * inv;
        }
        Self { re, eps }
    }
}
impl<T: Scalar, const N: usize> Neg for Dual<T, N> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self { re: -self.re, eps: self.eps.map(|e| -e) }
    }
}
impl<T: Scalar, const N: usize> Add<f64> for Dual<T, N> {
    type Output = Self;
    #[inline]
    fn add(self, x: f64) -> Self {
        Self { re: self.re + x, eps: self.eps }
    }
}
impl<T: Scalar, const N: usize> Sub<f64> for Dual<T, N> {
    type Output = Self;
    #[inline]
    fn sub(self, x: f64) -> Self {
        Self { re: self.re - x, eps: self.eps }
    }
}
impl<T: Scalar, const N: usize> Mul<f64> for Dual<T, N> {
    type Output = Self;
    #[inline]
    fn mul(self, x: f64) -> Self {
        Self { re: self.re * x, eps: self.eps.map(|e| e * x) }
    }
}
impl<T: Scalar, const N: usize> Div<f64> for Dual<T, N> {
    type Output = Self;
    #[inline]
    fn div(self, x: f64) -> Self {
        let inv = 1.0 / x;
        Self { re: self.re / x, eps: self.eps.map(|e| e * inv) }
    }
}
impl<T: Scalar, const N: usize> AddAssign for Dual<T, N> {
    #[inline]
    fn add_assign(&mut self, o: Self) {
        self.re += o.re;
        for j in 0..N {
            self.eps[j] += o.eps[j];
        }
    }
}
impl<T: Scalar, const N: usize> SubAssign for Dual<T, N> {
    #[inline]
    fn sub_assign(&mut self, o: Self) {
        self.re -= o.re;
        for j in 0..N {
            self.eps[j] -= o.eps[j];
        }
    }
}
impl<T: Scalar, const N: usize> MulAssign for Dual<T, N> {
    #[inline]
    fn mul_assign(&mut self, o: Self) {
        *self = *self * o;
    }
}

impl<T: Scalar, const N: usize> Scalar for Dual<T, N> {
    type Mask = T::Mask;

    #[inline]
    fn from_f64(x: f64) -> Self {
        Self::constant(T::from_f64(x))
    }
    #[inline]
    fn value(self) -> f64 {
        self.re.value()
    }
    #[inline]
    fn is_finite(self) -> bool {
        self.re.is_finite()
    }
    #[inline]
    fn less(self, other: Self) -> T::Mask {
        self.re.less(other.re)
    }
    #[inline]
    fn select(mask: T::Mask, a: Self, b: Self) -> Self {
        let mut eps = a.eps;
        for j in 0..N {
            eps[j] = T::select(mask, a.eps[j], b.eps[j]);
        }
        Self { re: T::select(mask, a.re, b.re), eps }
    }
    #[inline]
    fn sqrt(self) -> Self {
        let s = self.re.sqrt();
        self.chain(s, T::from_f64(0.5) / s)
    }
    #[inline]
    fn exp(self) -> Self {
        let e = self.re.exp();
        self.chain(e, e)
    }
    #[inline]
    fn ln(self) -> Self {
        self.chain(self.re.ln(), T::one() / self.re)
    }
    #[inline]
    fn sin_cos(self) -> (Self, Self) {
        let (s, c) = self.re.sin_cos();
        (self.chain(s, c), self.chain(c, -s))
    }
    #[inline]
    fn tanh(self) -> Self {
        let t = self.re.tanh();
        self.chain(t, T::one() - t * t)
    }
    #[inline]
    fn atan2(self, x: Self) -> Self {
        // At the origin `inv` is the constant 0, not a large number: the second derivatives vanish there as well.
        let distance2 = self.re * self.re + x.re * x.re;
        let origin = distance2.less(T::from_f64(f64::MIN_POSITIVE));
        let inv = T::select(origin, T::zero(), T::one() / T::select(origin, T::one(), distance2));
        let (dy, dx) = (x.re * inv, -self.re * inv);
        let mut eps = self.eps;
        for j in 0..N {
            eps[j] = self.eps[j] * dy + x.eps[j] * dx;
        }
        Self { re: self.re.atan2(x.re), eps }
    }
    #[inline]
    fn nearest(self) -> Self {
        Self::constant(self.re.nearest())
    }
}
