//! Which of two columns of one actuator is the order: it leaps, and the other follows it.
//! Names are compared elsewhere, and a rudder angle that was recorded alone is examined by the audit.

use crate::recording::import::signals::log::Column;
use crate::recording::import::signals::signal::{Signal, median, size_below};

/// Samples in which the two are apart that a decision needs: a steering gear takes some to turn through one order.
const FEWEST: usize = 10;
/// The two are apart where they differ by this share of their range: above the noise of an angle and the rounding of an order.
const APART: f64 = 0.2;
/// A feedback that is apart from its order goes towards it in this share of all its way, the rest being noise, ...
const TOWARDS: f64 = 0.5;
/// ... this many times as far as the order comes to meet it, ...
const FURTHER: f64 = 2.0;
/// ... in steps that are smaller by this factor: a leap is made in one step, a rudder of 2 to 5 deg/s takes several.
const FASTER: f64 = 1.5;

/// Whether the second leads the first in time and leaps faster, so that it is the order of which the first is the feedback. What is sampled
/// too slowly to show a lag decides nothing.
pub fn follows(feedback: &[&Column], order: &[&Column]) -> bool {
    let [feedback, order] = [feedback, order].map(|columns| Signal::new(columns, 1.0, 0.0, false).0);
    let scale = size_below(&feedback.v, 0.95) / size_below(&order.v, 0.95);
    let both: Vec<[f64; 2]> =
        feedback.t.iter().zip(&feedback.v).map(|(t, v)| [*v, scale * order.at(*t, feedback.step)]).collect();
    let Some(middle) = median(feedback.v.clone()) else { return false };
    let range = size_below(&feedback.v.iter().map(|v| v - middle).collect::<Vec<f64>>(), 0.95);
    // The way of each in all, weighted with itself, and where they are apart: how often, how far in all, and towards the other.
    let (mut way, mut squares, mut apart, mut gone, mut towards) = ([0.0; 2], [0.0; 2], 0, 0.0, [0.0; 2]);
    for pair in both.windows(2).filter(|pair| pair[0][1].is_finite() && pair[1][1].is_finite()) {
        let steps = [pair[1][0] - pair[0][0], pair[1][1] - pair[0][1]];
        for (i, step) in steps.iter().enumerate() {
            way[i] += step.abs();
            squares[i] += step * step;
        }
        let difference = pair[0][1] - pair[0][0];
        if difference.abs() > APART * range {
            apart += 1;
            gone += steps[0].abs();
            towards[0] += steps[0] * difference.signum();
            towards[1] -= steps[1] * difference.signum();
        }
    }
    let leads = apart >= FEWEST && towards[0] > TOWARDS * gone && towards[0] > FURTHER * towards[1].max(0.0);
    // Usual steps where they move.
    leads && squares[1] * way[0] > FASTER * squares[0] * way[1]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An order that leaps to both sides, and what follows it at so many deg in a row.
    fn steered(rate: f64) -> [Column; 2] {
        let (mut columns, mut angle) = ([Column::default(), Column::default()], 0.0_f64);
        for i in 0..400 {
            let order = [0.0, 20.0, -20.0, 10.0][i / 40 % 4];
            angle += (order - angle).clamp(-rate, rate);
            let noise = 0.1 * (1.7 * i as f64).sin();
            columns[0].push(i as f64, angle + noise);
            columns[1].push(i as f64, order);
        }
        columns
    }

    #[test]
    fn what_leaps_is_the_order_of_what_follows_it() {
        let [angle, order] = steered(2.5);
        assert!(follows(&[&angle], &[&order]) && !follows(&[&order], &[&angle]));
        // The same in radians.
        let radians = Column { v: order.v.iter().map(|v| v.to_radians()).collect(), ..order.clone() };
        assert!(follows(&[&angle], &[&radians]) && !follows(&[&radians], &[&angle]));
    }

    #[test]
    fn two_feedbacks_are_no_order_of_one_another() {
        let [angle, order] = steered(2.5);
        let rounded = Column { v: angle.v.iter().map(|v| v.round()).collect(), ..angle.clone() };
        let mirrored = Column { v: angle.v.iter().map(|v| 0.3 - v).collect(), ..angle.clone() };
        for other in [&angle, &rounded, &mirrored] {
            assert!(!follows(&[&angle], &[other]) && !follows(&[other], &[&angle]));
        }
        // A gear that is there at the next sample shows no lag.
        let fast = steered(100.0);
        assert!(!follows(&[&fast[0]], &[&order]) && !follows(&[&order], &[&fast[0]]));
    }
}
