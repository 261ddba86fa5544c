//! What position, heading, velocity and yaw rate of one recording say of each other: clocks, gyro and reference point.
//! No ship and no model enters, so that it can stand witness when a diagnosis blames a sensor.

use super::{Hull, RealError};
use nalgebra::{DMatrix, DVector};
use trimtab::recording::{Channel, Recording, Run};
use trimtab::report::{Table, fixed, sig};

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
    /// tau and a lever l, `dx - int v dt = tau dv + l d(cos psi, sin psi)`; the two look alike at constant speed, so that each
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
fn wrapped(angle: f64) -> f64 {
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

/// What a recording's own kinematics say must be mended in its windows before a model is asked.
#[derive(Clone, Debug, Default)]
pub struct Mend {
    /// Recorded velocities are late or no measurement of their own: leave them out.
    pub no_velocity: bool,
    /// Stretches in which position and heading were held, not measured \[s\].
    pub held: Vec<(f64, f64)>,
    /// The yaw rate is this much late \[s\].
    pub rate_delay: f64,
    /// The yaw rate reads this much too much \[rad/s\].
    pub rate_bias: f64,
    /// Times at which position or heading jump: windows over them are left out \[s\].
    pub jumps: Vec<f64>,
}

impl Mend {
    /// The run with its gyro in time and without bias, and without what was not measured; `None` when the receiver jumped.
    pub fn applied(&self, run: &Run) -> Option<Run> {
        let (first, last) = (run.inputs.first()?.t, run.inputs.last()?.t);
        if self.jumps.iter().any(|t| first <= *t && *t <= last) {
            return None;
        }
        let mut out = run.clone();
        for k in 0..run.measured.len() {
            let t = run.inputs[k].t;
            // A sample is the mean of the rows within half a sample period.
            if self.held.iter().any(|(a, b)| a - 0.5 * run.dt <= t && t <= b + 0.5 * run.dt) {
                out.measured[k][..3].fill(None);
            }
            if self.no_velocity {
                out.measured[k][3..5].fill(None);
            }
            let rate = interpolated(run, 5, k as f64 + self.rate_delay / run.dt);
            out.measured[k][5] = rate.map(|r| r - self.rate_bias);
        }
        Some(out)
    }
}

/// A channel between two samples; `None` outside the run, and beside a missing value.
fn interpolated(run: &Run, channel: usize, place: f64) -> Option<f64> {
    let (i, share) = (place.floor(), place - place.floor());
    let value = |i: f64| if i < 0.0 { None } else { run.measured.get(i as usize)?[channel] };
    if share == 0.0 { value(i) } else { Some((1.0 - share) * value(i)? + share * value(i + 1.0)?) }
}

/// Stretches in which position and heading repeat to the last bit for `rows` rows or more: a receiver that holds its last value.
/// A stretch begins with the first repetition.
pub fn held(recording: &Recording, rows: usize) -> Vec<(f64, f64)> {
    let [t, x, y, psi] = position(recording);
    let repeats = |k: usize| k > 0 && x[k] == x[k - 1] && y[k] == y[k - 1] && psi[k] == psi[k - 1];
    let mut out = Vec::new();
    let mut k = 1;
    while k < x.len() {
        let from = k;
        while k < x.len() && repeats(k) {
            k += 1;
        }
        if k - from >= rows.max(1) {
            out.push((t[from], t[k - 1]));
        }
        k += 1;
    }
    out
}

/// Times at which position or heading move faster than a ship can \[m/s, rad/s\] since they last changed: a receiver that lost
/// itself and found itself again.
pub fn jumps(recording: &Recording, fastest: f64, fastest_turn: f64) -> Vec<f64> {
    let [t, x, y, psi] = position(recording);
    let mut changed = 0;
    let mut out = Vec::new();
    for k in 1..x.len() {
        let (dx, dy, turn) = (x[k] - x[k - 1], y[k] - y[k - 1], wrapped(psi[k] - psi[k - 1]).abs());
        if dx == 0.0 && dy == 0.0 && turn == 0.0 {
            continue;
        }
        let since = t[k] - t[changed];
        if dx.hypot(dy) > fastest * since || turn > fastest_turn * since {
            out.push(t[k]);
        }
        changed = k;
    }
    out
}

/// Time, position and heading; empty where one was not recorded.
fn position(recording: &Recording) -> [&[f64]; 4] {
    let channels = [Channel::T, Channel::X, Channel::Y, Channel::Psi].map(|c| recording.get(c).unwrap_or_default());
    if channels.iter().any(|c| c.is_empty()) { [&[]; 4] } else { channels }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A circle recorded at 10 Hz: velocities late by `delay`, yaw rate late and biased, positions of a point `lever` forward.
    fn circle(delay: f64, rate_delay: f64, bias: f64, lever: f64) -> Recording {
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
    fn clocks_gyro_and_lever_are_read_off_a_recording() {
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

    #[test]
    fn a_receiver_that_holds_and_one_that_jumps_are_told_apart() {
        let good = circle(0.0, 0.0, 0.0, 0.0);
        assert!(held(&good, 2).is_empty() && jumps(&good, 1.5, 0.5).is_empty());
        let broken = |edit: &dyn Fn(&mut [Vec<f64>; 3])| {
            let mut place = [Channel::X, Channel::Y, Channel::Psi].map(|c| good.get(c).unwrap().to_vec());
            edit(&mut place);
            let others = good.channels().filter(|(c, _)| ![Channel::X, Channel::Y, Channel::Psi].contains(c));
            let mut channels: Vec<(Channel, Vec<f64>)> = others.map(|(c, v)| (c, v.to_vec())).collect();
            let [x, y, psi] = place;
            channels.extend([(Channel::X, x), (Channel::Y, y), (Channel::Psi, psi)]);
            Recording::from_channels("broken", channels).unwrap()
        };
        let holding = broken(&|p| p.iter_mut().for_each(|c| (101..110).for_each(|k| c[k] = c[100])));
        let stretches = held(&holding, 2);
        assert_eq!(stretches.len(), 1);
        assert!((stretches[0].0 - 10.1).abs() < 1e-9 && (stretches[0].1 - 10.9).abs() < 1e-9, "{stretches:?}");
        assert!(jumps(&holding, 1.5, 0.5).is_empty(), "it catches up no faster than it could have sailed");
        let jumping = broken(&|p| p[0][700..].iter_mut().for_each(|x| *x += 0.4));
        assert_eq!(jumps(&jumping, 1.5, 0.5).len(), 1);
        assert!(held(&jumping, 2).is_empty());
    }
}
