//! The second baseline: parameters from virtual captive tests on a truth simulator, as the paper describes for its p~.
//! It uses forces under imposed motion, never a manoeuvre; `truth::captive` measures, and lift and drag are read here.
//!
//! | test | runs | gives |
//! |---|---|---|
//! | towing | hull alone, straight, 25 speeds ahead up to the ship's highest | p1, p2, p3 |
//! | propeller | rudder amidships, ahead speeds and rates, ahead and astern rotation | p0 |
//! | rudder sweep | angles at self-propulsion and overload points, without and with drift | p4 to p10 |

use super::error::PaperError;
use crate::truth::captive::{Range, Row, fit_resistance, fit_side_force, propeller_runs, rudder_sweep, towing};
use crate::truth::integrate::trimmed_rate;
use crate::truth::ships::ShipId;
use crate::truth::simulator::Truth;
use nalgebra::{DMatrix, DVector};
use trimtab::model::Model;
use trimtab::model::dynamics::Dynamics;
use trimtab::ship::state::{Inputs, State};

/// One row of a rudder sweep, read with the inflow of the model that is to use the curves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RudderPoint {
    /// Angle of attack \[rad\].
    pub attack: f64,
    /// Lift coefficient.
    pub lift: f64,
    /// Drag coefficient.
    pub drag: f64,
}

/// Angles of attack beyond this are left out of the curves, as constraint (iv) is \[rad\].
const ATTACK_LIMIT: f64 = 45.0 * std::f64::consts::PI / 180.0;

/// Highest ahead speed \[m/s\] and largest rudder angle \[deg\] of a ship's programme: those of the paper's Table 1.
fn programme(ship: ShipId) -> (f64, f64) {
    match ship {
        ShipId::A => (8.23, 35.0),
        ShipId::B => (6.17, 40.0),
    }
}

/// The model with p0 to p10 from captive tests.
///
/// # Errors
/// A programme that does not determine the parameters.
pub fn captive_baseline(ship: ShipId, model: &Model) -> Result<Model, PaperError> {
    let truth = ship.truth();
    let (fastest, _) = programme(ship);
    let undetermined = |what| PaperError::Captive { ship: ship.name(), what };
    let resistance = fit_resistance(&towing(truth.as_ref(), Range { from: 0.5, to: fastest, count: 25 }))
        .ok_or(undetermined("resistance"))?;
    let speeds = Range { from: 0.0, to: 0.75 * fastest, count: 7 };
    let top = trimmed_rate(truth.as_ref(), fastest, 6.0);
    let side_force = fit_side_force(&propeller_runs(truth.as_ref(), speeds, Range { from: -top, to: top, count: 15 }))
        .ok_or(undetermined("side force"))?;
    let points = rudder_points(model, &rudder_rows(ship, truth.as_ref()));
    let lift = polynomial(&points, 3, |p| p.lift).ok_or(undetermined("lift"))?;
    let drag = polynomial(&points, 2, |p| p.drag).ok_or(undetermined("drag"))?;
    let mut baseline = model.clone();
    baseline.name = "captive tests".into();
    let [p1, p2, p3] = resistance;
    baseline.set_eleven(&[side_force, p1, p2, p3, lift[0], lift[1], lift[2], lift[3], drag[0], drag[1], drag[2]]);
    // A parameter that is zero by symmetry comes out of the least squares as rounding.
    for parameter in baseline.parameters.iter_mut().filter(|p| p.free) {
        if parameter.value.abs() < 1e-9 * parameter.scale {
            parameter.value = 0.0;
        }
    }
    Ok(baseline)
}

/// The rudder sweeps of a ship: at a quarter, half, three quarters and all of its speed, each at the self-propulsion point and at
/// 1.5 times that rate as in a kick ahead, with drift of 0 and 10 deg to either side.
pub fn rudder_rows(ship: ShipId, truth: &dyn Truth) -> Vec<Row> {
    let (fastest, hard) = programme(ship);
    let points: Vec<(f64, f64)> = [0.25, 0.5, 0.75, 1.0]
        .iter()
        .flat_map(|share| {
            let u = share * fastest;
            let n = trimmed_rate(truth, u, 6.0);
            [(u, n), (u, 1.5 * n)]
        })
        .collect();
    let hard = f64::to_radians(hard);
    rudder_sweep(
        truth,
        &points,
        &[-10.0_f64, 0.0, 10.0].map(f64::to_radians),
        Range { from: -hard, to: hard, count: 29 },
    )
}

/// Lift and drag coefficients behind measured rudder forces, by the inflow (u_R, v_R) of `model`.
///
/// The rudder term inverted: with g = atan2(v_R, u_R), `L = -(X sin g + Y cos g)`, `D = Y sin g - X cos g`,
/// `c = 2 (L, D)/(rho A_R U_R^2)`, `a = delta - g`.
pub fn rudder_points(model: &Model, rows: &[Row]) -> Vec<RudderPoint> {
    let dynamics = Dynamics::new(model, model.values());
    let pressure = 0.5 * model.ship.hull.water_density * model.ship.rudder.area;
    let read = |row: &Row| {
        let state = State::from_array([0.0, 0.0, 0.0, row.u, row.v, row.r]);
        let inputs = Inputs::actuators(0.0, row.n, row.delta);
        let flow = dynamics.flow(&dynamics.instant(&state, &inputs));
        let (sin, cos) = flow.rudder_v.atan2(flow.rudder_u).sin_cos();
        let full = pressure * (flow.rudder_u.powi(2) + flow.rudder_v.powi(2));
        let force = row.force.rudder;
        RudderPoint {
            attack: row.delta - flow.rudder_v.atan2(flow.rudder_u),
            lift: -(force.x * sin + force.y * cos) / full,
            drag: (force.y * sin - force.x * cos) / full,
        }
    };
    rows.iter().map(read).filter(|p| p.attack.abs() <= ATTACK_LIMIT).collect()
}

/// Least-squares polynomial of the angle of attack, constant first.
fn polynomial(points: &[RudderPoint], degree: usize, value: impl Fn(&RudderPoint) -> f64) -> Option<Vec<f64>> {
    let basis = DMatrix::from_fn(points.len(), degree + 1, |i, j| points[i].attack.powi(j as i32));
    let right = DVector::from_iterator(points.len(), points.iter().map(value));
    let solution = basis.svd(true, true).solve(&right, 1e-12).ok()?;
    solution.iter().all(|c| c.is_finite()).then(|| solution.iter().copied().collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paper::case::initial_model;
    use crate::truth::motion::Force;
    use trimtab::physics::Form;
    use trimtab::terms::steering::rudder::Rudder;

    #[test]
    fn lift_and_drag_of_the_model_s_own_rudder_are_read_back_exactly() {
        for ship in [ShipId::A, ShipId::B] {
            let model = initial_model(ship, Form::Paper).unwrap();
            let theta = model.values();
            let mut rows = rudder_rows(ship, ship.truth().as_ref());
            for row in &mut rows {
                let state = State::from_array([0.0, 0.0, 0.0, row.u, row.v, row.r]);
                let inputs = Inputs::actuators(0.0, row.n, row.delta);
                let forces = Dynamics::new(&model, theta.clone()).contributions(&state, &inputs);
                let (_, rudder) = forces.iter().find(|(name, _)| *name == "rudder").unwrap();
                row.force.rudder = Force { x: rudder.x, y: rudder.y, n: rudder.n };
            }
            let points = rudder_points(&model, &rows);
            assert!(points.len() > rows.len() / 2);
            let p = model.part("rudder", &theta);
            for point in points {
                assert!((point.lift - Rudder::lift_polynomial(p, point.attack)).abs() < 1e-9);
                assert!((point.drag - Rudder::drag_polynomial(p, point.attack)).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn a_polynomial_is_recovered_from_its_own_points() {
        let at = |attack: f64| RudderPoint { attack, lift: 0.1 + 2.0 * attack - 3.0 * attack.powi(3), drag: 0.0 };
        let points: Vec<RudderPoint> = (-5..=5).map(|i| at(0.1 * f64::from(i))).collect();
        let found = polynomial(&points, 3, |p| p.lift).unwrap();
        for (found, expected) in found.iter().zip([0.1, 2.0, 0.0, -3.0]) {
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        }
    }

    #[test]
    fn captive_parameters_have_the_signs_of_a_real_ship() {
        for ship in [ShipId::A, ShipId::B] {
            let baseline = captive_baseline(ship, &initial_model(ship, Form::Paper).unwrap()).unwrap();
            let p = baseline.eleven();
            let resistance = |u: f64| p[1] * u + p[2] * u * u + p[3] * u * u * u;
            assert!([1.0, 3.0, 6.0].iter().all(|u| resistance(*u) > 0.0), "{p:?}");
            assert!(p[5] > 1.5 && p[5] < 5.0, "lift slope {}", p[5]);
            assert!(p[8] >= 0.0 && p[10] > 0.0, "drag {} {}", p[8], p[10]);
        }
    }
}
