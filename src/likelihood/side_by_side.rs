//! The filter over a few runs of one sample period side by side: correction by the measurements, sensitivities, prediction.
//! What a step or a column does to the ship is computed elsewhere; the filter puts the runs together.

use super::covariance::{self, Discrete, Measurement, Square, Z, initial, predict, sum_along, sum_of_rows};
use super::directions::{Directions, Prepared};
use super::noise::Noise;
use super::pass::{GATE, Gains, Pass, Tangent, Wanted, boost};
use super::step_map::{Jacobians, Slope, Stages, carry, exact, no_slope, none, slope_at};
use crate::recording::Run;
use crate::sensitivity::chain::StateSlope;
use crate::sensitivity::local::side_by_side;
use crate::sensitivity::{Plain, Products};
use crate::simulate::{Integration, Method, step};
use crate::state::{Force, Inputs, STATES, State};
use nalgebra::{DMatrix, DVector};
use std::f64::consts::TAU;

/// Runs of one sample period with their indices, at most one a lane.
pub(super) type Together<'r> = [(usize, &'r Run)];

/// What the measurements of one sample change, by channel: 0 where a lane has none, or an outlier.
struct Correction<P> {
    /// Innovation.
    error: [P; STATES],
    /// One over its variance.
    inverse: [P; STATES],
    gain: [[P; Z]; STATES],
    /// How the report changes with the state.
    report: [[P; STATES]; STATES],
    /// Derivatives of the report by the columns of sensors.
    sensed: Vec<(usize, [P; STATES])>,
    /// Whether some lane has a measurement, and whether all have.
    some: [bool; STATES],
    all: [bool; STATES],
}

impl<P: Plain> Correction<P> {
    /// By no measurement, of sensors that report the state.
    fn none() -> Self {
        let (zero, one) = (P::zero(), P::one());
        Self {
            error: [zero; STATES],
            inverse: [zero; STATES],
            gain: [[zero; Z]; STATES],
            report: std::array::from_fn(|i| std::array::from_fn(|j| if i == j { one } else { zero })),
            sensed: Vec::new(),
            some: [false; STATES],
            all: [false; STATES],
        }
    }
}

/// The forces of a basis at a sample, and the columns that they have begun to move: those before their first force are zero and are
/// not carried.
struct Basis<P> {
    /// The column of each force that has begun, in the order in which they begin.
    begun: Vec<usize>,
    /// Whether a force has begun.
    has_begun: Vec<bool>,
    /// The forces by lane.
    forces: Vec<Vec<[f64; 3]>>,
    /// The forces that have begun, X, Y, N over lanes.
    side_by_side: Vec<[P; 3]>,
}

/// The filter at one sample.
struct Filtering<'f, P: Plain> {
    runs: &'f Together<'f>,
    wanted: &'f Wanted<'f>,
    directions: &'f Directions<'f>,
    prepared: Prepared<'f, P>,
    noise: Discrete<P>,
    dt: f64,
    /// Whether the accelerations' Jacobian at both ends of a step carries the linearisation over it.
    smooth: bool,
    mean: [P; Z],
    covariance: Square<P>,
    /// The corrections by two measurements, which the covariance takes at once.
    measurements: [Measurement<P>; 2],
    /// Whether it is still to be corrected by the first of them.
    waits: bool,
    /// The Jacobian of the rates at the last sample, where it is carried, and room for the next.
    ends: Box<[Slope<P>; 2]>,
    /// Which of the two is that of the last sample.
    last: usize,
    /// The Jacobians of the last step.
    jacobians: Jacobians<P>,
    /// Derivatives of the mean by column: by the parameters, then by the forces of the basis that have begun.
    slopes: Vec<[P; Z]>,
    basis: Basis<P>,
    /// The columns' part in the accelerations at the start and at the end of a step.
    rates: [Vec<[P; 3]>; 2],
    room: Vec<[P; 3]>,
    /// Room for steps whose stages are differentiated.
    stages: Stages<P>,
    score: Vec<P>,
    information: Products<P>,
    log_likelihood: P,
    used: P,
    outliers: P,
    passes: Vec<Pass>,
}

/// Passes over runs side by side.
pub(super) fn passes<P: Plain>(directions: &Directions, runs: &Together, noise: &Noise, wanted: &Wanted) -> Vec<Pass> {
    let samples = runs.iter().map(|(_, run)| run.measured.len()).max().unwrap_or(0);
    if samples == 0 {
        return Vec::new();
    }
    let mut filtering = Filtering::<P>::new(directions, runs, noise, wanted, samples);
    let mut correction = Correction::none();
    for k in 0..samples {
        filtering.correct(k, &mut correction);
        filtering.learn(k, &correction);
        filtering.record(k);
        if k + 1 < samples {
            filtering.advance(k);
        }
    }
    filtering.finish()
}

/// Where a flag is set.
#[inline(always)]
fn where_set<P: Plain>(flag: P, value: P) -> P {
    P::select(P::zero().less(flag), value, P::zero())
}

/// A channel's row of the report's Jacobian times a vector; without terms of sensors the report is the state.
#[inline(always)]
fn along<P: Plain>(senses: bool, report: &[[P; STATES]; STATES], channel: usize, value: impl Fn(usize) -> P) -> P {
    if senses {
        (0..STATES).fold(P::zero(), |sum, l| value(l).mul_add(report[channel][l], sum))
    } else {
        value(channel)
    }
}

/// Carries a derivative of the mean through the correction by sensors that report the state, and gives the derivatives of the reports;
/// `seen` makes them of those of a channel's state and coloured noise. An entry is loaded and stored once for all channels but those
/// before its own.
#[inline(always)]
fn corrected<P: Plain>(d: &mut [P; Z], gain: &[[P; Z]; STATES], seen: impl Fn(usize, P, P) -> P) -> [P; STATES] {
    let mut rows = [P::zero(); STATES];
    macro_rules! channels {
        ($($j:literal)*) => { $(
            for i in [$j, 9 + $j] {
                let mut entry = d[i];
                (0..$j).for_each(|m| entry = (-gain[m][i]).mul_add(rows[m], entry));
                d[i] = entry;
            }
            rows[$j] = seen($j, d[$j], d[9 + $j]);
        )* };
    }
    channels!(0 1 2 3 4 5);
    macro_rules! entries {
        ($($i:literal from $first:literal)*) => { $(
            let mut entry = d[$i];
            ($first..STATES).for_each(|m| entry = (-gain[m][$i]).mul_add(rows[m], entry));
            d[$i] = entry;
        )* };
    }
    entries!(0 from 0 1 from 1 2 from 2 3 from 3 4 from 4 5 from 5 6 from 0 7 from 0 8 from 0);
    entries!(9 from 0 10 from 1 11 from 2 12 from 3 13 from 4 14 from 5);
    rows
}

/// As [`corrected`], where each channel reports a function of the whole state.
fn corrected_by_reports<P: Plain>(
    d: &mut [P; Z],
    gain: &[[P; Z]; STATES],
    report: &[[P; STATES]; STATES],
    seen: impl Fn(usize, P, P) -> P,
) -> [P; STATES] {
    let mut rows = [P::zero(); STATES];
    for (j, gain) in gain.iter().enumerate() {
        rows[j] = seen(j, along(true, report, j, |l| d[l]), d[9 + j]);
        (0..Z).for_each(|i| d[i] = (-gain[i]).mul_add(rows[j], d[i]));
    }
    rows
}

impl<'f, P: Plain> Filtering<'f, P> {
    fn new(
        directions: &'f Directions<'f>,
        runs: &'f Together<'f>,
        noise: &Noise,
        wanted: &'f Wanted<'f>,
        samples: usize,
    ) -> Self {
        let run = |lane: usize| runs[lane.min(runs.len() - 1)].1;
        let dt = run(0).dt;
        let input = |lane: usize, k: usize| -> &Inputs<f64> { &run(lane).inputs[k.min(run(lane).inputs.len() - 1)] };
        let inputs: Vec<Inputs<P>> = (0..samples).map(|k| side_by_side(|lane| input(lane, k))).collect();
        let values: Vec<Vec<f64>> = (0..P::WIDTH).map(|lane| directions.model.values_in(&run(lane).session)).collect();
        let theta: Vec<P> = (0..values[0].len()).map(|i| P::gather(|lane| values[lane][i])).collect();
        let prepared = directions.at(&theta, &inputs, dt);
        let noise: Discrete<P> = Discrete::new(noise, dt).lift();
        let state: [P; STATES] = std::array::from_fn(|j| P::gather(|lane| run(lane).initial[j]));
        let mut mean = [P::zero(); Z];
        mean[..STATES].copy_from_slice(&state);
        let parameters = directions.len();
        let forces = wanted.basis.map_or(0, |(n, _)| n);
        let calm = [P::zero(); 3];
        let mut ends = Box::new([no_slope(); 2]);
        let local = slope_at(&prepared.dynamics, &state, &calm, &prepared.series[0], &mut ends[0]);
        let mut rates = [vec![calm; parameters], vec![calm; parameters]];
        let mut room = Vec::new();
        if parameters > 0 && !wanted.exact {
            prepared.rates(&local, 0, &state, &calm, &mut room, &mut rates[0]);
        }
        let kept = |run: &Run| if wanted.sums_only { 0 } else { run.measured.len() };
        let pass = |(_, run): &(usize, &Run)| Pass {
            log_likelihood: 0.0,
            used: 0,
            outliers: 0,
            score: DVector::zeros(0),
            information: DMatrix::zeros(0, 0),
            innovations: Vec::with_capacity(kept(run)),
            slopes: Vec::new(),
            filtered: Vec::with_capacity(kept(run)),
            force_sd: Vec::with_capacity(kept(run)),
            tangent: wanted.tangent.then(Tangent::default),
            gains: wanted.gains.then(Gains::default),
        };
        let mut information = Products::new(parameters + forces);
        information.begin(parameters);
        Self {
            runs,
            wanted,
            directions,
            prepared,
            dt,
            smooth: directions.integration == Integration { method: Method::Rk4, substeps: 1 } && !wanted.exact,
            mean,
            covariance: initial(&noise, directions.model),
            measurements: [Measurement::nothing(); 2],
            waits: false,
            noise,
            ends,
            last: 0,
            jacobians: none(),
            slopes: vec![[P::zero(); Z]; parameters],
            basis: Basis::new(forces),
            rates,
            room,
            stages: Stages::new(if wanted.exact { parameters } else { 0 }),
            score: vec![P::zero(); parameters],
            information,
            log_likelihood: P::zero(),
            used: P::zero(),
            outliers: P::zero(),
            passes: runs.iter().map(pass).collect(),
        }
    }

    /// The instant of a sample.
    fn instant(&self, k: usize) -> usize {
        k * self.directions.integration.instants()
    }

    /// Those of the first entries of the mean that are the ship's state.
    fn state(&self) -> [P; STATES] {
        std::array::from_fn(|j| self.mean[j])
    }

    /// A value of the gains that are given, NaN where a run has none.
    fn given(&self, frozen: &[Gains], of: impl Fn(&Gains) -> Option<f64>) -> P {
        P::gather(|lane| self.runs.get(lane).and_then(|(run, _)| of(frozen.get(*run)?)).unwrap_or(f64::NAN))
    }

    /// Corrects mean and covariance by the measurements of a sample, channel after channel.
    fn correct(&mut self, k: usize, out: &mut Correction<P>) {
        let (zero, one) = (P::zero(), P::one());
        let reference = self.state();
        let mut report = reference;
        let senses = self.directions.senses;
        if senses {
            (report, out.report) = self.prepared.report(&reference, self.instant(k));
        }
        out.sensed = self.prepared.sensed(&reference, self.instant(k));
        let mut innovation = [P::from_f64(f64::NAN); STATES];
        let mut variance = innovation;
        for j in 0..STATES {
            let measured = |lane: usize| self.runs.get(lane).and_then(|(_, run)| run.recorded(k, j));
            let mut present = P::gather(|lane| f64::from(u8::from(measured(lane).is_some())));
            (out.some[j], out.all[j]) = (false, false);
            if (0..P::WIDTH).all(|lane| present.in_lane(lane) == 0.0) {
                (out.error[j], out.inverse[j], out.gain[j]) = (zero, zero, [zero; Z]);
                continue;
            }
            // The state through the report, and this channel's coloured noise.
            let moved = along(senses, &out.report, j, |l| self.mean[l] - reference[l]);
            let predicted = report[j] + self.mean[9 + j] + moved;
            let mut error = P::gather(|lane| measured(lane).unwrap_or(0.0)) - predicted;
            if j == 2 {
                error = trimtab_ad::smooth::wrap_angle(error);
            }
            let (ph, s) = if let Some(frozen) = self.wanted.frozen {
                let given = self.given(frozen, |g| Some(g.variance.get(k)?[j]));
                present *= P::gather(|lane| f64::from(u8::from(given.in_lane(lane).is_finite())));
                ([zero; Z], given)
            } else {
                let ph = self.covariance_with(j, &out.report);
                (ph, self.noise.white[j] + ph[9 + j] + along(senses, &out.report, j, |l| ph[l]))
            };
            let s = P::select(zero.less(present), s, one);
            let sigma = s.sqrt();
            innovation[j] = P::select(zero.less(present), error / sigma, innovation[j]);
            let gate = if self.wanted.frozen.is_none() { GATE } else { f64::INFINITY };
            let outlier = P::select((sigma * gate).less(error.abs()), present, zero);
            let used = present - outlier;
            let square = P::select(zero.less(outlier), P::from_f64(GATE * GATE), error * error / s);
            self.log_likelihood -= where_set(present, (square + s.ln() + TAU.ln()) * 0.5);
            self.used += used;
            self.outliers += outlier;
            out.error[j] = where_set(used, error);
            out.inverse[j] = where_set(used, one / s);
            variance[j] = P::select(zero.less(used), s, variance[j]);
            out.some[j] = true;
            out.all[j] = (0..P::WIDTH).all(|lane| used.in_lane(lane) > 0.0);
            self.apply(k, j, &ph, used, out);
        }
        if std::mem::take(&mut self.waits) {
            covariance::correct(&mut self.covariance, &self.measurements[0]);
        }
        let linear = |j: usize| along(senses, &out.report, j, |l| reference[l]);
        let offset = std::array::from_fn(|j| report[j] - linear(j));
        self.note(k, &innovation, &variance, &offset, out);
    }

    /// The covariance of the filter state with what a channel reports.
    #[inline(always)]
    fn covariance_with(&mut self, channel: usize, report: &[[P; STATES]; STATES]) -> [P; Z] {
        let p = &self.covariance;
        let [first, second] = &mut self.measurements;
        let (before, own) = if self.waits { (Some(&*first), second) } else { (None, first) };
        if self.directions.senses {
            sum_along(p, before, &report[channel], 9 + channel, &mut own.ph);
        } else {
            sum_of_rows(p, before, channel, 9 + channel, &mut own.ph);
        }
        own.ph
    }

    /// Notes what the measurements of a sample brought: standardised innovations, their variances, and the linearised report.
    fn note(
        &mut self,
        k: usize,
        innovation: &[P; STATES],
        variance: &[P; STATES],
        offset: &[P; STATES],
        correction: &Correction<P>,
    ) {
        for (lane, ((_, run), pass)) in self.runs.iter().zip(&mut self.passes).enumerate() {
            if k >= run.measured.len() {
                continue;
            }
            if !self.wanted.sums_only {
                pass.innovations.push(innovation.map(|e| e.in_lane(lane)));
            }
            if let Some(t) = &mut pass.tangent {
                t.offset.push(offset.map(|o| o.in_lane(lane)));
                if self.directions.senses {
                    t.report.push(correction.report.map(|row| row.map(|x| x.in_lane(lane))));
                }
            }
            if let Some(g) = &mut pass.gains {
                g.variance.push(variance.map(|s| s.in_lane(lane)));
                g.gain.push(correction.gain.map(|gain| gain.map(|gain| gain.in_lane(lane))));
            }
        }
    }

    /// Applies the gain of one channel, from the covariance `ph` of its innovation with the filter state.
    fn apply(&mut self, k: usize, j: usize, ph: &[P; Z], used: P, out: &mut Correction<P>) {
        let frozen = self.wanted.frozen;
        for i in 0..Z {
            let gain = match frozen {
                None => where_set(used, ph[i] * out.inverse[j]),
                Some(frozen) => where_set(used, self.given(frozen, |g| Some(g.gain.get(k)?[j][i]))),
            };
            out.gain[j][i] = gain;
            self.mean[i] += gain * out.error[j];
        }
        if frozen.is_none() {
            self.measurements[usize::from(self.waits)].gain = out.gain[j];
            if self.waits {
                covariance::correct_twice(&mut self.covariance, &self.measurements);
            }
            self.waits = !self.waits;
        }
    }

    /// Carries the sensitivities through the correction of a sample, and adds score and information.
    fn learn(&mut self, k: usize, correction: &Correction<P>) {
        if self.slopes.is_empty() {
            return;
        }
        let Correction { error, inverse, gain, report, some, all, .. } = correction;
        let mut sensed = Vec::new();
        if !correction.sensed.is_empty() {
            sensed.resize(self.slopes.len(), [P::zero(); STATES]);
            correction.sensed.iter().for_each(|(c, report)| sensed[*c] = *report);
        }
        let root = inverse.map(|inverse| inverse.sqrt());
        let senses = self.directions.senses;
        for (c, slope) in self.slopes.iter_mut().enumerate() {
            let seen = |j: usize, of_state: P, coloured: P| {
                let mut row = coloured + of_state;
                if let Some(sensed) = sensed.get(c) {
                    row += sensed[j];
                }
                if all[j] { row } else { where_set(inverse[j], row) }
            };
            let rows =
                if senses { corrected_by_reports(slope, gain, report, seen) } else { corrected(slope, gain, seen) };
            for j in (0..STATES).filter(|j| some[*j]) {
                self.score[c] = (error[j] * inverse[j]).mul_add(rows[j], self.score[c]);
            }
            let row = std::array::from_fn(|j| rows[j] * root[j]);
            if self.wanted.slopes {
                for (lane, ((_, run), pass)) in self.runs.iter().zip(&mut self.passes).enumerate() {
                    if k < run.measured.len() {
                        // An innovation falls where what is expected rises.
                        pass.slopes.push(row.map(|x: P| -x.in_lane(lane)));
                    }
                }
            }
            self.information.set(c, &row);
        }
        self.information.next_sample();
    }

    /// Notes the filtered state of a sample.
    fn record(&mut self, k: usize) {
        if self.wanted.sums_only {
            return;
        }
        for (lane, ((_, run), pass)) in self.runs.iter().zip(&mut self.passes).enumerate() {
            if k < run.measured.len() {
                pass.filtered.push(self.mean.map(|z| z.in_lane(lane)));
                let variance = |e: usize| self.covariance[6 + e][6 + e].in_lane(lane);
                pass.force_sd.push(std::array::from_fn(|e| variance(e).max(0.0).sqrt()));
            }
        }
    }

    /// Predicts the next sample.
    fn advance(&mut self, k: usize) {
        let (state, push) = (self.state(), [self.mean[6], self.mean[7], self.mean[8]]);
        let (from, integration) = (self.instant(k), self.directions.integration);
        let force = Force { x: push[0], y: push[1], n: push[2] };
        let Prepared { dynamics, series, .. } = &self.prepared;
        let image = step(dynamics, integration, self.dt, &state, &series[from..], &force);
        self.carry_slopes(k, &state, &push, &image);
        let (a, gamma) = &self.jacobians;
        for (lane, ((_, run), pass)) in self.runs.iter().zip(&mut self.passes).enumerate() {
            let (true, Some(t)) = (k + 1 < run.measured.len(), &mut pass.tangent) else { continue };
            let pushed = |i: usize| gamma[i][0] * push[0] + gamma[i][1] * push[1] + gamma[i][2] * push[2];
            t.state.push(state.map(|x| x.in_lane(lane)));
            t.image.push(std::array::from_fn(|i| (image[i] - pushed(i)).in_lane(lane)));
            t.a.push(a.map(|row| row.map(|x| x.in_lane(lane))));
            t.gamma.push(gamma.map(|row| row.map(|x| x.in_lane(lane))));
        }
        self.mean[..STATES].copy_from_slice(&image);
        (0..3).for_each(|i| self.mean[6 + i] *= self.noise.fade);
        (0..STATES).for_each(|i| self.mean[9 + i] *= self.noise.rho[i]);
        if self.wanted.frozen.is_none() {
            let boost = P::gather(|lane| self.runs.get(lane).map_or(1.0, |(_, run)| boost(run, k)));
            predict(&mut self.covariance, a, gamma, &self.noise, boost);
        }
    }

    /// Carries the sensitivities over a step to `image`, and keeps its Jacobians.
    fn carry_slopes(&mut self, k: usize, state: &[P; STATES], push: &[P; 3], image: &[P; STATES]) {
        let (from, later) = (self.instant(k), self.instant(k + 1));
        let parameters = self.directions.len();
        let any = parameters > 0 || self.wanted.basis.is_some();
        if self.wanted.frozen.is_some() && !any && !self.wanted.tangent {
            return;
        }
        let Prepared { dynamics, series, .. } = &self.prepared;
        let faded = push.map(|w| w * self.noise.fade);
        let next = 1 - self.last;
        let mut end = None;
        if self.smooth {
            end = Some(slope_at(dynamics, image, &faded, &series[later], &mut self.ends[next]));
            carry(&self.ends[self.last], &self.ends[next], self.dt, &mut self.jacobians);
            self.last = next;
        } else {
            let integration = self.directions.integration;
            self.jacobians = exact(&self.prepared, integration, self.dt, from, state, push, &mut self.stages);
        }
        if !any {
            return;
        }
        if !self.wanted.exact && parameters > 0 {
            // The parameters act through the accelerations: the trapezoidal rule carries them over the step. Any predictable
            // sensitivity leaves the score unbiased, so that this costs no more than a little power.
            let ends = &mut self.ends;
            let local = end.get_or_insert_with(|| slope_at(dynamics, image, &faded, &series[later], &mut ends[next]));
            self.prepared.rates(local, later, image, &faded, &mut self.room, &mut self.rates[1]);
        }
        self.push(k, state);
        let columns = std::mem::take(&mut self.stages.columns);
        self.move_slopes(Stages::by_parameters(&columns));
        self.stages.columns = columns;
        self.rates.swap(0, 1);
    }

    /// Moves the derivatives of the mean over a step by its Jacobians, with the columns' own part in it: `through` the parameters'
    /// where it is not empty, and else by the rates at the ends.
    fn move_slopes(&mut self, through: &[StateSlope<P>]) {
        let half = P::from_f64(0.5 * self.dt);
        let (a, gamma) = &self.jacobians;
        let parameters = self.directions.len();
        for (c, slope) in self.slopes.iter_mut().enumerate() {
            // Of heading, velocities and unknown force; the position moves nothing but itself.
            let mut d: [P; 7] = std::array::from_fn(|l| slope[2 + l]);
            let mut next = [P::zero(); STATES];
            if let Some(force) = c.checked_sub(parameters).map(|c| self.basis.side_by_side[c]) {
                (0..3).for_each(|l| d[4 + l] += force[l]);
            } else if let Some(own) = through.get(c) {
                next = *own;
            } else {
                (0..3).for_each(|l| d[1 + l] = half.mul_add(self.rates[0][c][l], d[1 + l]));
                (0..3).for_each(|l| next[3 + l] = half * self.rates[1][c][l]);
            }
            for i in 0..STATES {
                let mut sum = if i < 2 { next[i] + slope[i] } else { next[i] };
                (0..4).for_each(|l| sum = a[i][2 + l].mul_add(d[l], sum));
                (0..3).for_each(|l| sum = gamma[i][l].mul_add(d[4 + l], sum));
                slope[i] = sum;
            }
            (6..9).for_each(|l| slope[l] *= self.noise.fade);
            (9..Z).for_each(|l| slope[l] *= self.noise.rho[l - 9]);
        }
    }

    /// Evaluates the forces of the basis at a sample; those that act for the first time get a column.
    fn push(&mut self, k: usize, state: &[P; STATES]) {
        let Some((_, basis)) = self.wanted.basis else { return };
        let now = &self.prepared.series[k * self.directions.integration.instants()];
        for (lane, (forces, (index, run))) in self.basis.forces.iter_mut().zip(self.runs).enumerate() {
            forces.clear();
            if k < run.measured.len() {
                let state = State::from_array(state.map(|x| x.in_lane(lane)));
                basis((*index, k), &state, &now.map(|x| x.in_lane(lane)), forces);
            }
        }
        self.basis.begin();
        let carried = self.directions.len() + self.basis.begun.len();
        self.slopes.resize(carried, [P::zero(); Z]);
        self.score.resize(carried, P::zero());
        self.information.begin(carried);
    }

    /// The passes when the last sample is in.
    fn finish(mut self) -> Vec<Pass> {
        self.information.finish();
        let parameters = self.directions.len();
        let width = parameters + self.basis.has_begun.len();
        let place = |c: usize| c.checked_sub(parameters).map_or(c, |c| parameters + self.basis.begun[c]);
        for (lane, pass) in self.passes.iter_mut().enumerate() {
            pass.log_likelihood = self.log_likelihood.in_lane(lane);
            pass.used = self.used.in_lane(lane) as usize;
            pass.outliers = self.outliers.in_lane(lane) as usize;
            pass.score = DVector::zeros(width);
            pass.information = DMatrix::zeros(width, width);
            self.score.iter().enumerate().for_each(|(c, g)| pass.score[place(c)] = g.in_lane(lane));
        }
        for i in 0..self.slopes.len() {
            for j in 0..=i {
                let (sums, at) = (self.information.get(i, j), (place(i), place(j)));
                for (lane, pass) in self.passes.iter_mut().enumerate() {
                    let sum = sums.in_lane(lane);
                    (pass.information[at], pass.information[(at.1, at.0)]) = (sum, sum);
                }
            }
        }
        self.passes
    }
}

impl<P: Plain> Basis<P> {
    /// Of so many forces, none of which has acted.
    fn new(count: usize) -> Self {
        Self {
            begun: Vec::new(),
            has_begun: vec![false; count],
            forces: vec![Vec::new(); P::WIDTH],
            side_by_side: Vec::new(),
        }
    }

    /// Puts the forces of a sample side by side, with a place for those that act for the first time.
    fn begin(&mut self) {
        let Self { begun, has_begun, forces, side_by_side } = self;
        for (c, has_begun) in has_begun.iter_mut().enumerate().filter(|(_, has_begun)| !**has_begun) {
            if forces.iter().any(|lane| lane.get(c).is_some_and(|force| *force != [0.0; 3])) {
                *has_begun = true;
                begun.push(c);
            }
        }
        let of = |c: usize, l: usize, lane: usize| forces[lane].get(c).map_or(0.0, |force| force[l]);
        side_by_side.clear();
        side_by_side.extend(begun.iter().map(|c| std::array::from_fn(|l| P::gather(|lane| of(*c, l, lane)))));
    }
}
