//! The inputs of a simulation from a dictionary or a table of columns, checked for shape, unit and time.
//! It simulates nothing.

use crate::convert::vector;
use pyo3::exceptions::{PyKeyError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use trimtab::files::suggestion;
use trimtab::recording::{CHANNELS, Channel, Driven, Quantity};
use trimtab::ship::state::{Inputs, STATE_NAMES, STATE_UNITS, STATES};

/// Columns beside those that a recording has as they are: name, smallest and largest value, unit and meaning.
const AROUND: [(&str, [f64; 2], &str); 8] = [
    ("wind_north", [-100.0, 100.0], "true wind in m/s towards north"),
    ("wind_east", [-100.0, 100.0], "true wind in m/s towards east"),
    ("current_north", [-10.0, 10.0], "current in m/s towards north"),
    ("current_east", [-10.0, 10.0], "current in m/s towards east"),
    ("waves_north", [-1000.0, 1000.0], "H_s^2 in m2 times the north component of where waves travel to"),
    ("waves_east", [-1000.0, 1000.0], "H_s^2 in m2 times the east component of where waves travel to"),
    ("draught_to_depth", [0.0, 1.0], "draught over water depth, 0 in deep water"),
    ("bank", [-10.0, 10.0], "1/y_starboard - 1/y_port in 1/m, 0 in open water"),
];

/// Names of the inputs of a craft with the limits and the meaning of each.
fn known(driven: &Driven) -> Vec<(&'static str, [f64; 2], String)> {
    let mut blank: Inputs<f64> = Inputs::actuators(0.0, 0.0, 0.0);
    let recorded = blank.recorded().filter_map(|(name, _)| Channel::from_name(name));
    let of = |channel: Channel| {
        let info = channel.info();
        let unit = match (channel, info.quantity) {
            (Channel::Thruster, _) => ", from -1 to 1",
            (_, Quantity::Rotation) => ", in revolutions per second: divide rpm by 60",
            (_, Quantity::Angle) => ", in rad: numpy.radians converts degrees",
            (_, Quantity::Force) => ", in N",
            (_, Quantity::Moment) => ", in N m",
            _ => "",
        };
        (info.name, [info.limits.0, info.limits.1], format!("{}{unit}", info.doc))
    };
    let around = AROUND.iter().map(|(name, limits, about)| (*name, *limits, (*about).to_owned()));
    recorded.chain(driven.commands.iter().copied()).map(of).chain(around).collect()
}

/// What the entry of an input is.
fn entry<'a>(inputs: &'a mut Inputs<f64>, name: &str, driven: &Driven) -> Option<&'a mut f64> {
    if let Some(command) = driven.commands.iter().position(|channel| channel.name() == name) {
        return inputs.commands.get_mut(command);
    }
    match name {
        "wind_north" => Some(&mut inputs.wind[0]),
        "wind_east" => Some(&mut inputs.wind[1]),
        "current_north" => Some(&mut inputs.current[0]),
        "current_east" => Some(&mut inputs.current[1]),
        "waves_north" => Some(&mut inputs.waves[0]),
        "waves_east" => Some(&mut inputs.waves[1]),
        "draught_to_depth" => Some(&mut inputs.draught_to_depth),
        "bank" => Some(&mut inputs.bank),
        _ => inputs.recorded().find(|(own, _)| *own == name).map(|(_, value)| value),
    }
}

/// The sample period and the inputs of a craft at every sample.
pub fn inputs(given: &Bound<'_, PyAny>, dt: Option<f64>, driven: &Driven) -> PyResult<(f64, Vec<Inputs<f64>>)> {
    let names: Vec<String> = match given.call_method0("keys") {
        Ok(keys) => keys.try_iter()?.map(|key| key?.extract()).collect::<PyResult<_>>()?,
        Err(_) => {
            return Err(PyTypeError::new_err(
                "inputs: expected a dictionary or a table with columns, such as {\"n\": 2.0, \"delta\": delta} with the propeller rate \
                 [1/s] and the rudder angle [rad] at every sample",
            ));
        }
    };
    let known = known(driven);
    let mut columns: Vec<(String, Vec<f64>)> = Vec::new();
    for name in names {
        if name != "t" && !known.iter().any(|(own, ..)| *own == name) {
            let all: Vec<&str> = std::iter::once("t").chain(known.iter().map(|(own, ..)| *own)).collect();
            let near = suggestion(&name, all.iter().copied());
            return Err(PyKeyError::new_err(format!(
                "unknown input `{name}`{near}; the inputs are {}",
                all.join(", ")
            )));
        }
        let value = given.get_item(&name)?;
        let values = match value.extract::<f64>() {
            Ok(constant) => vec![constant],
            Err(_) => vector(&format!("inputs[\"{name}\"]"), &value)?,
        };
        columns.push((name, values));
    }
    complete(&columns, driven)?;
    let samples = columns.iter().map(|(_, v)| v.len()).max().unwrap_or(0);
    if samples < 2 {
        return Err(PyValueError::new_err(
            "inputs: give at least one column with a value for each of two samples or more, such as \"delta\"; a single number stands \
             for all samples",
        ));
    }
    for (name, values) in &columns {
        checked(name, values, samples, &known)?;
    }
    let times = columns.iter().find(|(name, _)| name == "t").map(|(_, values)| values.as_slice());
    let dt = step(times, dt)?;
    let start = times.map_or(0.0, |t| t[0]);
    let at = |k: usize| {
        let mut one = Inputs::actuators(start + dt * k as f64, 0.0, 0.0);
        for (name, values) in &columns {
            if let Some(place) = entry(&mut one, name, driven) {
                *place = values[k.min(values.len() - 1)];
            }
        }
        one
    };
    Ok((dt, (0..samples).map(at).collect()))
}

/// Whether each actuator has its channels: one that is left out would be simulated as one that stands still.
fn complete(columns: &[(String, Vec<f64>)], driven: &Driven) -> PyResult<()> {
    let has = |channel: &Channel| columns.iter().any(|(name, _)| name == channel.name());
    let missing: Vec<Channel> = driven.needs().filter(|channel| !has(channel)).collect();
    if missing.is_empty() {
        return Ok(());
    }
    let each = |of: &dyn Fn(Channel) -> String| missing.iter().map(|channel| of(*channel)).collect::<Vec<_>>();
    let absent = each(&|channel| format!("no `{}` ({})", channel.name(), channel.info().words)).join(" and ");
    let still = each(&|channel| format!("\"{}\": 0.0", channel.name())).join(", ");
    Err(PyValueError::new_err(format!(
        "inputs: there is {absent}; give a value for every sample or one number for all of them, as in {still} for what stands still"
    )))
}

/// Whether a column has a value in its range for every sample.
fn checked(name: &str, values: &[f64], samples: usize, known: &[(&'static str, [f64; 2], String)]) -> PyResult<()> {
    let bad = |words: String| Err(PyValueError::new_err(words));
    if values.len() != samples && (values.len() != 1 || name == "t") {
        return bad(format!(
            "inputs[\"{name}\"] has {} values, and another input has {samples}; give each as many as there are samples, or one number",
            values.len()
        ));
    }
    if let Some(k) = values.iter().position(|v| !v.is_finite()) {
        return bad(format!(
            "inputs[\"{name}\"][{k}] = {} is not a finite number; fill the gap, or cut the series there",
            values[k]
        ));
    }
    let Some((_, [low, high], about)) = known.iter().find(|(own, ..)| *own == name) else { return Ok(()) };
    match values.iter().position(|v| !(*low..=*high).contains(v)) {
        Some(k) => {
            bad(format!("inputs[\"{name}\"][{k}] = {} is outside {low} to {high}; it is the {about}", values[k]))
        }
        None => Ok(()),
    }
}

/// The sample period from the times or as given.
fn step(times: Option<&[f64]>, dt: Option<f64>) -> PyResult<f64> {
    let from_times = times.map(|t| (t[t.len() - 1] - t[0]) / (t.len() - 1) as f64);
    let Some(step) = from_times.or(dt) else {
        return Err(PyValueError::new_err(
            "give the sample period `dt` [s], or a column \"t\" of times [s] in the inputs",
        ));
    };
    if !(step.is_finite() && step > 0.0) {
        return Err(PyValueError::new_err(format!(
            "a sample period of {step} s: it must be above 0, with times that increase"
        )));
    }
    if let Some((own, given)) = from_times.zip(dt).filter(|(own, given)| (own - given).abs() > 1e-6 * own) {
        return Err(PyValueError::new_err(format!(
            "dt = {given} s, and the times of \"t\" are {own} s apart; leave out one"
        )));
    }
    let uneven = times.and_then(|t| t.windows(2).position(|pair| ((pair[1] - pair[0]) - step).abs() > 1e-3 * step));
    match uneven {
        Some(k) => Err(PyValueError::new_err(format!(
            "inputs[\"t\"]: the step after sample {k} is not the {step} s of the others; interpolate the inputs on equal steps first \
             (numpy.interp)"
        ))),
        None => Ok(step),
    }
}

/// An initial state `[x, y, psi, u, v, r]`, checked for its units.
pub fn state(given: &Bound<'_, PyAny>) -> PyResult<[f64; STATES]> {
    let names: Vec<String> =
        STATE_NAMES.iter().zip(STATE_UNITS).map(|(name, unit)| format!("{name} [{unit}]")).collect();
    let values = crate::convert::finite("initial_state", given, &names)?;
    for (i, (value, name)) in values.iter().zip(STATE_NAMES).enumerate() {
        let Some(info) = CHANNELS.iter().find(|c| c.name == name) else { continue };
        if !(info.limits.0..=info.limits.1).contains(value) {
            return Err(PyValueError::new_err(format!(
                "initial_state[{i}] = {value} is outside {} to {}; it is the {}, in {}",
                info.limits.0, info.limits.1, info.doc, STATE_UNITS[i]
            )));
        }
    }
    Ok(std::array::from_fn(|i| values[i]))
}
