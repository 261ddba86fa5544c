//! Regions of state and inputs, and the test of a constant force in each of them.
//! A region says where a force shows, not what it is.

use crate::likelihood::covariance::Z;
use crate::likelihood::evidence::{Base, Evidence};
use crate::model::Model;
use crate::recording::Run;
use crate::state::{Inputs, State};
use crate::units::GRAVITY;
use serde::Serialize;

/// A region of state and inputs in which a force acts that the model does not have.
#[derive(Clone, Debug, Serialize)]
pub struct RegionTest {
    /// The region in words.
    pub region: String,
    /// Share of all samples that lie in it.
    pub samples: f64,
    /// Mean force there: X, Y \[N\], N \[N m\].
    pub force: [f64; 3],
    /// Standard errors.
    pub error: [f64; 3],
    /// Twice the gain in log-likelihood.
    pub statistic: f64,
    /// p-value, corrected for the number of regions.
    pub p: f64,
}

/// Whether a state with its inputs lies in a region.
pub type Predicate = fn(&Model, &State<f64>, &Inputs<f64>) -> bool;

fn speed_unit(model: &Model) -> f64 {
    (GRAVITY * model.ship.hull.lpp).sqrt()
}

fn quadrant(s: &State<f64>, q: i32) -> bool {
    (s.psi / std::f64::consts::FRAC_PI_2).round().rem_euclid(4.0) as i32 == q
}

/// The regions, in words and as a condition on model, state and inputs.
pub const REGIONS: [(&str, Predicate); 12] = [
    ("propeller astern (n < 0)", |_, _, i| i.n < 0.0),
    ("sternway (u < 0)", |m, s, _| s.u < -0.003 * speed_unit(m)),
    ("low speed (Fn < 0.05)", |m, s, _| s.u.hypot(s.v) < 0.05 * speed_unit(m)),
    ("high speed (Fn > 0.15)", |m, s, _| s.u.hypot(s.v) > 0.15 * speed_unit(m)),
    ("large drift (over 20 deg)", |m, s, _| s.u.hypot(s.v) > 0.01 * speed_unit(m) && s.v.abs() > 0.34 * s.u.hypot(s.v)),
    ("hard rudder (over 25 deg)", |_, _, i| i.delta.abs() > 0.436),
    ("turning to starboard", |m, s, _| s.r > 0.005 * speed_unit(m) / m.ship.hull.lpp),
    ("turning to port", |m, s, _| s.r < -0.005 * speed_unit(m) / m.ship.hull.lpp),
    ("heading north", |_, s, _| quadrant(s, 0)),
    ("heading east", |_, s, _| quadrant(s, 1)),
    ("heading south", |_, s, _| quadrant(s, 2)),
    ("heading west", |_, s, _| quadrant(s, 3)),
];

/// Tests a constant force in every region that was visited, the most significant first. `first` is the first of the forces'
/// columns, three a region, and `unit` their scales \[N, N, N m\].
pub fn regions(visits: &Visits, evidence: &Evidence, base: &Base, first: usize, unit: &[f64; 3]) -> Vec<RegionTest> {
    let test = |(j, (name, _)): (usize, &(&str, Predicate))| {
        let at = first + 3 * j;
        let test = evidence.test(base, &[at, at + 1, at + 2]);
        (test.degrees > 0).then(|| RegionTest {
            region: (*name).into(),
            samples: visits.inside[j] as f64 / visits.samples.max(1) as f64,
            force: std::array::from_fn(|e| test.amplitude[e] * unit[e]),
            error: std::array::from_fn(|e| test.covariance[(e, e)].max(0.0).sqrt() * unit[e]),
            statistic: test.statistic,
            p: (test.p * REGIONS.len() as f64).min(1.0),
        })
    };
    let mut out: Vec<RegionTest> = REGIONS.iter().enumerate().filter_map(test).collect();
    out.sort_by(|a, b| b.statistic.total_cmp(&a.statistic));
    out
}

/// How many samples lie in each region.
#[derive(Clone, Copy, Debug, Default)]
pub struct Visits {
    samples: usize,
    inside: [usize; REGIONS.len()],
}

impl Visits {
    /// Adds those of another run.
    pub fn add(&mut self, other: &Self) {
        self.samples += other.samples;
        self.inside.iter_mut().zip(other.inside).for_each(|(sum, more)| *sum += more);
    }
}

/// The regions in which a run was, by its filtered states.
pub fn visited(run: &Run, filtered: &[[f64; Z]], model: &Model) -> Visits {
    let mut visits = Visits::default();
    for (z, i) in filtered.iter().zip(&run.inputs) {
        let s = State { x: z[0], y: z[1], psi: z[2], u: z[3], v: z[4], r: z[5] };
        visits.samples += 1;
        for (count, (_, inside)) in visits.inside.iter_mut().zip(&REGIONS) {
            *count += usize::from(inside(model, &s, i));
        }
    }
    visits
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::physics::Form;
    use crate::ship::Ship;
    use std::path::Path;

    #[test]
    fn every_heading_is_in_one_quadrant_and_a_stopped_ship_is_slow_and_does_not_drift() {
        let ship = Ship::read(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/experiments/ships/a.toml"))).unwrap();
        let model = Model::new(ship, "HD", Form::Regular, &[]).unwrap();
        let still = Inputs::actuators(0.0, 1.0, 0.0);
        let regions_of = |s: &State<f64>| -> Vec<&str> {
            REGIONS.iter().filter(|(_, inside)| inside(&model, s, &still)).map(|(name, _)| *name).collect()
        };
        for degrees in (-720..720).step_by(7) {
            let s = State { x: 0.0, y: 0.0, psi: f64::from(degrees).to_radians(), u: 0.0, v: 0.0, r: 0.0 };
            let names = regions_of(&s);
            assert_eq!(names.iter().filter(|n| n.starts_with("heading")).count(), 1, "{degrees} {names:?}");
            assert!(names.contains(&"low speed (Fn < 0.05)") && names.len() == 2, "{names:?}");
        }
        let east = State { x: 0.0, y: 0.0, psi: 1.5, u: 0.0, v: 0.0, r: 0.0 };
        assert!(regions_of(&east).contains(&"heading east"));
    }
}
