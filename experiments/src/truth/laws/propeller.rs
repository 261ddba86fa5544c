//! Open-water thrust of a screw in all four quadrants, from a Fourier series or from a quadratic K_T(J) with an extension.
//! It is not the thrust on the ship: wake, thrust deduction and side force belong to the simulators.

use std::f64::consts::PI;

use super::blend::astern_weight;

/// Wageningen B4-70, P/D = 0.8: rows `[A_k, B_k]` of 100 C_T*, k = 0..=30.
#[rustfmt::skip]
const B470_08: [[f64; 2]; 31] = [
    [2.8757, 0.0],
    [13.007, -77.762],
    [0.62869, -1.3032],
    [2.8104, 10.58],
    [-1.6832, -1.0413],
    [-4.4894, 4.5769],
    [0.37703, 1.4296],
    [3.1647, -0.39612],
    [-0.13492, -0.9917],
    [-1.9905, 2.0759],
    [0.17576, 0.90153],
    [1.975, -0.029877],
    [-0.11063, -0.56354],
    [-0.069828, 0.94773],
    [0.25665, 0.23681],
    [0.80681, -0.53204],
    [-0.18781, -0.071537],
    [0.29821, 0.52768],
    [0.48643, 0.0174],
    [0.33893, -0.68105],
    [-0.26851, -0.204],
    [0.096098, 0.14086],
    [0.2145, -0.057914],
    [0.06644, -0.44898],
    [-0.1321, -0.11454],
    [0.016378, -0.012005],
    [0.012367, -0.11932],
    [-0.16113, -0.24427],
    [-0.10536, 0.049882],
    [-0.041139, 0.063587],
    [-0.0089569, -0.073611],
];

/// Law of the open-water thrust.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum OpenWater {
    /// K_T = k0 + k1 J + k2 J^2, extended beyond its quadrant after Yasukawa: below J = -0.5 the parabola is turned over and
    /// steepened by 1.5, and astern rotation multiplies with beta_t = 0.4811 p^2 - 1.1116 p - 0.1404.
    Quadratic {
        /// K_T at J = 0.
        k0: f64,
        /// Slope at J = 0.
        k1: f64,
        /// Curvature.
        k2: f64,
        /// Pitch ratio p = P/D.
        pitch_ratio: f64,
    },
    /// Wageningen B4-70, P/D = 0.8, 31 Fourier terms (Roddy, Hess & Faller 2006, NSWCCD-50-TR-2006/004).
    B470Pitch08,
}

impl OpenWater {
    /// Thrust T \[N\] at propeller rate `n` \[rps\] and inflow speed `va` \[m/s\], any signs; `diameter` D \[m\], `rho` \[kg/m^3\].
    pub fn thrust(&self, n: f64, va: f64, diameter: f64, rho: f64) -> f64 {
        match self {
            Self::Quadratic { k0, k1, k2, pitch_ratio } => {
                quadratic_thrust([*k0, *k1, *k2], *pitch_ratio, n, va, diameter, rho)
            }
            Self::B470Pitch08 => fourier_thrust(n, va, diameter, rho),
        }
    }
}

/// T = C_T*(beta) 1/2 rho (V_A^2 + (0.7 pi n D)^2) pi D^2 / 4, beta = atan2(V_A, 0.7 pi n D),
/// C_T* = 1/100 sum_k (A_k cos k beta + B_k sin k beta).
fn fourier_thrust(n: f64, va: f64, diameter: f64, rho: f64) -> f64 {
    let tip = 0.7 * PI * n * diameter;
    let (sin, cos) = va.atan2(tip).sin_cos();
    let (mut c, mut s) = (1.0, 0.0);
    let mut sum = 0.0;
    for [a, b] in B470_08 {
        sum += a * c + b * s;
        (c, s) = (c * cos - s * sin, s * cos + c * sin);
    }
    0.01 * sum * 0.5 * rho * (va * va + tip * tip) * PI * diameter * diameter / 4.0
}

fn quadratic_thrust(k: [f64; 3], pitch_ratio: f64, n: f64, va: f64, diameter: f64, rho: f64) -> f64 {
    // Multiplied out with n^2 D^2, so that n = 0 needs no division.
    let polynomial = |nd: f64, va: f64| k[0] * nd * nd + k[1] * nd * va + k[2] * va * va;
    let ahead = |nd: f64, va: f64| {
        const LOWEST: f64 = -0.5;
        let below = va - LOWEST * nd;
        if below >= 0.0 {
            polynomial(nd, va)
        } else {
            1.5 * (k[1] * nd * below - k[2] * below * below) + polynomial(nd, LOWEST * nd)
        }
    };
    let nd = n * diameter;
    let scale = rho * diameter * diameter;
    if n >= 0.0 {
        return scale * ahead(nd, va);
    }
    let reversal = 0.4811 * pitch_ratio * pitch_ratio - 1.1116 * pitch_ratio - 0.1404;
    let weight = astern_weight(n, diameter, va);
    scale * ((1.0 - weight) * ahead(0.0, va) + weight * reversal * ahead(-nd, -va))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kt(law: OpenWater, n: f64, j: f64) -> f64 {
        // Unit diameter and density: J = V_A / (n D).
        law.thrust(n, j * n, 1.0, 1.0) / (n * n)
    }

    #[test]
    fn fourier_series_gives_the_published_ahead_curve() {
        let published = [0.346, 0.313, 0.282, 0.254, 0.219, 0.176, 0.127, 0.078, 0.028];
        for (i, expected) in published.iter().enumerate() {
            let found = kt(OpenWater::B470Pitch08, 1.0, 0.1 * i as f64);
            assert!((found - expected).abs() < 1e-3, "J {} K_T {found}", 0.1 * i as f64);
        }
    }

    #[test]
    fn fourier_series_gives_the_published_crash_back_curve() {
        let published = [(0.0, -0.255), (-0.2, -0.235), (-0.4, -0.222), (-0.6, -0.329), (-0.8, -0.507), (-1.0, -0.672)];
        for (j, expected) in published {
            let found = kt(OpenWater::B470Pitch08, -1.0, j);
            assert!((found - expected).abs() < 1.5e-3, "J {j}: {found}");
        }
    }

    #[test]
    fn quadratic_law_is_the_standard_one_ahead() {
        let law = OpenWater::Quadratic { k0: 0.2931, k1: -0.2753, k2: -0.1385, pitch_ratio: 0.72 };
        for j in [0.0_f64, 0.3, 0.6, 0.9] {
            let expected = 0.2931 - 0.2753 * j - 0.1385 * j * j;
            assert!((kt(law, 2.0, j) - expected).abs() < 1e-14);
        }
    }

    #[test]
    fn extension_of_the_quadratic_law_agrees_in_sign_with_the_series() {
        let law = OpenWater::Quadratic { k0: 0.346, k1: -0.30, k2: -0.12, pitch_ratio: 0.8 };
        for (n, va) in [(1.0, -0.5), (-1.0, 0.5), (-1.0, -0.3), (1.0, 0.3)] {
            let (a, b) = (law.thrust(n, va, 1.0, 1.0), OpenWater::B470Pitch08.thrust(n, va, 1.0, 1.0));
            assert!(a * b > 0.0 && (0.4..2.5).contains(&(a / b)), "n {n} V_A {va}: {a} against {b}");
        }
    }
}
