//! From latitude and longitude to metres north and east on the plane that touches the earth at one point.
//! The ellipsoid is WGS84; heights count as 0, and no map projection is used.

use super::signal::median;
use geo3d::{Geodetic, LocalFrame};

/// A plane that touches the earth.
pub struct Plane {
    /// Latitude and longitude of the point \[deg\].
    pub origin: [f64; 2],
    frame: LocalFrame,
}

impl Plane {
    /// The plane at a latitude and longitude \[deg\].
    pub fn at(origin: [f64; 2]) -> Self {
        Self { origin, frame: LocalFrame::new(Geodetic::new(origin[0], origin[1], 0.0)) }
    }

    /// The plane in the middle of positions \[deg\], its point rounded to a ten-thousandth of a degree.
    pub fn amid(latitudes: &[f64], longitudes: &[f64]) -> Option<Self> {
        let rounded = |v: f64| (v * 1e4).round() / 1e4;
        Some(Self::at([rounded(median(latitudes.to_vec())?), rounded(median(longitudes.to_vec())?)]))
    }

    /// Metres north and east of the point.
    pub fn metres(&self, latitude: f64, longitude: f64) -> [f64; 2] {
        let p = self.frame.enu_of(Geodetic::new(latitude, longitude, 0.0));
        [p.north, p.east]
    }
}

/// Degrees and minutes in one number, as in `5412.345` for 54 deg 12.345', to degrees; `None` where the minutes are none.
pub fn from_minutes(value: f64) -> Option<f64> {
    let (degrees, minutes) = ((value.abs() / 100.0).floor(), value.abs() % 100.0);
    (minutes < 60.0 && degrees <= 180.0).then(|| value.signum() * (degrees + minutes / 60.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_minute_of_latitude_is_a_mile_and_of_longitude_less() {
        let plane = Plane::at([54.0, 10.0]);
        let [north, east] = plane.metres(54.0 + 1.0 / 60.0, 10.0);
        // A meridian minute at 54 deg on WGS84: M pi / 10800 with M = a (1 - e2) / (1 - e2 sin2)^1.5 = 6377 km.
        assert!((north - 1855.0).abs() < 0.5 && east.abs() < 1e-6, "{north} {east}");
        let [north, east] = plane.metres(54.0, 10.0 + 1.0 / 60.0);
        assert!((east - 1093.0).abs() < 0.5 && north.abs() < 1.0, "{north} {east}");
        assert_eq!(from_minutes(-1030.0), Some(-10.5));
        assert_eq!(from_minutes(5475.0), None);
    }
}
