//! A generic force law: a basis of smooth forces of state, inputs and heading, as a rival of every name in the catalogue.
//! It is no physics: it says what a free law would explain, and names nothing.

use crate::diagnose::settings::PARAMETER_PRICE;
use crate::likelihood::algebra::pick;
use crate::likelihood::evidence::{Base, Evidence};
use crate::likelihood::filter::Column;
use crate::model::Model;
use nalgebra::{DVector, SymmetricEigen};

/// Where the basis of a generic force law is among the columns.
#[derive(Clone, Debug)]
pub struct GenericLaw {
    /// Columns of the mirror-symmetric basis.
    pub symmetric: Vec<usize>,
    /// Columns of the basis that breaks mirror symmetry or is fixed on the earth.
    pub asymmetric: Vec<usize>,
    /// Dotted names, symmetric then asymmetric.
    names: Vec<String>,
}

impl GenericLaw {
    /// Appends the columns of the basis, symmetric then asymmetric.
    pub fn append(columns: &mut Vec<Column>, model: &Model) -> Self {
        let mut names = Vec::new();
        let mut block = |term: &str| {
            let (start, prefix) = (columns.len(), format!("{term}."));
            for (i, p) in model.parameters.iter().enumerate().filter(|(_, p)| p.name.starts_with(&prefix)) {
                names.push(p.name.clone());
                columns.push(Column::tangent(model, i));
            }
            (start..columns.len()).collect()
        };
        let (symmetric, asymmetric) = (block("symmetric"), block("asymmetric"));
        Self { symmetric, asymmetric, names }
    }

    /// All columns, symmetric then asymmetric.
    pub fn columns(&self) -> Vec<usize> {
        self.symmetric.iter().chain(&self.asymmetric).copied().collect()
    }

    /// Dotted name of one of its columns.
    pub fn name(&self, column: usize) -> Option<&str> {
        self.columns().iter().position(|c| *c == column).map(|i| self.names[i].as_str())
    }
}

/// The base with some columns of a generic law beside it, under a prior that draws them to zero, whose common variance has the
/// highest marginal likelihood; the base alone where the data ask for no such law.
pub fn widen(evidence: &Evidence, base: &Base, columns: &[usize]) -> Base {
    let h = &evidence.total.information;
    let cross = pick(h, columns, &base.columns);
    let own = pick(h, columns, columns) - &cross * &base.inverse * cross.transpose();
    let score = DVector::from_fn(columns.len(), |i, _| evidence.total.score[columns[i]]) - &cross * base.step();
    let eigen = SymmetricEigen::new((&own + own.transpose()) * 0.5);
    let z = eigen.eigenvectors.transpose() * &score;
    let Some(variance) = shrinkage(&eigen.eigenvalues, &z) else { return base.clone() };
    let mut shrunk = Evidence { total: evidence.total.clone(), ..Evidence::default() };
    for c in columns {
        shrunk.total.information[(*c, *c)] += 1.0 / variance;
    }
    shrunk.extend(base, columns)
}

/// The variance of amplitudes `~ N(0, v)` by marginal likelihood, `ln p = sum -ln(1 + v l)/2 + z^2 v / (2 (1 + v l))` with the
/// information `l` and the score `z` along each principal direction; `None` where no variance gains enough over none.
fn shrinkage(information: &DVector<f64>, score: &DVector<f64>) -> Option<f64> {
    let log_marginal = |v: f64| -> f64 {
        information
            .iter()
            .zip(score.iter())
            .map(|(l, z)| {
                let d = 1.0 + v * l.max(0.0);
                -0.5 * d.ln() + 0.5 * z * z * v / d
            })
            .sum()
    };
    let (mut best, mut variance) = (0.0, None);
    for i in 0..=40 {
        let v = 10f64.powf(-8.0 + 0.25 * f64::from(i));
        let value = log_marginal(v);
        if value > best + PARAMETER_PRICE {
            (best, variance) = (value, Some(v));
        }
    }
    variance
}

/// The base model with the best linear generic correction under unit priors: as much as any force law could do.
pub fn corrected(law: &GenericLaw, evidence: &Evidence, base: &Base, model: &Model) -> Model {
    let mut model = model.clone();
    let columns = law.columns();
    let mut shrunk = evidence.clone();
    for c in &columns {
        shrunk.total.information[(*c, *c)] += 1.0;
    }
    let test = shrunk.test(base, &columns);
    for (name, a) in law.names.iter().zip(test.amplitude.iter()) {
        if let Some(i) = model.index(name) {
            model.parameters[i].value += a * model.parameters[i].scale;
        }
    }
    model
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::likelihood::evidence::RunEvidence;
    use nalgebra::DMatrix;

    /// One run of columns that share no information: the score of each, and information 100.
    fn independent(score: &[f64]) -> Evidence {
        let n = score.len();
        Evidence::new(vec![RunEvidence {
            session: "a".into(),
            score: DVector::from_column_slice(score),
            information: DMatrix::from_diagonal_element(n, n, 100.0),
        }])
    }

    #[test]
    fn scores_of_unit_variance_ask_for_no_generic_law_and_large_ones_for_their_own_variance() {
        let l = DVector::from_element(20, 100.0);
        // z^2 / l = 1 is what chance makes.
        assert_eq!(shrinkage(&l, &DVector::from_element(20, 10.0)), None);
        // z^2 / l = 401 has its maximum at v l = 400.
        let v = shrinkage(&l, &DVector::from_element(20, (401.0f64 * 100.0).sqrt())).unwrap_or(0.0);
        assert!(v > 1.5 && v < 8.0, "{v}");
    }

    #[test]
    fn a_base_that_needs_no_generic_law_stays_as_it_is() {
        let e = independent(&[5.0, 10.0, -10.0]);
        let base = e.base(&[0], &[0.0], &[0.0]);
        assert_eq!(widen(&e, &base, &[1, 2]).columns, [0]);
        let e = independent(&[5.0, 900.0, -900.0]);
        assert_eq!(widen(&e, &e.base(&[0], &[0.0], &[0.0]), &[1, 2]).columns, [0, 1, 2]);
    }
}
