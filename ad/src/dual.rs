//! Forward-mode dual numbers with `N` partial derivatives over any [`Scalar`]: `f64`, SIMD lanes, or duals again.
//! It is not a tape: nothing is recorded and there is no reverse pass.

use crate::{Lanes, Scalar};
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};

/// `re + sum_j eps[j] e_j` with `e_i e_j = 0`: a value and its `N` first derivatives.
///
/// The value is computed by the same operations as without derivatives and has the same bits. `Dual<Dual<f64, N>, M>` has
/// second derivatives in `eps[i].eps[j]`; `Dual<Lanes, N>` differentiates four evaluations at once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dual<T, const N: usize> {
    /// The value.
    pub re: T,
    /// The partial derivatives.
    pub eps: [T; N],
}

/// A dual number along directions in which coefficients are constant: the derivatives of a law by its variables, at fixed
/// coefficients.
///
/// As [`Dual`], but its [`Scalar::Coefficient`] is the plain number `T`: a product of a coefficient and a variable then costs
/// `1 + N` multiplications instead of `1 + 2 N`. It exists over `f64` and over [`Lanes`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Along<T, const N: usize> {
    /// The value.
    pub re: T,
    /// The derivatives along the directions.
    pub eps: [T; N],
}

/// As `eps.map(f)`, written so that it is always unrolled in place.
#[inline(always)]
fn each<T: Copy, const N: usize>(mut eps: [T; N], f: impl Fn(T) -> T) -> [T; N] {
    for e in &mut eps {
        *e = f(*e);
    }
    eps
}

/// What both kinds of dual number do alike: construction and arithmetic.
macro_rules! dual_arithmetic {
    ($Number:ident, $inline:meta) => {
        impl<T: Scalar, const N: usize> $Number<T, N> {
            /// A constant: zero derivatives.
            #[$inline]
            pub fn constant(re: T) -> Self {
                Self { re, eps: [T::zero(); N] }
            }
            /// The `j`-th independent variable: derivative 1 in place `j`.
            #[$inline]
            pub fn variable(re: T, j: usize) -> Self {
                let mut x = Self::constant(re);
                x.eps[j] = T::one();
                x
            }
            /// `f(x)` from the value `f` and the derivative `df` at the real part.
            #[$inline]
            fn chain(self, f: T, df: T) -> Self {
                Self { re: f, eps: each(self.eps, |e| e * df) }
            }
        }

        impl<T: Scalar, const N: usize> Add for $Number<T, N> {
            type Output = Self;
            #[$inline]
            fn add(mut self, o: Self) -> Self {
                self += o;
                self
            }
        }
        impl<T: Scalar, const N: usize> Sub for $Number<T, N> {
            type Output = Self;
            #[$inline]
            fn sub(mut self, o: Self) -> Self {
                self -= o;
                self
            }
        }
        impl<T: Scalar, const N: usize> Mul for $Number<T, N> {
            type Output = Self;
            #[$inline]
            fn mul(self, o: Self) -> Self {
                let mut eps = self.eps;
                for j in 0..N {
                    eps[j] = self.eps[j].mul_add(o.re, o.eps[j] * self.re);
                }
                Self { re: self.re * o.re, eps }
            }
        }
        impl<T: Scalar, const N: usize> Div for $Number<T, N> {
            type Output = Self;
            #[$inline]
            fn div(self, o: Self) -> Self {
                // A division of its own, not `self.re * inv`: the value then has the same bits as without derivatives.
                let re = self.re / o.re;
                let inv = T::one() / o.re;
                let mut eps = self.eps;
                for j in 0..N {
                    eps[j] = o.eps[j].mul_add(-re, self.eps[j]) * inv;
                }
                Self { re, eps }
            }
        }
        impl<T: Scalar, const N: usize> Neg for $Number<T, N> {
            type Output = Self;
            #[$inline]
            fn neg(self) -> Self {
                Self { re: -self.re, eps: each(self.eps, |e| -e) }
            }
        }
        impl<T: Scalar, const N: usize> Add<f64> for $Number<T, N> {
            type Output = Self;
            #[$inline]
            fn add(self, x: f64) -> Self {
                Self { re: self.re + x, eps: self.eps }
            }
        }
        impl<T: Scalar, const N: usize> Sub<f64> for $Number<T, N> {
            type Output = Self;
            #[$inline]
            fn sub(self, x: f64) -> Self {
                Self { re: self.re - x, eps: self.eps }
            }
        }
        impl<T: Scalar, const N: usize> Mul<f64> for $Number<T, N> {
            type Output = Self;
            #[$inline]
            fn mul(self, x: f64) -> Self {
                Self { re: self.re * x, eps: each(self.eps, |e| e * x) }
            }
        }
        impl<T: Scalar, const N: usize> Div<f64> for $Number<T, N> {
            type Output = Self;
            #[$inline]
            fn div(self, x: f64) -> Self {
                let inv = 1.0 / x;
                Self { re: self.re / x, eps: each(self.eps, |e| e * inv) }
            }
        }
        impl<T: Scalar, const N: usize> AddAssign for $Number<T, N> {
            #[$inline]
            fn add_assign(&mut self, o: Self) {
                self.re += o.re;
                for j in 0..N {
                    self.eps[j] += o.eps[j];
                }
            }
        }
        impl<T: Scalar, const N: usize> SubAssign for $Number<T, N> {
            #[$inline]
            fn sub_assign(&mut self, o: Self) {
                self.re -= o.re;
                for j in 0..N {
                    self.eps[j] -= o.eps[j];
                }
            }
        }
        impl<T: Scalar, const N: usize> MulAssign for $Number<T, N> {
            #[$inline]
            fn mul_assign(&mut self, o: Self) {
                *self = *self * o;
            }
        }
    };
}
dual_arithmetic!(Dual, inline);
dual_arithmetic!(Along, inline(always));

/// The functions of a [`Scalar`], for a dual number over `$t`.
macro_rules! dual_functions {
    ($t:ty, $inline:meta) => {
        type Mask = <$t as Scalar>::Mask;

        #[$inline]
        fn from_f64(x: f64) -> Self {
            Self::constant(<$t>::from_f64(x))
        }
        #[$inline]
        fn value(self) -> f64 {
            self.re.value()
        }
        #[$inline]
        fn is_finite(self) -> bool {
            self.re.is_finite()
        }
        #[$inline]
        fn less(self, other: Self) -> Self::Mask {
            self.re.less(other.re)
        }
        #[$inline]
        fn select(mask: Self::Mask, a: Self, b: Self) -> Self {
            let mut eps = a.eps;
            for j in 0..N {
                eps[j] = <$t>::select(mask, a.eps[j], b.eps[j]);
            }
            Self { re: <$t>::select(mask, a.re, b.re), eps }
        }
        #[$inline]
        fn sqrt(self) -> Self {
            let s = self.re.sqrt();
            self.chain(s, <$t>::from_f64(0.5) / s)
        }
        #[$inline]
        fn exp(self) -> Self {
            let e = self.re.exp();
            self.chain(e, e)
        }
        #[$inline]
        fn ln(self) -> Self {
            self.chain(self.re.ln(), <$t>::one() / self.re)
        }
        #[$inline]
        fn sin_cos(self) -> (Self, Self) {
            let (s, c) = self.re.sin_cos();
            (self.chain(s, c), self.chain(c, -s))
        }
        #[$inline]
        fn tanh(self) -> Self {
            let t = self.re.tanh();
            self.chain(t, <$t>::one() - t * t)
        }
        #[$inline]
        fn atan2(self, x: Self) -> Self {
            // At the origin `inv` is the constant 0, not a large number: the second derivatives vanish there as well.
            let distance2 = self.re * self.re + x.re * x.re;
            let origin = distance2.less(<$t>::from_f64(f64::MIN_POSITIVE));
            let inv = <$t>::select(origin, <$t>::zero(), <$t>::one() / <$t>::select(origin, <$t>::one(), distance2));
            let (dy, dx) = (x.re * inv, -self.re * inv);
            let mut eps = self.eps;
            for j in 0..N {
                eps[j] = self.eps[j].mul_add(dy, x.eps[j] * dx);
            }
            Self { re: self.re.atan2(x.re), eps }
        }
        #[$inline]
        fn nearest(self) -> Self {
            Self::constant(self.re.nearest())
        }
    };
}

impl<T: Scalar, const N: usize> Scalar for Dual<T, N> {
    type Coefficient = Self;
    #[inline(always)]
    fn lift(coefficient: Self) -> Self {
        coefficient
    }
    dual_functions!(T, inline);
}

macro_rules! along {
    ($t:ty) => {
        impl<const N: usize> Scalar for Along<$t, N> {
            type Coefficient = $t;
            #[inline(always)]
            fn lift(coefficient: $t) -> Self {
                Self::constant(coefficient)
            }
            dual_functions!($t, inline(always));
        }
        impl<const N: usize> Mul<Along<$t, N>> for $t {
            type Output = Along<$t, N>;
            #[inline(always)]
            fn mul(self, x: Along<$t, N>) -> Along<$t, N> {
                Along { re: self * x.re, eps: each(x.eps, |e| e * self) }
            }
        }
        impl<const N: usize> Add<Along<$t, N>> for $t {
            type Output = Along<$t, N>;
            #[inline(always)]
            fn add(self, x: Along<$t, N>) -> Along<$t, N> {
                Along { re: self + x.re, eps: x.eps }
            }
        }
        impl<const N: usize> Sub<Along<$t, N>> for $t {
            type Output = Along<$t, N>;
            #[inline(always)]
            fn sub(self, x: Along<$t, N>) -> Along<$t, N> {
                Along { re: self - x.re, eps: each(x.eps, |e| -e) }
            }
        }
    };
}
along!(f64);
along!(Lanes);

impl<const N: usize> Mul<Lanes> for Along<Lanes, N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, x: Lanes) -> Self {
        Self { re: self.re * x, eps: each(self.eps, |e| e * x) }
    }
}
impl<const N: usize> Add<Lanes> for Along<Lanes, N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, x: Lanes) -> Self {
        Self { re: self.re + x, eps: self.eps }
    }
}
impl<const N: usize> Sub<Lanes> for Along<Lanes, N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, x: Lanes) -> Self {
        Self { re: self.re - x, eps: self.eps }
    }
}
impl<const N: usize> Div<Lanes> for Along<Lanes, N> {
    type Output = Self;
    #[inline(always)]
    fn div(self, x: Lanes) -> Self {
        let inv = Lanes::one() / x;
        Self { re: self.re / x, eps: each(self.eps, |e| e * inv) }
    }
}

impl<const N: usize> Dual<Lanes, N> {
    /// The dual number in one lane. Panics, as a slice does, when `lane` is not below [`Lanes::LANES`].
    #[inline]
    pub fn lane(self, lane: usize) -> Dual<f64, N> {
        Dual { re: self.re.lane(lane), eps: self.eps.map(|e| e.lane(lane)) }
    }
}
