//! [`Scalar`] for the dual numbers of the `num-dual` crate: vectors of first derivatives, hyper-duals and second order.
//! They are the independent implementation that this crate's own [`Dual`](crate::Dual) is tested against; no new number
//! type is defined here.

use crate::Scalar;
use ::num_dual::{Dual2SVec64, Dual64, DualNum, DualSVec64, HyperDual64, HyperDualSVec64};

/// Beyond this argument `tanh` is 1 and flat to the last bit, while the `sinh / cosh` of num-dual goes on to overflow.
const TANH_IS_FLAT: f64 = 20.0;

/// Implements [`Scalar`] for a num-dual type whose real part is an `f64` field `re`.
macro_rules! scalar_from_num_dual {
    ($number:ty $(, const $n:ident)*) => {
        impl<$(const $n: usize),*> Scalar for $number {
            type Coefficient = Self;
            type Mask = bool;

            #[inline]
            fn lift(coefficient: Self) -> Self {
                coefficient
            }

            #[inline]
            fn from_f64(x: f64) -> Self {
                Self::from_re(x)
            }
            #[inline]
            fn value(self) -> f64 {
                self.re
            }
            #[inline]
            fn is_finite(self) -> bool {
                self.re.is_finite()
            }
            #[inline]
            fn less(self, other: Self) -> bool {
                self.re < other.re
            }
            #[inline]
            fn select(mask: bool, a: Self, b: Self) -> Self {
                if mask { a } else { b }
            }
            #[inline]
            fn sqrt(self) -> Self {
                DualNum::sqrt(&self)
            }
            #[inline]
            fn exp(self) -> Self {
                DualNum::exp(&self)
            }
            #[inline]
            fn ln(self) -> Self {
                DualNum::ln(&self)
            }
            #[inline]
            fn sin_cos(self) -> (Self, Self) {
                DualNum::sin_cos(&self)
            }
            #[inline]
            fn tanh(self) -> Self {
                if self.re.abs() > TANH_IS_FLAT {
                    return Self::from_re(self.re.signum());
                }
                let mut t = DualNum::tanh(&self);
                t.re = self.re.tanh();
                t
            }
            /// num-dual differentiates `atan(y / x)`, which divides by zero abeam; the larger of the two is the divisor here.
            #[inline]
            fn atan2(self, x: Self) -> Self {
                let re = Scalar::atan2(self.re, x.re);
                if self.re * self.re + x.re * x.re < f64::MIN_POSITIVE {
                    return Self::from_re(re);
                }
                let mut angle =
                    if self.re.abs() > x.re.abs() { -DualNum::atan(&(x / self)) } else { DualNum::atan(&(self / x)) };
                angle.re = re;
                angle
            }
        }
    };
}

scalar_from_num_dual!(Dual64);
scalar_from_num_dual!(DualSVec64<N>, const N);
scalar_from_num_dual!(HyperDual64);
scalar_from_num_dual!(HyperDualSVec64<M, N>, const M, const N);
scalar_from_num_dual!(Dual2SVec64<N>, const N);
