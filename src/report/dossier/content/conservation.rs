//! Conservation on a study's own inputs: impulse equals the change of momentum, and hull and resistance take energy out of the motion.
//! Both are of simulations in fine steps; how far a coarse step is from them is checked in `verification`.

use super::check::Check;
use crate::dynamics::Dynamics;
use crate::model::Model;
use crate::recording::{Run, or_nan};
use crate::simulate::{Integration, Method, driven, start, step};
use crate::state::{Force, STATES, State};
use rayon::prelude::*;

/// Steps in a sample period; even, for Simpson's rule.
const FINE: usize = 8;
/// Largest share of the impulse that may be lost: the error of Simpson's rule.
const LOST: f64 = 1e-4;

/// What is counted along a run.
#[derive(Clone, Copy, Debug, Default)]
struct Sum {
    /// Change of momentum less impulse, by equation \[N s; N m s\].
    residual: [f64; 3],
    /// Impulse of the size of the force.
    size: [f64; 3],
    /// Steps, and those in which hull and resistance drive the ship.
    steps: usize,
    driving: usize,
}

/// One instant of a fine simulation.
struct Sampled {
    velocity: [f64; 3],
    force: [f64; 3],
    /// Force that the change of momentum over ground has beside: of the current in turning axes.
    turning: [f64; 3],
    mass: crate::physics::Inertia<f64>,
    power: f64,
}

/// Momentum and energy.
pub(super) fn conservation(model: &Model, runs: &[Run]) -> Result<Vec<Check>, String> {
    let sums: Vec<Option<Sum>> = runs.par_iter().map(|run| along(model, run)).collect();
    let sums: Vec<Sum> = sums.into_iter().flatten().collect();
    if sums.is_empty() {
        return Err(
            "conservation: no run is simulated to its end, or the mass matrix changes with the motion (term `roll`)"
                .into(),
        );
    }
    let share = |s: &Sum| {
        let all = s.size.iter().fold(0.0, |a: f64, b| a.max(*b));
        let of = (0..3).filter(|e| s.size[*e] > 1e-9 * all).map(|e| s.residual[e].abs() / s.size[e]);
        of.fold(0.0, f64::max)
    };
    let lost = sums.iter().map(share).fold(0.0, f64::max);
    let (steps, driving) = sums.iter().fold((0, 0), |(a, b), s| (a + s.steps, b + s.driving));
    let momentum = "momentum: largest difference between mass times change of velocity and the time integral of the force, as a share of \
                    the integral of the force's size, over the equations of surge, sway and yaw";
    let energy =
        "energy: share of the simulated instants at which hull and resistance together add energy to the motion";
    Ok(vec![
        Check::most("momentum", momentum.into(), lost, "-", LOST, sums.len()),
        Check::most("energy", energy.into(), driving as f64 / steps.max(1) as f64, "-", 0.0, sums.len()),
    ])
}

/// The sums of one run; none where the simulation diverges or the mass matrix changes with the motion.
fn along(model: &Model, run: &Run) -> Option<Sum> {
    let dynamics = Dynamics::new(model, model.values_in(&run.session));
    let fine = Integration { method: Method::Rk4, substeps: FINE };
    let one = Integration { substeps: 1, ..fine };
    let series = driven(&dynamics, fine, run.dt, &run.inputs);
    let known = run.channels().map(|m| f64::from(u8::from(m)));
    let mut state = start(&dynamics, series.first()?, &run.initial, &known);
    let h = run.dt / FINE as f64;
    let mut sum = Sum::default();
    let count = (run.inputs.len() - 1) * FINE;
    let mut last: Vec<Sampled> = Vec::with_capacity(3);
    for i in 0..=count {
        last.push(sampled(&dynamics, &state, &series[2 * i])?);
        if let [a, b, c] = last.as_slice() {
            sum.add([a, b, c], h);
            last.drain(..2);
        }
        if i < count {
            state = step(&dynamics, one, h, &state, &series[2 * i..], &Force::zero());
        }
    }
    sum.residual.iter().all(|r| r.is_finite()).then_some(sum)
}

fn sampled(dynamics: &Dynamics<f64>, state: &[f64; STATES], inputs: &crate::state::Inputs<f64>) -> Option<Sampled> {
    if !or_nan(&state.map(Some)).iter().all(|v| v.is_finite()) {
        return None;
    }
    let state = State::from_array(*state);
    let at = dynamics.instant(&state, inputs);
    let flow = dynamics.flow(&at);
    if flow.adjust.roll.is_some() {
        return None;
    }
    let mass = dynamics.inertia(&flow);
    let [along, across] = flow.current;
    // Of the forms of the hull all but that of the model are zero.
    let hull = ["hull", "mmg_hull", "general_hull", "resistance"];
    let all = dynamics.contributions(&state, inputs);
    let power = |(_, f): &(_, Force<f64>)| f.x * flow.u + f.y * flow.v + f.n * flow.r;
    let power = all.iter().filter(|(name, _)| hull.contains(name)).map(power).sum();
    Some(Sampled {
        velocity: [state.u, state.v, state.r],
        force: dynamics.force(&at, &flow).to_array(),
        turning: mass.force(&[across * state.r, -along * state.r, 0.0]).to_array(),
        mass,
        power,
    })
}

impl Sum {
    /// Adds two steps of length `h` \[s\] by Simpson's rule.
    fn add(&mut self, [a, b, c]: [&Sampled; 3], h: f64) {
        let change: [f64; 3] = std::array::from_fn(|e| c.velocity[e] - a.velocity[e]);
        let momentum = a.mass.force(&change).to_array();
        let integral = |f: &dyn Fn(&Sampled) -> f64| h / 3.0 * (f(a) + 4.0 * f(b) + f(c));
        for e in 0..3 {
            self.residual[e] += momentum[e] - integral(&|m| m.force[e] + m.turning[e]);
            self.size[e] += integral(&|m| m.force[e].abs());
        }
        self.steps += 1;
        self.driving += usize::from(a.power > 0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::Form;
    use crate::recording::Split;
    use crate::ship::Ship;
    use crate::state::Inputs;
    use std::path::Path;

    /// A turn of ship A with a linear resistance \[N s/m\].
    fn turn(resistance: f64) -> Vec<Check> {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments/ships/a.toml");
        let mut model = Model::new(Ship::read(&path).unwrap(), "A", Form::Regular, &[]).unwrap();
        model.set_eleven(&[-0.017, 34187.0, -12568.0, 1594.0, -0.039, 3.193, 0.205, -4.882, 0.048, 0.0746, 1.370]);
        let linear = model.find("resistance.linear").unwrap();
        model.parameters[linear].value = resistance;
        let inputs: Vec<_> = (0..=40).map(|k| Inputs::actuators(5.0 * f64::from(k), 2.0, 0.3)).collect();
        let run = Run {
            name: "run".into(),
            recording: "run".into(),
            session: String::new(),
            manoeuvre: String::new(),
            split: Split::Test,
            dt: 5.0,
            recorded_dt: 5.0,
            measured: vec![[Some(0.0); STATES]; inputs.len()],
            inputs,
            initial: [0.0, 0.0, 0.3, 4.0, 0.0, 0.0],
            disturbed: Vec::new(),
            derived: [false; STATES],
        };
        conservation(&model, &[run]).unwrap()
    }

    #[test]
    fn impulse_is_kept_and_a_hull_that_is_driven_by_its_resistance_is_reported() {
        let [momentum, energy] = turn(34187.0).try_into().unwrap();
        assert!(momentum.passed && momentum.number < 1e-4, "{momentum:?}");
        assert!(energy.passed && energy.number == 0.0, "{energy:?}");
        let [momentum, energy] = turn(-40_000.0).try_into().unwrap();
        assert!(momentum.passed, "{momentum:?}");
        assert!(!energy.passed && energy.number > 0.0, "{energy:?}");
    }
}
