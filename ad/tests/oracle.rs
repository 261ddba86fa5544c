//! This crate's dual numbers against those of num-dual, an independent implementation: every operator and function, first
//! and second order. No derivative here is computed by hand; those are in `laws.rs`.

mod functions;

use functions::{Function, close};
use num_dual::{Derivative, Dual2SVec64, Dual64, DualSVec64, HyperDual64, HyperDualSVec64};
use proptest::prelude::*;
use trimtab_ad::{Dual, Scalar};

type First = Dual<f64, 2>;
type Second = Dual<Dual<f64, 2>, 2>;

/// The `j`-th variable with respect to which both orders are taken.
fn second_order(x: f64, j: usize) -> Second {
    Dual::variable(Dual::variable(x, j), j)
}

fn entry<const R: usize, const C: usize>(
    d: &Derivative<f64, nalgebra::Const<R>, nalgebra::Const<C>>,
    i: usize,
    j: usize,
) -> f64 {
    d.0.map_or(0.0, |m| m[(i, j)])
}

proptest! {
    #![proptest_config(functions::config())]

    #[test]
    fn first_derivatives_are_those_of_num_dual(unit in [0.0..1.0, 0.0..1.0]) {
        for f in Function::ALL {
            let [x, y] = f.point(unit);
            let ours = f.of(First::variable(x, 0), First::variable(y, 1));
            let theirs = f.of(DualSVec64::<2>::from_re(x).derivative(0), DualSVec64::from_re(y).derivative(1));
            prop_assert!(close(ours.re, theirs.re, 1e-14), "{f:?} at {x}, {y}: {ours:?} {theirs:?}");
            for j in 0..2 {
                prop_assert!(close(ours.eps[j], entry(&theirs.eps, j, 0), 1e-13), "{f:?} at {x}, {y}: {ours:?} {theirs:?}");
            }
        }
    }

    #[test]
    fn a_directional_derivative_is_that_of_num_dual(unit in [0.0..1.0, 0.0..1.0], direction in [-1.0..1.0, -1.0..1.0]) {
        for f in Function::ALL {
            let [x, y] = f.point(unit);
            let ours = f.of(Dual { re: x, eps: [direction[0]] }, Dual { re: y, eps: [direction[1]] });
            let theirs = f.of(Dual64::new(x, direction[0]), Dual64::new(y, direction[1]));
            prop_assert!(close(ours.re, theirs.re, 1e-14) && close(ours.eps[0], theirs.eps, 1e-13), "{f:?} at {x}, {y}");
        }
    }

    #[test]
    fn second_derivatives_are_those_of_all_second_order_types_of_num_dual(unit in [0.0..1.0, 0.0..1.0]) {
        for f in Function::ALL {
            let [x, y] = f.point(unit);
            let ours = f.of(second_order(x, 0), second_order(y, 1));
            let dual2 = f.of(Dual2SVec64::<2>::from_re(x).derivative(0), Dual2SVec64::from_re(y).derivative(1));
            let hyper_vec = f.of(
                HyperDualSVec64::<2, 2>::from_re(x).derivative1(0).derivative2(0),
                HyperDualSVec64::from_re(y).derivative1(1).derivative2(1),
            );
            let hyper = f.of(HyperDual64::new(x, 1.0, 0.0, 0.0), HyperDual64::new(y, 0.0, 1.0, 0.0));
            prop_assert!(close(ours.eps[0].eps[1], hyper.eps1eps2, 1e-11), "{f:?} at {x}, {y}: {ours:?} {hyper:?}");
            for i in 0..2 {
                let gradient = ours.re.eps[i];
                prop_assert_eq!(gradient.to_bits(), ours.eps[i].re.to_bits(), "{:?} has two gradients", f);
                prop_assert!(close(gradient, entry(&dual2.v1, 0, i), 1e-13), "{f:?} at {x}, {y}: {ours:?} {dual2:?}");
                for j in 0..2 {
                    let hessian = ours.eps[i].eps[j];
                    prop_assert!(close(hessian, entry(&dual2.v2, i, j), 1e-11), "{f:?} at {x}, {y}: {ours:?} {dual2:?}");
                    prop_assert!(close(hessian, entry(&hyper_vec.eps1eps2, i, j), 1e-11), "{f:?} at {x}, {y}");
                }
            }
        }
    }

    #[test]
    fn nesting_does_not_change_the_inner_number(unit in [0.0..1.0, 0.0..1.0]) {
        for f in Function::ALL {
            let [x, y] = f.point(unit);
            let value = f.of(x, y);
            let first = f.of(First::variable(x, 0), First::variable(y, 1));
            let second = f.of(second_order(x, 0), second_order(y, 1));
            prop_assert_eq!(value.to_bits(), first.re.to_bits(), "{:?} at {}, {}", f, x, y);
            prop_assert_eq!(first, second.re, "{:?} at {}, {}", f, x, y);
        }
    }
}

/// The laws every implementation of [`Scalar`] keeps at points where a textbook formula would divide by zero.
fn keeps_the_corners<S: Scalar>(x: impl Fn(f64) -> S, derivatives: impl Fn(S) -> Vec<f64>) {
    for (y, angle) in [(1.0, std::f64::consts::FRAC_PI_2), (-1.0, -std::f64::consts::FRAC_PI_2)] {
        let abeam = x(y).atan2(S::zero());
        assert_eq!(abeam.value(), angle);
        assert!(derivatives(abeam).iter().all(|d| d.is_finite()), "{abeam:?}");
    }
    for (y, along) in [(0.0, 0.0), (-0.0, 0.0), (0.0, -0.0), (-0.0, -0.0), (1e-200, 1e-200)] {
        let origin = x(y).atan2(x(along));
        assert!(derivatives(origin).iter().all(|&d| d == 0.0), "atan2({y}, {along}): {origin:?}");
        assert_eq!(origin.value(), if y == along && y > 0.0 { std::f64::consts::FRAC_PI_4 } else { 0.0 });
    }
    for end in [-800.0, 800.0] {
        let flat = x(end).tanh();
        assert_eq!(flat.value(), f64::signum(end));
        assert!(derivatives(flat).iter().all(|&d| d == 0.0), "tanh({end}): {flat:?}");
    }
    let not_taken = S::select(x(-1.0).less(S::zero()), x(2.0), x(-1.0).sqrt() / S::zero());
    assert_eq!(not_taken.value(), 2.0);
    assert!(derivatives(not_taken).iter().all(|d| d.is_finite()), "NaN leaks from the other arm: {not_taken:?}");
    assert!(!x(f64::NAN).is_finite() && !x(f64::INFINITY).is_finite() && x(-3.0).is_finite());
}

#[test]
fn every_number_type_is_finite_where_a_textbook_formula_divides_by_zero() {
    keeps_the_corners(|x| x, |_| vec![]);
    keeps_the_corners(|x| First::variable(x, 1), |z| z.eps.to_vec());
    keeps_the_corners(
        |x| second_order(x, 1),
        |z| z.eps.iter().flat_map(|e| e.eps).chain(z.re.eps).chain(z.eps.map(|e| e.re)).collect(),
    );
    keeps_the_corners(|x| Dual64::new(x, 1.0), |z| vec![z.eps]);
    keeps_the_corners(|x| DualSVec64::<2>::from_re(x).derivative(1), |z| (0..2).map(|j| entry(&z.eps, j, 0)).collect());
    keeps_the_corners(|x| HyperDual64::new(x, 1.0, 1.0, 0.0), |z| vec![z.eps1, z.eps2, z.eps1eps2]);
    keeps_the_corners(
        |x| HyperDualSVec64::<2, 1>::from_re(x).derivative1(1).derivative2(0),
        |z| vec![entry(&z.eps1, 1, 0), entry(&z.eps2, 0, 0), entry(&z.eps1eps2, 1, 0)],
    );
    keeps_the_corners(
        |x| Dual2SVec64::<2>::from_re(x).derivative(1),
        |z| vec![entry(&z.v1, 0, 1), entry(&z.v2, 1, 1), entry(&z.v2, 0, 1)],
    );
}

#[test]
fn the_angle_of_the_origin_has_no_mixed_derivative() {
    let angle = second_order(0.0, 0).atan2(second_order(0.0, 1));
    assert_eq!(angle, Second::zero());
}
