//! What a term is: its name and particulars, and what it computes at an instant, generic over the number.
//! No term is defined here, and none is listed: a term may come from another crate.

use super::flow::{Adjust, Flow};
use super::instant::Instant;
use super::mechanism::Mechanism;
use super::validity::Validity;
use crate::parameter::ParameterInfo;
use crate::ship::Ship;
use crate::state::{Force, Inputs, STATES};
use trimtab_ad::{Along, Dual, Scalar};

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

    /// What its parameter of that index can change. Sensitivities to a parameter that acts by its own term's force cost one term
    /// instead of all; when in doubt, [`Reach::Anything`].
    fn reach(&self, _parameter: usize) -> Reach {
        Reach::Anything
    }

    /// How many parameters of the terms before it in a model the term reads as well: its `p` begins with these, and its own follow. 0
    /// for most; a rudder in a propeller's race reads the propeller's.
    fn before(&self) -> usize {
        0
    }
}

/// What a parameter can change.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Reach {
    /// Inertia, inputs, or what other terms work with.
    Anything,
    /// The propeller's and the rudder's inflow and nothing else: the parameters of the term `flow`. In another term it is taken as
    /// [`Reach::Anything`].
    Flow,
    /// The mass matrix and the force of its own term and nothing else: the masses of the term `hull`. In another term it is taken as
    /// [`Reach::Anything`].
    Inertia,
    /// The force of its own term and nothing else.
    Force,
    /// The force of its own term and nothing else, by `p_j f_j`: the factor `f_j` depends on the state and the inputs, and on no
    /// parameter of the term.
    LinearForce,
}

/// What a term computes, generic over the number. Every method defaults to "no effect".
///
/// `p` contains the term's own parameters in the order of its `TermInfo`, behind those of [`Term::before`]. At its default parameters a term that is not part
/// of the base model must have no effect at all.
pub trait Physics<S: Scalar>: Term {
    /// Changes the inputs of a whole run before it is simulated (actuator lag, rudder offset). `dt` is the sample
    /// period \[s\].
    fn drive(&self, _p: &[S], _ship: &Ship, _dt: f64, _series: &mut [Inputs<S>]) {}

    /// Changes what other terms work with: wake, thrust, coefficient factors, current. It depends on parameters and inputs only.
    fn adjust(&self, _p: &[S], _ship: &Ship, _inputs: &Inputs<S>, _adjust: &mut Adjust<S>) {}

    /// Force on the ship (X forward, Y to starboard \[N\], N to starboard \[N m\] about midship).
    fn force(&self, _p: &[S::Coefficient], _at: &Instant<S>, _flow: &Flow<S>) -> Force<S> {
        Force::zero()
    }

    /// Changes what the sensors report: `y` comes in as the state `[x, y, psi, u, v, r]`; `rate` is its time derivative.
    fn measure(
        &self,
        _p: &[S::Coefficient],
        _at: &Instant<S>,
        _flow: &Flow<S>,
        _rate: &[S; STATES],
        _y: &mut [S; STATES],
    ) {
    }

    /// The force per unit of each parameter of [`Reach::LinearForce`], into `out` by the parameter's index.
    ///
    /// `p` is room for the parameters, all zero, and is left so. The default evaluates the force for one unit of each; a term
    /// whose force is written as a sum of `p_j f_j` may give the factors directly.
    fn slopes(&self, p: &mut [S::Coefficient], at: &Instant<S>, flow: &Flow<S>, out: &mut [Force<S>]) {
        let rest = self.force(p, at, flow);
        for (j, out) in out.iter_mut().enumerate() {
            if self.reach(j) == Reach::LinearForce {
                p[j] = S::Coefficient::one();
                *out = self.force(p, at, flow) - rest;
                p[j] = S::Coefficient::zero();
            }
        }
    }
}

/// The most parameters a term may have.
pub const MOST_PARAMETERS: usize = 64;

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

/// Number of derivatives carried at once by numbers that carry them by the parameters of a fit.
pub const CHUNK: usize = 12;
/// Number of derivatives carried at once where a parameter may change anything.
pub const FEW: usize = 4;
/// Value and `CHUNK` first derivatives: trimtab's own dual numbers.
pub type Gradient = trimtab_ad::Dual<f64, CHUNK>;
/// Value, first derivatives in two blocks of variables, and the mixed second derivatives between the blocks.
pub type Curvature = trimtab_ad::Dual<trimtab_ad::Dual<f64, 6>, 6>;
/// Value and `CHUNK` first derivatives by num-dual.
pub type NumDual = num_dual::DualSVec64<CHUNK>;
/// Values of four runs side by side.
pub type Lanes = trimtab_ad::Lanes;

numbers!(
    f64,
    Gradient,
    Curvature,
    NumDual,
    Lanes,
    Dual<f64, FEW>,
    Dual<Lanes, FEW>,
    Along<f64, 3>,
    Along<Lanes, 3>,
    Along<f64, 4>,
    Along<Lanes, 4>,
);
