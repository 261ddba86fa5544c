//! The mass matrix of the three equations of motion, added mass included.
//! It holds no force: those on the right-hand side are the terms'.

use super::flow::Flow;
use crate::state::Force;
use trimtab_ad::Scalar;

/// The mass matrix of the three equations: surge alone, sway and yaw coupled.
#[derive(Clone, Copy, Debug)]
pub struct Inertia<S> {
    /// m - Xudot.
    pub surge: S,
    /// m - Yvdot.
    pub sway: S,
    /// m xG - Yrdot.
    pub sway_yaw: S,
    /// m xG - Nvdot.
    pub yaw_sway: S,
    /// Iz - Nrdot.
    pub yaw: S,
}

impl<S: Scalar> Inertia<S> {
    /// The mass matrix from the parameters of the term `hull`.
    pub fn new(p: &[S], flow: &Flow<S>) -> Self {
        let a = &flow.adjust;
        let m = p[0] * a.mass;
        let xg = p[2] + a.x_g;
        let cube = flow.speed * flow.speed * flow.speed;
        Self {
            surge: m - p[3],
            sway: m - p[4] * a.added_mass,
            sway_yaw: m * xg - p[5] * a.added_mass + a.roll[0] * cube,
            yaw_sway: m * xg - p[6] * a.added_mass,
            yaw: p[1] * a.mass - p[7] * a.added_mass + a.roll[1] * cube,
        }
    }

    /// Determinant of the sway-yaw part, `sway yaw - sway_yaw yaw_sway` \[kg2 m2\].
    pub fn determinant(&self) -> S {
        self.sway * self.yaw - self.sway_yaw * self.yaw_sway
    }

    /// Accelerations (u', v', r') under a force.
    pub fn solve(&self, f: &Force<S>) -> [S; 3] {
        let inverse = S::one() / self.determinant();
        [
            f.x / self.surge,
            (f.y * self.yaw - f.n * self.sway_yaw) * inverse,
            (f.n * self.sway - f.y * self.yaw_sway) * inverse,
        ]
    }
}

impl Inertia<f64> {
    /// Whether the matrix can be inverted and every mass is positive: only then is it a ship's.
    pub fn is_positive(&self) -> bool {
        self.surge > 0.0 && self.sway > 0.0 && self.yaw > 0.0 && self.determinant() > 0.0
    }
}
