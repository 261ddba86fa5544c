//! Load of the measured wind on the part of the ship above water.
//! The wind channel gives speed and direction; unknown are the three load coefficients. An unmeasured wind is the term `mean_wind`.

use crate::parameter::ParameterInfo;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Flow, Reach};
use crate::physics::{Group, Instant, Physics, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::ship::{AboveWater, Ship};
use crate::state::Force;
use trimtab_ad::Scalar;

/// Measured wind.
pub struct Wind;

/// The ship's above-water particulars, or typical ones of a cargo ship where the file has none: A_F = 0.95 B^2,
/// A_L = 0.7 L B, L_oa = 1.08 L (within 3 % of ships A and B).
pub fn above_water(ship: &Ship) -> AboveWater {
    let hull = &ship.hull;
    ship.above_water.clone().unwrap_or(AboveWater {
        frontal_area: 0.95 * hull.breadth * hull.breadth,
        lateral_area: 0.7 * hull.lpp * hull.breadth,
        length_overall: 1.08 * hull.lpp,
        air_density: 1.225,
    })
}

/// Load of the air on the ship moving through it \[N, N m\], with coefficients `c` = (c_x, c_y, c_n).
///
/// Relative velocity `u_w = u - W_x`, `v_w = v - W_y` in body axes, `V = sqrt(u_w^2 + v_w^2 + small^2)`:
/// `X = -1/2 rho_a A_F c_x u_w V`, `Y = -1/2 rho_a A_L c_y v_w V`, `N = -rho_a A_L L_oa c_n u_w v_w`. These are
/// `C_X = -c_x cos g`, `C_Y = c_y sin g`, `C_N = c_n sin 2g` with the angle of attack `g = -atan2(v_w, u_w)`, without the
/// angle, so that still air and a ship at rest are no special case.
fn air_load<S: Scalar>(at: &Instant<S>, wind: [S::Coefficient; 2], c: [S::Coefficient; 3]) -> Force<S> {
    let air = above_water(at.ship);
    let [along, across] = at.to_body(wind);
    let (u, v) = (at.state.u - along, at.state.v - across);
    let small = at.small;
    let speed = (u * u + v * v + small * small).sqrt();
    Force {
        x: -(u * c[0] * speed) * (0.5 * air.air_density * air.frontal_area),
        y: -(v * c[1] * speed) * (0.5 * air.air_density * air.lateral_area),
        n: -(u * c[2] * v) * (air.air_density * air.lateral_area * air.length_overall),
    }
}

/// What a wind (north, east) \[m/s\], blowing to, adds to the load of still air. Still air is part of the resistance of
/// the calm-water model, so that no wind is no force.
pub(in crate::terms) fn wind_load<S: Scalar>(
    at: &Instant<S>,
    wind: [S::Coefficient; 2],
    c: [S::Coefficient; 3],
) -> Force<S> {
    air_load(at, wind, c) - air_load(at, [S::Coefficient::zero(); 2], c)
}

static INFO: TermInfo = TermInfo {
    name: "wind",
    title: "measured wind",
    group: Group::Environment,
    equation: "u_w = u - W_x, v_w = v - W_y, V^2 = u_w^2 + v_w^2; X = -1/2 rho_a A_F c_x u_w V, Y = -1/2 rho_a A_L c_y v_w V, N = -rho_a A_L L_oa c_n u_w v_w; less the load in still air",
    source: "cosine and sine form, C_X = -c_x cos g, C_Y = c_y sin g, C_N = c_n sin 2g, as in public MMG codes",
    needs: &["wind"],
    validity: Validity::any(
        "the cosine and sine form is used for any direction of the wind; its source gives no range",
    ),
    mechanisms: &[Mechanism {
        name: "wind",
        title: "wind recorded by the anemometer",
        kind: Kind::Environment,
        parameters: &["drag", "side", "yaw"],
        companions: &[],
        probe: Probe::Tangent,
        needs_reference: false,
        by_session: false,
        stand_in: false,
        look_alikes: &["mean_wind", "earth_force", "wave_drift"],
        trial: "slow runs on all headings in more wind",
    }],
    parameters: &[
        ParameterInfo::new("drag", "c_x", "-", "longitudinal load coefficient, typically 0.5 to 0.9")
            .scale(|_| 0.7)
            .spread(|_| 0.9)
            .bounds(0.0, 2.0),
        ParameterInfo::new("side", "c_y", "-", "lateral load coefficient, typically 0.7 to 0.95")
            .scale(|_| 0.8)
            .spread(|_| 0.95)
            .bounds(0.0, 2.0),
        ParameterInfo::new("yaw", "c_n", "-", "yaw load coefficient, typically 0.05 to 0.2")
            .scale(|_| 0.1)
            .spread(|_| 0.2)
            .bounds(-0.5, 0.5),
    ],
};

impl Term for Wind {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }

    fn reach(&self, _parameter: usize) -> Reach {
        Reach::LinearForce
    }
}

impl<S: Scalar> Physics<S> for Wind {
    fn force(&self, p: &[S::Coefficient], at: &Instant<S>, _flow: &Flow<S>) -> Force<S> {
        wind_load(at, at.inputs.wind, [p[0], p[1], p[2]])
    }
}
