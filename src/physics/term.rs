//! What a term is: its name and particulars, and what it computes at an instant, generic over the number.
//! No term is defined here, and none is listed: a term may come from another crate.

use super::flow::{Adjust, Flow};
use super::instant::Instant;
use super::mechanism::Mechanism;
use super::validity::Validity;
use crate::parameter::ParameterInfo;
use crate::ship::Ship;
use crate::state::{Force, Inputs, STATES};
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
    /// The range of motion over which its law is valid.
    pub validity: Validity,
    /// What the diagnosis may name with it, none for the base terms.
    pub mechanisms: &'static [Mechanism],
    /// Its parameters, in the order of the slice the physics is given.
    pub parameters: &'static [ParameterInfo],
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
    fn adjust(&self, _p: &[S], _at: &Instant<S>, _adjust: &mut Adjust<S>) {}

    /// Force on the ship (X forward, Y to starboard \[N\], N to starboard \[N m\] about midship).
    fn force(&self, _p: &[S], _at: &Instant<S>, _flow: &Flow<S>) -> Force<S> {
        Force::zero()
    }

    /// Changes what the sensors report: `y` comes in as the state `[x, y, psi, u, v, r]`; `rate` is its time derivative.
    fn measure(&self, _p: &[S], _at: &Instant<S>, _flow: &Flow<S>, _rate: &[S; STATES], _y: &mut [S; STATES]) {}
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
