//! The last evaluations of one cost, so that a point is evaluated once for all steps of a fit that ask.
//! It computes nothing of its own and decides nothing.

use super::cost::{Cost, Quadratic};
use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;

/// How many points are remembered: start, best and last of a solve, and one to compare with.
const REMEMBERED: usize = 4;

/// A cost and its last evaluations.
pub(super) struct Evaluations<'a> {
    /// The cost.
    pub cost: &'a Cost<'a>,
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
    /// Of a cost that was not evaluated yet.
    pub fn of(cost: &'a Cost<'a>) -> Self {
        Self { cost, values: RefCell::default(), quadratics: RefCell::default() }
    }

    /// As [`Cost::value`].
    pub fn value(&self, p: &[f64]) -> Option<f64> {
        let beside_derivatives = self.quadratics.borrow().iter().find(|known| known.p == p).map(|k| k.quadratic.value);
        if beside_derivatives.is_some() {
            return beside_derivatives;
        }
        let known = self.values.borrow().iter().find(|(at, _)| at == p).map(|(_, value)| *value);
        known.unwrap_or_else(|| {
            let value = self.cost.value(p);
            remember(&self.values, (p.to_vec(), value));
            value
        })
    }

    /// As [`Cost::quadratic`].
    pub fn quadratic(&self, p: &[f64]) -> Option<Rc<Quadratic>> {
        self.derivatives(p, true)
    }

    /// As [`Cost::with_gradient`], perhaps with the matrix.
    pub fn with_gradient(&self, p: &[f64]) -> Option<Rc<Quadratic>> {
        self.derivatives(p, false)
    }

    fn derivatives(&self, p: &[f64], with_matrix: bool) -> Option<Rc<Quadratic>> {
        let serves = |known: &&Known| known.p == p && (known.with_matrix || !with_matrix);
        let known = self.quadratics.borrow().iter().find(serves).map(|known| Rc::clone(&known.quadratic));
        known.or_else(|| {
            let quadratic = if with_matrix { self.cost.quadratic(p) } else { self.cost.with_gradient(p) };
            let quadratic = Rc::new(quadratic?);
            remember(&self.quadratics, Known { p: p.to_vec(), with_matrix, quadratic: Rc::clone(&quadratic) });
            Some(quadratic)
        })
    }
}
