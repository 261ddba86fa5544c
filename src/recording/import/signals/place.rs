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
    pub recorded: [Signal; 2],
    /// What was put in order among the latitudes.
    pub tidied: Tidied,
    /// How they are written.
    pub form: &'static str,
    /// Positions at 0 N 0 E.
    pub nowhere: usize,
}

/// Positions from the columns of latitude and longitude with the units that are stated \[rad\]; `None` where no time has both.
///
/// # Errors
/// [`ImportError::Choice`] for numbers that are no latitude or longitude.
pub fn places(lat: &[&Column], lon: &[&Column], units: [Option<f64>; 2]) -> Result<Option<Places>, ImportError> {
    let form = Form::of([lat, lon], units);
    let [latitudes, longitudes] = degrees([lat, lon], form)?;
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
    let (x, y) = (axis(0), axis(1));
    let recorded = [lat_signal, lon_signal];
    Ok(Some(Places { x, y, origin: sailed.origin, recorded, tidied, form: form.words(), nowhere }))
}

/// How latitudes and longitudes are written.
#[derive(Clone, Copy, PartialEq)]
enum Form {
    Degrees,
    Radians,
    /// Minutes of arc.
    Minutes,
    /// Degrees and minutes in one number.
    DegreesMinutes,
    /// Degrees, minutes and seconds in one number.
    DegreesMinutesSeconds,
    /// Whole ten-millionths of a degree, as autopilots and receivers send them.
    TenMillionths,
}

impl Form {
    /// As the units say; by their size where these are degrees or none.
    fn of(both: [&[&Column]; 2], units: [Option<f64>; 2]) -> Self {
        let usual = |columns: &[&Column]| columns.iter().map(|c| size_below(&c.v, 0.5)).fold(0.0, f64::max);
        let whole = || both.iter().all(|columns| columns.iter().flat_map(|c| &c.v).all(|v| v.fract() == 0.0));
        let both_are = |factor: f64| units.iter().all(|unit| unit.is_some_and(|u| (u / factor - 1.0).abs() < 1e-9));
        match usual(both[0]) {
            _ if both_are(1.0) => Self::Radians,
            _ if both_are(1f64.to_radians() / 60.0) => Self::Minutes,
            // Degrees and minutes reach 9000 in latitude and 18000 in longitude.
            latitude if latitude.max(usual(both[1])) > 20_000.0 && whole() => Self::TenMillionths,
            // The same in seconds reach a hundred times as many.
            latitude if latitude > 9000.0 => Self::DegreesMinutesSeconds,
            latitude if latitude > 90.0 => Self::DegreesMinutes,
            _ => Self::Degrees,
        }
    }

    fn words(self) -> &'static str {
        match self {
            Self::Degrees => "deg",
            Self::Radians => "rad",
            Self::Minutes => "min of arc",
            Self::DegreesMinutes => "deg and minutes (dddmm.mmm)",
            Self::DegreesMinutesSeconds => "deg, minutes and seconds (dddmmss.ss)",
            Self::TenMillionths => "1e-7 deg",
        }
    }

    fn degrees(self, v: f64) -> f64 {
        match self {
            Self::Degrees => v,
            Self::Radians => v.to_degrees(),
            Self::Minutes => v / 60.0,
            Self::DegreesMinutes => from_minutes(v).unwrap_or(f64::NAN),
            Self::DegreesMinutesSeconds => {
                let minutes = (v.abs() / 100.0).floor() + v.abs() % 100.0 / 60.0;
                // Seconds may be rounded to 60.
                if v.abs() % 100.0 <= 60.0 { from_minutes(minutes.copysign(v)).unwrap_or(f64::NAN) } else { f64::NAN }
            }
            Self::TenMillionths => v * 1e-7,
        }
    }
}

/// Latitudes and longitudes in degrees. Single values that are none are left out.
fn degrees(both: [&[&Column]; 2], form: Form) -> Result<[Column; 2], ImportError> {
    let mut found = [Column::default(), Column::default()];
    for (i, columns) in both.iter().enumerate() {
        let most = [90.0, 360.0][i];
        let (mut wrong, mut count) = (None, 0);
        for (t, v) in columns.iter().flat_map(|c| c.t.iter().zip(&c.v)) {
            let degrees = form.degrees(*v);
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
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_the_same_in_every_way_it_is_written() {
        let minute = Some(1f64.to_radians() / 60.0);
        let cases = [
            (54.18, -7.45, None, "deg"),
            (5410.8, -727.0, None, "deg and minutes (dddmm.mmm)"),
            (541_048.2, -72_700.2, None, "deg, minutes and seconds (dddmmss.ss)"),
            (3250.8, -447.0, minute, "min of arc"),
            (541_800_000.0, -74_500_000.0, None, "1e-7 deg"),
            (54.18f64.to_radians(), (-7.45f64).to_radians(), Some(1.0), "rad"),
        ];
        for (lat, lon, unit, form) in cases {
            let column = |v: f64| Column { t: vec![0.0, 1.0], v: vec![v; 2], ..Column::default() };
            let found = places(&[&column(lat)], &[&column(lon)], [unit; 2]).unwrap().unwrap();
            let off = (found.origin[0] - 54.18).hypot(found.origin[1] + 7.45);
            assert!(found.form == form && off < 1e-3, "{form}: {} {:?}", found.form, found.origin);
        }
    }
}
