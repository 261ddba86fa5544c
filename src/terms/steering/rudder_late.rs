//! A rudder angle that is recorded late: the rudder was where the record has it some time later. A smoothed feedback, a logger that writes an
//! old value, or a clock of its own. A record that comes before the rudder is an order, and the term `rudder_lag`.

use crate::parameter::ParameterInfo;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Group, Physics, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::ship::Ship;
use crate::state::Inputs;
use crate::terms::size;
use trimtab_ad::Scalar;

/// Rudder angle recorded late.
pub struct RudderLate;

static INFO: TermInfo = TermInfo {
    name: "rudder_late",
    title: "rudder angle recorded late",
    group: Group::Rudder,
    equation: "delta(t) = delta_m(t + tau)",
    source: "pure delay of a record that is linear between samples; the last sample lasts",
    needs: &[],
    validity: Validity::any("a constant delay"),
    mechanisms: &[Mechanism {
        name: "rudder_late",
        title: "rudder angle recorded late",
        kind: Kind::Actuator,
        parameters: &["time"],
        companions: &[],
        probe: Probe::Tangent,
        needs_reference: false,
        by_session: false,
        stand_in: false,
        look_alikes: &["time_skew", "log_skew", "yaw_rate_skew"],
        trial: "zigzags after a check of the rudder's clock against the order",
    }],
    parameters: &[ParameterInfo::new("time", "tau_d", "s", "time from the rudder to its record")
        .scale(|s| 0.7 * size::time(s))
        .bounds(0.0, 60.0)],
};

impl Term for RudderLate {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }
}

impl<S: Scalar> Physics<S> for RudderLate {
    fn drive(&self, p: &[S], _ship: &Ship, dt: f64, series: &mut [Inputs<S>]) {
        let samples = p[0] / dt;
        // A delay beyond the series reads its last sample, whatever it is.
        let whole = samples.value().clamp(0.0, series.len() as f64).floor();
        let part = samples - whole;
        let last = series.len().saturating_sub(1);
        // Those behind are still as recorded when one is read.
        for i in 0..series.len() {
            let [a, b] = [0, 1].map(|k| series[(i + whole as usize + k).min(last)].delta);
            series[i].delta = a + (b - a) * part;
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use std::path::Path;

    fn driven(tau: f64, angles: &[f64]) -> Vec<f64> {
        let ship = Ship::read(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/experiments/ships/a.toml"))).unwrap();
        let mut series: Vec<Inputs<f64>> = angles.iter().map(|&a| Inputs::actuators(0.0, 2.0, a)).collect();
        RudderLate.drive(&[tau], &ship, 0.5, &mut series);
        series.iter().map(|i| i.delta).collect()
    }

    #[test]
    fn a_record_that_is_late_by_a_sample_and_a_half_is_read_so_much_later() {
        let angles = [0.0, 0.1, 0.3, 0.2, 0.2];
        assert_eq!(driven(0.0, &angles), angles);
        let near = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12);
        assert!(near(&driven(0.75, &angles), &[0.2, 0.25, 0.2, 0.2, 0.2]), "{:?}", driven(0.75, &angles));
        assert!(near(&driven(50.0, &angles), &[0.2; 5]));
    }
}
