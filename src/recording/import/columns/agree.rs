//! How well a column agrees with what is known of the motion: a speed with the track, a direction with the course, a rate with the heading.
//! It ranks the candidates for one quantity; units and signs are decided later, in `evidence`.

use crate::recording::import::signals::log::{Column, Meaning};
use crate::recording::import::signals::motion::{COHERENT, Track, ratio, rudder_effect};
use crate::recording::import::signals::signal::{Signal, size_below};
use crate::recording::{Channel, Quantity};
use std::f64::consts::FRAC_PI_2;

/// What is known of the motion while columns are chosen.
#[derive(Default)]
pub struct Sight {
    /// The track.
    pub track: Option<Track>,
    /// The heading \[rad\].
    pub psi: Option<Signal>,
}

/// A speed agrees where the track's is within this share of it: the spread of the speed of a track from fixes of some metres.
const NEAR: f64 = 0.15;
/// t value of a rudder's effect that counts half: twice that from which its sign is determined.
const HALF_T: f64 = 10.0;

impl Sight {
    /// From 0, where a column contradicts the data, to 1; `None` where they do not show it.
    pub fn agreement(&self, meaning: Meaning, columns: &[&Column]) -> Option<f64> {
        match meaning {
            Meaning::Course | Meaning::Channel(Channel::Psi) => self.direction(columns),
            Meaning::GroundSpeed => self.speed(columns),
            Meaning::Channel(Channel::R) => self.rate(columns),
            Meaning::Channel(Channel::Delta) => self.rudder(columns),
            _ => None,
        }
    }

    /// Mean cosine of the angle between the direction and the course: a heading that counts from elsewhere than north is steadily off it.
    /// A direction that is counted anticlockwise may begin at any quarter.
    fn direction(&self, columns: &[&Column]) -> Option<f64> {
        let track = self.track.as_ref()?;
        let signal = heading(columns, Some(track));
        let along = |[length, angle]: [f64; 2]| length * angle.cos().max(0.0);
        let quarter = |[length, angle]: [f64; 2]| length * (angle - (angle / FRAC_PI_2).round() * FRAC_PI_2).cos();
        let clockwise = track.agreement(&signal, 1.0).map(along);
        [clockwise, track.agreement(&signal, -1.0).map(quarter)].into_iter().flatten().reduce(f64::max)
    }

    /// Whether the track is as fast as the column says in the unit that the file states, or in any where it states none.
    fn speed(&self, columns: &[&Column]) -> Option<f64> {
        let track = self.track.as_ref()?;
        let mut size = Signal::new(columns, 1.0, 0.0, false).0;
        size.v.iter_mut().for_each(|v| *v = v.abs());
        let pairs: Vec<[f64; 2]> = track.speed.pairs(&size).into_iter().filter(|p| p[0] > 0.3 * track.fast).collect();
        let found = ratio(&pairs)?;
        let near = |factor: f64| (found.gain.abs() / factor).ln().abs() < NEAR;
        let stated = columns.iter().find_map(|c| Quantity::Speed.factor(c.unit.as_deref()?));
        let fits = match stated {
            Some(factor) => near(factor),
            None => ["m/s", "kn", "km/h"].iter().filter_map(|u| Quantity::Speed.factor(u)).any(near),
        };
        Some(if fits && found.coherence > COHERENT { found.coherence } else { 0.0 })
    }

    /// Coherence with the rate of the heading.
    fn rate(&self, columns: &[&Column]) -> Option<f64> {
        let psi = self.psi.as_ref()?;
        let raw = Signal::new(columns, 1.0, 0.0, false).0;
        let span = psi.span().max(raw.span());
        ratio(&psi.rate(span).pairs(&raw.smooth(span))).map(|r| r.coherence)
    }

    /// How surely the ship turns by the column. One that it does not turn by may be sound where nothing is steered, so that it never
    /// contradicts.
    fn rudder(&self, columns: &[&Column]) -> Option<f64> {
        let psi = self.psi.as_ref()?;
        let t = rudder_effect(&psi.rate(psi.span()), &Signal::new(columns, 1.0, 0.0, false).0)?.abs();
        Some(0.5 + 0.5 * t / (t + HALF_T))
    }
}

/// Columns as a heading \[rad\].
pub fn heading(columns: &[&Column], track: Option<&Track>) -> Signal {
    Signal::new(columns, heading_unit(columns, track), 0.0, true).0
}

/// SI value of one of a heading's: the unit in which it goes with the track, or by its size, or as stated.
pub fn heading_unit(columns: &[&Column], track: Option<&Track>) -> f64 {
    let top = columns.iter().map(|c| size_below(&c.v, 0.999)).fold(0.0, f64::max);
    let stated = columns.iter().find_map(|c| Quantity::Angle.factor(c.unit.as_deref()?));
    let unit = Track::unit_of_direction(track, |factor| Signal::new(columns, factor, 0.0, true).0, top);
    unit.map(|u| u.factor).or(stated).unwrap_or(1.0)
}
