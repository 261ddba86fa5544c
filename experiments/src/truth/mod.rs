//! The truth: ship simulators, ships, trials, captive tests and scenarios that stand in for the sea in the experiments.
//! It is not part of the library: nothing here may reach the model, the fit or the diagnosis, and nothing here uses their code.
//!
//! Two simulators with different physics stand behind one trait, [`Truth`]: [`mmg`] after Yasukawa & Yoshimura (2015) and
//! [`large_drift`], a reconstruction of a large-drift simulator with a flapped rudder. Axes: x forward, y starboard, psi
//! clockwise from north, r > 0 bow to starboard, delta > 0 turns the ship to starboard; origin midship; SI units, radians, rps.

pub mod captive;
pub mod crossflow;
pub mod dataset;
pub mod hd;
pub mod helmsman;
pub mod large_drift;
pub mod mmg;
pub mod propeller;
pub mod ships;
pub mod trial;

use std::fmt;
use std::ops::Add;
use std::sync::Arc;

/// Largest RK4 step of a truth simulation \[s\].
pub const MAX_STEP: f64 = 0.1;

/// Where the ship is and how she moves over the ground.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct State {
    /// Position north \[m\].
    pub x: f64,
    /// Position east \[m\].
    pub y: f64,
    /// Heading, clockwise from north, not wrapped \[rad\].
    pub psi: f64,
    /// Surge velocity over ground, ahead positive \[m/s\].
    pub u: f64,
    /// Sway velocity over ground at midship, to starboard positive \[m/s\].
    pub v: f64,
    /// Yaw rate, bow to starboard positive \[rad/s\].
    pub r: f64,
}

impl State {
    /// The state as `[x, y, psi, u, v, r]`.
    pub fn to_array(self) -> [f64; 6] {
        [self.x, self.y, self.psi, self.u, self.v, self.r]
    }

    /// The state from `[x, y, psi, u, v, r]`.
    pub fn from_array([x, y, psi, u, v, r]: [f64; 6]) -> Self {
        Self { x, y, psi, u, v, r }
    }

    /// Speed over ground sqrt(u^2 + v^2) \[m/s\].
    pub fn speed(&self) -> f64 {
        self.u.hypot(self.v)
    }

    fn plus(self, rate: [f64; 6], h: f64) -> Self {
        let mut s = self.to_array();
        for (value, slope) in s.iter_mut().zip(rate) {
            *value += h * slope;
        }
        Self::from_array(s)
    }
}

/// What the actuators really do: positions reached, not commands.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Inputs {
    /// Propeller rate, ahead positive \[rps\].
    pub n: f64,
    /// Rudder angle, turning the ship to starboard positive \[rad\].
    pub delta: f64,
}

impl Inputs {
    fn between(from: &Self, to: &Self, fraction: f64) -> Self {
        Self { n: from.n + fraction * (to.n - from.n), delta: from.delta + fraction * (to.delta - from.delta) }
    }
}

/// A force on the body axes, moment about midship included.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Force {
    /// Surge force, forward positive \[N\].
    pub x: f64,
    /// Sway force, to starboard positive \[N\].
    pub y: f64,
    /// Yaw moment, bow to starboard positive \[N m\].
    pub n: f64,
}

impl Add for Force {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, n: self.n + other.n }
    }
}

/// The force by origin, as a captive test with a rudder and a propeller dynamometer would give it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Contributions {
    /// Damping force of the bare hull (added mass is in [`Inertia`]).
    pub hull: Force,
    /// Effective thrust and side force of the propeller.
    pub propeller: Force,
    /// Rudder force, with what it induces on the hull.
    pub rudder: Force,
}

impl Contributions {
    /// Sum of the three.
    pub fn total(&self) -> Force {
        self.hull + self.propeller + self.rudder
    }
}

/// Inertia of ship and entrained water about midship.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inertia {
    /// Mass of the ship m \[kg\].
    pub mass: f64,
    /// Surge added mass m_x \[kg\].
    pub surge_added: f64,
    /// Sway added mass m_y \[kg\].
    pub sway_added: f64,
    /// Yaw inertia of ship and water about midship, I_zG + x_G^2 m + J_z \[kg m^2\].
    pub yaw: f64,
    /// Centre of gravity forward of midship x_G \[m\].
    pub xg: f64,
}

/// Main particulars of a ship, full scale or model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Particulars {
    /// Length between perpendiculars L \[m\].
    pub length: f64,
    /// Breadth B \[m\].
    pub breadth: f64,
    /// Draught d \[m\].
    pub draught: f64,
    /// Displacement volume \[m^3\].
    pub volume: f64,
    /// Centre of gravity forward of midship x_G \[m\].
    pub xg: f64,
    /// Density of the water rho \[kg/m^3\].
    pub rho: f64,
}

impl Particulars {
    /// Block coefficient Cb = volume / (L B d).
    pub fn block(&self) -> f64 {
        self.volume / (self.length * self.breadth * self.draught)
    }

    /// The similar ship of this length \[m\], in the same water.
    #[must_use]
    pub fn scaled(&self, length: f64) -> Self {
        let k = length / self.length;
        Self {
            length,
            breadth: k * self.breadth,
            draught: k * self.draught,
            volume: k.powi(3) * self.volume,
            xg: k * self.xg,
            rho: self.rho,
        }
    }

    /// Mass rho volume \[kg\].
    pub fn mass(&self) -> f64 {
        self.rho * self.volume
    }

    /// 1/2 rho L d, what a force coefficient is multiplied with (and with U^2) \[kg/m^2\].
    pub fn force_scale(&self) -> f64 {
        0.5 * self.rho * self.length * self.draught
    }
}

/// A force added from outside: wind, a bank, a tug, an effect to conceal. Called with time \[s\], state over ground and inputs;
/// gives `[X, Y, N]` in \[N, N, N m\] on the body axes about midship.
pub type ExtraForce = dyn Fn(f64, &State, &Inputs) -> [f64; 3] + Send + Sync;

/// What surrounds the ship: calm still water unless said otherwise.
#[derive(Clone, Default)]
pub struct Environment {
    /// Velocity of a uniform steady current, `[north, east]`, where the water flows to \[m/s\].
    pub current: [f64; 2],
    /// A force from outside, if any.
    pub extra: Option<Arc<ExtraForce>>,
}

impl fmt::Debug for Environment {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Environment").field("current", &self.current).field("extra", &self.extra.is_some()).finish()
    }
}

/// A truth simulator of one ship.
pub trait Truth: Send + Sync {
    /// Main particulars of the ship.
    fn particulars(&self) -> &Particulars;

    /// Inertia of ship and entrained water.
    fn inertia(&self) -> Inertia;

    /// Quasi-steady force at velocity through the water (u, v \[m/s\], r \[rad/s\]), propeller rate n \[rps\] and rudder
    /// angle delta \[rad\]. Finite and continuous in all four quadrants and at rest.
    fn force(&self, u: f64, v: f64, r: f64, n: f64, delta: f64) -> Contributions;

    /// Time derivative of `[x, y, psi, u, v, r]` at time `t` \[s\].
    ///
    /// In a uniform steady current the equations of motion hold unchanged for the velocity through the water nu_r;
    /// then nu' = nu_r' + (v_c r, -u_c r, 0), (u_c, v_c) being the current on the body axes:
    ///
    /// (m + m_x) u_r' = X + (m + m_y) v_r r + x_G m r^2
    /// (m + m_y) v_r' + x_G m r' = Y - (m + m_x) u_r r
    /// (I_zG + x_G^2 m + J_z) r' + x_G m v_r' = N - x_G m u_r r
    fn derivative(&self, t: f64, state: &State, inputs: &Inputs, environment: &Environment) -> [f64; 6] {
        let (sin, cos) = state.psi.sin_cos();
        let [north, east] = environment.current;
        let (u_c, v_c) = (north * cos + east * sin, -north * sin + east * cos);
        let (u, v, r) = (state.u - u_c, state.v - v_c, state.r);
        let mut force = self.force(u, v, r, inputs.n, inputs.delta).total();
        if let Some(extra) = &environment.extra {
            let [x, y, n] = extra(t, state, inputs);
            force = force + Force { x, y, n };
        }
        let i = self.inertia();
        let (m_surge, m_sway, m_xg) = (i.mass + i.surge_added, i.mass + i.sway_added, i.mass * i.xg);
        let du = (force.x + m_sway * v * r + m_xg * r * r) / m_surge;
        let y = force.y - m_surge * u * r;
        let n = force.n - m_xg * u * r;
        let det = m_sway * i.yaw - m_xg * m_xg;
        let dv = (i.yaw * y - m_xg * n) / det;
        let dr = (m_sway * n - m_xg * y) / det;
        [state.u * cos - state.v * sin, state.u * sin + state.v * cos, r, du + v_c * r, dv - u_c * r, dr]
    }
}

/// One classical Runge-Kutta step of `h` seconds from time `t`; the inputs run linearly from `from` to `to` over it.
pub fn rk4(
    truth: &dyn Truth,
    t: f64,
    state: &State,
    from: &Inputs,
    to: &Inputs,
    h: f64,
    environment: &Environment,
) -> State {
    let middle = Inputs::between(from, to, 0.5);
    let k1 = truth.derivative(t, state, from, environment);
    let k2 = truth.derivative(t + 0.5 * h, &state.plus(k1, 0.5 * h), &middle, environment);
    let k3 = truth.derivative(t + 0.5 * h, &state.plus(k2, 0.5 * h), &middle, environment);
    let k4 = truth.derivative(t + h, &state.plus(k3, h), to, environment);
    let mut slope = [0.0; 6];
    for i in 0..6 {
        slope[i] = (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]) / 6.0;
    }
    state.plus(slope, h)
}

/// Sails `period` seconds in equal RK4 steps of at most `max_step` seconds, the inputs running linearly from `from` to `to`.
pub fn sail(
    truth: &dyn Truth,
    t: f64,
    state: &State,
    from: &Inputs,
    to: &Inputs,
    period: f64,
    max_step: f64,
    environment: &Environment,
) -> State {
    let steps = (period / max_step - 1e-9).ceil().max(1.0) as usize;
    let h = period / steps as f64;
    let mut state = *state;
    for i in 0..steps {
        let begin = Inputs::between(from, to, i as f64 / steps as f64);
        let end = Inputs::between(from, to, (i + 1) as f64 / steps as f64);
        state = rk4(truth, t + i as f64 * h, &state, &begin, &end, h, environment);
    }
    state
}

/// Propeller rate at which the ship holds the ahead speed `u` \[m/s\] on a straight course with the rudder amidships \[rps\].
///
/// Found by bisection on the surge force, which rises with n; the result is clipped to 0..=`n_max`.
pub fn trimmed_rate(truth: &dyn Truth, u: f64, n_max: f64) -> f64 {
    let (mut low, mut high) = (0.0, n_max);
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if truth.force(u, 0.0, 0.0, middle, 0.0).total().x > 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    0.5 * (low + high)
}

/// 0 below `from`, 1 above `to`, and twice continuously differentiable between.
pub(crate) fn smooth_step(x: f64, from: f64, to: f64) -> f64 {
    let s = ((x - from) / (to - from)).clamp(0.0, 1.0);
    s * s * s * (10.0 - s * (15.0 - 6.0 * s))
}

/// How far the propeller turns astern, 0 at n >= 0 and 1 from |n| D = 0.3 |u| on.
///
/// The laws for ahead and for astern rotation do not meet at n = 0; this blends them over a narrow range of the advance ratio.
pub(crate) fn astern_weight(n: f64, diameter: f64, u: f64) -> f64 {
    // 1 cm/s keeps the ratio defined at rest, where every force it blends is below a newton or scales with n^2 anyway.
    smooth_step(-n * diameter, 0.0, 0.3 * u.hypot(0.01))
}

#[cfg(test)]
mod tests {
    use super::ships::{kvlcc2, ship_a, ship_b};
    use super::*;

    fn truths() -> Vec<Box<dyn Truth>> {
        vec![Box::new(ship_a()), Box::new(ship_b())]
    }

    #[test]
    fn force_is_finite_in_all_four_quadrants_and_at_rest() {
        let grid = [-6.0, -1.0, -1e-3, -1e-9, 0.0, 1e-9, 1e-3, 1.0, 6.0];
        let kvlcc2: Box<dyn Truth> = Box::new(kvlcc2());
        for truth in truths().into_iter().chain([kvlcc2]) {
            for u in grid {
                for v in grid {
                    for r in grid.map(|g| g * 0.01) {
                        for n in grid {
                            for delta in [-0.6, 0.0, 0.6] {
                                let f = truth.force(u, v, r, n, delta).total();
                                assert!(
                                    f.x.is_finite() && f.y.is_finite() && f.n.is_finite(),
                                    "{u} {v} {r} {n} {delta}"
                                );
                            }
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn force_is_continuous_through_zero_speed_and_zero_rate() {
        let e = 1e-7;
        for truth in truths() {
            let jump = |a: Contributions, b: Contributions| {
                let (a, b) = (a.total(), b.total());
                let l = truth.particulars().length;
                (a.x - b.x).abs().max((a.y - b.y).abs()).max((a.n - b.n).abs() / l)
            };
            for v in [-1.0, 0.3] {
                for r in [-0.02, 0.01] {
                    for n in [-2.0, -0.4, 0.4, 2.0] {
                        let j = jump(truth.force(e, v, r, n, 0.4), truth.force(-e, v, r, n, 0.4));
                        assert!(j < 50.0, "across u = 0: {j} N at v {v} r {r} n {n}");
                    }
                    for u in [-3.0, 0.5, 5.0] {
                        let j = jump(truth.force(u, v, r, e, 0.4), truth.force(u, v, r, -e, 0.4));
                        assert!(j < 50.0, "across n = 0: {j} N at u {u} v {v} r {r}");
                    }
                }
            }
        }
    }

    #[test]
    fn uniform_current_only_carries_the_ship_along() {
        let truth = ship_b();
        let current = Environment { current: [0.7, -0.4], extra: None };
        let inputs = Inputs { n: 1.5, delta: 0.3 };
        let mut still = State { u: 4.0, v: -0.2, r: 0.005, psi: 0.6, ..State::default() };
        let (sin, cos) = still.psi.sin_cos();
        let mut carried = State { u: 4.0 + 0.7 * cos - 0.4 * sin, v: -0.2 - 0.7 * sin - 0.4 * cos, ..still };
        let time = 100.0;
        for i in 0..1000 {
            let t = i as f64 * 0.1;
            still = rk4(&truth, t, &still, &inputs, &inputs, 0.1, &Environment::default());
            carried = rk4(&truth, t, &carried, &inputs, &inputs, 0.1, &current);
        }
        assert!((carried.x - still.x - 0.7 * time).abs() < 1e-6);
        assert!((carried.y - still.y + 0.4 * time).abs() < 1e-6);
        assert!((carried.psi - still.psi).abs() < 1e-8);
    }

    #[test]
    fn extra_force_enters_the_equations_of_motion() {
        let truth = ship_a();
        let pushed = Environment { extra: Some(Arc::new(|t, _, _| [1e4 * t, 0.0, 0.0])), ..Environment::default() };
        let (state, inputs) = (State { u: 3.0, ..State::default() }, Inputs { n: 1.5, delta: 0.0 });
        let calm = truth.derivative(2.0, &state, &inputs, &Environment::default());
        let gained = truth.derivative(2.0, &state, &inputs, &pushed);
        let i = truth.inertia();
        assert!((gained[3] - calm[3] - 2e4 / (i.mass + i.surge_added)).abs() < 1e-12);
        assert_eq!(gained[4..], calm[4..]);
    }

    #[test]
    fn runge_kutta_converges_with_fourth_order() {
        // A turn that has settled on one side: no kink of the straightening coefficient or of |v| is crossed.
        for truth in truths() {
            let start = State { u: 4.0, v: -0.8, r: 0.012, ..State::default() };
            let (from, to) = (Inputs { n: 1.6, delta: 0.3 }, Inputs { n: 2.0, delta: 0.4 });
            let run =
                |h: f64| sail(truth.as_ref(), 0.0, &start, &from, &to, 32.0, h, &Environment::default()).to_array();
            let exact = run(0.05);
            let error = |h: f64| run(h).iter().zip(exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            let order = (error(4.0) / error(2.0)).log2();
            assert!((3.5..4.8).contains(&order), "order {order}");
        }
    }

    #[test]
    fn smooth_step_runs_from_zero_to_one() {
        assert_eq!(smooth_step(-1.0, 0.0, 2.0), 0.0);
        assert_eq!(smooth_step(3.0, 0.0, 2.0), 1.0);
        assert!((smooth_step(1.0, 0.0, 2.0) - 0.5).abs() < 1e-15);
    }
}
