//! Stages of a fit: what is fitted before all whole runs, so that the fit to these begins nearer. It cuts and draws runs; what is
//! done with them is the work of `solve`.
//!
//! Where errors of the start grow fast, runs are cut into shorter pieces, each started from its own measured state.
//! The cost of a run simulated in open loop has one basin near the ship and many far from it: a hull coefficient that is wrong
//! by a third turns the simulated ship out of step with the recorded one, and from there on its track does not show in which
//! direction the parameters are wrong. Over a shorter piece the same error has not grown yet. So the shortest pieces over which errors
//! grow no faster than linearly are fitted first, then pieces twice as long, then the whole runs. Source of the idea: multiple shooting,
//! Bock, in Modelling of Chemical Reaction Systems (1981) 102-125; here the states at the cuts are the measured ones.

use super::problem::{FEW, PIECES};
use super::task::Task;
use crate::fit::error::FitError;
use crate::fit::objectives::cost::Cost;
use crate::fit::settings::Hessian;
use crate::recording::{Run, RunStore, Runs, or_nan};
use crate::state::STATES;

/// Steps that a piece has at least.
const MIN_STEPS: usize = 10;

/// Parts into which a run is cut at most.
const MAX_PARTS: usize = 8;

/// Ratio of the costs of runs and of their halves up to which errors grow no faster than linearly: an error e = a t has a mean
/// square over a time T of a^2 T^2/3, four times that over half the time.
const LINEAR: f64 = 4.0;

/// Runs from which on a few of them are fitted first, how many these are at least, and the share of all that they are at least.
/// Most of the steps of a fit only bring it near, which a few runs do as well as all.
const MANY_RUNS: usize = 96;
const FEW_RUNS: usize = 24;
const FEW_SHARE: usize = 16;

/// Runs from which on a fit by likelihood begins with a few of them, how many these are at least, and the share of all that they are at
/// least. With priors on what a few runs do not determine, and noise estimated along, fewer bring it near than where a cost is all there is.
const MANY_BY_LIKELIHOOD: usize = 24;
const FEW_BY_LIKELIHOOD: usize = 8;
const SHARE_BY_LIKELIHOOD: usize = 5;

/// What a stage fits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::fit) enum Sample {
    /// All runs, each cut into so many pieces.
    Pieces(usize),
    /// About one of so many runs.
    Few(usize),
}

impl Sample {
    /// The stages before the fit to all whole runs, where the first cuts them into `parts`.
    pub fn stages(task: &Task, parts: usize) -> Vec<Self> {
        if parts > 1 { falling(parts).map(Self::Pieces).collect() } else { Self::few(task).into_iter().collect() }
    }

    /// A few of the runs, where there are many and a fit takes steps that a few of them determine as well as all.
    pub fn few(task: &Task) -> Option<Self> {
        let runs = task.cost.runs();
        let many = runs >= MANY_RUNS && task.settings.hessian == Hessian::GaussNewton;
        many.then(|| Self::Few(runs / (runs / FEW_SHARE).max(FEW_RUNS)))
    }

    /// What is fitted, as [`Progress::part`](super::problem::Progress::part) says it.
    pub fn part(self) -> &'static str {
        match self {
            Self::Pieces(_) => PIECES,
            Self::Few(_) => FEW,
        }
    }

    /// The runs of the stage with the weights of their whole run.
    ///
    /// # Errors
    /// [`FitError::Unreadable`] where the runs of a file cannot be kept in another.
    pub fn draw(self, runs: Runs, weights: &[[f64; STATES]]) -> Result<(RunStore, Vec<[f64; STATES]>), FitError> {
        match self {
            Self::Pieces(parts) => cut(runs, weights, parts),
            Self::Few(of) => few(runs, weights, of),
        }
    }
}

/// Number of parts of the first stage of a fit, 1 for no stages: the fewest parts over which the errors of the start grow no faster than
/// linearly. Of many runs that can all be simulated from the start, a few show how fast errors grow.
pub(in crate::fit) fn parts(task: &Task) -> usize {
    let longest = task.runs.iter().map(|r| r.measured.len().saturating_sub(1)).max().unwrap_or(0);
    let longest = task.cost.ranks().largest(&[longest as f64])[0] as usize;
    let few = Sample::few(task).filter(|_| task.start_cost.is_finite());
    let few = few.and_then(|few| few.draw(task.runs, task.cost.weights()).ok());
    let (runs, weights) =
        few.as_ref().map_or((task.runs, task.cost.weights()), |(runs, weights)| (Runs::from(runs), &weights[..]));
    let cost = |parts: usize| {
        let (pieces, weights) = cut(runs, weights, parts).ok()?;
        let cost =
            Cost::weighted(task.cost.ranks(), task.model, Runs::from(&pieces), weights, task.cost_options()).ok()?;
        cost.value(&task.start).map(|c| c * cost.runs() as f64)
    };
    let mut parts = 1;
    let mut here = cost(parts);
    while parts < MAX_PARTS && longest / (2 * parts) >= MIN_STEPS {
        let halves = cost(2 * parts);
        if let (Some(here), Some(halves)) = (here, halves)
            && here <= LINEAR * halves
        {
            break;
        }
        (parts, here) = (2 * parts, halves);
    }
    parts
}

/// The numbers of parts of the stages before the whole runs: `parts`, then half as many, down to 2.
fn falling(parts: usize) -> impl Iterator<Item = usize> {
    std::iter::successors(Some(parts), |p| Some(p / 2)).take_while(|p| *p > 1)
}

/// Every run cut into `parts` pieces of equal length, each started from the state measured there.
///
/// A run whose state is not measured at a cut stays in one piece there. Pieces keep the weights and the name of their run.
///
/// # Errors
/// [`FitError::Unreadable`] where the pieces of runs in a file cannot be kept in another.
fn cut(runs: Runs, weights: &[[f64; STATES]], parts: usize) -> Result<(RunStore, Vec<[f64; STATES]>), FitError> {
    let mut pieces = RunStore::new(if runs.held() { usize::MAX } else { 0 });
    let mut kept = Vec::new();
    for (run, weights) in runs.iter().zip(weights) {
        for piece in cut_run(&run, parts) {
            pieces.push(piece).map_err(|_| FitError::Unreadable)?;
            kept.push(*weights);
        }
    }
    Ok((pieces, kept))
}

/// About one of `of` runs, drawn by its name: the same whatever rank has it, and from all kinds that take turns in a list.
fn few(runs: Runs, weights: &[[f64; STATES]], of: usize) -> Result<(RunStore, Vec<[f64; STATES]>), FitError> {
    let mut drawn = RunStore::new(if runs.held() { usize::MAX } else { 0 });
    let mut kept = Vec::new();
    for (run, weights) in runs.iter().zip(weights) {
        if hash(&run.name).is_multiple_of(of as u64) {
            drawn.push(run.into_owned()).map_err(|_| FitError::Unreadable)?;
            kept.push(*weights);
        }
    }
    Ok((drawn, kept))
}

/// A few of the runs for a fit by likelihood, where there are many: those whose names have the lowest hashes, the same in whatever order
/// runs are listed.
pub(in crate::fit) fn drawn(runs: &[Run]) -> Option<Vec<Run>> {
    let few = (runs.len() / SHARE_BY_LIKELIHOOD).max(FEW_BY_LIKELIHOOD);
    let mut order: Vec<usize> = (0..runs.len()).collect();
    order.sort_by_cached_key(|i| (hash(&runs[*i].name), runs[*i].name.clone()));
    order.truncate(few);
    order.sort_unstable();
    (runs.len() >= MANY_BY_LIKELIHOOD).then(|| order.into_iter().map(|i| runs[i].clone()).collect())
}

/// Hash of a text by Fowler, Noll and Vo (FNV-1a, 64 bits), its high half folded into the low one.
fn hash(text: &str) -> u64 {
    let hash = text
        .bytes()
        .fold(0xcbf2_9ce4_8422_2325, |hash: u64, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3));
    hash ^ (hash >> 32)
}

fn cut_run(run: &Run, parts: usize) -> Vec<Run> {
    let steps = run.measured.len().saturating_sub(1);
    if parts < 2 || steps / parts < MIN_STEPS {
        return vec![run.clone()];
    }
    let known = |k: &usize| !run.measured[*k].contains(&None);
    let inner = (1..parts).map(|i| i * steps / parts).filter(known);
    let cuts: Vec<usize> = std::iter::once(0).chain(inner).chain([steps]).collect();
    let piece = |ends: &[usize]| {
        let (from, to) = (ends[0], ends[1]);
        Run {
            inputs: run.inputs[from..=to].to_vec(),
            measured: run.measured[from..=to].to_vec(),
            initial: if from == 0 { run.initial } else { or_nan(&run.measured[from]) },
            ..run.clone()
        }
    };
    cuts.windows(2).map(piece).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::{Split, measured};
    use crate::state::Inputs;
    use std::borrow::Cow;

    fn run(steps: usize) -> Run {
        Run {
            name: "a 100 s".into(),
            recording: "a".into(),
            session: String::new(),
            manoeuvre: String::new(),
            split: Split::Train,
            dt: 0.5,
            recorded_dt: 0.5,
            inputs: (0..=steps).map(|k| Inputs::actuators(100.0 + 0.5 * k as f64, 1.0, 0.0)).collect(),
            measured: measured(&(0..=steps).map(|k| [k as f64; 6]).collect::<Vec<_>>()),
            initial: [-1.0; 6],
            disturbed: Vec::new(),
            derived: [false; STATES],
        }
    }

    fn held(runs: &[Run], weights: &[[f64; STATES]]) -> (Vec<Run>, Vec<[f64; STATES]>) {
        let (pieces, weights) = cut(Runs::from(runs), weights, 2).unwrap();
        (Runs::from(&pieces).iter().map(Cow::into_owned).collect(), weights)
    }

    fn pieces(run: Run) -> Vec<Run> {
        held(&[run], &[[1.0; STATES]]).0
    }

    #[test]
    fn pieces_share_the_sample_at_a_cut_and_start_from_what_was_measured_there() {
        let (pieces, weights) = held(&[run(40), run(8)], &[[1.0; STATES], [2.0; STATES]]);
        assert_eq!(weights, [[1.0; STATES], [1.0; STATES], [2.0; STATES]]);
        assert_eq!(pieces.iter().map(|p| p.measured.len()).collect::<Vec<_>>(), [21, 21, 9]);
        assert_eq!(pieces[0].initial, [-1.0; 6]);
        assert_eq!(pieces[1].initial, [20.0; 6]);
        assert_eq!(pieces[1].measured[0], [Some(20.0); 6]);
        assert_eq!(pieces[1].start_time(), 110.0);
    }

    #[test]
    fn a_run_is_left_whole_where_it_is_short_or_its_state_is_not_known() {
        assert_eq!(pieces(run(19)).len(), 1);
        let mut gap = run(40);
        gap.measured[20][4] = None;
        assert_eq!(pieces(gap).len(), 1);
        let mut unmeasured = run(40);
        unmeasured.measured.iter_mut().for_each(|m| m[4] = None);
        assert_eq!(pieces(unmeasured).len(), 1);
    }

    #[test]
    fn few_runs_are_drawn_by_their_names_whatever_their_order() {
        let named = |i: usize| Run { recording: format!("run {i}"), name: format!("run {i} 0 s"), ..run(20) };
        let runs: Vec<Run> = (0..400).map(named).collect();
        let backwards: Vec<Run> = runs.iter().rev().cloned().collect();
        let names = |runs: &[Run]| {
            let (drawn, weights) = Sample::Few(10).draw(Runs::from(runs), &[[1.0; STATES]; 400]).unwrap();
            let mut names: Vec<String> = Runs::from(&drawn).iter().map(|r| r.name.clone()).collect();
            assert_eq!(names.len(), weights.len());
            names.sort();
            names
        };
        let drawn = names(&runs);
        assert!((20..=60).contains(&drawn.len()), "{drawn:?}");
        assert_eq!(drawn, names(&backwards));
    }

    #[test]
    fn a_fit_by_likelihood_begins_with_the_same_few_runs_in_whatever_order_they_are_listed() {
        let named = |i: usize| Run { name: format!("run {i} 0 s"), ..run(20) };
        let runs: Vec<Run> = (0..40).map(named).collect();
        let backwards: Vec<Run> = runs.iter().rev().cloned().collect();
        let names = |runs: &[Run]| {
            let mut names: Vec<String> = drawn(runs).into_iter().flatten().map(|r| r.name).collect();
            names.sort();
            names
        };
        assert_eq!(names(&runs).len(), 8);
        assert_eq!(names(&runs), names(&backwards));
        assert!(drawn(&runs[..23]).is_none());
    }

    #[test]
    fn stages_double_the_length_of_the_pieces() {
        assert_eq!(falling(8).collect::<Vec<_>>(), [8, 4, 2]);
        assert_eq!(falling(1).count(), 0);
    }
}
