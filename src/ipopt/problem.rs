//! The part of a program that stays fixed during a solve, checked, and the context that the callbacks work on.
//! It calls neither Ipopt nor anything unsafe.

use super::history::DEFAULT_HISTORY;
use super::nlp::{Multipliers, Nlp};
use super::options::{HessianMode, Options};
use super::status::{Counts, IpoptError};

/// What Ipopt gets in place of an infinite bound; it takes anything beyond 1e19 for "none".
const NO_BOUND: f64 = 2e19;

/// The part of an [`Nlp`] that stays fixed during a solve, checked.
pub(super) struct Problem {
    pub(super) variable_lower: Vec<f64>,
    pub(super) variable_upper: Vec<f64>,
    pub(super) constraint_lower: Vec<f64>,
    pub(super) constraint_upper: Vec<f64>,
    pub(super) start: Vec<f64>,
    /// Multipliers to start with, all of them finite and as many as there are bounds.
    pub(super) multipliers: Option<Multipliers>,
    pub(super) jacobian: Vec<(i32, i32)>,
    /// Empty with a limited-memory Hessian.
    pub(super) hessian: Vec<(i32, i32)>,
    pub(super) hessian_mode: HessianMode,
}

impl Problem {
    pub(super) fn of(nlp: &dyn Nlp, options: &Options) -> Result<Self, IpoptError> {
        let (n, m) = (nlp.variables(), nlp.constraints());
        if n == 0 {
            return Err(IpoptError::NoVariables);
        }
        countable("variables", n)?;
        countable("constraints", m)?;

        let (mut variable_lower, mut variable_upper) = (vec![f64::NEG_INFINITY; n], vec![f64::INFINITY; n]);
        nlp.variable_bounds(&mut variable_lower, &mut variable_upper);
        check_bounds("variable", &mut variable_lower, &mut variable_upper)?;
        let (mut constraint_lower, mut constraint_upper) = (vec![f64::NEG_INFINITY; m], vec![f64::INFINITY; m]);
        nlp.constraint_bounds(&mut constraint_lower, &mut constraint_upper);
        check_bounds("constraint", &mut constraint_lower, &mut constraint_upper)?;

        let mut start = vec![0.0; n];
        nlp.start(&mut start);
        if let Some((index, &value)) = start.iter().enumerate().find(|(_, value)| !value.is_finite()) {
            return Err(IpoptError::Start { index, value });
        }

        let fits = |w: &Multipliers| {
            [w.constraints.len(), w.lower.len(), w.upper.len()] == [m, n, n]
                && [&w.constraints, &w.lower, &w.upper].into_iter().all(|values| all_finite(values))
        };
        let multipliers = nlp.multipliers().filter(fits);

        let jacobian = check_structure("Jacobian", &nlp.jacobian_structure(), m, n)?;
        let (hessian, hessian_mode) = match options.hessian {
            HessianMode::Given => match check_structure("Hessian", &nlp.hessian_structure(), n, n)? {
                empty if empty.is_empty() => (empty, HessianMode::LimitedMemory { history: DEFAULT_HISTORY }),
                structure => (structure, HessianMode::Given),
            },
            mode @ HessianMode::LimitedMemory { .. } => (Vec::new(), mode),
        };
        Ok(Self {
            variable_lower,
            variable_upper,
            constraint_lower,
            constraint_upper,
            start,
            multipliers,
            jacobian,
            hessian,
            hessian_mode,
        })
    }

    pub(super) fn variables(&self) -> usize {
        self.variable_lower.len()
    }

    pub(super) fn constraints(&self) -> usize {
        self.constraint_lower.len()
    }
}

fn countable(what: &'static str, count: usize) -> Result<i32, IpoptError> {
    i32::try_from(count).map_err(|_| IpoptError::TooLarge { what, count })
}

/// Refuses bounds that leave no finite value, and turns infinite ones into what Ipopt takes for none.
fn check_bounds(what: &'static str, lower: &mut [f64], upper: &mut [f64]) -> Result<(), IpoptError> {
    for (index, (lower, upper)) in lower.iter_mut().zip(upper.iter_mut()).enumerate() {
        // Negated, so that a NaN is refused too; and a lower bound of +infinity leaves nothing even below an upper one.
        let sensible = *lower <= *upper && *lower < f64::INFINITY && *upper > f64::NEG_INFINITY;
        if !sensible {
            return Err(IpoptError::Bounds { what, index, lower: *lower, upper: *upper });
        }
        *lower = lower.max(-NO_BOUND);
        *upper = upper.min(NO_BOUND);
    }
    Ok(())
}

fn check_structure(
    matrix: &'static str,
    structure: &[(usize, usize)],
    rows: usize,
    columns: usize,
) -> Result<Vec<(i32, i32)>, IpoptError> {
    let what = if matrix == "Hessian" { "Hessian entries" } else { "Jacobian entries" };
    countable(what, structure.len())?;
    let checked = structure.iter().enumerate().map(|(entry, &(row, column))| {
        if row >= rows || column >= columns || (matrix == "Hessian" && column > row) {
            return Err(IpoptError::Structure { matrix, entry, row, column, rows, columns });
        }
        Ok((countable("rows", row)?, countable("columns", column)?))
    });
    checked.collect()
}

/// What the callbacks work on.
pub(super) struct Context<'a> {
    pub(super) nlp: &'a mut dyn Nlp,
    pub(super) problem: Problem,
    /// Whether the start is asked for only to fill the shim's result arrays, before the solve: they get NaN, so that an
    /// answer Ipopt never wrote is distinguished from one it did.
    pub(super) placeholder: bool,
    pub(super) counts: Counts,
    pub(super) iterations: usize,
    /// The first panic caught. From then on every callback refuses without running the caller's code.
    pub(super) panic: Option<String>,
}

impl Context<'_> {
    pub(super) fn objective(&mut self, x: &[f64]) -> Option<f64> {
        self.counts.objective += 1;
        self.nlp.objective(x).filter(|value| value.is_finite())
    }

    pub(super) fn gradient(&mut self, x: &[f64], gradient: &mut [f64]) -> bool {
        self.counts.gradient += 1;
        self.nlp.gradient(x, gradient) && all_finite(gradient)
    }

    pub(super) fn constraint_values(&mut self, x: &[f64], values: &mut [f64]) -> bool {
        self.counts.constraints += 1;
        self.nlp.constraint_values(x, values) && all_finite(values)
    }

    pub(super) fn jacobian_values(&mut self, x: &[f64], values: &mut [f64]) -> bool {
        self.counts.jacobian += 1;
        self.nlp.jacobian_values(x, values) && all_finite(values)
    }

    pub(super) fn hessian_values(&mut self, x: &[f64], factor: f64, multipliers: &[f64], values: &mut [f64]) -> bool {
        self.counts.hessian += 1;
        self.nlp.hessian_values(x, factor, multipliers, values) && all_finite(values)
    }
}

pub(super) fn all_finite(values: &[f64]) -> bool {
    values.iter().all(|value| value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn structures_outside_the_matrix_are_refused() {
        assert_eq!(check_structure("Jacobian", &[(0, 2)], 1, 3), Ok(vec![(0, 2)]));
        let outside = check_structure("Jacobian", &[(0, 0), (1, 0)], 1, 3);
        assert!(matches!(outside, Err(IpoptError::Structure { entry: 1, row: 1, column: 0, .. })));
        let above_the_diagonal = check_structure("Hessian", &[(0, 0), (0, 1)], 2, 2);
        assert!(matches!(above_the_diagonal, Err(IpoptError::Structure { matrix: "Hessian", entry: 1, .. })));
    }
}
