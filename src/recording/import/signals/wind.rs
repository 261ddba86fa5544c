//! Whether a recorded wind is what its columns were taken for: a true wind does not turn with the ship.
//! It reports; what a column is taken for is decided elsewhere.

use super::log::Meaning;
use super::motion::Track;
use super::signal::Signal;
use crate::recording::Channel;
use std::collections::BTreeMap;

/// How speed and direction of a wind may be meant.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Reading {
    /// Measured on the moving ship, and not over ground.
    apparent: bool,
    /// The direction counts from the bow, and not from north.
    from_bow: bool,
    /// It counts to port.
    to_port: bool,
}

const TRUE_FROM_NORTH: Reading = Reading { apparent: false, from_bow: false, to_port: false };
const TRUE_FROM_BOW: Reading = Reading { apparent: false, from_bow: true, to_port: false };
const APPARENT: Reading = Reading { apparent: true, from_bow: true, to_port: false };
const READINGS: [Reading; 6] = [
    TRUE_FROM_NORTH,
    TRUE_FROM_BOW,
    APPARENT,
    Reading { apparent: true, from_bow: false, to_port: false },
    Reading { apparent: true, from_bow: true, to_port: true },
    Reading { apparent: false, from_bow: true, to_port: true },
];

/// A wind is steadier in one reading than in another where its variance is so many times less: gusts are the same in both.
const STEADIER: f64 = 3.0;
/// Length of the mean of the headings, of 1, above which the ship hardly turned and nothing turns with it.
const ONE_WAY: f64 = 0.7;
/// Samples from which this is judged.
const ENOUGH: usize = 60;
/// Two records of one wind contradict each other where their difference is this share of the wind.
const APART: f64 = 0.7;

/// What was taken as a wind.
struct Wind {
    speed: Meaning,
    direction: Meaning,
    reading: Reading,
}

const WINDS: [Wind; 3] = [
    Wind {
        speed: Meaning::Channel(Channel::WindSpeed),
        direction: Meaning::Channel(Channel::WindDirection),
        reading: TRUE_FROM_NORTH,
    },
    Wind { speed: Meaning::Channel(Channel::WindSpeed), direction: Meaning::WindAngle, reading: TRUE_FROM_BOW },
    Wind {
        speed: Meaning::Channel(Channel::ApparentWindSpeed),
        direction: Meaning::Channel(Channel::ApparentWindDirection),
        reading: APPARENT,
    },
];

/// What the track says against the winds as they were taken. `names` are the columns by quantity.
pub fn doubts(by: &BTreeMap<Meaning, Signal>, track: &Track, names: &impl Fn(Meaning) -> String) -> Vec<String> {
    let Some(psi) = by.get(&Meaning::Channel(Channel::Psi)) else { return Vec::new() };
    let mut doubts = Vec::new();
    let mut over_ground: Vec<Vec<[f64; 2]>> = Vec::new();
    for wind in &WINDS {
        let (Some(speed), Some(direction)) = (by.get(&wind.speed), by.get(&wind.direction)) else { continue };
        let samples = Samples::new(track, psi, speed, direction);
        over_ground.push(samples.over_ground(wind.reading));
        let Some(better) = samples.steadier(wind.reading) else { continue };
        let [speed, direction] = [wind.speed, wind.direction].map(names);
        let (taken, found) = (words(wind.reading), words(better));
        let next = match better {
            TRUE_FROM_NORTH => format!("`--column wind_speed=\"{speed}\" --column wind_direction=\"{direction}\"`"),
            TRUE_FROM_BOW => format!("`--column wind_speed=\"{speed}\" --column wind_angle=\"{direction}\"`"),
            APPARENT => {
                format!("`--column apparent_wind_speed=\"{speed}\" --column apparent_wind_direction=\"{direction}\"`")
            }
            Reading { from_bow: true, .. } => "`sign = -1` for the direction in columns.toml".to_owned(),
            _ => "subtract the heading from the direction in the log".to_owned(),
        };
        doubts.push(format!(
            "WARNING: the wind of `{speed}` and `{direction}`, taken as {taken}, turns with the ship; as {found} it is steady: {next}"
        ));
    }
    if let ([first, second], true) = (&over_ground[..], doubts.is_empty())
        && contradict(first, second)
    {
        let text = "WARNING: true and apparent wind contradict each other: with the ship's velocity the apparent wind is not the true one; check units, and whether one of the directions is that to which it blows";
        doubts.push(text.to_owned());
    }
    doubts
}

fn words(reading: Reading) -> String {
    let kind = if reading.apparent { "an apparent wind" } else { "a true wind" };
    let from = match (reading.from_bow, reading.to_port) {
        (false, _) => "from north",
        (true, false) => "from the bow, to starboard",
        (true, true) => "from the bow, to port",
    };
    format!("{kind} with its direction counted {from}")
}

/// Whether two records of the wind over ground, at the times of the track, are not of one wind.
fn contradict(first: &[[f64; 2]], second: &[[f64; 2]]) -> bool {
    let (mut apart, mut size, mut count) = (0.0, 0.0, 0);
    for (a, b) in first.iter().zip(second) {
        let square = (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2);
        if square.is_finite() {
            apart += square;
            size += 0.5 * (a[0] * a[0] + a[1] * a[1] + b[0] * b[0] + b[1] * b[1]);
            count += 1;
        }
    }
    count >= ENOUGH && apart > APART * APART * size
}

/// Wind and motion at the times of the track.
struct Samples {
    /// Recorded speed and direction, heading, and velocity over ground to north and east; NaN where one is missing.
    rows: Vec<[f64; 5]>,
}

impl Samples {
    fn new(track: &Track, psi: &Signal, speed: &Signal, direction: &Signal) -> Self {
        let step = track.speed.step;
        let row = |(i, t): (usize, &f64)| {
            [speed.at(*t, step), direction.at(*t, step), psi.at(*t, step), track.north.v[i], track.east.v[i]]
        };
        Self { rows: track.speed.t.iter().enumerate().map(row).collect() }
    }

    /// The velocity of the air over ground, to north and east \[m/s\].
    fn over_ground(&self, reading: Reading) -> Vec<[f64; 2]> {
        let of = |[speed, direction, psi, north, east]: &[f64; 5]| {
            let direction = if reading.to_port { -direction } else { *direction };
            let (sin, cos) = if reading.from_bow { psi + direction } else { direction }.sin_cos();
            let moved = f64::from(u8::from(reading.apparent));
            [moved * north - speed * cos, moved * east - speed * sin]
        };
        self.rows.iter().map(of).collect()
    }

    /// Variance of the wind over ground, of both components; `None` of too few.
    fn variance(&self, reading: Reading) -> Option<f64> {
        let all: Vec<[f64; 2]> =
            self.over_ground(reading).into_iter().filter(|w| w[0].is_finite() && w[1].is_finite()).collect();
        if all.len() < ENOUGH {
            return None;
        }
        let count = all.len() as f64;
        let mean: [f64; 2] = std::array::from_fn(|c| all.iter().map(|w| w[c]).sum::<f64>() / count);
        Some(all.iter().map(|w| (w[0] - mean[0]).powi(2) + (w[1] - mean[1]).powi(2)).sum::<f64>() / count)
    }

    /// The reading in which the wind is steady, where that is not the one that was taken.
    fn steadier(&self, taken: Reading) -> Option<Reading> {
        let headings: Vec<f64> = self.rows.iter().filter(|r| r.iter().all(|v| v.is_finite())).map(|r| r[2]).collect();
        let mean = |f: fn(f64) -> f64| headings.iter().map(|psi| f(*psi)).sum::<f64>() / headings.len().max(1) as f64;
        if mean(f64::sin).hypot(mean(f64::cos)) > ONE_WAY {
            return None;
        }
        let own = self.variance(taken)?;
        let of = |reading: &Reading| Some((*reading, self.variance(*reading)?));
        let best = READINGS.iter().filter_map(of).min_by(|a, b| a.1.total_cmp(&b.1))?;
        (best.0 != taken && STEADIER * best.1 < own).then_some(best.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::import::signals::signal::unwrap;
    use std::f64::consts::TAU;

    /// A ship that turns twice in a wind of 8 m/s from 240 deg, which veers by some degrees, and what its anemometer shows in a reading.
    fn by(reading: Reading, speed: Meaning, direction: Meaning) -> BTreeMap<Meaning, Signal> {
        let mut all: BTreeMap<Meaning, Signal> = BTreeMap::new();
        let mut put = |meaning: Meaning, t: f64, v: f64| {
            let signal = all.entry(meaning).or_insert_with(|| Signal { step: 1.0, ..Signal::default() });
            signal.t.push(t);
            signal.v.push(v);
        };
        let (u, rate) = (5.0, TAU / 300.0);
        for i in 0..600 {
            let t = f64::from(i);
            let psi = rate * t;
            let from = (240.0 + 5.0 * (0.05 * t).sin()).to_radians();
            let air = [-8.0 * from.cos(), -8.0 * from.sin()];
            let on_board = [air[0] - u * psi.cos(), air[1] - u * psi.sin()];
            let [north, east] = if reading.apparent { on_board } else { air };
            let absolute = (-east).atan2(-north);
            let angle = if reading.from_bow { absolute - psi } else { absolute };
            put(Meaning::Channel(Channel::X), t, u / rate * psi.sin());
            put(Meaning::Channel(Channel::Y), t, u / rate * (1.0 - psi.cos()));
            put(Meaning::Channel(Channel::Psi), t, psi);
            put(speed, t, north.hypot(east));
            put(direction, t, if reading.to_port { -angle } else { angle });
        }
        if let Some(direction) = all.get_mut(&direction) {
            unwrap(&mut direction.v);
        }
        all
    }

    /// The doubts, each column by the name of its quantity.
    fn doubted(by: &BTreeMap<Meaning, Signal>) -> Vec<String> {
        let [x, y] = [Channel::X, Channel::Y].map(|c| &by[&Meaning::Channel(c)]);
        doubts(by, &Track::of(x, y).unwrap(), &|meaning| meaning.name().to_owned())
    }

    #[test]
    fn a_wind_that_turns_with_the_ship_is_doubted_and_the_reading_in_which_it_is_steady_named() {
        for wind in &WINDS {
            for reading in READINGS {
                let found = doubted(&by(reading, wind.speed, wind.direction));
                if reading == wind.reading {
                    assert!(found.is_empty(), "{reading:?}: {found:?}");
                } else {
                    assert!(found.len() == 1 && found[0].contains(&words(reading)), "{reading:?}: {found:?}");
                }
            }
        }
    }

    #[test]
    fn true_and_apparent_wind_that_are_not_of_one_wind_contradict_each_other() {
        let [own, _, apparent] = &WINDS;
        let mut both = by(own.reading, own.speed, own.direction);
        both.extend(by(apparent.reading, apparent.speed, apparent.direction));
        assert!(doubted(&both).is_empty());
        // The true wind is written as the direction to which it blows, which is as steady.
        if let Some(direction) = both.get_mut(&own.direction) {
            direction.v.iter_mut().for_each(|d| *d += 0.5 * TAU);
        }
        let found = doubted(&both);
        assert!(found.len() == 1 && found[0].contains("contradict"), "{found:?}");
    }
}
