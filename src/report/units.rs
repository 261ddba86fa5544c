//! The units in which people read a diagnosis: degrees, and kN and t for a ship.
//! Every number is SI and radians until here.

use crate::numerals::sig;
use crate::ship::Ship;

/// The equations of motion in their order: symbol and SI unit of the force, and the motion it drives.
pub(super) const EQUATIONS: [(&str, &str, &str); 3] = [("X", "N", "surge"), ("Y", "N", "sway"), ("N", "N m", "yaw")];

/// The units in which people read: degrees, and kN and t for a ship but N and kg for a model basin's.
#[derive(Clone, Copy, Debug)]
pub(super) struct Units {
    large: bool,
}

impl Units {
    /// The units for a ship.
    pub(super) fn of(ship: &Ship) -> Self {
        Self { large: ship.hull.mass > 2e4 }
    }

    /// Factor from an SI unit, and the unit it leads to.
    pub(super) fn human(self, unit: &str) -> (f64, &str) {
        const DEGREES: f64 = 180.0 / std::f64::consts::PI;
        match unit {
            "N" if self.large => (1e-3, "kN"),
            "N m" if self.large => (1e-3, "kN m"),
            "kg" if self.large => (1e-3, "t"),
            "rad" => (DEGREES, "deg"),
            "rad/s" => (DEGREES, "deg/s"),
            "-" => (1.0, ""),
            other => (1.0, other),
        }
    }

    /// A value with its unit.
    pub(super) fn text(self, value: f64, unit: &str) -> String {
        let (factor, unit) = self.human(unit);
        format!("{} {unit}", sig(value * factor, 3)).trim_end().to_owned()
    }

    /// For the force in an equation: the factor from SI, and the label of an axis, `surge X [kN]`.
    pub(super) fn axis(self, equation: usize) -> (f64, String) {
        let (name, unit, motion) = EQUATIONS[equation];
        let (factor, unit) = self.human(unit);
        (factor, format!("{motion} {name} [{unit}]"))
    }
}
