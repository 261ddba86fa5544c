//! Which of the constraint rows the solver gets: a curve that is sampled at a hundred points touches its limit at one or two of them.
//! It solves nothing, and decides nothing of what is feasible: every row counts there.
//!
//! Rows near their limits and every few of the others are taken at first; those that a solution breaks join them, and the solve goes on
//! (an outer approximation, exact as the rows are linear: a point that breaks none of the rows left out solves the whole program).

use super::scaling::Scaling;
use super::task::Task;

/// Of rows far from their limits, every how many the solver gets: they keep its steps from leaving a curve's limits by far.
const EVERY: usize = 8;

/// The rows that the solver gets.
pub(in crate::fit) struct WorkingRows {
    taken: Vec<bool>,
}

impl WorkingRows {
    /// A few of the rows of a task.
    pub fn of(task: &Task) -> Self {
        Self { taken: (0..task.rows.len()).map(|i| i % EVERY == 0).collect() }
    }

    /// Takes the rows that `p` is within `margin` of their limits, in the sizes of the rows; beyond them by more than its negative.
    /// Whether there are new ones.
    pub fn take(&mut self, task: &Task, scaling: &Scaling, p: &[f64], margin: f64) -> bool {
        let mut new = false;
        for ((taken, row), size) in self.taken.iter_mut().zip(&task.rows).zip(&scaling.sizes).filter(|((t, _), _)| !**t)
        {
            let value = row.value(p);
            let room = (value - row.lower).min(row.upper - value);
            *taken = room < margin * size;
            new |= *taken;
        }
        new
    }

    /// Their indices.
    pub fn indices(&self) -> Vec<usize> {
        (0..self.taken.len()).filter(|i| self.taken[*i]).collect()
    }

    /// Multipliers of all rows from those of the solver's: a row left out is not active.
    pub fn of_all(&self, multipliers: &[f64]) -> Vec<f64> {
        let mut own = multipliers.iter();
        self.taken.iter().map(|taken| if *taken { own.next().copied().unwrap_or(0.0) } else { 0.0 }).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example::{RK4, model, runs};
    use crate::fit::{Cost, FitError, FitSettings, fit};

    #[test]
    fn rows_near_a_limit_and_rows_that_are_broken_are_taken_and_none_is_given_back() -> Result<(), FitError> {
        let (model, runs) = (model(), runs(&model(), 3));
        let settings = FitSettings { integration: RK4, ..FitSettings::default() };
        let cost = Cost::new(&model, &runs, settings.cost_options())?;
        let task = Task::new(&model, &cost, (&runs[..]).into(), &settings)?;
        let mut rows = WorkingRows::of(&task);
        let few = rows.indices().len();
        assert!(few > 0 && EVERY * few >= task.rows.len() && few < task.rows.len());
        assert!(!rows.take(&task, &task.scaling, &task.start, f64::NEG_INFINITY));
        assert_eq!(rows.indices().len(), few);
        let mut broken = task.start.clone();
        let free = model.free();
        let drag =
            free.iter().position(|i| model.parameters[*i].name == "rudder.drag0").ok_or(FitError::NothingFree)?;
        broken[drag] = -1.0;
        assert!(rows.take(&task, &task.scaling, &broken, 0.0));
        let out = |i: usize| task.rows[i].violation(&broken) > 0.0;
        assert!((0..task.rows.len()).filter(|i| out(*i)).all(|i| rows.indices().contains(&i)));
        assert!(!rows.take(&task, &task.scaling, &broken, 0.0), "a row is taken once");
        let own: Vec<f64> = (1..=rows.indices().len()).map(|i| i as f64).collect();
        let all = rows.of_all(&own);
        assert!(rows.indices().iter().zip(&own).all(|(i, y)| all[*i] == *y) && all.len() == task.rows.len());
        assert_eq!(all.iter().filter(|y| **y != 0.0).count(), own.len());
        Ok(())
    }

    #[test]
    fn a_limit_that_is_active_between_the_rows_taken_first_is_kept() -> Result<(), FitError> {
        let (truth, runs) = (model(), runs(&model(), 6));
        let mut settings = FitSettings { integration: RK4, ..FitSettings::default() };
        // Between this and the upper limit at a = 0 there is hardly room: a few degrees beside it the drag of the ship breaks this one.
        settings.constraints.drag.lower = Some(0.0499);
        let found = fit(&truth, &runs[..], &settings, &mut |_| true)?;
        assert!(found.converged && found.active.iter().any(|a| a.rule == "drag"), "{}", found.report());
        let cost = Cost::new(&found.model, &runs, settings.cost_options())?;
        let task = Task::new(&found.model, &cost, (&runs[..]).into(), &settings)?;
        assert!(task.is_feasible(&task.start), "{}", found.report());
        Ok(())
    }
}
