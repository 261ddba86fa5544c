//! Numbers for physics that is written once and evaluated many ways.
//!
//! [`Scalar`] is the trait that dynamics are written against. Nothing in this crate is about ships: it has the numbers,
//! their derivatives, and smooth shapes for which those derivatives exist.
//!
//! | number | one evaluation gives |
//! |---|---|
//! | `f64` | the value |
//! | [`Dual<f64, N>`](Dual) | the value and `N` exact first derivatives |
//! | [`Dual<Dual<f64, N>, M>`](Dual) | those and `M x N` exact second derivatives |
//! | [`Lanes`] | four values |
//! | [`Dual<Lanes, N>`](Dual) | four values, each with `N` derivatives |
//! | num-dual's `Dual64`, `DualSVec64`, `HyperDual64`, `HyperDualSVec64`, `Dual2SVec64` | as [`Dual`], by an independent implementation |
//!
//! # Dual numbers, by an example
//!
//! A hull resists with `X = -12 u |u|` newton at the speed `u`. What is the slope of the resistance at 3 m/s? By hand
//! `dX/du = -24 |u| = -72`. By differences one evaluates at `u` and at `u + h`, and has to choose an `h` that is small, but
//! not so small that rounding swamps the difference.
//!
//! A dual number carries the step along *without giving it a size*. Write `u = 3 + e` and agree that `e` is so small that
//! `e^2 = 0`. Then
//!
//! ```text
//! u |u|     = (3 + e) (3 + e) = 9 + 6 e + e^2 = 9 + 6 e
//! -12 u |u| = -108 - 72 e
//! ```
//!
//! and the factor of `e` is the derivative: not an estimate, the number itself. Nothing in it depended on the function; a
//! machine has only to know how a sum and a product treat the pair (value, factor of `e`),
//!
//! ```text
//! (a + a' e) + (b + b' e) = (a + b) + (a' + b') e
//! (a + a' e) * (b + b' e) =  a b    + (a' b + a b') e          the product rule
//! f(a + a' e)             =  f(a)   + f'(a) a' e               the chain rule
//! ```
//!
//! and any program made of such steps, loops and time integration included, differentiates itself as it runs:
//!
//! ```
//! use trimtab_ad::{Dual, Scalar};
//!
//! fn resistance<S: Scalar>(u: S) -> S {
//!     u * u.abs() * -12.0
//! }
//!
//! assert_eq!(resistance(3.0), -108.0);
//!
//! let x = resistance(Dual::<f64, 1>::variable(3.0, 0));
//! assert_eq!(x.re, -108.0);
//! assert_eq!(x.eps[0], -72.0); // dX/du in N s/m
//! ```
//!
//! With several variables each gets an infinitesimal of its own, `e_1 ... e_N` with every product `e_i e_j = 0`, and one
//! pass gives the whole gradient. Here the ship coasts for ten seconds, and the distance run is differentiated by the
//! resistance coefficient and by the mass, through each of the hundred steps:
//!
//! ```
//! use trimtab_ad::{Scalar, ScalarFunction, Step, check_gradient, gradient, hessian};
//!
//! /// How far a hull of `x = [resistance coefficient in kg/m, mass in kg]` coasts in 10 s from 2 m/s.
//! struct Coasting;
//! impl ScalarFunction for Coasting {
//!     fn of<S: Scalar>(&self, x: &[S]) -> S {
//!         let dt = 0.1;
//!         let (mut u, mut distance) = (S::from_f64(2.0), S::zero());
//!         for _ in 0..100 {
//!             distance += u * dt;
//!             u -= x[0] * u * u.abs() / x[1] * dt;
//!         }
//!         distance
//!     }
//! }
//!
//! let x = [12.0, 1000.0];
//! let (distance, slope) = gradient(&Coasting, &x);
//! assert!(distance > 17.0 && distance < 20.0);
//! assert!(slope[0] < 0.0 && slope[1] > 0.0); // more drag runs shorter, more mass runs longer
//! assert!((slope[0] * x[0] + slope[1] * x[1]).abs() < 1e-12); // only the ratio of the two matters
//!
//! assert!(check_gradient(&Coasting, &x, Step::default(), 1e-6).passed());
//! let (_, _, curvature) = hessian(&Coasting, &x);
//! assert_eq!(curvature[(0, 1)], curvature[(1, 0)]);
//! ```
//!
//! # Branches
//!
//! `if u < 0` has one outcome for one number and four for lanes. Branches on values are written with
//! [`Scalar::select`]; the derivative is that of the arm chosen, and the value of the other arm, even a NaN, is dropped:
//!
//! ```
//! use trimtab_ad::{Dual, Lanes, Scalar};
//!
//! fn root_or_zero<S: Scalar>(x: S) -> S {
//!     S::select(x.less(S::zero()), S::zero(), x.sqrt())
//! }
//!
//! let x = Lanes::from_fn(|lane| if lane < 2 { -1.0 } else { 4.0 });
//! let y = root_or_zero(Dual::<Lanes, 1>::variable(x, 0));
//! assert_eq!((y.lane(0).re, y.lane(0).eps[0]), (0.0, 0.0));
//! assert_eq!((y.lane(3).re, y.lane(3).eps[0]), (2.0, 0.25));
//! ```
//!
//! # Corners
//!
//! `|u|` has no derivative at 0 and a clamp none at its ends; a solver that arrives there gets the slope of one side.
//! [`smooth`] has rounded versions. `sqrt` has an infinite slope at 0: write `(x * x + eps).sqrt()`, or select around it.

mod dual;
mod jacobian;
mod lanes;
mod num_dual;
mod scalar;
pub mod smooth;

pub use dual::{Along, Dual};
pub use jacobian::{
    CHUNK, GradientCheck, GradientEntry, HESSIAN_CHUNK, ScalarFunction, Step, VectorFunction, central_differences,
    check_gradient, gradient, hessian, hessian_in_chunks, jacobian, jacobian_in_chunks,
};
pub use lanes::{LaneMask, Lanes};
pub use scalar::Scalar;
