//! A magnetic compass whose reading errs with the heading, by the iron of the ship.
//! It acts on the heading channel only; it is identifiable because neither the track nor the yaw rate follows the reported heading.

use crate::parameter::ParameterInfo;
use crate::physics::Flow;
use crate::physics::Probe;
use crate::physics::Validity;
use crate::physics::{Group, Instant, Physics, Term, TermInfo};
use crate::physics::{Kind, Mechanism};
use crate::state::STATES;
use trimtab_ad::Scalar;

/// Standard deviation of what is left in an adjusted compass \[rad\]: 1 deg, for it stays within 3 deg.
const RESIDUAL: f64 = 0.0175;

/// Semicircular deviation of a magnetic compass.
pub struct CompassDeviation;

static INFO: TermInfo = TermInfo {
    name: "compass_deviation",
    title: "deviation of the compass",
    group: Group::Sensor,
    equation: "psi_m = psi + d_N cos psi + d_E sin psi",
    source: "semicircular part of the deviation, coefficients C and B with the sign of a reading; Bowditch, American Practical \
             Navigator (NGA Pub. 9), compass adjustment",
    needs: &[],
    validity: Validity::any("small angles; the coefficients belong to one place and one compass"),
    mechanisms: &[Mechanism {
        name: "compass_deviation",
        title: "a deviation of the compass that changes with the heading",
        kind: Kind::Sensor,
        parameters: &["north", "east"],
        companions: &[],
        probe: Probe::Tangent,
        needs_reference: false,
        by_session: false,
        stand_in: false,
        look_alikes: &["heading_bias", "current"],
        trial: "swinging the compass: steady runs on eight headings",
    }],
    parameters: &[
        ParameterInfo::new("north", "d_N", "rad", "reported minus true heading when heading north")
            .scale(|_| 0.0175)
            .spread(|_| RESIDUAL)
            .bounds(-0.5, 0.5)
            .odd(),
        ParameterInfo::new("east", "d_E", "rad", "reported minus true heading when heading east")
            .scale(|_| 0.0175)
            .spread(|_| RESIDUAL)
            .bounds(-0.5, 0.5),
    ],
};

impl Term for CompassDeviation {
    fn info(&self) -> &'static TermInfo {
        &INFO
    }
}

impl<S: Scalar> Physics<S> for CompassDeviation {
    fn measure(
        &self,
        p: &[S::Coefficient],
        at: &Instant<S>,
        _flow: &Flow<S>,
        _rate: &[S; STATES],
        y: &mut [S; STATES],
    ) {
        let [sin, cos] = at.heading;
        y[2] += cos * p[0] + sin * p[1];
    }
}

#[cfg(test)]
mod tests {
    use crate::diagnose::example::erring;

    /// As `C cos psi + B sin psi` on a card of deviations.
    #[test]
    fn the_card_of_the_compass_is_a_cosine_and_a_sine_of_the_heading() {
        let [sound, off] = [vec![], vec![("compass_deviation.north", 0.035), ("compass_deviation.east", 0.052)]]
            .map(|errors| erring(&errors, 3));
        for (a, b) in sound.iter().zip(&off).flat_map(|(a, b)| a.measured.iter().zip(&b.measured)) {
            let psi = a[2].unwrap();
            let expected = 0.035 * psi.cos() + 0.052 * psi.sin();
            assert!((b[2].unwrap() - psi - expected).abs() < 1e-12);
            assert_eq!((a[0], a[3], a[5]), (b[0], b[3], b[5]));
        }
    }
}
