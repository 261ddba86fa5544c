//! The filter along runs whose steps and reports are linearised: innovations and their variances for a noise, without sensitivities to
//! the ship's parameters. How the noise is chosen is decided elsewhere.

use super::levels::Noise;
use crate::likelihood::covariance::{
    Discrete, Measurement, Square, Z, correct, correct_twice, initial, predict, sum_along, sum_of_rows,
};
use crate::likelihood::filter::{Tangent, boost};
use crate::model::Model;
use crate::recording::Run;
use crate::state::STATES;
use trimtab_ad::{Lanes, Scalar};

/// Up to four runs with their step maps, one a lane; what a run does not have is 0.
pub(super) struct Together<'a>(pub &'a [(&'a Run, &'a Tangent)]);

/// A linearised step, with the factor on what the unknown force gains in it.
#[derive(Clone, Copy)]
pub(super) struct Step {
    /// Where the step begins, and where it leads from there.
    pub state: [Lanes; STATES],
    pub image: [Lanes; STATES],
    /// Its Jacobians by state and force.
    pub a: [[Lanes; STATES]; STATES],
    pub gamma: [[Lanes; 3]; STATES],
    pub boost: Lanes,
}

impl Step {
    /// Of zeros.
    fn zero() -> Self {
        let zero = Lanes::zero();
        Self {
            state: [zero; STATES],
            image: [zero; STATES],
            a: [[zero; STATES]; STATES],
            gamma: [[zero; 3]; STATES],
            boost: zero,
        }
    }
}

impl Together<'_> {
    /// A number of each run.
    fn gather(&self, of: impl Fn(&Run, &Tangent) -> Option<f64>) -> Lanes {
        Lanes::from_fn(|lane| self.0.get(lane).and_then(|(run, tangent)| of(run, tangent)).unwrap_or(0.0))
    }

    /// Samples of the longest run.
    pub fn samples(&self) -> usize {
        self.0.iter().map(|(run, _)| run.measured.len()).max().unwrap_or(0)
    }

    /// A noise at the sample period of each run.
    pub fn discrete(&self, noise: &Noise) -> Discrete<Lanes> {
        let dt = |lane: usize| self.0[lane.min(self.0.len() - 1)].0.dt;
        Discrete::side_by_side(&std::array::from_fn(|lane| Discrete::new(noise, dt(lane))))
    }

    /// The filter before the first measurement.
    pub fn start(&self, noise: &Discrete<Lanes>, model: &Model) -> Place {
        let mut z = [Lanes::zero(); Z];
        (0..STATES).for_each(|i| z[i] = self.gather(|run, _| Some(run.initial[i])));
        Place { sample: 0, z, p: initial(noise, model) }
    }

    /// A measurement less what its sensor reports where the state is zero, and 1 where there is one; `None` without any.
    fn measured(&self, sample: usize, channel: usize) -> Option<(Lanes, Lanes)> {
        let has = |run: &Run| run.recorded(sample, channel);
        let error = self.gather(|run, t| Some(has(run)? - t.offset[sample][channel]));
        let some = self.0.iter().any(|(run, _)| has(run).is_some());
        some.then(|| (error, self.gather(|run, _| has(run).map(|_| 1.0))))
    }

    /// How the report of a channel changes with the state; `None` where it is the state.
    #[inline(always)]
    fn report(&self, sample: usize, channel: usize) -> Option<[Lanes; STATES]> {
        let senses = self.0.iter().any(|(_, t)| !t.report.is_empty());
        senses.then(|| std::array::from_fn(|l| self.gather(|_, t| Some(t.report.get(sample)?[channel][l]))))
    }

    /// Writes the step from a sample to the next.
    fn step(&self, sample: usize, out: &mut Step) {
        let (none, nowhere, no_force) = ([0.0; STATES], [[0.0; STATES]; STATES], [[0.0; 3]; STATES]);
        let tangent = |lane: usize| self.0.get(lane).map(|(_, tangent)| tangent);
        let state = each_lane(|lane| tangent(lane)?.state.get(sample), &none);
        let image = each_lane(|lane| tangent(lane)?.image.get(sample), &none);
        let a = each_lane(|lane| tangent(lane)?.a.get(sample), &nowhere);
        let gamma = each_lane(|lane| tangent(lane)?.gamma.get(sample), &no_force);
        for i in 0..STATES {
            out.state[i] = Lanes::from_fn(|lane| state[lane][i]);
            out.image[i] = Lanes::from_fn(|lane| image[lane][i]);
            (0..STATES).for_each(|l| out.a[i][l] = Lanes::from_fn(|lane| a[lane][i][l]));
            (0..3).for_each(|l| out.gamma[i][l] = Lanes::from_fn(|lane| gamma[lane][i][l]));
        }
        out.boost = self.gather(|run, _| Some(boost(run, sample)));
    }
}

/// What each lane has, or else `none`.
fn each_lane<'a, T>(of: impl Fn(usize) -> Option<&'a T>, none: &'a T) -> [&'a T; Lanes::LANES] {
    std::array::from_fn(|lane| of(lane).unwrap_or(none))
}

/// The filter before the measurements of a sample.
#[derive(Clone)]
pub(super) struct Place {
    pub sample: usize,
    /// Its mean.
    pub z: [Lanes; Z],
    /// Its covariance.
    pub p: Square<Lanes>,
}

/// A measurement as the filter takes it.
pub(super) struct Taken<'a> {
    pub channel: usize,
    /// How its report changes with the state; `None` where it is the state.
    pub slopes: Option<&'a [Lanes; STATES]>,
    /// The covariance of the filter state with it.
    pub ph: &'a [Lanes; Z],
    /// The innovation and its variance.
    pub error: Lanes,
    pub variance: Lanes,
    /// The inverse of the variance where the measurement corrects the filter, and 0 where it is absent or an outlier.
    pub weight: Lanes,
    /// 1 where there is a measurement.
    pub present: Lanes,
}

/// What goes along with the filter.
pub(super) trait Follow {
    /// Is told of every measurement, in their order.
    fn takes(&mut self, measurement: Taken);
    /// Is told of every step, before the filter takes it.
    fn steps(&mut self, _from: &Place, _step: &Step) {}
}

/// Moves a filter on to the sample `until`, before its measurements; at the end of the runs behind those of the last. What lies beyond
/// `gate` standard deviations is an outlier, which does not change the filter.
pub(super) fn pass(
    along: &Together,
    noise: &Discrete<Lanes>,
    gate: f64,
    place: &mut Place,
    until: usize,
    follow: &mut impl Follow,
) {
    let gate = Lanes::from_f64(gate * gate);
    let samples = along.samples();
    let mut step = Step::zero();
    // The corrections by measurements of a sample: the covariance is corrected by two at a time, so that one may wait for the next.
    let mut measurements = [Measurement::nothing(); 2];
    while place.sample < until.min(samples) {
        let k = place.sample;
        let Place { z, p, .. } = &mut *place;
        let mut waiting = false;
        for j in 0..STATES {
            let Some((y, present)) = along.measured(k, j) else { continue };
            let slopes = along.report(k, j);
            let [first, second] = &mut measurements;
            let (before, own) = if waiting { (Some(&*first), second) } else { (None, first) };
            match &slopes {
                Some(slopes) => sum_along(p, before, slopes, 9 + j, &mut own.ph),
                None => sum_of_rows(p, before, j, 9 + j, &mut own.ph),
            }
            let seen = |of: &[Lanes; Z]| slopes.as_ref().map_or(of[j], |slopes| product(slopes, of));
            let (reported, spread) = (seen(z), seen(&own.ph));
            let mut error = -(reported + z[9 + j]) + y;
            if j == 2 {
                error = trimtab_ad::smooth::wrap_angle(error);
            }
            let variance = noise.white[j] + spread + own.ph[9 + j];
            let outlier = (gate * variance).less(error * error);
            let weight = Lanes::select(outlier, Lanes::zero(), present / variance);
            for i in 0..Z {
                own.gain[i] = own.ph[i] * weight;
                z[i] += own.gain[i] * error;
            }
            let (slopes, ph) = (slopes.as_ref(), &own.ph);
            follow.takes(Taken { channel: j, slopes, ph, error, variance, weight, present });
            if waiting {
                correct_twice(p, &measurements);
            }
            waiting = !waiting;
        }
        if waiting {
            correct(p, &measurements[0]);
        }
        if k + 1 < samples {
            along.step(k, &mut step);
            follow.steps(place, &step);
            move_mean(&mut place.z, &step, noise);
            predict(&mut place.p, &step.a, &step.gamma, noise, step.boost);
        }
        place.sample += 1;
    }
}

/// Slopes by the ship's state times the first entries of a vector.
#[inline(always)]
fn product(slopes: &[Lanes; STATES], of: &[Lanes; Z]) -> Lanes {
    (0..STATES).fold(Lanes::zero(), |sum, l| sum + slopes[l] * of[l])
}

/// Moves the mean by a sample under the linearised step map.
#[inline(always)]
fn move_mean(z: &mut [Lanes; Z], step: &Step, noise: &Discrete<Lanes>) {
    let mut away = [Lanes::zero(); STATES];
    (0..STATES).for_each(|l| away[l] = z[l] - step.state[l]);
    for i in 0..STATES {
        z[i] = step.image[i];
        (0..STATES).for_each(|l| z[i] += away[l] * step.a[i][l]);
        (0..3).for_each(|l| z[i] += z[6 + l] * step.gamma[i][l]);
    }
    for i in 0..3 {
        z[6 + i] = noise.fade * z[6 + i];
    }
    for j in 0..STATES {
        z[9 + j] = noise.rho[j] * z[9 + j];
    }
}
