//! Lanes against `f64`, lane by lane: bit for bit for the arithmetic, within stated units in the last place for the rest.
//! Derivatives over lanes are tested here too; derivatives of a single number in `oracle.rs`.

mod functions;

use functions::Function;
use proptest::prelude::*;
use trimtab_ad::{Dual, Lanes, Scalar};

/// How many representable numbers lie between `a` and `b`.
fn ulps(a: f64, b: f64) -> u64 {
    let ordered = |x: f64| {
        let bits = x.to_bits() as i64;
        if bits < 0 { i64::MIN - bits } else { bits }
    };
    ordered(a).abs_diff(ordered(b))
}

/// Lanes with one number and seven others that must not change its result.
fn among_others(x: f64, others: [f64; 7]) -> Lanes {
    Lanes::from_fn(|lane| if lane == 3 { x } else { others[lane.min(6)] })
}

/// Any double: zeros of both signs, subnormals, infinities and NaN included.
fn any_double() -> impl Strategy<Value = f64> {
    any::<u64>().prop_map(f64::from_bits)
}

fn same(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan())
}

proptest! {
    #![proptest_config(functions::config())]

    #[test]
    fn arithmetic_over_lanes_has_the_bits_of_f64(x in any_double(), y in any_double(), others in any::<[f64; 7]>()) {
        let (a, b) = (among_others(x, others), among_others(y, others));
        let mut added = a;
        added += b;
        let mut subtracted = a;
        subtracted -= b;
        let mut multiplied = a;
        multiplied *= b;
        for (name, lanes, single) in [
            ("+", a + b, x + y),
            ("-", a - b, x - y),
            ("*", a * b, x * y),
            ("/", a / b, x / y),
            ("+=", added, x + y),
            ("-=", subtracted, x - y),
            ("*=", multiplied, x * y),
            ("neg", -a, -x),
            ("sqrt", a.sqrt(), x.sqrt()),
            ("+ f64", a + y, x + y),
            ("- f64", a - y, x - y),
            ("* f64", a * y, x * y),
            ("/ f64", a / y, x / y),
            ("abs", a.abs(), Scalar::abs(x)),
            ("max", a.max(b), Scalar::max(x, y)),
            ("min", a.min(b), Scalar::min(x, y)),
            ("nearest", a.nearest(), Scalar::nearest(x)),
        ] {
            prop_assert!(same(lanes.lane(3), single), "{name} of {x:e} and {y:e}: {} against {single}", lanes.lane(3));
        }
        prop_assert_eq!(a.less(b).lane(3), x < y);
        let chosen = if x < y { x } else { y };
        prop_assert!(same(Lanes::select(a.less(b), a, b).lane(3), chosen));
    }

    #[test]
    fn exponential_is_within_2_ulps(x in -700.0..700.0) {
        let (ours, std) = (Lanes::from_f64(x).exp().lane(2), f64::exp(x));
        prop_assert!(ulps(ours, std) <= 2, "exp({x:e}) is {} ulps off", ulps(ours, std));
    }

    #[test]
    fn logarithm_is_within_2_ulps(exponent in -690.0..690.0) {
        let x = f64::exp(exponent);
        let (ours, std) = (Lanes::from_f64(x).ln().lane(2), f64::ln(x));
        prop_assert!(ulps(ours, std) <= 2, "ln({x:e}) is {} ulps off", ulps(ours, std));
    }

    #[test]
    fn logarithm_near_one_is_within_2_ulps(x in 0.5..2.0) {
        let (ours, std) = (Lanes::from_f64(x).ln().lane(2), f64::ln(x));
        prop_assert!(ulps(ours, std) <= 2, "ln({x:e}) is {} ulps off", ulps(ours, std));
    }

    #[test]
    fn hyperbolic_tangent_is_within_4_ulps(x in -25.0..25.0, decade in -12..1) {
        let x = x * 10f64.powi(decade);
        let (ours, std) = (Lanes::from_f64(x).tanh().lane(2), f64::tanh(x));
        prop_assert!(ulps(ours, std) <= 4, "tanh({x:e}) is {} ulps off", ulps(ours, std));
    }

    #[test]
    fn arc_tangent_is_within_4_ulps(y in -9.0..9.0, x in -9.0..9.0, decade in -12..12) {
        let y = y * 10f64.powi(decade);
        let (ours, std) = (Lanes::from_f64(y).atan2(Lanes::from_f64(x)).lane(2), f64::atan2(y, x));
        prop_assert!(ulps(ours, std) <= 4, "atan2({y:e}, {x:e}) is {} ulps off", ulps(ours, std));
    }

    #[test]
    fn sine_and_cosine_within_a_turn_are_within_2_ulps(x in -6.3..6.3, decade in -12..1) {
        let x = x * 10f64.powi(decade);
        let (s, c) = Lanes::from_f64(x).sin_cos();
        prop_assert!(ulps(s.lane(2), x.sin()) <= 2, "sin({x:e}) is {} ulps off", ulps(s.lane(2), x.sin()));
        prop_assert!(ulps(c.lane(2), x.cos()) <= 2, "cos({x:e}) is {} ulps off", ulps(c.lane(2), x.cos()));
    }

    #[test]
    fn sine_and_cosine_of_a_heading_of_many_turns_are_within_one_epsilon(x in -1e6..1e6) {
        let (s, c) = Lanes::from_f64(x).sin_cos();
        prop_assert!((s.lane(2) - x.sin()).abs() <= f64::EPSILON);
        prop_assert!((c.lane(2) - x.cos()).abs() <= f64::EPSILON);
    }

    #[test]
    fn every_function_gives_a_lane_the_same_bits_whatever_the_other_lanes_hold(
        at in any::<[f64; 2]>(), unit in [0.0..1.0, 0.0..1.0], others in any::<[f64; 7]>(),
    ) {
        for f in Function::ALL {
            for [x, y] in [at, f.point(unit)] {
                let alone = f.of(Lanes::from_f64(x), Lanes::from_f64(y)).lane(3);
                let crowded = f.of(among_others(x, others), among_others(y, others)).lane(3);
                prop_assert!(same(alone, crowded), "{f:?} at {x:e}, {y:e}: {alone:e} alone, {crowded:e} among others");
            }
        }
    }

    #[test]
    fn every_function_over_lanes_is_that_of_f64_to_rounding(points in prop::array::uniform4([0.0..1.0, 0.0..1.0])) {
        for f in Function::ALL {
            let [x, y] = [0, 1].map(|i| Lanes::from_fn(|lane| f.point(points[lane])[i]));
            let lanes = f.of(x, y);
            for lane in 0..Lanes::LANES {
                let single = f.of(x.lane(lane), y.lane(lane));
                prop_assert!(functions::close(lanes.lane(lane), single, 1e-14), "{f:?}: {} {single}", lanes.lane(lane));
            }
        }
    }

    #[test]
    fn duals_over_lanes_are_duals_in_each_lane(points in prop::array::uniform4([0.0..1.0, 0.0..1.0])) {
        for f in Function::ALL {
            let [x, y] = [0, 1].map(|i| Lanes::from_fn(|lane| f.point(points[lane])[i]));
            let lanes = f.of(Dual::<Lanes, 2>::variable(x, 0), Dual::variable(y, 1));
            for lane in 0..Lanes::LANES {
                let single = f.of(Dual::<f64, 2>::variable(x.lane(lane), 0), Dual::variable(y.lane(lane), 1));
                let dual = lanes.lane(lane);
                prop_assert!(functions::close(dual.re, single.re, 1e-14), "{f:?}");
                for j in 0..2 {
                    prop_assert!(functions::close(dual.eps[j], single.eps[j], 1e-13), "{f:?}: {dual:?} {single:?}");
                }
            }
        }
    }
}

#[test]
fn arc_tangent_on_the_axes_and_at_infinity_is_that_of_f64() {
    let special = [-f64::INFINITY, -2.0, -0.0, 0.0, 2.0, f64::INFINITY];
    for y in special {
        for x in special {
            let lanes = Lanes::from_f64(y).atan2(Lanes::from_f64(x)).lane(0);
            assert!(ulps(lanes, Scalar::atan2(y, x)) <= 1, "atan2({y}, {x}) = {lanes}");
        }
    }
}

#[test]
fn each_lane_takes_its_own_branch() {
    let x = Lanes::from_fn(|lane| lane as f64 - 1.5);
    let mask = x.less(Lanes::zero());
    let y = Lanes::select(mask, Lanes::from_f64(-1.0), Lanes::from_f64(1.0));
    assert_eq!(y.to_array(), [-1.0, -1.0, 1.0, 1.0]);
    assert!(mask.lane(1) && !mask.lane(2));
}

#[test]
fn one_lane_that_is_not_finite_makes_the_whole_not_finite() {
    assert!(Lanes::from_fn(|lane| lane as f64).is_finite());
    assert!(!Lanes::from_fn(|lane| if lane == 3 { f64::NAN } else { 1.0 }).is_finite());
}

#[test]
fn the_sum_is_taken_in_the_order_of_the_lanes() {
    let x = [1e16, 1.0, -1e16, 1.0];
    assert_eq!(Lanes::from_fn(|lane| x[lane]).sum(), x.iter().sum::<f64>());
}
