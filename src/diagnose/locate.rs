//! Where an unknown force acts: in which equation, when, in which region of state and inputs.
//! It tests constant forces in windows and regions against the base; what the force is, is not asked here.

use super::estimate::{Estimate, base_of, restrictions};
use super::evidence::{Base, Evidence, RunEvidence, chi_squared_p, pick};
use super::filter::{Column, Filter, Pass, Run, Wanted};
use crate::model::Model;
use crate::simulate::Integration;
use crate::state::{Inputs, State};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use rayon::prelude::*;
use serde::Serialize;

/// Samples in one block of the time scan.
const BLOCK: usize = 5;

/// A time window in which a force acts that the model does not have.
#[derive(Clone, Debug, Serialize)]
pub struct Window {
    /// The run.
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

/// What the location step found.
#[derive(Clone, Debug, Serialize)]
pub struct Location {
    /// X, Y, N.
    pub equations: [EquationShare; 3],
    /// Windows, most significant first, not overlapping within a run.
    pub windows: Vec<Window>,
    /// Regions, most significant first.
    pub regions: Vec<RegionTest>,
}

/// Tests constant forces in every window of every run and in every region.
pub fn locate(found: &Estimate, integration: Integration, runs: &[Run]) -> Location {
    let model = &found.model;
    let columns: Vec<Column> = found.free.iter().map(|f| f.column).collect();
    let filter = Filter::new(model, integration, &columns);
    let longest = runs.iter().map(|r| r.measured.len()).max().unwrap_or(0);
    let blocks = longest.div_ceil(BLOCK);
    let extra = 3 * (blocks + REGIONS.len());
    let basis = |k: usize, s: &State<f64>, i: &Inputs<f64>, out: &mut Vec<[f64; 3]>| {
        out.resize(extra, [0.0; 3]);
        for e in 0..3 {
            let mut f = [0.0; 3];
            f[e] = found.noise.force[e];
            out[3 * (k / BLOCK) + e] = f;
            for (j, (_, inside)) in REGIONS.iter().enumerate() {
                if inside(model, s, i) {
                    out[3 * (blocks + j) + e] = f;
                }
            }
        }
    };
    let passes: Vec<Pass> = runs
        .par_iter()
        .map(|r| filter.pass(r, &found.noise, Wanted { basis: Some((extra, &basis)), ..Wanted::default() }))
        .collect();
    let evidence = super::estimate::evidence(runs, &passes, &restrictions(&found.free));
    let base = base_of(&evidence, model, &found.free);
    let base_step = base.step();
    let looked_at: f64 = runs
        .iter()
        .map(|r| {
            let b = r.measured.len().div_ceil(BLOCK) as f64;
            0.5 * b * (b + 1.0)
        })
        .sum();
    let mut windows: Vec<Window> = runs
        .par_iter()
        .zip(&evidence.runs)
        .enumerate()
        .flat_map_iter(|(index, (run, e))| {
            scan(run, index, e, &base, &base_step, columns.len(), looked_at, &found.noise.force)
        })
        .collect();
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
    Location { equations, windows, regions }
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

/// Blocks `from..to` of a run with the constant force that fits there.
struct Span {
    statistic: f64,
    from: usize,
    to: usize,
    estimate: Vector3<f64>,
    inverse: Matrix3<f64>,
}

/// The significant windows of one run, greedily, not overlapping.
fn scan(
    run: &Run,
    index: usize,
    e: &RunEvidence,
    base: &Base,
    base_step: &DVector<f64>,
    first: usize,
    looked_at: f64,
    unit: &[f64; 3],
) -> Vec<Window> {
    let blocks = run.measured.len().div_ceil(BLOCK);
    let columns: Vec<usize> = (first..first + 3 * blocks).collect();
    let cross = pick(&e.information, &columns, &base.columns);
    let h: DMatrix<f64> = pick(&e.information, &columns, &columns) - &cross * &base.inverse * cross.transpose();
    let g = DVector::from_fn(columns.len(), |i, _| e.score[columns[i]]) - &cross * base_step;
    // Two-dimensional running sums of the 3 x 3 blocks, so that every window costs the same.
    let at = |i: usize, j: usize| Matrix3::from_fn(|a, b| h[(3 * i + a, 3 * j + b)]);
    let mut sums = vec![Matrix3::zeros(); (blocks + 1) * (blocks + 1)];
    for i in 0..blocks {
        for j in 0..blocks {
            sums[(i + 1) * (blocks + 1) + j + 1] =
                at(i, j) + sums[i * (blocks + 1) + j + 1] + sums[(i + 1) * (blocks + 1) + j]
                    - sums[i * (blocks + 1) + j];
        }
    }
    let mut candidates: Vec<Span> = Vec::new();
    for from in 0..blocks {
        let mut score = Vector3::zeros();
        for to in from + 1..=blocks {
            score += Vector3::from_fn(|a, _| g[3 * (to - 1) + a]);
            let w = blocks + 1;
            let information = sums[to * w + to] - sums[from * w + to] - sums[to * w + from] + sums[from * w + from];
            let symmetric = (information + information.transpose()) * 0.5;
            let Some(inverse) = symmetric.try_inverse() else { continue };
            if symmetric.diagonal().min() < 1e-6 {
                continue;
            }
            let estimate = inverse * score;
            let statistic = score.dot(&estimate);
            if statistic.is_finite() && chi_squared_p(statistic, 3) * looked_at < 0.01 {
                candidates.push(Span { statistic, from, to, estimate, inverse });
            }
        }
    }
    candidates.sort_by(|a, b| b.statistic.total_cmp(&a.statistic));
    let mut taken: Vec<(usize, usize)> = Vec::new();
    let mut out = Vec::new();
    for Span { statistic, from, to, estimate, inverse } in candidates {
        if taken.iter().any(|(a, b)| from < *b && *a < to) || out.len() == 3 {
            continue;
        }
        taken.push((from, to));
        let samples = (from * BLOCK, (to * BLOCK).min(run.measured.len() - 1));
        out.push(Window {
            run: run.name.clone(),
            session: run.session.clone(),
            start: run.inputs[samples.0].t,
            end: run.inputs[samples.1].t,
            force: std::array::from_fn(|a| estimate[a] * unit[a]),
            error: std::array::from_fn(|a| inverse[(a, a)].max(0.0).sqrt() * unit[a]),
            statistic,
            p: (chi_squared_p(statistic, 3) * looked_at).min(1.0),
            index,
            samples,
        });
    }
    out
}
