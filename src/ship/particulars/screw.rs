//! Thrust of the Wageningen B-series, the propellers that a screw is taken for where its open-water curve is not known.
//! Ahead and without cavitation; what a propeller does astern is in [`crate::physics::Flow`].

/// A propeller of the Wageningen B-series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Screw {
    /// Number of blades Z, 2 to 7.
    pub blades: u8,
    /// Expanded area ratio A_E/A_0 \[-\], 0.30 to 1.05.
    pub area: f64,
    /// Pitch ratio P/D \[-\], 0.5 to 1.4.
    pub pitch: f64,
}

/// Coefficient of each term of K_T, and the exponents of J, P/D, A_E/A_0 and Z.
const TERMS: [(f64, [i32; 4]); 39] = [
    (0.008_804_96, [0, 0, 0, 0]),
    (-0.204_554, [1, 0, 0, 0]),
    (0.166_351, [0, 1, 0, 0]),
    (0.158_114, [0, 2, 0, 0]),
    (-0.147_581, [2, 0, 1, 0]),
    (-0.481_497, [1, 1, 1, 0]),
    (0.415_437, [0, 2, 1, 0]),
    (0.014_404_3, [0, 0, 0, 1]),
    (-0.053_005_4, [2, 0, 0, 1]),
    (0.014_348_1, [0, 1, 0, 1]),
    (0.060_682_6, [1, 1, 0, 1]),
    (-0.012_589_4, [0, 0, 1, 1]),
    (0.010_968_9, [1, 0, 1, 1]),
    (-0.133_698, [0, 3, 0, 0]),
    (0.006_384_07, [0, 6, 0, 0]),
    (-0.001_327_18, [2, 6, 0, 0]),
    (0.168_496, [3, 0, 1, 0]),
    (-0.050_721_4, [0, 0, 2, 0]),
    (0.085_455_9, [2, 0, 2, 0]),
    (-0.050_447_5, [3, 0, 2, 0]),
    (0.010_465, [1, 6, 2, 0]),
    (-0.006_482_72, [2, 6, 2, 0]),
    (-0.008_417_28, [0, 3, 0, 1]),
    (0.016_842_4, [1, 3, 0, 1]),
    (-0.001_022_96, [3, 3, 0, 1]),
    (-0.031_779_1, [0, 3, 1, 1]),
    (0.018_604, [1, 0, 2, 1]),
    (-0.004_107_98, [0, 2, 2, 1]),
    (-0.000_606_848, [0, 0, 0, 2]),
    (-0.004_981_9, [1, 0, 0, 2]),
    (0.002_598_3, [2, 0, 0, 2]),
    (-0.000_560_528, [3, 0, 0, 2]),
    (-0.001_636_52, [1, 2, 0, 2]),
    (-0.000_328_787, [1, 6, 0, 2]),
    (0.000_116_502, [2, 6, 0, 2]),
    (0.000_690_904, [0, 0, 1, 2]),
    (0.004_217_49, [0, 3, 1, 2]),
    (0.000_056_522_9, [3, 6, 1, 2]),
    (-0.001_465_64, [0, 3, 2, 2]),
];

/// K_T of a propeller of the Wageningen B-series at an advance ratio J, ahead, at a Reynolds number of 2e6.
///
/// Source: Oosterveld & van Oossanen 1975, Further computer-analyzed data of the Wageningen B-screw series, table 5.
pub fn thrust_coefficient(screw: &Screw, j: f64) -> f64 {
    let base = [j, screw.pitch, screw.area, f64::from(screw.blades)];
    TERMS.iter().map(|(c, powers)| c * base.iter().zip(powers).map(|(x, n)| x.powi(*n)).product::<f64>()).sum()
}

/// Coefficients of `k0 + k1 J + k2 J^2` nearest to K_T from J = 0 to the advance ratio without thrust (least squares).
pub(super) fn quadratic(screw: &Screw) -> [f64; 3] {
    const STEPS: usize = 50;
    let last = (1..=200).map(|i| 0.01 * f64::from(i)).find(|j| thrust_coefficient(screw, *j) <= 0.0).unwrap_or(2.0);
    let rows = (0..=STEPS).map(|i| last * i as f64 / STEPS as f64);
    let (mut normal, mut right) = (nalgebra::Matrix3::zeros(), nalgebra::Vector3::zeros());
    for j in rows {
        let row = nalgebra::Vector3::new(1.0, j, j * j);
        normal += row * row.transpose();
        right += row * thrust_coefficient(screw, j);
    }
    // The three powers differ over more than two points, so that the matrix has an inverse.
    normal.lu().solve(&right).map_or([0.35, -0.25, -0.15], Into::into)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_is_that_of_the_published_chart() {
        // B4-70: the four-quadrant chart of Roddy, Hess & Faller 2006 at rest, and the quadratic of the ship files.
        let screw = |pitch| Screw { blades: 4, area: 0.70, pitch };
        for (pitch, at_rest) in [(0.8, 0.346), (1.0, 0.450)] {
            let k = thrust_coefficient(&screw(pitch), 0.0);
            assert!((k / at_rest - 1.0).abs() < 0.04, "P/D {pitch}: {k}");
        }
        let [k0, k1, k2] = quadratic(&screw(0.8));
        for j in [0.0, 0.2, 0.4, 0.6, 0.8] {
            let (fitted, known) = (k0 + j * (k1 + j * k2), 0.3425 - 0.2424 * j - 0.1897 * j * j);
            assert!((fitted - known).abs() < 0.02, "J {j}: {fitted} {known}");
            assert!((fitted - thrust_coefficient(&screw(0.8), j)).abs() < 0.01);
        }
    }
}
