//! Resistance of a ship in calm, deep water from its main dimensions, for the start of a fit.
//! Friction with a form factor and an allowance for roughness; wave making is left out, so that it is too small for fast ships.

/// Kinematic viscosity of sea water at 15 deg C \[m2/s\].
const VISCOSITY: f64 = 1.19e-6;

/// Wetted surface S \[m2\] by Mumford: `S = 1.7 L d + nabla/d`, with the displaced volume `nabla` \[m3\].
pub(super) fn wetted_surface(length: f64, draught: f64, volume: f64) -> f64 {
    1.7 * length * draught + volume / draught
}

/// Form factor k \[-\] by Watanabe: `k = -0.095 + 25.6 C_b / ((L/B)^2 sqrt(B/d))`, limited to 0.05 to 0.5.
pub(super) fn form_factor(block: f64, [length, breadth, draught]: [f64; 3]) -> f64 {
    (-0.095 + 25.6 * block / ((length / breadth).powi(2) * (breadth / draught).sqrt())).clamp(0.05, 0.5)
}

/// Frictional resistance coefficient C_F \[-\] by the line of the ITTC 1957, at a speed \[m/s\].
pub(super) fn friction(length: f64, speed: f64) -> f64 {
    let reynolds = (speed * length / VISCOSITY).max(1e5);
    0.075 / (reynolds.log10() - 2.0).powi(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_parts_are_those_of_kvlcc2() {
        // Published for the full-scale ship: S = 27 194 m2, k = 0.2 (of the double model), C_F by the ITTC line.
        let surface = wetted_surface(320.0, 20.8, 312_600.0);
        assert!((surface / 27_194.0 - 1.0).abs() < 0.05, "{surface}");
        let k = form_factor(0.81, [320.0, 58.0, 20.8]);
        assert!((0.15..0.35).contains(&k), "{k}");
        assert!((friction(7.0, 1.19) - 0.075 / (7.0_f64.log10() + 4.0).powi(2)).abs() < 1e-12);
    }
}
