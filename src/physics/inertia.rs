//! The mass matrix of the three equations of motion, added mass included.
//! It has no force: those on the right-hand side are the terms'.

use super::flow::Adjust;
use crate::state::Force;
use std::ops::Mul;
use trimtab_ad::Scalar;

/// The mass matrix of the three equations: surge alone, sway and yaw coupled.
#[derive(Clone, Copy, Debug)]
pub struct Inertia<S> {
    /// m - Xudot \[kg\].
    pub surge: S,
    /// m - Yvdot \[kg\].
    pub sway: S,
    /// m xG - Yrdot \[kg m\].
    pub sway_yaw: S,
    /// m xG - Nvdot \[kg m\].
    pub yaw_sway: S,
    /// Iz - Nrdot \[kg m2\].
    pub yaw: S,
}

impl<S: Scalar> Inertia<S> {
    /// The mass matrix from the parameters of the term `hull` and what terms change, without roll.
    #[inline(always)]
    pub fn new(p: &[S], adjust: &Adjust<S>) -> Self {
        let m = p[0] * adjust.mass;
        let moment = m * (p[2] + adjust.x_g);
        Self {
            surge: m - p[3],
            sway: m - p[4] * adjust.added_mass,
            sway_yaw: moment - p[5] * adjust.added_mass,
            yaw_sway: moment - p[6] * adjust.added_mass,
            yaw: p[1] * adjust.mass - p[7] * adjust.added_mass,
        }
    }

    /// The matrix in another number.
    #[inline(always)]
    pub fn map<T>(&self, f: impl Fn(S) -> T) -> Inertia<T> {
        Inertia {
            surge: f(self.surge),
            sway: f(self.sway),
            sway_yaw: f(self.sway_yaw),
            yaw_sway: f(self.yaw_sway),
            yaw: f(self.yaw),
        }
    }

    /// The force that gives the accelerations (u', v', r').
    #[inline(always)]
    pub fn force(&self, [surge, sway, yaw]: &[S; 3]) -> Force<S> {
        Force {
            x: self.surge * *surge,
            y: self.sway * *sway + self.sway_yaw * *yaw,
            n: self.yaw_sway * *sway + self.yaw * *yaw,
        }
    }

    /// Determinant of the coupled sway-yaw part \[kg2 m2\], which must be positive.
    #[inline(always)]
    pub fn determinant(&self) -> S {
        self.sway * self.yaw - self.sway_yaw * self.yaw_sway
    }

    /// The inverse of the mass matrix.
    #[inline(always)]
    pub fn inverse(&self) -> Mobility<S> {
        let inverse = S::one() / self.determinant();
        Mobility {
            surge: S::one() / self.surge,
            sway: self.yaw * inverse,
            sway_yaw: -self.sway_yaw * inverse,
            yaw_sway: -self.yaw_sway * inverse,
            yaw: self.sway * inverse,
        }
    }
}

/// The inverse of the mass matrix: accelerations per force.
#[derive(Clone, Copy, Debug)]
pub struct Mobility<S> {
    /// Surge acceleration per surge force \[1/kg\].
    pub surge: S,
    /// Sway acceleration per sway force \[1/kg\].
    pub sway: S,
    /// Sway acceleration per yaw moment \[1/(kg m)\].
    pub sway_yaw: S,
    /// Yaw acceleration per sway force \[1/(kg m)\].
    pub yaw_sway: S,
    /// Yaw acceleration per yaw moment \[1/(kg m2)\].
    pub yaw: S,
}

impl<C: Copy> Mobility<C> {
    /// Accelerations (u', v', r') under a force.
    #[inline(always)]
    pub fn accelerations<S: Scalar + Mul<C, Output = S>>(&self, f: &Force<S>) -> [S; 3] {
        [f.x * self.surge, f.y * self.sway + f.n * self.sway_yaw, f.y * self.yaw_sway + f.n * self.yaw]
    }
}

impl Inertia<f64> {
    /// Whether the matrix can be inverted and every mass is positive: only then is it a ship's.
    pub fn is_positive(&self) -> bool {
        self.surge > 0.0 && self.sway > 0.0 && self.yaw > 0.0 && self.determinant() > 0.0
    }
}
