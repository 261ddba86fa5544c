//! How far one simulated trajectory is from the measured one: mean deviations and cVDM, or that the simulation diverged.
//! It compares no models; the definitions are in the documentation of [`crate::evaluate`].

use crate::fit::objectives::cost::weights;
use crate::recording::Run;
use crate::ship::Ship;
use crate::simulate::Trajectory;
use crate::state::{STATE_NAMES, STATES};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use trimtab_ad::smooth::wrap_angle;

/// How far a simulated trajectory is from the measured one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Deviation {
    /// Mean deviation of x, y, psi, u, v, r (m, m, rad, m/s, m/s, rad/s); absent where not measured.
    #[serde(serialize_with = "by_dimension", deserialize_with = "from_dimensions")]
    pub md: [Option<f64>; STATES],
    /// cVDM \[%\].
    pub cvdm: f64,
}

/// A value for each dimension as a map by name, without the absent ones.
pub(super) fn by_dimension<T: Serialize, S: serde::Serializer>(
    values: &[Option<T>; STATES],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_map(STATE_NAMES.iter().zip(values).filter_map(|(name, value)| Some((name, value.as_ref()?))))
}

/// The values that [`by_dimension`] wrote.
fn from_dimensions<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<[Option<f64>; STATES], D::Error> {
    let by_name = BTreeMap::<String, f64>::deserialize(deserializer)?;
    Ok(STATE_NAMES.map(|name| by_name.get(name).copied()))
}

/// What a model makes of a window.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", untagged)]
pub enum Outcome {
    /// The simulation ran through.
    Simulated(Deviation),
    /// The simulation diverged.
    Diverged {
        /// Time since the start of the window \[s\].
        diverged_after: f64,
    },
}

impl Outcome {
    /// The deviation, of a simulation that ran through.
    pub fn deviation(&self) -> Option<&Deviation> {
        match self {
            Self::Simulated(deviation) => Some(deviation),
            Self::Diverged { .. } => None,
        }
    }

    /// cVDM \[%\], infinite where the simulation diverged: for ordering, not for reports.
    pub(super) fn order(&self) -> f64 {
        self.deviation().map_or(f64::INFINITY, |d| d.cvdm)
    }
}

/// The outcome of a prediction of a window; `max_yaw_rate` is r_max \[rad/s\].
pub fn outcome(window: &Run, predicted: &Trajectory, ship: &Ship, max_yaw_rate: f64) -> Outcome {
    let weights = weights(ship, window, max_yaw_rate);
    let diverged = |sample: usize| Outcome::Diverged { diverged_after: sample as f64 * window.dt };
    if let Some(sample) = predicted.diverged_at {
        return diverged(sample);
    }
    let mut sums = [0.0; STATES];
    let mut counts = [0_usize; STATES];
    for (s, m) in predicted.states.iter().zip(&window.measured).skip(1) {
        for i in 0..STATES {
            let Some(m) = m[i] else { continue };
            let difference = s[i] - m;
            sums[i] += if i == 2 { wrap_angle(difference).abs() } else { difference.abs() };
            counts[i] += 1;
        }
    }
    let md: [Option<f64>; STATES] = std::array::from_fn(|i| (counts[i] > 0).then(|| sums[i] / counts[i] as f64));
    let cvdm = (0..STATES).filter_map(|i| Some(100.0 * md[i]? * weights[i])).sum::<f64>();
    // A sensor term with absurd parameters can report values that are not finite, from a simulation that ran through.
    if !cvdm.is_finite() {
        return diverged(0);
    }
    Outcome::Simulated(Deviation { md, cvdm })
}
