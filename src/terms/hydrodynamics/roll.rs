//! Yaw moment and sway force of the heel that a turn causes, following the turn with a lag.
//! Heel is quasi-static: the lag is expanded to first order, so that roll resonance and heel from wind are not modelled. With a negative `yaw` the lag takes away inertia, and 1/2 rho L^2 d |yaw| U^3 tau/g must stay below Iz - Nrdot.

use crate::parameter::ParameterInfo;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Adjust, Flow};
use crate::physics::{Group, Instant, Physics, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::ship::Ship;
use crate::state::{Force, Inputs};
use crate::terms::size;
use trimtab_ad::Scalar;

/// Roll-yaw coupling.
pub struct Roll;

/// Sway force and yaw moment per U^3 r.
fn gains<S: Scalar>([yaw, share, _lag]: [S; 3], ship: &Ship) -> [S; 2] {
    let unit = size::pressure(ship) / size::GRAVITY;
    [yaw * share * unit, yaw * (unit * ship.hull.lpp)]
}

static INFO: TermInfo = TermInfo {
    name: "roll",
    title: "roll-yaw coupling",
    group: Group::Hull,
    equation: "h = U (r - tau r')/g; N = k_N 1/2 rho L^2 d U^2 h, Y = s N/L; the part in r' joins the mass matrix",
    source: "quasi-static reduction of the four-degree-of-freedom container-ship model of Son & Nomoto",
    needs: &[],
    validity: Validity::any("quasi-static: the turn must change slowly against the roll period, which is not recorded"),
    mechanisms: &[Mechanism {
        name: "roll",
        title: "roll coupled into yaw",
        kind: Kind::Ship,
        parameters: &["yaw"],
        companions: &["share"],
        probe: Probe::Tangent,
        needs_reference: true,
        by_session: false,
        stand_in: false,
        look_alikes: &["munk", "loading"],
        trial: "zigzags at high speed with the roll recorded",
    }],
    parameters: &[
        ParameterInfo::new("yaw", "k_N", "-", "yaw moment of heel, per U r/g")
            .scale(|_| 0.1)
            .spread(|_| 0.5)
            .bounds(-5.0, 5.0),
        // Y_phi/N_phi of the container ship, whose hull heels about its waterline.
        ParameterInfo::new(
            "share",
            "s",
            "-",
            "sway force of heel over its yaw moment, times L; 0.44 for a container ship",
        )
        .default(|_| 0.44)
        .scale(|_| 0.3)
        .spread(|_| 0.5)
        .bounds(-2.0, 3.0),
        ParameterInfo::new(
            "lag",
            "tau",
            "s",
            "time by which heel follows the turn, about a quarter of the roll period",
        )
        .default(size::time)
        .scale(size::time)
        .bounds(0.0, 30.0),
    ],
};

impl Term for Roll {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }
}

impl<S: Scalar> Physics<S> for Roll {
    fn adjust(&self, p: &[S], ship: &Ship, _inputs: &Inputs<S>, adjust: &mut Adjust<S>) {
        let [sway, yaw] = gains([p[0], p[1], p[2]], ship);
        let [sway_yaw, yaw_yaw] = adjust.roll.unwrap_or([S::zero(); 2]);
        adjust.roll = Some([sway_yaw + sway * p[2], yaw_yaw + yaw * p[2]]);
    }

    fn force(&self, p: &[S::Coefficient], at: &Instant<S>, flow: &Flow<S>) -> Force<S> {
        let [sway, yaw] = gains([p[0], p[1], p[2]], at.ship);
        let cause = flow.speed * flow.speed * flow.speed * flow.r;
        Force { x: S::zero(), y: cause * sway, n: cause * yaw }
    }
}
