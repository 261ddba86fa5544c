//! What the terms share at one instant: water-relative velocity, propeller thrust and rudder inflow.
//! It gives no force itself; its parameters (wake, thrust, race, straightening) are those of the pseudo-term `flow`.

use super::instant::{Form, Instant};
use crate::ship::Ship;
use std::f64::consts::PI;
use trimtab_ad::{Dual, Scalar};

/// Declares the modifiers: one line for each, with its neutral value.
macro_rules! modifiers {
    ($($(#[$doc:meta])+ $name:ident = $neutral:literal),+ $(,)?) => {
        /// What terms may change for the others before forces are computed, by their parameters and the inputs: no modifier
        /// depends on the state. Neutral: no current, zero additions, factors 1.
        #[derive(Clone, Copy, Debug)]
        pub struct Adjust<S> {
            /// Current over ground \[m/s\], (north, east) components of where it sets to.
            pub current: [S; 2],
            /// Added to the sway-yaw \[kg m\] and yaw-yaw \[kg m2\] entries of the mass matrix per cube of speed through the
            /// water; `None` where no term adds anything.
            pub roll: Option<[S; 2]>,
            /// Wake in a turn: C_1, the mean of C_2 and half its difference between the sides (term `mmg_wake`); `None` where no
            /// term gives it.
            pub wake_turn: Option<[S; 3]>,
            $($(#[$doc])+ pub $name: S,)+
        }

        impl<S: Scalar> Adjust<S> {
            /// No change to anything.
            #[inline(always)]
            pub fn neutral() -> Self {
                Self { current: [S::zero(); 2], roll: None, wake_turn: None, $($name: S::from_f64($neutral),)+ }
            }

            /// The modifiers in another number.
            #[inline(always)]
            pub fn map<T>(&self, f: impl Fn(S) -> T) -> Adjust<T> {
                Adjust {
                    current: self.current.map(&f),
                    roll: self.roll.map(|roll| roll.map(&f)),
                    wake_turn: self.wake_turn.map(|wake| wake.map(&f)),
                    $($name: f(self.$name),)+
                }
            }
        }
    };
}

modifiers! {
    /// Added to the effective wake fraction \[-\].
    wake = 0.0,
    /// Wake lost per squared sine of the drift angle at the propeller \[-\].
    wake_relief = 0.0,
    /// Wake gained per sine of the drift angle at the propeller, stern moving to starboard \[-\].
    wake_asymmetry = 0.0,
    /// Factor on propeller thrust \[-\].
    thrust = 1.0,
    /// Factor on the propeller race factor kappa \[-\].
    race = 1.0,
    /// Factor on resistance \[-\].
    resistance = 1.0,
    /// Factor on the sway force of drift, Y_v \[-\].
    sway = 1.0,
    /// Factor on that of large drift, Y_vv or Y_vvv \[-\].
    sway_drag = 1.0,
    /// Factor on that of drift in a turn and of a fast turn, Y_vr and Y_rr, or Y_vvr, Y_vrr and Y_rrr \[-\].
    sway_mixed = 1.0,
    /// Factor on the yaw moment of drift, N_v and N_vvv \[-\].
    yaw_static = 1.0,
    /// Factor on that of drift in a turn, N_vvr and N_rrv or N_vrr \[-\].
    yaw_mixed = 1.0,
    /// Factor on the rotary derivatives Y_r and N_r \[-\].
    rotary = 1.0,
    /// Factor on the yaw moment of a fast turn, N_rr or N_rrr \[-\].
    rotary_drag = 1.0,
    /// Factor on sway and yaw added mass \[-\].
    added_mass = 1.0,
    /// Factor on the ship's mass and yaw inertia \[-\].
    mass = 1.0,
    /// Shift of the centre of gravity \[m\], forward.
    x_g = 0.0,
    /// Share (0 paper form, 1 fore-aft consistent form) of the sternway correction \[-\].
    sternway = 0.0,
    /// Fraction of the rudder's lift that is lost beyond stall \[-\].
    stall = 0.0,
    /// Angle of attack at which it begins to be lost \[rad\].
    stall_onset = 0.0,
}

/// Velocities and inflows at one instant.
#[derive(Clone, Copy, Debug)]
pub struct Flow<S: Scalar> {
    /// Surge velocity through the water \[m/s\].
    pub u: S,
    /// Sway velocity through the water \[m/s\].
    pub v: S,
    /// Yaw rate \[rad/s\].
    pub r: S,
    /// Speed through the water, regularised: sqrt(u^2 + v^2 + small^2) \[m/s\].
    pub speed: S,
    /// sqrt(u^2 + small^2) \[m/s\].
    pub abs_u: S,
    /// sqrt(v^2 + small^2) \[m/s\].
    pub abs_v: S,
    /// sqrt(r^2 + (small/L)^2) \[rad/s\].
    pub abs_r: S,
    /// Current in body axes \[m/s\].
    pub current: [S; 2],
    /// Propeller advance velocity \[m/s\].
    pub advance: S,
    /// Propeller thrust T \[N\], before thrust deduction.
    pub thrust: S,
    /// Net propeller force X_n \[N\], after thrust deduction.
    pub propulsion: S,
    /// Axial rudder inflow u_R \[m/s\].
    pub rudder_u: S,
    /// Lateral rudder inflow v_R = -gamma (v + l_R r) \[m/s\]; in form `mmg` U beta for -v.
    pub rudder_v: S,
    /// What other terms changed.
    pub adjust: Adjust<S::Coefficient>,
}

/// Indices of the flow parameters, of which the first six are those of any propeller.
pub(crate) mod index {
    pub const WAKE: usize = 0;
    pub const THRUST_DEDUCTION: usize = 1;
    pub const KT0: usize = 2;
    pub const KT1: usize = 3;
    pub const KT2: usize = 4;
    pub const ASTERN: usize = 5;
    pub const WAKE_RATIO: usize = 6;
    pub const RACE: usize = 7;
    pub const RACE_ASTERN: usize = 8;
    pub const STRAIGHTENING: usize = 9;
    pub const ASYMMETRY: usize = 10;
    pub const LEVER: usize = 11;
    /// How many there are.
    pub const COUNT: usize = 12;
}

/// What the parameters of the flow act through: its quantities at propeller and rudder, in the units of [`Flow`].
#[derive(Clone, Copy, Debug)]
pub struct Inflow<S> {
    /// Propeller advance velocity.
    pub advance: S,
    /// Propeller thrust.
    pub thrust: S,
    /// Net propeller force.
    pub propulsion: S,
    /// Axial rudder inflow.
    pub rudder_u: S,
    /// Lateral rudder inflow.
    pub rudder_v: S,
}

impl<S: Scalar> Flow<S> {
    /// Flow at an instant, from the parameters `p` of the term `flow` and what other terms adjusted.
    ///
    /// Propeller (all quadrants, continuous through n = 0 and u = 0):
    /// `T = f rho (k0 D^4 n|n| + k1 D^3 |n| V_A + k2 D^2 V_A |V_A|)`, k0 times `astern` and k1 times 0.3 for n < 0 (crash-back of
    /// the Wageningen B4-70 chart), `V_A = (1 - w) u` ahead and `u` astern; `X_n = (1 - t) T` ahead, `T` astern. For n, u > 0
    /// this is `rho n^2 D^4 K_T(J)`.
    ///
    /// Rudder (Yasukawa & Yoshimura 2015, eq. 22 to 26, written so that n -> 0 and u -> 0 are regular):
    /// `a = u_P + kappa (sqrt(u_P^2 + c+) - u_P) - kappa_a sqrt(c-)`, `c = 8 T / (pi rho D^2)`,
    /// `u_R^2 = eps^2 (eta a|a| + (1 - eta) u_P|u_P|)` with its sign, `eta = D/H_R`.
    ///
    /// With `still` there is no current, whatever `adjust` says.
    #[inline(always)]
    pub fn new(p: &[S::Coefficient], at: &Instant<S>, adjust: Adjust<S::Coefficient>, still: bool) -> Self {
        let ship = at.ship;
        let small = at.small;
        let tiny = small * small;
        let (u, v, r) = (at.state.u, at.state.v, at.state.r);
        let (u, v, current) = if still {
            (u, v, [S::zero(); 2])
        } else {
            let current = at.to_body(adjust.current);
            (u - current[0], v - current[1], current)
        };
        let speed = (u * u + v * v + tiny).sqrt();
        let abs_u = (u * u + tiny).sqrt();
        let abs_v = (v * v + tiny).sqrt();
        let abs_r = (r * r + tiny / (ship.hull.lpp * ship.hull.lpp)).sqrt();

        let ahead = ahead(u, abs_u);
        // Sine of the drift angle at the propeller.
        let side = v + r * ship.propeller_x();
        let drift = side / (u * u + side * side + tiny).sqrt();
        let relief = drift * adjust.wake_relief - adjust.wake_asymmetry;
        let mut wake = p[index::WAKE] + adjust.wake - drift * relief;
        if let Some(turn) = adjust.wake_turn {
            let kept = S::Coefficient::one() - p[index::WAKE] - adjust.wake;
            wake -= turning_wake(ship, turn, [v, r], [speed, abs_u]) * kept;
        }
        let wake = wake * ahead;
        let advance = (S::one() - wake) * u;
        let screw = [p[index::KT0], p[index::KT1], p[index::KT2], p[index::ASTERN]];
        let d = ship.propeller.diameter;
        let thrust = thrust(d, small, screw, advance, at.inputs.n) * (adjust.thrust * ship.hull.water_density);
        let positive = S::zero().less(thrust);
        let deducted = S::select(positive, thrust * p[index::THRUST_DEDUCTION], S::zero());
        let propulsion = thrust - deducted;
        let race = [p[index::RACE] * adjust.race, p[index::RACE_ASTERN], p[index::WAKE_RATIO]];
        let rudder_u = axial(&Race::of(ship), small, race, advance, thrust);
        let bend = [p[index::STRAIGHTENING], p[index::ASYMMETRY], p[index::LEVER]];
        let rudder_v = lateral(ship.hull.lpp, small, bend, across(at.form, v, speed, abs_u), r);
        Self { u, v, r, speed, abs_u, abs_v, abs_r, current, advance, thrust, propulsion, rudder_u, rudder_v, adjust }
    }
}

impl<S: Scalar> Flow<S> {
    /// The flow in another number: `f` converts what depends on the state, `g` what terms changed.
    #[inline(always)]
    pub fn map<T: Scalar>(&self, f: impl Fn(S) -> T, g: impl Fn(S::Coefficient) -> T::Coefficient) -> Flow<T> {
        Flow {
            u: f(self.u),
            v: f(self.v),
            r: f(self.r),
            speed: f(self.speed),
            abs_u: f(self.abs_u),
            abs_v: f(self.abs_v),
            abs_r: f(self.abs_r),
            current: self.current.map(&f),
            advance: f(self.advance),
            thrust: f(self.thrust),
            propulsion: f(self.propulsion),
            rudder_u: f(self.rudder_u),
            rudder_v: f(self.rudder_v),
            adjust: self.adjust.map(g),
        }
    }
}

impl<S: Scalar<Coefficient = S>> Flow<S> {
    /// Derivatives of the flow by each of its parameters `p`, in their order. Each law of [`Flow::new`] is differentiated by its own
    /// few arguments with dual numbers, and the chain rule joins them.
    #[inline(always)]
    pub fn slopes(&self, p: &[S], at: &Instant<S>) -> [Inflow<S>; index::COUNT] {
        let (ship, small) = (at.ship, at.small);
        let zero = S::zero();
        let still = Inflow { advance: zero, thrust: zero, propulsion: zero, rudder_u: zero, rudder_v: zero };
        let mut out = [still; index::COUNT];

        let [k0, k1, k2, astern, advance] =
            seeded([p[index::KT0], p[index::KT1], p[index::KT2], p[index::ASTERN], self.advance]);
        let unit = self.adjust.thrust * ship.hull.water_density;
        let d = ship.propeller.diameter;
        let by_screw =
            thrust(d, small, [k0, k1, k2, astern], advance, Dual::constant(at.inputs.n)).eps.map(|slope| slope * unit);
        let race = p[index::RACE] * self.adjust.race;
        let [race, race_astern, ratio, advance, thrust] =
            seeded([race, p[index::RACE_ASTERN], p[index::WAKE_RATIO], self.advance, self.thrust]);
        let by_race = axial(&Race::of(ship), small, [race, race_astern, ratio], advance, thrust).eps;
        let bend = seeded([p[index::STRAIGHTENING], p[index::ASYMMETRY], p[index::LEVER]]);
        let across = across(at.form, self.v, self.speed, self.abs_u);
        let by_bend = lateral(ship.hull.lpp, small, bend, Dual::constant(across), Dual::constant(self.r)).eps;

        let positive = zero.less(self.thrust);
        let left = S::select(positive, S::one() - p[index::THRUST_DEDUCTION], S::one());
        let by_thrust =
            |slope: S| Inflow { thrust: slope, propulsion: slope * left, rudder_u: slope * by_race[4], ..still };
        let gained = |turn| turning_wake(ship, turn, [self.v, self.r], [self.speed, self.abs_u]);
        let advance = -(ahead(self.u, self.abs_u) * self.u);
        let advance = advance + advance * self.adjust.wake_turn.map_or(zero, gained);
        let wake = by_thrust(by_screw[4] * advance);
        out[index::WAKE] = Inflow { advance, rudder_u: wake.rudder_u + by_race[3] * advance, ..wake };
        out[index::THRUST_DEDUCTION].propulsion = S::select(positive, -self.thrust, zero);
        for (j, slope) in [index::KT0, index::KT1, index::KT2, index::ASTERN].into_iter().zip(by_screw) {
            out[j] = by_thrust(slope);
        }
        out[index::RACE].rudder_u = by_race[0] * self.adjust.race;
        out[index::RACE_ASTERN].rudder_u = by_race[1];
        out[index::WAKE_RATIO].rudder_u = by_race[2];
        for (j, slope) in [index::STRAIGHTENING, index::ASYMMETRY, index::LEVER].into_iter().zip(by_bend) {
            out[j].rudder_v = slope;
        }
        out
    }
}

/// Numbers as the variables that a law is differentiated by.
#[inline(always)]
fn seeded<S: Scalar, const N: usize>(values: [S; N]) -> [Dual<S, N>; N] {
    std::array::from_fn(|j| Dual::variable(values[j], j))
}

/// 0 astern to 1 ahead, over a few small speeds.
#[inline(always)]
pub(crate) fn ahead<S: Scalar>(u: S, abs_u: S) -> S {
    (u / abs_u + 1.0) * 0.5
}

/// By which share a turn raises 1 - w_P0 (Yasukawa & Yoshimura 2015, eq. 17 and 18): (1 - exp(-C_1 |b|)) (C_2 - 1), with the drift
/// angle at the propeller b = beta - x_P' r' and C_2 by its side. The change of side is smooth over a thousandth of a radian.
#[inline(always)]
fn turning_wake<S: Scalar>(
    ship: &Ship,
    [c1, mean, half]: [S::Coefficient; 3],
    [v, r]: [S; 2],
    [speed, abs_u]: [S; 2],
) -> S {
    const SMOOTH: f64 = 1e-3;
    let drift = -v.atan2(abs_u) - r * ship.propeller_x() / speed;
    let size = (drift * drift + SMOOTH * SMOOTH).sqrt();
    let c2 = drift / size * half + mean;
    (S::one() - (-(size - SMOOTH) * c1).exp()) * (c2 - 1.0)
}

/// The lateral velocity at midship that the rudder's inflow is made of \[m/s\]: v, and in form `mmg` -U beta, which the standard
/// method prints; they agree to second order in the drift angle. Ahead and astern alike.
#[inline(always)]
fn across<S: Scalar>(form: Form, v: S, speed: S, abs_u: S) -> S {
    if form == Form::Mmg { speed * v.atan2(abs_u) } else { v }
}

/// Thrust over the density of water, before what terms change \[m4/s2\], from k0, k1, k2 and `astern`.
#[inline(always)]
pub(crate) fn thrust<S: Scalar>(
    diameter: f64,
    small: f64,
    [k0, k1, k2, astern]: [S::Coefficient; 4],
    advance: S,
    n: S::Coefficient,
) -> S {
    let d = diameter;
    let (zero, one) = (S::Coefficient::zero(), S::Coefficient::one());
    let reverse = n.less(zero);
    let k0 = k0 * S::Coefficient::select(reverse, astern, one);
    let k1 = k1 * S::Coefficient::select(reverse, S::Coefficient::from_f64(0.3), one);
    let abs_n = n.abs();
    let pace = (advance * advance + 1e-2 * small * small).sqrt();
    advance * (k1 * abs_n * d.powi(3)) + advance * pace * (k2 * d.powi(2)) + k0 * n * abs_n * d.powi(4)
}

/// A propeller and the blade that stands in its race.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Race {
    /// Density of the water \[kg/m3\].
    pub density: f64,
    /// Diameter of the propeller \[m\].
    pub diameter: f64,
    /// Span of the blade \[m\].
    pub span: f64,
}

impl Race {
    /// That of propeller and rudder.
    #[inline(always)]
    fn of(ship: &Ship) -> Self {
        Self { density: ship.hull.water_density, diameter: ship.propeller.diameter, span: ship.rudder.span }
    }
}

/// Axial rudder inflow u_R \[m/s\] from kappa, kappa_a and eps, the advance velocity \[m/s\] and the thrust \[N\].
#[inline(always)]
pub(crate) fn axial<S: Scalar>(
    behind: &Race,
    small: f64,
    [race, race_astern, ratio]: [S::Coefficient; 3],
    advance: S,
    thrust: S,
) -> S {
    let (rho, d) = (behind.density, behind.diameter);
    let tiny = small * small;
    let positive = S::zero().less(thrust);
    let c = thrust * (8.0 / (PI * rho * d * d));
    let c_ahead = S::select(positive, c, S::zero());
    let c_astern = S::select(positive, S::zero(), -c);
    let eta = (d / behind.span).min(1.0);
    let square = advance * advance + 1e-2 * tiny;
    let race = ((square + c_ahead).sqrt() - advance.abs()) * race
        - ((c_astern + 1e-2 * tiny).sqrt() - 0.1 * small) * race_astern;
    let a = advance + race;
    let square = a * a.abs() * eta + advance * advance.abs() * (1.0 - eta);
    // Signed square root, smooth through zero: s / (s^2 + small^4)^(1/4).
    square * ratio / (square * square + 1e-2 * tiny * tiny).sqrt().sqrt()
}

/// Lateral rudder inflow v_R \[m/s\] from gamma, dgamma and l_R/L, at a lateral velocity \[m/s\] and a yaw rate \[rad/s\].
#[inline(always)]
pub(crate) fn lateral<S: Scalar>(
    lpp: f64,
    small: f64,
    [straightening, asymmetry, lever]: [S::Coefficient; 3],
    v: S,
    r: S,
) -> S {
    let lateral = v + r * (lever * lpp);
    -lateral * (straightening + lateral * asymmetry / (lateral * lateral + small * small).sqrt())
}
