//! Load of a steady wind that was not measured, with typical load coefficients.
//! It models no gusts; a recorded wind is the term `wind`.

use super::wind::wind_load;
use crate::parameter::ParameterInfo;
use crate::physics::Flow;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Group, Instant, Physics, Reach, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::state::Force;
use crate::terms::size;
use trimtab_ad::Scalar;

/// Unmeasured mean wind.
pub struct MeanWind;

/// Typical load coefficients c_x, c_y, c_n \[-\].
pub const TYPICAL: [f64; 3] = [0.7, 0.8, 0.1];

/// Relative spread of areas above the water that are estimated from the main dimensions, as `trimtab new` states it.
const AREA: f64 = 0.3;

/// Standard deviation of a coefficient that multiplies such an area, of this spread by itself.
fn with_area(coefficient: f64, spread: f64) -> f64 {
    spread.hypot(AREA * coefficient)
}

static INFO: TermInfo = TermInfo {
    name: "mean_wind",
    title: "unmeasured mean wind",
    group: Group::Environment,
    equation: "u_w = u - W_x, v_w = v - W_y, V^2 = u_w^2 + v_w^2; X = -1/2 rho_a A_F c_x u_w V, Y = -1/2 rho_a A_L c_y v_w V, N = -rho_a A_L L_oa c_n u_w v_w; less the load in still air; c_x, c_y, c_n typical unless fitted",
    source: "cosine and sine form, C_X = -c_x cos g, C_Y = c_y sin g, C_N = c_n sin 2g, as in public MMG codes; middle of the ranges given there",
    needs: &[],
    validity: Validity::any(
        "the cosine and sine form is used for any direction of the wind; its source gives no range",
    ),
    mechanisms: &[Mechanism {
        name: "mean_wind",
        title: "unrecorded wind",
        kind: Kind::Environment,
        parameters: &["north", "east"],
        companions: &["drag", "side", "yaw"],
        probe: Probe::Odd,
        needs_reference: false,
        by_session: true,
        stand_in: false,
        look_alikes: &["earth_force", "wave_drift", "current"],
        trial: "drifting stopped on several headings with the wind recorded",
    }],
    parameters: &[
        ParameterInfo::new("north", "W_N", "m/s", "wind towards north")
            .scale(|s| 0.17 * size::speed(s))
            .bounds(-40.0, 40.0),
        ParameterInfo::new("east", "W_E", "m/s", "wind towards east")
            .scale(|s| 0.17 * size::speed(s))
            .bounds(-40.0, 40.0)
            .odd(),
        ParameterInfo::new("drag", "c_x", "-", "longitudinal load coefficient, typically 0.5 to 0.9")
            .default(|_| TYPICAL[0])
            .scale(|_| 0.2)
            .spread(|_| with_area(TYPICAL[0], 0.2))
            .bounds(0.0, 2.0),
        ParameterInfo::new("side", "c_y", "-", "lateral load coefficient, typically 0.7 to 0.95")
            .default(|_| TYPICAL[1])
            .scale(|_| 0.2)
            .spread(|_| with_area(TYPICAL[1], 0.2))
            .bounds(0.0, 2.0),
        ParameterInfo::new("yaw", "c_n", "-", "yaw load coefficient, typically 0.05 to 0.2")
            .default(|_| TYPICAL[2])
            .scale(|_| 0.1)
            .spread(|_| with_area(TYPICAL[2], 0.1))
            .bounds(-0.5, 0.5),
    ],
};

impl Term for MeanWind {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }

    fn reach(&self, _parameter: usize) -> Reach {
        Reach::Force
    }
}

impl<S: Scalar> Physics<S> for MeanWind {
    fn force(&self, p: &[S::Coefficient], at: &Instant<S>, _flow: &Flow<S>) -> Force<S> {
        wind_load(at, [p[0], p[1]], [p[2], p[3], p[4]])
    }
}
