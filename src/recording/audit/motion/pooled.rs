//! One run against all others: whether rudder and propeller act in it as they do in the other runs, or to the other side, later, or not.
//! The coefficients are those of the other runs, so that a short run says more than its own regression would.

use super::response::Curve;
use super::sources::Sources;
use super::sums::Sums;
use crate::recording::audit::limits::{
    EXPLAINS, OWN_SIDE, POOLED_AGREED, POOLED_EVIDENCE, POOLED_LEAVES, POOLED_RUNS, POOLED_SIZE, POOLED_STILL,
    POOLED_UNUSUAL, SCALE_EVIDENCE,
};
use crate::statistics::median;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// What explains a run better than the coefficients of the other runs as they are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Odd {
    /// The channel acts to the other side.
    Turned,
    /// The channel lags so much behind the motion \\[s\\].
    Late(f64),
    /// The motion does not answer the channel.
    Unanswered,
}

/// The sums of several runs at lag 0, added.
fn total<'c>(curves: impl Iterator<Item = &'c Curve>) -> Option<Sums> {
    let mut sum: Option<Sums> = None;
    for curve in curves {
        let one = curve.at_zero();
        match &mut sum {
            None => sum = Some(one.clone()),
            Some(sum) => sum.add(one),
        }
    }
    sum
}

/// The matrix of products of columns, factorised with each column scaled to one and a ridge of 1e-9, and the scales; `less` is taken out of
/// the sums.
fn normal(sum: &Sums, less: Option<&Sums>) -> Option<(Cholesky<f64, Dyn>, DVector<f64>)> {
    let n = sum.response.len();
    let a = DMatrix::from_fn(n, n, |i, j| sum.columns[i * n + j] - less.map_or(0.0, |l| l.columns[i * n + j]));
    let scale = a.diagonal().map(|d| if d > 0.0 { d.sqrt().recip() } else { 0.0 });
    let scaled = DMatrix::from_fn(n, n, |i, j| a[(i, j)] * scale[i] * scale[j] + f64::from(u8::from(i == j)) * 1e-9);
    Some((scaled.cholesky()?, scale))
}

/// Coefficients from sums; `less` is taken out of them.
pub(in crate::recording::audit) fn coefficients(sum: &Sums, less: Option<&Sums>) -> Option<Vec<f64>> {
    let b = DVector::from_fn(sum.response.len(), |i, _| sum.response[i] - less.map_or(0.0, |l| l.response[i]));
    let (normal, scale) = normal(sum, less)?;
    let solved = normal.solve(&b.component_mul(&scale)).component_mul(&scale);
    Some(solved.iter().copied().collect())
}

/// Runs of one sample period in which a channel is of the usual size, and with which a run is compared.
pub(in crate::recording::audit) struct Pool<'c> {
    step: f64,
    known: Vec<&'c Curve>,
    sum: Sums,
}

impl<'c> Pool<'c> {
    /// Those of some runs in which the `size` of the channel is at most so many times that of the middle one: a run with a damaged
    /// sample would outweigh all others. The middle one is of those in which the channel moves: where most runs are sailed at one rate of
    /// the propeller, what it does is in the others. `None` for fewer than [`POOLED_RUNS`].
    pub(in crate::recording::audit) fn new(
        curves: &[Option<&'c Curve>],
        size: impl Fn(&Curve) -> f64,
        most: f64,
    ) -> Option<Self> {
        let step = curves.iter().flatten().next()?.step;
        let sizes = || curves.iter().flatten().map(|c| size(c));
        let largest = sizes().fold(0.0, f64::max);
        let middle = median(sizes().filter(|size| *size > POOLED_STILL * largest))?;
        let usual = |c: &&Curve| is_step(c, step) && size(c) <= most * middle;
        let known: Vec<&Curve> = curves.iter().flatten().copied().filter(usual).collect();
        let sum = total(known.iter().copied()).filter(|_| known.len() >= POOLED_RUNS)?;
        Some(Self { step, known, sum })
    }

    /// Its runs.
    pub(in crate::recording::audit) fn runs(&self) -> impl Iterator<Item = &'c Curve> {
        self.known.iter().copied()
    }

    /// Whether a run is one of them.
    fn has(&self, curve: &Curve) -> bool {
        self.known.iter().any(|k| std::ptr::eq(*k, curve))
    }

    /// Whether a run has their sample period, so that their coefficients are its own.
    pub(in crate::recording::audit) fn is_alike(&self, curve: &Curve) -> bool {
        is_step(curve, self.step)
    }

    /// Coefficients of all runs but this one.
    pub(in crate::recording::audit) fn others(&self, curve: &Curve) -> Option<Vec<f64>> {
        coefficients(&self.sum, self.has(curve).then(|| curve.at_zero()))
    }

    /// Squares that the errors of the coefficients of the others make in a run on average, `tr(Cov A)` with A its sums of products of the
    /// channel's own columns: where the channel only jitters in the others, they do not say what it does. `usual` is what is left of a window;
    /// windows overlap, so that these are worth fewer samples.
    fn unsure(&self, curve: &Curve, usual: f64) -> Option<f64> {
        let (normal, scale) = normal(&self.sum, self.has(curve).then(|| curve.at_zero()))?;
        let (inverse, n) = (normal.inverse(), scale.len());
        let own = curve.own.min(n);
        let products = &curve.at_zero().columns;
        let trace: f64 = (0..own)
            .flat_map(|i| (0..own).map(move |j| (i, j)))
            .map(|(i, j)| inverse[(i, j)] * scale[i] * scale[j] * products[j * n + i])
            .sum();
        Some(usual * curve.rows / curve.samples * trace)
    }

    /// What the coefficients of the others usually leave of a run, squared and by window; `None` where they leave nothing.
    pub(in crate::recording::audit) fn usual(&self) -> Option<f64> {
        let square = |c: &Curve| Some(c.at_zero().left(&self.others(c)?) / c.rows);
        median(self.runs().filter_map(square)).filter(|u| *u > 0.0)
    }
}

fn is_step(curve: &Curve, step: f64) -> bool {
    (curve.step / step - 1.0).abs() < 0.01
}

/// What is odd in each run, in their order, compared with the pool and with the other runs of its recording. `worth` says which lags
/// \\[s\\] matter.
pub(in crate::recording::audit) fn odd(
    curves: &[Option<&Curve>],
    pool: &Pool,
    sources: &Sources,
    worth: impl Fn(f64) -> bool,
) -> Vec<Option<Odd>> {
    let usual = pool.usual();
    let alike = |run: usize| curves[run].filter(|c| pool.is_alike(c));
    let judged = |run: usize| {
        let curve = alike(run)?;
        let others = pool.others(curve)?;
        let usually = usual.map(|usual| usual * curve.rows);
        let unsure = usual.and_then(|usual| pool.unsure(curve, usual));
        let expected = usually.zip(unsure).map(|(usually, unsure)| usually + unsure);
        // Where the error of the coefficients would leave more than the motion itself does, as of a propeller that rests in the other runs but
        // for the noise of its record, they do not say what the motion must answer.
        let known = usually.zip(unsure).is_some_and(|(usually, unsure)| unsure <= usually);
        let unanswered = || (known && is_unanswered(curve, &others, expected?)).then_some(Odd::Unanswered);
        let found = judged(curve, &others, expected.unwrap_or(0.0), &worth).or_else(unanswered)?;
        sources.agree(run, |other| losses(alike(other)?, &others, found)).then_some(found)
    };
    (0..curves.len()).map(judged).collect()
}

/// Squares that coefficients leave of a run as it is, and with what is odd; `None` where it does not have the lag.
fn losses(curve: &Curve, others: &[f64], odd: Odd) -> Option<[f64; 2]> {
    match odd {
        Odd::Turned => Some([curve.at_zero().left(others), curve.at_zero().left(&to_the_other_side(curve, others))]),
        Odd::Late(seconds) => {
            let place = curve.at(seconds)?;
            Some([curve.at_zero_beside(place).left(others), curve.sums[place].left(others)])
        }
        Odd::Unanswered => Some([curve.at_zero().left(others), curve.at_zero().left_without(curve.own, others)]),
    }
}

/// The coefficients of a channel that acts to the other side.
fn to_the_other_side(curve: &Curve, others: &[f64]) -> Vec<f64> {
    others.iter().enumerate().map(|(i, c)| if i < curve.own { -c } else { *c }).collect()
}

/// The runs with which the effect of an actuator is compared.
pub(in crate::recording::audit) fn actuated<'c>(curves: &[Option<&'c Curve>]) -> Option<Pool<'c>> {
    let size = |c: &Curve| c.at_zero().columns.first().copied().unwrap_or(0.0) / c.rows;
    Pool::new(curves, size, POOLED_SIZE)
}

/// What the coefficients of the other runs leave of each run at the lag that its own regression finds, as a share of what they leave at
/// none; `None` where there are too few others.
pub(in crate::recording::audit) fn shares_at_best(curves: &[Option<&Curve>], pool: &Pool) -> Vec<Option<f64>> {
    let share = |curve: &Option<&Curve>| {
        let curve = curve.filter(|c| pool.is_alike(c))?;
        let (others, best) = (pool.others(curve)?, curve.best());
        Some(curve.sums[best].left(&others) / curve.at_zero_beside(best).left(&others))
    };
    curves.iter().map(share).collect()
}

/// Whether a run by itself shows no effect of the channel, and is explained better without it than with its effect in the other runs,
/// which leaves more than is expected of a sound run.
fn is_unanswered(curve: &Curve, others: &[f64], expected: f64) -> bool {
    let sums = curve.at_zero();
    let (as_it_is, nothing) = (sums.left(others), sums.left_without(curve.own, others));
    let evidence = curve.samples * (as_it_is - nothing) / nothing.max(expected);
    curve.side().abs() < POOLED_EVIDENCE && as_it_is > POOLED_UNUSUAL * expected && evidence > SCALE_EVIDENCE
}

/// What is odd in a run, given the coefficients of the others: the explanation with the most evidence, over the windows that it shares with
/// the run as it is. To the other side acts only what leaves more than is `expected` of a sound run: what is usually left of one, and the
/// error of the others' coefficients.
fn judged(curve: &Curve, others: &[f64], expected: f64, worth: &impl Fn(f64) -> bool) -> Option<Odd> {
    let turned = to_the_other_side(curve, others);
    let zero = curve.zero();
    // A run that does not show by itself that the channel acts to the other side is not judged by the others, and neither is one that is as
    // usual.
    let of_side = curve.side() < -OWN_SIDE && curve.at_zero().left(others) > POOLED_UNUSUAL * expected;
    let mut best: Option<(f64, Odd)> = None;
    for (place, sums) in curve.sums.iter().enumerate() {
        let seconds = curve.seconds(place);
        let inside = place > 0 && place + 1 < curve.sums.len();
        let as_it_is = curve.at_zero_beside(place);
        let (before, nothing) = (as_it_is.left(others), as_it_is.left_without(curve.own, others));
        let candidates = [
            (worth(seconds) && inside).then(|| (sums.left(others), Odd::Late(seconds))),
            (place == zero && of_side).then(|| (sums.left(&turned), Odd::Turned)),
        ];
        for (left, what) in candidates.into_iter().flatten() {
            let evidence = curve.samples * (before - left) / left.max(f64::MIN_POSITIVE);
            // Where the run by itself is explained best by this lag, it is not the best of many.
            let least = if inside && place == curve.best() { POOLED_AGREED } else { POOLED_EVIDENCE };
            let better = left < POOLED_LEAVES * before && left < EXPLAINS * nothing && evidence > least;
            if better && best.is_none_or(|(most, _)| evidence > most) {
                best = Some((evidence, what));
            }
        }
    }
    best.map(|(_, what)| what)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::audit::example::noise;
    use crate::recording::audit::motion::response::rudder;
    use crate::recording::audit::motion::series::Series;
    use crate::recording::{Channel, Recording};

    /// A run that answers to its channel with 0.8, against 0.8 to the other side in the other runs; `sign` is what its own regression
    /// says, with other columns of its own.
    fn run(sign: f64) -> Curve {
        let sums = Sums { columns: vec![1.0], response: vec![0.8], squares: 1.0 };
        Curve {
            step: 2.0,
            lags: vec![0],
            left: vec![1.0],
            sign: vec![sign],
            without: 3.0,
            samples: 40.0,
            rows: 40.0,
            beside: [sums.clone(), sums.clone()],
            sums: vec![sums],
            own: 1,
            plateaus: Vec::new(),
            blur: 0.0,
        }
    }

    /// What is odd in each run, with no lag that matters.
    fn among(curves: &[Option<&Curve>], sources: &Sources) -> Vec<Option<Odd>> {
        odd(curves, &actuated(curves).unwrap(), sources, |_| false)
    }

    #[test]
    fn a_run_of_a_recording_whose_other_runs_are_sound_is_not_turned() {
        // The last one answers to the other side, and is not significant by itself.
        let curves: Vec<Curve> = (0..9).map(|i| run(if i < 8 { 1.0 } else { -1.0 })).collect();
        let mut curves = curves;
        curves[8].sums[0].response[0] *= -1.0;
        let all: Vec<Option<&Curve>> = curves.iter().map(Some).collect();
        let odd = |sources: Sources| among(&all, &sources);
        let found = odd(Sources::of(0..9));
        assert!(found[..8].iter().all(Option::is_none) && found[8] == Some(Odd::Turned), "{found:?}");
        assert_eq!(odd(Sources::of(std::iter::repeat_n("log", 9))), [None; 9]);
        // A file that is turned is turned in all of its runs.
        curves[7] = curves[8].clone();
        let all: Vec<Option<&Curve>> = curves.iter().map(Some).collect();
        let found = among(&all, &Sources::of((0..9).map(|i| i.min(7))));
        assert!(found[..7].iter().all(Option::is_none) && found[7..] == [Some(Odd::Turned); 2], "{found:?}");
    }

    #[test]
    fn runs_in_which_the_channel_rests_do_not_outvote_those_that_show_what_it_does() {
        let mut curves: Vec<Curve> = (0..29).map(|i| run(if i == 28 { -1.0 } else { 1.0 })).collect();
        for still in &mut curves[..20] {
            // But for rounding.
            (still.sums[0].columns, still.sums[0].response) = (vec![1e-18], vec![1e-19]);
        }
        curves[28].sums[0].response[0] *= -1.0;
        let all: Vec<Option<&Curve>> = curves.iter().map(Some).collect();
        let found = among(&all, &Sources::of(0..29));
        assert!(found[..28].iter().all(Option::is_none) && found[28] == Some(Odd::Turned), "{found:?}");
    }

    #[test]
    fn a_channel_that_a_run_does_not_answer_is_reported_where_the_others_would_answer_it() {
        // `moves` is how much the channel moves in the last run, which does not answer it; `shows` whether it says something else by itself.
        let found = |moves: f64, shows: bool| {
            let mut curves = vec![run(1.0); 9];
            curves[8].sums[0] = Sums { columns: vec![moves], response: vec![0.0], squares: 0.4 };
            curves[8].without = if shows { 3.0 } else { curves[8].left[0] };
            let all: Vec<Option<&Curve>> = curves.iter().map(Some).collect();
            among(&all, &Sources::of(0..9))
        };
        let unanswered = found(4.0, false);
        assert!(
            unanswered[..8].iter().all(Option::is_none) && unanswered[8] == Some(Odd::Unanswered),
            "{unanswered:?}"
        );
        for (moves, shows) in [(0.1, false), (4.0, true)] {
            assert_eq!(found(moves, shows), [None; 9]);
        }
    }

    #[test]
    fn what_the_others_show_by_jitter_alone_is_no_answer_that_a_run_must_give() {
        // In the others the channel moves by a hundredth of what it moves by in the last.
        let mut curves = vec![run(1.0); 9];
        for still in &mut curves[..8] {
            still.sums[0] = Sums { columns: vec![1e-4], response: vec![8e-5], squares: 1.0 };
        }
        curves[8].sums[0] = Sums { columns: vec![4.0], response: vec![0.0], squares: 0.4 };
        curves[8].without = curves[8].left[0];
        let all: Vec<Option<&Curve>> = curves.iter().map(Some).collect();
        let pool = Pool::new(&all[..8], |_| 1.0, 5.0).unwrap();
        assert_eq!(odd(&all, &pool, &Sources::of(0..9), |_| false), [None; 9]);
    }

    #[test]
    fn a_rudder_does_less_in_a_slow_run_and_that_is_not_odd() {
        // A ship at this speed under a rudder that swings, and of which this share acts.
        let swung = |seed: u32, speed: f64, acts: f64| {
            let mut unit = noise(seed);
            let mut columns: [Vec<f64>; 4] = Default::default();
            let mut r = 0.0;
            for i in 0..160 {
                let delta = 0.3 * (f64::from(i) * (0.06 + 0.01 * f64::from(seed))).sin().signum();
                let row = [2.0 * f64::from(i), speed + 0.02 * unit(), r + 2e-3 * unit(), delta];
                columns.iter_mut().zip(row).for_each(|(c, value)| c.push(value));
                r += (3e-3 * speed * speed * acts * delta - r) / 8.0;
            }
            let names = [Channel::T, Channel::U, Channel::R, Channel::Delta];
            let recording = Recording::from_channels("run", names.into_iter().zip(columns).collect()).unwrap();
            rudder(&Series::from(&recording)).unwrap()
        };
        let found = |speed: f64, acts: f64| {
            let curves: Vec<Curve> = (0..8).map(|i| swung(i + 1, 4.0, 1.0)).chain([swung(9, speed, acts)]).collect();
            among(&curves.iter().map(Some).collect::<Vec<_>>(), &Sources::of(0..9))
        };
        assert_eq!(found(0.5, 1.0), [None; 9]);
        // As one in degrees that counts as radians does at the usual speed.
        let small = found(4.0, 0.02);
        assert!(small[..8].iter().all(Option::is_none) && small[8] == Some(Odd::Unanswered), "{small:?}");
    }

    #[test]
    fn a_run_that_shows_its_own_side_is_not_turned_by_what_the_others_say() {
        let judged = |sign: f64| judged(&run(sign), &[-0.8], 0.0, &|_| false);
        assert_eq!((judged(-1.0), judged(1.0)), (Some(Odd::Turned), None));
    }
}
