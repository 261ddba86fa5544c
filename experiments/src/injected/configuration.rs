//! How a set is given to the diagnosis: which recordings, how cut, turned, modelled and listed. None of it is physics that is
//! injected: between two configurations of one set the truth is the same.

use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::error::InjectedError;
use super::set::{Set, table};

/// Which recordings are unseen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Unseen {
    /// Those of the committed study.
    Studied,
    /// Those on which the committed study trains.
    Swapped,
    /// None.
    None,
}

/// How the recordings are turned.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Turned {
    /// As recorded.
    No,
    /// All by one angle.
    Together,
    /// Each by an angle of its own.
    Each,
}

/// What the study says of sessions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Sessions {
    /// Nothing.
    None,
    /// One for all.
    One,
    /// Two, run by run in turn.
    Two,
    /// As recorded.
    Recorded,
}

/// What the study says of a wind that was measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Wind {
    /// Nothing: the columns are withheld, or there are none.
    Withheld,
    /// The columns are there, the model has no load for them.
    Given,
    /// The columns are there and the model has a load for them.
    Modelled,
}

/// How a set is given to the diagnosis.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Configuration {
    /// The set.
    pub set: Set,
    /// Recordings, by their place in the study of the set.
    pub runs: Vec<usize>,
    /// Which of them are unseen.
    pub unseen: Unseen,
    /// Length of windows \[s\]; whole recordings if absent.
    pub window: Option<f64>,
    /// Grid step \[s\].
    pub step: f64,
    /// Part of each recording that is used, as shares of its duration.
    pub span: [f64; 2],
    /// How they are turned.
    pub turned: Turned,
    /// Whether port and starboard are exchanged, of the ship too.
    pub mirrored: bool,
    /// Factor on the start value of the resistance.
    pub start: f64,
    /// Whether the coefficients of the hull are free.
    pub freed: bool,
    /// Sessions.
    pub sessions: Sessions,
    /// Wind.
    pub wind: Wind,
    /// Whether the origins of positions and of time are moved.
    pub moved: [bool; 2],
    /// Whether the recordings are listed in the opposite order.
    pub reversed: bool,
    /// Whether each recording is listed as two halves.
    pub cut: bool,
    /// Length of the ship over its true length; all else follows by Froude's law.
    pub scale: f64,
    /// Threads of the diagnosis.
    pub threads: usize,
    /// Seed of the angles.
    pub seed: u64,
}

fn one_of<T: Copy>(rng: &mut ChaCha8Rng, values: &[T], otherwise: T) -> T {
    values.get(rng.random_range(0..values.len().max(1))).copied().unwrap_or(otherwise)
}

impl Configuration {
    /// Draws one: every factor by itself.
    ///
    /// # Errors
    /// [`InjectedError::Case`] if the committed study is not as expected.
    pub fn draw(set: Set, seed: u64) -> Result<Self, InjectedError> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let (facts, listed) = (set.facts(), set.runs()?);
        let window = set.window()?;
        // Both sides of the split, so that it can be swapped.
        let mut runs = Vec::new();
        for test in [false, true] {
            let mut side: Vec<usize> = (0..listed.len()).filter(|i| listed[*i].test == test).collect();
            side.shuffle(&mut rng);
            let most = side.len().min(if test { 4 } else { 8 });
            // A diagnosis of fewer than four runs says so and nothing else.
            let least = most.min(4);
            side.truncate(rng.random_range(least..=most));
            runs.extend(side);
        }
        runs.sort_unstable();
        let turned = one_of(&mut rng, &[Turned::No, Turned::Together, Turned::Each], Turned::No);
        let recorded = if set == Set::Esso { Sessions::Recorded } else { Sessions::Two };
        let sessions = one_of(&mut rng, &[Sessions::None, Sessions::One, Sessions::Two, recorded], Sessions::None);
        let wind = one_of(&mut rng, &[Wind::Modelled, Wind::Modelled, Wind::Withheld], Wind::Modelled);
        let unseen = [Unseen::Studied, Unseen::Studied, Unseen::Swapped, Unseen::Swapped, Unseen::None];
        let unseen = one_of(&mut rng, &unseen, Unseen::Studied);
        // MARIN's two long turning circles alone are too few unless they are cut in windows.
        let cut = [Some(window), Some(window), Some(window), Some(0.5 * window)];
        let lengths = [None, None, Some(window), Some(0.5 * window)];
        let few = set == Set::Marin && unseen == Unseen::Swapped;
        Ok(Self {
            set,
            runs,
            unseen,
            window: one_of(&mut rng, if few { &cut } else { &lengths }, None),
            step: one_of(&mut rng, facts.steps, 1.0),
            span: one_of(&mut rng, &[[0.0, 1.0], [0.0, 1.0], [0.0, 0.7], [0.2, 1.0]], [0.0, 1.0]),
            turned,
            mirrored: rng.random_range(0..4) == 0,
            start: one_of(&mut rng, &[0.0, 0.5, 1.0, 1.0, 1.5], 1.0),
            freed: rng.random_range(0..3) == 0,
            // One wind blows over a session: recordings that are turned apart share none.
            sessions: if set == Set::Esso && turned == Turned::Each { Sessions::None } else { sessions },
            wind: if facts.calm { Wind::Withheld } else { wind },
            moved: [false; 2],
            reversed: false,
            cut: false,
            scale: 1.0,
            threads: 1,
            seed,
        })
    }

    /// Angle by which a recording is turned \[rad\].
    pub fn angle(&self, run: usize) -> f64 {
        let stream = match self.turned {
            Turned::No => return 0.0,
            Turned::Together => 0,
            Turned::Each => run as u64 + 1,
        };
        ChaCha8Rng::seed_from_u64(self.seed.wrapping_add(stream)).random_range(0.0..std::f64::consts::TAU)
    }

    /// Name of a recording in the study.
    pub fn run_name(run: usize) -> String {
        format!("run {:02}", run + 1)
    }

    /// Session of the recording at a place of the list; its own name where the study gives none.
    pub fn session(&self, place: usize, recorded: Option<&str>) -> String {
        match self.sessions {
            Sessions::None => self.runs.get(place).map(|run| Self::run_name(*run)).unwrap_or_default(),
            Sessions::One => "day 1".to_owned(),
            Sessions::Two => format!("day {}", place % 2 + 1),
            Sessions::Recorded => recorded.unwrap_or("day 1").to_owned(),
        }
    }

    /// Whether a recording is unseen, of which the committed study says `test`.
    pub fn is_unseen(&self, test: bool) -> bool {
        match self.unseen {
            Unseen::Studied => test,
            Unseen::Swapped => !test,
            Unseen::None => false,
        }
    }

    /// The ship file: mirrored and scaled as the recordings are.
    ///
    /// # Errors
    /// [`InjectedError::Case`] if the committed file is no TOML.
    pub fn ship(&self) -> Result<toml::Table, InjectedError> {
        let mut ship = table(self.set.facts().ship, "ship file")?;
        ship.insert("name".to_owned(), "ship".into());
        ship.remove("source");
        if self.mirrored {
            change(&mut ship, &["parameters", ASYMMETRY], |v| -v);
        }
        if self.scale != 1.0 {
            for (path, power) in DIMENSIONS {
                change(&mut ship, path, |v| v * self.scale.powi(*power));
            }
        }
        Ok(ship)
    }

    /// The model file.
    ///
    /// # Errors
    /// [`InjectedError::Case`] if a committed file is no TOML.
    pub fn model(&self) -> Result<toml::Table, InjectedError> {
        let text = match (self.wind, self.freed) {
            (Wind::Modelled, true) => include_str!("../../studies/esso_osaka/freed_wind.toml"),
            (Wind::Modelled, false) => include_str!("../../studies/esso_osaka/wind.toml"),
            (_, true) => self.set.facts().freed,
            (_, false) => "form = \"regular\"\n",
        };
        let mut model = table(text, "model file")?;
        model.insert("name".to_owned(), "base model".into());
        if self.mirrored {
            change(&mut model, &["parameters", ASYMMETRY, "prior", "mean"], |v| -v);
        }
        let resistance = self.ship()?.get("parameters").and_then(|p| p.get(RESISTANCE)).and_then(toml::Value::as_float);
        if let Some(value) = resistance.filter(|_| self.start != 1.0) {
            let parameters = model.entry("parameters").or_insert_with(|| toml::Table::new().into());
            if let Some(parameters) = parameters.as_table_mut() {
                let start = toml::Table::from_iter([("value".to_owned(), toml::Value::Float(self.start * value))]);
                parameters.insert(RESISTANCE.to_owned(), start.into());
            }
        }
        Ok(model)
    }

    /// In words, for tables.
    pub fn words(&self) -> String {
        let runs = self.runs.iter().map(|r| (r + 1).to_string()).collect::<Vec<_>>().join(" ");
        let mut words = vec![format!("runs {runs}"), format!("unseen {:?}", self.unseen).to_lowercase()];
        words.push(self.window.map_or("whole".to_owned(), |w| format!("windows of {w} s")));
        words.push(format!("step {} s", self.step));
        let mut say = |said: bool, text: String| words.extend(said.then_some(text));
        say(self.span != [0.0, 1.0], format!("from {} to {}", self.span[0], self.span[1]));
        say(self.turned != Turned::No, format!("turned {:?}", self.turned).to_lowercase());
        say(self.mirrored, "mirrored".to_owned());
        say(self.start != 1.0, format!("start x{}", self.start));
        say(self.freed, "hull free".to_owned());
        say(true, format!("sessions {:?}", self.sessions).to_lowercase());
        say(!self.set.facts().calm, format!("wind {:?}", self.wind).to_lowercase());
        say(self.moved[0], "origin moved".to_owned());
        say(self.moved[1], "time moved".to_owned());
        say(self.reversed, "listed backwards".to_owned());
        say(self.cut, "cut in halves".to_owned());
        say(self.scale != 1.0, format!("scaled x{}", self.scale));
        say(self.threads != 1, format!("{} threads", self.threads));
        words.join("; ")
    }
}

/// The parameter of the committed ship files that differs between port and starboard.
const ASYMMETRY: &str = "flow.asymmetry";
/// The parameter whose start value is varied: free, and without a prior.
const RESISTANCE: &str = "resistance.quadratic";

/// Numbers of a ship file that have a dimension, with the power of the length by which they grow under Froude's law.
const DIMENSIONS: &[(&[&str], i32)] = &[
    (&["hull", "lpp"], 1),
    (&["hull", "breadth"], 1),
    (&["hull", "draught"], 1),
    (&["hull", "mass"], 3),
    (&["hull", "x_g"], 1),
    (&["propeller", "diameter"], 1),
    (&["propeller", "x"], 1),
    (&["rudder", "area"], 2),
    (&["rudder", "span"], 1),
    (&["rudder", "x"], 1),
    (&["above_water", "frontal_area"], 2),
    (&["above_water", "lateral_area"], 2),
    (&["above_water", "length_overall"], 1),
    (&["parameters", RESISTANCE], 2),
];

/// Changes a number inside tables of tables, if it is there.
pub(super) fn change(table: &mut toml::Table, path: &[&str], of: impl Fn(f64) -> f64) {
    let Some((last, folders)) = path.split_last() else { return };
    let mut at = Some(table);
    for name in folders {
        at = at.and_then(|t| t.get_mut(*name)).and_then(toml::Value::as_table_mut);
    }
    let Some(value) = at.and_then(|t| t.get_mut(*last)) else { return };
    let number = value.as_float().or_else(|| value.as_integer().map(|i| i as f64));
    if let Some(number) = number {
        *value = toml::Value::Float(of(number));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::injected::set::SETS;

    #[test]
    fn a_seed_draws_one_configuration_and_many_seeds_every_level() {
        for set in SETS {
            let all: Vec<Configuration> = (0..100).map(|seed| Configuration::draw(set, seed).unwrap()).collect();
            assert_eq!(all[7], Configuration::draw(set, 7).unwrap());
            for turned in [Turned::No, Turned::Together, Turned::Each] {
                assert!(all.iter().any(|c| c.turned == turned));
            }
            let listed = set.runs().unwrap();
            for c in &all {
                let unseen = |test: bool| c.runs.iter().filter(|r| listed[**r].test == test).count();
                assert!(unseen(false) >= 4 && unseen(true) >= if set == Set::Marin { 2 } else { 4 }, "{}", c.words());
                assert!(c.wind != Wind::Modelled || !set.facts().calm);
            }
        }
    }

    #[test]
    fn recordings_are_turned_by_nothing_one_angle_or_one_each() {
        let base = Configuration::draw(Set::Hsva, 3).unwrap();
        let angles = |turned: Turned| {
            let c = Configuration { turned, ..base.clone() };
            [c.angle(0), c.angle(1)]
        };
        assert_eq!(angles(Turned::No), [0.0, 0.0]);
        let [a, b] = angles(Turned::Together);
        assert!(a == b && a != 0.0);
        let [a, b] = angles(Turned::Each);
        assert!(a != b);
    }

    #[test]
    fn ship_and_model_follow_the_mirror_the_scale_and_the_start() {
        let c = Configuration { mirrored: true, scale: 4.0, start: 0.5, ..Configuration::draw(Set::Hsva, 3).unwrap() };
        let (ship, model) = (c.ship().unwrap(), c.model().unwrap());
        let number = |t: &toml::Table, path: [&str; 2]| t[path[0]][path[1]].as_float().unwrap();
        assert_eq!(number(&ship, ["parameters", ASYMMETRY]), 0.1225);
        assert_eq!(number(&ship, ["hull", "lpp"]), 28.0);
        assert_eq!(number(&ship, ["parameters", RESISTANCE]), 24.9 * 16.0);
        assert_eq!(model["parameters"][RESISTANCE]["value"].as_float(), Some(0.5 * 24.9 * 16.0));
    }
}
