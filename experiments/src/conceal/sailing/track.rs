//! The sampling of a concealed run, its track before noise, and the states between its rows.
//! It simulates nothing; `sail` fills it.

use crate::truth::motion::{Inputs, State};

/// Time between rows \[s\].
pub const PERIOD: f64 = 2.0;
/// Steps of a run: 121 rows.
pub const STEPS: usize = 120;
/// Inner steps in one row interval: 0.25 s each.
pub const INNER: usize = 8;

/// The true motion of a run, and the report of noise-free sensors with the concealed defects.
#[derive(Debug, Clone, PartialEq)]
pub struct Track {
    /// True states at the rows.
    pub truth: Vec<State>,
    /// Reported states `[x, y, psi, u, v, r]`, before noise.
    pub reported: Vec<[f64; 6]>,
    /// Recorded inputs: the orders.
    pub orders: Vec<Inputs>,
    /// Environment channels: header with unit, values.
    pub channels: Vec<(String, Vec<f64>)>,
    /// For every effect, the mean square of its force: X, Y \[N\], N \[N m\].
    pub energy: Vec<[f64; 3]>,
}

/// The states at inner steps, for sensors that report another time.
pub struct Fine {
    nodes: Vec<State>,
}

impl Fine {
    /// From states at the inner steps.
    pub fn new(nodes: Vec<State>) -> Self {
        Self { nodes }
    }

    /// From states at the rows: straight lines between them, as an Euler step makes them.
    pub fn between_rows(rows: &[State]) -> Self {
        let pairs = rows.windows(2).flat_map(|w| (0..INNER).map(|i| between(&w[0], &w[1], i as f64 / INNER as f64)));
        let mut nodes: Vec<State> = pairs.collect();
        nodes.extend(rows.last());
        Self { nodes }
    }

    /// The state `shift` seconds from row `row`, linear between inner steps and beyond the ends of the run.
    pub fn at(&self, row: usize, shift: f64) -> State {
        let place = (row * INNER) as f64 + shift / (PERIOD / INNER as f64);
        let low = (place.floor().max(0.0) as usize).min(self.nodes.len().saturating_sub(2));
        let (Some(a), Some(b)) = (self.nodes.get(low), self.nodes.get(low + 1)) else { return State::default() };
        between(a, b, place - low as f64)
    }
}

fn between(a: &State, b: &State, fraction: f64) -> State {
    let (a, b) = (a.to_array(), b.to_array());
    State::from_array(std::array::from_fn(|i| a[i] + fraction * (b[i] - a[i])))
}
