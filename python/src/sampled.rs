//! Numbers whose values can be taken out of them, run by run: what a function of plain numbers needs to be a part of the physics.
//! It differentiates nothing.

use trimtab::physics::{Lanes, NumDual};
use trimtab::simulate::sensitivity::Plain;
use trimtab_ad::{Along, Dual, Scalar};

/// A number of the physics as plain numbers side by side, with derivatives or without.
pub trait Sampled: Scalar {
    /// How many plain numbers it consists of.
    const WIDTH: usize;
    /// Whether it carries derivatives.
    const CARRIES: bool;
    /// One of them.
    fn lane(self, lane: usize) -> f64;
    /// A number from them, without derivatives.
    fn of_lanes(values: &[f64]) -> Self;
}

impl Sampled for f64 {
    const WIDTH: usize = 1;
    const CARRIES: bool = false;
    fn lane(self, _lane: usize) -> f64 {
        self
    }
    fn of_lanes(values: &[f64]) -> Self {
        values[0]
    }
}

impl Sampled for Lanes {
    const WIDTH: usize = <Self as Plain>::WIDTH;
    const CARRIES: bool = false;
    fn lane(self, lane: usize) -> f64 {
        self.in_lane(lane)
    }
    fn of_lanes(values: &[f64]) -> Self {
        Self::gather(|lane| values[lane])
    }
}

impl Sampled for NumDual {
    const WIDTH: usize = 1;
    const CARRIES: bool = true;
    fn lane(self, _lane: usize) -> f64 {
        self.value()
    }
    fn of_lanes(values: &[f64]) -> Self {
        Self::from_f64(values[0])
    }
}

macro_rules! with_derivatives {
    ($number:ident) => {
        impl<T: Sampled, const N: usize> Sampled for $number<T, N>
        where
            Self: Scalar,
        {
            const WIDTH: usize = T::WIDTH;
            const CARRIES: bool = true;
            fn lane(self, lane: usize) -> f64 {
                self.re.lane(lane)
            }
            fn of_lanes(values: &[f64]) -> Self {
                Self::constant(T::of_lanes(values))
            }
        }
    };
}
with_derivatives!(Dual);
with_derivatives!(Along);
