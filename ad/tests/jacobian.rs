//! Jacobians, gradients and Hessians of whole functions: against central differences, against num-dual, and against
//! themselves cut into other chunks. Single operators are tested in `oracle.rs`.

use nalgebra::{DMatrix, DVector};
use num_dual::Dual2SVec64;
use proptest::prelude::*;
use trimtab_ad::{
    Dual, GradientCheck, Scalar, ScalarFunction, Step, VectorFunction, central_differences, check_gradient, gradient,
    hessian, hessian_in_chunks, jacobian, jacobian_in_chunks,
};

mod functions;

/// A damped pendulum under quadratic friction, 40 Euler steps: each result depends on each variable through a loop.
struct Pendulum;

impl VectorFunction for Pendulum {
    fn outputs(&self) -> usize {
        3
    }
    fn eval<S: Scalar<Coefficient = S>>(&self, x: &[S], y: &mut [S]) {
        let (mut angle, mut rate) = (S::from_f64(0.3), S::zero());
        for step in 0..40 {
            let push = x[step % x.len()];
            let acceleration = push - angle.sin() - rate * rate.abs() * (x[0].squared() + 0.1);
            angle += rate * 0.1;
            rate += acceleration * 0.1;
            y[0] += angle.squared();
        }
        y[1] = angle.atan2(rate);
        y[2] = (rate * 3.0).tanh() * x[x.len() - 1].exp();
    }
}

/// The first result of the pendulum plus a coupling of all variables.
struct Cost;

impl ScalarFunction for Cost {
    fn of<S: Scalar<Coefficient = S>>(&self, x: &[S]) -> S {
        let mut y = [S::zero(); 3];
        Pendulum.eval(x, &mut y);
        let coupling = x.iter().fold(S::one(), |product, &xi| product * (xi + 2.0).ln());
        y[0] + y[1] * y[2] + coupling
    }
}

fn point() -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(-0.9..0.9, 1..14)
}

proptest! {
    #![proptest_config(proptest::test_runner::Config { cases: 100, ..functions::config() })]

    #[test]
    fn the_jacobian_does_not_depend_on_the_chunk(x in point()) {
        let whole = jacobian(&Pendulum, &x);
        prop_assert_eq!(&jacobian_in_chunks::<1, _>(&Pendulum, &x), &whole);
        prop_assert_eq!(&jacobian_in_chunks::<3, _>(&Pendulum, &x), &whole);
        prop_assert_eq!(&jacobian_in_chunks::<16, _>(&Pendulum, &x), &whole);
    }

    #[test]
    fn the_hessian_does_not_depend_on_the_chunk_and_is_symmetric(x in point()) {
        let (value, slope, curvature) = hessian(&Cost, &x);
        prop_assert_eq!(value.to_bits(), Cost.of(&x).to_bits());
        prop_assert_eq!(&curvature, &curvature.transpose());
        for (v, g, h) in [
            hessian_in_chunks::<1, _>(&Cost, &x),
            hessian_in_chunks::<5, _>(&Cost, &x),
            hessian_in_chunks::<16, _>(&Cost, &x),
        ] {
            prop_assert_eq!(v, value);
            prop_assert_eq!(&g, &slope);
            prop_assert!((&h - &curvature).amax() <= 1e-12 * (1.0 + curvature.amax()));
        }
    }

    #[test]
    fn the_values_beside_a_jacobian_have_the_bits_of_a_plain_evaluation(x in point()) {
        let mut y = [0.0; 3];
        Pendulum.eval(&x, &mut y);
        prop_assert_eq!(jacobian(&Pendulum, &x).0, y);
    }

    #[test]
    fn the_jacobian_is_the_limit_of_central_differences(x in point()) {
        let (_, exact) = jacobian(&Pendulum, &x);
        let estimate = central_differences(&Pendulum, &x, Step::default());
        prop_assert!((&exact - &estimate).amax() <= 1e-7 * (1.0 + exact.amax()), "{exact} {estimate}");
    }

    #[test]
    fn halving_the_step_quarters_the_error_of_central_differences(x in point()) {
        /// Smooth, so that only the truncation error remains.
        struct Waves;
        impl VectorFunction for Waves {
            fn outputs(&self) -> usize {
                1
            }
            fn eval<S: Scalar<Coefficient = S>>(&self, x: &[S], y: &mut [S]) {
                y[0] = x.iter().fold(S::zero(), |sum, &xi| sum + (xi * 3.0).exp());
            }
        }
        let (_, exact) = jacobian(&Waves, &x);
        let error = |h| (central_differences(&Waves, &x, Step::Absolute(h)) - &exact).norm();
        let ratio = error(2e-2) / error(1e-2);
        prop_assert!((3.9..4.1).contains(&ratio), "{ratio}");
    }

    #[test]
    fn the_hessian_is_that_of_num_dual(x in prop::array::uniform5(-0.9..0.9)) {
        let (value, slope, curvature) = hessian(&Cost, &x);
        let theirs = Cost.of(&std::array::from_fn::<_, 5, _>(|j| Dual2SVec64::<5>::from_re(x[j]).derivative(j)));
        let their_slope = theirs.v1.0.map(|v| v.transpose()).unwrap_or_default();
        let their_curvature = theirs.v2.0.unwrap_or_default();
        prop_assert!(functions::close(value, theirs.re, 1e-13));
        prop_assert!((&slope - DVector::from_column_slice(their_slope.as_slice())).amax() <= 1e-12 * (1.0 + slope.amax()));
        let difference = &curvature - DMatrix::from_column_slice(5, 5, their_curvature.as_slice());
        prop_assert!(difference.amax() <= 1e-11 * (1.0 + curvature.amax()), "{difference}");
    }

    #[test]
    fn the_hessian_is_the_jacobian_of_the_gradient(x in point()) {
        let slope_at = |x: &[f64]| gradient(&Cost, x).1;
        let (_, slope, curvature) = hessian(&Cost, &x);
        let tolerance = 1e-6 * (1.0 + curvature.amax());
        prop_assert!((slope_at(&x) - slope).amax() <= 1e-12 * (1.0 + curvature.amax()));
        for j in 0..x.len() {
            let h = 1e-5;
            let (mut above, mut below) = (x.clone(), x.clone());
            above[j] += h;
            below[j] -= h;
            let column = (slope_at(&above) - slope_at(&below)) / (2.0 * h);
            prop_assert!((column - curvature.column(j)).amax() <= tolerance);
        }
    }

    #[test]
    fn a_smooth_function_passes_the_gradient_check(x in point()) {
        let check = check_gradient(&Cost, &x, Step::default(), 1e-5);
        prop_assert!(check.passed(), "{check}");
    }
}

/// Two results of three variables of very unlike size; the derivative of the first by the last is wrong by 0.1 %.
struct SlightlyWrong;

impl VectorFunction for SlightlyWrong {
    fn outputs(&self) -> usize {
        2
    }
    fn eval<S: Scalar<Coefficient = S>>(&self, x: &[S], y: &mut [S]) {
        let stuck = S::from_f64(x[2].value());
        y[0] = x[0] * 1e-4 + (x[2] * 0.999 + stuck * 0.001) * 1e-6;
        y[1] = x[0] * x[1] * x[2];
    }
}

#[test]
fn the_gradient_check_names_the_worst_entry_even_where_it_is_tiny() {
    let check = check_gradient(&SlightlyWrong, &[1e4, -3.0, 1e-2], Step::default(), 1e-5);
    let worst = check.worst.unwrap();
    assert!(!check.passed());
    assert_eq!((worst.output, worst.input), (0, 2));
    assert!(check.to_string().contains("d y[0] / d x[2]"), "{check}");
}

#[test]
fn the_gradient_check_passes_a_slope_beside_a_large_constant() {
    /// A value of a million hides a slope of one behind its rounding.
    struct Offset;
    impl ScalarFunction for Offset {
        fn of<S: Scalar<Coefficient = S>>(&self, x: &[S]) -> S {
            x[0] + 1e6
        }
    }
    let check = check_gradient(&Offset, &[0.1], Step::Absolute(1e-7), 1e-6);
    let worst = check.worst.unwrap();
    assert!((worst.estimate - worst.exact).abs() > 1e-6, "the case is too easy: {worst:?}");
    assert!(check.passed(), "{check}");
}

#[test]
fn the_gradient_check_reports_a_derivative_that_is_not_finite_without_printing_it() {
    /// The root of a sum of squares has no derivative where they all vanish.
    struct Speed;
    impl ScalarFunction for Speed {
        fn of<S: Scalar<Coefficient = S>>(&self, x: &[S]) -> S {
            (x[0] * x[0] + x[1] * x[1]).sqrt()
        }
    }
    let check = check_gradient(&Speed, &[0.0, 0.0], Step::default(), 1e-6);
    assert!(!check.passed());
    let text = check.to_string();
    assert!(text.contains("is not finite") && !text.contains("NaN") && !text.contains("inf,"), "{text}");
}

#[test]
fn a_function_without_variables_or_results_has_an_empty_jacobian() {
    /// Four constants.
    struct Constants(usize);
    impl VectorFunction for Constants {
        fn outputs(&self) -> usize {
            self.0
        }
        fn eval<S: Scalar<Coefficient = S>>(&self, _: &[S], y: &mut [S]) {
            y.fill(S::from_f64(4.0));
        }
    }
    let (y, slope) = jacobian(&Constants(2), &[]);
    assert_eq!((y, slope.shape()), (vec![4.0, 4.0], (2, 0)));
    assert_eq!(jacobian(&Constants(0), &[1.0]).1.shape(), (0, 1));
    assert_eq!(
        check_gradient(&Constants(0), &[1.0], Step::default(), 1e-6),
        GradientCheck { worst: None, tolerance: 1e-6 }
    );
}

#[test]
fn the_jacobian_of_a_linear_function_is_its_matrix() {
    /// `y = A x`.
    struct Linear(DMatrix<f64>);
    impl VectorFunction for Linear {
        fn outputs(&self) -> usize {
            self.0.nrows()
        }
        fn eval<S: Scalar<Coefficient = S>>(&self, x: &[S], y: &mut [S]) {
            for (i, yi) in y.iter_mut().enumerate() {
                for (j, &xj) in x.iter().enumerate() {
                    *yi += xj * self.0[(i, j)];
                }
            }
        }
    }
    let a = DMatrix::from_fn(4, 19, |i, j| (3 * i + j) as f64 - 7.5);
    assert_eq!(jacobian(&Linear(a.clone()), &[0.5; 19]).1, a);
}

#[test]
fn the_hessian_of_rosenbrocks_valley_is_the_published_one() {
    /// `(1 - x)^2 + 100 (y - x^2)^2`, whose Hessian at (1, 1) is [[802, -400], [-400, 200]].
    struct Rosenbrock;
    impl ScalarFunction for Rosenbrock {
        fn of<S: Scalar<Coefficient = S>>(&self, x: &[S]) -> S {
            (x[0] - 1.0).squared() + (x[1] - x[0] * x[0]).squared() * 100.0
        }
    }
    let (value, slope, curvature) = hessian(&Rosenbrock, &[1.0, 1.0]);
    assert_eq!((value, slope), (0.0, DVector::zeros(2)));
    assert_eq!(curvature, DMatrix::from_row_slice(2, 2, &[802.0, -400.0, -400.0, 200.0]));
    let by_hand: Dual<f64, 2> = Rosenbrock.of(&[Dual::variable(-1.2, 0), Dual::variable(1.0, 1)]);
    assert!(functions::close(by_hand.eps[0], -215.6, 1e-14) && functions::close(by_hand.eps[1], -88.0, 1e-14));
}
