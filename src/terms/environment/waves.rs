//! Mean drift load of the measured waves, proportional to the wave height squared.
//! Coefficients do not depend on wave length or ship speed, and motions at wave frequency are not modelled.

use crate::parameter::ParameterInfo;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Flow, Reach};
use crate::physics::{Group, Instant, Physics, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::state::Force;
use crate::terms::size;
use trimtab_ad::Scalar;

/// Measured waves.
pub struct Waves;

/// Mean drift load of waves given as `H_s^2 (north, east)` \[m2\] of where they travel to, with coefficients `c` = (c_x,
/// c_y, c_n). The mean of the squared amplitude of an irregular sea is `H_s^2/8`.
pub(in crate::terms) fn drift_load<S: Scalar>(
    at: &Instant<S>,
    waves: [S::Coefficient; 2],
    c: [S::Coefficient; 3],
) -> Force<S> {
    let ship = at.ship;
    let [along, across] = at.to_body(waves);
    let unit = ship.hull.water_density * size::GRAVITY * ship.hull.lpp / 16.0;
    Force { x: along * c[0] * unit, y: across * c[1] * unit, n: across * c[2] * (unit * ship.hull.lpp) }
}

static INFO: TermInfo = TermInfo {
    name: "waves",
    title: "measured waves",
    group: Group::Environment,
    equation: "X = 1/16 rho g L H_s^2 c_x cos chi, Y = 1/16 rho g L H_s^2 c_y sin chi, N = 1/16 rho g L^2 H_s^2 c_n sin chi; chi from the bow to where the waves travel",
    source: "Daidola's mean drift with constant coefficients",
    needs: &["waves"],
    validity: Validity {
        froude: Some([-0.1, 0.1]),
        source: "Daidola, Graham & Chandrash 1986 is for slow speeds, as the coefficients do not depend on speed; the number 0.1 is an engineering limit",
        ..Validity::ANY
    },
    mechanisms: &[Mechanism {
        name: "waves",
        title: "wave drift of recorded waves",
        kind: Kind::Environment,
        parameters: &["drag", "side", "yaw"],
        companions: &[],
        probe: Probe::Tangent,
        needs_reference: false,
        by_session: false,
        stand_in: false,
        look_alikes: &["wave_drift", "wind"],
        trial: "slow runs on all headings in higher waves",
    }],
    parameters: &[
        ParameterInfo::new("drag", "c_x", "-", "longitudinal drift coefficient, typically 0.05 to 0.2")
            .scale(|_| 0.15)
            .spread(|_| 0.3)
            .bounds(0.0, 2.0),
        ParameterInfo::new("side", "c_y", "-", "lateral drift coefficient, typically 0.1 to 1.3")
            .scale(|_| 0.8)
            .spread(|_| 1.0)
            .bounds(0.0, 3.0),
        ParameterInfo::new("yaw", "c_n", "-", "yaw drift coefficient, typically -0.1 to 0.06")
            .scale(|_| 0.05)
            .spread(|_| 0.1)
            .bounds(-0.5, 0.5),
    ],
};

impl Term for Waves {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }

    fn reach(&self, _parameter: usize) -> Reach {
        Reach::LinearForce
    }
}

impl<S: Scalar> Physics<S> for Waves {
    fn force(&self, p: &[S::Coefficient], at: &Instant<S>, _flow: &Flow<S>) -> Force<S> {
        drift_load(at, at.inputs.waves, [p[0], p[1], p[2]])
    }
}
