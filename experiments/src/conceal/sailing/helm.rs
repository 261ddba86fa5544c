//! The helmsman of the concealed cases: orders over time, and the rudder and rate that follow from them row by row.
//! It depends on no effect, and on no ship but its length.

use std::f64::consts::PI;

use super::track::PERIOD;
use crate::truth::motion::{Inputs, State};

/// How the rudder is ordered during a part of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Steer {
    /// This angle \[rad\].
    Helm(f64),
    /// Steady on the first course altered by this angle \[rad\].
    Course(f64),
    /// Rudder and change of heading of this angle, to either side in turn \[rad\].
    Zigzag(f64),
}

/// Orders from a time on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Order {
    /// Time \[s\].
    pub from: f64,
    /// Propeller rate \[rps\].
    pub n: f64,
    /// Rudder.
    pub steer: Steer,
}

/// A helmsman under way.
#[derive(Debug)]
pub struct Helmsman<'a> {
    orders: &'a [Order],
    heading: f64,
    length: f64,
    part: usize,
    began: f64,
    side: f64,
}

/// Rates of steering gear and telegraph, contained in the recorded orders \[rad/s, rps/s\].
const RATES: [f64; 2] = [5.0 * PI / 180.0, 0.15];

impl<'a> Helmsman<'a> {
    /// A helmsman with orders, on a first heading \[rad\], in a ship of `length` \[m\].
    pub fn new(orders: &'a [Order], heading: f64, length: f64) -> Self {
        Self { orders, heading, length, part: usize::MAX, began: heading, side: 1.0 }
    }

    /// Orders one row after `before`, with the ship at `state` at time `t` \[s\].
    pub fn next(&mut self, t: f64, state: &State, before: &Inputs) -> Inputs {
        let part = self.orders.iter().rposition(|o| o.from <= t).unwrap_or(0);
        if part != self.part {
            (self.part, self.began, self.side) = (part, state.psi, 1.0);
        }
        let Some(Order { n, steer, .. }) = self.orders.get(part).copied() else { return *before };
        let wanted = match steer {
            Steer::Helm(angle) => angle,
            Steer::Course(alter) => {
                let error = self.heading + alter - state.psi;
                let turn = state.r * self.length / state.speed().max(1.0);
                if state.u < 0.0 { 0.0 } else { (1.4 * error - 0.7 * turn).clamp(-0.45, 0.45) }
            }
            Steer::Zigzag(angle) => {
                if self.side * (state.psi - self.began) >= angle.abs() {
                    self.side = -self.side;
                }
                self.side * angle
            }
        };
        let reach = |from: f64, to: f64, rate: f64| from + (to - from).clamp(-rate * PERIOD, rate * PERIOD);
        Inputs { n: reach(before.n, n, RATES[1]), delta: reach(before.delta, wanted, RATES[0]) }
    }
}
