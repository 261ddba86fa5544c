//! From latitude and longitude to metres sailed north and east, on WGS84. Heights count as 0, and no map projection is used.

use super::signal::median;

/// Semi-major axis of WGS84 \[m\] and its first eccentricity squared.
const A: f64 = 6_378_137.0;
const E2: f64 = 6.694_379_990_14e-3;

/// Radii of curvature at a latitude \[rad\]: that of the meridian, `M = a (1 - e2) / w^3`, and that of the parallel, `a cos(phi) / w`, with
/// `w^2 = 1 - e2 sin(phi)^2` \[m\].
fn radii(phi: f64) -> [f64; 2] {
    let w = (1.0 - E2 * phi.sin().powi(2)).sqrt();
    [A * (1.0 - E2) / w.powi(3), A * phi.cos() / w]
}

/// Positions as metres sailed.
pub struct Sailed {
    /// Latitude and longitude of the point from which they count \[deg\].
    pub origin: [f64; 2],
    /// Metres north and east.
    pub metres: Vec<[f64; 2]>,
}

/// The way to the north and east of a track of latitudes and longitudes \[deg\], from a point amid it, rounded to a ten-thousandth of a
/// degree: each step counts along the meridian and along the parallel between its ends. So north is up everywhere, and heading, course and
/// speed are those of the track, as long as it may be; a track that encloses an area closes up to `area tan(phi) / R`: 0.2 m for a square
/// kilometre at 54 deg. `None` of nothing.
pub fn sailed(latitudes: &[f64], longitudes: &[f64]) -> Option<Sailed> {
    let rounded = |v: f64| (v * 1e4).round() / 1e4;
    let origin = [rounded(median(latitudes.to_vec())?), rounded(median(longitudes.to_vec())?)];
    let (mut at, mut metres, mut before) = ([0.0; 2], Vec::with_capacity(latitudes.len()), origin);
    for (latitude, longitude) in latitudes.iter().zip(longitudes) {
        let [north, east] = radii((0.5 * (before[0] + latitude)).to_radians());
        at = [at[0] + north * (latitude - before[0]).to_radians(), at[1] + east * (longitude - before[1]).to_radians()];
        metres.push(at);
        before = [*latitude, *longitude];
    }
    Some(Sailed { origin, metres })
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
        let minute = 1.0 / 60.0;
        let Some(found) = sailed(&[54.0, 54.0 + minute, 54.0], &[10.0; 3]) else { panic!("a track") };
        assert_eq!(found.origin, [54.0, 10.0]);
        // A meridian minute at 54 deg on WGS84: M pi / 10800 with M = a (1 - e2) / (1 - e2 sin2)^1.5 = 6377 km.
        assert!((found.metres[1][0] - 1855.0).abs() < 0.5 && found.metres[1][1] == 0.0, "{:?}", found.metres);
        assert!(found.metres[2][0].abs() < 1e-9);
        let Some(found) = sailed(&[54.0; 3], &[10.0 + minute, 10.0, 10.0]) else { panic!("a track") };
        assert!((found.metres[0][1] - 1093.0).abs() < 0.5 && found.metres[0][0] == 0.0, "{:?}", found.metres);
        assert_eq!(from_minutes(-1030.0), Some(-10.5));
        assert_eq!(from_minutes(5475.0), None);
    }

    #[test]
    fn north_is_up_wherever_a_track_leads() {
        // A minute of arc each to the north and to the east, at the end of a day's way along the parallel.
        let day: Vec<f64> = (0..=300).map(|i| 10.0 + 0.02 * f64::from(i)).collect();
        let (mut latitudes, mut longitudes) = (vec![54.0; day.len()], day);
        latitudes.push(54.0 + 1.0 / 60.0);
        longitudes.push(16.0);
        let Some(Sailed { metres, .. }) = sailed(&latitudes, &longitudes) else { panic!("a track") };
        let [from, to] = [metres[300], metres[301]];
        assert!((to[0] - from[0] - 1855.0).abs() < 0.5 && (to[1] - from[1]).abs() < 1e-9, "{from:?} {to:?}");
    }
}
