//! Latitudes and longitudes of columns as metres: degrees, radians or degrees and minutes, without what is no fix.
//! Which columns they are is chosen elsewhere, and no axis is turned here.

use super::geodesy::{from_minutes, sailed};
use super::log::Column;
use super::signal::{Signal, Tidied, size_below};
use crate::recording::import::error::ImportError;

/// Positions of a ship.
pub struct Places {
    /// Metres north of the point.
    pub x: Signal,
    /// Metres east of the point.
    pub y: Signal,
    /// Latitude and longitude of the point \[deg\].
    pub origin: [f64; 2],
    /// Latitude and longitude as they were recorded.
    pub told: [Signal; 2],
    /// What was put in order among the latitudes.
    pub tidied: Tidied,
    /// How they are written.
    pub form: &'static str,
    /// Positions at 0 N 0 E.
    pub nowhere: usize,
}

/// Positions from the columns of latitude and longitude; `None` where no time has both.
///
/// # Errors
/// [`ImportError::Choice`] for numbers that are no latitude or longitude.
pub fn places(lat: &[&Column], lon: &[&Column], radians: bool) -> Result<Option<Places>, ImportError> {
    let (columns, minutes) = degrees([lat, lon], if radians { 1f64.to_degrees() } else { 1.0 })?;
    let [latitudes, longitudes] = columns;
    let (lat_signal, tidied) = Signal::new(&[&latitudes], 1.0, 0.0, false);
    let (lon_signal, _) = Signal::new(&[&longitudes], 1f64.to_radians(), 0.0, true);
    let mut places: Vec<[f64; 3]> = Vec::new();
    let mut nowhere = 0;
    for (t, latitude) in lat_signal.t.iter().zip(&lat_signal.v) {
        let longitude = lon_signal.at(*t, lat_signal.step).to_degrees();
        if latitude.abs() < 1e-9 && longitude.abs() < 1e-9 {
            nowhere += 1;
        } else if longitude.is_finite() {
            places.push([*t, *latitude, longitude]);
        }
    }
    let column = |k: usize| places.iter().map(|p| p[k]).collect::<Vec<f64>>();
    let Some(sailed) = sailed(&column(1), &column(2)) else { return Ok(None) };
    let axis = |axis: usize| Signal {
        t: column(0),
        v: sailed.metres.iter().map(|m| m[axis]).collect(),
        ..lat_signal.without_samples()
    };
    let form = match (minutes, radians) {
        (true, _) => "deg and minutes (dddmm.mmm)",
        (_, true) => "rad",
        _ => "deg",
    };
    let (x, y) = (axis(0), axis(1));
    let told = [lat_signal, lon_signal];
    Ok(Some(Places { x, y, origin: sailed.origin, told, tidied, form, nowhere }))
}

/// Latitudes and longitudes in degrees, of which one value is `unit`, and whether they were written as degrees and minutes. Single
/// values that are none are left out.
fn degrees(both: [&[&Column]; 2], unit: f64) -> Result<([Column; 2], bool), ImportError> {
    let usual = |columns: &[&Column]| columns.iter().map(|c| size_below(&c.v, 0.5)).fold(0.0, f64::max);
    let in_minutes = usual(both[0]) > 90.0;
    let mut found = [Column::default(), Column::default()];
    for (i, columns) in both.iter().enumerate() {
        let most = [90.0, 360.0][i];
        let (mut wrong, mut count) = (None, 0);
        for (t, v) in columns.iter().flat_map(|c| c.t.iter().zip(&c.v)) {
            let degrees = if in_minutes { from_minutes(*v).unwrap_or(f64::NAN) } else { unit * *v };
            if degrees.abs() <= most {
                found[i].push(*t, degrees);
            } else {
                (wrong, count) = (Some(*v), count + 1);
            }
        }
        if let Some(wrong) = wrong.filter(|_| count > found[i].v.len() / 20) {
            let name = columns.first().map_or("", |c| c.name.as_str());
            let (words, channel) = (["latitude", "longitude"][i], ["x", "y"][i]);
            let text = format!(
                "column `{name}` contains {wrong}, which is no {words} in deg; is it metres? then pass `--column {channel}={name}`"
            );
            return Err(ImportError::Choice(text));
        }
    }
    Ok((found, in_minutes))
}
