//! The derivatives of the log-likelihood by the noise, backwards through the filter: as exact as those forwards, at the price of one
//! more pass for all of them.

use super::levels::{GROUP_OF, NOISE_PARAMETERS, Noise};
use super::linearised::{Follow, Place, Step, Taken, Together, pass};
use crate::likelihood::covariance::{Discrete, Square, Z};
use crate::state::STATES;
use trimtab_ad::{Lanes, Scalar};

/// What the filter did, in its order.
#[derive(Default)]
struct Tape {
    measurements: Vec<Record>,
    steps: Vec<(Place, Step, usize)>,
}

/// A measurement that the filter took.
struct Record {
    channel: usize,
    slopes: Option<[Lanes; STATES]>,
    ph: [Lanes; Z],
    error: Lanes,
    weight: Lanes,
}

impl Follow for Tape {
    fn takes(&mut self, Taken { channel, slopes, ph, error, weight, .. }: Taken) {
        self.measurements.push(Record { channel, slopes: slopes.copied(), ph: *ph, error, weight });
    }
    fn steps(&mut self, from: &Place, step: &Step) {
        self.steps.push((from.clone(), *step, self.measurements.len()));
    }
}

/// The derivatives of the log-likelihood of what comes behind a place: by mean and covariance there, and by the noise.
struct Adjoint {
    z: [Lanes; Z],
    /// Both halves of a symmetric matrix L: a change dP of the covariance adds the sum of `L_ij dP_ij`.
    p: Square<Lanes>,
    noise: Discrete<Lanes>,
}

impl Adjoint {
    fn zero() -> Self {
        let zero = Lanes::zero();
        let noise = Discrete {
            white: [zero; STATES],
            coloured: [zero; STATES],
            rho: [zero; STATES],
            force: [zero; 3],
            fade: zero,
        };
        Self { z: [zero; Z], p: [[zero; Z]; Z], noise }
    }

    /// Back through a measurement of innovation e = y - h'z and variance s = h'c + white, c = P h the covariance with it:
    /// `z' = z + c e / s`, `P' = P - c c' / s`, log-likelihood `-(e^2 / s + ln s) / 2`.
    #[inline(always)]
    fn measurement(&mut self, Record { channel, slopes, ph, error, weight }: &Record) {
        let (e, w) = (*error, *weight);
        let mut along = [Lanes::zero(); Z];
        for i in 0..Z {
            let row = &self.p[i];
            along[i] = (0..Z).fold(Lanes::zero(), |sum, l| sum + row[l] * ph[l]);
        }
        let of_mean = (0..Z).fold(Lanes::zero(), |sum, i| sum + self.z[i] * ph[i]);
        let of_covariance = (0..Z).fold(Lanes::zero(), |sum, i| sum + along[i] * ph[i]);
        let by_error = w * (of_mean - e);
        let by_variance = w * w * (of_covariance - of_mean * e + e * e * 0.5) - w * 0.5;
        // By half of each entry of c, since a change of P reaches L from two sides.
        let mut by_ph = [Lanes::zero(); Z];
        (0..Z).for_each(|i| by_ph[i] = w * (self.z[i] * e * 0.5 - along[i]));
        let mut entry = |l: usize, h: Lanes| by_ph[l] += by_variance * 0.5 * h;
        match slopes {
            Some(slopes) => (0..STATES).for_each(|l| entry(l, slopes[l])),
            None => entry(*channel, Lanes::one()),
        }
        entry(9 + channel, Lanes::one());
        let mut back = |l: usize, h: Lanes| {
            self.z[l] -= by_error * h;
            for i in 0..Z {
                let part = by_ph[i] * h;
                self.p[i][l] += part;
                self.p[l][i] += part;
            }
        };
        match slopes {
            // Most reports depend on one or two entries of the state.
            Some(slopes) => {
                (0..STATES).filter(|l| slopes[*l] != Lanes::zero()).for_each(|l| back(l, slopes[l]));
            }
            None => back(*channel, Lanes::one()),
        }
        back(9 + channel, Lanes::one());
        self.noise.white[*channel] += by_variance;
    }

    /// Back through a step `z' = F z + b`, `P' = F P F' + Q`: `L = F' L' F`, and by an entry f of F on its diagonal
    /// `2 (L' F P)_ii + z'_i z_i`.
    fn step(&mut self, Place { z, p, .. }: &Place, Step { a, gamma, boost, .. }: &Step, noise: &Discrete<Lanes>) {
        for i in 0..3 {
            let own = self.p[6 + i][6 + i] * *boost;
            self.noise.force[i] += own * (Lanes::one() - noise.fade * noise.fade);
            self.noise.fade -= own * noise.force[i] * noise.fade * 2.0;
        }
        for j in 0..STATES {
            let own = self.p[9 + j][9 + j];
            self.noise.coloured[j] += own * (Lanes::one() - noise.rho[j] * noise.rho[j]);
            self.noise.rho[j] -= own * noise.coloured[j] * noise.rho[j] * 2.0;
        }
        // L' F.
        let mut half = [[Lanes::zero(); Z]; Z];
        for i in 0..Z {
            let (row, out) = (&self.p[i], &mut half[i]);
            (out[0], out[1]) = (row[0], row[1]);
            for l in 0..STATES {
                let factor = row[l];
                (2..STATES).for_each(|c| out[c] += factor * a[l][c]);
                (0..3).for_each(|c| out[6 + c] += factor * gamma[l][c]);
            }
            (0..3).for_each(|c| out[6 + c] += row[6 + c] * noise.fade);
            (0..STATES).for_each(|j| out[9 + j] = row[9 + j] * noise.rho[j]);
        }
        let on_diagonal = |i: usize| {
            let before = (0..=i).fold(Lanes::zero(), |sum, l| sum + half[i][l] * p[i][l]);
            let all = (i + 1..Z).fold(before, |sum, l| sum + half[i][l] * p[l][i]);
            all * 2.0 + self.z[i] * z[i]
        };
        (6..9).for_each(|i| self.noise.fade += on_diagonal(i));
        (0..STATES).for_each(|j| self.noise.rho[j] += on_diagonal(9 + j));
        // F' times that, of which one half is made and mirrored.
        let mut out = [[Lanes::zero(); Z]; Z];
        (out[0], out[1]) = (half[0], half[1]);
        for l in 0..STATES {
            for c in 2..STATES {
                (0..=c).for_each(|i| out[c][i] += half[l][i] * a[l][c]);
            }
            for c in 0..3 {
                (0..=6 + c).for_each(|i| out[6 + c][i] += half[l][i] * gamma[l][c]);
            }
        }
        (6..9).for_each(|c| (0..=c).for_each(|i| out[c][i] += half[c][i] * noise.fade));
        (0..STATES).for_each(|j| (0..=9 + j).for_each(|i| out[9 + j][i] = half[9 + j][i] * noise.rho[j]));
        for i in 0..Z {
            (0..i).for_each(|l| out[l][i] = out[i][l]);
        }
        self.p = out;
        let of_state = self.z;
        for c in 2..STATES {
            self.z[c] = (0..STATES).fold(Lanes::zero(), |sum, l| sum + of_state[l] * a[l][c]);
        }
        for c in 0..3 {
            let faded = of_state[6 + c] * noise.fade;
            self.z[6 + c] = (0..STATES).fold(faded, |sum, l| sum + of_state[l] * gamma[l][c]);
        }
        (0..STATES).for_each(|j| self.z[9 + j] = of_state[9 + j] * noise.rho[j]);
    }

    /// Back to the start, where unknown force and coloured noise have their variances.
    fn start(&mut self) {
        (0..3).for_each(|i| self.noise.force[i] += self.p[6 + i][6 + i]);
        (0..STATES).for_each(|j| self.noise.coloured[j] += self.p[9 + j][9 + j]);
    }

    /// The derivatives by the logarithms of a noise, in the lane of a run of sample period `dt` \[s\].
    fn by_logarithms(&self, noise: &Noise, dt: f64, lane: usize) -> [f64; NOISE_PARAMETERS] {
        let mut out = [0.0; NOISE_PARAMETERS];
        // What is left of a correlation after a period, by the logarithm of its time.
        let by_time = |time: f64| (-dt / time).exp() * dt / time;
        for j in 0..STATES {
            let (g, sensor) = (GROUP_OF[j], noise.sensors[GROUP_OF[j]]);
            out[3 * g] += 2.0 * sensor.white.powi(2) * self.noise.white[j].lane(lane);
            out[3 * g + 1] += 2.0 * sensor.coloured.powi(2) * self.noise.coloured[j].lane(lane);
            out[3 * g + 2] += by_time(sensor.time) * self.noise.rho[j].lane(lane);
        }
        for i in 0..3 {
            out[12 + i] = 2.0 * noise.force[i].powi(2) * self.noise.force[i].lane(lane);
        }
        out[15] = by_time(noise.force_time) * self.noise.fade.lane(lane);
        out
    }
}

/// The derivatives of the log-likelihood of each run by the logarithms of the noise, outliers left out. `places` are where the filter of
/// this noise was on its way, the first at its start: it passes over what lies between two of them once more.
pub(super) fn slopes(along: &Together, noise: &Noise, gate: f64, places: &[Place]) -> Vec<[f64; NOISE_PARAMETERS]> {
    let discrete = along.discrete(noise);
    let mut adjoint = Adjoint::zero();
    let mut tape = Tape::default();
    for (i, from) in places.iter().enumerate().rev() {
        let until = places.get(i + 1).map_or(usize::MAX, |next| next.sample);
        pass(along, &discrete, gate, &mut from.clone(), until, &mut tape);
        while let Some((place, step, measurements)) = tape.steps.pop() {
            tape.measurements.drain(measurements..).rev().for_each(|record| adjoint.measurement(&record));
            adjoint.step(&place, &step, &discrete);
        }
        tape.measurements.drain(..).rev().for_each(|record| adjoint.measurement(&record));
    }
    adjoint.start();
    along.0.iter().enumerate().map(|(lane, (run, _))| adjoint.by_logarithms(noise, run.dt, lane)).collect()
}
