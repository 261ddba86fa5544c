//! A list of every operator and function that physics may use, for the law tests.
//! It has no test and no expected value.
#![allow(dead_code, reason = "each test file is a crate of its own and uses a part of this")]

use proptest::test_runner::{Config, RngSeed};
use trimtab_ad::{Scalar, smooth};

/// One operator or function of two variables; a function of one variable ignores `y`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Function {
    Add,
    Sub,
    Mul,
    Div,
    Neg,
    AddNumber,
    SubNumber,
    MulNumber,
    DivNumber,
    AddAssign,
    SubAssign,
    MulAssign,
    Sqrt,
    Exp,
    Ln,
    Sin,
    Cos,
    Tanh,
    Atan2,
    Squared,
    Abs,
    Max,
    Min,
    Clamp,
    Select,
    Nearest,
    SmoothAbs,
    SmoothStep,
    Blend,
    Softplus,
    WrapAngle,
    Composite,
}

impl Function {
    pub const ALL: [Self; 32] = [
        Self::Add,
        Self::Sub,
        Self::Mul,
        Self::Div,
        Self::Neg,
        Self::AddNumber,
        Self::SubNumber,
        Self::MulNumber,
        Self::DivNumber,
        Self::AddAssign,
        Self::SubAssign,
        Self::MulAssign,
        Self::Sqrt,
        Self::Exp,
        Self::Ln,
        Self::Sin,
        Self::Cos,
        Self::Tanh,
        Self::Atan2,
        Self::Squared,
        Self::Abs,
        Self::Max,
        Self::Min,
        Self::Clamp,
        Self::Select,
        Self::Nearest,
        Self::SmoothAbs,
        Self::SmoothStep,
        Self::Blend,
        Self::Softplus,
        Self::WrapAngle,
        Self::Composite,
    ];

    /// The function at `(x, y)`.
    pub fn of<S: Scalar>(self, x: S, y: S) -> S {
        match self {
            Self::Add => x + y,
            Self::Sub => x - y,
            Self::Mul => x * y,
            Self::Div => x / y,
            Self::Neg => -x,
            Self::AddNumber => x + 1.7,
            Self::SubNumber => x - 1.7,
            Self::MulNumber => x * 1.7,
            Self::DivNumber => x / 1.7,
            Self::AddAssign => {
                let mut z = x;
                z += y;
                z
            }
            Self::SubAssign => {
                let mut z = x;
                z -= y;
                z
            }
            Self::MulAssign => {
                let mut z = x;
                z *= y;
                z
            }
            Self::Sqrt => x.sqrt(),
            Self::Exp => x.exp(),
            Self::Ln => x.ln(),
            Self::Sin => x.sin(),
            Self::Cos => x.cos(),
            Self::Tanh => x.tanh(),
            Self::Atan2 => x.atan2(y),
            Self::Squared => x.squared(),
            Self::Abs => x.abs(),
            Self::Max => x.max(y),
            Self::Min => x.min(y),
            Self::Clamp => x.clamp(-1.0, 1.5),
            Self::Select => S::select(x.less(y), x * y, x.sin()),
            Self::Nearest => x.nearest() * y,
            Self::SmoothAbs => smooth::smooth_abs(x, 0.1),
            Self::SmoothStep => smooth::smooth_step(x),
            Self::Blend => smooth::blend(x, -0.5, 1.5, x * y, y.sin()),
            Self::Softplus => smooth::softplus(x),
            Self::WrapAngle => smooth::wrap_angle(x),
            Self::Composite => (x.sin() * y.exp() + x.atan2(y * y + 1.0)).tanh() / (x.squared() + 2.0).sqrt(),
        }
    }

    /// A point inside the function's domain from a point of the unit square.
    pub fn point(self, [a, b]: [f64; 2]) -> [f64; 2] {
        let (x, y) = (6.0 * a - 3.0, 6.0 * b - 3.0);
        match self {
            Self::Sqrt | Self::Ln => [0.01 + 10.0 * a, y],
            Self::Div => [x, if y < 0.0 { y - 0.1 } else { y + 0.1 }],
            Self::Atan2 => [x, if y.abs() < 0.1 { y + 0.3 } else { y }],
            Self::WrapAngle => [10.0 * x, y],
            Self::SmoothStep => [2.0 * a - 0.5, y],
            _ => [x, y],
        }
    }
}

/// Whether `a` and `b` agree to `tolerance`, relative where they are large and absolute where they are small.
pub fn close(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance * 1f64.max(a.abs()).max(b.abs())
}

/// A configuration with equal points on every run and on every machine.
pub fn config() -> Config {
    Config { cases: 1000, rng_seed: RngSeed::Fixed(20250218), failure_persistence: None, ..Config::default() }
}
