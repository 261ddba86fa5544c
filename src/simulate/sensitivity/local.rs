//! The rates of the state at an instant with their exact Jacobian by heading and velocities, for one run or for a few side by side.
//! Positions have no part in it: no force depends on where the ship is.

use crate::dynamics::Dynamics;
use crate::physics::{FEW, Flow, Inflow, Instant, Number, Physics};
use crate::state::{Force, Inputs, STATES, State};
use crate::terms::propulsion::propeller::Propeller;
use crate::terms::steering::rudder::Rudder;
use trimtab_ad::{Along, Dual, Lanes, Scalar};

/// Places of the terms `propeller` and `rudder` in a model.
const PROPELLER: usize = 3;
const RUDDER: usize = 4;

/// Rates of the state, and how the accelerations change with it.
#[derive(Clone, Copy, Debug)]
pub struct Local<P> {
    /// Rates of `[x, y, psi, u, v, r]`.
    pub rates: [P; STATES],
    /// Jacobian of (u', v', r') by (psi, u, v, r).
    pub jacobian: [[P; 4]; 3],
    /// Sine and cosine of the heading.
    pub heading: [P; 2],
}

/// A number without derivatives, for one run or for several side by side, that simulations are differentiated over.
pub trait Plain: Number<Coefficient = Self> + PartialEq {
    /// The number with [`FEW`] derivatives by parameters.
    type Few: Number<Coefficient = Self::Few>;
    /// How many runs it contains.
    const WIDTH: usize;
    /// A number from one value a run.
    fn gather(f: impl FnMut(usize) -> f64) -> Self;
    /// The value of one run.
    fn in_lane(self, lane: usize) -> f64;
    /// Without derivatives.
    fn few(self) -> Self::Few;
    /// With given derivatives.
    fn few_with(self, slopes: [Self; FEW]) -> Self::Few;
    /// Value and derivatives.
    fn parts(few: &Self::Few) -> (Self, [Self; FEW]);
    /// Rates and their Jacobian at a state, and what the terms share there, under a force `push` beside that of the terms.
    fn linearise(
        dynamics: &Dynamics<Self>,
        state: &[Self; STATES],
        inputs: &Inputs<Self>,
        push: &Force<Self>,
    ) -> (Local<Self>, Flow<Self>);
    /// What the sensors report of a state, and the derivative by the state.
    fn reported(
        dynamics: &Dynamics<Self>,
        state: &[Self; STATES],
        inputs: &Inputs<Self>,
    ) -> ([Self; STATES], [[Self; STATES]; STATES]);
    /// Derivatives of the terms' force by the inflow of propeller and rudder, and into `rudder` the rudder's force per unit of each of
    /// its parameters, which comes with them.
    fn by_inflow(
        dynamics: &Dynamics<Self>,
        at: &Instant<Self>,
        flow: &Flow<Self>,
        rudder: &mut [Force<Self>; 7],
    ) -> Inflow<Force<Self>>;
}

macro_rules! plain {
    ($number:ty, $width:expr, |$f:ident| $gather:expr, |$x:ident, $i:ident| $lane:expr) => {
        impl Plain for $number {
            type Few = Dual<$number, FEW>;
            const WIDTH: usize = $width;
            #[inline]
            #[allow(unused_mut)]
            fn gather(mut $f: impl FnMut(usize) -> f64) -> Self {
                $gather
            }
            #[inline]
            fn in_lane(self, $i: usize) -> f64 {
                let $x = self;
                $lane
            }
            #[inline]
            fn few(self) -> Self::Few {
                Dual::constant(self)
            }
            #[inline]
            fn few_with(self, slopes: [Self; FEW]) -> Self::Few {
                Dual { re: self, eps: slopes }
            }
            #[inline]
            fn parts(few: &Self::Few) -> (Self, [Self; FEW]) {
                (few.re, few.eps)
            }
            #[inline(always)]
            fn linearise(
                dynamics: &Dynamics<Self>,
                state: &[Self; STATES],
                inputs: &Inputs<Self>,
                push: &Force<Self>,
            ) -> (Local<Self>, Flow<Self>) {
                let [_, _, psi, u, v, r] = *state;
                if dynamics.is_still() && dynamics.extras().is_empty() {
                    let x = [Along::constant(psi), Along::variable(u, 0), Along::variable(v, 1), Along::variable(r, 2)];
                    along::<$number, 3>(dynamics, state, x, inputs, push, |[u, v, r]| [Self::zero(), u, v, r])
                } else {
                    let x =
                        [Along::variable(psi, 0), Along::variable(u, 1), Along::variable(v, 2), Along::variable(r, 3)];
                    along::<$number, 4>(dynamics, state, x, inputs, push, |slopes| slopes)
                }
            }
            fn reported(
                dynamics: &Dynamics<Self>,
                state: &[Self; STATES],
                inputs: &Inputs<Self>,
            ) -> ([Self; STATES], [[Self; STATES]; STATES]) {
                reported(dynamics, state, inputs)
            }
            #[inline(always)]
            fn by_inflow(
                dynamics: &Dynamics<Self>,
                at: &Instant<Self>,
                flow: &Flow<Self>,
                rudder: &mut [Force<Self>; 7],
            ) -> Inflow<Force<Self>> {
                by_inflow(dynamics, at, flow, rudder)
            }
        }
    };
}
plain!(f64, 1, |f| f(0), |x, _lane| x);
plain!(Lanes, Lanes::LANES, |f| Lanes::from_fn(f), |x, lane| x.lane(lane));

/// Inputs of a few runs side by side, from those of each.
pub fn side_by_side<'i, P: Plain>(of: impl Fn(usize) -> &'i Inputs<f64>) -> Inputs<P> {
    Inputs::from_entries(|entry| P::gather(|lane| *entry(of(lane))))
}

/// Rates and Jacobian by one evaluation along `N` directions.
#[inline(always)]
fn along<P: Plain, const N: usize>(
    dynamics: &Dynamics<P>,
    state: &[P; STATES],
    [psi, u, v, r]: [Along<P, N>; 4],
    inputs: &Inputs<P>,
    push: &Force<P>,
    row: impl Fn([P; N]) -> [P; 4],
) -> (Local<P>, Flow<P>)
where
    Along<P, N>: Number<Coefficient = P>,
{
    let constant = Along::<P, N>::constant;
    let moving = State { x: constant(state[0]), y: constant(state[1]), psi, u, v, r };
    let push = Force { x: constant(push.x), y: constant(push.y), n: constant(push.n) };
    let (rates, flow) = dynamics.rates_in_place(&moving, inputs, &push);
    let (sin, cos) = psi.sin_cos();
    let local = Local {
        rates: rates.map(|rate| rate.re),
        jacobian: [row(rates[3].eps), row(rates[4].eps), row(rates[5].eps)],
        heading: [sin.re, cos.re],
    };
    (local, flow.map(|x| x.re, |c| c))
}

/// A report and its Jacobian by one evaluation along the heading and the velocities: no sensor's error depends on where the ship is.
fn reported<P: Plain>(
    dynamics: &Dynamics<P>,
    state: &[P; STATES],
    inputs: &Inputs<P>,
) -> ([P; STATES], [[P; STATES]; STATES])
where
    Along<P, 4>: Number<Coefficient = P>,
{
    let x: [Along<P, 4>; STATES] =
        std::array::from_fn(|j| if j < 2 { Along::constant(state[j]) } else { Along::variable(state[j], j - 2) });
    let y = dynamics.report(&x, inputs);
    let position = |i: usize, j: usize| if i == j { P::one() } else { P::zero() };
    let row = |i: usize| std::array::from_fn(|j| if j < 2 { position(i, j) } else { y[i].eps[j - 2] });
    (y.map(|v| v.re), std::array::from_fn(row))
}

/// The force's derivatives by propulsion come from the propeller, those by the rudder's inflow from the rudder; further terms may
/// have all five.
#[inline(always)]
fn by_inflow<P: Plain>(
    dynamics: &Dynamics<P>,
    at: &Instant<P>,
    flow: &Flow<P>,
    rudder: &mut [Force<P>; 7],
) -> Inflow<Force<P>>
where
    Along<P, 1>: Scalar<Coefficient = P>,
    Along<P, 2>: Scalar<Coefficient = P>,
    Along<P, 3>: Number<Coefficient = P>,
{
    let part = |place: usize| dynamics.model().placed()[place].part(dynamics.theta());
    let constant = Force::<P>::zero();
    let mut out =
        Inflow { advance: constant, thrust: constant, propulsion: constant, rudder_u: constant, rudder_v: constant };
    [out.propulsion] = directions::<P, 1>(
        at,
        flow,
        |f| f.propulsion.eps[0] = P::one(),
        |at, flow| Propeller.force(part(PROPELLER), at, flow),
    );
    let seed = |f: &mut Flow<Along<P, 2>>| (f.rudder_u.eps[0], f.rudder_v.eps[1]) = (P::one(), P::one());
    [out.rudder_u, out.rudder_v] = directions::<P, 2>(at, flow, seed, |at, flow| {
        let (force, slopes) = Rudder::force_and_slopes(part(RUDDER), at, flow);
        for (out, slope) in rudder.iter_mut().zip(slopes) {
            *out = Force { x: slope.x.re, y: slope.y.re, n: slope.n.re };
        }
        force
    });
    for t in dynamics.extras() {
        let by = |seed: fn(&mut Flow<Along<P, 3>>)| {
            directions::<P, 3>(at, flow, seed, |at, flow| {
                <Along<P, 3> as Number>::physics(t.term).force(t.part(dynamics.theta()), at, flow)
            })
        };
        let [advance, thrust, propulsion] = by(|f| {
            (f.advance.eps[0], f.thrust.eps[1], f.propulsion.eps[2]) = (P::one(), P::one(), P::one());
        });
        let [rudder_u, rudder_v, _] = by(|f| (f.rudder_u.eps[0], f.rudder_v.eps[1]) = (P::one(), P::one()));
        out.advance += advance;
        out.thrust += thrust;
        out.propulsion += propulsion;
        out.rudder_u += rudder_u;
        out.rudder_v += rudder_v;
    }
    out
}

/// Derivatives of a force along `N` directions in the flow, which `seed` sets.
#[inline(always)]
fn directions<P: Plain, const N: usize>(
    at: &Instant<P>,
    flow: &Flow<P>,
    seed: impl Fn(&mut Flow<Along<P, N>>),
    force: impl FnOnce(&Instant<Along<P, N>>, &Flow<Along<P, N>>) -> Force<Along<P, N>>,
) -> [Force<P>; N]
where
    Along<P, N>: Scalar<Coefficient = P>,
{
    let mut flow = flow.map(Along::constant, |c| c);
    seed(&mut flow);
    let state = State::from_array(at.state.to_array().map(Along::constant));
    let at = Instant {
        ship: at.ship,
        small: at.small,
        form: at.form,
        state: &state,
        heading: at.heading.map(Along::constant),
        inputs: at.inputs,
    };
    let force = force(&at, &flow);
    std::array::from_fn(|j| Force { x: force.x.eps[j], y: force.y.eps[j], n: force.n.eps[j] })
}
