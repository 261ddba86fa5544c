//! Concealed cases: recordings of a ship under an effect the diagnosis is not told, and a sealed manifest that tells the judge.
//! The generator shares no term, integrator or coefficient with the library's model; only judge and campaign read its output.
//!
//! A case is a [`Spec`]: a truth family, effects with their strength, a background, a design and a seed. [`Case::make`] sails it;
//! [`Case::write`] writes `study/` (all that the diagnosis may see) and `sealed/manifest.json` (what the judge opens afterwards).
//! Random streams are split by purpose, so that a case with and without its effect has the same ship, plans, gusts and noise.

pub mod baselines;
pub mod campaign;
pub mod craft;
pub mod design;
pub mod effects;
pub mod judge;
pub mod meter;
pub mod noise;
pub mod runner;
pub mod sail;
pub mod seal;
pub mod strength;

use std::path::PathBuf;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use craft::{Craft, Family, LENGTH};
use design::{Design, PERIOD, Plan, STEPS};
use effects::{Class, Draw, Entry};
use noise::{Noise, Rows};
use sail::{Active, Method, Track, World};

/// Why a case could not be made, written or judged.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ConcealError {
    /// No such effect.
    #[error("unknown effect `{name}`; the effects are {known}")]
    UnknownEffect {
        /// Name given.
        name: String,
        /// All names.
        known: String,
    },
    /// The effect is part of the family's own structure.
    #[error("effect `{effect}` cannot be concealed in the {family} family, which contains it; choose --family hd")]
    NotInFamily {
        /// Effect.
        effect: &'static str,
        /// Family.
        family: &'static str,
    },
    /// A size that cannot be.
    #[error("size {size} {unit} of effect `{effect}` must lie in 0 to {most}")]
    Size {
        /// Effect.
        effect: &'static str,
        /// Size given.
        size: f64,
        /// Its unit.
        unit: &'static str,
        /// Largest size.
        most: f64,
    },
    /// The effect cannot be seen at any size tried.
    #[error("effect `{effect}` at {size} {unit} has a signal-to-noise ratio of {snr:.3}; give --size instead of --snr")]
    Invisible {
        /// Effect.
        effect: &'static str,
        /// Size tried.
        size: f64,
        /// Its unit.
        unit: &'static str,
        /// What came of it.
        snr: f64,
    },
    /// The meter of the signal-to-noise ratio failed.
    #[error("cannot measure the signal-to-noise ratio: {message}")]
    Meter {
        /// What it said.
        message: String,
    },
    /// A file could not be read or written.
    #[error("{path}: {source}", path = path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A file is not what it should be.
    #[error("{path}: {message}", path = path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        message: String,
    },
    /// The manifest or a recording is not the one that was sealed.
    #[error("{path}: SHA-256 is {found}, sealed was {sealed}; the case has been changed and cannot be judged", path = path.display())]
    Broken {
        /// The file.
        path: PathBuf,
        /// Digest found.
        found: String,
        /// Digest sealed.
        sealed: String,
    },
}

/// How strong an effect is to be.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Strength {
    /// The default size times this factor.
    Times(f64),
    /// This physical size, in the unit of the effect.
    Size(f64),
    /// The size that gives this signal-to-noise ratio.
    Snr(f64),
}

/// What surrounds the effect: ordinary sea and sensors, or one of the nulls' troubles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum Background {
    /// Small gusts, ordinary sensors.
    Ordinary,
    /// Gusts of 4 kN, 4 kN and 120 kN m.
    Gusts,
    /// Position noise of 1.5 m, nearly all of it coloured with 30 s.
    Coloured,
    /// Every hull coefficient off by up to 10 %.
    Hull,
    /// Data made by explicit Euler steps of one row interval.
    Euler,
    /// One row in a hundred with an outlier of position or heading.
    Outliers,
    /// Two dropouts in every run.
    Dropouts,
}

impl Background {
    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ordinary => "ordinary",
            Self::Gusts => "gusts",
            Self::Coloured => "coloured",
            Self::Hull => "hull",
            Self::Euler => "euler",
            Self::Outliers => "outliers",
            Self::Dropouts => "dropouts",
        }
    }
}

/// What is to be concealed, and where.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Spec {
    /// Truth family.
    pub family: Family,
    /// Effects and their strength; none for a null.
    pub effects: Vec<(String, Strength)>,
    /// Background.
    pub background: Background,
    /// Design.
    pub design: Design,
    /// Whether the effects act in the second half of the sessions only, the first half being a reference.
    pub contrast: bool,
    /// Seed.
    pub seed: u64,
}

impl Spec {
    /// A null of this family and seed: nothing concealed, ordinary background, standard design.
    pub fn null(family: Family, seed: u64) -> Self {
        Self {
            family,
            effects: Vec::new(),
            background: Background::Ordinary,
            design: Design::Standard,
            contrast: false,
            seed,
        }
    }

    /// The effects of the spec in the catalogue.
    ///
    /// # Errors
    /// [`ConcealError::UnknownEffect`], or one that the family cannot have.
    pub fn entries(&self) -> Result<Vec<&'static Entry>, ConcealError> {
        let of = |(name, _): &(String, Strength)| {
            let entry = effects::find(name).ok_or_else(|| ConcealError::UnknownEffect {
                name: name.clone(),
                known: effects::catalogue().map(|e| e.name).collect::<Vec<_>>().join(", "),
            })?;
            if self.family != Family::Hd && !entry.in_mmg {
                return Err(ConcealError::NotInFamily { effect: entry.name, family: self.family.name() });
            }
            Ok(entry)
        };
        self.effects.iter().map(of).collect()
    }
}

/// The recordings of a case, as they are written.
#[derive(Debug, Clone, PartialEq)]
pub struct Recorded {
    /// The plans that were sailed.
    pub plans: Vec<Plan>,
    /// The tracks before noise.
    pub tracks: Vec<Track>,
    /// The noisy rows of each run.
    pub rows: Vec<Rows>,
    /// When effects of limited duration acted, in the runs to train on.
    pub windows: Vec<effects::Window>,
    /// How far her two sides differ ([`Craft::asymmetry`]).
    pub asymmetry: Option<f64>,
}

/// A case, made and not yet written.
pub struct Case {
    /// What was asked for.
    pub spec: Spec,
    /// The effects as they acted.
    pub effects: Vec<Active>,
    /// Signal-to-noise ratios reached, where they were measured.
    pub snr: Vec<Option<f64>>,
    /// The recordings.
    pub recorded: Recorded,
}

/// Random streams of a case; each purpose has its own.
mod stream {
    pub const CRAFT: u64 = 0;
    pub const PLANS: u64 = 1;
    pub const SENSORS: u64 = 2;
    pub const EFFECTS: u64 = 100;
    pub const GUSTS: u64 = 1_000;
    pub const NOISE: u64 = 2_000;
}

fn rng(seed: u64, stream: u64) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(stream);
    rng
}

impl Case {
    /// Sails a case. `meter` is asked only where a strength is given as a signal-to-noise ratio.
    ///
    /// # Errors
    /// [`ConcealError`] about the effects, their size, or the meter.
    pub fn make(spec: &Spec, meter: &dyn strength::Meter) -> Result<Self, ConcealError> {
        let entries = spec.entries()?;
        let mut sizes = Vec::new();
        let mut snr = Vec::new();
        for (place, (entry, (_, strength))) in entries.iter().zip(&spec.effects).enumerate() {
            let (size, reached) = match *strength {
                Strength::Times(factor) => (entry.size * factor, None),
                Strength::Size(size) => (size, None),
                Strength::Snr(target) => {
                    let without = record(spec, Vec::new());
                    let with = |size: f64| record(spec, vec![activate(spec, entry, place, size, without.plans.len())]);
                    let (size, snr) = strength::solve(entry, target, |size| meter.snr(entry, &with(size), &without))?;
                    (size, Some(snr))
                }
            };
            if !(0.0..=entry.most).contains(&size) {
                return Err(ConcealError::Size { effect: entry.name, size, unit: entry.unit, most: entry.most });
            }
            sizes.push(size);
            snr.push(reached);
        }
        let runs = if spec.design == Design::Few { 6 } else { 40 };
        let active = || -> Vec<Active> {
            let each = entries.iter().zip(&sizes).enumerate();
            each.map(|(place, (entry, size))| activate(spec, entry, place, *size, runs)).collect()
        };
        Ok(Self { spec: spec.clone(), effects: active(), snr, recorded: record(spec, active()) })
    }

    /// Kind of answer the case calls for, as a verdict of the diagnosis.
    pub fn expected(&self) -> &'static str {
        let is = |class: Class| self.effects.iter().any(|e| e.entry.class == class);
        if self.effects.is_empty() {
            return match self.spec.background {
                Background::Euler => "NUMERICS",
                Background::Gusts => "RANDOM",
                _ => "NOTHING MISSING",
            };
        }
        let alone = !self.spec.contrast;
        if is(Class::Withheld) {
            "NOT IN THE CATALOGUE"
        } else if is(Class::Absorbed) && alone {
            "ABSORBED"
        } else if !self.spec.design.can_tell() || (alone && self.effects.iter().any(|e| e.entry.reference)) {
            "ONE OF"
        } else if is(Class::Random) {
            "RANDOM"
        } else if self.effects.iter().all(|e| e.entry.class == Class::Sensor) {
            "SENSOR"
        } else {
            "NAMED"
        }
    }
}

/// An effect at a size, with all that it draws taken from a stream of its own.
fn activate(spec: &Spec, entry: &'static Entry, place: usize, size: f64, runs: usize) -> Active {
    let mut rng = rng(spec.seed, stream::EFFECTS + place as u64);
    let mut draw = Draw { rng: &mut rng, runs, length: LENGTH, duration: PERIOD * STEPS as f64 };
    let sessions = if spec.design == Design::Few { 2 } else { 4 };
    Active {
        entry,
        size,
        physics: (entry.build)(size, &mut draw),
        sessions: (0..sessions).map(|s| !spec.contrast || s >= sessions / 2).collect(),
    }
}

fn record(spec: &Spec, effects: Vec<Active>) -> Recorded {
    let mut sensors = rng(spec.seed, stream::SENSORS);
    let mut noise = Noise::ordinary(&mut sensors);
    let mut gusts = [800.0, 800.0, 24_000.0];
    let (mut hull_error, mut method) = (0.0, Method::RungeKutta);
    match spec.background {
        Background::Ordinary => {}
        Background::Gusts => gusts = [4_000.0, 4_000.0, 120_000.0],
        Background::Coloured => {
            for i in 0..2 {
                (noise.sigma[i], noise.coloured[i], noise.time[i]) = (1.5, 0.97, 30.0);
            }
        }
        Background::Hull => hull_error = 0.1,
        Background::Euler => method = Method::Euler,
        Background::Outliers => noise.outliers = 0.01,
        Background::Dropouts => noise.dropouts = 2.0,
    }
    let craft = Craft::draw(spec.family, hull_error, &mut rng(spec.seed, stream::CRAFT));
    let plans = design::plans(spec.design, &craft, spec.family.pace(), &mut rng(spec.seed, stream::PLANS));
    let world = World { craft, effects, gusts, method };
    let sailed = |(i, plan): (usize, &Plan)| sail::sail(&world, plan, i, rng(spec.seed, stream::GUSTS + i as u64));
    let tracks: Vec<Track> = plans.iter().enumerate().map(sailed).collect();
    let noisy = |(i, t): (usize, &Track)| noise.apply(&t.reported, &mut rng(spec.seed, stream::NOISE + i as u64));
    let rows = tracks.iter().enumerate().map(noisy).collect();
    let windows = world.effects.iter().flat_map(|e| e.windows(&plans)).collect();
    Recorded { plans, tracks, rows, windows, asymmetry: world.craft.asymmetry() }
}

#[cfg(test)]
mod tests;
