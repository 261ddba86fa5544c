//! Agreement of position, heading, velocity and yaw rate within one recording: delays, gyro bias and reference point.
//! It uses no ship and no model, so that it is independent evidence on a sensor that a diagnosis names.

use super::error::RealError;
use super::hull::Hull;
use nalgebra::{DMatrix, DVector};
use trimtab::numbers::numerals::{fixed, sig};
use trimtab::recording::{Channel, Recording};
use trimtab::report::Table;

/// Whether the channels of one recording agree.
#[derive(Clone, Debug)]
pub struct Agreement {
    /// The run.
    pub run: String,
    /// By how much velocities are later than positions \[s\].
    pub velocity_delay: f64,
    /// By how much the yaw rate is later than the heading \[s\].
    pub rate_delay: f64,
    /// Recorded yaw rate less the change of heading \[rad/s\].
    pub rate_bias: f64,
    /// How far forward of the point whose velocity is recorded the point lies whose position is recorded \[m\].
    pub lever: f64,
}

/// Least squares of `y` on columns.
fn least_squares(columns: &[Vec<f64>], y: Vec<f64>) -> Vec<f64> {
    let a = DMatrix::from_fn(y.len(), columns.len(), |i, j| columns[j][i]);
    let normal = a.transpose() * &a;
    let right = a.transpose() * DVector::from_vec(y);
    normal.cholesky().map_or_else(|| vec![0.0; columns.len()], |c| c.solve(&right).as_slice().to_vec())
}

/// Running integral by the trapezoidal rule.
fn integral(values: &[f64], t: &[f64]) -> Vec<f64> {
    let mut sum = 0.0;
    let mut out = vec![0.0];
    for k in 1..values.len() {
        sum += 0.5 * (values[k] + values[k - 1]) * (t[k] - t[k - 1]);
        out.push(sum);
    }
    out
}

impl Agreement {
    /// Compares changes over `span` \[s\] of position and heading with the integrals of velocity and yaw rate. With a delay
    /// tau and a lever l, `dx - int v dt = tau dv + l d(cos psi, sin psi)`; the two are collinear at constant speed, so that each
    /// is estimated with the other taken as zero. `None` for a recording without the channels or shorter than two spans.
    pub fn of(recording: &Recording, run: &str, span: f64) -> Option<Self> {
        use Channel::{Psi, R, T, U, V, X, Y};
        let channels = [T, X, Y, Psi, U, V, R].map(|c| recording.get(c));
        let [t, x, y, psi, u, v, r] = channels;
        let (t, x, y, psi, u, v, r) = (t?, x?, y?, psi?, u?, v?, r?);
        let lag = (span / recording.step()).round() as usize;
        let (mut late, mut lever, mut position) = (Vec::new(), [Vec::new(), Vec::new()], Vec::new());
        let (mut heading, mut rate) = (Vec::new(), [Vec::new(), Vec::new()]);
        for segment in recording.segments() {
            let s = |c: &[f64]| c[segment.clone()].to_vec();
            let (t, x, y, psi, u, v, r) = (s(t), s(x), s(y), s(psi), s(u), s(v), s(r));
            let (cos, sin): (Vec<f64>, Vec<f64>) = psi.iter().map(|p| (p.cos(), p.sin())).unzip();
            let north: Vec<f64> = (0..t.len()).map(|k| u[k] * cos[k] - v[k] * sin[k]).collect();
            let east: Vec<f64> = (0..t.len()).map(|k| u[k] * sin[k] + v[k] * cos[k]).collect();
            let (sum_north, sum_east, turned) = (integral(&north, &t), integral(&east, &t), integral(&r, &t));
            for k in lag..t.len() {
                let d = |c: &[f64]| c[k] - c[k - lag];
                position.extend([d(&x) - d(&sum_north), d(&y) - d(&sum_east)]);
                late.extend([d(&north), d(&east)]);
                lever[0].extend([d(&cos), d(&sin)]);
                lever[1].extend([-d(&sin), d(&cos)]);
                heading.push(wrapped(d(&psi) - d(&turned)));
                rate[0].push(d(&r));
                rate[1].push(-d(&t));
            }
        }
        if heading.len() < lag.max(1) {
            return None;
        }
        let turn = least_squares(&rate, heading);
        Some(Self {
            run: run.to_owned(),
            velocity_delay: least_squares(&[late], position.clone())[0],
            rate_delay: turn[0],
            rate_bias: turn[1],
            lever: least_squares(&lever, position)[0],
        })
    }

    /// Of every recording of a study.
    ///
    /// # Errors
    /// [`RealError::Study`].
    pub fn of_study(hull: &Hull, span: f64) -> Result<Vec<Self>, RealError> {
        let mut out = Vec::new();
        for run in &hull.study.runs {
            out.extend(Self::of(&hull.study.recording(run)?, &run.labels.run, span));
        }
        Ok(out)
    }
}

/// An angle in (-pi, pi].
pub fn wrapped(angle: f64) -> f64 {
    angle.sin().atan2(angle.cos())
}

/// A row a run.
pub fn table(agreements: &[Agreement]) -> Table {
    let mut table = Table::new([
        "run",
        "velocity later than position [s]",
        "yaw rate later than heading [s]",
        "gyro bias [deg/s]",
        "lever [m]",
    ]);
    for a in agreements {
        table.row([
            a.run.clone(),
            fixed(a.velocity_delay, 2),
            fixed(a.rate_delay, 2),
            sig(a.rate_bias.to_degrees(), 3),
            sig(a.lever, 3),
        ]);
    }
    table
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A circle recorded at 10 Hz: velocities late by `delay`, yaw rate late and biased, positions of a point `lever` forward.
    pub fn circle(delay: f64, rate_delay: f64, bias: f64, lever: f64) -> Recording {
        let (speed, size, slow) = (0.5, 0.3, 0.05);
        let t: Vec<f64> = (0..1500).map(|k| 0.1 * f64::from(k)).collect();
        // Heading swings, so that yaw rate and speed change.
        let psi = |t: f64| size * (slow * t).sin() + 0.02 * t;
        let rate = |t: f64| size * slow * (slow * t).cos() + 0.02;
        let mut place = [0.0, 0.0];
        let mut track = Vec::new();
        for &t in &t {
            track.push([place[0] + lever * psi(t).cos(), place[1] + lever * psi(t).sin()]);
            let middle = psi(t + 0.05);
            place = [place[0] + 0.1 * speed * middle.cos(), place[1] + 0.1 * speed * middle.sin()];
        }
        let velocity = |t: f64| {
            let turn = psi(t - delay) - psi(t);
            [speed * turn.cos(), speed * turn.sin()]
        };
        let of = |f: &dyn Fn(f64) -> f64| t.iter().map(|t| f(*t)).collect::<Vec<_>>();
        Recording::from_channels(
            "circle",
            vec![
                (Channel::X, track.iter().map(|p| p[0]).collect()),
                (Channel::Y, track.iter().map(|p| p[1]).collect()),
                (Channel::Psi, of(&psi)),
                (Channel::U, of(&|t| velocity(t)[0])),
                (Channel::V, of(&|t| velocity(t)[1])),
                (Channel::R, of(&|t| rate(t - rate_delay) + bias)),
                (Channel::N, of(&|_| 10.0)),
                (Channel::Delta, of(&|_| 0.1)),
                (Channel::T, t),
            ],
        )
        .unwrap()
    }

    #[test]
    fn delays_gyro_bias_and_lever_of_a_recording_are_recovered() {
        let late = Agreement::of(&circle(0.8, 0.5, 1e-3, 0.0), "late", 20.0).unwrap();
        assert!((late.velocity_delay - 0.8).abs() < 0.02, "{late:?}");
        assert!((late.rate_delay - 0.5).abs() < 0.02 && (late.rate_bias - 1e-3).abs() < 2e-5, "{late:?}");
        let aft = Agreement::of(&circle(0.0, 0.0, 0.0, -0.4), "aft", 20.0).unwrap();
        assert!((aft.lever + 0.4).abs() < 0.01, "{aft:?}");
        let sound = Agreement::of(&circle(0.0, 0.0, 0.0, 0.0), "sound", 20.0).unwrap();
        assert!(
            sound.velocity_delay.abs() < 0.02 && sound.lever.abs() < 0.01 && sound.rate_delay.abs() < 0.02,
            "{sound:?}"
        );
    }
}
