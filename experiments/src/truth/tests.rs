//! Laws that every truth simulator keeps: finite and continuous forces, the order of the integrator, and the reference trials.
//! Laws of one simulator are tested in its own file.

use super::integrate::{sail, trimmed_rate};
use super::motion::{Contributions, Inputs, State};
use super::reference::{Reference, ZIGZAGS, references};
use super::ships::{kvlcc2, ship_a, ship_b};
use super::simulator::Truth;
use super::trial::{turning, zigzag};

fn truths() -> Vec<Box<dyn Truth>> {
    vec![Box::new(ship_a()), Box::new(ship_b())]
}

#[test]
fn force_is_finite_in_all_four_quadrants_and_at_rest() {
    let grid = [-6.0, -1.0, -1e-3, -1e-9, 0.0, 1e-9, 1e-3, 1.0, 6.0];
    let kvlcc2: Box<dyn Truth> = Box::new(kvlcc2());
    for truth in truths().into_iter().chain([kvlcc2]) {
        for u in grid {
            for v in grid {
                for r in grid.map(|g| g * 0.01) {
                    for n in grid {
                        for delta in [-0.6, 0.0, 0.6] {
                            let f = truth.force(u, v, r, n, delta).total();
                            assert!(f.x.is_finite() && f.y.is_finite() && f.n.is_finite(), "{u} {v} {r} {n} {delta}");
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn force_is_continuous_through_zero_speed_and_zero_rate() {
    let e = 1e-7;
    for truth in truths() {
        let jump = |a: Contributions, b: Contributions| {
            let (a, b) = (a.total(), b.total());
            let l = truth.particulars().length;
            (a.x - b.x).abs().max((a.y - b.y).abs()).max((a.n - b.n).abs() / l)
        };
        for v in [-1.0, 0.3] {
            for r in [-0.02, 0.01] {
                for n in [-2.0, -0.4, 0.4, 2.0] {
                    let j = jump(truth.force(e, v, r, n, 0.4), truth.force(-e, v, r, n, 0.4));
                    assert!(j < 50.0, "across u = 0: {j} N at v {v} r {r} n {n}");
                }
                for u in [-3.0, 0.5, 5.0] {
                    let j = jump(truth.force(u, v, r, e, 0.4), truth.force(u, v, r, -e, 0.4));
                    assert!(j < 50.0, "across n = 0: {j} N at u {u} v {v} r {r}");
                }
            }
        }
    }
}

#[test]
fn runge_kutta_converges_with_fourth_order() {
    // A turn that has settled on one side: no kink of the straightening coefficient or of |v| is crossed.
    for truth in truths() {
        let start = State { u: 4.0, v: -0.8, r: 0.012, ..State::default() };
        let (from, to) = (Inputs { n: 1.6, delta: 0.3 }, Inputs { n: 2.0, delta: 0.4 });
        let run = |h: f64| sail(truth.as_ref(), &start, [&from, &to], 32.0, h).to_array();
        let exact = run(0.05);
        let error = |h: f64| run(h).iter().zip(exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let order = (error(4.0) / error(2.0)).log2();
        assert!((3.5..4.8).contains(&order), "order {order}");
    }
}

#[test]
fn the_trials_of_kvlcc2_agree_with_the_reference_simulation() {
    let near = |found: f64, expected: f64, within: f64, what: &str| {
        assert!((found - expected).abs() <= within, "{what}: {found} instead of {expected}");
    };
    for reference in references() {
        let Reference { ship, rate, starboard, port, overshoots, .. } = &reference;
        near(trimmed_rate(ship, reference.speed, 20.0), *rate, 0.01 * rate, "trimmed n");
        // The step of the reference: it reverses the rudder up to one step late, which is worth 0.2 deg of overshoot.
        let approach = reference.approach(0.5);
        let angle = 35.0_f64.to_radians();
        let right = turning(ship, &approach, angle).expect("turns to starboard");
        let found = right.measures();
        for (i, (f, e)) in found.iter().zip(starboard).enumerate() {
            near(*f, *e, 0.01 * e, ["advance", "transfer", "TD", "steady", "U/U0", "drift", "r'"][i]);
        }
        let left = turning(ship, &approach, -angle).expect("turns to port");
        near(left.advance, port[0], 0.01 * port[0], "port advance");
        near(left.tactical_diameter, port[1], 0.01 * port[1], "port TD");
        for (order, [first, second]) in ZIGZAGS.into_iter().zip(overshoots) {
            let [a, b] = zigzag(ship, &approach, order.to_radians()).expect("answers the helm");
            near(a.to_degrees(), *first, 0.1, &format!("OSA1 of {order}"));
            near(b.to_degrees(), *second, 0.1, &format!("OSA2 of {order}"));
        }
    }
}

/// The 7 m model of KVLCC2 with the library's form `mmg` and the published primes.
fn fitted_form() -> trimtab::model::Model {
    let file = |name: &str| std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("ships").join(name);
    let ship = trimtab::ship::Ship::read(&file("kvlcc2_7m.toml")).unwrap();
    trimtab::model::Model::read(&file("kvlcc2_7m_mmg.toml"), ship).unwrap()
}

#[test]
fn the_library_in_form_mmg_sails_the_trials_of_kvlcc2_as_this_simulator_does() {
    use trimtab::evaluate::maneuver::{ManeuverSettings, Side, turning_trial, zigzag_trial};
    let reference = &references()[0];
    let approach = reference.approach(0.1);
    let model = fitted_form();
    let theta = model.values();
    let settings = ManeuverSettings {
        speed: Some(approach.speed),
        rudder_rate_deg_s: Some(approach.rudder_rate.to_degrees()),
        step: Some(approach.step),
        ..ManeuverSettings::default()
    };
    let ours = settings.approach(&model, &theta).unwrap();
    assert!((ours.n / approach.n - 1.0).abs() < 5e-3, "{} {}", ours.n, approach.n);
    let length = reference.ship.particulars.length;
    for (side, sign) in [(Side::Starboard, 1.0), (Side::Port, -1.0)] {
        let angle = 35.0_f64.to_radians();
        let truth = turning(&reference.ship, &approach, sign * angle).unwrap();
        let m = turning_trial(&model, &theta, &ours, side, angle).measures;
        let steady = m.steady.unwrap();
        let found = [m.advance.unwrap(), m.transfer.unwrap(), m.tactical_diameter.unwrap(), steady.diameter];
        for (found, expected) in found.iter().map(|x| x / length).zip(truth.measures()) {
            assert!((found / expected - 1.0).abs() < 5e-3, "{side:?}: {found} instead of {expected}");
        }
        for degrees in [10.0_f64, 20.0] {
            let angle = degrees.to_radians();
            let truth = zigzag(&reference.ship, &approach, sign * angle).unwrap();
            let m = zigzag_trial(&model, &theta, &ours, side, [angle; 2]).measures;
            for (found, expected) in m.overshoots.iter().zip(truth) {
                assert!((found / expected - 1.0).abs() < 5e-3, "{side:?} {degrees} deg: {found} instead of {expected}");
            }
        }
    }
}
