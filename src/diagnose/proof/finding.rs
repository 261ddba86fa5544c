//! What a diagnosis names: a value with its interval, and a finding with everything that is said about it.
//! It computes nothing; how a finding is made and judged is in other files.

use super::grade::Grade;
use super::unseen::FindingProof;
use crate::diagnose::evidence::locate::EquationShare;
pub use crate::diagnose::evidence::push::PUSH;
use crate::diagnose::evidence::push::Window;
use crate::diagnose::settings::MATERIAL_SHARE;
use crate::physics::Kind;
use serde::Serialize;

/// A value with its interval.
#[derive(Clone, Debug, Serialize)]
pub struct Amplitude {
    /// Dotted name.
    pub name: String,
    /// Value.
    pub value: f64,
    /// SI unit.
    pub unit: String,
    /// Standard error.
    pub error: f64,
    /// 95 % interval.
    pub ci95: [f64; 2],
}

impl Amplitude {
    /// A value with its standard error, as normally distributed.
    pub fn new(name: String, value: f64, unit: &str, error: f64) -> Self {
        Self::within(name, value, unit, error, 1.96)
    }

    /// A value with its standard error, whose 95 % interval reaches so many errors to either side.
    pub fn within(name: String, value: f64, unit: &str, error: f64, reach: f64) -> Self {
        Self { name, value, unit: unit.into(), error, ci95: [value - reach * error, value + reach * error] }
    }

    /// The interval on the scale of the logarithm: `value exp(+- reach error / value)`.
    pub fn of_one_sign(&mut self) {
        let factor = (0.5 * (self.ci95[1] - self.ci95[0]) / self.value).exp();
        self.ci95 = [self.value / factor, self.value * factor];
    }

    /// The same uncertainty around another value.
    pub fn moved_to(&mut self, value: f64) {
        let by = value - self.value;
        self.value = value;
        self.ci95.iter_mut().for_each(|limit| *limit += by);
    }
}

/// Shares of the unexplained force by equation.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Equations {
    /// Surge.
    #[serde(rename = "X")]
    pub x: EquationShare,
    /// Sway.
    #[serde(rename = "Y")]
    pub y: EquationShare,
    /// Yaw.
    #[serde(rename = "N")]
    pub n: EquationShare,
}

impl From<[EquationShare; 3]> for Equations {
    fn from([x, y, n]: [EquationShare; 3]) -> Self {
        Self { x, y, n }
    }
}

/// A mechanism, a push or a fault of a sensor that is named.
#[derive(Clone, Debug, Serialize)]
pub struct Finding {
    /// Name of the mechanism; `push` for a time-local force, `generic` when it is not in the catalogue.
    pub mechanism: String,
    /// Plain words.
    pub title: String,
    /// How well it is supported.
    pub grade: Grade,
    /// What kind of thing it is.
    pub kind: Kind,
    /// Every mechanism that these data allow in its place, itself first.
    pub confidence_set: Vec<String>,
    /// Why the set is what it is.
    pub why: String,
    /// Sessions in which it acts; empty for all.
    pub sessions: Vec<String>,
    /// Whether each of these sessions has an amplitude of its own, `parameters` naming the session in brackets.
    pub by_session: bool,
    /// Twice the gain in log-likelihood.
    pub statistic: f64,
    /// Corrected p-value.
    pub p: f64,
    /// Share of the force it brings, by equation.
    pub equations: Equations,
    /// Time windows, for a time-local force.
    pub windows: Vec<Window>,
    /// Region of state and inputs in which the unexplained force is most significant.
    pub region: Option<String>,
    /// Its signature in words.
    pub signature: String,
    /// Its parameters.
    pub parameters: Vec<Amplitude>,
    /// How far it changes predictions of the training runs, as a share of the error there is without it.
    pub change: Option<f64>,
    /// Without and with it on unseen runs, everything else refitted.
    pub held_out: Option<FindingProof>,
}

/// Whether all of some amplitudes are times, as those of a clock are.
pub fn are_times(amplitudes: &[Amplitude]) -> bool {
    !amplitudes.is_empty() && amplitudes.iter().all(|a| a.unit == "s")
}

impl Finding {
    /// Whether it was withdrawn as immaterial because it is a time less than is resolved: a clock, or a lag that else would change predictions
    /// enough to matter.
    pub fn is_unresolved(&self) -> bool {
        let matters = self.change.is_some_and(|change| change >= MATERIAL_SHARE);
        self.grade == Grade::Immaterial && are_times(&self.parameters) && (self.kind == Kind::Sensor || matters)
    }
}

/// Title of a push.
pub const PUSH_TITLE: &str = "a push for a limited time (tug, thruster, line)";

/// The name in a confidence set for physics that is not in the catalogue.
pub const GENERIC: &str = "generic";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interval_of_a_size_of_one_sign_has_its_sign_and_is_the_other_one_where_the_size_is_well_known() {
        for sign in [1.0, -1.0] {
            let of = |error: f64| {
                let mut size = Amplitude::within("fouling.fraction".into(), sign * 0.24, "-", error, 12.7);
                size.of_one_sign();
                size.ci95
            };
            let [low, high] = of(0.03);
            assert!(low * sign > 0.0 && high * sign > 0.0 && (low * high - 0.24_f64.powi(2)).abs() < 1e-12);
            assert!(low < sign * 0.24 && sign * 0.24 < high);
            let well = of(1e-5);
            assert!((well[1] - well[0] - 2.0 * 12.7e-5).abs() < 1e-8);
        }
    }
}
