//! From the columns taken to signals in SI units: each quantity's unit and sign decided with its evidence, positions in metres.
//! Rows are made elsewhere; here each quantity keeps its own times.

use super::agree::{heading, heading_unit};
use super::choose::{Choices, Chosen, Unused};
use super::evidence::{Given, Known, Verdict, direction, other, rotation, rudder, speed, yaw_rate};
use super::names::is_pose;
use crate::numerals::sig;
use crate::recording::Channel;
use crate::recording::import::error::ImportError;
use crate::recording::import::signals::log::{Column, Meaning, needed};
use crate::recording::import::signals::motion::{AGREE, COHERENT, NO_COURSE, Track, ratio};
use crate::recording::import::signals::place::places;
use crate::recording::import::signals::signal::{Signal, Tidied, median};
use crate::recording::import::signals::wind::doubts;
use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;

/// What a column was taken for.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Taken {
    /// The quantity: a channel, or `lat`, `lon`, `cog`, `sog`.
    pub quantity: String,
    /// The column.
    pub column: String,
    /// Its unit.
    pub unit: String,
    /// Why it is taken so.
    pub evidence: String,
    /// Samples.
    pub samples: usize,
    /// Usual step \[s\].
    pub step: f64,
}

/// Signals in SI units by quantity, and the notes on them.
#[derive(Default)]
pub struct Signals {
    /// By quantity; positions as the channels x and y.
    pub by: BTreeMap<Meaning, Signal>,
    /// What each column was taken for.
    pub taken: Vec<Taken>,
    /// Columns that are not used.
    pub unused: Vec<Unused>,
    /// Warnings and what was put in order.
    pub notes: Vec<String>,
    /// Latitude and longitude of the point from which positions count \[deg\].
    pub origin: Option<[f64; 2]>,
    /// Questions that the data do not answer.
    asked: Vec<String>,
}

/// Decides units and signs and makes the signals.
///
/// # Errors
/// [`ImportError::Undecided`] with every question at once, [`ImportError::Choice`] where files contradict each other.
pub fn take(chosen: &Chosen<'_>, choices: &Choices) -> Result<Signals, ImportError> {
    let mut signals = Signals::default();
    let mut known = Known::default();
    let given = |meaning: Meaning| given(meaning, chosen.get(&meaning).map_or(&[], Vec::as_slice), choices);
    signals.positions(chosen, choices)?;
    for channel in [Channel::X, Channel::Y] {
        let meaning = Meaning::Channel(channel);
        if let Some(columns) = chosen.get(&meaning).filter(|_| !signals.by.contains_key(&meaning)) {
            let verdict = other(meaning, columns, given(meaning)?.as_ref());
            signals.put(meaning, columns, verdict);
        }
    }
    let get = |signals: &Signals, channel| signals.by.get(&Meaning::Channel(channel)).cloned();
    known_track(&mut signals, chosen, &mut known);
    if choices.units.keys().all(|k| !["lat", "lon"].contains(&k.as_str()))
        && let Some(axes) = known.track.as_ref().and_then(|track| wrong_axes(track, chosen))
    {
        axes.iter().for_each(|axis| signals.turn_axis(*axis));
        known.track = get(&signals, Channel::X).zip(get(&signals, Channel::Y)).and_then(|(x, y)| Track::of(&x, &y));
    }
    known.variation = signals.variation(chosen, given(Meaning::Variation)?.as_ref(), known.track.as_ref());
    for meaning in [Meaning::Channel(Channel::Psi), Meaning::Course] {
        if let Some(columns) = chosen.get(&meaning) {
            let verdict = direction(meaning, columns, given(meaning)?.as_ref(), &known);
            signals.put(meaning, columns, verdict);
        }
    }
    known.psi = get(&signals, Channel::Psi);
    signals.part_with_no_course(known.track.as_ref());
    signals.speeds(chosen, &known, choices)?;
    let r = Meaning::Channel(Channel::R);
    if let Some(columns) = chosen.get(&r) {
        let verdict = yaw_rate(r, columns, given(r)?.as_ref(), &known);
        signals.put(r, columns, verdict);
    }
    let turning = known.psi.as_ref().map(|psi| psi.rate(psi.span()));
    // A recorded rate with many blanks has few stretches that are long enough for a comparison with a rudder.
    let whole = |r: &Signal| {
        let fitted = r.smooth(r.span()).t.len();
        turning.as_ref().is_none_or(|turning| 2 * fitted > turning.t.len())
    };
    known.r = get(&signals, Channel::R).filter(whole).or(turning.clone());
    if let Some(columns) = chosen.get(&Meaning::WindAngle) {
        let mut verdict = other(Meaning::WindAngle, columns, given(Meaning::WindAngle)?.as_ref());
        if let Ok(verdict) = &mut verdict {
            verdict.evidence += "; an angle from the bow: the direction is heading + angle";
        }
        signals.put(Meaning::WindAngle, columns, verdict);
    }
    for (meaning, columns) in chosen {
        let Meaning::Channel(channel) = *meaning else { continue };
        let verdict = match channel {
            Channel::Delta | Channel::DeltaOrder => rudder(*meaning, columns, given(*meaning)?.as_ref(), &known),
            Channel::N | Channel::NOrder => rotation(*meaning, columns, given(*meaning)?.as_ref(), &known),
            Channel::Command(_) => other(*meaning, columns, given(*meaning)?.as_ref())
                .map(|verdict| by_its_name(verdict, columns, channel)),
            // Decided above, or left out.
            Channel::R => continue,
            _ if signals.by.contains_key(meaning) || signals.is_asked(*meaning) => continue,
            // The unit of the surge velocity is that of both.
            Channel::V if signals.is_asked(Meaning::Channel(Channel::U)) => continue,
            _ => other(*meaning, columns, given(*meaning)?.as_ref()).map(|verdict| referred(verdict, channel)),
        };
        signals.put(*meaning, columns, verdict);
    }
    if !signals.asked.is_empty() {
        return Err(ImportError::Undecided(signals.asked));
    }
    if let Some(track) = &known.track {
        signals.doubt_winds(chosen, track);
    }
    Ok(signals)
}

/// The axes of position that are counted the wrong way, 0 for north and 1 for east: latitude and longitude against which every direction
/// turns, from north or south and not from east or west as a mathematician's angle; or half a turn from which every direction points,
/// which turns both. A heading alone turns against the track where it is itself counted the wrong way, too: its axes are those of the
/// position unless the yaw rate turns against it, or a velocity over ground goes where the track does.
fn wrong_axes(track: &Track, chosen: &Chosen<'_>) -> Option<&'static [usize]> {
    if !chosen.contains_key(&Meaning::Latitude) || !chosen.contains_key(&Meaning::Longitude) {
        return None;
    }
    if !chosen.contains_key(&Meaning::Course) && heading_is_wrong(track, chosen) {
        return None;
    }
    let directions: Vec<&Vec<&Column>> =
        [Meaning::Channel(Channel::Psi), Meaning::Course].iter().filter_map(|m| chosen.get(m)).collect();
    let against = |columns: &&Vec<&Column>| -> Option<&'static [usize]> {
        let signal = heading(columns, Some(track));
        let [right, off] = track.agreement(&signal, 1.0)?;
        let quarters = |angle: f64| (angle / FRAC_PI_2).round().rem_euclid(4.0);
        if let Some(turned) = track.anticlockwise(&signal) {
            match quarters(turned) {
                0.0 => Some(&[1]),
                2.0 => Some(&[0]),
                _ => None,
            }
        } else {
            (right > AGREE && quarters(off) == 2.0).then_some(&[0, 1])
        }
    };
    let axes: Vec<&'static [usize]> = directions.iter().map(against).collect::<Option<_>>()?;
    axes.first().copied().filter(|first| axes.iter().all(|axis| axis == first))
}

/// Whether others than the heading say how the ship moved, and the heading contradicts them.
fn heading_is_wrong(track: &Track, chosen: &Chosen<'_>) -> bool {
    let raw = |meaning: Meaning| Some(Signal::new(chosen.get(&meaning)?, 1.0, 0.0, false).0);
    let alike = |a: &Signal, b: &Signal| ratio(&a.pairs(b)).filter(|r| r.coherence > COHERENT).map(|r| r.gain);
    let [north, east] = [Meaning::VelocityNorth, Meaning::VelocityEast].map(raw);
    if let (Some(north), Some(east)) = (north, east) {
        let along = |own: &Signal, other: &Signal| alike(own, other).is_some_and(|gain| gain > 0.0);
        return along(&track.north, &north) && along(&track.east, &east);
    }
    let (Some(psi), Some(r)) = (chosen.get(&Meaning::Channel(Channel::Psi)), raw(Meaning::Channel(Channel::R))) else {
        return false;
    };
    let psi = heading(psi, Some(track));
    let span = psi.span().max(r.span());
    alike(&psi.rate(span), &r.smooth(span)).is_some_and(|gain| gain < 0.0)
}

fn origin_words(origin: [f64; 2]) -> String {
    format!("metres on WGS84 from {} N {} E", origin[0], origin[1])
}

/// The verdict on a direction of wind, current or waves, with what it counts from.
fn referred(mut verdict: Verdict, channel: Channel) -> Verdict {
    let from = match channel {
        Channel::ApparentWindDirection => "; an angle from the bow",
        Channel::WindDirection | Channel::CurrentDirection | Channel::WaveDirection => "; from north",
        _ => "",
    };
    verdict.evidence += from;
    verdict
}

/// The verdict on a channel of an actuator, with the range of its values: no sign is decided, for a fit finds that of its gain.
fn by_its_name(mut verdict: Verdict, columns: &[&Column], channel: Channel) -> Verdict {
    let values = || columns.iter().flat_map(|c| &c.v).copied();
    let (low, high) = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
    let range = format!("{}, values from {} to {}", channel.info().words, sig(low, 3), sig(high, 3));
    verdict.evidence = if verdict.evidence.is_empty() { range } else { format!("{range}; {}", verdict.evidence) };
    verdict
}

/// The unit that the user or the files give.
fn given(meaning: Meaning, columns: &[&Column], choices: &Choices) -> Result<Option<Given>, ImportError> {
    let quantity = meaning.quantity();
    if let Some(unit) = choices.units.get(meaning.name()) {
        return Ok(quantity.factor(unit).map(|factor| Given { unit: unit.clone(), factor, by_user: true }));
    }
    let mut units: Vec<&String> = columns.iter().filter_map(|c| c.unit.as_ref()).collect();
    units.dedup();
    if let [first, second, ..] = units.as_slice() {
        let name = columns.first().map_or("", |c| c.name.as_str());
        return Err(ImportError::Choice(format!(
            "column `{name}` is in {first} in one file and in {second} in another; import them apart, or rename one of the columns"
        )));
    }
    let unit = units.first().map(|u| (*u).clone());
    Ok(unit.and_then(|unit| quantity.factor(&unit).map(|factor| Given { unit, factor, by_user: false })))
}

/// The track of the positions that were taken, whether its axes may be exchanged, and the sway velocity that would show it.
fn known_track(signals: &mut Signals, chosen: &Chosen<'_>, known: &mut Known) {
    let get = |channel| signals.by.get(&Meaning::Channel(channel));
    let Some((x, y)) = get(Channel::X).zip(get(Channel::Y)) else { return };
    let called = |is: fn(&str) -> bool| {
        let columns = chosen.get(&Meaning::Channel(Channel::X));
        signals.origin.is_none() && columns.is_some_and(|c| c.iter().any(|c| is(&c.name)))
    };
    let of_pose = called(is_pose);
    known.axes_untold = signals.origin.is_none() && !of_pose && !called(is_north);
    if known.axes_untold && are_degrees(x, y) {
        signals.asked.push(in_degrees(chosen));
        return;
    }
    known.track = Track::of(x, y);
    let sway = chosen.get(&Meaning::Channel(Channel::V));
    known.sway = sway.map(|columns| Signal::new(columns, 1.0, 0.0, false).0);
    if of_pose {
        signals.notes.push(POSE.to_owned());
    }
}

/// No craft's track is this slow over a whole log \[m/s\]; in degrees the fastest is slower.
const CRAWLS: f64 = 1e-3;

/// Whether two axes of position, taken as metres, must be degrees: numbers that these have, of a track that a ship would take days for.
fn are_degrees(x: &Signal, y: &Signal) -> bool {
    let within = |s: &Signal| s.v.iter().all(|v| v.abs() <= 180.0) && s.v.iter().any(|v| v.abs() > 1.0);
    let both: Vec<(f64, f64, f64)> = x.t.iter().zip(&x.v).zip(&y.v).map(|((t, x), y)| (*t, *x, *y)).collect();
    // What lies between the files of a log is no part of its track.
    let longest = x.longest_step();
    let steps = || both.windows(2).filter(|w| w[1].0 - w[0].0 <= longest);
    let path: f64 = steps().map(|w| (w[1].1 - w[0].1).hypot(w[1].2 - w[0].2)).sum();
    let time: f64 = steps().map(|w| w[1].0 - w[0].0).sum();
    x.t == y.t && (within(x) || within(y)) && path > 0.0 && path < CRAWLS * time
}

/// The question for positions that must be degrees: X is the longitude, as programs for maps write it.
fn in_degrees(chosen: &Chosen<'_>) -> String {
    let name = |channel: Channel| {
        chosen.get(&Meaning::Channel(channel)).and_then(|c| c.first()).map_or("NAME", |c| c.name.as_str())
    };
    let (x, y) = (name(Channel::X), name(Channel::Y));
    format!(
        "whether columns `{x}` and `{y}` are longitude and latitude: as metres they move less than a millimetre a second; pass `--column lon={x} --column lat={y}`, as programs for maps write them, or the other way round"
    )
}

/// What a pose of ROS is taken for.
const POSE: &str = "the position of a pose counts x to the east and y to the north, as ROS has it (REP 103); `--column x=NAME --column y=NAME` \
                    says which column is north (x) and which is east (y), if it does not";

/// Whether a position is called north by its name.
fn is_north(name: &str) -> bool {
    name == "N" || name.to_lowercase().contains("north")
}

impl Signals {
    fn is_asked(&self, meaning: Meaning) -> bool {
        self.asked.iter().any(|a| a.contains(&format!("--unit {}=", meaning.name())))
    }

    /// Takes columns as the verdict says, or keeps the question.
    fn put(&mut self, meaning: Meaning, columns: &[&Column], verdict: Result<Verdict, String>) {
        let name = columns.first().map_or("", |c| c.name.as_str());
        match verdict {
            Ok(verdict) => {
                if let Some(doubt) = &verdict.doubt {
                    self.notes.push(format!("{name}: {doubt}"));
                }
                let (signal, tidied) = Signal::new(columns, verdict.factor, verdict.offset, meaning.wraps());
                self.list(meaning, columns, &signal, tidied, &verdict.unit, verdict.evidence);
                self.by.insert(meaning, signal);
            }
            Err(question) if needed(meaning) => {
                // Two parts of one speed share the question.
                if !self.asked.contains(&question) {
                    self.asked.push(question);
                }
            }
            Err(question) => {
                if meaning == Meaning::Channel(Channel::R) {
                    let text = "its unit is not known, and it is left out: the yaw rate is that of the heading";
                    self.notes.push(format!("{name}: {text}; `--unit r=deg/min` or another takes it"));
                }
                self.unused.push(Unused { column: name.to_owned(), why: question });
            }
        }
    }

    fn list(
        &mut self,
        meaning: Meaning,
        columns: &[&Column],
        signal: &Signal,
        tidied: Tidied,
        unit: &str,
        evidence: String,
    ) {
        let name = columns.first().map_or("", |c| c.name.as_str());
        for (count, what) in [
            (tidied.out_of_order, "come before an earlier one and are sorted"),
            (tidied.repeated, "have the time of another and are left out"),
        ] {
            if count > 0 {
                self.notes.push(format!("{name}: {count} samples {what}"));
            }
        }
        self.taken.push(Taken {
            quantity: meaning.name().to_owned(),
            column: name.to_owned(),
            unit: unit.to_owned(),
            evidence,
            samples: signal.t.len(),
            step: signal.step,
        });
    }

    /// Latitude and longitude as metres.
    fn positions(&mut self, chosen: &Chosen<'_>, choices: &Choices) -> Result<(), ImportError> {
        let (Some(lat), Some(lon)) = (chosen.get(&Meaning::Latitude), chosen.get(&Meaning::Longitude)) else {
            return Ok(());
        };
        let units = [given(Meaning::Latitude, lat, choices)?, given(Meaning::Longitude, lon, choices)?];
        let Some(places) = places(lat, lon, units.map(|unit| unit.map(|u| u.factor)))? else { return Ok(()) };
        if places.nowhere > 0 {
            let text = "positions are 0 N 0 E, which receivers write without a fix; taken as missing";
            self.notes.push(format!("{} {text}", places.nowhere));
        }
        let why = origin_words(places.origin);
        let [recorded_lat, recorded_lon] = &places.recorded;
        self.list(Meaning::Latitude, lat, recorded_lat, places.tidied, places.form, why.clone());
        self.list(Meaning::Longitude, lon, recorded_lon, Tidied::default(), places.form, why);
        self.by.insert(Meaning::Channel(Channel::X), places.x);
        self.by.insert(Meaning::Channel(Channel::Y), places.y);
        self.origin = Some(places.origin);
        Ok(())
    }

    /// Counts an axis of position the other way, and reports that first.
    fn turn_axis(&mut self, axis: usize) {
        let (channel, meaning) = [(Channel::X, Meaning::Latitude), (Channel::Y, Meaning::Longitude)][axis];
        if let Some(signal) = self.by.get_mut(&Meaning::Channel(channel)) {
            signal.v.iter_mut().for_each(|v| *v = -*v);
        }
        if let Some(origin) = &mut self.origin {
            origin[axis] = -origin[axis];
        }
        let from = self.origin.map_or_else(String::new, origin_words);
        let side = ["south", "west"][axis];
        let words =
            format!("counted positive to the {side}, turned: heading and course turn against the track otherwise");
        for taken in &mut self.taken {
            let turned = if taken.quantity == meaning.name() { format!("{words}; ") } else { String::new() };
            taken.evidence = turned + &from;
        }
        let name = meaning.name();
        let text =
            format!("WARNING: the {} is {words}; if it is right as it is, pass `--unit {name}=deg`", meaning.words());
        self.notes.insert(0, text);
    }

    /// The magnetic variation \[rad\] and its column.
    fn variation(
        &mut self,
        chosen: &Chosen<'_>,
        given: Option<&Given>,
        track: Option<&Track>,
    ) -> Option<(f64, String)> {
        let columns = chosen.get(&Meaning::Variation)?;
        let verdict = other(Meaning::Variation, columns, given);
        // Where no unit is given, that of the heading which it corrects: a variation of a few degrees is small in either.
        let corrected = chosen.get(&Meaning::Channel(Channel::Psi)).map(|psi| heading_unit(psi, track));
        let (factor, unit) = match (&verdict, corrected) {
            (Ok(verdict), _) => (verdict.factor, verdict.unit.as_str()),
            (Err(_), Some(1.0)) => (1.0, "rad"),
            (Err(_), _) => (1f64.to_radians(), "deg"),
        };
        let (signal, tidied) = Signal::new(columns, factor, 0.0, true);
        let name = columns.first().map_or("", |c| c.name.as_str());
        self.list(Meaning::Variation, columns, &signal, tidied, unit, "positive to the east".to_owned());
        median(signal.v).map(|v| (v, name.to_owned()))
    }

    /// Reports first what the track says against the winds.
    fn doubt_winds(&mut self, chosen: &Chosen<'_>, track: &Track) {
        let named = |meaning: Meaning| {
            let columns = chosen.get(&meaning).and_then(|c| c.first());
            columns.map_or_else(|| meaning.name().to_owned(), |c| c.name.clone())
        };
        let doubts = doubts(&self.by, track, &named);
        self.notes.splice(0..0, doubts);
    }

    /// Leaves out a course over ground that is none: that of a receiver is the track's own direction, so that no heading is nearer to it.
    fn part_with_no_course(&mut self, track: Option<&Track>) {
        let off = |meaning: Meaning| {
            let [length, angle] = track?.agreement(self.by.get(&meaning)?, 1.0)?;
            Some(1.0 - length * angle.cos())
        };
        let (course, heading) = (off(Meaning::Course), off(Meaning::Channel(Channel::Psi)));
        if let Some(course) = course.filter(|c| *c > NO_COURSE && heading.is_none_or(|h| *c > 2.0 * h)) {
            self.by.remove(&Meaning::Course);
            let of_course = |taken: &Taken| taken.quantity == Meaning::Course.name();
            let why = format!(
                "it is no course over ground: {} deg off the direction of the track (root mean square), a set course perhaps",
                sig((2.0 * course).sqrt().to_degrees(), 2)
            );
            for taken in self.taken.iter().filter(|t| of_course(t)) {
                self.unused.push(Unused { column: taken.column.clone(), why: why.clone() });
            }
            self.taken.retain(|taken| !of_course(taken));
        }
    }

    /// Speeds: over ground alone or in parts, and through water.
    fn speeds(&mut self, chosen: &Chosen<'_>, known: &Known, choices: &Choices) -> Result<(), ImportError> {
        let pairs = [
            [Meaning::GroundSpeed, Meaning::GroundSpeed],
            [Meaning::VelocityNorth, Meaning::VelocityEast],
            [Meaning::Channel(Channel::U), Meaning::Channel(Channel::V)],
            [Meaning::Channel(Channel::UWater), Meaning::Channel(Channel::VWater)],
        ];
        for [first, second] in pairs {
            let mut parts: Vec<(Meaning, &Vec<&Column>)> =
                [first, second].iter().filter_map(|m| Some((*m, chosen.get(m)?))).collect();
            parts.dedup_by_key(|(meaning, _)| *meaning);
            let Some((meaning, columns)) = parts.first() else { continue };
            let raw: Vec<Signal> = parts.iter().map(|(_, c)| Signal::new(c, 1.0, 0.0, false).0).collect();
            let mut size = raw[0].clone();
            if let Some(other) = raw.get(1) {
                let step = size.step;
                size.v = size.t.iter().zip(&size.v).map(|(t, v)| v.hypot(other.at(*t, step))).collect();
            }
            size.v.iter_mut().for_each(|v| *v = v.abs());
            let name = columns.first().map_or("", |c| c.name.as_str());
            // The second part alone, a sway velocity, is not the speed of the ship: the track says nothing of its unit.
            let nothing = Known::default();
            let known = if parts.len() == 1 && *meaning != first { &nothing } else { known };
            let verdict = speed(*meaning, name, &size, given(*meaning, columns, choices)?.as_ref(), known);
            for (meaning, columns) in parts {
                self.put(meaning, columns, verdict.clone());
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pause_between_two_files_does_not_make_metres_degrees() {
        let signal = |speed: f64| {
            let t: Vec<f64> = (0..200).map(|k| f64::from(k) + if k < 100 { 0.0 } else { 1e6 }).collect();
            Signal { v: (0..200).map(|k| 20.0 + speed * f64::from(k % 100)).collect(), t, step: 1.0, jitter: 0.0 }
        };
        assert!(!are_degrees(&signal(0.8), &signal(0.1)));
        assert!(are_degrees(&signal(5e-5), &signal(1e-5)));
    }
}
