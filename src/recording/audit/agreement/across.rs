//! What only a comparison of runs shows: clocks that differ, one run in another unit, the same data on both sides of the split.
//! The evidence of each run is gathered where the run is audited; no recording is read here.

use super::propeller::{advance, advance_ratio, is_unpowered, keeps_speed, sails_on, unpowered};
use super::reckoning::{Reckoned, reckoned};
use super::scales::scales;
use super::scatter::{Scatter, scatters};
use super::signs::Effect;
use super::stuck::stuck;
use crate::numerals::sig;
use crate::recording::audit::issue::{Issue, Severity, Shared};
use crate::recording::audit::limits::{
    COPY_ANGLE, COPY_OWNERS, COPY_SHARE, COPY_SPEED, EXPLAINS, LAG_EVIDENCE, LAG_LEAVES, LAG_SHARE, LAG_STEPS,
    LEVER_LAG, POOLED_EVIDENCE, SAME_LAG, SESSION_SHARE, SHARED_ROWS, SHARED_SHARE,
};
use crate::recording::audit::motion::plateau::Plateau;
use crate::recording::audit::motion::pooled::{Odd, actuated, odd, shares_at_best};
use crate::recording::audit::motion::response::Curve;
use crate::recording::audit::motion::series::mean_square;
use crate::recording::audit::motion::sources::Sources;
use crate::recording::audit::record::Responses;
use crate::recording::audit::values::gear::{Fastest, leaps as gear_leaps};
use crate::recording::audit::values::held::{Repeats, held, repeats};
use crate::recording::audit::values::length::{Length, shorter};
use crate::recording::audit::values::orders::{Leap, ordered};
use crate::recording::{Channel, Recording, Split};
use crate::ship::Ship;
use crate::ship::units::GRAVITY;
use crate::study::Listed;
use serde::{Deserialize, Serialize};
use std::collections::hash_map::Entry;
use std::collections::{BTreeMap, HashMap};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::PathBuf;

/// Channels that dead reckoning compares.
const TRACK: [Channel; 6] = [Channel::X, Channel::Y, Channel::Psi, Channel::U, Channel::V, Channel::R];

/// The quantities of a run that are compared with those of other runs.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Evidence {
    run: String,
    /// The file from which it is cut, and the column map by which it is read.
    source: (PathBuf, Option<PathBuf>),
    session: String,
    split: Split,
    /// Root mean square speed \[m/s\]; 0 where none was recorded.
    speed: f64,
    /// Median advance ratio.
    ratio: Option<f64>,
    responses: Responses,
    /// Channels of the wrong sign.
    turned: Vec<Channel>,
    /// Channels that are too small for their unit.
    small: Vec<Channel>,
    /// Channels with damaged single values, from which no lag is estimated.
    damaged: Vec<Channel>,
    /// Whether its positions are those of another point than its velocities, which reads as a late or early clock.
    levered: bool,
    /// Channels of the motion that were not recorded, and not derived, and what to do.
    lacks: Vec<(Channel, String)>,
    /// Whether the audit of the run alone already reports a fault of its track, so that dead reckoning adds nothing.
    track_told: bool,
    /// Whether its propeller never turns though it sails.
    unpowered: bool,
    /// Whether it keeps its speed over several lengths.
    keeps_speed: bool,
    /// The largest leap of the rudder.
    leap: Option<Leap>,
    /// The fastest change of the rudder.
    fastest: Option<Fastest>,
    /// How its velocities scatter.
    scatter: Scatter,
    /// What its channels repeat.
    repeats: Vec<Repeats>,
    /// Its length, if the study uses all of it.
    length: Option<Length>,
    /// Fingerprints of the rows in which the ship's motion changed.
    rows: Vec<u64>,
    /// Fingerprints of its rounded values, with the row of each.
    rounded: Vec<(usize, u64)>,
}

impl Evidence {
    /// The evidence of a run, from the part of its recording that the study uses.
    pub(in crate::recording::audit) fn of(
        run: &Listed,
        recording: &Recording,
        ship: &Ship,
        responses: Responses,
        issues: &[Issue],
    ) -> Self {
        let of_fault = |fault| issues.iter().filter(|i| i.fault == fault).filter_map(|i| i.channel).collect();
        Self {
            run: run.labels.run.clone(),
            source: (run.file.clone(), run.column_map.clone()),
            session: run.labels.session.clone(),
            split: run.labels.split,
            speed: recording.get(Channel::U).and_then(mean_square).unwrap_or(0.0).sqrt(),
            ratio: advance_ratio(recording, ship),
            responses,
            turned: of_fault("sign_error"),
            small: of_fault("unit_error"),
            damaged: of_fault("outlier"),
            levered: issues.iter().any(|i| i.fault == "lever"),
            lacks: issues
                .iter()
                .filter(|i| i.fault == "not_recorded")
                .filter_map(|i| Some((i.channel?, i.next_step.clone())))
                .collect(),
            track_told: issues.iter().any(|i| {
                i.severity > Severity::Note && i.fault != "lever" && i.channel.is_some_and(|c| TRACK.contains(&c))
            }),
            unpowered: is_unpowered(recording, ship),
            keeps_speed: keeps_speed(recording, ship),
            leap: Leap::of(recording),
            fastest: Fastest::of(recording, Channel::Delta),
            scatter: Scatter::of(recording),
            repeats: repeats(recording),
            length: Length::of(recording).filter(|_| run.from.is_none() && run.to.is_none()),
            rows: fingerprints(recording),
            rounded: rounded(recording, ship),
        }
    }

    /// Name of the run.
    pub(super) fn name(&self) -> &str {
        &self.run
    }

    /// How the motion answers.
    pub(super) fn responses(&self) -> &Responses {
        &self.responses
    }

    /// Whether the run by itself shows this fault of a channel.
    pub(super) fn shows(&self, fault: &str, channel: Channel) -> bool {
        match fault {
            "sign_error" => self.turned.contains(&channel),
            "unit_error" => self.small.contains(&channel),
            _ => false,
        }
    }
}

/// A number for every row whose motion differs from the row before: of heading, velocities and actuators to the last bit, wherever
/// the position is counted from and whatever the clock says.
fn fingerprints(recording: &Recording) -> Vec<u64> {
    const SEEN: [Channel; 6] = [Channel::Psi, Channel::U, Channel::V, Channel::R, Channel::N, Channel::Delta];
    let columns: Vec<&[f64]> = SEEN.iter().filter_map(|c| recording.get(*c)).collect();
    let moving =
        |row: usize| columns.iter().any(|c| c[row] != c[row - 1]) && columns.iter().all(|c| c[row].is_finite());
    let number = |row: usize| {
        let mut hasher = DefaultHasher::new();
        columns.iter().for_each(|c| c[row].to_bits().hash(&mut hasher));
        hasher.finish()
    };
    if columns.len() < 4 { Vec::new() } else { (1..recording.len()).filter(|row| moving(*row)).map(number).collect() }
}

/// As [`fingerprints`], with every value as a multiple of what rounding in a log may change: two recordings of one motion agree in most of
/// these, though one has fewer digits, and two of which the motion is only alike do not, as a ship's motion and the noise differ by more.
fn rounded(recording: &Recording, ship: &Ship) -> Vec<(usize, u64)> {
    let (speed, time) = ((GRAVITY * ship.hull.lpp).sqrt(), (ship.hull.lpp / GRAVITY).sqrt());
    let units = [
        (Channel::Psi, COPY_ANGLE),
        (Channel::U, COPY_SPEED * speed),
        (Channel::V, COPY_SPEED * speed),
        (Channel::R, COPY_SPEED / time),
        (Channel::Delta, COPY_ANGLE),
    ];
    let columns: Vec<(&[f64], f64)> = units.iter().filter_map(|(c, unit)| Some((recording.get(*c)?, *unit))).collect();
    if columns.len() < 4 {
        return Vec::new();
    }
    let row = |i: usize| columns.iter().map(|(v, unit)| (v[i] / unit).round() as i64).collect::<Vec<i64>>();
    let finite = |i: usize| columns.iter().all(|(v, _)| v[i].is_finite());
    let mut before = Vec::new();
    let mut found = Vec::new();
    for i in (0..recording.len()).filter(|i| finite(*i)) {
        let now = row(i);
        if now != before {
            let mut hasher = DefaultHasher::new();
            now.hash(&mut hasher);
            found.push((i, hasher.finish()));
            before = now;
        }
    }
    found
}

/// Everything that a comparison of the runs shows.
pub fn across(runs: &[Evidence], ship: &Ship) -> Vec<Shared> {
    let mut found = Vec::new();
    let sources = Sources::of(runs.iter().map(|r| &r.source));
    let ratios = sources.medians(&runs.iter().map(|r| r.ratio).collect::<Vec<_>>());
    for (run, issue) in runs.iter().zip(advance(&ratios, ship)) {
        found.extend(issue.map(|issue| Shared { runs: vec![run.run.clone()], issue }));
    }
    let sailing: Vec<f64> = runs.iter().map(|r| r.speed * r.speed).filter(|s| *s > 0.0).collect();
    let speed = (sailing.iter().sum::<f64>() / sailing.len().max(1) as f64).sqrt();
    let time = ship.hull.lpp / speed.max(ship.small_speed());
    for pair in &PAIRS {
        found.extend(late(runs, &sources, pair, time));
        found.extend(sessions(runs, pair, time));
    }
    found.extend(lacking(runs));
    let leaps: Vec<Leap> = runs.iter().filter_map(|r| r.leap).collect();
    let every = || runs.iter().map(|r| r.run.clone()).collect::<Vec<_>>();
    if !runs.is_empty() && runs.iter().all(|r| r.unpowered) {
        found.push(Shared { runs: every(), issue: unpowered() });
    } else {
        let keeps = |r: &&Evidence| r.unpowered && r.keeps_speed;
        found.extend(runs.iter().filter(keeps).map(|r| Shared { runs: vec![r.run.clone()], issue: sails_on() }));
    }
    found.extend(ordered(&leaps, time).map(|issue| Shared { runs: every(), issue }));
    let responses: Vec<(&str, &Responses)> = runs.iter().map(|r| (r.run.as_str(), &r.responses)).collect();
    let scattered: Vec<(&str, Scatter)> = runs.iter().map(|r| (r.run.as_str(), r.scatter)).collect();
    let clear = |r: &&Evidence| !r.track_told && !found.iter().any(|f| f.runs == [r.run.as_str()]);
    let tracked: Vec<(&Evidence, &Reckoned)> =
        runs.iter().filter(clear).filter_map(|r| Some((r, r.responses.reckoned.as_ref()?))).collect();
    let tracks: Vec<(&str, &Reckoned)> = tracked.iter().map(|(r, track)| (r.run.as_str(), *track)).collect();
    let apart = reckoned(&tracks, &Sources::of(tracked.iter().map(|(r, _)| &r.source)), ship.hull.lpp);
    for shared in scales(&responses, &sources).into_iter().chain(scatters(&scattered, &sources)).chain(apart) {
        let same = |f: &Shared| f.runs == shared.runs && f.issue.channel == shared.issue.channel;
        if !found.iter().any(same) {
            found.push(shared);
        }
    }
    // A damaged value leaps too.
    let moved = |r: &Evidence| !r.damaged.contains(&Channel::Delta);
    let fastest: Vec<(&str, Option<&Fastest>)> =
        runs.iter().map(|r| (r.run.as_str(), r.fastest.as_ref().filter(|_| moved(r)))).collect();
    found.extend(gear_leaps(&fastest));
    let repeated: Vec<(&str, &[Repeats])> = runs.iter().map(|r| (r.run.as_str(), &r.repeats[..])).collect();
    found.extend(held(&repeated));
    let lengths: Vec<(&str, Option<Length>)> = runs.iter().map(|r| (r.run.as_str(), r.length)).collect();
    found.extend(shorter(&lengths));
    found.extend(shared_rows(runs));
    for copy in copies(runs) {
        let same = |f: &Shared| f.issue.fault == copy.issue.fault && copy.runs.iter().all(|run| f.runs.contains(run));
        if !found.iter().any(same) {
            found.push(copy);
        }
    }
    found
}

/// Channels that a few runs lack and most have: a sum over channels is another quantity for these runs.
fn lacking(runs: &[Evidence]) -> Vec<Shared> {
    let lacks = |run: &Evidence, channel: Channel| run.lacks.iter().any(|(c, _)| *c == channel);
    let few = |channel: Channel| 2 * runs.iter().filter(|r| lacks(r, channel)).count() < runs.len();
    let lack = |run: &Evidence, channel: Channel, next: &str| {
        let text = format!(
            "{} was not recorded, as it was in most runs: cost and cVDM of this run are of fewer channels",
            channel.info().words
        );
        let next = format!("{next}; or leave the run out");
        let issue = Issue::new(Severity::Error, "not_recorded", text, next).of(channel);
        Shared { runs: vec![run.run.clone()], issue }
    };
    let of = |run| move |(channel, next): &(Channel, String)| few(*channel).then(|| lack(run, *channel, next));
    runs.iter().flat_map(|run| run.lacks.iter().filter_map(of(run))).collect()
}

/// A channel and the motion that it is compared with.
struct Pair {
    channel: Channel,
    of: fn(&Responses) -> Option<&Curve>,
    /// Whether the channel acts on the motion, and does not only measure it.
    acts: bool,
    /// The largest lags behind and ahead of the motion, common to all runs, that may have another cause than a clock, as shares of the time
    /// in which the ship sails its length.
    excused: [f64; 2],
    /// The largest share of the squares that a lag common to all runs may leave.
    leaves: f64,
    motion: &'static str,
}

impl Pair {
    /// The response of a run in which no value of the channel is damaged, nor the channel told to be of another point.
    fn curve<'r>(&self, run: &'r Evidence) -> Option<&'r Curve> {
        let levered = self.channel == Channel::X && run.levered;
        (self.of)(&run.responses).filter(|_| !run.damaged.contains(&self.channel) && !levered)
    }
}

/// Rudder and propeller cause the motion, so that only a wrong clock puts them behind it; ahead of it they may be by the lag of steering
/// gear and engines. An antenna off midship reports a position early or late.
///
/// The yaw answers the rudder by way of the sway too, which is recorded with noise, or over ground in a current. What is left of that looks
/// like a rudder that is late by a part of the ship's own lag, whoever steers it by the heading, and explains little: in sound zigzags it
/// leaves 0.75 to 0.85 of the squares; a rudder that is late by a fifth of the time in which the ship sails its length leaves 0.6 or less.
const PAIRS: [Pair; 4] = [
    Pair {
        channel: Channel::Delta,
        of: |r| r.rudder.as_ref(),
        acts: true,
        excused: [SESSION_SHARE, LAG_SHARE],
        leaves: LAG_LEAVES,
        motion: "the yaw of the ship",
    },
    Pair {
        channel: Channel::N,
        of: |r| r.propeller.as_ref(),
        acts: true,
        excused: [SESSION_SHARE, LAG_SHARE],
        leaves: 1.0,
        motion: "the surge of the ship",
    },
    Pair {
        channel: Channel::R,
        of: |r| r.gyro.as_ref(),
        acts: false,
        excused: [SESSION_SHARE; 2],
        leaves: 1.0,
        motion: "the heading",
    },
    Pair {
        channel: Channel::X,
        of: |r| r.receiver.as_ref(),
        acts: false,
        excused: [LEVER_LAG; 2],
        leaves: 1.0,
        motion: "velocity and heading",
    },
];

/// Curves of several runs as one: twice the negative log-likelihood at the lags that all have.
struct Sum {
    step: f64,
    lags: Vec<isize>,
    total: Vec<f64>,
    /// Independent samples that the residuals are worth.
    samples: f64,
}

impl Sum {
    /// Of those with the step of the first; `None` without any.
    fn of<'c>(curves: impl Iterator<Item = &'c Curve> + Clone) -> Option<Self> {
        let step = curves.clone().next()?.step;
        let alike = |c: &&Curve| (c.step / step - 1.0).abs() < 0.01;
        let shortest = curves.clone().filter(alike).map(|c| c.lags.last().copied().unwrap_or(0)).min()?;
        let mut sum: Option<Self> = None;
        for curve in curves.filter(alike) {
            let inside = |lag: &isize| lag.abs() <= shortest;
            let terms = curve.lags.iter().zip(&curve.left).filter(|(lag, _)| inside(lag));
            let terms: Vec<f64> = terms.map(|(_, left)| curve.samples * left.ln()).collect();
            match &mut sum {
                None => {
                    let lags = curve.lags.iter().copied().filter(inside).collect();
                    sum = Some(Self { step, lags, total: terms, samples: curve.samples });
                }
                Some(sum) => {
                    sum.total.iter_mut().zip(terms).for_each(|(total, term)| *total += term);
                    sum.samples += curve.samples;
                }
            }
        }
        sum
    }

    fn best(&self) -> usize {
        (0..self.total.len()).min_by(|i, j| self.total[*i].total_cmp(&self.total[*j])).unwrap_or(0)
    }

    /// Whether a place is at the end of the lags, so that a longer one might be better.
    fn at_end(&self, place: usize) -> bool {
        place == 0 || place + 1 == self.lags.len()
    }

    fn seconds(&self, place: usize) -> f64 {
        self.lags[place] as f64 * self.step
    }

    /// Twice the log-likelihood ratio of one place over another.
    fn evidence(&self, place: usize, over: usize) -> f64 {
        self.total[over] - self.total[place]
    }

    /// Share of the squares at one place that is left at another, the geometric mean over the runs.
    fn share(&self, place: usize, of: usize) -> f64 {
        (-self.evidence(place, of) / self.samples).exp()
    }
}

/// Whether a channel explains the motion at all, at its best lag and with the right sign.
fn evident(curve: &Curve) -> bool {
    let best = curve.best();
    let explained = curve.left[best] <= EXPLAINS * curve.without && curve.effect(best) > LAG_EVIDENCE;
    explained && curve.sign[best] > 0.0
}

/// Channels that are late or early in all runs together, and rudder and propeller in those runs that differ from that; the lag of sensors
/// in single runs is reported by the audit of each run.
fn late(runs: &[Evidence], sources: &Sources, pair: &Pair, time: f64) -> Vec<Shared> {
    let blur = runs.iter().filter_map(|r| pair.curve(r)).map(|c| c.blur).fold(0.0, f64::max);
    let beyond =
        |seconds: f64, share: f64, step: f64| seconds.abs() > (share * time).max(LAG_STEPS[0] * step).max(blur);
    let excused = |seconds: f64| pair.excused[usize::from(seconds < 0.0)];
    // An actuator of the wrong sign, or of a motion of the wrong sign, cannot be distinguished from one that is late by half a period.
    let motion_turned = |r: &Evidence| r.turned.iter().any(|c| [Channel::R, Channel::U].contains(c));
    let sound = |r: &&Evidence| !r.turned.contains(&pair.channel) && !motion_turned(r);
    let of_sound = runs.iter().filter(sound).filter_map(|r| Some((r, pair.curve(r)?)));
    let curves: Vec<(&Evidence, &Curve)> = of_sound.filter(|(_, c)| evident(c)).collect();
    // Where several runs show that the sign is turned, it may be so in the others.
    let turned_in = runs.iter().filter(|r| r.turned.contains(&pair.channel)).count();
    let all = Sum::of(curves.iter().map(|(_, c)| *c)).filter(|_| curves.len() > 1 && turned_in < 2).and_then(|sum| {
        let (best, zero) = (sum.best(), sum.lags.iter().position(|lag| *lag == 0)?);
        let explains = sum.share(best, zero) <= pair.leaves;
        let sure = sum.evidence(best, zero) > LAG_EVIDENCE && explains && !sum.at_end(best);
        let seconds = sum.seconds(best);
        (sure && beyond(seconds, excused(seconds), sum.step)).then_some(seconds)
    });
    let known = |seconds: f64| all.is_some_and(|all| (seconds - all).abs() <= SAME_LAG * all.abs());
    let lag = |curve: &Curve| {
        let (best, zero) = (curve.best(), curve.zero());
        let seconds = curve.seconds(best);
        let better = curve.evidence(best, zero) > LAG_EVIDENCE && curve.left[best] <= LAG_LEAVES * curve.left[zero];
        let inside = best > 0 && best + 1 < curve.lags.len();
        // A single run is reported only where its lag is longer than gear, engines and filters cause.
        let long = beyond(seconds, excused(seconds).max(LAG_SHARE), curve.step);
        (long && better && inside && !known(seconds)).then_some(seconds)
    };
    let among_others: Vec<Option<&Curve>> = runs.iter().map(|r| pair.curve(r)).collect();
    // Only an actuator acts on the motion in the same way in all runs.
    let pool = actuated(&among_others).filter(|_| pair.acts);
    let shares = pool.as_ref().map(|pool| shares_at_best(&among_others, pool));
    // The other runs must not contradict what a run shows by itself, nor must those that are cut from the same recording.
    let agreed = |run: &Evidence, seconds: f64| {
        let Some(place) = runs.iter().position(|r| std::ptr::eq(r, run)) else { return false };
        let losses = |other: usize| {
            let curve: &Curve = among_others[other]?;
            Some([curve.zero(), curve.at(seconds)?].map(|lag| curve.samples * curve.left[lag].ln()))
        };
        let share = shares.as_ref().and_then(|shares| shares[place]);
        share.is_none_or(|share| share <= LAG_LEAVES) && sources.agree(place, losses)
    };
    let own_lag = |(run, curve): &(&Evidence, &Curve)| {
        let issue = lagging(pair, lag(curve).filter(|lag| pair.acts && agreed(run, *lag))?, "", pair.motion);
        Some(Shared { runs: vec![run.run.clone()], issue })
    };
    let step = curves.first().map_or(0.0, |(_, c)| c.step);
    let worth = |seconds: f64| beyond(seconds, SESSION_SHARE, step) && all.is_none();
    let odd_issue = |odd: Odd| match odd {
        Odd::Turned => turned(pair),
        Odd::Late(seconds) => lagging(pair, seconds, "", pair.motion),
        Odd::Unanswered => unanswered(pair),
    };
    let by_others = pool.as_ref().map_or_else(Vec::new, |pool| {
        let odd = odd(&among_others, pool, sources, worth).into_iter().map(|odd| odd.map(odd_issue));
        let stuck = stuck(&among_others, pool).into_iter().map(|plateau| plateau.map(|p| stands_still(pair, p)));
        let of_run = |(run, issue): (&Evidence, Option<Issue>)| {
            Some(Shared { runs: vec![run.run.clone()], issue: issue.filter(|_| !motion_turned(run))? })
        };
        runs.iter().zip(odd).chain(runs.iter().zip(stuck)).filter_map(of_run).collect()
    });
    let together = all.map(|seconds| Shared {
        runs: curves.iter().map(|(run, _)| run.run.clone()).collect(),
        issue: lagging(pair, seconds, "", pair.motion),
    });
    let mut found: Vec<Shared> = together.into_iter().chain(curves.iter().filter_map(own_lag)).collect();
    let also = turned_as_others(runs, pair).into_iter().chain(turned_in_a_session(runs, pair));
    for shared in also.chain(by_others) {
        if !found.iter().any(|f| f.runs == shared.runs) {
            found.push(shared);
        }
    }
    found
}

/// Runs that show an actuator of the wrong sign less clearly than a single run must, where several others show it.
fn turned_as_others(runs: &[Evidence], pair: &Pair) -> Vec<Shared> {
    let known = runs.iter().filter(|r| r.turned.contains(&pair.channel)).count();
    let turns = |run: &&Evidence| {
        let none = !run.turned.iter().any(|c| [pair.channel, Channel::R, Channel::U].contains(c));
        none && pair.curve(run).is_some_and(|curve| {
            let zero = curve.zero();
            curve.side() < -POOLED_EVIDENCE && curve.left[zero] < EXPLAINS * curve.without
        })
    };
    let also = runs.iter().filter(|_| pair.acts && known > 1).filter(turns);
    let text = format!("acts on {} to the other side than it must, as in other runs", pair.motion);
    let next = format!("set `sign = -1` for `{}` in a column map", pair.channel);
    let issue = Issue::new(Severity::Error, "sign_error", text, next).of(pair.channel);
    also.map(|run| Shared { runs: vec![run.run.clone()], issue: issue.clone() }).collect()
}

/// The runs of a session in which an actuator has the wrong sign, where all of them together show it, single ones do not show it with
/// certainty, and none shows that the sign is right.
fn turned_in_a_session(runs: &[Evidence], pair: &Pair) -> Vec<Shared> {
    // The motion itself must be recorded with the right sign.
    let sound = |r: &Evidence| !r.turned.iter().any(|c| [Channel::R, Channel::U].contains(c));
    let mut sessions: BTreeMap<&str, Vec<(&Evidence, &Curve)>> = BTreeMap::new();
    for run in runs.iter().filter(|r| pair.acts && sound(r)) {
        if let Some(curve) = pair.curve(run) {
            sessions.entry(&run.session).or_default().push((run, curve));
        }
    }
    sessions.retain(|_, of| {
        let mut effect = Effect::default();
        of.iter().for_each(|(_, curve)| effect.add(Some(curve)));
        of.len() > 1 && effect.turned() && of.iter().all(|(_, curve)| curve.side() <= POOLED_EVIDENCE)
    });
    let issue_of = |session: &str, (run, _): &(&Evidence, &Curve)| {
        let text = format!(
            "acts on {} to the other side than it must, as the runs of session `{session}` show together",
            pair.motion
        );
        let next = format!("set `sign = -1` for `{}` in a column map of these runs", pair.channel);
        let issue = Issue::new(Severity::Error, "sign_error", text, next).of(pair.channel);
        Shared { runs: vec![run.run.clone()], issue }
    };
    let unreported = |(run, _): &&(&Evidence, &Curve)| !run.turned.contains(&pair.channel);
    sessions.iter().flat_map(|(session, of)| of.iter().filter(unreported).map(|run| issue_of(session, run))).collect()
}

/// The doubt about an actuator of the wrong sign.
fn turned(pair: &Pair) -> Issue {
    let text = format!("acts on {} to the other side than in the other runs", pair.motion);
    let next = format!(
        "is its sign that of the other runs? set `sign = -1` for `{}` in a column map of this run",
        pair.channel
    );
    Issue::new(Severity::Error, "sign_error", text, next).of(pair.channel)
}

/// The doubt about an actuator that the motion does not answer.
fn unanswered(pair: &Pair) -> Issue {
    let text = format!("moves, and {} does not answer it as in the other runs", pair.motion);
    let next = "is it of this run, in its unit and at its time? compare it with the log, or leave the run out";
    Issue::new(Severity::Warning, "unanswered", text, next.to_owned()).of(pair.channel)
}

/// The doubt about an actuator that is stuck.
fn stands_still(pair: &Pair, plateau: &Plateau) -> Issue {
    let text = format!(
        "keeps one value for {} s, and {} there is not what it is with such a value in the other runs",
        sig(plateau.seconds, 3),
        pair.motion
    );
    let next = "did its log stand still, or did something else push the ship (a tug, a hand)? leave the fields blank, so that they count \
                as a dropout, or cut the run there with `from` or `to`";
    Issue::new(Severity::Warning, "frozen", text, next).of(pair.channel).at(plateau.lines)
}

/// The doubt about a lag \[s\]: `whose` begins the text, `than` is what it is compared with.
fn lagging(pair: &Pair, seconds: f64, whose: &str, than: &str) -> Issue {
    let order = if seconds > 0.0 { "behind" } else { "ahead of" };
    let text = format!("{whose}runs about {} s {order} {than}", sig(seconds.abs(), 2));
    let also = if pair.channel == Channel::X { " (and for `y`)" } else { "" };
    let delay = format!("`delay = {}` for `{}`{also} in a column map", sig(seconds, 2), pair.channel);
    let next = if whose.is_empty() && pair.channel == Channel::R {
        // Two measurements of one motion: neither is the cause of the other.
        let other = sig(-seconds, 2);
        format!(
            "{delay} takes it back, if its clock is wrong, and `delay = {other}` for `psi`, if that of the heading is"
        )
    } else if whose.is_empty() {
        format!("{delay} takes it back, if its clock is wrong")
    } else {
        format!("{delay} takes it back; `delay = {{ \"SESSION\" = ... }}` does so in one session")
    };
    Issue::new(Severity::Warning, "clock", text, next).of(pair.channel)
}

/// Twice the log-likelihood ratio of a run for one lag over another; 0 where it does not have both.
fn gain(curve: &Curve, from: isize, to: isize) -> f64 {
    let at = |lag: isize| curve.lags.iter().position(|l| *l == lag);
    at(from).zip(at(to)).map_or(0.0, |(from, to)| curve.evidence(to, from))
}

/// Sessions in which a channel has another lag than in all others.
fn sessions(runs: &[Evidence], pair: &Pair, time: f64) -> Vec<Shared> {
    let mut names: Vec<&str> = Vec::new();
    for run in runs {
        if !names.contains(&run.session.as_str()) {
            names.push(&run.session);
        }
    }
    let curves = |inside: bool, name: &str| {
        let name = name.to_owned();
        let wanted = move |r: &&Evidence| (r.session == name) == inside;
        runs.iter().filter(wanted).filter_map(|r| pair.curve(r)).filter(|c| evident(c)).collect::<Vec<_>>()
    };
    let differing = |name: &&str| {
        let (own, others) = (curves(true, name), curves(false, name));
        // A session of one run needs no comparison: its faults are reported for that run.
        if own.len() < 2 || others.len() < 2 {
            return None;
        }
        let (own, others) = (Sum::of(own.into_iter())?, Sum::of(others.into_iter())?);
        let (best, usual) = (own.best(), others.best());
        let same = own.lags.iter().position(|lag| *lag == others.lags[usual])?;
        let apart = own.seconds(best) - others.seconds(usual);
        let worth = apart.abs() > (SESSION_SHARE * time).max(LAG_STEPS[0] * own.step);
        // The evidence of the strongest run does not count.
        let own_gain = |c: &Curve| gain(c, own.lags[same], own.lags[best]);
        let most = curves(true, name).into_iter().map(own_gain).fold(0.0, f64::max);
        let sure = own.evidence(best, same) - most > LAG_EVIDENCE && !own.at_end(best);
        (worth && sure && (own.step / others.step - 1.0).abs() < 0.01).then_some((name.to_string(), apart))
    };
    let found: Vec<(String, f64)> = names.iter().filter_map(differing).collect();
    // With two sessions each differs from the other: one doubt, of the later one in the list.
    let found = if names.len() == 2 { found.into_iter().skip(1).collect() } else { found };
    let doubt = |(name, seconds): (String, f64)| {
        let than = format!("{}, compared with the other sessions", pair.motion);
        let issue = lagging(pair, seconds, &format!("in session `{name}` it "), &than);
        let runs = runs.iter().filter(|r| r.session == name).map(|r| r.run.clone()).collect();
        Shared { runs, issue }
    };
    found.into_iter().map(doubt).collect()
}

/// Runs that share rows: on both sides of the split they prove nothing, on one side they count twice.
fn shared_rows(runs: &[Evidence]) -> Vec<Shared> {
    let mut owners: HashMap<u64, usize> = HashMap::new();
    let mut found = Vec::new();
    for (i, run) in runs.iter().enumerate() {
        let mut common: BTreeMap<usize, usize> = BTreeMap::new();
        for row in &run.rows {
            match owners.entry(*row) {
                Entry::Occupied(owner) if *owner.get() != i => *common.entry(*owner.get()).or_default() += 1,
                Entry::Occupied(_) => {}
                Entry::Vacant(free) => drop(free.insert(i)),
            }
        }
        for (other, rows) in common {
            let other = &runs[other];
            let shorter = run.rows.len().min(other.rows.len());
            if rows >= SHARED_ROWS && rows as f64 >= SHARED_SHARE * shorter as f64 {
                let issue = sharing(run, other, &format!("share {rows} of {shorter} rows"));
                found.push(Shared { runs: vec![other.run.clone(), run.run.clone()], issue });
            }
        }
    }
    found
}

/// Runs that are copies of one another but for rounding: at one distance of their rows most values agree.
fn copies(runs: &[Evidence]) -> Vec<Shared> {
    let mut owners: HashMap<u64, Vec<(usize, usize)>> = HashMap::new();
    let mut found = Vec::new();
    for (i, run) in runs.iter().enumerate() {
        let mut common: BTreeMap<(usize, isize), usize> = BTreeMap::new();
        for (row, number) in &run.rounded {
            for (other, at) in owners.get(number).into_iter().flatten() {
                *common.entry((*other, *row as isize - *at as isize)).or_default() += 1;
            }
        }
        let mut listed: Vec<usize> = Vec::new();
        for ((other, _), rows) in common {
            let shorter = run.rounded.len().min(runs[other].rounded.len());
            if rows >= SHARED_ROWS && rows as f64 >= COPY_SHARE * shorter as f64 && !listed.contains(&other) {
                listed.push(other);
                let issue = sharing(run, &runs[other], &format!("agree in {rows} of {shorter} rows but for rounding"));
                found.push(Shared { runs: vec![runs[other].run.clone(), run.run.clone()], issue });
            }
        }
        for (row, number) in &run.rounded {
            let owned = owners.entry(*number).or_default();
            // A motion that many rows share identifies none of them.
            if owned.len() < COPY_OWNERS {
                owned.push((i, *row));
            }
        }
    }
    found
}

fn sharing(run: &Evidence, other: &Evidence, rows: &str) -> Issue {
    if run.split == other.split {
        let text = format!("runs {} and {} {rows}: these count twice", other.run, run.run);
        let next = "leave one of them out, or cut them with `from` and `to` so that they do not overlap";
        return Issue::new(Severity::Warning, "shared_data", text, next);
    }
    let (train, test) = if run.split == Split::Train { (run, other) } else { (other, run) };
    let text = format!("run {} to train on and run {} to test on {rows}: the test proves nothing", train.run, test.run);
    let next = "keep both on one side of the split, or cut them with `from` and `to` so that they do not overlap";
    Issue::new(Severity::Error, "shared_data", text, next)
}
