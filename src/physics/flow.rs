//! What the terms share at one instant: water-relative velocity, propeller thrust and rudder inflow.
//! It gives no force itself; its parameters (wake, thrust, race, straightening) are those of the pseudo-term `flow`.

use super::instant::Instant;
use std::f64::consts::PI;
use trimtab_ad::Scalar;

/// An earth-fixed (north, east) vector in body axes (forward, starboard) at heading `psi`.
pub fn to_body<S: Scalar>([north, east]: [S; 2], psi: S) -> [S; 2] {
    let (sin, cos) = psi.sin_cos();
    [north * cos + east * sin, east * cos - north * sin]
}

/// What terms may change for the others before forces are computed. Neutral: no current, zero additions, factors 1.
#[derive(Clone, Copy, Debug)]
pub struct Adjust<S> {
    /// Current over ground \[m/s\], (north, east) components of where it sets to.
    pub current: [S; 2],
    /// Added to the effective wake fraction \[-\].
    pub wake: S,
    /// Wake lost per squared sine of the drift angle at the propeller \[-\].
    pub wake_relief: S,
    /// Wake gained per sine of the drift angle at the propeller, stern moving to starboard \[-\].
    pub wake_asymmetry: S,
    /// Factor on propeller thrust \[-\].
    pub thrust: S,
    /// Factor on the propeller race factor kappa \[-\].
    pub race: S,
    /// Factor on resistance \[-\].
    pub resistance: S,
    /// Factor on sway-force derivatives \[-\].
    pub sway: S,
    /// Factor on the static yaw derivative N_v and N_vvr \[-\].
    pub yaw_static: S,
    /// Factor on the rotary derivatives Y_r, N_r, N_rr, N_rrv \[-\].
    pub rotary: S,
    /// Factor on sway and yaw added mass \[-\].
    pub added_mass: S,
    /// Factor on the ship's mass and yaw inertia \[-\].
    pub mass: S,
    /// Shift of the centre of gravity \[m\], forward.
    pub x_g: S,
    /// Added to the sway-yaw \[kg m\] and yaw-yaw \[kg m2\] entries of the mass matrix per cube of speed through the water.
    pub roll: [S; 2],
    /// Share (0 paper form, 1 fore-aft consistent form) of the sternway correction \[-\].
    pub sternway: S,
    /// Fraction of the rudder's lift that is lost beyond stall \[-\].
    pub stall: S,
    /// Angle of attack at which it begins to be lost \[rad\].
    pub stall_onset: S,
}

impl<S: Scalar> Adjust<S> {
    /// No change to anything.
    pub fn neutral() -> Self {
        let (zero, one) = (S::zero(), S::one());
        Self {
            current: [zero; 2],
            wake: zero,
            wake_relief: zero,
            wake_asymmetry: zero,
            thrust: one,
            race: one,
            resistance: one,
            sway: one,
            yaw_static: one,
            rotary: one,
            added_mass: one,
            mass: one,
            x_g: zero,
            roll: [zero; 2],
            sternway: zero,
            stall: zero,
            stall_onset: zero,
        }
    }
}

/// Velocities and inflows at one instant.
#[derive(Clone, Copy, Debug)]
pub struct Flow<S> {
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
    /// Lateral rudder inflow v_R = -gamma (v + l_R r) \[m/s\].
    pub rudder_v: S,
    /// What other terms changed.
    pub adjust: Adjust<S>,
}

/// Indices of the flow parameters.
mod index {
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
}

impl<S: Scalar> Flow<S> {
    /// A flow of plain numbers, as one without derivatives.
    pub fn constant(f: &Flow<f64>) -> Self {
        let c = S::from_f64;
        let a = &f.adjust;
        Self {
            u: c(f.u),
            v: c(f.v),
            r: c(f.r),
            speed: c(f.speed),
            abs_u: c(f.abs_u),
            abs_v: c(f.abs_v),
            abs_r: c(f.abs_r),
            current: f.current.map(c),
            advance: c(f.advance),
            thrust: c(f.thrust),
            propulsion: c(f.propulsion),
            rudder_u: c(f.rudder_u),
            rudder_v: c(f.rudder_v),
            adjust: Adjust {
                current: a.current.map(c),
                wake: c(a.wake),
                wake_relief: c(a.wake_relief),
                wake_asymmetry: c(a.wake_asymmetry),
                thrust: c(a.thrust),
                race: c(a.race),
                resistance: c(a.resistance),
                sway: c(a.sway),
                yaw_static: c(a.yaw_static),
                rotary: c(a.rotary),
                added_mass: c(a.added_mass),
                mass: c(a.mass),
                x_g: c(a.x_g),
                roll: a.roll.map(c),
                sternway: c(a.sternway),
                stall: c(a.stall),
                stall_onset: c(a.stall_onset),
            },
        }
    }

    /// Flow at a moment, from the parameters `p` of the term `flow` and what other terms adjusted.
    ///
    /// Propeller (all quadrants, continuous through n = 0 and u = 0):
    /// `T = f rho (k0 D^4 n|n| + k1 D^3 |n| V_A + k2 D^2 V_A |V_A|)`, k0 times `astern` and k1 times 0.3 for n < 0 (crash-back of
    /// the Wageningen B4-70 chart), `V_A = (1 - w) u` ahead and `u` astern; `X_n = (1 - t) T` ahead, `T` astern. For n, u > 0
    /// this is `rho n^2 D^4 K_T(J)`.
    ///
    /// Rudder (Yasukawa & Yoshimura 2015, eq. 22 to 26, written so that n -> 0 and u -> 0 are regular):
    /// `a = u_P + kappa (sqrt(u_P^2 + c+) - u_P) - kappa_a sqrt(c-)`, `c = 8 T / (pi rho D^2)`,
    /// `u_R^2 = eps^2 (eta a|a| + (1 - eta) u_P|u_P|)` with its sign, `eta = D/H_R`.
    pub fn new(p: &[S], at: &Instant<S>, adjust: Adjust<S>) -> Self {
        let ship = at.ship;
        let small = ship.small_speed();
        let tiny = small * small;
        let current = to_body(adjust.current, at.state.psi);
        let (u, v, r) = (at.state.u - current[0], at.state.v - current[1], at.state.r);
        let speed = (u * u + v * v + tiny).sqrt();
        let abs_u = (u * u + tiny).sqrt();
        let abs_v = (v * v + tiny).sqrt();
        let abs_r = (r * r + tiny / (ship.hull.lpp * ship.hull.lpp)).sqrt();

        let rho = ship.hull.water_density;
        let d = ship.propeller.diameter;
        let n = at.inputs.n;
        let abs_n = n.abs();
        // 0 astern to 1 ahead, over a few small speeds.
        let ahead = (u / abs_u + 1.0) * 0.5;
        // Sine of the drift angle at the propeller.
        let side = v + r * ship.propeller_x();
        let drift = side / (u * u + side * side + tiny).sqrt();
        let wake =
            (p[index::WAKE] + adjust.wake - drift * (adjust.wake_relief * drift - adjust.wake_asymmetry)) * ahead;
        let advance = (S::one() - wake) * u;
        let reverse = n.less(S::zero());
        let k0 = p[index::KT0] * S::select(reverse, p[index::ASTERN], S::one());
        let k1 = p[index::KT1] * S::select(reverse, S::from_f64(0.3), S::one());
        let thrust = adjust.thrust
            * rho
            * (k0 * d.powi(4) * n * abs_n
                + k1 * d.powi(3) * abs_n * advance
                + p[index::KT2] * d.powi(2) * advance * (advance * advance + 1e-2 * tiny).sqrt());
        let positive = S::zero().less(thrust);
        let propulsion = thrust * (S::one() - S::select(positive, p[index::THRUST_DEDUCTION], S::zero()));

        let c = thrust * (8.0 / (PI * rho * d * d));
        let c_ahead = S::select(positive, c, S::zero());
        let c_astern = S::select(positive, S::zero(), -c);
        let eta = (d / ship.rudder.span).min(1.0);
        let race = p[index::RACE] * adjust.race * ((advance * advance + c_ahead + 1e-2 * tiny).sqrt() - advance.abs())
            - p[index::RACE_ASTERN] * ((c_astern + 1e-2 * tiny).sqrt() - 0.1 * small);
        let a = advance + race;
        let square = a * a.abs() * eta + advance * advance.abs() * (1.0 - eta);
        // Signed square root, smooth through zero: s / (s^2 + small^4)^(1/4).
        let rudder_u = p[index::WAKE_RATIO] * square / (square * square + 1e-2 * tiny * tiny).sqrt().sqrt();
        let lever = p[index::LEVER] * ship.hull.lpp;
        let lateral = v + lever * r;
        let rudder_v =
            -lateral * (p[index::STRAIGHTENING] + p[index::ASYMMETRY] * lateral / (lateral * lateral + tiny).sqrt());
        Self { u, v, r, speed, abs_u, abs_v, abs_r, current, advance, thrust, propulsion, rudder_u, rudder_v, adjust }
    }
}
