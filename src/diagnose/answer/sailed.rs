//! Runs as they were recorded and as the base model and the improved model simulate them from their first sample, for pictures.
//! No number of a diagnosis is taken from here: errors are those of the proof.

use crate::evaluate::predict;
use crate::model::Model;
use crate::recording::{Run, Split, or_nan};
use crate::simulate::Integration;
use crate::state::STATES;
use rayon::prelude::*;

/// Runs kept at most: one page shows them all.
pub const MOST_RUNS: usize = 60;
/// Samples of a run kept at most.
const MOST_SAMPLES: usize = 240;

/// One run, thinned: every series has one entry a time.
#[derive(Clone, Debug)]
pub struct Sailed {
    /// The run.
    pub run: String,
    /// Its session.
    pub session: String,
    /// Whether it is a training run; otherwise no step of the analysis has used it.
    pub train: bool,
    /// Time on the recording's clock \[s\].
    pub time: Vec<f64>,
    /// Propeller rate \[1/s\] and rudder angle \[rad\].
    pub inputs: Vec<[f64; 2]>,
    /// Measured `[x, y, psi, u, v, r]`, NaN where there is no value.
    pub recorded: Vec<[f64; STATES]>,
    /// The same, simulated by the base model, refitted; shorter where it diverges.
    pub base: Vec<[f64; STATES]>,
    /// The same, simulated with the findings; absent where nothing was found.
    pub improved: Option<Vec<[f64; STATES]>>,
}

/// The runs with their simulations, at most [`MOST_RUNS`] of them, at equal distances in their list.
pub fn sailed(runs: &[Run], base: &Model, improved: Option<&Model>, integration: Integration) -> Vec<Sailed> {
    let stride = runs.len().div_ceil(MOST_RUNS).max(1);
    let shown: Vec<&Run> = runs.iter().step_by(stride).collect();
    let of = |run: &&Run| {
        let count = run.measured.len().min(run.inputs.len());
        let stride = count.div_ceil(MOST_SAMPLES).max(1);
        let simulated = |model: &Model| predict(model, run, integration).states.into_iter().step_by(stride).collect();
        let kept = || (0..count).step_by(stride);
        Sailed {
            run: run.name.clone(),
            session: run.session.clone(),
            train: run.split == Split::Train,
            time: kept().map(|k| run.time(k)).collect(),
            inputs: kept().map(|k| [run.inputs[k].n, run.inputs[k].delta]).collect(),
            recorded: kept().map(|k| or_nan(&run.measured[k])).collect(),
            base: simulated(base),
            improved: improved.map(simulated),
        }
    };
    shown.par_iter().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example::{RK4, model, runs, with};

    #[test]
    fn long_lists_and_long_runs_are_thinned_and_every_series_has_one_entry_a_time() {
        let truth = with(&[("current.north", 0.3)]);
        let all: Vec<Run> = (0..10).flat_map(|_| runs(&truth, 10)).collect();
        let sailed = sailed(&all, &model(), Some(&truth), RK4);
        assert!(sailed.len() <= MOST_RUNS && sailed.len() > MOST_RUNS / 2, "{}", sailed.len());
        for s in &sailed {
            assert_eq!((s.recorded.len(), s.inputs.len()), (s.time.len(), s.time.len()));
            assert_eq!((s.base.len(), s.improved.as_ref().map(Vec::len)), (s.time.len(), Some(s.time.len())));
        }
        // The simulation with the current ends nearer to the recording.
        let end = |states: &[[f64; STATES]]| states.last().map(|s| [s[0], s[1]]).unwrap();
        let gap = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
        let s = &sailed[0];
        assert!(gap(end(s.improved.as_ref().unwrap()), end(&s.recorded)) < gap(end(&s.base), end(&s.recorded)));
    }
}
