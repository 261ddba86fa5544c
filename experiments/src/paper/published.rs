//! Numbers that the paper prints for ships A and B: parameters and performance, for comparison with ours.
//! Only the initial guess enters a fit, and only the baseline an evaluation; the statistics of Table 1 are in `coverage`.

use crate::truth::ships::ShipId;

/// Numbers of Papandreou et al. 2025 (arXiv 2502.18696) for one ship. Parameters are p0 to p10.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Published {
    /// Initial guess of the fit. Printed as (p1, p2, p3, p0, p4, ...): the values only make sense so.
    pub initial: [f64; 11],
    /// Baseline p~, said to come from captive tests.
    pub baseline: [f64; 11],
    /// Fitted p*.
    pub fitted: [f64; 11],
    /// mARI \[-\].
    pub mari: f64,
    /// Improvement of the mean cVDM \[-\].
    pub cvdm_improvement: f64,
    /// Consistency, 1 - Var(cVDM*)/Var(cVDM~) \[-\].
    pub consistency: f64,
}

/// The paper's numbers for a ship.
pub fn published(ship: ShipId) -> Published {
    // Both ships have the same rudder, and so the same p~4 to p~10.
    let baseline = |p0, p1, p2, p3| [p0, p1, p2, p3, -0.012, 0.864, 0.182, -1.191, 0.005, -0.1230, 0.779];
    match ship {
        ShipId::A => Published {
            initial: [0.00, 34187.03, -12569.98, 1586.29, -0.02, 2.70, 0.42, -3.23, 0.06, -0.11, 1.97],
            baseline: baseline(0.0, 10500.0, -1900.0, 346.0),
            fitted: [-0.017, 34187.0, -12568.0, 1594.0, -0.039, 3.193, 0.205, -4.882, 0.048, 0.0746, 1.370],
            mari: 0.321,
            cvdm_improvement: 0.516,
            consistency: 0.7236,
        },
        ShipId::B => Published {
            initial: [-0.05, 5504.65, -4218.06, 1063.42, -0.01, 2.73, 0.35, -3.10, 0.06, -0.11, 1.97],
            baseline: baseline(0.0, 5669.0, -1127.0, 538.0),
            fitted: [-0.027, 5505.0, -4215.0, 1077.0, 0.012, 2.420, -0.019, -3.195, 0.047, 0.0001, 1.359],
            mari: 0.429,
            cvdm_improvement: 0.578,
            consistency: 0.8967,
        },
    }
}
