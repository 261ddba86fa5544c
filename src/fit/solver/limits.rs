//! What ends a fit before its optimum: its limits on iterations, evaluations and time, a caller's request, and a solve without progress.
//! It watches and counts; the best point so far is kept elsewhere.

use crate::fit::settings::FitSettings;
use crate::ipopt::IterationReport;
use crate::ranks::Ranks;
use std::fmt;
use std::time::Instant;

/// Evaluations without progress after which a solve ends.
const PATIENCE: usize = 50;

/// Share by which the cost must fall, and by which violation or gradient must fall, to count as progress.
const LOWER: f64 = 1e-6;
const SMALLER: f64 = 0.1;

/// What ended a solve before its optimum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::fit) enum Stop {
    Caller,
    Iterations(usize),
    Evaluations(usize),
    Seconds(f64),
    NoProgress,
}

impl fmt::Display for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Caller => write!(f, "stopped by the caller before it converged"),
            Self::Iterations(most) => write!(
                f,
                "the limit of {most} iterations was reached: raise max_iterations in [fit], or fix or give priors to parameters that the data \
                 do not determine"
            ),
            Self::Evaluations(most) => write!(
                f,
                "the limit of {most} evaluations was reached: raise max_evaluations in [fit], or fix or give priors to parameters that the \
                 data do not determine"
            ),
            Self::Seconds(most) => write!(
                f,
                "the limit of {most} s was reached: raise max_seconds in [fit], or fit to fewer or shorter runs first"
            ),
            Self::NoProgress => write!(
                f,
                "{PATIENCE} evaluations brought no progress: the point may be as good as rounding allows; otherwise shorten `window`, try \
                 --starts, or give priors to parameters that the data do not determine"
            ),
        }
    }
}

/// The limits of a fit, over all its solves, and how far it is.
pub(in crate::fit) struct Watch<'a> {
    ranks: &'a Ranks,
    clock: Instant,
    most_iterations: usize,
    most_evaluations: usize,
    most_seconds: f64,
    solves: usize,
    iterations: usize,
    evaluations: usize,
    stop: Option<Stop>,
    /// The least cost, violation and gradient of this solve, and the evaluations when one of them last fell.
    least: [f64; 3],
    progressed: usize,
}

impl<'a> Watch<'a> {
    /// The limits of the settings, the clock starting now.
    pub fn new(settings: &FitSettings, ranks: &'a Ranks) -> Self {
        Self {
            ranks,
            clock: Instant::now(),
            most_iterations: settings.max_iterations,
            most_evaluations: settings.max_evaluations,
            most_seconds: settings.max_seconds,
            solves: 0,
            iterations: 0,
            evaluations: 0,
            stop: None,
            least: [f64::INFINITY; 3],
            progressed: 0,
        }
    }

    /// Begins a solve.
    pub fn begin(&mut self) {
        self.solves += 1;
        self.least = [f64::INFINITY; 3];
        self.progressed = self.evaluations;
        if self.stop == Some(Stop::NoProgress) {
            self.stop = None;
        }
    }

    /// Solves so far, the present one included.
    pub fn solves(&self) -> usize {
        self.solves
    }

    /// What ended the present solve, where something did.
    pub fn stop(&self) -> Option<Stop> {
        self.stop
    }

    /// Whether the whole fit has to end.
    pub fn is_over(&self) -> bool {
        self.stop.is_some_and(|stop| stop != Stop::NoProgress)
    }

    /// Evaluations so far.
    pub fn evaluations(&self) -> usize {
        self.evaluations
    }

    /// Counts an evaluation; false where it must not be made any more.
    pub fn evaluates(&mut self) -> bool {
        if self.stop.is_some() {
            return false;
        }
        if self.evaluations >= self.most_evaluations {
            self.stop = Some(Stop::Evaluations(self.most_evaluations));
        } else if self.evaluations >= self.progressed + PATIENCE {
            self.stop = Some(Stop::NoProgress);
        }
        self.evaluations += 1;
        self.stop.is_none()
    }

    /// Notes an iteration after which the caller continues or not; false where the solve must end.
    pub fn goes_on(&mut self, report: &IterationReport, wanted: bool) -> bool {
        if self.stop.is_some() {
            return false;
        }
        let fell = [
            self.least[0].is_infinite() || report.objective < self.least[0] - LOWER * self.least[0].abs(),
            report.inf_pr < (1.0 - SMALLER) * self.least[1],
            report.inf_du < (1.0 - SMALLER) * self.least[2],
        ];
        for ((fell, least), now) in
            fell.iter().zip(&mut self.least).zip([report.objective, report.inf_pr, report.inf_du])
        {
            if *fell {
                *least = now;
                self.progressed = self.evaluations;
            }
        }
        self.iterations += usize::from(report.iteration > 0);
        // Ranks have clocks of their own, and must end together.
        let seconds = self.ranks.largest(&[self.clock.elapsed().as_secs_f64()])[0];
        if !wanted {
            self.stop = Some(Stop::Caller);
        } else if self.iterations >= self.most_iterations {
            self.stop = Some(Stop::Iterations(self.most_iterations));
        } else if seconds >= self.most_seconds {
            self.stop = Some(Stop::Seconds(self.most_seconds));
        }
        self.stop.is_none()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn report(iteration: usize, objective: f64) -> IterationReport {
        IterationReport {
            iteration,
            restoration: false,
            objective,
            inf_pr: 0.0,
            inf_du: 1.0,
            mu: 0.0,
            step: 0.0,
            regularisation: 0.0,
            alpha_du: 1.0,
            alpha_pr: 1.0,
            trials: 1,
        }
    }

    fn watch(settings: &FitSettings) -> Watch<'static> {
        let mut watch = Watch::new(settings, Ranks::one());
        watch.begin();
        watch
    }

    #[test]
    fn each_limit_ends_the_fit_and_says_which_it_was() {
        let few = FitSettings { max_evaluations: 3, ..FitSettings::default() };
        let mut w = watch(&few);
        assert_eq!((0..5).filter(|_| w.evaluates()).count(), 3);
        assert_eq!((w.stop(), w.is_over()), (Some(Stop::Evaluations(3)), true));
        let mut w = watch(&FitSettings { max_iterations: 2, ..FitSettings::default() });
        assert!((0..2).all(|i| w.goes_on(&report(i, 1.0 / f64::from(i as u32 + 1)), true)));
        assert!(!w.goes_on(&report(2, 0.1), true) && w.stop() == Some(Stop::Iterations(2)));
        let mut w = watch(&FitSettings { max_seconds: 1e-9, ..FitSettings::default() });
        assert!(!w.goes_on(&report(0, 1.0), true) && matches!(w.stop(), Some(Stop::Seconds(_))));
        let mut w = watch(&FitSettings::default());
        assert!(!w.goes_on(&report(0, 1.0), false) && w.stop() == Some(Stop::Caller) && !w.evaluates());
    }

    #[test]
    fn a_solve_that_gets_nowhere_ends_after_fifty_evaluations_and_the_next_begins_anew() {
        let mut w = watch(&FitSettings::default());
        assert!(w.goes_on(&report(0, 1.0), true));
        assert_eq!((0..200).filter(|_| w.evaluates()).count(), PATIENCE);
        assert_eq!((w.stop(), w.is_over()), (Some(Stop::NoProgress), false));
        w.begin();
        for i in 0..100 {
            assert!(w.evaluates() && w.goes_on(&report(i, 0.5_f64.powi(i as i32)), true), "{i}");
        }
    }
}
