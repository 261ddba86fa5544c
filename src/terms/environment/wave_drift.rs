//! Mean drift load of unmeasured waves: one direction on the earth, with a different gain ahead and abeam.
//! It does not depend on the ship's speed, as a wind load does; it is an order of magnitude stronger abeam than ahead, as `earth_force` is not.

use super::waves::drift_load;
use crate::parameter::ParameterInfo;
use crate::physics::Flow;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Group, Instant, Physics, Reach, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::state::Force;
use trimtab_ad::Scalar;

/// Unmeasured wave drift.
pub struct WaveDrift;

/// Typical drift coefficients c_x, c_y, c_n \[-\].
pub const TYPICAL: [f64; 3] = [0.07, 1.0, 0.06];

static INFO: TermInfo = TermInfo {
    name: "wave_drift",
    title: "unmeasured wave drift",
    group: Group::Environment,
    equation: "X = 1/16 rho g L H_s^2 c_x cos chi, Y = 1/16 rho g L H_s^2 c_y sin chi, N = 1/16 rho g L^2 H_s^2 c_n sin chi; chi from the bow to where the waves travel; c_x, c_y, c_n typical unless fitted",
    source: "Daidola's mean drift with its coefficients for waves half as long as the ship",
    needs: &[],
    validity: Validity {
        froude: Some([-0.1, 0.1]),
        source: "Daidola, Graham & Chandrash 1986 is for slow speeds, as the coefficients do not depend on speed; the number 0.1 is an engineering limit",
        ..Validity::ANY
    },
    mechanisms: &[Mechanism {
        name: "wave_drift",
        title: "wave drift of unrecorded waves",
        kind: Kind::Environment,
        parameters: &["north", "east"],
        companions: &["ahead", "abeam", "yaw"],
        probe: Probe::Tangent,
        needs_reference: false,
        by_session: true,
        stand_in: false,
        look_alikes: &["mean_wind", "earth_force", "current"],
        trial: "drifting stopped on several headings with the waves recorded",
    }],
    parameters: &[
        ParameterInfo::new("north", "H2_N", "m2", "significant wave height squared, towards north")
            .scale(|s| 3.5e-5 * s.hull.lpp * s.hull.lpp)
            .bounds(-100.0, 100.0),
        ParameterInfo::new("east", "H2_E", "m2", "significant wave height squared, towards east")
            .scale(|s| 3.5e-5 * s.hull.lpp * s.hull.lpp)
            .bounds(-100.0, 100.0)
            .odd(),
        ParameterInfo::new("ahead", "c_x", "-", "longitudinal drift coefficient")
            .default(|_| TYPICAL[0])
            .scale(|_| 0.05)
            .spread(|_| 0.05)
            .bounds(0.0, 1.0),
        ParameterInfo::new("abeam", "c_y", "-", "lateral drift coefficient")
            .default(|_| TYPICAL[1])
            .scale(|_| 0.3)
            .spread(|_| 0.3)
            .bounds(0.0, 3.0),
        ParameterInfo::new("yaw", "c_n", "-", "yaw drift coefficient")
            .default(|_| TYPICAL[2])
            .scale(|_| 0.06)
            .spread(|_| 0.06)
            .bounds(-0.5, 0.5),
    ],
};

impl Term for WaveDrift {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }

    fn reach(&self, _parameter: usize) -> Reach {
        Reach::Force
    }
}

impl<S: Scalar> Physics<S> for WaveDrift {
    fn force(&self, p: &[S::Coefficient], at: &Instant<S>, _flow: &Flow<S>) -> Force<S> {
        drift_load(at, [p[0], p[1]], [p[2], p[3], p[4]])
    }
}
