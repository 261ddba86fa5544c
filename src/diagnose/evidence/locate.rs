//! Where an unknown force acts: in which equation, when, in which region of state and inputs, and in which part of the water.
//! It tests constant forces against the base; the cause of a force is named elsewhere.

use super::blocks::{Blocks, block_length, choices};
use super::generic::{GenericLaw, widen};
use super::place::{Chart, PARTS, Place, place};
use super::push::{Push, Window, pushes, significant};
use super::region::{REGIONS, RegionTest, Visits, regions, visited};
use crate::likelihood::estimate::{Estimate, Sums, base_of, restrictions, run_evidence};
use crate::likelihood::evidence::{Base, Evidence, RunEvidence};
use crate::likelihood::filter::{Column, Filter, Pass, Wanted};
use crate::model::Model;
use crate::recording::Run;
use crate::simulate::Integration;
use crate::state::{Inputs, State};
use nalgebra::DVector;
use serde::Serialize;

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

/// What the location step found.
#[derive(Clone, Debug, Serialize)]
pub struct Location {
    /// X, Y, N.
    pub equations: [EquationShare; 3],
    /// Windows, most significant first, not overlapping within a run.
    pub windows: Vec<Window>,
    /// The best constant force in windows of some runs, whether it is significant or not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub push: Option<Push>,
    /// Every such force that the search came to, the strongest first.
    #[serde(skip)]
    pub pushes: Vec<Push>,
    /// Regions, most significant first.
    pub regions: Vec<RegionTest>,
    /// Whether an earth-fixed force differs from place to place.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub place: Option<Place>,
}

/// The constant forces that are tested, as columns after those of the parameters: three a block of time, three a region, and
/// north and east in every part of the water and in all of it.
struct Layout<'a> {
    model: &'a Model,
    /// Scales of the forces \[N, N, N m\].
    unit: [f64; 3],
    /// Samples in a block.
    length: usize,
    /// Blocks in the longest run.
    blocks: usize,
    chart: Option<Chart>,
    /// Whether there are forces in blocks alone.
    in_time: bool,
}

impl<'a> Layout<'a> {
    fn new(found: &'a Estimate, runs: &[Run], in_time: bool) -> Self {
        let length = block_length(runs);
        let blocks = runs.iter().map(|r| r.measured.len().div_ceil(length)).max().unwrap_or(0);
        let chart = if in_time { None } else { Chart::of(runs) };
        Self { model: &found.model, unit: found.noise.force, length, blocks, chart, in_time }
    }

    /// Blocks in a run.
    fn blocks_in(&self, run: &Run) -> usize {
        run.measured.len().div_ceil(self.length)
    }

    /// Windows of all runs.
    fn choices(&self, runs: &[Run]) -> f64 {
        runs.iter().map(|run| choices(self.blocks_in(run))).sum()
    }

    /// First of the regions' forces.
    fn regions(&self) -> usize {
        3 * self.blocks
    }

    /// First of the forces fixed on the earth.
    fn parts(&self) -> usize {
        3 * (self.blocks + REGIONS.len())
    }

    /// How many forces there are.
    fn count(&self) -> usize {
        if self.in_time { self.regions() } else { self.parts() + 2 * PARTS + 2 }
    }

    /// The forces at a sample: X, Y, N of each.
    fn forces(&self, sample: usize, s: &State<f64>, i: &Inputs<f64>, out: &mut Vec<[f64; 3]>) {
        out.resize(self.count(), [0.0; 3]);
        for e in 0..3 {
            let mut f = [0.0; 3];
            f[e] = self.unit[e];
            out[3 * (sample / self.length) + e] = f;
            for (j, (_, inside)) in REGIONS.iter().enumerate() {
                if !self.in_time && inside(self.model, s, i) {
                    out[self.regions() + 3 * j + e] = f;
                }
            }
        }
        if let Some(chart) = &self.chart {
            let (sin, cos) = s.psi.sin_cos();
            let unit = self.unit[1];
            for part in [chart.part([s.x, s.y]), PARTS] {
                let at = self.parts() + 2 * part;
                out[at] = [unit * cos, -unit * sin, 0.0];
                out[at + 1] = [unit * sin, unit * cos, 0.0];
            }
        }
    }
}

/// What constant forces are tested beside.
struct Beside<'a> {
    /// A pass gives its columns, those of the force law and those of constant forces.
    filter: Filter<'a>,
    restrictions: Vec<Option<Vec<String>>>,
    /// The free parameters of an estimate.
    base: Base,
    /// These and a smooth force law: a force that comes back with the ship's state is no event, and what the law can mimic is taken out
    /// of the windows.
    widened: Base,
    /// First of the constant forces.
    first: usize,
}

impl<'a> Beside<'a> {
    /// By a first pass, so that a second one needs to keep no more of a run than the evidence for a force in each span of its time.
    fn new(found: &'a Estimate, integration: Integration, runs: &[Run]) -> Self {
        let model = &found.model;
        let mut columns: Vec<Column> = found.free.iter().map(|f| f.column).collect();
        let law = GenericLaw::append(&mut columns, model);
        let (first, filter) = (columns.len(), Filter::new(model, integration, &columns));
        let restrictions = restrictions(&found.free);
        let parameters = Sums::of(&filter, runs, &found.noise, &restrictions, false).evidence;
        let base = base_of(&parameters, model, &found.free);
        let widened = widen(&parameters, &base, &law.columns());
        Self { filter, restrictions, base, widened, first }
    }
}

/// The pushes that an estimate leaves, the strongest first, as [`locate`] has them.
pub fn pushes_left(found: &Estimate, integration: Integration, runs: &[Run]) -> Vec<Push> {
    let Beside { filter, restrictions, widened, first, .. } = Beside::new(found, integration, runs);
    let layout = Layout::new(found, runs, true);
    let basis = |(_, k): (usize, usize), s: &State<f64>, i: &Inputs<f64>, out: &mut Vec<[f64; 3]>| {
        layout.forces(k, s, i, out);
    };
    let wanted = Wanted { basis: Some((layout.count(), &basis)), ..Wanted::default() };
    let step = widened.step();
    let of_run = |run: &Run, Pass { score, information, .. }: Pass| {
        let one = run_evidence(run, score, information, &restrictions);
        Blocks::new(layout.length, layout.blocks_in(run), &one, &widened, &step, first)
    };
    let mut blocks = Vec::with_capacity(runs.len());
    filter.each(runs, &found.noise, wanted, of_run, |one| blocks.push(one));
    pushes(runs, &blocks, &layout.unit, layout.choices(runs))
}

/// Tests constant forces in every window of every run, in every region and in every part of the water.
pub fn locate(found: &Estimate, integration: Integration, runs: &[Run]) -> Location {
    let model = &found.model;
    let Beside { filter, restrictions, base, widened, first } = Beside::new(found, integration, runs);
    let layout = Layout::new(found, runs, false);
    let unit = &layout.unit;
    let basis = |(_, k): (usize, usize), s: &State<f64>, i: &Inputs<f64>, out: &mut Vec<[f64; 3]>| {
        layout.forces(k, s, i, out);
    };
    let wanted = Wanted { basis: Some((layout.count(), &basis)), ..Wanted::default() };
    let (step, widened_step) = (base.step(), widened.step());
    let of_run = |run: &Run, pass: Pass| {
        let Pass { score, information, filtered, .. } = pass;
        let one = run_evidence(run, score, information, &restrictions);
        RunForces {
            blocks: Blocks::new(layout.length, layout.blocks_in(run), &one, &widened, &widened_step, first),
            excess: excess(&one, &base, &step, first, layout.blocks),
            squares: filtered.iter().map(|z| std::array::from_fn(|eq| z[6 + eq] * z[6 + eq])).collect(),
            visited: visited(run, &filtered, model),
            evidence: one,
        }
    };
    let (mut evidence, mut blocks) = (Evidence::default(), Vec::with_capacity(runs.len()));
    let (mut forces, mut samples) = (Forces::default(), Visits::default());
    filter.each(runs, &found.noise, wanted, of_run, |one| {
        evidence.add(one.evidence, false);
        blocks.push(one.blocks);
        forces.add(&one.excess, &one.squares);
        samples.add(&one.visited);
    });
    let looked_at = layout.choices(runs);
    let pushes = pushes(runs, &blocks, unit, looked_at);
    Location {
        equations: forces.shares(unit),
        windows: significant(runs, &blocks, unit, looked_at),
        push: pushes.first().cloned(),
        pushes,
        regions: regions(&samples, &evidence, &base, first + layout.regions(), unit),
        place: layout.chart.as_ref().and_then(|c| place(c, &evidence, &widened, first + layout.parts(), unit[1])),
    }
}

/// What is kept of the pass over one run until it is added up.
struct RunForces {
    evidence: RunEvidence,
    blocks: Blocks,
    /// Significance of the force in each block beyond what chance makes, by equation.
    excess: Vec<[f64; 3]>,
    /// Squares of the filtered force by sample and equation.
    squares: Vec<[f64; 3]>,
    visited: Visits,
}

/// Squared significance of the force in each block, less 1, by equation; 0 where that is below 0 or the data see no force.
fn excess(e: &RunEvidence, base: &Base, step: &DVector<f64>, first: usize, blocks: usize) -> Vec<[f64; 3]> {
    let of = |b: usize, eq: usize| {
        let c = first + 3 * b + eq;
        let own = e.information[(c, c)];
        if own > 1e-6 {
            let cross: f64 = base.columns.iter().zip(step.iter()).map(|(j, s)| e.information[(c, *j)] * s).sum();
            ((e.score[c] - cross).powi(2) / own - 1.0).max(0.0)
        } else {
            0.0
        }
    };
    (0..blocks).map(|b| std::array::from_fn(|eq| of(b, eq))).collect()
}

/// Sums over the runs of the block-wise force evidence and of the squared filtered force, by equation.
#[derive(Default)]
struct Forces {
    excess: [f64; 3],
    squares: [f64; 3],
    samples: usize,
}

impl Forces {
    fn add(&mut self, excess: &[[f64; 3]], squares: &[[f64; 3]]) {
        excess.iter().for_each(|e| (0..3).for_each(|eq| self.excess[eq] += e[eq]));
        squares.iter().for_each(|s| (0..3).for_each(|eq| self.squares[eq] += s[eq]));
        self.samples += squares.len();
    }

    /// Share of each equation in the evidence, and the filtered force's root mean square.
    fn shares(&self, sigma: &[f64; 3]) -> [EquationShare; 3] {
        let total = self.excess.iter().sum::<f64>().max(f64::MIN_POSITIVE);
        let count = (self.samples as f64).max(1.0);
        std::array::from_fn(|eq| EquationShare {
            share: self.excess[eq] / total,
            rms: (self.squares[eq] / count).sqrt(),
            sigma: sigma[eq],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example::{RK4, at, model, runs, with};

    #[test]
    fn a_yaw_moment_that_the_model_lacks_is_found_in_yaw() {
        // A base with nothing free, and runs of a ship with a constant yaw moment.
        let found = Estimate { free: Vec::new(), ..at(&model()) };
        let of = |truth: &Model| locate(&found, RK4, &runs(truth, 9));
        let share = |l: &Location| l.equations.map(|e| e.share);
        let null = of(&model());
        let yaw = of(&with(&[("asymmetric.N_0", 4e5)]));
        let [x, y, n] = share(&yaw);
        assert!(n > 0.7 && (x + y + n - 1.0).abs() < 1e-9, "{:?}", share(&yaw));
        assert!(yaw.equations[2].rms > 3.0 * null.equations[2].rms);
        assert!(null.windows.is_empty() && null.regions[0].p > 1e-4, "{:?}", null.regions[0]);
        let best = &yaw.regions[0];
        assert!(best.p < 1e-6 && best.force[2] > 5.0 * best.error[2], "{best:?}");
    }

    #[test]
    fn a_force_that_acts_when_the_propeller_turns_astern_is_found_in_that_region() {
        let found = Estimate { free: Vec::new(), ..at(&model()) };
        let walk = with(&[("propeller_walk.astern", 0.15)]);
        let location = locate(&found, RK4, &runs(&walk, 9));
        let regions: Vec<&str> = location.regions.iter().filter(|r| r.p < 1e-3).map(|r| r.region.as_str()).collect();
        assert!(regions.contains(&"propeller astern (n < 0)"), "{regions:?}");
    }

    #[test]
    fn the_pushes_that_are_left_are_those_of_the_location_to_the_bit() {
        let found = at(&model());
        let turned = runs(&with(&[("asymmetric.N_0", 4e5)]), 5).swap_remove(1);
        let mut runs = runs(&model(), 5);
        runs[1] = turned;
        let all = locate(&found, RK4, &runs).pushes;
        let alone = pushes_left(&found, RK4, &runs);
        assert!(!all.is_empty());
        let text = |pushes: &[Push]| format!("{pushes:?}");
        assert_eq!(text(&all), text(&alone));
    }

    #[test]
    fn every_force_of_the_layout_has_a_column_of_its_own() {
        let model = model();
        let (found, runs) = (at(&model), runs(&model, 3));
        let layout = Layout::new(&found, &runs, false);
        let mut forces = Vec::new();
        let state = State { x: 10.0, y: 20.0, psi: 0.5, u: 4.0, v: 0.0, r: 0.0 };
        layout.forces(7, &state, &Inputs::actuators(0.0, 1.0, 0.0), &mut forces);
        assert_eq!(forces.len(), layout.count());
        let block = 3 * (7 / layout.length);
        let set = |from: usize, to: usize| forces[from..to].iter().filter(|f| **f != [0.0; 3]).count();
        assert_eq!((set(0, layout.regions()), set(block, block + 3)), (3, 3));
        // North and east in the part of the water and in all of it.
        assert_eq!(set(layout.parts(), layout.count()), 4);
        assert_eq!(forces[layout.count() - 2], [layout.unit[1] * 0.5f64.cos(), -layout.unit[1] * 0.5f64.sin(), 0.0]);
    }
}
