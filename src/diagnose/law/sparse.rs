//! The few columns of a library that the data ask for: the set with the highest gain in log-likelihood less a price a column.
//! It is algebra on scores and information: it refits nothing, and does not know what a column means.

use crate::diagnose::settings::{IDENTIFIABLE_SHARE, LAW_P};
use crate::likelihood::algebra::pick;
use crate::likelihood::evidence::{Base, Evidence, degrees_of, excess};
use crate::statistics::{chi_squared_p, student_quantile};
use nalgebra::{DMatrix, DVector};

/// A library of columns once the base is profiled out.
struct Library {
    /// Efficient score.
    score: DVector<f64>,
    /// Efficient information.
    information: DMatrix<f64>,
    /// Information of each column by itself, before the base is profiled out.
    own: Vec<f64>,
    /// Efficient score by group of runs.
    groups: Vec<DVector<f64>>,
    /// Price of a column whose scores scatter no more than their information says.
    price: f64,
}

/// The price of a column in a library of `size`, in log-likelihood: `ln(size/p)` (PASTIS: Gerardos & Ronceray 2025, arXiv 2501.10339),
/// with p = [`LAW_P`]. Among so many superfluous columns, whose scores are normal with the variance that is used, fewer than p on
/// average gain as much by chance. That variance is itself estimated from groups of runs: the price is that at which Student's t with
/// its degrees of freedom is as improbable as the normal score is at `ln(size/p)`.
fn price(size: usize, degrees: f64) -> f64 {
    let chance = chi_squared_p(2.0 * (size as f64 / LAW_P).ln(), 1);
    0.5 * student_quantile(1.0 - 0.5 * chance, degrees).powi(2)
}

impl Library {
    fn new(evidence: &Evidence, base: &Base, columns: &[usize], groups: &[&str]) -> Self {
        let h = &evidence.total.information;
        let cross = pick(h, columns, &base.columns);
        let take_over = &cross * &base.inverse;
        let efficient = |score: &DVector<f64>, of_base: &DVector<f64>| {
            DVector::from_fn(columns.len(), |i, _| score[columns[i]]) - &take_over * of_base
        };
        let sums = evidence.sums_of(groups);
        let of_group =
            |g: &DVector<f64>| efficient(g, &DVector::from_fn(base.columns.len(), |i, _| g[base.columns[i]]));
        let information = pick(h, columns, columns) - &take_over * cross.transpose();
        Self {
            score: efficient(&evidence.total.score, &base.score),
            information: (&information + information.transpose()) * 0.5,
            own: columns.iter().map(|c| h[(*c, *c)]).collect(),
            groups: sums.iter().map(of_group).collect(),
            price: price(columns.len(), degrees_of(sums.len())),
        }
    }

    /// What a set of columns is worth: its gain in log-likelihood, less the price of every column times the square of the factor by
    /// which its error is larger than its information says. `None` where the data cannot distinguish its columns from each other or from
    /// the base.
    fn worth(&self, set: &[usize]) -> Option<f64> {
        let unit: Vec<f64> = set.iter().map(|i| 1.0 / self.own[*i].sqrt()).collect();
        let scaled = pick(&self.information, set, set).map_with_location(|i, j, v| v * unit[i] * unit[j]);
        let inverse = scaled.cholesky()?.inverse();
        let identifiable = |i: usize| inverse[(i, i)] > 0.0 && inverse[(i, i)] * IDENTIFIABLE_SHARE < 1.0;
        if !(0..set.len()).all(identifiable) {
            return None;
        }
        let part = |score: &DVector<f64>| DVector::from_fn(set.len(), |i, _| score[set[i]] * unit[i]);
        let score = part(&self.score);
        let sums: Vec<DVector<f64>> = self.groups.iter().map(part).collect();
        let gain = 0.5 * score.dot(&(&inverse * &score));
        let prices: f64 = excess(&inverse, &sums).iter().map(|f| self.price * f * f).sum();
        Some(gain - prices).filter(|w| w.is_finite())
    }

    /// The sets that differ from one by a column more, a column less, or a column in another's place.
    fn neighbours(&self, set: &[usize]) -> Vec<Vec<usize>> {
        let outside: Vec<usize> = (0..self.own.len()).filter(|c| !set.contains(c)).collect();
        let without = |i: usize| [&set[..i], &set[i + 1..]].concat();
        let more = |set: &[usize], c: &usize| [set, &[*c]].concat();
        let mut all: Vec<Vec<usize>> = outside.iter().map(|c| more(set, c)).collect();
        for i in 0..set.len() {
            all.push(without(i));
            all.extend(outside.iter().map(|c| more(&without(i), c)));
        }
        all
    }
}

/// The columns of a library that the data ask for, in the order of the library: from none on, the best of all moves (a column more, a
/// column less, a column in another's place) while one gains. The worth rises with every move, so that the search ends. `groups` names
/// that of each run, between which scores may scatter more than their information says.
pub fn select(evidence: &Evidence, base: &Base, columns: &[usize], groups: &[&str]) -> Vec<usize> {
    let library = Library::new(evidence, base, columns, groups);
    let (mut set, mut worth) = (Vec::new(), 0.0);
    loop {
        let valued = library.neighbours(&set).into_iter().filter_map(|s| Some((library.worth(&s)?, s)));
        match valued.max_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((better, next)) if better > worth => (set, worth) = (next, better),
            _ => break,
        }
    }
    set.sort_unstable();
    set.into_iter().map(|i| columns[i]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::likelihood::evidence::RunEvidence;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    /// As many monomials as the generic force law has.
    const LIBRARY: usize = 49;

    /// What recordings are made of: two columns of a base and a library, in recordings of four runs.
    struct Study {
        /// Recordings, cut into four runs each.
        recordings: usize,
        /// Correlation of neighbouring columns.
        correlation: f64,
        /// Error that is common to the runs of a recording, over that of a run; the information leaves it out.
        common: f64,
        /// True coefficients of the library.
        truth: Vec<(usize, f64)>,
    }

    impl Study {
        fn null(recordings: usize, correlation: f64, common: f64) -> Self {
            Self { recordings, correlation, common, truth: Vec::new() }
        }

        /// The columns that are selected of the library, on one draw.
        fn selected(&self, seed: u64) -> Vec<usize> {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
            let n = LIBRARY + 2;
            let (mut runs, mut groups) = (Vec::new(), Vec::new());
            for recording in 0..self.recordings {
                let common = DVector::from_fn(n, |_, _| self.common * 2.0 * normal());
                for _ in 0..4 {
                    let x = self.columns(n, &mut normal);
                    let law = |i: usize| self.truth.iter().map(|(c, b)| x[(i, c + 2)] * b).sum::<f64>();
                    // The base's own columns act too.
                    let y = DVector::from_fn(x.nrows(), |i, _| 0.3 * x[(i, 0)] - x[(i, 1)] + law(i) + normal());
                    let score = x.transpose() * y + &common;
                    runs.push(RunEvidence { session: "a".into(), score, information: x.transpose() * x });
                    groups.push(recording.to_string());
                }
            }
            let evidence = Evidence::new(runs);
            let columns: Vec<usize> = (2..n).collect();
            let groups: Vec<&str> = groups.iter().map(String::as_str).collect();
            let chosen = select(&evidence, &evidence.base(&[0, 1], &[0.0; 2], &[0.0; 2]), &columns, &groups);
            chosen.into_iter().map(|c| c - 2).collect()
        }

        /// Samples of one run, each column like the one before it.
        fn columns(&self, n: usize, normal: &mut impl FnMut() -> f64) -> DMatrix<f64> {
            let mut x = DMatrix::from_fn(20, n, |_, _| normal());
            let rest = (1.0 - self.correlation * self.correlation).sqrt();
            for j in 1..n {
                let before = x.column(j - 1) * self.correlation;
                let own = x.column(j) * rest;
                x.set_column(j, &(before + own));
            }
            x
        }

        /// False columns of the library a draw, over so many draws.
        fn false_columns(&self, draws: u64) -> f64 {
            let is_false = |c: &usize| self.truth.iter().all(|(t, _)| t != c);
            let count = |seed: u64| self.selected(seed).iter().filter(|c| is_false(c)).count();
            (0..draws).map(count).sum::<usize>() as f64 / draws as f64
        }
    }

    #[test]
    fn the_price_is_the_logarithm_of_the_library_over_p_and_is_higher_the_fewer_the_groups() {
        assert!((price(49, 1e4) - (49.0 / LAW_P).ln()).abs() < 0.01);
        assert!(price(49, 7.0) > price(49, 29.0) && price(49, 29.0) > price(49, 1e4));
        // t = 5.408 leaves 0.1 % beyond it with seven degrees of freedom, z = 3.2905 of a normal variable.
        let size = LAW_P * (0.5f64 * 3.290_527 * 3.290_527).exp();
        let of =
            |size: f64| 0.5 * student_quantile(1.0 - 0.5 * chi_squared_p(2.0 * (size / LAW_P).ln(), 1), 7.0).powi(2);
        assert!((of(size) - 0.5 * 5.407_883 * 5.407_883).abs() < 1e-3, "{}", of(size));
    }

    #[test]
    fn nulls_give_fewer_false_columns_than_p_whether_columns_are_alike_or_runs_of_a_recording_err_alike() {
        for (recordings, correlation, common) in
            [(8, 0.0, 0.0), (30, 0.0, 0.0), (30, 0.9, 0.0), (8, 0.7, 3.0), (30, 0.7, 3.0)]
        {
            let rate = Study::null(recordings, correlation, common).false_columns(300);
            println!(
                "{recordings} recordings, correlation {correlation}, common error {common}: {rate} false a library"
            );
            assert!(rate <= LAW_P, "{recordings} recordings, correlation {correlation}, common error {common}: {rate}");
        }
    }

    #[test]
    fn a_known_pair_of_columns_is_found_without_false_ones() {
        for correlation in [0.0, 0.7] {
            let study = Study { truth: vec![(7, 0.6), (30, -0.6)], ..Study::null(30, correlation, 0.0) };
            let found = (0..50).filter(|seed| study.selected(*seed) == [7, 30]).count();
            assert!(found >= 47, "{found} of 50 with correlation {correlation}");
        }
    }

    #[test]
    fn a_column_that_only_stood_for_two_others_gives_way_to_them() {
        // The column between the true ones is like both, and the first to be taken.
        let study = Study { truth: vec![(10, 0.5), (12, 0.5)], ..Study::null(30, 0.9, 0.0) };
        let found = (0..50).filter(|seed| study.selected(*seed) == [10, 12]).count();
        assert!(found >= 45, "{found} of 50");
    }

    #[test]
    fn columns_that_nothing_distinguishes_from_the_base_or_from_each_other_are_not_taken_twice() {
        // The second column is the base's own, the fourth is the third, the fifth was not recorded.
        let x = DMatrix::from_fn(40, 3, |i, j| (1.3 * i as f64 + 2.1 * (j * j) as f64 + 0.7 * (i * j) as f64).sin());
        let y = DVector::from_fn(40, |i, _| 5.0 * x[(i, 1)]);
        let of = [0, 0, 1, 1];
        let column = |j: usize| x.column(of[j]);
        let information = DMatrix::from_fn(5, 5, |i, j| if i.max(j) == 4 { 0.0 } else { column(i).dot(&column(j)) });
        let score = DVector::from_fn(5, |i, _| if i == 4 { f64::NAN } else { column(i).dot(&y) });
        let evidence = Evidence::new(vec![RunEvidence { session: "a".into(), score, information }]);
        let base = evidence.base(&[0], &[0.0], &[0.0]);
        assert_eq!(select(&evidence, &base, &[1, 2, 3, 4], &["a"]).len(), 1);
        assert!(select(&evidence, &base, &[], &["a"]).is_empty());
    }
}
