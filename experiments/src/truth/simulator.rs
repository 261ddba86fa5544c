//! A truth simulator: the trait, the inertia of ship and water, and the equations of motion that all simulators share.
//! Forces are each simulator's own; time steps are in `integrate`.

use super::motion::{Contributions, Force, Inputs, Particulars, State};

/// Inertia of ship and entrained water about midship, as it enters the equations of motion
///
/// ```text
/// surge u' = X + carried[1] v r + mxg r^2
/// coupled [v', r'] = [Y - carried[0] u r, N - mxg u r]
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inertia {
    /// Mass and added mass of surge \[kg\].
    pub surge: f64,
    /// Mass matrix of sway and yaw \[kg, kg m; kg m, kg m^2\].
    pub coupled: [[f64; 2]; 2],
    /// The masses in u r and v r \[kg\]: with the added mass, unless a hull coefficient contains that part.
    pub carried: [f64; 2],
    /// m x_G \[kg m\].
    pub mxg: f64,
}

impl Inertia {
    /// From mass and x_G of the ship, added masses of surge and sway \[kg\], and the yaw inertia of ship and water \[kg m^2\].
    pub fn new(mass: f64, xg: f64, [surge_added, sway_added]: [f64; 2], yaw: f64) -> Self {
        let (surge, sway, mxg) = (mass + surge_added, mass + sway_added, mass * xg);
        Self { surge, coupled: [[sway, mxg], [mxg, yaw]], carried: [surge, sway], mxg }
    }

    /// Accelerations (u', v', r') at a velocity (u, v, r) through the water under a force.
    pub fn accelerations(&self, [u, v, r]: [f64; 3], force: &Force) -> [f64; 3] {
        let [longitudinal, lateral] = self.carried;
        let x = force.x + lateral * v * r + self.mxg * r * r;
        let y = force.y - longitudinal * u * r;
        let n = force.n - self.mxg * u * r;
        let [[a, b], [c, d]] = self.coupled;
        let det = a * d - b * c;
        [x / self.surge, (d * y - b * n) / det, (a * n - c * y) / det]
    }

    /// The force that gives these accelerations (u', v', r') at rest: X, Y \[N\], N \[N m\].
    pub fn force(&self, [du, dv, dr]: [f64; 3]) -> [f64; 3] {
        let [[a, b], [c, d]] = self.coupled;
        [self.surge * du, a * dv + b * dr, c * dv + d * dr]
    }
}

/// Added masses of a hull as primes, and the radius of gyration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AddedMass {
    /// m_x', on 1/2 rho L^2 d.
    pub surge: f64,
    /// m_y', on 1/2 rho L^2 d.
    pub sway: f64,
    /// J_z', on 1/2 rho L^4 d.
    pub yaw: f64,
    /// Radius of gyration k_zz / L about the centre of gravity.
    pub gyration: f64,
}

impl AddedMass {
    /// The inertia of a ship: m, m_x, m_y and I_zG + x_G^2 m + J_z.
    pub fn inertia(&self, p: &Particulars) -> Inertia {
        let (mass, scale) = (p.mass(), p.force_scale() * p.length);
        let radius = self.gyration * p.length;
        let yaw = mass * (radius * radius + p.xg * p.xg) + self.yaw * scale * p.length * p.length;
        Inertia::new(mass, p.xg, [self.surge * scale, self.sway * scale], yaw)
    }

    /// The numbers by reference, so that all of them can be altered alike.
    pub fn each(&mut self) -> [&mut f64; 4] {
        [&mut self.surge, &mut self.sway, &mut self.yaw, &mut self.gyration]
    }
}

/// Thrust of the propeller and the flow that it leaves at the rudder.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Propulsion {
    /// Thrust before deduction \[N\].
    pub thrust: f64,
    /// Longitudinal and lateral inflow at the rudder (u_R, v_R) \[m/s\].
    pub rudder_inflow: [f64; 2],
}

/// A truth simulator of one ship. Velocities are through the water: u, v \[m/s\], r \[rad/s\].
pub trait Truth: Send + Sync {
    /// Main particulars of the ship.
    fn particulars(&self) -> &Particulars;

    /// Inertia of ship and entrained water.
    fn inertia(&self) -> Inertia;

    /// Thrust and rudder inflow at propeller rate `n` \[rps\].
    fn propulsion(&self, u: f64, v: f64, r: f64, n: f64) -> Propulsion;

    /// Damping force of the hull.
    fn hull_force(&self, u: f64, v: f64, r: f64) -> Force;

    /// Effective thrust and side force of a propeller with `thrust` \[N\] before deduction, at rate `n` \[rps\].
    fn propeller_force(&self, thrust: f64, u: f64, n: f64) -> Force;

    /// Force of the rudder at angle `delta` \[rad\] in an inflow (u_R, v_R) \[m/s\], with what it induces on the hull.
    fn rudder_force(&self, inflow: [f64; 2], delta: f64) -> Force;

    /// Quasi-steady force at propeller rate `n` \[rps\] and rudder angle `delta` \[rad\], by origin. Finite and continuous in
    /// all four quadrants and at rest.
    fn force(&self, u: f64, v: f64, r: f64, n: f64, delta: f64) -> Contributions {
        let Propulsion { thrust, rudder_inflow } = self.propulsion(u, v, r, n);
        Contributions {
            hull: self.hull_force(u, v, r),
            propeller: self.propeller_force(thrust, u, n),
            rudder: self.rudder_force(rudder_inflow, delta),
        }
    }

    /// Time derivative of `[x, y, psi, u, v, r]` in calm water.
    fn derivative(&self, state: &State, inputs: &Inputs) -> [f64; 6] {
        let (sin, cos) = state.psi.sin_cos();
        let State { u, v, r, .. } = *state;
        let force = self.force(u, v, r, inputs.n, inputs.delta).total();
        let [du, dv, dr] = self.inertia().accelerations([u, v, r], &force);
        [u * cos - v * sin, u * sin + v * cos, r, du, dv, dr]
    }
}
