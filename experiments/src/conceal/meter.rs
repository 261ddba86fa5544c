//! The signal-to-noise ratio of an effect in the test of the diagnosis, with parameters, nuisances and noise projected out.
//! It is the one part of the generator that calls the library, and only for the size of an effect, never for its form.

use std::f64::consts::PI;
use std::path::Path;
use std::sync::Mutex;

use trimtab::diagnose::Settings;
use trimtab::model::Model;
use trimtab::recording::{Run, Split};
use trimtab::ship::Ship;
use trimtab::ship::state::Inputs;

use super::effects::effect::{Class, Entry};
use super::error::ConcealError;
use super::family::Family;
use super::sailing::recorded::Recorded;
use super::sailing::track::PERIOD;
use super::seal;
use super::signal::Signal;
use super::strength::{ForceMeter, Meter};

/// The ratio of the first accepted mechanism that has a test, on the runs to train on; of one force in their windows where effects
/// have windows. Effects without a test (gusts, those outside the catalogue) are graded by [`ForceMeter`].
pub struct DiagnosisMeter {
    model: Model,
    settings: Settings,
    /// The last runs without an effect and the signal fitted to them: the solver of sizes asks for one case several times.
    last: Mutex<Option<(Vec<Run>, Signal)>>,
}

impl DiagnosisMeter {
    /// A meter for the ship of this family and the base model of the concealed cases.
    ///
    /// # Errors
    /// [`ConcealError::Meter`] when the library refuses them.
    pub fn new(family: Family) -> Result<Self, ConcealError> {
        let fail = |e: &dyn std::fmt::Display| ConcealError::Meter { message: e.to_string() };
        let ship = Ship::parse(&seal::ship_file(family), Path::new("ship.toml")).map_err(|e| fail(&e))?;
        let model = Model::parse(seal::MODEL, Path::new("model.toml"), ship).map_err(|e| fail(&e))?;
        Ok(Self { model, settings: Settings::default(), last: Mutex::new(None) })
    }
}

impl Meter for DiagnosisMeter {
    fn snr(&self, effect: &Entry, with: &Recorded, without: &Recorded) -> Result<f64, ConcealError> {
        let force = || ForceMeter::default().snr(effect, with, without);
        if effect.class == Class::Random {
            return force();
        }
        // Both get the channels of the case: a model must see one sea.
        let (a, b) = (runs(without, with), runs(with, with));
        // The value is replaced as a whole, so that a panic elsewhere leaves none half written.
        let mut last = self.last.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if !last.as_ref().is_some_and(|(runs, _)| same(runs, &a)) {
            let signal = Signal::new(&self.model, &a, &self.settings)
                .map_err(|e| ConcealError::Meter { message: e.to_string() })?;
            *last = Some((a, signal));
        }
        let windows = windows(with);
        if let Some((_, signal)) = last.as_ref().filter(|_| !windows.is_empty()) {
            return Ok(signal.ratio_in(&b, &windows));
        }
        let ratio = |mechanism: &&str| last.as_ref().map_or(0.0, |(_, signal)| signal.ratio(&b, mechanism));
        // Some mechanisms have no sensitivity at their neutral values: a log without a current.
        effect.accepted.iter().map(ratio).find(|r| *r > 0.0).map_or_else(force, Ok)
    }
}

/// Windows of effects of limited duration: index among the runs to train on, first and last row.
fn windows(recorded: &Recorded) -> Vec<(usize, usize, usize)> {
    let train: Vec<usize> = (0..recorded.plans.len()).filter(|i| !recorded.plans[*i].test).collect();
    let row = |t: f64| (t / PERIOD).round().max(0.0) as usize;
    let place = |run: usize| train.iter().position(|i| *i == run);
    recorded.windows.iter().filter_map(|(run, start, end)| Some((place(*run)?, row(*start), row(*end)))).collect()
}

/// Whether two sets of runs have equal numbers, missing ones included.
fn same(a: &[Run], b: &[Run]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a.inputs == b.inputs && a.measured == b.measured)
}

/// The runs to train on as runs of the filter, with the environment channels of `sea`.
fn runs(recorded: &Recorded, sea: &Recorded) -> Vec<Run> {
    let train = (0..recorded.plans.len()).filter(|i| !recorded.plans[*i].test);
    train
        .map(|i| {
            let (plan, track) = (&recorded.plans[i], &recorded.tracks[i]);
            let channel = |name: &str, row: usize| {
                let (_, values) = sea.tracks[i].channels.iter().find(|(h, _)| h.split(' ').next() == Some(name))?;
                values.get(row).copied()
            };
            let inputs = track.orders.iter().enumerate().map(|(row, order)| {
                let mut at = Inputs::actuators(plan.clock + row as f64 * PERIOD, order.n, order.delta);
                // Speed and direction FROM become components of where it goes TO.
                let towards = |speed: &str, direction: &str| {
                    let (size, from) = (channel(speed, row)?, channel(direction, row)? + PI);
                    Some((size, [from.cos(), from.sin()]))
                };
                if let Some((speed, to)) = towards("wind_speed", "wind_direction") {
                    at.wind = to.map(|c| c * speed);
                }
                if let Some((height, to)) = towards("wave_height", "wave_direction") {
                    at.waves = to.map(|c| c * height * height);
                }
                if let (Some(starboard), Some(port)) = (channel("bank_starboard", row), channel("bank_port", row)) {
                    at.bank = 1.0 / starboard - 1.0 / port;
                }
                at.thruster = channel("thruster", row).unwrap_or_default();
                at
            });
            let rows = &recorded.rows[i];
            Run {
                name: plan.name.clone(),
                recording: plan.name.clone(),
                session: format!("day {}", plan.session + 1),
                manoeuvre: plan.manoeuvre.to_owned(),
                split: Split::Train,
                dt: PERIOD,
                recorded_dt: PERIOD,
                inputs: inputs.collect(),
                initial: rows.iter().flatten().next().copied().unwrap_or_default(),
                measured: rows.iter().map(|r| r.map_or([None; 6], |r| r.map(Some))).collect(),
                disturbed: Vec::new(),
                derived: [false; 6],
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conceal::case::Case;
    use crate::conceal::spec::{Spec, Strength};

    fn case(meter: &DiagnosisMeter, effect: &str, size: f64) -> Case {
        let effects = vec![(effect.to_owned(), Strength::Size(size))];
        Case::make(&Spec { effects, ..Spec::null(Family::Hd, 4) }, meter).unwrap()
    }

    #[test]
    fn a_stronger_effect_has_a_higher_ratio_and_no_effect_has_none() {
        let meter = DiagnosisMeter::new(Family::Hd).unwrap();
        let of = |size: f64| case(&meter, "heading_bias", size);
        let (none, weak, strong) = (of(0.0), of(0.002), of(0.004));
        let entry = weak.effects[0].entry;
        let ratio = |case: &Case| meter.snr(entry, &case.recorded, &none.recorded).unwrap();
        assert_eq!(ratio(&none), 0.0);
        assert!((ratio(&strong) / ratio(&weak) - 2.0).abs() < 0.1, "{} {}", ratio(&strong), ratio(&weak));
    }

    #[test]
    fn neither_equal_runs_nor_a_mechanism_outside_the_catalogue_have_a_ratio() {
        let meter = DiagnosisMeter::new(Family::Hd).unwrap();
        let none = case(&meter, "heading_bias", 0.0);
        let runs = runs(&none.recorded, &none.recorded);
        let signal = Signal::new(&meter.model, &runs, &meter.settings).unwrap();
        assert!(signal.ratio(&runs, "current") < 1e-9 && signal.ratio_in(&runs, &[(0, 20, 40)]) < 1e-9);
        assert_eq!(signal.ratio(&runs, "no such mechanism"), 0.0);
    }

    #[test]
    fn a_push_is_graded_in_its_windows_with_the_nuisances_projected_out() {
        let meter = DiagnosisMeter::new(Family::Hd).unwrap();
        let of = |size: f64| case(&meter, "push", size);
        let (none, weak, strong) = (of(0.0), of(4e3), of(8e3));
        let entry = weak.effects[0].entry;
        let ratio = |case: &Case| meter.snr(entry, &case.recorded, &none.recorded).unwrap();
        assert!((ratio(&strong) / ratio(&weak) - 2.0).abs() < 0.3, "{} {}", ratio(&strong), ratio(&weak));
        let unprojected = ForceMeter::default().snr(entry, &strong.recorded, &none.recorded).unwrap();
        assert!(ratio(&strong) < unprojected, "{} {unprojected}", ratio(&strong));
    }
}
