//! A reference simulation of KVLCC2's trials, 7 m model and full scale: the same equations by RK4 at 0.5 s full scale.
//! It has numbers only; the trials themselves are simulated in `trial`.

// An advance of 3.142 ship lengths is not pi.
#![allow(clippy::approx_constant)]

use super::integrate::trimmed_rate;
use super::mmg::Mmg;
use super::ships::{kvlcc2, kvlcc2_model};
use super::trial::Approach;

/// Zigzags: rudder and heading \[deg\], sign of the first execute.
pub const ZIGZAGS: [f64; 4] = [10.0, -10.0, 20.0, -20.0];

/// Free-running model tests of MARIN for SIMMAN 2008, in the order of [`ZIGZAGS`] \[deg\].
pub const MARIN_OVERSHOOTS: [[f64; 2]; 4] = [[8.2, 21.9], [9.5, 15.0], [13.7, 14.9], [15.1, 13.3]];
/// Measures of the 35 deg turn to starboard, in the order of [`super::trial::Turning::measures`], with the model tests where there are any;
/// advance and tactical diameter are read from the recorded tests, from the moment the rudder moves.
pub const MARIN_STARBOARD: [(&str, Option<f64>); 7] = [
    ("advance [L]", Some(3.10)),
    ("transfer [L]", None),
    ("tactical diameter [L]", Some(3.33)),
    ("steady diameter [L]", None),
    ("steady U/U0", Some(0.375)),
    ("steady drift [deg]", Some(19.0)),
    ("steady r L/U", None),
];
/// Advance and tactical diameter \[L\] of the model tests to port, and their places in these measures.
pub const MARIN_PORT: [(usize, f64); 2] = [(0, 3.02), (2, 3.07)];

/// A scale of the ship and the results of the reference simulation.
pub struct Reference {
    /// `7 m model`
    pub title: &'static str,
    /// The ship.
    pub ship: Mmg,
    /// Approach speed \[m/s\].
    pub speed: f64,
    /// Propeller rate of the approach \[rps\].
    pub rate: f64,
    /// The turn at 35 deg to starboard, as [`super::trial::Turning::measures`].
    pub starboard: [f64; 7],
    /// The turn to port: advance and tactical diameter \[L\].
    pub port: [f64; 2],
    /// First two overshoots \[deg\], in the order of [`ZIGZAGS`].
    pub overshoots: [[f64; 2]; 4],
}

impl Reference {
    /// The approach with a step in seconds of the full-scale ship.
    pub fn approach(&self, step: f64) -> Approach {
        let time = (self.ship.particulars.length / 320.0).sqrt();
        let n = trimmed_rate(&self.ship, self.speed, 20.0);
        Approach { speed: self.speed, n, rudder_rate: 1.76_f64.to_radians() / time, step: step * time }
    }
}

/// Both scales.
pub fn references() -> [Reference; 2] {
    [
        Reference {
            title: "7 m model",
            ship: kvlcc2_model(),
            speed: 1.179,
            rate: 11.834,
            starboard: [3.132, 1.327, 3.113, 2.315, 0.381, 19.1, 0.864],
            port: [3.142, 3.099],
            overshoots: [[5.5, 15.0], [7.8, 9.7], [12.1, 17.5], [15.8, 13.1]],
        },
        Reference {
            title: "full scale, 320 m",
            ship: kvlcc2(),
            speed: 7.97,
            rate: 1.7785,
            starboard: [3.029, 1.272, 3.006, 2.247, 0.377, 19.4, 0.890],
            port: [3.053, 3.015],
            overshoots: [[5.5, 14.2], [7.6, 9.3], [12.0, 16.9], [15.6, 12.9]],
        },
    ]
}
