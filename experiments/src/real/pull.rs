//! Earth-fixed forces by session, compared with the wind of an anemometer that the diagnosis did not use.
//! The forces come from a question asked of a frame; here they are only compared and tabulated.

use nalgebra::{Matrix2, Vector2};
use trimtab::numbers::numerals::fixed;
use trimtab::recording::Run;
use trimtab::report::Table;

use super::frame::Answer;
use super::runs::sessions;

/// An earth-fixed force in one session, beside the wind that the anemometer recorded.
#[derive(Clone, Debug)]
pub struct Pull {
    /// The session.
    pub session: String,
    /// Its manoeuvres.
    pub manoeuvre: String,
    /// Force towards north and east \[N\].
    pub force: [f64; 2],
    /// Its covariance \[N2\].
    pub covariance: Matrix2<f64>,
    /// Mean of the recorded wind, towards (north, east) \[m/s\].
    pub wind: [f64; 2],
}

impl Pull {
    /// Direction of action \[rad\], clockwise from north, with the half width of its 95 % interval.
    pub fn direction(&self) -> (f64, f64) {
        let f = Vector2::from(self.force);
        let size = f.norm().max(f64::MIN_POSITIVE);
        let across = Vector2::new(-f.y, f.x) / size;
        let sd = (across.transpose() * self.covariance * across)[(0, 0)].max(0.0).sqrt();
        (f.y.atan2(f.x), (1.96 * sd).atan2(size))
    }

    /// Size of the force with its standard error \[N\].
    pub fn size(&self) -> (f64, f64) {
        let f = Vector2::from(self.force);
        let along = f / f.norm().max(f64::MIN_POSITIVE);
        (f.norm(), (along.transpose() * self.covariance * along)[(0, 0)].max(0.0).sqrt())
    }

    /// Direction to which the wind blew \[rad\] and the size of its mean \[m/s\].
    pub fn wind_direction(&self) -> (f64, f64) {
        (self.wind[1].atan2(self.wind[0]), self.wind[0].hypot(self.wind[1]))
    }

    /// Direction of the force less that of the wind \[rad\], in (-pi, pi].
    pub fn turned(&self) -> f64 {
        let d = self.direction().0 - self.wind_direction().0;
        d.sin().atan2(d.cos())
    }
}

/// The forces of an answer about `earth_force.north` and `.east` of each session of the runs. `witness` are those runs with the
/// wind as recorded, from which nothing but the comparison is taken.
pub fn pulls(answer: &Answer, witness: &[Run]) -> Vec<Pull> {
    let names = sessions(witness);
    let (value, covariance) = (&answer.test.amplitude, &answer.test.covariance);
    names
        .into_iter()
        .enumerate()
        .map(|(s, session)| {
            let i = 2 * s;
            let of = || witness.iter().filter(|r| r.session == session);
            let winds = || of().flat_map(|r| &r.inputs);
            let count = winds().count().max(1) as f64;
            let mut manoeuvres: Vec<&str> = of().map(|r| r.manoeuvre.as_str()).collect();
            manoeuvres.sort_unstable();
            manoeuvres.dedup();
            Pull {
                manoeuvre: manoeuvres.join(" and "),
                force: [value[i], value[i + 1]],
                covariance: covariance.fixed_view::<2, 2>(i, i).into_owned(),
                wind: [0, 1].map(|c| winds().map(|w| w.wind[c]).sum::<f64>() / count),
                session,
            }
        })
        .collect()
}

/// A row a session.
pub fn pulls_table(pulls: &[Pull]) -> Table {
    let mut table = Table::new([
        "session",
        "manoeuvre",
        "force [N]",
        "standard error [N]",
        "towards [deg]",
        "95 % interval, half width [deg]",
        "mean wind [m/s]",
        "blowing to [deg]",
        "difference [deg]",
    ]);
    for p in pulls {
        let ((to, half), (size, error), (blows, speed)) = (p.direction(), p.size(), p.wind_direction());
        table.row([
            p.session.clone(),
            p.manoeuvre.clone(),
            fixed(size, 3),
            fixed(error, 3),
            fixed(to.to_degrees(), 0),
            fixed(half.to_degrees(), 0),
            fixed(speed, 2),
            fixed(blows.to_degrees(), 0),
            fixed(p.turned().to_degrees(), 0),
        ]);
    }
    table
}
