//! Kinematic consistency of position, heading, velocity and yaw rate: a track is the integral of the velocities along the heading, and a
//! heading that of the yaw rate. Errors of sensors are compared by it without a model of the ship; which are compared is decided elsewhere.

use super::candidate::Candidate;
use crate::diagnose::settings::{CORRECTIONS, GATE, SENSOR_SPREAD, STRETCH, STRETCHES};
use crate::dynamics::Dynamics;
use crate::likelihood::evidence::chi_squared_p;
use crate::likelihood::filter::Column;
use crate::model::Model;
use crate::physics::Kind;
use crate::recording::{Measured, Run};
use crate::state::{Force, Inputs, STATES, State};
use crate::statistics::{interval_of_sum, median};
use nalgebra::{DMatrix, DVector};
use std::collections::{BTreeMap, BTreeSet};
use trimtab_ad::smooth::wrap_angle;

/// The equations of a stretch: its way ahead and to starboard \[m\], its turn \[rad\].
type Equations = [f64; 3];

/// A stretch of a run, half a ship length long.
struct Stretch<'r> {
    recording: &'r str,
    session: &'r str,
    /// Its block of successive stretches: the run, and the number of the block in it.
    block: (usize, usize),
    /// Way and turn less those that the velocities make, of what was recorded without the errors that the model already has.
    left: Equations,
    /// The same of what a unit of each column adds to the reports.
    columns: Vec<Equations>,
}

impl Stretch<'_> {
    /// The stretch with some of its columns in each session, which are zero in the others.
    fn apart(&self, some: &[usize], sessions: &BTreeSet<&str>) -> Self {
        let of = |session: &str, c: usize| if session == self.session { self.columns[c] } else { [0.0; 3] };
        let columns = sessions.iter().flat_map(|session| some.iter().map(|c| of(session, *c))).collect();
        Self { columns, ..*self }
    }
}

/// How well the sensors agree if one of them errs.
#[derive(Clone, Debug)]
pub struct Agreement {
    /// Its amplitudes at which they agree best, in units of the candidate's columns.
    pub amplitude: DVector<f64>,
    /// Log-likelihood by recording, up to a constant that all errors share, and the number of its stretches.
    by_recording: BTreeMap<String, (f64, f64)>,
}

impl Agreement {
    /// The 95 % interval over recordings of how much likelier it is than another; `None` where they are too few.
    pub fn over(&self, other: &Self) -> Option<[f64; 2]> {
        gain_over(&self.by_recording, &other.by_recording)
    }
}

/// The agreement of the sensors under each of some candidates, which are errors of sensors with one amplitude in all sessions; `None`
/// where no stretch has every channel. Positions p, heading psi, velocities V over ground and yaw rate r give
/// `R(-psi) (p(t + T) - p(t) - int R(psi) V dt)` and `psi(t + T) - psi(t) - int r dt`, which are linear in the amplitudes; each equation
/// counts by the scatter that all errors together leave in it, with outliers at the filter's gate.
pub fn agreements(model: &Model, runs: &[Run], candidates: &[&Candidate]) -> Option<Vec<Agreement>> {
    let stretches = stretches_of(model, runs, candidates);
    let scatter = scatter(&stretches)?;
    let each = places(candidates).map(|own| {
        let amplitude = solve(&stretches, &own, &scatter, 0.0)?;
        let by_recording = by(&stretches, &scatter, |s| s.recording.to_owned(), |s| less(s, &own, &amplitude));
        Some(Agreement { amplitude, by_recording })
    });
    each.collect()
}

/// Gain in log-likelihood of the kinematic consistency of some runs, by the errors of sensors that a model has (`after`) over those of
/// another (`before`): over all recordings, with its 95 % interval over them, where they are enough. Each equation counts
/// by the scatter that the errors of all sensors among the `candidates` together leave in it. `None` where no stretch has every channel.
pub fn gain(before: &Model, after: &Model, runs: &[Run], candidates: &[Candidate]) -> Option<(f64, Option<[f64; 2]>)> {
    let sensors: Vec<&Candidate> = candidates.iter().filter(|c| c.mechanism.kind == Kind::Sensor).collect();
    let without = stretches_of(before, runs, &sensors);
    let scatter = scatter(&without)?;
    let [before, after] = [without, stretches_of(after, runs, &[])].map(|all| {
        let by_recording = by(&all, &scatter, |s| s.recording.to_owned(), |s| s.left);
        Agreement { amplitude: DVector::zeros(0), by_recording }
    });
    let all = |a: &Agreement| a.by_recording.values().map(|r| r.0).sum::<f64>();
    Some((all(&after) - all(&before), after.over(&before)))
}

/// An error of a sensor, estimated from the kinematic consistency alone as if no other sensor had an error.
pub struct Disagreement {
    /// Its amplitudes, in units of the candidate's columns: those of all sessions, or of each of some, session after session.
    pub amplitude: DVector<f64>,
    /// The sessions, where they differ significantly and throughout; empty where they do not.
    pub sessions: Vec<String>,
    /// Twice what it adds to the log-likelihood.
    pub statistic: f64,
    /// Its p-value.
    pub p: f64,
    /// Whether it makes the stretches likelier throughout, by the scatter over blocks of successive stretches: what changes in time is no
    /// error of a sensor, however large. True where there are too few blocks for that.
    pub is_steady: bool,
    /// Log-likelihood of the stretches with it, and their number, by block.
    by_block: BTreeMap<(usize, usize), (f64, f64)>,
}

impl Disagreement {
    /// Whether it makes the stretches significantly likelier than another error does.
    pub fn is_ahead_of(&self, other: &Self) -> bool {
        gain_over(&self.by_block, &other.by_block).is_some_and(|[low, _]| low > 0.0)
    }
}

/// The 95 % interval over blocks of how much likelier the stretches are by one account than by another.
fn gain_over<K: Ord>(of: &BTreeMap<K, (f64, f64)>, other: &BTreeMap<K, (f64, f64)>) -> Option<[f64; 2]> {
    let gains: Vec<(f64, f64)> = of.iter().map(|(key, (l, n))| (l - other[key].0, *n)).collect();
    interval_of_sum(&gains)
}

/// Each candidate at the amplitudes at which the sensors agree best, the others without an error; `None` where no stretch has every channel.
/// An error that leaves the sensors consistent (an antenna whose position and velocities are both those of another point, or clocks that are
/// all late together) is not significant, whatever its size. A candidate has an amplitude in each session where that is likelier with a
/// chance below `alpha`.
pub fn disagreements(model: &Model, runs: &[Run], candidates: &[&Candidate], alpha: f64) -> Option<Vec<Disagreement>> {
    let stretches = stretches_of(model, runs, candidates);
    let scatter = scatter(&stretches)?;
    let sessions: BTreeSet<&str> = stretches.iter().map(|s| s.session).collect();
    let without = by(&stretches, &scatter, |s| s.block, |s| s.left);
    let total = |by_block: &BTreeMap<_, (f64, f64)>| by_block.values().map(|b| b.0).sum::<f64>();
    let of = |stretches: &[Stretch], own: &[usize], sessions: Vec<String>| {
        let amplitude = solve(stretches, own, &scatter, SENSOR_SPREAD.powi(-2))?;
        let by_block = by(stretches, &scatter, |s| s.block, |s| less(s, own, &amplitude));
        let statistic = 2.0 * (total(&by_block) - total(&without)).max(0.0);
        let p = chi_squared_p(statistic, own.len());
        let is_steady = gain_over(&by_block, &without).is_none_or(|[low, _]| low > 0.0);
        Some(Disagreement { amplitude, sessions, statistic, p, is_steady, by_block })
    };
    let each = places(candidates).map(|own| {
        let all = of(&stretches, &own, Vec::new())?;
        if sessions.len() > 1 {
            let apart: Vec<Stretch> = stretches.iter().map(|s| s.apart(&own, &sessions)).collect();
            let columns: Vec<usize> = (0..own.len() * sessions.len()).collect();
            let each = of(&apart, &columns, sessions.iter().map(|s| (*s).to_owned()).collect())?;
            let gain = (each.statistic - all.statistic).max(0.0);
            if chi_squared_p(gain, columns.len() - own.len()) < alpha && each.is_ahead_of(&all) {
                return Some(each);
            }
        }
        Some(all)
    });
    each.collect()
}

/// Where the columns of each candidate stand among those of all.
fn places<'c>(candidates: &'c [&Candidate]) -> impl Iterator<Item = Vec<usize>> + 'c {
    candidates.iter().scan(0, |from, c| {
        let own = *from..*from + c.columns.len();
        *from = own.end;
        Some(own.collect())
    })
}

/// Log-likelihood of what is left of stretches, with their number, by what they have in common: normal by the scatter of each equation, with
/// outliers at the filter's gate.
fn by<'s, 'r: 's, K: Ord>(
    stretches: &'s [Stretch<'r>],
    scatter: &Equations,
    key: impl Fn(&Stretch) -> K,
    left: impl Fn(&Stretch) -> Equations,
) -> BTreeMap<K, (f64, f64)> {
    let mut sums = BTreeMap::new();
    for stretch in stretches {
        let of = |(e, s): (f64, &f64)| -0.5 * (e / s).powi(2).min(GATE * GATE);
        let likelihood: f64 = left(stretch).into_iter().zip(scatter).map(of).sum();
        let sum: &mut (f64, f64) = sums.entry(key(stretch)).or_default();
        *sum = (sum.0 + likelihood, sum.1 + 1.0);
    }
    sums
}

/// The scatter of each equation beside the errors of all sensors.
fn scatter(stretches: &[Stretch]) -> Option<Equations> {
    let all: Vec<usize> = (0..stretches.first()?.columns.len()).collect();
    let first = scatter_of(stretches.iter().map(|s| s.left));
    // Without what the errors explain, and then by what is left without outliers.
    let next = |scatter: Equations| {
        let amplitude = solve(stretches, &all, &scatter, SENSOR_SPREAD.powi(-2))?;
        Some(scatter_of(stretches.iter().map(|s| less(s, &all, &amplitude))))
    };
    next(next(first)?)
}

/// What some columns at these amplitudes leave of a stretch.
fn less(stretch: &Stretch, columns: &[usize], amplitude: &DVector<f64>) -> Equations {
    std::array::from_fn(|q| {
        let explained: f64 = columns.iter().zip(amplitude.iter()).map(|(c, a)| stretch.columns[*c][q] * a).sum();
        stretch.left[q] - explained
    })
}

/// The scatter of each equation: 1.4826 times the median size, that is a standard deviation where it is normal.
fn scatter_of(left: impl Iterator<Item = Equations> + Clone) -> Equations {
    let of = |q: usize| median(left.clone().map(|e| e[q].abs())).unwrap_or(0.0);
    std::array::from_fn(|q| (1.4826 * of(q)).max(f64::MIN_POSITIVE.sqrt()))
}

/// Amplitudes of some columns by least squares over the stretches that are no outliers, with a prior of this precision around zero;
/// `None` where they are no numbers.
fn solve(stretches: &[Stretch], columns: &[usize], scatter: &Equations, precision: f64) -> Option<DVector<f64>> {
    let n = columns.len();
    let mut amplitude = DVector::zeros(n);
    // What lies far from a first solution is left out of the second.
    for round in 0..2 {
        let mut information = DMatrix::from_diagonal_element(n, n, precision);
        let mut g = DVector::zeros(n);
        for s in stretches {
            let left = less(s, columns, &amplitude);
            for q in (0..3).filter(|q| round == 0 || left[*q].abs() < GATE * scatter[*q]) {
                let row = DVector::from_fn(n, |i, _| s.columns[columns[i]][q] / scatter[q]);
                g += &row * (s.left[q] / scatter[q]);
                information += &row * row.transpose();
            }
        }
        let least = f64::EPSILON * f64::max(information.amax(), f64::MIN_POSITIVE);
        amplitude = information.pseudo_inverse(least).ok()? * g;
    }
    amplitude.iter().all(|a| a.is_finite()).then_some(amplitude)
}

/// The stretches of all runs.
fn stretches_of<'r>(model: &Model, runs: &'r [Run], candidates: &[&Candidate]) -> Vec<Stretch<'r>> {
    runs.iter().enumerate().flat_map(|(index, run)| stretches(model, (index, run), candidates)).collect()
}

/// The stretches of a run in which every channel was measured.
fn stretches<'r>(model: &Model, (index, run): (usize, &'r Run), candidates: &[&Candidate]) -> Vec<Stretch<'r>> {
    let states: Vec<Option<[f64; STATES]>> = corrected(model, run);
    let reports = reports(model, run, &states, candidates);
    // By what was recorded, so that the stretches are the same whatever errors the model has.
    let speed = median(run.measured.iter().filter_map(whole).map(|s| s[3].hypot(s[4]))).unwrap_or(0.0);
    let rows = (STRETCH * model.ship.hull.lpp / (speed * run.dt)).round();
    let rows = if rows.is_finite() { (rows as usize).clamp(1, states.len().max(2) - 1) } else { return Vec::new() };
    let starts = (0..states.len().saturating_sub(rows)).step_by(rows);
    let stretch = |from: usize| {
        let span = Span { states: &states, from, to: from + rows, dt: run.dt };
        let left = span.disagreement()?;
        let columns = reports.iter().map(|added| span.slope(added)).collect::<Option<_>>()?;
        let block = (index, from / (rows * STRETCHES));
        Some(Stretch { recording: &run.recording, session: &run.session, block, left, columns })
    };
    starts.filter_map(stretch).collect()
}

/// The measured state, where every channel has a value.
fn whole(measured: &Measured) -> Option<[f64; STATES]> {
    let mut state = [0.0; STATES];
    for (s, m) in state.iter_mut().zip(measured) {
        *s = (*m)?;
    }
    Some(state)
}

/// The states that the sensors of a model report as was measured, where every channel has a value: an error that the model
/// already has is no disagreement. By fixed-point iteration, as the errors are small beside what is measured.
fn corrected(model: &Model, run: &Run) -> Vec<Option<[f64; STATES]>> {
    let dynamics = Dynamics::new(model, model.values_in(&run.session));
    let of = |(measured, input): (&Measured, &Inputs<f64>)| {
        let measured = whole(measured)?;
        let mut state = measured;
        for _ in 0..CORRECTIONS {
            let report = dynamics.report(&state, input);
            if report == measured {
                break;
            }
            (0..STATES).for_each(|j| state[j] += measured[j] - report[j]);
        }
        Some(state)
    };
    run.measured.iter().zip(&run.inputs).map(of).collect()
}

/// What a unit of each column adds to the report of each sample, by central differences at the values that the model has: exact for a report
/// that is quadratic in them.
fn reports(
    model: &Model,
    run: &Run,
    states: &[Option<[f64; STATES]>],
    candidates: &[&Candidate],
) -> Vec<Vec<[f64; STATES]>> {
    let values = model.values_in(&run.session);
    let plain = Dynamics::new(model, values.clone());
    // What moves the ship is the same whatever a sensor reports of it.
    let moving = |(s, input): (&Option<[f64; STATES]>, _)| {
        let state = State::from_array((*s)?);
        let (rates, flow) = plain.rates(&state, input, &Force::zero());
        Some((state, rates, flow))
    };
    let moving: Vec<_> = states.iter().zip(&run.inputs).map(moving).collect();
    let of = |dynamics: &Dynamics<f64>| -> Vec<[f64; STATES]> {
        let report = |(moving, input): (&Option<(State<f64>, _, _)>, _)| {
            moving.as_ref().map_or([0.0; STATES], |(state, rates, flow)| dynamics.measure(state, input, rates, flow))
        };
        moving.iter().zip(&run.inputs).map(report).collect()
    };
    let column = |c: &Column| {
        let [more, less] = [0.5, -0.5].map(|half| {
            let mut with = values.clone();
            with[c.parameter] += half * c.scale;
            of(&Dynamics::new(model, with))
        });
        more.iter().zip(&less).map(|(m, l)| std::array::from_fn(|j| m[j] - l[j])).collect()
    };
    candidates.iter().flat_map(|c| &c.columns).map(column).collect()
}

/// The samples of a run from one to another, every one with every channel, among those around them.
struct Span<'s> {
    states: &'s [Option<[f64; STATES]>],
    from: usize,
    to: usize,
    dt: f64,
}

impl Span<'_> {
    fn state(&self, k: usize) -> Option<[f64; STATES]> {
        *self.states.get(k)?
    }

    /// Recorded way and turn less those that the velocities make, along the heading in the middle.
    fn disagreement(&self) -> Option<Equations> {
        let (first, last) = (self.state(self.from)?, self.state(self.to)?);
        let change = [last[0] - first[0], last[1] - first[1], wrap_angle(last[2] - first[2])];
        let rate = |k: usize| {
            let [_, _, psi, u, v, r] = self.state(k)?;
            Some(over_ground(psi, [u, v, r]))
        };
        let [north, east, turn] = self.less_integral(change, rate)?;
        self.along([north, east, wrap_angle(turn)])
    }

    /// How the disagreement changes with what is added to the reports.
    fn slope(&self, added: &[[f64; STATES]]) -> Option<Equations> {
        let change = std::array::from_fn(|q| added[self.to][q] - added[self.from][q]);
        let rate = |k: usize| {
            let ([_, _, psi, u, v, _], [_, _, turned, du, dv, dr]) = (self.state(k)?, added[k]);
            Some(over_ground(psi, [du - v * turned, dv + u * turned, dr]))
        };
        self.along(self.less_integral(change, rate)?)
    }

    /// A change less the integral of its rate, by the trapezoidal rule with the first term of Euler and Maclaurin: without it long samples
    /// would look like an error of a sensor in every turn.
    fn less_integral(&self, mut change: Equations, rate: impl Fn(usize) -> Option<Equations>) -> Option<Equations> {
        for k in self.from + 1..=self.to {
            for rate in [rate(k - 1)?, rate(k)?] {
                (0..3).for_each(|q| change[q] -= 0.5 * self.dt * rate[q]);
            }
        }
        let ends = [(self.from, 1), (self.to, -1)].map(|(k, inwards)| self.twice_the_slope(k, inwards, &rate));
        let [Some(first), Some(last)] = ends else { return Some(change) };
        (0..3).for_each(|q| change[q] += self.dt / 24.0 * (last[q] - first[q]));
        Some(change)
    }

    /// Twice the slope of a rate at one end, times the sample period: by the samples on both sides, or, where there is none outside, by
    /// the next two; `None` where there are none.
    fn twice_the_slope(
        &self,
        end: usize,
        inwards: isize,
        rate: &impl Fn(usize) -> Option<Equations>,
    ) -> Option<Equations> {
        let at = |steps: isize| rate(end.checked_add_signed(steps * inwards)?);
        let (own, next) = (at(0)?, at(1)?);
        let slope: Equations = if let Some(outside) = at(-1) {
            std::array::from_fn(|q| next[q] - outside[q])
        } else {
            let further = at(2)?;
            std::array::from_fn(|q| 4.0 * next[q] - 3.0 * own[q] - further[q])
        };
        Some(slope.map(|s| s * inwards as f64))
    }

    /// A way on the earth's axes, along the heading in the middle.
    fn along(&self, [north, east, turn]: Equations) -> Option<Equations> {
        let (sin, cos) = self.state((self.from + self.to).div_ceil(2))?[2].sin_cos();
        Some([north * cos + east * sin, east * cos - north * sin, turn])
    }
}

/// Velocities ahead and to starboard on the earth's axes; the yaw rate is the same.
fn over_ground(psi: f64, [ahead, across, turn]: Equations) -> Equations {
    let (sin, cos) = psi.sin_cos();
    [ahead * cos - across * sin, ahead * sin + across * cos, turn]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::evidence::candidate::candidates;
    use crate::diagnose::example::{erring, model, runs, with};
    use crate::diagnose::settings::INDISTINGUISHABLE;

    /// Agreements under a late clock, a lever arm of the positions and a bias of the gyro.
    fn of(runs: &[Run]) -> Vec<Agreement> {
        let model = model();
        let list = candidates(&model, &[]);
        let named = |name: &str| list.iter().find(|c| c.mechanism.name == name).unwrap();
        agreements(&model, runs, &["time_skew", "position_lever", "yaw_rate_bias"].map(named)).unwrap()
    }

    fn value(agreement: &Agreement, place: usize, name: &str) -> f64 {
        let m = model();
        agreement.amplitude[place] * m.parameters[m.find(name).unwrap()].scale
    }

    #[test]
    fn the_error_that_the_sensors_have_is_distinguished_from_its_look_alike_and_its_size_is_found() {
        let late = of(&erring(&[("time_skew.position", -2.0)], 12));
        assert!(
            (value(&late[0], 0, "time_skew.position") + 2.0).abs() < 0.1,
            "{}",
            value(&late[0], 0, "time_skew.position")
        );
        assert!(late[0].over(&late[1]).is_some_and(|[low, _]| low > 0.0), "{:?}", late[0].over(&late[1]));
        let off = of(&erring(&[("position_lever.x", 12.0)], 12));
        assert!((value(&off[1], 0, "position_lever.x") - 12.0).abs() < 0.6);
        assert!(off[1].over(&off[0]).is_some_and(|[low, _]| low > 0.0), "{:?}", off[1].over(&off[0]));
        let biased = of(&erring(&[("yaw_rate_bias.bias", 0.002)], 12));
        assert!((value(&biased[2], 0, "yaw_rate_bias.bias") - 0.002).abs() < 2e-4);
    }

    #[test]
    fn an_error_is_found_at_its_size_and_is_ahead_of_all_others() {
        let m = model();
        let list = candidates(&m, &[]);
        let names = ["time_skew", "log_scale", "yaw_rate_bias", "position_lever"];
        let asked = names.map(|name| list.iter().find(|c| c.mechanism.name == name).unwrap());
        // The log's error as a share of what it reads.
        let errors = [
            ("time_skew.position", -1.5, -1.5, 0.3),
            ("log_scale.error", 0.08, 0.08 / 1.08, 0.004),
            ("yaw_rate_bias.bias", 0.001, 0.001, 2e-4),
            ("position_lever.x", 12.0, 12.0, 1.0),
        ];
        for (i, (name, error, expected, near)) in errors.into_iter().enumerate() {
            let all = disagreements(&m, &erring(&[(name, error)], 12), &asked, 0.01).unwrap();
            let value = all[i].amplitude[0] * asked[i].columns[0].scale;
            assert!((value - expected).abs() < near && all[i].p < 1e-6 && all[i].is_steady, "{name}: {value}");
            assert!((0..4).all(|other| other == i || all[i].is_ahead_of(&all[other])), "{name}");
        }
    }

    #[test]
    fn an_error_gains_all_along_and_sensors_that_agree_do_not() {
        let m = model();
        let list = candidates(&m, &[]);
        let asked = ["yaw_rate_bias", "log_scale"].map(|name| list.iter().find(|c| c.mechanism.name == name).unwrap());
        let is_steady = |runs: &[Run], i: usize| disagreements(&m, runs, &asked, 0.01).unwrap()[i].is_steady;
        assert!(is_steady(&erring(&[("yaw_rate_bias.bias", 0.002)], 12), 0));
        assert!((0..2).all(|i| !is_steady(&erring(&[], 12), i)));
    }

    #[test]
    fn sessions_have_an_error_each_where_they_differ_and_one_where_they_do_not() {
        let m = model();
        let list = candidates(&m, &[]);
        let asked = ["yaw_rate_bias"].map(|name| list.iter().find(|c| c.mechanism.name == name).unwrap());
        let [a, b] = [0.002, -0.001].map(|bias| erring(&[("yaw_rate_bias.bias", bias)], 12));
        let runs: Vec<Run> = a.into_iter().zip(b).map(|(a, b)| if a.session == "a" { a } else { b }).collect();
        let found = &disagreements(&m, &runs, &asked, 0.01).unwrap()[0];
        let unit = asked[0].columns[0].scale;
        assert!(found.sessions == ["a", "b"] && found.is_steady);
        for (value, bias) in found.amplitude.iter().zip([0.002, -0.001]) {
            assert!((value * unit - bias).abs() < 3e-4, "{} for {bias}", value * unit);
        }
        let same = &disagreements(&m, &erring(&[("yaw_rate_bias.bias", 0.002)], 12), &asked, 0.01).unwrap()[0];
        assert!(same.sessions.is_empty() && same.amplitude.len() == 1);
    }

    #[test]
    fn only_what_makes_the_sensors_inconsistent_is_significant() {
        let m = model();
        let list = candidates(&m, &[]);
        let asked =
            ["time_skew", "log_scale", "antenna"].map(|name| list.iter().find(|c| c.mechanism.name == name).unwrap());
        let of = |errors: &[(&str, f64)]| {
            disagreements(&m, &erring(errors, 12), &asked, 0.01).unwrap().iter().map(|d| d.p < 1e-6).collect::<Vec<_>>()
        };
        assert!(of(&[("time_skew.position", -1.5)])[0] && of(&[("log_scale.error", 0.08)])[1]);
        // Positions and velocities of one other point agree with each other, and so do clocks that are late together.
        assert_eq!(of(&[("antenna.x", 20.0)]), [false, false, false]);
        let late = ["position", "heading", "velocity", "yaw_rate"].map(|channel| format!("time_skew.{channel}"));
        assert_eq!(of(&late.each_ref().map(|name| (name.as_str(), 1.5))), [false, false, false]);
        assert_eq!(of(&[]), [false, false, false]);
    }

    #[test]
    fn velocities_that_are_late_are_distinguished_from_late_positions_and_from_a_lever_arm() {
        let m = model();
        let list = candidates(&m, &[]);
        let asked = ["log_skew", "time_skew", "position_lever"]
            .map(|name| list.iter().find(|c| c.mechanism.name == name).unwrap());
        let all = agreements(&m, &erring(&[("time_skew.velocity", 2.0)], 12), &asked).unwrap();
        assert!((value(&all[0], 0, "time_skew.velocity") - 2.0).abs() < 0.2, "{all:?}");
        assert!(all[1..].iter().all(|other| all[0].over(other).is_some_and(|[low, _]| low > 0.0)), "{all:?}");
        let late = agreements(&m, &erring(&[("time_skew.position", -2.0)], 12), &asked).unwrap();
        assert!(late[1].over(&late[0]).is_some_and(|[low, _]| low > 0.0), "{late:?}");
    }

    #[test]
    fn a_change_less_the_integral_of_its_rate_is_of_fourth_order_inside_a_run_and_at_its_ends() {
        // x = sin t along the north axis, and the yaw rate of psi = 0.
        let left = |n: usize, from: usize, to: usize| {
            let dt = 2.0 / n as f64;
            let state = |k: usize| {
                let t = k as f64 * dt;
                Some([t.sin(), 0.0, 0.0, t.cos(), 0.0, 0.0])
            };
            let states: Vec<_> = (0..=n).map(state).collect();
            Span { states: &states, from, to, dt }.disagreement().unwrap()[0].abs()
        };
        for (coarse, fine) in [(left(16, 4, 12), left(32, 8, 24)), (left(16, 0, 16), left(32, 0, 32))] {
            assert!(coarse / fine > 12.0 && coarse < 1e-4, "{coarse:e} {fine:e}");
        }
    }

    #[test]
    fn sensors_that_agree_distinguish_no_error_from_another() {
        let sound = of(&runs(&model(), 12));
        assert!(sound[0].over(&sound[1]).is_some_and(|[low, high]| low < 0.0 && high > 0.0), "{sound:?}");
    }

    #[test]
    fn a_current_or_a_force_is_no_disagreement_and_where_a_channel_is_missing_there_is_no_answer() {
        let calm = of(&runs(&model(), 6));
        let drifting = of(&runs(&with(&[("current.north", 0.5), ("earth_force.east", 2e4)]), 6));
        let size = |a: &Agreement| value(a, 0, "time_skew.position").abs();
        assert!(size(&calm[0]) < 0.2 && size(&drifting[0]) < 0.2);
        let mut blind = runs(&model(), 6);
        blind.iter_mut().flat_map(|r| &mut r.measured).for_each(|m| m[4] = None);
        let model = model();
        let list = candidates(&model, &[]);
        assert!(agreements(&model, &blind, &[&list[0]]).is_none());
    }

    #[test]
    fn what_the_model_already_has_of_its_sensors_is_no_disagreement_and_what_comes_on_top_is() {
        let errors = [("time_skew.yaw_rate", 2.0), ("time_skew.position", -1.5), ("log_scale.error", 0.08)];
        let m = with(&errors);
        let list = candidates(&m, &[]);
        let asked = ["time_skew", "yaw_rate_skew", "log_scale"]
            .map(|name| list.iter().find(|c| c.mechanism.name == name).unwrap());
        let of = |runs: &[Run]| disagreements(&m, runs, &asked, 0.01).unwrap();
        let known = of(&erring(&errors, 12));
        assert!(known.iter().all(|d| d.p > 1e-3), "{:?}", known.iter().map(|d| d.p).collect::<Vec<_>>());
        let more = of(&erring(&[errors[0], ("time_skew.position", -3.0), errors[2]], 12));
        let scale = m.parameters[m.find("time_skew.position").unwrap()].scale;
        // Both have the noise of the same runs.
        let added = (more[0].amplitude[0] - known[0].amplitude[0]) * scale;
        assert!((added + 1.5).abs() < 0.1 && more[0].p < 1e-6 && more[1].p > 1e-3, "{added}");
    }

    #[test]
    fn a_model_with_the_error_of_a_sensor_gains_its_opposite_loses_and_the_ship_has_no_say() {
        let list = candidates(&model(), &[]);
        let runs = erring(&[("yaw_rate_bias.bias", 0.002)], 12);
        let of = |values: &[(&str, f64)]| gain(&model(), &with(values), &runs, &list).unwrap();
        let (right, interval) = of(&[("yaw_rate_bias.bias", 0.002)]);
        assert!(right > 20.0 && interval.is_some_and(|[low, _]| low > 0.0), "{right} {interval:?}");
        let (wrong, interval) = of(&[("yaw_rate_bias.bias", -0.002)]);
        assert!(wrong < -20.0 && interval.is_some_and(|[_, high]| high < 0.0), "{wrong} {interval:?}");
        let m = model();
        let damping = 2.0 * m.parameters[m.find("hull.Nr").unwrap()].value;
        assert_eq!(of(&[("yaw_rate_bias.bias", 0.002), ("hull.Nr", damping)]).0, right);
        // Positions and velocities of one other point agree with each other.
        let (none, _) = gain(&m, &with(&[("antenna.x", 20.0)]), &erring(&[], 12), &list).unwrap();
        assert!(none.abs() < INDISTINGUISHABLE, "{none}");
    }

    #[test]
    fn two_recordings_have_an_agreement_and_no_interval() {
        let few = of(&runs(&model(), 2));
        assert!(few[0].over(&few[1]).is_none());
    }
}
