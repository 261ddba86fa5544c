//! Validation against programs and measurements from outside: an MMG program from PyPI, and free-running model tests of MARIN.
//! The tests named `val_*` in `real.rs` and in `tests/library/trials.rs` use recordings, which are no part of the project.

use trimtab_experiments::truth::integrate::{sail, trimmed_rate};
use trimtab_experiments::truth::mmg::Mmg;
use trimtab_experiments::truth::motion::{Inputs, State};
use trimtab_experiments::truth::reference::{MARIN_OVERSHOOTS, MARIN_PORT, MARIN_STARBOARD, ZIGZAGS};
use trimtab_experiments::truth::ships::{kvlcc2, kvlcc2_model};
use trimtab_experiments::truth::trial::{Approach, turning, zigzag};

/// What shipmmg 0.0.11 writes; shipmmg_kvlcc2.py beside it says how.
const SHIPMMG: &str = include_str!("shipmmg_kvlcc2.csv");

/// KVLCC2 at full scale without wake and with its centre of gravity at midship, where both programs have the same equations.
fn common() -> Mmg {
    let mut ship = kvlcc2();
    ship.particulars.xg = 0.0;
    (ship.propeller.wake, ship.wake_c1) = (0.0, 0.0);
    ship
}

/// The rudder angle \[rad\] at a time \[s\], as the script gives it to shipmmg.
fn rudder(case: &str, t: f64) -> f64 {
    let over = 35f64.to_radians() * (1.0 - (-(t / 10.0) * (t / 10.0)).exp());
    match case {
        "common turn starboard" => over,
        "common turn port" => -over,
        _ => 20f64.to_radians() * (std::f64::consts::TAU * t / 300.0).sin(),
    }
}

#[test]
fn val_shipmmg_simulates_the_same_tracks_of_kvlcc2() {
    let ship = common();
    let inputs = |case: &str, t: f64| Inputs { n: 1.4, delta: rudder(case, t) };
    let (mut largest, mut rows) = ([0.0_f64; 6], 0);
    let (mut state, mut steps) = (State::default(), 0);
    for line in SHIPMMG.lines().skip(2) {
        let cells: Vec<&str> = line.split(',').collect();
        let numbers: Vec<f64> = cells[1..].iter().map(|c| c.parse().unwrap()).collect();
        let (case, t) = (cells[0], numbers[0]);
        if t == 0.0 {
            (state, steps) = (State { u: 7.97, ..State::default() }, 0);
        }
        while f64::from(steps) * 0.1 < t - 0.05 {
            let (from, to) = (f64::from(steps) * 0.1, f64::from(steps + 1) * 0.1);
            state = sail(&ship, &state, [&inputs(case, from), &inputs(case, to)], 0.1, 0.1);
            steps += 1;
        }
        assert!((numbers[7] - rudder(case, t)).abs() < 1e-6, "{line}: another rudder");
        for ((largest, found), expected) in largest.iter_mut().zip(state.to_array()).zip(&numbers[1..7]) {
            *largest = largest.max((found - expected).abs());
        }
        rows += 1;
    }
    println!("largest differences in {rows} states: {largest:?} (m, m, rad, m/s, m/s, rad/s)");
    assert_eq!(rows, 138);
    // Over 900 s and about 4 km.
    let limits = [0.05, 0.05, 1e-5, 1e-5, 1e-5, 1e-7];
    for (found, limit) in largest.iter().zip(limits) {
        assert!(*found < limit, "{largest:?} against {limits:?}");
    }
}

/// The 7 m model of KVLCC2 as MARIN tested it: 7.97 m/s at full scale.
fn tested() -> (Mmg, Approach) {
    let ship = kvlcc2_model();
    let time = (7.0_f64 / 320.0).sqrt();
    let (speed, n) = (1.179, trimmed_rate(&ship, 1.179, 20.0));
    (ship, Approach { speed, n, rudder_rate: 1.76_f64.to_radians() / time, step: 0.05 * time })
}

#[test]
fn val_turning_circles_of_kvlcc2_by_published_mmg_parameters_are_near_the_model_tests_of_marin() {
    let (ship, approach) = tested();
    let angle = 35f64.to_radians();
    let measures = |side: f64| turning(&ship, &approach, side * angle).unwrap().measures();
    let (starboard, port) = (measures(1.0), measures(-1.0));
    for (i, (name, tested)) in MARIN_STARBOARD.iter().enumerate() {
        let Some(tested) = tested else { continue };
        let error = starboard[i] / tested - 1.0;
        println!("starboard {name}: {:.3}, tested {tested}, {:+.1} %", starboard[i], 100.0 * error);
        assert!(error.abs() < 0.08, "starboard {name}: {error:+.3}");
    }
    for (i, tested) in MARIN_PORT {
        let error = port[i] / tested - 1.0;
        println!("port {}: {:.3}, tested {tested}, {:+.1} %", MARIN_STARBOARD[i].0, port[i], 100.0 * error);
        assert!(error.abs() < 0.08, "port {}: {error:+.3}", MARIN_STARBOARD[i].0);
    }
}

#[test]
fn val_zigzags_of_kvlcc2_by_published_mmg_parameters_are_near_the_model_tests_of_marin() {
    let (ship, approach) = tested();
    for (order, tested) in ZIGZAGS.into_iter().zip(MARIN_OVERSHOOTS) {
        let found = zigzag(&ship, &approach, order.to_radians()).unwrap().map(f64::to_degrees);
        println!("{order:+.0}: overshoots {found:.1?} deg, tested {tested:?}");
        // The method is known to give too small a second overshoot in a zigzag 10/10 of this hull, which is unstable in yaw.
        let limits = if order.abs() < 15.0 { [3.5, 8.0] } else { [3.5, 3.5] };
        for i in 0..2 {
            assert!(
                (found[i] - tested[i]).abs() < limits[i],
                "{order:+.0}, overshoot {}: {found:?}, {tested:?}",
                i + 1
            );
        }
    }
}
