//! The vocabulary of motion: state, inputs and force, generic over the number type.
//! Everything here is in SI units and radians; what is read in other units is converted where it is read.

use std::ops::{Add, AddAssign, Mul, Sub};
use trimtab_ad::Scalar;

/// Number of entries of a state vector `[x, y, psi, u, v, r]`.
pub const STATES: usize = 6;

/// Names of the state entries, in order.
pub const STATE_NAMES: [&str; STATES] = ["x", "y", "psi", "u", "v", "r"];
/// Units of the state entries, in order.
pub const STATE_UNITS: [&str; STATES] = ["m", "m", "rad", "m/s", "m/s", "rad/s"];

/// Position, heading and velocity of the ship's midship point.
///
/// Earth frame: `x` north, `y` east, `psi` clockwise from north. Body frame: `u` forward, `v` to starboard, `r` to
/// starboard. Velocities are over ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State<S> {
    /// North position \[m\].
    pub x: S,
    /// East position \[m\].
    pub y: S,
    /// Heading \[rad\], clockwise from north, not wrapped.
    pub psi: S,
    /// Surge velocity over ground \[m/s\].
    pub u: S,
    /// Sway velocity over ground \[m/s\], to starboard.
    pub v: S,
    /// Yaw rate \[rad/s\], to starboard.
    pub r: S,
}

impl<S: Scalar> State<S> {
    /// From `[x, y, psi, u, v, r]`.
    #[inline]
    pub fn from_array([x, y, psi, u, v, r]: [S; STATES]) -> Self {
        Self { x, y, psi, u, v, r }
    }
    /// To `[x, y, psi, u, v, r]`.
    #[inline]
    pub fn to_array(self) -> [S; STATES] {
        [self.x, self.y, self.psi, self.u, self.v, self.r]
    }
    /// A constant state, with zero derivatives.
    #[inline]
    pub fn constant(s: &[f64; STATES]) -> Self {
        Self::from_array(s.map(S::from_f64))
    }
    /// True when every entry is finite.
    pub fn is_finite(&self) -> bool {
        self.to_array().iter().all(|s| s.is_finite())
    }
}

/// The most channels that the actuators of a craft may have together: four azimuths with rate and angle, and four more.
pub const COMMANDS: usize = 12;

/// The inputs that a simulation takes from one channel of a recording as it is: one row each, and `$then!` makes of them what it
/// needs. A row gives field, variant of `Channel`, quantity, smallest and largest value accepted (SI), the name in messages and
/// the meaning with its sign.
macro_rules! recorded_inputs {
    ($then:ident) => {
        $then! {
            n N: Rotation, (-60.0, 60.0), "propeller rate", "propeller rate, positive ahead";
            delta Delta: Angle, (-1.6, 1.6), "rudder angle", "rudder angle, positive turns the ship to starboard";
            thruster Thruster: Number, (-1.01, 1.01), "bow thruster command",
                "bow thruster command, -1 full to port, 1 full to starboard";
        }
    };
}
pub(crate) use recorded_inputs;

macro_rules! inputs {
    ($($name:ident $channel:ident: $quantity:ident, $limits:expr, $words:literal, $doc:literal;)*) => {
        /// What acts on the ship from outside at one instant: actuators and environment.
        ///
        /// A channel that was not recorded has its neutral value (no wind, no current, no waves, deep water, no bank, no
        /// thruster), so that the terms which read it give no force.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct Inputs<S> {
            /// Time \[s\].
            pub t: S,
            $(
                #[doc = concat!($doc, " (SI units, radians).")]
                pub $name: S,
            )*
            /// True wind velocity over ground \[m/s\] as (north, east) components of where it blows TO.
            pub wind: [S; 2],
            /// Current velocity over ground \[m/s\] as (north, east) components of where it sets TO.
            pub current: [S; 2],
            /// Wave height and direction as `H_s^2 (north, east)` of where waves travel TO \[m2\].
            pub waves: [S; 2],
            /// Draught over water depth, d/h \[-\]; 0 in deep water.
            pub draught_to_depth: S,
            /// Bank proximity `1/y_s - 1/y_p` \[1/m\] from the distances to the starboard and the port bank; 0 in open water.
            pub bank: S,
            /// Channels of the named actuators, in the order of [`crate::ship::actuator::channels`]; 0 where there is none. Their number is
            /// [`COMMANDS`], written out for the compiler (1.95 stops at a struct update in a closure otherwise).
            pub commands: [S; 12],
        }

        impl<S> Inputs<S> {
            /// From what `f` makes of each entry of inputs of another type; it is given the way to look an entry up.
            #[inline(always)]
            pub fn from_entries<T>(mut f: impl FnMut(fn(&Inputs<T>) -> &T) -> S) -> Self {
                Self {
                    t: f(|i| &i.t),
                    $($name: f(|i| &i.$name),)*
                    wind: [f(|i| &i.wind[0]), f(|i| &i.wind[1])],
                    current: [f(|i| &i.current[0]), f(|i| &i.current[1])],
                    waves: [f(|i| &i.waves[0]), f(|i| &i.waves[1])],
                    draught_to_depth: f(|i| &i.draught_to_depth),
                    bank: f(|i| &i.bank),
                    commands: [
                        f(|i| &i.commands[0]),
                        f(|i| &i.commands[1]),
                        f(|i| &i.commands[2]),
                        f(|i| &i.commands[3]),
                        f(|i| &i.commands[4]),
                        f(|i| &i.commands[5]),
                        f(|i| &i.commands[6]),
                        f(|i| &i.commands[7]),
                        f(|i| &i.commands[8]),
                        f(|i| &i.commands[9]),
                        f(|i| &i.commands[10]),
                        f(|i| &i.commands[11]),
                    ],
                }
            }

            /// The entries that are a channel of a recording as it is, by the channel's name.
            pub fn recorded(&mut self) -> impl Iterator<Item = (&'static str, &mut S)> {
                [$((stringify!($name), &mut self.$name)),*].into_iter()
            }
        }
    };
}
recorded_inputs!(inputs);

impl<S: Scalar> Inputs<S> {
    /// Propeller and rudder alone, in a neutral environment.
    pub fn actuators(t: f64, n: f64, delta: f64) -> Self {
        let neutral = Self::from_entries(|_: fn(&Inputs<S>) -> &S| S::zero());
        Self { t: S::from_f64(t), n: S::from_f64(n), delta: S::from_f64(delta), ..neutral }
    }

    /// The inputs as a constant of another number type.
    #[inline]
    pub fn constant(i: &Inputs<f64>) -> Self {
        i.map(S::from_f64)
    }
}

impl<S: Copy> Inputs<S> {
    /// Applies `f` to every entry.
    #[inline(always)]
    pub fn map<T>(&self, f: impl Fn(S) -> T) -> Inputs<T> {
        Inputs::from_entries(|entry| f(*entry(self)))
    }

    /// Applies `f` to the entries of two inputs pairwise.
    #[inline(always)]
    pub fn zip<T>(&self, other: &Self, f: impl Fn(S, S) -> T) -> Inputs<T> {
        Inputs::from_entries(|entry| f(*entry(self), *entry(other)))
    }
}

impl<S: Scalar> Inputs<S> {
    /// Linear interpolation between two instants, `fraction` of the way from `self` to `next`.
    #[inline]
    pub fn between(&self, next: &Self, fraction: f64) -> Self {
        self.zip(next, |a, b| a + (b - a) * fraction)
    }
}

/// Force on the ship's body axes about midship: X forward \[N\], Y to starboard \[N\], N to starboard \[N m\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Force<S> {
    /// Surge force \[N\].
    pub x: S,
    /// Sway force \[N\].
    pub y: S,
    /// Yaw moment \[N m\].
    pub n: S,
}

impl<S: Scalar> Force<S> {
    /// No force.
    #[inline]
    pub fn zero() -> Self {
        Self { x: S::zero(), y: S::zero(), n: S::zero() }
    }
    /// To `[X, Y, N]`.
    #[inline]
    pub fn to_array(self) -> [S; 3] {
        [self.x, self.y, self.n]
    }
}

impl<S: Scalar> Add for Force<S> {
    type Output = Self;
    #[inline]
    fn add(mut self, o: Self) -> Self {
        self += o;
        self
    }
}

impl<S: Scalar> AddAssign for Force<S> {
    #[inline]
    fn add_assign(&mut self, o: Self) {
        self.x += o.x;
        self.y += o.y;
        self.n += o.n;
    }
}

impl<S: Scalar> Sub for Force<S> {
    type Output = Self;
    #[inline]
    fn sub(self, o: Self) -> Self {
        Self { x: self.x - o.x, y: self.y - o.y, n: self.n - o.n }
    }
}

impl<S: Scalar> Mul<S> for Force<S> {
    type Output = Self;
    #[inline]
    fn mul(self, k: S) -> Self {
        Self { x: self.x * k, y: self.y * k, n: self.n * k }
    }
}
