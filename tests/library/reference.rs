//! The model against numbers computed independently for the reconstructed ships A and B.
//! Laws of every term are in `laws.rs` and `catalogue.rs`.

// 6.28 is a speed in m/s, not 2 pi.
#![allow(clippy::approx_constant)]

use std::path::Path;
use trimtab::model::Model;
use trimtab::physics::Form;
use trimtab::ship::Ship;
use trimtab::ship::state::Inputs;
use trimtab::simulate::{Integration, Method, Scenario, simulate};

fn ship(letter: &str) -> Ship {
    let path = format!("{}/experiments/ships/{letter}.toml", env!("CARGO_MANIFEST_DIR"));
    Ship::read(Path::new(&path)).unwrap()
}

fn assert_close(found: f64, expected: f64, relative: f64, what: &str) {
    assert!((found - expected).abs() <= relative * expected.abs(), "{what}: {found:.4e}, expected {expected:.4e}");
}

#[test]
fn estimated_coefficients_match_the_reference_table() {
    let names = [
        "Xudot", "Yvdot", "Yrdot", "Nvdot", "Nrdot", "Yv", "Yr", "Nv", "Nr", "Xvr", "Yvv", "Yvr", "Yrr", "Nrr", "Nrrv",
        "Nvvr",
    ];
    let a = [
        -1.546e5, -2.948e6, -1.484e7, -8.807e6, -1.187e9, -5.323e4, 9.843e5, -1.493e6, -5.877e7, -9.875e5, -1.058e5,
        -3.914e6, -5.261e7, -2.997e9, 3.846e9, -1.165e8,
    ];
    let b = [
        -7.312e5, -1.237e7, -1.093e8, -8.636e7, -9.943e9, -1.516e5, 3.815e6, -6.780e6, -3.450e8, -3.711e6, -2.949e5,
        -1.352e7, -3.079e8, -2.012e10, 4.585e10, -5.653e8,
    ];
    for (letter, table) in [("a", a), ("b", b)] {
        for (name, expected) in names.iter().zip(table) {
            assert_close(ship(letter).coefficient(name), expected, 2e-3, &format!("ship {letter} {name}"));
        }
    }
}

/// Tactical diameter over L, steady yaw rate and steady speed of a 35 degree starboard turn.
fn turn(letter: &str, p: &[f64; 11], rps: f64, u: f64) -> (f64, f64, f64) {
    let ship = ship(letter);
    let l = ship.hull.lpp;
    let mut model = Model::new(ship, "HD", Form::Paper, &[]).unwrap();
    model.set_eleven(p);
    let rudder = 35f64.to_radians();
    let inputs: Vec<_> =
        (0..1200).map(|k| Inputs::actuators(k as f64, rps, rudder * (k as f64 / 14.0).min(1.0))).collect();
    let scenario = Scenario { dt: 1.0, inputs, initial: [0.0, 0.0, 0.0, u, 0.0, 0.0] };
    let t = simulate(&model, &model.values(), Integration { method: Method::Rk4, substeps: 2 }, &scenario);
    assert!(t.diverged_at.is_none());
    let i = t.states.iter().position(|s| s[2] > std::f64::consts::PI).unwrap();
    let last = t.states[t.states.len() - 1];
    (t.states[i][1] / l, last[5], last[3].hypot(last[4]))
}

#[test]
fn published_parameters_give_the_turn_of_an_independent_simulation() {
    let star = [-0.017, 34187.0, -12568.0, 1594.0, -0.039, 3.193, 0.205, -4.882, 0.048, 0.0746, 1.370];
    let tilde = [0.0, 10500.0, -1900.0, 346.0, -0.012, 0.864, 0.182, -1.191, 0.005, -0.123, 0.779];
    let (diameter, rate, _) = turn("a", &star, 200.0 / 60.0, 6.28);
    println!("p*: TD {diameter:.2} L, r {rate:.4} rad/s");
    assert!((3.2..4.1).contains(&diameter), "tactical diameter {diameter}");
    assert!((0.021..0.029).contains(&rate), "yaw rate {rate}");
    let (diameter, _, _) = turn("a", &tilde, 200.0 / 60.0, 6.98);
    println!("p~: TD {diameter:.2} L");
    assert!((6.5..9.0).contains(&diameter), "tactical diameter {diameter}");
}
