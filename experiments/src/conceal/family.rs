//! The truth families of the concealed cases: which simulator and which hull make the recordings.
//! It has no ship; `craft` draws one of a family.

use serde::{Deserialize, Serialize};

/// Which equations make a data set.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum Family {
    /// The paper's HD equation, the family that is fitted.
    Hd,
    /// The MMG standard method with a four-quadrant propeller and a large-drift hull: another family than the fitted one.
    Mmg,
    /// Another hull: a full tanker, KVLCC2's form with its published MMG parameters, brought to ship A's length.
    Tanker,
    /// Another hull and another simulator: ship B, flapped rudder and strips at large drift, brought to ship A's length.
    Flap,
}

impl Family {
    /// Name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Hd => "hd",
            Self::Mmg => "mmg",
            Self::Tanker => "tanker",
            Self::Flap => "flap",
        }
    }

    /// Factor on the speeds of the programme: a tanker is slower than a coaster of its length at the same rate of the screw.
    pub fn pace(self) -> f64 {
        match self {
            Self::Hd | Self::Mmg => 1.0,
            Self::Tanker => 0.6,
            Self::Flap => 0.75,
        }
    }

    /// The ship file that a diagnosis is given, without the thruster.
    pub fn ship_file(self) -> &'static str {
        match self {
            Self::Hd | Self::Mmg => include_str!("../../ships/a.toml"),
            Self::Tanker => include_str!("../../ships/tanker.toml"),
            Self::Flap => include_str!("../../ships/flap.toml"),
        }
    }

    /// Mechanisms that describe the family itself against the fitted model, whatever effect is concealed: to name one of
    /// these is no false alarm. None of them is an environment, an external force or a sensor defect.
    pub fn structure(self) -> &'static [&'static str] {
        match self {
            Self::Hd => &[],
            Self::Mmg | Self::Tanker | Self::Flap => &[
                "crossflow",
                "hull_nonlinear",
                "munk",
                "sternway",
                "wake_drift",
                "race",
                "rudder_stall",
                "symmetric",
                "asymmetric",
            ],
        }
    }
}
