//! The ship, the channels that were recorded, their sampling and clocks, and what the audit doubts of them.
//! The doubts are the audit's; nothing is judged here.

use super::claim::{Span, span};
use crate::recording::Run;
use crate::recording::audit::{Issue, Severity, StudyAudit};
use crate::ship::Ship;
use serde::Serialize;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// A particular of the ship.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Particular {
    /// What it is, in words.
    pub name: &'static str,
    /// Value.
    pub value: f64,
    /// SI unit; `-` for none.
    pub unit: &'static str,
}

/// A channel over all recordings.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChannelUse {
    /// Name.
    pub channel: &'static str,
    /// Its SI unit.
    pub unit: &'static str,
    /// The units in the files.
    pub recorded_in: Vec<String>,
    /// Recordings that have it.
    pub recordings: usize,
    /// Recordings in which it is derived from other channels.
    pub derived: usize,
    /// Rows without a value.
    pub missing: usize,
    /// Smallest value.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub min: Option<f64>,
    /// Largest value.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max: Option<f64>,
}

/// A kind of doubt of the audit, with the number of recordings.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RecordedDoubt {
    /// How grave.
    pub severity: Severity,
    /// Name of the fault.
    pub fault: &'static str,
    /// Recordings in which it was found; 0 for the study as a whole.
    pub recordings: usize,
    /// The first of them in words.
    pub text: String,
}

/// How the recordings are sampled.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Recorded {
    /// Recordings.
    pub recordings: usize,
    /// Rows with a time.
    pub rows: usize,
    /// Sum of the durations \[s\].
    pub duration: f64,
    /// Sessions.
    pub sessions: usize,
    /// Runs or windows that are used to train and to test.
    pub windows: [usize; 2],
    /// How the split was made, in words.
    pub split: String,
    /// Sample periods and clocks: the step of the recordings, and the lags of their sensors against one another.
    pub clocks: Vec<Span>,
}

/// Ship, sensors and clocks.
#[derive(Clone, Debug, Serialize)]
pub struct ShipPart {
    /// Name of the ship.
    pub name: String,
    /// Where the particulars are from, as the ship file says.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub source: String,
    /// The particulars.
    pub particulars: Vec<Particular>,
    /// Sampling and clocks.
    pub recorded: Recorded,
    /// The channels.
    pub channels: Vec<ChannelUse>,
    /// Noise of the sensors as the diagnosis estimates it: position, heading, speed, yaw rate; absent without a diagnosis.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub noise: Option<Value>,
    /// Warnings and errors of the audit.
    pub doubts: Vec<RecordedDoubt>,
}

impl ShipPart {
    /// The part of a study whose recordings were audited.
    pub(super) fn new(ship: &Ship, audit: &StudyAudit, runs: &[Run], noise: Option<Value>) -> Self {
        Self {
            name: ship.name.clone(),
            source: ship.source.clone(),
            particulars: particulars(ship),
            recorded: recorded(audit, runs),
            channels: channels(audit),
            noise,
            doubts: doubts(audit),
        }
    }
}

fn particulars(ship: &Ship) -> Vec<Particular> {
    let (hull, screw, rudder) = (&ship.hull, &ship.propeller, &ship.rudder);
    [
        ("length between perpendiculars L", hull.lpp, "m"),
        ("breadth B", hull.breadth, "m"),
        ("draught d", hull.draught, "m"),
        ("mass m", hull.mass, "kg"),
        ("block coefficient C_b", hull.block_coefficient, "-"),
        ("centre of gravity x_G, forward of midship", hull.x_g, "m"),
        ("radius of gyration in yaw over L", hull.gyration, "-"),
        ("density of water", hull.water_density, "kg/m3"),
        ("propeller diameter D", screw.diameter, "m"),
        ("rudder area", rudder.area, "m2"),
    ]
    .map(|(name, value, unit)| Particular { name, value, unit })
    .to_vec()
}

fn recorded(audit: &StudyAudit, runs: &[Run]) -> Recorded {
    let sessions: BTreeSet<&str> = runs.iter().map(|r| r.session.as_str()).collect();
    let lags = |f: fn(&crate::recording::audit::Kinematics) -> Option<f64>| -> Vec<f64> {
        audit.recordings.iter().filter_map(|a| f(a.kinematics.as_ref()?)).collect()
    };
    let steps: Vec<f64> = audit.recordings.iter().map(|a| a.step).collect();
    let clocks = [
        span("step of the recordings", "s", &steps),
        span("yaw rate late on heading", "s", &lags(|k| k.yaw_rate_lag)),
        span("velocity late on position", "s", &lags(|k| k.velocity_lag)),
    ];
    Recorded {
        recordings: audit.recordings.len(),
        rows: audit.recordings.iter().map(|a| a.rows).sum(),
        duration: audit.recordings.iter().map(|a| a.duration).sum(),
        sessions: sessions.len(),
        windows: [audit.train_windows, audit.test_windows],
        split: audit.split.clone(),
        clocks: clocks.into_iter().flatten().collect(),
    }
}

fn channels(audit: &StudyAudit) -> Vec<ChannelUse> {
    let mut all: Vec<ChannelUse> = Vec::new();
    for c in audit.recordings.iter().flat_map(|a| &a.channels) {
        let name = c.channel.name();
        let place = all.iter().position(|u| u.channel == name).unwrap_or_else(|| {
            let (recorded_in, min, max) = (Vec::new(), None, None);
            all.push(ChannelUse {
                channel: name,
                unit: c.unit,
                recorded_in,
                recordings: 0,
                derived: 0,
                missing: 0,
                min,
                max,
            });
            all.len() - 1
        });
        let u = &mut all[place];
        if !c.derived && !u.recorded_in.contains(&c.recorded_in) {
            u.recorded_in.push(c.recorded_in.clone());
        }
        u.recordings += 1;
        u.derived += usize::from(c.derived);
        u.missing += c.missing;
        u.min = [u.min, c.min].into_iter().flatten().reduce(f64::min);
        u.max = [u.max, c.max].into_iter().flatten().reduce(f64::max);
    }
    all
}

/// The warnings and errors of an audit, each kind once, the gravest first.
fn doubts(audit: &StudyAudit) -> Vec<RecordedDoubt> {
    let mut kinds: BTreeMap<(std::cmp::Reverse<Severity>, &'static str), (BTreeSet<&str>, &Issue)> = BTreeMap::new();
    let own = audit.issues.iter().map(|i| (None, i));
    let all = own.chain(audit.recordings.iter().flat_map(|a| a.issues.iter().map(|i| (Some(a.run.as_str()), i))));
    for (run, issue) in all.filter(|(_, i)| i.severity > Severity::Note) {
        let kind = kinds.entry((std::cmp::Reverse(issue.severity), issue.fault)).or_insert((BTreeSet::new(), issue));
        kind.0.extend(run);
    }
    let doubt = |((severity, fault), (runs, issue)): (_, (BTreeSet<&str>, &Issue))| {
        let std::cmp::Reverse(severity) = severity;
        RecordedDoubt { severity, fault, recordings: runs.len(), text: issue.text.clone() }
    };
    kinds.into_iter().map(doubt).collect()
}
