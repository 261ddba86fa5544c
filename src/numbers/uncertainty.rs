//! How sure the parameters of a fitted model are: their covariance, as the model file keeps it, and deviations drawn from it.
//! Where a covariance comes from is with those who estimate; what is made of the draws, with those who ask for them.

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{ChiSquared, Distribution, StandardNormal};
use serde::{Deserialize, Serialize};

/// The covariance of the estimates of a model, table `[covariance]` of a model file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Uncertainty {
    /// What it is, in words: `recordings taken as independent`.
    pub kind: String,
    /// Degrees of freedom of the variance behind it; absent where there are so many that they do not matter.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub freedom: Option<usize>,
    /// Dotted names of the parameters.
    pub parameters: Vec<String>,
    /// Parameters that were free and are not in it, as the data do not determine them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub undetermined: Vec<String>,
    /// Why the fit behind it is in doubt, in words; absent where nothing was found.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub doubt: Option<String>,
    /// The covariance: a row a parameter, in their units.
    pub matrix: Vec<Vec<f64>>,
}

impl Uncertainty {
    /// From a covariance with an entry absent where one of two parameters is not determined; nothing where none is.
    pub fn new(kind: &str, freedom: Option<usize>, names: &[String], covariance: &[Vec<Option<f64>>]) -> Option<Self> {
        let known = |i: usize| covariance.get(i).and_then(|row| *row.get(i)?).is_some_and(f64::is_finite);
        let (inside, outside): (Vec<usize>, Vec<usize>) = (0..names.len()).partition(|i| known(*i));
        let named = |list: &[usize]| list.iter().map(|i| names[*i].clone()).collect();
        let entry = |i: &usize, j: &usize| covariance[*i][*j].unwrap_or(0.0);
        let matrix = inside.iter().map(|i| inside.iter().map(|j| entry(i, j)).collect()).collect();
        (!inside.is_empty()).then(|| Self {
            kind: kind.to_owned(),
            freedom,
            parameters: named(&inside),
            undetermined: named(&outside),
            doubt: None,
            matrix,
        })
    }

    /// From standard deviations of parameters that are known independently; nothing where there is none.
    pub fn independent(kind: &str, known: &[(String, f64)]) -> Option<Self> {
        let names: Vec<String> = known.iter().map(|(name, _)| name.clone()).collect();
        let entry = |i: usize, j: usize| Some(if i == j { known[i].1 * known[i].1 } else { 0.0 });
        let table: Vec<Vec<_>> = (0..known.len()).map(|i| (0..known.len()).map(|j| entry(i, j)).collect()).collect();
        Self::new(kind, None, &names, &table)
    }

    /// What is wrong with it, for a model that has the parameters for which `has` is true; nothing if nothing is.
    pub fn fault(&self, has: impl Fn(&str) -> bool) -> Option<String> {
        let n = self.parameters.len();
        if self.matrix.len() != n || self.matrix.iter().any(|row| row.len() != n) {
            return Some(format!("`matrix` of [covariance] must have {n} rows of {n} numbers, one a parameter"));
        }
        let finite = self.matrix.iter().flatten().all(|x| x.is_finite());
        if !finite || (0..n).any(|i| self.matrix[i][i] < 0.0) {
            return Some("`matrix` of [covariance] has a negative variance or an entry that is no number".into());
        }
        let unknown = self.parameters.iter().find(|name| !has(name));
        unknown.map(|name| format!("[covariance] names `{name}`, which the model does not have"))
    }

    /// `count` deviations of the parameters from their estimates, in their units: multivariate Student-t with the degrees of freedom, or
    /// normal where there are none. Equal seeds give equal deviations.
    pub fn deviations(&self, count: usize, seed: u64) -> Vec<Vec<f64>> {
        let n = self.parameters.len();
        if self.fault(|_| true).is_some() {
            return Vec::new();
        }
        // By standard deviations, so that parameters of 1e4 and of 1e-2 are equally exact; a parameter that a constraint fixes has none.
        let sd: Vec<f64> = (0..n).map(|i| self.matrix[i][i].sqrt()).collect();
        let correlation = DMatrix::from_fn(n, n, |i, j| {
            let scale = sd[i] * sd[j];
            if scale > 0.0 { 0.5 * (self.matrix[i][j] + self.matrix[j][i]) / scale } else { 0.0 }
        });
        let eigen = SymmetricEigen::new(correlation);
        let root = eigen.eigenvectors * DMatrix::from_diagonal(&eigen.eigenvalues.map(|e| e.max(0.0).sqrt()));
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let tails = self.freedom.filter(|f| *f > 0).and_then(|f| Some((f as f64, ChiSquared::new(f as f64).ok()?)));
        let mut draw = || -> Vec<f64> {
            let normal = DVector::from_fn(n, |_, _| StandardNormal.sample(&mut rng));
            let tail = tails.as_ref().map_or(1.0, |(f, chi)| (f / chi.sample(&mut rng)).sqrt());
            let step: DVector<f64> = &root * normal * tail;
            step.iter().zip(&sd).map(|(step, sd)| step * sd).collect()
        };
        (0..count).map(|_| draw()).collect()
    }

    /// A deviation brought inside limits: what lies beyond goes to its limit, and the others go along as the covariance has them
    /// (the conditional mean, `d - C_V (C_VV)^-1 (d_V - limit_V)`). By itself it would leave the combinations that are known well.
    pub fn limited(&self, deviation: &[f64], limits: impl Fn(usize) -> [f64; 2]) -> Vec<f64> {
        let n = self.parameters.len();
        let sd: Vec<f64> = (0..n).map(|i| self.matrix[i][i].sqrt()).collect();
        let unit = |i: usize| if sd[i] > 0.0 { sd[i] } else { 1.0 };
        let inside = |i: usize, d: f64| d.clamp(limits(i)[0], limits(i)[1]);
        let (mut out, mut beyond) = (deviation.to_vec(), Vec::new());
        loop {
            let more: Vec<usize> = (0..n).filter(|i| !beyond.contains(i) && inside(*i, out[*i]) != out[*i]).collect();
            if more.is_empty() {
                break;
            }
            beyond.extend(more);
            let count = beyond.len();
            let entry = |i: usize, j: usize| 0.5 * (self.matrix[i][j] + self.matrix[j][i]) / (unit(i) * unit(j));
            let among = DMatrix::from_fn(count, count, |a, b| entry(beyond[a], beyond[b]));
            let excess =
                |a: usize, _: usize| (deviation[beyond[a]] - inside(beyond[a], out[beyond[a]])) / unit(beyond[a]);
            let excess = DVector::from_fn(count, excess);
            let Ok(inverse) = among.pseudo_inverse(f64::EPSILON.sqrt()) else { break };
            let pull = inverse * excess;
            for i in 0..n {
                let moved: f64 = (0..count).map(|a| entry(i, beyond[a]) * pull[a]).sum();
                out[i] = deviation[i] - unit(i) * moved;
            }
            // Exactly, also where two of them are one.
            beyond.iter().for_each(|i| out[*i] = inside(*i, out[*i]));
        }
        (0..n).map(|i| inside(i, out[i])).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example(freedom: Option<usize>) -> Uncertainty {
        let names = ["resistance.linear", "rudder.lift1", "rudder.lift3"].map(str::to_owned);
        let covariance =
            [vec![Some(4e6), Some(60.0), None], vec![Some(60.0), Some(0.01), None], vec![None, None, None]];
        Uncertainty::new("test", freedom, &names, &covariance).unwrap()
    }

    fn product(draws: &[Vec<f64>], i: usize, j: usize) -> f64 {
        draws.iter().map(|d| d[i] * d[j]).sum::<f64>() / draws.len() as f64
    }

    #[test]
    fn deviations_have_the_covariance_and_the_seed_repeats_them() {
        let u = example(None);
        assert_eq!((u.parameters.len(), u.undetermined.as_slice()), (2, &["rudder.lift3".to_owned()][..]));
        let draws = u.deviations(4000, 7);
        assert!((product(&draws, 0, 0) / 4e6 - 1.0).abs() < 0.1 && (product(&draws, 1, 1) / 0.01 - 1.0).abs() < 0.1);
        assert!((product(&draws, 0, 1) / 60.0 - 1.0).abs() < 0.25);
        assert_eq!(draws, u.deviations(4000, 7));
        assert_ne!(draws, u.deviations(4000, 8));
    }

    #[test]
    fn what_a_limit_cuts_off_the_others_follow_by_the_covariance_and_what_is_inside_stays() {
        let u = example(None);
        let limits = |i: usize| if i == 0 { [-1000.0, 1000.0] } else { [-1.0, 1.0] };
        assert_eq!(u.limited(&[900.0, -0.2], limits), [900.0, -0.2]);
        // A thousand of the first is 60 / 4e6 of the second each.
        let cut = u.limited(&[3000.0, 0.1], limits);
        assert!((cut[0] - 1000.0).abs() < 1e-9 && (cut[1] - (0.1 - 2000.0 * 60.0 / 4e6)).abs() < 1e-9, "{cut:?}");
        let both = u.limited(&[3000.0, 5.0], limits);
        assert!((both[0] - 1000.0).abs() < 1e-9 && (both[1] - 1.0).abs() < 1e-9, "{both:?}");
        let apart = Uncertainty::independent("test", &[("a".into(), 2.0), ("b".into(), 3.0)]).unwrap();
        assert_eq!(apart.limited(&[9.0, 1.0], |_| [-4.0, 4.0]), [4.0, 1.0]);
    }

    #[test]
    fn few_degrees_of_freedom_widen_the_deviations() {
        // The variance of Student's t is f / (f - 2).
        let spread = |freedom| product(&example(freedom).deviations(4000, 1), 1, 1);
        assert!((spread(Some(6)) / spread(None) - 1.5).abs() < 0.2);
    }

    #[test]
    fn a_covariance_that_does_not_fit_its_model_is_reported() {
        let mut u = example(None);
        assert_eq!(u.fault(|_| true), None);
        assert!(u.fault(|name| name != "rudder.lift1").unwrap().contains("rudder.lift1"));
        u.matrix.pop();
        assert!(u.fault(|_| true).unwrap().contains("2 rows of 2 numbers"));
        assert!(u.deviations(3, 1).is_empty());
    }
}
