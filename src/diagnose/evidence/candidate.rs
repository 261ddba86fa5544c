//! A mechanism of the catalogue as a candidate of one model: its columns, its amplitudes, and the sessions it acts in.
//! The mechanisms are described in the terms' files, with the physics; whether one is named is decided elsewhere.

use crate::diagnose::settings::{BEYOND_BOUNDS, QUARTER_TIDE};
use crate::likelihood::estimate::{Estimate, FreeParameter};
use crate::likelihood::evidence::Test;
use crate::likelihood::filter::Column;
use crate::model::Model;
use crate::physics::{Group, Mechanism, Probe};
use crate::recording::Run;
use nalgebra::DVector;

/// Whether recordings can possibly show a mechanism: a tide needs a good part of its period.
pub fn applies(mechanism: &Mechanism, runs: &[Run]) -> bool {
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
    /// What the model already has of it.
    pub held: Held,
}

/// What a model had of a mechanism before the diagnosis: what is missing is what exceeds that.
#[derive(Clone, Debug, Default)]
pub struct Held {
    /// Values of its parameters in all sessions, by column, each in its unit.
    common: Vec<f64>,
    /// What single sessions add to them, by session and parameter.
    sessions: Vec<(String, usize, f64)>,
}

impl Held {
    fn new(model: &Model, columns: &[Column]) -> Self {
        let own = |parameter: usize| columns.iter().any(|c| c.parameter == parameter);
        let of = |(session, list): (&String, &Vec<(usize, f64)>)| {
            let own = list.iter().filter(|(i, _)| own(*i));
            own.map(|(i, value)| (session.clone(), *i, *value)).collect::<Vec<_>>()
        };
        Self {
            common: columns.iter().map(|c| model.parameters[c.parameter].value).collect(),
            sessions: model.sessions.iter().flat_map(of).collect(),
        }
    }
}

impl Candidate {
    /// Whether the amplitudes of a test, added to the present values, are possible: clipped to the parameters' bounds they
    /// keep most of the predicted gain. The linear test of a nonlinear law may predict more than is possible. What is either so or not, as
    /// two actuators that are swapped, has no upper limit here: a model fitted without it predicts any multiple of it.
    pub fn admissible(&self, model: &Model, test: &Test) -> bool {
        let beyond = |(i, a): (usize, &f64)| {
            let c = &self.columns[i % self.columns.len()];
            let p = &model.parameters[c.parameter];
            let value = p.value + a * c.scale;
            let error = test.covariance[(i, i)].max(0.0).sqrt() * c.scale.abs();
            let upper = if self.mechanism.probe == Probe::Whole { f64::INFINITY } else { p.upper };
            let away = value - value.clamp(p.lower, upper);
            if away == 0.0 { 0.0 } else { (away / error).powi(2) }
        };
        test.amplitude.iter().enumerate().map(beyond).sum::<f64>() <= BEYOND_BOUNDS * test.statistic.max(1.0)
    }

    /// Its free parameters where it acts, group of sessions by group.
    pub fn parameters(&self, extent: &Extent) -> Vec<FreeParameter> {
        let of = |sessions: Option<Vec<String>>| {
            self.columns.iter().map(move |col| FreeParameter {
                column: Column { probe: Probe::Tangent, ..*col },
                sessions: sessions.clone(),
                prior: None,
            })
        };
        extent.parts().into_iter().flat_map(of).collect()
    }

    /// The values that the model already had of its parameters where it acts, in units of their columns: group of sessions by group.
    pub fn held(&self, extent: &Extent) -> DVector<f64> {
        let of = |(i, f): (usize, &FreeParameter)| {
            let column = i % self.columns.len();
            let value = match f.sessions.as_ref().and_then(|s| s.first()) {
                None => self.held.common[column],
                Some(session) => {
                    let own = self.held.sessions.iter().filter(|(s, i, _)| s == session && *i == f.column.parameter);
                    own.map(|(_, _, value)| value).sum()
                }
            };
            value / f.column.scale
        };
        let parameters = self.parameters(extent);
        DVector::from_iterator(parameters.len(), parameters.iter().enumerate().map(of))
    }

    /// The places in a model of the coefficients that are not known exactly once it acts.
    pub fn companions(&self, model: &Model) -> Vec<usize> {
        self.mechanism.companions.iter().filter_map(|name| model.index(&format!("{}.{name}", self.term))).collect()
    }

    /// Where its parameters are among the free ones.
    pub fn positions(&self, free: &[FreeParameter], extent: &Extent) -> Vec<usize> {
        let same = |f: &FreeParameter, own: &FreeParameter| {
            f.column.parameter == own.column.parameter && f.prior.is_none() && f.sessions == own.sessions
        };
        self.parameters(extent).iter().filter_map(|own| free.iter().position(|f| same(f, own))).collect()
    }

    /// Adds amplitudes in units of the columns' scales to its parameters.
    pub fn add(&self, model: &mut Model, extent: &Extent, amplitude: &DVector<f64>) {
        for (p, a) in self.parameters(extent).iter().zip(amplitude.iter()) {
            p.set(model, a * p.column.scale + p.value(model));
        }
    }

    /// The model of an estimate without it beyond what the model already had, and what is free then.
    pub fn removed(&self, found: &Estimate, extent: &Extent) -> (Model, Vec<FreeParameter>) {
        let (mut model, mut free) = (found.model.clone(), found.free.clone());
        let own = self.parameters(extent);
        for (f, held) in own.iter().zip(self.held(extent).iter()) {
            f.set(&mut model, held * f.column.scale);
        }
        let mut places = self.positions(&free, extent);
        places.sort_unstable();
        for at in places.into_iter().rev() {
            free.remove(at);
        }
        (model, free)
    }
}

/// Appends the columns of candidates, and gives the places of each candidate's own.
pub fn append(columns: &mut Vec<Column>, candidates: &[Candidate]) -> Vec<Vec<usize>> {
    let mut place = |c: &Candidate| {
        let start = columns.len();
        columns.extend(&c.columns);
        (start..columns.len()).collect()
    };
    candidates.iter().map(&mut place).collect()
}

/// Every mechanism of the catalogue whose term is in the model, except those of a propeller or a rudder that the craft has not and the
/// ones withheld.
pub fn candidates(model: &Model, withhold: &[String]) -> Vec<Candidate> {
    let mut out = Vec::new();
    for info in model.catalogue().iter().map(|term| term.info()).filter(|info| !model.lacks(info)) {
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
                let held = Held::new(model, &columns);
                out.push(Candidate { mechanism, term: info.name, group: info.group, columns, names, held });
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
    fn amplitudes_a_little_beyond_their_bound_are_possible_and_the_other_sign_is_not() {
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

    #[test]
    fn a_mechanism_that_is_added_and_removed_leaves_the_estimate_as_it_was() {
        use crate::diagnose::example;
        let model = example::model();
        let c = example::candidate(&model, "current");
        for extent in [Extent::All, Extent::In(vec!["a".into()]), Extent::Each(vec!["a".into(), "b".into()])] {
            let mut found = example::at(&model);
            let count = found.free.len();
            let own = c.parameters(&extent);
            found.free.extend(own.clone());
            let amplitude = DVector::from_fn(own.len(), |i, _| 0.1 * (i + 1) as f64);
            c.add(&mut found.model, &extent, &amplitude);
            for (f, a) in own.iter().zip(amplitude.iter()) {
                assert!((f.value(&found.model) - a * f.column.scale).abs() < 1e-12, "{extent:?}");
            }
            let places = c.positions(&found.free, &extent);
            assert_eq!(places, (count..count + own.len()).collect::<Vec<_>>());
            let (bare, free) = c.removed(&found, &extent);
            assert_eq!(free.len(), count);
            assert!(["a", "b", "c"].iter().all(|s| bare.values_in(s) == model.values_in(s)), "{extent:?}");
        }
    }

    #[test]
    fn what_a_model_already_has_is_where_a_mechanism_starts_and_where_it_returns_to() {
        use crate::diagnose::example;
        let mut model = example::with(&[("current.north", 0.3)]);
        let north = model.find("current.north").unwrap();
        model.sessions.insert("a".into(), vec![(north, 0.1)]);
        let c = example::candidate(&model, "current");
        let scale = c.columns[0].scale;
        let each = Extent::Each(vec!["a".into(), "b".into()]);
        for (extent, held) in [(Extent::All, vec![0.3, 0.0]), (each, vec![0.1, 0.0, 0.0, 0.0])] {
            let expected = DVector::from_vec(held) / scale;
            assert!((c.held(&extent) - &expected).amax() < 1e-12, "{extent:?}");
            let mut found = example::at(&model);
            found.free.extend(c.parameters(&extent));
            let more = DVector::from_element(expected.len(), 0.2);
            c.add(&mut found.model, &extent, &more);
            let present = c.parameters(&extent).iter().map(|f| f.value(&found.model) / scale).collect::<Vec<_>>();
            assert!((DVector::from_vec(present) - expected - more).amax() < 1e-12, "{extent:?}");
            let (bare, _) = c.removed(&found, &extent);
            assert!(["a", "b", "c"].iter().all(|s| bare.values_in(s) == model.values_in(s)), "{extent:?}");
        }
    }

    #[test]
    fn a_tide_needs_recordings_over_a_quarter_of_its_period() {
        let model = crate::diagnose::example::model();
        let tide = crate::diagnose::example::candidate(&model, "tide").mechanism;
        let mut runs = crate::diagnose::example::runs(&model, 2);
        assert!(!applies(tide, &runs));
        runs[1].inputs.iter_mut().for_each(|i| i.t += 12_000.0);
        assert!(applies(tide, &runs));
    }
}
