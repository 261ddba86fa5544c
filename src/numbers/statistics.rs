//! The statistics that every judgement uses: quantiles, tails, shares, the bootstrap over clusters, cluster-robust variance.
//! No ship is in it: the caller says what is counted, compared or resampled.

use crate::ranks::{ExactSums, Ranks};
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use serde::Serialize;
use statrs::distribution::{ChiSquared, ContinuousCDF, FisherSnedecor, Normal, StudentsT};

/// Mean of the finite values; `None` of nothing.
pub fn mean(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0_usize);
    for value in values.into_iter().filter(|v| v.is_finite()) {
        sum += value;
        count += 1;
    }
    (count > 0).then(|| sum / count as f64)
}

/// Sample variance, of two values or more.
pub fn variance(values: &[f64]) -> Option<f64> {
    let m = mean(values.iter().copied()).filter(|_| values.len() > 1)?;
    Some(values.iter().map(|v| (v - m).powi(2)).sum::<f64>() / (values.len() - 1) as f64)
}

/// Median of the finite values, the mean of the two in the middle for an even number; `None` of nothing.
pub fn median(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.into_iter().filter(|v| v.is_finite()).collect();
    if values.is_empty() {
        return None;
    }
    let (odd, half) = (values.len() % 2 == 1, values.len() / 2);
    let (below, middle, _) = values.select_nth_unstable_by(half, f64::total_cmp);
    let next = below.iter().copied().max_by(f64::total_cmp).filter(|_| !odd);
    Some(next.map_or(*middle, |next| 0.5 * (next + *middle)))
}

/// Value below which a share (0 to 1) of the sorted values lies, by linear interpolation; `None` of nothing.
pub fn quantile(sorted: &[f64], share: f64) -> Option<f64> {
    let last = sorted.len().checked_sub(1)?;
    let position = share * last as f64;
    let (below, above) = (sorted[position.floor() as usize], sorted[position.ceil() as usize]);
    Some(below + (above - below) * position.fract())
}

/// Upper tail of chi-squared; 1 for no degrees of freedom. Underflows to the smallest positive number, not to zero.
pub fn chi_squared_p(statistic: f64, degrees: usize) -> f64 {
    if degrees == 0 || !statistic.is_finite() {
        return 1.0;
    }
    ChiSquared::new(degrees as f64).map_or(1.0, |d| d.sf(statistic.max(0.0)).max(f64::MIN_POSITIVE))
}

/// Upper tail of a quadratic form in `directions` standard normal values whose variance was estimated from `degrees` independent ones:
/// of `directions` times Fisher's F. Tends to [`chi_squared_p`] for many degrees; 1 without directions or degrees.
pub fn scattered_p(statistic: f64, directions: usize, degrees: f64) -> f64 {
    if !statistic.is_finite() {
        return 1.0;
    }
    let f = statistic.max(0.0) / directions.max(1) as f64;
    FisherSnedecor::new(directions as f64, degrees).map_or(1.0, |d| d.sf(f).max(f64::MIN_POSITIVE))
}

/// Value that a standard normal variable stays below with a probability.
pub fn normal_quantile(probability: f64) -> f64 {
    Normal::standard().inverse_cdf(probability)
}

/// Value that Student's t stays below with a probability.
pub fn student_quantile(probability: f64, degrees: f64) -> f64 {
    StudentsT::new(0.0, 1.0, degrees).map_or_else(|_| normal_quantile(probability), |t| t.inverse_cdf(probability))
}

/// Probability that Student's t is as far from zero as this, to either side; 1 of what is not a number. Underflows to the smallest positive
/// number, not to zero.
pub fn student_p(t: f64, degrees: f64) -> f64 {
    if t.is_nan() {
        return 1.0;
    }
    StudentsT::new(0.0, 1.0, degrees).map_or(1.0, |d| (2.0 * d.sf(t.abs())).max(f64::MIN_POSITIVE))
}

/// How many clusters of equal size those of some sizes count as, `(sum x)^2/sum x^2` (Kish 1965, Survey Sampling, section 11.7); not a number
/// without any.
pub fn counted(sizes: impl IntoIterator<Item = f64>) -> f64 {
    let (sum, squares) = sizes.into_iter().fold((0.0, 0.0), |(sum, squares), x| (sum + x, squares + x * x));
    sum * sum / squares
}

/// The 95 % interval of `q = sum y/sum x` over independent clusters, each a pair (y, x) whose y is expected in proportion to its size
/// x >= 0. With h the share of a cluster in all sizes, the variance of `sum y` given the sizes is `sum (y - q x)^2/(1 - h)` (Bell & McCaffrey
/// 2002, Survey Methodology 28, p. 169), and Student's t has `1/sum h^2 - 1` degrees of freedom: clusters of unequal size count as fewer
/// (Carter, Schnepel & Steigerwald 2017, Rev. Economics and Statistics 99, p. 698). For equal sizes it is the interval of a mean.
/// `None` of fewer than three clusters, and where they count as fewer than two.
pub fn interval_of_ratio(clusters: &[(f64, f64)]) -> Option<[f64; 2]> {
    let size: f64 = clusters.iter().map(|c| c.1).sum();
    let counted = counted(clusters.iter().map(|c| c.1));
    if clusters.len() < FEWEST_CLUSTERS || counted.is_nan() || counted < FEWEST_COUNTED {
        return None;
    }
    let q = clusters.iter().map(|c| c.0).sum::<f64>() / size;
    let variance: f64 = clusters.iter().map(|(y, x)| (y - q * x).powi(2) / (1.0 - x / size)).sum();
    let half = student_quantile(0.975, counted - 1.0) * variance.sqrt() / size;
    Some([q - half, q + half]).filter(|ends| ends.iter().all(|e| e.is_finite()))
}

/// The 95 % interval of `sum y` over clusters as [`interval_of_ratio`] takes them.
pub fn interval_of_sum(clusters: &[(f64, f64)]) -> Option<[f64; 2]> {
    let size: f64 = clusters.iter().map(|c| c.1).sum();
    interval_of_ratio(clusters).map(|ends| ends.map(|e| e * size))
}

/// Share of the ranks that belongs to differences above zero, of all differences ranked by their size (Wilcoxon 1945, Biometrics Bulletin 1,
/// p. 80): above a half where these prevail, in number and size. Differences of one size share their ranks, those of zero have none; `None`
/// where all are zero.
pub fn positive_rank_share(differences: &[f64]) -> Option<f64> {
    let mut sorted: Vec<f64> = differences.iter().copied().filter(|d| *d != 0.0).collect();
    sorted.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
    let (mut positive, mut all, mut before) = (0.0, 0.0, 0);
    for alike in sorted.chunk_by(|a, b| a.abs() == b.abs()) {
        let rank = before as f64 + 0.5 * (alike.len() + 1) as f64;
        positive += rank * alike.iter().filter(|d| **d > 0.0).count() as f64;
        all += rank * alike.len() as f64;
        before += alike.len();
    }
    (all > 0.0).then(|| positive / all)
}

/// A p-value once it is the least of so many that were looked at (Bonferroni).
pub fn corrected(p: f64, tried: f64) -> f64 {
    (p * tried).min(1.0)
}

/// Chance that the largest of n normal values is as far above the others (Grubbs 1969, Technometrics 11, p. 1, one-sided):
/// n times the upper tail of Student's t of its distance from the mean of the others, with n - 2 degrees of freedom. 1 for fewer than
/// three values, and where one is not finite; the smallest positive number where the others are all alike.
pub fn outlier_p(values: &[f64]) -> f64 {
    let n = values.len() as f64;
    let Some(last) = (0..values.len()).max_by(|i, j| values[*i].total_cmp(&values[*j])) else { return 1.0 };
    let others: Vec<f64> = (0..values.len()).filter(|i| *i != last).map(|i| values[i]).collect();
    let (Some(centre), Some(variance)) = (mean(others.iter().copied()), variance(&others)) else { return 1.0 };
    let far = values[last] - centre;
    if !values.iter().all(|v| v.is_finite()) || far <= 0.0 {
        return 1.0;
    }
    let t = far / (variance * n / (n - 1.0)).sqrt();
    StudentsT::new(0.0, 1.0, n - 2.0).map_or(1.0, |d| corrected(d.sf(t).max(f64::MIN_POSITIVE), n))
}

/// How many of n values may stand apart together ([`furthest`]): one in four, and three at most.
pub fn most_apart(n: usize) -> usize {
    (n / 4).clamp(1, 3)
}

/// Which of n normal values is furthest from the others to either side, and the chance of that. Values that stand apart hide one another:
/// one is compared without those that are further still, up to [`most_apart`] of them, and the least chance counts, times the number of
/// comparisons (Rosner 1983, Technometrics 25, p. 165; each of them Grubbs's, [`outlier_p`] on both sides).
pub fn furthest(values: &[f64]) -> Option<(usize, f64)> {
    let most = most_apart(values.len());
    let mut left: Vec<(usize, f64)> = values.iter().copied().enumerate().collect();
    let mut first: Option<(usize, f64)> = None;
    for _ in 0..most {
        let signed = |sign: f64| left.iter().map(|(_, v)| sign * v).collect::<Vec<f64>>();
        let of = |v: &[f64]| Some(((0..v.len()).max_by(|i, j| v[*i].total_cmp(&v[*j]))?, corrected(outlier_p(v), 2.0)));
        let (up, down) = (of(&signed(1.0))?, of(&signed(-1.0))?);
        let (place, p) = if up.1 <= down.1 { up } else { down };
        let (index, _) = left.remove(place);
        let (_, least) = first.get_or_insert((index, 1.0));
        *least = least.min(corrected(p, most as f64));
    }
    first
}

/// Chance that two samples of normal values of one variance have means so far apart, to either side: Student's t with the pooled variance
/// (Student 1908). 1 where one has fewer than two values, and where no value differs from another.
pub fn means_differ_p(a: &[f64], b: &[f64]) -> f64 {
    let (Some(means), Some(variances)) = (
        mean(a.iter().copied()).zip(mean(b.iter().copied())),
        variance(a).zip(variance(b)).filter(|_| a.len() > 1 && b.len() > 1),
    ) else {
        return 1.0;
    };
    let [m, n] = [a, b].map(|v| v.len() as f64);
    let pooled = ((m - 1.0) * variances.0 + (n - 1.0) * variances.1) / (m + n - 2.0);
    let t = (means.0 - means.1).abs() / (pooled * (1.0 / m + 1.0 / n)).sqrt();
    if t.is_finite() { student_p(t, m + n - 2.0) } else { 1.0 }
}

/// The variance of a sum of scores over c clusters, `c/(c-1) sum_c g_c g_c^T` with `g_c` the sum of the scores of cluster c (Liang &
/// Zeger 1986, Biometrika 73, p. 13), and c; `n` is the length of a score. The clusters are those of all ranks, each with whole
/// ones. A score that is not finite leaves zeros.
pub fn clustered_variance(ranks: &Ranks, clusters: &[DVector<f64>], n: usize) -> (DMatrix<f64>, usize) {
    let mut sums = ExactSums::new(n * n);
    for g in clusters {
        (g * g.transpose()).iter().enumerate().for_each(|(i, x)| sums.add(i, *x));
    }
    let [count] = ranks.counts([clusters.len()]);
    let sum = ranks.total(sums).map_or_else(|| DMatrix::zeros(n, n), |sum| DMatrix::from_vec(n, n, sum));
    let c = count as f64;
    (if c > 1.0 { sum * (c / (c - 1.0)) } else { sum }, count)
}

/// A share of so many cases, with its Wilson score interval at 95 %.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Share {
    /// Cases that did.
    pub hits: usize,
    /// All cases.
    pub of: usize,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Share {
    /// Counts the true among those that are known; `None` when there are none.
    pub fn of(cases: impl IntoIterator<Item = Option<bool>>) -> Option<Self> {
        let known: Vec<bool> = cases.into_iter().flatten().collect();
        let hits = known.iter().filter(|b| **b).count();
        (!known.is_empty()).then(|| Self::new(hits, known.len()))
    }

    /// `hits` of `of` > 0 cases.
    pub fn new(hits: usize, of: usize) -> Self {
        let (n, p, z) = (of as f64, hits as f64 / of as f64, 1.959_964);
        let centre = p + z * z / (2.0 * n);
        let half = z * (p * (1.0 - p) / n + z * z / (4.0 * n * n)).sqrt();
        let whole = 1.0 + z * z / n;
        Self { hits, of, low: ((centre - half) / whole).max(0.0), high: ((centre + half) / whole).min(1.0) }
    }

    /// The share itself.
    pub fn value(&self) -> f64 {
        self.hits as f64 / self.of as f64
    }
}

impl std::fmt::Display for Share {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [p, a, b] = [self.value(), self.low, self.high].map(|v| 100.0 * v);
        // A few of many are not none, and all but a few are not all.
        let decimals = usize::from(self.hits > 0 && p < 0.5 || self.hits < self.of && p >= 99.5);
        write!(f, "{p:.decimals$} % ({a:.0} to {b:.0}) of {}", self.of)
    }
}

/// A bootstrap over clusters: whole clusters are drawn, since what is in one shares what is unknown, and every statistic is
/// asked of the same draws.
pub struct Bootstrap<'a> {
    draws: Vec<Vec<usize>>,
    ranks: &'a Ranks,
}

/// Fewest draws from which the ends of an interval are taken: of fewer they are single draws.
const FEWEST_DRAWS: usize = 100;
/// Fewest clusters that have an interval: of fewer it would only seem to say something.
const FEWEST_CLUSTERS: usize = 3;
/// Fewest clusters that clusters of unequal size must count as: two leave Student's t one degree of freedom.
const FEWEST_COUNTED: f64 = 2.0;

impl<'a> Bootstrap<'a> {
    /// So many draws of as many clusters as there are.
    pub fn new(clusters: usize, resamples: usize, seed: u64) -> Self {
        Self::over(Ranks::one(), clusters, resamples, seed)
    }

    /// As [`Self::new`], with the draws divided among the ranks: each asks for the same intervals in the same order.
    pub fn over(ranks: &'a Ranks, clusters: usize, resamples: usize, seed: u64) -> Self {
        let resamples = if clusters < FEWEST_CLUSTERS { 0 } else { resamples };
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let draws = (0..resamples).map(|_| (0..clusters).map(|_| random.random_range(0..clusters)).collect());
        Self { draws: draws.collect(), ranks }
    }

    /// The 95 % percentile interval of a statistic of drawn clusters; `None` where too few draws have one.
    pub fn interval(&self, statistic: impl Fn(&[usize]) -> Option<f64> + Sync) -> Option<[f64; 2]> {
        let own = &self.draws[self.ranks.share(self.draws.len())];
        let own: Vec<f64> = own.par_iter().filter_map(|d| statistic(d)).filter(|v| v.is_finite()).collect();
        let mut drawn = self.ranks.gather(&own).concat();
        drawn.sort_by(f64::total_cmp);
        let at = |share: f64| drawn[((drawn.len() - 1) as f64 * share).round() as usize];
        (drawn.len() >= FEWEST_DRAWS).then(|| [at(0.025), at(0.975)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_value_that_stands_apart_to_either_side_is_found_and_means_that_differ_are_improbable() {
        let apart = |v: &[f64]| furthest(v).unwrap();
        let (above, p) = apart(&[1.0, 1.2, 0.8, 1.1, 9.0]);
        assert!(above == 4 && p < 1e-3);
        let (below, same) = apart(&[-1.0, -1.2, -0.8, -1.1, -9.0]);
        assert!(below == 4 && (p - same).abs() < 1e-12 * p);
        assert!(apart(&[1.0, 1.2, 0.8, 1.1]).1 > 0.1 && furthest(&[]).is_none());
        // Three that hide one another, and as many values without them.
        let mut many: Vec<f64> = (0..24).map(|i| f64::from(i % 5) - 2.0).collect();
        assert!(apart(&many).1 > 0.1);
        (many[3], many[11], many[17]) = (-9.0, -8.8, -8.6);
        let (index, p) = apart(&many);
        let hidden = outlier_p(&many.iter().map(|v| -v).collect::<Vec<_>>());
        assert!(index == 3 && p < 2e-3 && hidden > 1e-2, "{index} {p} {hidden}");
        assert!(means_differ_p(&[1.0, 1.1, 0.9], &[1.0, 1.05, 0.9]) > 0.5);
        assert!(means_differ_p(&[1.0, 1.1, 0.9], &[5.0, 5.1, 4.9]) < 1e-4);
        // Student's t of 2 with 4 degrees of freedom, two-sided.
        let t2 = [0.0, 1.0, 2.0].map(|x| x + 2.0 * (2.0_f64 / 3.0).sqrt());
        assert!((means_differ_p(&[0.0, 1.0, 2.0], &t2) - 0.116_117).abs() < 1e-5);
        assert_eq!(means_differ_p(&[1.0], &[2.0, 3.0]), 1.0);
    }

    #[test]
    fn the_interval_of_a_sum_over_clusters_of_one_size_is_that_of_students_t() {
        // Mean 2, standard deviation 1, three values: t = 4.3027.
        let of_size = |size: f64| [1.0, 2.0, 3.0].map(|y| (y, size));
        let half = 4.302_652_73 * 3f64.sqrt();
        for size in [1.0, 250.0] {
            let [low, high] = interval_of_sum(&of_size(size)).unwrap();
            assert!((low - (6.0 - half)).abs() < 1e-6 && (high - (6.0 + half)).abs() < 1e-6, "{low} {high}");
        }
        assert!(interval_of_sum(&[(1.0, 1.0), (2.0, 1.0)]).is_none());
    }

    #[test]
    fn what_goes_with_the_size_of_a_cluster_has_no_scatter_and_one_large_cluster_has_no_interval() {
        let in_proportion = [2.0, 20.0, 6.0, 10.0].map(|size| (0.4 * size, size));
        let ends = interval_of_ratio(&in_proportion).unwrap();
        assert!(ends.iter().all(|e| (e - 0.4).abs() < 1e-12), "{ends:?}");
        assert!(interval_of_ratio(&[(1.0, 1.0), (2.0, 1.0), (30.0, 100.0)]).is_none());
        assert!(interval_of_ratio(&[(f64::NAN, 1.0), (2.0, 1.0), (3.0, 1.0)]).is_none());
        assert!(interval_of_ratio(&[(0.0, 0.0); 4]).is_none());
    }

    #[test]
    fn the_interval_of_a_ratio_contains_it_as_often_as_it_says_over_clusters_of_unequal_size() {
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let mut normal = || (0..12).map(|_| random.random_range(-0.5..0.5)).sum::<f64>();
        let sizes: [f64; 6] = [1.0, 1.0, 2.0, 3.0, 3.0, 8.0];
        let covered = (0..4000).filter(|_| {
            let clusters = sizes.map(|x| (0.3 * x + 0.2 * x.sqrt() * normal(), x));
            interval_of_ratio(&clusters).is_some_and(|[low, high]| (low..=high).contains(&0.3))
        });
        let share = covered.count() as f64 / 4000.0;
        assert!((0.93..=0.98).contains(&share), "{share}");
    }

    #[test]
    fn the_ranks_of_what_prevails_are_more_than_half() {
        assert_eq!(positive_rank_share(&[]), None);
        assert_eq!(positive_rank_share(&[0.0, 0.0]), None);
        // Ranks 1, 2 and 3; the two smaller ones are lost.
        assert_eq!(positive_rank_share(&[-1.0, 5.0, -2.0, 0.0]), Some(0.5));
        assert_eq!(positive_rank_share(&[-1.0, f64::NEG_INFINITY, 2.0]), Some(2.0 / 6.0));
        // Ties: each has the rank 1.5.
        assert_eq!(positive_rank_share(&[3.0, -3.0, 4.0]), Some(4.5 / 6.0));
    }

    #[test]
    fn wilson_interval_is_the_published_one() {
        // Newcombe 1998, table I: 81 of 263, and 0 of 20.
        let s = Share::new(81, 263);
        assert!((s.low - 0.2553).abs() < 1e-4 && (s.high - 0.3662).abs() < 1e-4, "{s:?}");
        let s = Share::new(0, 20);
        assert!(s.low == 0.0 && (s.high - 0.1611).abs() < 1e-4, "{s:?}");
    }

    #[test]
    fn an_outlier_is_as_unlikely_as_the_published_table_says() {
        // Grubbs 1969, table I, one-sided: (greatest - mean)/s that is exceeded by a share of samples of n.
        for (n, share, critical) in
            [(5, 0.05, 1.672), (8, 0.01, 2.221), (10, 0.05, 2.176), (10, 0.01, 2.410), (20, 0.01, 2.884)]
        {
            let sample = |last: f64| -> Vec<f64> {
                let others = (0..n - 1).map(|i| if i % 2 == 0 { f64::from(i) } else { -f64::from(i) });
                others.chain([last]).collect()
            };
            let apart = |last: f64| {
                let all = sample(last);
                (last - mean(all.iter().copied()).unwrap()) / variance(&all).unwrap().sqrt()
            };
            let (mut low, mut high) = (f64::from(n), 1e3 * f64::from(n));
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if apart(middle) < critical { low = middle } else { high = middle }
            }
            let p = outlier_p(&sample(low));
            assert!((p / share - 1.0).abs() < 0.03, "{n} {critical}: {p}");
        }
        assert_eq!([&[][..], &[1.0], &[1.0, 9.0], &[1.0; 5], &[1.0, f64::NAN, 2.0, 9.0]].map(outlier_p), [1.0; 5]);
        assert!(outlier_p(&[1.0, 1.0, 1.0, 2.0]) < 1e-300);
    }

    #[test]
    fn unknown_cases_are_not_counted() {
        let s = Share::of([Some(true), None, Some(false), None]).unwrap();
        assert_eq!((s.hits, s.of), (1, 2));
        assert!(Share::of([None]).is_none());
    }

    #[test]
    fn a_few_of_many_are_not_shown_as_none_nor_all_but_a_few_as_all() {
        let words = |hits| Share::new(hits, 298).to_string();
        assert_eq!(words(0), "0 % (0 to 1) of 298");
        assert_eq!([words(1), words(297)], ["0.3 % (0 to 2) of 298", "99.7 % (98 to 100) of 298"]);
        assert_eq!([words(2), words(298)], ["1 % (0 to 2) of 298", "100 % (99 to 100) of 298"]);
    }

    #[test]
    fn quantiles_interpolate_between_samples() {
        let sorted = [1.0, 2.0, 4.0, 8.0, 16.0];
        assert_eq!([0.0, 0.25, 0.5, 1.0].map(|q| quantile(&sorted, q)), [Some(1.0), Some(2.0), Some(4.0), Some(16.0)]);
        assert_eq!(quantile(&sorted, 0.125), Some(1.5));
        assert_eq!(quantile(&[], 0.5), None);
        assert_eq!(median([4.0, f64::NAN, 1.0, 2.0]), Some(2.0));
        assert_eq!((median([3.0, 1.0]), median([]), mean([])), (Some(2.0), None, None));
        assert_eq!((variance(&[1.0, 3.0]), variance(&[1.0])), (Some(2.0), None));
    }

    #[test]
    fn tails_are_those_of_the_tables() {
        assert!((student_p(-5.407_883, 7.0) - 1e-3).abs() < 1e-6 && student_p(1e300, 7.0) > 0.0);
        assert_eq!((student_p(0.0, 4.0), student_p(f64::NAN, 4.0)), (1.0, 1.0));
        assert!((chi_squared_p(3.841_459, 1) - 0.05).abs() < 1e-6 && chi_squared_p(5.0, 0) == 1.0);
        assert!((normal_quantile(0.975) - 1.959_964).abs() < 1e-6);
        assert!((student_quantile(0.975, 4.0) - 2.776_445).abs() < 1e-5);
        assert_eq!((corrected(0.01, 5.0), corrected(0.4, 5.0)), (0.05, 1.0));
    }

    #[test]
    fn clusters_that_repeat_a_score_add_its_square_not_its_size() {
        let vector = |values: &[f64]| DVector::from_row_slice(values);
        let m = clustered_variance(Ranks::one(), &[vector(&[1.0, 0.0]), vector(&[-1.0, 0.0])], 2);
        assert_eq!(m.0, DMatrix::from_row_slice(2, 2, &[4.0, 0.0, 0.0, 0.0]));
    }

    #[test]
    fn an_interval_of_the_mean_is_as_wide_as_its_standard_error_says() {
        let values: Vec<f64> = (0..200).map(|i| f64::from(i % 20)).collect();
        let of = |drawn: &[usize]| mean(drawn.iter().map(|i| values[*i]));
        let [low, high] = Bootstrap::new(values.len(), 2000, 1).interval(of).unwrap();
        let error = (variance(&values).unwrap() / 200.0).sqrt();
        assert!((0.5 * (low + high) - 9.5).abs() < 0.1 && ((high - low) / (3.92 * error) - 1.0).abs() < 0.1);
        assert_eq!(Bootstrap::new(2, 2000, 1).interval(of), None);
    }
}
