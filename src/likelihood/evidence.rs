//! Scores and information of all runs, and the small dense algebra that every later step is made of.
//! It does not know what a column means: names and verdicts are made elsewhere.

use super::algebra::{pick, pseudo_inverse};
use super::settings::{IDENTIFIABLE_SHARE, SCATTER_GROUPS};
use crate::numbers::moderated::{GroupScore, Moderation, Ratio, pooled, ratio};
pub use crate::statistics::chi_squared_p;
use crate::statistics::{corrected, scattered_p, student_quantile};
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use std::collections::BTreeMap;

/// Score and information of one run.
#[derive(Clone, Debug, Default)]
pub struct RunEvidence {
    /// Session of the run.
    pub session: String,
    /// Score by column.
    pub score: DVector<f64>,
    /// Information by pairs of columns.
    pub information: DMatrix<f64>,
}

impl RunEvidence {
    /// Nothing known of so many columns.
    fn zero(session: &str, columns: usize) -> Self {
        Self { session: session.into(), score: DVector::zeros(columns), information: DMatrix::zeros(columns, columns) }
    }
}

/// Score of one run.
#[derive(Clone, Debug)]
pub struct RunScore {
    /// Session of the run.
    pub session: String,
    /// Score by column.
    pub score: DVector<f64>,
    /// Information by column, the others known.
    pub information: DVector<f64>,
}

/// Sums of scores and information over sessions and over all runs. Of the information of single runs only the diagonal is kept.
#[derive(Clone, Debug, Default)]
pub struct Evidence {
    /// By run, in order.
    pub runs: Vec<RunScore>,
    /// Sum over all runs.
    pub total: RunEvidence,
    /// Sums by session; empty where sessions are not distinguished.
    pub sessions: BTreeMap<String, RunEvidence>,
}

/// A linear test of a group of columns against a base.
#[derive(Clone, Debug)]
pub struct Test {
    /// The statistic: twice the gain in log-likelihood that the quadratic model predicts.
    pub statistic: f64,
    /// Degrees of freedom that the data can see.
    pub degrees: usize,
    /// p-value of the statistic under chi-squared.
    pub p: f64,
    /// Estimated amplitudes, in units of the columns' scales.
    pub amplitude: DVector<f64>,
    /// Covariance of the amplitudes.
    pub covariance: DMatrix<f64>,
    /// Smallest share of the columns' information that is left once the base is fitted too, 0 to 1.
    pub retained: f64,
}

impl Test {
    /// The test of `k` columns for which the data give no finite number.
    fn blind(k: usize) -> Self {
        Self {
            statistic: 0.0,
            degrees: 0,
            p: 1.0,
            amplitude: DVector::zeros(k),
            covariance: DMatrix::zeros(k, k),
            retained: 0.0,
        }
    }
}

impl Evidence {
    /// Sums the runs in order.
    pub fn new(runs: Vec<RunEvidence>) -> Self {
        let mut sum = Self::default();
        runs.into_iter().for_each(|run| sum.add(run, true));
        sum
    }

    /// Adds a run; `apart` where its session is distinguished from the others.
    pub fn add(&mut self, run: RunEvidence, apart: bool) {
        let RunEvidence { session, score, information } = run;
        if self.runs.is_empty() {
            self.total = RunEvidence::zero("", score.len());
        }
        self.total.score += &score;
        self.total.information += &information;
        if apart {
            let sum = self.sessions.entry(session.clone()).or_insert_with(|| RunEvidence::zero(&session, score.len()));
            sum.score += &score;
            sum.information += &information;
        }
        self.runs.push(RunScore { session, score, information: information.diagonal() });
    }

    /// The base block: its information with the prior precision added, factorised.
    pub fn base(&self, columns: &[usize], precision: &[f64], pull: &[f64]) -> Base {
        let n = columns.len();
        let mut h = pick(&self.total.information, columns, columns);
        let mut g = DVector::from_fn(n, |i, _| self.total.score[columns[i]]);
        for i in 0..n {
            h[(i, i)] += precision[i];
            g[i] += pull[i];
        }
        Base { columns: columns.to_vec(), inverse: pseudo_inverse(&h), score: g }
    }

    /// How much further the base's parameters scatter between groups of runs than its information says, as factors of at least 1 on
    /// their standard errors: the roots of the moderated ratios ([`Moderation`]) of their efficient scores `A^-1 g_c`, with A the base's
    /// information and `g_c` the scores summed over the runs of group c. What is typical is learnt from the base and from `further`
    /// columns. A model of another form than the ship's has the same error in all runs of a kind.
    pub fn scatter(&self, base: &Base, groups: &[&str], further: &[usize]) -> Scatter {
        let groups = self.groups(groups);
        let own: Vec<Option<Ratio>> = (0..base.columns.len()).map(|i| groups.of_base(base, i)).collect();
        let others = further.iter().filter_map(|c| groups.beside(self, base, *c, |_| 0));
        let moderation = Moderation::of(&own.iter().flatten().copied().chain(others).collect::<Vec<_>>());
        let moderated = own.into_iter().map(|r| floored(moderation.moderated(r)));
        let (factors, degrees) = moderated.map(|r| (r.value.sqrt(), r.degrees)).unzip();
        Scatter { factors, degrees }
    }

    /// The moderated ratio of a group of columns beside a base, the largest of them, each around its own effect in each part of the
    /// runs: `part` says to which a run belongs. What is typical is learnt from all `further` columns.
    pub fn moderated(
        &self,
        base: &Base,
        columns: &[usize],
        groups: &[&str],
        further: &[usize],
        part: impl Fn(usize) -> usize,
    ) -> Ratio {
        let groups = self.groups(groups);
        let all: Vec<Ratio> = further.iter().filter_map(|c| groups.beside(self, base, *c, |_| 0)).collect();
        let moderation = Moderation::of(&all);
        let one = |c: &usize| moderation.moderated(groups.beside(self, base, *c, &part));
        columns
            .iter()
            .map(one)
            .reduce(|a, b| if b.value > a.value { b } else { a })
            .map_or_else(|| floored(moderation.moderated(None)), floored)
    }

    /// The runs by group.
    fn groups(&self, groups: &[&str]) -> Groups<'_> {
        let mut members: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        groups.iter().zip(0..self.runs.len()).for_each(|(group, run)| members.entry(group).or_default().push(run));
        Groups { runs: &self.runs, members: members.into_values().collect() }
    }

    /// The scores summed over the runs of each group, `groups` naming that of each run.
    pub fn sums_of(&self, groups: &[&str]) -> Vec<DVector<f64>> {
        let zero = || DVector::zeros(self.total.score.len());
        let sum = |members: &Vec<usize>| members.iter().fold(zero(), |sum, run| sum + &self.runs[*run].score);
        self.groups(groups).members.iter().map(sum).collect()
    }

    /// Tests a group of columns, common to all runs, the base profiled out.
    pub fn test(&self, base: &Base, columns: &[usize]) -> Test {
        let cross = pick(&self.total.information, columns, &base.columns);
        let own = pick(&self.total.information, columns, columns);
        let score = DVector::from_fn(columns.len(), |i, _| self.total.score[columns[i]]);
        base.test(&score, &own, &cross)
    }

    /// Tests a group of columns that acts in some sessions only, the base profiled out. With the same columns in the
    /// base ([`Evidence::extend`]) what is common to all sessions is projected out, so that the others are the reference.
    pub fn test_in(&self, base: &Base, columns: &[usize], sessions: &[&str]) -> Test {
        let k = columns.len();
        let mut score = DVector::zeros(k);
        let mut own = DMatrix::zeros(k, k);
        let mut cross = DMatrix::zeros(k, base.columns.len());
        for e in self.sessions.iter().filter(|(s, _)| sessions.contains(&s.as_str())).map(|(_, e)| e) {
            score += DVector::from_fn(k, |i, _| e.score[columns[i]]);
            own += pick(&e.information, columns, columns);
            cross += pick(&e.information, columns, &base.columns);
        }
        base.test(&score, &own, &cross)
    }

    /// The base with further columns, common to all runs.
    pub fn extend(&self, base: &Base, columns: &[usize]) -> Base {
        let mut all = base.columns.clone();
        all.extend(columns);
        let k = columns.len();
        let n = base.columns.len();
        let mut inverse = DMatrix::zeros(n + k, n + k);
        let cross = pick(&self.total.information, columns, &base.columns);
        let own = pick(&self.total.information, columns, columns);
        // Bordered inverse.
        let b = &base.inverse * cross.transpose();
        let schur = pseudo_inverse(&(&own - &cross * &b));
        inverse.view_mut((0, 0), (n, n)).copy_from(&(&base.inverse + &b * &schur * b.transpose()));
        inverse.view_mut((0, n), (n, k)).copy_from(&(-(&b * &schur)));
        inverse.view_mut((n, 0), (k, n)).copy_from(&(-(&schur * b.transpose())));
        inverse.view_mut((n, n), (k, k)).copy_from(&schur);
        let mut score = base.score.clone().resize_vertically(n + k, 0.0);
        for (i, c) in columns.iter().enumerate() {
            score[n + i] = self.total.score[*c];
        }
        Base { columns: all, inverse, score }
    }

    /// Tests whether a group of columns acts differently from session to session, its common part projected out.
    ///
    /// The amplitudes are those of each session in turn (session-major), relative to the common part. `None` when there
    /// are fewer than two sessions, or more than half as many as runs.
    pub fn contrast(&self, base: &Base, columns: &[usize]) -> Option<Test> {
        let parted = self.sessions.len() >= 2 && are_references(self.sessions.len(), self.runs.len());
        parted.then(|| self.test_each(&self.extend(base, columns), columns))
    }

    /// Tests a group of columns with an amplitude of its own in each session (session-major, in the order of
    /// [`Evidence::sessions`]), the base profiled out.
    pub fn test_each(&self, base: &Base, columns: &[usize]) -> Test {
        let k = columns.len();
        let sessions = self.sessions.len();
        let mut g = DVector::zeros(sessions * k);
        let mut h = DMatrix::zeros(sessions * k, sessions * k);
        let mut c = DMatrix::zeros(sessions * k, base.columns.len());
        for (s, e) in self.sessions.values().enumerate() {
            for i in 0..k {
                g[s * k + i] = e.score[columns[i]];
            }
            h.view_mut((s * k, s * k), (k, k)).copy_from(&pick(&e.information, columns, columns));
            c.view_mut((s * k, 0), (k, base.columns.len())).copy_from(&pick(&e.information, columns, &base.columns));
        }
        base.test(&g, &h, &c)
    }
}

/// A ratio with no fewer degrees of freedom than the least number of groups has.
fn floored(ratio: Ratio) -> Ratio {
    Ratio { degrees: ratio.degrees.max(degrees_of(0)), ..ratio }
}

/// Runs that are no independent evidence, by group.
struct Groups<'a> {
    runs: &'a [RunScore],
    members: Vec<Vec<usize>>,
}

impl Groups<'_> {
    /// Efficient score and information of each group along one column, given each run's efficient score.
    fn scores(&self, column: usize, score: impl Fn(&RunScore) -> f64) -> Vec<GroupScore> {
        let one = |members: &Vec<usize>| GroupScore {
            score: members.iter().map(|i| score(&self.runs[*i])).sum(),
            weight: members.iter().map(|i| self.runs[*i].information[column]).sum(),
        };
        self.members.iter().map(one).collect()
    }

    /// The ratio of a parameter of the base.
    fn of_base(&self, base: &Base, index: usize) -> Option<Ratio> {
        let row = base.inverse.row(index);
        let score = |run: &RunScore| base.columns.iter().zip(row.iter()).map(|(c, a)| a * run.score[*c]).sum();
        ratio(&self.scores(base.columns[index], score), row[index])
    }

    /// The ratio of a column beside the base, around its own effect in each part of the runs; `None` where the base takes it over.
    fn beside(&self, all: &Evidence, base: &Base, column: usize, part: impl Fn(usize) -> usize) -> Option<Ratio> {
        let cross = pick(&all.total.information, &[column], &base.columns);
        let taken = &cross * &base.inverse;
        let own = all.total.information[(column, column)];
        let left = own - (&taken * cross.transpose())[(0, 0)];
        if left.is_nan() || left < IDENTIFIABLE_SHARE * own {
            return None;
        }
        let efficient = |run: &RunScore| {
            run.score[column] - base.columns.iter().zip(taken.iter()).map(|(c, t)| t * run.score[*c]).sum::<f64>()
        };
        let mut parts: BTreeMap<usize, Vec<GroupScore>> = BTreeMap::new();
        for (group, members) in self.scores(column, efficient).into_iter().zip(&self.members) {
            parts.entry(members.first().map_or(0, |run| part(*run))).or_default().push(group);
        }
        let in_part = |groups: Vec<GroupScore>| {
            let share = groups.iter().map(|g| g.weight).sum::<f64>() / own;
            ratio(&groups, share * left)
        };
        pooled(parts.into_values().filter_map(in_part))
    }
}

/// Whether so many sessions of so many runs can be compared with each other: a session of one run is a run, not a reference.
pub fn are_references(sessions: usize, runs: usize) -> bool {
    2 * sessions <= runs
}

/// The factors of [`Evidence::scatter`] for an inverse information and the scores of each group; 1 of fewer than two groups.
pub fn excess(inverse: &DMatrix<f64>, sums: &[DVector<f64>]) -> Vec<f64> {
    let (n, count) = (inverse.nrows(), sums.len() as f64);
    if sums.len() < 2 {
        return vec![1.0; n];
    }
    let mean = sums.iter().fold(DVector::zeros(n), |a: DVector<f64>, g| a + g) / count;
    let mut variances = DVector::zeros(n);
    for g in sums {
        let step = inverse * (g - &mean);
        variances += step.component_mul(&step) * (count / (count - 1.0));
    }
    let factor = |i: usize| (variances[i] / inverse[(i, i)]).sqrt();
    (0..n).map(factor).map(|f| if f > 1.0 { f } else { 1.0 }).collect()
}

/// Degrees of freedom of a scatter between so many groups of runs.
pub fn degrees_of(groups: usize) -> f64 {
    (groups.max(SCATTER_GROUPS) - 1) as f64
}

/// How far estimates scatter beyond their information.
#[derive(Clone, Debug)]
pub struct Scatter {
    /// Factors on the standard errors, in the order of the base's columns.
    pub factors: Vec<f64>,
    /// Their degrees of freedom: those of the groups and of what is typical, and no fewer than the least number of groups has.
    pub degrees: Vec<f64>,
}

impl Scatter {
    /// Standard errors, multiplied by the factor, that a parameter's 95 % interval reaches to either side: Student's t, as an error that
    /// is estimated from few groups is itself uncertain (Cameron & Miller 2015, J. Human Resources 50, p. 317, section VI.D).
    pub fn reach(&self, place: usize) -> f64 {
        student_quantile(0.975, self.degrees[place])
    }

    /// The fewest degrees of freedom of some parameters.
    fn fewest(&self, places: &[usize]) -> f64 {
        places.iter().map(|i| self.degrees[*i]).fold(f64::INFINITY, f64::min)
    }

    /// Whether the 95 % region of some parameters leaves out a point at a squared distance in units of their covariance, multiplied by the
    /// factors: for one parameter the interval of [`Scatter::reach`].
    pub fn excludes(&self, statistic: f64, places: &[usize]) -> bool {
        self.p(statistic, places.len(), places) < 0.05
    }

    /// Whether zero is left out of the region of all parameters of an effect that has its own size in each session, or of those of one
    /// session by itself, each at half of 5 %: `together` is the squared distance of all of them, `one_by_one` that of each session's.
    /// Sizes that are alike show together, and one that stands out shows alone, where the region of all is wide for their number.
    pub fn excludes_in_some(&self, together: f64, one_by_one: &[f64], places: &[usize]) -> bool {
        let sessions = one_by_one.len().max(1);
        let least = one_by_one.iter().map(|s| self.p(*s, places.len() / sessions, places)).fold(1.0, f64::min);
        2.0 * self.p(together, places.len(), places).min(corrected(least, sessions as f64)) < 0.05
    }

    /// Chance of a squared distance as large as this, by Fisher's F; 1 without parameters.
    fn p(&self, statistic: f64, parameters: usize, places: &[usize]) -> f64 {
        if parameters == 0 { 1.0 } else { scattered_p(statistic, parameters, self.fewest(places)) }
    }
}

/// A block of columns that is always fitted along.
#[derive(Clone, Debug)]
pub struct Base {
    /// Its columns.
    pub columns: Vec<usize>,
    /// Inverse of its information (prior included).
    pub inverse: DMatrix<f64>,
    /// Its score (prior included).
    pub score: DVector<f64>,
}

impl Base {
    /// The step towards the maximum of the quadratic model.
    pub fn step(&self) -> DVector<f64> {
        &self.inverse * &self.score
    }

    /// Tests further columns with given score, own information and cross information with the base.
    pub fn test(&self, score: &DVector<f64>, own: &DMatrix<f64>, cross: &DMatrix<f64>) -> Test {
        let reduced = own - cross * &self.inverse * cross.transpose();
        let effective = score - cross * self.step();
        let k = score.len();
        if k == 0 || !effective.iter().chain(reduced.iter()).all(|v| v.is_finite()) {
            return Test::blind(k);
        }
        // In units in which each column alone carries information 1.
        let unit: Vec<f64> = (0..k).map(|i| 1.0 / own[(i, i)].max(f64::MIN_POSITIVE).sqrt()).collect();
        let scaled = DMatrix::from_fn(k, k, |i, j| 0.5 * (reduced[(i, j)] + reduced[(j, i)]) * unit[i] * unit[j]);
        let full = DMatrix::from_fn(k, k, |i, j| own[(i, j)] * unit[i] * unit[j]);
        let eigen = SymmetricEigen::new(scaled.clone());
        let full_eigen = SymmetricEigen::new(full);
        let floor = IDENTIFIABLE_SHARE * full_eigen.eigenvalues.max().max(1.0) * 0.1;
        let z = DVector::from_fn(k, |i, _| effective[i] * unit[i]);
        let mut statistic = 0.0;
        let mut degrees = 0;
        let mut amplitude = DVector::zeros(k);
        let mut covariance = DMatrix::zeros(k, k);
        for (l, v) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
            if *l > floor.max(IDENTIFIABLE_SHARE) {
                let along = v.dot(&z);
                statistic += along * along / l;
                degrees += 1;
                amplitude += v * (along / l);
                covariance += v * v.transpose() / *l;
            }
        }
        for i in 0..k {
            amplitude[i] *= unit[i];
            for j in 0..k {
                covariance[(i, j)] *= unit[i] * unit[j];
            }
        }
        let retained = retained_share(&reduced, own);
        Test { statistic, degrees, p: chi_squared_p(statistic, degrees), amplitude, covariance, retained }
    }
}

/// Smallest generalised eigenvalue of (reduced, own): the share of information that is left in the worst direction.
fn retained_share(reduced: &DMatrix<f64>, own: &DMatrix<f64>) -> f64 {
    let k = own.nrows();
    let eigen = SymmetricEigen::new(own.clone());
    let largest = eigen.eigenvalues.max();
    if largest.is_nan() || largest <= 0.0 {
        return 0.0;
    }
    let kept: Vec<usize> = (0..k).filter(|i| eigen.eigenvalues[*i] > 1e-9 * largest).collect();
    let half =
        DMatrix::from_fn(k, kept.len(), |i, j| eigen.eigenvectors[(i, kept[j])] / eigen.eigenvalues[kept[j]].sqrt());
    let relative = half.transpose() * reduced * &half;
    let symmetric = (&relative + relative.transpose()) * 0.5;
    SymmetricEigen::new(symmetric).eigenvalues.min().clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one_run(session: &str, score: &[f64], information: &[f64]) -> RunEvidence {
        let n = score.len();
        RunEvidence {
            session: session.into(),
            score: DVector::from_column_slice(score),
            information: DMatrix::from_row_slice(n, n, information),
        }
    }

    #[test]
    fn of_one_parameter_the_region_is_its_interval_and_of_several_it_is_wider() {
        let scatter = Scatter { factors: Vec::new(), degrees: vec![5.0; 6] };
        let edge = scatter.reach(0).powi(2);
        assert!(!scatter.excludes(0.999 * edge, &[0]) && scatter.excludes(1.001 * edge, &[0]));
        // Six times the 95 % point of Fisher's F with 6 and 5 degrees, 4.950.
        let all = [0, 1, 2, 3, 4, 5];
        assert!(!scatter.excludes(6.0 * 4.94, &all) && scatter.excludes(6.0 * 4.96, &all));
        assert!(!scatter.excludes(1e9, &[]));
    }

    #[test]
    fn an_effect_with_its_own_size_in_each_session_shows_in_all_together_or_in_one_that_stands_out() {
        let scatter = Scatter { factors: Vec::new(), degrees: vec![5.0; 12] };
        let places: Vec<usize> = (0..12).collect();
        // Of six sessions with two parameters each: 12 times the 97.5 % point of F(12, 5), 6.525; and twice the point of F(2, 5) beyond
        // which lies 0.025/6, 18.65 by (1 + 2 F / 5)^(-5/2) = 0.025/6.
        let (together, alone) = (12.0 * 6.525, 5.0 * ((6.0 / 0.025_f64).powf(0.4) - 1.0));
        let even = |all: f64| scatter.excludes_in_some(all, &[all / 6.0; 6], &places);
        assert!(!even(0.99 * together) && even(1.01 * together));
        let one = |s: f64| scatter.excludes_in_some(s, &[0.0, s, 0.0, 0.0, 0.0, 0.0], &places);
        assert!(!one(0.99 * alone) && one(1.01 * alone) && alone < 0.6 * together);
        assert!(!scatter.excludes_in_some(1e9, &[], &[]));
    }

    #[test]
    fn a_column_that_the_base_can_mimic_retains_nothing() {
        let e = Evidence::new(vec![one_run("a", &[3.0, 3.0], &[4.0, 4.0, 4.0, 4.0])]);
        let base = e.base(&[0], &[0.0], &[0.0]);
        let t = e.test(&base, &[1]);
        assert_eq!(t.degrees, 0);
        assert!(t.retained < 1e-12 && t.p == 1.0);
    }

    #[test]
    fn without_a_column_and_without_a_number_the_test_sees_nothing() {
        let e = Evidence::new(vec![one_run("a", &[3.0, f64::NAN], &[4.0, 0.0, 0.0, f64::NAN])]);
        let base = e.base(&[0], &[0.0], &[0.0]);
        for columns in [&[][..], &[1]] {
            let t = e.test(&base, columns);
            assert_eq!((t.degrees, t.p, t.amplitude.len()), (0, 1.0, columns.len()));
        }
    }

    #[test]
    fn an_independent_column_is_tested_as_if_alone() {
        let e = Evidence::new(vec![one_run("a", &[5.0, 6.0], &[4.0, 0.0, 0.0, 9.0])]);
        let base = e.base(&[0], &[0.0], &[0.0]);
        let t = e.test(&base, &[1]);
        assert!((t.statistic - 4.0).abs() < 1e-12 && (t.amplitude[0] - 6.0 / 9.0).abs() < 1e-12);
        assert!((t.retained - 1.0).abs() < 1e-12);
    }

    #[test]
    fn scores_that_scatter_between_groups_of_runs_widen_the_standard_errors() {
        // Four runs whose scores have the variance that their information of 1 says, and the same with two kinds that pull apart.
        let of = |pull: f64| {
            let signs = [1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0];
            let run = |(i, sign): (usize, &f64)| one_run("a", &[sign + if i < 4 { pull } else { -pull }], &[1.0]);
            Evidence::new(signs.iter().enumerate().map(run).collect())
        };
        let groups = ["turn", "turn", "turn", "turn", "zigzag", "zigzag", "zigzag", "zigzag"];
        let factor = |pull: f64| {
            let e = of(pull);
            e.scatter(&e.base(&[0], &[0.0], &[0.0]), &groups, &[]).factors[0]
        };
        assert_eq!(factor(0.0), 1.0);
        // B = 2 (4^2 + 4^2), A = 8: the variance is 64/64 where the information says 1/8. One direction has no other to be moderated by.
        assert!((factor(1.0) - 8.0_f64.sqrt()).abs() < 1e-12);
        let e = of(1.0);
        assert_eq!(e.scatter(&e.base(&[0], &[0.0], &[0.0]), &["all"; 8], &[]).factors, [1.0]);
    }

    #[test]
    fn what_acts_in_one_session_is_no_scatter_of_its_own_there_and_is_one_of_a_common_effect() {
        // Information 1 a run; an effect of 3 in session b alone.
        let signs = [0.5, -0.5, 0.5, -0.5, 0.5, -0.5, 0.5, -0.5];
        let run = |(i, sign): (usize, &f64)| {
            one_run(if i < 4 { "a" } else { "b" }, &[0.0, sign + if i < 4 { 0.0 } else { 3.0 }], &[1.0, 0.0, 0.0, 1.0])
        };
        let e = Evidence::new(signs.iter().enumerate().map(run).collect());
        let base = e.base(&[0], &[0.0], &[0.0]);
        let names = ["0", "1", "2", "3", "4", "5", "6", "7"];
        let common = e.moderated(&base, &[1], &names, &[], |_| 0);
        // 8/7 of 4 (3.0 - 1.5)^2 + 4 (1.5)^2 + 8 (0.5)^2, over the information of 8.
        assert!((common.value - 8.0 / 7.0 * 20.0 / 8.0).abs() < 1e-12 && common.degrees == 7.0, "{common:?}");
        let apart = e.moderated(&base, &[1], &names, &[], |run| usize::from(run >= 4));
        assert_eq!((apart.value, apart.degrees), (1.0, 6.0));
    }

    #[test]
    fn intervals_are_wider_the_fewer_groups_of_runs_there_are() {
        let reach = |groups: usize| Scatter { factors: Vec::new(), degrees: vec![degrees_of(groups)] }.reach(0);
        assert!((reach(8) - 2.3646).abs() < 1e-4 && (reach(5) - 2.7764).abs() < 1e-4);
        assert_eq!((reach(2), reach(1)), (reach(5), reach(5)));
        assert!((reach(10_000) - 1.96).abs() < 1e-3);
    }

    #[test]
    fn a_column_whose_score_is_not_a_number_is_not_identifiable() {
        let e = Evidence::new(vec![one_run("a", &[5.0, f64::NAN], &[4.0, f64::NAN, f64::NAN, f64::NAN])]);
        let t = e.test(&e.base(&[0], &[0.0], &[0.0]), &[1]);
        assert_eq!((t.degrees, t.p, t.retained), (0, 1.0, 0.0));
    }

    #[test]
    fn a_common_amplitude_makes_no_contrast() {
        // Both sessions see the mechanism with the same amplitude 2.
        let half = |s: &str, g: f64, h: f64| one_run(s, &[0.0, g], &[0.5, 0.0, 0.0, h]);
        let runs = vec![half("a", 4.0, 2.0), half("a", 4.0, 2.0), half("b", 2.0, 1.0), half("b", 2.0, 1.0)];
        let e = Evidence::new(runs);
        let base = e.base(&[0], &[0.0], &[0.0]);
        let t = e.contrast(&base, &[1]).unwrap();
        assert!(t.statistic.abs() < 1e-9, "{t:?}");
        assert_eq!(t.degrees, 1);
    }

    /// Score and information of a linear model `y = X b` with errors of variance 1, at `b = 0`.
    fn linear(session: &str, x: &DMatrix<f64>, y: &DVector<f64>) -> RunEvidence {
        RunEvidence { session: session.into(), score: x.transpose() * y, information: x.transpose() * x }
    }

    fn regression() -> (DMatrix<f64>, DVector<f64>) {
        let x = DMatrix::from_fn(12, 4, |i, j| (1.3 * i as f64 + 2.1 * (j * j) as f64 + 0.7 * (i * j) as f64).sin());
        (x, DVector::from_fn(12, |i, _| ((11 * i) % 5) as f64 - 1.0))
    }

    /// Least sum of squares, and the coefficients.
    fn least_squares(x: &DMatrix<f64>, y: &DVector<f64>) -> (f64, DVector<f64>) {
        let b = (x.transpose() * x).try_inverse().unwrap() * x.transpose() * y;
        ((y - x * &b).norm_squared(), b)
    }

    #[test]
    fn the_score_statistic_of_a_linear_model_is_the_reduction_of_the_sum_of_squares() {
        let (x, y) = regression();
        let e = Evidence::new(vec![linear("a", &x, &y)]);
        let t = e.test(&e.base(&[0, 1], &[0.0; 2], &[0.0; 2]), &[2, 3]);
        let ((fewer, _), (all, b)) = (least_squares(&x.columns(0, 2).into_owned(), &y), least_squares(&x, &y));
        assert!((t.statistic - (fewer - all)).abs() < 1e-9 && t.degrees == 2, "{t:?}");
        assert!((t.amplitude[0] - b[2]).abs() < 1e-9 && (t.amplitude[1] - b[3]).abs() < 1e-9);
        let covariance = (x.transpose() * &x).try_inverse().unwrap();
        assert!((t.covariance[(0, 1)] - covariance[(2, 3)]).abs() < 1e-9);
    }

    #[test]
    fn a_base_that_is_extended_is_the_base_of_all_its_columns() {
        let (x, y) = regression();
        let e = Evidence::new(vec![linear("a", &x, &y)]);
        let direct = e.base(&[0, 1, 2, 3], &[0.5, 0.0, 0.0, 0.0], &[0.1, 0.0, 0.0, 0.0]);
        let extended = e.extend(&e.base(&[0, 1], &[0.5, 0.0], &[0.1, 0.0]), &[2, 3]);
        assert_eq!(extended.columns, direct.columns);
        assert!((extended.inverse - &direct.inverse).amax() < 1e-9 && (extended.score - &direct.score).amax() < 1e-9);
    }

    #[test]
    fn a_mechanism_in_one_session_has_the_amplitude_that_a_column_of_that_session_has() {
        let (x, y) = regression();
        let half = |from: usize| (x.rows(from, 6).into_owned(), y.rows(from, 6).into_owned());
        let ((xa, ya), (xb, yb)) = (half(0), half(6));
        let e = Evidence::new(vec![linear("a", &xa, &ya), linear("b", &xb, &yb)]);
        let base = e.base(&[0, 1], &[0.0; 2], &[0.0; 2]);
        // The third column with its values in session b and zero in session a.
        let of = |sessions: [bool; 2]| {
            let column = |i: usize| if sessions[usize::from(i >= 6)] { x[(i, 2)] } else { 0.0 };
            DVector::from_fn(12, |i, _| column(i))
        };
        let with = |columns: &[DVector<f64>]| {
            let all: Vec<DVector<f64>> =
                [x.column(0).into_owned(), x.column(1).into_owned()].into_iter().chain(columns.to_vec()).collect();
            least_squares(&DMatrix::from_columns(&all), &y).1
        };
        let only_b = e.test_in(&base, &[2], &["b"]);
        assert!((only_b.amplitude[0] - with(&[of([false, true])])[2]).abs() < 1e-9);
        let each = e.test_each(&base, &[2]);
        let direct = with(&[of([true, false]), of([false, true])]);
        assert!((each.amplitude[0] - direct[2]).abs() < 1e-9 && (each.amplitude[1] - direct[3]).abs() < 1e-9);
    }

    #[test]
    fn the_upper_tail_of_chi_squared_has_its_known_quantiles_and_never_vanishes() {
        assert!((chi_squared_p(3.841_459, 1) - 0.05).abs() < 1e-6 && (chi_squared_p(9.210_340, 2) - 0.01).abs() < 1e-6);
        assert_eq!((chi_squared_p(5.0, 0), chi_squared_p(f64::NAN, 2)), (1.0, 1.0));
        assert!(chi_squared_p(1e6, 1) > 0.0);
    }
}
