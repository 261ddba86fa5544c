//! The noise that planned sensors and an unknown force are taken to have, as the diagnosis models it.
//! Nothing is estimated: there are no recordings yet.

use super::settings::{Sensor, SensorSettings};
use crate::likelihood::noise::fit::guess;
use crate::likelihood::noise::{GROUP_OF, Noise, SensorNoise};
use crate::likelihood::settings::{COLOURED_GUESS, COLOURED_PERIODS};
use crate::model::Model;
use crate::recording::Run;
use serde::Serialize;

/// Ships below this length are models in a basin \[m\].
const MODEL_LENGTH: f64 = 20.0;

/// Standard deviations that a plan is made with, SI units.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Level {
    /// Position \[m\].
    pub position: f64,
    /// Heading \[rad\].
    pub heading: f64,
    /// Speed \[m/s\].
    pub speed: f64,
    /// Yaw rate \[rad/s\].
    pub yaw_rate: f64,
    /// Sensors that are not on board.
    pub without: Vec<Sensor>,
    /// Sample period \[s\].
    pub step: f64,
    /// Unknown force in X, Y \[N\] and N \[N m\].
    pub force: [f64; 3],
    /// Its correlation time \[s\].
    pub force_time: f64,
}

impl SensorSettings {
    /// White noise of position \[m\], heading \[rad\], speed \[m/s\] and yaw rate \[rad/s\] of a ship of this length \[m\].
    fn white(&self, length: f64) -> [f64; 4] {
        let [position, heading, speed, rate] =
            if length < MODEL_LENGTH { [0.005, 0.05, 0.01, 0.05] } else { [0.5, 0.1, 0.05, 0.02] };
        [
            self.position.unwrap_or(position),
            self.heading_deg.unwrap_or(heading).to_radians(),
            self.speed.unwrap_or(speed),
            self.yaw_rate_deg_s.unwrap_or(rate).to_radians(),
        ]
    }

    /// Whether a channel of x, y, psi, u, v, r is measured.
    pub(super) fn measures(&self, channel: usize) -> bool {
        let group = [Sensor::Position, Sensor::Heading, Sensor::Speed, Sensor::YawRate][GROUP_OF[channel]];
        !self.without.contains(&group)
    }

    /// The noise: the white part of each sensor as planned, its coloured part and the unknown force as a diagnosis first guesses them.
    pub(super) fn noise(&self, model: &Model, runs: &[Run], step: f64) -> (Noise, Level) {
        let white = self.white(model.ship.hull.lpp);
        let sensor =
            |white: f64| SensorNoise { white, coloured: COLOURED_GUESS * white, time: COLOURED_PERIODS * step };
        let noise = Noise { sensors: white.map(sensor), ..guess(runs, model) };
        let [position, heading, speed, yaw_rate] = white;
        let (force, force_time) = (noise.force, noise.force_time);
        let without = self.without.clone();
        (noise, Level { position, heading, speed, yaw_rate, without, step, force, force_time })
    }
}
