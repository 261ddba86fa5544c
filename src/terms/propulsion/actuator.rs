//! The force of a named actuator of the ship file: forces as logged, an order, a thruster or a propeller in its own inflow, a rudder; and
//! its faults, which a diagnosis may name. There is a term for each actuator, by its name, and none in the list of all terms: a craft brings its own. The
//! paper's propeller and rudder are the terms `flow`, `propeller` and `rudder`, with faults in terms of their own.
//!
//! The faults are the same for every law, and none is at its default:
//! - `lost` \[-\], loss of effectiveness: `F -> (1 - k_l) F`; 1 where the actuator is dead, 2 where it pushes the other way.
//! - `lag` \[s\], a first-order lag between channel and force: `tau c' = c_o - c`, exact for a channel that is linear between samples.
//! - `turn_lag` \[s\], of an actuator that turns, the same between the angle that is recorded and the direction in which it pushes: what turns an
//!   azimuth thruster or an outboard engine is another machine than what drives it. The angle of a foil is its channel, with `lag`.
//! - `other_sign` \[-\], of an actuator that turns: `a -> (1 - 2 s) a`; 1 where its angle is recorded with the other sign.
//! - `zero` \[rad\], an offset of its direction, positive clockwise from above, or of the angle of a rudder: `a -> a + a_0`. Logged forces
//!   have no direction.
//! - `swap` \[-\], of two actuators in each other's mirror place, a parameter of the first: `c -> c + s (c_m - c)`, `c_m -> c_m + s (c - c_m)` for every
//!   channel c of the one and c_m of the other, before any lag; 1 where the recordings of the two are exchanged.

use super::screw::{self, Screw};
use crate::parameter::ParameterInfo;
use crate::physics::{
    AnyTerm, Flow, Group, Instant, Kind, MOST_PARAMETERS, Mechanism, Physics, Probe, Reach, Term, TermInfo, Validity,
};
use crate::ship::Ship;
use crate::ship::actuator::{Actuator, Component, Drive, Lag, Law, MOST_LAG, channels, pairs};
use crate::state::{Force, Inputs};
use crate::terms::size;
use crate::terms::steering::foil::{self, Foil, Upstream};
use crate::terms::steering::rudder_lag::first_order;
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::sync::{LazyLock, Mutex, PoisonError};
use trimtab_ad::Scalar;

/// A named actuator.
#[derive(Debug)]
pub struct ActuatorTerm {
    info: &'static TermInfo,
    push: Push,
    /// Place \[m\], forward and to starboard of midship.
    place: [f64; 2],
    /// Its direction where that is fixed \[rad\].
    fixed: Option<f64>,
    /// Index of its first channel among the commands.
    slot: usize,
    /// How many channels it has.
    channels: usize,
    /// How many of them have the lag of its force: all but the angle, which comes last and has its own; that of a foil is what it pushes by.
    lagged: usize,
    /// Index of the first channel, among the commands, of the actuator in its mirror place that comes after it.
    partner: Option<usize>,
    /// Index of its lag among its parameters, behind that of the zero of its direction where it has one.
    lag: usize,
    /// Index of the lag of its direction, where it turns; the sign of its angle follows.
    turn_lag: Option<usize>,
    /// How many parameters lie between those of the propeller in whose race it stands, these included, and its own.
    before: usize,
    /// Whether a rudder stands in its race.
    is_ahead_of_rudder: bool,
}

/// What it pushes with.
#[derive(Debug)]
enum Push {
    Logged(Vec<Component>),
    Order,
    Thruster,
    Propeller(Screw),
    Foil(Foil),
}

impl ActuatorTerm {
    /// Index of the share of its push that is lost.
    fn lost(&self) -> usize {
        self.lag + 1
    }

    /// Index of the share of its partner's recording.
    fn swap(&self) -> usize {
        self.lag + 2
    }
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

const ZERO: ParameterInfo = ParameterInfo::new("zero", "a_0", "rad", "added to the angle, recorded or fixed")
    .scale(|_| 0.05)
    .spread(|_| 0.1)
    .odd();

/// As far as all of its push the other way and half as much again, and so much beyond a sound one.
const LOST: ParameterInfo = ParameterInfo::new(
    "lost",
    "k_l",
    "-",
    "share of its push that is lost: 1 where it is dead, 2 where it is reversed",
)
.scale(|_| 0.1)
.spread(|_| 0.2)
.bounds(-1.5, 2.5);

/// Bounded beyond 1, so that an estimate of 1 has an error to both sides.
const SWAP: ParameterInfo = ParameterInfo::new(
    "swap",
    "s",
    "-",
    "share of the recording of the actuator in its mirror place in its own, and the other way round: 1 where they are swapped",
)
.spread(|_| 0.5)
.bounds(0.0, 1.5);

/// Bounded as [`SWAP`].
const OTHER_SIGN: ParameterInfo = ParameterInfo::new(
    "other_sign",
    "s_a",
    "-",
    "share of the other sign in its angle: 1 where that is recorded with the other sign",
)
.spread(|_| 0.5)
.bounds(0.0, 1.5);

const LAG: ParameterInfo = ParameterInfo::new("lag", "tau", "s", "time constant between channel and force")
    .scale(|s| 0.5 * size::time(s))
    .bounds(0.0, MOST_LAG);

const TURN_LAG: ParameterInfo =
    ParameterInfo::new("turn_lag", "tau_a", "s", "time constant between recorded angle and direction")
        .scale(|s| 0.5 * size::time(s))
        .bounds(0.0, MOST_LAG);

/// A lag that is estimated begins where its slope is not that of no lag.
const FREE_LAG: ParameterInfo = LAG.default(|s| 0.5 * size::time(s));
const FREE_TURN_LAG: ParameterInfo = TURN_LAG.default(|s| 0.5 * size::time(s));

/// Whether an actuator pushes along a channel `NAME.angle`.
fn turns(actuator: &Actuator) -> bool {
    actuator.law != Law::Foil && actuator.drives().contains(&Drive::Angle)
}

/// The terms that were made in this process, by what they were made of; each is kept for good, as those of the catalogue are.
static MADE: LazyLock<Mutex<BTreeMap<String, &'static ActuatorTerm>>> = LazyLock::new(Mutex::default);

/// The actuator in the mirror place of another.
struct Partner<'a> {
    name: &'a str,
    /// Index of its first channel among the commands.
    slot: usize,
}

/// An actuator of a craft, and the others that it has to do with.
struct Fitted<'a> {
    own: &'a Actuator,
    /// Index of its first channel among the commands.
    slot: usize,
    partner: Option<Partner<'a>>,
    /// The propeller in whose race it stands, the first channel of that among the commands, and how many parameters lie between those
    /// of the propeller, these included, and its own.
    behind: Option<(&'a Actuator, usize, usize)>,
    is_ahead_of_rudder: bool,
}

/// The terms of the named actuators of a craft, in the order of the ship file.
pub fn terms(ship: &Ship) -> Vec<&'static dyn AnyTerm> {
    let all = &ship.actuators;
    let first = |i: usize| channels(&all[..i]).len();
    let pairs = pairs(all);
    let partner = |i: usize| {
        let [_, j] = pairs.iter().find(|[first, _]| *first == i)?;
        Some(Partner { name: &all[*j].name, slot: first(*j) })
    };
    let has_partner = |i: usize| pairs.iter().any(|[first, _]| *first == i);
    let behind = |i: usize| {
        let ahead = all[i].behind.as_ref()?;
        let j = all[..i].iter().position(|other| other.name == *ahead)?;
        let between = (j..i).map(|k| parameters(&all[k], has_partner(k)).len()).sum();
        Some((&all[j], first(j), between))
    };
    let fitted = |(i, own): (usize, &'_ Actuator)| {
        let is_ahead_of_rudder = all.iter().any(|other| other.behind.as_ref() == Some(&own.name));
        term(&Fitted { own: &all[i], slot: first(i), partner: partner(i), behind: behind(i), is_ahead_of_rudder })
    };
    all.iter().enumerate().map(|a| fitted(a) as &dyn AnyTerm).collect()
}

/// The term of an actuator, made once.
fn term(fitted: &Fitted<'_>) -> &'static ActuatorTerm {
    let beside = fitted.partner.as_ref().map(|p| (p.name, p.slot));
    let Fitted { own, slot, behind, is_ahead_of_rudder, .. } = fitted;
    let key = format!("{slot} {own:?} {beside:?} {behind:?} {is_ahead_of_rudder}");
    let mut made = MADE.lock().unwrap_or_else(PoisonError::into_inner);
    made.entry(key).or_insert_with(|| Box::leak(Box::new(ActuatorTerm::new(fitted))))
}

/// A text that is kept for good.
fn leaked(text: String) -> &'static str {
    Box::leak(text.into_boxed_str())
}

/// What a diagnosis may name of an actuator, each by the dotted name of its parameter: what is not free in its model anyhow, and what
/// differs from session to session though it is.
fn faults(actuator: &Actuator, parameters: &[ParameterInfo], partner: Option<&Partner>) -> Vec<Mechanism> {
    let name = &actuator.name;
    let fault = |parameter: &'static [&'static str; 1], title: String, trial: String| {
        let [own] = parameter;
        Mechanism {
            name: leaked(format!("{name}.{own}")),
            title: leaked(title),
            kind: Kind::Actuator,
            parameters: parameter,
            companions: &[],
            probe: if [SWAP.name, OTHER_SIGN.name].contains(own) { Probe::Whole } else { Probe::Tangent },
            // Its gain takes over what is lost in all sessions alike.
            needs_reference: *own == LOST.name,
            by_session: false,
            stand_in: false,
            look_alikes: if [LAG.name, TURN_LAG.name].contains(own) {
                &["time_skew", "yaw_rate_skew", "log_skew"]
            } else {
                &[]
            },
            trial: leaked(trial),
        }
    };
    let mut faults = vec![fault(
        &["lost"],
        format!("loss of effectiveness of the actuator {name}"),
        format!("the same orders to {name} alone, ahead and astern, in every session"),
    )];
    // A lag that the ship file gives, or has estimated, is known or free.
    if actuator.lag.is_none() {
        let title = format!("lag of the actuator {name}");
        faults.push(fault(&["lag"], title, format!("quick steps of {name} alone, from rest and back")));
        if turns(actuator) {
            let title = format!("lag of the direction of the actuator {name}");
            faults.push(fault(&["turn_lag"], title, format!("quick turns of {name} under way, at one rate")));
        }
    }
    if parameters.iter().any(|p| p.name == ZERO.name) {
        let turned = if actuator.law == Law::Foil { "rudder angle" } else { "direction" };
        let title = format!("offset of the {turned} of the actuator {name}");
        faults.push(fault(&["zero"], title, format!("runs driven by {name} alone, ahead and astern")));
    }
    if turns(actuator) {
        let title = format!("angle of the actuator {name} recorded with the other sign");
        faults.push(fault(&["other_sign"], title, format!("runs driven by {name} alone at angles to both sides")));
    }
    if let Some(Partner { name: other, .. }) = partner {
        let title = format!("swapped sides: {name} has the recording of {other}, and {other} that of {name}");
        faults.push(fault(&["swap"], title, format!("turns from rest by {name} alone and by {other} alone")));
    }
    faults
}

/// The faults of every law, as part of its equation.
const FAULTY: &str = "faults: F -> (1 - k_l) F, a -> a + a_0, a -> (1 - 2 s_a) a, tau_a a' = a_c - a, c -> c + s (c_m - c) with c_m of the actuator in its mirror place";

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
        Law::Propeller => (
            "propeller",
            "T = rho n^2 D^4 K_T(J), K_T = k0 + k1 J + k2 J^2, J = (1-w) u_a/(n D), four quadrants, u_a = (u - y r) cos a + (v + x r) sin a; \
             (1 - t) T along its direction a where T > 0; N = x Y - y X; tau n' = n_c - n",
            "Yasukawa & Yoshimura 2015, J. Mar. Sci. Technol. 20, eq. 11 to 14; four quadrants as in `flow`; start values where the ship file gives none: B4-70 with P/D = 0.8, wake by Taylor (Lewis 1988, Principles of Naval Architecture II, p. 159)",
        ),
        Law::Foil => (
            "rudder",
            "F_N = 1/2 rho A U_R^2 f_alpha sin(delta - atan2(v_R, u_R)), f_alpha to a flat plate's from 45 to 60 deg; X = -(1 - t_R) F_N sin delta, \
             Y = -(1 + a_H) F_N cos delta, N = -(x + a_H x_H' L) F_N cos delta - y X; v_R = -gamma (v + l_R r), u_R = eps (u - y r) or in the \
             race of a propeller as in `flow`; tau delta' = delta_c - delta",
            "Yasukawa & Yoshimura 2015, J. Mar. Sci. Technol. 20, eq. 19 to 26; start values: slope by Fujii & Tsuda 1961, in a race t_R = 0.45 - 0.28 C_b, a_H = 0.627 C_b - 0.153",
        ),
    }
}

/// The parameters of an actuator, in order: those of its law, the zero of its direction, its lag, what is lost, the swap, and of one that
/// turns the lag of its direction and the sign of its angle.
fn parameters(actuator: &Actuator, has_partner: bool) -> Vec<ParameterInfo> {
    let mut parameters: Vec<ParameterInfo> = match actuator.law {
        Law::Force => actuator.components().iter().map(|c| GAINS[*c as usize]).collect(),
        Law::Order => vec![ORDER],
        Law::Thruster => vec![THRUST, LOSS, ASTERN],
        Law::Propeller => screw::PARAMETERS.to_vec(),
        Law::Foil if actuator.behind.is_some() => [foil::PARAMETERS.as_slice(), &foil::IN_RACE].concat(),
        Law::Foil => foil::PARAMETERS.to_vec(),
    };
    parameters.extend((actuator.law != Law::Force).then_some(ZERO));
    let is_free = matches!(actuator.lag, Some(Lag::Word(_)));
    parameters.push(if is_free { FREE_LAG } else { LAG });
    parameters.push(LOST);
    parameters.extend(has_partner.then_some(SWAP));
    if turns(actuator) {
        parameters.extend([if is_free { FREE_TURN_LAG } else { TURN_LAG }, OTHER_SIGN]);
    }
    parameters
}

impl ActuatorTerm {
    fn new(fitted: &Fitted<'_>) -> Self {
        let Fitted { own: actuator, slot, partner, behind, is_ahead_of_rudder } = fitted;
        let (title, equation, source) = words(actuator.law);
        let drives = actuator.drives();
        let parameters = parameters(actuator, partner.is_some());
        let index = |name: &str| parameters.iter().position(|p| p.name == name);
        let (lag, turn_lag) = (index(LAG.name).unwrap_or_default(), index(TURN_LAG.name));
        let mechanisms = faults(actuator, &parameters, partner.as_ref());
        let place = [actuator.x, actuator.y];
        let screw = |of: &Actuator, rate| Screw { diameter: of.diameter.unwrap_or(1.0), place: [of.x, of.y], rate };
        let upstream = |(ahead, rate, _): &(&Actuator, usize, usize)| {
            let own = self::parameters(ahead, false);
            let index = |name| own.iter().position(|p| p.name == name).unwrap_or_default();
            Upstream {
                screw: screw(ahead, *rate),
                axis: ahead.angle.unwrap_or(0.0).to_radians().sin_cos().into(),
                zero: index(ZERO.name),
                lost: index(LOST.name),
            }
        };
        let push = match actuator.law {
            Law::Force => Push::Logged(actuator.components()),
            Law::Order => Push::Order,
            Law::Thruster => Push::Thruster,
            Law::Propeller => Push::Propeller(screw(actuator, *slot)),
            Law::Foil => Push::Foil(Foil {
                area: actuator.area.unwrap_or(0.0),
                span: actuator.blade_span(),
                place,
                angle: *slot,
                behind: behind.as_ref().map(upstream),
            }),
        };
        let needs: Vec<&'static str> =
            drives.iter().map(|d| leaked(format!("{}.{}", actuator.name, d.suffix()))).collect();
        let info = TermInfo {
            name: leaked(actuator.name.clone()),
            title,
            group: if actuator.law == Law::Foil { Group::Rudder } else { Group::Propulsion },
            equation: leaked(format!("{equation}; {FAULTY}")),
            source: leaked(format!(
                "{source}; loss of effectiveness: Blanke et al. 2016, Diagnosis and Fault-Tolerant Control"
            )),
            needs: Box::leak(needs.into_boxed_slice()),
            validity: Validity::any("no range is published for an actuator of unknown make"),
            mechanisms: Box::leak(mechanisms.into_boxed_slice()),
            parameters: Box::leak(parameters.into_boxed_slice()),
        };
        Self {
            info: Box::leak(Box::new(info)),
            push,
            place,
            fixed: actuator.angle.map(f64::to_radians),
            slot: *slot,
            channels: drives.len(),
            lagged: drives.iter().filter(|d| **d != Drive::Angle || actuator.law == Law::Foil).count(),
            partner: partner.as_ref().map(|p| p.slot),
            lag,
            turn_lag,
            before: behind.map_or(0, |(_, _, between)| between),
            is_ahead_of_rudder: *is_ahead_of_rudder,
        }
    }

    /// Whether a parameter is free in a model that says nothing of it: gains, which no particulars give, and a lag that is to be
    /// estimated.
    pub fn free_at_first(actuator: &Actuator, parameter: &str) -> bool {
        Self::is_gain(parameter)
            || ["lag", "turn_lag"].contains(&parameter) && matches!(actuator.lag, Some(Lag::Word(_)))
    }

    /// Whether a parameter multiplies the whole push: a gain, or the slope of a foil.
    pub fn is_gain(parameter: &str) -> bool {
        parameter == "slope" || parameter.starts_with("gain")
    }

    /// Whether a parameter of this dotted name is the share of the push of an actuator that is lost.
    pub fn is_loss(name: &str) -> bool {
        name.split_once('.').is_some_and(|(_, parameter)| parameter == LOST.name)
    }

    /// Whether a parameter is one of a law that particulars give no more than roughly: it is estimated along, with its spread as prior.
    pub fn is_uncertain(parameter: &str) -> bool {
        ["loss", "astern", "wake", "kt0", "wake_ratio", "race", "straightening"].contains(&parameter)
    }

    /// Sine and cosine of the direction in which it pushes.
    #[inline(always)]
    fn direction<C: Scalar<Coefficient = C>>(&self, p: &[C], inputs: &Inputs<C>) -> [C; 2] {
        let angle = match self.fixed {
            Some(angle) => C::from_f64(angle),
            None => inputs.commands[self.slot + self.lagged],
        };
        let (sin, cos) = (angle + p[self.lag - 1]).sin_cos();
        [sin, cos]
    }
}

impl Term for ActuatorTerm {
    fn info(&self) -> &'static TermInfo {
        self.info
    }

    fn reach(&self, parameter: usize) -> Reach {
        let turns = self.turn_lag.is_some_and(|lag| [lag, lag + 1].contains(&parameter));
        let drives = parameter == self.lag || parameter == self.swap() || turns;
        let in_race = self.is_ahead_of_rudder && screw::is_in_race(parameter);
        let has_no_room = self.before + self.info.parameters.len() > MOST_PARAMETERS;
        if drives || in_race || has_no_room { Reach::Anything } else { Reach::Force }
    }

    fn before(&self) -> usize {
        self.before
    }
}

impl<S: Scalar> Physics<S> for ActuatorTerm {
    fn drive(&self, p: &[S], _ship: &Ship, dt: f64, series: &mut [Inputs<S>]) {
        let p = &p[self.before..];
        if let Some(partner) = self.partner {
            for commands in series.iter_mut().map(|inputs| &mut inputs.commands) {
                for (own, other) in (self.slot..).zip(partner..).take(self.channels) {
                    let exchanged = (commands[other] - commands[own]) * p[self.swap()];
                    commands[own] += exchanged;
                    commands[other] -= exchanged;
                }
            }
        }
        for slot in self.slot..self.slot + self.lagged {
            first_order(p[self.lag], dt, series, |i| &mut i.commands[slot]);
        }
        if let Some(lag) = self.turn_lag {
            let slot = self.slot + self.lagged;
            let sign = S::one() - p[lag + 1] * 2.0;
            series.iter_mut().for_each(|inputs| inputs.commands[slot] *= sign);
            // The shorter way from sample to sample, and not back through all of a turn.
            for k in 1..series.len() {
                let before = series[k - 1].commands[slot];
                let angle = &mut series[k].commands[slot];
                *angle -= ((*angle - before) / TAU).nearest() * TAU;
            }
            first_order(p[lag], dt, series, |i| &mut i.commands[slot]);
        }
    }

    fn force(&self, p: &[S::Coefficient], at: &Instant<S>, flow: &Flow<S>) -> Force<S> {
        let (upstream, p) = p.split_at(self.before);
        let command = |i: usize| at.inputs.commands[self.slot + i];
        let [x, y] = self.place;
        let left = S::Coefficient::one() - p[self.lost()];
        let direction = || self.direction(p, at.inputs);
        let (thrust, [sin, cos]) = match &self.push {
            Push::Logged(components) => {
                let mut force = Force::<S::Coefficient>::zero();
                for (i, component) in components.iter().enumerate() {
                    let pushed = p[i] * command(i) * left;
                    match component {
                        Component::X => force.x = pushed,
                        Component::Y => force.y = pushed,
                        Component::N => force.n = pushed,
                    }
                }
                let n = force.n + force.y * x - force.x * y;
                return Force { x: S::lift(force.x), y: S::lift(force.y), n: S::lift(n) };
            }
            Push::Foil(blade) => return blade.force(p, upstream, [p[self.lag - 1], left], at, flow),
            Push::Order => (S::lift(p[0] * command(0) * left), direction()),
            Push::Thruster => {
                let [sin, cos] = direction();
                let n = command(0);
                let (zero, one) = (S::Coefficient::zero(), S::Coefficient::one());
                let ahead = p[0] * left;
                let gain = ahead * S::Coefficient::select(n.less(zero), p[2], one);
                let inflow = (flow.u - flow.r * y) * cos + (flow.v + flow.r * x) * sin;
                (S::lift(gain * n * n.abs()) - inflow * (ahead * p[1] * n.abs()), [sin, cos])
            }
            Push::Propeller(screw) => {
                let axis = direction();
                let [_, thrust] = screw.advance_and_thrust(p, axis, left, at, flow);
                (Screw::net(p, thrust), axis)
            }
        };
        let (along, aside) = (thrust * cos, thrust * sin);
        Force { x: along, y: aside, n: aside * x - along * y }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::dynamics::Dynamics;
    use crate::model::Model;
    use crate::physics::Form;
    use crate::state::{STATES, State};
    use std::path::Path;

    /// A catamaran with a thruster on each side, a pair of azimuths, and a force as logged.
    const CRAFT: &str = "name = \"cat\"\n[hull]\nlpp = 1.2\nbreadth = 0.9\nmass = 17.0\n\
        [[actuator]]\nname = \"left\"\nx = -0.4\ny = -0.3\nlaw = \"thruster\"\nangle = 0\n\
        [[actuator]]\nname = \"fore\"\nx = 0.4\ny = -0.2\nlaw = \"order\"\nlag = 0.5\n\
        [[actuator]]\nname = \"right\"\nx = -0.4\ny = 0.3\nlaw = \"thruster\"\nangle = 0\n\
        [[actuator]]\nname = \"aft\"\nx = 0.4\ny = 0.2\nlaw = \"order\"\nlag = \"free\"\n\
        [[actuator]]\nname = \"tau\"\nlaw = \"force\"\n";

    fn model() -> Model {
        let ship = Ship::parse(CRAFT, Path::new("ship.toml")).unwrap();
        Model::new(ship, "cat", Form::General, &[]).unwrap()
    }

    fn recorded() -> Vec<Inputs<f64>> {
        let at = |k: usize| {
            let mut inputs = Inputs::actuators(0.1 * k as f64, 0.0, 0.0);
            inputs.commands = std::array::from_fn(|c| (0.3 * k as f64 + c as f64).sin());
            inputs
        };
        (0..50).map(at).collect()
    }

    /// The recording as it drives the craft with some faults.
    fn driven(faults: &[(&str, f64)], series: &[Inputs<f64>]) -> Vec<Inputs<f64>> {
        let (mut model, mut series) = (model(), series.to_vec());
        model.set(&[("aft.lag", 0.0), ("aft.turn_lag", 0.0), ("fore.lag", 0.0)]).unwrap();
        model.set(faults).unwrap();
        Dynamics::new(&model, model.values()).drive(0.1, &mut series);
        series
    }

    /// The force of each actuator with some faults: by name, X, Y, N.
    fn forces(faults: &[(&str, f64)]) -> Vec<(&'static str, [f64; 3])> {
        let mut model = model();
        model.set(faults).unwrap();
        let dynamics = Dynamics::new(&model, model.values());
        let state = State::from_array([0.0, 0.0, 0.3, 0.5, -0.1, 0.2]);
        let all = dynamics.contributions(&state, &recorded()[7]);
        let named = all.into_iter().filter(|(name, _)| model.ship.actuator(name).is_some());
        named.map(|(name, force)| (name, force.to_array())).collect()
    }

    #[test]
    fn each_actuator_has_its_faults_by_name_and_none_that_its_model_frees() {
        let model = model();
        let of = |name: &str| -> Vec<&str> {
            let info = model.catalogue().find(name).unwrap().info();
            info.mechanisms.iter().map(|m| m.name).collect()
        };
        assert_eq!(of("left"), ["left.lost", "left.lag", "left.zero", "left.swap"]);
        assert_eq!(of("right"), ["right.lost", "right.lag", "right.zero"]);
        assert_eq!(of("fore"), ["fore.lost", "fore.zero", "fore.other_sign", "fore.swap"], "its lags are given");
        assert_eq!(of("aft"), ["aft.lost", "aft.zero", "aft.other_sign"]);
        assert_eq!(of("tau"), ["tau.lost", "tau.lag"]);
        let all = model.catalogue().iter().flat_map(|t| t.info().mechanisms.iter().map(|m| (t.info(), m)));
        for (info, m) in all.filter(|(info, _)| model.ship.actuator(info.name).is_some()) {
            let own = m.parameters.iter().all(|p| info.parameters.iter().any(|q| q.name == *p));
            let known =
                |name: &str| model.catalogue().iter().any(|t| t.info().mechanisms.iter().any(|m| m.name == name));
            assert!(own && m.title.contains(info.name) && m.look_alikes.iter().all(|n| known(n)), "{}", m.name);
        }
        let swap = model.catalogue().find("left").unwrap().info().mechanisms[3].title;
        assert!(swap.contains("left") && swap.contains("right"), "{swap}");
    }

    #[test]
    fn a_sound_actuator_changes_no_bit_of_its_recording() {
        assert_eq!(driven(&[], &recorded()), recorded());
    }

    #[test]
    fn what_is_swapped_has_the_recording_of_its_partner_and_swapped_again_its_own() {
        let recorded = recorded();
        let swap = [("left.swap", 1.0), ("fore.swap", 1.0)];
        let once = driven(&swap, &recorded);
        // left.rate, fore.order and angle, right.rate, aft.order and angle, tau.X, Y and N.
        let partner = [3, 4, 5, 0, 1, 2, 6, 7, 8];
        for (a, b) in recorded.iter().zip(&once) {
            assert!((0..9).all(|c| (b.commands[c] - a.commands[partner[c]]).abs() < 1e-15), "{a:?} {b:?}");
        }
        for (a, b) in recorded.iter().zip(&driven(&swap, &once)) {
            assert!(a.commands.iter().zip(b.commands).all(|(a, b)| (a - b).abs() < 1e-15), "{a:?} {b:?}");
        }
        // Half of each: both have the mean.
        let half = driven(&[("left.swap", 0.5)], &recorded);
        assert!(half.iter().all(|i| (i.commands[0] - i.commands[3]).abs() < 1e-15));
    }

    #[test]
    fn a_lag_is_that_of_the_actuator_and_not_of_the_recording_that_it_is_given() {
        let recorded = recorded();
        let late = driven(&[("left.swap", 1.0), ("left.lag", 0.4)], &recorded);
        let alone = driven(&[("right.lag", 0.4)], &recorded);
        for (a, (b, c)) in recorded.iter().zip(late.iter().zip(&alone)) {
            assert!((b.commands[3] - a.commands[0]).abs() < 1e-15 && (b.commands[0] - c.commands[3]).abs() < 1e-15);
        }
    }

    #[test]
    fn a_direction_follows_its_angle_late_the_shorter_way_and_not_its_order() {
        let mut recorded = recorded();
        // Past astern, where the recording jumps from half a turn to minus half a turn.
        for (k, inputs) in recorded.iter_mut().enumerate() {
            let angle = 3.0 + 0.02 * k as f64;
            inputs.commands[2] = angle.sin().atan2(angle.cos());
        }
        let late = driven(&[("fore.turn_lag", 0.4)], &recorded);
        for (k, (a, b)) in recorded.iter().zip(&late).enumerate().skip(30) {
            assert_eq!(a.commands[1], b.commands[1]);
            // A ramp is followed by its slope times the time constant behind.
            let expected = 3.0 + 0.02 * k as f64 - 0.2 * 0.4;
            assert!((b.commands[2] - expected).abs() < 1e-4, "{k} {}", b.commands[2]);
        }
    }

    #[test]
    fn an_angle_with_the_other_sign_turns_to_the_other_side_and_no_other_channel_changes() {
        let recorded = recorded();
        for (a, b) in recorded.iter().zip(&driven(&[("aft.other_sign", 1.0)], &recorded)) {
            let expected: Vec<f64> = a.commands.iter().enumerate().map(|(c, v)| if c == 5 { -v } else { *v }).collect();
            assert!(b.commands.iter().zip(expected).all(|(b, a)| (b - a).sin().abs() < 1e-12), "{b:?}");
        }
    }

    #[test]
    fn an_actuator_that_lost_all_is_dead_and_one_that_lost_twice_that_pushes_the_other_way() {
        let sound = forces(&[]);
        for (i, (name, own)) in sound.iter().enumerate() {
            let lost = |share: f64| forces(&[(format!("{name}.lost").as_str(), share)]);
            let [half, dead, reversed] = [0.5, 1.0, 2.0].map(lost);
            assert!(own.iter().any(|f| *f != 0.0), "{name}");
            for c in 0..3 {
                let size = 1e-12 * own[c].abs();
                assert!((half[i].1[c] - 0.5 * own[c]).abs() <= size && dead[i].1[c] == 0.0, "{name}");
                assert!((reversed[i].1[c] + own[c]).abs() <= size, "{name}");
            }
            assert!((0..sound.len()).filter(|j| *j != i).all(|j| dead[j] == sound[j]), "{name}");
        }
    }

    #[test]
    fn an_offset_turns_the_force_of_an_actuator_at_rest_with_a_fixed_direction_or_a_recorded_one() {
        let model = model();
        let at_rest = |faults: &[(&str, f64)], name: &str| {
            let mut model = model.clone();
            model.set(faults).unwrap();
            let dynamics = Dynamics::new(&model, model.values());
            let all = dynamics.contributions(&State::from_array([0.0; STATES]), &recorded()[7]);
            all.into_iter().find(|(own, _)| *own == name).unwrap().1.to_array()
        };
        for name in ["left", "fore"] {
            let zero = format!("{name}.zero");
            let ([x, y, _], [turned_x, turned_y, _]) = (at_rest(&[], name), at_rest(&[(zero.as_str(), 0.1)], name));
            let (sin, cos) = 0.1_f64.sin_cos();
            assert!((turned_x - (x * cos - y * sin)).abs() < 1e-12, "{name}");
            assert!((turned_y - (y * cos + x * sin)).abs() < 1e-12, "{name}");
        }
    }
}
