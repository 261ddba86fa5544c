//! The covariance of the filter state, from its start through measurements and steps, for one noise or for several at once.
//! It is not the filter: means, innovations and sensitivities are carried elsewhere.

use super::noise::{GROUP_OF, Noise};
use crate::model::Model;
use crate::state::STATES;
use trimtab_ad::{Lanes, Scalar};

/// Length of the filter state `[x y psi u v r | w_X w_Y w_N | e_1 .. e_6]`.
pub const Z: usize = 15;

/// A square matrix over the filter state.
pub type Square<S> = [[S; Z]; Z];

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
    let speed = (9.80665 * l).sqrt();
    let wide = [0.5 * l, 0.5 * l, 0.2, 0.05 * speed, 0.05 * speed, 0.1 * speed / l];
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
/// everything else fades on its own. `boost` multiplies what the unknown force gains.
pub fn predict<S: Scalar>(
    p: &mut Square<S>,
    a: &[[f64; STATES]; STATES],
    gamma: &[[f64; 3]; STATES],
    noise: &Discrete<S>,
    boost: f64,
) {
    let mut moved = [[S::zero(); Z]; STATES];
    for i in 0..STATES {
        let row = a[i].iter().enumerate().chain(gamma[i].iter().enumerate().map(|(l, g)| (STATES + l, g)));
        for (l, factor) in row.filter(|(_, factor)| **factor != 0.0) {
            for c in 0..Z {
                moved[i][c] += p[l][c] * *factor;
            }
        }
    }
    let fade: [S; Z - STATES] = std::array::from_fn(|i| if i < 3 { noise.fade } else { noise.rho[i - 3] });
    for i in 0..Z {
        for j in 0..=i {
            let value = if i < STATES {
                let mut sum = S::zero();
                (0..STATES).for_each(|l| sum += moved[i][l] * a[j][l]);
                (0..3).for_each(|l| sum += moved[i][STATES + l] * gamma[j][l]);
                sum
            } else if j < STATES {
                moved[j][i] * fade[i - STATES]
            } else {
                p[i][j] * fade[i - STATES] * fade[j - STATES]
            };
            p[i][j] = value;
            p[j][i] = value;
        }
    }
    for i in 0..3 {
        p[6 + i][6 + i] += noise.force[i] * (S::one() - noise.fade * noise.fade) * boost;
    }
    for j in 0..STATES {
        p[9 + j][9 + j] += noise.coloured[j] * (S::one() - noise.rho[j] * noise.rho[j]);
    }
}
