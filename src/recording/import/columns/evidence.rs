//! Units, signs and senses by comparing columns with one another: heading against the track and the yaw rate, speed against the
//! track, rudder against the turn. What the data do not show is asked for, with the flag to pass.

use super::agree::{MOST_RADIANS, compass_unit, counts_turns, largest, top};
use super::names::is_magnetic;
use super::scale::{MOST_SHARE, advice, clock, full_turn, of_share};
use crate::numerals::sig;
use crate::recording::import::signals::log::{Column, Meaning};
use crate::recording::import::signals::motion::{AGREE, COHERENT, Track, ratio, rudder_effect};
use crate::recording::import::signals::signal::{Signal, median, size_below};
use crate::recording::{Channel, Quantity};
use std::f64::consts::{FRAC_PI_2, TAU};

/// What a column was taken for.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// The unit.
    pub unit: String,
    /// SI value of one, with the sign.
    pub factor: f64,
    /// Added, SI.
    pub offset: f64,
    /// Why.
    pub evidence: String,
    /// What contradicts it, to be reported as a warning.
    pub doubt: Option<String>,
}

/// A unit that is given, and by whom.
#[derive(Clone, Debug)]
pub struct Given {
    /// As written.
    pub unit: String,
    /// SI value of one.
    pub factor: f64,
    /// Whether it is the user who gives it.
    pub by_user: bool,
}

/// What is known when a column is looked at.
#[derive(Default)]
pub struct Known {
    /// The track.
    pub track: Option<Track>,
    /// Whether the axes of the track may be exchanged: they are called x and y, not north and east.
    pub axes_untold: bool,
    /// Sway velocity in its own unit, where it was recorded.
    pub sway: Option<Signal>,
    /// Heading \[rad\].
    pub psi: Option<Signal>,
    /// Yaw rate \[rad/s\]: the recorded one, or that of the heading.
    pub r: Option<Signal>,
    /// Magnetic variation \[rad\], positive to the east, and its column.
    pub variation: Option<(f64, String)>,
}

impl Known {
    /// Whether exchanged axes explain a direction that turns against the track as well as its own sense does: where nothing calls them
    /// north and east, only a sway velocity distinguishes the two.
    fn mirrored(&self, columns: &[&Column], verdict: &Verdict) -> bool {
        let Some(track) = self.track.as_ref().filter(|_| self.axes_untold) else { return false };
        let heading = Signal::new(columns, verdict.factor, verdict.offset, true).0;
        self.sway.as_ref().is_none_or(|sway| track.sways(&heading, sway) < SWAYS)
    }

    /// Whether the ship goes ahead, by heading and track.
    fn goes_ahead(&self) -> bool {
        let both = self.track.as_ref().zip(self.psi.as_ref()).and_then(|(track, psi)| track.agreement(psi, 1.0));
        both.is_some_and(|[length, angle]| length > AGREE && angle.abs() < FRAC_PI_2)
    }
}

/// Agreement from which a sway velocity shows to which side the ship goes.
const SWAYS: f64 = 0.3;
/// Ratios may differ from those of the units by this share.
const NEAR: f64 = 0.15;
/// The same for speeds through water, which a current changes.
const NEAR_IN_WATER: f64 = 0.3;
/// A speed that is this many times another is no measurement of the same.
const FAR: f64 = 5.0;
/// A steady angle of course and heading that is reported \[rad\]: 3 deg, above the error of a gyrocompass under way (1 to 2 deg).
const STEADY: f64 = 0.052;
/// t value of the rudder's effect from which its sign is determined.
const RUDDER_T: f64 = 5.0;
/// Hard over is at 35 deg by the rules (SOLAS II-1/29), and hardly any rudder goes beyond 45 deg \[rad\].
const HARD_OVER: f64 = 0.785;
/// A rudder that mostly shows more than this share of its most is not measured from midships.
const AMIDSHIPS: f64 = 0.2;
/// Share of the values that may be stray.
const STRAY: f64 = 0.005;
/// Any rudder angle above this is no radian.
const MOST_RUDDER: f64 = 1.6;
/// A rate above the first is rpm, one below the second rps.
const RPM_ABOVE: f64 = 25.0;
const RPS_BELOW: f64 = 6.0;
/// No propeller drives a ship at less than this \[rps\]: the largest turn at one in a second at service speed, and a third of that in port.
const SLOWEST: f64 = 0.2;

/// The words of the question for a unit that nothing shows.
pub fn ask(meaning: Meaning, column: &str, choices: &str) -> String {
    format!("the unit of column `{column}` ({}): pass `--unit {}={choices}`", meaning.words(), meaning.name())
}

/// The verdict of a given unit.
fn as_given(given: &Given, evidence: &str) -> Verdict {
    let by = if given.by_user { "as passed with --unit" } else { "unit as the file gives it" };
    let evidence = if evidence.is_empty() { by.to_owned() } else { format!("{by}; {evidence}") };
    Verdict { unit: given.unit.clone(), factor: given.factor, offset: 0.0, evidence, doubt: None }
}

/// A verdict by the data, with a doubt where the file says otherwise.
fn by_data(unit: &str, factor: f64, evidence: String, given: Option<&Given>) -> Verdict {
    let differs = given.filter(|g| (g.factor / factor.abs()).ln().abs() > 0.05);
    let doubt = differs.map(|g| format!("the file says {}, the data {unit}; taken as {unit}", g.unit));
    Verdict { unit: unit.to_owned(), factor, offset: 0.0, evidence, doubt }
}

/// The unit whose factor, up to the sign, is nearest to a ratio; `None` where none is near.
fn nearest_unit(quantity: Quantity, units: &[&'static str], gain: f64, near: f64) -> Option<(&'static str, f64)> {
    let all = units.iter().filter_map(|unit| Some((*unit, quantity.factor(unit)?)));
    let off = |factor: f64| (gain.abs() / factor).ln().abs();
    all.min_by(|a, b| off(a.1).total_cmp(&off(b.1))).filter(|(_, factor)| off(*factor) < near)
}

/// A heading or a course: degrees or radians, clockwise or not.
///
/// # Errors
/// The question to ask.
pub fn direction(
    meaning: Meaning,
    columns: &[&Column],
    given: Option<&Given>,
    known: &Known,
) -> Result<Verdict, String> {
    let name = columns.first().map_or("", |c| c.name.as_str());
    let raw = |factor: f64| Signal::new(columns, factor, 0.0, true).0;
    let agreement = |factor: f64| known.track.as_ref().and_then(|track| track.agreement(&raw(factor), 1.0));
    let (top, shown) = (largest(columns), compass_unit(columns, known.track.as_ref()));
    // A unit that the file states, and in which it goes with the track or has its size: milliradians, hundredths of a degree.
    let goes = |g: &&Given| agreement(g.factor).map_or(top * g.factor < MOST_RADIANS, |[length, _]| length > AGREE);
    let stated = given.filter(|g| g.by_user || (g.factor != 1.0 && Quantity::Angle.factor("deg") != Some(g.factor)));
    let (unit, factor, why) = match (given, &shown) {
        (Some(given), _) if given.by_user || stated.filter(goes).is_some() => {
            (given.unit.as_str(), given.factor, String::new())
        }
        (_, Some(shown)) => (shown.unit, shown.factor, shown.why.clone()),
        (Some(given), None) if top * given.factor < MOST_RADIANS || counts_turns(columns, given.factor) => {
            (given.unit.as_str(), given.factor, String::new())
        }
        _ => {
            let units = if top > MOST_RADIANS { "deg, cdeg or mrad" } else { "deg or rad" };
            return Err(ask(meaning, name, units) + &full_turn(meaning, top));
        }
    };
    let agrees =
        given.is_some_and(|g| g.by_user || stated.filter(goes).is_some() || (g.factor / factor - 1.0).abs() < 1e-6);
    let mut verdict = match given {
        Some(given) if agrees => as_given(given, &why),
        given => by_data(unit, factor, why, given),
    };
    if is_magnetic(name) {
        bring_to_true(&mut verdict, meaning, known);
    }
    if let Some([right, _]) = agreement(factor) {
        let degrees = |angle: f64| sig(angle.to_degrees(), 3);
        if let Some(turned) = known.track.as_ref().and_then(|track| track.anticlockwise(&raw(factor))) {
            let quarter = (turned / FRAC_PI_2).round() * FRAC_PI_2;
            (verdict.factor, verdict.offset) = (-factor, quarter);
            if given.is_none_or(|g| !g.by_user) && known.mirrored(columns, &verdict) {
                return Err(format!(
                    "whether x is east and y north, or column `{name}` ({}) is counted anticlockwise, since it turns against the track: exchange the axes with `--column x=NAME --column y=NAME`, or pass `--unit {}={unit}` if it is anticlockwise",
                    meaning.words(),
                    meaning.name()
                ));
            }
            verdict.evidence += &format!(
                "; goes with the track where it is counted anticlockwise, from {} deg clockwise of north",
                degrees(quarter)
            );
        } else if right > AGREE {
            verdict.evidence += "; turns as the track does: clockwise from north";
        }
    }
    if meaning == Meaning::Channel(Channel::Psi) {
        let heading = Signal::new(columns, verdict.factor, verdict.offset, true).0;
        let steady = known.track.as_ref().and_then(|track| track.steady_angle(&heading));
        let warning = steady.filter(|angle| angle.abs() > STEADY).map(steady_words);
        verdict.doubt = both(verdict.doubt.take(), warning);
    }
    Ok(verdict)
}

/// Adds the variation to a magnetic direction, or reports that it is not known.
fn bring_to_true(verdict: &mut Verdict, meaning: Meaning, known: &Known) {
    match &known.variation {
        Some((variation, column)) => {
            verdict.offset = *variation;
            let (degrees, side) = (sig(variation.to_degrees().abs(), 3), if *variation < 0.0 { "W" } else { "E" });
            verdict.evidence += &format!("; magnetic, brought to true north by {degrees} deg {side} (`{column}`)");
        }
        None => {
            let words = if meaning == Meaning::Course { "course" } else { "heading" };
            verdict.doubt = Some(format!(
                "a magnetic {words}: variation and deviation are not in it; `offset` in columns.toml adds them, or a column of the variation (`--column variation=NAME`)"
            ));
        }
    }
}

/// The warning about a steady angle from heading to course \[rad\].
fn steady_words(angle: f64) -> String {
    format!(
        "the course is {} deg off the heading on all headings alike, which no current explains: a magnetic compass, or one that is not aligned; `psi = {{ offset = {} }}` (rad) in [columns] of columns.toml takes it out",
        sig(angle.to_degrees(), 3),
        sig(angle, 4)
    )
}

/// Speeds over ground or through water, by the speed of the track. `size` is the speed that the columns give, in their own unit.
///
/// # Errors
/// The question to ask.
pub fn speed(
    meaning: Meaning,
    name: &str,
    size: &Signal,
    given: Option<&Given>,
    known: &Known,
) -> Result<Verdict, String> {
    if let Some(given) = given.filter(|g| g.by_user) {
        return Ok(as_given(given, ""));
    }
    let in_water = matches!(meaning, Meaning::Channel(Channel::UWater | Channel::VWater));
    let near = if in_water { NEAR_IN_WATER } else { NEAR };
    let ratio = known.track.as_ref().and_then(|track| {
        let pairs: Vec<[f64; 2]> = track.speed.pairs(size).into_iter().filter(|p| p[0] > 0.3 * track.fast).collect();
        ratio(&pairs).filter(|r| r.coherence > COHERENT)
    });
    let found = ratio.and_then(|ratio| {
        let (unit, factor) = nearest_unit(Quantity::Speed, &["m/s", "kn", "km/h"], ratio.gain, near)?;
        Some((unit, factor, format!("speed of the track / {name} = {}", sig(ratio.gain, 3))))
    });
    let times = |given: &Given| ratio.map_or(1.0, |ratio| ratio.gain.abs() / given.factor);
    match (found, given) {
        (Some((unit, factor, why)), given) => Ok(by_data(unit, factor, why, given)),
        (None, Some(given)) if !in_water && !(1.0 / FAR..FAR).contains(&times(given)) => {
            let (many, unit, flag) = (sig(times(given), 3), &given.unit, meaning.name());
            Err(format!(
                "the track is sailed {many} times as fast as column `{name}` says in {unit}: {}. With `--unit {flag}={unit}` it is taken as it is",
                advice(times(given))
            ))
        }
        (None, Some(given)) => Ok(as_given(given, "")),
        (None, None) => {
            let of_clock = ratio.filter(|_| !in_water).and_then(|ratio| clock(name, ratio.gain));
            Err(of_clock.unwrap_or_else(|| ask(meaning, name, "kn or m/s")))
        }
    }
}

/// A yaw rate, by the rate of the heading.
///
/// # Errors
/// The question to ask.
pub fn yaw_rate(
    meaning: Meaning,
    columns: &[&Column],
    given: Option<&Given>,
    known: &Known,
) -> Result<Verdict, String> {
    let name = columns.first().map_or("", |c| c.name.as_str());
    let given_by_user = given.filter(|g| g.by_user);
    let raw = Signal::new(columns, 1.0, 0.0, false).0;
    let found = known.psi.as_ref().and_then(|psi| {
        let span = psi.span().max(raw.span());
        ratio(&psi.rate(span).pairs(&raw.smooth(span))).filter(|r| r.coherence > COHERENT)
    });
    let sense =
        |gain: f64| if gain < 0.0 { (-1.0, "anticlockwise positive, turned") } else { (1.0, "clockwise positive") };
    match (found, given_by_user.or(given)) {
        (Some(ratio), given) => {
            let near = nearest_unit(
                Quantity::AngularRate,
                &["deg/min", "deg/s", "rad/s", "mrad/s", "cdeg/s"],
                ratio.gain,
                NEAR,
            );
            let (sign, words) = sense(ratio.gain);
            match (near, given) {
                (_, Some(given)) if given.by_user => {
                    let mut verdict = as_given(given, words);
                    verdict.factor *= sign;
                    Ok(verdict)
                }
                (Some((unit, factor)), given) => {
                    let why =
                        format!("heading turns as {name} says ({} rad/s a unit), {words}", sig(ratio.gain.abs(), 3));
                    Ok(by_data(unit, sign * factor, why, given))
                }
                (None, Some(given)) => {
                    let mut verdict = as_given(given, words);
                    verdict.factor *= sign;
                    let times = ratio.gain.abs() / given.factor;
                    verdict.doubt = Some(format!("heading turns {} times as fast as {name} says", sig(times, 3)));
                    Ok(verdict)
                }
                (None, None) => Err(ask(meaning, name, "deg/min, deg/s or rad/s")),
            }
        }
        (None, Some(given)) => Ok(as_given(given, "")),
        (None, None) => Err(ask(meaning, name, "deg/min, deg/s or rad/s")),
    }
}

/// A rudder angle: degrees or radians, and which sign turns the ship to starboard.
///
/// # Errors
/// The question to ask.
pub fn rudder(meaning: Meaning, columns: &[&Column], given: Option<&Given>, known: &Known) -> Result<Verdict, String> {
    let name = columns.first().map_or("", |c| c.name.as_str());
    let top = top(columns);
    let turned = known.psi.as_ref().map_or(0.0, |psi| {
        let (low, high) = psi.v.iter().fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
        high - low
    });
    // Hardly any ship turns half round with less than a degree and a half of rudder.
    let too_little = top <= MOST_RUDDER && turned > 3.0;
    let mut side = None;
    let mut verdict = match given {
        Some(given) if given.by_user || given.factor < 0.5 || top <= MOST_RUDDER => as_given(given, ""),
        given if top > MOST_RUDDER => {
            if is_per_cent(columns) {
                return Err(of_share(meaning, name, top));
            }
            let (unit, factor) = rudder_unit(columns).ok_or_else(|| ask(meaning, name, "deg, cdeg or mrad"))?;
            by_data(unit, factor, format!("angles up to {}", sig(top, 3)), given)
        }
        None if too_little && (HARD_OVER..MOST_SHARE).contains(&top) => {
            return Err(format!("{}, or {}", ask(meaning, name, "rad"), of_share(meaning, name, top)));
        }
        given if too_little => {
            let why = format!("angles up to {} turn the ship through {} deg", sig(top, 3), sig(turned.to_degrees(), 3));
            by_data("rad", 1.0, why, given)
        }
        _ => return Err(ask(meaning, name, "deg or rad")),
    };
    if lacks_side(columns, known) {
        let midships = columns.iter().filter_map(|c| median(c.v.clone())).fold(0.0, f64::max);
        let middle = (midships > AMIDSHIPS * top).then(|| sig(midships, 3));
        if given.is_none_or(|g| !g.by_user) {
            let (flag, unit) = (meaning.name(), &verdict.unit);
            let middle = middle.map_or_else(String::new, |middle| {
                format!("; where {middle} is midships, pass how much one is, `--unit {flag}={unit}` or `--unit {flag}='14 deg'`, and the import gives the offset")
            });
            return Err(format!(
                "the side of column `{name}` ({}), which is never negative while the ship turns to both sides: give it a sign, letters P and S, or a column of them beside it; with `--unit {flag}={unit}` it is taken as it is{middle}",
                meaning.words()
            ));
        }
        let offset = sig(-midships * verdict.factor, 4);
        side = middle.map(|middle| format!(
            "never negative while the ship turns to both sides: where {middle} is midships, `delta = {{ offset = {offset} }}` (rad) in [columns] of columns.toml takes it out"
        ));
    }
    let signal = Signal::new(columns, verdict.factor, 0.0, false).0;
    let effect = known.r.as_ref().and_then(|r| rudder_effect(&r.smooth(r.span()), &signal));
    match effect {
        Some(t) if t < -RUDDER_T => {
            verdict.factor = -verdict.factor;
            verdict.evidence += &format!("; the ship turns against it (t = {}): positive to port, turned", sig(t, 3));
        }
        Some(t) if t > RUDDER_T => {
            verdict.evidence += &format!("; the ship turns with it (t = {}): positive turns to starboard", sig(t, 3));
        }
        _ => {
            verdict.doubt =
                Some("the recordings do not determine its sign: positive must turn the ship to starboard".to_owned());
        }
    }
    verdict.doubt = both(verdict.doubt.take(), side);
    if let Some(given) = given.filter(|g| !g.by_user && g.factor < 0.5 && too_little) {
        let doubt = format!(
            "the file says {}, and {} of them turn the ship through {} deg: if the values are radians, pass `--unit {}=rad`",
            given.unit,
            sig(top, 3),
            sig(turned.to_degrees(), 3),
            meaning.name()
        );
        verdict.doubt = Some(verdict.doubt.take().map_or(doubt.clone(), |sign| format!("{doubt}; {sign}")));
    }
    Ok(verdict)
}

/// Two doubts of one column, where there are two.
fn both(first: Option<String>, second: Option<String>) -> Option<String> {
    first.into_iter().chain(second).reduce(|a, b| format!("{a}; {b}"))
}

/// Whether numbers are more than the degrees of any rudder, in more than stray ones, and no more than 100 per cent.
fn is_per_cent(columns: &[&Column]) -> bool {
    let most = Channel::Delta.info().limits.1.to_degrees();
    let values = || columns.iter().flat_map(|c| &c.v);
    let beyond = values().filter(|v| v.abs() > most).count();
    top(columns) < 100.0 * MOST_SHARE && values().any(|v| *v < 0.0) && beyond as f64 > STRAY * values().count() as f64
}

/// The unit of rudder angles by their size: degrees where a rudder reaches as many, or else the one in which it does.
fn rudder_unit(columns: &[&Column]) -> Option<(&'static str, f64)> {
    // A stray number far away is no measure of the angles.
    let top = columns.iter().map(|c| size_below(&c.v, 0.95)).fold(0.0, f64::max);
    let reached = |unit: &'static str| {
        let factor = Quantity::Angle.factor(unit)?;
        (top * factor <= Channel::Delta.info().limits.1).then_some((unit, factor))
    };
    let finer = [reached("cdeg"), reached("mrad")];
    let known = finer.iter().flatten().count() == 1;
    reached("deg").or_else(|| finer.into_iter().flatten().next().filter(|_| known))
}

/// Whether a rudder angle is written without its sign: the ship turns as fast to one side as to the other with angles of one sign.
fn lacks_side(columns: &[&Column], known: &Known) -> bool {
    let Some(r) = &known.r else { return false };
    let r = r.smooth(r.span());
    let (low, high) = r.v.iter().fold((0.0_f64, 0.0_f64), |(l, h), v| (l.min(*v), h.max(*v)));
    let both = low.abs().min(high) > 0.3 * low.abs().max(high);
    // A stray number far away is no measure of the angles.
    let top = columns.iter().map(|c| size_below(&c.v, 0.95)).fold(0.0, f64::max);
    both && top > 0.0 && columns.iter().flat_map(|c| &c.v).all(|v| *v >= -0.02 * top)
}

/// A propeller rate.
///
/// # Errors
/// The question to ask.
pub fn rotation(
    meaning: Meaning,
    columns: &[&Column],
    given: Option<&Given>,
    known: &Known,
) -> Result<Verdict, String> {
    let name = columns.first().map_or("", |c| c.name.as_str());
    let top = top(columns);
    let per_minute = Quantity::Rotation.factor("rpm").unwrap_or(1.0);
    let why = format!("rates up to {}", sig(top, 3));
    let mut verdict = match given {
        Some(given) => as_given(given, &why),
        None if top > RPM_ABOVE => by_data("rpm", per_minute, why, None),
        None if top > 0.0 && top < RPS_BELOW => by_data("rps", 1.0, why, None),
        None => return Err(ask(meaning, name, "rpm or rps")),
    };
    let turning = || columns.iter().flat_map(|c| &c.v).filter(|v| v.abs() > 0.1 * top);
    let (astern, all) = (turning().filter(|v| **v < 0.0).count(), turning().count());
    if 20 * astern > 19 * all && known.goes_ahead() {
        verdict.factor = -verdict.factor;
        verdict.evidence += "; the ship goes ahead with negative ones: turned";
    }
    let factor = verdict.factor.abs();
    if let Some(given) = given.filter(|g| !g.by_user)
        && top > 0.0
        && top * factor < SLOWEST
    {
        verdict.doubt = Some(format!(
            "{} {} is little for a ship's propeller: if the values are revolutions per second, pass `--unit {}=rps`",
            sig(top, 3),
            given.unit,
            meaning.name()
        ));
    }
    if top * factor > 7.0 && top * factor < 60.0 {
        let rpm = sig(top * factor * 60.0, 3);
        verdict.doubt = Some(format!(
            "{rpm} rpm is much for a ship's propeller: if it is the engine's, add `n = {{ scale = 0.2 }}` (1 / gear ratio) to [columns] of columns.toml"
        ));
    }
    let unsigned = astern_unsigned(columns, top, known);
    verdict.doubt = both(unsigned, verdict.doubt.take());
    Ok(verdict)
}

/// Seconds for which a ship makes sternway, and its least share of her speed ahead, that no current or stop by itself explains.
const STERNWAY: (f64, f64) = (30.0, 0.1);

/// What is said of a rate that is never negative while the ship goes astern with her propeller turning.
fn astern_unsigned(columns: &[&Column], top: f64, known: &Known) -> Option<String> {
    let (track, psi) = known.track.as_ref().zip(known.psi.as_ref())?;
    if columns.iter().flat_map(|c| &c.v).any(|v| *v < -0.02 * top) {
        return None;
    }
    let rate = Signal::new(columns, 1.0, 0.0, false).0;
    let astern = |i: &usize| {
        let t = track.speed.t[*i];
        let (sin, cos) = psi.at(t, track.speed.step).sin_cos();
        let ahead = track.north.v[*i] * cos + track.east.v[*i] * sin;
        ahead < -STERNWAY.1 * track.fast && rate.at(t, rate.step.max(track.speed.step)) > 0.1 * top
    };
    let seconds = (0..track.speed.t.len()).filter(astern).count() as f64 * track.speed.step;
    (seconds > STERNWAY.0).then(|| {
        format!(
            "never negative while the ship goes astern for {} s with the propeller turning: it lacks its sign, and every run with the engine astern is wrong; make it negative there, or add a column of the sense (ahead, astern) beside it",
            sig(seconds, 3)
        )
    })
}

/// No propeller turns faster \[rps\]: `trimtab help channels`.
const FASTEST: f64 = 60.0;
/// Any other channel: its unit as given, degrees by size or by where they jump, rates by size, or a plain number.
///
/// # Errors
/// Why it is left out.
pub fn other(meaning: Meaning, columns: &[&Column], given: Option<&Given>) -> Result<Verdict, String> {
    let name = columns.first().map_or("", |c| c.name.as_str());
    if let Some(given) = given {
        return Ok(as_given(given, ""));
    }
    let quantity = meaning.quantity();
    let top = largest(columns);
    if let Some(shown) = (quantity == Quantity::Angle).then(|| compass_unit(columns, None)).flatten() {
        return Ok(by_data(shown.unit, shown.factor, shown.why, None));
    }
    match quantity {
        Quantity::Rotation if top > TAU * FASTEST => {
            let per_minute = quantity.factor("rpm").unwrap_or(1.0);
            Ok(by_data("rpm", per_minute, format!("rates up to {}", sig(top, 3)), None))
        }
        Quantity::Length => Ok(by_data("m", 1.0, "no unit is given: metres".to_owned(), None)),
        Quantity::Number if top <= 1.01 => Ok(by_data("-", 1.0, format!("values up to {}", sig(top, 3)), None)),
        Quantity::Number if top <= 101.0 => Ok(by_data("%", 0.01, format!("values up to {}", sig(top, 3)), None)),
        _ => Err(ask(meaning, name, &quantity.choices().replace(", ", " or "))),
    }
}
