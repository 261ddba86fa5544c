//! How far a finding changes what is predicted, and whether a model follows the recordings better than steady motion would.
//! It compares free simulations with each other and with what was measured; what follows from it is decided elsewhere.

use crate::evaluate::{outcome, steady_motion};
use crate::model::Model;
use crate::recording::Run;
use crate::simulate::Trajectory;
use crate::state::STATES;
use crate::statistics::{mean, positive_rank_share};
use serde::Serialize;
use trimtab_ad::smooth::wrap_angle;

/// Difference of two values of a channel, headings by the shorter way round.
fn difference(channel: usize, a: f64, b: f64) -> f64 {
    if channel == 2 { wrap_angle(a - b) } else { a - b }
}

/// Root mean square difference of two predictions over the root mean square error of the first, in the channel where this is
/// largest; positions count together. Infinite where one of them diverges everywhere, or the first is exact.
pub fn change(runs: &[Run], without: &[Trajectory], with: &[Trajectory]) -> f64 {
    let (mut moved, mut error) = ([0.0; STATES], [0.0; STATES]);
    let mut any = false;
    for (run, (before, after)) in runs.iter().zip(without.iter().zip(with)) {
        if before.diverged_at.is_some() || after.diverged_at.is_some() {
            continue;
        }
        any = true;
        for ((b, a), m) in before.states.iter().zip(&after.states).zip(&run.measured) {
            for c in 0..STATES {
                let Some(m) = m[c] else { continue };
                moved[c] += difference(c, a[c], b[c]).powi(2);
                error[c] += difference(c, m, b[c]).powi(2);
            }
        }
    }
    let share = |moved: f64, error: f64| if moved == 0.0 { 0.0 } else { (moved / error).sqrt() };
    let position = share(moved[0] + moved[1], error[0] + error[1]);
    let largest = (2..STATES).map(|c| share(moved[c], error[c])).fold(position, f64::max);
    if any { largest } else { f64::INFINITY }
}

/// How a model follows recordings, beside steady motion: surge, sway and yaw rate kept as they were at the start of a run.
#[derive(Clone, Debug, Serialize)]
pub struct Following {
    /// Runs that a prediction can be judged on.
    pub runs: usize,
    /// Those of them that the model simulates with a smaller cVDM than steady motion.
    pub better_than_steady: usize,
    /// Mean cVDM of the model \[%\], over the runs on which it does not diverge.
    pub cvdm: Option<f64>,
    /// Mean cVDM of steady motion \[%\], over the same runs.
    pub steady: Option<f64>,
    /// Share of the ranks of the runs, by how far the two cVDM differ, that belongs to runs which the model simulates better; 1 of none. A run
    /// on which the model diverges is the worst.
    pub rank_share: f64,
}

impl Following {
    /// Judges predictions of runs, one a run, by the cVDM that `trimtab evaluate` prints.
    pub fn new(model: &Model, runs: &[Run], predicted: &[Trajectory], max_yaw_rate: f64) -> Self {
        let (mut pairs, mut gains) = (Vec::new(), Vec::new());
        for (run, p) in runs.iter().zip(predicted) {
            let judged = |t: &Trajectory| outcome(run, t, &model.ship, max_yaw_rate).deviation().map(|d| d.cvdm);
            let Some(steady) = judged(&steady_motion(run)) else { continue };
            let own = judged(p);
            gains.push(own.map_or(f64::NEG_INFINITY, |own| steady - own));
            pairs.extend(own.map(|own| (own, steady)));
        }
        let better = gains.iter().filter(|gain| **gain > 0.0).count();
        Self {
            runs: gains.len(),
            better_than_steady: better,
            cvdm: mean(pairs.iter().map(|p| p.0)),
            steady: mean(pairs.iter().map(|p| p.1)),
            rank_share: positive_rank_share(&gains).unwrap_or(1.0),
        }
    }

    /// Whether the runs that the model simulates better than steady motion outweigh the others, so that it is a base on which anything may be
    /// named. They need not be more: on a straight course steady motion is hard to beat, and little is lost where it is not.
    pub fn holds(&self) -> bool {
        self.rank_share >= 0.5
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example::{RK4, model, runs, with};
    use crate::evaluate::predict_all;

    #[test]
    fn a_change_is_measured_in_units_of_the_error_there_is() {
        let truth = with(&[("current.north", 0.4)]);
        let runs = runs(&truth, 6);
        let of = |m: &Model| predict_all(m, &runs, RK4);
        let (without, with) = (of(&model()), of(&truth));
        let right = change(&runs, &without, &with);
        assert!((0.9..1.1).contains(&right), "{right}");
        let half = change(&runs, &without, &of(&super::tests::with(&[("current.north", 0.2)])));
        assert!((0.4..0.6).contains(&half), "{half}");
        assert_eq!(change(&runs, &without, &without), 0.0);
        let lost: Vec<Trajectory> = without.iter().map(|t| Trajectory { diverged_at: Some(3), ..t.clone() }).collect();
        assert_eq!(change(&runs, &without, &lost), f64::INFINITY);
    }

    #[test]
    fn the_model_that_sailed_is_better_than_steady_motion_in_manoeuvres_and_a_wrong_one_is_not() {
        let runs = runs(&model(), 6);
        let following = |m: &Model| Following::new(m, &runs, &predict_all(m, &runs, RK4), 0.0314);
        let right = following(&model());
        assert_eq!((right.runs, right.better_than_steady, right.rank_share), (6, 6, 1.0));
        // A ship whose rudder works the wrong way.
        let wrong = following(&with(&[("rudder.lift1", -3.2)]));
        assert!(wrong.better_than_steady < 3 && !wrong.holds(), "{wrong:?}");
    }

    #[test]
    fn a_model_that_is_better_in_turns_is_a_base_though_steady_motion_is_better_on_most_courses() {
        let turns = runs(&model(), 8);
        let exact = predict_all(&model(), &turns, RK4);
        let course = |run: &Run| {
            let measured = steady_motion(run).states.into_iter().map(|s| s.map(Some)).collect();
            Run { measured, ..run.clone() }
        };
        // On a course the model is one step of the recording behind.
        let behind = |run: &Run| {
            let mut behind = steady_motion(run);
            behind.states.rotate_right(1);
            behind.states[0] = run.initial;
            behind
        };
        let with_courses = |turning: usize| {
            let courses: Vec<Run> = turns.iter().chain(&turns).take(10).map(course).collect();
            let predicted = exact[..turning].iter().cloned().chain(courses.iter().map(behind)).collect::<Vec<_>>();
            let all: Vec<Run> = turns[..turning].iter().cloned().chain(courses).collect();
            Following::new(&model(), &all, &predicted, 0.0314)
        };
        let (many, one) = (with_courses(8), with_courses(1));
        assert!(many.better_than_steady < 9 && many.holds(), "{many:?}");
        // A single turn does not outweigh ten courses.
        assert!(!one.holds(), "{one:?}");
    }
}
