//! How well a column agrees with what is known of the motion: a speed with the track, a direction with the course, a rate with the heading.
//! It ranks the candidates for one quantity, and finds the unit of a direction; other units and signs are decided later, in `evidence`.

use crate::numerals::sig;
use crate::recording::import::signals::log::{Column, Meaning};
use crate::recording::import::signals::motion::{COHERENT, Track, ratio, rudder_effect};
use crate::recording::import::signals::signal::{Signal, size_below};
use crate::recording::{Channel, Quantity};
use std::f64::consts::{FRAC_PI_2, TAU};

/// What is known of the motion while columns are chosen.
#[derive(Default)]
pub struct Sight {
    /// The track.
    pub track: Option<Track>,
    /// The heading \[rad\].
    pub psi: Option<Signal>,
}

/// A speed agrees where the track's is within this share of it: the spread of the speed of a track from fixes of some metres.
const NEAR: f64 = 0.15;
/// t value of a rudder's effect that counts half: twice that from which its sign is determined.
const HALF_T: f64 = 10.0;

impl Sight {
    /// From 0, where a column contradicts the data, to 1; `None` where they do not show it.
    pub fn agreement(&self, meaning: Meaning, columns: &[&Column]) -> Option<f64> {
        match meaning {
            Meaning::Course | Meaning::Channel(Channel::Psi) => self.direction(columns),
            Meaning::GroundSpeed => self.speed(columns),
            Meaning::Channel(Channel::R) => self.rate(columns),
            Meaning::Channel(Channel::Delta) => self.rudder(columns),
            _ => None,
        }
    }

    /// Mean cosine of the angle between the direction and the course: a heading that counts from elsewhere than north is steadily off it.
    /// A direction that is counted anticlockwise may begin at any quarter.
    fn direction(&self, columns: &[&Column]) -> Option<f64> {
        let track = self.track.as_ref()?;
        let signal = heading(columns, Some(track));
        let along = |[length, angle]: [f64; 2]| length * angle.cos().max(0.0);
        let quarter = |[length, angle]: [f64; 2]| length * (angle - (angle / FRAC_PI_2).round() * FRAC_PI_2).cos();
        let clockwise = track.agreement(&signal, 1.0).map(along);
        [clockwise, track.agreement(&signal, -1.0).map(quarter)].into_iter().flatten().reduce(f64::max)
    }

    /// One less the mean square of what the column is off the speed of the track, as a share of it, in the unit that the file states, or in
    /// the nearest where it states none; nought where none is near.
    fn speed(&self, columns: &[&Column]) -> Option<f64> {
        let track = self.track.as_ref()?;
        let mut size = Signal::new(columns, 1.0, 0.0, false).0;
        size.v.iter_mut().for_each(|v| *v = v.abs());
        let pairs: Vec<[f64; 2]> = track.speed.pairs(&size).into_iter().filter(|p| p[0] > 0.3 * track.fast).collect();
        let found = ratio(&pairs)?;
        let stated = columns.iter().find_map(|c| Quantity::Speed.factor(c.unit.as_deref()?));
        let usual = ["m/s", "kn", "km/h"].iter().filter_map(|u| Quantity::Speed.factor(u));
        let off = |factor: f64| (found.gain.abs() / factor).ln().abs();
        let factor = stated.or_else(|| usual.min_by(|a, b| off(*a).total_cmp(&off(*b))))?;
        if off(factor) >= NEAR || found.coherence <= COHERENT {
            return Some(0.0);
        }
        let square = |f: &dyn Fn(&[f64; 2]) -> f64| pairs.iter().map(|p| f(p).powi(2)).sum::<f64>();
        Some((1.0 - square(&|p| p[0] - factor * p[1]) / square(&|p| p[0])).max(0.0))
    }

    /// Coherence with the rate of the heading.
    fn rate(&self, columns: &[&Column]) -> Option<f64> {
        let psi = self.psi.as_ref()?;
        let raw = Signal::new(columns, 1.0, 0.0, false).0;
        let span = psi.span().max(raw.span());
        ratio(&psi.rate(span).pairs(&raw.smooth(span))).map(|r| r.coherence)
    }

    /// How surely the ship turns by the column. One that it does not turn by may be sound where nothing is steered, so that it never
    /// contradicts.
    fn rudder(&self, columns: &[&Column]) -> Option<f64> {
        let psi = self.psi.as_ref()?;
        let t = rudder_effect(&psi.rate(psi.span()), &Signal::new(columns, 1.0, 0.0, false).0)?.abs();
        Some(0.5 + 0.5 * t / (t + HALF_T))
    }
}

/// Columns as a heading \[rad\].
pub fn heading(columns: &[&Column], track: Option<&Track>) -> Signal {
    Signal::new(columns, heading_unit(columns, track), 0.0, true).0
}

/// SI value of one of a heading's: a unit of its own that the file states, or that in which it goes with the track or has its size, or as
/// stated.
pub fn heading_unit(columns: &[&Column], track: Option<&Track>) -> f64 {
    let stated = columns.iter().find_map(|c| Quantity::Angle.factor(c.unit.as_deref()?));
    let own = stated.filter(|factor| *factor < 0.5 * DEGREE && top(columns) * factor < MOST_RADIANS);
    own.or(compass_unit(columns, track).map(|shown| shown.factor)).or(stated).unwrap_or(1.0)
}

/// What columns lack of full agreement is a mean square: one fits worse where it is this many times that of another, twice its root.
pub const CLEARLY: f64 = 4.0;
/// One degree \[rad\].
const DEGREE: f64 = TAU / 360.0;
/// Any heading or course above this is no radian, but for one that counts turns.
pub const MOST_RADIANS: f64 = 7.0;
/// A direction in degrees stays within so many turns, unless it counts them from the first.
const FEW_TURNS: f64 = 2.0;
/// Nor does one that counts them count more than so many.
const MANY_TURNS: f64 = 20.0;
/// Jumps by a whole turn that show a unit.
const JUMPS: usize = 3;
/// A jump by a whole turn is missed by at most this share of it.
const OFF_TURN: f64 = 0.1;
/// The units of a direction: the usual two, and those that need more numbers for a turn.
const USUAL: [&str; 2] = ["deg", "rad"];
const FINER: [&str; 2] = ["cdeg", "mrad"];

/// The unit of a direction, and what shows it.
pub struct Shown {
    /// The unit.
    pub unit: &'static str,
    /// SI value of one.
    pub factor: f64,
    /// In words.
    pub why: String,
}

/// The unit of a direction: the one in which it goes with the track, by a whole turn of which it jumps, or in which it has its size.
pub fn compass_unit(columns: &[&Column], track: Option<&Track>) -> Option<Shown> {
    if counts_gon(columns, track) {
        return None;
    }
    let of = |units: &[&'static str]| -> Vec<(&'static str, f64)> {
        units.iter().filter_map(|unit| Some((*unit, Quantity::Angle.factor(unit)?))).collect()
    };
    let (top, mut units, finer) = (top(columns), of(&USUAL), of(&FINER));
    let by_size = by_size(columns, &finer);
    if top * DEGREE > TAU * (1.0 + OFF_TURN) {
        units.extend(&finer);
    }
    let factors: Vec<f64> = units.iter().map(|(_, factor)| *factor).collect();
    let raw = |factor: f64| Signal::new(columns, factor, 0.0, true).0;
    let of_track = track.and_then(|track| track.unit_of_direction(raw, &factors));
    let by_track = units.iter().copied().find(|(_, factor)| Some(*factor) == of_track);
    let by_jumps = units.iter().copied().find(|(_, factor)| jumps_by(columns, TAU / factor));
    // A direction that counts turns goes with the track, too.
    let goes = |factor: f64| {
        let both = [1.0, -1.0].map(|sense| track?.agreement(&raw(factor), sense));
        both.into_iter().flatten().map(|[length, _]| length).reduce(f64::max)
    };
    let counted = |factor: f64| top * factor > FEW_TURNS * TAU;
    let by_size =
        by_size.filter(|(_, factor)| !counted(*factor) || goes(*factor).is_none_or(|length| length > COHERENT));
    let (unit, factor) = by_track.or(by_jumps).or(by_size)?;
    let values = format!("values up to {}", sig(largest(columns), 3));
    let words = match unit {
        "rad" => "radians",
        "deg" => "degrees",
        "cdeg" => "hundredths of a degree",
        _ => "milliradians",
    };
    let why = match (by_track, by_size) {
        (Some(_), by_size) if by_size.is_none_or(|(size, _)| size != unit) => {
            format!("{values}; the track goes that way in {words}")
        }
        (None, None) => format!("{values}; jumps by a turn in {words}"),
        _ if finer.iter().any(|(finer, _)| *finer == unit) => {
            format!("{values}, which no direction has in degrees: {words}")
        }
        _ => values,
    };
    Some(Shown { unit, factor, why })
}

/// Values of a full turn in gon, of the last part of it from which a direction in gon leaps to its first, and of a turn in degrees.
const GON: [f64; 3] = [400.0, 380.0, 361.0];

/// Whether a direction passes north by leaps of a turn in gon, which is in no unit that is read here, or goes with the track so and not in
/// degrees.
fn counts_gon(columns: &[&Column], track: Option<&Track>) -> bool {
    let [turn, leap, degrees] = GON;
    let leaps = || columns.iter().flat_map(|c| c.v.windows(2)).any(|v| (v[1] - v[0]).abs() > leap);
    let apart = |turn: f64| Some(1.0 - track?.agreement(&Signal::new(columns, TAU / turn, 0.0, true).0, 1.0)?[0]);
    let goes = || apart(turn).zip(apart(360.0)).is_some_and(|(gon, degrees)| CLEARLY * gon < degrees);
    top(columns) > degrees && largest(columns) <= turn && (leaps() || goes())
}

/// The unit that the size of a direction shows.
fn by_size(columns: &[&Column], finer: &[(&'static str, f64)]) -> Option<(&'static str, f64)> {
    let top = top(columns);
    let turns = |factor: f64| top * factor / TAU;
    if top <= MOST_RADIANS {
        return None;
    }
    if turns(DEGREE) <= FEW_TURNS || counts_turns(columns, DEGREE) {
        return Some(("deg", DEGREE));
    }
    let within = || finer.iter().filter(|(_, factor)| turns(*factor) <= 1.0 + 0.1 * OFF_TURN);
    within().next().filter(|_| within().count() == 1).copied()
}

/// Whether a direction in that unit counts turns: it begins within one, never steps by half of one, and makes some at most.
pub fn counts_turns(columns: &[&Column], factor: f64) -> bool {
    let turn = TAU / factor;
    let begins = columns.iter().filter_map(|c| c.v.first()).all(|v| v.abs() < 1.5 * turn);
    let steps = columns.iter().flat_map(|c| c.v.windows(2)).all(|v| (v[1] - v[0]).abs() < 0.5 * turn);
    begins && steps && top(columns) < MANY_TURNS * turn
}

/// Whether a direction jumps by about so much, and never farther, where it passes the end of its range.
fn jumps_by(columns: &[&Column], turn: f64) -> bool {
    let steps = || columns.iter().flat_map(|c| c.v.windows(2)).map(|v| (v[1] - v[0]).abs());
    let whole = |step: &f64| (step / turn - 1.0).abs() < OFF_TURN;
    largest(columns) <= turn * (1.0 + OFF_TURN)
        && steps().filter(whole).count() >= JUMPS
        && steps().all(|step| step <= turn)
}

/// The largest size of the values.
pub fn largest(columns: &[&Column]) -> f64 {
    columns.iter().flat_map(|c| &c.v).fold(0.0, |m: f64, v| m.max(v.abs()))
}

/// The same without a stray number.
pub fn top(columns: &[&Column]) -> f64 {
    columns.iter().map(|c| size_below(&c.v, 0.999)).fold(0.0, f64::max)
}
