//! A concealed case: its effects brought to the strength asked for, and the recordings with them.
//! It writes nothing; `seal` does.

use super::effects::effect::Class;
use super::error::ConcealError;
use super::sailing::recorded::{Recorded, activate, record};
use super::sailing::sail::Active;
use super::spec::{Background, Spec, Strength};
use super::strength::{Meter, solve};

/// A case, made and not yet written.
pub struct Case {
    /// The specification.
    pub spec: Spec,
    /// The effects at their sizes.
    pub effects: Vec<Active>,
    /// Signal-to-noise ratios reached, where they were measured.
    pub snr: Vec<Option<f64>>,
    /// The recordings.
    pub recorded: Recorded,
}

impl Case {
    /// Makes a case. `meter` is used only where a strength is given as a signal-to-noise ratio.
    ///
    /// # Errors
    /// [`ConcealError`] about the effects, their size, or the meter.
    pub fn make(spec: &Spec, meter: &dyn Meter) -> Result<Self, ConcealError> {
        let entries = spec.entries()?;
        let mut sizes = Vec::new();
        let mut snr = Vec::new();
        for (place, (entry, (_, strength))) in entries.iter().zip(&spec.effects).enumerate() {
            let (size, reached) = match *strength {
                Strength::Times(factor) => (entry.size * factor, None),
                Strength::Size(size) => (size, None),
                Strength::Snr(target) => {
                    let without = record(spec, Vec::new());
                    let with = |size: f64| record(spec, vec![activate(spec, entry, place, size)]);
                    let (size, snr) = solve(entry, target, |size| meter.snr(entry, &with(size), &without))?;
                    (size, Some(snr))
                }
            };
            if !(0.0..=entry.most).contains(&size) {
                return Err(ConcealError::Size { effect: entry.name, size, unit: entry.unit, most: entry.most });
            }
            sizes.push(size);
            snr.push(reached);
        }
        let active = || -> Vec<Active> {
            let each = entries.iter().zip(&sizes).enumerate();
            each.map(|(place, (entry, size))| activate(spec, entry, place, *size)).collect()
        };
        Ok(Self { spec: spec.clone(), effects: active(), snr, recorded: record(spec, active()) })
    }

    /// The right verdict of a diagnosis.
    pub fn expected(&self) -> &'static str {
        let is = |class: Class| self.effects.iter().any(|e| e.entry.class == class);
        if self.effects.is_empty() {
            return match self.spec.background {
                Background::Euler => "NUMERICS",
                Background::Gusts => "RANDOM",
                _ => "NOTHING MISSING",
            };
        }
        let alone = !self.spec.contrast;
        if is(Class::Withheld) {
            "NOT IN THE CATALOGUE"
        } else if is(Class::Absorbed) && alone {
            "ABSORBED"
        } else if !self.spec.design.can_tell() || (alone && self.effects.iter().any(|e| e.entry.reference)) {
            "ONE OF"
        } else if is(Class::Random) {
            "RANDOM"
        } else if self.effects.iter().all(|e| e.entry.class == Class::Sensor) {
            "SENSOR"
        } else {
            "NAMED"
        }
    }
}
