//! The data sets of ships A and B: seeded port approaches, departures and sea passages sailed by a helmsman on a truth simulator.
//! It draws plans and records runs; the manoeuvres are in `programme`, the physics is the simulator's, and no noise is added.
//!
//! The paper prints no time step. Here a manoeuvre is 120 steps of 2 s for ship A and of 3 s for ship B, recorded in 121 rows:
//! 240 s and 360 s, some 10 ship lengths at the mean speed of either ship. Orders are given at the rows and the actuators move in
//! a straight line from row to row, so that inputs interpolated linearly between rows are exactly those that moved the ship.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::helmsman::{Helmsman, Leg, Phase, Style};
use super::integrate::{MAX_STEP, sail, trimmed_rate};
use super::motion::{Inputs, State};
use super::programme::{Draw, Service, Sketch, manoeuvre, service};
use super::ships::ShipId;
use super::simulator::Truth;

/// Steps of a recorded manoeuvre: 120 intervals, 121 rows.
pub const STEPS: usize = 120;
/// The seed of the data sets behind the figures, fixed before any result was known.
pub const SEED: u64 = 20_250_226;
/// Which part of the data a run belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Split {
    /// Fitted to.
    Train,
    /// Held out, 12.5 % of the runs.
    Test,
}

/// A recorded manoeuvre.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Name, unique in its data set: `ship_a_017`.
    pub name: String,
    /// Train or test.
    pub split: Split,
    /// The kind of manoeuvre.
    pub manoeuvre: &'static str,
    /// Time from the first row \[s\].
    pub t: Vec<f64>,
    /// `[x, y, psi, u, v, r]` of each row, SI.
    pub state: Vec<[f64; 6]>,
    /// Propeller rate \[rps\].
    pub n: Vec<f64>,
    /// Rudder angle \[rad\].
    pub delta: Vec<f64>,
}

/// The plan of a run, as a helmsman is given it.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// Name of the run.
    pub name: String,
    /// Train or test.
    pub split: Split,
    /// The kind of manoeuvre.
    pub manoeuvre: &'static str,
    /// Speed ahead at which the lead-in begins \[m/s\].
    pub speed: f64,
    /// Heading there \[rad\].
    pub heading: f64,
    /// Time sailed before the first row, so that the recording begins under way \[s\].
    pub lead: f64,
    /// Telegraph and helm.
    pub phases: Vec<Phase>,
    /// The route, for those phases that follow it.
    pub legs: Vec<Leg>,
    /// The helmsman's style.
    pub style: Style,
}

/// The sample period of the recordings of a ship \[s\].
pub fn period(ship: ShipId) -> f64 {
    service(ship).period
}

/// The data set of a ship: its truth simulator in calm water, sailed on [`plans`].
pub fn dataset(ship: ShipId, seed: u64) -> Vec<Run> {
    let truth = ship.truth();
    plans(ship, seed).iter().map(|plan| record(truth.as_ref(), ship, plan)).collect()
}

/// The plans of a data set, 12.5 % of them drawn for the test: 21 of 165 for ship A, 13 of 100 for ship B.
///
/// Each run draws from a stream of its own, and so does the split: a change to one run leaves the others unchanged.
pub fn plans(ship: ShipId, seed: u64) -> Vec<Plan> {
    let service = service(ship);
    let first_stream = match ship {
        ShipId::A => 0,
        ShipId::B => 1 << 32,
    };
    let stream = |i: usize| {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        rng.set_stream(first_stream + i as u64);
        rng
    };
    let splits = split(service.runs, &mut stream(0));
    let of_run = |(i, split): (usize, Split)| {
        let mut draw = Draw { rng: stream(i + 1) };
        let sketch: Sketch = manoeuvre(&service, (i as f64 + 0.5) / service.runs as f64)(&mut draw);
        Plan {
            name: format!("{}_{:03}", ship.name(), i + 1),
            split,
            manoeuvre: sketch.manoeuvre,
            speed: sketch.speed,
            heading: draw.between(0.0, 2.0 * std::f64::consts::PI),
            lead: service.period * draw.between(10.0, 25.0).round(),
            phases: sketch.phases,
            legs: sketch.legs,
            style: Style {
                gain: draw.between(1.0, 2.0),
                counter: draw.between(0.8, 1.5),
                limit: draw.between(15.0, 30.0).to_radians(),
                stop: match ship {
                    ShipId::A => 35.0_f64.to_radians(),
                    ShipId::B => 40.0_f64.to_radians(),
                },
            },
        }
    };
    splits.into_iter().enumerate().map(of_run).collect()
}

/// A random eighth of the runs (rounded) for the test, by Fisher and Yates.
fn split(runs: usize, rng: &mut ChaCha8Rng) -> Vec<Split> {
    let mut order: Vec<usize> = (0..runs).collect();
    for i in (1..runs).rev() {
        order.swap(i, rng.random_range(0..=i));
    }
    let mut splits = vec![Split::Train; runs];
    for &i in &order[..(0.125 * runs as f64).round() as usize] {
        splits[i] = Split::Test;
    }
    splits
}

/// Sails a plan and records it.
pub fn record(truth: &dyn Truth, ship: ShipId, plan: &Plan) -> Run {
    let Service { period, actuators, .. } = service(ship);
    let mut state = State { psi: plan.heading, u: plan.speed, ..State::default() };
    // The run begins at the rate that keeps the speed, or with the engine stopped.
    let mut inputs =
        Inputs { n: if plan.speed > 1.0 { trimmed_rate(truth, plan.speed, 6.0) } else { 0.0 }, delta: 0.0 };
    let lead = (plan.lead / period).round() as i64;
    let length = truth.particulars().length;
    let mut helmsman = Helmsman::new(&plan.phases, &plan.legs, plan.style, length, -plan.lead, &state);
    let mut run = Run {
        name: plan.name.clone(),
        split: plan.split,
        manoeuvre: plan.manoeuvre,
        t: Vec::with_capacity(STEPS + 1),
        state: Vec::with_capacity(STEPS + 1),
        n: Vec::with_capacity(STEPS + 1),
        delta: Vec::with_capacity(STEPS + 1),
    };
    for i in -lead..=STEPS as i64 {
        let t = i as f64 * period;
        if i >= 0 {
            run.t.push(t);
            run.state.push(state.to_array());
            run.n.push(inputs.n);
            run.delta.push(inputs.delta);
        }
        let next = actuators.follow(&inputs, &helmsman.order(t, &state), period);
        state = sail(truth, &state, [&inputs, &next], period, MAX_STEP);
        inputs = next;
    }
    run
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHIPS: [ShipId; 2] = [ShipId::A, ShipId::B];

    #[test]
    fn data_sets_have_the_paper_s_size_and_an_eighth_of_test_runs() {
        for (ship, runs, tests) in [(ShipId::A, 165, 21), (ShipId::B, 100, 13)] {
            let plans = plans(ship, 7);
            assert_eq!(plans.len(), runs);
            assert_eq!(plans.iter().filter(|plan| plan.split == Split::Test).count(), tests);
        }
    }

    #[test]
    fn same_seed_gives_the_same_bits_and_another_seed_other_runs() {
        let plans = plans(ShipId::A, 3);
        let truth = ShipId::A.truth();
        let sail = |plan: &Plan| record(truth.as_ref(), ShipId::A, plan);
        for plan in plans.iter().step_by(40) {
            assert_eq!(sail(plan), sail(plan));
        }
        assert_eq!(plans, super::plans(ShipId::A, 3));
        assert_ne!(plans, super::plans(ShipId::A, 4));
    }

    #[test]
    fn every_row_is_finite_and_every_run_has_120_steps() {
        for ship in SHIPS {
            for run in dataset(ship, 11) {
                assert_eq!([run.t.len(), run.state.len(), run.n.len(), run.delta.len()], [STEPS + 1; 4]);
                assert!(run.t[0] == 0.0 && (run.t[STEPS] - STEPS as f64 * period(ship)).abs() < 1e-9);
                let inputs = run.n.iter().chain(&run.delta);
                assert!(run.state.iter().flatten().chain(inputs).all(|x| x.is_finite()), "{}", run.name);
            }
        }
    }

    #[test]
    fn the_recorded_inputs_reproduce_the_recorded_motion() {
        // Simulated again from the first row with the recorded inputs, linear between rows.
        let ship = ShipId::B;
        let truth = ship.truth();
        for plan in plans(ship, 5).iter().step_by(17) {
            let run = record(truth.as_ref(), ship, plan);
            let mut state = State::from_array(run.state[0]);
            let inputs = |i: usize| Inputs { n: run.n[i], delta: run.delta[i] };
            for i in 0..STEPS {
                state = sail(truth.as_ref(), &state, [&inputs(i), &inputs(i + 1)], period(ship), MAX_STEP);
            }
            assert_eq!(state.to_array(), run.state[STEPS]);
        }
    }
}
