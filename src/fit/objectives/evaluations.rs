//! The last evaluations of one objective, so that a point is evaluated once for all steps of a fit that ask.
//! It computes nothing of its own and decides nothing.

use super::cost::Quadratic;
use super::objective::Objective;
use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;

/// How many points are remembered: start, best and last of a solve, and one to compare with.
const REMEMBERED: usize = 4;

/// An objective and its last evaluations.
pub(in crate::fit) struct Evaluations<'a> {
    /// The objective.
    pub objective: &'a dyn Objective,
    values: RefCell<VecDeque<(Vec<f64>, Option<f64>)>>,
    quadratics: RefCell<VecDeque<Known>>,
}

struct Known {
    p: Vec<f64>,
    with_matrix: bool,
    quadratic: Rc<Quadratic>,
}

fn remember<T>(all: &RefCell<VecDeque<T>>, new: T) {
    let mut all = all.borrow_mut();
    all.truncate(REMEMBERED - 1);
    all.push_front(new);
}

impl<'a> Evaluations<'a> {
    /// Of an objective that was not evaluated yet.
    pub fn of(objective: &'a dyn Objective) -> Self {
        Self { objective, values: RefCell::default(), quadratics: RefCell::default() }
    }

    /// As [`Objective::value`].
    pub fn value(&self, p: &[f64]) -> Option<f64> {
        let beside_derivatives = self.quadratics.borrow().iter().find(|known| known.p == p).map(|k| k.quadratic.value);
        if beside_derivatives.is_some() {
            return beside_derivatives;
        }
        let known = self.values.borrow().iter().find(|(at, _)| at == p).map(|(_, value)| *value);
        known.unwrap_or_else(|| {
            let value = self.objective.value(p);
            remember(&self.values, (p.to_vec(), value));
            value
        })
    }

    /// As [`Objective::quadratic`], with the matrix.
    pub fn quadratic(&self, p: &[f64]) -> Option<Rc<Quadratic>> {
        self.derivatives(p, true)
    }

    /// As [`Objective::quadratic`], perhaps with the matrix.
    pub fn with_gradient(&self, p: &[f64]) -> Option<Rc<Quadratic>> {
        self.derivatives(p, false)
    }

    fn derivatives(&self, p: &[f64], with_matrix: bool) -> Option<Rc<Quadratic>> {
        let serves = |known: &&Known| known.p == p && (known.with_matrix || !with_matrix);
        let known = self.quadratics.borrow().iter().find(serves).map(|known| Rc::clone(&known.quadratic));
        known.or_else(|| {
            let quadratic = Rc::new(self.objective.quadratic(p, with_matrix)?);
            remember(&self.quadratics, Known { p: p.to_vec(), with_matrix, quadratic: Rc::clone(&quadratic) });
            Some(quadratic)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::{Cost, FitSettings};
    use crate::model::Model;
    use crate::physics::Form;
    use crate::recording::{Run, Split, measured};
    use crate::ship::Ship;
    use crate::state::Inputs;
    use std::path::Path;

    #[test]
    fn a_point_is_evaluated_once_and_forgotten_after_a_few_others() {
        let path = format!("{}/experiments/ships/a.toml", env!("CARGO_MANIFEST_DIR"));
        let model = Model::new(Ship::read(Path::new(&path)).unwrap(), "HD", Form::Paper, &[]).unwrap();
        let run = Run {
            name: "straight".into(),
            recording: "straight".into(),
            session: String::new(),
            manoeuvre: String::new(),
            split: Split::Train,
            dt: 1.0,
            recorded_dt: 1.0,
            inputs: (0..20).map(|k| Inputs::actuators(f64::from(k), 2.0, 0.1)).collect(),
            measured: measured(&[[0.0; 6]; 20]),
            initial: [0.0, 0.0, 0.0, 4.0, 0.0, 0.0],
            disturbed: Vec::new(),
            derived: [false; 6],
        };
        let runs = [run];
        let cost = Cost::new(&model, &runs, FitSettings::default().cost_options()).unwrap();
        let evaluations = Evaluations::of(&cost);
        let p: Vec<f64> = cost.free().iter().map(|i| model.parameters[*i].value).collect();
        let first = evaluations.quadratic(&p).unwrap();
        assert!(Rc::ptr_eq(&first, &evaluations.quadratic(&p).unwrap()));
        assert!(Rc::ptr_eq(&first, &evaluations.with_gradient(&p).unwrap()));
        assert_eq!(evaluations.value(&p), Some(first.value));
        for i in 1..=REMEMBERED {
            let moved: Vec<f64> = p.iter().map(|p| p * (1.0 + 1e-3 * i as f64)).collect();
            let gradient = evaluations.with_gradient(&moved).unwrap();
            // A gradient alone does not serve for the matrix.
            assert!(!Rc::ptr_eq(&gradient, &evaluations.quadratic(&moved).unwrap()));
        }
        let again = evaluations.quadratic(&p).unwrap();
        assert!(!Rc::ptr_eq(&first, &again) && first.value == again.value);
    }
}
