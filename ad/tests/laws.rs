//! The rules of calculus that duals must keep, and the shapes in `smooth`, with derivatives computed by hand.
//! The comparison with another implementation is in `oracle.rs`.

mod functions;

use functions::close;
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};
use trimtab_ad::{Dual, Scalar, smooth};

type D = Dual<f64, 1>;
type DD = Dual<D, 1>;

fn at(x: f64) -> D {
    D::variable(x, 0)
}

/// Value, first and second derivative of a function of one variable.
fn derivatives(f: impl Fn(DD) -> DD, x: f64) -> [f64; 3] {
    let y = f(DD::variable(at(x), 0));
    [y.re.re, y.eps[0].re, y.eps[0].eps[0]]
}

fn any_dual() -> impl Strategy<Value = D> {
    (-5.0..5.0, -5.0..5.0).prop_map(|(re, eps)| D { re, eps: [eps] })
}

fn agree(a: D, b: D) -> bool {
    close(a.re, b.re, 1e-12) && close(a.eps[0], b.eps[0], 1e-12)
}

proptest! {
    #![proptest_config(functions::config())]

    #[test]
    fn the_product_rule_holds(a in any_dual(), b in any_dual()) {
        prop_assert_eq!((a * b).eps[0], a.eps[0] * b.re + b.eps[0] * a.re);
    }

    #[test]
    fn the_quotient_rule_holds(a in any_dual(), b in any_dual()) {
        prop_assume!(b.re.abs() > 0.1);
        let slope = (a.eps[0] * b.re - a.re * b.eps[0]) / (b.re * b.re);
        prop_assert!(close((a / b).eps[0], slope, 1e-12));
        prop_assert!(agree(a / b * b, a));
    }

    #[test]
    fn sums_and_products_commute_associate_and_distribute(a in any_dual(), b in any_dual(), c in any_dual()) {
        prop_assert_eq!(a + b, b + a);
        prop_assert_eq!(a * b, b * a);
        prop_assert!(agree((a + b) + c, a + (b + c)));
        prop_assert!(agree((a * b) * c, a * (b * c)));
        prop_assert!(agree(a * (b + c), a * b + a * c));
        prop_assert_eq!(a - b, -(b - a));
    }

    #[test]
    fn a_plain_number_acts_as_a_constant(a in any_dual(), x in 0.1..5.0f64) {
        let constant = D::constant(x);
        prop_assert_eq!(a + x, a + constant);
        prop_assert_eq!(a - x, a - constant);
        prop_assert_eq!(a * x, a * constant);
        prop_assert!(agree(a / x, a / constant));
    }

    #[test]
    fn identities_between_functions_hold_with_their_derivatives(a in any_dual()) {
        let (s, c) = a.sin_cos();
        prop_assert!(agree(s * s + c * c, D::one()));
        prop_assert!(agree(a.exp().ln(), a));
        prop_assert!(agree((a * a + 1.0).sqrt().squared(), a * a + 1.0));
        prop_assert!(agree(a.tanh(), ((a * 2.0).exp() - 1.0) / ((a * 2.0).exp() + 1.0)));
        prop_assert!(agree(s.atan2(c).sin(), s));
    }

    #[test]
    fn the_arc_tangent_gives_back_angle_and_its_rate_whatever_the_radius(angle in any_dual(), radius in 0.01..100.0f64) {
        prop_assume!(angle.re.abs() < 3.1);
        let (s, c) = angle.sin_cos();
        prop_assert!(agree((s * radius).atan2(c * radius), angle));
    }

    #[test]
    fn select_takes_the_derivative_of_the_chosen_arm(a in any_dual(), b in any_dual()) {
        let chosen = D::select(a.less(b), a, b);
        prop_assert_eq!(chosen, if a.re < b.re { a } else { b });
        prop_assert_eq!(a.min(b).re, a.re.min(b.re));
        prop_assert_eq!(a.max(b).re, a.re.max(b.re));
    }

    #[test]
    fn an_arm_that_is_not_taken_leaves_no_trace(a in any_dual(), poison in prop::sample::select(vec![f64::NAN, f64::INFINITY])) {
        let never = D { re: poison, eps: [poison] };
        prop_assert_eq!(D::select(true, a, never), a);
        prop_assert_eq!(D::select(false, never, a), a);
    }

    #[test]
    fn a_clamp_has_slope_1_inside_and_0_outside(x in -3.0..3.0) {
        let y = at(x).clamp(-1.0, 2.0);
        prop_assert_eq!(y.re, x.clamp(-1.0, 2.0));
        prop_assert_eq!(y.eps[0], if (-1.0..=2.0).contains(&x) { 1.0 } else { 0.0 });
    }

    #[test]
    fn a_smooth_absolute_value_lies_just_above_the_sharp_one(x in -10.0..10.0, eps in 1e-6..1.0) {
        let y = smooth::smooth_abs(at(x), eps);
        prop_assert!(y.re >= x.abs() && y.re <= x.abs() + eps);
        prop_assert!(close(y.eps[0], x / y.re, 1e-14));
        prop_assert_eq!(y.re, smooth::smooth_abs(-x, eps));
    }

    #[test]
    fn a_smooth_step_rises_from_0_to_1_and_is_odd_about_its_middle(x in -1.0..2.0) {
        let [y, slope, _] = derivatives(smooth::smooth_step, x);
        prop_assert!((0.0..=1.0 + f64::EPSILON).contains(&y) && slope >= 0.0);
        prop_assert!(close(y + smooth::smooth_step(1.0 - x), 1.0, 1e-14));
    }

    #[test]
    fn a_blend_is_one_arm_below_the_other_above_and_between_them_in_between(x in -3.0..3.0, a in any_dual(), b in any_dual()) {
        let (a_there, b_there) = (smooth::blend(D::constant(-1.0), -1.0, 2.0, a, b), smooth::blend(D::constant(2.0), -1.0, 2.0, a, b));
        prop_assert_eq!(a_there, a);
        prop_assert_eq!(b_there, b);
        let y = smooth::blend(x, -1.0, 2.0, a.re, b.re);
        let slack = 1e-14 * (a.re.abs() + b.re.abs());
        prop_assert!(y >= a.re.min(b.re) - slack && y <= a.re.max(b.re) + slack);
    }

    #[test]
    fn softplus_has_the_logistic_function_as_slope(x in -30.0..30.0) {
        let [y, slope, curvature] = derivatives(smooth::softplus, x);
        let logistic = 1.0 / (1.0 + (-x).exp());
        prop_assert!((slope - logistic).abs() <= 1e-11 * logistic, "{slope} {logistic}");
        prop_assert!((curvature - logistic * (1.0 - logistic)).abs() <= 1e-11 * logistic);
        let exact = x.max(0.0) + (-x.abs()).exp().ln_1p();
        prop_assert!((y - exact).abs() <= 1e-11 * exact, "{y} {exact}");
    }

    #[test]
    fn a_wrapped_angle_is_the_same_direction_in_the_half_open_turn(x in -1000.0..1000.0) {
        let [y, slope, curvature] = derivatives(smooth::wrap_angle, x);
        prop_assert!(y > -PI - 1e-12 && y <= PI + 1e-12);
        prop_assert!((y.sin() - x.sin()).abs() < 1e-12 && (y.cos() - x.cos()).abs() < 1e-12);
        prop_assert_eq!([slope, curvature], [1.0, 0.0]);
    }
}

#[test]
fn a_smooth_step_leaves_its_ends_with_zero_slope_and_curvature() {
    for (end, value) in [(0.0, 0.0), (1.0, 1.0), (-5.0, 0.0), (7.0, 1.0)] {
        assert_eq!(derivatives(smooth::smooth_step, end), [value, 0.0, 0.0]);
    }
    assert_eq!(derivatives(smooth::smooth_step, 0.5), [0.5, 1.875, 0.0]);
}

#[test]
fn half_a_turn_wraps_to_plus_pi_from_either_side() {
    assert_eq!(smooth::wrap_angle(PI), PI);
    assert_eq!(smooth::wrap_angle(-PI), PI);
    assert_eq!(smooth::wrap_angle(PI.next_up()), PI.next_up() - TAU);
    assert_eq!(smooth::wrap_angle((-PI).next_up()), (-PI).next_up());
    assert_eq!(smooth::wrap_angle(0.0), 0.0);
}

#[test]
fn the_nearest_integer_of_a_tie_is_the_lower() {
    for (x, nearest) in [(0.5, 0.0), (-0.5, -1.0), (1.5, 1.0), (2.5, 2.0), (-1.5, -2.0), (0.499, 0.0), (0.501, 1.0)] {
        assert_eq!(Scalar::nearest(x), nearest, "{x}");
        assert_eq!(at(x).nearest(), D::constant(nearest));
    }
}

#[test]
fn softplus_neither_overflows_nor_vanishes_at_large_arguments() {
    assert_eq!(derivatives(smooth::softplus, 800.0), [800.0, 1.0, 0.0]);
    assert!(derivatives(smooth::softplus, -800.0).iter().all(|&d| d == 0.0));
    let [value, slope, _] = derivatives(smooth::softplus, -100.0);
    assert!(close(value / (-100f64).exp(), 1.0, 1e-14) && close(slope / (-100f64).exp(), 1.0, 1e-14));
    assert_eq!(derivatives(smooth::softplus, 0.0)[1..], [0.5, 0.25]);
}
