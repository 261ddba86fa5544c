//! What is done with a ship: steering, propeller, speed and turning as series without gaps, and the time scale of its motion. A craft without
//! the channel of a rudder is steered by what turns it, one without that of a propeller is not stopped by it.
//! What it makes of them is decided in `blocks`.

use crate::recording::{Channel, Recording, local, slope};
use std::ops::Range;

/// The controls and the motion in a stretch without a gap.
#[derive(Clone, Debug)]
pub struct Controls {
    /// Time \[s\].
    pub t: Vec<f64>,
    /// Rudder angle \[rad\] without single outliers; the yaw rate \[rad/s\] where no rudder was recorded.
    pub steering: Vec<f64>,
    /// Whether that is a rudder angle.
    pub by_rudder: bool,
    /// Propeller rate \[1/s\], without single outliers; empty where none was recorded.
    pub n: Vec<f64>,
    /// Heading \[rad\], unwrapped, or the integral of the yaw rate.
    pub psi: Vec<f64>,
    /// Yaw rate \[rad/s\], smoothed.
    pub r: Vec<f64>,
    /// Speed \[m/s\], smoothed; NaN where none was recorded.
    pub speed: Vec<f64>,
    /// Usual step \[s\].
    pub step: f64,
}

/// Steps over which motion is smoothed.
const SPAN_STEPS: f64 = 8.0;

impl Controls {
    /// Of the unbroken stretches of a recording.
    pub fn of(recording: &Recording) -> Vec<Self> {
        recording.segments().into_iter().filter_map(|rows| Self::within(recording, rows)).collect()
    }

    fn within(recording: &Recording, rows: Range<usize>) -> Option<Self> {
        let (time, step) = (recording.time(), recording.step());
        let span = SPAN_STEPS * step;
        let smooth = |v: &[f64]| local(time, v, rows.clone(), span).into_iter().map(|c| c[0]).collect::<Vec<f64>>();
        let get = |channel| recording.get(channel);
        let t = time[rows.clone()].to_vec();
        let (psi, r) = match (get(Channel::Psi), get(Channel::R)) {
            (Some(psi), Some(r)) => (psi[rows.clone()].to_vec(), smooth(r)),
            (Some(psi), None) => (psi[rows.clone()].to_vec(), slope(time, psi, rows.clone(), span)),
            (None, Some(r)) => (integral(&t, &r[rows.clone()]), smooth(r)),
            (None, None) => return None,
        };
        let speed = match (get(Channel::U), get(Channel::V), get(Channel::X), get(Channel::Y)) {
            (Some(u), Some(v), ..) => smooth(u).iter().zip(smooth(v)).map(|(u, v)| u.hypot(v)).collect(),
            (Some(u), None, ..) => smooth(u).iter().map(|u| u.abs()).collect(),
            (None, _, Some(x), Some(y)) => {
                let (dx, dy) = (slope(time, x, rows.clone(), span), slope(time, y, rows.clone(), span));
                dx.iter().zip(dy).map(|(a, b)| a.hypot(b)).collect()
            }
            _ => vec![f64::NAN; rows.len()],
        };
        let control = |channel| get(channel).map(|v| without_outliers(&v[rows.clone()]));
        let (rudder, n) = (control(Channel::Delta), control(Channel::N).unwrap_or_default());
        let by_rudder = rudder.is_some();
        Some(Self { steering: rudder.unwrap_or_else(|| r.clone()), by_rudder, n, t, psi, r, speed, step })
    }

    /// Samples.
    pub fn len(&self) -> usize {
        self.t.len()
    }
}

/// Each value as the middle one of itself and its neighbours.
fn without_outliers(v: &[f64]) -> Vec<f64> {
    let middle = |i: usize| {
        if i == 0 || i + 1 >= v.len() {
            return v[i];
        }
        let mut three = [v[i - 1], v[i], v[i + 1]];
        three.sort_by(f64::total_cmp);
        three[1]
    };
    (0..v.len()).map(middle).collect()
}

fn integral(t: &[f64], r: &[f64]) -> Vec<f64> {
    let mut psi = vec![0.0; t.len()];
    for i in 1..t.len() {
        psi[i] = psi[i - 1] + 0.5 * (r[i] + r[i - 1]) * (t[i] - t[i - 1]);
    }
    psi
}

/// The value below which a share of the sizes lies; 0 of nothing.
pub fn size_below(values: impl Iterator<Item = f64>, share: f64) -> f64 {
    let mut sizes: Vec<f64> = values.map(f64::abs).filter(|v| v.is_finite()).collect();
    if sizes.is_empty() {
        return 0.0;
    }
    let at = ((sizes.len() - 1) as f64 * share) as usize;
    *sizes.select_nth_unstable_by(at, f64::total_cmp).1
}

/// The time in which the ship turns through ten degrees when it turns fast \[s\]: five seconds of a ship of 50 m, twenty of one of
/// 300 m, one of a model. Between five steps and a minute.
pub fn time_scale(all: &[Controls]) -> f64 {
    let fast = size_below(all.iter().flat_map(|c| c.r.iter().copied()), 0.95);
    let step = all.iter().map(|c| c.step).fold(0.0, f64::max);
    (0.175 / fast.max(1e-6)).clamp(5.0 * step, (60.0_f64).max(5.0 * step))
}
