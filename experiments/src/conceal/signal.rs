//! The signal-to-noise ratio of an effect for the diagnosis, by which concealed effects are graded.
//! It decides nothing and names nothing.

use nalgebra::DVector;
use trimtab::diagnose::Settings;
use trimtab::diagnose::evidence::candidate::{Candidate, append, candidates};
use trimtab::likelihood::estimate::{Estimate, base_of, estimate, evidence, passes, restrictions};
use trimtab::likelihood::evidence::{Base, Evidence};
use trimtab::likelihood::filter::{Column, Filter, Wanted};
use trimtab::likelihood::noise::NoisePrior;
use trimtab::likelihood::noise::fit::guess;
use trimtab::likelihood::parameters::base_parameters;
use trimtab::likelihood::settings::Effort;
use trimtab::model::{Model, ModelError};
use trimtab::recording::Run;
use trimtab::ship::state::{Inputs, State};
use trimtab::simulate::Integration;

/// Rounds of the base model: noise within a few per cent.
const ROUNDS: Effort = Effort { rounds: 6, noise_rounds: 2, noise_iterations: 6 };

/// The base model fitted to runs without an effect, ready to measure the same runs with it.
pub struct Signal {
    runs: Vec<Run>,
    null: Estimate,
    integration: Integration,
    candidates: Vec<Candidate>,
    columns: Vec<Column>,
    groups: Vec<Vec<usize>>,
    without: Evidence,
}

impl Signal {
    /// Fits the base model and its noise to runs without the effect.
    ///
    /// # Errors
    /// When the catalogue's terms cannot be added to the model.
    pub fn new(model: &Model, without: &[Run], settings: &Settings) -> Result<Self, ModelError> {
        let full = model.complete()?;
        let integration = settings.integration();
        let free = base_parameters(&full, settings.nuisance);
        let first = guess(without, &full);
        let null = estimate(&full, integration, without, &free, &first, &NoisePrior::around(&first), ROUNDS);
        let candidates = candidates(&full, &[]);
        let mut columns: Vec<Column> = free.iter().map(|f| f.column).collect();
        let groups = append(&mut columns, &candidates);
        let p = passes(&null.model, integration, &columns, without, &null.noise, false);
        let evidence = evidence(without, &p, &restrictions(&free));
        Ok(Self { runs: without.to_vec(), null, integration, candidates, columns, groups, without: evidence })
    }

    /// Signal-to-noise ratio of the change from the runs without to the same runs with the effect (same noise), along a
    /// mechanism: the square root of the noncentrality of its score test, with parameters, nuisance coefficients, initial states
    /// and noise profiled out. 0 for a mechanism that is not in the catalogue.
    ///
    /// For a mechanism that needs a reference, the test is the one between sessions.
    pub fn ratio(&self, with: &[Run], mechanism: &str) -> f64 {
        let Some(index) = self.candidates.iter().position(|c| c.mechanism.name == mechanism) else { return 0.0 };
        let candidate = &self.candidates[index];
        let free = self.null.free.len();
        let own = &self.groups[index];
        let columns: Vec<Column> = self.columns[..free].iter().chain(&candidate.columns).copied().collect();
        let p = passes(&self.null.model, self.integration, &columns, with, &self.null.noise, false);
        let changed = evidence(with, &p, &restrictions(&self.null.free));
        let mut difference = self.without.clone();
        // Columns of this pass among those of the first one.
        let place: Vec<usize> = (0..free).chain(own.iter().copied()).collect();
        let subtract = |from: &DVector<f64>, new: &DVector<f64>| {
            let mut out = from.clone();
            for (j, c) in place.iter().enumerate() {
                out[*c] = new[j] - from[*c];
            }
            out
        };
        difference.total.score = subtract(&self.without.total.score, &changed.total.score);
        for (name, s) in &mut difference.sessions {
            if let Some(other) = changed.sessions.get(name) {
                s.score = subtract(&s.score, &other.score);
            }
        }
        let base = self.base(&difference);
        let test = if candidate.mechanism.needs_reference {
            difference.contrast(&base, own).unwrap_or_else(|| difference.test(&base, own))
        } else {
            difference.test(&base, own)
        };
        test.statistic.max(0.0).sqrt()
    }

    /// The ratio for one constant force (X, Y, N) in windows of some runs: index of the run, first and last sample.
    pub fn ratio_in(&self, with: &[Run], windows: &[(usize, usize, usize)]) -> f64 {
        let free = self.null.free.len();
        let filter = Filter::new(&self.null.model, self.integration, &self.columns[..free]);
        let seen = |runs: &[Run]| {
            let basis = |(run, k): (usize, usize), _: &State<f64>, _: &Inputs<f64>, out: &mut Vec<[f64; 3]>| {
                let on = windows.iter().any(|(i, from, to)| *i == run && (*from..=*to).contains(&k));
                let unit = |e: usize| if on { self.null.noise.force[e] } else { 0.0 };
                out.extend([[unit(0), 0.0, 0.0], [0.0, unit(1), 0.0], [0.0, 0.0, unit(2)]]);
            };
            let wanted = Wanted { basis: Some((3, &basis)), ..Wanted::default() };
            let p = filter.passes(runs, &self.null.noise, wanted);
            evidence(runs, &p, &restrictions(&self.null.free))
        };
        let mut difference = seen(&self.runs);
        difference.total.score = seen(with).total.score - &difference.total.score;
        let test = difference.test(&self.base(&difference), &[free, free + 1, free + 2]);
        test.statistic.max(0.0).sqrt()
    }

    /// What parameters and nuisances take of a difference. The prior's pull belongs to the estimate, not to it.
    fn base(&self, difference: &Evidence) -> Base {
        let base = base_of(difference, &self.null.model, &self.null.free);
        Base { score: DVector::from_fn(self.null.free.len(), |i, _| difference.total.score[i]), ..base }
    }
}
