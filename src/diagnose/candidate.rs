//! A mechanism of the catalogue as a candidate of one model: its columns, its amplitudes, and the sessions it acts in.
//! What the mechanisms are is told in the terms' files, beside the physics.

use super::evidence::Test;
use super::filter::Column;
use crate::model::Model;
use crate::physics::{Group, Mechanism};
use crate::recording::Run;
use crate::terms::CATALOGUE;

/// Whether recordings can possibly show a mechanism: a tide needs a good part of its period.
pub fn applies(mechanism: &Mechanism, runs: &[Run]) -> bool {
    const QUARTER_TIDE: f64 = 11_178.0;
    let times = || runs.iter().flat_map(|r| [r.inputs.first(), r.inputs.last()]).flatten().map(|i| i.t);
    let span = times().fold(f64::NEG_INFINITY, f64::max) - times().fold(f64::INFINITY, f64::min);
    mechanism.name != "tide" || span > QUARTER_TIDE
}

/// In which sessions a mechanism acts, and whether with one amplitude.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Extent {
    /// In all sessions, with one amplitude.
    All,
    /// In these sessions, with one amplitude; absent in the others.
    In(Vec<String>),
    /// In each of these sessions with an amplitude of its own.
    Each(Vec<String>),
}

impl Extent {
    /// The groups of sessions that share an amplitude, each as the sessions of its free parameters; `None` for all sessions.
    pub fn parts(&self) -> Vec<Option<Vec<String>>> {
        match self {
            Self::All => vec![None],
            Self::In(sessions) => vec![Some(sessions.clone())],
            Self::Each(sessions) => sessions.iter().map(|s| Some(vec![s.clone()])).collect(),
        }
    }

    /// The sessions it names; none for all with one amplitude.
    pub fn sessions(&self) -> &[String] {
        match self {
            Self::All => &[],
            Self::In(sessions) | Self::Each(sessions) => sessions,
        }
    }
}

/// A mechanism placed in a model.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// What it is.
    pub mechanism: &'static Mechanism,
    /// Name of its term.
    pub term: &'static str,
    /// Group of its term.
    pub group: Group,
    /// Its columns.
    pub columns: Vec<Column>,
    /// Its dotted parameter names.
    pub names: Vec<String>,
}

impl Candidate {
    /// Amplitude (root mean square over the sessions, where each has its own) in units of the floor: below 1 it is not worth
    /// naming.
    pub fn size(&self, amplitude: &[f64]) -> f64 {
        let parts = amplitude.len() as f64 / self.columns.len().max(1) as f64;
        (amplitude.iter().map(|a| a * a).sum::<f64>() / parts).sqrt() / self.mechanism.floor
    }

    /// Whether the amplitudes of a test, added to the present values, are possible: kept inside the parameters' bounds they
    /// hold most of what they promise. A law that bends may well promise more than there can be.
    pub fn admissible(&self, model: &Model, test: &Test) -> bool {
        let beyond = |(i, a): (usize, &f64)| {
            let c = &self.columns[i % self.columns.len()];
            let p = &model.parameters[c.parameter];
            let value = p.value + a * c.scale;
            let error = test.covariance[(i, i)].max(0.0).sqrt() * c.scale.abs();
            let away = value - value.clamp(p.lower, p.upper);
            if away == 0.0 { 0.0 } else { (away / error).powi(2) }
        };
        test.amplitude.iter().enumerate().map(beyond).sum::<f64>() <= BEYOND * test.statistic.max(1.0)
    }
}

/// Share of what a test promises that amplitudes may lose when they are kept inside their bounds.
const BEYOND: f64 = 0.25;

/// Appends the columns of candidates, and gives where those of each stand.
pub fn append(columns: &mut Vec<Column>, candidates: &[Candidate]) -> Vec<Vec<usize>> {
    let mut place = |c: &Candidate| {
        let start = columns.len();
        columns.extend(&c.columns);
        (start..columns.len()).collect()
    };
    candidates.iter().map(&mut place).collect()
}

/// Every mechanism of the catalogue whose term is in the model, except the ones withheld.
pub fn candidates(model: &Model, withhold: &[String]) -> Vec<Candidate> {
    let mut out = Vec::new();
    for term in CATALOGUE {
        let info = term.info();
        for mechanism in info.mechanisms {
            if withhold.iter().any(|w| w == mechanism.name) {
                continue;
            }
            let names: Vec<String> = mechanism.parameters.iter().map(|p| format!("{}.{p}", info.name)).collect();
            let columns: Option<Vec<Column>> = names
                .iter()
                .map(|n| {
                    model.index(n).map(|parameter| Column {
                        parameter,
                        scale: model.parameters[parameter].scale,
                        probe: mechanism.probe,
                    })
                })
                .collect();
            if let Some(columns) = columns {
                out.push(Candidate { mechanism, term: info.name, group: info.group, columns, names });
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::physics::Form;
    use crate::ship::Ship;
    use nalgebra::{DMatrix, DVector};
    use std::path::Path;

    #[test]
    fn what_promises_a_little_more_than_there_can_be_is_possible_and_the_other_sign_is_not() {
        let ship = Ship::read(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/experiments/ships/a.toml"))).unwrap();
        let model = Model::new(ship, "HD", Form::Regular, &[]).unwrap().complete().unwrap();
        let all = candidates(&model, &[]);
        let stall = all.iter().find(|c| c.mechanism.name == "rudder_stall").unwrap();
        // All lift can be lost and no more: amplitudes in units of that, one tenth as uncertain as large.
        let possible = |share: f64| {
            let (a, error) = (share / stall.columns[0].scale, 0.1 * share / stall.columns[0].scale);
            stall.admissible(
                &model,
                &Test {
                    statistic: 100.0,
                    degrees: 1,
                    p: 0.0,
                    amplitude: DVector::from_element(1, a),
                    covariance: DMatrix::from_element(1, 1, error * error),
                    retained: 1.0,
                },
            )
        };
        assert!(possible(0.5) && possible(1.3) && !possible(4.0) && !possible(-0.5));
    }
}
