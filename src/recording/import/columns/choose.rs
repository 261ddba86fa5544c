//! Which column is taken for what: as the user says, as the format says, as its name and the data say.
//! Of several columns for one quantity one is taken and the others are listed; units and signs are not decided here.

use super::actuators::by_names;
use super::agree::{CLEARLY, Sight, heading, largest, top};
use super::names::{
    Reading, VAGUELY, by_revolutions, is_second_choice, is_unit, is_vertical, name_and_unit, reading, source,
};
use super::orders::follows;
use super::scale::{full_turn, of_share};
use super::sides::are_sides;
use crate::files::suggestion;
use crate::recording::import::error::ImportError;
use crate::recording::import::signals::log::{Column, Log, Meaning, needed};
use crate::recording::import::signals::motion::Track;
use crate::recording::import::signals::place::places;
use crate::recording::import::signals::signal::{Signal, size_below};
use crate::recording::{CHANNELS, Channel, Driven, Quantity};
use std::collections::{BTreeMap, HashMap};

/// What a column of revolutions is.
const SHAFT: Meaning = Meaning::Channel(Channel::N);

/// What the user says of the columns.
#[derive(Clone, Debug, Default)]
pub struct Choices {
    /// Column name by quantity (`psi`, `lat`, ...); `t` for the time.
    pub columns: BTreeMap<String, String>,
    /// Unit by quantity.
    pub units: BTreeMap<String, String>,
    /// What drives the craft, of which every recording must have the channels.
    pub driven: Driven,
}

impl Choices {
    /// The same with the names of columns as they are read: a header that is copied with its unit, `n [rpm]`, is the column `n`.
    pub fn read_names(&self) -> Self {
        let read = |name: &String| match name_and_unit(name) {
            (read, Some(_)) => read,
            _ => name.clone(),
        };
        let columns = self.columns.iter().map(|(quantity, name)| (quantity.clone(), read(name))).collect();
        Self { columns, ..self.clone() }
    }

    /// What a column is by itself: as the user says, as the format says, as its name says.
    pub fn meaning(&self, column: &Column) -> Option<Meaning> {
        let forced = self.columns.iter().find(|(_, name)| name.eq_ignore_ascii_case(&column.name));
        let forced = forced.and_then(|(quantity, _)| Meaning::from_name(quantity));
        forced.or(column.meaning).or_else(|| by_name(&column.name, column.unit.as_deref()).map(|(meaning, _)| meaning))
    }

    /// Whether the craft has what such a column is of.
    fn has(&self, meaning: Meaning) -> bool {
        match meaning {
            SHAFT => self.driven.propeller,
            Meaning::Channel(Channel::Delta) => self.driven.rudder,
            _ => true,
        }
    }

    /// Checks that each quantity there is, and each unit of it.
    ///
    /// # Errors
    /// [`ImportError::Choice`].
    pub fn check(&self) -> Result<(), ImportError> {
        let known = || {
            let beside = crate::recording::import::signals::log::BESIDE_CHANNELS.iter().map(|(name, ..)| *name);
            CHANNELS.iter().map(|c| c.name).chain(beside)
        };
        let all = self.columns.keys().map(|k| ("--column", k)).chain(self.units.keys().map(|k| ("--unit", k)));
        for (flag, name) in all {
            let commands = self.driven.commands.iter().map(|c| c.name());
            if !known().chain(commands.clone()).any(|k| k == name) {
                let near = suggestion(name, known().chain(commands.clone()));
                let list = known().chain(commands).collect::<Vec<_>>().join(", ");
                return Err(ImportError::Choice(format!(
                    "{flag} {name}=...: there is no `{name}`{near}; there are {list}"
                )));
            }
        }
        for (name, unit) in &self.units {
            let quantity = Meaning::from_name(name).map_or(Quantity::Time, Meaning::quantity);
            if quantity.factor(unit).is_none() {
                let choices = quantity.choices();
                return Err(ImportError::Choice(format!(
                    "--unit {name}={unit}: `{unit}` is none of {choices}; pass one of them"
                )));
            }
        }
        Ok(())
    }
}

/// A column that was not used.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Unused {
    /// Its name.
    pub column: String,
    /// Why, and the flag to use it.
    pub why: String,
}

/// The columns of one quantity: one name, in one file or several.
pub type Chosen<'a> = BTreeMap<Meaning, Vec<&'a Column>>;

/// What was chosen of the columns.
#[derive(Default)]
pub struct Choice<'a> {
    /// The columns that are taken, by what they are.
    pub chosen: Chosen<'a>,
    /// Those that are not.
    pub unused: Vec<Unused>,
    /// Questions about units that are not known.
    pub asked: Vec<String>,
    /// What else decided than names: by what a column is taken for, a sentence for its evidence.
    pub decided: Vec<(Meaning, String)>,
}

/// A column of one name, in one file or several, that may be taken for a quantity.
struct Candidate<'a> {
    name: &'a str,
    columns: Vec<&'a Column>,
    /// Share of its name that the quantity explains.
    explained: f64,
    /// Whether the user says so.
    forced: bool,
}

/// The columns `N` and `E`, where a log has both: one letter alone is the name of a propeller rate too.
fn axes(names: &[(&str, Vec<&Column>)]) -> Vec<(&'static str, Meaning)> {
    let axes = [("N", Meaning::Channel(Channel::X)), ("E", Meaning::Channel(Channel::Y))];
    let has_both = axes.iter().all(|(axis, _)| names.iter().any(|(name, _)| name == axis));
    if has_both { axes.into() } else { Vec::new() }
}

/// Takes a column whose name is the course in one log and the heading in another, as `Kurs`, for the heading beside a course over ground.
fn heading_of_courses(candidates: &mut BTreeMap<Meaning, Vec<Candidate>>) {
    let heading = Meaning::Channel(Channel::Psi);
    if !candidates.contains_key(&heading)
        && let Some(courses) = candidates.get_mut(&Meaning::Course)
        && courses.iter().any(|c| c.explained > VAGUELY)
        && let Some(vague) = courses.iter().position(|c| c.explained == VAGUELY && !c.forced)
    {
        let candidate = courses.remove(vague);
        candidates.insert(heading, vec![candidate]);
    }
}

/// The columns that are taken and those that are not. Candidates are ranked by what the user says, whether they
/// contain values that change, whether the data contradict them, whether their partner is of the same sensor, whether more than one letter
/// or a unit says what they are, how much of their name the quantity explains, whether the file states a unit that fits, how well they
/// agree with the data, whether they scatter as little as the calmest, and how many samples they have.
///
/// # Errors
/// [`ImportError::Choice`] for a column that no file has.
pub fn choose<'a>(logs: &'a [Log], choices: &Choices) -> Result<Choice<'a>, ImportError> {
    let mut unused = Vec::new();
    let mut candidates = candidates(logs, choices, &mut unused)?;
    heading_of_courses(&mut candidates);
    let mut order: Vec<Meaning> = candidates.keys().copied().collect();
    order.sort_by_key(|meaning| (turn(*meaning), *meaning));
    let (mut chosen, mut sight, mut decided) = (Chosen::new(), Sight::default(), Vec::new());
    let mut parted = Vec::new();
    for meaning in order {
        let Some(mut list) = candidates.remove(&meaning) else { continue };
        let partner = leader(meaning).and_then(|leader| chosen.get(&leader)).and_then(|c| c.first());
        let mut best = best(&list, meaning, partner.map(|c| c.name.as_str()), &sight);
        if let Some(order) = ordered(meaning)
            && let Some(found) = order_among(&mut list, &mut best)
        {
            let (of, by) = (list[best].name, found.name.to_owned());
            decided.push((meaning, format!("`{by}` leads it and leaps faster: that is the order")));
            if chosen.contains_key(&order) || candidates.contains_key(&order) {
                let why = format!("it leads `{of}` and leaps faster: an order, of which another column is taken");
                unused.push(Unused { column: by, why });
            } else {
                decided.push((order, format!("leads `{of}` and leaps faster: the order")));
                chosen.insert(order, found.columns);
            }
        }
        parted.extend(sides_apart(meaning, &list, best));
        let taken = list.get(best).map_or("", |c| c.name);
        for (i, candidate) in list.into_iter().enumerate() {
            if i == best {
                chosen.insert(meaning, candidate.columns);
                continue;
            }
            let name = candidate.name;
            let dead = if moves(&candidate.columns) { "" } else { "; it never changes" };
            let why = format!(
                "`{taken}` is taken for {}{dead}; the other with `--column {}={name}`",
                meaning.words(),
                meaning.name()
            );
            unused.push(Unused { column: name.to_owned(), why });
        }
        look(&mut sight, meaning, &chosen, choices);
    }
    if chosen.contains_key(&Meaning::Channel(Channel::WindDirection))
        && let Some(angle) = chosen.remove(&Meaning::WindAngle)
    {
        let why = "the direction from north is taken for that of the wind".to_owned();
        unused.extend(angle.first().map(|c| Unused { column: c.name.clone(), why }));
    }
    let asked = parted.into_iter().chain(ask_for_units(&mut chosen, &mut unused, choices)).collect();
    Ok(Choice { chosen, unused, asked, decided })
}

/// The candidates by what they may be; the columns that are none are listed.
fn candidates<'a>(
    logs: &'a [Log],
    choices: &Choices,
    unused: &mut Vec<Unused>,
) -> Result<BTreeMap<Meaning, Vec<Candidate<'a>>>, ImportError> {
    let names = named(logs);
    let forced = forced(&names, choices)?;
    let free: Vec<(&str, Option<&str>)> = names
        .iter()
        .filter(|(name, _)| !forced.contains_key(*name))
        .map(|(name, columns)| (*name, columns.first().and_then(|c| c.unit.as_deref())))
        .collect();
    let open: Vec<Channel> = choices
        .driven
        .commands
        .iter()
        .copied()
        .filter(|c| !forced.values().any(|m| *m == Meaning::Channel(*c)))
        .collect();
    let named = by_names(&free, &open);
    let axes = axes(&names);
    let all: Vec<&str> = names.iter().map(|(name, _)| *name).collect();
    let mut candidates: BTreeMap<Meaning, Vec<Candidate<'a>>> = BTreeMap::new();
    for (name, columns) in names {
        let of_actuator = named.get(name).map(|channel| (Meaning::Channel(*channel), 1.0));
        let is_forced = forced.contains_key(name);
        let axis = axes.iter().find(|(axis, _)| *axis == name).filter(|_| !is_forced).map(|(_, m)| (*m, 1.0));
        if !is_forced && is_vertical(name, &all) {
            let why = "a vertical velocity, beside those to the north and to the east".to_owned();
            unused.push(Unused { column: name.to_owned(), why });
            continue;
        }
        match of_actuator.or(axis).or_else(|| read(name, &columns, &forced)) {
            Some((meaning, _)) if !is_forced && !choices.has(meaning) => {
                let why = format!("the ship file has no {}", if meaning == SHAFT { "propeller" } else { "rudder" });
                unused.push(Unused { column: name.to_owned(), why });
            }
            Some((meaning, explained)) => {
                let forced = is_forced;
                candidates.entry(meaning).or_default().push(Candidate { name, columns, explained, forced });
            }
            None => unused.push(Unused { column: name.to_owned(), why: "nothing here uses it".to_owned() }),
        }
    }
    Ok(candidates)
}

/// The questions for units that are stated and not known; what is not needed is left out with its own.
fn ask_for_units(chosen: &mut Chosen<'_>, unused: &mut Vec<Unused>, choices: &Choices) -> Vec<String> {
    let mut asked = Vec::new();
    chosen.retain(|meaning, columns| {
        let Some(question) = unknown_unit(*meaning, columns, choices) else { return true };
        if needed(*meaning) {
            asked.push(question);
            return true;
        }
        unused.extend(columns.first().map(|c| Unused { column: c.name.clone(), why: question }));
        false
    });
    asked
}

/// What is ordered of an actuator by what is measured of it.
fn ordered(meaning: Meaning) -> Option<Meaning> {
    match meaning {
        Meaning::Channel(Channel::Delta) => Some(Meaning::Channel(Channel::DeltaOrder)),
        Meaning::Channel(Channel::N) => Some(Meaning::Channel(Channel::NOrder)),
        _ => None,
    }
}

/// Takes the order out of the candidates for what is measured of an actuator, by what the best of them and another do: the best is the
/// order itself only where their names say as much as each other.
fn order_among<'a>(list: &mut Vec<Candidate<'a>>, best: &mut usize) -> Option<Candidate<'a>> {
    let others = || (0..list.len()).filter(|i| i != best && !list[*i].forced && moves(&list[*i].columns));
    let named = |i: usize| NAMED.iter().filter(|bound| list[i].explained > **bound).count();
    let follower = others()
        .find(|i| !list[*best].forced && named(*i) == named(*best) && follows(&list[*i].columns, &list[*best].columns));
    let order = match follower {
        Some(follower) => std::mem::replace(best, follower),
        None => others().find(|i| follows(&list[*best].columns, &list[*i].columns))?,
    };
    *best -= usize::from(order < *best);
    Some(list.remove(order))
}

/// The question for an angle or a rate of an actuator that has a column for each side.
fn sides_apart(meaning: Meaning, list: &[Candidate<'_>], best: usize) -> Option<String> {
    let taken = list.get(best).filter(|c| is_actuator(meaning) && !c.forced)?;
    let other = list.iter().find(|other| are_sides((taken.name, &taken.columns), (other.name, &other.columns)))?;
    Some(format!(
        "`{}` and `{}` are one {} to two sides: write their difference to one column, or name the one that counts with `--column {}=NAME`",
        taken.name,
        other.name,
        meaning.words(),
        meaning.name()
    ))
}

/// The columns of all files by their name, in the order in which they come.
fn named(logs: &[Log]) -> Vec<(&str, Vec<&Column>)> {
    let mut at: HashMap<&str, usize> = HashMap::new();
    let mut found: Vec<(&str, Vec<&Column>)> = Vec::new();
    for column in logs.iter().flat_map(|log| &log.columns) {
        let i = *at.entry(&column.name).or_insert(found.len());
        if i == found.len() {
            found.push((&column.name, Vec::new()));
        }
        found[i].1.push(column);
    }
    found
}

/// What the user says of columns, by their name.
fn forced(names: &[(&str, Vec<&Column>)], choices: &Choices) -> Result<BTreeMap<String, Meaning>, ImportError> {
    let mut forced = BTreeMap::new();
    for (quantity, column) in &choices.columns {
        let Some(meaning) = Meaning::from_name(quantity) else { continue };
        let exact = names.iter().find(|(name, _)| name == column);
        let Some((found, _)) = exact.or_else(|| names.iter().find(|(name, _)| name.eq_ignore_ascii_case(column)))
        else {
            let near = suggestion(column, names.iter().map(|(name, _)| *name));
            let list = names.iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
            return Err(ImportError::Choice(format!(
                "--column {quantity}={column}: no file has a column `{column}`{near}; there are {list}"
            )));
        };
        forced.insert((*found).to_owned(), meaning);
    }
    Ok(forced)
}

/// What a column is, and how much of its name that explains: as the user says, as the format says, as its name says.
fn read(name: &str, columns: &[&Column], forced: &BTreeMap<String, Meaning>) -> Option<(Meaning, f64)> {
    let first = columns.first()?;
    let unit = first.unit.as_deref();
    if let Some(meaning) = forced.get(name).copied().or(first.meaning) {
        return Some((meaning, 1.0));
    }
    by_name(name, unit)
}

/// What a name and its unit say.
fn by_name(name: &str, unit: Option<&str>) -> Option<(Meaning, f64)> {
    // One letter says too little where the unit is none of what it may stand for: `V [V]`.
    let sure = |r: &Reading, unit| is_stated(r.meaning, unit) || name.chars().count() > 1 && fits(r.meaning, unit);
    let by_name = reading(name).filter(|r| unit.is_none_or(|unit| sure(r, unit)));
    by_name.or_else(|| by_revolutions(name, unit?)).map(|r| (r.meaning, r.explained))
}

/// The order in which quantities are chosen: those with which others are compared come first.
fn turn(meaning: Meaning) -> usize {
    let first = [
        Meaning::Latitude,
        Meaning::Longitude,
        Meaning::Channel(Channel::X),
        Meaning::Channel(Channel::Y),
        Meaning::Channel(Channel::Psi),
        Meaning::GroundSpeed,
        Meaning::Course,
        Meaning::VelocityNorth,
        Meaning::Channel(Channel::WindSpeed),
        Meaning::Channel(Channel::ApparentWindSpeed),
    ];
    first.iter().position(|m| *m == meaning).unwrap_or(first.len())
}

/// The quantity with which one stays together: both are of one sensor.
fn leader(meaning: Meaning) -> Option<Meaning> {
    let channel = Meaning::Channel;
    Some(match meaning {
        Meaning::Longitude | Meaning::GroundSpeed => Meaning::Latitude,
        Meaning::Course => Meaning::GroundSpeed,
        Meaning::VelocityEast => Meaning::VelocityNorth,
        Meaning::WindAngle | Meaning::Channel(Channel::WindDirection) => channel(Channel::WindSpeed),
        Meaning::Channel(Channel::ApparentWindDirection) => channel(Channel::ApparentWindSpeed),
        Meaning::Channel(Channel::Y) => channel(Channel::X),
        Meaning::Channel(Channel::V) => channel(Channel::U),
        Meaning::Channel(Channel::VWater) => channel(Channel::UWater),
        Meaning::Channel(Channel::CurrentDirection) => channel(Channel::CurrentSpeed),
        Meaning::Channel(Channel::WaveDirection) => channel(Channel::WaveHeight),
        _ => return None,
    })
}

fn moves(columns: &[&Column]) -> bool {
    columns.iter().any(|c| c.v.iter().any(|v| *v != c.v[0]))
}

/// Names of which more than a half, or nearly all, is explained rank alike within these bounds: a word more or less is no evidence.
const NAMED: [f64; 3] = [0.95, 0.65, 0.35];
/// A column that agrees less with the data than this is contradicted by them: a direction at random has an agreement of nought and a
/// sound one of nearly one.
const CONTRADICTED: f64 = 0.4;
/// A column agrees as well as the best within this mean square: 1 % of the speed, 0.8 deg of a direction, by which sensors of one ship differ.
const CHANCE: f64 = 1e-4;

/// The first of the best.
fn best(list: &[Candidate<'_>], meaning: Meaning, partner: Option<&str>, sight: &Sight) -> usize {
    if list.len() < 2 {
        return 0;
    }
    let samples = |c: &Candidate<'_>| c.columns.iter().map(|c| c.v.len()).sum::<usize>();
    let most = list.iter().map(samples).max().unwrap_or(0);
    let stated =
        |c: &Candidate<'_>| c.columns.first().is_some_and(|c| c.unit.as_deref().is_some_and(|u| is_stated(meaning, u)));
    let any_stated = list.iter().any(stated);
    let agreements: Vec<Option<f64>> = list.iter().map(|c| sight.agreement(meaning, &c.columns)).collect();
    let least = agreements.iter().flatten().fold(1.0_f64, |least, a| least.min(1.0 - a));
    let scatter: Vec<f64> = list.iter().map(|c| if is_motion(meaning) { scatter(&c.columns) } else { 0.0 }).collect();
    let calm = scatter.iter().copied().fold(f64::INFINITY, f64::min);
    let rank = |i: &usize| {
        let (c, agreement) = (&list[*i], agreements[*i]);
        (
            c.forced,
            (5 * samples(c) > most, moves(&c.columns)),
            agreement.is_none_or(|a| a > CONTRADICTED),
            partner.map_or(1, |partner| shared(&source(partner), &source(c.name))),
            stated(c) || !any_stated || c.name.chars().count() > 1,
            NAMED.iter().filter(|bound| c.explained > **bound).count(),
            !is_second_choice(c.name),
            stated(c),
            agreement.map_or(0.5, |a| 1.0 - a) <= CLEARLY * least + CHANCE,
            scatter[*i] <= CLEARLY * calm,
            // In tenths: a few samples more are no better.
            10 * samples(c) / most.max(1),
        )
    };
    (0..list.len()).rev().max_by_key(rank).unwrap_or(0)
}

/// Whether a ship moves in a quantity, so that it changes smoothly.
fn is_motion(meaning: Meaning) -> bool {
    matches!(meaning, Meaning::Channel(Channel::Psi | Channel::R) | Meaning::GroundSpeed | Meaning::Course)
}

/// How far a column jumps from value to value, as a share of its size: its second differences below which most are. Of a sensor that repeats
/// its values the changes are few, and of any the leaps across north.
fn scatter(columns: &[&Column]) -> f64 {
    let second = |v: &[f64]| v[0] - 2.0 * v[1] + v[2];
    let all: Vec<f64> = columns.iter().flat_map(|c| c.v.windows(3).map(second)).collect();
    let sizes: Vec<f64> = columns.iter().flat_map(|c| c.v.iter().copied()).collect();
    size_below(&all, 0.95) / size_below(&sizes, 0.95).max(f64::MIN_POSITIVE)
}

/// How far two columns are of one sensor: 2 where both name the same, 0 where they name two, 1 where one of them names none.
fn shared(one: &str, other: &str) -> u8 {
    match (one, other) {
        ("", _) | (_, "") => 1,
        _ => 2 * u8::from(one == other),
    }
}

/// Takes the quantities with which others are compared from what was just chosen.
fn look(sight: &mut Sight, meaning: Meaning, chosen: &Chosen<'_>, choices: &Choices) {
    let of = |meaning: Meaning| chosen.get(&meaning).map(Vec::as_slice);
    let unit = |meaning: Meaning, columns: &[&Column]| {
        let unit = choices.units.get(meaning.name()).or(columns.first().and_then(|c| c.unit.as_ref()));
        unit.and_then(|u| Quantity::Angle.factor(u))
    };
    match meaning {
        Meaning::Longitude => {
            let both = of(Meaning::Latitude).zip(of(Meaning::Longitude));
            let places = both.and_then(|(lat, lon)| {
                places(lat, lon, [unit(Meaning::Latitude, lat), unit(Meaning::Longitude, lon)]).ok().flatten()
            });
            sight.track = places.and_then(|p| Track::of(&p.x, &p.y));
        }
        Meaning::Channel(Channel::Y) if sight.track.is_none() => {
            let [x, y] = [Channel::X, Channel::Y].map(|c| of(Meaning::Channel(c)));
            let signal = |columns| Signal::new(columns, 1.0, 0.0, false).0;
            sight.track = x.zip(y).and_then(|(x, y)| Track::of(&signal(x), &signal(y)));
        }
        Meaning::Channel(Channel::Psi) => sight.psi = of(meaning).map(|columns| heading(columns, sight.track.as_ref())),
        _ => {}
    }
}

/// Whether a unit is one of a quantity.
fn is_stated(meaning: Meaning, unit: &str) -> bool {
    meaning.quantity().factor(unit).is_some()
}

/// Whether a speed is in `ms`, which is written for m/s and for milliseconds, so that it says nothing.
fn says_nothing(meaning: Meaning, unit: &str) -> bool {
    unit == "ms" && meaning.quantity() == Quantity::Speed
}

/// Whether a quantity may be measured in a unit: a rudder in deg/s is no rudder angle. A unit that is not known is asked for.
fn fits(meaning: Meaning, unit: &str) -> bool {
    is_stated(meaning, unit)
        || !is_unit(unit)
        || says_nothing(meaning, unit)
        || (is_actuator(meaning) && is_share(unit))
}

/// Whether a quantity is of an actuator, which a logger may write as a share of its most.
fn is_actuator(meaning: Meaning) -> bool {
    use Channel::{Delta, DeltaOrder, N, NOrder};
    matches!(meaning, Meaning::Channel(Delta | DeltaOrder | N | NOrder))
}

/// Whether a unit is that of a share: `%`, `pct`, `% MCR`, `-`.
fn is_share(unit: &str) -> bool {
    unit.contains('%') || unit == "pct" || Quantity::Number.factor(unit).is_some()
}

/// The question for a unit that is not known, where no other column shows it: speeds and rates are compared with the track and the heading.
fn unknown_unit(meaning: Meaning, columns: &[&Column], choices: &Choices) -> Option<String> {
    let unit = columns.iter().find_map(|c| c.unit.as_deref().filter(|unit| !is_stated(meaning, unit)))?;
    let compared = matches!(meaning.quantity(), Quantity::Speed | Quantity::AngularRate) && needed(meaning);
    if compared || choices.units.contains_key(meaning.name()) {
        return None;
    }
    let (name, choices) = (meaning.name(), meaning.quantity().choices().replace(", ", " or "));
    let column = columns.first().map_or("", |c| c.name.as_str());
    if is_actuator(meaning) && is_share(unit) {
        return Some(of_share(meaning, column, top(columns)));
    }
    Some(format!(
        "the unit `{unit}` of column `{column}` ({}) is not known: pass `--unit {name}={choices}`, or how much one is, such as `--unit {name}='0.1 {}'`{}, or write the column in one of these",
        meaning.words(),
        meaning.quantity().si(),
        full_turn(meaning, largest(columns))
    ))
}
