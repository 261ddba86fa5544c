//! Nomoto's K and T of a trial: the gain and the time constant of the first-order response of yaw rate to rudder.
//! They describe one trial, at its rudder angles and its loss of speed; no model is made of them.

use super::track::Track;
use nalgebra::{SMatrix, SVector};
use serde::Serialize;

/// Nomoto's equation of first order, T r' + r = K (delta - delta_0) (Nomoto, Taguchi, Honda & Hirano 1957), fitted to a trial.
///
/// Primes are K' = K L/U and T' = T U/L. A ship that is unstable on its course has negative K and T at small angles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Nomoto {
    /// Gain K \[1/s\]: yaw rate over rudder angle in the steady turn.
    pub gain: f64,
    /// Time constant T \[s\].
    pub time: f64,
    /// Rudder angle delta_0 that holds a straight course \[rad\]; 0 where one rudder step does not determine it.
    pub neutral: f64,
}

/// K, T and the neutral angle from samples `from` to `to` of a track with rudder to both sides.
///
/// The equation is integrated once, as Nomoto did by hand, so that no measured rate is differentiated:
/// psi - psi_0 = K int delta dt - T (r - r_0) - K delta_0 t, solved for K, T and K delta_0 by least squares of the heading.
pub(super) fn nomoto(track: &Track, from: usize, to: usize) -> Option<Nomoto> {
    let [gain, time, held] = fitted::<3>(track, from, to)?;
    let found = Nomoto { gain, time, neutral: held / gain };
    found.neutral.is_finite().then_some(found)
}

/// K and T of a turn with one rudder step, which does not distinguish the neutral angle from the gain.
pub(super) fn nomoto_of_step(track: &Track, from: usize, to: usize) -> Option<Nomoto> {
    let [gain, time] = fitted::<2>(track, from, to)?;
    Some(Nomoto { gain, time, neutral: 0.0 })
}

/// The least squares of the integrated equation in its first `N` unknowns.
fn fitted<const N: usize>(track: &Track, from: usize, to: usize) -> Option<[f64; N]> {
    let start = track.states.get(from)?;
    let (mut matrix, mut right) = (SMatrix::<f64, N, N>::zeros(), SVector::<f64, N>::zeros());
    let mut turned = 0.0;
    for k in from + 1..=to.min(track.len().checked_sub(1)?) {
        let dt = track.t[k] - track.t[k - 1];
        turned += 0.5 * dt * (track.delta[k - 1] + track.delta[k]);
        let s = &track.states[k];
        let all = [turned, -(s[5] - start[5]), -(track.t[k] - track.t[from])];
        let heading = s[2] - start[2];
        if !(heading.is_finite() && all.iter().all(|x| x.is_finite())) {
            continue;
        }
        let row = SVector::<f64, N>::from_fn(|i, _| all[i]);
        right += row * heading;
        matrix += row * row.transpose();
    }
    solved(matrix, right)
}

/// The solution of a symmetric positive system; `None` where it is singular.
fn solved<const N: usize>(a: SMatrix<f64, N, N>, b: SVector<f64, N>) -> Option<[f64; N]> {
    // What a diagonal entry keeps beside the unknowns before it, relative to it, below which these cannot be distinguished.
    const LEAST: f64 = 1e-10;
    let factor = a.cholesky()?;
    let kept = |i: usize| factor.l_dirty()[(i, i)].powi(2);
    (0..N).all(|i| kept(i) > LEAST * a[(i, i)]).then(|| factor.solve(&b).into())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ship that obeys the equation, under a rudder angle of time, in fine steps.
    fn sailed(gain: f64, time: f64, neutral: f64, rudder: impl Fn(f64) -> f64) -> Track {
        let mut track = Track::default();
        let (mut psi, mut r, dt) = (0.3, 0.0, 0.05);
        for k in 0..6000 {
            let t = k as f64 * dt;
            track.t.push(t);
            track.states.push([0.0, 0.0, psi, 2.0, 0.0, r]);
            track.delta.push(rudder(t));
            track.n.push(1.0);
            let rate = |r: f64, t: f64| (gain * (rudder(t) - neutral) - r) / time;
            let middle = r + 0.5 * dt * rate(r, t);
            let after = r + dt * rate(middle, t + 0.5 * dt);
            psi += 0.5 * dt * (r + after);
            r = after;
        }
        track
    }

    #[test]
    fn a_ship_that_obeys_the_equation_gives_its_own_gain_time_and_neutral_angle() {
        for (gain, time, neutral) in [(0.05, 20.0, 0.02), (0.2, 3.0, -0.01), (-0.02, -80.0, 0.0)] {
            let track = sailed(gain, time, neutral, |t| 0.2 * (t / 20.0).sin().signum());
            let found = nomoto(&track, 0, 4000).unwrap();
            assert!((found.gain / gain - 1.0).abs() < 1e-2, "{found:?}");
            assert!((found.time / time - 1.0).abs() < 1e-2, "{found:?}");
            assert!((found.neutral - neutral).abs() < 1e-3, "{found:?}");
        }
        let step = sailed(0.05, 20.0, 0.0, |t| 0.6 * (t / 10.0).min(1.0));
        let found = nomoto_of_step(&step, 0, 2000).unwrap();
        assert!((found.gain / 0.05 - 1.0).abs() < 1e-3 && (found.time / 20.0 - 1.0).abs() < 1e-3, "{found:?}");
    }

    #[test]
    fn a_rudder_at_rest_determines_neither_gain_nor_time() {
        let track = sailed(0.05, 20.0, 0.0, |_| 0.0);
        assert_eq!((nomoto(&track, 0, 4000), nomoto_of_step(&track, 0, 4000)), (None, None));
    }
}
