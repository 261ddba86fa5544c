//! The covariance of the filter state, from its start through measurements and steps, for one noise or for several at once.
//! It is not the filter: means, innovations and sensitivities are carried elsewhere.

use super::noise::{GROUP_OF, Noise};
use super::settings::START_SPREAD;
use crate::model::Model;
use crate::state::STATES;
use crate::units::GRAVITY;
use trimtab_ad::{Lanes, Scalar};

/// Length of the filter state `[x y psi u v r | w_X w_Y w_N | e_1 .. e_6]`.
pub const Z: usize = 15;

/// A symmetric matrix over the filter state, of which the entries `[i][j]` with `j <= i` are kept.
pub type Square<S> = [[S; Z]; Z];

/// A measurement, by how it corrects the filter state.
#[derive(Clone, Copy, Debug)]
pub struct Measurement<S> {
    /// The gain.
    pub gain: [S; Z],
    /// The covariance of the filter state with it.
    pub ph: [S; Z],
}

impl<S: Scalar> Measurement<S> {
    /// Nothing.
    pub fn nothing() -> Self {
        Self { gain: [S::zero(); Z], ph: [S::zero(); Z] }
    }
}

/// Writes a row of the covariance after the correction `before`, which is not in `p` yet.
#[inline(always)]
fn row<S: Scalar>(p: &Square<S>, before: Option<&Measurement<S>>, place: usize, out: &mut [S; Z]) {
    (0..=place).for_each(|i| out[i] = p[place][i]);
    (place + 1..Z).for_each(|i| out[i] = p[i][place]);
    if let Some(Measurement { gain, ph }) = before {
        let (own_gain, own_ph) = (gain[place], ph[place]);
        (0..=place).for_each(|i| out[i] -= own_gain * ph[i]);
        (place + 1..Z).for_each(|i| out[i] -= gain[i] * own_ph);
    }
}

/// Writes the sum of two rows of the covariance, `one < two`, each as `row` has it.
#[inline(always)]
pub fn sum_of_rows<S: Scalar>(
    p: &Square<S>,
    before: Option<&Measurement<S>>,
    one: usize,
    two: usize,
    sum: &mut [S; Z],
) {
    let Some(Measurement { gain, ph }) = before else {
        (0..=one).for_each(|i| sum[i] = p[one][i] + p[two][i]);
        (one + 1..=two).for_each(|i| sum[i] = p[i][one] + p[two][i]);
        (two + 1..Z).for_each(|i| sum[i] = p[i][one] + p[i][two]);
        return;
    };
    let ([gain_1, gain_2], [ph_1, ph_2]) = ([gain[one], gain[two]], [ph[one], ph[two]]);
    (0..=one).for_each(|i| sum[i] = p[one][i] - gain_1 * ph[i] + (p[two][i] - gain_2 * ph[i]));
    (one + 1..=two).for_each(|i| sum[i] = p[i][one] - gain[i] * ph_1 + (p[two][i] - gain_2 * ph[i]));
    (two + 1..Z).for_each(|i| sum[i] = p[i][one] - gain[i] * ph_1 + (p[i][two] - gain[i] * ph_2));
}

/// Writes the sum of the first rows of the covariance, each times a slope, and of one more row, each as `row` has it.
#[inline(always)]
pub fn sum_along<S: Scalar + PartialEq>(
    p: &Square<S>,
    before: Option<&Measurement<S>>,
    slopes: &[S; STATES],
    more: usize,
    sum: &mut [S; Z],
) {
    let mut of_state = [S::zero(); Z];
    row(p, before, more, sum);
    // Most reports depend on one or two entries of the state.
    for (l, slope) in slopes.iter().enumerate().filter(|(_, slope)| **slope != S::zero()) {
        row(p, before, l, &mut of_state);
        (0..Z).for_each(|i| sum[i] += of_state[i] * *slope);
    }
}

/// Takes `gain ph'` out of the covariance: the correction by a measurement.
#[inline(always)]
pub fn correct<S: Scalar>(p: &mut Square<S>, Measurement { gain, ph }: &Measurement<S>) {
    // Each row by itself, so that the loop along it has a fixed length.
    macro_rules! rows {
        ($($i:literal)*) => { $((0..=$i).for_each(|l| p[$i][l] -= gain[$i] * ph[l]);)* };
    }
    rows!(0 1 2 3 4 5 6 7 8 9 10 11 12 13 14);
}

/// Corrects by two measurements, one after the other: each entry is loaded and stored once for both.
#[inline(always)]
pub fn correct_twice<S: Scalar>(p: &mut Square<S>, [one, two]: &[Measurement<S>; 2]) {
    // A few columns at a time, whose covariances with both measurements stay in registers.
    columns::<S, 0>(p, one, two);
    columns::<S, WIDE>(p, one, two);
    columns::<S, { 2 * WIDE }>(p, one, two);
}

/// Columns that are worked on at a time.
const WIDE: usize = Z / 3;

/// Corrects the columns from `FROM` on by two measurements.
#[inline(always)]
fn columns<S: Scalar, const FROM: usize>(p: &mut Square<S>, one: &Measurement<S>, two: &Measurement<S>) {
    let [a, b]: [[S; WIDE]; 2] = [one, two].map(|one| std::array::from_fn(|c| one.ph[FROM + c]));
    macro_rules! rows {
        ($($i:literal)*) => { $(
            let (gain_1, gain_2) = (one.gain[$i], two.gain[$i]);
            for c in 0..WIDE {
                if FROM + c <= $i {
                    p[$i][FROM + c] = p[$i][FROM + c] - gain_1 * a[c] - gain_2 * b[c];
                }
            }
        )* };
    }
    rows!(0 1 2 3 4 5 6 7 8 9 10 11 12 13 14);
}

/// The noise over one sample period: variances, and what is left of a correlation after it.
#[derive(Clone, Copy, Debug)]
pub struct Discrete<S> {
    /// Variance of the white part by channel \[unit of the channel squared\].
    pub white: [S; STATES],
    /// Variance of the coloured part by channel \[unit of the channel squared\].
    pub coloured: [S; STATES],
    /// Correlation of the coloured part with itself one sample later.
    pub rho: [S; STATES],
    /// Variance of the unknown force in X, Y \[N^2\] and N \[N^2 m^2\].
    pub force: [S; 3],
    /// Correlation of the unknown force with itself one sample later.
    pub fade: S,
}

impl Discrete<f64> {
    /// Of a noise, at a sample period \[s\].
    pub fn new(noise: &Noise, dt: f64) -> Self {
        let sensor = |j: usize| &noise.sensors[GROUP_OF[j]];
        Self {
            white: std::array::from_fn(|j| sensor(j).white.powi(2)),
            coloured: std::array::from_fn(|j| sensor(j).coloured.powi(2)),
            rho: std::array::from_fn(|j| (-dt / sensor(j).time).exp()),
            force: noise.force.map(|f| f * f),
            fade: (-dt / noise.force_time).exp(),
        }
    }

    /// The same noise in another number.
    pub fn lift<S: Scalar>(&self) -> Discrete<S> {
        Discrete {
            white: self.white.map(S::from_f64),
            coloured: self.coloured.map(S::from_f64),
            rho: self.rho.map(S::from_f64),
            force: self.force.map(S::from_f64),
            fade: S::from_f64(self.fade),
        }
    }
}

impl Discrete<Lanes> {
    /// Four noises side by side.
    pub fn side_by_side(noises: &[Discrete<f64>; Lanes::LANES]) -> Self {
        let lanes = |of: &dyn Fn(&Discrete<f64>) -> f64| Lanes::from_fn(|lane| of(&noises[lane]));
        Self {
            white: std::array::from_fn(|j| lanes(&|n| n.white[j])),
            coloured: std::array::from_fn(|j| lanes(&|n| n.coloured[j])),
            rho: std::array::from_fn(|j| lanes(&|n| n.rho[j])),
            force: std::array::from_fn(|i| lanes(&|n| n.force[i])),
            fade: lanes(&|n| n.fade),
        }
    }
}

/// Wide on the ship's state (the run's own start is unknown), stationary on the unknown force and the coloured sensors.
pub fn initial<S: Scalar>(noise: &Discrete<S>, model: &Model) -> Square<S> {
    let mut p = [[S::zero(); Z]; Z];
    let l = model.ship.hull.lpp;
    let speed = (GRAVITY * l).sqrt();
    let [x, y, psi, u, v, r] = START_SPREAD;
    let wide = [x * l, y * l, psi, u * speed, v * speed, r * speed / l];
    for (i, w) in wide.iter().enumerate() {
        p[i][i] = S::from_f64(w * w);
    }
    for i in 0..3 {
        p[6 + i][6 + i] = noise.force[i];
    }
    for j in 0..STATES {
        p[9 + j][9 + j] = noise.coloured[j];
    }
    p
}

/// Writes the covariance of the ship's state one sample later with the filter state before.
#[inline(always)]
fn moved<S: Scalar>(p: &Square<S>, a: &[[S; STATES]; STATES], gamma: &[[S; 3]; STATES], out: &mut [[S; Z]; STATES]) {
    // The rows that move the ship, whole: heading, velocities and unknown force.
    let mut rows = [[S::zero(); Z]; 7];
    macro_rules! whole {
        ($($l:literal)*) => { $(
            (0..=$l).for_each(|c| rows[$l - 2][c] = p[$l][c]);
            ($l + 1..Z).for_each(|c| rows[$l - 2][c] = p[c][$l]);
        )* };
    }
    whole!(2 3 4 5 6 7 8);
    (0..Z).for_each(|c| out[0][c] = p[c][0]);
    out[1][0] = p[1][0];
    (1..Z).for_each(|c| out[1][c] = p[c][1]);
    // Two rows and a few columns at a time, whose sums stay in registers.
    for i in (0..STATES).step_by(2) {
        for from in (0..Z).step_by(WIDE) {
            let mut sums = [[S::zero(); WIDE]; 2];
            (0..2).for_each(|r| (0..WIDE).for_each(|c| sums[r][c] = out[i + r][from + c]));
            // Loops and no closures: a compiler that does not inline one keeps its sums in memory.
            for (l, row) in rows.iter().enumerate() {
                let factors =
                    if l < 4 { [a[i][2 + l], a[i + 1][2 + l]] } else { [gamma[i][l - 4], gamma[i + 1][l - 4]] };
                for (sums, factor) in sums.iter_mut().zip(factors) {
                    for (sum, p) in sums.iter_mut().zip(&row[from..from + WIDE]) {
                        *sum += *p * factor;
                    }
                }
            }
            (0..2).for_each(|r| (0..WIDE).for_each(|c| out[i + r][from + c] = sums[r][c]));
        }
    }
}

/// `F P F' + Q` with the block structure of the filter state: `a` moves the ship, `gamma` lets the unknown force act on it,
/// everything else fades on its own. The first two columns of `a` are those of the identity: the motion does not depend on the
/// position. `boost` multiplies what the unknown force gains.
pub fn predict<S: Scalar>(
    p: &mut Square<S>,
    a: &[[S; STATES]; STATES],
    gamma: &[[S; 3]; STATES],
    noise: &Discrete<S>,
    boost: S,
) {
    let mut moved = [[S::zero(); Z]; STATES];
    self::moved(p, a, gamma, &mut moved);
    for i in 0..STATES {
        for j in 0..=i {
            let mut sum = if j < 2 { moved[i][j] } else { S::zero() };
            (2..STATES).for_each(|l| sum += moved[i][l] * a[j][l]);
            (0..3).for_each(|l| sum += moved[i][STATES + l] * gamma[j][l]);
            p[i][j] = sum;
        }
    }
    let fade: [S; Z - STATES] = std::array::from_fn(|i| if i < 3 { noise.fade } else { noise.rho[i - 3] });
    for i in STATES..Z {
        let own = fade[i - STATES];
        (0..STATES).for_each(|j| p[i][j] = moved[j][i] * own);
        (STATES..=i).for_each(|j| p[i][j] = p[i][j] * own * fade[j - STATES]);
    }
    for i in 0..3 {
        p[6 + i][6 + i] += noise.force[i] * (S::one() - noise.fade * noise.fade) * boost;
    }
    for j in 0..STATES {
        p[9 + j][9 + j] += noise.coloured[j] * (S::one() - noise.rho[j] * noise.rho[j]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::example;
    use nalgebra::SMatrix;

    type Dense = SMatrix<f64, Z, Z>;

    fn jacobians() -> ([[f64; STATES]; STATES], [[f64; 3]; STATES]) {
        let moves = |i: usize, j: usize| if j < 2 { 0.0 } else { 0.01 * ((3 * i + 5 * j) % 7) as f64 };
        let value = |i: usize, j: usize| f64::from(u8::from(i == j)) + moves(i, j);
        (
            std::array::from_fn(|i| std::array::from_fn(|j| value(i, j))),
            std::array::from_fn(|i| std::array::from_fn(|j| if i < 3 { 0.0 } else { 1e-5 * (i + j) as f64 })),
        )
    }

    /// A covariance of everything with everything.
    fn full() -> Square<f64> {
        let root = Dense::from_fn(|i, j| ((2 * i + 3 * j) % 5) as f64 - 2.0);
        let p = root * root.transpose() + Dense::identity();
        std::array::from_fn(|i| std::array::from_fn(|j| p[(i, j)]))
    }

    #[test]
    fn the_block_form_of_a_step_is_f_p_f_transposed_plus_q() {
        let (a, gamma) = jacobians();
        let noise = Discrete::new(&example::noise(), 2.0);
        let mut f = Dense::zeros();
        for i in 0..STATES {
            (0..STATES).for_each(|j| f[(i, j)] = a[i][j]);
            (0..3).for_each(|j| f[(i, STATES + j)] = gamma[i][j]);
            f[(9 + i, 9 + i)] = noise.rho[i];
        }
        (6..9).for_each(|i| f[(i, i)] = noise.fade);
        let mut expected = f * Dense::from_fn(|i, j| full()[i][j]) * f.transpose();
        (0..3).for_each(|i| expected[(6 + i, 6 + i)] += 5.0 * noise.force[i] * (1.0 - noise.fade.powi(2)));
        (0..STATES).for_each(|j| expected[(9 + j, 9 + j)] += noise.coloured[j] * (1.0 - noise.rho[j].powi(2)));
        let mut p = full();
        predict(&mut p, &a, &gamma, &noise, 5.0);
        for i in 0..Z {
            for j in 0..=i {
                let off = (p[i][j] - expected[(i, j)]).abs();
                assert!(off < 1e-10 * expected[(i, i)].max(expected[(j, j)]).max(1.0), "{i} {j}");
            }
        }
    }

    #[test]
    fn a_correction_takes_a_product_out_of_the_lower_triangle_and_a_row_is_whole() {
        let mut p = full();
        (0..Z).for_each(|i| (i + 1..Z).for_each(|j| p[i][j] = f64::NAN));
        let mut sum = [f64::NAN; Z];
        for (i, whole) in full().iter().enumerate() {
            row(&p, None, i, &mut sum);
            assert_eq!(sum, *whole);
        }
        for (i, j) in [(0, 9), (3, 12), (5, 14)] {
            sum_of_rows(&p, None, i, j, &mut sum);
            assert!((0..Z).all(|c| sum[c] == full()[i][c] + full()[j][c]));
        }
        let gain: [f64; Z] = std::array::from_fn(|i| 0.1 * i as f64);
        correct(&mut p, &Measurement { gain, ph: full()[4] });
        for i in 0..Z {
            assert!((0..=i).all(|l| (p[i][l] - full()[i][l] + gain[i] * full()[4][l]).abs() < 1e-12));
        }
    }

    #[test]
    fn two_corrections_at_once_have_the_bits_of_one_after_the_other() {
        let measurements: [Measurement<f64>; 2] = [0.1, 0.7].map(|by| Measurement {
            gain: full()[5].map(|g| by / (1.0 + g * g)),
            ph: full()[8].map(|h| h / (3.0 + by)),
        });
        let (mut each, mut both) = (full(), full());
        correct(&mut each, &measurements[0]);
        let slopes = [0.5, 0.0, 1.0, -2.0, 0.0, 0.1];
        for more in 9..Z {
            let [mut after, mut expected] = [[f64::NAN; Z]; 2];
            sum_of_rows(&both, Some(&measurements[0]), more - 9, more, &mut after);
            sum_of_rows(&each, None, more - 9, more, &mut expected);
            assert_eq!(after, expected, "{more}");
            sum_along(&both, Some(&measurements[0]), &slopes, more, &mut after);
            sum_along(&each, None, &slopes, more, &mut expected);
            assert_eq!(after, expected, "{more}");
        }
        correct(&mut each, &measurements[1]);
        correct_twice(&mut both, &measurements);
        assert_eq!(both, each);
    }

    #[test]
    fn the_unknown_force_and_the_coloured_noise_keep_their_variances_from_step_to_step() {
        let model = example::model();
        let noise = Discrete::new(&example::noise(), 2.0);
        let (a, gamma) = jacobians();
        let mut p = initial(&noise, &model);
        (0..50).for_each(|_| predict(&mut p, &a, &gamma, &noise, 1.0));
        assert!((0..3).all(|i| (p[6 + i][6 + i] / noise.force[i] - 1.0).abs() < 1e-12));
        assert!((0..STATES).all(|j| (p[9 + j][9 + j] / noise.coloured[j] - 1.0).abs() < 1e-12));
    }

    #[test]
    fn eight_noises_side_by_side_are_each_alone() {
        let (a, gamma) = jacobians();
        let noises: [Discrete<f64>; Lanes::LANES] =
            std::array::from_fn(|i| Discrete::new(&example::noise(), 1.0 + i as f64));
        let side_by_side = Discrete::side_by_side(&noises);
        let model = example::model();
        let mut all = initial(&side_by_side, &model);
        let lift = Lanes::from_f64;
        predict(&mut all, &a.map(|row| row.map(lift)), &gamma.map(|row| row.map(lift)), &side_by_side, Lanes::one());
        for (lane, noise) in noises.iter().enumerate() {
            let mut one = initial(noise, &model);
            predict(&mut one, &a, &gamma, noise, 1.0);
            for i in 0..Z {
                for j in 0..=i {
                    let off = all[i][j].to_array()[lane] - one[i][j];
                    assert!(off.abs() <= 1e-12 * one[i][i].max(one[j][j]), "{lane} {i} {j}");
                }
            }
        }
    }
}
