//! The parts of an effect: its entry in the catalogue, its random numbers, its view of an instant, and its action.
//! The effects are in the files beside this one; `sail` lets them act and `seal` keeps them secret.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use crate::conceal::sailing::craft::Craft;
use crate::conceal::sailing::track::Fine;
use crate::conceal::sailing::tweak::Tweak;
use crate::truth::motion::{Inputs, State};

/// What kind of answer an effect calls for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Class {
    /// A force on the ship or a lag in its machinery that the diagnosis has in its catalogue.
    Force,
    /// A defect of a sensor that the diagnosis has in its catalogue.
    Sensor,
    /// Force that does not repeat: to be called random, not named.
    Random,
    /// In the catalogue, but the fitted parameters can mimic it when it acts in all sessions: never to be named then.
    Absorbed,
    /// Not in the catalogue of the diagnosis.
    Withheld,
}

/// How the size of an effect is compared with the parameters that a diagnosis reports.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Compare {
    /// Its law differs too much from the fitter's for a comparison.
    No,
    /// The size is the parameter of this name (the part after the dot).
    Size(&'static str),
    /// [`Physics::truth`] gives the true values of several or converted parameters.
    Truth,
}

/// An effect of the catalogue.
#[derive(Debug)]
pub struct Entry {
    /// Name on the command line and in the manifest.
    pub name: &'static str,
    /// What kind of answer it calls for.
    pub class: Class,
    /// Names of the diagnosis' catalogue that are right, the exact one first.
    pub accepted: &'static [&'static str],
    /// Names that are wrong but near: the nearest mechanism of a catalogue without this one.
    pub near: &'static [&'static str],
    /// Unit of the size.
    pub unit: &'static str,
    /// Default size; the sign is part of it.
    pub size: f64,
    /// Largest realistic size.
    pub most: f64,
    /// Comparison with reported parameters.
    pub compare: Compare,
    /// Whether it moves the actuators away from their orders.
    pub moves_actuators: bool,
    /// Whether it can act in a ship of the MMG family, whose structure already contains some effects.
    pub in_mmg: bool,
    /// Whether hull, propeller and rudder coefficients, which are known from charts only, can mimic it in part, so that it is
    /// identifiable only against sessions without it.
    pub reference: bool,
    /// The law and its source.
    pub law: &'static str,
    /// Makes the effect at a size; directions, periods and places are drawn.
    pub build: fn(f64, &mut Draw<'_>) -> Box<dyn Physics>,
}

/// A force that can act in every ship and is visible without a reference: an entry names only what differs.
pub const FORCE: Entry = Entry {
    name: "",
    class: Class::Force,
    accepted: &[],
    near: &[],
    unit: "-",
    size: 0.0,
    most: 0.0,
    compare: Compare::No,
    moves_actuators: false,
    in_mmg: true,
    reference: false,
    law: "",
    build: |_, _| Box::new(Nothing),
};

/// A sensor defect.
pub const SENSOR: Entry = Entry { class: Class::Sensor, ..FORCE };

/// An effect that is in no catalogue of the diagnosis.
pub const WITHHELD: Entry = Entry { class: Class::Withheld, ..FORCE };

/// No effect at all.
struct Nothing;

impl Physics for Nothing {}

/// The random numbers of an effect, for its directions, periods and places.
pub struct Draw<'a> {
    /// A stream of the effect's own: no other number changes when it draws more or less.
    pub rng: &'a mut ChaCha8Rng,
    /// Number of runs.
    pub runs: usize,
    /// Ship's length \[m\].
    pub length: f64,
    /// Length of a run \[s\].
    pub duration: f64,
}

impl Draw<'_> {
    /// A number between two bounds.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        self.rng.random_range(low..high)
    }

    /// A direction in 0..2 pi.
    pub fn direction(&mut self) -> f64 {
        self.between(0.0, 2.0 * std::f64::consts::PI)
    }

    /// -1 or 1.
    pub fn side(&mut self) -> f64 {
        if self.rng.random_range(0.0..1.0) < 0.5 { -1.0 } else { 1.0 }
    }

    /// For every run, whether it is one of about `share` of them (at least one run).
    pub fn some_runs(&mut self, share: f64) -> Vec<bool> {
        let mut chosen: Vec<bool> = (0..self.runs).map(|_| self.rng.random_range(0.0..1.0) < share).collect();
        let least = self.rng.random_range(0..self.runs);
        if !chosen.contains(&true) {
            chosen[least] = true;
        }
        chosen
    }
}

/// One instant of one run, as an effect sees it.
#[derive(Clone, Copy)]
pub struct Instant<'a> {
    /// Index of the run.
    pub run: usize,
    /// Time from the first row of the run \[s\].
    pub t: f64,
    /// Time of the campaign, running on from session to session \[s\].
    pub clock: f64,
    /// State over ground.
    pub state: State,
    /// Velocity through the water \[u, v, r\].
    pub water: [f64; 3],
    /// Actual positions of the actuators.
    pub inputs: Inputs,
    /// Heading at the start of the run \[rad\].
    pub course: f64,
    /// Two independent gust processes of unit variance and 20 s, for the effect's use.
    pub gust: [f64; 2],
    /// Memory of the effect, advanced by [`Physics::remember`].
    pub memory: [f64; 2],
    /// The ship without any effect.
    pub craft: &'a Craft,
}

/// A time window of an effect of limited duration: run index, start and end \[s\].
pub type Window = (usize, f64, f64);

/// An environment channel that a case gives: name and unit as in a CSV header, and its value at an instant.
pub struct ChannelOf<'a> {
    /// `depth`
    pub name: &'static str,
    /// `m`
    pub unit: &'static str,
    /// Value in that unit.
    pub value: Box<dyn Fn(&Instant<'_>) -> f64 + 'a>,
}

/// The action of an effect. Every method does nothing by default.
pub trait Physics: Send + Sync {
    /// Changes the ship's coefficients at this instant.
    fn alter(&self, _at: &Instant<'_>, _tweak: &mut Tweak) {}

    /// Force on the ship: X, Y \[N\] and N \[N m\] on the body axes about midship.
    fn force(&self, _at: &Instant<'_>) -> [f64; 3] {
        [0.0; 3]
    }

    /// Velocity of the water over ground, towards (north, east) \[m/s\].
    fn current(&self, _clock: f64) -> [f64; 2] {
        [0.0; 2]
    }

    /// Moves the actuators: orders run linearly `from` -> `to` over `h` seconds, the actuators start `at`; `actual` has
    /// the positions that they would reach without this effect, and then with it.
    fn actuate(&self, _h: f64, _orders: [Inputs; 2], _at: &Inputs, _state: &State, _actual: &mut Inputs) {}

    /// Advances the effect's memory by `h` seconds.
    fn remember(&self, _h: f64, _at: &Instant<'_>, _memory: &mut [f64; 2]) {}

    /// Changes the reported state `y` at row `row`, which contains the true state first; `fine` is the track between rows.
    fn measure(&self, _clock: f64, _row: usize, _fine: &Fine, _y: &mut [f64; 6]) {}

    /// Environment channels that are recorded with it.
    fn channels(&self) -> Vec<ChannelOf<'_>> {
        Vec::new()
    }

    /// True values of the parameters that the diagnosis may report: name (after the dot), value, unit.
    fn truth(&self) -> Vec<(&'static str, f64, &'static str)> {
        Vec::new()
    }

    /// Its time windows, for effects of limited duration.
    fn windows(&self) -> Vec<Window> {
        Vec::new()
    }
}

/// (north, east) components of a vector of this size in this direction.
pub fn vector(size: f64, direction: f64) -> [f64; 2] {
    [size * direction.cos(), size * direction.sin()]
}

/// 0 before `from`, 1 after `to`, a straight line with rounded ends between.
pub fn ramp(x: f64, from: f64, to: f64) -> f64 {
    let s = ((x - from) / (to - from)).clamp(0.0, 1.0);
    s * s * (3.0 - 2.0 * s)
}
