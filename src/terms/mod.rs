//! The catalogue of terms: each physical effect, actuator defect or sensor defect is one file here and two lines below.
//! A term computes; what is known of it (equation, source, parameters) is data in its `TermInfo`.
//!
//! # Adding a term
//! Write `src/terms/my_effect.rs` with a unit struct that implements [`Term`] and [`Physics`], add `mod my_effect;` and
//! `&my_effect::MyEffect` below. The registry, `trimtab terms`, bounds, priors, the diagnosis and the catalogue tests
//! read it from there.

use crate::flow::{Adjust, Flow};
use crate::parameter::ParameterInfo;
use crate::ship::Ship;
use crate::state::{Force, Inputs, STATES, State};
use trimtab_ad::Scalar;

/// Which part of the simulator a term belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Group {
    /// Hull hydrodynamics.
    Hull,
    /// Propeller and engine.
    Propulsion,
    /// Rudder and steering gear.
    Rudder,
    /// Wind, waves, current, bottom and banks.
    Environment,
    /// What else pushes: thrusters, tugs, lines.
    External,
    /// Not physics of the ship: how a sensor reports it.
    Sensor,
}

/// How the low-speed and astern behaviour of hull and resistance is written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Form {
    /// As printed: terms scaled with U >= 0, resistance an even-odd mix in u.
    #[default]
    Paper,
    /// Fore-aft consistent: the odd (Munk-type) terms change sign with u and resistance opposes motion either way.
    Regular,
}

/// What is known of a term.
#[derive(Debug)]
pub struct TermInfo {
    /// Name, the first half of its parameters' dotted names.
    pub name: &'static str,
    /// What it is in plain words.
    pub title: &'static str,
    /// Where it belongs.
    pub group: Group,
    /// The equation, in plain text.
    pub equation: &'static str,
    /// Source, with page or equation number where there is one.
    pub source: &'static str,
    /// Recorded channels it needs, none for most.
    pub needs: &'static [&'static str],
    /// What the diagnosis may name with it, none for the base terms.
    pub mechanisms: &'static [crate::diagnose::mechanism::Mechanism],
    /// Its parameters, in the order of the slice the physics is given.
    pub parameters: &'static [ParameterInfo],
}

/// The instant at which physics is evaluated.
#[derive(Clone, Copy, Debug)]
pub struct Moment<'a, S> {
    /// The ship.
    pub ship: &'a Ship,
    /// Low-speed form of hull and resistance.
    pub form: Form,
    /// The state, velocities over ground.
    pub state: &'a State<S>,
    /// Inputs at this instant.
    pub inputs: &'a Inputs<S>,
}

/// A term: something with a name and an equation. What it computes is in [`Physics`].
pub trait Term: Sync {
    /// What is known of the term.
    fn info(&self) -> &'static TermInfo;

    /// Whether its parameter of that index changes this term's own force and nothing else: neither inertia, nor inputs, nor
    /// what other terms work with. Sensitivities to such a parameter cost one term instead of all; when in doubt, `false`.
    fn acts_by_force_alone(&self, _parameter: usize) -> bool {
        false
    }
}

/// What a term computes, generic over the number. Every method defaults to "no effect".
///
/// `p` holds the term's own parameters in the order of its `TermInfo`. At its default parameters a term that is not part
/// of the base model must have no effect at all.
pub trait Physics<S: Scalar>: Term {
    /// Changes the inputs of a whole run before it is simulated (actuator lag, rudder offset). `dt` is the sample
    /// period \[s\].
    fn drive(&self, _p: &[S], _ship: &Ship, _dt: f64, _series: &mut [Inputs<S>]) {}

    /// Changes what other terms work with: wake, thrust, coefficient factors, current.
    fn adjust(&self, _p: &[S], _at: &Moment<S>, _adjust: &mut Adjust<S>) {}

    /// Force on the ship (X forward, Y to starboard \[N\], N to starboard \[N m\] about midship).
    fn force(&self, _p: &[S], _at: &Moment<S>, _flow: &Flow<S>) -> Force<S> {
        Force::zero()
    }

    /// Changes what the sensors report: `y` comes in as the state `[x, y, psi, u, v, r]`; `rate` is its time derivative.
    fn measure(&self, _p: &[S], _at: &Moment<S>, _flow: &Flow<S>, _rate: &[S; STATES], _y: &mut [S; STATES]) {}
}

macro_rules! numbers {
    ($($number:ty),+ $(,)?) => {
        /// A term whose physics can be evaluated with every number type that trimtab uses.
        pub trait AnyTerm: $(Physics<$number> +)+ {}
        impl<T: $(Physics<$number> +)+> AnyTerm for T {}

        $(impl Number for $number {
            fn physics(term: &'static dyn AnyTerm) -> &'static dyn Physics<Self> {
                term
            }
        })+
    };
}

/// A scalar for which the catalogue is compiled.
pub trait Number: Scalar {
    /// The term's physics for this number type.
    fn physics(term: &'static dyn AnyTerm) -> &'static dyn Physics<Self>;
}

/// Number of derivatives carried at once.
pub const CHUNK: usize = 12;
/// Value and `CHUNK` first derivatives: trimtab's own dual numbers.
pub type Gradient = trimtab_ad::Dual<f64, CHUNK>;
/// Value, first derivatives in two blocks of variables, and the mixed second derivatives between the blocks.
pub type Curvature = trimtab_ad::Dual<trimtab_ad::Dual<f64, 6>, 6>;
/// Value and `CHUNK` first derivatives by num-dual.
pub type NumDual = num_dual::DualSVec64<CHUNK>;
/// Values of eight runs side by side.
pub type Lanes = trimtab_ad::Lanes;
/// Values and `CHUNK` first derivatives of eight runs side by side.
pub type GradientLanes = trimtab_ad::Dual<trimtab_ad::Lanes, CHUNK>;

numbers!(f64, Gradient, Curvature, NumDual, Lanes, GradientLanes);

pub mod antenna;
pub mod asymmetric;
pub mod bank;
pub mod crossflow;
pub mod current;
pub mod earth_force;
pub mod engine_lag;
pub mod fouling;
pub mod heading_bias;
pub mod hull;
pub mod hull_nonlinear;
pub mod loading;
pub mod log_scale;
pub mod mean_wind;
pub mod munk;
pub mod propeller;
pub mod propeller_walk;
pub mod push;
pub mod race;
pub mod resistance;
pub mod roll;
pub mod rudder;
pub mod rudder_lag;
pub mod rudder_offset;
pub mod rudder_rate;
pub mod rudder_stall;
pub mod shallow;
pub mod size;
pub mod sternway;
pub mod sway_log_bias;
pub mod symmetric;
pub mod thrust_loss;
pub mod thruster;
pub mod tide;
pub mod time_skew;
pub mod wake_drift;
pub mod water_log;
pub mod wave_drift;
pub mod waves;
pub mod wind;
pub mod yaw_rate_bias;

/// Every term, in the order in which they are listed and added up.
pub static CATALOGUE: &[&dyn AnyTerm] = &[
    &crate::flow::FlowTerm,
    &hull::Hull,
    &resistance::Resistance,
    &propeller::Propeller,
    &rudder::Rudder,
    &current::Current,
    &tide::Tide,
    &wind::Wind,
    &mean_wind::MeanWind,
    &waves::Waves,
    &wave_drift::WaveDrift,
    &earth_force::EarthForce,
    &shallow::Shallow,
    &bank::Bank,
    &propeller_walk::PropellerWalk,
    &wake_drift::WakeDrift,
    &thrust_loss::ThrustLoss,
    &engine_lag::EngineLag,
    &race::Race,
    &rudder_offset::RudderOffset,
    &rudder_lag::RudderLag,
    &rudder_rate::RudderRate,
    &rudder_stall::RudderStall,
    &crossflow::Crossflow,
    &hull_nonlinear::HullNonlinear,
    &sternway::Sternway,
    &munk::Munk,
    &loading::Loading,
    &fouling::Fouling,
    &roll::Roll,
    &thruster::Thruster,
    &push::Push,
    &symmetric::Symmetric,
    &asymmetric::Asymmetric,
    &heading_bias::HeadingBias,
    &yaw_rate_bias::YawRateBias,
    &log_scale::LogScale,
    &sway_log_bias::SwayLogBias,
    &antenna::Antenna,
    &time_skew::TimeSkew,
    &water_log::WaterLog,
];

/// The term of that name.
pub fn find(name: &str) -> Option<&'static dyn AnyTerm> {
    CATALOGUE.iter().copied().find(|t| t.info().name == name)
}
