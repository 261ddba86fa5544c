//! Small convex quadratic programs: the least of a quadratic function under linear limits, with the multipliers of the limits.
//! It knows matrices alone: no model, no cost, and not where a quadratic function comes from.
//!
//! ```text
//! minimise x^T H x / 2 + g^T x   subject to   n_k^T x >= b_k
//! ```
//!
//! The dual active-set method begins at the minimum without limits and takes in one broken limit after the other; a limit whose
//! multiplier reaches 0 is let go. It needs no feasible start, and limits that depend on each other do it no harm: one that
//! follows from those already taken in is never broken. Source: Goldfarb and Idnani, "A numerically stable dual method for
//! solving strictly convex quadratic programs", Mathematical Programming 27 (1983) 1-33.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// Share of one plus its limit by which a limit may be broken.
const BROKEN: f64 = 1e-11;

/// Square of the sine of the angle between a limit's normal and those already taken in, in the metric of H, below which it counts
/// as one of their combinations.
const DEPENDENT: f64 = 1e-18;

/// Changes of the set of limits, for each limit and variable, after which the search is given up.
const MOST_CHANGES: usize = 10;

/// Where a quadratic function is least under the limits.
pub(super) struct Minimum {
    /// The point.
    pub x: DVector<f64>,
    /// `H x + g = sum_k multiplier_k n_k`, none below 0, by the index of the limit; a limit that is not named has 0.
    pub multipliers: Vec<(usize, f64)>,
}

/// The limits that are held, and the factor of H in whose metric directions are projected.
struct Held<'a> {
    lower: DMatrix<f64>,
    normals: &'a DMatrix<f64>,
    limits: Vec<usize>,
    multipliers: Vec<f64>,
}

/// Which way to go to mend a broken limit.
struct Direction {
    /// Change of the point.
    x: DVector<f64>,
    /// Decrease of the multipliers of the limits that are held.
    multipliers: DVector<f64>,
    /// Change of the broken limit's value; 0 where its normal is a combination of those held.
    rise: f64,
}

/// The minimum under the limits `normals^T x >= bounds`, one column a limit. `None` where H is not positive definite or no point
/// is within all limits.
pub(super) fn minimise(
    h: &DMatrix<f64>,
    g: &DVector<f64>,
    normals: &DMatrix<f64>,
    bounds: &DVector<f64>,
) -> Option<Minimum> {
    let factor: Cholesky<f64, Dyn> = Cholesky::new(h.clone())?;
    let mut x = -factor.solve(g);
    let mut held = Held { lower: factor.unpack(), normals, limits: Vec::new(), multipliers: Vec::new() };
    let mut changes = MOST_CHANGES * (bounds.len() + g.len());
    loop {
        let room = normals.tr_mul(&x) - bounds;
        let broken = |k: usize| room[k] < -BROKEN * (1.0 + bounds[k].abs()) && !held.limits.contains(&k);
        let Some(worst) = (0..bounds.len()).filter(|k| broken(*k)).min_by(|a, b| room[*a].total_cmp(&room[*b])) else {
            let multipliers = held.limits.into_iter().zip(held.multipliers).collect();
            return Some(Minimum { x, multipliers });
        };
        let mut multiplier = 0.0;
        loop {
            changes = changes.checked_sub(1)?;
            let direction = held.direction(worst)?;
            let missing = bounds[worst] - normals.column(worst).dot(&x);
            let whole = if direction.rise > 0.0 { missing / direction.rise } else { f64::INFINITY };
            let first = held.first_let_go(&direction);
            let length = first.map_or(whole, |(_, length)| length.min(whole));
            if !length.is_finite() {
                return None;
            }
            if direction.rise > 0.0 {
                x.axpy(length, &direction.x, 1.0);
            }
            for (u, fall) in held.multipliers.iter_mut().zip(direction.multipliers.iter()) {
                *u = (*u - length * fall).max(0.0);
            }
            multiplier += length;
            match first {
                Some((k, shorter)) if shorter < whole => held.let_go(k),
                _ => break,
            }
        }
        held.limits.push(worst);
        held.multipliers.push(multiplier);
    }
}

impl Held<'_> {
    /// The direction in which the quadratic function grows least as limit `k` is mended and all held limits stay as they are.
    fn direction(&self, k: usize) -> Option<Direction> {
        let own = self.lower.solve_lower_triangular(&self.normals.column(k).into_owned())?;
        let others = self.lower.solve_lower_triangular(&self.normals.select_columns(&self.limits))?;
        let (along, multipliers) = if self.limits.is_empty() {
            (own.clone(), DVector::zeros(0))
        } else {
            let (q, r) = others.qr().unpack();
            let within = q.tr_mul(&own);
            (&own - &q * &within, r.solve_upper_triangular(&within)?)
        };
        let square = along.norm_squared();
        let rise = if square > DEPENDENT * own.norm_squared() { square } else { 0.0 };
        Some(Direction { x: self.lower.tr_solve_lower_triangular(&along)?, multipliers, rise })
    }

    /// The held limit whose multiplier first reaches 0 along a direction, and after what length.
    fn first_let_go(&self, direction: &Direction) -> Option<(usize, f64)> {
        let falls = self.multipliers.iter().zip(direction.multipliers.iter()).enumerate();
        let lengths = falls.filter(|(_, (_, fall))| **fall > 0.0).map(|(k, (u, fall))| (k, u / fall));
        lengths.min_by(|a, b| a.1.total_cmp(&b.1))
    }

    fn let_go(&mut self, k: usize) {
        self.limits.remove(k);
        self.multipliers.remove(k);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    fn vector(values: &[f64]) -> DVector<f64> {
        DVector::from_row_slice(values)
    }

    /// Largest violation of the conditions of an optimum: stationarity, limits, signs, and a multiplier only where a limit holds.
    fn fault(h: &DMatrix<f64>, g: &DVector<f64>, normals: &DMatrix<f64>, bounds: &DVector<f64>, m: &Minimum) -> f64 {
        let mut gradient = h * &m.x + g;
        let room = normals.tr_mul(&m.x) - bounds;
        let mut fault = room.iter().fold(0.0, |worst: f64, room| worst.max(-room));
        for (k, multiplier) in &m.multipliers {
            gradient -= normals.column(*k) * *multiplier;
            fault = fault.max(-multiplier).max((multiplier * room[*k]).abs());
        }
        fault.max(gradient.amax())
    }

    #[test]
    fn the_minimum_of_random_programs_meets_the_conditions_of_an_optimum() {
        let mut random = ChaCha8Rng::seed_from_u64(7);
        let mut draw = || random.random_range(-1.0..1.0);
        for (n, m) in [(1, 2), (3, 0), (3, 5), (6, 40), (12, 100), (25, 60)] {
            for _ in 0..20 {
                let factor = DMatrix::from_fn(n, n, |_, _| draw());
                let h = &factor * factor.transpose() + DMatrix::identity(n, n) * 1e-3;
                let g = DVector::from_fn(n, |_, _| 10.0 * draw());
                let mut normals = DMatrix::from_fn(n, m, |_, _| draw());
                // Limits that are the same twice, and sums of two others.
                if m > 4 {
                    let (first, sum) = (normals.column(0).into_owned(), normals.column(1) + normals.column(2));
                    normals.set_column(3, &first);
                    normals.set_column(4, &sum);
                }
                let inside = DVector::from_fn(n, |_, _| draw());
                let mut bounds = normals.tr_mul(&inside);
                bounds.iter_mut().skip(5).step_by(2).for_each(|b| *b -= 0.5);
                let minimum = minimise(&h, &g, &normals, &bounds).unwrap();
                let fault = fault(&h, &g, &normals, &bounds, &minimum);
                assert!(fault < 1e-7, "{n} variables, {m} limits: {fault:e}");
            }
        }
    }

    #[test]
    fn a_limit_is_let_go_where_another_holds_in_its_place() {
        // Least distance from (2, 1) under x <= 1 and x + y <= 1: the second holds alone.
        let normals = DMatrix::from_columns(&[vector(&[-1.0, 0.0]), vector(&[-1.0, -1.0])]);
        let minimum = minimise(&DMatrix::identity(2, 2), &vector(&[-1.6, -1.0]), &normals, &vector(&[-1.0, -1.0]));
        let minimum = minimum.unwrap();
        assert!((&minimum.x - vector(&[0.8, 0.2])).norm() < 1e-12, "{:?}", minimum.x);
        assert!(matches!(minimum.multipliers[..], [(1, u)] if (u - 0.8).abs() < 1e-12), "{:?}", minimum.multipliers);
    }

    #[test]
    fn limits_that_contradict_each_other_have_no_minimum() {
        let normals = DMatrix::from_columns(&[vector(&[1.0, 0.0]), vector(&[-1.0, 0.0])]);
        let limits = vector(&[1.0, 0.0]);
        assert!(minimise(&DMatrix::identity(2, 2), &vector(&[0.0, 0.0]), &normals, &limits).is_none());
    }
}
