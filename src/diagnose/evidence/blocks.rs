//! The evidence for a constant force in any span of blocks of a run's time, the base model projected out.
//! It names no cause of a force and compares no spans.

use crate::diagnose::settings::{BLOCK_SAMPLES, BLOCKS, PUSH_LONGEST};
use crate::likelihood::algebra::pick;
use crate::likelihood::evidence::{Base, RunEvidence};
use crate::recording::Run;
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

/// Samples in one block of the time scan. The evidence for a force that sets in comes mostly from the time of its onset, and a run cut
/// more finely costs more time than it adds evidence.
pub fn block_length(runs: &[Run]) -> usize {
    let longest = runs.iter().map(|r| r.measured.len()).max().unwrap_or(0);
    longest.div_ceil(BLOCKS).max(BLOCK_SAMPLES)
}

/// A run's force evidence after the base, by spans of blocks, so that every span costs the same.
pub struct Blocks {
    /// Samples in a block.
    pub length: usize,
    count: usize,
    /// Sums of the scores of the blocks before each.
    score: Vec<Vector3<f64>>,
    /// Information of every span, the first block rising before the last, as the six entries of its lower triangle.
    information: Vec<[f64; 6]>,
}

impl Blocks {
    /// Of a run's scores, the base projected out: three columns a block from column `first` on.
    pub fn new(
        length: usize,
        count: usize,
        e: &RunEvidence,
        base: &Base,
        base_step: &DVector<f64>,
        first: usize,
    ) -> Self {
        let columns: Vec<usize> = (first..first + 3 * count).collect();
        let cross = pick(&e.information, &columns, &base.columns);
        let h: DMatrix<f64> = pick(&e.information, &columns, &columns) - &cross * &base.inverse * cross.transpose();
        let g = DVector::from_fn(columns.len(), |i, _| e.score[columns[i]]) - &cross * base_step;
        Self::sums(length, count, &g, &h)
    }

    /// Of score and information, three columns a block.
    pub fn sums(length: usize, count: usize, g: &DVector<f64>, h: &DMatrix<f64>) -> Self {
        let w = count + 1;
        let mut score = vec![Vector3::zeros(); w];
        // Sums over the rectangles of blocks that begin with the first.
        let mut corner = vec![Matrix3::<f64>::zeros(); w * w];
        for i in 0..count {
            score[i + 1] = score[i] + Vector3::from_fn(|a, _| g[3 * i + a]);
            for j in 0..count {
                corner[(i + 1) * w + j + 1] = Matrix3::from_fn(|a, b| h[(3 * i + a, 3 * j + b)])
                    + corner[i * w + j + 1]
                    + corner[(i + 1) * w + j]
                    - corner[i * w + j];
            }
        }
        let span = |(from, to): (usize, usize)| {
            let h = corner[to * w + to] - corner[from * w + to] - corner[to * w + from] + corner[from * w + from];
            let h = (h + h.transpose()) * 0.5;
            TRIANGLE.map(|place| h[place])
        };
        Self { length, count, score, information: spans(count).map(span).collect() }
    }

    /// How many spans begin before block `from`: count, count - 1, ...
    fn before(&self, from: usize) -> usize {
        from * self.count - from * from.saturating_sub(1) / 2
    }

    /// Whether a span of so many blocks leaves a good part of the run without a force.
    fn is_local(&self, length: usize) -> bool {
        length as f64 <= PUSH_LONGEST * self.count as f64
    }

    /// Score of a constant force in blocks `from..to`, and its information.
    pub fn span(&self, from: usize, to: usize) -> (Vector3<f64>, Matrix3<f64>) {
        let mut h = Matrix3::zeros();
        for ((i, j), value) in TRIANGLE.into_iter().zip(self.information[self.before(from) + to - from - 1]) {
            (h[(i, j)], h[(j, i)]) = (value, value);
        }
        (self.score[to] - self.score[from], h)
    }

    /// What a constant force in blocks `from..to` gains in log-likelihood.
    pub fn gain(&self, from: usize, to: usize, force: &Vector3<f64>) -> f64 {
        self.gain_at(from, to, &self.information[self.before(from) + to - from - 1], force)
    }

    /// As [`Self::gain`], for the information of the span.
    fn gain_at(&self, from: usize, to: usize, h: &[f64; 6], force: &Vector3<f64>) -> f64 {
        let along = |a: f64, b: f64, c: f64| a * force[0] + b * force[1] + c * force[2];
        let pull = [along(h[0], h[1], h[3]), along(h[1], h[2], h[4]), along(h[3], h[4], h[5])];
        (self.score[to] - self.score[from]).dot(force) - 0.5 * along(pull[0], pull[1], pull[2])
    }

    /// What a constant force gains in every span that leaves a good part of the run without it, in the order of
    /// [`Self::local_spans`].
    pub fn local_gains(&self, force: &Vector3<f64>, gains: &mut Vec<(usize, usize, f64)>) {
        gains.clear();
        let mut rest = self.information.as_slice();
        for from in 0..self.count {
            let (own, later) = rest.split_at(self.count - from);
            rest = later;
            let local = own.iter().zip(from + 1..).take_while(|(_, to)| self.is_local(to - from));
            gains.extend(local.map(|(h, to)| (from, to, self.gain_at(from, to, h, force))));
        }
    }

    /// The constant force that fits blocks `from..to` best.
    pub fn fit(&self, from: usize, to: usize) -> Option<Span> {
        let (score, information) = self.span(from, to);
        let inverse = information.try_inverse()?;
        let estimate = inverse * score;
        let least = information.diagonal().min();
        Some(Span { statistic: score.dot(&estimate), from, to, estimate, inverse, least })
    }

    /// Every span of blocks, as the first and the one after the last.
    pub fn spans(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        spans(self.count)
    }

    /// Spans that leave a good part of the run without the force.
    pub fn local_spans(&self) -> impl Iterator<Item = (usize, usize)> {
        self.spans().filter(|(from, to)| self.is_local(to - from))
    }
}

/// The lower triangle of a force's information, row by row.
const TRIANGLE: [(usize, usize); 6] = [(0, 0), (1, 0), (1, 1), (2, 0), (2, 1), (2, 2)];

/// Every span of so many blocks, as the first and the one after the last.
fn spans(count: usize) -> impl Iterator<Item = (usize, usize)> + use<> {
    (0..count).flat_map(move |from| (from + 1..=count).map(move |to| (from, to)))
}

/// Spans of a run of `blocks` blocks.
pub fn choices(blocks: usize) -> f64 {
    0.5 * (blocks * (blocks + 1)) as f64
}

/// Blocks `from..to` of a run with the constant force that fits there.
pub struct Span {
    /// Twice the gain in log-likelihood.
    pub statistic: f64,
    /// First block.
    pub from: usize,
    /// The block after the last.
    pub to: usize,
    /// The force.
    pub estimate: Vector3<f64>,
    /// Its covariance.
    pub inverse: Matrix3<f64>,
    /// Least information on one component of the force.
    least: f64,
}

impl Span {
    /// Whether the data see every component of the force.
    pub fn seen(&self) -> bool {
        self.least >= 1e-6 && self.statistic.is_finite()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Four blocks whose three force components share information from block to block.
    fn evidence() -> (DVector<f64>, DMatrix<f64>) {
        let root = DMatrix::from_fn(12, 12, |i, j| ((3 * i + 7 * j) % 11) as f64 / 11.0);
        let score = DVector::from_fn(12, |i, _| ((5 * i) % 7) as f64 - 3.0);
        (score, root.transpose() * &root + DMatrix::identity(12, 12))
    }

    #[test]
    fn the_sums_of_a_span_are_those_of_its_blocks() {
        let (g, h) = evidence();
        let blocks = Blocks::sums(2, 4, &g, &h);
        for (from, to) in blocks.spans() {
            let mut expected = (Vector3::zeros(), Matrix3::zeros());
            for i in from..to {
                expected.0 += Vector3::from_fn(|a, _| g[3 * i + a]);
                for j in from..to {
                    expected.1 += Matrix3::from_fn(|a, b| h[(3 * i + a, 3 * j + b)]);
                }
            }
            let (score, information) = blocks.span(from, to);
            assert!((score - expected.0).amax() < 1e-12 && (information - expected.1).amax() < 1e-12);
        }
    }

    #[test]
    fn the_gains_of_local_spans_are_those_of_each() {
        let (g, h) = evidence();
        let blocks = Blocks::sums(2, 4, &g, &h);
        let force = Vector3::new(0.3, -1.2, 0.7);
        let mut gains = vec![(0, 0, 0.0)];
        blocks.local_gains(&force, &mut gains);
        let each: Vec<(usize, usize, f64)> =
            blocks.local_spans().map(|(from, to)| (from, to, blocks.gain(from, to, &force))).collect();
        assert_eq!(gains, each);
        let (score, information) = blocks.span(1, 3);
        let expected = score.dot(&force) - 0.5 * force.dot(&(information * force));
        assert!((blocks.gain(1, 3, &force) - expected).abs() < 1e-12);
    }

    #[test]
    fn the_force_that_fits_a_span_gains_half_its_statistic_and_no_force_gains_more() -> Result<(), String> {
        let (g, h) = evidence();
        let blocks = Blocks::sums(2, 4, &g, &h);
        let best = blocks.fit(1, 3).ok_or("no fit")?;
        let gain = |force: &Vector3<f64>| blocks.gain(1, 3, force);
        assert!((gain(&best.estimate) - 0.5 * best.statistic).abs() < 1e-12);
        for e in 0..3 {
            for d in [-0.1, 0.1] {
                let mut other = best.estimate;
                other[e] += d;
                assert!(gain(&other) < gain(&best.estimate));
            }
        }
        Ok(())
    }

    #[test]
    fn profiling_out_a_base_parameter_gives_the_force_of_a_joint_fit_of_both() -> Result<(), String> {
        // One base column beside one block: the force of the joint fit by the whole inverse.
        let (score, information) = evidence();
        let four = DVector::from_fn(4, |i, _| score[i]);
        let joint = DMatrix::from_fn(4, 4, |i, j| information[(i, j)]);
        let run = RunEvidence { session: "a".into(), score: four.clone(), information: joint.clone() };
        let e = crate::likelihood::evidence::Evidence::new(vec![run.clone()]);
        let base = e.base(&[0], &[0.0], &[0.0]);
        let blocks = Blocks::new(2, 1, &run, &base, &base.step(), 1);
        let alone = blocks.fit(0, 1).ok_or("no fit")?;
        let both = joint.try_inverse().ok_or("singular")? * four;
        assert!((alone.estimate - Vector3::new(both[1], both[2], both[3])).amax() < 1e-12);
        Ok(())
    }

    #[test]
    fn a_run_of_four_blocks_has_ten_spans_of_which_seven_leave_a_good_part_of_it() {
        let (g, h) = evidence();
        let blocks = Blocks::sums(2, 4, &g, &h);
        assert_eq!((blocks.spans().count(), blocks.local_spans().count(), choices(4)), (10, 7, 10.0));
    }
}
