//! Where an unknown force acts: in which equation, when, in which region of state and inputs.
//! It tests constant forces in windows and regions against the base; what the force is, is not asked here.

use super::estimate::{Estimate, base_of, restrictions};
use super::evidence::{Base, Evidence, RunEvidence, chi_squared_p, pick};
use super::filter::{Column, Filter, Pass, Wanted};
use super::noise::Noise;
use super::screen::{basis_columns, widen};
use crate::model::Model;
use crate::recording::Run;
use crate::simulate::Integration;
use crate::state::{Inputs, State};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use rayon::prelude::*;
use serde::Serialize;
use statrs::statistics::{Data, OrderStatistics};
use std::collections::BTreeSet;

/// The time scan goes in at most so many blocks a run, of at least two samples each: the evidence for a force that sets in is
/// mostly in when it does, and a run cut more finely costs more than it tells.
const MOST_BLOCKS: usize = 64;

/// Samples in one block of the time scan.
fn block_length(runs: &[Run]) -> usize {
    let longest = runs.iter().map(|r| r.measured.len()).max().unwrap_or(0);
    longest.div_ceil(MOST_BLOCKS).max(2)
}

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

/// A region of state and inputs in which a force acts that the model does not have.
#[derive(Clone, Debug, Serialize)]
pub struct RegionTest {
    /// The region in words.
    pub region: String,
    /// Share of all samples that lie in it.
    pub samples: f64,
    /// Mean force there: X, Y \[N\], N \[N m\].
    pub force: [f64; 3],
    /// Standard errors.
    pub error: [f64; 3],
    /// Twice the gain in log-likelihood.
    pub statistic: f64,
    /// p-value, corrected for the number of regions.
    pub p: f64,
}

/// Unexplained force in one equation.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct EquationShare {
    /// Share of the unexplained force, in terms of its significance, 0 to 1.
    pub share: f64,
    /// Root mean square of the unexplained force \[N, or N m for yaw\].
    pub rms: f64,
    /// Standard deviation of the unknown force in the noise model \[N, or N m for yaw\].
    pub sigma: f64,
}

type Predicate = fn(&Model, &State<f64>, &Inputs<f64>) -> bool;

fn speed_unit(model: &Model) -> f64 {
    (9.80665 * model.ship.hull.lpp).sqrt()
}

fn quadrant(s: &State<f64>, q: i32) -> bool {
    (s.psi / std::f64::consts::FRAC_PI_2).round().rem_euclid(4.0) as i32 == q
}

const REGIONS: [(&str, Predicate); 12] = [
    ("propeller astern (n < 0)", |_, _, i| i.n < 0.0),
    ("sternway (u < 0)", |m, s, _| s.u < -0.003 * speed_unit(m)),
    ("low speed (Fn < 0.05)", |m, s, _| s.u.hypot(s.v) < 0.05 * speed_unit(m)),
    ("high speed (Fn > 0.15)", |m, s, _| s.u.hypot(s.v) > 0.15 * speed_unit(m)),
    ("large drift (over 20 deg)", |m, s, _| s.u.hypot(s.v) > 0.01 * speed_unit(m) && s.v.abs() > 0.34 * s.u.hypot(s.v)),
    ("hard rudder (over 25 deg)", |_, _, i| i.delta.abs() > 0.436),
    ("turning to starboard", |m, s, _| s.r > 0.005 * speed_unit(m) / m.ship.hull.lpp),
    ("turning to port", |m, s, _| s.r < -0.005 * speed_unit(m) / m.ship.hull.lpp),
    ("heading north", |_, s, _| quadrant(s, 0)),
    ("heading east", |_, s, _| quadrant(s, 1)),
    ("heading south", |_, s, _| quadrant(s, 2)),
    ("heading west", |_, s, _| quadrant(s, 3)),
];

/// A force fixed on the earth that is another in one part of the water than in the rest.
#[derive(Clone, Debug, Serialize)]
pub struct Place {
    /// Southern and northern limit of the part where it stands out most \[m\].
    pub north: [f64; 2],
    /// Western and eastern limit \[m\].
    pub east: [f64; 2],
    /// Force there, less what acts everywhere: north, east \[N\].
    pub force: [f64; 2],
    /// Standard errors.
    pub error: [f64; 2],
    /// Twice the gain in log-likelihood of a force of its own in each of [`PARTS`] x [`PARTS`] parts over one that is the same everywhere.
    pub statistic: f64,
    /// Degrees of freedom.
    pub degrees: usize,
    /// p-value.
    pub p: f64,
}

/// Parts into which the water sailed is divided each way.
pub const PARTS: usize = 3;

/// The water that was sailed, in parts.
struct Chart {
    low: [f64; 2],
    high: [f64; 2],
}

impl Chart {
    /// Of all measured positions but the outermost two per cent each way.
    fn of(runs: &[Run]) -> Option<Self> {
        let limits = |axis: usize| {
            let all = runs.iter().flat_map(|r| &r.measured).filter_map(|m| m[axis]);
            let mut all = Data::new(all.collect::<Vec<f64>>());
            (all.quantile(0.02), all.quantile(0.98))
        };
        let ((south, north), (west, east)) = (limits(0), limits(1));
        (north > south && east > west).then_some(Self { low: [south, west], high: [north, east] })
    }

    /// Which part a position is in; the outermost parts reach as far as one likes.
    fn part(&self, position: [f64; 2]) -> usize {
        let [i, j]: [usize; 2] = std::array::from_fn(|a| {
            let share = (position[a] - self.low[a]) / (self.high[a] - self.low[a]);
            ((share * PARTS as f64) as usize).min(PARTS - 1)
        });
        i * PARTS + j
    }

    /// Limits of a part along an axis.
    fn limits(&self, part: usize, axis: usize) -> [f64; 2] {
        let i = if axis == 0 { part / PARTS } else { part % PARTS } as f64;
        let width = (self.high[axis] - self.low[axis]) / PARTS as f64;
        [self.low[axis] + i * width, self.low[axis] + (i + 1.0) * width]
    }
}

/// What the location step found.
#[derive(Clone, Debug, Serialize)]
pub struct Location {
    /// X, Y, N.
    pub equations: [EquationShare; 3],
    /// Windows, most significant first, not overlapping within a run.
    pub windows: Vec<Window>,
    /// The same force in windows of some runs, whether it is significant or not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub push: Option<Push>,
    /// Every such force that the search came to, the strongest first.
    #[serde(skip)]
    pub pushes: Vec<Push>,
    /// Regions, most significant first.
    pub regions: Vec<RegionTest>,
    /// Whether an earth-fixed force goes with the place.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub place: Option<Place>,
}

/// Tests constant forces in every window of every run and in every region.
pub fn locate(found: &Estimate, integration: Integration, runs: &[Run]) -> Location {
    let model = &found.model;
    let mut columns: Vec<Column> = found.free.iter().map(|f| f.column).collect();
    let free = columns.len();
    for term in ["symmetric", "asymmetric"] {
        columns.extend(basis_columns(model, term).into_iter().map(|(_, column)| column));
    }
    let filter = Filter::new(model, integration, &columns);
    let length = block_length(runs);
    let blocks_in = |r: &Run| r.measured.len().div_ceil(length);
    let blocks = runs.iter().map(blocks_in).max().unwrap_or(0);
    let chart = Chart::of(runs);
    // Blocks of time, regions, and parts of the water.
    let parts = 3 * (blocks + REGIONS.len());
    let everywhere = parts + 2 * PARTS * PARTS;
    let extra = everywhere + 2;
    let basis = |k: usize, s: &State<f64>, i: &Inputs<f64>, out: &mut Vec<[f64; 3]>| {
        out.resize(extra, [0.0; 3]);
        for e in 0..3 {
            let mut f = [0.0; 3];
            f[e] = found.noise.force[e];
            out[3 * (k / length) + e] = f;
            for (j, (_, inside)) in REGIONS.iter().enumerate() {
                if inside(model, s, i) {
                    out[3 * (blocks + j) + e] = f;
                }
            }
        }
        if let Some(chart) = &chart {
            let at = parts + 2 * chart.part([s.x, s.y]);
            let (sin, cos) = s.psi.sin_cos();
            let unit = found.noise.force[1];
            for at in [at, everywhere] {
                out[at] = [unit * cos, -unit * sin, 0.0];
                out[at + 1] = [unit * sin, unit * cos, 0.0];
            }
        }
    };
    let passes: Vec<Pass> = runs
        .par_iter()
        .map(|r| filter.pass(r, &found.noise, Wanted { basis: Some((extra, &basis)), ..Wanted::default() }))
        .collect();
    let evidence = super::estimate::evidence(runs, &passes, &restrictions(&found.free));
    let base = base_of(&evidence, model, &found.free);
    // A force that comes back with the ship's state is no event: what a smooth force law can mimic is taken out of the windows.
    let widened = widen(&evidence, &base, &(free..columns.len()).collect::<Vec<_>>());
    let step = widened.step();
    let looked_at: f64 = runs.iter().map(|r| choices(blocks_in(r))).sum();
    let blocks_of: Vec<Blocks> = runs
        .par_iter()
        .zip(&evidence.runs)
        .map(|(run, e)| Blocks::new(length, blocks_in(run), e, &widened, &step, columns.len()))
        .collect();
    let mut windows: Vec<Window> = runs
        .par_iter()
        .zip(&blocks_of)
        .enumerate()
        .flat_map_iter(|(index, (run, b))| {
            scan(b, looked_at).into_iter().map(move |s| window(run, index, length, &s, looked_at, &found.noise.force))
        })
        .collect();
    let pushes = common_pushes(runs, &blocks_of, &found.noise.force, looked_at);
    windows.sort_by(|a, b| b.statistic.total_cmp(&a.statistic));
    let mut regions: Vec<RegionTest> = REGIONS
        .iter()
        .enumerate()
        .filter_map(|(j, (name, inside))| {
            let at = columns.len() + 3 * (blocks + j);
            let test = evidence.test(&base, &[at, at + 1, at + 2]);
            let (mut hit, mut all) = (0.0, 0.0);
            for (r, p) in runs.iter().zip(&passes) {
                for (z, i) in p.filtered.iter().zip(&r.inputs) {
                    let s = State { x: z[0], y: z[1], psi: z[2], u: z[3], v: z[4], r: z[5] };
                    all += 1.0;
                    hit += f64::from(u8::from(inside(model, &s, i)));
                }
            }
            (test.degrees > 0).then(|| RegionTest {
                region: (*name).into(),
                samples: hit / f64::max(all, 1.0),
                force: std::array::from_fn(|e| test.amplitude[e] * found.noise.force[e]),
                error: std::array::from_fn(|e| test.covariance[(e, e)].max(0.0).sqrt() * found.noise.force[e]),
                statistic: test.statistic,
                p: (test.p * REGIONS.len() as f64).min(1.0),
            })
        })
        .collect();
    regions.sort_by(|a, b| b.statistic.total_cmp(&a.statistic));
    let equations = equation_shares(&passes, &evidence, &base, columns.len(), blocks, &found.noise.force);
    let place = chart.and_then(|c| place(&c, &evidence, &widened, columns.len() + parts, found.noise.force[1]));
    Location { equations, windows, push: pushes.first().cloned(), pushes, regions, place }
}

/// Tests whether an earth-fixed force is another in each part of the water.
fn place(chart: &Chart, evidence: &Evidence, base: &Base, first: usize, unit: f64) -> Option<Place> {
    let sailed =
        |part: &usize| (0..2).all(|i| evidence.total.information[(first + 2 * part + i, first + 2 * part + i)] > 1e-6);
    let parts: Vec<usize> = (0..PARTS * PARTS).filter(sailed).collect();
    let own: Vec<usize> = parts.iter().flat_map(|part| [first + 2 * part, first + 2 * part + 1]).collect();
    // What is the same everywhere is the weather.
    let weather = first + 2 * PARTS * PARTS;
    let test = evidence.test(&evidence.extend(base, &[weather, weather + 1]), &own);
    let weight = |j: &usize| -> f64 {
        (2 * j..2 * j + 2).map(|i| test.amplitude[i].powi(2) / test.covariance[(i, i)].max(f64::MIN_POSITIVE)).sum()
    };
    let strongest = (0..parts.len()).max_by(|a, b| weight(a).total_cmp(&weight(b))).filter(|_| test.degrees > 0)?;
    let (part, at) = (parts[strongest], |i: usize| 2 * strongest + i);
    Some(Place {
        north: chart.limits(part, 0),
        east: chart.limits(part, 1),
        force: std::array::from_fn(|i| test.amplitude[at(i)] * unit),
        error: std::array::from_fn(|i| test.covariance[(at(i), at(i))].max(0.0).sqrt() * unit),
        statistic: test.statistic,
        degrees: test.degrees,
        p: test.p,
    })
}

/// Share of each equation in the block-wise force evidence, and the filtered force's root mean square.
fn equation_shares(
    passes: &[Pass],
    evidence: &Evidence,
    base: &Base,
    first: usize,
    blocks: usize,
    sigma: &[f64; 3],
) -> [EquationShare; 3] {
    let step = base.step();
    let mut excess = [0.0; 3];
    for e in &evidence.runs {
        for b in 0..blocks {
            for eq in 0..3 {
                let c = first + 3 * b + eq;
                let own = e.information[(c, c)];
                if own > 1e-6 {
                    let cross: f64 =
                        base.columns.iter().zip(step.iter()).map(|(j, s)| e.information[(c, *j)] * s).sum();
                    excess[eq] += ((e.score[c] - cross).powi(2) / own - 1.0).max(0.0);
                }
            }
        }
    }
    let total: f64 = excess.iter().sum::<f64>().max(f64::MIN_POSITIVE);
    let count: f64 = passes.iter().map(|p| p.filtered.len() as f64).sum::<f64>().max(1.0);
    std::array::from_fn(|eq| EquationShare {
        share: excess[eq] / total,
        rms: (passes.iter().flat_map(|p| &p.filtered).map(|z| z[6 + eq] * z[6 + eq]).sum::<f64>() / count).sqrt(),
        sigma: sigma[eq],
    })
}

/// Running sums of a run's block-wise force evidence after the base, so that every span of blocks costs the same.
struct Blocks {
    /// Samples in a block.
    length: usize,
    count: usize,
    score: Vec<Vector3<f64>>,
    information: Vec<Matrix3<f64>>,
}

impl Blocks {
    fn new(length: usize, count: usize, e: &RunEvidence, base: &Base, base_step: &DVector<f64>, first: usize) -> Self {
        let columns: Vec<usize> = (first..first + 3 * count).collect();
        let cross = pick(&e.information, &columns, &base.columns);
        let h: DMatrix<f64> = pick(&e.information, &columns, &columns) - &cross * &base.inverse * cross.transpose();
        let g = DVector::from_fn(columns.len(), |i, _| e.score[columns[i]]) - &cross * base_step;
        Self::sums(length, count, &g, &h)
    }

    /// Running sums of score and information, three columns a block.
    fn sums(length: usize, count: usize, g: &DVector<f64>, h: &DMatrix<f64>) -> Self {
        let w = count + 1;
        let mut score = vec![Vector3::zeros(); w];
        let mut information = vec![Matrix3::zeros(); w * w];
        for i in 0..count {
            score[i + 1] = score[i] + Vector3::from_fn(|a, _| g[3 * i + a]);
            for j in 0..count {
                information[(i + 1) * w + j + 1] = Matrix3::from_fn(|a, b| h[(3 * i + a, 3 * j + b)])
                    + information[i * w + j + 1]
                    + information[(i + 1) * w + j]
                    - information[i * w + j];
            }
        }
        Self { length, count, score, information }
    }

    /// Score of a constant force in blocks `from..to`, and its information.
    fn span(&self, from: usize, to: usize) -> (Vector3<f64>, Matrix3<f64>) {
        let w = self.count + 1;
        let h = self.information[to * w + to] - self.information[from * w + to] - self.information[to * w + from]
            + self.information[from * w + from];
        (self.score[to] - self.score[from], (h + h.transpose()) * 0.5)
    }

    /// What a constant force in blocks `from..to` gains in log-likelihood.
    fn gain(&self, from: usize, to: usize, force: &Vector3<f64>) -> f64 {
        let (score, information) = self.span(from, to);
        score.dot(force) - 0.5 * force.dot(&(information * force))
    }

    /// The constant force that fits blocks `from..to` best.
    fn fit(&self, from: usize, to: usize) -> Option<Span> {
        let (score, information) = self.span(from, to);
        let inverse = information.try_inverse()?;
        let estimate = inverse * score;
        let least = information.diagonal().min();
        Some(Span { statistic: score.dot(&estimate), from, to, estimate, inverse, least })
    }

    fn spans(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        let count = self.count;
        (0..count).flat_map(move |from| (from + 1..=count).map(move |to| (from, to)))
    }

    /// Spans that leave a good part of the run without the force.
    fn local_spans(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        let most = 0.7 * self.count as f64;
        self.spans().filter(move |(from, to)| (to - from) as f64 <= most)
    }
}

/// Spans of a run of `blocks` blocks.
fn choices(blocks: usize) -> f64 {
    0.5 * (blocks * (blocks + 1)) as f64
}

/// Blocks `from..to` of a run with the constant force that fits there.
struct Span {
    statistic: f64,
    from: usize,
    to: usize,
    estimate: Vector3<f64>,
    inverse: Matrix3<f64>,
    /// Least information on one component of the force.
    least: f64,
}

impl Span {
    /// Whether the data see every component of the force.
    fn seen(&self) -> bool {
        self.least >= 1e-6 && self.statistic.is_finite()
    }
}

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

/// The same push with every edge of its windows at the sample, up to a block before or after where it was, at which its force gains
/// most. `found` is the estimate beside which it stands. A window in a run that was parted since stays as it is.
pub fn sharpened(push: &Push, found: &Estimate, integration: Integration, runs: &[Run]) -> Push {
    let filter = Filter::new(&found.model, integration, &[]);
    let force = Vector3::from_fn(|e, _| push.force[e] / found.noise.force[e]);
    let length = block_length(runs);
    let sharp = |w: &Window| {
        let (from, to) = w.samples;
        let same = |r: &&Run| r.recording == w.run && to < r.inputs.len() && r.inputs[from].t == w.start;
        let Some(run) = runs.get(w.index).filter(same) else { return w.clone() };
        // What the run's samples say, as if nobody knew of the push.
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
    let basis = |k: usize, _: &State<f64>, _: &Inputs<f64>, out: &mut Vec<[f64; 3]>| {
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

/// The significant windows of one run, greedily, not overlapping.
fn scan(blocks: &Blocks, looked_at: f64) -> Vec<Span> {
    let significant = |s: &Span| s.seen() && chi_squared_p(s.statistic, 3) * looked_at < 0.01;
    let mut candidates: Vec<Span> =
        blocks.spans().filter_map(|(from, to)| blocks.fit(from, to)).filter(significant).collect();
    candidates.sort_by(|a, b| b.statistic.total_cmp(&a.statistic));
    let mut out: Vec<Span> = Vec::new();
    for c in candidates {
        if out.len() < 3 && out.iter().all(|s| c.from >= s.to || s.from >= c.to) {
            out.push(c);
        }
    }
    out
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
    /// Share of the evidence for it that sway force and yaw moment hold by themselves, 0 to 1.
    pub sideways: f64,
    /// Evidence for its mirror image (the same surge force, sway force and yaw moment to the other side) in windows of its own,
    /// as a share of its own evidence: what the ship's motion brings comes to both sides, a push from outside does not.
    pub mirrored: f64,
    /// When it acts.
    pub windows: Vec<Window>,
}

impl Push {
    /// How many recordings it acts in: windows of one recording are no evidence apart.
    pub fn recordings(&self) -> usize {
        self.windows.iter().map(|w| w.run.as_str()).collect::<BTreeSet<_>>().len()
    }
}

/// Share of the runs that a push is taken to act in beforehand.
const AFFECTED: f64 = 0.2;

/// Spans, the best of their runs, from which that search starts.
const STARTS: usize = 12;

/// Looks for one force that acts in unknown windows of unknown runs: alternately the windows in which the force gains most,
/// and the force that fits them best, from several starts. The strongest first.
fn common_pushes(runs: &[Run], blocks: &[Blocks], unit: &[f64; 3], looked_at: f64) -> Vec<Push> {
    // The best span of every run is a start.
    let mut starts: Vec<Span> = blocks
        .iter()
        .filter_map(|b| {
            let fits = b.local_spans().filter_map(|(from, to)| b.fit(from, to)).filter(Span::seen);
            fits.max_by(|a, b| a.statistic.total_cmp(&b.statistic))
        })
        .collect();
    starts.sort_by(|a, b| b.statistic.total_cmp(&a.statistic));
    starts.truncate(STARTS);
    // The spans of the runs that rather have the force than not, and twice the logarithm of how much likelier all runs are when
    // some of them have it, in any of their spans, than when none has.
    let chosen = |force: &Vector3<f64>| -> (Vec<(usize, usize, usize)>, f64) {
        let mut spans = Vec::new();
        let mut statistic = 0.0;
        for (index, b) in blocks.iter().enumerate() {
            let gains: Vec<(usize, usize, f64)> =
                b.local_spans().map(|(from, to)| (from, to, b.gain(from, to, force))).collect();
            let Some((from, to, most)) = gains.iter().copied().max_by(|a, b| a.2.total_cmp(&b.2)) else { continue };
            let mean = gains.iter().map(|g| (g.2 - most).exp()).sum::<f64>() / gains.len() as f64;
            let (with, without) = ((AFFECTED * mean).ln() + most, (1.0 - AFFECTED).ln());
            if with > without {
                spans.push((index, from, to));
            }
            statistic += 2.0 * (with.max(without) + (-(with - without).abs()).exp().ln_1p());
        }
        (spans, statistic)
    };
    let mut found: Vec<Push> = Vec::new();
    for start in starts {
        let mut force = start.estimate;
        let mut inverse = start.inverse;
        let (mut spans, mut statistic) = chosen(&force);
        for _ in 0..4 {
            let (mut score, mut information) = (Vector3::zeros(), Matrix3::zeros());
            for (index, from, to) in &spans {
                let (g, h) = blocks[*index].span(*from, *to);
                score += g;
                information += h;
            }
            let Some(i) = information.try_inverse() else { break };
            (inverse, force) = (i, i * score);
            (spans, statistic) = chosen(&force);
        }
        if spans.is_empty() || found.iter().any(|p| (p.statistic - statistic).abs() < 1e-6 * statistic.abs()) {
            continue;
        }
        // With the surge force free, against all three.
        let across = inverse.fixed_view::<2, 2>(1, 1).into_owned().try_inverse();
        let (Some(across), Some(all)) = (across, inverse.try_inverse()) else { continue };
        let side = force.fixed_rows::<2>(1).into_owned();
        let (_, image) = chosen(&Vector3::new(force[0], -force[1], -force[2]));
        let fitted = |(index, from, to): &(usize, usize, usize)| {
            let b = &blocks[*index];
            Some(window(&runs[*index], *index, b.length, &b.fit(*from, *to)?, looked_at, unit))
        };
        found.push(Push {
            sideways: side.dot(&(across * side)) / force.dot(&(all * force)).max(f64::MIN_POSITIVE),
            mirrored: image.max(0.0) / statistic.max(f64::MIN_POSITIVE),
            force: std::array::from_fn(|a| force[a] * unit[a]),
            error: std::array::from_fn(|a| inverse[(a, a)].max(0.0).sqrt() * unit[a]),
            statistic,
            windows: spans.iter().filter_map(fitted).collect(),
        });
    }
    found.sort_by(|a, b| b.statistic.total_cmp(&a.statistic));
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::noise::guess;
    use crate::physics::Form;
    use crate::recording::Split;
    use crate::ship::Ship;
    use crate::state::{Inputs, STATES};
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
            let mut blocks = Blocks { length: LENGTH, count, score: vec![Vector3::zeros()], information: Vec::new() };
            for i in 0..count {
                let inside = acts(index) && (from..from + 6).contains(&i);
                let noise = Vector3::from_fn(|_, _| rng.sample(StandardNormal));
                let step = noise + Vector3::from(force) * f64::from(u8::from(inside));
                blocks.score.push(blocks.score[i] + step);
            }
            for i in 0..=count {
                blocks.information.extend((0..=count).map(|j| Matrix3::identity() * i.min(j) as f64));
            }
            let run = Run {
                name: format!("run {index} 0 s"),
                recording: format!("run {index}"),
                session: "one".into(),
                manoeuvre: String::new(),
                split: Split::Train,
                dt: 2.0,
                inputs: (0..count * LENGTH).map(|k| Inputs::actuators(2.0 * k as f64, 1.0, 0.0)).collect(),
                measured: vec![[Some(0.0); STATES]; count * LENGTH],
                initial: [0.0; STATES],
                disturbed: Vec::new(),
            };
            (run, blocks)
        };
        (0..30).map(one).unzip()
    }

    fn strongest(force: [f64; 3], acts: impl Fn(usize) -> bool, seed: u64) -> Push {
        let (runs, blocks) = measured(force, acts, seed);
        common_pushes(&runs, &blocks, &[1.0; 3], 1.0).swap_remove(0)
    }

    #[test]
    fn windows_in_runs_that_were_parted_since_stay_as_they_are() {
        let ship = Ship::read(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/experiments/ships/a.toml"))).unwrap();
        let model = Model::new(ship, "HD", Form::Regular, &[]).unwrap();
        let (runs, blocks) = measured([0.0, 3.0, 2.0], |i| i == 3, 1);
        let push = common_pushes(&runs, &blocks, &[1.0; 3], 1.0).swap_remove(0);
        let noise = guess(&runs, &model);
        let found = Estimate { model, noise, free: Vec::new(), log_posterior: 0.0 };
        let windows = |runs: &[Run]| {
            let sharp = sharpened(&push, &found, Integration::default(), runs);
            sharp.windows.iter().map(|w| w.samples).collect::<Vec<_>>()
        };
        let before: Vec<_> = push.windows.iter().map(|w| w.samples).collect();
        let mut parted = runs.clone();
        for r in &mut parted {
            r.inputs.drain(..20);
            r.measured.drain(..20);
        }
        assert_eq!(windows(&parted), before);
        assert_eq!(windows(&runs[..1]), before);
        assert_eq!(windows(&runs).len(), before.len());
    }

    #[test]
    fn no_push_is_made_of_noise() {
        for seed in 0..20 {
            let push = strongest([0.0; 3], |_| false, seed);
            assert!(push.statistic < 12.0, "seed {seed}: {} in {} runs", push.statistic, push.recordings());
        }
    }

    #[test]
    fn a_weak_push_in_many_runs_is_seen_and_so_is_when() {
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
