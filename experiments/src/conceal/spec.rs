//! The specification of a concealed case: truth family, effects with their strength, background, design and seed.
//! It makes nothing; `case` does.

use serde::{Deserialize, Serialize};

use super::effects::catalogue::{catalogue, find};
use super::effects::effect::Entry;
use super::error::ConcealError;
use super::family::Family;
use super::sailing::design::Design;

/// The strength asked of an effect.
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

/// Sea and sensors beside the effect: ordinary, or with one disturbance.
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

/// What a case conceals, and in which runs.
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
            let entry = find(name).ok_or_else(|| ConcealError::UnknownEffect {
                name: name.clone(),
                known: catalogue().map(|e| e.name).collect::<Vec<_>>().join(", "),
            })?;
            if self.family != Family::Hd && !entry.in_mmg {
                return Err(ConcealError::NotInFamily { effect: entry.name, family: self.family.name() });
            }
            Ok(entry)
        };
        self.effects.iter().map(of).collect()
    }
}
