//! The force of a named actuator of the ship file: forces as logged, an order, or a thruster in its own inflow.
//! There is a term for each actuator, by its name, and none in the catalogue: a craft brings its own. The paper's propeller and rudder are
//! the terms `flow`, `propeller` and `rudder`.

use super::rudder_lag::first_order;
use super::size;
use crate::parameter::ParameterInfo;
use crate::physics::{AnyTerm, Flow, Group, Instant, Physics, Reach, Term, TermInfo, Validity};
use crate::ship::Ship;
use crate::ship::actuator::{Actuator, Component, Drive, Lag, Law, MOST_LAG, channels};
use crate::state::{Force, Inputs};
use std::collections::BTreeMap;
use std::sync::{LazyLock, Mutex, PoisonError};
use trimtab_ad::Scalar;

/// A named actuator.
#[derive(Debug)]
pub struct ActuatorTerm {
    info: &'static TermInfo,
    law: Law,
    /// Place \[m\], forward and to starboard of midship.
    place: [f64; 2],
    /// Sine and cosine of a fixed direction.
    fixed: Option<[f64; 2]>,
    components: Vec<Component>,
    /// Index of its first channel among the commands.
    slot: usize,
    /// How many of its channels are lagged: all but the angle, which comes last.
    lagged: usize,
    /// Index of its lag among its parameters.
    lag: usize,
}

/// Rate at which a thruster of a craft usually turns \[1/s\]: 8 sqrt(g/L), which is 3 for a ship of 85 m and 23 for a craft of 1.2 m.
fn usual_rate(ship: &Ship) -> f64 {
    8.0 / size::time(ship)
}

/// A large force of an actuator \[N\]: 3 % of the craft's weight, between 0.9 % of a coaster and 6 to 40 % of small craft.
fn large_force(ship: &Ship) -> f64 {
    0.03 * ship.hull.mass * size::GRAVITY
}

fn per_rate(ship: &Ship) -> f64 {
    large_force(ship) / usual_rate(ship).powi(2)
}

const fn logged(name: &'static str, symbol: &'static str, about: &'static str) -> ParameterInfo {
    ParameterInfo::new(name, symbol, "-", about).default(|_| 1.0).scale(|_| 0.5)
}

const GAINS: [ParameterInfo; 3] = [
    logged("gain_x", "k_X", "surge force of the craft over that logged"),
    logged("gain_y", "k_Y", "sway force of the craft over that logged"),
    logged("gain_n", "k_N", "yaw moment of the craft over that logged"),
];

const ORDER: ParameterInfo =
    ParameterInfo::new("gain", "k", "N", "force for an order of 1").default(large_force).scale(large_force);

const THRUST: ParameterInfo =
    ParameterInfo::new("gain", "k", "N s2", "thrust at rest over n|n|").default(per_rate).scale(per_rate);

/// Inverse of the advance at which thrust ends: a propeller of 4 % of the length, J = 1.2 or so.
const LOSS: ParameterInfo = ParameterInfo::new("loss", "l", "1/m", "thrust lost for one m advanced in a turn")
    .default(|s| 20.0 / s.hull.lpp)
    .scale(|s| 10.0 / s.hull.lpp)
    .spread(|s| 20.0 / s.hull.lpp)
    .bounds(0.0, f64::INFINITY);

const ASTERN: ParameterInfo = ParameterInfo::new("astern", "a", "-", "thrust astern over thrust ahead, at rest")
    .default(|_| 1.0)
    .scale(|_| 0.2)
    .spread(|_| 0.3)
    .bounds(0.0, 2.0);

const ZERO: ParameterInfo =
    ParameterInfo::new("zero", "a_0", "rad", "added to the angle recorded").scale(|_| 0.05).spread(|_| 0.1).odd();

const LAG: ParameterInfo = ParameterInfo::new("lag", "tau", "s", "time constant between channel and force")
    .scale(|s| 0.5 * size::time(s))
    .bounds(0.0, MOST_LAG);

/// A lag that is estimated begins where its slope is not that of no lag.
const FREE_LAG: ParameterInfo = LAG.default(|s| 0.5 * size::time(s));

/// The terms that were made in this process, by what they were made of; each is kept for good, as those of the catalogue are.
static MADE: LazyLock<Mutex<BTreeMap<String, &'static ActuatorTerm>>> = LazyLock::new(Mutex::default);

/// The terms of the named actuators of a craft, in the order of the ship file.
pub fn terms(ship: &Ship) -> Vec<&'static dyn AnyTerm> {
    let first = |i: usize| channels(&ship.actuators[..i]).len();
    ship.actuators.iter().enumerate().map(|(i, a)| term(a, first(i)) as &dyn AnyTerm).collect()
}

/// The term of an actuator whose first channel is that `slot` of the commands.
fn term(actuator: &Actuator, slot: usize) -> &'static ActuatorTerm {
    let mut made = MADE.lock().unwrap_or_else(PoisonError::into_inner);
    made.entry(format!("{slot} {actuator:?}")).or_insert_with(|| Box::leak(Box::new(ActuatorTerm::new(actuator, slot))))
}

/// What a law is in words: title, equation and source.
fn words(law: Law) -> (&'static str, &'static str, &'static str) {
    match law {
        Law::Force => (
            "forces as logged",
            "X = k_X NAME.X, Y = k_Y NAME.Y, N = k_N NAME.N + x Y - y X; tau F' = F_c - F",
            "none: a force that a controller orders or estimates, of which the craft feels a share",
        ),
        Law::Order => (
            "actuator by its order",
            "T = k NAME.order along its direction a at (x, y): X = T cos a, Y = T sin a, N = x Y - y X; tau c' = c_o - c",
            "none: proportional to the order, as a throttle, a pump or an axis of a Voith-Schneider propeller is nearly",
        ),
        Law::Thruster => (
            "thruster",
            "T = k (n|n| - l |n| u_a), k times a for n < 0, u_a = (u - y r) cos a + (v + x r) sin a; X = T cos a, Y = T sin a, \
             N = x Y - y X; tau n' = n_c - n",
            "thrust bilinear in rate and inflow: Blanke 1981; Fossen 2011, Handbook of Marine Craft Hydrodynamics and Motion Control, section 12.3",
        ),
    }
}

impl ActuatorTerm {
    fn new(actuator: &Actuator, slot: usize) -> Self {
        let (title, equation, source) = words(actuator.law);
        let drives = actuator.drives();
        let components = actuator.components();
        let mut parameters: Vec<ParameterInfo> = match actuator.law {
            Law::Force => components.iter().map(|c| GAINS[*c as usize]).collect(),
            Law::Order => vec![ORDER],
            Law::Thruster => vec![THRUST, LOSS, ASTERN],
        };
        parameters.extend(drives.contains(&Drive::Angle).then_some(ZERO));
        let lag = parameters.len();
        parameters.push(if matches!(actuator.lag, Some(Lag::Word(_))) { FREE_LAG } else { LAG });
        let leaked = |text: String| -> &'static str { Box::leak(text.into_boxed_str()) };
        let needs: Vec<&'static str> =
            drives.iter().map(|d| leaked(format!("{}.{}", actuator.name, d.suffix()))).collect();
        let info = TermInfo {
            name: leaked(actuator.name.clone()),
            title,
            group: Group::Propulsion,
            equation,
            source,
            needs: Box::leak(needs.into_boxed_slice()),
            validity: Validity::any("no range is published for an actuator of unknown make"),
            mechanisms: &[],
            parameters: Box::leak(parameters.into_boxed_slice()),
        };
        Self {
            info: Box::leak(Box::new(info)),
            law: actuator.law,
            place: [actuator.x, actuator.y],
            fixed: actuator.angle.map(|a| a.to_radians().sin_cos().into()),
            components,
            slot,
            lagged: drives.iter().filter(|d| **d != Drive::Angle).count(),
            lag,
        }
    }

    /// Whether a parameter is free in a model that says nothing of it: gains, which no particulars tell, and a lag that is to be
    /// estimated.
    pub fn free_at_first(actuator: &Actuator, parameter: &str) -> bool {
        parameter.starts_with("gain") || parameter == "lag" && matches!(actuator.lag, Some(Lag::Word(_)))
    }

    /// Sine and cosine of the direction in which it pushes.
    #[inline(always)]
    fn direction<C: Scalar<Coefficient = C>>(&self, p: &[C], inputs: &Inputs<C>) -> [C; 2] {
        match self.fixed {
            Some(fixed) => fixed.map(C::from_f64),
            None => {
                let (sin, cos) = (inputs.commands[self.slot + self.lagged] + p[self.lag - 1]).sin_cos();
                [sin, cos]
            }
        }
    }
}

impl Term for ActuatorTerm {
    fn info(&self) -> &'static TermInfo {
        self.info
    }

    fn reach(&self, parameter: usize) -> Reach {
        if parameter == self.lag {
            Reach::Anything
        } else if self.law != Law::Thruster
            && self.info.parameters[parameter].name.starts_with("gain")
            && self.lag == self.lagged
        {
            Reach::LinearForce
        } else {
            Reach::Force
        }
    }
}

impl<S: Scalar> Physics<S> for ActuatorTerm {
    fn drive(&self, p: &[S], _ship: &Ship, dt: f64, series: &mut [Inputs<S>]) {
        for slot in self.slot..self.slot + self.lagged {
            first_order(p[self.lag], dt, series, |i| &mut i.commands[slot]);
        }
    }

    fn force(&self, p: &[S::Coefficient], at: &Instant<S>, flow: &Flow<S>) -> Force<S> {
        let command = |i: usize| at.inputs.commands[self.slot + i];
        let [x, y] = self.place;
        if self.law == Law::Force {
            let mut force = Force::<S::Coefficient>::zero();
            for (i, component) in self.components.iter().enumerate() {
                let pushed = p[i] * command(i);
                match component {
                    Component::X => force.x = pushed,
                    Component::Y => force.y = pushed,
                    Component::N => force.n = pushed,
                }
            }
            let n = force.n + force.y * x - force.x * y;
            return Force { x: S::lift(force.x), y: S::lift(force.y), n: S::lift(n) };
        }
        let [sin, cos] = self.direction(p, at.inputs);
        let thrust = if self.law == Law::Order {
            S::lift(p[0] * command(0))
        } else {
            let n = command(0);
            let (zero, one) = (S::Coefficient::zero(), S::Coefficient::one());
            let gain = p[0] * S::Coefficient::select(n.less(zero), p[2], one);
            let inflow = (flow.u - flow.r * y) * cos + (flow.v + flow.r * x) * sin;
            S::lift(gain * n * n.abs()) - inflow * (p[0] * p[1] * n.abs())
        };
        let (ahead, aside) = (thrust * cos, thrust * sin);
        Force { x: ahead, y: aside, n: aside * x - ahead * y }
    }
}
