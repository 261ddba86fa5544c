//! A push: the same constant force in windows of some runs, sought in the evidence of blocks, and the windows of single runs.
//! Whether a push is an event and no form of the ship's own forces is decided elsewhere.

use super::blocks::{Blocks, Span, block_length};
use crate::diagnose::settings::{PUSH_PRIOR, PUSH_ROUNDS, PUSH_STARTS};
use crate::likelihood::estimate::Estimate;
use crate::likelihood::evidence::chi_squared_p;
use crate::likelihood::filter::{Filter, Pass, Wanted};
use crate::likelihood::noise::Noise;
use crate::recording::Run;
use crate::simulate::Integration;
use crate::state::{Inputs, State};
use crate::statistics::counted;
use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;
use serde::Serialize;
use std::collections::BTreeMap;

/// Name of a force for a limited time.
pub const PUSH: &str = "push";

/// A time window in which a force acts that the model does not have.
#[derive(Clone, Debug, Serialize)]
pub struct Window {
    /// The recording.
    pub run: String,
    /// Its session.
    pub session: String,
    /// First second of the window, on the recording's clock.
    pub start: f64,
    /// Last second.
    pub end: f64,
    /// Mean force there: X, Y \[N\], N \[N m\].
    pub force: [f64; 3],
    /// Standard errors.
    pub error: [f64; 3],
    /// Twice the gain in log-likelihood.
    pub statistic: f64,
    /// p-value, corrected for every window of every run that was looked at.
    pub p: f64,
    /// Index of the run.
    #[serde(skip)]
    pub index: usize,
    /// Sample range.
    #[serde(skip)]
    pub samples: (usize, usize),
}

/// The same force in windows of some runs.
#[derive(Clone, Debug, Serialize)]
pub struct Push {
    /// The force: X, Y \[N\], N \[N m\].
    pub force: [f64; 3],
    /// Standard errors.
    pub error: [f64; 3],
    /// Twice the gain in log-likelihood where neither the runs nor their windows are known: beforehand a fifth of the runs have
    /// it, in any of their spans.
    pub statistic: f64,
    /// Share of the evidence for it that sway force and yaw moment give by themselves, 0 to 1.
    pub sideways: f64,
    /// Evidence for its mirror image (the same surge force, sway force and yaw moment to the other side) in windows of its own,
    /// as a share of its own evidence: the ship's motion brings forces to both sides, a push from outside does not.
    pub mirrored: f64,
    /// When it acts.
    pub windows: Vec<Window>,
}

impl Push {
    /// How many recordings of equal evidence those in which it acts count as: windows of one recording are no independent
    /// evidence, and faint windows of others do not make one strong window repeat.
    pub fn recordings(&self) -> usize {
        let mut evidence: BTreeMap<&str, f64> = BTreeMap::new();
        for w in &self.windows {
            *evidence.entry(&w.run).or_default() += w.statistic;
        }
        counted(evidence.into_values()).round() as usize
    }
}

/// p-value, corrected for every window, below which a window is listed.
const WINDOW_P: f64 = 0.01;

/// Most windows that are listed of a run.
const WINDOWS: usize = 3;

/// The significant windows of all runs, the most significant first, not overlapping within a run. `looked_at` is the number of
/// windows of all runs, and `unit` the scales of the forces \[N, N, N m\].
pub fn significant(runs: &[Run], blocks: &[Blocks], unit: &[f64; 3], looked_at: f64) -> Vec<Window> {
    let of = |(index, (run, b)): (usize, (&Run, &Blocks))| -> Vec<Window> {
        scan(b, looked_at).iter().map(|s| window(run, index, b.length, s, looked_at, unit)).collect()
    };
    let mut out: Vec<Window> = runs.par_iter().zip(blocks).enumerate().flat_map_iter(of).collect();
    out.sort_by(|a, b| b.statistic.total_cmp(&a.statistic));
    out
}

/// A span of blocks as a window of its run.
fn window(run: &Run, index: usize, length: usize, s: &Span, looked_at: f64, unit: &[f64; 3]) -> Window {
    let samples = (s.from * length, (s.to * length).min(run.measured.len() - 1));
    Window {
        run: run.recording.clone(),
        session: run.session.clone(),
        start: run.inputs[samples.0].t,
        end: run.inputs[samples.1].t,
        force: std::array::from_fn(|a| s.estimate[a] * unit[a]),
        error: std::array::from_fn(|a| s.inverse[(a, a)].max(0.0).sqrt() * unit[a]),
        statistic: s.statistic,
        p: (chi_squared_p(s.statistic, 3) * looked_at).min(1.0),
        index,
        samples,
    }
}

/// The significant windows of one run, greedily, not overlapping.
fn scan(blocks: &Blocks, looked_at: f64) -> Vec<Span> {
    let significant = |s: &Span| s.seen() && chi_squared_p(s.statistic, 3) * looked_at < WINDOW_P;
    let mut candidates: Vec<Span> =
        blocks.spans().filter_map(|(from, to)| blocks.fit(from, to)).filter(significant).collect();
    candidates.sort_by(|a, b| b.statistic.total_cmp(&a.statistic));
    let mut out: Vec<Span> = Vec::new();
    for c in candidates {
        if out.len() < WINDOWS && out.iter().all(|s| c.from >= s.to || s.from >= c.to) {
            out.push(c);
        }
    }
    out
}

/// Looks for one force that acts in unknown windows of unknown runs: alternately the windows in which the force gains most,
/// and the force that fits them best, from several starts. The strongest first.
pub fn pushes(runs: &[Run], blocks: &[Blocks], unit: &[f64; 3], looked_at: f64) -> Vec<Push> {
    let mut out: Vec<Push> = Vec::new();
    for start in starts(blocks) {
        let Some(fit) = PushFit::from(start, blocks) else { continue };
        let same = |p: &Push| (p.statistic - fit.statistic).abs() < 1e-6 * fit.statistic.abs();
        if !out.iter().any(same) {
            out.extend(fit.push(runs, blocks, unit, looked_at));
        }
    }
    out.sort_by(|a, b| b.statistic.total_cmp(&a.statistic));
    out
}

/// The spans from which the search starts: the best of every run, of which the best.
fn starts(blocks: &[Blocks]) -> Vec<Span> {
    let best = |b: &Blocks| {
        let fits = b.local_spans().filter_map(|(from, to)| b.fit(from, to)).filter(Span::seen);
        fits.max_by(|a, b| a.statistic.total_cmp(&b.statistic))
    };
    let mut out: Vec<Span> = blocks.iter().filter_map(best).collect();
    out.sort_by(|a, b| b.statistic.total_cmp(&a.statistic));
    out.truncate(PUSH_STARTS);
    out
}

/// A span of a run: its index, first block and the one after the last.
type Place = (usize, usize, usize);

/// The spans of the runs that rather have the force than not, and twice the logarithm of how much likelier all runs are when some
/// of them have it, in any of their spans, than when none has.
fn chosen(blocks: &[Blocks], force: &Vector3<f64>) -> (Vec<Place>, f64) {
    let mut spans = Vec::new();
    let (mut statistic, mut gains) = (0.0, Vec::new());
    for (index, b) in blocks.iter().enumerate() {
        b.local_gains(force, &mut gains);
        let Some((from, to, most)) = gains.iter().copied().max_by(|a, b| a.2.total_cmp(&b.2)) else { continue };
        let mean = gains.iter().map(|g| (g.2 - most).exp()).sum::<f64>() / gains.len() as f64;
        let (with, without) = ((PUSH_PRIOR * mean).ln() + most, (1.0 - PUSH_PRIOR).ln());
        if with > without {
            spans.push((index, from, to));
        }
        statistic += 2.0 * (with.max(without) + (-(with - without).abs()).exp().ln_1p());
    }
    (spans, statistic)
}

/// A force with the spans in which it acts.
struct PushFit {
    force: Vector3<f64>,
    /// Its covariance.
    inverse: Matrix3<f64>,
    spans: Vec<Place>,
    statistic: f64,
}

impl PushFit {
    /// Alternates between spans and force from a start; `None` where no run has the force.
    fn from(start: Span, blocks: &[Blocks]) -> Option<Self> {
        let (mut force, mut inverse) = (start.estimate, start.inverse);
        let (mut spans, mut statistic) = chosen(blocks, &force);
        for _ in 0..PUSH_ROUNDS {
            let (mut score, mut information) = (Vector3::zeros(), Matrix3::zeros());
            for (index, from, to) in &spans {
                let (g, h) = blocks[*index].span(*from, *to);
                score += g;
                information += h;
            }
            let Some(i) = information.try_inverse() else { break };
            (inverse, force) = (i, i * score);
            (spans, statistic) = chosen(blocks, &force);
        }
        (!spans.is_empty()).then_some(Self { force, inverse, spans, statistic })
    }

    /// The push in units of force, with its share across the keel and the statistic of its mirror image.
    fn push(&self, runs: &[Run], blocks: &[Blocks], unit: &[f64; 3], looked_at: f64) -> Option<Push> {
        let Self { force, inverse, spans, statistic } = self;
        // With the surge force free, against all three.
        let across = inverse.fixed_view::<2, 2>(1, 1).into_owned().try_inverse()?;
        let all = inverse.try_inverse()?;
        let side = force.fixed_rows::<2>(1).into_owned();
        let (_, image) = chosen(blocks, &Vector3::new(force[0], -force[1], -force[2]));
        let fitted = |(index, from, to): &Place| {
            let b = &blocks[*index];
            Some(window(&runs[*index], *index, b.length, &b.fit(*from, *to)?, looked_at, unit))
        };
        Some(Push {
            sideways: side.dot(&(across * side)) / force.dot(&(all * force)).max(f64::MIN_POSITIVE),
            mirrored: image.max(0.0) / statistic.max(f64::MIN_POSITIVE),
            force: std::array::from_fn(|a| force[a] * unit[a]),
            error: std::array::from_fn(|a| inverse[(a, a)].max(0.0).sqrt() * unit[a]),
            statistic: *statistic,
            windows: spans.iter().filter_map(fitted).collect(),
        })
    }
}

/// A push with the edges of its windows moved, by up to a block, to the samples at which its force gains most. `found` is the
/// estimate whose innovations it explains. A window in a run that was divided since is kept.
pub fn sharpened(push: &Push, found: &Estimate, integration: Integration, runs: &[Run]) -> Push {
    let filter = Filter::new(&found.model, integration, &[]);
    let force = Vector3::from_fn(|e, _| push.force[e] / found.noise.force[e]);
    let length = block_length(runs);
    let sharp = |w: &Window| {
        let (from, to) = w.samples;
        let same = |r: &&Run| r.recording == w.run && to < r.inputs.len() && r.inputs[from].t == w.start;
        let Some(run) = runs.get(w.index).filter(same) else { return w.clone() };
        // The unknown force is not set free in the windows, so that the samples show the push.
        let run = Run { disturbed: Vec::new(), ..run.clone() };
        let (from, to) = edges(&filter, &found.noise, &run, w.samples, length, &force);
        Window { samples: (from, to), start: run.inputs[from].t, end: run.inputs[to].t, ..w.clone() }
    };
    Push { windows: push.windows.par_iter().map(sharp).collect(), ..push.clone() }
}

/// First and last sample of a window whose edges are within `length` samples of these, where a force gains most.
fn edges(
    filter: &Filter,
    noise: &Noise,
    run: &Run,
    samples: (usize, usize),
    length: usize,
    force: &Vector3<f64>,
) -> (usize, usize) {
    let (a, b) = samples;
    let middle = a.midpoint(b);
    let first = a.saturating_sub(length)..(a + length + 1).min(middle + 1);
    let last = (middle + 1).max(b.saturating_sub(length))..(b + length + 1).min(run.measured.len());
    let inside = first.len();
    let limits: Vec<usize> = first.chain(last).collect();
    let count = limits.len().saturating_sub(1);
    let basis = |(_, k): (usize, usize), _: &State<f64>, _: &Inputs<f64>, out: &mut Vec<[f64; 3]>| {
        out.clear();
        out.resize(3 * count, [0.0; 3]);
        let piece = limits.partition_point(|l| *l <= k);
        if (1..=count).contains(&piece) {
            for e in 0..3 {
                out[3 * (piece - 1) + e][e] = noise.force[e];
            }
        }
    };
    let Pass { score, information, .. } =
        filter.pass(run, noise, Wanted { basis: Some((3 * count, &basis)), ..Wanted::default() });
    let pieces = Blocks::sums(1, count, &score, &information);
    let gain = |(from, to): &(usize, usize)| pieces.gain(*from, *to, force);
    let choices = (0..inside).flat_map(|from| (inside..=count).map(move |to| (from, to)));
    let best = choices.max_by(|a, b| gain(a).total_cmp(&gain(b)));
    best.map_or(samples, |(from, to)| (limits[from], limits[to]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::likelihood::noise::fit::guess;
    use crate::model::Model;
    use crate::physics::Form;
    use crate::recording::Split;
    use crate::ship::Ship;
    use crate::state::{Inputs, STATES};
    use nalgebra::{DMatrix, DVector};
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use rand_distr::StandardNormal;
    use std::path::Path;

    /// Samples in a block here.
    const LENGTH: usize = 5;

    /// Sixteen blocks whose forces are measured with unit error each; in some runs one acts for six of them.
    fn measured(force: [f64; 3], acts: impl Fn(usize) -> bool, seed: u64) -> (Vec<Run>, Vec<Blocks>) {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let count = 16;
        let one = |index: usize| {
            let from = 2 + index % 8;
            let mut score = DVector::zeros(3 * count);
            for i in 0..count {
                let inside = acts(index) && (from..from + 6).contains(&i);
                let noise = Vector3::from_fn(|_, _| rng.sample(StandardNormal));
                let step = noise + Vector3::from(force) * f64::from(u8::from(inside));
                score.rows_mut(3 * i, 3).copy_from(&step);
            }
            let blocks = Blocks::sums(LENGTH, count, &score, &DMatrix::identity(3 * count, 3 * count));
            let run = Run {
                name: format!("run {index} 0 s"),
                recording: format!("run {index}"),
                session: "one".into(),
                manoeuvre: String::new(),
                split: Split::Train,
                dt: 2.0,
                recorded_dt: 2.0,
                inputs: (0..count * LENGTH).map(|k| Inputs::actuators(2.0 * k as f64, 1.0, 0.0)).collect(),
                measured: vec![[Some(0.0); STATES]; count * LENGTH],
                initial: [0.0; STATES],
                disturbed: Vec::new(),
                derived: [false; STATES],
            };
            (run, blocks)
        };
        (0..30).map(one).unzip()
    }

    fn strongest(force: [f64; 3], acts: impl Fn(usize) -> bool, seed: u64) -> Push {
        let (runs, blocks) = measured(force, acts, seed);
        pushes(&runs, &blocks, &[1.0; 3], 1.0).swap_remove(0)
    }

    #[test]
    fn one_strong_window_and_faint_ones_elsewhere_are_one_recording_and_windows_of_one_do_not_add() {
        let (runs, blocks) = measured([0.0, 3.0, 2.0], |i| i == 3, 1);
        let push = pushes(&runs, &blocks, &[1.0; 3], 1.0).swap_remove(0);
        let of = |windows: &[(&str, f64)]| {
            let window = |(run, statistic): &(&str, f64)| Window {
                run: (*run).into(),
                statistic: *statistic,
                ..push.windows[0].clone()
            };
            Push { windows: windows.iter().map(window).collect(), ..push.clone() }.recordings()
        };
        assert_eq!(of(&[("a", 200.0), ("b", 10.0), ("c", 15.0), ("d", 10.0)]), 1);
        assert_eq!(of(&[("a", 40.0), ("b", 30.0), ("c", 50.0), ("d", 40.0)]), 4);
        assert_eq!(of(&[("a", 20.0), ("a", 20.0), ("b", 40.0)]), 2);
    }

    #[test]
    fn a_window_in_a_run_that_was_divided_since_keeps_its_edges() {
        let ship = Ship::read(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/experiments/ships/a.toml"))).unwrap();
        let model = Model::new(ship, "HD", Form::Regular, &[]).unwrap();
        let (runs, blocks) = measured([0.0, 3.0, 2.0], |i| i == 3, 1);
        let push = pushes(&runs, &blocks, &[1.0; 3], 1.0).swap_remove(0);
        let noise = guess(&runs, &model);
        let found = Estimate { model, noise, free: Vec::new(), log_posterior: 0.0, seen: None };
        let windows = |runs: &[Run]| {
            let sharp = sharpened(&push, &found, Integration::default(), runs);
            sharp.windows.iter().map(|w| w.samples).collect::<Vec<_>>()
        };
        let before: Vec<_> = push.windows.iter().map(|w| w.samples).collect();
        let mut divided = runs.clone();
        for r in &mut divided {
            r.inputs.drain(..20);
            r.measured.drain(..20);
        }
        assert_eq!(windows(&divided), before);
        assert_eq!(windows(&runs[..1]), before);
        assert_eq!(windows(&runs).len(), before.len());
    }

    #[test]
    fn noise_alone_gives_no_significant_push() {
        for seed in 0..20 {
            let push = strongest([0.0; 3], |_| false, seed);
            assert!(push.statistic < 12.0, "seed {seed}: {} in {} runs", push.statistic, push.recordings());
        }
    }

    #[test]
    fn a_weak_push_in_many_runs_is_found_with_its_windows() {
        for seed in 0..5 {
            let push = strongest([0.0, 1.6, 1.1], |i| i % 3 == 0, seed);
            assert!(push.statistic > 40.0, "seed {seed}: {}", push.statistic);
            assert!(push.sideways > 0.9 && push.mirrored < 0.1, "seed {seed}: {} {}", push.sideways, push.mirrored);
            let right = |w: &&Window| {
                let start = 2.0 * (LENGTH * (2 + w.index % 8)) as f64;
                w.index.is_multiple_of(3) && w.end.min(start + 60.0) - w.start.max(start) > 30.0
            };
            let found = push.windows.iter().filter(right).count();
            assert!(found >= 7 && push.windows.len() <= found + 2, "seed {seed}: {found} of {}", push.windows.len());
        }
    }
}
