//! The words of the truth simulators: state, inputs, force and particulars of a ship, in `f64` and SI units.
//! It has no equation of motion and no coefficient of any ship.

use std::ops::Add;

/// Position and heading of the ship, and its motion over the ground.
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
}

/// Positions that the actuators have reached, not commands.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Inputs {
    /// Propeller rate, ahead positive \[rps\].
    pub n: f64,
    /// Rudder angle, turning the ship to starboard positive \[rad\].
    pub delta: f64,
}

impl Inputs {
    /// The inputs at a fraction of the way from one pair to another.
    pub fn between(from: &Self, to: &Self, fraction: f64) -> Self {
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
    /// Damping force of the bare hull, without added mass.
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

    /// 1/2 rho L d \[kg/m^2\]: a force coefficient times this and U^2 is a force.
    pub fn force_scale(&self) -> f64 {
        0.5 * self.rho * self.length * self.draught
    }
}
