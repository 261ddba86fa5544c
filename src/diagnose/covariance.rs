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

/// A row of a symmetric matrix.
#[inline(always)]
pub fn row<S: Scalar>(p: &Square<S>, place: usize) -> [S; Z] {
    let mut out = p[place];
    (place + 1..Z).for_each(|i| out[i] = p[i][place]);
    out
}

/// The sum of two rows of a symmetric matrix, `first < second`.
#[inline(always)]
pub fn sum_of_rows<S: Scalar>(p: &Square<S>, first: usize, second: usize) -> [S; Z] {
    let mut out = [S::zero(); Z];
    (0..=first).for_each(|i| out[i] = p[first][i] + p[second][i]);
    (first + 1..=second).for_each(|i| out[i] = p[i][first] + p[second][i]);
    (second + 1..Z).for_each(|i| out[i] = p[i][first] + p[i][second]);
    out
}

/// The sum of the first rows of a symmetric matrix, each times a slope, and of one more row.
#[inline(always)]
pub fn sum_along<S: Scalar>(p: &Square<S>, slopes: &[S; STATES], more: usize) -> [S; Z] {
    let mut sum = row(p, more);
    for (l, slope) in slopes.iter().enumerate() {
        let of_state = row(p, l);
        (0..Z).for_each(|i| sum[i] += of_state[i] * *slope);
    }
    sum
}

/// Takes `gain ph'` out of the covariance: what a measurement tells, `ph` being the covariance of the filter state with it.
#[inline(always)]
pub fn correct<S: Scalar>(p: &mut Square<S>, gain: &[S; Z], ph: &[S; Z]) {
    // Each row by itself, so that the loop along it has a fixed length.
    macro_rules! rows {
        ($($i:literal)*) => { $((0..=$i).for_each(|l| p[$i][l] -= gain[$i] * ph[l]);)* };
    }
    rows!(0 1 2 3 4 5 6 7 8 9 10 11 12 13 14);
}

/// Adds a multiple of row `L` of a symmetric matrix.
#[inline(always)]
fn add_row<S: Scalar, const L: usize>(p: &Square<S>, factor: S, sums: &mut [S; Z]) {
    (0..=L).for_each(|c| sums[c] += p[L][c] * factor);
    (L + 1..Z).for_each(|c| sums[c] += p[c][L] * factor);
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
    for (i, moved) in moved.iter_mut().enumerate() {
        let mut sums = [S::zero(); Z];
        match i {
            0 => (0..Z).for_each(|c| sums[c] = p[c][0]),
            1 => {
                sums[0] = p[1][0];
                (1..Z).for_each(|c| sums[c] = p[c][1]);
            }
            _ => (),
        }
        add_row::<S, 2>(p, a[i][2], &mut sums);
        add_row::<S, 3>(p, a[i][3], &mut sums);
        add_row::<S, 4>(p, a[i][4], &mut sums);
        add_row::<S, 5>(p, a[i][5], &mut sums);
        add_row::<S, 6>(p, gamma[i][0], &mut sums);
        add_row::<S, 7>(p, gamma[i][1], &mut sums);
        add_row::<S, 8>(p, gamma[i][2], &mut sums);
        (0..Z).for_each(|c| moved[c] = sums[c]);
    }
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
        assert!((0..Z).all(|i| row(&p, i) == full()[i]));
        for (i, j) in [(0, 9), (3, 12), (5, 14)] {
            let sum = sum_of_rows(&p, i, j);
            assert!((0..Z).all(|c| sum[c] == full()[i][c] + full()[j][c]));
        }
        let gain: [f64; Z] = std::array::from_fn(|i| 0.1 * i as f64);
        correct(&mut p, &gain, &full()[4]);
        for i in 0..Z {
            assert!((0..=i).all(|l| (p[i][l] - full()[i][l] + gain[i] * full()[4][l]).abs() < 1e-12));
        }
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
