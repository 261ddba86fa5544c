//! Natural sizes of a ship's motion, from which terms take the scale of their parameters.
//! They are Froude-scaled, so that a 3 m model and a 300 m tanker each get relevant sizes; nothing here is physics.

use crate::ship::Ship;

pub use crate::units::GRAVITY;

/// Speed at Froude number 1, sqrt(g L) \[m/s\]: 28.9 m/s for an 85 m ship.
pub fn speed(ship: &Ship) -> f64 {
    (GRAVITY * ship.hull.lpp).sqrt()
}

/// Time that goes with it, sqrt(L/g) \[s\]: 2.9 s for an 85 m ship.
pub fn time(ship: &Ship) -> f64 {
    (ship.hull.lpp / GRAVITY).sqrt()
}

/// A relevant force \[N\]: a tenth of the resistance at Froude number 0.2, 12 kN for an 85 m ship.
pub fn force(ship: &Ship) -> f64 {
    pressure(ship) * (0.2 * speed(ship)).powi(2) * 0.002
}

/// A relevant yaw moment \[N m\]: that force at a quarter of the length.
pub fn moment(ship: &Ship) -> f64 {
    0.25 * force(ship) * ship.hull.lpp
}

/// 1/2 rho L d \[kg/m\]: what makes a hull force coefficient dimensional, times a velocity squared.
pub fn pressure(ship: &Ship) -> f64 {
    0.5 * ship.hull.water_density * ship.hull.lpp * ship.hull.draught
}
